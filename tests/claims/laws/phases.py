"""What the ratio law of `gearcam.laws.ratio.phases` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any

from claims.claim import ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from random_designs.draw import short
from random_designs.law_draw import Counts, Law, LawDraw, period, rising
from witness import exact
from witness.exact import Exact, Number, Piece, Slope, mp, of, turn_of

TURN = 2 * math.pi
DOUBLE = Lobes(1, 2, RING)
SECTOR = Lobes(1, 1, RING)


def phases() -> tuple[LawClaim, ...]:
    turn, mid = 2 * math.pi, math.radians(160)
    two = (0.0, mid, turn)
    three = (0.0, mid, 1.5 * math.pi, turn)
    return (
        LawClaim(
            parameters=Phases(shape="cosine", knots=two, ratios=(1.6, 0.4, 1.6)),
            ratio={0.0: 1.6, mid: 0.4, mid / 2: 1.0, mid / 3: 1.3},
            driven={mid: mid, turn: turn, mid / 2: mid / 2 + 0.6 * mid / math.pi},
            continuity=1,
        ),
        LawClaim(
            parameters=Phases(shape="cubic", knots=two, ratios=(1.6, 0.4, 1.6)),
            ratio={0.0: 1.6, mid: 0.4, mid / 2: 1.0, mid / 4: 1.6 - 1.2 * 5 / 32},
            driven={mid: mid, turn: turn, mid / 2: mid * (0.8 - 1.2 * 3 / 32)},
            continuity=1,
        ),
        LawClaim(
            parameters=Phases(shape="cosine", knots=three, ratios=(1.6, 0.4, "solve", 1.6)),
            ratio={1.5 * math.pi: 1.06, turn: 1.6, mid: 0.4},
            driven={mid: mid, 1.5 * math.pi: mid + math.radians(110) * 0.73, turn: turn},
            continuity=1,
        ),
        *_open_claims(),
    )


def _open_claims() -> tuple[LawClaim, ...]:
    """003 (3.26) and (3.12), which give the driver's way in closed form."""
    u, v, way = math.radians(10), math.radians(60), math.radians(308.3)
    three = 0.5 * way + 0.25 * (u + v)
    two = ((math.pi - 2) * v + math.pi * way) / (2 * math.pi)
    return (
        LawClaim(
            parameters=Phases(
                shape="cosine",
                knots=(0.0, u, v, "solve"),
                ratios=(1.0, 1.0, 2.0, 2.0),
                driven_travel=way,
            ),
            ratio={0.0: 1.0, u: 1.0, 0.5 * (u + v): 1.5, v: 2.0, 2.0: 2.0},
            driven={u: u, v: u + 1.5 * (v - u), three: way},
            continuity=1,
        ),
        LawClaim(
            parameters=Phases(
                shape="sine", knots=(0.0, v, "solve"), ratios=(1.0, 2.0, 2.0), driven_travel=way
            ),
            ratio={0.0: 1.0, v / 3: 1.5, v: 2.0, 2.5: 2.0},
            driven={v: v + 2 * v / math.pi, two: way},
            continuity=1,
        ),
    )


def phases_in_rings() -> tuple[LawClaim, ...]:
    mid, degree = math.radians(160), math.radians(1)
    u, v, way = 10 * degree, 60 * degree, 150 * degree
    # arcs have the mean of their ends: 0.4*u + 0.6*(v - u) + 0.8*(x - v) = way
    end = v + (way - 0.4 * u - 0.6 * (v - u)) / 0.8
    return (
        LawClaim(
            parameters=Phases(shape="cosine", knots=(0.0, mid, TURN), ratios=(0.8, "solve", 0.8)),
            lobes=DOUBLE,
            ratio={0.0: 0.8, mid: 0.2, mid / 2: 0.5, mid / 3: 0.65},
            driven={mid: mid / 2, mid / 2: mid / 4 + 0.3 * mid / math.pi, TURN: math.pi},
            continuity=1,
        ),
        LawClaim(
            parameters=Phases(
                shape="cosine",
                knots=(0.0, u, v, "solve"),
                ratios=(0.4, 0.4, 0.8, 0.8),
                driven_travel=way,
            ),
            lobes=SECTOR,
            ratio={0.0: 0.4, u: 0.4, 0.5 * (u + v): 0.6, v: 0.8, 2.0: 0.8},
            driven={u: 0.4 * u, v: 0.4 * u + 0.6 * (v - u), end: way},
            continuity=1,
        ),
    )


def _openany_phases(d: LawDraw) -> tuple[Law, Counts]:
    low, high = d.even(0.7, 1.0), d.even(1.0, 1.8)
    travel, z = d.even(120, 300), d.equal(16)
    if d.chance(0.4):
        law: Law = {"shape": "sine", "knots_deg": [0, d.even(50, 90), "solve"]}
        return law | {"ratios": [1, high, high], "driven_travel_deg": travel}, z
    shape = d.pick(["cosine", "cubic", "quintic"])
    knots = [0, d.even(5, 20), d.even(60, 90), "solve"]
    ratios = [low, low, high, high]
    if d.chance(0.3):
        knots[3], ratios[2:] = short(travel / d.even(0.9, 1.2)), ["solve", high]
    return {
        "shape": shape, "knots_deg": knots, "ratios": ratios, "driven_travel_deg": travel,
    }, z  # fmt: skip


def any_phases(d: LawDraw) -> tuple[Law, Counts]:
    if d.chance(0.35):
        return _openany_phases(d)
    z = d.lobed(16)
    count = d.whole(2, 5)
    swing = d.log(0.02, 0.4)
    ratios: list[Any] = [short(z[0] / z[1] * d.even(1 - swing, 1 + swing)) for _ in range(count)]
    ratios.append(ratios[0])
    ratios[d.whole(1, count - 1)] = "solve"
    shape = d.pick(["cosine", "cubic", "quintic"])
    return {"shape": shape, "knots_deg": rising(d, count, period(z)), "ratios": ratios}, z


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


def exact_phases(law: Phases, mate: int) -> Callable[[Any], Exact]:
    *inner, last = law.knots
    knots: list[Any] = [of(knot) for knot in inner]
    if law.driven_travel is None:
        return lambda _: arcs([*knots, turn_of(1)], law.ratios, law.shape, turn_of(1), mate)
    end = None if last == "solve" else of(last)
    return lambda _: arcs([*knots, end], law.ratios, law.shape, of(law.driven_travel), mate)


def phases_cases() -> Iterator[ExactCase]:
    for shape in ("cosine", "cubic", "quintic"):
        for knot in (120, 160):
            two = Phases(
                shape=shape, knots=(0.0, math.radians(knot), TURN), ratios=(1.6, "solve", 1.6)
            )
            yield ExactCase(two, (61, 61), exact_phases(two, WHEEL))
    given = Phases(knots=(0.0, math.radians(160), TURN), ratios=(1.6, 0.4, 1.6))
    yield ExactCase(given, (61, 61), exact_phases(given, WHEEL))
    three = Phases(knots=(0.0, 2.0, 4.1, TURN), ratios=(1.2, 0.7, "solve", 1.2))
    yield ExactCase(three, (61, 61), exact_phases(three, WHEEL))
    travels: tuple[tuple[str, Any, Any], ...] = (
        ("cosine", (0.0, 0.2, 1.0, "solve"), (1.0, 1.0, 2.0, 2.0)),
        ("sine", (0.0, 1.0, "solve"), (1.0, 2.0, 2.0)),
        ("quintic", (0.0, 1.0, 2.0, 4.0), (1.0, 1.5, "solve", 0.8)),
    )
    for shape, knots, ratios in travels:
        law = Phases(shape=shape, knots=knots, ratios=ratios, driven_travel=4.0)
        yield ExactCase(law, (40, 40), exact_phases(law, WHEEL))
    sharp = Phases(knots=(0.0, 0.02, 3.0, TURN), ratios=(1.0, 0.9, "solve", 1.0))
    yield ExactCase(sharp, (61, 61), exact_phases(sharp, WHEEL))


CLAIMS = {
    "phases": LawClaims(values=phases() + phases_in_rings(), draw=any_phases, cases=phases_cases),
}
