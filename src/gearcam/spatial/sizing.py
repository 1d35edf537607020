"""The least outer diameter of a cylinder cam that keeps its limits.

A larger cylinder has flatter walls: pressure angle and undercut decrease with its radius. To first
order it is the largest derivative of the lift over the tangent of the pressure angle, plus the
depth of the roller.

Source: 000 (3.156), which lacks the depth. Depends on make and checks; numpy only.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

from gearcam.base.adjustments import Scale, least
from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import Limits, limit_of
from gearcam.base.numerals import DIGITS, formatted, shortened
from gearcam.base.quantities import LONGEST
from gearcam.laws.program import Program
from gearcam.spatial import checks
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.make import make_cylinder
from gearcam.spatial.spec import CylinderSpec, SpatialFollower

_DIGITS: Final = 6
"""Digits of a diameter that is solved for."""


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
    reasons = {"pressure-angle": partial(_steep, limits), "undercut": lambda made: made.undercut}

    def reason(diameter: float) -> str:
        made = make_cylinder(program, follower, replace(cam, outer_diameter=diameter), bore)
        return next((code for code, broken in reasons.items() if broken(made)), "")

    core = bore + max(wall, 1e-3 * cam.groove_depth)
    low = 2.0 * (cam.groove_depth + cam.floor_clearance + core)
    codes = {0: reason(low)}
    if not codes[0]:
        return SolvedDiameter(diameter=shortened(low, 1.0, _DIGITS), decided_by="thin-wall")
    scale = Scale(_DIGITS)
    start = scale.index(low)

    def keeps(place: int) -> bool:
        codes[place] = reason(scale.value(start + place))
        return not codes[place]

    found = least(keeps, _larger(scale, low))
    if found is None:
        what = f"no outer diameter up to {formatted(LONGEST)} mm keeps the limits"
        allowed = "a smaller lift, a larger angle of the phases, or other limits"
        raise InfeasibleError(what, where="cam.outer_diameter_mm", nearest=allowed)
    place, smaller = found
    return SolvedDiameter(diameter=scale.value(start + place), decided_by=codes[smaller])


def flat_diameter(
    program: Program, follower: SpatialFollower, cam: CylinderSpec, bore: float, limits: Limits
) -> float | None:
    """Return the least larger outer diameter that keeps the limit of the pressure angle, mm.

    Parameters
    ----------
    program, follower, cam, bore, limits
        As of `least_diameter`.

    Returns
    -------
    float or None
        In the digits printed; None if there is none up to the largest length of a design.
    """
    given, scale = 2.0 * cam.outer_radius, Scale(DIGITS)
    start = scale.index(given)

    def keeps(place: int) -> bool:
        wider = replace(cam, outer_diameter=scale.value(start + place))
        return not _steep(limits, make_cylinder(program, follower, wider, bore))

    try:
        found = least(keeps, _larger(scale, given))
    except InfeasibleError:
        return None
    return scale.value(start + found[0]) if found else None


def _steep(limits: Limits, made: SpatialCam) -> bool:
    """Return whether the pressure angle of a cam is beyond its limit."""
    worst = made.pressure()
    return worst is not None and worst.value > checks.allowed_pressure(made, limits)


def _larger(scale: Scale, size: float) -> Iterator[int]:
    """Yield the places of twice a size, four times and so on, counted from it."""
    start, last = scale.index(size), scale.index(LONGEST)
    while (size := 2.0 * size) < LONGEST:
        yield scale.index(size) - start
    yield last - start
