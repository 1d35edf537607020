"""Machines with one degree of freedom, reduced to the driver (000, 5.1).

With the moment of inertia J at the driver, the motor's torque M and the resistance R,

    E = J*omega**2/2,        dE/dphi = M - R

needs no derivative of J and no acceleration. A pair has ``J = J1 + i**2*J2``. Its teeth carry the
torque ``Q = M2 + J2*alpha2`` on the driven wheel, and take ``kappa*Q`` from the driver: kappa is
the ratio i without friction, and larger or smaller with it, as teeth drive or are driven. So

    R = i*M2 + (kappa - i)*Q,        Q = (J1*(M2 + J2*i'*omega**2) + J2*i*M)/(J1 + kappa*J2*i)

where alpha1 is eliminated from ``J1*alpha1 = M - kappa*Q`` and ``alpha2 = i*alpha1 + i'*omega**2``;
the sign of Q, on which kappa depends, is that of its numerator. At an even speed the motor's torque
is what it must be, and ``Q = M2 + J2*i'*omega**2``.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Final, Self

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.dynamics.tabled import Tabled
from gearcam.numeric.arrays import Array, distinct, snapped
from gearcam.numeric.piecewise import extremes

TURN: Final = 2.0 * math.pi

_AT_KNOT: Final = 1e-9
"""Distance from a knot, rad, within which a place is called by it."""


def least_and_largest(
    places: Array, values: Array
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the least and the largest of some values, each as (place, value).

    Parameters
    ----------
    places, values : (n,) arrays
        The values and where they are.
    """
    low, high = int(values.argmin()), int(values.argmax())
    return (float(places[low]), float(values[low])), (float(places[high]), float(values[high]))


@dataclass(frozen=True, eq=False, kw_only=True)
class Machine(ABC, ShortRepr):
    """A machine over its driver's angle.

    Parameters
    ----------
    rows : Tabled
        What it needs at each angle; its methods get a row of it, of floats or of arrays.
    knots : (n,) array, rad
        Between them all is smooth; the first and last are the ends of the turn or travel.
    flywheel : float, kg m2
        Moment of inertia of a flywheel on the driver's shaft.
    share : float
        Share of its loads that acts.
    """

    lighter: ClassVar[str] = "a load of up to {} times this one runs"
    """The message that names the share of the loads that runs, where the whole load does not."""

    rows: Tabled
    knots: Array
    flywheel: float = 0.0
    share: float = 1.0

    @abstractmethod
    def inertia(self, row: Any) -> Any:
        """Return the moment of inertia at the driver, kg m2."""

    @abstractmethod
    def inertia_slope(self, row: Any) -> Any:
        """Return its derivative by the driver's angle."""

    @abstractmethod
    def load(self, row: Any, omega: Any) -> Any:
        """Return the torque at the driver that loads alone resist with, without losses, N m.

        Parameters
        ----------
        row, omega
            See `resistance`.
        """

    @abstractmethod
    def resistance(self, row: Any, omega: Any, driving: Any) -> Any:
        """Return the torque that resists, with losses, N m.

        Parameters
        ----------
        row : list of float, or (m, n) array
            Of `rows`.
        omega : float or (n,) array, rad/s
            Speed of the driver.
        driving : float, (n,) array or None, N m
            Torque of the motor; None at an even speed.
        """

    @property
    def closed(self) -> bool:
        """Whether it repeats after its last knot."""
        return self.rows.closed

    @property
    def period(self) -> float:
        """Angle from its first to its last knot, rad: a turn, several turns, or a travel."""
        return float(self.knots[-1] - self.knots[0])

    @property
    def turns(self) -> int:
        """Turns of the driver in its period; 1 of a travel."""
        return max(1, round(self.period / TURN)) if self.closed else 1

    @cached_property
    def inertia_ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The least and the largest moment of inertia, each as (angle, kg m2)."""

        def both(phi: Array) -> list[Array]:
            row, nothing = self.rows.at(phi), np.zeros(phi.shape)
            return [self.inertia(row) + nothing, self.inertia_slope(row) + nothing]

        places, values = extremes(both, self.rows.edges, cells=True)
        places = snapped(places, self.knots, _AT_KNOT)
        return least_and_largest(places, values)

    def knots_over(self, periods: float, low: float | None = None) -> Array:
        """Return the knots of some periods, rad; of an open machine those of its travel.

        Parameters
        ----------
        periods : float
            Number of periods.
        low : float, optional
            Where they begin, in the first one; at the first knot by default.
        """
        own, every, high = self.knots, self.knots, self.knots[-1]
        if self.closed:
            every = distinct(np.add.outer(self.period * np.arange(math.ceil(periods)), own))
            high = own[0] + self.period * periods
        first = own[0] if low is None else low
        return np.concatenate([[first], every[(every > first) & (every < high)], [high]])

    def with_flywheel(self, inertia: float) -> Self:
        """Return the machine with another flywheel, kg m2."""
        return replace(self, flywheel=inertia)


def polynomial(coefficients: Sequence[Any], x: Any) -> Any:
    """Return a polynomial's value.

    Parameters
    ----------
    coefficients : sequence of float or (n,) array
        The lowest first.
    x : float or (n,) array
        Its variable.
    """
    value = coefficients[-1]
    for one in coefficients[-2::-1]:
        value = value * x + one
    return value


@dataclass(frozen=True, eq=False, kw_only=True)
class PairMachine(Machine):
    """A pair; a row has i, i', where teeth rub kappa - i of both flanks, and the load.

    Parameters
    ----------
    driver, driven : float, kg m2
        Moments of inertia of all that turns with each shaft.
    rubs : bool
        Whether a row has ``kappa - i`` where teeth drive, and where they are driven.

    Notes
    -----
    The load is a polynomial of the driver's speed, its lowest coefficient first.
    """

    driver: float
    driven: float
    rubs: bool = False

    def inertia(self, row: Any) -> Any:
        """Return the moment of inertia at the driver."""
        return self.driver + self.flywheel + self.driven * row[0] * row[0]

    def inertia_slope(self, row: Any) -> Any:
        """Return its derivative."""
        return 2.0 * self.driven * row[0] * row[1]

    def driven_load(self, row: Any, omega: Any) -> Any:
        """Return the load on the driven wheel, N m (see `resistance`)."""
        return self.share * polynomial(row[4 if self.rubs else 2 :], omega)

    def load(self, row: Any, omega: Any) -> Any:
        """Return the load at the driver (see `Machine.load`)."""
        return row[0] * self.driven_load(row, omega)

    def mesh_torque(self, row: Any, omega: Any, driving: Any) -> tuple[Any, Any]:
        """Return the torque of the teeth on the driven wheel, N m, and ``kappa - i``.

        Parameters
        ----------
        row, omega, driving
            See `resistance`.
        """
        ratio, load = row[0], self.driven_load(row, omega)
        carried = load + self.driven * row[1] * omega * omega
        driver = self.driver + self.flywheel
        if driving is not None:
            carried = driver * carried + self.driven * ratio * driving
        more = row[3] + (row[2] - row[3]) * (carried > 0.0) if self.rubs else 0.0 * ratio
        if driving is not None:
            carried = carried / (driver + (ratio + more) * self.driven * ratio)
        return carried, more

    def resistance(self, row: Any, omega: Any, driving: Any) -> Any:
        """Return the torque that resists (see `Machine.resistance`)."""
        if not self.rubs:
            return self.load(row, omega)
        torque, more = self.mesh_torque(row, omega, driving)
        return self.load(row, omega) + more * torque


@dataclass(frozen=True, eq=False, kw_only=True)
class ReducedMachine(Machine):
    """A mechanism; a row has its reduced inertia, the derivative of this, and its load."""

    lighter = "loads, weights and springs of up to {} times these run"

    def inertia(self, row: Any) -> Any:
        """Return the reduced inertia."""
        return self.flywheel + row[0]

    def inertia_slope(self, row: Any) -> Any:
        """Return its derivative."""
        return row[1]

    def load(self, row: Any, omega: Any) -> Any:
        """Return the load (see `Machine.load`)."""
        return self.share * polynomial(row[2:], omega)

    def resistance(self, row: Any, omega: Any, driving: Any) -> Any:  # noqa: ARG002
        """Return the torque that resists, without losses (see `Machine.resistance`)."""
        return self.load(row, omega)
