"""What results give as data: one computation with the files, refused by name, ready for frames."""

from __future__ import annotations

import json
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.kinds.cam.result import CamResult
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.numeric.columns import Columns
from gearcam.parts.solids import volume_error
from helpers_built import built
from helpers_files import ROLLER, table
from helpers_pairs import PROFILES, job, profile
from helpers_sampling import few


@pytest.fixture(scope="module")
def pair() -> GearPairResult:
    return job(Ellipse(eccentricity=0.2), (20, 20), module=2.0, tolerance=0.01)


@pytest.fixture(scope="module")
def cam() -> CamResult:
    return gearcam.build(gearcam.loads(ROLLER))


def tables(pair: GearPairResult, cam: CamResult) -> dict[str, Columns]:
    return {
        "centrodes": pair.centrodes(),
        "motion": pair.motion(),
        "contact": pair.contact(),
        "contact ratios": pair.contact_ratios,
        "flanks": pair.gear2.flanks,
        "mesh": pair.mesh(steps=3, to_deg=10).columns,
        "cam": cam.motion(),
        "cam contact": cam.contact(),
        "followed": cam.follow(cam.profile.vertices).columns,
    }


def test_every_table_is_of_plain_columns_of_one_length(
    pair: GearPairResult, cam: CamResult
) -> None:
    for name, columns in tables(pair, cam).items():
        lengths = {values.shape for values in columns.values()}
        assert len(lengths) == 1, name
        assert len(lengths.pop()) == 1, name
        for values in columns.values():
            assert type(values) is np.ndarray
            assert values.dtype.kind in "if"
        again = pickle.loads(pickle.dumps(columns))
        assert type(again) is Columns
        for key, values in columns.items():
            np.testing.assert_array_equal(again[key], values)


def test_frames_take_every_table(pair: GearPairResult, cam: CamResult) -> None:
    for columns in tables(pair, cam).values():
        frame = pl.DataFrame(columns)
        assert list(frame.columns) == list(columns)
        for key, values in columns.items():
            np.testing.assert_array_equal(frame[key].to_numpy(), values)


@pytest.mark.parametrize("name", ["ellipse", "feeder", "press"])
def test_centrodes_are_those_of_the_file(name: str) -> None:
    result = profile(name)
    rows, found = table(result.files("csv")["centrodes.csv"]), result.centrodes()
    assert set(found) - set(rows) == {"x1_mm", "y1_mm", "x2_mm", "y2_mm"}
    for key, values in rows.items():
        np.testing.assert_allclose(found[key], values, rtol=1e-15, atol=1e-300)


def test_the_motion_of_a_cam_is_that_of_the_file(cam: CamResult) -> None:
    rows = table(cam.files("csv")["motion.csv"])
    names = ["theta_deg", "s", "ds", "d2s", "d3s", "pressure_angle_deg"]
    assert list(rows) == [*names, "rho_pitch_mm", "rho_profile_mm"]
    for one, two in zip(rows.values(), cam.motion().values(), strict=True):
        np.testing.assert_allclose(two, one, rtol=1e-15, atol=1e-300)


def test_all_parts_have_an_outline(pair: GearPairResult, cam: CamResult) -> None:
    for part in (pair.gear1, pair.gear2, *pair.parts, cam.cam, *cam.parts):
        assert part.outline.ndim == 2
        assert part.outline.shape[1] == 2
        x, y = part.outline.T
        assert np.dot(x, np.roll(y, -1)) > np.dot(y, np.roll(x, -1))  # counter-clockwise
    np.testing.assert_array_equal(cam.cam.outline, cam.profile.vertices)
    np.testing.assert_array_equal(pair.gear1.outline, pair.parts[0].outline)


def test_the_outline_of_a_part_is_as_made(cam: CamResult) -> None:
    made = gearcam.build(cam.design.with_({"blank.clearance_mm": 0.5}))
    (part,) = made.parts
    np.testing.assert_array_equal(part.outline, made.contour.vertices)
    assert made.cam.outline.max() == pytest.approx(part.outline.max() + 0.5, abs=0.1)


Call = Callable[[GearPairResult, CamResult], object]


@pytest.mark.parametrize(
    ("call", "key", "words"),
    [
        (lambda pair, _: pair.centrodes(1), "n", "1 is out of range"),
        (lambda pair, _: pair.centrodes(2.5), "n", "2.5 is not a whole number"),
        (lambda pair, _: pair.centrodes(True), "n", "True is out of range"),
        (lambda pair, _: pair.motion("now"), "phi1", "'now' is not a number"),
        (lambda pair, _: pair.motion([[1.0]]), "phi1", "the shape (1, 1)"),
        (lambda pair, _: pair.contact([0.0, math.nan]), "phi1", "nan is out of range"),
        (lambda pair, _: pair.contact(0.0, side="left"), "side", "'left' is not known here"),
        (lambda pair, _: pair.gear1.flank_points(1), "count", "a whole number, 2 or more"),
        (lambda pair, _: pair.mesh(steps=0), "meshing.steps", "0 is out of range"),
        (lambda pair, _: pair.mesh(step_s=9), "meshing.step_s", "did you mean steps?"),
        (lambda _, cam: cam.motion(math.inf), "theta", "inf is out of range"),
        (lambda _, cam: cam.contact("top"), "theta", "'top' is not a number"),
        (lambda _, cam: cam.follow([[0.0, 1.0]]), "profile", "the shape (1, 2)"),
        (lambda _, cam: cam.follow([[0, 1], [1, "x"]]), "profile", "is not an array of numbers"),
        (lambda _, cam: cam.follow([[0, 1], [1, 0], [math.nan, 0]]), "profile", "not finite"),
    ],
)
def test_bad_arguments_are_refused_by_name(
    call: Call, key: str, words: str, pair: GearPairResult, cam: CamResult
) -> None:
    with pytest.raises(DesignError) as caught:
        call(pair, cam)
    (problem,) = caught.value.problems
    assert problem.key == key
    assert words in str(problem)


def test_an_open_pair_is_asked_within_its_travel() -> None:
    result = profile("log_spiral")
    end = result.law.period
    for call in (result.motion, result.contact):
        assert len(call([0.0, end * (1.0 + 1e-13)])["phi1_deg"]) > 1
        for beyond in (-1e-6, end + 1e-6):
            with pytest.raises(DesignError, match=r"phi1: .* is out of range"):
                call(beyond)


def test_a_number_is_a_phase(pair: GearPairResult) -> None:
    assert pair.motion(1.0)["phi1_deg"].shape == (1,)
    assert set(pair.contact(1.0)["phi1_deg"]) == {math.degrees(1.0)}


def test_a_study_is_data_that_may_be_written(pair: GearPairResult, tmp_path: Path) -> None:
    study = pair.mesh(steps=6, to_deg=30)
    assert not list(tmp_path.iterdir())
    assert study.complete
    assert study.facts["meshing.steps"] == 6
    assert study.to_dict()["meshing"]["steps_done"] == 6
    assert study.facts.document["mesh"] == pair.facts.document["mesh"]
    written = study.write(tmp_path)
    rows = table((written.directory / "meshing.csv").read_bytes())
    assert list(rows) == list(study.columns)
    for key, values in study.columns.items():
        np.testing.assert_allclose(values, rows[key], rtol=1e-15, atol=1e-300)
    assert np.isnan(study.columns["pressure_angle_deg"][study.columns["carries"] == 0.0]).all()
    assert written.findings == study.findings
    assert written.summary["design"]["meshing"]["steps"] == 6
    back = pickle.loads(pickle.dumps(study))
    np.testing.assert_array_equal(back.columns["depth_mm"], study.columns["depth_mm"])


def test_other_settings_of_a_study_leave_the_wheels_as_they_are(pair: GearPairResult) -> None:
    design, distance = pair.design, pair.pair.center_distance
    far = pair.mesh(steps=4, to_deg=20, center_distance_mm=distance + 0.3)
    near = pair.mesh(steps=4, to_deg=20)
    assert pair.design is design
    assert far.result is not pair
    assert far.result.gear1 is pair.gear1  # pyright: ignore[reportAttributeAccessIssue]
    assert far.facts["meshing.center_distance_mm"] == pytest.approx(distance + 0.3)
    assert near.facts["meshing.center_distance_mm"] == pytest.approx(distance)
    changes = {"meshing.steps": 4, "meshing.to_deg": 20}
    other = gearcam.build(design.with_(changes)).mesh()
    for key, values in near.columns.items():
        np.testing.assert_array_equal(other.columns[key], values)


@pytest.mark.parametrize("name", ["ellipse", "plate_cam_offset_roller"])
def test_other_chords_give_the_outlines_of_a_design_that_has_them(name: str) -> None:
    design: Any = gearcam.load(PROFILES / f"{name}.toml")
    result = gearcam.build(design)
    coarse = result.with_chords(0.02)
    asked = gearcam.build(design.with_({"output.chord_tolerance_mm": 0.02}))
    assert coarse.design == asked.design
    for part, same, fine in zip(coarse.parts, asked.parts, result.parts, strict=True):
        np.testing.assert_array_equal(part.contour.vertices, same.contour.vertices)
        assert len(part.contour.vertices) < len(fine.contour.vertices)
    for stage in result.before_output:
        assert getattr(coarse, stage) is getattr(result, stage)


def test_a_profile_is_followed_from_points_as_from_a_file(cam: CamResult, tmp_path: Path) -> None:
    points = cam.profile.vertices
    path = tmp_path / "given.csv"
    text = "\n".join(f"{x!r},{y!r}" for x, y in points.tolist())
    path.write_text(f"x_mm,y_mm\n{text}\n", encoding="ascii")
    one, two = cam.follow(points), cam.follow(str(path))
    closed = cam.follow(np.vstack([points, points[:1]]))
    for key, values in one.columns.items():
        np.testing.assert_array_equal(two.columns[key], values)
        np.testing.assert_array_equal(closed.columns[key], values)
    assert (
        one.facts["followed.largest_difference"]
        == one.columns["difference"][np.abs(one.columns["difference"]).argmax()]
    )


@pytest.mark.parametrize("name", ["ellipse", "plate_cam_offset_roller"])
def test_a_dictionary_is_what_the_summary_holds(name: str, tmp_path: Path) -> None:
    result = gearcam.build(gearcam.load(PROFILES / f"{name}.toml"))
    result.check(tmp_path)
    summary = json.loads((tmp_path / name / "summary.json").read_text("utf-8"))
    found = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    for one in (summary, found):
        one.pop("timings_s")
    assert summary.pop("files") == {}
    assert found["hash"] == result.design_hash
    assert {"format", "kind", "findings", "versions", "design"} <= set(found)
    assert found == summary


@pytest.mark.parametrize("name", few(["ellipse", "stepped_ellipse", "eccentric_cam"]))
def test_solids_are_the_parts(name: str) -> None:
    result = built(PROFILES / f"{name}.toml")
    solids = result.solids
    assert list(solids) == [part.name for part in result.parts]
    for part in result.parts:
        body = solids[part.name]
        assert body.is_watertight
        assert abs(body.volume - part.volume) <= volume_error(part)
        assert body.bounds[1][2] - body.bounds[0][2] == pytest.approx(part.thickness)


def test_what_cannot_be_made_has_no_data() -> None:
    result = job(Ellipse(eccentricity=0.9), (8, 8), module=2.0)
    for ask in (lambda: result.contact(0.0), lambda: result.contact_ratio, lambda: result.solids):
        with pytest.raises(InfeasibleError):
            ask()


def test_absent_values_of_whole_numbers_are_not_a_number() -> None:
    found = Columns({"tooth": np.ma.array([1, 2], mask=[False, True]), "side": np.ma.array([1, 1])})
    assert found["tooth"][0] == 1.0
    assert np.isnan(found["tooth"][1])
    assert type(found["side"]) is np.ndarray


def test_a_study_with_other_settings_belongs_to_another_design(tmp_path: Path) -> None:
    made = job(Ellipse(eccentricity=0.2), (20, 20), module=2.0, tolerance=0.01)
    before, gear = made.design, made.gear1
    study = made.mesh(steps=24)
    other: Any = study.result
    assert other.design == before.with_({"meshing.steps": 24}) != before
    assert study.write(tmp_path).summary["design"]["meshing"]["steps"] == 24
    assert made.design is before
    assert "meshing" not in made.timings
    assert other.gear1 is gear  # what the settings do not change is made once


@pytest.mark.parametrize("name", ["nail_machine_two_phase", "feeder", "valve_lever"])
def test_facts_are_plain_numbers(name: str) -> None:
    def kinds(value: Any) -> set[type]:
        if isinstance(value, dict):
            value = list(value.values())
        return set().union(*map(kinds, value)) if isinstance(value, list) else {type(value)}

    found = built(PROFILES / f"{name}.toml").facts.document
    assert kinds(found) <= {int, float, str, bool}


def test_facts_of_functions_are_plain_numbers() -> None:
    law = gearcam.laws.Formula(phi2=lambda phi1: phi1 - 0.3 * np.sin(phi1))
    made = job(law, (20, 20), module=2.0, tolerance=0.01)
    assert type(made.facts["accuracy.driven_angle_rad"]) is float
