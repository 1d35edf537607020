"""From the sizes of a design to a cam in space; refuses what cannot be.

Refused: velocities that jump (a corner in space), a groove that leaves the cylinder, a floor at the
bore, a cone whose tip lies in the groove, an arm that carries the roller past the middle.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import ABOVE, InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted, shortened
from gearcam.base.quantities import LENGTH
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.envelope import Roller
from gearcam.spatial.guides import AcrossGuide, Straight, SwingArm
from gearcam.spatial.spec import WALLS, CylinderSpec, SpatialFollower

_INSIDE: Final = 0.05
"""How far inside the range of the pivot's distance the suggested one is, as a share of it."""


def make_cylinder(
    program: Program, follower: SpatialFollower, cam: CylinderSpec, bore: float
) -> SpatialCam:
    """Return a cylinder cam.

    Parameters
    ----------
    program : Program
        The lift over a turn.
    follower : SpatialFollower
        Its roller and how it is guided.
    cam : CylinderSpec
        The cylinder.
    bore : float, mm
        Radius of the bore.

    Returns
    -------
    SpatialCam

    Raises
    ------
    InfeasibleError
        See above.
    """
    demand_smooth(program)
    depth = cam.groove_depth
    length = follower.roller_length or depth
    if length > depth:
        what = "the roller reaches deeper than the groove"
        raise beyond_limit(what, "follower.roller_length_mm", length, depth, near=depth)
    if cam.floor <= bore:
        most = cam.outer_radius - cam.floor_clearance - bore
        what, note = "the floor of the groove is inside the bore", "the limit is where they meet"
        if most <= 0.0:  # no groove has room: the bore is too large
            wide = 2.0 * cam.floor
            raise beyond_limit(
                what, "blank.bore_diameter_mm", 2.0 * bore, wide, note, near=wide / ABOVE
            )
        raise beyond_limit(what, "cam.groove_depth_mm", depth, most, note)
    made = SpatialCam(
        program=program,
        guide=_guide(program, follower, cam.lowest),
        roller=Roller(
            radius=follower.roller_radius,
            at=cam.outer_radius,
            half_angle=follower.half_angle(cam.outer_radius),
        ),
        inner=cam.outer_radius - length,
        floor=cam.floor,
        outer_radius=cam.outer_radius,
        clearance=cam.roller_clearance,
        sides=WALLS[cam.walls],
        clockwise=cam.clockwise,
        apart=0.0
        if cam.rib is None
        else cam.rib + 2.0 * follower.roller_radius + cam.roller_clearance,
    )
    _demand_cone(made, follower, cam)
    _demand_rib(made, follower)
    _demand_middle(made)
    _demand_room(made, cam)
    return made


def _guide(program: Program, follower: SpatialFollower, lowest: float) -> AcrossGuide:
    if not follower.oscillating:
        return Straight(height=lowest)
    low, high = program.range
    arm = follower.arm or 0.0
    start = -0.5 * (high - low) if follower.start is None else follower.start
    distance = follower.pivot_distance or 0.5 * arm * (1.0 + math.cos(0.5 * (high - low)))
    return SwingArm(length=arm, distance=distance, start=start, height=lowest)


def demand_smooth(program: Program, title: str = "motion") -> None:
    """Refuse velocities that jump.

    Parameters
    ----------
    program : Program
        A lift.
    title : str
        The part of the design that gives it.

    Raises
    ------
    InfeasibleError
        At a knot where its velocity jumps.
    """
    for jump in program.hard:
        where = f"{title}, at {formatted(math.degrees(jump.theta), 5)} deg"
        what = "the velocity jumps, so that the walls would have a corner"
        raise InfeasibleError(
            what, where=where, nearest="a motion law whose velocity is continuous"
        )


def _demand_cone(cam: SpatialCam, follower: SpatialFollower, size: CylinderSpec) -> None:
    """Refuse a cone whose tip lies in the groove: below it the walls would change places.

    On an arm the roller must reach past the middle of the cam at the floor too.
    """
    slope, reach = math.tan(cam.tool.half_angle), cam.outer_radius - cam.inner
    thick = cam.roller.radius - LENGTH.least
    wide = cam.tool.radius - max(LENGTH.least, ABOVE * float(np.abs(_aside(cam)).max()))
    deep = cam.outer_radius - cam.floor
    least = min(cam.roller.radius - reach * slope, cam.tool.radius - deep * slope)
    if least >= LENGTH.least or min(thick, wide) <= 0.0:
        return
    most = math.degrees(math.atan(min(thick / reach, wide / deep)))
    what, angle = "the tip of the conical roller lies in the groove", shortened(most, -1.0)
    depth = wide / slope - size.floor_clearance
    if follower.roller_length is None:
        depth = min(depth, thick / slope)
    note, others = "the limit is for this depth of the groove", list[Adjustment]()
    if depth > LENGTH.least and (follower.roller_length or 0.0) <= min(depth, thick / slope):
        shallow = shortened(depth, -1.0)
        note += f"; with this angle cam.groove_depth_mm may be up to {formatted(shallow)}"
        others = [Adjustment(near={"cam.groove_depth_mm": shallow})]
    value = math.degrees(cam.tool.half_angle)
    raise beyond_limit(
        what, "follower.cone_deg", value, angle, note, near=angle, adjustments=others
    )


def _aside(cam: SpatialCam) -> Array:
    """Return how far the roller is from the middle of the cam over a turn, mm."""
    point, _ = cam.guide.placed(cam.program.derivatives(cam.program.survey.places.ravel(), 0)[0])
    return point[0, :, 1]


def _demand_rib(cam: SpatialCam, follower: SpatialFollower) -> None:
    """Refuse a rib under an arm, and one that its rollers cut through."""
    if not cam.apart:
        return
    if follower.oscillating:
        what = "two rollers on an arm do not embrace a rib"
        raise InfeasibleError(what, where="cam.walls", nearest='a translating follower, or "both"')
    least, rib = cam.least_rib, cam.apart - 2.0 * cam.tool.radius
    if least is not None and least.value <= 0.0:
        width = 2.0 * cam.tool.radius_at(least.x)
        most = cam.apart * width / (least.value + width) - 2.0 * cam.tool.radius
        what = f"the rollers cut through the rib at {formatted(math.degrees(least.theta), 5)} deg"
        raise beyond_limit(what, "cam.rib_mm", rib, most, near=shortened(ABOVE * most, 1.0))


def _demand_middle(cam: SpatialCam) -> None:
    """Refuse an arm that carries the end of the roller past the middle of the cam."""
    if not isinstance(cam.guide, SwingArm):
        return
    aside, radius = _aside(cam), cam.tool.radius_at(cam.floor)
    if np.abs(aside).max() < radius:
        return
    distance = cam.guide.distance
    least, most = float(aside.max()) + distance - radius, float(aside.min()) + distance + radius
    if least >= most:
        what = "the arm swings so far that the roller leaves the middle of the cam"
        allowed = "a longer arm, a smaller lift or a larger roller"
        raise InfeasibleError(what, where="follower.arm_mm", nearest=allowed)
    what = "the pivot is where the roller does not stay on the middle of the cam"
    limit, side = (least, 1.0) if distance <= least else (most, -1.0)
    note = f"from {formatted(least)} to {formatted(most)} mm, both excluded"
    near = shortened(limit + side * _INSIDE * (most - least), side)
    raise beyond_limit(what, "follower.pivot_distance_mm", distance, limit, note, near=near)


def _demand_room(cam: SpatialCam, size: CylinderSpec) -> None:
    """Refuse a groove that leaves the cylinder."""
    low, high = cam.heights
    half = cam.tool.radius_at(cam.outer_radius)
    if cam.apart:
        half = 0.5 * cam.apart - half
    if -1 in cam.sides and low - half <= 0.0:
        what, near = "the groove leaves the lower face of the cylinder", size.lowest + half - low
        raise beyond_limit(
            what, "cam.lowest_mm", size.lowest, near, near=shortened(ABOVE * near, 1.0), unit="mm"
        )
    if 1 in cam.sides and high + half >= size.length:
        what, near = "the groove leaves the upper face of the cylinder", high + half
        raise beyond_limit(
            what, "cam.length_mm", size.length, near, near=shortened(ABOVE * near, 1.0), unit="mm"
        )
