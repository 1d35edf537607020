"""Limits of basic rack, profile shift, backlash and clearance: teeth keep lands, roots and addenda.

Limits of a ring: more teeth than its wheel, and metal outside its roots.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted, rounded_down
from gearcam.gears.flank import Toothing
from gearcam.gears.flank_ends import find_cusps, find_tips
from gearcam.gears.spec import BasicRack, Finish, PairSpec, Rack, RingSpec
from gearcam.numeric.arrays import Array

_TIP_PART = 0.95
"""Largest tip radius over the dedendum: at 1 the arc's centre is on the pitch line, no fillet."""

_LEAST_ADDENDUM = 0.1
"""Smallest addendum that a profile shift may leave, in modules."""

_MOST_BACKLASH = 2.0
"""Largest backlash over half the thickness of the thinner teeth: half of them is left."""

_SHARE = 0.98
"""Share of the available space that a reduced default takes, so that a land is left."""

_SHALLOW = 0.8
"""Addendum over dedendum of the common rack, where one is derived from the other."""

_ROUNDING = 1e-12
"""Rounding of a limit: in modules, and relative."""

_FAR = 1.5
"""Range of reach searched, over the reach of a rack's flank: concave parts reach farther."""


def settle_rack(given: Rack, x: float) -> BasicRack:
    """Return the basic rack: given values as given, defaults reduced where they do not fit.

    The tip radius is reduced first, then the dedendum, then the addendum.

    Parameters
    ----------
    given : Rack
        Values of the design; None where it gives none.
    x : float
        Profile shift, in modules.

    Returns
    -------
    BasicRack

    Raises
    ------
    InfeasibleError
        If the given values contradict each other.
    """
    usual, shift = BasicRack(), abs(x)
    deepest = _SHARE * _deepest(given.pressure_angle, given.tip_radius or 0.0)
    if given.dedendum is not None:
        deepest = given.dedendum
    addendum = given.addendum
    if addendum is None:
        wanted = max(usual.addendum, shift + _LEAST_ADDENDUM)
        addendum = wanted if wanted <= deepest else max(_SHALLOW * deepest, shift + _LEAST_ADDENDUM)
    dedendum = given.dedendum
    if dedendum is None:
        room = least_dedendum(given, x)
        wanted = usual.dedendum if usual.dedendum >= addendum else addendum / _SHALLOW
        dedendum = max(min(max(wanted, room), deepest), addendum)
    rack = BasicRack(
        pressure_angle=given.pressure_angle, addendum=addendum, dedendum=dedendum, tip_radius=0.0
    )
    largest = min(_largest_tip(rack), _TIP_PART * (dedendum - shift))
    tip = given.tip_radius
    if tip is None:
        tip = min(usual.tip_radius, max(0.0, _SHARE * largest))
    rack = replace(rack, tip_radius=tip)
    # a default dedendum could be reduced as far as the tip radius needs
    free = given.dedendum is None
    _demand_rack(rack, _widest_tip(given.pressure_angle) if free else _largest_tip(rack))
    return rack


def least_dedendum(given: Rack, x: float) -> float:
    """Return the least dedendum for a `given` tip radius at a profile shift `x`, in modules."""
    return abs(x) + (given.tip_radius or 0.0) / _TIP_PART


def _deepest(alpha: float, tip_radius: float) -> float:
    """Dedendum at which a rack's tooth becomes pointed: ``rho/cos + (hf - rho)*tan = pi/4``."""
    return tip_radius + (0.25 * math.pi - tip_radius / math.cos(alpha)) / math.tan(alpha)


def _largest_tip(rack: BasicRack) -> float:
    """Largest tip radius that leaves a rack's tooth a land; negative if none does."""
    alpha, depth = rack.pressure_angle, rack.dedendum
    room = 0.25 * math.pi - depth * math.tan(alpha)
    return min(room / (1.0 / math.cos(alpha) - math.tan(alpha)), _TIP_PART * depth)


def _widest_tip(alpha: float) -> float:
    """Largest tip radius of a rack with the nearest dedendum that leaves its teeth a land."""
    part, tangent = _SHARE * _TIP_PART, math.tan(alpha)
    return part * 0.25 * math.pi / (tangent + part * (1.0 / math.cos(alpha) - tangent))


def _demand_rack(rack: BasicRack, largest: float) -> None:
    """Refuse a rack without clearance, or whose tooth tip has no land."""
    depth = rack.dedendum
    angle = f"a pressure angle of {formatted(math.degrees(rack.pressure_angle))} deg"
    if depth < rack.addendum:
        what = "the dedendum is less than the addendum: teeth would hit the mate's roots"
        note = "the limit is the addendum"
        near = _short(rack.addendum / _SHALLOW)
        adjustments = (Adjustment(near={"rack.addendum": _short(_SHALLOW * depth)}),)
        raise beyond_limit(
            what, "rack.dedendum", depth, rack.addendum, note, near=near, adjustments=adjustments
        )
    if _largest_tip(rack) < 0.0:
        deepest = _deepest(rack.pressure_angle, 0.0)
        what = "the rack's tooth becomes pointed before it reaches the dedendum"
        note = f"the limit is the depth where its flanks meet, at {angle}"
        adjustments = (Adjustment(near={"rack.addendum": _short(0.7 * deepest)}),)
        raise beyond_limit(
            what,
            "rack.dedendum",
            depth,
            deepest,
            note,
            near=_short(0.9 * deepest),
            adjustments=adjustments,
        )
    if rack.tip_radius > largest * (1.0 + _ROUNDING):
        what = "the tip radius is too large: it leaves the rack's teeth no land"
        note = f"the limit is for {angle}"
        raise beyond_limit(
            what, "rack.tip_radius", rack.tip_radius, largest, note, near=0.99 * largest
        )


def demand_shift(rack: BasicRack, spec: PairSpec, module: float) -> None:
    """Refuse a profile shift or backlash that leaves a wheel without teeth or roots.

    Parameters
    ----------
    rack : BasicRack
        Basic rack.
    spec : PairSpec
        Shift and backlash.
    module : float, mm
        Module.

    Raises
    ------
    InfeasibleError
        Naming the largest.
    """
    largest = min(rack.dedendum - rack.tip_radius / _TIP_PART, rack.addendum - _LEAST_ADDENDUM)
    if abs(spec.x) > largest + _ROUNDING:
        what = "the profile shift leaves one wheel no root or no addendum"
        note = "the limit is that of this rack"
        raise beyond_limit(what, "pair.x", spec.x, math.copysign(largest, spec.x), note, far=0.0)
    thinnest = 0.25 * math.pi - abs(spec.x) * math.tan(rack.pressure_angle)
    most = _MOST_BACKLASH * thinnest * module
    if spec.backlash > most:
        what = "the backlash is too large: it leaves no teeth"
        note = f"the limit is for a module of {formatted(module)} mm"
        raise beyond_limit(what, "pair.backlash_mm", spec.backlash, most, note, far=0.0)


def demand_clearance(
    rack: BasicRack, spec: PairSpec, module: float, finish: tuple[Finish, Finish]
) -> None:
    """Refuse a clearance that leaves a wheel no teeth.

    Parameters
    ----------
    rack : BasicRack
        Basic rack.
    spec : PairSpec
        Shift and backlash.
    module : float, mm
        Module.
    finish : (Finish, Finish)
        Clearance and rounding of both wheels' teeth.

    Raises
    ------
    InfeasibleError
        Naming the largest.
    """
    alpha = rack.pressure_angle
    for number, (wheel, shift) in enumerate(zip(finish, (spec.x, -spec.x), strict=True)):
        half = (0.25 * math.pi + shift * math.tan(alpha)) * module - 0.25 * spec.backlash
        # `demand_shift` has left the least addendum, but for rounding
        height = max(0.0, rack.addendum + shift - _LEAST_ADDENDUM) * module
        most = min(0.5 * half * math.cos(alpha), height)
        if wheel.clearance > most:
            what = "the clearance is too large: it leaves no teeth"
            note = f"the limit is for a module of {formatted(module)} mm"
            raise beyond_limit(
                what, f"blank.clearance_mm[{number}]", wheel.clearance, most, note, far=0.0
            )


def demand_ring(spec: PairSpec) -> None:
    """Refuse a closed ring that does not have more teeth than its wheel.

    Parameters
    ----------
    spec : PairSpec
        With the tooth counts.

    Raises
    ------
    InfeasibleError
        With the tooth counts to use instead.
    """
    z1, z2 = spec.teeth
    if spec.type != "internal" or z2 > z1:
        return
    if z2 == z1:
        what, counts = "an internal pair cannot have equal tooth counts", [z1, 2 * z1]
        nearest = "a ring needs more teeth than its wheel"
    else:
        what, counts = "the ring has fewer teeth than its wheel", [z2, z1]
        nearest = (
            f"the ring must be wheel 2: use teeth = {counts} with the inverse law, ratio 1/i as "
            "a function of phi2"
        )
    adjustments = (
        Adjustment(near={"pair.teeth": counts}),
        Adjustment(near={"pair.type": "external"}),
    )
    raise beyond_limit(
        what, "pair.teeth[1]", float(z2), float(z1), nearest, adjustments=adjustments
    )


def demand_rim(ring: RingSpec, roots: float, module: float, limit: float) -> None:
    """Refuse an outer diameter that leaves no metal outside a ring's roots.

    Parameters
    ----------
    ring : RingSpec
        Given values of the design.
    roots : float, mm
        Largest radius of its teeth.
    module : float, mm
        Module.
    limit : float, mm
        Least rim without a finding.

    Raises
    ------
    InfeasibleError
        With the diameter that keeps the limit.
    """
    if ring.least_rim(roots, module) <= 0.0:
        what = "the outer diameter of the ring does not clear the roots of its teeth"
        where = "wheel 2, ring.outer_diameter_mm"
        note = (
            "the limit is the circle through the deepest root; "
            f"{formatted(2.0 * (roots + limit))} mm leave a rim of {formatted(limit)} mm"
        )
        raise beyond_limit(
            what, where, ring.outer_diameter, 2.0 * roots, note, near=2.0 * (roots + limit)
        )


def contact_bound(first: Toothing, second: Toothing) -> float:
    """Return an upper bound of the contact ratio.

    Parameters
    ----------
    first, second : Toothing
        Both wheels.

    Returns
    -------
    float
        Smallest of all flanks: from addendum curve to addendum curve, less the parts beyond cusps.
    """
    sf, sigma = (values[first.whole_flanks] for values in first.flanks)
    (low, high), (low2, high2) = _reach(first, second, sf, sigma), _reach(second, first, sf, -sigma)
    return float((np.minimum(high, -low2) - np.maximum(low, -high2)).min()) / first.pitch


def _reach(toothing: Toothing, mate: Toothing, sf: Array, sigma: Array) -> tuple[Array, Array]:
    """Reach of flanks, mm, from their cusps (-inf without one) to the addendum curve.

    Below the pitch curve their own cutter limits them, above it the cutter of the mate.
    """
    far = [_FAR * replace(one.cutter, kc=0.0).reach for one in (toothing, mate)]
    cusps = find_cusps(toothing, sf, sigma, -far[0], far[1])
    tips = find_tips(toothing, sf, sigma, np.minimum(cusps.addendum, far[1]))
    return cusps.dedendum, sigma * (sf - toothing.track.arc_length(tips.phi))


def demand_cutters(first: Toothing, second: Toothing) -> None:
    """Refuse wheels whose concave parts no cutter fits.

    Parameters
    ----------
    first, second : Toothing
        Both wheels.

    Raises
    ------
    InfeasibleError
        With the bound of the contact ratio where the flanks could not drive either.
    """
    for toothing in (first, second):
        cutter = toothing.cutter
        if cutter.fits:
            continue
        radius = toothing.track.concave.radius
        least, bound = cutter.least_concave_radius, contact_bound(first, second)
        drives = bound >= 1.0
        what = (
            "a concave part of the centrode is too tight for this module: a pinion cutter small "
            "enough to fit would have pointed teeth"
            + ("" if drives else ", and each flank is in contact for less than one pitch")
        )
        where = f"wheel {toothing.wheel}"
        value = radius if drives else bound
        limit = least if drives else 1.0
        note = (
            "the value is the smallest concave radius, the limit the least for this "
            f"module; the flanks allow a contact ratio of at most {formatted(bound, 4)}"
            if drives
            else "the value is the largest contact ratio that any cutter could give"
        )
        raise beyond_limit(
            what, where, value, limit, note, unit="mm" if drives else "", more_teeth=least / radius
        )


def _short(size: float) -> float:
    """Return a size rounded to the digits that people type."""
    return float(rounded_down(size, 4))
