"""What is shown of the motion of a machine, whatever its equations are."""

from __future__ import annotations

from functools import cached_property
from typing import Protocol

from gearcam.dynamics.machine import Machine
from gearcam.dynamics.motors import Motor
from gearcam.numeric.arrays import Array


class MachineMotion(Protocol):
    """A motion over the driver's angle (see `gearcam.dynamics.rigid.RigidMotion`)."""

    @property
    def machine(self) -> Machine:
        """What moves."""
        ...

    @property
    def motor(self) -> Motor | None:
        """What turns it; None at an even speed."""
        ...

    @property
    def knots(self) -> Array:
        """From the first to the last angle, rad: between them it is smooth."""
        ...

    @property
    def ends(self) -> tuple[float, float]:
        """First and last angle, rad."""
        ...

    @property
    def places(self) -> Array:
        """Angles, rad, between which nothing of the motion is missed."""
        ...

    @cached_property
    def speeds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and largest speed, each as (angle, rad/s)."""
        ...

    @property
    def mean_speed(self) -> float:
        """Half the sum of both, rad/s."""
        ...

    @property
    def irregularity(self) -> float:
        """``(max - min)/mean``."""
        ...

    @property
    def lasts(self) -> float:
        """Time, s."""
        ...

    @cached_property
    def works(self) -> tuple[float, float, float]:
        """Work of the motor, on the loads, and lost, J."""
        ...

    @cached_property
    def gained(self) -> float:
        """Energy gained, J."""
        ...

    @property
    def residue(self) -> float:
        """What the balance of works and energy leaves, as a share."""
        ...

    @cached_property
    def stopped(self) -> float | None:
        """Where the driver stopped, rad."""
        ...

    def speed(self, phi: Array) -> Array:
        """Return speeds, rad/s, at angles (n,)."""
        ...

    def time(self, phi: Array) -> Array:
        """Return times, s, at angles (n,)."""
        ...

    def torques(self, phi: Array) -> tuple[Array, Array, Array]:
        """Return torques of motor, loads and losses at the driver, N m, at angles (n,)."""
        ...
