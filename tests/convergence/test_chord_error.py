"""Outlines keep their tolerance, with no more points than the curvature asks for.

What the sampler says of itself is not believed: chords are measured at 40 places each, against a
much finer outline too, and the points that curvature asks for come from turning angles of that
finer outline.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from shapely import LinearRing

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.gears.outline import Outline
from gearcam.gears.track import Wheel
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import polygon_area
from helpers_pairs import job, profile
from helpers_sampling import few
from witness.distance import distances

FINE = 1e-6
"""Tolerance of the outline that stands for the true curve, modules."""

CORNER = 0.02
"""Turning angle from which a vertex of the finest outline is a corner: smooth ones turn 0.005."""

TOLERANCES = [1 / 5000, 1 / 2000, 1 / 1000, 1 / 500, 1 / 200, 1 / 100, 1 / 50]
"""Modules."""

NAMES = ["ellipse", "circular", "nail", "peanut"]
WHEELS: list[Wheel] = [1, 2]

both = pytest.mark.parametrize(  # one wheel of each pair is run each time
    ("name", "wheel"),
    few((name, WHEELS[(k + j) % 2]) for k, name in enumerate(NAMES) for j in (0, 1)),
)


@cache
def finest(name: str, wheel: Wheel) -> Outline:
    """The outline of a wheel at the finest tolerance."""
    if name == "nail":
        made = profile("nail_machine_two_phase")
    elif name == "ellipse":
        made = job(Ellipse(eccentricity=0.3), (24, 24))
    elif name == "circular":
        made = job(Constant(), (20, 30))
    else:
        made = job(Formula(r1="1 + 0.3*cos(2*phi1)"), (48, 48))
    return at(made.gears[wheel - 1].profile, FINE * made.pair.module)


def at(outline: Outline, tolerance: float) -> Outline:
    """The same wheel at another tolerance, mm."""
    return replace(outline, tolerance=tolerance)


def module(outline: Outline) -> float:
    """Module, mm."""
    return outline.toothing.pitch / np.pi


class Demand(NamedTuple):
    """What a curve asks for."""

    root: float
    """Integral of sqrt(kappa/8) ds: chords times sqrt(tolerance)."""
    corners: int


@cache
def demand(name: str, wheel: Wheel) -> Demand:
    """Points that curvature asks for, by finite differences of the finest outline."""
    points = finest(name, wheel).points
    steps = np.diff(points, append=points[0])
    turning = np.abs(np.angle(steps * np.conj(np.roll(steps, 1))))
    length = 0.5 * (np.abs(steps) + np.abs(np.roll(steps, 1)))
    smooth = turning < CORNER
    # kappa*ds = turning, so that sqrt(kappa/8) ds = sqrt(turning*ds/8).
    return Demand(
        float(np.sqrt(turning[smooth] * length[smooth] / 8.0).sum()), int((~smooth).sum())
    )


@both
def test_vertices_lie_on_the_true_curve(name: str, wheel: Wheel) -> None:
    fine = finest(name, wheel)
    m = module(fine)
    vertices, ring = as_pairs(at(fine, m / 1000).points), LinearRing(as_pairs(fine.points))
    assert distances(vertices, ring).max() <= 1.01 * FINE * m
    off = vertices.copy()
    off[7] *= 1 + 1e-6
    assert distances(off, ring)[7] > 2 * FINE * m


@both
@pytest.mark.parametrize("part", few(TOLERANCES))
def test_no_chord_is_farther_off_than_the_tolerance(name: str, wheel: Wheel, part: float) -> None:
    fine = finest(name, wheel)
    tolerance = part * module(fine)
    outline = at(fine, tolerance)
    vertices = outline.sampler.chords[0]
    inner = np.linspace(0.0, 1.0, 42)[1:-1, None]
    curve = outline.sampler.at((vertices[:-1] + inner * np.diff(vertices)).ravel())[0]
    first = outline.points[::-1] if wheel == 2 else outline.points
    chord = np.roll(first, -1) - first
    off = np.abs(np.imag(np.conj(chord) * (curve.reshape(40, -1) - first)) / np.abs(chord))
    assert off.max() <= tolerance
    # What the summary states is what one finds with ten times the places.
    assert off.max() == pytest.approx(outline.chord_error, rel=0.05)
    assert outline.chord_error <= tolerance


@both
@pytest.mark.parametrize("part", few([1 / 500, 1 / 5000, 1 / 50], 3))
def test_the_finest_outline_lies_within_the_tolerance(name: str, wheel: Wheel, part: float) -> None:
    fine = finest(name, wheel)
    tolerance = part * module(fine)
    worst = distances(as_pairs(fine.points), LinearRing(as_pairs(at(fine, tolerance).points))).max()
    assert 0.5 * tolerance <= worst <= tolerance


@both
@pytest.mark.parametrize("part", TOLERANCES)
def test_few_points_more_than_curvature_asks_for(name: str, wheel: Wheel, part: float) -> None:
    fine = finest(name, wheel)
    asked = demand(name, wheel)
    least = asked.root / np.sqrt(part * module(fine))
    # A coarse tolerance leaves short stretches no choice: one chord each is the least there is.
    spare = asked.corners if part > 1 / 200 else 0
    assert 0.97 * least <= len(at(fine, part * module(fine)).points) <= 1.3 * least + spare


@both
def test_what_the_summary_calls_the_least_is_the_least(name: str, wheel: Wheel) -> None:
    fine = finest(name, wheel)
    tolerance = module(fine) / 1000
    least = demand(name, wheel).root / np.sqrt(tolerance)
    assert at(fine, tolerance).sampler.least == pytest.approx(least, rel=0.03)


@both
def test_corners_are_where_tips_begin_and_end(name: str, wheel: Wheel) -> None:
    """And where undercut has trimmed a flank, if it took so much that a kink is left."""
    fine = finest(name, wheel)
    trimmed = int(np.isfinite(fine.flanks.cusps.dedendum).sum())
    tips = 2 * fine.toothing.teeth
    assert tips <= demand(name, wheel).corners <= tips + trimmed


@both
def test_the_area_converges_with_the_tolerance(name: str, wheel: Wheel) -> None:
    """Slope 1 in the tolerance, which is 2 in the length of chords."""
    fine = finest(name, wheel)
    parts = np.geomspace(3e-3, 3e-5, 7)
    areas = [polygon_area(at(fine, part * module(fine)).points) for part in parts]
    errors = np.abs(np.array(areas) - polygon_area(fine.points))
    slope = np.polyfit(np.log(parts), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.1)


def test_more_chords_than_a_million_are_refused_with_the_tolerance_that_has_so_many() -> None:
    text = """
kind = "gear-pair"
name = "fine"
law = { type = "ellipse", eccentricity = 0.3 }
pair = { module_mm = 2, teeth = [400, 400] }
output = { files = ["csv"], chord_tolerance_mm = %r }
"""
    with pytest.raises(InfeasibleError, match="chords") as refused:
        _ = gearcam.build(gearcam.loads(text % 2.5e-9)).gear1
    limit = refused.value.limit
    assert limit is not None
    sampler = gearcam.build(gearcam.loads(text % (100.0 * limit))).gear1.profile.sampler
    assert sampler.least == pytest.approx(1e5, rel=0.01)  # as the root of the tolerance


STEEP = """
kind = "cam"
name = "steep"
motion = [
    { type = "segment", to_deg = 19.9, angle_deg = 76.9378 },
    { type = "segment", to_deg = 13.2, angle_deg = 91.9324 },
    { type = "segment", to_deg = 0, angle_deg = 75.5386 },
    { type = "dwell", angle_deg = 115.59119999999999 },
]
[follower]
type = "roller"
roller_radius_mm = 0.0435
pivot_distance_mm = 0.516
motion = "oscillating"
arm_mm = 0.532
[cam]
prime_radius_mm = 0.2
[output]
chord_tolerance_mm = 9e-06
"""


def test_dense_points_lie_densely_where_the_curve_is_fast_within_a_chord() -> None:
    sampler = gearcam.build(gearcam.loads(STEEP)).cam.walls[0].sampler
    dense = sampler.dense(8)
    shares = np.linspace(0.0, 1.0, 41)[1:-1]
    places = dense.places[:-1, None] + np.diff(dense.places)[:, None] * shares
    seen = sampler.at(places.ravel())[0].reshape(places.shape)
    chord = np.diff(dense.points)[:, None]
    off = np.abs(((seen - dense.points[:-1, None]) * np.conj(chord / abs(chord))).imag)
    assert off.max() <= sampler.tolerance / 32.0


COARSE = """
kind = "cam"
name = "coarse"
motion = [
    { type = "rise", law = "2-3", lift_mm = 0.004, angle_deg = 92.752 },
    { type = "return", law = "2-3", angle_deg = 267.248 },
]
[follower]
type = "domed"
dome_radius_mm = 0.3
[cam]
prime_radius_mm = 1.0
[output]
chord_tolerance_mm = 0.6
"""


def test_a_closed_curve_has_eight_chords_at_least() -> None:
    result = gearcam.build(gearcam.loads(COARSE))
    assert 8 <= len(result.profile.vertices) <= 12
    assert result.profile.chord_error < 0.704 * (1.0 - np.cos(np.pi / 8))
    assert result.follow(result.profile.vertices).facts["followed.error"] < 0.2
