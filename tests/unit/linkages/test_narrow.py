"""Where a part is nearly singular it moves fast, which all searches for extremes see."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import mpmath
import numpy as np
import pytest

from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import Crank, Dyad, GivenMotion, GuideLine, MemberPoint
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_linkages import crank_slider, four_bar, linkage, swinging_guide
from helpers_measured import TURN, even
from helpers_sampling import few

mp: Any = mpmath

CRANK = 100.0

GAPS = [0.1, 1e-3, 1e-6, 1e-9]
"""Distances of a length from that of the change point, as shares of the base."""


def _twice(q: Array, order: int) -> Jet:
    return Jet.variable(q, order) * 2.0


def _measured(made: Linkage, name: str) -> TrackMeasures:
    found = settled(made)
    return TrackMeasures(partial(found.real_track, name), found.knots, found.closed)


@pytest.mark.parametrize("gap", [1.0, 0.01, 1e-4])
def test_a_pin_that_passes_the_pivot_twice(gap: float) -> None:
    """The pin goes round the pivot twice in a turn; the pivot is nearer to it the second time."""
    made = Linkage(
        [
            GivenMotion("fast", _twice),
            GivenMotion("slow", even),
            MemberPoint("O", 0j),
            Crank("crank", "fast", "O", "A", CRANK, 0.3137),
            MemberPoint("Q", complex(gap - CRANK)),
            Crank("wobble", "slow", "Q", "P", 0.49 * gap, 1.234),
            Dyad("RTR1", "P", "A", "B", ("rocker", "block"), Lengths(0.0, 0.0)),
        ],
        TURN,
    )
    angle = _measured(made, "rocker.angle")
    assert angle.rise == pytest.approx(4.0 * math.pi, rel=1e-12)
    assert angle.dead_centers == ()


def _largest(track: Callable[[Any], Any], order: int, width: float) -> float:
    """Return the largest size of a derivative up to a quarter turn after 0, by mpmath."""

    def size(h: Any) -> Any:
        return abs(mp.diff(track, h, order))

    places = [0.0, *np.geomspace(0.1 * width, 0.5 * math.pi, 40 + round(-8.0 * math.log10(width)))]
    values = [size(h) for h in places]
    best = int(np.argmax(values))
    low, high = places[max(best - 1, 0)], places[min(best + 1, len(places) - 1)]
    for _ in range(30):  # golden section: the top is flat
        one, other = high - 0.618 * (high - low), low + 0.618 * (high - low)
        low, high = (low, other) if size(one) > size(other) else (one, high)
    return float(max(size(0.5 * (low + high)), values[best]))


@pytest.mark.parametrize("gap", few(GAPS))
def test_peaks_of_a_slider_near_its_change_points(gap: float) -> None:
    """Its place is ``-r*sin(h) + sqrt(l^2 - r^2*cos(h)^2)``, h from where the crank is across.

    The motion about both places is the same, one way and the other.
    """
    rod, crank = 100.0, 100.0 - 100.0 * gap
    found = _measured(crank_slider(crank, rod), "slide.guide2")
    with mp.workdps(30):
        r, whole = mp.mpf(crank), mp.mpf(rod)

        def place(h: Any) -> Any:
            return mp.sqrt(whole**2 - (r * mp.cos(h)) ** 2) - r * mp.sin(h)

        for order in (1, 2, 3):
            sides = (_largest(lambda h, s=s: place(s * h), order, gap**0.5) for s in (1, -1))
            wanted, room = max(sides), 1e-9 + 1e-15 / gap  # rounding of the lengths
            assert abs(found.size(order).value) == pytest.approx(wanted, rel=room)


def test_peaks_at_the_change_points() -> None:
    """With equal lengths it moves by ``2*r*cos(q)``, or stands still behind the change point."""
    moves = _measured(crank_slider(100.0, 100.0, keeps="motion"), "slide.guide2")
    stands = _measured(crank_slider(100.0, 100.0), "slide.guide2")
    for found in (moves, stands):
        assert [abs(found.size(k).value) for k in (1, 2, 3)] == pytest.approx([200.0] * 3, 1e-12)


def _four_bar(gap: float) -> tuple[Linkage, str, float]:
    return four_bar(30.0, 80.0, 50.0 + gap, 100.0), "rocker.angle", math.pi


def _folded(gap: float) -> tuple[Linkage, str, float]:
    return four_bar(30.0, 80.0, 150.0 - gap, 100.0), "coupler.angle", 0.0


def _offset(gap: float) -> tuple[Linkage, str, float]:
    return crank_slider(50.0, 90.0 + gap, 40.0), "slide.guide2", 1.5 * math.pi


def _guide(gap: float) -> tuple[Linkage, str, float]:
    return swinging_guide(60.0, 60.0 + gap), "guide.angle", 1.5 * math.pi


def _block(gap: float) -> tuple[Linkage, str, float]:
    """The block's arm is nearly as long as the distance of its pin from the pivot."""
    parts = [one for one in swinging_guide(60.0, 100.0).elements if not isinstance(one, Dyad)]
    sizes = Lengths(0.0, 40.0 - gap, 0.5 * math.pi)
    dyad = Dyad("RTR1", "pivot", "pin", "block", ("guide", "slide"), sizes)
    return linkage(*parts, dyad), "guide.angle", 1.5 * math.pi


def _parallel(gap: float) -> tuple[Linkage, str, float]:
    """A guide on the rocker of a four-bar comes nearly parallel to one that stands still."""
    bar = four_bar()
    top = _measured(bar, "rocker.angle").largest()
    more = (
        GuideLine("one", 0j, 0.0, "rocker"),
        GuideLine("two", 200 + 50j, top.value + 1e-1 * gap),
        Dyad("TRT", "one", "two", "X", ("m", "n"), Lengths(0.0, 0.0, 0.0, 1.5, 1.5)),
    )
    return linkage(*bar.elements, *more), "X.guide2", top.place


def _two(gap: float) -> tuple[Linkage, str, float]:
    """Where the first dyad moves fastest, the second one is nearly singular too."""
    bar = _four_bar(gap)[0]
    top = _measured(bar, "C.y").largest()
    more = (
        GuideLine("bed", 0j, 0.0),
        Dyad("RRT", "C", "bed", "S", ("rod", "ram"), Lengths(top.value + gap, 0.0)),
    )
    return linkage(*bar.elements, *more), "S.guide2", top.place


def _open(gap: float) -> tuple[Linkage, str, float]:
    """The driver's range ends where the rod is nearly across."""
    end = math.asin(0.8)
    made = crank_slider(50.0, 80.0 + gap, -40.0, knots_deg=(-90.0, math.degrees(end)))
    return Linkage(made.elements, made.knots, closed=False), "slide.guide2", end


def _slow(gap: float) -> tuple[Linkage, str, float]:
    """Ten turns of the crank are one cycle."""
    bar = _four_bar(gap)[0]
    parts = [one for one in bar.elements if not isinstance(one, GivenMotion)]
    fast = GivenMotion("q", lambda q, order: Jet.variable(q, order) * 10.0)
    return linkage(fast, *parts), "rocker.angle", 0.1 * math.pi


NEARLY = [_four_bar, _folded, _offset, _guide, _block, _parallel, _two, _open, _slow]


@pytest.mark.parametrize("gap", few([1e-5, 3.0, 1e-3, 0.1]))
@pytest.mark.parametrize("nearly", NEARLY)
def test_no_place_has_more_than_the_peaks(
    nearly: Callable[[float], tuple[Linkage, str, float]], gap: float
) -> None:
    """Against 24000 places about the nearly singular one, and all over the range."""
    made, name, at = nearly(gap)
    found = _measured(made, name)
    low, high = found.span
    beside = np.geomspace(1e-9, 3.0, 10000)
    q = np.concatenate([at - beside, [at], at + beside, np.linspace(low, high, 4000)])
    q = low + np.mod(q - low, high - low) if found.closed else q[(q >= low) & (q <= high)]
    seen = found.track(q, 3).derivatives()
    for order in (0, 1, 2, 3):
        largest, least = found.largest(order).value, found.least(order).value
        room = 1e-5 * np.abs(seen[order]).max()
        assert largest == pytest.approx(seen[order].max(), abs=room)
        assert least == pytest.approx(seen[order].min(), abs=room)


def _kite(room: float, *, start: float = 0.0, rods: tuple[float, float] = (90.0, 90.0)) -> Linkage:
    """The crank's pin comes within `room` of the rocker's pivot."""
    return linkage(
        MemberPoint("A", 0j),
        MemberPoint("D", complex(40.0 + room)),
        Crank("crank", "q", "A", "B", 40.0, start),
        Dyad("RRR", "B", "D", "C", ("coupler", "rocker"), Lengths(*rods)),
    )


def _rocker(room: float) -> Callable[[Any], Any]:
    """The rocker's angle from straight up over the crank's angle, with rods of 90 mm."""
    base = mp.mpf(40.0 + room)

    def angle(q: Any) -> Any:
        pin = 40 * mp.expj(q)
        way = base - pin
        height = mp.sqrt(8100 - abs(way) ** 2 / 4) / abs(way)
        return mp.arg((pin + way * (0.5 + 1j * height) - base) / 1j)

    return angle


@pytest.mark.parametrize("room", few([1e-2, 1e-3, 1.5e-4, 1e-4, 5e-5, 1e-5, 4.2e-6], 3))
@pytest.mark.parametrize("start", [0.0, 1.0])
def test_a_kite_beside_its_change_point(room: float, start: float) -> None:
    """Where the pin is nearest the rocker turns by ``-a/room``, and all but half a turn in all."""
    made = settled(_kite(room, start=start))
    assert not made.dyads[0].changes
    found = TrackMeasures(partial(made.real_track, "rocker.angle"), made.knots)
    with mp.workdps(30):
        angle = _rocker(room)
        least = float(mp.mpf(40.0 + room) - 40)
        assert float(mp.diff(angle, 0)) == pytest.approx(-40.0 / least, rel=1e-12)
        turn = sum(_largest(lambda h, s=s: angle(s * h), 0, room / 40.0) for s in (-1, 1))
    fastest = found.track(np.array([-start % TURN[1]]), 1).derivatives()[1][0]
    assert fastest == pytest.approx(-40.0 / least, rel=1e-8)
    assert abs(found.size(1).value) == pytest.approx(40.0 / least, rel=1e-6)
    assert found.stroke == pytest.approx(turn, abs=1e-9)


@pytest.mark.parametrize("room", [3.9e-6, 1e-7, 1e-8, 1e-9])
def test_a_kite_that_double_precision_does_not_resolve(room: float) -> None:
    with pytest.raises(NotClosingError) as caught:
        settled(_kite(room))
    assert caught.value.resolved is not None
    own, least = caught.value.resolved
    assert own == pytest.approx(room, rel=1e-6)
    settled(_kite(least))
    assert caught.value.closing.meets


@pytest.mark.parametrize("more", [1e-2, 1e-5])
def test_a_change_point_where_the_outer_joints_almost_meet(more: float) -> None:
    """Rods as different as their ends come near: there it turns by ``-2*a/more`` on one side."""
    made = settled(_kite(more, start=1.0, rods=(90.0 + more, 90.0)))
    assert len(made.dyads[0].changes) == 1
    found = TrackMeasures(partial(made.real_track, "rocker.angle"), made.knots)
    assert abs(found.size(1).value) == pytest.approx(80.0 / more, rel=2e-4)


@pytest.mark.parametrize("room", few(10.0**-power for power in range(2, 10)))
def test_a_four_bar_beside_its_change_point(room: float) -> None:
    """Folded where the crank is in line: ``distance - (b - c) = room``; peaks by mpmath."""
    crank, coupler, rocker, base = 40.0, 120.0, 50.0, 110.0 + room
    made = settled(four_bar(crank, coupler, rocker, base))
    assert not made.dyads[0].changes
    found = TrackMeasures(partial(made.real_track, "rocker.angle"), made.knots)
    with mp.workdps(30):

        def angle(q: Any) -> Any:
            pin = crank * mp.expj(q)
            way = base - pin
            square = abs(way) ** 2
            along = (mp.mpf(coupler) ** 2 - mp.mpf(rocker) ** 2 + square) / (2 * square)
            height = mp.sqrt(mp.mpf(coupler) ** 2 / square - along**2)
            return mp.arg(pin + way * (along + 1j * height) - base)

        wanted = _largest(angle, 1, math.sqrt(room))
        wanted = max(wanted, _largest(lambda h: angle(-h), 1, math.sqrt(room)))
    assert abs(found.size(1).value) == pytest.approx(wanted, rel=1e-6 + 1e-14 / room)
