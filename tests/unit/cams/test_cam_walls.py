"""Walls on both sides of a pitch curve: those of a groove, trimmed each for itself."""

from __future__ import annotations

import math

import pytest
import shapely

from gearcam.cams.disc import make_cam
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.cams.wall import Wall
from helpers_cams import back, follower_of, program, rise, there_and_back

RADIUS = 6.0


def walls(lift: float, degrees: tuple[float, ...], law: str) -> tuple[Wall, Wall]:
    """The walls inside and outside the pitch curve of a roller."""
    program, follower = there_and_back(law, lift, degrees), follower_of("roller")
    outer = Wall(program=program, follower=follower, side=-1)
    return make_cam(program, follower), outer


def test_a_groove_has_the_area_of_a_roller_along_its_pitch_curve() -> None:
    inner, outer = walls(12.0, (120.0, 60.0, 120.0, 60.0), "cycloidal")
    assert inner.corners == outer.corners == ()
    length = 0.5 * (inner.size.perimeter + outer.size.perimeter)
    assert outer.size.perimeter - inner.size.perimeter == pytest.approx(4.0 * math.pi * RADIUS)
    assert outer.size.area - inner.size.area == pytest.approx(2.0 * RADIUS * length, rel=1e-12)


@pytest.mark.parametrize("law", ["cycloidal", "constant-velocity"])
def test_trimmed_walls_are_the_edges_of_all_rollers(law: str) -> None:
    inner, outer = walls(10.0, (25.0, 0.0, 25.0, 310.0), law)
    assert outer.corners
    band = shapely.LinearRing(inner.pitch_contour.vertices).buffer(RADIUS, quad_segs=256)
    for contour, edge in ((inner.contour, band.interiors[0]), (outer.contour, band.exterior)):
        region = shapely.Polygon(edge)
        off = shapely.symmetric_difference(contour.polygon, region).area
        assert off < 3.0 * contour.tolerance * region.length


def test_sides_meet_at_the_corner_of_a_steep_return() -> None:
    """The speed of the profile there, times the rounding of cam angles, is far below a chord."""
    phases = [rise("modified-sine", 360.0 - 7e-3, 5000.0), back("cycloidal", 7e-3)]
    dome = FollowerSpec(type="domed", dome_radius=10000.0)
    wall = make_cam(program(phases), make_follower(dome, CamSpec(prime_radius=20000.0)))
    (run,) = wall.contour.runs
    assert abs(run.points[0] - run.points[-1]) < 0.1 * wall.tolerance
