"""What the ratio laws of `gearcam.laws.ratio.formula` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from claims.claim import RING_TEETH, ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.span import RACK, RING, Lobes
from random_designs.draw import short
from random_designs.law_draw import Counts, Law, LawDraw
from witness import exact
from witness.exact import Exact, Slope, by_radius, closed_by, mp, of, turn_of, whole

TURN = 2 * math.pi
DOUBLE = Lobes(1, 2, RING)
SECTOR = Lobes(1, 1, RING)


def formula() -> tuple[LawClaim, ...]:
    turn = 2 * math.pi
    root = math.sqrt(1 - 0.3**2)
    return (
        LawClaim(
            parameters=Formula(phi2="phi1 - 0.08*sin(2*phi1)"),
            ratio={0.0: 0.84, math.pi / 2: 1.16, math.pi / 4: 1.0},
            driven={math.pi / 4: math.pi / 4 - 0.08, math.pi: math.pi, turn: turn},
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(ratio="1/(1 + 0.3*cos(phi1))"),
            ratio={0.0: root / 1.3, math.pi: root / 0.7, math.pi / 2: root},
            driven={math.pi: math.pi, turn: turn, math.pi / 2: 2 * math.atan(math.sqrt(7 / 13))},
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(r1="1/(1 + 0.5*cos(phi1))"),
            ratio={0.0: 1 / 3, math.pi: 3.0, math.pi / 2: 0.6},
            driven={math.pi: math.pi, math.pi / 2: 2 * math.atan(1 / 3), turn: turn},
            continuity=3,
        ),
        *of_functions(),
    )


def of_functions() -> tuple[LawClaim, ...]:
    """Python functions, which give no derivatives: of arrays, of floats, with a derivative."""
    turn = 2 * math.pi
    root = math.sqrt(1 - 0.3**2)
    return (
        LawClaim(
            parameters=Formula(phi2=lambda phi1: phi1 - 0.08 * np.sin(2 * phi1)),
            ratio={0.0: 0.84, math.pi / 2: 1.16, math.pi / 4: 1.0},
            driven={math.pi / 4: math.pi / 4 - 0.08, math.pi: math.pi, turn: turn},
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(
                phi2=(lambda phi1: phi1 + 0.1 * phi1**2, lambda phi1: 1 + 0.2 * phi1),
                driver_travel=2.0,
                driven_travel=2.4,
            ),
            ratio={0.0: 1.0, 1.0: 1.2, 2.0: 1.4},
            driven={1.0: 1.1, 2.0: 2.4},
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(ratio=lambda phi1: 1 / (1 + 0.3 * math.cos(phi1))),
            ratio={0.0: root / 1.3, math.pi: root / 0.7, math.pi / 2: root},
            driven={math.pi: math.pi, turn: turn, math.pi / 2: 2 * math.atan(math.sqrt(7 / 13))},
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(r1=lambda phi1: 7 / (1 + 0.3 * np.cos(phi1))),
            ratio={0.0: 0.7 / 1.3, math.pi: 1.3 / 0.7, math.pi / 2: 0.91 / 1.09},
            driven={math.pi: math.pi, math.pi / 2: 2 * math.atan(0.7 / 1.3), turn: turn},
            continuity=3,
        ),
    )


def formula_in_rings() -> tuple[LawClaim, ...]:
    a = (math.sqrt(9 - 0.25 * 8) - 1) / 0.75  # an ellipse's centre distance, 1 : 3
    half = 2 / 3 * math.atan(math.sqrt((1 + 0.5 * a) / (1 + 1.5 * a)))
    polar = {0.0: 1 / (1 + 1.5 * a), math.pi: 1 / (1 + 0.5 * a), math.pi / 2: 1 / (1 + a)}
    lobe = {math.pi / 2: half, math.pi: math.pi / 3, TURN: TURN / 3}
    return (
        LawClaim(
            parameters=Formula(phi2="phi1/2 - 0.08*sin(2*phi1)"),
            lobes=DOUBLE,
            ratio={0.0: 0.34, math.pi / 2: 0.66},
            driven={math.pi / 4: math.pi / 8 - 0.08, TURN: math.pi},
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(ratio="1 + 0.3*cos(phi1)"),
            lobes=DOUBLE,
            ratio={0.0: 0.65, math.pi: 0.35},
            driven={1.0: 0.5 + 0.15 * math.sin(1.0), TURN: math.pi},
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(r1="7/(1 + 0.5*cos(phi1))"),
            lobes=Lobes(1, 3, RING),
            ratio=polar,
            driven=lobe,
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(r1=lambda phi1: 7 / (1 + 0.5 * np.cos(phi1))),
            lobes=Lobes(1, 3, RING),
            ratio=polar,
            driven=lobe,
            continuity=3,
        ),
        LawClaim(
            parameters=Formula(phi2="phi1/2 + phi1**2/20", driver_travel=2.0, driven_travel=1.2),
            lobes=SECTOR,
            ratio={0.0: 0.5, 1.0: 0.6, 2.0: 0.7},
            driven={1.0: 0.55, 2.0: 1.2},
            continuity=3,
        ),
        LawClaim(
            # a circle on an open pair: r1/A = u, i = u/(1 + u) = 3/5
            parameters=Formula(r1="2", driver_travel=2.0, driven_travel=1.2),
            lobes=SECTOR,
            ratio={0.0: 0.6, 1.3: 0.6},
            driven={1.0: 0.6, 2.0: 1.2},
            continuity=3,
        ),
    )


def any_formula(d: LawDraw) -> tuple[Law, Counts]:
    a, b = d.sign() * d.log(1e-3, 0.35), d.sign() * d.log(1e-3, 0.12)
    if d.chance(0.25):
        travel = d.even(90, 250)
        law: Law = {d.pick(["ratio", "r1"]): f"1 + {short(0.5 * a)}*sin(phi1/2) + {b}*phi1"}
        return law | {"driver_travel_deg": travel, "driven_travel_deg": travel}, d.equal(12)
    z, kind = d.lobed(16), d.pick(["ratio", "r1", "phi2"])
    more = d.whole(1, 6 if math.gcd(*z) >= 40 else 3)
    n, shift = z[0] // math.gcd(*z), d.even(0, 6)
    if kind == "phi2":
        a, b, mean = short(a / n * z[0] / z[1]), short(b / more / n * z[0] / z[1]), f"{z[0]}/{z[1]}"
        return {kind: f"phi1*{mean} + {a}*cos({n}*phi1 + {shift}) + {b}*sin({more * n}*phi1)"}, z
    half = 0.5 if kind == "r1" else 1.0
    waves = f"{short(half * a)}*cos({n}*phi1 + {shift}) + {short(half * b)}*sin({more * n}*phi1)"
    return {kind: f"1 + {waves}"}, z


def rack() -> tuple[LawClaim, ...]:
    return (
        LawClaim(
            parameters=RackLaw(r1="1 + 0.2*cos(phi1)"),
            ratio={0.0: 1.2, math.pi: 0.8, math.pi / 2: 1.0},
            driven={math.pi: math.pi, math.pi / 2: math.pi / 2 + 0.2, 7.0: 7 + 0.2 * math.sin(7)},
            continuity=3,
        ),
        LawClaim(
            parameters=RackLaw(travel="3*phi1 - 0.5*sin(2*phi1)"),
            ratio={0.0: 2.0, math.pi / 2: 4.0},
            driven={math.pi / 2: 1.5 * math.pi, 2 * math.pi: 6 * math.pi},
            continuity=3,
        ),
        LawClaim(
            parameters=RackLaw(travel=lambda phi1: 3 * phi1 - 0.5 * math.sin(2 * phi1)),
            ratio={0.0: 2.0, math.pi / 2: 4.0},
            driven={math.pi / 2: 1.5 * math.pi, 2 * math.pi: 6 * math.pi},
            continuity=3,
        ),
    )


def any_rack(d: LawDraw) -> tuple[Law, Counts]:
    a, n = d.sign() * d.log(1e-3, 0.2), d.whole(1, 3)
    shape = {"r1": f"1 + {a}*cos({n}*phi1)"}
    if d.chance(0.5):
        shape = {"travel": f"3*phi1 + {short(a / n)}*sin({n}*phi1)"}
    return shape, (d.whole(14, d.most_teeth), d.whole(6, d.most_teeth))


BuildOutput = Callable[[Any, Any], Any]
"""A formula with the library of its functions: numpy, or `witness.exact`; doubles stay exact."""

PHI2: tuple[tuple[str, BuildOutput, BuildOutput, tuple[int, int]], ...] = (
    # text, phi2, its derivative, teeth
    (
        "phi1 - 0.08*sin(2*phi1)",
        lambda x, m: x - 0.08 * m.sin(2 * x),
        lambda x, m: 1 - mp.mpf(0.08) * 2 * m.cos(2 * x),
        (61, 61),
    ),
    (
        "phi1 - 0.6*sin(phi1)",
        lambda x, m: x - 0.6 * m.sin(x),
        lambda x, m: 1 - 0.6 * m.cos(x),
        (61, 61),
    ),
    (
        "phi1 + 0.001*sin(60*phi1)",
        lambda x, m: x + 0.001 * m.sin(60 * x),
        lambda x, m: 1 + mp.mpf(0.001) * 60 * m.cos(60 * x),
        (61, 61),
    ),
    (
        "phi1/2 + 0.1*cos(phi1)",
        lambda x, m: x / 2 + 0.1 * m.cos(x),
        lambda x, m: 0.5 - 0.1 * m.sin(x),
        (40, 80),
    ),
)
OTHERS: tuple[tuple[str, str, BuildOutput, tuple[int, int], int], ...] = (
    # what, text, itself, teeth, mate
    ("ratio", "1 + 0.3*cos(phi1)", lambda x, m: 1 + 0.3 * m.cos(x), (61, 61), 1),
    (
        "ratio",
        "1/(1 + 0.9*cos(phi1 + 0.4))",
        lambda x, m: 1 / (1 + 0.9 * m.cos(x + 0.4)),
        (61, 61),
        1,
    ),
    (
        "ratio",
        "1 + 0.2*tanh(20*sin(phi1))",
        lambda x, m: 1 + 0.2 * m.tanh(20 * m.sin(x)),
        (61, 61),
        1,
    ),
    (
        "ratio",
        "1 + 0.3*exp(-40*(1 - cos(phi1)))",
        lambda x, m: 1 + 0.3 * m.exp(-40 * (1 - m.cos(x))),
        (61, 61),
        1,
    ),
    ("ratio", "1 + 0.1*sin(2*phi1)", lambda x, m: 1 + 0.1 * m.sin(2 * x), (60, 90), 1),
    ("ratio", "1 + 0.1*sin(phi1)", lambda x, m: 1 + 0.1 * m.sin(x), RING_TEETH, -1),
    ("r1", "1/(1 + 0.5*cos(phi1))", lambda x, m: 1 / (1 + 0.5 * m.cos(x)), (61, 61), 1),
    ("r1", "2 + 0.1*cos(3*phi1)", lambda x, m: 2 + 0.1 * m.cos(3 * x), (60, 40), 1),
    ("r1", "5 + exp(sin(phi1))", lambda x, m: 5 + m.exp(m.sin(x)), (61, 61), 1),
    (
        "r1",
        "3 + 0.05*tanh(30*cos(phi1))",
        lambda x, m: 3 + 0.05 * m.tanh(30 * m.cos(x)),
        (61, 61),
        1,
    ),
)


def exact_formula(what: str, function: BuildOutput, teeth: tuple[int, int], mate: int) -> Any:
    """Return what makes the exact law of a formula."""
    common = math.gcd(*teeth)
    period, advance = turn_of(teeth[0] // common), turn_of(teeth[1] // common)

    def shape(x: Slope) -> Slope:
        return function(x, exact)

    if what == "r1":
        return by_radius(whole(shape, period, 8), advance, mate)
    if what == "ratio":
        return lambda _: closed_by(shape, period, advance, mate)
    return lambda _: Exact(whole(shape, period, 8), mate)


def formula_cases() -> Iterator[ExactCase]:
    """Each formula as a text and as a Python function."""
    rows = [("phi2", text, phi2, ratio, teeth, 1) for text, phi2, ratio, teeth in PHI2]
    rows += [(what, text, one, one, teeth, mate) for what, text, one, teeth, mate in OTHERS]
    for what, text, written, ratio, teeth, mate in rows:

        def function(x: Any, written: BuildOutput = written) -> Any:
            return written(x, np)

        for given in (text, function):
            law = Formula(**{what: given})  # type: ignore[arg-type]
            yield ExactCase(law, teeth, exact_formula(what, ratio, teeth, mate), mate)


def rack_cases() -> Iterator[ExactCase]:
    for what, text, radius in (
        ("r1", "1 + 0.2*cos(phi1)", lambda x: 1 + of(0.2) * exact.cos(x)),
        ("r1", "2 + 0.1*exp(sin(2*phi1))", lambda x: 2 + of(0.1) * exact.exp(exact.sin(2 * x))),
        ("travel", "2*phi1 + 0.3*sin(phi1)", lambda x: 2 + of(0.3) * exact.cos(x)),
    ):
        law = Exact(whole(radius, turn_of(1)), RACK)
        yield ExactCase(RackLaw(**{what: text}), (24, 31), lambda _, law=law: law, RACK)


CLAIMS = {
    "formula": LawClaims(
        values=formula() + formula_in_rings(), draw=any_formula, cases=formula_cases
    ),
    "rack": LawClaims(values=rack(), draw=any_rack, cases=rack_cases),
}
