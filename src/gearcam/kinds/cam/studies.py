"""Studies of cams: motion on a given profile, errors of tolerances, stages at rising resolution."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Fact
from gearcam.base.registry import deferred
from gearcam.cams.three_points import three_point_curvature
from gearcam.kinds.cam.curvature import curvature_at, pitch_points
from gearcam.kinds.cam.given_profile import followed
from gearcam.kinds.shared import accuracy_study
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.sampling import Sampler
from gearcam.results.kind import Study
from gearcam.results.ladders import (
    CHORD_ORDER,
    Ladder,
    Ladders,
    limit_ladder,
    outline_ladder,
    solid_ladder,
    tolerances_around,
)
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import ArrayLike

    from gearcam.kinds.cam.result import CamResult
    from gearcam.results.study import Progress

_FILE: Final = "followed.csv"


def follow(
    result: CamResult,
    profile: str | Path | ArrayLike,
    wall: str | None = None,
    progress: Progress | None = None,
    *,
    fit: bool = False,
) -> StudyResult:
    """Return the motion of a cam's follower on a given profile (see `CamResult.follow`)."""
    from gearcam.kinds.cam.given_profile import followed, read_profile

    if fit:
        return _fit(result, profile, wall, progress)
    chosen = result.wall(wall)
    if progress is not None:
        progress("profile", 0, 2)
    outline, bulges = read_profile(profile, chosen)
    if progress is not None:
        progress("follow", 1, 2)
    with result.stage("follow"):
        limits = result.design.limits
        columns, facts, found = followed(chosen, outline, bulges, result.angles, limits)
    return StudyResult(
        result=result,
        study=FOLLOW,
        file=_FILE,
        table=columns,
        group=facts,
        study_findings=found,
    )


def _fit(
    result: CamResult,
    profile: str | Path | ArrayLike,
    wall: str | None,
    progress: Progress | None,
) -> StudyResult:
    """Return the same with the design that has this motion."""
    from gearcam.kinds.cam import fit as fitting
    from gearcam.kinds.cam.given_profile import compared

    fitting.demand_fit(result.design)
    chosen = result.wall(wall)
    rows = fitting.read_lift(profile, chosen)
    if rows is None:
        study = follow(result, profile, wall, progress)
        columns, found = fitting.of_turn(study), study.study_findings
        facts: dict[str, Any] = dict(study.group)
        scale = chosen.follower.lift_unit[0]
        theta, lift = np.radians(columns["theta_deg"]), columns["s"] / scale
        chords = float(np.sqrt(np.mean(columns["error"] ** 2))) / scale
        # arcs and splines are as far from the true curve as their tolerance allows
        error = max(chords, chosen.tolerance / chosen.follower.lever)
    else:
        (theta, lift), found, error = rows, (), None
        columns, facts = compared(chosen, theta, lift)
    if progress is not None:
        progress("fit", 0, 1)
    with result.stage("fit"):
        one = fitting.fit(result, chosen, theta, lift, error=error, source=profile)
        columns, facts = columns | one.columns, facts | {"fit": one.facts}
    # the motion of the given design stands only for another one
    facts |= {"largest_difference": replace(facts["largest_difference"], shown=False)}
    found = tuple(finding for finding in found if finding.code != "other-profile")
    study = StudyResult(
        result=one.named_as_given,
        study=FOLLOW,
        file=_FILE,
        table=columns,
        group=facts,
        study_findings=(*found, *one.findings),
        drawn=one.charts,
        pages={fitting.FILE: one.page},
    )
    # the headline of a build is that of the given design; that of the study itself is this one
    _, *sizes = one.named_as_given.design_facts.headline
    fit = {"design": Fact(", ".join(sizes), "fitted design", shown=True), **facts["fit"]}
    lines = tuple(study.facts.lines(f"{FOLLOW.key}."))
    return replace(study, group=facts | {"fit": fit}, lines=lines)


def _follow(result: CamResult, progress: Progress | None, **given: Any) -> StudyResult:
    """Return the motion on a `given` profile, wall and fit, by default those of the design."""
    spec = result.design.follow
    asked = given or {"profile": spec.file or "", "wall": spec.wall, "fit": spec.fit}
    return follow(result, progress=progress, **asked)


def _demand(design: Any) -> None:
    if design.follow.fit:
        from gearcam.kinds.cam.fit import demand_fit

        demand_fit(design)
    if design.follow.file is None:
        rule = "a DXF or CSV file of a closed profile"
        problem = Problem("is missing", file=design.source, key="follow.file", allowed=rule)
        raise DesignError([problem])


FOLLOW: Final = Study(
    name="follow",
    key="followed",
    doc="Compute the follower motion on a given profile; write DIR/NAME/followed.csv. With --fit "
    "find the design that moves like this; write DIR/NAME/fitted.toml too.",
    done="followed",
    table="follow",
    compute=_follow,
    argument="file",
    metavar="PROFILE",
    demand=_demand,
    many=False,
)


PRECISION: Final = Study(
    name="precision",
    key="precision",
    doc="Compute how errors of sizes move the follower; write DIR/NAME/precision.csv.",
    done="studied",
    table="precision",
    options={"lift_error_deg": "swing-error"},
    compute=deferred("gearcam.kinds.cam.precision:study_precision"),
)


FORCES: Final = Study(
    name="forces",
    key="forces",
    doc="Compute forces, torque, efficiency and contact pressure; write DIR/NAME/forces.csv.",
    done="computed",
    table="forces",
    compute=deferred("gearcam.kinds.cam.forces:study_forces"),
    demand=deferred("gearcam.kinds.cam.under_load:demand"),
)

STUDIES: Final[dict[str, Study]] = {
    one.name: one for one in (FOLLOW, FORCES, PRECISION, accuracy_study())
}
"""The studies by name."""


_COUNTS: Final = (45, 90, 180, 360, 720, 1440, 2880, 5760)
"""Points of a turn for three-point curvature."""

_ANGLES: Final = 120
"""Cam angles at which the lift of a profile is compared."""


def _outline(result: CamResult) -> Ladder:
    walls, used = result.cam.walls, result.form.chord_tolerance

    def samplers(tolerance: float) -> list[Sampler]:
        cut = [replace(wall, tolerance=tolerance) for wall in walls]
        for wall in cut:
            _ = wall.contour  # computed on demand
        return [wall.sampler for wall in cut]

    reach = max(float(np.abs(wall.outline).max()) for wall in walls)
    measured = "chords of walls" if len(walls) > 1 else "chords of the profile"
    return outline_ladder(used, tolerances_around(used), samplers, measured=measured, reach=reach)


def _solid(result: CamResult) -> Ladder:
    own = result.form.chord_tolerance
    return solid_ladder(result, own, tolerances_around(own)[:-1])


def _contact(result: CamResult) -> Ladder:
    """Return the lift from the polygon of the first finished profile, over chord tolerance."""
    wall = result.cam.walls[0]
    theta = np.linspace(0.0, wall.program.period, _ANGLES, endpoint=False)
    own, outlines = result.form.chord_tolerance, dict[float, Plane]()

    def make(tolerance: float) -> tuple[Array, int]:
        if tolerance not in outlines:
            outlines[tolerance] = replace(wall, tolerance=tolerance).contour.points
        outline = outlines[tolerance]
        bulges = np.zeros(len(outline))
        found, _, _ = followed(wall, outline, bulges, theta, result.design.limits)
        return found["s"], len(outline)

    return limit_ladder(
        own,
        make,
        levels=tolerances_around(own)[:-1],
        measured="lift from the profile",
        unit=result.follower.lift_unit[1],
    )


def _cam(result: CamResult) -> Ladder:
    """Return the rms error of the pitch curve's curvature from three neighbouring points.

    Next to a knot where a derivative of the lift jumps it converges more slowly, or not at all.
    """
    motion = result.cam.motions[0]
    program = motion.program

    def make(count: float) -> tuple[Array, Array]:
        theta = np.arange(int(count), dtype=np.float64) * (program.period / count)
        return theta, three_point_curvature(pitch_points(motion, theta), closed=program.closed)

    def measure(made: tuple[Array, Array]) -> tuple[float, int]:
        theta, curvature = made
        exact = curvature_at(motion, theta)
        error = curvature - (exact if program.closed else exact[1:-1])
        return math.sqrt(np.mean(error**2)), len(theta)

    rough = min((jump.order for jump in program.jumps), default=4)
    return Ladder(
        refined="points of a turn",
        measured="curvature from three points",
        unit="1/mm",
        levels=_COUNTS,
        own=None,
        order=min(CHORD_ORDER, rough - 1.5),
        rounding=0.0,
        make=make,
        measure=measure,
    )


LADDERS: Final[Ladders] = {
    "outline": _outline,
    "solid": _solid,
    "contact": _contact,
    "cam": _cam,
}
