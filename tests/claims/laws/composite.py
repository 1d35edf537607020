"""What the ratio laws of `gearcam.laws.ratio.composite` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from claims.claim import RING_TEETH, ExactCase, LawClaim, LawClaims
from claims.laws.phases import arc, arcs
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from random_designs.draw import short
from random_designs.law_draw import Counts, Law, LawDraw, period
from witness import exact
from witness.exact import Exact, Slope, mp, of, turn_of, whole

TURN = 2 * math.pi
DOUBLE = Lobes(1, 2, RING)
SECTOR = Lobes(1, 1, RING)


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


def multispeed_in_rings() -> tuple[LawClaim, ...]:
    degree = math.radians(1)
    return (
        LawClaim(
            parameters=Multispeed(
                ratios=(0.4, "solve"), angles=(150 * degree, 150 * degree), transition=30 * degree
            ),
            lobes=DOUBLE,
            ratio={0.0: 0.4, 157.5 * degree: 0.4 + 0.2 * 53 / 512, 4.0: 0.6},
            driven={150 * degree: 60 * degree, 180 * degree: 75 * degree, TURN: math.pi},
            continuity=2,
        ),
        LawClaim(
            parameters=Multispeed(
                ratios=(0.4, "solve"),
                angles=(40 * degree, 100 * degree),
                transition=20 * degree,
                shape="cosine",
                driven_travel=108 * degree,
            ),
            lobes=SECTOR,
            ratio={0.0: 0.4, 50 * degree: 0.6, 2.0: 0.8},
            driven={40 * degree: 16 * degree, 160 * degree: 108 * degree},
            continuity=1,
        ),
    )


def any_multispeed(d: LawDraw) -> tuple[Law, Counts]:
    law: Law = {"shape": d.pick(["cosine", "cubic", "quintic"])}
    if d.chance(0.3):
        angles = [d.even(30, 100), d.even(30, 100)]
        law |= {"angles_deg": angles, "transition_deg": d.even(20, 60)}
        travel = short((sum(angles) + law["transition_deg"]) * d.even(0.9, 1.3))
        return law | {"ratios": [d.even(0.8, 1.2), "solve"], "driven_travel_deg": travel}, d.equal()
    z, count = d.lobed(20), d.whole(2, 3)
    each = short(period(z) * d.even(0.12, 0.25))
    rest = period(z) - count * each
    angles = [short(share * rest) for share in d.shares(count)]
    angles[-1] = rest - sum(angles[:-1])
    ratios: list[Any] = [short(z[0] / z[1] * d.even(0.7, 1.3)) for _ in range(count)]
    ratios[d.whole(1, count) - 1] = "solve"
    return law | {"angles_deg": angles, "transition_deg": each, "ratios": ratios}, z


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


def three_phase_polynomial_in_rings() -> tuple[LawClaim, ...]:
    """Half of what 003 Table 2.6 says for the nail machine's knots and a = 0.4."""
    u, v = math.radians(160), 1.5 * math.pi
    bottom = 16 * math.pi**2 - 4 * math.pi * v + 2 * u * v - 6 * math.pi * u - u * u
    p = 12 * math.pi * 0.6 / bottom
    b = 0.2 + 0.5 * p * (TURN - u)
    return (
        LawClaim(
            parameters=ThreePhasePolynomial(knots=(0.0, u, v, TURN), lowest=0.2),
            lobes=DOUBLE,
            ratio={0.0: b, u: 0.2, v: 0.2 + 0.5 * p * (v - u)},
            driven={u: 0.5 * u * (b + 0.2), TURN: math.pi},
            continuity=1,
        ),
    )


def any_three_phases(d: LawDraw) -> tuple[Law, Counts]:
    z = d.lobed(20)
    shares = (d.even(0.3, 0.5), d.even(0.65, 0.8))
    knots = [0, *(short(share * period(z)) for share in shares), period(z)]
    return {"knots_deg": knots, "lowest": short(z[0] / z[1] * d.even(0.4, 0.95))}, z


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


def fourier_in_rings() -> tuple[LawClaim, ...]:
    return (
        LawClaim(
            parameters=Fourier(cosines=(0.2, 0.1), sines=(0.05,)),
            lobes=DOUBLE,
            ratio={0.0: 0.65, math.pi: 0.45, math.pi / 2: 0.475},
            driven={math.pi: math.pi / 2 + 0.05, math.pi / 2: math.pi / 4 + 0.125},
            continuity=3,
        ),
    )


def any_fourier(d: LawDraw) -> tuple[Law, Counts]:
    z, of = d.lobed(12), d.pick(["ratio", "phi2"])
    waves = [[d.sign() * d.log(1e-3, 0.2) / k for k in range(1, d.whole(1, 4) + 1)] for _ in "ab"]
    # degrees of phi2: a share of the ratio over k*n1
    n = z[0] // math.gcd(*z)
    unit = [1.0 if of == "ratio" else 57.0 / (n * k) for k in range(1, 5)]
    cosines, sines = ([short(a * u) for a, u in zip(wave, unit, strict=False)] for wave in waves)
    return {"of": of, "cosines": cosines, "sines": sines}, z


def exact_multispeed(law: Multispeed, mate: int) -> Callable[[Any], Exact]:
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


def multispeed_cases() -> Iterator[ExactCase]:
    for width, shape, ratio in (
        (30.0, "quintic", 0.8),
        (10.0, "cosine", 0.7),
        (3.0, "cubic", 0.9),
        (1.0, "quintic", 0.97),
        (0.3, "cosine", 0.99),
        (0.1, "quintic", 0.995),
        (0.1, "cubic", 0.99),
        (0.1, "quintic", 0.99999),
    ):
        t = math.radians(width)
        angles = (2.5, TURN - 2 * t - 2.5)
        law = Multispeed(ratios=(ratio, "solve"), angles=angles, transition=t, shape=shape)
        yield ExactCase(law, (61, 61), exact_multispeed(law, WHEEL))
    for t in (0.3, math.radians(0.1)):
        law = Multispeed(ratios=(1.0, "solve"), angles=(0.7, 2.0), transition=t, driven_travel=3.2)
        yield ExactCase(law, (40, 40), exact_multispeed(law, WHEEL))


def exact_polynomials(law: ThreePhasePolynomial, mate: int) -> Callable[[Any], Exact]:
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


def three_phase_cases() -> Iterator[ExactCase]:
    for a in (0.4, 0.7, 0.95):
        law = ThreePhasePolynomial(knots=(0.0, 2.8, 4.7, TURN), lowest=a)
        yield ExactCase(law, (61, 61), exact_polynomials(law, WHEEL))


def exact_fourier(law: Fourier, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
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


def fourier_cases() -> Iterator[ExactCase]:
    for law, teeth, n, mate in (
        (Fourier(cosines=(0.2, 0.1), sines=(0.05, 0.0)), (61, 61), (1, 1), WHEEL),
        (Fourier(of="phi2", cosines=(3.0, 0.5), sines=(-4.0, 0.2)), (60, 90), (2, 3), WHEEL),
        (Fourier(cosines=(0.1,) * 3, sines=(-0.05,) * 3), (30, 60), (1, 2), WHEEL),
        (Fourier(cosines=(0.1,), sines=(0.1,)), RING_TEETH, (1, 3), RING),
        (Fourier(cosines=(0.004,) * 12, sines=(0.008,) * 12), (61, 61), (1, 1), WHEEL),
    ):
        yield ExactCase(law, teeth, exact_fourier(law, n, mate), mate)


CLAIMS = {
    "multispeed": LawClaims(
        values=multispeed() + multispeed_in_rings(), draw=any_multispeed, cases=multispeed_cases
    ),
    "three-phase-polynomial": LawClaims(
        values=three_phase_polynomial() + three_phase_polynomial_in_rings(),
        draw=any_three_phases,
        cases=three_phase_cases,
    ),
    "fourier": LawClaims(
        values=fourier() + fourier_in_rings(), draw=any_fourier, cases=fourier_cases
    ),
}
