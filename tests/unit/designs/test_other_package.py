"""Laws, parts, formats and studies that another installed package brings by entry points."""

from __future__ import annotations

import json
import math
import pickle
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base import brought
from gearcam.cli import main
from gearcam.designs import KINDS
from gearcam.designs.schema import schema
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS

PACKAGE = Path(__file__).parents[2] / "other_package"

PAIR = """
kind = "gear-pair"
name = "joint"
[law]
type = "universal-joint"
shaft_angle_deg = 30
[pair]
module_mm = 2
teeth = [40, 40]
[output]
files = ["ratio-txt"]
studies = ["swing"]
"""

CAM = """
kind = "cam"
name = "wave"
[cam]
prime_radius_mm = 40
[follower]
type = "roller"
roller_radius_mm = 8
[[motion]]
type = "rise"
law = "double-harmonic"
angle_deg = 180
lift_mm = 16
[[motion]]
type = "return"
law = "double-harmonic"
angle_deg = 180
"""

MACHINE = """
kind = "mechanism"
name = "half"
[[drive]]
name = "motor"
even = true
speed_rpm = 60
[[joint]]
name = "D"
at_mm = [100, 0]
[[crank]]
name = "crank"
on = "motor"
joint = "B"
length_mm = 40
[[middle]]
name = "M"
first = "B"
second = "D"
"""


@pytest.fixture
def package(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Install the other package."""
    monkeypatch.syspath_prepend(PACKAGE)
    brought.every_entry_point.cache_clear()
    yield
    brought.every_entry_point.cache_clear()
    for kind in KINDS.values():
        kind.added.clear()
        for name in ("tree", "several", "tables"):
            vars(kind).pop(name, None)
    for laws, name in ((LAWS, "universal-joint"), (MOTION_LAWS, "double-harmonic")):
        laws._entries.pop(name, None)


C = math.cos(math.radians(30))


@pytest.mark.usefixtures("package")
def test_a_ratio_law_is_read_and_built() -> None:
    result = gc.build(gc.loads(PAIR))
    phi = np.radians([0.0, 30.0, 90.0])
    expected = C / (np.cos(phi) ** 2 + C**2 * np.sin(phi) ** 2)
    assert result.motion(phi)["ratio"] == pytest.approx(expected, rel=1e-12)
    assert result.design.to_dict()["law"] == {"type": "universal-joint", "shaft_angle_deg": 30.0}


@pytest.mark.usefixtures("package")
def test_a_motion_law_is_read_and_built() -> None:
    result = gc.build(gc.loads(CAM))
    theta = np.radians([60.0, 90.0, 120.0, 240.0])
    assert result.motion(theta)["lift_mm"] == pytest.approx([1.0, 4.0, 9.0, 9.0], abs=1e-9)


@pytest.mark.usefixtures("package")
def test_a_part_of_a_mechanism_moves_and_is_asked_for() -> None:
    result = gc.build(gc.loads(MACHINE))
    q = np.radians([0.0, 50.0, 200.0])
    assert result.motion(q)["M_x_mm"] == pytest.approx(50.0 + 20.0 * np.cos(q), abs=1e-9)
    assert result.design.to_dict()["middle"] == [{"name": "M", "first": "B", "second": "D"}]
    with pytest.raises(gc.DesignError, match=r"middle\[0\].second") as caught:
        gc.loads(MACHINE.replace('second = "D"', 'second = "E"'))
    assert "nothing has this name" in str(caught.value)


@pytest.mark.usefixtures("package")
def test_a_format_is_written(tmp_path: Path) -> None:
    gc.build(gc.loads(PAIR)).write(tmp_path)
    phi, ratio = np.loadtxt(tmp_path / "joint" / "ratio.txt", unpack=True)
    assert ratio[90] == pytest.approx(1 / C, rel=1e-10)
    assert phi[90] == 90.0


@pytest.mark.usefixtures("package")
def test_a_study_has_settings_a_command_and_a_place_in_the_summary(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result = gc.build(gc.loads(PAIR))
    assert result.facts["swing.swing"] == pytest.approx(1 / C - C, rel=1e-3)
    file = tmp_path / "joint.toml"
    file.write_text(PAIR)
    assert main(["swing", str(file), "--steps", "7", "-o", str(tmp_path)]) == 0
    at_60 = C / (0.25 + 0.75 * C**2)  # the nearest of 0, 60, ... degrees to the largest, at 90
    summary = json.loads((tmp_path / "joint" / "summary.json").read_text())
    assert summary["swing"]["swing"] == pytest.approx(at_60 - C, rel=1e-6)
    assert "largest less smallest ratio" in capsys.readouterr().out
    with pytest.raises(gc.DesignError, match=r"swing.steps: 3 is out of range"):
        gc.loads(PAIR + "[swing]\nsteps = 3\n")


@pytest.mark.usefixtures("package")
def test_lists_and_hints_have_what_it_brings(capsys: pytest.CaptureFixture[str]) -> None:
    text = json.dumps(schema())
    for name in ("universal-joint", "double-harmonic", '"middle"', "ratio-txt", '"swing"'):
        assert name in text
    assert main(["laws"]) == 0
    assert "the ratio of a universal joint" in capsys.readouterr().out
    with pytest.raises(gc.DesignError, match=r"did you mean middle\?"):
        gc.loads(MACHINE.replace("[[middle]]", "[[midle]]"))


@pytest.mark.usefixtures("package")
def test_its_tables_are_part_of_the_design() -> None:
    """Where one is left out nothing changes, even after it was asked for elsewhere."""
    text = MACHINE.partition("[[middle]]")[0]
    before, full = gc.loads(text), gc.loads(MACHINE)
    assert isinstance(full, gc.MechanismDesign)
    assert gc.loads(text) == before
    assert "middle" not in gc.loads(text).to_dict()
    assert full != before
    assert pickle.loads(pickle.dumps(full)) == full
    parts = {"middle": full.added["middle"]}
    assert (
        gc.MechanismDesign(
            name="half", drive=full.drive, joint=full.joint, crank=full.crank, added=parts
        )
        == full
    )
    assert full.with_({"middle[0].second": "B"}).added["middle"][0].second == "B"
    with pytest.raises(gc.DesignError, match="centre: is no table that another package brings"):
        gc.MechanismDesign(name="half", drive=full.drive, added={"centre": ()})


@pytest.mark.usefixtures("package")
def test_it_is_read_where_another_process_pickled_it() -> None:
    text, kind = pickle.dumps(gc.loads(MACHINE)), KINDS["mechanism"]
    kind.added.clear()
    for name in ("tree", "several", "tables"):
        vars(kind).pop(name, None)
    assert pickle.loads(text).to_dict()["middle"]


def test_packages_are_not_looked_for_where_all_names_are_known(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def looked_for() -> Any:
        raise AssertionError

    monkeypatch.setattr(brought, "every_entry_point", looked_for)
    behind = (
        MACHINE.replace(
            "even = true",
            "[drive.pair.law]\ntype = 'ellipse'\neccentricity = 0.3\n[drive.pair.pair]\n"
            "module_mm = 2\nteeth = [40, 40]",
        )
        .replace("speed_rpm = 60\n", "")
        .replace('"motor"\njoint', '"motor.wheel2"\njoint')
    )
    for text in (PAIR, CAM, MACHINE, behind):
        known = text.replace("universal-joint", "ellipse").replace(
            "shaft_angle_deg = 30", "eccentricity = 0.3"
        )
        known = known.replace("double-harmonic", "cycloidal").partition("[[middle]]")[0]
        known = known.replace('"ratio-txt"', '"csv"').replace('"swing"', '"mesh"')
        design = gc.loads(known)
        gc.build(design).write(tmp_path)
        assert pickle.loads(pickle.dumps(design)) == design


@pytest.mark.usefixtures("package")
def test_a_package_that_cannot_be_loaded_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    folder = tmp_path / "broken-1.0.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: broken\nVersion: 1.0\n")
    (folder / "entry_points.txt").write_text("[gearcam.ratio_laws]\nbent = no_such_module:LAW\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(gc.DesignError, match="bent: the package broken brings it, but cannot be"):
        gc.loads(PAIR.replace("universal-joint", "bent"))
