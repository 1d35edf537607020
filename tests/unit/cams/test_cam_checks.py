"""Every check of cams speaks just beyond its limit and is silent just within it."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest

import gearcam.cams.checks  # noqa: F401  (registers the checks)
from gearcam.base.findings import CHECKS, Finding, run_checks
from gearcam.base.tolerances import DEFAULT
from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.spec import KIND
from gearcam.laws.motion_table import MotionTable
from helpers_cams import back, cam, dwell, follower_of, program, rise, there_and_back

STEEP = (60.0, 90.0, 60.0, 150.0)


def findings(made: DiscCam, code: str, **limits: float) -> list[Finding]:
    return [found for found in run_checks(KIND, made, limits) if found.code == code]


class Edge(NamedTuple):
    """A cam whose measured value is known, and the sign in which it is beyond its limit."""

    make: Callable[[float], DiscCam]
    """From a value in its unit to a cam that has it."""
    limit: float
    beyond: float
    name: str
    """The limit's key, for its default value is not the only one."""
    severity: str


def pressed(degrees: float) -> DiscCam:
    """Constant velocity of a sliding point: ``tan(alpha) = s'/prime`` at the start."""
    lift = 20.0 * math.tan(math.radians(degrees)) * math.radians(120.0)
    return cam(
        "point",
        "constant-velocity",
        lift,
        (120.0, 60.0, 170.0, 10.0),
        prime_radius=20.0,
        offset=0.0,
    )


def swung(degrees: float, prime: float = 60.0) -> DiscCam:
    """On an arm: ``tan(alpha) = (arm*(1 + s') - d*cos(Psi))/(d*sin(Psi))`` at the start."""
    d, arm = 100.0, 90.0
    psi = math.acos((d * d + arm * arm - prime * prime) / (2 * d * arm))
    speed = (math.tan(math.radians(degrees)) * math.sin(psi) + math.cos(psi)) * d / arm - 1.0
    lift = math.degrees(speed * math.radians(30.0))
    return cam(
        "swinging point", "constant-velocity", lift, (30.0, 60.0, 200.0, 70.0), prime_radius=prime
    )


def loses(lift: float) -> DiscCam:
    """A face at a shock: the corner costs ``base*(1/cos(...) - 1)``, found by bisection."""
    low, high = 0.1, 20.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if shock_loss(middle) < lift else (low, middle)
    return cam("flat", "constant-velocity", low, (120.0, 60.0, 120.0, 60.0))


def shock_loss(height: float) -> float:
    """Where the straight side of the rise meets the arc of the dwell, by the law of the face.

    The envelope of ``h = base + v*theta`` and the straight piece of the velocity's jump: at the end
    of the rise the face would be touched at v along itself. The corner is where the curve of the
    rise meets the circle of the dwell; the follower on it has the height ``R*cos(turn)``.
    """
    base, b = 40.0, math.radians(120.0)
    v, top = height / b, 40.0 + height
    # the rise's own points: (v + i*(base + v*theta))*exp(-i*theta); R of the circle is `top`
    theta = (math.sqrt(top**2 - v**2) - base) / v
    corner = complex(v, base + v * theta) * np.exp(-1j * theta)
    turn = np.angle(corner)
    # largest loss on the rise: base + v*t - R*sin(turn + t), where v = R*cos(turn + t)
    t = math.acos(v / top) - turn
    on_rise = base + v * t - top * math.sin(turn + t) if t < b else 0.0
    on_dwell = top - top * math.sin(turn + b)
    return max(on_rise, on_dwell)


def sharp(radius: float) -> DiscCam:
    """A dwell's arc about the axis: ``prime - r`` with the smallest curvature radius there."""
    return cam("roller", "cycloidal", 1.0, prime_radius=6.0 + radius)


EDGES: dict[str, Edge] = {
    "pressure-angle": Edge(pressed, 30.0, 1.0, "pressure_angle", "warning"),
    "pressure-angle swung": Edge(swung, 45.0, 1.0, "pressure_angle", "warning"),
    "jamming": Edge(pressed, 65.0, 1.0, "jamming_angle", "error"),
    "jamming swung": Edge(partial(swung, prime=20.0), 80.0, 1.0, "jamming_angle", "error"),
    "undercut": Edge(loses, 0.01, 1.0, "lost_lift", "error"),
}


@pytest.mark.parametrize("name", EDGES)
def test_a_check_speaks_just_beyond_its_limit(name: str) -> None:
    edge = EDGES[name]
    code = name.split()[0]
    step = edge.limit * 1e-6 * edge.beyond
    for value, speaks in ((edge.limit + step, True), (edge.limit - step, False)):
        found = findings(edge.make(value), code)
        at_limit = [one for one in found if one.severity == edge.severity]
        assert bool(at_limit) == speaks
        if speaks:
            largest = max(one.value or 0.0 for one in at_limit)
            assert largest == pytest.approx(value, rel=1e-7)
            assert at_limit[0].limit == pytest.approx(edge.limit, rel=1e-12)


@pytest.mark.parametrize(("make", "degrees"), [(pressed, 25.0), (swung, 44.95)])
def test_the_pressure_angle_has_a_limit_of_its_own(
    make: Callable[[float], DiscCam], degrees: float
) -> None:
    """30 degrees by custom, 45 for arms; a design may set another."""
    made = make(degrees)
    assert findings(made, "pressure-angle") == []
    assert findings(made, "pressure-angle", pressure_angle=math.radians(degrees + 1e-4)) == []
    below = math.radians(degrees - 1e-4)
    (found,) = findings(made, "pressure-angle", pressure_angle=below)
    assert found.where.startswith("rise, at ")
    assert found.limit == pytest.approx(degrees - 1e-4)
    assert found.value == pytest.approx(degrees, abs=1e-6)


def test_the_offset_roller_presses_on_its_return() -> None:
    """31.81 degrees, at an angle that is named, and nothing on the rise."""
    (found,) = findings(cam("roller, offset"), "pressure-angle")
    assert found.severity == "warning"
    assert found.value == pytest.approx(31.810726, abs=5e-7)
    assert (found.limit, found.unit) == (pytest.approx(30.0), "deg")
    assert "on the return reaches 31.81 deg" in found.message
    place = float(found.where.removeprefix("return, at ").removesuffix(" deg"))
    exact = cam("roller, offset").motion(np.radians([place]))["pressure"]
    assert math.degrees(exact[0]) == pytest.approx(-31.810726, abs=1e-5)
    assert findings(cam("roller"), "pressure-angle") == []


def test_the_sharpest_place_is_held_against_its_limit() -> None:
    made = cam("roller, offset")
    convex = made.profile_radius[0]
    assert 1.0 < convex == pytest.approx(22.670419 - 6.0, abs=0.5)
    assert findings(made, "sharp-profile") == []
    (found,) = findings(made, "sharp-profile", profile_radius=convex * (1 + 1e-9))
    assert (found.value, found.unit, found.severity) == (convex, "mm", "warning")
    assert f"{convex:.4g} mm" in found.message
    assert findings(made, "sharp-profile", profile_radius=convex * (1 - 1e-9)) == []


@pytest.mark.parametrize(("radius", "speaks"), [(1 - 1e-6, True), (1 + 1e-6, False)])
def test_a_millimetre_is_sharp(radius: float, speaks: bool) -> None:
    """A face on ``s = e*(1 - cos)`` has the constant radius base + e."""
    phases = [rise("harmonic", 180.0, 1.0), back("harmonic", 180.0)]
    made = make_cam(program(phases), follower_of("flat", base_radius=radius - 0.5))
    assert bool(findings(made, "sharp-profile")) == speaks


def test_a_trimmed_cam_is_not_called_sharp_too() -> None:
    made = cam("flat", "cycloidal", 10.0, STEEP, base_radius=20.0)
    assert findings(made, "sharp-profile", profile_radius=100.0) == []
    assert len(findings(made, "undercut")) == 2


class Lost(NamedTuple):
    """Angles in degrees, from the beginning of a rise, and the loss in mm."""

    undercut: tuple[float, float]
    rests: tuple[float, float]
    worst: float
    loss: float


def steep_face() -> Lost:
    """A face on 10 mm cycloidal in 60 degrees and a dwell, base 20 mm, by mpmath.

    Undercut where ``h + h'' < 0``. The face touches ``(h' + i*h)*exp(-i*theta)``: the corner is
    where this curve meets itself, and what rests on a corner P stands at ``Im(P*exp(i*theta))``.
    """
    mp: Any = mpmath.MPContext()
    mp.dps = 30
    width = mp.pi / 3

    def height(t: Any) -> Any:
        wave = mp.sin(2 * mp.pi * t / width) / (2 * mp.pi)
        return 20 + 10 * (t / width - wave) if t < width else mp.mpf(30)

    def speed(t: Any) -> Any:
        return 10 / width * (1 - mp.cos(2 * mp.pi * t / width)) if t < width else mp.mpf(0)

    def room(t: Any) -> Any:
        return height(t) + 20 * mp.pi / width**2 * mp.sin(2 * mp.pi * t / width)

    def touched(t: Any) -> Any:
        return mp.mpc(speed(t), height(t)) * mp.exp(-1j * t)

    def miss(low: Any, high: Any) -> list[Any]:
        found = touched(low) - touched(high)
        return [found.real, found.imag]

    ends = [mp.findroot(room, mp.radians(guess)) for guess in (35, 56)]
    low, high = mp.findroot(miss, (mp.radians(25), mp.radians(70)))
    corner = touched(low)
    # where the follower should go as fast as it goes while it rests on the corner
    worst = mp.findroot(
        lambda t: speed(t) - (corner * mp.exp(1j * t)).real,
        (mp.radians(40), mp.radians(50)),
        solver="anderson",
    )
    loss = height(worst) - (corner * mp.exp(1j * worst)).imag
    first, second, c, d, at = (float(mp.degrees(x)) for x in (*ends, low, high, worst))
    return Lost((first, second), (c, d), at, float(loss))


@pytest.mark.parametrize("first", [0.0, 40.0])
def test_undercut_at_a_jump_is_in_one_place(first: float) -> None:
    """The rise begins downwards; where it begins the turn, its beginning is not the turn's end."""
    sinks = "(x - 0.16*sin(6.28*x))/(1 - 0.16*sin(6.28))"
    phases = [rise("formula", 120.0, 10.0, formula=sinks), dwell(60.0), back("cycloidal", 120.0)]
    before = [dwell(first)] if first else []
    made = make_cam(program([*before, *phases, dwell(60.0 - first)]), follower_of("roller"))
    found = [one for one in findings(made, "undercut") if "has a corner" in one.message]
    assert found[0].where == f"at {first:g} deg"
    assert f"undercut at {first:g} deg." in found[0].message


def test_undercut_names_its_angles_and_its_loss() -> None:
    """On the rise as computed by hand, on the return from 150 to 210 degrees its image."""
    made = cam("flat", "cycloidal", 10.0, STEEP, base_radius=20.0)
    found = findings(made, "undercut")
    assert [one.severity for one in found] == ["error", "error"]
    exact = steep_face()
    (a, b), (c, d) = exact.undercut, exact.rests
    returning = ((210.0 - b, 210.0 - a), (210.0 - d, 210.0 - c), 210.0 - exact.worst)
    for one, ((a, b), (c, d), worst) in zip(
        found, ((exact.undercut, exact.rests, exact.worst), returning), strict=True
    ):
        assert f"undercut from {a:.5g} deg to {b:.5g} deg." in one.message
        assert f"rides from {c:.5g} deg to {d:.5g} deg" in one.message
        assert f"up to {exact.loss:.4g} mm of lift is lost" in one.message
        assert one.where == f"at {worst:.5g} deg"
        assert one.value == pytest.approx(exact.loss, rel=1e-9)
        assert (one.limit, one.unit) == (0.01, "mm")
    allowed = findings(made, "undercut", lost_lift=exact.loss * (1 + 1e-9))
    assert [one.severity for one in allowed] == ["warning", "warning"]
    one_more = findings(made, "undercut", lost_lift=exact.loss * (1 - 1e-9))
    assert "error" in [one.severity for one in one_more]
    assert findings(cam("flat"), "undercut") == []


@pytest.mark.parametrize(("kind", "lever"), [("swinging roller", 90.0), ("swinging face", 100.0)])
def test_the_loss_of_an_arm_is_told_in_mm_and_degrees(kind: str, lever: float) -> None:
    made = cam(kind, "constant-velocity", 12.0, STEEP)
    found = findings(made, "undercut")
    assert len(found) == 2
    for one, loss in zip(found, made.lost, strict=True):
        assert one.value == pytest.approx(loss.value * lever, rel=1e-12)
        assert f"({math.degrees(loss.value):.4g} deg) of lift" in one.message
        assert one.limit == 0.01


def test_undercut_over_the_end_of_the_turn_is_one_finding() -> None:
    """A program that begins in the middle of its rise: both parts belong to one corner."""
    made = cam("flat", "cycloidal", 10.0, STEEP, base_radius=20.0)
    low, high = made.undercut[0]
    shift = math.degrees(0.5 * (low + high))
    # the same rise by a formula that is cut in two at the middle of its undercut
    b = 60.0
    x0 = shift / b
    lift = 10.0 * (x0 - math.sin(2 * math.pi * x0) / (2 * math.pi))
    whole = "({0} - sin(2*pi*({0}))/(2*pi))"
    start = whole.format(repr(x0))
    first = whole.format(f"({x0!r} + {1 - x0!r}*x)")
    last = whole.format(f"({x0!r}*x)")
    phases = [
        rise("formula", b - shift, 10.0 - lift, formula=f"({first} - {start})/(1 - {start})"),
        dwell(90.0),
        back("cycloidal", 60.0, 10.0),
        dwell(150.0),
        rise("formula", shift, lift, formula=f"{last}/{start}"),
    ]
    m = made.follower
    turned = make_cam(program(phases), follower_of("flat", base_radius=m.start + lift))
    assert turned.size.area == pytest.approx(made.size.area, rel=1e-12)
    assert len(turned.undercut) == 3
    found = findings(turned, "undercut")
    assert len(found) == 2
    (_, first_end), (start, end) = turned.undercut_ranges
    assert first_end < start < 2.0 * math.pi < end
    assert any(f"to {math.degrees(end):.5g} deg" in one.message for one in found)
    assert sorted(one.value or 0.0 for one in found) == pytest.approx(
        sorted(loss.value for loss in made.lost), rel=1e-9
    )


def test_undercut_within_its_limit_is_a_warning() -> None:
    """A face whose radius falls a little below zero loses nanometres."""
    made = cam("flat", "cycloidal", 10.0, STEEP, base_radius=barely(0.05))
    found = findings(made, "undercut")
    assert [one.severity for one in found] == ["warning", "warning"]
    for one, (start, _) in zip(found, made.undercut, strict=True):
        assert f"{math.degrees(start):.5g} deg" in one.message
        assert 0.0 < (one.value or 0.0) < 1e-5
    larger = cam("flat", "cycloidal", 10.0, STEEP, base_radius=barely(-1e-8))
    assert findings(larger, "undercut") == []


def barely(depth: float) -> float:
    """Base radius at which the face's radius of curvature falls below zero by so much.

    ``s + s''`` of a cycloidal return in an angle b, at its smallest: the root of its derivative.
    """
    lift, b = 10.0, math.radians(60.0)
    k = 2 * math.pi / b

    def slope(t: float) -> float:
        return lift / b * (1 - math.cos(k * t)) + lift / b * k * k * math.cos(k * t)

    low, high = 0.5 * b, b
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if slope(middle) < 0.0 else (low, middle)
    least = lift * (low / b - math.sin(k * low) / (2 * math.pi)) + lift / b * k * math.sin(k * low)
    return -least - depth


@pytest.mark.parametrize("kind", ["flat", "swinging roller"])
def test_shocks_are_told_at_their_angles(kind: str) -> None:
    swings = kind != "flat"
    unit = "deg" if swings else "mm"
    hard = cam(kind, "constant-velocity", 12.0, STEEP)
    speed = 12.0 / math.radians(60.0)
    found = findings(hard, "velocity-jump")
    assert [one.where for one in found] == ["at 0 deg", "at 60 deg", "at 150 deg", "at 210 deg"]
    assert [one.value for one in found] == pytest.approx([speed, -speed, -speed, speed])
    assert {(one.severity, one.unit) for one in found} == {("warning", f"{unit}/rad")}
    assert findings(hard, "acceleration-jump") == []
    soft = cam(kind, "harmonic", 12.0, STEEP)
    jump = 0.5 * math.pi**2 * 12.0 / math.radians(60.0) ** 2
    found = findings(soft, "acceleration-jump")
    assert [one.where for one in found] == ["at 0 deg", "at 60 deg", "at 150 deg", "at 210 deg"]
    assert [one.value for one in found] == pytest.approx([jump, jump, -jump, -jump])
    assert {(one.severity, one.unit) for one in found} == {("note", f"{unit}/rad2")}
    assert findings(soft, "velocity-jump") == []
    smooth = cam(kind, "cycloidal", 12.0, STEEP)
    assert findings(smooth, "velocity-jump") == findings(smooth, "acceleration-jump") == []


@pytest.mark.parametrize(("size", "speaks"), [(3e-9, True), (0.3e-9, False)])
def test_a_shock_counts_from_a_billionth_of_the_peak(size: float, speaks: bool) -> None:
    """The end speed of a polynomial that goes over into a dwell; it grows again, not falls."""
    lift, b = 10.0, math.radians(90.0)
    phases = [
        rise("polynomial", 90.0, lift, start=(0.0, 0.0), end=(-size * 1.875, 0.0)),
        dwell(90.0),
        back("3-4-5", 90.0),
        dwell(90.0),
    ]
    made = make_cam(program(phases), follower_of("flat"))
    assert made.program.peaks[0] == pytest.approx(1.875 * lift / b, rel=1e-6)
    assert bool(findings(made, "velocity-jump")) == speaks


@pytest.mark.parametrize(("kind", "lever"), [("roller", 1.0), ("swinging roller", 90.0)])
def test_coarse_rows_are_told(kind: str, lever: float) -> None:
    """The error that the rows foresee, on the arm, against the chord tolerance."""
    swings = lever > 1.0
    theta = np.linspace(0.0, 2 * math.pi, 30)
    lift = there_and_back("cycloidal", 10.0, swings=swings).lift(theta)
    table = MotionTable(theta=tuple(theta.tolist()), lift=tuple(lift.tolist()))
    rows = table.program(DEFAULT, oscillating=swings)
    for share, speaks in ((1.0 + 1e-9, False), (1.0 - 1e-9, True)):
        tolerance = share * lever * rows.errors[0]
        made = make_cam(rows, follower_of(kind), tolerance=tolerance)
        found = findings(made, "coarse-rows")
        assert bool(found) is speaks
    assert found[0].value == pytest.approx(lever * rows.errors[0])
    assert (found[0].limit, found[0].unit, found[0].severity) == (tolerance, "mm", "warning")
    assert found[0].where == "motion"


def test_a_quiet_cam_has_no_findings() -> None:
    made = make_cam(there_and_back("cycloidal", 10.0), follower_of("roller", prime_radius=60.0))
    assert run_checks(KIND, made, {}) == ()


def test_every_check_of_cams_is_covered() -> None:
    codes = {code for kind, code in CHECKS if kind == KIND}
    tried = {name.split()[0] for name in EDGES} | {
        *("sharp-profile", "velocity-jump", "acceleration-jump", "coarse-rows"),
        "lost-motion",  # in test_groove_cams.py
        "face-width",  # in test_yoke_cams.py
        "no-clearance",  # in test_groove_cams.py
    }
    assert codes == tried
    limits = {check.limit[0] for (kind, _), check in CHECKS.items() if kind == KIND and check.limit}
    assert limits == {
        *("pressure_angle", "jamming_angle", "lost_lift", "profile_radius", "lost_motion")
    }
