"""Pages on paper, as PDF and as pictures: nothing overlaps, is cut, left alone or too pale."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import zip_longest
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest
from selenium.webdriver import Chrome

import gearcam as gc
import helpers_built
from gearcam.compare.page import document as compared
from gearcam.compare.variants import variants_of
from gearcam.pictures.charts import Chart, Line
from gearcam.report.file import solids_shown
from gearcam.report.page import charts_page, document, page
from gearcam.sweeps.page import page as swept
from gearcam.sweeps.rows import measured
from helpers_browser import LAPTOP, open_page
from helpers_pairs import PROFILES
from helpers_print import Sheet, filled, found, outside, overlaps, printed

NAIL: Final = "nail_machine_two_phase"
KINDS: Final = (
    NAIL,
    "loaded_nail_machine",  # with studies
    "askew_pair",  # with patterns of contact
    "groove_cam",
    "undercut_cam",  # with errors and remedies
    "elastic_valve_train",
    "cylinder_cam",
    "globoidal_indexer",
    "nail_machine_slide",
    "four_bar",
)
MANY: Final = [round(0.02 * (k + 1), 2) for k in range(12)]
PALE: Final = 1.05 / 3.0 - 0.05
"""Luminance of what has a contrast of 3 to paper, the least that shows a shape (WCAG 2.2)."""

COLUMN, HIGH, STEP = 0.75 * 312, 0.75 * 200, 0.75 * 320
"""Width and height of a printed chart, and from one column to the next, points."""

TOLD: Final = """
const shown = JSON.parse(document.getElementById("document").textContent);
const text = (one) => one.textContent.replace(/\\s+/g, " ").trim();
const all = (places) => [...document.querySelectorAll(places)];
const own = (one) => one.querySelector("output") ? one.childNodes[1].textContent.trim() : text(one);
return {
  sections: all("h2").map(text),
  heads: all("thead tr").map((row) => [...row.children].map(text).join(" ")),
  charts: all(".chart").map((one) => {
    const title = text(one.querySelector("h3"));
    const { x, y } = shown.charts.find((chart) => chart.title === title);
    return [`${title} ${y}`, x, own(one.querySelector(".legend li"))];
  }),
};
"""
"""What the page says that it has: headings, and title, axis and first line of its charts."""


@dataclass(frozen=True)
class OnPaper:
    """Sheets, and what the page told of itself."""

    margin: float
    told: dict[str, Any]
    sheets: list[Sheet]


Write = Callable[[str], Path]


@pytest.fixture(scope="module")
def write(tmp_path_factory: pytest.TempPathFactory) -> Write:
    """What writes a page by its name, once."""
    folder = tmp_path_factory.mktemp("printed")

    @cache
    def written(name: str) -> Path:
        path = folder / f"{name}.html"
        path.write_bytes(_content(name))
        return path

    return written


def _content(name: str) -> bytes:
    if name in ("two_variants", "twelve_variants"):
        values = [0.3, 0.5] if name == "two_variants" else MANY
        keys = {"law.eccentricity": values, "output.chord_tolerance_mm": [0.02]}
        return page(compared(variants_of([str(PROFILES / "ellipse.toml")], keys), name))
    if name == "sweep":
        base = gc.load(PROFILES / "ellipse.toml")
        places = np.linspace(0.05, 0.5, 10).round(3)
        rows = [measured(base, k, {"law.eccentricity": float(e)}) for k, e in enumerate(places)]
        goals = {"pair.ratio.max": -1.0, "mesh.contact_ratio.forward.least": -1.0}
        return swept(base, rows, ["law.eccentricity = 0.05:0.5:0.05"], goals)
    if name == "charts":
        x = np.linspace(0.0, 6.0, 50)
        lines = (Line(label="sine", x=x, y=np.sin(x)), Line(label="cosine", x=x, y=np.cos(x)))
        charts = [Chart(title=f"Chart {k}", x="s", y="mm", lines=lines) for k in range(7)]
        return charts_page("charts", charts, "\n".join(f"{k} " + 30 * "0.123 " for k in range(90)))
    result = helpers_built.built(PROFILES / f"{name}.toml")
    return page(document(result), solids=solids_shown(result))


def on_paper(browser: Chrome, path: Path, paper: str, margin: float, **media: str) -> OnPaper:
    open_page(browser, path, LAPTOP, **media)
    told = browser.execute_script(TOLD)
    return OnPaper(margin, told, printed(browser, paper, margin))


def close(text: str) -> str:
    """A text without spaces, whose places differ where lines end."""
    return "".join(text.split())


def check(done: OnPaper) -> None:
    """All that paper asks for; what is wrong is named with the number of its sheet."""
    for number, sheet in enumerate(done.sheets, 1):
        assert overlaps(sheet) == [], number
        assert outside(sheet, done.margin) == [], number
        lonely(done, sheet, number)
        if number < len(done.sheets):
            assert filled(sheet, done.margin) > 0.4, number
    assert done.sheets[-1].words, "the last sheet is empty"
    whole(done)


def lonely(done: OnPaper, sheet: Sheet, number: int) -> None:
    """No heading stands at the foot of a sheet, or directly before another one."""
    sections = {close(one) for one in done.told["sections"]}
    heads = sections | {close(one) for one in done.told["heads"]}
    rows = sheet.rows
    for row, following in zip_longest(rows, rows[1:]):
        if close(row.text) not in heads:
            continue
        ends = following.top if following else 0.0
        width = sheet.size[0]
        shown = (sheet.ink((0.0, ends + 1.0, width, row.bottom - 1.0)) < PALE).any()
        assert following or shown, (number, f"{row.text} is alone")
        more = following and close(following.text) not in sections
        assert more or shown, (number, f"{row.text} is empty")


def whole(done: OnPaper) -> None:
    """Each chart is whole, on one sheet with its title and its legend, and can be seen."""
    number, place, edges = 0, 0, set[int]()
    for title, across, label in done.told["charts"]:
        while (at := found(done.sheets[number], title, place)) is None:
            number, place = number + 1, 0
            assert number < len(done.sheets), f"{title} is not on paper"
        sheet, (above, place) = done.sheets[number], at
        below = found(sheet, label, place)
        assert below, f"{title}: its legend is on another sheet"
        box = (above[0], below[0][3], above[0] + COLUMN, above[1])
        assert box[3] - box[1] > HIGH, f"{title} has no room"
        assert found(sheet, across), f"{title} is cut"
        assert np.mean(sheet.ink(box) < PALE) > 0.003, f"{title} is too pale"
        edges.add(round(above[0]))
    if len(edges) > 1:
        assert max(edges) - min(edges) == pytest.approx(STEP, abs=3.0), "the page is shrunk"


@pytest.mark.parametrize(
    ("name", "paper", "margin"), [("groove_cam", "A4", 10.0), (NAIL, "Letter", 20.0)]
)
def test_a_report_on_paper(
    name: str, paper: str, margin: float, browser: Chrome, write: Write
) -> None:
    done = on_paper(browser, write(name), paper, margin)
    check(done)
    assert len(done.sheets) <= 5


def test_what_is_dark_on_the_screen_is_printed_as_what_is_light(
    browser: Chrome, write: Write
) -> None:
    light, dark = (
        on_paper(browser, write("groove_cam"), "A4", 10.0, prefers_color_scheme=one).sheets
        for one in ("light", "dark")
    )
    assert len(light) == len(dark)
    for one, other in zip(light, dark, strict=True):
        assert np.mean(np.abs(one.colours - other.colours)) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("paper", ["A4", "Letter"])
@pytest.mark.parametrize("margin", [0.0, 10.0, 20.0])
@pytest.mark.parametrize("name", [*KINDS, "two_variants", "twelve_variants", "sweep", "charts"])
def test_all_kinds_on_all_papers(
    name: str, paper: str, margin: float, browser: Chrome, write: Write
) -> None:
    check(on_paper(browser, write(name), paper, margin))
