"""The solids in a page: drawn when they are asked for, whole, moved with the slider, turned
by keys, and printed."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import ActionChains, Chrome, Keys
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

import gearcam
from gearcam.compare.page import document as document_of_variants
from gearcam.compare.variants import variants_of
from gearcam.report.file import solids_shown
from gearcam.report.page import document, page
from helpers_browser import LAPTOP, PHONE, complaints, go, open_page, requests, settle, until
from helpers_pairs import PROFILES
from helpers_view import served

NAIL = "nail_machine_two_phase"
INSIDE = "const view = document.querySelector('#solids iframe').contentWindow;"
ENDS = """
const ends = [Infinity, -Infinity, Infinity, -Infinity], colours = new Set();
view.scene.traverse((one) => {
  if (!one.isMesh) return;
  colours.add(one.material.color.getHex());
  const places = one.geometry.attributes.position;
  for (let k = 0; k < places.count; k++) {
    const at = new view.THREE.Vector3().fromBufferAttribute(places, k);
    at.applyMatrix4(one.matrixWorld).project(view.camera);
    ends[0] = Math.min(ends[0], at.x); ends[1] = Math.max(ends[1], at.x);
    ends[2] = Math.min(ends[2], at.y); ends[3] = Math.max(ends[3], at.y);
  }
});
"""


@pytest.fixture(scope="module")
def solids_page(built: Callable[[str], Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("solids") / "nail.html"
    result = gearcam.build(built(NAIL).design.with_({"output.chord_tolerance_mm": 0.02}))
    path.write_bytes(page(document(result), solids=solids_shown(result)))
    return path


def show(browser: Chrome) -> None:
    def unfolded() -> bool:
        """Click once more if the page moved beneath the click, as while its charts are drawn."""
        is_open = "return document.querySelector('#solids details').open"
        if not browser.execute_script(is_open):
            browser.find_element(By.CSS_SELECTOR, "#solids summary").click()
        return browser.execute_script(is_open)

    until(unfolded)
    until(lambda: browser.execute_script("return document.querySelector('#solids [data-drawn]')"))


def faults(browser: Chrome) -> list[str]:
    """Complaints, but for those of a driver without a graphics card."""
    return [one for one in complaints(browser) if "GPU stall due to ReadPixels" not in one]


@pytest.mark.parametrize(("size", "scheme"), [(LAPTOP, "light"), (PHONE, "dark")])
def test_solids_are_drawn_whole_when_they_are_asked_for(
    size: tuple[int, int], scheme: str, browser: Chrome, solids_page: Path
) -> None:
    open_page(browser, solids_page, size, prefers_color_scheme=scheme)
    assert browser.find_elements(By.TAG_NAME, "iframe") == []
    show(browser)
    script = f"""{INSIDE} {ENDS}
    return [ends, [...colours], view.scene.background.getHex(), view.innerWidth];
    """
    (left, right, low, high), colours, ground, width = browser.execute_script(script)
    assert -1.0 < left < 0.0 < right < 1.0
    assert -1.0 < low < 0.0 < high < 1.0
    assert max(right - left, high - low) > 0.9  # of 2: not small either
    assert len(colours) == 2
    assert ground == (0xFFFFFF if scheme == "light" else 0x1A2027)
    assert width < size[0]  # beside the view the page scrolls
    assert faults(browser) == []
    assert [one for one in requests(browser) if one.startswith(("http", "ws"))] == []


CAM = "cylinder_cam"
PLACED = """
const matrices = {};
document.querySelector('#solids iframe').contentWindow.scene.traverse((one) => {
  if (one.isMesh) matrices[one.name] = one.matrixWorld.toArray();
});
return matrices;
"""


def placed(browser: Chrome) -> dict[str, np.ndarray]:
    """The matrices of the solids where they are drawn."""
    return {
        name: np.array(one).reshape(4, 4).T for name, one in browser.execute_script(PLACED).items()
    }


@pytest.fixture(scope="module")
def cam_page(built: Callable[[str], Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("solids") / "cam.html"
    result = gearcam.build(built(CAM).design.with_({"output.wall_step_deg": 3}))
    path.write_bytes(page(document(result), solids=solids_shown(result)))
    return path


def lifted(lift: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[2, 3] = lift
    return matrix


def turned(degrees: float, x: float = 0.0) -> np.ndarray:
    matrix, angle = np.eye(4), math.radians(degrees)
    matrix[0, :2] = math.cos(angle), -math.sin(angle)
    matrix[1, :2] = math.sin(angle), math.cos(angle)
    matrix[0, 3] = x
    return matrix


@pytest.mark.parametrize("size", [LAPTOP, pytest.param(PHONE, marks=pytest.mark.slow)])
def test_cam_and_roller_follow_the_slider(
    size: tuple[int, int], browser: Chrome, cam_page: Path, built: Callable[[str], Any]
) -> None:
    open_page(browser, cam_page, size)
    go(browser, 120.0)  # before they are shown
    show(browser)
    slider = browser.find_element(By.ID, "place")
    for place in (120.0, 75.0, 200.0, 359.5):
        script = "arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))"
        browser.execute_script(script, slider, round(2 * place))
        settle(browser)
        lift = built(CAM).motion(np.radians([place]))["lift_mm"][0]
        found = placed(browser)
        assert found["cam"] == pytest.approx(turned(place), abs=1e-6)
        assert found["roller"] == pytest.approx(lifted(25.0 + lift), abs=1e-4)
    slider.send_keys(Keys.ARROW_LEFT)
    settle(browser)
    assert placed(browser)["cam"] == pytest.approx(turned(359.0), abs=1e-6)


def test_wheels_follow_the_slider_by_the_poses_of_their_pictures(
    browser: Chrome, solids_page: Path, built: Callable[[str], Any]
) -> None:
    open_page(browser, solids_page)
    show(browser)
    for place in (0.0, 41.5, 300.0):
        go(browser, place)
        phi2 = built(NAIL).motion(np.radians([place]))["phi2_deg"][0]
        found = placed(browser)
        assert found["gear1"] == pytest.approx(turned(-place), abs=1e-6)
        assert found["gear2"] == pytest.approx(turned(phi2, 180.0), abs=1e-6)


def test_parts_in_space_open_with_the_solids_above_the_picture_and_play(
    browser: Chrome, cam_page: Path
) -> None:
    open_page(browser, cam_page)
    until(lambda: browser.execute_script("return document.querySelector('#solids [data-drawn]')"))
    names = [one.text for one in browser.find_elements(By.CSS_SELECTOR, "nav a")]
    assert "Solids" not in names
    solid, strip = (
        browser.find_element(By.CSS_SELECTOR, one).rect for one in ("#solids iframe", "#parts")
    )
    assert solid["y"] + solid["height"] <= strip["y"]
    assert strip["y"] + strip["height"] <= LAPTOP[1]
    assert solid["height"] > 1.5 * strip["height"]
    assert solid["width"] == pytest.approx(strip["width"], abs=2)
    browser.find_element(By.ID, "play").click()
    turns = browser.execute_async_script(f"""
        const done = arguments[0], turns = [];
        {INSIDE} const cam = view.scene.getObjectByName("cam");
        const look = () => {{
          turns.push(cam.rotation.z);
          if (turns.length < 6) requestAnimationFrame(look); else done(turns);
        }};
        requestAnimationFrame(look);
    """)
    browser.find_element(By.ID, "play").click()
    assert turns == sorted({*turns})  # anew in each frame
    assert faults(browser) == []


@pytest.mark.slow
def test_solids_that_were_folded_are_moved_when_they_are_unfolded(
    browser: Chrome, cam_page: Path
) -> None:
    open_page(browser, cam_page)
    show(browser)
    home = browser.find_element(By.CSS_SELECTOR, "#solids summary")
    home.click()
    go(browser, 90.0)
    assert placed(browser)["cam"] == pytest.approx(turned(0.0), abs=1e-6)  # nothing is drawn
    home.click()
    settle(browser)
    assert placed(browser)["cam"] == pytest.approx(turned(90.0), abs=1e-6)


@pytest.mark.slow
def test_solids_stay_in_sight_at_all_places(browser: Chrome, solids_page: Path) -> None:
    """The wheels are not round: one that is in sight may leave it as it turns."""
    open_page(browser, solids_page, PHONE)
    show(browser)
    for place in range(0, 360, 45):
        go(browser, place)
        left, right, low, high = browser.execute_script(f"{INSIDE} {ENDS} return ends;")
        assert -1.0 < left < right < 1.0
        assert -1.0 < low < high < 1.0


@pytest.mark.slow
def test_keys_turn_and_zoom(browser: Chrome, solids_page: Path) -> None:
    open_page(browser, solids_page)
    show(browser)
    browser.find_element(By.CSS_SELECTOR, "#solids iframe").click()
    seen = f"{INSIDE} const p = view.camera.position.clone().sub(view.controls.target);"
    places = []
    for key in (Keys.ARROW_LEFT, Keys.ARROW_RIGHT, Keys.ARROW_UP, Keys.ARROW_DOWN, "+", "-"):
        before = browser.execute_script(f"{seen} return [p.x, p.y, p.z, p.length()]")
        ActionChains(browser).send_keys(key).perform()
        places.append(
            (before, browser.execute_script(f"{seen} return [p.x, p.y, p.z, p.length()]"))
        )
    for before, after in places[:4]:
        assert after[3] == pytest.approx(before[3])
        assert after[:3] != pytest.approx(before[:3], rel=1e-2)
    assert places[1][1] == pytest.approx(places[0][0])  # back again
    assert places[3][1] == pytest.approx(places[2][0])
    assert places[4][1][3] < places[4][0][3] < places[5][1][3] * 1.001
    assert places[0][1][0] > places[0][0][0]  # as if dragged to the left


@pytest.mark.slow
def test_paper_has_a_picture_of_what_is_seen(browser: Chrome, solids_page: Path) -> None:
    open_page(browser, solids_page)
    browser.execute_script("dispatchEvent(new Event('beforeprint'))")
    assert browser.find_elements(By.CSS_SELECTOR, "#solids img") == []
    show(browser)
    for _ in range(2):
        browser.execute_script("dispatchEvent(new Event('beforeprint'))")
    (picture,) = browser.find_elements(By.CSS_SELECTOR, "#solids img")
    assert not picture.is_displayed()
    # more than one colour: it was taken while it was drawn
    script = """
    const done = arguments[0], shown = document.querySelector('#solids img');
    shown.decode().then(() => {
      const canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [shown.naturalWidth, shown.naturalHeight];
      const pen = canvas.getContext('2d');
      pen.drawImage(shown, 0, 0);
      const pixels = pen.getImageData(0, 0, canvas.width, canvas.height).data;
      done(new Set(new Uint32Array(pixels.buffer)).size);
    });
    """
    assert browser.execute_async_script(script) > 10


def test_where_nothing_draws_them_words_say_so(browser: Chrome, solids_page: Path) -> None:
    open_page(browser, solids_page)
    browser.execute_script("HTMLCanvasElement.prototype.getContext = () => null")
    browser.find_element(By.CSS_SELECTOR, "#solids summary").click()
    settle(browser)
    assert "no WebGL" in browser.find_element(By.ID, "solids").text
    assert browser.find_elements(By.TAG_NAME, "iframe") == []


def test_a_page_of_variants_is_drawn_and_moves(browser: Chrome, tmp_path: Path) -> None:
    variants = variants_of([str(PROFILES / "ellipse.toml")], {"law.eccentricity": [0.1, 0.3]})
    path = tmp_path / "compare.html"
    path.write_bytes(page(document_of_variants(variants, "ellipse, variants")))
    shown = open_page(browser, path, PHONE)
    browser.execute_script("gearcam.go(90)")
    settle(browser)
    turns = [one["turn"] for one in browser.execute_script("return gearcam.poses()")]
    wanted = [body["turn"] for body in shown["scene"]["bodies"]]
    assert turns == [one if isinstance(one, (int, float)) else one[180] for one in wanted]
    assert "--line-2" in path.read_text("utf-8")
    assert [one.text for one in browser.find_elements(By.CSS_SELECTOR, ".variants b")] == [
        "eccentricity=0.1", "eccentricity=0.3",
    ]  # fmt: skip
    assert not browser.find_element(By.ID, "accuracy").is_displayed()
    wide = "const e = document.scrollingElement; return [e.scrollWidth, e.clientWidth]"
    assert browser.execute_script(wide) == [PHONE[0], PHONE[0]]
    assert complaints(browser) == []


@pytest.mark.slow
def test_the_live_view_shows_the_solids_of_the_numbers_in_the_page(
    browser: Chrome, tmp_path: Path
) -> None:
    file = tmp_path / "cam.toml"
    text = (PROFILES / f"{CAM}.toml").read_text("utf-8")
    file.write_text(text.partition("[output]")[0] + "[output]\nwall_step_deg = 3\n")
    with served(file) as (server, view):
        browser.get_log("browser")
        browser.get(server.address)
        until(lambda: browser.execute_script("return !!window.gearcam?.solids"))
        until(lambda: browser.find_elements(By.ID, "save"))
        show(browser)
        go(browser, 170.0)
        assert placed(browser)["cam"] == pytest.approx(turned(170.0), abs=1e-6)
        assert placed(browser)["roller"] == pytest.approx(lifted(85.0), abs=1e-4)
        camera = f"{INSIDE} view.camera.position.x += 50; return view.camera.position.toArray()"
        seen = browser.execute_script(camera)
        browser.execute_script(f"{INSIDE} view.old = true")
        Select(browser.find_element(By.CSS_SELECTOR, ".cut select")).select_by_value("y")
        length = browser.find_element(By.CSS_SELECTOR, 'input[aria-label="cam.length_mm, number"]')
        length.clear()
        length.send_keys("120", Keys.ENTER)
        tall = f"""
            if (!document.querySelector('#solids [data-drawn]')) return 0;
            {INSIDE} if (view.old) return 0;
            return view.scene.getObjectByName('cam').geometry.boundingBox.max.z"""
        assert until(lambda: browser.execute_script(tall)) == 120.0
        assert placed(browser)["cam"] == pytest.approx(turned(170.0), abs=1e-6)
        # seen from where it was
        again = browser.execute_script(f"{INSIDE} return view.camera.position.toArray()")
        assert again == pytest.approx(seen)
        # and cut as it was
        cut = f"{INSIDE} return view.renderer.clippingPlanes.map((one) => one.normal.toArray())"
        assert browser.execute_script(cut) == [[0, 1, 0]]
        browser.find_element(By.CSS_SELECTOR, "#solids summary").click()
        file.write_text(
            file.read_text().replace("outer_diameter_mm = 200", "outer_diameter_mm = 210")
        )
        view.refresh()
        until(lambda: "210 mm" in browser.find_element(By.ID, "verdict").text)
        browser.find_element(By.CSS_SELECTOR, "#solids summary").click()
        radius = f"""
            if (!document.querySelector('#solids [data-drawn]')) return 0;
            {INSIDE} const cam = view.scene.getObjectByName('cam');
            cam.geometry.computeBoundingBox(); return cam.geometry.boundingBox.max.y"""
        until(lambda: 104.8 < browser.execute_script(radius) <= 105.0)
        wrong = faults(browser)
        browser.get("about:blank")  # the page would ask for a server that has ended
    assert wrong == []
