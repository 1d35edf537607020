"""Displacement functions: what everything that moves promises, be it a wheel, a rack or a follower.

A displacement gives the place of a driven element, rad or a length, over the angle of its driver,
rad, with exact derivatives: the transfer functions of first and higher order. Between its *knots*
it is analytic. It is *closed* where it goes on for ever, gaining its *advance* in every *period*
(2*pi/n2 for a wheel, the travel for a rack, 0 for a follower); an open one is the travel from 0 to
its period, and may be continued a little beyond. Ratio laws (phi2 over phi1) and lift programs (s
over theta) keep this, so that whoever takes a displacement takes either.

Source: Litvin (displacement function of a gear drive), Norton (of a cam).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.numeric.arrays import Array

JUMP: Final = 1e-9
"""Jump of a derivative that counts, in its largest value: far above rounding."""


EXACT: Final = (0.0, 0.0, 0.0, 0.0)
"""Errors beyond rounding of a function in closed form and of its first three derivatives."""


@dataclass(frozen=True, kw_only=True)
class Jump:
    """A knot where a derivative jumps.

    Parameters
    ----------
    theta : float, rad
        Where; 0 for the ends of a period, which are one knot.
    order : int
        Of the lowest derivative that jumps there: 1 velocity, 2 acceleration, 3 jerk.
    before, after : float
        Its values on both sides, per rad^order.
    """

    theta: float
    order: int
    before: float
    after: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Deviation:
    """The largest distance of a smoothed lift from the rows that it was made from.

    Parameters
    ----------
    theta : float, rad
        Where.
    value : float, mm or rad
        How far, positive where the lift is above the row.
    rows : (n, 2) array
        The rows as given: angle, rad, and lift, mm or rad.
    """

    theta: float
    value: float
    rows: Array


class Displacement(ABC):
    """A displacement function (see the module)."""

    @property
    @abstractmethod
    def knots(self) -> Array:
        """Knots from 0 to the period, rad, both included; at others nothing jumps."""

    @property
    @abstractmethod
    def period(self) -> float:
        """Driver's angle, rad, after which it repeats; if it is open, its whole travel."""

    @property
    def advance(self) -> float:
        """What is gained over the period; nothing, unless it says so."""
        return 0.0

    @property
    def closed(self) -> bool:
        """Whether it repeats; it does, unless it says no."""
        return True

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """The lowest derivative that jumps at each knot; an open one has no jumps at its ends."""
        raise NotImplementedError

    @abstractmethod
    def in_period(self, x: Array, order: int) -> list[Array]:
        """Return ``[y, y', ..., y^(order)]`` at angles within the period, rad.

        Parameters
        ----------
        x : array, rad
            From 0 to the period; of an open one also beyond.
        order : int
            Of the last derivative.

        Returns
        -------
        list of arrays
        """

    def derivatives(self, x: ArrayLike, order: int) -> list[Array]:
        """Return ``[y, y', ..., y^(order)]`` at any driver angles, rad.

        Parameters
        ----------
        x : array, rad
            At a knot the derivatives to its right count.
        order : int
            Of the last derivative.

        Returns
        -------
        list of arrays
            Of the shape of `x`; place, then per rad, rad^2 and so on.
        """
        periods, x = self.within(np.asarray(x, dtype=float))
        place, *slopes = self.in_period(x, order)
        return [place + periods * self.advance, *slopes]

    def within(self, x: Array) -> tuple[Array, Array]:
        """Return how many periods lie before driver angles, and the angles within theirs, rad."""
        if not self.closed:
            return np.zeros(np.shape(x)), x
        periods = np.floor(x / self.period)
        return periods, x - periods * self.period
