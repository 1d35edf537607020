"""Formulas of laws as functions of jets, which bring their derivatives with them.

From Python a formula may also be a function (see `gearcam.laws.functions`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from gearcam.laws.displacement import EXACT
from gearcam.laws.formula_syntax import VARIABLE, FormulaError, parse
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import FUNCTIONS, Jet, Value

Function = Callable[[Any], Any]
"""Written in Python: takes a float array, or a float, and returns as many values."""

Functions = Function | tuple[Function, ...]
"""A function, or a function with its first derivatives, each of the one before it."""

Given = str | Functions
"""A formula: as text, or as functions."""


@dataclass(frozen=True, kw_only=True)
class Axis:
    """Over what a formula is needed.

    Parameters
    ----------
    name : str
        What its values are, such as ``phi2``.
    low, high : float
        The interval.
    place : callable
        ``place(x)`` returns a place in words.
    variable : str
        Its name in texts.
    remedy : str
        What may be given instead of a function that is not smooth.
    series : bool
        Whether long Taylor series are taken of it: only harmonics have the digits for them.
    """

    name: str
    low: float = 0.0
    high: float
    place: Callable[[float], str]
    variable: str = VARIABLE
    remedy: str = ""
    series: bool = False


def formula_problems(
    name: str, given: Given, variable: str = VARIABLE
) -> Iterator[tuple[str, int | None, str, str]]:
    """Yield what is wrong in a law's formula, for its ``problems`` (see `parse`)."""
    try:
        if isinstance(given, str):
            parse(given, variable)
    except FormulaError as error:
        place = "" if error.column is None else f"column {error.column}: "
        hint = f" ({error.hint})" if error.hint else ""
        yield name, None, f"{place}{error.what}{hint}", error.allowed


def compiled(text: str, variable: str = VARIABLE) -> Callable[[Jet], Jet]:
    """Return a formula as a function of jets (see `parse`)."""
    expression = parse(text, variable)
    return lambda x: expression.evaluate(x, FUNCTIONS)


def function_of(given: Given, axis: Axis, tolerance: float) -> Callable[[Jet], Jet]:
    """Return a formula as a function of jets.

    Parameters
    ----------
    given : str, callable or tuple of callables
        The formula.
    axis : Axis
        Where it is needed.
    tolerance : float
        Truncation error allowed to the expansion of a function, in its largest value.

    Returns
    -------
    callable
        ``function(jet) -> jet``; how exact it is `errors_of` tells.

    Raises
    ------
    InfeasibleError
        Where a function is not finite or smooth, or fails.
    """
    if isinstance(given, str):
        return compiled(given, axis.variable)
    from gearcam.laws.functions import expanded  # which a text does not need

    return expanded(given, axis, tolerance)


def errors_of(function: Callable[[Jet], Jet]) -> tuple[float, ...]:
    """Return estimated errors of what `function_of` gives, and of its first three derivatives.

    A text is exact: zeros.
    """
    return getattr(function, "errors", EXACT)


def values_of(function: Callable[[Jet], Jet]) -> Callable[[Array], Array]:
    """Return a function of jets as one of places."""
    return lambda x: function(Jet.variable(x, 0)).derivatives()[0]


def derivative(function: Callable[..., Jet]) -> Callable[..., Jet]:
    """Return the derivative of a function of jets, itself one.

    Parameters
    ----------
    function : callable
        ``function(jet, *parameters) -> jet``.

    Returns
    -------
    callable
    """

    def slope(x: Jet, *parameters: Value) -> Jet:
        one_more = function(Jet.variable(x.c[0], x.order + 1), *parameters)
        slopes = [(k + 1) * value for k, value in enumerate(one_more.c[1:])]
        return Jet([slopes[0] + 0.0 * x.c[0], *slopes[1:]])

    return slope
