"""Followers with a round end: on a stem that is guided straight, or on an arm."""

from __future__ import annotations

import cmath
import math
from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from gearcam.cams.carriers import Carrier, Pair, unit
from gearcam.cams.followers.base import UPRIGHT, Contact, Follower, Symbol, Values, dot, polar
from gearcam.laws.program import Program
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.supports import Pivot, Support, guide
from gearcam.numeric.arrays import Array, Mask, Plane
from gearcam.numeric.jets import Jet, atan, sin_cos, sqrt


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

    def _end(self, p: float) -> tuple[complex, list[tuple[complex, float]]]:
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
        return dot(normal, by_position), round_end | {
            name: dot(normal, moved) for name, moved in by_size.items()
        }

    @abstractmethod
    def on_level(self, height: Array) -> Array:
        """Return positions (n,) with the centre at heights, mm."""

    @abstractmethod
    def axes(self, p: Jet | Array) -> tuple[Pair, Pair]:
        """Return ``i*conj(t)`` and ``conj(t)*C`` for the centre C and the direction t."""

    def _moving(self, carrier: Carrier, p: Values, ds: Values) -> tuple[Values, Values]:
        """Return A and B (see the package)."""
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
        return guide(1j * turn, self.offset * turn, self.start + highest + self.radius, friction)

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

    def symbol(self, p: float, reach: float, wide: float) -> Symbol:  # noqa: ARG002
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
            self.demand_within(program, (0.0, self.highest), "passes the line of centres")
        else:
            across = "gets perpendicular to the cam's travel"
            self.demand_within(program, (-UPRIGHT, UPRIGHT), across)

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
            "arm": out,
            "pivot_distance": self.hand * still,
            "pivot_height": 1j * still,
        }

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

    def symbol(self, p: float, reach: float, wide: float) -> Symbol:  # noqa: ARG002
        """Return the arm and its end (see `Follower.symbol`)."""
        centre, ends = self._end(p)
        return [(self.pivot, centre)], ends

    def on_level(self, height: Array) -> Array:
        """Return positions on this side of the perpendicular to the x axis."""
        return np.arcsin((height - self.pivot.imag) / self.arm)

    def rest(self, x: Jet, y: Jet, grow: Array | float = 0.0, side: int = 1) -> tuple[Jet, Array]:
        """Return the position on discs (see `Follower.rest`)."""
        angle, far = polar(self.hand * (self.pivot.real - x), y - self.pivot.imag)
        reach = self.radius + grow
        # half the angle from the three sides: a round end may be tiny compared to the arm
        room = (reach - (far - self.arm)) * (reach + (far - self.arm))
        beyond = (far + self.arm - reach) * (far + self.arm + reach)
        overlaps = reach >= far.c[0] + self.arm
        beyond = Jet([np.where(overlaps, 1.0, beyond.c[0]), *beyond.c[1:]])
        turn = 2.0 * atan(sqrt(_at_least_0(room) / beyond))
        turn = Jet([np.where(overlaps, np.inf, turn.c[0]), *turn.c[1:]])
        return angle + side * turn, np.asarray(room.c[0])


def _at_least_0(x: Jet) -> Jet:
    return Jet([np.maximum(x.c[0], 0.0), *x.c[1:]])
