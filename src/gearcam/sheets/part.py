"""The sheet of a part: front view, section A-A, and a separate view of a bore that is not round.

The front view is in the part's own frame, seen from +z. The section is in the vertical plane
through the axis, or through the first hole of a part without one; it is seen from the left and
stands on the right (first angle), with the front face on its right. A keyway or a flat is turned
into its plane, and the bore shown a second time, so that this is at the top. Holes of one size at
equal angles on one circle are a *pattern*, with one diameter, the circle and the direction of the
first; other holes have a letter, and their positions in the table.

Depends on parts, drawings and sheets.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final, cast

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Plane, bounds
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Bevel, Hub, Opening, Part, ScrewHole
from gearcam.parts.shapes import Circle, Loop, extremes, true_points
from gearcam.pictures.drawings import BORE, HOLE, SLOT, Drawing, box, part_features, place, placed
from gearcam.sheets.board import AROUND, FIRST_LEVEL, LEVEL, OVERHANG, Board, Measure, direction
from gearcam.sheets.board import label_of as label
from gearcam.sheets.paper import NO_VALUES, Heading, Values, begin, finish
from gearcam.sheets.sections import Section, crossings
from gearcam.sheets.sheet import CENTERLINE, DIMENSION, EDGE, HEIGHT, HIDDEN, Sheet, Text, fine
from gearcam.sheets.symbols import datum, frame, section_line

LEFT: Final = 24.0
BETWEEN: Final = 36.0
RIGHT: Final = 28.0
ABOVE: Final = 16.0
BELOW: Final = 5.0
BORE_ROOM: Final = 44.0
UNROLLED: Final = 36.0
"""Space for dimensions left of, between, right of and above the views, more below the front view
for the line of the section, for those of the bore's view,
and for those of an unrolled outside, mm of paper."""

SAME: Final = 1e-6
"""Sizes, mm, and angles, rad, that differ by less are equal."""

_PLANES: Final = 10
"""Places of the section that are tried, with both ends."""

_NEAR: Final = 0.1
"""Angle to both sides of theta = 0 at which the outline is looked at, rad."""

UP: Final = 0.5 * math.pi


@dataclass(frozen=True, eq=False, kw_only=True)
class Turning:
    """How a cam turns: where its angle is 0, rad, and the sense; None of what slides."""

    zero: float
    clockwise: bool

    @property
    def words(self) -> str:
        """The sense of turning in words."""
        return f"turns {'' if self.clockwise else 'counter-'}clockwise"


@dataclass(frozen=True, eq=False, kw_only=True)
class Unrolled:
    """What the sheet of a cam in space shows beside its blank.

    Parameters
    ----------
    loops : sequence of (n,) complex array, mm
        What the section cuts of its solid: z and y, with z = 0 at the back.
    drawing : Drawing
        Its outside unrolled, the lower left corner at 0.
    title : str
        What is written above that.
    note : str
        Where its walls are given.
    """

    loops: Sequence[Plane]
    drawing: Drawing
    title: str
    note: str


@dataclass(frozen=True, eq=False, kw_only=True)
class _Wheel:
    """A part with the data of its sheet; points are on the true curves.

    `points` are those of the outline, `toothed` those of the teeth, for a ring of its inner edge.
    """

    part: Part
    points: Plane
    toothed: Plane
    unrolled: Unrolled | None = None

    @cached_property
    def low(self) -> complex:
        return bounds(self.points)[0]

    @cached_property
    def high(self) -> complex:
        return bounds(self.points)[1]

    @cached_property
    def round(self) -> bool:
        """Whether the outline is a circle around the axis, as for most rings and groove cams."""
        return float(np.ptp(np.abs(self.points))) < SAME

    @cached_property
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

    @cached_property
    def bore(self) -> Opening | None:
        return next((one for one in self.part.openings if one.kind == BORE), None)

    @property
    def fits(self) -> Mapping[str, Any]:
        """Sizes of the bore that have tolerance classes."""
        return self.bore.fits if self.bore else {}

    @property
    def keyed(self) -> Loop | None:
        """The bore if it is not round."""
        shape = self.bore.shape if self.bore else None
        return shape if isinstance(shape, Loop) else None

    @property
    def radius(self) -> float:
        """Radius of the bore, with a keyway or a flat that of the arc, mm; 0 without a bore."""
        if self.keyed is not None:
            return float(abs(self.keyed.points[0]))
        return self.bore.shape.reach if self.bore else 0.0

    @property
    def plane(self) -> float:
        """Where the section is, x, mm; without axis and holes where it cuts most metal."""
        if self.turns:
            return 0.0
        even = np.linspace(self.low.real, self.high.real, _PLANES)[1:-1]
        tried = [one.center.real for one in _holes_of(self.part)][:1] or even.tolist()
        edge, tolerance = self.part.contours[-1], self.part.tolerance

        def metal(x: float) -> float:
            return float(np.diff(crossings(edge, x, tolerance))[::2].sum())

        return max(tried, key=metal)

    @cached_property
    def section(self) -> Section:
        """What the plane cuts, a keyway or flat turned into it."""
        part = self.part
        turned = {}
        if self.keyed is not None and self.bore is not None:
            middle = cmath.phase(complex(_floor(self.keyed).mean()))
            shape = placed(self.keyed, Pose(UP - middle))
            turned[id(self.bore)] = replace(self.bore, shape=shape)
        layers = [
            replace(one, openings=tuple(turned.get(id(o), o) for o in one.openings))
            for one in part.layers
        ]
        # chamfers are told in words; a set screw is turned into the plane
        pockets = [one for one in part.pockets if not isinstance(one, Bevel | ScrewHole)]
        return Section(layers=layers, pockets=pockets, x=self.plane, tolerance=part.tolerance)


def _holes_of(part: Part) -> list[Circle]:
    """Return the round holes of a part."""
    shapes = [one.shape for one in part.openings if one.kind == HOLE]
    return [one for one in shapes if isinstance(one, Circle)]


def _floor(keyed: Loop) -> Plane:
    """Return both ends of the floor of a keyway, or of a flat."""
    return keyed.points[-2:] if len(keyed.points) == 5 else keyed.points[[0, -1]]


def fitted(words: str, fit: Any) -> str:
    """Return the text of a size with its tolerance class and limits, if it has any."""
    if fit is None:
        return words
    limits = f"±{decimal(fit.upper)}"
    if fit.lower != -fit.upper:
        limits = "/".join(f"{'+' * (one > 0)}{decimal(one)}" for one in (fit.upper, fit.lower))
    return f"{words} {fit.tolerance_class} ({limits})"


def part_sheet(
    part: Part,
    facts: Mapping[str, str],
    heading: Heading,
    *,
    turning: Turning | None = None,
    values: Values = NO_VALUES,
    unrolled: Unrolled | None = None,
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
    turning : Turning, optional
        How a cam turns.
    values : Values
        A second table.
    unrolled : Unrolled, optional
        What is shown of a cam in space, of which the part is the blank.

    Returns
    -------
    Sheet
        With the name of the part.

    Raises
    ------
    InfeasibleError
        If the part is too large for the smallest scale.
    """
    points = true_points(part.contours[-1:])
    toothed = true_points(part.inner[-1:]) if part.inner else points
    wheel = _Wheel(part=part, points=points, toothed=toothed, unrolled=unrolled)
    size = wheel.high - wheel.low + part.thickness + (2.0 * wheel.radius if wheel.keyed else 0.0)
    levels = max(1 + len(part.bosses) + len(part.recesses), 1 + wheel.placed)
    below = BELOW + FIRST_LEVEL + LEVEL * levels
    across = BETWEEN + RIGHT + (BORE_ROOM if wheel.keyed else 0.0)
    rows = len(facts) + len(part.openings) + 2 + values.tall
    low, wide = wheel.low, 0.0
    if unrolled is not None:
        outside = box(unrolled.drawing.features)[1]
        size, low, wide = size + 1j * outside.imag, low - 1j * outside.imag, outside.real
        below += UNROLLED
    board = begin(size, (complex(LEFT, below), complex(across, ABOVE)), low, rows, wide)
    side = wheel.high.real + BETWEEN * board.unit
    if unrolled is not None:
        under = below - UNROLLED + 10.0
        _unrolled(board, unrolled, wheel.low - 1j * under * board.unit)
    _front_view(board, wheel)
    _section(board, wheel, side)
    if wheel.keyed is not None:
        _bore_view(board, wheel, side + part.thickness + (RIGHT + 18.0) * board.unit)
    _front_sizes(board, wheel)
    _section_sizes(board, wheel, side)
    if turning is not None:
        _turning(board, wheel, turning)
    _callouts(board, wheel, side)
    _frames(board, wheel, heading, side)
    return finish(
        board,
        heading,
        name=part.name,
        facts=facts,
        notes=[*_notes(wheel)],
        values=values,
    )


def _notes(wheel: _Wheel) -> list[str]:
    part, chamfer = wheel.part, wheel.part.chamfer
    about = " R, X, Y and angles from the axis." if wheel.turns else ""
    about = " X, Y from the cross." if wheel.placed else about
    return [
        *([f"Chamfer {decimal(chamfer)} x 45 deg on both faces."] if chamfer else []),
        *(["Holes go right through."] if part.openings else []),
        f"All sizes are finished sizes.{about}",
        wheel.unrolled.note
        if wheel.unrolled
        else f"Outline: DXF file of this part, chord tolerance {fine(part.tolerance)} mm.",
    ]


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
    low, high, over = wheel.low, wheel.high, OVERHANG * board.unit
    if wheel.turns:
        board.line(CENTERLINE, low.real - over, high.real + over)
    section_line(board, wheel.plane, low.imag, high.imag)


def _front_sizes(board: Board, wheel: _Wheel) -> None:
    left, low, right, high = extremes(wheel.points)
    floor, side = wheel.low.imag - BELOW * board.unit, wheel.low.real
    if wheel.round:
        words = label(Circle(center=0j, diameter=(right - left).real))
        board.measure([Measure(first=left, second=right, text=words)], floor)
        return
    across, up = [Measure(first=left, second=right)], [Measure(first=low, second=high)]
    if wheel.placed:
        near = left if abs(wheel.low.real) < abs(wheel.high.real) else right
        corner = complex(near.real, wheel.low.imag)
        board.centre(Circle(center=0j, diameter=board.unit))
        across += [Measure(first=0j, second=corner)] if abs(corner.real) > SAME else []
        up += [Measure(first=0j, second=corner)]
    board.measure(across, floor)
    board.measure(up, side, vertical=True)


def _section(board: Board, wheel: _Wheel, left: float) -> None:
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
    middles = [0.0] if wheel.turns else []
    middles += [
        one.center.imag
        for one in _holes_of(part)
        if abs(one.center.real - wheel.plane) < 0.5 * one.diameter
    ]
    for y in middles:
        board.line(CENTERLINE, complex(left - over, y), complex(end + over, y))
    if wheel.keyed is not None:
        _corner(board, wheel, left, end)
    if part.screw is not None:
        _screw(board, part.screw, shift, wheel.radius)
    title = complex(0.5 * (left + end), wheel.high.imag + 6.0 * board.unit)
    board.write(Text(text="A-A", place=title, height=3.5, anchor="middle"))


def _unrolled(board: Board, unrolled: Unrolled, high: complex) -> None:
    """Draw the unrolled outside of a cam from its upper left corner on."""
    end = box(unrolled.drawing.features)[1]
    first, last = high - 1j * end.imag, high + end.real
    for feature in place(unrolled.drawing.features, Pose(0.0, first)):
        board.draw(feature.layer, feature.shape)
    around = Measure(first=first, second=complex(last.real, first.imag), aside=True)
    board.measure([around], first.imag)
    board.write(Text(text=unrolled.title, place=high + 3.0j * board.unit))


def _corner(board: Board, wheel: _Wheel, left: float, end: float) -> None:
    """Draw the edge where the side of a keyway, or a flat, meets the bore behind the plane."""
    floor = _floor(wheel.keyed)  # type: ignore[arg-type]
    half = 0.5 * float(abs(floor[1] - floor[0]))
    y = math.sqrt(max(wheel.radius**2 - half**2, 0.0))
    if y < abs(floor.mean()) - SAME:
        board.line(EDGE, complex(left, y), complex(end, y))


def _screw(board: Board, screw: ScrewHole, shift: float, inner: float) -> None:
    """Draw the hole of a set screw below the bore, and say its thread and place."""
    outer, middle = 0.5 * cast("Circle", screw.edge).diameter, shift + screw.middle
    for x in (shift + screw.low, shift + screw.high):
        board.line(EDGE, complex(x, -inner), complex(x, -outer))
    over = OVERHANG * board.unit
    board.line(CENTERLINE, complex(middle, -inner + over), complex(middle, -outer - over))
    at = f"at {decimal(math.degrees(screw.angle))} deg, z {decimal(screw.middle)} mm"
    board.rows.append((_thread(screw), at))


def _thread(screw: ScrewHole) -> str:
    return f"set screw M{decimal(screw.size)}"


def _section_sizes(board: Board, wheel: _Wheel, left: float) -> None:
    part, hub = wheel.part, wheel.part.hub or Hub(diameter=0.0)
    back, end, base = left + hub.back, left + part.thickness, wheel.low.imag
    rim = 1j * _lowest(wheel)
    lengths = [Measure(first=back + rim, second=back + part.width + rim)]
    if part.bosses:
        foot = -0.5j * hub.diameter
        lengths += [
            Measure(first=back + boss.low + foot, second=back + boss.high + foot)
            for boss in part.bosses
        ]
        lengths.append(Measure(first=left + foot, second=end + foot, aside=True))
    for one in part.recesses:
        depth = back + one.low + 1j * base, back + one.high + 1j * base
        lengths.append(Measure(first=depth[0], second=depth[1]))
    board.measure(lengths, base)
    beside: list[Measure] = []
    fits = wheel.fits
    if wheel.bore and wheel.keyed is None:
        words = label(Circle(center=0j, diameter=2.0 * wheel.radius))
        beside.append(_upright(end, wheel.radius, fitted(words, fits.get("diameter"))))
    if part.hub is not None:
        words = label(Circle(center=0j, diameter=hub.diameter))
        if hub.front:
            beside.append(_upright(end, 0.5 * hub.diameter, words))
        else:
            board.measure([_upright(left, 0.5 * hub.diameter, words)], left, vertical=True)
    board.measure(beside, end, side=1, vertical=True)
    if wheel.bore and wheel.keyed is None and wheel.turns:
        datum(board, complex(end + FIRST_LEVEL * board.unit, -wheel.radius), -1j)


def _lowest(wheel: _Wheel) -> float:
    """Return how far down the plate is seen in the section, mm."""
    steps = [one.edge.polyline(wheel.part.tolerance) for one in wheel.part.steps]
    return min(float(one.imag[one.real >= wheel.plane].min()) for one in steps)


def _upright(x: float, radius: float, words: str) -> Measure:
    return Measure(first=complex(x, -radius), second=complex(x, radius), text=words)


def _bore_view(board: Board, wheel: _Wheel, left: float) -> None:
    """Draw a bore to the right of x = `left`, with its keyway or flat at the top."""
    bore, floor = wheel.keyed, _floor(wheel.keyed)  # type: ignore[arg-type]
    kind = "keyway" if len(bore.points) == 5 else "flat"  # type: ignore[union-attr]
    fits = wheel.fits
    radius, middle = wheel.radius, complex(floor.mean())
    unit, x, top, way = board.unit, left + wheel.radius, abs(middle), cmath.phase(middle)
    board.draw(EDGE, placed(bore, Pose(UP - way, x)))  # type: ignore[arg-type]
    board.centre(Circle(center=complex(x), diameter=2.0 * max(radius, top)))
    words = fitted(label(Circle(center=0j, diameter=2.0 * radius)), fits.get("diameter"))
    ends = complex(x - radius), complex(x + radius)
    board.measure([Measure(first=ends[0], second=ends[1], text=words)], -radius)
    half = 0.5 * float(abs(floor[1] - floor[0]))
    edge = complex(x - half, top)
    if kind == "keyway":
        words = fitted(decimal(2.0 * half), fits.get("keyway"))
        over = Measure(first=edge, second=edge + 2.0 * half, text=words)
        board.measure([over], max(top, radius), side=1)
    depth = f"{decimal(radius + top)}{_depth_limits(fits, half, kind)}"
    across = Measure(first=complex(x, -radius), second=edge, text=depth)
    board.measure([across], x - radius, vertical=True)
    datum(board, complex(x - radius, -radius - FIRST_LEVEL * unit), -1.0)
    line = complex(x, -radius - (FIRST_LEVEL + 5.0 + HEIGHT) * unit)
    board.write(Text(text=f"bore, {kind} turned up", place=line, anchor="middle"))
    board.rows.append((f"{kind}, direction", f"{decimal(math.degrees(way))} deg"))


def _depth_limits(fits: Mapping[str, Any], half: float, kind: str) -> str:
    """Return the limits of the depth of a keyway with a tolerance class (DIN 6885-1)."""
    if kind != "keyway" or not fits.get("keyway"):
        return ""
    return f" (+{0.1 if half <= 3.0 else 0.2}/0)"


def _turning(board: Board, wheel: _Wheel, turning: Turning) -> None:
    """Draw where the angle of a cam is 0, and an arrow for its sense."""
    ahead = wheel.points * cmath.rect(1.0, -turning.zero)
    reach = float(ahead.real[np.abs(np.angle(ahead)) < _NEAR].max())
    end = cmath.rect(reach + 8.0 * board.unit, turning.zero)
    board.line(CENTERLINE, 0j, end)
    if not board.label(end, "theta = 0"):
        board.rows.append(("theta = 0 at", f"{decimal(math.degrees(turning.zero))} deg"))
    radius = 0.5 * (wheel.radius + float(np.abs(wheel.points).min()))
    sense = -1.0 if turning.clockwise else 1.0
    angles = turning.zero + sense * np.linspace(0.3, 1.2, 19)
    arc = radius * np.exp(1j * angles)
    board.line(DIMENSION, *arc.tolist())
    tip = complex(arc[-1])
    board.arrow(tip, 1j * sense * tip / abs(tip))
    if not board.label(complex(arc[9]), turning.words):
        board.rows.append(("rotation", turning.words))


def _frames(board: Board, wheel: _Wheel, heading: Heading, left: float) -> None:
    """Draw the frames of run-out and profile tolerance."""
    notes, part = heading.notes, wheel.part
    if notes.profile_tolerance:
        spot = complex(wheel.points[np.argmax((wheel.points * cmath.rect(1.0, -0.7)).real)])
        frame(board, spot, "profile", fine(notes.profile_tolerance))
    if notes.runout and wheel.turns and wheel.bore:
        back = left + (part.hub.back if part.hub else 0.0)
        top = max(float(ends[-1]) for ends, _ in wheel.section.slabs if len(ends))
        # of an outline that is not round, that of the face
        spot = complex(back + 0.5 * part.width, top) if wheel.round else back + 0.95j * top
        frame(board, spot, "runout", fine(notes.runout), "A")


def _callouts(board: Board, wheel: _Wheel, side: float) -> None:
    """Draw the leaders into the front view, those with fixed places first."""
    part = wheel.part
    _holes(board, part)
    if wheel.turns and (part.inner or not wheel.round):
        _radii(board, wheel)
    for opening in part.openings:
        if opening.kind == SLOT and isinstance(opening.shape, Loop):
            _slot(board, opening.shape)
    if part.screw is not None:
        edge = complex(side - part.ends[0] + part.screw.middle, -part.screw.edge.reach)
        board.label(edge, _thread(part.screw))
    for mark in part.marks:
        words = f"mark {{}}, {decimal(mark.depth)} deep"
        if not board.callout(mark.edge, words):
            board.rows.append(("mark", label(mark.edge, words)))


def _radii(board: Board, wheel: _Wheel) -> None:
    """Draw the largest and the smallest radius of the teeth from the axis."""
    reach = np.abs(wheel.toothed)
    for radius, word in ((float(reach.max()), "max"), (float(reach.min()), "min")):
        # the first of the points on an arc about the axis, not one that rounding chooses
        point = complex(wheel.toothed[np.argmax(np.abs(reach - radius) < SAME)])
        circle, words = Circle(center=0j, diameter=2.0 * radius), f"{{}} {word}"
        # a leader without direction to the axis
        if not board.callout(circle, words, kind="radius", angles=direction(point)) and (
            not board.label(point, label(circle, words, "radius"))
        ):
            board.rows.append((f"{word}. radius from axis", decimal(radius)))


def _holes(board: Board, part: Part) -> None:
    """Draw the centre lines of all holes, then their sizes, large ones first."""
    groups: dict[tuple[int, int], list[Circle]] = {}
    for circle in _holes_of(part):
        key = round(circle.diameter / SAME), round(abs(circle.center) / SAME)
        groups.setdefault(key, []).append(circle)
    patterns = [group for group in groups.values() if _even(group)]
    singles = [one for group in groups.values() if not _even(group) for one in group]
    for group in patterns:
        _ring(board, group)
    names = {id(one): f"H{k} {{}}" for k, one in enumerate(singles, start=1)}
    for hole in singles:
        board.centre(hole)
    for hole in sorted(singles, key=lambda one: -one.diameter):
        board.callout(hole, names[id(hole)])
    for group in patterns:
        _pattern(board, group)
    for hole in singles:
        place = f"X {decimal(hole.center.real)}  Y {decimal(hole.center.imag)}"
        board.rows.append((label(hole, names[id(hole)]), place))


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
    first, words = cmath.phase(one.center), f"{count} x {{}}"
    board.callout(one, words, angles=AROUND)
    # the arrow points at the circle between two holes
    between = first + math.pi / count * np.array([1.0, 3.0, -1.0, -3.0, 0.5, -0.5, 1.5, -1.5])
    ring = Circle(center=0j, diameter=2.0 * abs(one.center))
    board.callout(ring, angles=between)
    at = f"on {label(ring)}, at {decimal(math.degrees(first))} deg"
    board.rows.append((label(one, words), at))


def _slot(board: Board, shape: Loop) -> None:
    """Dimension a slot along an arc about the axis: width, mean radius and end angles."""
    corners = shape.points
    half = len(corners) // 2
    radii = np.abs(corners[[0, half]])
    middle, width = float(radii.mean()), float(radii[0] - radii[1])
    sweep = float(np.angle(corners[1:half] / corners[: half - 1]).sum())
    first = math.degrees(cmath.phase(complex(corners[0])))
    end = Circle(center=complex(corners[[half - 1, half]].mean()), diameter=width)
    if not board.callout(end, "slot {}", kind="radius"):
        board.rows.append(("slot, width", decimal(width)))
    board.rows.append(("slot, mid radius", decimal(middle)))
    last = first + math.degrees(sweep)
    board.rows.append(("slot, ends at", f"{decimal(first)}, {decimal(last)} deg"))
