"""Python functions become functions of jets as exact as they can be, or are refused with words."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.entry import Axis, Functions
from gearcam.laws.functions import Expanded, expanded
from gearcam.numeric.jets import Jet

TURN = 2.0 * math.pi
CORNER = 2.0
mp: Any = mpmath.mp
rng = np.random.default_rng(7)


def made(given: Functions, low: float = 0.0, high: float = TURN) -> Expanded:
    axis = Axis(name="phi2", low=low, high=high, place=lambda x: f"at {x!r}", remedy="take a table")
    return expanded(given, axis, DEFAULT.expansion)


Case = tuple[Functions, Callable[[Any], Any], tuple[float, float], tuple[float, ...]]

EXACT: dict[str, Case] = {
    "few harmonics": (
        lambda x: x - 0.6 * np.sin(x),
        lambda x: x - 0.6 * mp.sin(x),
        (0.0, TURN),
        (1e-15, 1e-15, 1e-15),
    ),
    "many harmonics": (
        lambda x: 1 / (1 + 0.7 * np.cos(x)),
        lambda x: 1 / (1 + mp.mpf(0.7) * mp.cos(x)),
        (0.0, TURN),
        (1e-13, 1e-12, 2e-11),
    ),
    "a peak": (
        lambda x: 1 / (1 + 0.95 * np.cos(x)),
        lambda x: 1 / (1 + mp.mpf(0.95) * mp.cos(x)),
        (0.0, TURN),
        (5e-12, 2e-10, 1e-8),
    ),
    "value by value": (
        lambda x: math.exp(math.sin(x)),
        lambda x: mp.exp(mp.sin(x)),
        (0.0, TURN),
        (5e-14, 3e-13, 5e-12),
    ),
    "with a branch": (
        lambda x: math.sin(x) if x > 1 else math.cos(math.pi / 2 - x),
        mp.sin,
        (0.0, TURN),
        (1e-15, 2e-15, 2e-15),
    ),
    "a polynomial": (
        lambda x: x**3 * (10 - 15 * x + 6 * x * x),
        lambda x: x**3 * (10 - 15 * x + 6 * x * x),
        (0.0, 1.0),
        (1e-14, 1e-13, 1e-13),
    ),
    "an open one": (np.exp, mp.exp, (-1.0, 2.0), (5e-13, 5e-11, 3e-9)),
    "a constant": (lambda _: 3, lambda x: mp.mpf(3) + 0 * x, (0.0, TURN), (0.0, 0.0, 0.0)),
    "a steep middle": (
        lambda x: np.tanh(40 * (x - 0.5)),
        lambda x: mp.tanh(40 * (x - mp.mpf(0.5))),
        (0.0, 1.0),
        (1e-12, 1e-10, 1e-8),
    ),
    "a bump of a fifth of a degree": (
        lambda x: 1 + 0.1 * np.exp(-(((x - 1.2345) / 0.002) ** 2)),
        lambda x: 1 + mp.mpf(0.1) * mp.exp(-(((x - mp.mpf(1.2345)) / mp.mpf(0.002)) ** 2)),
        (0.0, TURN),
        (1e-11, 2e-9, 2e-7),
    ),
    "steep, with derivatives": (
        (
            lambda x: np.tanh(40 * (x - 0.5)),
            lambda x: 40 / np.cosh(40 * (x - 0.5)) ** 2,
            lambda x: -3200 * np.tanh(40 * (x - 0.5)) / np.cosh(40 * (x - 0.5)) ** 2,
        ),
        lambda x: mp.tanh(40 * (x - mp.mpf(0.5))),
        (0.0, 1.0),
        (5e-15, 5e-14, 1e-12),
    ),
}
"""Function, the same for mpmath, interval, errors of three derivatives in the largest of each."""


@pytest.mark.parametrize("name", EXACT)
def test_values_and_derivatives_are_those_of_high_precision(name: str) -> None:
    given, exact, (low, high), allowed = EXACT[name]
    function = made(given, low, high)
    near = 1.2345 if "bump" in name else 0.5 * (low + high)
    beside = near + 0.004 * np.linspace(-1.0, 1.0, 9)
    places = np.concatenate([rng.uniform(low, high, 20), [low, high], beside])
    found = function(Jet.variable(places, 4)).derivatives()
    with mp.workdps(40):
        rows = [[float(c) for c in mp.taylor(exact, mp.mpf(x), 3)] for x in places]
    expected = np.array(rows).T * [[1.0], [1.0], [2.0], [6.0]]
    off = [float(np.abs(a - b).max()) for a, b in zip(found, expected, strict=False)]
    sizes = np.abs(expected).max(axis=1)
    assert off[0] <= function.errors[0] + np.spacing(sizes[0])
    assert function.errors[0] < 2e-14 * sizes[0]
    for order, share in enumerate(allowed, start=1):
        assert off[order] <= share * sizes[order]


def test_jets_of_jets_are_composed() -> None:
    """sin(x*x) from sin as a function of a jet, against the closed form of the derivatives."""
    sine = made(np.sin, 0.0, 4.0)
    x = np.linspace(0.1, 1.9, 11)
    inner = Jet.variable(x, 3) * Jet.variable(x, 3)
    found = sine(inner).derivatives()
    s, c = np.sin(x * x), np.cos(x * x)
    exact = (s, 2 * x * c, 2 * c - 4 * x**2 * s, -12 * x * s - 8 * x**3 * c)
    for one, two in zip(found, exact, strict=True):
        np.testing.assert_allclose(one, two, atol=1e-8)


def test_a_function_is_called_with_arrays_and_never_again() -> None:
    calls: list[int] = []

    def counted(x: np.ndarray) -> np.ndarray:
        calls.append(x.size)
        x -= 0.5 * np.sin(x)  # its own copy
        return x

    function = made(counted)
    (found,) = function(Jet.variable(np.ones(1), 0)).derivatives()[0]
    assert found == pytest.approx(1.0 - 0.5 * math.sin(1.0), abs=1e-14)
    assert len(calls) <= 5
    assert sum(calls) < 4000
    before = len(calls)
    function(Jet.variable(np.linspace(0.0, TURN, 1000), 4))
    assert len(calls) == before


def failing(x: float) -> float:
    if x > 3.0:
        raise LookupError("no such angle")
    return math.sin(x)


OF_TWO: Any = lambda x, y: x + y  # noqa: E731


def corner(order: int) -> Functions:
    return lambda x: 2.0 + np.where(x > CORNER, (x - CORNER) ** order, 0.0)


REFUSED: dict[str, tuple[Functions, str, float, float]] = {
    "a step": (corner(0), "is not smooth", CORNER, 1e-4),
    "a corner": (corner(1), "is not smooth", CORNER, 1e-4),
    "a jump of the second derivative": (corner(2), "is not smooth", CORNER, 1e-3),
    "a jump of the third": (corner(3), "is not smooth", CORNER, 0.01),
    "a jump of the fourth": (corner(4), "is not smooth", CORNER, 0.1),
    "a jump of the fifth": (corner(5), "is not smooth", CORNER, 0.2),
    "a corner on a joint": (lambda x: abs(x - math.pi) ** 3, "is not smooth", math.pi, 1e-9),
    "a root": (np.sqrt, "is not smooth", 0.0, 1e-4),
    "not finite": (lambda x: 1 / (x - math.pi), "is not finite", math.pi, 1e-9),
    "not a number": (lambda x: np.log(x - 1.0), "is not finite", 0.0, 1e-9),
    "an error": (failing, "raises LookupError: no such angle", 3.0, 0.01),
    "other arguments": (OF_TWO, "raises TypeError", 0.0, 1e-9),
    "nothing": (lambda _: None, "gives None, not a number", 0.0, 1e-9),
    "a text": (lambda _: "one", "gives 'one', not a number", 0.0, 1e-9),
    "a complex number": (lambda x: 1j * x, "gives 0j, not a number", 0.0, 1e-9),
    "two numbers": (lambda x: np.array([x, x]), r"an array of shape \(2,\), not", 0.0, 1e-9),
    "noise": (lambda x: x + 1e-9 * rng.normal(size=np.shape(x)), "is not deterministic", 0.0, 7.0),
    "of the whole array": (lambda x: x - np.mean(x), "is not deterministic", 0.0, 7.0),
    "single precision": (lambda x: np.sin(np.float32(x)), "not smooth anywhere", 0.0, 7.0),
    "another's derivative": (
        (np.sin, lambda x: -np.cos(x)),
        "the first derivative given with phi2 is not the derivative",
        0.0,
        1e-9,
    ),
    "a derivative that is nearly right": (
        (np.exp, np.exp, lambda x: np.exp(x) + 1e-3 * np.exp(-((x - 3.0) ** 2))),
        "the second derivative given with phi2 is not the derivative",
        3.0,
        0.01,
    ),
    "a derivative with a step": (
        (lambda x: x * x, lambda x: np.where(x < CORNER, 2 * x, 2 * x + 1)),
        "the first derivative given with phi2 is not smooth",
        CORNER,
        1e-4,
    ),
}
"""Function, words, place, distance to which the place is told."""


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_smooth_function_is_refused_with_its_place(name: str) -> None:
    given, words, place, distance = REFUSED[name]
    with pytest.raises(InfeasibleError, match=words) as caught:
        made(given)
    assert str(caught.value).startswith(("phi2 ", "the first", "the second"))
    assert abs(float(caught.value.where.removeprefix("at ")) - place) <= distance
    if "smooth" in words:
        assert caught.value.nearest == "take a table"


def test_scatter_far_below_digits_that_count_is_taken() -> None:
    function = made(lambda x: np.sin(x) + 3e-14 * np.sin(1.7e12 * x))
    x = np.linspace(0.0, TURN, 101)
    _, _, _, third = function(Jet.variable(x, 3)).derivatives()
    np.testing.assert_allclose(third, -np.cos(x), atol=1e-10)


def test_no_wave_hides_between_the_places() -> None:
    for count in (256, 512, 2048):
        function = made(lambda x, count=count: 2.0 + 0.1 * np.cos(count * x))
        found = function(Jet.variable(np.array([0.7]), 0)).derivatives()[0][0]
        assert found == pytest.approx(2.0 + 0.1 * math.cos(count * 0.7), abs=1e-12)


def test_long_series_are_taken_of_harmonics_only() -> None:
    axis = Axis(name="slide", high=TURN, place=str, series=True)
    function = expanded(lambda x: np.cos(x) - 0.3 * np.sin(3 * x), axis, DEFAULT.expansion)
    c = function(Jet.variable(np.array([0.5]), 30)).c
    with mp.workdps(50):
        exact = mp.taylor(lambda t: mp.cos(t) - mp.mpf(0.3) * mp.sin(3 * t), mp.mpf(0.5), 30)
    for k, (one, two) in enumerate(zip(c, exact, strict=True)):
        assert abs(float(np.ravel(one)[0]) - float(two)) < 1e-14 * 3.0**k / math.factorial(k)
    with pytest.raises(InfeasibleError, match="slide needs more than 96 harmonics"):
        expanded(lambda x: x * (6.0 - x), axis, DEFAULT.expansion)
