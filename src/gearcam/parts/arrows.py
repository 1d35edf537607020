"""Arrows in the front face, which show how a part moves: an arc about the axis, or a straight one.

An arrow is a line with a head, as wide and deep as its process can make. It lies where it leaves
its own width to all edges: among the longest that fit the one nearest to the middle of the metal.
Where none fits it is refused.

Depends on parts' shapes; shapely inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.numeric.arrays import Plane, as_pairs
from gearcam.parts.body import Arrow, Part
from gearcam.parts.openings import Workpiece
from gearcam.parts.shapes import Loop

if TYPE_CHECKING:
    from shapely import Polygon

LINES: Final = {
    "printing": (1.0, 0.6),
    "laser": (0.5, 0.2),
    "wire": (0.5, 0.2),
    "milling": (1.0, 0.3),
}
"""Width and largest depth of a line by process, mm: two passes of a nozzle of 0.4 mm and two
layers; a line that is engraved beside the cut; a cutter of 1 mm."""

DEPTH_PART: Final = 0.1
"""Largest depth of what is engraved, as a share of the width of the part."""

_HEAD: Final = (3.0, 3.5)
"""Width and length of the head, over the width of the line."""

_SWEEPS: Final = np.radians([60.0, 40.0, 25.0])
_LENGTHS: Final = (0.3, 0.15, 0.08)
"""Angles of arcs, and lengths of straight arrows over the part's, from the most wanted on."""

_PLACES: Final = 25
"""Radii, and directions or places, that are tried."""


def arrow(part: Part, work: Workpiece, way: complex, core: float) -> Arrow:
    """Return the arrow of a part.

    Parameters
    ----------
    part : Part
        The part.
    work : Workpiece
        With its process.
    way : complex
        How it moves: 1 counter-clockwise about its axis, -1 clockwise; of what slides the
        direction, a unit vector.
    core : float, mm
        Radius within which bore and hub lie.

    Returns
    -------
    Arrow

    Raises
    ------
    InfeasibleError
        If there is no room.
    """
    from shapely import Polygon, prepare, union_all

    line, depth = LINES[work.process]
    covered = [mark.edge for mark in part.marks]
    covered += [boss.edge for boss in part.bosses if boss.low > 0.0]
    edges = [part.steps[-1].edges, *((edge,) for edge in covered)]
    edges += [one.edges for one in part.recesses if one.front]
    whole, *used = (
        Polygon(outer, holes)
        for outer, *holes in ([work.points(edge) for edge in one] for one in edges)
    )
    free: Any = whole.difference(union_all(used)).buffer(-line, quad_segs=4)
    prepare(free)
    shapes = _arcs if part.turns else _straight
    for shape in shapes(free, way, line, core):
        if free.contains(Polygon(as_pairs(shape.polyline(0.1 * line)))):
            return Arrow(edge=shape, depth=min(depth, DEPTH_PART * part.width))
    what = f"there is no room for an arrow with a line of {line} mm"
    key = "blank.rotation_arrow"
    note = "leave it out, or fewer and smaller holes"
    raise work.refusal(what, None, None, note, (Adjustment(near={key: False}),), key)


def _arcs(free: Polygon, way: complex, line: float, core: float) -> Iterator[Loop]:
    """Yield arcs about the axis, the longest first, then those in the middle of the metal."""
    outer = float(np.abs(free.bounds).max()) if not free.is_empty else 0.0
    radii = np.linspace(core, outer, _PLACES + 2)[1:-1]
    radii = radii[np.argsort(np.abs(radii - 0.5 * (core + outer)), kind="stable")]
    turns = 2.0 * math.pi * np.arange(_PLACES) / _PLACES
    for sweep, radius in product(_SWEEPS.tolist(), radii.tolist()):
        for turn in turns.tolist() if radius * sweep >= 2.0 * _HEAD[1] * line else ():
            yield _arc(radius, 0.5 * math.pi + turn, sweep, way.real, line)  # from the top on


def _arc(radius: float, middle: float, sweep: float, hand: float, line: float) -> Loop:
    """Return an arrow along an arc about the origin, counter-clockwise if `hand` is 1."""
    flat = np.roll(_corners(radius * sweep, line), 1)
    angles = middle + hand * flat.real / radius
    points = np.asarray((radius - flat.imag) * np.exp(1j * angles), dtype=np.complex128)
    bend = math.tan(0.25 * (sweep - _HEAD[1] * line / radius))
    bulges = hand * bend * np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0])
    if hand < 0.0:  # mirrored: the other way round
        points, bulges = points[::-1], -np.roll(bulges[::-1], -1)
    return Loop(points=points, bulges=bulges)


def _corners(length: float, line: float) -> Plane:
    """Return the corners of an arrow to the right, about its middle, from the tail's lower one."""
    half, wide = 0.5 * line, 0.5 * _HEAD[0] * line
    tail, neck, tip = -0.5 * length, 0.5 * length - _HEAD[1] * line, 0.5 * length
    x = np.array([tail, neck, neck, tip, neck, neck, tail])
    return x + 1j * np.array([-half, -half, -wide, 0.0, wide, half, half])


def _straight(free: Polygon, way: complex, line: float, _: float) -> Iterator[Loop]:
    """Yield straight arrows, the longest first, then those in the middle of the metal."""
    if free.is_empty:
        return
    low, high = complex(*free.bounds[:2]), complex(*free.bounds[2:])
    middle, size = 0.5 * (low + high), high - low
    along = abs((size * way.conjugate()).real)
    steps = np.linspace(-0.5, 0.5, _PLACES)
    steps = steps[np.argsort(np.abs(steps), kind="stable")].tolist()
    for share in _LENGTHS:
        if share * along < 2.0 * _HEAD[1] * line:
            continue
        edge = way * _corners(share * along, line)
        for x, y in product(steps, steps):
            place = middle + complex(x * size.real, y * size.imag)
            yield Loop(points=place + edge, bulges=np.zeros(len(edge)))
