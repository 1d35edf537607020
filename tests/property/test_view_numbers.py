"""Numbers of design files: each can be replaced and nothing else is; sliders stay in what reads."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gearcam.base.errors import DesignError
from gearcam.base.quantities import ANGLE, COUNT, LENGTH, NUMBER, Param, Quantity
from gearcam.designs.design import loads, path_of, value_at
from gearcam.designs.faults import dotted
from gearcam.designs.table import Key
from gearcam.view.numbers import equals, numbers, replaced, sliders, span
from helpers_pairs import PROFILES
from helpers_sampling import few

FILES = sorted(PROFILES.glob("*.toml"))
BY_NAME = pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)


def free(*_: Any) -> tuple[()]:
    """Let every number change alone."""
    return ()


def leaves(part: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str, Any]]:
    if isinstance(part, dict | list):
        for key, item in part.items() if isinstance(part, dict) else enumerate(part):
            yield from leaves(item, (*path, key))
    else:
        # of a size with a tolerance class its number is meant
        classed = isinstance(part, str) and re.fullmatch(r"([\d.]+) (?:[A-Z]|JS)\d+", part)
        yield dotted(path), float(classed[1]) if classed else part


@BY_NAME
def test_only_the_number_that_is_changed_differs(file: Path) -> None:
    text = file.read_text()
    before, found = dict(leaves(tomllib.loads(text))), numbers(text)
    assert found
    assert found == {key: one for key, one in before.items() if type(one) in (int, float)}
    for key, value in found.items():
        made = replaced(text, {key: value + 0.625})
        after = dict(leaves(tomllib.loads(made)))
        assert {k: v for k, v in after.items() if v != before[k]} == {key: value + 0.625}
        assert list(after) == list(before)
        mine, theirs = made.split("\n"), text.split("\n")
        (line,) = [k for k, (a, b) in enumerate(zip(mine, theirs, strict=True)) if a != b]
        assert mine[line].partition("#")[1:] == theirs[line].partition("#")[1:]


@BY_NAME
def test_all_numbers_at_once_and_back_again_are_the_same_text(file: Path) -> None:
    text = file.read_text()
    found = numbers(text)
    made = replaced(text, {key: value + 1 for key, value in found.items()})
    assert numbers(made) == pytest.approx({key: value + 1 for key, value in found.items()})
    assert numbers(replaced(made, found)) == found
    assert replaced(text, {}) == text


@pytest.mark.parametrize("file", few(FILES, 12), ids=lambda file: file.stem)
def test_sliders_hold_what_is_in_the_file_and_end_at_what_reads(file: Path) -> None:
    text, found = file.read_text(), numbers(file.read_text())
    design = loads(text, file=str(file))

    def reads(other: str) -> bool:
        try:
            loads(other, file=str(file))
        except DesignError:
            return False
        return True

    made = sliders(text, reads, free)
    assert made
    same = replaced(text, {one["key"]: one["value"] for one in made})
    assert loads(same, file=str(file)) == design
    for one in made:
        key, value = one["key"], one["value"]
        written = value_at(tomllib.loads(text), key)
        # of a size with a class, such as "25 H7", the size
        size = float(written.split()[0]) if isinstance(written, str) else written
        assert value == found[key] == size
        assert one["low"] <= value <= one["high"]
        assert 0 < one["step"] <= one["high"] - one["low"]
        assert one["doc"]
        assert isinstance(one["integer"], bool)
        for end in (one["low"], one["high"]):
            ways = ({}, equals(found, key, end))
            assert end == value or any(reads(replaced(text, {key: end, **more})) for more in ways)


ODD = """\
# all that TOML allows
kind = "gear-pair" # 3.0
"name" = 'a = 3 # no comment'
law = { type = "phases", knots_deg = [ 0, 1_60.0, # in the middle
  +3.6e2 ], ratios = [1.6, 0.4 , 1.6,] } # ratios
[pair]
teeth = [
  36, # [37]
  36,
]
  center_distance_mm=180#mm
[[motion]]
a.b = 0x10
[[motion]]
a = {"c d" = -0.5}
"""


@pytest.mark.parametrize(
    ("key", "value", "old", "new"),
    [
        ("law.knots_deg[0]", 5, " 0,", " 5,"),
        ("law.knots_deg[1]", 170.5, "1_60.0", "170.5"),
        ("law.knots_deg[2]", 350, "+3.6e2", "350.0"),
        ("law.ratios[2]", 1.7, "1.6,]", "1.7,]"),
        ("law.ratios[1]", 0.1 + 0.2, "0.4 ", "0.30000000000000004 "),
        ("pair.teeth[0]", 38, "  36, #", "  38, #"),
        ("pair.teeth[1]", 38, "36,\n]", "38,\n]"),
        ("pair.center_distance_mm", 181.0, "=180#", "=181#"),
        ("motion[0].a.b", 17, "0x10", "17.0"),
        ('motion[1].a."c d"', -1, "-0.5", "-1.0"),
    ],
)
def test_numbers_are_found_wherever_toml_lets_them_stand(
    key: str, value: float, old: str, new: str
) -> None:
    if '"' in key:
        with pytest.raises(KeyError):  # no key of ours has a space
            replaced(ODD, {key: value})
        return
    assert ODD.count(old) == 1
    made = replaced(ODD, {key: value})
    assert made == ODD.replace(old, new)
    assert value_at(tomllib.loads(made), key) == pytest.approx(value)


def test_a_key_that_does_not_stand_there_is_refused() -> None:
    with pytest.raises(KeyError):
        replaced(ODD, {"pair.x": 1})


def test_equal_numbers_of_a_list_are_found() -> None:
    found = numbers(ODD)
    assert equals(found, "law.ratios[0]", 2) == {"law.ratios[2]": 2}
    assert equals(found, "pair.teeth[1]", 40) == {"pair.teeth[0]": 40}
    assert equals(found, "law.ratios[1]", 2) == {}
    assert equals(found, "pair.center_distance_mm", 2) == {}


def key_of(quantity: Quantity, base: type = float, **bounds: float) -> Key:
    return Key("a", "a", Param(quantity, **bounds), base, None, "", 0)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("key", "value", "low", "high"),
    [
        (key_of(LENGTH, gt=0, le=1e6), 180, 90, 360),
        (key_of(NUMBER, ge=0, lt=1), 0.3, 0, 0.999),
        (key_of(ANGLE, ge=10, le=35), 20, 10, 35),
        (key_of(COUNT, int, ge=1), 36, 18, 72),
        (key_of(COUNT, int, ge=1), 1, 1, 3),
        (key_of(COUNT, int, ge=0, le=3), 0, 0, 2),
        (key_of(LENGTH, ge=0), 0, 0, 1),
        (key_of(ANGLE), 0, -10, 10),
        (key_of(LENGTH), -4, -8, -2),
        (key_of(LENGTH, gt=0, le=1), 0.001, 0.001, 0.002),
        (key_of(LENGTH, ge=1e-9, le=1), 0.001, 0.0005, 0.002),
    ],
)
def test_ends_of_sliders(key: Key, value: float, low: float, high: float) -> None:
    found = span(key, value)
    assert found[:2] == pytest.approx((low, high))


@given(
    st.floats(-1e6, 1e6, allow_nan=False),
    st.floats(1e-9, 1e9),
    st.floats(0.0, 1.0),
    st.sampled_from([float, int]),
)
def test_a_slider_ends_within_what_is_allowed(
    low: float, size: float, share: float, base: type
) -> None:
    value = base(low + share * size)
    if not low <= value <= low + size:
        return
    first, last, step = span(key_of(NUMBER, base, ge=low, le=low + size), value)
    assert step > 0
    slack = 1e-9 * max(abs(low), abs(low + size), 1.0)
    assert low - slack <= first <= value <= last <= low + size + slack


def test_keys_go_there_and_back() -> None:
    for file in FILES:
        for key in numbers(file.read_text()):
            assert dotted(path_of(key)) == key


def test_sliders_are_those_of_the_kind_that_the_document_means() -> None:
    """A cylinder cam is written as a cam, whose tables have other keys."""
    text = (PROFILES / "cylinder_cam.toml").read_text()
    keys = {one["key"] for one in sliders(text, lambda _: True, free)}
    missed = {key for key in numbers(text) if key not in keys}
    assert {"cam.length_mm", "cam.lowest_mm", "cam.floor_clearance_mm"} <= keys
    assert missed == set()
