"""Where flanks end at the root, and what their exact curves alone can drive.

A rack or pinion leaves every flank the same joint with its fillet. Where a concave part is too
tight for any cutter the mate itself cuts the root: each of its teeth, longer by the clearance,
with its flanks continued. Their corner touches the flank where they end, and leaves the fillet on
its way to the root land. The same continued flanks bound the contact ratio before anything is cut.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.flank import Toothing
from gearcam.gears.tips import TipEnds, find_tips
from gearcam.gears.undercut import Undercut, find_cusps

Array = NDArray[np.float64]

_FAR = 1.5
"""How far flanks are followed, over the reach of a rack's: in concave parts they go farther."""


def joints(toothing: Toothing, sf: Array, sigma: Array) -> tuple[Array, Array]:
    """Return where flanks join their fillets, and fillets the root land.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    sf, sigma : (n,) arrays, mm and 1
        Flanks.

    Returns
    -------
    reach, offset : (n,) arrays, mm
        Rolls ``|s - sf|`` of both joints (see `Cutter`).
    """
    cutter = toothing.cutter
    if not cutter.mated:
        return np.full(sf.shape, cutter.reach), np.full(sf.shape, cutter.offset)
    longer = replace(cutter, addendum=cutter.dedendum)
    _, tips = _exact(replace(toothing, wheel=3 - toothing.wheel, cutter=longer), sf, -sigma)
    touch, foot = toothing.rolling.arc_length(np.stack([tips.phi, tips.foot]))
    return sigma * (touch - sf), sigma * (foot - sf)


def contact_bound(first: Toothing, second: Toothing) -> float:
    """Return what the contact ratio cannot exceed, whatever cuts the roots.

    Parameters
    ----------
    first, second : Toothing
        Both wheels.

    Returns
    -------
    float
        Smallest of any flank: from tip curve to tip curve, cusps taken off.
    """
    half, places = first.half_tooth, first.tooth_places[first.whole]
    sf, sigma = np.concatenate([places + half, places - half]), np.repeat([1.0, -1.0], len(places))
    ends = []
    for toothing, side in ((first, sigma), (second, -sigma)):
        cusps, tips = _exact(toothing, sf, side)
        ends.append((cusps.dedendum, side * (sf - toothing.rolling.arc_length(tips.phi))))
    (low, high), (low2, high2) = ends
    return float((np.minimum(high, -low2) - np.maximum(low, -high2)).min()) / first.pitch


def _exact(toothing: Toothing, sf: Array, sigma: Array) -> tuple[Undercut, TipEnds]:
    """Cusps of flanks, and their ends at the tip curve, whatever their mates are."""
    far = _FAR * replace(toothing.cutter, kc=0.0).reach
    cusps = find_cusps(toothing, sf, sigma, -far, far)
    return cusps, find_tips(toothing, sf, sigma, np.minimum(cusps.addendum, far))
