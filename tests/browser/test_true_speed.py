"""Parts move as a study of dynamics says, each turn or travel in the time that it takes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By

import gearcam as gc
from gearcam.numeric.arrays import Array
from gearcam.report.page import document, page
from helpers_browser import complaints, go, open_page
from helpers_pairs import PROFILES

PLAYED = """
const [count] = arguments;
const frame = window.requestAnimationFrame;
const waiting = [];
window.requestAnimationFrame = (call) => waiting.push(call);
document.getElementById("play").click();
const places = [];
for (let k = 0; k <= count; k++) {
    for (const call of waiting.splice(0)) call(50 * k);
    places.push(gearcam.place);
}
document.getElementById("play").click();
window.requestAnimationFrame = frame;
return places;
"""
"""Plays so many frames, each 50 ms after the one before, and returns the places."""

CYCLE = 12.0
"""Time of a turn or travel in the picture where the machine has no speed, s; else about that."""

SHARE = "return Number(document.getElementById('speed').value)"
"""How fast the picture is, as a share of the true speed."""

SHARES = "return [...document.getElementById('speed').options].map((one) => one.value)"

MACHINES: dict[str, tuple[str, dict[str, Any]]] = {
    "a turn": ("nail_machine_flywheel", {"motor.flywheel_kg_m2": 0}),
    "a travel": (
        "log_spiral",
        {
            "dynamics": {"run": "start", "inertia_kg_m2": [0.01, 0.01]},
            "motor": {"type": "linear", "start_torque_nm": 3, "idle_rpm": 60},
            "output.studies": ["dynamics"],
        },
    ),
}


def opened(browser: Chrome, folder: Path, name: str, changes: dict[str, Any]) -> Any:
    """Open the page of a profile with changes, and return its study."""
    result = gc.build(gc.load(PROFILES / f"{name}.toml").with_(changes))
    path = folder / "page.html"
    path.write_bytes(page(document(result)))
    open_page(browser, path)
    return result.studies.get("dynamics")


def played(browser: Chrome, count: int) -> tuple[Array, Array]:
    """Play from the first place on; return the times, s, and places of the frames."""
    go(browser, 0.0)
    return np.linspace(0.0, 0.05 * count, count + 1), np.array(
        browser.execute_script(PLAYED, count)
    )


@pytest.mark.parametrize("name", MACHINES)
def test_parts_play_at_the_speed_of_the_study(name: str, browser: Chrome, tmp_path: Path) -> None:
    study = opened(browser, tmp_path, *MACHINES[name])
    time, angle = study.columns["t_s"], study.columns["phi1_deg"]
    lasts = time[-1] - time[0]
    share = browser.execute_script(SHARE)
    assert 0.6 < lasts / share / CYCLE < 1.6  # the nearest of 1, 1/2, 1/5, 1/10 and so on
    cycle = lasts / share
    seconds, places = played(browser, 450)
    true = np.interp(time[0] + (seconds * share) % lasts, time, angle)
    assert seconds[-1] > cycle  # the first of another turn, or of the travel once more
    inside = np.abs(seconds - cycle) > 1e-9  # its end is also the beginning
    assert places[inside] == pytest.approx(true[inside], abs=1e-3 * angle[-1])
    even = (seconds * angle[-1] / cycle) % angle[-1]
    assert np.abs(even - true)[seconds < cycle].max() > 0.005 * angle[-1]
    told = browser.find_element(By.ID, "factor").text
    factor = re.fullmatch("of true speed: (.*) of (.*) rpm", told)
    assert factor
    rpm = angle[-1] / 360.0 / lasts * 60.0
    assert float(factor[2]) == pytest.approx(rpm, rel=1e-3)
    assert float(factor[1]) == pytest.approx(share * rpm, rel=1e-3)
    shares = [float(one) for one in browser.execute_script(SHARES)]
    slower = shares[shares.index(share) + 1]
    browser.find_element(By.CSS_SELECTOR, f"#speed [value='{slower}']").click()
    assert browser.find_element(By.ID, "factor").text != told
    seconds, places = played(browser, 100)
    true = np.interp(time[0] + seconds * slower, time, angle)
    assert places == pytest.approx(true, abs=1e-3 * angle[-1])
    assert complaints(browser) == []


def test_the_reader_can_have_it_even(browser: Chrome, tmp_path: Path) -> None:
    opened(browser, tmp_path, *MACHINES["a turn"])
    browser.find_element(By.ID, "true").click()
    assert not browser.find_element(By.ID, "factor").text
    seconds, places = played(browser, 60)
    cycle = float(seconds[-1] * 360.0 / places[-1])
    assert 0.6 < cycle / CYCLE < 1.6
    assert places == pytest.approx(360.0 * seconds / cycle, abs=1e-6)


@pytest.mark.parametrize("run", [{"output.studies": []}, {"dynamics.run": "turns"}])
def test_without_a_time_of_the_cycle_there_is_no_choice(
    run: dict[str, Any], browser: Chrome, tmp_path: Path
) -> None:
    """Neither without the study, nor of a run whose turns differ."""
    name, changes = MACHINES["a turn"]
    motor = {"motor": {"type": "constant", "torque_nm": 500}}
    opened(browser, tmp_path, name, {**changes, **run, **motor})
    assert not browser.find_element(By.ID, "pace").is_displayed()
    told = browser.find_element(By.ID, "factor").text
    factor = re.fullmatch("of true speed: (.*) of 180 rpm", told)  # the mean one of its drive
    assert factor
    seconds, places = played(browser, 60)
    assert places == pytest.approx(6.0 * float(factor[1]) * seconds, abs=1e-6)


def test_without_a_speed_a_turn_takes_twelve_seconds(browser: Chrome, tmp_path: Path) -> None:
    opened(browser, tmp_path, "ellipse", {})
    assert not browser.find_element(By.ID, "factor").text
    seconds, places = played(browser, 60)
    assert places == pytest.approx(360.0 * seconds / CYCLE, abs=1e-6)
