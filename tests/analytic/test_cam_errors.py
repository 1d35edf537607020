"""Errors that a cam tells of itself are never less than the truth, and not far above it.

The truth is the mathematics once more in 32 digits (`witness.lifts`, `witness.cam_numbers`), from
the text of the design. All numbers are held against it, also those without an estimate, at places
all over the turn, at extremes, at the ends of undercut stretches and at corners.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import gearcam
from gearcam.designs.writing import toml_text
from gearcam.kinds.cam.result import error_rows
from helpers_cam_truth import faults, judged, rows
from helpers_sampling import few
from random_designs.cam import design as cam
from random_designs.draw import Draw
from witness.lifts import formula

mp: Any = mpmath.mp
DIGITS = 32


def told_by_text(design: Mapping[str, Any]) -> bool:
    """Whether the text tells the plane cam.

    No rows, which may scatter, no size to be found, no lift that corrects an elastic train.
    """
    motion, sizes = design.get("motion", {}), design.get("cam", {})
    plane = "type" in design.get("follower", {}) and "solve" not in sizes.values()
    plane &= "polydyne" not in str(design.get("drive"))
    return plane and (isinstance(motion, list) or "lift" in motion)


GALLERY = sorted(
    path
    for path in Path("profiles").glob("*cam*.toml")
    if told_by_text(tomllib.loads(path.read_text()))
)
FAST = ("undercut_cam", "groove_cam")

ROLLER = {"type": "roller", "roller_radius_mm": 8.0}
FOLLOWERS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "roller": ({**ROLLER, "offset_mm": 3.0}, {"prime_radius_mm": 40.0}),
    "flat": ({"type": "flat"}, {"base_radius_mm": 60.0}),
    "swinging": (
        {**ROLLER, "motion": "oscillating", "arm_mm": 80.0, "pivot_distance_mm": 90.0},
        {"prime_radius_mm": 40.0},
    ),
}
LIFTS: dict[str, Any] = {
    "5.0*(1 - cos(theta))": lambda t: 5.0 * (1.0 - np.cos(t)),
    "2.0*sin(theta) + sin(3*theta)": lambda t: 2.0 * np.sin(t) + np.sin(3.0 * t),
    "3.0*exp(sin(theta))": lambda t: 3.0 * np.exp(np.sin(t)),
}
FIRST = next(iter(LIFTS))


def drawn(number: int) -> dict[str, Any]:
    """A design at random, of the families that take turns; rows are looked at by themselves."""

    draws = (cam(Draw(f"errors {number} {again}"), number) for again in range(9))
    made = next(one for one in draws if told_by_text(one))
    if made["cam"].get("form") != "translating":
        made.pop("blank", None)
    follower, wheel = made["follower"], made["cam"]
    if number % 4 == 1 and follower["type"] == "roller" and wheel.get("form") is None:
        size = wheel.get("prime_radius_mm") or wheel["base_radius_mm"]
        follower["roller_radius_mm"] = 0.8 * size  # often undercut
    return {"kind": "cam", "name": "cam", **made}


def told_and_true(result: Any, truth: Mapping[str, Any]) -> tuple[dict[str, float], Any]:
    """The estimates of a result, and its true errors with their sizes."""
    with mp.workdps(DIGITS):
        true = judged(rows(result, truth))
    return {name: value for name, (value, _) in error_rows(result).items()}, true


def random_faults(number: int) -> list[str] | None:
    """The same of a design at random; None where it cannot be made."""
    design = drawn(number)
    try:
        result = gearcam.build(gearcam.loads(toml_text(design)))
        _ = result.profiles
    except gearcam.GearcamError:
        return None
    return [f"{number}: {fault}" for fault in faults(*told_and_true(result, design))]


def smooth(follower: str, text: str) -> dict[str, Any]:
    """A design of the whole turn by a formula."""
    given, wheel = FOLLOWERS[follower]
    lift = f"0.02*({text})" if follower == "swinging" else text
    return {"kind": "cam", "name": "cam", "motion": {"lift": lift}, "follower": given, "cam": wheel}


def with_motion(design: Mapping[str, Any], motion: Any) -> Any:
    return gearcam.build(replace(gearcam.loads(toml_text(design)), motion=motion))


@pytest.mark.parametrize("number", few([10, 55, 247, 41]))
def test_estimates_of_random_cams_are_honest(number: int) -> None:
    assert random_faults(number) == []


@pytest.mark.slow
def test_estimates_of_a_hundred_random_cams_are_honest() -> None:
    found = [random_faults(number) for number in range(112)]
    assert sum(one is not None for one in found) >= 100
    assert [fault for one in found if one for fault in one] == []


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=path.stem, marks=() if path.stem in FAST else pytest.mark.slow)
        for path in GALLERY
    ],
)
def test_estimates_of_the_gallery_are_honest(path: Path) -> None:
    design = tomllib.loads(path.read_text())
    assert faults(*told_and_true(gearcam.build(gearcam.load(path)), design)) == []


@pytest.mark.parametrize(
    ("follower", "text"),
    [
        pytest.param(name, text, marks=() if (name, text) == ("flat", FIRST) else pytest.mark.slow)
        for name in FOLLOWERS
        for text in LIFTS
    ],
)
def test_estimates_of_python_functions_are_honest(follower: str, text: str) -> None:
    design = smooth(follower, text)
    share = 0.02 if follower == "swinging" else 1.0
    motion = gearcam.MotionFormula(lift=lambda theta: share * LIFTS[text](theta))
    assert faults(*told_and_true(with_motion(design, motion), design)) == []


@pytest.mark.parametrize(
    ("follower", "text", "count"),
    [
        pytest.param(
            name,
            text,
            count,
            marks=() if (name, text, count) == ("flat", FIRST, 36) else pytest.mark.slow,
        )
        for name in FOLLOWERS
        for text in LIFTS
        for count in (36, 60, 180)
    ],
)
def test_estimates_of_rows_are_honest(follower: str, text: str, count: int) -> None:
    """Rows of a smooth motion: what the curve through them misses of it.

    Of the area little is known: errors between rows cancel in it.
    """
    design = smooth(follower, text)
    theta = 2.0 * np.pi * np.arange(count) / count
    with mp.workdps(DIGITS):
        lift = formula(design["motion"]["lift"], "theta")
        rows_of_lift = [float(lift(mp.mpf(place))) for place in theta.tolist()]
    motion = gearcam.MotionTable(theta=theta, lift=np.array(rows_of_lift))
    both = told_and_true(with_motion(design, motion), design)
    found = faults(*both, known=np.inf)
    assert [fault for fault in found if not fault.startswith("area_mm2")] == []
    assert faults(*both, most=np.inf, known=np.inf) == []


def test_estimates_that_are_too_small_or_too_large_are_seen() -> None:
    design = drawn(41)
    told, true = told_and_true(gearcam.build(gearcam.loads(toml_text(design))), design)
    assert len(true) >= 7
    assert {"lift_mm", "profile_mm"} <= {*true} & {*told}
    for name in true:
        for factor in (1e-4, 1e4):
            wrong = {**told, name: factor * told[name]} if name in told else told
            seen = faults(wrong, true, known=0.0)
            assert any(fault.startswith(name) for fault in seen)
