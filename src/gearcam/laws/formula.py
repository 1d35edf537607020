"""Formulas of laws as functions of jets, that is, with their derivatives.

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
"""A Python function of a float array or a float; it returns as many values."""

Functions = Function | tuple[Function, ...]
"""A function, or a tuple of a function and its first derivatives in order."""

Given = str | Functions
"""A formula, as text or as functions."""


@dataclass(frozen=True, kw_only=True)
class Axis:
    """The variable and the interval of a formula.

    Parameters
    ----------
    name : str
        Name of the values, such as ``phi2``.
    low, high : float
        The interval.
    place : callable
        ``place(x)`` returns a place as text for messages.
    variable : str
        Name of the variable in formulas.
    remedy : str
        Alternative to a function that is not smooth, for messages.
    series : bool
        Whether long Taylor series are needed, which only harmonics give accurately.
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
    """Yield the faults of the formula of a law, for its ``problems`` (see `parse`)."""
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
        Largest truncation error of the expansion of a function over its largest value.

    Returns
    -------
    callable
        ``function(jet) -> jet``; for its errors see `errors_of`.

    Raises
    ------
    InfeasibleError
        If a function is not finite, not smooth, or raises an exception.
    """
    if isinstance(given, str):
        return compiled(given, axis.variable)
    from gearcam.laws.functions import expanded  # which a text does not need

    return expanded(given, axis, tolerance)


def errors_of(function: Callable[[Jet], Jet]) -> tuple[float, ...]:
    """Return error estimates of a result of `function_of` and its first three derivatives.

    Zeros for a formula given as text.
    """
    return getattr(function, "errors", EXACT)


def values_of(function: Callable[[Jet], Jet]) -> Callable[[Array], Array]:
    """Return a function of jets as a function of arrays."""
    return lambda x: function(Jet.variable(x, 0)).derivatives()[0]


def derivative(function: Callable[..., Jet]) -> Callable[..., Jet]:
    """Return the derivative of a function of jets, again a function of jets.

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
