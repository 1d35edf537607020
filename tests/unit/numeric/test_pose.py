"""Poses against matrices of homogeneous coordinates."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcam.numeric.arrays import Plane
from gearcam.numeric.pose import UNMOVED, Pose, SpacePose

POSES = [Pose(), Pose(0.7, 3.0 - 2.0j, 5.0), Pose(-2.0, 1j), Pose(shift=4.0), Pose(math.pi)]
POINTS = np.array([0j, 1.0, 2.0 - 3.0j])


def matrix(pose: Pose) -> np.ndarray:
    c, s, shift = math.cos(pose.turn), math.sin(pose.turn), complex(pose.shift)
    return np.array([[c, -s, shift.real], [s, c, shift.imag], [0.0, 0.0, 1.0]])


def moved(matrix: np.ndarray, points: Plane) -> Plane:
    x, y, _ = matrix @ np.stack([points.real, points.imag, np.ones(len(points))])
    return x + 1j * y


@pytest.mark.parametrize("outer", POSES)
@pytest.mark.parametrize("inner", POSES)
def test_a_pose_on_a_pose_is_the_product_of_both(outer: Pose, inner: Pose) -> None:
    both = outer @ inner
    expected = moved(matrix(outer) @ matrix(inner), POINTS)
    assert both.apply(POINTS) == pytest.approx(expected, abs=1e-14)
    assert outer.apply(inner.apply(POINTS)) == pytest.approx(expected, abs=1e-14)
    assert both.height == outer.height + inner.height


@pytest.mark.parametrize("pose", POSES)
def test_the_inverse_undoes_a_pose(pose: Pose) -> None:
    expected = moved(np.linalg.inv(matrix(pose)), POINTS)
    assert pose.inverse.apply(POINTS) == pytest.approx(expected, abs=1e-14)
    assert (pose.inverse @ pose).height == 0.0


def test_n_poses_are_applied_each_to_its_point() -> None:
    turns, shifts = np.array([0.3, -1.0, 2.0]), np.array([1j, 2.0, -1.0 + 1j])
    every = Pose(turns, shifts)
    expected = [
        complex(Pose(turn, shift).apply(point))
        for turn, shift, point in zip(turns, shifts, POINTS, strict=True)
    ]
    assert every.apply(POINTS) == pytest.approx(np.array(expected), abs=1e-15)
    assert every[1:].apply(POINTS[1:]) == pytest.approx(np.array(expected[1:]), abs=1e-15)
    assert every[:, None].apply(POINTS).shape == (3, 3)
    assert every.inverse.apply(every.apply(POINTS)) == pytest.approx(POINTS, abs=1e-14)


def test_only_the_pose_of_a_body_in_its_own_frame_moves_nothing() -> None:
    assert Pose() == UNMOVED
    assert Pose(1e-9) != UNMOVED
    assert Pose(height=1e-9) != UNMOVED


AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.48, -0.6, 0.64))
SHIFTS = np.array([[1.0, -2.0, 3.0], [0.0, 0.5, 0.0], [-4.0, 0.0, 7.0]])
TURNS = np.array([0.3, -2.0, 8.0])


@pytest.mark.parametrize("axis", AXES)
def test_a_pose_in_space_turns_about_its_axis(axis: tuple[float, float, float]) -> None:
    """Held against quaternions: q v q*, multiplied out by hand of the quaternion."""
    pose = SpacePose(axis, TURNS, SHIFTS)
    own = np.array([0.7, -1.1, 2.3])
    for k, turn in enumerate(TURNS):
        real, way = math.cos(0.5 * turn), math.sin(0.5 * turn) * np.array(axis)
        doubled = 2.0 * np.cross(way, own)
        expected = own + real * doubled + np.cross(way, doubled) + SHIFTS[k]
        assert (pose.matrix[k] @ [*own, 1.0])[:3] == pytest.approx(expected, abs=1e-14)
        assert pose[k].matrix == pytest.approx(pose.matrix[k], abs=0.0)


@pytest.mark.parametrize("axis", AXES)
def test_a_mirrored_pose_is_that_of_the_mirror_image(axis: tuple[float, float, float]) -> None:
    pose, mirror = SpacePose(axis, TURNS, SHIFTS), np.diag([1.0, -1.0, 1.0, 1.0])
    assert pose.mirrored.matrix == pytest.approx(mirror @ pose.matrix @ mirror, abs=1e-14)


def test_a_pose_in_the_plane_is_the_same_in_space() -> None:
    pose, point = Pose(0.4, 3.0 - 2.0j, 5.0), 1.5 + 0.5j
    x, y, z, _ = pose.in_space.matrix @ [point.real, point.imag, 2.0, 1.0]
    assert x + 1j * y == pytest.approx(pose.apply(point), abs=1e-14)
    assert z == 7.0
