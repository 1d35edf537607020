"""Stepwise overlap: the outlines of the pair, turned phase by phase and intersected.

This is the source texts' study of the contact patch (003, section 2.3.3.1), and the proof that
looks at nothing but outlines. The wheels are taken in `halves` of teeth, the driver's turned into
the driven wheel's frame. Half h of the driver faces half h of the driven wheel, and can reach the
two beside it: so all overlap of the wheels is looked at, and each piece of it belongs to a pair of
halves. Facing halves are overlapped as graphs (`staircase`); a phase in which a half may touch
another than its mate, or stands across it, is cut as polygons. So is what an open wheel or a rack
may run into far from the pitch point: its other end, or the body below its teeth.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, cast

import numpy as np
import shapely
from numpy.typing import NDArray

from gearcam.gears.contact import Ints
from gearcam.gears.guide import Guide
from gearcam.gears.rolling import Rolling
from gearcam.gears.track import Plane
from gearcam.meshing.halves import Halves, as_polygons
from gearcam.meshing.staircase import Facing, overlap

Array = NDArray[np.float64]

_GROUP = 16
"""Halves of the driver that are first looked at together."""

_BESIDE = 4
"""Halves on both sides of the facing one whose tips are taken for the driven wheel's reach."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Overlaps:
    """Pieces of overlap, one entry each.

    Parameters
    ----------
    step : (n,) int array
        Index of the phase.
    half : (2, n) int array
        Halves h of driver and driven wheel that overlap, counted within the first turn; the number
        after the last one is the body of an open wheel.
    facing : (n,) bool array
        Whether these halves face each other, so that their flanks are a pair.
    area : (n,) array, mm^2
        Area.
    length : (n,) array, mm
        Diagonal of its box: the length of a thin lens.
    radius : (2, n) array, mm
        Smallest and largest distance of its corners from the driver's axis.
    """

    step: Ints
    half: Ints
    facing: NDArray[np.bool_]
    area: Array
    length: Array
    radius: Array

    @property
    def depth(self) -> Array:
        """Depth of a lens (a parabola's segment) of this area and length, mm."""
        return 1.5 * self.area / self.length


@dataclass(frozen=True, eq=False, kw_only=True)
class Turning:
    """Two wheels on their shafts, ready to be turned.

    Parameters
    ----------
    rolling : Rolling
        The centrodes.
    driver, driven : Halves
        The wheels.
    distance : float, mm
        Distance of the shafts as mounted; of a rack, how far it is moved away from its place.
    moved : float, mm
        How far the teeth are moved on along the centrodes: a step of stepped wheels.
    """

    rolling: Rolling
    driver: Halves
    driven: Halves
    distance: float
    moved: float = 0.0

    @cached_property
    def guide(self) -> Guide:
        """What guides the driven wheel."""
        return self.rolling.guide

    @cached_property
    def _tree(self) -> Any:
        return shapely.STRtree(self.driven.polygons)

    @cached_property
    def _land(self) -> Array:
        """Largest distance of a tip's corners from its middle, for each half of the driver."""
        width, half = self.driver.width, np.arange(self.driver.count)
        other = (half + np.where((half + self.driver.first) % 2 == 0, -1, 1)) % len(half)
        return np.maximum(width, width[other])

    @cached_property
    def _groups(self) -> tuple[Plane, Array]:
        """Centres and radii of circles about the tips of groups of the driver's halves."""
        tips, starts = self.driver.tips, np.arange(0, self.driver.count, _GROUP)
        sizes = np.diff(np.append(starts, len(tips)))
        center: Plane = np.asarray(np.add.reduceat(tips, starts) / sizes, dtype=complex)
        apart = np.abs(tips - np.repeat(center, sizes)) + self._land
        return center, np.maximum.reduceat(apart, starts)

    @cached_property
    def _reach(self) -> Array:
        """Largest height of the driven wheel near the half that faces each of the driver's."""
        driven, count = self.driven, self.driven.count
        begin = driven.starts[:count]
        heights = self.guide.height(driven.points[: driven.starts[count]])
        near = np.arange(count)[:, None] + np.arange(-_BESIDE, _BESIDE + 1)
        near = near % count if driven.closed else np.clip(near, 0, count - 1)
        return np.maximum.reduceat(heights, begin)[near].max(axis=1)

    def pose(self, phi1: Array, advance: float, lead: Array | float = 0.0) -> tuple[Plane, Plane]:
        """Return the turn and shift that take the driver's points into the driven wheel's frame.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Phases.
        advance : float, rad
            How far the driver is ahead of them.
        lead : (n,) array or float, rad, of a rack mm
            How far the driven wheel is.

        Returns
        -------
        turn, shift : (n,) complex arrays, 1 and mm
        """
        turn, shift = self.guide.stand(phi1, lead)
        back = np.conj(turn)
        return np.exp(-1j * (phi1 + advance)) * back, back * (-self.distance - shift)

    def overlaps(self, phi1: Array, advance: float, lead: Array | float = 0.0) -> Overlaps:
        """Return all pieces of overlap at phases (see `pose`)."""
        turn, shift = self.pose(phi1, advance, lead)
        step, facing = self._near(phi1, turn, shift)
        driver, driven = self.driver, self.driven
        steps = overlap((driver.edges, driver.thinned), (driven.edges, driven.thinned), facing)
        left = np.zeros(len(phi1), dtype=bool)
        left[step[steps.beyond]] = True
        parts: list[Overlaps] = []
        if not driven.closed:
            parts.append(self._cut(*self._astray(turn, shift, step, facing.one)))
        if left.any():
            rest = np.flatnonzero(left[step])
            parts.append(self._cut(step[rest], facing.take(rest)))
        some = np.flatnonzero((steps.area > 0.0) & ~left[step])
        graphs = Overlaps(
            step=step[some],
            half=self._named(facing.one[some], facing.two[some]),
            facing=np.ones(len(some), dtype=bool),
            area=steps.area[some],
            length=steps.length[some],
            radius=steps.radius[:, some],
        )
        return _together([graphs, *parts]) if parts else graphs

    def _named(self, one: Ints, two: Ints) -> Ints:
        """Numbers h of halves by their places in arrays."""
        return np.stack([one + self.driver.first, two + self.driven.first])

    def _cut(self, step: Ints, facing: Facing) -> Overlaps:
        """Overlap halves with all others, as polygons."""
        index, owner = self.driver.gather(facing.one)
        points = self.driver.points[index] * facing.turn[owner] + facing.shift[owner]
        sizes = np.bincount(owner)
        # what lies beside the end of an open wheel may reach any root
        if self.driven.closed:
            points, sizes = _within(points, sizes, self.guide.height(points) <= facing.reach[owner])
        polygons = as_polygons(points, sizes)
        one, two = self._tree.query(polygons)
        mates = self.driven.polygons[two]
        # the prepared ones first: twice as fast as the tree's own test
        hit = shapely.intersects(mates, polygons[one])
        shared = shapely.intersection(polygons[one[hit]], mates[hit])
        area = shapely.area(shared)
        some = np.flatnonzero(area > 0.0)
        one, two, shared = one[hit][some], two[hit][some], shared[some]
        bounds = shapely.bounds(shared)
        corners, of = shapely.get_coordinates(shared, return_index=True)
        seen = np.abs(corners @ [1.0, 1.0j] - facing.shift[one][of])
        starts = np.flatnonzero(np.append(True, np.diff(of) > 0)) if len(of) else of
        radius = [f.reduceat(seen, starts) if len(of) else seen for f in (np.minimum, np.maximum)]
        return Overlaps(
            step=step[one],
            half=self._named(facing.one[one], two),
            facing=facing.two[one] == two,
            area=area[some],
            length=np.hypot(bounds[:, 2] - bounds[:, 0], bounds[:, 3] - bounds[:, 1]),
            radius=np.stack(radius),
        )

    def face(self, phi1: Array, one: Ints, two: Ints) -> NDArray[np.bool_]:
        """Return whether halves face each other.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Phases.
        one, two : (n,) int arrays
            Halves h of driver and driven wheel, counted within the first turns.

        Returns
        -------
        (n,) bool array
        """
        mate = self.driven.index(self._unroll(self._halves_past(phi1), one))
        return (mate >= 0) & (mate + self.driven.first == two)

    def _halves_past(self, phi1: Array) -> Array:
        """How many halves have passed the pitch point."""
        return 2.0 * (self.rolling.arc_length(phi1) - self.moved) / self.driver.pitch

    def _unroll(self, at: Array, half: Ints) -> Ints:
        """Count halves of the driver, known within the first turn, over all turns."""
        if not self.driver.closed:
            return half
        turns = np.rint((at - 0.5 - half) / self.driver.count).astype(np.int64)
        return half + turns * self.driver.count

    def gaps(self, side: int, phi1: Array, advance: float, lead: Array | float = 0.0) -> Array:
        """Return the least distance of facing halves of a side at phases.

        Parameters
        ----------
        side : {-1, +1}
            sigma of the driver's flanks.
        phi1, advance, lead
            See `pose`.

        Returns
        -------
        (n,) array, mm
            0 where they overlap; infinite where none face each other.
        """
        turn, shift = self.pose(phi1, advance, lead)
        s, pitch = self.rolling.arc_length(phi1), self.driver.pitch
        pair = np.rint(s / pitch - 0.25 * side).astype(np.int64)
        least = np.full(len(phi1), np.inf)
        for j in (pair - 1, pair, pair + 1):
            half = 2 * j - (side < 0)
            one, two = self.driver.index(half), self.driven.index(half)
            there = np.flatnonzero((one >= 0) & (two >= 0))
            index, owner = self.driver.gather(one[there])
            points = self.driver.points[index] * turn[there][owner] + shift[there][owner]
            polygons = as_polygons(points, np.bincount(owner))
            distance = shapely.distance(polygons, self.driven.polygons[two[there]])
            least[there] = np.minimum(least[there], distance)
        return least

    def _near(self, phi1: Array, turn: Plane, shift: Plane) -> tuple[Ints, Facing]:
        """Phases, and the driver's halves within the driven wheel's tips with their mates."""
        center, radius = self._groups
        far = self.guide.height(center * turn[:, None] + shift[:, None])
        step, group = np.nonzero(far <= radius + self._reach.max())
        step = np.repeat(step, _GROUP)
        half = (group[:, None] * _GROUP + np.arange(_GROUP)).ravel()
        real = half < self.driver.count
        step, half = step[real], half[real]
        past = self._halves_past(phi1)[step]
        mate = self.driven.index(self._unroll(past, half + self.driver.first))
        tips = self.driver.tips[half] * turn[step] + shift[step]
        near = (self.guide.height(tips) <= self._reach[mate] + self._land[half]) & (mate >= 0)
        step, half, mate = step[near], half[near], mate[near]
        return step, Facing(
            one=half,
            two=mate,
            turn=turn[step],
            shift=shift[step],
            guide=self.guide,
            reach=self._reach[mate],
        )

    def _astray(self, turn: Plane, shift: Plane, step: Ints, facing: Ints) -> tuple[Ints, Facing]:
        """Find what else of the driver comes near an open wheel or a rack, without mates.

        `facing` are the halves that face theirs at each `step`. A body is the last of all.
        """
        driver = self.driver
        others = np.full((len(turn), driver.count), True)
        others[step, facing] = False
        step, half = np.nonzero(others)
        center, radius = driver.circles
        seen = center[half] * turn[step] + shift[step]
        points = shapely.points(seen.real, seen.imag)
        near = np.unique(self._tree.query(points, predicate="dwithin", distance=radius[half])[0])
        step, half = step[near], half[near]
        if not driver.closed:
            bodies = self._touched_bodies(turn, shift)
            step = np.append(step, bodies)
            half = np.append(half, np.full(len(bodies), driver.count))
        return step, Facing(
            one=half,
            two=np.full(len(half), -1),
            turn=turn[step],
            shift=shift[step],
            guide=self.guide,
            reach=np.full(len(half), np.inf),
        )

    def _touched_bodies(self, turn: Plane, shift: Plane) -> Ints:
        """Phases at which the driver's body may touch the driven wheel."""
        body, last = self.driver.polygons[-1], self.driver.starts[-2:]
        center, radius = self.driven.circles
        seen = (center - shift[:, None]) * np.conj(turn)[:, None]
        centers: Any = shapely.points(seen.real, seen.imag)
        near = shapely.dwithin(body, centers, cast("Any", radius)).any(axis=1)
        points = self.driver.points[last[0] : last[1]] * turn[:, None] + shift[:, None]
        bodies = as_polygons(points.ravel(), np.full(len(turn), points.shape[1]))
        return np.flatnonzero(near | shapely.intersects(self.driven.polygons[-1], bodies))


def _within(points: Plane, sizes: Ints, inside: NDArray[np.bool_]) -> tuple[Plane, Ints]:
    """Leave out what the mate cannot reach: roots beyond the first vertex that is not `inside`.

    The tip and the point below it always stay: what is left is the rest of the same half.
    """
    keep = inside.copy()
    keep[1:] |= inside[:-1]
    keep[:-1] |= inside[1:]
    ends = np.cumsum(sizes)
    keep[ends - 2] = keep[ends - 3]
    for kept in (ends - 1, ends - sizes, ends - sizes + 1):
        keep[kept] = True
    return points[keep], np.add.reduceat(keep.astype(np.int64), ends - sizes)


def _together(parts: list[Overlaps]) -> Overlaps:
    """Return the pieces of all parts in the order of their steps."""
    order = np.argsort(np.concatenate([part.step for part in parts]), kind="stable")
    every = {
        field.name: np.concatenate([getattr(part, field.name) for part in parts], axis=-1)
        for field in fields(Overlaps)
    }
    return Overlaps(**{name: values[..., order] for name, values in every.items()})
