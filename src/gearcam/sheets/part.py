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

import numpy as np

from gearcam.base.inches import file_unit
from gearcam.numeric.arrays import Plane
from gearcam.numeric.pose import Pose
from gearcam.parts.blank import thread_diameter
from gearcam.parts.body import Hub, Part, ScrewHole
from gearcam.parts.shafts import keyway_of
from gearcam.parts.shapes import Circle, Loop, extremes
from gearcam.pictures.drawings import (
    BLANK,
    CENTRODE,
    PITCH,
    Path,
    box,
    part_features,
    place,
    placed,
)
from gearcam.sheets.board import FIRST_LEVEL, LEVEL, OVERHANG, Board
from gearcam.sheets.callouts import (
    PAST_SECTION,
    callouts,
    direction,
    frames,
    position,
    turning_arrow,
    zero_line,
)
from gearcam.sheets.dimensions import Measure, diameter_text
from gearcam.sheets.paper import NO_VALUES, Heading, Values, begin, finish
from gearcam.sheets.sheet import (
    CENTERLINE,
    DIMENSION,
    EDGE,
    HEIGHT,
    HIDDEN,
    Sheet,
    Text,
    fine,
    length_text,
    text_width,
)
from gearcam.sheets.spec import DrawingNotes
from gearcam.sheets.symbols import datum, section_letters, section_line
from gearcam.sheets.wheel import SAME, UP, Sense, Teeth, Unrolled, Wheel, floor_of, holes_of

LEFT: Final = 25.0
BETWEEN: Final = 34.0
RIGHT: Final = 26.0
ABOVE: Final = 14.0
BELOW: Final = 5.0
BORE_ROOM: Final = 44.0
BORE_LEFT: Final = 18.0
TEXT_ROOM: Final = 6.0
UNROLLED: Final = 36.0
DEPTH: Final = 0.7
"""Space for dimensions left of, between, right of and above the views, more below the front view
for the line of the section, at least for those of the bore's view, of this left of the bore and
between it and a text, and for those of an unrolled outside; least distance of the lines of a
thread, mm of paper."""


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
    screws = 1 if part.screw else 0
    levels = max(1 + len(part.bosses) + len(part.recesses) + screws, 1 + wheel.placed)
    below = BELOW + FIRST_LEVEL + LEVEL * levels
    across = BETWEEN + RIGHT
    if wheel.keyed is not None:
        wide = max(text_width(wheel.bore_text), text_width(wheel.floor_text))
        across += max(BORE_ROOM, BORE_LEFT + TEXT_ROOM + wide)
    rows = len(facts) + len(part.openings) + 2 + values.tall
    outside = box(unrolled.drawing.features)[1] if unrolled else 0j
    above = ABOVE + LEVEL * screws + (PAST_SECTION if turning and turning.upright else 0.0)
    room = complex(LEFT, below + (UNROLLED if unrolled else 0.0)), complex(across, above)
    tall = 1j * outside.imag
    board = begin(part.name, size + tall, room, wheel.low - tall, rows, outside.real)
    side = wheel.high.real + BETWEEN * board.unit
    walls = part.recesses[0].edge.polyline(part.tolerance) if part.recesses else wheel.points
    if unrolled is not None:
        walls = _unrolled(board, unrolled, wheel.low - 1j * (below + 10.0) * board.unit)
    _front_view(board, wheel)
    _section(board, wheel, side)
    if wheel.keyed is not None:
        _bore_view(
            board, wheel, wheel.keyed, side + part.thickness + (RIGHT + BORE_LEFT) * board.unit
        )
    _front_sizes(board, wheel)
    _section_sizes(board, wheel, side)
    zero = zero_line(board, wheel, turning) if turning else 0j
    section_letters(board, wheel.plane, wheel.low.imag, wheel.high.imag)
    if wheel.keyed is not None:
        direction(board, wheel, wheel.keyed, turning.zero if turning else 0.0)
    if turning is not None:
        turning_arrow(board, wheel, turning, zero)
    frames(board, wheel, heading, side, walls)
    callouts(board, wheel, side)
    if teeth is not None:
        at = position(teeth.first - wheel.origin)
        board.label(teeth.first, "tooth 1", ("tooth 1, tip", at))
    return finish(board, heading, facts, [*_notes(wheel, heading.notes), *notes], values)


def _notes(wheel: Wheel, notes: DrawingNotes) -> list[str]:
    part, name, held = wheel.part, file_unit().name, "none is given"
    if notes.profile_tolerance:
        held = "that of its profile"
    elif notes.general_tolerances:
        held = "the general one"
    clearance = wheel.unrolled.groove.clearance if wheel.unrolled else 0.0
    more = f", {length_text(clearance)} {name}" if clearance else ""
    about = " R, X, Y from the axis; angles from x, to the right." if wheel.turns else ""
    if not wheel.turns and (holes_of(part) or part.marks):
        side = "left" if wheel.origin.real == wheel.low.real else "right"
        about = f" X, Y from the {'cross' if wheel.placed else f'lower {side} corner'}."
    return [
        *(["Edges that are shown with a chamfer have it on both faces."] if part.chamfer else []),
        *(
            [f"Width of the groove: diameter of the roller and clearance{more}; tolerance: {held}."]
            if wheel.grooved
            else []
        ),
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
    board.hatch([loop + shift for loop in wheel.cut])
    if wheel.unrolled is None:
        for start, stop in wheel.section.lines:
            board.line(EDGE, start + shift, stop + shift)
    else:
        for loop in wheel.unrolled.loops:
            board.line(EDGE, *(loop + shift).tolist(), closed=True)
        _behind(board, wheel, left, end, part.chamfer)
    if part.chamfer:
        _behind(board, wheel, left + part.chamfer, end - part.chamfer, 0.0)
    over = OVERHANG * board.unit
    near = [c for c in holes_of(part) if abs(c.center.real - wheel.plane) < 0.5 * c.diameter]
    middles = [*([0.0] if wheel.turns else []), *(circle.center.imag for circle in near)]
    middles += [y for y, *_ in wheel.cut_teeth]
    for y in middles:
        board.line(CENTERLINE, complex(left - over, y), complex(end + over, y))
    if wheel.keyed is not None:
        _corner(board, wheel, wheel.keyed, left + part.chamfer, end - part.chamfer)
    if wheel.shown.screw is not None:
        _screw(board, wheel, wheel.shown.screw, shift)


def _behind(board: Board, wheel: Wheel, left: float, end: float, chamfer: float) -> None:
    """Draw the edges of the bore behind the plane at x = `left` and `end`, wider by a `chamfer`."""
    if wheel.bore is not None:
        low, high = -1j * (wheel.radius + chamfer), 1j * (wheel.bore_top + chamfer)
        for x in (left, end):
            board.line(EDGE, x + low, x + high)


def _unrolled(board: Board, unrolled: Unrolled, high: complex) -> Plane:
    """Draw the unrolled outside of a cam from its upper left corner on; return its first wall."""
    end = box(unrolled.drawing.features)[1]
    first, last = high - 1j * end.imag, high + end.real
    for feature in place(unrolled.drawing.features, Pose(0.0, first)):
        board.draw(feature.layer, feature.shape)
    around = Measure(first, complex(last.real, first.imag), aside=True)
    board.measure([around], first.imag)
    board.write(Text(text=unrolled.title, place=high + 3.0j * board.unit))
    shapes = (one.shape for one in unrolled.drawing.features if one.layer not in (BLANK, PITCH))
    points = next(one.points for one in shapes if isinstance(one, Path)) + first
    x, y = (points - first).real / end.real, (points - first).imag / end.imag
    return points[(np.abs(x - 0.5) < 0.45) & (np.abs(y - 0.5) < 0.45)]


def _corner(board: Board, wheel: Wheel, bore: Loop, left: float, end: float) -> None:
    """Draw the edge where the side of a keyway, or a flat, meets the bore behind the plane."""
    _, floor = floor_of(bore)
    y = math.sqrt(max(wheel.radius**2 - 0.25 * float(abs(floor[1] - floor[0])) ** 2, 0.0))
    if y < abs(floor.mean()) - SAME:
        board.line(EDGE, complex(left, y), complex(end, y))


def _screw(board: Board, wheel: Wheel, screw: ScrewHole, shift: float) -> None:
    """Draw thread and centre line of a set screw."""
    outer, side = screw.edge.reach, math.copysign(1.0, screw.angle)
    inner = wheel.bore_top if side > 0.0 else wheel.radius
    over = OVERHANG * board.unit
    half = max(0.5 * thread_diameter(screw.size), 0.5 * screw.drill + DEPTH * board.unit)
    lines = (-half, DIMENSION, 0.0), (half, DIMENSION, 0.0), (0.0, CENTERLINE, over)
    for away, layer, more in lines:
        x = shift + screw.middle + away
        board.line(layer, complex(x, side * (inner - more)), complex(x, side * (outer + more)))


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
    screw, top = wheel.shown.screw, wheel.high.imag
    if screw is not None:
        reach = 1j * math.copysign(screw.edge.reach, screw.angle)
        face = end if screw.middle > 0.0 else left
        place = Measure(face + reach, back + screw.middle + reach)
        if screw.angle > 0.0:
            board.measure([place], top, side=1)
        else:
            lengths.append(place)
    board.measure(lengths, base)
    middle, high = 0.5 * (left + end), top + 6.0 * board.unit
    places = (complex(middle + x * board.unit, high) for x in (0.0, 12.0, -12.0, 24.0, -24.0))
    board.first_free(Text(text="A-A", place=one, height=3.5, anchor="middle") for one in places)
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
