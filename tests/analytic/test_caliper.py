"""What a caliper reads on a cam, and where a grinding wheel is: closed forms, and brute force."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from numpy.typing import NDArray

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.cams.caliper import caliper, lowered, wheel
from gearcam.cams.wall import Wall
from gearcam.parts.parallel import moved
from helpers_cams import KINDS, cam
from helpers_pairs import PROFILES

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

ANGLES = np.radians(np.arange(0.0, 360.0, 7.0))

FINE = 1e-6
"""Chord tolerance of the outlines that brute force looks at, mm."""

CONVEX = ("point", "roller", "domed", "flat", "swinging face")


def walls_of(name: str) -> tuple[Wall, ...]:
    return gearcam.build(gearcam.load(PROFILES / f"{name}.toml")).cam.walls


def fine(wall: Wall) -> Plane:
    return replace(wall, tolerance=FINE).contour.points


def crossed(points: Plane, side: int) -> Array:
    """Where rays meet a polygon, chord by chord: the outermost place, or the innermost."""
    found = []
    for angle in ANGLES.tolist():
        a = points * np.exp(-1j * angle)
        b = np.roll(a, -1)
        cut = (a.imag < 0.0) != (b.imag < 0.0)
        share = a.imag[cut] / (a.imag[cut] - b.imag[cut])
        far = a.real[cut] + share * (b.real[cut] - a.real[cut])
        found.append(side * (side * far[far > 0.0]).max())
    return np.array(found)


def rested(points: Plane, side: int, radius: float) -> Array:
    """Where a wheel on a ray rests on points, whatever is tangent to what."""
    found = []
    for angle in ANGLES.tolist():
        seen = points * np.exp(-1j * angle)
        seen = seen[(np.abs(seen.imag) < radius) & (seen.real > 0.0)]
        deep = 0.0 if math.isinf(radius) else np.sqrt(radius**2 - seen.imag**2)
        found.append(side * (side * (seen.real + side * deep)).max())
    return np.array(found)


def _between_points(points: Plane, radius: float) -> float:
    """How much deeper a wheel may sink between points of the outline, at most."""
    longest = float(np.abs(np.diff(points)).max())
    return 2 * FINE + 1.5 * longest**2 / (8 * radius)


def test_an_eccentric_disc_has_the_radii_of_its_circle() -> None:
    """Of 31 mm, its centre 6 mm below the axis; flat wheels see its support function."""
    (wall,), seen = walls_of("eccentric_cam"), -6j * np.exp(-1j * ANGLES)
    np.testing.assert_allclose(wheel(wall, ANGLES, math.inf), 31.0 + seen.real, atol=1e-13)
    for radius in (0.0, 4.5, 500.0):
        found = wheel(wall, ANGLES, radius) if radius else caliper(wall, ANGLES)
        exact = seen.real + np.sqrt((31.0 + radius) ** 2 - seen.imag**2)
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-14 * (31.0 + radius) * 8)


def test_the_radii_of_a_roller_cam_agree_with_thirty_digits() -> None:
    """The parallel of the pitch curve, its root by mpmath: cycloidal, offset 8, roller 6."""
    wall, theta0 = cam("roller, offset"), mp.mpf(0.9)
    with mp.workdps(30):
        start, quarter = mp.sqrt(mp.mpf(30) ** 2 - 64), mp.pi / 2

        def place(theta: Any) -> Any:
            x = theta / quarter
            s = 10 * (x - mp.sin(2 * mp.pi * x) / (2 * mp.pi))
            ds = 10 / quarter * (1 - mp.cos(2 * mp.pi * x))
            way = mp.mpc(start + s, ds - 8)
            centre = mp.mpc(8, start + s) - mp.mpc(0, 6) * way / abs(way)
            return centre * mp.expj(-theta)

        for degree in (40, 55, 70):
            angle = mp.radians(degree)
            root = mp.findroot(lambda t, a=angle: mp.im(place(t) * mp.expj(-a)), theta0)
            exact = abs(place(root))
            found = caliper(wall, np.array([float(angle)]))[0]
            assert abs(mp.mpf(float(found)) - exact) < mp.mpf("2e-14") * exact


@pytest.mark.parametrize("kind", KINDS)
def test_the_radii_are_those_of_the_fine_outline(kind: str) -> None:
    for clockwise in (False, True):
        wall = cam(kind, clockwise=clockwise)
        off = caliper(wall, ANGLES) - crossed(fine(wall), wall.side)
        assert 0.0 < np.abs(off).max() < 3 * FINE


@pytest.mark.parametrize("name", ["groove_cam", "conjugate_cams", "undercut_cam", "yoke_cam"])
def test_walls_outside_the_roller_and_edges_are_read_too(name: str) -> None:
    walls = walls_of(name)
    for wall in walls:
        points = fine(wall)
        off = caliper(wall, ANGLES) - crossed(points, wall.side)
        assert np.abs(off).max() < 5 * FINE
        off = wall.side * (wheel(wall, ANGLES, 3.0) - rested(points, wall.side, 3.0))
        assert -1e-12 < off.min() <= off.max() < _between_points(points, 3.0)
    assert name != "undercut_cam" or walls[0].edges


@pytest.mark.parametrize("kind", CONVEX)
def test_a_wheel_rests_where_no_point_of_the_outline_is_in_it(kind: str) -> None:
    wall = cam(kind, "3-4-5", prime_radius=60.0) if kind == "roller" else cam(kind, "3-4-5", 3.0)
    for radius in (2.0, 25.0, math.inf):
        if radius > wall.profile_radius[1]:
            continue
        off = wheel(wall, ANGLES, radius) - rested(fine(wall), 1, radius)
        assert -1e-12 < off.min() <= off.max() < _between_points(fine(wall), radius)


def test_a_flat_wheel_rests_on_an_edge() -> None:
    wall = cam("flat", "cycloidal", 20.0, base_radius=15.0)
    assert wall.edges
    off = wheel(wall, ANGLES, math.inf) - rested(fine(wall), 1, math.inf)
    assert -1e-12 < off.min() <= off.max() < 2 * FINE


def test_a_wheel_as_large_as_the_roller_has_its_centre_on_the_pitch_curve() -> None:
    wall = cam("roller")
    pitch = replace(wall, tolerance=FINE).pitch_contour.points
    off = wheel(wall, ANGLES, 6.0) - crossed(pitch, 1)
    assert np.abs(off).max() < 3 * FINE
    assert np.abs(wheel(wall, ANGLES, 6.1) - crossed(pitch, 1)).max() > 0.09


@pytest.mark.parametrize("kind", ["roller", "flat", "swinging face", "swinging roller", "point"])
def test_clearance_is_taken_off_along_the_normals(kind: str) -> None:
    wall = cam(kind)
    parallel = moved(replace(wall, tolerance=FINE).contour, -0.2).points
    off = caliper(lowered(wall, 0.2), ANGLES) - crossed(parallel, 1)
    assert np.abs(off).max() < 10 * FINE


def test_a_wheel_that_does_not_reach_a_hollow_is_refused_with_one_that_does() -> None:
    (wall,) = walls_of("undercut_cam")
    deepest = wall.profile_radius[1]
    for radius in (30.0, math.inf):
        with pytest.raises(InfeasibleError, match=r"wheel does not reach.*wheel_radius_mm") as told:
            wheel(wall, ANGLES, radius)
        assert "a wheel up to 26.49 mm" in told.value.nearest
    wheel(wall, ANGLES, 26.49)
    # a point whose velocity jumps makes an inner corner
    vars(wall)["profile_radius"] = (0.0, 0.0)
    with pytest.raises(InfeasibleError, match="no wheel reaches an inner corner"):
        wheel(wall, ANGLES, 1.0)
    # the parallel of a hollow that is too tight crosses itself
    vars(wall)["profile_radius"] = (0.0, math.inf)
    assert deepest < 30.0
    with pytest.raises(InfeasibleError, match="a smaller wheel"):
        wheel(wall, ANGLES, 60.0)
