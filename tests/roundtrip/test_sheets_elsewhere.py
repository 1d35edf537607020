"""Workshop drawings in other programs: the same texts, decimals, prefixes and heights."""

from __future__ import annotations

import shutil
from dataclasses import replace

import pytest

import read_sheets
from gearcam.sheets.sheet import Sheet
from helpers_built import built
from helpers_pairs import PROFILES

pytestmark = pytest.mark.slow

HEIGHTS = {"browser": 0.03, "librecad": 0.02}
"""Largest relative error of a height: capitals of fonts differ; PDF rounds coordinates."""


def need(*programs: str) -> None:
    for one in programs:
        if shutil.which(one) is None:
            pytest.skip(f"{one} is not there")


@pytest.fixture(scope="module")
def sheets() -> dict[str, Sheet]:
    names = ("circular", "shop_order", "cylinder_cam", "groove_cam")
    found = [(name, one) for name in names for one in built(PROFILES / f"{name}.toml").sheets]
    return {f"{name} {one.name}": one for name, one in found}


def test_librecad_draws_every_text_in_its_height(sheets: dict[str, Sheet]) -> None:
    need("librecad", "xvfb-run")
    report = read_sheets.in_librecad(sheets)
    assert report.differing == []
    assert report.texts > 300
    assert report.height_off < HEIGHTS["librecad"]


def test_freecad_reads_every_text_and_measures_the_same(sheets: dict[str, Sheet]) -> None:
    need("freecadcmd")
    report = read_sheets.in_freecad(sheets)
    assert report.differing == []
    assert report.texts > 300


def test_a_browser_shows_every_text_in_its_height(sheets: dict[str, Sheet]) -> None:
    need("chromium", "chromedriver")
    driver = read_sheets.browser()
    try:
        report = read_sheets.in_browser(sheets, driver)
    finally:
        driver.quit()
    assert report.differing == []
    assert report.height_off < HEIGHTS["browser"]


def test_another_decimal_is_noticed(sheets: dict[str, Sheet]) -> None:
    """The control: what is drawn has one text that the sheet has otherwise."""
    need("librecad", "xvfb-run")
    sheet = sheets["circular gear1"]
    one, *rest = sheet.texts
    other = replace(sheet, texts=(replace(one, text=f"{one.text}.5"), *rest))
    report = read_sheets.in_librecad({"sheet": other}, drawn={"sheet": sheet})
    assert report.differing == [f"sheet: {one.text + '.5'!r}"]
