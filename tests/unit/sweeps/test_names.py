"""Names of columns and facts: the nearest of unknown ones, and either name of a key."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.results.record import Record
from helpers_built import built
from helpers_pairs import PROFILES

PAIR = gc.load(PROFILES / "ellipse.toml").with_({"pair.teeth": [20, 20]})
FOUND: dict[str, Callable[[], Mapping[str, Any]]] = {
    "columns": lambda: gc.sweep(PAIR, {"pair.module_mm": [1]}, jobs=1).columns,
    "row": lambda: gc.sweep(PAIR, {"pair.module_mm": [1]}, jobs=1).rows[0].facts,
    "record": lambda: built(PAIR).record(),
    "facts": lambda: built(PAIR).facts,
}


@pytest.mark.parametrize("name", FOUND)
def test_an_unknown_name_is_told_the_nearest(name: str) -> None:
    found = FOUND[name]()
    with pytest.raises(KeyError, match=r"'pair\.ratio\.maxx' .* did you mean pair\.ratio\.max"):
        found["pair.ratio.maxx"]
    assert "pair.ratio.maxx" not in found
    assert found.get("pair.ratio.maxx") is None
    again = pickle.loads(pickle.dumps(found))
    with pytest.raises(KeyError, match="did you mean") as error:
        again["pair.ratio.maxx"]
    assert str(pickle.loads(pickle.dumps(error.value))) == str(error.value)
    # either name, and places in brackets
    for one in (found, again):
        assert np.all(one["rack.addendum"] == one["pair.rack.addendum"])
        if name == "facts":
            assert one["gears[0].size_mm"] == one["gears.0.size_mm"]
            assert one["gears[0].size_mm[1]"] == one["gears.0.size_mm"][1]
        else:
            assert np.all(one["gears[0].size_mm[1]"] == one["gears.0.size_mm.1"])


def test_a_table_of_a_study_tells_the_nearest_name() -> None:
    study = built(PAIR.with_({"meshing.steps": 4})).study("mesh")
    with pytest.raises(KeyError, match=r"'phi1' .* did you mean phi1_deg"):
        study.columns["phi1"]


def test_where_all_are_refused_the_reason_is_told(tmp_path: Path) -> None:
    keys = {"law.eccentricity": [0.99, 0.995], "rack.addendum": [1.0]}
    sweep = gc.sweep(PAIR, keys, jobs=1, folder=tmp_path)
    assert len(sweep.rows) == sweep.tally.refused == 2
    with pytest.raises(KeyError, match=r"all 2 variants were refused: \S+"):
        sweep.columns["pair.ratio.max"]
    assert sweep.columns["pair.rack.addendum"].tolist() == [1.0, 1.0]
    with pytest.raises(KeyError, match=r"this variant was refused: \S+"):
        sweep.rows[0].facts["pair.ratio.max"]


def test_a_record_stays_a_record_in_a_row() -> None:
    row = gc.sweep(PAIR, {"pair.module_mm": [1]}, jobs=1).rows[0]
    assert isinstance(row.facts, Record)
    assert json.loads(json.dumps(asdict(row)))["facts"] == row.facts
