"""Forces of cams in space obey virtual work and equilibrium, and become those of plates."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.kinds.under_load import UnderLoad
from gearcam.mechanics.statics import Statics
from gearcam.spatial.envelope import touched
from gearcam.spatial.friction import SpaceFrictionSpec
from gearcam.spatial.guides import Straight
from gearcam.spatial.loaded import RollerTouch
from helpers_sampling import chosen

CYLINDER = """
kind = "cam"
name = "cylinder"
motion = [
    { type = "rise", angle_deg = 120, law = "modified-sine", lift_mm = 30 },
    { type = "dwell", angle_deg = 60 },
    { type = "return", angle_deg = 120, law = "cycloidal" },
    { type = "dwell", angle_deg = "rest" },
]
follower = { roller_radius_mm = 8 }

[cam]
form = "cylinder"
outer_diameter_mm = 120
length_mm = 90
lowest_mm = 30
groove_depth_mm = 12
"""

INDEXER = """
kind = "cam"
name = "indexer"
index = { law = "modified-sine", angle_deg = 120 }
turret = { stops = 8, roller_radius_mm = 8, roller_length_mm = 14, reach_mm = 58 }
cam = { form = "globoidal", center_distance_mm = 100, floor_clearance_mm = 0.5 }
"""

ARM = {
    "follower.motion": "oscillating",
    "follower.arm_mm": 80,
    "motion": [
        {"type": "rise", "angle_deg": 120, "law": "modified-sine", "lift_deg": 22},
        {"type": "return", "angle_deg": 160, "law": "modified-sine"},
        {"type": "dwell", "angle_deg": "rest"},
    ],
}

RUBBING = {
    "friction.joint": 0.06,
    "friction.roller": 0.1,
    "friction.flank": 0.08,
    "friction.journal_radius_mm": [12, 3],
}
GUIDED = {"friction.guide": 0.1, "friction.guide_length_mm": 60, "friction.guide_distance_mm": 75}

FORMS: dict[str, tuple[str, dict[str, Any]]] = {
    "groove": (CYLINDER, {"load": [{"formula": "120 + 4*s"}], **GUIDED}),
    "clearance": (CYLINDER, {"load": [{"force_n": 90}], "cam.roller_clearance_mm": 0.1}),
    "cone": (CYLINDER, {"load": [{"formula": "120 - 9*s"}], "follower.cone_deg": "apex", **GUIDED}),
    "rib": (CYLINDER, {"load": [{"force_n": 90}], "cam.walls": "rib", "cam.rib_mm": 9, **GUIDED}),
    "end": (CYLINDER, {"load": [{"force_n": 90}], "cam.walls": "lower"}),
    "arm": (CYLINDER, {"load": [{"formula": "6 + 5*s"}], **ARM}),
    "indexer": (INDEXER, {"load": [{"torque_nm": 5}]}),
}


@cache
def built(name: str, *, rubbing: bool = False) -> Any:
    text, changes = FORMS[name]
    design = gc.loads(text).with_(changes | (RUBBING if rubbing else {}))
    return gc.build(design)


def studied(result: Any) -> tuple[Statics, np.ndarray, np.ndarray]:
    under = UnderLoad(result)
    x = np.linspace(0.02, 6.25, 97)
    return under.statics(x, np.ones_like(x)), x, result.program.derivatives(x, 1)[1]


@pytest.mark.parametrize("name", FORMS)
def test_without_friction_the_torque_is_virtual_work(name: str) -> None:
    friction = {key: 0.0 for key in ("friction.guide",) if key in FORMS[name][1]}
    result = gc.build(built(name).design.with_(friction))
    statics, _, ds = studied(result)
    assert not statics.lifted.any()
    assert statics.torque == pytest.approx(statics.against * ds, rel=1e-11, abs=1e-9)
    assert np.abs(statics.torque).max() > 100.0


@pytest.mark.parametrize("name", FORMS)
def test_what_is_put_in_is_useful_or_lost(name: str) -> None:
    statics, _, _ = studied(built(name, rubbing=True))
    lost = sum(statics.lost.values())
    scale = np.nanmax(np.abs(statics.torque))
    assert statics.torque == pytest.approx(statics.useful + lost, abs=1e-10 * scale)
    assert all(np.nanmin(one) >= -1e-12 * scale for one in statics.lost.values())
    assert np.nanmax(statics.lost["contact"]) > 0.005 * scale


@pytest.mark.parametrize("name", FORMS)
def test_the_relative_curvature_is_that_of_the_gap_beside_the_line_of_contact(name: str) -> None:
    """The wall's points of neighbouring angles, and their distance from the roller's axis."""
    cam, step = built(name).cam, 2e-4
    shape = cam.tool
    for wall in cam.walls:
        for theta in (0.4, 1.1, 4.0):
            x = np.full(
                (1, 1), 0.7 * cam.middle + 0.3 * wall.contact_line(np.array([theta]))[0].x[0, -1]
            )
            here = touched(cam.axis(np.array([theta]), wall.side), shape, x, wall.side)
            along = touched(cam.axis(np.array([theta]), wall.side), shape, x + 1e-4, wall.side)
            line = (along.points - here.points)[0, 0]
            line /= np.linalg.norm(line)
            axis = cam.axis(np.array([theta]), wall.side)
            foot, way = axis.point[0, 0], axis.direction[0, 0]
            bends = []
            for sign in (1.0, -1.0):
                other = np.array([theta + sign * step])
                point = touched(cam.axis(other, wall.side), shape, x, wall.side).points[0, 0]
                place = (point - foot) @ way
                aside = np.linalg.norm(point - foot - place * way)
                gap = math.cos(shape.half_angle) * (aside - shape.radius_at(place))
                apart = point - here.points[0, 0]
                across = apart - (apart @ line) * line
                bends.append(2.0 * gap / (across @ across))
            assert here.curvature(shape)[0, 0] == pytest.approx(np.mean(bends), rel=2e-4)


def test_a_narrower_roller_adds_its_own_curvature() -> None:
    cam = built("clearance").cam
    theta, x = np.array([0.3]), np.full((1, 1), cam.middle)
    contact = touched(cam.axis(theta), cam.tool, x, 1)
    both = [contact.curvature(one)[0, 0] for one in (cam.tool, cam.roller)]
    pressed = contact.pressure[0, 0]
    assert both[1] - both[0] == pytest.approx(1.0 / 8.0 - 1.0 / 8.05, rel=0.05 + pressed**2)


@pytest.mark.parametrize("name", FORMS)
def test_the_line_load_is_the_whole_force_and_even_where_the_follower_rests(name: str) -> None:
    result = built(name)
    for touch in result.touches:
        places, loads, _ = touch.pressed(np.array([0.5, 6.1]))
        line = touch.line(np.array([0.5, 6.1]))
        assert (line.weights * loads).sum(axis=1) == pytest.approx([1.0, 1.0], rel=1e-12)
        if name in ("groove", "clearance", "rib", "end"):
            assert np.ptp(loads[1]) == pytest.approx(0.0, abs=1e-12)
            assert loads[1, 0] == pytest.approx(1.0 / np.ptp(places[1]), rel=1e-12)
            # at a slope: less at the inner end, in proportion to the cosine of the pressure angle
            pressure = line.contact.pressure
            assert loads[0] / loads[0, 0] == pytest.approx(
                np.cos(pressure[0]) / np.cos(pressure[0, 0]), rel=1e-12
            )


def in_space(cam: Any, touch: RollerTouch, theta: float) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment about the origin for a normal force of 1, by many sums along the roller."""
    contact, _ = touch.line(np.array([theta]))
    x = np.linspace(contact.x[0, 0], contact.x[0, -1], 4001)[None, :]
    wall = touched(contact.axis, cam.tool, x, contact.side)
    c, s = math.cos(theta), math.sin(theta)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    points, normals = wall.points[0] @ turn.T, wall.normals[0] @ turn.T
    length = np.linalg.norm(np.gradient(points, axis=0), axis=1)  # half a step at the ends
    length[[0, -1]] *= 0.5
    share = np.abs(normals[:, 2]) * length
    each = -(share / share.sum())[:, None] * normals
    return each.sum(axis=0), np.cross(points, each).sum(axis=0)


@pytest.mark.parametrize(("name", "height"), [("groove", 0.0), ("groove", 22.0), ("cone", -15.0)])
def test_both_ends_of_a_guide_hold_the_follower(name: str, height: float) -> None:
    """Six equations of equilibrium: normal force, both ends, and what keeps it from turning."""
    result = gc.build(built(name).design.with_({"friction.guide_at_mm": height}))
    statics, x, _ = studied(result)
    for k in (5, 20, 60):
        touch = result.touches[statics.carrying[k]]
        force, moment = in_space(result.cam, touch, x[k])
        z = 30.0 + result.program.derivatives(x[k : k + 1], 0)[0][0] + height
        sense = np.sign(result.program.derivatives(x[k : k + 1], 1)[1][0])
        ends = [np.array([75.0, 0.0, z + half]) for half in (30.0, -30.0)]
        columns = [np.concatenate([force, moment])]
        columns += [
            np.concatenate([unit, np.cross(end, unit)])
            for end in ends
            for unit in (np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
        ]
        columns.append(np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
        found = np.zeros(6)
        for _ in range(200):  # the drag of the guide depends on the reactions
            drag = 0.1 * sense * (np.hypot(*found[1:3]) + np.hypot(*found[3:5]))
            along = np.array([0.0, 0.0, -statics.against[k] - drag])
            known = np.concatenate([along, np.cross([75.0, 0.0, z], along)])
            found = np.linalg.solve(np.stack(columns, axis=1), -known)
        normal, high, low = found[0], found[1:3], found[3:5]
        assert normal == pytest.approx(statics.force[k], rel=1e-5)
        assert np.hypot(*high) == pytest.approx(statics.reactions["guide_high_n"][k], rel=1e-5)
        assert np.hypot(*low) == pytest.approx(statics.reactions["guide_low_n"][k], rel=1e-5)
        assert found[5] == pytest.approx(
            statics.reactions["guide_twist_nmm"][k], rel=1e-4, abs=1e-6
        )
        tipped = statics.reactions["guide_moment_nmm"][k]
        assert 30.0 * np.hypot(*(high - low)) == pytest.approx(tipped, rel=1e-4)


def test_weight_across_the_guide_takes_part_in_its_friction() -> None:
    """The normal force fulfils the balance of forces along the guide."""
    changes = {
        "mass": [{"mass_kg": 9.0}],
        "gravity.direction_deg": 180.0,
        "drive.speed_rpm": 1.0,
    }
    result = gc.build(built("groove").design.with_(changes))
    statics, x, ds = studied(result)
    ends = statics.reactions["guide_high_n"] + statics.reactions["guide_low_n"]
    lifting = np.array(
        [
            in_space(result.cam, result.touches[c], one)[0][2]
            for c, one in zip(statics.carrying, x, strict=True)
        ]
    )
    needed = statics.against + 0.1 * np.sign(np.where(np.abs(ds) < 1e-9, 0.0, ds)) * ends
    assert statics.force * lifting == pytest.approx(needed, rel=1e-5)
    thrust = statics.reactions["bearing_thrust_n"]  # the bearing pushes the cam as it the follower
    assert thrust == pytest.approx(statics.force * lifting, rel=1e-5)
    assert ends.min() >= 0.999 * 9.0 * 9.80665  # at rest the ends carry the weight


@pytest.mark.parametrize("radius", [3e3, 1.2e4])
def test_a_large_cylinder_is_a_plate(radius: float) -> None:
    """The developed cam: normal force, driving force and pressure of the same lift."""
    turn = 2.0 * math.pi * radius
    lift, depth = 0.09 * turn, 12.0
    rubbing = {"roller": 0.2, "joint": 0.0, "journal_radius_mm": [10, 4]}
    cylinder = gc.build(
        gc.loads(CYLINDER).with_(
            {
                "motion": [
                    {"type": "rise", "angle_deg": 90, "law": "cycloidal", "lift_mm": lift},
                    {"type": "return", "angle_deg": 150, "law": "cycloidal"},
                    {"type": "dwell", "angle_deg": "rest"},
                ],
                "cam.outer_diameter_mm": 2.0 * radius,
                "cam.length_mm": lift + 40.0,
                "load": [{"force_n": 100.0}],
                "friction": rubbing,
            }
        )
    )
    plate = gc.build(
        gc.loads(
            'kind = "cam"\nname = "plate"\nfollower = { type = "roller", roller_radius_mm = 8 }\n'
            f'cam = {{ form = "translating", walls = "both", groove_depth_mm = {depth}, '
            "thickness_mm = 20 }\nblank = { height_mm = 1e5 }\n"
            f'motion = [{{ type = "rise", travel_mm = {turn / 4}, law = "cycloidal", '
            f"lift_mm = {lift} }},"
            f'{{ type = "return", travel_mm = {turn * 5 / 12}, law = "cycloidal" }}, '
            f'{{ type = "dwell", travel_mm = {turn / 3} }}]'
        ).with_({"load": [{"force_n": 100.0}], "friction": rubbing})
    )
    x = np.linspace(0.05, 4.1, 41)
    round_, flat = UnderLoad(cylinder), UnderLoad(plate)
    one = round_.statics(x, np.ones_like(x))
    other = flat.statics(x * radius, np.ones_like(x))
    close = 4.0 * 12.0 / radius
    assert one.force == pytest.approx(other.force, rel=close)
    assert one.torque / radius == pytest.approx(other.torque, abs=100.0 * close)
    assert round_.pressure(one) == pytest.approx(flat.pressure(other), rel=close)
    assert one.lost["contact"] / radius == pytest.approx(other.lost["contact"], rel=close)
    assert np.ptp(other.force) > 5.0  # the pressure angle takes part


def test_the_wall_above_is_the_wall_below_upside_down() -> None:
    rise = [
        {"type": "rise", "angle_deg": 120, "law": "3-4-5", "lift_mm": 20},
        {"type": "dwell", "angle_deg": 30},
        {"type": "return", "angle_deg": 150, "law": "3-4-5"},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    fall = [
        {"type": "return", "angle_deg": 120, "law": "3-4-5", "lift_mm": 20},
        {"type": "dwell", "angle_deg": 30},
        {"type": "rise", "angle_deg": 150, "law": "3-4-5", "lift_mm": 20},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    common = {"mass": [{"mass_kg": 0.4}], "drive.speed_rpm": 200, **RUBBING, **GUIDED}
    below = gc.build(
        gc.loads(CYLINDER).with_(
            {"motion": rise, "cam.walls": "lower", "load": [{"force_n": 60}], **common}
        )
    )
    above = gc.build(
        gc.loads(CYLINDER).with_(
            {"motion": fall, "cam.walls": "upper", "load": [{"force_n": -60}], **common}
        )
    )
    found = [studied(one)[0] for one in (below, above)]
    assert found[0].force == pytest.approx(found[1].force, rel=1e-9)
    assert found[0].torque == pytest.approx(found[1].torque, abs=1e-7)
    speeds = [UnderLoad(one).loads.release for one in (below, above)]
    assert speeds[0] is not None
    assert speeds[1] is not None
    assert speeds[0][:2] == pytest.approx(speeds[1][:2], rel=1e-6)


@pytest.mark.parametrize("name", chosen(["cone", "arm", "indexer"], "cone", "arm"))
def test_a_clockwise_cam_is_the_mirror_image(name: str) -> None:
    design = built(name, rubbing=True).design.with_({"forces.steps": 36})
    one, other = (
        gc.build(design.with_({"cam.rotation": way})).study("forces").columns
        for way in ("ccw", "cw")
    )
    turned = ("pivot_thrust_n",) if name == "indexer" else ("guide_twist_nmm", "pivot_y_n")
    for column in one:
        sign = -1.0 if column in turned else 1.0
        assert other[column] == pytest.approx(
            sign * np.asarray(one[column]), rel=1e-12, nan_ok=True
        ), column


def test_a_turret_is_moved_by_all_rollers_that_are_on_the_cam() -> None:
    """What they press times their levers is the load, by a sum over positions of the rollers."""
    result = built("indexer")
    statics, x, _ = studied(result)
    k = 10
    touch = result.touches[statics.carrying[k]]
    line = touch.line(x[k : k + 1])
    rollers = line.weights.reshape(len(line.contact.x), -1).sum(axis=1) > 0.0
    assert 1 <= rollers.sum() <= 3
    _, loads, _ = touch.pressed(x[k : k + 1])
    c, s = math.cos(x[k]), math.sin(x[k])
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    points = line.of(line.contact.points)[0] @ turn.T
    normals = line.of(line.contact.normals)[0] @ turn.T
    share = (line.weights * loads)[0] * statics.force[k]
    moments = np.cross(points - np.array([100.0, 0.0, 0.0]), -share[:, None] * normals).sum(axis=0)
    assert moments[1] == pytest.approx(5000.0, rel=1e-9)
    tipping = math.hypot(moments[0], moments[2])
    assert statics.reactions["pivot_moment_nmm"][k] == pytest.approx(tipping, rel=1e-9)
    assert statics.reactions["pivot_thrust_n"][k] == pytest.approx(share @ normals[:, 1], rel=1e-9)


@pytest.mark.parametrize("theta", [0.2, 0.7, 1.05, 1.4, 3.0])
def test_all_of_each_roller_that_is_on_the_cam_presses(theta: float) -> None:
    """The length of the lines of contact, by many places on all rollers of the turret."""
    cam = built("indexer").cam
    turns = 2.0 * math.pi * np.arange(-4.0, 4.0) + theta
    x = np.tile(np.linspace(cam.hub, cam.reach, 14001), (len(turns), 1))
    for touch, wall in zip(built("indexer").touches, cam.walls, strict=True):
        points = wall.contact(turns, x).points
        radius, height = np.hypot(points[..., 0], points[..., 1]), np.abs(points[..., 2])
        depth = np.hypot(cam.distance - radius, points[..., 2])
        on = (depth >= cam.top) & (height <= cam.half_length) & (radius < cam.distance)
        apart = np.linalg.norm(np.diff(points, axis=1), axis=2)
        length = apart[on[:, 1:] & on[:, :-1]].sum()
        line = touch.line(np.array([theta]))
        assert line.weights.sum() == pytest.approx(length, abs=6e-3)
        assert touch.rollers(np.array([theta]))[0] == on.any(axis=1).sum()


def test_forces_of_a_roller_that_passes_a_face_do_not_jump() -> None:
    result = built("indexer")
    x = np.linspace(0.3, 1.9, 2001)
    force = UnderLoad(result).statics(x, np.ones_like(x)).force
    assert np.abs(np.diff(force)).max() < 0.02 * force.max()


REFUSED = [
    (CYLINDER, {"cam.walls": "upper", "spring": [{"preload_n": 5}]}, "spring[0]", "below 0"),
    (CYLINDER, {"friction.guide_length_mm": 50}, "guide_distance_mm", ""),
    (CYLINDER, {"load": [{"torque_nm": 5}]}, "load[0].torque_nm", "force_n"),
    (CYLINDER, {"gravity.direction_deg": 90}, "gravity.direction_deg", "mass"),
    (INDEXER, {"load": [{"on": "follower", "torque_nm": 5}]}, "load[0].on", "turret"),
    (INDEXER, {"load": [{"force_n": 5}]}, "load[0]", "torque_nm"),
    (INDEXER, {"mass": [{"mass_kg": 5}]}, "mass[0].inertia", "inertia_kg_m2"),
    (INDEXER, {"friction.guide": 0.1}, "friction.guide", ""),
]


@pytest.mark.parametrize(("text", "changes", "key", "allowed"), REFUSED)
def test_mistakes_are_refused(text: str, changes: Any, key: str, allowed: str) -> None:
    with pytest.raises(DesignError) as refusal:
        gc.loads(text).with_(changes)
    assert key in str(refusal.value)
    assert allowed in str(refusal.value)


def test_an_undercut_wall_has_no_forces() -> None:
    design = gc.loads(CYLINDER).with_(
        {"follower.roller_radius_mm": 14.0, "cam.outer_diameter_mm": 60}
    )
    with pytest.raises(InfeasibleError, match="undercut"):
        gc.build(design).study("forces")


def test_a_guide_without_sizes_has_no_ends() -> None:
    held = Straight(height=0.0).support(SpaceFrictionSpec())
    result = gc.build(gc.loads(CYLINDER).with_({"load": [{"force_n": 10}]}))
    assert not {"guide_low_n", "guide_moment_nmm"} & result.study("forces").columns.keys()
    assert held.mirrored == ("guide_twist_nmm",)


@pytest.mark.parametrize("angle", [15.0, 30.0, 45.0])
def test_the_pressure_of_a_cone_is_that_of_its_line_of_contact(angle: float) -> None:
    """At rest: a cone on a cone about the cam's axis, even load on a line of 12 mm/cos(g)."""
    design = built("groove").design.with_(
        {"follower.cone_deg": angle, "follower.roller_radius_mm": 20.0, "cam.length_mm": 120.0}
    )
    result = gc.build(design.with_({"load": [{"force_n": 100.0}], "friction": {}}))
    statics = UnderLoad(result).statics(np.array([6.1]), np.ones(1))
    g = math.radians(angle)
    assert statics.force[0] == pytest.approx(100.0 / math.cos(g), rel=1e-12)
    # wall and roller at the inner end: the roller of 20 - 12*tan(g), the wall flat around it
    thin = 20.0 - 12.0 * math.tan(g)
    _, loads, curvature = result.touches[statics.carrying[0]].pressed(np.array([6.1]))
    load = statics.force[0] * loads[0, 0]
    line = result.touches[0].line(np.array([6.1])).weights.sum()
    assert line == pytest.approx(12.0 / math.cos(g), rel=1e-9)
    assert load == pytest.approx(statics.force[0] / line, rel=1e-9)
    assert curvature[0, 0] > math.cos(g) / thin


def test_a_pin_is_thinner_than_its_roller() -> None:
    changes = {"friction.roller": 0.1, "friction.journal_radius_mm": [10, 8]}
    for text in (CYLINDER, INDEXER):
        with pytest.raises(DesignError, match="the pin is not thinner than its roller"):
            gc.build(gc.loads(text).with_(changes)).study("forces")


def test_a_roller_that_leaves_the_cam_on_slopes_is_refused() -> None:
    design = gc.loads(CYLINDER).with_(
        {
            "cam.groove_depth_mm": 0.25,
            "cam.length_mm": 120,
            "motion": [
                {"type": "rise", "angle_deg": 100, "law": "3-4-5", "lift_mm": 60},
                {"type": "return", "angle_deg": 150, "law": "3-4-5"},
                {"type": "dwell", "angle_deg": "rest"},
            ],
            "load": [{"force_n": 50}],
        }
    )
    with pytest.raises(InfeasibleError, match="the roller leaves the cam at"):
        gc.build(design).study("forces")


def test_what_is_lifted_off_a_wall_above_needs_loads_that_press_upwards() -> None:
    design = gc.loads(CYLINDER).with_({"cam.walls": "upper", "load": [{"force_n": 20}]})
    (finding,) = [
        one for one in gc.build(design).study("forces").findings if one.code == "lift-off"
    ]
    assert "loads below 0, which press it upwards" in finding.message


def test_slip_is_integrated_to_a_hundredth_across_the_load() -> None:
    """Sideways forces against those of 65 times as many places."""
    from gearcam.spatial import slip

    places = np.linspace(-1.0, 1.0, 17)
    fine = np.linspace(-1.0, 1.0, 16 * 65 + 1)
    found = []
    for x in (places, fine):
        weights = np.full((1, len(x)), 1.0)
        weights[0, [0, -1]] = 0.5
        weights /= weights.sum()
        speeds = 10.0 + 1.3 * x[None, :], 0.2 + 0.3 * x[None, :] ** 2
        rubbed = slip.rubbed(weights, np.full((1, len(x)), 5.0), speeds, 0.01, 0.1)
        found.append([(weights * one).sum() for one in rubbed])
    assert found[0] == pytest.approx(found[1], rel=0.01)
    assert found[0][0] == pytest.approx(0.01, rel=1e-9)  # what the pin needs


def test_a_turret_that_is_free_at_some_angle_has_no_forces() -> None:
    design = built("indexer").design.with_({"cam.length_mm": 18.0})
    with pytest.raises(InfeasibleError, match="no roller holds the turret"):
        gc.build(design).study("forces")


def test_a_spring_that_just_holds_holds_up_to_the_speed_it_was_solved_for() -> None:
    """A preload that a load at rest decides leaves nothing but rounding there."""
    design = gc.loads(CYLINDER).with_(
        {
            "cam.walls": "lower",
            "load": [{"force_n": 80.0, "against": True}],
            "mass": [{"mass_kg": 3.5}],
            "spring": [{"stiffness_n_mm": 2.0, "preload_n": "solve"}],
            "drive.speed_rpm": 150.0,
        }
    )
    found = gc.build(design).study("forces").facts.document["forces"]
    assert found["spring"]["preload_n"] == pytest.approx(80.0, rel=1e-9)
    assert found["release_speed_rpm"] >= 150.0
    assert not found["lifted"]


@pytest.mark.parametrize("text", [CYLINDER, INDEXER])
def test_what_carries_nothing_has_charts_with_lines(text: str) -> None:
    charts = gc.build(gc.loads(text)).study("forces").charts
    assert "normal" in charts
    assert all(one.lines for one in charts.values())


def test_the_summary_has_the_largest_forces_of_bearings_between_steps_too() -> None:
    design = built("groove", rubbing=True).design
    coarse, fine = (gc.build(design.with_({"forces.steps": one})) for one in (24, 2000))
    study = coarse.study("forces")
    largest = study.facts.document["forces"]["largest"]
    for name in ("guide_low_n", "guide_high_n", "bearing_n", "bearing_thrust_n"):
        rows = np.abs(np.asarray(study.columns[name]))
        assert largest[name] == pytest.approx(rows.max(), rel=1e-12)
    more = fine.study("forces").facts.document["forces"]["largest"]
    assert largest == pytest.approx(more, rel=1e-9)
