"""Round numbers are written round, all others to the last bit, and in one place only."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest

from arch import rules
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import Finding
from gearcam.base.numerals import (
    decimal,
    exact,
    formatted,
    rounded_down,
    rounds_to,
    settled,
    told_apart,
    tree,
)
from gearcam.console import infeasible_text
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


def _near_each_other() -> list[tuple[float, float]]:
    """Numbers that differ by 1 to 1e-16 of their size."""
    random = np.random.default_rng(11)
    values = (random.uniform(0.1, 1.0, 400) * 10.0 ** random.integers(-6, 6, 400)).tolist()
    off = (10.0 ** random.uniform(-16.0, 0.0, 400) * random.choice([-1.0, 1.0], 400)).tolist()
    return [(value, value * (1.0 + one)) for value, one in zip(values, off, strict=True)]


@pytest.mark.parametrize("digits", [4, 6, 10])
def test_numbers_that_differ_look_different_and_are_those_numbers(digits: int) -> None:
    for one, other in _near_each_other():
        texts = told_apart(one, other, "mm", digits)
        assert (texts[0] == texts[1]) == (one == other), (one, other)
        for text, number in zip(texts, (one, other), strict=True):
            assert float(text.removesuffix(" mm")) == pytest.approx(
                number, rel=10.0 ** (1 - digits)
            )
    assert told_apart(0.1 + 0.2, 0.3) == ("0.30000000000000004", "0.29999999999999999")
    assert told_apart(2.0, 2.0) == ("2", "2")
    assert told_apart(248.6788032, 248.679) == ("248.6788", "248.679")  # one digit more
    assert told_apart(None, 2.0, "N") == ("", "2 N")


def test_value_and_limit_of_findings_refusals_and_facts_look_different() -> None:
    for value, limit in _near_each_other():
        if value == limit:
            continue
        finding = Finding(code="a", severity="note", message="", value=value, limit=limit)
        assert finding.text != finding.limit_text.split()[-1]
        refusal = InfeasibleError("too much", value=value, limit=limit)
        for text in (str(refusal), infeasible_text(refusal)):
            words = re.split(r"[\s;,]+", text)
            assert words[words.index("value") + 1] != words[words.index("limit") + 1]
        if abs(value - limit) > 1e-9 * limit:
            for shown in (value, {"least": value, "mean": 2.0 * limit}):
                fact = Facts({"a": Fact(shown, at_least=limit)}).quantity("a")
                alike = fact.text.split(",")[0] == fact.limit.split()[-1]
                assert value > limit or not alike  # what keeps its limit may look like it


@pytest.mark.parametrize(
    ("written", "value", "same"),
    [
        (248.679, 248.67880320994, True),
        (248.68, 248.67880320994, True),
        (248.7, 248.67880320994, False),  # five digits at least
        (248.679, 248.6796, False),
        (262.1855, 262.18548705, True),
        (262.1855, 262.18541, False),
        (262.18548705, 262.1854870519, True),
        (180.0, 180.004, True),
        (180.0, 180.006, False),
    ],
)
def test_a_number_is_known_by_the_digits_that_are_written(
    written: float, value: float, same: bool
) -> None:
    assert rounds_to(value, written) == same
    assert rounds_to(value, math.degrees(math.radians(written))) == same


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
