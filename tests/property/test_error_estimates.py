"""What a summary says of its own errors is honest: never less than the error, hardly more.

Over designs of every law the true error, against 30 digits, is below the estimate, and the
estimate below a hundred times the true error, unless both are rounding: below 1e-13 of what the
number is made of. That is for lengths the wheel or the centrode, for contact ratios all pitches.
"""

from __future__ import annotations

from dataclasses import replace

import mpmath
import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT, Tolerances
from gearcam.gears.estimates import area_error, ratio_error
from gearcam.gears.rolling import curvature_errors, roll
from gearcam.laws.ratio.base import LAWS
from gearcam.laws.ratio.composite import Fourier
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.shapes import RoundedPolygon
from gearcam.laws.ratio.span import ONE_LOBE
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import expand
from helpers_estimates import MODULE, gc, rows_of
from helpers_exact import cases

CASES = cases()
TIGHT = 100.0
FEW = ("constant-1", "ellipse-7", "log-spiral-4", "multispeed-5", "formula-11", "rack-1")


WIDE = {
    ("formula-11", "tip_thickness_mm"): 400.0,
    ("formula-13", "convex_radius_mm"): 600.0,
    ("formula-13", "concave_curvature_per_mm"): 600.0,
}
"""Rows that are wider: the derivatives of a Python function are known by a bound, which is that
of its noisiest place, and the thinnest tooth or the sharpest bend stands elsewhere."""


def demand_honest(name: str) -> None:
    rows = rows_of(CASES[name])
    assert [row for row in rows if not row.honest] == []
    wide = {(name, row.name): row for row in rows if not row.tight(TIGHT)}
    assert set(wide) == {known for known in WIDE if known[0] == name}
    assert [row for known, row in wide.items() if not row.tight(WIDE[known])] == []


@pytest.mark.parametrize("name", FEW)
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


@pytest.mark.parametrize(("height", "sharp"), [(3, 100), (3, 200)])
def test_a_ratio_is_off_by_more_where_the_radius_nears_the_distance(
    height: int, sharp: int
) -> None:
    """Against the distance that closes the law with 30 digits: even sums of a periodic wave."""
    made = Formula(r1=f"1 + {height}*exp(-{sharp}*sin(phi1/2)**2)").build(ONE_LOBE, DEFAULT)
    rolling = roll(made, teeth=(61, 61), center_distance=1.0, module=None, tolerances=DEFAULT)
    with mpmath.workdps(30):
        halves = (mpmath.pi * k / 2000 for k in range(2000))
        radii = [1 + height * mpmath.exp(-sharp * mpmath.sin(half) ** 2) for half in halves]
        distance = mpmath.mpf(made.solved["center_distance_over_scale"])
        for _ in range(4):
            ratios = [r / (distance - r) for r in radii]
            slope = sum(i / (distance - r) for i, r in zip(ratios, radii, strict=True))
            distance += (sum(ratios) - len(ratios)) / slope
        off = float(abs(made.ratio_range[1][1] - radii[0] / (distance - radii[0])))
    assert off < ratio_error(rolling) < TIGHT * off


def test_an_area_is_off_by_less_than_its_estimate_and_in_proportion() -> None:
    """Against the cubics through dense points, an order better than chords: slope 1 of both."""
    case, told, true = CASES["ellipse-3"], [], []
    spec = gc.PairSpec(teeth=case.teeth, module=MODULE)
    tolerances = (0.005, 0.00125, 0.0003125)  # coarser ones ask for few vertices a flank
    for tolerance in tolerances:
        output = gc.PairOutputSpec(chord_tolerance=tolerance)
        design = gc.GearPairDesign(name="one", law=case.law, pair=spec, output=output)
        gears = gc.build(design).gears
        told.append(max(area_error(gear) for gear in gears))
        contours = [gear.profile.contour for gear in gears]
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


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("name", ["fourier-0", "ellipse-4", "log-spiral-2", "fourier-3", "rack-1"])
def test_what_a_ratio_is_off_by_goes_into_curvatures_as_it_must(name: str, order: int) -> None:
    """Against differences of how fast the directions of the centrodes turn."""
    case, small = CASES[name], 1e-6
    law = case.law.build(case.lobes, DEFAULT)
    off = tuple(small * (k == order + 1) for k in range(4))
    exact, inexact = (
        roll(one, teeth=case.teeth, center_distance=1.0, module=None, tolerances=DEFAULT)
        for one in (law, replace(law, function_errors=off))
    )

    def bends(phi: Array, moved: Array) -> Array:
        i, di, ddi = (
            values + moved * (k == order) for k, values in enumerate(law.ratio.derivatives(phi, 2))
        )
        u = 1.0 / (1.0 + case.mate * i)
        q = u * u * di + 1j * u * i
        turn = ((u * u * (ddi - 2.0 * case.mate * u * di * di) + 1j * u * u * di) / q).imag
        return np.array([1.0 + turn, case.mate * i - turn]) / np.abs(q)

    for one, other in zip(exact.tracks, inexact.tracks, strict=True):
        phi, _ = one.curvature_extremes
        step = 1e-6 * law.ratio(phi)
        change = np.abs(bends(phi, step) - bends(phi, -step))[one.wheel - 1] / (2.0 * step)
        told = (curvature_errors(other) - curvature_errors(one)) / small
        np.testing.assert_allclose(told, change, rtol=1e-6, atol=1e-7 * change.max())


def test_the_error_of_the_size_is_one_of_radii() -> None:
    """Of arc lengths of a few digits, which the module asks for a centre distance by."""
    law = CASES["ellipse-7"].law.build(ONE_LOBE, DEFAULT)
    fine, rough = (
        roll(law, teeth=(61, 61), center_distance=None, module=MODULE, tolerances=tolerances)
        for tolerances in (DEFAULT, Tolerances(expansion=1e-5))
    )
    for one, other in zip(fine.tracks, rough.tracks, strict=True):
        off, told = abs(one.convex.radius - other.convex.radius), other.bends.radius_error
        assert 1e-10 < off <= told <= 100.0 * off


def test_the_miss_of_a_solved_law_is_one_of_curvatures() -> None:
    """As of a ratio that is off everywhere by the same share."""
    law, miss = CASES["formula-8"].law.build(ONE_LOBE, DEFAULT), 1e-6
    missed = replace(law, driven=law.driven.shifted(miss))
    rolling = roll(missed, teeth=(61, 61), center_distance=1.0, module=None, tolerances=DEFAULT)
    for number, track in enumerate(rolling.tracks):
        phi, kappa = track.curvature_extremes
        ratios = np.array(law.ratio.derivatives(phi, 2)) * (1.0 + miss / law.advance)
        off = np.abs(rolling.curvatures_of(ratios)[number] - kappa).max()
        assert off <= curvature_errors(track).max() <= 3.0 * off


def test_what_is_straight_to_rounding_has_no_radius() -> None:
    law = RackLaw(r1="1 + 1e-17*cos(phi1)")
    spec = gc.PairSpec(teeth=(24, 31), module=MODULE)
    wheel, rack = gc.build(gc.GearPairDesign(name="one", law=law, pair=spec)).gears
    assert "centrode.min_convex_radius_mm" not in rack.facts
    assert wheel.facts["centrode.min_convex_radius_mm"] == pytest.approx(24.0, rel=1e-15)


def test_no_root_is_nearer_to_its_shaft_than_the_summary_says() -> None:
    """Of a straight land chords are no nearer than the curve, but far nearer than their ends."""
    law = RoundedPolygon(corners=4, corner_radius=1 / 6)
    spec = gc.PairSpec(teeth=(48, 48), module=MODULE)
    output = gc.PairOutputSpec(chord_tolerance=1e-4)
    rack = gc.Rack(tip_radius=0.1)
    result = gc.build(gc.GearPairDesign(name="one", law=law, pair=spec, rack=rack, output=output))
    off = []
    for gear in result.gears:
        places = gear.profile.sampler.chords[0]
        within = places[:-1] + np.diff(places) * np.arange(64)[:, None] / 64.0
        distances = np.abs(gear.profile.sampler.at(within.ravel())[0])
        off.append(gear.least_radius - float(distances.min()))
    assert max(off) <= result.facts["accuracy.root_radius_mm"] <= 1.1 * max(off)


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
        told.append((replace(law, driven=made).integral_error, replace(rolling, arc=arc).arc_error))
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
