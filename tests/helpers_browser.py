"""How tests use a page in a browser as a person would."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from selenium.webdriver import Chrome

LAPTOP, PHONE = (1280, 900), (390, 844)
PATIENCE = 10.0
"""Time for what a page does by itself, s: machines that run tests are busy."""


def open_page(
    browser: Chrome, path: Path, size: tuple[int, int] = LAPTOP, **media: str
) -> dict[str, Any]:
    """Open a page in a window of a `size`, pixels, and return the document that it shows.

    `media` are features such as ``prefers_color_scheme="dark"``.
    """
    browser.get("about:blank")  # what was open before is not to complain of its new size
    width, height = size
    metrics = {
        "width": width,
        "height": height,
        "deviceScaleFactor": 1,
        "mobile": size == PHONE,
    }
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    features = [{"name": key.replace("_", "-"), "value": value} for key, value in media.items()]
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": features})
    browser.get_log("browser")
    browser.get_log("performance")
    browser.get(path.as_uri())
    settle(browser)
    shown = browser.execute_script("return document.getElementById('document').textContent")
    return json.loads(shown)


def until(done: Callable[[], Any]) -> Any:
    """Wait for what is to become true, and return it."""
    end = time.monotonic() + PATIENCE
    while not (found := done()):
        assert time.monotonic() < end, "the page does not come to it"
        time.sleep(0.02)
    return found


def unfold(browser: Chrome) -> None:
    """Open all that is folded."""
    browser.execute_script("document.querySelectorAll('details').forEach((one) => one.open = true)")
    settle(browser)


def settle(browser: Chrome) -> None:
    """Wait until what was asked for is drawn."""
    browser.execute_async_script(
        "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done))"
    )


def go(browser: Chrome, place: float) -> None:
    """Move the parts to a place of the driver."""
    browser.execute_script("gearcam.go(arguments[0])", place)
    settle(browser)


def complaints(browser: Chrome) -> list[str]:
    """What the console has told since the page was opened."""
    return [entry["message"] for entry in browser.get_log("browser")]


def requests(browser: Chrome) -> list[str]:
    """Addresses that were asked for since the page was opened."""
    messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    return [
        one["params"]["request"]["url"]
        for one in messages
        if one["method"] == "Network.requestWillBeSent"
    ]


def saved(browser: Chrome, folder: Path, button: str, name: str) -> Path:
    """Click on what a selector finds, and return the file that it saves."""
    behaviour = {"behavior": "allow", "downloadPath": str(folder)}
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", behaviour)
    browser.execute_script("document.querySelector(arguments[0]).click()", button)
    path = folder / name
    until(lambda: path.exists() and path.stat().st_size)
    return path
