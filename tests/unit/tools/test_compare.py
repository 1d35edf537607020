"""The tools that draw random designs and compare what two trees make of them."""

from __future__ import annotations

import io
import json
import math
import tomllib
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest

import compare
from compare_files import called, files, folders, summaries, told
from compare_sides import Side
from helpers_sampling import chosen
from random_designs.cam import FOLLOWERS, in_turn
from random_designs.designs import MAKERS, design
from random_designs.documented import known_keys, schema

Document = dict[str, Any]

MOST = 5000
"""Designs of each kind within which everything is drawn, whatever is added; usually 400 are enough,
but what one design in 300 has is missing in the first 400 of every fourth seed."""


@cache
def document(kind: str, index: int) -> Document:
    """A random design as its tables; without any if it has an error on purpose."""
    drawn = design(kind, 1, index)
    return {} if drawn.broken else tomllib.loads(next(iter(drawn.files.values())))


def never_drawn(
    kind: str, wanted: set[Any], names: Callable[[Document], Iterable[Any]]
) -> set[Any]:
    """Which of the wanted names no random design has."""
    missing = set(wanted)
    for index in range(MOST):
        missing.difference_update(names(document(kind, index)))
        if not missing:
            break
    return missing


def choices(kind: str, title: str, key: str) -> set[str]:
    """What the schema lets a key be."""
    node = known_keys(schema(), {"kind": kind})[title]
    table = known_keys(node.get("items", node), {"type": "rise"})
    return set(table[key].get("enum") or table[key]["items"]["enum"])


# --- the generator ------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", MAKERS)
def test_a_design_is_told_by_its_seed_and_number(kind: str) -> None:
    first = [design(kind, 7, index) for index in range(20)]
    assert [design(kind, 7, index) for index in (19, 3)] == [first[19], first[3]]
    assert design(kind, 8, 3) != design(kind, 7, 3)


def test_every_kind_of_the_program_is_drawn() -> None:
    assert set(MAKERS) == set(schema()["properties"]["kind"]["enum"])


def laws(made: Document) -> Iterator[str | tuple[str, str]]:
    law = made.get("law", {})
    yield law.get("type", "")
    if "driven_travel_deg" in law:
        yield "open", law["type"]


def motions(made: Document) -> Iterator[tuple[str, ...]]:
    motion, follower = made.get("motion", []), made.get("follower", {})
    if isinstance(motion, dict):
        yield from (("turn", key.rpartition("_")[0] or key) for key in motion)
        motion = []
    for phase in motion:
        yield (phase["type"],)
        yield phase["type"], phase.get("law", "")
        if phase.get("angle_deg") == "rest":
            yield ("rest",)
    yield follower.get("type", ""), follower.get("motion", "")


def test_every_ratio_law_is_drawn() -> None:
    opened = {"phases", "multispeed", "log-spiral", "formula", "table", "motion"}
    wanted = choices("gear-pair", "law", "type") | {("open", law) for law in opened}
    assert never_drawn("gear-pair", wanted, laws) == set()


def test_every_rise_and_return_and_follower_is_drawn() -> None:
    names = ("law", "type")
    moves, phases = (choices("cam", "motion", name) for name in names)
    followers = choices("cam", "follower", "type")
    wanted = {
        *((phase, law) for phase in ("rise", "return") for law in moves),
        *((phase,) for phase in (*phases, "rest")),
        *(("turn", key) for key in ("file", "theta", "lift", "smoothing_tolerance")),
        *((kind, motion) for kind in followers for motion in ("", "oscillating")),
    }
    assert never_drawn("cam", wanted, motions) == set()


def test_a_name_that_is_never_drawn_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{__name__}.MOST", 40)
    assert never_drawn("gear-pair", {"ellipse", "hyperbola"}, laws) == {"hyperbola"}


def test_each_motion_law_meets_each_follower() -> None:
    """However many laws there are: both take turns, but not in step."""
    for count in (23, 24):
        pairs = {in_turn(index, count) for index in range(count * len(FOLLOWERS))}
        assert len(pairs) == count * len(FOLLOWERS)


@pytest.mark.parametrize("kind", chosen(list(MAKERS), "cam", "globoidal-cam"))
def test_every_key_and_file_that_the_program_documents_is_drawn(kind: str) -> None:
    first = next(filter(None, (document(kind, index) for index in range(MOST))))
    wanted = {
        (title, key)
        for title, node in known_keys(schema(), {"kind": kind}).items()
        if title not in ("kind", "name", "law", "motion", "limits", "sweep")
        for key in known_keys(node, {})
    }
    wanted |= {("limits", key) for key in known_keys(known_keys(schema(), first)["limits"], {})}
    wanted |= {("files", file) for file in choices(kind, "output", "files")}

    def keys(made: Document) -> Iterator[tuple[str, str]]:
        for title, table in made.items():
            for row in table if isinstance(table, list) else [table]:
                yield from ((title, key) for key in row if isinstance(row, dict))
        yield from (("files", file) for file in made.get("output", {}).get("files", ()))

    assert never_drawn(kind, wanted, keys) == set()


# --- files --------------------------------------------------------------------------------------


def outline(moved: float = 0.0) -> bytes:
    points = 100.0 * np.stack([np.cos(np.arange(50)), np.sin(np.arange(50))], axis=1)
    points[7, 0] += moved
    return "\n".join(["x_mm,y_mm", *(f"{x!r},{y!r}" for x, y in points.tolist())]).encode()


def places(name: str, before: bytes, after: bytes, tolerance: float = 1e-3) -> list[str]:
    return [one.place for one in files(name, before, after, tolerance)]


def test_a_moved_vertex_is_seen_and_rounding_is_not() -> None:
    assert places("a.csv", outline(), outline(1e-9)) == ["a.csv:x_mm"]
    assert places("a.csv", outline(), outline(2e-10)) == ["a.csv:x_mm"]
    assert places("a.csv", outline(), outline(5e-11)) == []
    assert places("a.csv", outline(), outline() + b"\n1,2") == ["a.csv"]
    assert places("a.csv", outline(), outline().replace(b"y_mm", b"z_mm")) == ["a.csv"]
    word = b"tooth,x_mm\nleft,1.0\n"
    assert places("a.csv", word, word.replace(b"left", b"right")) == ["a.csv:tooth"]


def test_round_numbers_may_differ_in_their_last_place() -> None:
    drawn = b'<path d="M0.5 -34.9964L12 3.25">'
    assert places("a.svg", drawn, drawn.replace(b"34.9964", b"34.9965")) == []
    assert places("a.svg", drawn, drawn.replace(b"34.9964", b"34.9967")) == ["a.svg"]
    assert places("a.svg", drawn, drawn.replace(b"0.5", b"0.6")) == ["a.svg"]
    assert places("a.svg", drawn, drawn.replace(b"12", b"13")) == ["a.svg"]
    assert places("a.svg", drawn, drawn.replace(b"path", b"part")) == ["a.svg"]


def test_lines_of_a_step_file_may_break_elsewhere() -> None:
    assert places("a.step", b"POINT(1.5,\n  2.5)", b"POINT(1.5,2.5)") == []
    assert places("a.step", b"POINT(1.5,\n  2.5)", b"POINT(1.5,3.5)") == ["a.step"]


def circle_dxf(cuts: list[float], radius: float = 20.0) -> bytes:
    """A circle of arcs that meet at these angles."""
    drawing = ezdxf.new()  # pyright: ignore[reportPrivateImportUsage]
    steps = np.diff([*cuts, cuts[0] + 2 * math.pi])
    points = [
        (radius * math.cos(a), radius * math.sin(a), math.tan(step / 4))
        for a, step in zip(cuts, steps, strict=True)
    ]
    drawing.modelspace().add_lwpolyline(points, format="xyb", close=True)
    text = io.StringIO()
    drawing.write(text)
    return text.getvalue().encode()


def test_arcs_may_lie_elsewhere_within_their_tolerance() -> None:
    arcs = circle_dxf([0.0, 2.0, 4.0])
    assert places("a.dxf", arcs, circle_dxf([0.0, 1.0, 3.0, 5.0])) == []
    assert places("a.dxf", arcs, circle_dxf([0.0, 1.0, 4.0], 20.0019)) == []
    assert places("a.dxf", arcs, circle_dxf([0.0, 1.0, 4.0], 20.0021)) == ["a.dxf"]
    path = b'<path class="profile" d="M20 0A20 20 0 %d 1 %s %sA20 20 0 %d 1 20 0Z"/>'
    half = path % (0, b"-20", b"0", 0)
    quarter = path % (0, b"0", b"20", 1)
    assert places("cut.svg", half, quarter) == []
    assert places("cut.svg", half, quarter.replace(b"20 0Z", b"20.01 0Z")) == ["cut.svg"]


def test_solids_are_compared_in_single_precision() -> None:
    corners = np.arange(24, dtype="<f4").reshape(2, 12) + 1
    facets = np.zeros(2, dtype=[("corners", "<f4", 12), ("end", "<u2")])
    facets["corners"] = corners
    solid = bytes(84) + facets.tobytes()
    facets["corners"][1, 5] *= 1 + 1e-7
    assert places("a.stl", solid, bytes(84) + facets.tobytes()) == []
    facets["corners"][1, 5] += 1e-3
    assert places("a.stl", solid, bytes(84) + facets.tobytes()) == ["a.stl"]
    head = b"glTF" + bytes(8) + (4).to_bytes(4, "little") + b"JSON{}  " + bytes(8)
    indices = np.array([0, 1, 2, 1], dtype="<u4")
    mesh = [head + corners.tobytes() + order.tobytes() for order in (indices, indices[::-1])]
    assert places("a.glb", mesh[0], mesh[1]) == ["a.glb"]


def test_folders_are_compared_file_by_file(tmp_path: Path) -> None:
    for name in "ab":
        (tmp_path / name).mkdir()
        (tmp_path / name / "gear1.csv").write_bytes(outline())
    assert [*folders(tmp_path / "a", tmp_path / "b", 1e-3)] == []
    (tmp_path / "a" / "gear2.csv").write_bytes(outline())
    assert [one.words for one in folders(tmp_path / "a", tmp_path / "b", 1e-3)] == ["only in base"]


# --- what is told -------------------------------------------------------------------------------


def test_summaries_are_compared_key_by_key() -> None:
    one: dict[str, Any] = {
        "timings_s": {"law": 0.1},
        "pair": {"module_mm": 2.0, "teeth": [24, 24], "ratio": {"min": 2e-24, "max": 8.0}},
        "mass": {"unbalance_g_mm": 1e-12, "unbalance_direction_deg": 90.0, "volume_mm3": 9e4},
    }
    two = json.loads(json.dumps(one))
    two["timings_s"]["law"] = 0.2
    two["pair"]["ratio"]["min"] = -3e-24
    two["mass"]["unbalance_direction_deg"] = -20.0
    assert [*summaries("s", one, two)] == []
    two["pair"] |= {"module_mm": 2.0 + 1e-9, "teeth": [24, 25], "added": "x"}
    found = {one.place for one in summaries("s", one, two)}
    assert found == {"s:pair.module_mm", "s:pair.teeth[1]", "s:pair.added"}


def test_findings_are_compared_by_code_value_and_place() -> None:
    tip = {"code": "thin-tip", "severity": "warning", "value": 0.1, "limit": 0.2, "unit": "mm"}
    one = [{**tip, "where": f"wheel {k}, phi1 = 160.5 deg", "message": "thin"} for k in (1, 2)]

    def apart(changed: dict[str, Any], *, messages: bool = False) -> list[str]:
        two = [{**one[1]}, {**one[0], **changed}]
        return [one.place for one in told("finding", one, two, messages=messages)]

    assert apart({}) == []
    assert apart({"value": 0.1 + 1e-9}) == ["finding:thin-tip.value"]
    assert apart({"value": 0.1 + 1e-14, "where": "wheel 1, phi1 = 160.501 deg"}) == []
    assert apart({"where": "wheel 1, phi1 = 161 deg"}) == ["finding:thin-tip.where"]
    assert apart({"severity": "error"}) == ["finding:thin-tip.severity"]
    assert apart({"message": "too thin"}) == []
    assert apart({"message": "too thin"}, messages=True) == ["finding:thin-tip.message"]
    assert [one.place for one in told("finding", one, one[:1], messages=False)] == [
        "finding:thin-tip"
    ]


# --- both sides at work -------------------------------------------------------------------------

PROGRAM = """
import os
from pathlib import Path


class Found:
    code, severity, value, where, message = "thin-tip", "warning", VALUE, "wheel 1", "thin"


class Result:
    def __init__(self, path):
        self.path = path

    def write(self, out):
        Path(out).mkdir()
        (Path(out) / "outline.csv").write_text(Path(self.path).read_text())
        self.findings = [Found()]
        ENDS
        return self


load = str
build = Result
"""


def a_tree(folder: Path, value: str = "1.5", ends: str = "") -> Path:
    """A program of a few lines with the public interface of gearcam."""
    (folder / "src" / "gearcam").mkdir(parents=True)
    text = PROGRAM.replace("VALUE", value).replace("ENDS", ends or "pass")
    (folder / "src" / "gearcam" / "__init__.py").write_text(text)
    (folder / "profiles").mkdir()
    (folder / "profiles" / "one.toml").write_text("x = 1\n")
    (folder / "profiles" / "two.toml").write_text("x = 2\n")
    return folder


def run(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *words: str | Path
) -> tuple[int, str]:
    monkeypatch.setattr("sys.argv", ["compare.py", *map(str, words), "--count", "0"])
    code = compare.main()
    return code, capsys.readouterr().out


@pytest.mark.parametrize(
    ("value", "ends", "words"),
    [
        ("1.5", "", ""),
        ("1.5 + 1e-9", "", "finding:thin-tip.value: 2 designs"),
        ("1.5", "self.findings = []", "finding:thin-tip: 2 designs"),
        ("1.5", "(Path(out) / 'outline.csv').unlink()", "only in base"),
        ("1.5", "raise ValueError('no way')", "built | ValueError no way"),
        ("1.5", "if 'one' in out: os._exit(3)", "end:built | crash #: 1 design\n"),
        pytest.param(
            *("1.5", "while 'two' in out: pass", "end:built | out of time: 1 design\n"),
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_planted_difference_is_told(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    value: str,
    ends: str,
    words: str,
) -> None:
    base = a_tree(tmp_path / "base")
    tree = a_tree(tmp_path / "tree", value, ends)
    limit = "1" if "out of time" in words else "20"
    code, text = run(monkeypatch, capsys, base, "--tree", tree, "--limit", limit)
    assert code == bool(words)
    assert words in text
    if words:
        return
    assert "gallery                   2              2              0" in text


def test_what_is_allowed_is_no_difference(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    base, tree = a_tree(tmp_path / "base"), a_tree(tmp_path / "tree", "1.6")
    words = (base, "--tree", tree, "--allow")
    assert run(monkeypatch, capsys, *words, "finding:thin-*")[0] == 0
    assert run(monkeypatch, capsys, *words, "finding:thick-*")[0] == 1


def test_another_program_than_the_tree_s_is_refused(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    with pytest.raises(SystemExit):
        Side(tmp_path, tmp_path / "work", 1.0)


def test_the_base_has_its_own_keys() -> None:
    text = 'kind = "gear-pair"\n\n[steps]\ncount = 3\noffset_mm = 1.5\n\n[pair]\nteeth = [3, 4]\n'
    renames = {"steps.count": "helix.steps", "steps.offset_mm": "helix.offset_mm"}
    made = tomllib.loads(compare.renamed(text, renames))
    assert made == {
        "kind": "gear-pair",
        "helix": {"steps": 3, "offset_mm": 1.5},
        "pair": {"teeth": [3, 4]},
    }
    assert compare.renamed(compare.renamed(text, {}), {}) == compare.renamed(text, {})
    words = compare.renamed('[follower]\ntype = "knife-edge"\n', {"knife-edge": "point"})
    assert tomllib.loads(words) == {"follower": {"type": "point"}}


def test_the_base_has_its_own_names(tmp_path: Path) -> None:
    for name, head in (("a", "way_mm,by_way_mm"), ("b", "travel_mm,by_way_mm")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "rack.csv").write_text(f"{head}\n1,2\n")
    sides = tmp_path / "a", tmp_path / "b"
    assert [one.place for one in folders(*sides, 1e-3)] == ["rack.csv"]
    assert [*folders(*sides, 1e-3, {"travel_mm": "way_mm"})] == []
    assert called('"off-flank": "way-off-flank"', {"new": "off-flank"}) == '"new": "way-off-flank"'
