"""Ladders show the orders that theory expects, against what the program itself does not say."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.kinds.cam import ladders as cam_ladders
from gearcam.numeric.chebyshev import expand
from gearcam.results.accuracy import Accuracy, accuracy
from gearcam.results.ladders import chord_distance, integral_ladder
from helpers_sampling import few

PAIR = """
kind = "gear-pair"
name = "pair"
law = { type = "ellipse", eccentricity = 0.2 }
pair = { module_mm = 2, teeth = [17, 17] }
output = { files = ["csv"], chord_tolerance_mm = 0.001 }
"""
CAM = """
kind = "cam"
name = "cam"
motion = [
  {{ type = "rise", law = "{law}", angle_deg = 80, lift_mm = 10 }},
  {{ type = "dwell", angle_deg = 61 }},
  {{ type = "return", law = "{law}", angle_deg = 101 }},
  {{ type = "dwell", angle_deg = "rest" }},
]
follower = {{ type = "roller", roller_radius_mm = 8 }}
cam = {{ base_radius_mm = 40, thickness_mm = 10 }}
output = {{ files = ["csv"] }}
"""


def built(text: str) -> Any:
    return gearcam.build(gearcam.loads(text))


def climbed(text: str, *stages: str) -> Accuracy:
    return accuracy(built(text), stages, repeat=1)


@pytest.mark.parametrize("degree", [2, 4, 6])
def test_the_integral_of_an_expansion_gains_two_orders_on_its_degree(degree: int) -> None:
    """Of even degree: the nodes lie evenly about the middle."""
    x = np.linspace(0.0, 6.0, 4999)
    counts = np.array([128, 192, 256])
    errors = []
    for count in counts.tolist():
        found = expand(lambda t: np.cos(40.0 * t), [0.0, 6.0], np.inf, degree=degree, cuts=count)
        errors.append(np.abs(found.antiderivative()(x) - np.sin(40.0 * x) / 40.0).max())
    slope = np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(-(degree + 2), abs=0.1)


def test_the_integral_ladder_has_order_ten() -> None:
    """On an integrand so long that many rungs are above rounding."""
    ladder = integral_ladder(
        lambda x: np.cos(40.0 * x),
        np.array([0.0, 2.0 * math.pi]),
        lambda x: np.sin(40.0 * x) / 40.0,
        size=3.0,
        measured="",
        unit="",
    )
    found = [ladder.measure(ladder.make(level)) for level in (96.0, 128.0, 192.0)]
    errors, points = np.array(found).T
    assert points.tolist() == [9 * 96, 9 * 128, 9 * 192]
    assert np.polyfit(np.log(points), np.log(errors), 1)[0] == pytest.approx(-10.0, abs=0.1)
    assert ladder.order == 10.0


def test_the_size_scales_the_error_of_an_integral() -> None:
    def at(size: float) -> float:
        ladder = integral_ladder(
            np.exp, np.array([0.0, 9.0]), np.exp, size=size, measured="", unit=""
        )
        return ladder.measure(ladder.make(2.0))[0]

    assert at(7.0) == pytest.approx(7.0 * at(1.0))


@pytest.mark.parametrize("stage", few(["outline", "solid", "flank", "contact"]))
def test_stages_of_a_pair_have_order_two(stage: str) -> None:
    assert climbed(PAIR, stage).order(stage) == pytest.approx(2.0, abs=0.1)


def test_law_and_centrode_end_in_rounding() -> None:
    found = climbed(PAIR, "law", "centrode")
    for stage in ("law", "centrode"):
        first, *_, last = found.of(stage)
        assert first.error > 1e-4
        assert last.error < found.ladders[stage].rounding < 1e-11
        own = next(rung for rung in found.of(stage) if rung.own)
        assert own.error < found.ladders[stage].rounding


@pytest.mark.parametrize(
    ("law", "order"), [("harmonic", 0.5), ("3-4-5", 1.5), ("cycloidal", 1.5), ("4-5-6-7", 2.0)]
)
def test_curvature_from_three_points_converges_as_the_lift_is_smooth(
    law: str, order: float
) -> None:
    """A jump of the acceleration spoils two points of n by what does not fall, and so on."""
    found = climbed(CAM.format(law=law), "cam")
    assert found.ladders["cam"].order == order
    assert found.order("cam") == pytest.approx(order, abs=0.1)


def test_stages_of_a_cam_have_order_two() -> None:
    found = climbed(CAM.format(law="4-5-6-7"), "outline", "solid", "contact")
    for stage in ("outline", "solid", "contact"):
        assert found.order(stage) == pytest.approx(2.0, abs=0.1)


@pytest.mark.slow
def test_the_solid_of_a_cam_in_space_has_order_one_in_points_of_its_surface() -> None:
    """Twice as many in both directions make the error a quarter; its volume is stated so well."""
    text = Path("profiles/cylinder_cam.toml").read_text("utf-8").replace('["developed"]', "[]")
    found = climbed(f'name = "cylinder"\n{text}', "solid")
    assert found.order("solid") == pytest.approx(1.0, abs=0.1)
    own = next(rung for rung in found.of("solid") if rung.own)
    assert own.error == pytest.approx(built(f'name = "cylinder"\n{text}').volume_error, rel=0.2)


def test_the_lift_from_a_profile_is_off_by_no_more_than_its_chords_explain() -> None:
    result = built(CAM.format(law="4-5-6-7"))
    ladder = cam_ladders.LADDERS["contact"](result)
    for level in ladder.levels:
        error, _ = ladder.measure(ladder.make(level))
        assert 0.1 * level < error < 1.5 * level


def test_chords_of_a_circle_are_off_by_their_height() -> None:
    """The profile of the eccentric is a circle of 31 mm: a chord's height is in its angle."""
    result = gearcam.build(gearcam.load("profiles/eccentric_cam.toml"))
    wall = result.cam.walls[0]
    error, count = chord_distance(wall.sampler)
    x, y = wall.outline.T
    assert count == len(x)
    chords = np.hypot(x - np.roll(x, 1), y - np.roll(y, 1))
    heights = 31.0 * (1.0 - np.cos(np.arcsin(chords / 62.0)))
    assert error == pytest.approx(heights.max(), rel=1e-6)


def test_the_error_of_the_own_outline_is_what_the_result_says_of_it() -> None:
    result = built(PAIR)
    own = next(rung for rung in accuracy(result, ["outline"], repeat=1).rungs if rung.own)
    assert own.level == 0.001
    told = max(gear.profile.chord_error for gear in result.gears)
    assert own.error == pytest.approx(told, rel=0.03)
    assert own.points == sum(len(gear.outline) for gear in result.gears)


def test_an_oscillating_follower_is_told_in_degrees() -> None:
    """Its lever makes of them what the chords of the profile are off."""
    result = gearcam.build(gearcam.load("profiles/plate_cam_oscillating.toml"))
    ladder = cam_ladders.LADDERS["contact"](result)
    assert ladder.unit == "deg"
    error, _ = ladder.measure(ladder.make(0.016))
    assert 0.1 * 0.016 < math.radians(error) * result.design.follower.arm < 2.0 * 0.016
