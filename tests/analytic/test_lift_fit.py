"""Laws and phases found in lifts, which are integrated from accelerations, with noise."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest

from gearcam.base.registry import name_of
from gearcam.laws.lift_fit import FittedLift, fit_lift
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import DwellPhase, ReturnPhase, RisePhase
from gearcam.numeric.arrays import Array, Mask
from helpers_sampling import few

Q = 0.125
FINE = np.linspace(0.0, 1.0, 100_001)


def odd(first: Callable[[Array], Array]) -> Callable[[Array], Array]:
    """An acceleration that is the opposite in the second half."""
    return lambda x: np.where(x < 0.5, first(x), -first(1.0 - x))


def trapezoid_rounded(x: Array) -> Array:
    return np.select(
        [x < 1 / 8, x < 3 / 8],
        [np.sin(4 * math.pi * x), np.ones_like(x)],
        np.cos(4 * math.pi * (x - 3 / 8)),
    )


ACCELERATIONS: dict[str, Callable[[Array], Array]] = {
    "constant-acceleration": odd(np.ones_like),
    "harmonic": lambda x: np.cos(math.pi * x),
    "cycloidal": lambda x: np.sin(2 * math.pi * x),
    "trapezoidal-velocity": odd(lambda x: np.where(x < Q, 1.0, 0.0)),
    "sine-trapezoidal-velocity": odd(lambda x: np.where(x < Q, np.sin(math.pi * x / Q), 0.0)),
    "trapezoidal-acceleration": odd(lambda x: np.interp(x, [0, Q, 0.5 - Q, 0.5], [0, 1, 1, 0])),
    "2-3": lambda x: 1 - 2 * x,
    "3-4-5": lambda x: x * (1 - x) * (1 - 2 * x),
    "4-5-6-7": lambda x: x**2 * (1 - x) ** 2 * (1 - 2 * x),
    "5-6-7-8-9": lambda x: x**3 * (1 - x) ** 3 * (1 - 2 * x),
    "modified-trapezoid": odd(trapezoid_rounded),
    "modified-sine": odd(
        lambda x: np.where(
            x < 1 / 8, np.sin(4 * math.pi * x), np.sin(math.pi / 3 + 4 * math.pi * x / 3)
        )
    ),
}


def integral(values: Array) -> Array:
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(FINE)
    return np.concatenate([[0.0], np.cumsum(steps)])


def rise(name: str) -> Array:
    """The share of the lift at the places FINE."""
    if name == "constant-velocity":
        return FINE
    if name == "3-4-5-6":  # half of 64*u^3*(1 - u)^3
        return 8 * FINE**3 * (1 - FINE / 2) ** 3
    lift = integral(integral(ACCELERATIONS[name](FINE)))
    return lift / lift[-1]


@dataclass(frozen=True)
class Move:
    law: str
    start: float
    end: float
    low: float
    high: float

    def lift(self, degrees: Array) -> tuple[Mask, Array]:
        """Where it is, and its lift."""
        x = (degrees - self.start) % 360.0 / (self.end - self.start)
        share = rise(self.law)
        if self.law == "3-4-5-6" and self.high < self.low:  # the rise run backwards
            share = 1.0 - share[::-1]
        return x < 1.0, self.low + (self.high - self.low) * np.interp(x, FINE, share)


def rows(moves: Sequence[Move], noise: float, count: int = 240) -> tuple[Array, Array]:
    degrees = np.arange(count) * 360.0 / count
    lift = np.full(count, np.nan)
    for move in moves:
        on, values = move.lift(degrees)
        lift[on] = values[on]
    for number, move in enumerate(moves):
        until = moves[(number + 1) % len(moves)].start
        dwell = (degrees - move.end) % 360.0 < (until - move.end) % 360.0
        lift[dwell & np.isnan(lift)] = move.high
    random = np.random.default_rng(sum(map(ord, moves[0].law)))
    return np.radians(degrees), lift + random.normal(0.0, noise, count)


def double_dwell(law: str) -> list[Move]:
    return [Move(law, 20, 115, 0, 12), Move(law, 140, 220, 12, 0)]


def named(fitted: FittedLift, k: int) -> list[str]:
    laws = [fitted.model.laws[k], *(one.law for one in fitted.alike[k])]
    return [name_of(MOTION_LAWS, law) for law in laws]


def demand_found(fitted: FittedLift, moves: Sequence[Move]) -> None:
    """Every law is named, and every boundary within twice its stated error, which is two sigma."""
    model = fitted.model
    assert len(model.laws) == len(moves)
    starts = np.degrees(model.starts) % 360.0
    for move in moves:
        off = np.abs((starts - move.start + 180.0) % 360.0 - 180.0)
        k = int(off.argmin())
        assert move.law in named(fitted, k)
        # 1e-3 deg: the integration of a jump
        assert off[k] < 2.0 * math.degrees(fitted.error(("start", k))) + 1e-3
        far = abs((math.degrees(model.ends[k]) - move.end + 180.0) % 360.0 - 180.0)
        assert far < 2.0 * math.degrees(fitted.error(("end", k))) + 1e-3


LAWS = [*ACCELERATIONS, "constant-velocity", "3-4-5-6"]


@pytest.mark.parametrize(
    ("law", "noise"), few([(law, noise) for noise in (1e-3, 1e-2, 0.1) for law in LAWS], 6)
)
def test_every_law_is_found_or_named(law: str, noise: float) -> None:
    moves = double_dwell(law)
    fitted = fit_lift(*rows(moves, noise), (1.0, "mm"))
    demand_found(fitted, moves)
    # sums of 240 squares: 4.6 % a standard deviation
    assert fitted.rows.noise == pytest.approx(noise, rel=0.3)
    assert math.sqrt(float(np.mean(fitted.missed**2))) == pytest.approx(noise, rel=0.2)
    if noise == 1e-3:  # a tenth of a thousandth of the lift: no other law comes near
        for k in (0, 1):
            assert named(fitted, k)[0] == law
            # but families with a number, which begin with this law: q of almost 0
            assert all(getattr(one.law, "q", 1.0) < 0.05 for one in fitted.alike[k])


def test_laws_are_alike_in_much_noise_only() -> None:
    moves = double_dwell("cycloidal")
    quiet, loud = (fit_lift(*rows(moves, noise), (1.0, "mm")) for noise in (1e-3, 0.1))
    assert named(quiet, 0) == ["cycloidal"]
    assert {"cycloidal", "3-4-5"} <= set(named(loud, 0))
    assert loud.error(("start", 0)) > 100.0 * quiet.error(("start", 0))


@pytest.mark.parametrize(
    ("last", "noise", "seed"),
    [("modified-sine", 0.04, 0), ("modified-sine", 0.04, 6), ("harmonic", 0.02, 0)],
)
def test_phases_share_a_law_unless_another_misses_clearly_less(
    last: str, noise: float, seed: int
) -> None:
    moves = [
        Move("modified-sine", 20, 80, 0, 10),
        Move("modified-sine", 100, 160, 10, 2),
        Move("modified-sine", 190, 260, 2, 12),
        Move(last, 280, 350, 12, 0),
    ]
    theta, lift = rows(moves, 0.0, 180)
    lift += np.random.default_rng(seed).normal(0.0, noise, len(theta))
    fitted = fit_lift(theta, lift, (1.0, "mm"))
    demand_found(fitted, moves)
    first, *others, end = (named(fitted, k)[0] for k in range(4))
    assert set(others) == {first}
    assert (end == first) == (last == "modified-sine")


def test_sizes_are_round_where_noise_allows_it() -> None:
    fitted = fit_lift(*rows(double_dwell("modified-sine"), 1e-2), (1.0, "mm"))
    low, up, high, down, rest = fitted.phases()
    assert isinstance(up, RisePhase)
    assert isinstance(down, ReturnPhase)
    assert all(isinstance(one, DwellPhase) for one in (low, high, rest))
    widths = [math.degrees(one.angle) for one in (low, up, high, down) if one.angle != "rest"]
    assert widths == pytest.approx([20, 95, 25, 80], abs=1e-12)
    assert (up.lift, down.lift, rest.angle) == (12.0, None, "rest")
    assert fitted.begin[1] == 0.0


def test_moves_touch_where_no_dwell_is_seen() -> None:
    moves = [Move("3-4-5-6", 30, 130, 0, 8), Move("3-4-5-6", 130, 230, 8, 0)]
    fitted = fit_lift(*rows(moves, 5e-3), (1.0, "mm"))
    demand_found(fitted, moves)
    assert sorted(fitted.model.tied) == [False, True]
    assert len(fitted.phases()) == 4


def test_a_program_over_the_end_of_the_turn_begins_at_its_lowest_lift() -> None:
    moves = [Move("cycloidal", 300, 400, 1.5, 7.5), Move("harmonic", 90, 200, 7.5, 1.5)]
    fitted = fit_lift(*rows(moves, 2e-3), (1.0, "mm"))
    demand_found(fitted, moves)
    assert math.degrees(fitted.begin[1]) % 360.0 == pytest.approx(300.0, abs=1e-9)
    assert float(fitted.model.levels.min()) == pytest.approx(1.5, abs=1e-9)


def test_three_levels_and_two_rises_in_a_row() -> None:
    moves = [
        Move("3-4-5", 0, 80, 0, 5),
        Move("cycloidal", 80, 170, 5, 12),
        Move("harmonic", 200, 300, 12, 0),
    ]
    fitted = fit_lift(*rows(moves, 1e-3, 360), (1.0, "mm"))
    demand_found(fitted, moves)


@pytest.mark.parametrize(("law", "other"), [("3-4-5", "3-4-5"), ("harmonic", "4-5-6-7")])
def test_a_dwell_of_few_rows_is_seen(law: str, other: str) -> None:
    moves = [Move(law, 322, 451.3, 20, 6), Move(other, 127.8, 247.4, 6, 20)]
    demand_found(fit_lift(*rows(moves, 1e-3, 36), (1.0, "mm")), moves)


def test_equal_levels_are_equal() -> None:
    moves = [
        Move("cycloidal", 10, 70, 0, 5),
        Move("cycloidal", 90, 150, 5, 0),
        Move("modified-sine", 180, 240, 0, 9),
        Move("modified-sine", 260, 340, 9, 0),
    ]
    fitted = fit_lift(*rows(moves, 3e-3, 360), (1.0, "mm"))
    demand_found(fitted, moves)
    assert sorted(fitted.model.levels.tolist()) == pytest.approx([0, 0, 5, 9], abs=1e-12)
    lifts = [one.lift for one in fitted.phases() if isinstance(one, RisePhase)]
    assert lifts == [5.0, 5.0, 9.0, None]


def test_the_number_of_a_law_is_found() -> None:
    q = 0.3
    lift = integral(integral(odd(lambda x: np.where(x < q, 1.0, 0.0))(FINE)))
    theta, values = rows(
        [Move("constant-velocity", 20, 115, 0, 12), Move("2-3", 140, 220, 12, 0)], 0
    )
    on, share = Move("constant-velocity", 20, 115, 0, 1).lift(np.degrees(theta))
    values[on] = 12.0 * np.interp(share[on], FINE, lift / lift[-1])
    values += np.random.default_rng(1).normal(0.0, 2e-3, len(theta))
    fitted = fit_lift(theta, values, (1.0, "mm"))
    assert named(fitted, 0) == ["trapezoidal-velocity"]
    assert fitted.model.laws[0].q == pytest.approx(q, abs=2e-3)


def test_a_lift_without_a_law_leaves_more_than_noise() -> None:
    theta = np.radians(np.arange(0.0, 360.0, 2.0))
    lift = 4.0 * np.exp(2.0 * (np.cos(theta) - 1.0)) * (1.0 + 0.2 * np.sin(theta))
    noise = np.random.default_rng(2).normal(0.0, 1e-3, len(theta))
    fitted = fit_lift(theta, lift + noise, (1.0, "mm"))
    assert fitted.rows.noise == pytest.approx(1e-3, rel=0.3)
    assert math.sqrt(float(np.mean(fitted.missed**2))) > 5.0 * fitted.rows.noise
