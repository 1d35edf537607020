"""What joins two members of a linkage, or drives one: hinges, guides, drives.

Each has a few unknown forces and moments with which one member acts on another: a hinge a force of
any direction, a guide a force across it and a couple, a drive a moment or a force in the sense of
its motion. The equilibrium of the members gives them (see `gearcam.linkages.reactions`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.known import Known
from gearcam.linkages.plane import turning
from gearcam.numeric.arrays import Array, Plane

FORCES: Final = ("x", "y", "normal", "force", "tension")
"""Unknowns of bonds that are forces; the others are moments."""


class Wrench(NamedTuple):
    """A force and a moment at n angles of the driver.

    Attributes
    ----------
    force : (n,) complex array
        In the machine's frame.
    moment : (n,) array
        About the machine's origin, in mm times the unit of the force.
    """

    force: Plane
    moment: Array

    @classmethod
    def at(cls, point: Plane, force: Plane | complex) -> Wrench:
        """Return that of a `force` at a `point`, mm."""
        whole = force + np.zeros_like(point)
        return cls(whole, np.imag(np.conj(point) * whole))

    def times(self, factor: Array) -> Wrench:
        """Return `factor` times as much."""
        return Wrench(self.force * factor, self.moment * factor)

    @classmethod
    def couple(cls, size: Array) -> Wrench:
        """Return that of a couple."""
        return cls(np.zeros(size.shape, dtype=complex), size)


@dataclass(frozen=True, kw_only=True)
class Bond(ShortRepr, ABC):
    """What joins two members.

    Parameters
    ----------
    name : str
        Of the joint or the drive.
    on, by : str
        The member on which its forces act, and the one that exerts them.
    """

    unknowns: ClassVar[tuple[str, ...]]
    """Names of its forces and moments."""

    name: str
    on: str
    by: str

    @abstractmethod
    def units(self, known: Known) -> tuple[Wrench, ...]:
        """Return what a unit of each unknown exerts, with the motion that is `known`."""

    def works(self, known: Known) -> tuple[Array, ...]:
        """Return the work that a unit of each unknown takes from the drives per rad of the driver.

        Of what only guides it is 0.
        """
        return tuple(np.zeros(known.q.shape) for _ in self.unknowns)


@dataclass(frozen=True, kw_only=True)
class Hinge(Bond):
    """A hinge.

    Parameters
    ----------
    name, on, by : str
        See `Bond`.
    place : str
        The joint, or the member that begins there.
    driven : str
        Quantity that drives the length of `by`, a cylinder; empty if none does.
    """

    unknowns = ("x", "y")

    place: str
    driven: str = ""

    def units(self, known: Known) -> tuple[Wrench, ...]:
        """Return what the components of its force in the machine's frame exert (see `Bond`)."""
        point = known.place(self.place)
        return Wrench.at(point, 1.0), Wrench.at(point, 1j)

    def works(self, known: Known) -> tuple[Array, ...]:
        """Return the work of a cylinder (see `Bond`)."""
        if not self.driven:
            return super().works(known)
        way = known.direction(self.by) * known.rate(self.driven)
        return way.real, way.imag

    def turns(self, known: Known) -> Array:
        """Return by how much `on` turns against `by` per rad of the driver, (n,)."""
        return _turning(known, self.on) - _turning(known, self.by)


@dataclass(frozen=True, kw_only=True)
class SlidingJoint(Bond):
    """A straight guide.

    Parameters
    ----------
    name, on, by : str
        See `Bond`; `on` slides.
    guide : str
        Frame of the guide: its force is across the x axis, positive along y.
    place : str
        The joint, or the member that begins there, about which its couple is told.
    slide : str
        Quantity: the place on the guide.
    """

    unknowns = ("normal", "couple")

    guide: str
    place: str
    slide: str

    def units(self, known: Known) -> tuple[Wrench, ...]:
        """Return what its normal force and its couple exert (see `Bond`)."""
        across = Wrench.at(known.place(self.place), 1j * known.direction(self.guide))
        return across, Wrench.couple(np.ones(known.q.shape))

    def along(self, known: Known) -> Wrench:
        """Return what a unit of force along the guide exerts."""
        return Wrench.at(known.place(self.place), known.direction(self.guide))


@dataclass(frozen=True, kw_only=True)
class ShaftDrive(Bond):
    """A shaft that turns a member.

    Parameters
    ----------
    name, on, by : str
        See `Bond`.
    shaft : str
        Quantity: its turn, rad.
    """

    unknowns = ("moment",)

    shaft: str

    def units(self, known: Known) -> tuple[Wrench, ...]:
        """Return what its moment exerts (see `Bond`)."""
        return (Wrench.couple(np.ones(known.q.shape)),)

    def works(self, known: Known) -> tuple[Array, ...]:
        """Return its turn per rad of the driver (see `Bond`)."""
        return (known.rate(self.shaft),)


@dataclass(frozen=True, kw_only=True)
class PushDrive(Bond):
    """What pushes a member along its guide.

    Parameters
    ----------
    name, on, by : str
        See `Bond`.
    guide : str
        Frame of the guide.
    place : str
        The member's joint.
    way : str
        Quantity: the place on the guide, mm.
    """

    unknowns = ("force",)

    guide: str
    place: str
    way: str

    def units(self, known: Known) -> tuple[Wrench, ...]:
        """Return what its force exerts (see `Bond`)."""
        return (Wrench.at(known.place(self.place), known.direction(self.guide)),)

    def works(self, known: Known) -> tuple[Array, ...]:
        """Return its way per rad of the driver (see `Bond`)."""
        return (known.rate(self.way),)


@dataclass(frozen=True, kw_only=True)
class ChainDrive(Bond):
    """A chain that a wheel winds up.

    Parameters
    ----------
    name, on, by : str
        See `Bond`.
    place : str
        The joint at its end.
    center : complex, mm
        The wheel's centre.
    radius : float, mm
        Of the wheel, to the chain's middle.
    wind : float
        +1 if turning counter-clockwise winds up, else -1.
    shaft : str
        Quantity: the wheel's turn, rad.
    """

    unknowns = ("tension",)

    place: str
    center: complex
    radius: float
    wind: float
    shaft: str

    def units(self, known: Known) -> tuple[Wrench, ...]:
        """Return what its tension exerts (see `Bond`)."""
        end = known.place(self.place)
        away = end - self.center
        beside = self.wind * np.arccos(self.radius / np.abs(away))
        leaving = self.radius * np.exp(1j * beside) * away / np.abs(away)
        free = leaving - away
        return (Wrench.at(end, free / np.abs(free)),)

    def works(self, known: Known) -> tuple[Array, ...]:
        """Return the length that is wound up per rad of the driver (see `Bond`)."""
        return (self.radius * self.wind * known.rate(self.shaft),)


@dataclass(frozen=True, kw_only=True)
class SlotPin(Bond):
    """The pin in a slot of a Geneva wheel, and what locks the wheel while it rests.

    Parameters
    ----------
    name, on, by : str
        See `Bond`.
    center : str
        Joint in which the crank's shaft stands.
    length, start : float, mm and rad
        Of the crank, and its direction where the shaft's turn is 0.
    shaft, turn : str
        Quantities: turns of crank and wheel, rad.
    """

    unknowns = ("moment",)

    center: str
    length: float
    start: float
    shaft: str
    turn: str

    def units(self, known: Known) -> tuple[Wrench, ...]:
        """Return what a unit of moment about the wheel's centre exerts (see `Bond`).

        The pin presses across the slot; what locks the wheel at rest is taken as a couple.
        """
        turn = np.asarray(known.jet(self.shaft).c[0]) + self.start
        pin = known.place(self.center) + self.length * np.exp(1j * turn)
        arm = pin - known.place(self.on)
        pressed = Wrench.at(pin, 1j * arm / np.abs(arm) ** 2)
        rests = known.rate(self.turn) == 0.0
        moment = np.where(rests, 1.0, pressed.moment)
        return (Wrench(np.where(rests, 0.0, pressed.force), moment),)

    def works(self, known: Known) -> tuple[Array, ...]:
        """Return the wheel's turn per rad of the driver (see `Bond`)."""
        return (known.rate(self.turn),)


def _turning(known: Known, member: str) -> Array:
    """Return the turn of a member per rad of the driver, (n,)."""
    found = turning(known.frame(member).direction.upto(1))
    return np.asarray(found.c[0]) + np.zeros(known.q.shape)
