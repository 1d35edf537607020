"""What a page saves: the drawing in mm as it stands, the picture as it is seen, all of a chart."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By

from helpers_browser import go, open_page, saved, unfold

NAIL = "nail_machine_two_phase"
SVG = "{http://www.w3.org/2000/svg}"
ROUNDED = 2e-4
"""Lengths are written in steps of 1e-4 mm, points and placements apart."""

BuildOutput = Callable[[str], Path]
Built = Callable[[str], Any]


def points_of(path: ET.Element) -> Any:
    """Points of a path where its placement puts them, y upwards, mm."""
    numbers = [float(one) for one in re.findall(r"-?[\d.]+(?:e-?\d+)?", path.attrib["d"])]
    flat = np.array(numbers).reshape(-1, 2) @ [1.0, 1j]
    place = re.fullmatch(r"translate\((\S+) (\S+)\) rotate\((\S+)\)", path.attrib["transform"])
    assert place is not None
    x, y, turn = map(float, place.groups())
    return flat * np.exp(1j * math.radians(turn)) + complex(x, y)


def box(points: Any) -> list[float]:
    return [points.real.min(), points.imag.min(), points.real.max(), points.imag.max()]


def test_a_saved_drawing_has_the_outlines_where_they_stand(
    browser: Chrome, page_of: BuildOutput, built: Built, tmp_path: Path
) -> None:
    document = open_page(browser, page_of(NAIL), prefers_color_scheme="dark")
    go(browser, 77.0)
    root = ET.parse(saved(browser, tmp_path, "#svg", f"{NAIL}.svg")).getroot()
    (group,) = root.findall(f"{SVG}g")
    assert group.attrib["transform"] == "scale(1 -1)"
    phi2 = built(NAIL).motion(np.radians([77.0]))["phi2_deg"][0]
    stands = zip(
        built(NAIL).gears, (-77.0, phi2), (0.0, 180.0), ("#cfe0f2", "#f8e0c6"), strict=True
    )
    for gear, turn, x, fill in stands:
        (drawn,) = (one for one in group if one.attrib["fill"] == fill)  # colours of paper
        outline = (gear.outline @ [1.0, 1j]) * np.exp(1j * math.radians(turn)) + x
        assert box(points_of(drawn)) == pytest.approx(box(outline), abs=ROUNDED)
    left, bottom, right, top = document["scene"]["box"]
    x, y, wide, tall = map(float, root.attrib["viewBox"].split())
    assert (x < left, y < -top, x + wide > right, y + tall > -bottom) == (True,) * 4
    assert (root.attrib["width"], root.attrib["height"]) == (f"{wide}mm", f"{tall}mm")


def test_a_saved_picture_is_what_is_seen(
    browser: Chrome, page_of: BuildOutput, tmp_path: Path
) -> None:
    open_page(browser, page_of(NAIL))
    data = saved(browser, tmp_path, "#png", f"{NAIL}.png").read_bytes()
    canvas = browser.find_element(By.ID, "parts")
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    sides = [int.from_bytes(data[k : k + 4], "big") for k in (16, 20)]
    assert sides == [canvas.get_property("width"), canvas.get_property("height")]


@pytest.mark.parametrize("name", ["radii", "sliding"])
def test_the_data_of_a_chart_are_saved(
    name: str, browser: Chrome, page_of: BuildOutput, built: Built, tmp_path: Path
) -> None:
    """One column of places for lines that share them, else one for each; breaks are empty."""
    charts = open_page(browser, page_of(NAIL))["charts"]
    (title,) = (chart["title"] for chart in charts if chart["name"] == name)
    unfold(browser)
    button = f'[aria-label="Save CSV: {title}"]'
    path = saved(browser, tmp_path, button, f"{NAIL}_{name}.csv")
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    chart = built(NAIL).chart(name)
    shared = name == "radii"
    labels = [
        [chart.x] * (k == 0 or not shared) + [f"{line.label}: {chart.y}"]
        for k, line in enumerate(chart.lines)
    ]
    assert head == [label for own in labels for label in own]
    for k, line in enumerate(chart.lines):
        columns = (0, 1 + k) if shared else (2 * k, 2 * k + 1)
        cells = np.array([[row[c] or "nan" for c in columns] for row in rows], dtype=float)
        wanted = np.column_stack([line.x, line.y])
        assert np.isnan(cells[len(wanted) :]).all()
        np.testing.assert_allclose(cells[: len(wanted)], wanted, atol=1e-3)
