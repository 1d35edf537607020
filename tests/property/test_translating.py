"""Random translating cams are what their rollers leave of a plate, or are refused."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.cams.placing import make_follower_over_plate
from gearcam.cams.spec import PlateFollower
from gearcam.cams.translating import TranslatingCam, make_translating
from gearcam.laws.phases_of_lift import DwellPhase, SegmentPhase
from gearcam.laws.program import make_program
from helpers_cams import close
from helpers_sampling import QUICK, rounded
from property.test_cams import programs

CHORD = 2e-3
HIGH = 1e3

Given = tuple[dict[str, Any], float, float, tuple[float, float], list[Any]]


@st.composite
def plates(draw: st.DrawFn) -> Given:
    way = draw(rounded(20, 200))
    follower: dict[str, Any] = {"type": "roller", "roller_radius": draw(rounded(0.02, 0.2)) * way}
    if draw(st.booleans()):
        arm = draw(rounded(0.5, 2)) * way
        follower |= {"motion": "oscillating", "arm": arm, "pivot_distance": arm}
        follower["pivot_height"] = draw(rounded(-0.8, 0.8)) * arm
    else:
        follower["axis"] = draw(st.sampled_from([0.0, 0.0, 0.3, -0.5]))
    runs = draw(st.tuples(*[st.sampled_from([0.0, 0.1, 0.5])] * 2))
    return (
        follower,
        way,
        draw(st.sampled_from([0.0, 0.05, 1.0])),
        runs,
        draw(programs("motion" in follower)),
    )


def made_of(design: Given) -> TranslatingCam | InfeasibleError:
    follower, way, clearance, runs, phases = design
    if any(isinstance(one, SegmentPhase) for one in phases):
        phases = [
            replace(one, velocity=None, acceleration=None) if isinstance(one, SegmentPhase) else one
            for one in phases
        ]
    spec = PlateFollower(**follower)
    share = way / sum(float(one.angle) for one in phases)
    phases = [replace(one, angle=float(one.angle) * share) for one in phases]
    before, after = ([DwellPhase(angle=run * way)] if run else [] for run in runs)
    try:
        motion = make_program(
            [*before, *phases, *after], DEFAULT, oscillating=spec.oscillating, closed=False
        )
        made = make_translating(
            motion,
            make_follower_over_plate(spec),
            height=HIGH,
            groove=True,
            clearance=clearance,
            tolerance=CHORD,
        )
        assert made.groove is not None
        assert all(wall.contour.runs for wall in made.walls)
    except InfeasibleError as error:
        return error
    return made


def centers_of(design: Given, made: TranslatingCam) -> Any:
    """Middles of rollers in the cam's frame, by the geometry of the follower."""
    given, motion = design[0], made.motion.program
    way = np.union1d(np.linspace(0.0, made.travel, 8001), motion.knots)
    lift = motion.derivatives(way, 0)[0]
    if "arm" not in given:
        return lift * 1j * np.exp(-1j * given["axis"]) - way
    swing = lift - np.arcsin(given["pivot_height"] / given["arm"])
    arm = -np.cos(swing) + 1j * np.sin(swing)
    return given["pivot_distance"] + 1j * given["pivot_height"] + given["arm"] * arm - way


def demand_plate(design: Given) -> None:
    made = made_of(design)
    if isinstance(made, InfeasibleError):
        assert made.nearest or made.limit is not None
        return
    points = centers_of(design, made)
    line = np.column_stack([points.real, points.imag])
    region = shapely.LineString(line).buffer(0.5 * made.width, quad_segs=128)
    assert made.groove is not None
    close(made.groove, shapely.Polygon(region.exterior), CHORD)
    for wall in made.walls:
        metal = wall.contour.polygon
        assert metal.is_valid
        assert shapely.intersection(metal, region).area < 3.0 * CHORD * region.length
    assert made.lost_motion is not None
    lost = made.lost_motion.value
    assert np.isfinite(lost)
    assert lost >= 0.0


quick = settings(QUICK, max_examples=5)


@quick
@given(plates())
def test_any_groove_is_the_band_of_its_roller(design: Given) -> None:
    demand_plate(design)


@pytest.mark.slow
@settings(quick, max_examples=500)
@given(plates())
def test_five_hundred_plates(design: Given) -> None:
    demand_plate(design)
