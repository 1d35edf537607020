"""The loads of a follower: springs, given loads, inertia and gravity, and the spring that holds it.

Everything is *against* a rise: N along a guide, N mm about a pivot. Weight and inertia also press
on the support, and rub there. A cam that only presses keeps its follower where

    Q + sigma*G(0) >= 0

(`gearcam.mechanics.supports`): Q is the sum of the loads, sigma the sign of the velocity, and G(0)
that friction. It presses a rising follower onto the cam, and holds one that returns back from it.
So the spring that just holds the follower is an extreme of the rest, which is all else in that sum,

    preload = max(-(rest + k*s)),        stiffness = max(-(rest + F0)/s),

and the speed W at which a given spring lets go is the least with ``a + b*W**2 + sigma*G(0) = 0``: a
are the loads at rest, and b is the inertia times s''. In a guide G(0) does not depend on the speed,
and ``W**2`` is ``(a + sigma*G(0))/(-b)``. On a pivot it is ``r*abs(P - W**2*H)`` with the weight P
and the mass times acceleration H, and ``W**2`` the root of a square. Extremes lie at knots or are
enclosed between neighbouring samples and divided until rounding: exact where they lie at a knot, as
for a harmonic motion.

Sources: classical (Norton, Rothbart); 000 section 3.5.

Depends on supports and laws; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.laws.program import Program
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.load import LoadSpec
from gearcam.mechanics.mass import MassSpec
from gearcam.mechanics.spring import SpringSpec
from gearcam.mechanics.supports import Support, TotalLoad
from gearcam.numeric.arrays import Array, Plane, distinct

_SAMPLES = 65
"""Samples of each smooth piece; between neighbours there is one extreme at most, as a rule."""

_ROUNDS = 6
"""Divisions of the space around an extreme by a sixteenth: below 1e-8 of a piece."""

_BARELY = 1e-9
"""Lift over the largest below which a stiffness does nothing."""

_AT_REST = 1e-12
"""Velocity over the largest below which the follower is at rest: rounding."""

_INSIDE = 1e-3
"""Way from an end of a piece to its middle at which it has its direction of motion."""

_TRIED = 100
"""Speeds at which a damped follower is looked at, a fourteenth apart."""

_ROUNDING = 1e-12
"""Load over that at rest that is rounding."""

MM = 1e-3
"""Metres in a millimetre: N of kg mm/s2, and N m of N mm."""


class Carried(Protocol):
    """A follower, as far as what acts on it depends on it."""

    @property
    def angular(self) -> bool:
        """Whether lifts are angles."""
        ...

    @property
    def start(self) -> float:
        """Position at zero lift, mm or rad."""
        ...

    @property
    def load_unit(self) -> tuple[float, str, str]:
        """Factor from loads, N or N mm, to their unit in output, that unit, and its suffix."""
        ...

    def mass_point(self, p: Array, distance: float) -> Plane:
        """Return points in the fixed frame at positions (n,), by the distance from the pivot."""
        ...


class DrivenMotion(NamedTuple):
    """The motion of a follower.

    Parameters
    ----------
    x : (n,) array
        Positions of the driver.
    s, ds, d2s : (n,) arrays
        Lifts, and their derivatives by the way of the driver.
    way : 1 or -1, or (n,) array
        Whether the driver goes forward, or back.
    """

    x: Array
    s: Array
    ds: Array
    d2s: Array
    way: Array | float = 1.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Loads(ShortRepr):
    """What acts on a follower beside its cam.

    Parameters
    ----------
    program : Program
        Its lift.
    follower : Carried
        The follower.
    support : Support
        What holds it.
    speed : float or None, rad/s or mm/s
        Of the cam.
    springs, given, masses : sequences
        As in the design; a mass acts by its inertia with a speed, and by its weight with gravity.
    pull : complex, m/s2
        Acceleration of gravity, in the frame of a cam that turns counter-clockwise.
    friction : FrictionSpec
        Coefficients of friction.
    side : {1, -1}
        Whether a cam that only presses does so against the loads, or from above.
    """

    program: Program
    follower: Carried
    support: Support
    speed: float | None = None
    springs: Sequence[SpringSpec] = ()
    given: Sequence[LoadSpec] = ()
    masses: Sequence[MassSpec] = ()
    pull: complex = 0j
    friction: FrictionSpec = field(default_factory=FrictionSpec)
    side: float = 1.0

    @property
    def _unit(self) -> float:
        """N or N mm in the unit of output, N or N m."""
        return 1e3 if self.follower.angular else 1.0

    @property
    def ways(self) -> tuple[float, ...]:
        """Forward, 1, and of a cam that slides to and fro also back, -1."""
        return (1.0,) if self.program.closed else (1.0, -1.0)

    @property
    def _breaks(self) -> list[Array]:
        """Knots of the given loads, within the turn or travel."""
        breaks = [np.asarray(one.knots) for one in self.given]
        return [one[(one > 0.0) & (one < self.program.period)] for one in breaks]

    def motion(self, x: Array, way: Array | float = 1.0) -> DrivenMotion:
        """Return the motion at positions of the driver.

        Parameters
        ----------
        x : (n,) array
            The positions.
        way : 1 or -1, or (n,) array
            Whether the driver goes forward, or back.
        """
        s, ds, d2s = self.program.derivatives(x, 2)
        return DrivenMotion(x, s, way * ds, d2s, way)

    @cached_property
    def inertia(self) -> float:
        """Mass, kg, or moment of inertia, kg m2, times the unit of output over that inside."""
        return sum(one.acting(oscillating=self.follower.angular) for one in self.masses)

    @cached_property
    def damper(self) -> float:
        """Damping of all springs, N s/mm or N mm s/rad."""
        return sum(one.drag for one in self.springs)

    def _weights(self, s: Array) -> tuple[Array, Plane]:
        """Return weight against a rise, and on the support."""
        against, total = np.zeros_like(s), np.zeros(s.shape, dtype=complex)
        for one in self.masses:
            pull = np.full(s.shape, (one.mass or 0.0) * self.pull)
            centre = self.follower.mass_point(self.follower.start + s, one.center or 0.0)
            against -= self.support.lifting(pull, centre)
            total += pull
        return against, total

    def _sense(self, motion: DrivenMotion) -> Array:
        """Return the sign of velocities, 0 in dwells; where a phase begins or ends that within."""
        x, ds = motion.x, motion.ds
        program, still = self.program, _AT_REST * self.program.peaks[0]
        x, knots = x % program.period if program.closed else x, program.knots
        piece = np.searchsorted(knots[1:-1], x, side="right")
        middle = 0.5 * (knots[piece] + knots[piece + 1])
        near = motion.way * program.derivatives(x + _INSIDE * (middle - x), 1)[1]
        ds = np.where(np.abs(ds) > still, ds, near)
        return np.where(np.abs(ds) > still, np.sign(ds), 0.0)

    def _hurry(self, motion: DrivenMotion) -> Plane:
        """Return the masses times their accelerations at a speed of 1, N."""
        _, s, ds, d2s, _ = motion
        total = np.zeros(s.shape, dtype=complex)
        for one in self.masses:
            centre = self.follower.mass_point(self.follower.start + s, one.center or 0.0)
            total += MM * (one.mass or 0.0) * self.support.hurrying(centre, ds, d2s)
        return total

    def pressing(self, motion: DrivenMotion) -> Plane:
        """Return the force of weight and inertia on the support, N, in a `motion`."""
        weight = self._weights(motion.s)[1]
        return weight - (self.speed or 0.0) ** 2 * self._hurry(motion)

    def still(self, motion: DrivenMotion) -> Array:
        """Return loads and weight against a rise, without springs and inertia."""
        x, s = motion.x, motion.s
        sense = self._sense(motion)
        x = x % self.program.period if self.program.closed else x
        total, _ = self._weights(s)
        for one in self.given:
            total = total + one.at(x, s, sense, per=self._unit)
        return total

    def known(self, motion: DrivenMotion) -> Array:
        """Return what holds the follower without what springs have to be solved for."""
        s, d2s = motion.s, motion.d2s
        total = self.still(motion)
        for one in self.springs:
            rate, force = one.rate, one.force
            total = total + (0.0 if rate == "solve" else rate) * s
            total = total + (0.0 if force == "solve" else force)
        drag = self.support.drag(self.pressing(motion), self.friction)
        total = total + self.damper * (self.speed or 0.0) * motion.ds
        return total + self.inertia * (self.speed or 0.0) ** 2 * d2s + self._sense(motion) * drag

    @cached_property
    def solved(self) -> dict[str, float]:
        """The stiffness or preload that springs need, N/mm or N mm/rad, and N or N mm.

        Infinite where no stiffness holds the follower: it would have to at zero lift.
        """
        found: dict[str, float] = {}
        for one in self.springs:
            if one.force == "solve":
                found["preload"] = max(0.0, self._largest(lambda motion: -self.known(motion))[0])
            if one.rate == "solve":
                found["stiffness"] = max(0.0, self._largest(self._needed)[0])
        return found

    @cached_property
    def lack(self) -> float:
        """The force against a rise by which the loads are too small to hold the follower."""

        def missing(motion: DrivenMotion) -> Array:
            return -self.side * self.total_load(motion).holding(self.support, self.friction)

        return self._largest(missing)[0]

    @cached_property
    def preload_at_rest(self) -> float:
        """The preload that is needed where a stiffness does nothing, N or N mm."""
        least = _BARELY * max(map(abs, self.program.range))

        def lack(motion: DrivenMotion) -> Array:
            return np.where(motion.s <= least, -self.known(motion), -np.inf)

        return self._largest(lack)[0]

    def _needed(self, motion: DrivenMotion) -> Array:
        """Return the stiffness that is needed at a lift, negative where none is."""
        s, lack = motion.s, -self.known(motion)
        least = _BARELY * max(map(abs, self.program.range))
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(s > least, lack / s, np.where(lack > 0.0, np.inf, -np.inf))

    @cached_property
    def release(self) -> tuple[float, float, float] | None:
        """The speed at which the follower lifts off, rad/s or mm/s, where, and on which way.

        None if it never does; 0 if the loads do not hold it at the lowest speeds either.
        """
        if not self.inertia:
            return None

        most, where, way = self._largest(self._looseness)
        if self.damper and math.isfinite(most):
            return self._damped_release(1.0 / math.sqrt(most) if most > 0.0 else 0.0)
        return (1.0 / math.sqrt(most), where, way) if most > 0.0 else None

    def _damped_release(self, undamped: float) -> tuple[float, float, float] | None:
        """Return the release with dampers, from the speed without them; 0: none.

        They also press on a rise, and lift on a return, by the speed itself, so that the lowest
        speed is looked for among many below ten times that without them.
        """
        springs = [one.with_solved(self.solved) for one in self.springs]

        def lack(speed: float) -> tuple[float, float, float]:
            other = replace(self, speed=speed, springs=springs)

            def missing(motion: DrivenMotion) -> Array:
                load = other.total_load(motion)
                return -other.side * load.holding(other.support, other.friction)

            return other._largest(missing)

        _, acceleration, _ = self.program.peaks
        still = -lack(0.0)[0]
        falls = self.damper * self.program.peaks[0] or math.inf
        top = 10.0 * max(undamped, still / falls, math.sqrt(still / (self.inertia * acceleration)))
        low = 0.0
        for high in np.geomspace(1e-3 * top, top, _TRIED).tolist():
            if lack(high)[0] > 0.0:
                break
            low = high
        else:
            return None
        while high - low > _ROUNDING * high:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if lack(middle)[0] > 0.0 else (middle, high)
        return (high, *lack(high)[1:])

    def _looseness(self, motion: DrivenMotion) -> Array:
        """Return one over the squares of the speeds at which the follower lifts off.

        They are 0 where it lifts off at none, and infinite where at all that are low.
        """
        s, d2s = motion.s, motion.d2s
        sense, weight, hurry = self._sense(motion), self._weights(s)[1], self._hurry(motion)
        still = self.held_still(motion)
        still[np.abs(still) <= _ROUNDING * np.abs(still).max(initial=0.0)] = 0.0  # of a spring
        sense, a, b = (self.side * one for one in (sense, still, self.inertia * d2s))

        def drag(force: Plane) -> Array:
            return np.abs(sense) * self.support.drag(force, self.friction)

        # drag(weight - u*hurry)^2 = p^2 - 2*u*mixed + u^2*h^2, and (a + b*u)^2 is to equal it
        p, h = drag(weight), drag(hurry)
        mixed = 0.25 * (drag(weight + hurry) ** 2 - drag(weight - hurry) ** 2)
        half = a * b + mixed
        inside = (b * p) ** 2 + (a * h) ** 2 + 2.0 * a * b * mixed + mixed**2 - (h * p) ** 2
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(inside)
            squares = (a - p) * (a + p) / np.stack([root - half, -root - half])
            # the other sign of the root belongs to the opposite velocity
            own = sense * (a + b * squares) <= _ROUNDING * np.abs(a)
            good = own & np.isfinite(squares) & (squares > 0.0)
            loose = np.where(good, 1.0 / squares, 0.0).max(axis=0)
        held, slight = a + sense * p, _ROUNDING * np.abs(a).max(initial=0.0)
        return np.where((held < -slight) | ((held <= slight) & (b < 0.0)), np.inf, loose)

    def held_still(self, motion: DrivenMotion) -> Array:
        """Return the loads against a rise at a very low speed, with springs as solved."""
        s, total = motion.s, self.still(motion)
        for one in self.springs:
            rate, force = one.rate, one.force
            total = total + (self.solved["stiffness"] if rate == "solve" else rate) * s
            total = total + (self.solved["preload"] if force == "solve" else force)
        return total

    def total_load(self, motion: DrivenMotion) -> TotalLoad:
        """Return what the cam has to move."""
        square = (self.speed or 0.0) ** 2
        return TotalLoad(
            against=self.held_still(motion)
            + self.damper * (self.speed or 0.0) * motion.ds
            + self.inertia * square * motion.d2s,
            resultant=self.pressing(motion),
            sense=self._sense(motion),
        )

    def _largest(self, value: Callable[[DrivenMotion], Array]) -> tuple[float, float, float]:
        """Return the largest value over the turn, or to and fro, where it is, and on which way."""
        found = [self._largest_on(way, value) for way in self.ways]
        return max(found, key=lambda one: one[0])

    def _largest_on(
        self, way: float, value: Callable[[DrivenMotion], Array]
    ) -> tuple[float, float, float]:
        """Return the largest value on one way (see `_largest`)."""
        cuts = distinct(self.program.cuts, self.program.knots, *self._breaks)
        low, high = cuts[:-1, None], np.nextafter(cuts[1:, None], -np.inf)
        x = low + (high - low) * np.linspace(0.0, 1.0, _SAMPLES)
        found = value(self.motion(x.ravel(), way)).reshape(x.shape)
        for _ in range(_ROUNDS):
            best = np.argmax(found, axis=1)[:, None]
            low = np.take_along_axis(x, np.maximum(best - 1, 0), axis=1)
            high = np.take_along_axis(x, np.minimum(best + 1, x.shape[1] - 1), axis=1)
            x = low + (high - low) * np.linspace(0.0, 1.0, 33)
            found = value(self.motion(x.ravel(), way)).reshape(x.shape)
        row, column = np.unravel_index(int(np.argmax(found)), found.shape)
        return float(found[row, column]), float(x[row, column]), way
