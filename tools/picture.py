"""Take the README's picture of the nail machine's page: `python tools/picture.py`.

It needs chromium with its driver (tools/browser installs them).
"""

from __future__ import annotations

import base64
import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from selenium.webdriver import Chrome
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

import gearcam

ROOT = Path(__file__).resolve().parents[1]
PROFILE = ROOT / "profiles" / "nail_machine_two_phase.toml"
PICTURE = ROOT / "docs" / "nail_machine_two_phase.png"
SIZE = (1280, 900)
"""Width and height, pixels."""
PLACE = 118.0
"""Driver angle in the picture, deg."""


def taken(page: Path) -> bytes:
    """Return a screenshot of the parts and first charts of a page, PNG."""
    options = Options()
    options.binary_location = shutil.which("chromium") or sys.exit("there is no chromium")
    for flag in ("--headless=new", "--no-sandbox", "--hide-scrollbars"):
        options.add_argument(flag)
    browser = Chrome(options=options, service=Service(shutil.which("chromedriver")))
    try:
        width, height = SIZE
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        browser.get(page.as_uri())
        browser.execute_script("gearcam.go(arguments[0]); location.hash = 'charts'", PLACE)
        browser.execute_async_script(  # charts are drawn a few at a time
            "const done = arguments[0]; setTimeout(() => requestAnimationFrame(done), 1000)"
        )
        shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"format": "png"})
        return base64.b64decode(shot["data"])
    finally:
        browser.quit()


if __name__ == "__main__":
    result = gearcam.build(gearcam.load(PROFILE))
    with TemporaryDirectory() as folder:
        written = result.write(folder)
        PICTURE.write_bytes(taken(written.directory / "report.html"))
