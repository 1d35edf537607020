"""What laws of centrodes must give."""

from __future__ import annotations

import math

from claims.claim import LawClaim
from gearcam.laws.ratio.centrodes import EccentricCircle, Limacon, Lobed, LogSpiral
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import RackLaw
from gearcam.laws.ratio.shapes import BSplineLaw, RoundedPolygon
from gearcam.laws.ratio.span import Lobes


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
    )  # fmt: skip


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


CENTRODES: dict[str, tuple[LawClaim, ...]] = {
    "eccentric-circle": eccentric_circle(),
    "limacon": limacon(),
    "lobed": lobed(),
    "ellipse": ellipse(),
    "bspline": bspline(),
    "rounded-polygon": rounded_polygon(),
    "log-spiral": log_spiral(),
    "rack": rack(),
}
