"""What the ratio law of `gearcam.laws.ratio.table` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from claims.claim import ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import RING, Lobes
from gearcam.laws.ratio.table import TableLaw
from random_designs.draw import short
from random_designs.law_draw import Counts, Law, LawDraw, period
from witness.exact import Exact, Function, Slope, by_radius, of, turn_of

TURN = 2 * math.pi
DOUBLE = Lobes(1, 2, RING)
SECTOR = Lobes(1, 1, RING)


def table() -> tuple[LawClaim, ...]:
    turn = 2 * math.pi
    angles = tuple(turn * k / 8 for k in range(9))
    # points on a straight line give a line; values at the points are kept
    waves = tuple(a - 0.1 * math.sin(a) for a in angles)
    return (
        LawClaim(
            parameters=TableLaw(phi1=angles, ratio=(3.0,) * 9),
            lobes=Lobes(1, 2),
            ratio={0.0: 0.5, 1.0: 0.5, 5.0: 0.5},
            driven={1.0: 0.5, turn: math.pi},
            continuity=3,
        ),
        LawClaim(
            parameters=TableLaw(phi1=angles, phi2=waves),
            ratio={},
            driven=dict(zip(angles, waves, strict=True)),
            continuity=1,
        ),
        LawClaim(
            parameters=TableLaw(phi1=angles, r1=tuple(2.0 + 0.2 * math.cos(a) for a in angles)),
            ratio={},
            driven={turn: turn, math.pi: math.pi},
            continuity=2,
        ),
    )


def table_in_rings() -> tuple[LawClaim, ...]:
    angles = tuple(TURN * k / 8 for k in range(9))
    waves = tuple(0.5 * a - 0.1 * math.sin(a) for a in angles)
    return (
        LawClaim(
            parameters=TableLaw(phi1=angles, phi2=waves),
            lobes=DOUBLE,
            ratio={},
            driven=dict(zip(angles, waves, strict=True)),
            continuity=1,
        ),
        LawClaim(
            parameters=TableLaw(phi1=angles, r1=(2.0,) * 9),
            lobes=DOUBLE,
            ratio={0.0: 0.5, 1.0: 0.5},
            driven={1.0: 0.5, TURN: math.pi},
            continuity=3,
        ),
        LawClaim(
            # over a sector, from a ratio told at another scale
            parameters=TableLaw(
                phi1=tuple(0.25 * k for k in range(9)), ratio=(3.0,) * 9, driven_travel=1.2
            ),
            lobes=SECTOR,
            ratio={0.0: 0.6, 1.9: 0.6},
            driven={1.0: 0.6, 2.0: 1.2},
            continuity=3,
        ),
    )


def any_table(d: LawDraw) -> tuple[Law, Counts]:
    z, count, kind = d.lobed(16), d.whole(12, 48), d.pick(["ratio", "phi2_deg", "r1"])
    a, shift, mean = d.sign() * d.log(1e-2, 0.3), d.even(0, 6), z[0] / z[1]
    turns = [2 * math.pi * k / count for k in range(count + 1)]
    angles = [period(z) * k / count for k in range(count + 1)]
    wave = [math.cos(t + shift) for t in turns[:-1]]
    wave.append(wave[0])
    if kind == "phi2_deg":
        unit = period(z) / (2 * math.pi)
        rise = [math.sin(t + shift) - math.sin(shift) for t in turns[:-1]] + [0.0]
        values = [mean * (x + a * unit * w) for x, w in zip(angles, rise, strict=True)]
    else:
        values = [(1 + (a if kind == "ratio" else 0.5 * a) * w) for w in wave]
    if z[0] == z[1] and kind != "phi2_deg" and d.chance(0.3):
        angles = [short(0.8 * x) for x in angles]
        return {"phi1_deg": angles, kind: values, "driven_travel_deg": d.even(240, 300)}, z
    return {"phi1_deg": angles, kind: values}, z


def exact_table(law: TableLaw, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    """The quintics of the table, from the pieces that the program made of its rows."""
    kind, angles, values, _ = law.points

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


def table_cases() -> Iterator[ExactCase]:
    for kind, count, teeth, mate in (
        ("ratio", 12, (61, 61), 1),
        ("ratio", 90, (60, 90), 1),
        ("ratio", 24, (30, 90), -1),
        ("phi2", 24, (61, 61), 1),
        ("phi2", 72, (61, 61), 1),
        ("r1", 16, (61, 61), 1),
        ("r1", 48, (40, 80), 1),
        ("ratio", 400, (61, 61), 1),
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
        given: dict[str, Any] = {kind: tuple(values.tolist())}
        law = TableLaw(phi1=tuple(angles.tolist()), **given)
        yield ExactCase(law, teeth, exact_table(law, n, mate), mate)


CLAIMS = {
    "table": LawClaims(values=table() + table_in_rings(), draw=any_table, cases=table_cases),
}
