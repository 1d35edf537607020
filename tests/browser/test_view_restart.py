"""A tab that was left open while the live view ended and was started again."""

from __future__ import annotations

from pathlib import Path

import pytest
from selenium.webdriver import Chrome, Keys
from selenium.webdriver.common.by import By

from helpers_browser import until
from helpers_view import DESIGN, free_port, served


@pytest.fixture(autouse=True)
def _state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA"):
        monkeypatch.setenv(name, str(tmp_path / "state"))


def notice(browser: Chrome) -> str:
    return browser.find_element(By.ID, "notice").text


def begun(browser: Chrome) -> None:
    until(lambda: browser.execute_script("return !!window.gearcam?.solids"))
    until(lambda: browser.find_elements(By.ID, "save"))


def field_of(browser: Chrome, key: str) -> str:
    (found,) = browser.find_elements(By.CSS_SELECTOR, f'input[aria-label="{key}, number"]')
    return found.get_attribute("value") or ""


def test_a_tab_says_that_the_view_ended_and_was_started_again_and_keeps_its_numbers(
    browser: Chrome, tmp_path: Path
) -> None:
    file, port = tmp_path / "wheels.toml", free_port()
    file.write_text(DESIGN)
    with served(file, port) as (server, _):
        browser.get(server.address)
        begun(browser)
        assert notice(browser) == ""
        (width,) = browser.find_elements(
            By.CSS_SELECTOR, 'input[aria-label="pair.face_width_mm, number"]'
        )
        width.clear()
        width.send_keys("7", Keys.ENTER)
        until(lambda: browser.find_element(By.ID, "saved").text == "Not saved.")
    until(lambda: "The live view has ended" in notice(browser))
    assert not browser.find_element(By.ID, "save").is_enabled()
    with served(file, port):
        until(lambda: notice(browser) == "The live view was started again. Reload")
        browser.execute_script("window.old = true")
        (button,) = browser.find_elements(By.CSS_SELECTOR, "#notice button")
        button.click()  # no question about the numbers: they are kept
        until(lambda: browser.execute_script("return !window.old && !!window.gearcam?.solids"))
        begun(browser)
        assert notice(browser) == ""
        assert field_of(browser, "pair.face_width_mm") == "7"
        assert browser.find_element(By.ID, "saved").text == "Not saved."
        facts = "return document.getElementById('facts').textContent"
        until(lambda: "x 7 mm" in browser.execute_script(facts))
        browser.find_element(By.ID, "save").click()
        until(lambda: "face_width_mm = 7" in file.read_text())
        browser.get("about:blank")  # the page would ask for a server that has ended


def test_a_tab_without_a_page_yet_goes_on_by_itself(browser: Chrome, tmp_path: Path) -> None:
    file, port = tmp_path / "wheels.toml", free_port()
    file.write_text(DESIGN.replace("module_mm = 2.0", "module_mm = -2.0"))
    with served(file, port) as (server, _):
        browser.get(server.address)
        until(lambda: "cannot be shown" in browser.find_element(By.ID, "state").text)
    until(lambda: "The live view has ended" in browser.find_element(By.ID, "state").text)
    file.write_text(DESIGN)
    with served(file, port):
        begun(browser)
        browser.get("about:blank")
