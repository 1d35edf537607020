"""Torques of motors over the driver's angle and speed (000, 5.1.3), N m.

A *motor* returns its torque at single places or at arrays of them, for speeds from 0 on.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import RPM, TORQUE
from gearcam.mechanics.motor import MotorSpec

_KILO: Final = TORQUE.factor
"""N mm in a N m."""


class Motor(ABC, ShortRepr):
    """What turns the driver."""

    settles: ClassVar[bool] = False
    """Whether its torque falls with the speed, so that a machine has a regime of its own."""
    known: tuple[float, float] = (0.0, math.inf)
    """Speeds between which its torque is known, rad/s."""
    scale: float = 0.0
    """A usual speed of the driver, rad/s; 0 if it has none."""
    bends: tuple[float, ...] = ()
    """Speeds, rad/s, between which its torque changes little, or only rises or falls."""

    @abstractmethod
    def torque(self, phi: Any, omega: Any) -> Any:
        """Return its torque, N m.

        Parameters
        ----------
        phi, omega : float or (n,) array
            Angle of the driver from the start, rad, and its speed, rad/s.
        """


@dataclass(frozen=True)
class ConstantMotor(Motor):
    """A motor with a torque of one `size`, N m, at all speeds; of 0 the machine coasts."""

    size: float = 0.0

    def torque(self, phi: Any, omega: Any) -> Any:  # noqa: ARG002
        """Return its torque (see `Motor.torque`)."""
        return self.size + 0.0 * omega


@dataclass(frozen=True)
class SpringMotor(Motor):
    """A wound spring: a torque at the `start`, N m, and its `fall` per rad until it is unwound."""

    start: float
    fall: float

    def torque(self, phi: Any, omega: Any) -> Any:
        """Return ``start - fall*phi``, 0 at least (see `Motor.torque`)."""
        left = self.start - self.fall * phi
        return 0.5 * (left + abs(left)) + 0.0 * omega


@dataclass(frozen=True)
class LinearMotor(Motor):
    """A motor whose torque falls evenly with the speed (5.20).

    It has that of the `start`, N m, at rest, and none at its `idle` speed, rad/s.
    """

    start: float
    idle: float

    settles = True

    @property
    def scale(self) -> float:  # type: ignore[override]
        """Its speed without load, rad/s."""
        return self.idle

    def torque(self, phi: Any, omega: Any) -> Any:  # noqa: ARG002
        """Return ``start*(1 - omega/idle)`` (see `Motor.torque`)."""
        return self.start * (1.0 - omega / self.idle)


@dataclass(frozen=True)
class AsynchronousMotor(Motor):
    """An induction motor, by Kloss's formula ``M = 2*Mk/(s/sk + sk/s)``.

    Parameters
    ----------
    breakdown : float, N m
        Its largest torque Mk.
    slip : float
        The slip sk there.
    synchronous : float, rad/s
        The speed without slip.
    """

    breakdown: float
    slip: float
    synchronous: float

    settles = True

    @property
    def scale(self) -> float:  # type: ignore[override]
        """Its synchronous speed, rad/s."""
        return self.synchronous

    @property
    def bends(self) -> tuple[float, ...]:  # type: ignore[override]
        """The speeds about its largest torques, that drives and that brakes."""
        slips = [share * self.slip for share in (-2.0, -1.0, -0.5, 0.5, 1.0, 2.0)]
        return tuple(self.synchronous * (1.0 - one) for one in slips)

    def torque(self, phi: Any, omega: Any) -> Any:  # noqa: ARG002
        """Return its torque; above the synchronous speed it brakes (see `Motor.torque`)."""
        s = 1.0 - omega / self.synchronous
        return 2.0 * self.breakdown * s * self.slip / (s * s + self.slip * self.slip)


@dataclass(frozen=True)
class TableMotor(Motor):
    """Torques of some `sizes`, N m, at `speeds`, rad/s: a monotone cubic (Fritsch, Butland).

    Beyond its speeds, where a regime is only looked for: that of the first below them, and above
    them the chord of the last two goes on.
    """

    speeds: tuple[float, ...]
    sizes: tuple[float, ...]

    @property
    def settles(self) -> bool:  # type: ignore[override]
        """Whether it has less torque at its highest speed than anywhere below."""
        return self.sizes[-1] < min(self.sizes[:-1])

    @property
    def known(self) -> tuple[float, float]:  # type: ignore[override]
        """Its first and its last speed."""
        return self.speeds[0], self.speeds[-1]

    @property
    def scale(self) -> float:  # type: ignore[override]
        """Its highest speed."""
        return self.speeds[-1]

    @property
    def bends(self) -> tuple[float, ...]:  # type: ignore[override]
        """Its speeds."""
        return self.speeds

    @cached_property
    def _cells(self) -> tuple[list[float], list[tuple[float, ...]], Any]:
        from scipy.interpolate import PchipInterpolator

        powers = np.asarray(PchipInterpolator(self.speeds, self.sizes).c)
        return [*self.speeds[1:-1]], [tuple(one) for one in powers.T.tolist()], powers

    def torque(self, phi: Any, omega: Any) -> Any:  # noqa: ARG002
        """Return its torque (see `Motor.torque`)."""
        inner, cells, powers = self._cells
        lowest, highest = self.known
        if isinstance(omega, np.ndarray):
            within = np.clip(omega, lowest, highest)
            cell = np.searchsorted(inner, within, side="right")
            a, b, c, d = powers[:, cell]
            low = np.asarray(self.speeds)[cell]
        else:
            within = min(max(omega, lowest), highest)
            number = bisect_right(inner, within)
            a, b, c, d = cells[number]
            low = self.speeds[number]
        t = within - low
        chord = (self.sizes[-1] - self.sizes[-2]) / (self.speeds[-1] - self.speeds[-2])
        beyond = 0.5 * (omega - highest + abs(omega - highest))
        return ((a * t + b) * t + c) * t + d + chord * beyond


def motor_of(spec: MotorSpec) -> Motor | None:
    """Return the motor of a table ``[motor]``; None if the driver turns evenly.

    Parameters
    ----------
    spec : MotorSpec
        The table; a constant torque that is left out is 0 here.
    """

    def si(value: float | None) -> float:
        return (value or 0.0) / _KILO

    torque = spec.torque or (0.0,)
    match spec.type:
        case "speed":
            return None
        case "spring":
            return SpringMotor(si(torque[0]), si(spec.stiffness))
        case "linear":
            return LinearMotor(si(spec.start_torque), spec.idle or 0.0)
        case "asynchronous":
            slip, synchronous = spec.breakdown_slip or 0.0, spec.synchronous or 0.0
            return AsynchronousMotor(si(spec.breakdown_torque), slip, synchronous)
        case "table":
            speeds = tuple(RPM.factor * one for one in spec.rpm or ())
            return TableMotor(speeds, tuple(map(si, torque)))
        case _:
            return ConstantMotor(si(torque[0]))
