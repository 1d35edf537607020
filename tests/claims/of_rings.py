"""What laws must give where the mate is a ring: ``i = r1/(A + r1)``, below 1."""

from __future__ import annotations

import math

import numpy as np

from claims.claim import LawClaim
from gearcam.laws.ratio.centrodes import EccentricCircle, Limacon, Lobed, LogSpiral
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.position import MotionLaw
from gearcam.laws.ratio.shapes import BSplineLaw, RoundedPolygon
from gearcam.laws.ratio.span import RING, Lobes
from gearcam.laws.ratio.table import TableLaw

TURN = 2 * math.pi
DOUBLE = Lobes(1, 2, RING)
SECTOR = Lobes(1, 1, RING)


def circles() -> dict[str, tuple[LawClaim, ...]]:
    a = math.sqrt(1 - 0.25**2)  # the centre distance, exactly; and i(phi + pi) = 1 - i(phi)
    # with q = 1 - 1/2: A = q*(q + sqrt(q^2 + (1 - q^2)*(1 - e^2)))/(1 - q^2)
    c = 0.5 * (0.5 + math.sqrt(0.25 + 0.75 * (1 - 0.2**2))) / 0.75
    root = math.sqrt((c + 1) ** 2 - 0.2**2)
    quarter = 2 / root * math.atan(math.sqrt((c + 0.8) / (c + 1.2)))
    return {
        "eccentric-circle": (
            LawClaim(
                parameters=EccentricCircle(eccentricity=0.25),
                lobes=DOUBLE,
                ratio={0.0: 1.25 / (a + 1.25), math.pi: 1 - 1.25 / (a + 1.25), math.pi / 2: 0.5},
                driven={math.pi: math.pi / 2, TURN: math.pi},
                continuity=3,
            ),
        ),
        "limacon": (
            LawClaim(
                parameters=Limacon(eccentricity=0.2),
                lobes=DOUBLE,
                ratio={0.0: 1.2 / (c + 1.2), math.pi: 0.8 / (c + 0.8), math.pi / 2: 1 / (c + 1)},
                driven={math.pi: math.pi / 2, math.pi / 2: math.pi / 2 - c * quarter},
                continuity=3,
            ),
        ),
    }


def of_lobes() -> dict[str, tuple[LawClaim, ...]]:
    q, e = 0.6, 0.1  # 1 - 2/5
    c = q * (q + math.sqrt(q * q + (1 - q * q) * (1 - e * e))) / (1 - q * q)
    # A = p*(sqrt(k^2 - e^2*(k^2 - 1)) - 1)/(1 - e^2), then tan(3*phi2/2) = t*tan(phi1)
    p = (math.sqrt(2.25 - 0.09 * 1.25) - 1) / 0.91
    t = math.sqrt((0.7 * p + 1) / (1.3 * p + 1))
    return {
        "lobed": (
            LawClaim(
                parameters=Lobed(eccentricity=e),
                lobes=Lobes(2, 5, RING),
                ratio={0.0: 1.1 / (c + 1.1), math.pi / 2: 0.9 / (c + 0.9)},
                driven={math.pi / 2: math.pi / 5, TURN: 0.4 * TURN},
                continuity=3,
            ),
        ),
        "ellipse": (
            LawClaim(
                parameters=Ellipse(eccentricity=0.3, lobes=(2, 3)),
                lobes=Lobes(2, 3, RING),
                ratio={0.0: 1 / (1.3 * p + 1), math.pi / 2: 1 / (0.7 * p + 1)},
                driven={math.pi / 2: math.pi / 3, 0.6: 2 / 3 * math.atan(t * math.tan(0.6))},
                continuity=3,
            ),
        ),
    }


def shapes() -> dict[str, tuple[LawClaim, ...]]:
    # centre distance, and the polygon's h and d, by quadrature with 40 digits
    c, top, low = 0.99566822947132195696706298117794, 17 / 15, 13 / 15
    h, d, corner = 0.90570454443666452326749167169773, 0.80945512945424481712176363844249, 1 / 3
    return {
        "bspline": (
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
        ),
        "rounded-polygon": (
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
        ),
        "log-spiral": (
            LawClaim(
                # r1/A = exp(phi1)/3 from 1/3 to 1, and i = r1/(A + r1)
                parameters=LogSpiral(ratios=(0.25, 0.5), driven_travel=math.log(1.5)),
                lobes=SECTOR,
                ratio={0.0: 0.25, 0.5: 1 / (1 + 3 * math.exp(-0.5)), math.log(3): 0.5},
                driven={0.5: math.log((3 + math.exp(0.5)) / 4), math.log(3): math.log(1.5)},
                continuity=3,
            ),
        ),
    }


def formulas() -> dict[str, tuple[LawClaim, ...]]:
    return {
        "constant": (
            LawClaim(
                parameters=Constant(),
                lobes=Lobes(2, 3, RING),
                ratio={0.0: 2 / 3, 1.0: 2 / 3},
                driven={1.5: 1.0, 3 * math.pi: TURN},
                continuity=3,
            ),
        ),
        "formula": _formulas(),
        "motion": (
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
        ),
    }


def _formulas() -> tuple[LawClaim, ...]:
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


def of_phases() -> dict[str, tuple[LawClaim, ...]]:
    return {
        "phases": _phases(),
        "multispeed": _multispeed(),
        "three-phase-polynomial": (_three_phases(math.radians(160), 1.5 * math.pi),),
        "fourier": (
            LawClaim(
                parameters=Fourier(cosines=(0.2, 0.1), sines=(0.05,)),
                lobes=DOUBLE,
                ratio={0.0: 0.65, math.pi: 0.45, math.pi / 2: 0.475},
                driven={math.pi: math.pi / 2 + 0.05, math.pi / 2: math.pi / 4 + 0.125},
                continuity=3,
            ),
        ),
        "table": _tables(),
    }


def _phases() -> tuple[LawClaim, ...]:
    mid, degree = math.radians(160), math.radians(1)
    u, v, way = 10 * degree, 60 * degree, 150 * degree
    # arcs have the mean of their ends: 0.4*u + 0.6*(v - u) + 0.8*(x - v) = way
    end = v + (way - 0.4 * u - 0.6 * (v - u)) / 0.8
    return (
        LawClaim(
            parameters=Phases(shape="cosine", knots=(0.0, mid, TURN), ratios=(0.8, "solve", 0.8)),
            lobes=DOUBLE,
            ratio={0.0: 0.8, mid: 0.2, mid / 2: 0.5, mid / 3: 0.65},
            driven={mid: mid / 2, mid / 2: mid / 4 + 0.3 * mid / math.pi, TURN: math.pi},
            continuity=1,
        ),
        LawClaim(
            parameters=Phases(
                shape="cosine",
                knots=(0.0, u, v, "solve"),
                ratios=(0.4, 0.4, 0.8, 0.8),
                driven_travel=way,
            ),
            lobes=SECTOR,
            ratio={0.0: 0.4, u: 0.4, 0.5 * (u + v): 0.6, v: 0.8, 2.0: 0.8},
            driven={u: 0.4 * u, v: 0.4 * u + 0.6 * (v - u), end: way},
            continuity=1,
        ),
    )


def _multispeed() -> tuple[LawClaim, ...]:
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


def _three_phases(u: float, v: float) -> LawClaim:
    """Half of what 003 Table 2.6 says for the nail machine's knots and a = 0.4."""
    bottom = 16 * math.pi**2 - 4 * math.pi * v + 2 * u * v - 6 * math.pi * u - u * u
    p = 12 * math.pi * 0.6 / bottom
    b = 0.2 + 0.5 * p * (TURN - u)
    return LawClaim(
        parameters=ThreePhasePolynomial(knots=(0.0, u, v, TURN), lowest=0.2),
        lobes=DOUBLE,
        ratio={0.0: b, u: 0.2, v: 0.2 + 0.5 * p * (v - u)},
        driven={u: 0.5 * u * (b + 0.2), TURN: math.pi},
        continuity=1,
    )


def _tables() -> tuple[LawClaim, ...]:
    angles = tuple(TURN * k / 8 for k in range(9))
    waves = tuple(0.5 * a - 0.1 * math.sin(a) for a in angles)
    return (
        LawClaim(
            parameters=TableLaw(phi1=angles, phi2=waves),
            lobes=DOUBLE,
            ratio={},
            driven=dict(zip(angles, waves, strict=True)),
            continuity=1,
        ),
        LawClaim(
            parameters=TableLaw(phi1=angles, r1=(2.0,) * 9),
            lobes=DOUBLE,
            ratio={0.0: 0.5, 1.0: 0.5},
            driven={1.0: 0.5, TURN: math.pi},
            continuity=3,
        ),
        LawClaim(
            # over a sector, from a ratio told at another scale
            parameters=TableLaw(
                phi1=tuple(0.25 * k for k in range(9)), ratio=(3.0,) * 9, driven_travel=1.2
            ),
            lobes=SECTOR,
            ratio={0.0: 0.6, 1.9: 0.6},
            driven={1.0: 0.6, 2.0: 1.2},
            continuity=3,
        ),
    )


RINGS: dict[str, tuple[LawClaim, ...]] = (
    circles() | of_lobes() | shapes() | formulas() | of_phases()
)
