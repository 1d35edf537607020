"""Sweeps and searches from Python: rows as they come, columns, going on, what is refused."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import gearcam as gc
from gearcam.cli import main
from helpers_pairs import PROFILES
from helpers_processes import ENVIRONMENT

PAIR = gc.load(PROFILES / "ellipse.toml").with_({"output.files": ["csv"], "pair.teeth": [20, 20]})
KEYS = {"law.eccentricity": np.linspace(0.1, 0.4, 3), "pair.teeth": [(20, 20), (24, 24)]}
GOAL = "pair.ratio.max"


@pytest.fixture(scope="module")
def made() -> gc.Sweep:
    """A sweep of six variants that is complete."""
    sweep = gc.sweep(PAIR, KEYS, jobs=1)
    assert len(sweep.rows) == 6
    return sweep


def test_nothing_is_built_before_it_is_asked_for() -> None:
    sweep = gc.sweep(PAIR, KEYS, jobs=1)
    assert (sweep.done, len(sweep)) == (0, 6)
    rows = iter(sweep)
    first = next(rows)
    assert (first.number, sweep.done) == (0, 1)
    rows.close()  # type: ignore[attr-defined]
    assert sweep.done == 1


def test_what_is_missing_is_built_by_the_next_iteration(made: gc.Sweep) -> None:
    sweep = gc.sweep(PAIR, KEYS, jobs=1)
    for row in sweep:
        if row.number == 1:
            break
    again = list(sweep)
    assert [row.number for row in again] == list(range(6))
    assert [row.facts for row in again] == [row.facts for row in made.rows]


def test_columns_have_a_value_for_each_variant(made: gc.Sweep) -> None:
    columns = made.columns
    assert columns["law.eccentricity"].tolist() == [0.1, 0.1, 0.25, 0.25, 0.4, 0.4]
    assert columns["pair.teeth"].tolist() == ["[20, 20]", "[24, 24]"] * 3
    expected = (1.0 + columns["law.eccentricity"]) / (1.0 - columns["law.eccentricity"])
    assert columns[GOAL] == pytest.approx(expected, rel=1e-12)
    assert columns["number"].dtype.kind == columns["errors"].dtype.kind == "i"
    assert made.columns is columns
    assert len(pl.DataFrame(dict(columns))) == 6


def test_a_refused_variant_has_its_reason_and_no_numbers() -> None:
    sweep = gc.sweep(PAIR, {"law.eccentricity": [0.2, 0.99]}, jobs=1)
    columns = sweep.columns
    assert np.isnan(columns[GOAL]).tolist() == [False, True]
    assert columns["refusal"][0] == ""
    assert columns["refusal"][1] == sweep.rows[1].refusal != ""
    assert sweep.tally.refused == 1


def test_samples_are_the_same_for_the_same_seed() -> None:
    keys = {"law.eccentricity": "tolerance(0.3, 0.01)", "pair.module_mm": "1:2"}
    plans = [gc.sweep(PAIR, keys, latin=4, seed=seed).plan for seed in (2, 2, 3)]
    drawn = [[plan.values(k) for k in range(4)] for plan in plans]
    assert drawn[0] == drawn[1] != drawn[2]
    assert all(abs(one["law.eccentricity"] - 0.3) <= 0.01 for one in drawn[0])
    assert len(gc.sweep(PAIR, keys, random=7)) == 7


def test_designs_of_variants_can_be_built(made: gc.Sweep) -> None:
    result = gc.build(made.design(3))
    assert result.record()[GOAL] == made.columns[GOAL][3]
    for wrong in (-1, 6, 1.0, True):
        with pytest.raises(gc.DesignError, match="0 to 5"):
            made.design(wrong)  # type: ignore[arg-type]


def test_progress_is_told_after_each_row() -> None:
    told: list[tuple[int, int]] = []
    keys = {"pair.module_mm": [1, 2]}
    assert gc.sweep(PAIR, keys, jobs=1, progress=lambda *at: told.append(at)).rows
    assert told == [(1, 2), (2, 2)]


def test_a_folder_keeps_rows_and_the_command_goes_on_from_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "pair.toml"
    text = 'kind = "gear-pair"\n[law]\ntype = "ellipse"\neccentricity = 0.3\n[pair]\n'
    file.write_text(text + "module_mm = 1\nteeth = [20, 20]\n[sweep]\npair.module_mm = [1, 2]\n")
    folder = tmp_path / "out"
    with gc.sweep(file, {"law.eccentricity": "0.1,0.3"}, jobs=1, folder=folder) as sweep:
        assert len(sweep) == 4
        next(iter(sweep))
    with gc.sweep(file, {"law.eccentricity": "0.1,0.3"}, jobs=1, folder=folder) as sweep:
        assert sweep.done == 1
        files = sweep.write()
    assert "sweep.csv" in [one.name for one in files]
    words = ["sweep", str(file), "--set", "law.eccentricity=0.1,0.3", "-o", str(folder)]
    assert main([*words, "--jobs", "1"]) == 0
    assert "4 variants, 1 are there" in capsys.readouterr().out
    with pytest.raises(gc.DesignError, match="another sweep"):
        gc.sweep(file, {"law.eccentricity": "0.1,0.2"}, folder=folder)
    table = pl.read_csv(folder / "sweep.csv")
    columns = gc.sweep(file, {"law.eccentricity": "0.1,0.3"}, folder=folder).columns
    assert list(columns) == table.columns
    assert columns[GOAL].tolist() == table[GOAL].to_list()


def test_long_lists_that_differ_in_one_value_are_different_sweeps() -> None:
    lists = [np.linspace(0.1, 0.4, 40) for _ in range(3)]
    lists[2][20] += 1e-6
    plans = [gc.sweep(PAIR, {"law.eccentricity": one}).plan for one in lists]
    assert plans[0].axes[0].text == "40 values, 0.1 to 0.4"
    assert plans[0].head == plans[1].head
    assert plans[0].mark != plans[2].mark


def test_functions_that_differ_are_different_sweeps() -> None:
    def marks(*ratios: Any) -> Iterator[str]:
        for ratio in ratios:
            law = gc.laws.Formula(ratio=ratio)
            base = gc.GearPairDesign(
                name="m", law=law, pair=gc.PairSpec(teeth=(20, 20), module=1.0)
            )
            yield gc.sweep(base, {"pair.module_mm": [1, 2]}).plan.mark

    one, same, other = marks(
        lambda x: 1.0 + 0.1 * np.cos(x), lambda x: 1.0 + 0.1 * np.cos(x), lambda x: 1.0 + 0.2 * x
    )
    assert one == same != other


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"design": 3}, "is no design"),
        ({"keys": 5}, "is no mapping"),
        ({"keys": None}, "nothing is to be varied"),
        ({"keys": {"law.ecc": [0.1]}}, "did you mean eccentricity"),
        ({"keys": {"law.eccentricity": "0.1:0.2"}}, "has no step"),
        ({"keys": {"law.eccentricity": []}}, "has no value"),
        ({"random": 0}, "is not a number of samples"),
        ({"random": 2, "latin": 2}, "one of them"),
        ({"random": 2, "seed": -1}, "is not a seed"),
        ({"jobs": 0}, "jobs: is not above 0"),
        ({"jobs": 1.5}, "jobs: is not above 0"),
        ({"limit": -1}, "limit: is not above 0"),
        ({"memory": "much"}, "memory: is not"),
        ({"client": "dask"}, "has no submit"),
        ({"client": pytest, "jobs": 2}, "both given"),
    ],
)
def test_mistakes_are_refused_before_anything_is_built(words: Any, message: str) -> None:
    given = {"design": PAIR, "keys": {"law.eccentricity": [0.1, 0.2]}} | words
    with pytest.raises(gc.DesignError) as raised:
        gc.sweep(given.pop("design"), given.pop("keys"), **given)
    assert message in " ".join(str(raised.value).split())


def test_a_script_without_a_guard_is_told_once(tmp_path: Path) -> None:
    """Its processes read it, and would start processes of their own."""
    file = tmp_path / "script.py"
    call = f'gearcam.sweep("{PROFILES}/ellipse.toml", {{"law.eccentricity": [0.1, 0.2]}})'
    file.write_text(f"import gearcam\n{call}.rows\n")
    done = subprocess.run(
        [sys.executable, str(file)], env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert done.stderr.count("__main__") == 1
    assert done.stderr.count("Traceback") == 1


def test_the_best_is_that_of_the_command(tmp_path: Path) -> None:
    keys = {"law.eccentricity": "0.1:0.4"}
    words: dict[str, Any] = {"minimize": GOAL, "method": "random", "trials": 6, "jobs": 1}
    found = gc.optimize(PAIR, keys, **words)
    assert len(found.rows) == 6
    (best,) = found.best
    assert best.facts[GOAL] == found.columns[GOAL].min()
    assert found.designs[0].to_dict()["law"] == PAIR.with_(best.values).to_dict()["law"]
    with gc.optimize(PAIR, keys, folder=tmp_path / "one", **words) as again:
        files = {one.name for one in again.write()}
    assert files >= {"optimize.csv", "optimize.html", "best.toml"}
    written = gc.load(tmp_path / "one" / "best.toml").to_dict()["law"]
    assert written == found.designs[0].to_dict()["law"]
    with gc.optimize(PAIR, keys, folder=tmp_path / "one", **words) as third:  # all are known
        assert [one.time_s for one in third.rows] == [one.time_s for one in again.rows]


def test_a_search_of_several_goals_has_their_front() -> None:
    goals = ("pair.ratio.max", "pair.center_distance_mm")
    keys = {"law.eccentricity": "0.1:0.4", "pair.module_mm": "1:2"}
    found = gc.optimize(PAIR, keys, minimize=goals, method="random", trials=12, jobs=1)
    front = [tuple(row.facts[name] for name in goals) for row in found.best]
    assert front == sorted(front)
    assert [b for _, b in front] == sorted((b for _, b in front), reverse=True)
    with pytest.raises(gc.DesignError, match="no fact of this design"):
        gc.optimize(PAIR, keys, minimize="pair.ratio.maxx")
    with pytest.raises(gc.DesignError, match="no goal is given"):
        gc.optimize(PAIR, keys)


def test_none_that_may_be_taken_is_said() -> None:
    found = gc.optimize(
        PAIR, {"law.eccentricity": "0.98:0.99"}, minimize=GOAL, method="random", trials=2, jobs=1
    )
    with pytest.raises(gc.InfeasibleError, match="none of 2 variants"):
        _ = found.best
