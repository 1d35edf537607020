"""What ratio laws must give.

Those of centrodes stand in `claims.of_centrodes`, those of internal pairs in `claims.of_rings`.
"""

from __future__ import annotations

import math

import numpy as np

from claims.claim import LawClaim
from claims.of_centrodes import CENTRODES
from claims.of_rings import RINGS
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.position import MotionLaw
from gearcam.laws.ratio.span import Lobes
from gearcam.laws.ratio.table import TableLaw


def constant() -> tuple[LawClaim, ...]:
    return (
        LawClaim(
            parameters=Constant(),
            lobes=Lobes(2, 3),
            ratio={0.0: 2 / 3, 1.0: 2 / 3},
            driven={3 * math.pi: 2 * math.pi, 1.5: 1.0},
            continuity=3,
        ),
    )


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


def motion() -> tuple[LawClaim, ...]:
    turn = 2 * math.pi
    # a slide that moves as its crank moves it when turning evenly: i = 1
    even = "1 - cos(phi1) + 3*(1 - sqrt(1 - (sin(phi1)/3)**2))"
    # the same crank led by phi1 - 0.2*sin(phi1)
    led = even.replace("phi1", "(phi1 - 0.2*sin(phi1))")
    return (
        LawClaim(
            # y = x + x^2/10 from 0 to 2 over half a turn each: i = (1 + x/5)/1.2
            parameters=MotionLaw(
                y="x + x**2/10", x_from=0.0, x_to=2.0, driver_travel=math.pi, driven_travel=math.pi
            ),
            ratio={0.0: 1 / 1.2, math.pi / 2: 1.0, math.pi: 1.4 / 1.2},
            driven={math.pi: math.pi, math.pi / 2: math.pi * 1.1 / 2.4},
            continuity=3,
        ),
        LawClaim(
            parameters=MotionLaw(slide=even, rod=3.0),
            ratio={0.0: 1.0, 1.0: 1.0, math.pi: 1.0, 5.0: 1.0},
            driven={1.0: 1.0, math.pi: math.pi, 6.0: 6.0, turn: turn},
            continuity=3,
        ),
        LawClaim(
            parameters=MotionLaw(slide=led, rod=3.0),
            ratio={0.0: 0.8, math.pi: 1.2, math.pi / 2: 1.0},
            driven={math.pi: math.pi, 1.0: 1 - 0.2 * math.sin(1.0), turn: turn},
            continuity=3,
        ),
        LawClaim(
            parameters=MotionLaw(
                y=lambda x: x + x**2 / 10,
                x_from=2.0,
                x_to=0.0,
                driver_travel=math.pi,
                driven_travel=math.pi,
            ),
            ratio={0.0: 1.4 / 1.2, math.pi / 2: 1.0, math.pi: 1 / 1.2},
            driven={math.pi: math.pi, math.pi / 2: math.pi * 1.3 / 2.4},
            continuity=3,
        ),
    )


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


def multispeed() -> tuple[LawClaim, ...]:
    degree = math.radians(1)
    # 150*0.8 + 150*b + 60*(0.8 + b)/2 = 360 gives b = 1.2; quintic at a quarter: 53/512
    return (
        LawClaim(
            parameters=Multispeed(
                ratios=(0.8, "solve"),
                angles=(150 * degree, 150 * degree),
                transition=30 * degree,
            ),
            ratio={
                0.0: 0.8,
                2.0: 0.8,
                165 * degree: 1.0,
                157.5 * degree: 0.8 + 0.4 * 53 / 512,
                4.0: 1.2,
            },
            driven={
                150 * degree: 120 * degree,
                180 * degree: 150 * degree,
                2 * math.pi: 2 * math.pi,
            },
            continuity=2,
        ),
        LawClaim(
            parameters=Multispeed(
                ratios=(1.0, "solve"),
                angles=(40 * degree, 100 * degree),
                transition=20 * degree,
                shape="cosine",
                driven_travel=270 * degree,
            ),
            ratio={0.0: 1.0, 50 * degree: 1.5, 2.0: 2.0},
            driven={40 * degree: 40 * degree, 160 * degree: 270 * degree},
            continuity=1,
        ),
    )


def three_phase_polynomial() -> tuple[LawClaim, ...]:
    """003 Table 2.6 as printed, for the nail machine's knots and a = 0.4."""
    u, v, turn = math.radians(160), 1.5 * math.pi, 2 * math.pi
    bottom = 16 * math.pi**2 - 4 * math.pi * v + 2 * u * v - 6 * math.pi * u - u * u
    p = 24 * math.pi * 0.6 / bottom
    b, middle = 0.4 + 0.5 * p * (turn - u), 0.4 + 0.5 * p * (v - u)
    return (
        LawClaim(
            parameters=ThreePhasePolynomial(knots=(0.0, u, v, turn), lowest=0.4),
            ratio={0.0: b, u: 0.4, v: middle, 0.5 * u: 0.5 * (b + 0.4)},
            driven={
                u: 0.5 * u * (b + 0.4),
                turn: turn,
                v: 0.5 * u * (b + 0.4) + (v - u) * (0.4 + p * (v - u) / 6),
            },
            continuity=1,
        ),
    )


def fourier() -> tuple[LawClaim, ...]:
    return (
        LawClaim(
            parameters=Fourier(cosines=(0.2, 0.1), sines=(0.05,)),
            ratio={0.0: 1.3, math.pi: 0.9, math.pi / 2: 0.95},
            driven={math.pi: math.pi + 0.1, math.pi / 2: math.pi / 2 + 0.25},
            continuity=3,
        ),
        LawClaim(
            parameters=Fourier(of="phi2", sines=(-9.0,)),
            lobes=Lobes(2, 3),
            ratio={0.0: 2 / 3 * (1 - math.pi / 10), math.pi / 4: 2 / 3},
            driven={math.pi / 4: 2 / 3 * (math.pi / 4 - math.pi / 20), math.pi: 2 * math.pi / 3},
            continuity=3,
        ),
    )


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


OUTSIDE: dict[str, tuple[LawClaim, ...]] = {
    **CENTRODES,
    "constant": constant(),
    "formula": formula(),
    "motion": motion(),
    "phases": phases(),
    "multispeed": multispeed(),
    "three-phase-polynomial": three_phase_polynomial(),
    "fourier": fourier(),
    "table": table(),
}

LAW_CLAIMS = {name: (*claims, *RINGS.get(name, ())) for name, claims in OUTSIDE.items()}
