"""The meshing study on the nail machine: what it proves, and what it finds when a pair is wrong."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import gearcam.meshing.study as study_room
from gearcam import build, loads
from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import run_checks
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.gears.outline import build_outline
from gearcam.gears.subject import KIND as PAIR_KIND
from gearcam.gears.subject import CheckedPair
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.meshing.checks import KIND
from gearcam.meshing.numbers import numbers, pairs_in_contact
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import Meshing, mount, run, study
from helpers_pairs import OVERCLOSURE, job, moved, profile
from helpers_sampling import few

NAILS = ("nail_machine_two_phase", "nail_machine_three_phase")
TURN = np.radians(np.arange(360.0))

FORWARDS = [(name, OVERCLOSURE) for name in NAILS]
BACKWARDS = [(name, -OVERCLOSURE) for name in NAILS]
TURNS = few([*FORWARDS, *reversed(BACKWARDS)], 6)
"""Pairs that are turned once, forwards or backwards."""


@cache
def full_turn(name: str, overclosure: float) -> Meshing:
    return study(profile(name).gears, MeshingSpec(overclosure=overclosure))


def codes(meshing: Meshing) -> dict[str, str]:
    return {found.code: found.severity for found in run_checks(KIND, meshing, {})}


@pytest.mark.parametrize(("name", "overclosure"), TURNS)
def test_a_full_turn_runs_clean(name: str, overclosure: float) -> None:
    meshing = full_turn(name, overclosure)
    found = numbers(meshing)
    assert found["complete"]
    assert found["steps_done"] == 360
    assert found["interference_steps"] == 0
    assert abs(found["transmission_error"]["mean_lag"]) < 1e-9
    assert found["transmission_error"]["peak_to_peak"] < 1e-9
    assert max(map(abs, found["backlash_mm"].values())) < 1e-9
    assert found["pairs_in_contact"] == {"min": 1, "max": 2}
    assert 2.0 * found["chord_error_mm"] <= found["penetration_mm"] / 100.0
    assert codes(meshing) == {}


@pytest.mark.parametrize(("name", "overclosure"), TURNS)
def test_outlines_and_exact_flanks_agree(name: str, overclosure: float) -> None:
    agreement = numbers(full_turn(name, overclosure))["agreement"]
    assert agreement["inside"] < 0.02
    assert agreement["steps_apart"] <= 1
    assert agreement["clipped_mm2"] < 3e-3


@pytest.mark.parametrize("name", few(NAILS))
@pytest.mark.parametrize("steps", few([60, 180]))
def test_outlines_count_the_unloaded_pairs_but_within_a_step_of_a_change(
    name: str, steps: int
) -> None:
    """Edges overlap by half a lens outside their arcs: the overclosure must be small.

    Where an undercut flank ends its mate is nearly parallel, and the lens is long.
    """
    meshing = study(profile(name).gears, MeshingSpec(overclosure=math.radians(5e-4), steps=steps))
    pairs, phi = meshing.setup.pairs[DRIVE], meshing.phi1
    stepwise, unloaded = pairs_in_contact(meshing), pairs.arcs.carrying(phi)
    assert np.all(stepwise >= unloaded)
    changes = pairs.arcs.stretches[0]
    apart = np.flatnonzero(stepwise != unloaded)
    beside = np.abs(np.angle(np.exp(1j * (phi[apart][:, None] - changes)))).min(axis=1)
    far = apart[beside > math.radians(1.0)]
    columns = meshing.columns
    idle = (columns["carries"] == 0.0) & np.isin(columns["step"], far)
    undercut = profile(name).gear2.profile.undercut_teeth
    assert set(columns["tooth2"][idle].astype(int).tolist()) <= set(undercut)
    assert len(far) <= 2


@pytest.mark.parametrize("name", few(NAILS))
def test_held_back_the_flanks_come_apart_by_the_overclosure(name: str) -> None:
    meshing = full_turn(name, OVERCLOSURE)
    held, setup = numbers(meshing)["held_back_gap_mm"], meshing.setup
    assert held["min"] == pytest.approx(setup.penetration, rel=0.02)
    assert held["max"] <= OVERCLOSURE * setup.lever * 1.01


@pytest.mark.parametrize("by", few([0.02, -0.02]))
def test_a_tooth_moved_by_20_um_is_found(by: float) -> None:
    """Tooth 1 driving: forward is the side of falling s."""
    spec = MeshingSpec(start=math.radians(-8.0), end=math.radians(8.0), steps=64)
    setup = mount(profile(NAILS[0]).gears, spec)
    whole, broken = run(setup), run(moved(setup, 1, by))
    assert codes(whole) == {}
    driven = 180.0 / (1.0 + 1.6)
    shift = 0.02 / driven
    assert np.abs(broken.every("lead")).max() == pytest.approx(shift, rel=0.05)
    if by < 0.0:
        assert codes(broken)["interference"] == "error"
        assert broken.every("lead").max() == pytest.approx(shift, rel=0.05)
    else:
        # where it is alone the driven wheel lags until it touches; where not, the others carry
        assert broken.every("lead").min() == pytest.approx(-shift, rel=0.05)
        assert broken.every("lead").max() == pytest.approx(0.0, abs=1e-9)
        assert numbers(broken)["pairs_in_contact"] == numbers(whole)["pairs_in_contact"]


def test_a_tooth_that_only_the_outline_moves_is_found_by_its_depth() -> None:
    spec = MeshingSpec(start=math.radians(-8.0), end=math.radians(8.0), steps=64)
    setup = mount(profile(NAILS[0]).gears, spec)
    broken = run(replace(moved(setup, 1, -0.02), pairs=setup.pairs))
    finding = next(f for f in run_checks(KIND, broken, {}) if f.code == "interference")
    assert finding.value == pytest.approx(
        0.02 * math.cos(math.radians(20.0)) + 0.009, rel=0.2
    )  # a clipped lens is blunter
    assert "tooth 1 in tooth" in finding.where


def test_half_a_pitch_off_phase_is_found() -> None:
    made = profile(NAILS[0])
    setup = mount(made.gears, MeshingSpec())
    radius = np.abs(made.pair.rolling.tracks[1].frames(TURN[::10]).p)
    lead = 0.5 * math.pi * made.pair.module / radius
    found = setup.turning.overlaps(TURN[::10], OVERCLOSURE, lead)
    areas = np.bincount(found.step, found.area, minlength=36)
    assert areas.min() > made.pair.module**2


@pytest.mark.parametrize("name", few(NAILS))
def test_mounted_close_interferes_and_wide_plays(name: str) -> None:
    made = profile(name)
    close = study(made.gears, MeshingSpec(steps=72, center_distance=179.9))
    assert numbers(close)["interference_steps"] == 72
    assert codes(close)["interference"] == "error"
    wide = study(made.gears, MeshingSpec(steps=72, center_distance=180.1))
    assert numbers(wide)["interference_steps"] == 0
    turns = wide.every("backlash") / wide.every("along")
    phi = wide.phi1
    tangent = made.pair.rolling.tracks[0].frames(phi).t * np.exp(-1j * phi)
    tilt = np.arctan2(tangent.real, tangent.imag)
    alpha = made.pair.rack.pressure_angle
    radius = np.abs(made.pair.rolling.tracks[1].frames(phi).p)
    # to first order: the force lines of both sides cut the line of centres at alpha +- tilt
    expected = 0.1 * (np.tan(alpha + tilt) + np.tan(alpha - tilt)) / radius
    assert np.all(np.abs(turns / expected - 1.0) < 0.01)
    along = 0.1 * (np.tan(alpha + tilt) + np.tan(alpha - tilt)) * np.cos(tilt)
    assert np.all(np.abs(wide.every("backlash") / along - 1.0) < 0.01)
    # and the outlines say the same: turned by all of the backlash, the other flanks touch
    turning, error = wide.setup.turning, wide.every("lead")
    for share, free in ((0.999, True), (1.001, False)):
        found = turning.overlaps(phi, 0.0, error + share * turns)
        touched = np.unique(found.step[found.depth > wide.setup.noise])
        assert (len(touched) == 0) == free


@pytest.mark.parametrize("name", few(NAILS))
def test_corners_not_taken_from_the_roots_are_found(name: str) -> None:
    made = profile(name)
    first, second = (
        replace(gear, profile=build_outline(gear.toothing, None, 1e-3, DEFAULT))
        for gear in made.gears
    )
    assert "interference" in codes(study((first, second), MeshingSpec(steps=180)))


def test_an_interruption_keeps_the_steps_done() -> None:
    def stop(stage: str, done: int, total: int) -> None:  # noqa: ARG001
        if done:
            raise KeyboardInterrupt

    meshing = study(profile(NAILS[0]).gears, MeshingSpec(steps=300), stop)
    found = numbers(meshing)
    assert not found["complete"]
    assert 0 < found["steps_done"] < found["steps"] == 300
    assert meshing.columns["phi1_deg"].max() < 180.0


def test_teeth_choose_the_phases() -> None:
    meshing = study(profile(NAILS[0]).gears, MeshingSpec(teeth=(1, 27)))
    assert 25 < len(meshing.phi1) < 50
    pairs = flank_pairs(profile(NAILS[0]).gears, DRIVE)
    middle = pairs.wheels[0].toothing.track.angle(pairs.wheels[0].toothing.tooth_places[[0, 26]])
    beside = np.abs(np.angle(np.exp(1j * (meshing.phi1[:, None] - middle)))).min(axis=1)
    assert beside.max() < math.radians(20.0)
    assert {1.0, 27.0} <= set(meshing.columns["tooth1"].tolist())


@pytest.mark.parametrize(("name", "overclosure"), TURNS)
def test_both_sides_are_those_of_the_motion(name: str, overclosure: float) -> None:
    """With the driver ahead it is the drive side that overlaps, held back the other."""
    side = DRIVE if overclosure > 0.0 else COAST
    assert set(full_turn(name, overclosure).columns["side"].tolist()) == {float(side)}


def test_the_pair_s_own_check_names_the_sides_alike() -> None:
    """The three-phase pair carries worse driving than holding back."""
    made = profile(NAILS[1])
    limits = {"contact_ratio": 1.4}
    found = [f for f in made.findings if f.code == "contact-ratio"]
    assert found == []
    strict = run_checks(PAIR_KIND, subject_of(made), limits)
    worse = [f for f in strict if f.code == "contact-ratio"]
    assert [f.where.partition(",")[0] for f in worse] == ["driving forward"]
    ratios = {side: flank_pairs(made.gears, side).arcs.ratios.min() for side in (DRIVE, COAST)}
    assert ratios[DRIVE] < 1.4 < ratios[COAST]
    assert worse[0].value == pytest.approx(ratios[DRIVE], rel=1e-12)


def subject_of(made: GearPairResult) -> CheckedPair:
    return CheckedPair(pair=made.pair, gears=made.gears, bores=made.bores)


def test_teeth_that_cannot_be_told_apart_are_refused() -> None:
    """HalfTeeth that cross themselves once showed overlap where there is none."""
    made = job(Ellipse(eccentricity=0.281), (9, 6), module=2.0, x=0.4)
    with pytest.raises(InfeasibleError, match="wheel 2"):
        study(made.gears, MeshingSpec())


@pytest.mark.parametrize(("most", "words"), few([(1e5, "chords"), (1e7, "lost in rounding")]))
def test_an_overclosure_too_small_to_be_shown_is_refused_with_one_that_is_not(
    most: float, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study_room, "_MOST", most)
    made = job(Ellipse(eccentricity=0.281), (20, 20), module=2.0)
    with pytest.raises(InfeasibleError, match=words) as refused:
        mount(made.gears, MeshingSpec(overclosure=-1e-11))
    told = refused.value.nearest
    assert told is not None
    least = math.radians(float(told.split()[0]))
    assert mount(made.gears, MeshingSpec(overclosure=least)).penetration > 0.0
    with pytest.raises(InfeasibleError):
        mount(made.gears, MeshingSpec(overclosure=0.97 * least))


SHARP = """
kind = "gear-pair"
name = "sharp"
law = { type = "rounded-polygon", corners = 3, corner_radius = 0.4 }
pair = { module_mm = 0.4, teeth = [46, 46] }
rack = { tip_radius = 0.0001 }
"""


def test_middles_of_lands_are_halfway_however_many_vertices_their_fillets_have() -> None:
    """At the corners of the polygon a root once ended in a fillet, and its half-teeth crossed."""
    gears = build(loads(SHARP)).gears
    turning = mount(gears, MeshingSpec()).turning
    for wheel in (turning.driver, turning.driven):
        assert wheel.sound
    assert study(gears, MeshingSpec(steps=3)).complete
