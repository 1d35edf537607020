"""Centrodes of internal pairs against values in thirty digits, closed forms and trapezia."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.rolling import Rolling, roll
from gearcam.laws.ratio.centrodes import EccentricCircle, Limacon, Lobed, LogSpiral
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.shapes import BSplineLaw
from gearcam.laws.ratio.span import RING, WHEEL, Lobes

DIGITS = 2e-13
"""Rounding, in parts of a value."""


@dataclass(frozen=True)
class Known:
    """A pair by values in thirty digits: mm, 1/mm; curvatures positive where a curve is round."""

    law: Any
    teeth: tuple[int, int]
    module: float
    distance: float
    ratios: tuple[float, float]
    wheel: tuple[float, float]
    ring: tuple[float, float]
    angles: tuple[float, float]
    """Driver angles, deg, at which the ring's curvature is smallest and largest."""


PAIRS = {
    "ellipse 1 : 2": Known(
        Ellipse(eccentricity=0.3), (24, 48), 2.0, 22.87542426332165,
        (0.42910015222746, 0.58261456842243), (0.0388374616, 0.0447392551),
        (0.011535130992333, 0.03166779578069), (0, 180),
    ),
    "ellipse 2 : 3": Known(
        Ellipse(eccentricity=0.2), (40, 60), 2.0, 18.96124240457442,
        (0.62342211015523, 0.71291094301063), (0.010619023249028, 0.042476092996114),
        (-0.0013776448529665, 0.03637888225469), (0, 90),
    ),
    "ellipse 3 : 5": Known(
        Ellipse(eccentricity=0.1), (36, 60), 1.0, 11.70222537594158,
        (0.57643356193646, 0.62452990903345), (0.011416714331359, 0.10275042898223),
        (-0.015179839299116, 0.083460572523826), (0, 60),
    ),
    "ellipse 1 : 3": Known(
        Ellipse(eccentricity=0.5), (20, 60), 3.0, 52.84919975012854,
        (0.23301861563441, 0.47683362468102), (0.026968477298278, 0.041520687007453),
        (-0.0062477039937268, 0.030659573346232), (0, 180),
    ),
    "limacon": Known(
        Limacon(eccentricity=0.2), (30, 60), 2.0, 29.40294362584882,
        (0.44694638738774, 0.5479642582585), (0.031563289187018, 0.034361756938711),
        (0.0082883677059438, 0.020049868929244), (180, 0),
    ),
    "lobed": Known(
        Lobed(eccentricity=0.1), (32, 80), 1.5, 35.57390222368966,
        (0.37547009096655, 0.42356643806354), (0.02597609606562, 0.052166870611121),
        (-0.0032250319776103, 0.030114998247393), (90, 0),
    ),
    "eccentric circle": Known(
        EccentricCircle(eccentricity=0.25), (28, 56), 2.0, 27.11088342345192,
        (0.43649167310371, 0.56350832689629), (1 / 28, 1 / 28),
        (0.0088805558620814, 0.02324309505418), (180, 0),
    ),
    "ratio": Known(
        Formula(ratio="0.5*(1 + 0.3*cos(phi1))"), (30, 60), 2.0, 25.21575753039528,
        (0.35, 0.65), (0.025089591715097, 0.037709652704687),
        (-0.022782967960644, 0.027959881234937), (180, 0),
    ),
}  # fmt: skip


def rolled(law: Any, teeth: tuple[int, int], module: float) -> Rolling:
    common = math.gcd(*teeth)
    lobes = Lobes(teeth[0] // common, teeth[1] // common, RING)
    made = law.build(lobes, DEFAULT)
    return roll(made, teeth=teeth, center_distance=None, module=module, tolerances=DEFAULT)


@cache
def known(name: str) -> Rolling:
    pair = PAIRS[name]
    return rolled(pair.law, pair.teeth, pair.module)


@pytest.mark.parametrize("name", PAIRS)
def test_distance_and_ratios_are_those_known(name: str) -> None:
    pair, made = PAIRS[name], known(name)
    assert made.center_distance == pytest.approx(pair.distance, rel=DIGITS)
    (_, low), (_, high) = made.law.ratio.extremes
    assert (low, high) == pytest.approx(pair.ratios, abs=2e-14)


@pytest.mark.parametrize("name", PAIRS)
def test_lengths_are_in_the_ratio_of_the_tooth_counts(name: str) -> None:
    pair, (wheel, ring) = PAIRS[name], known(name).tracks
    assert wheel.length == pytest.approx(math.pi * pair.module * pair.teeth[0], rel=1e-15, abs=0)
    assert ring.length * pair.teeth[0] == pytest.approx(
        wheel.length * pair.teeth[1], rel=1e-15, abs=0
    )


@pytest.mark.parametrize("name", PAIRS)
def test_curvatures_are_those_known(name: str) -> None:
    """A ring's is negative where it is round."""
    pair, (first, second) = PAIRS[name], known(name).curvature_extremes
    # nine digits of the first pair's are known
    digits = 1e-9 if name == "ellipse 1 : 2" else 1e-12
    assert (first[1].min(), first[1].max()) == pytest.approx(pair.wheel, rel=digits, abs=0)
    order = np.argsort(-second[1])
    flattest, roundest = order[0], order[-1]
    found = (-second[1][flattest], -second[1][roundest])
    assert found == pytest.approx(pair.ring, rel=1e-12, abs=0)
    missed = second[0][[flattest, roundest]] - np.radians(pair.angles)
    period = known(name).law.period  # both ends of a lobe are one place
    assert missed == pytest.approx(period * np.round(missed / period), abs=1e-7)


@pytest.mark.parametrize("name", PAIRS)
def test_a_ring_closes_by_the_trapezia_of_its_ratio(name: str) -> None:
    """Trapezia of a periodic analytic function are exact: mean ratio, and length by chords."""
    made, pair = known(name), PAIRS[name]
    phi = np.linspace(0.0, 2.0 * math.pi, 4096, endpoint=False)
    _, ratio = made.law.derivatives(phi, 1)
    assert float(ratio.mean()) == pytest.approx(pair.teeth[0] / pair.teeth[1], abs=1e-15)
    one, two = (track.frames(phi).p for track in made.tracks)
    radius = np.abs(one)
    np.testing.assert_allclose(ratio, radius / (made.center_distance + radius), rtol=1e-14)
    np.testing.assert_allclose(np.abs(two) - radius, made.center_distance, rtol=1e-14)
    assert np.unwrap(np.angle(two)) == pytest.approx(made.law.phi2(phi), abs=1e-13)


@pytest.mark.parametrize("e", [0.0, 0.05, 0.3, 0.7, 0.95])
@pytest.mark.parametrize("lobes", [(1, 2), (2, 3), (3, 5), (5, 6), (1, 7)])
def test_closed_forms_of_the_centre_distance(e: float, lobes: tuple[int, int]) -> None:
    ring = Lobes(*lobes, RING)
    k = lobes[1] / lobes[0]
    polar = (math.sqrt(k * k - e * e * (k * k - 1)) - 1) / (1 - e * e)
    solved = Ellipse(eccentricity=e).build(ring, DEFAULT).solved
    assert solved["center_distance_over_semi_latus_rectum"] == pytest.approx(polar, rel=1e-12)
    q = 1 - 1 / k
    wave = q * (q + math.sqrt(q * q + (1 - q * q) * (1 - e * e))) / (1 - q * q)
    solved = Lobed(eccentricity=e).build(ring, DEFAULT).solved
    assert solved["center_distance_over_scale"] == pytest.approx(wave, rel=1e-12)
    # the same curves as formulas: the centre distance is solved
    for text, distance in ((f"1/(1 + {e}*cos(n))", polar), (f"1 + {e}*cos(n)", wave)):
        shape = Formula(r1=text.replace("(n)", f"({lobes[0]}*phi1)"))
        found = shape.build(ring, DEFAULT).solved["center_distance_over_scale"]
        assert found == pytest.approx(distance, rel=1e-12)


@pytest.mark.parametrize("e", [0.0, 0.2, 0.6, 0.9])
def test_an_eccentric_circle_in_a_ring_of_twice_the_teeth(e: float) -> None:
    law = EccentricCircle(eccentricity=e).build(Lobes(1, 2, RING), DEFAULT)
    distance = law.solved["center_distance_over_scale"]
    assert distance == pytest.approx(math.sqrt(1 - e * e), rel=1e-12)
    phi = np.linspace(0.0, 3.0, 31)
    np.testing.assert_allclose(law.ratio(phi) + law.ratio(phi + math.pi), 1.0, rtol=1e-13)


@pytest.mark.parametrize("teeth", [(20, 30), (35, 36), (10, 97)])
def test_round_rings(teeth: tuple[int, int]) -> None:
    distance = 3.0 * (teeth[1] - teeth[0]) / 2.0
    circle = BSplineLaw(radii=(5.0,) * 4)
    for law in (Constant(), Formula(r1="7"), circle, Lobed(eccentricity=0.0)):
        made = rolled(law, teeth, 3.0)
        assert made.center_distance == pytest.approx(distance, rel=1e-12)


def test_the_far_ends_of_the_mean_ratio() -> None:
    """Rings hardly larger than the wheel, and far larger: the root lies at the bracket's ends."""
    for teeth in ((99, 100), (3, 9000)):
        n1, n2 = (count // math.gcd(*teeth) for count in teeth)
        law = Formula(r1=f"1 + 0.3*cos({n1}*phi1)").build(Lobes(n1, n2, RING), DEFAULT)
        assert abs(law.closure_error) < 1e-13
        same = Lobed(eccentricity=0.3).build(Lobes(n1, n2, RING), DEFAULT).solved
        assert law.solved == pytest.approx(same, rel=1e-12)


def test_what_an_error_of_the_radius_does_to_the_ring() -> None:
    """``di/dr = c/(c - w*r)^2``: the same function drives a wheel and a ring."""
    shape = Formula(r1=lambda phi1: 1 / (1 + 0.4 * np.cos(phi1)))
    r = 1 / (1 + 0.4 * np.cos(np.linspace(0.0, 2.0 * math.pi, 4096)))
    per_error = []
    for mate in (WHEEL, RING):
        law = shape.build(Lobes(1, 2, mate), DEFAULT)
        c = law.solved["center_distance_over_scale"]
        per_error.append(law.function_error / float((c / (c - mate * r) ** 2).mean()))
    assert 0.0 < per_error[0] == pytest.approx(per_error[1], rel=0.02, abs=0)


SPIRAL = LogSpiral(ratios=(0.25, 0.5), driven_travel=math.log(1.5))
SECTORS = {
    "spiral": SPIRAL,
    "falling spiral": LogSpiral(ratios=(0.9, 0.4), driven_travel=1.0),
    "phases": Phases(
        knots=(0.0, 0.5, 1.5, "solve"), ratios=(0.4, 0.4, 0.8, 0.8), driven_travel=2.0
    ),
    "slope at the ends": Formula(phi2="phi1/2 + phi1**2/20", driver_travel=2.0, driven_travel=1.2),
}


@cache
def sector(name: str) -> Rolling:
    law = SECTORS[name].build(Lobes(1, 1, RING), DEFAULT)
    return roll(law, teeth=(40, 40), center_distance=50.0, module=None, tolerances=DEFAULT)


def test_the_mate_of_a_spiral_is_a_spiral_that_grows_the_same_way() -> None:
    """``r1/A = exp(phi1)/3`` and ``r2 = r1 + A``, which is ``4/3*A*exp(phi2)``."""
    made = sector("spiral")
    phi = np.linspace(0.0, math.log(3.0), 21)
    one, two = (track.frames(phi) for track in made.tracks)
    np.testing.assert_allclose(np.abs(one.p), 50.0 / 3.0 * np.exp(phi), rtol=1e-13)
    np.testing.assert_allclose(np.abs(two.p), 200.0 / 3.0 * np.exp(np.angle(two.p)), rtol=1e-13)
    for frames in (one, two):  # a spiral's angle to its radius is the same everywhere
        np.testing.assert_allclose(np.angle(frames.t / frames.p), math.pi / 4, rtol=1e-13)


@pytest.mark.parametrize("name", SECTORS)
def test_open_centrodes_roll_beyond_both_ends(name: str) -> None:
    made = sector(name)
    low, high = made.arc.angle(np.array([-made.margin, made.arc.length + made.margin]))
    assert low < -1e-3 < made.law.period + 1e-3 < high
    phi = np.linspace(low, high, 401)
    one, two = (track.frames(phi) for track in made.tracks)
    ratio, driven = made.law.ratio(phi), made.law.driven(phi)
    assert 0.0 < ratio.min() <= ratio.max() < 1.0
    np.testing.assert_allclose(one.kappa + two.kappa, (1.0 - ratio) / one.speed, rtol=1e-12)
    turned = two.p * np.exp(-1j * driven) - made.center_distance
    np.testing.assert_allclose(one.p * np.exp(-1j * phi), turned, atol=1e-12)
    np.testing.assert_allclose(one.s, two.s, atol=1e-12)
    # no corner where the continuation begins
    ends = np.array([0.0, made.law.period])
    for track in made.tracks:
        before, behind = (track.frames(ends + step) for step in (-1e-9, 1e-9))
        np.testing.assert_allclose(before.t, behind.t, atol=1e-8)
