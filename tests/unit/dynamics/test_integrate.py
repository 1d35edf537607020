"""Integration between knots and switches, on motions known in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.dynamics import integrate
from gearcam.dynamics.choice import MethodChoice
from gearcam.dynamics.integrate import METHODS, Integrator, Mode, Switch

pytest.importorskip("scipy")


def integrator(method: str = "dop853", rtol: float = 1e-9, parts: int = 2) -> Integrator:
    return Integrator(method=method, rtol=rtol, atol=(rtol,) * parts)


def swing(_: float, y: Any) -> Sequence[float]:
    return [float(y[1]), -float(y[0])]


def fall(_: float, y: Any) -> Sequence[float]:
    return [float(y[1]), -1.0]


@pytest.mark.parametrize("method", METHODS)
def test_a_smooth_motion(method: str) -> None:
    made = integrator(method)({"swing": Mode(swing)}, ("swing", [1.0, 0.0]), [0.0, 1.0, 6.0])
    wrong = 1e-5 if method in ("bdf", "lsoda") else 1e-7
    assert made.end == pytest.approx([math.cos(6.0), -math.sin(6.0)], abs=wrong)
    x = np.linspace(0.0, 6.0, 50)
    # between steps Radau is of order 3
    assert made.at(x)[0] == pytest.approx(np.cos(x), abs=1e-5)
    assert (made.place, made.mode, made.switches) == (6.0, "swing", [])


@pytest.mark.parametrize("method", METHODS)
def test_a_rate_that_jumps_at_a_knot_has_the_value_of_its_own_side(method: str) -> None:
    knots = [0.0, 0.3, 0.7, 2.0]

    def rate(x: float, _: Any) -> Sequence[float]:
        return [float(np.searchsorted(knots, x, side="right")) ** 3]

    made = integrator(method, parts=1)({"one": Mode(rate)}, ("one", [0.0]), knots)
    assert made.end[0] == pytest.approx(0.3 + 8.0 * 0.4 + 27.0 * 1.3, rel=1e-13)


@pytest.mark.parametrize("method", METHODS)
def test_switches_are_met_where_they_are(method: str) -> None:
    """A body on a spring below 0, that flies above."""
    leaves = Switch(lambda _, y: -float(y[0]), "flight", 1e-12)
    lands = Switch(lambda _, y: float(y[0]), "spring", 1e-12)
    modes = {"spring": Mode(swing, (leaves,)), "flight": Mode(fall, (lands,))}
    made = integrator(method, 1e-10)(modes, ("spring", [0.0, -1.0]), [0.0, 3.0 * (math.pi + 2.0)])
    places = [place for place, _, _ in made.switches]
    wanted = [math.pi, math.pi + 2.0, 2.0 * math.pi + 2.0, 2.0 * math.pi + 4.0]
    wanted += [3.0 * math.pi + 4.0]
    assert places[:5] == pytest.approx(wanted, abs=1e-4 if method in ("bdf", "lsoda") else 1e-7)
    assert [after for _, _, after in made.switches[:2]] == ["flight", "spring"]
    assert made.modes([1.0, math.pi + 1.0]) == ["spring", "flight"]
    # at a switch the state is that after it
    assert made.modes([places[0]]) == ["flight"]
    assert made.at([math.pi + 1.0])[:, 0] == pytest.approx([0.5, 0.0], abs=1e-4)


def test_a_mode_that_ends_and_comes_back_within_a_step_is_seen() -> None:
    """The height is a parabola, which one step of any length follows."""
    low = Switch(lambda _, y: float(y[0]), "under", 0.0)
    up = {"over": Mode(lambda x, _: [2.0 * (x - 1.0)], (low,)), "under": Mode(lambda *_: [0.0])}
    made = integrator(parts=1)(up, ("over", [0.75]), [0.0, 2.0])
    assert made.switches[0][0] == pytest.approx(0.5, abs=1e-9)
    assert made.mode == "under"


def test_a_motion_ends_with_its_last_mode() -> None:
    stop = Switch(lambda _, y: float(y[0]), "still", 0.0)
    passed: list[float] = []
    knots = [0.0, 1.0, 2.0, 3.0]
    start = "fall", [1.125, 0.0]
    modes = {"fall": Mode(fall, (stop,)), "still": Mode(fall, last=True)}
    made = integrator()(modes, start, knots, passed=passed.append)
    assert (made.mode, passed) == ("still", [1.0])
    assert made.place == pytest.approx(1.5, abs=1e-9)
    with pytest.raises(ValueError, match="only"):
        made.at([1.6])


def test_a_motion_that_switches_without_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(integrate, "_MOST", 20)
    # in each mode the state moves to where the other begins
    modes = {
        "up": Mode(lambda *_: [1.0], (Switch(lambda _, y: -float(y[0]), "down", 1e-9),)),
        "down": Mode(lambda *_: [-1.0], (Switch(lambda _, y: float(y[0]), "up", 1e-9),)),
    }
    with pytest.raises(InfeasibleError, match="20 switches between"):
        integrator(parts=1)(modes, ("up", [0.0]), [0.0, 1.0])


def test_only_what_is_wanted_is_kept() -> None:
    made = integrator()({"swing": Mode(swing)}, ("swing", [1.0, 0.0]), [0.0, 20.0], keep=15.0)
    assert 10.0 < made.pieces[0].low <= 15.0
    assert made.at([15.0])[0, 0] == pytest.approx(math.cos(15.0), abs=1e-7)


def test_a_stiff_mode_begins_with_steps_of_its_own() -> None:
    """From rest nothing tells how fast a spring is, nor does the flight before it."""
    seen: list[float] = []

    def hard(x: float, y: Any) -> Sequence[float]:
        seen.append(x)
        return [float(y[1]), -1e8 * (float(y[0]) - 1.0)]

    hits = Switch(lambda _, y: float(y[0]), "spring", 1e-12)
    spring = Mode(hard, pace=lambda *_: 1e4)
    modes = {"flight": Mode(fall, (hits,)), "spring": spring}
    integrator()(modes, ("spring", [1.0, 1e-9]), [0.0, 1.0], keep=2.0)
    assert max(seen[:13]) <= 1e-4
    seen.clear()
    integrator()(modes, ("flight", [0.5, 0.0]), [0.0, 1.01], keep=2.0)
    assert min(seen) >= 1.0
    assert max(seen[:13]) <= 1.0 + 1.1e-4


class Steps:
    """An integrator that makes steps of a length for so many evaluations."""

    def __init__(self, size: float, work: int) -> None:
        self.step_size, self.nfev, self._work = size, 0, work

    def step(self) -> None:
        self.nfev += self._work


def advanced(choice: MethodChoice, steps: Steps, most: int) -> int:
    """Return after how many steps the method changes; `most` if it does not."""
    for number in range(most):
        steps.step()
        if choice.changes(steps, 1.0):
            return number + 1
    return most


def test_steps_shorter_than_stability_asks_are_never_left() -> None:
    assert advanced(MethodChoice(), Steps(3.9, 12), 1000) == 1000


def test_a_trial_that_fails_waits_twice_as_long() -> None:
    choice, waits = MethodChoice(), []
    for _ in range(4):
        waits.append(advanced(choice, Steps(6.0, 12), 1000))
        assert choice.method == "lsoda"
        assert advanced(choice, Steps(0.9, 2), 1000) == 60
        assert choice.method == "dop853"
    assert waits == [8, 16, 32, 64]


def test_a_trial_that_pays_goes_on_until_it_does_not() -> None:
    choice = MethodChoice()
    advanced(choice, Steps(6.0, 12), 1000)
    assert advanced(choice, Steps(2.0, 2), 1000) == 1000
    assert advanced(choice, Steps(0.9, 2), 1000) <= 40
    assert choice.method == "dop853"


def test_a_method_that_fails_is_left() -> None:
    choice = MethodChoice()
    assert not choice.fails()
    advanced(choice, Steps(6.0, 12), 1000)
    assert choice.fails()
    assert choice.method == "dop853"


@pytest.mark.parametrize("start", [1e-320, 1e-16])
def test_a_switch_that_rounding_puts_at_the_start_is_met_there(start: float) -> None:
    falls = Mode(lambda *_: [-1.0], (Switch(lambda _, y: float(y[0]), "rest", 0.0, dips=False),))
    modes = {"falls": falls, "rest": Mode(lambda *_: [0.0], last=True)}
    made = integrator(parts=1)(modes, ("falls", [start]), [6.0, 7.0])
    assert made.switches == [(pytest.approx(6.0, abs=1e-15), "falls", "rest")]
