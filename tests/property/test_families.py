"""Every law family at random: wheels that fit each other, or a refusal whose advice holds.

Parameters, tooth counts from 6 to 200 (the quick runs: to 60), profile shift. The outlines are
simple and do not collide in 64 phases for each tooth (by the stepwise overlap, and by whole
outlines in some phases); a refusal names tooth counts that build while one step fewer is refused;
at most a fifth are refused.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.centrodes import EccentricCircle, Limacon, Lobed, LogSpiral
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.position import MotionLaw
from gearcam.laws.ratio.shapes import BSplineLaw, RoundedPolygon
from gearcam.laws.ratio.span import RACK
from gearcam.laws.ratio.table import TableLaw
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.overlap import Turning
from helpers_pairs import explained, job
from helpers_sampling import few, rounded

MODULE = 2.0
TURN = 2 * math.pi
PHASES_PER_TOOTH = 64
FEW_TEETH, FEW_PHASES = 60, 24

Given = tuple[Any, tuple[int, int], float]


def degrees(low: int, high: int) -> st.SearchStrategy[float]:
    return st.integers(low, high).map(math.radians)


@st.composite
def equal(draw: st.DrawFn, low: int = 6) -> tuple[int, int]:
    z = draw(st.integers(low, 200))
    return z, z


@st.composite
def lobed(draw: st.DrawFn, low: int = 6) -> tuple[int, int]:
    n1, n2 = draw(st.sampled_from([(1, 1), (1, 1), (1, 2), (2, 1), (2, 3), (3, 2)]))
    each = draw(st.integers(math.ceil(low / min(n1, n2)), 200 // max(n1, n2)))
    return n1 * each, n2 * each


@st.composite
def one_lobe(draw: st.DrawFn, low: int = 6) -> tuple[int, int]:
    n = draw(st.integers(1, 3))
    z = draw(st.integers(low, 200 // n))
    return z, n * z


@st.composite
def phases(draw: st.DrawFn) -> Phases:
    low, high = draw(rounded(0.5, 1)), draw(rounded(1, 1.7))
    kind = draw(st.sampled_from(["two", "three", "open", "sine"]))
    if kind == "two":
        knots = (0.0, draw(degrees(120, 240)), TURN)
        shape = draw(st.sampled_from(["cosine", "cubic", "quintic"]))
        return Phases(shape=shape, knots=knots, ratios=(high, "solve", high))
    if kind == "three":
        knots = (0.0, draw(degrees(90, 150)), draw(degrees(200, 260)), TURN)
        return Phases(knots=knots, ratios=(1.2, low, "solve", 1.2))
    travel = draw(degrees(150, 280))
    first, second = draw(degrees(5, 20)), draw(degrees(60, 90))
    if kind == "sine":
        return Phases(
            shape="sine",
            knots=(0.0, second, "solve"),
            ratios=(1.0, high, high),
            driven_travel=travel,
        )
    return Phases(
        knots=(0.0, first, second, "solve"), ratios=(low, low, high, high), driven_travel=travel
    )


@st.composite
def multispeeds(draw: st.DrawFn) -> Multispeed:
    transition = draw(degrees(40, 80))
    first = draw(rounded(0.35, 0.65)) * (TURN - 2 * transition)
    angles = (first, TURN - 2 * transition - first)
    shape = draw(st.sampled_from(["quintic", "cosine", "cubic"]))
    ratio = draw(rounded(0.7, 1.3))
    return Multispeed(ratios=(ratio, "solve"), angles=angles, transition=transition, shape=shape)


@st.composite
def fouriers(draw: st.DrawFn) -> Fourier:
    a, b = draw(st.tuples(rounded(-0.25, 0.25), rounded(-0.1, 0.1)))
    return Fourier(cosines=(a, b), sines=(draw(rounded(-0.2, 0.2)),))


@st.composite
def tables(draw: st.DrawFn) -> TableLaw:
    count, a, shift = draw(st.integers(12, 48)), draw(rounded(-0.3, 0.3)), draw(rounded(0, 6))
    angles = tuple(TURN * k / count for k in range(count + 1))
    wave = [math.cos(x + shift) for x in (*angles[:-1], 0.0)]
    kind = draw(st.sampled_from(["ratio", "phi2", "r1"]))
    if kind == "phi2":
        rise = [math.sin(x + shift) - math.sin(shift) for x in (*angles[:-1], 0.0)]
        values = [x + a * w for x, w in zip(angles, rise, strict=True)]
    else:
        values = [1.0 + (a if kind == "ratio" else 0.5 * a) * w for w in wave]
    return TableLaw(phi1=angles, **{kind: tuple(values)})  # type: ignore[arg-type]


@st.composite
def motions(draw: st.DrawFn) -> MotionLaw:
    a = draw(rounded(0, 0.4))
    if draw(st.booleans()):
        turned = f"(phi1 - {a}*sin(phi1))"
        return MotionLaw(slide=f"1 - cos{turned}", rod=draw(rounded(2, 8)))
    travel = draw(degrees(90, 270))
    return MotionLaw(
        y=f"x + {a}*x**2", x_from=0.0, x_to=1.0, driver_travel=travel, driven_travel=travel
    )


@st.composite
def splines(draw: st.DrawFn) -> BSplineLaw:
    count = draw(st.integers(4, 8))
    return BSplineLaw(radii=tuple(draw(rounded(0.9, 1.1)) for _ in range(count)))


def ellipses(e: float) -> Ellipse:
    return Ellipse(eccentricity=e)


FAMILIES: dict[str, tuple[st.SearchStrategy[Any], st.SearchStrategy[tuple[int, int]]]] = {
    "phases": (phases(), equal(20)),
    "constant": (st.just(Constant()), st.tuples(st.integers(6, 200), st.integers(6, 200))),
    "ellipse": (rounded(0, 0.6).map(ellipses), lobed()),
    "formula": (rounded(-0.3, 0.3).map(lambda a: Formula(ratio=f"1 + {a}*cos(6*phi1)")), lobed(40)),
    "three-phase-polynomial": (
        rounded(0.4, 0.9).map(
            lambda a: ThreePhasePolynomial(knots=(0.0, 2.8, 4.7, TURN), lowest=a)
        ),
        equal(20),
    ),
    "eccentric-circle": (
        rounded(0, 0.6).map(lambda e: EccentricCircle(eccentricity=e)),
        one_lobe(),
    ),
    "limacon": (rounded(0, 0.4).map(lambda e: Limacon(eccentricity=e)), one_lobe()),
    "lobed": (rounded(0, 0.15).map(lambda e: Lobed(eccentricity=e)), lobed()),
    "log-spiral": (
        st.builds(
            lambda i, k, t: LogSpiral(ratios=(i, i * k), driven_travel=t),
            rounded(0.6, 1.2),
            rounded(1.2, 3),
            degrees(60, 200),
        )
        | st.builds(
            lambda k, t: LogSpiral(ratios=(1 / k, k), return_angle=t),
            rounded(1.05, 1.4),
            degrees(90, 170),
        ),
        equal(8),
    ),
    "bspline": (splines(), equal(12)),
    "rounded-polygon": (
        st.builds(
            lambda n, c: RoundedPolygon(corners=n, corner_radius=c),
            st.integers(3, 6),
            rounded(0.16, 0.4),
        ),
        equal(20),
    ),
    "multispeed": (multispeeds(), equal(20)),
    "fourier": (fouriers(), equal(12)),
    "table": (tables(), equal(12)),
    "motion": (motions(), equal(12)),
    "rack": (
        rounded(0, 0.2).map(lambda a: RackLaw(r1=f"1 + {a}*cos(2*phi1)")),
        st.tuples(st.integers(12, 200), st.integers(6, 200)),
    ),
}


def region(points: Any) -> Any:
    return shapely.Polygon(np.stack([points.real, points.imag], axis=1))


def whole_overlap(made: GearPairResult, phi: float) -> float:
    """Area that the whole outlines share at a phase."""
    driven = float(made.law.phi2(phi))
    one = made.gear1.outline @ [1, 1j] * np.exp(-1j * phi)
    two = made.gear2.outline @ [1, 1j]
    if made.law.mate == RACK:
        two = two - 1j * driven * made.pair.center_distance
    else:
        two = two * np.exp(1j * driven) + made.pair.center_distance
    return float(shapely.intersection(region(one), region(two)).area)


def demand_free(made: GearPairResult, per_tooth: int) -> None:
    """No collision: every phase by the stepwise overlap, a few by whole outlines."""
    end = float(made.centrode_angles()[-1]) if made.law.mate == RACK else made.law.lobes.period
    phases = end * (np.arange(12) + 0.37) / 12
    assert max(whole_overlap(made, phi) for phi in phases) <= explained(made)
    first, second = (half_teeth(gear.profile) for gear in made.gears)
    if not (first.sound and second.sound):  # the study refuses them
        phases = end * np.arange(per_tooth) / per_tooth
        assert max(whole_overlap(made, phi) for phi in phases) <= explained(made)
        return
    turning = Turning(
        rolling=made.pair.rolling, driver=first, driven=second, distance=made.pair.shift
    )
    if made.pair.closed:
        count = per_tooth * math.gcd(*made.pair.teeth)
        angles = made.law.lobes.period * np.arange(count) / count
    else:
        count = per_tooth * made.pair.teeth[1]
        angles = np.linspace(0.0, end, count)
    found = turning.overlaps(angles, 0.0)
    areas = np.bincount(found.step, found.area, minlength=count)
    assert areas.max() <= explained(made)


def demand_remedies(refused: GearPairResult, patience: float) -> None:
    """What the search names builds, and the next smaller change is refused or has errors."""
    found = gearcam.remedies(refused, patience=patience)
    assert found.found or found.gave_up or "pair.teeth" in found.tried
    for remedy in found.found:
        assert not has_errors(remedy.design)
        assert not remedy.less or has_errors(refused.design.with_(remedy.less))


def has_errors(design: Any) -> bool:
    """Whether a design is refused or builds with errors."""
    try:
        findings = gearcam.build(design).findings
    except InfeasibleError:
        return True
    return any(finding.severity == "error" for finding in findings)


def demand(given: Given, *, thorough: bool = True) -> bool:
    """Build a design and demand all that is promised; whether it was built."""
    law, teeth, x = given
    start = time.process_time()
    made = job(law, teeth, module=MODULE, x=x)
    try:
        _ = made.gears
    except InfeasibleError as error:
        refused: InfeasibleError | None = error
    else:
        refused = None
    assert time.process_time() - start < 10.0
    if refused is not None:
        demand_remedies(made, 6.0 if thorough else 0.3)
        return False
    for gear in made.gears:
        ring = shapely.LinearRing(gear.outline)
        assert ring.is_simple
        assert ring.is_ccw
    demand_free(made, PHASES_PER_TOOTH if thorough else FEW_PHASES)
    _ = made.findings
    return True


def run(family: str, examples: int, most: int = 200) -> list[bool]:
    """Try designs of a family, one wheel with `most` teeth at most; whether each was built.

    Few teeth are looked at in fewer phases, and remedies are sought for a shorter time.
    """
    laws, teeth = FAMILIES[family]
    built: list[bool] = []

    @settings(
        derandomize=True,
        database=None,
        deadline=None,
        max_examples=examples,
        phases=[Phase.generate],
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    )
    @given(
        laws,
        teeth.filter(lambda counts: min(counts) <= most),
        st.sampled_from([0.0, 0.0, 0.2, -0.2, 0.4]),
    )
    def one(law: Any, counts: tuple[int, int], x: float) -> None:
        built.append(demand((law, counts, x), thorough=most > FEW_TEETH))

    one()
    return built


@pytest.mark.parametrize("family", few(FAMILIES))
def test_a_few_designs_of_each_family(family: str) -> None:
    run(family, 2, most=FEW_TEETH)


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_two_hundred_designs_of_each_family(family: str) -> None:
    built = run(family, 200)
    assert len(built) >= 150
    assert np.mean(built) >= 0.8


def test_every_family_of_the_registry_is_tried() -> None:
    from gearcam.laws.ratio.base import LAWS

    assert set(FAMILIES) == set(LAWS)
