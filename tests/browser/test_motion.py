"""Parts in a page stand where the library computes them; keys, slider and charts agree."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from selenium.webdriver import ActionChains, Chrome, Keys
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement
from shapely import affinity

from gearcam.report.file import report_files
from gearcam.report.page import PAGE
from helpers_browser import complaints, go, open_page, requests, settle, unfold, until

NAIL = "nail_machine_two_phase"
ROUNDED = 1e-6
"""Turns are told in steps of 1e-7 rad, lengths in 1e-4 mm."""
BENT = 0.5e-5
"""Error of a turn between two places half a degree apart, rad: an eighth of its second derivative,
below 0.5 for these, times the square of the step."""

BuildOutput = Callable[[str], Path]
Built = Callable[[str], Any]


def poses(browser: Chrome) -> dict[str, Any]:
    return {one["name"]: one for one in browser.execute_script("return gearcam.poses()")}


def slide(browser: Chrome, index: int) -> None:
    """Drag the slider to one of its stops."""
    slider = browser.find_element(By.ID, "place")
    script = "arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))"
    browser.execute_script(script, slider, index)
    settle(browser)


def number_of(name: str, charts: list[dict[str, Any]]) -> int:
    return [chart["name"] for chart in charts].index(name)


def drawn(browser: Chrome, figure: WebElement) -> WebElement:
    """The plot of a chart, once it is scrolled to and drawn."""
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", figure)
    return until(lambda: figure.find_elements(By.CLASS_NAME, "u-over"))[0]


@pytest.mark.parametrize("name", [NAIL, "groove_cam", "feeder"])
def test_a_page_opens_without_complaint_or_network(
    name: str, browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(name))
    unfold(browser)
    for figure in browser.find_elements(By.CLASS_NAME, "chart"):
        drawn(browser, figure)
    go(browser, 100.0)
    assert complaints(browser) == []
    own = page_of(name).as_uri()
    assert [url for url in requests(browser) if url != own and not url.startswith("data:")] == []


def test_a_written_page_is_small_and_quickly_there(
    browser: Chrome, built: Built, tmp_path: Path
) -> None:
    path = tmp_path / PAGE
    path.write_bytes(report_files(built(NAIL), {})[PAGE])
    assert path.stat().st_size <= 4_000_000
    open_page(browser, path)
    mark = "return performance.getEntriesByName('first-picture')[0].startTime"
    assert browser.execute_script(mark) < 3 * 1000.0  # a second, on a busy machine


def test_the_slider_turns_wheels_as_the_library_does(
    browser: Chrome, page_of: BuildOutput, built: Built
) -> None:
    places = open_page(browser, page_of(NAIL))["scene"]["places"]
    for index in (0, 1, 250, 719, 720):
        slide(browser, index)
        phi1 = math.radians(places[index])
        phi2 = math.radians(built(NAIL).motion(np.array([phi1]))["phi2_deg"][0])
        there = poses(browser)
        assert there["gear1"]["turn"] == pytest.approx(-phi1, abs=ROUNDED)
        assert there["gear2"]["turn"] == pytest.approx(phi2, abs=ROUNDED)
        assert (there["gear2"]["x"], there["gear2"]["y"]) == (180.0, 0.0)


def test_between_places_wheels_turn_evenly(
    browser: Chrome, page_of: BuildOutput, built: Built
) -> None:
    open_page(browser, page_of(NAIL))
    for place in (33.2, 160.27):
        go(browser, place)
        phi2 = math.radians(built(NAIL).motion(np.radians([place]))["phi2_deg"][0])
        assert poses(browser)["gear2"]["turn"] == pytest.approx(phi2, abs=BENT)


def test_a_follower_is_lifted_as_the_library_does(
    browser: Chrome, page_of: BuildOutput, built: Built
) -> None:
    open_page(browser, page_of("groove_cam"))
    for place in (0.0, 45.0, 120.0, 230.0):
        go(browser, place)
        lift = built("groove_cam").motion(np.radians([place]))["lift_mm"][0]
        there = poses(browser)
        assert there["follower"]["y"] == pytest.approx(lift, abs=1e-4)
        assert abs(there["cam"]["turn"]) == pytest.approx(math.radians(place), abs=ROUNDED)


COLOURS = {"gear1": (207, 224, 242), "gear2": (248, 224, 198), "ground": (255, 255, 255)}
"""Of the page in light, as of saved drawings."""
PIXELS_READ = """
const [xs, ys] = arguments;
const pen = document.getElementById("parts").getContext("2d");
return xs.map((x, k) => [...pen.getImageData(x, ys[k], 1, 1).data].slice(0, 3));
"""


def test_the_picture_is_of_the_outlines(
    browser: Chrome, page_of: BuildOutput, built: Built
) -> None:
    """Pixels away from edges have the colour of the part that shapely finds there."""
    scene = open_page(browser, page_of(NAIL))["scene"]
    for box in browser.find_elements(By.CSS_SELECTOR, "#seen input:checked"):
        box.click()
    go(browser, 77.0)
    wide, tall, scale = fitted(browser, scene["box"])
    left, bottom, right, top = scene["box"]
    phi2 = built(NAIL).motion(np.radians([77.0]))["phi2_deg"][0]
    regions, drawn = {}, [shapely.MultiPoint([(0.0, 0.0), (180.0, 0.0)]).buffer(8.0)]
    for part, turn, x in zip(built(NAIL).parts, (-77.0, phi2), (0.0, 180.0), strict=True):
        marks = shapely.MultiPoint(
            [(mark.center.real, mark.center.imag) for mark in part.marks]
        ).buffer(2.0)
        regions[part.name], mark = (
            affinity.translate(affinity.rotate(one, turn, origin=(0.0, 0.0)), x)
            for one in (part.region, marks)
        )
        drawn.append(mark)
    pixels = np.random.default_rng(5).integers((0, 0), (wide, tall), (3000, 2))
    x = (pixels[:, 0] + 0.5 - 0.5 * wide) / scale + 0.5 * (left + right)
    y = (0.5 * tall - pixels[:, 1] - 0.5) / scale + 0.5 * (bottom + top)
    spots = shapely.points(x, y)
    edges = shapely.union_all([one.boundary for one in regions.values()])
    clear = shapely.distance(edges, spots) > 3.0 / scale
    clear &= ~shapely.contains(shapely.union_all(drawn), spots)
    read = np.array(browser.execute_script(PIXELS_READ, *pixels.T.tolist()))
    inside = {name: shapely.contains(one, spots) for name, one in regions.items()}
    inside["ground"] = ~np.any(list(inside.values()), axis=0)
    for name, there in inside.items():
        assert (there & clear).sum() > 200
        assert (read[there & clear] == COLOURS[name]).all()


def fitted(browser: Chrome, box: list[float]) -> tuple[int, int, float]:
    """Width and height of the picture, pixels, and pixels for a mm where it shows the whole."""
    script = "const c = document.getElementById('parts'); return [c.width, c.height]"
    wide, tall = browser.execute_script(script)
    return wide, tall, 0.95 * min(wide / (box[2] - box[0]), tall / (box[3] - box[1]))


def read_at(browser: Chrome, x: float, y: float) -> list[int]:
    """Colour of a pixel of the picture."""
    return browser.execute_script(PIXELS_READ, [round(x)], [round(y)])[0]


def test_what_is_pointed_at_stays_when_zoomed_and_goes_when_dragged(
    browser: Chrome, page_of: BuildOutput
) -> None:
    """The cross of shaft 1: its middle is dark, what is beside it the ground of the bore."""
    box = open_page(browser, page_of(NAIL))["scene"]["box"]
    wide, tall, scale = fitted(browser, box)
    x, y = 0.5 * wide - scale * 0.5 * (box[0] + box[2]), 0.5 * tall
    canvas = browser.find_element(By.ID, "parts")
    at = (round(x - 0.5 * wide), 0)
    origin = ScrollOrigin.from_element(canvas, *at)
    ActionChains(browser).scroll_from_origin(origin, 0, -700).perform()
    settle(browser)
    assert sum(read_at(browser, x, y)) < 600  # a thin line over white
    assert read_at(browser, x + 50, y + 50) == [255, 255, 255]  # ten millimetres were 14 pixels
    drag = ActionChains(browser).move_to_element_with_offset(canvas, *at).click_and_hold()
    drag.move_by_offset(70, -90).release().perform()
    settle(browser)
    assert sum(read_at(browser, x + 70, y - 90)) < 600
    assert browser.execute_script("return gearcam.place") == 0.0


def test_the_view_follows_the_contact(browser: Chrome, page_of: BuildOutput) -> None:
    """The pitch point in the middle, with its own colour."""
    open_page(browser, page_of(NAIL))
    browser.find_element(By.ID, "mesh").click()
    for label in browser.find_elements(By.CSS_SELECTOR, "#seen label"):
        if label.text in ("pitch point", "line of action", "contact points"):
            label.click()
    middle = "const c = document.getElementById('parts'); return [c.width / 2, c.height / 2]"
    for place in (0.0, 100.0, 300.0):
        go(browser, place)
        assert read_at(browser, *browser.execute_script(middle)) == [0x5B, 0x2F, 0xA0]


def test_keys_move_the_parts(browser: Chrome, page_of: BuildOutput) -> None:
    places = open_page(browser, page_of(NAIL))["scene"]["places"]
    pressed = [
        (Keys.ARROW_RIGHT, 1), (Keys.ARROW_UP, 2), (Keys.ARROW_LEFT, 1), (Keys.PAGE_UP, 21),
        (Keys.PAGE_DOWN, 1), (Keys.ARROW_DOWN, 0), (Keys.END, 720), (Keys.ARROW_RIGHT, 720),
        (Keys.HOME, 0), (Keys.PAGE_DOWN, 0),
    ]  # fmt: skip
    for where, keys in (("place", pressed), ("parts", pressed[:4])):
        home = browser.find_element(By.ID, where)
        for key, index in keys:
            home.send_keys(key)
            assert browser.execute_script("return gearcam.place") == places[index], key
    settle(browser)
    assert browser.find_element(By.ID, "place").get_attribute("value") == "21"


def test_space_plays_and_pauses(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(NAIL))
    canvas, button = (browser.find_element(By.ID, name) for name in ("parts", "play"))
    told = browser.find_element(By.ID, "told")
    canvas.send_keys(Keys.SPACE)
    assert (button.text, told.get_attribute("aria-live")) == ("Pause", "off")
    until(lambda: browser.execute_script("return gearcam.place > 1"))
    canvas.send_keys(Keys.SPACE)
    assert (button.text, told.get_attribute("aria-live")) == ("Play", "polite")
    settle(browser)
    place = browser.execute_script("return gearcam.place")
    settle(browser)
    assert browser.execute_script("return gearcam.place") == place
    assert told.text.startswith(f"driver angle phi1 = {place:.1f} deg, ratio i21 = ")


def test_a_driven_wheel_goes_on_where_a_cycle_ends(browser: Chrome, page_of: BuildOutput) -> None:
    """The ring has twice the teeth: after a turn of the driver it is half round, not back."""
    open_page(browser, page_of("ring_ellipse"))
    go(browser, 359.5)
    before = poses(browser)["gear2"]["turn"]
    browser.find_element(By.ID, "play").click()
    until(lambda: browser.execute_script("return gearcam.place < 180"))
    browser.find_element(By.ID, "play").click()
    after = poses(browser)["gear2"]["turn"]
    assert abs(before) < math.pi + 0.1
    assert 0.0 < abs(after) - abs(before) < 0.5


def test_a_click_on_a_chart_moves_parts_and_all_cursors(
    browser: Chrome, page_of: BuildOutput, built: Built
) -> None:
    charts = open_page(browser, page_of(NAIL))["charts"]
    unfold(browser)
    figure = browser.find_elements(By.CLASS_NAME, "chart")[number_of("ratio", charts)]
    over = drawn(browser, figure)
    width = over.size["width"]
    right = -round(0.44 * width)  # of the middle, pixels
    ActionChains(browser).move_to_element_with_offset(over, right, 0).click().perform()
    settle(browser)
    place = browser.execute_script("return gearcam.place")
    assert place == pytest.approx(180.0 + 360.0 * right / width, abs=360.0 / width)
    ratio = built(NAIL).motion(np.radians([place]))["ratio"][0]
    told = figure.find_element(By.CSS_SELECTOR, ".legend output").text
    assert float(told) == pytest.approx(ratio, abs=1e-4)  # five digits
    assert poses(browser)["gear1"]["turn"] == pytest.approx(-math.radians(place), abs=ROUNDED)
    for chart, figure in zip(charts, browser.find_elements(By.CLASS_NAME, "chart"), strict=True):
        drawn(browser, figure)
        go(browser, place)
        cursor = figure.find_element(By.CLASS_NAME, "cursor")
        assert cursor.is_displayed() is (chart["x"] == "driver angle phi1, deg")
        if cursor.is_displayed():
            own = figure.find_element(By.CLASS_NAME, "u-over").rect
            middle = cursor.rect["x"] + 0.5 * cursor.rect["width"] - own["x"]
            assert middle == pytest.approx(own["width"] * place / 360.0, abs=1.5)


def test_a_chart_that_is_not_over_the_driver_stays(browser: Chrome, page_of: BuildOutput) -> None:
    charts = open_page(browser, page_of(NAIL))["charts"]
    unfold(browser)
    figure = browser.find_elements(By.CLASS_NAME, "chart")[number_of("contact_ratio", charts)]
    drawn(browser, figure).click()
    assert browser.execute_script("return gearcam.place") == 0.0


def test_where_motion_is_to_be_reduced_it_steps(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(NAIL), prefers_reduced_motion="reduce")
    button = browser.find_element(By.ID, "play")
    assert button.text == "Step"
    button.click()
    settle(browser)
    settle(browser)
    assert browser.execute_script("return gearcam.place") == pytest.approx(10.0)
    browser.find_element(By.ID, "animate").click()
    assert button.text == "Play"
    button.click()
    until(lambda: browser.execute_script("return gearcam.place > 11"))
    button.click()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("feeder", r"driver angle phi1 = 100\.0 deg, velocity = [\d.]+ mm/rad"),
        ("measured_cam", r"cam angle theta = 100\.0 deg, lift = [\d.]+ mm"),
        ("translating_cam", r"travel u = 100\.0 mm, lift = [\d.]+ mm"),
    ],
)
def test_the_place_is_said_with_what_is_measured_there(
    name: str, value: str, browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(name))
    go(browser, 100.0)
    assert re.fullmatch(value, browser.find_element(By.ID, "told").text)


def test_knots_are_drawn_and_told(browser: Chrome, page_of: BuildOutput) -> None:
    charts = open_page(browser, page_of(NAIL))["charts"]
    unfold(browser)
    figure = browser.find_elements(By.CLASS_NAME, "chart")[0]
    drawn(browser, figure)
    assert "knot" in figure.find_element(By.CLASS_NAME, "legend").text
    ink = """
        const canvas = arguments[0].querySelector("canvas");
        return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data
            .reduce((sum, one) => sum + one, 0);
    """
    marked = browser.execute_script(ink, figure)
    plain = [chart | {"marks": []} for chart in charts]
    browser.execute_script("gearcam.show({ charts: arguments[0] })", plain)
    settle(browser)
    assert browser.execute_script(ink, figure) < marked
    assert "knot" not in figure.find_element(By.CLASS_NAME, "legend").text


RECORD = """
const pen = CanvasRenderingContext2D.prototype;
const fill = pen.fillText;
window.written = {};
pen.fillText = function (text, ...place) {
    if (document.querySelector(".chart").contains(this.canvas)) {
        window.written[text] = [this.textBaseline, ...place];
    }
    return fill.call(this, text, ...place);
};
gearcam.show({ charts: arguments[0] });
"""
"""Shows charts, and records what is written in the first one: baseline and place by text."""


def test_small_numbers_stand_at_the_axis_and_labels_of_limits_apart(
    browser: Chrome, page_of: BuildOutput
) -> None:
    charts = open_page(browser, page_of("groove_cam"))["charts"]
    assert "lift = 0 mm" in browser.find_element(By.TAG_NAME, "body").text
    drawn(browser, browser.find_elements(By.CLASS_NAME, "chart")[0])
    levels = {"outer": 3e-16, "inner": 2.9e-16, "low": -2e-16}
    tiny = charts[0] | {
        "lines": [charts[0]["lines"][0] | {"x": [0, 360], "y": [-2e-16, 3e-16]}],
        "range": [-2e-16, 3e-16],
        "ends": [[0, 360], [-2.3e-16, 3.3e-16]],
        "limits": [{"label": one, "value": at, "seen": True} for one, at in levels.items()],
    }
    browser.execute_script(RECORD, [tiny, *charts[1:]])
    settle(browser)
    written = browser.execute_script("return window.written")
    assert {name: written.get(name, [None])[0] for name in levels} == {
        "outer": None,  # it would lie upon the inner one
        "inner": "alphabetic",
        "low": "alphabetic",
    }
    assert {"-2e-16", "0", "2e-16"} <= {*written}


def test_numbers_at_logarithmic_axes_stand_at_their_logarithms(
    browser: Chrome, page_of: BuildOutput
) -> None:
    """An axis that is logarithmic after it was linear."""
    charts = open_page(browser, page_of("groove_cam"))["charts"]
    drawn(browser, browser.find_elements(By.CLASS_NAME, "chart")[0])
    x, y = [1e-3, 1e-2, 1.0], [1e-5, None, 1e-11]
    errors = charts[0] | {"lines": [charts[0]["lines"][0] | {"x": x, "y": y}], "limits": []}
    errors |= {"log": "xy", "range": [1e-11, 1e-5], "ends": [[1e-3, 1.0], [1e-11, 1e-5]]}
    browser.execute_script(RECORD, [errors, *charts[1:]])
    settle(browser)
    written = browser.execute_script("return window.written")
    numbers = {text: place for text, (_, *place) in written.items() if re.match(r"[\d.e-]+$", text)}
    for texts, axis in ((("0.001", "0.01", "0.1"), 0), (("1e-11", "1e-9", "1e-7"), 1)):
        places = [numbers[text][axis] for text in texts]
        assert places[2] - places[1] == pytest.approx(places[1] - places[0], abs=1.0)
        assert abs(places[1] - places[0]) > 50.0
