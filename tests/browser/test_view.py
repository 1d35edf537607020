"""The live view in a browser: it reloads, follows sliders, saves, and shows what is wrong."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from gearcam import kinds
from helpers_browser import complaints, settle
from helpers_pairs import PROFILES
from helpers_view import served

NAIL = PROFILES / "nail_machine_two_phase.toml"
SECONDS = 60.0
WIDE = (1500, 950)
SPY = """
    window.documents = [];
    const show = window.gearcam.show;
    window.gearcam.show = (next) => { window.documents.push(next); show(next); };
"""

pytestmark = pytest.mark.slow


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "nail.toml"
    made.write_text(NAIL.read_text())
    return made


@pytest.fixture
def page(file: Path, browser: Chrome) -> Iterator[Chrome]:
    """The nail machine's page, as the command serves it; it must end as it should."""
    words = [sys.executable, "-m", "gearcam", "view", str(file), "--no-browser"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        browser.get_log("browser")  # type: ignore[no-untyped-call]
        (address,) = re.findall(r"http://\S+/", process.stdout.readline())
        browser.get(address)
        until(lambda: browser.find_elements(By.ID, "parts"))
        until(lambda: browser.execute_script("return !!window.gearcam"))
        browser.execute_script(SPY)
        yield browser
        wrong = browser.get_log("browser")  # type: ignore[no-untyped-call]
        browser.get("about:blank")  # the page would ask for a server that has ended
        process.send_signal(signal.SIGINT)
        assert process.wait(SECONDS) == 0
    assert [one["message"] for one in wrong if one["level"] == "SEVERE"] == []


def until(true: Callable[[], Any]) -> Any:
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        found = true()
        if found:
            return found
        time.sleep(0.05)
    raise TimeoutError


def shown(page: Chrome) -> list[dict[str, Any]]:
    return page.execute_script(
        "return window.documents.map((one) => ({charts: (one.charts || []).length,"
        " facts: one.blocks.facts, draft: one.scene.places.length < 721}))"
    )


def error(page: Chrome) -> str:
    return page.find_element(By.ID, "error").text


def slider(page: Chrome, key: str) -> Any:
    return page.find_element(By.ID, f"key-{key}")


def field(page: Chrome, key: str) -> Any:
    return page.find_element(By.CSS_SELECTOR, f'input[aria-label="{key}, number"]')


def test_the_page_follows_the_file(page: Chrome, file: Path) -> None:
    file.write_text(file.read_text().replace("distance_mm = 180", "distance_mm = 200"))
    until(lambda: shown(page) and not shown(page)[-1]["draft"])
    last = shown(page)[-1]
    assert last["charts"] >= 6
    assert "200 mm" in last["facts"]
    until(lambda: float(field(page, "pair.center_distance_mm").get_attribute("value")) == 200)


def test_a_bad_file_is_told_and_the_last_good_page_stays(page: Chrome, file: Path) -> None:
    good = file.read_text()
    facts = page.find_element(By.ID, "facts").text
    file.write_text(good.replace("teeth = [36, 36]", "teeth = [36]\nwheels = 2"))
    told = until(lambda: error(page))
    assert "2 problems" in told
    assert "pair.wheels" in told
    assert page.find_element(By.ID, "facts").text == facts
    assert page.find_element(By.ID, "error").get_attribute("role") == "alert"
    file.write_text(good)
    until(lambda: not error(page))


def test_a_slider_is_followed_coarsely_and_then_exactly(page: Chrome, file: Path) -> None:
    before = file.read_text()
    one = slider(page, "law.ratios[1]")
    drawn = 'return document.querySelector("#charts .plot").getAttribute("aria-label")'
    page.execute_script('document.querySelector("#charts").scrollIntoView()')
    chart = page.execute_script(drawn)
    page.execute_script(
        "for (const value of [0.41, 0.42, 0.43]) { arguments[0].value = value;"
        " arguments[0].dispatchEvent(new Event('input')); }",
        one,
    )
    until(lambda: shown(page))
    assert shown(page)[0]["draft"]
    until(lambda: page.execute_script(drawn) != chart)
    assert all(one["draft"] for one in shown(page))
    page.execute_script("arguments[0].dispatchEvent(new Event('change'))", one)
    until(lambda: not shown(page)[-1]["draft"])
    # the cosine of two phases closes where both ratios make 2
    until(lambda: float(field(page, "law.ratios[0]").get_attribute("value")) == 1.57)
    assert not page.find_elements(By.ID, "key-law.ratios[2]")  # it is the first
    assert file.read_text() == before
    page.find_element(By.ID, "save").click()
    until(lambda: file.read_text() != before)
    assert tomllib.loads(file.read_text())["law"]["ratios"] == [1.57, 0.43, 1.57]
    assert file.read_text() == before.replace("[1.6, 0.4, 1.6]", "[1.57, 0.43, 1.57]")
    until(lambda: not page.find_element(By.ID, "save").is_enabled())
    width = field(page, "pair.face_width_mm")  # and once more, on what is there now
    width.clear()
    width.send_keys("60", Keys.ENTER)
    until(lambda: page.find_element(By.ID, "save").is_enabled())
    page.find_element(By.ID, "save").click()
    until(lambda: "face_width_mm = 60" in file.read_text())


@pytest.fixture
def wide(page: Chrome) -> Iterator[Chrome]:
    """The page in a window of a large screen."""
    metrics = {"width": WIDE[0], "height": WIDE[1], "deviceScaleFactor": 1, "mobile": False}
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    settle(page)
    yield page
    page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_numbers_picture_and_leading_charts_are_in_one_view(wide: Chrome) -> None:
    figures = wide.find_elements(By.CSS_SELECTOR, "#charts > figure")
    assert len(figures) == 3
    seen = [*figures, wide.find_element(By.ID, "parts"), wide.find_element(By.ID, "controls")]
    seen += wide.find_elements(By.CSS_SELECTOR, "#numbers .key")[:3]
    boxes = [one.rect for one in seen]
    for box in boxes:
        assert min(box["x"], box["y"]) >= 0
        assert box["x"] + box["width"] <= WIDE[0]
        assert box["y"] + box["height"] <= WIDE[1]
    across = "const e = document.scrollingElement; return [e.scrollWidth, e.clientWidth]"
    assert wide.execute_script(across) == [WIDE[0], WIDE[0]]


def test_curves_follow_the_hand_and_a_draft_is_replaced(wide: Chrome) -> None:
    """With real input: curves change while the slider is held, and again when it is let go."""
    names = "return [...document.querySelectorAll('#charts > figure .plot')]"
    names += ".map((one) => one.getAttribute('aria-label'))"
    before = wide.execute_script(names)
    heading = "return getComputedStyle(document.getElementById('moving'), '::after').content"
    one = slider(wide, "law.ratios[1]")
    held = ActionChains(wide).move_to_element(one).click_and_hold().move_by_offset(40, 0)
    held.perform()
    until(lambda: all(a != b for a, b in zip(wide.execute_script(names), before, strict=True)))
    assert wide.execute_script(heading) == '" (draft)"'
    assert all(one["draft"] for one in shown(wide))
    ActionChains(wide).release().perform()
    until(lambda: not shown(wide)[-1]["draft"])
    assert wide.execute_script(heading) == "none"


def test_what_is_saved_is_told_and_what_is_not_is_asked_for(page: Chrome, file: Path) -> None:
    before = file.read_text()
    save, told = page.find_element(By.ID, "save"), page.find_element(By.ID, "saved")
    style = "const s = getComputedStyle(arguments[0]); return [s.borderStyle, s.color]"
    idle = page.execute_script(style, save)
    width = field(page, "pair.face_width_mm")
    width.clear()
    width.send_keys("60", Keys.ENTER)
    until(lambda: told.text == "Not saved.")
    assert page.execute_script(style, save) != idle
    leaving = "const e = new Event('beforeunload', {cancelable: true}); return dispatchEvent(e)"
    assert page.execute_script(leaving) is False
    page.find_element(By.ID, "save").click()
    until(lambda: told.text.startswith("Saved."))
    until(lambda: shown(page) and not shown(page)[-1]["draft"])
    until(lambda: file.read_text() != before)
    time.sleep(1.0)  # the file is followed meanwhile
    assert told.text.startswith("Saved.")
    assert page.execute_script(style, save) == idle
    assert page.execute_script(leaving) is True


def test_equal_numbers_are_shown_once_and_come_back_together(page: Chrome) -> None:
    """The teeth of both wheels: what follows a number is not left behind as a change."""
    save = page.find_element(By.ID, "save")
    (label,) = page.find_elements(By.CSS_SELECTOR, 'label[title="pair.teeth[0]"]')
    assert label.text == "teeth, wheel 1 and wheel 2"
    assert not page.find_elements(By.ID, "key-pair.teeth[1]")
    teeth = field(page, "pair.teeth[0]")
    for count, changed in (("40", True), ("36", False)):
        teeth.clear()
        teeth.send_keys(count, Keys.ENTER)
        until(lambda count=count: f"teeth {count} : {count}" in text_of(page, "verdict"))
        assert save.is_enabled() is changed


def test_a_field_and_the_keyboard_do_the_same(page: Chrome) -> None:
    one = field(page, "pair.face_width_mm")
    one.clear()
    one.send_keys("60", Keys.ENTER)
    until(lambda: shown(page) and not shown(page)[-1]["draft"])
    until(lambda: page.find_element(By.ID, "save").is_enabled())
    count = len(shown(page))
    slider(page, "pair.center_distance_mm").send_keys(Keys.ARROW_RIGHT)
    until(lambda: len(shown(page)) > count)
    assert float(field(page, "pair.center_distance_mm").get_attribute("value")) > 180


def places(page: Chrome) -> list[float]:
    """Where sliders stand, pixels from the top of the page, or of a column that stays in sight."""
    return page.execute_script(
        "const home = document.getElementById('numbers');"
        "const stays = getComputedStyle(home).position === 'sticky';"
        "const off = stays ? home.scrollTop - home.getBoundingClientRect().top : scrollY;"
        "return [...document.querySelectorAll('#numbers input')]"
        ".map((one) => Math.round(one.getBoundingClientRect().top + off))"
    )


def verdict(page: Chrome) -> tuple[str, str]:
    """The verdict that is seen, and its colour."""
    found = page.execute_script(
        "return [...document.querySelectorAll('.verdict')].map((one) => [one.textContent,"
        " getComputedStyle(one)]).filter(([, style]) => style.visibility === 'visible')"
        ".map(([text, style]) => [text.trim().split(/\\s+/).slice(1).join(' '), style.color])"
    )
    ((words, colour),) = found
    return words, colour


RED = "rgb(179, 38, 30)"


@pytest.mark.parametrize("size", [(1600, 1000), (1200, 800), (390, 844)])
def test_a_refused_design_has_a_red_verdict_and_the_sliders_stay(
    page: Chrome, size: tuple[int, int]
) -> None:
    metrics = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False}
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    try:
        bore = field(page, "blank.bore_diameter_mm[0]")
        page.execute_script("arguments[0].scrollIntoView({block: 'center'})", bore)
        good, before = verdict(page), places(page)
        assert good[1] != RED
        bore.clear()
        bore.send_keys("400", Keys.ENTER)
        assert "the bore reaches the root of the teeth" in until(lambda: error(page))
        assert shown(page) == []
        assert verdict(page) == ("Cannot be made", RED)
        assert page.find_element(By.ID, "moving").text == "Last valid design"
        assert places(page) == before
        # the box is within the window, and the field that was used is not below it
        box = page.find_element(By.ID, "error")
        ends = page.execute_script(
            "const r = arguments[0].getBoundingClientRect();"
            "return [r.left, r.top, r.right, r.bottom]",
            box,
        )
        assert min(ends) >= 0.0
        assert (ends[2] <= size[0], ends[3] <= size[1]) == (True, True)
        hit = page.execute_script(
            "const r = arguments[0].getBoundingClientRect(); return document.elementFromPoint("
            "r.left + 0.5 * r.width, r.top + 0.5 * r.height) === arguments[0]",
            bore,
        )
        assert hit
        until(lambda: page.find_elements(By.CSS_SELECTOR, "#error button"))
        assert "blank.bore_diameter_mm = [" in error(page)
        page.find_element(By.CSS_SELECTOR, "#error button").click()
        until(lambda: not error(page))
        assert verdict(page) == good
        assert page.find_element(By.ID, "moving").text == "Parts in motion"
        rim = 2 * 2.7 * 4.923  # on both sides 2.7 modules, the limit
        assert 80.0 - rim < float(bore.get_attribute("value")) < 92.0 - rim
        assert shown(page)[-1]["charts"]
    finally:
        page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_a_design_with_errors_offers_its_remedies_with_buttons(page: Chrome) -> None:
    good, before = verdict(page), places(page)
    teeth = field(page, "pair.teeth[0]")
    teeth.clear()
    teeth.send_keys("18", Keys.ENTER)
    buttons = until(lambda: page.find_elements(By.CSS_SELECTOR, "#remedies li button"))
    assert verdict(page)[1] == RED
    assert places(page) == before
    assert buttons[0].accessible_name == "Use this: pair.teeth = [24, 24]"
    page.execute_script("arguments[0].click()", buttons[0])
    until(lambda: verdict(page)[1] != RED)
    assert teeth.get_attribute("value") == "24"
    assert "teeth 24 : 24" in page.find_element(By.ID, "verdict").text
    assert verdict(page) in {good, ("Ready to cut", "rgb(28, 107, 63)")}
    assert not page.find_elements(By.CSS_SELECTOR, "#remedies li button")


def test_a_file_that_is_saved_refused_is_shown_so_with_its_remedies(
    page: Chrome, file: Path
) -> None:
    good, text = verdict(page), file.read_text()
    file.write_text(text.replace("bore_diameter_mm = [40, 40]", "bore_diameter_mm = [40, 400]"))
    assert file.read_text() != text
    until(lambda: "was built without errors" in error(page))
    assert verdict(page) == ("Cannot be made", RED)
    page.refresh()
    until(lambda: page.execute_script("return !!window.gearcam"))
    assert verdict(page) == ("Cannot be made", RED)
    page.execute_script(SPY)
    file.write_text(text)
    until(lambda: not error(page))
    assert verdict(page) == good


def test_every_slider_has_a_name_and_is_reached_by_the_keyboard(page: Chrome) -> None:
    for one in page.find_elements(By.CSS_SELECTOR, "#numbers input"):
        assert one.accessible_name
        assert one.get_attribute("tabindex") is None
    names = page.execute_script(
        "return [...document.querySelectorAll('[id]')].map((one) => one.id)"
    )
    assert len(names) == len(set(names))


SPACER = """kind = "spacer"
name = "ring"
[ring]
bore_mm = 20
[output]
studies = ["weigh"]
"""


def text_of(page: Chrome, name: str) -> str:
    """The text of a block, folded or not."""
    return page.execute_script("return document.getElementById(arguments[0]).textContent", name)


def test_the_page_of_a_kind_without_moving_parts_follows_file_and_sliders(
    browser: Chrome, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    toys = Path(__file__).parents[1] / "toy_kinds"
    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(toys)])
    file = tmp_path / "ring.toml"
    file.write_text(SPACER)
    with served(file) as (server, view):
        browser.get_log("browser")
        browser.get(server.address)
        until(lambda: browser.execute_script("return !!window.gearcam"))
        assert browser.find_elements(By.CSS_SELECTOR, '#solids, nav a[href="#solids"]') == []
        (figure,) = browser.find_elements(By.CLASS_NAME, "chart")
        assert figure.find_element(By.TAG_NAME, "h3").text == "Mass"
        assert "30 mm" in text_of(browser, "facts")
        file.write_text(SPACER.replace("20", "24"))
        view.refresh()
        until(lambda: "34 mm" in text_of(browser, "facts"))
        bore = field(browser, "ring.bore_mm")
        until(lambda: bore.get_attribute("value") == "24")
        bore.clear()
        bore.send_keys("30", Keys.ENTER)
        until(lambda: "40 mm" in text_of(browser, "facts"))
        browser.execute_script(
            "arguments[0].value = 25; arguments[0].dispatchEvent(new Event('input'))",
            slider(browser, "ring.bore_mm"),
        )
        until(lambda: "35 mm" in text_of(browser, "facts"))
        bore.clear()
        bore.send_keys("400", Keys.ENTER)
        assert "400 is out of range" in until(lambda: error(browser))
        assert verdict(browser) == ("Cannot be made", RED)
        wrong = complaints(browser)
        browser.get("about:blank")  # the page would ask for a server that has ended
    assert wrong == []
