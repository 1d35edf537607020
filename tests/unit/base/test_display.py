"""How objects show themselves: in one line each, and in notebooks as pictures with facts."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import gearcam
from gearcam import kinds
from gearcam.base.display import ShortRepr, line, word
from gearcam.console import all_lines
from gearcam.designs import loads
from gearcam.laws.ratio.ellipse import Ellipse
from helpers_built import built
from helpers_pairs import PROFILES, job, profile

DEEP, EACH = 6, 3
"""How deep attributes are followed, and how many objects of a type are."""


def build(name: str) -> Any:
    return built(PROFILES / f"{name}.toml")


def reached(start: object) -> Iterator[tuple[str, object]]:
    """All objects of the package that public attributes lead to, each with its way."""
    seen: dict[int, object] = {}
    count: dict[type, int] = {}
    todo: list[tuple[str, object, int]] = [("result", start, 0)]
    while todo:
        way, one, depth = todo.pop(0)
        if isinstance(one, tuple | list):
            todo += [(f"{way}[{k}]", item, depth) for k, item in enumerate(one[:EACH])]
        elif type(one).__module__.startswith("gearcam") and id(one) not in seen:
            seen[id(one)] = one
            count[type(one)] = count.get(type(one), 0) + 1
            if count[type(one)] <= EACH:
                yield way, one
                listed = {*object.__dir__(one), *dir(one)}  # also what is not for users
                names = sorted(name for name in listed if not name.startswith("_"))
                names = names if depth < DEEP else []
                todo += [(f"{way}.{name}", _got(one, name), depth + 1) for name in names]


def _got(one: object, name: str) -> object:
    try:
        return getattr(one, name)
    except Exception:  # what this one has not
        return None


@pytest.mark.parametrize(
    "name",
    [
        *("valve_lever", "groove_cam"),
        *(
            pytest.param(name, marks=pytest.mark.slow)
            for name in ("feeder", "undercut_cam", "shop_order", "stepped_ellipse")
        ),
    ],
)
def test_everything_that_is_reached_shows_itself_in_one_line(name: str) -> None:
    coarse = {"output.chord_tolerance_mm": 0.01}
    result = gearcam.build(gearcam.load(PROFILES / f"{name}.toml").with_(coarse))
    extra = result.mesh(steps=2, to_deg=5) if hasattr(result, "mesh") else None
    types = set()
    for start in (result, extra):
        for way, one in reached(start):
            text = repr(one)
            assert len(text) < 100, f"{way}: {text[:200]}"
            assert "\n" not in text, way
            assert " at 0x" not in text, f"{way}: {text}"
            assert "array([" not in text, f"{way}: {text}"
            types.add(type(one).__name__)
    assert {"Part", "Contour", "Facts"} <= types
    assert len(types) > 15


def test_an_object_is_its_type_and_its_fields_but_for_defaults() -> None:
    @dataclass(frozen=True)
    class Made(ShortRepr):
        name: str
        size: float
        points: Any
        inner: Any
        usual: int = 3
        other: int = 4

    @dataclass(frozen=True)
    class More(Made):
        last: Any = None

    made = Made("a", 1.0 / 3.0, np.zeros((5, 2)), ShortRepr, other=5)
    assert repr(made) == "Made(name='a', size=0.333333, points=array(5, 2), other=5)"
    assert repr(More("a", 2.0, np.zeros(2), made, last=(1, 2.5))) == (
        "More(name='a', size=2, points=array(2,), last=(1, 2.5), inner=Made)"
    )
    long = Made("n" * 200, 2.0, list(range(20)), {"a": 1})
    assert repr(long).startswith("Made(name='nnn")
    assert "points=20 items, inner={a: 1}" in repr(long)
    assert word((np.zeros(2), made)) == "(array(2,), Made)"
    assert word((print, 1)) == "2 items"
    assert word(["w" * 29] * 3) == "3 items"
    assert word(("w",)) == "('w',)"
    assert line("Made", ["w" * 40] * 5) == f"Made({'w' * 40}, {'w' * 40}, ...)"
    assert word(print) == word(None) == ""
    assert word(True) == "True"


@pytest.mark.parametrize("path", sorted(PROFILES.glob("*.toml")), ids=lambda path: path.stem)
def test_what_a_design_asks_for_shows_itself_in_one_line(path: Path) -> None:
    for way, one in reached(gearcam.load(path)):
        assert len(repr(one)) < 100, f"{way}: {one!r}"
        assert " at 0x" not in repr(one), f"{way}: {one!r}"


def test_long_names_and_many_stages_are_cut(tmp_path: Path) -> None:
    result = gearcam.build(build("ellipse").design.with_({"name": "n" * 99}))
    study = result.mesh(steps=2, to_deg=5)
    result.write(tmp_path, files=["csv", "svg"])
    for one in (result, result.design, study, profile("ellipse")):
        assert len(repr(one)) < 100
        assert repr(one).endswith(">")


def test_facts_print_as_the_console_tells_them() -> None:
    result = profile("ellipse")
    lines = str(result.facts).splitlines()
    assert lines[0] == ", ".join(result.facts.headline)
    assert re.fullmatch(
        r"  least contact ratio +1\.7\S+, mean 1\.7\S+ +\(at least 1\.1\).*", lines[3]
    )
    assert repr(result.facts).startswith(f"Facts({lines[0]}")


def test_the_console_tells_the_same(tmp_path: Path) -> None:
    written = job(Ellipse(eccentricity=0.2), (20, 20), module=2.0, tolerance=0.01).check(tmp_path)
    told = list(all_lines(written))
    assert told[: len(str(written.facts).splitlines())] == str(written.facts).splitlines()


class Page(HTMLParser):
    """The texts of a page, and its images; every tag has to be closed in its place."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.texts: list[str] = []
        self.images: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        assert all(name == "style" for name, _ in attrs)
        self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: Any) -> None:
        assert tag == "img"
        data = dict(attrs)["src"].removeprefix("data:image/svg+xml;base64,")
        self.images.append(base64.b64decode(data).decode())

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def parsed(svg: str) -> ET.Element:
    root = ET.fromstring(svg.encode())
    assert root.tag.endswith("}svg")
    return root


def shown() -> dict[str, Any]:
    pair, cam = build("shop_order"), build("plate_cam_offset_roller")
    rack = build("feeder").gear2
    return {
        "gear1": pair.gear1, "part": pair.parts[0], "cam": cam.cam, "cam part": cam.part,
        "rack": rack,
    }  # fmt: skip


class Frame(HTMLParser):
    """A frame, and the document of the page in it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.attributes: dict[str, str] = {}
        self.feed(text)
        page = self.attributes["srcdoc"]
        _, _, data = page.partition('<script type="application/json" id="document">')
        self.page, self.document = page, json.loads(data.partition("</script>")[0])

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        assert (tag, self.attributes) == ("iframe", {})
        self.attributes = dict(attrs)

    def handle_data(self, data: str) -> None:
        raise AssertionError(data)


def test_notebooks_show_a_result_as_its_page_without_solids() -> None:
    for name in ("ellipse", "plate_cam_offset_roller"):
        result = build(name)
        frame = Frame(result._repr_html_())
        assert frame.attributes["title"] == name
        assert frame.document["title"] == name
        assert frame.document["scene"]["title"] == name
        assert len(frame.document["charts"]) == len(result.charts)
        assert "solids-view" not in frame.page.partition('id="document"')[0]
        assert '<script type="application/json" id="solids-view">' not in frame.page
        assert len(result._repr_html_()) < 1_000_000
        assert Frame(result.design._repr_html_()).document["title"] == name
        assert len(list(parsed(result._repr_svg_()).iter())) > 4


def test_notebooks_show_a_picture_with_facts() -> None:
    for name, one in shown().items():
        svg = one._repr_svg_()
        root = parsed(svg)
        assert len(list(root.iter())) > 4, name
        page = Page(one._repr_html_())
        assert page.images == [svg], name
        assert len(page.texts) > 8, name
        assert not any("<" in text for text in page.texts)


def test_a_notebook_does_not_wait_for_remedies(monkeypatch: pytest.MonkeyPatch) -> None:
    def sought(*_: object) -> None:
        raise AssertionError("remedies were sought")

    monkeypatch.setattr("gearcam.report.page.remedies", sought)
    design = build("ellipse").design.with_({"pair.teeth": [9, 9]})
    findings = gearcam.build(design).findings
    assert "error" in {one.severity for one in findings}
    told = Frame(design._repr_html_()).document["blocks"]
    assert "Do not cut this yet" in told["verdict"]


def coordinates(path: str) -> np.ndarray:
    numbers = [float(text) for text in re.findall(r"-?[\d.]+", path)]
    return np.array(numbers).reshape(-1, 2)


def test_the_picture_of_a_wheel_is_its_outline_and_its_centrode() -> None:
    gear = profile("log_spiral").gear2
    paths = [one.get("d") or "" for one in parsed(gear._repr_svg_() or "").iter() if one.get("d")]
    outline, centrode, cross = map(coordinates, (path.replace("M", " ") for path in paths))
    np.testing.assert_allclose(outline * [1, -1], gear.outline, atol=1e-4)
    end = gear.pair.law.period
    np.testing.assert_allclose(
        centrode[[0, -1]] * [1, -1], gear.centrode(np.array([0.0, end])), atol=1e-4
    )
    assert np.abs(cross.mean(axis=0)).max() < 1e-9


def test_the_picture_of_a_part_shows_its_openings() -> None:
    part = build("shop_order").parts[0]
    path = next(one.get("d") or "" for one in parsed(part.picture()).iter() if one.get("d"))
    assert path.count("M") == path.count("Z") == 1 + len(part.openings) + len(part.marks)


REFUSED = (
    'law = { type = "ellipse", eccentricity = 0.9 }\npair = { teeth = [8, 8], module_mm = 1 }\n'
)


def test_a_refused_design_shows_its_refusal() -> None:
    design = loads(f'kind = "gear-pair"\nname = "a-b"\n{REFUSED}')
    page = Page(design._repr_html_())
    assert page.texts[0] == "a-b cannot be made"
    assert "reach past its own shaft" in page.texts[1]
    assert "limit 0.428" in page.texts[1]
    root = parsed(design._repr_svg_() or "")
    words = [one.text or "" for one in root.iter() if one.tag.endswith("}text")]
    assert words[0] == "a-b cannot be made"
    assert "reach past its own shaft" in words[1]
    assert gearcam.build(design)._repr_html_() == design._repr_html_()


def test_the_page_of_a_notebook_tells_the_findings() -> None:
    result = build("undercut_cam")
    told = Frame(result._repr_html_()).document["blocks"]["findings"]
    for finding in result.findings:
        assert escape(finding.message, quote=False).replace("'", "&#39;") in told
        assert finding.code in told


def test_all_facts_are_folded_below_by_name() -> None:
    facts = profile("ellipse").facts
    texts = Page(facts._repr_html_()).texts
    assert f"all {len(facts)} facts, by name" in texts
    assert {"pair.module_mm", "gears.1.outline.vertices"} <= {*texts}
    least = texts.index("least contact ratio")
    assert texts[least + 1].startswith("1.7")
    assert texts[least + 2] == "at least 1.1"


def test_what_has_no_picture_shows_facts(monkeypatch: pytest.MonkeyPatch) -> None:
    from arch.test_kinds import GOOD, TOY

    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(TOY)])
    result = gearcam.build(loads(GOOD))
    assert result._repr_svg_() is None
    page = Page(result._repr_html_())
    assert page.images == []
    assert "24" in " ".join(page.texts)
    assert result.assembled() == {}
