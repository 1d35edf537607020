"""What a page draws, as JSON holds it: nothing lost that is seen, nothing that JSON has not."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gearcam
from arch import rules
from gearcam.base.readable import readable
from gearcam.numeric.pose import Pose
from gearcam.pictures.charts import Chart, Limit, Line, MarkedPlace
from gearcam.pictures.drawings import CENTRODE, OUTLINE, Feature, Path
from gearcam.pictures.scenes import ColouredCurve, ContactPoints, JointForce, MovingBody, Scene
from gearcam.report.data import chart_data, scene_data
from gearcam.report.page import blocks
from helpers_built import built

NAMES = ("ellipse", "ring_ellipse", "feeder", "stepped_ellipse", "groove_cam", "conjugate_cams")


def made(name: str) -> tuple[Any, Scene]:
    result = built(rules.ROOT / "profiles" / f"{name}.toml")
    return result, result.scene(24)


def read(data: Any) -> Any:
    """Return data as a page reads it; JSON knows no NaN."""
    return json.loads(json.dumps(data, allow_nan=False))


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_is_read_back_to_its_decimals(name):
    _, scene = made(name)
    data = read(scene_data(scene))
    assert data["places"] == pytest.approx(scene.places, abs=5.1e-5)
    assert [one["name"] for one in data["bodies"]] == [body.name for body in scene.bodies]
    for told, body in zip(data["bodies"], scene.bodies, strict=True):
        for key, values, digits in (
            ("turn", body.pose.turn, 7),
            ("x", body.pose.shift.real, 4),
            ("y", body.pose.shift.imag, 4),
        ):
            # one number where nothing changes
            assert isinstance(told[key], float) == (np.ptp(values) == 0.0)
            assert np.asarray(told[key]) + 0.0 * values == pytest.approx(
                values, abs=0.51 * 10.0**-digits
            )
        assert told["teeth"] == (None if body.teeth is None else body.teeth.tolist())
    for key, contacts in scene.contacts.items():
        told = data["contacts"][key]
        assert told["start"] == contacts.start.tolist()
        point = np.array(told["x"]) + 1j * np.array(told["y"])
        assert np.abs(point - contacts.point).max() < 1e-4
        force = np.array(told["fx"]) + 1j * np.array(told["fy"])
        assert np.abs(force - contacts.force).max() < 1e-6


@pytest.mark.parametrize("name", ["ellipse", "ring_ellipse", "feeder"])
def test_teeth_are_vertices_of_the_first_chain_of_metal(name):
    result, scene = made(name)
    data = read(scene_data(scene))
    toothed = [one for one in data["bodies"] if one["teeth"]]
    for told in toothed:
        gear = next(gear for gear in result.gears if gear.name == told["name"])
        assert told["metal"][0] == pytest.approx(gear.outline.ravel(), abs=5.1e-5)
        assert max(map(max, told["teeth"])) < len(gear.outline)


def test_a_groove_is_a_floor_and_centrodes_are_dashed():
    groove = read(scene_data(made("groove_cam")[1]))["bodies"][0]
    assert len(groove["floor"]) == 2  # its outer wall and the island within
    assert len(groove["metal"]) == 2  # the disc and its bore
    lines = read(scene_data(made("ellipse")[1]))["bodies"][0]["lines"]
    (centrode,) = (one for one in lines if one["layer"] == CENTRODE)
    assert centrode["dashed"] is True
    assert centrode["closed"] is True


def test_what_is_no_number_is_null_and_nothing_is_minus_zero():
    places = np.array([0.0, 1.0])
    square = Path(points=np.array([complex(-0.0, 0.0), 1.0, 1.0 + 1.0j]))
    body = MovingBody(
        name="a",
        called="a",
        features=(Feature(layer=OUTLINE, shape=square),),
        pose=Pose(np.array([-0.0, 1e-9]), np.zeros(2, dtype=np.complex128)),
    )
    contacts = ContactPoints(
        start=np.array([0, 1, 1]),
        point=np.array([complex(math.nan, 1.0)]),
        force=np.array([1.0 + 0j]),
    )
    scene = Scene(
        title="t",
        driver="x, mm",
        places=places,
        closed=False,
        bodies=(body,),
        contacts={"all": contacts},
        pitch=np.array([complex(math.inf, 0.0), 1.0]),
    )
    data = read(scene_data(scene))
    assert data["pitch"] == [None, 0.0, 1.0, 0.0]
    assert data["contacts"]["all"]["x"] == [None]
    assert "-0.0" not in json.dumps(data)


def test_forces_are_shares_of_the_largest():
    scene = replace(made("ellipse")[1], contacts={})
    n = len(scene.places)
    forces = [(3.0 + 4.0j, "B"), (math.nan, "C"), (-10.0j, "D")]
    arrows = tuple(
        JointForce(name=name, point=np.full(n, 1.0 + 2.0j), force=np.full(n, complex(force)))
        for force, name in forces
    )
    data = read(scene_data(replace(scene, forces=arrows)))
    assert [(one["name"], one["fx"][0], one["fy"][0]) for one in data["forces"]] == [
        ("B", 0.3, 0.4), ("C", None, None), ("D", 0.0, -1.0)
    ]  # fmt: skip
    assert (data["forces"][0]["x"][0], data["forces"][0]["y"][0]) == (1.0, 2.0)
    assert data["largest_force"] == "10 N"
    with pytest.raises(ValueError, match="B: needs a force for each place"):
        replace(scene, forces=(replace(arrows[0], force=np.zeros(3, dtype=complex)),))
    assert read(scene_data(scene))["largest_force"] is None


def test_curves_of_one_quantity_share_a_scale():
    """That ends at the largest value on any of them, and tells where this is."""
    label, points = "contact pressure, MPa", np.array([1.0, 2.0 + 1j, complex(math.nan, 0.0)])
    curves = [
        ColouredCurve(
            body=body,
            places=np.array([0.0, start, 9.0]),
            points=points + shift,
            values={label: np.array(values)},
        )
        for body, start, shift, values in (
            ("a", 4.0, 0j, [300.0, 100.0 / 3.0, math.nan]),
            ("b", 5.0, 10j, [math.nan, 400.0, math.nan]),
        )
    ]
    data = read(scene_data(replace(made("ellipse")[1], coloured=tuple(curves))))
    first, second = data["coloured"]
    assert first["values"][label] == [300.0, 33.333, None]
    assert second["values"][label] == [None, 400.0, None]
    assert (first["body"], first["points"][:4]) == ("a", [1.0, 0.0, 2.0, 1.0])
    scale = {"least": 33.333, "largest": 400.0, "place": 5.0, "body": "b", "x": 2.0, "y": 11.0}
    scale["told"] = ["33.3", "400.0 MPa"]
    assert data["scales"] == {label: scale}


def test_a_chart_is_read_back_to_six_digits():
    y = np.array([1.23456789e-5, np.nan, -9.87654321e-3, 0.0])
    line = Line(label="values", x=np.array([0.0, 1.0, 2.0, 359.123456789]), y=y)
    far = (Limit(label="near", value=0.0), Limit(label="far", value=1.0))
    marks = (MarkedPlace(label="knots", value=2.0),)
    chart = Chart(title="t", x="angle, deg", y="1/mm", lines=(line,), limits=far, marks=marks)
    data = read(chart_data("c", chart, "angle, deg"))
    told = data["lines"][0]
    assert told["x"] == [0.0, 1.0, 2.0, 359.123]
    assert told["y"] == [1.235e-5, None, -9.87654e-3, 0.0]
    assert data["range"] == list(chart.range)
    assert np.ravel(data["ends"]) == pytest.approx(np.ravel(chart.ends), rel=1e-11)
    assert [one["seen"] for one in data["limits"]] == [True, False]
    assert data["marks"] == [{"label": "knots", "value": 2.0}]
    assert data["moves"] is True
    assert chart_data("c", chart, "another, deg")["moves"] is False


def test_on_a_logarithmic_axis_each_value_has_six_digits():
    """And what has no logarithm is left out, on this axis only."""
    x, y = (
        np.array([0.0, 1.0, 2.0, 3.0, 4.0]),
        np.array([1.23456789e-5, 987654321.0, 0.0, -1, np.nan]),
    )
    line = Line(label="values", x=x, y=y)
    data = read(chart_data("c", Chart(title="t", x="x", y="y", lines=(line,), log="y"), ""))
    assert data["lines"][0]["x"] == x.tolist()
    assert data["lines"][0]["y"] == [1.23457e-5, 987654000.0, None, None, None]
    assert data["log"] == "y"


@pytest.mark.parametrize("name", NAMES)
def test_every_chart_of_a_result_is_json(name):
    result, scene = made(name)
    for one in result.charts:
        chart = result.chart(one)
        data = read(chart_data(one, chart, scene.driver))
        for told, line in zip(data["lines"], chart.lines, strict=True):
            y = np.array([math.nan if value is None else value for value in told["y"]])
            y /= data["factor"]
            assert np.isnan(y).tolist() == (~np.isfinite(line.y)).tolist()
            largest = np.nanmax(np.abs(line.y), initial=0.0)
            assert np.nanmax(np.abs(y - line.y), initial=0.0) <= 1e-5 * largest


DRIVEN, OUTLINES = "driven angle", ["outlines, between their points"]
WEIGHED = ["area", "volume (mass in the same proportion)"]


@pytest.mark.parametrize(
    ("name", "labels"),
    [
        ("ellipse", [DRIVEN, "points of the flanks", *OUTLINES, "contact ratio"]),
        ("feeder", ["rack travel", "points of the flanks", *OUTLINES, "contact ratio"]),
        ("shop_order", [DRIVEN, "points of the flanks", *OUTLINES, "contact ratio", *WEIGHED]),
        ("groove_cam", ["lift of the follower", "points of the profile", *OUTLINES]),
        ("lathe_slide", ["lift of the follower", "points of the profile", *OUTLINES, *WEIGHED]),
    ],
)
def test_accuracy_is_one_number_for_each_thing_that_people_act_on(name, labels):
    result, _ = made(name)
    html = blocks(result)["accuracy"]
    rows = dict(re.findall(r'<th scope="row">(.+?)</th><td class="number">(.+?)</td>', html))
    assert list(rows) == labels
    chord = result.facts["accuracy.chord_mm"]
    assert rows[OUTLINES[0]] == readable(chord, "mm", digits=2)


def test_of_several_walls_the_largest_error_is_shown():
    result, _ = made("groove_cam")
    result = gearcam.build(result.design.with_({"blank.density_kg_m3": 7850}))
    areas = [result.facts[f"accuracy.{wall}_area_mm2"] for wall in ("inner", "outer")]
    html = blocks(result)["accuracy"]
    assert f'>area</th><td class="number">{readable(max(areas), "mm2", digits=2)}<' in html


def test_solids_that_move_in_space_are_told() -> None:
    _, scene = made("cylinder_cam")
    data = read(scene_data(scene))
    assert (data["eye"], data["up"]) == ([1.0, -0.8, 0.6], [0.0, 0.0, 1.0])
    assert [*data["solids"]] == ["cam", "roller"]
    for name, pose in scene.in_space.items():
        told = data["solids"][name]
        assert told["axis"] == list(pose.axis)
        assert told["turn"] + 0.0 * pose.turn == pytest.approx(pose.turn, abs=0.51e-7)
        for key, values in zip("xyz", pose.shift.T, strict=True):
            assert told[key] + 0.0 * values == pytest.approx(values, abs=0.51e-4)
    # the roller stands at its lift, which is known in the middle of rise and dwell
    assert data["solids"]["roller"]["turn"] == 0.0
    assert data["solids"]["roller"]["z"][5] == pytest.approx(25.0 + 30.0)
    assert data["solids"]["roller"]["z"][11] == 25.0 + 60.0
    assert data["solids"]["cam"]["turn"][6] == pytest.approx(0.5 * math.pi, abs=1e-7)


def test_a_pose_in_space_is_needed_for_each_place() -> None:
    _, scene = made("cylinder_cam")
    short = {"roller": scene.in_space["roller"][:-1]}
    with pytest.raises(ValueError, match="roller: needs a pose in space for each place"):
        replace(scene, in_space=short)
