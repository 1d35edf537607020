"""Disc cams give the published numbers, to the printed digits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.measures import Range
from helpers_cams import (
    TURN,
    angles,
    back,
    cam,
    dense,
    follower_of,
    program,
    rise,
    there_and_back,
)

ANGLE = 5e-7
"""Half of the last digit of a printed angle, deg, and of a printed radius, mm."""

SIZE = 5e-10
"""The same of perimeters, areas and lengths that are printed with nine digits."""


def degrees(found: Range | None) -> tuple[float, float]:
    assert found is not None
    return math.degrees(found.low.value), math.degrees(found.high.value)


def smallest_radius(found: Range | None) -> float:
    assert found is not None
    return 1.0 / found.high.value


def test_the_roller_with_an_offset() -> None:
    made = cam("roller, offset")
    assert degrees(made.pressure("rise")) == pytest.approx((-15.466010, 7.969733), abs=ANGLE)
    assert degrees(made.pressure("return")) == pytest.approx((-31.810726, -11.617196), abs=ANGLE)
    radius = smallest_radius(made.pitch_curvature("rise"))
    assert radius == pytest.approx(22.670419, abs=ANGLE)
    assert made.pressure("dwell") is not None
    assert made.pressure("segment") is None


@pytest.mark.parametrize(
    ("kind", "angle", "radius"),
    [("roller", 20.144742, 23.796403), ("roller, offset back", 31.810726, 24.749139)],
)
def test_the_roller_with_other_offsets(kind: str, angle: float, radius: float) -> None:
    made = cam(kind)
    found = made.pressure("rise")
    assert found is not None
    assert math.degrees(found.largest) == pytest.approx(angle, abs=ANGLE)
    assert found.largest == found.high.value
    radii = smallest_radius(made.pitch_curvature("rise"))
    assert radii == pytest.approx(radius, abs=ANGLE)


def test_the_common_shortcuts_are_not_taken() -> None:
    """The radial formula gives 14.448704 deg and 23.796403 mm, both on the unsafe side."""
    made = cam("roller, offset")
    found = made.pressure("rise")
    assert found is not None
    assert math.degrees(found.largest) > 14.448704 + 1.0
    assert smallest_radius(made.pitch_curvature()) < 23.796403 - 1.0


def test_the_return_is_the_rise_of_the_opposite_offset() -> None:
    """Time runs backwards: angles change their signs, radii do not."""
    made, other = cam("roller, offset"), cam("roller, offset back")
    low, high = degrees(made.pressure("return"))
    assert degrees(other.pressure("rise")) == pytest.approx((-high, -low), abs=1e-9)
    one, two = (
        smallest_radius(c.pitch_curvature(k)) for c, k in ((made, "return"), (other, "rise"))
    )
    assert one == pytest.approx(two, rel=1e-12)


def test_the_flat_face() -> None:
    made = cam("flat")
    assert made.size.perimeter == pytest.approx(282.743338823, abs=SIZE)
    assert made.size.area == pytest.approx(6328.539219167, abs=SIZE)
    place, radius = made.contact_place, made.face_radius
    assert place is not None
    assert radius is not None
    assert place.largest == pytest.approx(12.732395447, abs=SIZE)
    assert -place.low.value == pytest.approx(place.high.value, rel=1e-13)
    assert radius.low.value == pytest.approx(23.573687214, abs=SIZE)
    assert made.profile_radius == (radius.low.value, math.inf)
    assert made.size.area_error < 1e-9


def test_the_flat_face_by_its_integrals() -> None:
    """Perimeter ``2*pi*Rb + integral of s``; area ``1/2 integral of (Rb + s)^2 - s'^2``.

    Of a cycloidal rise of L in an angle b: the integral of s is L*b/2, that of s^2
    ``L^2*b*(1/3 + 5/(8*pi^2))`` and that of s'^2 ``3*L^2/(2*b)``.
    """
    base, lift, b = 50.0, 7.0, math.radians(100.0)
    top = math.radians(60.0)
    made = cam("flat", lift=lift, degrees=(100.0, 60.0, 100.0, 100.0), base_radius=base)
    way = lift * (b + top)
    assert made.size.perimeter == pytest.approx(TURN * base + way, rel=1e-13)
    # the cross term -2*x*sin(2*pi*x)/(2*pi) gives 1/(2*pi^2), the sine's square 1/(8*pi^2)
    square = 2 * lift**2 * b * (1 / 3 + 0.5 / math.pi**2 + 0.125 / math.pi**2) + lift**2 * top
    speed = 2 * 1.5 * lift**2 / b
    area = 0.5 * (TURN * base**2 + 2 * base * way + square - speed)
    assert made.size.area == pytest.approx(area, rel=1e-13)
    place = made.contact_place
    assert place is not None
    assert place.high.value == pytest.approx(2 * lift / b, rel=1e-13)


def harmonic_circle(name: str, clockwise: bool = False) -> DiscCam:
    """A flat face on ``s = e*(1 - cos(theta))`` with e = 5 mm, Rb = 30 mm."""
    more: dict[str, Any] = {"formula": "(1 - cos(pi*x))/2"} if name == "formula" else {}
    phases = [rise(name, 180.0, 10.0, **more), back(name, 180.0, **more)]
    found = follower_of("flat", base_radius=30.0)
    return make_cam(program(phases), found, clockwise=clockwise, tolerance=1e-4)


@pytest.mark.parametrize("name", ["harmonic", "formula"])
def test_a_harmonic_lift_of_a_flat_face_is_a_circle(name: str) -> None:
    made = harmonic_circle(name)
    off = np.abs(dense(made) + 5j) - 35.0
    assert np.abs(off).max() < 1e-12
    assert np.abs(np.abs(made.contour.vertices @ [1, 1j] + 5j) - 35.0).max() < 1e-12
    assert made.size.perimeter == pytest.approx(TURN * 35.0, rel=1e-13)
    assert made.size.area == pytest.approx(0.5 * TURN * 35.0**2, rel=1e-13)
    radius = made.face_radius
    assert radius is not None
    assert (radius.low.value, radius.high.value) == pytest.approx((35.0, 35.0), rel=1e-13)
    assert made.program.continuity == 3
    assert made.program.jumps == ()


def test_the_circle_turns_clockwise_too() -> None:
    assert np.abs(np.abs(dense(harmonic_circle("harmonic", True)) + 5j) - 35.0).max() < 1e-12


@pytest.mark.parametrize("kind", ["roller, offset", "domed", "swinging roller", "swinging dome"])
def test_the_profile_is_a_parallel_of_the_pitch_curve(kind: str) -> None:
    """``rho_pitch = rho_profile + r``, and every point of the profile is r from its centre."""
    made = cam(kind, lift=6.0)
    theta, radius = angles(200), made.follower.radius
    found = made.motion(theta)
    np.testing.assert_allclose(found["rho_pitch"], made.radii(theta) + radius, rtol=1e-13)
    assert np.ptp(found["rho_pitch"]) > 1.0
    points = made.places(200)[1]
    turned = TURN * np.arange(200) / 200
    centres, _ = made.pitch_curve.trace(turned, *made.program.derivatives(turned, 1))
    np.testing.assert_allclose(np.abs(points - centres), radius, rtol=1e-13)
    # the three curves' perimeters differ by 2*pi*r each (Steiner), whatever their form
    outer = made.pitch_contour.moments.area
    inner = made.size
    steiner = inner.area + radius * inner.perimeter + math.pi * radius**2
    assert outer == pytest.approx(steiner, rel=1e-9)


def test_extremes_are_roots_and_not_samples() -> None:
    """The largest pressure angle, polished by a golden section of the closed formula."""
    made = cam("roller, offset")
    b, lift, start = math.pi / 2, 10.0, math.sqrt(30.0**2 - 8.0**2)

    def alpha(t: float) -> float:
        s = lift * (t / b - math.sin(TURN * t / b) / TURN)
        return math.atan2(lift / b * (1 - math.cos(TURN * t / b)) - 8.0, start + s)

    low, high = 0.5, 1.2
    for _ in range(200):
        one, two = high - 0.618 * (high - low), low + 0.618 * (high - low)
        low, high = (one, high) if alpha(one) < alpha(two) else (low, two)
    found = made.pressure("rise")
    assert found is not None
    assert found.high.value == pytest.approx(alpha(low), rel=1e-14)
    assert found.high.theta == pytest.approx(low, abs=1e-6)
    grid = made.motion(np.linspace(0.0, b, 5001)[:-1])["pressure"]
    assert grid.max() < found.high.value
    assert found.low.theta == pytest.approx(0.0, abs=1e-11)
    assert found.low.value == pytest.approx(math.atan2(-8.0, start), rel=1e-14)


def test_dwells_do_not_count_for_pressure_angles() -> None:
    """On the upper dwell of an offset follower the angle is its own; on rises it is larger."""
    made = cam("roller, offset")
    upper = math.atan2(-8.0, math.sqrt(30.0**2 - 64.0) + 10.0)
    assert degrees(made.pressure("dwell"))[1] == pytest.approx(math.degrees(upper), abs=1e-9)
    only_rise = degrees(made.pressure("rise"))
    assert only_rise[1] > math.degrees(upper)


def test_programs_of_other_laws_have_the_peaks_of_their_laws() -> None:
    """A phase scales velocity by L/b, acceleration by L/b^2, jerk by L/b^3 (000 3.4)."""
    b = math.radians(70.0)
    for name, (velocity, acceleration, jerk) in {
        "cycloidal": (2.0, 6.2831853072, 39.4784176044),
        "3-4-5": (1.875, 5.7735026919, 60.0),
        "modified-trapezoid": (2.0, 4.8881237628, 61.4259748124),
        "modified-sine": (1.7596033860, 5.5279570705, 69.4663572887),
    }.items():
        made = there_and_back(name, 12.0, (70.0, 100.0, 120.0, 70.0))
        scaled = (velocity * 12.0 / b, acceleration * 12.0 / b**2, jerk * 12.0 / b**3)
        assert made.peaks == pytest.approx(scaled, rel=1e-10)


@pytest.mark.parametrize("kind", ["roller, offset", "swinging roller", "domed"])
def test_a_rising_shock_leaves_an_arc_of_the_roller(kind: str) -> None:
    """Where the velocity jumps up, the follower turns about its centre: a concave arc of r."""
    made = cam(kind, "constant-velocity")
    convex, concave = made.profile_radius
    assert convex == 0.0
    assert concave == pytest.approx(made.follower.radius, rel=1e-12)


def test_shocks_of_a_point_are_corners() -> None:
    made = cam("point", "constant-velocity")
    assert made.profile_radius == (0.0, 0.0)
    smooth = cam("point", "cycloidal").profile_radius
    assert min(smooth) > 1.0


def test_extremes_stand_at_knots_inside_laws_too() -> None:
    """Constant acceleration: just after the middle of the rise ``s'' = -4*L/b^2``, s = L/2."""
    lift, b = 10.0, math.pi / 2
    made = cam("flat", "constant-acceleration", lift)
    radius, place = made.face_radius, made.contact_place
    assert radius is not None
    assert place is not None
    assert radius.low.value == pytest.approx(40.0 + lift / 2 - 4 * lift / b**2, rel=1e-10)
    assert radius.high.value == pytest.approx(40.0 + lift / 2 + 4 * lift / b**2, rel=1e-10)
    assert place.high.value == pytest.approx(2 * lift / b, rel=1e-10)
    assert place.high.theta == pytest.approx(b / 2, abs=1e-9)


def test_the_pitch_curve_has_corners_at_shocks() -> None:
    """The centre of a roller turns a corner there, and nowhere else."""
    made = cam("roller, offset", "constant-velocity")
    runs = made.pitch_contour.runs
    knots = made.program.knots[:-1]
    corners, _ = made.pitch_curve.trace(knots, *made.program.derivatives(knots, 1))
    starts = np.array([run.points[0] for run in runs])
    assert len(runs) == 4
    off = np.abs(starts[:, None] - corners).min(axis=0)
    assert off.max() < 1e-12
    assert len(cam("roller, offset").pitch_contour.runs) == 1
