"""What is drawn of a mechanism: where links, wheels, cams and paths are, by plain geometry."""

from __future__ import annotations

import importlib
import io
import math
import re
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pytest
import shapely

import gearcam as gc
from gearcam.export.dxf import GREY
from gearcam.kinds.mechanism.drawn import distances, path_within, picture
from gearcam.kinds.mechanism.names import parts_of, tables_of
from gearcam.kinds.mechanism.parts.picture import Picture
from gearcam.numeric.arrays import as_pairs
from gearcam.pictures.drawings import GHOST, MEMBER, TRACE, Circle, chains
from gearcam.pictures.scenes import MovingBody, Scene
from gearcam.report.data import scene_data
from gearcam.report.page import blocks
from helpers_machines import MACHINES, machine
from helpers_pairs import PROFILES

etree: Any = importlib.import_module("lxml.etree")  # without types

FEW = 24
"""Steps of the master."""

ROUNDED = 1e-9
"""Of lengths, mm."""

JOINTS = {
    "four-bar": {
        "crank": ("B", "A"), "coupler": ("B", "C", "P"), "rocker": ("C", "D"),
    },
    "slide behind a pair": {"crank": ("B",), "rod": ("B", "C"), "ram": ("C",)},
    "pair, mirrored, turned, twice as fast": {
        "one": ("B",), "two": ("C",), "left": ("B", "P"), "right": ("C", "P"),
    },
    "lever on a cam, mirrored": {"lever": ("B",), "rod": ("B", "C"), "tool": ("C",)},
    "table on two cams": {"x": ("X",), "y": ("Y",), "mx": ("T",), "my": ("T",)},
    "shaper": {
        "crank": ("pin",), "rocker": ("O", "E"), "block": ("pin", "B"), "rod": ("E", "ram"),
        "head": ("ram",),
    },
    "cylinder": {"ram": ("A",), "arm": ("D", "C")},
    "door": {"leaf": ("B",)},
    "lift": {"gate": ("hook",)},
    "Geneva wheel": {},
    "cross": {"crank": ("B",), "block": ("B", "S")},
}  # fmt: skip
"""By machine, the joints that each member is drawn through, as its table says."""

STANDING = {"A": 0j, "D": 110 + 0j, "O": -130j}
"""Places of joints of these machines that stand still and have other names elsewhere."""


def body(scene: Scene, name: str) -> Any:
    (found,) = (one for one in scene.bodies if one.name == name)
    return found


def as_any(one: Any) -> Any:
    return one


def pins(one: MovingBody) -> Any:
    """Return the places of the joints of a member, (n, k)."""
    centers = [f.shape.center for f in one.features if isinstance(f.shape, Circle)]
    return one.pose[:, None].apply(np.array(centers))


def joint(result: Any, name: str, places: Any) -> Any:
    if name in STANDING and name not in {one.joint for one in result.design.dyad}:
        fixed = {one.name: complex(*one.at) for one in result.design.joint}
        return np.full(len(places), fixed.get(name, STANDING[name]))
    return result.linkage.track(name, np.radians(places), 0).c[0] + np.zeros(len(places))


@pytest.mark.parametrize("name", MACHINES)
def test_members_stay_on_their_joints(name: str) -> None:
    result = machine(name)
    scene = result.scene(FEW)
    for member, joints in JOINTS[name].items():
        places = pins(body(scene, member))
        for one in joints:
            off = np.abs(places - joint(result, one, scene.places)[:, None]).min(axis=1)
            assert off.max() < ROUNDED, (member, one)


@pytest.mark.parametrize("name", ["four-bar", "pair, mirrored, turned, twice as fast", "shaper"])
def test_members_of_a_dyad_meet(name: str) -> None:
    """Each body is rigid: that both have a pin in one place closes the loop by itself."""
    scene = machine(name).scene(FEW)
    for dyad in machine(name).design.dyad:
        first, second = (pins(body(scene, member)) for member in dyad.members)
        apart = np.abs(first[:, :, None] - second[:, None, :]).min(axis=(1, 2))
        assert apart.max() < ROUNDED or dyad.type == "RTR"


def test_a_rigid_body_that_lags_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    result = machine("four-bar")
    true = Picture.pose

    def late(self: Any, name: str) -> Any:
        pose = true(self, name)
        return pose if name != "coupler" else type(pose)(pose.turn + 1e-6, pose.shift)

    monkeypatch.setattr(Picture, "pose", late)
    scene = result.scene(FEW)
    first, second = (pins(body(scene, member)) for member in ("coupler", "rocker"))
    assert np.abs(first[:, :, None] - second[:, None, :]).min(axis=(1, 2)).max() > 1e-5


@pytest.mark.parametrize("name", ["slide behind a pair", "pair, mirrored, turned, twice as fast"])
def test_wheels_turn_with_their_cranks(name: str) -> None:
    scene = machine(name).scene(FEW)
    crank = body(scene, "crank" if name.startswith("slide") else "two")
    wheel = body(scene, "pair.gear2")
    behind = (wheel.pose.turn - crank.pose.turn + math.pi) % math.tau
    assert np.ptp(behind) < 1e-9
    assert np.ptp(wheel.pose.turn) == pytest.approx(math.tau * (2 if "twice" in name else 1))


def outline(one: MovingBody, k: int) -> Any:
    (points, _), *_ = chains(one.features[0].shape, 1e-3)
    return shapely.Polygon(as_pairs(one.pose[k].apply(points)))


def ring(points: Any) -> Any:
    return shapely.LinearRing(as_pairs(points))


@pytest.mark.parametrize("name", ["slide behind a pair", "pair, mirrored, turned, twice as fast"])
def test_wheels_mesh_wherever_they_stand(name: str) -> None:
    scene = machine(name).scene(FEW)
    for k in range(0, FEW, 5):
        one, two = (outline(body(scene, f"pair.gear{n}"), k) for n in (1, 2))
        assert one.intersection(two).area < 1e-3
        assert one.distance(two) < 2e-3


@pytest.mark.parametrize(
    ("name", "drive"),
    [("lever on a cam, mirrored", "cam"), ("table on two cams", "camx"),
     ("table on two cams", "camy")],
)  # fmt: skip
def test_rollers_touch_their_cams(name: str, drive: str) -> None:
    scene = machine(name).scene(FEW)
    cam, follower = body(scene, f"{drive}.cam"), body(scene, f"{drive}.follower")
    (roller,) = (f.shape for f in follower.features if isinstance(f.shape, Circle))
    for k in range(FEW):
        center = complex(follower.pose[k].apply(roller.center))
        gap = outline(cam, k).exterior.distance(shapely.Point(center.real, center.imag))
        assert gap - 0.5 * roller.diameter == pytest.approx(0.0, abs=5e-3)


@pytest.mark.parametrize(
    ("name", "slide"), [("table on two cams", "camx"), ("table on two cams", "camy")]
)
def test_slides_are_where_the_follower_ends(name: str, slide: str) -> None:
    scene = machine(name).scene(FEW)
    follower = body(scene, f"{slide}.follower")
    (roller,) = (f.shape for f in follower.features if isinstance(f.shape, Circle))
    member = body(scene, slide[-1])
    assert np.abs(member.pose.shift - follower.pose.apply(roller.center)).max() < 1e-6


def test_the_teeth_of_a_ring_are_seen() -> None:
    drive = {"name": "ring", "pair": str(PROFILES / "ring_ellipse.toml")}
    crank = {"name": "arm", "on": "ring.wheel2", "joint": "B", "length_mm": 30}
    document = {"kind": "mechanism", "name": "drawn", "drive": [drive], "crank": [crank]}
    result = gc.build(gc.design({**document, "output": {"files": ["svg"]}}))
    classes = re.findall(r'class="(gear2-\w+)"', result.files("svg")["poses.svg"].decode())
    assert classes.index("gear2-outline") < classes.index("gear2-inner")


def test_a_chain_covers_its_free_part_and_leaves_its_wheel_along_a_tangent() -> None:
    result = machine("door")
    scene = result.scene(FEW)
    pieces = [one for one in scene.bodies if re.fullmatch(r"chain_\d+", one.name)]
    lines: Any = [(one.pose, one.features[0].shape) for one in pieces]
    ends = np.array([pose[:, None].apply(line.points) for pose, line in lines])
    end = joint(result, "B", scene.places)
    start, center = ends[0, :, 0], 600 + 300j
    assert np.abs(ends[-1, :, 1] - end).max() < ROUNDED
    assert np.abs(np.abs(start - center) - 100.0).max() < ROUNDED
    assert np.abs(((end - start) * (start - center).conj()).real).max() < 1e-6
    along = np.abs(ends - start[:, None])
    assert (along[1:, :, 0] <= along[:-1, :, 1] + ROUNDED).all()  # no gaps
    # the wheel winds up what the free part loses
    wound = 100.0 * np.radians(scene.places)
    free = np.abs(end - start)
    leaving = np.unwrap(np.angle(start - center))
    assert np.ptp(free - 100.0 * leaving + wound) < 1e-6


def test_what_is_lifted_has_its_wheel_beside_the_chain() -> None:
    scene = machine("lift").scene(FEW)
    wheel, gate = body(scene, "chain_wheel"), body(scene, "gate")
    assert wheel.pose.shift[0] == pytest.approx(0.0, abs=ROUNDED)  # where the motor is
    pieces = [one for one in scene.bodies if re.fullmatch(r"chain_\d+", one.name)]
    ends: Any = [one.pose.apply(one.features[0].shape.points[1]) for one in map(as_any, pieces)]
    assert np.abs(ends[-1] - gate.pose.shift).max() < ROUNDED
    lifted = gate.pose.shift.imag - gate.pose.shift[0].imag
    assert np.abs(lifted - 50.0 * wheel.pose.turn).max() < ROUNDED


def test_the_middle_of_a_wheel_that_surrounds_its_crank_is_open() -> None:
    wheel = {"name": "wheel", "on": "motor", "slots": 4, "length_mm": 50, "internal": True}
    document = {"drive": MACHINES["four-bar"]["drive"], "geneva": [wheel]}
    made = gc.design({"kind": "mechanism", "name": "drawn", **document})
    drawn = gc.build(made).files("svg")["poses.svg"].decode()
    (opening,) = re.findall(r'<path class="member-bore" fill="(#\w+)"', drawn)
    assert opening == "#ffffff"
    scene = gc.build(made).scene(4)
    assert scene is not None
    wheel, near = body(scene, "wheel"), 50.0 / math.sin(math.pi / 4) * math.cos(math.pi / 4)
    assert np.abs(wheel.features[1].shape.points).min() == pytest.approx(near)


def test_a_cylinder_holds_its_rod() -> None:
    scene = machine("cylinder").scene(FEW)
    barrel, rod = body(scene, "ram"), body(scene, "ram_rod")
    end = rod.pose.shift
    off = np.abs(end - joint(machine("cylinder"), "C", scene.places))
    assert off.max() < ROUNDED
    inner = rod.features[0].shape.points.real.min()
    depth = np.abs(end - barrel.pose.shift) + inner
    length = barrel.features[0].shape.points.real.max()
    assert (depth > 0.0).all()
    assert (depth < length).all()


def paths(scene: Scene) -> list[Any]:
    shapes: Any = [f.shape for one in scene.bodies for f in one.features if f.kind == TRACE]
    return [one.points for one in shapes]


@pytest.mark.parametrize(("name", "points"), [("four-bar", ["P", "C"]), ("door", ["B"])])
def test_paths_are_those_of_the_points(name: str, points: list[str]) -> None:
    result = machine(name)
    scene = result.scene(FEW)
    for path, one in zip(paths(scene), points, strict=True):
        assert np.abs(path - joint(result, one, scene.places)).max() < ROUNDED


def test_places_are_counted_in_turns_of_the_master() -> None:
    scene = machine("four-bar").scene(FEW)
    assert len(scene.places) == FEW + 1
    assert (scene.start, scene.closed, scene.driver) == (
        pytest.approx(40.0), True, "crank angle theta, deg"
    )  # fmt: skip
    door = machine("door").scene(FEW)
    assert (door.places[0], door.places[-1], door.closed) == (0.0, pytest.approx(400.0), False)


def test_links_have_a_colour_of_their_own() -> None:
    data = scene_data(machine("slide behind a pair").scene(FEW))
    told = {one["name"]: one["link"] for one in data["bodies"]}
    assert told["rod"]
    assert not told["pair.gear1"]


# --- paths within a tolerance --------------------------------------------------------------------


def test_a_path_is_within_its_tolerance_with_few_chords() -> None:
    """A circle of radius r needs pi/sqrt(2*t/r) chords."""
    radius, tolerance = 100.0, 1e-3
    knots = np.array([0.0, math.tau])

    def circle(q: Any) -> Any:
        return radius * np.exp(1j * q)

    q, points = path_within(circle, knots, tolerance)
    least = math.pi / math.acos(1.0 - tolerance / radius)
    assert least <= len(q) - 1 < 1.5 * least
    middle = 0.5 * (points[1:] + points[:-1])
    assert (radius - np.abs(middle)).max() <= tolerance


def test_a_path_with_cusps_and_rests_is_within_its_tolerance() -> None:
    def cycloid(q: Any) -> Any:
        turned = np.clip(q, 1.0, None) - 1.0  # at rest at first
        return 10.0 * (turned - np.sin(turned) + 1j * (1.0 - np.cos(turned)))

    knots = np.array([0.0, 1.0, 1.0 + 2.0 * math.tau])
    q, points = path_within(cycloid, knots, 1e-4)
    between = q[:-1] + np.outer(np.linspace(0.0, 1.0, 42)[1:-1], np.diff(q))
    off = distances(cycloid(between), points[:-1], points[1:])
    assert off.max() < 1e-4


# --- files ---------------------------------------------------------------------------------------


def paths_dxf(result: Any) -> Any:
    return ezdxf.filemanagement.read(io.StringIO(result.files("dxf")["paths.dxf"].decode()))


def layers(result: Any) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    for entity in paths_dxf(result).modelspace():
        found.setdefault(entity.dxf.layer, []).append(entity)
    return found


@pytest.mark.parametrize("tolerance", [0.01, pytest.param(1e-4, marks=pytest.mark.slow)])
def test_the_dxf_holds_the_paths_within_the_tolerance(tolerance: float) -> None:
    result = machine("four-bar")
    result = type(result)(result.design.with_({"output.chord_tolerance_mm": tolerance}))
    for name in ("P", "C"):
        (line,) = layers(result)[f"{name}_PATH"]
        assert line.closed
        points = np.array([x + 1j * y for x, y in line.get_points("xy")])
        q = np.linspace(0.0, math.tau, 8001)
        true = result.linkage.track(name, q, 0).c[0]
        off = shapely.distance(ring(points), shapely.points(as_pairs(true)))
        assert off.max() <= tolerance
        # corners are on the path, but for the spacing of these angles
        assert shapely.distance(ring(true), shapely.points(as_pairs(points))).max() < 1e-5


def test_the_dxf_shows_the_machine_at_its_angle() -> None:
    found = layers(machine("slide behind a pair"))
    assert {"MEMBER", "GROUND", "GEAR1_OUTLINE", "GEAR2_OUTLINE"} <= found.keys()
    assert len(found["MEMBER"]) == 3


@pytest.mark.parametrize("name", ["slide behind a pair", "table on two cams"])
def test_nothing_in_the_dxf_has_the_colour_of_cuts(name: str) -> None:
    found = {one.dxf.name: one.color for one in paths_dxf(machine(name)).layers}
    assert {"GEAR1_OUTLINE", "PROFILE"} & found.keys()
    assert {color for layer, color in found.items() if layer not in ("0", "Defpoints")} == {GREY}


def test_layers_of_points_are_different() -> None:
    document = {"kind": "mechanism", "name": "drawn", **MACHINES["four-bar"]}
    names = ["p", "P", "P_2"]
    document["point"] = [
        {"name": name, "on": "coupler", "at_mm": [10.0 * k, 5]} for k, name in enumerate(names)
    ]
    document["output"] = {"files": ["dxf"]}
    found = layers(gc.build(gc.design(document)))
    assert {one for one in found if one.endswith(TRACE)} == {"p_PATH", "P_2_PATH", "P_2_2_PATH"}


@pytest.mark.parametrize("name", MACHINES)
def test_the_picture_has_all_names(name: str) -> None:
    result = machine(name)
    root: Any = etree.fromstring(result.files("svg")["poses.svg"])
    space = {"s": "http://www.w3.org/2000/svg"}
    texts = [one.text for one in root.findall(".//s:text[@class='name']", space)]
    joints = {one.name for one in (*result.design.joint, *result.design.point)}
    joints |= {one.joint for one in (*result.design.crank, *result.design.dyad)}
    design = result.design
    members = {one.name for one in (*design.crank, *design.hoist, *design.geneva)}
    assert joints | members <= set(texts)
    classes = {one.get("class") for one in root.iter() if one.get("class")}
    assert {"member", "ghost"} <= classes
    # a light edge below each name, for readers that do not know paint-order
    halos = [one.text for one in root.findall(".//s:text[@class='halo']", space)]
    assert halos == texts
    assert not any(one.get("stroke") for one in root.findall(".//s:text[@class='name']", space))
    width, height = (float(one) for one in root.get("viewBox").split()[2:])
    left, top = (float(one) for one in root.get("viewBox").split()[:2])
    for one in root.findall(".//s:text[@class='name']", space):
        assert left < float(one.get("x")) < left + width
        assert top < float(one.get("y")) < top + height


def test_a_picture_shows_wheels_and_paths() -> None:
    for name, words in (
        ("slide behind a pair", {"gear1-outline", "gear2-outline", "ground"}),
        ("table on two cams", {"profile", "follower", "path"}),
    ):
        data = machine(name).files("svg")["poses.svg"].decode()
        assert words <= set(re.findall(r'class="([\w-]+)"', data))


def test_links_are_as_wide_as_suits_the_machine() -> None:
    for name in MACHINES:
        scene = machine(name).scene(FEW)
        shapes: Any = [f.shape for one in scene.bodies for f in one.features if f.kind == MEMBER]
        sizes = [np.ptp(one.points.imag) for one in shapes if not isinstance(one, Circle)]
        data = scene_data(scene)["box"]
        across = math.hypot(data[2] - data[0], data[3] - data[1])
        assert 0.002 < min(s for s in sizes if s) / across < 0.1


def test_symbols_are_not_said_to_be_ready_to_cut() -> None:
    names = ("four-bar", "lift")
    told = {name: blocks(machine(name), seek=False)["verdict"] for name in names}
    assert "Look before you build" in told["four-bar"]
    assert "Nothing is wrong with the motion" in told["lift"]
    assert not any("cut" in one for one in told.values())


def test_the_prime_circle_of_a_cam_is_left_out() -> None:
    data = machine("lever on a cam, mirrored").files("svg")["poses.svg"].decode()
    assert 'class="pitch"' in data
    assert 'class="prime"' not in data


def lift(**hoist: Any) -> Any:
    drive, (own,) = (MACHINES["lift"][key] for key in ("drive", "hoist"))
    document = {"kind": "mechanism", "name": "drawn", "drive": drive, "hoist": [{**own, **hoist}]}
    return gc.build(gc.design(document))


def notes(result: Any) -> dict[str, Any]:
    return {one.code: one for one in result.checked}


@pytest.mark.parametrize("wind", ["ccw", "cw"])
def test_a_hoist_has_its_wheel_on_its_shaft_wherever_the_chain_is(wind: str) -> None:
    way = {"wind": wind, "direction_deg": 90 if wind == "ccw" else -90}
    far = lift(at_mm=[300, -500], **way)
    scene = far.scene(FEW)
    assert np.abs(body(scene, "chain_wheel").pose.shift).max() < ROUNDED
    (dashed,) = (f for one in scene.bodies for f in one.features if f.kind == "CENTRODE")
    assert dashed.shape.points == pytest.approx([50, 300])
    told = notes(far)["guided-chain"]
    near = re.search(r"at_mm = \[(.*)\]", told.message)
    assert near is not None
    straight = [float(one) for one in near[1].split(", ")]
    assert straight == pytest.approx([50, -500])  # both wind and way turned: the same side
    assert told.value == pytest.approx(300.0)
    mended = lift(at_mm=straight, **way)
    assert "guided-chain" not in notes(mended)
    assert not [f for one in mended.scene(FEW).bodies for f in one.features if f.kind == "CENTRODE"]


def test_a_wheel_that_is_not_on_its_shaft_is_told() -> None:
    assert notes(machine("door"))["wheel-apart"].value == pytest.approx(math.hypot(600, 300))
    drive = [{**MACHINES["door"]["drive"][0], "at_mm": [600, 300]}]
    document = {"kind": "mechanism", "name": "drawn", "chain": MACHINES["door"]["chain"]}
    assert "wheel-apart" not in notes(gc.build(gc.design({**document, "drive": drive})))


def test_a_tall_picture_is_not_endless() -> None:
    root: Any = etree.fromstring(lift(at_mm=[50, -5000]).files("svg")["poses.svg"])
    width, height = (int(root.get(one)) for one in ("width", "height"))
    assert width == 960
    assert 1000 < height < 1500


def test_other_angles_are_written_beside_the_machine() -> None:
    """At 60 deg and so on of the crank, those of a machine that rests together."""
    result = machine("four-bar")
    root: Any = etree.fromstring(result.files("svg")["poses.svg"])
    texts = [one for one in root.iter("{*}text") if one.get("class") == "name"]
    at = {one.text: float(one.get("x")) - 1j * float(one.get("y")) for one in texts}
    shown = result.design.output.pose
    angles = [(round(math.degrees(shown)) + 60 * k) % 360 for k in range(1, 6)]
    for angle in angles:
        pin = 40.0 * np.exp(1j * math.radians(angle))
        assert abs(at[f"{angle}°"] - pin) < 12.0
    assert "thin lines: the machine at the theta beside them" in etree.tostring(root).decode()


def test_a_path_there_and_back_is_drawn_once() -> None:
    """The arc of a rocker's end as one way, the loop of a coupler's point whole."""
    (frame,) = (one for one in machine("four-bar").scene(360).bodies if has_path(one))
    loop, arc = (one.shape for one in frame.features if one.kind == TRACE)
    assert (loop.closed, arc.closed) == (True, False)
    turned = np.unwrap(np.angle(arc.points - 110.0))
    assert (np.diff(turned) * np.sign(turned[-1] - turned[0]) > -1e-12).all()
    stroke = machine("four-bar").output("rocker.angle", np.linspace(0, math.tau, 3601))
    assert np.ptp(turned) == pytest.approx(np.ptp(np.radians(stroke["rocker_deg"])), abs=1e-4)


def has_path(one: MovingBody) -> bool:
    return any(feature.kind == TRACE for feature in one.features)


@pytest.mark.parametrize("name", [*JOINTS])
def test_names_stay_on_their_joints(name: str) -> None:
    result = machine(name)
    scene = result.scene(FEW)
    where = {text: one.pose.apply(at) for one in scene.bodies for text, at in one.names}
    design = result.design
    parts: list[Any] = [part for *_, part in parts_of(tables_of(design))]
    joints = [part.joint for part in parts if hasattr(part, "joint")]
    joints += [one.name for one in (*design.joint, *design.point)]
    for joint_name in joints:
        place = joint(result, joint_name, scene.places)
        assert np.abs(where[joint_name] - place).max() < 1e-6


def test_a_swinging_guide_begins_at_its_pivot() -> None:
    """The block of the shaper is never next to it."""
    rocker = next(one for one in machine("shaper").scene(FEW).bodies if one.called == "rocker")
    outlines: Any = [f.shape for f in rocker.features if not isinstance(f.shape, Circle)]
    points = np.concatenate([points for one in outlines for points, _ in chains(one, 1e-3)])
    half = np.abs(points.imag).max()
    assert points.real.min() == pytest.approx(-half, rel=1e-3)


def test_thin_lines_are_drawn_over_wheels_and_under_members() -> None:
    drawing, _ = picture(machine("slide behind a pair"))
    layers = [one.layer for one in drawing.features]
    thin = [k for k, layer in enumerate(layers) if layer == GHOST]
    wheels = [k for k, layer in enumerate(layers) if layer.startswith("GEAR")]
    members = [k for k, layer in enumerate(layers) if layer == MEMBER]
    assert max(wheels) < min(thin)
    assert max(thin) < min(members)
