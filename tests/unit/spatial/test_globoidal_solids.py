"""The solid of a globoidal cam: closed, its volume, and rollers that run through it."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.numeric.arrays import Array
from gearcam.numeric.mesh import Mesh
from gearcam.spatial.globoidal import GloboidalCam
from gearcam.spatial.globoidal_carving import scallop
from gearcam.spatial.globoidal_surface import (
    blank_surface,
    chord_error,
    core_surface,
    outer_radius,
    rib_surface,
    turret_surface,
)
from gearcam.spatial.surface import revolved
from helpers_built import built as shared
from helpers_globoidal import DESIGN, indexer
from helpers_pairs import PROFILES
from helpers_sampling import chosen, few
from helpers_spatial import solid
from witness.roller_of_turret import Wheel


@cache
def built(steps: int, places: int, **more: Any) -> Any:
    found = gc.build(DESIGN.with_({"cam.roller_clearance_mm": 0, "cam.length_mm": 46} | more))
    return found.mesh_of(steps, places)


@cache
def body(steps: int, places: int, clearance: float = 0.0) -> Any:
    """The solid of a cam with a clearance, mm."""
    more = {"cam.roller_clearance_mm": clearance} if clearance else {}
    return solid(built(steps, places, **more))


def roller(cam: GloboidalCam, angle: float, wider: float, moved: float = 0.0) -> Any:
    """The part of a roller outside the turret's body, at a cam angle, in the frame of the cam.

    Moved with the turret, by so many mm in its middle.
    """
    theta, radius = math.radians(angle), cam.roller.radius + wider
    ends = 44.0, cam.reach
    corners = [(0.0, ends[0]), (0.0, ends[1]), (radius, ends[1]), (radius, ends[0])]
    made = revolved(corners, 1440)
    psi = float(cam.angle(np.array([theta]))[0]) + moved / cam.middle
    c, s = math.cos(theta), math.sin(theta)
    x, y, z = made.vertices.T
    fixed = (
        cam.distance - z * math.cos(psi) + x * math.sin(psi),
        y,
        z * math.sin(psi) + x * math.cos(psi),
    )
    turned = [c * fixed[0] + s * fixed[1], c * fixed[1] - s * fixed[0], fixed[2]]
    placed = Mesh(vertices=np.stack(turned, axis=1), triangles=made.triangles)
    if placed.volume < 0.0:
        placed = replace(placed, triangles=made.triangles[:, ::-1])
    return solid(placed)


ANGLES = (-30.1, 13.37, 60.13, 71.2, 95.5, 110.01, 200.3)
"""Of dwells and of the index, in degrees; none is one of the solid's."""


FINE = 5e-3
"""By how much a roller is wider or the turret turned where it touches, of 1080 steps, mm."""

PLAY = 0.16
"""A clearance, mm: far above what 360 steps are off."""

AROUND = ((-30.1, (1,)), (60.13, (1, -1)), (71.2, (1, -1)), (200.3, (-1,)))
"""Angles, and the sides of the roller that a wall is near."""


@pytest.mark.parametrize(
    ("steps", "angle"),
    chosen(product((360, 720, 1080), ANGLES), (360, 71.2)),
)
def test_rollers_fit_between_the_ribs(steps: int, angle: float) -> None:
    """A roller that is smaller by the chord error is clear; one that is wider is not."""
    cam, made, coarser = indexer(), body(steps, 1 + steps // 60), (1080 / steps) ** 2
    error = chord_error(cam, steps, 1 + steps // 60)
    assert error < 2.5e-3 * coarser
    assert (made ^ roller(cam, angle, -error - 2e-5)).volume() == 0.0
    assert (made ^ roller(cam, angle, error + 1e-4)).volume() > 1e-3
    assert (made ^ roller(cam, angle, FINE * coarser)).volume() > 0.02


@pytest.mark.parametrize(
    ("steps", "around"),
    chosen(product((360, 720, 1080), AROUND), *((360, one) for one in AROUND[2:])),
)
def test_there_is_no_gap(steps: int, around: tuple[float, tuple[int, ...]]) -> None:
    """A roller that is clear meets each wall if the turret turns a little: in a dwell only one."""
    cam, made, (angle, sides) = indexer(), body(steps, 1 + steps // 60), around
    error = chord_error(cam, steps, 1 + steps // 60)
    for side in (1, -1):
        moved = FINE * (1080 / steps) ** 2 * side
        found = made ^ roller(cam, angle, -error - 2e-5, moved)
        assert (found.volume() > 2e-4) == (side in sides)


@pytest.mark.slow
@pytest.mark.parametrize("angle", chosen(ANGLES, 60.13))
def test_a_clearance_is_half_to_each_side(angle: float) -> None:
    cam = indexer(clearance=PLAY)
    error = chord_error(cam, 360, 7)
    made = body(360, 7, PLAY)
    assert error < 0.3 * 0.5 * PLAY
    assert (made ^ roller(cam, angle, 0.5 * PLAY - error - 2e-5)).volume() == 0.0
    assert (made ^ roller(cam, angle, 0.5 * PLAY + error + 1e-4)).volume() > 1e-4


@pytest.mark.slow
def test_the_backlash_at_rest() -> None:
    """The rollers are clear while the turret turns by less than half its backlash."""
    changes = {"cam.roller_clearance_mm": PLAY, "cam.length_mm": 46, "output.wall_step_deg": 5}
    found = gc.build(DESIGN.with_(changes))
    half = 0.5 * math.radians(found.facts["indexer.backlash_deg"]) * found.cam.middle
    made, error = body(360, 7, PLAY), chord_error(found.cam, 360, 7)
    for angle, side in ((-60.0, 1.0), (250.0, -1.0)):
        for factor, touches in ((0.7, False), (1.3, True)):
            # the roller's true size; its triangles and those of the cam are off by microns
            moved = roller(found.cam, angle, 0.0, factor * side * half)
            assert ((made ^ moved).volume() > 1e-4) == touches
    assert error < 0.3 * 0.5 * PLAY


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("bore", few([30.0, 0.0]))
def test_solids_are_closed(rotation: str, bore: float) -> None:
    more = {"cam.rotation": rotation, "blank.bore_diameter_mm": bore}
    made = built(180, 5, **more)
    assert made.watertight
    assert solid(made).volume() == pytest.approx(made.volume, rel=1e-12)
    assert solid(made).genus() == (1 if bore else 0)
    assert len(solid(made).decompose()) == 1
    other = built(180, 5, **more | {"cam.rotation": "ccw"})
    assert made.volume == pytest.approx(other.volume, rel=1e-12)


@pytest.mark.slow
def test_the_volume_is_of_second_order() -> None:
    volumes = [built(*size).volume for size in ((360, 7), (720, 13), (1440, 25))]
    second, third = -np.diff(volumes)
    assert second / third == pytest.approx(4.0, abs=0.5)


@pytest.mark.slow
def test_the_error_of_the_volume_is_stated() -> None:
    coarse, fine = (built(*size).volume for size in ((360, 7), (540, 10)))
    result = gc.build(
        DESIGN.with_(
            {"cam.roller_clearance_mm": 0, "cam.length_mm": 46, "output.wall_step_deg": 1,
             "output.wall_points": 7}
        )
    )  # fmt: skip
    truth = fine - (coarse - fine) / (1.5**2 - 1.0)
    assert abs(result.mesh.volume - truth) < 1.5 * result.volume_error < 20.0


def test_core_and_blank_have_the_volumes_of_pappus() -> None:
    """Of a rectangle less a segment of a circle, by its centroid; the error is of second order."""
    cam = indexer()
    for radius, half, made in (
        (cam.top, 23.0, blank_surface(cam, 10.0, 720)),
        (cam.floor, 23.0 + 0.1 * (cam.floor - 23.0), core_surface(cam, 720)),
    ):
        # pi times the integral of (C - sqrt(radius^2 - z^2))^2 over z
        root = math.sqrt(radius**2 - half**2)
        area = half * root + radius**2 * math.asin(half / radius)
        square = 2.0 * (radius**2 * half - half**3 / 3.0)
        expected = math.pi * (2.0 * half * 100.0**2 - 200.0 * area + square)
        expected -= math.pi * 200.0 * half if radius == cam.top else 0.0
        assert solid(made).volume() == pytest.approx(expected, rel=1.6e-4)


def winding(made: Mesh, points: Array) -> Array:
    """How often the surface winds around points: 1 in the metal, 0 outside (solid angles)."""
    corners = made.vertices[made.triangles]
    found = []
    for point in points:
        a, b, c = np.moveaxis(corners - point, 1, 0)
        la, lb, lc = (np.linalg.norm(one, axis=1) for one in (a, b, c))
        top = (a * np.cross(b, c)).sum(axis=1)
        low = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        found.append(2.0 * np.arctan2(top, low).sum() / (4.0 * math.pi))
    return np.array(found)


def ring_points(cam: GloboidalCam, count: int) -> Array:
    """Random points in the ring of the ribs, mm."""
    random = np.random.default_rng(7)
    chi = math.asin(cam.half_length / cam.top)
    depth, angle = random.uniform(cam.top, cam.reach, count), random.uniform(-chi, chi, count)
    azimuth, radius = (
        random.uniform(0.0, 2.0 * math.pi, count),
        cam.distance - depth * np.cos(angle),
    )
    points = np.stack(
        [radius * np.cos(azimuth), radius * np.sin(azimuth), depth * np.sin(angle)], axis=1
    )
    inside = cam.depth(points) > cam.top + 0.1
    return points[inside & (np.abs(points[:, 2]) < cam.half_length - 0.1)]


@pytest.mark.parametrize(
    ("distance", "unclear", "count"),
    chosen([(100, 0.05, 12), (100, 0.05, 120), (75, 0.25, 120)], (100, 0.05, 12)),
)
def test_metal_is_where_no_roller_comes(distance: float, unclear: float, count: int) -> None:
    """At random points of the ring of the ribs, by search; of an undercut cam too."""
    found = gc.build(
        DESIGN.with_({"cam.center_distance_mm": distance, "cam.roller_clearance_mm": 0})
    )
    cam, made = found.cam, found.mesh_of(120 if found.carved else 360, 7)
    assert found.carved == (distance < 100)
    assert made.watertight
    angle = cache(lambda at: float(cam.angle(np.array([at]))[0]))  # of all points alike
    wheel = Wheel(cam.distance, cam.places[1], angle)
    points = ring_points(cam, count)
    gaps = np.array([wheel.nearest(tuple(one), *cam.span) for one in points.tolist()]) - 8.0
    clear = np.abs(gaps) > unclear
    metal = winding(made, points[clear])
    assert metal == pytest.approx((gaps[clear] > 0.0).astype(float), abs=1e-6)
    assert 0.2 < metal.mean() < 0.9
    assert clear.sum() > count / 2


@pytest.mark.parametrize("steps", [36, pytest.param(120, marks=pytest.mark.slow)])
def test_a_carved_rib_is_the_rib_of_walls(monkeypatch: pytest.MonkeyPatch, steps: int) -> None:
    """Of a cam that is not undercut: larger by the scallops, nowhere by more than is stated."""
    result = gc.build(DESIGN.with_({"cam.length_mm": 46, "cam.roller_clearance_mm": 0}))
    rib = built(360, 7).volume
    monkeypatch.setattr(type(result), "carved", property(lambda _: True))
    made, cam = result.mesh_of(steps, 7), indexer()
    assert made.watertight
    height = scallop(cam, steps, 7)
    assert 0.03 < height * (steps / 120) ** 2 < 0.3
    # the walls have about 2 * 13.5 mm by 340 mm in a winding of the rib
    assert 0.0 < made.volume - rib < height * 2 * 13.5 * 340 * 1.5
    between = 60.0 + 180.0 / steps  # at half a step
    assert (solid(made) ^ roller(cam, between, -height - 1e-3)).volume() == 0.0
    assert (solid(made) ^ roller(cam, between, 0.0)).volume() > 0.1


def test_the_rib_goes_beyond_all_that_bounds_it() -> None:
    cam = indexer()
    made = rib_surface(cam, 360, 7)
    assert made.watertight
    depth = cam.depth(made.vertices)
    assert depth.min() == pytest.approx(cam.top - 0.4)
    assert depth.max() == pytest.approx(cam.floor + 0.4)
    # what is cut off at both ends is beyond the faces
    assert outer_radius(cam) == pytest.approx(100.0 - math.sqrt(44.5**2 - 23.0**2))


def test_the_turret_has_a_roller_for_each_stop() -> None:
    made = turret_surface(indexer(), 44.0, 96)
    bodies = solid(made).decompose()
    assert len(bodies) == 9
    assert made.watertight
    x, y, z = made.vertices.T
    assert np.hypot(x, z).max() == pytest.approx(math.hypot(58.0, 8.0), rel=1e-3)
    assert np.abs(y).max() == pytest.approx(1.2 * 8.0)


@pytest.mark.parametrize("rotation", ["cw", pytest.param("ccw", marks=pytest.mark.slow)])
def test_cam_and_turret_turn_together_without_touching(rotation: str) -> None:
    """As they are shown: at a cam angle the rollers touch the ribs and cut nothing."""
    design = DESIGN.with_({"cam.roller_clearance_mm": PLAY, "output.theta_deg": 47.3})
    coarse = {"output.wall_step_deg": 1, "output.wall_points": 7}
    shown = gc.build(design.with_({"cam.rotation": rotation} | coarse)).assembled()
    cam, turret = (solid(shown[name]) for name in ("cam", "turret"))
    assert (cam ^ turret).volume() == 0.0
    moved = turret.translate((0.0, 0.0, PLAY))
    assert (cam ^ moved).volume() > 0.1


@pytest.mark.slow
def test_an_undercut_wall_is_told_with_its_solid() -> None:
    changes = {"cam.center_distance_mm": 75, "output.files": ["stl"], "output.wall_step_deg": 5}
    found = gc.build(DESIGN.with_({**changes, "output.wall_points": 4}))
    codes = [(one.severity, one.code) for one in found.checked]
    assert codes[:2] == [("error", "undercut")] * 2
    assert ("note", "carved-solid") in codes
    assert found.mesh.watertight
    assert "scallops" in found.facts["accuracy.how.chord_mm"]


@pytest.mark.parametrize(
    ("file", "changes"),
    [
        ("globoidal_indexer", {"output.wall_step_deg": 0.033, "output.wall_points": 2}),
        ("cylinder_cam", {"output.wall_step_deg": 0.01, "output.wall_points": 40}),
    ],
)
def test_a_solid_of_too_many_facets_is_refused_with_the_least_step(
    file: str, changes: dict[str, float]
) -> None:
    design: Any = gc.load(PROFILES / f"{file}.toml").with_(changes)
    result: Any = gc.build(design)
    with pytest.raises(gc.InfeasibleError, match="the solid would have more") as one:
        _ = result.mesh
    assert one.value.limit is not None
    places = design.output.wall_points
    for factor, feasible in ((1.001, True), (0.999, False)):
        steps = gc.build(design.with_({"output.wall_step_deg": factor * one.value.limit})).steps
        assert (result.facets(steps, places) <= result.most_facets) == feasible


@pytest.mark.parametrize("file", ["globoidal_indexer", "cylinder_cam"])
def test_the_number_of_facets_is_about_that_of_what_a_solid_is_made_from(file: str) -> None:
    result = shared(PROFILES / f"{file}.toml")
    for steps, places in ((90, 5), (180, 9)):
        if file == "cylinder_cam":
            count = len(result.solid_of(steps, places).triangles)
        else:
            made = rib_surface(result.cam, steps, places), core_surface(result.cam, steps)
            blank = blank_surface(result.cam, 0.0, steps)
            count = sum(len(one.triangles) for one in (*made, blank))
        assert result.facets(steps, places) == pytest.approx(count, rel=0.15)
