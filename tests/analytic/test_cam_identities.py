"""Pressure angle and curvature of every follower, from finite differences of the geometry alone.

`witness.cam_sweep` writes down where the follower stands and differentiates in thirty digits; none
of the closed formulas of the package is used. Then the printed formulas of the textbook, and
eccentric circles: every follower on a circle has a closed lift, whose cam must be that circle.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.cams.disc import DiscCam, make_cam
from helpers_cams import (
    KINDS,
    TURN,
    Sizes,
    angles,
    back,
    cam,
    dense,
    follower_of,
    program,
    rise,
    sizes_of,
    there_and_back,
    witness_of,
)
from witness.cam_sweep import Exact, Motion, dot, mp

DEGREES = (80.0, 70.0, 110.0, 100.0)
DIGITS = 30
EXACT = 1e-12


@pytest.fixture(autouse=True)
def digits() -> Any:
    with mp.workdps(DIGITS):
        yield


def samples(count: int, seed: int) -> np.ndarray:
    """Random cam angles on the rise and on the return, and one on a dwell."""
    u = np.radians(np.random.default_rng(seed).uniform(0.5, 79.5, count))
    down = np.radians(np.random.default_rng(seed + 1).uniform(150.5, 259.5, count))
    return np.concatenate([u, down, np.radians([123.4])])


def close(got: float, exact: Any, scale: float | None = None) -> None:
    unit = abs(exact) if scale is None else scale
    assert abs(got - exact) <= EXACT * unit


@pytest.mark.parametrize("kind", KINDS)
def test_contact_by_differences(kind: str) -> None:
    law = ("cycloidal", "3-4-5")[KINDS.index(kind) % 2]
    made = cam(kind, law, 9.0, DEGREES)
    exact = Exact(witness_of(kind), Motion(law, 9.0, DEGREES, made.follower.angular))
    theta = samples(3, 5)
    found, radii = made.motion(theta), made.radii(theta)
    contact: Any = made.curve.contact(theta, 0)
    for k, at in enumerate(theta):
        t = mp.mpf(float(at))
        close(found["s"][k], exact.motion(t, mp), 1.0)
        close(found["pressure"][k], exact.pressure(t), 1.0)
        if made.follower.has_centre:
            close(1.0 / found["rho_pitch"][k], exact.curvature(exact.pitch, t))
            close(contact.pitch_speed.c[0][k], abs(mp.diff(exact.pitch, t)))
        close(1.0 / radii[k], exact.curvature(exact.contact, t))
        if made.curve.rounded:
            close(contact.speed.c[0][k], abs(mp.diff(exact.contact, t)))


@pytest.mark.parametrize("kind", KINDS)
def test_profile_points_by_differences(kind: str) -> None:
    made = cam(kind, "3-4-5", 9.0, DEGREES)
    exact = Exact(witness_of(kind), Motion("3-4-5", 9.0, DEGREES, made.follower.angular))
    theta, points, normals = made.places(12)
    assert len(theta) == 12
    for at, point, normal in zip(theta + 0.0, points, normals, strict=True):
        t = mp.mpf(float(at)) + mp.mpf("1e-30")
        z, along = exact.contact(t), mp.diff(exact.contact, t)
        assert abs(complex(z) - point) < 1e-12
        # drawn clockwise, the outside lies to the left
        assert abs(complex(1j * along / abs(along)) - normal) < 1e-12


@pytest.mark.parametrize(
    ("kind", "changed"),
    [
        ("roller", {"roller_radius": 25.0}),
        ("swinging roller", {"roller_radius": 36.0}),
        ("flat", {"base_radius": 15.0}),
        ("swinging face, near", {"base_radius": 40.0}),
    ],
)
def test_undercut_has_a_negative_radius(kind: str, changed: dict[str, Any]) -> None:
    """Where the contact goes backwards along the profile, seen by the turning of its normal."""
    steep = (60.0, 90.0, 60.0, 150.0)
    made = cam(kind, "cycloidal", 14.0, steep, **changed)
    exact = Exact(
        witness_of(kind, **changed), Motion("cycloidal", 14.0, steep, made.follower.angular)
    )
    theta = np.radians(np.linspace(1.0, 59.0, 14))
    radii = made.radii(theta)
    assert (radii > 0.0).any()
    assert (radii < 0.0).any()
    for at, radius in zip(theta, radii, strict=True):
        t = mp.mpf(float(at))

        def normal(u: Any) -> Any:
            f = exact.follower
            if f.flat:
                return f.normal(exact.position(u), mp) * mp.exp(-1j * u)
            way = exact.pitch(u) - exact.contact(u)
            return way / abs(way)

        # dz = rho dn for an outward normal n
        turned, moved = mp.diff(normal, t), mp.diff(exact.contact, t)
        close(radius, dot(turned, moved) / dot(turned, turned))


def test_the_textbook_formulas_of_a_sliding_roller() -> None:
    """000 (3.21) and (3.26), written out as printed."""
    made = cam("roller, offset", "3-4-5", 9.0, DEGREES)
    theta = angles(300)
    found = made.motion(theta)
    s, ds, d2s = found["s"], found["ds"], found["d2s"]
    e, height = 8.0, math.sqrt(30.0**2 - 8.0**2) + s
    np.testing.assert_allclose(np.tan(found["pressure"]), (ds - e) / height, rtol=1e-12)
    radius = (
        ((ds - e) ** 2 + height**2) ** 1.5
        / ((ds - e) * (2 * ds - e) + height * (height - d2s))
        * np.sign(height**2 - e * (ds - e))
    )
    np.testing.assert_allclose(found["rho_pitch"], radius, rtol=1e-12)
    np.testing.assert_allclose(made.radii(theta), radius - 6.0, rtol=1e-12)


def test_the_textbook_formulas_of_a_swinging_roller() -> None:
    """000 (3.33) and (3.35); the sign of (3.35) is turned: it counts the other way around."""
    made = cam("swinging roller", "3-4-5", 9.0, DEGREES)
    theta = angles(300)
    found = made.motion(theta)
    d, arm = 100.0, 90.0
    psi = math.acos((d**2 + arm**2 - 40.0**2) / (2 * d * arm)) + found["s"]
    one = 1.0 + found["ds"]
    tangent = (arm * one - d * np.cos(psi)) / (d * np.sin(psi))
    np.testing.assert_allclose(np.tan(found["pressure"]), tangent, rtol=1e-11)
    above = (d**2 + arm**2 * one**2 - 2 * arm * d * one * np.cos(psi)) ** 1.5
    below = (
        d * arm * found["d2s"] * np.sin(psi)
        + d * arm * one * (1 + one) * np.cos(psi)
        - d**2
        - arm**2 * one**3
    )
    sign = np.sign(-(d**2) - arm**2 * one + d * arm * (1 + one) * np.cos(psi))
    np.testing.assert_allclose(found["rho_pitch"], above / below * sign, rtol=1e-11)


def test_a_flat_face_by_the_textbook() -> None:
    """000 (3.42), (3.43): touched at s', radius base + s + s''."""
    made = cam("flat", "3-4-5", 9.0, DEGREES)
    theta = angles(300)
    found, contact = made.motion(theta), made.curve.contact(theta, 0)
    np.testing.assert_allclose(contact.place.c[0], found["ds"], atol=1e-13)
    np.testing.assert_allclose(made.radii(theta), 40.0 + found["s"] + found["d2s"], rtol=1e-13)
    assert np.all(found["pressure"] == 0.0)


# --- eccentric circles ---------------------------------------------------------------------------

RADIUS, AWAY = 40.0, 7.0
"""Of the circle, and its centre's distance from the axis, below it at theta = 0."""


def circle_lift(m: Sizes, turn: str) -> str:
    """The follower's place on the circle, as a formula of its centre ``AWAY*(sin, -cos)(turn)``."""
    x, y = f"({AWAY}*sin({turn}))", f"(0 - {AWAY}*cos({turn}))"
    if not m.oscillating:
        if m.flat:
            return f"({y} + {RADIUS})"
        return f"({y} + sqrt({(RADIUS + m.radius) ** 2!r} - ({x} - {m.offset!r})**2))"
    across, square = f"({m.pivot!r} - {x})", f"(({m.pivot!r} - {x})**2 + {y}**2)"
    if m.flat:
        rest = f"asin({RADIUS + m.face_offset!r}/sqrt({square}))"
    else:
        reach = m.arm**2 - (RADIUS + m.radius) ** 2
        rest = f"acos(({reach!r} + {square})/({2 * m.arm!r}*sqrt({square})))"
    return f"(atan({y}/{across}) + {rest})"


def place(m: Sizes, turn: float) -> float:
    """The same as a number: the touching circle is seen from where the follower is guided."""
    x, y, reach = AWAY * math.sin(turn), -AWAY * math.cos(turn), RADIUS + m.radius
    if not m.oscillating:
        return y + (RADIUS if m.flat else math.sqrt(reach**2 - (x - m.offset) ** 2))
    seen, far = math.atan2(y, m.pivot - x), math.hypot(m.pivot - x, y)
    if m.flat:
        return seen + math.asin((RADIUS + m.face_offset) / far)
    return seen + math.acos((m.arm**2 + far**2 - reach**2) / (2 * m.arm * far))


def circle_cam(kind: str, clockwise: bool = False) -> DiscCam:
    """The cam that lifts the follower as the circle does: one rise, one return, by formulas."""
    m = sizes_of(follower_of(kind))
    low, high = place(m, 0.0), place(m, math.pi)
    up = f"({circle_lift(m, 'pi*x')} - {low!r})/{high - low!r}"
    down = f"({high!r} - {circle_lift(m, 'pi + pi*x')})/{high - low!r}"
    swings = m.oscillating
    lift = math.degrees(high - low) if swings else high - low
    phases = [
        rise("formula", 180.0, lift, swings=swings, formula=up),
        back("formula", 180.0, formula=down),
    ]
    motion = program(phases, swings=swings)
    return make_cam(motion, replace(m, start=low).follower, clockwise=clockwise, tolerance=1e-3)


@pytest.mark.parametrize(
    ("kind", "clockwise"),
    [*((kind, False) for kind in KINDS), ("roller, offset", True), ("swinging face, near", True)],
)
def test_an_eccentric_circle_under_every_follower(kind: str, clockwise: bool) -> None:
    made = circle_cam(kind, clockwise)
    assert made.program.continuity == 3
    middle = complex(0.0, -AWAY)
    points = np.concatenate([run.points for run in made.contour.runs])
    assert np.abs(np.abs(points - middle) / RADIUS - 1.0).max() < 1e-12
    assert made.size.perimeter == pytest.approx(TURN * RADIUS, rel=1e-12)
    assert made.size.area == pytest.approx(math.pi * RADIUS**2, rel=1e-12)
    radii = made.radii(angles(90))
    np.testing.assert_allclose(radii, RADIUS, rtol=1e-10)
    assert made.undercut == []
    convex, concave = made.profile_radius
    assert (convex, concave) == (pytest.approx(RADIUS, rel=1e-10), math.inf)


def test_a_wrong_circle_is_seen() -> None:
    """The control: the roller's offset other than the formula's."""
    made = circle_cam("roller, offset")
    m = sizes_of(made.follower)
    points = dense(make_cam(made.program, replace(m, offset=-8.0).follower))
    assert np.abs(np.abs(points - complex(0.0, -AWAY)) - RADIUS).max() > 0.1


def test_a_constant_lift_over_half_a_turn_is_an_arc() -> None:
    """On its dwells every profile is an arc about the axis."""
    for kind in KINDS:
        made = cam(kind, degrees=DEGREES)
        theta, points, _ = made.places(360)
        top = points[(theta > np.radians(80.5)) & (theta < np.radians(149.5))]
        assert np.ptp(np.abs(top)) < 1e-12 * abs(top[0])
        assert len(top) > 60
    assert there_and_back("cycloidal", 1.0).stretches[1].kind == "dwell"


@pytest.mark.parametrize("kind", ["roller, offset", "swinging face, near"])
def test_a_clockwise_cam_is_the_mirror_image(kind: str) -> None:
    one, two = (cam(kind, degrees=DEGREES, clockwise=turned) for turned in (False, True))
    for here, there in zip(one.places(90)[1:], two.places(90)[1:], strict=True):
        np.testing.assert_allclose(there, -np.conj(here), atol=1e-12)
    for made in (one, two):
        _, points, normals = made.places(90)
        metal = made.contour.polygon
        for depth, inside in ((-0.01, True), (0.01, False)):
            places = points + depth * normals
            assert np.all(shapely.contains_xy(metal, places.real, places.imag) == inside)
    assert two.size == one.size
    np.testing.assert_allclose(two.contour.area, one.contour.area, rtol=1e-12)
    mirrored = two.pitch_contour.vertices * [-1.0, 1.0]
    np.testing.assert_allclose(mirrored[::-1], one.pitch_contour.vertices, atol=1e-9)
