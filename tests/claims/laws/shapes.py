"""What the ratio laws of `gearcam.laws.ratio.shapes` must give, and random ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

from claims.claim import RING_TEETH, ExactCase, LawClaim, LawClaims
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.shapes import BSplineLaw, RoundedPolygon
from gearcam.laws.ratio.span import RING, WHEEL, Lobes
from random_designs.law_draw import Counts, Law, LawDraw
from witness import exact
from witness.exact import Exact, Function, Number, Piece, Slope, by_radius, mp, of, turn_of

TURN = 2 * math.pi
DOUBLE = Lobes(1, 2, RING)


def bspline() -> tuple[LawClaim, ...]:
    # equal control values give a circle
    circle = LawClaim(
        parameters=BSplineLaw(radii=(2.0, 2.0, 2.0, 2.0)),
        lobes=Lobes(2, 3),
        ratio={0.0: 2 / 3, 1.0: 2 / 3},
        driven={1.5: 1.0, 3 * math.pi: 2 * math.pi},
        continuity=3,
    )
    # r = 1 at 0 and pi, (1 + 4*1.2 + 1)/6 at pi/2; c by quadrature with 30 digits
    c, top, low = 2.01705534812207634097601527257, 17 / 15, 13 / 15
    wave = LawClaim(
        parameters=BSplineLaw(radii=(1.0, 1.2, 1.0, 0.8)),
        ratio={
            0.0: 1 / (c - 1),
            math.pi: 1 / (c - 1),
            math.pi / 2: top / (c - top),
            1.5 * math.pi: low / (c - low),
        },
        driven={2 * math.pi: 2 * math.pi},
        continuity=2,
    )
    return circle, wave


def bspline_in_rings() -> tuple[LawClaim, ...]:
    # centre distance, and the polygon's h and d, by quadrature with 40 digits
    c, top, low = 0.99566822947132195696706298117794, 17 / 15, 13 / 15
    return (
        LawClaim(
            parameters=BSplineLaw(radii=(1.0, 1.2, 1.0, 0.8)),
            lobes=DOUBLE,
            ratio={
                0.0: 1 / (c + 1),
                math.pi / 2: top / (c + top),
                1.5 * math.pi: low / (c + low),
            },
            driven={TURN: math.pi},
            continuity=2,
        ),
    )


def any_bspline(d: LawDraw) -> tuple[Law, Counts]:
    swing = d.log(1e-3, 0.15)
    return {"radii": [d.even(1 - swing, 1 + swing) for _ in range(d.whole(4, 8))]}, d.lobed(16)


def rounded_polygon() -> tuple[LawClaim, ...]:
    # h and the corner's middle d by quadrature with 30 digits
    h, d, c = 0.448203891095789116482924270672, 0.398153761100542820776691342953, 1 / 6
    return (
        LawClaim(
            parameters=RoundedPolygon(corners=4, corner_radius=c),
            ratio={
                0.0: h / (1 - h),
                math.pi / 2: h / (1 - h),
                math.pi / 4: (d + c) / (1 - d - c),
                0.5: h / (math.cos(0.5) - h),
            },
            driven={math.pi / 4: math.pi / 4, math.pi / 2: math.pi / 2, 2 * math.pi: 2 * math.pi},
            continuity=1,
        ),
    )


def rounded_polygon_in_rings() -> tuple[LawClaim, ...]:
    h, d, corner = 0.90570454443666452326749167169773, 0.80945512945424481712176363844249, 1 / 3
    return (
        LawClaim(
            parameters=RoundedPolygon(corners=4, corner_radius=corner),
            lobes=DOUBLE,
            ratio={
                0.0: h / (1 + h),
                math.pi / 4: (d + corner) / (1 + d + corner),
                0.2: h / (math.cos(0.2) + h),
            },
            driven={math.pi / 4: math.pi / 8, TURN: math.pi},
            continuity=1,
        ),
        LawClaim(
            # corners rounder than the centre distance is long; those of a circular wheel are 4
            parameters=RoundedPolygon(corners=4, corner_radius=2.0),
            lobes=Lobes(4, 5, RING),
            ratio={},
            driven={math.pi / 4: 0.2 * math.pi, TURN: 0.8 * TURN},
            continuity=1,
        ),
    )


def exact_bspline(law: BSplineLaw, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    count, control = len(law.radii), [of(value) for value in law.radii]
    step = turn_of(n[0]) / count

    def piece(k: int) -> Piece:
        a, b, c, d = (control[(k + j) % count] for j in (-1, 0, 1, 2))

        def radius(x: Slope) -> Slope:
            t = (x - k * step) / step
            upper = 3 * (a - 2 * b + c) + t * (d - a + 3 * (b - c))
            return (a + 4 * b + c + t * (3 * (c - a) + t * upper)) / 6

        return k * step, (k + 1) * step, radius

    return by_radius([piece(k) for k in range(count)], turn_of(n[1]), mate)


def bspline_cases() -> Iterator[ExactCase]:
    for radii, teeth, n, mate in (
        ((1.0, 1.1, 0.95, 1.02), (61, 61), (1, 1), WHEEL),
        ((2.0, 2.2, 1.9, 2.1, 2.3, 2.0), (40, 60), (2, 3), WHEEL),
        ((1.0, 1.3, 0.8, 1.2, 0.9, 1.0, 1.1, 1.0), (61, 61), (1, 1), WHEEL),
        ((1.0, 1.05, 0.95, 1.0, 1.02), RING_TEETH, (1, 3), RING),
    ):
        law = BSplineLaw(radii=radii)
        yield ExactCase(law, teeth, exact_bspline(law, n, mate), mate)


def exact_polygon(law: RoundedPolygon, n: tuple[int, int], mate: int) -> Callable[[Any], Exact]:
    half, c = mp.pi / law.corners, of(law.corner_radius)

    def pieces(h: Number) -> list[Piece]:
        d, turn = (h - c) / mp.cos(half), mp.atan2((h - c) * mp.tan(half), h)

        def side(middle: Number) -> Function:
            return lambda x: h / (exact.cos(x - middle) - mate * h)

        def corner(x: Slope) -> Slope:
            across = d * exact.sin(x - half)
            radius = d * exact.cos(x - half) + exact.sqrt(c * c - across * across)
            return radius / (1 - mate * radius)

        ends = (mp.mpf(0), turn, half, 2 * half - turn, 2 * half)
        shapes = (side(mp.mpf(0)), corner, corner, side(2 * half))
        return [(*pair, shape) for pair, shape in zip(pairwise(ends), shapes, strict=True)]

    def make(built: RatioLaw) -> Exact:
        def excess(h: Number) -> Number:
            return Exact(pieces(h)[:2], 0).integral.sums[-1][0] - half * n[0] / n[1]

        near = of(built.solved["side_distance_over_center_distance"])
        h = mp.findroot(excess, (near, near * (1 + mp.mpf(10) ** -10)), tol=mp.mpf(10) ** -36)
        sector, parts = pieces(h), []
        for k in range(law.corners // n[0]):
            for low, high, shape in sector:
                moved = 2 * half * k
                parts.append((low + moved, high + moved, lambda x, s=shape, m=moved: s(x - m)))
        return Exact(parts, mate)

    return make


def polygon_cases() -> Iterator[ExactCase]:
    for corners, radius, teeth, n, mate in (
        (4, 1 / 6, (40, 40), (1, 1), WHEEL),
        (3, 0.1, (60, 60), (1, 1), WHEEL),
        (6, 0.05, (60, 90), (2, 3), WHEEL),
        (4, 0.2, (40, 120), (1, 3), RING),
    ):
        law = RoundedPolygon(corners=corners, corner_radius=radius)
        yield ExactCase(law, teeth, exact_polygon(law, n, mate), mate)


CLAIMS = {
    "bspline": LawClaims(
        values=bspline() + bspline_in_rings(), draw=any_bspline, cases=bspline_cases
    ),
    "rounded-polygon": LawClaims(
        values=rounded_polygon() + rounded_polygon_in_rings(),
        usual={"corners": (3, 6), "corner_radius": (0.16, 0.4)},
        cases=polygon_cases,
    ),
}
