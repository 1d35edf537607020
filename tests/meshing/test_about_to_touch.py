"""Edges before the mate's flanks: involutes in closed form, whole flanks turned, ends of arcs."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from gearcam.gears.contact import COAST, DRIVE, FlankPairs, flank_pairs
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.meshing.about_to_touch import EdgeGaps, about_to_touch
from gearcam.meshing.contact import Contacts, contacts
from gearcam.meshing.edges import first_touch
from helpers_pairs import job, profile, shifted
from helpers_sampling import few

Plane = NDArray[np.complex128]

PAIRS: dict[str, Callable[[], GearPairResult]] = {
    "two phases": lambda: profile("nail_machine_two_phase"),
    "ring": lambda: profile("ring_ellipse"),
    "rack": lambda: profile("feeder"),
    "open": lambda: profile("log_spiral"),
    "backlash": lambda: profile("circular"),
    "ellipse": lambda: job(Ellipse(eccentricity=0.3), (24, 24), module=2.0),
}
SIDES = [DRIVE, COAST]
LARGEST = 0.05
"""Largest gap, modules."""


def side_of(name: str, side: int, farther: float = 0.0) -> FlankPairs:
    """The pairs of a side, mounted farther apart by so many modules."""
    made = PAIRS[name]()
    outward = -1.0 if made.pair.rolling.guide.place < 0.0 else 1.0
    return flank_pairs(made.gears, side, made.pair.shift + outward * farther * made.pair.module)


def edges(pairs: FlankPairs, phi1: np.ndarray, largest: float = LARGEST) -> EdgeGaps:
    module = pairs.pitch / math.pi
    return about_to_touch(pairs, phi1, contacts(pairs, phi1), largest * module)


def flank_line(pairs: FlankPairs, wheel: int, j: int) -> Plane:
    """Dense points of a flank, in its wheel's frame."""
    flanks, number = pairs.wheels[wheel - 1], np.array([j])
    sf, (low, high) = flanks.place(number), flanks.reach(number)
    reach = np.linspace(low[0], high[0], 801)
    frames = flanks.toothing.frames(pairs.track.angle(sf - flanks.sigma * reach))
    return flanks.toothing.flank_points(frames, sf, flanks.sigma) + flanks.eccentric


def distances(pairs: FlankPairs, j: int, phi1: float, turns: list[float]) -> list[float]:
    """Distance of both flanks of a pair, mm, with the driven wheel turned from its nominal."""
    driver = flank_line(pairs, 1, j) * np.exp(-1j * phi1)
    fixed = shapely.LineString(np.stack([driver.real, driver.imag], axis=1))
    shapely.prepare(fixed)
    driven, found = flank_line(pairs, 2, j), []
    for turn in turns:
        pose = pairs.guide.pose(pairs.guide.nominal(np.array([phi1])) + turn)
        placed = driven * pose.rotation + pose.shift + pairs.distance
        line = shapely.LineString(np.stack([placed.real, placed.imag], axis=1))
        found.append(float(shapely.distance(fixed, line)))
    return found


def spread_phases(pairs: FlankPairs, count: int) -> np.ndarray:
    return np.linspace(0.02, 0.98, count) * pairs.travel


def demand_first_touch(pairs: FlankPairs, phi1: np.ndarray, checked: int) -> None:
    """The flanks touch at the turn told and not before, and close by the lever."""
    found = edges(pairs, phi1)
    lead, _ = first_touch(pairs, phi1, contacts(pairs, phi1))
    some = np.flatnonzero(found.gap > 6e-3)
    some = np.random.default_rng(5).permutation(some)[:checked]
    assert len(some) == checked
    assert set(found.edge_of[some].tolist()) == {1, 2}
    for k in some.tolist():
        phase, j, turn = float(phi1[found.step[k]]), int(found.pair[k]), float(found.turn[k])
        lags = [0.5 * turn, turn - 5e-3 / float(found.lever[k]), turn, 1.001 * turn]
        place = float(lead[found.step[k]])
        half, near, at, beyond = distances(
            pairs, j, phase, [place + pairs.side * lag for lag in lags]
        )
        assert half == pytest.approx(0.5 * found.gap[k], rel=0.1)
        assert near == pytest.approx(5e-3, rel=2e-3)
        assert at < 1e-5
        assert beyond == 0.0


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("side", SIDES)
def test_whole_flanks_touch_at_the_turn_and_not_before(name: str, side: int) -> None:
    pairs = side_of(name, side)
    demand_first_touch(pairs, spread_phases(pairs, 40), 5)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", few(["two phases", "ring", "rack", "backlash"]))
def test_so_do_those_mounted_farther_apart(name: str, side: int) -> None:
    pairs = side_of(name, side, 0.03)
    demand_first_touch(pairs, spread_phases(pairs, 40), 5)


@pytest.mark.parametrize("side", SIDES)
def test_gaps_are_behind_the_leading_tooth_pair(side: int) -> None:
    """A tooth that is 20 um ahead leads while it is in contact."""
    even = side_of("two phases", side)
    pairs = shifted(even, 10, side * 0.02)
    at = float(even.arcs.start[9] + even.arcs.end[9]) / 2.0
    phi1 = at + np.linspace(-0.2, 0.2, 41)
    lead, _ = first_touch(pairs, phi1, contacts(pairs, phi1))
    assert np.count_nonzero(np.abs(lead) > 1e-5) > 10
    demand_first_touch(pairs, phi1, 5)


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("farther", few([0.03, 0.0]))
def test_gaps_close_towards_the_arcs(name: str, side: int, farther: float) -> None:
    """The gap with the square of the distance; place and direction become the contact's."""
    pairs = side_of(name, side, farther)
    arcs, near = pairs.arcs, 3e-6
    middle = slice(2, len(pairs.numbers) - 2)
    known = 0
    for end, outward in ((arcs.start[middle], -1.0), (arcs.end[middle], 1.0)):
        inside, number = contacts(pairs, end - outward * 1e-10), pairs.numbers[middle]
        own = inside.pair == number[inside.step]
        touching = dict(zip(inside.step[own].tolist(), np.flatnonzero(own).tolist(), strict=True))
        found = [edges(pairs, end + outward * apart) for apart in (near, 10.0 * near)]
        rows = [
            {int(each.step[k]): int(k) for k in np.flatnonzero(each.pair == number[each.step])}
            for each in found
        ]
        for step in sorted(rows[0].keys() & rows[1].keys() & touching.keys()):
            ends_in(inside, touching[step], found, [row[step] for row in rows])
            known += 1
    assert known >= len(arcs.start[middle])


def ends_in(contact: Contacts, at: int, found: list[EdgeGaps], rows: list[int]) -> None:
    """Two gaps, one ten times as far from a contact as the other."""
    close, far = (
        (
            float(each.gap[k]),
            abs(each.point[k] - contact.point[at]),
            abs(each.force[k] - contact.force[at]),
            float(each.curvature[k]),
        )
        for each, k in zip(found, rows, strict=True)
    )
    assert far[0] / close[0] == pytest.approx(100.0, rel=0.1)
    for near, farther in zip(close[1:3], far[1:3], strict=True):
        assert farther / near == pytest.approx(10.0, rel=0.1)
    assert close[1] < 0.1
    assert close[2] < 2e-3
    assert close[3] == pytest.approx(contact.curvature[at], rel=0.01)


def involute(radius: float, base: float) -> float:
    """Angle about the axis from an involute's start on the base circle to a radius."""
    tangent = math.sqrt((radius / base) ** 2 - 1.0)
    return tangent - math.atan(tangent)


class Spur:
    """Spur gears by the textbook; the driver at 0 turns counter-clockwise, O2 is on the x axis.

    Flanks touch on the line from N1 to N2; polar angles of both involutes fall with the radius.
    """

    def __init__(self, made: GearPairResult):
        module, teeth, rack = made.pair.module, made.pair.teeth, made.pair.rack
        shift = (made.design.pair.x, -made.design.pair.x)
        self.ratio = teeth[0] / teeth[1]
        pitch = [0.5 * module * z for z in teeth]
        self.base = [r * math.cos(rack.pressure_angle) for r in pitch]
        self.tip = [r + module * (rack.addendum + x) for r, x in zip(pitch, shift, strict=True)]
        self.axis = sum(pitch)
        force = 1j * np.exp(-1j * rack.pressure_angle)
        sine = math.sin(rack.pressure_angle)
        rolled = [
            math.sqrt(tip**2 - base**2) for tip, base in zip(self.tip, self.base, strict=True)
        ]
        self.end = pitch[0] + (rolled[0] - pitch[0] * sine) * force
        self.start = pitch[0] + (pitch[1] * sine - rolled[1]) * force

    def driven_tip(self, swung: float) -> tuple[float, float, complex, complex]:
        """The driven tip, `swung` back from where contact begins, on the driver's involute.

        With the driver's angle before, the lag, the point and the force.
        """
        point = self.axis + (self.start - self.axis) * np.exp(1j * swung)
        base, radius, first = self.base[0], abs(point), abs(self.start)
        polar = float(np.angle(point))
        before = (
            float(np.angle(self.start)) - polar - involute(radius, base) + involute(first, base)
        )
        force = 1j * np.exp(1j * (polar - math.acos(base / radius)))
        return before, swung - self.ratio * before, point, force

    def driver_tip(self, after: float) -> tuple[float, float, complex, complex]:
        """The driver's tip on the driven involute, so much `after` the end of contact."""
        point = self.end * np.exp(1j * after)
        seen, last, base = point - self.axis, self.end - self.axis, self.base[1]
        polar = float(np.angle(seen / last))
        back = involute(abs(seen), base) - involute(abs(last), base)
        lag = polar + self.ratio * after + back
        force = -1j * np.exp(1j * (float(np.angle(seen)) - math.acos(base / abs(seen))))
        return after, lag, point, force


SPURS: dict[str, Callable[[], GearPairResult]] = {
    "shifted": lambda: profile("circular"),
    "plain": lambda: job(Constant(), (18, 27), module=2.5),
    "stub": lambda: job(
        Constant(),
        (40, 24),
        module=2.5,
        rack=Rack(pressure_angle=math.radians(25), addendum=0.8, dedendum=1.0, tip_radius=0.3),
    ),
}


@pytest.mark.parametrize("name", SPURS)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("edge_of", [1, 2])
def test_gaps_of_involutes_have_a_closed_form(name: str, side: int, edge_of: int) -> None:
    """On the coast side all is mirrored, and runs backwards."""
    made = SPURS[name]()
    truth, pairs = Spur(made), flank_pairs(made.gears, side)
    tip = truth.driver_tip if edge_of == 1 else truth.driven_tip
    cases = [tip(swung) for swung in (0.002, 0.01, 0.03, 0.05)]
    known = [np.array(each) for each in zip(*cases, strict=True)]
    (away, lag), (point, force) = (
        known[:2],
        (np.conj(each) if side < 0 else each for each in known[2:]),
    )
    arcs = pairs.arcs
    # after the end, or before the start
    after = (edge_of == 1) == (side == DRIVE)
    found = edges(pairs, arcs.end[5] + away if after else arcs.start[5] - away, np.inf)
    own = found.pair == pairs.numbers[5]
    assert found.step[own].tolist() == [0, 1, 2, 3]
    assert found.edge_of[own].tolist() == [edge_of] * 4
    assert lag.min() > 0.0
    assert found.turn[own] == pytest.approx(lag, abs=1e-11)
    assert np.abs(found.point[own] - point).max() < 1e-9
    assert np.abs(found.force[own] - force).max() < 1e-9
    lever = np.abs(np.imag(np.conj(point - truth.axis) * force))
    assert found.lever[own] == pytest.approx(lever, rel=1e-9)
    assert found.gap[own] == pytest.approx(lag * lever, abs=1e-9)
    if edge_of == 1:
        assert lever == pytest.approx(truth.base[1], rel=1e-12)


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("side", SIDES)
def test_entries_are_whole(name: str, side: int) -> None:
    """Sorted, none in contact, none twice, none beyond the largest gap, all numbers usable."""
    pairs = side_of(name, side)
    phi1 = spread_phases(pairs, 101)
    found, touching = edges(pairs, phi1), contacts(pairs, phi1)
    keys = list(zip(found.step.tolist(), found.pair.tolist(), strict=True))
    assert keys == sorted(set(keys))
    assert not set(keys) & set(zip(touching.step.tolist(), touching.pair.tolist(), strict=True))
    assert len(keys) > 30
    assert np.all((found.turn >= 0.0) & (found.lever > 0.0))
    assert np.all((found.gap <= LARGEST * pairs.pitch / math.pi) & (found.gap >= 0.0))
    assert found.gap == pytest.approx(found.turn * found.lever)
    assert np.abs(np.abs(found.force) - 1.0).max() < 1e-12
    # no flatter than flanks in contact
    assert found.curvature.min() > 0.9 * touching.curvature.min()
    all_of_them = edges(pairs, phi1, np.inf)
    assert len(all_of_them.step) > len(keys)
    assert all_of_them.gap.max() > LARGEST * pairs.pitch / math.pi


def test_curvatures_are_above_0_where_undercut_has_removed_the_mate() -> None:
    """Concave tips meet flanks above their undercut: the sum of both curvatures is negative."""
    pairs = flank_pairs(profile("rounded_square").gears, DRIVE)
    phi1 = np.linspace(0.56, 0.95, 120)
    assert edges(pairs, phi1).curvature.min() > 0.9 * contacts(pairs, phi1).curvature.min()


def test_a_flank_that_ends_at_its_root_first_is_left_out() -> None:
    """A driver whose flanks end above their form points: the mate's tips would touch fillets."""
    pairs = side_of("ellipse", DRIVE)
    driver = pairs.wheels[0]
    lowest = np.maximum(driver.flanks.lowest, -2.0)
    short = replace(driver, flanks=replace(driver.flanks, lowest=lowest))
    cut = replace(pairs, wheels=(short, pairs.wheels[1]))
    assert np.all(cut.arcs.start > pairs.arcs.start + 0.01)
    whole, less = (edges(each, each.arcs.start - 1e-3) for each in (pairs, cut))
    assert np.all(np.isin(pairs.numbers, whole.step[whole.pair == whole.step]))
    assert not np.any(less.pair == less.step)


@pytest.mark.parametrize("side", SIDES)
def test_where_no_flanks_touch_an_edge_is_first(side: int) -> None:
    made = job(Constant(), (20, 20), module=2.5)
    pairs = flank_pairs(made.gears, side, made.pair.shift + 3.2)
    phi1 = np.linspace(0.0, 0.6, 61)
    found, touching = edges(pairs, phi1, np.inf), contacts(pairs, phi1)
    alone = np.setdiff1d(np.arange(61), touching.step)
    assert 5 < len(alone) < 56
    least = np.full(61, np.inf)
    np.minimum.at(least, found.step, found.turn)
    assert np.all(least[alone] == 0.0)
    assert np.all(least[np.setdiff1d(found.step, alone)] > 0.0)


def test_no_phases_and_no_gaps_give_nothing() -> None:
    pairs = side_of("backlash", DRIVE)
    for found in (edges(pairs, np.empty(0)), edges(pairs, np.array([0.1]), 0.0)):
        assert len(found.step) == len(found.curvature) == 0
