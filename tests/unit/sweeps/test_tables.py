"""Tables of sweeps, read by another reader."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from gearcam.sweeps.log import Log
from gearcam.sweeps.rows import Built
from gearcam.sweeps.tables import Tally, columns_of, write_tables

ROWS = [
    Built(
        number=0,
        values={"law.eccentricity": 0.1 + 0.2, "pair.teeth": [20, 24], "law.type": "a, b"},
        facts={"size_mm": 1.0 / 3.0, "cutter": "rack"},
        findings=("undercut", "thin-wall"),
        errors=1,
        time_s=0.5,
    ),
    Built(
        number=1,
        values={"law.eccentricity": 3, "pair.teeth": [20, 24], "law.type": "a, b"},
        refusal='"3" is too large',
        time_s=0.1,
    ),
    Built(
        number=2,
        values={"law.eccentricity": 0.2, "pair.teeth": [20, 24], "law.type": "a, b"},
        facts={"size_mm": 2.0, "more": 1e-12},
    ),
]


@pytest.fixture
def tables(tmp_path: Path) -> tuple[Tally, Path]:
    with Log(tmp_path, {"sweep": "x"}) as log:
        for number in (2, 0, 1):
            log.append(ROWS[number])
        tally, _ = write_tables(log, tmp_path)
    return tally, tmp_path


def test_the_table_has_a_row_for_each_variant(tables: tuple[Tally, Path]) -> None:
    tally, folder = tables
    table = pl.read_csv(folder / "sweep.csv")
    assert table.columns == [
        "number", "law.eccentricity", "pair.teeth", "law.type", "size_mm", "cutter", "more",
        "findings", "errors", "refusal", "time_s",
    ]  # fmt: skip
    assert table["number"].to_list() == [0, 1, 2]
    assert table["law.eccentricity"].to_list() == [0.1 + 0.2, 3.0, 0.2]
    assert table["pair.teeth"].to_list() == ["[20, 24]"] * 3
    assert table["size_mm"].to_list() == [1.0 / 3.0, None, 2.0]
    assert table["cutter"].to_list() == ["rack", None, None]
    assert table["findings"].to_list()[0] == "undercut thin-wall"
    assert table["refusal"].to_list()[1] == '"3" is too large'
    assert (tally.rows, tally.refused, tally.wrong) == (3, 1, 1)
    assert {one.name for one in folder.iterdir()} <= {"sweep.csv", "sweep.log", "sweep.parquet"}


def test_a_number_that_is_left_out_is_nan(tmp_path: Path) -> None:
    key = "pair.module_mm"
    with Log(tmp_path, {"sweep": "x"}) as log:
        for number, value in enumerate([None, 1]):
            log.append(Built(number=number, values={key: value, "law.type": value and "a"}))
        columns = columns_of(log)
        write_tables(log, tmp_path)
    assert columns[key].dtype.kind == "f"
    assert np.isnan(columns[key]).tolist() == [True, False]
    assert columns[key][1] == 1.0
    assert columns["law.type"].tolist() == ["", "a"]
    assert (tmp_path / "sweep.csv").read_text().splitlines()[1].startswith("0,,,")
    table = pl.read_csv(tmp_path / "sweep.csv")
    assert table[key].to_list() == [None, 1]
    if importlib.util.find_spec("pyarrow"):
        assert pl.read_parquet(tmp_path / "sweep.parquet")[key].to_list() == [None, 1.0]


def test_parquet_has_the_same_with_types(tables: tuple[Tally, Path]) -> None:
    pytest.importorskip("pyarrow")
    _, folder = tables
    table, plain = pl.read_parquet(folder / "sweep.parquet"), pl.read_csv(folder / "sweep.csv")
    assert table.columns == plain.columns
    assert table.schema["number"] == pl.Int64
    assert table.schema["law.eccentricity"] == pl.Float64
    assert table.schema["pair.teeth"] == pl.String
    assert table["more"].to_list() == [None, None, 1e-12]
    for name in plain.columns:
        expected = [None if one == "" else one for one in plain[name].to_list()]
        found = [None if one == "" else one for one in table[name].to_list()]
        assert found == expected, name
