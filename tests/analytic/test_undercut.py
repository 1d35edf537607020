"""Undercut exactly where the closed form says, tooth by tooth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from claims.claim import LawParameters
from gearcam.gears.checks import largest_module
from gearcam.gears.spec import Rack
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from helpers_pairs import job, profile

SINE = math.sin(math.radians(20)) ** 2


@pytest.mark.parametrize(("teeth", "undercut"), [(17, True), (18, False)])
def test_a_circular_wheel_needs_17_097_teeth(teeth: int, undercut: bool) -> None:
    made = job(Constant(), (teeth, 30))
    assert bool(made.gear1.profile.undercut_teeth) is undercut
    assert pytest.approx(17.097, abs=5e-4) == 2 / SINE


@pytest.mark.parametrize(("eccentricity", "fewest"), [(0.0, 17.097), (0.3, 18.358), (0.5, 21.297)])
def test_an_ellipse_needs_the_teeth_of_its_sharpest_place(
    eccentricity: float, fewest: float
) -> None:
    """The fewest teeth as a real number, from the message's closed form; undercut below it only."""
    law = Ellipse(eccentricity=eccentricity)
    made = job(law, (40, 40))
    assert 40 * made.pair.module / largest_module(made.gear1) == pytest.approx(fewest, abs=5e-4)
    above = math.ceil(fewest)
    assert job(law, (above, above)).gear1.profile.undercut_teeth == ()
    assert job(law, (above - 2, above - 2)).gear1.profile.undercut_teeth != ()


def test_the_nail_machines_driven_wheels_have_the_undercut_that_is_known() -> None:
    two, three = profile("nail_machine_two_phase"), profile("nail_machine_three_phase")
    assert two.gear1.profile.undercut_teeth == ()
    assert two.gear2.profile.undercut_teeth == (15, 17, 18)
    assert three.gear1.profile.undercut_teeth == ()
    assert three.gear2.profile.undercut_teeth == (15, 16, 17, 18)
    assert largest_module(two.gear2) == pytest.approx(3.4259, abs=5e-5)
    assert largest_module(three.gear2) == pytest.approx(3.0416, abs=5e-5)


def test_a_trimmed_involute_starts_where_the_trochoid_crosses_it() -> None:
    """z = 10: the height at which flank and fillet cross, from a dense independent trochoid."""
    made = job(Constant(), (10, 10), module=1.0)
    gear = made.gear1
    reach = gear.profile.flanks.lowest
    assert np.ptp(reach) < 1e-9
    radius, alpha = 5.0, math.radians(20)
    # Involute from its base circle, and the envelope of the rack's tip arc, both about the same
    # tooth flank; the crossing is searched on fine polylines.
    depth, rho = 1.25 - 0.38, 0.38
    center = rho / math.cos(alpha) + depth * math.tan(alpha)
    roll = np.linspace(center, (depth / math.sin(alpha) + rho) / math.cos(alpha), 400001)
    pole = np.exp(1j * roll / radius)
    arm = pole * (-depth + 1j * (center - roll))
    trochoid = radius * pole + arm * (1 + rho / np.abs(arm))
    w = np.linspace(0.0, -radius * math.tan(alpha) / 1.0, 400001)
    pole = np.exp(1j * (-w) / radius)
    involute = pole * (radius + w * math.cos(alpha) * (math.sin(alpha) + 1j * math.cos(alpha)))
    # In polar form both are single-valued in radius near the crossing.
    grid = np.linspace(np.abs(involute).min() + 1e-6, np.abs(involute).max(), 200001)
    flank = np.interp(grid, np.abs(involute)[::-1], np.angle(involute)[::-1])
    order = np.argsort(np.abs(trochoid))
    root = np.interp(grid, np.abs(trochoid)[order], np.angle(trochoid)[order])
    inside = grid < np.abs(trochoid).max()
    crossing = grid[inside][np.flatnonzero(np.diff(np.sign((flank - root)[inside])))[-1]]
    x = np.interp(crossing, np.abs(involute)[::-1], w[::-1])
    assert reach[0] == pytest.approx(x, abs=2e-4)


@pytest.mark.parametrize(
    ("law", "teeth"),
    [
        (Formula(phi2="phi1 - 0.12*sin(2*phi1)"), (40, 40)),
        (Ellipse(eccentricity=0.6), (22, 22)),
        (Formula(r1="1 + 0.2*cos(2*phi1)"), (30, 30)),
    ],
)
def test_the_cusps_found_are_those_of_a_fine_scan(
    law: LawParameters, teeth: tuple[int, int]
) -> None:
    made = job(law, teeth)
    for gear in made.gears:
        flanks, toothing = gear.profile.flanks, gear.toothing
        w = np.linspace(-toothing.cutter.reach, 0.0, 4001)
        s = flanks.sf[:, None] - flanks.sigma[:, None] * w
        frames = toothing.frames(made.pair.rolling.arc.angle(s))
        regular = toothing.regularity(frames, flanks.sf[:, None], flanks.sigma[:, None]) > 0
        np.testing.assert_array_equal(np.isfinite(flanks.cusps.dedendum), ~regular.all(axis=1))
        for k in np.flatnonzero(~regular.all(axis=1)):
            last = w[np.flatnonzero(~regular[k])[-1]]
            assert flanks.cusps.dedendum[k] == pytest.approx(last, abs=2 * (w[1] - w[0]))


def test_a_lower_pressure_angle_undercuts_sooner() -> None:
    rack = Rack(pressure_angle=math.radians(14.5), tip_radius=0.2)
    assert job(Constant(), (25, 40), rack=rack).gear1.profile.undercut_teeth != ()
    assert job(Constant(), (25, 40), rack=Rack(tip_radius=0.2)).gear1.profile.undercut_teeth == ()
