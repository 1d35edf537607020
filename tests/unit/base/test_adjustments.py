"""The least change along an adjustment: against a search of every place; places are short."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gearcam.base.adjustments import Scale, least, way

COUNT = 300


@given(st.integers(1, COUNT), st.integers(1, COUNT))
def test_the_least_is_that_of_a_search_of_every_place(first: int, guess: int) -> None:
    """Wherever the looks begin, and with a guess in few builds."""
    built: list[int] = []

    def cures(place: int) -> bool:
        built.append(place)
        return place >= first

    halves = [COUNT >> k for k in range(6)]
    doubled = [*(2**k for k in range(9)), COUNT]
    assert least(cures, halves) == least(cures, doubled) == (first, first - 1)
    built.clear()
    around = [guess, *(min(guess + 2**k, COUNT) for k in range(10))]
    assert least(cures, around, guessed=True) == (first, first - 1)
    assert len(built) <= 4 + 3 * math.log2(1 + abs(first - guess))
    assert not any(cures(place) for place in (first - 1, 0))


def test_places_between_those_that_cure_are_found_too() -> None:
    """What is too much fails as well: 40 to 60 cure alone."""
    assert least(lambda place: 40 <= place <= 60, [1, 2, 4, 8, 16, 32, 50, 100]) == (40, 39)
    assert least(lambda place: 40 <= place <= 60, [1, 2, 4, 8, 16, 32, 64, 128]) is None


def test_a_search_that_must_end_keeps_what_it_has() -> None:
    left = iter([False] * 3 + [True] * 9)
    assert least(lambda place: place >= 37, [100], over=lambda: next(left)) == (50, 25)
    assert least(lambda _: True, [5], over=lambda: True) is None


@given(st.integers(1, 6), st.floats(1e-3, 1e6))
def test_decimals_by_their_index(digits: int, value: float) -> None:
    scale = Scale(digits)
    at = scale.index(value)
    low, high = scale.value(at), scale.value(at + 1)
    assert low <= value * (1.0 + 1e-9)
    assert value < high
    assert scale.index(low) == at
    assert len(f"{low:.12g}".replace(".", "").strip("0").split("e")[0]) <= digits


@pytest.mark.parametrize("start", [7.0, 9.3, 20.0, 33.3])
def test_sizes_are_the_same_from_anywhere(start: float) -> None:
    larger = way({"a": start}, {"a": 700.0}, size=True)
    found = {larger.at(k)["a"] for k in range(1, len(larger.shares) + 1)}
    usual = way({"a": 1.0}, {"a": 700.0}, size=True)
    all_of_them = {usual.at(k)["a"] for k in range(1, len(usual.shares) + 1)}
    assert found == {one for one in all_of_them if one > start}
    steps = sorted(found)
    assert all(b / a <= 1.0101 for a, b in pairwise(steps))


@pytest.mark.parametrize(
    ("near", "far", "size"),
    [
        ({"a": 0.5}, {"a": 1.0}, False),
        ({"a": 1.0}, {"a": 0.0}, False),
        ({"a": -25.0, "b": 10.0}, {"a": -0.25, "b": 0.1}, True),
        ({"a": 30.0, "b": 80.0}, {"a": 3000.0, "b": 6020.0}, True),
        ({"a": [0.3, "solve"]}, {"a": 1.0}, False),
        ({"a": [20, 26]}, {"a": [60, 78]}, False),
    ],
)
def test_places_are_short_and_in_their_order(near: dict, far: dict, size: bool) -> None:  # type: ignore[type-arg]
    """Each is a change of its own, and none goes back."""
    places, digits = way(near, far, size=size), 4 + 2 * ("b" in near)
    found = [places.at(k) for k in range(len(places.shares) + 1)]
    flat = [
        [x for one in made.values() for x in (one if isinstance(one, list) else [one])]
        for made in found
    ]
    numbers = [[x for x in one if not isinstance(x, str)] for one in flat]
    assert len({str(one) for one in numbers}) == len(numbers)
    for values in zip(*numbers, strict=True):
        assert [*values] == sorted(values, reverse=values[-1] < values[0])
    assert all(
        len(f"{one[0]:.12g}".lstrip("-0.").replace(".", "")) <= digits for one in numbers[1:]
    )
    assert places.at(len(places.shares)) == {
        key: value if isinstance(value, list) or not isinstance(near[key], list) else found[-1][key]
        for key, value in far.items()
    }


def test_numbers_that_close_together_are_not_rounded_alone() -> None:
    together = way({"a": [0.4, 1.6]}, {"a": [1.0, 1.0]})
    for place in range(1, len(together.shares) + 1):
        first, second = together.at(place)["a"]
        assert first + second == pytest.approx(2.0, abs=1e-9)


def test_lifts_that_return_to_0_do_so_at_each_place() -> None:
    """12 + 8 - 20 = 0 in short decimals."""
    near = {"a": 12.0, "b": 8.0, "c": 20.0}
    places = way(near, {key: 0.01 * value for key, value in near.items()}, size=True)
    for place in range(1, len(places.shares) + 1):
        a, b, c = places.at(place).values()
        assert abs(a + b - c) < 1e-9
        assert len(f"{c:.12g}") <= 8


def test_the_first_of_many_teeth_keeps_their_ratio() -> None:
    many = way({"z": [300, 306]}, {"z": [900, 918]})
    assert many.first == {"z": [300, 306]}
    assert many.at(1) == {"z": [350, 357]}


@pytest.mark.parametrize("start", [0.999999998, 1.0, 1.000000002])
def test_ways_of_nearly_round_length_have_places(start: float) -> None:
    places = way({"a": start}, {"a": 0.0})
    assert 90 <= len(places.shares) <= 260
    assert places.at(len(places.shares)) == {"a": 0.0}
