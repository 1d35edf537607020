"""Random conjugate and yoke cams are what their rollers and faces leave, or are refused.

Centres of rollers are written out from a drawing of the follower; faces are support lines.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.cams.conjugate import ConjugateCam, SecondRoller, make_conjugate
from gearcam.cams.disc import YokeCam, make_cam, make_yoke
from gearcam.cams.placing import make_follower, make_round_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.laws.half_turns import completed, miss
from gearcam.laws.phases_of_lift import levels
from gearcam.laws.program import Program, make_program
from helpers_cams import TURN, close, program, rise, sizes_of
from helpers_sampling import QUICK, rounded
from property.test_cams import LAWS, dwell, programs, segment
from witness.cam_sweep import Follower, swept
from witness.roller_bands import band, island

CHORD = 2e-3

Given = tuple[dict[str, Any], float, Any]


def turns(motion: Program, count: int) -> Any:
    theta = np.linspace(0.0, TURN, count + 1)[:-1]
    return np.union1d(theta, motion.knots[:-1])


# --- conjugate cams ----------------------------------------------------------------------------


@st.composite
def pairs_of_cams(draw: st.DrawFn) -> tuple[dict[str, Any], float, SecondRoller, Any]:
    prime = draw(rounded(15, 60))
    follower: dict[str, Any] = {"type": "roller", "roller_radius": draw(rounded(0.05, 0.5)) * prime}
    prime2 = draw(rounded(0.6, 1.5)) * prime
    second: dict[str, Any] = {"radius": draw(rounded(0.05, 0.5)) * prime2, "prime": prime2}
    if draw(st.booleans()):
        follower |= {"motion": "oscillating", "pivot_distance": draw(rounded(1.2, 4)) * prime}
        follower["arm"] = follower["pivot_distance"] + draw(rounded(-0.9, 0.9)) * prime
        second["arm"] = follower["pivot_distance"] + draw(rounded(-0.9, 0.9)) * prime2
    else:
        follower["offset"] = draw(rounded(-0.9, 0.9)) * prime
    return follower, prime, SecondRoller(**second), draw(programs("motion" in follower))


def conjugate(design: Any) -> ConjugateCam | InfeasibleError:
    follower, prime, second, phases = design
    spec = FollowerSpec(**follower)
    try:
        found = make_round_follower(spec, CamSpec(prime_radius=prime))
        motion = program(phases, swings=spec.oscillating)
        made = make_conjugate(motion, found, second, tolerance=CHORD)
        assert all(wall.contour.runs for wall in made.walls)
    except InfeasibleError as error:
        return error
    return made


def centers_of(made: ConjugateCam) -> tuple[Any, Any]:
    """Middles of both rollers, seen from the cams, by the geometry of one rigid follower."""
    one, motion, roller = sizes_of(made.first.follower), made.first.program, made.roller
    theta = turns(motion, 20000)
    position = one.start + motion.derivatives(theta, 0)[0]
    if one.oscillating:
        first = one.pivot - one.arm * np.exp(-1j * position)
        # the second arm is the first, turned about the pivot by the angle between them
        turned = (first - one.pivot) / one.arm * np.exp(1j * made.apart)
        second = one.pivot + roller.arm * turned
    else:
        first = one.offset + 1j * position
        second = first - 1j * made.apart
    seen = np.exp(-1j * theta)
    return first * seen, second * seen


def demand_conjugate(design: Any) -> bool:
    made = conjugate(design)
    if isinstance(made, InfeasibleError):
        assert made.where
        assert made.nearest or made.limit is not None
        return False
    for wall, centers in zip(made.walls, centers_of(made), strict=True):
        close(wall.contour, island(band(centers, wall.follower.radius)), CHORD)
        assert np.isfinite(wall.shortfall)
        assert wall.contour.moments.area == pytest.approx(wall.size.area, rel=1e-6)
    assert made.prime2 == pytest.approx(design[2].prime, rel=1e-9)
    return True


# --- yokes -------------------------------------------------------------------------------------


@st.composite
def yokes(draw: st.DrawFn) -> Given:
    """A follower, and half a turn of rises, dwells and segments that ends at a lift."""
    size = draw(rounded(15, 60))
    follower: dict[str, Any] = {"type": draw(st.sampled_from(["flat", "roller"]))}
    if follower["type"] == "roller":
        follower["roller_radius"] = draw(rounded(0.05, 0.5)) * size
    shares = draw(st.lists(rounded(0.05, 1), min_size=1, max_size=4))
    scale, phases = draw(st.sampled_from([1.0, 5.0, 20.0])), []
    for number, share in enumerate(shares):
        angle, lift = 180.0 * share / sum(shares), draw(rounded(0.2, 1)) * scale
        kind = draw(st.sampled_from(["rise", "rise", "dwell", "segment"]))
        if kind == "rise" or (number == 0 and kind == "dwell" and len(shares) == 1):
            phases.append(rise(draw(st.sampled_from(LAWS)), angle, lift))
        elif kind == "dwell":
            phases.append(dwell(angle))
        else:
            to = levels(phases)[-1] + lift
            phases.append(segment(angle, to, draw(rounded(-1, 1)) * scale, swings=False))
    if not levels(phases)[-1]:
        phases[-1] = rise("cycloidal", 180.0 * shares[-1] / sum(shares), scale)
    return follower, size, phases


def yoke(design: Given) -> YokeCam | InfeasibleError:
    follower, size, phases = design
    spec = FollowerSpec(**follower)
    try:
        cam = CamSpec(base_radius=size) if spec.flat else CamSpec(prime_radius=size)
        motion = completed(make_program(phases, DEFAULT, half=True))
        made = make_yoke(make_cam(motion, make_follower(spec, cam), tolerance=CHORD))
        assert made.contour.runs
    except InfeasibleError as error:
        return error
    return made


def demand_yoke(design: Given) -> bool:
    made = yoke(design)
    if isinstance(made, InfeasibleError):
        assert made.where
        assert made.nearest or made.limit is not None
        return False
    scale = made.breadth
    assert abs(miss(made.program).value) < 1e-14 * scale
    m, motion = sizes_of(made.follower), made.program
    theta = turns(motion, 4000 if m.flat else 20000)
    lift = motion.derivatives(theta, 0)[0]
    if m.flat:
        own = Follower(size=m.start, flat=True)
        region = swept(own, theta, lift, 3.0 * scale, 0)
    else:
        region = island(band(1j * (m.start + lift) * np.exp(-1j * theta), m.radius))
    close(made.contour, region, CHORD)
    if m.flat and not made.corners and not made.undercut:
        assert made.size.perimeter == pytest.approx(math.pi * scale, rel=1e-9)
        vertices = made.contour.vertices @ [1.0, 1j]
        heights = (vertices[:, None] * np.exp(1j * np.linspace(0.0, math.pi, 36))).imag
        assert np.ptp(heights, axis=0) == pytest.approx(np.full(36, scale), abs=2.0 * CHORD)
    return True


quick = settings(QUICK, max_examples=15)


@quick
@given(pairs_of_cams())
def test_any_conjugate_cams_are_what_their_rollers_leave(design: Any) -> None:
    demand_conjugate(design)


@quick
@given(yokes())
def test_any_yoke_is_what_both_sides_leave(design: Given) -> None:
    demand_yoke(design)


@pytest.mark.slow
@settings(quick, max_examples=500)
@given(pairs_of_cams())
def test_five_hundred_conjugate_cams(design: Any) -> None:
    demand_conjugate(design)


@pytest.mark.slow
@settings(quick, max_examples=500)
@given(yokes())
def test_five_hundred_yokes(design: Given) -> None:
    demand_yoke(design)
