"""Positions over many turns, and the way through change points."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest
from mpmath import mp

from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.dyads import DYADS, Lengths
from gearcam.linkages.elements import Crank, Dyad, GivenMotion, Law, MemberPoint
from gearcam.linkages.linkage import Linkage
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_linkages import TURN, TWO_PHASES, crank_slider, four_bar, linkage, phases
from helpers_random_linkages import drawn, place, side

TURNS = np.arange(-10, 10)

AROUND = np.array([-0.5, -0.11, -0.06, -0.01, -1e-3, -1e-5, -1e-7, -1e-9, 0.0])
"""Angles beside a change point, rad: before, in and beyond the reach of its series."""

BESIDE = np.concatenate([AROUND, -AROUND[:-1]])


def test_positions_stay_over_ten_turns_forwards_and_backwards() -> None:
    seen = 0
    for index in range(16):
        try:
            made = settled(drawn(46, index).linkage)
        except NotClosingError:
            continue
        once = np.linspace(0.0, TURN, 360, endpoint=False)
        q = (once + TURN * TURNS[:, None]).ravel()
        known, back = made.at(q, 0), made.at(q[::-1], 0)
        for dyad in made.dyads:
            seen += 1
            joint = place(known, dyad.joint)
            if dyad.kind.branches:
                assert np.all(side(dyad, known) * dyad.sign > 0.0), (index, dyad)
            assert np.array_equal(joint[::-1], place(back, dyad.joint))
            turns = joint.reshape(TURNS.size, -1)
            size = 100.0 + np.abs(joint).max()
            assert np.abs(turns - turns[0]).max() < 1e-10 * size, (index, dyad)
    assert seen > 16


def exact(function: Any, angles: Array, order: int = 3) -> list[Array]:
    """Value and derivatives by mpmath."""
    with mp.workdps(40):
        found = [[complex(x) for x in mp.diffs(function, mp.mpf(float(q)), order)] for q in angles]
    return list(np.array(found).T)


def parallel(q: Any) -> Any:
    """The far joint of a parallelogram with cranks of 50 and a base of 120."""
    return 120 + 50 * mp.expj(q)


def crossed(q: Any) -> Any:
    """The same of the anti-parallelogram: mirrored at the line from the pin to the far shaft."""
    return 120 + (50 * mp.expj(q) - 120) / (50 * mp.expj(-q) - 120) * 50 * mp.expj(-q)


def assert_same(made: Linkage, name: str, angles: Array, wanted: list[Array]) -> None:
    found = made.track(name, angles, 3).derivatives()
    for order, (one, other) in enumerate(zip(found, wanted, strict=True)):
        room = 1e-12 * 10.0**order * np.abs(other).max()
        assert np.abs(one - other).max() < room, (order, np.abs(one - other) / room)


class TestParallelogram:
    """All orders, in rows exactly at change points, beside them and far from them."""

    angles = (BESIDE + pi * np.array([-3, -2, -1, 0, 1, 2, 3, 18, 19, -19])[:, None]).ravel()

    def test_keeps_its_motion(self) -> None:
        made = settled(four_bar(50.0, 120.0, 50.0, 120.0, 1.0, "motion"))
        assert_same(made, "C", self.angles, exact(parallel, self.angles))

    def test_keeps_its_motion_crossed(self) -> None:
        made = settled(four_bar(50.0, 120.0, 50.0, 120.0, -1.0, "motion"))
        assert_same(made, "C", self.angles, exact(crossed, self.angles))

    @pytest.mark.parametrize("sign", [1.0, -1.0])
    def test_keeps_its_branch(self, sign: float) -> None:
        """At a change point itself as behind it."""
        made = settled(four_bar(50.0, 120.0, 50.0, 120.0, sign, "branch"))
        behind = np.floor((self.angles + 1e-11) / pi) % 2.0
        one, other = exact(parallel, self.angles), exact(crossed, self.angles)
        is_one = behind == (0.0 if sign > 0.0 else 1.0)
        wanted = [np.where(is_one, a, b) for a, b in zip(one, other, strict=True)]
        assert_same(made, "C", self.angles, wanted)

    def test_two_in_a_row(self) -> None:
        """Both change at the same angles."""
        parts = four_bar(50.0, 120.0, 50.0, 120.0, 1.0, "motion").elements
        more = Dyad("RRR", "C", "D2", "C2", ("link", "last"), Lengths(120.0, 50.0), keeps="motion")
        made = settled(linkage(*parts, MemberPoint("D2", 240 + 0j), more))
        assert all(one.changes for one in made.dyads)
        assert_same(made, "C2", self.angles, exact(lambda q: parallel(q) + 120, self.angles))

    def test_behind_a_pair(self) -> None:
        """One change point is at a knot of the pair's law, one between knots."""
        law = phases(*TWO_PHASES)
        made = settled(
            linkage(
                GivenMotion("q", law),
                MemberPoint("A", 0j),
                MemberPoint("D", 120 + 0j),
                Crank("crank", "q", "A", "B", 50.0),
                Dyad(
                    "RRR",
                    "B",
                    "D",
                    "C",
                    ("coupler", "rocker"),
                    Lengths(120.0, 50.0),
                    keeps="motion",
                ),
                knots_deg=TWO_PHASES[0],
            )
        )
        changes = made.dyads[0].changes
        assert len(changes) == 2
        angles = (np.array(changes)[:, None] + BESIDE).ravel()
        found = made.track("C", angles, 3).derivatives()
        with_order = made.track("B", angles, 3).derivatives()
        for order, (one, other) in enumerate(zip(found, with_order, strict=True)):
            wanted = other + 120.0 if order == 0 else other
            assert np.abs(one - wanted).max() < 1e-10 * 10.0**order


BEYOND = np.array([-0.1, -0.03, -0.021, -0.019, -0.011, -1e-3, 0.0, 1e-3, 0.011, 0.03, 0.1])
"""Angles from a change point, rad: nearer and farther than 0.02."""


def driven_by(law: Law, knots: Array) -> tuple[Linkage, Array]:
    """Parallelogram behind a law, and the angles beside its change point."""
    parts = list(four_bar(50.0, 120.0, 50.0, 120.0, 1.0, "motion").elements)
    parts = [GivenMotion("q", law) if one.gives == ("q",) else one for one in parts]
    made = settled(linkage(*parts, knots_deg=np.degrees(knots).tolist(), closed=False))
    (change,) = made.dyads[0].changes
    return made, change + BEYOND


def assert_parallel(made: Linkage, angles: Array) -> None:
    found, wanted = (made.track(name, angles, 3).derivatives() for name in "CB")
    wanted[0] = wanted[0] + 120.0
    for order, (one, other) in enumerate(zip(found, wanted, strict=True)):
        assert np.abs(one - other).max() < 1e-9 * 100.0**order, order


def test_law_that_bends_sharply_at_a_change_point() -> None:
    """Its series from there reaches 0.02 rad only."""

    def law(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order) - pi
        return x + pi + (jets.sqrt(x * x + 0.02**2) - 0.02) * 0.3

    assert_parallel(*driven_by(law, np.array([0.5, 5.0])))


def test_knot_beside_a_change_point() -> None:
    """The shaft speeds up 0.02 rad before: what is beyond the knot says nothing about it."""
    knot = pi - 0.02

    def law(q: Array, order: int) -> Jet:
        x, late = Jet.variable(q, order), q >= knot
        faster = (x - knot) * (x - knot) * 0.3
        return x + Jet([np.where(late, value, 0.0) for value in faster.c])

    assert_parallel(*driven_by(law, np.array([0.5, knot, 5.0])))


def test_slide_that_touches_its_limit() -> None:
    """A rod as long as it must be: in one place across the guide, where the slide may turn back."""
    angles = (BESIDE + 1.5 * pi + TURN * np.array([-3, -1, 0, 1, 2])[:, None]).ravel()
    angles = np.concatenate([angles, [0.0, 1.0, 3.0, 10.0]])

    def slide(q: Any) -> Any:
        root = mp.sqrt(50 * (130 - 50 * mp.sin(q))) * mp.sqrt(2)
        return 50 * mp.cos(q) + root * mp.sin(q / 2 + mp.pi / 4)

    made = settled(crank_slider(50.0, 90.0, 40.0, keeps="motion"))
    assert_same(made, "slide.guide2", angles, exact(slide, angles))
    stays = settled(crank_slider(50.0, 90.0, 40.0))
    places = stays.track("slide.guide2", angles, 0).c[0] - 50.0 * np.cos(angles)
    assert np.all(places >= -1e-9)


def test_signs_change_where_they_are_said_to() -> None:
    """The sign of the triangle's area at each side of a change point."""
    for keeps, there in (("branch", [1.0, 1.0]), ("motion", [1.0, -1.0])):
        made = settled(four_bar(50.0, 120.0, 50.0, 120.0, 1.0, keeps))
        for at in pi * np.array([1.0, 3.0, -1.0, 19.0]):
            known = made.at(at + np.array([-0.01, 0.01]), 0)
            assert np.array_equal(np.sign(side(made.dyads[0], known)), there)


def test_every_type_with_branches_can_touch_or_is_refused() -> None:
    """Types that would jam where their positions meet have no way through it."""
    assert {name for name, kind in DYADS.items() if kind.branches} == {
        "RRR",
        "RRT",
        "TRR",
        "RTR1",
        "RTR2",
    }
    made = linkage(
        MemberPoint("O", 0j),
        MemberPoint("D", 100 + 0j),
        Crank("crank", "q", "O", "pin", 60.0),
        Dyad("RTR1", "D", "pin", "block", ("guide", "slide"), Lengths(0.0, 40.0, 0.5 * pi)),
    )
    with pytest.raises(NotClosingError) as caught:
        settled(made)
    assert caught.value.closing.changes == pytest.approx((0.0,), abs=1e-9)
    assert caught.value.nearest[0][1] == pytest.approx(40.0 * 0.999)
