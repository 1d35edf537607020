"""Linkages whose values are known, and laws that drive them."""

from __future__ import annotations

from functools import partial

import numpy as np

from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import Crank, Dyad, GivenMotion, GuideLine, Law, MemberPoint
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

TURN: Array = np.array([0.0, 2.0 * np.pi], dtype=np.float64)


def even(q: Array, order: int) -> Jet:
    """Return the driver's own angle."""
    return Jet.variable(q, order)


def cosine_phases(knots_deg: list[float], ratios: list[float]) -> tuple[Law, Array]:
    """Return the driven angle of a pair whose ratio goes from one value to the next by cosines."""
    knots, begins = np.radians(knots_deg), [0.0]
    spans, middles = np.diff(knots), 0.5 * (np.array(ratios[1:]) + ratios[:-1])
    for span, middle in zip(spans, middles, strict=True):
        begins.append(begins[-1] + middle * span)

    def law(q: Array, order: int) -> Jet:
        k = np.clip(np.searchsorted(knots, q, "right") - 1, 0, len(spans) - 1)
        x = Jet.variable(q, order) - knots[k]
        swing = 0.5 * np.diff(ratios)[k] * spans[k] / np.pi
        wave = jets.sin(x * (np.pi / spans[k]))
        return x * middles[k] - wave * swing + np.array(begins)[k]

    return law, knots


def nail_machine(law: Law, knots: Array) -> Linkage:
    """Return crank 150, rod 750 and a slide whose place is its distance from the shaft."""
    parts = [
        GivenMotion("wheel2", law),
        MemberPoint("O", 0j),
        Crank("crank", "wheel2", "O", "pin", 150.0, np.pi),
        GuideLine("bed", 0j, 0.0),
        Dyad("RRT", "pin", "bed", "slide", ("rod", "ram"), Lengths(750.0, 0.0)),
    ]
    return Linkage(in_order(parts), knots)


def four_bar(
    base: float, lengths: tuple[float, float, float], point: complex = 0j, sign: float = 1.0
) -> Linkage:
    """Return a four-bar with an even crank and a point P of its coupler."""
    crank, coupler, rocker = lengths
    parts = [
        GivenMotion("q", even),
        MemberPoint("A", 0j),
        MemberPoint("D", complex(base)),
        Crank("crank", "q", "A", "B", crank),
        Dyad("RRR", "B", "D", "C", ("coupler", "rocker"), Lengths(coupler, rocker), sign),
        MemberPoint("P", point, "coupler"),
    ]
    return Linkage(in_order(parts), TURN)


COUPLER_POINT = 60.0 * np.exp(1j * np.radians(35.0))


def known_four_bar() -> Linkage:
    """Return the four-bar of the reference values."""
    return four_bar(110.0, (40.0, 120.0, 90.0), COUPLER_POINT)


def quick_return() -> Linkage:
    """Return a crank, a block on a swinging guide, and a ram."""
    parts = [
        GivenMotion("q", even),
        MemberPoint("O", 0j),
        MemberPoint("pivot", -150j),
        Crank("crank", "q", "O", "pin", 60.0),
        Dyad("RTR1", "pivot", "pin", "block", ("rocker", "slide"), Lengths(0.0, 0.0)),
        MemberPoint("E", 320.0, "rocker"),
        GuideLine("bed", 150j, 0.0),
        Dyad("RRT", "E", "bed", "ram", ("link", "tool"), Lengths(100.0, 0.0)),
    ]
    return Linkage(in_order(parts), TURN)


def measures(linkage: Linkage, name: str) -> TrackMeasures:
    """Return the measures of an output of a linkage."""
    track = partial(linkage.real_track, name)
    return TrackMeasures(track, linkage.knots, linkage.closed)


def six_bar_with_dwell() -> Linkage:
    """Return the six-bar of 000, fig. 2.118 a, with K and G as they must be; output ``arm``."""
    parts = [
        GivenMotion("q", even),
        MemberPoint("A", 0j),
        MemberPoint("D", 300.0),
        MemberPoint("G", 500.0 + 740.0j),
        Crank("crank", "q", "A", "B", 100.0),
        Dyad("RRR", "B", "D", "C", ("coupler", "rocker"), Lengths(300.0, 300.0)),
        MemberPoint("E", 600.0, "coupler"),
        Dyad("RRR", "E", "G", "F", ("link", "arm"), Lengths(379.0, 218.0)),
    ]
    return Linkage(in_order(parts), TURN)


def drawn_straight(coupler: float, base: float, angle: float) -> Linkage:
    """Return a linkage of 000, fig. 2.106: crank 100, coupler = rocker = CP, which P follows."""
    beyond = coupler * np.exp(1j * angle)
    return four_bar(base, (100.0, coupler, coupler), complex(coupler + beyond))
