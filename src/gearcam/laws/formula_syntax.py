"""Formulas as text, read into expressions that can only compute.

A *formula* is made of numbers, ``pi``, the driver angle ``phi1`` (rad), the operators
``+ - * / **``, parentheses, and functions of one argument. The text is split into these words
first; anything else is refused with its column. Python's parser then gives a syntax tree, which is
checked against a list of allowed nodes and turned into a flat *program*, in which equal parts are
computed once. Python executes nothing: attributes, subscripts, comparisons, imports and other names
are not accessible.

Numbers are read as floats and parts without ``phi1`` are computed once, so that ``9**9**9**9`` and
numbers of a thousand digits take no time: parts without a finite real value are refused with their
column. The variable may be any object that has the operators, with a table of functions for it:
an array, or a jet, which also has derivatives.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.base.errors import GearcamError
from gearcam.base.numerals import formatted
from gearcam.base.rules import Breach
from gearcam.laws.entry import VARIABLE
from gearcam.numeric.jets import FUNCTIONS

MAX_LENGTH: Final = 2000
"""Largest number of characters of a formula, which also limits the work of reading it."""

MAX_NESTING: Final = 50
"""Deepest nesting of parentheses and towers of powers."""

MAX_EXPONENT: Final = 100.0
"""Largest constant exponent."""

CONSTANTS: Final = {"pi": math.pi}

_PARTS: Final = f"pi, numbers, + - * / ** ( ), {', '.join(FUNCTIONS)}"
"""Allowed elements of a formula beside its variable, for messages."""

_OPERATORS: Final[dict[type, Callable[..., Any]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}

_TOKEN = re.compile(
    r"(?P<space>[ \t\r\n]+)"
    r"|(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[^\W\d]\w*)"
    r"|(?P<operator>\*\*|[-+*/])"
    r"|(?P<open>\()"
    r"|(?P<close>\))"
    r"|(?P<other>.)",
    re.DOTALL,
)
_HINTS: Final = {
    "^": "a power is written **",
    ",": "functions take one argument, and the decimal sign is a point",
    "=": "give the right side only",
    "[": "use round parentheses",
    "{": "use round parentheses",
    "\N{MINUS SIGN}": "this is a typographic minus: type -",
    "\N{EN DASH}": "this is a dash: type -",
    "\N{MULTIPLICATION SIGN}": "multiply with *",
    "\N{MIDDLE DOT}": "multiply with *",
    "\N{DEGREE SIGN}": "angles in formulas are in radians: multiply by pi/180",
}
_ALIASES: Final = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "ln": "log",
    "e": "exp(1)",
    "\N{GREEK SMALL LETTER PI}": "pi",
}
_VARIABLES: Final = frozenset(
    {"phi1", "phi", "theta", "x", "t", "q", "u"}
    | {"\N{GREEK SMALL LETTER PHI}", "\N{GREEK SMALL LETTER THETA}"}
)
"""Names of the variable of some formula, which people write in others."""


class FormulaError(GearcamError, ValueError):
    """A formula that cannot be read.

    Parameters
    ----------
    what : str
        What is wrong, without the column.
    column : int or None
        Column in the text, from 1; None for the whole formula.
    allowed : str
        Allowed elements at that column.
    hint : str
        Suggestion.
    """

    def __init__(
        self, what: str, *, column: int | None = None, allowed: str = "", hint: str = ""
    ) -> None:
        self.what, self.column, self.allowed, self.hint = what, column, allowed, hint
        place = f"column {column}: {what}" if column is not None else what
        parts = (place, allowed and f"allowed: {allowed}", hint)
        super().__init__("; ".join(part for part in parts if part))

    def breach(self, name: str) -> Breach:
        """Return the fault of the field `name` that holds the formula."""
        place = "" if self.column is None else f"column {self.column}: "
        hint = f" ({self.hint})" if self.hint else ""
        return name, None, f"{place}{self.what}{hint}", self.allowed


Operand = int | float
"""A constant, or the number of a value: 0 is the variable, k the result of the k-th step."""

Function = Callable[..., Any] | str
"""An operator, or the name of a function."""

Step = tuple[Function, tuple[Operand, ...]]
"""Operation and operands."""


@dataclass(frozen=True, eq=False)
class Expression:
    """A formula after reading.

    Parameters
    ----------
    text : str
        The formula as written.
    steps : tuple of Step
        Operations, each with one value.
    result : int or float
        The formula's value.
    """

    text: str
    steps: tuple[Step, ...]
    result: Operand

    @property
    def is_constant(self) -> bool:
        """Whether the formula does not contain the angle."""
        return isinstance(self.result, float)

    def evaluate(self, x: Any, functions: Mapping[str, Callable[[Any], Any]] = FUNCTIONS) -> Any:
        """Compute the formula.

        Parameters
        ----------
        x : array, float or any object with the operators
            The driver's angle, rad.
        functions : mapping of str to callable
            The functions for this type of `x`, by the same names; those of jets by default.

        Returns
        -------
        same type as `x`
            Also for a constant formula. Outside the domain of a function values are nan or inf,
            without a warning; callers report them with their angle.
        """
        values = [x]
        with np.errstate(all="ignore"):
            for function, operands in self.steps:
                call = functions[function] if isinstance(function, str) else function
                values.append(call(*(values[k] if isinstance(k, int) else k for k in operands)))
            return x * 0.0 + self.result if self.is_constant else values[int(self.result)]


def parse(text: str, variable: str = VARIABLE) -> Expression:
    """Read a formula.

    Parameters
    ----------
    text : str
        Formula, such as ``phi1 - 0.08*sin(2*phi1)``.
    variable : str
        Name of the variable, an identifier.

    Returns
    -------
    Expression
        The formula after reading.

    Raises
    ------
    FormulaError
        If the text contains anything not allowed, or a part without ``phi1`` that has no finite
        real value.
    """
    if not text.strip():
        raise FormulaError("the formula is empty", allowed=_allowed(variable))
    if len(text) > MAX_LENGTH:
        raise FormulaError(
            f"the formula has {len(text)} characters", allowed=f"at most {MAX_LENGTH} characters"
        )
    _check_words(text, variable)
    # Only the words above are left, all in ASCII, and blanks of any kind become spaces (the grammar
    # gives line ends a meaning); so with a parenthesis before it columns of the tree, which count
    # from 0, are columns of the text.
    try:
        tree = ast.parse("(" + re.sub(r"\s", " ", text) + ")", mode="eval")
    except (SyntaxError, RecursionError, MemoryError, ValueError) as error:
        what = "this cannot be read as a formula"
        raise FormulaError(what, allowed=_allowed(variable)) from error
    steps, result = _steps(tree.body, variable)
    return Expression(text, steps, result)


def _allowed(variable: str) -> str:
    """Return the allowed elements of a formula in a variable, for messages."""
    return f"{variable}, {_PARTS}"


def _check_words(text: str, variable: str) -> None:
    """Check each word, its neighbours and the parentheses."""
    before = "start"
    opened: list[int] = []
    for kind, word, column in _words(text, variable):
        _check_neighbours(before, kind, word, column, variable)
        if kind == "open":
            opened.append(column)
        elif kind == "close":
            if not opened:
                raise FormulaError("this closing parenthesis was never opened", column=column)
            opened.pop()
        if len(opened) > MAX_NESTING:
            raise FormulaError(
                "parentheses are nested too deep", column=column, allowed=f"{MAX_NESTING} deep"
            )
        before = kind
    if before in ("operator", "function", "open"):
        raise FormulaError("the formula ends too early", column=len(text.rstrip()) + 1)
    if opened:
        raise FormulaError("this parenthesis is never closed", column=opened[-1])


def _words(text: str, variable: str) -> Iterator[tuple[str, str, int]]:
    """Split the text: kind (value, function, operator, open, close), word, column from 1."""
    for match in _TOKEN.finditer(text):
        kind, word, column = str(match.lastgroup), match.group(), match.start() + 1
        if kind == "other":
            name = repr(word) if word.isprintable() else f"U+{ord(word):04X}"
            what, hint = f"unexpected sign {name}", _HINTS.get(word, "")
            raise FormulaError(what, column=column, allowed=_allowed(variable), hint=hint)
        if kind == "name":
            _check_name(word, column, variable)
            kind = "function" if word in FUNCTIONS else "value"
        elif kind == "number":
            _check_number(word, column)
            kind = "value"
        if kind != "space":
            yield kind, word, column


def _check_name(word: str, column: int, variable: str) -> None:
    names = (variable, *CONSTANTS, *FUNCTIONS)
    if word in names:
        return
    import difflib

    lower = word.lower()
    alias = variable if lower in _VARIABLES else _ALIASES.get(lower)
    close = [alias] if alias else difflib.get_close_matches(lower, names, n=1)
    raise FormulaError(
        f"unknown name {word!r}",
        column=column,
        allowed=_allowed(variable),
        hint="".join(f"did you mean {name}?" for name in close),
    )


def _check_number(word: str, column: int) -> None:
    if not math.isfinite(float(word)):
        raise FormulaError(
            "this number is too large", column=column, allowed="numbers up to 1.8e308"
        )
    if word.isdigit() and word != "0" and word.startswith("0"):
        hint = f"write {formatted(float(word))}"
        raise FormulaError(f"the number {word} begins with a zero", column=column, hint=hint)


def _check_neighbours(before: str, kind: str, word: str, column: int, variable: str) -> None:
    """Refuse two words that cannot follow each other (the signs + and - may start a value)."""
    after_value = before in ("value", "close")
    if before == "function" and kind != "open":
        what = f"the argument of a function needs parentheses: sin({variable})"
        raise FormulaError(what, column=column)
    if kind in ("value", "function", "open") and after_value:
        raise FormulaError(
            f"an operator is missing before {word!r}",
            column=column,
            allowed="+ - * / **",
            hint="multiplication is written with *",
        )
    if kind == "operator" and not after_value and word not in ("+", "-"):
        raise FormulaError(f"a value is missing before {word!r}", column=column)
    if kind == "close" and before == "operator":
        raise FormulaError(f"a value is missing before {word!r}", column=column)
    if kind == "close" and before == "open":
        raise FormulaError("these parentheses are empty", column=column - 1)


def _steps(root: ast.expr, variable: str) -> tuple[tuple[Step, ...], Operand]:
    """Return the steps of a syntax tree and its result; equal parts are one step.

    Without recursion, since a tree may be as deep as the text is long.
    """
    names: dict[str, Operand] = {variable: 0, **CONSTANTS}
    steps: dict[tuple[Function, str], tuple[int, Step]] = {}
    values: list[Operand] = []
    todo: list[ast.expr | tuple[Function, ast.expr, Sequence[ast.expr]]] = [root]
    while todo:
        item = todo.pop()
        if isinstance(item, tuple):
            function, node, parts = item
            operands = tuple(values[-len(parts) :])
            del values[-len(parts) :]
            if function is operator.pow:
                _check_exponent(operands[1], parts[1].col_offset)
            if all(isinstance(value, float) for value in operands):
                values.append(_constant(function, operands, node.col_offset))
            else:
                key = function, repr(operands)  # by its text: 0.0 and -0.0 are two constants
                values.append(steps.setdefault(key, (len(steps) + 1, (function, operands)))[0])
            continue
        match item:
            case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                values.append(float(value))
            case ast.Name(id=name) if name in names:
                values.append(names[name])
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                todo += [(_OPERATORS[type(op)], item, (left, right)), right, left]
            case ast.UnaryOp(op=op, operand=part) if type(op) in _OPERATORS:
                todo += [(_OPERATORS[type(op)], item, (part,)), part]
            case ast.Call(func=ast.Name(id=name), args=[part], keywords=[]) if name in FUNCTIONS:
                todo += [(name, item, (part,)), part]
            case _:
                what, allowed = "this is not allowed", _allowed(variable)
                raise FormulaError(what, column=item.col_offset, allowed=allowed)
    return tuple(step for _, step in steps.values()), values[0]


def _constant(function: Function, operands: Sequence[Operand], column: int) -> float:
    """Return the value of a part without the variable."""
    call = getattr(math, function) if isinstance(function, str) else function
    try:
        result = call(*operands)
    except (ArithmeticError, ValueError):
        result = math.nan
    if isinstance(result, complex) or not math.isfinite(result):
        raise FormulaError(
            "this part has no finite real value", column=column, allowed="finite real numbers"
        )
    return float(result)


def _check_exponent(value: Operand, column: int) -> None:
    if isinstance(value, float) and abs(value) > MAX_EXPONENT:
        raise FormulaError(
            f"exponent {formatted(value)} is too large",
            column=column,
            allowed=f"exponents from {formatted(-MAX_EXPONENT)} to {formatted(MAX_EXPONENT)}",
        )
