"""Biarcs: chains of circular arcs fitted to curves.

A *biarc* is a pair of arcs with a common tangent at the joint, through two points with given
tangents. A run becomes a bulge polyline (see `bulges`) of biarcs, each as long as the tolerance
allows.

Points are complex numbers inside this room: turning and scaling a vector is one product.
Curvature, not radius, describes an arc, so that a nearly straight piece loses no digits.

Refused: runs that do not join to a closed chain, tolerances that are not positive.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.bulges import as_pairs, off_circle
from gearcam.numeric.contour import Run
from gearcam.numeric.fitting import longest_pieces, points_to_fit
from gearcam.numeric.hermite import on_cubics

Piece = list[tuple[complex, float]]
"""End point and bulge of each arc of a piece."""

MAX_TURN = 0.5 * math.pi
"""Largest angle that one biarc may turn through, rad: keeps its two arcs short of a half circle,
where distance to the arc and distance to the circle could differ."""

STRAIGHT = 1e-6
"""A piece counts as straight where its rise is below this part of the tolerance: far above
rounding, far below anything that a machine can follow."""

ROUNDING = 1e-15
"""Distance of two points, over that from the origin, that is nothing but rounding."""

SAME_ARC = 1e-6
"""Difference of the two end angles, rad, below which a biarc is written as one arc."""

NEAR = 0.02
"""The search stops where the longest fitting piece is known to this part of its length."""

CHECK_PART = 0.02
"""Part of the tolerance by which the arcs may leave the curve unseen between two checks."""

REACH = 3
"""Steps beside a bend over which an arc may carry on its curvature."""

MOST_CHECKS = 50
"""Most parts of a step: beyond, a run is too coarse to be judged by any number of checks."""


@dataclass(frozen=True, eq=False)
class _Curve:
    """A run as complex points and tangents, with the angle turned so far.

    Distances are taken at the `checks`: the points, and more between them where points are sparse
    beside a sharper bend; `place` is where each point stands among the checks.
    """

    points: Plane
    tangents: Plane
    turned: Array
    checks: Plane
    place: Ints


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
    curve = _curve(run, tolerance)
    last = len(curve.points) - 1
    pieces = longest_pieces(
        partial(_piece, curve, tolerance), partial(_furthest, curve), last, tolerance, 3, NEAR
    )
    ends, bulges = zip(*(arc for _, piece in pieces for arc in piece), strict=True)
    return as_pairs(np.array([curve.points[0], *ends])), np.array(bulges)


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


def _curve(run: Run, tolerance: float) -> _Curve:
    points, tangents = points_to_fit(run, tolerance)
    steps = np.angle(tangents[1:] * np.conj(tangents[:-1]))
    turned = np.concatenate([[0.0], np.cumsum(steps)])
    length = np.abs(np.diff(points))
    checks, place = _between(points, tangents, _checks(length, steps, tolerance))
    return _Curve(points, tangents, turned, checks, place)


def _checks(length: Array, turn: Array, tolerance: float) -> Ints:
    """Return into how many parts each step of a run is cut for checking.

    Next to a sharp bend an arc may carry on the bend's curvature over a long, flat step and leave
    the curve between its ends: such a step is cut as finely as the bend asks for.
    """
    bend = np.abs(turn) / length
    padded = np.pad(bend, REACH, mode="edge")
    sharpest = np.max([padded[k : k + len(bend)] for k in range(2 * REACH + 1)], axis=0)
    parts = np.ceil(length * np.sqrt(sharpest / (8 * CHECK_PART * tolerance)))
    return np.clip(parts, 1, MOST_CHECKS).astype(np.int64)


def _between(points: Plane, tangents: Plane, parts: Ints) -> tuple[Plane, Ints]:
    """Return points with others between them (cubic Hermite), and where the points stand."""
    place = np.concatenate([[0], np.cumsum(parts)])
    index = np.repeat(np.arange(len(parts)), parts)
    part = (np.arange(len(index)) - place[index]) / parts[index]
    return np.append(on_cubics(points, tangents, index, part)[0], points[-1]), place


def _furthest(curve: _Curve, start: int) -> int:
    """Return the last index to which the tangent turns by no more than `MAX_TURN`."""
    turned = np.abs(curve.turned[start + 1 :] - curve.turned[start])
    over = turned > MAX_TURN
    return start + max(1, int(np.argmax(over)) if over.any() else len(turned))


def _piece(curve: _Curve, tolerance: float, start: int, end: int) -> tuple[float, Piece]:
    """Return the largest distance and the arcs of the biarc between two points of the curve."""
    p, q = complex(curve.points[start]), complex(curve.points[end])
    t, u = complex(curve.tangents[start]), complex(curve.tangents[end])
    chord = q - p
    inner = curve.checks[curve.place[start] + 1 : curve.place[end]]
    if abs(chord) <= ROUNDING * abs(q):
        return float(np.abs(inner - p).max(initial=0.0)), [(q, 0.0)]
    first, second = cmath.phase(chord / t), cmath.phase(u / chord)
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


def _to_arc(points: Plane, start: complex, tangent: complex, end: complex) -> Array:
    """Return distances of points to the circle through two points with a tangent at the first."""
    chord = end - start
    bend = 2 * (chord / tangent).imag / abs(chord) ** 2
    local = (points - start) * tangent.conjugate()
    return off_circle(local, bend)
