"""How contacts share a load: against closed forms of springs, and the equations themselves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.mechanics.material import MaterialSpec
from gearcam.stress import sharing
from gearcam.stress.sharing import ContactWidths, share

STIFF = ContactWidths(material=MaterialSpec(), local=0.0, spread=0.5)
"""Contacts that close by nothing beside the compliance: all is linear."""

STEEL = ContactWidths(material=MaterialSpec(), local=2.0 / (math.pi * 226374.0), spread=0.5)


def springs(*, gap: float, coupled: float = 0.0) -> tuple[Any, Any, Any, Any, Any, Any]:
    compliance = np.array([[[2e-5, coupled], [coupled, 3e-5]]])
    lever, gaps = np.array([[40.0, 42.0]]), np.array([[0.0, gap]])
    return compliance, lever, lever, gaps, np.full((1, 2), 0.1), np.array([4000.0])


def test_two_springs_share_a_load() -> None:
    compliance, lever, gain, gap, curvature, load = springs(gap=5e-4)
    made = share(compliance, lever, gain, gap, curvature, load, STIFF)
    # F_i = (a_i*e - g_i)/c_i and sum F_i*a_i = T
    stiffness = 40.0**2 / 2e-5 + 42.0**2 / 3e-5
    lag = (4000.0 + 42.0 * 5e-4 / 3e-5) / stiffness
    assert made.lag == pytest.approx([lag], rel=1e-12)
    assert made.force[0] == pytest.approx(
        [40.0 * lag / 2e-5, (42.0 * lag - 5e-4) / 3e-5], rel=1e-12
    )
    assert made.stiffness == pytest.approx([stiffness], rel=1e-12)


def test_a_wide_gap_stays_open() -> None:
    compliance, lever, gain, gap, curvature, load = springs(gap=1e-2)
    made = share(compliance, lever, gain, gap, curvature, load, STIFF)
    assert made.force[0] == pytest.approx([100.0, 0.0])
    assert made.lag == pytest.approx([100.0 * 2e-5 / 40.0], rel=1e-12)
    assert made.stiffness == pytest.approx([40.0**2 / 2e-5], rel=1e-12)


def test_the_rim_couples_neighbours() -> None:
    """A force on one tooth moves the other too: the share moves towards the stiffer one."""
    loose = share(*springs(gap=0.0), STIFF).force[0]
    tied = share(*springs(gap=0.0, coupled=1e-5), STIFF).force[0]
    assert tied[0] > loose[0]
    # by hand: the inverse of the compliance times the levers
    inverse = np.linalg.inv(np.array([[2e-5, 1e-5], [1e-5, 3e-5]]))
    expected = inverse @ [40.0, 42.0]
    assert tied == pytest.approx(4000.0 * expected / (expected @ [40.0, 42.0]), rel=1e-12)


def test_the_contacts_close_as_half_planes_do() -> None:
    """The equations hold with the logarithm, and the stiffness is the slope of the load."""
    compliance, lever, _, gap, curvature, _ = springs(gap=2e-4, coupled=1e-6)
    many = np.linspace(500.0, 8000.0, 7)
    compliance, lever, gap, curvature = (
        np.repeat(one, len(many), axis=0) for one in (compliance, lever, gap, curvature)
    )
    made = share(compliance, lever, lever, gap, curvature, many, STEEL)
    width = np.sqrt(4.0 * made.force / (np.pi * 0.1 * STEEL.material.contact_modulus))
    with np.errstate(divide="ignore", invalid="ignore"):
        local = made.force * STEEL.local * (0.5 + 2.0 * np.log(0.5 / width))
    local = np.nan_to_num(local)
    closed = np.einsum("nij,nj->ni", compliance, made.force) + local + gap
    carries = made.force > 0.0
    assert carries[:, 0].all()
    assert carries[-1, 1]
    assert np.abs(closed - made.lag[:, None] * lever)[carries].max() < 1e-12
    assert (closed >= made.lag[:, None] * lever)[~carries].all()
    assert (made.force * lever).sum(axis=1) == pytest.approx(many, rel=1e-12)
    more = share(compliance, lever, lever, gap, curvature, many * (1.0 + 1e-5), STEEL)
    slope = 1e-5 * many / (more.lag - made.lag)
    assert made.stiffness == pytest.approx(slope, rel=1e-3)


def test_friction_changes_the_levers_of_equilibrium_only() -> None:
    """Both contacts close as before; the moments that add up to the load are others."""
    compliance, lever, _, gap, curvature, load = springs(gap=0.0)
    gain = lever * np.array([[0.9, 1.1]])
    made = share(compliance, lever, gain, gap, curvature, load, STIFF)
    slopes = np.array([40.0 / 2e-5, 42.0 / 3e-5])  # forces per unit of lag
    lag = 4000.0 / (slopes @ gain[0])
    assert made.lag == pytest.approx([lag], rel=1e-12)
    assert made.force[0] == pytest.approx(slopes * lag, rel=1e-12)
    assert made.stiffness == pytest.approx([slopes @ gain[0]], rel=1e-12)


def test_forces_that_are_not_found_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sharing, "_STEPS", 1)
    with pytest.raises(InfeasibleError, match="was not found"):
        share(*springs(gap=5e-4), STEEL)
