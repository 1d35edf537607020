"""A cam that is written as DXF, followed and fitted is the cam that was written."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam.designs import Design
from gearcam.designs.writing import toml_text
from gearcam.export.dxf import CURVES
from helpers_pairs import PROFILES
from helpers_sampling import chosen, few

# without constant velocity: its profile is undercut whatever its size, and the corner loses lift
LAWS = [
    "constant-acceleration", "harmonic", "cycloidal", "trapezoidal-velocity",
    "sine-trapezoidal-velocity", "trapezoidal-acceleration", "2-3", "3-4-5", "4-5-6-7",
    "5-6-7-8-9", "3-4-5-6", "modified-trapezoid", "modified-sine",
]  # fmt: skip
QUICK = [
    ("modified-trapezoid", "arcs"),
    ("cycloidal", "splines"),
]

ARM, GROOVE = (
    gearcam.load(PROFILES / f"{name}.toml") for name in ("plate_cam_oscillating", "groove_cam")
)
OTHERS = {
    "clockwise": (ARM.with_({"cam.rotation": "cw"}), None, 20.0),
    "splines to 20 um": (
        GROOVE.with_({"output.dxf_curves": "splines", "output.chord_tolerance_mm": 0.02}),
        "outer",
        10.0,
    ),
}


def double_dwell(law: str, curves: str) -> dict[str, Any]:
    """A cam whose rise and return have a motion law, and how it is drawn."""
    return {
        "kind": "cam",
        "name": "own",
        "motion": [
            {"type": "rise", "law": law, "angle_deg": 90, "lift_mm": 10},
            {"type": "dwell", "angle_deg": 90},
            {"type": "return", "law": law, "angle_deg": 80},
            {"type": "dwell", "angle_deg": "rest"},
        ],
        "follower": {"type": "roller", "roller_radius_mm": 6},
        "cam": {"prime_radius_mm": 30, "thickness_mm": 12},
        "output": {"files": ["dxf"], "dxf_curves": curves},
    }


def demand_found(design: Design, folder: Path, lift: float, wall: str | None = None) -> None:
    """The design that is found in the DXF file of another has its laws, angles and lift."""
    result = gearcam.build(design.with_({"output.files": ["dxf"]}))
    file = Path(result.write(folder).directory) / "cam.dxf"
    study = result.follow(file, wall=wall, fit=True)
    assert "unknown-law" not in {one.code for one in study.findings}
    found = gearcam.loads(study.files["fitted.toml"].decode()).to_dict()["motion"]
    given = design.to_dict()["motion"]
    assert [one.get("law") for one in found] == [one.get("law") for one in given]
    for one, other in zip(found[:-1], given, strict=False):
        assert one["angle_deg"] == pytest.approx(other["angle_deg"], abs=0.2)
    high = found[0].get("lift_mm") or found[0]["lift_deg"]
    assert high == pytest.approx(lift, abs=0.01)


@pytest.mark.parametrize(("law", "curves"), chosen(product(LAWS, CURVES), *QUICK))
def test_a_cam_is_found_in_its_own_drawing(law: str, curves: str, tmp_path: Path) -> None:
    design = gearcam.loads(toml_text(double_dwell(law, curves)))
    demand_found(design, tmp_path, 10.0)


@pytest.mark.parametrize("case", few(OTHERS))
def test_other_followers_and_tolerances(case: str, tmp_path: Path) -> None:
    design, wall, lift = OTHERS[case]
    demand_found(design, tmp_path, lift, wall)


def test_a_coarser_drawing_than_the_design_says_is_told(tmp_path: Path) -> None:
    """Its waves are no moves; no law fits within the design's own tolerance."""
    design = GROOVE.with_({"output.files": ["dxf"]})
    coarse = design.with_({"output.chord_tolerance_mm": 0.05})
    file = Path(gearcam.build(coarse).write(tmp_path).directory) / "cam.dxf"
    study = gearcam.build(design).follow(file, wall="inner", fit=True)
    assert "unknown-law" in {one.code for one in study.findings}
    found = gearcam.loads(study.files["fitted.toml"].decode()).to_dict()["motion"]
    assert [one["type"] for one in found] == ["rise", "dwell", "return", "dwell"]
