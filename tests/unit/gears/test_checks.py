"""Every check speaks just beyond its limit and is silent just within it, in a real build."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from mpmath import ellipe

from gearcam.base.findings import CHECKS, Finding
from gearcam.gears.checks import remote_cutter, undercut
from gearcam.gears.spec import Rack, RingSpec
from gearcam.gears.subject import KIND, CheckedPair
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.composite import Fourier
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from helpers_built import built
from helpers_pairs import job, profile
from helpers_rings import highest_on_circles, ring, ring_job

HALF = (0.0, math.pi, 2 * math.pi)
UNEVEN = (0.0, math.radians(160), 2 * math.pi)


def codes(made: GearPairResult) -> dict[str, Finding]:
    return {finding.code: finding for finding in made.findings}


def nearly_closed(miss: float) -> GearPairResult:
    return job(Phases(knots=HALF, ratios=(1.2, 0.8 + miss / math.pi, 1.2)), (30, 30))


def swing(smallest: float) -> GearPairResult:
    e = (1 - smallest) / (1 + smallest)
    return job(Ellipse(eccentricity=e), (200, 200))


def bending(radius_in_modules: float) -> GearPairResult:
    """An ellipse's smallest radius is a(1 - e^2); the module follows from the perimeter 4aE(e)."""
    e = 0.8
    radius = (1 - e * e) / (4 * float(ellipe(e * e)) / (math.pi * 30))
    return job(
        Ellipse(eccentricity=e),
        (30, 30),
        limits={"convex_radius": 2.5 * radius / radius_in_modules},
    )


def concave(limit: float) -> GearPairResult:
    return job(Formula(r1="1 + 0.25*cos(2*phi1)"), (40, 40), limits={"concave_radius": limit})


def tips(addendum: float) -> GearPairResult:
    return job(Constant(), (12, 60), rack=Rack(addendum=addendum, dedendum=2.0, tip_radius=0.08))


def rim(extra: float) -> GearPairResult:
    """Root radius of z = 40, m = 1 is 18.75 mm; a bore of 32.1 mm leaves a rim of 2.7 modules."""
    return job(Constant(), (40, 40), bores=(2 * (18.75 - 2.7) + extra, 10.0))


def overlap_of(ratio: float) -> GearPairResult:
    """Circular wheels z = 40: the contact ratio follows from the addendum in closed form."""
    alpha = math.radians(20)
    half = 0.5 * ratio * math.pi * math.cos(alpha) + 20 * math.sin(alpha)
    addendum = math.sqrt(half**2 + (20 * math.cos(alpha)) ** 2) - 20
    return job(Constant(), (40, 40), rack=Rack(addendum=addendum))


def heights(limit: float) -> GearPairResult:
    return job(Formula(r1="1 + 0.25*cos(2*phi1)"), (60, 60), limits={"tip_height": limit})


def shaped(over: float) -> GearPairResult:
    """The limit of cutter teeth over what fits: 2*R/(1.15*m) with the concave radius R.

    r = 1 + 0.25*cos(2*phi) has kappa = (r - r'')/r^2 = -4/9 at 90 deg, and a length of pi*m*z.
    """
    phi = np.linspace(0.0, 2 * math.pi, 4097)[:-1]
    speed = np.hypot(1 + 0.25 * np.cos(2 * phi), 0.5 * np.sin(2 * phi))
    scale = math.pi * 80 / (2 * math.pi * float(speed.mean()))
    teeth = 2 * scale * (9 / 4) / 1.15
    law = Formula(r1="1 + 0.25*cos(2*phi1)")
    return job(law, (80, 80), limits={"cutter_teeth": teeth * over})


def door(more: float) -> GearPairResult:
    """The furnace door, its limit of the gap `more` rad than what is left, by hand.

    Half a pitch beyond its ends the driven wheel is a circle of radius A/2 and A/3.
    """
    made = profile("furnace_door")
    ends = 2.5 * math.pi * 5 / made.pair.center_distance
    gap = 2 * math.pi - math.radians(308.3) - ends
    return job(made.design.law, (29, 29), module=5.0, limits={"end_gap": gap + more})


def shaper(teeth: float) -> GearPairResult:
    """A ring cut by a pinion of so many teeth."""
    return ring_job(ring=RingSpec(cutter_teeth=teeth))


def circles(addendum: float) -> GearPairResult:
    return ring({"type": "constant"}, (28, 33), rack={"addendum": addendum})


class Case(NamedTuple):
    code: str
    severity: str
    beyond: Callable[[], GearPairResult]
    within: Callable[[], GearPairResult]


CASES = [
    Case("closure", "warning", lambda: nearly_closed(1.8e-9), lambda: nearly_closed(1.7e-9)),
    Case("ratio-positive", "warning", lambda: swing(0.0999), lambda: swing(0.1001)),
    Case(
        "ratio-continuity",
        "warning",
        lambda: job(
            Phases(knots=UNEVEN, ratios=(1.2, 0.8, 1.2), shape="cubic"),
            (30, 30),
            limits={"ratio_continuity": 2},
        ),
        lambda: job(
            Phases(knots=UNEVEN, ratios=(1.2, 0.8, 1.2), shape="cubic"),
            (30, 30),
            limits={"ratio_continuity": 1},
        ),
    ),
    # r1'/r1 of an ellipse is at most e/sqrt(1 - e^2): psi = asin(e), and 20 + 30 = 50 deg
    Case(
        "pressure-angle",
        "warning",
        lambda: job(Ellipse(eccentricity=0.5001), (60, 60)),
        lambda: job(Ellipse(eccentricity=0.4999), (60, 60)),
    ),
    # i = 1 + a*cos(4*phi1) changes by 4*a at most
    Case(
        "acceleration",
        "warning",
        lambda: job(Fourier(cosines=(0.0, 0.0, 0.0, 0.5001)), (160, 160)),
        lambda: job(Fourier(cosines=(0.0, 0.0, 0.0, 0.4999)), (160, 160)),
    ),
    Case("self-crossing", "warning", lambda: door(1e-9), lambda: door(-1e-9)),
    Case("concave-teeth", "warning", lambda: shaped(1.0001), lambda: shaped(0.9999)),
    Case("small-cutter", "note", lambda: shaper(11.999), lambda: shaper(12.0)),
    Case("sharp", "warning", lambda: bending(2.499), lambda: bending(2.501)),
    Case(
        "undercut", "warning", lambda: job(Constant(), (17, 60)), lambda: job(Constant(), (18, 60))
    ),
    Case("contact-ratio", "warning", lambda: overlap_of(1.0999), lambda: overlap_of(1.1001)),
    # tips as high as this end neither at form points nor at cusps
    Case(
        "tips-collide",
        "error",
        lambda: circles(highest_on_circles(28, 33) + 1e-6),
        lambda: circles(highest_on_circles(28, 33) - 1e-6),
    ),
    Case("thin-rim", "warning", lambda: rim(0.002), lambda: rim(-0.002)),
    Case(
        "no-backlash",
        "note",
        lambda: job(Constant(), (20, 20), limits={"backlash": 1e-6}),
        lambda: job(Constant(), (20, 20), limits={"backlash": 0.0}),
    ),
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.code)
def test_a_check_speaks_beyond_its_limit_only(case: Case) -> None:
    found = codes(case.beyond()).get(case.code)
    assert found is not None
    assert found.severity == case.severity
    assert found.message.endswith(".")
    assert found.where
    assert found.value is not None
    assert case.code not in codes(case.within())


def test_concave_parts_are_noted_with_their_radius() -> None:
    found = codes(concave(1e6))["concave"]
    assert found.severity == "note"
    assert found.value is not None
    assert "concave" in codes(concave(found.value * 1.0001))
    assert "concave" not in codes(concave(found.value * 0.9999))
    assert "concave" not in codes(job(Ellipse(eccentricity=0.3), (40, 40)))


def test_thin_and_pointed_tips() -> None:
    """z = 12: the thickness falls with the addendum; the two sides of 0.2 modules, and a point."""
    low, high = 1.0, 1.6
    for _ in range(12):
        middle = 0.5 * (low + high)
        thick = tips(middle).gear1.profile.tip_thickness.min() >= 0.2
        low, high = (middle, high) if thick else (low, middle)
    assert "thin-tip" in codes(tips(high))
    assert "thin-tip" not in codes(tips(low))
    assert "thin" in codes(tips(high))["thin-tip"].message
    pointed = tips(1.95)
    assert codes(pointed)["thin-tip"].value == pytest.approx(0.0, abs=1e-9)
    assert "pointed" in codes(pointed)["thin-tip"].message


def test_short_flanks_are_noted() -> None:
    made = heights(1.0)
    tip = [
        gear.profile.flanks.tips.height.min() / gear.toothing.cutter.addendum for gear in made.gears
    ]
    least = min(tip)
    assert least < 0.9999
    assert "short-flank" in codes(heights(least + 1e-6))
    assert "short-flank" not in codes(heights(least - 1e-6))


def test_a_pinion_cutter_that_reaches_a_remote_tooth_names_both() -> None:
    """A cutter four times as large as the one chosen touches both ends of a wheel with a waist.

    The cutter that a build chooses fits into the sharpest hollow, and hollows of a polar curve
    widen outwards, so that no build was found in which it reaches a remote tooth.
    """
    made = job(Formula(r1="1 + 0.5*cos(2*phi1)"), (60, 60))
    assert "remote-cutter" not in codes(made)
    gear = made.gear1
    large = replace(
        gear.toothing, cutter=replace(gear.toothing.cutter, kc=gear.toothing.cutter.kc / 4)
    )
    pair = replace(made.pair, toothings=(large, made.pair.toothings[1]))
    gears = (replace(gear, pair=pair), made.gear2)
    subject = CheckedPair(pair=pair, gears=gears, bores=(None, None))
    (found,) = remote_cutter(subject, math.nan)
    assert found.severity == "warning"
    numbers = [int(word) for word in found.where.replace(",", "").split() if word.isdigit()]
    assert numbers[0] == 1
    assert abs(numbers[1] - numbers[2]) >= 3


def test_every_check_of_the_registry_is_tested_here() -> None:
    named = {case.code for case in CASES} | {
        "concave",
        "thin-tip",
        "short-flank",
        "remote-cutter",
        "measuring-pin",
    }
    assert named == {check.code for check in CHECKS.values() if check.kind == KIND}
    assert len(named) == 19


def test_a_pin_that_touches_not_all_flanks_is_noted() -> None:
    made = job(Ellipse(eccentricity=0.3), (41, 41))
    thickest = float(np.min(made.gear1.measuring.over.thickest.diameter))
    for more, noted in ((1e-6, True), (-1e-6, False)):
        output = replace(made.design.output, pin_diameter=(thickest + more, 1.75))
        found = codes(built(replace(made.design, output=output)))
        assert ("measuring-pin" in found) == noted
        if noted:
            assert found["measuring-pin"].severity == "note"
            assert "The recommended pin has 1.75 mm." in found["measuring-pin"].message
            assert found["measuring-pin"].where == "wheel 1, teeth 11, 31"
    unusual = replace(made.design, pair=replace(made.design.pair, module=0.003))
    drawn = replace(unusual, output=replace(made.design.output, files=("drawing-svg",)))
    assert "measuring-pin" not in codes(built(unusual))
    assert "no pin of a simple size" in codes(built(drawn))["measuring-pin"].message.lower()


def test_a_pair_that_does_not_drive_is_an_error() -> None:
    found = codes(overlap_of(0.95))["contact-ratio"]
    assert found.severity == "error"
    assert found.value == pytest.approx(0.95, abs=1e-9)
    assert "No flanks touch" in found.message
    assert "tooth edges drive" in found.message
    assert "phi1 = " in found.message
    assert codes(overlap_of(1.01))["contact-ratio"].severity == "warning"


def test_flanks_that_carry_long_enough_but_not_everywhere_are_held_against_nothing() -> None:
    found = codes(job(Ellipse(eccentricity=0.8), (24, 24)))["contact-ratio"]
    assert found.severity == "error"
    assert found.value is not None
    assert found.value > 1.1
    assert found.limit_text == ""
    assert "No flanks touch" in found.message


def test_undercut_that_leaves_a_phase_undriven_is_an_error() -> None:
    made = job(Constant(), (17, 60))
    subject = CheckedPair(pair=made.pair, gears=made.gears, bores=(None, None))
    ratio = subject.contact_ratio
    (warning,) = undercut(subject, ratio - 1e-6)
    (error,) = undercut(subject, ratio + 1e-6)
    assert (warning.severity, error.severity) == ("warning", "error")
    cut = codes(job(Constant(), (5, 5)))["undercut"]
    assert cut.severity == "error"


def test_the_fewest_teeth_without_undercut_are_named() -> None:
    """With the fewest teeth there is no undercut, with one less there is, and so they are named.

    m = rho_min*sin(alpha)^2 with the sharpest radius a(1 - e^2) and the perimeter 4aE(e) = pi*m*z.
    """
    e = 0.5
    law = Ellipse(eccentricity=e)
    exact = 4 * float(ellipe(e * e)) / (math.pi * (1 - e * e) * math.sin(math.radians(20)) ** 2)
    teeth = math.ceil(exact)
    found = codes(job(law, (18, 18)))["undercut"]
    assert found.limit == teeth == 22
    assert "undercut" not in codes(job(law, (teeth, teeth)))
    assert "undercut" in codes(job(law, (teeth - 1, teeth - 1)))
    assert f"With about {teeth} : {teeth} teeth" in found.message


def test_contact_ratio_of_circular_wheels_is_the_textbooks() -> None:
    """Contact ratio from tip and base circles; both sides, every flank."""
    made = job(Constant(), (24, 36))
    subject = CheckedPair(pair=made.pair, gears=made.gears, bores=(None, None))
    alpha, r1, r2 = math.radians(20), 12.0, 18.0

    def tip(r: float) -> float:
        return math.sqrt((r + 1) ** 2 - (r * math.cos(alpha)) ** 2)

    path = tip(r1) + tip(r2) - (r1 + r2) * math.sin(alpha)
    expected = path / (math.pi * math.cos(alpha))
    for pairs in subject.sides:
        np.testing.assert_allclose(pairs.arcs.ratios, expected, rtol=1e-9)
        assert pairs.arcs.stretches[2].min() == 1


def test_findings_come_worst_first() -> None:
    order = ["error", "warning", "note"]
    found = [finding.severity for finding in profile("nail_machine_three_phase").findings]
    assert found == sorted(found, key=order.index)
    assert "warning" in found
    assert "error" not in found


@pytest.mark.parametrize("module", [1.0, 1.3, 2.0, 3.7])
@pytest.mark.parametrize("backlash", [0.01, 0.07, 0.123])
def test_a_backlash_that_is_given_as_its_limit_keeps_it(module: float, backlash: float) -> None:
    made = job(
        Constant(), (20, 20), module=module, backlash=backlash, limits={"backlash": backlash}
    )
    assert "no-backlash" not in codes(made)
