"""Facts of a cam: what the console, the report and ``summary.json`` show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Facts, extent
from gearcam.base.findings import limit_of
from gearcam.base.numerals import formatted
from gearcam.cams.checks import KIND, pressure_limits
from gearcam.kinds.shared import peak_of
from gearcam.parts.mass import part_facts

if TYPE_CHECKING:
    from gearcam.cams.measures import Range
    from gearcam.cams.wall import PitchMotion, Wall
    from gearcam.kinds.cam.build import CamResult
    from gearcam.laws.program import Program
    from gearcam.numeric.contour import Contour

Tree = dict[str, Any]

_DERIVATIVES: Final = ("velocity", "acceleration", "jerk")


_RADII: Final = {
    "profile_min_mm": "smallest radius of the profile",
    "pitch_min_mm": "smallest radius of the pitch curve",
    "pitch_rise_min_mm": "smallest radius of the pitch curve, rise",
    "pitch_return_min_mm": "smallest radius of the pitch curve, return",
    "profile_convex_min_mm": "smallest convex radius",
    "profile_concave_min_mm": "smallest concave radius",
}
"""Labels of radii of curvature."""

_SHOWN: Final = ("profile_convex_min_mm", "profile_concave_min_mm")
"""Keys that are always shown."""


def facts(result: CamResult) -> Facts:
    """Return the facts of a cam, its `result`."""
    design = result.design
    tree: Tree = {
        "kerf_mm": design.output.kerf or None,
        "motion": _motion(result),
        "cam": _cam(result),
        "part": _part(result) or None,
        "solution": _solution(result),
        "accuracy": result.accuracy,
    }
    headline = ("motion.total_lift", f"cam.{result.form.leading}")
    return Facts(tree, headline, f"{design.cam.form} cam for {design.follower.named}")


def _motion(result: CamResult) -> Tree:
    """Return lift in mm or deg and the peaks of its derivatives."""
    program, driver = result.program, result.driver
    scale, unit = result.follower.lift_unit
    low, high = program.range
    return {
        "unit": unit,
        "lift": Fact(extent(low, high, scale), "lift", unit=unit, shown=True),
        "total_lift": result.cam.motions[0].total_lift,
        "continuity": Fact(program.continuity, "continuity of the motion", unit=""),
        "deviation": _deviation(program, scale, unit),
        **{
            key: Fact(
                scale * peak,
                meaning,
                unit=f"{unit}/{driver.per}{order if order > 1 else ''}",
                shown=True,
            )
            for order, (name, peak) in enumerate(zip(_DERIVATIVES, program.peaks, strict=True), 1)
            for key, meaning in [peak_of(program, name, order)]
        },
        **_timed(result),
    }


def _solution(result: CamResult) -> Tree | None:
    """Return the sizes that were solved for, and the limits that decide on them."""
    found = result.solution
    if found is None:
        return None
    sizes = {key.split(".")[1]: (key, value) for key, value in found.sizes.items()}
    tree: Tree = {
        name: Fact(value, f"{key}, solved", shown=True) for name, (key, value) in sizes.items()
    }
    if found.deciding:
        tree["decided_by"] = Fact(", ".join(found.deciding), "decided by", shown=True)
    return tree


def _timed(result: CamResult) -> Tree:
    """Return the peaks of the derivatives by time; none without a speed."""
    program, drive = result.program, result.design.drive
    scales, tree = result.cam.motions[0].timed_scales(drive.speed), Tree()
    for order, (column, factor) in enumerate(scales.items(), 1):
        name = _DERIVATIVES[order - 1]
        (key, meaning), peak = peak_of(program, name, order), factor * program.peaks[order - 1]
        place = f"at {drive.named}"
        tree[key + column.removeprefix(name)] = Fact(peak, meaning, place=place, shown=True)
    return tree


def _deviation(program: Program, scale: float, unit: str) -> Fact | None:
    """Return the largest distance of a smoothed lift from the rows of its table."""
    if program.deviation is None:
        return None
    place = f"at {formatted(math.degrees(program.deviation.theta), scale=360.0)} deg"
    value, meaning = scale * program.deviation.value, "largest distance from the given points"
    return Fact(value, meaning, place=place, unit=unit, shown=True)


def _cam(result: CamResult) -> Tree:
    design, given = result.solved, result.solved.follower
    return {
        "form": design.cam.form,
        "follower": f"{given.motion} {given.type}",
        "roller_radius_mm": given.roller_radius,
        "dome_radius_mm": given.dome_radius,
        "pivot_distance_mm": given.pivot_distance,
        "arm_mm": given.arm,
        "face_offset_mm": given.face_offset or None,
        **result.form.sizes(),
        "thickness_mm": design.cam.thickness,
        "pressure_angle_deg": pressure(result, result.cam.motions[0]),
        "lost_motion": _lost_motion(result),
        **result.form.facts(),
    }


def pressure(result: CamResult, motion: PitchMotion) -> Tree:
    """Return the pressure angles of rises and returns.

    Parameters
    ----------
    result : CamResult
        With the limits.
    motion : PitchMotion
        One of the motions of its cam.

    Returns
    -------
    dict
        Of facts.
    """
    made: Tree = {}
    whose = f", {motion.called}" if motion.key else ""
    given = limit_of(KIND, "pressure-angle", result.design.limits)
    largest = 0.0
    for kind, limit in pressure_limits(result.follower, given).items():
        found = motion.pressure(kind)
        if found is not None:
            worst = max(found.low, found.high, key=lambda end: abs(end.value))
            made[f"{kind}_max"] = Fact(
                math.degrees(found.largest),
                f"pressure angle, {kind}{whose}",
                at_most=math.degrees(limit),
                place=result.driver.place(worst.theta),
                unit="deg",
                shown=found.largest > 0.0,
            )
            made[kind] = Fact(ends_of(found, math.degrees(1.0)), unit="deg")
            largest = max(largest, found.largest)
    return {"max": Fact(math.degrees(largest), unit="deg")} | made if made else made


def _lost_motion(result: CamResult) -> Fact | None:
    """Return how far a follower between two walls can move while the cam stands still."""
    lost = result.cam.lost_motion
    if lost is None:
        return None
    scale, unit = result.follower.lift_unit
    place = result.driver.place(lost.theta)
    return Fact(scale * lost.value, "lost motion", place=place, unit=unit, shown=True)


def _part(result: CamResult) -> Tree | list[Tree]:
    """Return the facts of the part, or of each part, of a cam; empty if none is ordered."""
    if not result.ordered:
        return {}
    density, several = result.design.blank.density, len(result.parts) > 1
    parts = [
        part_facts(part, f"cam {number}" if several else "", tools, density)
        for number, (part, tools) in enumerate(
            zip(result.parts, result.part_subject.tools, strict=True), start=1
        )
    ]
    return parts if several else parts[0]


def ends_of(found: Range, scale: float = 1.0) -> dict[str, float]:
    """Return both ends of the range `found`, times a `scale`."""
    return extent(found.low.value, found.high.value, scale)


def size(wall: Wall, made: Contour, clearance: float = 0.0) -> Tree:
    """Return the sizes of a finished wall, with clearance.

    Parameters
    ----------
    wall : Wall
        The curve that the follower touches.
    made : Contour
        The curve that is cut.
    clearance : float, mm
        Distance between them.

    Returns
    -------
    dict
        Facts by key.
    """
    reach = np.abs(made.points)
    least = min(float(reach.min()), wall.nearest_flat - clearance)
    common = {
        "chord_error_mm": made.chord_error,
        "vertices": len(made.points),
        "radius_mm": extent(least, float(reach.max())),
    }
    if clearance:
        return {"clearance_mm": clearance, "area_mm2": made.moments.area, **common}
    return {
        "perimeter_mm": wall.size.perimeter,
        "area_mm2": wall.size.area,
        "least_vertices": wall.sampler.least,
        **common,
    }


def curvature(wall: Wall) -> Tree:
    """Return the smallest radii of profile and pitch curve: all, rises, returns, each sign."""
    convex, concave = wall.profile_radius
    made = {"profile_min_mm": min(convex, concave)}
    whole = wall.pitch_curvature()
    made["pitch_min_mm"] = min(convex, concave) if whole is None else whole.least_radius
    for kind in ("rise", "return"):
        found = wall.pitch_curvature(kind)
        if found is not None:
            made[f"pitch_{kind}_min_mm"] = found.least_radius
    made |= {"profile_convex_min_mm": convex, "profile_concave_min_mm": concave}
    which = f", {wall.called}" if wall.key else ""
    return {
        name: Fact(value, _RADII[name] + which, shown=name in _SHOWN)
        for name, value in made.items()
        if math.isfinite(value)
    }


def start_angle(motion: PitchMotion) -> float | None:
    """Return the angle at zero lift of an oscillating follower, deg."""
    follower = motion.follower
    return math.degrees(follower.start) if follower.angular else None


def trimming(wall: Wall) -> Tree:
    """Return where a `wall` is undercut, and the lift lost by trimming."""
    corners, swings, scale = bool(wall.edges), wall.follower.angular, wall.carrier.driver.scale
    return {
        "undercut": [[scale * low, scale * high] for low, high in wall.undercut_ranges],
        "lost_lift_deg": math.degrees(wall.shortfall) if corners and swings else None,
        "lost_lift_mm": wall.shortfall if corners and not swings else None,
    }
