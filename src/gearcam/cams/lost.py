"""The lift that an undercut cam loses: what the follower does while it rests on a corner.

Between the angles at which the two sides of a corner are drawn the follower touches nothing but
corners; its lift there has a closed form, and the largest distance from the lift that was asked for
is a root of a derivative.

Depends on trim, mechanism, laws and numeric; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from gearcam.cams.measures import Extreme
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.trim import Corner
from gearcam.errors import InfeasibleError
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet, asin, atan, cos, sin, sqrt
from gearcam.numeric.piecewise import extremes

_TURN = 2.0 * math.pi
_NARROWEST = 1e-9
"""Width, rad, below which both sides of a corner may seem to have changed places."""


def resting(mechanism: Mechanism, point: complex, side: int = 1) -> Callable[[Jet], Jet]:
    """Return the lift of a follower that rests on a point of the cam.

    Parameters
    ----------
    mechanism : Mechanism
        The follower.
    point : complex, mm
        In the cam's frame, turning counter-clockwise.
    side : {1, -1}
        Whether a round follower stands above the point or is pressed against it from below.

    Returns
    -------
    callable
        ``lift(theta) -> Jet``, mm or rad; nan where the point cannot be touched.
    """
    m, radius, angle = mechanism, abs(point), math.atan2(point.imag, point.real)

    def place(theta: Jet) -> tuple[Jet, Jet]:
        """Return where the point stands: seen along the follower's way, or with its pivot at +d."""
        if not m.slide:
            return radius * cos(theta + angle), radius * sin(theta + angle)
        x, y = point.real - m.slide * theta, point.imag + 0.0 * theta
        if m.oscillating:
            return -1.0 * x, y - m.height
        c, s = math.cos(m.tilt), math.sin(m.tilt)
        return c * x + s * y, c * y - s * x

    def sliding(theta: Jet) -> Jet:
        x, y = place(theta)
        if m.flat:
            return y - m.start
        aside = x - m.offset
        return y + side * sqrt(m.radius**2 - aside * aside) - m.start

    def swinging(theta: Jet) -> Jet:
        x, y = place(theta)
        # the point seen from the pivot: its angle from the line to the axis, its distance
        across = m.pivot - x
        square = across * across + y * y
        # an arctangent of two halves stays finite on the pivot's own height
        seen = 2.0 * atan(y / (sqrt(square) + across))
        if m.flat:
            return seen + asin(m.face_offset / sqrt(square)) - m.start
        # by two halves too: beside the arm a round follower may be tiny
        away, more = sqrt(square) - m.arm, sqrt(square) + m.arm
        within = (m.radius - away) * (m.radius + away)
        beyond = (more - m.radius) * (more + m.radius)
        return seen + side * 2.0 * atan(sqrt(within / beyond)) - m.start

    return swinging if m.oscillating else sliding


def lost_lift(program: Program, mechanism: Mechanism, corner: Corner, side: int = 1) -> Extreme:
    """Return the largest lift that a corner costs, and where.

    Parameters
    ----------
    program : Program
        The lift asked for.
    mechanism : Mechanism
        The follower.
    corner : Corner
        Of the trimmed profile, turning counter-clockwise.
    side : {1, -1}
        Whether the profile is within the pitch curve or beyond it.

    Returns
    -------
    Extreme
        Cam angle, rad, and lift, mm or rad, never negative.

    Raises
    ------
    InfeasibleError
        If the follower cannot touch the corner anywhere.
    """
    rest, start, end = resting(mechanism, corner.point, side), corner.before, corner.after
    if end < start:
        end += _TURN
    if end == start or end - start > _TURN - _NARROWEST:
        return Extreme(theta=start, value=0.0)

    def missing(theta: Array) -> list[Array]:
        with np.errstate(invalid="ignore"):
            given = rest(Jet.variable(theta, 1)).derivatives()
        return list(side * np.subtract(program.derivatives(theta, 1), given))

    places, values = extremes(missing, program.cuts_between(start, end))
    if np.isnan(values).all():
        raise InfeasibleError(
            "a corner that trimming leaves is where the follower cannot rest",
            where=mechanism.driver.told(start),
            nearest="its arm or its pivot leaves it no place there",
        )
    best = int(np.nanargmax(values))
    return Extreme(theta=float(places[best]) % _TURN, value=max(0.0, float(values[best])))
