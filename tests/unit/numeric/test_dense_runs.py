"""Dense runs are as near to the true curve as they promise, also where its curvature jumps."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.gears.flank import trace
from gearcam.numeric import sampling
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.hermite import on_cubics
from gearcam.numeric.sampling import Sampler, sags
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
        lines = [LineString(as_pairs(run.points)) for run in outline.contour.runs]
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
                steps = np.diff(run.points)
                tangents = run.tangents
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


@dataclass(frozen=True)
class Rounded:
    """One curve: straight as far as 0, where a unit circle begins."""

    start: np.ndarray
    end = np.array([0.8])
    corner = np.array([True])
    breaks = np.array([0]), np.array([0.0])

    def at(self, index: np.ndarray, parameter: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        del index  # there is one curve
        side, angle = np.minimum(parameter, 0.0), np.maximum(parameter, 0.0)
        return side + np.sin(angle) + 1j * (1 - np.cos(angle)), np.exp(1j * angle)


@pytest.mark.parametrize("before", [1.0, 3.3, 7.7])
def test_between_dense_points_are_cubics_where_the_curvature_jumps_too(before: float) -> None:
    """So are fits measured: a step across the jump would hide the bend in a cubic of its own."""
    tolerance = 1e-3
    curves = Rounded(np.array([-before]))
    (run,) = Sampler(curves=curves, tolerance=tolerance, closed=False).dense(6).runs()
    p, t = run.points, run.tangents
    assert np.abs(p).min() < 1e-9
    steps = np.repeat(np.arange(len(p) - 1), 9)
    places = on_cubics(p, t, steps, np.tile(np.arange(1, 10) / 10, len(p) - 1))[0]
    off = np.where(places.real < 0, np.abs(places.imag), np.abs(np.abs(places - 1j) - 1))
    assert off.max() < 1e-3 * tolerance


@pytest.mark.parametrize("tangent", [1.0, -1.0])
def test_a_curve_that_runs_backwards_leaves_its_chords_no_farther(tangent: float) -> None:
    """Undercut: halving its chords would make no sag smaller."""
    at = np.exp(1j * np.linspace(0.0, 1.0, 9))
    found = sags(at, 1j * tangent * at, np.full(9, 2))
    np.testing.assert_allclose(found, 1.0 - math.cos(1.0 / 16.0), rtol=2e-3)


def test_chords_that_measuring_asks_for_are_counted_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the density promises is less than what the jump takes."""
    monkeypatch.setattr(sampling, "_MEASURED", 1.0)
    curves = Rounded(np.array([-3.3]))
    every = Sampler(curves=curves, tolerance=1e-5, closed=False)
    count = len(every.chords[0]) - 1
    assert every.least < 93 < count
    with pytest.raises(InfeasibleError, match="chords") as refused:
        _ = Sampler(curves=curves, tolerance=1e-5, closed=False, most=93).chords
    assert refused.value.where == "output.chord_tolerance_mm"


class Point(Rounded):
    """A curve that stays in a place: rounding makes the narrowest ones such."""

    def at(self, index: np.ndarray, parameter: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        del index
        return np.ones(len(parameter), dtype=complex), np.ones(len(parameter), dtype=complex)


@pytest.mark.filterwarnings("error")
def test_chords_of_no_length_have_an_error_too() -> None:
    made = Sampler(curves=Point(np.array([-2.0])), tolerance=1e-3)
    _, points, error = made.chords
    assert (points == 1.0).all()
    assert error == 0.0
