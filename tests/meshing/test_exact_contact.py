"""Exact contact and first touch of non-circular wheels: dense points and finite differences."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import touches
from gearcam.meshing.patches import patches
from helpers_pairs import dense_touch, job, profile, shifted
from helpers_sampling import few


@cache
def samples() -> tuple[GearPairResult, ...]:
    return (
        profile("nail_machine_two_phase"),
        profile("nail_machine_three_phase"),
        job(Ellipse(eccentricity=0.3), (24, 24), module=2.0),
    )


NAMES = ["two phases", "three phases", "ellipse"]


def touched(made: GearPairResult, side: int, phi1: np.ndarray, distance: complex) -> np.ndarray:
    """The driven wheel's turn at first touch, by dense points."""
    phi2 = made.law.phi2(phi1)
    pairs = zip(phi1.tolist(), phi2.tolist(), strict=True)
    return np.array([dense_touch(made, side, *both, distance, internal=False) for both in pairs])


@pytest.mark.parametrize("made", samples(), ids=NAMES)
@pytest.mark.parametrize("side", few([DRIVE, COAST]))
@pytest.mark.parametrize("more", few([0.1, 0.0, -0.1], 3))
def test_first_touch_is_that_of_dense_points(made: GearPairResult, side: int, more: float) -> None:
    phases = np.linspace(0.1, 6.2, 23)
    distance = made.pair.center_distance + more
    found = touches(flank_pairs(made.gears, side, distance), phases)
    outward = np.full(len(phases), -np.inf)
    np.maximum.at(outward, found.step, -side * found.turn)
    expected = touched(made, side, phases, distance)
    assert -side * outward == pytest.approx(expected, abs=1e-7)
    if more == 0.0:
        assert np.abs(outward).max() < 1e-9


@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_a_flank_moved_by_20_um_turns_the_driven_wheel_by_20_um_over_its_lever(side: int) -> None:
    made = profile("nail_machine_two_phase")
    pairs = flank_pairs(made.gears, side)
    phi = made.pair.rolling.arc.angle(pairs.wheels[0].toothing.tooth_places[9:10])
    moved = touches(shifted(pairs, 10, side * 0.02), phi)
    exact = contacts(pairs, phi)
    lever = exact.lever[1][exact.pair == 9]
    assert len(lever) == 1
    turn = moved.turn[moved.pair == 9]
    normal = 0.02 * math.cos(made.pair.rack.pressure_angle)
    assert turn == pytest.approx(-side * normal / lever, rel=2e-3)


@pytest.mark.parametrize("made", samples(), ids=NAMES)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_sliding_is_the_difference_of_the_arcs_travelled(made: GearPairResult, side: int) -> None:
    pairs = flank_pairs(made.gears, side)
    phases, step = np.linspace(0.1, 6.2, 41), 1e-5
    middle = contacts(pairs, phases)
    before, after = (contacts(pairs, phases + d) for d in (-step, step))
    keys = [list(zip(c.step.tolist(), c.pair.tolist(), strict=True)) for c in (before, after)]
    checked = 0
    for k, key in enumerate(zip(middle.step.tolist(), middle.pair.tolist(), strict=True)):
        if not all(key in known for known in keys):
            continue
        (a, b), phi = (known.index(key) for known in keys), phases[key[0]]
        tangent = middle.force[k] * 1j  # along the flanks
        arcs = []
        for wheel in (1, 2):
            ends = []
            for found, n, angle in ((before, a, phi - step), (after, b, phi + step)):
                axis = 0.0 if wheel == 1 else made.pair.center_distance
                turn = angle if wheel == 1 else -float(made.law.phi2(angle))
                now = phi if wheel == 1 else -float(made.law.phi2(phi))
                ends.append((found.point[n] - axis) * np.exp(1j * (turn - now)))
            arcs.append(float(np.real((ends[1] - ends[0]) * np.conj(tangent))) / (2.0 * step))
        outward = np.sign(np.real(tangent * np.conj(middle.point[k])))
        difference = outward * (arcs[0] - arcs[1])
        assert middle.sliding[k] == pytest.approx(difference, abs=2e-4)
        for wheel in (0, 1):
            own = (arcs[0] - arcs[1]) * (1.0 if wheel == 0 else -1.0) / arcs[wheel]
            if abs(arcs[wheel]) > 1.0:
                assert middle.specific[wheel, k] == pytest.approx(own, abs=2e-4)
        checked += 1
    assert checked > 40


@pytest.mark.parametrize("made", samples(), ids=NAMES)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_counts_arcs_and_contacts_agree(made: GearPairResult, side: int) -> None:
    pairs = flank_pairs(made.gears, side)
    phases = np.random.default_rng(7).uniform(0.0, 2.0 * math.pi, 500)
    number = pairs.arcs.carrying(phases)
    assert np.array_equal(number, np.bincount(contacts(pairs, phases).step, minlength=500))
    start, end, carrying = pairs.arcs.stretches
    place = np.searchsorted(start, phases, side="right") - 1
    assert np.array_equal(number, carrying[place])
    rolling = made.pair.rolling
    weighted = (rolling.tracks[0].arc_length(end) - rolling.tracks[0].arc_length(start)) @ carrying
    assert weighted == pytest.approx(pairs.arcs.ratios.sum() * pairs.pitch, rel=1e-9)


JUMP: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "jump",
    "law": {
        "type": "three-phase-polynomial",
        "knots_deg": [0, 60.2705, 124.58, 180],
        "lowest": 0.443897,
    },
    "pair": {"module_mm": 1.09591, "teeth": [46, 69], "backlash_mm": 0.0823727},
    "blank": {"clearance_mm": 0.0329081},
    "output": {"chord_tolerance_mm": 0.00815452},
}
"""Flanks that touch across a knot where the curvature jumps by half."""


@pytest.mark.parametrize("side", few([DRIVE, COAST]))
def test_flanks_touch_across_a_jump_of_the_curvature(side: int) -> None:
    """Newton's steps went to and fro there; and of two places the one that comes first is told."""
    made = gearcam.build(gearcam.design(JUMP))
    phi1 = np.radians(np.linspace(59.0, 62.0, 601))
    pairs = flank_pairs(made.gears, side)
    found = contacts(pairs, phi1)
    assert np.all((np.diff(found.step) > 0) | (np.diff(found.pair) > 0))
    count = np.bincount(found.step, minlength=len(phi1))
    assert (count == pairs.arcs.carrying(phi1)).all()
    outward = np.full(len(phi1), -np.inf)
    np.maximum.at(outward, found.step, -side * found.lead)
    expected = -side * touched(made, side, phi1[::40], pairs.distance)
    assert outward[::40] == pytest.approx(expected, abs=1e-7)


def test_patches_beside_a_jump_of_the_curvature_are_the_overlap_of_the_outlines() -> None:
    design = gearcam.design(JUMP).with_({"output.chord_tolerance_mm": 1e-5})
    made = gearcam.build(design)
    pairs = flank_pairs(made.gears, COAST)
    phi1, lead = np.radians([60.25, 60.3, 60.4, 60.5]), 0.0027
    found = patches(pairs, phi1, 0.0, lead)
    predicted = np.bincount(found.step, found.area, minlength=len(phi1))
    one, two = (gear.outline @ [1, 1j] for gear in made.gears)
    for area, phi in zip(predicted, phi1, strict=True):
        back = np.exp(1j * (made.law.phi2(phi) + lead))
        turned = (one * np.exp(-1j * phi), two * back + pairs.distance)
        first, second = (shapely.Polygon(np.column_stack([w.real, w.imag])) for w in turned)
        assert area == pytest.approx(first.intersection(second).area, rel=0.03)
