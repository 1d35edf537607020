"""Followers with a flat face: square to a stem that is guided straight, or on an arm."""

from __future__ import annotations

import cmath
import math
from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import rounded_down
from gearcam.cams.carriers import Carrier, unit
from gearcam.cams.followers.base import UPRIGHT, Contact, Follower, Symbol, Values, dot, polar
from gearcam.cams.followers.rounds import Arm
from gearcam.laws.program import Program
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.supports import Pivot, Support, guide
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.jets import Jet, asin, sin_cos

_STANDSTILL = 1e-7
"""Least relative difference of a face's downward speed from the cam's: below it the contact is a
million pivot distances away, or stays at one point."""


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
        return guide(1j, complex(self.offset), self.start + highest, friction)

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
            "axis": dot(normal, 1j * point),
            "face_angle": dot(normal, 1j * (point - foot)),
        }

    def symbol(self, p: float, reach: float, wide: float) -> Symbol:
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
        self.demand_within(program, (-UPRIGHT, UPRIGHT), across)
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
        return dot(normal, -1j * (point - self.pivot)), {
            "pivot_distance": normal.real,
            "pivot_height": normal.imag,
            "face_offset": dot(normal, -1j * unit(-p)),
        }

    def symbol(self, p: float, reach: float, wide: float) -> Symbol:  # noqa: ARG002
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
        angle, far = polar(self.pivot - x, y)
        face = self.offset + grow
        share = face / far
        turn = asin(Jet([np.clip(share.c[0], -1.0, 1.0), *share.c[1:]]))
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
