"""Stiff and extreme wheels: a valid outline in good time, or a refusal with value and limit."""

from __future__ import annotations

import math
import re
import time
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.gears.checks import largest_module
from gearcam.gears.flank import trace
from gearcam.gears.outline import Outline
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.numeric.arrays import as_pairs
from helpers_pairs import Assembly, job
from helpers_sampling import few

SLOWEST = 5.0
"""Seconds of work, however busy the machine is; the one that this was written on takes a tenth."""


LARGEST_TIP = (math.pi / 4 - 1.25 * math.tan(math.radians(20))) / (
    1 / math.cos(math.radians(20)) - math.tan(math.radians(20))
)
"""Tip radius that leaves the common rack no land at all, modules."""


def degrees(*angles: float) -> tuple[float, ...]:
    """Angles in rad."""
    return tuple(math.radians(angle) for angle in angles)


def gaps(outline: Outline) -> float:
    """Largest distance of a curve's end from the next one's start, modules."""
    rows, count = outline.rows, np.arange(len(outline.rows.kind))
    ends = trace(outline.toothing, rows, count, rows.end)[0]
    starts = trace(outline.toothing, rows, count, rows.start)[0]
    return float(np.abs(ends - np.roll(starts, -1)).max()) * math.pi / outline.toothing.pitch


def built_or_refused(law: Any, teeth: tuple[int, int], **given: Any) -> GearPairResult | None:
    """The job, proved; None if the design was refused in a way that helps."""
    start = time.process_time()
    made = job(law, teeth, **given)  # advice is proved in test_families
    try:
        _ = made.gears
    except InfeasibleError as error:
        refused = error
    else:
        refused = None
    if refused is not None:
        assert refused.value is not None
        assert refused.limit is not None
        assert refused.nearest
        return None
    profiles = [gear.profile for gear in made.gears]
    for profile in profiles:
        ring = shapely.LinearRing(as_pairs(profile.points))
        assert ring.is_simple
        assert ring.is_ccw
        assert profile.chord_error <= profile.tolerance
        assert gaps(profile) <= 1e-9
    assert json_clean(made)
    assert time.process_time() - start < SLOWEST
    return made


def json_clean(made: GearPairResult) -> bool:
    """Whether no number of the summary is infinite or not a number."""
    import json

    return bool(json.dumps(made.facts.document, allow_nan=False))


def built(law: Any, teeth: tuple[int, int], **given: Any) -> GearPairResult:
    """The job, proved; a refusal fails the test."""
    made = built_or_refused(law, teeth, **given)
    assert made is not None
    return made


# Shapes


def test_a_very_long_ellipse() -> None:
    made = built(Ellipse(eccentricity=0.95), (200, 200))
    e, distance = 0.95, made.pair.center_distance
    assert made.gear1.toothing.track.convex.radius == pytest.approx(
        0.5 * distance * (1 - e * e), rel=1e-9
    )
    assert Assembly(made).overlap(0.3) < 1e-3


@pytest.mark.parametrize("z", few([3, 4, 5, 6]))
@pytest.mark.parametrize("law", [Constant(), Ellipse(eccentricity=0.2)])
def test_hardly_any_teeth(z: int, law: Any) -> None:
    made = built(law, (z, z))
    assert made.gear1.profile.undercut_teeth == tuple(range(1, z + 1))
    assert "error" in {finding.severity for finding in made.findings}


@pytest.mark.parametrize("teeth", [(3, 9), (9, 3), (3, 100), (7, 5), (17, 60), (3, 4)])
def test_circles_of_unequal_size(teeth: tuple[int, int]) -> None:
    made = built(Constant(), teeth)
    ratio = made.gear1.toothing.track.convex.radius / made.gear2.toothing.track.convex.radius
    assert ratio == pytest.approx(teeth[0] / teeth[1], rel=1e-12)


def test_lobes_of_one_tooth() -> None:
    built(Formula(ratio="1 + 0.02*cos(7*phi1)"), (7, 5))
    built(Formula(ratio="1 + 0.01*cos(13*phi1)"), (13, 17))


@pytest.mark.parametrize("z", [20, 80, 320])
def test_a_phase_of_one_degree(z: int) -> None:
    knots = degrees(0, 120, 121, 240, 360)
    built(Phases(knots=knots, ratios=(1.0, 1.0002, 0.9998, "solve", 1.0)), (z, z))
    steep = Phases(knots=knots, ratios=(1.0, 1.05, 0.95, "solve", 1.0))
    assert built_or_refused(steep, (z, z)) is None


def test_tips_that_meet_five_pitches_from_a_hollow_are_shortened() -> None:
    """The driver's hollow is of 12 modules: corners are in it for pitches, as in a ring."""
    law = Phases(
        knots=(*degrees(0, 16, 60), "solve"),
        ratios=(0.5, 0.5, 1.49, 1.49),
        driven_travel=math.radians(150),
    )
    made = job(law, (150, 150), module=2.0, tolerance=2e-3)
    phi = np.radians([23.2, 23.73, 24.1])
    driven = made.law.phi2(phi)
    for one, two in zip(phi, driven, strict=True):
        first = made.gear1.outline @ [1, 1j] * np.exp(-1j * one)
        second = made.gear2.outline @ [1, 1j] * np.exp(1j * two) + made.pair.center_distance
        wheels = [shapely.Polygon(np.column_stack([z.real, z.imag])) for z in (first, second)]
        assert wheels[0].intersection(wheels[1]).area < 2e-3


@pytest.mark.parametrize("shape", ["cosine", "cubic"])
@pytest.mark.parametrize("z", [40, 400])
def test_a_ratio_that_swings_thirtyfold(shape: str, z: int) -> None:
    law = Phases(shape=shape, knots=degrees(0, 180, 360), ratios=(60 / 31, "solve", 60 / 31))
    built_or_refused(law, (z, z))


def test_a_ratio_that_swings_thirtyfold_on_convex_wheels() -> None:
    e = (30**0.5 - 1) / (30**0.5 + 1)
    made = built(Ellipse(eccentricity=e), (60, 60))
    (_, low), (_, high) = made.law.ratio_range
    assert high / low == pytest.approx(30.0, rel=1e-12)


@pytest.mark.parametrize("e", [0.9, 0.95, 0.97, 0.99])
def test_a_long_ellipse_given_by_its_radius(e: float) -> None:
    """r1 = 1/(1 + e*cos(phi1)) is an ellipse with A/scale = 2/(1 - e*e)."""
    made = job(Formula(r1=f"1/(1 + {e}*cos(phi1))"), (400, 400))
    center = made.law.solved["center_distance_over_scale"]
    assert center == pytest.approx(2 / (1 - e * e), rel=1e-11)


# Sizes


@pytest.mark.parametrize("law", [Ellipse(eccentricity=0.3), Formula(r1="1 + 0.3*cos(2*phi1)")])
@pytest.mark.parametrize("module", few([0.01, 1000.0]))
def test_a_wheel_of_another_size_has_the_same_shape(law: Any, module: float) -> None:
    one = built(law, (40, 40), module=1.0, tolerance=1e-3)
    other = built(law, (40, 40), module=module, tolerance=1e-3 * module)
    for a, b in zip(one.gears, other.gears, strict=True):
        assert len(a.outline) == len(b.outline)
        assert b.outline / module == pytest.approx(a.outline, rel=0, abs=1e-9 * 20)
        assert b.toothing.cutter.kind == a.toothing.cutter.kind
    assert [f.code for f in one.findings if f.code != "no-backlash"] == [
        f.code for f in other.findings if f.code != "no-backlash"
    ]


@pytest.mark.parametrize("law", [Ellipse(eccentricity=0.3), Formula(r1="1 + 0.3*cos(2*phi1)")])
def test_a_tolerance_of_a_millionth_of_the_module(law: Any) -> None:
    fine = built(law, (40, 40), tolerance=1e-6)
    rough = built(law, (40, 40), tolerance=1e-4)
    assert len(fine.gear1.outline) == pytest.approx(10 * len(rough.gear1.outline), rel=0.1)


# Racks


RACKS = {
    "sharp corners": Rack(tip_radius=0.0),
    "deep": Rack(dedendum=2.0, tip_radius=0.0),
    "shallow": Rack(addendum=0.4, dedendum=0.5, tip_radius=0.1),
    "hardly rounded": Rack(tip_radius=1e-6),
    "fully rounded": Rack(dedendum=1.25, tip_radius=LARGEST_TIP),
    "centre of the tip on the pitch line": Rack(addendum=0.3, dedendum=0.38, tip_radius=0.38),
    "centre near the pitch line": Rack(addendum=0.3, dedendum=0.381, tip_radius=0.38),
    "14.5 degrees": Rack(pressure_angle=math.radians(14.5)),
    "14.5 degrees, sharp": Rack(pressure_angle=math.radians(14.5), tip_radius=0.05),
    "30 degrees": Rack(pressure_angle=math.radians(30), tip_radius=0.1),
    "35 degrees": Rack(pressure_angle=math.radians(35), addendum=0.8, dedendum=1.0, tip_radius=0.1),
    "5 degrees": Rack(pressure_angle=math.radians(5)),
    "5 degrees, sharp": Rack(pressure_angle=math.radians(5), tip_radius=0.05),
}


@pytest.mark.parametrize("rack", few(RACKS, 3))
@pytest.mark.parametrize(
    "law", few([Ellipse(eccentricity=0.3), Constant(), Formula(r1="1 + 0.3*cos(2*phi1)")], 3)
)
def test_racks_of_all_sorts(rack: str, law: Any) -> None:
    built_or_refused(law, (40, 40), rack=RACKS[rack])


@pytest.mark.parametrize(
    ("rack", "what", "value", "limit"),
    [
        # rho*(1/cos(alpha) - tan(alpha)) <= pi/4 - hf*tan(alpha)
        (Rack(dedendum=1.25, tip_radius=0.5), "tip radius", 0.5, 0.4719),
        (Rack(dedendum=2.0, tip_radius=0.1), "tip radius", 0.1, 0.08206),
        (
            Rack(pressure_angle=math.radians(30), dedendum=1.25, tip_radius=0.38),
            "tip radius",
            0.38,
            0.11035,
        ),
        # hf*tan(alpha) <= pi/4
        (Rack(pressure_angle=math.radians(35), dedendum=1.25), "dedendum", 1.25, 1.12166),
        (Rack(dedendum=2.5, tip_radius=0.0), "dedendum", 2.5, 2.15785),
    ],
)
def test_a_rack_that_cannot_be_made_is_refused_with_its_limit(
    rack: Rack, what: str, value: float, limit: float
) -> None:
    with pytest.raises(InfeasibleError, match=what) as caught:
        _ = job(Constant(), (40, 40), rack=rack).pair
    assert caught.value.value == value
    assert caught.value.limit == pytest.approx(limit, abs=5e-5)


@pytest.mark.parametrize("law", [Constant(), Ellipse(eccentricity=0.3)])
@pytest.mark.parametrize("z", [20, 41])
def test_pointed_teeth_end_in_a_point(law: Any, z: int) -> None:
    made = built(law, (z, z), rack=Rack(addendum=1.75, dedendum=2.0, tip_radius=0.08))
    for gear in made.gears:
        assert gear.profile.tip_thickness.max() < 1e-9
        assert gear.profile.flanks.tips.height.max() < 1.75 * made.pair.module
    assert {finding.code for finding in made.findings} >= {"thin-tip"}


def test_some_teeth_are_pointed_and_others_are_not() -> None:
    rack = Rack(addendum=1.75, dedendum=2.0, tip_radius=0.08)
    made = built(Ellipse(eccentricity=0.5), (41, 41), rack=rack)
    thickness = made.gear1.profile.tip_thickness
    assert thickness.min() < 1e-9 < 0.01 < thickness.max()


# Loops at the root


LOOPS = [
    *[(Constant(), z, Rack(pressure_angle=math.radians(17), tip_radius=0.25)) for z in (9, 16)],
    (Constant(), 3, Rack(pressure_angle=math.radians(22.5), tip_radius=0.25)),
    *[(Ellipse(eccentricity=0.4), z, Rack()) for z in (9, 13, 14, 17)],
    *[(Ellipse(eccentricity=0.6), z, Rack()) for z in (8, 9, 12, 21)],
    (Ellipse(eccentricity=0.2), 17, Rack()),
    # Without a land two fillets touch where they meet, and that is no crossing.
    *[(Constant(), z, Rack(dedendum=1.25, tip_radius=LARGEST_TIP)) for z in (8, 12, 16)],
    (Ellipse(eccentricity=0.4), 17, Rack(dedendum=1.25, tip_radius=LARGEST_TIP)),
]


@pytest.mark.parametrize(("law", "z", "rack"), few(LOOPS))
def test_undercut_flanks_end_on_their_fillets(law: Any, z: int, rack: Rack) -> None:
    made = built(law, (z, z), rack=rack)
    for gear in made.gears:
        assert gear.profile.undercut_teeth != ()


def test_alike_teeth_are_trimmed_alike() -> None:
    made = built(Constant(), (16, 16), rack=Rack(pressure_angle=math.radians(17), tip_radius=0.25))
    lowest = made.gear1.profile.flanks.lowest
    assert np.ptp(lowest) < 1e-9


def test_undercut_is_no_reason_to_refuse_a_wheel() -> None:
    law = Formula(phi2="phi1*25/50 + 0.019166666666666667*sin(phi1 + 1.04)")
    built(law, (25, 50), rack=Rack(pressure_angle=math.radians(14.5)), tolerance=1e-5)


# What must not pass unsaid


def errors_of(made: GearPairResult) -> list[str]:
    """Codes of the findings at error level."""
    return [finding.code for finding in made.findings if finding.severity == "error"]


@pytest.mark.parametrize(("e", "z"), [(0.97, 40), (0.72, 6)])
def test_a_shaft_outside_its_wheel_is_refused(e: float, z: int) -> None:
    """The near focus lies less than a dedendum inside the centrode: a*(1 - e) < 1.25 m."""
    rack = Rack(addendum=0.8, dedendum=1.0, tip_radius=0.3)
    made = job(Ellipse(eccentricity=e), (z, z), rack=rack)
    assert 0.5 * made.pair.center_distance * (1 - e) < 1.0
    with pytest.raises(InfeasibleError, match=r"shaft|axis"):
        _ = made.gears


@pytest.mark.parametrize("addendum", [0.2, 0.5])
def test_teeth_too_short_to_drive_are_an_error(addendum: float) -> None:
    made = built(Constant(), (40, 40), rack=Rack(addendum=addendum))
    assert errors_of(made) != []


@pytest.mark.parametrize("rack", [Rack(addendum=2.0, dedendum=1.0, tip_radius=0.05)])
def test_tips_never_reach_the_mates_root(rack: Rack) -> None:
    try:
        made = built_or_refused(Constant(), (40, 40), rack=rack, tolerance=1e-4)
    except DesignError:
        return
    if made is not None:
        assembly = Assembly(made)
        assert max(assembly.overlap(phi) for phi in np.linspace(0.0, 1.0, 24)) < 1e-4


def test_the_largest_module_is_free_of_undercut_under_a_pinion_cutter_too() -> None:
    law = Formula(r1="1 + 0.21*cos(3*phi1) - 0.042*sin(6*phi1)")
    made = job(law, (36, 36), distance=180.0)
    assert made.gear2.toothing.cutter.kind == "pinion"
    fewest = math.ceil(36 * made.pair.module / largest_module(made.gear2))
    again = job(law, (fewest, fewest), distance=180.0)
    assert again.gear2.profile.undercut_teeth == ()


@pytest.mark.parametrize("center", [1.0, 1.8, 3.6])
def test_a_narrow_bump_of_the_ratio_is_not_lost(center: float) -> None:
    """A bump of 1 % over half a degree: sqrt(2*pi/5000)*0.01 rad = 0.35e-3 of the driven angle."""
    bump = f"exp(-20000*sin((phi1 - {center})/2)**2)"
    law = job(Formula(ratio=f"1 + 0.01*{bump}"), (300, 300)).law
    x = np.linspace(0.0, 2 * math.pi, 200001)
    assert np.trapezoid(law.ratio(x), x) == pytest.approx(2 * math.pi, abs=1e-9)


def test_a_formula_must_repeat_with_every_lobe_not_only_meet_at_its_ends() -> None:
    """sin(phi1)^3 is zero and flat at 0 and 180 degrees, but not the same in both halves."""
    with pytest.raises(InfeasibleError, match="periodic"):
        _ = job(Formula(ratio="1 + 0.3*sin(phi1)**3"), (40, 20)).law


def test_a_flank_may_cross_itself_and_then_its_fillet() -> None:
    """The curvature jumps at the knot at 0: the flank of tooth 14 has a small loop of its own."""
    law = Phases(knots=(0.0, 4.4265040489080185, 2 * math.pi), ratios=(1.404, "solve", 1.404))
    rack = Rack(addendum=1.3, dedendum=1.5, tip_radius=0.2)
    made = built(law, (14, 14), rack=rack)
    flanks = made.gear1.profile.flanks
    assert -np.inf < flanks.cusps.dedendum[13] < flanks.lowest[13]


def test_where_a_wheel_falls_apart_is_told_in_words() -> None:
    law = Ellipse(eccentricity=0.99)
    with pytest.raises(InfeasibleError, match="not in one piece") as caught:
        _ = job(law, (41, 41), module=1.0).gear1
    assert re.fullmatch(r"self-intersection at x = -1\.\d+, y = 0 mm", caught.value.where)
