"""Motions by rows of angle and lift: through them or smoothed, told in rises and returns."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion_table import MotionTable
from gearcam.laws.program import Program
from helpers_cams import back, dwell, program, rise, there_and_back
from helpers_sampling import few

Array = NDArray[np.float64]
TURN = 2.0 * math.pi
FINE = np.linspace(0.0, TURN, 20001)


def angles(count: int, shift: float = 0.0) -> Array:
    return TURN * (np.arange(count) + shift) / count


def table(theta: Array, lift: Array, **more: Any) -> MotionTable:
    return MotionTable(theta=tuple(theta.tolist()), lift=tuple(lift.tolist()), **more)


def made(theta: Array, lift: Array, **more: Any) -> Program:
    return table(theta, lift, **more).program(DEFAULT)


def lift_of(motion: Program, theta: Array) -> Array:
    return motion.derivatives(theta, 0)[0]


def kinds(motion: Program) -> list[tuple[str, float, float]]:
    return [(s.kind, math.degrees(s.start), math.degrees(s.end)) for s in motion.stretches]


MOTIONS: dict[str, Program] = {
    "harmonic, velocity": program(
        [rise("harmonic", 60.0, 10.0), back("constant-velocity", 120.0), dwell(180.0)]
    ),
    "harmonic": there_and_back("harmonic", 10.0),
    "cycloidal": there_and_back("cycloidal", 10.0),
    "uneven": program([rise("3-4-5", 100.3, 10.0), dwell(20.2), back("3-4-5", 139.5), dwell(100)]),
    "4-5-6-7": there_and_back("4-5-6-7", 10.0),
    "no dwell": program([rise("modified-sine", 120.0, 9.0), back("cycloidal", 240.0)]),
    "harmonic back": program([rise("harmonic", 120.0, 9.0), back("harmonic", 240.0)]),
    "eccentric": program([rise("harmonic", 180.0, 10.0), back("harmonic", 180.0)]),
}
"""Motions whose velocity, acceleration, jerk or nothing jumps."""


@pytest.mark.parametrize("shift", few([0.25, 0.0]))
@pytest.mark.parametrize("name", MOTIONS)
def test_the_lift_goes_through_the_rows_and_is_smooth(name: str, shift: float) -> None:
    theta = angles(240, shift)
    lift = lift_of(MOTIONS[name], theta)
    found = made(theta, lift)
    np.testing.assert_allclose(lift_of(found, theta), lift, atol=1e-14)
    assert found.jumps == ()
    assert found.continuity == 3
    assert found.deviation is None
    assert found.knots[0] == 0.0
    assert found.knots[-1] == TURN
    assert len(found.knots) == 241 + (shift > 0.0)


@pytest.mark.parametrize("count", few([72, 715, 180, 360], 4))
@pytest.mark.parametrize("name", MOTIONS)
def test_the_error_between_rows_is_foreseen(name: str, count: int) -> None:
    """From rows left out: never less than the error, and nine times at most."""
    motion = MOTIONS[name]
    theta = angles(count)
    found = made(theta, lift_of(motion, theta))
    error = float(np.abs(lift_of(found, FINE) - lift_of(motion, FINE)).max())
    assert error < found.errors[0] < 9.0 * error + 1e-13


@pytest.mark.parametrize(
    ("name", "power", "order"),
    [("harmonic", 2.0, 0), ("cycloidal", 3.0, 0), ("4-5-6-7", 4.0, 0), ("4-5-6-7", 2.0, 2)],
)
def test_errors_fall_as_the_smoothness_of_the_motion_allows(
    name: str, power: float, order: int
) -> None:
    """The derivative that jumps decides; the rows at the jumps are rows of the table."""
    counts = (72, 144, 288, 576)
    exact = MOTIONS[name].derivatives(FINE, order)[order]
    errors = []
    for count in counts:
        theta = angles(count)
        found = made(theta, lift_of(MOTIONS[name], theta))
        errors.append(float(np.abs(found.derivatives(FINE, order)[order] - exact).max()))
    slope = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(power, abs=0.2)


@pytest.mark.parametrize("name", ["harmonic", "cycloidal", "4-5-6-7"])
def test_rises_returns_and_dwells_are_those_of_the_motion(name: str) -> None:
    theta = angles(360)
    found = made(theta, lift_of(MOTIONS[name], theta))
    expected = [("rise", 0, 90), ("dwell", 90, 180), ("return", 180, 270), ("dwell", 270, 360)]
    assert [kind for kind, _, _ in kinds(found)] == [kind for kind, _, _ in expected]
    np.testing.assert_allclose(
        [ends for _, *ends in kinds(found)], [ends for _, *ends in expected], atol=1e-9
    )


@pytest.mark.parametrize("shift", [0.0, 0.37])
def test_a_lift_turns_where_its_curve_does(shift: float) -> None:
    theta = angles(90, shift)
    found = made(theta, 3.0 * np.cos(theta - 1.0) + np.cos(2.0 * theta))
    slope = found.derivatives(np.array([stretch.end for stretch in found.stretches]), 1)[1]
    np.testing.assert_allclose(slope[:-1], 0.0, atol=1e-6)
    assert {stretch.kind for stretch in found.stretches} == {"rise", "return"}
    starts = [stretch.start for stretch in found.stretches]
    assert starts == [0.0, *(stretch.end for stretch in found.stretches[:-1])]
    for stretch in found.stretches:
        low, high = lift_of(found, np.array([stretch.start, stretch.end - 1e-12]))
        assert (high > low) == (stretch.kind == "rise")


def test_a_dwell_over_the_end_of_the_turn_is_cut_there() -> None:
    """Rows from 0.5 degrees on; three equal rows are a dwell, two are a turning point."""
    theta = angles(360, 0.5)
    lift = lift_of(MOTIONS["cycloidal"], theta + math.radians(45.0))
    found = kinds(made(theta, lift))
    assert [kind for kind, _, _ in found] == ["rise", "dwell", "return", "dwell", "rise"]
    assert found[0][1] == 0.0
    assert found[-1][2] == pytest.approx(360.0, abs=1e-9)
    six = angles(12)
    top = np.array([0.0, 1, 2, 3, 3, 2, 1, 0, -1, -1, -1, 0])
    found = kinds(made(six, top))
    assert [kind for kind, _, _ in found] == ["rise", "return", "dwell", "rise"]
    assert found[0][2] == pytest.approx(105.0, abs=1.0)
    np.testing.assert_allclose(found[2][1:], [240.0, 300.0], atol=1e-9)


# --- rows at the ends of the turn ----------------------------------------------------------------


def test_a_last_row_that_repeats_the_first_changes_nothing() -> None:
    theta = angles(120)
    lift = lift_of(MOTIONS["uneven"], theta)
    one = made(theta, lift)
    two = made(np.append(theta, TURN), np.append(lift, lift[0]))
    np.testing.assert_array_equal(one.derivatives(FINE, 3), two.derivatives(FINE, 3))
    assert two.errors == one.errors


def test_where_the_rows_begin_changes_nothing() -> None:
    """The same points of an uneven table, from 0 on and from the 30th on, turned back."""
    theta = angles(100) + 0.01 * np.sin(7.0 * angles(100))
    theta[0] = 0.0
    lift = lift_of(MOTIONS["uneven"], theta)
    one = made(theta, lift)
    turned = (np.roll(theta, -30) - theta[30]) % TURN
    two = made(turned, np.roll(lift, -30))
    found = two.derivatives(FINE - theta[30], 3)
    for got, expected in zip(found, one.derivatives(FINE, 3), strict=True):
        scale = float(np.abs(expected).max())
        np.testing.assert_allclose(got, expected, atol=1e-7 * scale)


@pytest.mark.parametrize(
    ("first", "last"), few([(1, 361), (1, 360), (-90, 269), (-90, 270), (360, 720)])
)
@pytest.mark.parametrize("tolerance", [None, 0.01])
def test_rows_may_begin_at_any_angle(
    first: int, last: int, tolerance: float | None, tmp_path: Path
) -> None:
    """The rows of each degree, in a file and in a list: the motion is that of those from 0 on."""

    def lift(angle: int) -> float:
        return round(float(lift_of(MOTIONS["uneven"], np.radians([angle % 360.0]))[0]), 5)

    file = tmp_path / "motion.csv"
    rows = range(first, last + 1)
    file.write_text("theta_deg,lift_mm\n" + "".join(f"{a},{lift(a)!r}\n" for a in rows))
    lists = {
        name: np.array([lift(a) for a in one])
        for name, one in (("rows", rows), ("turn", range(360)))
    }
    expected = made(angles(360), lists["turn"], smoothing_tolerance=tolerance)
    for given in (
        MotionTable(file=str(file), smoothing_tolerance=tolerance),
        table(np.radians([*rows]), lists["rows"], smoothing_tolerance=tolerance),
    ):
        found = given.program(DEFAULT)
        # of a smoothed lift the rounding of angles counts more
        atol = 1e-7 if tolerance else 1e-9
        np.testing.assert_allclose(lift_of(found, FINE), lift_of(expected, FINE), atol=atol)
        np.testing.assert_allclose(found.knots, expected.knots, atol=1e-12)


@pytest.mark.parametrize(
    ("count", "last", "whole"),
    [
        (361, "6.2831853", True),
        (361, "6.2832", True),
        (361, "6.28318", True),  # cut off
        (361, "6.283", True),
        (37, "6.28", True),
        (361, "6.2834", False),
        (361, "6.2852", False),
    ],
)
def test_a_turn_in_radians_may_be_rounded(
    count: int, last: str, whole: bool, tmp_path: Path
) -> None:
    theta = np.linspace(0.0, TURN, count)
    lift = lift_of(MOTIONS["uneven"], theta)
    lift[-1] = lift[0]
    rows = [f"{a!r},{b!r}\n" for a, b in zip(theta.tolist(), lift.tolist(), strict=True)]
    file = tmp_path / "motion.csv"
    file.write_text("".join(["theta_rad,lift_mm\n", *rows[:-1], f"{last},{float(lift[0])!r}\n"]))
    given = MotionTable(file=str(file))
    if not whole:
        with pytest.raises(InfeasibleError, match=r"the rows go from 0 deg to .* up to 360 deg"):
            given.program(DEFAULT)
        return
    expected = lift_of(made(theta[:-1], lift[:-1]), FINE)
    np.testing.assert_allclose(lift_of(given.program(DEFAULT), FINE), expected, atol=1e-12)


# --- smoothing -----------------------------------------------------------------------------------


def noisy(name: str, theta: Array, seed: int = 7) -> Array:
    noise = np.random.default_rng(seed).uniform(-0.003, 0.003, theta.size)
    return lift_of(MOTIONS[name], theta) + noise


@pytest.mark.parametrize("tolerance", few([0.0035, 0.005, 0.02], 3))
@pytest.mark.parametrize("name", MOTIONS)
def test_no_row_is_farther_off_than_the_tolerance(name: str, tolerance: float) -> None:
    """Nearly all of it is used, and what is told is the largest distance, with its place."""
    theta = angles(360, 0.1)
    lift = noisy(name, theta)
    found = made(theta, lift, smoothing_tolerance=tolerance)
    off = lift_of(found, theta) - lift
    assert found.deviation is not None
    worst = int(np.abs(off).argmax())
    assert found.deviation.theta == pytest.approx(theta[worst], abs=1e-15)
    assert found.deviation.value == pytest.approx(off[worst], abs=1e-14)
    assert 0.9 * tolerance < abs(off[worst]) <= tolerance
    assert found.continuity == 3


@pytest.mark.parametrize("name", ["cycloidal", "4-5-6-7", "no dwell", "eccentric"])
def test_smoothing_finds_the_motion_below_the_noise(name: str) -> None:
    """Velocity, acceleration and jerk of a smooth motion, which the rows have lost."""
    theta = angles(360)
    motion, rough = MOTIONS[name], made(theta, noisy(name, theta))
    found = made(theta, noisy(name, theta), smoothing_tolerance=0.005)
    for order, part in ((0, 5e-4), (1, 0.01), (2, 0.15)):
        exact = motion.derivatives(FINE, order)[order]
        off = np.abs(found.derivatives(FINE, order)[order] - exact).max()
        assert off < part * np.abs(exact).max()
    assert found.peaks[2] < 1.2 * motion.peaks[2]
    assert rough.peaks[2] > 50.0 * motion.peaks[2]


@pytest.mark.parametrize("count", [360, 3600])
def test_a_smoothed_lift_has_as_many_knots_as_its_waves_need(count: int) -> None:
    """However many rows there are: pieces, files and times follow the motion."""
    theta = angles(count, 0.1)
    found = made(theta, noisy("cycloidal", theta), smoothing_tolerance=0.01)
    assert 50 < len(found.knots) < 140
    assert found.errors[0] < 1e-4
    assert found.jumps == ()


def test_more_tolerance_gives_less_jerk() -> None:
    theta = angles(360)
    lift = noisy("harmonic", theta)
    jerks = []
    for tolerance in (0.0031, 0.004, 0.006, 0.01, 0.05, 0.5):
        found = made(theta, lift, smoothing_tolerance=tolerance)
        jerks.append(float((found.derivatives(FINE, 3)[3] ** 2).mean()))
    assert (np.diff(jerks) < 0.0).all()


def test_a_tolerance_below_all_noise_is_the_curve_through_the_rows() -> None:
    theta = angles(36)
    lift = noisy("harmonic", theta)
    found = made(theta, lift, smoothing_tolerance=1e-13)
    np.testing.assert_allclose(lift_of(found, theta), lift, atol=1e-13)
    assert found.deviation is not None
    assert abs(found.deviation.value) <= 1e-13


@pytest.mark.parametrize("count", [180, 360, 1440])
def test_dwells_are_found_below_the_noise(count: int) -> None:
    """To the width of the shortest wave that is left, 10 degrees or so; tops are no dwells."""
    theta = angles(count)
    found = kinds(made(theta, noisy("cycloidal", theta), smoothing_tolerance=0.005))
    around = [entry for entry in found if entry[2] - entry[1] > 5.0]
    assert [kind for kind, _, _ in around] == ["rise", "dwell", "return", "dwell"]
    np.testing.assert_allclose([ends[0] for _, *ends in around], [0, 90, 180, 270], atol=6.0)
    for name, top in (("harmonic back", 120.0), ("eccentric", 180.0)):
        found = kinds(made(theta, noisy(name, theta), smoothing_tolerance=0.005))
        assert {kind for kind, _, _ in found} == {"rise", "return"}
        assert [end for kind, _, end in found if kind == "rise" and end < 300.0] == [
            pytest.approx(top, abs=2.0)
        ]


def test_a_slow_way_is_no_dwell_however_slow() -> None:
    """0.2 mm in 180 degrees, slower than the tolerance in a wave: rows tell a rise all the same."""
    theta = angles(360)
    way = np.where(theta < math.pi, 0.2 * theta / math.pi, 5.2 - 5.0 * np.cos(theta - math.pi))
    way = np.where(theta < math.pi, way, 0.2 * (TURN - theta) / math.pi + 5.0 * np.sin(theta) ** 2)
    found = kinds(made(theta, way, smoothing_tolerance=0.02))
    assert ("rise", True) in {(kind, start < 30.0 and end > 150.0) for kind, start, end in found}


def test_the_two_ends_of_the_turn_may_differ_by_the_tolerance() -> None:
    """What is told counts both rows."""
    theta = np.append(angles(120), TURN)
    lift = lift_of(MOTIONS["cycloidal"], theta)
    lift[-1] += 0.004
    found = made(theta, lift, smoothing_tolerance=0.005)
    off = lift_of(found, theta[:-1]) - lift[:-1]
    last = float(lift_of(found, theta[:1])[0] - lift[-1])
    assert found.deviation is not None
    assert abs(found.deviation.value) == pytest.approx(max(abs(last), np.abs(off).max()), abs=1e-9)
    assert abs(found.deviation.value) <= 0.005
    with pytest.raises(InfeasibleError, match=r"it jumps by 0\.004 mm"):
        made(theta, lift, smoothing_tolerance=0.0039)


# --- refusals ------------------------------------------------------------------------------------

THETA = angles(12)
LIFT = 5.0 * (1.0 - np.cos(THETA))


def moved(row: int, degrees: float) -> Array:
    theta = THETA.copy()
    theta[row] = math.radians(degrees)
    return theta


BAD: dict[str, tuple[Array, Array]] = {
    "few": (THETA[:5], LIFT[:5]),
    "many": (angles(3601), np.cos(angles(3601))),
    "below": (moved(0, -365.0), LIFT),
    "above": (moved(11, 721.0), LIFT),
    "more than a turn": (moved(11, 361.0), LIFT),
    "more than a turn from 30 deg": (moved(11, 391.0) + math.radians(30.0), LIFT),
    "falls": (moved(4, 89.0), LIFT),
    "twice": (np.insert(THETA, 4, THETA[3])[:12], LIFT),
    "close": (moved(4, 90.0003), LIFT),
    "half": (0.5 * THETA, LIFT),
    "end": (THETA[:-1], LIFT[:-1]),
    "high": (THETA, np.where(np.arange(12) == 5, 2e6, LIFT)),
    "flat": (THETA, 0.0 * LIFT + 3.0),
    "smooth": (THETA, LIFT),
    "jump": (np.append(THETA, TURN), np.append(LIFT, 0.2)),
}
REFUSED = {
    "few": (None, "has 5 rows", "6 to 3600 rows"),
    "many": (None, "has 3601 rows", "6 to 3600 rows"),
    "below": (0, "the angle is -365 deg", "-360 to 720 deg"),
    "above": (11, "the angle is 721 deg", "-360 to 720 deg"),
    "more than a turn": (11, "the rows go from 0 deg to 361 deg", "one turn: up to 360 deg"),
    "more than a turn from 30 deg": (
        11,
        "the rows go from 30 deg to 421 deg",
        "one turn: up to 390 deg",
    ),
    "falls": (4, "89 deg follows 90 deg", "at least 0.00036 deg"),
    "twice": (4, "90 deg is given twice", "above the one before"),
    "close": (4, "90.0003 deg follows 90 deg", "above the one before"),
    "half": (None, "the rows go from 0 deg to 165 deg", "over the whole turn"),
    "end": (None, "the rows go from 0 deg to 300 deg", "may be left out"),
    "high": (5, "the lift is 2000000 mm", "at most 100000 mm"),
    "flat": (None, "the follower never moves", "at least two different lifts"),
    "smooth": (None, "leaves no lift", "below 5 mm, half of"),
    "jump": (12, "after the turn is 0.2 mm: it jumps by 0.2 mm", "that of the first row, 0 mm"),
}


@pytest.mark.parametrize("change", REFUSED)
def test_rows_that_make_no_motion_are_refused(change: str, tmp_path: Path) -> None:
    """With the number of the row; of a file with its line."""
    theta, lift = BAD[change]
    more: dict[str, Any] = {"smoothing_tolerance": 5.0} if change == "smooth" else {}
    row, message, rule = REFUSED[change]
    ((_, found, told, allowed),) = table(theta, lift, **more).turn_problems(oscillating=False)
    assert found == row
    assert message in told
    assert rule in allowed
    with pytest.raises(InfeasibleError, match=r"\(motion\."):
        made(theta, lift, **more)
    file = tmp_path / "motion.csv"
    rows = "".join(
        f"{math.degrees(a)!r},{b!r}\n" for a, b in zip(theta.tolist(), lift.tolist(), strict=True)
    )
    file.write_text("# a comment\ntheta_deg,lift_mm\n" + rows)
    ((name, _, told, _),) = MotionTable(file=str(file), **more).turn_problems(oscillating=False)
    assert name == ("smoothing_tolerance" if change == "smooth" else "file")
    assert message.split(" deg ")[-1] in told
    assert ("line" in told) == (row is not None)
    if row is not None:
        assert told.startswith(f"line {row + 3}: ")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("theta_deg,lift_mm\n", "has 0 rows"),
        ("theta_deg,lift\n0,1\n", "columns are theta_deg, lift; write theta_deg,lift_mm, if"),
        ("theta_deg,lift_deg\n0,1\n", "line 1: lift_deg is of the wrong kind for a translating"),
        ("theta_deg,lift_mm,lift_deg\n0,1,2\n", "has 1 rows"),
        ("theta_deg,lift_mm\n0,x\n", "line 2: 'x' is not a number"),
        ("theta_deg,lift_mm\n0,nan\n", "line 2: 'nan' is not finite"),
        ("", "is empty"),
    ],
)
def test_files_that_hold_no_rows_are_refused(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "motion.csv"
    file.write_text(text)
    ((name, _, told, _),) = MotionTable(file=str(file)).turn_problems(oscillating=False)
    assert name == "file"
    assert message in told


def test_rows_are_given_once_and_whole() -> None:
    lift, theta = tuple(LIFT.tolist()), tuple(THETA.tolist())
    for given, name, message in (
        (MotionTable(), "theta", "is missing"),
        (MotionTable(theta=theta), "lift", "is missing"),
        (MotionTable(lift=lift), "theta", "is missing"),
        (MotionTable(file="a.csv", theta=theta), "file", "the rows are given twice"),
    ):
        ((found, _, told, _),) = given.problems()
        assert found == name
        assert message in told
    uneven = MotionTable(theta=theta, lift=lift[:-1])
    ((found, _, told, _),) = uneven.turn_problems(oscillating=False)
    assert (found, told) == ("lift", "11 values, but theta has 12")
    ((_, _, told, _),) = MotionTable(file="nowhere.csv").turn_problems(oscillating=False)
    assert "cannot be read" in told


def test_a_file_has_the_lift_of_the_followers_kind(tmp_path: Path) -> None:
    rows = "".join(f"{30 * k},{b}\n" for k, b in enumerate(LIFT.tolist()))
    for unit, oscillating in (("mm", False), ("deg", True)):
        file = tmp_path / f"{unit}.csv"
        file.write_text(f"theta_deg,lift_{unit}\n{rows}")
        found = MotionTable(file=str(file)).program(DEFAULT, oscillating=oscillating)
        high = math.radians(10.0) if oscillating else 10.0
        assert found.range[1] == pytest.approx(high, rel=1e-12)
        with pytest.raises(InfeasibleError, match=rf"line 1: lift_{unit} is of the wrong kind"):
            MotionTable(file=str(file)).program(DEFAULT, oscillating=not oscillating)
