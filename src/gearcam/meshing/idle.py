"""Stretches on which no flanks share a tangent: there ends of flanks drive, or nothing does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcam.gears.contact import FlankPairs
from gearcam.gears.normals import touch
from gearcam.meshing.gap import to_pitch_line, touches

_BETWEEN = np.linspace(0.02, 0.98, 9)
"""Shares of a stretch at which it is asked what drives."""


@dataclass(frozen=True, kw_only=True)
class Idle:
    """A stretch of the driver's way on which no flanks share a tangent.

    Parameters
    ----------
    start, end : float, rad
        Driver angles.
    edges : bool
        Whether ends of flanks touch all along it, and so drive.
    apart : float, mm
        Largest difference of the driven wheel's place, along its pitch curve, from where flanks
        without ends would hold it.
    """

    start: float
    end: float
    edges: bool
    apart: float


def idle(pairs: FlankPairs) -> tuple[Idle, ...]:
    """Return the stretches of a lobe, or of an open pair's way, on which no flanks touch.

    Parameters
    ----------
    pairs : FlankPairs
        The side.

    Returns
    -------
    tuple of Idle
        In order.
    """
    start, end, carrying = pairs.stretches
    rolling = pairs.toothings[0].rolling
    lobe = rolling.law.lobes.period if pairs.closed and pairs.even else pairs.way
    at = np.flatnonzero((carrying == 0) & (start < lobe * (1.0 - 1e-12)))
    found = []
    for low, high in zip(start[at], end[at], strict=True):
        phi1 = low + (high - low) * _BETWEEN
        near = touches(pairs, phi1)
        turn = np.full(len(phi1), np.inf)
        np.minimum.at(turn, near.step, pairs.side * near.turn)
        s = rolling.arc_length(phi1)
        nearest = pairs.near(s)[:, 0]
        free = touch(pairs, phi1, pairs.play(nearest))[0].lead
        apart = np.abs((pairs.side * turn - free) * to_pitch_line(rolling, phi1))
        edges = bool(np.isfinite(turn).all())
        found.append(
            Idle(
                start=float(low),
                end=float(high),
                edges=edges,
                apart=float(apart.max()) if edges else np.inf,
            )
        )
    return tuple(found)
