"""What the ratio law of `gearcam.laws.ratio.phases` must give, and random ones."""

from __future__ import annotations

import math
from typing import Any

from claims.claim import LawClaim, LawClaims
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import RING, Lobes
from random_designs.draw import short
from random_designs.law_draw import Counts, Law, LawDraw, period, rising

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


CLAIMS = {
    "phases": LawClaims(values=phases() + phases_in_rings(), draw=any_phases),
}
