"""Profiles in the colours of what a reader chooses; the largest value is marked where it is."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.support.select import Select

from gearcam.report.page import document
from helpers_browser import PHONE, complaints, go, open_page, settle

VALVE = "valve_train"
PRESSURE, FORCE, ANGLE = "contact pressure", "normal force", "pressure angle"
LEVELS = [
    "440154", "482878", "3e4989", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b",
    "fde725",
]  # fmt: skip
"""Colours from the least to the largest value."""
TEXT = {"light": [0x1D, 0x25, 0x30], "dark": [0xE4, 0xE8, 0xED]}

READ = """
const [xs, ys] = arguments;
const pen = document.getElementById("parts").getContext("2d");
return xs.map((x, k) => [...pen.getImageData(Math.floor(x), Math.floor(ys[k]), 1, 1).data]
    .slice(0, 3));
"""

BuildOutput = Callable[[str], Path]
Built = Callable[[str], Any]


def choose(browser: Chrome, quantity: str) -> None:
    Select(browser.find_element(By.ID, "colouring")).select_by_visible_text(quantity)
    settle(browser)


def hide_contacts(browser: Chrome) -> None:
    for box in browser.find_elements(By.CSS_SELECTOR, "#seen input:checked"):
        box.click()
    settle(browser)


def read(browser: Chrome, points: Any, box: list[float]) -> list[list[int]]:
    """Colours of the picture at points, mm, in the fixed frame."""
    script = "const c = document.getElementById('parts'); return [c.width, c.height]"
    wide, tall = browser.execute_script(script)
    scale = 0.95 * min(wide / (box[2] - box[0]), tall / (box[3] - box[1]))
    x = 0.5 * wide + scale * (points.real - 0.5 * (box[0] + box[2]))
    y = 0.5 * tall - scale * (points.imag - 0.5 * (box[1] + box[3]))
    return browser.execute_script(READ, x.tolist(), y.tolist())


def spot(columns: Any, column: str) -> float:
    """Cam angle of the largest value, deg, where the ring covers the profile."""
    return float(columns["theta_deg"][np.nanargmax(columns[column])])


def strokes(browser: Chrome) -> set[str]:
    """Colours of the lines of a saved picture."""
    return set(re.findall(r'stroke="#(\w{6})"', browser.execute_script("return gearcam.svg()")))


def on_profile(result: Any, theta: Any, turned: float) -> Any:
    """Points of contact at cam angles, deg, where the cam has turned to another angle."""
    contact = result.contact(np.radians(theta))
    return (contact["x_mm"] + 1j * contact["y_mm"]) * np.exp(1j * math.radians(turned))


def test_the_profile_takes_the_colours_of_what_is_chosen(
    browser: Chrome, page_of: BuildOutput, built: Built
) -> None:
    """The level of the study's value, whatever the position of the cam, away from other levels."""
    box = open_page(browser, page_of(VALVE))["scene"]["box"]
    result, columns = built(VALVE), built(VALVE).study("forces").columns
    hide_contacts(browser)
    options = Select(browser.find_element(By.ID, "colouring")).options
    assert [one.text for one in options] == ["nothing", FORCE, PRESSURE]
    theta = np.arange(5.0, 360.0, 5.0)
    colours = [[int(one[k : k + 2], 16) for k in (0, 2, 4)] for one in LEVELS]
    seen = []
    for quantity, column in ((FORCE, "normal_n"), (PRESSURE, "pressure_mpa")):
        choose(browser, quantity)
        values = columns[column]
        near = theta + np.array([[-1.0], [0.0], [1.0]])
        share = (np.interp(near, columns["theta_deg"], values) - values.min()) / np.ptp(values)
        level = np.floor(10.0 * share).astype(int)
        clear = (np.ptp(level, axis=0) == 0) & (np.abs(theta - spot(columns, column)) > 10.0)
        assert len(set(level[0, clear])) >= 5
        for turned in (0.0, 140.0):
            go(browser, turned)
            found = read(browser, on_profile(result, theta, turned), box)
            told = [one for one, own in zip(found, clear, strict=True) if own]
            assert told == [colours[one] for one in level[0, clear]], (quantity, turned)
        seen.append(found)
    assert seen[0] != seen[1]
    choose(browser, "nothing")
    assert not any(one in colours for one in read(browser, on_profile(result, theta, 140.0), box))


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_ring_is_at_the_contact_of_the_largest_pressure(
    scheme: str,
    browser: Chrome,
    page_of: BuildOutput,
    built: Built,
    tmp_path: Path,
) -> None:
    """As in forces.csv: eight pixels around that point have the colour of the ring."""
    result = built(VALVE)
    result.study("forces").write(tmp_path)
    (path,) = tmp_path.rglob("forces.csv")
    with path.open() as file:
        rows = list(csv.DictReader(file))
    highest = max(rows, key=lambda row: float(row["pressure_mpa"]))
    place, largest = float(highest["theta_deg"]), float(highest["pressure_mpa"])
    box = open_page(browser, page_of(VALVE), prefers_color_scheme=scheme)["scene"]["box"]
    hide_contacts(browser)
    choose(browser, PRESSURE)
    told = browser.find_element(By.ID, "scale").text.replace("\n", " ")
    words = r"([\d.]+) ([\d.]+) MPa largest at cam angle theta = ([\d.]+) deg"
    numbers = re.fullmatch(words, told)
    assert numbers
    least = min(float(row["pressure_mpa"]) for row in rows)
    wanted = pytest.approx([least, largest, place], abs=1e-5 * largest)
    assert [*map(float, numbers.groups())] == wanted
    size = browser.find_element(By.ID, "parts").size
    pixel = max((box[2] - box[0]) / size["width"], (box[3] - box[1]) / size["height"]) / 0.95
    around = 9.0 * pixel * np.exp(1j * math.pi * np.arange(8) / 4)
    for turned in (0.0, 90.0, place):
        go(browser, turned)
        at = on_profile(result, np.array([place]), turned)
        found = np.array(read(browser, at + around, box))
        assert np.abs(found - TEXT[scheme]).max() <= 8, turned  # edges of lines are blended


def test_a_saved_picture_has_the_colours(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of("conjugate_cams"))
    assert not strokes(browser) & {*LEVELS}
    choose(browser, ANGLE)
    assert strokes(browser) >= {*LEVELS}


@pytest.mark.parametrize("name", ["nail_machine_two_phase", "yoke_cam"])
def test_without_values_there_is_nothing_to_choose(
    name: str, browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(name))
    assert not browser.find_element(By.ID, "colouring").is_displayed()


def test_the_choice_stays_while_there_are_such_values(
    browser: Chrome, page_of: BuildOutput, built: Built
) -> None:
    """Also over drafts that have no forces; they are drawn without colours."""
    whole = open_page(browser, page_of(VALVE))
    choose(browser, PRESSURE)
    legend = browser.find_element(By.ID, "scale")
    before = legend.text
    draft = {"title": whole["title"], "scene": {**whole["scene"], "coloured": [], "scales": {}}}
    browser.execute_script("gearcam.show(arguments[0])", {**draft, "blocks": {}})
    settle(browser)
    assert legend.text == ""
    browser.execute_script("gearcam.show(arguments[0])", whole)
    settle(browser)
    assert legend.text == before
    other = document(built("groove_cam"))
    browser.execute_script("gearcam.show(arguments[0])", other)
    settle(browser)
    chosen = Select(browser.find_element(By.ID, "colouring"))
    assert [one.text for one in chosen.options] == ["nothing", ANGLE]
    assert chosen.first_selected_option.text == "nothing"
    assert complaints(browser) == []


def test_colours_are_told_on_a_phone_and_on_paper(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of("groove_cam"), PHONE)
    colours = browser.find_element(By.ID, "colours")
    media = "Emulation.setEmulatedMedia"
    browser.execute_cdp_cmd(media, {"media": "print"})
    assert not colours.is_displayed()  # nothing is coloured
    browser.execute_cdp_cmd(media, {"media": ""})
    choose(browser, ANGLE)
    wide = "const e = document.scrollingElement; return [e.scrollWidth, e.clientWidth]"
    assert browser.execute_script(wide) == [PHONE[0], PHONE[0]]
    browser.execute_cdp_cmd(media, {"media": "print"})
    assert colours.is_displayed()
    assert len(colours.find_elements(By.TAG_NAME, "i")) == len(LEVELS)
    browser.execute_cdp_cmd(media, {"media": ""})
