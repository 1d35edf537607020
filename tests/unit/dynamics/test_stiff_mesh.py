"""Stiffness and play of a mesh: sums of springs, closed forms of involutes, smooth functions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.dynamics import mesh_stiffness as room
from gearcam.dynamics.mesh_stiffness import Smooth, backlash_angle, mesh_stiffness, secant_stiffness
from gearcam.meshing.about_to_touch import about_to_touch
from gearcam.meshing.contact import contacts
from gearcam.numeric.roots import bracketed_root

TURN = 2.0 * math.pi
ALPHA = math.radians(20.0)

PAIR = """
kind = "gear-pair"
name = "pair"
law = {{ type = "ellipse", eccentricity = {eccentricity} }}
pair = {{ module_mm = 4, teeth = [41, 41], backlash_mm = {backlash}, face_width_mm = 10 }}
output = {{ files = ["csv"] }}
"""


def built(eccentricity: float, backlash: float) -> Any:
    text = PAIR.format(eccentricity=eccentricity, backlash=backlash)
    return gearcam.build(gearcam.loads(text))


def sides(eccentricity: float, backlash: float) -> Any:
    return built(eccentricity, backlash).subject.sides


def test_springs_that_close_one_after_the_other_carry_the_load() -> None:
    draw = np.random.default_rng(1)
    count, most = 40, 4
    lever, gap = draw.uniform(20, 80, (count, most)), draw.uniform(0, 0.02, (count, most))
    gap[:, 0] = 0.0
    load = 10.0 ** draw.uniform(3, 7, count)
    step = np.repeat(np.arange(count), most)
    made, lag = secant_stiffness(step, lever.ravel(), gap.ravel(), 1e5, load)

    def left(e: np.ndarray) -> np.ndarray:
        return (1e5 * lever**2 * np.maximum(e[:, None] - gap / lever, 0.0)).sum(axis=1) - load

    found = bracketed_root(left, np.zeros(count), load / (1e5 * lever[:, 0] ** 2), 1e-16)
    assert lag == pytest.approx(found, rel=1e-9)
    assert made == pytest.approx(load / lag)
    carrying = (lag[:, None] > gap / lever).sum(axis=1)
    assert set(carrying.tolist()) >= {1, 2, 3, 4}


def test_a_phase_without_teeth_has_no_stiffness() -> None:
    step, lever = np.array([0, 2]), np.array([40.0, 40.0])
    made, lag = secant_stiffness(step, lever, np.zeros(2), 1e5, np.full(3, 1e4))
    assert made.tolist() == pytest.approx([1.6e8, 0.0, 1.6e8])
    assert not np.isfinite(lag[1])


def test_a_light_load_leaves_the_sum_of_the_pairs_that_touch() -> None:
    """Circular wheels: the lever is the base radius."""
    drive = sides(0.0, 0.0)[1]
    phi1 = np.linspace(0.0, TURN, 200, endpoint=False)
    made = mesh_stiffness(drive, phi1, 14.0, 10.0, 1e-6)
    base = 82.0 * math.cos(ALPHA)
    one = 14.0 * 10.0 * 1e3 * base**2 * 1e-3
    touching = np.bincount(contacts(drive, phi1).step, minlength=200)
    assert made == pytest.approx(one * touching, rel=1e-6)
    assert set(touching.tolist()) == {1, 2}


def test_under_load_stiffness_does_not_jump() -> None:
    """The secant stiffness falls continuously as a pair leaves; the sum of pairs halves at once."""
    drive = sides(0.0, 0.0)[1]

    def largest_step(count: int, load: float) -> float:
        phi1 = np.linspace(0.0, TURN / 41, count)
        made = mesh_stiffness(drive, phi1, 14.0, 10.0, load)
        return float(np.abs(np.diff(made)).max() / made.max())

    assert largest_step(4000, 1e-6) > 0.4
    assert largest_step(4000, 2000.0) < 0.02
    assert largest_step(4000, 2000.0) < 0.3 * largest_step(1000, 2000.0)


def test_a_mesh_that_does_not_touch_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    drive = sides(0.0, 0.0)[1]
    none = contacts(drive, np.zeros(0))
    monkeypatch.setattr(room, "contacts", lambda *_: none)
    monkeypatch.setattr(room, "about_to_touch", lambda *_: about_to_touch(drive, [], none, 1.0))
    with pytest.raises(InfeasibleError, match="no teeth touch"):
        mesh_stiffness(drive, np.linspace(0.0, 1.0, 100), 14.0, 10.0, 100.0)


def test_the_play_of_circular_wheels_is_the_backlash_over_the_radius() -> None:
    phi1 = np.linspace(0.0, TURN, 50)
    assert backlash_angle(sides(0.0, 0.01), phi1) == pytest.approx(0.01 / 82.0, rel=1e-5)
    assert backlash_angle(sides(0.0, 0.0), phi1) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("backlash", [0.1, 0.01])
def test_the_play_of_other_wheels_has_the_levers_of_both_normals(backlash: float) -> None:
    """Half the backlash, normal to either flank, over the lever of this flank's normal."""
    result, phi1 = built(0.5, backlash), np.linspace(0.0, TURN, 50)
    both, distance = result.subject.sides, result.pair.rolling.center_distance
    closed = np.zeros(50)
    for side in both:
        found, lever = contacts(side, phi1), np.zeros(50)
        lever[found.step] = found.lever[1]
        closed += 0.5 * backlash * math.cos(ALPHA) / lever
    found = backlash_angle(both, phi1)
    assert found == pytest.approx(closed, rel=0.01 * backlash)
    # not the backlash over the radius: pitch curves lie askew to the line of centres
    of_radius = found * distance / (1.0 + result.law.ratio(phi1)) / backlash
    assert of_radius.min() == pytest.approx(1.0, abs=1e-3)
    assert of_radius.max() > 1.2


def test_a_smooth_function_has_two_continuous_derivatives_and_repeats() -> None:
    x = np.linspace(0.0, TURN, 36, endpoint=False)
    made = Smooth(x, np.exp(np.cos(x)), TURN)
    near = 1e-9
    for order in (0, 1, 2):
        at = made.knots
        below, above = made(at - near, order), made(at + near, order)
        assert below == pytest.approx(above, abs=1e-7)
    y = np.linspace(-3.0, 9.0, 500)
    missed = np.abs(made(y) - np.exp(np.cos(y))).max()
    assert missed < made.error < 100.0 * missed
    assert made(y, 1) == pytest.approx(-np.sin(y) * np.exp(np.cos(y)), abs=1e-2)
    assert made(y + TURN) == pytest.approx(made(y), rel=1e-12)


@pytest.mark.parametrize("count", [20, 21])
def test_an_open_function_ends(count: int) -> None:
    x = np.linspace(0.0, 2.0, count)
    made = Smooth(x, np.exp(x), None)
    y = np.linspace(0.0, 2.0, 300)
    missed = np.abs(made(y) - np.exp(y)).max()
    assert missed < made.error
    assert made.knots[[0, -1]].tolist() == [0.0, 2.0]
