"""Stepwise overlap: the outlines of the pair, turned phase by phase and intersected.

This is the source texts' study of the contact patch (003, section 2.3.3.1), and the proof that
looks at nothing but outlines. The wheels are taken in `halves` of teeth, the driver's turned into
the driven wheel's frame. Half h of the driver faces half h of the driven wheel, and can reach the
two beside it: so all overlap of the wheels is looked at, and each piece of it belongs to a pair of
halves. Facing halves are overlapped as graphs (`staircase`); a phase in which a half may touch
another than its mate, or stands across it, is cut as polygons.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from gearcam.gears.contact import Ints
from gearcam.gears.rolling import Plane, Rolling
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
        Halves of driver and driven wheel that overlap, counted within the first turn.
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
        Distance of the shafts as mounted.
    moved : float, mm
        How far the teeth are moved on along the centrodes: a step of stepped wheels.
    """

    rolling: Rolling
    driver: Halves
    driven: Halves
    distance: float
    moved: float = 0.0

    @cached_property
    def _tree(self) -> Any:
        return shapely.STRtree(self.driven.polygons)

    @cached_property
    def _land(self) -> Array:
        """Largest distance of a tip's corners from its middle, for each half of the driver."""
        width, half = self.driver.width, np.arange(self.driver.count)
        other = (half + np.where(half % 2 == 0, -1, 1)) % len(half)
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
        """Largest radius of the driven wheel near the half that faces each of the driver's."""
        near = np.arange(-_BESIDE, _BESIDE + 1)
        return self.driven.outmost[
            (np.arange(self.driven.count)[:, None] + near) % self.driven.count
        ].max(axis=1)

    def pose(self, phi1: Array, advance: float, lead: Array | float = 0.0) -> tuple[Plane, Plane]:
        """Return the turn and shift that take the driver's points into the driven wheel's frame.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Phases.
        advance : float, rad
            How far the driver is ahead of them.
        lead : (n,) array or float, rad
            How far the driven wheel is.

        Returns
        -------
        turn, shift : (n,) complex arrays, 1 and mm
        """
        back = np.exp(-1j * (self.rolling.law.phi2(phi1) + lead))
        return np.exp(-1j * (phi1 + advance)) * back, back * complex(-self.distance)

    def overlaps(self, phi1: Array, advance: float, lead: Array | float = 0.0) -> Overlaps:
        """Return all pieces of overlap at phases (see `pose`)."""
        turn, shift = self.pose(phi1, advance, lead)
        step, half, mate, reach = self._near(phi1, turn, shift)
        facing = Facing(one=half, two=mate, turn=turn[step], shift=shift[step], reach=reach)
        driver, driven = self.driver, self.driven
        steps = overlap((driver.edges, driver.thinned), (driven.edges, driven.thinned), facing)
        left = np.zeros(len(phi1), dtype=bool)
        left[step[steps.beyond]] = True
        some = np.flatnonzero((steps.area > 0.0) & ~left[step])
        graphs = Overlaps(
            step=step[some],
            half=np.stack([half[some], mate[some]]),
            facing=np.ones(len(some), dtype=bool),
            area=steps.area[some],
            length=steps.length[some],
            radius=steps.radius[:, some],
        )
        if not left.any():
            return graphs
        rest = np.flatnonzero(left[step])
        return _together(graphs, self._cut(step[rest], facing.take(rest)))

    def _cut(self, step: Ints, facing: Facing) -> Overlaps:
        """Overlap halves with all others, as polygons."""
        index, owner = self.driver.gather(facing.one)
        points = self.driver.points[index] * facing.turn[owner] + facing.shift[owner]
        polygons = as_polygons(*_within(points, np.bincount(owner), facing.reach[owner]))
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
            half=np.stack([facing.one[one], two]),
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
            Halves of driver and driven wheel, counted within the first turns.

        Returns
        -------
        (n,) bool array
        """
        return (self._unroll(self._halves_past(phi1), one) - two) % self.driven.count == 0

    def _halves_past(self, phi1: Array) -> Array:
        """How many halves have passed the pitch point."""
        return 2.0 * (self.rolling.arc_length(phi1) - self.moved) / self._pitch

    def _unroll(self, at: Array, half: Ints) -> Ints:
        """Count halves of the driver, known within the first turn, over all turns."""
        turns = np.rint((at - 0.5 - half) / self.driver.count).astype(np.int64)
        return half + turns * self.driver.count

    @property
    def _pitch(self) -> float:
        return self.rolling.length(1) / (self.driver.count // 2)

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
            0 where they overlap.
        """
        turn, shift = self.pose(phi1, advance, lead)
        pair = np.rint(self.rolling.arc_length(phi1) / self._pitch - 0.25 * side).astype(np.int64)
        least = np.full(len(phi1), np.inf)
        for j in (pair - 1, pair, pair + 1):
            half = 2 * j - (side < 0)
            index, owner = self.driver.gather(half % self.driver.count)
            points = self.driver.points[index] * turn[owner] + shift[owner]
            polygons = as_polygons(points, np.bincount(owner))
            mates = self.driven.polygons[half % self.driven.count]
            distance = shapely.distance(polygons, mates)
            least = np.minimum(least, distance)
        return least

    def _near(self, phi1: Array, turn: Plane, shift: Plane) -> tuple[Ints, Ints, Ints, Array]:
        """Phases, driver's halves within the driven wheel's tips, their mates and its radius."""
        center, radius = self._groups
        far = np.abs(center * turn[:, None] + shift[:, None])
        step, group = np.nonzero(far <= radius + self.driven.outmost.max())
        step = np.repeat(step, _GROUP)
        half = (group[:, None] * _GROUP + np.arange(_GROUP)).ravel()
        real = half < self.driver.count
        step, half = step[real], half[real]
        facing = self._unroll(self._halves_past(phi1)[step], half) % self.driven.count
        distance = np.abs(self.driver.tips[half] * turn[step] + shift[step])
        near = distance <= self._reach[facing] + self._land[half]
        step, half, facing = step[near], half[near], facing[near]
        return step, half, facing, self._reach[facing]


def _within(points: Plane, sizes: Ints, reach: Array) -> tuple[Plane, Ints]:
    """Leave out what the mate cannot reach: roots beyond the first vertex outside.

    The tip and the point below it always stay: what is left is the rest of the same half.
    """
    inside = points.real**2 + points.imag**2 <= reach * reach
    keep = inside.copy()
    keep[1:] |= inside[:-1]
    keep[:-1] |= inside[1:]
    ends = np.cumsum(sizes)
    keep[ends - 2] = keep[ends - 3]
    for kept in (ends - 1, ends - sizes, ends - sizes + 1):
        keep[kept] = True
    return points[keep], np.add.reduceat(keep.astype(np.int64), ends - sizes)


def _together(one: Overlaps, two: Overlaps) -> Overlaps:
    """Return the pieces of both in the order of their steps."""
    order = np.argsort(np.concatenate([one.step, two.step]), kind="stable")
    every = {
        field.name: np.concatenate([getattr(one, field.name), getattr(two, field.name)], axis=-1)
        for field in fields(Overlaps)
    }
    return Overlaps(**{name: values[..., order] for name, values in every.items()})
