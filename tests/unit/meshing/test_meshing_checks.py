"""Each check of a meshing study: an input that just triggers it, and one that just does not."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from gearcam.base.findings import CHECKS, Finding, run_checks
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.gears.spec import Rack
from gearcam.laws.ratio.constant import Constant
from gearcam.meshing.checks import KIND, clearances, spans
from gearcam.meshing.drive_checks import contact_ratio
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import Meshing, mount, run, study
from helpers_pairs import job, moved, profile

ALPHA = math.radians(20.0)
FEW = MeshingSpec(steps=24, end=math.radians(36.0))


def found(meshing: Meshing, limits: dict[str, float] | None = None) -> dict[str, Finding]:
    return {finding.code: finding for finding in run_checks(KIND, meshing, limits or {})}


@cache
def wheels(distance_more: float = 0.0) -> Meshing:
    made = job(Constant(), (20, 20), module=2.0)
    return study(made.gears, replace(FEW, center_distance=40.0 + distance_more))


def test_all_checks_are_here() -> None:
    codes = {code for kind, code in CHECKS if kind == KIND}
    assert codes == {
        "contact-ratio",
        "nothing-drives",
        "interference",
        "edge-contact",
        "fillet-interference",
        "tip-clearance",
    }


def test_a_good_pair_has_no_findings() -> None:
    assert found(wheels()) == {}


@pytest.mark.parametrize(("more", "bad"), [(-0.0005, True), (0.0005, False)])
def test_interference(more: float, bad: bool) -> None:
    finding = found(wheels(more)).get("interference")
    assert (finding is not None) == bad
    if finding is not None:
        assert finding.severity == "error"
        assert finding.value is not None
        # along the pitch line 2*tan(alpha) of the missing distance; less than the overclosure, so
        # that the outlines cannot show it
        assert finding.value == pytest.approx(0.001 * math.tan(math.radians(20.0)), rel=1e-3)


@pytest.mark.parametrize(("limit", "bad"), [(0.2505, True), (0.2495, False)])
def test_tip_clearance(limit: float, bad: bool) -> None:
    """The rack leaves a quarter of a module."""
    assert ("tip-clearance" in found(wheels(), {"tip_clearance": limit})) == bad


def test_tip_clearance_follows_the_mounting() -> None:
    for more in (-0.0005, 0.0, 0.0005):
        for distances in clearances(wheels(more)):
            assert distances == pytest.approx(0.5 + more, abs=2e-4)


def test_contact_ratio_below_one_is_an_error_and_says_that_edges_drive() -> None:
    """Short teeth: their arcs of contact leave gaps, in which the ends of flanks touch."""
    short = job(Constant(), (20, 20), module=2.0, rack=Rack(addendum=0.5, dedendum=0.7))
    findings = found(study(short.gears, FEW))
    assert "nothing-drives" not in findings
    finding = findings["contact-ratio"]
    assert finding.severity == "error"
    assert "tooth edges drive" in finding.message
    ratio = mount(short.gears, FEW).pairs[DRIVE].arcs.ratios[0]
    assert finding.value == pytest.approx(ratio, rel=1e-9)
    assert ratio < 1.0
    longer = job(Constant(), (20, 20), module=2.0, rack=Rack(addendum=0.7, dedendum=0.9))
    assert "contact-ratio" not in found(study(longer.gears, FEW))


def test_what_is_the_same_of_both_sides_is_one_finding_with_the_worse_value() -> None:
    """The nail machine carries worse driving than holding back; both limits are above both."""
    sides = tuple(flank_pairs(profile("nail_machine_three_phase").gears, s) for s in (COAST, DRIVE))
    least = [float(side.arcs.ratios.min()) for side in sides]
    assert least[1] < least[0]
    (both,) = contact_ratio(SimpleNamespace(sides=sides), 2.0)
    assert both.value == least[1]
    assert both.severity == "warning"
    backward, forward = both.where.split("; ")
    assert backward.startswith("driving backward, wheel 1, tooth ")
    assert forward.startswith("driving forward, wheel 1, tooth ")
    (one,) = contact_ratio(SimpleNamespace(sides=sides), 0.5 * sum(least))
    assert one.where == forward


def test_a_flank_of_less_than_a_pitch_is_an_error_though_its_neighbours_drive() -> None:
    """One flank of the driver is shorter at both ends; those beside it cover what it leaves."""
    pairs = flank_pairs(job(Constant(), (20, 20), module=2.0).gears, DRIVE)
    driver, driven = pairs.wheels
    flanks = driver.flanks
    highest, lowest = flanks.highest.copy(), flanks.lowest.copy()
    highest[20 + 7] -= 0.4 * pairs.pitch
    lowest[20 + 7] = 0.3 * pairs.pitch - driven.flanks.highest[0]
    driver = replace(driver, flanks=replace(flanks, highest=highest, lowest=lowest))
    short = replace(pairs, wheels=(driver, driven))
    assert short.arcs.ratios.min() < 1.0
    assert short.arcs.stretches[2].min() == 1
    (finding,) = contact_ratio(SimpleNamespace(sides=(short,)), 1.1)
    assert finding.severity == "error"
    assert "neighbours drive" in finding.message
    assert finding.where == "driving forward, wheel 1, tooth 8"


@pytest.mark.parametrize(("distance", "bad"), [(43.7, True), (42.0, False)])
def test_nothing_drives_where_not_even_edges_reach(distance: float, bad: bool) -> None:
    """Tips of 22 mm radius: at 43.7 mm they hardly reach each other, and not all along."""
    made = job(Constant(), (20, 20), module=2.0)
    findings = found(study(made.gears, replace(FEW, center_distance=distance)))
    assert ("nothing-drives" in findings) == bad
    assert findings["contact-ratio"].severity == "error"
    if bad:
        assert "nothing drives at all" in findings["contact-ratio"].message
        assert "phi1 = " in findings["nothing-drives"].where


def test_edge_contact_where_only_an_edge_is_left() -> None:
    """Teeth too short to carry all the way: between their arcs their edges touch."""
    short = job(Constant(), (20, 20), module=2.0, rack=Rack(addendum=0.5, dedendum=0.7))
    finding = found(study(short.gears, FEW))["edge-contact"]
    assert finding.severity == "warning"
    assert finding.value is not None
    assert 0 < finding.value < 24


def test_contact_off_the_flanks() -> None:
    """So close that tips touch fillets; half as close they do not."""
    gears = profile("nail_machine_two_phase").gears
    codes = [
        set(found(study(gears, MeshingSpec(steps=60, center_distance=180.0 - less))))
        for less in (1.1, 0.3)
    ]
    assert "fillet-interference" in codes[0]
    assert "fillet-interference" not in codes[1]


@pytest.mark.slow
def test_a_tooth_that_lags_leaves_arcs_without_contact_but_no_interference() -> None:
    """Tooth 1 of the driver 20 um behind its place, and the same pair as it should be.

    The driven wheel lags where tooth 1 would carry alone, 2 - contact ratio pitches long; at the
    ends of this arc the edges of its neighbours drive, between them tooth 1 at its 20 um.
    """
    reach = math.sqrt(11.0**2 - (10.0 * math.cos(ALPHA)) ** 2) - 10.0 * math.sin(ALPHA)
    contact_ratio = 2.0 * reach / (math.pi * math.cos(ALPHA))
    spec = MeshingSpec(start=math.radians(-18.0), end=math.radians(18.0), steps=360)
    setup = mount(job(Constant(), (20, 20), module=2.0, backlash=0.05).gears, spec)
    whole, broken = run(setup), run(moved(setup, 1, 0.02))
    # half the backlash is taken up first
    lags = [-20.0 * meshing.every("lead") - 0.025 for meshing in (whole, broken)]
    assert np.abs(lags[0]).max() < 1e-9
    assert not whole.every("edge").any()
    late = lags[1] > 1e-9
    assert late.sum() * 0.1 == pytest.approx((2.0 - contact_ratio) * 18.0, abs=0.1)
    # the driving flank is a quarter of a pitch before the middle of the tooth, at phi1 = 0
    assert np.degrees(broken.phi1[late]).mean() == pytest.approx(-4.5, abs=0.06)
    full = np.abs(lags[1] - 0.02) < 1e-9
    edges = broken.every("edge").astype(bool)
    assert full.any()
    assert edges.any()
    np.testing.assert_array_equal(late, full | edges)
    assert not (full & edges).any()
    assert np.all(lags[1][edges] < 0.02)
    for meshing in (whole, broken):
        assert np.all(meshing.every("interferes") == 0)


def test_phases_are_told_as_ranges() -> None:
    angles = np.radians([0.0, 1.0, 2.0, 5.0, 8.0, 9.0, 20.0, 30.0])
    assert spans(angles, math.radians(1.0)) == "phi1 = 0 to 2, 5, 8 to 9 deg and 2 more"
