"""The sheet of a part: front view, section A-A, and a separate view of a bore that is not round.

The front view is in the part's own frame, seen from +z. The section is in the vertical plane
through the axis, or through the first hole of a part without one; it is seen from the left and
stands on the right (first angle), with the front face on its right. A keyway or a flat is turned
into its plane, and the bore shown a second time, so that this is at the top.

Depends on parts, drawings and sheets.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from typing import Final

from gearcam.base.inches import file_unit
from gearcam.base.numerals import decimal
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Hub, Part, ScrewHole
from gearcam.parts.shafts import keyway_of
from gearcam.parts.shapes import Circle, Loop, extremes
from gearcam.pictures.drawings import CENTRODE, box, part_features, place, placed
from gearcam.sheets.board import FIRST_LEVEL, LEVEL, OVERHANG, Board
from gearcam.sheets.callouts import callouts, frames, position, thread, turning_arrow
from gearcam.sheets.dimensions import Measure, diameter_text
from gearcam.sheets.paper import NO_VALUES, Heading, Values, begin, finish
from gearcam.sheets.sheet import (
    CENTERLINE,
    EDGE,
    HEIGHT,
    HIDDEN,
    Sheet,
    Text,
    fine,
    length_text,
    text_width,
)
from gearcam.sheets.symbols import datum, section_letters, section_line
from gearcam.sheets.wheel import SAME, UP, Sense, Teeth, Unrolled, Wheel, floor_of, holes_of

LEFT: Final = 24.0
BETWEEN: Final = 34.0
RIGHT: Final = 26.0
ABOVE: Final = 14.0
BELOW: Final = 5.0
BORE_ROOM: Final = 44.0
BORE_LEFT: Final = 18.0
TEXT_ROOM: Final = 8.0
UNROLLED: Final = 36.0
"""Space for dimensions left of, between, right of and above the views, more below the front view
for the line of the section, at least for those of the bore's view, of this left of the bore and
between it and a text, and for those of an unrolled outside, mm of paper."""


def part_sheet(
    part: Part,
    facts: Mapping[str, str],
    heading: Heading,
    *,
    turning: Sense | None = None,
    teeth: Teeth | None = None,
    values: Values = NO_VALUES,
    unrolled: Unrolled | None = None,
    notes: Sequence[str] = (),
) -> Sheet:
    """Return the sheet of a part.

    Parameters
    ----------
    part : Part
        The finished part; the front view of a stepped one shows the step in front.
    facts : mapping of str to str
        Rows of the table of data, such as module and teeth; those of the holes follow.
    heading : Heading
        What the title block says.
    turning : Sense, optional
        How a cam turns.
    teeth : Teeth, optional
        Of a wheel, or of a rack.
    values : Values
        A second table.
    unrolled : Unrolled, optional
        What is shown of a cam in space, of which the part is the blank.
    notes : sequence of str
        What the notes say besides, such as the file of the outline.

    Returns
    -------
    Sheet
        With the name of the part.

    Raises
    ------
    InfeasibleError
        If the part is too large for the smallest scale.
    """
    wheel = Wheel(part=part, teeth=teeth, unrolled=unrolled)
    size = wheel.high - wheel.low + part.thickness + (2.0 * wheel.radius if wheel.keyed else 0.0)
    levels = max(1 + len(part.bosses) + len(part.recesses), 1 + wheel.placed)
    below = BELOW + FIRST_LEVEL + LEVEL * levels
    across = BETWEEN + RIGHT
    if wheel.keyed is not None:
        wide = max(text_width(wheel.bore_text), text_width(wheel.floor_text))
        across += max(BORE_ROOM, BORE_LEFT + TEXT_ROOM + wide)
    rows = len(facts) + len(part.openings) + 2 + values.tall
    outside = box(unrolled.drawing.features)[1] if unrolled else 0j
    room = complex(LEFT, below + (UNROLLED if unrolled else 0.0)), complex(across, ABOVE)
    tall = 1j * outside.imag
    board = begin(part.name, size + tall, room, wheel.low - tall, rows, outside.real)
    side = wheel.high.real + BETWEEN * board.unit
    if unrolled is not None:
        _unrolled(board, unrolled, wheel.low - 1j * (below + 10.0) * board.unit)
    _front_view(board, wheel)
    _section(board, wheel, side)
    if wheel.keyed is not None:
        _bore_view(
            board, wheel, wheel.keyed, side + part.thickness + (RIGHT + BORE_LEFT) * board.unit
        )
    _front_sizes(board, wheel)
    _section_sizes(board, wheel, side)
    if turning is not None:
        turning_arrow(board, wheel, turning)
    section_letters(board, wheel.plane, wheel.low.imag, wheel.high.imag)
    callouts(board, wheel, side)
    if teeth is not None:
        at = position(teeth.first - wheel.origin)
        board.label(teeth.first, "tooth 1", ("tooth 1, tip", at))
    frames(board, wheel, heading, side)
    return finish(board, heading, facts, [*_notes(wheel), *notes], values)


def _notes(wheel: Wheel) -> list[str]:
    part, chamfer = wheel.part, wheel.part.chamfer
    about = " R, X, Y from the axis; angles from x, to the right." if wheel.turns else ""
    if not wheel.turns and (holes_of(part) or part.marks):
        side = "left" if wheel.origin.real == wheel.low.real else "right"
        about = f" X, Y from the {'cross' if wheel.placed else f'lower {side} corner'}."
    return [
        *([f"Chamfer {length_text(chamfer)} x 45 deg on both faces."] if chamfer else []),
        *(["Holes go right through."] if holes_of(part) else []),
        f"All sizes are finished sizes.{about}",
        *([wheel.unrolled.note] if wheel.unrolled else []),
    ]


def _front_view(board: Board, wheel: Wheel) -> None:
    part = wheel.part
    behind = {id(edge) for one in part.recesses if not one.front for edge in one.edges}
    for feature in part_features(part, -1):
        board.draw(HIDDEN if id(feature.shape) in behind else feature.layer, feature.shape)
    if part.hub is not None:
        circle = Circle(center=0j, diameter=part.hub.diameter)
        board.draw(EDGE if part.hub.front > 0.0 else HIDDEN, circle)
    if wheel.teeth is not None:
        board.draw(CENTRODE, wheel.teeth.pitch)
    low, high, over = wheel.low, wheel.high, OVERHANG * board.unit
    if wheel.turns:
        board.line(CENTERLINE, low.real - over, high.real + over)
    section_line(board, wheel.plane, low.imag, high.imag)


def _front_sizes(board: Board, wheel: Wheel) -> None:
    left, low, right, high = extremes(wheel.points)
    # sizes of an outline that its file defines are for reference, as those of a profile are
    across, up = ([Measure(*ends, aside=wheel.turns)] for ends in ((left, right), (low, high)))
    if wheel.tips and not wheel.part.inner:
        words = diameter_text(2.0 * wheel.tips)
        across, up = [Measure(-wheel.tips, wheel.tips, words)], []
    elif wheel.round:
        across, up = [Measure(left, right, diameter_text((right - left).real))], []
    elif wheel.placed:
        near = left if abs(wheel.low.real) < abs(wheel.high.real) else right
        corner = complex(near.real, wheel.low.imag)
        board.centre(Circle(center=0j, diameter=board.unit))
        across += [Measure(0j, corner)] if abs(corner.real) > SAME else []
        up += [Measure(0j, corner)]
    board.measure(across, wheel.low.imag - BELOW * board.unit)
    board.measure(up, wheel.low.real, vertical=True)


def _section(board: Board, wheel: Wheel, left: float) -> None:
    """Draw the section, with its back at x = `left`."""
    part = wheel.part
    shift, end = left - part.ends[0], left + part.thickness
    cut = wheel.section.metal if wheel.unrolled is None else wheel.unrolled.loops
    board.hatch([loop + shift for loop in cut])
    if wheel.unrolled is None:
        for start, stop in wheel.section.lines:
            board.line(EDGE, start + shift, stop + shift)
    else:
        for loop in cut:
            board.line(EDGE, *(loop + shift).tolist(), closed=True)
        for x in (left, end):
            board.line(EDGE, complex(x, -wheel.radius), complex(x, wheel.radius))
    over = OVERHANG * board.unit
    near = [c for c in holes_of(part) if abs(c.center.real - wheel.plane) < 0.5 * c.diameter]
    middles = [*([0.0] if wheel.turns else []), *(circle.center.imag for circle in near)]
    middles += [y for y, *_ in wheel.cut_teeth]
    for y in middles:
        board.line(CENTERLINE, complex(left - over, y), complex(end + over, y))
    if wheel.keyed is not None:
        _corner(board, wheel, wheel.keyed, left, end)
    if part.screw is not None:
        _screw(board, wheel, part.screw, shift)
    title = complex(0.5 * (left + end), wheel.high.imag + 6.0 * board.unit)
    board.write(Text(text="A-A", place=title, height=3.5, anchor="middle"))


def _unrolled(board: Board, unrolled: Unrolled, high: complex) -> None:
    """Draw the unrolled outside of a cam from its upper left corner on."""
    end = box(unrolled.drawing.features)[1]
    first, last = high - 1j * end.imag, high + end.real
    for feature in place(unrolled.drawing.features, Pose(0.0, first)):
        board.draw(feature.layer, feature.shape)
    around = Measure(first, complex(last.real, first.imag), aside=True)
    board.measure([around], first.imag)
    board.write(Text(text=unrolled.title, place=high + 3.0j * board.unit))


def _corner(board: Board, wheel: Wheel, bore: Loop, left: float, end: float) -> None:
    """Draw the edge where the side of a keyway, or a flat, meets the bore behind the plane."""
    _, floor = floor_of(bore)
    y = math.sqrt(max(wheel.radius**2 - 0.25 * float(abs(floor[1] - floor[0])) ** 2, 0.0))
    if y < abs(floor.mean()) - SAME:
        board.line(EDGE, complex(left, y), complex(end, y))


def _screw(board: Board, wheel: Wheel, screw: ScrewHole, shift: float) -> None:
    """Draw the hole of a set screw, and say its thread and place."""
    outer, middle, (side, inner) = screw.edge.reach, shift + screw.middle, wheel.screwed
    for x in (shift + screw.low, shift + screw.high):
        board.line(EDGE, complex(x, side * inner), complex(x, side * outer))
    over = OVERHANG * board.unit
    ends = complex(middle, side * (inner - over)), complex(middle, side * (outer + over))
    board.line(CENTERLINE, *ends)
    turned = math.degrees(screw.angle) % 360.0
    at = f"at {decimal(turned)} deg, z {length_text(screw.middle)} {file_unit().name}"
    board.rows.append((thread(screw), at))


def _section_sizes(board: Board, wheel: Wheel, left: float) -> None:
    part, hub = wheel.part, wheel.part.hub or Hub(diameter=0.0)
    back, end, base = left + hub.back, left + part.thickness, wheel.low.imag
    steps = [one.edge.polyline(part.tolerance) for one in part.steps]
    # how far down the plate is seen
    rim = 1j * min(float(one.imag[one.real >= wheel.plane].min()) for one in steps)
    foot, floor = -0.5j * hub.diameter, 1j * base
    lengths = [Measure(back + rim, back + part.width + rim)]
    lengths += [Measure(back + one.low + foot, back + one.high + foot) for one in part.bosses]
    if part.bosses:
        lengths.append(Measure(left + foot, end + foot, aside=True))
    lengths += [Measure(back + one.low + floor, back + one.high + floor) for one in part.recesses]
    board.measure(lengths, base)
    plain = wheel.bore and wheel.keyed is None
    beside = [_upright(end, wheel.radius, wheel.bore_text)] if plain else []
    if wheel.tips and part.inner:
        beside.append(_upright(end, wheel.tips, diameter_text(2.0 * wheel.tips)))
    if part.hub is not None:
        words = diameter_text(hub.diameter)
        if hub.front:
            beside.append(_upright(end, 0.5 * hub.diameter, words))
        else:
            board.measure([_upright(left, 0.5 * hub.diameter, words)], left, vertical=True)
    board.measure(beside, end, side=1, vertical=True)
    if plain and wheel.turns:
        datum(board, complex(end + FIRST_LEVEL * board.unit, -wheel.radius), -1j)


def _upright(x: float, radius: float, words: str) -> Measure:
    return Measure(complex(x, -radius), complex(x, radius), text=words)


def _bore_view(board: Board, wheel: Wheel, bore: Loop, left: float) -> None:
    """Draw a bore to the right of x = `left`, with its keyway or flat at the top."""
    kind, floor = floor_of(bore)
    radius, middle = wheel.radius, complex(floor.mean())
    unit, x, top, way = board.unit, left + wheel.radius, abs(middle), cmath.phase(middle)
    board.draw(EDGE, placed(bore, Pose(UP - way, x)))
    board.centre(Circle(center=complex(x), diameter=2.0 * max(radius, top)))
    across = Measure(complex(x - radius), complex(x + radius), wheel.bore_text)
    board.measure([across], -radius)
    half = 0.5 * float(abs(floor[1] - floor[0]))
    edge, limits = complex(x - half, top), ""
    if kind == "keyway":
        across = Measure(edge, edge + 2.0 * half, wheel.floor_text)
        board.measure([across], max(top, radius), side=1)
        key = keyway_of(2.0 * radius)
        if wheel.fits.get("keyway") and key and abs(top - radius - key.hub_depth) < SAME:
            limits = f" (+{fine(key.tolerance)}/0)"
    bottom = complex(x, -radius) if kind != "flats" else edge.conjugate()
    depth = length_text(top - bottom.imag) + limits
    board.measure([Measure(bottom, edge, depth)], x - radius, vertical=True)
    datum(board, complex(x - radius, -radius - FIRST_LEVEL * unit), -1.0)
    line = complex(x, -radius - (FIRST_LEVEL + 5.0 + HEIGHT) * unit)
    board.write(Text(text=f"bore, {kind} turned up", place=line, anchor="middle"))
    board.rows.append((f"{kind}, direction", f"{decimal(math.degrees(way) % 360.0)} deg"))
