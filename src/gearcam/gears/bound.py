"""What the flanks of a pair alone can drive, whatever cuts their roots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.gears.flank import Toothing
from gearcam.gears.tips import find_tips
from gearcam.gears.undercut import find_cusps
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array

_FAR = 1.5
"""How far flanks are followed, over the reach of a rack's: in concave parts they go farther."""


def contact_bound(first: Toothing, second: Toothing) -> float:
    """Return what the contact ratio cannot exceed.

    Parameters
    ----------
    first, second : Toothing
        Both wheels.

    Returns
    -------
    float
        Smallest of any flank: from addendum curve to addendum curve, cusps taken off.
    """
    sf, sigma = (values[first.whole_flanks] for values in first.flanks)
    (low, high), (low2, high2) = _reach(first, second, sf, sigma), _reach(second, first, sf, -sigma)
    return float((np.minimum(high, -low2) - np.maximum(low, -high2)).min()) / first.pitch


def _reach(toothing: Toothing, mate: Toothing, sf: Array, sigma: Array) -> tuple[Array, Array]:
    """Reach of flanks from their cusps, or without end, to the addendum curve, mm.

    Below the pitch curve they go as far as the own cutter, above it as far as that of the mate.
    """
    far = [_FAR * replace(one.cutter, kc=0.0).reach for one in (toothing, mate)]
    cusps = find_cusps(toothing, sf, sigma, -far[0], far[1])
    tips = find_tips(toothing, sf, sigma, np.minimum(cusps.addendum, far[1]))
    return cusps.dedendum, sigma * (sf - toothing.track.arc_length(tips.phi))


def demand_cutters(first: Toothing, second: Toothing) -> None:
    """Refuse wheels into whose concave parts no cutter fits.

    Parameters
    ----------
    first, second : Toothing
        Both wheels.

    Raises
    ------
    InfeasibleError
        With what the contact ratio could be, where the flanks themselves could not drive either.
    """
    for toothing in (first, second):
        cutter = toothing.cutter
        if cutter.fits:
            continue
        radius = toothing.track.concave.radius
        least, bound = cutter.least_concave_radius, contact_bound(first, second)
        drives = bound >= 1.0
        raise InfeasibleError(
            "a concave part of the centrode is too tight for these teeth: a pinion cutter that "
            "fits into it has pointed teeth"
            + ("" if drives else ", and the flanks themselves touch for less than a pitch"),
            where=f"wheel {toothing.wheel}",
            value=radius if drives else bound,
            limit=least if drives else 1.0,
            unit="mm" if drives else "",
            nearest="these are the smallest concave radius, and the least for this module; the "
            f"flanks by themselves allow a contact ratio of at most {shown(bound, 4)}"
            if drives
            else "this is the most that the contact ratio can be, whatever cuts the roots",
            more_teeth=least / radius,
        )
