"""Cams with phases so short that they are steps: their sizes, and what is felt of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from shapely import Polygon

from gearcam.cams.disc import DiscCam, make_cam
from gearcam.errors import InfeasibleError
from gearcam.parts.body import Part
from gearcam.parts.mass import quadrature_error
from helpers_cams import back, dwell, mechanism, program, rise
from helpers_sliding import built

TOP, FALL, LIFT = 150.0, 90.0, 10.0


def stepped(kind: str, rise_law: str, width: float, after: float) -> DiscCam:
    """A cam whose rise, of a width in degrees, begins after a dwell."""
    made = mechanism(kind)
    swings = made.oscillating
    walk = [
        rise(rise_law, width, LIFT, swings=swings),
        dwell(TOP),
        back("cycloidal", FALL),
        dwell(360.0 - TOP - FALL - width - after),
    ]
    return make_cam(program([dwell(after), *walk] if after else walk, swings=swings), made)


def rolled_step() -> float:
    """The area for a roller of 6 mm by shapely: what its disc leaves inside the pitch curve."""
    top, fall, low = (
        np.radians(np.linspace(*ends, 40001))
        for ends in ((0.0, TOP), (TOP, TOP + FALL), (TOP + FALL, 360.0))
    )
    share = (fall - fall[0]) / (fall[-1] - fall[0])
    falling = LIFT * (1.0 - share + np.sin(2.0 * math.pi * share) / (2.0 * math.pi))
    lift = np.concatenate([np.full_like(top, LIFT), falling, np.zeros_like(low)])
    around = np.concatenate([top, fall, low])
    pitch = (30.0 + lift)[:, None] * np.column_stack([np.sin(around), np.cos(around)])
    return float(Polygon(pitch).buffer(-6.0, quad_segs=2000).area)


def demand_a_step(made: DiscCam, area: float, width: float) -> None:
    """Its area by quadrature, by its polygon and by cubics, each within what is told of it."""
    size, contour = made.size, made.contour
    sector = 0.5 * contour.reach**2 * math.radians(width)  # of the rise itself
    assert abs(size.area - area) <= sector + size.area_error
    assert contour.area == pytest.approx(
        size.area, abs=contour.chord_error * size.perimeter + size.area_error
    )
    off = abs(contour.moments.area - size.area)
    part = Part(name="cam", contours=(contour,), width=1.0)
    told = quadrature_error(part, steep=True).area
    assert off <= told + size.area_error + 1e-9 * size.area


LAWS = ["constant-acceleration", "cycloidal", "4-5-6-7"]


@pytest.mark.parametrize("kind", ["roller", "swinging roller"])
@pytest.mark.parametrize("rise_law", LAWS)
def test_a_steep_rise_has_the_area_of_a_step(rise_law: str, kind: str) -> None:
    """The roller swings about the foot of the step within a tiny part of the rise."""
    area = stepped(kind, "constant-velocity", 1e-9, 0.0).size.area
    for width in (1e-3, 1e-5, 1e-7):
        made = stepped(kind, rise_law, width, 0.0)
        assert made.size.area_error <= 1e-13 * area
        demand_a_step(made, area, width)


FAR = {
    "constant-velocity": 1e-8,
    "constant-acceleration": 1e-5,
    "cycloidal": 1e-7,
    "4-5-6-7": 1e-7,
}
"""The narrowest rise of each law, in degrees."""


@pytest.mark.parametrize("rise_law", FAR)
def test_a_steep_rise_far_from_zero_knows_how_little_is_known(rise_law: str) -> None:
    """There angles are rounded to a part of the swing."""
    area = stepped("roller", "constant-velocity", 1e-9, 0.0).size.area
    assert area == pytest.approx(rolled_step(), 1e-5)  # shapely takes points away
    for width in (1e-3, FAR[rise_law]):
        made = stepped("roller", rise_law, width, 100.0)
        assert made.size.area_error <= 1e-3 * area
        demand_a_step(made, area, width)


def test_what_turns_between_two_angles_is_refused() -> None:
    """Far from 0, two angles next to each other are farther apart than the swing is wide."""
    told = "two cam angles that are next to each other .*100 deg.*a longer phase there"
    with pytest.raises(InfeasibleError, match=told):
        _ = stepped("roller", "constant-acceleration", 1e-7, 100.0).contour


KNIFE = """
kind = "cam"
name = "knife"
[[motion]]
type = "rise"
law = "{law}"
lift_mm = {lift}
way_mm = {way}
[[motion]]
type = "dwell"
way_mm = 20
[[motion]]
type = "return"
law = "{law}"
way_mm = {way}
[follower]
type = "point"
[cam]
form = "translating"
run_in_mm = 5
run_out_mm = 20
thickness_mm = 5
[blank]
height_mm = 160
[output]
chord_tolerance_mm = {tolerance}
"""


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
@pytest.mark.parametrize(("lift", "way"), [(10, 20), (10, 1), (100, 1)])
@pytest.mark.parametrize("rise_law", ["cycloidal", "3-4-5", "harmonic", "constant-acceleration"])
def test_a_knife_edge_feels_no_more_of_the_chords_than_is_told(
    rise_law: str, lift: int, way: int, tolerance: float
) -> None:
    """A steep plate multiplies a chord's error, and turns of few chords tell little of it."""
    made = built(KNIFE.format(law=rise_law, lift=lift, way=way, tolerance=tolerance))
    study = made.follow(made.profiles[0].vertices)
    off = np.abs(study.columns["difference"])
    assert np.all(off <= study.columns["error"] + 1e-9)
