"""A section through the solids, and distances between places on them, with real input."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import ActionChains, Chrome, Keys
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.interaction import POINTER_TOUCH
from selenium.webdriver.common.actions.pointer_input import PointerInput
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

import gearcam
from gearcam.report.file import solids_shown
from gearcam.report.page import document, page
from helpers_browser import LAPTOP, PHONE, complaints, go, open_page, settle, until

INSIDE = "const view = document.querySelector('#solids iframe').contentWindow;"
DRAWN = "return document.querySelector('#solids [data-drawn]')"
WIDTH, DISTANCE = 50.0, 180.0
"""Face width and centre distance of the nail machine, mm."""

SNAP = 14
"""Pixels within which a place snaps to a corner."""


@pytest.fixture(scope="module")
def path(built: Callable[[str], Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("solids") / "nail.html"
    design = built("nail_machine_two_phase").design.with_({"output.chord_tolerance_mm": 0.05})
    result = gearcam.build(design)
    made.write_bytes(page(document(result, seek=False), solids=solids_shown(result)))
    return made


@pytest.fixture
def opened(browser: Chrome, path: Path) -> Iterator[Chrome]:
    open_shown(browser, path, LAPTOP)
    yield browser
    wrong = [one for one in complaints(browser) if "GPU stall" not in one]
    assert wrong == []


def open_shown(browser: Chrome, path: Path, size: tuple[int, int]) -> None:
    open_page(browser, path, size)
    browser.execute_script("document.querySelector('#solids details').open = true")
    until(lambda: browser.execute_script(DRAWN))
    script = "document.querySelector('#solids .view').scrollIntoView({block: 'center'})"
    browser.execute_script(script)
    settle(browser)


def part(browser: Chrome, selector: str) -> Any:
    return browser.find_element(By.CSS_SELECTOR, f"#solids {selector}")


def told(browser: Chrome) -> str:
    return part(browser, ".measure [role=status]").text


def labels(browser: Chrome) -> list[str]:
    return [one.text for one in browser.find_elements(By.CSS_SELECTOR, "#solids .marks b")]


def pixel_of(browser: Chrome, body: str, point: tuple[float, float, float]) -> tuple[int, int]:
    """Where a point of a body is in the view, in pixels from its upper left corner."""
    script = f"""{INSIDE} const [name, point] = arguments;
    const at = view.scene.getObjectByName(name).localToWorld(new view.THREE.Vector3(...point));
    at.project(view.camera);
    return [(1 + at.x) / 2 * view.innerWidth, (1 - at.y) / 2 * view.innerHeight];"""
    x, y = browser.execute_script(script, body, point)
    return round(x), round(y)


def corner_of(browser: Chrome, body: str) -> tuple[float, float, float]:
    """The point of the front face of a body that is lowest in the view."""
    script = f"""{INSIDE} const body = view.scene.getObjectByName(arguments[0]);
    const places = body.geometry.attributes.position, top = body.geometry.boundingBox.max.z;
    let best = null, low = Infinity;
    for (let k = 0; k < places.count; k++) {{
      const own = new view.THREE.Vector3().fromBufferAttribute(places, k);
      if (own.z < top) continue;
      const y = body.localToWorld(own.clone()).project(view.camera).y;
      if (y < low) [best, low] = [own.toArray(), y];
    }}
    return best;"""
    return tuple(browser.execute_script(script, body))


def corners_at(browser: Chrome, body: str, x: int, y: int) -> list[list[float]]:
    """The corners of a body that are as near to a point of the view as places snap."""
    script = f"""{INSIDE} const [name, x, y] = arguments;
    const body = view.scene.getObjectByName(name), places = body.geometry.attributes.position;
    return Array.from({{ length: places.count }}, (_, k) =>
      new view.THREE.Vector3().fromBufferAttribute(places, k)).filter((own) => {{
        const at = body.localToWorld(own.clone()).project(view.camera);
        const right = (1 + at.x) / 2 * view.innerWidth - x;
        return Math.hypot(right, (1 - at.y) / 2 * view.innerHeight - y) < {SNAP};
    }}).map((own) => own.toArray());"""
    return browser.execute_script(script, body, x, y)


def click(browser: Chrome, x: float, y: float) -> None:
    """Click at pixels from the upper left corner of the view."""
    frame = part(browser, "iframe")
    # offsets are from the middle of what is seen of it
    browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", frame)
    size = frame.size
    aside = (round(x - size["width"] / 2), round(y - size["height"] / 2))
    ActionChains(browser).move_to_element_with_offset(frame, *aside).click().perform()


def matrix(browser: Chrome, body: str) -> np.ndarray:
    script = f"{INSIDE} return view.scene.getObjectByName(arguments[0]).matrixWorld.toArray()"
    return np.array(browser.execute_script(script, body)).reshape(4, 4).T


def colour_at(browser: Chrome, x: int, y: int) -> tuple[int, ...]:
    script = f"""{INSIDE}
    view.render();
    const canvas = document.createElement("canvas"), drawn = view.renderer.domElement;
    [canvas.width, canvas.height] = [drawn.width, drawn.height];
    const pen = canvas.getContext("2d");
    pen.drawImage(drawn, 0, 0);
    return [...pen.getImageData(arguments[0], arguments[1], 1, 1).data];"""
    return tuple(browser.execute_script(script, x, y))


def test_distances_snap_to_corners_and_centres_and_stay_with_their_bodies(
    opened: Chrome,
) -> None:
    button = part(opened, ".measure button")
    front1, front2 = (pixel_of(opened, name, (0, 0, WIDTH)) for name in ("gear1", "gear2"))
    click(opened, *front1)  # not measuring yet
    assert labels(opened) == []
    button.click()
    assert button.get_attribute("aria-pressed") == "true"
    click(opened, front1[0] + 5, front1[1] - 4)  # beside it
    assert told(opened) == "First place: a centre. Pick the second."
    click(opened, *front2)
    assert labels(opened) == [f"{DISTANCE:.2f} mm"]
    corner = corner_of(opened, "gear1")
    x, y = pixel_of(opened, "gear1", corner)
    click(opened, x, y)
    assert told(opened) == "First place: a corner. Pick the second."
    click(opened, *front2)
    corners = corners_at(opened, "gear1", x, y)

    def told_of() -> set[int]:
        """The corners whose distance the last label tells."""
        other = matrix(opened, "gear2") @ [0.0, 0.0, WIDTH, 1.0]
        value = float(labels(opened)[-1].removesuffix(" mm"))
        ends = [matrix(opened, "gear1") @ [*one, 1.0] for one in corners]
        away = [float(np.linalg.norm(one - other)) for one in ends]
        return {k for k, one in enumerate(away) if abs(one - value) < 0.006}

    before, place = labels(opened)[1], part(opened, ".marks span:last-child").rect
    chosen = told_of()
    assert chosen
    go(opened, 120.0)
    assert labels(opened)[0] == f"{DISTANCE:.2f} mm"
    assert labels(opened)[1] != before
    assert chosen & told_of()
    assert part(opened, ".marks span:last-child").rect["y"] != pytest.approx(place["y"], abs=5)
    part(opened, ".marks span button").click()
    assert len(labels(opened)) == 1
    assert chosen & told_of()
    click(opened, 3, 3)
    assert told(opened) == "There is no solid at this place."


def test_a_section_looks_solid_and_moves(opened: Chrome) -> None:
    x, y = pixel_of(opened, "gear1", (45.0, 0.0, WIDTH / 2))  # within the metal
    before = colour_at(opened, x, y)
    choice = part(opened, ".cut select")
    assert not part(opened, ".cut input").is_displayed()
    Select(choice).select_by_value("z")
    slider = part(opened, ".cut input")
    assert slider.get_attribute("aria-valuetext") == "z = 25.0 mm"
    flat = colour_at(opened, x, y)
    assert flat != before
    assert flat == colour_at(opened, x + 9, y + 3)  # without light and shade
    slider.send_keys(Keys.ARROW_RIGHT)
    assert slider.get_attribute("aria-valuetext") != "z = 25.0 mm"
    slider.send_keys(Keys.ARROW_LEFT)
    part(opened, ".measure button").click()
    click(opened, x, y)
    assert told(opened) == "First place: a place of the section. Pick the second."
    part(opened, ".measure button").click()
    part(opened, ".cut button").click()  # from behind: the front face is seen again
    assert colour_at(opened, *pixel_of(opened, "gear1", (45.0, 0.0, WIDTH))) != flat
    Select(choice).select_by_value("")
    assert not slider.is_displayed()
    assert colour_at(opened, x, y) == before


@pytest.mark.slow
def test_places_are_picked_with_keys(opened: Chrome) -> None:
    button = part(opened, ".measure button")
    button.send_keys(Keys.ENTER)
    front1, front2 = (pixel_of(opened, name, (0, 0, WIDTH)) for name in ("gear1", "gear2"))
    size = part(opened, "iframe").size
    x, y = size["width"] / 2, size["height"] / 2
    for to in (front1, front2):
        across = Keys.ARROW_LEFT if to[0] < x else Keys.ARROW_RIGHT
        along = Keys.ARROW_UP if to[1] < y else Keys.ARROW_DOWN
        keys = ActionChains(opened)
        steps = round(abs(to[0] - x) / 10), round(abs(to[1] - y) / 10)
        keys.send_keys(*[across] * steps[0], *[along] * steps[1], Keys.ENTER).perform()
        x += 10 * steps[0] * (1 if across == Keys.ARROW_RIGHT else -1)
        y += 10 * steps[1] * (1 if along == Keys.ARROW_DOWN else -1)
    assert labels(opened) == [f"{DISTANCE:.2f} mm"]
    ActionChains(opened).send_keys(Keys.ESCAPE).perform()
    assert button.get_attribute("aria-pressed") == "false"
    assert opened.execute_script("return document.activeElement") == button
    part(opened, ".marks button").send_keys(Keys.ENTER)
    assert labels(opened) == []


@pytest.mark.slow
def test_places_are_picked_by_touch(browser: Chrome, path: Path) -> None:
    open_shown(browser, path, PHONE)
    part(browser, ".measure button").click()
    settle(browser)
    corner = browser.execute_script(
        "const r = document.querySelector('#solids iframe').getBoundingClientRect();"
        "return [r.left, r.top]"
    )
    for name in ("gear1", "gear2"):
        x, y = pixel_of(browser, name, (0, 0, WIDTH))
        touch = ActionBuilder(browser, mouse=PointerInput(POINTER_TOUCH, "finger"))
        finger = touch.pointer_action
        finger.move_to_location(round(corner[0] + x), round(corner[1] + y))
        finger.pointer_down().pointer_up()
        touch.perform()
    assert labels(browser) == [f"{DISTANCE:.2f} mm"]
    wide = "const e = document.scrollingElement; return [e.scrollWidth, e.clientWidth]"
    assert browser.execute_script(wide) == [PHONE[0], PHONE[0]]
