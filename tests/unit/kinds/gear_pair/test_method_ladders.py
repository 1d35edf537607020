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


def test_only_elastic_wheels_have_the_stages() -> None:
    assert not [one for one in stages_of(gearcam.loads(PAIR)) if one.startswith("dynamics")]
    found = [one for one in stages_of(gearcam.loads(ELASTIC)) if one.startswith("dynamics")]
    assert found == [f"dynamics_{one}" for one in ("auto", "radau", "bdf", "lsoda", "dop853")]
    with pytest.raises(gearcam.DesignError, match="not a stage"):
        stages_of(gearcam.loads(PAIR), ["dynamics_auto"])


@pytest.mark.slow
def test_errors_fall_with_the_tolerance_and_auto_is_as_good_as_the_best() -> None:
    made = accuracy(gearcam.build(gearcam.loads(ELASTIC)), ["dynamics_auto", "dynamics_dop853"], 1)
    for stage in made.ladders:
        errors = [rung.error for rung in made.of(stage)]
        assert errors == sorted(errors, reverse=True)
        assert errors[-1] < 1e-5
    auto, explicit = (made.of(stage)[-1] for stage in made.ladders)
    assert auto.own
    assert auto.points < 0.5 * explicit.points
    assert auto.error < 2.0 * explicit.error
