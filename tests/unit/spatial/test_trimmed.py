"""Undercut walls: what the roller takes off, the lift that is lost, and the carved solid."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import NotFiniteError
from gearcam.base.findings import run_checks
from gearcam.base.numerals import shortened
from gearcam.numeric.mesh import Mesh
from gearcam.parts.solids import carved
from gearcam.spatial.cam import SpatialCam, SpatialWall
from gearcam.spatial.carving import roller_corners, scallop
from gearcam.spatial.checks import KIND
from gearcam.spatial.developed import largest_in_plane
from gearcam.spatial.envelope import Roller
from gearcam.spatial.extremes import Spot
from gearcam.spatial.guides import AcrossGuide, Straight
from gearcam.spatial.hulls import round_hulls
from gearcam.spatial.surface import Cylinder, blank_surface, surface
from gearcam.spatial.trimmed import TrimmedWall, lost_lift
from helpers_sampling import chosen, few
from helpers_spatial import reference, slice_way, solid, swept, swinging
from witness.roller_in_space import Mechanism

_DENSE = 20001
"""Near an edge two angles reach equally high: a coarser search takes the wrong one."""

BLANK = Cylinder(length=110.0, bore=10.0)


def cut(radius: float = 22.3, half_angle: float = 0.0, **more: Any) -> SpatialCam:
    roller = Roller(radius=radius, at=40.0, half_angle=half_angle)
    return reference(**({"height": 40.0, "roller": roller} | more))


def mechanism(cam: SpatialCam, inner: float) -> Mechanism:
    def center(at: Any) -> tuple[Any, Any]:
        point, _ = cam.guide.placed(cam.program.derivatives(np.atleast_1d(at), 0)[0])
        return point[0, :, 1], point[0, :, 2]

    return Mechanism(center, cam.roller.radius, 40.0, cam.roller.half_angle, inner)


CAMS = {
    "cylinder": cut(),
    "larger": cut(25.0),
    "cone": cut(30.0, 0.2),
    "arm": replace(swinging(), roller=Roller(radius=22.0, at=40.0), floor=27.5),
}


@pytest.mark.slow
def test_a_roller_that_the_developed_plane_allows_is_cut_in_space() -> None:
    cam = CAMS["cylinder"]
    assert cam.largest_roller.value < 22.3 < largest_in_plane(cam, 28.0)
    assert all(lost_lift(wall).depth.value > 3e-3 for wall in cam.walls)


def test_nothing_is_lost_without_undercut() -> None:
    for wall in cut(21.5).walls:
        assert (lost_lift(wall).depth.value, lost_lift(wall).way.value) == (0.0, 0.0)


@pytest.mark.parametrize("name", chosen(list(CAMS), "cylinder"))
def test_the_depth_is_that_of_the_search(name: str) -> None:
    cam = CAMS[name]
    search = mechanism(cam, cam.floor)
    for wall in cam.walls:
        spot = lost_lift(wall).depth
        x, y, z = wall.contact(np.array([spot.theta]), np.array([[spot.x]])).points[0, 0]
        found = search.wall(math.hypot(x, y), math.atan2(y, x), wall.side)
        assert wall.side * (found - z) == pytest.approx(spot.value, abs=1e-7)


def room(wall: SpatialWall, spot: Spot, more: float) -> float:
    """Least height between the roller, moved on by so much, and the wall of the search."""
    cam, search = wall.cam, mechanism(wall.cam, wall.cam.floor)
    lift = float(cam.program.derivatives(np.array([spot.theta]), 0)[0][0])
    point, _ = cam.guide.placed(np.array([lift + wall.side * more]))
    y_a, z_a = point[0, 0, 1:]
    radius = cam.roller.radius_at(spot.x)
    near, size, least = 0.0, 1.5, math.inf
    for _ in range(6):
        rooms = {}
        for angle in near + np.linspace(-size, size, 25):
            y, z = y_a + radius * math.sin(angle), z_a + wall.side * radius * math.cos(angle)
            if math.hypot(spot.x, y) <= cam.outer_radius:
                wanted = math.hypot(spot.x, y), math.atan2(y, spot.x) - spot.theta
                rooms[angle] = wall.side * (search.wall(*wanted, wall.side, _DENSE) - z)
        near = min(rooms, key=lambda one: rooms[one])
        least, size = min(least, rooms[near]), size / 8.0
    return least


@pytest.mark.parametrize("name", chosen(list(CAMS), "cylinder"))
def test_the_follower_moves_by_the_lost_lift_until_it_rests(name: str) -> None:
    wall = CAMS[name].walls[0]
    way = lost_lift(wall).way
    assert way.value > 1e-4
    assert room(wall, way, way.value) == pytest.approx(0.0, abs=5e-5)
    assert room(wall, way, 0.0) > 1e-4


def test_no_other_place_loses_more() -> None:
    wall = CAMS["larger"].walls[0]
    theta = np.linspace(0.0, 2.0 * math.pi, 301)
    x = np.linspace(28.0, 36.0, 13) * np.ones((301, 1))
    found = TrimmedWall(wall=wall).lost(theta, x)
    most = lost_lift(wall).way.value
    assert 0.9 * most < found.max() <= most + 1e-6


@pytest.mark.parametrize(("limit", "severity"), [(5.49e-4, "error"), (5.51e-4, "warning")])
def test_the_lost_lift_decides_whether_undercut_is_an_error(limit: float, severity: str) -> None:
    found = [*run_checks(KIND, (CAMS["cylinder"], BLANK), {"lost_lift": limit})]
    both = [one for one in found if one.code == "undercut"]
    assert [one.severity for one in both] == [severity, severity]
    assert 5.49e-4 < (both[0].value or 0.0) < 5.51e-4  # see the witness for undercut walls


@pytest.mark.parametrize("more", few([1e-6, 1e-2]))
def test_an_undercut_that_takes_no_lift_does_not_tell_of_0_mm(more: float) -> None:
    cam = cut(CAMS["cylinder"].largest_roller.value + more)
    assert all(wall.undercut and lost_lift(wall).way.value == 0.0 for wall in cam.walls)
    both = [one for one in run_checks(KIND, (cam, BLANK), {}) if one.code == "undercut"]
    assert [(one.value, " 0 mm" in one.message) for one in both] == [(None, False)] * 2


def carving(cam: SpatialCam, steps: int, places: int) -> Mesh:
    return carved(blank_surface(cam, BLANK, 4 * steps), roller_corners(cam, BLANK, steps, places))


ROUND = math.pi * (40.0**2 - 10.0**2) * 110.0


@pytest.mark.slow
@pytest.mark.parametrize("count", chosen([30, 45, 90], 30))
def test_the_carved_solid_has_the_volume_of_the_search(count: int) -> None:
    cam = cut(25.0)
    search = mechanism(cam, cam.floor)
    nodes, weights = np.polynomial.legendre.leggauss(6)
    share = 0.5 + 0.5 * nodes
    removed = 0.0
    for u, weight in zip(share, weights, strict=True):
        radius = 28.0 + 12.0 * u**2  # heights rise with the root of it
        heights = [
            search.wall(radius, azimuth, 1, 601) - search.wall(radius, azimuth, -1, 601)
            for azimuth in 2.0 * math.pi * np.arange(count) / count
        ]
        removed += 0.5 * weight * 24.0 * u * radius * 2.0 * math.pi * float(np.mean(heights))
    made = carving(cam, 2 * count, 9)
    assert made.watertight
    assert ROUND - made.volume == pytest.approx(removed, rel=2e-3 * 90 / count)


@pytest.mark.slow
@pytest.mark.parametrize(
    "more",
    [{"apart": 24.0, "half_angle": 0.1}, {}, {"sides": (1,)}, {"sides": (-1,)}],
)
def test_carving_a_whole_groove_gives_its_surface(more: dict[str, Any]) -> None:
    cam = cut(8.0, **more)
    true = surface(cam, BLANK, 720, 13).volume
    errors = [carving(cam, n, n // 12).volume - true for n in (36, 72)]
    assert errors[1] > 0.0
    assert 2.5 < errors[0] / errors[1] < 5.0


def roller(cam: SpatialCam, theta: float, less: float) -> Any:
    """The roller from 1.5 mm above the floor as a prism, so much smaller, in the cam's frame."""
    radius, depth = cam.roller.radius - less, cam.outer_radius - cam.inner
    lift = float(cam.program.derivatives(np.array([theta]), 0)[0][0])
    return (
        manifold3d.Manifold.cylinder(depth, radius, radius, 1440)
        .rotate((0.0, 90.0, 0.0))
        .translate((cam.inner + 1.5, 0.0, 40.0 + lift))
        .rotate((0.0, 0.0, -math.degrees(theta)))
    )


@pytest.mark.parametrize(("radius", "steps"), few([(8.0, 60), (8.0, 120), (22.3, 120)], 3))
def test_nothing_is_left_higher_than_is_stated(radius: float, steps: int) -> None:
    """A roller between two positions, in dwells and on slopes, by intersections of manifold3d."""
    cam = cut(radius)
    body, height = solid(carving(cam, steps, 13)), scallop(cam, steps, 13)
    step = 2.0 * math.pi / steps
    angles = [step * (k + 0.5) for k in (steps * np.array([15, 30, 50, 66, 110])) // 120]
    left = [(body ^ roller(cam, theta, height + 5e-4)).volume() for theta in angles]
    assert max(left) == 0.0
    assert max((body ^ roller(cam, theta, 0.95 * height)).volume() for theta in angles) > 0.0


@pytest.mark.parametrize("half_angle", [0.0, 0.3])
def test_the_distance_from_a_hull_is_that_from_its_faces(half_angle: float) -> None:
    """Against the planes of the triangles of manifold3d."""
    cam = cut(12.0, half_angle)
    (wall, _), theta = cam.walls, np.array([0.7, 3.1])
    hulls = round_hulls(cam, 1, theta, (28.0, 42.0), 24)
    hulls = hulls.more(hulls.touching(wall, np.linspace(28.0, 40.0, 5), 0.05))
    points = wall.contact(theta + 0.02, np.tile([30.0, 33.0, 39.0], (2, 1))).points
    found, ways = hulls.faces(points)
    for k, corners in enumerate(hulls.corners):
        made = manifold3d.Manifold.hull_points(corners).to_mesh64()
        a, b, c = np.moveaxis(made.vert_properties[:, :3][made.tri_verts], 1, 0)
        normals = np.cross(b - a, c - a)
        sizes = np.linalg.norm(normals, axis=1)
        whole = sizes > 1e-3
        planes = normals[whole] / sizes[whole][:, None]
        for point, off, normal in zip(points[k], found[k], ways[k], strict=True):
            every = ((point - a[whole]) * planes).sum(axis=1)
            assert off == pytest.approx(every.max(), abs=1e-7)
            assert normal == pytest.approx(planes[every.argmax()], abs=1e-6)
    assert found.min() > 0.0


def test_scallops_fall_with_the_square_of_the_step() -> None:
    heights = [scallop(cut(), steps, 33) for steps in (60, 120, 240)]
    assert np.abs(np.diff(np.log2(heights)) + 2.0).max() < 0.15


STEEP = """\
kind = "cam"
name = "steep"
[[motion]]
type = "rise"
law = "cycloidal"
angle_deg = {rise}
{lift}
[[motion]]
type = "dwell"
angle_deg = {dwell}
[[motion]]
type = "return"
law = "3-4-5"
angle_deg = {back}
[[motion]]
type = "dwell"
angle_deg = "rest"
[follower]
{follower}
[cam]
form = "cylinder"
{cam}
"""

STEEP_CAMS = {  # steep rises, far too large rollers: places near the outside leave the blank
    "one wall": {
        "rise": 50,
        "lift": "lift_deg = 37",
        "dwell": 106,
        "back": 113,
        "follower": 'motion = "oscillating"\nroller_radius_mm = 8\narm_mm = 52',
        "cam": "outer_diameter_mm = 55\nlength_mm = 141\nlowest_mm = 38\ngroove_depth_mm = 4\n"
        'walls = "upper"',
    },
    "groove": {
        "rise": 65,
        "lift": "lift_deg = 28",
        "dwell": 100,
        "back": 85,
        "follower": 'motion = "oscillating"\nroller_radius_mm = 7.8\narm_mm = 47',
        "cam": "outer_diameter_mm = 50\nlength_mm = 241\nlowest_mm = 73.5\ngroove_depth_mm = 7",
    },
    "translating": {
        "rise": 60,
        "lift": "lift_mm = 25",
        "dwell": 90,
        "back": 90,
        "follower": "roller_radius_mm = 12\ncone_deg = 5",
        "cam": "outer_diameter_mm = 60\nlength_mm = 90\nlowest_mm = 30\ngroove_depth_mm = 10",
    },
}


@pytest.mark.slow
@pytest.mark.parametrize("name", chosen(list(STEEP_CAMS), "one wall"))
def test_a_roller_that_is_far_too_large_is_told_in_finite_numbers(
    tmp_path: Path, name: str
) -> None:
    result = gc.build(gc.loads(STEEP.format(**STEEP_CAMS[name])))
    written = result.write(tmp_path, files=["csv"])
    found = [one for one in written.findings if one.code == "undercut"]
    assert {one.severity for one in found} == {"error"}
    wall = result.cam.walls[0]  # pyright: ignore
    spot, arm = lost_lift(wall).way, getattr(wall.cam.guide, "length", 1.0)
    lost = arm * slice_way(wall, swept(wall), spot.theta, spot.x)
    assert found[0].value == pytest.approx(lost, abs=1e-4)
    gone, edge = lost_lift(wall).gone, wall.edge
    assert gone is not None
    assert f"Nothing is left of the wall made at {math.degrees(gone):.5g} deg" in found[0].message
    x = np.linspace(wall.cam.inner, edge(np.array([gone]))[0], 33)
    assert TrimmedWall(wall=wall).depth(np.array([gone]), x[None, :]).min() > 0.0
    smaller = shortened(wall.allowed_radius, -1.0)
    allowed = result.design.with_({"follower.roller_radius_mm": smaller})
    assert not gc.build(allowed).cam.undercut  # pyright: ignore
    assert f"A roller_radius_mm of up to {smaller:g} cuts nothing off." in found[0].message


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("guide", [Straight(height=7.0), swinging().guide], ids=["straight", "arm"])
def test_a_follower_goes_on_until_its_roller_meets_a_point(guide: AcrossGuide, side: int) -> None:
    lift, radius = np.array([0.1, 0.2, 0.3]), np.array([8.0, 9.0, 10.0])
    (_, y, z), _ = (one[0].T for one in guide.placed(lift))
    point = y + radius * np.array([-0.9, 0.1, 0.8]), z + side * 1.1 * radius
    way = guide.way(lift, point, radius, side)
    (_, y, z), _ = (one[0].T for one in guide.placed(lift + side * way))
    assert (way > 0.0).all()
    assert np.hypot(point[0] - y, point[1] - z) == pytest.approx(radius, abs=1e-12)
    assert (side * (point[1] - z) > 0.0).all()
    aside = point[0] + 300.0, point[1]
    assert np.isinf(guide.way(lift, aside, radius, side)).all()


def test_an_extreme_that_is_not_a_number_is_refused() -> None:
    """No check would find it beyond a limit."""
    assert Spot(theta=0.0, x=1.0, value=math.inf).value == math.inf
    with pytest.raises(NotFiniteError, match="an extreme at 90 deg, 1 mm from the axis is not a"):
        Spot(theta=math.pi / 2, x=1.0, value=math.nan)
