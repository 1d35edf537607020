"""Random grooves are what a roller as wide as the groove takes away, or are refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.base.errors import InfeasibleError
from gearcam.cams.groove import GrooveCam, make_groove
from gearcam.cams.placing import make_round_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from helpers_cams import close, program, sizes_of
from helpers_sampling import QUICK, rounded
from property.test_cams import programs
from witness.roller_bands import band, island

CHORD = 2e-3

Given = tuple[dict[str, Any], float, float, list[Any]]


@st.composite
def grooves(draw: st.DrawFn) -> Given:
    prime = draw(rounded(15, 60))
    follower: dict[str, Any] = {"type": "roller", "roller_radius": draw(rounded(0.05, 0.5)) * prime}
    if draw(st.booleans()):
        follower |= {"motion": "oscillating", "pivot_distance": draw(rounded(1.2, 4)) * prime}
        follower["arm"] = follower["pivot_distance"] + draw(rounded(-0.9, 0.9)) * prime
    else:
        follower["offset"] = draw(rounded(-0.9, 0.9)) * prime
    clearance = draw(st.sampled_from([0.0, 0.05, 1.0]))
    return follower, prime, clearance, draw(programs("motion" in follower))


def made_of(design: Given) -> GrooveCam | InfeasibleError:
    follower, prime, clearance, phases = design
    spec = FollowerSpec(**follower)
    try:
        found = make_round_follower(spec, CamSpec(prime_radius=prime))
        motion = program(phases, swings=spec.oscillating)
        made = make_groove(motion, found, clearance=clearance, tolerance=CHORD)
        assert all(wall.contour.runs for wall in made.walls)
    except InfeasibleError as error:
        return error
    return made


def centers_of(made: GrooveCam) -> Any:
    """Middles of rollers, by the geometry of the follower."""
    m, motion = sizes_of(made.motion.follower), made.motion.program
    theta = np.linspace(0.0, 2.0 * np.pi, 20001)[:-1]
    theta = np.union1d(theta, motion.knots[:-1])
    position = m.start + motion.derivatives(theta, 0)[0]
    fixed = m.pivot - m.arm * np.exp(-1j * position) if m.oscillating else m.offset + 1j * position
    return fixed * np.exp(-1j * theta)


def demand_groove(design: Given) -> None:
    made = made_of(design)
    if isinstance(made, InfeasibleError):
        assert made.nearest or made.limit is not None
        return
    region = band(centers_of(made), 0.5 * made.width)
    inner, outer = (wall.contour for wall in made.walls)
    close(inner, island(region), CHORD)
    close(outer, shapely.Polygon(region.exterior), CHORD)
    assert outer.polygon.contains(inner.polygon)
    play = made.lost_motion.value
    assert np.isfinite(play)
    assert play >= 0.0


quick = settings(QUICK, max_examples=15)


@quick
@given(grooves())
def test_any_groove_is_the_band_of_its_roller(design: Given) -> None:
    demand_groove(design)


@pytest.mark.slow
@settings(quick, max_examples=500)
@given(grooves())
def test_five_hundred_grooves(design: Given) -> None:
    demand_groove(design)
