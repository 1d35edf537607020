"""Cams keep their tolerance at the price that curvature asks for, and agree with a cutter's passes.

A chord of length l is off by ``kappa*l^2/8``: polygon, area and lift converge with the square of
the number of vertices, which grows with ``tolerance^-1/2``. A follower that is subtracted at N cam
angles leaves ridges of height ``delta^2*(kappa + 1/r)/8`` over its steps ``delta ~ 1/N``: the area
of the boolean sweep converges to that of the profile with order 2, corners included, as long as the
angles hold the knots at which the velocity jumps.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.cams.disc import DiscCam
from gearcam.cams.follow import follow
from gearcam.numeric.contour import polygon_area
from helpers_cams import TURN, angles, cam, corners_of, dense, lever, witness_of
from helpers_sampling import few
from witness.cam_sweep import swept

STEEP = (60.0, 90.0, 60.0, 150.0)
TOLERANCES = np.geomspace(1e-2, 1e-5, 7)

SMOOTH = ["roller, offset", "domed", "flat", "swinging roller", "swinging face, near"]


@cache
def at(kind: str, tolerance: float) -> DiscCam:
    return cam(kind, "3-4-5", 8.0, tolerance=tolerance)


def slope(x: Any, y: Any) -> float:
    return float(np.polyfit(np.log(x), np.log(np.abs(y)), 1)[0])


def counts(kind: str) -> list[int]:
    return [len(at(kind, float(t)).contour.vertices) for t in TOLERANCES]


@pytest.mark.parametrize("kind", SMOOTH)
def test_vertices_grow_with_the_root_of_the_tolerance(kind: str) -> None:
    assert slope(TOLERANCES, counts(kind)) == pytest.approx(-0.5, abs=0.02)


@pytest.mark.parametrize("kind", SMOOTH)
def test_the_area_converges_with_the_square_of_the_vertices(kind: str) -> None:
    exact = at(kind, TOLERANCES[0]).size.area
    errors = [polygon_area(at(kind, float(t)).contour.points) - exact for t in TOLERANCES]
    assert slope(counts(kind), errors) == pytest.approx(-2.0, abs=0.1)


@pytest.mark.parametrize("kind", SMOOTH)
def test_the_lift_converges_with_the_square_of_the_vertices(kind: str) -> None:
    theta, errors = angles(500), []
    for made in (at(kind, float(tolerance)) for tolerance in TOLERANCES):
        found = follow(corners_of(made), made.follower, theta)
        errors.append(np.abs(found.lift - made.program.derivatives(theta, 0)[0]).max())
    assert slope(counts(kind), errors) == pytest.approx(-2.0, abs=0.1)
    assert errors[-1] * lever(at(kind, float(TOLERANCES[-1]))) < 2.0 * TOLERANCES[-1]


@pytest.mark.parametrize("kind", SMOOTH)
@pytest.mark.parametrize("tolerance", few([3e-4, 1e-2]))
def test_the_polygon_keeps_its_tolerance(kind: str, tolerance: float) -> None:
    """By the distance of much finer points from the polygon."""
    made = cam(kind, "3-4-5", 8.0, tolerance=tolerance)
    fine = dense(at(kind, float(TOLERANCES[-1])))[::5]
    ring: Any = shapely.LinearRing(made.contour.vertices)
    shapely.prepare(ring)
    worst = shapely.distance(shapely.points(np.column_stack([fine.real, fine.imag])), ring).max()
    assert 0.5 * tolerance <= worst <= tolerance
    assert made.contour.chord_error == pytest.approx(worst, rel=0.05)
    assert made.contour.chord_error <= tolerance


@pytest.mark.parametrize("kind", SMOOTH)
def test_vertices_lie_on_the_profile(kind: str) -> None:
    made = at(kind, 1e-3)
    ring: Any = shapely.LinearRing(at(kind, float(TOLERANCES[-1])).contour.vertices)
    shapely.prepare(ring)
    off = shapely.distance(shapely.points(made.contour.vertices), ring)
    assert off.max() <= 1.01 * TOLERANCES[-1]


@pytest.mark.parametrize("kind", SMOOTH)
def test_few_vertices_more_than_curvature_asks_for(kind: str) -> None:
    """The integral of ``sqrt(kappa/(8*tolerance)) ds`` from turning angles of the finest points."""
    step = np.diff(dense(at(kind, float(TOLERANCES[-1]))))
    step = step[np.abs(step) > 0.0]
    turning = np.abs(np.angle(step[1:] * np.conj(step[:-1])))
    length = 0.5 * (np.abs(step[1:]) + np.abs(step[:-1]))
    root = float(np.sqrt(turning * length / 8.0).sum())
    for tolerance in (1e-2, 1e-3, 1e-4):
        made = (
            at(kind, tolerance)
            if tolerance in TOLERANCES
            else cam(kind, "3-4-5", 8.0, tolerance=tolerance)
        )
        least = root / np.sqrt(tolerance)
        assert 0.97 * least <= len(made.contour.vertices) <= 1.1 * least + 4
        assert made.sampler.least == pytest.approx(least, rel=0.03)


# --- the boolean witness --------------------------------------------------------------------------

Case = tuple[str, str, float, tuple[float, float, float, float], dict[str, Any]]

SWEPT: dict[str, Case] = {
    "roller": ("roller, offset", "cycloidal", 10.0, STEEP, {}),
    "dome": ("domed", "cycloidal", 10.0, STEEP, {}),
    "roller, undercut": ("roller, offset", "cycloidal", 10.0, STEEP, {"roller_radius": 22.0}),
    "roller larger than the curve": ("roller", "cycloidal", 10.0, STEEP, {"roller_radius": 29.0}),
    "roller with shocks": ("roller, offset back", "constant-velocity", 10.0, STEEP, {}),
    "swinging roller, undercut": (
        "swinging roller",
        "cycloidal",
        12.0,
        (45.0, 90.0, 45.0, 180.0),
        {"roller_radius": 25.0},
    ),
    "swinging roller with shocks": ("swinging roller", "constant-velocity", 12.0, STEEP, {}),
    "face": ("flat", "cycloidal", 10.0, STEEP, {"base_radius": 60.0}),
    "face, undercut": ("flat", "cycloidal", 10.0, STEEP, {"base_radius": 20.0}),
    "face with shocks": ("flat", "constant-velocity", 10.0, STEEP, {}),
    "swinging face, undercut": ("swinging face", "cycloidal", 12.0, STEEP, {}),
    "swinging face with shocks": ("swinging face, far", "constant-velocity", 12.0, STEEP, {}),
}


def sweep(case: Case, made: DiscCam, count: int) -> Any:
    theta = TURN * np.arange(count) / count
    lift = made.program.derivatives(theta, 0)[0]
    blank = 1.2 * float(np.abs(made.contour.vertices).max())
    return swept(witness_of(case[0], **case[4]), theta, lift, blank, count)


@pytest.mark.parametrize("name", SWEPT)
def test_a_swept_follower_leaves_the_trimmed_profile(name: str) -> None:
    case = SWEPT[name]
    kind, law, lift, degrees, changed = case
    made = cam(kind, law, lift, degrees, **changed)
    steps = [72, 144, 288, 576] if made.follower.has_centre else [96, 192, 384, 768]
    assert bool(made.corners) == ("undercut" in name or "shocks" in name or "larger" in name)
    left = [sweep(case, made, count) for count in steps]
    over = [region.area - made.size.area for region in left]
    assert min(over) > 0.0
    assert slope(steps, over) == pytest.approx(-2.0, abs=0.1)
    # what is left of the difference is a thin rim of ridges
    assert over[-1] < 2e-3 * made.size.area
    apart = shapely.symmetric_difference(left[-1], made.contour.polygon).area
    assert apart < 1.1 * over[-1] + made.size.perimeter * made.contour.chord_error


def test_a_wrong_trimming_is_seen() -> None:
    """The control: a roller 20 um larger than the one that is swept; the area stops converging."""
    case = SWEPT["roller, undercut"]
    made = cam(case[0], case[1], case[2], case[3], roller_radius=22.02)
    over = [sweep(case, made, count).area - made.size.area for count in (72, 144, 288, 576)]
    assert slope([72, 144, 288, 576], over) > -1.9
