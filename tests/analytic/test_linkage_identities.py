"""Random linkages: lengths and angles hold, or what is refused is open where it is said to be."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from gearcam.linkages.closing import Closing, NotClosingError, closing, settled
from gearcam.linkages.dyads import DYADS
from gearcam.linkages.elements import Dyad
from gearcam.linkages.known import Known
from gearcam.linkages.linkage import Linkage
from gearcam.numeric.arrays import Array
from helpers_dyad_loops import Loop
from helpers_random_linkages import TURN, Drawn, drawn, margin, misfit, place, side, with_lengths
from witness import linkages as witness

SEED = 45

BESIDE = 1e-7
"""Angle from the end of a range at which a linkage is looked at, rad."""


@dataclass(frozen=True)
class Refused:
    """A linkage that does not close, and what was said."""

    linkage: Linkage
    error: NotClosingError

    @property
    def dyad(self) -> Dyad:
        assert isinstance(self.error.closing.element, Dyad)
        return self.error.closing.element

    def margin(self, q: Array) -> Array:
        return margin(self.dyad, self.linkage.at(q, 0, self.dyad))


def sorted_out(number: int) -> tuple[list[tuple[Drawn, Linkage]], list[Refused]]:
    """Those of the first random linkages that close, and those that are refused."""
    closed, refused = [], []
    for index in range(number):
        one = drawn(SEED, index)
        try:
            closed.append((one, settled(one.linkage)))
        except NotClosingError as error:
            refused.append(Refused(one.linkage, error))
    return closed, refused


NUMBERS = [60, pytest.param(1000, marks=pytest.mark.slow)]


@pytest.fixture(scope="module", params=NUMBERS)
def linkages(request: pytest.FixtureRequest) -> tuple[list[tuple[Drawn, Linkage]], list[Refused]]:
    return sorted_out(request.param)


def test_all_types_and_signs_close_and_are_refused(linkages) -> None:
    closed, refused = linkages
    seen = Counter((dyad.type, dyad.sign) for _, made in closed for dyad in made.dyads)
    assert set(seen) == {(name, sign) for name in DYADS for sign in (1.0, -1.0)}
    assert {len(made.dyads) for _, made in closed} == {1, 2, 3, 4}
    can = {name for name, kind in DYADS.items() if kind.branches}
    assert {one.dyad.type for one in refused} >= can


def test_lengths_and_angles_hold(linkages) -> None:
    """At 1000 random angles, also over many turns; and the sign tells the position."""
    for number, (_, made) in enumerate(linkages[0]):
        q = np.random.default_rng(number).uniform(-5.0 * TURN, 5.0 * TURN, 1000)
        known = made.at(q, 0)
        for dyad in made.dyads:
            assert misfit(dyad, known).max() < 1e-13, (number, dyad)
            if DYADS[dyad.type].branches and not dyad.changes:
                assert np.all(side(dyad, known) * dyad.sign > 0.0), (number, dyad)


def test_ranges_of_refusals(linkages) -> None:
    """Just inside of them it closes, just outside not; elsewhere as a fine grid says."""
    for one in linkages[1]:
        found = one.error.closing
        for begin, end in found.ranges:
            for edge, inwards in ((begin, 1.0), (end, -1.0)):
                if abs(edge) < 1e-12 or abs(edge - TURN) < 1e-12:
                    continue  # the turn's end, or a range over it
                inside, outside = one.margin(edge + inwards * np.array([BESIDE, -BESIDE]))
                assert inside > 0.0 > outside, (edge, one.dyad)
        q = np.linspace(0.0, TURN, 2001)
        assert np.array_equal(one.margin(q) >= 0.0, within(q, found)), one.dyad


def within(q: Array, found: Closing) -> Array:
    """Whether angles are in one of the ranges, but for their ends."""
    return np.any(
        [
            (begin <= angle) & (angle <= end)
            for begin, end in found.ranges
            for angle in (q, q - TURN)
        ]
        or [np.zeros(q.shape, dtype=bool)],
        axis=0,
    )


def test_least_share_is_where_it_is_said(linkages) -> None:
    for one in linkages[1]:
        found = one.error.closing
        there = one.margin(np.array([found.place]))[0]
        if found.changes:
            assert abs(there) < 1e-5
        elif one.dyad.driven is None:  # or a share of a length that changes
            assert there < 0.0
            around = one.margin(found.place + np.array([-1e-3, 1e-3]))
            assert there <= around.min() + 1e-9


def test_offered_lengths_close(linkages) -> None:
    """Each offer makes the dyad close; one nearer to what was given does not."""
    offers = 0
    for one in linkages[1]:
        for lengths in one.error.nearest:
            offers += 1
            other, dyad = with_lengths(one.linkage, one.dyad, lengths)
            found = closing(other, dyad)
            assert found is not None
            assert found.least > 0.0, (one.dyad, lengths)
            if len(lengths) > 1:
                continue
            ((number, length),) = lengths.items()
            own = float(one.dyad.lengths[number])
            nearer = length + np.copysign(3e-3 * length, own - length)
            if abs(own - length) > 3e-3 * length:
                less = closing(*with_lengths(one.linkage, one.dyad, {number: nearer}))
                assert less is not None
                assert less.least < 0.0, (one.dyad, lengths)
        if one.dyad.type in ("RRR", "RRT", "TRR") and one.dyad.driven is None:
            assert one.error.nearest, one.dyad
    assert offers > 5


def test_places_by_angles_of_triangles(linkages) -> None:
    """Every joint, computed with 50 digits by angles instead of roots."""
    for number, (one, made) in enumerate(linkages[0]):
        q = float(np.random.default_rng(number).uniform(0.0, TURN))
        with witness.mp.workdps(50):
            wanted = witness.places(made, one.ways, witness.mp.mpf(q))
        known = made.at(np.array([q]), 0)
        for dyad in made.dyads:
            for name in (dyad.joint, f"M{dyad.joint[1:]}"):
                found, exact = known.jet(name).c[0][0], complex(wanted[name])
                assert abs(found - exact) < 1e-10 * (100.0 + abs(exact)), (number, dyad)


def firm(dyad: Dyad, known: Known) -> Any:
    """Whether a dyad is far from where its positions meet."""
    if dyad.type == "TRT":
        return margin(dyad, known) > 0.02
    return margin(dyad, known) > 0.02 * float(np.real(max(dyad.lengths[:2])))  # pyright: ignore[reportArgumentType]


def test_loops_close_by_newton_iteration(linkages) -> None:
    """From a place beside the position the iteration finds it, from a mirrored one the other."""
    mirrored: set[str] = set()
    for number, (_, made) in enumerate(linkages[0]):
        rng = np.random.default_rng(number)
        known = made.at(rng.uniform(0.0, TURN, 20), 0)
        for dyad in made.dyads:
            loop, chosen = Loop(dyad, known), firm(dyad, known)
            if not chosen.any():
                continue
            size, at = 100.0 + np.abs(place(known, dyad.joint)), loop.found()
            assert np.all((np.abs(loop.step(at)).max(axis=0) < 1e-11 * size)[chosen]), dyad
            beside = at + rng.uniform(-1e-2, 1e-2, at.shape)
            miss = np.abs(loop.joint(loop.solved(beside)) - place(known, dyad.joint))
            assert np.all((miss < 1e-11 * size)[chosen]), (number, dyad)
            if not dyad.kind.branches:
                continue
            other = replace(dyad, sign=-dyad.sign).solution(known).joint.c[0]
            guess = loop.mirrored() + rng.uniform(-1e-2, 1e-2, at.shape)
            miss = np.abs(loop.joint(loop.solved(guess)) - other)
            assert np.all((miss < 1e-11 * size)[chosen]), (number, dyad)
            assert np.all((np.abs(other - place(known, dyad.joint)) > 1e-3 * size)[chosen])
            mirrored.add(dyad.type)
    assert mirrored == {name for name, kind in DYADS.items() if kind.branches}


def test_derivatives_by_fifty_digits(linkages) -> None:
    """Three orders of every joint, against numerical derivatives of the positions by angles."""
    for number, (one, made) in enumerate(linkages[0][:60]):
        q = float(np.random.default_rng(number).uniform(0.0, TURN))
        known = made.at(np.array([q]), 0)
        if not all(firm(dyad, known).all() for dyad in made.dyads):
            continue
        for dyad in made.dyads:
            exact = witness.derivatives(made, one.ways, dyad.joint, q, 3)
            found = made.track(dyad.joint, np.array([q]), 3).derivatives()
            for value, wanted in zip(found, exact, strict=True):
                assert abs(value[0] - wanted) < 1e-9 * (100.0 + abs(wanted)), (number, dyad)


def test_a_guide_moved_by_a_micrometre_is_noticed(linkages) -> None:
    """By the lengths and angles of the dyads on it, which held before."""
    seen = 0
    for _, made in linkages[0]:
        q = np.linspace(0.0, TURN, 7)
        known = made.at(q, 0)
        for dyad in made.dyads:
            for name in {dyad.first, dyad.second} & {"bed", "post", "slot"}:
                frame = known.frame(name)
                known.given[name] = frame._replace(origin=frame.origin + frame.direction * 1e-3j)
                assert misfit(dyad, known).min() > 1e-10
                known.given[name] = frame
                assert misfit(dyad, known).max() < 1e-13
                seen += 1
    assert seen > 10
