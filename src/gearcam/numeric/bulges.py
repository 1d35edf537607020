"""Bulge polylines: chains of arcs and straight pieces, and exact distances to them.

A *bulge polyline* is what a DXF polyline holds: vertices, and for each piece its *bulge*, the
tangent of a quarter of the arc's angle, positive where the piece turns left, 0 where it is
straight.

Refused: another number of bulges than the vertices ask for.
"""

from __future__ import annotations

import math

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane

BLOCK = 24
"""Points whose distances are computed together."""


def as_complex(values: Array) -> Plane:
    """Return points (n, 2) as complex numbers (n,)."""
    return np.ascontiguousarray(values, dtype=np.float64).view(np.complex128).ravel()


def as_pairs(values: Plane) -> Array:
    """Return complex numbers (n,) as points (n, 2)."""
    return np.ascontiguousarray(values).view(np.float64).reshape(-1, 2)


def off_circle(local: Plane, bend: float | Array) -> Array:
    """Return distances to the circle that passes 0 along +x, or to the line.

    Parameters
    ----------
    local : complex array, mm
        Points in the frame whose origin is on the circle and whose x-axis is its tangent.
    bend : float or array, 1/mm
        Signed curvature, positive to the left, 0 for a line.

    Returns
    -------
    array, mm
        Never negative; no digits are lost where the curvature is small.
    """
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
    start, chord, bends = bulge_pieces(vertices, bulges, closed)
    points, _ = divided(start, chord, bends, np.maximum(arc_chords(chord, bends, sagitta), least))
    if not closed:
        points = np.append(points, as_complex(vertices)[-1])
    return as_pairs(points)


def arc_chords(chord: Plane, bends: Array, sagitta: float) -> Ints:
    """Return how many chords keep each piece within the `sagitta`, mm (see `bulge_pieces`)."""
    half = 2 * np.abs(np.arctan(bends))
    bent = half != 0
    radius = 0.5 * np.abs(chord[bent]) / np.sin(half[bent])
    # Sagitta of a chord over the angle w: r*(1 - cos(w/2)) = 2*r*sin(w/4)^2.
    widest = 4 * np.arcsin(np.minimum(np.sqrt(sagitta / (2 * radius)), 1.0))
    count = np.ones(len(half), dtype=np.int64)
    count[bent] = np.ceil(2 * half[bent] / widest)
    return count


def divided(start: Plane, chord: Plane, bends: Array, count: Ints) -> tuple[Plane, Ints]:
    """Return places that divide each piece evenly into a `count` of parts, and their pieces.

    Parameters
    ----------
    start, chord, bends : (n,) arrays
        Of the pieces (see `bulge_pieces`).
    count : (n,) int array
        Of parts.

    Returns
    -------
    points : (m,) complex array, mm
        The beginning of each part.
    piece : (m,) int array
        The number of the piece that it is of.
    """
    piece = np.repeat(np.arange(len(start)), count)
    share = (np.arange(len(piece)) - np.repeat(np.cumsum(count) - count, count)) / count[piece]
    return start[piece] + on_arcs(chord[piece], bends[piece], share)[0], piece


def on_arcs(chord: Plane, bends: Array, share: Array) -> tuple[Plane, Plane]:
    """Return places on arcs.

    Parameters
    ----------
    chord, bends : arrays, mm and 1
        Of the arcs (see `bulge_pieces`).
    share : array
        Of each arc's length, from 0 to 1.

    Returns
    -------
    way, slope : complex arrays, mm
        From the beginning, and by the share.
    """
    half = 2 * np.arctan(bends)
    safe = np.where(half == 0, 1.0, half)
    reach = np.where(half == 0, share, np.sin(share * safe) / np.sin(safe))
    way = chord * (reach * np.exp(1j * half * (share - 1)))
    return way, chord / np.sinc(half / np.pi) * np.exp(1j * half * (2 * share - 1))


def arc_centers(start: Plane, chord: Plane, bends: Array) -> Plane:
    """Return the centres of arcs, complex, mm (see `bulge_pieces`); none is straight."""
    return start + 0.5 * chord * (1 + 0.5j * (1 / bends - bends))


def bulge_pieces(vertices: Array, bulges: Array, closed: bool) -> tuple[Plane, Plane, Array]:
    """Return start, chord (complex, mm) and bulge of each piece (see `flatten_bulges`).

    Raises
    ------
    ValueError
        If another number of bulges is given than the vertices ask for.
    """
    points = as_complex(vertices)
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
    start, chord, bends = bulge_pieces(vertices, bulges, closed)
    real = chord != 0
    if real.any():
        start, chord, bends = start[real], chord[real], bends[real]
    middle, reach = start + 0.5 * chord, 0.5 * np.abs(chord) * np.maximum(1.0, np.abs(bends))
    targets = as_complex(points)
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


def _nearest(points: Plane, start: Plane, chord: Plane, bends: Array) -> Array:
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
    return np.where(beside, off_circle(local, bend), ends).min(axis=1)


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
