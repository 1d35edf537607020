"""The lift lost by an undercut cam: motion of the follower while it rests on a corner.

Between the cam angles of the two sides of a corner the follower touches only corners; its lift
there has a closed form, and its largest deviation from the given lift is a root of a derivative.

Depends on trim, followers, laws and numeric; numpy only.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.cams.carriers import Carrier
from gearcam.cams.curve import CamCurve
from gearcam.cams.followers import Follower
from gearcam.cams.measures import Extreme
from gearcam.cams.trim import Corner
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import extremes

_NARROWEST = 1e-9
"""Angle, rad of a turn, below which rounding may exchange the two sides of a corner."""


def resting(
    follower: Follower, carrier: Carrier, point: complex, side: int = 1
) -> Callable[[Jet], Jet]:
    """Return the lift of a follower that rests on a point of the cam.

    Parameters
    ----------
    follower : Follower
        The follower.
    carrier : Carrier
        Motion of the cam.
    point : complex, mm
        In the cam's frame, turning counter-clockwise.
    side : {1, -1}
        Whether a round follower is above the point or pressed against it from below.

    Returns
    -------
    callable
        ``lift(theta) -> Jet``, mm or rad; nan where the point cannot be touched.
    """

    def lift(theta: Jet) -> Jet:
        with np.errstate(divide="ignore", invalid="ignore"):
            position, room = follower.rest(*carrier.placed(theta, point), side=side)
        missed = (room < 0.0) | ~np.isfinite(position.c[0])
        s = position - follower.start
        return Jet([np.where(missed, np.nan, value) for value in s.c])

    return lift


def lost_lift(curve: CamCurve, corner: Corner) -> Extreme:
    """Return the largest lift lost at a corner, and its cam angle.

    Parameters
    ----------
    curve : CamCurve
        The untrimmed profile, turning counter-clockwise.
    corner : Corner
        Corner of the trimmed profile.

    Returns
    -------
    Extreme
        Cam angle, rad, and lift, mm or rad, not negative.

    Raises
    ------
    InfeasibleError
        If the follower cannot touch the corner anywhere.
    """
    program, side = curve.program, curve.lift_sign
    start, end = corner.before, corner.after
    rest = resting(curve.follower, curve.carrier, corner.point, side)
    if end < start:
        end += program.period
    if end == start or end - start > program.period - _NARROWEST * program.grain:
        return Extreme(theta=start, value=0.0)

    def missing(theta: Array) -> list[Array]:
        given = rest(Jet.variable(theta, 1)).derivatives()
        return list(side * np.subtract(program.derivatives(theta, 1), given))

    places, values = extremes(missing, program.cuts_between(start, end))
    if np.isnan(values).all():
        raise InfeasibleError(
            "the follower cannot rest on a corner that trimming leaves",
            where=curve.carrier.driver.told(start),
            nearest="its arm or its pivot does not allow that position",
        )
    best = int(np.nanargmax(values))
    return Extreme(theta=float(places[best]) % program.period, value=max(0.0, float(values[best])))
