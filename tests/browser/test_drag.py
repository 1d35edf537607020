"""Dragging in the live view: joints and knots go with the pointer, and numbers with them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement

from helpers_browser import complaints, settle, until
from helpers_pairs import PROFILES
from helpers_view import served

PROFILE = {"linkage": "four_bar", "arm": "plate_cam_oscillating", "pair": "nail_machine_two_phase"}

SPOT = """
const { parts, poses, placed, page } = gearcam;
const [body, name] = arguments;
const { x, y } = placed(poses()[body], page.scene.bodies[body].handles[name]);
const { x: left, y: top, scale } = parts.view;
return [(x - left) * scale, (top - y) * scale, x, y];
"""
"""Where a handle is: pixels from the middle of the picture, and mm."""

SQUARE = """
const { plot, movable } = gearcam.charts.views[0];
const { x, y } = movable[arguments[0]];
const { clientWidth, clientHeight } = plot.over;
return [plot.valToPos(x, "x") - 0.5 * clientWidth, plot.valToPos(y, "y") - 0.5 * clientHeight];
"""
"""Where a handle of the first chart is: pixels from its middle."""


@pytest.fixture
def page(request: pytest.FixtureRequest, browser: Chrome, tmp_path: Path) -> Iterator[Chrome]:
    file = tmp_path / "design.toml"
    file.write_text((PROFILES / f"{PROFILE[request.param]}.toml").read_text())
    metrics = {"width": 1500, "height": 950, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    with served(file) as (server, _):
        browser.get_log("browser")
        browser.get(server.address)
        until(lambda: browser.execute_script("return Boolean(window.gearcam?.page.numbers)"))
        until(lambda: browser.find_elements(By.CLASS_NAME, "u-over"))
        yield browser
        wrong = [one for one in complaints(browser) if "Canvas2D" not in one]
        assert wrong == []
        browser.get("about:blank")


def values(page: Chrome) -> dict[str, float]:
    fields = page.find_elements(By.CSS_SELECTOR, "#numbers input[type=number]")
    return {
        str(one.get_attribute("aria-label")).removesuffix(", number"): float(
            str(one.get_attribute("value"))
        )
        for one in fields
    }


def spot(page: Chrome, body: int, name: str) -> list[float]:
    return page.execute_script(SPOT, body, name)


def drag(page: Chrome, home: WebElement, start: list[float], way: tuple[int, int]) -> None:
    """Drag from a place, pixels from the middle of what it is in, by some pixels."""
    hand = ActionChains(page, duration=30)
    hand.move_to_element_with_offset(home, round(start[0]), round(start[1])).click_and_hold()
    for _ in range(5):
        hand.move_by_offset(way[0] // 5, way[1] // 5)
    hand.perform()


def taken(page: Chrome, body: int, name: str) -> tuple[WebElement, list[float]]:
    """The picture, and where a handle is once it can be dragged."""
    home = page.find_element(By.ID, "parts")
    at = spot(page, body, name)

    def near() -> bool:
        for aside in (2, 0):
            hand = ActionChains(page, duration=10)
            hand.move_to_element_with_offset(home, round(at[0]) + aside, round(at[1])).perform()
        return str(home.get_attribute("title")).startswith("Drag")

    until(near)
    return home, at


def at_pointer(page: Chrome, body: int, name: str, wanted: list[float]) -> bool:
    return math.dist(spot(page, body, name)[:2], wanted) < 1.0


@pytest.mark.parametrize("page", ["linkage"], indirect=True)
def test_a_joint_follows_the_pointer_and_curves_move(page: Chrome) -> None:
    page.execute_script("gearcam.go(40)")
    home, at = taken(page, 2, "C")
    before, label = (
        values(page),
        "return document.querySelector('.plot').getAttribute('aria-label')",
    )
    chart = page.execute_script(label)
    drag(page, home, at, (40, -30))
    until(lambda: at_pointer(page, 2, "C", [at[0] + 40.0, at[1] - 30.0]))
    assert page.execute_script("return document.body.classList.contains('draft')")
    assert page.execute_script(label) != chart
    after = values(page)
    # the numbers that move few other joints: the lengths of both links
    changed = {key for key, one in after.items() if one != before[key]}
    assert changed == {"dyad[0].lengths_mm[0]", "dyad[0].lengths_mm[1]"}
    ActionChains(page).release().perform()
    until(lambda: not page.execute_script("return document.body.classList.contains('draft')"))
    # where the pointer left it: C is as far from B and D as the numbers say
    b, c, d = (
        complex(*spot(page, body, name)[2:]) for body, name in ((1, "B"), (2, "C"), (0, "D"))
    )
    assert abs(c - b) == pytest.approx(values(page)["dyad[0].lengths_mm[0]"], abs=1e-3)
    assert abs(c - d) == pytest.approx(values(page)["dyad[0].lengths_mm[1]"], abs=1e-3)


@pytest.mark.parametrize("page", ["linkage"], indirect=True)
def test_a_locked_number_stays_and_others_move(page: Chrome) -> None:
    page.execute_script("gearcam.go(40)")
    locked = "point[0].at_mm[0]"
    lock = page.find_element(By.CSS_SELECTOR, f'[aria-label="lock {locked}"]')
    page.execute_script("arguments[0].scrollIntoView({ block: 'center' })", lock)
    lock.click()
    before = values(page)
    home, at = taken(page, 2, "P")
    drag(page, home, at, (20, -15))
    until(lambda: at_pointer(page, 2, "P", [at[0] + 20.0, at[1] - 15.0]))
    after = values(page)
    assert after[locked] == before[locked]
    assert after["point[0].at_mm[1]"] != before["point[0].at_mm[1]"]
    ActionChains(page).release().perform()


@pytest.mark.parametrize("page", ["arm"], indirect=True)
def test_the_end_of_a_rise_is_dragged_on_the_lift(page: Chrome) -> None:
    over = page.find_element(By.CSS_SELECTOR, "#charts .u-over")
    wide = over.rect["width"]
    at = page.execute_script(SQUARE, 0)
    drag(page, over, at, (15, -10))
    until(lambda: values(page)["motion[0].lift_deg"] > 21.0)
    lift = values(page)["motion[0].lift_deg"]
    ActionChains(page).release().perform()
    until(lambda: not page.execute_script("return document.body.classList.contains('draft')"))
    told = page.find_element(By.ID, "saved").text
    longer = 15 * 360.0 / wide
    assert f"motion[0].angle_deg = {120.0 + longer:.2f}"[:-1] in told
    assert f"motion[1].angle_deg = {60.0 - longer:.2f}"[:-1] in told
    settle(page)
    drawn = page.execute_script("return gearcam.page.shown.charts[0].handles[0]")
    assert (drawn["x"], drawn["y"]) == pytest.approx((120.0 + longer, lift), abs=0.02)


@pytest.mark.parametrize("page", ["pair"], indirect=True)
def test_a_knot_is_dragged_against_a_ghost(page: Chrome) -> None:
    page.find_element(By.ID, "ghost").click()
    over = page.find_element(By.CSS_SELECTOR, "#charts .u-over")
    ink = "const { data } = gearcam.charts.views[0].plot.ctx.getImageData(0, 0, 2000, 600);"
    ink += " return data.reduce((sum, one, k) => sum + (k % 4 === 3 && one > 40), 0)"
    drag(page, over, page.execute_script(SQUARE, 1), (20, -10))
    until(lambda: values(page)["law.knots_deg[1]"] > 165.0)
    ActionChains(page).release().perform()
    until(lambda: not page.execute_script("return document.body.classList.contains('draft')"))
    # it is where it was dropped, and the other ratios give the mean of a turn
    dropped = page.execute_script("return gearcam.page.shown.charts[0].handles[1]")
    assert dropped["x"] == pytest.approx(160.0 + 20 * 360.0 / over.rect["width"], abs=0.1)
    assert dropped["y"] == values(page)["law.ratios[1]"] > 0.4
    assert values(page)["law.ratios[0]"] == pytest.approx(2.0 - dropped["y"], abs=1e-6)
    settle(page)
    haunted = page.execute_script(ink)
    page.find_element(By.ID, "ghost").click()
    settle(page)
    assert page.execute_script(ink) < haunted
