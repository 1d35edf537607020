"""The closed logarithmic spiral: two equal wheels, joints, teeth, and what cannot be."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam as gc
from claims.laws.centrodes import exact_nautilus
from claims.test_laws import tanh_sinh
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.centrodes import LogSpiral
from gearcam.laws.ratio.span import RING, Lobes
from helpers_pairs import profile

CASES = [(0.5, 95.386), (2.0, 80.0), (0.4, 60.0), (0.9, 180.0), (0.999, 120.0), (0.1, 20.0)]


def law_of(start: float, degrees: float) -> RatioLaw:
    law = LogSpiral(ratios=(start, "solve"), return_angle=math.radians(degrees))
    return law.build(Lobes(1, 1), DEFAULT)


@pytest.mark.parametrize(("start", "degrees"), CASES)
def test_both_centrodes_are_one_curve(start: float, degrees: float) -> None:
    """phi2 by a quadrature of the ratio, r1 and r2 from it: wheel 2 is wheel 1, turned."""
    law, joint = law_of(start, degrees), 2 * math.pi - math.radians(degrees)
    phi1 = np.concatenate([np.linspace(0, joint, 9), np.linspace(joint, 2 * math.pi, 12)[1:]])
    x, weights = tanh_sinh(phi1)
    driven = np.append(0.0, np.cumsum((law.ratio(x) * weights).sum(axis=1)))
    i = law.ratio(phi1)
    # the middle of the spiral is one radius: there wheel 2 has turned as far as wheel 1
    same = np.mod(joint - driven, 2 * math.pi)
    other = law.ratio(same)
    np.testing.assert_allclose(other / (1 + other), 1 / (1 + i), atol=1e-12, rtol=0)


@pytest.mark.parametrize(("start", "degrees"), CASES)
def test_it_agrees_with_thirty_digits(start: float, degrees: float) -> None:
    law = law_of(start, degrees)
    ends = (start, 1 / start)
    exact = exact_nautilus(LogSpiral(ratios=ends, return_angle=math.radians(degrees)))(None)
    for phi in np.linspace(0, 2 * math.pi, 41).tolist():
        found = exact.ratio(phi)
        i, slope = (float(one[0]) for one in law.ratio.derivatives(np.array([phi]), 1))
        assert i == pytest.approx(float(found.v), rel=1e-12)
        assert slope == pytest.approx(float(found.d), rel=1e-9, abs=1e-11)


@pytest.mark.parametrize(("start", "degrees"), CASES[:5])
def test_it_is_c2_at_both_joints_and_no_smoother(start: float, degrees: float) -> None:
    """The third derivative jumps where the odd polynomial begins and ends."""
    law = law_of(start, degrees)
    assert law.ratio.continuity == (2, 2)
    assert [jump.theta for jump in law.jumps] == pytest.approx(
        [2 * math.pi - math.radians(degrees), 0.0]
    )
    assert law.closure_error == pytest.approx(0.0, abs=1e-14)


def test_the_ratio_leaves_its_ends_by_little() -> None:
    """It rises on until the return has turned it: less than 4 % for a spiral from 1 to 2."""
    (_, low), (_, high) = law_of(0.5, 95.386).ratio_range
    assert 1.0 < high / 2.0 < 1.04
    assert low * high == pytest.approx(1.0, abs=1e-12)


def region(points: Any) -> Any:
    return shapely.Polygon(np.column_stack([points.real, points.imag]))


def test_the_wheels_of_the_profile_are_one_part() -> None:
    """Turned by the angle between both centrodes the outlines agree to the chord tolerance."""
    made = profile("nautilus")
    one, two = (gear.outline @ [1, 1j] for gear in made.gears)
    # the point of wheel 2 that meets the driver at phi1 = 0 is the driver's at 360 - return
    turned = np.exp(1j * (math.pi + math.radians(360 - 95.386)))
    apart = region(one).hausdorff_distance(region(two * turned))
    assert apart < 5e-3
    beside = region(one).hausdorff_distance(region(two * turned * np.exp(0.01j)))
    assert beside > 0.1
    study = gc.build(made.design).mesh(steps=8)
    assert study.facts["meshing.interference_steps"] == 0


REFUSED = {
    "unequal wheels": ((0.5, 2.0), Lobes(2, 3), "an external pair with equal tooth counts"),
    "a ring": ((0.5, 2.0), Lobes(1, 2, RING), "an external pair with equal tooth counts"),
    "other ratios": ((0.5, 2.2), Lobes(1, 1), "its ratios are k and 1/k"),
    "no spiral": ((1.0, 1.0), Lobes(1, 1), "changes from start to end"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_close_is_refused(name: str) -> None:
    ratios, lobes, words = REFUSED[name]
    law = LogSpiral(ratios=ratios, return_angle=1.5)
    with pytest.raises(InfeasibleError, match=words):
        law.build(lobes, DEFAULT)


WRONG = {
    "neither": ({"ratios": [0.5, 2]}, "law: neither return_deg nor driven_travel_deg is given"),
    "both": (
        {"ratios": [0.5, 2], "return_deg": 80, "driven_travel_deg": 90},
        "law.driven_travel_deg: 90: is given beside return_deg = 80",
    ),
    "an open one": ({"ratios": [0.5, "solve"], "driven_travel_deg": 90}, "is not possible here"),
    "twice": ({"ratios": ["solve", "solve"], "return_deg": 90}, "is not possible here"),
    "too much": ({"ratios": [1e-4, "solve"], "return_deg": 90}, "0.0001 is out of range"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_reads_wrong_is_named(name: str) -> None:
    law, words = WRONG[name]
    pair = {"module_mm": 2, "teeth": [48, 48]}
    with pytest.raises(DesignError, match=words):
        gc.design({"kind": "gear-pair", "law": {"type": "log-spiral", **law}, "pair": pair})
