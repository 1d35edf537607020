"""The outside of a ring that follows its roots: a parallel of the centrode on the metal's side.

The land of a root is such a parallel too, a dedendum away. Parallels that have corners or cross
themselves are refused.
"""

from __future__ import annotations

import math

import numpy as np

from gearcam.base.errors import InfeasibleError, Way
from gearcam.gears.flank import Curve, Rows, WheelCurves
from gearcam.gears.pair import Gear
from gearcam.numeric.bulges import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.numeric.sampling import Sampler


def outside(gear: Gear, rim: float) -> Contour:
    """Return the outside of a ring at a constant distance `rim` from its roots.

    Parameters
    ----------
    gear : Gear
        The ring, closed.
    rim : float, mm
        Distance from the lands of its roots.

    Returns
    -------
    Contour
        Counter-clockwise, with the chord tolerance of the teeth.

    Raises
    ------
    InfeasibleError
        If a concave part of the centrode is too tight for the rim.
    """
    toothing, profile = gear.toothing, gear.profile
    away = toothing.cutter.dedendum + rim
    most = toothing.track.convex.radius - toothing.cutter.dedendum
    if rim >= most:
        raise _refusal("a concave part of the pitch curve is too tight", rim, most)
    # a piece for each tooth, as dense as its curvature needs
    ends = np.linspace(0.0, toothing.track.around, toothing.teeth + 1)
    none = np.zeros(toothing.teeth)
    rows = Rows(
        kind=np.full(toothing.teeth, int(Curve.LAND)),
        sf=none,
        sigma=none,
        start=ends[:-1],
        end=ends[1:],
        low=none - away,
        high=none - away,
        corner=np.arange(toothing.teeth) == 0,
        tooth=np.arange(toothing.teeth),
    )
    curves = WheelCurves(toothing=toothing, rows=rows)
    sampler = Sampler(curves=curves, tolerance=profile.tolerance)
    _, points, error = sampler.chords
    made = Contour(
        dense=lambda: sampler.dense(profile.oversampling).runs(),
        vertices=as_pairs(points),
        tolerance=profile.tolerance,
        chord_error=error,
    )
    if not made.polygon.is_valid:
        raise _refusal("it would cross itself", rim, 0.0)
    return made


def _refusal(why: str, rim: float, most: float) -> InfeasibleError:
    """Return the error for a parallel; `most` is the largest rim the curvature allows, if any."""
    ways = [Way(near={"ring.outer": "round"})]
    bent = 0.0 < most < math.inf
    if bent:
        ways.insert(0, Way(near={"ring.rim_mm": 0.99 * most}, far={"ring.rim_mm": 0.1 * most}))
    return InfeasibleError(
        f"the outside of the ring cannot follow its roots: {why}",
        where="ring.rim_mm",
        value=rim,
        limit=most if bent else None,
        unit="mm",
        nearest="at the limit the outside gets a corner" if bent else "",
        ways=ways,
    )
