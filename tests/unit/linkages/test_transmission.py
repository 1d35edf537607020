"""Pressure angles and guide distances against printed values and closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.linkages.closing import settled
from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import Crank, Dyad, GivenMotion, GuideLine, MemberPoint
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.linkages.transmission import (
    ADMISSIBLE,
    guide_distance,
    pressure_angle,
    transmissions,
)
from helpers_measured import (
    TURN,
    even,
    four_bar,
    known_four_bar,
    nail_machine,
    quick_return,
)


def test_the_transmission_angle_of_a_four_bar() -> None:
    linkage = known_four_bar()
    known = linkage.at(np.radians([0.0, 30.0, 120.0, 180.0, 330.0]), 0)
    angle = 90.0 - np.degrees(pressure_angle(known, linkage.dyads[0]))
    expected = [35.4309446873, 40.5152947943, 78.2463743831, 90.0, 40.5152947943]
    assert angle == pytest.approx(expected, abs=1e-10)
    (worst,) = transmissions(linkage)
    assert worst.pressure_angle is not None
    assert np.degrees(worst.pressure_angle.value) == pytest.approx(54.5690553127, abs=1e-10)
    assert worst.pressure_angle.place == 0.0
    assert worst.share == pytest.approx(np.sin(np.radians(35.4309446873)), abs=1e-12)
    assert worst.distance is None


def test_the_pressure_angle_of_a_crank_slider() -> None:
    linkage = nail_machine(even, TURN)
    (worst,) = transmissions(linkage)
    assert worst.pressure_angle is not None
    assert worst.pressure_angle.value == pytest.approx(np.arcsin(0.2), rel=1e-14)
    assert np.degrees(worst.pressure_angle.place) % 180.0 == pytest.approx(90.0, abs=1e-12)


@pytest.mark.parametrize("side", [1, -1])
def test_a_rod_that_stands_nearly_across_its_guide(side: int) -> None:
    spare = 2.0**-36
    parts = [
        GivenMotion("q", even),
        MemberPoint("O", 0j),
        Crank("crank", "q", "O", "pin", 50.0),
        GuideLine("bed", side * 40j, 0.0),
        Dyad("RRT", "pin", "bed", "slide", ("rod", "ram"), Lengths(90.0 + spare, 0.0)),
    ]
    (worst,) = transmissions(Linkage(in_order(parts), TURN))
    assert worst.pressure_angle is not None
    left = np.pi / 2 - worst.pressure_angle.value
    # the cosine of the angle is the root of (l - 90)*(l + 90)/l^2
    assert left == pytest.approx(np.sqrt(2.0 * spare / 90.0), rel=3e-5)
    assert np.degrees(worst.pressure_angle.place) == pytest.approx(180.0 + 90.0 * side, abs=1e-5)


@pytest.mark.parametrize("kind", ["TRR", "RRT"])
def test_a_rod_between_a_slide_and_a_turning_guide(kind: str) -> None:
    guide = GuideLine("bed", 0j, 0.3, "crank")
    ends = ("fixed", "bed") if kind == "RRT" else ("bed", "fixed")
    lengths = Lengths(100.0, 0.0) if kind == "RRT" else Lengths(0.0, 100.0)
    parts = [
        GivenMotion("q", even),
        MemberPoint("O", 0j),
        MemberPoint("fixed", 60.0 + 0j),
        Crank("crank", "q", "O", "pin", 50.0),
        guide,
        Dyad(kind, *ends, "B", ("one", "two"), lengths),
    ]
    (worst,) = transmissions(Linkage(in_order(parts), TURN))
    assert worst.pressure_angle is not None
    # the joint's distance from the guide is 60*|sin(q + 0.3)|
    assert worst.pressure_angle.value == pytest.approx(np.arcsin(0.6), rel=1e-14)
    assert (worst.pressure_angle.place + 0.3) % np.pi == pytest.approx(np.pi / 2, abs=1e-13)


def test_the_distance_of_a_swinging_guide() -> None:
    linkage = quick_return()
    guide, rod = transmissions(linkage)
    assert guide.pressure_angle is None
    assert guide.distance is not None
    assert guide.distance.value == pytest.approx(90.0, rel=1e-14)
    assert np.degrees(guide.distance.place) == pytest.approx(270.0, abs=1e-11)
    assert guide.share == 1.0
    assert rod.pressure_angle is not None


@pytest.mark.parametrize(("kind", "lengths"), [("RTR1", (0.0, 30.0)), ("RTR2", (30.0, 0.0))])
def test_the_distance_of_a_guide_with_an_arm(kind: str, lengths: tuple[float, float]) -> None:
    parts = [
        GivenMotion("q", even),
        MemberPoint("O", 0j),
        MemberPoint("pivot", 100.0 + 0j),
        Crank("crank", "q", "O", "pin", 40.0),
        Dyad(kind, "pivot", "pin", "B", ("one", "two"), Lengths(*lengths, beta=np.pi / 6)),
    ]
    linkage = Linkage(in_order(parts), TURN)
    (worst,) = transmissions(linkage)
    assert worst.distance is not None
    assert worst.distance.value == pytest.approx(np.sqrt(60.0**2 - 15.0**2), rel=1e-14)
    assert worst.share == pytest.approx(np.sqrt(1.0 - 1.0 / 16.0), rel=1e-14)
    known = linkage.at(np.array([0.0, 1.0]), 2)
    # the same from the slide's own place: l = l0 + arm*cos(beta)
    slide = known.jet("B.member1" if kind == "RTR1" else "B.member2")
    own = slide - 30.0 * np.cos(np.pi / 6)
    distance = guide_distance(known, linkage.dyads[0])
    for got, wanted in zip(distance.c, (own * own).c, strict=True):
        assert got == pytest.approx(wanted, rel=1e-12)
    with pytest.raises(ValueError, match=r"RTR\d has no pressure angle; allowed are RRR, RRT"):
        pressure_angle(known, linkage.dyads[0])


def test_the_angle_between_two_guides() -> None:
    parts = [
        GivenMotion("q", lambda q, order: even(q, order) * 0.25),
        MemberPoint("O", 0j),
        Crank("crank", "q", "O", "pin", 40.0, 0.2),
        GuideLine("turning", 5j, 0.0, "crank"),
        GuideLine("bed", 30.0 + 0j, 0.0),
        Dyad("TRT", "turning", "bed", "B", ("one", "two"), Lengths(0.0, 0.0)),
    ]
    (worst,) = transmissions(Linkage(in_order(parts), TURN, closed=False))
    assert worst.pressure_angle is not None
    # the guides are at 0.2 to 0.2 + pi/2 to each other
    assert worst.pressure_angle == pytest.approx((np.pi / 2 - 0.2, 0.0), abs=1e-12)


@pytest.mark.parametrize("kind", ["RTT", "TTR"])
def test_a_constant_angle_between_guide_and_member(kind: str) -> None:
    slanted = float(np.radians(70.0))
    dyad = Dyad("RTT", "pin", "bed", "B", ("one", "two"), Lengths(10.0, 0.0, 0.5, gamma2=slanted))
    if kind == "TTR":
        sizes = Lengths(0.0, 10.0, -0.5, gamma1=slanted)
        dyad = Dyad("TTR", "bed", "pin", "B", ("one", "two"), sizes)
    parts = [
        GivenMotion("q", even),
        MemberPoint("O", 0j),
        Crank("crank", "q", "O", "pin", 40.0),
        GuideLine("bed", 30.0 + 0j, 0.1),
        dyad,
    ]
    (worst,) = transmissions(Linkage(in_order(parts), TURN))
    assert worst.pressure_angle is not None
    assert np.degrees(worst.pressure_angle.value) == pytest.approx(20.0, abs=1e-12)


def test_a_parallelogram_goes_through_90_degrees() -> None:
    (worst,) = transmissions(settled(four_bar(120.0, (50.0, 120.0, 50.0))))
    assert worst.pressure_angle is not None
    assert worst.pressure_angle.value == pytest.approx(np.pi / 2, abs=1e-9)
    assert worst.share == pytest.approx(0.0, abs=1e-9)


def test_admissible_values_of_the_source() -> None:
    assert np.degrees(ADMISSIBLE["RRR"].pressure_angle) == pytest.approx((45.0, 60.0))
    assert np.degrees(ADMISSIBLE["RRT"].pressure_angle) == pytest.approx((30.0, 45.0))
    assert ADMISSIBLE["RTR1"].distance == (0.2, 0.1)
