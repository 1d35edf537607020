"""What the ratio law of `gearcam.laws.ratio.constant` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Iterator

from claims.claim import RING_TEETH, ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from random_designs.law_draw import Counts, Law, LawDraw
from witness.exact import Exact, Slope, mp, turn_of, whole

TURN = 2 * math.pi


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


def constant_in_rings() -> tuple[LawClaim, ...]:
    return (
        LawClaim(
            parameters=Constant(),
            lobes=Lobes(2, 3, RING),
            ratio={0.0: 2 / 3, 1.0: 2 / 3},
            driven={1.5: 1.0, 3 * math.pi: TURN},
            continuity=3,
        ),
    )


def any_constant(d: LawDraw) -> tuple[Law, Counts]:
    return {}, (d.whole(6, d.most_teeth), d.whole(6, d.most_teeth))


def constant_cases() -> Iterator[ExactCase]:
    for teeth, n, share, mate in (
        ((20, 31), 20, mp.mpf(20) / 31, WHEEL),
        (RING_TEETH, 1, mp.mpf(1) / 3, RING),
    ):
        exact = Exact(whole(lambda x, i=share: Slope(i) + 0 * x, turn_of(n)), mate)
        yield ExactCase(Constant(), teeth, lambda _, exact=exact: exact, mate)


CLAIMS = {
    "constant": LawClaims(
        values=constant() + constant_in_rings(), draw=any_constant, cases=constant_cases
    ),
}
