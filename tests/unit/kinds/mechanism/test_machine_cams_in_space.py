"""Cylinder cams and globoidal indexing cams as drives of mechanisms."""

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
from gearcam.parts.shapes import Circle
from helpers_machines import DRUM, FRAMES, SWING
from helpers_pairs import PROFILES

INDEXER: dict[str, Any] = gc.load(PROFILES / "globoidal_indexer.toml").to_dict()


def turning(cam: dict[str, Any], rotation: str) -> dict[str, Any]:
    """The same cam that turns in a direction."""
    return {**cam, "cam": {**cam["cam"], "rotation": rotation}}


def machine(drive: dict[str, Any], **tables: Any) -> Any:
    """A mechanism behind a drive."""
    return gc.build(
        gc.design({"kind": "mechanism", "name": "m", "drive": [{"name": "d", **drive}], **tables})
    )


def placed(point: Plane, frame: dict[str, Any]) -> Plane:
    """Points of the frame of a drive, in the machine."""
    seen = point.conj() if frame.get("mirror") else point
    turn = cmath.exp(1j * math.radians(frame.get("turn_deg", 0)))
    return complex(*frame.get("at_mm", (0, 0))) + seen * turn


def roller(cam: dict[str, Any], theta: Array) -> Plane:
    """The roller as the cam's own solids have it: its y and z."""
    result: Any = gc.build(gc.design(cam))
    (pose,) = result.moved_poses(theta).values()
    y = result.cam.hand * pose.shift[:, 1]
    return y + 1j * pose.shift[:, 2]


def place(result: Any, joint: str, q: Array) -> Plane:
    """The place of a joint."""
    table = result.output(joint, q)
    return table[f"{joint}_x_mm"] + 1j * table[f"{joint}_y_mm"]


THETA = np.radians([0.0, 20.0, 75.0, 149.0, 170.0, 250.0, 340.0, 400.0])


@pytest.mark.parametrize("frame", FRAMES.values(), ids=FRAMES)
@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_a_slide_is_where_the_roller_of_its_cylinder_cam_is(
    frame: dict[str, Any], rotation: str
) -> None:
    cam = turning(DRUM, rotation)
    slide = {"name": "s", "on": "d.follower", "joint": "T"}
    result = machine({"cam": cam, **frame}, slide=[slide])
    assert place(result, "T", THETA) == pytest.approx(placed(roller(cam, THETA), frame), abs=1e-10)
    lift = gc.build(gc.design(cam)).motion(THETA)  # pyright: ignore[reportAttributeAccessIssue]
    found = result.output("s", THETA)
    assert found["s_mm"] == pytest.approx(lift["lift_mm"], abs=1e-12)
    assert found["s_mm_per_rad3"] == pytest.approx(lift["jerk_mm_per_rad3"], abs=1e-9)


@pytest.mark.parametrize("frame", FRAMES.values(), ids=FRAMES)
@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_an_arm_carries_the_roller_of_its_cylinder_cam(
    frame: dict[str, Any], rotation: str
) -> None:
    cam = turning(SWING, rotation)
    arm = {"name": "a", "on": "d.follower", "joint": "T", "length_mm": 160, "arm_angle_deg": 0}
    result = machine({"cam": cam, **frame}, crank=[arm])
    assert place(result, "T", THETA) == pytest.approx(placed(roller(cam, THETA), frame), abs=1e-10)


@pytest.mark.parametrize("frame", FRAMES.values(), ids=FRAMES)
@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_a_crank_on_a_turret_stays_on_its_roller(frame: dict[str, Any], rotation: str) -> None:
    """The roller in front begins half a pitch below the middle, and rises while the cam turns."""
    cam = turning(INDEXER, rotation)
    result: Any = gc.build(gc.design(cam))
    theta = np.linspace(0.0, 16.0 * math.pi, 97)
    turret = np.radians(result.motion(theta)["turret_deg"])
    angle = turret - math.pi / 8
    ends = 100.0 - 58.0 * np.cos(angle) + 58.0j * np.sin(angle)
    start = math.pi + math.pi / 8  # of that roller, from x towards z
    way = cmath.phase(placed(np.array([cmath.exp(1j * start)]), {**frame, "at_mm": (0, 0)})[0])
    crank = {"name": "k", "on": "d.turret", "joint": "T", "length_mm": 58,
             "angle_deg": math.degrees(way)}  # fmt: skip
    made = machine({"cam": cam, **frame}, crank=[crank])
    assert place(made, "T", theta) == pytest.approx(placed(ends, frame), abs=1e-9)
    # as the rollers of the cam itself stand
    axis = result.cam.guide.placed(turret[:12])
    tip = (axis[0] + 58.0 * axis[1])[0]
    assert tip[:, 0] + 1j * tip[:, 2] == pytest.approx(ends[:12], abs=1e-9)


@pytest.mark.parametrize(
    ("stops", "ratio", "turns"), [(8, 1, 8), (6, 1, 6), (8, -2, 4), (8, 0.5, 16), (6, 1.5, 4)]
)
def test_a_machine_repeats_when_its_turret_is_back(stops: int, ratio: float, turns: int) -> None:
    cam = gc.design(INDEXER).with_(
        {"turret.stops": stops, "turret.roller_radius_mm": 6, "cam.length_mm": 60}
    )
    drives = [{"name": "motor", "even": True},
              {"name": "d", "cam": cam.to_dict(), "ratio": ratio, "phase_deg": 17}]  # fmt: skip
    crank = [{"name": "k", "on": "d.turret", "joint": "T", "length_mm": 50}]
    result: Any = gc.build(
        gc.design({"kind": "mechanism", "name": "m", "drive": drives, "crank": crank})
    )
    assert result.linkage.span == pytest.approx((0.0, 2.0 * math.pi * turns))
    ends = place(result, "T", np.array([0.3, 0.3 + 2.0 * math.pi * turns]))
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)
    # -1 turn of the turret after as many turns of the cam as it has stops
    turned = result.output("d.turret", 2.0 * math.pi * np.array([0.0, stops / ratio]))
    assert np.diff(turned["d_turret_deg"]) == pytest.approx(-360.0)


def test_a_cylinder_cam_repeats_after_whole_turns_of_its_own() -> None:
    drives = [{"name": "motor", "even": True}, {"name": "d", "cam": DRUM, "ratio": 1.5}]
    slide = [{"name": "s", "on": "d.follower", "joint": "T"}]
    result: Any = gc.build(
        gc.design({"kind": "mechanism", "name": "m", "drive": drives, "slide": slide})
    )
    assert result.linkage.span == pytest.approx((0.0, 4.0 * math.pi))


def table() -> Any:
    """A slide behind the pin of a turret."""
    crank = {"name": "k", "on": "d.turret", "joint": "B", "length_mm": 40, "angle_deg": 20}
    rod = {"type": "RRT", "from": "B", "to": "bed", "joint": "S", "members": ["rod", "ram"],
           "lengths_mm": [150, 0]}  # fmt: skip
    return machine(
        {"cam": INDEXER, "speed_rpm": 60},
        crank=[crank],
        guide=[{"name": "bed", "through": "d.turret", "direction_deg": 90}],
        dyad=[rod],
        mass=[{"of": "k", "mass_kg": 3, "at_mm": [0, 0], "inertia_kg_m2": 0.02}],
    )


def test_derivatives_of_what_a_turret_drives_are_those_of_its_places() -> None:
    result, q, step = table(), np.linspace(0.1, 50.0, 200), 1e-5
    knots = result.linkage.knots
    q = q[np.abs(q[:, None] - knots).min(axis=1) > 2.0 * step]
    before, at, after = (result.output("S", q + side) for side in (-step, 0.0, step))
    for value, rate in (("S_mm", "S_mm_per_rad"), ("S_mm_per_rad", "S_mm_per_rad2")):
        differences = (after[value] - before[value]) / (2.0 * step)
        assert at[rate] == pytest.approx(differences, abs=1e-5)


def test_the_turret_exerts_what_its_inertia_asks_for() -> None:
    study = table().study("torque").columns
    cam: Any = gc.build(gc.design(INDEXER))
    theta = np.radians(study["theta_deg"])
    moved = cam.motion(theta)
    speed = 2.0 * math.pi
    bend = np.radians(moved["acceleration_deg_per_rad2"]) * speed**2
    assert study["turret_torque_nm"] == pytest.approx(0.02 * bend, abs=1e-9)
    rate = np.radians(moved["velocity_deg_per_rad"])
    assert study["torque_nm"] == pytest.approx(0.02 * bend * rate, abs=1e-9)


@pytest.mark.parametrize("frame", FRAMES.values(), ids=FRAMES)
def test_an_arm_exerts_its_torque_in_its_lift(frame: dict[str, Any]) -> None:
    """By the work of the driver: the torque times the rate of the lift."""
    arm = {"name": "a", "on": "d.follower", "joint": "T", "length_mm": 160, "arm_angle_deg": 0}
    for rotation in ("ccw", "cw"):
        drive = {"cam": turning(SWING, rotation), **frame}
        result = machine(drive, crank=[arm], load=[{"on": "T", "force_n": [70, -100]}])
        study = result.study("torque").columns
        cam: Any = gc.build(gc.design(drive["cam"]))
        rate = np.radians(cam.motion(np.radians(study["theta_deg"]))["velocity_deg_per_rad"])
        torque = study["follower_torque_nm"] * rate
        assert study["torque_nm"] == pytest.approx(torque, abs=1e-9)
        assert np.abs(torque).max() > 1.0


def test_a_compared_arm_of_the_other_hand_exerts_its_torque_in_its_lift() -> None:
    arm = {"name": "a", "on": "d.follower", "joint": "T", "length_mm": 160}
    result = machine(
        {"cam": SWING}, crank=[arm], load=[{"on": "T", "force_n": [70, -100]}],
        compare=[{"name": "x", "cam": turning(SWING, "cw")}],
    )  # fmt: skip
    study = result.compared["x"].study("torque").columns
    rate = result.output("d.follower", np.radians(study["theta_deg"]))["d_follower_rad_per_rad"]
    assert study["torque_nm"] == pytest.approx(study["follower_torque_nm"] * rate, abs=1e-9)
    assert np.abs(study["torque_nm"]).max() > 1.0


def test_a_cam_in_space_behind_a_shaft_stands_at_its_own_angle() -> None:
    drives = [{"name": "motor", "even": True},
              {"name": "d", "cam": DRUM, "ratio": -2, "phase_deg": 50}]  # fmt: skip
    slide = [{"name": "s", "on": "d.follower", "joint": "T"}]
    result: Any = gc.build(
        gc.design({"kind": "mechanism", "name": "m", "drive": drives, "slide": slide})
    )
    own: Any = gc.build(gc.design(DRUM))
    found = result.output("s", THETA)
    law = own.motion(np.radians(50.0) - 2.0 * THETA)
    assert found["s_mm"] == pytest.approx(law["lift_mm"], abs=1e-10)
    assert found["s_mm_per_rad"] == pytest.approx(-2.0 * law["velocity_mm_per_rad"], abs=1e-9)


@pytest.mark.parametrize(
    ("walls", "down", "off"),
    [("both", -90, False), ("lower", -90, False), ("lower", 90, True), ("upper", -90, True),
     ("upper", 90, False)],
)  # fmt: skip
def test_a_follower_is_pulled_off_one_wall_only_to_its_side(
    walls: str, down: float, off: bool
) -> None:
    cam = {**DRUM, "cam": {**DRUM["cam"], "walls": walls}}
    result = machine(
        {"cam": cam, "speed_rpm": 1},
        slide=[{"name": "s", "on": "d.follower", "joint": "T"}],
        mass=[{"of": "s", "mass_kg": 2}],
        gravity={"direction_deg": down},
    )
    found = result.study("torque").study_findings
    assert [one.code for one in found] == ["lift-off"] * off
    for one in found:
        assert one.value == pytest.approx(2 * 9.80665, rel=0.01)  # almost at rest


@pytest.mark.parametrize("walls", ["both", "lower", "upper"])
def test_the_contact_force_is_shared_along_the_roller(walls: str) -> None:
    """A place at x approaches its wall by c = x/sqrt(x^2 + s'^2) of the lift, and carries as much.

    So the force N has the effect N*integral(c^2)/integral(c) along the line of contact, whose
    points are 11*(s', x)/sqrt(x^2 + s'^2) beside and above the axis of the roller.
    """
    cam = {**DRUM, "cam": {**DRUM["cam"], "walls": walls}}
    result = machine(
        {"cam": cam}, slide=[{"name": "s", "on": "d.follower", "joint": "T"}],
        load=[{"on": "s", "force_n": -50}],
    )  # fmt: skip
    study = result.study("forces").columns
    own: Any = gc.build(gc.design(cam))
    rate = own.motion(np.radians(study["theta_deg"]))["velocity_mm_per_rad"]
    end = np.full(rate.shape, 100.0)
    for _ in range(20):  # the points of contact are aside by 11*s'/sqrt(x^2 + s'^2)
        end = np.sqrt(100.0**2 - (11.0 * rate) ** 2 / (end**2 + rate**2))
    x = 82.0 + np.linspace(0.0, 1.0, 2001) * (end[:, None] - 82.0)
    c = x / np.hypot(x, rate[:, None])
    stretch = np.hypot(1.0, 11.0 * rate[:, None] / (x**2 + rate[:, None] ** 2))
    effect = np.trapezoid(c**2 * stretch, x, axis=1) / np.trapezoid(c * stretch, x, axis=1)
    side = -1.0 if walls == "upper" else 1.0  # off which it is pulled
    assert study["d_contact_n"] == pytest.approx(side * 50.0 / effect, rel=1e-6)


def test_the_rollers_of_a_turret_carry_what_its_inertia_asks_for() -> None:
    """At rest nothing; else the torque over a place that presses, times the cosine of its angle."""
    study = table().study("forces")
    force, theta = study.columns["d_contact_n"], study.columns["theta_deg"]
    moved: Any = gc.build(gc.design(INDEXER))
    bend = np.radians(moved.motion(np.radians(theta))["acceleration_deg_per_rad2"])
    torque = 0.02 * bend * (2.0 * math.pi) ** 2
    assert np.abs(force[theta % 360.0 > 121.0]).max() < 1e-9
    busy = np.abs(torque) > 0.05 * np.abs(torque).max()
    lever = 1e3 * torque[busy] / force[busy]  # N mm of a N
    steepest = math.radians(float(moved.facts.document["cam"]["pressure_angle_deg"]["max"]))
    assert lever.max() < 58.0
    assert lever.min() > 44.0 * math.cos(steepest)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"cam.length_mm": 12}, "no roller holds the turret"),
        (
            {"cam.center_distance_mm": 85, "blank.bore_diameter_mm": 10, "index.angle_deg": 80},
            "wall is undercut",
        ),
    ],
)
def test_contact_forces_of_a_faulty_globoidal_cam_are_refused(
    changes: dict[str, Any], told: str
) -> None:
    crank = {"name": "k", "on": "d.turret", "joint": "B", "length_mm": 40}
    result = machine(
        {"cam": gc.design(INDEXER).with_(changes).to_dict()},
        crank=[crank],
        load=[{"on": "B", "force_n": [0, -10]}],
    )
    with pytest.raises(InfeasibleError) as caught:
        result.study("forces")
    assert told in str(caught.value)


def test_a_cam_in_space_with_a_density_has_no_mass_in_the_plane() -> None:
    heavy = {**DRUM, "blank": {"density_kg_m3": 7850}}
    slide = [{"name": "s", "on": "d.follower", "joint": "T"}]
    push = [{"on": "s", "force_n": -50}]
    moments = [
        machine({"cam": cam, "speed_rpm": 60}, slide=slide, load=push).study("torque").columns
        for cam in (DRUM, heavy)
    ]
    assert moments[0]["torque_nm"].tolist() == moments[1]["torque_nm"].tolist()


def test_cams_in_space_are_compared_with_others_of_their_sort() -> None:
    slide = [{"name": "s", "on": "d.follower", "joint": "T"}]
    motion = [{**one, "law": "modified-sine"} if "law" in one else one for one in DRUM["motion"]]
    result = machine(
        {"cam": DRUM}, slide=slide, compare=[{"name": "x", "cam": {**DRUM, "motion": motion}}]
    )
    # the largest velocity is that of the return: 2 of a cycloid, 4*pi/(4 + pi) of a modified sine
    mean = -60 / math.radians(140)
    largest = [2.0 * mean, 4.0 * math.pi / (4.0 + math.pi) * mean]
    assert result.comparison()["velocity"] == pytest.approx(largest, rel=1e-9)
    disc = gc.load(PROFILES / "lathe_slide.toml").to_dict()
    with pytest.raises(gc.DesignError, match="does not have the shafts of d: follower"):
        machine({"cam": DRUM}, slide=slide, compare=[{"name": "x", "cam": disc}])


def test_a_cam_without_its_kind_is_a_cam() -> None:
    slide = [{"name": "s", "on": "d.follower", "joint": "T"}]
    for cam in (DRUM, gc.load(PROFILES / "lathe_slide.toml").to_dict()):
        spoken = machine({"cam": {k: v for k, v in cam.items() if k != "kind"}}, slide=slide)
        assert spoken.design == machine({"cam": cam}, slide=slide).design


def test_an_impossible_cam_is_refused_with_its_place() -> None:
    cam = {**DRUM, "cam": {**DRUM["cam"], "groove_depth_mm": 18, "lowest_mm": 5}}
    with pytest.raises(InfeasibleError, match=r"\(drive\[0\].cam: cam.lowest_mm\)"):
        _ = machine({"cam": cam}, slide=[{"name": "s", "on": "d.follower", "joint": "T"}]).linkage


def _rollers(body: Any) -> Plane:
    return np.array([one.shape.center for one in body.features if isinstance(one.shape, Circle)])


@pytest.mark.parametrize("frame", FRAMES.values(), ids=FRAMES)
@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_the_picture_has_the_roller_where_the_arm_carries_it(
    frame: dict[str, Any], rotation: str
) -> None:
    arm = {"name": "a", "on": "d.follower", "joint": "T", "length_mm": 160, "arm_angle_deg": 0}
    drives = [{"name": "motor", "even": True},
              {"name": "d", "cam": turning(SWING, rotation), "phase_deg": 70, **frame}]  # fmt: skip
    result: Any = gc.build(
        gc.design({"kind": "mechanism", "name": "m", "drive": drives, "crank": [arm]})
    )
    drawn = scene(result, 36)
    bodies = {one.name: one for one in drawn.bodies}
    (at,) = _rollers(bodies["d.follower"])
    joint = place(result, "T", np.radians(drawn.places))
    assert bodies["d.follower"].pose.apply(at) == pytest.approx(joint, abs=1e-9)
    assert np.ptp(bodies["d.cam"].pose.turn) == 0.0


def test_the_picture_has_a_guide_under_what_a_cylinder_cam_pushes() -> None:
    """Only the roller is drawn of a follower along the cam."""
    drawn = scene(machine({"cam": DRUM}, slide=[{"name": "s", "on": "d.follower", "joint": "T"}]))
    bodies = {one.name: one for one in drawn.bodies}
    assert [one.layer for one in bodies["d.follower"].features] == ["FOLLOWER"]
    assert {one.kind for one in bodies["frame"].features} == {"GROUND"}


def test_the_picture_has_the_rollers_of_a_turret_on_its_cam() -> None:
    drawn = scene(table(), 36)
    bodies = {one.name: one for one in drawn.bodies}
    turret, cam = bodies["d.turret"], bodies["d.cam"]
    # the body of 44 mm, its centre and eight rollers; the tops of the ribs are just outside it
    assert len(turret.features) == 2 + 8
    outline: Any = cam.features[0].shape
    right = outline.points[outline.points.real > 0.0]
    assert np.abs(right - 100.0) == pytest.approx(44.5)
    assert outline.points.imag.max() == pytest.approx(-outline.points.imag.min())
    # at rest one roller is half a pitch below the middle, and one as much above it
    ends = [one.shape.points[1:3].mean() for one in turret.features[:8]]  # pyright: ignore
    angles = np.degrees(np.angle(100.0 - np.array(ends)))
    assert np.sort(np.abs(angles))[:2] == pytest.approx(22.5)
    assert np.abs(np.array(ends) - 100.0) == pytest.approx(58.0)
    # after eight turns of the cam it has turned once
    assert turret.pose.turn[-1] - turret.pose.turn[0] == pytest.approx(-2.0 * math.pi)
