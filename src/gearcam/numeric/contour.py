"""Closed contours made of smooth runs, with their polygon.

A *run* is a smooth piece of a true curve between two corners, sampled densely with its tangents. A
*contour* is the closed chain of runs, with its adaptive polygon: vertices on the true curve, no
chord farther from it than the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array
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
    points : (n, 2) array, mm
        Points on the true curve, dense: chord error at most 1/32 of the contour's tolerance.
    tangents : (n, 2) array
        Unit tangents, forward along the contour.
    joints : tuple of int
        Indices of inner points at which two curves join smoothly.
    """

    points: Array
    tangents: Array
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
    vertices : (k, 2) array, mm
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
    vertices: Array
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
        turned = Pose(pose.turn)
        return replace(
            own,
            dense=lambda: tuple(
                replace(run, points=_move(run.points, pose), tangents=_move(run.tangents, turned))
                for run in own.runs
            ),
            vertices=_move(own.vertices, pose),
            source=own,
            pose=pose,
        )

    def moved(self, points: Array) -> Array:
        """Return points (n, 2) of its own frame in their places."""
        return points if self.source is None else _move(points, self.pose)

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
        return polygon_area(self.vertices)

    @cached_property
    def moments(self) -> Moments:
        """Moments of the region inside the true curve, from the dense runs."""
        # steps between runs have no length
        return curve_moments(
            np.vstack([run.points for run in self.runs]),
            np.vstack([run.tangents for run in self.runs]),
        )

    @property
    def length(self) -> float:
        """Length of the polygon's boundary, mm."""
        return float(np.hypot(*np.diff(self.vertices, axis=0, append=self.vertices[:1]).T).sum())

    @property
    def reach(self) -> float:
        """Largest distance of a vertex from the origin, mm."""
        return float(np.hypot(*self.vertices.T).max())

    def points(self, _: float) -> Array:
        """Return the polygon's vertices, within the contour's own tolerance."""
        return self.vertices

    @cached_property
    def polygon(self) -> Polygon:
        """The polygon as a shapely region."""
        from shapely import Polygon

        return Polygon(self.vertices)


def _move(points: Array, pose: Pose) -> Array:
    values = np.ascontiguousarray(points, dtype=np.float64).view(np.complex128)
    return pose.apply(values).view(np.float64)


def polygon_area(vertices: Array) -> float:
    """Return the signed area of a polygon, counter-clockwise positive.

    Parameters
    ----------
    vertices : (n, 2) array, mm
        First point not repeated.

    Returns
    -------
    float, mm^2
        From the shoelace formula about the first vertex.
    """
    x, y = (vertices - vertices[0]).T
    return 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
