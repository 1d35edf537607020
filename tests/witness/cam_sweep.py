"""Disc cams once more: positions of the follower from the geometry, and its passing as a cutter.

The follower's place is written out from a drawing, for numpy and mpmath alike; pressure angle and
curvature are then left to finite differences in high precision. The cam itself is a blank from
which the follower is subtracted at many cam angles.

Fixed frame: the cam's axis is the origin, a translating follower moves along ``+y``, the pivot of a
swinging one is at ``(pivot, 0)``. The cam turns counter-clockwise by theta. Lengths in mm, angles
in rad but for the degrees of phases and of a swinging follower's lift.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import shapely

Number = Any
"""A float, an array or a number of mpmath."""
Region = Any
mp: Any = mpmath.mp

LAWS: dict[str, Callable[[Number, Any], Number]] = {
    "constant-velocity": lambda x, _: x,
    "harmonic": lambda x, lib: (1 - lib.cos(lib.pi * x)) / 2,
    "cycloidal": lambda x, lib: x - lib.sin(2 * lib.pi * x) / (2 * lib.pi),
    "3-4-5": lambda x, _: x**3 * (10 - 15 * x + 6 * x * x),
}
"""Lift over the whole lift, by the angle over the whole angle."""


@dataclass(frozen=True)
class Motion:
    """A rise, a dwell, a return and a dwell, of so many degrees."""

    law: str
    height: float
    """mm, or degrees of an arm."""
    degrees: Sequence[float]
    swings: bool = False

    def __call__(self, theta: Number, lib: Any) -> Number:
        """The lift at an angle of the first turn."""
        up, top, down, _ = (lib.pi * angle / 180 for angle in self.degrees)
        height = self.height * (lib.pi / 180 if self.swings else 1)
        shape = LAWS[self.law]
        if lib is np:
            rising = shape(np.clip(theta / up, 0.0, 1.0), np)
            return height * (rising - shape(np.clip((theta - up - top) / down, 0.0, 1.0), np))
        if theta < up:
            return height * shape(theta / up, lib)
        if theta < up + top:
            return height * lib.mpf(1)
        if theta < up + top + down:
            return height * (1 - shape((theta - up - top) / down, lib))
        return lib.mpf(0)


@dataclass(frozen=True)
class Follower:
    """What touches the cam: a face or a circle, sliding or swinging."""

    size: float
    """Prime radius of a circle's centre, base radius of a face."""
    flat: bool = False
    swings: bool = False
    radius: float = 0.0
    offset: float = 0.0
    arm: float = 0.0
    pivot: float = 0.0
    face: float = 0.0
    """How far a swinging face stands off its pivot, towards the cam."""

    def start(self, lib: Any) -> Number:
        """Height, or angle of the arm from the line between pivot and cam, at zero lift."""
        if self.flat:
            return (
                lib.asin((self.size + self.face) / lib.mpf(self.pivot))
                if self.swings
                else (lib.mpf(self.size))
            )
        if not self.swings:
            return lib.sqrt(lib.mpf(self.size) ** 2 - lib.mpf(self.offset) ** 2)
        d, arm, size = (lib.mpf(side) for side in (self.pivot, self.arm, self.size))
        return lib.acos((d * d + arm * arm - size * size) / (2 * d * arm))

    def centre(self, position: Number, lib: Any) -> Number:
        """The circle's centre in the fixed frame, at a height or an angle of the arm."""
        if not self.swings:
            return self.offset + 1j * position
        return self.pivot - self.arm * lib.exp(-1j * position)

    def normal(self, position: Number, lib: Any) -> Number:
        """The face's normal in the fixed frame, away from the cam."""
        return 1j * lib.exp(-1j * position) if self.swings else 1j * lib.exp(0 * position)

    def through(self, position: Number, lib: Any) -> Number:
        """A point of the face in the fixed frame."""
        if not self.swings:
            return 1j * position
        return self.pivot - self.face * self.normal(position, lib)


def dot(a: Number, b: Number) -> Number:
    """The scalar product of two vectors of the plane."""
    return (a.conjugate() * b).real


class Exact:
    """A follower and its cam in high precision, by differences of the geometry alone."""

    def __init__(self, follower: Follower, motion: Motion) -> None:
        self.follower, self.motion, self.first = follower, motion, follower.start(mp)

    def position(self, theta: Number) -> Number:
        """Height or angle of the arm."""
        return self.first + self.motion(theta, mp)

    def pitch(self, theta: Number) -> Number:
        """The circle's centre, seen from the cam."""
        return self.follower.centre(self.position(theta), mp) * mp.exp(-1j * theta)

    def contact(self, theta: Number) -> Number:
        """Where the profile is touched, seen from the cam."""
        if not self.follower.flat:
            along = mp.diff(self.pitch, theta)
            # the metal lies to the right of a curve that runs clockwise
            return self.pitch(theta) - 1j * self.follower.radius * along / abs(along)

        def normal(t: Number) -> Number:
            return self.follower.normal(self.position(t), mp) * mp.exp(-1j * t)

        def height(t: Number) -> Number:
            at = self.follower.through(self.position(t), mp) * mp.exp(-1j * t)
            return dot(normal(t), at)

        # the envelope of lines n*z = h: also n'*z = h'
        n, slope = normal(theta), mp.diff(normal, theta)
        return 1j * (mp.diff(height, theta) * n - height(theta) * slope) / dot(1j * n, slope)

    def pressure(self, theta: Number) -> Number:
        """From the velocity that a lift gives the follower where it is touched, to the normal."""
        position, follower = self.position(theta), self.follower
        if follower.flat:
            normal = follower.normal(position, mp)
            touched = self.contact(theta) * mp.exp(1j * theta)
            moves = -1j * (touched - follower.pivot) if follower.swings else mp.mpc(0, 1)
        else:
            # the normal is square to the way of the centre as it is seen from the cam
            normal = 1j * mp.diff(self.pitch, theta) * mp.exp(1j * theta)
            moves = mp.diff(lambda at: follower.centre(at, mp), position)
        return mp.arg(normal / moves)

    def curvature(self, curve: Callable[[Number], Number], theta: Number) -> Number:
        """Curvature of a curve that runs clockwise, positive where convex."""
        first, second = mp.diff(curve, theta), mp.diff(curve, theta, 2)
        return -(first.conjugate() * second).imag / abs(first) ** 3


def swept(follower: Follower, theta: Number, lift: Number, blank: float, sides: int) -> Region:
    """A blank disc less the follower at some cam angles and lifts: the part about the axis.

    Circles are inscribed polygons of so many sides; faces are half planes, exact.
    """
    position = float(follower.start(mp)) + lift
    seen = np.exp(-1j * theta)
    if follower.flat:
        return _below(
            follower.normal(position, np) * seen, follower.through(position, np) * seen, blank
        )
    around = follower.radius * np.exp(2j * np.pi * np.arange(sides) / sides)
    rings = (follower.centre(position, np) * seen)[:, None] + around
    cutters = shapely.polygons(np.stack([rings.real, rings.imag], axis=-1))
    left = (
        shapely.Point(0.0, 0.0).buffer(blank, quad_segs=64).difference(shapely.union_all(cutters))
    )
    axis = shapely.Point(0.0, 0.0)
    return next(part for part in shapely.get_parts(left) if part.contains(axis))


def _below(normals: Number, points: Number, blank: float) -> Region:
    """What lies below all faces: the polar of the hull of the poles ``n/h`` of their lines."""
    poles = normals / dot(normals, points)
    hull = shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(pairs(poles))))[:-1]
    z = hull @ [1.0, 1j]
    if (np.conj(z) * np.roll(z, -1)).imag.sum() < 0:
        z = z[::-1]
    # two neighbouring lines cross where z*a = z*b = 1
    a, b = z, np.roll(z, -1)
    corners = 1j * (a - b) / (np.conj(a) * b).imag
    return shapely.polygons(pairs(corners)).intersection(
        shapely.Point(0.0, 0.0).buffer(blank, quad_segs=64)
    )


def pairs(points: Number) -> Number:
    """Complex numbers (n,) as (n, 2)."""
    return np.stack([points.real, points.imag], axis=-1)
