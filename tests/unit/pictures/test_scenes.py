"""Scenes: what stands where, held against outlines, motion and law by plain geometry."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from shapely import LineString, Point, Polygon

import gearcam
from arch import rules
from gearcam.numeric.contour import Contour
from gearcam.pictures.drawings import Circle, chains
from gearcam.pictures.scenes import PLACES, MovingBody, Scene, extent
from helpers_sampling import few

PROFILES = {path.stem: path for path in sorted((rules.ROOT / "profiles").glob("*.toml"))}
DOCUMENTS: dict[str, Any] = {
    name: tomllib.loads(path.read_text(encoding="utf-8")) for name, path in PROFILES.items()
}
FAST = (
    "circular", "ellipse", "feeder", "furnace_door", "limacon", "ring_ellipse", "shop_order",
    "stepped_ellipse", "two_lobed_ellipse",
)  # fmt: skip
"""Pairs of each sort: what is true of the others is seen in the slow tests."""

CAMS = [
    name
    for name, one in DOCUMENTS.items()
    if one.get("kind") == "cam" and one["cam"].get("form") not in ("cylinder", "globoidal")
]
PAIRS = [
    name if name in FAST else pytest.param(name, marks=pytest.mark.slow)
    for name, one in DOCUMENTS.items()
    if one.get("kind", "gear-pair") == "gear-pair"
]

SLIDING = {
    "sliding, inclined": {"axis_deg": 15},
    "sliding, swinging": {
        "motion": "oscillating", "arm_mm": 80, "pivot_distance_mm": 75, "pivot_height_mm": 10,
    },
}  # fmt: skip
"""Other followers of the translating cam."""

FEW = 36
"""Steps of the driver: enough for every tooth space of a pair to be met somewhere."""

CHORD = 2e-3
"""Two chord errors, mm: of outlines, and of circles in a scene."""


@cache
def made(name: str, key: str = "", value: object = None) -> Any:
    """Return the result of a profile, as it is or with another value."""
    design = gearcam.load(PROFILES[name])
    return gearcam.build(design.with_({key: value}) if key else design)


def sliding(name: str) -> Any:
    """Return a translating cam with one of the other followers."""
    given = DOCUMENTS["translating_cam"]
    follower = given["follower"] | SLIDING[name]
    motion = [dict(one) for one in given["motion"]]
    if "arm_mm" in follower:
        motion[0] = {**motion[0], "lift_deg": 10}
        del motion[0]["lift_mm"]
    return gearcam.build(gearcam.design(given | {"follower": follower, "motion": motion}))


def scene(result: Any, places: int = FEW) -> Scene:
    return result.scene(places)


def wheels(found: Scene, result: Any) -> list[MovingBody]:
    """Return the bodies with teeth, driver first."""
    toothed = {body.name: body for body in found.bodies if body.teeth is not None}
    return [toothed[gear.name] for gear in result.gears]


def stood(body: MovingBody, k: int, points: Any) -> Any:
    """Return points of a body, complex, where they stand at a place."""
    return np.asarray(points) * np.exp(1j * body.pose.turn[k]) + body.pose.shift[k]


def plane(points: Any) -> Any:
    return np.column_stack([points.real, points.imag])


def tooth(body: MovingBody, number: int) -> Any:
    """Return the points of a tooth, complex, in the body's frame."""
    assert body.teeth is not None
    points, _ = next(chains(body.features[0].shape, 1e-3))
    first, last = body.teeth[number - 1]
    return (
        points[first : last + 1] if first <= last else np.append(points[first:], points[: last + 1])
    )


def off(body: MovingBody, k: int, chain: Any, point: complex) -> float:
    """Return the distance of a point from a chain of a body as it stands."""
    return LineString(plane(stood(body, k, chain))).distance(Point(point.real, point.imag))


@pytest.mark.parametrize("name", PAIRS)
def test_wheels_move_as_the_law_says_and_never_into_each_other(name):
    result = made(name)
    found = scene(result)
    motion = result.motion(np.radians(found.places))
    one, two = wheels(found, result)
    assert one.pose.turn == pytest.approx(-np.radians(motion["phi1_deg"]))
    assert not one.pose.shift.any()
    if result.pair.on_rack:
        assert not two.pose.turn.any()
        assert two.pose.shift == pytest.approx(-1j * motion["travel_mm"])
    else:
        # a wheel turns against its mate, a ring with it
        way = -1.0 if result.pair.internal else 1.0
        assert two.pose.turn == pytest.approx(way * np.radians(motion["phi2_deg"]))
        assert two.pose.shift == pytest.approx(np.full(FEW + 1, way * result.pair.center_distance))
    for k in (0, 17):
        first, second = (
            Polygon(
                plane(stood(body, k, part.contours[0].polyline(CHORD))),
                [plane(stood(body, k, edge.points)) for edge in part.inner[:1]],
            )
            for body, part in zip((one, two), result.parts, strict=True)
        )
        assert first.intersection(second).area < CHORD * result.pair.module


@pytest.mark.parametrize("name", PAIRS)
def test_teeth_touch_where_the_scene_says(name):
    result = made(name)
    found = scene(result)
    bodies = wheels(found, result)
    tolerance = 2.0 * max(gear.profile.chord_error for gear in result.gears)
    turns = result.pair.rolling.guide.turns
    for side, contacts in found.contacts.items():
        table = result.contact(np.radians(found.places), side)
        lag = next(table[name] for name in table if name.startswith("lag"))
        assert contacts.start[0] == 0
        assert contacts.start[-1] == len(contacts.point) == len(lag)
        assert contacts.teeth is not None
        for k in range(FEW + 1):
            for row in range(contacts.start[k], contacts.start[k + 1]):
                numbers, point = contacts.teeth[row], contacts.point[row]
                back = np.exp(1j * turns * lag[row]) if turns else 1.0
                # the driven wheel stands where it is designed; flanks touch when it is behind
                middle = bodies[1].pose.shift[k]
                own = middle + (point - middle) * back if turns else point - 1j * lag[row]
                for body, number, place in zip(bodies, numbers, (point, own), strict=True):
                    assert off(body, k, tooth(body, number), place) < tolerance
                # the driver presses onto the driven tooth, out of its own
                inside = Polygon(plane(stood(bodies[0], k, tooth(bodies[0], numbers[0]))))
                steps = point + 20.0 * tolerance * contacts.force[row] * np.array([-1.0, 1.0])
                behind, ahead = (inside.distance(Point(*xy)) for xy in plane(steps))
                assert behind < ahead


@pytest.mark.parametrize("name", PAIRS)
def test_each_tooth_stands_at_its_own_place_on_the_centrode(name):
    result = made(name)
    for body, gear in zip(wheels(scene(result, 1), result), result.gears, strict=True):
        toothing = gear.toothing
        assert body.teeth is not None
        more = 0 if toothing.closed or toothing.in_gap else gear.wheel  # half a tooth at the ends
        half = more == 2
        assert len(body.teeth) == toothing.teeth + more
        # s = 0 is the middle of the driver's first tooth, and of a space of the driven wheel
        first = 0.5 if gear.wheel == 2 else 0.0
        for number in range(1, toothing.teeth + 1):
            s = np.array([(number - 1 + first) * toothing.pitch])
            (place,) = toothing.frames(toothing.track.angle(s)).p
            shape = Polygon(plane(tooth(body, number + half)))
            assert shape.is_valid
            assert shape.contains(Point(place.real, place.imag))


def test_an_open_driven_wheel_begins_and_ends_with_half_a_tooth():
    result = made("furnace_door")
    found = scene(result, 200).contacts["drive"]
    assert result.contact(side="drive")["tooth2"].min() == 0
    assert found.teeth is not None
    assert found.teeth.min(axis=0).tolist() == [1, 1]


def test_a_rack_goes_all_its_way_and_a_turn_ends_a_closed_pair():
    rack, pair = scene(made("feeder")), scene(made("limacon"))
    assert (rack.places[-1], rack.closed) == (540.0, False)  # 60 teeth under a wheel of 40
    assert (pair.places[-1], pair.closed) == (360.0, True)
    assert np.ptp(pair.bodies[1].pose.turn) == pytest.approx(math.pi)


@pytest.mark.parametrize(("angle", "start"), [(-150.0, 0.0), (100.0, 100.0), (900.0, 540.0)])
def test_a_rack_drawn_beyond_its_travel_starts_at_its_end(angle: float, start: float) -> None:
    assert scene(made("feeder", "output.phi1_deg", angle)).start == pytest.approx(start)


@pytest.mark.parametrize("name", ["ellipse", "limacon", "ring_uneven", "feeder", "log_spiral"])
def test_the_pitch_point_divides_the_line_of_centres(name):
    result = made(name)
    found = scene(result)
    assert found.pitch is not None
    assert found.pitch.imag == pytest.approx(0.0, abs=1e-9)
    motion = result.motion(np.radians(found.places))
    if result.pair.on_rack:
        assert found.pitch.real == pytest.approx(motion["velocity_mm_per_rad"])
    else:
        far = np.abs(found.pitch - result.pair.shift)
        assert np.abs(found.pitch) / far == pytest.approx(motion["ratio"])


def test_steps_stand_behind_the_lowest_and_move_with_it():
    result = made("stepped_ellipse")
    found = scene(result)
    names = [body.name for body in found.bodies]
    assert names == [*["gear1"] * 3, *["gear2"] * 3, "gear1", "gear2", "frame"]
    for number, name in enumerate(("gear1", "gear2")):
        steps = [body for body in found.bodies if body.name == name]
        *behind, lowest = steps
        assert all(np.array_equal(one.pose.turn, lowest.pose.turn) for one in behind)
        assert [one.teeth is None for one in steps] == [True, True, True, False]
        shapes = [one.features[0].shape for one in (lowest, *reversed(behind))]
        for shape, gears in zip(shapes, result.steps, strict=True):
            assert shape is gears[number].profile.contour


def test_teeth_of_a_ring_are_on_its_inner_edge():
    ring = next(b for b in scene(made("ring_ellipse"), 1).bodies if b.name == "gear2")
    assert ring.features[0].kind == "INNER"
    points = tooth(ring, 1)
    ends, tip = np.abs(points[[0, -1]]), np.abs(points).min()
    assert tip < ends.min()  # it points to the shaft


@pytest.mark.parametrize("name", few(CAMS))
def test_followers_touch_cams(name):
    demand_touch(made(name))


@pytest.mark.parametrize(
    "name", few(name for name in CAMS if DOCUMENTS[name]["cam"].get("form") != "translating")
)
def test_followers_touch_cams_that_turn_the_other_way(name):
    given = DOCUMENTS[name]["cam"].get("rotation", "ccw")
    demand_touch(made(name, "cam.rotation", "ccw" if given == "cw" else "cw"))


@pytest.mark.parametrize("name", ["plate_cam_offset_roller", "plate_cam_oscillating"])
def test_a_cam_that_is_drawn_turned_moves_the_same(name):
    result = made(name, "output.theta_deg", 100.0)
    demand_touch(result)
    assert scene(result).start == pytest.approx(100.0)
    assert scene(made(name, "output.theta_deg", 355.0)).start == pytest.approx(355.0)


def test_a_yoke_is_touched_from_above_and_from_below():
    contacts = scene(made("yoke_cam")).contacts
    upper, lower = contacts["upper side"], contacts["lower side"]
    # between parallel faces, pressed apart
    assert upper.point.imag - lower.point.imag == pytest.approx(np.full(FEW + 1, 100.0))
    assert upper.force == pytest.approx(np.full(FEW + 1, 1j))
    assert lower.force == pytest.approx(np.full(FEW + 1, -1j))


def test_conjugate_cams_are_two_bodies():
    result = made("conjugate_cams")
    for body, part in zip(scene(result).bodies[:2], result.parts, strict=True):
        (profile,) = (one.shape for one in body.features if one.kind == "PROFILE")
        assert isinstance(profile, Contour)
        assert profile.points == pytest.approx(part.contour.points, abs=1e-9)


@pytest.mark.parametrize("name", SLIDING)
def test_other_followers_touch_cams_that_slide(name):
    demand_touch(sliding(name))


def demand_touch(result: Any) -> None:
    """Demand that contacts lie on cam and follower as they stand, and that nothing else does."""
    found = scene(result)
    *cams, follower, frame = found.bodies
    assert (follower.name, frame.name) == ("follower", "frame")
    assert [body.name for body in cams] == [part.name for part in result.parts]
    rows = zip(found.contacts.values(), _edges(result, cams), strict=True)
    slack = CHORD + (result.design.blank.clearance or 0.0)
    slack += 0.5 * getattr(result.design.cam, "roller_clearance", 0.0)
    lost = result.cam.walls[0].shortfall
    for contacts, (cam, edge) in rows:
        touching = 0
        for k in range(FEW + 1):
            for row in range(contacts.start[k], contacts.start[k + 1]):
                point, force = contacts.point[row], contacts.force[row]
                assert off(cam, k, edge, point) < slack
                gaps = [_gap(follower, k, one.shape, point, force) for one in follower.features]
                assert min(gaps) < slack
                touching += 1
        assert touching > (0.8 if lost else 1.0) * FEW
    _demand_apart(result, found, slack)
    _demand_motion(result, found)


def _edges(result: Any, cams: list[MovingBody]) -> list[tuple[MovingBody, Any]]:
    """Return body and edge, complex, of each set of contacts, in order."""
    shapes = [(cam, one.shape) for cam in cams for one in cam.features]
    found = []
    for wall in result.contours:
        place = wall.points[len(wall.points) // 3]
        near = (
            (cam, np.append(shape.points, shape.points[:1]))
            for cam, shape in shapes
            if isinstance(shape, Contour)
            if np.abs(shape.points - place).min() < CHORD
        )
        found.append(next(near))
    return found * 2 if result.form.half_turns else found


def _gap(follower: MovingBody, k: int, shape: Any, point: complex, force: complex) -> float:
    """Return how far a point is from a follower's shape that the force is square to."""
    if isinstance(shape, Circle):
        (center,) = stood(follower, k, [shape.center])
        # towards the roller's middle
        return abs(center - 0.5 * shape.diameter * force - point)
    chain, _ = next(chains(shape, 1e-3))
    ends = stood(follower, k, chain)
    along = np.diff(ends)
    face = np.flatnonzero(np.abs(np.real(np.conj(along) * force)) < 1e-6 * np.abs(along))
    # a face is touched anywhere, a point with its end
    gaps = [off(follower, k, chain[i : i + 2], point) for i in face]
    return min(gaps, default=float(np.abs(ends - point).min()))


def _demand_apart(result: Any, found: Scene, slack: float) -> None:
    """Demand that rollers do not stand in the metal, and that none hangs in the air."""
    *cams, follower, _ = found.bodies
    rollers = [one.shape for one in follower.features if isinstance(one.shape, Circle)]
    if result.cam.walls[0].shortfall or not rollers:
        return
    for k in range(FEW + 1):
        rings = [LineString(plane(stood(cam, k, edge))) for cam, edge in _edges(result, cams)]
        for roller in rollers:
            (center,) = stood(follower, k, [roller.center])
            gaps = [ring.distance(Point(center.real, center.imag)) for ring in rings]
            assert min(abs(gap - 0.5 * roller.diameter) for gap in gaps) < slack


def _demand_motion(result: Any, found: Scene) -> None:
    """Demand that the follower moves by its lift, upwards or against the cam's own turn."""
    *cams, follower, _ = found.bodies
    driver = result.driver
    motion = result.motion(found.places / driver.scale)
    for cam in cams:
        if result.form.moves == "sliding":
            assert cam.pose.shift == pytest.approx(found.places + 0j)
        else:
            way = -1.0 if result.design.cam.clockwise else 1.0
            assert cam.pose.turn == pytest.approx(way * np.radians(found.places))
    column = next(name for name in motion if name.startswith("lift"))
    lift = motion[column] - motion[column][0]
    if column == "lift_deg":
        assert np.abs(follower.pose.turn - follower.pose.turn[0]) == pytest.approx(
            np.radians(np.abs(lift))
        )
    else:
        way = (follower.pose.shift - follower.pose.shift[0]) * np.exp(
            1j * math.radians(getattr(result.design.follower, "axis", 0.0) or 0.0)
        )
        assert np.abs(way) == pytest.approx(np.abs(lift), abs=1e-9)
        assert way.imag == pytest.approx(np.abs(way.imag) * np.sign(lift), abs=1e-9)


@pytest.mark.parametrize("name", ["translating_cam", "shop_order", "eccentric_cam", "ellipse"])
def test_a_scene_begins_where_the_design_is_drawn(name):
    result = made(name)
    found = scene(result)
    output = result.design.output
    told = getattr(output, "place", None) or math.degrees(output.pose)
    assert found.start == pytest.approx(told)
    assert len(scene(result, PLACES).places) == PLACES + 1


@pytest.mark.parametrize(
    "name", ["feeder", "furnace_door", "ring_ellipse", "translating_cam", "conjugate_cams"]
)
def test_nothing_leaves_the_box_and_little_is_left_empty(name):
    found = scene(made(name))
    left, bottom, right, top = extent(found)
    seen: list[Any] = []
    for body in found.bodies:
        points = np.concatenate([p for f in body.features for p, _ in chains(f.shape, 1e-3)])
        seen += [stood(body, k, points) for k in range(FEW + 1)]
    every: Any = np.concatenate(seen)
    room = (right - left) / 6000.0
    assert every.real.min() >= left - room
    assert every.real.max() <= right + room
    assert every.imag.min() >= bottom - room
    assert every.imag.max() <= top + room
    assert np.ptp(every.real) > 0.9 * (right - left)
    assert np.ptp(every.imag) > 0.9 * (top - bottom)


def test_a_scene_has_the_time_at_its_places_if_it_rises_there():
    found = scene(made("ellipse"))
    rising = np.linspace(0.0, 2.0, len(found.places))
    assert replace(found, times=rising).times is rising
    for wrong in (rising[1:], rising[::-1]):
        with pytest.raises(ValueError, match="a later one for each place"):
            replace(found, times=wrong)
