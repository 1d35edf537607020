"""Whatever ring is asked for: a wheel that turns in it, or a way to one that does.

Whole outlines over all turns, by polygons, against what the findings say.
"""

from __future__ import annotations

import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.kinds.gear_pair.result import GearPairResult
from helpers_rings import CHORDS, overlap, random_ring, ring
from helpers_sampling import few

PATIENCE = 60.0
"""Seconds for a way out: much more than anybody waits, on a machine with other work."""

CLEAR = -0.05
"""Margin, in modules, from which outlines overlap visibly though tips are rounded."""

COARSE = 5e-3
"""Chord tolerance, in modules, with which ways out are sought: they are proven with a fine one."""

QUICK = [2, 5, 6, 7, 10, 13, 14, 16]
"""Designs of which few need a way out: the search takes seconds."""


def errors_of(result: GearPairResult) -> set[str]:
    return {found.code for found in result.findings if found.severity == "error"}


def traced(result: GearPairResult, chords: float) -> GearPairResult:
    """The same to another chord tolerance, in modules."""
    module = result.design.pair.module
    assert module is not None
    return gearcam.build(result.design.with_({"output.chord_tolerance_mm": chords * module}))


def demand_fit_or_way(result: GearPairResult) -> str:
    """What came of a design: it fits, or has an error or a refusal, and its ways out fit."""
    try:
        errors = errors_of(result)
    except InfeasibleError as error:
        errors = {f"refused: {error}"}
    else:
        if not errors:
            assert overlap(result) == 0.0
            return "fits"
        found = result.subject.tip_pass
        assert found is not None
        if "tips-collide" not in errors:
            assert overlap(result) == 0.0
        elif found.margin < CLEAR * result.pair.module:
            assert overlap(result, found.phi1) > 0.0
    ways = gearcam.remedies(traced(result, COARSE), patience=PATIENCE).found
    assert ways, errors
    for way in ways[:2]:
        other = traced(gearcam.build(way.design), CHORDS)  # type: ignore[arg-type]
        assert not errors_of(other), way.changes
        assert overlap(other) == 0.0, way.changes
    return min(errors)[:12]


@pytest.mark.parametrize("seed", few(QUICK))
def test_a_ring_fits_or_has_a_way_out(seed: int) -> None:
    demand_fit_or_way(random_ring(seed))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(300))
def test_every_ring_fits_or_has_a_way_out(seed: int) -> None:
    demand_fit_or_way(random_ring(seed))


@pytest.mark.parametrize("teeth", few([((28, 36),), ((40, 48),), ((28, 35),)], 3))
def test_circles_of_small_differences(teeth: tuple[int, int]) -> None:
    result = ring({"type": "constant"}, teeth, output={"chord_tolerance_mm": CHORDS})
    demand_fit_or_way(result)
