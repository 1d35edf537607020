"""Laws of pairs in 30 digits: the mathematics of every law once more.

Each names its parameters once, as doubles, and writes its mathematics anew for
`witness.exact`, where every double is taken as it is. Of a table the quintics are the law: their
coefficients are read from it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.centrodes import LogSpiral
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.shapes import BSplineLaw, RoundedPolygon
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from gearcam.laws.ratio.table import TableLaw
from witness import exact
from witness.exact import Exact, Function, Piece, Slope, mp, of_radius

TURN = 2.0 * math.pi
RING_TYPE = {1: "external", 0: "external", -1: "internal"}
Number = Any


@dataclass(frozen=True, eq=False)
class Case:
    """A pair.

    Parameters
    ----------
    name : str
        Its law and number.
    law : parameters of a law
        As designs have them.
    teeth : (int, int)
        Tooth counts.
    exact : callable
        ``exact(law)`` returns what it is; the built law gives places to begin with.
    mate : {1, 0, -1}
        External wheel, rack, ring.
    """

    name: str
    law: Any
    teeth: tuple[int, int]
    exact: Callable[[RatioLaw], Exact]
    mate: int = WHEEL

    @property
    def lobes(self) -> Lobes:
        common = math.gcd(*self.teeth)
        mate = RING if self.mate == RING else WHEEL
        return Lobes(self.teeth[0] // common, self.teeth[1] // common, mate)


def turn_of(count: int) -> Number:
    return 2 * mp.pi / count


def of(value: Any) -> Number:
    return mp.mpf(float(value))


def whole(function: Function, period: Number, parts: int = 4) -> list[Piece]:
    """One function over a period."""
    edges = [period * k / parts for k in range(parts + 1)]
    return [(low, high, function) for low, high in pairwise(edges)]


def closed_by(function: Function, period: Number, advance: Number, mate: int) -> Exact:
    """Scale a ratio so that it closes."""
    mean = Exact(whole(function, period), 0).integral.sums[-1][0]
    return Exact(whole(lambda x: function(x) * (advance / mean), period), mate)


def by_radius(pieces: Sequence[Piece], advance: Number, mate: int) -> Callable[[RatioLaw], Exact]:
    def make(law: RatioLaw) -> Exact:
        # whatever is near: the ratio tells the distance at any place
        x = of(0.3) * pieces[-1][1]
        shape = next(shape for _, high, shape in pieces if x <= high)
        r, i = shape(Slope(x, mp.mpf(1))).v, of(law.ratio(float(x)))
        return of_radius(pieces, advance, mate, float(r / i + mate * r))[0]

    return make


# --- the laws -------------------------------------------------------------------------------------


def ellipse(e: float, n: tuple[int, int] = (1, 1), mate: int = WHEEL) -> Callable[[Any], Exact]:
    shape = whole(lambda x: 1 / (1 + of(e) * exact.cos(n[0] * x)), turn_of(n[0]))
    return by_radius(shape, turn_of(n[1]), mate)


def circle(e: float, mate: int, turns: int) -> Callable[[Any], Exact]:
    def radius(x: Slope) -> Slope:
        across = of(e) * exact.sin(x)
        return of(e) * exact.cos(x) + exact.sqrt(1 - across * across)

    return by_radius(whole(radius, turn_of(1), 8), turn_of(turns), mate)


def lobed(e: float, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    shape = whole(lambda x: 1 + of(e) * exact.cos(n[0] * x), turn_of(n[0]))
    return by_radius(shape, turn_of(n[1]), mate)


def spiral(law: LogSpiral, mate: int) -> Callable[[Any], Exact]:
    start, end = (of(value) for value in law.ratios)
    first, turn = start / (1 + mate * start), (1 + mate * end) / (1 + mate * start)
    growth = mate * mp.log(turn) / of(law.driven_travel)
    travel = mp.log(end / start / turn) / growth

    def ratio(x: Slope) -> Slope:
        share = first * exact.exp(growth * x)
        return share / (1 - mate * share)

    return lambda _: Exact(whole(ratio, travel), mate)


def nautilus(law: LogSpiral) -> Callable[[Any], Exact]:
    """A closed spiral: phi1 = t + h and phi2 = t - h, t from the middle of the return."""
    k, turn = mp.sqrt(of(law.ratios[1]) / of(law.ratios[0])), of(law.return_angle)
    joint, half = 2 * mp.pi - turn, turn / 2
    c = mp.log(k) / joint
    # h' = a*t + b*t^3 + e*t^5 meets -tanh(c*(t - pi)) at the end, up to the second derivative
    v = mp.tanh(c * (mp.pi - half))
    rows = [[half, half**3, half**5], [1, 3 * half**2, 5 * half**4], [0, 6 * half, 20 * half**3]]
    d = -c * (1 - v * v)
    a, b, e = mp.lu_solve(mp.matrix(rows), mp.matrix([v, d, 2 * c * v * d]))

    def h(t: Number) -> Number:
        return a * t**2 / 2 + b * t**4 / 4 + e * t**6 / 6

    def slope(t: Any) -> Any:
        return a * t + b * t**3 + e * t**5

    def falling(x: Slope) -> Slope:
        t, goal = mp.mpf(0), x.v - (2 * mp.pi - half - h(half))
        for _ in range(40):
            t -= (t + h(t) - goal) / (1 + slope(t))
        here = slope(Slope(t, x.d / (1 + slope(t))))
        return (1 - here) / (1 + here)

    def rising(x: Slope) -> Slope:
        share = exact.exp(c * x) / (1 + k)
        return share / (1 - share)

    pieces = [*whole(rising, joint), *((joint + turn * j / 8, joint + turn * (j + 1) / 8, falling)
                                       for j in range(8))]  # fmt: skip
    return lambda _: Exact(pieces, WHEEL)


Shape = tuple[Callable[[Slope], Slope], Number]
"""What rises from 0 to 1 over the unit interval, and its mean."""

SHAPES: dict[str, Shape] = {
    "cosine": (lambda t: (1 - exact.cos(mp.pi * t)) / 2, mp.mpf(1) / 2),
    "cubic": (lambda t: t * t * (3 - 2 * t), mp.mpf(1) / 2),
    "quintic": (lambda t: t**3 * (10 + t * (6 * t - 15)), mp.mpf(1) / 2),
    "sine": (lambda t: exact.sin(mp.pi / 2 * t), 2 / mp.pi),
}


def arc(low: Number, high: Number, start: Number, end: Number, shape: str) -> Piece:
    rise = SHAPES[shape][0]
    return low, high, lambda x: start + (end - start) * rise((x - low) / (high - low))


def arcs(
    knots: Sequence[Number], ratios: Sequence[Any], shape: str, advance: Number, mate: int
) -> Exact:
    """Ratios at knots joined by arcs; one ratio, or the last knot, is what closure asks for."""
    knots, share = list(knots), SHAPES[shape][1]
    if "solve" in ratios:
        known = [mp.mpf(0) if value == "solve" else of(value) for value in ratios]
        weights = [mp.mpf(0)] * len(knots)
        for k, (low, high) in enumerate(pairwise(knots)):
            weights[k] += (1 - share) * (high - low)
            weights[k + 1] += share * (high - low)
        rest = advance - sum(w * v for w, v in zip(weights, known, strict=True))
        unknown = sum(w for w, v in zip(weights, ratios, strict=True) if v == "solve")
        values = [rest / unknown if v == "solve" else of(v) for v in ratios]
    else:
        values = [of(value) for value in ratios]
    if knots[-1] is None:
        means = [(1 - share) * a + share * b for a, b in pairwise(values)]
        way = sum(m * (b - a) for m, (a, b) in zip(means[:-1], pairwise(knots[:-1]), strict=True))
        knots[-1] = knots[-2] + (advance - way) / means[-1]
    pieces = zip(pairwise(knots), pairwise(values), strict=True)
    return Exact([arc(low, high, a, b, shape) for (low, high), (a, b) in pieces], mate)


def phases(law: Phases, mate: int) -> Callable[[Any], Exact]:
    *inner, last = law.knots
    knots: list[Any] = [of(knot) for knot in inner]
    if law.driven_travel is None:
        return lambda _: arcs([*knots, turn_of(1)], law.ratios, law.shape, turn_of(1), mate)
    end = None if last == "solve" else of(last)
    return lambda _: arcs([*knots, end], law.ratios, law.shape, of(law.driven_travel), mate)


def multispeed(law: Multispeed, mate: int) -> Callable[[Any], Exact]:
    knots, ratios = [mp.mpf(0)], [law.ratios[0]]
    for number, (angle, ratio) in enumerate(zip(law.angles, law.ratios, strict=True)):
        if number:
            knots.append(knots[-1] + of(law.transition))
            ratios.append(ratio)
        if angle:
            knots.append(knots[-1] + of(angle))
            ratios.append(ratio)
    advance = turn_of(1)
    if law.driven_travel is None:
        knots.append(turn_of(1))
        ratios.append(law.ratios[0])
    else:
        advance = of(law.driven_travel)
    return lambda _: arcs(knots, ratios, law.shape, advance, mate)


def polynomials(law: ThreePhasePolynomial, mate: int) -> Callable[[Any], Exact]:
    u, v, turn, a = of(law.knots[1]), of(law.knots[2]), turn_of(1), of(law.lowest)
    first, second, third = u, v - u, turn - v
    rise = (second + third) / 2
    weight = rise * first / 2 + second**2 / 6 + rise * third - third**2 / 6
    p = (turn - a * turn) / weight
    b = a + p * rise
    return lambda _: Exact(
        [
            arc(mp.mpf(0), u, b, a, "cubic"),
            (u, v, lambda x: a + p / 2 / second * (x - u) ** 2),
            (v, turn, lambda x: b - p / 2 / third * (x - turn) ** 2),
        ],
        mate,
    )


def fourier(law: Fourier, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    mean = mp.mpf(n[0]) / n[1]

    def ratio(x: Slope) -> Slope:
        total = Slope(mp.mpf(1))
        for k, (a, b) in enumerate(zip(law.cosines, law.sines, strict=True), start=1):
            c, s = exact.cos(k * n[0] * x), exact.sin(k * n[0] * x)
            if law.of == "ratio":
                total = total + of(a) * c + of(b) * s
            else:
                total = total + (k * n[0] * mp.pi / 180) * (of(b) * c - of(a) * s)
        return mean * total

    return lambda _: Exact(whole(ratio, turn_of(n[0])), mate)


def bspline(law: BSplineLaw, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    count, control = len(law.radii), [of(value) for value in law.radii]
    step = turn_of(n[0]) / count

    def piece(k: int) -> Piece:
        a, b, c, d = (control[(k + j) % count] for j in (-1, 0, 1, 2))

        def radius(x: Slope) -> Slope:
            t = (x - k * step) / step
            upper = 3 * (a - 2 * b + c) + t * (d - a + 3 * (b - c))
            return (a + 4 * b + c + t * (3 * (c - a) + t * upper)) / 6

        return k * step, (k + 1) * step, radius

    return by_radius([piece(k) for k in range(count)], turn_of(n[1]), mate)


def polygon(law: RoundedPolygon, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    half, c = mp.pi / law.corners, of(law.corner_radius)

    def pieces(h: Number) -> list[Piece]:
        d, turn = (h - c) / mp.cos(half), mp.atan2((h - c) * mp.tan(half), h)

        def side(middle: Number) -> Function:
            return lambda x: h / (exact.cos(x - middle) - mate * h)

        def corner(x: Slope) -> Slope:
            across = d * exact.sin(x - half)
            radius = d * exact.cos(x - half) + exact.sqrt(c * c - across * across)
            return radius / (1 - mate * radius)

        ends = (mp.mpf(0), turn, half, 2 * half - turn, 2 * half)
        shapes = (side(mp.mpf(0)), corner, corner, side(2 * half))
        return [(*pair, shape) for pair, shape in zip(pairwise(ends), shapes, strict=True)]

    def make(built: RatioLaw) -> Exact:
        def excess(h: Number) -> Number:
            return Exact(pieces(h)[:2], 0).integral.sums[-1][0] - half * n[0] / n[1]

        near = of(built.solved["side_distance_over_center_distance"])
        h = mp.findroot(excess, (near, near * (1 + mp.mpf(10) ** -10)), tol=mp.mpf(10) ** -36)
        sector, parts = pieces(h), []
        for k in range(law.corners // n[0]):
            for low, high, shape in sector:
                moved = 2 * half * k
                parts.append((low + moved, high + moved, lambda x, s=shape, m=moved: s(x - m)))
        return Exact(parts, mate)

    return make


def table(law: TableLaw, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    """The quintics of the table, from the pieces that the program made of its rows."""
    kind, angles, values = law.points

    def make(built: RatioLaw) -> Exact:
        from gearcam.numeric.shape_keeping import quintics

        closed = law.driven_travel is None
        last = turn_of(n[0]) if closed else of(angles[-1])
        rise = float(values[-1] - values[0]) if kind == "phi2" else 0.0
        grid = np.array([0.0, *angles[1:-1], built.period])
        rows = quintics(grid, values, rise if closed else None)

        def polynomial(low: float, powers: Any) -> Function:
            known = [of(value) for value in powers]

            def value(x: Slope) -> Slope:
                t = x - of(low)
                total = Slope(known[-1])
                for power in known[-2::-1]:
                    total = total * t + power
                return total

            return value

        if kind == "phi2":
            rows = rows[:, 1:] * np.arange(1, 6)
        knots = [*(of(x) for x in grid[:-1]), last]
        pieces = [
            (low, high, polynomial(float(x), row))
            for (low, high), x, row in zip(pairwise(knots), grid, rows, strict=False)
        ]
        advance = turn_of(n[1]) if closed else of(law.driven_travel)
        if kind == "r1":
            return by_radius(pieces, advance, mate)(built)
        if kind == "phi2":
            return Exact(pieces, mate)
        factor = advance / Exact(pieces, 0).integral.sums[-1][0]
        scaled = [(a, b, lambda x, f=f: factor * f(x)) for a, b, f in pieces]
        return Exact(scaled, mate)

    return make
