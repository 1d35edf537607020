"""The command accuracy: table, files, figure, refusals; and how it takes times."""

from __future__ import annotations

import json
import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import polars as pl
import pytest

import gearcam
from gearcam.base.errors import DesignError, GearcamError
from gearcam.cli import main
from gearcam.kinds.cam import ladders as room
from gearcam.results.accuracy import accuracy, stages_of
from gearcam.results.ladders import Ladder

TEXT = """
kind = "cam"
name = "cam"
motion = [
  { type = "rise", law = "4-5-6-7", angle_deg = 120, lift_mm = 10 },
  { type = "return", law = "4-5-6-7", angle_deg = 240 },
]
follower = { type = "roller", roller_radius_mm = 8 }
cam = { base_radius_mm = 40, thickness_mm = 10 }
output = { files = ["csv"] }
"""


@pytest.fixture
def design(tmp_path: Path) -> str:
    path = tmp_path / "cam.toml"
    path.write_text(TEXT, encoding="utf-8")
    return str(path)


def run(design: str, *options: str) -> tuple[int, Path]:
    folder = Path(design).parent / "out"
    return main(["accuracy", design, "-o", str(folder), *options]), folder / "cam"


def ladder(make: Any = float, **more: Any) -> Ladder:
    """A ladder whose error is 1/level^2 at so many points."""
    given = {"levels": (10.0, 20.0, 40.0), "own": 20.0, "order": 2.0, "rounding": 0.0, **more}
    return Ladder(
        refined="steps",
        measured="nothing",
        unit="mm",
        make=make,
        measure=lambda made: (made**-2.0, int(made)),
        **given,
    )


@pytest.fixture
def planted(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Ladders that stand for those of cams."""
    made: dict[str, Any] = {}
    monkeypatch.setattr(room, "LADDERS", made)
    return made


# --- what is told -------------------------------------------------------------------------------


def test_table_and_file_tell_the_same(design: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, folder = run(design, "--stage", "cam,outline", "--repeat", "2")
    assert code == 0
    told = capsys.readouterr().out
    rows = pl.read_csv(folder / "accuracy.csv")
    assert rows.columns[:5] == ["stage", "measured", "method", "refined", "level"]
    assert rows["stage"].unique(maintain_order=True).to_list() == ["outline", "cam"]
    lines = iter(told.splitlines())
    for row in rows.iter_rows(named=True):
        cells = next(line.split() for line in lines if f"{row['error']:.2e} {row['unit']}" in line)
        assert float(cells[0]) == pytest.approx(row["level"], rel=1e-5)
        assert ("*" in cells) == (row["own"] == 1)
        assert int(cells[-1]) == row["points"]
        assert float(cells[-3]) == pytest.approx(1e3 * row["time_s"], abs=1e-3)
    assert "order 2.00, expected 2" in told
    assert "median of 2 runs" in told


def test_orders_in_the_file_are_slopes_of_its_errors(design: str) -> None:
    _, folder = run(design, "--stage", "cam", "--repeat", "1")
    rows = pl.read_csv(folder / "accuracy.csv").to_dicts()
    assert rows[0]["order"] is None
    for before, row in pairwise(rows):
        slope = math.log(before["error"] / row["error"], row["points"] / before["points"])
        assert row["order"] == pytest.approx(slope)


def test_the_files_of_a_build_stay(design: str) -> None:
    folder = Path(design).parent / "out"
    assert main(["build", design, "-o", str(folder)]) == 0
    before = set(json.loads((folder / "cam/summary.json").read_text("utf-8"))["files"])
    run(design, "--stage", "cam", "--repeat", "1")
    after = set(json.loads((folder / "cam/summary.json").read_text("utf-8"))["files"])
    assert after == before | {"accuracy.csv", "accuracy.html"}
    assert all((folder / "cam" / name).exists() for name in after)


# --- refusals -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--stage", "outlin"), ('"outlin" is not a stage', "did you mean outline?")),
        (("--stage", "centrode"), ('"centrode" is not a stage of designs of kind cam',)),
        (("--stage", "cam,law"), ('"law" is not a stage of designs of kind cam',)),
        (("--stage", ","), ("the list is empty",)),
    ],
)
def test_other_stages_are_refused(
    design: str, capsys: pytest.CaptureFixture[str], options: tuple[str, ...], said: tuple[str, ...]
) -> None:
    code, folder = run(design, *options)
    assert code == 2
    told = capsys.readouterr().err
    assert all(words in told for words in said)
    assert "allowed: outline, solid, contact, cam" in told or "the list is empty" in told
    assert not folder.exists()


@pytest.mark.parametrize("count", ["0", "-3"])
def test_no_repeats_are_refused(
    design: str, capsys: pytest.CaptureFixture[str], count: str
) -> None:
    code, folder = run(design, "--repeat", count)
    assert code == 2
    told = capsys.readouterr().err
    assert "accuracy.repeat" in told
    assert "from 1 to 1000" in told
    assert not folder.exists()


def test_python_is_refused_the_same() -> None:
    result = gearcam.build(gearcam.loads(TEXT))
    with pytest.raises(DesignError, match="1 or more"):
        accuracy(result, repeat=0)
    with pytest.raises(DesignError, match="is not a stage"):
        accuracy(result, ["centrode"])


def test_a_kind_without_ladders_has_no_stages(planted: dict[str, Any]) -> None:
    assert planted == {}
    with pytest.raises(DesignError, match="none of designs of kind cam"):
        stages_of(gearcam.loads(TEXT))


# --- how it is measured -------------------------------------------------------------------------


def test_levels_take_turns(planted: dict[str, Any]) -> None:
    calls: list[float] = []

    def make(level: float) -> float:
        calls.append(level)
        return level

    planted["one"] = lambda _: ladder(make)
    planted["two"] = lambda _: ladder(lambda level: make(-level) and level)
    found = accuracy(gearcam.build(gearcam.loads(TEXT)), repeat=4)
    assert len(calls) == 6 * 5
    rounds = [calls[k : k + 6] for k in range(0, 30, 6)]
    for number, one in enumerate(rounds):
        assert {abs(level) for level in one[:3]} == {10.0, 20.0, 40.0}
        assert min(one[:3]) > 0.0 > max(one[3:])
        assert number == 0 or one[0] == (10.0, 20.0, 40.0)[(number - 1) % 3]
    assert [rung.stage for rung in found.rungs] == ["one"] * 3 + ["two"] * 3
    assert found.order("one") == pytest.approx(2.0)
    assert [rung.own for rung in found.of("one")] == [False, True, False]


def test_the_median_counts(planted: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    planted["one"] = lambda _: ladder(levels=(10.0,))
    clock = iter([0.0, 5.0, 10.0, 11.0, 20.0, 22.0])
    result = gearcam.build(gearcam.loads(TEXT))
    with monkeypatch.context() as patched:
        patched.setattr("gearcam.results.accuracy.time.perf_counter", lambda: next(clock))
        found = accuracy(result, repeat=3)
    assert found.rungs[0].seconds == 2.0


def test_a_level_that_cannot_be_made_is_left_out_by_name(planted: dict[str, Any]) -> None:
    def make(level: float) -> float:
        if level < 15.0:
            raise GearcamError("it falls apart")
        return level

    planted["one"] = lambda _: ladder(make)
    found = accuracy(gearcam.build(gearcam.loads(TEXT)), repeat=1)
    assert [rung.level for rung in found.rungs] == [20.0, 40.0]
    assert "  10: left out: it falls apart" in list(found.lines())
    planted["one"] = lambda _: ladder(make, levels=(10.0, 12.0))
    with pytest.raises(GearcamError, match="falls apart"):
        accuracy(gearcam.build(gearcam.loads(TEXT)), repeat=1)


def test_a_stage_that_cannot_be_made_is_left_out_by_name(planted: dict[str, Any]) -> None:
    def fall(_: object) -> Ladder:
        raise GearcamError("it falls apart")

    planted |= {"one": lambda _: ladder(), "two": fall}
    result = gearcam.build(gearcam.loads(TEXT))
    found = accuracy(result, repeat=1)
    assert {rung.stage for rung in found.rungs} == {"one"}
    assert list(found.lines())[-1] == "two: left out: it falls apart"
    with pytest.raises(GearcamError, match="falls apart"):
        accuracy(result, ["two"], repeat=1)


def test_rounding_has_no_order(planted: dict[str, Any]) -> None:
    planted["one"] = lambda _: ladder(rounding=1e-3)
    found = accuracy(gearcam.build(gearcam.loads(TEXT)), repeat=1)
    assert [rung.order for rung in found.rungs] == [None, pytest.approx(2.0), None]
    assert any("order 2.00, expected 2" in line for line in found.lines())
    planted["one"] = lambda _: ladder(rounding=1.0)
    found = accuracy(gearcam.build(gearcam.loads(TEXT)), repeat=1)
    assert found.order("one") is None
    assert any("rounding, expected 2" in line for line in found.lines())


# --- the figure ---------------------------------------------------------------------------------


def test_every_level_is_drawn_and_the_own_is_marked(planted: dict[str, Any]) -> None:
    planted["one"] = lambda _: ladder()
    planted["two"] = lambda _: ladder(own=None)
    one, two = accuracy(gearcam.build(gearcam.loads(TEXT)), repeat=1).charts
    assert (one.title, one.log, one.y) == ("one", "xy", "error of nothing, mm")
    assert [(len(line.x), line.dots) for line in one.lines] == [(3, False), (3, True), (1, True)]
    assert one.lines[0].y.tolist() == [0.01, 0.0025, 0.000625]
    assert one.lines[2].y.tolist() == [0.0025]
    assert [line.label for line in two.lines] == ["error", "levels: steps"]


def test_the_page_shows_the_charts_and_the_printed_table(
    design: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, folder = run(design, "--stage", "cam,outline", "--repeat", "1")
    assert code == 0
    page = (folder / "accuracy.html").read_text("utf-8")
    (shown,) = re.findall(r"<pre>(error against run time.*?)</pre>", page, re.DOTALL)
    printed = capsys.readouterr().out
    assert all(f"  {line}".rstrip() in printed.splitlines() for line in shown.splitlines())
    (data,) = re.findall(r'id="document">(.*?)</script>', page)
    rows = pl.read_csv(folder / "accuracy.csv")
    for chart in json.loads(data)["charts"]:
        of = rows.filter(pl.col("stage") == chart["title"])
        line = chart["lines"][0]
        times = {"s": 1.0, "ms": 1e3, "us": 1e6}[chart["x"].rpartition(", ")[2]]
        assert line["x"] == pytest.approx([times * t for t in of["time_s"]], rel=1e-5)
        errors = [chart["factor"] * one for one in of["error"].to_list()]
        assert line["y"] == pytest.approx(errors, rel=1e-5)
