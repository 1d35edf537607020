"""Whatever ring is asked for: a wheel that turns in it, or a way to one that does.

Whole outlines over all turns, by polygons, against what the findings say.
"""

from __future__ import annotations

import pytest

import gearcam
from gearcam.errors import InfeasibleError
from helpers_rings import overlap, random_ring

PATIENCE = 60.0
"""Seconds for a way out: much more than anybody waits, on a machine with other work."""

CLEAR = -0.05
"""Margin, in modules, from which outlines overlap visibly though tips are rounded."""


def demand_fit_or_way(seed: int) -> str:
    """What came of a design: it fits, or has an error or a refusal, and its ways out fit."""
    result, refusal = random_ring(seed), None
    try:
        errors = {found.code for found in result.findings if found.severity == "error"}
    except InfeasibleError as error:
        refusal, errors = error, {"refused"}
    if not errors:
        assert overlap(result) == 0.0
        return "fits"
    if "tips-collide" in errors:
        found = result.subject.tip_pass
        assert found is not None
        if found.margin < CLEAR * result.pair.module:
            assert overlap(result, found.phi1) > 0.0
    elif refusal is None:
        assert overlap(result) == 0.0
    ways = gearcam.remedies(result, refusal, patience=PATIENCE).found
    assert ways, f"{sorted(errors)}: {refusal}"
    for way in ways[:2]:
        other = gearcam.build(way.design)
        assert overlap(other) == 0.0, way.changes  # type: ignore[arg-type]
    return min(errors)


@pytest.mark.parametrize("seed", range(12))
def test_a_ring_fits_or_has_a_way_out(seed: int) -> None:
    demand_fit_or_way(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12, 300))
def test_every_ring_fits_or_has_a_way_out(seed: int) -> None:
    demand_fit_or_way(seed)
