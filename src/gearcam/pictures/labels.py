"""Names in a picture, each beside what it names, where few lines are.

Depends on drawings, numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from gearcam.numeric.arrays import Plane
from gearcam.pictures.markup import GLYPH

_AROUND: Final = 12
"""Directions in which a place is looked for."""

_RINGS: Final = (1.0, 1.7, 2.6)
"""Distances at which it is looked for, in the smallest one."""

_FAR: Final = 0.4
"""What a larger distance costs, in points of lines below the name."""

_ON_NAME: Final = 50.0
"""What a place on another name costs, in points of lines below it."""


class Label(NamedTuple):
    """A name in a picture.

    Attributes
    ----------
    text : str
        The name.
    center : complex, mm
        Its middle.
    size : float, mm
        Height of its letters.
    """

    text: str
    center: complex
    size: float

    @property
    def corners(self) -> tuple[complex, complex]:
        """The corners of its box, mm."""
        half = 0.5 * complex(GLYPH * self.size * max(1, len(self.text)), 1.1 * self.size)
        return self.center - half, self.center + half


def labelled(
    wanted: Sequence[tuple[str, complex]],
    lines: Plane,
    size: float,
    gap: float,
    others: Sequence[Label] = (),
) -> tuple[Label, ...]:
    """Return names beside places.

    Parameters
    ----------
    wanted : sequence of (str, complex)
        Names and their places, mm; the first ones have the first choice.
    lines : (n,) complex array, mm
        Points of lines on which names are badly read.
    size : float, mm
        Height of letters.
    gap : float, mm
        Least distance of a name from its place.
    others : sequence of Label
        Names that are there already.

    Returns
    -------
    tuple of Label
    """
    made: list[Label] = []
    for text, at in wanted:
        beside = _beside(text, at, size, gap)
        costs = [_cost(label, lines, [*others, *made]) + _FAR * ring for ring, label in beside]
        made.append(beside[int(np.argmin(costs))][1])
    return tuple(made)


def _beside(text: str, at: complex, size: float, gap: float) -> list[tuple[int, Label]]:
    """Return labels around a place and the numbers of their rings."""
    low, high = Label(text, 0j, size).corners
    half, choices = 0.5 * (high - low), []
    for ring, far in enumerate(_RINGS):
        for k in range(_AROUND):
            angle = math.tau * (k + 1.5) / _AROUND
            x, y = math.cos(angle), math.sin(angle)
            # the box touches a circle around the place
            reach = gap * far + min(half.real / max(abs(x), 1e-9), half.imag / max(abs(y), 1e-9))
            choices.append((ring, Label(text, at + reach * complex(x, y), size)))
    return choices


def _cost(label: Label, lines: Plane, others: Sequence[Label]) -> float:
    """Return how badly a label would be read."""
    low, high = label.corners
    inside = (lines.real > low.real) & (lines.real < high.real)
    inside &= (lines.imag > low.imag) & (lines.imag < high.imag)
    met = sum(_meet(label.corners, other.corners) for other in others)
    return float(np.count_nonzero(inside)) + _ON_NAME * met


def _meet(one: tuple[complex, complex], other: tuple[complex, complex]) -> bool:
    """Return whether two boxes overlap."""
    apart = one[0].real >= other[1].real or other[0].real >= one[1].real
    return not (apart or one[0].imag >= other[1].imag or other[0].imag >= one[1].imag)
