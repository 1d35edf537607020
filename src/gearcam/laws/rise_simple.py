"""The elementary rises: constant velocity, constant acceleration, harmonic, cycloidal."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.laws.rise_pieces import from_half, lag, reflected
from gearcam.laws.rises import NARROWEST, RISES, ClosedForm, RiseClaim, RiseEntry
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


def _claims_velocity() -> tuple[RiseClaim, ...]:
    return (
        RiseClaim(
            parameters=ConstantVelocity(),
            values={0.0: 0.0, 0.3: 0.3, 0.75: 0.75, 1.0: 1.0},
            velocities={0.0: 1.0, 0.5: 1.0, 1.0: 1.0},
            peak_velocity=1.0,
            peak_acceleration=math.inf,
            peak_jerk=math.inf,
            continuity=0,
        ),
    )


def _claims_acceleration() -> tuple[RiseClaim, ...]:
    """000 fig. 3.13; the velocity's triangle is 2 high whatever q."""
    return (
        RiseClaim(
            parameters=ConstantAcceleration(),
            values={0.25: 0.125, 0.5: 0.5, 0.75: 0.875},
            velocities={0.25: 1.0, 0.5: 2.0, 0.75: 1.0},
            peak_velocity=2.0,
            peak_acceleration=4.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
        RiseClaim(
            parameters=ConstantAcceleration(q=0.8),
            values={0.4: 0.2, 0.8: 0.8, 0.9: 0.95},
            velocities={0.4: 1.0, 0.8: 2.0, 0.9: 1.0},
            peak_velocity=2.0,
            peak_acceleration=10.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def _claims_harmonic() -> tuple[RiseClaim, ...]:
    return (
        RiseClaim(
            parameters=Harmonic(),
            values={1 / 3: 0.25, 0.5: 0.5, 2 / 3: 0.75},
            velocities={0.0: 0.0, 1 / 6: math.pi / 4, 0.5: math.pi / 2},
            peak_velocity=math.pi / 2,
            peak_acceleration=math.pi**2 / 2,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def _claims_cycloidal() -> tuple[RiseClaim, ...]:
    quarter = 0.25 - 0.5 / math.pi
    return (
        RiseClaim(
            parameters=Cycloidal(),
            values={0.25: quarter, 0.5: 0.5, 0.75: 1.0 - quarter},
            velocities={0.0: 0.0, 0.25: 1.0, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=2 * math.pi,
            peak_jerk=4 * math.pi**2,
            continuity=2,
        ),
    )


RISES.hang(
    RiseEntry(
        name="constant-velocity",
        parameters=ConstantVelocity,
        doc="even speed, with a blow at both ends; only for very slow cams and feed motions",
        continuity="C0: the velocity jumps at both ends",
        source="000 section 3.3.3.1, fig. 3.12",
        claims=_claims_velocity,
    )
)
RISES.hang(
    RiseEntry(
        name="constant-acceleration",
        parameters=ConstantAcceleration,
        doc="least peak acceleration, but it jumps: slow to medium speeds",
        continuity="C1: the acceleration jumps at both ends and at q",
        source="000 section 3.3.3.1, fig. 3.13",
        claims=_claims_acceleration,
    )
)
RISES.hang(
    RiseEntry(
        name="harmonic",
        parameters=Harmonic,
        doc="smooth for rise-return over the full turn without dwells; else slow to medium speeds",
        continuity="C1: the acceleration jumps at both ends",
        source="000 section 3.3.3.1, fig. 3.14",
        claims=_claims_harmonic,
    )
)
RISES.hang(
    RiseEntry(
        name="cycloidal",
        parameters=Cycloidal,
        doc="no jump of acceleration between dwells: high speeds, if it is cut exactly",
        continuity="C2: the jerk jumps at both ends",
        source="000 section 3.3.3.1, fig. 3.15 (its S''' is to read 4*pi^2*cos)",
        claims=_claims_cycloidal,
    )
)
