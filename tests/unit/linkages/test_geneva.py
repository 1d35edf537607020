"""Geneva wheels against printed values and the place of the pin in its slot."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from gearcam.linkages.elements import Crank, GivenMotion, Law, MemberPoint
from gearcam.linkages.geneva import GenevaWheel
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_measured import TURN, cosine_phases, even

MALTESE = GenevaWheel("wheel", "q", "O", 60.0, 4)


def test_the_wheel_of_the_source() -> None:
    crank = np.radians([-44.999999999999, -30.0, -15.0, 0.0, 10.0, 30.0, 44.999999999999])
    turn, ratio, bend = MALTESE.wheel_turn(Jet.variable(crank, 2)).derivatives()
    assert -np.degrees(turn) == pytest.approx(
        [-45.0, -42.3678051586, -30.0, 0.0, 22.0180030305, 42.3678051586, 45.0], abs=1e-10
    )
    expected = [0.0, 0.408248290464, 1.36602540378, 2.41421356237, 1.83053471687, 0.408248290464]
    assert -ratio[:6] == pytest.approx(expected, abs=1e-11)
    bends = [1.0, 2.33321184036, 5.09807621135, 0.0, -5.33526963477, -2.33321184036, -1.0]
    assert -bend == pytest.approx(bends, abs=1e-10)
    assert MALTESE.distance == pytest.approx(60.0 * np.sqrt(2.0))
    assert MALTESE.jump == pytest.approx(1.0)


def test_it_rests_outside_and_goes_on_by_a_slot_per_turn() -> None:
    crank = np.radians([46.0, 180.0, 181.0, 314.0, 360.0, 720.0, -46.0, -360.0])
    found = MALTESE.wheel_turn(Jet.variable(crank, 3)).derivatives()
    assert -np.degrees(found[0]) == pytest.approx([45, 45, 45, 45, 90, 180, -45, -90], abs=1e-12)
    assert np.all(found[3][[0, 1, 2, 3, 6]] == 0.0)


def _machine(wheel: GenevaWheel, law: Law, knots: Array) -> Linkage:
    parts = [
        GivenMotion("q", law),
        MemberPoint("O", 20.0 - 5.0j),
        Crank("crank", "q", "O", "pin", wheel.length, wheel.start),
        wheel,
    ]
    return Linkage(in_order(parts), wheel.knots(law, knots))


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("slots", [3, 4, 7, 24])
def test_the_pin_stays_in_its_slot(slots: int, internal: bool) -> None:
    wheel = replace(MALTESE, slots=slots, internal=internal, direction=0.7, start=2.0)
    linkage = _machine(wheel, even, TURN)
    middle = 0.7 - 2.0 + (np.pi if internal else 0.0)
    half = 0.5 * wheel.engaged
    q = middle + np.linspace(-half + 1e-9, half - 1e-9, 41)
    for turn in (0, 1, -3):
        known = linkage.at(q + turn * 2.0 * np.pi, 3)
        slotted = known.frame("wheel")
        # each turn the next slot
        slot = slotted.direction * np.exp((1 if not internal else -1) * 1j * turn * wheel.pitch)
        way = known.jet("pin") - slotted.origin
        for k, one in enumerate((way / slot).c):
            assert np.abs(np.imag(one)).max() < 1e-9 * 60.0 * 10.0**k
        assert np.all(np.real((way / slot).c[0]) > 0.0)
    assert wheel.engaged == pytest.approx(
        np.pi * (1 + 2 / slots) if internal else np.pi * (1 - 2 / slots)
    )


@pytest.mark.parametrize("internal", [False, True])
def test_the_jump_of_acceleration_at_entry_and_exit(internal: bool) -> None:
    wheel = replace(MALTESE, slots=5, internal=internal, start=1.0)
    linkage = _machine(wheel, even, TURN)
    assert linkage.knots.size == 4
    turn = TrackMeasures(partial(linkage.track, "wheel.turn"), linkage.knots)
    assert abs(turn.rise) == pytest.approx(2.0 * np.pi / 5.0, rel=1e-14)
    assert (turn.rise > 0.0) is internal
    places, bends = turn.extremes[2]
    for knot in linkage.knots[1:3]:
        sides = np.abs(bends[places == knot])
        assert sides.min() == 0.0
        assert sides.max() == pytest.approx(np.tan(np.pi / 5.0), rel=1e-9)
    places, ratios = turn.extremes[1]
    assert np.abs(ratios[np.isin(places, linkage.knots[1:3])]).max() < 1e-9
    top = np.sin(np.pi / 5.0) / (1.0 + (1 if internal else -1) * np.sin(np.pi / 5.0))
    assert max(turn.largest(1).value, -turn.least(1).value) == pytest.approx(top, rel=1e-12)


def test_knots_behind_a_pair_that_turns_unevenly() -> None:
    law, knots = cosine_phases([0, 160, 360], [1.6, 0.4, 1.6])
    wheel = replace(MALTESE, slots=6, direction=3.0)
    found = wheel.knots(law, knots)
    assert found.size == knots.size + 2
    new = np.setdiff1d(found, knots)
    crank = np.asarray(law(new, 0).c[0])
    assert crank == pytest.approx([3.0 - np.pi / 3.0, 3.0 + np.pi / 3.0], abs=1e-14)


def test_two_turns_of_the_crank_per_turn_of_the_driver_have_four_more_knots() -> None:
    def twice(q: Array, order: int) -> Jet:
        return Jet.variable(q, order) * -2.0

    found = replace(MALTESE, direction=1.0).knots(twice, TURN)
    assert found.size == 2 + 4


def test_slots_and_length_are_checked() -> None:
    for slots in (2, 25):
        with pytest.raises(ValueError, match=f"slots {slots}: must be 3 to 24"):
            replace(MALTESE, slots=slots)
    with pytest.raises(ValueError, match="length 0 mm: must be above 0"):
        replace(MALTESE, length=0.0)


def test_the_pin_enters_and_leaves_once_a_turn() -> None:
    quarter = 0.25 * np.pi
    found = MALTESE.switches(0.0, 7.0)
    assert found == pytest.approx([quarter, 7.0 * quarter], abs=1e-15)
    found = MALTESE.switches(-quarter - 1e-12, 9.0 * quarter + 1e-12)
    assert found == pytest.approx(quarter * np.array([-1.0, 1.0, 7.0, 9.0]), abs=1e-15)


@pytest.mark.parametrize("slots", [3, 5, 7, 11])
def test_an_entry_at_a_knot_is_that_knot(slots: int) -> None:
    wheel = replace(MALTESE, slots=slots, direction=np.pi * (0.5 - 1.0 / slots))
    found = wheel.knots(even, TURN)
    assert found.size == 3
    assert found[1] == pytest.approx(wheel.engaged, abs=1e-14)
    beside = np.array([0.0, wheel.engaged + 1e-13, 2.0 * np.pi])
    assert wheel.knots(even, beside).tolist() == beside.tolist()
