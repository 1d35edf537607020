"""Piecewise analytic functions: closed-form pieces between knots, with exact derivatives.

A *piece* is a function of jets, so that its derivatives are exact; it may have its integral in
closed form. Pieces of one function that differ only in parameters are evaluated together. Between
knots the function is smooth; at a knot any derivative may jump, and `continuity` gives the order of
the first that does.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, distinct, opposite
from gearcam.numeric.chebyshev import FIRST_CUTS, Expansion, expand
from gearcam.numeric.jets import Jet
from gearcam.numeric.roots import bracketed_root

_SAME = 1e-9
"""Difference of derivatives across a knot, in the largest of them or 1, that counts as rounding."""

_INSET = 1e-12
"""Distance of outermost points from the knots, as a share of the interval."""

_ENDS = [0, -1]

_PLACES, LEAST_PLACES = 192, 48
"""Total number of points in all intervals, and least number in each."""

_PLACES_OF_CELLS, _LEAST_OF_CELL = 9 * FIRST_CUTS, 9
"""The same for intervals that resolve all features: as many points as in the first step of
expansions."""

_FLAT = 1e-8
"""Tolerance of the place of extremes, as a share of the interval: their values are flat."""

_BETWEEN, _ADDED = 24, 2400
"""Least number of points of a drawn curve between two knots, and largest number added."""

_BLOCK = 1 << 15
"""Points at which pieces are evaluated at once: with more, intermediate arrays leave the cache and
the allocator returns them to the system."""


@dataclass(frozen=True, eq=False)
class Piece(ShortRepr):
    """A smooth piece, with its integral where that has a closed form.

    Parameters
    ----------
    function : callable
        ``function(jet, *parameters) -> jet``; each parameter is a float, or an array with one value
        per point.
    integral : callable or None
        ``integral(jet, *parameters) -> jet`` with derivative `function`, any constant.
    parameters : tuple of float
        Parameters by which pieces of the same function differ.
    """

    function: Callable[..., Jet]
    integral: Callable[..., Jet] | None = None
    parameters: tuple[float, ...] = ()

    def __call__(self, x: Jet) -> Jet:
        """Return the value of the piece for a jet."""
        return self.function(x, *self.parameters)


@dataclass(frozen=True, eq=False, kw_only=True)
class Piecewise(ShortRepr):
    """A function of one variable made of pieces, smooth between knots.

    Parameters
    ----------
    knots : (n + 1,) array
        Rising.
    pieces : tuple of n Piece
        Pieces between the knots; their integrals are not used.
    offsets : (n,) array
        Added to the pieces: integration constants.
    """

    knots: Array
    pieces: tuple[Piece, ...]
    offsets: Array

    @cached_property
    def _families(self) -> tuple[Ints, list[tuple[Callable[..., Jet], Array]]]:
        """Number of each piece's function, and the functions with parameters, one column per piece.

        Columns of other functions' pieces are never read.
        """
        owners: dict[tuple[Callable[..., Jet], int], list[int]] = {}
        for k, piece in enumerate(self.pieces):
            owners.setdefault((piece.function, len(piece.parameters)), []).append(k)
        numbers, functions = np.zeros(len(self.pieces), dtype=np.int64), []
        for number, ((function, count), own) in enumerate(owners.items()):
            numbers[own] = number
            columns = np.zeros((count, len(self.pieces)))
            columns[:, own] = np.transpose([self.pieces[k].parameters for k in own])
            functions.append((function, columns))
        return numbers, functions

    def derivatives(self, x: ArrayLike, order: int) -> list[Array]:
        """Return ``[f, f', ..., f^(order)]`` at `x`; at a knot from the piece on its right."""
        x = np.asarray(x, dtype=float)
        if len(self.pieces) != 1:
            index = np.searchsorted(self.knots[1:-1], x.ravel(), side="right")
            return list(self.on_pieces(index, x.ravel(), order).reshape(order + 1, *x.shape))
        (piece,) = self.pieces
        jet = piece(Jet.variable(x.ravel(), order)) + self.offsets[0]
        return [values.reshape(x.shape) for values in jet.derivatives()]

    def on_pieces(
        self, index: Ints, x: Array, order: int, moved: Callable[[Array], Array] | None = None
    ) -> Array:
        """Return function and derivatives from given pieces, also exactly at knots.

        Parameters
        ----------
        index : (n,) array of int
            Numbers of the pieces.
        x : (n,) array
            Points in or at the ends of them.
        order : int
            Order of the last derivative.
        moved : callable, optional
            ``moved(parameters) -> parameters``: a change of the parameters at each point.

        Returns
        -------
        (order + 1, n) array
        """
        numbers, functions = self._families
        result = np.empty((order + 1, x.size))
        for number, (function, columns) in enumerate(functions):
            if len(functions) > 1:
                own = np.flatnonzero(numbers.take(index) == number)
                blocks = [own[k : k + _BLOCK] for k in range(0, own.size, _BLOCK)]
            else:
                blocks = [slice(k, k + _BLOCK) for k in range(0, x.size, _BLOCK)]
            for here in blocks:
                which = index[here]
                given = columns.take(which, 1, mode="clip")
                jet = function(Jet.variable(x[here], order), *(moved(given) if moved else given))
                for k, values in enumerate((jet + self.offsets[which]).derivatives()):
                    result[k, here] = values
        return result

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
        """Return smallest and largest value over cells (see `extremes`), each as (place, value)."""
        places, values = extremes(lambda x: self.derivatives(x, 1), knots, cells=True)
        low, high = int(np.argmin(values)), int(np.argmax(values))
        return (float(places[low]), float(values[low])), (float(places[high]), float(values[high]))

    @property
    def last(self) -> float:
        """Value at the last knot, from the left."""
        return float(self.side(len(self.knots) - 1, -1, 0)[0])

    def side(self, knot: int, side: int, order: int) -> list[float]:
        """Return derivatives up to `order` at a knot from the piece on one `side` (-1 or +1)."""
        number = np.array([knot - 1 if side < 0 else knot])
        return self.on_pieces(number, self.knots[[knot]], order)[:, 0].tolist()

    @cached_property
    def continuity(self) -> tuple[int, ...]:
        """Order of continuity (-1 to 3) at each inner knot and, last, across the ends."""
        numbers = np.arange(len(self.pieces))
        before = self.on_pieces(numbers, self.knots[1:], 3)
        after = np.roll(self.on_pieces(numbers, self.knots[:-1], 3), -1, axis=1)
        scale = np.fmax(1.0, np.fmax.reduce(np.abs([*before, *after])))
        equal = np.abs(before - after) <= _SAME * scale
        return tuple((np.logical_and.accumulate(equal).sum(axis=0) - 1).tolist())


def piecewise(knots: ArrayLike, pieces: list[Piece]) -> Piecewise:
    """Return the function made of the pieces between the knots."""
    return Piecewise(
        knots=np.asarray(knots, dtype=float), pieces=tuple(pieces), offsets=np.zeros(len(pieces))
    )


def integrate(knots: ArrayLike, pieces: list[Piece], tolerance: float) -> Piecewise | Expansion:
    """Return the integral from the first knot, in closed form if every piece has one.

    Parameters
    ----------
    knots : (n + 1,) array
        Rising.
    pieces : list of n Piece
        The integrand.
    tolerance : float
        Relative truncation error of the expansion used otherwise.

    Returns
    -------
    Piecewise or Expansion
        A continuous function, zero at the first knot.

    Raises
    ------
    NotSmoothError
        If the integrand is not finite or not smooth between the knots.
    """
    grid = np.asarray(knots, dtype=float)
    closed = [
        replace(piece, function=piece.integral, integral=None)
        for piece in pieces
        if piece.integral is not None
    ]
    if len(closed) < len(pieces):
        return expand(piecewise(grid, pieces), grid, tolerance).antiderivative()
    parts, numbers = piecewise(grid, closed), np.arange(len(closed))
    starts, ends = (parts.on_pieces(numbers, x, 0)[0] for x in (grid[:-1], grid[1:]))
    totals = np.concatenate([[0.0], np.cumsum(ends - starts)])
    return replace(parts, offsets=totals[:-1] - starts)


def places_between(knots: ArrayLike, *, cells: bool = False) -> Array:
    """Return points in every interval between knots, both ends just inside.

    Parameters
    ----------
    knots : (n + 1,) array
        Rising.
    cells : bool
        Whether the knots include those found by an expansion: then the intervals resolve all
        features, and in total have as many points as the first step of expansions.

    Returns
    -------
    (n, k) array
        Rising.
    """
    grid = np.asarray(knots, dtype=float)
    width = np.diff(grid)
    most, least = (_PLACES_OF_CELLS, _LEAST_OF_CELL) if cells else (_PLACES, LEAST_PLACES)
    steps = np.linspace(_INSET, 1.0 - _INSET, max(most // len(width), least))
    x = grid[:-1, None] + width[:, None] * steps
    # in a narrow interval so small a share may round to the knot, which belongs to another piece
    x[:, 0] = np.maximum(x[:, 0], np.nextafter(grid[:-1], np.inf))
    x[:, -1] = np.minimum(x[:, -1], np.nextafter(grid[1:], -np.inf))
    return x


def extremes(
    function: Callable[[Array], Sequence[Array]], knots: ArrayLike, *, cells: bool = False
) -> tuple[Array, Array]:
    """Return all extremes of a function: roots of its slope, and both sides of its knots.

    Parameters
    ----------
    function : callable
        ``function(x) -> (values, slopes)``.
    knots : (n + 1,) array
        Between them the function is smooth.
    cells : bool
        See `places_between`.

    Returns
    -------
    places, values : (k,) arrays
        Candidates for the largest and smallest value, in rising order of place.
    """
    return extremes_of_each(lambda x: np.array(function(x))[:, None], knots, cells=cells)[0]


def extremes_of_each(
    functions: Callable[[Array], Array], knots: ArrayLike, *, cells: bool = False
) -> list[tuple[Array, Array]]:
    """Return the extremes of several functions at once (see `extremes`).

    Parameters
    ----------
    functions : callable
        ``functions(x) -> (values, slopes)``, an array (2, m, k) for m functions.
    knots : (n + 1,) array
        Between them the functions are smooth.
    cells : bool
        See `places_between`.

    Returns
    -------
    list of m (places, values)
    """
    x = places_between(knots, cells=cells)
    values, slopes = (found.reshape(-1, *x.shape) for found in functions(x.ravel()))
    # the outermost points are off the knots, their values are those at the knots
    inset = _INSET / (1.0 - 2.0 * _INSET) * (x[:, -1:] - x[:, :1]) * [-1.0, 1.0]
    values[..., _ENDS] += slopes[..., _ENDS] * inset
    return _extremes_among(functions, x, values, slopes)


def extremes_among(
    function: Callable[[Array], Sequence[Array]], x: Array, values: Array, slopes: Array
) -> tuple[Array, Array]:
    """Return the same from values and slopes that are already computed.

    Parameters
    ----------
    function : callable
        As for `extremes`.
    x : (n, k) array
        Points in n intervals, from `places_between`.
    values, slopes : (n, k) arrays
        Values and slopes there.

    Returns
    -------
    places, values : arrays
    """
    (found,) = _extremes_among(
        lambda t: np.array(function(t))[:, None], x, values[None], slopes[None]
    )
    return found


def _extremes_among(
    functions: Callable[[Array], Array], x: Array, values: Array, slopes: Array
) -> list[tuple[Array, Array]]:
    before, after, flat = slopes[..., :-1], slopes[..., 1:], slopes == 0.0
    # after a slope of 0 at a knot the function may rise and then fall steeply
    hidden = np.diff(flat) & opposite(np.diff(values), before + after)
    which, piece, cell = turns = np.nonzero(opposite(before, after) | hidden)
    before, after = before[turns], after[turns]
    known = np.where(before == 0.0, -after, before), np.where(after == 0.0, -before, after)
    number = np.arange(which.size)
    width = x[:, -1] - x[:, 0]  # none is left between knots that differ by rounding only
    roots = bracketed_root(
        lambda t: functions(t)[1, which, number],
        x[piece, cell],
        x[piece, cell + 1],
        _FLAT * float(width[width > 0.0].min(initial=np.inf)),
        known,
    )
    tops = functions(roots)[0, which, number] if roots.size else roots
    # a slope rounded to 0 has no change of sign: take the ends of such a stretch
    edge = flat.copy()
    edge[..., 1:-1] &= ~(flat[..., :-2] & flat[..., 2:])
    edge[..., _ENDS] = True
    found = []
    for k, own in enumerate(values):
        places = np.concatenate([x[edge[k]], roots[which == k]])
        order = np.argsort(places, kind="stable")
        found.append((places[order], np.concatenate([own[edge[k]], tops[which == k]])[order]))
    return found


def with_both_sides(places: Array, knots: Array) -> Array:
    """Return points on an axis that include both sides of knots, with enough between knots.

    Parameters
    ----------
    places : (n,) array
        Rising.
    knots : (m,) array
        Possible jumps of the drawn curve; those outside the points are left out.

    Returns
    -------
    (k,) array
        Rising: for a knot the last number before it, and the knot itself. Between close knots
        points are added, unless there are very many.
    """
    inside = distinct(knots[(knots > places[0]) & (knots < places[-1])])
    edges = np.concatenate([places[:1], inside, places[-1:]])
    gaps = np.diff(edges)
    each = min(_BETWEEN, _ADDED // gaps.size)
    narrow = np.diff(np.searchsorted(places, edges)) < each
    more = edges[:-1, None] + gaps[:, None] * np.arange(1, each) / max(each, 1)
    sides = [inside, np.nextafter(inside, -np.inf), more[narrow].ravel()]
    return distinct(places, *sides)
