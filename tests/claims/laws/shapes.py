"""What the ratio laws of `gearcam.laws.ratio.shapes` must give, and random ones."""

from __future__ import annotations

import math

from claims.claim import LawClaim, LawClaims
from gearcam.laws.ratio.shapes import BSplineLaw, RoundedPolygon
from gearcam.laws.ratio.span import RING, Lobes
from random_designs.law_draw import Counts, Law, LawDraw

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


CLAIMS = {
    "bspline": LawClaims(values=bspline() + bspline_in_rings(), draw=any_bspline),
    "rounded-polygon": LawClaims(
        values=rounded_polygon() + rounded_polygon_in_rings(),
        usual={"corners": (3, 6), "corner_radius": (0.16, 0.4)},
    ),
}
