"""Stepwise overlap of solids: the half-teeth of both wheels as prisms, also on tilted axes.

At each phase the driver's prisms are placed as in the plane study, then tilted with its axis about
the middle of the face width, and intersected with the driven wheel's. On parallel axes the overlap
is that of the outlines times the width. On tilted axes the wheels touch first at a face, and the
patch lies at that end of the teeth: `gearcam.meshing.errors` takes up the backlash there.

A wheel's hub, bore and rim never reach its mate; so the half-teeth, and for an open wheel its body,
stand for the wheel whatever its other shape. What intersects prisms is given: this module knows no
library of solids.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import shapely

from gearcam.meshing.half_teeth import HalfTeeth
from gearcam.meshing.overlap import Turning
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.contour import polygon_area

_ALONG = 20.0
"""Points along a patch in a picture."""


class PrismPair(Protocol):
    """Prisms of two wheels, in the wheels' frames."""

    def overlap(self, one: int, two: int, motion: Array) -> tuple[float, Array]:
        """Return the overlap of a prism of wheel 1, moved by a (3, 4) matrix, with one of wheel 2.

        Returns
        -------
        volume : float, mm^3
        vertices : (n, 3) array, mm
            In the frame of wheel 2; none without overlap.
        """
        ...


class PrismMaker(Protocol):
    """Makes prisms of outlines, counter-clockwise, from one height to another, mm."""

    def __call__(
        self, first: Sequence[Plane], second: Sequence[Plane], low: float, high: float
    ) -> PrismPair:
        """Return the prisms."""
        ...


@dataclass(frozen=True, eq=False, kw_only=True)
class SolidOverlaps:
    """Overlaps of prisms, one entry each.

    Parameters
    ----------
    step : (n,) int array
        Number of the phase.
    half : (2, n) int array
        Half-teeth h of driver and driven wheel (see `Overlaps`).
    volume : (n,) array, mm^3
        Volume.
    start : (n + 1,) int array
        Index of the first vertex of each, and the end.
    height, radius : (m,) arrays, mm
        Of the vertices: over the middle of the face width, and from the driver's axis.
    """

    step: Ints
    half: Ints
    volume: Array
    start: Ints
    height: Array
    radius: Array

    def outline(self, number: int) -> Array:
        """Return points on the convex outline of a patch: heights and radii, (2, n), mm."""
        own = slice(self.start[number], self.start[number + 1])
        points = np.stack([self.height[own], self.radius[own]], axis=1)
        spacing = float(np.ptp(self.height[own])) / _ALONG
        hull = shapely.segmentize(shapely.MultiPoint(points).convex_hull, spacing)
        return shapely.get_coordinates(hull).T

    @property
    def extents(self) -> tuple[Array, Array]:
        """Least and largest height of each, (n,), mm."""
        if not len(self.volume):
            return np.empty(0), np.empty(0)
        low, high = (end.reduceat(self.height, self.start[:-1]) for end in (np.minimum, np.maximum))
        return low, high


@dataclass(frozen=True, eq=False, kw_only=True)
class Bodies:
    """The prisms of two mounted wheels.

    Parameters
    ----------
    turning : Turning
        The outlines, mounted as in the middle of the face width.
    prisms : PrismPair
        The prisms, heights over the middle of the face width.
    tilt : complex, rad
        Of the driver's axis, in the plane of the axes and across it: the driven shaft is that much
        further along x and y for each mm of height.
    reach : float, mm
        Largest height of the prisms over or below the middle of the face width.
    """

    turning: Turning
    prisms: PrismPair
    tilt: complex
    reach: float

    def overlaps(self, phi1: Array, overclosure: float, lead: Array | float) -> SolidOverlaps:
        """Return all overlaps at phases (see `Turning.pose`)."""
        turning = self.turning
        pose = turning.pose(phi1, overclosure, lead)
        motion = self.motions(phi1, overclosure, lead)
        step, one, two = turning.near(pose, abs(self.tilt) * self.reach)
        shared: list[tuple[int, float, Array]] = []
        for k, (at, first, second) in enumerate(
            zip(step.tolist(), one.tolist(), two.tolist(), strict=True)
        ):
            volume, vertices = self.prisms.overlap(first, second, motion[at])
            if volume > 0.0:
                shared.append((k, volume, vertices))
        rows = np.array([k for k, *_ in shared], dtype=np.int64)
        counts = np.array([len(vertices) for *_, vertices in shared], dtype=np.int64)
        points = np.concatenate([np.empty((0, 3)), *(vertices for *_, vertices in shared)])
        height, radius = self._from_axis(points, np.repeat(step[rows], counts), motion)
        return SolidOverlaps(
            step=step[rows],
            half=np.stack([one[rows] + turning.driver.first, two[rows] + turning.driven.first]),
            volume=np.array([volume for _, volume, _ in shared]),
            start=np.append(0, np.cumsum(counts)),
            height=height,
            radius=radius,
        )

    def motions(self, phi1: Array, overclosure: float, lead: Array | float) -> Array:
        """Return the motions of the driver in the driven wheel's frame.

        Parameters
        ----------
        phi1, overclosure, lead
            See `Turning.pose`.

        Returns
        -------
        (n, 3, 4) array, mm
            Rotations and shifts.
        """
        turning = self.turning
        pose = turning.pose(phi1, overclosure, lead)
        # the driver turns on its axis, is tilted with it, and is seen from the driven wheel
        spun = _about_z(-(phi1 + overclosure))
        back = _about_z(pose.turn + phi1 + overclosure)
        turned = back @ tilted(-self.tilt) @ spun
        shift = np.stack([pose.shift.real, pose.shift.imag, np.zeros(len(phi1))], axis=1)
        return np.concatenate([turned, shift[:, :, None]], axis=2)

    def _from_axis(self, points: Array, step: Ints, motion: Array) -> tuple[Array, Array]:
        """Return heights and distances of points, (n, 3), from the driver's axis."""
        seen = points - motion[step, :, 3]
        own = np.einsum("nji,nj->ni", motion[step, :, :3], seen)
        return own[:, 2], np.hypot(own[:, 0], own[:, 1])


def bodies(turning: Turning, make: PrismMaker, tilt: complex, low: float, high: float) -> Bodies:
    """Return the prisms of two mounted wheels.

    Parameters
    ----------
    turning : Turning
        The outlines.
    make : PrismMaker
        Makes the prisms.
    tilt : complex, rad
        See `Bodies`.
    low, high : float, mm
        Heights over the middle of the face width from which to which the teeth extend.
    """
    first, second = (_outlines(wheel) for wheel in (turning.driver, turning.driven))
    return Bodies(
        turning=turning,
        prisms=make(first, second, low, high),
        tilt=tilt,
        reach=max(abs(low), abs(high)),
    )


def _outlines(wheel: HalfTeeth) -> list[Plane]:
    """Return the outlines of half-teeth, then of the body, counter-clockwise."""
    every = [wheel.points[a:b] for a, b in zip(wheel.starts[:-1], wheel.starts[1:], strict=True)]
    return [one if polygon_area(one) > 0.0 else one[::-1] for one in every]


def _about_z(angle: Array) -> Array:
    """Return rotations about z, (n, 3, 3)."""
    cos, sin, none = np.cos(angle), np.sin(angle), np.zeros(len(angle))
    rows = [[cos, -sin, none], [sin, cos, none], [none, none, none + 1.0]]
    return np.moveaxis(np.array(rows), -1, 0)


def tilted(tilt: complex) -> Array:
    """Return the rotation that tilts the z-axis towards a direction in the plane, (3, 3).

    Parameters
    ----------
    tilt : complex, rad
        The angle, as a vector in the direction in which points above the plane move.
    """
    angle = abs(tilt)
    if angle == 0.0:
        return np.eye(3)
    x, y = tilt.real / angle, tilt.imag / angle
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array(
        [
            [1.0 + (cos - 1.0) * x * x, (cos - 1.0) * x * y, sin * x],
            [(cos - 1.0) * x * y, 1.0 + (cos - 1.0) * y * y, sin * y],
            [-sin * x, -sin * y, cos],
        ]
    )
