"""Pairs of every law with what they are in 30 digits: designs for the estimates of errors.

Each design names its parameters once, as doubles, and writes its mathematics anew for
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
from gearcam.laws.ratio.centrodes import EccentricCircle, Limacon, Lobed, LogSpiral
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.position import MotionLaw
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


def by_radius(
    pieces: Sequence[Piece], advance: Number, mate: int
) -> Callable[[RatioLaw], Exact]:
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
            return ((a + 4 * b + c) + t * (3 * (c - a) + t * (3 * (a - 2 * b + c) + t * (d - a + 3 * (b - c))))) / 6  # fmt: skip

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
                parts.append(
                    (low + moved, high + moved, lambda x, s=shape, m=moved: s(x - m))
                )
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


# --- the designs ----------------------------------------------------------------------------------


def cases() -> list[Case]:
    """Return all designs, every law, closed and open, wheels, rings and racks."""
    made: list[Case] = []

    def add(name: str, law: Any, teeth: tuple[int, int], ex: Any, mate: int = WHEEL) -> None:
        made.append(Case(f"{name}-{sum(c.name.startswith(name) for c in made)}", law, teeth, ex, mate))

    ring = (30, 90)
    add("constant", Constant(), (20, 31), lambda _: Exact(whole(lambda x: Slope(mp.mpf(20) / 31) + 0 * x, turn_of(20)), 1))
    add("constant", Constant(), ring, lambda _: Exact(whole(lambda x: Slope(mp.mpf(1) / 3) + 0 * x, turn_of(1)), -1), RING)
    for e in (0.0, 0.05, 0.3, 0.6, 0.8, 0.9, 0.95, 0.99):
        add("ellipse", Ellipse(eccentricity=e), (61, 61), ellipse(e))
    for e, teeth, n in ((0.2, (60, 40), (3, 2)), (0.4, (40, 80), (1, 2)), (0.7, (30, 90), (1, 3)), (0.15, (51, 34), (3, 2))):
        add("ellipse", Ellipse(eccentricity=e), teeth, ellipse(e, n))
    for e in (0.1, 0.3, 0.6):
        add("ellipse", Ellipse(eccentricity=e), ring, ellipse(e, (1, 3), RING), RING)
    for e in (0.0, 0.2, 0.5, 0.8, 0.95):
        add("eccentric-circle", EccentricCircle(eccentricity=e), (61, 61), circle(e, 1, 1))
    add("eccentric-circle", EccentricCircle(eccentricity=0.4), (30, 60), circle(0.4, 1, 2))
    add("eccentric-circle", EccentricCircle(eccentricity=0.3), ring, circle(0.3, -1, 3), RING)
    for e in (0.1, 0.4, 0.7, 0.9):
        add("limacon", Limacon(eccentricity=e), (61, 61), lobed(e, (1, 1), 1))
    add("limacon", Limacon(eccentricity=0.2), ring, lobed(0.2, (1, 3), -1), RING)
    for e, teeth, n in ((0.1, (60, 90), (2, 3)), (0.05, (90, 60), (3, 2)), (0.2, (61, 61), (1, 1)), (0.3, (40, 80), (1, 2))):
        add("lobed", Lobed(eccentricity=e), teeth, lobed(e, n, 1))
    add("lobed", Lobed(eccentricity=0.05), (60, 90), lobed(0.05, (2, 3), -1), RING)
    for ratios, travel, mate in (((0.5, 2.0), 2.0, 1), ((1.0, 1.3), 4.0, 1), ((3.0, 0.4), 1.2, 1), ((0.2, 0.4), 1.0, -1), ((1.0, 1.0001), 2.0, 1)):
        law = LogSpiral(ratios=ratios, driven_travel=travel)
        add("log-spiral", law, (30, 30), spiral(law, mate), mate)
    for shape in ("cosine", "cubic", "quintic"):
        for knot in (120, 160):
            two = Phases(shape=shape, knots=(0.0, math.radians(knot), TURN), ratios=(1.6, "solve", 1.6))
            add("phases", two, (61, 61), phases(two, 1))
    given = Phases(knots=(0.0, math.radians(160), TURN), ratios=(1.6, 0.4, 1.6))
    add("phases", given, (61, 61), phases(given, 1))
    three = Phases(knots=(0.0, 2.0, 4.1, TURN), ratios=(1.2, 0.7, "solve", 1.2))
    add("phases", three, (61, 61), phases(three, 1))
    for shape, knots, ratios in (
        ("cosine", (0.0, 0.2, 1.0, "solve"), (1.0, 1.0, 2.0, 2.0)),
        ("sine", (0.0, 1.0, "solve"), (1.0, 2.0, 2.0)),
        ("quintic", (0.0, 1.0, 2.0, 4.0), (1.0, 1.5, "solve", 0.8)),
    ):
        way = Phases(shape=shape, knots=knots, ratios=ratios, driven_travel=4.0)
        add("phases", way, (40, 40), phases(way, 1))
    sharp = Phases(knots=(0.0, 0.02, 3.0, TURN), ratios=(1.0, 0.9, "solve", 1.0))
    add("phases", sharp, (61, 61), phases(sharp, 1))
    for width, shape, ratio in ((30.0, "quintic", 0.8), (10.0, "cosine", 0.7), (3.0, "cubic", 0.9), (1.0, "quintic", 0.97), (0.3, "cosine", 0.99), (0.1, "quintic", 0.995), (0.1, "cubic", 0.99)):
        t = math.radians(width)
        speeds = Multispeed(ratios=(ratio, "solve"), angles=(2.5, TURN - 2 * t - 2.5), transition=t, shape=shape)
        add("multispeed", speeds, (61, 61), multispeed(speeds, 1))
    for t in (0.3, math.radians(0.1)):
        speeds = Multispeed(ratios=(1.0, "solve"), angles=(0.7, 2.0), transition=t, driven_travel=3.2)
        add("multispeed", speeds, (40, 40), multispeed(speeds, 1))
    for a in (0.4, 0.7, 0.95):
        cubic = ThreePhasePolynomial(knots=(0.0, 2.8, 4.7, TURN), lowest=a)
        add("three-phase-polynomial", cubic, (61, 61), polynomials(cubic, 1))
    for law, teeth, n, mate in (
        (Fourier(cosines=(0.2, 0.1), sines=(0.05, 0.0)), (61, 61), (1, 1), 1),
        (Fourier(of="phi2", cosines=(3.0, 0.5), sines=(-4.0, 0.2)), (60, 90), (2, 3), 1),
        (Fourier(cosines=(0.1,) * 3, sines=(-0.05,) * 3), (30, 60), (1, 2), 1),
        (Fourier(cosines=(0.1,), sines=(0.1,)), ring, (1, 3), -1),
        (Fourier(cosines=(0.001,) * 40, sines=(0.002,) * 40), (61, 61), (1, 1), 1),
    ):
        add("fourier", law, teeth, fourier(law, n, mate), mate)
    for radii, teeth, n, mate in (
        ((1.0, 1.1, 0.95, 1.02), (61, 61), (1, 1), 1),
        ((2.0, 2.2, 1.9, 2.1, 2.3, 2.0), (40, 60), (2, 3), 1),
        ((1.0, 1.3, 0.8, 1.2, 0.9, 1.0, 1.1, 1.0), (61, 61), (1, 1), 1),
        ((1.0, 1.05, 0.95, 1.0, 1.02), ring, (1, 3), -1),
    ):
        law = BSplineLaw(radii=radii)
        add("bspline", law, teeth, bspline(law, n, mate), mate)
    for corners, radius, teeth, n, mate in ((4, 1 / 6, (40, 40), (1, 1), 1), (3, 0.1, (60, 60), (1, 1), 1), (6, 0.05, (60, 90), (2, 3), 1), (4, 0.2, (40, 120), (1, 3), -1)):
        law = RoundedPolygon(corners=corners, corner_radius=radius)
        add("rounded-polygon", law, teeth, polygon(law, n, mate), mate)
    made += _formulas()
    made += _motions()
    made += _tables()
    return made


FORMULAS: tuple[tuple[str, str, Any, Any, tuple[int, int], int], ...] = (
    # what, text, Python, 30 digits, teeth, mate
    ("phi2", "phi1 - 0.08*sin(2*phi1)", lambda x: x - 0.08 * np.sin(2 * x), lambda x: 1 - of(0.08) * 2 * exact.cos(2 * x), (61, 61), 1),
    ("phi2", "phi1 - 0.6*sin(phi1)", lambda x: x - 0.6 * np.sin(x), lambda x: 1 - of(0.6) * exact.cos(x), (61, 61), 1),
    ("phi2", "phi1 + 0.001*sin(60*phi1)", lambda x: x + 0.001 * np.sin(60 * x), lambda x: 1 + of(0.001) * 60 * exact.cos(60 * x), (61, 61), 1),
    ("phi2", "phi1/2 + 0.1*cos(phi1)", lambda x: x / 2 + 0.1 * np.cos(x), lambda x: mp.mpf(1) / 2 - of(0.1) * exact.sin(x), (40, 80), 1),
    ("ratio", "1 + 0.3*cos(phi1)", lambda x: 1 + 0.3 * np.cos(x), lambda x: 1 + of(0.3) * exact.cos(x), (61, 61), 1),
    ("ratio", "1/(1 + 0.9*cos(phi1))", lambda x: 1 / (1 + 0.9 * np.cos(x)), lambda x: 1 / (1 + of(0.9) * exact.cos(x)), (61, 61), 1),
    ("ratio", "1 + 0.2*tanh(20*sin(phi1))", lambda x: 1 + 0.2 * np.tanh(20 * np.sin(x)), lambda x: 1 + of(0.2) * exact.tanh(20 * exact.sin(x)), (61, 61), 1),
    ("ratio", "1 + 0.3*exp(-40*(1 - cos(phi1)))", lambda x: 1 + 0.3 * np.exp(-40 * (1 - np.cos(x))), lambda x: 1 + of(0.3) * exact.exp(-40 * (1 - exact.cos(x))), (61, 61), 1),
    ("ratio", "1 + 0.1*sin(2*phi1)", lambda x: 1 + 0.1 * np.sin(2 * x), lambda x: 1 + of(0.1) * exact.sin(2 * x), (60, 90), 1),
    ("ratio", "1 + 0.1*sin(phi1)", lambda x: 1 + 0.1 * np.sin(x), lambda x: 1 + of(0.1) * exact.sin(x), (30, 90), -1),
    ("r1", "1/(1 + 0.5*cos(phi1))", lambda x: 1 / (1 + 0.5 * np.cos(x)), lambda x: 1 / (1 + of(0.5) * exact.cos(x)), (61, 61), 1),
    ("r1", "2 + 0.1*cos(3*phi1)", lambda x: 2 + 0.1 * np.cos(3 * x), lambda x: 2 + of(0.1) * exact.cos(3 * x), (60, 40), 1),
    ("r1", "5 + exp(sin(phi1))", lambda x: 5 + np.exp(np.sin(x)), lambda x: 5 + exact.exp(exact.sin(x)), (61, 61), 1),
    ("r1", "3 + 0.05*tanh(30*cos(phi1))", lambda x: 3 + 0.05 * np.tanh(30 * np.cos(x)), lambda x: 3 + of(0.05) * exact.tanh(30 * exact.cos(x)), (61, 61), 1),
)  # fmt: skip


def _formulas() -> list[Case]:
    made = []
    for number, (what, text, function, ratio, teeth, mate) in enumerate(FORMULAS):
        common = math.gcd(*teeth)
        n = teeth[0] // common, teeth[1] // common
        period, advance = turn_of(n[0]), turn_of(n[1])
        if what == "r1":
            ex: Any = by_radius(whole(ratio, period, 8), advance, mate)
        elif what == "ratio":
            ex = lambda _, p=period, a=advance, r=ratio, m=mate: closed_by(r, p, a, m)  # noqa: E731
        else:
            ex = lambda _, p=period, r=ratio, m=mate: Exact(whole(r, p, 8), m)  # noqa: E731
        for kind, given in (("formula", text), ("function", function)):
            law = Formula(**{what: given})
            made.append(Case(f"{kind}-{number}", law, teeth, ex, mate))
    for number, (what, text, radius) in enumerate(
        (
            ("r1", "1 + 0.2*cos(phi1)", lambda x: 1 + of(0.2) * exact.cos(x)),
            ("r1", "2 + 0.1*exp(sin(2*phi1))", lambda x: 2 + of(0.1) * exact.exp(exact.sin(2 * x))),
            ("travel", "2*phi1 + 0.3*sin(phi1)", lambda x: 2 + of(0.3) * exact.cos(x)),
        )
    ):
        ex = lambda _, r=radius: Exact(whole(r, turn_of(1)), 0)  # noqa: E731
        made.append(Case(f"rack-{number}", RackLaw(**{what: text}), (24, 31), ex, 0))
    return made


def _motions() -> list[Case]:
    made = []
    for number, (y, rise) in enumerate(
        (
            ("x + x**2/10", lambda x: 1 + x / 5),
            ("x + 0.1*sin(3*x)", lambda x: 1 + of(0.1) * 3 * exact.cos(3 * x)),
            ("exp(x)", exact.exp),
        )
    ):
        law = MotionLaw(y=y, x_from=0.0, x_to=2.0, driver_travel=3.0, driven_travel=2.5)
        period, advance = of(3.0), of(2.5)
        ex = lambda _, p=period, a=advance, f=rise: closed_by(  # noqa: E731
            lambda x: f(2 * x / p), p, a, 1
        )
        made.append(Case(f"motion-{number}", law, (40, 40), ex))
    for number, (lead, rod) in enumerate(((0.0, 3.0), (0.2, 3.0), (0.3, 2.0), (0.1, 20.0))):
        led = f"(phi1 - {lead}*sin(phi1))"
        slide = f"1 - cos{led} + {rod}*(1 - sqrt(1 - (sin{led}/{rod})**2))"
        law = MotionLaw(slide=slide, rod=rod)
        ex = lambda _, a=lead: Exact(whole(lambda x: 1 - of(a) * exact.cos(x), turn_of(1)), 1)  # noqa: E731
        made.append(Case(f"slide-{number}", law, (61, 61), ex))
    return made


def _tables() -> list[Case]:
    made = []
    for number, (kind, count, teeth, mate) in enumerate(
        (
            ("ratio", 12, (61, 61), 1),
            ("ratio", 90, (60, 90), 1),
            ("ratio", 24, (30, 90), -1),
            ("phi2", 24, (61, 61), 1),
            ("phi2", 72, (61, 61), 1),
            ("r1", 16, (61, 61), 1),
            ("r1", 48, (40, 80), 1),
            ("ratio", 400, (61, 61), 1),
        )
    ):
        common = math.gcd(*teeth)
        n = teeth[0] // common, teeth[1] // common
        angles = TURN / n[0] * np.arange(count + 1) / count
        wave = 0.2 * np.cos(n[0] * angles + 0.7)
        values = 1.0 + wave
        values[-1] = values[0]
        if kind == "phi2":
            values = angles + 0.2 * (np.sin(angles + 0.7) - math.sin(0.7))
            values[-1] = TURN
        law = TableLaw(phi1=tuple(angles.tolist()), **{kind: tuple(values.tolist())})
        made.append(Case(f"table-{number}", law, teeth, table(law, n, mate), mate))
    return made
