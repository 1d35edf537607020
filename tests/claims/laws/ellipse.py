"""What the ratio law of `gearcam.laws.ratio.ellipse` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from claims.claim import RING_TEETH, ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from witness import exact
from witness.exact import Exact, by_radius, of, turn_of, whole


def ellipse() -> tuple[LawClaim, ...]:
    half = 2.0 * math.atan(0.25 / 1.75 * math.tan(0.5))
    # two lobes on three: A from the quadratic, then tan(3*phi2/2) = q*tan(phi1)
    distance = (1 + math.sqrt(0.09 + 0.91 * 2.25)) / 0.91
    q = math.sqrt((0.7 * distance - 1) / (1.3 * distance - 1))
    return (
        LawClaim(
            parameters=Ellipse(eccentricity=0.5),
            ratio={0.0: 1 / 3, math.pi: 3.0, math.pi / 2: 0.6},
            driven={math.pi: math.pi, math.pi / 2: 2 * math.atan(1 / 3), 2 * math.pi: 2 * math.pi},
            continuity=3,
        ),
        LawClaim(
            parameters=Ellipse(eccentricity=0.75),
            ratio={0.0: 1 / 7, math.pi: 7.0},
            driven={1.0: half, 2 * math.pi + 1.0: 2 * math.pi + half},
            continuity=3,
        ),
        LawClaim(
            parameters=Ellipse(eccentricity=0.3, lobes=(2, 3)),
            lobes=Lobes(2, 3),
            ratio={0.0: 1 / (1.3 * distance - 1), math.pi / 2: 1 / (0.7 * distance - 1)},
            driven={math.pi / 2: math.pi / 3, 0.6: 2 / 3 * math.atan(q * math.tan(0.6))},
            continuity=3,
        ),
        LawClaim(
            # equal two-lobed wheels: b = sqrt(1 + (A*e)^2) gives A = 2/(1 - e^2)
            parameters=Ellipse(eccentricity=0.3, lobes=(2, 2)),
            ratio={0.0: 0.7 / 1.3, math.pi / 2: 1.3 / 0.7, math.pi: 0.7 / 1.3},
            driven={math.pi / 2: math.pi / 2, math.pi / 4: math.atan(0.7 / 1.3)},
            continuity=3,
        ),
    )


def ellipse_in_rings() -> tuple[LawClaim, ...]:
    # A = p*(sqrt(k^2 - e^2*(k^2 - 1)) - 1)/(1 - e^2), then tan(3*phi2/2) = t*tan(phi1)
    p = (math.sqrt(2.25 - 0.09 * 1.25) - 1) / 0.91
    t = math.sqrt((0.7 * p + 1) / (1.3 * p + 1))
    return (
        LawClaim(
            parameters=Ellipse(eccentricity=0.3, lobes=(2, 3)),
            lobes=Lobes(2, 3, RING),
            ratio={0.0: 1 / (1.3 * p + 1), math.pi / 2: 1 / (0.7 * p + 1)},
            driven={math.pi / 2: math.pi / 3, 0.6: 2 / 3 * math.atan(t * math.tan(0.6))},
            continuity=3,
        ),
    )


def ratio(law: Ellipse, lobes: Lobes, x: Any, m: Any) -> Any:
    """From both centrodes: A - w*r2 = r1 and p = 1, A from the closed form."""
    e, w, k = law.eccentricity, lobes.mate, law.lobes or (lobes.n1, lobes.n2)
    swing = 1 - e * e
    share = k[1] / (k[0] + 0 * e)  # of the type of e
    distance = (w + m.sqrt(1 + swing * (share * share - 1))) / swing
    return 1 / (distance * (1 + e * m.cos(k[0] * x)) - w)


def exact_ellipse(
    e: float, n: tuple[int, int] = (1, 1), mate: int = WHEEL
) -> Callable[[Any], Exact]:
    shape = whole(lambda x: 1 / (1 + of(e) * exact.cos(n[0] * x)), turn_of(n[0]))
    return by_radius(shape, turn_of(n[1]), mate)


def ellipse_cases() -> Iterator[ExactCase]:
    for e in (0.0, 0.05, 0.3, 0.6, 0.8, 0.9, 0.95, 0.99):
        yield ExactCase(Ellipse(eccentricity=e), (61, 61), exact_ellipse(e))
    for e, teeth, n in (
        (0.2, (60, 40), (3, 2)),
        (0.4, (40, 80), (1, 2)),
        (0.7, (30, 90), (1, 3)),
        (0.15, (51, 34), (3, 2)),
    ):
        yield ExactCase(Ellipse(eccentricity=e), teeth, exact_ellipse(e, n))
    for e in (0.1, 0.3, 0.6):
        exact = exact_ellipse(e, (1, 3), RING)
        yield ExactCase(Ellipse(eccentricity=e), RING_TEETH, exact, RING)


CLAIMS = {
    "ellipse": LawClaims(
        values=ellipse() + ellipse_in_rings(),
        ratio=ratio,
        usual={"eccentricity": (1e-3, 0.8)},
        cases=ellipse_cases,
    ),
}
