"""The charts of a mechanism: what they draw is what tables, facts and closed forms tell."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from helpers_machines import MACHINES, PAIR, machine

OTHER = {
    "law": {"type": "ellipse", "eccentricity": 0.2},
    "pair": {"teeth": [24, 24], "module_mm": 3},
}


def drawn(result: Any, name: str) -> dict[str, tuple[Any, Any]]:
    return {one.label: (one.x, one.y) for one in result.chart(name).lines}


@pytest.mark.parametrize(
    ("chart", "column"),
    [("motion", "C_mm"), ("velocity", "C_mm_per_rad"), ("acceleration", "C_mm_per_rad2"),
     ("jerk", "C_mm_per_rad3")],
)  # fmt: skip
def test_charts_draw_the_table(chart: str, column: str) -> None:
    result = machine("slide behind a pair")
    ((x, y),) = drawn(result, chart).values()
    assert result.chart(chart).x == "driver angle phi1, deg"
    table = result.motion(np.radians(x))
    np.testing.assert_allclose(y, table[column], atol=1e-9)


def test_the_first_three_charts_are_place_velocity_and_acceleration() -> None:
    assert machine("four-bar").charts[:3] == ("motion", "velocity", "acceleration")
    turning = gc.design({
        "kind": "mechanism", "name": "drawn",
        **{k: MACHINES["four-bar"][k] for k in ("drive", "joint", "crank", "dyad")},
        "output": {"files": ["csv"], "outputs": ["rocker.angle"]},
    })  # fmt: skip
    names = gc.build(turning).charts
    assert names[:3] == ("direction", "angular_velocity", "angular_acceleration")
    assert "motion" not in names


def test_a_chart_of_an_angle_is_in_degrees_and_its_rates_in_radians() -> None:
    result = machine("four-bar")
    ((x, angle),) = drawn(result, "direction").values()
    ((_, rate),) = drawn(result, "angular_velocity").values()
    slopes = np.diff(angle) / np.diff(x)
    middles = 0.5 * (rate[1:] + rate[:-1])
    assert np.abs(slopes - middles).max() < 1e-4
    assert result.chart("direction").y == "direction, deg"
    assert result.chart("angular_velocity").y == "angular velocity, rad/rad"


def test_every_drive_that_is_compared_has_a_line() -> None:
    document: dict[str, Any] = {
        "kind": "mechanism", "name": "drawn", **MACHINES["slide behind a pair"],
        "compare": [{"name": "other", "pair": OTHER}, {"name": "even", "even": True}],
    }  # fmt: skip
    result = gc.build(gc.design(document))
    lines = drawn(result, "velocity")
    assert [*lines][1:] == ["other", "even"]
    # behind an even shaft the crank-slider of the text books, its crank at 0 deg for phi1 = 0
    x, velocity = lines["even"]
    q, crank, rod = np.radians(x), 40.0, 120.0
    height = 10.0 - crank * np.sin(q)
    slope = -crank * np.sin(q) + height * crank * np.cos(q) / np.sqrt(rod**2 - height**2)
    assert np.abs(velocity - slope).max() < 1e-9
    alone = gc.build(gc.design({**document, "drive": [{"name": "pair", "pair": OTHER}]}))
    np.testing.assert_allclose(lines["other"][1], next(iter(drawn(alone, "velocity").values()))[1])


def test_the_pressure_angle_of_a_four_bar() -> None:
    """By the law of cosines at the coupler's end."""
    ((x, angle),) = drawn(machine("four-bar"), "pressure_angle").values()
    square = 40.0**2 + 110.0**2 - 2.0 * 40.0 * 110.0 * np.cos(np.radians(x))
    between = np.arccos((120.0**2 + 90.0**2 - square) / (2.0 * 120.0 * 90.0))
    np.testing.assert_allclose(angle, np.abs(90.0 - np.degrees(between)), atol=1e-9)
    (limit,) = machine("four-bar").chart("pressure_angle").limits
    assert limit.value == pytest.approx(45.0)


def test_a_limit_of_the_design_is_drawn_instead() -> None:
    document = {"kind": "mechanism", "name": "drawn", **MACHINES["four-bar"]}
    result = gc.build(gc.design({**document, "limits": {"pressure_angle_deg": 50}}))
    (limit,) = result.chart("pressure_angle").limits
    assert limit.value == pytest.approx(50.0)


def test_what_does_not_change_or_is_not_there_has_no_chart() -> None:
    assert "pressure_angle" not in machine("table on two cams").charts
    assert "path" not in machine("slide behind a pair").charts


def test_the_path_is_drawn_in_the_plane() -> None:
    result = machine("four-bar")
    lines = drawn(result, "path")
    assert [*lines] == ["P", "C"]
    x, y = lines["C"]
    assert np.abs(np.hypot(x - 110.0, y) - 90.0).max() < 1e-9


def test_both_sides_of_a_jump_are_drawn() -> None:
    """The acceleration of a polynomial pair's slide jumps where its ratio has a corner."""
    corner = {"law": {"type": "phases", "shape": "cosine", "knots_deg": [0, 160, 360],
                      "ratios": [1.6, 0.4, 1.6]}, "pair": PAIR["pair"]}  # fmt: skip
    document = {"kind": "mechanism", "name": "drawn", **MACHINES["slide behind a pair"]}
    result = gc.build(gc.design({**document, "drive": [{"name": "pair", "pair": corner}]}))
    ((x, jerk),) = drawn(result, "jerk").values()
    (mark,) = result.chart("jerk").marks
    assert mark.value == pytest.approx(160.0)
    (at,) = np.nonzero(np.isclose(x, 160.0, rtol=0.0, atol=1e-9))
    assert len(at) == 2
    assert abs(np.diff(jerk[at])[0]) > 1.0
    assert math.isclose(x[0], 0.0)


def asked(**more: Any) -> Any:
    """Return the result of the slide behind a pair with other tables."""
    document = {"kind": "mechanism", "name": "drawn", **MACHINES["slide behind a pair"], **more}
    return gc.build(gc.design(document))


def test_rates_are_by_time_where_the_master_has_a_speed() -> None:
    drive = MACHINES["slide behind a pair"]["drive"][0]
    result = asked(drive=[{**drive, "speed_rpm": 90}])
    table = result.motion(np.radians(next(iter(drawn(result, "velocity").values()))[0]))
    for chart, column, unit in (
        ("velocity", "C_mm_s", "mm/s"), ("acceleration", "C_mm_s2", "mm/s2"),
        ("jerk", "C_mm_s3", "mm/s3"),
    ):  # fmt: skip
        ((_, y),) = drawn(result, chart).values()
        np.testing.assert_allclose(y, table[column], rtol=1e-12, atol=1e-7)
        assert result.chart(chart).y.endswith(f", {unit}")


def test_charts_of_what_is_asked_for_first_lead() -> None:
    turning = ("direction", "angular_velocity", "angular_acceleration")
    lengths = ("motion", "velocity", "acceleration")
    for outputs, first in ((["rod.angle", "C"], turning), (["C", "rod.angle"], lengths)):
        names = asked(output={"outputs": outputs}).charts
        assert names[:3] == first
        assert len(names) == len({*names})
        assert {*turning, *lengths} < {*names}


def test_intervals_over_the_end_of_a_turn_are_marked_at_both_ends() -> None:
    """One convention: a range begins within the turn, as the table of loads has it."""
    given = MACHINES["slide behind a pair"]["crank"][0]
    crank = {**given, "angle_deg": given.get("angle_deg", 0) - 10}
    interval = [
        {"on": "C", "travel_mm": 10, "before": before} for before in ("outer", "inner")
    ]  # fmt: skip
    result = asked(crank=[crank], interval=interval)
    marks = [one.value for one in result.chart("motion").marks if one.label.startswith("last bit")]
    assert len(marks) == 4
    assert all(0.0 <= one <= 360.0 for one in marks)
    for one, ends in zip(result.intervals, (marks[:2], marks[2:]), strict=True):
        assert 0.0 <= one.begin < math.tau
        places = result.output("C", np.radians(ends))["C_mm"]
        assert abs(np.diff(places)[0]) == pytest.approx(10.0)
    assert any(one.end > math.tau for one in result.intervals)


def test_a_drive_has_one_name() -> None:
    load = [{"on": "C", "force_n": -100}]
    result = asked(compare=[{"name": "even", "even": True}], load=load, output={
        "files": ["csv"], "outputs": ["C"], "studies": ["torque"]})  # fmt: skip
    names = ["pair", "even"]
    assert [*drawn(result, "velocity")] == names
    assert [*drawn(result, "torque.torque")] == names
    assert list(dict.fromkeys(result.comparison()["drive"])) == names
