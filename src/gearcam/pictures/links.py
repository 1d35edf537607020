"""Shapes of links, slides, guides and pivots, as drawings of machines show them.

They are symbols: their joints are where they are, their widths are chosen to be seen.

Depends on drawings, numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import BORE, GROUND, MEMBER, Feature, Path

_DIRECTIONS: Final = 96
"""Corners of a round end: of a width of 10 mm it is within 3 um of a circle."""

_PIN: Final = 0.9
"""Diameter of a pin in half widths of a bar."""

_LONG, _WIDE = 2.6, 1.7
"""Half length and half width of a block in half widths of a bar."""

_HATCH: Final = 1.2
"""Length of hatching in half widths of a bar."""


def link(pins: Sequence[complex], half: float) -> tuple[Feature, ...]:
    """Return a link through its joints: a bar with round ends, or a plate through more than two.

    Parameters
    ----------
    pins : sequence of complex, mm
        Its joints, in its own frame.
    half : float, mm
        Half of its width.

    Returns
    -------
    tuple of Feature
        The link and the pins in it.
    """
    places = np.array(pins, dtype=np.complex128)
    around = np.exp(2j * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS)
    # the joint that is outermost in each direction, and half a width beyond it
    outer = (places[:, None] * around.conj()).real.argmax(axis=0)
    edge = Feature(layer=MEMBER, shape=Path(points=places[outer] + half * around))
    return edge, *(pin(at, half) for at in dict.fromkeys(pins))


def pin(at: complex, half: float) -> Feature:
    """Return the pin in a joint, `at`, mm, of a link that is twice `half` wide."""
    return Feature(layer=f"{MEMBER}_{BORE}", shape=Circle(center=at, diameter=_PIN * half))


def block(at: complex, direction: float, half: float) -> tuple[Feature, ...]:
    """Return a block that slides.

    Parameters
    ----------
    at : complex, mm
        Its middle.
    direction : float, rad
        Along which it slides.
    half : float, mm
        Half of the width of a link.

    Returns
    -------
    tuple of Feature
        The block and the pin in it.
    """
    corner = half * complex(_LONG, _WIDE)
    corners = np.array([-corner, corner.conjugate(), corner, -corner.conjugate()])
    edge = Path(points=at + corners * np.exp(1j * direction))
    return Feature(layer=MEMBER, shape=edge), pin(at, half)


def guide(ends: tuple[float, float], half: float) -> tuple[Feature, ...]:
    """Return a guide on the ground along the x axis of its frame, below the blocks on it.

    Parameters
    ----------
    ends : (float, float), mm
        First and last place of the middle of a block.
    half : float, mm
        Half of the width of a link.

    Returns
    -------
    tuple of Feature
        A line with hatching.
    """
    low, high = ends[0] - 2.0 * _LONG * half, ends[1] + 2.0 * _LONG * half
    return hatched(low - 1j * _WIDE * half, high - 1j * _WIDE * half, half)


def hatched(first: complex, last: complex, half: float) -> tuple[Feature, ...]:
    """Return a line on the ground, which is to the right of it.

    Parameters
    ----------
    first, last : complex, mm
        Its ends.
    half : float, mm
        Half of the width of a link.

    Returns
    -------
    tuple of Feature
        The line and its hatching.
    """
    way, size = last - first, _HATCH * half
    ahead = way / abs(way)
    count = max(3, min(40, round(abs(way) / size)))
    feet = first + way * (np.arange(count) + 0.7) / count
    slanted = size * ahead * complex(-0.7, -0.7)
    lines = [np.array([first, last]), *(np.array([foot, foot + slanted]) for foot in feet)]
    paths = (Path(points=points, closed=False) for points in lines)
    return tuple(Feature(layer=GROUND, shape=path) for path in paths)


def pivot(at: complex, half: float) -> tuple[Feature, ...]:
    """Return a joint that stands still: a foot on the ground.

    Parameters
    ----------
    at : complex, mm
        The joint.
    half : float, mm
        Half of the width of a link.

    Returns
    -------
    tuple of Feature
    """
    low, high = at + half * complex(-1.8, -3.0), at + half * complex(1.8, -3.0)
    foot = Path(points=np.array([at, low, high]))
    wide = 0.8 * half
    return Feature(layer=GROUND, shape=foot), *hatched(low - wide, high + wide, half)
