"""Several functions of the driver's angle as one table, which is read quickly at single places.

Right hand sides of equations of motion are evaluated at one place at a time, where arrays and the
laws themselves cost a hundred times as much.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import expand_all


class Tabled(ShortRepr):
    """Functions of one variable between knots, to a tolerance.

    Parameters
    ----------
    functions : callable
        ``functions(x) -> (m, n) array`` at n places.
    knots : (k,) array
        Rising: between them all functions are smooth.
    tolerance : float
        Error, relative to the largest value of each function.
    closed : bool
        Whether the functions repeat after the last knot.
    cuts : int
        First number of cells, a power of 2.
    sizes : float or (m,) array
        What the error is relative to where a function is smaller than this.

    Raises
    ------
    NotSmoothError
        If a function is not finite or not smooth between the knots.
    """

    def __init__(
        self,
        functions: Callable[[Array], Array],
        knots: ArrayLike,
        tolerance: float,
        *,
        closed: bool = True,
        cuts: int = 32,
        sizes: ArrayLike = 0.0,
    ) -> None:
        knots = np.asarray(knots, dtype=float)
        self.low, self.closed = float(knots[0]), closed
        self.period = float(knots[-1]) - self.low
        self._columns = expand_all(functions, knots, tolerance, cuts=cuts, sizes=sizes)

    @property
    def edges(self) -> Array:
        """Ends of its cells, in which few points tell all."""
        return self._columns[0].knots

    @cached_property
    def _cells(self) -> tuple[list[float], list[tuple[float, float, list[tuple[float, ...]]]]]:
        """Inner edges, and of each cell its middle, inverse half width, powers, highest first."""
        parts = [column.powers for column in self._columns]
        middles, scales, _ = parts[0]
        powers = np.array([one[2][::-1] for one in parts])
        cells = [
            (middle, scale, [tuple(one) for one in own])
            for middle, scale, own in zip(
                middles.tolist(), scales.tolist(), powers.transpose(2, 0, 1).tolist(), strict=True
            )
        ]
        return self._columns[0].knots[1:-1].tolist(), cells

    def __call__(self, x: float) -> list[float]:
        """Return the values at one place; at a knot from the right."""
        inner, cells = self._cells
        if self.closed:
            x = self.low + (x - self.low) % self.period
        middle, scale, powers = cells[bisect_right(inner, x)]
        t = (x - middle) * scale
        found = []
        for a, b, c, d, e, f, g, h, i in powers:
            found.append(
                (((((((a * t + b) * t + c) * t + d) * t + e) * t + f) * t + g) * t + h) * t + i
            )
        return found

    def at(self, x: ArrayLike) -> Array:
        """Return the values at places `x`, (m, n)."""
        x = np.asarray(x, dtype=float)
        if self.closed:
            x = self.low + (x - self.low) % self.period
        return np.array([column(x) for column in self._columns])
