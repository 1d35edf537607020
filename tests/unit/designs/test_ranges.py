"""Sizes that nobody makes are refused by the ranges of keys, and the ends of ranges are not."""

from __future__ import annotations

import copy
from typing import Any

import pytest

import gearcam
from gearcam.base.errors import DesignError

CAM: dict[str, Any] = {
    "kind": "cam",
    "name": "range",
    "motion": [
        {"type": "rise", "law": "cycloidal", "angle_deg": 180, "lift_mm": 10},
        {"type": "return", "law": "cycloidal", "angle_deg": "rest"},
    ],
    "follower": {"type": "roller", "roller_radius_mm": 5},
    "cam": {"prime_radius_mm": 40},
    "blank": {},
    "output": {"chord_tolerance_mm": 0.01},
}

SPEEDS: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "range",
    "law": {
        "type": "multispeed",
        "ratios": [0.8, 1.0, "solve"],
        "angles_deg": [100, 0, 200],
        "transition_deg": 20,
    },
    "pair": {"module_mm": 2, "teeth": [40, 40]},
    "blank": {},
}
SPIRAL: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "range",
    "law": {"type": "log-spiral", "ratios": [0.5, 2.0], "driven_travel_deg": 100},
    "pair": {"module_mm": 2, "teeth": [40, 40]},
}


@pytest.mark.parametrize(
    ("document", "path", "allowed", "refused", "words"),
    [
        (CAM, ("motion", 0, "lift_mm"), 1e-3, 0.9e-3, "from 0.001 to"),
        (CAM, ("motion", 0, "lift_mm"), 1e5, 1.1e5, "to 100000 mm"),
        (CAM, ("motion", 0, "angle_deg"), 0.01, 0.009, "from 0.01 to 360 deg"),
        (CAM, ("follower", "roller_radius_mm"), 1e-3, 0.9e-3, "from 0.001 to"),
        (CAM, ("blank", "clearance_mm"), 1e-6, 0.9e-6, "0 or a number from 1e-06 to 100 mm"),
        (CAM, ("output", "kerf_mm"), 0.0005, 0.9e-6, "0 or a number from 1e-06 to 100 mm"),
        (SPEEDS, ("blank", "clearance_mm"), 0.0005, 0.9e-6, "0 or a number from 1e-06 to 100 mm"),
        (SPEEDS, ("blank", "clearance_mm"), 0, -1e-6, "0 or a number from"),
        (SPEEDS, ("pair", "backlash_mm"), 1e-6, -1e-6, "from 0 to"),
        (CAM, ("cam", "prime_radius_mm"), 1e5, 1.1e5, "to 100000 mm"),
        (CAM, ("output", "chord_tolerance_mm"), 1e-9, 0.9e-9, "from 1e-09 to 1 mm"),
        (SPEEDS, ("law", "transition_deg"), 0.01, 0.009, "from 0.01 to 360 deg"),
        (SPEEDS, ("law", "angles_deg", 1), 0.01, 0.009, "0, or at least 0.01 deg"),
        (SPEEDS, ("pair", "module_mm"), 1e-3, 0.9e-3, "from 0.001 to"),
        (SPIRAL, ("law", "ratios", 0), 1e-3, 0.9e-3, "from 0.001 to 1000"),
    ],
)
def test_a_value_beyond_its_range_is_refused(
    document: dict[str, Any], path: tuple[Any, ...], allowed: Any, refused: Any, words: str
) -> None:
    def given(value: Any) -> dict[str, Any]:
        made = copy.deepcopy(document)
        owner: Any = made
        for key in path[:-1]:
            owner = owner[key]
        owner[path[-1]] = value
        return made

    gearcam.design(given(allowed))
    with pytest.raises(DesignError) as caught:
        gearcam.design(given(refused))
    (problem,) = caught.value.problems
    assert words in str(problem)
    assert path[-1 if isinstance(path[-1], str) else -2] in str(problem)
