"""The sheet of a wheel: front view, side view, and a separate view of a bore that is not round.

The front view is in the part's own frame, seen from +z; the side view is the view from the left,
on the right (first angle), with the front face on its right. A bore with a keyway or a flat is
shown a second time, turned so that this is at the top. Holes of one size at equal angles on one
circle are a *pattern*, with one diameter, the circle and the direction of the first; other holes
have a letter, and their positions in the table.

Depends on parts, drawings and sheets.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Plane, bounds
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Edge, Hub, Part
from gearcam.parts.shapes import Circle, Loop, extremes, true_points
from gearcam.pictures.drawings import BORE, HOLE, INNER, SLOT, part_features, placed, reach
from gearcam.sheets.board import AROUND, CLEAR, FIRST_LEVEL, LEVEL, OVERHANG, TIGHT, Board
from gearcam.sheets.paper import begin, finish
from gearcam.sheets.sheet import (
    CENTERLINE,
    EDGE,
    GAP,
    HEIGHT,
    HIDDEN,
    RoundDimension,
    Sheet,
    Text,
    fine,
    text_width,
)

LEFT: Final = 24.0
BETWEEN: Final = 36.0
RIGHT: Final = 24.0
ABOVE: Final = 14.0
BORE_ROOM: Final = 44.0
"""Space for dimensions left of, between, right of and above the views, and for those of the bore's
view, mm of paper."""

SAME: Final = 1e-6
"""Sizes, mm, and angles, rad, that differ by less are equal."""


@dataclass(frozen=True, eq=False, kw_only=True)
class _Wheel:
    """A part with the data of its sheet; points are on the true curves.

    `points` are those of the outline, `toothed` those of the teeth, for a ring of its inner edge.
    """

    part: Part
    points: Plane
    toothed: Plane

    @property
    def low(self) -> complex:
        return bounds(self.points)[0]

    @property
    def high(self) -> complex:
        return bounds(self.points)[1]

    @property
    def round(self) -> bool:
        """Whether the outline is a circle around the axis, as for most rings and groove cams."""
        return float(np.ptp(np.abs(self.points))) < SAME

    @property
    def turns(self) -> bool:
        """Whether the axis lies within the outline; racks have no axis."""
        corners = self.part.contours[-1].polyline(self.part.tolerance)
        if not (self.part.turns and corners.all()):
            return False
        turn = float(np.angle(np.roll(corners, -1) / corners).sum())
        return abs(turn) > math.pi

    @property
    def placed(self) -> bool:
        """Whether hole positions refer to an origin that is not an axis."""
        return not self.turns and any(one.kind == HOLE for one in self.part.openings)

    @property
    def bore(self) -> Edge | None:
        return next((one.shape for one in self.part.openings if one.kind == BORE), None)

    @property
    def bore_radius(self) -> float:
        """Bore diameter, with a keyway or a flat that of the arc, mm; 0 without a bore."""
        if isinstance(self.bore, Loop):
            return float(abs(self.bore.points[0]))
        return 0.5 * self.bore.diameter if isinstance(self.bore, Circle) else 0.0


def wheel_sheet(part: Part, facts: Mapping[str, str], title: str) -> Sheet:
    """Return the sheet of a wheel.

    Parameters
    ----------
    part : Part
        The finished wheel; the front view of a stepped one shows the step in front.
    facts : mapping of str to str
        Rows of the parameter table, such as module and teeth; those of the holes follow.
    title : str
        First line of the title block.

    Returns
    -------
    Sheet
        With the name of the part.

    Raises
    ------
    ValueError
        If the part is too large for the smallest scale.
    """
    points = true_points(part.contours[-1:])
    toothed = true_points(part.inner[-1:]) if part.inner else points
    wheel = _Wheel(part=part, points=points, toothed=toothed)
    keyed = wheel.bore if isinstance(wheel.bore, Loop) else None
    shown = 2.0 * wheel.bore_radius if keyed else 0.0
    size = wheel.high - wheel.low + part.thickness + shown
    levels = 1 + len(part.bosses) + (part.hub is not None) + len(part.recesses)  # side view
    levels = max(levels, 1 + wheel.placed)
    below = FIRST_LEVEL + LEVEL * levels
    across = BETWEEN + RIGHT + (BORE_ROOM if keyed else 0.0)
    rows = len(facts) + len(part.openings) + 2
    room = complex(LEFT, below), complex(across, ABOVE)
    board = begin(size, room, wheel.low, rows)
    _front_view(board, wheel)
    side = wheel.high.real + BETWEEN * board.unit
    _side_view(board, wheel, side)
    if keyed:
        right = side + part.thickness + (RIGHT + 0.5 * BORE_ROOM) * board.unit
        _bore_view(board, keyed, right)
    _callouts(board, wheel)
    about = " R, X, Y and angles from the axis." if wheel.turns else ""
    about = " X, Y from the cross." if wheel.placed else about
    notes = [
        f"Chord tolerance of the outline: {fine(part.tolerance)} mm.",
        "For the outline see the DXF file of this part.",
        f"All sizes are finished sizes.{about}",
    ]
    return finish(board, name=part.name, title=title, facts=facts, notes=notes)


def _front_view(board: Board, wheel: _Wheel) -> None:
    part = wheel.part
    behind = {
        id(edge)
        for one in part.recesses
        if not one.front
        for edge in (one.edge, *(island.shape for island in one.openings))
    }
    for feature in part_features(part, -1):
        board.draw(HIDDEN if id(feature.shape) in behind else feature.layer, feature.shape)
    if part.hub is not None:
        circle = Circle(center=0j, diameter=part.hub.diameter)
        board.draw(EDGE if part.hub.front > 0.0 else HIDDEN, circle)
    if wheel.turns:
        low, high, over = wheel.low, wheel.high, OVERHANG * board.unit
        board.line(CENTERLINE, low.real - over, high.real + over)
        board.line(CENTERLINE, 1j * (low.imag - over), 1j * (high.imag + over))
    first = FIRST_LEVEL * board.unit
    left, low, right, high = extremes(wheel.points)
    if wheel.round:
        board.linear(left, right, low.imag - first, prefix="Ø")
        return
    if wheel.placed:
        _origin(board, wheel)
    board.linear(left, right, low.imag - first - LEVEL * board.unit * wheel.placed)
    board.linear(low, high, left.real - first, vertical=True)


def _origin(board: Board, wheel: _Wheel) -> None:
    """Draw the origin of a part without an axis, to which hole positions refer."""
    first, left, right = FIRST_LEVEL * board.unit, wheel.low.real, wheel.high.real
    side, way = (left, -2.0) if abs(left) < abs(right) else (right, 1.0)
    corner = complex(side, wheel.low.imag)
    board.centre(0j, 0.0)
    if abs(side) > SAME:
        board.linear(0j, corner, corner.imag - first)
    board.linear(0j, corner, side + way * first, vertical=True)


def _side_view(board: Board, wheel: _Wheel, left: float) -> None:
    """Draw the view from the left, with its back at x = `left`."""
    part, unit, hub = wheel.part, board.unit, wheel.part.hub or Hub(diameter=0.0)
    back, end = left + hub.back, left + part.thickness
    for layer in part.layers:
        low, high = back + layer.low, back + layer.high
        bottom, top = _span(layer.edge)
        _rectangle(board, complex(low, bottom), complex(high, top))
        for opening in layer.openings:
            for y in _span(opening.shape) if opening.kind == INNER else ():
                board.line(HIDDEN, complex(low, y), complex(high, y))
    _recesses(board, part, back)
    if wheel.turns:
        over = OVERHANG * unit
        board.line(CENTERLINE, left - over, end + over)
    radius = wheel.bore_radius
    for y in (-radius, radius) if radius else ():
        board.line(HIDDEN, complex(left, y), complex(end, y))
    base = wheel.low.imag
    lengths = [(back, back + part.width)]
    lengths += [(back + boss.low, back + boss.high) for boss in part.bosses]
    lengths += [(left, end)] if part.hub is not None else []
    lengths += [(back + one.low, back + one.high) for one in part.recesses]
    hidden = base if part.recesses else -0.5 * hub.diameter
    lengths.sort(key=lambda one: one[1] - one[0])  # short ones first: no crossings
    for level, (low, high) in enumerate(lengths):
        start, stop = (
            complex(x, base if x in (back, back + part.width) else hidden) for x in (low, high)
        )
        board.linear(start, stop, base - (FIRST_LEVEL + LEVEL * level) * unit)
    level = 0
    if isinstance(wheel.bore, Circle):
        at = end + FIRST_LEVEL * unit
        board.linear(end - 1j * radius, end + 1j * radius, at, vertical=True, prefix="Ø")
        level = 1
    if part.hub is not None:
        radius, front = 0.5 * hub.diameter, hub.front > 0.0
        x = end if front else left
        at = end + (FIRST_LEVEL + LEVEL * level) * unit if front else left - FIRST_LEVEL * unit
        board.linear(x - 1j * radius, x + 1j * radius, at, vertical=True, prefix="Ø")


def _recesses(board: Board, part: Part, back: float) -> None:
    """Draw the hidden edges of pockets in the side view."""
    for recess in part.recesses:
        low, high = back + recess.low, back + recess.high
        for y in (end for edge in recess.edges for end in _span(edge)):
            board.line(HIDDEN, complex(low, y), complex(high, y))
        floor, (bottom, top) = low if recess.front else high, _span(recess.edge)
        board.line(HIDDEN, complex(floor, bottom), complex(floor, top))


def _span(edge: Edge) -> tuple[float, float]:
    """Return the extent of an edge along y, mm."""
    low, high = bounds(reach(edge) if isinstance(edge, Loop) else true_points([edge]))
    return low.imag, high.imag


def _rectangle(board: Board, low: complex, high: complex) -> None:
    corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag)]
    for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
        board.line(EDGE, start, end)


def _bore_view(board: Board, bore: Loop, left: float) -> None:
    """Draw a bore to the right of x = `left`, with its keyway or flat at the top."""
    corners = bore.points
    kind, floor = ("keyway", corners[-2:]) if len(corners) == 5 else ("flat", corners[[0, -1]])
    radius, middle = float(abs(corners[0])), complex(floor.mean())
    unit, x, top, direction = board.unit, left + radius, abs(middle), cmath.phase(middle)
    board.draw(EDGE, placed(bore, Pose(0.5 * math.pi - direction, x)))
    board.centre(complex(x), max(radius, top))
    first = FIRST_LEVEL * unit
    below = -radius - first
    board.linear(x - radius, x + radius, below, prefix="Ø")
    half = 0.5 * float(abs(floor[1] - floor[0]))
    if kind == "keyway":
        board.linear(complex(x - half, top), complex(x + half, top), max(top, radius) + first)
    edge = complex(x - half, top)
    board.linear(complex(x, -radius), edge, x - radius - first, vertical=True)
    line = complex(x, below - 5.0 * unit - HEIGHT * unit)
    board.write(Text(text=f"bore, {kind} turned up", place=line, anchor="middle"))
    board.rows.append((f"{kind}, direction", f"{decimal(math.degrees(direction))} deg"))


def _callouts(board: Board, wheel: _Wheel) -> None:
    """Draw the leaders into the front view, those with fixed places first."""
    part = wheel.part
    _holes(board, part)
    if wheel.turns and (part.inner or not wheel.round):
        _radii(board, wheel)
    for opening in part.openings:
        if opening.kind == SLOT and isinstance(opening.shape, Loop):
            _slot(board, opening.shape)
    for mark in part.marks:
        words = f", {decimal(mark.depth)} deep"
        dimension = RoundDimension(
            center=mark.center, radius=0.5 * mark.diameter, prefix="mark ", suffix=words
        )
        if not board.round(dimension):
            board.rows.append(("mark", f"Ø{decimal(mark.diameter)}{words}"))


def _radii(board: Board, wheel: _Wheel) -> None:
    """Draw the largest and the smallest radius of the teeth from the axis."""
    reach = np.abs(wheel.toothed)
    for radius, words in ((float(reach.max()), "max"), (float(reach.min()), "min")):
        # the first of the points on an arc about the axis, not one that rounding chooses
        point = complex(wheel.toothed[np.argmax(np.abs(reach - radius) < SAME)])
        dimension = RoundDimension(center=0j, radius=radius, diameter=False, suffix=f" {words}")
        # a leader without direction to the axis
        direction = np.array([cmath.phase(point)])
        if not (board.round(dimension, direction) or board.label(point, dimension.label)):
            board.rows.append((f"{words}. radius from axis", decimal(radius)))


def _holes(board: Board, part: Part) -> None:
    """Draw the centre lines of all holes, then their sizes, large ones first."""
    groups: dict[tuple[int, int], list[Circle]] = {}
    for opening in part.openings:
        if opening.kind == HOLE and isinstance(opening.shape, Circle):
            circle, away = opening.shape, abs(opening.shape.center)
            key = round(circle.diameter / SAME), round(away / SAME)
            groups.setdefault(key, []).append(circle)
    patterns = [group for group in groups.values() if _even(group)]
    singles = [one for group in groups.values() if not _even(group) for one in group]
    for group in patterns:
        _ring(board, group)
    named = [
        RoundDimension(center=one.center, radius=0.5 * one.diameter, prefix=f"H{k} ")
        for k, one in enumerate(singles, start=1)
    ]
    for hole in named:
        inside = 2.0 * hole.radius * board.scale > text_width(hole.label) + TIGHT
        gap = (-CLEAR - GAP, HEIGHT + GAP + 2.0 * CLEAR) if inside else None
        board.centre(hole.center, hole.radius, gap)
    for hole in sorted(named, key=lambda one: -one.radius):
        board.round(hole)
    for group in patterns:
        _pattern(board, group)
    for hole in named:
        place = f"X {decimal(hole.center.real)}  Y {decimal(hole.center.imag)}"
        board.rows.append((hole.label, place))


def _even(circles: list[Circle]) -> bool:
    """Whether holes on one circle are at equal angles."""
    if len(circles) < 2:
        return False
    angles = np.sort([cmath.phase(circle.center) for circle in circles])
    steps = np.diff(np.append(angles, angles[0] + 2.0 * math.pi))
    return bool((np.abs(steps - 2.0 * math.pi / len(circles)) < SAME).all())


def _ring(board: Board, circles: list[Circle]) -> None:
    """Draw the centre lines of a pattern: its circle, and a radial line through each hole."""
    away = abs(circles[0].center)
    board.draw(CENTERLINE, Circle(center=0j, diameter=2.0 * away))
    arm = 0.5 * circles[0].diameter + 0.5 * OVERHANG * board.unit
    for circle in circles:
        spoke = arm / away * circle.center
        board.line(CENTERLINE, circle.center - spoke, circle.center + spoke)


def _pattern(board: Board, circles: list[Circle]) -> None:
    one, count = circles[0], len(circles)
    first = cmath.phase(one.center)
    size = RoundDimension(center=one.center, radius=0.5 * one.diameter, prefix=f"{count} x ")
    board.round(size, AROUND)
    # the arrow points at the circle between two holes
    between = first + math.pi / count * np.array([1.0, 3.0, -1.0, -3.0, 0.5, -0.5, 1.5, -1.5])
    ring = RoundDimension(center=0j, radius=abs(one.center))
    board.round(ring, between)
    board.rows.append((size.label, f"on {ring.label}, at {decimal(math.degrees(first))} deg"))


def _slot(board: Board, shape: Loop) -> None:
    """Dimension a slot along an arc about the axis: width, mean radius and end angles."""
    corners = shape.points
    half = len(corners) // 2
    radii = np.abs(corners[[0, half]])
    middle, width = float(radii.mean()), float(radii[0] - radii[1])
    sweep = float(np.angle(corners[1:half] / corners[: half - 1]).sum())
    first = math.degrees(cmath.phase(complex(corners[0])))
    place = complex(corners[[half - 1, half]].mean())
    end = RoundDimension(center=place, radius=0.5 * width, diameter=False, prefix="slot ")
    if not board.round(end):
        board.rows.append(("slot, width", decimal(width)))
    board.rows.append(("slot, mid radius", decimal(middle)))
    last = first + math.degrees(sweep)
    board.rows.append(("slot, ends at", f"{decimal(first)}, {decimal(last)} deg"))
