"""The followers of cams: position, velocity and contact of each, once for every carrier.

Points of the plane are complex numbers, mm, in the fixed frame. The *position* p of a follower is
its lift added to its position at zero lift, mm or rad. A round follower has a centre ``C(p)``;
its path has the unit tangent t, the follower's direction, and the length ``lever`` per unit of p:

==================== ======================================= ========= ==========
follower             centre                                  lever     direction t
==================== ======================================= ========= ==========
stem                 ``exp(i*tilt)*(offset + i*p)``          1         ``i*exp(i*tilt)``
arm                  ``pivot - hand*arm*exp(-i*hand*p)``     ``arm``   ``i*exp(-i*hand*p)``
==================== ======================================= ========= ==========

With U, the velocity of a point at rest seen from the cam, the centre moves in the cam's frame by
``A + i*B = i*lever*s' + i*conj(t)*U``: A across the follower's direction, B against it.
``alpha = arctan(B/A)`` is the pressure angle, ``w = hypot(A, B)`` the speed of the centre and
``turning = rate - spin*s' - alpha'`` the angular rate of the normal; the pitch curve's curvature is
``turning/w`` (positive for a convex curve), and the profile, a roller's radius r inside it, is
traced at the speed ``w - r*turning``. Where that is negative the profile is undercut.

A flat face is a support line at the distance h from the cam's axis, which turns by ``-beta`` in the
cam's frame: it touches ``g = h'/beta'`` along itself, and the profile is traced at the speed
``h*beta' + g'``. The curves run clockwise.

Frame: the cam's axis is the origin. Over a cam that turns a stem moves along ``+y``, and the pivot
of an arm or a swinging face is on the x axis; positions are

==================== ==========================================================
stem                 height of the centre
flat stem            height of the face
arm                  Psi, between the arm and the line from pivot to cam
flat arm             the same of the face
==================== ==========================================================

A roller *below* the axis, the second on one follower, has a negative position; the formulas of the
first are valid for it unchanged.

Refused: positions that an arm or a swinging face cannot take.

Sources: 000 eqs. (3.17), (3.21), (3.26), (3.30), (3.33), section 3.4.4; derived anew.
"""

from __future__ import annotations

import cmath
import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self, TypeVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import rounded_down
from gearcam.cams.carriers import Carrier, Pair, unit
from gearcam.cams.supports import Pivot, StraightGuide, Support
from gearcam.laws.program import Program
from gearcam.mechanics.friction import FrictionSpec
from gearcam.numeric.arrays import Array, Mask, Plane
from gearcam.numeric.jets import Jet, asin, atan, sin_cos, sqrt

_UPRIGHT = 0.5 * math.pi
"""Largest angle, rad, of an arm over a cam that slides, and of a face from the line of centres."""

_STANDSTILL = 1e-7
"""Least relative difference of a face's downward speed from the cam's: below it the contact is a
million pivot distances away, or stays at one point."""


Values = TypeVar("Values", Jet, Array)
"""Jets, or numbers alone."""

Line = tuple[complex, ...]
"""Points of an open line, mm."""

Disc = tuple[complex, float]
"""Centre and radius, mm."""


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
    def symbol(self, p: float, reach: float, wide: float) -> tuple[list[Line], list[Disc]]:
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


def _guide(direction: complex, foot: complex, beyond: float, friction: FrictionSpec) -> Support:
    """Return a guide along a direction from a foot, mm, by default beyond a height, mm."""
    length = friction.guide_length or 0.0
    height = beyond + 0.5 * length if friction.guide_at is None else friction.guide_at
    return StraightGuide(direction=direction, middle=foot + height * direction)


@dataclass(frozen=True, kw_only=True)
class Round(Follower):
    """A follower with a round end: a roller, a dome, or a point."""

    has_centre = True

    @property
    def bend(self) -> float:
        """Curvature of its end, 1/mm (see `Follower.bend`)."""
        return 1.0 / self.radius if self.radius else math.inf

    highest: ClassVar[float]
    """Limit of its positions over a cam that turns, mm or rad."""

    @property
    def farthest(self) -> float:
        """Largest distance from the origin to its centre, mm, over all positions."""
        return math.inf

    def _end(self, p: float) -> tuple[complex, list[Disc]]:
        """Return the centre, and its end as discs: none of a point."""
        centre = complex(self.centre(np.array(p)))
        return centre, [(centre, self.radius)] if self.radius else []

    @abstractmethod
    def with_end(self, radius: float, arm: float) -> Self:
        """Return the follower with an end of another radius, mm, and an arm unless 0."""

    @abstractmethod
    def centre(self, p: Array) -> Plane:
        """Return the centre, mm, at positions (n,)."""

    @abstractmethod
    def centre_by(self, p: Array) -> tuple[Plane, dict[str, Plane]]:
        """Return the derivatives of the centre by the position, and by its sizes, at (n,)."""

    def along_normal(self, p: Array, point: Plane, normal: Plane) -> tuple[Array, dict[str, Array]]:  # noqa: ARG002
        """Return what moves the centre, and the radius (see `Follower.along_normal`)."""
        by_position, by_size = self.centre_by(p)
        round_end = {"radius": np.full(normal.shape, -1.0)} if self.radius else {}
        return _dot(normal, by_position), round_end | {
            name: _dot(normal, moved) for name, moved in by_size.items()
        }

    @abstractmethod
    def on_level(self, height: Array) -> Array:
        """Return positions (n,) with the centre at heights, mm."""

    @abstractmethod
    def axes(self, p: Jet | Array) -> tuple[Pair, Pair]:
        """Return ``i*conj(t)`` and ``conj(t)*C`` for the centre C and the direction t."""

    def _moving(self, carrier: Carrier, p: Values, ds: Values) -> tuple[Values, Values]:
        """Return A and B (see the module)."""
        a, b = carrier.relative(*self.axes(p))
        across: Any = 0.0 * p + a if isinstance(a, float) else a
        return across, b + self.lever * ds

    def contact(self, carrier: Carrier, p: Jet, ds: Jet, inset: float) -> Contact:
        """Return the contact (see `Follower.contact`)."""
        across, against = self._moving(carrier, p, ds)
        a, b = across.shortened(), against.shortened()
        square = a * a + b * b
        turning = (b * across.differentiated() - a * against.differentiated()) / square
        turning = turning + carrier.rate
        if self.spin:
            turning = turning - self.spin * ds.shortened()
        speed = sqrt(square)
        return Contact(
            across=b,
            along=a,
            turning=turning,
            pitch_speed=speed,
            speed=speed - inset * turning if inset else speed,
            place=0.0 * a,
        )

    def trace(
        self, carrier: Carrier, x: Array, p: Array, ds: Array, inset: float
    ) -> tuple[Plane, Plane]:
        """Return points and tangents (see `Follower.trace`)."""
        a, b = self._moving(carrier, p, ds)
        tangents = (a + 1j * b) / np.hypot(a, b) * unit(self.lean(p) - carrier.rate * x)
        return carrier.under(x, self.centre(p)) - 1j * inset * tangents, tangents

    def jump(self, carrier: Carrier, p: Array, ds: Array) -> Array:
        """Return the parameter of a jump (see `Follower.jump`)."""
        a, b = self._moving(carrier, p, ds)
        return np.arctan(b / np.abs(a))

    def velocity(self, carrier: Carrier, p: Array, jump: Array) -> Array:
        """Return the velocities in a jump (see `Follower.velocity`)."""
        a, b = self._moving(carrier, p, np.zeros_like(p))
        return (np.abs(a) * np.tan(jump) - b) / self.lever

    def jump_speed(self, carrier: Carrier, p: Array, inset: float) -> Array:
        """Return the speed around the centre (see `Follower.jump_speed`)."""
        return inset * np.sign(self._moving(carrier, p, np.zeros_like(p))[0])


@dataclass(frozen=True, kw_only=True)
class Stem(Round):
    """A round end on a stem that is guided straight.

    Parameters
    ----------
    offset : float, mm
        Distance of the guide from the origin, to the right.
    tilt : float, rad
        Angle of the guide from the y axis, counter-clockwise.
    """

    offset: float = 0.0
    tilt: float = 0.0

    highest = math.inf

    @property
    def aside(self) -> float:
        """Distance of its guide from the origin, mm."""
        return abs(self.offset)

    @property
    def nearest(self) -> float:
        """Distance of its guide from the origin, mm."""
        return abs(self.offset)

    @property
    def below(self) -> bool:
        """Whether its positions are negative."""
        return self.start < 0.0

    def with_end(self, radius: float, arm: float) -> Self:  # noqa: ARG002
        """Return the stem with another end (see `Round.with_end`)."""
        return replace(self, radius=radius)

    def least_start(self, limit: float, lift: Array, velocity: Array) -> tuple[float, float]:
        """Return the range of positions at zero lift (see `Follower.least_start`)."""
        return float((np.abs(velocity - self.offset) / math.tan(limit) - lift).max()), math.inf

    def held(self, friction: FrictionSpec, highest: float) -> Support:
        """Return its guide (see `Follower.held`)."""
        turn = cmath.exp(1j * self.tilt)
        return _guide(1j * turn, self.offset * turn, self.start + highest + self.radius, friction)

    def centre(self, p: Array) -> Plane:
        """Return the centre, mm."""
        return np.asarray(cmath.exp(1j * self.tilt) * (self.offset + 1j * p), dtype=np.complex128)

    def centre_by(self, p: Array) -> tuple[Plane, dict[str, Plane]]:
        """Return the derivatives by offset and inclination (see `Round.centre_by`)."""
        aside = np.full(np.shape(p), cmath.exp(1j * self.tilt))
        return 1j * aside, {"offset": aside, "axis": 1j * self.centre(p)}

    def lean(self, p: Array) -> float:  # noqa: ARG002
        """Return the tilt."""
        return self.tilt

    def axes(self, p: Jet | Array) -> tuple[Pair, Pair]:
        """Return ``exp(-i*tilt)`` and ``p - i*offset``."""
        return (math.cos(self.tilt), -math.sin(self.tilt)), (p, -self.offset)

    def on_circle(self, radius: Array | float) -> Array:
        """Return positions above the origin."""
        return np.sqrt(np.maximum((radius - self.offset) * (radius + self.offset), 0.0))

    def distance(self, p: float) -> float:
        """Return the distance of its centre from the origin, mm."""
        return math.hypot(self.offset, p)

    def on_chord(self, z: Plane, chord: Plane, grow: Array | float) -> Array:
        """Return the place between the ends (see `Follower.on_chord`)."""
        turn = cmath.exp(-1j * self.tilt)
        z, chord = turn * z, turn * chord
        reach, length = self.radius + grow, np.abs(chord)
        aside = self.offset - z.real - reach * (chord.imag / length)
        none = np.full(z.shape, np.nan)
        return np.divide(aside, chord.real, out=none, where=chord.real < 0.0)

    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""
        return replace(self, start=-self.start, tilt=-self.tilt)

    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the shift along the guide (see `Follower.moved`)."""
        return np.zeros_like(rise), np.asarray(
            1j * cmath.exp(1j * self.tilt) * rise, dtype=np.complex128
        )

    def symbol(self, p: float, reach: float, wide: float) -> tuple[list[Line], list[Disc]]:  # noqa: ARG002
        """Return the stem and its end (see `Follower.symbol`)."""
        centre, ends = self._end(p)
        up = math.copysign(0.5 * reach, self.start) * 1j * cmath.exp(1j * self.tilt)
        return [(centre, centre + up)], ends

    def on_level(self, height: Array) -> Array:
        """Return positions at heights of a stem through the origin."""
        return height / math.cos(self.tilt)

    def rest(self, x: Jet, y: Jet, grow: Array | float = 0.0, side: int = 1) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        aside, along = c * x + s * y - self.offset, c * y - s * x
        reach = self.radius + grow
        room = (reach - aside) * (reach + aside)
        return along + side * sqrt(_at_least_0(room)), np.asarray(room.c[0])


@dataclass(frozen=True, kw_only=True)
class Arm(Round):
    """A round end on an arm, which points from its pivot to the left or to the right.

    Parameters
    ----------
    arm : float, mm
        From the pivot to the centre.
    pivot : complex, mm
        The pivot.
    hand : {1, -1}
        Whether the arm points along ``-x`` or ``+x`` at position 0; it rises with the position.
    """

    arm: float
    pivot: complex
    hand: int = 1

    angular = True
    highest = math.pi
    pressure_limit = math.radians(45.0)
    jamming_limit = math.radians(80.0)

    @property
    def nearest(self) -> float:
        """Difference of arm and pivot distance, mm."""
        return abs(self.pivot.real - self.arm)

    @property
    def farthest(self) -> float:
        """Sum of arm and pivot distance, mm."""
        return self.pivot.real + self.arm

    @property
    def below(self) -> bool:
        """Whether it points to below the line of centres."""
        return self.hand > 0 and self.start < 0.0

    def demand(self, program: Program) -> None:
        """Refuse an arm over the line of centres, or across a travel (see `Follower.demand`)."""
        if self.hand > 0:
            _demand_within(self, program, (0.0, self.highest), "passes the line of centres")
        else:
            across = "gets perpendicular to the cam's travel"
            _demand_within(self, program, (-_UPRIGHT, _UPRIGHT), across)

    def with_end(self, radius: float, arm: float) -> Self:
        """Return the arm with another end (see `Round.with_end`)."""
        return replace(self, radius=radius, arm=arm or self.arm)

    def least_start(self, limit: float, lift: Array, velocity: Array) -> tuple[float, float]:
        """Return the range of positions at zero lift (see `Follower.least_start`).

        With ``turn = arccos(l*(1 + s')*cos(limit)/d)`` a position q keeps the limit at a lift s if
        ``abs(turn - limit) <= q + s <= turn + limit`` and ``q + s <= 2*pi - turn - limit``.
        """
        share = self.arm * (1.0 + velocity) * math.cos(limit) / self.pivot.real
        if np.abs(share).max() > 1.0:
            return math.inf, -math.inf
        turn = np.arccos(share)
        most = np.minimum(turn + limit, 2.0 * math.pi - turn - limit) - lift
        return float((np.abs(turn - limit) - lift).max()), float(most.min())

    @property
    def lever(self) -> float:
        """Millimetres per unit of lift."""
        return self.arm

    @property
    def spin(self) -> float:
        """Turn of its direction per unit of position, rad."""
        return -float(self.hand)

    def held(self, friction: FrictionSpec, highest: float) -> Support:  # noqa: ARG002
        """Return its pivot (see `Follower.held`)."""
        return Pivot(at=self.pivot, spin=self.spin)

    def mass_point(self, p: Array, distance: float) -> Plane:
        """Return a point on the line from the pivot to the centre (see `Follower.mass_point`)."""
        return self.pivot - (self.hand * distance) * unit(-self.hand * p)

    def centre(self, p: Array) -> Plane:
        """Return the centre, mm."""
        return self.pivot - (self.hand * self.arm) * unit(-self.hand * p)

    def centre_by(self, p: Array) -> tuple[Plane, dict[str, Plane]]:
        """Return the derivatives by the arm and the place of the pivot (see `Round.centre_by`)."""
        out, still = -self.hand * unit(-self.hand * p), np.ones(np.shape(p), dtype=np.complex128)
        return -1j * self.hand * self.arm * out, {
            "arm": out, "pivot_distance": self.hand * still, "pivot_height": 1j * still,
        }  # fmt: skip

    def axes(self, p: Jet | Array) -> tuple[Pair, Pair]:
        """Return ``exp(i*hand*p)``, and ``i*hand*arm - i*exp(i*hand*p)*pivot``.

        Of the angle itself: the centre's coordinates would lose the digits of the first part, whose
        sign says on which side of the axis the centre is.
        """
        (s, c), x, y = sin_cos(p), self.pivot.real, self.pivot.imag
        s = self.hand * s
        across, against = x * s, -x * c
        if np.any(y):
            across, against = across + y * c, against + y * s
        return (c, s), (across, against + self.hand * self.arm)

    def on_circle(self, radius: Array | float) -> Array:
        """Return positions above the origin, of a pivot on the x axis."""
        # half the angle from the sides, with parentheses (after Kahan) that keep all digits if the
        # triangle is nearly flat
        small, large = sorted([self.pivot.real, self.arm])
        apart = large - small
        half = np.arctan2(
            np.sqrt(np.maximum((radius - apart) * (radius + apart), 0.0)),
            np.sqrt(np.maximum((small - (radius - large)) * (small + (radius + large)), 0.0)),
        )
        return 2.0 * half

    @property
    def clear(self) -> float:
        """Largest radius of a cam about the origin that does not reach past its pivot, mm."""
        return self.pivot.real + self.arm - self.radius

    def distance(self, p: float) -> float:
        """Return the distance of its centre from the origin, mm, of a pivot on the x axis."""
        # law of cosines by half the angle: with a long arm, short pivot it cannot round below 0
        pivot = self.pivot.real
        half = math.sqrt(pivot * self.arm) * math.sin(0.5 * p)
        return math.hypot(pivot - self.arm, 2.0 * half)

    def behind(self, z: Plane, grow: Array | float) -> Mask:
        """Return which discs lie beyond the pivot, or above the axis (see `Follower.behind`)."""
        if self.hand < 0:
            return z.real - self.pivot.real + self.radius + grow < 0.0
        return super().behind(z, grow)

    def on_chord(self, z: Plane, chord: Plane, grow: Array | float) -> Array:
        """Return the place between the ends (see `Follower.on_chord`)."""
        length = np.abs(chord)
        from_pivot = (z - self.pivot) * np.conj(chord / length)
        beside = self.radius + grow - from_pivot.imag
        room = (self.arm - beside) * (self.arm + beside)
        place = (self.hand * np.sqrt(np.maximum(room, 0.0)) - from_pivot.real) / length
        return np.where(room >= 0.0, place, np.nan)

    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""
        return replace(self, start=-self.start, pivot=self.pivot.conjugate())

    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the rotation about the pivot (see `Follower.moved`)."""
        turn = -self.hand * rise
        return turn, self.pivot * (1.0 - unit(turn))

    def symbol(self, p: float, reach: float, wide: float) -> tuple[list[Line], list[Disc]]:  # noqa: ARG002
        """Return the arm and its end (see `Follower.symbol`)."""
        centre, ends = self._end(p)
        return [(self.pivot, centre)], ends

    def on_level(self, height: Array) -> Array:
        """Return positions on this side of the perpendicular to the x axis."""
        return np.arcsin((height - self.pivot.imag) / self.arm)

    def rest(self, x: Jet, y: Jet, grow: Array | float = 0.0, side: int = 1) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        angle, far = _polar(self.hand * (self.pivot.real - x), y - self.pivot.imag)
        reach = self.radius + grow
        # half the angle from the three sides: a round end may be tiny compared to the arm
        room = (reach - (far - self.arm)) * (reach + (far - self.arm))
        beyond = (far + self.arm - reach) * (far + self.arm + reach)
        overlaps = reach >= far.c[0] + self.arm
        beyond = Jet([np.where(overlaps, 1.0, beyond.c[0]), *beyond.c[1:]])
        turn = 2.0 * atan(sqrt(_at_least_0(room) / beyond))
        turn = Jet([np.where(overlaps, np.inf, turn.c[0]), *turn.c[1:]])
        return angle + side * turn, np.asarray(room.c[0])


@dataclass(frozen=True, kw_only=True)
class Face(Follower):
    """A follower with a flat face."""

    has_centre = False

    @abstractmethod
    def line(self, p: Values) -> tuple[Values, Values]:
        """Return the distance of the face from the origin, mm, and its derivative by p."""

    @abstractmethod
    def guided(self, turning: Jet, slope: Jet, along: Jet) -> tuple[Jet, Jet, Jet]:
        """Return the velocities of the pressure angle, and the place of contact on the face.

        Parameters
        ----------
        turning : Jet
            Angular rate of the face seen from the cam, clockwise.
        slope : Jet
            Derivative of its distance from the origin by the position.
        along : Jet, mm
            Distance of the contact from the foot of the origin on the face.

        Returns
        -------
        across, along, place : Jet
            See `Contact`.
        """

    def contact(self, carrier: Carrier, p: Jet, ds: Jet, inset: float) -> Contact:  # noqa: ARG002
        """Return the contact (see `Follower.contact`)."""
        height, slope = self.line(p)
        turning = carrier.rate - self.spin * ds
        reach = slope * ds / turning
        turning = turning.shortened()
        across, along, place = self.guided(turning, slope.shortened(), reach.shortened())
        speed = height.shortened() * turning + reach.differentiated()
        return Contact(
            across=across,
            along=along,
            turning=turning,
            pitch_speed=speed,
            speed=speed,
            place=place,
        )

    def trace(
        self,
        carrier: Carrier,
        x: Array,
        p: Array,
        ds: Array,
        inset: float,  # noqa: ARG002
    ) -> tuple[Plane, Plane]:
        """Return points and tangents (see `Follower.trace`)."""
        height, slope = self.line(p)
        tangents = unit(self.lean(p) - carrier.rate * x)
        return (slope * self.jump(carrier, p, ds) + 1j * height) * tangents, tangents

    def jump(self, carrier: Carrier, p: Array, ds: Array) -> Array:  # noqa: ARG002
        """Return the contact's distance from the foot over the slope (see `Follower.jump`)."""
        return ds / (carrier.rate - self.spin * ds)

    def velocity(self, carrier: Carrier, p: Array, jump: Array) -> Array:  # noqa: ARG002
        """Return the velocities in a jump (see `Follower.velocity`)."""
        return carrier.rate * jump / (1.0 + self.spin * jump)

    def jump_speed(self, carrier: Carrier, p: Array, inset: float) -> Array:  # noqa: ARG002
        """Return the derivative of the contact's distance (see `Follower.jump_speed`)."""
        return self.line(p)[1]


@dataclass(frozen=True, kw_only=True)
class FlatStem(Face):
    """A flat face square to a stem that is guided along the y axis.

    Parameters
    ----------
    offset : float, mm
        Distance of the guide from the origin; without influence on the cam.
    """

    offset: float = 0.0

    def held(self, friction: FrictionSpec, highest: float) -> Support:
        """Return its guide (see `Follower.held`)."""
        return _guide(1j, complex(self.offset), self.start + highest, friction)

    def distance(self, p: float) -> float:
        """Return the height of the face, mm."""
        return p

    def on_circle(self, radius: Array | float) -> Array:
        """Return the heights themselves."""
        return np.asarray(radius)

    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""
        return replace(self, start=-self.start)

    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the shift along the guide (see `Follower.moved`)."""
        return np.zeros_like(rise), np.asarray(1j * rise, dtype=np.complex128)

    def along_normal(self, p: Array, point: Plane, normal: Plane) -> tuple[Array, dict[str, Array]]:
        """Return what moves the face (see `Follower.along_normal`)."""
        foot = self.offset + 1j * p
        return normal.imag, {
            "offset": normal.real,
            "axis": _dot(normal, 1j * point),
            "face_angle": _dot(normal, 1j * (point - foot)),
        }

    def symbol(self, p: float, reach: float, wide: float) -> tuple[list[Line], list[Disc]]:
        """Return face and stem (see `Follower.symbol`)."""
        foot = complex(self.offset, p)
        return [(complex(-wide, p), complex(wide, p)), (foot, foot + 0.5j * reach)], []

    def rest(
        self,
        x: Jet,  # noqa: ARG002
        y: Jet,
        grow: Array | float = 0.0,
        side: int = 1,  # noqa: ARG002
    ) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        return y + grow, np.ones(np.shape(y.c[0]))

    def line(self, p: Values) -> tuple[Values, Values]:
        """Return the height and 1 (see `Face.line`)."""
        return p, 0.0 * p + 1.0

    def guided(self, turning: Jet, slope: Jet, along: Jet) -> tuple[Jet, Jet, Jet]:  # noqa: ARG002
        """Return no pressure angle, and the contact where it is (see `Face.guided`)."""
        return 0.0 * along, 0.0 * along + 1.0, along


@dataclass(frozen=True, kw_only=True)
class FlatArm(Face):
    """A flat face that swings about a pivot on the x axis.

    Parameters
    ----------
    pivot : float, mm
        Distance of the pivot from the cam's axis.
    offset : float, mm
        Distance of the face from the pivot, towards the cam.
    """

    pivot: float
    offset: float = 0.0

    angular = True
    pressure_limit = Arm.pressure_limit
    jamming_limit = Arm.jamming_limit

    @property
    def lever(self) -> float:
        """Millimetres per unit of lift, at the cam's axis."""
        return self.pivot

    @property
    def nearest(self) -> float:
        """Least distance from the origin to the face, mm, over all positions."""
        return max(0.0, -self.pivot - self.offset)

    def demand(self, program: Program) -> None:
        """Refuse a face that turns too far or falls too fast (see `Follower.demand`)."""
        across = "is perpendicular to the line of centres"
        _demand_within(self, program, (-_UPRIGHT, _UPRIGHT), across)
        slowest = program.range_of(1)[0]
        if not slowest > -1.0 + _STANDSTILL:
            what = "the face swings down faster than the cam turns: no profile can support it"
            share = rounded_down(-100.0 * (1.0 - 2.0 * _STANDSTILL) / slowest, 4)
            note = "value and limit are rad of swing per rad of the cam; lifts of less than "
            raise beyond_limit(what, "motion", slowest, -1.0, f"{note}{share} % of these work")

    def on_circle(self, radius: Array | float) -> Array:
        """Return positions at distances of the face from the origin."""
        return np.arcsin((radius + self.offset) / self.pivot)

    @property
    def clear(self) -> float:
        """Largest radius of a cam about the origin that does not reach past its pivot, mm."""
        return self.pivot - self.offset

    def held(self, friction: FrictionSpec, highest: float) -> Support:  # noqa: ARG002
        """Return its pivot (see `Follower.held`)."""
        return Pivot(at=self.pivot + 0j, spin=self.spin)

    def mass_point(self, p: Array, distance: float) -> Plane:
        """Return a point on the parallel to the face through the pivot (see `Follower`)."""
        return self.pivot - distance * unit(-p)

    def distance(self, p: float) -> float:
        """Return the distance of the face from the origin, mm."""
        return self.pivot * math.sin(p) - self.offset

    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""
        return replace(self, start=-self.start, offset=-self.offset)

    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the rotation about the pivot (see `Follower.moved`)."""
        return -rise, self.pivot * (1.0 - unit(-rise))

    def along_normal(self, p: Array, point: Plane, normal: Plane) -> tuple[Array, dict[str, Array]]:
        """Return what moves the face (see `Follower.along_normal`)."""
        return _dot(normal, -1j * (point - self.pivot)), {
            "pivot_distance": normal.real,
            "pivot_height": normal.imag,
            "face_offset": _dot(normal, -1j * unit(-p)),
        }

    def symbol(self, p: float, reach: float, wide: float) -> tuple[list[Line], list[Disc]]:  # noqa: ARG002
        """Return the face, and its distance from the pivot (see `Follower.symbol`)."""
        along = cmath.exp(-1j * p)
        foot = self.pivot - self.offset * 1j * along
        return [(complex(self.pivot), foot, foot - along * (self.pivot + 0.4 * reach))], []

    @property
    def spin(self) -> float:
        """Turn of the face per unit of position, rad."""
        return -1.0

    def rest(
        self,
        x: Jet,
        y: Jet,
        grow: Array | float = 0.0,
        side: int = 1,  # noqa: ARG002
    ) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        angle, far = _polar(self.pivot - x, y)
        face = self.offset + grow
        turn = asin(_within_1(face / far))
        turn = Jet([np.where(face > far.c[0], np.inf, turn.c[0]), *turn.c[1:]])
        return angle + turn, np.asarray(far.c[0] + face)

    def line(self, p: Values) -> tuple[Values, Values]:
        """Return the face as a line (see `Face.line`)."""
        sine, cosine = sin_cos(p)
        return self.pivot * sine - self.offset, self.pivot * cosine

    def guided(self, turning: Jet, slope: Jet, along: Jet) -> tuple[Jet, Jet, Jet]:  # noqa: ARG002
        """Return the distance of the contact from the pivot's foot (see `Face.guided`).

        That is ``d*cos(p) - along``, in a form that keeps all digits if the face falls nearly as
        fast as the cam turns.
        """
        place = slope / turning
        return 0.0 * place - self.offset, place, place


def _demand_within(
    follower: Follower, program: Program, limits: tuple[float, float], passing: str
) -> None:
    """Refuse an arm whose positions are not between two `limits`, rad, and say what it passes."""
    (low, high), (least, most) = (follower.start + lift for lift in program.range), limits
    if least < low and high < most:
        return
    position, limit = (low, least) if low <= least else (high, most)
    value, limit = (math.degrees(angle - follower.start) for angle in (position, limit))
    what, note = f"the arm swings too far: it {passing}", "value and limit are lifts"
    raise beyond_limit(what, "motion", value, limit, note, unit="deg")


def _polar(across: Jet, y: Jet) -> tuple[Jet, Jet]:
    """Return the angle of points seen from a pivot, rad, and their distance, mm."""
    far = sqrt(across * across + y * y)
    # an arctangent of half the angle stays finite at the height of the pivot
    return 2.0 * atan(y / (far + across)), far


def _dot(normal: Plane, moved: Plane) -> Array:
    """Return the components of movements along normals."""
    return (np.conj(normal) * moved).real


def _at_least_0(x: Jet) -> Jet:
    return Jet([np.maximum(x.c[0], 0.0), *x.c[1:]])


def _within_1(x: Jet) -> Jet:
    return Jet([np.clip(x.c[0], -1.0, 1.0), *x.c[1:]])
