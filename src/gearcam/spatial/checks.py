"""The checks of cams in space: pressure angle, undercut, lost motion, thin walls, slip, shocks.

Importing this module registers them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from gearcam.base.findings import Limits, Remark, check, limit_of
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, LENGTH, Param
from gearcam.base.readable import readable
from gearcam.mechanics.clearance import without_clearance
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.guides import Straight, SwingArm
from gearcam.spatial.remarks import at, shocks, smaller_roller, thin_rib
from gearcam.spatial.surface import Cylinder
from gearcam.spatial.trimmed import lost_lift

KIND: Final = "cams in space"
"""Their group."""

SOLID: Final = "solids of cams in space"
"""The group of what is looked at where a solid is made."""

SWINGING: Final = math.radians(45.0)
ALONG: Final = math.radians(30.0)
"""Default limits of the pressure angle of a follower on an arm and one that moves straight, rad."""

_SLIP: Final = 0.02
"""Share of its speed at which the surface of a roller may slip without a note."""


def pressure_limit(cam: SpatialCam, given: float) -> float:
    """Return the largest pressure angle that is allowed, rad.

    Parameters
    ----------
    cam : SpatialCam
        The cam.
    given : float, rad
        The limit of the design; nan: that of the cam's follower.
    """
    default = ALONG if isinstance(cam.guide, Straight) else SWINGING
    return default if math.isnan(given) else given


def allowed_pressure(cam: SpatialCam, limits: Limits) -> float:
    """Return the largest pressure angle that a design allows, rad.

    Parameters
    ----------
    cam : SpatialCam
        Its cam.
    limits : mapping of str to float
        Its limits.
    """
    return pressure_limit(cam, limit_of(KIND, "pressure-angle", limits))


Subject = tuple[SpatialCam, Cylinder]
"""What is checked: a cam and what it is made from."""


@check(
    "pressure-angle",
    kind=KIND,
    limit=(
        "pressure_angle",
        Param(
            ANGLE,
            gt=0,
            lt=90,
            example=30,
            doc="largest pressure angle along the roller; 30 translating, 45 oscillating",
        ),
        math.nan,
    ),
    relation="at most",
)
def pressure_angle(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of large pressure angles anywhere along the roller.

    Looks at: the pressure angle between the inner end of the roller and the outside of the cam; it
    is largest at the inner end.
    """
    cam, _ = subject
    worst, largest = cam.pressure(), pressure_limit(cam, limit)
    if worst is None or worst.value <= largest:
        return
    angle = math.degrees(worst.value)
    yield Remark(
        f"The pressure angle reaches {readable(angle, 'deg')}, {formatted(worst.x, 4)} mm from the "
        "axis.",
        at(worst.theta),
        angle,
        limit=math.degrees(largest),
    )


@check(
    "undercut",
    kind=KIND,
    limit=("lost_lift", Param(LENGTH, ge=0, doc="largest lift that undercut may lose"), 0.01),
    relation="at most",
    severity=("warning", "error"),
)
def undercut(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of a wall that the roller cuts away at another cam angle.

    It is an error where this costs more lift than the limit.

    Looks at: how walls spread in space, and how far the follower can move towards the wall left.
    The condition in the developed plane allows larger rollers than there is room for.
    """
    cam, _ = subject
    for wall in cam.walls:
        if not wall.undercut:
            continue
        loss, guide = lost_lift(wall), cam.guide
        lost = loss.way.value * (guide.length if isinstance(guide, SwingArm) else 1.0)
        angle = ""
        if isinstance(guide, SwingArm):
            angle = f" ({formatted(math.degrees(loss.way.value), 3)} deg)"
        cut = (
            f"The roller cuts the {wall.key} wall at other angles, so little that no lift is lost."
        )
        if lost > 0.0:
            depth = readable(loss.depth.value, "mm", digits=3)
            beyond = readable(lost, "mm", digits=3)
            cut = (
                f"The roller cuts up to {depth} off the {wall.key} wall at other angles. The "
                "roller then rests on an edge: if only this place on it touched, the follower "
                f"could move by {beyond}{angle} beyond its lift."
            )
        gone = "" if loss.gone is None else f" Nothing is left of the wall made {at(loss.gone)}."
        yield Remark(
            f"{cut}{gone}{smaller_roller(wall)}",
            f"{wall.key} wall, {loss.way.place}",
            lost or None,
            severity="error" if lost > limit else "warning",
        )


@check("carved-solid", kind=SOLID, severity="note", unit="mm")
def carved_solid(subject: tuple[int, float], limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a solid that is not made from its walls, since one is undercut.

    Looks at: the scallops that a roller leaves which is subtracted at many angles.
    """
    count, height = subject
    yield Remark(
        f"A wall is undercut: the solid is the blank less {count} positions of the roller, by "
        f"manifold3d. Scallops between them are up to {readable(height, 'mm', digits=3)} high.",
        value=height,
    )


@check(
    "lost-motion",
    kind=KIND,
    limit=("lost_motion", Param(LENGTH, ge=0, doc="largest lost motion between two walls"), 0.1),
    relation="at most",
)
def lost_motion(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of a follower that can move between the two walls.

    Looks at: the clearance over the cosine of the pressure angle at the outside, where it is least.
    """
    cam, _ = subject
    lost = cam.lost_motion
    if lost is None or lost.value <= limit:
        return
    yield Remark(
        f"The follower can move by {readable(lost.value, 'mm')} while the cam does not.",
        at(lost.theta),
        lost.value,
    )


@check("no-clearance", kind=KIND, severity="note", unit="mm")
def clearances(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a roller without clearance between two walls, or at the floor.

    Looks at: `cam.roller_clearance_mm` where there are two walls, and the gap between the floor and
    the end of the roller.
    """
    cam, _ = subject
    between = cam.clearance if len(cam.sides) > 1 else math.inf
    yield from without_clearance(between, cam.inner - cam.floor)


@check(
    "thin-wall",
    kind=KIND,
    limit=("wall_thickness", Param(LENGTH, ge=0, doc="least thickness of metal"), 2.0),
    relation="at least",
)
def thin_wall(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of little metal beside the walls or below the floor.

    Looks at: the distance of the walls from the faces, and of the floor from the bore.
    """
    cam, blank = subject
    if cam.least_rib is not None:
        yield from thin_rib(cam.least_rib, limit)
        return
    low, high = cam.heights
    half = cam.tool.radius_at(cam.outer_radius)
    places = {
        "between the lower wall and the lower face": (-1, low - half),
        "between the upper wall and the upper face": (1, blank.length - high - half),
        "between the floor and the bore": (0, cam.floor - blank.bore if blank.bore else math.inf),
    }
    for where, (side, thickness) in places.items():
        if side in (0, *cam.sides) and thickness < limit:
            yield Remark(
                f"The metal {where} is {readable(thickness, 'mm')} thick.", where, thickness
            )


@check("roller-slip", kind=KIND, severity="note")
def roller_slip(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a roller whose surface cannot roll along its whole length.

    Looks at: radius of the roller over distance from the cam's axis, at both ends of the contact. A
    cone with its tip on this axis rolls everywhere.
    """
    cam, _ = subject
    inner, outer = (cam.roller.radius_at(x) / x for x in (cam.inner, cam.outer_radius))
    slip = abs(1.0 - outer / inner)
    if slip > _SLIP:
        yield Remark(
            f"The roller cannot roll along its whole length: at its ends the speeds differ by "
            f"{formatted(100.0 * slip, 3)} %. A cone with its tip on the cam's axis "
            '(cone_deg = "apex") does not slip.',
        )


@check("acceleration-jump", kind=KIND, severity="note")
def acceleration_jump(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a knot at which the acceleration jumps.

    Looks at: knots where the acceleration jumps.
    """
    yield from shocks(subject[0].program, "follower")
