"""Stepwise overlap: the outlines of the pair, turned phase by phase and intersected.

This is the source texts' study of the contact patch (003, section 2.3.3.1), and the proof that
looks at nothing but outlines. Each wheel is divided into *halves* of teeth, from the middle of a
tip to the middle of a root and a little below; h counts them from tooth 1's +s half as 0, wheel 2
from the half that faces it. Half h of the driver faces half h of the driven wheel, and can reach
the two beside it: so all overlap of the wheels is looked at, and each piece of it belongs to a
pair of halves. Driver's halves are turned into the driven wheel's frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from gearcam.gears.flank import Kind
from gearcam.gears.outline import Outline
from gearcam.gears.rolling import Plane, Rolling
from gearcam.meshing.contact import Ints

Array = NDArray[np.float64]

_BELOW = 0.5
"""Depth of the halves below the root, in dedendums: more than any overlap that is worth a name."""

_BESIDE = 4
"""Halves on both sides of the facing one whose tips are taken for the driven wheel's reach."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Halves:
    """The halves of a wheel's teeth.

    Parameters
    ----------
    points : complex array, mm
        Vertices of all halves in the wheel's frame, one half after another: each from the middle
        of the tip to the middle of the root, below that, and below the tip.
    starts : (2z + 1,) int array
        Where each half begins, and the end.
    chord_error : float, mm
        Largest distance of the curve from its chords.
    """

    points: Plane
    starts: Ints
    chord_error: float

    @property
    def count(self) -> int:
        """Number of halves, 2z."""
        return len(self.starts) - 1

    @cached_property
    def polygons(self) -> Any:
        """The halves as shapely polygons, prepared, (2z,)."""
        polygons = _polygons(self.points, np.diff(self.starts))
        shapely.prepare(polygons)
        return polygons

    def distance(self, points: Plane) -> Array:
        """Return the distances of points from the halves, mm; 0 inside."""
        union = shapely.MultiPolygon(self.polygons.tolist())
        return np.asarray(shapely.distance(union, shapely.points(points.real, points.imag)))

    @cached_property
    def outmost(self) -> Array:
        """Largest distance of each half from the axis, mm, (2z,)."""
        return np.asarray(np.maximum.reduceat(np.abs(self.points), self.starts[:-1]))

    def gather(self, halves: Ints) -> tuple[Ints, Ints]:
        """Return the indices into `points` of some `halves`, and which of these each belongs to."""
        sizes = self.starts[halves + 1] - self.starts[halves]
        owner = np.repeat(np.arange(len(halves)), sizes)
        first = np.cumsum(sizes) - sizes
        return np.arange(len(owner)) - first[owner] + self.starts[halves][owner], owner


def halve(outline: Outline) -> Halves:
    """Divide a wheel into the halves of its teeth.

    Parameters
    ----------
    outline : Outline
        The wheel at the tolerance of the study.

    Returns
    -------
    Halves
        In the order of rising s from the middle of tooth 1 (wheel 1) or from the middle of the
        space before tooth 1 (wheel 2).
    """
    toothing, size = outline.toothing, len(outline.points)
    roots, tips = _middles(outline)
    depth = -(1.0 + _BELOW) * toothing.cutter.dedendum
    angles = toothing.rolling.angle(toothing.tooth_places)
    gaps = toothing.rolling.angle(toothing.tooth_places + 0.5 * toothing.pitch)
    deep, low = (_below(outline, v, depth) for v in (angles, gaps))
    points = outline.sampler.chords[1]
    halves: list[Plane] = []
    for tooth, (root, tip) in enumerate(zip(roots, tips, strict=True)):
        before = tips[tooth - 1] - (0 if tooth else size)
        front, back = np.arange(before, root + 1) % size, np.arange(root, tip + 1) % size
        following = (tooth + 1) % toothing.teeth
        halves.append(np.concatenate([points[front], [low[tooth], deep[tooth]]]))
        halves.append(np.concatenate([points[back[::-1]], [low[tooth], deep[following]]]))
    if toothing.wheel == 2:
        halves = halves[-1:] + halves[:-1]
    starts = np.concatenate([[0], np.cumsum([len(half) for half in halves])])
    return Halves(
        points=np.concatenate(halves), starts=starts, chord_error=outline.sampler.chords[2]
    )


def _middles(outline: Outline) -> tuple[Ints, Ints]:
    """Vertices in the middle of each space and, following it, of the next tip.

    A space begins with the + flank of its tooth and ends with the - flank of the next one.
    """
    rows, z = outline.rows, outline.toothing.teeth
    row = outline.sampler.row_of(outline.sampler.chords[0][:-1])
    flank = np.flatnonzero(rows.kind == Kind.FLANK)
    space = np.where(rows.sigma[flank] > 0.0, rows.tooth[flank], rows.tooth[flank] - 1) % z
    ends = np.zeros((2, 2, z), dtype=np.int64)
    for side, mine in enumerate((rows.sigma[flank] > 0.0, rows.sigma[flank] < 0.0)):
        first, last = np.full(z, len(rows.kind)), np.full(z, -1)
        np.minimum.at(first, space[mine], flank[mine])
        np.maximum.at(last, space[mine], flank[mine])
        ends[side] = np.searchsorted(row, first), np.searchsorted(row, last + 1)
    # space 1 follows tooth 1 and comes first; space z, counted as 0, comes last
    (front, front_end), (back, back_end) = np.roll(ends, -1, axis=2)
    roots = (front_end + back) // 2
    tips = (back_end + np.append(front[1:], len(row))) // 2
    return roots, tips


def _below(outline: Outline, angle: Array, height: float) -> Plane:
    frames = outline.toothing.frames(angle, curved=False)
    return frames.p + height * outline.toothing.turn * frames.t


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
    """

    rolling: Rolling
    driver: Halves
    driven: Halves
    distance: float

    @cached_property
    def _tree(self) -> Any:
        return shapely.STRtree(self.driven.polygons)

    @cached_property
    def _tops(self) -> Plane:
        """Outmost point of each half of the driver, as its whole half is seen from far."""
        outmost = self.driver.outmost
        index, owner = self.driver.gather(np.arange(self.driver.count))
        best = np.flatnonzero(np.abs(self.driver.points[index]) == outmost[owner])
        _, first = np.unique(owner[best], return_index=True)
        return self.driver.points[index[best[first]]]

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
        step, half, reach = self._near(phi1, turn, shift)
        index, owner = self.driver.gather(half)
        points = self.driver.points[index] * turn[step][owner] + shift[step][owner]
        polygons = _polygons(*_within(points, np.bincount(owner), reach[owner]))
        one, two = self._tree.query(polygons)
        mates = self.driven.polygons[two]
        # the prepared ones first: twice as fast as the tree's own test
        hit = shapely.intersects(mates, polygons[one])
        one, two = one[hit], two[hit]
        shared = shapely.intersection(polygons[one], mates[hit])
        area = shapely.area(shared)
        some = np.flatnonzero(area > 0.0)
        bounds = shapely.bounds(shared[some])
        corners, of = shapely.get_coordinates(shared[some], return_index=True)
        step = step[one[some]]
        seen = np.abs(corners @ [1.0, 1.0j] - shift[step][of])
        starts = np.flatnonzero(np.append(True, np.diff(of) > 0)) if len(of) else of
        radius = [f.reduceat(seen, starts) if len(of) else seen for f in (np.minimum, np.maximum)]
        return Overlaps(
            step=step,
            half=np.stack([half[one[some]], two[some]]),
            facing=self.face(phi1[step], half[one[some]], two[some]),
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
        return (self._unroll(phi1, one) - two) % self.driven.count == 0

    def _unroll(self, phi1: Array, half: Ints) -> Ints:
        """Count halves of the driver, known within the first turn, over all turns."""
        at = 2.0 * self.rolling.arc_length(phi1) / self._pitch
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
            polygons = _polygons(points, np.bincount(owner))
            mates = self.driven.polygons[half % self.driven.count]
            distance = shapely.distance(polygons, mates)
            least = np.minimum(least, distance)
        return least

    def _near(self, phi1: Array, turn: Plane, shift: Plane) -> tuple[Ints, Ints, Array]:
        """Phases and driver's halves that come within the driven wheel's tips, and their radius."""
        half = np.arange(self.driver.count)
        facing = self._unroll(phi1[:, None], half) % self.driven.count
        distance = np.abs(self._tops * turn[:, None] + shift[:, None])
        reach = self._reach[facing]
        step, near = np.nonzero(distance <= reach)
        return step, near, reach[step, near]


def _within(points: Plane, sizes: Ints, reach: Array) -> tuple[Plane, Ints]:
    """Leave out what the mate cannot reach: roots beyond the first vertex outside.

    The point below the tip always stays, so that what is left is the rest of the same half.
    """
    inside = points.real**2 + points.imag**2 <= reach * reach
    keep = inside.copy()
    keep[1:] |= inside[:-1]
    keep[:-1] |= inside[1:]
    ends = np.cumsum(sizes)
    keep[ends - 2] = keep[ends - 3]
    keep[ends - 1] = True
    return points[keep], np.add.reduceat(keep.astype(np.int64), ends - sizes)


def _polygons(points: Plane, sizes: Ints) -> Any:
    coordinates = np.stack([points.real, points.imag], axis=1)
    owner = np.repeat(np.arange(len(sizes)), sizes)
    return shapely.polygons(shapely.linearrings(coordinates, indices=owner))
