"""What is shown of the motion of a machine, whatever its equations are."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.dynamics.machine import Machine
from gearcam.dynamics.motors import Motor
from gearcam.numeric.arrays import Array


def residue(ins: Sequence[float], outs: Sequence[float]) -> float:
    """Return what a balance leaves, over the larger of its sides.

    Parameters
    ----------
    ins, outs : sequences of float, J
        Energies and works in and out; a negative one counts on the other side.
    """
    into = sum(max(one, 0.0) for one in ins) - sum(min(one, 0.0) for one in outs)
    out = sum(max(one, 0.0) for one in outs) - sum(min(one, 0.0) for one in ins)
    return abs(into - out) / max(into, out) if into or out else 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class MachineMotion(ABC, ShortRepr):
    """A motion over the driver's angle.

    Parameters
    ----------
    machine : Machine
        What moves, with rigid members.
    motor : Motor or None
        What turns it; None at an even speed.
    knots : (n,) array, rad
        From the first to the last angle: between them it is smooth.
    """

    machine: Machine
    motor: Motor | None
    knots: Array

    @property
    def ends(self) -> tuple[float, float]:
        """First and last angle, rad: where it stopped, if it did."""
        last = self.knots[-1] if self.stopped is None else self.stopped
        return float(self.knots[0]), float(last)

    @cached_property
    @abstractmethod
    def places(self) -> Array:
        """Angles, rad, between which nothing of the motion is missed."""

    @cached_property
    @abstractmethod
    def speeds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and largest speed of the driver, each as (angle, rad/s)."""

    @property
    def mean_speed(self) -> float:
        """Half the sum of the least and the largest speed, rad/s (000, 5.5)."""
        return 0.5 * (self.speeds[0][1] + self.speeds[1][1])

    @property
    def irregularity(self) -> float:
        """``(max - min)/mean`` of the speed (000, 5.6)."""
        return (self.speeds[1][1] - self.speeds[0][1]) / self.mean_speed

    @cached_property
    def lasts(self) -> float:
        """Time from the first to the last angle, s."""
        return float(np.diff(self.time(np.array(self.ends)))[0])

    @cached_property
    @abstractmethod
    def works(self) -> tuple[float, float, float]:
        """Work of the motor, on the loads, and lost, J."""

    @cached_property
    @abstractmethod
    def gained(self) -> float:
        """By how much the energy is larger at the end, J."""

    @property
    @abstractmethod
    def residue(self) -> float:
        """What the balance of works and energy leaves (see `residue`)."""

    @cached_property
    @abstractmethod
    def stopped(self) -> float | None:
        """Angle at which the driver stopped, rad; None if it did not."""

    @abstractmethod
    def speed(self, phi: Array) -> Array:
        """Return speeds of the driver, rad/s, at angles (n,)."""

    @abstractmethod
    def time(self, phi: Array) -> Array:
        """Return times, s, at angles (n,)."""

    @abstractmethod
    def torques(self, phi: Array) -> tuple[Array, Array, Array]:
        """Return torques of motor, loads and losses at the driver, N m, at angles (n,)."""
