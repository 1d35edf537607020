"""Mechanisms in a page: links on their joints, paths, and lengths that are dragged."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By

import gearcam as gc
from gearcam.report.page import document, page
from helpers_browser import complaints, go, open_page, until
from helpers_pairs import PROFILES
from helpers_view import served

BAR = "four_bar"
PLACE = 77.0
"""Of the crank, deg."""

BuildOutput = Callable[[str], Path]
Built = Callable[[str], Any]

SPY = """
    window.scenes = [];
    const show = window.gearcam.show;
    window.gearcam.show = (next) => { window.scenes.push(next.scene); show(next); };
"""


WRITTEN = """
    const kind = CanvasRenderingContext2D.prototype;
    const [clear, write] = [kind.fillRect, kind.fillText];
    window.names = [];
    kind.fillRect = function (...at) { window.names.length = 0; clear.apply(this, at); };
    kind.fillText = function (text, x, y) {
      const { a, e, f } = this.getTransform();
      const wide = this.measureText(text).width;
      window.names.push({ text, x: e / a + x, y: f / a + y, wide, edge: this.canvas.width / a });
      write.call(this, text, x, y);
    };
"""
"""Keeps where names were last written, in pixels."""


def poses(browser: Chrome) -> dict[str, Any]:
    return {one["name"]: one for one in browser.execute_script("return gearcam.poses()")}


def test_links_stand_on_their_joints(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(BAR))
    go(browser, PLACE)
    found = poses(browser)
    crank, coupler, rocker = (found[name] for name in ("crank", "coupler", "rocker"))
    pin = 40.0 * cmath.exp(1j * crank["turn"])
    assert crank["turn"] == pytest.approx(math.radians(PLACE), abs=1e-6)
    assert abs(complex(coupler["x"], coupler["y"]) - pin) < 1e-3
    # both ends of the loop meet: 120 mm from the crank's pin and 90 mm from the pivot
    ends = (
        pin + 120.0 * cmath.exp(1j * coupler["turn"]),
        110.0 + 90.0 * cmath.exp(1j * rocker["turn"]),
    )
    assert abs(ends[0] - ends[1]) < 2e-3
    assert complaints(browser) == []


def test_paths_are_drawn_until_they_are_unchecked(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(BAR))
    (box,) = (
        one.find_element(By.TAG_NAME, "input")
        for one in browser.find_elements(By.CSS_SELECTOR, "#seen label")
        if one.text.strip() == "paths of points"
    )
    assert box.is_selected()
    dashed = "return (gearcam.svg().match(/stroke-dasharray/g) || []).length"
    assert browser.execute_script(dashed) == 1
    box.click()
    assert browser.execute_script(dashed) == 0


def test_forces_are_drawn_at_their_joints_to_one_scale(browser: Chrome, tmp_path: Path) -> None:
    loads = [{"on": "C", "force_n": [40, -90]}]
    output = {"output.studies": ["forces"], "output.files": ["report"]}
    made = gc.build(gc.load(PROFILES / f"{BAR}.toml").with_({"load": loads, **output}))
    path = tmp_path / "forces.html"
    path.write_bytes(page(document(made)))
    open_page(browser, path)
    go(browser, PLACE)
    line = r'<path fill="none" stroke="\S+" stroke-width="(\S+)" d="M(\S+) (\S+) (\S+) (\S+?)"'

    def arrows() -> dict[complex, complex]:
        """The arrows by where they begin, in pixels."""
        rows = re.findall(line, browser.execute_script("return gearcam.svg()"))
        every = [[float(one) for one in row] for row in rows]
        return {complex(x, y): 1.5 * complex(ex - x, ey - y) / w for w, x, y, ex, ey in every}

    table = made.study("forces").columns
    sizes = [table[name.replace("_x_n", "_n")].max() for name in table if name.endswith("_x_n")]
    row = int(np.abs(next(iter(table.values())) - PLACE).argmin())
    pin = 40.0 * cmath.exp(1j * math.radians(PLACE))
    (arrow,) = (way for at, way in arrows().items() if abs(at - pin) < 1e-3)
    force = complex(table["B_x_n"][row], table["B_y_n"][row])
    assert arrow == pytest.approx(120.0 * force / max(sizes), abs=0.1)
    assert len(arrows()) == len(sizes) == 4
    (box,) = (
        one.find_element(By.TAG_NAME, "input")
        for one in browser.find_elements(By.CSS_SELECTOR, "#seen label")
        if "forces in joints, up to" in one.text
    )
    box.click()
    assert not arrows()
    assert complaints(browser) == []


def test_names_move_with_the_machine_until_they_are_unchecked(
    browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(BAR))
    texts = (
        'return [...gearcam.svg().matchAll(/<text x="(\\S+)" y="(\\S+)".*?>(.*?)<.text>/g)]'
        ".map((one) => [one[3], Number(one[1]), -Number(one[2])])"
    )
    found = []
    for place in (0.0, PLACE):
        go(browser, place)
        found.append({text: complex(x, y) for text, x, y in browser.execute_script(texts)})
        assert {*", ".join(found[-1]).split(", ")} == {
            "B", "C", "D", "P", "crank", "coupler", "rocker"
        }  # fmt: skip
    # beside the crank's pin, at the same distance
    pins = [40.0 * cmath.exp(1j * math.radians(place)) for place in (0.0, PLACE)]
    assert abs(found[0]["B"] - pins[0] - (found[1]["B"] - pins[1])) < 1e-3
    assert abs(found[0]["B"] - pins[0]) < 5.0
    (box,) = (
        one.find_element(By.TAG_NAME, "input")
        for one in browser.find_elements(By.CSS_SELECTOR, "#seen label")
        if one.text.strip() == "names"
    )
    assert box.is_selected()
    box.click()
    assert browser.execute_script(texts) == []
    assert complaints(browser) == []


def test_names_do_not_cover_each_other_at_the_edge(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of("quick_return"))
    browser.execute_script(WRITTEN)
    for place in (0.0, 20.0, 330.0):
        go(browser, place)
        names = browser.execute_script("return window.names")
        assert {"link", "E", "pivot"} <= {one["text"] for one in names}
        assert all(one["x"] >= 0.0 and one["x"] + one["wide"] <= one["edge"] for one in names)
        for k, one in enumerate(names):
            for other in names[:k]:
                beside = one["x"] >= other["x"] + 0.9 * other["wide"]
                beside |= other["x"] >= one["x"] + 0.9 * one["wide"]
                assert beside or abs(one["y"] - other["y"]) > 9.0, (place, one, other)


@pytest.mark.slow
def test_the_place_is_told_with_the_name_of_the_output(
    browser: Chrome, page_of: BuildOutput
) -> None:
    words = {}
    for name in ("nail_machine_slide", "lathe_levers", BAR):
        open_page(browser, page_of(name))
        go(browser, 0.0)
        words[name] = browser.find_element(By.ID, "told").text.partition(", ")[2]
    assert words["nail_machine_slide"].startswith("pair: position of slide = ")
    assert words["lathe_levers"].startswith("position of slide = ")
    assert words[BAR].startswith("P_x: position = ")


def test_wheels_and_links_move_together(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of("nail_machine_slide"))
    turns = []
    for place in (0.0, 100.0, 250.0):
        go(browser, place)
        found = poses(browser)
        turns.append(found["pair.gear2"]["turn"] - found["crank"]["turn"])
        assert found["pair.gear1"]["turn"] == pytest.approx(-math.radians(place), abs=1e-6)
    assert all(abs(math.remainder(turn - turns[0], math.tau)) < 1e-5 for turn in turns)


@pytest.fixture
def live(browser: Chrome, tmp_path: Path) -> Iterator[Chrome]:
    file = tmp_path / "bar.toml"
    file.write_text((PROFILES / f"{BAR}.toml").read_text("utf-8"))
    with served(file) as (server, _):
        browser.get_log("browser")  # type: ignore[no-untyped-call]
        browser.get(server.address)
        until(lambda: browser.execute_script("return !!window.gearcam"))
        browser.execute_script(SPY)
        yield browser
        wrong = complaints(browser)
        browser.get("about:blank")  # the page would ask for a server that has ended
    assert wrong == []


def longest(scene: dict[str, Any], name: str) -> float:
    """Return the distance of the pins of a link, from the middles of its round holes."""
    (body,) = (one for one in scene["bodies"] if one["name"] == name)
    middles = [complex(sum(hole[::2]), sum(hole[1::2])) / (len(hole) / 2) for hole in body["metal"]]
    return max(abs(one - other) for one in middles[1:] for other in middles[1:])


@pytest.mark.parametrize(
    ("key", "link", "value"),
    [("crank[0].length_mm", "crank", 30.0), ("dyad[0].lengths_mm[1]", "rocker", 95.0)],
)
def test_a_length_is_dragged(live: Chrome, key: str, link: str, value: float) -> None:
    live.execute_script(
        "const one = document.getElementById(`key-${arguments[0]}`); one.value = arguments[1];"
        "one.dispatchEvent(new Event('input'))",
        key,
        value,
    )
    drafted = until(lambda: live.execute_script("return window.scenes.at(-1)"))
    assert longest(drafted, link) == pytest.approx(value, abs=1e-3)
    assert len(drafted["places"]) < 200  # coarse while it is dragged
    live.execute_script(
        "document.getElementById(`key-${arguments[0]}`).dispatchEvent(new Event('change'))", key
    )
    until(lambda: live.execute_script("return window.scenes.at(-1).places.length") == 721)


def field(page: Chrome, key: str) -> Any:
    return page.find_element(By.CSS_SELECTOR, f'input[aria-label="{key}, number"]')


def test_the_nearest_length_that_closes_is_taken_and_seen(live: Chrome) -> None:
    box = field(live, "dyad[0].lengths_mm[0]")
    box.clear()
    box.send_keys("1000\n")
    other = field(live, "dyad[0].lengths_mm[1]")
    until(lambda: float(other.get_attribute("value")) > 900.0)
    assert float(box.get_attribute("value")) == 1000.0
    assert len(live.find_elements(By.CLASS_NAME, "changed")) == 2
