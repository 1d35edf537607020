"""What the ratio laws of `gearcam.laws.ratio.centrodes` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from claims.claim import RING_TEETH, ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.centrodes import EccentricCircle, Limacon, Lobed, LogSpiral
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from random_designs.draw import short
from random_designs.law_draw import Counts, Law, LawDraw
from witness import exact
from witness.exact import Exact, Number, Slope, by_radius, mp, of, turn_of, whole

TURN = 2 * math.pi
DOUBLE = Lobes(1, 2, RING)
SECTOR = Lobes(1, 1, RING)


def eccentric_circle() -> tuple[LawClaim, ...]:
    # A/R = 2.04379288568712 by high-precision quadrature; at phi1 = 90 deg r1 = sqrt(1 - e^2)
    a, b = 2.04379288568712, math.sqrt(1 - 0.3**2)
    return (
        LawClaim(
            parameters=EccentricCircle(eccentricity=0.3),
            ratio={0.0: 1.3 / (a - 1.3), math.pi: 0.7 / (a - 0.7), math.pi / 2: b / (a - b)},
            driven={math.pi: math.pi, 2 * math.pi: 2 * math.pi},
            continuity=3,
        ),
    )


def eccentric_circle_in_rings() -> tuple[LawClaim, ...]:
    a = math.sqrt(1 - 0.25**2)  # the centre distance, exactly; and i(phi + pi) = 1 - i(phi)
    return (
        LawClaim(
            parameters=EccentricCircle(eccentricity=0.25),
            lobes=DOUBLE,
            ratio={0.0: 1.25 / (a + 1.25), math.pi: 1 - 1.25 / (a + 1.25), math.pi / 2: 0.5},
            driven={math.pi: math.pi / 2, TURN: math.pi},
            continuity=3,
        ),
    )


def limacon() -> tuple[LawClaim, ...]:
    # with k = 2: b = (1 + 2*sqrt(1 + 3*e^2))/3
    b = (1 + 2 * math.sqrt(1 + 3 * 0.4**2)) / 3
    half = 2 * math.atan(math.sqrt((b + 0.4) / (b - 0.4)))
    return (
        LawClaim(
            parameters=Limacon(eccentricity=0.4),
            ratio={0.0: 1.4 / (b - 0.4), math.pi: 0.6 / (b + 0.4), math.pi / 2: 1 / b},
            driven={math.pi: math.pi, math.pi / 2: 2 * half - math.pi / 2},
            continuity=3,
        ),
    )


def limacon_in_rings() -> tuple[LawClaim, ...]:
    # with q = 1 - 1/2: A = q*(q + sqrt(q^2 + (1 - q^2)*(1 - e^2)))/(1 - q^2)
    c = 0.5 * (0.5 + math.sqrt(0.25 + 0.75 * (1 - 0.2**2))) / 0.75
    root = math.sqrt((c + 1) ** 2 - 0.2**2)
    quarter = 2 / root * math.atan(math.sqrt((c + 0.8) / (c + 1.2)))
    return (
        LawClaim(
            parameters=Limacon(eccentricity=0.2),
            lobes=DOUBLE,
            ratio={0.0: 1.2 / (c + 1.2), math.pi: 0.8 / (c + 0.8), math.pi / 2: 1 / (c + 1)},
            driven={math.pi: math.pi / 2, math.pi / 2: math.pi / 2 - c * quarter},
            continuity=3,
        ),
    )


def lobed() -> tuple[LawClaim, ...]:
    # with k = 1 + 2/3 the centre distance is (1 + b) = k*sqrt(b^2 - e^2)
    k, e = 5 / 3, 0.2
    b = (1 + math.sqrt(1 + (k * k - 1) * (1 + k * k * e * e))) / (k * k - 1)
    return (
        LawClaim(
            parameters=Lobed(eccentricity=e),
            lobes=Lobes(2, 3),
            ratio={0.0: 1.2 / (b - 0.2), math.pi / 2: 0.8 / (b + 0.2), math.pi / 4: 1 / b},
            driven={math.pi / 2: math.pi / 3, 2 * math.pi: 4 * math.pi / 3},
            continuity=3,
        ),
        LawClaim(
            parameters=Lobed(eccentricity=0.1, lobes=(3, 3)),
            lobes=Lobes(1, 1),
            ratio={0.0: 1.1 / ((1 + 2 * math.sqrt(1.03)) / 3 - 0.1)},
            driven={math.pi / 3: math.pi / 3, 2 * math.pi: 2 * math.pi},
            continuity=3,
        ),
    )


def lobed_in_rings() -> tuple[LawClaim, ...]:
    q, e = 0.6, 0.1  # 1 - 2/5
    c = q * (q + math.sqrt(q * q + (1 - q * q) * (1 - e * e))) / (1 - q * q)
    return (
        LawClaim(
            parameters=Lobed(eccentricity=e),
            lobes=Lobes(2, 5, RING),
            ratio={0.0: 1.1 / (c + 1.1), math.pi / 2: 0.9 / (c + 0.9)},
            driven={math.pi / 2: math.pi / 5, TURN: 0.4 * TURN},
            continuity=3,
        ),
    )


MIDDLE = (5.302807344706602278429696138, 5.69276694285767405618955570348)
"""phi1 and phi2 in the middle of a quarter turn's return from 2 to 1/2, by 30 digits."""


def log_spiral() -> tuple[LawClaim, ...]:
    # from u = 1/3 to 2/3 both wheels turn alike: r1 doubles while r2 halves
    k = math.log(2.0) / 2.0
    return (
        LawClaim(
            parameters=LogSpiral(ratios=(0.5, 2.0), driven_travel=2.0),
            ratio={0.0: 0.5, 1.0: 1 / (3 / math.sqrt(2) - 1), 2.0: 2.0},
            driven={2.0: 2.0, 1.0: math.log((2 / 3) / (1 - math.sqrt(2) / 3)) / k},
            continuity=3,
        ),
        LawClaim(
            parameters=LogSpiral(ratios=(3.0, 1.0), driven_travel=1.0),
            ratio={0.0: 3.0, math.log(1.5) / math.log(2): 1.0},
            driven={math.log(1.5) / math.log(2): 1.0},
            continuity=3,
        ),
        LawClaim(
            # closed: from 1/k to k while both wheels turn by 1.5*pi; the return by 30-digit Newton
            parameters=LogSpiral(ratios=(0.5, 2.0), return_angle=math.pi / 2),
            ratio={0.0: 0.5, 0.75 * math.pi: 1 / (3 / math.sqrt(2) - 1), 1.5 * math.pi: 2.0,
                   MIDDLE[0]: 1.0},
            driven={1.5 * math.pi: 1.5 * math.pi, 2 * math.pi: 2 * math.pi, MIDDLE[0]: MIDDLE[1]},
            continuity=2,
        ),
        LawClaim(
            parameters=LogSpiral(ratios=("solve", 0.5), return_angle=math.pi / 2),
            ratio={0.0: 2.0, 1.5 * math.pi: 0.5, MIDDLE[1]: 1.0},
            driven={1.5 * math.pi: 1.5 * math.pi, MIDDLE[1]: MIDDLE[0]},
            continuity=2,
        ),
    )  # fmt: skip  # fmt: skip


def log_spiral_in_rings() -> tuple[LawClaim, ...]:
    return (
        LawClaim(
            # r1/A = exp(phi1)/3 from 1/3 to 1, and i = r1/(A + r1)
            parameters=LogSpiral(ratios=(0.25, 0.5), driven_travel=math.log(1.5)),
            lobes=SECTOR,
            ratio={0.0: 0.25, 0.5: 1 / (1 + 3 * math.exp(-0.5)), math.log(3): 0.5},
            driven={0.5: math.log((3 + math.exp(0.5)) / 4), math.log(3): math.log(1.5)},
            continuity=3,
        ),
    )


def any_spiral(d: LawDraw) -> tuple[Law, Counts]:
    if d.chance(0.3):
        ratios = [d.even(1.05, 1.6), "solve"]
        return {"ratios": ratios[:: d.sign()], "return_deg": d.even(90, 170)}, d.equal(30)
    first, growth = d.even(0.5, 1.2), d.log(1.05, 3)
    ratios = [first, short(first * growth)]
    return {"ratios": ratios[:: d.sign()], "driven_travel_deg": d.even(60, 220)}, d.equal()


def exact_circle(e: float, mate: int, turns: int) -> Callable[[Any], Exact]:
    def radius(x: Slope) -> Slope:
        across = of(e) * exact.sin(x)
        return of(e) * exact.cos(x) + exact.sqrt(1 - across * across)

    return by_radius(whole(radius, turn_of(1), 8), turn_of(turns), mate)


def circle_cases() -> Iterator[ExactCase]:
    for e, teeth, mate in (
        *((e, (61, 61), WHEEL) for e in (0.0, 0.2, 0.5, 0.8, 0.95)),
        (0.4, (30, 60), WHEEL),
        (0.3, RING_TEETH, RING),
    ):
        law = EccentricCircle(eccentricity=e)
        yield ExactCase(law, teeth, exact_circle(e, mate, teeth[1] // teeth[0]), mate)


def exact_lobed(e: float, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    shape = whole(lambda x: 1 + of(e) * exact.cos(n[0] * x), turn_of(n[0]))
    return by_radius(shape, turn_of(n[1]), mate)


def limacon_cases() -> Iterator[ExactCase]:
    for e in (0.1, 0.4, 0.7, 0.9):
        yield ExactCase(Limacon(eccentricity=e), (61, 61), exact_lobed(e, (1, 1), WHEEL))
    yield ExactCase(Limacon(eccentricity=0.2), RING_TEETH, exact_lobed(0.2, (1, 3), RING), RING)


def lobed_cases() -> Iterator[ExactCase]:
    for e, teeth, n, mate in (
        (0.1, (60, 90), (2, 3), WHEEL),
        (0.05, (90, 60), (3, 2), WHEEL),
        (0.2, (61, 61), (1, 1), WHEEL),
        (0.3, (40, 80), (1, 2), WHEEL),
        (0.05, (60, 90), (2, 3), RING),
    ):
        yield ExactCase(Lobed(eccentricity=e), teeth, exact_lobed(e, n, mate), mate)


def exact_spiral(law: LogSpiral, mate: int) -> Callable[[Any], Exact]:
    start, end = (of(value) for value in law.ratios)
    first, turn = start / (1 + mate * start), (1 + mate * end) / (1 + mate * start)
    growth = mate * mp.log(turn) / of(law.driven_travel)
    travel = mp.log(end / start / turn) / growth

    def ratio(x: Slope) -> Slope:
        share = first * exact.exp(growth * x)
        return share / (1 - mate * share)

    return lambda _: Exact(whole(ratio, travel), mate)


def exact_nautilus(law: LogSpiral) -> Callable[[Any], Exact]:
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


def spiral_cases() -> Iterator[ExactCase]:
    for ratios, travel, mate in (
        ((0.5, 2.0), 2.0, WHEEL),
        ((1.0, 1.3), 4.0, WHEEL),
        ((3.0, 0.4), 1.2, WHEEL),
        ((0.2, 0.4), 1.0, RING),
        ((1.0, 1.0001), 2.0, WHEEL),
    ):
        law = LogSpiral(ratios=ratios, driven_travel=travel)
        yield ExactCase(law, (30, 30), exact_spiral(law, mate), mate)
    for ratios, degrees in (((0.5, 2.0), 95.386), ((1.5, 1 / 1.5), 120.0)):
        law = LogSpiral(ratios=ratios, return_angle=math.radians(degrees))
        yield ExactCase(law, (48, 48), exact_nautilus(law))


CLAIMS = {
    "eccentric-circle": LawClaims(
        values=eccentric_circle() + eccentric_circle_in_rings(),
        usual={"eccentricity": (1e-3, 0.7)},
        cases=circle_cases,
    ),
    "limacon": LawClaims(
        values=limacon() + limacon_in_rings(),
        usual={"eccentricity": (1e-3, 0.6)},
        cases=limacon_cases,
    ),
    "lobed": LawClaims(
        values=lobed() + lobed_in_rings(), usual={"eccentricity": (1e-3, 0.15)}, cases=lobed_cases
    ),
    "log-spiral": LawClaims(
        values=log_spiral() + log_spiral_in_rings(), draw=any_spiral, cases=spiral_cases
    ),
}
