"""Open pairs and racks: printed and closed-form numbers, ends, mates, and what touches at them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import shapely

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.gears.spec import RingSpec
from gearcam.laws.ratio.centrodes import LogSpiral
from gearcam.laws.ratio.composite import Multispeed
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import ONE_LOBE, Travel
from gearcam.laws.ratio.table import TableLaw
from helpers_pairs import job, profile

SPIRAL = LogSpiral(ratios=(0.5, 2.0), driven_travel=math.radians(200))


def door(second: float) -> Phases:
    """003 section 3.2.2.2 with phi_u = 10 deg."""
    return Phases(
        knots=(0.0, math.radians(10), math.radians(second), "solve"),
        ratios=(1.0, 1.0, 2.0, 2.0),
        driven_travel=math.radians(308.3),
    )


@pytest.mark.parametrize(
    ("second", "travel", "length"),
    [(60.0, 171.65, 1.935834337285), (90.0, 179.15, 1.972103175704)],
)
def test_the_furnace_door_has_the_printed_lengths(
    second: float, travel: float, length: float
) -> None:
    """And the driven wheel's smallest radius, at phi_u: kappa = (2 + (pi/(phi_v - phi_u))^2/2)/A"""
    made = job(door(second), (29, 29), module=5.0)
    assert isinstance(made.law.lobes, Travel)
    assert math.degrees(made.law.lobes.period) == pytest.approx(travel, abs=1e-11)
    assert {*made.facts["pair.solved"]} == {"knots_deg[3]", "center_distance_mm"}
    assert made.law.phi2(made.law.lobes.period) == pytest.approx(math.radians(308.3), abs=1e-14)
    unit = made.pair.rolling.tracks[0].length / made.pair.center_distance
    assert unit == pytest.approx(length, abs=1e-12)
    bend = 2 + 0.5 * (math.pi / math.radians(second - 10)) ** 2
    assert made.gear2.toothing.track.convex.radius == pytest.approx(
        made.pair.center_distance / bend, rel=1e-12
    )


TRAVELS = {
    "formula": (
        Formula(phi2="1.8*phi1 + 0.03*sin(phi1)", driver_travel=2.4),
        1.8 * 2.4 + 0.03 * math.sin(2.4),
    ),
    "phases": (
        Phases(knots=(0.0, 1.5, 3.5), ratios=(0.8, 1.2, 1.0), driven_travel="solve"),
        1.5 * 1.0 + 2.0 * 1.1,
    ),
    "multispeed": (
        Multispeed(ratios=(0.8, 1.2), angles=(1.0, 1.0), transition=1.5, driven_travel="solve"),
        0.8 + 1.5 * 1.0 + 1.2,
    ),
    "table": (
        TableLaw(
            phi1=tuple(0.5 * k for k in range(7)),
            phi2=tuple(0.5 * k + 0.01 * k * k for k in range(7)),
            driven_travel="solve",
        ),
        3.36,
    ),
}
"""Laws that give the travel of the driven wheel themselves, rad."""


@pytest.mark.parametrize("name", TRAVELS)
def test_the_travel_that_a_law_gives(name: str) -> None:
    """Solved, rounded to what is shown, or refused with the value that is accepted as printed."""
    law, travel = TRAVELS[name]
    solved = job(law, (24, 24), module=1.0)
    assert solved.law.advance == pytest.approx(travel, rel=1e-14)
    assert solved.law.closure_error == pytest.approx(0.0, abs=1e-13)
    degrees = math.degrees(travel)
    assert solved.facts["pair.solved.driven_travel_deg"] == pytest.approx(degrees, rel=1e-13)
    near = math.radians(float(f"{degrees:.6g}"))
    rounded = job(replace(law, driven_travel=near), (24, 24), module=1.0)
    assert rounded.law.advance == solved.law.advance
    assert not [one for one in rounded.checked if one.code == "closure"]
    with pytest.raises(InfeasibleError, match="driven wheel's travel") as caught:
        _ = job(replace(law, driven_travel=travel * (1.0 + 1e-5)), (24, 24), module=1.0).law
    told = caught.value.adjustments[-1].near["law.driven_travel_deg"]
    again = replace(law, driven_travel=math.radians(float(f"{told:.10g}")))
    assert job(again, (24, 24), module=1.0).law.advance == solved.law.advance


@pytest.mark.parametrize("key", ["ratio", "r1"])
def test_a_law_at_any_scale_does_not_give_a_travel(key: str) -> None:
    law = Formula(**{key: "1 + 0.1*phi1"}, driver_travel=2.0, driven_travel="solve")
    with pytest.raises(InfeasibleError, match="does not give the driven wheel's travel"):
        _ = job(law, (24, 24), module=1.0).law


def test_a_spiral_goes_on_as_a_spiral_beyond_its_ends() -> None:
    made = job(SPIRAL, (24, 24), module=2.0)
    way, growth = made.law.lobes.period, made.law.solved["growth_per_rad"]
    for phi in (-0.2, 0.5 * way, way + 0.2):
        r1 = float(abs(made.pair.rolling.tracks[0].frames(np.array([phi])).p[0]))
        assert r1 == pytest.approx(
            made.pair.center_distance / 3 * math.exp(growth * phi), rel=1e-13
        )


@pytest.mark.parametrize("slope", [0.0, 1.0])
def test_the_continued_law_has_no_corner(slope: float) -> None:
    """From a constant ratio by a circle, from a slope by a spiral: C1 at both ends."""
    shape = "sine" if slope else "cosine"
    law = Phases(
        shape=shape, knots=(0.0, 1.0, "solve"), ratios=(1.0, 2.0, 2.0), driven_travel=4.0
    ).build(ONE_LOBE, DEFAULT)
    for end in (0.0, law.lobes.period):
        inside, outside = (law.derivatives(np.array([end + h]), 2)[1:] for h in (1e-9, -1e-9))
        assert inside[0] == pytest.approx(outside[0], abs=1e-8)
        assert inside[1] == pytest.approx(outside[1], abs=1e-7)


def whole_teeth(points: np.ndarray, centrode: np.ndarray) -> int:
    """Teeth that stand out of the centrode: pieces of the outline beyond it."""
    body = shapely.Polygon(points)
    apart = shapely.difference(body, shapely.LineString(centrode).buffer(1e-3, cap_style="flat"))
    return len(shapely.get_parts(apart)) - 1


def test_a_blank_ends_half_a_pitch_beyond_its_centrode() -> None:
    """The driver has one tooth more than pitches, the driven wheel a half at each end."""
    made = profile("furnace_door")
    for gear, count in ((made.gear1, 30), (made.gear2, 31)):
        way = made.law.lobes.period
        places = np.array([-0.5, gear.toothing.teeth + 0.5]) * gear.toothing.pitch
        start, end = made.pair.rolling.arc.angle(places).tolist()
        assert start < 0.0 < way < end
        assert whole_teeth(gear.outline, gear.centrode(np.linspace(start, end, 4001))) == count


@pytest.mark.parametrize("name", ["furnace_door", "log_spiral", "furnace_door_two_phase"])
def test_an_open_pair_drives_from_end_to_end(name: str) -> None:
    made = profile(name)
    length = made.pair.rolling.tracks[0].length
    for side in (DRIVE, COAST):
        pairs = flank_pairs(made.gears, side)
        arcs = pairs.arcs
        assert arcs.stretches[2].min() >= 1
        start, end = map(made.pair.rolling.tracks[0].arc_length, (arcs.start, arcs.end))
        carried = arcs.ratios > 0.0
        assert start[carried].min() < 0.0
        assert end[carried].max() > length


def test_a_missing_end_tooth_would_be_seen() -> None:
    """Without the last flanks the coverage has a hole at the end."""
    made = profile("furnace_door")
    arcs = flank_pairs(made.gears, COAST).arcs
    fewer = replace(arcs, start=arcs.start[:-3], end=arcs.end[:-3])
    start, end, carrying = fewer.stretches
    assert np.flatnonzero(carrying == 0).tolist() == [len(carrying) - 1]
    assert end[-1] == pytest.approx(made.law.lobes.period, abs=1e-12)
    assert start[-1] == pytest.approx(float(fewer.end.max()), abs=1e-12)


def test_ends_that_meet_are_refused_with_the_way_that_does() -> None:
    with pytest.raises(InfeasibleError, match="meet behind its shaft") as caught:
        _ = job(LogSpiral(ratios=(0.2, 0.5), driven_travel=math.radians(200)), (20, 20)).gears
    error = caught.value
    assert error.value is not None
    assert error.limit is not None
    # way and travel are in proportion on spirals; the end teeth stay as they are
    for share, works in ((0.99, True), (1.02, False)):
        travel = math.radians(200) * error.limit / error.value * share
        made = job(LogSpiral(ratios=(0.2, 0.5), driven_travel=travel), (20, 20))
        if works:
            assert shapely.Polygon(made.gear1.outline).is_valid
        else:
            with pytest.raises(InfeasibleError):
                _ = made.gears


SECTOR = Formula(
    ratio="1 + 0.3*cos(phi1) + 0.2*sin(phi1)",
    driver_travel=math.radians(200),
    driven_travel=math.radians(110),
)


@pytest.mark.parametrize(
    ("ring", "rim"),
    [(RingSpec(), 5.4), (RingSpec(rim=7.0), 7.0), (RingSpec(outer_diameter=240.0), None)],
)
def test_the_body_of_a_ring_s_sector_lies_outside_its_teeth(
    ring: RingSpec, rim: float | None
) -> None:
    """Counter-clockwise around the metal: teeth, then an arc about the shaft on the outside."""
    made = job(SECTOR, (24, 24), module=2.0, internal=True, ring=ring)
    gear, points = made.gear2, made.gear2.outline @ [1, 1j]
    assert shapely.LinearRing(gear.outline).is_ccw
    # half a pitch inside and outside the pitch curve, in the middle of a tooth and of a space
    toothing = gear.toothing
    for place, solid in ((9.5, (True, True)), (10.0, (False, False))):
        frames = toothing.frames(toothing.track.angle(place * toothing.pitch))
        normal = toothing.turn * frames.t  # to the tips: to the shaft
        assert np.real(frames.p * np.conj(normal)) < 0.0
        for height, metal in zip((-1.0, 1.0), solid, strict=True):
            x, y = np.stack([(frames.p + height * normal).real, (frames.p + height * normal).imag])
            assert shapely.contains_xy(shapely.Polygon(gear.outline), x, y) == metal
    toothed = gear.profile.toothed
    outside = 120.0 if rim is None else np.abs(toothed).max() + rim
    assert np.abs(points).max() == pytest.approx(outside, rel=1e-12)
    arc = points[np.abs(np.abs(points) - outside) < 1e-9]
    assert len(arc) > 20
    # it spans the angle of the end faces
    ends = toothing.frames(toothing.track.angle(toothing.ends))
    faces = ends.p - (toothing.cutter.dedendum + 2.0) * toothing.turn * ends.t
    assert np.angle(arc[-1] / arc[0]) == pytest.approx(np.angle(faces[1] / faces[0]), abs=1e-9)
    assert made.gear1.least_radius < np.abs(toothed).min()  # wheel 1 keeps its hub


@pytest.mark.parametrize(
    ("key", "spec", "value"),
    [
        ("ring.rim_mm", lambda rim: RingSpec(rim=rim), 1.5),
        ("ring.outer_diameter_mm", lambda size: RingSpec(outer_diameter=size), 180.0),
    ],
)
def test_an_outside_within_the_end_faces_is_refused_with_one_that_does(
    key: str, spec: Callable[[float], RingSpec], value: float
) -> None:
    def sector(given: float) -> np.ndarray:
        made = job(SECTOR, (24, 24), module=2.0, internal=True, ring=spec(given))
        return made.gear2.outline

    with pytest.raises(InfeasibleError, match="end faces") as caught:
        sector(value)
    (way,), limit = caught.value.adjustments, caught.value.limit
    assert limit is not None
    named = way.near[key]
    assert isinstance(named, float)
    assert shapely.Polygon(sector(named)).is_valid
    assert limit < named < 1.01 * limit
    with pytest.raises(InfeasibleError, match="end faces"):
        sector(0.999 * limit)


def test_the_outside_of_an_open_ring_is_round() -> None:
    with pytest.raises(InfeasibleError, match="roots of a closed ring only"):
        _ = job(
            SECTOR, (24, 24), module=2.0, internal=True, ring=RingSpec(outer="follow")
        ).gear2.outline


def test_a_ring_s_sector_that_meets_itself_is_refused() -> None:
    law = Formula(ratio="1", driver_travel=math.radians(359), driven_travel=math.radians(357))
    with pytest.raises(InfeasibleError, match="ends of the dr") as caught:
        _ = job(law, (300, 300), module=1.0, internal=True).gears
    assert caught.value.limit == pytest.approx(353.0, abs=3.0)


def test_a_circular_wheel_drives_a_straight_rack() -> None:
    """The limit: flanks are straight lines at 20 degrees, one pitch apart."""
    made = job(RackLaw(r1="1"), (20, 9), module=2.0, tolerance=1e-5)
    assert made.pair.rolling.tracks[0].length == pytest.approx(40 * math.pi, abs=1e-12)
    toothing, flanks = made.gear2.toothing, made.gear2.profile.flanks
    for sigma in (1.0, -1.0):
        sf = flanks.sf[flanks.sigma == sigma][4:5]
        phi = made.pair.rolling.arc.angle(sf + np.linspace(-3.0, 3.0, 7))
        points = toothing.flank_points(toothing.frames(phi), sf, np.array([sigma]))
        assert np.angle(np.diff(points)) % math.pi == pytest.approx(
            (sigma * math.radians(20)) % math.pi, abs=1e-9
        )
    assert made.gear2.toothing.pitch == pytest.approx(2 * math.pi)


def test_a_rack_moves_by_the_integral_of_the_radius() -> None:
    made = job(RackLaw(travel="3*phi1 - 0.5*sin(2*phi1)"), (40, 60), module=2.0)
    scale = made.pair.center_distance
    phi = np.linspace(0.0, 9.0, 7)
    frames = made.pair.rolling.tracks[1].frames(phi)
    np.testing.assert_allclose(frames.p.imag, scale * (3 * phi - 0.5 * np.sin(2 * phi)), rtol=1e-13)
    np.testing.assert_allclose(frames.p.real, scale * (3 - np.cos(2 * phi)), rtol=1e-13)
    np.testing.assert_allclose(frames.s, made.pair.rolling.tracks[0].frames(phi).s, rtol=1e-14)


def test_a_centre_distance_of_a_rack_is_refused() -> None:
    with pytest.raises(InfeasibleError, match="module_mm"):
        _ = job(RackLaw(r1="1"), (20, 9), distance=40.0).gears
