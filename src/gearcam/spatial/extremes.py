"""Extremes over the cam angle and the place along a roller.

They are found on a grid over boxes between knots and narrowed down around its best point, to
`NARROW` of the box.

Depends on numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from gearcam.base.errors import NotFiniteError
from gearcam.base.numerals import formatted, in_range
from gearcam.numeric.arrays import Array

NARROW: Final = 1e-9
"""Width, as a share of a box, to which an extreme is narrowed."""

_ALONG: Final = 7
"""Places along the roller at which extremes are looked for."""

_AROUND: Final = 24
"""Places in each interval between knots at which they are looked for."""

_FINE: Final = 15
"""Places in each direction around the best one, each time that it is narrowed: few large steps cost
less than many small ones."""

_MOST: Final = 100
"""Largest number of times: a dozen are usual."""

_BLOCK: Final = 1 << 14
"""Places at which a function is evaluated at once, many boxes together."""

_INSET: Final = 1e-12
"""Distance from knots at which their sides are looked at, as a share of an interval."""

_DECIMALS: Final = 5
"""Of degrees in words: what is beside a knot is at it."""

Box = tuple[float, float, float, float]
"""First and last cam angle, rad, first and last place along the roller, mm."""

OfPlaces = Callable[[Array, Array], Array]
"""``function(theta, x)`` of n cam angles, rad, and (n, k) places along a roller, mm."""


@dataclass(frozen=True, kw_only=True)
class Spot:
    """An extreme: its `value`, the cam angle `theta`, rad, and the place `x` on the roller, mm.

    It may be infinite, where nothing is limited. What is not a number is refused: no check would
    find it beyond a limit.

    Parameters
    ----------
    theta, x, value
        See above.
    start : str
        What places are measured from, in words.
    """

    theta: float
    x: float
    value: float
    start: str = "axis"

    def __post_init__(self) -> None:
        if math.isnan(self.value):
            raise NotFiniteError(f"an extreme {self.place}", self.value)

    @property
    def place(self) -> str:
        """Where it is, in words."""
        angle = in_range(round(math.degrees(self.theta), _DECIMALS), 0.0, 360.0, 5)
        return f"at {angle} deg, {formatted(self.x, 4)} mm from the {self.start}"


def boxes_between(cuts: Array, ends: tuple[float, float]) -> list[Box]:
    """Return the boxes between cuts; functions may jump at these.

    Parameters
    ----------
    cuts : (n,) array, rad
        Rising cam angles.
    ends : (float, float), mm
        First and last place along the roller.
    """
    return [
        (left + _INSET * (right - left), right - _INSET * (right - left), *ends)
        for left, right in pairwise(cuts.tolist())
    ]


def lowest(function: OfPlaces, boxes: Sequence[Box]) -> Spot:
    """Return the least value of a function in any of some boxes.

    Parameters
    ----------
    function : callable
        See `OfPlaces`; infinite where it does not count.
    boxes : sequence of Box
        Boxes of one place or more.
    """
    counts = _AROUND, _ALONG if any(box[3] > box[2] for box in boxes) else 1
    each = max(1, _BLOCK // (counts[0] * counts[1]))
    found = [_lowest_in(function, boxes[k : k + each], counts) for k in range(0, len(boxes), each)]
    return _narrowed(function, *min(found, key=lambda one: one[0].value))


def _lowest_in(
    function: OfPlaces, boxes: Sequence[Box], counts: tuple[int, int]
) -> tuple[Spot, Box]:
    """Return the lowest point of grids over boxes of cam angles and places, and its box."""
    start, end, low, high = np.array(boxes).T
    theta = np.linspace(start, end, counts[0], axis=1).ravel()
    x = np.repeat(np.linspace(low, high, counts[1], axis=1), counts[0], axis=0)
    values = function(theta, x)
    k, j = np.unravel_index(np.argmin(values), values.shape)
    spot = Spot(theta=float(theta[k]), x=float(x[k, j]), value=float(values[k, j]))
    return spot, boxes[int(k) // counts[0]]


def _narrowed(function: OfPlaces, spot: Spot, box: Box) -> Spot:
    """Return the lowest point near a point of a grid over a box.

    Around it a window of one step becomes smaller as long as the lowest point is inside it, and
    follows one that is at its border, such as along the end of what counts.
    """
    sizes = [(box[1] - box[0]) / (_AROUND - 1), (box[3] - box[2]) / (_ALONG - 1)]
    least = [NARROW * (box[1] - box[0]), NARROW * (box[3] - box[2])]
    for _ in range(_MOST):
        if sizes[0] <= least[0] and sizes[1] <= least[1]:
            break
        near = (
            max(box[0], spot.theta - sizes[0]),
            min(box[1], spot.theta + sizes[0]),
            max(box[2], spot.x - sizes[1]),
            min(box[3], spot.x + sizes[1]),
        )
        found, _ = _lowest_in(function, [near], (_FINE, _FINE if sizes[1] else 1))
        moved = found.value < spot.value
        at_border = moved and (
            (found.theta in near[:2] and found.theta not in box[:2])
            or (found.x in near[2:] and found.x not in box[2:])
        )
        spot = found if moved else spot
        sizes = sizes if at_border else [2.0 * size / (_FINE - 1) for size in sizes]
    return spot
