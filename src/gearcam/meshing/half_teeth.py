"""Half-teeth: the pieces into which outlines are cut for the stepwise overlap.

Each wheel is divided into *half-teeth*, from the middle of a tip to the middle of a root and a
little below. They are numbered by h, from 0 at the + side of tooth 1; on wheel 2 from the one that
faces it, so that half-tooth h of the driver faces half-tooth h of the driven wheel. On closed
wheels h continues over the turns; an open one has the half-teeth -1 to 2z, from one end of its
blank to the other, and a *body* below them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import shapely

from gearcam.gears.flank import Curve, Toothing
from gearcam.gears.outline import Outline
from gearcam.numeric.arrays import Array, Ints, Plane, as_pairs, in_groups, lengths_along
from gearcam.numeric.pose import Pose

_BELOW = 0.5
"""Depth of the half-teeth below the root, in dedendums: more than any overlap of interest."""

_SAME = 1e-12
"""Share of the outline within which a middle counts as a vertex: closer edges may cross."""


@dataclass(frozen=True, eq=False, kw_only=True)
class HalfTeeth:
    """The half-teeth of a wheel.

    Parameters
    ----------
    points : complex array, mm
        Vertices of all half-teeth in the wheel's frame, in order: each from the middle of the tip
        to the middle of the root, below that, and below the tip. For an open wheel those of its
        body follow.
    starts : (n + 1,) int array, for an open wheel (n + 2,)
        Index of the first vertex of each half-tooth, and the end.
    chord_error : float, mm
        Largest distance of the curve from its chords.
    tips : (n,) complex array, mm
        Middle of the tip of each half-tooth's tooth.
    teeth : (n,) int array
        Number of each half-tooth's tooth.
    first : int
        h of the first one: 0, for an open wheel -1.
    pitch : float, mm
        Pitch along the centrode: two half-teeth.
    closed : bool
        Whether the wheel is toothed all around.
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
        """Number of half-teeth: 2z on a closed wheel, 2z + 2 on an open one."""
        return len(self.tips)

    def index(self, half: Ints) -> Ints:
        """Return the array indices of half-teeth h, in any turn; -1 where there is none."""
        if self.closed:
            return half % self.count
        index = half - self.first
        return np.where((index >= 0) & (index < self.count), index, -1)

    def of_pair(self, pair: Ints, side: int) -> Ints:
        """Return the half-teeth h, in the first turn, of pairs j, `pair`, of a driver's `side`."""
        return self.index(2 * pair - (side < 0)) + self.first

    def tooth(self, half: Ints) -> Any:
        """Return the tooth numbers of half-teeth h, (n,), masked for the body."""
        index = half - self.first
        body = index == self.count
        return np.ma.masked_array(self.teeth[np.where(body, 0, index)], mask=body)

    def moved(
        self, toothing: Toothing, pitch: Mapping[int, float], eccentric: complex
    ) -> HalfTeeth:
        """Return the half-teeth of a wheel with errors.

        Parameters
        ----------
        toothing : Toothing
            The wheel.
        pitch : mapping of int to float, mm
            Errors of teeth along the pitch curve, by number: a tooth is moved as a whole.
        eccentric : complex, mm
            Offset of all teeth from the shaft.
        """
        points, tips = self.points.copy(), self.tips.copy()
        for number, error in pitch.items():
            place = toothing.tooth_places[toothing.numbers.index(number)]
            at = toothing.frames(toothing.track.angle([place, place + error]), curved=False)
            turn = at.t[1] / at.t[0]
            for half in np.flatnonzero(self.teeth == number):
                own = slice(self.starts[half], self.starts[half + 1])
                points[own] = at.p[1] + (points[own] - at.p[0]) * turn
                tips[half] = at.p[1] + (tips[half] - at.p[0]) * turn
        return replace(self, points=points + eccentric, tips=tips + eccentric)

    @cached_property
    def polygons(self) -> Any:
        """The half-teeth as prepared shapely polygons, (n,), then the body of an open wheel."""
        polygons = as_polygons(self.points, np.diff(self.starts))
        shapely.prepare(polygons)
        return polygons

    @property
    def sound(self) -> bool:
        """Whether no half-tooth crosses itself, as those of very few, deep teeth may."""
        return bool(np.all(shapely.is_valid(self.polygons)))

    def distance(self, points: Plane) -> Array:
        """Return the distances of points from the half-teeth, mm; 0 inside."""
        at: Any = shapely.points(points.real, points.imag)
        body = self.points[self.starts[self.count] :]  # by its edges, since it has many
        ends = np.stack([body, np.roll(body, -1)], axis=1)
        edges: Any = shapely.linestrings(as_pairs(ends).reshape(-1, 2, 2))
        tree = shapely.STRtree(np.concatenate([self.polygons[: self.count], edges]))
        least = tree.query_nearest(at, return_distance=True, all_matches=False)[1]
        for whole in self.polygons[self.count :]:
            least[shapely.intersects(whole, at)] = 0.0
        return least

    @cached_property
    def circles(self) -> tuple[Plane, Array]:
        """Centres and radii of circles around the half-teeth, (n,), mm."""
        left, low, right, high = shapely.bounds(self.polygons[: self.count]).T
        return 0.5 * (left + right + 1j * (low + high)), 0.5 * np.hypot(right - left, high - low)

    def placed(self, which: Ints, pose: Pose) -> Any:
        """Return half-teeth `which` as polygons, each in its place by one of the n poses `pose`."""
        first = self.starts[which]
        sizes = self.starts[which + 1] - first
        owner, place = in_groups(sizes)
        places = self.points[first[owner] + place] * pose.rotation[owner] + pose.shift[owner]
        return as_polygons(places, sizes)


def half_teeth(outline: Outline) -> HalfTeeth:
    """Return a wheel divided into half-teeth.

    Parameters
    ----------
    outline : Outline
        The wheel at the tolerance of the study.

    Returns
    -------
    HalfTeeth
        In order of rising s: from the middle of tooth 1 (wheel 1) or from the middle of the space
        before tooth 1 (wheel 2); for an open wheel from its end.
    """
    toothing, (_, points, chord_error) = outline.toothing, outline.sampler.chords
    middles, low, high, tip_first = _middles(outline)
    inner = _inner(outline, len(middles))
    parts: list[Plane] = []
    for k in range(len(middles) - 1):
        between = points[np.arange(low[k] + 1, high[k + 1]) % len(points)]
        step = 1 if (k % 2 == 0) == tip_first else -1
        own = np.concatenate([middles[k : k + 1], between, middles[k + 1 : k + 2]])
        parts.append(np.concatenate([own[::step], inner[k : k + 2][::-step]]))
    if toothing.closed and toothing.wheel == 2:
        parts = parts[-1:] + parts[:-1]
    tips = np.array([part[0] for part in parts])
    if not toothing.closed:
        parts.append(np.concatenate([inner, _counted(outline)[1:-1]]))
    return HalfTeeth(
        points=np.concatenate(parts),
        starts=np.cumsum([0, *map(len, parts)]),
        chord_error=chord_error,
        tips=tips,
        teeth=_teeth(toothing),
        first=0 if toothing.closed else -1,
        pitch=toothing.pitch,
        closed=toothing.closed,
    )


def _teeth(toothing: Toothing) -> Ints:
    """Return the tooth number of each half-tooth."""
    teeth = np.repeat(np.array(toothing.numbers), 2)
    if toothing.closed:
        return np.roll(teeth, -1) if toothing.wheel == 1 else teeth
    # wheel 1's first and last tooth formed lie outside its blank, wheel 2's half in it
    beyond = 3 - toothing.wheel
    return teeth[beyond:-beyond]


def _middles(outline: Outline) -> tuple[Plane, Ints, Ints, bool]:
    """Middles of lands, mm, vertices before and after them, and whether a tip is the first.

    From the first tooth's tip to the same tip again; for an open wheel from end to end. Vertex
    numbers continue past the closing point. A middle that is a vertex is both its neighbours.
    """
    j, points, _ = outline.sampler.chords
    lands, tip_first = _lands(outline, j[-1])
    size = len(j) - 1
    ring = np.append(points, points[:1])[: size + 1]
    way = lengths_along(ring)
    # the first tip of a closed wheel begins before the closing point
    j, way = (np.concatenate([one[:-1] - one[-1], one]) for one in (j, way))
    ring = np.concatenate([ring[:-1], ring])
    chord = np.minimum(np.searchsorted(j, lands, side="right"), len(j) - 1) - 1
    ends = outline.sampler.at(np.where(lands < 0.0, lands + j[-1], lands).ravel())[0]
    middle = (way[chord] + np.abs(ends.reshape(lands.shape) - ring[chord])).mean(axis=1)
    middle = np.minimum(middle, way[-1])
    grain = _SAME * way[-1]
    low = np.searchsorted(way, middle + grain, side="right") - 1
    beside = np.where(middle - way[low] > grain, middle - way[low], 0.0)
    high = low + (beside > 0.0)
    step = ring[high] - ring[low]
    middles = ring[low] + beside * step / np.maximum(np.abs(step), np.finfo(float).tiny)
    return middles, low - size, high - size, tip_first


def _lands(outline: Outline, whole: float) -> tuple[Array, bool]:
    """Vertex numbers at the ends of lands, (n, 2), and whether a tip is the first."""
    (front, front_end), (back, back_end) = _flanks(outline)
    roots = np.stack([front_end, back], axis=1)
    tips = np.stack([back_end[:-1], front[1:]], axis=1)
    if outline.toothing.closed:
        tips = np.concatenate([[[back_end[-1] - whole, 0.0]], tips, [[back_end[-1], whole]]])
    elif outline.toothing.wheel == 1:
        roots[0], roots[-1] = 0.0, whole
    else:
        tips = np.concatenate([[[0.0, 0.0]], tips, [[whole, whole]]])
    tip_first = len(tips) > len(roots)
    lands = np.empty((len(tips) + len(roots), 2))
    lands[int(not tip_first) :: 2], lands[int(tip_first) :: 2] = tips, roots
    return lands, tip_first


def _flanks(outline: Outline) -> Array:
    """Vertex numbers at start and end of the front and back of each space, (2, 2, spaces).

    A space begins with the + flank of its tooth and ends with the - flank of the next one. An open
    driver has half a space at each end.
    """
    rows, toothing, joints = outline.rows, outline.toothing, outline.sampler.joints
    flank = np.flatnonzero(rows.kind == Curve.FLANK)
    plus = rows.sigma[flank] > 0.0
    count = len(toothing.numbers) - (0 if toothing.closed else 1)
    space = (rows.tooth[flank] - toothing.numbers[0] - np.where(plus, 0, 1)) % count
    ends = np.zeros((2, 2, count))
    for side, mine in enumerate((plus, ~plus)):
        first, last = np.full(count, len(rows.kind)), np.full(count, -1)
        np.minimum.at(first, space[mine], flank[mine])
        np.maximum.at(last, space[mine], flank[mine])
        ends[side] = joints[first], joints[last + 1]
    return ends


def _inner(outline: Outline, count: int) -> Plane:
    """Points below the middles of lands; at the ends of an open wheel corners of its body."""
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
    """Vertices of the body between the ends of an open wheel, in order of rising s."""
    points = outline.points[len(outline.toothed) :]
    return points if outline.toothing.wheel == 1 else points[::-1]


def as_polygons(points: Plane, sizes: Ints) -> Any:
    """Return polygons of `sizes` vertices each, from consecutive `points`."""
    owner = np.repeat(np.arange(len(sizes)), sizes)
    return shapely.polygons(shapely.linearrings(as_pairs(points), indices=owner))
