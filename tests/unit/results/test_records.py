"""A result as one flat row: plain values only, the same as in its summary, ready for frames."""

from __future__ import annotations

import json
import math
from typing import Any

import polars as pl
import pytest

import gearcam as gc
from helpers_sampling import few

CAM = "profiles/plate_cam_offset_roller.toml"
PLAIN = (str, bool, int, float)


def result(path: str, changes: dict[str, Any] | None = None) -> Any:
    return gc.build(gc.load(path).with_(changes or {}))


NAMES = [
    "ellipse", "log_spiral", "shop_order", "ring_ellipse", "feeder", "stepped_ellipse",
    "nail_machine_three_phase", "undercut_cam", "groove_cam", "conjugate_cams", "measured_cam",
]  # fmt: skip


@pytest.mark.parametrize("name", few(NAMES))
def test_a_record_holds_plain_values_only(name: str) -> None:
    row = result(f"profiles/{name}.toml").record()
    assert {type(value) for value in row.values()} <= set(PLAIN)
    assert all(isinstance(key, str) for key in row)
    assert not any(isinstance(value, float) and math.isnan(value) for value in row.values())
    assert next(iter(row.items())) == ("name", name)


def test_its_values_are_those_of_the_facts() -> None:
    made = result("profiles/shop_order.toml")
    row, facts = made.record(), made.facts
    assert row["pair.center_distance_mm"] == facts["pair.center_distance_mm"]
    assert [row[f"pair.ratio.{end}"] for end in ("min", "max")] == list(
        facts["pair.ratio"].values()
    )
    assert [row[f"gears.0.size_mm.{axis}"] for axis in range(3)] == facts["gears.0.size_mm"]
    assert json.loads(str(row["pair.teeth"])) == facts["pair.teeth"]  # as in a design file
    assert row["gears.1.teeth"] == facts["pair.teeth"][1]
    assert row["gears.0.openings.0.kind"] == "bore"
    names = {one.name for one in facts.quantities() if not one.name.startswith("accuracy.")}
    kept = {name for name in names if any(key == name or key.startswith(name) for key in row)}
    assert kept == names
    assert not any(key.startswith("accuracy") for key in row)


def test_it_says_what_the_checks_found() -> None:
    made = result("profiles/undercut_cam.toml")
    row = made.record()
    errors = [one for one in made.findings if one.severity == "error"]
    assert row["findings.errors"] == len(errors) > 0
    assert row["findings.codes"].split(", ")[0] == errors[0].code
    assert len(set(row["findings.codes"].split(", "))) == len({one.code for one in made.findings})


def test_results_of_one_kind_make_a_frame() -> None:
    eccentricities = [0.1, 0.2, 0.3, 0.6]
    frame = pl.DataFrame(
        result("profiles/ellipse.toml", {"law.eccentricity": e, "pair.x": x}).record()
        for e, x in zip(eccentricities, (0, 0, 0.1, 0), strict=True)
    )
    assert frame.height == 4
    assert frame["pair.ratio.max"].to_list() == pytest.approx(
        [(1 + e) / (1 - e) for e in eccentricities]
    )
    assert frame["pair.x"].to_list() == [0.0, 0.0, 0.1, 0.0]
    assert frame["findings.errors"].dtype.is_integer()
    assert not any(dtype == pl.Object for dtype in frame.dtypes)


def test_results_of_both_kinds_make_a_frame() -> None:
    rows = [result(path).record() for path in ("profiles/ellipse.toml", CAM)]
    frame = pl.DataFrame(rows)
    assert frame["kind"].to_list() == ["gear-pair", "cam"]
    assert set(frame.columns) == {*rows[0], *rows[1]}
    assert frame["pair.module_mm"].to_list() == [1.0, None]
    assert frame["cam.prime_radius_mm"].to_list() == [None, rows[1]["cam.prime_radius_mm"]]
