"""A key that has an effect only with another one is refused where that is missing."""

from __future__ import annotations

from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError
from helpers_pairs import PROFILES

ROLLER, SWINGING, PAIR = "plate_cam_offset_roller", "plate_cam_oscillating", "ellipse"

CASES: list[tuple[str, dict[str, Any], str, dict[str, Any]]] = [
    # profile, table with the key, the key, what makes it right
    (ROLLER, {"friction": {"journal_radius_mm": [9, 3]}}, "joint", {"joint": 0.1}),
    (ROLLER, {"friction": {"guide": 0.1}}, "guide_length_mm", {"guide_length_mm": 40}),
    (ROLLER, {"gravity": {"g_m_s2": 5}}, "direction_deg", {}),
    (ROLLER, {"precision": {"combined": "root-of-squares"}}, "lift_error_mm",
     {"lift_error_mm": 0.1}),
    (SWINGING, {"mass": {"inertia_kg_m2": 1e-3, "center_mm": 9}}, "mass_kg", {"mass_kg": 0.2}),
    (PAIR, {"steps": {"offset_mm": 1}}, "offset_mm", {"count": 2}),
    (PAIR, {"errors": {"seed": 7}}, "seed", {"center_tolerance_mm": 0.01}),
    (PAIR, {"errors": {"distribution": "normal"}}, "distribution", {"tilt_tolerance_deg": [1, 0]}),
    (PAIR, {"errors": {"eccentricity_deg": 30}}, "eccentricity_deg",
     {"eccentricity_mm": [0.1, 0]}),
    (PAIR, {"errors": {"eccentricity_deg": [30, 40], "eccentricity_mm": [0.1, 0]}},
     "eccentricity_deg[1]", {"eccentricity_mm": [0.1, 0.1]}),
]  # fmt: skip


def _read(profile: str, tables: dict[str, Any]) -> Any:
    document = gc.load(PROFILES / f"{profile}.toml").to_dict()
    document["output"] = {"files": ["csv"]}
    several = {title: [table] if title == "mass" else table for title, table in tables.items()}
    return gc.design(document | several)


@pytest.mark.parametrize(("profile", "tables", "key", "right"), CASES)
def test_a_key_without_its_partner_is_refused(
    profile: str, tables: dict[str, Any], key: str, right: dict[str, Any]
) -> None:
    ((title, table),) = tables.items()
    with pytest.raises(DesignError) as caught:
        _read(profile, tables)
    (problem,) = caught.value.problems
    place = f"{title}[0]" if title == "mass" else title
    assert problem.key == f"{place}.{key}"
    assert problem.allowed
    if right:
        assert _read(profile, {title: table | right})


def test_gravity_needs_a_mass() -> None:
    with pytest.raises(DesignError, match="no mass on which gravity acts"):
        _read(ROLLER, {"gravity": {"direction_deg": -90}})
    assert _read(ROLLER, {"gravity": {"direction_deg": -90}, "mass": {"mass_kg": 0.2}})


DYADS: list[tuple[dict[str, Any], str]] = [
    ({"beta_deg": 10}, "beta_deg"),
    ({"slide_on": 2}, "slide_on"),
    ({"gammas_deg": [0, 20]}, "gammas_deg[1]"),
]


@pytest.mark.parametrize(("keys", "told"), DYADS)
def test_a_dyad_of_hinges_has_no_keys_of_slides(keys: dict[str, Any], told: str) -> None:
    document = gc.load(PROFILES / "four_bar.toml").to_dict()
    (dyad,) = document["dyad"]
    assert dyad["type"] == "RRR"
    document["dyad"] = [dyad | keys]
    with pytest.raises(DesignError) as caught:
        gc.design(document)
    assert [problem.key for problem in caught.value.problems] == [f"dyad[0].{told}"]
