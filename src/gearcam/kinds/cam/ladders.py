"""Stages of cams at rising resolution (`gearcam.results.ladders`)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.cams.three_points import three_point_curvature
from gearcam.kinds.cam.curvature import curvature_at, pitch_points
from gearcam.kinds.cam.given_profile import followed
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.sampling import Sampler
from gearcam.results.ladders import (
    CHORD_ORDER,
    Ladder,
    Ladders,
    limit_ladder,
    outline_ladder,
    solid_ladder,
    tolerances_around,
)

if TYPE_CHECKING:
    from gearcam.kinds.cam.result import CamResult

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
