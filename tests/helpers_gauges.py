"""Pins and jaws laid against the outline of a wheel, which knows nothing of flanks."""

from __future__ import annotations

from typing import Final

import numpy as np
import shapely

from gearcam.gears.measuring import Measuring
from gearcam.gears.pair import Gear

_AT_ENDS: Final = 0.8
"""Distance of a contact from the middle of its flank from which it is at its end."""


def misfits(measuring: Measuring, gear: Gear) -> np.ndarray:
    """How far discs in the found places of pins are from touching the outline, (n,), mm."""
    diameter, pins = measuring.pins()
    ring = shapely.LinearRing(gear.outline)
    places = [shapely.Point(one.real, one.imag) for one in pins.center[pins.measured]]
    return np.array([ring.distance(one) for one in places]) - 0.5 * diameter


def jaw_misfits(measuring: Measuring, gear: Gear) -> np.ndarray:
    """How far readings of spans are from those over the teeth's own vertices, (n,), mm.

    Not of those at the very ends of flanks, where the next vertex is one of the fillet.
    """
    points, (teeth, ends) = gear.profile.points, gear.profile.teeth
    spans, off = measuring.spans, []
    for number, (first, last) in enumerate(zip(spans.first, spans.last, strict=True)):
        contact = spans.contact[:, number]
        if spans.off[number] > _AT_ENDS:
            continue
        along = np.conj((contact[0] - contact[1]) / abs(contact[0] - contact[1]))
        reach = []
        for tooth in (last, first):
            start, stop = ends[np.flatnonzero(teeth == tooth)[0]]
            own = np.arange(start, stop + 1 + len(points) * (stop < start)) % len(points)
            reach.append((along * points[own]).real)
        # the first and the last vertex of a tooth may be those of its fillets
        most = reach[0][1:-1].max() - reach[1][1:-1].min() - spans.reading[number]
        least = reach[0].max() - reach[1].min() - spans.reading[number]
        off.append(most if most > 0.0 else min(least, 0.0))
    return np.array(off)
