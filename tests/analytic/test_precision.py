"""Errors of sizes move the follower as the same cam with other sizes does.

A profile that was made for the sizes of a design is followed with sizes that differ: the lift is
found from the points alone. Its difference is the sensitivity, to first order.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.cams.follow import follow
from gearcam.cams.precision import added, largest, rooted, sensitivities
from gearcam.cams.wall import Wall
from gearcam.kinds.cam.tables import SIZES
from gearcam.numeric.arrays import Array, Plane
from helpers_built import built
from helpers_files import ROLLER, read
from helpers_sampling import few

_CAMS = (
    "flat_follower", "plate_cam_offset_roller", "plate_cam_oscillating", "conjugate_cams",
    "groove_cam", "translating_cam", "tappet", "valve_lever", "lathe_slide", "yoke_cam",
    "undercut_cam", "arm over a plate",
)  # fmt: skip

_SHARES = np.array([0.05, 0.11, 0.2, 0.28, 0.37, 0.45, 0.61, 0.72, 0.83, 0.93])
"""Parts of a turn, away from knots and corners."""

_POINTS = 20000


_ARM = {
    "follower.motion": "oscillating", "follower.arm_mm": 60, "follower.pivot_distance_mm": 55,
    "follower.pivot_height_mm": 5, "motion": [
        {"type": "rise", "travel_mm": 40, "law": "cycloidal", "lift_deg": 10},
        {"type": "dwell", "travel_mm": 20},
        {"type": "return", "travel_mm": 40, "law": "cycloidal"},
    ],
}  # fmt: skip
"""An arm in place of the stem on the translating cam."""


def _walls(name: str) -> list[tuple[Wall, dict[str, float]]]:
    """Return the walls of a cam, each with what links its follower to the first."""
    if name == "arm over a plate":
        cam = built(gc.load("profiles/translating_cam.toml").with_(_ARM)).cam
    else:
        cam = built(f"profiles/{name}.toml").cam
    return [(wall, cam.linked(wall)) for wall in cam.walls]


class _Made:
    """A profile as made, of points, and the lift that follows from it with other sizes."""

    def __init__(self, wall: Wall) -> None:
        self.wall, self.open = wall, wall.program.open
        grid = np.linspace(0.0, wall.program.period, _POINTS, endpoint=self.open)
        grid = grid[wall.touched(grid)]
        points, tangents = wall.curve.trace(grid, *wall.program.derivatives(grid, 1))
        self.points, self.normals = points, 1j * wall.side * tangents

    def lift(self, theta: Array, size: str, error: float) -> Array:
        """Return the lift with an error of a size."""
        follower, points = self.wall.follower, self.points
        if size in ("cam_angle", "travel"):
            theta = theta + error
        elif size == "profile":
            points = points + error * self.normals
        elif size == "pivot_distance":
            pivot: Any = follower.pivot  # pyright: ignore[reportAttributeAccessIssue]
            follower = replace(follower, pivot=pivot + getattr(follower, "hand", 1) * error)
        elif size == "pivot_height":  # as if the cam were lower
            rows = [self._at(follower, points - 1j * error * unit, np.array([x]))
                    for x in theta for unit in [1.0 if self.open else np.exp(-1j * x)]]  # fmt: skip
            return np.concatenate(rows)
        else:
            name = {"axis": "tilt", "face_offset": "offset"}.get(size, size)
            follower = replace(follower, **{name: getattr(follower, name) + error})
        return self._at(follower, points, theta)

    def _at(self, follower: Any, points: Plane, theta: Array) -> Array:
        if self.open:  # output of a cam that slides is the mirror image, and a closed profile
            points = -np.conj(points)
            beyond = 1000j * self.wall.side
            points = np.append(points, [points[-1].real - beyond, points[0].real - beyond])
        wall = self.wall
        return follow(points, follower, theta, carrier=wall.carrier, side=wall.side).lift


def _followable(wall: Wall, size: str) -> bool:
    """Whether a follower of the package can have another such size."""
    turned = size == "axis" and not wall.follower.has_centre
    return not turned and size not in ("roller_distance", "arms_angle", "face_angle")


@pytest.mark.parametrize("name", few(_CAMS))
def test_sensitivities_are_the_differences_of_the_inverse_problem(name: str) -> None:
    for wall, linked in _walls(name):
        theta = _SHARES * wall.program.period
        theta = theta[wall.touched(theta)]
        made, found = _Made(wall), sensitivities(wall, linked, theta)
        for size in found:
            assert np.isfinite(found[size]).all()
            if not _followable(wall, size):
                continue
            step = 0.1 if SIZES[size].quantity.unit == "mm" else 0.004
            still = made.lift(theta, size, 0.0)
            off = [
                (made.lift(theta, size, error) - still) / error - found[size]
                for error in (step, 0.5 * step)
            ]
            scale = float(np.abs(found[size]).max()) + 1e-3
            # what is left is of first order in the error: half of it leaves half
            assert np.abs(off[0]).max() < 0.05 * scale, (size, off)
            assert np.abs(2.0 * off[1] - off[0]).max() < 2e-4 * scale, (size, off)


@pytest.mark.parametrize("name", _CAMS)
def test_a_cam_turned_on_its_shaft_is_the_same_cam_earlier(name: str) -> None:
    # by the velocity of the metal at the contact, not by the lift's derivative
    for wall, linked in _walls(name):
        theta = _SHARES * wall.program.period
        found = sensitivities(wall, linked, theta)
        s, ds = wall.program.derivatives(theta, 1)
        points, tangents = wall.curve.trace(theta, s, ds)
        turn, shift = wall.carrier.frame(theta)
        metal = wall.carrier.passing(points * turn + shift)
        along = (np.conj(1j * wall.side * tangents * turn) * metal).real
        size = "travel" if wall.program.open else "cam_angle"
        moved, wanted = along * found["profile"], found[size]
        kept = np.isfinite(wanted)
        assert np.allclose(moved[kept], wanted[kept], rtol=1e-9, atol=1e-9)


def test_a_stem_has_closed_forms() -> None:
    (wall, linked), = _walls("plate_cam_offset_roller")  # fmt: skip
    theta = _SHARES * wall.program.period
    found = sensitivities(wall, linked, theta)
    s, ds = wall.program.derivatives(theta, 1)
    offset = getattr(wall.follower, "offset")  # noqa: B009
    slope = (ds - offset) / (wall.follower.start + s)
    assert np.allclose(found["radius"], np.hypot(1.0, slope), rtol=1e-13)
    assert np.array_equal(found["radius"], found["profile"])
    assert np.allclose(found["offset"], slope, rtol=1e-12, atol=1e-14)
    assert np.allclose(found["axis"], -ds, rtol=1e-12, atol=1e-12)


def test_a_face_out_of_square_lifts_by_the_distance_of_the_contact() -> None:
    (wall, linked), = _walls("flat_follower")  # fmt: skip
    theta = _SHARES * wall.program.period
    found = sensitivities(wall, linked, theta)
    ds = wall.program.derivatives(theta, 1)[1]
    offset = getattr(wall.follower, "offset")  # noqa: B009
    # turned counter-clockwise, the face rises on the right, where the contact is, and so sinks
    assert np.allclose(found["face_angle"], -(ds - offset), rtol=1e-12, atol=1e-12)
    assert np.allclose(found["axis"], -ds, rtol=1e-12, atol=1e-12)
    assert np.allclose(found["offset"], 0.0, atol=1e-15)
    assert np.allclose(found["profile"], 1.0, rtol=1e-15)


def test_the_second_roller_is_moved_by_its_distance_from_the_first() -> None:
    (_, first), (wall, second) = _walls("conjugate_cams")
    assert not first
    assert second == {"arms_angle": 1.0}
    theta = _SHARES * wall.program.period
    assert np.all(sensitivities(wall, second, theta)["arms_angle"] == 1.0)


def test_the_sizes_of_the_example_in_the_source() -> None:
    """s0 = 20, h = 30, e = 5, roller 10 mm; (3.125) and (3.129) give 0.2521 and -0.6874."""
    design = read(
        ROLLER,
        ("angle_deg = 90\nlift_mm = 10", "angle_deg = 120\nlift_mm = 30"),
        (
            'type = "return"\nlaw = "cycloidal"\nangle_deg = 90',
            'type = "return"\nlaw = "cycloidal"\nangle_deg = 120',
        ),
        ('type = "dwell"\nangle_deg = 90', 'type = "dwell"\nangle_deg = 60'),
        ("roller_radius_mm = 6\noffset_mm = 8", "roller_radius_mm = 10\noffset_mm = 5"),
        ("prime_radius_mm = 30", f"prime_radius_mm = {math.hypot(20.0, 5.0)!r}"),
    )
    (wall,) = built(design).cam.walls
    theta = np.array([math.pi / 3.0])
    found, made = sensitivities(wall, {}, theta), _Made(wall)
    assert math.isclose(found["offset"][0], 0.6757, abs_tol=5e-5)
    assert math.isclose(found["radius"][0], 1.2069, abs_tol=5e-5)
    for size in ("offset", "radius"):
        ends = [made.lift(theta, size, error)[0] for error in (-0.01, 0.01)]
        assert math.isclose((ends[1] - ends[0]) / 0.02, found[size][0], rel_tol=1e-4)


@pytest.mark.parametrize("how", [added, rooted])
def test_the_largest_deviation_is_that_of_a_fine_search(how: Any) -> None:
    cam = built("profiles/conjugate_cams.toml").cam
    errors = {"profile": 0.02, "arm": 0.05, "cam_angle": 0.003}
    found = largest(cam, lambda values: how(values, errors))
    assert found is not None
    best = -1.0
    for wall in cam.walls:
        x = np.linspace(0.0, wall.program.period, 50001)
        best = max(best, float(how(sensitivities(wall, cam.linked(wall), x), errors).max()))
    assert best <= found.value * (1.0 + 1e-12) < best * (1.0 + 1e-6)


def test_the_guide_is_as_sensitive_as_the_pressure_angle_is_steep() -> None:
    (wall, _), = _walls("plate_cam_offset_roller")  # fmt: skip
    angles = [wall.pressure(kind) for kind in ("rise", "return")]
    steepest = max(one.largest for one in angles if one is not None)
    found = largest(built("profiles/plate_cam_offset_roller.toml").cam, lambda by: by["offset"])
    assert found is not None
    assert math.isclose(found.value, math.tan(steepest), rel_tol=1e-13)


def test_errors_are_combined_as_said() -> None:
    values = {"profile": np.array([1.0, -2.0]), "arm": np.array([-3.0, 0.5])}
    errors = {"profile": 0.1, "arm": 0.2}
    assert np.allclose(added(values, errors), [0.7, 0.3])
    assert np.allclose(rooted(values, errors), [math.hypot(0.1, 0.6), math.hypot(0.2, 0.1)])
    assert not added(values, {}).any()


def test_nothing_is_said_where_the_follower_rests_on_a_corner() -> None:
    (wall, linked), = _walls("undercut_cam")  # fmt: skip
    corner = wall.corners[0]
    inside = np.array([0.5 * (corner.before + corner.after)])
    assert all(np.isnan(value).all() for value in sensitivities(wall, linked, inside).values())
    beside = np.array([corner.before - 1e-6, corner.after + 1e-6])
    assert all(np.isfinite(value).all() for value in sensitivities(wall, linked, beside).values())
