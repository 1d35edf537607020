"""Formulas of laws as functions of jets, which bring their derivatives with them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from gearcam.laws.formula_syntax import VARIABLE, FormulaError, parse
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import FUNCTIONS, Jet, Value


def formula_problems(
    name: str, text: str, variable: str = VARIABLE
) -> Iterator[tuple[str, int | None, str, str]]:
    """Yield what is wrong in a law's formula, for its ``problems`` (see `parse`)."""
    try:
        parse(text, variable)
    except FormulaError as error:
        place = "" if error.column is None else f"column {error.column}: "
        hint = f" ({error.hint})" if error.hint else ""
        yield name, None, f"{place}{error.what}{hint}", error.allowed


def compiled(text: str, variable: str = VARIABLE) -> Callable[[Jet], Jet]:
    """Return a formula as a function of jets (see `parse`)."""
    expression = parse(text, variable)
    return lambda x: expression.evaluate(x, FUNCTIONS)


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
