"""Dyads and linkages against numbers known to twelve digits: places, speeds, accelerations."""

from __future__ import annotations

import math
from math import pi, radians

import numpy as np
import pytest

from gearcam.linkages.chain import LeverChain, roots_in
from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.dyads import DYADS, Lengths, Solved
from gearcam.linkages.elements import Crank, Dyad, Element, GivenMotion, GuideLine, Law, MemberPoint
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.plane import Frame, imaginary, real, rotation, towards
from gearcam.numeric.arrays import Array
from gearcam.numeric.piecewise import extremes
from helpers_linkages import (
    THREE_PHASES,
    TURN,
    TWO_PHASES,
    agree,
    angles_agree,
    column,
    crank_slider,
    derivatives,
    four_bar,
    halve_products_of_speeds,
    linkage,
    phases,
    rows,
    state,
    swinging_guide,
    turned,
    variable,
)

JOINTS = (
    state(10 + 5j, 120 - 80j, -900 + 1500j),
    state(130 + 25j, -60 + 140j, 700 - 400j),
)
GUIDES = (
    Frame(state(-20j, 50 + 30j, 200 - 600j), towards(state(radians(25.0), 3.0, -12.0))),
    Frame(state(150 - 30j, -40 + 25j, -300 + 500j), towards(state(radians(100.0), -2.0, 9.0))),
)
"""What the outer joints and the guides of all dyads do at t = 0."""

NAMES = {"guide1": "guide1", "guide2": "guide2", "slide1": "member1", "slide2": "member2"}
"""Columns of slides, and what they are of."""

SIXTY_RPM = TURN


def solved(row: dict[str, str], guides: tuple[Frame, Frame] = GUIDES) -> Solved:
    """The dyad of a row of the table."""
    kind = DYADS[row["dyad"]]
    ends = [guides[k] if guided else JOINTS[k] for k, guided in enumerate(kind.guides)]
    sizes = Lengths(
        float(row["first"]),
        float(row["second"]),
        *(radians(float(row[f"{name}_deg"])) for name in ("beta", "gamma1", "gamma2")),
    )
    return kind.solve(*ends, sizes, float(row["sign"]))


def assert_printed(row: dict[str, str], found: Solved, orders: int = 3) -> None:
    """Joint, members and slides as in a row of the table: places, speeds, accelerations."""
    for part, names in ((real, ("x", "vx", "ax")), (imaginary, ("y", "vy", "ay"))):
        for value, name in zip(part(found.joint).derivatives()[:orders], names, strict=False):
            agree(value, float(row[name]), 100.0)
    for frame, member in zip(found.frames, ("member1", "member2"), strict=True):
        if row[f"{member}_deg"]:
            angle, *rates = rotation(frame.direction).derivatives()[:orders]
            angles_agree(angle, float(row[f"{member}_deg"]))
            for value, name in zip(rates, ("omega", "epsilon"), strict=False):
                agree(value, float(row[f"{member}_{name}"]), 100.0)
    for name, slide in NAMES.items():
        if row[name]:
            values = found.slides[slide].derivatives()[:orders]
            for value, ending in zip(values, ("", "_v", "_a"), strict=False):
                agree(value, float(row[name + ending]), 1000.0)


def named(row: dict[str, str]) -> str:
    return "{dyad} {first} {second} {beta_deg} {gamma1_deg} {gamma2_deg} {sign}".format(**row)


@pytest.mark.parametrize("row", rows("dyads"), ids=named)
def test_dyads(row: dict[str, str]) -> None:
    """Every type, with every sign."""
    assert_printed(row, solved(row))


class TestFaultsAreNoticed:
    """What would be wrong in a linkage is wrong in the table."""

    @pytest.mark.parametrize(
        "row", [r for r in rows("dyads") if DYADS[r["dyad"]].branches], ids=named
    )
    def test_the_other_sign(self, row: dict[str, str]) -> None:
        with pytest.raises(AssertionError):
            assert_printed(row, solved(row | {"sign": str(-float(row["sign"]))}), 1)

    @pytest.mark.parametrize(
        "row", [r for r in rows("dyads") if any(DYADS[r["dyad"]].guides)], ids=named
    )
    @pytest.mark.parametrize("along", [1e-3, 1e-3j])
    def test_a_guide_moved_by_a_micrometre(self, row: dict[str, str], along: complex) -> None:
        """Along itself its slide's place changes, across itself more."""
        moved = [frame._replace(origin=frame.origin + frame.direction * along) for frame in GUIDES]
        with pytest.raises(AssertionError):
            assert_printed(row, solved(row, (moved[0], moved[1])), 1)

    def test_half_of_a_coriolis_acceleration(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The product of two speeds counts once: places and speeds stay right."""
        halve_products_of_speeds(monkeypatch)
        for row in rows("dyads"):
            assert_printed(row, solved(row), 2)
            with pytest.raises(AssertionError):
                assert_printed(row, solved(row))
        points = [row for row in rows("four_bar") if row["sign"] == "1"][:12]
        place, speed, _ = derivatives(four_bar(), "P.x", column(points, "crank_deg"), 2)
        agree(place, column(points, "xP"))
        agree(speed * 10.0, column(points, "vPx"))


def test_every_type_and_sign_is_in_the_table() -> None:
    table = rows("dyads")
    assert {row["dyad"] for row in table} == set(DYADS)
    for name, kind in DYADS.items():
        signs = {row["sign"] for row in table if row["dyad"] == name}
        assert signs == ({"1", "-1"} if kind.branches else {"1"})


@pytest.mark.parametrize(("sign", "epsilon"), [(1, 0.0), (-1, 0.0), (1, 25.0)])
def test_four_bar_with_a_coupler_point(sign: int, epsilon: float) -> None:
    """Both positions; the crank turning evenly, and speeding up."""
    table = [
        row
        for row in rows("four_bar")
        if float(row["eps1"]) == epsilon and int(row["sign"]) == sign
    ]
    assert table
    made, degrees, omega = four_bar(sign=float(sign)), column(table, "crank_deg"), 10.0

    def in_time(name: str) -> tuple[Array, Array, Array]:
        place, first, second = derivatives(made, name, degrees, 2)
        return place, first * omega, second * omega**2 + first * epsilon

    for name, number in (("coupler", 2), ("rocker", 3)):
        angle, speed, acceleration = in_time(f"{name}.angle")
        angles_agree(angle, column(table, f"{name}_deg"))
        agree(speed, column(table, f"omega{number}"))
        agree(acceleration, column(table, f"eps{number}"))
    for axis in "xy":
        for found, what in zip(in_time(f"P.{axis}"), ("", "v", "a"), strict=True):
            agree(found, column(table, f"{what}{axis}P" if not what else f"{what}P{axis}"))


def test_limits_of_the_rocker() -> None:
    """Crank and coupler in line: the rocker stands, its angle is an extreme."""
    made = four_bar()
    crank = radians(32.7637577589), radians(233.77845338)
    value, slope, _ = derivatives(made, "rocker.angle", np.degrees(crank), 2)
    angles_agree(value, np.array([74.1733798681, 134.184385153]))
    assert np.abs(slope).max() < 1e-11

    def turning(q: Array) -> tuple[Array, Array]:
        first, second = made.track("rocker.angle", q, 1).derivatives()
        return first, second

    places, values = extremes(turning, made.knots)
    agree(math.degrees(values.max() - values.min()), 60.0110052852)
    for place in crank:
        assert np.abs(places - place).min() < 1e-7  # flat there


@pytest.mark.parametrize(
    ("pair", "law", "knots"),
    [
        ("none", variable, (0.0, 360.0)),
        ("two", phases(*TWO_PHASES), TWO_PHASES[0]),
        ("three", phases(*THREE_PHASES), THREE_PHASES[0]),
    ],
)
class TestNailMachine:
    """A crank-slider behind a pair, at 180 rpm of the driver."""

    def machine(self, law: Law, knots: tuple[float, ...]) -> Linkage:
        return crank_slider(150.0, 750.0, law=law, start=pi, knots_deg=knots)

    def test_slide(self, pair: str, law: Law, knots: tuple[float, ...]) -> None:
        table = [row for row in rows("nail_machine") if row["pair"] == pair]
        made, degrees = self.machine(law, knots), column(table, "phi1_deg")
        turn, ratio = derivatives(made, "q", degrees, 1)
        agree(np.degrees(turn), column(table, "phi2_deg"))
        agree(ratio, column(table, "i21"))
        found = derivatives(made, "slide.guide2", degrees, 3)
        for value, name in zip(found, ("s", "s1", "s2", "s3"), strict=True):
            agree(value, column(table, name), 1000.0)
        omega = 180.0 * TURN / 60.0
        agree(1e-3 * found[1] * omega, column(table, "v_m_s"))
        agree(1e-3 * found[2] * omega**2, column(table, "a_m_s2"))


def test_quick_return() -> None:
    """A crank, a block on a swinging guide, a ram that its end pushes."""
    table = rows("quick_return")
    made = settled(
        swinging_guide(
            60.0,
            150.0,
            MemberPoint("E", 320.0 + 0j, "guide"),
            GuideLine("bed", 150j, 0.0),
            Dyad("RRT", "E", "bed", "ram", ("link", "slider"), Lengths(100.0, 0.0)),
        )
    )
    degrees = column(table, "crank_deg")
    angle, omega, epsilon = derivatives(made, "guide.angle", degrees, 2)
    angles_agree(angle, column(table, "rocker_deg"))
    agree(omega * SIXTY_RPM, column(table, "omega"))
    agree(epsilon * SIXTY_RPM**2, column(table, "eps"))
    place, speed = derivatives(made, "block.member1", degrees, 1)
    agree(place, column(table, "block"))
    agree(speed * SIXTY_RPM, column(table, "block_v"))
    for order, (value, name) in enumerate(
        zip(derivatives(made, "ram.guide2", degrees, 2), ("ram", "ram_v", "ram_a"), strict=True)
    ):
        agree(value * SIXTY_RPM**order, column(table, name))
    at = np.array([203.578178478, 336.421821522])
    ends, slope = derivatives(made, "ram.x", at, 1)
    agree(ends, np.array([-28.225721319, 227.774278681]))
    assert np.abs(slope).max() < 1e-8


class TestFurnaceDoor:
    """A chain that wheel 2 winds up, at 0.8 rad/s of wheel 1."""

    knots = (0.0, 10.0, 60.0, 171.65)
    law = staticmethod(phases(knots, (1.0, 1.0, 2.0, 2.0)))

    def test_lifted(self) -> None:
        table = rows("door_lifted")
        turn = self.law(np.radians(column(table, "phi1_deg")), 2).derivatives()
        agree(np.degrees(turn[0]), column(table, "phi2_deg"))
        agree(100.0 * turn[0], column(table, "lift"))
        agree(turn[1], column(table, "i21"))
        agree(100.0 * turn[1] * 0.8, column(table, "v"))
        agree(100.0 * turn[2] * 0.8**2, column(table, "a"))

    def door(self) -> LeverChain:
        limits = radians(-90.0), radians(-30.0)
        length = 1735.30026219493133
        return LeverChain(
            "door", "B", "q", 0j, 600 + 300j, 100.0, length, radians(-90.0), limits, 1.0
        )

    def test_swung(self) -> None:
        table = rows("door_hinged")
        made = linkage(GivenMotion("q", self.law), self.door(), knots_deg=self.knots, closed=False)
        angle, omega, epsilon = derivatives(
            settled(made), "door.angle", column(table, "phi1_deg"), 2
        )
        angles_agree(angle, column(table, "door_deg") - 90.0)
        agree(omega * 0.8, column(table, "omega"))
        agree(epsilon * 0.8**2, column(table, "eps"))

    def test_opens_by_half_a_right_angle(self) -> None:
        door = self.door()
        made = linkage(GivenMotion("q", variable), door, knots_deg=(0.0, 308.3), closed=False)
        angles_agree(derivatives(made, "door.angle", np.array([308.3]), 0)[0], -45.0)
        assert roots_in(door, radians(308.3)) == 1


def circular(*more: Element) -> Linkage:
    """A coupler point that runs on a circle for half a turn."""
    return linkage(
        MemberPoint("A", 0j),
        MemberPoint("D", 300 + 0j),
        Crank("crank", "q", "A", "B", 100.0),
        Dyad("RRR", "B", "D", "C", ("coupler", "rocker"), Lengths(300.0, 300.0)),
        MemberPoint("E", 600 + 0j, "coupler"),
        *more,
    )


def test_circular_stretch_of_a_coupler_curve() -> None:
    table, made = rows("circular_stretch"), circular()
    point = derivatives(made, "E", column(table, "crank_deg"), 0)[0]
    agree(point.real, column(table, "xE"))
    agree(point.imag, column(table, "yE"))
    agree(np.abs(point - (300 + 826.7j)), column(table, "to_center"))


def test_six_bar_with_a_dwell() -> None:
    table = rows("six_bar_dwell")
    made = settled(
        circular(
            MemberPoint("G", 500 + 740j),
            Dyad("RRR", "E", "G", "F", ("rod", "lever"), Lengths(379.0, 218.0)),
        )
    )
    found = derivatives(made, "lever.angle", column(table, "crank_deg"), 0)[0]
    angles_agree(found, column(table, "GF_deg"))

    def angle(q: Array) -> tuple[Array, Array]:
        value, slope = made.track("lever.angle", q, 1).derivatives()
        return value, slope

    _, values = extremes(angle, np.radians([100.0, 260.0]))
    agree(np.degrees(values.max() - values.min()), 0.330746869002, 100.0)


def test_harmonics_of_a_slide() -> None:
    """Of the acceleration of a central crank-slider, over the crank."""
    q = np.linspace(0.0, TURN, 256, endpoint=False)
    for row in rows("slide_harmonics"):
        made = crank_slider(1.0, float(row["rod_over_crank"]))
        second = made.track("slide.x", q, 2).derivatives()[2]
        amplitudes = -np.fft.rfft(second).real / (q.size / 2)
        for number in (1, 2, 4, 6, 8):
            agree(amplitudes[number], float(row[f"A{number}"]), 1e-2, 1e-9)


def test_geneva_wheel() -> None:
    """The slot is a guide that swings about the wheel's centre."""
    table = rows("geneva")
    made = linkage(
        MemberPoint("O", 0j),
        MemberPoint("W", 60.0 * math.sqrt(2.0) + 0j),
        Crank("crank", "q", "O", "pin", 60.0),
        Dyad("RTR1", "W", "pin", "block", ("wheel", "slide"), Lengths(0.0, 0.0)),
        knots_deg=(-45.0, 45.0),
        closed=False,
    )
    angle, ratio, second = derivatives(made, "wheel.angle", column(table, "crank_deg"), 2)
    angles_agree(pi - angle, column(table, "wheel_deg"))
    agree(-ratio, column(table, "ratio"))
    agree(-second, column(table, "d2"))


def test_five_bar_behind_both_wheels() -> None:
    """A crank on each wheel of the two-phase pair, 60 rpm of wheel 1."""
    table = rows("five_bar")
    made = settled(
        linkage(
            GivenMotion("wheel1", turned(-1.0)),
            GivenMotion("wheel2", phases(*TWO_PHASES)),
            MemberPoint("O1", 0j),
            MemberPoint("O2", 180 + 0j),
            Crank("crank1", "wheel1", "O1", "pin1", 45.0, 0.5 * pi),
            Crank("crank2", "wheel2", "O2", "pin2", 50.0, 0.5 * pi),
            Dyad("RRR", "pin1", "pin2", "B", ("link1", "link2"), Lengths(150.0, 160.0)),
            knots_deg=TWO_PHASES[0],
        )
    )
    found = derivatives(made, "B", column(table, "phi1_deg"), 2)
    for order, (value, what) in enumerate(zip(found, ("", "v", "a"), strict=True)):
        agree(value.real * SIXTY_RPM**order, column(table, f"{what}x"))
        agree(value.imag * SIXTY_RPM**order, column(table, f"{what}y"))


class TestClosing:
    """Where linkages close, and change points."""

    def test_crank_that_only_swings(self) -> None:
        with pytest.raises(NotClosingError) as caught:
            settled(four_bar(80.0, 60.0, 70.0, 100.0))
        found = caught.value.closing
        agree(np.degrees(found.ranges), np.array([[-91.7907846593, 91.7907846593]]))
        reached = found.ranges[0][1]
        distance = abs(80.0 * np.exp(1j * reached) - 100.0)
        agree(distance, 60.0 + 70.0)

    def test_parallelogram(self) -> None:
        made = settled(four_bar(50.0, 120.0, 50.0, 120.0))
        agree(np.array(made.dyads[0].changes), np.array([0.0, pi]))

    def test_slide_too_far_off(self) -> None:
        with pytest.raises(NotClosingError) as caught:
            settled(crank_slider(50.0, 80.0, 40.0))
        agree(
            np.degrees(caught.value.closing.ranges),
            np.array([[-53.1301023542, 233.130102354]]),
        )
        settled(crank_slider(50.0, 90.001, 40.0))
        with pytest.raises(NotClosingError):
            settled(crank_slider(50.0, 89.999, 40.0))
        touching = settled(crank_slider(50.0, 90.0, 40.0))
        agree(np.array(touching.dyads[0].changes), 1.5 * pi)

    def test_pin_through_the_pivot_of_its_guide(self) -> None:
        with pytest.raises(NotClosingError) as caught:
            settled(swinging_guide(60.0, 60.0))
        agree(caught.value.closing.place, 1.5 * pi)
        made = settled(swinging_guide(60.0, 61.0))
        agree(-derivatives(made, "guide.angle", np.array([270.0]), 1)[1], 60.0)

    def test_longest_crank(self) -> None:
        assert not settled(four_bar(79.999)).dyads[0].changes
        assert settled(four_bar(80.0)).dyads[0].changes == pytest.approx((0.0,), abs=1e-12)
        with pytest.raises(NotClosingError):
            settled(four_bar(80.001))
