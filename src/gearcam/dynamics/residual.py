"""Residual vibration: how far a follower swings in the dwell after a rise, without damping.

A mass on a spring that is lifted through it by a rise S of unit height, from rest, swings about its
new place by ``abs(integral_0^1 S'(x)*exp(2i*pi*tau*x) dx)``, tau being the time of the rise over
the natural period. By parts it is the integral of S'' over ``2*pi*tau``; this form holds for jumps
of the velocity at the ends, too, and at tau = 0.

Sources: classical (convolution); the closed forms of single laws are in the tests.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gearcam.numeric.arrays import Array
from gearcam.numeric.gauss import legendre_rule
from gearcam.numeric.piecewise import Piecewise

_NODES, _WEIGHTS = legendre_rule(24)

_LEAST: int = 4
"""Panels of a piece, at least; more where the vibration turns by more than 4 rad in one."""


def residual(rise: Piecewise, ratios: ArrayLike) -> Array:
    """Return the amplitude of the vibration after a rise, over what its height makes slowly.

    Parameters
    ----------
    rise : Piecewise
        S over the unit interval, from 0 to 1.
    ratios : (n,) array
        Time of the rise over the natural period.

    Returns
    -------
    (n,) array
    """
    ratios = np.asarray(ratios, dtype=float)
    turning = 2.0 * np.pi * float(np.max(ratios, initial=0.0))
    total = np.zeros(ratios.shape, dtype=complex)
    for number, (low, high) in enumerate(zip(rise.knots[:-1], rise.knots[1:], strict=True)):
        panels = _LEAST + int(turning * (high - low) / 4.0)
        half = 0.5 * (high - low) / panels
        middles = low + half * (1.0 + 2.0 * np.arange(panels))
        x = (middles[:, None] + half * _NODES).ravel()
        speed = rise.on_pieces(np.full(x.shape, number), x, 1)[1]
        weights = np.tile(half * _WEIGHTS, panels) * speed
        total += np.exp(2j * np.pi * ratios[:, None] * x) @ weights
    return np.abs(total)
