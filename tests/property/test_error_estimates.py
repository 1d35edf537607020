"""What a summary says of its own errors is honest: never less than the error, hardly more.

Over designs of every law the true error, against 30 digits, is below the estimate, and the
estimate below a hundred times the true error, unless both are rounding: below 1e-13 of what the
number is made of. That is for lengths the wheel or the centrode, for contact ratios all pitches.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.rolling import roll
from gearcam.laws.ratio import LAWS
from gearcam.laws.ratio.composite import Fourier
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.span import ONE_LOBE
from gearcam.numeric.chebyshev import expand
from helpers_estimates import MODULE, gc, rows_of
from helpers_exact import cases
from helpers_sampling import chosen

CASES = cases()
TIGHT = 100.0
FEW = ("constant-1", "ellipse-7", "log-spiral-4", "multispeed-5", "formula-11", "rack-1")


def demand_honest(name: str) -> None:
    rows = rows_of(CASES[name])
    assert [row for row in rows if not row.honest] == []
    assert [row for row in rows if not row.tight(TIGHT)] == []


@pytest.mark.parametrize("name", chosen(FEW, "constant-1", "log-spiral-4"))
def test_estimates_of_a_few_designs_are_honest(name: str) -> None:
    demand_honest(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(CASES) - set(FEW)))
def test_estimates_of_all_designs_are_honest(name: str) -> None:
    demand_honest(name)


def test_there_are_a_hundred_designs_of_all_laws() -> None:
    assert len(CASES) >= 100
    laws = {entry.name for entry in LAWS.values()}
    assert {type(case.law) for case in CASES.values()} == {
        type(LAWS[name].example) for name in laws
    }
    assert {case.mate for case in CASES.values()} == {1, 0, -1}


def test_an_area_is_off_by_less_than_its_estimate_and_in_proportion() -> None:
    """Against the cubics through dense points, an order better than chords: slope 1 of both."""
    case, told, true = CASES["ellipse-3"], [], []
    spec = gc.PairSpec(teeth=case.teeth, module=MODULE)
    tolerances = (0.005, 0.00125, 0.0003125)  # coarser ones ask for few vertices a flank
    for tolerance in tolerances:
        output = gc.PairOutputSpec(chord_tolerance=tolerance)
        design = gc.GearPairDesign(name="one", law=case.law, pair=spec, output=output)
        result = gc.build(design)
        told.append(result.facts["accuracy.area_mm2"])
        contours = [gear.profile.contour for gear in result.gears]
        true.append(max(abs(one.area - one.moments.area) for one in contours))
    assert all(one <= other <= 4.0 * one for one, other in zip(true, told, strict=True))
    for values in (told, true):
        slope = np.polyfit(np.log(tolerances), np.log(values), 1)[0]
        assert slope == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("name", ["ellipse-7", "rounded-polygon-0"])
def test_no_chord_is_farther_from_the_curve_than_the_summary_says(name: str) -> None:
    """At 63 places in every chord: more than the seven or three at which it was measured."""
    case = CASES[name]
    spec = gc.PairSpec(teeth=case.teeth, module=MODULE)
    result = gc.build(gc.GearPairDesign(name="one", law=case.law, pair=spec))
    told, worst = result.facts["accuracy.chord_mm"], 0.0
    for gear in result.gears:
        places, points, _ = gear.profile.sampler.chords
        shares = np.arange(1, 64)[:, None] / 64.0
        within = places[:-1] + np.diff(places) * shares
        away = gear.profile.sampler.at(within.ravel())[0].reshape(within.shape) - points
        chord = np.diff(np.append(points, points[:1]))
        worst = max(worst, float((np.abs(np.imag(away * np.conj(chord))) / np.abs(chord)).max()))
    assert worst <= told <= 1.04 * worst


def test_what_is_straight_to_rounding_has_no_radius() -> None:
    law = RackLaw(r1="1 + 1e-17*cos(phi1)")
    spec = gc.PairSpec(teeth=(24, 31), module=MODULE)
    wheel, rack = gc.build(gc.GearPairDesign(name="one", law=law, pair=spec)).gears
    assert "centrode.min_convex_radius_mm" not in rack.facts
    assert wheel.facts["centrode.min_convex_radius_mm"] == pytest.approx(24.0, rel=1e-15)


@pytest.mark.parametrize("degree", [2, 4, 6, 8])
def test_the_estimate_of_an_integral_rises_with_the_order_of_its_expansion(degree: int) -> None:
    """Of a driven angle and of an arc length: two orders more than the degree, as the errors do.

    Of degree 8 the orders show only where they are not yet quite themselves: above rounding.
    """
    law = Fourier(cosines=(0.0,) * 19 + (0.3,)).build(ONE_LOBE, DEFAULT)
    rolling = roll(law, teeth=(61, 61), center_distance=1.0, module=None, tolerances=DEFAULT)
    rough = (40, 48, 64) if degree == 8 else (64, 96, 128)
    x = np.linspace(0.0, law.period, 2999)
    told, true = [], []
    for cuts in rough:
        made = expand(law.ratio, law.knots, np.inf, degree=degree, cuts=cuts).antiderivative()
        arc = replace(rolling.arc, unit=made, speed=law.ratio)
        told.append((replace(law, driven=made).error, replace(rolling, arc=arc).arc_error))
        true.append(float(np.abs(made(x) - law.driven(x)).max()))
    for estimate in np.transpose(told):
        assert (np.array(true) <= estimate).all()
        assert (estimate <= 3.0 * np.array(true)).all()
        slope = np.polyfit(np.log(rough), np.log(estimate), 1)[0]
        assert slope == pytest.approx(-(degree + 2), abs=0.25 if degree == 8 else 0.1)


def test_the_estimate_of_a_python_function_knows_its_noise() -> None:
    """Values that are rounded to 12 digits: the driven angle and the flanks are told so."""
    clean, noisy = (
        Formula(ratio=lambda x, digits=digits: np.round(1.0 + 0.3 * np.cos(x), digits)).build(
            CASES["formula-9"].lobes, DEFAULT
        )
        for digits in (16, 13)
    )
    assert 30.0 * clean.function_error < noisy.function_error < 1e-11
    assert noisy.error > noisy.function_error
