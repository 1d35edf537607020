"""Displacement functions of driven elements: wheels, racks and followers.

A displacement gives the position of a driven element, rad or a length, over the angle of its
driver, rad, with exact derivatives: the transfer functions of first and higher order. It is
analytic between its *knots*. A *closed* one repeats and gains its *advance* in every *period*
(2*pi/n2 for a wheel, the travel for a rack, 0 for a follower); an open one is the travel from 0 to
its period and may be continued a little beyond. Ratio laws (phi2 over phi1) and lift programs (s
over theta) have this interface, so that code for displacements works with both.

Source: Litvin (displacement function of a gear drive), Norton (of a cam).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array

JUMP: Final = 1e-9
"""Smallest jump of a derivative that counts, over its largest value: far above rounding."""

SLIGHT: Final = 1e-3
"""Largest jump of a derivative that does not matter, over its largest value. Rounded by a
micrometre of lift, such a jump of the velocity takes about a hundredth of the acceleration that a
lift of 100 mm has anyway, and less of a smaller one. Five printed digits stay below."""

EXACT: Final = (0.0, 0.0, 0.0, 0.0)
"""Errors beyond rounding of a function in closed form and of its first three derivatives."""


@dataclass(frozen=True, kw_only=True)
class Jump(ShortRepr):
    """A knot where a derivative jumps.

    Parameters
    ----------
    theta : float, rad
        Angle of the knot; 0 for both ends of a period, which are one knot.
    order : int
        Order of the lowest derivative that jumps: 1 velocity, 2 acceleration, 3 jerk.
    before, after : float
        Values of the derivative on both sides, per rad^order.
    share : float
        Size of the jump over the largest value of the derivative.
    """

    theta: float
    order: int
    before: float
    after: float
    share: float = 1.0

    @property
    def slight(self) -> bool:
        """Whether it is too small to matter, as by coefficients that were printed in few digits."""
        return self.share <= SLIGHT

    @property
    def small(self) -> str:
        """What is said of a jump that is too small to matter, after its size."""
        return f", {formatted(100.0 * self.share, 2)} % of its largest value: too small to matter"


@dataclass(frozen=True, kw_only=True)
class Deviation:
    """The largest distance of a smoothed lift from the rows of its table.

    Parameters
    ----------
    theta : float, rad
        Cam angle of that row.
    value : float, mm or rad
        Distance, positive if the lift is above the row.
    """

    theta: float
    value: float


class Displacement(ABC):
    """A displacement function (see the module docstring)."""

    @property
    @abstractmethod
    def knots(self) -> Array:
        """Knots from 0 to the period, rad, both included."""

    @property
    @abstractmethod
    def period(self) -> float:
        """Driver angle, rad, after which it repeats; of an open one its travel."""

    @property
    def advance(self) -> float:
        """Displacement over the period; 0 by default."""
        return 0.0

    @property
    def closed(self) -> bool:
        """Whether it repeats; True by default."""
        return True

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """The lowest derivative that jumps at each knot; no jumps at the ends of an open one."""
        raise NotImplementedError

    @abstractmethod
    def in_period(self, x: Array, order: int) -> list[Array]:
        """Return ``[y, y', ..., y^(order)]`` at angles within the period, rad.

        Parameters
        ----------
        x : array, rad
            Angles from 0 to the period; of an open one also beyond.
        order : int
            Highest order of derivative.

        Returns
        -------
        list of arrays
        """

    def derivatives(self, x: ArrayLike, order: int) -> list[Array]:
        """Return ``[y, y', ..., y^(order)]`` at any driver angles, rad.

        Parameters
        ----------
        x : array, rad
            Driver angles; at a knot the derivatives are those on its right.
        order : int
            Highest order of derivative.

        Returns
        -------
        list of arrays
            Shaped like `x`: displacement, then derivatives per rad, rad^2, ...
        """
        periods, x = self.within(np.asarray(x, dtype=float))
        place, *slopes = self.in_period(x, order)
        return [place + periods * self.advance, *slopes]

    def within(self, x: Array) -> tuple[Array, Array]:
        """Return the whole periods before driver angles, and the angles within them, rad."""
        if not self.closed:
            return np.zeros(np.shape(x)), x
        periods = np.floor(x / self.period)
        return periods, x - periods * self.period
