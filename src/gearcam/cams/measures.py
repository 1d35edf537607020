"""Measures of a cam: pressure angles, radii of curvature, undercut stretches, size.

Every extreme is a root of an exact derivative, or one of the two values at a knot; every end of an
undercut stretch is a root of the contact's speed, bracketed by its extremes.

Depends on curve, contact and numeric; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.cams.curve import CamCurve, ProfileSegments
from gearcam.cams.followers import Contact
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.gauss import gauss_rule
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import extremes_among, places_between
from gearcam.numeric.roots import bracketed_root

_GAP = 1e-11
"""Gap, rad of a turn, below which two undercut stretches are merged."""

_ROOT = 1e-15
"""Width of a root's bracket, rad of a turn."""

_GAUSS = 16
_CELLS = 4
_MOST_CELLS = 1024
_AGREED = 1e-14
"""Gauss points per cell of a segment; cells are halved until sums agree to this share."""

_ROUNDING = 16.0 * np.finfo(float).eps
"""Relative rounding of sums."""


@dataclass(frozen=True, kw_only=True)
class Extreme:
    """A `value` and its cam angle `theta`, rad."""

    theta: float
    value: float


@dataclass(frozen=True, kw_only=True)
class Range(ShortRepr):
    """The smallest value of a quantity, `low`, and the largest, `high`."""

    low: Extreme
    high: Extreme

    @property
    def largest(self) -> float:
        """The largest absolute value."""
        return max(abs(self.low.value), abs(self.high.value))

    @property
    def least_radius(self) -> float:
        """Smallest radius of a range of curvature; infinite if all is straight."""
        return 1.0 / self.largest if self.largest else math.inf


def range_of(
    curve: CamCurve, pick: Callable[[Contact], Jet], stretches: list[tuple[float, float]]
) -> Range | None:
    """Return the range of a quantity of the contact.

    Parameters
    ----------
    curve : CamCurve
        The cam.
    pick : callable
        ``pick(contact) -> Jet``.
    stretches : list of (float, float)
        Ranges of cam angle, rad.

    Returns
    -------
    Range or None
        None if there are no stretches.
    """

    def function(theta: Array) -> list[Array]:
        return pick(curve.contact(theta)).derivatives()

    if not stretches:
        return None
    cuts = [curve.program.cuts_between(*ends) for ends in stretches]
    # at the ends of cells each side is evaluated by its own piece, up to the knot itself
    _, states = curve.program.sides(cuts)
    at_ends = pick(curve.contact_of(states, 0)).c[0] + np.zeros(states.shape[1])
    candidates = []
    shares = np.cumsum([len(places) - 1 for places in cuts])[:-1]
    for places, sides in zip(cuts, np.split(at_ends.reshape(2, -1), shares, axis=1), strict=True):
        x = places_between(places)
        values, slopes = (row.reshape(x.shape) for row in function(x.ravel()))
        x[:, [0, -1]], values[:, [0, -1]] = np.stack([places[:-1], places[1:]], axis=1), sides.T
        candidates.append(extremes_among(function, x, values, slopes))
    theta, value = np.concatenate(candidates, axis=1)
    low, high = (
        Extreme(theta=float(theta[k]), value=float(value[k]))
        for k in (value.argmin(), value.argmax())
    )
    return Range(low=low, high=high)


def undercut(curve: CamCurve) -> list[tuple[float, float]]:
    """Return the stretches on which the profile runs backwards.

    Parameters
    ----------
    curve : CamCurve
        The cam.

    Returns
    -------
    list of (float, float)
        Cam angles, rad, in rising order; both are equal if only a jump runs backwards. A stretch
        across the end of the turn is cut there.
    """
    if not curve.rounded:
        return []
    survey = curve.program.survey
    side, hard = curve.lift_sign, curve.program.hard
    back = (jump.theta for jump in hard if side * (jump.after - jump.before) < 0.0)
    stretches = [(theta, theta) for theta in back]

    def speed(theta: Array) -> list[Array]:
        return curve.contact(theta).speed.derivatives()

    speeds = curve.contact_of(survey.values).speed.derivatives()
    # between two points a function lies above the lower of its tangents if it has a minimum there,
    # otherwise above its ends
    cell = np.diff(survey.places, axis=1).max(axis=1, keepdims=True)
    if np.all(speeds[0] - np.abs(speeds[1]) * cell > 0.0):
        return stretches
    places, values = extremes_among(speed, survey.places, *speeds)
    before, after = values[:-1] < 0.0, values[1:] < 0.0
    low, high = places[:-1].copy(), places[1:].copy()
    whole = low < high  # not across a knot
    turns = whole & (before != after)
    ends, signs = (low[turns], high[turns]), (values[:-1][turns], values[1:][turns])
    roots = bracketed_root(lambda t: speed(t)[0], *ends, _ROOT * curve.program.grain, signs)
    low[turns & after] = roots[after[turns]]
    high[turns & before] = roots[before[turns]]
    kept = whole & (before | after) & (low < high)
    stretches += zip(low[kept].tolist(), high[kept].tolist(), strict=True)
    return _joined(sorted(stretches), _GAP * curve.program.grain)


def _joined(stretches: list[tuple[float, float]], gap: float) -> list[tuple[float, float]]:
    """Return stretches, with those joined that are at most a `gap` apart."""
    joined: list[tuple[float, float]] = []
    for low, high in stretches:
        if joined and low - joined[-1][1] <= gap:
            joined[-1] = (joined[-1][0], max(joined[-1][1], high))
        else:
            joined.append((low, high))
    return joined


def over_the_end(
    stretches: Sequence[tuple[float, float]], program: Program
) -> list[list[tuple[float, float]]]:
    """Return stretches of a turn one by one, with a stretch across the turn's end kept together.

    Parameters
    ----------
    stretches : sequence of (float, float)
        Cam angles, rad, in rising order, cut at the end of the turn.
    program : Program
        The lift.

    Returns
    -------
    list of lists
        Each with one stretch, or with the two parts of one, that after the end first.
    """
    parts = [[stretch] for stretch in stretches]
    both = len(parts) > 1 and stretches[0][0] == 0.0 and stretches[-1][1] >= program.period
    if program.closed and both:
        return [*parts[1:-1], [stretches[0], stretches[-1]]]
    return parts


@dataclass(frozen=True, kw_only=True)
class Size(ShortRepr):
    """The size of a profile.

    Parameters
    ----------
    perimeter, area : float, mm and mm^2
        Length of the profile, and area inside it.
    area_error : float, mm^2
        Estimated error of the area inside the computed curve: of quadrature, and rounding.
    """

    perimeter: float
    area: float
    area_error: float


def size_of(segments: ProfileSegments, nodes: int = _GAUSS, most: int = _MOST_CELLS) -> Size:
    """Return perimeter and area of a closed curve, by Gauss-Legendre quadrature of every segment.

    Parameters
    ----------
    segments : ProfileSegments
        Closed; mirrored or not.
    nodes : int
        Nodes per cell.
    most : int
        Largest number of cells of a segment.

    Returns
    -------
    Size
        Its error includes the difference from the result with half as many cells.
    """
    cells = _CELLS
    sizes, _ = _integrals(segments, cells, nodes)
    while True:
        cells, before = 2 * cells, sizes
        sizes, rounding = _integrals(segments, cells, nodes)
        changes = np.abs(sizes - before)
        if np.all(changes <= _AGREED * sizes) or cells >= most:
            break
    perimeter, area = sizes.tolist()
    return Size(
        perimeter=perimeter,
        area=area,
        area_error=float(changes[1]) + rounding + _ROUNDING * area,
    )


def _integrals(segments: ProfileSegments, cells: int, nodes: int) -> tuple[Array, float]:
    """Return perimeter and area with given numbers of cells per segment, and nodes per cell.

    Also the error of the area from the rounding of angles, of nodes and of ends, which are large
    where a curve moves far within such a rounding.
    """
    places, weights = gauss_rule(nodes)
    share = ((np.arange(cells)[:, None] + places) / cells).ravel()
    weight = np.tile(weights / cells, cells)
    count = len(segments.start)
    index = np.repeat(np.arange(count), len(share))
    run = (segments.end - segments.start)[index]
    parameter = segments.start[index] + np.tile(share, count) * run
    points, velocities = segments.moving(index, parameter)
    rates = np.stack([np.abs(velocities), 0.5 * (np.conj(points) * velocities).imag])
    grain = np.spacing(np.maximum(np.abs(segments.start), np.abs(segments.end)))
    rounding = float(np.abs(rates[1]).reshape(count, -1).max(axis=1) @ grain)
    length, swept = rates * run * np.tile(weight, count)
    return np.array([math.fsum(np.abs(length)), abs(float(swept.sum()))]), rounding
