"""A chain that a wheel winds up and that swings a lever: one root in the lever's angle.

The free length of the chain from the point where it leaves its wheel to the lever, less the length
wound on the wheel, falls as the wheel turns. This is a function of the lever's angle alone, so its
monotonic stretches are known once and for all, and so is the number of positions.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.elements import Carriers, Element
from gearcam.linkages.known import GROUND, Known
from gearcam.linkages.plane import Frame, rotation, square, towards
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import extremes
from gearcam.numeric.roots import newton_in_bracket

if TYPE_CHECKING:
    from gearcam.linkages.bonds import Bond

_SLACK: Final = 1e-9
"""How far a lever may be beyond its limits by rounding, rad, and as a share of the chain."""

_TURNED: Final = 1e-14
"""Accuracy of a root, rad."""


@dataclass(frozen=True, eq=False)
class LeverChain(ShortRepr, Element):
    """A chain between a wheel that stands still and a lever that it swings.

    Parameters
    ----------
    name : str
        Of the lever: its frame begins in its hinge, x towards the chain's joint.
    joint : str
        Name of the joint at the chain's end.
    shaft : str
        Quantity: the wheel's turn, rad.
    hinge, center : complex, mm
        Where the lever is hinged, and the wheel's centre.
    radius : float, mm
        Of the wheel, to the chain's middle.
    length : float, mm
        Of the lever, from the hinge to the joint.
    start : float, rad
        The lever's angle where the wheel's turn is 0.
    limits : (float, float), rad
        The lever's least and largest angle.
    wind : float
        +1 if turning counter-clockwise winds the chain up, -1 if clockwise.
    """

    needing = ("shaft",)
    giving = ("name", "joint")

    name: str
    joint: str
    shaft: str
    hinge: complex
    center: complex
    radius: float
    length: float
    start: float
    limits: tuple[float, float]
    wind: float = 1.0

    def free(self, angle: Jet) -> Jet:
        """Return the free length less the length on the wheel, mm.

        Parameters
        ----------
        angle : Jet
            The lever's angle, rad.
        """
        way = self.hinge - self.center + towards(angle) * self.length
        distance = square(way)
        free = jets.sqrt(distance - self.radius * self.radius)
        beside = cmath.phase(self.hinge - self.center + self.length * cmath.exp(1j * self.start))
        seen = rotation(way * cmath.exp(-1j * beside) / jets.sqrt(distance))
        leaving = seen + jets.acos(self.radius / jets.sqrt(distance)) * self.wind
        return free - leaving * (self.radius * self.wind)

    def values(self, angle: Array) -> tuple[Array, Array]:
        """Return `free` and its slope at angles (n,) of the lever, rad."""
        value, slope = self.free(Jet.variable(angle, 1)).derivatives()
        return value, slope

    @cached_property
    def stretch(self) -> tuple[float, float]:
        """The lever's angles round the start over which the chain's length is monotonic, rad."""
        low, high = self.limits
        places, _ = extremes(self.values, [low, high])
        below, above = places[places < self.start - _SLACK], places[places > self.start + _SLACK]
        return float(below.max(initial=low)), float(above.min(initial=high))

    def _ends(self) -> tuple[float, float, float]:
        """Return the chain's length at both ends of the stretch and at the start, mm."""
        low, high = self.stretch
        first, last, start = self.values(np.array([low, high, self.start]))[0].tolist()
        return first, last, start

    def _wanted(self, known: Known) -> Jet:
        return self._ends()[2] - known.jet(self.shaft) * (self.radius * self.wind)

    def room(self, known: Known) -> tuple[Jet, ...]:
        """Return how far the wanted length is from those at the ends of the stretch, as shares."""
        low, high, _ = self._ends()
        wanted, whole = self._wanted(known), high - low
        return (wanted - low) / whole + _SLACK, (high - wanted) / whole + _SLACK

    def solve(self, known: Known) -> None:
        """Add the lever and the chain's joint."""
        (low, high), (first, last, _) = self.stretch, self._ends()
        wanted = self._wanted(known)
        target, rises = np.asarray(wanted.c[0]), 1.0 if last > first else -1.0

        def miss(angle: Array) -> tuple[Array, Array]:
            value, slope = self.values(angle)
            return rises * (value - target), rises * slope

        ends = np.full(target.shape, low), np.full(target.shape, high)
        at = newton_in_bracket(miss, *ends, np.full(target.shape, self.start), _TURNED)
        slope = self.values(at)[1]
        angle = Jet([at, *[0.0] * known.order])
        # each step with the slope at the root makes one derivative more exact
        for _ in range(known.order):
            angle = angle - (self.free(angle) - wanted) / slope
        frame = Frame(known.constant(self.hinge), towards(angle))
        known.given[self.name] = frame
        known.given[self.joint] = frame.at(complex(self.length))

    def carried(self, carriers: Carriers) -> Carriers:
        """Return the lever (see `Element`)."""
        del carriers
        return {self.name: self.name, self.joint: self.name}

    def bonds(self, carriers: Carriers) -> Iterator[Bond]:
        """Yield the lever's hinge and the chain (see `Element`)."""
        from gearcam.linkages.bonds import ChainDrive, Hinge  # motion needs none

        del carriers
        yield Hinge(name=f"{self.name}.hinge", on=self.name, by=GROUND, place=self.name)
        yield ChainDrive(
            name=self.joint,
            on=self.name,
            by=GROUND,
            place=self.joint,
            center=self.center,
            radius=self.radius,
            wind=self.wind,
            shaft=self.shaft,
        )


def roots_in(chain: LeverChain, turn: float) -> int:
    """Return how many positions of the lever within its limits fit a turn of the wheel.

    Parameters
    ----------
    chain : LeverChain
        The chain with its lever.
    turn : float, rad
        Of the wheel.

    Returns
    -------
    int
    """
    _, values = extremes(chain.values, list(chain.limits))
    target = chain.values(np.array([chain.start]))[0] - turn * chain.radius * chain.wind
    beyond = np.sign(values - target)
    return int(np.count_nonzero(beyond[1:] != beyond[:-1]))
