"""Closed contours made of smooth runs, with their polygon.

A *run* is a smooth piece of a true curve between two corners, sampled densely with its tangents. A
*contour* is the closed chain of runs, with its adaptive polygon: points on the true curve, no chord
farther from it than the tolerance. Points are complex numbers, in mm.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.numeric.moments import Moments, curve_moments
from gearcam.numeric.pose import UNMOVED, Pose

if TYPE_CHECKING:
    from shapely import Polygon

Fitted = TypeVar("Fitted")


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(ShortRepr):
    """A smooth piece of a curve between two corners.

    Parameters
    ----------
    points : (n,) complex array, mm
        Points on the true curve, dense: chord error at most 1/32 of the contour's tolerance.
    tangents : (n,) complex array
        Unit tangents, forward along the contour.
    joints : tuple of int
        Indices of inner points at which two curves join smoothly.
    """

    points: Plane
    tangents: Plane
    joints: tuple[int, ...] = field(default=())

    @property
    def pieces(self) -> tuple[Run, ...]:
        """The run cut at its joints."""
        cuts = [0, *self.joints, len(self.points) - 1]
        return tuple(
            Run(points=self.points[low : high + 1], tangents=self.tangents[low : high + 1])
            for low, high in pairwise(cuts)
        )

    @property
    def reversed(self) -> Run:
        """The same curve in the opposite sense."""
        last = len(self.points) - 1
        return Run(
            points=self.points[::-1],
            tangents=-self.tangents[::-1],
            joints=tuple(last - joint for joint in reversed(self.joints)),
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Contour(ShortRepr):
    """A closed, counter-clockwise curve.

    Parameters
    ----------
    dense : callable
        Returns the runs in order, each beginning where the one before ends; called only if needed,
        since the polygon does without.
    points : (k,) complex array, mm
        The adaptive polygon, first point not repeated.
    tolerance : float, mm
        The allowed chord error.
    chord_error : float, mm
        The chord error measured against the dense runs.
    source : Contour or None
        The contour in its own frame, if this one is *placed*.
    pose : Pose
        Its pose, if it is placed.
    """

    dense: Callable[[], tuple[Run, ...]]
    points: Plane
    tolerance: float
    chord_error: float
    source: Contour | None = None
    pose: Pose = UNMOVED

    @property
    def own(self) -> Contour:
        """The contour in its own frame."""
        return self.source or self

    def placed(self, pose: Pose) -> Contour:
        """Return the contour in its place."""
        own, pose = self.own, pose @ self.pose
        return replace(
            own,
            dense=lambda: tuple(
                replace(run, points=pose.apply(run.points), tangents=run.tangents * pose.rotation)
                for run in own.runs
            ),
            points=pose.apply(own.points),
            source=own,
            pose=pose,
        )

    def fitted(self, fit: Callable[[Sequence[Run], float], Fitted], tolerance: float) -> Fitted:
        """Return `fit` of the runs in their own frame to a `tolerance`, cached."""
        made, key = self.own._fits, (fit, tolerance)
        if key not in made:
            made[key] = fit(self.own.runs, tolerance)
        return made[key]

    @cached_property
    def _fits(self) -> dict[Any, Any]:
        return {}

    @cached_property
    def runs(self) -> tuple[Run, ...]:
        """The dense runs, in order."""
        return self.dense()

    @cached_property
    def area(self) -> float:
        """Area of the polygon, mm^2."""
        return polygon_area(self.points)

    @cached_property
    def moments(self) -> Moments:
        """Moments of the region inside the true curve, from the dense runs."""
        # steps between runs have no length
        return curve_moments(
            np.concatenate([run.points for run in self.runs]),
            np.concatenate([run.tangents for run in self.runs]),
        )

    @property
    def length(self) -> float:
        """Length of the polygon's boundary, mm."""
        return float(np.abs(np.diff(self.points, append=self.points[:1])).sum())

    @property
    def reach(self) -> float:
        """Largest distance of a vertex from the origin, mm."""
        return float(np.abs(self.points).max())

    @property
    def vertices(self) -> Array:
        """The points of the polygon as pairs, (k, 2), mm."""
        return as_pairs(self.points)

    def polyline(self, _: float) -> Plane:
        """Return the polygon's points, (k,), complex, mm, within the contour's own tolerance."""
        return self.points

    @cached_property
    def polygon(self) -> Polygon:
        """The polygon as a shapely region."""
        from shapely import Polygon

        return Polygon(self.vertices)


def polygon_area(points: Plane) -> float:
    """Return the signed area of a polygon, counter-clockwise positive.

    Parameters
    ----------
    points : (n,) complex array, mm
        First point not repeated.

    Returns
    -------
    float, mm^2
        From the shoelace formula about the first vertex.
    """
    spokes = points - points[0]
    x, y = spokes.real, spokes.imag
    return 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
