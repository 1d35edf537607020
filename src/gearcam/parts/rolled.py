"""A disc that rolls along an outline: where it touches, and where it touches two places at once.

The middle of a disc that touches a smooth run outside (or, with a negative radius, inside) runs on
the run's parallel. About a corner that opens towards the disc it runs on an arc; at one that closes
the parallels are joined through the corner itself. All of this is one closed *chain*, which may
cross itself. The chain is cut at its crossings, and what lies around the faces with a positive
winding number is the way that the disc can really go: *stretches* of runs and arcs, in order.

Everything is done on dense points with their exact tangents; crossings are then refined on the
cubics through them.

Refused: discs that leave no single way around.

Depends on numeric; shapely inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcam.errors import InfeasibleError
from gearcam.numeric.bulges import Complex, as_complex, as_pairs
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.cubics import on_cubics

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_SMOOTH: Final = 1e-9
"""Gap between parallels, in tolerances, below which no corner is between their runs."""

_DENSE: Final = 1 / 40
"""Chord error of dense points over the tolerance."""

_ROUNDS: Final = 16
_NARROWER: Final = 0.125
_TOGETHER: Final = 1e-15
"""Rounds in which a crossing is refined, how much narrower each looks, and the distance over that
from the axis at which it is found: rounding."""

_BESIDE: Final = 0.1
"""Steps of a run that its new ends keep from the points inside."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of a run between two places, counted in points of the run with fractions.

    Parameters
    ----------
    run : Run
        The run; of an arc about a corner the arc itself.
    by : float, mm
        How far the disc's middle is from it: 0 for an arc, which is its way already.
    low, high : float
        The places.
    corner : complex or None, mm
        Of an arc: what the disc touches all the while.
    """

    run: Run
    by: float
    low: float
    high: float
    corner: complex | None = None

    def place(self, at: float) -> tuple[complex, complex]:
        """Return point and unit tangent at a place: of the cubic through its neighbours."""
        p, t = as_complex(self.run.points), as_complex(self.run.tangents)
        k = min(max(int(at), 0), len(p) - 2)
        share = np.array([at - k])
        points, tangents = on_cubics(p[k : k + 2], t[k : k + 2], np.array([0]), share)
        return complex(points[0]), complex(tangents[0])

    def touched(self, at: float) -> complex:
        """Return what the disc touches at a place."""
        return self.place(at)[0] if self.corner is None else self.corner

    def middle(self, at: float) -> complex:
        """Return where the disc's middle is at a place."""
        point, tangent = self.place(at)
        return point - 1j * self.by * tangent

    @property
    def backwards(self) -> bool:
        """Whether the disc's middle goes against the outline: the disc is larger than its bend."""
        run = self.as_run(self.by)
        way, tangents = np.diff(as_complex(run.points)), as_complex(run.tangents)
        return float((way * np.conj(tangents[1:] + tangents[:-1])).real.sum()) < 0.0

    def as_run(self, by: float) -> Run:
        """Return the stretch, moved by `by`, mm, as a run of its own."""
        inner = np.arange(math.floor(self.low) + 1, math.ceil(self.high))
        # right beside an end, points would only show how exact tangents between points are
        inner = inner[(inner - self.low > _BESIDE) & (self.high - inner > _BESIDE)]
        ends = [self.place(self.low), self.place(self.high)]
        p = np.concatenate([[ends[0][0]], as_complex(self.run.points)[inner], [ends[1][0]]])
        t = np.concatenate([[ends[0][1]], as_complex(self.run.tangents)[inner], [ends[1][1]]])
        places = np.concatenate([[self.low], inner, [self.high]])
        joints = [int(np.argmin(np.abs(places - joint))) for joint in self.run.joints]
        inside = tuple(joint for joint in dict.fromkeys(joints) if 0 < joint < len(p) - 1)
        return Run(points=as_pairs(p - 1j * by * t), tangents=as_pairs(t), joints=inside)


@dataclass(frozen=True, eq=False)
class Rolled:
    """The way of a disc.

    Parameters
    ----------
    stretches : tuple of Stretch
        What it touches, in order, counter-clockwise.
    centers : tuple of complex or None, mm
        Behind each stretch, where the disc touches this and the next one at once; None where one
        ends as the next begins.
    """

    stretches: tuple[Stretch, ...]
    centers: tuple[complex | None, ...]

    @property
    def pairs(self) -> list[tuple[Stretch, Stretch, complex | None]]:
        """Each stretch with the next one and what is between them."""
        following = self.stretches[1:] + self.stretches[:1]
        return list(zip(self.stretches, following, self.centers, strict=True))


def roll(contour: Contour, radius: float) -> Rolled:
    """Roll a disc along a contour.

    Parameters
    ----------
    contour : Contour
        The outline.
    radius : float, mm
        Of the disc, outside positive, inside negative.

    Returns
    -------
    Rolled

    Raises
    ------
    InfeasibleError
        If the disc is too large to go around.
    """
    pieces = _pieces(contour, radius)
    chain = _chain(pieces)
    ring = _way(chain.points, contour, radius)
    stretches = list(_stretches(pieces, chain, ring))
    if not stretches:
        raise too_far(contour, radius)
    return _joined(stretches, contour, radius)


def _pieces(contour: Contour, radius: float) -> list[Stretch | Complex]:
    """Return the runs, arcs about opening corners, and chains through closing ones, in order."""
    runs = [_densified(run, radius, contour.tolerance) for run in contour.runs]
    made: list[Stretch | Complex] = []
    for run, following in zip(runs, [*runs[1:], runs[0]], strict=True):
        whole = Stretch(run, radius, 0.0, len(run.points) - 1.0)
        after = Stretch(following, radius, 0.0, 1.0)
        made.append(whole)
        (corner, before), (_, behind) = whole.place(whole.high), after.place(0.0)
        turn = float(np.angle(behind / before))
        if abs(turn * radius) <= _SMOOTH * contour.tolerance:
            continue
        if turn * radius > 0.0:
            arc = arc_run(corner, radius, -1j * before, -1j * behind, contour.tolerance)
            made.append(Stretch(arc, 0.0, 0.0, len(arc.points) - 1.0, corner))
        else:
            made.append(np.array([whole.middle(whole.high), corner, after.middle(0.0)]))
    return made


def arc_run(center: complex, radius: float, start: complex, end: complex, tolerance: float) -> Run:
    """Return an arc about a centre from one outward normal to the next.

    Parameters
    ----------
    center : complex, mm
        Its centre.
    radius : float, mm
        Positive: the arc bulges outwards, negative: inwards.
    start, end : complex
        Outward unit normals of the outline at its ends.
    tolerance : float, mm
        Of the outline.

    Returns
    -------
    Run
        Dense.
    """
    turn = float(np.angle(end / start))
    count = max(8, math.ceil(abs(turn) / math.sqrt(8.0 * _DENSE * tolerance / abs(radius))))
    spokes = start * np.exp(1j * turn * np.linspace(0.0, 1.0, count + 1))
    spokes[-1] = end
    tangents = 1j * spokes * math.copysign(1.0, turn * radius)
    return Run(points=as_pairs(center + radius * spokes), tangents=as_pairs(tangents))


def _densified(run: Run, radius: float, tolerance: float) -> Run:
    """Return a run with more points where its parallel would have too few."""
    p, t = as_complex(run.points), as_complex(run.tangents)
    turn = np.abs(np.angle(t[1:] * np.conj(t[:-1])))
    bow = 0.125 * turn * (np.abs(np.diff(p)) + abs(radius) * turn)
    parts = np.maximum(np.ceil(np.sqrt(bow / (_DENSE * tolerance))), 1.0).astype(np.int64)
    if (parts == 1).all():
        return run
    first = np.concatenate([[0], np.cumsum(parts)])
    step = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(step)) - first[step]) / parts[step]
    points, tangents = on_cubics(p, t, step, share)
    joints = tuple(int(first[joint]) for joint in run.joints)
    return Run(
        points=as_pairs(np.append(points, p[-1])),
        tangents=as_pairs(np.append(tangents, t[-1])),
        joints=joints,
    )


class _Chain(NamedTuple):
    """The closed chain of the disc's middle: points, and the piece and number of each."""

    points: Complex
    piece: Ints
    number: Ints


def _chain(pieces: list[Stretch | Complex]) -> _Chain:
    ways = [
        piece
        if isinstance(piece, np.ndarray)
        else as_complex(piece.run.points) - 1j * piece.by * as_complex(piece.run.tangents)
        for piece in pieces
    ]
    sizes = [len(way) for way in ways]
    return _Chain(
        points=np.concatenate(ways),
        piece=np.repeat(np.arange(len(ways)), sizes),
        number=np.concatenate([np.arange(size) for size in sizes]),
    )


def _way(chain: Complex, contour: Contour, radius: float) -> Complex:
    """Return the outer boundary of the faces of positive winding number, counter-clockwise."""
    from shapely import LineString, Polygon, get_coordinates, polygonize, unary_union

    closed = np.append(chain, chain[:1])
    faces: Any = polygonize([unary_union(LineString(as_pairs(closed)))])
    inner = [face for face in faces.geoms if _winding(closed, face) > 0]
    whole: Any = unary_union(inner)
    # slivers that rounding leaves between parallels that all but coincide
    least = contour.tolerance * float(np.abs(np.diff(closed)).sum()) * _SMOOTH
    parts = [part for part in getattr(whole, "geoms", [whole]) if part.area > least]
    if len(parts) != 1 or any(Polygon(hole).area > least for hole in parts[0].interiors):
        raise too_far(contour, radius)
    ring = as_complex(get_coordinates(parts[0].exterior))[:-1]
    return ring if parts[0].exterior.is_ccw else ring[::-1]


def _winding(closed: Complex, face: Any) -> int:
    """How often a closed chain goes around a face."""
    inside = face.representative_point()
    way = closed - complex(inside.x, inside.y)
    above = way.imag > 0.0
    rises, falls = ~above[:-1] & above[1:], above[:-1] & ~above[1:]
    left = (np.conj(way[:-1]) * way[1:]).imag
    return int((rises & (left > 0.0)).sum()) - int((falls & (left < 0.0)).sum())


def _segments(chain: _Chain, ring: Complex) -> Ints:
    """Return where in the chain the segment under each edge of the ring begins."""
    from shapely import STRtree, linestrings, points

    p, q = chain.points, np.roll(chain.points, -1)
    first = {edge: k for k, edge in enumerate(zip(p.tolist(), q.tolist(), strict=True))}
    edges = zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True)
    made = np.array([first.get(edge, -1) for edge in edges], dtype=np.int64)
    cut = np.flatnonzero(made < 0)  # a part of a segment only: beside a crossing
    if cut.size:
        lines: Any = linestrings(np.stack([as_pairs(p), as_pairs(q)], axis=1))
        tree = STRtree(lines)
        middle = points(as_pairs(0.5 * (ring + np.roll(ring, -1))[cut]))
        made[cut] = tree.query_nearest(middle, all_matches=False)[1]
    return made


def _stretches(pieces: list[Stretch | Complex], chain: _Chain, ring: Complex) -> Iterator[Stretch]:
    """Yield what the disc touches along the ring, stretch by stretch."""
    segment = _segments(chain, ring)
    inside = np.roll(chain.number, -1)[segment] > 0
    piece = np.where(inside, chain.piece[segment], -1)  # -1: between two pieces
    ahead = np.roll(segment, -1)
    goes_on = (np.roll(piece, -1) == piece) & (ahead >= segment) & (ahead <= segment + 1)
    ends = np.flatnonzero(~goes_on)
    if not ends.size:  # one smooth run all around
        ends = np.array([len(ring) - 1])
    last = np.roll(ends, 1)
    for before, end in zip(last.tolist(), ends.tolist(), strict=True):
        whole = pieces[int(piece[end])]
        if piece[end] < 0 or isinstance(whole, np.ndarray):
            continue
        start = (before + 1) % len(ring)
        low = _place(chain, int(segment[start]), ring[start])
        high = _place(chain, int(segment[end]), ring[(end + 1) % len(ring)])
        if low < high:
            yield Stretch(whole.run, whole.by, low, high, whole.corner)


def _place(chain: _Chain, segment: int, point: complex) -> float:
    """Return the place of a point on a segment, in points of its piece."""
    start, end = chain.points[segment], chain.points[(segment + 1) % len(chain.points)]
    length = abs(end - start)
    share = abs(point - start) / length if length else 0.0
    return float(chain.number[segment]) + min(share, 1.0)


def _joined(parts: list[Stretch], contour: Contour, radius: float) -> Rolled:
    """Refine where stretches meet."""
    centers: list[complex | None] = []
    for number in range(len(parts)):
        following = (number + 1) % len(parts)
        one, two = parts[number], parts[following]
        gap = abs(one.middle(one.high) - two.middle(two.low))
        if gap <= _SMOOTH * contour.tolerance and one.high == len(one.run.points) - 1.0:
            centers.append(None)
            continue
        center, high, low = _refined(one, two)
        parts[number] = replace(one, high=high)
        parts[following] = replace(parts[following], low=low)
        centers.append(center)
    if any(part.high < part.low or part.backwards for part in parts):
        raise too_far(contour, radius)
    return Rolled(tuple(parts), tuple(centers))


def _refined(one: Stretch, two: Stretch) -> tuple[complex, float, float]:
    """Return the crossing of two ways of the disc's middle, and its places.

    Each round crosses the chords through places on either side; they come nearer by the square of
    their distance, and stay within a step of the first ones.
    """
    high, low, reach = one.high, two.low, 1.0
    ends = [(0.0, len(stretch.run.points) - 1.0) for stretch in (one, two)]
    for _ in range(_ROUNDS):
        (i, k), (j, m) = (
            (max(at - reach, first), min(at + reach, last))
            for at, (first, last) in zip((high, low), ends, strict=True)
        )
        found = _crossing(
            np.array([one.middle(at) for at in (i, high, k)]),
            np.array([two.middle(at) for at in (j, low, m)]),
            np.array([i, high, k]),
            np.array([j, low, m]),
        )
        if found is None:  # it lies beside what was looked at
            reach = min(1.0, reach / _NARROWER**2)
        else:
            high, low = found
            reach *= _NARROWER
            if abs(one.middle(high) - two.middle(low)) < _TOGETHER * abs(one.middle(high)):
                break
    return 0.5 * (one.middle(high) + two.middle(low)), high, low


def _crossing(a: Complex, b: Complex, i: Array, j: Array) -> tuple[float, float] | None:
    """Return the places, on both, of the first crossing of two short chains."""
    p, r = a[:-1, None], np.diff(a)[:, None]
    q, s = b[None, :-1], np.diff(b)[None, :]
    cross = (np.conj(r) * s).imag
    with np.errstate(divide="ignore", invalid="ignore"):
        x = (np.conj(q - p) * s).imag / cross
        y = (np.conj(q - p) * r).imag / cross
    hit = (x >= 0.0) & (x <= 1.0) & (y >= 0.0) & (y <= 1.0)
    if not hit.any():
        return None
    k, m = (int(index[0]) for index in np.nonzero(hit))
    share, other = float(x[k, m]), float(y[k, m])
    return float(i[k] + share * (i[k + 1] - i[k])), float(j[m] + other * (j[m + 1] - j[m]))


def too_far(contour: Contour, radius: float) -> InfeasibleError:
    """Return the refusal of a disc of `radius`, mm, on a `contour`."""
    side = "outside" if radius > 0 else "inside"
    return InfeasibleError(
        f"no simple outline is left by a disc of this radius that rolls {side}",
        where=f"an outline of {np.ptp(contour.vertices[:, 0]):.6g} mm",
        value=abs(radius),
        unit="mm",
    )
