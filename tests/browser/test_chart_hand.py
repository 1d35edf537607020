"""The hand on a chart: it reads all curves, moves the parts, chooses a stretch, and saves it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement

from helpers_browser import open_page, saved, settle, until

SVG = "{http://www.w3.org/2000/svg}"
ELLIPSE, ECCENTRICITY = "ellipse", 0.3
RATIO = "Transmission ratio"

BuildOutput = Callable[[str], Path]


def ratio(degrees: float) -> float:
    """The ratio of equal ellipses about their foci (Litvin)."""
    e = ECCENTRICITY
    return (1.0 - e * e) / (1.0 + e * e + 2.0 * e * math.cos(math.radians(degrees)))


@pytest.fixture
def figure(browser: Chrome, page_of: BuildOutput) -> WebElement:
    """The chart of the ratio, drawn."""
    open_page(browser, page_of(ELLIPSE))
    found = browser.find_element(By.CSS_SELECTOR, "#charts > figure")
    assert found.find_element(By.TAG_NAME, "h3").text == RATIO
    until(lambda: found.find_elements(By.CLASS_NAME, "u-over"))
    ActionChains(browser).scroll_to_element(found).perform()
    return found


def over(figure: WebElement) -> WebElement:
    return figure.find_element(By.CLASS_NAME, "u-over")


def pixel(figure: WebElement) -> float:
    """Degrees of a pixel of the whole chart."""
    return 360.0 / over(figure).rect["width"]


def at(figure: WebElement, degrees: float) -> int:
    """How many pixels a place is from the middle of the whole chart."""
    return round((degrees - 180.0) / pixel(figure))


def told(figure: WebElement) -> float:
    return float(figure.find_element(By.CSS_SELECTOR, ".legend output").text)


def read_at(figure: WebElement) -> float:
    text = figure.find_element(By.CLASS_NAME, "at").text
    return float(re.sub(r"at (\S+) deg", r"\1", text))


def ends(figure: WebElement) -> list[float]:
    """Largest, its place, least, its place, as the legend tells them."""
    text = figure.find_element(By.CLASS_NAME, "extremes").text
    return [float(one) for one in re.findall(r"[\d.]+", text)]


def test_pointing_reads_curves_and_moves_nothing(browser: Chrome, figure: WebElement) -> None:
    before = told(figure)
    ActionChains(browser).move_to_element_with_offset(over(figure), at(figure, 230.0), 0).perform()
    until(lambda: figure.find_element(By.CLASS_NAME, "at").text)
    assert read_at(figure) == pytest.approx(230.0, abs=1.5 * pixel(figure))
    assert told(figure) == pytest.approx(ratio(read_at(figure)), rel=1e-3)
    assert browser.execute_script("return gearcam.place") == 0.0
    ActionChains(browser).move_to_element(browser.find_element(By.ID, "verdict")).perform()
    until(lambda: not figure.find_element(By.CLASS_NAME, "at").text)
    assert told(figure) == before


def test_dragging_and_arrow_keys_move_the_parts(browser: Chrome, figure: WebElement) -> None:
    hand = ActionChains(browser).move_to_element_with_offset(over(figure), at(figure, 90.0), 0)
    hand.click_and_hold().move_by_offset(40, 0).perform()
    settle(browser)
    place = browser.execute_script("return gearcam.place")
    assert place == pytest.approx(90.0 + 40 * pixel(figure), abs=pixel(figure))
    assert told(figure) == pytest.approx(ratio(place), rel=1e-4)
    ActionChains(browser).release().send_keys(Keys.ARROW_RIGHT).perform()
    settle(browser)
    after = browser.execute_script("return gearcam.place")
    assert after == pytest.approx(math.floor(place / 0.5 + 0.5) * 0.5 + 0.5, abs=1e-9)


def test_a_stretch_is_chosen_and_left(browser: Chrome, figure: WebElement) -> None:
    assert ends(figure) == pytest.approx([13 / 7, 180.0, 7 / 13, 0.0], rel=1e-4)
    wide = pixel(figure)
    start = ActionChains(browser).key_down(Keys.SHIFT)
    start.move_to_element_with_offset(over(figure), at(figure, 90.0), 0).click_and_hold()
    start.move_by_offset(round(60.0 / wide), 0).release().key_up(Keys.SHIFT).perform()
    settle(browser)
    assert browser.execute_script("return gearcam.place") == 0.0
    most, right, least, left = ends(figure)
    assert [left, right] == pytest.approx([90.0, 150.0], abs=2.0 * wide)
    assert [least, most] == pytest.approx([ratio(left), ratio(right)], rel=1e-4)
    # the pointer reads the stretch, not the whole
    ActionChains(browser).move_to_element(over(figure)).perform()
    until(lambda: figure.find_element(By.CLASS_NAME, "at").text)
    assert read_at(figure) == pytest.approx(120.0, abs=2.0 * wide)
    ActionChains(browser).double_click(over(figure)).perform()
    settle(browser)
    assert ends(figure)[1] == 180.0
    figure.find_element(By.XPATH, ".//button[text()='Zoom']").click()
    hand = ActionChains(browser).move_to_element_with_offset(over(figure), at(figure, 30.0), 0)
    hand.click_and_hold().move_by_offset(round(30.0 / wide), 0).release().perform()
    settle(browser)
    assert ends(figure)[1] == pytest.approx(60.0, abs=2.0 * wide)
    figure.find_element(By.XPATH, ".//button[text()='Whole']").click()
    settle(browser)
    assert ends(figure)[1] == 180.0


@pytest.mark.usefixtures("figure")
def test_a_chart_is_saved_as_it_is_seen(browser: Chrome, tmp_path: Path) -> None:
    button = f'[aria-label="Save SVG: {RATIO}"]'
    root = ET.parse(saved(browser, tmp_path, button, f"{ELLIPSE}_ratio.svg")).getroot()
    texts = [one.text or "" for one in root.iter(f"{SVG}text")]
    assert texts[0] == RATIO
    assert "driver angle phi1, deg" in texts
    # an axis in degrees has steps of 45 there
    steps = [str(one) for one in range(0, 361, 45)]
    start = texts.index("0")
    assert texts[start : start + len(steps)] == steps
    # the line is the law's, to the tenth of a pixel
    (clip,) = (one for one in root.iter(f"{SVG}clipPath"))
    left, width = (float(clip[0].attrib[one]) for one in ("x", "width"))
    lines = [one for one in root.iter(f"{SVG}path") if one.get("stroke-width") == "1.6"]
    x, y = np.array(re.findall(r"[\d.]+", lines[0].attrib["d"]), dtype=float).reshape(-1, 2).T
    wanted = np.array([ratio(one) for one in 360.0 * (x - left) / width])
    scale = np.ptp(y) / np.ptp(wanted)
    np.testing.assert_allclose(y, y.max() - scale * (wanted - wanted.min()), atol=0.1)
    picture = saved(
        browser, tmp_path, button.replace("SVG", "PNG"), f"{ELLIPSE}_ratio.png"
    ).read_bytes()
    sides = [int.from_bytes(picture[k : k + 4], "big") for k in (16, 20)]
    assert sides == [3 * math.floor(float(root.attrib[one])) for one in ("width", "height")]
