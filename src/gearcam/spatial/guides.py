"""How a follower moves the axis of its roller, and what the cam makes of it.

A *guide* gives the axis of the roller in the fixed frame for a lift: along the cam (`Straight`),
on an arm about a pivot (`SwingArm`), on a turret (`Turret`). The cam turns by theta meanwhile, so
in its frame the axis is turned by -theta (`carried`).

Frame: the cam's axis is z. The roller of `Straight` and `SwingArm` has its axis parallel to x and
meets the cam at the azimuth 0; lift is along +z.

Depends on envelope, supports and poses; numpy only.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.mechanics.supports import Support
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.pose import SpacePose
from gearcam.spatial.envelope import RollerAxis
from gearcam.spatial.friction import SpaceFrictionSpec
from gearcam.spatial.supports import OverhungGuide, ThrustPivot


class RollerGuide(ABC, ShortRepr):
    """What carries a roller, in a plane: across the cam, y and z, or x and z."""

    angular: ClassVar[bool]
    """Whether its lift is an angle."""

    mirrored: ClassVar[bool]
    """Whether the plane is seen in a mirror where the cam turns clockwise."""

    @staticmethod
    @abstractmethod
    def in_plane(vectors: Array) -> Plane:
        """Return vectors (..., 3) in the plane of the motion, complex."""

    @abstractmethod
    def support(self, friction: SpaceFrictionSpec) -> Support:
        """Return what holds it, with the sizes of a guide (see `gearcam.spatial.supports`)."""

    def mass_point(self, lift: Array, distance: float) -> Plane:  # noqa: ARG002
        """Return the centre of mass in the plane of the motion: on the guide, or on the pivot.

        Parameters
        ----------
        lift : (n,) array, mm or rad
            The lift.
        distance : float, mm
            Of an arm from its pivot, towards the roller.
        """
        return np.zeros(len(lift), dtype=np.complex128)

    @abstractmethod
    def placed(self, lift: Array) -> tuple[Array, Array]:
        """Return the axis of the roller in the fixed frame.

        Parameters
        ----------
        lift : (n,) array, mm or rad
            The lift.

        Returns
        -------
        point, direction : (3, n, 3) arrays
            A point of the axis, mm, and its direction, with two derivatives by the lift.
        """

    @abstractmethod
    def pose(self, lift: Array) -> SpacePose:
        """Return the n poses of the roller in the fixed frame; in its own its axis is +x.

        Parameters
        ----------
        lift : (n,) array, mm or rad
            The lift.
        """


class AcrossGuide(RollerGuide):
    """A guide that keeps the roller's axis parallel to x: it moves in planes across the cam."""

    mirrored = True

    @staticmethod
    def in_plane(vectors: Array) -> Plane:
        """Return y + i*z (see `RollerGuide.in_plane`)."""
        return vectors[..., 1] + 1j * vectors[..., 2]

    @abstractmethod
    def way(self, lift: Array, point: tuple[Array, Array], radius: Array, side: int) -> Array:
        """Return how far the follower goes on until the roller meets points.

        Parameters
        ----------
        lift : (n,) array, mm or rad
            Its lift.
        point : (y, z), (n,) arrays, mm
            The points, in the plane across the roller.
        radius : (n,) array, mm
            Radius of the roller there.
        side : {1, -1}
            Whether it goes upwards, or downwards.

        Returns
        -------
        (n,) array, mm or rad
            Below 0 where it is beyond the point; infinite where it passes beside it.
        """


@dataclass(frozen=True, kw_only=True)
class Straight(AcrossGuide):
    """A follower that moves along the cam.

    Parameters
    ----------
    height : float, mm
        Height of the roller at zero lift.
    """

    height: float

    angular = False

    def support(self, friction: SpaceFrictionSpec) -> Support:
        """Return the guide beside the cam (see `RollerGuide.support`)."""
        return OverhungGuide(
            direction=1j,
            middle=0j,
            distance=friction.guide_distance or 0.0,
            height=friction.guide_at or 0.0,
            length=friction.guide_length or 0.0,
        )

    def placed(self, lift: Array) -> tuple[Array, Array]:
        """Return the axis of the roller (see `RollerGuide.placed`)."""
        point, direction = np.zeros((3, len(lift), 3)), np.zeros((3, len(lift), 3))
        point[0, :, 2], point[1, :, 2] = self.height + lift, 1.0
        direction[0, :, 0] = 1.0
        return point, direction

    def pose(self, lift: Array) -> SpacePose:
        """Return the poses of the roller (see `RollerGuide.pose`)."""
        return SpacePose((1.0, 0.0, 0.0), np.zeros(len(lift)), self.placed(lift)[0][0])

    def way(self, lift: Array, point: tuple[Array, Array], radius: Array, side: int) -> Array:
        """Return how far it goes until the roller meets points (see `AcrossGuide.way`)."""
        y, z = point
        square = radius**2 - y**2
        way = side * (z - self.height - lift) - np.sqrt(np.maximum(square, 0.0))
        return np.where(square < 0.0, math.inf, way)


@dataclass(frozen=True, kw_only=True)
class SwingArm(AcrossGuide):
    """A follower that swings about an axis parallel to that of its roller.

    Parameters
    ----------
    length : float, mm
        From the pivot to the roller.
    distance : float, mm
        The pivot is at y = -`distance`.
    start : float, rad
        Angle of the arm from +y towards +z at zero lift.
    height : float, mm
        Height of the roller at zero lift.
    """

    length: float
    distance: float
    start: float
    height: float

    angular = True

    @property
    def pivot(self) -> float:
        """Height of the pivot, mm."""
        return self.height - self.length * math.sin(self.start)

    def support(self, friction: SpaceFrictionSpec) -> Support:  # noqa: ARG002
        """Return the pivot, whose place along the roller is not known (see `RollerGuide`)."""
        return ThrustPivot(at=self._pivot, spin=1.0, along=0, central=False)

    @property
    def _pivot(self) -> complex:
        return complex(-self.distance, self.pivot)

    def mass_point(self, lift: Array, distance: float) -> Plane:
        """Return a point of the arm (see `RollerGuide.mass_point`)."""
        arm: Plane = np.exp(1j * (self.start + lift))
        return self._pivot + distance * arm

    def placed(self, lift: Array) -> tuple[Array, Array]:
        """Return the axis of the roller (see `RollerGuide.placed`)."""
        point, direction = np.zeros((3, len(lift), 3)), np.zeros((3, len(lift), 3))
        y, z = self.length * np.cos(self.start + lift), self.length * np.sin(self.start + lift)
        point[0, :, 1], point[0, :, 2] = y - self.distance, z + self.pivot
        point[1, :, 1], point[1, :, 2] = -z, y
        point[2, :, 1], point[2, :, 2] = -y, -z
        direction[0, :, 0] = 1.0
        return point, direction

    def pose(self, lift: Array) -> SpacePose:
        """Return the poses of the roller (see `RollerGuide.pose`)."""
        return SpacePose((1.0, 0.0, 0.0), self.start + lift, self.placed(lift)[0][0])

    def way(self, lift: Array, point: tuple[Array, Array], radius: Array, side: int) -> Array:
        """Return how far it goes until the roller meets points (see `AcrossGuide.way`).

        Pivot, axis of the roller and point are a triangle with known sides.
        """
        y, z = point[0] + self.distance, point[1] - self.pivot
        far = np.hypot(y, z)
        cosine = (self.length**2 + far**2 - radius**2) / (2.0 * self.length * far)
        between = np.arccos(np.minimum(cosine, 1.0))
        way = side * (np.arctan2(z, y) - self.start - lift) - between
        return np.where(cosine > 1.0, math.inf, way)


@dataclass(frozen=True, kw_only=True)
class Turret(RollerGuide):
    """A wheel with radial rollers, its axis parallel to y beside the cam.

    Distances along a roller's axis are measured from the axis of the turret, towards the cam.

    Parameters
    ----------
    distance : float, mm
        From the cam's axis to that of the turret.
    start : float, rad
        Angle of the roller from the common perpendicular towards +z at zero lift.
    """

    distance: float
    start: float

    angular, mirrored = True, False

    @staticmethod
    def in_plane(vectors: Array) -> Plane:
        """Return x + i*z (see `RollerGuide.in_plane`)."""
        return vectors[..., 0] + 1j * vectors[..., 2]

    def support(self, friction: SpaceFrictionSpec) -> Support:  # noqa: ARG002
        """Return the bearing of the turret (see `RollerGuide.support`)."""
        return ThrustPivot(at=complex(self.distance), spin=-1.0, along=1, central=True)

    def mass_point(self, lift: Array, distance: float) -> Plane:  # noqa: ARG002
        """Return its axis (see `RollerGuide.mass_point`)."""
        return np.full(len(lift), complex(self.distance))

    def placed(self, lift: Array) -> tuple[Array, Array]:
        """Return the axis of the roller (see `RollerGuide.placed`)."""
        point, direction = np.zeros((3, len(lift), 3)), np.zeros((3, len(lift), 3))
        point[0, :, 0] = self.distance
        c, s = np.cos(self.start + lift), np.sin(self.start + lift)
        for order, (x, z) in enumerate(((-c, s), (s, c), (c, -s))):
            direction[order, :, 0], direction[order, :, 2] = x, z
        return point, direction

    def pose(self, lift: Array) -> SpacePose:
        """Return the poses of the roller (see `RollerGuide.pose`)."""
        return SpacePose((0.0, 1.0, 0.0), math.pi + self.start + lift, self.placed(lift)[0][0])


def carried(
    guide: RollerGuide, theta: Array, lift: Array, first: Array, second: Array
) -> RollerAxis:
    """Return the axis of a roller in the frame of a cam that turns.

    Parameters
    ----------
    guide : RollerGuide
        What carries the roller.
    theta : (n,) array, rad
        Cam angles.
    lift, first, second : (n,) arrays
        The lift and its derivatives by the cam angle.

    Returns
    -------
    RollerAxis
    """
    c, s = np.cos(theta), np.sin(theta)
    back = np.zeros((len(theta), 3, 3))
    back[:, 0, 0], back[:, 0, 1], back[:, 1, 0], back[:, 1, 1], back[:, 2, 2] = c, s, -s, c, 1.0

    still, by_lift, twice_by_lift = np.stack(guide.placed(lift), axis=1)  # points, directions
    once = by_lift * first[:, None]
    twice = twice_by_lift * first[:, None] ** 2 + by_lift * second[:, None]
    rates = (
        still,
        once - _about(still),
        twice - 2.0 * _about(once) + _about(_about(still)),
        by_lift,
    )
    point, direction = np.einsum("nij,kbnj->bkni", back, np.stack(rates))
    return RollerAxis(point=point[:3], direction=direction[:3], way=point[3], swing=direction[3])


def _about(vectors: Array) -> Array:
    """Return z x vector."""
    return vectors[..., [1, 0, 2]] * [-1.0, 1.0, 0.0]
