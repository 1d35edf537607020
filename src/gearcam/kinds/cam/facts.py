"""Facts of a cam: what the console, the report and ``summary.json`` show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gearcam.base.facts import Fact, Facts, extent
from gearcam.base.findings import limit_of
from gearcam.base.numerals import formatted
from gearcam.cams.checks import KIND, pressure_limit
from gearcam.kinds.cam.wall_facts import ends_of
from gearcam.parts.facts import part_facts

if TYPE_CHECKING:
    from gearcam.cams.wall import PitchMotion
    from gearcam.kinds.cam.build import CamResult
    from gearcam.laws.program import Program

Tree = dict[str, Any]

_PEAKS = (
    ("peak_velocity", "largest velocity", 1),
    ("peak_acceleration", "largest acceleration", 2),
    ("peak_jerk", "largest jerk", 3),
)


def facts(result: CamResult) -> Facts:
    """Return the facts of a cam, its `result`."""
    design = result.design
    tree: Tree = {
        "kerf_mm": design.output.kerf or None,
        "motion": _motion(result),
        "cam": _cam(result),
        "part": _part(result) or None,
        "accuracy": result.accuracy,
    }
    follower = f"{design.follower.motion} {design.follower.type} follower"
    article = "an" if design.follower.oscillating else "a"
    headline = ("motion.total_lift", f"cam.{result.form.leading}")
    return Facts(tree, headline, f"{design.cam.form} cam for {article} {follower}")


def _motion(result: CamResult) -> Tree:
    """Return lift in mm or deg and the peaks of its derivatives that are finite."""
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
            name: Fact(
                scale * peak,
                meaning,
                unit=f"{unit}/{driver.per}{order if order > 1 else ''}",
                shown=True,
            )
            for (name, meaning, order), peak in zip(
                _PEAKS[: program.continuity + 1], program.peaks, strict=False
            )
        },
    }


def _deviation(program: Program, scale: float, unit: str) -> Fact | None:
    """Return the largest distance of a smoothed lift from the rows of its table."""
    if program.deviation is None:
        return None
    place = f"at {formatted(math.degrees(program.deviation.theta), scale=360.0)} deg"
    value, meaning = scale * program.deviation.value, "largest distance from the given points"
    return Fact(value, meaning, place=place, unit=unit, shown=True)


def _cam(result: CamResult) -> Tree:
    design, given = result.design, result.design.follower
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
    limit = pressure_limit(result.follower, given)
    for kind in ("rise", "return"):
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
    return made


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
    told = [
        part_facts(part, f"cam {number}" if several else "", tools, density)
        for number, (part, tools) in enumerate(
            zip(result.parts, result.part_subject.tools, strict=True), start=1
        )
    ]
    return told if several else told[0]
