"""Elementary motion laws, and trapezoids of velocity and of acceleration."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gearcam.base.quantities import NUMBER, param
from gearcam.laws.entry import LawEntry
from gearcam.laws.motion.base import NARROWEST, ClosedForm
from gearcam.laws.motion.pieces import from_half, lag, reflected
from gearcam.numeric.jets import Jet, sin
from gearcam.numeric.piecewise import Piece, Piecewise, piecewise


@dataclass(frozen=True, kw_only=True)
class ConstantVelocity(ClosedForm):
    """Constant velocity, which jumps at both ends.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.ConstantVelocity()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.25, 1.0, 0.0]
    """

    def function(self) -> Piecewise:
        """``S = phi``."""
        return piecewise([0.0, 1.0], [Piece(lambda x: x)])


@dataclass(frozen=True, kw_only=True)
class ConstantAcceleration(ClosedForm):
    """Two parabolas: constant acceleration up to q, then constant deceleration.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.ConstantAcceleration(q=0.4)
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1562, 1.25, 5.0]
    """

    q: float = param(
        NUMBER,
        default=0.5,
        ge=NARROWEST,
        le=1.0 - NARROWEST,
        doc="share of the angle that accelerates",
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
    """Simple harmonic motion: acceleration ``(pi^2/2)*cos(pi*phi)``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Harmonic()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1464, 1.1107, 3.4894]
    """

    def function(self) -> Piecewise:
        """``S = (1 - cos(pi*phi))/2``, which is ``sin(pi*phi/2)^2``."""

        def half(x: Jet) -> Jet:
            wave = sin((0.5 * math.pi) * x)
            return wave * wave

        return from_half([(0.5, half)])


@dataclass(frozen=True, kw_only=True)
class Cycloidal(ClosedForm):
    """A sine of acceleration: ``2*pi*sin(2*pi*phi)``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Cycloidal()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.0908, 1.0, 6.2832]
    """

    def function(self) -> Piecewise:
        """``S = phi - sin(2*pi*phi)/(2*pi)``."""
        turn = 2.0 * math.pi
        return from_half([(0.5, lambda x: (1.0 / turn) * lag(turn * x))])


@dataclass(frozen=True, kw_only=True)
class TrapezoidalVelocity(ClosedForm):
    """Constant velocity ``1/(1 - q)`` between two sectors of constant acceleration, q wide each.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.TrapezoidalVelocity(q=0.3)
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1488, 1.1905, 4.7619]
    """

    q: float = param(
        NUMBER, default=0.125, ge=NARROWEST, le=0.5, doc="share of the angle to full velocity"
    )

    def function(self) -> Piecewise:
        """``S = phi^2/(2*q*(1 - q))``, then ``S = (phi - q/2)/(1 - q)``."""
        q, speed = self.q, 1.0 / (1.0 - self.q)
        return from_half(
            [(q, lambda x: (0.5 * speed / q) * (x * x)), (0.5 - q, lambda x: speed * (x - 0.5 * q))]
        )


@dataclass(frozen=True, kw_only=True)
class SineTrapezoidalVelocity(ClosedForm):
    """Constant velocity ``1/(1 - q)`` between two sectors of a half sine of acceleration.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.SineTrapezoidalVelocity(q=0.3)
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1445, 1.3329, 3.74]
    """

    q: float = param(
        NUMBER, default=0.125, ge=NARROWEST, le=0.5, doc="share of the angle to full velocity"
    )

    def function(self) -> Piecewise:
        """``S = (phi - (q/pi)*sin(pi*phi/q))/(2*(1 - q))``, then ``S = (phi - q/2)/(1 - q)``."""
        q, speed = self.q, 1.0 / (1.0 - self.q)
        return from_half(
            [
                (q, lambda x: (0.5 * speed * q / math.pi) * lag((math.pi / q) * x)),
                (0.5 - q, lambda x: speed * (x - 0.5 * q)),
            ]
        )


@dataclass(frozen=True, kw_only=True)
class TrapezoidalAcceleration(ClosedForm):
    """Two trapezoids of acceleration, ``A = 4/(1 - 2*q)`` high, with flanks q wide.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.TrapezoidalAcceleration(q=0.125)
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.0972, 1.0, 5.3333]
    """

    q: float = param(
        NUMBER,
        default=0.125,
        ge=NARROWEST,
        le=0.25,
        doc="share of the angle to full acceleration",
    )

    def function(self) -> Piecewise:
        """S of the three sectors in which S'' rises, stays at A, and falls through zero."""
        q, top = self.q, 4.0 / (1.0 - 2.0 * self.q)
        flat = 0.5 - 2.0 * q
        v1, s1 = 0.5 * top * q, top * q * q / 6.0
        v2, s2 = v1 + top * flat, s1 + flat * (v1 + 0.5 * top * flat)

        def constant(x: Jet) -> Jet:
            t = x - q
            return t * (0.5 * top * t + v1) + s1

        def falling(x: Jet) -> Jet:
            t = x - (0.5 - q)
            return t * (t * ((-top / (6.0 * q)) * t + 0.5 * top) + v2) + s2

        rising = (q, lambda x: (top / (6.0 * q)) * (x * x * x))
        return from_half([rising, (flat, constant), (q, falling)])


ENTRIES: Final = (
    LawEntry(
        name="constant-velocity",
        example=ConstantVelocity(),
        doc="constant velocity that starts and stops abruptly: only for very slow cams and feeds",
        continuity="C0: the velocity jumps at both ends",
        source="Duca, Buium, Paraoaru, section 3.3.3.1, fig. 3.12",
    ),
    LawEntry(
        name="constant-acceleration",
        example=ConstantAcceleration(),
        doc="lowest peak acceleration of all, but it jumps: low to medium speeds",
        continuity="C1: the acceleration jumps at both ends and at q",
        source="Duca, Buium, Paraoaru, section 3.3.3.1, fig. 3.13",
    ),
    LawEntry(
        name="harmonic",
        example=Harmonic(),
        doc="smooth for one rise and return a turn without dwells; else low to medium speeds",
        continuity="C1: the acceleration jumps at both ends",
        source="Duca, Buium, Paraoaru, section 3.3.3.1, fig. 3.14",
    ),
    LawEntry(
        name="cycloidal",
        example=Cycloidal(),
        doc="no jump of acceleration between dwells: high speeds, if the cam is cut accurately",
        continuity="C2: the jerk jumps at both ends",
        source="Duca, Buium, Paraoaru, section 3.3.3.1, fig. 3.15 (S''' corrected to 4*pi^2*cos)",
    ),
    LawEntry(
        name="trapezoidal-velocity",
        example=TrapezoidalVelocity(),
        doc="constant velocity over most of the lift without a jump of velocity: feeds and winding",
        continuity="C1: the acceleration jumps at both ends of each ramp of the velocity",
        source="Duca, Buium, Paraoaru, section 3.3.3.3, fig. 3.20",
    ),
    LawEntry(
        name="sine-trapezoidal-velocity",
        example=SineTrapezoidalVelocity(),
        doc="constant velocity over most of the lift, smooth start and stop: faster feeds",
        continuity="C2: the jerk jumps at both ends of each ramp of the velocity",
        source="Duca, Buium, Paraoaru, section 3.3.3.3, fig. 3.21 (sign of S' corrected)",
    ),
    LawEntry(
        name="trapezoidal-acceleration",
        example=TrapezoidalAcceleration(),
        doc="low peak acceleration without a jump: any speed, less demanding to cut than cycloidal",
        continuity="C2: the jerk jumps at the ends of the sectors",
        source="Duca, Buium, Paraoaru, section 3.3.3.3, fig. 3.22; Neklutin",
    ),
)
