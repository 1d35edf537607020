"""The page of a sweep: its columns, and the design file of each variant."""

from __future__ import annotations

import json
import re
from typing import Any

import gearcam as gc
from gearcam.designs.writing import toml_text
from gearcam.sweep.page import file_text, page
from gearcam.sweep.rows import Built, measured
from helpers_pairs import PROFILES
from helpers_sweep import BASE


def put_in(text: str, values: dict[str, Any]) -> str:
    """Return the text of a design file as the page makes it."""
    for number, value in enumerate(values.values()):
        text = text.replace(f'"@@{number}@@"', json.dumps(value))
    return text.replace('"@@name@@"', json.dumps(BASE.name))


def held(content: bytes) -> Any:
    found = re.search(rb'id="document">(.*?)</script>', content, re.DOTALL)
    assert found
    return json.loads(found[1])


def test_values_are_put_into_a_file_that_is_the_variant() -> None:
    values = {
        "law.eccentricity": 0.21,
        "pair.teeth[0]": 31,
        "pair.teeth[1]": 31,
        "blank.bore_diameter_mm": [6, 8],
        "output.files": ["dxf"],
        "limits.contact_ratio": 1.1,
    }
    text = put_in(file_text(BASE, list(values)), values)
    assert gc.loads(text) == BASE.with_(values)


def test_values_in_a_list_of_tables_are_put_in() -> None:
    base = gc.load(PROFILES / "valve_tolerances.toml")
    values = {"spring[0].preload_n": 99.5, "mass[0].mass_kg": 0.1, "friction.guide": 0.2}
    text = put_in(file_text(base, list(values)), values).replace(BASE.name, base.name)
    assert gc.loads(text) == base.with_(values)
    assert gc.loads(toml_text(base.to_dict())) == base


def test_columns_are_those_that_differ() -> None:
    rows = [measured(BASE, k, {"law.eccentricity": e}) for k, e in enumerate((0.1, 0.2, 3.0))]
    content = held(page(BASE, rows, ["one line"]))
    columns = {one["name"]: one for one in content["columns"]}
    assert columns["law.eccentricity"]["values"] == [0.1, 0.2, 3.0]
    assert columns["law.eccentricity"]["input"]
    least = columns["pair.ratio.min"]["values"]
    assert least[2] is None
    assert least[:2] == [float(f"{row.facts['pair.ratio.min']:.7g}") for row in rows[:2]]
    assert "pair.module_mm" not in columns
    assert content["refused"] == [-1, -1, 0]
    assert "eccentricity" in content["reasons"][0]
    assert content["x"] == "law.eccentricity"


def test_a_fact_with_the_name_of_a_key_is_one_column() -> None:
    base = gc.load(PROFILES / "valve_tolerances.toml")
    rows = [
        Built(number=k, values={"cam.base_radius_mm": r}, facts={"cam.base_radius_mm": r, "a": r})
        for k, r in enumerate((27.0, 28.0))
    ]
    names = [one["name"] for one in held(page(base, rows, []))["columns"]]
    assert names == ["cam.base_radius_mm", "a"]


def test_goals_are_set_before() -> None:
    rows = [Built(number=k, values={"a": k}, facts={"b": float(k), "c": -k}) for k in range(3)]
    content = held(page(BASE, rows, [], {"b": 1.0, "c": -1.0}))
    assert content["goals"] == {"b": "1", "c": "-1"}
    assert content["y"] == "b"
