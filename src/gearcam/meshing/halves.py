"""Halves of teeth: the outlines as the stepwise overlap cuts them.

Each wheel is divided into *halves* of teeth, from the middle of a tip to the middle of a root and
a little below; h counts them from tooth 1's +s half as 0, wheel 2 from the half that faces it.
Half h of the driver faces half h of the driven wheel. Closed wheels count on over their turns; an
open one has the halves -1 to 2z, from one end of its blank to the other, and a *body* below them.
"""

from __future__ import annotations

from collections.abc import Sequence, Sized
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import shapely

from gearcam.gears.flank import Curve, Toothing
from gearcam.gears.outline import Outline
from gearcam.numeric.arrays import Array, Ints, Plane

_BELOW = 0.5
"""Depth of the halves below the root, in dedendums: more than any overlap that is worth a name."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Halves:
    """The halves of a wheel's teeth.

    Parameters
    ----------
    points : complex array, mm
        Vertices of all halves in the wheel's frame, one half after another: each from the middle
        of the tip to the middle of the root, below that, and below the tip. Of an open wheel those
        of its body follow.
    starts : (n + 1,) int array, of an open wheel (n + 2,)
        Where each half begins, and the end.
    chord_error : float, mm
        Largest distance of the curve from its chords.
    tips : (n,) complex array, mm
        Middle of the tip of each half's tooth.
    teeth : (n,) int array
        Number of each half's tooth.
    first : int
        h of the first half: 0, of an open wheel -1.
    pitch : float, mm
        Pitch along the centrode: two halves.
    closed : bool
        Whether the halves go all around.
    """

    points: Plane
    starts: Ints
    chord_error: float
    tips: Plane
    teeth: Ints
    first: int
    pitch: float
    closed: bool

    @property
    def count(self) -> int:
        """Number of halves: 2z of a closed wheel, 2z + 2 of an open one."""
        return len(self.tips)

    def index(self, half: Ints) -> Ints:
        """Return the places in arrays of halves h, however counted; -1 where there is none."""
        if self.closed:
            return half % self.count
        index = half - self.first
        return np.where((index >= 0) & (index < self.count), index, -1)

    def of_pair(self, pair: Ints, side: int) -> Ints:
        """Return the halves h, within the first turns, of pairs j of a driver's `side`: `pair`."""
        return self.index(2 * pair - (side < 0)) + self.first

    def tooth(self, half: Ints) -> Any:
        """Return the numbers of the teeth of halves h, masked where it is the body, (n,)."""
        index = half - self.first
        body = index == self.count
        return np.ma.masked_array(self.teeth[np.where(body, 0, index)], mask=body)

    @cached_property
    def polygons(self) -> Any:
        """The halves as shapely polygons, prepared, (n,), then the body of an open wheel."""
        polygons = as_polygons(self.points, np.diff(self.starts))
        shapely.prepare(polygons)
        return polygons

    @property
    def sound(self) -> bool:
        """Whether no half crosses itself, as those of very few, deep teeth may."""
        return bool(np.all(shapely.is_valid(self.polygons)))

    def distance(self, points: Plane) -> Array:
        """Return the distances of points from the halves, mm; 0 inside."""
        union = shapely.MultiPolygon(self.polygons.tolist())
        return np.asarray(shapely.distance(union, shapely.points(points.real, points.imag)))

    @cached_property
    def circles(self) -> tuple[Plane, Array]:
        """Centres and radii of circles about the halves, (n,), mm."""
        begin, sizes = self.starts[: self.count], np.diff(self.starts)[: self.count]
        points = self.points[: self.starts[self.count]]
        center: Plane = np.asarray(np.add.reduceat(points, begin) / sizes, dtype=complex)
        apart = np.abs(points - np.repeat(center, sizes))
        return center, np.asarray(np.maximum.reduceat(apart, begin))

    def placed(self, halves: Ints, turn: Plane, shift: Plane) -> Any:
        """Return `halves` as polygons, (n,), each by its own `turn` and `shift`, mm."""
        sizes = self.starts[halves + 1] - self.starts[halves]
        owner = np.repeat(np.arange(len(halves)), sizes)
        first = np.cumsum(sizes) - sizes
        index = np.arange(len(owner)) - first[owner] + self.starts[halves][owner]
        return as_polygons(self.points[index] * turn[owner] + shift[owner], sizes)


def halve(outline: Outline) -> Halves:
    """Divide a wheel into the halves of its teeth.

    Parameters
    ----------
    outline : Outline
        The wheel at the tolerance of the study.

    Returns
    -------
    Halves
        In the order of rising s: from the middle of tooth 1 (wheel 1) or from the middle of the
        space before tooth 1 (wheel 2), of an open wheel from its end.
    """
    toothing = outline.toothing
    points, lands = _lands(outline)
    inner = _inner(outline, len(lands))
    halves: list[Plane] = []
    size = len(outline.sampler.chords[1])
    for k, (first, second) in enumerate(pairwise(lands)):
        between = np.arange(first.low + 1, second.high) % size
        own = points[np.concatenate([[first.middle], between, [second.middle]])]
        step = 1 if first.tip else -1
        halves.append(np.concatenate([own[::step], inner[k : k + 2][::-step]]))
    if toothing.closed and toothing.wheel == 2:
        halves = halves[-1:] + halves[:-1]
    bodies = [] if toothing.closed else [_body(outline, inner)]
    return Halves(
        points=np.concatenate(halves + bodies),
        starts=_starts(halves + bodies),
        chord_error=outline.sampler.chords[2],
        tips=np.array([half[0] for half in halves]),
        teeth=_teeth(toothing),
        first=0 if toothing.closed else -1,
        pitch=toothing.pitch,
        closed=toothing.closed,
    )


def _teeth(toothing: Toothing) -> Ints:
    """Return the number of each half's tooth."""
    teeth = np.repeat(np.array(toothing.numbers), 2)
    if toothing.closed:
        return np.roll(teeth, -1) if toothing.wheel == 1 else teeth
    # wheel 1's first and last tooth formed lie outside its blank, wheel 2's half in it
    beyond = 3 - toothing.wheel
    return teeth[beyond:-beyond]


def _starts(parts: Sequence[Sized]) -> Ints:
    return np.concatenate([[0], np.cumsum([len(part) for part in parts])])


class _Land(NamedTuple):
    """A land, and the number of its middle: a vertex itself, or one between `low` and `high`."""

    tip: bool
    low: int
    high: int
    middle: int


def _lands(outline: Outline) -> tuple[Plane, list[_Land]]:
    """Vertices of the outline, then those middles of lands that are none; the lands in order.

    From the first tooth's tip to the same one again; of an open wheel from end to end. Vertices
    are counted on where the outline closes.
    """
    points = outline.sampler.chords[1]
    size = len(points)
    (front, front_end), (back, back_end) = _flanks(outline)
    roots = np.stack([front_end, back], axis=1)
    tips = np.stack([back_end[:-1], front[1:]], axis=1)
    if outline.toothing.closed:
        tips = np.concatenate([[[back_end[-1] - size, 0]], tips, [[back_end[-1], size]]])
    elif outline.toothing.wheel == 1:
        roots[0], roots[-1] = 0, size - 1
    else:
        tips = np.concatenate([[[0, 0]], tips, [[size - 1, size - 1]]])
    first, second = (tips, roots) if len(tips) > len(roots) else (roots, tips)
    ends = np.empty((len(tips) + len(roots), 2), dtype=np.int64)
    ends[::2], ends[1::2] = first, second
    low, high = ends.sum(axis=1) // 2, (ends.sum(axis=1) + 1) // 2
    middles = 0.5 * (points[low % size] + points[high % size])
    lands = [
        _Land((k % 2 == 0) == (first is tips), a, b, size + k if a < b else a % size)
        for k, (a, b) in enumerate(zip(low.tolist(), high.tolist(), strict=True))
    ]
    return np.concatenate([points, middles]), lands


def _flanks(outline: Outline) -> Ints:
    """Vertices at which the front of each space begins and ends, and the back, (2, 2, spaces).

    A space begins with the + flank of its tooth and ends with the - flank of the next one. At the
    ends of an open driver there is half a space.
    """
    rows, toothing = outline.rows, outline.toothing
    vertices = outline.sampler.chords[0]
    row = outline.sampler.curve_of(vertices[:-1] if toothing.closed else vertices)
    flank = np.flatnonzero(rows.kind == Curve.FLANK)
    plus = rows.sigma[flank] > 0.0
    count = len(toothing.numbers) - (0 if toothing.closed else 1)
    space = (rows.tooth[flank] - toothing.numbers[0] - np.where(plus, 0, 1)) % count
    ends = np.zeros((2, 2, count), dtype=np.int64)
    for side, mine in enumerate((plus, ~plus)):
        first, last = np.full(count, len(rows.kind)), np.full(count, -1)
        np.minimum.at(first, space[mine], flank[mine])
        np.maximum.at(last, space[mine], flank[mine])
        ends[side] = np.searchsorted(row, first), np.searchsorted(row, last + 1)
    return ends


def _inner(outline: Outline, count: int) -> Plane:
    """Points below the middles of lands; at the ends of an open wheel the corners of its body."""
    toothing = outline.toothing
    start = toothing.tooth_places[0] if toothing.closed else toothing.ends[0]
    angle = toothing.track.angle(start + 0.5 * toothing.pitch * np.arange(count))
    frames = toothing.frames(angle, curved=False)
    height = -(1.0 + _BELOW) * toothing.cutter.dedendum
    inner = frames.p + height * toothing.turn * frames.t
    if toothing.closed:
        inner[-1] = inner[0]
    else:
        inner[[-1, 0]] = _counted(outline)[[0, -1]]
    return inner


def _counted(outline: Outline) -> Plane:
    """Vertices of what joins the ends of an open wheel, in the order of rising s."""
    x, y = outline.points[len(outline.toothed) :].T
    points: Plane = x + 1j * y
    return points if outline.toothing.wheel == 1 else points[::-1]


def _body(outline: Outline, inner: Plane) -> Plane:
    """Vertices of what is below the halves of an open wheel."""
    return np.concatenate([inner, _counted(outline)[1:-1]])


def as_polygons(points: Plane, sizes: Ints) -> Any:
    """Return polygons of `sizes` vertices each, whose `points` stand one after another."""
    coordinates = np.stack([points.real, points.imag], axis=1)
    owner = np.repeat(np.arange(len(sizes)), sizes)
    return shapely.polygons(shapely.linearrings(coordinates, indices=owner))
