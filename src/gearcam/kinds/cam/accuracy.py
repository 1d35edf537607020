"""What the accuracy block of a cam says: an estimate for each family of its numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from gearcam.cams.moved import (
    Moved,
    contact_place,
    face_radius,
    lost_lift_error,
    pitch_curvature,
    play_error,
    pressure_angle,
    profile_point,
    undercut_error,
)
from gearcam.parts.mass import quadrature_error
from gearcam.parts.tools import tool_errors

if TYPE_CHECKING:
    from gearcam.cams.cam import Cam
    from gearcam.kinds.cam.build import CamResult

Rows = dict[str, tuple[float, str]]
"""Estimates and how each was made, by name."""

_MOVED: Final = "largest change of the turn when every number that it comes from is moved by "
_ROUNDED: Final = f"{_MOVED}its rounding"
_UNKNOWN: Final = f"{_MOVED}its rounding, and the lift by what is not known of it beyond that"
_GAUSS: Final = (
    "Gauss-Legendre quadrature with fewer cells, what is not known of the lift, and rounding"
)


def error_rows(result: CamResult) -> Rows:
    """Return the estimated errors of a cam.

    Parameters
    ----------
    result : CamResult
        A built design.

    Returns
    -------
    dict of str to (float, str)
        Each with how it was made, by name; chords and files are not among them.
    """
    cam, program = result.cam, result.program
    moved, how = Moved(program), _UNKNOWN if any(program.errors) else _ROUNDED
    motion = zip(result.mechanism.motion_scales.items(), moved.lift, strict=True)
    rows = {name: (scale * off, how) for (name, scale), off in motion}
    rows |= {name: (value, how) for name, value in _shape(cam, moved)}
    rows |= dict(_trimming(result, moved))
    rows |= dict(_sizes(result))
    if result.ordered:
        rows |= tool_errors(result.part_subject.tools)
    return rows


def _shape(cam: Cam, moved: Moved) -> Iterator[tuple[str, float]]:
    """Yield the errors of what is told of the contact and of curves, the largest of all walls."""
    curves = [motion.curve for motion in cam.motions]
    walls = [wall.curve for wall in cam.walls]
    slant = max(moved.error(one, pressure_angle) for one in curves)
    yield "pressure_angle_deg", math.degrees(slant)
    if curves[0].mechanism.flat:
        yield "radius_mm", max(moved.error(one, face_radius) for one in walls)
        yield "contact_mm", max(moved.error(one, contact_place) for one in walls)
    else:
        yield "curvature_per_mm", max(moved.error(one, pitch_curvature) for one in curves)
    yield "profile_mm", max(moved.error(one, profile_point) for one in walls)


def _trimming(result: CamResult, moved: Moved) -> Iterator[tuple[str, tuple[float, str]]]:
    """Yield the errors of what undercut costs, and of the lost motion between two walls."""
    cam, driver, (scale, unit) = result.cam, result.mechanism.driver, result.mechanism.outward
    if any(wall.undercut for wall in cam.walls):
        off = driver.scale * max(undercut_error(moved, wall) for wall in cam.walls)
        how = "change of the speed along the profile when all is moved by its rounding, over its "
        yield f"undercut_{driver.unit}", (off, f"{how}slope")
    if any(wall.corners for wall in cam.walls):
        off = scale * max(lost_lift_error(moved, wall) for wall in cam.walls)
        how = "the follower on a corner moved by as much as its two sides miss each other, and by "
        yield f"lost_lift_{unit}", (off, f"{how}rounding")
    if (lost := cam.lost_motion) is not None:
        off = scale * play_error(moved, cam.motions[0], cam.walls, lost.theta)
        yield f"lost_motion_{unit}", (off, "errors of both walls there, as the follower feels them")


def _sizes(result: CamResult) -> Iterator[tuple[str, tuple[float, str]]]:
    """Yield the errors of sizes: of walls as they are touched, and of parts."""
    if not result.design.blank.clearance:
        for wall in result.cam.walls:
            prefix, size = f"{wall.key}_" if wall.key else "", wall.size
            yield f"{prefix}perimeter_mm", (size.perimeter_error, _GAUSS)
            if wall.program.closed:
                yield f"{prefix}area_mm2", (size.area_error, _GAUSS)
    if result.ordered and result.design.blank.density is not None:
        walls = sum(wall.cubics_missed for wall in result.cam.walls)
        off = max(quadrature_error(part).area + part.width * walls for part in result.parts)
        how = "cubics through dense points of walls with halved, of all edges with doubled steps; "
        how += "rounding"
        yield "volume_mm3", (off, how)
