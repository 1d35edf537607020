"""A slip of the decimal point in one row is named; corners, dwells and coarse tables are not."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.numeric.stray import stray_rows
from helpers_pairs import PROFILES

Array = NDArray[np.float64]

LAWS = sorted(set(MOTION_LAWS) - {"formula"})


@cache
def made(name: str) -> Callable[[Array], Array]:
    function = MOTION_LAWS[name].example.build(DEFAULT).function
    return lambda x: np.asarray(function(x))


def lift(name: str, theta: Array, angle: float, hold: float) -> Array:
    """A rise of 10, a dwell at the top, and the same back, in degrees."""
    shape = made(name)
    up, down = np.clip(theta / angle, 0, 1), np.clip((theta - angle - hold) / angle, 0, 1)
    return 10.0 * np.where(theta < angle + hold, shape(up), 1.0 - shape(down))


@pytest.mark.parametrize("name", LAWS)
def test_no_row_of_a_motion_law_is_stray_however_coarse_or_noisy(name: str) -> None:
    rng = np.random.default_rng(3)
    for trial in range(40):
        step, angle = float(rng.choice([1, 2, 5, 10, 15, 20])), rng.uniform(20, 180)
        theta = np.arange(0.0, 360.0, step) + rng.uniform(0, step)
        theta = theta[(theta < 360.0) & (rng.random(len(theta)) > 0.1 * (trial % 3))]
        rows = lift(name, theta, angle, rng.choice([0.0, rng.uniform(0, 100)]))
        rows += rng.normal(0.0, float(rng.choice([0.0, 0.01, 0.05])), len(rows))
        found, _ = stray_rows(np.radians(theta), np.round(rows, rng.choice([1, 2, 5])), 2 * np.pi)
        assert not len(found)


@pytest.mark.parametrize("factor", [10.0, 0.1, 1.7])
@pytest.mark.parametrize("name", ["cycloidal", "constant-velocity", "modified-trapezoid"])
def test_one_slip_is_found_and_nothing_else(name: str, factor: float) -> None:
    theta = np.arange(0.0, 360.0, 10.0)
    true = lift(name, theta, 150.0, 50.0)
    for row in np.flatnonzero(true > 2.0).tolist():
        rows = np.round(true, 2)
        rows[row] *= factor
        found, suggested = stray_rows(np.radians(theta), rows, 2 * np.pi)
        assert found.tolist() == [row]
        assert suggested[0] == pytest.approx(true[row], abs=0.3)


def test_a_rise_and_return_within_one_row_is_a_motion() -> None:
    rows = np.zeros(36)
    rows[5] = 10.0
    assert not len(stray_rows(np.arange(36) * np.pi / 18, rows, 2 * np.pi)[0])


CAM = """
kind = "cam"
name = "slipped"
motion = {file = "rows.csv"}
follower = {type = "roller", roller_radius_mm = 5}
cam = {prime_radius_mm = 30, thickness_mm = 4}
"""


def test_the_line_the_value_and_what_the_rows_around_suggest_are_told(tmp_path: Path) -> None:
    theta = np.arange(0.0, 360.0, 10.0)
    rows = [f"{a:g},{s:.3f}" for a, s in zip(theta, lift("cycloidal", theta, 150, 60), strict=True)]
    assert rows[9] == "90,6.935"
    design, table = tmp_path / "cam.toml", tmp_path / "rows.csv"
    design.write_text(CAM, encoding="utf-8")
    for given, told in (("90,6.935", False), ("90,69.35", True)):
        rows[9] = given
        table.write_text("# measured\ntheta_deg,lift_mm\n" + "\n".join(rows), encoding="utf-8")
        result = gc.build(gc.load(design))
        found = [one for one in result.findings_without_hints if one.code == "stray-row"]
        assert [(one.value, one.where) for one in found] == [
            (69.35, "motion, line 12, at 90 deg")
        ] * told
        assert all("suggest 6.9" in one.message for one in found)
    with pytest.raises(DesignError, match=r"line 12: the lift 69\.35 mm is out of line.* 6\.9"):
        result.follow(str(table), fit=True)  # type: ignore[attr-defined]


def test_no_table_of_the_gallery_has_a_stray_row() -> None:
    for file in PROFILES.glob("*.toml"):
        program = getattr(gc.load(file), "motion", None)
        if isinstance(program, gc.MotionTable):
            assert not [*program.stray(oscillating=False)], file
