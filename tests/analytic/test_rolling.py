"""Centrodes: identities that hold for every pair, and closed forms."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.rolling import Rolling, roll
from gearcam.gears.track import Wheel
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import RING, Lobes

LAWS = {
    "two phases": (
        Phases(knots=tuple(np.radians([0, 160, 360])), ratios=(1.6, 0.4, 1.6)),
        Lobes(1, 1),
    ),
    "three phases": (
        Phases(knots=tuple(np.radians([0, 160, 270, 360])), ratios=(1.6, 0.4, "solve", 1.6)),
        Lobes(1, 1),
    ),
    "ellipse 0.9": (Ellipse(eccentricity=0.9), Lobes(1, 1)),
    "ellipse 0.99": (Ellipse(eccentricity=0.99), Lobes(1, 1)),
    "two to three": (Formula(ratio="1 + 0.2*cos(2*phi1)"), Lobes(2, 3)),
    "one to three": (Formula(r1="1 + 0.1*cos(phi1)"), Lobes(1, 3)),
    "in a ring, one to two": (Formula(ratio="1 + 0.3*cos(phi1)"), Lobes(1, 2, RING)),
    "in a ring, two to three": (
        Formula(ratio="1 + 0.05*cos(2*phi1) + 0.04*sin(4*phi1)"),
        Lobes(2, 3, RING),
    ),
}


@pytest.fixture(params=list(LAWS))
def rolling(request: pytest.FixtureRequest) -> Rolling:
    parameters, lobes = LAWS[request.param]
    teeth = (12 * lobes.n1, 12 * lobes.n2)
    law = parameters.build(lobes, DEFAULT)
    return roll(law, teeth=teeth, center_distance=100.0, module=None, tolerances=DEFAULT)


PHI = np.linspace(-4.0, 15.0, 901)


def test_euler_and_savary(rolling: Rolling) -> None:
    """kappa1 + kappa2 = (1 + w*i)/v: the sum of the curvatures follows from the ratio alone."""
    one, two = rolling.tracks[0].frames(PHI), rolling.tracks[1].frames(PHI)
    _, ratio = rolling.law.derivatives(PHI, 1)
    expected = (1.0 + rolling.mate * ratio) / one.speed
    np.testing.assert_allclose(one.kappa + two.kappa, expected, rtol=1e-9)


def test_the_centrodes_touch_and_share_their_tangent(rolling: Rolling) -> None:
    one, two = rolling.tracks[0].frames(PHI), rolling.tracks[1].frames(PHI)
    turn1 = np.exp(-1j * PHI)
    w = rolling.mate
    turn2 = np.exp(1j * w * rolling.law.phi2(PHI))
    placed = two.p * turn2 + w * rolling.center_distance
    np.testing.assert_allclose(one.p * turn1, placed, atol=1e-11)
    np.testing.assert_allclose(one.t * turn1, two.t * turn2, atol=1e-12)
    assert np.abs((one.p * turn1).imag).max() < 1e-11


@pytest.mark.parametrize("wheel", [1, 2])
def test_points_move_along_the_tangent_by_the_arc_length(rolling: Rolling, wheel: Wheel) -> None:
    h = 1e-5
    track = rolling.tracks[wheel - 1]
    low, high, here = track.frames(PHI - h), track.frames(PHI + h), track.frames(PHI)
    away = np.abs(np.mod(PHI[:, None] - rolling.law.knots + 1.0, rolling.law.lobes.period) - 1.0)
    smooth = away.min(axis=1) > 1e-3
    step = (high.p - low.p) / (high.s - low.s)
    bend = (high.t - low.t) / (high.s - low.s)
    outward = here.t * (-1j if wheel == 1 else 1j)
    np.testing.assert_allclose(step[smooth], here.t[smooth], atol=3e-5)
    np.testing.assert_allclose(bend[smooth], (-here.kappa * outward)[smooth], atol=2e-4)


def test_the_curves_close(rolling: Rolling) -> None:
    for wheel in (1, 2):
        turns = rolling.tracks[wheel - 1].around
        ends = rolling.tracks[wheel - 1].frames(np.array([0.0, turns]))
        assert abs(ends.p[1] - ends.p[0]) < 1e-10
        assert ends.s[1] - ends.s[0] == pytest.approx(rolling.tracks[wheel - 1].length, rel=1e-14)


def test_arc_length_both_ways(rolling: Rolling) -> None:
    s = np.linspace(-1.3, 2.7, 4001) * rolling.arc.length
    back = rolling.tracks[0].arc_length(rolling.arc.angle(s))
    assert np.abs(back - s).max() < 2e-12 * rolling.tracks[0].length


@pytest.mark.parametrize("eccentricity", [0.3, 0.9, 0.99])
def test_an_ellipse_has_the_perimeter_and_curvature_of_an_ellipse(eccentricity: float) -> None:
    e = eccentricity
    law = Ellipse(eccentricity=e).build(Lobes(1, 1), DEFAULT)
    made = roll(law, teeth=(41, 41), center_distance=2.0, module=None, tolerances=DEFAULT)
    assert made.tracks[0].length == pytest.approx(4 * float(mpmath.ellipe(e * e)), rel=1e-14)
    for track in made.tracks:
        kappa = track.curvature_extremes[1]
        assert 1 / kappa.max() == pytest.approx(1 - e * e, rel=1e-11)
        assert 1 / kappa.min() == pytest.approx(1 / math.sqrt(1 - e * e), rel=1e-11)


def test_exactly_one_size_is_wanted() -> None:
    law = Ellipse(eccentricity=0.1).build(Lobes(1, 1), DEFAULT)
    for sizes in ((None, None), (100.0, 1.0)):
        with pytest.raises(ValueError, match="exactly one"):
            roll(
                law,
                teeth=(20, 20),
                center_distance=sizes[0],
                module=sizes[1],
                tolerances=DEFAULT,
            )
