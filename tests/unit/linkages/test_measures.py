"""Extremes, dead centres and time ratios against printed values and closed forms."""

from __future__ import annotations

import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

from gearcam.base.findings import CHECKS
from gearcam.linkages.checks import KIND
from gearcam.linkages.elements import Crank, GivenMotion, MemberPoint
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.linkages.measures import DeadCenter, TrackMeasures, extremes_of
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_measured import (
    TURN,
    cosine_phases,
    even,
    known_four_bar,
    measures,
    nail_machine,
    quick_return,
)

PAIRS = {
    "none": (even, TURN),
    "two phases": cosine_phases([0, 160, 360], [1.6, 0.4, 1.6]),
    "three phases": cosine_phases([0, 160, 270, 360], [1.6, 0.4, 1.06, 1.6]),
}

PEAKS = {
    "none": (
        (152.974962014, 100.899864701),
        (-152.974962014, 259.100135299),
        (120.0, 0.0),
        (-180.0, 180.0),
    ),
    "two phases": (
        (185.094888691, 54.6182942781),
        (-203.736787041, 301.699956228),
        (307.2, 0.0),
        (-178.205043964, 262.488356918),
    ),
    "three phases": (
        (185.094888691, 54.6182942781),
        (-177.018491124, 302.941923309),
        (307.2, 0.0),
        (-166.322225534, 240.915065261),
    ),
}


@pytest.mark.parametrize("pair", PAIRS)
def test_peaks_of_the_nail_machine(pair: str) -> None:
    slide = measures(nail_machine(*PAIRS[pair]), "slide.guide2")
    found = slide.largest(1), slide.least(1), slide.largest(2), slide.least(2)
    for peak, (value, place) in zip(found, PEAKS[pair], strict=True):
        assert peak.value == pytest.approx(value, rel=2e-12)
        assert np.degrees(peak.place) == pytest.approx(place, abs=1e-9)


def test_the_nail_machine_moves_over_300_mm() -> None:
    slide = measures(nail_machine(*PAIRS["two phases"]), "slide.guide2")
    assert slide.stroke == pytest.approx(300.0, rel=1e-14)
    inner, outer = slide.dead_centers
    assert (inner.outer, outer.outer) == (False, True)
    assert inner.place == inner.until == 0.0
    assert np.degrees(outer.place) == pytest.approx(204.644514019, abs=1e-9)


def test_the_angles_at_which_the_crank_has_a_place() -> None:
    law, knots = PAIRS["two phases"]
    wheel = TrackMeasures(law, knots)
    assert wheel.rise == pytest.approx(2.0 * np.pi, rel=1e-14)
    assert np.degrees(wheel.places_of(np.radians(158.0))) == pytest.approx([155.011955902])
    assert wheel.places_of(-1.0).size == 0
    assert wheel.dead_centers == ()


def test_limits_and_time_ratio_of_a_rocker() -> None:
    rocker = measures(known_four_bar(), "rocker.angle")
    inner, outer = rocker.dead_centers
    assert np.degrees([inner.value, inner.place]) == pytest.approx(
        [74.1733798681, 32.7637577589], abs=1e-10
    )
    assert np.degrees([outer.value, outer.place]) == pytest.approx(
        [134.184385153, 233.77845338], abs=1e-9
    )
    assert np.degrees(rocker.stroke) == pytest.approx(60.0110052852, abs=1e-10)
    ratio = rocker.time_ratio
    assert ratio is not None
    assert ratio.least == pytest.approx(0.790913837853, abs=1e-12)
    assert np.degrees(ratio.forward) == pytest.approx(180.0 + 21.0146956213, abs=1e-10)


def test_time_ratio_and_ram_of_the_quick_return() -> None:
    linkage = quick_return()
    rocker, ram = measures(linkage, "rocker.angle"), measures(linkage, "ram.guide2")
    ratio = rocker.time_ratio
    assert ratio is not None
    assert np.degrees(rocker.stroke) == pytest.approx(47.1563569564, abs=1e-10)
    assert ratio.ratio == pytest.approx(1.70995278172, abs=1e-11)
    assert ratio.least == pytest.approx(0.584811470053, abs=1e-12)
    inner, outer = ram.dead_centers
    assert [inner.value, np.degrees(inner.place)] == pytest.approx([-28.225721319, 203.578178478])
    assert [outer.value, np.degrees(outer.place)] == pytest.approx([227.774278681, 336.421821522])
    assert ram.stroke == pytest.approx(256.0, rel=1e-13)


def test_extremes_of_all_orders_are_roots_to_rounding() -> None:
    def wave(q: Array, order: int) -> Jet:
        return jets.sin(Jet.variable(q, order) * 2.0 + 0.3)

    for order, (places, values) in enumerate(extremes_of(wave, TURN)):
        inner = (places > 0.0) & (places < TURN[1])
        at = np.arange(0, 4) * np.pi / 2 + (np.pi / 2 * ((order + 1) % 2) - 0.3) / 2
        expected = np.sort(np.mod(at, 2 * np.pi))
        assert places[inner] == pytest.approx(expected, abs=2e-15)
        assert np.abs(values[inner]) == pytest.approx(np.full(4, 2.0**order), rel=1e-15)


def test_values_at_a_knot_are_one_sided() -> None:
    def corner(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order) - 1.0
        return x * np.where(q < 1.0, 2.0, 5.0)

    for knots in ([0.0, 1.0, 2.0], [0.0, 1.0, 9.0, 9.01], [0.0, 0.01, 1.0, 9.0]):
        places, values = extremes_of(corner, np.array(knots))[1]
        assert values[places == 1.0].tolist() == [2.0, 5.0]


def _rise_rest_return(q: Array, order: int) -> Jet:
    x = Jet.variable(np.mod(q, 2.0 * np.pi), order)
    up, down = x * 1.0, (x - 2.0) * 1.0
    rising = (1.0 - jets.cos(up * np.pi)) * 3.0
    falling = (1.0 + jets.cos(down * np.pi)) * 3.0
    parts = [
        np.where(q < 1.0, r, np.where(q < 2.0, 6.0 * (k == 0), np.where(q < 3.0, f, 0.0)))
        for k, (r, f) in enumerate(zip(rising.c, falling.c, strict=True))
    ]
    return Jet(parts)


def test_a_motion_rests_at_its_ends() -> None:
    knots = np.array([0.0, 1.0, 2.0, 3.0, 2.0 * np.pi])
    found = TrackMeasures(_rise_rest_return, knots)
    low, high = found.dead_centers
    assert (low.outer, high.outer) == (False, True)
    assert (low.value, high.value) == pytest.approx((0.0, 6.0), abs=1e-14)
    assert (low.place, low.until) == pytest.approx((3.0 - 2.0 * np.pi, 0.0), abs=1e-12)
    assert (high.place, high.until) == pytest.approx((1.0, 2.0), abs=1e-12)
    ratio = found.time_ratio
    assert ratio is not None
    assert tuple(ratio) == pytest.approx((1.0, 1.0))


@pytest.mark.parametrize("shift", [0.0, 3e-6, 1e-7, 1e-9])
def test_a_dead_center_beside_a_knot_is_one_place(shift: float) -> None:
    def wave(q: Array, order: int) -> Jet:
        return jets.cos(Jet.variable(q, order) - shift)

    first, second = TrackMeasures(wave, TURN).dead_centers
    assert first.place == first.until == pytest.approx(shift, abs=1e-8)
    assert second == pytest.approx(DeadCenter(-1.0, np.pi + shift, np.pi + shift, outer=False))


def test_an_open_range_has_the_ends_at_which_it_stands_still() -> None:
    def wave(q: Array, order: int) -> Jet:
        return jets.cos(Jet.variable(q, order))

    half = TrackMeasures(wave, np.array([0.0, np.pi]), closed=False)
    assert [(one.value, one.outer) for one in half.dead_centers] == [(1.0, True), (-1.0, False)]
    part = TrackMeasures(wave, np.array([0.5, 4.0]), closed=False)
    assert [(one.value, one.place) for one in part.dead_centers] == [(-1.0, np.pi)]
    assert part.time_ratio is None


def test_what_stands_still_has_no_dead_center() -> None:
    def rest(q: Array, order: int) -> Jet:
        return Jet([5.0 + 1e-15 * np.sin(40.0 * q), *[0.0] * order])

    assert TrackMeasures(rest, TURN).dead_centers == ()


@pytest.mark.parametrize("speed", [1.0, -5.0])
def test_an_angle_goes_on_past_half_a_turn(speed: float) -> None:
    def turned(q: Array, order: int) -> Jet:
        return Jet.variable(q, order) * speed + 3.0

    parts = [GivenMotion("q", turned), MemberPoint("O", 0j), Crank("crank", "q", "O", "A", 1.0)]
    linkage = Linkage(in_order(parts), TURN)
    track = partial(linkage.real_track, "crank.angle")
    q = np.linspace(-4.0 * np.pi, 6.0 * np.pi, 1001)
    assert track(q, 1).c[0] == pytest.approx(3.0 + speed * q, abs=1e-12)
    assert track(np.array([7.0]), 0).c[0] == pytest.approx(3.0 + speed * 7.0, abs=1e-12)
    assert TrackMeasures(track, TURN).rise == pytest.approx(2.0 * np.pi * speed)


@pytest.mark.parametrize("shift", [0.0, 1.0, np.pi / 3.0])
def test_an_output_that_turns_and_steps_back(shift: float) -> None:
    def pilgrim(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order) + shift
        return x - jets.sin(x) * 2.0

    found = TrackMeasures(pilgrim, TURN)
    assert found.rise == pytest.approx(2.0 * np.pi, rel=1e-15)
    expected = sorted(np.mod(np.array([1.0, 5.0]) * np.pi / 3.0 - shift, 2.0 * np.pi))
    assert [one.place for one in found.dead_centers] == pytest.approx(expected, abs=1e-14)
    assert {one.outer for one in found.dead_centers} == {True, False}
    q = np.array([-7.0, -1.0, 6.0, 20.0])
    for got, wanted in zip(found.at(q, 2).c, pilgrim(q, 2).c, strict=True):
        assert got == pytest.approx(wanted, abs=1e-13)


@pytest.mark.parametrize(("jump", "slight"), [(0.9e-3, True), (1.1e-3, False), (-1.1e-3, False)])
def test_a_jump_of_a_thousandth_of_the_largest_velocity_is_too_small_to_matter(
    jump: float, slight: bool
) -> None:
    places, values = np.array([0.0, 1.0, 1.0, 2.0]), np.array([0.0, -2.0, -2.0 + 2.0 * jump, 0.0])
    track = SimpleNamespace(
        extremes={1: (places, values)}, knots=np.array([0.0, 1.0, 2.0]), closed=True
    )
    machine = SimpleNamespace(outputs={"s": track}, units={"s": "mm"})
    (found,) = CHECKS[KIND, "velocity-jump"].run(machine, math.nan)
    assert found.value == pytest.approx(2.0 * jump)
    assert f"jumps by {found.value:.5g} mm" in found.message
    assert found.severity == ("note" if slight else "warning")
    assert ("too small to matter" in found.message) == slight


@pytest.mark.parametrize("noise", [0.0, 1e-15, 1e-11])
def test_what_stands_still_but_for_rounding_has_no_velocity(noise: float) -> None:
    """Its derivatives are 0, also between two sides of a knot; not of one that moves."""

    def trembling(q: Array, order: int) -> Jet:
        return jets.sin(Jet.variable(q, order) * 7.0) * noise + 50.0

    found = TrackMeasures(trembling, TURN)
    assert found.still
    assert [found.stroke, *(found.size(order).value for order in (1, 2, 3))] == [0.0] * 4
    assert not found.dead_centers

    def moving(q: Array, order: int) -> Jet:
        return jets.sin(Jet.variable(q, order)) * 1e-6 + 50.0

    moves = TrackMeasures(moving, TURN)
    assert not moves.still
    assert moves.size(1).value == pytest.approx(1e-6)
