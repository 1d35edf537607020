"""Non-circular pairs off their designed distance: common normals and the search for first touch."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.gears.contact import COAST, DRIVE, FlankPairs, flank_pairs
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, known_to, non_contact, touches
from gearcam.meshing.harmonics import harmonics
from gearcam.meshing.numbers import numbers
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import Meshing, study
from gearcam.parts.blank import Blank
from helpers_pairs import job, profile
from helpers_sampling import few

MADE = ["nail_machine_two_phase", "nail_machine_three_phase", "ellipse", "shop_order"]
MORE = [-0.1, 0.0, 0.05, 0.3]
SIDES = [DRIVE, COAST]


def leads(pairs: FlankPairs, phi1: np.ndarray) -> np.ndarray:
    """By common normals only; nan where no flanks touch."""
    found = contacts(pairs, phi1)
    outward = np.full(len(phi1), -np.inf)
    np.maximum.at(outward, found.step, -pairs.side * found.lead)
    return np.where(np.isfinite(outward), -pairs.side * outward, np.nan)


def searched(pairs: FlankPairs, phi1: np.ndarray) -> np.ndarray:
    """By the search for first touch, which knows nothing of common normals."""
    found = touches(pairs, phi1)
    outward = np.full(len(phi1), -np.inf)
    np.maximum.at(outward, found.step, -pairs.side * found.turn)
    return -pairs.side * outward


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("more", few(MORE, 4))
@pytest.mark.parametrize("side", SIDES)
def test_common_normals_and_the_gap_agree(name: str, more: float, side: int) -> None:
    made = profile(name)
    pairs = flank_pairs(made.gears, side, made.pair.center_distance + more)
    phi1 = np.linspace(0.05, 6.25, 41)
    assert leads(pairs, phi1) == pytest.approx(searched(pairs, phi1), abs=1e-12)


@pytest.mark.parametrize("name", few(MADE))
@pytest.mark.parametrize(
    ("more", "side"), few([(more, side) for more in MORE for side in SIDES], 5)
)
def test_arcs_end_where_an_edge_begins_to_touch(name: str, more: float, side: int) -> None:
    """A hundred-thousandth of a degree inside a pair shares a tangent, outside its end touches."""
    made = profile(name)
    pairs = flank_pairs(made.gears, side, made.pair.center_distance + more)
    inside = math.radians(1e-5)
    for edge, inward in zip((pairs.arcs.start, pairs.arcs.end), (inside, -inside), strict=True):
        for way, at_edge in ((inward, False), (-inward, True)):
            found = touches(pairs, edge + way)
            own = found.pair == pairs.numbers[found.step]
            assert np.count_nonzero(own) == len(pairs.numbers)
            assert np.all(found.edge[own] == at_edge)


def test_clearance_and_play_are_taken_up() -> None:
    """To first order the play along the pitch line is that of all four flanks, over cos(alpha)."""
    plain = job(Ellipse(eccentricity=0.3), (20, 20), module=2.5, backlash=0.02)
    made = GearPairResult(replace(plain.design, blank=Blank(clearance=(0.05, 0.03))))
    both = [leads(flank_pairs(made.gears, s), np.linspace(0.0, 6.2, 37)) for s in (DRIVE, COAST)]
    play = 0.02 + 2.0 * 0.08 / math.cos(math.radians(20.0))
    phi1 = np.linspace(0.0, 6.2, 37)
    radius = np.abs(made.pair.rolling.tracks[1].frames(phi1).p)
    tangent = made.pair.rolling.tracks[0].frames(phi1).t * np.exp(-1j * phi1)
    found = (both[1] - both[0]) * radius * tangent.imag
    assert found == pytest.approx(play, rel=0.05)
    assert np.all(both[0] < 0.0)  # driven, the wheel is behind
    assert np.all(both[1] > 0.0)


@pytest.mark.parametrize(("more", "edges"), [(1.0, True), (2.2, False)])
def test_what_drives_where_no_flanks_touch(more: float, edges: bool) -> None:
    made = profile("ellipse")
    pairs = flank_pairs(made.gears, DRIVE, made.pair.center_distance + more)
    found = non_contact(pairs)
    assert found
    assert all(stretch.edges for stretch in found) == edges
    middle = np.array([0.5 * (stretch.start + stretch.end) for stretch in found])
    assert np.all(np.isnan(leads(pairs, middle)))
    if edges:
        lead, by_edge = first_touch(pairs, middle, contacts(pairs, middle))
        assert np.all(by_edge)
        assert np.all(np.isfinite(lead))


def test_stepwise_outlines_count_the_pairs_that_are_told_off_centre() -> None:
    """A small overclosure: as many outlines overlap as have a common normal, but at changes."""
    made = profile("ellipse")
    spec = MeshingSpec(
        steps=90, overclosure=math.radians(5e-4), center_distance=made.pair.center_distance + 0.2
    )
    found = study(made.gears, spec)
    assert numbers(found)["interference_steps"] == 0
    assert numbers(found)["agreement"]["steps_apart"] <= 1
    assert numbers(found)["agreement"]["inside"] < 0.02


def mounted(more: float, **settings: object) -> Meshing:
    made = profile("shop_order")
    spec = MeshingSpec(center_distance=made.pair.center_distance + more, **settings)  # type: ignore[arg-type]
    return study(made.gears, spec)


def test_harmonics_make_up_the_lag() -> None:
    """The series, with its mean, is the lag again, as far as its orders go; the rest is small."""
    found = mounted(0.1, steps=32 * 8)
    lead = found.every("lead")
    error = numbers(found)["transmission_error"]
    assert error["mean_lag"] == pytest.approx(-lead.mean(), abs=1e-15)
    assert error["peak_to_peak"] == pytest.approx(np.ptp(lead), abs=1e-15)
    orders = [one["order"] for one in error["harmonics"]]
    assert orders == sorted(set(orders) & set(range(1, 3 * 32 + 1)))
    assert min(one["amplitude"] for one in error["harmonics"]) > error["known_to"]
    series = np.full(lead.shape, -error["mean_lag"])
    for one in error["harmonics"]:
        phase = math.radians(one["phase_deg"])
        series += one["amplitude"] * np.cos(one["order"] * found.phi1 + phase)
    assert series == pytest.approx(lead, abs=1e-3 * error["peak_to_peak"])


@pytest.mark.parametrize("turns", [1, 2])
def test_harmonics_of_a_known_lag(turns: int) -> None:
    start, teeth = math.radians(20.0), 32
    phi1 = start + 2.0 * math.pi * np.arange(8 * teeth * turns) / (8 * teeth)
    lead = 1e-3 + 3e-4 * np.cos(2.0 * phi1 + 0.7) - 1e-5 * np.sin(90.0 * phi1)
    told = {one["order"]: one for one in harmonics(lead, start, turns, teeth, 1e-15)}
    assert told[2]["amplitude"] == pytest.approx(3e-4, rel=1e-9)
    assert told[2]["phase_deg"] == pytest.approx(math.degrees(0.7), abs=1e-7)
    assert told[90]["amplitude"] == pytest.approx(1e-5, rel=1e-9)
    assert told[90]["phase_deg"] == pytest.approx(90.0, abs=1e-6)
    assert list(told) == [2, 90]


def test_harmonics_between_those_of_a_turn() -> None:
    """Of a wheel that comes back to the same teeth after three turns."""
    phi1 = 6.0 * math.pi * np.arange(720) / 720
    lag = 3e-4 * np.cos(2.0 / 3.0 * phi1 - 0.4) + 1e-5 * np.cos(2.0 * phi1)
    told = harmonics(lag, 0.0, 3, 20, 1e-15, between=True)
    assert [one["order"] for one in told] == [pytest.approx(2.0 / 3.0), 2]
    assert told[0]["amplitude"] == pytest.approx(3e-4, rel=1e-9)
    assert told[0]["phase_deg"] == pytest.approx(math.degrees(-0.4), abs=1e-7)


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        pytest.param({"steps": 32 * 8 - 1}, "steps = 256", marks=pytest.mark.slow),
        ({"steps": 90, "end": math.radians(90.0)}, "whole turns"),
        ({"steps": 400, "teeth": (1,)}, "not every phase"),
    ],
)
def test_harmonics_are_refused_with_the_reason(settings: dict, reason: str) -> None:
    error = numbers(mounted(0.0, **settings))["transmission_error"]
    assert "harmonics" not in error
    assert reason in error["no_harmonics"]


def test_a_mounting_out_of_reach_is_refused() -> None:
    with pytest.raises(InfeasibleError, match="do not mesh"):
        mounted(6.5)


@pytest.mark.parametrize(
    "name", ["ellipse", "eccentric_circle", "ring_uneven", "feeder", "extreme/ellipse_95"]
)
def test_leads_of_a_pair_as_designed_are_known_to_their_rounding(name: str) -> None:
    """Without backlash the true lead is 0, so that the computed one is its error."""
    made, grid = profile(name), np.linspace(0.0, 2.0 * math.pi, 500)
    for side in (DRIVE, COAST):
        pairs = flank_pairs(made.gears, side)
        phi1 = grid * (1.0 if pairs.closed else pairs.travel / (2.0 * math.pi))
        found = contacts(pairs, phi1)
        share = np.abs(found.lead) / known_to(pairs, phi1)[found.step]
        assert 0.01 < share.max() < 0.5
        assert not first_touch(pairs, phi1, found)[0].any()


def test_rounding_is_not_a_transmission_error() -> None:
    found = numbers(study(profile("ellipse").gears, MeshingSpec(steps=41 * 8)))
    error = found["transmission_error"]
    assert error["mean_lag"] == error["peak_to_peak"] == 0.0
    assert error["harmonics"] == []
    assert 1e-15 < error["known_to"] < 1e-12
    assert found["lag_mm"] == found["backlash_mm"] == {"min": 0.0, "max": 0.0}


@pytest.mark.slow
def test_small_transmission_errors_are_shown() -> None:
    """They grow with the centre distance: one of 1e-9 rad is a ten-thousandth of 1e-5 rad."""
    made = profile("ellipse")
    small, large = (
        numbers(
            study(
                made.gears,
                MeshingSpec(center_distance=made.pair.center_distance + more, steps=41 * 8),
            )
        )["transmission_error"]
        for more in (5e-8, 5e-4)
    )
    assert 1e-10 < small["peak_to_peak"] < 1e-8
    assert small["peak_to_peak"] == pytest.approx(1e-4 * large["peak_to_peak"], rel=1e-2)
    first = [one["harmonics"][0]["amplitude"] for one in (small, large)]
    assert first[0] == pytest.approx(1e-4 * first[1], rel=1e-2)
