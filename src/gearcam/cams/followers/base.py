"""What a follower answers, whatever its shape, and its contact with a cam."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar, Self, TypeVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.cams.carriers import Carrier
from gearcam.laws.program import Program
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.supports import Support
from gearcam.numeric.arrays import Array, Mask, Plane
from gearcam.numeric.jets import Jet, atan, sqrt

UPRIGHT = 0.5 * math.pi
"""Largest angle, rad, of an arm over a cam that slides, and of a face from the line of centres."""

Values = TypeVar("Values", Jet, Array)
"""Jets, or numbers alone."""

Symbol = tuple[list[tuple[complex, ...]], list[tuple[complex, float]]]
"""Points of open lines, mm, and discs by centre and radius, mm."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Contact:
    """The contact at some cam angles, jets in theta.

    Parameters
    ----------
    across, along : Jet
        Velocities whose ratio is the tangent of the pressure angle.
    turning : Jet
        Angular rate of the profile's normal.
    pitch_speed : Jet, mm/rad
        Speed of the centre along the pitch curve; for a flat face equal to `speed`.
    speed : Jet, mm/rad
        Speed of the contact along the profile, negative where it is undercut.
    place : Jet, mm
        For a flat face: position of the contact along the face, from the parallel to the
        follower's axis through the cam's axis, or from the pivot; zero for round followers.
    """

    across: Jet
    along: Jet
    turning: Jet
    pitch_speed: Jet
    speed: Jet
    place: Jet

    @property
    def pressure(self) -> Jet:
        """Signed pressure angle, rad."""
        return atan(self.across / self.along)


@dataclass(frozen=True, kw_only=True)
class Follower(ShortRepr, ABC):
    """A follower in the fixed frame.

    Parameters
    ----------
    start : float, mm or rad
        Position at zero lift.
    radius : float, mm
        Of a round end; 0 for a point or a flat face.
    """

    start: float
    radius: float = 0.0

    angular: ClassVar[bool] = False
    """Whether positions and lifts are angles."""

    has_centre: ClassVar[bool]
    """Whether it has a centre, which traces a pitch curve."""

    pressure_limit: ClassVar[float] = math.radians(30.0)
    """Largest recommended pressure angle, rad."""

    jamming_limit: ClassVar[float] = math.radians(65.0)
    """Pressure angle from which friction blocks the follower, rad.

    A stem in a guide of length b that overhangs it by a jams at ``tan(alpha + rho) = 1/(mu*(1 +
    2*a/b))``, an arm on a pin of radius r at ``cos(alpha + rho) = r/l*sin(arctan(mu))``; rho is the
    angle of friction at the cam, ``arctan(mu)`` of a contact that slides and nearly 0 of a roller.
    With ``mu = 0.15`` a stem jams from 65.8 deg with a roller and ``a = b``, from 64.8 deg with a
    sliding contact and ``a = b/2``; an arm with ``r = l/10`` and a sliding contact from 80.6 deg.
    Source: 000 eqs. (3.82), (3.84), (3.99).
    """

    @property
    def lift_unit(self) -> tuple[float, str]:
        """Factor from lift, mm or rad, to its unit in output, and that unit: mm or deg."""
        return (math.degrees(1.0), "deg") if self.angular else (1.0, "mm")

    @property
    def load_unit(self) -> tuple[float, str, str]:
        """Factor from loads, N or N mm, to their unit in output, that unit, and its suffix."""
        return (1e-3, "N m", "nm") if self.angular else (1.0, "N", "n")

    @property
    def lever(self) -> float:
        """Millimetres per unit of lift."""
        return 1.0

    @property
    def spin(self) -> float:
        """Turn of its direction per unit of position, rad."""
        return 0.0

    def lean(self, p: Array) -> Array | float:
        """Return the angle of its direction from the y axis at positions (n,), rad."""
        return self.spin * p

    @property
    def bend(self) -> float:
        """Curvature of its end, 1/mm: 0 of a face, infinite of a point."""
        return 0.0

    @abstractmethod
    def held(self, friction: FrictionSpec, highest: float) -> Support:
        """Return what holds it.

        Parameters
        ----------
        friction : FrictionSpec
            With the length and the place of a guide.
        highest : float, mm or rad
            The highest lift, above which a guide begins if it has no given place.
        """

    def mass_point(self, p: Array, distance: float) -> Plane:  # noqa: ARG002
        """Return a point of the follower in the fixed frame.

        Parameters
        ----------
        p : (n,) array
            Positions.
        distance : float, mm
            From the pivot towards the contact; a stem is weighed on its axis.
        """
        return np.zeros(np.shape(p), dtype=np.complex128)

    @property
    def below(self) -> bool:
        """Whether it is below the cam's axis, and comes nearer to it as it rises."""
        return False

    @property
    def prime_radius(self) -> float:
        """Distance from the cam's axis at zero lift, mm; of a flat face the base radius."""
        return self.distance(self.start)

    @property
    def aside(self) -> float:
        """Distance of the guide of a round end from the origin, mm."""
        return 0.0

    @property
    def nearest(self) -> float:
        """Least distance from the origin to its centre or face, mm, over all positions."""
        return 0.0

    @property
    def on_axis(self) -> float:
        """Position, mm or rad, at which it touches the cam's axis, or is as near as it can."""
        return float(self.on_circle(max(self.radius, self.nearest)))

    def demand(self, program: Program) -> None:
        """Refuse a lift that brings it to positions that it cannot take.

        Parameters
        ----------
        program : Program
            The lift.

        Raises
        ------
        InfeasibleError
            If it passes a position that it cannot take, or loses its contact.
        """

    def demand_within(self, program: Program, limits: tuple[float, float], passing: str) -> None:
        """Refuse a lift with which a follower that swings takes positions not between limits.

        Parameters
        ----------
        program : Program
            The lift.
        limits : (float, float), rad
            Least and largest position.
        passing : str
            What it passes there, in words.

        Raises
        ------
        InfeasibleError
            If a position is not between them.
        """
        (low, high), (least, most) = (self.start + lift for lift in program.range), limits
        if least < low and high < most:
            return
        position, limit = (low, least) if low <= least else (high, most)
        value, limit = (math.degrees(angle - self.start) for angle in (position, limit))
        what, note = f"the arm swings too far: it {passing}", "value and limit are lifts"
        raise beyond_limit(what, "motion", value, limit, note, unit="deg")

    @abstractmethod
    def contact(self, carrier: Carrier, p: Jet, ds: Jet, inset: float) -> Contact:
        """Return the contact with the cam.

        Parameters
        ----------
        carrier : Carrier
            Motion of the cam.
        p, ds : Jet
            Position and velocity, each with one derivative more than the contact.
        inset : float, mm
            Depth of the profile below a round follower's centre; of no meaning for faces.
        """

    @abstractmethod
    def trace(
        self, carrier: Carrier, x: Array, p: Array, ds: Array, inset: float
    ) -> tuple[Plane, Plane]:
        """Return points, mm, and unit tangents, clockwise, of a curve in the cam's frame.

        Parameters
        ----------
        carrier : Carrier
            Motion of the cam.
        x, p, ds : (n,) arrays
            Driver positions, positions and velocities of the follower.
        inset : float, mm
            Depth below a round follower's centre, 0 for the pitch curve; of no meaning for faces,
            whose profile is the only curve.
        """

    @abstractmethod
    def rest(self, x: Jet, y: Jet, grow: Array | float = 0.0, side: int = 1) -> tuple[Jet, Array]:
        """Return the position at which it rests on discs.

        Parameters
        ----------
        x, y : Jet, mm
            Centres of the discs in the fixed frame.
        grow : float or array, mm
            Radii of the discs.
        side : {1, -1}
            Whether a round follower is above the disc or pressed against it from below.

        Returns
        -------
        position : Jet, mm or rad
            Infinite where the follower always overlaps the disc. Out of reach it is that of the
            nearest point in reach, so that searches may pass there.
        room : array
            Negative out of reach; mm^2 for a round follower.
        """

    @abstractmethod
    def distance(self, p: float) -> float:
        """Return the distance from the origin to its centre or face, mm, at a position."""

    @abstractmethod
    def on_circle(self, radius: Array | float) -> Array:
        """Return positions (n,) at distances from the origin, mm: the inverse of `distance`.

        Out of reach of a round follower that of the nearest distance in reach.
        """

    def least_start(self, limit: float, lift: Array, velocity: Array) -> tuple[float, float]:  # noqa: ARG002
        """Return the range of positions at zero lift that keep a limit of the pressure angle.

        Over a cam that turns. The pressure angle of a face does not depend on them.

        Parameters
        ----------
        limit : float, rad
            Largest pressure angle.
        lift, velocity : (n,) arrays
            Along the motion.

        Returns
        -------
        low, high : float, mm or rad
            Infinite and reversed if there is none.
        """
        return math.inf, -math.inf

    def starting_at(self, radius: float) -> Self:
        """Return the follower that is at a distance from the origin, mm, at zero lift."""
        return replace(self, start=float(self.on_circle(radius)))

    @property
    def clear(self) -> float:
        """Largest radius of a cam about the origin that does not reach past its pivot, mm."""
        return math.inf

    def behind(self, z: Plane, grow: Array | float) -> Mask:
        """Return which discs lie where the follower cannot be.

        Inside a profile that is beyond the axis; over a cam that slides, beyond the pivot, where
        the arm of a disc cam's follower may be.

        Parameters
        ----------
        z : complex array, mm
            Centres of the discs in the fixed frame.
        grow : float or array, mm
            Their radii.
        """
        return np.full(z.shape, self.below) & (z.imag - grow > 0.0)

    def on_chord(self, z: Plane, chord: Plane, grow: Array | float) -> Array:  # noqa: ARG002
        """Return where between its ends it rests on a chord: 0 at the start, 1 at the end.

        The centre of a round follower is there where its path leaves the chord's parallel.

        Parameters
        ----------
        z, chord : (n,) complex arrays, mm
            Starts of chords in the fixed frame, with the metal to the left, and chords.
        grow : float or array, mm
            Growth of the metal.

        Returns
        -------
        (n,) array
            On the line of the chord, also beyond its ends; nan if it rests at the ends only.
        """
        return np.full(z.shape, np.nan)

    @abstractmethod
    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""

    @abstractmethod
    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the rigid motion of the follower over rises (n,), mm or rad.

        Returns
        -------
        turn, shift : (n,) arrays, rad and complex mm
            A rotation about the origin, then a shift.
        """

    @abstractmethod
    def along_normal(self, p: Array, point: Plane, normal: Plane) -> tuple[Array, dict[str, Array]]:
        """Return how far its surface moves along the normal of a contact, mm, by what moves it.

        Parameters
        ----------
        p : (n,) array
            Positions of the follower.
        point, normal : (n,) complex arrays, mm and 1
            Points of contact in the fixed frame, with the normals of the metal, outward.

        Returns
        -------
        by_position : (n,) array
            Per unit of the position.
        by_size : dict of str to (n,) array
            Per unit of each of its sizes, mm or rad.
        """

    @abstractmethod
    def symbol(self, p: float, reach: float, wide: float) -> Symbol:
        """Return lines and discs that show the follower.

        Parameters
        ----------
        p : float, mm or rad
            Position.
        reach : float, mm
            Size of the cam.
        wide : float, mm
            Half the width of a face on a stem.
        """

    @abstractmethod
    def jump(self, carrier: Carrier, p: Array, ds: Array) -> Array:
        """Return the even parameter of a jump of the velocity, which rises with it.

        The pressure angle of a round follower, rad; of a swinging face the position of the contact
        in distances of the pivot; of a translating one the velocity itself.

        Parameters
        ----------
        carrier : Carrier
            Motion of the cam.
        p, ds : (n,) arrays
            Positions and velocities of the follower.
        """

    @abstractmethod
    def velocity(self, carrier: Carrier, p: Array, jump: Array) -> Array:
        """Return the velocities in a jump.

        Parameters
        ----------
        carrier : Carrier
            Motion of the cam.
        p, jump : (n,) arrays
            Positions of the follower, and the parameter of the jump (see `jump`).
        """

    @abstractmethod
    def jump_speed(self, carrier: Carrier, p: Array, inset: float) -> Array:
        """Return the speed of a curve, mm per unit of the parameter, during a jump.

        Parameters
        ----------
        carrier : Carrier
            Motion of the cam.
        p : (n,) array
            Positions of the follower.
        inset : float, mm
            Depth below a round follower's centre.
        """


def polar(across: Jet, y: Jet) -> tuple[Jet, Jet]:
    """Return angle, rad, and distance, mm, of points `across` and `y` from a pivot."""
    far = sqrt(across * across + y * y)
    # an arctangent of half the angle stays finite at the height of the pivot
    return 2.0 * atan(y / (far + across)), far


def dot(normal: Plane, moved: Plane) -> Array:
    """Return the components of what has `moved` along a `normal`, (n,)."""
    return (np.conj(normal) * moved).real
