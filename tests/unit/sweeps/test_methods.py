"""Methods of optimization on functions whose optimum is known."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gearcam.numeric.arrays import Array
from gearcam.sweeps.axes import axes_of
from gearcam.sweeps.methods import METHODS_KNOWN, Quest, Spent, minimized, usual
from helpers_sampling import chosen, few

SPAN = {"a": "0:1", "b": "0:1"}


def searched(
    method: str, search: Quest, function: Callable[..., tuple[Any, float]]
) -> list[tuple[list[Any], list[float], float]]:
    """Return values, goals and violations of all trials."""
    trials: list[tuple[list[Any], list[float], float]] = []

    def evaluate(points: Array) -> tuple[Array, Array]:
        if len(trials) >= search.trials:
            raise Spent
        goals, broken = [], []
        for point in points:
            values = [axis.at(float(u)) for axis, u in zip(search.axes, point, strict=True)]
            goal, excess = function(*values)
            goals.append(list(np.atleast_1d(goal)))
            broken.append(excess)
            trials.append((values, goals[-1], excess))
        return np.array(goals), np.array(broken)

    with pytest.raises(Spent):
        minimized(method, search, evaluate)
    return trials


def corner(a: float, b: float) -> tuple[float, float]:
    """Least a + b above the hyperbola a*b = 0.09: 0.6 at (0.3, 0.3)."""
    return a + b, max(0.0, 0.09 - a * b)


@pytest.mark.parametrize(
    ("method", "trials", "error"),
    few([("scipy", 400, 1e-5), ("tpe", 120, 0.05), ("random", 600, 0.1), ("nsga2", 600, 0.02)]),
)
def test_the_least_value_on_a_curved_limit_is_found(method: str, trials: int, error: float) -> None:
    search = Quest(axes_of(SPAN), 1, trials, 1)
    good = [goals[0] for _, goals, broken in searched(method, search, corner) if broken == 0.0]
    assert 0.6 <= min(good) < 0.6 + error


def mixed(teeth: int, law: str, share: float) -> tuple[float, float]:
    bend = {"x": 0.3, "y": -0.2, "z": 0.1}[law]
    return (teeth - 34) ** 2 / 50 + (share - 0.4) ** 2 + bend * np.sin(9 * teeth), 0.0


@pytest.mark.parametrize(
    ("method", "trials"), few([("scipy", 300), ("tpe", 150), ("nsga2", 600)], 3)
)
def test_whole_numbers_and_choices_against_all_combinations(method: str, trials: int) -> None:
    axes = axes_of({"teeth": "20:50:1", "law": ["x", "y", "z"], "share": "0:1"})
    found = min(searched(method, Quest(axes, 1, trials, 3), mixed), key=lambda one: one[1])
    least, best = min(
        (mixed(teeth, law, 0.4)[0], (teeth, law))
        for teeth, law in itertools.product(range(20, 51), "xyz")
    )
    assert tuple(found[0][:2]) == best
    assert found[1][0] < least + 0.01


def test_the_front_of_two_goals_has_the_area_of_the_true_one() -> None:
    def two(a: float, b: float) -> tuple[list[float], float]:
        return [a, (1.0 + b) * (1.0 - np.sqrt(a / (1.0 + b)))], 0.0  # ZDT1: best at b = 0

    trials = searched("nsga2", Quest(axes_of(SPAN), 2, 1000, 1), two)
    found = sorted(tuple(goals) for _, goals, _ in trials)
    area, height = 0.0, 1.0
    for x, y in found:
        if y < height:
            area, height = area + (1.0 - x) * (height - y), y
    assert area > 0.97 * (2.0 / 3.0)  # the integral of sqrt(x)


@pytest.mark.parametrize("method", chosen(METHODS_KNOWN, "scipy", "nsga2", "random"))
def test_trials_depend_on_the_seed_only(method: str) -> None:
    first, again, other = (
        [values for values, *_ in searched(method, Quest(axes_of(SPAN), 1, 96, seed), corner)]
        for seed in (1, 1, 2)
    )
    assert first == again
    assert first != other


def test_the_usual_method_follows_variables_and_price() -> None:
    numbers, whole = axes_of(SPAN), axes_of({"teeth": "20:50:1"})
    assert usual(Quest(numbers, 1, 200, 1), 0.01)[0] == "scipy"
    assert usual(Quest(numbers, 2, 200, 1), 0.01)[0] == "nsga2"
    assert usual(Quest(whole, 1, 200, 1), 0.01)[0] == "scipy"
    assert usual(Quest(whole, 1, 200, 1), 5.0)[0] == "tpe"
    assert usual(Quest(whole, 1, 5000, 1), 5.0)[0] == "scipy"
    choices = axes_of({"law": ["x", "y"]})
    assert usual(Quest(choices, 1, 200, 1), 0.01)[0] == "tpe"
    assert usual(Quest(choices, 1, 5000, 1), 0.01)[0] == "scipy"
    assert usual(Quest(choices, 2, 200, 1), 0.01)[0] == "nsga2"
    assert usual(Quest(numbers, 1, 200, 1), 5.0)[0] == "scipy"
