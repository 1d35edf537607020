"""The walls of a roller in closed form: its envelope for any rigid motion of its axis.

A roller is a cylinder or a cone about an *axis* with the point P(theta) and the unit direction
a(theta), both given in the frame of the cam with two derivatives. At the distance x along the axis
its centre is Q = P + x*a, with the velocity v = P' + x*a' against the cam, and its radius is
r(x) = r0 + (x - x0)*tan(g), g half the angle of the cone.

The roller touches the cam where the normal n = cos(g)*m - sin(g)*a of its surface is perpendicular
to the velocity of the point of contact X = Q + r*m. The direction m is perpendicular to a; with
u = cos(g)*v + r*sin(g)*a' the condition is linear in it::

    m . u = sin(g)*(a . v)

so that m has two values, mirrored in the plane of a and u: the two *sides*. Side +1 is that of
e x a, where e is the direction of u across the axis. For a cylinder m = n is perpendicular to
both a and v.

The *spread* of a wall is the area dX/dx by dX/dtheta on its surface, over dx and dtheta, positive
where the roller leaves what it has made. A wall whose spread changes sign is undercut: the roller
cuts it away at another angle. From F(x, psi, theta) = m.u - sin(g)*(a.v) = 0, psi the angle of m
about the axis::

    F_psi = t.u,  F_x = (m.a')/cos(g),
    F_theta = m.u' - sin(g)*(a'.v + a.v') - cos(g)*(a'.m)*(a.v),  t = a x m

Across the line of contact the wall leaves the roller with the *relative curvature* k. With D the
distance from the roller, D = D_theta = 0 on the wall and D_theta = -F, so that for a fixed point of
it D_theta,theta = grad(F).X_theta. Over the square of the distance of neighbouring lines of
contact, spread/|X_x|, this is::

    k = cos(g)*|F_psi|*|X_x|^2/(r*spread),  |X_x|^2 = 1/cos(g)^2 + (r*F_x/F_psi)^2

For a disc cam it is 1/r + 1/rho, rho the radius of curvature of the profile.

Source: derived here; for parallel axes 000 section 3.4.5. Depends on numpy only.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Mask

SIDES: Final = (1, -1)
"""The sides of a roller."""

_NEXT, _LAST = [1, 2, 0], [2, 0, 1]


@dataclass(frozen=True, eq=False, kw_only=True)
class RollerAxis(ShortRepr):
    """The axis of a roller in the frame of the cam, at n cam angles.

    Parameters
    ----------
    point, direction : (3, n, 3) arrays, mm and 1
        A point of it and its unit direction, with two derivatives by the cam angle.
    way, swing : (n, 3) arrays
        Derivatives of both by the lift: how the follower can move.
    """

    point: Array
    direction: Array
    way: Array
    swing: Array


@dataclass(frozen=True, kw_only=True)
class Roller(ShortRepr):
    """A roller.

    Parameters
    ----------
    radius : float, mm
        At the place `at`.
    at : float, mm
        A distance along its axis.
    half_angle : float, rad
        Half the angle of a cone that widens along its axis; 0 of a cylinder.
    """

    radius: float
    at: float = 0.0
    half_angle: float = 0.0

    def radii(self, x: Array) -> Array:
        """Return its radius, mm, at distances along its axis, mm."""
        return self.radius + (x - self.at) * math.tan(self.half_angle)

    def radius_at(self, x: float) -> float:
        """Return its radius, mm, at one distance along its axis, mm."""
        return float(self.radii(np.array(x)))


@dataclass(frozen=True, eq=False, kw_only=True)
class RollerContact(ShortRepr):
    """Where a roller touches one wall: at n cam angles, at k distances along its axis each.

    Parameters
    ----------
    axis : RollerAxis
        The motion of its axis.
    x, radius : (n, k) arrays, mm
        Distances along the axis, and radii of the roller there.
    half_angle : float, rad
        Half the angle of its cone.
    side : {1, -1}
        The side.
    """

    axis: RollerAxis
    x: Array
    radius: Array
    half_angle: float
    side: int

    @cached_property
    def _a(self) -> tuple[Array, Array, Array]:
        """The direction of the axis and its derivatives, for every x."""
        return tuple(one[:, None, :] for one in self.axis.direction)  # pyright: ignore

    @cached_property
    def _v(self) -> tuple[Array, Array]:
        """Velocity and acceleration of the centre against the cam."""
        x = self.x[..., None]
        first, second = (
            p[:, None, :] + x * a[:, None, :]
            for p, a in zip(self.axis.point[1:], self.axis.direction[1:], strict=True)
        )
        return first, second

    @cached_property
    def _u(self) -> Array:
        g, (_, a1, _), (v, _) = self.half_angle, self._a, self._v
        return math.cos(g) * v + (math.sin(g) * self.radius)[..., None] * a1

    @cached_property
    def centers(self) -> Array:
        """Centres of the roller, (n, k, 3), mm."""
        return self.axis.point[0][:, None, :] + self.x[..., None] * self._a[0]

    @cached_property
    def _across(self) -> tuple[Array, Array]:
        """The direction of u across the axis, and m . e; beyond 1 nothing is touched."""
        (a, _, _), (v, _) = self._a, self._v
        across = self._u - dot(self._u, a)[..., None] * a
        size = np.sqrt(dot(across, across))
        return across / size[..., None], math.sin(self.half_angle) * dot(a, v) / size

    @property
    def exists(self) -> Mask:
        """Whether the roller touches this wall, (n, k): not a cone that moves along its axis."""
        return np.abs(self._across[1]) < 1.0

    @cached_property
    def radial(self) -> Array:
        """The direction m from the centre to the point of contact, (n, k, 3); nan without one."""
        along, share = self._across
        with np.errstate(invalid="ignore"):
            beside = self.side * np.sqrt(1.0 - share**2)
        return share[..., None] * along + beside[..., None] * cross(along, self._a[0])

    @cached_property
    def points(self) -> Array:
        """Points of the wall, (n, k, 3), mm, in the frame of the cam."""
        return self.centers + self.radius[..., None] * self.radial

    @cached_property
    def normals(self) -> Array:
        """Unit normals of the roller there, (n, k, 3): into the metal."""
        g = self.half_angle
        return math.cos(g) * self.radial - math.sin(g) * self._a[0]

    @cached_property
    def pressure(self) -> Array:
        """Pressure angle, (n, k), rad: between the normal and how the centre can move."""
        way = self.axis.way[:, None, :] + self.x[..., None] * self.axis.swing[:, None, :]
        along = np.abs(dot(self.normals, way))
        beside = cross(self.normals, way)
        return np.arctan2(np.sqrt(dot(beside, beside)), along)

    @cached_property
    def tangents(self) -> Array:
        """Unit tangents of the roller's circumference there, (n, k, 3): a x m."""
        return cross(self._a[0], self.radial)

    @property
    def generators(self) -> Array:
        """Unit vectors along the surface of the roller there, (n, k, 3), outwards."""
        g = self.half_angle
        return math.cos(g) * self._a[0] + math.sin(g) * self.radial

    @cached_property
    def _slopes(self) -> tuple[Array, Array]:
        """F_psi and F_x."""
        return dot(self.tangents, self._u), dot(self._a[1], self.radial) / math.cos(self.half_angle)

    @cached_property
    def spread(self) -> Array:
        """The spread of the wall, (n, k), mm; negative where it is undercut."""
        g, r = self.half_angle, self.radius
        cosine, sine = math.cos(g), math.sin(g)
        (a, a1, a2), (v, v1), m = self._a, self._v, self.radial
        by_psi, by_x = self._slopes
        u1 = cosine * v1 + (sine * r)[..., None] * a2
        turned = dot(a1, m)
        by_theta = dot(m, u1) - sine * (dot(a1, v) + dot(a, v1)) - cosine * turned * dot(a, v)
        along = cosine * (dot(a, v) - r * turned) + sine * dot(m, v)
        around = dot(self.tangents, v) - r * by_theta / by_psi
        return self.side * (around / cosine + along * r * by_x / by_psi)

    @property
    def vanishing(self) -> Array:
        """Radii, (n, k), mm, of cylinders for which the spread vanishes; infinite without one.

        The direction m does not depend on the radius of a cylinder, and the spread becomes
        ``(t.v + c*r - (m.a')^2/(t.v)*r^2)*side``, c what is left of the derivatives. At r = 0 it is
        positive, and the factor of r^2 is not: one root is positive.
        """
        a, (v, v1), m = self._a[0], self._v, self.radial
        by_psi, by_x = self._slopes
        tail = dot(m, v1) - 2.0 * by_x * dot(a, v)
        constant, linear = np.abs(by_psi), -self.side * tail / by_psi
        square = by_x**2 / constant
        root = np.sqrt(linear**2 + 4.0 * constant * square)
        with np.errstate(divide="ignore", invalid="ignore"):  # the forms in which nothing cancels
            falling, rising = 2.0 * constant / (root - linear), (root + linear) / (2.0 * square)
        return np.where(linear < 0.0, falling, np.where(root + linear > 0.0, rising, math.inf))

    @cached_property
    def stretch(self) -> Array:
        """Length of the line of contact over that of x, (n, k): |X_x|."""
        by_psi, by_x = self._slopes
        return np.hypot(1.0 / math.cos(self.half_angle), self.radius * by_x / by_psi)

    def curvature(self, roller: Roller) -> Array:
        """Return the relative curvature of wall and a roller across the line of contact.

        Parameters
        ----------
        roller : Roller
            The roller; narrower than what has made the wall by the clearance of a groove.

        Returns
        -------
        (n, k) array, 1/mm
        """
        cosine, by_psi = math.cos(self.half_angle), np.abs(self._slopes[0])
        own = cosine * by_psi * self.stretch**2 / (self.radius * self.spread)
        narrower = 1.0 / roller.radii(self.x) - 1.0 / self.radius
        return own + narrower / (cosine * self.stretch**2)


def touched(axis: RollerAxis, roller: Roller, x: Array, side: int) -> RollerContact:
    """Return where a roller touches a wall.

    Parameters
    ----------
    axis : RollerAxis
        The motion of its axis, at n cam angles.
    roller : Roller
        Its shape.
    x : (n, k) array, mm
        Distances along its axis.
    side : {1, -1}
        The side.
    """
    radius, half_angle = roller.radii(x), roller.half_angle
    return RollerContact(axis=axis, x=x, radius=radius, half_angle=half_angle, side=side)


def dot(one: Array, other: Array) -> Array:
    """Return the scalar products of vectors, (..., 3), `one` and the `other`."""
    return np.einsum("...i,...i->...", one, other)


def cross(one: Array, other: Array) -> Array:
    """Return the products of `one` and the `other`, (..., 3); `numpy.cross` is slow for few."""
    return one[..., _NEXT] * other[..., _LAST] - one[..., _LAST] * other[..., _NEXT]
