"""Facts of the motions and walls of a cam: pressure angles, curvature, trimming, sizes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.findings import limit_of
from gearcam.cams.checks import KIND, pressure_limits

if TYPE_CHECKING:
    from gearcam.base.findings import Limits
    from gearcam.cams.measures import Range
    from gearcam.cams.wall import PitchMotion, Wall
    from gearcam.numeric.contour import Contour

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


def pressure(motion: PitchMotion, limits: Limits) -> Tree:
    """Return the pressure angles of rises and returns.

    Parameters
    ----------
    motion : PitchMotion
        One of the motions of a cam.
    limits : mapping of str to float
        Limits of the design.

    Returns
    -------
    dict
        Of facts.
    """
    made: Tree = {}
    whose = f", {motion.called}" if motion.key else ""
    given = limit_of(KIND, "pressure-angle", limits)
    largest = 0.0
    for kind, limit in pressure_limits(motion.follower, given).items():
        found = motion.pressure(kind)
        if found is not None:
            worst = max(found.low, found.high, key=lambda end: abs(end.value))
            made[f"{kind}_max"] = Fact(
                math.degrees(found.largest),
                f"pressure angle, {kind}{whose}",
                at_most=math.degrees(limit),
                place=motion.carrier.driver.place(worst.theta),
                unit="deg",
                shown=found.largest > 0.0,
            )
            made[kind] = Fact(ends_of(found, math.degrees(1.0)), unit="deg")
            largest = max(largest, found.largest)
    return {"max": Fact(math.degrees(largest), unit="deg")} | made if made else made


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
