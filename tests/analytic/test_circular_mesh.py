"""Circular wheels as a limit of the exact contact: the formulas of 000, section 4.1.3.

Written from base circles and the line of action; eqs. (4.57) to (4.62), (4.84), (4.85), the last
one corrected (see docs/sources.md).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.gears.pair import Gear
from gearcam.gears.spec import Rack
from gearcam.laws.ratio.constant import Constant
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import touches
from gearcam.meshing.patches import patches
from helpers_pairs import job

MODULE = 2.5
CASES = [
    ((20, 20), Rack()),
    ((18, 27), Rack()),
    ((30, 20), Rack()),
    ((25, 75), Rack()),
    ((40, 24), Rack(pressure_angle=math.radians(25.0), addendum=0.8, dedendum=1.0, tip_radius=0.3)),
]


@dataclass(frozen=True)
class Spur:
    """A pair of spur gears without profile shift, by the textbook."""

    z1: int
    z2: int
    alpha: float
    addendum: float

    @property
    def r1(self) -> float:
        return 0.5 * MODULE * self.z1

    @property
    def r2(self) -> float:
        return 0.5 * MODULE * self.z2

    def base(self, radius: float) -> float:
        return radius * math.cos(self.alpha)

    @property
    def line(self) -> float:
        """a*sin(alpha): the line of action between the base circles, N1 to N2."""
        return (self.r1 + self.r2) * math.sin(self.alpha)

    def tip(self, radius: float) -> float:
        """Distance of the contact from N at a tip circle: sqrt(ra^2 - rb^2)."""
        return math.sqrt((radius + self.addendum * MODULE) ** 2 - self.base(radius) ** 2)

    @property
    def contact_ratio(self) -> float:
        """(4.57), (4.62)."""
        length = self.tip(self.r1) + self.tip(self.r2) - self.line
        return length / (math.pi * MODULE * math.cos(self.alpha))

    @property
    def active_radii(self) -> tuple[float, float]:
        """(4.58), (4.59): where the mates' tips touch."""
        return (
            math.hypot(self.base(self.r1), self.line - self.tip(self.r2)),
            math.hypot(self.base(self.r2), self.line - self.tip(self.r1)),
        )


def spur(teeth: tuple[int, int], rack: Rack) -> tuple[Spur, tuple[Gear, Gear]]:
    made = job(Constant(), teeth, module=MODULE, rack=rack)
    used = made.pair.rack
    return Spur(*teeth, used.pressure_angle, used.addendum), made.gears


@pytest.mark.parametrize(("teeth", "rack"), CASES)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_contact_ratio_and_active_radii(teeth: tuple[int, int], rack: Rack, side: int) -> None:
    truth, gears = spur(teeth, rack)
    pairs = flank_pairs(gears, side)
    assert pairs.arcs.ratios == pytest.approx(truth.contact_ratio, rel=1e-9)
    # the ends of the arc of contact of tooth 1 are where the mates' tips touch
    start, end = (float(edge[0]) for edge in (pairs.arcs.start, pairs.arcs.end))
    rolling = gears[0].pair.rolling
    phases = np.array([start + 1e-12, end - 1e-12])
    found = contacts(pairs, phases)
    radii = np.stack([np.abs(found.point), np.abs(found.point - rolling.center_distance)])
    lowest = [float(values.min()) for values in radii]
    assert lowest == pytest.approx(truth.active_radii, rel=1e-9)
    tips = [r + truth.addendum * MODULE for r in (truth.r1, truth.r2)]
    assert [float(values.max()) for values in radii] == pytest.approx(tips, rel=1e-9)


@pytest.mark.parametrize(("teeth", "rack"), CASES)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_sliding_curvature_and_force(teeth: tuple[int, int], rack: Rack, side: int) -> None:
    truth, gears = spur(teeth, rack)
    found = contacts(flank_pairs(gears, side), np.linspace(0.0, 1.0, 97))
    assert len(found.step) > 97
    axis = truth.r1 + truth.r2
    rho1 = np.sqrt(np.abs(found.point) ** 2 - truth.base(truth.r1) ** 2)
    rho2 = truth.line - rho1
    assert np.abs(found.point - axis) == pytest.approx(
        np.hypot(truth.base(truth.r2), rho2), rel=1e-9
    )
    i12 = truth.z2 / truth.z1  # of the angular speeds
    assert found.specific[0] == pytest.approx(1.0 - rho2 / (i12 * rho1), rel=1e-9, abs=1e-9)
    assert found.specific[1] == pytest.approx(1.0 - i12 * rho1 / rho2, rel=1e-9, abs=1e-9)
    assert found.curvature == pytest.approx(1.0 / rho1 + 1.0 / rho2, rel=1e-9)
    assert found.pressure_angle == pytest.approx(truth.alpha, rel=1e-9)
    assert found.lever[0] == pytest.approx(truth.base(truth.r1), rel=1e-9)
    assert found.lever[1] == pytest.approx(truth.base(truth.r2), rel=1e-9)
    # speeds along the flanks are rho*omega; driving, the contact climbs to the driver's tip
    assert found.sliding == pytest.approx(-side * (rho1 - rho2 / i12), rel=1e-9, abs=1e-9)
    # the driver turns clockwise: at the pitch point, left of the driven axis, it presses down
    assert np.all(np.sign(found.force.imag) == side)
    assert np.all(found.force.real > 0.0)


@pytest.mark.parametrize(("teeth", "rack"), CASES)
@pytest.mark.parametrize("more", [0.1, -0.05])
def test_play_at_another_centre_distance(teeth: tuple[int, int], rack: Rack, more: float) -> None:
    """The operating pressure angle and the involute function give the play exactly."""
    truth, gears = spur(teeth, rack)
    distance = truth.r1 + truth.r2 + more
    phases = np.linspace(0.0, 2.0 * math.pi / teeth[0], 23)
    turns = []
    for side in (DRIVE, COAST):
        found = touches(flank_pairs(gears, side, distance), phases)
        outward = np.full(len(phases), -np.inf)
        np.maximum.at(outward, found.step, -side * found.turn)
        turns.append(-side * outward)
    operating = math.acos((truth.base(truth.r1) + truth.base(truth.r2)) / distance)

    def inv(angle: float) -> float:
        return math.tan(angle) - angle

    opened = inv(operating) - inv(truth.alpha)
    # both teeth lose 2*(inv a' - inv a) of their angle against the space: j over r2'
    play = 2.0 * opened * (truth.z1 + truth.z2) / truth.z2
    assert turns[1] - turns[0] == pytest.approx(play, abs=1e-9)
    assert float(np.ptp(turns[0])) < 1e-11
    assert turns[0] == pytest.approx(-0.5 * play, abs=1e-9)


@pytest.mark.parametrize(("teeth", "rack"), CASES)
def test_lens_areas(teeth: tuple[int, int], rack: Rack) -> None:
    _, gears = spur(teeth, rack)
    overclosure = math.radians(0.005)
    phases = np.linspace(0.0, 2.0 * math.pi / teeth[0], 41)
    found = patches(flank_pairs(gears, DRIVE), phases, overclosure)
    whole = np.isfinite(found.closed)
    assert np.count_nonzero(whole) > 30
    # near the base circle the curvature changes within the lens
    error = np.abs(found.area[whole] / found.closed[whole] - 1.0)
    assert np.median(error) < 1e-3
    assert error.max() < 0.01


@pytest.mark.parametrize(("teeth", "rack"), CASES)
def test_single_and_double_pair_arcs(teeth: tuple[int, int], rack: Rack) -> None:
    truth, gears = spur(teeth, rack)
    pairs = flank_pairs(gears, DRIVE)
    start, end, carrying = pairs.arcs.stretches
    assert end[:-1] == pytest.approx(start[1:], abs=1e-12)
    assert float((end - start).sum()) == pytest.approx(2.0 * math.pi, rel=1e-12)
    mean = float(((end - start) * carrying).sum()) / (2.0 * math.pi)
    assert mean == pytest.approx(truth.contact_ratio, rel=1e-9)
    middle = 0.5 * (start + end)
    assert np.array_equal(pairs.arcs.carrying(middle), carrying)
