"""Chains of circular arcs: biarcs fitted to curves, and exact distances to them.

A *bulge polyline* is what a DXF polyline holds: vertices, and for each piece its *bulge*, the
tangent of a quarter of the arc's angle, positive where the piece turns left, 0 where it is
straight. A *biarc* is a pair of arcs with a common tangent at the joint, through two points with
given tangents.

Points are complex numbers inside this room: turning and scaling a vector is one product.
Curvature, not radius, describes an arc, so that a nearly straight piece loses no digits.

Refused: runs that do not join to a closed chain, tolerances that are not positive.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.contour import Run

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Piece = list[tuple[complex, float]]
"""End point and bulge of each arc of a piece."""

MAX_TURN = 0.5 * math.pi
"""Largest angle that one biarc may turn through, rad: keeps its two arcs short of a half circle,
where distance to the arc and distance to the circle could differ."""

STRAIGHT = 1e-6
"""A piece counts as straight where its rise is below this part of the tolerance: far above
rounding, far below anything that a machine can follow."""

SAME_ARC = 1e-6
"""Difference of the two end angles, rad, below which a biarc is written as one arc."""

AIM = 0.97
"""Part of the predicted length that the search tries: a little short, so that most succeed."""

NEAR = 0.02
"""The search stops where the longest fitting piece is known to this part of its length."""

BLOCK = 24
"""Points whose distances are computed together."""


@dataclass(frozen=True, eq=False)
class _Curve:
    """A run as complex points and tangents, with the angle turned so far."""

    points: Complex
    tangents: Complex
    turned: Array


def _complex(values: Array) -> Complex:
    return np.ascontiguousarray(values, dtype=np.float64).view(np.complex128).ravel()


def _pairs(values: Complex) -> Array:
    return np.ascontiguousarray(values).view(np.float64).reshape(-1, 2)


def fit_arcs(run: Run, tolerance: float) -> tuple[Array, Array]:
    """Fit tangent-continuous arcs to a run, each pair as long as the tolerance allows.

    From the start on, the longest piece is sought whose biarc stays within the tolerance of the
    run's points. The error grows with the third power of the length, so each trial predicts the
    next one. Distances are taken from the run's points to the arcs; the other way round they can
    be larger by the run's own chord error only, since arc and run share both ends and both end
    tangents.

    Parameters
    ----------
    run : Run
        A smooth piece, mm.
    tolerance : float, mm
        Largest distance between the run's points and the arcs.

    Returns
    -------
    vertices : (k, 2) array, mm
        Both ends of the run, and the knots between.
    bulges : (k - 1,) array
        Tangent of a quarter of each arc's angle, positive to the left, 0 for a straight piece.

    Raises
    ------
    ValueError
        If the tolerance is not positive, or the run is not finite or has fewer than two different
        points.
    """
    if not tolerance > 0:
        raise ValueError(f"the tolerance must be positive, not {tolerance}")
    curve = _curve(run)
    last = len(curve.points) - 1
    if last < 1:
        raise ValueError("a run needs at least two different points")
    knots, bulges = [complex(curve.points[0])], []
    start, guess = 0, last
    while start < last:
        end, piece = _longest(curve, start, guess, tolerance)
        for point, bulge in piece:
            knots.append(point)
            bulges.append(bulge)
        start, guess = end, end - start
    return _pairs(np.array(knots)), np.array(bulges)


def fit_closed(runs: Sequence[Run], tolerance: float) -> tuple[Array, Array]:
    """Fit arcs to a closed chain of runs.

    Parameters
    ----------
    runs : sequence of Run
        In order; each begins where the one before ends.
    tolerance : float, mm
        As for `fit_arcs`.

    Returns
    -------
    vertices : (k, 2) array, mm
        First point not repeated.
    bulges : (k,) array
        Bulge k belongs to the piece from vertex k to the next one.

    Raises
    ------
    ValueError
        If the runs do not join within the tolerance.
    """
    vertices, bulges = [], []
    for run, after in zip(runs, [*runs[1:], runs[0]], strict=True):
        gap = math.dist(run.points[-1], after.points[0])
        if gap > tolerance:
            raise ValueError(f"runs do not join: a gap of {gap:.3g} mm")
        points, bends = fit_arcs(run, tolerance)
        vertices.append(points[:-1])
        bulges.append(bends)
    return np.vstack(vertices), np.concatenate(bulges)


def _curve(run: Run) -> _Curve:
    points, tangents = _complex(run.points), _complex(run.tangents)
    if not (np.isfinite(points).all() and np.isfinite(tangents).all()):
        raise ValueError("points and tangents of a run must be finite")
    kept = np.concatenate([[True], np.diff(points) != 0])
    points, tangents = points[kept], tangents[kept]
    steps = np.angle(tangents[1:] * np.conj(tangents[:-1]))
    return _Curve(points, tangents, np.concatenate([[0.0], np.cumsum(steps)]))


def _longest(curve: _Curve, start: int, guess: int, tolerance: float) -> tuple[int, Piece]:
    """Return end and arcs of the longest piece from `start` that stays within the tolerance."""
    low, best = start + 1, _piece(curve, start, start + 1, tolerance)[1]
    high = _furthest(curve, start)
    trial, rounds = min(start + guess, high), 0
    while high - low > NEAR * (low - start):
        rounds += 1
        trial = min(max(trial, low + 1), high)
        error, piece = _piece(curve, start, trial, tolerance)
        if error <= tolerance:
            low, best = trial, piece
        else:
            high = trial - 1
        growth = AIM * (tolerance / max(error, 1e-3 * tolerance)) ** (1 / 3)
        trial = start + round(growth * (trial - start)) if rounds % 3 else (low + high + 1) // 2
    return low, best


def _furthest(curve: _Curve, start: int) -> int:
    """Return the last index to which the tangent turns by no more than `MAX_TURN`."""
    turned = np.abs(curve.turned[start + 1 :] - curve.turned[start])
    over = turned > MAX_TURN
    return start + max(1, int(np.argmax(over)) if over.any() else len(turned))


def _piece(curve: _Curve, start: int, end: int, tolerance: float) -> tuple[float, Piece]:
    """Return the largest distance and the arcs of the biarc between two points of the curve."""
    p, q = complex(curve.points[start]), complex(curve.points[end])
    t, u = complex(curve.tangents[start]), complex(curve.tangents[end])
    chord = q - p
    first, second = cmath.phase(chord / t), cmath.phase(u / chord)
    inner = curve.points[start + 1 : end]
    if abs(first - second) < SAME_ARC and abs(first) < 1:
        half = 0.5 * (first + second)
        return _largest(_to_arc(inner, p, t, q)), [(q, _bulge(half, chord, tolerance))]
    along = 2 * (chord * (t + u).conjugate()).real
    twist = 2 - 2 * (t * u.conjugate()).real
    root = along + math.sqrt(along * along + 4 * twist * abs(chord) ** 2)
    straight: tuple[float, Piece] = (math.inf, [(q, 0.0)])
    if along <= 0:
        return straight
    # Equal tangent lengths d on both sides of the joint (Bolton 1975): twist*d^2 + along*d =
    # |chord|^2.
    length = 2 * abs(chord) ** 2 / root
    joint = 0.5 * (p + q + length * (t - u))
    first, second = cmath.phase((joint - p) / t), cmath.phase(u / (q - joint))
    if max(abs(first), abs(second)) > 0.5 * MAX_TURN:
        return straight
    middle = t * cmath.exp(2j * first)
    before = ((inner - joint) * middle.conjugate()).real < 0
    error = max(
        _largest(_to_arc(inner[before], p, t, joint)),
        _largest(_to_arc(inner[~before], joint, middle, q)),
    )
    pieces = [
        (joint, _bulge(first, joint - p, tolerance)),
        (q, _bulge(second, q - joint, tolerance)),
    ]
    return error, pieces


def _bulge(half: float, chord: complex, tolerance: float) -> float:
    """Return the bulge of an arc that turns by ``2 * half``; 0 where it hardly rises."""
    bulge = math.tan(0.5 * half)
    return bulge if 0.5 * abs(bulge * chord) > STRAIGHT * tolerance else 0.0


def _largest(values: Array) -> float:
    return float(values.max()) if values.size else 0.0


def _to_arc(points: Complex, start: complex, tangent: complex, end: complex) -> Array:
    """Return distances of points to the circle through two points with a tangent at the first."""
    chord = end - start
    bend = 2 * (chord / tangent).imag / abs(chord) ** 2
    local = (points - start) * tangent.conjugate()
    return _off_circle(local, bend)


def _off_circle(local: Complex, bend: float | Array) -> Array:
    """Return distances to the circle through 0 along +x of signed curvature `bend` (or line)."""
    power = bend * (local.real**2 + local.imag**2) - 2 * local.imag
    return np.abs(power) / (1 + np.sqrt(np.maximum(1 + bend * power, 0.0)))


def flatten_bulges(
    vertices: Array, bulges: Array, sagitta: float, closed: bool = True, least: int = 1
) -> Array:
    """Replace the arcs of a bulge polyline by chords.

    Parameters
    ----------
    vertices : (k, 2) array, mm
        Vertices of the polyline.
    bulges : (k,) or (k - 1,) array
        Bulges; one more for the piece from the last vertex to the first where `closed`.
    sagitta : float, mm
        Largest distance between an arc and its chords.
    closed : bool
        Whether the polyline is closed; the first point is not repeated.
    least : int
        Fewest chords of each piece, straight ones too.

    Returns
    -------
    (n, 2) array, mm
        Points on the arcs, the vertices among them.
    """
    start, chord, bends = _pieces(vertices, bulges, closed)
    half = 2 * np.arctan(bends)
    bent = half != 0
    radius = 0.5 * np.abs(chord[bent] / np.sin(half[bent]))
    # Sagitta of a chord over the angle w: r*(1 - cos(w/2)) = 2*r*sin(w/4)^2.
    widest = 4 * np.arcsin(np.minimum(np.sqrt(sagitta / (2 * radius)), 1.0))
    count = np.ones(len(start), dtype=int)
    count[bent] = np.ceil(2 * np.abs(half[bent]) / widest).astype(int)
    count = np.maximum(count, least)
    index = np.repeat(np.arange(len(start)), count)
    part = (np.arange(len(index)) - np.repeat(np.cumsum(count) - count, count)) / count[index]
    points = start[index] + chord[index] * _along(half[index], part)
    if not closed:
        points = np.append(points, _complex(vertices)[-1])
    return _pairs(points)


def _along(half: Array, part: Array) -> Complex:
    """Return the place on an arc over the chord from 0 to 1 that turns by ``2 * half``."""
    safe = np.where(half == 0, 1.0, half)
    reach = np.where(half == 0, part, np.sin(part * safe) / np.sin(safe))
    return reach * np.exp(1j * half * (part - 1))


def _pieces(vertices: Array, bulges: Array, closed: bool) -> tuple[Complex, Complex, Array]:
    """Return start, chord and bulge of each piece."""
    points = _complex(vertices)
    bends = np.asarray(bulges, dtype=np.float64)
    expected = len(points) if closed else len(points) - 1
    if len(bends) != expected:
        raise ValueError(f"{len(points)} vertices need {expected} bulges, not {len(bends)}")
    ends = np.roll(points, -1)
    return points[:expected], (ends - points)[:expected], bends


def distances(points: Array, vertices: Array, bulges: Array, closed: bool = True) -> Array:
    """Return the exact distance of each point to the nearest place of a bulge polyline.

    Parameters
    ----------
    points : (n, 2) array, mm
        Any points; fast where neighbours in the array are neighbours in the plane.
    vertices, bulges, closed
        The polyline, as for `flatten_bulges`.

    Returns
    -------
    (n,) array, mm
        Never negative.

    Notes
    -----
    Points are taken by blocks. A disc around a block and a disc around each piece bound their
    distance from both sides; only pieces that can be the nearest are computed.
    """
    start, chord, bends = _pieces(vertices, bulges, closed)
    real = chord != 0
    if real.any():
        start, chord, bends = start[real], chord[real], bends[real]
    middle, reach = start + 0.5 * chord, 0.5 * np.abs(chord) * np.maximum(1.0, np.abs(bends))
    targets = _complex(points)
    result = np.empty(len(targets))
    for first in range(0, len(targets), BLOCK):
        block = targets[first : first + BLOCK]
        centre = 0.5 * (block.real.min() + block.real.max()) + 0.5j * (
            block.imag.min() + block.imag.max()
        )
        spread = np.abs(block - centre).max()
        away = np.abs(middle - centre)
        near = away - reach - spread <= (away + reach).min() + spread
        result[first : first + BLOCK] = _nearest(block, start[near], chord[near], bends[near])
    return result


def _nearest(points: Complex, start: Complex, chord: Complex, bends: Array) -> Array:
    """Return the distance of points (n,) to the nearest of the pieces (k,)."""
    half = 2 * np.arctan(bends)
    length = np.abs(chord)
    unit = np.divide(chord, length, out=np.ones_like(chord), where=length > 0)
    into, out = unit * np.exp(-1j * half), unit * np.exp(1j * half)
    bend = np.divide(2 * np.sin(half), length, out=np.zeros_like(length), where=length > 0)
    from_start = points[:, None] - start
    from_end = from_start - chord
    local = from_start * np.conj(into)
    ahead, behind = local.real >= 0, (from_end * np.conj(out)).real <= 0
    # Inside the arc's sector the circle is nearest, elsewhere one of the two ends.
    beside = np.where(np.abs(bends) <= 1, ahead & behind, ahead | behind)
    ends = np.minimum(np.abs(from_start), np.abs(from_end))
    return np.where(beside, _off_circle(local, bend), ends).min(axis=1)


def deviation(vertices: Array, bulges: Array, dense: Array, samples: int = 8) -> float:
    """Measure how far a closed bulge polyline and a closed dense polygon are from each other.

    Parameters
    ----------
    vertices : (k, 2) array, mm
        The polyline.
    bulges : (k,) array
        Its bulges.
    dense : (n, 2) array, mm
        Points on the true curve, in order, first not repeated.
    samples : int
        Places on each piece of the polyline whose distance to the dense polygon is taken.

    Returns
    -------
    float, mm
        The larger of both ways: dense points to the polyline (exact), places on the polyline to the
        dense polygon. The second way holds the dense polygon's own chord error.
    """
    there = distances(dense, vertices, bulges).max()
    places = flatten_bulges(vertices, bulges, math.inf, least=samples)
    back = distances(places, dense, np.zeros(len(dense))).max()
    return float(max(there, back))
