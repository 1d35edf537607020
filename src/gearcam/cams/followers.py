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

Sources: 000 eqs. (3.17), (3.21), (3.26), (3.30), (3.33), section 3.4.4; derived anew.
"""

from __future__ import annotations

import cmath
import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from gearcam.base.display import Brief
from gearcam.cams.carriers import Carrier, Pair, unit
from gearcam.cams.contact import Contact
from gearcam.numeric.arrays import Array, Mask, Plane
from gearcam.numeric.jets import Jet, asin, atan, cos, sin_cos, sqrt


@dataclass(frozen=True, kw_only=True)
class Follower(Brief, ABC):
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

    angular: ClassVar[bool]
    """Whether positions and lifts are angles."""

    @property
    @abstractmethod
    def lever(self) -> float:
        """Millimetres per unit of lift."""

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

    @property
    def clear(self) -> float:
        """Largest radius of a cam about the origin that does not reach past its pivot, mm."""
        return math.inf

    def behind(self, z: Plane, grow: Array | float) -> Mask:  # noqa: ARG002
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
        return np.zeros(z.shape, dtype=np.bool_)

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
    def symbol(self, p: float, reach: float, wide: float) -> list[tuple[complex, ...]]:
        """Return lines that show the follower, mm; a round end is shown besides.

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


@dataclass(frozen=True, kw_only=True)
class Round(Follower):
    """A follower with a round end: a roller, a dome, or a point."""

    @property
    @abstractmethod
    def spin(self) -> float:
        """Rotating of its direction per unit of position, rad."""

    @abstractmethod
    def centre(self, p: Array) -> Plane:
        """Return the centre, mm, at positions (n,)."""

    @abstractmethod
    def lean(self, p: Array) -> Array | float:
        """Return the angle of its direction at positions (n,), rad, from that of the y axis."""

    @abstractmethod
    def on_circle(self, radius: Array) -> Array:
        """Return positions (n,) with the centre on circles about the origin, mm."""

    @abstractmethod
    def on_level(self, height: Array) -> Array:
        """Return positions (n,) with the centre at heights, mm."""

    @abstractmethod
    def axes(self, p: Jet) -> tuple[Pair, Pair]:
        """Return ``i*conj(t)`` and ``conj(t)*C`` for the centre C and the direction t."""

    def _moving(self, carrier: Carrier, p: Jet, ds: Jet) -> tuple[Jet, Jet]:
        """Return A and B (see the module)."""
        a, b = carrier.seen(*self.axes(p))
        return a if isinstance(a, Jet) else 0.0 * p + a, b + self.lever * ds

    def contact(self, carrier: Carrier, p: Jet, ds: Jet, inset: float) -> Contact:
        """Return the contact (see `Follower.contact`)."""
        across, against = self._moving(carrier, p, ds)
        a, b, a_slope, b_slope = (
            across.shortened(),
            against.shortened(),
            across.differentiated(),
            against.differentiated(),
        )
        square = a * a + b * b
        turning = (carrier.rate - self.spin * ds.shortened()) - (a * b_slope - b * a_slope) / square
        speed = sqrt(square)
        return Contact(
            across=b,
            along=a,
            turning=turning,
            pitch_speed=speed,
            speed=speed - inset * turning,
            place=0.0 * a,
        )

    def trace(
        self, carrier: Carrier, x: Array, p: Array, ds: Array, inset: float
    ) -> tuple[Plane, Plane]:
        """Return points and tangents (see `Follower.trace`)."""
        a, b = (jet.c[0] for jet in self._moving(carrier, Jet([p]), Jet([ds])))
        tangents = (a + 1j * b) / np.hypot(a, b) * unit(self.lean(p) - carrier.rate * x)
        return carrier.under(x, self.centre(p)) - 1j * inset * tangents, tangents

    def jump(self, carrier: Carrier, p: Array, ds: Array) -> Array:
        """Return the parameter of a jump (see `Follower.jump`)."""
        a, b = (jet.c[0] for jet in self._moving(carrier, Jet([p]), Jet([ds])))
        return np.arctan(b / np.abs(a))

    def velocity(self, carrier: Carrier, p: Array, jump: Array) -> Array:
        """Return the velocities in a jump (see `Follower.velocity`)."""
        a, b = (jet.c[0] for jet in self._moving(carrier, Jet([p]), Jet([np.zeros_like(p)])))
        return (np.abs(a) * np.tan(jump) - b) / self.lever

    def jump_speed(self, carrier: Carrier, p: Array, inset: float) -> Array:
        """Return the speed around the centre (see `Follower.jump_speed`)."""
        return inset * np.sign(self._moving(carrier, Jet([p]), Jet([np.zeros_like(p)]))[0].c[0])


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

    angular = False

    @property
    def spin(self) -> float:
        """Rotating of its direction per unit of position, rad."""
        return 0.0

    @property
    def lever(self) -> float:
        """Millimetres per unit of lift."""
        return 1.0

    def centre(self, p: Array) -> Plane:
        """Return the centre, mm."""
        return np.asarray(cmath.exp(1j * self.tilt) * (self.offset + 1j * p), dtype=np.complex128)

    def lean(self, p: Array) -> float:  # noqa: ARG002
        """Return the tilt."""
        return self.tilt

    def axes(self, p: Jet) -> tuple[Pair, Pair]:
        """Return ``exp(-i*tilt)`` and ``p - i*offset``."""
        return (math.cos(self.tilt), -math.sin(self.tilt)), (p, -self.offset)

    def on_circle(self, radius: Array) -> Array:
        """Return positions above the origin."""
        return np.sqrt((radius - self.offset) * (radius + self.offset))

    def distance(self, p: float) -> float:
        """Return the distance of its centre from the origin, mm."""
        return math.hypot(self.offset, p)

    def behind(self, z: Plane, grow: Array | float) -> Mask:
        """Return which discs lie above one below the axis (see `Follower.behind`)."""
        return np.full(z.shape, self.start < 0.0) & (z.imag - grow > 0.0)

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

    def symbol(self, p: float, reach: float, wide: float) -> list[tuple[complex, ...]]:  # noqa: ARG002
        """Return the stem (see `Follower.symbol`)."""
        centre = complex(self.centre(np.array(p)))
        up = math.copysign(0.5 * reach, self.start) * 1j * cmath.exp(1j * self.tilt)
        return [(centre, centre + up)]

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

    @property
    def lever(self) -> float:
        """Millimetres per unit of lift."""
        return self.arm

    @property
    def spin(self) -> float:
        """Rotating of its direction per unit of position, rad."""
        return -float(self.hand)

    def centre(self, p: Array) -> Plane:
        """Return the centre, mm."""
        return self.pivot - (self.hand * self.arm) * unit(-self.hand * p)

    def lean(self, p: Array) -> Array:
        """Return the angle of its direction from the y axis, rad."""
        return -self.hand * p

    def axes(self, p: Jet) -> tuple[Pair, Pair]:
        """Return ``exp(i*hand*p)``, and ``i*hand*arm - i*exp(i*hand*p)*pivot``.

        Of the angle itself: the centre's coordinates would lose the digits of the first part, whose
        sign says on which side of the axis the centre is.
        """
        (s, c), x, y = sin_cos(p), self.pivot.real, self.pivot.imag
        s = self.hand * s
        across, against = x * s, -x * c
        if y:
            across, against = across + y * c, against + y * s
        return (c, s), (across, against + self.hand * self.arm)

    def on_circle(self, radius: Array) -> Array:
        """Return positions above the origin, of a pivot on the x axis."""
        return swing(self.pivot.real, self.arm, radius)

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
        return np.full(z.shape, self.start < 0.0) & (z.imag - grow > 0.0)

    def on_chord(self, z: Plane, chord: Plane, grow: Array | float) -> Array:
        """Return the place between the ends (see `Follower.on_chord`)."""
        length = np.abs(chord)
        from_pivot = (z - self.pivot) * np.conj(chord / length)
        beside = self.radius + grow - from_pivot.imag
        room = (self.arm - beside) * (self.arm + beside)
        way = (self.hand * np.sqrt(np.maximum(room, 0.0)) - from_pivot.real) / length
        return np.where(room >= 0.0, way, np.nan)

    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""
        return replace(self, start=-self.start, pivot=self.pivot.conjugate())

    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the rotation about the pivot (see `Follower.moved`)."""
        turn = -self.hand * rise
        return turn, self.pivot * (1.0 - unit(turn))

    def symbol(self, p: float, reach: float, wide: float) -> list[tuple[complex, ...]]:  # noqa: ARG002
        """Return the arm (see `Follower.symbol`)."""
        return [(self.pivot, complex(self.centre(np.array(p))))]

    def on_level(self, height: Array) -> Array:
        """Return positions on this side of the perpendicular to the x axis."""
        return np.arcsin((height - self.pivot.imag) / self.arm)

    def rest(self, x: Jet, y: Jet, grow: Array | float = 0.0, side: int = 1) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        seen, far = _seen(self.hand * (self.pivot.real - x), y - self.pivot.imag)
        reach = self.radius + grow
        # half the angle from the three sides: a round end may be tiny compared to the arm
        room = (reach - (far - self.arm)) * (reach + (far - self.arm))
        beyond = (far + self.arm - reach) * (far + self.arm + reach)
        overlaps = reach >= far.c[0] + self.arm
        beyond = Jet([np.where(overlaps, 1.0, beyond.c[0]), *beyond.c[1:]])
        turn = 2.0 * atan(sqrt(_at_least_0(room) / beyond))
        turn = Jet([np.where(overlaps, np.inf, turn.c[0]), *turn.c[1:]])
        return seen + side * turn, np.asarray(room.c[0])


@dataclass(frozen=True, kw_only=True)
class Face(Follower):
    """A follower with a flat face."""

    @abstractmethod
    def line(self, p: Jet, ds: Jet) -> tuple[Jet, Jet, Jet]:
        """Return the face as a line in the fixed frame.

        Parameters
        ----------
        p, ds : Jet
            Position and velocity of the follower.

        Returns
        -------
        height, rise, turning : Jet
            Distance from the origin, mm, its derivative, and the angular rate clockwise, rad per
            unit of x.
        """

    @abstractmethod
    def guided(self, p: Jet, turning: Jet, along: Jet) -> tuple[Jet, Jet, Jet]:
        """Return the velocities of the pressure angle, and the place of contact on the face.

        Parameters
        ----------
        p, turning : Jet
            Position, and angular rate of the face seen from the cam.
        along : Jet, mm
            Distance of the contact from the foot of the origin on the face.

        Returns
        -------
        across, along, place : Jet
            See `gearcam.cams.contact.Contact`.
        """

    def contact(self, carrier: Carrier, p: Jet, ds: Jet, inset: float) -> Contact:  # noqa: ARG002
        """Return the contact (see `Follower.contact`)."""
        height, rise, clockwise = self.line(p, ds)
        turning = carrier.rate + clockwise
        reach = rise / turning
        turning = turning.shortened()
        across, along, place = self.guided(p.shortened(), turning, reach.shortened())
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
        height, rise, clockwise = (jet.c[0] for jet in self.line(Jet([p]), Jet([ds])))
        tangents = unit(self.lean(p) - carrier.rate * x)
        return (rise / (carrier.rate + clockwise) + 1j * height) * tangents, tangents

    @abstractmethod
    def lean(self, p: Array) -> Array | float:
        """Return the angle of the face at positions (n,), rad, from that of the x axis."""


@dataclass(frozen=True, kw_only=True)
class FlatStem(Face):
    """A flat face square to a stem that is guided along the y axis.

    Parameters
    ----------
    offset : float, mm
        Distance of the guide from the origin; without influence on the cam.
    """

    offset: float = 0.0

    angular = False

    @property
    def lever(self) -> float:
        """Millimetres per unit of lift."""
        return 1.0

    def distance(self, p: float) -> float:
        """Return the height of the face, mm."""
        return p

    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""
        return replace(self, start=-self.start)

    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the shift along the guide (see `Follower.moved`)."""
        return np.zeros_like(rise), np.asarray(1j * rise, dtype=np.complex128)

    def symbol(self, p: float, reach: float, wide: float) -> list[tuple[complex, ...]]:
        """Return face and stem (see `Follower.symbol`)."""
        foot = complex(self.offset, p)
        return [(complex(-wide, p), complex(wide, p)), (foot, foot + 0.5j * reach)]

    def lean(self, p: Array) -> float:  # noqa: ARG002
        """Return 0: the face is level."""
        return 0.0

    def rest(
        self,
        x: Jet,  # noqa: ARG002
        y: Jet,
        grow: Array | float = 0.0,
        side: int = 1,  # noqa: ARG002
    ) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        return y + grow, np.ones(np.shape(y.c[0]))

    def line(self, p: Jet, ds: Jet) -> tuple[Jet, Jet, Jet]:
        """Return the face as a line (see `Face.line`)."""
        return p, ds, 0.0 * ds

    def guided(self, p: Jet, turning: Jet, along: Jet) -> tuple[Jet, Jet, Jet]:
        """Return no pressure angle, and the contact where it is (see `Face.guided`)."""
        return 0.0 * p, 0.0 * turning + 1.0, along

    def jump(self, carrier: Carrier, p: Array, ds: Array) -> Array:  # noqa: ARG002
        """Return the velocity itself (see `Follower.jump`)."""
        return ds

    def velocity(self, carrier: Carrier, p: Array, jump: Array) -> Array:  # noqa: ARG002
        """Return the parameter itself (see `Follower.velocity`)."""
        return jump

    def jump_speed(self, carrier: Carrier, p: Array, inset: float) -> Array:  # noqa: ARG002
        """Return 1, as the velocity is the place (see `Follower.jump_speed`)."""
        return np.ones_like(p)


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

    @property
    def lever(self) -> float:
        """Millimetres per unit of lift, at the cam's axis."""
        return self.pivot

    @property
    def clear(self) -> float:
        """Largest radius of a cam about the origin that does not reach past its pivot, mm."""
        return self.pivot - self.offset

    def distance(self, p: float) -> float:
        """Return the distance of the face from the origin, mm."""
        return self.pivot * math.sin(p) - self.offset

    def mirrored(self) -> Self:
        """Return its mirror image in the x axis."""
        return replace(self, start=-self.start, offset=-self.offset)

    def moved(self, rise: Array) -> tuple[Array, Plane]:
        """Return the rotation about the pivot (see `Follower.moved`)."""
        return -rise, self.pivot * (1.0 - unit(-rise))

    def symbol(self, p: float, reach: float, wide: float) -> list[tuple[complex, ...]]:  # noqa: ARG002
        """Return the face, and its distance from the pivot (see `Follower.symbol`)."""
        along = cmath.exp(-1j * p)
        foot = self.pivot - self.offset * 1j * along
        return [(complex(self.pivot), foot, foot - along * (self.pivot + 0.4 * reach))]

    def lean(self, p: Array) -> Array:
        """Return the angle of the face, rad."""
        return -p

    def rest(
        self,
        x: Jet,
        y: Jet,
        grow: Array | float = 0.0,
        side: int = 1,  # noqa: ARG002
    ) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        seen, far = _seen(self.pivot - x, y)
        face = self.offset + grow
        turn = asin(_within_1(face / far))
        turn = Jet([np.where(face > far.c[0], np.inf, turn.c[0]), *turn.c[1:]])
        return seen + turn, np.asarray(far.c[0] + face)

    def line(self, p: Jet, ds: Jet) -> tuple[Jet, Jet, Jet]:
        """Return the face as a line (see `Face.line`)."""
        s, c = sin_cos(p)
        return self.pivot * s - self.offset, self.pivot * c * ds, ds

    def guided(self, p: Jet, turning: Jet, along: Jet) -> tuple[Jet, Jet, Jet]:  # noqa: ARG002
        """Return the distance of the contact from the pivot's foot (see `Face.guided`).

        That is ``d*cos(p) - along``, in a form that keeps all digits if the face falls nearly as
        fast as the cam turns.
        """
        place = self.pivot * cos(p) / turning
        return 0.0 * place - self.offset, place, place

    def jump(self, carrier: Carrier, p: Array, ds: Array) -> Array:  # noqa: ARG002
        """Return the place of contact over its distance at rest (see `Follower.jump`)."""
        return ds / (carrier.rate + ds)

    def velocity(self, carrier: Carrier, p: Array, jump: Array) -> Array:  # noqa: ARG002
        """Return the velocities in a jump (see `Follower.velocity`)."""
        return carrier.rate * jump / (1.0 - jump)

    def jump_speed(self, carrier: Carrier, p: Array, inset: float) -> Array:  # noqa: ARG002
        """Return the length of the face to the pivot's foot (see `Follower.jump_speed`)."""
        return self.pivot * np.cos(p)


def swing(pivot: float, arm: float, size: Array | float) -> Array:
    """Return Psi, rad, of an arm with its end at given distances from the cam's axis.

    Parameters
    ----------
    pivot, arm : float, mm
        Axis to pivot; arm.
    size : (n,) array, mm
        Arm's end to axis.
    """
    # half the angle from the sides, with parentheses (after Kahan) that keep all digits if the
    # triangle is nearly flat
    small, large = sorted([pivot, arm])
    apart = large - small
    half = np.arctan2(
        np.sqrt((size - apart) * (size + apart)),
        np.sqrt((small - (size - large)) * (small + (size + large))),
    )
    return 2.0 * half


def _seen(across: Jet, y: Jet) -> tuple[Jet, Jet]:
    """Return the angle of points seen from a pivot, rad, and their distance, mm."""
    far = sqrt(across * across + y * y)
    # an arctangent of half the angle stays finite at the height of the pivot
    return 2.0 * atan(y / (far + across)), far


def _at_least_0(x: Jet) -> Jet:
    return Jet([np.maximum(x.c[0], 0.0), *x.c[1:]])


def _within_1(x: Jet) -> Jet:
    return Jet([np.clip(x.c[0], -1.0, 1.0), *x.c[1:]])
