"""A Geneva wheel is drawn so that its crank's pin runs in a slot, and the locking disc holds it."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import gearcam as gc
from gearcam.pictures.drawings import Circle, Path
from gearcam.pictures.scenes import MovingBody, Scene
from helpers_pairs import PROFILES


def scene_of(slots: int, internal: bool) -> Scene:
    design = gc.load(PROFILES / "geneva.toml").with_(
        {"geneva[0].slots": slots, "geneva[0].internal": internal}
    )
    scene = gc.build(design).scene(180)
    assert scene is not None
    return scene


def outlines(scene: Scene, place: int) -> tuple[shapely.Polygon, shapely.Polygon, complex]:
    """The wheel, the disc of the crank and the middle of the pin at a place."""
    bodies = {one.name: one for one in scene.bodies}
    wheel, crank = bodies["wheel"], bodies["wheel_crank"]

    def polygon(body: MovingBody, number: int) -> shapely.Polygon:
        shape = body.features[number].shape
        assert isinstance(shape, Path)
        points = body.pose[place].apply(shape.points)
        return shapely.Polygon(np.column_stack([points.real, points.imag]))

    pins = [one.shape for one in crank.features if isinstance(one.shape, Circle)]
    pin = complex(crank.pose[place].apply(np.array([pins[0].center]))[0])
    return polygon(wheel, 1 if scene_is_internal(wheel) else 0), polygon(crank, 0), pin


def scene_is_internal(wheel: MovingBody) -> bool:
    return isinstance(wheel.features[0].shape, Circle)


@pytest.mark.parametrize("slots", [3, 6, 24])
@pytest.mark.parametrize("internal", [False, True])
def test_the_pin_is_in_a_slot_while_it_moves_the_wheel(slots: int, internal: bool) -> None:
    scene = scene_of(slots, internal)
    bodies = {one.name: one for one in scene.bodies}
    wheel = bodies["wheel"].pose
    step = np.abs(np.diff(np.asarray(wheel.turn))) > 1e-9
    moved = np.convolve(step, np.ones(4), "same") == 4.0  # not beside entry and exit
    inside = 0
    for place in np.flatnonzero(moved).tolist():
        _, _, pin = outlines(scene, place)
        seen = complex(wheel[place].inverse.apply(np.array([pin]))[0])
        pitch = 2.0 * np.pi / slots
        off = (np.angle(seen) + 0.5 * pitch) % pitch - 0.5 * pitch
        assert abs(seen) * np.sin(off) == pytest.approx(0.0, abs=1e-8)
        inside += 1
    assert inside > 20


@pytest.mark.parametrize("slots", [4, 6, 12])
def test_the_disc_never_overlaps_the_wheel_and_holds_it_at_rest(slots: int) -> None:
    scene = scene_of(slots, False)
    for place in range(0, 180, 7):
        wheel, disc, _ = outlines(scene, place)
        assert wheel.intersection(disc).area < 2e-3 * disc.area
    wheel, disc, _ = outlines(scene, 0)
    turned = shapely.affinity.rotate(wheel, 3.0, origin=wheel.centroid)
    assert turned.intersection(disc).area > 2e-3 * disc.area
