"""Every law of the registry keeps every claim that is made for it."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from claims.claim import LawClaim
from claims.laws import LAW_CLAIMS
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.ratio import LAWS
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import RACK, RING, WHEEL, Lobes
from random_designs.law_draw import LawDraw
from random_designs.laws import parameters, random_law

CLAIMS = [
    pytest.param(claim, id=f"{name}-{number}")
    for name, claims in LAW_CLAIMS.items()
    for number, claim in enumerate(claims.values)
]

RINGS = {
    name: [claim for claim in claims.values if claim.lobes.mate == RING]
    for name, claims in LAW_CLAIMS.items()
    if name != "rack"
}


def members(name: str, count: int) -> list[Any]:
    """Random members of a law, and the same in a ring where it has more lobes than the wheel."""
    made = []
    for number in range(count):
        law, (z1, z2) = random_law(LawDraw(f"claims {name} {number}"), name)
        common = math.gcd(z1, z2)
        for mate in (WHEEL, RING) if z1 < z2 and name != "rack" else (WHEEL,):
            lobes = Lobes(z1 // common, z2 // common, mate)
            claim = LawClaim(
                parameters=parameters(law), lobes=lobes, ratio={}, driven={}, continuity=1
            )
            made.append(pytest.param(claim, id=f"{name}-random-{number}-{mate}"))
    return made


MEMBERS = [*CLAIMS, *(member for name in LAW_CLAIMS for member in members(name, 3))]


def built(claim: LawClaim) -> RatioLaw:
    return claim.parameters.build(claim.lobes, DEFAULT)


def tanh_sinh(breaks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights between breaks: x = tanh(pi/2*sinh(t)), t in equal steps.

    The weights beyond |t| = 3.25 are below rounding.
    """
    t = np.arange(-104, 105) / 32.0
    half, middle = 0.5 * np.diff(breaks)[:, None], 0.5 * (breaks[:-1] + breaks[1:])[:, None]
    x = 0.5 * np.pi * np.sinh(t)
    weights = 0.5 * np.pi * np.cosh(t) / np.cosh(x) ** 2 / 32.0
    return middle + half * np.tanh(x), half * weights


def test_the_registry_holds_exactly_the_laws_that_are_claimed() -> None:
    assert {entry.name for entry in LAWS.values()} == set(LAW_CLAIMS) == set(LAWS)
    for entry in LAWS.values():
        assert len(LAW_CLAIMS[entry.name].values) >= 1
        assert entry.source
        assert entry.doc
        assert entry.continuity
        assert dataclasses.is_dataclass(entry.parameters)


def test_every_law_but_that_of_a_rack_is_claimed_for_a_ring() -> None:
    assert set(RINGS) == set(LAWS) - {"rack"}
    assert all(RINGS.values())


@pytest.mark.parametrize("name", RINGS)
def test_a_ring_turns_slower_all_the_time(name: str) -> None:
    for law in map(built, RINGS[name]):
        assert law.mate == RING
        (_, smallest), (_, largest) = law.ratio.extremes
        assert 0.0 < smallest <= largest < 1.0
        if law.closed:
            assert float(law.phi2(2 * np.pi)) == pytest.approx(
                2 * np.pi * law.lobes.n1 / law.lobes.n2, abs=1e-13
            )


@pytest.mark.parametrize("name", [name for name, one in LAW_CLAIMS.items() if one.ratio])
def test_values_are_those_of_the_mathematics_written_again(name: str) -> None:
    ratio = LAW_CLAIMS[name].ratio
    assert ratio is not None
    claims = [*LAW_CLAIMS[name].values, *(one.values[0] for one in members(name, 12))]
    for claim in claims:
        law = built(claim)
        phi = np.linspace(0.0, law.period, 41)
        expected = ratio(claim.parameters, claim.lobes, phi, np)
        np.testing.assert_allclose(law.ratio(phi), expected, rtol=1e-13)


@pytest.mark.parametrize("claim", CLAIMS)
def test_values_are_those_of_the_closed_form(claim: LawClaim) -> None:
    law = built(claim)
    for phi, ratio in claim.ratio.items():
        assert law.derivatives(np.array([phi]), 1)[1][0] == pytest.approx(ratio, abs=1e-14)
    for phi, driven in claim.driven.items():
        assert float(law.phi2(phi)) == pytest.approx(driven, abs=2e-14)


@pytest.mark.parametrize("claim", MEMBERS)
def test_it_closes_and_repeats(claim: LawClaim) -> None:
    law = built(claim)
    assert abs(law.closure_error) < 1e-13
    if not law.lobes.closed:
        return
    assert law.driven.last == pytest.approx(law.lobes.advance, abs=1e-13)
    if law.mate != RACK:
        assert law.lobes == claim.lobes
    phi = np.linspace(0.01, law.lobes.period - 0.01, 7)
    shifted = phi + 3 * law.lobes.period
    np.testing.assert_allclose(law.phi2(shifted), law.phi2(phi) + 3 * law.lobes.advance, atol=1e-13)
    np.testing.assert_allclose(
        law.derivatives(shifted, 3)[1:], law.derivatives(phi, 3)[1:], atol=1e-10
    )


@pytest.mark.parametrize("claim", MEMBERS)
def test_derivatives_are_those_of_high_precision_differences(claim: LawClaim) -> None:
    """Orders 1 to 3 against fourth-order differences of the order below, piece by piece."""
    law = built(claim)
    for low, high in zip(law.knots[:-1], law.knots[1:], strict=True):
        x = low + (high - low) * np.array([0.13, 0.37, 0.52, 0.81])
        _, *exact = law.derivatives(x, 4)
        for order in (1, 2, 3):
            h = 2e-4 * (high - low)
            stencil = [law.derivatives(x + k * h, order)[order] for k in (-2, -1, 1, 2)]
            slope = (stencil[0] - 8 * stencil[1] + 8 * stencil[2] - stencil[3]) / (12 * h)
            scale = max(1.0, float(np.abs(exact[order]).max()))
            np.testing.assert_allclose(exact[order], slope, atol=2e-8 * scale)


@pytest.mark.parametrize("claim", MEMBERS)
def test_the_driven_angle_is_the_integral_of_the_ratio(claim: LawClaim) -> None:
    """A quadrature of another kind than the law's own, that knows only the ratio.

    With half its places it gives the same: what it misses is less than what is demanded.
    """
    law = built(claim)
    for phi in (0.3 * law.lobes.period, 0.9 * law.lobes.period):
        breaks = np.unique(np.append(np.linspace(0.0, phi, 9), law.knots[law.knots < phi]))
        places, weights = tanh_sinh(breaks)
        values = law.derivatives(places.ravel(), 1)[1].reshape(places.shape) * weights
        integral = float(values.sum())
        assert 2.0 * float(values[:, ::2].sum()) == pytest.approx(integral, abs=1e-13)
        assert float(law.phi2(phi)) == pytest.approx(integral, abs=1e-13)


@pytest.mark.parametrize("claim", CLAIMS)
def test_continuity_is_as_claimed_and_seen_from_both_sides(claim: LawClaim) -> None:
    law = built(claim)
    assert min((jump.order for jump in law.jumps), default=5) - 2 == claim.continuity
    h = 1e-7
    for knot in law.knots[1:] if law.lobes.closed else law.knots[1:-1]:
        before, after = law.derivatives(np.array([knot - h, knot + h]), 2)[2]
        scale = max(1.0, float(np.abs(law.derivatives(law.knots[:-1] + 0.1, 3)[3]).max()))
        assert abs(after - before) < 50 * h * scale


@pytest.mark.parametrize("claim", CLAIMS)
def test_the_error_estimate_covers_what_is_missed(claim: LawClaim) -> None:
    """The closed form tells the true error; both are within a rounding of the closed form."""
    law = built(claim)
    for phi, driven in claim.driven.items():
        assert abs(float(law.phi2(phi)) - driven) <= law.error + np.spacing(driven)
    # no driven angle is known better than the last digit of the lap that it is a part of
    assert np.spacing(law.advance) < law.error < 1e-13


@pytest.mark.parametrize("claim", MEMBERS)
def test_the_error_estimate_sees_a_wrong_integral(claim: LawClaim) -> None:
    """Control: off by a constant, or integrated from another ratio, 1e-9 rad each."""
    law = built(claim)
    off = replace(law, driven=law.driven.shifted(1e-9))
    assert 1e-9 <= off.error <= 2.001e-9  # twice where the law was solved: its end is off too
    steeper = replace(law, ratio=law.ratio.shifted(1e-9 / law.period))
    assert steeper.error == pytest.approx(2e-9, rel=1e-3)  # both may be rounded
