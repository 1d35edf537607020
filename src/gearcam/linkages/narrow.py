"""Places where a guide turns fast: knots there, so that searches between knots see all of it.

Near the pivot of its guide a pin at the distance ``D^2 = d^2 + (c*h)^2``, h the driver's angle from
the nearest place, turns the guide by nearly half a turn within a few d/c. Where this is narrow, it
is less than the step of a search.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from gearcam.linkages.linkage import Linkage, in_cycle
from gearcam.linkages.transmission import guide_distance, transmission_of
from gearcam.numeric.arrays import away

_NARROW: Final = 0.1
"""Width, rad, from which a search sees it without knots of its own."""

_AROUND: Final = np.array([-30.0, -6.0, -1.0, 0.0, 1.0, 6.0, 30.0])
"""Knots about the nearest place, in widths."""

_APART: Final = 1e-9
"""Distance from other knots below which none is added, rad."""


def with_narrow_places(linkage: Linkage) -> Linkage:
    """Return a linkage with knots where its guides turn fast.

    Parameters
    ----------
    linkage : Linkage
        One that closes over its whole range.

    Returns
    -------
    Linkage
    """
    found = list(_places(linkage))
    if not found:
        return linkage
    (low, high), places, knots = linkage.span, np.concatenate(found), linkage.knots
    if linkage.closed:
        _, places = in_cycle(places, linkage.span)
    inside = places[(places > low) & (places < high)]
    return replace(linkage, knots=np.union1d(knots, away(inside, knots, _APART)))


def _places(linkage: Linkage) -> Iterator[np.ndarray]:
    for dyad in linkage.dyads:
        nearest = transmission_of(linkage, dyad).distance if dyad.type.startswith("RTR") else None
        if nearest is None:
            continue
        known = linkage.at(np.array([nearest.place]), 2)
        bend = float(guide_distance(known, dyad).derivatives()[2][0])
        width = nearest.value / np.sqrt(0.5 * bend) if bend > 0.0 else np.inf
        if width < _NARROW:
            yield nearest.place + width * _AROUND
