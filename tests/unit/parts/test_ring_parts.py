"""The ring of an internal pair as a part: its outside, bolts, marks, checks and facts."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.gears.spec import Rack, RingSpec, StepsSpec
from gearcam.kinds.gear_pair.design import PairOutputSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.formula import Formula
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import Blank
from gearcam.parts.shapes import Circle
from helpers_pairs import job
from helpers_rings import UNEVEN, WAIST, centrode, plain, ring_design, ring_job
from helpers_sampling import chosen, few

FOLLOW = RingSpec(outer="follow", rim=6.0)


def bolted(count: int, circle: float, diameter: float, **rest: Any) -> Blank:
    turn = (0.0, math.pi / count)  # clear of the mark
    sizes = {"bolt_circle": (0.0, circle), "bolt_diameter": (0.0, diameter), "bolt_angle": turn}
    return Blank(bolts=(0, count), **sizes | rest)


def codes(made: GearPairResult) -> set[str]:
    return {finding.code for finding in made.findings}


def root(made: GearPairResult) -> float:
    return float(np.hypot(*made.gear2.outline.T).max())


def test_a_ring_is_what_lies_between_its_roots_and_a_circle() -> None:
    """Circles: roots at r2 + 1.25 modules, a rim of 2.7 modules outside them."""
    made = ring_job(Constant(), {"teeth": (30, 60)})
    ring = made.parts[1]
    (outside,) = ring.contours
    assert isinstance(outside, Circle)
    assert 0.5 * outside.diameter == pytest.approx(60.0 + 2.5 + 5.4, abs=1e-3)
    assert ring.contour is ring.inner[0] is made.gear2.profile.contour
    circle = outside.moments.area
    assert ring.steps[0].moments.area == pytest.approx(circle - ring.contour.moments.area)
    assert (ring.hub, ring.openings) == (None, ())
    picture = ring.picture()
    assert picture.count("Z") == 3, "outside, teeth, mark"


@pytest.mark.slow
@pytest.mark.parametrize("law", chosen({"uneven": UNEVEN, "waist": WAIST}, "waist"))
def test_an_outside_that_follows_is_a_true_parallel(law: Any) -> None:
    """Steiner: a parallel at d of a smooth closed curve has the area A + L*d + pi*d^2."""
    made = ring_job(law, ring=FOLLOW, output=PairOutputSpec(chord_tolerance=1e-4))
    (outside,) = made.parts[1].contours
    assert isinstance(outside, Contour)
    away = 2.5 + 6.0
    dense = centrode(made, 200001)
    area = shapely.Polygon(dense).area
    length = math.pi * 2.0 * 48
    assert outside.moments.area == pytest.approx(area + length * away + math.pi * away**2, rel=1e-8)
    assert len(outside.runs) == 1, "no corners"
    chords: Any = shapely.linestrings(np.stack([dense, np.roll(dense, -1, 0)], axis=1))
    curve = shapely.STRtree(chords)
    for points in (outside.vertices, as_pairs(outside.runs[0].points)):
        some = shapely.points(points[:: len(points) // 500])
        distance = curve.query_nearest(some, return_distance=True)[1]
        assert distance == pytest.approx(np.full(len(distance), away), abs=1e-6)
    hole = shapely.LinearRing(made.gear2.outline)
    least = hole.distance(shapely.LinearRing(outside.vertices))
    assert least == pytest.approx(6.0, abs=3e-4)


def test_the_steps_of_a_ring_share_their_outside() -> None:
    made = ring_job(ring=FOLLOW, steps=StepsSpec(count=3))
    part = made.parts[1]
    assert [len(part.contours), len(part.inner)] == [3, 3]
    assert len({id(edge) for edge in part.contours}) == 1
    outer = shapely.Polygon(as_pairs(part.contours[0].polyline(1e-3)))
    for gears in made.steps:
        hole = shapely.Polygon(gears[1].outline)
        assert outer.contains(hole)
        assert outer.boundary.distance(hole.boundary) >= 6.0 - 3e-3
    # the first step has no space where the ring is widest
    wide = ring_job(replace(UNEVEN, ratios=(0.4, 0.6, 0.4)), steps=StepsSpec(count=3, offset=-0.5))
    (outside, *_) = wide.parts[1].contours
    assert isinstance(outside, Circle)
    reach = [np.hypot(*gears[1].outline.T).max() for gears in wide.steps]
    assert reach[0] < max(reach)
    assert 0.5 * outside.diameter == pytest.approx(max(reach) + 5.4, rel=1e-12)


@pytest.mark.parametrize("ring", [RingSpec(), FOLLOW, RingSpec(outer_diameter=140.0)])
@pytest.mark.parametrize("blank", [Blank(), Blank(clearance=(0.1, 0.2), mark_diameter=0.5)])
def test_marks_face_each_other_across_the_mesh(ring: RingSpec, blank: Blank) -> None:
    """On the line of centres: the wheel's inside its root, the ring's outside its own."""
    made = ring_job(ring=ring, blank=blank)
    one, two = (part.marks[0] for part in made.parts)
    pitch_point = float(np.abs(made.gear1.toothing.frames(np.zeros(1)).p[0]))
    places = [one.center.real, two.center.real - made.pair.center_distance]
    assert [one.center.imag, two.center.imag] == [0.0, 0.0]
    assert places[0] < pitch_point < places[1]
    sides = zip(made.gears, (one, two), blank.clearance, (-1.0, 1.0), strict=True)
    for gear, mark, clear, side in sides:
        edge = shapely.Polygon(gear.outline)
        assert edge.contains(shapely.Point(mark.center.real, mark.center.imag)) == (gear.wheel == 1)
        centrode_there = abs(complex(*gear.centrode(np.zeros(1))[0]))
        # the root is a dedendum below the centrode, and the mark 0.2 modules below the root
        away = 2.5 + clear + 0.4 + 0.5 * mark.diameter
        assert mark.center.real == pytest.approx(centrode_there + side * away, abs=1e-9)
    region = made.parts[1].region
    assert region.contains(
        shapely.Point(two.center.real, two.center.imag).buffer(0.5 * two.diameter)
    )


SHAFT: dict[str, tuple[Any, Any]] = {
    "bore_diameter_mm": (10, 12), "keyway_width_mm": (3, 4), "keyway_depth_mm": (1.5, 2),
    "bore_flat_mm": (8, 9), "hub_diameter_mm": (16, 20), "hub_front_mm": (5, 6),
    "hub_back_mm": (5, 6), "lightening_holes": (4, 4), "stop_pin_mm": (2, 2),
}  # fmt: skip


@pytest.mark.parametrize("key", SHAFT)
def test_a_ring_has_nothing_of_a_shaft(key: str) -> None:
    blank = {"bore_diameter_mm": [10, 0], "hub_diameter_mm": [16, 0], "hub_back_mm": [5, 0]}
    blank |= {key: list(SHAFT[key])}
    document = ring_design().to_dict() | {"blank": blank}
    with pytest.raises(DesignError) as refused:
        gearcam.design(document)
    problems = {problem.key: problem for problem in refused.value.problems}
    told = problems[f"blank.{key}[1]"]
    assert "wheel 2 is a ring" in told.message
    assert "[ring]" in told.allowed
    assert told.value == SHAFT[key][1]


def test_one_value_for_both_wheels_asks_it_of_the_ring_too() -> None:
    """What serves a bore or a hub may be given once: it is made where these are."""
    sizes: dict[str, Any] = {"bore_diameter_mm": 10, "hub_diameter_mm": 16, "lightening_holes": 3}
    rest = {"hub_front_mm": 5, "keyway_width_mm": 3, "keyway_depth_mm": 1.5, "rim_mm": 5}
    document = ring_design(pair={"teeth": (40, 80)}).to_dict() | {"blank": sizes | rest}
    with pytest.raises(DesignError) as refused:
        gearcam.design(document)
    told = {problem.key: problem for problem in refused.value.problems}
    assert {*told} == {f"blank.{key}" for key in sizes}
    for key, value in sizes.items():
        assert "wheel 2 is a ring" in told[f"blank.{key}"].message
        assert f"[{value}, 0]" in told[f"blank.{key}"].allowed
    document["blank"] = {key: [value, 0] for key, value in sizes.items()} | rest
    design: Any = gearcam.design(document)
    assert gearcam.design(design.to_dict()) == design
    one, two = gearcam.build(design).parts
    assert [len(one.openings), len(two.openings)] == [4, 0]
    assert (one.hub is None, two.hub) == (False, None)


def nearest(refused: InfeasibleError, made: Any, way: int = 0) -> GearPairResult:
    """Follow the way that a refusal names."""
    return gearcam.build(made.with_(dict(refused.adjustments[way].near)))


def test_an_outside_that_reaches_the_roots_is_refused() -> None:
    roots = root(plain())
    design = ring_design(ring=RingSpec(outer_diameter=2.0 * roots - 0.01))
    with pytest.raises(InfeasibleError, match=r"ring\.outer_diameter_mm") as refused:
        _ = gearcam.build(design).gear2
    assert refused.value.limit == pytest.approx(2.0 * roots, rel=1e-12)
    made = nearest(refused.value, design)
    assert "thin-rim" not in codes(made)
    assert made.facts.document["mesh"]["rim_min_mm"] == pytest.approx(5.4, rel=1e-12)
    just = ring_job(
        ring=RingSpec(outer_diameter=2.0 * roots + 0.01), blank=Blank(timing_marks=False)
    )
    assert "thin-rim" in codes(just)
    assert just.parts[1].region.is_valid


def test_a_hollow_too_tight_for_the_outside_is_refused() -> None:
    """At a distance above the hollow's radius a parallel has corners."""
    tight = plain(WAIST).gear2.toothing.track.convex.radius - 2.5
    design = ring_design(WAIST, ring=replace(FOLLOW, rim=1.0001 * tight))
    with pytest.raises(InfeasibleError, match="follow its roots") as refused:
        _ = gearcam.build(design).parts
    assert refused.value.limit == pytest.approx(tight, rel=1e-12)
    (edge,) = nearest(refused.value, design).parts[1].contours
    assert isinstance(edge, Contour)
    (edge,) = nearest(refused.value, design, 1).parts[1].contours
    assert isinstance(edge, Circle)
    tables = replace(design, output=replace(design.output, files=("csv",)))
    with pytest.raises(InfeasibleError, match="follow its roots"):
        _ = gearcam.build(tables).findings


def test_bolts_lie_in_the_rim() -> None:
    """Between roots and outside of circles: 62.5 and 67.9 mm with 1 mm walls."""
    made = ring_job(Constant(), {"teeth": (30, 60)}, blank=bolted(4, 130.4, 3.3))
    assert [one.name for one in made.parts[1].openings] == [f"bolt hole {k}" for k in (1, 2, 3, 4)]
    assert "thin-wall" not in codes(made)
    # a root of the ring lies in the direction of 42 degrees
    for circle, what, wall in ((131.4, "outline", 67.9 - 65.7), (130.0, "roots", 65.0 - 62.5)):
        blank = bolted(1, circle, 3.3, bolt_angle=(0.0, math.radians(42.0)))
        other = ring_job(Constant(), {"teeth": (30, 60)}, blank=blank)
        (found,) = [one for one in other.findings if one.code == "thin-wall"]
        assert what in found.message
        assert found.value == pytest.approx(wall - 0.5 * 3.3, abs=1e-3)


@pytest.mark.parametrize(
    ("circle", "diameter"), few([(130.4, 5.6), (133.0, 3.0), (100.0, 3.0), (160.0, 3.0)])
)
@pytest.mark.parametrize("wall", few([1.0, 0.5]))
def test_bolts_outside_the_rim_are_refused(circle: float, diameter: float, wall: float) -> None:
    design = ring_design(
        Constant(),
        {"teeth": (30, 60)},
        blank=bolted(4, circle, diameter, clearance=(0.0, 0.05), clearance_bores=True),
        limits={"wall": wall},
    )
    with pytest.raises(InfeasibleError, match="rim of the ring") as refused:
        _ = gearcam.build(design).parts
    for number in range(len(refused.value.adjustments) - 1):
        made = nearest(refused.value, design, number)
        assert len(made.parts[1].openings) == 4
        assert "thin-wall" not in codes(made)
    if circle == 130.4:
        # the hole is wider by twice the clearance
        outline = gearcam.build(design).gear2.outline
        roots, outside = shapely.LinearRing(outline), np.hypot(*outline.T).max() + 5.4
        turns: Any = np.exp(1j * (math.pi / 4 + 0.5 * math.pi * np.arange(4)))
        away = shapely.distance(roots, shapely.points(65.2 * turns.real, 65.2 * turns.imag))
        limit = 2.0 * (min(away.min(), outside - 65.2) - wall) - 0.1
        assert refused.value.limit == pytest.approx(limit, abs=5e-3)
        assert f"walls of {wall:g} mm" in str(refused.value)


def test_a_bolt_hole_at_the_mark_is_turned_away() -> None:
    design = ring_design(
        Constant(), {"teeth": (30, 60)}, blank=bolted(4, 130.4, 3.3, bolt_angle=(0.0, 0.0))
    )
    with pytest.raises(InfeasibleError, match="timing mark meets") as refused:
        _ = gearcam.build(design).parts
    made = nearest(refused.value, design)
    assert made.design.blank.bolt_angle == pytest.approx((0.0, math.pi / 4))
    assert len(made.parts[1].openings) == 4


def test_no_room_for_bolts_names_the_ring() -> None:
    with pytest.raises(InfeasibleError, match=r"larger rim in \[ring\]"):
        _ = ring_job(Constant(), blank=bolted(4, 104.0, 3.0), ring=RingSpec(rim=1.5)).parts


def test_a_thin_rim_of_a_ring_is_found_and_cured() -> None:
    thin = ring_job(ring=RingSpec(rim=5.39), blank=Blank(bore_diameter=(6.0, 0.0)))
    (found,) = [one for one in thin.findings if one.code == "thin-rim"]
    assert found.where == "wheel 2"
    assert found.value == pytest.approx(5.39 / 2.0, rel=1e-12)
    assert "ring.rim_mm = 5.4 keeps the limit" in found.message
    assert "thin-rim" not in codes(ring_job(ring=RingSpec(rim=5.4)))
    assert thin.facts.document["mesh"]["rim_min_mm"] == 5.39


def test_a_thin_rim_is_told_by_the_key_that_is_given() -> None:
    """A ring has a rim or a diameter: the other key would be refused beside it."""
    least = 2.0 * ring_job(ring=RingSpec(rim=5.4)).gear2.largest_radius + 2.0 * 5.4
    thin = ring_job(ring=RingSpec(outer_diameter=least - 0.1))
    (found,) = [one for one in thin.findings if one.code == "thin-rim"]
    across = float(found.message.split("ring.outer_diameter_mm = ")[1].split()[0])
    assert "rim_mm" not in found.message
    assert across == pytest.approx(least, rel=1e-9)
    assert "thin-rim" not in codes(ring_job(ring=RingSpec(outer_diameter=across)))


def test_the_cutter_of_a_ring_is_noted_where_it_is_small() -> None:
    for teeth, expected in ((11.99, True), (12.0, False)):
        made = ring_job(ring=RingSpec(cutter_teeth=teeth))
        assert ("small-cutter" in codes(made)) == expected
        assert not codes(made) & {"concave", "concave-teeth"}
        assert made.facts.document["gears"][1]["cutter_teeth"] == pytest.approx(teeth, rel=1e-14)


def test_a_small_cutter_of_a_wheel_is_no_cutter_of_a_ring() -> None:
    law = Formula(r1="1 + 0.25*cos(2*phi1)")
    found = codes(job(law, (40, 40), limits={"cutter_teeth": 90.0}))
    assert "concave-teeth" in found
    assert "small-cutter" not in found


def test_the_largest_tool_of_a_ring_is_that_of_its_hole() -> None:
    """A disc that is rolled inside the hole reaches all of it up to that size, no larger one."""
    made = ring_job(WAIST, output=PairOutputSpec(chord_tolerance=2e-4))
    limits = made.parts_subject.tools[1]
    hole = shapely.Polygon(made.gear2.outline)

    def left(diameter: float) -> float:
        inner = hole.buffer(-0.5 * diameter, quad_segs=64)
        return hole.difference(inner.buffer(0.5 * diameter + 2e-3, quad_segs=64)).area

    assert left(0.98 * limits.diameter) < 1e-9
    assert left(1.05 * limits.diameter) > 1e-4


def test_a_kerf_that_does_not_fit_into_the_spaces_of_a_ring_is_found() -> None:
    limits = plain().parts_subject.tools[1]
    for factor, expected in ((0.99, False), (1.01, True)):
        made = ring_job(
            blank=Blank(timing_marks=False), output=PairOutputSpec(kerf=factor * limits.diameter)
        )
        where = {one.where for one in made.findings if one.code == "wide-kerf"}
        assert ("wheel 2" in where) == expected


def test_what_is_told_of_a_ring() -> None:
    made = plain(WAIST)
    document = made.facts.document
    assert document["pair"]["type"] == "internal"
    one, two = document["gears"]
    assert "internal" not in one
    assert two["internal"] is True
    assert "root_radius_min_mm" not in two
    assert two["root_radius_max_mm"] == pytest.approx(root(made), rel=1e-12)
    assert one["root_radius_min_mm"] < 40.0
    kc = max(1.15 * two["centrode"]["max_concave_curvature_per_mm"], 0.0)
    assert two["cutter_teeth"] <= 2.0 / (kc * 2.0) * (1.0 + 1e-12)
    assert two["outline"]["area_mm2"] == pytest.approx(shapely.Polygon(made.gear2.outline).area)
    assert document["mesh"]["rim_min_mm"] == pytest.approx(5.4)
    picture = made.gear2.picture()
    assert picture.count("Z") == 2, "the edge of the hole, and of what is shown around it"
    assert plain(Constant()).gear1.picture().count("Z") == 1


def test_a_ring_takes_another_pinion_where_the_usual_ones_teeth_are_pointed() -> None:
    """By rule as many teeth as the mate; where these are too deep 1/1.15 of the ring's."""
    deep = Rack(addendum=1.25, dedendum=1.6, tip_radius=0.1)
    for counts, rack, teeth in (((28, 48), Rack(), 28.0), ((20, 40), deep, 40 / 1.15)):
        made = job(Constant(), counts, module=2.0, rack=rack, internal=True)
        cutter = made.pair.toothings[1].cutter
        assert cutter.fits
        assert cutter.teeth == pytest.approx(teeth, rel=1e-12)
