"""Jets, expansions, piecewise functions and root searches against independent mathematics."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from gearcam.numeric import jets
from gearcam.numeric.chebyshev import NotSmoothError, expand, missed
from gearcam.numeric.jets import FUNCTIONS, Jet, Value
from gearcam.numeric.piecewise import Piece, extremes, extremes_among, integrate, piecewise
from gearcam.numeric.roots import bracketed_root, damped_newton, newton_in_bracket

POINTS = np.array([0.21, 0.47, 0.83])


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_jets_of_every_function_are_the_taylor_series_of_mpmath(name: str) -> None:
    def inner(x):  # type: ignore[no-untyped-def]
        return 0.4 + 0.3 * x * x

    jet = FUNCTIONS[name](inner(Jet.variable(POINTS, 4)))
    reference = getattr(mpmath, {"asin": "asin", "acos": "acos", "atan": "atan"}.get(name, name))
    for k, x in enumerate(POINTS):
        series = mpmath.taylor(lambda t: reference(inner(t)), x, 4)
        for order, value in enumerate(series):
            assert float(jet.derivatives()[order][k]) == pytest.approx(
                float(value) * math.factorial(order), rel=1e-9, abs=1e-9
            )


@pytest.mark.parametrize(
    ("build", "reference"),
    [
        (lambda x: x**3, lambda t: t**3),
        (lambda x: x**-2, lambda t: t**-2),
        (lambda x: x**2.5, lambda t: t**2.5),
        (lambda x: 2.0**x, lambda t: mpmath.mpf(2) ** t),
        (lambda x: x**x, lambda t: t**t),
        (lambda x: (1 - 2 * x) / (x + 1) - 3 / x, lambda t: (1 - 2 * t) / (t + 1) - 3 / t),
        (lambda x: -(+x) * x + 1, lambda t: -t * t + 1),
    ],
)
def test_jet_arithmetic_is_that_of_power_series(build, reference) -> None:  # type: ignore[no-untyped-def]
    jet = build(Jet.variable(POINTS, 3))
    for k, x in enumerate(POINTS):
        for order, value in enumerate(mpmath.taylor(reference, x, 3)):
            expected = float(value) * math.factorial(order)
            assert float(jet.derivatives()[order][k]) == pytest.approx(
                expected, rel=1e-10, abs=1e-10
            )


def test_a_square_has_derivatives_at_zero() -> None:
    values = (Jet.variable([0.0], 3) ** 2.0).derivatives()
    assert [float(v[0]) for v in values] == [0.0, 0.0, 2.0, 0.0]


@pytest.mark.parametrize("eccentricity", [0.1, 0.9, 0.999])
def test_an_expansion_reaches_rounding_however_sharp_the_function(eccentricity: float) -> None:
    e = eccentricity

    def speed(x: np.ndarray) -> np.ndarray:
        return np.sqrt(1.0 - e * e * np.sin(x) ** 2)

    total = expand(speed, [0.0, math.pi], 1e-15).antiderivative()
    assert total.last == pytest.approx(float(2 * mpmath.ellipe(e * e)), rel=4e-15)
    middle = float(total(0.5 * math.pi))
    assert middle == pytest.approx(float(mpmath.ellipe(e * e)), rel=4e-15)


def test_what_an_integral_misses_is_measured() -> None:
    """Between knots too, where an expansion is off most, and whatever the constant is."""

    def wave(x: np.ndarray) -> np.ndarray:
        return np.cos(40.0 * x)

    made = expand(wave, [0.0, 6.0], np.inf, degree=4, cuts=64).antiderivative()
    x = np.linspace(0.0, 6.0, 4999)
    true = np.abs(made(x) - np.sin(40.0 * x) / 40.0).max()
    for integral in (made, made.shifted(3.0)):
        assert true <= 1.5 * missed(integral, wave, made.knots) <= 1.55 * true
    knots = np.linspace(0.0, 6.0, 257)
    assert missed(lambda x: np.sin(40.0 * x) / 40.0, wave, knots) < 1e-16


@pytest.mark.parametrize("sharp", [20.0, 400.0])
def test_extremes_are_found_where_a_slope_is_rounded_to_zero(sharp: float) -> None:
    """On plateaus no slope changes its sign: tanh is 1 in all its digits there."""

    def step(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        wave = np.tanh(sharp * np.sin(x))
        return wave, sharp * np.cos(x) * (1.0 - wave * wave)

    _, values = extremes(step, [0.0, 2.0 * math.pi])
    assert values.min() == -1.0
    assert values.max() == 1.0


@pytest.mark.parametrize("mirrored", [False, True])
def test_extremes_are_found_beside_a_knot_where_the_slope_is_zero(mirrored: bool) -> None:
    """The first cell of a lift: up from rest and down again, steeply, before the next place."""
    fast, sign = 500.0, -1.0 if mirrored else 1.0

    def peak(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        t = 1.0 - x if mirrored else x
        fall = np.exp(-fast * t)
        return 3.0 - t * t * fall, sign * (fast * t * t - 2.0 * t) * fall

    x = np.linspace(0.0, 1.0, 33)[None]
    places, values = extremes_among(peak, x, *(found.reshape(x.shape) for found in peak(x)))
    assert abs(places[values.argmin()] - mirrored) == pytest.approx(2.0 / fast, abs=1e-8)
    assert values.min() == pytest.approx(3.0 - (2.0 / fast / math.e) ** 2, rel=1e-14)


def test_knots_that_are_neighbours_in_rounding_have_nothing_between_them() -> None:
    """And what lies between others is found as well as without them."""

    def noisy(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        odd = np.arange(x.size) % 2
        near = np.abs(x - 1.0) < 1e-12
        return np.where(near, odd, np.sin(x)), np.where(near, -odd, np.cos(x))

    places, values = extremes(noisy, [0.0, np.nextafter(1.0, 0.0), 1.0, 3.0])
    wide = places > 1.1
    top = int(values[wide].argmax())
    assert places[wide][top] == pytest.approx(math.pi / 2, abs=1e-8)
    assert values[wide][top] == pytest.approx(1.0, abs=1e-15)


def test_extremes_at_knots_are_those_at_the_knots_themselves() -> None:
    places, values = extremes(lambda x: (np.exp(x), np.exp(x)), [0.0, 20.0])
    assert places.shape == (2,)
    np.testing.assert_allclose(values, np.exp([0.0, 20.0]), rtol=1e-14, atol=0)


@pytest.mark.parametrize("place", [0.3, math.pi / 3])
def test_a_hidden_corner_is_found_where_it_is(place: float) -> None:
    with pytest.raises(NotSmoothError) as caught:
        expand(lambda x: np.abs(x - place) + np.cos(x), [0.0, 2.0], 1e-15)
    assert caught.value.place == pytest.approx(place, abs=1e-4)
    assert caught.value.finite


def test_a_pole_is_found_where_it_is() -> None:
    with pytest.raises(NotSmoothError) as caught:
        expand(lambda x: np.where(x > 1.3, np.nan, x), [0.0, 2.0], 1e-15)
    assert not caught.value.finite
    assert caught.value.place > 1.3


def test_a_corner_at_a_break_is_allowed() -> None:
    made = expand(lambda x: np.abs(x - 0.3), [0.0, 0.3, 1.0], 1e-15)
    assert 0.3 in made.knots
    assert made.antiderivative().last == pytest.approx(0.5 * (0.3**2 + 0.7**2), rel=1e-15)


def test_continuity_tells_the_first_derivative_that_jumps() -> None:
    def ramp(x: Jet) -> Jet:
        return 1.0 * x

    for power, order in ((0.0, -1), (1.0, 0), (2.0, 1), (3.0, 2)):

        def bent(x: Jet, power: float = power) -> Jet:
            return ramp(x) + (x - 1.0) ** power

        joined = piecewise([0.0, 1.0, 2.0], [Piece(ramp), Piece(bent)])
        assert joined.continuity[0] == order


def test_an_integral_without_closed_form_agrees_with_one_that_has() -> None:
    closed = Piece(jets.cos, jets.sin)
    numeric = Piece(jets.cos)
    grid = [0.0, 1.0, 4.0]
    a = integrate(grid, [closed, closed], 1e-15)
    b = integrate(grid, [closed, numeric], 1e-15)
    x = np.linspace(0.0, 4.0, 31)
    np.testing.assert_allclose(a(x), np.sin(x), atol=1e-15)
    np.testing.assert_allclose(b(x), np.sin(x), atol=1e-14)


def test_pieces_of_one_function_are_computed_at_once_each_with_its_parameters() -> None:
    """Waves and cubics by turns, in closed form; one call a function however many pieces."""
    calls = []

    def wave(x: Jet, low: Value, height: Value) -> Jet:
        calls.append("wave")
        return height * jets.sin(x - low)

    def area(x: Jet, low: Value, height: Value) -> Jet:
        return -height * jets.cos(x - low)

    count = 40
    knots = 0.25 * np.arange(count + 1)
    given = np.random.default_rng(5).uniform(0.5, 2.0, (count, 4))
    pieces = [
        Piece(jets.polynomial, jets.primitive, (float(low), *map(float, row)))
        if k % 2
        else Piece(wave, area, (float(low), float(row[0])))
        for k, (low, row) in enumerate(zip(knots, given, strict=False))
    ]
    joined, total = piecewise(knots, pieces), integrate(knots, pieces, 1e-15)
    x = np.concatenate([low + np.array([0.0, 0.07, 0.19]) for low in knots[:-1]])
    found, areas, before = joined.derivatives(x, 3), total(x), 0.0
    assert calls.count("wave") == 1
    for k, (low, row) in enumerate(zip(knots[:-1], given, strict=True)):
        here, t = slice(3 * k, 3 * k + 3), x[3 * k : 3 * k + 3] - low
        cubic, height = np.polynomial.Polynomial(row), row[0]
        turns = t + 0.5 * np.pi * np.arange(4)[:, None]
        exact = [cubic.deriv(j)(t) for j in range(4)] if k % 2 else height * np.sin(turns)
        np.testing.assert_allclose([f[here] for f in found], exact, rtol=1e-13, atol=1e-13)
        own = cubic.integ()(t) if k % 2 else height * (1.0 - np.cos(t))
        np.testing.assert_allclose(areas[here], before + own, rtol=1e-13, atol=1e-14)
        before += float(cubic.integ()(0.25)) if k % 2 else height * (1.0 - math.cos(0.25))
    assert joined.side(3, -1, 1) == pytest.approx(
        [given[2, 0] * math.sin(0.25), given[2, 0] * math.cos(0.25)], rel=1e-14
    )


@pytest.mark.parametrize("order", [0, 1, 5])
def test_polynomials_of_bent_jets_are_those_of_the_composed_polynomial(order: int) -> None:
    powers = [0.3, -1.0, 0.5, 2.0]
    kinds = (
        (jets.polynomial, powers),
        (jets.slope, [k * c for k, c in enumerate(powers)][1:]),
        (jets.primitive, [0.0, *(c / (k + 1) for k, c in enumerate(powers))]),
    )
    for function, own in kinds:
        for scale, bend in ((1.0, 0.0), (2.0, 0.0), (1.5, 0.4)):
            x = Jet.variable(POINTS, order)
            found = function(scale * x + bend * x * x, 0.2, *powers).derivatives()
            for k, place in enumerate(POINTS):
                plain = np.polynomial.Polynomial(own)
                inner = np.polynomial.Polynomial([-0.2, scale, bend])
                series = [plain(inner).deriv(j)(place) for j in range(order + 1)]
                assert [float(v[k]) for v in found] == pytest.approx(series, rel=1e-11, abs=1e-11)


def test_extremes_are_roots_of_the_slope_and_sides_of_knots() -> None:
    def saw(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        up = x < 1.0
        return np.where(up, x * x, 5.0 - x), np.where(up, 2.0 * x, -1.0)

    knots = [-1.0, 1.0, 3.0]
    _, values = extremes(saw, knots)
    _, negative = extremes(lambda x: [-v for v in saw(x)], knots)
    np.testing.assert_allclose(negative, -values, atol=1e-15)
    assert values.min() == pytest.approx(0.0, abs=1e-15)
    assert values.max() == pytest.approx(4.0, abs=1e-11)
    assert any(abs(v - 1.0) < 1e-11 for v in values)


def test_newton_in_a_bracket_survives_a_start_where_newton_alone_leaves() -> None:
    target = np.array([0.2, 0.99, 1.0 - 1e-9])

    def steep(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.arctan(200 * (x - target)), 200 / (1 + (200 * (x - target)) ** 2)

    found = newton_in_bracket(steep, np.zeros(3), np.ones(3), np.full(3, 0.5), 1e-15)
    np.testing.assert_allclose(found, target, atol=1e-14)


def test_newton_in_a_bracket_leaves_a_cycle() -> None:
    """Of a root of the distance Newton's steps lead as far to the other side, for ever."""
    target = np.array([0.1, -0.2, 0.0])

    def bent(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        off = x - target
        return np.sign(off) * np.sqrt(np.abs(off)), 0.5 / np.sqrt(np.maximum(np.abs(off), 1e-30))

    found = newton_in_bracket(bent, np.full(3, -1.0), np.ones(3), np.full(3, 0.3), 1e-12)
    np.testing.assert_allclose(found, target, atol=1e-11)


def test_newton_in_a_bracket_does_not_creep() -> None:
    """Down an exponential each step is as short as the last: two hundred would be needed."""
    target = np.array([0.1, -0.2, 0.0])

    def steep(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        value = np.exp(200.0 * (x - target))
        return value - 1.0, 200.0 * value

    found = newton_in_bracket(steep, np.full(3, -1.0), np.ones(3), np.ones(3), 1e-14)
    np.testing.assert_allclose(found, target, atol=1e-14)


def test_damped_steps_that_go_to_and_fro_end() -> None:
    """Newton's steps for a root of the distance lead as far to the other side."""
    target = np.array([[0.01], [-0.02], [0.0]])

    def bent(x: np.ndarray, _: np.ndarray) -> tuple[None, np.ndarray, np.ndarray]:
        off = x - target
        slopes = np.eye(3)[..., None] * (0.5 / np.sqrt(np.maximum(np.abs(off), 1e-30)))
        return None, np.sign(off) * np.sqrt(np.abs(off)), slopes

    found, _ = damped_newton(bent, np.full((3, 1), 0.3), np.ones(1), 1e-12)
    np.testing.assert_allclose(found, target, atol=1e-12)


def test_a_root_at_a_jump_is_found() -> None:
    found = bracketed_root(lambda x: np.where(x < 0.3, -1.0, 2.0), [0.0], [1.0], 1e-13)
    assert found[0] == pytest.approx(0.3, abs=1e-12)


def test_bracketed_roots_reach_rounding_in_few_steps() -> None:
    calls = 0

    def cubic(x: np.ndarray) -> np.ndarray:
        nonlocal calls
        calls += 1
        return np.cos(x) - x**3

    found = bracketed_root(cubic, [0.0], [1.0], 1e-15)
    assert found[0] == pytest.approx(float(mpmath.findroot(lambda t: mpmath.cos(t) - t**3, 0.8)))
    assert calls < 16


def test_sine_and_cosine_together_are_those_alone() -> None:
    x = Jet([np.linspace(-2.0, 2.0, 5), 0.7, np.linspace(0.1, 0.3, 5), -0.2])
    for both, alone in zip(jets.sin_cos(x), (jets.sin(x), jets.cos(x)), strict=True):
        for found, given in zip(both.derivatives(), alone.derivatives(), strict=True):
            assert found == pytest.approx(given, rel=1e-15)


def test_the_derivative_of_a_jet_and_the_jet_without_its_last() -> None:
    """Of ``x**4`` at 2: 32, 48, 48 after the value 16."""
    power = Jet.variable(np.array([2.0]), 3) ** 4
    assert [float(value[0]) for value in power.differentiated().derivatives()] == [32.0, 48.0, 48.0]
    assert [float(value[0]) for value in power.shortened().derivatives()] == [16.0, 32.0, 48.0]
