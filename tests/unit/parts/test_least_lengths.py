"""Lengths of a blank that are nothing beside their part are refused, with the least that is."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam.base.errors import InfeasibleError

TOLERANCE = 0.002
"""Of chords, mm."""

TINY = 1.5e-4
"""Too small for these parts, mm, and a keyway in a bore of a millimetre."""

OUTPUT = {"files": ["csv", "dxf", "stl"], "chord_tolerance_mm": TOLERANCE}

BOLTS = {"bolts": 3, "bolt_circle_mm": 20, "bolt_angle_deg": 11}
HUB = {"hub_diameter_mm": 12}
KEYED = {"bore_diameter_mm": 1, "keyway_width_mm": 0.4, "keyway_depth_mm": 0.4}

PLATE: dict[str, dict[str, Any]] = {
    "bore_diameter_mm": {},
    "keyway_width_mm": KEYED,
    "keyway_depth_mm": KEYED,
    "bolt_diameter_mm": BOLTS,
    "hub_diameter_mm": {"hub_front_mm": 4},
    "hub_front_mm": HUB,
    "hub_back_mm": HUB,
}
"""What a blank has beside a key."""

WHEEL = PLATE | {
    "tip_rounding_mm": {},
}

PAIR = {
    "kind": "gear-pair",
    "name": "fine",
    "law": {"type": "ellipse", "eccentricity": 0.1},
    "pair": {"module_mm": 2, "teeth": [17, 17]},
    "output": OUTPUT,
}

CAM = {
    "kind": "cam",
    "name": "fine",
    "motion": [
        {"type": "rise", "law": "harmonic", "angle_deg": 180, "lift_mm": 12},
        {"type": "return", "law": "harmonic", "angle_deg": 180},
    ],
    "follower": {"type": "flat"},
    "cam": {"base_radius_mm": 25, "thickness_mm": 10},
    "output": OUTPUT,
}

RING = PAIR | {"pair": {"module_mm": 2, "teeth": [17, 51], "type": "internal"}}

CASES = [
    *((PAIR, key, beside) for key, beside in WHEEL.items()),
    *((CAM, key, beside) for key, beside in PLATE.items()),
    (RING, "bolt_diameter_mm", {"bolts": [0, 3], "bolt_circle_mm": [0, 112]}),
]


def made(document: Any, key: str, beside: dict[str, Any], length: float) -> Any:
    value = [0, length] if document is RING else length
    return gearcam.build(gearcam.design(document | {"blank": beside | {key: value}}))


def refused(document: Any, key: str, beside: dict[str, Any], length: float) -> float:
    """The limit that is told of a length."""
    with pytest.raises(InfeasibleError, match="too small for a part of this size") as caught:
        _ = made(document, key, beside, length).findings
    assert caught.value.where.endswith(f"blank.{key}")
    assert caught.value.limit is not None
    return caught.value.limit


@pytest.mark.parametrize(
    ("document", "key", "beside"), CASES, ids=[f"{one['kind']} {key}" for one, key, _ in CASES]
)
def test_lengths_are_made_from_the_least_on(
    document: Any, key: str, beside: dict[str, Any], tmp_path: Path
) -> None:
    """With the least, meshes are closed and drawings keep their tolerance."""
    least = refused(document, key, beside, TINY)
    assert refused(document, key, beside, 0.99 * least) == least
    result = made(document, key, beside, least)
    result.write(tmp_path)
    reach = max(edge.reach for part in result.parts for edge in part.contours)
    assert least == pytest.approx(1e-5 * reach, rel=5e-3)
    (summary,) = tmp_path.rglob("summary.json")
    off = json.loads(summary.read_text())["accuracy"]["dxf_mm"]
    assert max(off.values()) <= TOLERANCE


@pytest.mark.parametrize("length", [1e-300, 1e-14, 1e-9])
def test_tips_rounded_by_nothing_are_told_so(length: float) -> None:
    assert refused(PAIR, "tip_rounding_mm", {}, length) == pytest.approx(2.07e-4)


def test_a_long_part_takes_no_flat_hub() -> None:
    """Heights are told in single precision too."""
    long = CAM | {"cam": {"base_radius_mm": 25, "thickness_mm": 1e4}}
    assert refused(long, "hub_front_mm", HUB, 0.01) == 0.1
