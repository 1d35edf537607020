"""Parts from wheels: the blank of a design, checks of the finished flanks, and error estimates."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.findings import limit_of
from gearcam.base.numerals import formatted
from gearcam.gears.estimates import pair_errors
from gearcam.gears.outline import outside
from gearcam.gears.pair import Gear, make_gear
from gearcam.gears.spec import RIM
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.numeric.arrays import as_complex, bounds
from gearcam.numeric.columns import Columns
from gearcam.numeric.contour import Contour
from gearcam.numeric.moments import curve_moments
from gearcam.parts.arrows import DEPTH_PART
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.parts.body import Mark, Part
from gearcam.parts.checks import CheckedParts
from gearcam.parts.make import make_part, marked
from gearcam.parts.marks import MARK_DEPTH, MARK_DIAMETER, MARK_GAP, timing_mark
from gearcam.parts.mass import quadrature_error
from gearcam.parts.openings import Stock, Workpiece, demand_apart, row_of_holes
from gearcam.parts.rim import demand_bolts, is_around
from gearcam.parts.shapes import Circle

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.gears.subject import CheckedPair

Steps = tuple[tuple[Gear, Gear], ...]

_PLACES = 65
"""Points on each flank at which it is checked that a cutter can reach them."""

_SLIGHT = 1e-3
"""Angle of the driver that shows how a wheel moves, rad."""

_CHORDS = 4
"""Least width of a rim in chord tolerances."""


def make_parts(steps: Steps, design: GearPairDesign) -> tuple[Part, Part]:
    """Return both wheels as parts.

    Parameters
    ----------
    steps : tuple of (Gear, Gear)
        Both wheels of each step, from below.
    design : GearPairDesign
        The design.

    Returns
    -------
    (Part, Part)
        Driver first.

    Raises
    ------
    InfeasibleError
        If there is no space for an opening, hub or mark.
    """
    first, second = (_part([pair[k] for pair in steps], design) for k in (0, 1))
    return first, second


def _part(gears: list[Gear], design: GearPairDesign) -> Part:
    gear = gears[0]
    if gear.ring:
        return _ring(gears, design)
    blank, work = design.blank.wheel(gear.wheel), _workpiece(gear, design)
    contours = [one.profile.contour for one in gears]
    width, way = design.pair.face_width, _way(gear)
    if work.bar:
        return _rack(gear, contours, design, work, way)
    return make_part(gear.name, contours, width, blank, work, lambda: _mark(gear, design), way=way)


def _workpiece(gear: Gear, design: GearPairDesign) -> Workpiece:
    """Return the workpiece of a wheel, a ring or a rack."""
    lobes, rack, travel = gear.pair.law.lobes, gear.toothing.track.slides, None
    if not (lobes.closed or rack or gear.ring):
        travel = lobes.period if gear.wheel == 1 else lobes.advance
    return Workpiece(
        name=f"wheel {gear.wheel}",
        rim=RIM * gear.pair.module,
        travel=travel,
        wheel=gear.wheel,
        process=design.output.marking,
        bar=rack,
    )


def _rack(
    gear: Gear, contours: list[Contour], design: GearPairDesign, work: Workpiece, way: complex
) -> Part:
    """Return the part of a rack, which moves in a direction (see `_way`)."""
    points, blank, width = contours[0].points, design.blank.wheel(2), design.pair.face_width
    low, high = bounds(points)
    foot, up = complex(high.real, 0.5 * (low.imag + high.imag)), -1.0
    holes = tuple(row_of_holes(design.bar, foot, 0.5 * way, up))
    demand_apart(holes, Stock(contours=contours, work=work), design.bar.places)
    part = Part(name=gear.name, contours=tuple(contours), width=width, openings=holes, turns=False)

    def mark() -> Mark:
        frames, module = gear.toothing.frames(np.zeros(1)), gear.pair.module
        size = blank.mark_diameter or MARK_DIAMETER * module
        deep = gear.toothing.cutter.dedendum + MARK_GAP * module + 0.5 * size
        center = complex(frames.p[0] - deep * gear.toothing.turn * frames.t[0])
        return Mark(center=center, diameter=size, depth=min(MARK_DEPTH, DEPTH_PART * width))

    # a rack that ends in a gap begins at the pitch point of phi1 = 0: its end face is the mark
    return marked(part, blank, work, None if gear.toothing.in_gap else mark, way=way)


def _way(gear: Gear) -> complex:
    """Return how a wheel moves (see `gearcam.parts.arrows.arrow`), for a driver that turns."""
    before, after = (gear.pair.rolling.poses(phi)[gear.wheel - 1] for phi in (0.0, _SLIGHT))
    if gear.toothing.track.slides:
        shift = complex(after.shift) - complex(before.shift)
        return shift / abs(shift)
    return math.copysign(1.0, float(after.turn) - float(before.turn))


def _ring(gears: list[Gear], design: GearPairDesign) -> Part:
    """Return the part of a ring; the outline of an open one includes its outside."""
    gear, ring, blank = gears[0], design.ring, design.blank.wheel(2)
    roots = max(one.largest_radius for one in gears)
    rim = ring.least_rim(roots, gear.pair.module)
    around = None if ring.outer == "follow" else roots + rim
    toothed = [one.profile.contour for one in gears]
    contours: list[Contour | Circle] = [*toothed]
    if gear.hollow:
        circle = Circle(center=0j, diameter=2.0 * (roots + rim))
        contours = [circle if around else outside(gear.profile, rim)] * len(gears)
    inner = toothed if gear.hollow else []
    work = _workpiece(gear, design)
    wall = limit_of(PARTS_KIND, "thin-wall", design.limits)

    def larger(radius: float) -> dict[str, object]:
        if ring.outer_diameter is not None:
            return {"ring.outer_diameter_mm": 2.0 * radius}
        return {"ring.rim_mm": radius - roots}

    if inner and not all(map(is_around, contours, inner)):
        tolerance = gear.profile.tolerance
        raise _crossing_chords(rim, tolerance, larger(roots + _CHORDS * tolerance))
    demand_bolts(blank, Stock(contours=contours, work=work, inner=inner), wall, larger)
    return make_part(
        gear.name,
        contours,
        design.pair.face_width,
        blank,
        work,
        lambda: _mark(gear, design, rim, around),
        inner=inner,
        way=_way(gear),
    )


def _crossing_chords(rim: float, tolerance: float, larger: dict[str, object]) -> InfeasibleError:
    """Return the error for a rim, mm, that is too thin for the chord tolerance."""
    key = "output.chord_tolerance_mm"
    size = formatted(rim)
    what = f"the rim of the ring, {size} mm, is too thin for the chord tolerance of its edges"
    note = "the limit is a quarter of the rim"
    return beyond_limit(
        what,
        key,
        tolerance,
        rim / _CHORDS,
        note,
        near=rim / _CHORDS,
        adjustments=(Adjustment(near=larger),),
    )


def _mark(
    gear: Gear, design: GearPairDesign, rim: float = 0.0, around: float | None = None
) -> Mark:
    """Return the timing mark of a wheel, or of a ring with its `rim` and outer radius."""
    frames = gear.toothing.frames(np.zeros(1))
    radius = complex(frames.p[0])
    normal = complex(frames.t[0]) * gear.toothing.turn
    blank = design.blank.wheel(gear.wheel).widened
    dedendum = gear.toothing.cutter.dedendum
    tilt = abs(float(np.angle(normal / (-radius if gear.ring else radius))))
    if gear.ring and around is None:
        around = abs(radius) + (dedendum + rim) / math.cos(tilt)
    return timing_mark(
        abs(radius),
        math.pi if gear.wheel == 2 and not gear.ring else 0.0,
        gear.pair.module,
        dedendum,
        design.pair.face_width,
        bore_reach=max(blank.bore_reach, 0.5 * blank.hub_diameter),
        outside=around,
        tilt=tilt,
        diameter=blank.mark_diameter,
    )


def parts_subject(
    parts: tuple[Part, Part], gears: tuple[Gear, Gear], kerf: float, *, sought: bool
) -> CheckedParts:
    """Return the input of checks of parts.

    Parameters
    ----------
    parts : (Part, Part)
        Both wheels, driver first.
    gears : (Gear, Gear)
        Their teeth, which a cutter must reach.
    kerf : float, mm
        Width of its cut.
    sought : bool
        Whether the largest tools are looked for.
    """
    pairs = zip(parts, gears, strict=True)
    uncut = tuple(sought and bool(kerf) and _uncut(part, gear, kerf) for part, gear in pairs)
    return CheckedParts(parts=parts, kerf=kerf, uncut=uncut, sought=sought)


def _uncut(part: Part, gear: Gear, kerf: float) -> bool:
    """Return whether a cutter cannot reach some point of a wheel's finished flanks."""
    from gearcam.parts.parallel import touches

    table = gear.flank_points(_PLACES)
    points, normals = as_complex(table.points), as_complex(table.normals)
    return not touches(part.contour, points, normals, 0.5 * kerf).all()


def inspection_rows(steps: Steps, count: int) -> Columns:
    """Return the points for inspection, by column.

    Parameters
    ----------
    steps : tuple of (Gear, Gear)
        Both wheels of each step, from below.
    count : int
        Points on each flank.

    Returns
    -------
    Columns
        Both wheels, every step, every whole tooth, both sides, from root to tip: points of the
        finished flanks and outward normals of the metal, in the wheel's frame.
    """
    names = ("wheel", "step", "tooth", "side", "point", "x_mm", "y_mm", "nx", "ny")
    rows = _rows(steps, lambda gear: gear.flank_points(count))
    return Columns({name: rows[name] for name in names})


def measure_rows(steps: Steps, pins: Sequence[float | None]) -> Columns:
    """Return what is measured on all wheels of all steps, by column (see `Measuring.table`).

    Parameters
    ----------
    steps : tuple of (Gear, Gear)
        Both wheels of each step, from below.
    pins : two float or None, mm
        Diameters of the pins; None: the recommended one.
    """
    return _rows(steps, lambda gear: gear.measuring.table(pins[gear.wheel - 1]))


def _rows(steps: Steps, table: Callable[[Gear], Columns]) -> Columns:
    """Return the tables of all wheels of all steps, one below the other."""
    blocks = [
        {"wheel": gear.wheel, "step": step, **table(gear)}
        for step, gears in enumerate(steps, start=1)
        for gear in gears
    ]
    return Columns(
        {
            name: np.concatenate([np.broadcast_to(one[name], one["tooth"].shape) for one in blocks])
            for name in blocks[0]
        }
    )


_FINER: Final = 16.0
"""Factor by which the tolerance is finer when corners are followed again."""

_TRACED: Final = 2.0
"""Error over the change: ends of flanks are off in proportion to the tolerance, with scatter."""

_VOLUME: Final = (
    "cubics through dense points with doubled steps, at kinks of tips with halved steps; ends of "
    "flanks searched again with a tolerance 16 times finer; flank_mm over the whole edge"
)


def tooth_errors(subject: CheckedPair) -> dict[str, tuple[float, str]]:
    """Return the error estimates of the teeth of a pair.

    Parameters
    ----------
    subject : CheckedPair
        The pair with its wheels.

    Returns
    -------
    dict of str to (float, str)
        Estimate and method by name.
    """
    driven, flank, contact_ratio = pair_errors(subject)
    pair = subject.pair
    how = "largest change if the law and its integrals change by their errors"
    if pair.law.function_error:
        how += ", with that of the expansion of the Python function"
    area = max(gear.profile.chord_error * gear.profile.contour.length for gear in subject.gears)
    name, scale = ("travel_mm", pair.center_distance) if pair.on_rack else ("driven_angle_rad", 1.0)
    return {
        name: (scale * driven, how),
        "flank_mm": (flank, how),
        "contact_ratio": (contact_ratio, how),
        "area_mm2": (area, "chord error times the length of the outline"),
    }


def volume_errors(
    parts: Sequence[Part], steps: Steps, design: GearPairDesign, flank: float, within: Tolerances
) -> dict[str, tuple[float, str]]:
    """Return the error estimate of volumes, as of `tooth_errors`; empty without a density.

    Parameters
    ----------
    parts : two Part
        Both wheels, driver first.
    steps : tuple of (Gear, Gear)
        Both wheels of each step, from below.
    design : GearPairDesign
        The design.
    flank : float, mm
        Error of the points of flanks.
    within : Tolerances
        Internal accuracy.
    """
    volumes = [
        _volume(part, gears, design, flank, within)
        for number, (part, *gears) in enumerate(zip(parts, *steps, strict=True), 1)
        if design.blank.wheel(number).density is not None
    ]
    return {"volume_mm3": (max(volumes), _VOLUME)} if volumes else {}


def _volume(
    part: Part, gears: Sequence[Gear], design: GearPairDesign, flank: float, within: Tolerances
) -> float:
    """Return the error of the volume of a part, mm^3, from the wheel of each of its steps."""
    height, off = part.width / len(gears), quadrature_error(part)
    for gear in gears:
        outline = gear.profile
        area = outline.kinks_missed + flank * outline.contour.length
        if outline.flanks.traced:
            tolerance = outline.tolerance / _FINER
            finer = make_gear(gear.pair, gear.wheel, tolerance, within, design.back)
            area += _TRACED * abs(_toothed(finer) - _toothed(gear))
        off += height * area
    return off


def _toothed(gear: Gear) -> float:
    """Return the area at the teeth of a wheel, without the joining edge of an open one."""
    runs = gear.profile.dense_teeth
    return sum(curve_moments(run.points, run.tangents).area for run in runs)
