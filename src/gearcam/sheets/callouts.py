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
from gearcam.parts.body import Part, ScrewHole
from gearcam.parts.fits import FitSize
from gearcam.parts.shapes import Circle, Loop, true_points
from gearcam.pictures.drawings import SLOT
from gearcam.sheets.board import OVERHANG, Board
from gearcam.sheets.dimensions import diameter_text
from gearcam.sheets.paper import Heading
from gearcam.sheets.sheet import CENTERLINE, DIMENSION, fine, length_text
from gearcam.sheets.symbols import frame
from gearcam.sheets.wheel import SAME, Sense, Wheel, fitted, holes_of

_NEAR: Final = 0.1
"""Angle to both sides of theta = 0 at which the outline is looked at, rad."""


def turning_arrow(board: Board, wheel: Wheel, turning: Sense) -> None:
    """Draw on a `board` where the angle of a cam, a `wheel`, is 0, and how it is `turning`."""
    ahead = wheel.points * cmath.rect(1.0, -turning.zero)
    reach = float(ahead.real[np.abs(np.angle(ahead)) < _NEAR].max())
    end = cmath.rect(reach + 8.0 * board.unit, turning.zero)
    board.line(CENTERLINE, 0j, end)
    board.label(end, "theta = 0", ("theta = 0 at", f"{decimal(math.degrees(turning.zero))} deg"))
    radius = 0.5 * (wheel.radius + float(np.abs(wheel.points).min()))
    sense = -1.0 if turning.clockwise else 1.0
    arc = radius * np.exp(1j * (turning.zero + sense * np.linspace(0.3, 1.2, 19)))
    board.line(DIMENSION, *arc.tolist())
    tip = complex(arc[-1])
    board.arrow(tip, 1j * sense * tip / abs(tip))
    words = f"turns {'' if turning.clockwise else 'counter-'}clockwise"
    board.label(complex(arc[9]), words, ("rotation", words))


def frames(board: Board, wheel: Wheel, heading: Heading, left: float) -> None:
    """Draw on a `board` the tolerance frames of a `heading` at a `wheel`, its section at `left`."""
    notes, part = heading.notes, wheel.part
    if notes.profile_tolerance:
        spot = complex(wheel.points[np.argmax((wheel.points * cmath.rect(1.0, -0.7)).real)])
        related = ("A",) if wheel.bore else ()
        frame(board, spot, "profile", fine(notes.profile_tolerance), *related)
    if notes.runout and wheel.turns and wheel.bore:
        back = left + (part.hub.back if part.hub else 0.0)
        top = max(float(ends[-1]) for ends, _ in wheel.section.slabs if len(ends))
        # of an outline that is not round, that of the face
        spot = complex(back + 0.5 * part.width, top) if wheel.round else back + 0.95j * top
        frame(board, spot, "runout", fine(notes.runout), "A")


def callouts(board: Board, wheel: Wheel, side: float) -> None:
    """Draw on a `board` the leaders of a `wheel`, whose section begins at x = `side`, mm."""
    part = wheel.part
    _holes(board, part, wheel.origin)
    if wheel.turns and (part.inner or not wheel.round):
        _radii(board, wheel)
    for opening in part.openings:
        if opening.kind == SLOT and isinstance(opening.shape, Loop):
            _slot(board, opening.shape)
    if part.screw is not None:
        up = wheel.screwed[0] * part.screw.edge.reach
        edge = complex(side - part.ends[0] + part.screw.middle, up)
        board.label(edge, thread(part.screw))
    for mark in part.marks:
        words = f"mark {diameter_text(mark.diameter)}, {length_text(mark.depth)} deep"
        board.callout(mark.edge, words, "label")
        board.rows.append((words, position(mark.center - wheel.origin)))
    if part.arrow is not None:
        board.rows.append(("arrow, place by the DXF", f"{length_text(part.arrow.depth)} deep"))


def _radii(board: Board, wheel: Wheel) -> None:
    """Draw the largest and the smallest radius of the teeth from the axis."""
    # of a ring those of its inner edge
    teeth = true_points(wheel.part.inner[-1:]) if wheel.part.inner else wheel.points
    reach = np.abs(teeth)
    for radius, word in ((float(reach.max()), "max"), (float(reach.min()), "min")):
        if abs(radius - wheel.tips) < SAME:
            continue  # a diameter
        # the first of the points on an arc about the axis, not one that rounding chooses
        point = complex(teeth[np.argmax(np.abs(reach - radius) < SAME)])
        circle, words = Circle(center=0j, diameter=2.0 * radius), f"(R{length_text(radius)} {word})"
        if not board.callout(circle, words, "radius", angles=np.array([cmath.phase(point)])):
            # a leader without direction to the axis
            board.label(point, words, (f"{word}. radius from axis", length_text(radius)))


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


def thread(screw: ScrewHole) -> str:
    """Return the thread of a set screw in words."""
    return f"set screw {screw.size}"
