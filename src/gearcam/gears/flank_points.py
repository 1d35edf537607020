"""Points on the finished flanks of a wheel: for inspection, for tools, and as data.

Depends on outlines.
"""

from __future__ import annotations

import numpy as np

from gearcam.gears.outline import Outline
from gearcam.numeric.columns import Columns


def flank_points(profile: Outline, count: int) -> Columns:
    """Return points on the finished flanks of all whole teeth.

    Parameters
    ----------
    profile : Outline
        The wheel's outline.
    count : int
        Points per flank, from root to tip at even steps of the rack's roll, both ends included.

    Returns
    -------
    Columns
        Rows by tooth, then side (+1 first), then from root to tip; see `Gear.flank_points`.
    """
    toothing, flanks = profile.toothing, profile.flanks
    kept = np.flatnonzero(toothing.whole_flanks & (flanks.highest > flanks.lowest))
    tooth = np.tile(np.array(toothing.numbers), 2)[kept]
    order = np.lexsort((-flanks.sigma[kept], tooth))
    kept, tooth = kept[order], tooth[order]
    share = np.linspace(0.0, 1.0, count)
    lowest, highest = flanks.lowest[kept, None], flanks.highest[kept, None]
    reach = (lowest + share * (highest - lowest)).ravel()
    sf, sigma = (np.repeat(values[kept], count) for values in (flanks.sf, flanks.sigma))
    phi1 = toothing.track.angle(sf - sigma * reach)
    frames = toothing.frames(phi1)
    points = toothing.flank_points(frames, sf, sigma)
    normals = sigma * toothing.normals(frames, sigma)
    with np.errstate(divide="ignore"):  # at a cusp
        curvature = frames.kappa / toothing.regularity(frames, sf, sigma)
    return Columns(
        {
            "tooth": np.repeat(tooth, count),
            "side": sigma.astype(np.int64),
            "point": np.tile(np.arange(1, count + 1), len(kept)),
            "x_mm": points.real,
            "y_mm": points.imag,
            "nx": normals.real,
            "ny": normals.imag,
            "curvature_per_mm": curvature,
            "reach_mm": reach,
            "phi1_deg": np.degrees(phi1),
        }
    )
