"""Clearance and rounded tips in the teeth against true parallels of the plain outline.

The parallels come from a disc that rolls along the outline (`gearcam.parts.rolled`), which knows
nothing of racks.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.flank import Curve
from gearcam.gears.pair import Gear, make_gear, make_pair
from gearcam.gears.spec import Finish, Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.composite import Multispeed
from gearcam.parts.parallel import moved, rounded
from helpers_pairs import job, profile
from helpers_sampling import few

TOLERANCE = 2e-4


def wheel(name: str, number: int, clearance: float, rounding: float) -> Gear:
    """A wheel of a profile with a finish in modules."""
    return finished(profile(name), number, clearance, rounding)


def finished(made: GearPairResult, number: int, clearance: float, rounding: float) -> Gear:
    """A wheel of a pair with a finish in modules."""
    module = made.pair.module
    finish = Finish(clearance=clearance * module, tip_rounding=rounding * module)
    design = made.design
    pair = make_pair(made.law, design.pair, design.rack, DEFAULT, (finish, finish))
    return make_gear(pair, 1 if number == 1 else 2, TOLERANCE, DEFAULT)


@pytest.mark.parametrize("name", few(["ellipse", "circular", "press"], 3))
@pytest.mark.parametrize("number", few([1, 2]))
@pytest.mark.parametrize(
    ("clearance", "rounding"),
    [
        pytest.param(0.05, 0.0, marks=pytest.mark.slow),
        pytest.param(0.0, 0.1, marks=pytest.mark.slow),
        pytest.param(0.03, 0.25, marks=pytest.mark.slow),
        (0.02, 0.45),
    ],
)
def test_teeth_are_the_parallels_of_plain_teeth(
    name: str, number: int, clearance: float, rounding: float
) -> None:
    """At 0.45 modules arcs meet on some teeth. Convex wheels: no mate shortens their tips."""
    gear = wheel(name, number, clearance, rounding)
    module, contour = gear.pair.module, wheel(name, number, 0.0, 0.0).profile.contour
    if clearance:
        contour = moved(contour, -clearance * module)
    if rounding:
        contour = rounded(contour, rounding * module)
    found, expected = (shapely.Polygon(p) for p in (gear.outline, contour.vertices))
    assert found.symmetric_difference(expected).area < TOLERANCE * found.length
    inner = shapely.LineString(gear.outline).interpolate(np.linspace(0, 1, 2000), normalized=True)
    assert shapely.distance(expected.boundary, inner).max() < 2.5 * TOLERANCE


@pytest.mark.parametrize("number", [1, 2])
def test_arcs_are_tangent_and_of_the_radius_asked_for(number: int) -> None:
    gear = wheel("ellipse", number, 0.02, 0.2)
    rows, sampler = gear.profile.rows, gear.profile.sampler
    arcs = np.flatnonzero(rows.kind == Curve.ROUND)
    assert len(arcs) == 2 * gear.toothing.teeth
    share = np.linspace(0.0, 1.0, 7)
    for row in arcs[::5]:
        points, tangents = sampler.curves.at(
            np.full(7, row), rows.start[row] + share * (rows.end - rows.start)[row]
        )
        turned = np.unwrap(np.angle(tangents))
        steps = np.abs(np.diff(points)) / (2.0 * np.sin(0.5 * np.abs(np.diff(turned))))
        assert steps == pytest.approx(0.2 * gear.pair.module, rel=1e-9)
        before, after = (row - 1) % len(rows.kind), (row + 1) % len(rows.kind)
        for own, other, end, begin in ((0, before, rows.end, None), (-1, after, None, rows.start)):
            place = end[other] if end is not None else begin[other]  # type: ignore[index]
            point, tangent = sampler.curves.at(np.array([other]), np.array([place]))
            assert abs(point[0] - points[own]) < 1e-9
            assert abs(np.angle(tangent[0] / tangents[own])) < 1e-9


def _steps(
    ratios: tuple[Any, ...], angles: tuple[float, ...], turn: float, teeth: int, **given: Any
) -> GearPairResult:
    """A pair that steps from ratio to ratio within `turn`; angles in degrees."""
    law = Multispeed(
        ratios=ratios,
        angles=tuple(math.radians(angle) for angle in angles),
        transition=math.radians(turn),
        shape="cubic",
    )
    return job(law, (teeth, teeth), module=2.0, **given)


@pytest.mark.parametrize(
    ("made", "radius"),
    [
        (
            _steps(
                ("solve", 1.08, 1.06),
                (116.0, 96.0, 73.0),
                25.0,
                24,
                rack=Rack(pressure_angle=math.radians(17.0)),
            ),
            0.1,
        ),
        (
            _steps(
                (0.9028, 0.9397, "solve"),
                (114.3525, 66.9967, 70.20766986505996),
                36.147710044980016,
                30,
                rack=Rack(
                    pressure_angle=math.radians(20.087),
                    addendum=1.364,
                    dedendum=1.461,
                    tip_radius=0.02,
                ),
                x=0.4,
            ),
            0.024,
        ),
    ],
    ids=["full", "long"],
)
def test_tips_of_flanks_that_end_at_cusps_are_rounded(made: GearPairResult, radius: float) -> None:
    """Newton's steps from the cusp or past it led far away: no radius was small enough."""
    sharp, gear = (finished(made, 1, 0.0, each) for each in (0.0, radius))
    toothing, flanks, size = gear.toothing, gear.profile.flanks, radius * made.pair.module
    frames = toothing.frames(flanks.tips.phi)
    assert np.abs(toothing.regularity(frames, flanks.sf, flanks.sigma)).min() < 1e-9
    opened = shapely.Polygon(sharp.outline).buffer(-size, 99).buffer(size, 99).boundary
    sampler = gear.profile.sampler
    arc = gear.profile.rows.kind[sampler.curve_of(sampler.chords[0][:-1])] == Curve.ROUND
    assert np.count_nonzero(arc) > 2 * toothing.teeth
    assert shapely.distance(opened, shapely.points(gear.outline[arc])).max() < 2.5 * TOLERANCE


def test_too_much_rounding_is_refused_with_the_most() -> None:
    with pytest.raises(InfeasibleError, match="tip rounding is too large") as caught:
        wheel("ellipse", 1, 0.0, 2.0)
    assert caught.value.limit is not None
    module = profile("ellipse").pair.module
    assert wheel("ellipse", 1, 0.0, caught.value.limit / module).outline.shape[1] == 2
    with pytest.raises(InfeasibleError):
        wheel("ellipse", 1, 0.0, 1.01 * caught.value.limit / module)


def test_too_much_clearance_is_refused_with_the_most() -> None:
    made = profile("ellipse")
    with pytest.raises(InfeasibleError, match="leaves no teeth") as caught:
        wheel("ellipse", 1, 0.6, 0.0)
    assert caught.value.limit is not None
    assert caught.value.limit == pytest.approx(
        0.5 * 0.25 * math.pi * made.pair.module * math.cos(math.radians(20.0)), rel=1e-9
    )
    wheel("ellipse", 1, caught.value.limit / made.pair.module, 0.0)
