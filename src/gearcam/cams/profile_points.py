"""The points of a cam profile: cleaned, bounded by blocks, and joined by local polynomials.

Where the points lie on a smooth curve, the curve over each chord is a graph: its height above the
chord is a polynomial through seven points. Five *stencils* are tried, as a corner or a jump of the
curvature may lie anywhere: centred, reaching to the left or to the right only, and the pair that
does not use the chord at all, one from each side, which meet somewhere over the chord.

Refused: fewer than eight points, numbers that are not finite, a profile that does not go around
the cam's axis once.

Source: derived anew; the choice of the smoothest stencil is that of ENO schemes (Harten, Engquist,
Osher, Chakravarthy, J. Comput. Phys. 71, 1987).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gearcam.errors import InfeasibleError
from gearcam.numeric.bulges import Complex, as_complex
from gearcam.numeric.roots import bracketed_root

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

FEWEST: Final = 8
"""Fewest points of a profile."""

_ALIKE: Final = 1e-12
"""Distance over the profile's size below which neighbours are one point: rounding."""

_STENCILS: Final = np.array(
    [
        [0, 1, -1, 2, -2, 3, -3],
        [0, 1, -1, -2, -3, -4, -5],
        [0, 1, 2, 3, 4, 5, 6],
        [0, -1, -2, -3, -4, -5, -6],
        [1, 2, 3, 4, 5, 6, 7],
    ]
)
"""Points of each stencil, counted from the start of the chord, those next to the chord first."""

_COSTS: Final = np.array([1.0, 4.0, 4.0, 64.0, 64.0])
"""By how much a stencil must be smoother than the centred one to be preferred: noise decides
nothing, and points from outside the chord are trusted last."""

_STRAIGHT: Final = 0.3
"""Smallest cosine between a chord and the others of its stencil: the curve must be a graph."""

_LOW: Final = 4
"""Points of the lower polynomial, whose difference from the full one estimates the error."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Pieces:
    """Smooth pieces of curve over chords: heights that are polynomials in the way along the chord.

    Parameters
    ----------
    owner : (p,) int array
        Which of the chords asked for.
    start, unit : (p,) complex arrays, mm and 1
        Start and direction of the chord.
    nodes, weights : (p, 7) arrays
        Newton's form: ways of the points, mm, and divided differences of the heights.
    low, high : (p,) arrays, mm
        Ends of the piece, ways along the chord.
    guessed : (p,) bool array
        Whether no stencil was smooth; the chord stands for the curve.
    """

    owner: Ints
    start: Complex
    unit: Complex
    nodes: Array
    weights: Array
    low: Array
    high: Array
    guessed: Mask

    def select(self, index: Mask) -> Pieces:
        """Return some of the pieces, by `index`."""
        return Pieces(**{name: values[index] for name, values in vars(self).items()})

    def at(self, way: Array, low: bool = False) -> tuple[Complex, Complex]:
        """Return points and derivatives by the way.

        Parameters
        ----------
        way : (p,) array, mm
            Ways along the chords.
        low : bool
            Whether to use the lower polynomial.

        Returns
        -------
        points, slopes : (p,) complex arrays, mm and 1
        """
        height, slope = newton(self.nodes, self.weights, way, _LOW if low else None)
        return self.start + (way + 1j * height) * self.unit, (1.0 + 1j * slope) * self.unit


@dataclass(frozen=True, eq=False, kw_only=True)
class ProfilePoints:
    """The points of a profile.

    Parameters
    ----------
    points : (n,) complex array, mm
        Counter-clockwise around the cam's axis at 0, no neighbours alike, first not repeated.
    """

    points: Complex

    @cached_property
    def size(self) -> float:
        """Largest distance from the axis, mm."""
        return float(np.abs(self.points).max())

    @cached_property
    def chords(self) -> Complex:
        """From each point to the next, mm."""
        return np.roll(self.points, -1) - self.points

    @cached_property
    def sagitta(self) -> Array:
        """Estimated height of the curve over each chord, mm: the larger of its ends' curvatures."""
        length, before = np.abs(self.chords), np.roll(self.chords, 1)
        turn = np.abs(np.angle(self.chords * np.conj(before)))
        bend = 2.0 * turn / (length + np.abs(before))
        return np.maximum(bend, np.roll(bend, -1)) * length**2 / 8.0

    @cached_property
    def blocks(self) -> tuple[Ints, Complex, Array]:
        """Blocks of neighbouring chords, and a disc around the curve over each.

        Returns
        -------
        chords : (b, k) int array
            Their numbers; the last block begins earlier, so that it is full too.
        middle : (b,) complex array, mm
        radius : (b,) array, mm
            The estimated heights of the curve are counted twice.
        """
        count = len(self.points)
        width = max(FEWEST, math.isqrt(count) // 2)
        first = np.minimum(np.arange(0, count, width), count - width)
        index = first[:, None] + np.arange(width)
        reach = self.points[(first[:, None] + np.arange(width + 1)) % count]
        middle = 0.5 * (reach[:, 0] + reach[:, -1])
        radius = np.abs(reach - middle[:, None]).max(axis=1)
        return index, middle, radius + 2.0 * self.sagitta[index].max(axis=1)

    def pieces(self, chords: Ints) -> Pieces:
        """Return the smooth curve over some chords.

        Parameters
        ----------
        chords : (m,) int array
            Numbers of the chords.

        Returns
        -------
        Pieces
            One for each chord, or two where a corner or a jump of the curvature lies over it.
        """
        start, chord = self.points[chords], self.chords[chords]
        length = np.abs(chord)
        unit = chord / length
        index = (chords[:, None, None] + _STENCILS) % len(self.points)
        local = (self.points[index] - start[:, None, None]) * np.conj(unit)[:, None, None]
        nodes, weights, rough = _interpolate(local)
        cost = np.where(np.isfinite(rough), rough * _COSTS, np.inf)
        cost[:, 3:] = cost[:, 3:].max(axis=1, keepdims=True)
        best = np.argmin(cost, axis=1)
        owner = np.arange(len(chords))
        guessed = np.isinf(cost[owner, best])
        weights[guessed] = 0.0
        nodes[guessed] = 0.0
        split = best == 3
        joint = length.copy()
        joint[split] = _meeting(nodes[split, 3:], weights[split, 3:], length[split])
        both = np.concatenate([owner, owner[split]])
        which = np.concatenate([best, np.full(np.count_nonzero(split), 4)])
        return Pieces(
            owner=both,
            start=start[both],
            unit=unit[both],
            nodes=nodes[both, which],
            weights=weights[both, which],
            low=np.concatenate([np.zeros(len(owner)), joint[split]]),
            high=np.concatenate([joint, length[split]]),
            guessed=guessed[both],
        )


def profile_points(points: Complex | Array) -> ProfilePoints:
    """Return the points of a profile, cleaned.

    Parameters
    ----------
    points : (n,) complex array or (n, 2) array, mm
        A closed profile in order, either way around; equal neighbours are dropped.

    Returns
    -------
    ProfilePoints

    Raises
    ------
    InfeasibleError
        If the points are no closed profile around the cam's axis.
    """
    z = in_plane(points)
    if not np.all(np.isfinite(z)):
        raise InfeasibleError(
            "the profile holds numbers that are not finite",
            where=f"point {int(np.argmin(np.isfinite(z)))}",
        )
    z = z[np.abs(z - np.roll(z, 1)) > _ALIKE * np.abs(z).max(initial=0.0)]
    if len(z) < FEWEST:
        raise InfeasibleError(
            "the profile has too few points", value=len(z), limit=FEWEST, unit="points"
        )
    around = float(np.angle(np.roll(z, -1) * np.conj(z)).sum()) / (2.0 * math.pi)
    if abs(abs(around) - 1.0) > 0.25 or not np.all(z):
        raise InfeasibleError(
            "the profile does not go around the cam's axis once",
            value=around,
            limit=1.0,
            unit="turns",
            nearest="one closed line in order, with the origin inside",
        )
    return ProfilePoints(points=z if around > 0.0 else z[::-1].copy())


def in_plane(points: Complex | Array) -> Complex:
    """Return points, complex numbers (n,) or pairs (n, 2), as complex numbers."""
    if np.iscomplexobj(points):
        return np.asarray(points, dtype=np.complex128)
    return as_complex(np.asarray(points, dtype=np.float64))


def newton(nodes: Array, weights: Array, x: Array, terms: int | None = None) -> tuple[Array, Array]:
    """Return values and derivatives of polynomials in Newton's form.

    Parameters
    ----------
    nodes, weights : (..., k) arrays
        Nodes and divided differences.
    x : (...) array
        Places.
    terms : int, optional
        How many of the first terms to use; all if left out.

    Returns
    -------
    value, slope : (...) arrays
    """
    value, slope = np.zeros_like(x), np.zeros_like(x)
    for k in reversed(range(terms or weights.shape[-1])):
        ahead = x - nodes[..., k]
        slope = slope * ahead + value
        value = value * ahead + weights[..., k]
    return value, slope


def _interpolate(local: Complex) -> tuple[Array, Array, Array]:
    """Return nodes, divided differences and roughness of the heights `local` (..., 7).

    The roughness bounds the error of the polynomial, mm; infinite where the curve is no graph.
    """
    nodes, weights = local.real.copy(), local.imag.copy()
    order = np.argsort(_STENCILS, axis=-1)
    steps = np.diff(np.take_along_axis(local, order[None], axis=-1), axis=-1)
    graph = np.all(steps.real > _STRAIGHT * np.abs(steps), axis=-1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for k in range(1, weights.shape[-1]):
            weights[..., k:] = (weights[..., k:] - weights[..., k - 1 : -1]) / (
                nodes[..., k:] - nodes[..., :-k]
            )
    rough = np.full(graph.shape, np.inf)
    # two orders: at a corner amid its points one of the differences may vanish by symmetry
    span, last = np.ptp(nodes[graph], axis=-1), np.abs(weights[graph][:, -2:])
    rough[graph] = (last[:, 0] + last[:, 1] * span) * span ** (weights.shape[-1] - 2)
    return nodes, weights, rough


def _meeting(nodes: Array, weights: Array, length: Array) -> Array:
    """Return where over their chords the curves (m, 2, 7) from the left and the right meet.

    At a corner they cross, at a jump of the curvature they touch.
    """

    def apart(way: Array, some: Mask, order: int) -> Array:
        left = newton(nodes[some, 0], weights[some, 0], way)[order]
        return left - newton(nodes[some, 1], weights[some, 1], way)[order]

    every = np.ones(len(length), dtype=bool)
    zero = np.zeros(len(length))
    # the joint is at an end where neither is seen: there the two are nearest
    nearer = np.abs(apart(zero, every, 0)) < np.abs(apart(length, every, 0))
    meeting = np.where(nearer, 0.0, length)
    for order in (1, 0):
        change = apart(zero, every, order) * apart(length, every, order) < 0.0

        def miss(way: Array, some: Mask = change, order: int = order) -> Array:
            return apart(way, some, order)

        tolerance = 1e-12 * float(length.max(initial=0.0))
        meeting[change] = bracketed_root(miss, zero[change], length[change], tolerance)
    return meeting
