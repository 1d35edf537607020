"""What stands on leaders in the views of a part: radii, holes, marks, tolerance frames, arrows.

Holes of one size at equal angles on one circle are a *pattern*, with one diameter, the circle and
the direction of the first; other holes have a number, and their positions in the table.

Depends on parts, drawings and sheets.
"""

from __future__ import annotations

import cmath
import math
from typing import Final

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Array, Plane
from gearcam.parts.body import Part
from gearcam.parts.fits import FitSize
from gearcam.parts.shapes import Circle, Loop, true_points
from gearcam.pictures.drawings import SLOT
from gearcam.sheets.board import OVERHANG, Board
from gearcam.sheets.dimensions import ARROW, diameter_text
from gearcam.sheets.paper import Heading
from gearcam.sheets.sheet import CENTERLINE, DIMENSION, fine, length_text
from gearcam.sheets.symbols import DATUM, frame
from gearcam.sheets.wheel import SAME, UP, GrooveSizes, Sense, Wheel, fitted, floor_of, holes_of

_FAN: Final = np.radians([0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0, 60.0, -60.0, 75.0, -75.0])
"""Directions of a leader from that across an edge, rad."""

_FLAT: Final = 1e-3
"""Largest distance of an edge of the section from a face, over the radius, that counts as none."""

_LOW: Final = 0.05
"""Differences of heights over that of a wall or a chamfer that do not count."""

PAST_SECTION: Final = 5.0
"""How far the line of theta = 0 goes past the letters of a section that it is on, mm of paper."""

_PLACES: Final = 12
"""Most places on arcs about the axis that are tried for the leader of a radius."""

_NEAR: Final = 0.1
"""Angle to both sides of theta = 0 at which the outline is looked at, rad."""


def zero_line(board: Board, wheel: Wheel, turning: Sense) -> complex:
    """Draw where the angle of a cam is 0.

    Parameters
    ----------
    board : Board
        The sheet.
    wheel : Wheel
        The cam.
    turning : Sense
        How it turns.

    Returns
    -------
    complex, mm
        The end of the line.
    """
    ahead = wheel.points * cmath.rect(1.0, -turning.zero)
    reach = float(ahead.real[np.abs(np.angle(ahead)) < _NEAR].max())
    past = 8.0 + (PAST_SECTION if turning.upright else 0.0)
    end = cmath.rect(reach + past * board.unit, turning.zero)
    board.line(CENTERLINE, 0j, end)
    return end


def turning_arrow(board: Board, wheel: Wheel, turning: Sense, end: complex) -> None:
    """Say where the angle of a cam is 0, and how it turns.

    Parameters
    ----------
    board : Board
        The sheet.
    wheel : Wheel
        The cam.
    turning : Sense
        How it turns.
    end : complex, mm
        The end of the line where its angle is 0.
    """
    board.label(end, "theta = 0", ("theta = 0 at", f"{decimal(math.degrees(turning.zero))} deg"))
    radius = 0.5 * (wheel.radius + float(np.abs(wheel.points).min()))
    sense = -1.0 if turning.clockwise else 1.0
    arc = radius * np.exp(1j * (turning.zero + sense * np.linspace(0.3, 1.2, 19)))
    board.line(DIMENSION, *arc.tolist())
    tip = complex(arc[-1])
    board.arrow(tip, 1j * sense * tip / abs(tip))
    words = f"turns {'' if turning.clockwise else 'counter-'}clockwise"
    board.label(complex(arc[9]), words, ("rotation", words))


def frames(board: Board, wheel: Wheel, heading: Heading, left: float, walls: Plane) -> None:
    """Draw on a `board` the tolerance frames of a `heading`.

    Parameters
    ----------
    board : Board
        The sheet.
    wheel : Wheel
        The part.
    heading : Heading
        With the tolerances.
    left : float, mm
        Where its section begins.
    walls : (n,) complex array, mm
        The outline, or a wall of the groove, on the sheet.
    """
    notes = heading.notes
    if notes.profile_tolerance:
        spot = complex(walls[np.argmax((walls * cmath.rect(1.0, -0.7)).real)])
        related = (DATUM,) if wheel.bore else ()
        frame(board, spot, "profile", fine(notes.profile_tolerance), *related)
    if notes.runout and wheel.turns and wheel.bore:
        spot, way = _running(wheel, OVERHANG * board.unit)
        spot += left - wheel.part.ends[0]
        frame(board, spot, "runout", fine(notes.runout), DATUM, angles=way + _FAN)


def _running(wheel: Wheel, least: float) -> tuple[complex, float]:
    """Return a point of the section where it is cut outside, and the direction away from it.

    On the outside if it is a cylinder, at least a length `least` of it, mm; else on the back.
    """
    (middles, ways), flat = wheel.edges, _FLAT * wheel.high.imag
    long = np.abs(ways)
    outside = np.abs(middles.imag - wheel.high.imag) + np.abs(ways.imag) < flat
    cylinder = wheel.round and (long * outside).max() > least
    back = (np.abs(middles.real) + np.abs(ways.real) < flat) & (middles.imag > 0.0)
    number = int(np.argmax(long * (outside if cylinder else back)))
    middle, way = complex(middles[number]), complex(ways[number])
    # beside the title of the section, and beside a hub
    return middle + 0.4 * math.copysign(1.0, way.real + way.imag) * way, UP if cylinder else math.pi


def callouts(board: Board, wheel: Wheel, side: float) -> None:
    """Draw on a `board` the leaders of a `wheel`, whose section begins at x = `side`, mm."""
    part, shift = wheel.part, side - wheel.part.ends[0]
    _holes(board, part, wheel.origin)
    if wheel.turns and (part.inner or not wheel.round):
        _radii(board, wheel)
    for opening in part.openings:
        if opening.kind == SLOT and isinstance(opening.shape, Loop):
            _slot(board, opening.shape)
    if wheel.shown.screw is not None and part.screw is not None:
        screw = wheel.shown.screw
        edge = complex(shift + screw.middle, math.copysign(screw.edge.reach, screw.angle))
        turned = f"{decimal(math.degrees(part.screw.angle) % 360.0)} deg"
        board.label(edge, f"set screw {screw.size}")
        board.rows.append((f"set screw {screw.size}, direction", turned))
    for mark in part.marks:
        words = f"mark {diameter_text(mark.diameter)}, {length_text(mark.depth)} deep"
        board.callout(mark.edge, words, "label")
        board.rows.append((words, position(mark.center - wheel.origin)))
    if part.arrow is not None:
        board.rows.append(("arrow, place by the DXF", f"{length_text(part.arrow.depth)} deep"))
    for recess in part.recesses:
        points, words = recess.edge.polyline(part.tolerance), f"{length_text(recess.width)} wide"
        weights = (points * cmath.rect(1.0, -2.2)).real
        _at(board, weights - weights.min(), points, "groove ", words)
    if wheel.unrolled is not None:
        _groove(board, wheel, wheel.unrolled.groove, shift)
    if part.chamfer:
        _chamfer(board, wheel, shift)


def _groove(board: Board, wheel: Wheel, groove: GrooveSizes, shift: float) -> None:
    """Say how wide and deep the groove of a cam in space is, or how high its wall, at the floor."""
    middles, ways = wheel.edges
    over = (middles.imag - groove.floor) / groove.depth
    floor = (over > -_LOW) & (over < 0.5) & (np.abs(ways.real) > np.abs(ways.imag))
    name, words = "wall ", f"{length_text(groove.depth)} high"
    if groove.width:
        name, words = (
            "groove ",
            f"{length_text(groove.width)} wide, {length_text(groove.depth)} deep",
        )
    _at(board, np.abs(ways.real) * floor, middles + shift, name, words)


def _chamfer(board: Board, wheel: Wheel, shift: float) -> None:
    """Say how large a chamfer is at the one that is farthest up in the section."""
    (middles, ways), size = wheel.edges, wheel.part.chamfer
    across, up = np.abs(ways.real), np.abs(ways.imag)
    slanted = (np.abs(across - up) < _LOW * size) & (up > _LOW * size) & (up < 1.1 * size)
    faces = np.array([level for one in wheel.part.layers for level in (one.low, one.high)])
    slanted &= np.abs(middles.real[:, None] - faces).min(axis=1) < size
    height = middles.imag - middles.imag.min() + 1.0
    _at(board, height * slanted, middles + shift, "", f"{length_text(size)} x 45°")


def _at(board: Board, weights: Array, points: Plane, name: str, words: str) -> None:
    """Say `words` with a leader to the point of the largest weight; the table, if all are 0."""
    best, row = int(np.argmax(weights)), (name.strip() or "chamfer", words)
    if not weights[best] > 0.0:
        board.rows.append(row)
    else:
        board.label(complex(points[best]), f"{name}{words}", row)


def direction(board: Board, wheel: Wheel, keyed: Loop, zero: float) -> None:
    """Draw the angle to a keyway or flat; if it is 0, the table has it.

    Parameters
    ----------
    board : Board
        The sheet.
    wheel : Wheel
        The part.
    keyed : Loop
        Its bore.
    zero : float, rad
        The direction from which the angle is counted.
    """
    kind, floor = floor_of(keyed)
    way = cmath.phase(complex(floor.mean()))
    turn = math.remainder(way - zero, 2.0 * math.pi)
    words = f"{decimal(abs(math.degrees(turn)))}°"
    row = f"{kind}, direction", f"{decimal(math.degrees(way) % 360.0)} deg"
    away = float(np.abs(keyed.points).max()) + 2.0 * OVERHANG * board.unit
    away = max(away, 4.0 * ARROW * board.unit / max(abs(turn), SAME))
    if away > 1.2 * float(np.abs(wheel.points).max()):
        board.rows.append(row)
        return
    board.line(CENTERLINE, 0j, cmath.rect(away + OVERHANG * board.unit, way))
    arc = away * np.exp(1j * (zero + turn * np.linspace(0.0, 1.0, 37)))
    board.line(DIMENSION, *arc.tolist())
    for tip, sense in ((complex(arc[0]), -1.0), (complex(arc[-1]), 1.0)):
        board.arrow(tip, math.copysign(sense, turn) * 1j * tip / abs(tip))
    board.label(complex(arc[18]), words, row)


def _radii(board: Board, wheel: Wheel) -> None:
    """Draw the largest and the smallest radius of the teeth from the axis."""
    # of a ring those of its inner edge
    teeth = true_points(wheel.part.inner[-1:]) if wheel.part.inner else wheel.points
    reach = np.abs(teeth)
    for radius, word in ((float(reach.max()), "max"), (float(reach.min()), "min")):
        if abs(radius - wheel.tips) < SAME:
            continue  # a diameter
        # all points on arcs about the axis, not the one that rounding chooses
        alike = teeth[np.abs(reach - radius) < SAME]
        alike = alike[np.linspace(0, len(alike) - 1, min(_PLACES, len(alike))).astype(int)]
        point = complex(alike[0])
        circle, words = Circle(center=0j, diameter=2.0 * radius), f"(R{length_text(radius)} {word})"
        if not board.callout(circle, words, "radius", angles=np.angle(alike)):
            # a leader away from the part, not quite from the axis
            row, outwards = (f"{word}. radius from axis", length_text(radius)), cmath.phase(point)
            board.label(point, words, row, angles=outwards + _FAN)


def _holes(board: Board, part: Part, origin: complex) -> None:
    """Draw the centre lines of all holes, then their sizes, large ones first."""
    groups: dict[tuple[int, int], list[Circle]] = {}
    for circle in holes_of(part):
        key = round(circle.diameter / SAME), round(abs(circle.center) / SAME)
        groups.setdefault(key, []).append(circle)
    patterns = [group for group in groups.values() if _even(group)]
    singles = [one for group in groups.values() if group not in patterns for one in group]
    for group in patterns:
        _ring(board, group)
    named = [
        (hole, f"hole {number} {hole_text(hole)}") for number, hole in enumerate(singles, start=1)
    ]
    for hole in singles:
        board.centre(hole)
    for hole, words in sorted(named, key=lambda one: -one[0].diameter):
        board.callout(hole, words)
    for group in patterns:
        _pattern(board, group)
    for hole, words in named:
        board.rows.append((words, position(hole.center - origin)))


def position(place: complex) -> str:
    """Return a `place` as text of a table."""
    return f"X {length_text(place.real)}  Y {length_text(place.imag)}"


def hole_text(hole: Circle) -> str:
    """Return the diameter of a hole, with tolerance class and limits if it has them."""
    size = hole.diameter
    return fitted(diameter_text(size), size if isinstance(size, FitSize) else None)


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
    first, words = cmath.phase(one.center), f"{count} x {hole_text(one)}"
    board.callout(one, words)
    # the arrow points at the circle between two holes
    between = first + math.pi / count * np.array([1.0, 3.0, -1.0, -3.0, 0.5, -0.5, 1.5, -1.5])
    ring = Circle(center=0j, diameter=2.0 * abs(one.center))
    size = diameter_text(ring.diameter)
    board.callout(ring, size, angles=between)
    board.rows.append((words, f"on {size}, at {decimal(math.degrees(first))} deg"))


def _slot(board: Board, shape: Loop) -> None:
    """Say of a slot along an arc about the axis: width, mean radius and end angles."""
    corners = shape.points
    half = len(corners) // 2
    radii = np.abs(corners[[0, half]])
    middle, width = float(radii.mean()), float(radii[0] - radii[1])
    sweep = float(np.angle(corners[1:half] / corners[: half - 1]).sum())
    first = math.degrees(cmath.phase(complex(corners[0])))
    end = Circle(center=complex(corners[[half - 1, half]].mean()), diameter=width)
    words, last = f"slot R{length_text(0.5 * width)}", first + math.degrees(sweep)
    board.callout(end, words, "radius", row=("slot, width", length_text(width)))
    board.rows.append(("slot, mid radius", length_text(middle)))
    board.rows.append(("slot, ends at", f"{decimal(first)}, {decimal(last)} deg"))
