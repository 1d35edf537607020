"""Stepped wheels: each step is a rolled copy that meshes as the first one does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.pair import Gear, leads, make_gear, stepped
from gearcam.gears.spec import StepsSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.meshing.numbers import numbers
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import study
from helpers_pairs import Assembly, explained, profile
from helpers_sampling import few


def turned(points: np.ndarray, angle: float) -> np.ndarray:
    """Points turned about the origin, counter-clockwise."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def test_the_steps_of_round_wheels_are_turned_copies() -> None:
    """Wheel 1 turns on by way/r, wheel 2 back: a closed form for circles."""
    from shapely import Polygon

    job = GearPairResult(replace(profile("circular").design, steps=StepsSpec(count=4)))
    pitch = np.pi * job.pair.module
    assert leads(job.pair, job.design.steps) == pytest.approx(pitch * np.arange(4) / 4)

    def apart(number: int, gear: Gear, sense: int) -> float:
        radius = 0.5 * job.pair.module * gear.toothing.teeth
        first = job.gears[gear.wheel - 1].outline
        copy = Polygon(turned(first, sense * number * pitch / 4 / radius))
        return copy.symmetric_difference(Polygon(gear.outline)).area / copy.length

    for number, gears in enumerate(job.steps):
        for gear, sense in zip(gears, (1, -1), strict=True):
            assert apart(number, gear, sense) < 2 * gear.profile.chord_error
            if number % 2:  # turned the wrong way it is another wheel
                assert apart(number, gear, -sense) > 0.05 * job.pair.module


@pytest.mark.parametrize("name", few(["nail_machine_two_phase", "formula"]))
def test_every_step_meshes_without_error_and_without_overlap(name: str) -> None:
    design = replace(profile(name).design, steps=StepsSpec(count=3, offset=-1.7))
    spec = MeshingSpec(steps=90)
    for gears in GearPairResult(design).steps[1:]:  # the first one is the pair without steps
        found = study(gears, spec)
        assert np.abs(found.columns["lag_rad"]).max() < 1e-9
        assert np.abs(found.columns["backlash_mm"]).max() < 1e-9
        summary = numbers(found)
        assert summary["interference_steps"] == 0
        assert summary["pairs_in_contact"]["min"] >= 1


def test_steps_that_do_not_belong_together_collide() -> None:
    """Wheel 1 of one step against wheel 2 of another: the control of the test above."""
    design = replace(profile("nail_machine_two_phase").design, steps=StepsSpec(count=3))
    job = GearPairResult(design)
    phases = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)

    def overlap(one: int, two: int) -> float:
        outlines = job.steps[one][0].outline, job.steps[two][1].outline
        assembly = Assembly(job, outlines)
        return max(assembly.overlap(float(phi)) for phi in phases)

    for step in range(3):
        assert overlap(step, step) < explained(job)
    assert overlap(0, 1) > 100 * explained(job)
    assert overlap(2, 1) > 100 * explained(job)


def test_the_default_offset_is_a_part_of_the_pitch() -> None:
    pair = profile("ellipse").pair
    pitch = np.pi * pair.module
    assert leads(pair, StepsSpec(count=5)) == pytest.approx(pitch / 5 * np.arange(5))
    assert leads(pair, StepsSpec(count=3, offset=1.2 * pitch)) == pytest.approx(
        [0.0, 0.2 * pitch, 0.4 * pitch]
    )
    assert leads(pair, StepsSpec(count=2, offset=-0.25 * pitch)) == pytest.approx(
        [0.0, 0.75 * pitch]
    )


def test_whole_pitches_change_nothing() -> None:
    pair = profile("ellipse").pair
    (_, way) = leads(pair, StepsSpec(count=2, offset=np.pi * pair.module))
    assert way == pytest.approx(0.0, abs=1e-12) or way == pytest.approx(np.pi * pair.module)
    tolerance = pair.chord_tolerance(None)
    plain = make_gear(pair, 1, tolerance, DEFAULT)
    again = make_gear(stepped(pair, np.pi * pair.module), 1, tolerance, DEFAULT)
    assert again.profile.contour.area == pytest.approx(plain.profile.contour.area, rel=1e-6)


def test_open_wheels_cannot_be_stepped() -> None:
    design = replace(profile("furnace_door").design, steps=StepsSpec(count=2))
    with pytest.raises(InfeasibleError, match="open wheels"):
        GearPairResult(design).steps  # noqa: B018


def test_a_step_that_is_not_there_is_refused_by_reading() -> None:
    from gearcam.base.errors import DesignError

    with pytest.raises(DesignError, match="no such step") as caught:
        replace(profile("formula").design, steps=StepsSpec(count=2), meshing=MeshingSpec(step=3))
    assert caught.value.problems[0].allowed == "at most steps.count = 2"
