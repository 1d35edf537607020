"""What the ratio law of `gearcam.laws.ratio.position` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Iterator

from claims.claim import ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.position import MotionLaw
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from random_designs.law_draw import Counts, Law, LawDraw
from witness import exact
from witness.exact import Exact, closed_by, of, turn_of, whole

SECTOR = Lobes(1, 1, RING)


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


def motion_in_rings() -> tuple[LawClaim, ...]:
    return (
        LawClaim(
            # y = x + x^2/10 from 0 to 2: i = (1 + x/5)/2.4
            parameters=MotionLaw(
                y="x + x**2/10",
                x_from=0.0,
                x_to=2.0,
                driver_travel=math.pi,
                driven_travel=math.pi / 2,
            ),
            lobes=SECTOR,
            ratio={0.0: 1 / 2.4, math.pi / 2: 0.5, math.pi: 1.4 / 2.4},
            driven={math.pi: math.pi / 2, math.pi / 2: math.pi * 1.1 / 4.8},
            continuity=3,
        ),
    )


def any_motion(d: LawDraw) -> tuple[Law, Counts]:
    a, travel = d.log(1e-3, 0.4), d.even(90, 270)
    if d.chance(0.5):
        turned, rod = f"(phi1 + {d.sign() * a}*sin(phi1))", d.even(2, 8)
        slide = f"1 - cos{turned}"
        if d.chance(0.6):  # the crank's own rod: the ratio is that of the formula
            slide += f" + {rod}*(1 - sqrt(1 - (sin{turned}/{rod})**2))"
        return {"slide": slide, "rod": rod}, d.equal()
    law: Law = {"y": f"x + {a}*x**2", "x_from": 0, "x_to": d.even(0.5, 2)}
    return law | {"driver_travel_deg": travel, "driven_travel_deg": travel}, d.equal()


def motion_cases() -> Iterator[ExactCase]:
    for y, rise in (
        ("x + x**2/10", lambda x: 1 + x / 5),
        ("x + 0.1*sin(3*x)", lambda x: 1 + of(0.1) * 3 * exact.cos(3 * x)),
        ("exp(x)", exact.exp),
    ):
        law = MotionLaw(y=y, x_from=0.0, x_to=2.0, driver_travel=3.0, driven_travel=2.5)
        travel = of(3.0)
        ratio = closed_by(lambda x, f=rise, p=travel: f(2 * x / p), travel, of(2.5), WHEEL)
        yield ExactCase(law, (40, 40), lambda _, ratio=ratio: ratio)
    for lead, rod in ((0.0, 3.0), (0.2, 3.0), (0.3, 2.0), (0.1, 20.0)):
        led = f"(phi1 - {lead}*sin(phi1))"
        slide = f"1 - cos{led} + {rod}*(1 - sqrt(1 - (sin{led}/{rod})**2))"
        ratio = Exact(whole(lambda x, a=lead: 1 - of(a) * exact.cos(x), turn_of(1)))
        yield ExactCase(MotionLaw(slide=slide, rod=rod), (61, 61), lambda _, ratio=ratio: ratio)


CLAIMS = {
    "motion": LawClaims(values=motion() + motion_in_rings(), draw=any_motion, cases=motion_cases),
}
