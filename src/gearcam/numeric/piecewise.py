"""Piecewise analytic functions: closed-form pieces between knots, with exact derivatives.

A *piece* is a function written for jets, so that its derivatives are exact; it may bring its
integral in closed form. Between knots a piece is smooth; at a knot any derivative may jump, and
`continuity` says which is the first to do so.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.numeric.chebyshev import Expansion, expand
from gearcam.numeric.jets import Jet
from gearcam.numeric.roots import bracketed_root

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Piece:
    """A smooth piece, with its integral where that has a closed form.

    Parameters
    ----------
    function : callable
        ``function(jet) -> jet``.
    integral : callable or None
        ``integral(jet) -> jet`` with derivative `function`, any constant.
    """

    function: Callable[[Jet], Jet]
    integral: Callable[[Jet], Jet] | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class Pieces(ABC):
    """A function of one variable, smooth between knots.

    Parameters
    ----------
    knots : (n + 1,) array
        Rising.
    """

    knots: Array

    def derivatives(self, x: ArrayLike, order: int) -> list[Array]:
        """Return ``[f, f', ..., f^(order)]`` at `x`; at a knot the piece to its right counts."""
        x = np.asarray(x, dtype=float)
        index = np.searchsorted(self.knots[1:-1], x.ravel(), side="right")
        return list(self.on_pieces(index, x.ravel(), order).reshape(order + 1, *x.shape))

    @abstractmethod
    def on_pieces(self, index: Index, x: Array, order: int) -> Array:
        """Return function and derivatives by given pieces, right at knots too.

        Parameters
        ----------
        index : (n,) array of int
            Numbers of the pieces.
        x : (n,) array
            Places in or at the ends of them.
        order : int
            Of the last derivative.

        Returns
        -------
        (order + 1, n) array
        """


@dataclass(frozen=True, eq=False, kw_only=True)
class Piecewise(Pieces):
    """A function made of pieces that are written for jets (see `Pieces`).

    Parameters
    ----------
    pieces : tuple of n callables
        ``piece(jet) -> jet``.
    offsets : (n,) array
        Added to the pieces: integration constants.
    """

    pieces: tuple[Callable[[Jet], Jet], ...]
    offsets: Array

    def derivatives(self, x: ArrayLike, order: int) -> list[Array]:
        """Return ``[f, f', ..., f^(order)]`` at `x`; at a knot the piece to its right counts."""
        if len(self.pieces) > 1:
            return super().derivatives(x, order)
        x = np.asarray(x, dtype=float)
        return [values.reshape(x.shape) for values in self._piece(0, x.ravel(), order)]

    def on_pieces(self, index: Index, x: Array, order: int) -> Array:
        """Return function and derivatives by given pieces (see `Pieces.on_pieces`)."""
        result = np.empty((order + 1, x.size))
        for number, here in members(index, len(self.pieces)):
            for k, values in enumerate(self._piece(number, x[here], order)):
                result[k, here] = values
        return result

    def _piece(self, number: int, x: Array, order: int) -> list[Array]:
        jet = self.pieces[number](Jet.variable(x, order)) + self.offsets[number]
        return jet.derivatives()

    def __call__(self, x: ArrayLike) -> Array:
        """Return the values at `x`."""
        return self.derivatives(x, 0)[0]

    def shifted(self, constant: float) -> Piecewise:
        """Return the function with a constant added."""
        return replace(self, offsets=self.offsets + constant)

    @cached_property
    def extremes(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Smallest and largest value, each as (place, value)."""
        return self.extremes_over(self.knots)

    def extremes_over(self, knots: Array) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return smallest and largest value between some of the knots, each as (place, value)."""

        def slope(x: Array) -> tuple[Array, Array]:
            value, derivative = self.derivatives(x, 1)
            return value[None], derivative[None]

        ((places, values),) = extremes(slope, knots)
        low, high = int(np.argmin(values)), int(np.argmax(values))
        return (float(places[low]), float(values[low])), (float(places[high]), float(values[high]))

    @property
    def last(self) -> float:
        """Value at the last knot, from the left."""
        return float(self.side(len(self.knots) - 1, -1, 0)[0])

    def side(self, knot: int, side: int, order: int) -> list[float]:
        """Return derivatives up to `order` at a knot by the piece on one `side` (-1 or +1)."""
        number = knot - 1 if side < 0 else knot
        found = self._piece(number, self.knots[knot : knot + 1], order)
        return [float(values[0]) for values in found]

    @cached_property
    def continuity(self) -> tuple[int, ...]:
        """Order of continuity (-1 to 3) at each inner knot and, last, across the ends."""
        last = len(self.knots) - 1
        pairs = [(k, k) for k in range(1, last)] + [(last, 0)]
        result = []
        for left, right in pairs:
            before, after = self.side(left, -1, 3), self.side(right, 1, 3)
            scale = max(1.0, *(abs(v) for v in before + after))
            equal = [abs(b - a) <= 1e-9 * scale for b, a in zip(before, after, strict=True)]
            result.append(equal.index(False) - 1 if False in equal else 3)
        return tuple(result)


def members(index: Index, count: int) -> Iterator[tuple[int, Index | slice]]:
    """Yield every number that occurs in an index, and where.

    Parameters
    ----------
    index : (n,) array of int
        Numbers from 0 on.
    count : int
        How many there may be.

    Yields
    ------
    number : int
        Rising.
    where : (k,) array of int, or slice
        Its places in `index`.
    """
    if count == 1:
        yield 0, slice(None)
        return
    for number in np.flatnonzero(np.bincount(index)).tolist():
        yield number, np.flatnonzero(index == number)


def piecewise(knots: ArrayLike, pieces: list[Piece]) -> Piecewise:
    """Return the function that the pieces make between the knots."""
    return Piecewise(
        knots=np.asarray(knots, dtype=float),
        pieces=tuple(piece.function for piece in pieces),
        offsets=np.zeros(len(pieces)),
    )


def integrate(knots: ArrayLike, pieces: list[Piece], tolerance: float) -> Piecewise | Expansion:
    """Return the integral from the first knot, in closed form where every piece has one.

    Parameters
    ----------
    knots : (n + 1,) array
        Rising.
    pieces : list of n Piece
        The integrand.
    tolerance : float
        Relative truncation error of the expansion that is used otherwise.

    Returns
    -------
    Piecewise or Expansion
        A continuous function, zero at the first knot.

    Raises
    ------
    NotSmoothError
        Where the integrand is not finite or not smooth between the knots.
    """
    grid = np.asarray(knots, dtype=float)
    integrals = [piece.integral for piece in pieces]
    closed = tuple(integral for integral in integrals if integral is not None)
    if len(closed) < len(pieces):
        return expand(piecewise(grid, pieces), grid, tolerance).antiderivative()
    offsets, total = [], 0.0
    for low, high, integral in zip(grid[:-1], grid[1:], closed, strict=True):
        start, end = integral(Jet.variable([low, high], 0)).derivatives()[0]
        offsets.append(total - start)
        total += end - start
    return Piecewise(knots=grid, pieces=closed, offsets=np.array(offsets))


def places_between(knots: ArrayLike, samples: int = 192) -> Array:
    """Return places in every interval between knots, both ends just inside.

    Parameters
    ----------
    knots : (n + 1,) array
        Rising.
    samples : int
        Places in all, at least a quarter of them in every interval.

    Returns
    -------
    (n, k) array
        Rising.
    """
    grid = np.asarray(knots, dtype=float)
    width = np.diff(grid)
    steps = np.linspace(1e-12, 1.0 - 1e-12, max(samples // len(width), samples // 4))
    x = grid[:-1, None] + width[:, None] * steps
    # of a narrow interval so small a share may round to the knot, which is another piece's
    x[:, 0] = np.maximum(x[:, 0], np.nextafter(grid[:-1], np.inf))
    x[:, -1] = np.minimum(x[:, -1], np.nextafter(grid[1:], -np.inf))
    return x


def extremes(
    function: Callable[[Array], tuple[Array, Array]], knots: ArrayLike, samples: int = 192
) -> list[tuple[Array, Array]]:
    """Find all extremes of functions: roots of their slopes, and both sides of their knots.

    Parameters
    ----------
    function : callable
        ``function(x) -> (values, slopes)``, both of shape (m, len(x)) for m functions.
    knots : (n + 1,) array
        Between them the functions are smooth.
    samples : int
        Of the places between which sign changes of the slopes are sought (see `places_between`).

    Returns
    -------
    list of m (places, values)
        Candidates for the largest and smallest value, in rising order of place.
    """
    x = places_between(knots, samples)
    values, slopes = (found.reshape(-1, *x.shape) for found in function(x.ravel()))
    return extremes_among(function, x, values, slopes)


def extremes_among(
    function: Callable[[Array], tuple[Array, Array]], x: Array, values: Array, slopes: Array
) -> list[tuple[Array, Array]]:
    """Find the same from values and slopes that are known already.

    Parameters
    ----------
    function : callable
        As of `extremes`.
    x : (n, k) array
        Places in n intervals, as `places_between` gives them.
    values, slopes : (m, n, k) arrays
        What the functions are there.

    Returns
    -------
    list of m (places, values)
    """
    owner, piece, cell = np.nonzero(slopes[..., :-1] * slopes[..., 1:] < 0.0)
    numbers = np.arange(len(owner))
    # An extreme is flat: a place good to 1e-8 of an interval gives its value to rounding.
    roots = bracketed_root(
        lambda t: function(t)[1][owner, numbers],
        x[piece, cell],
        x[piece, cell + 1],
        1e-8 * float((x[:, -1] - x[:, 0]).min()),
    )
    tops = function(roots)[0][owner, numbers] if roots.size else roots
    found = []
    for k in range(len(slopes)):
        places = np.append(x[:, [0, -1]], roots[owner == k])
        heights = np.append(values[k][:, [0, -1]], tops[owner == k])
        order = np.argsort(places, kind="stable")
        found.append((places[order], heights[order]))
    return found
