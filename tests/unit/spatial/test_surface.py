"""The surface of a cam in space: closed, its volume, and the roller that runs through it."""

from __future__ import annotations

import csv
import math
from typing import Any

import manifold3d
import numpy as np
import pytest

import gearcam as gc
from gearcam.numeric.mesh import Mesh
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.guides import RollerGuide, Turret
from gearcam.spatial.surface import Cylinder, chord_error, roller_surface, surface
from helpers_pairs import PROFILES
from helpers_sampling import chosen, few
from helpers_spatial import reference, solid, swinging

EXACT = 44298.298
"""Volume of the groove of the reference cam, mm^3: two quadratures agree to 1e-4."""


def mesh(cam: SpatialCam, steps: int = 720, places: int = 13, **blank: float) -> Mesh:
    return surface(cam, Cylinder(**({"length": 60.0} | blank)), steps, places)


@pytest.mark.parametrize("sides", [(1, -1), (1,), (-1,)])
@pytest.mark.parametrize("bore", [0.0, 10.0])
def test_surfaces_are_closed(sides: tuple[int, ...], bore: float) -> None:
    cam = reference(height=15.0, sides=sides, clearance=0.1, half_angle=0.1)
    made = mesh(cam, 180, 5, bore=bore)
    assert made.watertight
    assert made.volume > 0.0
    assert solid(made).volume() == pytest.approx(made.volume, rel=1e-12)
    assert solid(made).genus() == (1 if bore else 0)


@pytest.mark.parametrize("bore", [0.0, 10.0])
def test_the_surface_of_a_rib_is_closed(bore: float) -> None:
    cam = reference(height=30.0, apart=24.0, half_angle=0.1)
    made = mesh(cam, 180, 5, length=100.0, bore=bore)
    assert made.watertight
    assert solid(made).volume() == pytest.approx(made.volume, rel=1e-12)
    core = math.pi * (28.0**2 - bore**2) * 100.0
    rib = made.volume - core
    # in dwells, a third of the turn, it is 8 mm high between the cylinders, and wider at the core
    assert rib > math.pi * (40.0**2 - 28.0**2) * 8.0 * 0.8


def test_the_surface_of_a_swinging_follower_is_closed() -> None:
    cam = swinging()
    low, _ = cam.heights
    made = mesh(reference(program=cam.program, guide=cam.guide), length=60.0)
    assert low < 0.0  # it only has to be closed
    assert made.watertight


def test_the_volume_converges_with_the_square_of_the_step() -> None:
    cam = reference(height=15.0)
    steps, whole = (180, 360, 720), math.pi * 40.0**2 * 60.0
    errors = [whole - mesh(cam, n, 1 + n // 60).volume - EXACT for n in steps]
    slopes = np.diff(np.log(np.abs(errors))) / np.diff(np.log(steps))
    assert np.abs(slopes + 2.0).max() < 0.1
    assert abs(errors[-1]) < 2.4


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_points_of_the_table_of_walls_are_corners_of_the_solid(rotation: str) -> None:
    changes = {"cam.rotation": rotation, "output.wall_step_deg": 5, "output.wall_points": 4}
    result = gc.build(gc.load(PROFILES / "cylinder_cam.toml").with_(changes))
    text = result.files("csv")["walls.csv"].decode()
    rows = [row for row in csv.DictReader(text.splitlines()) if row["wall"] == "upper"]
    points = np.array([[float(row[key]) for key in ("X", "Y", "Z")] for row in rows])
    made = result.mesh
    assert made.watertight
    assert made.volume > 0.0
    far = [np.linalg.norm(made.vertices - one, axis=1).min() for one in points[::7]]
    assert max(far) < 1e-6


def test_the_chord_error_falls_with_the_square_of_the_step() -> None:
    cam = reference(height=15.0)
    errors = [chord_error(cam, n, 1 + n // 60) for n in (180, 360, 720)]
    assert np.abs(np.diff(np.log2(errors)) + 2.0).max() < 0.1


def roller(cam: SpatialCam, theta: float, more: float) -> Any:
    """The roller as a prism of 720 sides about its axis, wider by so much, in the cam's frame."""
    radius, depth = cam.roller.radius + more, cam.outer_radius + 5.0 - cam.inner
    made = manifold3d.Manifold.cylinder(depth, radius, radius, 720)
    lift = float(cam.program.derivatives(np.array([theta]), 0)[0][0])
    return (
        made.rotate((0.0, 90.0, 0.0))
        .translate((cam.inner + 1e-3, 0.0, 15.0 + lift))
        .rotate((0.0, 0.0, -math.degrees(theta)))
    )


def overlaps(body: Any, cam: SpatialCam, count: int, more: float) -> list[float]:
    """Volumes that the roller shares with a cam at angles between those of its surface."""
    angles = 2.0 * math.pi * (np.arange(count) + 0.37) / count
    return [(body ^ roller(cam, float(theta), more)).volume() for theta in angles]


@pytest.mark.parametrize(("steps", "count"), chosen([(360, 12), (720, 720)], (360, 12)))
@pytest.mark.parametrize("clearance", few([0.05, 0.0]))
def test_the_roller_runs_through_the_groove(clearance: float, steps: int, count: int) -> None:
    """It neither overlaps beyond the chord error nor has a gap beyond that and the clearance."""
    cam = reference(height=15.0, clearance=clearance, floor=27.96)
    places = 1 + steps // 60
    body, error = solid(mesh(cam, steps, places)), chord_error(cam, steps, places)
    assert error < 2.5e-3 * (720 / steps) ** 2
    assert max(overlaps(body, cam, count, 0.5 * clearance - 1.1 * error)) == 0.0
    assert min(overlaps(body, cam, count, 0.5 * clearance + 1.1 * error)) > 0.0


def test_two_rollers_embrace_a_rib() -> None:
    cam = reference(height=15.0, apart=24.0, floor=27.96)
    body, error = solid(mesh(cam, 360, 7, length=100.0)), chord_error(cam, 360, 7)
    for shift in (12.0, -12.0):
        moved = body.translate((0.0, 0.0, shift))
        assert max(overlaps(moved, cam, 10, -1.1 * error)) == 0.0
        assert min(overlaps(moved, cam, 10, 1.1 * error)) > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("side", few([1, -1]))
def test_a_wall_that_is_off_by_5_um_is_found(side: int) -> None:
    cam = reference(height=15.0)
    made = mesh(cam)
    (wall,) = (one for one in cam.walls if one.side == side)
    grid = wall.grid(np.linspace(0.0, 2.0 * math.pi, 720, endpoint=False), 13)
    known = {tuple(point): k for k, point in enumerate(made.vertices.tolist())}
    moved = made.vertices.copy()
    pairs = zip(grid.points.reshape(-1, 3).tolist(), grid.normals.reshape(-1, 3), strict=True)
    for point, normal in pairs:
        if tuple(point) in known:  # others coincide with one of these
            moved[known[tuple(point)]] -= 5e-3 * normal
    body = solid(Mesh(vertices=moved, triangles=made.triangles))
    assert max(overlaps(body, cam, 6, -1.1 * chord_error(cam, 720, 13))) > 0.0


@pytest.mark.parametrize("half_angle", [0.0, 0.1])
def test_the_surface_of_a_roller_is_closed_and_has_its_volume(half_angle: float) -> None:
    """Against a truncated cone and a cylinder of half its radius, as prisms of the same corners."""
    cam = reference(half_angle=half_angle)
    made = roller_surface(cam, 90)
    assert made.watertight
    area = 45.0 * math.sin(2.0 * math.pi / 90)  # of 90 chords about a circle of radius 1
    thin = 8.0 - 12.0 * math.tan(half_angle)
    cone = 12.0 / 3.0 * (8.0**2 + 8.0 * thin + thin**2)
    assert made.volume == pytest.approx(area * (cone + 8.0 * 4.0**2), rel=1e-12)
    assert (made.vertices[:, 0].min(), made.vertices[:, 0].max()) == (28.0, 48.0)


TURRET = Turret(distance=90.0, start=-0.3)


@pytest.mark.parametrize("guide", [reference().guide, swinging().guide, TURRET])
def test_the_pose_of_a_roller_carries_its_axis_where_the_guide_does(guide: RollerGuide) -> None:
    lift = np.linspace(0.0, 0.6, 5)
    point, direction = guide.placed(lift)
    matrix = guide.pose(lift).matrix
    for x in (0.0, 12.5):
        moved = matrix @ [x, 0.0, 0.0, 1.0]
        assert moved[:, :3] == pytest.approx(point[0] + x * direction[0], abs=1e-12)
