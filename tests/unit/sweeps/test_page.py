"""The page of a sweep: its columns, and the design file of each variant."""

from __future__ import annotations

import base64
import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import GearcamError
from gearcam.designs.writing import toml_text
from gearcam.sweeps.page import file_text, page
from gearcam.sweeps.rows import Built, measured
from helpers_pairs import PROFILES
from helpers_sweep import BASE


def put_in(text: str, values: dict[str, Any]) -> str:
    """Return the text of a design file as the page makes it."""
    for number, value in enumerate(values.values()):
        text = text.replace(f'"@@{number}@@"', json.dumps(value))
    return text.replace('"@@name@@"', json.dumps(BASE.name))


def held(content: bytes) -> Any:
    """Return the content of a page, its columns by their names with their values."""
    found = re.search(rb'id="document">(.*?)</script>', content, re.DOTALL)
    assert found
    document = json.loads(found[1])
    document["columns"] = {one["name"]: one for one in document["columns"]}
    for one in document["columns"].values():
        data = np.frombuffer(base64.b64decode(one["data"]), "<f8" if one["input"] else "<f4")
        one["values"] = [None if np.isnan(value) else float(value) for value in data]
    return document


def rows_of(values: dict[str, list[Any]], facts: dict[str, list[Any]]) -> list[Built]:
    count = len(next(iter(values.values())))
    return [
        Built(
            number=k,
            values={key: given[k] for key, given in values.items()},
            facts={name: given[k] for name, given in facts.items() if given[k] is not None},
        )
        for k in range(count)
    ]


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


def test_one_of_two_values_that_are_written_as_one_is_put_in() -> None:
    base = BASE.with_({"blank.bore_diameter_mm": [6, 6]})
    values = {"blank.bore_diameter_mm[1]": 7.5}
    assert gc.loads(put_in(file_text(base, list(values)), values)) == base.with_(values)


def test_files_that_a_design_names_are_named_from_the_root(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(PROFILES)
    base = gc.load("measured.toml")
    file = tmp_path / "saved.toml"
    file.write_text(put_in(file_text(base, ["pair.module_mm"]), {"pair.module_mm": 3}))
    law: Any = gc.load(file).to_dict()["law"]
    assert Path(law["file"]) == (PROFILES / "measured.csv").resolve()


def test_columns_are_those_that_differ() -> None:
    rows = [measured(BASE, k, {"law.eccentricity": e}) for k, e in enumerate((0.1, 0.2, 3.0))]
    content = held(page(BASE, iter(rows), ["one line"]))
    columns = content["columns"]
    assert columns["law.eccentricity"]["values"] == [0.1, 0.2, 3.0]
    assert columns["law.eccentricity"]["input"]
    least = columns["pair.ratio.min"]["values"]
    assert least[2] is None
    assert least[:2] == pytest.approx([row.facts["pair.ratio.min"] for row in rows[:2]], rel=1e-7)
    assert "pair.module_mm" not in columns
    assert content["refused"] == [-1, -1, 0]
    assert "eccentricity" in content["reasons"][0]
    assert content["x"] == "law.eccentricity"


def test_facts_that_are_the_same_are_listed_with_their_values() -> None:
    facts: dict[str, list[Any]] = {"a": [2.5, None, 2.5], "t": ["x", "x", "y"], "u": ["z"] * 3}
    content = page(BASE, rows_of({"k": [1, 2, 3]}, facts), [])
    listed = re.findall(r"<li>(.*?)</li>", content.decode())
    assert listed == ["a = 2.5", "u = z"]
    assert held(content)["columns"]["t"]["words"] == ["x", "y"]


def test_values_that_are_no_numbers_are_words_of_a_design_file() -> None:
    values: list[Any] = [[20, 21], "auto", 3, 0.5, True, {"n": 1.5}, [20, 21]]
    column = held(page(BASE, rows_of({"k": values}, {"a": list(range(7))}), []))["columns"]["k"]
    words = ["[20, 21]", '"auto"', "3", "0.5", "true", "{ n = 1.5 }"]
    assert column["words"] == words
    assert column["values"] == [0, 1, 2, 3, 4, 5, 0]
    assert [tomllib.loads(f"k = {one}")["k"] for one in words] == values[:6]


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan])
def test_a_fact_that_is_not_finite_has_no_place(value: float) -> None:
    rows = rows_of({"k": [1, 2, 3]}, {"a": [1.0, value, 2.0]})
    assert held(page(BASE, rows, []))["columns"]["a"]["values"] == [1.0, None, 2.0]


def test_reasons_that_differ_in_numbers_only_are_counted_together() -> None:
    reasons = [f"x{k}: {0.1 * k:g} is above 1e-{k}" for k in (1, 1, 1)]
    reasons += ["x1: -7 is above 12.5", "it breaks"]
    rows = [Built(number=k, values={"k": k}, refusal=one) for k, one in enumerate(reasons)]
    text = page(BASE, rows, []).decode()
    assert re.findall(r"<li>(.*?)</li>", text) == ["4: x1: … is above …", "1: it breaks"]
    assert held(text.encode())["reasons"] == list(dict.fromkeys(reasons))


def test_many_reasons_are_cut_off() -> None:
    rows = [Built(number=k, values={"k": k}, refusal="no" + "o" * k) for k in range(30)]
    listed = re.findall(r"<li>(.*?)</li>", page(BASE, rows, []).decode())
    assert len(listed) == 21
    assert listed[-1] == "10: other reasons"


def test_the_time_is_told() -> None:
    rows = [Built(number=k, values={"k": k}, time_s=k / 1e3) for k in range(101)]
    assert (
        "time: 5 % up to 5 ms, 50 % up to 50 ms, 95 % up to 95 ms" in page(BASE, rows, []).decode()
    )


def test_a_design_that_is_impossible_itself_can_be_varied(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: gc.Design) -> None:
        raise GearcamError("no")

    monkeypatch.setattr(gc, "build", refuse)
    content = held(page(BASE, rows_of({"k": [1, 2]}, {"a": [1.0, 2.0]}), []))
    assert (content["x"], content["y"]) == ("k", "a")


def test_a_fact_with_the_name_of_a_key_is_one_column() -> None:
    base = gc.load(PROFILES / "valve_tolerances.toml")
    rows = [
        Built(number=k, values={"cam.base_radius_mm": r}, facts={"cam.base_radius_mm": r, "a": r})
        for k, r in enumerate((27.0, 28.0))
    ]
    assert list(held(page(base, rows, []))["columns"]) == ["cam.base_radius_mm", "a"]


def test_goals_are_set_before() -> None:
    rows = [Built(number=k, values={"a": k}, facts={"b": float(k), "c": -k}) for k in range(3)]
    content = held(page(BASE, rows, [], {"b": 1.0, "c": -1.0}))
    assert content["goals"] == {"b": "1", "c": "-1"}
    assert (content["x"], content["y"]) == ("b", "c")


def test_facts_have_units_in_which_they_are_read_at_a_glance() -> None:
    rows = rows_of({"k": [1, 2]}, {"a_mm_s2": [1e5, 2e5], "b_mm": [3.0, 4.0]})
    columns = held(page(BASE, rows, []))["columns"]
    assert [columns["a_mm_s2"][key] for key in ("label", "unit", "factor")] == ["a", "m/s2", 1e-3]
    assert columns["a_mm_s2"]["values"] == [1e5, 2e5]
    assert [columns["b_mm"][key] for key in ("unit", "factor")] == ["mm", 1.0]
