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

from gearcam.linkages.elements import Dyad
from gearcam.linkages.linkage import Linkage, in_cycle
from gearcam.linkages.transmission import guide_distance, guide_distances
from gearcam.numeric.arrays import apart, away

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
    inside = apart(np.sort(places[(places > low) & (places < high)]), _APART)
    return replace(linkage, knots=np.union1d(knots, away(inside, knots, _APART)))


def _places(linkage: Linkage) -> Iterator[np.ndarray]:
    for dyad in linkage.dyads:
        if dyad.type in ("RTR1", "RTR2"):
            yield from _passes(linkage, dyad)


def _passes(linkage: Linkage, dyad: Dyad) -> Iterator[np.ndarray]:
    """Yield the knots about each place at which a pin passes the pivot of its guide closely."""
    places, squares = guide_distances(linkage, dyad).extremes[0]
    beside = np.minimum(np.append(squares[1:], np.inf), np.append(np.inf, squares[:-1]))
    places, squares = places[squares <= beside], squares[squares <= beside]
    bends = guide_distance(linkage.at(places, 2), dyad).derivatives()[2]
    for place, square, bend in zip(places, squares, bends, strict=True):
        width = np.sqrt(max(square, 0.0) / (0.5 * bend)) if bend > 0.0 else np.inf
        if width < _NARROW:
            yield place + width * _AROUND
