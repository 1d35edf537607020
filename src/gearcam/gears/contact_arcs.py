"""When pairs of flanks are in contact: arcs of the driver, contact ratios, pairs at a time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.gears.track import Track
from gearcam.numeric.arrays import Array, Ints, first_least

_SAME = 1e-12
"""Ends of arcs closer than this, in travels, are the same: rounding."""

_ALIKE = 1e-9
"""Contact ratios closer than this are equal: rounding separates what symmetry makes equal."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactArcs(ShortRepr):
    """The arcs of the driver along which pairs of flanks touch, one entry for each pair.

    Parameters
    ----------
    start, end : (n,) arrays, rad
        Driver angles at start and end of contact; ``start >= end`` if there is none.
    track : Track
        The driver's track.
    pitch : float, mm
        Its pitch.
    travel : float, rad
        Driver angle over which the pairs are counted.
    closed : bool
        Whether the arcs repeat after it.
    """

    start: Array
    end: Array
    track: Track
    pitch: float
    travel: float
    closed: bool

    @cached_property
    def ratios(self) -> Array:
        """Contact ratio of each pair: its arc along the driver's pitch curve, over the pitch."""
        start, end = self.track.arc_length(self.start), self.track.arc_length(self.end)
        return np.maximum(end - start, 0.0) / self.pitch

    @property
    def weakest(self) -> int:
        """Index of the smallest contact ratio; the first of those equal but for rounding."""
        return first_least(self.ratios, _ALIKE)

    @cached_property
    def stretches(self) -> tuple[Array, Array, Ints]:
        """Intervals of the `travel` by pairs in contact.

        Driver angles of start and end, rad, and the number of pairs in contact: 1 on single-pair
        arcs, 2 on double-pair arcs, 0 where no flanks touch.
        """
        touching = self.end > self.start
        again = self.travel * (np.arange(-1, 2)[:, None] if self.closed else np.zeros((1, 1)))
        start, end = ((edge[touching] + again).ravel() for edge in (self.start, self.end))
        edges = np.clip(np.concatenate([start, end]), 0.0, self.travel)
        edges = np.sort(np.concatenate([[0.0], edges, [self.travel]]))
        edges = edges[np.append(np.diff(edges) > _SAME * self.travel, True)]
        edges[0] = 0.0
        middle = 0.5 * (edges[:-1] + edges[1:])
        carrying = np.searchsorted(np.sort(start), middle, side="right")
        carrying -= np.searchsorted(np.sort(end), middle, side="left")
        first = np.flatnonzero(np.append(True, np.diff(carrying) != 0))
        return edges[first], np.append(edges[first[1:]], self.travel), carrying[first]

    def carrying(self, phi1: ArrayLike) -> Ints:
        """Return the number of pairs in contact at phases `phi1`, rad."""
        phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
        start, end, pairs = self.stretches
        x = np.mod(phi1, end[-1]) if self.closed else phi1
        return pairs[np.clip(np.searchsorted(start, x, side="right") - 1, 0, len(pairs) - 1)]
