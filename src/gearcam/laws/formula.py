"""Formulas of laws as functions of jets, that is, with their derivatives.

From Python a formula may also be a function (see `gearcam.laws.functions`). A formula of a lift
must be finite and smooth up to its jerk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.rules import Breach
from gearcam.base.tolerances import Tolerances
from gearcam.laws.displacement import EXACT
from gearcam.laws.entry import NO_JUMPS, VARIABLE, Axis, Functions
from gearcam.laws.formula_syntax import FormulaError, parse
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import NotSmoothError, expand
from gearcam.numeric.jets import Jet, Value

Given = str | Functions
"""A formula, as text or as functions."""


def formula_problems(name: str, given: Given, variable: str = VARIABLE) -> Iterator[Breach]:
    """Yield the faults of the formula of a law, for its ``problems`` (see `parse`)."""
    try:
        if isinstance(given, str):
            parse(given, variable)
    except FormulaError as error:
        place = "" if error.column is None else f"column {error.column}: "
        hint = f" ({error.hint})" if error.hint else ""
        yield name, None, f"{place}{error.what}{hint}", error.allowed


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
        return parse(given, axis.variable).evaluate
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


def demand_smooth(
    function: Callable[[Jet], Jet],
    given: Given,
    axis: Axis,
    names: Sequence[str],
    tolerances: Tolerances,
) -> Array:
    """Refuse a formula that has no jerk, or a rough one.

    Parameters
    ----------
    function : callable
        ``function(jet) -> jet``.
    given : str, callable or tuple of callables
        What it was made from.
    axis : Axis
        Where it is needed.
    names : sequence of str
        Of the function and its derivatives, the jerk last.
    tolerances : Tolerances
        Accuracy of expansions.

    Returns
    -------
    (n,) array
        Places that show the peaks of the jerk, both ends included.

    Raises
    ------
    InfeasibleError
        With the place.
    """
    # derivatives of an expansion have lost digits, and their smoothness is proven already
    tolerance = tolerances.expansion if isinstance(given, str) else 1e-6
    *_, cuts = [_cuts(function, order, axis, name, tolerance) for order, name in enumerate(names)]
    ends = np.array([axis.low, axis.high])
    values = np.array(function(Jet.variable(ends, len(names))).derivatives())
    for place, column in zip(ends.tolist(), values.T, strict=True):
        if not np.isfinite(column).all():
            order = int(np.argmin(np.isfinite(column)))
            what = f"{(*names, 'the derivative of its jerk')[order]} cannot be computed"
            note = "roots of zero and powers of zero that are not whole have no derivatives"
            raise InfeasibleError(what, where=axis.place(place), nearest=note)
    return cuts


def _cuts(
    function: Callable[[Jet], Jet], order: int, axis: Axis, name: str, tolerance: float
) -> Array:
    """Return the knots that an expansion of a derivative needs."""

    def values(x: Array) -> Array:
        # with 1 added, the rounding of a derivative that is zero does not count as rough
        return 1.0 + function(Jet.variable(x, order)).derivatives()[order]

    # cut at an odd place first, so that a corner at a round one lies inside a part
    odd = axis.low + 0.3819660112501052 * (axis.high - axis.low)
    try:
        return expand(values, [axis.low, odd, axis.high], tolerance).knots
    except NotSmoothError as error:
        state = "smooth" if error.finite else "finite"
        nearest = NO_JUMPS if error.finite else ""
        raise InfeasibleError(
            f"{name} is not {state}", where=axis.place(error.place), nearest=nearest
        ) from error
