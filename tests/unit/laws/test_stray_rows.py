"""A slip of the decimal point in one row is named; corners, dwells and coarse tables are not."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS as RATIO_LAWS
from gearcam.laws.ratio.span import Lobes
from gearcam.laws.row_checks import given_in, row_findings
from gearcam.numeric.stray import stray_rows
from helpers_pairs import PROFILES
from helpers_sampling import few
from random_designs.law_draw import LawDraw
from random_designs.laws import parameters, random_law

Array = NDArray[np.float64]

LAWS = sorted(set(MOTION_LAWS) - {"formula"})
LAWS_OF_RATIO = sorted(RATIO_LAWS)


@cache
def made(name: str) -> Callable[[Array], Array]:
    function = MOTION_LAWS[name].example.build(DEFAULT).function
    return lambda x: np.asarray(function(x))


def lift(name: str, theta: Array, angle: float, hold: float) -> Array:
    """A rise of 10, a dwell at the top, and the same back, in degrees."""
    shape = made(name)
    up, down = np.clip(theta / angle, 0, 1), np.clip((theta - angle - hold) / angle, 0, 1)
    return 10.0 * np.where(theta < angle + hold, shape(up), 1.0 - shape(down))


@pytest.mark.parametrize("name", few(LAWS))
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
        assert not row_findings([*given_in(gc.load(file), oscillating=False)]), file


@pytest.mark.parametrize("name", ["cycloidal", "modified-sine"])
@pytest.mark.parametrize(("step", "error"), [(1.0, 0.05), (2.0, 0.1), (5.0, 0.25), (10.0, 2.0)])
def test_a_small_error_in_a_smooth_lift_is_found(name: str, step: float, error: float) -> None:
    theta = np.arange(0.0, 360.0, step)
    true = 2.0 * lift(name, theta, 150.0, 60.0)
    for row in range(0, len(theta), max(1, len(theta) // 36)):
        rows = np.round(true, 3)
        rows[row] += error
        found, suggested = stray_rows(np.radians(theta), rows, 2 * np.pi)
        assert found.tolist() == [row]
        assert suggested[0] == pytest.approx(true[row], abs=error / 10)


RATIO = """
kind = "gear-pair"
name = "rows"
law = {{type = "table", {rows}}}
pair = {{module_mm = 2, teeth = [60, 30]}}
output = {{files = []}}
"""


def half_turn(values: str) -> tuple[Array, Array]:
    """Rows of a lobe of 180 degrees on which the driven wheel turns once."""
    phi = np.arange(0.0, 181.0, 5.0)
    ratio = 2.0 + 0.4 * np.cos(np.radians(2.0 * phi))
    rows = {
        "ratio": ratio,
        "phi2_deg": 2.0 * phi + 0.2 * np.degrees(np.sin(np.radians(2.0 * phi))),
        "r1": 100.0 * ratio / (1.0 + ratio),
    }
    return phi, np.round(rows[values], 4)


@pytest.mark.parametrize(("values", "wrong"), [("ratio", 2.5), ("phi2_deg", 81.2), ("r1", 64.0)])
def test_a_wrong_row_of_a_ratio_table_is_named(values: str, wrong: float, tmp_path: Path) -> None:
    phi, rows = half_turn(values)
    design, table = tmp_path / "pair.toml", tmp_path / "rows.csv"
    design.write_text(RATIO.format(rows='file = "rows.csv"'), encoding="utf-8")
    for slip in (False, True):
        true, rows[7] = rows[7], wrong if slip else rows[7]
        text = "\n".join(f"{a:g},{y:.4f}" for a, y in zip(phi, rows, strict=True))
        table.write_text(f"phi1_deg,{values}\n{text}\n", encoding="utf-8")
        found = row_findings([*given_in(gc.load(design), oscillating=False)])
        listed = f"phi1_deg = {phi.tolist()}, {values} = {rows.tolist()}"
        same = gc.loads(RATIO.format(rows=listed))
        listed_found = row_findings([*given_in(same, oscillating=False)])
        assert len(found) == len(listed_found) == slip
        if slip:
            assert found[0].where == "law, line 9, phi1 = 35 deg"
            assert listed_found[0].where == f"law, {values.split('_')[0]}[7], phi1 = 35 deg"
            assert found[0].value == pytest.approx(wrong, abs=1e-12)
            assert float(found[0].message.split("suggest ")[1].split()[0].rstrip(".")) == (
                pytest.approx(true, rel=1e-3)
            )


def test_findings_of_a_pair_and_of_a_cam_in_space_have_the_row() -> None:
    phi, rows = half_turn("ratio")
    rows[7] += 0.02
    listed = f"phi1_deg = {phi.tolist()}, ratio = {rows.tolist()}"
    pair = gc.build(gc.loads(RATIO.format(rows=listed)))
    assert [one.where for one in pair.checked if one.code == "stray-row"] == [
        "law, ratio[7], phi1 = 35 deg"
    ]
    rows[7] = 2.5
    listed = f"phi1_deg = {phi.tolist()}, ratio = {rows.tolist()}"
    with pytest.raises(gc.InfeasibleError, match=r"ratio 2\.5 is out of line.* suggest 2\.137"):
        _ = gc.build(gc.loads(RATIO.format(rows=listed))).pair
    theta = np.arange(0.0, 360.0, 5.0)
    raised = lift("cycloidal", theta, 120.0, 60.0)
    raised[15] += 1.0
    motion = {"theta_deg": theta.tolist(), "lift_mm": raised.tolist()}
    made = gc.build(gc.load(PROFILES / "cylinder_cam.toml").with_({"motion": motion}))
    assert "motion, lift[15], at 75 deg" in [
        one.where for one in made.checked if one.code == "stray-row"
    ]


@pytest.mark.parametrize(
    ("name", "sizes"),
    [
        ("cylinder_cam", {"cam.length_mm": 80}),  # the groove leaves a face
        ("cylinder_cam", {"cam.length_mm": 200, "cam.lowest_mm": 50, "output.files": ["gcode"]}),
        ("groove_cam", {}),  # the groove opens the edge
    ],
)
def test_a_cam_that_is_refused_for_a_row_names_the_row(name: str, sizes: dict[str, Any]) -> None:
    theta = np.arange(0.0, 360.0, 5.0)
    raised = lift("cycloidal", theta, 120.0, 60.0) * 0.3
    raised[15] += 60.0
    motion = {"theta_deg": theta.tolist(), "lift_mm": raised.tolist()}
    design = gc.load(PROFILES / f"{name}.toml").with_({"motion": motion, **sizes})
    with pytest.raises(gc.InfeasibleError, match=r"is out of line.* suggest") as caught:
        _ = [gc.build(design).files(one) for one in design.output.files]
    assert caught.value.where == "motion, lift[15], at 75 deg"
    assert "out of line" not in caught.value.nearest  # but why it is refused


def test_a_table_with_ends_is_looked_at_between_them() -> None:
    x = np.linspace(0.0, 1.0, 25)
    rise = x - np.sin(2.0 * np.pi * x) / (2.0 * np.pi)
    for row in range(25):
        rows = np.round(rise, 4)
        rows[row] += 0.05
        found, _ = stray_rows(x, rows, None)
        assert found.tolist() == ([row] if 3 <= row < 22 else [])
    assert not len(stray_rows(x, np.round(rise, 4), None)[0])


def sampled(trials: range) -> Iterator[tuple[str, Array, Array, float | None, float]]:
    """Yield rows of random ratio laws: ratio, driven angle, radius; in 2 to 5 decimals."""
    rng = np.random.default_rng(4)
    for name in LAWS_OF_RATIO:
        for trial in trials:
            law, teeth = random_law(LawDraw(f"{name} {trial}"), name)
            common = math.gcd(*teeth)
            try:
                made = parameters(law).build(Lobes(*(z // common for z in teeth)), DEFAULT)
            except gc.InfeasibleError:
                continue
            phi = np.linspace(0.0, made.period, int(rng.choice([13, 24, 36, 72, 180, 360])) + 1)
            ratio = np.asarray(made.ratio(phi))
            for values in (ratio, np.degrees(np.asarray(made.driven(phi))), ratio / (1 + ratio)):
                rows = np.round(values, rng.integers(2, 6))
                if made.closed:
                    rise = float(values[-1] - values[0])
                    yield name, phi[:-1], rows[:-1], made.period, rise
                else:
                    yield name, phi, rows, None, 0.0


def demand_none_stray(trials: range) -> None:
    count = 0
    for name, x, rows, period, rise in sampled(trials):
        assert not len(stray_rows(x, rows, period, rise)[0]), name
        count += 1
    assert count > 30 * len(trials)


def test_no_row_of_a_ratio_law_is_stray() -> None:
    demand_none_stray(range(2))


@pytest.mark.slow
def test_no_row_of_many_ratio_laws_is_stray() -> None:
    demand_none_stray(range(2, 60))
