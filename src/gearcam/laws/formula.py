"""Formulas of laws as functions of jets, that is, with their derivatives.

From Python a formula may also be a function (see `gearcam.laws.functions`). A formula of a lift
must be finite and smooth up to its jerk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.rules import Breach
from gearcam.laws.displacement import EXACT
from gearcam.laws.entry import NO_JUMPS, VARIABLE, Axis, Functions
from gearcam.laws.formula_syntax import FormulaError, parse
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import NotSmoothError, expand
from gearcam.numeric.jets import Jet, Value

Given = str | Functions
"""A formula, as text or as functions."""


def formula_problems(name: str, given: Given | None, variable: str = VARIABLE) -> Iterator[Breach]:
    """Yield the faults of a formula that is a text, for ``problems`` of a law (see `parse`)."""
    try:
        if isinstance(given, str):
            parse(given, variable)
    except FormulaError as error:
        yield error.breach(name)


@dataclass(frozen=True, eq=False)
class AxisFunction(ShortRepr):
    """A formula as a function of jets over its axis.

    Parameters
    ----------
    axis : Axis
        Where it is needed.
    evaluate : callable
        ``evaluate(jet) -> jet``.
    tolerance : float
        Roughness of a derivative that does not count, over its largest value.
    errors : (float, float, float, float)
        Estimated errors of the function and its first three derivatives.
    """

    axis: Axis
    evaluate: Callable[[Jet], Jet]
    tolerance: float
    errors: tuple[float, ...] = EXACT

    def __call__(self, x: Jet) -> Jet:
        """Return the function of a jet."""
        return self.evaluate(x)

    def demand_smooth(self, names: Sequence[str]) -> Array:
        """Refuse a formula that has no jerk, or a rough one.

        Parameters
        ----------
        names : sequence of str
            Of the function and its derivatives, the jerk last.

        Returns
        -------
        (n,) array
            Places that show the peaks of the jerk, both ends included.

        Raises
        ------
        InfeasibleError
            With the place.
        """
        *_, cuts = [self._cuts(order, name) for order, name in enumerate(names)]
        ends = np.array([self.axis.low, self.axis.high])
        values = np.array(self(Jet.variable(ends, len(names))).derivatives())
        for place, column in zip(ends.tolist(), values.T, strict=True):
            if not np.isfinite(column).all():
                order = int(np.argmin(np.isfinite(column)))
                what = f"{(*names, 'the derivative of its jerk')[order]} cannot be computed"
                note = "roots of zero and powers of zero that are not whole have no derivatives"
                raise InfeasibleError(what, where=self.axis.place(place), nearest=note)
        return cuts

    def _cuts(self, order: int, name: str) -> Array:
        """Return the knots that an expansion of a derivative needs."""

        def values(x: Array) -> Array:
            # with 1 added, the rounding of a derivative that is zero does not count as rough
            return 1.0 + self(Jet.variable(x, order)).derivatives()[order]

        low, high = self.axis.low, self.axis.high
        # cut at an odd place first, so that a corner at a round one lies inside a part
        odd = low + 0.3819660112501052 * (high - low)
        try:
            return expand(values, [low, odd, high], self.tolerance).knots
        except NotSmoothError as error:
            state = "smooth" if error.finite else "finite"
            nearest = NO_JUMPS if error.finite else ""
            where = self.axis.place(error.place)
            raise InfeasibleError(f"{name} is not {state}", where=where, nearest=nearest) from error


def function_of(given: Given, axis: Axis, tolerance: float) -> AxisFunction:
    """Return a formula as a function of jets.

    Parameters
    ----------
    given : str, callable or tuple of callables
        The formula.
    axis : Axis
        Where it is needed.
    tolerance : float
        Largest truncation error of an expansion over the largest value.

    Returns
    -------
    AxisFunction

    Raises
    ------
    InfeasibleError
        If a function is not finite, not smooth, or raises an exception.
    """
    if isinstance(given, str):
        return AxisFunction(axis, parse(given, axis.variable).evaluate, tolerance)
    from gearcam.laws.functions import expanded  # which a text does not need

    function = expanded(given, axis, tolerance)
    # its derivatives have lost digits, and their smoothness is proven already
    return AxisFunction(axis, function, 1e-6, function.errors)


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
