"""Stepwise overlap: the outlines of the pair, turned phase by phase and intersected.

This is the source texts' study of the contact patch (003, section 2.3.3.1), and a proof from the
outlines alone. The wheels are cut into `half_teeth`, and the driver's are turned into the driven
wheel's frame. Half-tooth h of the driver faces half-tooth h of the driven wheel and can touch the
two beside it: so all overlap of the wheels is found, and each piece belongs to a pair of
half-teeth. That includes collisions of an open wheel or a rack far from the pitch point: with the
other end, or with the body below the teeth.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, cast

import numpy as np
import shapely

from gearcam.gears.rolling import Rolling
from gearcam.meshing.half_teeth import HalfTeeth, as_polygons
from gearcam.numeric.arrays import Array, Ints, Mask, as_complex
from gearcam.numeric.pose import Pose


@dataclass(frozen=True, eq=False, kw_only=True)
class Overlaps:
    """Pieces of overlap, one entry each.

    Parameters
    ----------
    step : (n,) int array
        Number of the phase.
    half : (2, n) int array
        Half-teeth h of driver and driven wheel that overlap, in the first turn; the number after
        the last one is the body of an open wheel.
    facing : (n,) bool array
        Whether these half-teeth face each other, so that their flanks form a pair.
    area : (n,) array, mm^2
        Area.
    length : (n,) array, mm
        Diagonal of its bounding box: the length of a thin patch.
    radius : (2, n) array, mm
        Smallest and largest distance of its vertices from the driver's shaft.
    """

    step: Ints
    half: Ints
    facing: Mask
    area: Array
    length: Array
    radius: Array

    @property
    def depth(self) -> Array:
        """Depth, mm, of a patch of this area and length, taken as a parabolic segment."""
        return 1.5 * self.area / self.length


@dataclass(frozen=True, eq=False, kw_only=True)
class Turning:
    """Outlines of two mounted wheels, to be turned against each other.

    Parameters
    ----------
    rolling : Rolling
        The centrodes.
    driver, driven : HalfTeeth
        The wheels.
    distance : complex, mm
        Mounted distance (see `FlankPairs`).
    moved : float, mm
        Offset of the teeth along the centrodes, for a step of stepped wheels.
    """

    rolling: Rolling
    driver: HalfTeeth
    driven: HalfTeeth
    distance: complex
    moved: float = 0.0

    @cached_property
    def _tree(self) -> Any:
        return shapely.STRtree(self.driven.polygons)

    @cached_property
    def _teeth(self) -> Any:
        """Search tree of the half-teeth, without the body, which has very many vertices."""
        return shapely.STRtree(self.driven.polygons[: self.driven.count])

    @cached_property
    def _height(self) -> float:
        """Largest height of the driven wheel, mm."""
        return float(self.rolling.guide.height(self.driven.points).max())

    def pose(self, phi1: Array, overclosure: float, lead: Array | float = 0.0) -> Pose:
        """Return the poses of the driver in the driven wheel's frame.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Phases.
        overclosure : float, rad
            Angle by which the driver is ahead of them.
        lead : (n,) array or float, rad, for a rack mm
            Angle by which the driven wheel is ahead of them.
        """
        guide = self.rolling.guide
        driven = guide.pose(guide.nominal(phi1) + lead)
        return driven.inverse @ Pose(-(phi1 + overclosure), -self.distance)

    def overlaps(self, phi1: Array, overclosure: float, lead: Array | float = 0.0) -> Overlaps:
        """Return all pieces of overlap at phases (see `pose`)."""
        pose = self.pose(phi1, overclosure, lead)
        step, driving = self._candidates(pose)
        polygons = self.driver.placed(driving, pose[step])
        own, mate = self._tree.query(polygons)
        mates = self.driven.polygons[mate]
        # prepared polygons first: twice as fast as the tree's own test
        hit = shapely.intersects(mates, polygons[own])
        shared = shapely.intersection(polygons[own[hit]], mates[hit])
        area = shapely.area(shared)
        some = np.flatnonzero(area > 0.0)
        own, mate, shared = own[hit][some], mate[hit][some], shared[some]
        half = np.stack([driving[own] + self.driver.first, mate + self.driven.first])
        bounds = shapely.bounds(shared)
        corners, of = shapely.get_coordinates(shared, return_index=True)
        seen = np.abs(as_complex(corners) - pose.shift[step[own]][of])
        starts = np.searchsorted(of, np.arange(len(shared)))
        return Overlaps(
            step=step[own],
            half=half,
            facing=self.face(phi1[step[own]], *half),
            area=area[some],
            length=np.hypot(bounds[:, 2] - bounds[:, 0], bounds[:, 3] - bounds[:, 1]),
            radius=np.stack([end.reduceat(seen, starts) for end in (np.minimum, np.maximum)]),
        )

    def face(self, phi1: Array, one: Ints, two: Ints) -> Mask:
        """Return whether half-teeth face each other.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Phases.
        one, two : (n,) int arrays
            Half-teeth h of driver and driven wheel, in the first turn.

        Returns
        -------
        (n,) bool array
        """
        driver, at = self.driver, self.rolling.tracks[0].arc_length(phi1) - self.moved
        count = one
        if driver.closed:  # moved by whole turns to the one nearest to the pitch point
            past = 2.0 * at / driver.pitch
            count = one + driver.count * np.rint((past - 0.5 - one) / driver.count).astype(np.int64)
        mate = self.driven.index(count)
        real = (mate >= 0) & (one < driver.first + driver.count)
        return real & (mate + self.driven.first == two)

    def flank_distance(
        self, side: int, phi1: Array, overclosure: float, lead: Array | float = 0.0
    ) -> Array:
        """Return the least distance between facing half-teeth of a side at phases.

        Parameters
        ----------
        side : {-1, +1}
            sigma of the driver's flanks.
        phi1, overclosure, lead
            See `pose`.

        Returns
        -------
        (n,) array, mm
            0 where they overlap; infinite where none face each other.
        """
        pose = self.pose(phi1, overclosure, lead)
        s, pitch = self.rolling.tracks[0].arc_length(phi1), self.driver.pitch
        pair = np.rint(s / pitch - 0.25 * side).astype(np.int64)
        least = np.full(len(phi1), np.inf)
        for j in (pair - 1, pair, pair + 1):
            half = 2 * j - (side < 0)
            one, two = self.driver.index(half), self.driven.index(half)
            there = np.flatnonzero((one >= 0) & (two >= 0))
            polygons = self.driver.placed(one[there], pose[there])
            distance = shapely.distance(polygons, self.driven.polygons[two[there]])
            least[there] = np.minimum(least[there], distance)
        return least

    def near(self, pose: Pose, margin: float) -> tuple[Ints, Ints, Ints]:
        """Return the pieces of both wheels that are close to each other.

        Parameters
        ----------
        pose : Pose
            The n poses of the driver in the driven wheel's frame.
        margin : float, mm
            Largest distance.

        Returns
        -------
        step, one, two : (k,) int arrays
            Number of the pose, and indices of half-teeth of driver and driven wheel; the body of an
            open wheel has the last number.
        """
        step, one = self._candidates(pose, margin)
        polygons = self.driver.placed(one, pose[step])
        own, mate = self._tree.query(polygons, predicate="dwithin", distance=margin)
        return step[own], one[own], mate

    def _candidates(self, pose: Pose, margin: float = 0.0) -> tuple[Ints, Ints]:
        """Phases and half-teeth of the driver that may be within a margin of the driven wheel.

        The driver's body has the last number.
        """
        center, radius = self.driver.circles
        radius = radius + margin
        seen = pose[:, None].apply(center)
        step, half = np.nonzero(self.rolling.guide.height(seen) - radius <= self._height)
        seen = seen[step, half]
        points: Any = shapely.points(seen.real, seen.imag)
        near = np.zeros(len(step), dtype=bool)
        near[self._teeth.query(points, predicate="dwithin", distance=radius[half])[0]] = True
        for body in self.driven.polygons[self.driven.count :]:
            near |= shapely.dwithin(body, points, cast("Any", radius[half]))
        step, half = step[near], half[near]
        if not self.driver.closed:
            bodies = self._touched_bodies(pose)
            step = np.append(step, bodies)
            half = np.append(half, np.full(len(bodies), self.driver.count))
            order = np.argsort(step, kind="stable")
            step, half = step[order], half[order]
        return step, half

    def _touched_bodies(self, pose: Pose) -> Ints:
        """Phases at which the driver's body may touch the driven wheel."""
        body, last = self.driver.polygons[-1], self.driver.starts[-2:]
        center, radius = self.driven.circles
        seen = pose.inverse[:, None].apply(center)
        centers: Any = shapely.points(seen.real, seen.imag)
        touched = shapely.dwithin(body, centers, cast("Any", radius)).any(axis=1)
        points = pose[:, None].apply(self.driver.points[last[0] : last[1]])
        bodies = as_polygons(points.ravel(), np.full(len(points), points.shape[1]))
        return np.flatnonzero(touched | shapely.intersects(self.driven.polygons[-1], bodies))
