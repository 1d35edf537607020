"""Round numbers are written round, all others to the last bit, and in one place only."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest

from arch import rules
from gearcam.base.findings import Finding
from gearcam.base.numerals import decimal, exact, formatted, rounded_down, settled, tree
from gearcam.export.table import table_bytes


@pytest.mark.parametrize("degrees", [60.0, 0.1, 22.5, 359.99, 123.456, 7e-3, -60.0, 1e5])
def test_degrees_come_back_from_radians(degrees: float) -> None:
    """The way that angles take: read, kept in radians, summed, written."""
    kept = math.radians(degrees)
    for there in (math.degrees(kept), kept / (math.pi / 180.0), float(np.degrees(kept))):
        assert exact(there) == degrees


def test_a_table_of_whole_degrees_holds_whole_degrees() -> None:
    angles = np.degrees(np.radians(np.arange(0.0, 361.0)))
    assert any(len(repr(angle)) > 15 for angle in angles.tolist()), "nothing to mend"
    rows = table_bytes({"phi1_deg": angles}).decode().split()[1:]
    assert rows == [f"{k}.0" for k in range(361)]


def test_no_number_moves_by_more_than_two_units_in_the_last_place() -> None:
    random = np.random.default_rng(7)
    values = (random.standard_normal(20000) * 10.0 ** random.integers(-12, 12, 20000)).tolist()
    values += [math.nextafter(k / 8.0, math.inf) for k in range(-999, 1000)]
    moved = [abs(exact(value) - value) / math.ulp(value) for value in values]
    assert max(moved) <= 2.0
    assert sum(move > 0.0 for move in moved[:20000]) < 20


def test_three_units_beside_a_round_number_is_no_round_number() -> None:
    for value in (60.0, 0.1, 1234.5):
        beside = value
        for _ in range(2):
            beside = math.nextafter(beside, math.inf)
            assert exact(beside) == value
        beside = math.nextafter(beside, math.inf)
        assert exact(beside) == beside


def test_a_third_stays_a_third() -> None:
    for value in (1 / 3, 360 / 7, math.pi, 1e300 / 3, 5e-324, math.inf):
        assert exact(value) == value
    assert math.isnan(exact(math.nan))


def test_people_see_no_signed_zero_and_no_idle_zeros() -> None:
    assert [formatted(value) for value in (60.0, -0.0, 1.25, 123456.789)] == [
        "60", "0", "1.25", "123457",
    ]  # fmt: skip
    assert [formatted(1 / 3, digits) for digits in (2, 10)] == ["0.33", "0.3333333333"]
    assert [decimal(value) for value in (60.0, -1e-9, 1.25, 0.12349)] == [
        "60",
        "0",
        "1.25",
        "0.123",
    ]
    assert [decimal(value, 0) for value in (60.0, -0.2, 100.4)] == ["60", "0", "100"]


def test_noise_is_nothing_where_the_scale_is_known() -> None:
    assert settled(-1.19522e-14, 0.9) == 0.0
    assert settled(-1.19522e-14, 0.0) == -1.19522e-14
    assert settled(1e-9, 1.0) == 1e-9
    assert formatted(-1.19522e-14, scale=0.9) == "0"
    made = Finding(code="c", severity="note", message="m", value=-1.19522e-14, limit=0.9)
    assert made.value == 0.0
    assert Finding(code="c", severity="note", message="m", value=1e-14).value == 1e-14


def test_a_tree_keeps_its_shape() -> None:
    made = {"a": [59.99999999999999, 7, True, None, "59.99999999999999"], "b": (1 / 3, {"c": 0.1})}
    assert json.dumps(tree(made)) == json.dumps(
        {"a": [60.0, 7, True, None, "59.99999999999999"], "b": [1 / 3, {"c": 0.1}]}
    )


@pytest.mark.parametrize("value", [49.7, 7.123456789, 0.00123456789, 98765.4321, 3.0])
def test_a_limit_is_never_rounded_up(value: float) -> None:
    for digits in (3, 6):
        told = float(rounded_down(value, digits))
        assert told <= value < told + 1.01 * 10.0 ** (math.floor(math.log10(value)) + 1 - digits)


ROOMS = ("parts/", "sheets/", "export/", "drawings", "solids", "quantities", "console", "errors")
"""Where numbers are written by `numerals` only."""

_FORMATS = re.compile(r":[+ ,]?\.?\d*[efg]\}|%\.\d+[efg]|\brstrip\(\"0\"\)")


def test_nobody_else_formats_numbers() -> None:
    found = [
        f"{path.relative_to(rules.SOURCE)}: {line.strip()}"
        for path in rules.python_files(rules.SOURCE)
        if str(path.relative_to(rules.SOURCE)).startswith(ROOMS)
        and path.name not in ("rolled.py", "parallel.py")
        for line in path.read_text(encoding="utf-8").splitlines()
        if _FORMATS.search(line)
    ]
    assert found == []
