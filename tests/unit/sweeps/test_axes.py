"""What may be written for a key of a sweep."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.base.errors import DesignError
from gearcam.sweeps.axes import axes_of, settings_of


def axis(written: Any) -> Any:
    (one,) = axes_of({"law.eccentricity": written})
    return one


@pytest.mark.parametrize(
    ("written", "values"),
    [
        ("0.1,0.2", (0.1, 0.2)),
        ("[20,20],[24,24]", ([20, 20], [24, 24])),
        ("3", (3,)),
        ("cycloidal,3-4-5", ("cycloidal", "3-4-5")),
        ('"a:b"', ("a:b",)),
        ("true,false", (True, False)),
        ("0.05:0.2:0.05", (0.05, 0.1, 0.15, 0.2)),
        ("1:2:0.4", (1.0, 1.4, 1.8)),
        ("20:26:2", (20, 22, 24, 26)),
        ("3:1:-1", (3, 2, 1)),
        ("log(1, 1000, 4)", (1.0, 10.0, 100.0, 1000)),
        ([0.1, 0.2], (0.1, 0.2)),
        (7, (7,)),
        ([[20, 20], [24, 24]], ([20, 20], [24, 24])),
    ],
)
def test_values_and_ranges(written: Any, values: tuple[Any, ...]) -> None:
    found = axis(written).values
    assert found == values
    assert [type(one) for one in found] == [type(one) for one in values]


def test_a_range_has_its_end_in_spite_of_rounding() -> None:
    values = axis("0:1:0.1").values
    assert values == tuple(k / 10 for k in range(11))


@pytest.mark.parametrize(
    ("written", "cumulative"),
    [
        ("2:6", lambda x: (x - 2.0) / 4.0),
        ("log(1, 100)", lambda x: math.log(x) / math.log(100.0)),
        ("normal(20, 0.5)", lambda x: 0.5 * (1.0 + math.erf((x - 20.0) / 0.5 / math.sqrt(2.0)))),
    ],
)
def test_distributions_are_those_that_are_named(written: str, cumulative: Any) -> None:
    one = axis(written)
    assert one.sampled
    for u in (0.001, 0.2, 0.5, 0.77, 0.999):
        assert cumulative(one.at(u)) == pytest.approx(u, abs=1e-12)


def test_a_tolerance_is_normal_and_ends_at_its_limits() -> None:
    one = axis("tolerance(20, 0.3)")
    values = np.array([one.at(u) for u in (np.arange(20000) + 0.5) / 20000])
    assert one.at(0.0) == pytest.approx(19.7)
    assert one.at(1.0 - 1e-16) == pytest.approx(20.3)
    assert values.mean() == pytest.approx(20.0, abs=1e-9)
    # a normal distribution cut off at three standard deviations has 0.98658 of its own
    assert values.std() == pytest.approx(0.1 * 0.98658, rel=1e-4)


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("0.1:0.5:-0.1", "a step of -0.1 does not lead from 0.1 to 0.5"),
        ("0.5:0.1:0.1", "a step of 0.1 does not lead from 0.5 to 0.1"),
        ("0:1:0", "a step of 0 does not lead"),
        ("5:1", "is an empty range"),
        ("1:2:3:4", "is not a range"),
        ("1:b:3", '"b" is not a number'),
        ("1:nan", '"nan" is not a number'),
        ("log(0, 1)", "is not a range by logarithm"),
        ("log(1, 10, 1)", "is not a range by logarithm"),
        ("log(1)", "is not a range by logarithm"),
        ("normal(1, 0)", "is not two numbers"),
        ("tolerance(1)", "is not two numbers"),
        ("1,2,1", "1 is listed twice"),
        ([], "has no value"),
    ],
)
def test_what_cannot_be_read_is_named(written: Any, message: str) -> None:
    with pytest.raises(DesignError) as caught:
        axis(written)
    assert message in str(caught.value)
    assert "law.eccentricity" in str(caught.value)


def test_a_wrong_step_names_one_that_leads_there() -> None:
    with pytest.raises(DesignError, match=r"a step such as 0\.1"):
        axis("0.1:0.5:-0.1")


def test_settings_are_read_by_key() -> None:
    assert settings_of(["a.b=1:2", "c=x=y"]) == {"a.b": "1:2", "c": "x=y"}
    for texts, message in (
        (["a"], "is not KEY="),
        (["=1"], "is not KEY="),
        (["a="], "is not KEY="),
        (["a=1", "a=2"], "a is set twice"),
    ):
        with pytest.raises(DesignError, match=message):
            settings_of(texts)
