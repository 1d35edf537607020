"""What a cam does beneath its follower: it turns, or it slides.

The follower stands in the fixed frame, the cam's frame moves. A cam that turns does so
counter-clockwise about the origin, and a point of the fixed frame moves ``exp(-i*x)`` times within
the cam's frame; one that slides moves along ``-x``, so that a fixed point moves along ``+x`` in it.
(Output of a sliding cam is the mirror image.)

Depends on numeric; numpy only.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Protocol

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.mechanics.driver_axis import DriverAxis
from gearcam.mechanics.friction import FrictionSpec
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.jets import Jet, cos, sin

ROUNDING: Final = 1e-9
"""Share of a step by which a turn may differ from whole steps, and share of a travel by which a
position may exceed it."""

Pair = tuple[Any, Any]
"""Real and imaginary part of a vector: jets, arrays or floats."""


def unit(angle: Array | float) -> Plane:
    """Return unit vectors at angles (n,), rad."""
    result = np.empty(np.shape(angle), dtype=np.complex128)
    result.real, result.imag = np.cos(angle), np.sin(angle)
    return result


class Centred(Protocol):
    """A round follower, as far as a carrier must know it."""

    def centre(self, p: Array) -> Plane:
        """Return the centre, mm, at positions (n,)."""
        ...

    def on_circle(self, radius: Array) -> Array:
        """Return positions (n,) with the centre on circles about the origin, mm."""
        ...

    def on_level(self, height: Array) -> Array:
        """Return positions (n,) with the centre at heights, mm."""
        ...


class Carrier(ABC, ShortRepr):
    """The motion of a cam, by a driver position x: rad of a turn, or mm of a travel."""

    rate: ClassVar[float]
    """Angle by which the fixed frame turns back in the cam's frame, rad per unit of x."""

    around: ClassVar[bool]
    """Whether profiles go around the origin."""

    returns: ClassVar[bool]
    """Whether it comes back the same way, so that returns push the follower too."""

    @property
    @abstractmethod
    def driver(self) -> DriverAxis:
        """Name and unit of its angle or travel in output."""

    @property
    @abstractmethod
    def positions(self) -> tuple[float, float]:
        """Least and largest driver position, rad or mm."""

    @abstractmethod
    def places(self, step: float, period: float) -> Array:
        """Return the driver positions of a table.

        Parameters
        ----------
        step, period : float, rad or mm
            Step of the table, and whole turn or travel.

        Returns
        -------
        (n,) array, rad or mm
        """

    @abstractmethod
    def relative(self, ahead: Pair, at: Pair) -> Pair:
        """Return the velocity of a follower's centre at rest, seen from the cam.

        Parameters
        ----------
        ahead, at : pairs
            ``i*conj(t)`` and ``conj(t)*C`` for the centre C and the follower's direction t.

        Returns
        -------
        pair, mm per unit of x
            In axes of the follower: across its direction, and against it.
        """

    @abstractmethod
    def under(self, x: Array, z: Plane) -> Plane:
        """Return points z, mm, of the fixed frame in the cam's frame at driver positions x."""

    @abstractmethod
    def frame(self, x: Array) -> tuple[Plane, Plane]:
        """Return the pose of the cam at driver positions x: a rotation, then a shift, mm."""

    @abstractmethod
    def placed(self, x: Jet, z: complex) -> tuple[Jet, Jet]:
        """Return coordinates, mm, in the fixed frame of a point z of the cam, at x."""

    @abstractmethod
    def passing(self, z: Plane) -> Plane:
        """Return velocities of points z of the cam in the fixed frame, mm per unit of x."""

    @abstractmethod
    def drag(self, force: Plane, friction: FrictionSpec) -> Array:
        """Return the `friction` of the cam's bearing, N mm or N, under a `force` (n,), N."""

    @abstractmethod
    def stand(self, follower: Centred, z: Plane, near: Array) -> tuple[Array, Array, Plane]:
        """Return where a follower has its centre on given points of the cam's frame.

        Parameters
        ----------
        follower : Centred
            The follower.
        z : (n,) complex array, mm
            The points.
        near : (n,) array
            Driver positions nearby: less than half a turn away.

        Returns
        -------
        x, p, centre : (n,) arrays
            Driver positions, positions of the follower, and its centres in the fixed frame, mm.
        """


@dataclass(frozen=True)
class Rotating(Carrier):
    """A cam that turns counter-clockwise about the origin."""

    rate, around, returns = 1.0, True, False

    @property
    def driver(self) -> DriverAxis:
        """Name and unit of the cam angle."""
        return DriverAxis(
            column="theta_deg",
            symbol="theta",
            unit="deg",
            per="rad",
            called="cam angle",
            scale=math.degrees(1.0),
            whole=360.0,
        )

    @property
    def positions(self) -> tuple[float, float]:
        """Any angle (see `Carrier.positions`)."""
        return -math.inf, math.inf

    def places(self, step: float, period: float) -> Array:
        """Return angles; a whole turn only if it is in whole steps (see `Carrier.places`)."""
        return step * np.arange(math.floor(period / step + ROUNDING) + 1.0)

    def relative(self, ahead: Pair, at: Pair) -> Pair:  # noqa: ARG002
        """Return ``conj(t)*C``, as ``U = -i*C`` (see `Carrier.relative`)."""
        return at

    def under(self, x: Array, z: Plane) -> Plane:
        """Return the points turned back (see `Carrier.under`)."""
        return z * unit(-x)

    def frame(self, x: Array) -> tuple[Plane, Plane]:
        """Return a rotation (see `Carrier.frame`)."""
        return unit(x), np.zeros(np.shape(x), dtype=np.complex128)

    def placed(self, x: Jet, z: complex) -> tuple[Jet, Jet]:
        """Return the point turned by x (see `Carrier.placed`)."""
        radius, angle = abs(z), math.atan2(z.imag, z.real)
        return radius * cos(x + angle), radius * sin(x + angle)

    def passing(self, z: Plane) -> Plane:
        """Return velocities around the origin (see `Carrier.passing`)."""
        return 1j * z

    def drag(self, force: Plane, friction: FrictionSpec) -> Array:
        """Return the moment of friction of its journals (see `Carrier.drag`)."""
        return friction.circle * np.abs(force)

    def stand(self, follower: Centred, z: Plane, near: Array) -> tuple[Array, Array, Plane]:
        """Return where the centres are on the points (see `Carrier.stand`)."""
        p = follower.on_circle(np.abs(z))
        centre = follower.centre(p)
        return near + np.angle(centre * np.conj(z) * unit(-near)), p, centre


@dataclass(frozen=True)
class Sliding(Carrier):
    """A cam that slides along ``-x``.

    Parameters
    ----------
    travel : float, mm
        The whole travel.
    """

    travel: float

    rate, around, returns = 0.0, False, True

    @property
    def driver(self) -> DriverAxis:
        """Name and unit of the travel."""
        return DriverAxis(
            column="travel_mm",
            symbol="u",
            unit="mm",
            per="mm",
            called="travel",
            scale=1.0,
            whole=self.travel,
        )

    @property
    def positions(self) -> tuple[float, float]:
        """Both ends of the travel (see `Carrier.positions`)."""
        return 0.0, self.travel

    def places(self, step: float, period: float) -> Array:
        """Return travels and the end, where the cam is not as before (see `Carrier.places`)."""
        whole = step * np.arange(math.floor(period / step + ROUNDING) + 1.0)
        return np.append(whole[whole < period * (1.0 - ROUNDING)], period)

    def relative(self, ahead: Pair, at: Pair) -> Pair:  # noqa: ARG002
        """Return ``i*conj(t)``, as ``U = 1`` everywhere (see `Carrier.relative`)."""
        return ahead

    def under(self, x: Array, z: Plane) -> Plane:
        """Return the points moved on (see `Carrier.under`)."""
        return z + x

    def frame(self, x: Array) -> tuple[Plane, Plane]:
        """Return a shift (see `Carrier.frame`)."""
        return np.ones(np.shape(x), dtype=np.complex128), np.asarray(-x, dtype=np.complex128)

    def placed(self, x: Jet, z: complex) -> tuple[Jet, Jet]:
        """Return the point moved by x (see `Carrier.placed`)."""
        return z.real - x, z.imag + 0.0 * x

    def passing(self, z: Plane) -> Plane:
        """Return the velocity of all points."""
        return np.full(np.shape(z), -1.0, dtype=np.complex128)

    def drag(self, force: Plane, friction: FrictionSpec) -> Array:
        """Return the friction in the plate's guide, which does not tip (see `Carrier.drag`)."""
        return friction.guide * np.abs(force.imag)

    def stand(self, follower: Centred, z: Plane, near: Array) -> tuple[Array, Array, Plane]:  # noqa: ARG002
        """Return where the centres are on the points (see `Carrier.stand`)."""
        p = follower.on_level(z.imag)
        centre = follower.centre(p)
        return (z - centre).real, p, centre


ROTATING = Rotating()
"""A cam that turns."""
