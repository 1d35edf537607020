"""What a basic rack, a profile shift and a play must leave: teeth with lands, roots and addenda."""

from __future__ import annotations

import math

from gearcam.errors import InfeasibleError
from gearcam.gears.spec import Finish, PairSpec, Rack

_TIP_PART = 0.95
"""Largest tip radius over the dedendum: with its centre on the pitch line a tip arc would cut the
whole fillet at one instant."""

_LEAST_ADDENDUM = 0.1
"""Smallest addendum that a profile shift may leave, in modules."""

_MOST_PLAY = 2.0
"""Largest backlash over half the thickness of the thinner teeth: half of them is left."""


def demand_rack(rack: Rack) -> None:
    """Refuse a rack without clearance, or whose tooth tip has no land.

    Parameters
    ----------
    rack : Rack
        Basic rack.

    Raises
    ------
    InfeasibleError
        Naming the largest tip radius.
    """
    alpha, depth = rack.pressure_angle, rack.dedendum
    if depth < rack.addendum:
        raise InfeasibleError(
            "the dedendum is less than the addendum: teeth would run into the mate's root",
            where="rack.dedendum",
            value=depth,
            limit=rack.addendum,
            nearest=f"at least {rack.addendum:.6g}, better {1.25 * rack.addendum:.6g}",
        )
    half_space = 0.25 * math.pi
    # rho/cos(alpha) + (hf - rho)*tan(alpha) <= pi/4
    largest = (half_space - depth * math.tan(alpha)) / (1.0 / math.cos(alpha) - math.tan(alpha))
    largest = min(largest, _TIP_PART * depth)
    if largest < 0.0:
        raise InfeasibleError(
            "the rack's tooth is pointed before it is as deep as the dedendum",
            where="rack.dedendum",
            value=depth,
            limit=half_space / math.tan(alpha),
            nearest=f"a dedendum up to {half_space / math.tan(alpha):.6g}",
        )
    if rack.tip_radius > largest * (1.0 + 1e-12):
        raise InfeasibleError(
            "the rack's tip radius leaves its tooth no land",
            where="rack.tip_radius",
            value=rack.tip_radius,
            limit=largest,
            nearest=f"a tip radius up to {largest:.6g}",
        )


def demand_shift(rack: Rack, spec: PairSpec, module: float) -> None:
    """Refuse a profile shift or a play that leaves a wheel without teeth or roots.

    Parameters
    ----------
    rack : Rack
        Basic rack.
    spec : PairSpec
        Shift and play.
    module : float, mm
        Module.

    Raises
    ------
    InfeasibleError
        Naming the largest.
    """
    largest = min(rack.dedendum - rack.tip_radius / _TIP_PART, rack.addendum - _LEAST_ADDENDUM)
    if abs(spec.x) > largest:
        raise InfeasibleError(
            "the profile shift leaves one wheel no root or no addendum",
            where="pair.x",
            value=spec.x,
            limit=math.copysign(largest, spec.x),
            nearest=f"a shift from {-largest:.10g} to {largest:.10g} modules with this rack",
        )
    thinnest = 0.25 * math.pi - abs(spec.x) * math.tan(rack.pressure_angle)
    most = _MOST_PLAY * thinnest * module
    if spec.backlash > most:
        raise InfeasibleError(
            "so much backlash leaves no teeth",
            where="pair.backlash_mm",
            value=spec.backlash,
            limit=most,
            unit="mm",
            nearest=f"up to {most:.10g} mm for a module of {module:.6g} mm",
        )


def demand_clearance(
    rack: Rack, spec: PairSpec, module: float, finish: tuple[Finish, Finish]
) -> None:
    """Refuse a clearance that leaves a wheel no teeth.

    Parameters
    ----------
    rack : Rack
        Basic rack.
    spec : PairSpec
        Shift and play.
    module : float, mm
        Module.
    finish : (Finish, Finish)
        What is taken off the edges of both wheels' teeth.

    Raises
    ------
    InfeasibleError
        Naming the largest.
    """
    alpha = rack.pressure_angle
    for number, (wheel, shift) in enumerate(zip(finish, (spec.x, -spec.x), strict=True)):
        half = (0.25 * math.pi + shift * math.tan(alpha)) * module - 0.25 * spec.backlash
        height = (rack.addendum + shift - _LEAST_ADDENDUM) * module
        most = min(0.5 * half * math.cos(alpha), height)
        if wheel.clearance > most:
            raise InfeasibleError(
                "so much clearance leaves no teeth",
                where=f"blank.clearance_mm[{number}]",
                value=wheel.clearance,
                limit=most,
                unit="mm",
                nearest=f"up to {most:.6g} mm for a module of {module:.6g} mm",
            )
