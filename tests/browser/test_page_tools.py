"""What a page offers beside its pictures: measures, places that lines name, links, poses."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from helpers_browser import go, open_page, saved, settle, until

SVG = "{http://www.w3.org/2000/svg}"
WIDE = (1500, 950)
NAIL, FOUR_BAR = "nail_machine_two_phase", "four_bar"

BuildOutput = Callable[[str], Path]


def pixels(browser: Chrome, x: float, y: float) -> tuple[int, int]:
    """A point of the fixed frame, mm, as pixels from the middle of the picture."""
    view = browser.execute_script("return gearcam.parts.view")
    return round((x - view["x"]) * view["scale"]), round((view["y"] - y) * view["scale"])


def click(browser: Chrome, *points: complex) -> None:
    home = browser.find_element(By.ID, "parts")
    for one in points:
        spot = pixels(browser, one.real, one.imag)
        ActionChains(browser, duration=20).move_to_element_with_offset(
            home, *spot
        ).click().perform()
    settle(browser)


def choose(browser: Chrome, name: str, value: str) -> None:
    browser.find_element(By.CSS_SELECTOR, f"#{name} option[value='{value}'], #{name}").click()
    script = "const one = document.getElementById(arguments[0]); one.value = arguments[1];"
    script += " one.dispatchEvent(new Event('change'))"
    browser.execute_script(script, name, value)


def told(browser: Chrome) -> list[float]:
    rows = browser.find_elements(By.CSS_SELECTOR, "#measures output")
    return [float(re.findall(r"[\d.]+", one.text)[0]) for one in rows]


def joints(crank: float) -> dict[str, complex]:
    """Joints of the four-bar of the profile."""
    a, d = 0j, 110.0 + 0j
    b = 40.0 * cmath.exp(1j * math.radians(crank))
    way = d - b
    long = abs(way)
    along = (long * long + 120.0**2 - 90.0**2) / (2.0 * long)
    c = b + way / long * complex(along, math.sqrt(120.0**2 - along * along))
    return {"A": a, "B": b, "C": c, "D": d}


def test_measures_snap_to_joints_and_follow_the_motion(
    browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(FOUR_BAR), WIDE)
    go(browser, 40.0)
    at = joints(40.0)
    off = complex(0.8, 0.5)  # what is near is taken
    choose(browser, "measure", "distance")
    click(browser, at["B"] + off, at["D"] - off)
    assert told(browser) == pytest.approx([abs(at["B"] - at["D"])], abs=6e-3)
    choose(browser, "measure", "angle")
    click(browser, at["B"], at["C"], at["D"])
    turn = abs(cmath.phase((at["B"] - at["C"]) / (at["D"] - at["C"])))
    assert told(browser)[1] == pytest.approx(math.degrees(turn), abs=6e-3)
    go(browser, 130.0)
    at = joints(130.0)
    turn = abs(cmath.phase((at["B"] - at["C"]) / (at["D"] - at["C"])))
    assert told(browser) == pytest.approx([abs(at["B"] - at["D"]), math.degrees(turn)], abs=6e-3)
    browser.find_element(By.CSS_SELECTOR, "#measures button").click()
    assert told(browser) == pytest.approx([math.degrees(turn)], abs=6e-3)


def test_the_radius_of_a_bore_is_measured(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(NAIL), WIDE)
    choose(browser, "measure", "radius")
    click(browser, *(20.4 * cmath.exp(1j * one) for one in (0.3, 2.0, 4.4)))
    assert told(browser) == pytest.approx([20.0], abs=5e-3)
    # the picture is dragged again once nothing is measured
    before = browser.execute_script("return gearcam.parts.view.x")
    choose(browser, "measure", "")
    home = browser.find_element(By.ID, "parts")
    ActionChains(browser).move_to_element(home).click_and_hold().move_by_offset(60, 0).perform()
    ActionChains(browser).release().perform()
    assert browser.execute_script("return gearcam.parts.view.x") < before


def line(browser: Chrome, words: str) -> Any:
    (found,) = browser.find_elements(
        By.XPATH, f"//*[contains(@class, 'where') and normalize-space()='{words}']"
    )[:1]
    return found


def test_a_line_goes_to_its_angle_or_tooth(browser: Chrome, page_of: BuildOutput) -> None:
    document = open_page(browser, page_of(NAIL), WIDE)
    (text,) = re.findall(r"driving forward, phi1 = [\d.]+ deg", document["blocks"]["main"])
    line(browser, text).click()
    settle(browser)
    place = browser.execute_script("return gearcam.place")
    assert place == float(re.findall(r"= ([\d.]+)", text)[0])
    assert browser.execute_script("return gearcam.parts.following")
    # the tooth is in the middle of the view, and in contact
    line(browser, "wheel 2, tooth 16").send_keys(Keys.ENTER)
    settle(browser)
    view = browser.execute_script("return gearcam.parts.view")
    scene, place = document["scene"], browser.execute_script("return gearcam.place")
    wheel = next(one for one in scene["bodies"] if one["name"] == "gear2")
    first, last = wheel["teeth"][15]
    tip = wheel["metal"][0][2 * ((first + last) // 2) :][:2]
    pose = next(
        one for one in browser.execute_script("return gearcam.poses()") if one["name"] == "gear2"
    )
    there = complex(pose["x"], pose["y"]) + complex(*tip) * cmath.exp(1j * pose["turn"])
    assert abs(there - complex(view["x"], view["y"])) < 1.0
    near = [abs(one - place) for one in scene["places"]]
    index = near.index(min(near))
    touching = [
        pair[1]
        for one in scene["contacts"].values()
        for pair in one["teeth"][one["start"][index] : one["start"][index + 1]]
    ]
    assert 16 in touching


LIT = "return gearcam.page.seen.lit ?? []"


def test_lines_light_their_parts_and_parts_their_lines(
    browser: Chrome, page_of: BuildOutput
) -> None:
    document = open_page(browser, page_of(NAIL), WIDE)
    names = [one["name"] for one in document["scene"]["bodies"]]
    row = browser.find_element(By.XPATH, "//*[@id='main']//div[dt='overall size of wheel 2']")
    ActionChains(browser).move_to_element(row).perform()
    assert browser.execute_script(LIT) == [names.index("gear2")]
    click(browser, 45j)
    assert browser.execute_script(LIT) == []
    lit = [one.text for one in browser.find_elements(By.CSS_SELECTOR, "#main .lit dt")]
    assert "overall size of wheel 1" in lit
    assert "overall size of wheel 2" not in lit


OLD = ("#at=77&view=10,-5,6.5&open=facts", "#view=10%2C-5%2C6.5&at=77.0&open=facts,files")
"""Links of version 0.9 and what they show: they are read for ever."""


@pytest.mark.parametrize("link", OLD)
def test_old_links_show_what_they_showed(link: str, browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(FOUR_BAR), WIDE)
    browser.get("about:blank")
    browser.get(page_of(FOUR_BAR).as_uri() + link)
    settle(browser)
    seen = browser.execute_script("return [gearcam.place, gearcam.parts.view]")
    assert seen == [77, {"x": 10, "y": -5, "scale": 6.5}]
    assert browser.find_element(By.CSS_SELECTOR, "#facts details").get_attribute("open")


def test_the_address_keeps_what_is_seen(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(FOUR_BAR), WIDE)
    assert "#" not in browser.current_url
    go(browser, 123.5)
    browser.find_element(By.ID, "nearer").click()
    browser.find_element(By.CSS_SELECTOR, "#accuracy summary, #facts summary").click()
    state = "return [gearcam.place, gearcam.parts.view]"
    seen = browser.execute_script(state)
    until(lambda: all(one in browser.current_url for one in ("at=123.5", "view=", "open=")))
    link = browser.current_url
    browser.get("about:blank")
    browser.get(link)
    settle(browser)
    again = browser.execute_script(state)
    assert again[0] == seen[0]
    assert list(again[1].values()) == pytest.approx(list(seen[1].values()), rel=1e-5)


def test_a_sheet_of_poses_shows_twelve(
    browser: Chrome, page_of: BuildOutput, tmp_path: Path
) -> None:
    open_page(browser, page_of(FOUR_BAR), WIDE)
    root = ET.parse(saved(browser, tmp_path, "#poses", f"{FOUR_BAR}_poses.svg")).getroot()
    texts = [one.text or "" for one in root.iter(f"{SVG}text")]
    assert texts == [f"crank angle theta = {30 * k} deg" for k in range(12)]
    groups = root.findall(f"{SVG}g")
    assert len(groups) == 12
    # the coupler of each pose stands where the geometry puts it
    for k, group in enumerate(groups):
        wanted = joints(30.0 * k)["B"]
        places = [
            complex(float(one[0]), float(one[1]))
            for path in group.iter(f"{SVG}path")
            for one in re.findall(r"translate\((\S+) (\S+)\)", path.get("transform") or "")
        ]
        assert min(abs(one - wanted) for one in places) < 1e-3
