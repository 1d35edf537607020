"""Results that tests share are those of one design and no other."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import gearcam
import helpers_built
from helpers_built import built, fresh
from helpers_pairs import PROFILES

ELLIPSE = PROFILES / "ellipse.toml"
CAM = """
kind = "cam"
name = "rows"
motion = { file = "rows.csv" }
follower = { type = "flat" }
cam = { base_radius_mm = 30 }
"""


def test_one_design_has_one_result() -> None:
    shared = built(ELLIPSE)
    assert built(gearcam.load(ELLIPSE)) is shared
    assert built(gearcam.load(ELLIPSE)).gear1 is shared.gear1
    assert fresh(shared) is not shared
    assert "gear1" not in vars(fresh(shared))


@pytest.mark.parametrize(
    "changes",
    [
        {"name": "another"},
        {"limits.contact_ratio": 1.3},
        {"output.files": ["csv"]},
        {"meshing.steps": 24},
        {"law.eccentricity": 0.30000000000000004},
    ],
)
def test_another_design_has_another_result(changes: dict[str, Any]) -> None:
    design = gearcam.load(ELLIPSE)
    assert built(design.with_(changes)) is not built(design)


def test_other_rows_of_a_file_are_another_design(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    seen = []
    for lift in (1.0, 2.0):
        rows = [f"{30 * k},{lift * (k % 12 > 3)}" for k in range(13)]
        Path("rows.csv").write_text("\n".join(["theta_deg,lift_mm", *rows]), encoding="utf-8")
        seen.append(built(gearcam.loads(CAM)))
    assert seen[0].program.range != seen[1].program.range


def test_functions_without_a_name_are_not_shared() -> None:
    law = gearcam.laws.Formula(ratio=lambda _: 1.0)
    pair = gearcam.PairSpec(teeth=(20, 20), module=1.0)
    design = gearcam.GearPairDesign(name="own", law=law, pair=pair)
    assert built(design) is not built(design)


def test_results_used_last_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helpers_built, "_KEPT", 2)
    monkeypatch.setattr(helpers_built, "_results", type(helpers_built._results)())
    design = gearcam.load(ELLIPSE)
    one, two, three = (design.with_({"name": name}) for name in ("one", "two", "three"))
    first, second = built(one), built(two)
    assert built(one) is first
    _ = built(three)
    assert built(one) is first
    assert built(two) is not second
