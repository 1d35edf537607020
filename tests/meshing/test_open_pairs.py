"""Open pairs and racks from stop to stop: whole outlines, dense points, closed forms."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from gearcam.base.errors import InfeasibleError
from gearcam.cli import main
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.gears.pair import Gear
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.centrodes import LogSpiral
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.span import RACK, RING, WHEEL
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import touches
from gearcam.meshing.half_teeth import HalfTeeth, half_teeth
from gearcam.meshing.overlap import Turning
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import mount, phases, study
from helpers_pairs import OVERCLOSURE, PROFILES, explained, job, profile
from helpers_sampling import few

Array = NDArray[np.float64]


SECTOR = Formula(
    ratio="1 + 0.3*cos(phi1) + 0.2*sin(phi1)",
    driver_travel=math.radians(200),
    driven_travel=math.radians(110),
)

PAIRS = {
    "phases": lambda: profile("furnace_door"),
    "sine": lambda: profile("furnace_door_two_phase"),
    "spiral": lambda: profile("log_spiral"),
    "short spiral": lambda: job(
        LogSpiral(ratios=(0.8, 2.36), driven_travel=math.radians(61)), (16, 16), module=2.0
    ),
    "ring": lambda: job(SECTOR, (24, 24), module=2.0, internal=True),
    "feeder": lambda: profile("feeder"),
    "pinion": lambda: job(RackLaw(r1="1"), (20, 30), module=2.0),
    "short rack": lambda: job(RackLaw(r1="1 + 0.1*cos(phi1)"), (20, 6), module=2.0),
}


@cache
def made(name: str) -> GearPairResult:
    return PAIRS[name]()


@cache
def halves(name: str) -> tuple[HalfTeeth, HalfTeeth]:
    return half_teeth(made(name).gear1.profile), half_teeth(made(name).gear2.profile)


def turning(name: str, shift: float = 0.0) -> Turning:
    first, second = halves(name)
    pair = made(name).pair
    return Turning(rolling=pair.rolling, driver=first, driven=second, distance=pair.shift + shift)


def stop(name: str) -> float:
    """Driver angle at the last stop."""
    pair = made(name).pair
    return float(pair.rolling.arc.angle(pair.toothings[1].length))


def lead_of(name: str, way: float) -> float:
    """The driven wheel's turn for a way of about the pitch circle, mm; of a rack the way."""
    pair = made(name).pair
    radius = {RACK: 1.0, WHEEL: 0.5 * pair.center_distance, RING: 2.0 * pair.center_distance}
    return way / radius[pair.law.mate]


def seen(name: str, points: Any, phi: float, lead: float, distance: complex) -> Any:
    """Points of wheel 2 in the assembled pair, by the convention of the frames."""
    law, size = made(name).law, made(name).pair.center_distance
    driven = float(law.phi2(phi))
    if law.mate == RACK:
        return points - 1j * (size * driven + lead) + distance
    turn = -1j if law.mate == RING else 1j
    return points * np.exp(turn * (driven + lead)) + distance


def whole_areas(name: str, distance: complex, angles: Array, lead: float) -> Array:
    areas = []
    for phi in angles.tolist():
        one = made(name).gear1.outline @ [1, 1j] * np.exp(-1j * (phi + OVERCLOSURE))
        two = seen(name, made(name).gear2.outline @ [1, 1j], phi, lead, distance)
        wheels = [shapely.Polygon(np.stack([z.real, z.imag], axis=1)) for z in (one, two)]
        areas.append(wheels[0].intersection(wheels[1]).area)
    return np.array(areas)


@pytest.mark.parametrize("name", PAIRS)
def test_halves_and_body_make_up_an_open_wheel(name: str) -> None:
    for gear, parts in zip(made(name).gears, halves(name), strict=True):
        z = gear.toothing.teeth
        if parts.closed:
            assert (parts.count, parts.first) == (2 * z, 0)
            continue
        assert (parts.count, parts.first) == (2 * z + 2, -1)
        whole = shapely.Polygon(gear.outline)
        assert shapely.area(parts.polygons).sum() == pytest.approx(whole.area, rel=1e-12)
        union = shapely.union_all(parts.polygons)
        assert union.symmetric_difference(whole).area < 1e-9 * whole.area
        # halves -1, 0, 1, ... belong to the teeth at the middles of which they begin
        middle = gear.toothing.track.angle(
            gear.toothing.tooth_places[parts.teeth - gear.toothing.numbers[0]]
        )
        off = np.abs(gear.toothing.frames(middle).p - parts.tips)
        assert off.max() < 0.5 * gear.toothing.pitch
        ends = (1, z + 1) if gear.wheel == 1 else (0, z + 1)
        assert parts.tooth(np.array([-1, 2 * z])).tolist() == list(ends)
        assert parts.tooth(np.array([2 * z + 1])).mask.all()
        assert parts.index(np.array([-2, -1, 2 * z, 2 * z + 1])).tolist() == [-1, 0, 2 * z + 1, -1]


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("shift", few([-0.03, 0.0, -0.4], 3))
def test_all_overlap_is_that_of_the_whole_outlines(name: str, shift: float) -> None:
    """From stop to stop: in place, pushed together, turned by up to half a tooth."""
    module = made(name).pair.module
    mounted = turning(name, shift)
    angles = np.linspace(0.0, stop(name), 5)
    most = []
    for lead in (0.0, 0.02 * module, -0.4 * module):
        found = mounted.overlaps(angles, OVERCLOSURE, lead_of(name, lead))
        areas = np.bincount(found.step, found.area, minlength=len(angles))
        expected = whole_areas(name, mounted.distance, angles, lead_of(name, lead))
        assert areas == pytest.approx(expected, rel=1e-9, abs=1e-12 * module**2)
        most.append(expected[[0, -1]].min())
    assert max(most) > 0.01 * module**2  # at both stops there was something to see


@pytest.mark.parametrize(
    ("name", "turn"), [("spiral", -1.0), ("spiral", math.pi), ("phases", 2.0), ("ring", 1.9)]
)
def test_arms_and_hubs_are_seen(name: str, turn: float) -> None:
    """Turned so far that bodies run into teeth and into each other."""
    mounted = turning(name, -4.0)
    angles = np.linspace(0.0, stop(name), 5)
    found = mounted.overlaps(angles, OVERCLOSURE, turn)
    areas = np.bincount(found.step, found.area, minlength=len(angles))
    expected = whole_areas(name, mounted.distance, angles, turn)
    assert areas == pytest.approx(expected, rel=1e-9)
    bodies = [parts.count + parts.first for parts in halves(name)]
    assert all(np.any(found.half[k] == bodies[k]) for k in (0, 1))
    assert not found.facing[(found.half[0] == bodies[0]) | (found.half[1] == bodies[1])].any()


@pytest.mark.parametrize("name", few(PAIRS))
def test_in_place_nothing_overlaps_and_nothing_plays(name: str) -> None:
    angles = np.linspace(0.0, stop(name), 91)
    found = turning(name).overlaps(angles, 0.0)
    areas = np.bincount(found.step, found.area, minlength=len(angles))
    assert areas.max() <= explained(made(name))
    for side in (DRIVE, COAST):
        first = extreme(name, side, angles)
        assert first == pytest.approx(0.0, abs=1e-9)
    held = turning(name).flank_distance(DRIVE, angles, -OVERCLOSURE)
    assert np.all(held > 0.0)
    noise = 2.0 * sum(parts.chord_error for parts in halves(name))
    assert held.max() < OVERCLOSURE * np.abs(made(name).gear1.outline @ [1, 1j]).max() + noise


def extreme(name: str, side: int, angles: Array, shift: float = 0.0) -> Array:
    """The driven wheel's turn at first touch."""
    distance = made(name).pair.shift + shift
    found = touches(flank_pairs(made(name).gears, side, distance), angles)
    outward = np.full(len(angles), -np.inf)
    np.maximum.at(outward, found.step, -side * found.turn)
    return -side * outward


@cache
def flank(gear: Gear, place: int, sigma: int) -> NDArray[np.complex128]:
    """Dense points of a flank by its place among the teeth formed, in the wheel's frame."""
    flanks, toothing = gear.profile.flanks, gear.toothing
    number = place + (0 if sigma > 0 else len(toothing.numbers))
    reach = np.linspace(flanks.lowest[number], flanks.highest[number], 4001)
    sf = flanks.sf[number]
    frames = toothing.frames(toothing.track.angle(sf - sigma * reach))
    return toothing.flank_points(frames, np.full(4001, sf), np.full(4001, float(sigma)))


def dense_touch(name: str, side: int, phi: float, distance: complex) -> float:
    """First touch by dense points: of every flank near the pitch point on both wheels' blanks."""
    gears, mate = made(name).gears, made(name).law.mate
    first, second = (gear.toothing for gear in gears)
    s = float(first.track.arc_length(phi))
    ahead = []
    for place, at in enumerate(second.tooth_places.tolist()):
        sf = at - side * second.half_tooth
        if not (abs(sf - s) < 2.5 * second.pitch and second.ends[0] < sf < second.ends[1]):
            continue
        own = round((sf - side * first.half_tooth - first.tooth_places[0]) / first.pitch)
        own = own % first.teeth if first.closed else own
        one = flank(gears[0], own, side) * np.exp(-1j * phi) - distance
        two = seen(name, flank(gears[1], place, -side), phi, 0.0, 0.0)
        height, turn = {
            RACK: (lambda z: -z.real, lambda z: -z.imag),
            RING: (np.abs, lambda z: -np.angle(z)),
            WHEEL: (np.abs, lambda z: np.angle(-z)),
        }[mate]
        order = np.argsort(height(two))
        rho = height(two)[order]
        inside = (height(one) > rho[0]) & (height(one) < rho[-1])
        if inside.any():
            gap = turn(one[inside]) - np.interp(height(one)[inside], rho, turn(two)[order])
            ahead.append((-side * gap).max())
    return -side * max(ahead)


@pytest.mark.parametrize("name", few(["ring", "phases", "short rack", "spiral", "feeder"]))
@pytest.mark.parametrize("side", [DRIVE, COAST])
@pytest.mark.parametrize("shift", few([0.1, -0.1]))
def test_first_touch_is_that_of_dense_points(name: str, side: int, shift: float) -> None:
    angles = np.linspace(0.0, stop(name), 9)
    distance = made(name).pair.shift + shift
    expected = [dense_touch(name, side, phi, distance) for phi in angles.tolist()]
    radius = lead_of(name, 1.0)
    assert extreme(name, side, angles, shift) == pytest.approx(expected, abs=1e-5 * radius)
    assert np.abs(expected).max() > 2e-2 * radius


@pytest.mark.parametrize("shift", [0.2, -0.2])
def test_a_rack_moved_away_plays_by_twice_the_way_s_tangent(shift: float) -> None:
    """Play 2*d*tan(alpha), half on each side, whatever the phase; the outlines say so too."""
    angles = np.linspace(0.0, stop("pinion"), 41)
    half = shift * math.tan(made("pinion").pair.rack.pressure_angle)
    for side in (DRIVE, COAST):
        assert extreme("pinion", side, angles, shift) == pytest.approx(side * half, abs=1e-9)
    mounted = turning("pinion", shift)
    noise = sum(1.5 * parts.chord_error for parts in halves("pinion"))
    for share, free in ((0.9, True), (1.1, False)):
        found = mounted.overlaps(angles, 0.0, share * half)
        hit = np.bincount(found.step, found.depth > noise, minlength=len(angles)) > 0
        assert np.all(hit == (shift < 0.0 or not free))


@pytest.mark.parametrize("name", ["phases", "spiral", "ring", "feeder"])
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_a_flank_moved_by_20_um_turns_the_driven_wheel_by_20_um_over_its_lever(
    name: str, side: int
) -> None:
    pairs = flank_pairs(made(name).gears, side)
    driver, driven = pairs.wheels
    j = 4
    (number,) = np.flatnonzero(driver.flanks.sf == driver.place(np.array([j])))
    sf = driver.flanks.sf.copy()
    phi = driver.toothing.track.angle(sf[number : number + 1])
    sf[number] += side * 0.02
    moved_flanks = replace(driver.flanks, sf=sf)
    broken = replace(pairs, wheels=(replace(driver, flanks=moved_flanks), driven))
    exact, moved = contacts(pairs, phi), touches(broken, phi)
    normal = 0.02 * math.cos(made(name).pair.rack.pressure_angle)
    lever = exact.lever[1][exact.pair == j]
    if made(name).law.mate == RACK:
        lever = np.abs(exact.force.imag[exact.pair == j])
    assert moved.turn[moved.pair == j] == pytest.approx(-side * normal / lever, rel=5e-3)
    others = touches(pairs, phi).turn[moved.pair != j]
    assert moved.turn[moved.pair != j] == pytest.approx(others, abs=1e-12)


@pytest.mark.parametrize("name", ["phases", "spiral", "ring", "feeder"])
@pytest.mark.parametrize("tooth", ["first", "last"])
def test_an_end_tooth_moved_by_20_um_is_seen_at_its_stop(name: str, tooth: str) -> None:
    mounted = turning(name)
    half = 0 if tooth == "first" else 2 * made(name).pair.teeth[1]
    place = int(mounted.driver.index(np.array([half]))[0])
    driver = mounted.driver
    points = driver.points.copy()
    points[driver.starts[place] : driver.starts[place + 1]] *= np.exp(
        0.02j / abs(driver.tips[place])
    )
    broken = replace(mounted, driver=replace(driver, points=points))
    angles = np.array([0.0 if tooth == "first" else stop(name)])
    noise = 1.5 * sum(each.chord_error for each in halves(name))
    for found, seen_it in ((mounted.overlaps(angles, 0.0), 0), (broken.overlaps(angles, 0.0), 1)):
        deep = found.depth > noise
        assert np.count_nonzero(deep) == seen_it
        assert np.all(found.facing[deep])
        assert np.all(mounted.driver.index(found.half[0][deep]) == place)


@pytest.mark.parametrize("name", ["furnace_door", "feeder"])
def test_the_command_studies_the_travel_with_both_stops(name: str, tmp_path: Path) -> None:
    file = str(PROFILES / f"{name}.toml")
    assert main(["mesh", file, "-o", str(tmp_path), "--steps", "25"]) == 0
    found = json.loads((tmp_path / name / "summary.json").read_text("utf-8"))["meshing"]
    assert (found["steps_done"], found["interference_steps"]) == (25, 0)
    assert found["agreement"]["steps_apart"] <= 1
    assert found["agreement"]["inside"] < 0.02
    rows = np.genfromtxt(
        tmp_path / name / "meshing.csv", delimiter=",", names=True, encoding="ascii"
    )
    door = profile(name).pair
    last = math.degrees(float(door.rolling.arc.angle(door.toothings[1].length)))
    steps = np.unique(rows["phi1_deg"])
    assert steps == pytest.approx(np.linspace(0.0, last, 25), rel=1e-12)
    assert set(rows["facing"]) == {1.0}
    whole = np.isfinite(rows["closed_mm2"])
    assert np.count_nonzero(whole) > 10
    assert rows["predicted_mm2"][whole] == pytest.approx(rows["closed_mm2"][whole], rel=0.02)
    assert ("center_distance_mm" in found) == (door.law.mate != RACK)


def test_the_backlash_of_a_rack_is_the_way_that_it_may_move() -> None:
    gears = job(RackLaw(r1="1"), (20, 12), module=2.0, backlash=0.06).gears
    found = study(gears, MeshingSpec(steps=5))
    assert found.every("backlash") / found.every("along") == pytest.approx(0.06, rel=1e-9)
    assert found.every("backlash") == pytest.approx(0.06, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "spec", "words"),
    [
        ("spiral", MeshingSpec(start=-0.1), "between 0 and 200 deg"),
        ("spiral", MeshingSpec(end=4.0), "between 0 and 200 deg"),
        ("spiral", MeshingSpec(start=4.0), "before it begins"),
        ("feeder", MeshingSpec(center_distance=40.0), "no shaft"),
    ],
)
def test_what_leaves_the_travel_is_refused(name: str, spec: MeshingSpec, words: str) -> None:
    with pytest.raises(InfeasibleError, match=words):
        study(made(name).gears, spec)


def test_teeth_choose_phases_of_every_turn_of_a_pinion() -> None:
    setup = mount(made("feeder").gears, MeshingSpec(teeth=(2,), steps=541))
    chosen = phases(setup.spec, setup.pairs[setup.side])
    turns = np.unique(np.floor((np.degrees(chosen) + 90.0) / 360.0))
    assert turns.tolist() == [0.0, 1.0]
    off = np.degrees(
        np.angle(np.exp(1j * (chosen - setup.turning.rolling.arc.angle(2.0 * math.pi))))
    )
    assert np.abs(off).max() < 20.0


def test_no_two_vertices_of_a_half_tooth_are_a_rounding_apart() -> None:
    """Turned, they crossed, and the overlap of what crosses itself was told as all of it."""
    for gear in job(RackLaw(r1="1"), (27, 196), module=2.0).gears:
        halves = half_teeth(gear.profile)
        for polygon in halves.polygons:
            corners = shapely.get_coordinates(polygon)
            assert np.hypot(*np.diff(corners, axis=0).T).min() > 1e-9
