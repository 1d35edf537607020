"""The stages that compare methods of integration are for elastic wheels in motion."""

from __future__ import annotations

import pytest

import gearcam
from gearcam.results.accuracy import accuracy, stages_of

pytest.importorskip("scipy")

PAIR = """
kind = "gear-pair"
name = "pair"
law = { type = "ellipse", eccentricity = 0.2 }
pair = { module_mm = 2, teeth = [17, 17], face_width_mm = 10 }
output = { files = ["csv"] }
"""
ELASTIC = PAIR + "dynamics = { inertia_kg_m2 = [0.1, 0.1], stiffness_n_mm_um = 14 }\n"

WORK = {"radau": 2.0, "lsoda": 1.25, "dop853": 1.0}
"""Time of an evaluation with all that belongs to it, at least, over that in DOP853."""


def test_only_elastic_wheels_have_the_stages() -> None:
    assert not [one for one in stages_of(gearcam.loads(PAIR)) if one.startswith("dynamics")]
    found = [one for one in stages_of(gearcam.loads(ELASTIC)) if one.startswith("dynamics")]
    assert found == [f"dynamics_{one}" for one in ("free", "rattle", "driven", "slow")]
    with pytest.raises(gearcam.DesignError, match="not a stage"):
        stages_of(gearcam.loads(PAIR), ["dynamics_free"])


@pytest.mark.slow
@pytest.mark.parametrize("trial", ["free", "rattle", "driven", "slow"])
def test_errors_fall_with_the_tolerance_and_no_method_beats_auto(trial: str) -> None:
    stage = f"dynamics_{trial}"
    made = accuracy(gearcam.build(gearcam.loads(ELASTIC)), [stage], 1)
    auto = made.of(stage)
    errors = [rung.error for rung in auto]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 1e-5
    assert auto[-1].own
    others = [rung for by in made.ladders[stage].others for rung in made.of(stage, by)]
    assert len(others) == 12
    for rung in auto:
        better = [one for one in others if one.error < 0.9 * rung.error]
        assert all(WORK[one.by] * one.points > 0.9 * rung.points for one in better), rung
