"""Mistakes in loads, masses and springs of a mechanism are all reported, each with its place."""

from __future__ import annotations

from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError
from helpers_machines import MACHINES

LOAD = {"on": "C", "force_n": -5}


def problems(machine: str, **changes: Any) -> list[Any]:
    tables = {"kind": "mechanism", "name": "mine", **MACHINES[machine], **changes}
    with pytest.raises(DesignError) as caught:
        gc.design(tables)
    return list(caught.value.problems)


FAULTS: dict[str, tuple[str, dict[str, Any], str, str]] = {
    "no name": ("load", {"on": "ramm", "torque_nm": 1}, "on", "nothing has this name"),
    "a guide": ("load", {"on": "bed", "force_n": 1}, "on", "is a guide"),
    "two sizes": ("load", {**LOAD, "torque_nm": 2}, "torque_nm", "beside force_n"),
    "no size": ("load", {"on": "C"}, "", "neither"),
    "three values": ("load", {"on": "C", "force_n": [1, 2, 3]}, "force_n", "3 values"),
    "two directions": (
        "load", {"on": "C", "force_n": [1, 2], "direction_deg": 3}, "direction_deg", "two values",
    ),
    "a vector against": (
        "load", {"on": "C", "force_n": [1, 2], "against": True}, "against", "two values",
    ),
    "a force on a member": ("load", {"on": "rod", "force_n": 1}, "force_n", "is a member"),
    "a direction of a torque": (
        "load", {"on": "rod", "torque_nm": 1, "direction_deg": 3}, "direction_deg", "is a member",
    ),
    "rows over the way of a member": (
        "load", {"on": "rod", "table": [1, 2], "at_mm": [0, 1]}, "at_mm", "is a member",
    ),
    "a torque on a slide": ("load", {"on": "C", "torque_nm": 1}, "torque_nm", "is a slide"),
    "no direction": ("load", {"on": "B", "force_n": 1}, "force_n", "has no direction"),
    "no direction of a formula": ("load", {"on": "B", "formula": "q"}, "formula", "no direction"),
    "travel of a point": (
        "load",
        {"on": "B", "force_n": [1, 2], "travel_mm": 4, "before": "outer"},
        "travel_mm",
        "slides along no guide",
    ),
    "travel without a side": ("load", {**LOAD, "travel_mm": 4}, "before", "missing"),
    "a misspelt side": (
        "load", {**LOAD, "travel_mm": 4, "before": "outside"}, "before", "outer",
    ),
    "travel and a range": (
        "load",
        {**LOAD, "travel_mm": 4, "before": "outer", "from_deg": 1, "to_deg": 2},
        "travel_mm",
        "beside from_deg",
    ),
    "a range that falls": ("load", {**LOAD, "from_deg": 350, "to_deg": 10}, "to_deg", "not above"),
    "half a range": ("load", {**LOAD, "from_deg": 350}, "to_deg", "missing"),
    "rows nowhere": ("load", {"on": "C", "table": [1, 2]}, "at_deg", "missing"),
    "rows twice": (
        "load",
        {"on": "C", "table": [1, 2], "at_deg": [0, 360], "at_mm": [0, 9]},
        "at_mm",
        "beside at_deg",
    ),
    "rows of another length": (
        "load", {"on": "C", "table": [1, 2], "at_deg": [0, 9, 360]}, "at_deg", "table has 2",
    ),
    "ways that fall": (
        "load", {"on": "C", "table": [1, 2], "at_mm": [9, 0]}, "at_mm[1]", "below the value",
    ),
    "a formula of two": (
        "load", {"on": "C", "formula": "q*x"}, "formula", "x and q cannot be mixed",
    ),
    "a formula of nothing known": (
        "load", {"on": "C", "formula": "2*y"}, "formula", "y",
    ),
    "a formula of a pair's angle": (
        "load", {"on": "C", "formula": "2*phi1"}, "formula",
        "unknown name 'phi1' (did you mean q?)",
    ),
    "an empty formula": (
        "load", {"on": "C", "formula": " "}, "formula", "q or the place x or the velocity v, pi",
    ),
    "a mass of a joint": ("mass", {"of": "C", "mass_kg": 1}, "of", "is a joint"),
    "no mass": ("mass", {"of": "rod"}, "mass_kg", "missing"),
    "no centre": ("mass", {"of": "rod", "mass_kg": 1}, "", "is not given"),
    "two centres": (
        "mass", {"of": "rod", "mass_kg": 1, "at_mm": [1, 2], "center": "B"}, "at_mm", "beside",
    ),
    "a centre without a mass": (
        "mass", {"of": "rod", "inertia_kg_m2": 1, "center": "B"}, "mass_kg", "missing",
    ),
    "no such centre": (
        "mass", {"of": "rod", "mass_kg": 1, "center": "G"}, "center", "nothing has this name",
    ),
    "a mass of a shaft": (
        "mass", {"of": "pair.wheel2", "mass_kg": 1, "at_mm": [1, 0]}, "mass_kg", "stands still",
    ),
    "no spring": ("spring", {"on": "C"}, "stiffness_n_mm", "missing"),
    "neither place": ("spring", {"stiffness_n_mm": 1}, "", "neither"),
    "both springs": (
        "spring",
        {"on": "C", "stiffness_n_mm": 1, "preload_nm": 2},
        "preload_nm",
        "does not go with",
    ),
    "a spring of a member": (
        "spring", {"on": "rod", "stiffness_n_mm": 1}, "on", "straight spring about an angle",
    ),
    "a spring of a slide": (
        "spring", {"on": "C", "stiffness_nm_rad": 1}, "on", "about an angle along a line",
    ),
    "a spring of a point": ("spring", {"on": "B", "stiffness_n_mm": 1}, "on", "along no guide"),
    "a joint to a member": (
        "spring", {"between": ["B", "rod"], "stiffness_n_mm": 1}, "between", "a joint to a member",
    ),
    "a joint to itself": (
        "spring", {"between": ["B", "B"], "stiffness_n_mm": 1}, "between[1]", "first one again",
    ),
    "a free angle": (
        "spring",
        {"between": ["crank", "rod"], "stiffness_nm_rad": 1, "free_length_mm": 3},
        "free_length_mm",
        "does not apply",
    ),
    "no such joint": (
        "spring", {"between": ["B", "D"], "stiffness_n_mm": 1}, "between[1]", "nothing has",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", FAULTS)
def test_fault(case: str) -> None:
    title, table, key, words = FAULTS[case]
    found = problems("slide behind a pair", **{title: [table]})
    place = f"{title}[0].{key}" if key else f"{title}[0]"
    assert [one.key for one in found] == [place], found
    assert words in f"{found[0].message} {found[0].value} {found[0].allowed}", found


def test_what_a_drive_pushes_moves_along_its_own_way_only() -> None:
    load = [{"on": "cam_x.follower", "force_n": [1, 2]}]
    found = problems("table on two cams", load=load)
    assert [one.key for one in found][:1] == ["load[0].on"]


def test_loads_are_written_as_they_were_read() -> None:
    tables = {"kind": "mechanism", "name": "mine", **MACHINES["slide behind a pair"]}
    given: dict[str, Any] = {
        "load": [
            {"on": "C", "force_n": -5, "from_deg": 10, "to_deg": 20},
            {"on": "B", "force_n": [1, 2]},
        ],
        "mass": [{"of": "rod", "mass_kg": 3, "at_mm": [60, 0]}],
        "spring": [{"between": ["crank", "rod"], "stiffness_nm_rad": 2}],
        "gravity": {"direction_deg": -90},
    }
    document = gc.design({**tables, **given}).to_dict()
    for one, wanted in zip(document["load"], given["load"], strict=True):
        assert {key: one[key] for key in wanted} == wanted
    assert document["gravity"]["direction_deg"] == -90.0
    assert document["mass"][0]["at_mm"] == [60, 0]
    assert document["spring"][0]["between"] == ["crank", "rod"]
