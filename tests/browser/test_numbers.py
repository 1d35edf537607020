"""Numbers on pages: the script writes them as Python does, and keeps the unit of a chart."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver import Chrome

import gearcam.report
from gearcam.base.readable import column, number

SCRIPT = (Path(gearcam.report.__file__).parent / "numbers.js").read_text("utf-8")

VALUES = [
    0.0, -0.0, 41.96071, 279.351234, 0.757221, 28.154512, 1.857142, 2376.3412, 0.05, 100000.0,
    123456.7, -5.0902123, 3.21e-9, 2.71828e12, 9999.97, 0.99999999, 160.00000000000003, 1e-4,
]  # fmt: skip


def told(browser: Chrome, call: str, *given: Any) -> Any:
    browser.get("about:blank")
    return browser.execute_script(f"{SCRIPT}\nreturn {call};", *given)


@pytest.mark.parametrize("unit", ["", "mm", "deg"])
def test_numbers_are_those_of_the_console(browser: Chrome, unit: str) -> None:
    draw = random.Random(5)
    values = [*VALUES, *(draw.uniform(-1, 1) * 10 ** draw.uniform(-6, 9) for _ in range(300))]
    found = told(browser, "arguments[0].map((one) => brief(one, arguments[1]))", values, unit)
    assert found == [number(one, unit) for one in values]


def test_columns_are_those_of_the_console(browser: Chrome) -> None:
    draw = random.Random(6)
    rows = [[9.5, 10.25, 0.0], [47.8341, 1086.112], [-0.00488585, 12.00491], [1e-9, 12.00491]]
    rows += [[draw.uniform(-1, 1) * 10 ** draw.uniform(-2, 4) for _ in range(4)] for _ in range(90)]
    found = told(browser, "arguments[0].map((row) => lined(row))", rows)
    assert found == [list(column(row)) for row in rows]


def chart(unit: str, factor: float, high: float) -> dict[str, Any]:
    line = {"label": "a", "x": [0, 1, 2], "y": [0.0, high, None]}
    return {
        "y": f"acceleration, {unit}", "own": "mm/s2", "factor": factor, "range": [0.0, high],
        "ends": [[0, 2], [0.0, high]], "lines": [line],
        "limits": [{"label": "most", "value": high}],
        # a unit of the axis is less of a number where the axis has smaller units
        "handles": [{"x": 1.0, "y": high, "keys": {"a": [2.0, 3.0 / factor]}}],
    }  # fmt: skip


def test_a_chart_keeps_its_unit_while_one_drags(browser: Chrome) -> None:
    """Until its numbers are far from easy to read in it."""
    former = chart("mm/s2", 1.0, 9000.0)
    kept = told(browser, "inUnitOf(arguments[0], arguments[1])", chart("m/s2", 1e-3, 11.0), former)
    assert kept == chart("mm/s2", 1.0, 11000.0)
    far = chart("m/s2", 1e-3, 250.0)
    assert told(browser, "inUnitOf(arguments[0], arguments[1])", far, former) == far
    other = {**chart("N m", 1.0, 5.0), "own": "N m"}
    assert told(browser, "inUnitOf(arguments[0], arguments[1])", other, former) == other
    assert told(browser, "inUnitOf(arguments[0], null)", far) == far
