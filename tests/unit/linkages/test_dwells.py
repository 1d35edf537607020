"""Longest dwells against closed forms and a search by steps; the last bit of a travel."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.linkages.dwells import last_travels, longest_dwell
from gearcam.linkages.elements import Law
from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_measured import (
    TURN,
    cosine_phases,
    even,
    measures,
    nail_machine,
    six_bar_with_dwell,
)
from helpers_sampling import few


def _waves(cosines: Array, sines: Array, rise: float = 0.0) -> Law:
    def track(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order)
        total = x * rise
        for number, (c, s) in enumerate(zip(cosines, sines, strict=True), start=1):
            total = total + jets.cos(x * number) * c + jets.sin(x * number) * s
        return total

    return track


ONE, NONE = np.array([1.0]), np.array([0.0])


@pytest.mark.parametrize("amount", [1e-3, 0.1, 1.5])
def test_a_dwell_round_an_extreme(amount: float) -> None:
    found = longest_dwell(TrackMeasures(_waves(NONE, ONE), TURN), amount)
    assert found.length == pytest.approx(2.0 * np.arccos(1.0 - amount), rel=1e-13)


def test_a_dwell_over_the_end_of_a_turn_ends_above_it() -> None:
    track = _waves(np.array([1.0, 0.25]), np.array([0.0, 0.0]))  # flat at 180 deg only
    assert longest_dwell(TrackMeasures(track, TURN), 0.1).begin > 2.0
    shifted = TrackMeasures(track, np.array([np.pi, 3.0 * np.pi]))
    found = longest_dwell(shifted, 0.1)
    assert np.pi < found.begin < 3.0 * np.pi < found.end
    assert found.begin + found.end == pytest.approx(6.0 * np.pi, abs=1e-13)


def test_a_dwell_while_the_output_passes_through() -> None:
    slow = TrackMeasures(_waves(NONE, -0.9 * ONE, 1.0), TURN)
    found = longest_dwell(slow, 0.1)
    half = found.end - 2.0 * np.pi
    assert found.begin == pytest.approx(2.0 * np.pi - half, abs=1e-12)
    assert 2.0 * (half - 0.9 * np.sin(half)) == pytest.approx(0.1, abs=1e-14)


def test_a_passage_with_a_ripple_inside() -> None:
    found = longest_dwell(TrackMeasures(_waves(NONE, -1.05 * ONE, 1.0), TURN), 0.1)
    half = found.end - 2.0 * np.pi
    assert found.begin == pytest.approx(2.0 * np.pi - half, abs=1e-12)
    assert half - 1.05 * np.sin(half) == pytest.approx(0.05, abs=1e-14)


def _by_steps(track: Law, amount: float, steps: int) -> float:
    """Return the longest range by two pointers over two turns."""
    q = np.linspace(0.0, 4.0 * np.pi, 2 * steps, endpoint=False)
    value = np.asarray(track(q, 0).c[0])
    longest, end = 0, 0
    for begin in range(steps):
        end = max(end, begin)
        while end + 1 < q.size and np.ptp(value[begin : end + 2]) <= amount:
            end += 1
        longest = max(longest, end - begin)
    return longest * 2.0 * np.pi / steps


@pytest.mark.parametrize("rise", [0.0, 1.0, -2.0])
@pytest.mark.parametrize("seed", few(range(8), 4))
def test_dwells_of_waves_against_a_search_by_steps(seed: int, rise: float) -> None:
    random = np.random.default_rng(seed)
    track = _waves(random.normal(size=4), random.normal(size=4), rise)
    found = TrackMeasures(track, TURN)
    amount = float(random.uniform(0.02, 0.4)) * found.stroke
    dwell = longest_dwell(found, amount)
    q = np.linspace(dwell.begin, dwell.end, 20001)
    assert np.ptp(np.asarray(track(q, 0).c[0])) == pytest.approx(amount, rel=1e-6)
    steps = 3000
    assert 0.0 <= dwell.length - _by_steps(track, amount, steps) < 3.0 * 2.0 * np.pi / steps


def test_the_dwell_of_a_six_bar() -> None:
    arm = measures(six_bar_with_dwell(), "arm.angle")
    arm = TrackMeasures(arm.track, arm.knots)
    crank = np.radians([0.0, 30.0, 90.0, 140.0, 300.0])
    turned = np.degrees(arm.at(crank, 0).c[0])
    expected = [118.221453432, 124.664255953, 156.559568552, 156.481965734, 152.469073682]
    assert turned == pytest.approx(expected, abs=1e-9)
    part = TrackMeasures(arm.track, np.radians([100.0, 260.0]), closed=False)
    assert np.degrees(part.stroke) == pytest.approx(0.330746869002, abs=1e-11)
    dwell = longest_dwell(arm, part.stroke)
    begin, end = np.degrees(dwell)
    assert begin < 100.0
    assert end > 260.0
    assert np.degrees(TrackMeasures(arm.track, np.array(dwell), False).stroke) == pytest.approx(
        0.330746869002, abs=1e-9
    )


def test_an_output_that_stays_rests_all_the_turn() -> None:
    assert longest_dwell(TrackMeasures(_waves(NONE, ONE), TURN), 2.5) == tuple(TURN)


def test_a_dwell_at_the_end_of_an_open_range() -> None:
    part = TrackMeasures(_waves(NONE, ONE), np.array([0.4, 1.2]), closed=False)
    found = longest_dwell(part, 0.1)
    assert found == pytest.approx((np.arcsin(np.sin(1.2) - 0.1), 1.2), abs=1e-14)


def test_an_amount_must_be_above_0() -> None:
    with pytest.raises(ValueError, match="amount 0: must be above 0"):
        longest_dwell(TrackMeasures(_waves(NONE, ONE), TURN), 0.0)


CUBIC = cosine_phases([0, 160, 360], [1.6, 0.4, 1.6])
THREE = cosine_phases([0, 160, 270, 360], [1.6, 0.4, 1.06, 1.6])


def _last_22_deg() -> float:
    return 900.0 - (
        150.0 * np.cos(np.radians(22)) + np.sqrt(750**2 - (150 * np.sin(np.radians(22))) ** 2)
    )


@pytest.mark.parametrize(
    ("pair", "interval"),
    [((even, TURN), 22.0), (CUBIC, 49.63255812), (THREE, 47.16374566)],
    ids=["none", "two", "three"],
)
def test_the_forming_interval_of_the_nail_machine(pair: tuple[Law, Array], interval: float) -> None:
    slide = measures(nail_machine(*pair), "slide.guide2")
    (found,) = last_travels(slide, _last_22_deg())
    assert np.degrees(found.length) == pytest.approx(interval, abs=2e-8)


def test_the_load_range_before_the_outer_dead_center() -> None:
    slide = measures(nail_machine(*CUBIC), "slide.guide2")
    found = np.degrees(last_travels(slide, 4.0)[0])
    assert found == pytest.approx([179.279168440, 204.644514019], abs=1e-9)


def test_a_travel_before_the_inner_dead_center_reaches_over_the_turn() -> None:
    slide = measures(nail_machine(even, TURN), "slide.guide2")
    (found,) = last_travels(slide, 4.0, outer=False)
    assert found.end == pytest.approx(2.0 * np.pi, abs=1e-14)
    assert slide.at(np.array([found.begin]), 0).c[0] == pytest.approx([604.0], abs=1e-11)
    assert 0.0 < found.begin < found.end


@pytest.mark.parametrize("travel", [1.0 - 1e-13, 1.0, 1.0 + 4e-11])
def test_the_whole_travel_as_it_is_printed_is_the_last_travel(travel: float) -> None:
    twice = np.array([0.0, 1.0])
    wave = TrackMeasures(_waves(twice * 0.0, twice), TURN)
    for found in last_travels(wave, wave.stroke * travel):
        assert found.length == pytest.approx(0.5 * np.pi, abs=1e-4)
    with pytest.raises(ValueError, match="travel"):
        last_travels(wave, wave.stroke * (1.0 + 1e-8))


def test_each_arrival_at_a_dead_center_has_its_last_travel() -> None:
    twice = np.array([0.0, 1.0])
    sine, cosine = _waves(twice * 0.0, twice), _waves(twice, twice * 0.0)
    found = np.degrees(np.array(last_travels(TrackMeasures(sine, TURN), 0.5)))
    np.testing.assert_allclose(found, [[15.0, 45.0], [195.0, 225.0]], atol=1e-10)
    # one is over the end of the turn, which two extremes stand for
    found = np.degrees(np.array(last_travels(TrackMeasures(cosine, TURN), 0.5)))
    np.testing.assert_allclose(found, [[330.0, 360.0], [150.0, 180.0]], atol=1e-10)
    part = TrackMeasures(sine, np.radians([30.0, 250.0]), closed=False)
    np.testing.assert_allclose(
        np.degrees(np.array(last_travels(part, 0.5))), [[195.0, 225.0]], atol=1e-10
    )


def test_a_travel_ends_where_a_rest_over_the_end_of_a_turn_begins() -> None:
    def track(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order)
        up, down = 0.5 - 0.5 * jets.cos(x * 0.9), 0.5 + 0.5 * jets.cos((x - knots[1]) * 1.8)
        moved = [np.where(q < knots[1], *both) for both in zip(up.c, down.c, strict=True)]
        return Jet([np.where(q < knots[2], one, 0.0) for one in moved])

    knots = np.radians([0.0, 200.0, 300.0, 360.0])
    (found,) = last_travels(TrackMeasures(track, knots), 0.5, outer=False)
    assert np.degrees(found) == pytest.approx([250.0, 300.0], abs=1e-10)


def test_travels_that_cannot_be_are_refused() -> None:
    wave = _waves(NONE, ONE)
    with pytest.raises(ValueError, match=r"travel 2\.5: must be between 0 and 2$"):
        last_travels(TrackMeasures(wave, TURN), 2.5)
    part = TrackMeasures(wave, np.array([1.0, 3.0]), closed=False)
    with pytest.raises(ValueError, match=r"travel 0\.5: the range has 0\.158\d* of it before"):
        last_travels(part, 0.5)


@pytest.mark.parametrize("number", [30, pytest.param(300, marks=pytest.mark.slow)])
def test_a_knot_on_a_slope_begins_no_dwell(number: int) -> None:
    wave = _waves(NONE, ONE)
    for knot in np.linspace(0.3, 2.8, number):
        found = longest_dwell(TrackMeasures(wave, np.array([0.0, knot, 2.0 * np.pi])), 0.1)
        values = wave(np.linspace(*found, 101), 0).c[0]
        assert np.ptp(values) == pytest.approx(0.1, abs=1e-9), knot


@pytest.mark.parametrize("amount", [0.05, 0.4, 2.0])
def test_what_turns_on_stays_longest_where_it_is_slowest(amount: float) -> None:
    turning = _waves(NONE, 0.3 * ONE, 1.0)  # x + 0.3*sin(x), slowest at 180 deg
    found = longest_dwell(TrackMeasures(turning, TURN), amount)
    assert found.begin + found.end == pytest.approx(2.0 * np.pi, abs=1e-9)
    half = 0.5 * found.length
    assert 2.0 * (half - 0.3 * np.sin(half)) == pytest.approx(amount, abs=1e-12)
