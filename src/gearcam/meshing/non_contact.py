"""Non-contact stretches: no flanks share a tangent, and only edges drive, or nothing does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcam.gears.contact import FlankPairs
from gearcam.gears.normals import touch
from gearcam.meshing.edges import of_leading_pair, to_pitch_line, touches

_ROUNDING = 1e-12
"""Rounding of the driver angle at the end of a lobe, as a share of it."""

_BETWEEN = np.linspace(0.02, 0.98, 9)
"""Positions in a stretch, as shares of it, at which edge contact is tested."""


@dataclass(frozen=True, kw_only=True)
class NonContact:
    """A range of driver angles in which no flanks share a tangent.

    Parameters
    ----------
    start, end : float, rad
        Driver angles.
    edges : bool
        Whether ends of flanks touch, and so drive, all along it.
    apart : float, mm
        Largest deviation of the driven wheel, along its pitch curve, from its position with
        unlimited flanks.
    """

    start: float
    end: float
    edges: bool
    apart: float


def non_contact(pairs: FlankPairs) -> list[NonContact]:
    """Return the stretches of a lobe, or of an open pair's travel, in which no flanks touch.

    Parameters
    ----------
    pairs : FlankPairs
        The side.

    Returns
    -------
    list of NonContact
        In order.
    """
    start, end, carrying = pairs.stretches
    lobe = pairs.track.arc.period if pairs.closed and pairs.even else pairs.travel
    at = np.flatnonzero((carrying == 0) & (start < lobe * (1.0 - _ROUNDING)))
    phi1 = (start[at, None] + (end - start)[at, None] * _BETWEEN).ravel()
    if not phi1.size:
        return []
    found = touches(pairs, phi1)
    lead = -pairs.side * of_leading_pair(pairs.side, len(phi1), found.step, found.turn)
    any_pair = pairs.candidates(pairs.track.arc_length(phi1))[:, 0]
    free = touch(pairs, phi1, pairs.separation(any_pair))[0].lead
    apart = np.abs((lead - free) * to_pitch_line(pairs, phi1)).reshape(len(at), -1).max(axis=1)
    return [
        NonContact(start=low, end=high, edges=bool(np.isfinite(most)), apart=most)
        for low, high, most in zip(
            start[at].tolist(), end[at].tolist(), apart.tolist(), strict=True
        )
    ]
