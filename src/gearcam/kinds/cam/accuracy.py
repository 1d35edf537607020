"""Error estimates of a cam, one for each family of its numbers."""

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
"""Estimate and method by name."""

_ROUNDED: Final = "largest change over the turn if every input changes by its rounding"
_UNKNOWN: Final = f"{_ROUNDED} and the lift by its interpolation error"
_GAUSS: Final = (
    "Gauss-Legendre quadrature with fewer cells, interpolation error of the lift, and rounding"
)


def error_rows(result: CamResult) -> Rows:
    """Return the error estimates of a cam.

    Parameters
    ----------
    result : CamResult
        A built design.

    Returns
    -------
    dict of str to (float, str)
        Estimate and method by name, without those of chords and files.
    """
    cam, program = result.cam, result.program
    moved, how = Moved(program), _UNKNOWN if any(program.errors) else _ROUNDED
    motion = zip(result.cam.motions[0].motion_scales.items(), moved.lift, strict=True)
    rows = {name: (scale * off, how) for (name, scale), off in motion}
    rows |= {name: (value, how) for name, value in _shape(cam, moved)}
    rows |= dict(_trimming(result, moved))
    rows |= dict(_sizes(result))
    if result.ordered:
        rows |= tool_errors(result.part_subject.tools)
    return rows


def _shape(cam: Cam, moved: Moved) -> Iterator[tuple[str, float]]:
    """Yield the errors of contact, curvature and profile, the largest of all walls."""
    curves = [motion.pitch_curve for motion in cam.motions]
    walls = [wall.curve for wall in cam.walls]
    slant = max(moved.error(one, pressure_angle) for one in curves)
    yield "pressure_angle_deg", math.degrees(slant)
    if curves[0].follower.has_centre:
        yield "curvature_per_mm", max(moved.error(one, pitch_curvature) for one in curves)
    else:
        yield "radius_mm", max(moved.error(one, face_radius) for one in walls)
        yield "contact_mm", max(moved.error(one, contact_place) for one in walls)
    yield "profile_mm", max(moved.error(one, profile_point) for one in walls)


def _trimming(result: CamResult, moved: Moved) -> Iterator[tuple[str, tuple[float, str]]]:
    """Yield the errors of undercut ranges, lost lift, and lost motion between two walls."""
    cam, driver, (scale, unit) = result.cam, result.driver, result.follower.lift_unit
    if any(wall.undercut for wall in cam.walls):
        off = driver.scale * max(undercut_error(moved, wall) for wall in cam.walls)
        how = "change of the speed along the profile if every input changes by its rounding, "
        yield f"undercut_{driver.unit}", (off, f"{how}over the slope of the speed")
    if any(wall.corners for wall in cam.walls):
        off = scale * max(lost_lift_error(moved, wall) for wall in cam.walls)
        how = "lift on a corner that is moved by the gap between its two sides, and rounding"
        yield f"lost_lift_{unit}", (off, how)
    if (lost := cam.lost_motion) is not None:
        off = scale * play_error(moved, cam.motions[0], cam.walls, lost.theta)
        yield f"lost_motion_{unit}", (off, "errors of both walls, along the follower's motion")


def _sizes(result: CamResult) -> Iterator[tuple[str, tuple[float, str]]]:
    """Yield the errors of sizes: of walls before clearance, and of parts."""
    if not result.design.blank.clearance:
        for wall in result.cam.walls:
            prefix, size = f"{wall.key}_" if wall.key else "", wall.size
            yield f"{prefix}perimeter_mm", (size.perimeter_error, _GAUSS)
            if wall.program.closed:
                yield f"{prefix}area_mm2", (size.area_error, _GAUSS)
    if result.ordered and result.design.blank.density is not None:
        walls = sum(wall.cubics_missed for wall in result.cam.walls)
        off = max(quadrature_error(part).area + part.width * walls for part in result.parts)
        how = "cubics through dense points with halved steps on walls, with doubled steps on all "
        how += "edges; rounding"
        yield "volume_mm3", (off, how)
