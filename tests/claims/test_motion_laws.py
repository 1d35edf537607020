"""Every rise of the registry keeps every claim that is made for it."""

from __future__ import annotations

import dataclasses
import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from claims.claim import MotionClaim
from claims.motion import MOTION_CLAIMS
from claims.shown_rise import ShownRise, shown
from gearcam.base.quantities import params_of
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.motion.base import MotionFunction, MotionLawParameters
from random_designs.draw import Draw
from random_designs.laws import parameters, random_motion_law

Array = NDArray[np.float64]

CLAIMS = [
    pytest.param(claim, id=f"{name}-{number}")
    for name, claims in MOTION_CLAIMS.items()
    for number, claim in enumerate(claims.values)
]

MEMBERS = [
    *(
        pytest.param(claim.parameters, id=f"{name}-{number}")
        for name, claims in MOTION_CLAIMS.items()
        for number, claim in enumerate(claims.values)
    ),
    *(
        pytest.param(
            parameters(random_motion_law(Draw(f"claims {name} {number}"), name)),
            id=f"{name}-random-{number}",
        )
        for name in MOTION_CLAIMS
        for number in range(6)
    ),
]
"""All examples, and random members of every law."""

TAKEN = {"type", "law", "angle", "lift", "to", "end_velocity", "end_acceleration"}
"""Words that a design file needs beside the parameters of a rise."""

INFINITE = math.inf

# peak velocity, acceleration and jerk as printed; None where nothing is printed
REFERENCE: dict[str, tuple[float | None, float, float | None]] = {
    "constant-acceleration": (2, 4, INFINITE),
    "harmonic": (math.pi / 2, 4.9348022005, INFINITE),
    "cycloidal": (2, 6.2831853072, 39.4784176044),
    "modified-trapezoid": (2, 4.8881237628, 61.4259748124),
    "modified-sine": (1.7596033860, 5.5279570705, 69.4663572887),
    "2-3": (1.5, 6, None),
    "3-4-5": (1.875, 5.7735026919, 60),
    "4-5-6-7": (2.1875, 7.5131884044, 52.5),
    "5-6-7-8-9": (2.4609375, 9.3719762185, 78.75),
    "3-4-5-6": (None, 6, None),
    "trapezoidal-velocity": (None, 9.142857, None),
    "sine-trapezoidal-velocity": (None, 14.361566, None),
    "trapezoidal-acceleration": (None, 5.333333, None),
}


def built(claim: MotionClaim) -> ShownRise:
    return shown(claim.parameters)


def peaks(made: Any) -> tuple[float, float, float]:
    return made.peak_velocity, made.peak_acceleration, made.peak_jerk


def inside(rise: MotionFunction, count: int) -> list[Array]:
    """Places in each piece, its ends left out by a billionth of its width."""
    steps = np.linspace(1e-9, 1.0 - 1e-9, count)
    knots = rise.function.knots
    return [low + (high - low) * steps for low, high in pairwise(knots)]


def test_the_registry_holds_exactly_the_rises_that_are_claimed() -> None:
    assert {entry.name for entry in MOTION_LAWS.values()} == set(MOTION_CLAIMS) == set(MOTION_LAWS)
    for entry in MOTION_LAWS.values():
        assert len(MOTION_CLAIMS[entry.name].values) >= 1
        assert entry.source
        assert entry.continuity
        assert 20 <= len(entry.doc) <= 100
        assert "\n" not in entry.doc
        assert dataclasses.is_dataclass(entry.parameters)
        assert entry.parameters.__doc__
        assert not set(params_of(entry.parameters)) & TAKEN


@pytest.mark.parametrize("claim", CLAIMS)
def test_values_are_those_of_the_closed_form(claim: MotionClaim) -> None:
    rise = built(claim)
    for phi, value in claim.values.items():
        assert float(rise.function(phi)) == pytest.approx(value, abs=1e-14)
    for phi, velocity in claim.velocities.items():
        found = rise.function.derivatives(phi, 1)[1]
        assert float(found) == pytest.approx(velocity, rel=1e-13, abs=1e-13)


@pytest.mark.parametrize("law", MEMBERS)
def test_it_goes_from_corner_to_corner(law: MotionLawParameters) -> None:
    rise = law.build(DEFAULT)
    assert rise.function.knots[0] == 0.0
    assert rise.function.knots[-1] == 1.0
    assert (np.diff(rise.function.knots) > 0.0).all()
    assert abs(float(rise.function(0.0))) == 0.0
    assert float(rise.function(1.0)) == pytest.approx(1.0, abs=3e-16)


@pytest.mark.parametrize("law", MEMBERS)
def test_each_derivative_is_that_of_the_one_below(law: MotionLawParameters) -> None:
    """Gauss-Legendre integrals of S', S'' and S''' over each piece against differences."""
    rise = law.build(DEFAULT)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    knots = rise.function.knots
    for number, (low, high) in enumerate(pairwise(knots)):
        cuts = np.linspace(low, high, 9)
        half = 0.5 * np.diff(cuts)
        places = cuts[:-1] + half * (1.0 + nodes[:, None])
        before = rise.function.side(number, 1, 3)
        after = rise.function.side(number + 1, -1, 3)
        found = rise.function.derivatives(places, 3)
        for order in (1, 2, 3):
            integral = float((weights @ found[order]) @ half)
            scale = max(1.0, float(np.abs(found[order]).max()))
            expected = after[order - 1] - before[order - 1]
            assert integral == pytest.approx(expected, abs=1e-13 * scale)


@pytest.mark.parametrize("law", MEMBERS)
def test_lift_and_velocity_do_not_jump_inside(law: MotionLawParameters) -> None:
    function = law.build(DEFAULT).function
    for knot in range(1, len(function.knots) - 1):
        before, after = function.side(knot, -1, 1), function.side(knot, 1, 1)
        assert before == pytest.approx(after, rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("claim", CLAIMS)
def test_continuity_is_as_claimed_and_seen_from_both_sides(claim: MotionClaim) -> None:
    rise = built(claim)
    assert rise.continuity == claim.continuity
    assert rise.mirrored == claim.mirrored
    h = 1e-9
    found = np.array([v.ravel() for v in rise.function.derivatives(inside(rise, 801), 4)])
    largest = np.maximum(1.0, np.abs(found).max(axis=1))
    jumps = np.zeros(4)
    for knot in rise.function.knots:
        before = np.array(rise.function.derivatives(knot - h, 3)) if knot > 0.0 else np.zeros(4)
        after = np.array(rise.function.derivatives(knot + h, 3)) if knot < 1.0 else np.eye(4)[0]
        jumps = np.maximum(jumps, np.abs(after - before))
    for order in range(claim.continuity + 1):
        assert jumps[order] <= 5.0 * h * largest[order + 1]
    if claim.continuity < 3:
        assert jumps[claim.continuity + 1] > 1e-3 * largest[claim.continuity + 1]


@pytest.mark.parametrize("claim", CLAIMS)
def test_ends_are_those_of_the_first_and_the_last_piece(claim: MotionClaim) -> None:
    rise = built(claim)
    h = 1e-12
    found = rise.function.derivatives([h, 1.0 - h], 4)
    for order in (1, 2, 3):
        slack = 2.0 * h * float(np.abs(found[order + 1]).max()) + 1e-12
        assert rise.start[order - 1] == pytest.approx(float(found[order][0]), rel=1e-9, abs=slack)
        assert rise.end[order - 1] == pytest.approx(float(found[order][1]), rel=1e-9, abs=slack)


@pytest.mark.parametrize("claim", CLAIMS)
def test_peaks_are_those_of_the_closed_form_and_of_dense_sampling(claim: MotionClaim) -> None:
    rise = built(claim)
    assert peaks(rise) == pytest.approx(peaks(claim), rel=1e-12)
    dense = [np.array(rise.function.derivatives(part, 3)) for part in inside(rise, 6001)]
    sampled = np.abs(np.concatenate(dense, axis=1)).max(axis=1)
    for order, peak in enumerate(peaks(rise), start=1):
        if math.isinf(peak):
            assert claim.continuity < order - 1
        else:
            assert peak * (1.0 - 1e-6) <= sampled[order] <= peak * (1.0 + 1e-12)


@pytest.mark.parametrize("name", REFERENCE)
def test_peaks_are_those_of_the_reference_table(name: str) -> None:
    rise = shown(MOTION_LAWS[name].parameters())
    for found, printed in zip(peaks(rise), REFERENCE[name], strict=True):
        if printed is not None:
            assert found == pytest.approx(printed, rel=1e-7 if len(f"{printed}") < 10 else 1e-10)


def test_laws_whose_acceleration_jumps_are_told_by_their_jerk() -> None:
    """The table prints 12 for the jerk of the 2-3 law, which is that between its ends."""
    rise = shown(MOTION_LAWS["2-3"].parameters())
    assert rise.peak_jerk == math.inf
    assert rise.start[2] == rise.end[2] == -12.0


def test_the_rise_return_of_the_textbook_is_told_against_a_dwell_and_against_its_return() -> None:
    rise = shown(MOTION_LAWS["3-4-5-6"].parameters())
    assert rise.mirrored
    assert rise.end == (0.0, -6.0, 0.0)
    phi = np.linspace(0.0, 1.0, 100001)
    acceleration = rise.function.derivatives(phi, 2)[2]
    assert acceleration.max() == pytest.approx(4.8, abs=1e-8)
    assert acceleration.min() == -6.0
