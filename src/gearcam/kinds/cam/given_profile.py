"""The inverse problem: the motion of the design's follower on a given profile, and its study."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Fact
from gearcam.base.findings import Finding, Limits, run_checks
from gearcam.cams.follow import follow
from gearcam.cams.spec import FOLLOWED
from gearcam.cams.wall import Wall
from gearcam.numeric.arguments import points
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import flatten_bulges
from gearcam.results.outline_file import read_closed, straight
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.cam.result import CamResult
    from gearcam.results.study import Progress

_LIFTS: Final = ("s", "s_asked", "difference", "error", "s_fitted", "missed")
"""Columns in the unit of the lift, which their names do not say."""

_FILE: Final = "followed.csv"

_SAGITTA = 0.01
"""Chord error of flattened arcs, in chord tolerances of the design."""


def read_profile(file: str | Path | ArrayLike, wall: Wall) -> tuple[Plane, Array]:
    """Return a closed profile, read from a file or from points.

    Parameters
    ----------
    file : path or (n, 2) array, mm
        A DXF file with one closed outline (or one on the layer PROFILE, OUTLINE or INNER), or a CSV
        file with the columns x_mm and y_mm; or the points themselves.
    wall : Wall
        The wall; if outside the pitch curve it is on the layer OUTER.

    Returns
    -------
    outline : (n,) complex array, mm
        First not repeated.
    bulges : (n,) array
        Bulges of the pieces between them.

    Raises
    ------
    DesignError
        If the file cannot be read, or does not contain such a profile.
    """
    if not isinstance(file, str | os.PathLike):
        return straight(points("profile", file))
    also = "; with fit (--fit) also a CSV file of the lift: theta_deg, and lift_mm or lift_deg"
    return read_closed(os.fspath(file), what="a profile", outer=wall.side < 0, also=also)


def followed(
    wall: Wall, outline: Plane, bulges: Array, theta: Array, limits: Limits
) -> tuple[dict[str, Array], dict[str, Any], tuple[Finding, ...]]:
    """Return the motion of a cam's follower on a profile.

    Parameters
    ----------
    wall : Wall
        With the follower, as wide as a groove, the size of the cam, and the lift to compare with.
    outline : (n,) complex array, mm
        The profile in the cam's frame, as for the design.
    bulges : (n,) array
        Bulges of its pieces.
    theta : (m,) array, rad
        Cam angles.
    limits : mapping of str to float
        Limits of the design.

    Returns
    -------
    columns : dict of str to (m,) array
        For ``followed.csv``: the lift of the profile, the lift of the design, their difference.
    facts : dict
        Facts of the study.
    findings : tuple of Finding
        Findings of the checks.

    Raises
    ------
    InfeasibleError
        If the follower cannot rest on the profile.
    """
    outline = flatten_bulges(outline, bulges, _SAGITTA * wall.tolerance)
    carrier = wall.carrier
    # output of a cam that slides is the mirror image, which `follow` expects
    mirrored = wall.clockwise and carrier.around
    found = follow(
        -np.conj(outline) if mirrored else outline,
        wall.follower,
        theta,
        carrier=carrier,
        side=wall.side,
        missed=wall.tolerance,
    )
    scale, unit = wall.follower.lift_unit
    columns, facts = compared(wall, theta, found.lift)
    columns |= {
        "error": scale * found.error,
        "contact_x_mm": -found.contact.real if mirrored else found.contact.real,
        "contact_y_mm": found.contact.imag,
    }
    error = Fact(
        float(scale * found.error.max()), "error of the profile's chords", unit=unit, shown=True
    )
    facts |= {"points": len(outline), "error": error}
    return columns, facts, run_checks(FOLLOWED, (wall, found), limits)


def compared(wall: Wall, theta: Array, lift: Array) -> tuple[dict[str, Array], dict[str, Any]]:
    """Return the columns and the facts of a given lift beside that of the design.

    Parameters
    ----------
    wall : Wall
        The wall of the follower.
    theta : (n,) array, rad
        Cam angles.
    lift : (n,) array, mm or rad
        Lifts.
    """
    (scale, unit), driver = wall.follower.lift_unit, wall.carrier.driver
    asked = wall.program.derivatives(theta, 0)[0]
    difference = scale * (lift - asked)
    worst = int(np.abs(difference).argmax())
    columns = {
        driver.column: driver.scale * theta,
        "s": scale * lift,
        "s_asked": scale * asked,
        "difference": difference,
    }
    facts = {
        "points": len(theta),
        "unit": unit,
        "largest_difference": Fact(
            float(difference[worst]),
            "largest difference from the lift of the design",
            place=driver.place(float(theta[worst])),
            unit=unit,
            shown=True,
        ),
        f"at_{driver.unit}": driver.scale * float(theta[worst]),
        "rms_difference": float(np.sqrt(np.mean(difference**2))),
    }
    return columns, facts


def study_follow(result: CamResult, progress: Progress, **given: Any) -> StudyResult:
    """Return the study of a profile.

    Parameters
    ----------
    result : CamResult
        The cam.
    progress : Progress
        Called with what is computed, the number done and their total.
    **given
        The arguments of `CamResult.follow`; by default the settings of the design.
    """
    spec = result.design.follow
    asked = given or {"profile": spec.file or "", "wall": spec.wall, "fit": spec.fit}
    return _follow(result, progress, **asked)


def demand(design: Any) -> None:
    """Refuse a design without a profile, or one of which none can be fitted.

    Raises
    ------
    DesignError
    """
    if design.follow.fit:
        from gearcam.kinds.cam.fit import demand_fit

        demand_fit(design)
    if design.follow.file is None:
        rule = "a DXF or CSV file of a closed profile"
        problem = Problem("is missing", file=design.source, key="follow.file", allowed=rule)
        raise DesignError([problem])


def _follow(
    result: CamResult,
    progress: Progress,
    profile: str | Path | ArrayLike,
    wall: str | None = None,
    *,
    fit: bool = False,
) -> StudyResult:
    """Return the motion of a cam's follower on a given profile (see `CamResult.follow`)."""
    if fit:
        return _fit(result, progress, profile, wall)
    chosen = result.wall(wall)
    progress("profile", 0, 2)
    outline, bulges = read_profile(profile, chosen)
    progress("follow", 1, 2)
    with result.stage("follow"):
        limits = result.design.limits
        columns, facts, found = followed(chosen, outline, bulges, result.angles, limits)
    return StudyResult(
        result=result,
        study=result.kind.studies["follow"],
        file=_FILE,
        table=columns,
        full=dict.fromkeys(_LIFTS, f"lift_{facts['unit']}"),
        group=facts,
        study_findings=found,
    )


def _fit(
    result: CamResult,
    progress: Progress,
    profile: str | Path | ArrayLike,
    wall: str | None,
) -> StudyResult:
    """Return the same with the design that has this motion."""
    from gearcam.kinds.cam import fit as fitting

    fitting.demand_fit(result.design)
    chosen = result.wall(wall)
    rows = fitting.read_lift(profile, chosen)
    if rows is None:
        study = _follow(result, progress, profile, wall)
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
    progress("fit", 0, 1)
    with result.stage("fit"):
        one = fitting.fit(result, chosen, theta, lift, error=error, source=profile)
        columns, facts = columns | one.columns, facts | {"fit": one.facts}
    # the motion of the given design stands only for another one
    facts |= {"largest_difference": replace(facts["largest_difference"], shown=False)}
    found = tuple(finding for finding in found if finding.code != "other-profile")
    study = StudyResult(
        result=one.named_as_given,
        study=result.kind.studies["follow"],
        file=_FILE,
        table=columns,
        full=dict.fromkeys(_LIFTS, f"lift_{facts['unit']}"),
        group=facts,
        study_findings=(*found, *one.findings),
        drawn=one.charts,
        pages={fitting.FILE: one.page},
    )
    # the headline of a build is that of the given design; that of the study itself is this one
    _, *sizes = one.named_as_given.design_facts.headline
    fit = {"design": Fact(", ".join(sizes), "fitted design", shown=True), **facts["fit"]}
    lines = tuple(study.facts.lines(f"{study.study.key}."))
    return replace(study, group=facts | {"fit": fit}, lines=lines)
