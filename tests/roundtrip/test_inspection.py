"""Inspection points lie on the flanks as made, with the outward normals of the metal."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcam.kinds.gear_pair.design import PairOutputSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.parts.blank import Blank
from helpers_files import table
from helpers_pairs import profile


def job(name: str, count: int = 7, **blank: Any) -> GearPairResult:
    design = replace(
        profile(name).design,
        blank=Blank(**blank),
        output=PairOutputSpec(files=("inspection",), inspection_points=count),
    )
    return GearPairResult(design)


def read(made: GearPairResult) -> dict[str, np.ndarray]:
    """The file, by the standard library's reader."""
    return table(made.files("inspection")["inspection.csv"])


def distances(made: GearPairResult, rows: dict[str, np.ndarray], wheel: int) -> np.ndarray:
    """Of a wheel's points from the outline of its part."""
    from shapely import LinearRing, points

    ring = LinearRing(made.parts[wheel - 1].contour.vertices)
    here = rows["wheel"] == wheel
    return np.asarray(ring.distance(points(rows["x_mm"][here], rows["y_mm"][here])))


@pytest.mark.parametrize(
    ("name", "blank"),
    [
        ("nail_machine_two_phase", {}),
        ("nail_machine_two_phase", {"clearance": (0.15, 0.1), "tip_rounding": (0.4, 0.0)}),
        ("furnace_door", {}),
        ("ellipse", {"clearance": (0.05, 0.05)}),
    ],
)
def test_points_lie_on_the_part(name: str, blank: dict[str, Any]) -> None:
    made = job(name, **blank)
    rows = read(made)
    for gear in made.gears:
        away = distances(made, rows, gear.wheel)
        assert len(away) == 7 * 2 * len(
            range(*gear.toothing.whole.indices(len(gear.toothing.numbers)))
        )
        assert np.max(away) < 2 * gear.profile.chord_error


def test_points_of_another_clearance_do_not() -> None:
    made, other = job("ellipse"), job("ellipse", clearance=(0.004, 0.004))
    assert distances(other, read(made), 1).min() > 0.003


def test_normals_point_out_of_the_metal_and_stand_on_the_flanks() -> None:
    from shapely import Polygon, contains_xy

    made = job("nail_machine_two_phase", 65)
    rows = read(made)
    assert np.hypot(rows["nx"], rows["ny"]) == pytest.approx(1.0, abs=1e-14)
    for wheel, gear in enumerate(made.gears, start=1):
        here = rows["wheel"] == wheel
        x, y, nx, ny = (rows[key][here] for key in ("x_mm", "y_mm", "nx", "ny"))
        metal = Polygon(gear.outline)
        inner = (rows["point"][here] > 1) & (rows["point"][here] < 65)
        assert contains_xy(metal, x - 0.01 * nx, y - 0.01 * ny)[inner].all()
        assert not contains_xy(metal, x + 0.01 * nx, y + 0.01 * ny)[inner].any()
        # along a flank the chord between neighbours stands on the mean of their normals
        step = np.stack([np.diff(x), np.diff(y)]).T.reshape(-1, 2)
        mean = np.stack([nx[1:] + nx[:-1], ny[1:] + ny[:-1]]).T
        same = np.diff(rows["point"][here]) == 1
        lean = np.abs((step * mean).sum(axis=1)[same]) / np.hypot(*step[same].T)
        assert lean.max() < 4e-3
        # from root to tip
        radius = np.hypot(x, y)
        assert (np.diff(radius)[same] > 0).mean() > 0.95


def test_sides_and_teeth_are_told_apart() -> None:
    made = job("ellipse")
    rows = read(made)
    first = (rows["wheel"] == 1) & (rows["tooth"] == 1)
    # tooth 1 of wheel 1 is centred on the x axis, its + side is at rising angle
    assert (rows["y_mm"][first & (rows["side"] == 1)] > 0).all()
    assert (rows["y_mm"][first & (rows["side"] == -1)] < 0).all()
    assert set(rows["tooth"]) == set(range(1, 42))
    assert set(rows["step"]) == {1}


def test_rounded_tips_have_no_points() -> None:
    plain, round_ = job("ellipse"), job("ellipse", tip_rounding=0.2)
    reach = [np.hypot(r["x_mm"], r["y_mm"]).max() for r in (read(plain), read(round_))]
    assert 0.1 < reach[0] - reach[1] < 0.2


def test_the_command_writes_the_file(tmp_path: Path) -> None:
    written = job("ellipse").write(tmp_path)
    assert written.files == ("inspection.csv", "measures.csv", "summary.json")


def test_measures_are_a_row_for_each_tooth() -> None:
    made = job("ellipse", clearance=(0.05, 0.02))
    rows = table(made.files("inspection")["measures.csv"])
    assert list(rows["tooth"]) == 2 * [*range(1, 42)]
    assert list(rows["wheel"]) == 41 * [1] + 41 * [2]
    for wheel in (1, 2):
        columns = made.measures(wheel)
        for name, values in columns.items():
            read_back = rows[name][rows["wheel"] == wheel]
            np.testing.assert_allclose(read_back, values, rtol=1e-14, err_msg=name)
    over = [one.measures(1, 1.75)["over_pins_mm"] for one in (made, job("ellipse"))]
    thinner = over[0] - over[1]
    # 0.05 mm off each flank lowers a pin by its share over sin(alpha), on both sides
    assert thinner == pytest.approx(-2 * 0.05 / np.sin(np.radians(20)), rel=0.25)


def test_whole_numbers_have_no_point() -> None:
    made = job("ellipse")
    for name, data in made.files("inspection").items():
        head, *rows = (line.split(",") for line in data.decode().splitlines())
        whole = {"wheel", "step", "tooth", "side", "point", "opposite", "span_teeth"} & {*head}
        assert len(whole) == 5
        for column in whole:
            cells = {row[head.index(column)] for row in rows}
            assert not [one for one in cells if "." in one], (name, column)


def test_rows_of_open_wheels_and_steps() -> None:
    door = table(job("furnace_door").files("inspection")["measures.csv"])
    first = door["wheel"] == 1
    assert np.isnan(door["over_pins_mm"]).all()
    assert np.isnan(door["center_radius_mm"][first]).sum() == 1  # after the last tooth
    steps = table(job("stepped_ellipse").files("inspection")["measures.csv"])
    assert set(steps["step"]) == {1, 2, 3, 4}
    one = [steps["center_radius_mm"][(steps["step"] == k) & (steps["wheel"] == 1)] for k in (1, 2)]
    assert np.abs(one[0] - one[1]).max() > 0.01  # teeth of each step lie elsewhere


def test_nothing_is_measured_unless_it_is_asked_for() -> None:
    plain = GearPairResult(replace(profile("ellipse").design, output=PairOutputSpec()))
    assert not any("measuring" in name for name in plain.facts)
    assert plain.findings
    assert "measuring" not in vars(plain.gear1)
    asked = GearPairResult(
        replace(plain.design, output=PairOutputSpec(pin_diameter=(1.75, 2.0), files=("csv",)))
    )
    assert asked.facts["gears.1.measuring.pin_diameter_mm"] == 2.0
    assert asked.facts["gears.0.measuring.spans.0.teeth"] == 5
    assert asked.facts["gears.0.measuring.over_pins_mm"]["max"] == pytest.approx(44.4238, abs=1e-4)


def test_drawings_say_what_is_measured() -> None:
    made = GearPairResult(
        replace(profile("circular").design, output=PairOutputSpec(files=("drawing-svg",)))
    )
    text = made.files("drawing-svg")["gear1_drawing.svg"].decode()
    for words in ("measuring pin", "over pins, all spaces", "constant chord", "span over 3 teeth"):
        assert words in text
