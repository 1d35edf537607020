"""From the sizes of a design to a globoidal cam; refuses what cannot be.

Refused: velocities that jump (a corner in space), rollers that touch each other or the middle of
the cam, a core inside the bore, a rib that the rollers cut through, faces beyond the turret.
"""

from __future__ import annotations

import math
from dataclasses import replace

from gearcam.base.errors import ABOVE, InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted, shortened
from gearcam.laws.indexing import IndexProgram
from gearcam.spatial.envelope import Roller
from gearcam.spatial.globoidal import GloboidalCam
from gearcam.spatial.globoidal_spec import GloboidalSpec, TurretSpec
from gearcam.spatial.make import demand_smooth


def make_globoidal(
    program: IndexProgram, turret: TurretSpec, cam: GloboidalSpec, bore: float
) -> GloboidalCam:
    """Return a globoidal cam.

    Parameters
    ----------
    program : IndexProgram
        The angle of the turret over a turn.
    turret : TurretSpec
        The turret and its rollers.
    cam : GloboidalSpec
        The cam.
    bore : float, mm
        Radius of the bore.

    Returns
    -------
    GloboidalCam

    Raises
    ------
    InfeasibleError
        See above.
    """
    demand_smooth(program, "index")
    made = GloboidalCam(
        program=program,
        distance=cam.center_distance,
        stops=turret.stops,
        roller=Roller(radius=turret.roller_radius),
        top=turret.hub + cam.floor_clearance,
        hub=turret.hub,
        reach=turret.reach,
        # the rim of a roller's end is farther from the turret's axis than its middle
        floor=math.hypot(turret.reach, turret.roller_radius) + cam.floor_clearance,
        length=cam.length or turret.hub,
        clearance=cam.roller_clearance,
        clockwise=cam.clockwise,
    )
    _demand_ring(made, turret, cam)
    _demand_core(made, bore)
    _demand_rib(made, turret)
    if cam.length is None:
        made = replace(made, length=shortened(made.least_length, 1.0))
    _demand_faces(made, given=cam.length is not None)
    return made


def _demand_ring(cam: GloboidalCam, turret: TurretSpec, given: GloboidalSpec) -> None:
    """Refuse ribs that have no height, or rollers that touch each other there."""
    if cam.top >= cam.reach:
        most = turret.roller_length
        what = "the ribs would be outside the reach of the rollers"
        raise beyond_limit(
            what, "cam.floor_clearance_mm", given.floor_clearance, most, near=most / ABOVE / 10.0
        )
    room = 2.0 * cam.top * math.sin(0.5 * cam.pitch) - 2.0 * turret.roller_radius
    if cam.clearance >= room:
        what = "the grooves of neighbouring rollers would meet"
        raise beyond_limit(
            what, "cam.roller_clearance_mm", cam.clearance, room, near=shortened(room / 100, -1.0)
        )


def _demand_core(cam: GloboidalCam, bore: float) -> None:
    """Refuse a core that is thinner than the bore or the rollers."""
    core, least = cam.distance - cam.floor, max(bore, cam.tool.radius)
    if core > least:
        return
    thing = "bore" if least == bore else "radius of the rollers"
    what = f"the core of the cam is not thicker than the {thing}"
    limit = cam.floor + least
    raise beyond_limit(
        what,
        "cam.center_distance_mm",
        cam.distance,
        limit,
        near=shortened(ABOVE * limit, 1.0),
    )


def _demand_rib(cam: GloboidalCam, turret: TurretSpec) -> None:
    """Refuse a rib that its rollers cut through."""
    least = cam.least_rib
    if least.value > 0.0:
        return
    most = turret.roller_radius + 0.5 * least.value
    angle = formatted(math.degrees(least.theta), 5)
    what = f"the rollers cut through the rib at {angle} deg, where it is steep"
    if most <= 0.0:
        allowed = "a larger index angle, centre distance or number of stops"
        raise InfeasibleError(what, where="turret.roller_radius_mm", nearest=allowed)
    raise beyond_limit(
        what, "turret.roller_radius_mm", turret.roller_radius, most, near=shortened(most, -1.0)
    )


def _demand_faces(cam: GloboidalCam, *, given: bool) -> None:
    """Refuse faces at which the ribs would be beyond the turret's axis."""
    most = 2.0 * cam.top
    if cam.length < most:
        return
    what = "the faces of the cam would be beyond the body of the turret"
    if given:
        raise beyond_limit(what, "cam.length_mm", cam.length, most, near=cam.least_length)
    what = "with so few stops the cam cannot hold the turret at all times"
    raise InfeasibleError(
        what,
        where="turret.stops",
        value=cam.least_length,
        limit=most,
        unit="mm",
        nearest="least length of the cam, and twice the radius of the turret's body; more stops",
    )
