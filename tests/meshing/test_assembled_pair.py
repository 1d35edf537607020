"""The assembled wheels neither overlap nor have play, beyond what their chords explain.

The nail machine in steps of 4 degrees, among the slow tests of 1 degree (play: 2 degrees), with
outlines of 10 nm, so that what is left is the flanks'. The negative controls show that each claim
can fail: tips longer than the mate's flank, one moved tooth, a wheel off phase, another centre
distance.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.outline import build_outline
from gearcam.numeric.arrays import as_pairs
from helpers_pairs import PHASES, Assembly, profile
from helpers_sampling import few

FINE = 1e-5
"""Chord tolerance, mm."""

NAILS = ["nail_machine_two_phase", "nail_machine_three_phase"]


def allowance(chord: float) -> float:
    """Overlap area that two chord errors explain: a lens of that depth on each touching flank.

    Depth d on flanks of relative curvature k overlaps by (4/3)*d*sqrt(2*d/k); at most four flank
    pairs touch, and k is at least 1/(60 mm) here.
    """
    return 4 * (4 / 3) * (2 * chord) * math.sqrt(2 * 2 * chord * 60.0)


@pytest.mark.parametrize("name", few(NAILS))
@pytest.mark.parametrize("step", few([4, 1]))
def test_no_overlap_in_any_phase(name: str, step: int) -> None:
    made = profile(name, FINE)
    assembly = Assembly(made)
    worst = max(assembly.overlap(phi) for phi in PHASES[::step])
    assert worst <= allowance(FINE)


@pytest.mark.parametrize("name", few(NAILS))
@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("step", few([4, 2]))
def test_no_play_in_any_phase(name: str, way: int, step: int) -> None:
    """Turned by a hair (1e-6 rad, 0.1 um), the driven wheel meets the driver on either side."""
    made = profile(name, FINE)
    assembly = Assembly(made)
    hair = 4 * FINE / 51.0
    resting = [phi for phi in PHASES[::step] if assembly.overlap(phi, way * 2 * hair) == 0.0]
    assert resting == []


@pytest.mark.parametrize(("name", "phase", "least"), [(NAILS[0], 150, 1e-4), (NAILS[1], 165, 5e-3)])
def test_tips_longer_than_the_mates_flank_would_collide(
    name: str, phase: int, least: float
) -> None:
    made = profile(name, FINE)
    untreated = build_outline(made.gear1.toothing, None, FINE, DEFAULT)
    assembly = Assembly(made, (as_pairs(untreated.points), made.gear2.outline))
    worst = max(assembly.overlap(math.radians(d)) for d in range(phase - 12, phase + 13))
    assert worst > least


def test_a_moved_tooth_is_seen() -> None:
    made = profile(NAILS[0], FINE)
    outline = made.gear1.outline.copy()
    angle = np.degrees(np.arctan2(outline[:, 1], outline[:, 0]))
    radius = np.hypot(*outline.T)
    tooth = (np.abs(angle - 33.0) < 3.0) & (radius > radius.min())
    sideways = np.array([-math.sin(math.radians(33)), math.cos(math.radians(33))])
    outline[tooth] += 0.020 * sideways
    assembly = Assembly(made, (outline, made.gear2.outline))
    worst = max(assembly.overlap(phi) for phi in PHASES[15:50])
    assert worst > 100 * allowance(FINE)


def test_a_wheel_off_phase_collides() -> None:
    made = profile(NAILS[0], FINE)
    assembly = Assembly(made)
    tooth_thickness = 0.5 * made.gear2.toothing.pitch / 69.0
    assert min(assembly.overlap(phi, tooth_thickness) for phi in PHASES[::20]) > 1.0


@pytest.mark.parametrize("shift", [-0.1, 0.1])
def test_another_centre_distance_is_seen(shift: float) -> None:
    """At the knots the pitch line crosses the line of centres squarely: both sides part alike."""
    assembly = Assembly(profile(NAILS[0], FINE))
    assembly.distance += shift
    for phi in np.radians([0.0, 160.0]):
        if shift < 0:
            assert assembly.overlap(phi) > 0.05
        else:
            gap = assembly.at(phi)[0].distance(assembly.at(phi)[1])
            assert gap == pytest.approx(shift * math.sin(math.radians(20)), rel=0.05)


@pytest.mark.parametrize(
    ("law", "teeth"),
    [("ratio = 1 + 0.25*cos(phi1)", (15, 30)), ("r1 = 1 + 0.1*cos(2*phi1)", (20, 30))],
)
@pytest.mark.parametrize("count", few([25, 97]))
def test_unequal_wheels_run_without_overlap_or_play(
    law: str, teeth: tuple[int, int], count: int
) -> None:
    from gearcam.laws.ratio.formula import Formula
    from helpers_pairs import job

    name, text = law.split(" = ")
    shape: dict[str, Any] = {name: text}
    assembly = Assembly(job(Formula(**shape), teeth, module=2.0, tolerance=FINE))
    phases = np.linspace(0.0, 4 * math.pi, count)
    assert max(assembly.overlap(phi) for phi in phases) <= allowance(FINE)
    hair = 8 * FINE / 15.0
    for way in (hair, -hair):
        assert min(assembly.overlap(phi, way) for phi in phases) > 0.0
