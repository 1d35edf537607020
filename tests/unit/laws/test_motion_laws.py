"""Rises against second methods: high precision, other formulas, random parameters."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp
from numpy.typing import NDArray

from claims.shown_rise import ShownRise, shown
from gearcam.laws.motion.base import ClosedForm
from gearcam.laws.motion.formula import FormulaRise
from gearcam.laws.motion.pieces import from_both_ends, lag
from gearcam.laws.motion.points import BSplineRise, TableRise
from gearcam.laws.motion.polynomials import (
    Polynomial,
    Polynomial23,
    Polynomial345,
    Polynomial3456,
    Polynomial4567,
    Polynomial56789,
    of_least_degree,
)
from gearcam.laws.motion.scca import ModifiedSine, ModifiedTrapezoid, Scca
from gearcam.laws.motion.simple import (
    ConstantAcceleration,
    Cycloidal,
    Harmonic,
    SineTrapezoidalVelocity,
    TrapezoidalAcceleration,
    TrapezoidalVelocity,
)
from gearcam.numeric.jets import Jet, polynomial, sin

Array = NDArray[np.float64]
Number = Any
PHI = np.linspace(0.0, 1.0, 1001)


def at(made: ShownRise, phi: float, order: int = 0) -> float:
    return float(made.function.derivatives(phi, order)[order])


# --- digits near the ends -----------------------------------------------------------------------

EXACT: dict[str, tuple[ClosedForm, Callable[[Number], Number]]] = {
    "harmonic": (Harmonic(), lambda x: (1 - mp.cos(mp.pi * x)) / 2),
    "cycloidal": (Cycloidal(), lambda x: x - mp.sin(2 * mp.pi * x) / (2 * mp.pi)),
    "2-3": (Polynomial23(), lambda x: 3 * x**2 - 2 * x**3),
    "3-4-5": (Polynomial345(), lambda x: 10 * x**3 - 15 * x**4 + 6 * x**5),
    "4-5-6-7": (Polynomial4567(), lambda x: 35 * x**4 - 84 * x**5 + 70 * x**6 - 20 * x**7),
    "5-6-7-8-9": (
        Polynomial56789(),
        lambda x: 126 * x**5 - 420 * x**6 + 540 * x**7 - 315 * x**8 + 70 * x**9,
    ),
    "3-4-5-6": (Polynomial3456(), lambda x: x**3 * (2 - x) ** 3),
}


@pytest.mark.parametrize("name", EXACT)
def test_all_digits_are_right_near_both_ends(name: str) -> None:
    parameters, formula = EXACT[name]
    made = shown(parameters)
    places = [1e-9, 1e-6, 1e-3, 0.1, 0.35, 0.65, 0.9, 1 - 2**-10, 1 - 2**-20, 1 - 2**-30]
    with mp.workdps(60):
        for phi in places:
            for order in range(4):
                expected = float(mpmath.diff(formula, mp.mpf(phi), order))
                assert at(made, phi, order) == pytest.approx(expected, rel=2e-14, abs=0.0)


def test_sectors_of_a_millionth_keep_their_digits() -> None:
    q = 1e-6
    made = shown(SineTrapezoidalVelocity(q=q))
    assert at(made, q) == pytest.approx(q / (2 * (1 - q)), rel=1e-14)
    assert made.continuity == 2
    assert made.peak_acceleration == pytest.approx(math.pi / (2 * q * (1 - q)), rel=1e-12)
    made = shown(Scca(b=q, c=1.0 - 2 * q, d=q))
    assert made.continuity == 2
    assert made.peak_velocity == pytest.approx(2.0, rel=1e-12)


def test_what_lags_behind_its_sine_keeps_its_digits() -> None:
    x = np.array([1e-8, 1e-3, 0.7, 1.4999, 1.5001, 3.0, -1e-8, 0.0])
    found = lag(Jet.variable(x, 3)).derivatives()
    with mp.workdps(40):
        for k, place in enumerate(map(mp.mpf, x.tolist())):
            exact = [place - mp.sin(place), 1 - mp.cos(place), mp.sin(place), mp.cos(place)]
            assert [float(v[k]) for v in found] == pytest.approx(
                [float(v) for v in exact], rel=5e-16, abs=0.0
            )


def test_pieces_can_be_put_into_other_functions() -> None:
    """Jets of bent arguments: S(sin(x)) by the piece and by the plain polynomial."""
    powers = [Fraction(v) for v in (0, 0, 0, 10, -15, 6)]
    about_end = of_least_degree([0, 0, 0], [1, 0, 0])[1]
    piece = from_both_ends(powers, about_end, 0.0, 1.0)
    x = Jet.variable(np.linspace(0.05, 1.5, 40), 4)
    plain = polynomial(sin(x), 0.0, *map(float, powers)).derivatives()
    np.testing.assert_allclose(piece(sin(x)).derivatives(), plain, rtol=1e-12, atol=1e-11)
    waved = lag(2.0 * sin(x)).derivatives()
    direct = (2.0 * sin(x) - sin(2.0 * sin(x))).derivatives()
    np.testing.assert_allclose(waved, direct, atol=1e-13)


@pytest.mark.parametrize(
    ("parameters", "degree"),
    [
        (TableRise(x=(0.0, 0.1, 0.3, 0.35, 0.7, 1.0), y=(0.0, 0.05, 0.3, 0.25, 0.9, 1.0)), 5),
        (BSplineRise(control=(0.0, 0.0, 0.2, 0.9, 0.4, 1.0, 1.0), degree=3), 3),
    ],
)
def test_all_pieces_at_once_are_those_one_by_one(
    parameters: TableRise | BSplineRise, degree: int
) -> None:
    made = shown(parameters).function
    order = 6
    for number, piece in enumerate(made.pieces):
        places = np.linspace(made.knots[number], made.knots[number + 1], 11)
        found = made.on_pieces(np.full(11, number), places, order)
        alone = piece(Jet.variable(places, order)).derivatives()
        np.testing.assert_allclose(found, alone, rtol=1e-15, atol=0.0)
        through = np.polynomial.Polynomial.fit(places, found[0], degree)
        scale = np.abs(found[1]).max()
        assert np.abs(through.deriv()(places) - found[1]).max() < 1e-10 * scale


# --- laws by their accelerations, in high precision ---------------------------------------------


def scca_acceleration(b: float, c: float, d: float) -> Callable[[Number], Number]:
    def shape(x: Number) -> Number:
        if x > 0.5:
            return -shape(1 - x)
        if x < b / 2:
            return mp.sin(mp.pi * x / b)
        if x <= (b + c) / 2:
            return mp.mpf(1)
        return mp.cos(mp.pi * (x - (b + c) / 2) / d)

    return shape


def trapezoid(q: float) -> Callable[[Number], Number]:
    def shape(x: Number) -> Number:
        return -shape(1 - x) if x > 0.5 else min(x / q, mp.mpf(1), (0.5 - x) / q)

    return shape


def brakes(q: float, shape: Callable[[Number], Number]) -> Callable[[Number], Number]:
    def whole(x: Number) -> Number:
        if x > 0.5:
            return -whole(1 - x)
        return shape(x) if x < q else mp.mpf(0)

    return whole


ACCELERATIONS: dict[str, tuple[ClosedForm, Callable[[Number], Number], tuple[float, ...]]] = {
    "scca": (Scca(b=0.15, c=0.35, d=0.5), scca_acceleration(0.15, 0.35, 0.5), (0.075, 0.25)),
    "scca late": (Scca(b=0.7, c=0.2, d=0.1), scca_acceleration(0.7, 0.2, 0.1), (0.35, 0.45)),
    "trapezoid": (TrapezoidalAcceleration(q=0.17), trapezoid(0.17), (0.17, 0.33)),
    "velocity": (TrapezoidalVelocity(q=0.3), brakes(0.3, lambda x: 1 + 0 * x), (0.3,)),
    "sine velocity": (
        SineTrapezoidalVelocity(q=0.3),
        brakes(0.3, lambda x: mp.sin(mp.pi * x / 0.3)),
        (0.3,),
    ),
}


@pytest.mark.parametrize("name", ACCELERATIONS)
def test_laws_are_the_integrals_of_their_accelerations(name: str) -> None:
    """``S = integral of (phi - t)*a(t)``, over its value at phi = 1; nothing else is known."""
    parameters, shape, knots = ACCELERATIONS[name]
    made = shown(parameters)
    breaks = [0.0, *knots, 0.5, *(1.0 - k for k in reversed(knots)), 1.0]

    def lift(phi: float, power: int) -> Number:
        grid = [v for v in breaks if v < phi] + [phi]
        return mpmath.quad(lambda t: (phi - t) ** power * shape(t), grid)

    total = lift(1.0, 1)
    for phi in (0.04, 0.2, 0.31, 0.46, 0.5, 0.77, 0.95, 1.0):
        assert at(made, phi) == pytest.approx(float(lift(phi, 1) / total), abs=1e-14)
        assert at(made, phi, 1) == pytest.approx(float(lift(phi, 0) / total), abs=1e-13)
        place = phi - 1e-9
        expected = float(shape(mp.mpf(place)) / total)
        assert at(made, place, 2) == pytest.approx(expected, rel=1e-12, abs=1e-12)


MEMBERS: dict[str, tuple[tuple[float, float, float], ClosedForm]] = {
    "constant acceleration": ((0.0, 1.0, 0.0), ConstantAcceleration()),
    "harmonic": ((0.0, 0.0, 1.0), Harmonic()),
    "modified trapezoid": ((0.25, 0.5, 0.25), ModifiedTrapezoid()),
    "modified sine": ((0.25, 0.0, 0.75), ModifiedSine()),
    "cycloidal": ((0.5, 0.0, 0.5), Cycloidal()),
}


def test_typed_digits_of_the_widths_are_spread() -> None:
    typed = shown(Scca(b=0.25 + 9e-10, c=0.5, d=0.25))
    assert at(typed, 0.5) == pytest.approx(0.5, abs=1e-15)
    assert typed.continuity == 2


def test_sectors_without_a_width_make_no_piece() -> None:
    def count(b: float, c: float, d: float) -> int:
        return len(shown(Scca(b=b, c=c, d=d)).function.pieces)

    assert count(0.2, 0.5, 0.3) == 5
    assert count(0.5, 0.0, 0.5) == 3
    assert count(0.0, 1.0, 0.0) == 2
    assert count(0.0, 0.0, 1.0) == 1
    assert len(shown(TrapezoidalVelocity(q=0.5)).function.pieces) == 2
    assert len(shown(TrapezoidalAcceleration(q=0.25)).function.pieces) == 3


# --- polynomials --------------------------------------------------------------------------------


CONDITIONS = st.lists(st.floats(-50.0, 50.0, allow_subnormal=False), max_size=8)


@settings(max_examples=80, derandomize=True, database=None, deadline=None)
@given(CONDITIONS, CONDITIONS)
def test_polynomials_keep_any_conditions(start: list[float], end: list[float]) -> None:
    made = shown(Polynomial(start=tuple(start), end=tuple(end)))
    for knot, side, asked in ((0, 1, [0.0, *start]), (1, -1, [1.0, *end])):
        found = made.function.side(knot, side, 8)[: len(asked)]
        assert found == pytest.approx(asked, rel=1e-10, abs=1e-13)
    # its highest power is the number of conditions less one: beyond, all differences vanish
    degree = len(start) + len(end) + 1
    if degree <= 7:
        values = made.function.derivatives(np.array([0.1, 0.8]), degree + 1)[degree + 1]
        assert np.abs(values).max() == 0.0
    dense = np.abs(made.function.derivatives(np.linspace(0.0, 1.0, 2001), 1)[1]).max()
    assert made.peak_velocity >= dense * (1.0 - 1e-12)
    middle = made.function.derivatives([0.5 - 1e-9, 0.5 + 1e-9], 2)
    assert middle[0][1] - middle[0][0] == pytest.approx(2e-9 * middle[1][0], abs=1e-10)


@settings(max_examples=60, derandomize=True, database=None, deadline=None)
@given(st.floats(1e-6, 1.0), st.floats(0.0, 1.0), st.sampled_from([0, 1, 2]))
def test_sectors_of_any_width_join(share: float, rest: float, which: int) -> None:
    widths = [share, (1.0 - share) * rest, (1.0 - share) * (1.0 - rest)]
    b, c, d = (0.0 if v < 1e-6 else v for v in widths[which:] + widths[:which])
    total = b + c + d
    made = shown(Scca(b=b / total, c=c / total, d=d / total))
    assert at(made, 0.0) == 0.0
    assert at(made, 1.0) == 1.0
    assert made.continuity == (2 if b > 0.0 and d > 0.0 else 1)
    assert at(made, 0.5) == pytest.approx(0.5, abs=1e-15)
    np.testing.assert_allclose(made.function(PHI) + made.function(1.0 - PHI), 1.0, atol=1e-15)


@settings(max_examples=60, derandomize=True, database=None, deadline=None)
@given(st.floats(1e-6, 1.0))
def test_parts_of_any_width_join(q: float) -> None:
    cases: list[tuple[ClosedForm, int, float]] = [
        (ConstantAcceleration(q=min(q, 1 - 1e-6)), 1, 2.0),
        (TrapezoidalVelocity(q=0.5 * q), 1, 1.0 / (1.0 - 0.5 * q)),
        (SineTrapezoidalVelocity(q=0.5 * q), 2, 1.0 / (1.0 - 0.5 * q)),
        (TrapezoidalAcceleration(q=0.25 * max(q, 4e-6)), 2, 2.0),
    ]
    for parameters, continuity, velocity in cases:
        made = shown(parameters)
        assert at(made, 0.0) == 0.0
        assert at(made, 1.0) == 1.0
        assert made.continuity == continuity
        assert made.peak_velocity == pytest.approx(velocity, rel=1e-9)


# --- points and formulas ------------------------------------------------------------------------


def basis(knots: list[float], degree: int, index: int, x: float) -> float:
    """A B-spline by the recursion of Cox and de Boor."""
    if degree == 0:
        return 1.0 if knots[index] <= x < knots[index + 1] else 0.0
    result = 0.0
    for k, side in ((index, 0), (index + 1, 1)):
        width = knots[k + degree] - knots[k]
        if width > 0.0:
            part = (x - knots[k]) / width
            result += (1.0 - part if side else part) * basis(knots, degree - 1, k, x)
    return result


@pytest.mark.parametrize("degree", [3, 4, 5])
def test_b_splines_are_sums_of_their_basis(degree: int) -> None:
    control = (0.0, 0.0, 0.1, 0.7, -0.2, 0.4, 1.3, 1.0, 1.0)
    made = shown(BSplineRise(control=control, degree=degree))
    spans = len(control) - degree
    knots = [0.0] * degree + [k / spans for k in range(spans + 1)] + [1.0] * degree
    for phi in (0.0, 0.11, 0.3, 0.52, 0.77, 0.999):
        expected = sum(v * basis(knots, degree, k, phi) for k, v in enumerate(control))
        assert at(made, phi) == pytest.approx(expected, abs=1e-15)
    assert set(made.function.continuity[:-1]) == {min(3, degree - 1)}


def test_a_table_is_the_spline_of_least_jerk() -> None:
    """Three points: 3-4-5 and a tenth of the even quintic bump that is 1 at the middle."""
    made = shown(TableRise(x=(0.0, 0.5, 1.0), y=(0.0, 0.6, 1.0)))
    for phi in (0.1, 0.25, 0.4, 0.6, 0.9):
        u = 2.0 * min(phi, 1.0 - phi)
        bump = u**3 * (20.0 - 25.0 * u + 8.0 * u * u) / 3.0
        smooth = phi**3 * (10.0 - 15.0 * phi + 6.0 * phi * phi)
        assert at(made, phi) == pytest.approx(smooth + 0.1 * bump, abs=1e-15)


def test_a_table_passes_its_points_with_four_derivatives_and_the_ends_given() -> None:
    x = (0.0, 0.03, 0.2, 0.25, 0.6, 0.61, 1.0)
    y = (0.0, 0.1, -0.2, 0.5, 1.4, 1.3, 1.0)
    made = shown(TableRise(x=x, y=y, start=(0.5, -3.0), end=(2.0, 7.0)))
    np.testing.assert_allclose(made.function(x), y, atol=1e-14)
    assert made.start[:2] == pytest.approx((0.5, -3.0), rel=1e-13)
    assert made.end[:2] == pytest.approx((2.0, 7.0), rel=1e-13)
    scale = np.abs(made.function.derivatives(PHI, 4)).max(axis=1)
    for knot in range(1, len(x) - 1):
        sides = [np.array(made.function.side(knot, side, 4)) for side in (-1, 1)]
        assert (np.abs(sides[1] - sides[0]) <= 1e-11 * scale).all()


def test_a_table_in_a_file_is_the_same(tmp_path: Any) -> None:
    file = tmp_path / "rise.csv"
    file.write_text("# measured\nplace, y, x\n1, 0, 0\n\n2, 0.2, 0.4\n3, 0.9, 0.7\n4, 1, 1\n")
    inline = shown(TableRise(x=(0.0, 0.4, 0.7, 1.0), y=(0.0, 0.2, 0.9, 1.0)))
    read = shown(TableRise(file=str(file)))
    np.testing.assert_array_equal(read.function(PHI), inline.function(PHI))


def test_a_formula_with_typed_digits_meets_the_corners() -> None:
    made = shown(FormulaRise(formula="0.5*(1 - cos(3.141592653*x)) + 1e-12"))
    assert at(made, 0.0) == 0.0
    assert at(made, 1.0) == 1.0
    assert at(made, 0.5, 1) == pytest.approx(math.pi / 2, abs=1e-8)


def test_peaks_between_coarse_samples_are_found() -> None:
    steep = shown(FormulaRise(formula="(1 + tanh(2000*(x - 0.3137)))/2"))
    assert steep.peak_velocity == pytest.approx(1000.0, rel=1e-12)
    assert steep.peak_acceleration == pytest.approx(8e6 / (3 * math.sqrt(3)), rel=1e-12)
    assert steep.peak_jerk == pytest.approx(8e9, rel=1e-12)


@pytest.mark.parametrize("formula", ["x", "sqrt(1 + x)**2 - 1", "x + 0*sin(9*x)"])
def test_a_line_in_disguise_is_smooth(formula: str) -> None:
    made = shown(FormulaRise(formula=formula))
    assert made.continuity == 0
    assert made.peak_velocity == pytest.approx(1.0, abs=1e-14)
