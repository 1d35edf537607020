"""Upper bound of the contact ratio of a pair's flanks, for any cutter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import shown
from gearcam.gears.flank import Toothing
from gearcam.gears.tips import find_tips
from gearcam.gears.undercut import find_cusps
from gearcam.numeric.arrays import Array

_FAR = 1.5
"""Range of reach searched, over the reach of a rack's flank: concave parts reach farther."""


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
        raise InfeasibleError(
            "a concave part of the centrode is too tight for this module: a pinion cutter small "
            "enough to fit would have pointed teeth"
            + ("" if drives else ", and each flank is in contact for less than one pitch"),
            where=f"wheel {toothing.wheel}",
            value=radius if drives else bound,
            limit=least if drives else 1.0,
            unit="mm" if drives else "",
            nearest="the value is the smallest concave radius, the limit the least for this "
            f"module; the flanks allow a contact ratio of at most {shown(bound, 4)}"
            if drives
            else "the value is the largest contact ratio that any cutter could give",
            more_teeth=least / radius,
        )
