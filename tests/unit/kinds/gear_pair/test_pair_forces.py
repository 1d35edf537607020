"""The study of forces of a pair: its file, facts, findings, and what it refuses."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.base.errors import DesignError
from helpers_built import built
from helpers_pairs import PROFILES
from helpers_remedies import CIRCLE, DOOR, ELLIPSE, RING, pair

LOAD = [{"torque_nm": 20}]
RUBBING = {"flank": 0.08, "joint": 0.1, "journal_radius_mm": 5, "rolling_mm": 0.01}
RACK = {"type": "rack", "r1": "20 + 3*cos(phi1)"}


def study(law: Mapping[str, Any], teeth: list[int], load: Any = LOAD, **tables: Any) -> Any:
    document = pair(law, teeth, load=load, **tables)
    return gearcam.build(gearcam.design(document)).study("forces")


PAIRS: dict[str, Any] = {
    "closed": (ELLIPSE, [24, 24], {}),
    "with backlash": (ELLIPSE, [24, 24], {"pair": {"backlash_mm": 0.1}}),
    "open": (DOOR, [30, 30], {}),
    "a ring": (CIRCLE, [20, 50], {"pair": RING}),
    "stepped": (ELLIPSE, [24, 24], {"steps": {"count": 3}}),
}


@pytest.mark.parametrize("name", PAIRS)
def test_every_pair_has_forces(name: str) -> None:
    """Loads, losses and powers agree; the sum of the tooth forces has the load's moment."""
    law, teeth, tables = PAIRS[name]
    made = study(law, teeth, friction=RUBBING, **tables)
    table = made.columns
    assert (table["load_nm"] == 20.0).all()
    assert 0.9 < made.facts["forces.efficiency.overall"] < 1.0
    assert made.facts["forces.power_balance"] < 1e-12
    # forces on the driven element, about its shaft, against its journal and rolling
    result = made.result
    at = table["x_mm"] + 1j * table["y_mm"] - result.pair.shift
    push = table["force_x_n"] + 1j * table["force_y_n"]
    turn = -1.0 if name == "a ring" else 1.0
    moment = turn * np.imag(np.conj(at) * push) - 0.01 * table["normal_n"]
    row = table["phase"].astype(int) - 1
    held = np.zeros(row.max() + 1)
    held[row] = table["bearing_n"]
    journal = 5.0 * np.sin(np.arctan(0.1)) * held
    if name != "a ring":  # there rolling helps
        assert np.bincount(row, moment) - journal == pytest.approx(20_000.0, rel=1e-9)


def test_a_rack_is_pushed(tmp_path: Any) -> None:
    made = study(RACK, [20, 20], load=[{"force_n": 100}], friction={"flank": 0.1})
    table = made.columns
    assert {"travel_mm", "load_n"} <= {*table}
    along = np.bincount(table["phase"].astype(int) - 1, table["force_y_n"])
    assert np.abs(along) == pytest.approx(100.0, rel=1e-9)
    assert "guide of the rack" in made.facts["forces.friction"]
    assert "forces.csv" in made.write(tmp_path).files


def test_the_torque_of_the_driver_may_be_given() -> None:
    """The load that it balances is then stated."""
    first = study(ELLIPSE, [24, 24], friction=RUBBING)
    _, at = np.unique(first.columns["phase"], return_index=True)
    phi1, torque = (first.columns[name][at].tolist() for name in ("phi1_deg", "torque_nm"))
    given = {"on": "wheel1", "table": torque, "at_deg": phi1}
    made = study(ELLIPSE, [24, 24], load=[given], friction=RUBBING)
    # straight lines lie between the rows, and degrees are rounded beside jumps
    off = np.abs(made.columns["load_nm"] - 20.0)
    assert np.median(off) < 1e-9
    assert np.quantile(off, 0.9) < 1e-3


def test_loads_add_up_and_may_be_of_a_part_of_the_turn() -> None:
    loads = [{"torque_nm": 5}, {"formula": "2*cos(phi1)"},
             {"torque_nm": 3, "from_deg": 300, "to_deg": 60}]  # fmt: skip
    table = study(ELLIPSE, [24, 24], load=loads).columns
    phi1 = table["phi1_deg"]
    part = np.where((phi1 <= 60.0) | ((phi1 >= 300.0) & (phi1 < 360.0)) | (phi1 == 360.0), 3.0, 0.0)
    assert table["load_nm"] == pytest.approx(5.0 + 2.0 * np.cos(np.radians(phi1)) + part)


def test_a_load_that_pulls_is_on_the_coast_flanks() -> None:
    made = study(ELLIPSE, [24, 24], load=[{"formula": "20*sin(phi1)"}])
    table = made.columns
    assert (np.sign(table["load_nm"]) == -table["side"])[table["load_nm"] != 0.0].all()
    assert [one.code for one in made.study_findings] == ["load-reverses"]


def test_a_phase_without_contact_has_no_forces() -> None:
    """The row is there, and a finding says so."""
    made = study(ELLIPSE | {"eccentricity": 0.6}, [12, 12])
    table = made.columns
    apart = np.isnan(table["normal_n"])
    assert apart.any()
    assert np.isnan(table["torque_nm"][apart]).all()
    assert "unstated-forces" in {one.code for one in made.study_findings}
    assert "forces.efficiency" not in made.facts


def test_limits_of_pressure_and_torque() -> None:
    limits = {"contact_pressure_mpa": 100, "drive_torque_nm": 10}
    found = {one.code: one for one in study(ELLIPSE, [24, 24], limits=limits).study_findings}
    assert {*found} == {"contact-pressure", "drive-torque"}
    assert found["drive-torque"].limit == 10.0
    assert found["contact-pressure"].value > 100.0
    soft = study(ELLIPSE, [24, 24], material={"yield_mpa": [200, 300]})
    (one,) = soft.study_findings
    assert one.limit == pytest.approx(200.0 / 0.5575, rel=1e-4)


def test_extremes_are_those_between_the_steps_too() -> None:
    """Facts of few steps are those of many."""
    few, many = (
        study(ELLIPSE, [24, 24], friction=RUBBING, forces={"steps": steps}) for steps in (60, 6000)
    )
    for name in ("normal_n", "bearing_n", "torque_nm", "pressure_mpa"):
        for end in ("min", "max"):
            key = f"forces.{name}.{end}"
            assert few.facts[key] == pytest.approx(many.facts[key], rel=1e-6), key


def rows_of(folder: Path, head: str, *rows: str) -> str:
    """The name of a CSV file with these rows."""
    file = folder / "load.csv"
    file.write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    return str(file)


def test_rows_of_a_file_are_joined_by_straight_lines(tmp_path: Path) -> None:
    """Where an angle stands twice the load jumps, and both sides have a phase."""
    head = "phi1_deg,torque_nm,wheel2_torque_nm"
    file = rows_of(tmp_path, head, "0,1,10", "90,1,10", "90,1,30", "360,1,10")
    table = study(ELLIPSE, [24, 24], load=[{"file": file}]).columns
    phi1 = table["phi1_deg"]
    line = np.where(phi1 < 90.0, 10.0, 30.0 - 20.0 * (phi1 - 90.0) / 270.0)
    away = np.abs(phi1 - 90.0) > 1e-9
    assert table["load_nm"][away] == pytest.approx(line[away])
    assert {10.0, 30.0} == {*table["load_nm"][~away].round(9)}
    driver = study(ELLIPSE, [24, 24], load=[{"on": "wheel1", "file": file}]).columns
    assert (driver["torque_nm"] == 1.0).all()


@pytest.mark.parametrize("case", [
    (("phi1_deg,force_n", "0,1", "360,1"), "acts on a wheel"),
    (("phi1_deg,power_w", "0,1", "360,1"), "torque_nm"),
    (("phi1_deg,torque_nm", "0,1", "90,1", "80,1"), "line 4: phi1_deg falls"),
    (("phi1_deg,torque_nm", "0,1", "300,1"), "ends inside the turn"),
    (("phi1_deg,torque_nm", "10,1", "360,1"), "begin inside the turn"),
])  # fmt: skip
def test_files_that_are_refused(case: tuple[tuple[str, ...], str], tmp_path: Path) -> None:
    rows, words = case
    with pytest.raises(DesignError, match=words):
        study(ELLIPSE, [24, 24], load=[{"file": rows_of(tmp_path, *rows)}])


def test_a_file_that_is_not_there_is_named() -> None:
    with pytest.raises(DesignError, match="there is no such file"):
        study(ELLIPSE, [24, 24], load=[{"file": "nowhere.csv"}])


def test_a_mechanism_hands_over_its_torque(tmp_path: Path) -> None:
    """Without friction the pair's driver needs what the machine's does."""
    machine = built(PROFILES / "nail_machine_slide.toml").study("torque")
    (tmp_path / "torque.csv").write_bytes(machine.files["torque.csv"])
    text = (PROFILES / "nail_machine_two_phase.toml").read_text("utf-8")
    file = tmp_path / "pair.toml"
    file.write_text(text + '\n[[load]]\nfile = "torque.csv"\n', encoding="utf-8")
    made = gearcam.build(gearcam.load(file)).study("forces")
    own = machine.facts["torque.torque_nm.max"]
    assert made.facts["forces.torque_nm.max"] == pytest.approx(own, rel=1e-6)


def test_flanks_are_coloured_by_their_pressure() -> None:
    """Its points lie on the flanks, in the frame of their wheel."""
    made = study(ELLIPSE, [24, 24])
    for gear, curve in zip(made.result.gears, made.coloured(), strict=True):
        (pressure,) = curve.values.values()
        points = curve.points[np.isfinite(curve.points)]
        outline = shapely.LinearRing(np.column_stack([gear.outline[:, 0], gear.outline[:, 1]]))
        away = shapely.distance(shapely.points(points.real, points.imag), outline)
        assert away.max() < 0.011  # the tolerance of the chords
        assert np.nanmax(pressure) == pytest.approx(made.facts["forces.pressure_mpa.max"])


REFUSED: dict[str, tuple[Any, Any, str]] = {
    "nothing": (ELLIPSE, [], "nothing acts on the pair"),
    "both wheels": (ELLIPSE, [*LOAD, {"on": "wheel1", "torque_nm": 3}], "follows from"),
    "a force on a wheel": (ELLIPSE, [{"force_n": 3}], "acts on a wheel"),
    "a torque on a rack": (RACK, LOAD, "acts on a rack"),
    "phi2 of a rack": (RACK, [{"formula": "phi2"}], "no phi2"),
    "a short table": (ELLIPSE, [{"table": [1, 2], "at_deg": [0, 300]}], "ends inside the turn"),
    "a late table": (ELLIPSE, [{"table": [1, 2], "at_deg": [0, 400]}], "beyond the turn"),
    "a pole": (ELLIPSE, [{"formula": "1/phi1"}], "is not finite at phi1 = 0 deg"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused(name: str) -> None:
    law, load, words = REFUSED[name]
    with pytest.raises(DesignError, match=re.escape(words)):
        study(law, [24, 24], load=load)
