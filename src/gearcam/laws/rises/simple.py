"""The elementary rises: constant velocity, constant acceleration, harmonic, cycloidal."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.laws.entry import LawEntry
from gearcam.laws.rises.base import NARROWEST, RISES, ClosedForm
from gearcam.laws.rises.pieces import from_half, lag, reflected
from gearcam.numeric.jets import Jet, sin
from gearcam.numeric.piecewise import Piece, Piecewise, piecewise
from gearcam.quantities import NUMBER, param


@dataclass(frozen=True, kw_only=True)
class ConstantVelocity(ClosedForm):
    """A straight line; a hard shock at both ends."""

    def function(self) -> Piecewise:
        """``S = phi``."""
        return piecewise([0.0, 1.0], [Piece(lambda x: x)])


@dataclass(frozen=True, kw_only=True)
class ConstantAcceleration(ClosedForm):
    """Two parabolas: constant acceleration up to q, then constant deceleration."""

    q: float = param(
        NUMBER,
        default=0.5,
        ge=NARROWEST,
        le=1.0 - NARROWEST,
        doc="part of the angle in which the follower accelerates",
    )

    def function(self) -> Piecewise:
        """``S = phi^2/q``, then ``S = 1 - (1 - phi)^2/(1 - q)``."""
        speeding, slowing = 1.0 / self.q, 1.0 / (1.0 - self.q)
        pieces = [
            Piece(lambda x: speeding * (x * x)),
            Piece(reflected(lambda x: slowing * (x * x))),
        ]
        return piecewise([0.0, self.q, 1.0], pieces)


@dataclass(frozen=True, kw_only=True)
class Harmonic(ClosedForm):
    """Simple harmonic motion: acceleration ``(pi^2/2)*cos(pi*phi)``."""

    def function(self) -> Piecewise:
        """``S = (1 - cos(pi*phi))/2``, which is ``sin(pi*phi/2)^2``."""

        def half(x: Jet) -> Jet:
            wave = sin((0.5 * math.pi) * x)
            return wave * wave

        return from_half([(0.5, half)])


@dataclass(frozen=True, kw_only=True)
class Cycloidal(ClosedForm):
    """A sine of acceleration: ``2*pi*sin(2*pi*phi)``."""

    def function(self) -> Piecewise:
        """``S = phi - sin(2*pi*phi)/(2*pi)``."""
        turn = 2.0 * math.pi
        return from_half([(0.5, lambda x: (1.0 / turn) * lag(turn * x))])


RISES.register(
    LawEntry(
        name="constant-velocity",
        example=ConstantVelocity(),
        doc="even speed, with a blow at both ends; only for very slow cams and feed motions",
        continuity="C0: the velocity jumps at both ends",
        source="000 section 3.3.3.1, fig. 3.12",
    ),
    LawEntry(
        name="constant-acceleration",
        example=ConstantAcceleration(),
        doc="least peak acceleration, but it jumps: slow to medium speeds",
        continuity="C1: the acceleration jumps at both ends and at q",
        source="000 section 3.3.3.1, fig. 3.13",
    ),
    LawEntry(
        name="harmonic",
        example=Harmonic(),
        doc="smooth for rise-return over the full turn without dwells; else slow to medium speeds",
        continuity="C1: the acceleration jumps at both ends",
        source="000 section 3.3.3.1, fig. 3.14",
    ),
    LawEntry(
        name="cycloidal",
        example=Cycloidal(),
        doc="no jump of acceleration between dwells: high speeds, if it is cut exactly",
        continuity="C2: the jerk jumps at both ends",
        source="000 section 3.3.3.1, fig. 3.15 (its S''' is to read 4*pi^2*cos)",
    ),
)
