"""The law of a given driver centrode: solves the centre distance that closes the driven wheel."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import Tolerances
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.span import NO_DWELL, PLACES, WHEEL, Span, angle_text, demand_smooth
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import NotSmoothError, expand
from gearcam.numeric.jets import Jet, Value
from gearcam.numeric.piecewise import Piece, piecewise
from gearcam.numeric.roots import newton_in_bracket

_APART = 1e-9
"""Smallest distance between driven shaft and largest radius, relative: closer values are lost."""

_SMALLEST, _LARGEST = 1e-100, 1e100
"""Range of ratios and radii, whose squares must be finite."""


def law_of_centrode(
    shapes: list[Piece], knots: ArrayLike, lobes: Span, tolerances: Tolerances
) -> RatioLaw:
    """Return the law of a driver centrode given at any scale.

    With the centre distance c in that scale the ratio is ``i = r/(c - w*r)``, where w = 1 for a
    wheel as mate and -1 for a ring.

    Parameters
    ----------
    shapes : list of n Piece
        The radius between the knots, at any scale; positive.
    knots : (n + 1,) array, rad
        From 0 to the period.
    lobes : Lobes or Travel
        Lobes, or travels of an open pair.
    tolerances : Tolerances
        Accuracy.

    Returns
    -------
    RatioLaw
        With ``center_distance_over_scale`` in `solved`.

    Raises
    ------
    InfeasibleError
        If the radius is not finite or smooth, or the law cannot be realised.

    Notes
    -----
    The driven angle falls as c grows: for a wheel from infinity at the largest r, for a ring from
    the driver angle at c = 0. So there is one root, below the c of a circle of the largest r.
    """
    radius = piecewise(knots, shapes)
    with demand_smooth("r1"):
        center = solve_center(radius, knots, lobes, tolerances)

    def ratio(shape: Callable[..., Jet]) -> Callable[..., Jet]:
        def over_distance(x: Jet, *parameters: Value) -> Jet:
            r = shape(x, *parameters)
            return r / (center - lobes.mate * r)

        return over_distance

    ratios = {shape.function: ratio(shape.function) for shape in shapes}
    pieces = [Piece(ratios[shape.function], parameters=shape.parameters) for shape in shapes]
    return make_law(lobes, knots, pieces, tolerances, {"center_distance_over_scale": center})


def demand_positive(function: Callable[[Array], Array], name: str, period: float) -> None:
    """Refuse a function that is not finite, not positive or out of range somewhere.

    Parameters
    ----------
    function : callable
        ``function(phi1) -> values``.
    name : str
        Name of the values, for messages.
    period : float, rad
        Largest driver angle.

    Raises
    ------
    InfeasibleError
        With the first such place.
    """
    angles = np.linspace(0.0, period, PLACES)
    demand_radii(name, angles, function(angles))


def demand_radii(name: str, angles: Array, values: Array, place: str = "") -> None:
    """Refuse ratios or radii, at any scale, that are not finite, not positive or out of range.

    Parameters
    ----------
    name : str
        Name of the values, for messages.
    angles : (n,) array, rad
        Driver angles.
    values : (n,) array
        The ratios or radii.
    place : str
        Text before the angle in messages.

    Raises
    ------
    InfeasibleError
        With the first such place.
    """
    wrongs = {
        "is not finite": (~np.isfinite(values), None),
        "is not positive": (values <= 0.0, 0.0),
        "is too small for computing": (values < _SMALLEST, _SMALLEST),
        "is too large for computing": (values > _LARGEST, _LARGEST),
    }
    for state, (wrong, limit) in wrongs.items():
        for row in np.flatnonzero(wrong)[:1].tolist():
            value = None if limit is None else float(values[row])
            where = place + angle_text(float(angles[row]))
            note = NO_DWELL if name == "ratio" and limit == 0.0 else ""
            raise InfeasibleError(
                f"{name} {state}", where=where, value=value, limit=limit, nearest=note
            )


def solve_center(
    radius: Callable[[Array], Array], knots: ArrayLike, lobes: Span, tolerances: Tolerances
) -> float:
    """Return the centre distance, in the scale of the radius, that closes the driven wheel.

    Parameters
    ----------
    radius : callable
        ``radius(phi1) -> r1``, positive.
    knots : (n + 1,) array, rad
        From 0 to the period; the radius is smooth between them.
    lobes : Lobes or Travel
        Lobes, or travels of an open pair.
    tolerances : Tolerances
        Accuracy.

    Returns
    -------
    float

    Raises
    ------
    NotSmoothError
        If the radius is not finite or not smooth between the knots.
    """
    ends, tolerance = np.asarray(knots, dtype=float), tolerances.expansion
    mean = expand(radius, ends, tolerance).antiderivative().last / lobes.period
    largest = float(radius(np.append(np.linspace(0.0, lobes.period, PLACES), ends)).max())
    ratio, mate = lobes.period / lobes.advance, lobes.mate

    def excess(c: Array) -> tuple[Array, Array]:
        center = float(c)
        try:
            driven = expand(lambda t: radius(t) / (center - mate * radius(t)), ends, tolerance)
            slope = expand(lambda t: radius(t) / (center - mate * radius(t)) ** 2, ends, tolerance)
        except NotSmoothError:
            # too close to the largest radius: the driven angle cannot be computed, but is large
            return np.asarray(-np.inf), np.asarray(np.inf)
        miss = lobes.advance - driven.antiderivative().last
        return np.asarray(miss), np.asarray(slope.antiderivative().last)

    low = largest * (1.0 + _APART) if mate == WHEEL else 0.0
    high = largest * (mate + ratio) * (1.0 + _APART)
    start = min(max(mean * (mate + ratio), 0.75 * low + 0.25 * high), high)
    return float(newton_in_bracket(excess, low, high, start, 1e-15 * high))
