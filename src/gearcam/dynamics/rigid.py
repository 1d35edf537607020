"""A machine with rigid members in motion, by its energy over the driver's angle (000, 5.1).

The state is the kinetic energy, J, and the time, s (see `machine`). From rest the motion begins
with its series: with the torque M and the inertia J at rest, ``E = M*phi`` and
``t = sqrt(2*J*phi/M)``. The energy balance is a quadrature of torques along the motion, not the
integration itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.dynamics.integrate import Integrator, Mode, Motion, MotionPiece, Switch
from gearcam.dynamics.machine import TURN, Machine, least_and_largest
from gearcam.dynamics.motion import MachineMotion, residue
from gearcam.dynamics.motors import Motor
from gearcam.numeric.arrays import Array, distinct
from gearcam.numeric.gauss import gauss_cells
from gearcam.numeric.piecewise import extremes, places_between

MOVES, STANDS = "moves", "stands"
"""Modes: the driver turns, or it has stopped."""

_REST: Final = 1e-12
"""Kinetic energy, over that at a usual speed, below which the driver stands still."""

_BEGUN: Final = 1e-9
"""The same, up to which a motion from rest follows its series."""

_STEEP: Final = 5e3
"""Fall of a disturbance in a turn, as an exponent, from which explicit steps cost more."""

_PROBES: Final = 65
"""Places at which it is looked for."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RigidMotion(MachineMotion):
    """A motion of a machine with rigid members.

    Parameters
    ----------
    machine, motor, knots
        See `MachineMotion`.
    motion : Motion or None
        Energy, J, and time, s, over the driver's angle; None at an even speed.
    even : float, rad/s
        That speed.
    """

    motion: Motion | None = None
    even: float = 0.0

    def rows(self, phi: Array) -> Array:
        """Return the rows of the machine at angles, (m, n)."""
        return self.machine.rows.at(phi)

    def speed(self, phi: Array) -> Array:
        """Return the driver's speed, rad/s, at angles (n,)."""
        if self.motion is None:
            return np.full(phi.shape, self.even)
        energy = np.maximum(self.motion.at(phi)[0], 0.0)
        return np.sqrt(2.0 * energy / self.machine.inertia(self.rows(phi)))

    def time(self, phi: Array) -> Array:
        """Return the time, s, at angles (n,)."""
        if self.motion is None:
            return (phi - self.knots[0]) / self.even
        return self.motion.at(phi)[1]

    def driving(self, phi: Array, omega: Array) -> Array | None:
        """Return the torque of the motor, N m; None at an even speed (see `Motor.torque`)."""
        return None if self.motor is None else self.motor.torque(phi, omega)

    def torques(self, phi: Array) -> tuple[Array, Array, Array]:
        """Return the torques of motor, load and losses at the driver, N m, at angles (n,)."""
        row, omega = self.rows(phi), self.speed(phi)
        driving = self.driving(phi, omega)
        load, resisting = (
            self.machine.load(row, omega),
            self.machine.resistance(row, omega, driving),
        )
        if driving is None:
            driving = resisting + 0.5 * self.machine.inertia_slope(row) * omega**2
        return driving, load, resisting - load

    def _speed_and_slope(self, phi: Array) -> list[Array]:
        row, omega = self.rows(phi), self.speed(phi)
        driving, load, lost = self.torques(phi)
        slope = driving - load - lost - 0.5 * self.machine.inertia_slope(row) * omega**2
        with np.errstate(divide="ignore", invalid="ignore"):
            return [omega, slope / (self.machine.inertia(row) * omega)]

    @cached_property
    def _cells(self) -> Array:
        """Angles between which a few points tell all, rad."""
        steps = [one.low for one in self.motion.pieces] if self.motion else []
        low, high = self.ends
        periods = np.arange(math.ceil((high - low) / self.machine.period))
        edges = np.add.outer(self.machine.period * periods, self.machine.rows.edges).ravel()
        inside = edges[(edges > low) & (edges < high)]
        knots = self.knots[(self.knots > low) & (self.knots < high)]
        return distinct(knots, steps, inside, [low, high])

    @cached_property
    def places(self) -> Array:
        """Angles, rad, between which nothing of the motion is missed."""
        cells = self._cells
        return distinct(places_between(cells, cells=True)) if len(cells) > 1 else cells

    @cached_property
    def speeds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and largest speed of the driver, each as (angle, rad/s)."""
        if self.motion is None:
            only = float(self.knots[0]), self.even
            return only, only
        if len(self._cells) < 2:  # it does not start
            return (self.ends[0], 0.0), (self.ends[0], 0.0)
        places, values = extremes(self._speed_and_slope, self._cells, cells=True)
        return least_and_largest(places, values)

    @cached_property
    def works(self) -> tuple[float, float, float]:
        """Work of the motor, on the loads, and lost, J."""
        places, weights = (one.ravel() for one in gauss_cells(self._cells[:-1], self._cells[1:]))
        motor, load, lost = (float(weights @ one) for one in self.torques(places))
        return motor, load, lost

    @cached_property
    def gained(self) -> float:
        """By how much the kinetic energy is larger at the end, J."""
        ends = np.array(self.ends)
        if self.motion is not None:
            return float(np.diff(self.motion.at(ends)[0])[0])
        inertia = self.machine.inertia(self.rows(ends))
        return float(np.diff(0.5 * inertia * self.even**2)[0])

    @property
    def residue(self) -> float:
        """What the balance of works and energy leaves (see `residue`).

        In is what it had at the start and the motor's work, out what it has at the end and the
        works on loads and lost.
        """
        first = np.array(self.ends[:1])
        inertia = self.machine.inertia(self.rows(first))
        before = 0.5 * float((inertia * self.speed(first) ** 2)[0])
        return residue((before, self.works[0]), (before + self.gained, *self.works[1:]))

    @cached_property
    def stopped(self) -> float | None:
        """Angle at which the driver stopped, rad; None if it did not."""
        if self.motion is None or self.motion.mode != STANDS:
            return None
        return self.motion.switches[-1][0]


@dataclass(frozen=True, kw_only=True)
class RigidRun(ShortRepr):
    """How a machine with its motor moves.

    Parameters
    ----------
    machine : Machine
        The machine.
    motor : Motor
        What turns it.
    scale : float, rad/s
        A usual speed of the driver.
    rtol : float
        Relative tolerance of the integration.
    """

    machine: Machine
    motor: Motor
    scale: float
    rtol: float = 1e-9

    def energy(self, phi: float, omega: float) -> float:
        """Return the kinetic energy, J, at an angle `phi`, rad, and a speed `omega`, rad/s."""
        return 0.5 * self.machine.inertia(self.machine.rows(phi)) * omega * omega

    @cached_property
    def _usual(self) -> float:
        """Energy at a usual speed."""
        return self.energy(float(self.machine.knots[0]), self.scale)

    @cached_property
    def method(self) -> str:
        """The integrator: an implicit one if the motor's torque is very steep in the speed."""
        phi = np.linspace(self.machine.knots[0], self.machine.knots[-1], _PROBES)
        row = self.machine.rows.at(phi)
        less, more = (np.full(phi.shape, share * self.scale) for share in (0.98, 1.02))
        steep = np.abs(self.motor.torque(phi, more) - self.motor.torque(phi, less))
        rate = steep / (0.04 * self.scale**2 * self.machine.inertia(row))
        return "radau" if rate.max() * self.machine.period > _STEEP else "dop853"

    def _rate(self, phi: float, y: Any) -> tuple[float, float]:
        row = self.machine.rows(phi)
        energy, inertia = max(float(y[0]), 0.1 * _REST * self._usual), self.machine.inertia(row)
        omega = math.sqrt(2.0 * energy / inertia)
        driving = self.motor.torque(phi, omega)
        return driving - self.machine.resistance(row, omega, driving), 1.0 / omega

    @cached_property
    def _modes(self) -> dict[str, Mode]:
        least = _REST * self._usual
        stop = Switch(lambda _, y: float(y[0]) - least, STANDS, 0.0, dips=False)
        return {MOVES: Mode(self._rate, (stop,)), STANDS: Mode(lambda *_: (0.0, 0.0), last=True)}

    def _integrated(
        self, energy: float, time: float, knots: Array, keep: float = -math.inf
    ) -> Motion:
        tiny = 1e-3 * self.rtol
        atol = (tiny * self._usual, tiny * TURN / self.scale)
        integrator = Integrator(method=self.method, rtol=self.rtol, atol=atol)
        return integrator(self._modes, (MOVES, [energy, time]), [*knots], keep=keep)

    def _over(self, knots: Array, motion: Motion) -> RigidMotion:
        return RigidMotion(machine=self.machine, motor=self.motor, knots=knots, motion=motion)

    def from_speed(self, omega: float, periods: float = 1.0) -> RigidMotion:
        """Return the motion from the first angle, at a speed of `omega`, rad/s, over `periods`."""
        low = float(self.machine.knots[0])
        knots = self.machine.knots_over(periods)
        return self._over(knots, self._integrated(self.energy(low, omega), 0.0, knots))

    def speed_after_turn(self, omega: float) -> float:
        """Return the speed after a turn from the first angle, rad/s; 0 if the machine stops."""
        low, knots = float(self.machine.knots[0]), self.machine.knots_over(1.0)
        motion = self._integrated(self.energy(low, omega), 0.0, knots, math.inf)
        if motion.mode == STANDS:
            return 0.0
        inertia = self.machine.inertia(self.machine.rows(low))
        return math.sqrt(2.0 * float(motion.end[0]) / inertia)

    def from_rest(self, periods: float = 1.0) -> RigidMotion:
        """Return the motion from rest over a number of periods.

        Parameters
        ----------
        periods : float
            The periods; of an open machine its travel.

        Returns
        -------
        RigidMotion
            It has stopped at the first angle if the load is larger than the torque at rest.
        """
        low = float(self.machine.knots[0])
        row = self.machine.rows(low)
        driving = self.motor.torque(low, 0.0)
        torque = driving - self.machine.resistance(row, 0.0, driving)
        if torque <= 0.0:
            return self._standing(low)
        angle = _BEGUN * self._usual / torque
        slow = math.sqrt(2.0 * self.machine.inertia(row) / torque)

        def series(x: Array) -> Array:
            phi = np.maximum(x - low, 0.0)
            return np.array([torque * phi, slow * np.sqrt(phi)])

        knots = self.machine.knots_over(periods, low + angle)
        motion = self._integrated(torque * angle, slow * math.sqrt(angle), knots)
        pieces = [MotionPiece(low, low + angle, MOVES, series), *motion.pieces]
        return self._over(np.array([low, *knots[1:]]), replace(motion, pieces=pieces))

    def _standing(self, low: float) -> RigidMotion:
        """Return the motion of a machine that does not start."""
        knots = np.array([low, float(self.machine.knots[-1])])
        motion = Motion(
            place=float(knots[-1]),
            end=np.zeros(2),
            mode=STANDS,
            pieces=[MotionPiece(low, float(knots[-1]), STANDS, lambda x: np.zeros((2, len(x))))],
            switches=[(low, MOVES, STANDS)],
            evaluations=0,
            steps=0,
        )
        return self._over(knots, motion)
