"""A browser for the tests of pages: Debian's chromium, without a network and without a window."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

import helpers_built
from gearcam.report.page import document, page
from gearcam.results.result import Result
from helpers_pairs import PROFILES

FLAGS = (
    "--headless=new",
    "--no-sandbox",  # which root may not have
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
    "--window-size=1280,900",
    "--disable-background-networking",
    "--no-first-run",
    "--enable-unsafe-swiftshader",  # three dimensions without a graphics card
)


@pytest.fixture(scope="session")
def browser() -> Iterator[Chrome]:
    """Chromium; where there is none a test is skipped, or fails where CI is set."""
    program, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if program is None or driver is None:
        tell = pytest.fail if os.environ.get("CI") else pytest.skip
        tell("no chromium with its driver here: tools/browser installs them")
    options = Options()
    options.binary_location = program
    for flag in FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    made = Chrome(service=Service(driver), options=options)
    made.set_script_timeout(20)
    yield made
    made.quit()


@pytest.fixture(scope="session")
def built() -> Callable[[str], Result]:
    """What builds a profile by its name, once."""
    return lambda name: helpers_built.built(PROFILES / f"{name}.toml")


@pytest.fixture(scope="session")
def page_of(
    built: Callable[[str], Result], tmp_path_factory: pytest.TempPathFactory
) -> Callable[[str], Path]:
    """What writes the page of a profile by its name, once."""
    folder = tmp_path_factory.mktemp("pages")

    @cache
    def write(name: str) -> Path:
        path = folder / f"{name}.html"
        path.write_bytes(page(document(built(name))))
        return path

    return write
