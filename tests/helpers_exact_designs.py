"""Designs of every law: closed and open, wheels, rings and racks, and the extremes of each."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from claims.laws import LAW_CLAIMS
from gearcam.laws.ratio.centrodes import EccentricCircle, Limacon, Lobed, LogSpiral
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.position import MotionLaw
from gearcam.laws.ratio.shapes import BSplineLaw, RoundedPolygon
from gearcam.laws.ratio.span import RING, WHEEL
from gearcam.laws.ratio.table import TableLaw
from helpers_exact import (
    TURN,
    Case,
    bspline,
    by_radius,
    circle,
    closed_by,
    ellipse,
    fourier,
    lobed,
    multispeed,
    nautilus,
    of,
    phases,
    polygon,
    polynomials,
    spiral,
    table,
    turn_of,
    whole,
)
from witness import exact
from witness.exact import Exact, Slope, mp

Add = Callable[..., None]
RING_TEETH = (30, 90)


def cases() -> list[Case]:
    """Return all designs."""
    made: list[Case] = []

    def add(name: str, law: Any, teeth: tuple[int, int], of_it: Any, mate: int = WHEEL) -> None:
        number = sum(case.name.startswith(f"{name}-") for case in made)
        made.append(Case(f"{name}-{number}", law, teeth, of_it, mate))

    for group in (_centrodes, _phases, _speeds, _shapes):
        group(add)
    return [*made, *_formulas(), *_motions(), *_tables(), *_claimed()]


def _claimed() -> Iterator[Case]:
    """Yield the examples of laws whose claims have their mathematics once more, if closed."""
    for name, claims in LAW_CLAIMS.items():
        for number, claim in enumerate(claims.values if claims.ratio else ()):
            lobes = claim.lobes
            each = math.ceil(40 / min(lobes.n1, lobes.n2))
            teeth = each * lobes.n1, each * lobes.n2
            law = _in_30_digits(claim.parameters)
            assert claims.ratio is not None
            ex = lambda _, f=claims.ratio, p=law, n=lobes: Exact(  # noqa: E731
                whole(lambda x: f(p, n, x, exact), turn_of(n.n1)), n.mate
            )
            yield Case(f"{name}-claim-{number}", claim.parameters, teeth, ex, lobes.mate)


def _in_30_digits(parameters: Any) -> Any:
    """Return parameters whose floats are exact numbers of 30 digits."""

    def exactly(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(exactly, value))
        return mp.mpf(value) if isinstance(value, float) else value

    return replace(parameters, **{key: exactly(value) for key, value in vars(parameters).items()})


def _centrodes(add: Add) -> None:
    add(
        "constant",
        Constant(),
        (20, 31),
        lambda _: Exact(whole(lambda x: Slope(mp.mpf(20) / 31) + 0 * x, turn_of(20)), 1),
    )
    add(
        "constant",
        Constant(),
        RING_TEETH,
        lambda _: Exact(whole(lambda x: Slope(mp.mpf(1) / 3) + 0 * x, turn_of(1)), -1),
        RING,
    )
    for e in (0.0, 0.05, 0.3, 0.6, 0.8, 0.9, 0.95, 0.99):
        add("ellipse", Ellipse(eccentricity=e), (61, 61), ellipse(e))
    for e, teeth, n in (
        (0.2, (60, 40), (3, 2)),
        (0.4, (40, 80), (1, 2)),
        (0.7, (30, 90), (1, 3)),
        (0.15, (51, 34), (3, 2)),
    ):
        add("ellipse", Ellipse(eccentricity=e), teeth, ellipse(e, n))
    for e in (0.1, 0.3, 0.6):
        add("ellipse", Ellipse(eccentricity=e), RING_TEETH, ellipse(e, (1, 3), RING), RING)
    for e in (0.0, 0.2, 0.5, 0.8, 0.95):
        add("eccentric-circle", EccentricCircle(eccentricity=e), (61, 61), circle(e, 1, 1))
    add("eccentric-circle", EccentricCircle(eccentricity=0.4), (30, 60), circle(0.4, 1, 2))
    add("eccentric-circle", EccentricCircle(eccentricity=0.3), RING_TEETH, circle(0.3, -1, 3), RING)
    for e in (0.1, 0.4, 0.7, 0.9):
        add("limacon", Limacon(eccentricity=e), (61, 61), lobed(e, (1, 1), 1))
    add("limacon", Limacon(eccentricity=0.2), RING_TEETH, lobed(0.2, (1, 3), -1), RING)
    for e, teeth, n in (
        (0.1, (60, 90), (2, 3)),
        (0.05, (90, 60), (3, 2)),
        (0.2, (61, 61), (1, 1)),
        (0.3, (40, 80), (1, 2)),
    ):
        add("lobed", Lobed(eccentricity=e), teeth, lobed(e, n, 1))
    add("lobed", Lobed(eccentricity=0.05), (60, 90), lobed(0.05, (2, 3), -1), RING)


def _phases(add: Add) -> None:
    for ratios, travel, mate in (
        ((0.5, 2.0), 2.0, 1),
        ((1.0, 1.3), 4.0, 1),
        ((3.0, 0.4), 1.2, 1),
        ((0.2, 0.4), 1.0, -1),
        ((1.0, 1.0001), 2.0, 1),
    ):
        law = LogSpiral(ratios=ratios, driven_travel=travel)
        add("log-spiral", law, (30, 30), spiral(law, mate), mate)
    for ratios, degrees in (((0.5, 2.0), 95.386), ((1.5, 1 / 1.5), 120.0)):
        law = LogSpiral(ratios=ratios, return_angle=math.radians(degrees))
        add("log-spiral", law, (48, 48), nautilus(law))
    for shape in ("cosine", "cubic", "quintic"):
        for knot in (120, 160):
            two = Phases(
                shape=shape, knots=(0.0, math.radians(knot), TURN), ratios=(1.6, "solve", 1.6)
            )
            add("phases", two, (61, 61), phases(two, 1))
    given = Phases(knots=(0.0, math.radians(160), TURN), ratios=(1.6, 0.4, 1.6))
    add("phases", given, (61, 61), phases(given, 1))
    three = Phases(knots=(0.0, 2.0, 4.1, TURN), ratios=(1.2, 0.7, "solve", 1.2))
    add("phases", three, (61, 61), phases(three, 1))
    ways: tuple[tuple[str, Any, Any], ...] = (
        ("cosine", (0.0, 0.2, 1.0, "solve"), (1.0, 1.0, 2.0, 2.0)),
        ("sine", (0.0, 1.0, "solve"), (1.0, 2.0, 2.0)),
        ("quintic", (0.0, 1.0, 2.0, 4.0), (1.0, 1.5, "solve", 0.8)),
    )
    for shape, knots, ratios in ways:
        way = Phases(shape=shape, knots=knots, ratios=ratios, driven_travel=4.0)
        add("phases", way, (40, 40), phases(way, 1))
    sharp = Phases(knots=(0.0, 0.02, 3.0, TURN), ratios=(1.0, 0.9, "solve", 1.0))
    add("phases", sharp, (61, 61), phases(sharp, 1))


def _speeds(add: Add) -> None:
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
        speeds = Multispeed(
            ratios=(ratio, "solve"), angles=(2.5, TURN - 2 * t - 2.5), transition=t, shape=shape
        )
        add("multispeed", speeds, (61, 61), multispeed(speeds, 1))
    for t in (0.3, math.radians(0.1)):
        speeds = Multispeed(
            ratios=(1.0, "solve"), angles=(0.7, 2.0), transition=t, driven_travel=3.2
        )
        add("multispeed", speeds, (40, 40), multispeed(speeds, 1))
    for a in (0.4, 0.7, 0.95):
        cubic = ThreePhasePolynomial(knots=(0.0, 2.8, 4.7, TURN), lowest=a)
        add("three-phase-polynomial", cubic, (61, 61), polynomials(cubic, 1))


def _shapes(add: Add) -> None:
    for law, teeth, n, mate in (
        (Fourier(cosines=(0.2, 0.1), sines=(0.05, 0.0)), (61, 61), (1, 1), 1),
        (Fourier(of="phi2", cosines=(3.0, 0.5), sines=(-4.0, 0.2)), (60, 90), (2, 3), 1),
        (Fourier(cosines=(0.1,) * 3, sines=(-0.05,) * 3), (30, 60), (1, 2), 1),
        (Fourier(cosines=(0.1,), sines=(0.1,)), RING_TEETH, (1, 3), -1),
        (Fourier(cosines=(0.004,) * 12, sines=(0.008,) * 12), (61, 61), (1, 1), 1),
    ):
        add("fourier", law, teeth, fourier(law, n, mate), mate)
    for radii, teeth, n, mate in (
        ((1.0, 1.1, 0.95, 1.02), (61, 61), (1, 1), 1),
        ((2.0, 2.2, 1.9, 2.1, 2.3, 2.0), (40, 60), (2, 3), 1),
        ((1.0, 1.3, 0.8, 1.2, 0.9, 1.0, 1.1, 1.0), (61, 61), (1, 1), 1),
        ((1.0, 1.05, 0.95, 1.0, 1.02), RING_TEETH, (1, 3), -1),
    ):
        law = BSplineLaw(radii=radii)
        add("bspline", law, teeth, bspline(law, n, mate), mate)
    for corners, radius, teeth, n, mate in (
        (4, 1 / 6, (40, 40), (1, 1), 1),
        (3, 0.1, (60, 60), (1, 1), 1),
        (6, 0.05, (60, 90), (2, 3), 1),
        (4, 0.2, (40, 120), (1, 3), -1),
    ):
        law = RoundedPolygon(corners=corners, corner_radius=radius)
        add("rounded-polygon", law, teeth, polygon(law, n, mate), mate)


Written = Callable[[Any, Any], Any]
"""A formula with the library of its functions: numpy, or `witness.exact`; doubles stay exact."""

PHI2: tuple[tuple[str, Written, Written, tuple[int, int]], ...] = (
    # text, phi2, its derivative, teeth
    (
        "phi1 - 0.08*sin(2*phi1)",
        lambda x, m: x - 0.08 * m.sin(2 * x),
        lambda x, m: 1 - mp.mpf(0.08) * 2 * m.cos(2 * x),
        (61, 61),
    ),
    (
        "phi1 - 0.6*sin(phi1)",
        lambda x, m: x - 0.6 * m.sin(x),
        lambda x, m: 1 - 0.6 * m.cos(x),
        (61, 61),
    ),
    (
        "phi1 + 0.001*sin(60*phi1)",
        lambda x, m: x + 0.001 * m.sin(60 * x),
        lambda x, m: 1 + mp.mpf(0.001) * 60 * m.cos(60 * x),
        (61, 61),
    ),
    (
        "phi1/2 + 0.1*cos(phi1)",
        lambda x, m: x / 2 + 0.1 * m.cos(x),
        lambda x, m: 0.5 - 0.1 * m.sin(x),
        (40, 80),
    ),
)
OTHERS: tuple[tuple[str, str, Written, tuple[int, int], int], ...] = (
    # what, text, itself, teeth, mate
    ("ratio", "1 + 0.3*cos(phi1)", lambda x, m: 1 + 0.3 * m.cos(x), (61, 61), 1),
    (
        "ratio",
        "1/(1 + 0.9*cos(phi1 + 0.4))",
        lambda x, m: 1 / (1 + 0.9 * m.cos(x + 0.4)),
        (61, 61),
        1,
    ),
    (
        "ratio",
        "1 + 0.2*tanh(20*sin(phi1))",
        lambda x, m: 1 + 0.2 * m.tanh(20 * m.sin(x)),
        (61, 61),
        1,
    ),
    (
        "ratio",
        "1 + 0.3*exp(-40*(1 - cos(phi1)))",
        lambda x, m: 1 + 0.3 * m.exp(-40 * (1 - m.cos(x))),
        (61, 61),
        1,
    ),
    ("ratio", "1 + 0.1*sin(2*phi1)", lambda x, m: 1 + 0.1 * m.sin(2 * x), (60, 90), 1),
    ("ratio", "1 + 0.1*sin(phi1)", lambda x, m: 1 + 0.1 * m.sin(x), RING_TEETH, -1),
    ("r1", "1/(1 + 0.5*cos(phi1))", lambda x, m: 1 / (1 + 0.5 * m.cos(x)), (61, 61), 1),
    ("r1", "2 + 0.1*cos(3*phi1)", lambda x, m: 2 + 0.1 * m.cos(3 * x), (60, 40), 1),
    ("r1", "5 + exp(sin(phi1))", lambda x, m: 5 + m.exp(m.sin(x)), (61, 61), 1),
    (
        "r1",
        "3 + 0.05*tanh(30*cos(phi1))",
        lambda x, m: 3 + 0.05 * m.tanh(30 * m.cos(x)),
        (61, 61),
        1,
    ),
)


def _exact_of(what: str, function: Written, teeth: tuple[int, int], mate: int) -> Any:
    """Return what makes the exact law of a formula."""
    common = math.gcd(*teeth)
    period, advance = turn_of(teeth[0] // common), turn_of(teeth[1] // common)

    def shape(x: Slope) -> Slope:
        return function(x, exact)

    if what == "r1":
        return by_radius(whole(shape, period, 8), advance, mate)
    if what == "ratio":
        return lambda _: closed_by(shape, period, advance, mate)
    return lambda _: Exact(whole(shape, period, 8), mate)


def _formulas() -> list[Case]:
    """Each as a text and as a Python function, and racks."""
    rows = [("phi2", text, phi2, ratio, teeth, 1) for text, phi2, ratio, teeth in PHI2]
    rows += [(what, text, one, one, teeth, mate) for what, text, one, teeth, mate in OTHERS]
    made = []
    for number, (what, text, written, ratio, teeth, mate) in enumerate(rows):
        ex = _exact_of(what, ratio, teeth, mate)

        def function(x: Any, written: Written = written) -> Any:
            return written(x, np)

        for kind, one in (("formula", text), ("function", function)):
            given: dict[str, Any] = {what: one}
            made.append(Case(f"{kind}-{number}", Formula(**given), teeth, ex, mate))
    for number, (what, text, radius) in enumerate(
        (
            ("r1", "1 + 0.2*cos(phi1)", lambda x: 1 + of(0.2) * exact.cos(x)),
            ("r1", "2 + 0.1*exp(sin(2*phi1))", lambda x: 2 + of(0.1) * exact.exp(exact.sin(2 * x))),
            ("travel", "2*phi1 + 0.3*sin(phi1)", lambda x: 2 + of(0.3) * exact.cos(x)),
        )
    ):
        ex = lambda _, r=radius: Exact(whole(r, turn_of(1)), 0)  # noqa: E731
        made.append(Case(f"rack-{number}", RackLaw(**{what: text}), (24, 31), ex, 0))
    return made


def _motions() -> list[Case]:
    made = []
    for number, (y, rise) in enumerate(
        (
            ("x + x**2/10", lambda x: 1 + x / 5),
            ("x + 0.1*sin(3*x)", lambda x: 1 + of(0.1) * 3 * exact.cos(3 * x)),
            ("exp(x)", exact.exp),
        )
    ):
        law = MotionLaw(y=y, x_from=0.0, x_to=2.0, driver_travel=3.0, driven_travel=2.5)
        period, advance = of(3.0), of(2.5)
        ex = lambda _, p=period, a=advance, f=rise: closed_by(  # noqa: E731
            lambda x: f(2 * x / p), p, a, 1
        )
        made.append(Case(f"motion-{number}", law, (40, 40), ex))
    for number, (lead, rod) in enumerate(((0.0, 3.0), (0.2, 3.0), (0.3, 2.0), (0.1, 20.0))):
        led = f"(phi1 - {lead}*sin(phi1))"
        slide = f"1 - cos{led} + {rod}*(1 - sqrt(1 - (sin{led}/{rod})**2))"
        law = MotionLaw(slide=slide, rod=rod)
        ex = lambda _, a=lead: Exact(whole(lambda x: 1 - of(a) * exact.cos(x), turn_of(1)), 1)  # noqa: E731
        made.append(Case(f"slide-{number}", law, (61, 61), ex))
    return made


def _tables() -> list[Case]:
    made = []
    for number, (kind, count, teeth, mate) in enumerate(
        (
            ("ratio", 12, (61, 61), 1),
            ("ratio", 90, (60, 90), 1),
            ("ratio", 24, (30, 90), -1),
            ("phi2", 24, (61, 61), 1),
            ("phi2", 72, (61, 61), 1),
            ("r1", 16, (61, 61), 1),
            ("r1", 48, (40, 80), 1),
            ("ratio", 400, (61, 61), 1),
        )
    ):
        common = math.gcd(*teeth)
        n = teeth[0] // common, teeth[1] // common
        angles = TURN / n[0] * np.arange(count + 1) / count
        wave = 0.2 * np.cos(n[0] * angles + 0.7)
        values = 1.0 + wave
        values[-1] = values[0]
        if kind == "phi2":
            values = angles + 0.2 * (np.sin(angles + 0.7) - math.sin(0.7))
            values[-1] = TURN
        given: dict[str, Any] = {kind: tuple(values.tolist())}
        law = TableLaw(phi1=tuple(angles.tolist()), **given)
        made.append(Case(f"table-{number}", law, teeth, table(law, n, mate), mate))
    return made
