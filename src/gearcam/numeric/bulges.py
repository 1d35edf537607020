"""Bulge polylines: chains of arcs and straight lines, and the distances of curves from them.

A *bulge polyline* has the data of a DXF polyline: points, and for each piece its *bulge*, the
tangent of a quarter of the arc's angle, positive if the piece turns left, 0 if it is straight.
Points are complex numbers, in mm.
"""

from __future__ import annotations

import math

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane, in_groups

BLOCK = 20_000
"""Distances computed at once in the search for the nearest of all pieces."""


def off_circle(local: Plane, bend: float | Array) -> Array:
    """Return distances to the circle through 0 in the direction +x, or to the line.

    Parameters
    ----------
    local : complex array, mm
        Points in the frame whose origin is on the circle and whose x-axis is its tangent.
    bend : float or array, 1/mm
        Signed curvature, positive to the left, 0 for a line.

    Returns
    -------
    array, mm
        Not negative; without loss of digits where the curvature is small.
    """
    power = bend * (local.real**2 + local.imag**2) - 2 * local.imag
    return np.abs(power) / (1 + np.sqrt(np.maximum(1 + bend * power, 0.0)))


def flatten_bulges(
    points: Plane, bulges: Array, sagitta: float, closed: bool = True, least: int = 1
) -> Plane:
    """Return the points of chords that replace the arcs of a bulge polyline.

    Parameters
    ----------
    points : (k,) complex array, mm
        Points of the polyline.
    bulges : (k,) or (k - 1,) array
        Bulges; with `closed` one more, for the piece from the last point to the first.
    sagitta : float, mm
        Largest distance between an arc and its chords.
    closed : bool
        Whether the polyline is closed; the first point is not repeated.
    least : int
        Least number of chords of each piece, also of straight ones.

    Returns
    -------
    (n,) complex array, mm
        Points on the arcs, including those of the polyline.
    """
    start, chord, bends = bulge_pieces(points, bulges, closed)
    count = np.maximum(arc_chords(chord, bends, sagitta), least)
    ends, _ = divided(start, chord, bends, count)
    return ends if closed else np.append(ends, points[-1])


def arc_chords(chord: Plane, bends: Array, sagitta: float) -> Ints:
    """Return the numbers of chords within a `sagitta`, mm, of pieces (see `bulge_pieces`)."""
    half = 2 * np.abs(np.arctan(bends))
    bent = half != 0
    radius = 0.5 * np.abs(chord[bent]) / np.sin(half[bent])
    # sagitta of a chord over the angle w: r*(1 - cos(w/2)) = 2*r*sin(w/4)^2
    widest = 4 * np.arcsin(np.minimum(np.sqrt(sagitta / (2 * radius)), 1.0))
    count = np.ones(len(half), dtype=np.int64)
    count[bent] = np.ceil(2 * half[bent] / widest)
    return count


def divided(start: Plane, chord: Plane, bends: Array, count: Ints) -> tuple[Plane, Ints]:
    """Return points that divide each piece into `count` equal parts, and their pieces.

    Parameters
    ----------
    start, chord, bends : (n,) arrays
        Of the pieces (see `bulge_pieces`).
    count : (n,) int array
        Number of parts.

    Returns
    -------
    points : (m,) complex array, mm
        The beginning of each part.
    piece : (m,) int array
        The number of its piece.
    """
    piece, place = in_groups(count)
    share = place / count[piece]
    return start[piece] + on_arcs(chord[piece], bends[piece], share)[0], piece


def on_arcs(chord: Plane, bends: Array, share: Array) -> tuple[Plane, Plane]:
    """Return points on arcs.

    Parameters
    ----------
    chord, bends : arrays, mm and 1
        Of the arcs (see `bulge_pieces`).
    share : array
        Position as a share of each arc's length, from 0 to 1.

    Returns
    -------
    way, slope : complex arrays, mm
        Vector from the beginning, and its derivative by the share.
    """
    half = 2 * np.arctan(bends)
    safe = np.where(half == 0, 1.0, half)
    reach = np.where(half == 0, share, np.sin(share * safe) / np.sin(safe))
    way = chord * (reach * np.exp(1j * half * (share - 1)))
    return way, chord / np.sinc(half / np.pi) * np.exp(1j * half * (2 * share - 1))


def extremes(points: Plane, bulges: Array, closed: bool = True) -> Plane:
    """Return the points of a bulge polyline, and where its arcs run along an axis, complex, mm.

    Parameters
    ----------
    points, bulges, closed
        Of the polyline (see `flatten_bulges`).

    Returns
    -------
    (n,) complex array, mm
        Their bounding box is that of the polyline.
    """
    start, chord, bends = bulge_pieces(points, bulges, closed)
    bent = bends != 0
    start, chord, bends = start[bent], chord[bent], bends[bent]
    turn = 4 * np.arctan(bends)
    first = np.angle(chord) - 0.5 * turn
    axes = 0.5 * np.pi * np.arange(4)
    share = np.sign(turn)[:, None] * (axes - first[:, None]) % (2 * np.pi) / np.abs(turn)[:, None]
    piece, axis = np.nonzero(share < 1.0)
    found = start[piece] + on_arcs(chord[piece], bends[piece], share[piece, axis])[0]
    return np.concatenate([points, found])


def arc_centers(start: Plane, chord: Plane, bends: Array) -> Plane:
    """Return the centres of arcs, complex, mm (see `bulge_pieces`); no piece may be straight."""
    return start + 0.5 * chord * (1 + 0.5j * (1 / bends - bends))


def bulge_pieces(points: Plane, bulges: Array, closed: bool) -> tuple[Plane, Plane, Array]:
    """Return start, chord (complex, mm) and bulge of each piece (see `flatten_bulges`).

    Raises
    ------
    ValueError
        If the number of bulges does not match that of the points.
    """
    bends = np.asarray(bulges, dtype=np.float64)
    expected = len(points) if closed else len(points) - 1
    if len(bends) != expected:
        raise ValueError(f"{len(points)} points need {expected} bulges, not {len(bends)}")
    ends = np.roll(points, -1)
    return points[:expected], (ends - points)[:expected], bends


def farthest(targets: Plane, points: Plane, bulges: Array) -> float:
    """Return the largest distance of a closed curve's points from a closed bulge polyline.

    Parameters
    ----------
    targets : (n,) complex array, mm
        Points on the curve, in order; fast if the polyline begins near the first and has the same
        sense.
    points : (k,) complex array, mm
        The polyline.
    bulges : (k,) array
        Its bulges; arcs of half a circle at most.

    Returns
    -------
    float, mm
        The largest of the distances to the nearest points.

    Notes
    -----
    From the position of equal length each point descends to a nearest position, which may be only a
    local one at corners. The points that seem farthest are then compared with all pieces, until no
    other point can be farther.
    """
    start, chord, bends = bulge_pieces(points, bulges, closed=True)
    real = chord != 0
    if not real.any():  # all points coincide
        return float(np.abs(targets - start[0]).max())
    start, chord, half = start[real], chord[real], 2 * np.arctan(bends[real])
    size, end = np.abs(chord), start + chord
    into, out = (chord / size * np.exp(1j * sign * half) for sign in (-1, 1))
    bend = 2 * np.sin(half) / size

    def measured(targets: Plane, at: Ints) -> tuple[Array, Ints]:
        """Return distances to pieces, and the side (-1, 1) on which another piece may be nearer."""
        local, past = (targets - start[at]) * np.conj(into[at]), targets - end[at]
        side = ((past * np.conj(out[at])).real > 0).astype(np.int64) - (local.real < 0)
        ends = np.minimum(np.abs(local), np.abs(past))
        return np.where(side, ends, off_circle(local, bend[at])), side

    lengths = np.cumsum(size / np.sinc(half / np.pi))
    steps = np.abs(np.diff(targets, append=targets[0]))
    way = (np.cumsum(steps) - steps) * (lengths[-1] / steps.sum())
    piece = np.minimum(np.searchsorted(lengths, way, side="right"), len(start) - 1)
    least, side = measured(targets, piece)
    todo = np.flatnonzero(side)
    while todo.size:
        tried = (piece[todo] + side[todo]) % len(start)
        away, beyond = measured(targets[todo], tried)
        nearer = away < least[todo]
        todo, tried = todo[nearer], tried[nearer]
        piece[todo], least[todo], side[todo] = tried, away[nearer], beyond[nearer]
        todo = todo[side[todo] != 0]
    largest, every, order = 0.0, np.arange(len(start)), np.argsort(-least)
    count = max(1, BLOCK // len(start))
    for first in range(0, len(order), count):
        worst = order[first : first + count]
        if least[worst[0]] <= largest:
            break
        largest = max(largest, float(measured(targets[worst, None], every)[0].min(axis=1).max()))
    return largest


def deviation(points: Plane, bulges: Array, dense: Plane, samples: int = 8) -> float:
    """Return the largest distance between a closed bulge polyline and a closed dense polygon.

    Parameters
    ----------
    points : (k,) complex array, mm
        The polyline.
    bulges : (k,) array
        Its bulges.
    dense : (n,) complex array, mm
        Points on the true curve, in order, first not repeated.
    samples : int
        Points on each piece of the polyline for distances to the dense polygon.

    Returns
    -------
    float, mm
        The larger of two: from dense points to the polyline (exact), and from points of the
        polyline to the dense polygon, which includes the dense polygon's own chord error.
    """
    there = farthest(dense, points, bulges)
    places = flatten_bulges(points, bulges, math.inf, least=samples)
    back = farthest(places, dense, np.zeros(len(dense)))
    return max(there, back)
