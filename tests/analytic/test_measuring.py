"""Measures over pins, chords and spans against values of 25 digits and against finished outlines.

The second method knows no involutes: discs and jaws are laid against the outline's vertices.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam import laws
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.gears.measuring import Measuring
from gearcam.gears.pair import Gear
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.numeric.arrays import as_complex
from gearcam.parts.blank import Blank
from helpers_built import built
from helpers_gauges import jaw_misfits, misfits
from helpers_pairs import job, profile

EXACT = 1e-9

ROUND = [
    # z, m, x, pin, k: M, R, r_c, s, h, s_c, h_c, W, r_W
    (20, 2, 0, 3.5, 3, 44.9292900174, 20.7146450087, 20.0416888198, 3.13836382911, 2.06165332534,
     2.77409612421, 1.49515579190, 15.3208787520, 20.2951033517),
    (25, 2, 0.3, 3.5, 4, 55.8159675174, 26.2097026198, 25.4820663822, 3.57530307912, 2.66399586997,
     3.15976869001, 2.02496912483, 21.7756211875, 25.8927269324),
    (41, 1, -0.2, 1.75, 5, 43.1071690848, 20.6937700230, 20.3904164266, 1.42492122789,
     0.812384231600, 1.25849054017, 0.570973451638, 13.7220105171, 20.4490459868),
    (12, 3, 0.6, 5.5, 2, 46.4189281332, 20.4594640666, 19.0484826768, 5.99462711706, 5.05130676833,
     5.31816188375, 3.83217368665, 15.0200633927, 18.5067494679),
    (24, 3, 0.36, 5.25, 4, 81.1369601440, 37.9434800720, 36.8290522999, 5.49322144093,
     4.18492889615, 4.85535480477, 3.19639768713, 32.7445424143, 37.5825499883),
]  # fmt: skip
"""By the textbook's (4.153) to (4.160) in 25 digits, and discs pressed between rack envelopes."""


def ellipse(**blank: Any) -> GearPairResult:
    made = job(laws.Ellipse(eccentricity=0.3), (41, 41), module=2.0, backlash=blank.pop("j", 0.0))
    return built(replace(made.design, blank=Blank(**blank))) if blank else made


def waisted() -> GearPairResult:
    return job(laws.Formula(r1="1/(1 + 0.4*cos(2*phi1))"), (36, 36), module=2.0)


@pytest.mark.parametrize("row", ROUND, ids=lambda row: f"z{row[0]}")
def test_round_wheels_are_those_of_the_textbook(row: tuple[float, ...]) -> None:
    z, module, x, pin, k, over, radius, contact, chord, depth, *rest = row
    made = job(laws.Constant(), (int(z), int(z)), module=float(module), x=x)
    table = made.measures(1, pin)
    wanted = {
        "over_pins_mm": over,
        "center_radius_mm": radius,
        "contact_radius_before_mm": contact,
        "contact_radius_after_mm": contact,
        "chord_mm": chord,
        "chord_depth_mm": depth,
        "constant_chord_mm": rest[0],
        "constant_chord_depth_mm": rest[1],
    }
    for name, value in wanted.items():
        assert table[name] == pytest.approx(np.full(int(z), value), abs=EXACT), name
    for first in (1, int(z)):
        assert made.span(1, first, int(k)) == pytest.approx(rest[2], abs=EXACT)
    spans = made.gear1.measuring.spans
    touched = np.abs(spans.contact[:, spans.teeth == k])
    assert touched == pytest.approx(np.full(touched.shape, rest[3]), abs=EXACT)
    assert set(spans.first) == set(range(1, int(z) + 1))
    assert not spans.rocked.any()


@pytest.mark.parametrize(
    ("made", "space", "radius", "angle", "before", "after"),
    [
        (ellipse, 1, 30.1599622767, 6.08979175468, 29.4854756793, 29.5647537719),
        (ellipse, 11, 43.1524182245, 109.191879947, 42.0573028910, 43.0242016980),
        (ellipse, 21, 55.2978072870, 180.0, 54.6424441212, 54.6424441212),
        (waisted, 1, 21.2299417671, 8.46768543649, 20.4441690700, 20.9972660978),
        (waisted, 5, 34.1606691498, 55.9564963080, 32.6156274081, 34.7336961744),
        (waisted, 10, 47.4242209880, 93.9589888202, 46.9460908944, 46.4097081679),
    ],
)
def test_pins_of_non_circular_wheels(
    made: Any, space: int, radius: float, angle: float, before: float, after: float
) -> None:
    table, row = made().measures(1, 3.5), space - 1
    found = (table["center_radius_mm"], table["contact_radius_before_mm"])
    assert [one[row] for one in found] == pytest.approx([radius, before], abs=EXACT)
    assert table["contact_radius_after_mm"][row] == pytest.approx(after, abs=EXACT)
    assert table["center_deg"][row] == pytest.approx(angle, abs=EXACT)


def test_over_pins_and_chords_of_non_circular_wheels() -> None:
    one, two = ellipse().measures(1, 3.5), waisted().measures(1, 3.5)
    assert (one["opposite"][0], two["opposite"][0]) == (21, 19)
    assert one["over_pins_mm"][0] == pytest.approx(88.8475679387, abs=EXACT)
    assert two["over_pins_mm"][0] == pytest.approx(45.9598835342, abs=EXACT)
    assert one["chord_mm"][0] == pytest.approx(3.14070673416, abs=EXACT)
    assert one["chord_depth_mm"][0] == pytest.approx(2.03230339151, abs=EXACT)
    assert two["chord_mm"][9] == pytest.approx(3.13378409688, abs=EXACT)
    assert two["chord_depth_mm"][9] == pytest.approx(2.09587085081, abs=EXACT)
    for table in (one, two):
        assert np.ptp(table["constant_chord_mm"]) < EXACT  # along any centrode


SPANS = [(40, 5, 27.6422338861), (20, 4, 21.7379710179), (9, 5, 27.7969587101)]


def test_an_ellipse_has_four_spans() -> None:
    made = ellipse()
    spans = made.gear1.measuring.spans
    assert set(spans.place) == {0, 1, 2, 3}
    for first, teeth, reading in (*SPANS, (10, 5, 27.7969587101)):
        assert made.span(1, first, teeth) == pytest.approx(reading, abs=EXACT)
    rocked = made.measures(1)["span_rocked_1deg_mm"]
    # 27.6422764361 rocked by 1 deg, with terms of higher order
    assert rocked[39] == pytest.approx(4.25500e-5, abs=1e-8)
    assert rocked[8] < 0.0 < rocked[19]


def test_elsewhere_a_span_is_refused_with_the_nearest() -> None:
    with pytest.raises(InfeasibleError, match=r"wheel 1.*teeth 9 to 13, 5 teeth: 27\.797 mm"):
        ellipse().span(1, 5, 5)
    ring = profile("ring_ellipse")
    with pytest.raises(InfeasibleError, match="measure over pins"):
        ring.span(2, 1, 3)
    for wheel, first, teeth in ((3, 1, 3), (1, 1.5, 3), (1, 1, 0)):
        with pytest.raises(DesignError):
            ring.span(wheel, first, teeth)  # pyright: ignore


# --- against the finished outline -----------------------------------------------------------------

FINISHED = {
    "ellipse": ellipse,
    "finished": lambda: ellipse(j=0.08, clearance=(0.05, 0.02), tip_rounding=(0.3, 0.2)),
    "waisted": waisted,
    "undercut": lambda: profile("nail_machine_three_phase"),
    "ring": lambda: profile("ring_ellipse"),
    "open": lambda: profile("furnace_door"),
    "rack": lambda: job(laws.RackLaw(r1="1 + 0.2*cos(2*phi1)"), (40, 60), module=2.0),
    "stepped": lambda: profile("stepped_ellipse"),
    "half concave flanks": lambda: job(
        laws.Phases(
            shape="quintic",
            knots=tuple(map(math.radians, (0.0, 69.2486, 232.747, 360.0))),
            ratios=(0.353377, "solve", 0.358213, 0.353377),
        ),
        (18, 54),
        module=0.2,
        tolerance=1e-4,
    ),
}


def gears(name: str) -> list[Gear]:
    made = FINISHED[name]()
    return [gear for step in made.steps for gear in step]


@pytest.mark.parametrize("name", FINISHED)
def test_a_disc_lies_between_the_flanks(name: str) -> None:
    for gear in gears(name):
        diameter, pins = gear.measuring.pins()
        tolerance = 3.0 * gear.profile.chord_error
        ring = shapely.LinearRing(gear.outline)
        assert pins.measured.mean() > 0.9
        assert np.abs(misfits(gear.measuring, gear)).max() < tolerance
        for number in np.flatnonzero(pins.measured):
            center = pins.center[number]
            for contact in pins.contact[:, number]:
                assert ring.distance(shapely.Point(contact.real, contact.imag)) < tolerance
                assert abs(abs(contact - center) - 0.5 * diameter) < EXACT
            # held from both sides: a shift along the space presses it into a flank
            across = np.diff(pins.contact[:, number])[0]
            for sign in (-1.0, 1.0):
                other = center + sign * 0.02 * across / abs(across)
                assert ring.distance(shapely.Point(other.real, other.imag)) < 0.5 * diameter - 0.01


@pytest.mark.parametrize("broken", ["moved", "sign"])
def test_a_disc_of_wrong_flanks_does_not(broken: str) -> None:
    gear = ellipse().gear1
    flanks = gear.profile.flanks
    wrong = {
        "moved": lambda: replace(flanks, sf=flanks.sf + 0.01 * flanks.sigma),
        "sign": lambda: replace(
            flanks, sf=2.0 * np.tile(gear.toothing.tooth_places, 2) - flanks.sf
        ),
    }[broken]()
    other = Measuring(wheel=1, outline=replace(gear.profile, flanks=wrong))
    if broken == "sign":  # the flanks of a tooth change places
        with pytest.raises(InfeasibleError):
            other.pins(gear.measuring.over.recommended)
        return
    assert np.abs(misfits(other, gear)).min() > 0.004


@pytest.mark.parametrize("name", FINISHED)
def test_depths_and_gaps_are_those_of_the_outline(name: str) -> None:
    for gear in gears(name):
        points, toothing = gear.profile.points, gear.toothing
        tolerance = 3.0 * gear.profile.chord_error
        _, pins = gear.measuring.pins()
        table = gear.measuring.table()
        teeth, ends = gear.profile.teeth
        for number in range(0, len(gear.measuring.numbers), 5):
            middle = toothing.tooth_places[toothing.whole][number]
            places = middle + toothing.half_tooth * np.array([-1.0, 1.0])
            before, after = toothing.frames(toothing.track.angle(places)).p
            out = toothing.turn * (after - before) / abs(after - before)
            at = int(np.flatnonzero(teeth == gear.measuring.numbers[number])[0])
            first, last = ends[at]
            tooth = (
                points[first : last + 1]
                if first < last
                else np.append(points[first:], points[:last])
            )
            depth = (np.conj(out) * (tooth - before)).real.max()
            assert table["chord_depth_mm"][number] == pytest.approx(depth, abs=tolerance)
        # nothing of the outline but both flanks is as near
        for number in range(0, len(pins.center), 7):
            reach = np.abs(points - pins.center[number]).min()
            assert reach > 0.5 * table["pin_diameter_mm"][0] - tolerance


@pytest.mark.parametrize("name", FINISHED)
def test_jaws_lie_on_the_outermost_points_of_both_teeth(name: str) -> None:
    for gear in gears(name):
        off = jaw_misfits(gear.measuring, gear)
        assert np.abs(off).max(initial=0.0) < 3.0 * gear.profile.chord_error


@pytest.mark.parametrize("made", [ellipse, waisted, lambda: ellipse(j=0.1, clearance=(0.03, 0.03))])
def test_jaws_against_the_flanks_read_the_span(made: Any) -> None:
    gear = made().gear1
    spans, flanks = gear.measuring.spans, gear.flank_points(801)
    points, side, tooth = as_complex(flanks.points), flanks["side"], flanks["tooth"]

    def reading(number: int, rock: float) -> float:
        chord = spans.contact[0, number] - spans.contact[1, number]
        along = np.conj(chord / abs(chord) * np.exp(1j * rock))
        last = points[(tooth == spans.last[number]) & (side == 1)]
        first = points[(tooth == spans.first[number]) & (side == -1)]
        return float((along * last).real.max() - (along * first).real.min())

    assert len(spans.first) > 4
    for number in np.flatnonzero(spans.off < 0.8).tolist():
        steady = reading(number, 0.0)
        assert steady == pytest.approx(spans.reading[number], abs=2e-5)
        for rock in (-math.radians(1.0), math.radians(1.0)):
            change = spans.rocked[number] * rock * rock
            assert reading(number, rock) - steady == pytest.approx(change, abs=0.1 * abs(change))


def test_no_other_common_normals() -> None:
    """Along a convex centrode each roll b has one roll a whose normal is parallel."""
    gear = ellipse().gear1
    track, alpha = gear.toothing.track, gear.toothing.cutter.alpha
    s = np.linspace(0.0, 2.0 * gear.toothing.length, 16001)
    frames = track.frames(track.angle(s))
    turned = np.unwrap(np.angle(frames.t))
    b = s[: len(s) // 2 + 1]
    a = np.interp(turned[: len(b)] + 2.0 * alpha, turned, s)
    places = track.frames(track.angle(np.stack([a, b]))).p
    aside = np.imag(np.conj(frames.t[: len(b)] * np.exp(1j * alpha)) * (places[0] - places[1]))
    assert np.count_nonzero(aside[1:] * aside[:-1] < 0.0) == 4


# --- the pin --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("module", "wanted"), [(0.05, 0.09), (1.0, 1.75), (2.0, 3.5), (100.0, 175.0)]
)
def test_the_recommended_pin_has_a_simple_size(module: float, wanted: float) -> None:
    made = job(laws.Ellipse(eccentricity=0.3), (41, 41), module=module)
    diameter, pins = made.gear1.measuring.pins()
    assert diameter == wanted
    assert pins.measured.all()


def test_thinnest_and_thickest_pins_touch_ends_of_flanks() -> None:
    over = ellipse().gear1.measuring.over
    for limits, ends in ((over.thinnest, over.spaces.lowest), (over.thickest, over.spaces.highest)):
        assert np.abs(limits.reach - ends).min(axis=0).max() < EXACT
        inside = (over.spaces.lowest - EXACT <= limits.reach) & (
            limits.reach <= over.spaces.highest + EXACT
        )
        assert inside.all()
        for space in (0, 7, 20):
            pins = over.pins(float(limits.diameter[space]))
            assert np.isfinite(pins.center[space])


def test_a_pin_that_does_not_fit_is_refused_or_noted() -> None:
    made = ellipse()
    for wrong in (0.3, 30.0):
        with pytest.raises(InfeasibleError, match=r"recommended pin has 3\.5 mm") as refused:
            made.measures(1, wrong)
        assert refused.value.limit == pytest.approx(2.1 if wrong < 1 else 5.9, abs=0.1)
    for wrong in (0.0, -1.0, "3"):
        with pytest.raises(DesignError):
            made.measures(1, wrong)  # pyright: ignore
    thick = made.gear1.measuring.over.pins(5.85)  # at some spaces only
    both = thick.measured & thick.measured[thick.opposite]
    assert 0 < both.sum() < thick.measured.sum()
    assert (np.isfinite(thick.over) == both).all()
    design = made.design.with_({"output.pin_diameter_mm": [2.16, 3.5]})
    (note,) = [one for one in built(design).findings if one.code == "measuring-pin"]
    assert note.where.startswith("wheel 1, teeth ")
    assert "touch both flanks" in note.message


# --- rings and racks ------------------------------------------------------------------------------


def test_between_pins_of_a_round_ring() -> None:
    """The space of a ring is the tooth of a wheel: pins push outwards from its thickness."""
    z, module, pin, alpha = 48, 2.0, 3.5, math.radians(20)
    made = job(laws.Constant(), (24, z), module=module, internal=True)
    wanted = math.tan(alpha) - alpha + math.pi / (2 * z) - pin / (module * z * math.cos(alpha))
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if math.tan(middle) - middle < wanted else (low, middle)
    across = module * z * math.cos(alpha) / math.cos(low)
    assert made.measures(2, pin)["over_pins_mm"] == pytest.approx(across - pin, abs=EXACT)


def test_over_a_pin_and_the_back_of_a_straight_rack() -> None:
    rack = Rack(addendum=0.9, dedendum=1.25)
    plain = job(laws.RackLaw(r1="1"), (24, 30), module=2.0, backlash=0.06, rack=rack)
    barred = built(plain.design.with_({"bar.height_mm": 20}))  # from the back to the tips
    alpha, half = math.radians(20), 0.5 * math.pi + 0.25 * 0.06
    outwards = (1.75 / math.cos(alpha) - half) / math.tan(alpha)
    over = barred.measures(2, 3.5)["over_pins_mm"][:-1]
    assert over == pytest.approx(np.full(len(over), 18.2 + outwards + 1.75), abs=EXACT)


def test_an_arc_is_one_place() -> None:
    """Two arcs of circles, joined smoothly: conditions nearly hold beyond their ends."""
    gear = profile("two_speeds").gear1
    spans, module, alpha = gear.measuring.spans, gear.pair.module, math.radians(20)
    assert set(spans.place) == {-2, -1, 0, 1, 2, 3}
    for place, phi in ((-1, 60.0), (-2, 240.0)):  # those of round wheels of these radii
        radius = float(np.abs(gear.toothing.frames(np.radians([phi])).p[0]))
        for k in set(spans.teeth[spans.place == place].tolist()):
            arcs = (k - 0.5) * math.pi + 2.0 * radius / module * (math.tan(alpha) - alpha)
            here = spans.reading[(spans.place == place) & (spans.teeth == k)]
            assert here == pytest.approx(
                np.full(len(here), module * math.cos(alpha) * arcs), abs=EXACT
            )
