"""Moments by virtual work against printed numbers, equations of motion, and what must vanish."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

from gearcam.linkages.chain import LeverChain
from gearcam.linkages.closing import settled
from gearcam.linkages.coordinates import (
    Acting,
    JointDistance,
    MemberTurn,
    NamedCoordinate,
    PointWay,
)
from gearcam.linkages.dyads import Lengths
from gearcam.linkages.efforts import (
    GRAVITY,
    INERTIA,
    SPRINGS,
    ActiveRanges,
    AppliedForce,
    Effort,
    InertiaForce,
    force_on,
)
from gearcam.linkages.elements import Crank, Dyad, GivenMotion, GuideLine, MemberPoint, PushedSlide
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.work import VirtualWork
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_linkages import (
    THREE_PHASES,
    TURN,
    TWO_PHASES,
    agree,
    column,
    crank_slider,
    four_bar,
    linkage,
    phases,
    rows,
)

G = -9.80665j
MASSES = (("crank", 60.0, "G1", 0.55), ("rod", 45.0, "G2", 2.8), ("ram", 180.0, "slide", 0.0))


def inertia(*masses: tuple[str, float, str, float]) -> list[Effort]:
    turning = [InertiaForce.of_turn(MemberTurn(name), own, name) for name, _, _, own in masses]
    return [*turning, *(InertiaForce.of_mass(at, mass, name) for name, mass, at, _ in masses)]


def weights(masses: tuple[tuple[str, float, str, float], ...]) -> list[Effort]:
    return [force_on(center, mass * G, GRAVITY) for _, mass, center, _ in masses]


def nail_machine(law: tuple[tuple[float, ...], tuple[float, ...]]) -> Linkage:
    """The slide on x through the shaft; the crank from its outer dead centre."""
    made = crank_slider(150.0, 750.0, law=phases(*law), start=pi, knots_deg=law[0])
    points = MemberPoint("G1", 50 + 0j, "crank"), MemberPoint("G2", 260 + 0j, "rod")
    return linkage(*made.elements, *points, knots_deg=law[0])


def forging(*ranges: tuple[float, float]) -> AppliedForce:
    active = ActiveRanges([(radians(a), radians(b)) for a, b in ranges], TURN) if ranges else None
    return AppliedForce(PointWay("slide", "bed"), lambda _: -35435.0, active=active)


class TestNailMachine:
    @pytest.mark.parametrize("pair", ["two", "three"])
    def test_forging(self, pair: str) -> None:
        table = [row for row in rows("nail_forging") if row["phases"] == pair]
        made = nail_machine(TWO_PHASES if pair == "two" else THREE_PHASES)
        work = VirtualWork(made, [forging()])
        q = np.radians(column(table, "phi1_deg"))
        agree(1e-3 * work.moment(q).c[0], column(table, "wheel1_nm"))
        agree(1e-3 * work.on({"q": 1.0}, q), column(table, "wheel2_nm"))

    def work(self) -> VirtualWork:
        efforts = inertia(*MASSES) + weights(MASSES)
        return VirtualWork(
            nail_machine(TWO_PHASES), [*efforts, forging((150.0, 170.0))], 180.0 * pi / 30.0
        )

    def test_with_masses(self) -> None:
        table, work = rows("nail_masses"), self.work()
        q = np.radians(column(table, "phi1_deg"))
        agree(1e-3 * work.moment(q).c[0], column(table, "wheel1_nm"))
        agree(1e-3 * work.on({"q": 1.0}, q), column(table, "wheel2_nm"))

    def test_reduced_inertia(self) -> None:
        table, work = rows("nail_reduced_inertia"), self.work()
        value, slope = work.reduced_inertia(np.radians(column(table, "phi1_deg")), 1).derivatives()
        agree(value, column(table, "inertia"))
        agree(slope, column(table, "slope"))

    def test_energy_of_motion_is_the_work_of_inertia(self) -> None:
        work, q = self.work(), np.linspace(0.1, 6.2, 40)
        assert work.speed is not None
        slope = 0.5 * work.speed**2 * work.reduced_inertia(q, 1).derivatives()[1]
        agree(1e-3 * work.parts(q)[INERTIA].c[0], slope)

    def test_equations_of_motion(self) -> None:
        """The moment on wheel 2 from forces in the joints, rod and slide solved as one system."""
        work = self.work()
        assert work.speed is not None
        q = np.radians([20.0, 75.0, 160.0, 220.0, 333.0])
        wanted = [self.crank_moment(work, float(one)) for one in q]
        agree(work.on({"q": 1.0}, q), np.array(wanted))

    @staticmethod
    def crank_moment(work: VirtualWork, q: float) -> float:
        made, speed = work.linkage, work.speed or 0.0
        place, force = {}, {}
        for name in ("G1", "pin", "G2", "slide"):
            place[name] = made.track(name, np.array([q]), 0).derivatives()[0][0]
        for _, mass, center, _ in MASSES:
            second = made.track(center, np.array([q]), 2).derivatives()[2][0]
            force[center] = mass * (1e-3 * speed**2 * second - G)
        turn = made.track("rod.angle", np.array([q]), 2).derivatives()[2][0]
        if radians(150.0) <= q < radians(170.0):
            force["slide"] += 35435.0
        # unknown: crank on rod (2), rod on slide (2), guide on slide
        arm1, arm2 = place["pin"] - place["G2"], place["slide"] - place["G2"]
        rate = 2.8e3 * speed**2 * turn
        matrix = np.array(
            [
                [1.0, 0.0, -1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0, -1.0, 0.0],
                [-arm1.imag, arm1.real, arm2.imag, -arm2.real, 0.0],
                [0.0, 0.0, 1.0, 0.0, 0.0],
                [0.0, 0.0, 0.0, 1.0, 1.0],
            ]
        )
        rod, ram = force["G2"], force["slide"]
        x, y, *_ = np.linalg.solve(matrix, [rod.real, rod.imag, rate, ram.real, ram.imag])
        crank = made.track("crank.angle", np.array([q]), 2).derivatives()[2][0]
        on_pin = (place["pin"].conjugate() * complex(x, y)).imag
        own = (place["G1"].conjugate() * force["G1"]).imag
        return float(on_pin + own + 0.55e3 * speed**2 * crank)


class TestFourBar:
    """A force on the coupler's point and a moment on the rocker; no masses."""

    efforts = (
        force_on("P", 30 - 200j),
        AppliedForce(MemberTurn("rocker"), lambda _: -5000.0),
    )

    def test_printed(self) -> None:
        table, work = rows("four_bar_forces"), VirtualWork(four_bar(), self.efforts)
        agree(work.moment(np.radians(column(table, "crank_deg"))).c[0], column(table, "moment"))

    def test_forces_in_the_joints(self) -> None:
        """Coupler and rocker as one system of six equations; then the crank."""
        table, work = rows("four_bar_forces"), VirtualWork(four_bar(), self.efforts)
        names = ("R12x", "R12y", "R23x", "R23y", "R03x", "R03y")
        for row in table:
            q = np.array([radians(float(row["crank_deg"]))])
            b, c, p = (work.linkage.track(name, q, 0).derivatives()[0][0] for name in "BCP")
            cb, db = c - b, 110 - c  # moments about B, and about C
            matrix = [
                [1, 0, -1, 0, 0, 0],
                [0, 1, 0, -1, 0, 0],
                [0, 0, cb.imag, -cb.real, 0, 0],
                [0, 0, 1, 0, 1, 0],
                [0, 0, 0, 1, 0, 1],
                [0, 0, 0, 0, -db.imag, db.real],
            ]
            moment = ((p - b).conjugate() * (30 - 200j)).imag
            found = np.linalg.solve(np.array(matrix), [-30.0, 200.0, -moment, 0.0, 0.0, 5000.0])
            agree(np.asarray(found, dtype=float), np.array([float(row[name]) for name in names]))
            agree((b.conjugate() * complex(*found[:2])).imag, work.moment(q).c[0])


class TestFurnaceDoor:
    """A chain on wheel 2 holds a door of 1000 kg."""

    def work(self) -> VirtualWork:
        knots, length = (0.0, 10.0, 60.0, 171.65), 1735.30026219493133
        limits = radians(-90.0), radians(-30.0)
        door = LeverChain(
            "door", "B", "q", 0j, 600 + 300j, 100.0, length, radians(-90.0), limits, 1.0
        )
        made = linkage(
            GivenMotion("q", phases(knots, (1.0, 1.0, 2.0, 2.0))),
            door,
            MemberPoint("G", 0.5 * length + 0j, "door"),
            knots_deg=knots,
            closed=False,
        )
        return VirtualWork(made, [force_on("G", 1000.0 * G, GRAVITY)])

    def test_printed(self) -> None:
        table, work = rows("door_moments"), self.work()
        q = np.radians(column(table, "phi1_deg"))
        agree(1e-3 * work.moment(q).c[0], column(table, "wheel1_nm"))
        agree(1e-3 * work.on({"q": 1.0}, q), column(table, "wheel2_nm"))

    def test_lifts_its_weight(self) -> None:
        work = self.work()
        heights = work.linkage.track("G.y", work.knots, 0).derivatives()[0]
        agree(work.work, 9806.65 * (heights[-1] - heights[0]))
        agree(work.mean * radians(171.65), work.work)


def spring(rate: float, free: float = 0.0, damping: float = 0.0) -> AppliedForce:
    def law(acting: Acting) -> Jet:
        return -((acting.place - free) * rate + acting.velocity * damping)

    return AppliedForce(JointDistance("P", "D"), law, SPRINGS)


class TestIdentities:
    masses = (("coupler", 0.7, "P", 3e-4), ("rocker", 0.5, "C", 1e-4), ("crank", 0.2, "B", 5e-5))

    def work(self, *more: Effort, speed: float = 11.0) -> VirtualWork:
        efforts = inertia(*self.masses) + weights(self.masses)
        return VirtualWork(four_bar(), [*efforts, *more], speed)

    def test_nothing_is_left_over_a_turn(self) -> None:
        swing = AppliedForce(MemberTurn("coupler", "rocker"), lambda a: -a.place * 40.0, SPRINGS)
        work = self.work(spring(3.0, 25.0), swing)
        for own, size in work.works.values():
            assert size > 100.0
            assert abs(own) < 1e-12 * size

    def test_a_damper_takes_work(self) -> None:
        work = self.work(spring(0.0, damping=0.02))
        q = np.linspace(0.0, TURN, 2001)
        slope = work.linkage.track("P", q, 1).derivatives()
        way = slope[0] - 110.0
        speed = np.real(way.conj() * slope[1]) / np.abs(way) * 11.0
        lost = float(np.mean((0.02 * speed**2)[:-1]) / 11.0 * TURN)
        agree(work.work, lost, relative=1e-11)

    def test_what_a_turn_lifts_or_winds_up_is_not_back(self) -> None:
        spiral = AppliedForce(MemberTurn("crank"), lambda a: -a.place * 7.0, SPRINGS)
        weight = force_on("P", 3.0 * G, GRAVITY)
        assert VirtualWork(four_bar(), [weight]).kept == (INERTIA, GRAVITY, SPRINGS)
        assert VirtualWork(four_bar(), [weight, spiral]).kept == (INERTIA, GRAVITY)
        lift = PushedSlide("door", "q", "way", "hook")
        made = linkage(GuideLine("way", 0j, 0.5 * pi), lift)
        lifted = VirtualWork(made, [force_on("hook", 3.0 * G, GRAVITY)])
        assert lifted.kept == (INERTIA, SPRINGS)
        agree(lifted.work, 3.0 * 9.80665 * TURN)

    def test_masses_whose_velocity_jumps_are_not_kept(self) -> None:
        """A parallelogram that keeps its branch goes on as another linkage at its change points."""
        mass = inertia(("rocker", 2.0, "C", 0.1))
        folded = settled(four_bar(50.0, 120.0, 50.0, 120.0))
        assert VirtualWork(folded, mass, 5.0).kept == (GRAVITY, SPRINGS)
        straight = settled(four_bar(50.0, 120.0, 50.0, 120.0, keeps="motion"))
        assert VirtualWork(straight, mass, 5.0).kept == (INERTIA, GRAVITY, SPRINGS)

    def test_narrow_peaks(self) -> None:
        """A rocker is jerked next to a change point, while the crank's load goes up or down."""
        made = settled(four_bar(50.0, 120.0, 50.002, 120.0))
        made = replace(made, knots=np.array([0.5, 5.5]), closed=False)
        wave = AppliedForce(NamedCoordinate("q"), lambda a: jets.sin(a.angle) * 30.0)
        work = VirtualWork(
            made, [InertiaForce.of_turn(MemberTurn("rocker"), 5e-4, "rocker"), wave], 5.0
        )
        q = np.linspace(pi - 0.01, pi + 0.01, 160001)
        _, rate, change = made.track("rocker.angle", q, 2).derivatives()
        dense = 1e3 * 25.0 * 5e-4 * rate * change - 30.0 * np.sin(q)
        assert dense.min() < -50.0
        agree(work.least.value, dense.min(), relative=1e-5)

    def test_torsion_over_whole_turns(self) -> None:
        """A spring from the ground to the crank is wound up by each turn."""
        spiral = AppliedForce(MemberTurn("crank"), lambda a: -a.place * 7.0, SPRINGS)
        agree(VirtualWork(four_bar(), [spiral]).work, 0.5 * 7.0 * TURN**2)

    def test_slopes(self) -> None:
        against = AppliedForce(
            MemberTurn("rocker"), lambda a: a.velocity * -3.0 + a.angle * 2.0 + a.place * a.place
        )
        work, q, step = self.work(spring(2.0, 3.0, 0.1), against), np.linspace(0.3, 6.0, 9), 1e-5
        found = work.moment(q, 1).derivatives()[1]
        ends = work.moment(q + step).c[0], work.moment(q - step).c[0]
        np.testing.assert_allclose(found, (ends[0] - ends[1]) / (2.0 * step), rtol=1e-6)

    def test_shafts_together_make_the_driver(self) -> None:
        """Two cranks behind one driver: each exerts its share, also where one stands still."""
        laws = phases(*TWO_PHASES), lambda q, order: Jet.variable(q, order) * Jet.variable(q, order)
        made = linkage(
            GivenMotion("first", laws[0]),
            GivenMotion("second", laws[1]),
            MemberPoint("A", 0j),
            MemberPoint("E", 180 + 0j),
            Crank("one", "first", "A", "B", 45.0),
            Crank("two", "second", "E", "F", 50.0),
            Dyad("RRR", "B", "F", "C", ("left", "right"), Lengths(150.0, 160.0)),
            knots_deg=TWO_PHASES[0],
        )
        shaft = InertiaForce.of_turn(NamedCoordinate("first"), 0.003, "first")
        mass = *inertia(("right", 0.4, "C", 0.002)), shaft
        work = VirtualWork(made, [force_on("C", 40 - 70j), *mass], 6.0)
        q = np.array([0.0, 0.4, 2.0, 4.4])
        turns = [law(q, 1).derivatives()[1] for law in laws]
        shares = work.on({"first": 1.0}, q), work.on({"second": 1.0}, q)
        agree(shares[0] * turns[0] + shares[1] * turns[1], work.moment(q).c[0])
        assert turns[1][0] == 0.0
        assert abs(shares[1][0]) > 1.0

    def test_a_force_of_the_place_counts_from_the_guide(self) -> None:
        bed = GuideLine("far", 180 + 40j, pi)
        made = linkage(*crank_slider(50.0, 120.0).elements, bed)
        q = np.linspace(0.0, 6.0, 7)
        way, slope = made.track("slide.guide2", q, 1).derivatives()
        force = AppliedForce(PointWay("slide", "far"), lambda a: a.place * 2.0)
        agree(VirtualWork(made, [force]).moment(q).c[0], 2.0 * (180.0 - way) * slope)

    def test_a_slide_that_rests_is_loaded(self) -> None:
        made = crank_slider(50.0, 120.0, law=lambda q, order: Jet.variable(q, order) * 0.0 + 1.0)
        work = VirtualWork(made, [AppliedForce(PointWay("slide", "bed"), lambda _: -10.0)])
        q = np.array([0.5])
        assert work.moment(q).c[0] == 0.0
        moving = VirtualWork(crank_slider(50.0, 120.0), work.efforts)
        agree(work.on({"q": 1.0}, q), moving.moment(np.array([1.0])).c[0])

    def test_without_a_speed_masses_have_their_weight_only(self) -> None:
        work = VirtualWork(four_bar(), inertia(*self.masses))
        assert not np.any(work.moment(np.linspace(0.0, 6.0, 5)).c[0])


class TestRanges:
    def test_ends_belong_to_what_follows(self) -> None:
        active = ActiveRanges([(-0.5, 0.25)], TURN)
        q = np.array([0.0, 0.25, TURN - 0.5, TURN - 0.6, 2.0 * TURN + 0.2, np.nextafter(0.25, 0)])
        assert active.at(q).tolist() == [1.0, 0.0, 1.0, 0.0, 1.0, 1.0]
        agree(active.ends(0.0, TURN), np.array([0.25, TURN - 0.5]))

    def test_extremes_at_the_ends_of_a_load(self) -> None:
        table = [row for row in rows("nail_forging") if row["phases"] == "two"]
        work = VirtualWork(nail_machine(TWO_PHASES), [forging((150.0, 180.0))])
        agree(1e-3 * work.largest.value, float(table[0]["wheel1_nm"]), relative=1e-10)
        agree(work.largest.place, radians(150.0))
        assert work.least.value == 0.0

    def test_extremes_between_knots(self) -> None:
        """Constant force on a slide: where the slide is fastest."""
        made = crank_slider(50.0, 120.0)
        work = VirtualWork(made, [AppliedForce(PointWay("slide", "bed"), lambda _: -10.0)])

        def speed(q: Array) -> Array:
            return made.track("slide.guide2", q, 1).derivatives()[1]

        dense = speed(np.linspace(0.0, TURN, 100001))
        agree(work.largest.value, 10.0 * dense.max(), relative=1e-9)
        agree(work.least.value, 10.0 * dense.min(), relative=1e-9)


def test_a_torque_on_a_shaft() -> None:
    made = linkage(GivenMotion("q", phases(*TWO_PHASES)), knots_deg=TWO_PHASES[0])
    work = VirtualWork(made, [AppliedForce(NamedCoordinate("q"), lambda a: a.place * -2.0)])
    q = np.array([1.0, 3.0])
    turn, ratio = phases(*TWO_PHASES)(q, 1).derivatives()
    agree(work.moment(q).c[0], 2.0 * turn * ratio)
