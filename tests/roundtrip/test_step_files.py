"""STEP files of real wheels: one face for each piece of the outline, and the volume of the part."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gearcam.kinds.gear_pair.design import PairOutputSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.parts.blank import Blank
from helpers_pairs import profile
from helpers_sampling import few
from helpers_step import read_step


@pytest.fixture(scope="module")
def job() -> GearPairResult:
    design = replace(
        profile("circular").design,
        blank=Blank(bore_diameter=(8.0, 8.0), timing_marks=False),
        output=PairOutputSpec(files=("step",), pose=0.7),
    )
    return GearPairResult(design)


@pytest.fixture(scope="module")
def files(job: GearPairResult) -> dict[str, bytes]:
    return job.files("step")


@pytest.mark.parametrize("number", few([0, 1]))
def test_a_spur_wheel_has_a_face_for_each_flank_piece(
    job: GearPairResult, files: dict[str, bytes], number: int
) -> None:
    part, teeth = job.parts[number], job.pair.teeth[number]
    (solid,) = read_step(files[f"{part.name}.step"])
    # two flanks, two fillets, a land and a tip a tooth; both ends; the bore
    assert sum(solid.faces.values()) == 6 * teeth + 2 + 1
    assert solid.faces["bspline"] == 6 * teeth
    assert solid.faces["cylinder"] == 1
    assert solid.volume == pytest.approx(part.volume, rel=1e-6)


def test_the_pair_stands_assembled(job: GearPairResult, files: dict[str, bytes]) -> None:
    one, two = read_step(files["pair.step"])
    assert [one.name, two.name] == ["gear1", "gear2"]
    width = job.design.pair.face_width
    shift = job.pair.center_distance
    assert one.center == pytest.approx([0.0, 0.0, width / 2], abs=1e-5)
    assert two.center == pytest.approx([shift, 0.0, width / 2], abs=1e-5)
    reach = np.hypot(*job.parts[0].contour.vertices.T).max()
    assert one.bounds[1][0] <= reach + 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(("name", "bore"), [("formula", 8.0), ("nail_machine_two_phase", 40.0)])
def test_a_non_circular_wheel_keeps_its_volume(name: str, bore: float) -> None:
    """Smaller wheels do so in the test of rings as STEP solids."""
    design = replace(
        profile(name).design,
        output=PairOutputSpec(files=("step",)),
        blank=Blank(bore_diameter=(bore, 0.0), tip_rounding=(0.3, 0.0)),
    )
    job = GearPairResult(design)
    made = job.files("step")
    for part in job.parts:
        (solid,) = read_step(made[f"{part.name}.step"])
        assert solid.volume == pytest.approx(part.volume, rel=1e-6)
