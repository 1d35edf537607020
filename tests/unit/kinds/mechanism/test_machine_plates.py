"""Plates that slide as drives of mechanisms: their place is a formula in the master's angle."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from gearcam.kinds.mechanism.drawn import scene
from gearcam.numeric.arrays import Array, Plane

TRAVEL = 130.0

PLATE: dict[str, Any] = {
    "kind": "cam", "name": "plate",
    "motion": [
        {"type": "rise", "travel_mm": 60, "law": "3-4-5", "lift_mm": 15},
        {"type": "dwell", "travel_mm": 30},
        {"type": "return", "travel_mm": 40, "law": "cycloidal"},
    ],
    "follower": {"type": "roller", "roller_radius_mm": 6},
    "cam": {"form": "translating"},
    "blank": {"height_mm": 60},
}  # fmt: skip

SLANTED: dict[str, Any] = {**PLATE, "follower": {**PLATE["follower"], "axis_deg": 12}}

SWING: dict[str, Any] = {
    **PLATE,
    "motion": [{"type": "rise", "travel_mm": 60, "law": "3-4-5", "lift_deg": 9},
               *PLATE["motion"][1:]],
    "follower": {**PLATE["follower"], "motion": "oscillating", "arm_mm": 100,
                 "pivot_distance_mm": 90, "pivot_height_mm": 12},
}  # fmt: skip

HARMONIC: dict[str, Any] = {
    **PLATE,
    "motion": [{"type": "dwell", "travel_mm": 20},
               {"type": "rise", "travel_mm": 80, "law": "harmonic", "lift_mm": 15},
               {"type": "dwell", "travel_mm": 30}],
}  # fmt: skip

FORMULA = "65*(1 - cos(q))"
"""To the end of the travel and back in a turn."""

FRAMES: tuple[dict[str, Any], ...] = (
    {},
    {"at_mm": [30, -40], "turn_deg": 35},
    {"at_mm": [5, 10], "turn_deg": -120, "mirror": True},
)

Q = np.radians([0.0, 25.0, 61.0, 90.0, 130.0, 180.0, 222.0, 300.0, 380.0])


def lifted(plate: dict[str, Any] = PLATE, formula: str = FORMULA, **rest: Any) -> Any:
    """One whose follower and plate carry a slide."""
    rows = [{"name": "s", "on": "p.follower", "joint": "T"},
            {"name": "u", "on": "p.plate", "joint": "U"}]  # fmt: skip
    drive = {"name": "p", "cam": plate, "slide": formula}
    frame = {key: rest.pop(key) for key in ("at_mm", "turn_deg", "mirror") if key in rest}
    motor = {"name": "motor", "even": True, "speed_rpm": 60, **rest.pop("motor", {})}
    document = {"kind": "mechanism", "name": "m", "drive": [motor, drive | frame], "slide": rows}
    return gc.build(gc.design(document | rest))


def placed(point: Plane, frame: dict[str, Any]) -> Plane:
    """Points of the frame of a drive, in the machine."""
    seen = point.conj() if frame.get("mirror") else point
    turn = cmath.exp(1j * math.radians(frame.get("turn_deg", 0)))
    return complex(*frame.get("at_mm", (0, 0))) + seen * turn


def place(result: Any, joint: str, q: Array = Q) -> Plane:
    """The place of a joint."""
    table = result.output(joint, q)
    return table[f"{joint}_x_mm"] + 1j * table[f"{joint}_y_mm"]


def own(plate: dict[str, Any], u: Array) -> Any:
    """The motion of a plate at its own places, but for rounding."""
    result: Any = gc.build(gc.design(plate))
    return result.motion(np.clip(u, 0.0, TRAVEL))


def test_the_lift_and_its_derivatives_are_those_of_the_law_at_the_formulas_place() -> None:
    found, u = lifted().output("s", Q), 65.0 * (1.0 - np.cos(Q))
    law = own(PLATE, u)
    s = [law[f"{name}"] for name in ("lift_mm", "velocity_mm_per_mm", "acceleration_mm_per_mm2",
                                     "jerk_mm_per_mm3")]  # fmt: skip
    du, d2u, d3u = 65.0 * np.sin(Q), 65.0 * np.cos(Q), -65.0 * np.sin(Q)
    assert found["s_mm"] == pytest.approx(s[0], abs=1e-10)
    assert found["s_mm_per_rad"] == pytest.approx(s[1] * du, abs=1e-9)
    assert found["s_mm_per_rad2"] == pytest.approx(s[2] * du**2 + s[1] * d2u, abs=1e-8)
    jerk = s[3] * du**3 + 3.0 * s[2] * du * d2u + s[1] * d3u
    assert found["s_mm_per_rad3"] == pytest.approx(jerk, abs=1e-7)


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("plate", [PLATE, SLANTED])
def test_plate_and_follower_move_as_in_the_frame_of_the_cam(
    plate: dict[str, Any], frame: dict[str, Any]
) -> None:
    """The plate by u along +x, the centre of the roller by s along the guide, at first in 0."""
    result, u = lifted(plate, **frame), 65.0 * (1.0 - np.cos(Q))
    s, axis = own(plate, u)["lift_mm"], math.radians(plate["follower"].get("axis_deg", 0))
    along = np.asarray(u, dtype=np.complex128)
    assert place(result, "U") == pytest.approx(placed(along, frame), abs=1e-9)
    centre = s * complex(math.sin(axis), math.cos(axis))
    assert place(result, "T") == pytest.approx(placed(centre, frame), abs=1e-9)


@pytest.mark.parametrize("frame", FRAMES)
def test_an_arm_over_a_plate_swings_about_its_pivot(frame: dict[str, Any]) -> None:
    """Its roller is at (d - l*cos(Psi), p + l*sin(Psi)), with sin(Psi0) = -p/l."""
    arm = [{"name": "a", "on": "p.follower", "joint": "T", "length_mm": 100, "arm_angle_deg": 0}]
    result = lifted(SWING, slide=[], crank=arm, **frame)
    s = np.radians(own(SWING, 65.0 * (1.0 - np.cos(Q)))["lift_deg"])
    psi = math.asin(-12 / 100) + s
    centre = 90.0 - 100.0 * np.cos(psi) + 1j * (12.0 + 100.0 * np.sin(psi))
    assert place(result, "T") == pytest.approx(placed(centre, frame), abs=1e-9)


def test_the_largest_velocity_is_found_between_knots() -> None:
    """Of s(u(q)), by a search of many places with the law's own numbers."""
    result = lifted()
    q = np.linspace(0.0, 2.0 * math.pi, 200_001)
    law = own(PLATE, 65.0 * (1.0 - np.cos(q)))
    rate = law["velocity_mm_per_mm"] * 65.0 * np.sin(q)
    facts = result.facts.document["outputs"]["s"]
    assert abs(facts["velocity_mm_per_rad"]) == pytest.approx(np.abs(rate).max(), rel=1e-8)
    assert facts["stroke_mm"] == pytest.approx(15.0)


def test_at_a_knot_the_values_after_it_are_given_there_and_back() -> None:
    """A harmonic rise begins with the acceleration (h/2)*(pi/b)^2 by u, and comes back to it."""
    result = lifted(HARMONIC)
    forth = [math.acos(1.0 - u / 65.0) for u in (20.0, 100.0)]
    back = [2.0 * math.pi - one for one in reversed(forth)]
    knots = np.array([*forth, *back])
    for one in knots:
        assert np.abs(result.linkage.knots - one).min() < 1e-12
    bend, rate2 = 7.5 * (math.pi / 80.0) ** 2, (65.0 * np.sin(knots)) ** 2
    found = result.output("s", knots)["s_mm_per_rad2"]
    assert found == pytest.approx(rate2 * [bend, 0.0, -bend, 0.0], abs=1e-8)


@pytest.mark.parametrize(
    ("formula", "turns"), [("65*(1 - cos(q/2))", 2), ("65 + 60*sin(q/3)*cos(q)", 3)]
)
def test_the_cycle_is_that_of_the_formula(formula: str, turns: int) -> None:
    result = lifted(formula=formula)
    assert result.linkage.span == pytest.approx((0.0, 2.0 * math.pi * turns))


@pytest.mark.parametrize(
    ("formula", "told"),
    [
        ("66*(1 - cos(q))", "would be at 132 mm at 180 deg"),
        ("60 - 65*sin(q)", "would be at -5 mm at 90 deg"),
        # it never returns, but that is not what is wrong first
        ("30*q", "would be at 188.496 mm at 360 deg"),
        # within the travel in the first turn only
        ("40*(1 - cos(q/3))*1.7", "would be at 136 mm at 540 deg"),
    ],
)
def test_a_formula_beyond_the_travel_is_refused_with_the_place(formula: str, told: str) -> None:
    with pytest.raises(InfeasibleError) as caught:
        _ = lifted(formula=formula).linkage
    message = str(caught.value)
    assert f"the plate {told}, beyond its travel (drive[1].slide)" in message
    assert "places from 0 to 130 mm" in message


def test_a_plate_in_part_of_a_turn_needs_its_travel_there_only() -> None:
    part = {"motor": {"range_deg": [0, 90]}}
    assert lifted(formula="80*(1 - cos(q))", **part).linkage.span == pytest.approx(
        (0.0, 0.5 * math.pi)
    )
    with pytest.raises(InfeasibleError, match="at 160 mm at 180 deg"):
        _ = lifted(formula="80*(1 - cos(q))").linkage


def test_the_contact_force_of_a_plate_has_its_pressure_angle() -> None:
    """N cos(alpha) is what the follower exerts along its guide, and moves the plate by N sin."""
    result = lifted(load=[{"on": "s", "force_n": -50}])
    study = result.study("forces")
    q = np.radians(study.columns["theta_deg"])
    alpha = np.radians(own(PLATE, 65.0 * (1.0 - np.cos(q)))["pressure_angle_deg"])
    assert study.columns["p_contact_n"] == pytest.approx(50.0 / np.cos(alpha), rel=1e-8)
    drive = 50.0 * np.tan(alpha) * 65.0 * np.sin(q)
    torque = study.columns["driver_torque_nm"]
    assert np.abs(torque) == pytest.approx(1e-3 * np.abs(drive), abs=1e-8)
    assert np.abs(torque).max() > 0.5


def test_a_plate_with_a_density_is_moved_with_its_mass() -> None:
    """Its inertia does the work m*u''*u' in a small turn."""
    heavy = {**PLATE, "blank": {**PLATE["blank"], "density_kg_m3": 7850}}
    result = lifted(heavy, load=[{"on": "s", "force_n": -1e-9}])
    study = result.study("torque").columns
    q, speed = np.radians(study["theta_deg"]), 2.0 * math.pi
    made: Any = gc.build(gc.design(heavy))
    mass = made.facts.document["part"]["mass"]["mass_kg"]
    torque = 1e-6 * mass * speed**2 * 65.0 * np.cos(q) * 65.0 * np.sin(q)
    assert study["torque_nm"] == pytest.approx(torque, abs=1e-9)
    assert torque.max() > 0.01


def test_an_arm_over_a_plate_exerts_its_torque_in_its_lift() -> None:
    arm = [{"name": "a", "on": "p.follower", "joint": "T", "length_mm": 100}]
    for frame in FRAMES:
        result = lifted(
            SWING, slide=[], crank=arm, load=[{"on": "T", "force_n": [30, -50]}], **frame
        )
        study = result.study("torque").columns
        q = np.radians(study["theta_deg"])
        rate = np.radians(own(SWING, 65.0 * (1.0 - np.cos(q)))["velocity_deg_per_mm"])
        work = study["follower_torque_nm"] * rate * 65.0 * np.sin(q)
        assert study["torque_nm"] == pytest.approx(work, abs=1e-9)
        assert np.abs(work).max() > 0.1


def test_the_picture_has_plate_and_roller_where_their_joints_are() -> None:
    frame = FRAMES[2]
    result = lifted(**frame)
    drawn = scene(result, 36)
    q = np.radians(drawn.places)
    bodies = {one.name: one for one in drawn.bodies}
    moves = bodies["p.cam"].pose.shift - bodies["p.cam"].pose.shift[0]
    assert moves == pytest.approx(place(result, "U", q) - place(result, "U", q)[0], abs=1e-9)
    lifts = bodies["p.follower"].pose.shift - bodies["p.follower"].pose.shift[0]
    assert lifts == pytest.approx(place(result, "T", q) - place(result, "T", q)[0], abs=1e-9)
