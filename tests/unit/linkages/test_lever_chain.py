"""A chain that a wheel winds up: its free part touches the wheel and goes as fast as its rim."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

from gearcam.linkages.chain import LeverChain, roots_in
from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.elements import GivenMotion
from gearcam.linkages.linkage import Linkage
from gearcam.numeric.arrays import Array
from helpers_linkages import linkage, variable


def hoist(rng: np.random.Generator) -> LeverChain:
    """A lever that hangs down and a wheel above it, at either side."""
    wind = float(rng.choice([-1.0, 1.0]))
    radius, length = rng.uniform(20.0, 120.0), rng.uniform(400.0, 2000.0)
    # the chain leaves the wheel at the side where it is wound up, away from the lever
    center = complex(wind * length * rng.uniform(0.3, 0.7), length * rng.uniform(0.1, 0.4))
    start = -0.5 * pi
    swing = sorted([start - wind * 0.05, start + wind * rng.uniform(0.4, 0.8)])
    return LeverChain(
        "lever", "B", "q", 0j, center, radius, length, start, (swing[0], swing[1]), wind
    )


def over(chain: LeverChain, degrees: float) -> Linkage:
    return linkage(
        GivenMotion("q", lambda q, order: variable(q, order) * chain.wind),
        chain,
        knots_deg=(0.0, degrees),
        closed=False,
    )


def touching(chain: LeverChain, joint: Array) -> Array:
    """Where the chain leaves the wheel: of two tangents that which turning on winds up."""
    way = joint - chain.center
    found = np.empty(joint.shape, dtype=complex)
    for side in (1.0, -1.0):
        spoke = way / np.abs(way) * np.exp(1j * side * np.arccos(chain.radius / np.abs(way)))
        rim = 1j * chain.wind * spoke
        at = chain.center + chain.radius * spoke
        pulls = np.real(rim.conj() * (at - joint)) > 0.0
        found = np.where(pulls, at, found)
    return found


CHAINS = [hoist(np.random.default_rng([48, index])) for index in range(30)]


@pytest.mark.parametrize("chain", CHAINS)
def test_the_free_chain_goes_as_fast_as_the_rim(chain: LeverChain) -> None:
    made = settled(over(chain, 30.0))
    q = np.linspace(0.0, radians(30.0), 50)
    joint, speed, *_ = made.track("B", q, 3).derivatives()
    assert np.abs(np.abs(joint) - chain.length).max() < 1e-12 * chain.length
    assert joint[0] == pytest.approx(chain.length * np.exp(1j * chain.start), abs=1e-9)
    at = touching(chain, joint)
    free = at - joint
    # a tangent
    assert np.abs(np.real(free.conj() * (at - chain.center))).max() < 1e-8 * chain.length
    # pulled up, as the wheel turns by `wind` times the driver's angle
    pulled = np.real(speed * free.conj()) / np.abs(free)
    assert np.abs(pulled - chain.radius).max() < 1e-10 * chain.length


@pytest.mark.parametrize("chain", CHAINS[:10])
def test_its_derivatives_are_those_of_its_positions(chain: LeverChain) -> None:
    made, q = settled(over(chain, 30.0)), np.radians(np.linspace(5.0, 25.0, 9))
    exact = made.track("lever.angle", q, 3).derivatives()
    for order in (1, 2, 3):
        errors = []
        for step in (0.08, 0.04):
            ahead, behind = (
                made.track("lever.angle", q + sign * step, order - 1).derivatives()[order - 1]
                for sign in (1.0, -1.0)
            )
            errors.append(np.abs((ahead - behind) / (2.0 * step) - exact[order]).max())
        assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.3)


@pytest.mark.parametrize("chain", CHAINS)
def test_refused_where_the_lever_is_at_its_limit(chain: LeverChain) -> None:
    """Just inside the range it is not yet there, at its end it is."""
    made = over(chain, 2000.0)
    with pytest.raises(NotClosingError) as caught:
        settled(made)
    ((begin, end),) = caught.value.closing.ranges
    assert begin == 0.0
    low, high = chain.stretch
    edge = high if chain.wind > 0.0 else low
    reached = made.track("lever.angle", np.array([end, end - 1e-3]), 0).derivatives()[0]
    assert reached[0] == pytest.approx(edge, abs=1e-7)
    assert abs(reached[1] - edge) > 1e-7
    settled(over(chain, np.degrees(end) * (1.0 - 1e-6)))
    with pytest.raises(NotClosingError):
        settled(over(chain, np.degrees(end) * (1.0 + 1e-4)))
    assert roots_in(chain, chain.wind * 0.5 * end) == 1
