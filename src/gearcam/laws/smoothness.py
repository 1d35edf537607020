"""What a formula of a lift must be: finite and smooth up to its jerk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import NO_JUMPS
from gearcam.laws.formula import Axis, Given
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import NotSmoothError, expand
from gearcam.numeric.jets import Jet

_ODD_SHARE: Final = 0.3819660112501052
"""Where the search for corners is cut first: a corner at a round place then lies inside a part."""

_OF_FUNCTION: Final = 1e-6
"""Roughness of a derivative that does not count, in its largest value, where it is that of the
expansion of a function: this has lost digits, and its smoothness is proven already."""


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
    tolerance = tolerances.expansion if isinstance(given, str) else _OF_FUNCTION
    *_, cuts = [_cuts(function, order, axis, name, tolerance) for order, name in enumerate(names)]
    ends = np.array([axis.low, axis.high])
    found = np.array(function(Jet.variable(ends, len(names))).derivatives())
    for place, column in zip(ends.tolist(), found.T, strict=True):
        if not np.isfinite(column).all():
            order = int(np.argmin(np.isfinite(column)))
            raise InfeasibleError(
                f"{(*names, 'the derivative of its jerk')[order]} cannot be computed",
                where=axis.place(place),
                nearest="roots of zero and powers of zero that are not whole have no derivatives",
            )
    return cuts


def _cuts(
    function: Callable[[Jet], Jet], order: int, axis: Axis, name: str, tolerance: float
) -> Array:
    """Return the knots that an expansion of a derivative needs."""

    def values(x: Array) -> Array:
        # with 1 added, the rounding of a derivative that is zero does not count as rough
        return 1.0 + function(Jet.variable(x, order)).derivatives()[order]

    odd = axis.low + _ODD_SHARE * (axis.high - axis.low)
    try:
        return expand(values, [axis.low, odd, axis.high], tolerance).knots
    except NotSmoothError as error:
        state = "smooth" if error.finite else "finite"
        nearest = NO_JUMPS if error.finite else ""
        raise InfeasibleError(
            f"{name} is not {state}", where=axis.place(error.place), nearest=nearest
        ) from error
