"""Openings have the sizes that are asked for, keep what they must keep, and are refused else."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Mark, Opening, Part
from gearcam.parts.make import finished, make_part
from gearcam.parts.marks import timing_mark
from gearcam.parts.openings import Stock, Workpiece, bore, openings
from gearcam.parts.shapes import Circle, Loop
from helpers_contour import disc_contour, gear_contour
from helpers_pairs import profile
from helpers_sampling import few
from witness.distance import distances

FINE = 1e-6
"""Chords of openings in these tests, mm."""

PLACE = Workpiece(name="wheel 1", wheel=1, rim=5.4)


def blank(**sizes: Any) -> WheelBlank:
    return WheelBlank(**{"timing_marks": False, **sizes})


def made(contour: Contour, sizes: WheelBlank, place: Workpiece = PLACE, **rest: Any) -> Part:
    return make_part("g", [finished(contour, sizes, place)], 10.0, sizes, place, **rest)


def region(opening: Opening | Circle | Loop, sagitta: float = FINE) -> shapely.Polygon:
    shape = opening.shape if isinstance(opening, Opening) else opening
    return shapely.Polygon(as_pairs(shape.polyline(sagitta)))


def turned(shape: Circle | Loop, angle: float) -> shapely.Polygon:
    return shapely.affinity.rotate(region(shape), -angle, origin=(0, 0), use_radians=True)


def across(polygon: shapely.Polygon, x: float) -> tuple[float, float]:
    """Where a line parallel to y enters and leaves a polygon."""
    cut = shapely.LineString([(x, -1e3), (x, 1e3)]).intersection(polygon)
    return cut.bounds[1], cut.bounds[3]


KEYED = blank(bore_diameter=20.0, keyway_width=6.0, keyway_depth=2.8)
FLAT = blank(bore_diameter=20.0, bore_flat=17.5)


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0, math.pi])
def test_a_keyway_is_measured_across_and_from_the_bore(angle: float) -> None:
    shape = bore(replace(KEYED, keyway_angle=angle))
    assert isinstance(shape, Loop)
    polygon = turned(shape, angle)
    assert across(polygon, 11.5) == pytest.approx((-3.0, 3.0), abs=1e-9)
    assert polygon.bounds == pytest.approx((-10.0, -10.0, 12.8, 10.0), abs=2 * FINE)
    assert np.abs(shape.bulges).max() <= 1.0, "an arc beyond a half circle"
    strip = 2 * 3 * 12.8 - (3 * math.sqrt(91) + 100 * math.asin(0.3))
    assert shape.moments.area == pytest.approx(100 * math.pi + strip, rel=1e-12)
    assert np.abs(shape.points).max() == pytest.approx(KEYED.bore_reach, rel=1e-14)
    assert KEYED.bore_reach == pytest.approx(math.hypot(12.8, 3.0), rel=1e-14)


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_a_flat_is_measured_from_the_far_side(angle: float) -> None:
    shape = bore(replace(FLAT, keyway_angle=angle))
    polygon = turned(shape, angle)
    assert polygon.bounds == pytest.approx((-10.0, -10.0, 7.5, 10.0), abs=2 * FINE)
    half = math.acos(7.5 / 10)
    segment = 100 * (half - math.sin(half) * math.cos(half))
    assert shape.moments.area == pytest.approx(100 * math.pi - segment, rel=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_two_flats_are_measured_across_and_turned(angle: float) -> None:
    shape = bore(blank(bore_diameter=20.0, bore_across_flats=14.0, keyway_angle=angle))
    assert isinstance(shape, Loop)
    assert turned(shape, angle).bounds == pytest.approx((-7.0, -10.0, 7.0, 10.0), abs=2 * FINE)
    half = math.acos(0.7)
    segment = 100 * (half - math.sin(half) * math.cos(half))
    assert shape.moments.area == pytest.approx(100 * math.pi - 2 * segment, rel=1e-12)
    assert shape.moments.first == pytest.approx(0.0, abs=1e-12)
    assert shape.reach == pytest.approx(10.0, rel=1e-14)
    ends = shape.points * np.exp(-1j * angle)
    assert ends.real == pytest.approx([7, 7, -7, -7])
    assert (shape.bulges == 0.0).tolist() == [True, False, True, False]


@pytest.mark.parametrize(
    ("motor", "size"),
    [
        ("28BYJ-48", {"bore_diameter": 5.0, "bore_across_flats": 3.0}),
        ("N20", {"bore_diameter": 3.0, "bore_flat": 2.5}),
        ("TT", {"bore_diameter": 5.4, "bore_across_flats": 3.7}),
        ("NEMA 17", {"bore_diameter": 5.0, "bore_flat": 4.5}),
        ("NEMA 23", {"bore_diameter": 6.35, "bore_flat": 5.85}),
    ],
)
def test_a_motor_has_the_bore_of_its_shaft(motor: str, size: dict[str, float]) -> None:
    named, given = blank(shaft=motor, keyway_angle=0.4), blank(**size, keyway_angle=0.4)
    assert named.bore == size["bore_diameter"]
    assert named.bore_reach == 0.5 * named.bore
    own, same = (bore(one).moments for one in (named, given))
    assert (own.area, own.first) == (same.area, same.first)
    wide = blank(shaft=motor, clearance=0.1, clearance_bores=True)
    flat = wide.widened.bore_flat or wide.widened.bore_across_flats
    assert flat == pytest.approx([*size.values()][1] + 0.2)
    assert made(disc_contour(50.0), wide).openings[0].shape.moments.area > same.area


def test_a_standard_keyway_is_that_of_the_bore() -> None:
    named = blank(bore_diameter="25 H7", keyway="DIN 6885", keyway_angle=0.4)
    assert (str(named.sized.keyway_width), named.sized.keyway_depth) == ("8 JS9", 3.3)
    assert str(named.sized.bore_diameter) == "25 H7"
    given = blank(bore_diameter=25.0, keyway_width=8.0, keyway_depth=3.3, keyway_angle=0.4)
    assert bore(named).moments == bore(given).moments
    assert named.bore_reach == given.bore_reach
    assert given.sized is given


def test_bolts_stand_on_their_circle() -> None:
    sizes = blank(bolts=5, bolt_circle=60.0, bolt_diameter=6.6, bolt_angle=0.3)
    found = made(disc_contour(50.0), sizes).openings
    assert [opening.name for opening in found] == [f"bolt hole {k}" for k in range(1, 6)]
    for k, opening in enumerate(found):
        assert isinstance(opening.shape, Circle)
        wanted = 30 * np.exp(1j * (0.3 + 2 * math.pi * k / 5))
        assert opening.shape.center == pytest.approx(wanted, abs=1e-13)
        assert opening.shape.diameter == 6.6


def test_what_is_not_wanted_is_not_there() -> None:
    part = made(disc_contour(50.0), blank())
    assert (part.openings, part.hub, part.marks) == ((), None, ())


@cache
def toothed() -> Contour:
    return gear_contour(16, 5.0)


@cache
def roots_away() -> tuple[np.ndarray, np.ndarray]:
    """Points of a grid, and how far each is within the outline, mm; negative outside."""
    axis = np.linspace(-36.0, 36.0, 241)
    grid = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    polygon = toothed().polygon
    away = distances(grid, polygon.boundary)
    return grid, np.where(shapely.contains_xy(polygon, *grid.T), away, -away)


LIGHT = {"bore_diameter": 12.0, "hub_diameter": 18.0, "hub_front": 2.0, "rim": 5.0, "web": 3.0}


@pytest.mark.parametrize("count", [1, 2, 3, 5])
@pytest.mark.parametrize("bolts", [0, 3])
def test_lightening_holes_keep_rim_and_web_and_are_the_largest(count: int, bolts: int) -> None:
    """Against circles about all points of a grid: none that keeps the rules is 2 % larger."""
    if bolts and count > 3:
        return
    sizes = blank(**LIGHT, lightening_holes=count)
    if bolts:
        sizes = replace(sizes, bolts=bolts, bolt_circle=40.0, bolt_diameter=3.0, bolt_angle=0.2)
    every = made(toothed(), sizes).openings
    found, others = ([o for o in every if o.name.startswith(n)] for n in ("light", "bolt"))
    holes = [o.shape for o in found if isinstance(o.shape, Circle)]
    assert len(holes) == count
    ring = toothed().polygon.boundary
    grid, room = roots_away()
    room = room - 5.0
    room = np.minimum(room, np.hypot(*grid.T) - 9.0 - 3.0)
    for other in others:
        assert isinstance(other.shape, Circle)
        room = np.minimum(room, np.abs(grid @ [1, 1j] - other.shape.center) - 1.5 - 3.0)
    for number, hole in enumerate(holes):
        radius, place = hole.diameter / 2, hole.center
        turn = place * np.exp(-2j * math.pi * (number + 0.5) / count)
        walls = [ring.distance(shapely.Point(place.real, place.imag)) - radius - 5.0]
        walls.append(abs(place) - radius - 9.0 - 3.0)
        walls += [
            abs(place - o.shape.center) - radius - 4.5  # pyright: ignore[reportAttributeAccessIssue]
            for o in others
        ]
        beside = np.full(len(grid), np.inf)
        if count > 1:
            spokes = grid @ [1, 1j] * np.exp(-2j * math.pi * (number + 0.5) / count)
            half = math.pi / count
            beside = spokes.real * math.sin(half) - np.abs(spokes.imag) * math.cos(half) - 1.5
            away = turn.real * math.sin(half) - abs(turn.imag) * math.cos(half)
            walls.append(away - radius - 1.5)
        assert min(walls) > -1e-3, "a rule is broken"
        assert min(walls) < 0.01 * 5.0, "it touches nothing"
        assert radius > np.minimum(room, beside).max() / 1.02
    for one, other in zip(holes, holes[1:] + holes[:1], strict=True):
        if one is not other:
            away = abs(one.center - other.center)
            assert away - (one.diameter + other.diameter) / 2 >= 3.0 - 1e-3


@pytest.mark.parametrize("angle", [60.0, 120.0])
def test_of_a_sector_in_two_pieces_the_larger_is_taken(angle: float) -> None:
    """A bolt hole of 30 mm closes the ring between bore and rim of one sector."""
    sizes = blank(
        bore_diameter=20.0, bolts=1, bolt_circle=56.0, bolt_diameter=30.0,
        bolt_angle=math.radians(angle), lightening_holes=2, rim=5.0, web=3.0,
    )  # fmt: skip
    hole = made(disc_contour(50.0), sizes).openings[2]
    assert isinstance(hole.shape, Circle)
    place = math.degrees(np.angle(hole.shape.center))
    assert (place > 60.0) if angle == 60.0 else (place < 120.0)
    # the ring's whole width, rim and web taken off
    assert hole.shape.diameter == pytest.approx(45.0 - 13.0, abs=0.02)


@pytest.mark.parametrize("core", few([10.0, 40.0]))
def test_a_thin_rim_leaves_the_web_whole(core: float) -> None:
    """A web is kept as exactly as the rim, also where the bore is large."""
    sizes = blank(bore_diameter=2 * core, lightening_holes=4, rim=0.2, web=2.0)
    for opening in made(disc_contour(60.0), sizes).openings[1:]:
        assert isinstance(opening.shape, Circle)
        away = abs(opening.shape.center) - opening.shape.diameter / 2 - core
        assert away >= 2.0 - 1e-4


def test_rim_and_web_have_their_defaults() -> None:
    """2.7 modules, and the web as the rim; a bore of 20 in a disc of 100: touching both."""
    (hole,) = made(disc_contour(50.0), blank(lightening_holes=1, bore_diameter=20.0)).openings[1:]
    assert isinstance(hole.shape, Circle)
    assert hole.shape.diameter == pytest.approx(40 - 4 * 2.7, abs=0.02)
    (hole,) = made(
        disc_contour(50.0), blank(lightening_holes=1, bore_diameter=20.0, rim=3.0)
    ).openings[1:]
    assert hole.shape.moments.area == pytest.approx(math.pi * 17**2, abs=1.0)


@pytest.mark.parametrize("wheel", few([1, 2]))
@pytest.mark.parametrize("travel", few([0.4, 2.0, 5.0]))
def test_the_pin_stays_in_its_slot_all_the_way(wheel: int, travel: float) -> None:
    """The housing's pin stands on the line of centres: wheel 1 turns by -phi1, wheel 2 by +phi2.

    Turned back into the wheel's frame it is at +phi1, or at pi - phi2.
    """
    pin = 5.0
    place = Workpiece(name=f"wheel {wheel}", wheel=wheel, rim=5.4, travel=travel)
    part = made(disc_contour(50.0), blank(bore_diameter=20.0, stop_pin=pin), place)
    slot = next(o for o in part.openings if o.kind == "SLOT")
    assert isinstance(slot.shape, Loop)
    assert np.abs(slot.shape.bulges).max() <= 1.0, "an arc beyond a half circle"
    # midway between bore and roots; farther out where the slot's own ends come near each other
    ends = np.abs(slot.shape.points)
    radius = 0.5 * float(ends.max() + ends.min())
    roomiest = 50.0 / (1.0 + math.sin(0.5 * travel)) if travel > math.pi else 30.0
    assert radius == pytest.approx(roomiest, abs=0.5)
    wanted = travel * radius * pin + math.pi * pin**2 / 4
    assert slot.shape.moments.area == pytest.approx(wanted, abs=travel * pin * 1e-3)
    grown = region(slot, 1e-5).buffer(1e-3, quad_segs=8)
    # in the world: the pin at the side where the mate is
    world = radius if wheel == 1 else -radius

    def seat(phi: float) -> shapely.Polygon:
        turn = np.exp(-1j * phi) if wheel == 1 else np.exp(1j * phi)
        spot = world / turn
        return shapely.Point(spot.real, spot.imag).buffer(pin / 2, quad_segs=64)

    for phi in np.linspace(0.0, travel, 33):
        assert grown.contains(seat(float(phi)))
    beyond = math.radians(0.1)
    for phi in (-beyond, travel + beyond):
        assert not grown.contains(seat(phi))


@pytest.mark.slow
@pytest.mark.parametrize("wheel", few([1, 2]))
def test_the_ends_of_a_long_slot_do_not_meet(wheel: int) -> None:
    """On a disc of 100 mm: room to the edge, 50 - r, and to the other end, r*sin(travel/2)."""
    travel = 5.8
    widest = 100.0 * math.sin(0.5 * travel) / (1.0 + math.sin(0.5 * travel))
    place = Workpiece(name=f"wheel {wheel}", wheel=wheel, rim=5.4, travel=travel)
    (slot,) = openings(blank(stop_pin=0.98 * widest), [disc_contour(50.0)], place)
    assert region(slot, 1e-3).is_valid
    with pytest.raises(InfeasibleError, match="no room for the slot"):
        openings(blank(stop_pin=1.001 * widest), [disc_contour(50.0)], place)


def test_chords_of_the_widest_slot_keep_off_the_bore() -> None:
    place, sizes = Workpiece(name="wheel 1", wheel=1, rim=5.4, travel=2.0), {"bore_diameter": 20.0}
    outline = replace(disc_contour(50.0), tolerance=0.02)
    with pytest.raises(InfeasibleError, match="no room for the slot") as caught:
        openings(blank(**sizes, stop_pin=40.0), [outline], place)
    fits = blank(**sizes, stop_pin=float(caught.value.limit or 0.0) - 1e-9)
    bore, slot = openings(fits, [outline], place)
    assert not region(bore, 0.02).intersects(region(slot, 0.02))


@pytest.mark.parametrize("wheel", [1, 2])
def test_the_slot_of_an_open_pair_takes_its_own_travel(wheel: int) -> None:
    job = profile("log_spiral")
    lobes = job.law.lobes
    assert not lobes.closed
    travel = lobes.period if wheel == 1 else float(job.law.phi2(lobes.period))
    contour = (job.gear1, job.gear2)[wheel - 1].profile.contour
    place = Workpiece(name=f"wheel {wheel}", wheel=wheel, rim=5.4, travel=travel)
    (slot,) = openings(blank(stop_pin=2.0), [contour], place)
    angles = np.angle(slot.shape.polyline(1e-4) * (1 if wheel == 1 else -1))
    middle = travel / 2 if wheel == 1 else math.pi - travel / 2
    assert contour.polygon.contains(region(slot, 1e-4))
    inside = np.abs(np.angle(np.exp(1j * (angles * (1 if wheel == 1 else -1) - middle))))
    assert inside.max() > travel / 2


SLOTTED = Workpiece(name="wheel 1", wheel=1, rim=5.4, travel=1.5)

REFUSED: list[tuple[str, dict[str, Any], str, float, float, str]] = [
    ("bolt and outline", {"bolts": 3, "bolt_circle": 80.0}, "bolt_diameter", 19.9, 20.1,
     "bolt hole 1 meets the outline"),
    ("bore and outline", {}, "bore_diameter", 99.9, 100.1, "bore meets the outline"),
    ("bolts", {"bolts": 6, "bolt_circle": 40.0}, "bolt_diameter", 19.95, 20.05,
     "bolt hole 2 meets the bolt hole 1"),
    ("bolt and bore", {"bore_diameter": 20.0, "bolts": 1, "bolt_diameter": 10.0}, "bolt_circle",
     30.1, 29.9, "bolt hole 1 meets the bore"),
    ("bolts that touch", {"bolts": 6, "bolt_circle": 40.0}, "bolt_diameter", 19.95, 20.0,
     "bolt hole 2 meets the bolt hole 1"),
    ("bolt and bore that touch", {"bore_diameter": 20.0, "bolts": 4, "bolt_diameter": 10.0},
     "bolt_circle", 30.1, 30.0, "bolt hole 1 meets the bore"),
    ("bolt within the hub", {"hub_diameter": 40.0, "hub_front": 5.0, "bolts": 3,
     "bolt_diameter": 6.0}, "bolt_circle", 33.9, 34.1, "meets the edge of the hub"),
    ("bolt beside the hub", {"hub_diameter": 40.0, "hub_front": 5.0, "bolts": 3,
     "bolt_diameter": 6.0}, "bolt_circle", 46.1, 45.9, "meets the edge of the hub"),
    ("hub", {"bore_diameter": 10.0, "hub_front": 5.0}, "hub_diameter", 99.9, 100.1,
     "hub reaches the roots"),
    ("pin", {"bore_diameter": 20.0}, "stop_pin", 39.9, 40.1, "no room for the slot"),
    ("pin and hub", {"hub_diameter": 40.0, "hub_front": 5.0}, "stop_pin", 29.9, 30.1,
     "no room for the slot"),
    ("lightening", {"bore_diameter": 20.0, "lightening_holes": 4, "web": 20.0}, "rim", 19.8, 20.1,
     "lightening hole 1 has no room"),
    ("wider bolts", {"bolts": 6, "bolt_circle": 40.0, "bolt_diameter": 19.0,
     "clearance_bores": True}, "clearance", 0.49, 0.51, "meets"),
    ("wider bolts and smaller outline", {"bolts": 3, "bolt_circle": 80.0, "bolt_diameter": 19.0,
     "clearance_bores": True}, "clearance", 0.24, 0.26, "meets the outline"),
    ("bolts and smaller outline", {"bolts": 3, "bolt_circle": 80.0, "bolt_diameter": 19.0},
     "clearance", 0.49, 0.51, "meets the outline"),
    ("wider keyway and hub", {"bore_diameter": 20.0, "keyway_width": 6.0, "keyway_depth": 2.8,
     "hub_diameter": 27.0, "hub_front": 5.0, "clearance_bores": True}, "clearance", 0.1, 0.3,
     "hub"),
    ("wider slot", {"stop_pin": 49.0, "clearance_bores": True}, "clearance", 0.2, 0.36,
     "no room for the slot"),
    ("smaller outline and hub", {"hub_diameter": 99.0, "hub_front": 5.0}, "clearance", 0.4, 0.6,
     "hub"),
]  # fmt: skip


SLOTS = ("pin and hub", "wider slot")


@pytest.mark.parametrize(
    ("sizes", "name", "fits", "fails", "message"),
    [
        pytest.param(*case, id=name, marks=[pytest.mark.slow] * (name in SLOTS))
        for name, *case in REFUSED
    ],
)
def test_what_has_no_room_is_refused_and_what_has_is_made(
    sizes: dict[str, Any], name: str, fits: float, fails: float, message: str
) -> None:
    """Limits on a disc of 100 mm, each from the drawing."""
    contour = disc_contour(50.0)
    part = made(contour, blank(**sizes, **{name: fits}), SLOTTED)
    assert part.region.is_valid
    assert part.steps[0].moments.area == pytest.approx(part.region.area, rel=1e-3)
    with pytest.raises(InfeasibleError, match=message) as caught:
        made(contour, blank(**sizes, **{name: fails}), SLOTTED)
    error = caught.value
    if error.limit is not None and error.value == fails:
        assert min(fits, fails) - 1e-2 <= error.limit <= max(fits, fails) + 1e-2


def test_a_closed_wheel_has_no_stop() -> None:
    with pytest.raises(InfeasibleError, match="turns all around"):
        made(disc_contour(50.0), blank(stop_pin=3.0))


@pytest.mark.parametrize("wall", [1e-3, 0.1])
def test_a_bore_goes_through_its_hub_however_thin(wall: float) -> None:
    reach = 2 * KEYED.bore_reach
    part = made(disc_contour(50.0), replace(KEYED, hub_diameter=reach + wall, hub_front=5.0))
    assert [opening.name for opening in part.bosses[0].openings] == ["bore"]


def test_a_mark_must_lie_on_metal() -> None:
    """Beside a bolt hole, the hub and the outline, each with the size that still fits."""
    sizes = WheelBlank(
        hub_diameter=40.0, hub_front=5.0, bolts=1, bolt_circle=70.0, bolt_diameter=6.0
    )
    for x, y, room in (
        (24.0, 0.0, 2 * (24 - 20)), (48.0, 0.0, 2 * (50 - 48)), (35.0, 5.0, 2 * (5 - 3)),
    ):  # fmt: skip
        center = complex(x, y)
        for diameter, good in ((0.99 * room, True), (1.01 * room, False)):
            mark = Mark(center=center, diameter=diameter, depth=0.5)
            if good:
                assert made(disc_contour(50.0), sizes, marker=lambda m=mark: m).marks == (mark,)
                continue
            with pytest.raises(InfeasibleError, match="timing mark meets") as caught:
                made(disc_contour(50.0), sizes, marker=lambda m=mark: m)
            assert caught.value.limit == pytest.approx(room, abs=5e-3)
    for bad in ((0.0, 0.0), (60.0, 0.0), (35.0, 0.0)):
        mark = Mark(center=complex(*bad), diameter=0.1, depth=0.5)
        with pytest.raises(InfeasibleError, match="timing mark meets"):
            made(disc_contour(50.0), sizes, marker=lambda m=mark: m)


def test_a_mark_that_is_asked_for_takes_a_third_of_the_rim() -> None:
    """Pitch radius 100, root 6.25 below, bore reach 81.75: a rim of 12."""
    given = {"module": 5.0, "dedendum_mm": 6.25, "width": 10.0, "bore_reach": 81.75}
    assert timing_mark(100.0, 0.0, diameter=3.999, **given).diameter == 3.999
    with pytest.raises(InfeasibleError, match="timing mark is too large") as caught:
        timing_mark(100.0, 0.0, diameter=4.001, **given)
    assert caught.value.limit == pytest.approx(4.0)
    assert timing_mark(100.0, 0.0, 5.0, 6.25, 10.0, bore_reach=93.74).diameter > 0
    with pytest.raises(InfeasibleError, match="no room for a timing mark"):
        timing_mark(100.0, 0.0, 5.0, 6.25, 10.0, bore_reach=93.76)


def round_holes(random: np.random.Generator) -> WheelBlank:
    """Bore, bolts and hub, with room or without."""
    hub = random.random() < 0.5
    return blank(
        bore_diameter=float(random.choice([0.0, 5.0, 20.0, 30.0])),
        bolts=int(random.integers(0, 14)),
        bolt_circle=round(random.uniform(15.0, 150.0), 1),
        bolt_diameter=round(random.uniform(2.0, 15.0), 1),
        **({"hub_diameter": round(random.uniform(20.0, 60.0), 1), "hub_front": 5.0} if hub else {}),
    )


def outcome(contours: Any, sizes: WheelBlank, inner: Any = ()) -> Any:
    try:
        found = openings(sizes, contours, PLACE, inner)
    except InfeasibleError as error:
        return str(error)
    return [(one.name, one.shape.moments) for one in found]


def test_round_openings_are_judged_as_by_their_regions(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(12)
    disc = disc_contour(50.0)
    stocks: list[Any] = [
        ([gear_contour()], ()),
        ([gear_contour(), disc], ()),
        ([Circle(center=0j, diameter=120.0)], [disc_contour(20.0)]),
    ]
    jobs = [(*stocks[k % 3], round_holes(random)) for k in range(300)]
    plain = [outcome(contours, sizes, inner) for contours, inner, sizes in jobs]
    monkeypatch.setattr("gearcam.parts.openings._plainly_apart", lambda *_: False)
    assert plain == [outcome(contours, sizes, inner) for contours, inner, sizes in jobs]
    refused = [one for one in plain if isinstance(one, str)]
    assert 50 < len(refused) < 250
    for what in ("outline", "edge of the hub", "bore", "bolt hole 1"):
        assert any(f"meets the {what}" in one for one in refused)


def test_rooms_in_stock_are_those_of_its_region() -> None:
    random = np.random.default_rng(13)
    shifted = replace(disc_contour(45.0), points=disc_contour(45.0).points + 6.0)
    hole = [disc_contour(20.0)]
    for stock in (
        Stock(contours=[gear_contour(), shifted], work=PLACE),
        Stock(contours=[Circle(center=0j, diameter=120.0)], work=PLACE, inner=hole),
    ):
        inside = 0
        for x, y in random.uniform(-70.0, 70.0, (300, 2)):
            place = shapely.Point(x, y)
            within = stock.region.contains(place)
            wanted = stock.region.boundary.distance(place) if within else 0.0
            assert stock.room(complex(x, y)) == pytest.approx(wanted, abs=1e-9)
            inside += within
        assert 60 < inside < 240
