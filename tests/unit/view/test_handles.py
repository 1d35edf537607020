"""Handles against the geometry of what they belong to: where they go as numbers change."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import pytest

from gearcam.view import work
from gearcam.view.numbers import numbers
from helpers_pairs import PROFILES

PLACE = 40.0
DRAFT = math.radians(3.0) ** 2 / 8.0
"""Error of a draft's poses: its places are 3 degrees apart, and what is between is interpolated."""


def found(profile: str, *, place: float = PLACE, **steps: float) -> dict[tuple[int, str], Any]:
    text = (PROFILES / f"{profile}.toml").read_text()
    given = steps or {key: 1e-3 for key in numbers(text) if not key.startswith("output")}
    reply = work.find_handles(text, str(PROFILES / f"{profile}.toml"), {}, given, place)
    assert not reply["error"]
    return {(one["body"], one["name"]): one["moves"] for one in reply["handles"]}


@pytest.fixture(scope="module")
def four_bar() -> dict[tuple[int, str], Any]:
    return found("four_bar")


def handle(found: Mapping[tuple[int, str], Any], name: str) -> dict[str, list[float]]:
    (moves,) = (one for (_, own), one in found.items() if own == name)
    return moves


def coupler_joint(a: float, b: float, c: float, dx: float, dy: float) -> complex:
    """C of a four-bar at the crank angle, from the triangle B C D on the left of B to D."""
    start = a * complex(math.cos(math.radians(PLACE)), math.sin(math.radians(PLACE)))
    way = complex(dx, dy) - start
    long = abs(way)
    along = (long * long + b * b - c * c) / (2.0 * long)
    return start + way / long * complex(along, math.sqrt(b * b - along * along))


def test_joints_go_as_the_geometry_of_the_linkage_says(four_bar: dict[Any, Any]) -> None:
    assert handle(four_bar, "D") == {
        "joint[0].at_mm[0]": [1.0, 0.0],
        "joint[0].at_mm[1]": [0.0, 1.0],
    }
    (crank,) = handle(four_bar, "B").values()
    angle = math.radians(PLACE)
    assert crank == pytest.approx([math.cos(angle), math.sin(angle)], abs=DRAFT)
    keys = (
        "crank[0].length_mm",
        "dyad[0].lengths_mm[0]",
        "dyad[0].lengths_mm[1]",
        "joint[0].at_mm[0]",
        "joint[0].at_mm[1]",
    )
    given = [40.0, 120.0, 90.0, 110.0, 0.0]
    moves = handle(four_bar, "C")
    assert set(moves) == set(keys)
    for k, key in enumerate(keys):
        ends = [[one + sign * (k == n) * 1e-4 for n, one in enumerate(given)] for sign in (1, -1)]
        high, low = (coupler_joint(*end) for end in ends)
        wanted = (high - low) / 2e-4
        assert moves[key] == pytest.approx([wanted.real, wanted.imag], abs=0.01)


def test_what_no_number_moves_is_no_handle(four_bar: dict[Any, Any]) -> None:
    assert {name for _, name in four_bar} == {"B", "C", "D", "P"}  # neither links nor the shaft


def test_the_pivot_of_an_arm_moves_with_its_distance_alone() -> None:
    moves = found("plate_cam_oscillating")
    ways = [one for (body, _), one in moves.items() if body == 1]
    (pivot,) = (one for one in ways if one.keys() == {"follower.pivot_distance_mm"})
    assert pivot["follower.pivot_distance_mm"] == pytest.approx([1.0, 0.0], abs=1e-3)
    (roller,) = (one for one in ways if "motion[0].lift_deg" in one)
    assert {"follower.arm_mm", "cam.prime_radius_mm"} <= set(roller)


def test_a_number_at_its_end_is_tried_the_other_way() -> None:
    """The axis of the driven wheel, with a step that one side of the number refuses."""
    key = "pair.center_distance_mm"
    for step in (1e-3, -1e-3, -200.0):
        moves = found("nail_machine_two_phase", **{key: step})
        assert handle(moves, "")[key] == pytest.approx([1.0, 0.0], abs=1e-9)
