"""The checks of globoidal cams: pressure angle, undercut, hold, lost motion, thin ribs, shocks.

Importing this module registers them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from gearcam.base.findings import Remark, check
from gearcam.base.numerals import FEW, formatted, shortened
from gearcam.base.quantities import ANGLE, LENGTH, Param
from gearcam.base.readable import readable
from gearcam.mechanics.clearance import without_clearance
from gearcam.spatial.globoidal import GloboidalCam
from gearcam.spatial.remarks import shocks, smaller_roller, thin_rib

KIND: Final = "globoidal cams"
"""Their group."""

SOLID: Final = "solids of globoidal cams"
"""The group of what is looked at where a solid is made."""

_SLACK: Final = 1e-6
"""Length that may be missing without a finding, over the length: a value typed in digits."""

Subject = tuple[GloboidalCam, float]
"""What is checked: a cam and the radius of its bore, mm."""


@check(
    "pressure-angle",
    kind=KIND,
    limit=(
        "pressure_angle",
        Param(ANGLE, gt=0, lt=90, doc="largest pressure angle along the rollers"),
        math.radians(45.0),
    ),
    relation="at most",
)
def pressure_angle(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of large pressure angles anywhere along the rollers.

    Looks at: the pressure angle of the roller nearest to the middle of the cam, along the part of
    it that is on the ribs; it is largest at its end.
    """
    cam, _ = subject
    worst = cam.pressure
    if worst.value <= limit:
        return
    angle = math.degrees(worst.value)
    yield Remark(
        f"The pressure angle reaches {formatted(angle, FEW)} deg. A larger index angle reduces it.",
        worst.place,
        angle,
    )


@check("undercut", kind=KIND, severity="error", unit="mm", relation="at least")
def undercut(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report a wall that the rollers cut away at another cam angle.

    Looks at: how the walls spread in space, where they are on the cam.
    """
    cam, _ = subject
    for wall in cam.walls:
        if not wall.undercut:
            continue
        yield Remark(
            f"The rollers cut away a part of the {wall.key} wall at other angles."
            f"{smaller_roller(wall)}",
            f"{wall.key} wall, {wall.spread.place}",
            wall.spread.value,
            limit=0.0,
        )


@check("carved-solid", kind=SOLID, severity="note", unit="mm")
def carved_solid(subject: tuple[int, float], limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a solid that is not made from its walls, since one is undercut.

    Looks at: the scallops that rollers leave which are subtracted at many angles.
    """
    count, height = subject
    yield Remark(
        f"A wall is undercut: the rib is what the rollers leave at {count} cam angles in a turn, "
        f"by manifold3d. Scallops between them are up to {readable(height, 'mm', digits=3)} high.",
        value=height,
    )


@check("loose-turret", kind=KIND, relation="at least", severity=("warning", "error"), unit="mm")
def loose_turret(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a cam that is too short to hold the turret at all angles.

    It is an error where no roller touches a wall at all in one of the two directions.

    Looks at: whether in each direction a roller presses on a wall along its whole length.
    """
    cam, _ = subject
    least = cam.least_length
    if cam.length >= least * (1.0 - _SLACK):
        return
    free = cam.grip < 0.0
    how = "no roller touches a wall" if free else "no roller presses along its whole length"
    near = formatted(shortened(least, 1.0), FEW)
    yield Remark(
        f"At some angles {how} in one of the two directions. With cam.length_mm = {near} there "
        "is always one in both.",
        "cam.length_mm",
        cam.length,
        severity="error" if free else "warning",
        limit=least,
    )


@check(
    "lost-motion",
    kind=KIND,
    limit=("lost_motion", Param(LENGTH, ge=0, doc="largest lost motion of a roller"), 0.1),
    relation="at most",
)
def lost_motion(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of rollers that can move between two walls.

    Looks at: the clearance over the cosine of the pressure angle.
    """
    lost = subject[0].lost_motion
    if lost.value > limit:
        yield Remark(
            f"A roller can move by {readable(lost.value, 'mm')} while the cam does not.",
            lost.place,
            lost.value,
        )


@check("no-clearance", kind=KIND, severity="note", unit="mm")
def clearances(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note rollers without clearance between two ribs, or at the core.

    Looks at: `cam.roller_clearance_mm` and `cam.floor_clearance_mm`.
    """
    cam, _ = subject
    gap = cam.floor - math.hypot(cam.reach, cam.roller.radius)
    yield from without_clearance(cam.clearance, gap)


@check(
    "thin-wall",
    kind=KIND,
    limit=("wall_thickness", Param(LENGTH, ge=0, doc="least thickness of metal"), 2.0),
    relation="at least",
)
def thin_wall(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of a thin rib, and of little metal between core and bore.

    Looks at: the thickness of the rib along its normal to first order, and the core at its middle.
    """
    cam, bore = subject
    yield from thin_rib(cam.least_rib, limit)
    core = cam.distance - cam.floor - bore
    if bore and core < limit:
        yield Remark(
            f"The metal between the core and the bore is {readable(core, 'mm')} thick.",
            "between the core and the bore",
            core,
        )


@check("acceleration-jump", kind=KIND, severity="note")
def acceleration_jump(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a knot at which the acceleration jumps.

    Looks at: knots where the acceleration jumps, the ends of the index among them.
    """
    yield from shocks(subject[0].program, "turret")
