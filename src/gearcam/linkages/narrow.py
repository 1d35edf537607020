"""Where a linkage moves fast: knots about places at which a part of it is nearly singular.

What a part needs to close has a root such as ``sqrt(a^2 + b^2*h^2)``, h the driver's angle from
where least is left. The motion happens there within a few a/b, which is the distance of the complex
zero: this may be less than the step of a search.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from gearcam.linkages.linkage import in_cycle
from gearcam.numeric.arrays import Array, Ints, apart, away, distinct, divided
from gearcam.numeric.piecewise import LEAST_PLACES, places_between

_STEPS: Final = 3.0
"""Width, in steps of a search, from which it sees a place without knots of its own."""

_WIDER: Final = 6.0
"""How far each knot is from the place, in distances of the one before."""

_CELL: Final = 8.0
"""Steps of a search in which it sees all that a law does in a cell."""

_APART: Final = 1e-9
"""Distance from other knots below which none is added, rad."""


NARROWEST: Final = 1e-7
"""Least distance off that the driver's angle resolves well in double precision, rad."""


class Narrow(NamedTuple):
    """A zero of what is left of a part before it is singular, close to the driver's range.

    Attributes
    ----------
    place : float, rad
        The driver's angle next to it.
    width : float, rad
        How far off it is.
    number : int
        Of what is left.
    passed : bool
        Whether the driver passes it; otherwise it is beyond an end of the range.
    """

    place: float
    width: float
    number: int
    passed: bool


def narrow_places(
    left: Callable[[Array], Array], lows: Sequence[Array], knots: Array
) -> tuple[Narrow, ...]:
    """Return where a part of a linkage is so nearly singular that a search does not see it.

    Parameters
    ----------
    left : callable
        ``left(q)``, (3, m, n): what is left of the part before it is singular (see
        `gearcam.linkages.dyads.Solved`), with two derivatives by the driver's angle.
    lows : sequence of m arrays, rad
        Where each is smallest, but for change points.
    knots : (k,) array, rad
        The driver's angles from the first to the last one.

    Returns
    -------
    tuple of Narrow
    """
    within, places = _seen(knots), np.concatenate(lows)
    number = np.repeat(np.arange(len(lows)), [low.size for low in lows])
    found = left(places)[:, number, np.arange(places.size)]
    return tuple(one for one in _zeros(places, found, number) if 0.0 < one.width < within)


def _seen(knots: Array) -> float:
    """Return the width from which a search sees a place without knots of its own, rad."""
    return _STEPS * float(np.diff(places_between(knots)).max())


def with_narrow_places(found: Sequence[Narrow], knots: Array, *, closed: bool) -> Array:
    """Return knots between which searches see where a part of a linkage is nearly singular.

    Parameters
    ----------
    found : sequence of Narrow
        Where it is.
    knots : (k,) array, rad
        The driver's angles from the first to the last one.
    closed : bool
        Whether the motion repeats after the last knot.

    Returns
    -------
    (n,) array, rad
        The knots, with more of them if there are such places.
    """
    if not found:
        return knots
    within = _seen(knots)
    places = np.array(
        [
            one.place + sign * one.width * _WIDER**power
            for one in found
            for power in range(1 + int(np.log(within / one.width) / np.log(_WIDER)))
            for sign in (-1.0, 1.0)
        ]
    )
    low, high = knots[0], knots[-1]
    if closed:
        _, places = in_cycle(places, (low, high))
    inside = apart(np.sort(places[(places > low) & (places < high)]), _APART)
    return _with(inside, knots, within / _STEPS)


def _with(places: Array, knots: Array, step: float) -> Array:
    """Return knots with more places, between which a search has no wider step."""
    # more intervals have fewer points each
    even = divided(knots, np.ceil(np.diff(knots) / (LEAST_PLACES * step)).astype(int))
    return distinct(even, away(places, even, _APART))


def with_cells(cells: Sequence[Array], knots: Array) -> Array:
    """Return knots between which searches see all that the laws of drives do.

    Parameters
    ----------
    cells : sequence of (n,) array, rad
        Of each law the ends of the cells in which its expansion resolves it, rising.
    knots : (k,) array, rad
        The driver's angles from the first to the last one.

    Returns
    -------
    (m,) array, rad
        The knots, with more of them where cells are narrower than a search sees.
    """
    step = float(np.diff(places_between(knots)).max())
    found = [end for ends in cells for end in _around(ends, step)]
    return _with(distinct(np.array(found)), knots, step) if found else knots


def _around(ends: Array, step: float) -> Iterator[float]:
    """Yield the ends of runs of cells that are too narrow for a step of a search.

    A run is so short that the least number of places between its ends shows each of its cells.
    """
    begin, least = math.nan, math.nan
    for low, high in pairwise(ends.tolist()):
        width = high - low
        if width >= _CELL * step:
            if not math.isnan(begin):
                yield low
            begin = math.nan
        elif not high - begin <= LEAST_PLACES / _CELL * min(least, width):
            yield low
            begin, least = low, width
        else:
            least = min(least, width)
    if not math.isnan(begin):
        yield float(ends[-1])


def _zeros(places: Array, left: Array, number: Ints) -> Iterator[Narrow]:
    """Yield the zeros next to places: the real part, and how far off it is.

    The zero of the Taylor polynomial of second order: a complex one next to a minimum, a real one
    beyond an end of the driver's range.
    """
    value, slope, bend = left
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(slope * slope - 2.0 * value * bend + 0j)
        zeros = -2.0 * value / (slope + np.where(slope < 0.0, -root, root))
    for place, zero, which in zip(places.tolist(), zeros.tolist(), number.tolist(), strict=True):
        if zero.imag == 0.0:
            yield Narrow(place, abs(zero), which, passed=False)
        else:
            yield Narrow(place + zero.real, abs(zero.imag), which, passed=True)
