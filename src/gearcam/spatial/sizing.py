"""The least outer diameter of a cylinder cam that keeps its limits.

A larger cylinder has flatter walls: pressure angle and undercut decrease with its radius, so that
the least one is found by halving an interval. To first order it is the largest derivative of the
lift over the tangent of the pressure angle, plus the depth of the roller.

Source: 000 (3.156), which lacks the depth. Depends on make and checks; numpy only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import Limits, limit_of
from gearcam.base.numerals import formatted, shortened
from gearcam.base.quantities import LONGEST
from gearcam.laws.program import Program
from gearcam.spatial import checks
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.make import make_cylinder
from gearcam.spatial.spec import CylinderSpec, SpatialFollower

_CLOSE: Final = 1e-7
"""Share to which the diameter is found before it is rounded up."""


@dataclass(frozen=True, kw_only=True)
class SolvedDiameter(ShortRepr):
    """The least outer diameter of a cam.

    Parameters
    ----------
    diameter : float, mm
        The diameter.
    decided_by : str
        The code of the check that decides on it.
    """

    diameter: float
    decided_by: str


def least_diameter(
    program: Program, follower: SpatialFollower, cam: CylinderSpec, bore: float, limits: Limits
) -> SolvedDiameter:
    """Return the least outer diameter that keeps the limits of pressure angle, undercut and walls.

    Parameters
    ----------
    program : Program
        The lift over a turn.
    follower : SpatialFollower
        The roller and its guide.
    cam : CylinderSpec
        The other sizes of the cylinder.
    bore : float, mm
        Radius of the bore.
    limits : mapping of str to float
        Limits set by the design.

    Returns
    -------
    SolvedDiameter
        Rounded up to six digits.

    Raises
    ------
    InfeasibleError
        If there is none up to the largest length of a design, or the cam is impossible.
    """
    wall = limit_of(checks.KIND, "thin-wall", limits)

    def made(diameter: float) -> SpatialCam:
        return make_cylinder(program, follower, replace(cam, outer_diameter=diameter), bore)

    def steep(built: SpatialCam) -> bool:
        worst = built.pressure()
        return worst is not None and worst.value > checks.allowed_pressure(built, limits)

    reasons: dict[str, Callable[[SpatialCam], bool]] = {
        "pressure-angle": steep,
        "undercut": lambda found: found.undercut,
    }

    def reason(diameter: float) -> str:
        built = made(diameter)
        return next((code for code, broken in reasons.items() if broken(built)), "")

    core = bore + max(wall, 1e-3 * cam.groove_depth)
    low = 2.0 * (cam.groove_depth + cam.floor_clearance + core)
    decided = reason(low)
    if not decided:
        return SolvedDiameter(diameter=shortened(low, 1.0, 6), decided_by="thin-wall")
    high = 2.0 * low
    while (code := reason(high)) and high < LONGEST:
        low, high, decided = high, 2.0 * high, code
    if code:
        what = f"no outer diameter up to {formatted(LONGEST)} mm keeps the limits"
        allowed = "a smaller lift, a larger angle of the phases, or other limits"
        raise InfeasibleError(what, where="cam.outer_diameter_mm", nearest=allowed)
    while high - low > _CLOSE * high:
        middle = 0.5 * (low + high)
        code = reason(middle)
        low, high = (middle, high) if code else (low, middle)
        decided = code or decided
    return SolvedDiameter(diameter=shortened(high, 1.0, 6), decided_by=decided)
