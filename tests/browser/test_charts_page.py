"""A page of charts alone: all are drawn, with logarithmic axes, and each is saved."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By

from gearcam.pictures.charts import Chart, Line
from gearcam.report.page import charts_page
from helpers_browser import LAPTOP, PHONE, complaints, open_page, requests, until

X, Y = np.array([1e-3, 2e-3, 0.5]), np.array([1e-2, 0.0, 3.4567891e-13])


@pytest.fixture
def path(tmp_path: Path) -> Path:
    lines = (Line(label="error", x=X, y=Y), Line(label="own", x=X[2:], y=Y[2:], dots=True))
    charts = [Chart(title=f"</{k}>", x="s", y="mm", lines=lines, log="xy") for k in range(5)]
    made = tmp_path / "charts.html"
    made.write_bytes(charts_page("a & b", charts, "  level   error\n  1       <2>"))
    return made


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_all_charts_are_drawn_and_the_text_is_kept(
    size: tuple[int, int], path: Path, browser: Chrome
) -> None:
    data = open_page(browser, path, size)
    assert [len(chart["lines"]) for chart in data["charts"]] == [2] * 5
    figures = browser.find_elements(By.CLASS_NAME, "chart")
    for figure in figures:
        browser.execute_script("arguments[0].scrollIntoView()", figure)
        until(lambda figure=figure: figure.find_elements(By.TAG_NAME, "canvas"))
    assert [one.find_element(By.TAG_NAME, "h3").text for one in figures] == [
        f"</{k}>" for k in range(5)
    ]
    assert browser.find_element(By.TAG_NAME, "h1").text == browser.title == "a & b"
    text = browser.find_element(By.TAG_NAME, "pre").get_property("textContent")
    assert text == "  level   error\n  1       <2>"
    wide = "const e = document.scrollingElement; return e.scrollWidth - e.clientWidth"
    assert browser.execute_script(wide) == 0
    assert complaints(browser) == []
    assert requests(browser) == [path.as_uri()]


SIZE = """
    const canvas = arguments[0].querySelector("canvas");
    const { data, width } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const [xs, ys] = [[], []];
    for (let k = 0; k < data.length / 4; k++) {
      const rgb = data.slice(4 * k, 4 * k + 3);
      if (data[4 * k + 3] > 200 && Math.max(...rgb) - Math.min(...rgb) > 70) {
        xs.push(k % width);
        ys.push(Math.floor(k / width));
      }
    }
    const long = (all) => Math.max(...all) - Math.min(...all);
    return [long(xs), long(ys)];
"""
"""Width and height of what is drawn in colour, in pixels."""


def test_a_circle_is_round_where_both_axes_have_one_scale(browser: Chrome, tmp_path: Path) -> None:
    turn = np.linspace(0.0, 6.3, 200)
    line = Line(label="circle", x=3.0 * np.cos(turn), y=5.0 + 3.0 * np.sin(turn))
    charts = [Chart(title="c", x="N", y="N", lines=(line,), equal=one) for one in (True, False)]
    path = tmp_path / "charts.html"
    path.write_bytes(charts_page("circles", charts, ""))
    for size in (LAPTOP, PHONE):
        open_page(browser, path, size)
        sizes = []
        for figure in browser.find_elements(By.CLASS_NAME, "chart"):
            browser.execute_script("arguments[0].scrollIntoView()", figure)
            until(lambda figure=figure: figure.find_elements(By.TAG_NAME, "canvas"))
            sizes.append(until(lambda figure=figure: browser.execute_script(SIZE, figure)))
        (width, height), (wide, high) = sizes
        assert width == pytest.approx(height, abs=4.0)
        assert wide > 1.2 * high
        assert complaints(browser) == []


def test_what_is_saved_has_all_digits_of_small_values(
    path: Path, browser: Chrome, tmp_path: Path
) -> None:
    open_page(browser, path)
    behaviour = {"behavior": "allow", "downloadPath": str(tmp_path)}
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", behaviour)
    browser.find_elements(By.CLASS_NAME, "save")[0].click()
    (made,) = until(lambda: [*tmp_path.glob("*.csv")])
    assert re.match("a & b", made.name)
    with until(lambda: made.stat().st_size and made).open(newline="", encoding="utf-8") as file:
        _, *rows = csv.reader(file)
    assert [row[:2] for row in rows] == [["0.001", "0.01"], ["0.002", ""], ["0.5", "3.45679e-13"]]
