"""Friction between a roller and its wall: that of its pin, and slip along it.

The wall passes the follower with the speed u along the roller's circumference and w along the line
of contact. A roller that turns by W slips there with ``(u - r*W, w)``: it has one speed, but the
wall is faster outside. The friction per load is ``mu*slip/abs(slip)``, and what turns the roller,

    integral of p*r*mu*(u - r*W)/abs(slip)  =  q*R*N,

is the friction of its pin, q times the normal force at its circumference. The left side falls with
W, so that W is its only root; where even a roller at rest gets less, it does not turn.

Without a coefficient of slip there is only the friction of the pin, along the circumference.

Where the slip changes its sign the friction jumps. At each place stands its mean over half a step
to both sides, in closed form for an even change of the slip and a constant w: with s the slip, s+
and s- that at the ends, ``2*s/(hypot(s+, w) + hypot(s-, w))`` around the roller and
``w*(asinh(s+/w) - asinh(s-/w))/(s+ - s-)`` along it. Energy and moments balance exactly; forces
across the load are within 1 % of their largest. Depends on numeric; numpy only.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.roots import bracketed_root

_ROOT = 1e-13
"""Width of the bracket of a roller's speed, over the largest."""

_CREEP = 1e-4
"""Slip at which a roller is held, over its speed, where it does not slip otherwise."""


_NARROW = 1e-6
"""Least change of the slip over half a step, over w: for less the means are the values."""


class Rubbed(NamedTuple):
    """Friction at k places of n rollers.

    Attributes
    ----------
    around, along : (n, k) arrays
        Of the wall on the roller, over the load there: in the direction of u, and of w.
    lost : (n, k) array, mm per unit of the driver's way
        Work that is lost, over the load.
    """

    around: Array
    along: Array
    lost: Array


def rubbed(
    loads: Array, radius: Array, speeds: tuple[Array, Array], pin: float, slip: float
) -> Rubbed:
    """Return the friction of rollers.

    Parameters
    ----------
    loads : (n, k) array
        How much of the normal force each place carries.
    radius : (n, k) array, mm
        Radii of the roller there.
    speeds : two (n, k) arrays, mm per unit of the driver's way
        Of the wall past the follower, around and along the roller.
    pin : float
        Friction of the pin at the circumference, over the normal force.
    slip : float
        Coefficient of friction of slip; 0 leaves it out.

    Returns
    -------
    Rubbed
    """
    around, along = speeds
    if not slip:
        return Rubbed(pin * np.sign(around), np.zeros_like(along), pin * np.abs(around))
    way = np.sign((loads * around).sum(axis=1, keepdims=True))
    rolling = way * around / radius
    creep = radius * _CREEP * np.abs(around / radius).max(axis=1, keepdims=True)
    aside = np.hypot(along, creep) + np.finfo(float).tiny
    mean = (loads * radius).sum(axis=1, keepdims=True)

    def slipping(turn: Array) -> tuple[Array, Array, Array]:
        """Return the slip, its change over half a step, and its mean size with that along."""
        speed = around - way * radius * turn
        half = np.maximum(0.5 * np.abs(np.gradient(speed, axis=1)), _NARROW * aside)
        return speed, half, 0.5 * (np.hypot(speed + half, aside) + np.hypot(speed - half, aside))

    def excess(turn: Array) -> Array:
        speed, _, size = slipping(turn[:, None])
        gained = way * slip * (loads * radius * speed / size).sum(axis=1, keepdims=True)
        return (gained - pin * mean)[:, 0]

    rest, fastest = np.zeros(len(loads)), np.maximum(rolling.max(axis=1), 0.0)
    held = excess(rest) <= 0.0
    width = _ROOT * float(fastest.max(initial=0.0)) or 1.0
    turn = np.where(held, 0.0, bracketed_root(excess, rest, fastest, width))[:, None]
    speed, half, size = slipping(turn)
    share = np.arcsinh((speed + half) / aside) - np.arcsinh((speed - half) / aside)
    beside = slip * along * share / (2.0 * half)
    carried = np.maximum(loads.sum(axis=1, keepdims=True), np.finfo(float).tiny)
    lost = slip * speed**2 / size + beside * along + pin * turn * mean / carried
    return Rubbed(slip * speed / size, beside, lost)
