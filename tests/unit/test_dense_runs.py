"""Dense runs are as near to the true curve as they promise, also where its curvature jumps."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.gears.flank import trace
from helpers_pairs import profile

NAMES = ["rounded_square", "log_spiral"]


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_no_place_of_the_curve_is_far_from_the_dense_points(name: str) -> None:
    """At 97 places of every row, evenly in phi1: not where the dense points were chosen."""
    from shapely import LineString, STRtree, points

    for gear in profile(name).gears:
        outline = gear.profile
        rows = outline.rows
        share = np.linspace(0.0, 1.0, 97)
        index = np.repeat(np.arange(len(rows.kind)), len(share))
        phi = rows.start[index] + np.tile(share, len(rows.kind)) * (rows.end - rows.start)[index]
        curve, _ = trace(gear.toothing, rows, index, phi)
        lines = [LineString(run.points) for run in outline.contour.runs]
        tree = STRtree(lines)
        _, away = tree.query_nearest(
            points(curve.real, curve.imag), return_distance=True, all_matches=False
        )
        assert away.max() <= outline.tolerance / 32


def test_points_and_tangents_belong_together() -> None:
    """Each tangent stands between the chords beside it; no two points fall together."""
    for name in NAMES:
        for gear in profile(name).gears:
            for run in gear.profile.contour.runs:
                steps = np.diff(run.points @ [1, 1j])
                tangents = run.tangents @ [1, 1j]
                assert np.abs(steps).min() > 1e-4 * gear.profile.tolerance
                bend = np.angle(tangents[1:] / tangents[:-1])
                lean = np.angle(steps / tangents[:-1])
                # half the turn on an arc; near a jump of the curvature it may come on one side
                assert np.abs(lean - 0.5 * bend).max() < 0.6 * np.abs(bend).max() + 1e-6


def test_joints_are_where_curves_change() -> None:
    """Six curves a tooth of a round wheel: five joints, beside the corners at both tip edges."""
    gear = profile("circular").gear1
    runs = gear.profile.contour.runs
    teeth = gear.toothing.teeth
    assert sum(len(run.pieces) for run in runs) == 6 * teeth
    assert len(runs) == 2 * teeth
