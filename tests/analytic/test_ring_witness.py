"""Rings against a swept shaper that knows the raw law only: flanks, fillets and root lands.

A ring that is the same on both sides, and one that is not: its teeth would not fit if it were
turned over or numbered the other way round.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.gears.flank import Curve, trace
from gearcam.gears.pair import Gear
from helpers_sampling import chosen
from witness import laws, shaper, sweep
from witness.kinematics import Basic, Rolling

REACH = 11.0
"""Modules: within a ring a cutter stays in mesh for longer than outside."""

ALLOWED = 8e-6
"""The ridges that so many positions leave, mm."""

STEPS = 8000


def _even(phi: Any, lib: Any) -> laws.Derivatives:
    return 0.5 + 0.15 * lib.cos(phi), -0.15 * lib.sin(phi), -0.15 * lib.cos(phi)


def _odd(phi: Any, lib: Any) -> laws.Derivatives:
    mean = lib.pi / (lib.pi + lib.pi / 2)  # 2/3 to the last digit
    waves = [(0.05, 2, lib.cos, lib.sin, -1), (0.04, 2, lib.sin, lib.cos, 1)]
    waves.append((0.02, 4, lib.sin, lib.cos, 1))
    found = [1.0 + 0.0 * phi, 0.0 * phi, 0.0 * phi]
    for size, n, wave, slope, sign in waves:
        found[0] = found[0] + size * wave(n * phi)
        found[1] = found[1] + sign * n * size * slope(n * phi)
        found[2] = found[2] - n * n * size * wave(n * phi)
    value, first, second = (mean * each for each in found)
    return value, first, second


CASES = {
    "even": (_even, "1 + 0.3*cos(phi1)", (30, 60)),
    "odd": (_odd, "1 + 0.05*cos(2*phi1) + 0.04*sin(2*phi1) + 0.02*sin(4*phi1)", (60, 90)),
}


@cache
def ring(name: str) -> Gear:
    _, ratio, teeth = CASES[name]
    pair = gc.PairSpec(type="internal", teeth=teeth, module=2.0)
    return gc.build(gc.GearPairDesign(name=name, law=gc.laws.Formula(ratio=ratio), pair=pair)).gear2


@cache
def kinematics(name: str) -> tuple[Rolling, Basic]:
    ratio, _, (z1, _) = CASES[name]
    law = laws.smooth(ratio, 8)
    rolling = Rolling(law, 2.0 * np.pi * z1 / Rolling(law, 1.0, mate=-1).length, mate=-1)
    # pointed to the last digit where the cutter is small: the witness wants a land
    radius = 0.5 * ring(name).toothing.cutter.tip_radius * (1.0 - 1e-9)
    return rolling, Basic(2.0, tip_radius=radius)


@cache
def cut(name: str, k: int, steps: int) -> Any:
    rolling, basic = kinematics(name)
    curvature = ring(name).toothing.cutter.kc
    return shaper.cut_space(
        rolling,
        2,
        k,
        basic,
        steps,
        curvature=curvature,
        flank_points=1000,
        arc_points=600,
        reach=REACH,
    )


@cache
def points(name: str, k: int, *kinds: Curve) -> np.ndarray:
    """Points of the ring's curves between two teeth, as told, (n, 2), mm."""
    toothing, rows = ring(name).toothing, ring(name).profile.rows
    at = np.flatnonzero(np.isin(rows.kind, [int(kind) for kind in kinds]))
    start, end = rows.start[at], rows.end[at]
    phi = start + np.linspace(0.0, 1.0, 64)[:, None] * (end - start)
    found, _ = trace(toothing, rows, np.broadcast_to(at, phi.shape).ravel(), phi.ravel())
    rolling, basic = kinematics(name)
    return sweep.inside(np.stack([found.real, found.imag], axis=1), rolling, 2, k, basic)


PLACES = [("even", 16), ("odd", 4), ("odd", 20)]


def test_the_witness_rolls_as_the_pair_does() -> None:
    for name in CASES:
        rolling, _ = kinematics(name)
        assert ring(name).pair.center_distance == pytest.approx(rolling.distance, rel=1e-13)
        s = np.linspace(0.0, 2.0 * rolling.length, 37)
        own = ring(name).toothing.frames(ring(name).toothing.track.angle(s)).p
        assert np.abs(own - rolling.frames(2, s).point @ [1.0, 1.0j]).max() < 1e-10


@pytest.mark.parametrize(("name", "k"), chosen(PLACES, ("odd", 4)))
def test_flanks_and_fillets_are_those_that_a_shaper_leaves(name: str, k: int) -> None:
    found = points(name, k, Curve.FLANK, Curve.FILLET, Curve.LAND)
    assert len(found) > 150
    assert sweep.farthest(found, cut(name, k, STEPS)) < ALLOWED


def test_what_is_missed_falls_with_the_step_of_the_sweep() -> None:
    """Ridges between positions of the cutter are as high as the square of the step."""
    found = points("odd", 4, Curve.FLANK, Curve.FILLET)
    coarse, fine = (sweep.farthest(found, cut("odd", 4, steps)) for steps in (500, STEPS))
    assert np.log(coarse / fine) / np.log(STEPS / 500) == pytest.approx(2.0, abs=0.1)


def test_a_ring_off_by_a_micrometre_is_seen() -> None:
    moved = points("odd", 20, Curve.FLANK) + np.array([0.6e-3, 0.8e-3])
    assert sweep.farthest(moved, cut("odd", 20, STEPS)) > 5e-4


@pytest.mark.slow
def test_a_ring_turned_over_is_seen() -> None:
    """The control of the asymmetric one: its mirror image has other teeth."""
    over = points("odd", 20, Curve.FLANK, Curve.FILLET) * [1.0, -1.0]
    region = cut("odd", 90 - 20, STEPS)
    assert sweep.farthest(over, region) > 1e-2
