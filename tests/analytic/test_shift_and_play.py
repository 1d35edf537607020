"""Profile shift and play: made parts, closed forms, undercut, and the exact gap."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.base.errors import InfeasibleError
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.shapes import RoundedPolygon
from gearcam.meshing.numbers import numbers
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import study
from helpers_pairs import job, profile
from helpers_sampling import few

ALPHA = math.radians(20)


def thickness(made: GearPairResult, wheel: int) -> float:
    """Thickness of tooth 1 (wheel 1) on a circular wheel, along the pitch circle, mm."""
    gear = made.gears[wheel - 1]
    radius = gear.toothing.track.convex.radius
    circle = shapely.Point(0.0, 0.0).buffer(radius, quad_segs=20000).exterior
    inside = shapely.intersection(circle, shapely.Polygon(gear.outline))
    arcs = shapely.length(shapely.get_parts(shapely.line_merge(inside)))
    return float(np.sort(arcs)[len(arcs) // 2])


@pytest.mark.parametrize(("x", "printed"), [(0.0, 7.396), (-0.2, 6.710), (0.2, 8.081)])
def test_teeth_are_as_thick_as_those_that_were_made(x: float, printed: float) -> None:
    """Zarebski and Salacinski (2008): module 4.71, z = 32, on the rack's line."""
    made = job(Constant(), (32, 32), module=4.71, x=x, tolerance=1e-4)
    assert thickness(made, 1) == pytest.approx(printed, abs=5e-3)
    assert thickness(made, 2) == pytest.approx(math.pi * 4.71 - thickness(made, 1), abs=1e-3)


def test_the_rounded_square_has_the_printed_module() -> None:
    law = RoundedPolygon(corners=4, corner_radius=25 / 150)
    made = job(law, (32, 32), distance=150.0)
    assert made.pair.module == pytest.approx(4.91, rel=5e-3)
    assert made.gear1.toothing.track.convex.radius == pytest.approx(25.0, abs=1e-9)


@pytest.mark.parametrize("backlash", [0.05, 0.3])
def test_play_thins_both_wheels_by_half_of_it(backlash: float) -> None:
    made = job(Constant(), (30, 45), module=2.0, backlash=backlash, tolerance=1e-4)
    for wheel in (1, 2):
        assert thickness(made, wheel) == pytest.approx(math.pi - 0.5 * backlash, abs=1e-3)


@pytest.mark.parametrize("x", [-0.3, 0.0, 0.2, 0.4])
def test_circular_wheels_are_free_of_undercut_from_the_closed_form_on(x: float) -> None:
    """z = 2*(1 - x)/sin(alpha)^2; the common rack's straight flank is 1 module deep."""
    limit = 2 * (1 - x) / math.sin(ALPHA) ** 2
    for z, undercut in ((math.ceil(limit), False), (math.floor(limit), True)):
        made = job(Constant(), (z, 60), x=x)
        assert bool(made.gear1.profile.undercut_teeth) is undercut


FREE: dict[str, tuple[Any, tuple[int, int]]] = {
    "ellipse": (Ellipse(eccentricity=0.3), (40, 40)),
    "nail machine": (profile("nail_machine_two_phase").design.law, (72, 72)),
}


@pytest.mark.parametrize("name", FREE)
@pytest.mark.parametrize("x", few([-0.2, 0.3]))
def test_shifted_wheels_still_run_exactly(name: str, x: float) -> None:
    law, teeth = FREE[name]
    made = job(law, teeth, module=2.0, x=x)
    found = numbers(study(made.gears, MeshingSpec(steps=60)))
    assert found["transmission_error"]["peak_to_peak"] < 1e-13
    assert abs(found["transmission_error"]["mean_lag"]) < 1e-13
    assert found["interference_steps"] == 0
    assert max(abs(found["backlash_mm"][end]) for end in ("min", "max")) < 1e-11


@pytest.mark.parametrize("name", FREE)
def test_the_play_is_what_was_asked_for(name: str) -> None:
    """To first order in it: the wheels turn about their shafts, not along the pitch line."""
    law, teeth = FREE[name]
    made = job(law, teeth, module=2.0, backlash=0.02)
    found = numbers(study(made.gears, MeshingSpec(steps=60)))
    assert found["backlash_mm"]["min"] == pytest.approx(0.02, rel=5e-2)
    assert found["backlash_mm"]["max"] == pytest.approx(0.02, rel=5e-2)


@pytest.mark.parametrize(("x", "works"), [(0.85, True), (0.8501, False), (-0.8501, False)])
def test_a_shift_that_leaves_no_root_is_refused(x: float, works: bool) -> None:
    """1.25 - 0.38/0.95 = 0.85."""
    made = job(Constant(), (60, 60), x=x, rack=Rack(dedendum=1.25, tip_radius=0.38))
    if works:
        assert made.pair.toothings[0].cutter.dedendum == pytest.approx(0.4)
    else:
        with pytest.raises(InfeasibleError, match=r"limit -?0\.85;"):
            _ = made.pair


def test_so_much_play_that_no_teeth_are_left_is_refused() -> None:
    most = math.pi / 2
    assert job(Constant(), (60, 60), module=1.0, backlash=most * 0.9999).pair
    with pytest.raises(InfeasibleError, match="backlash"):
        _ = job(Constant(), (60, 60), module=1.0, backlash=most * 1.0001).pair


def pitch_force(made: GearPairResult, pitches: float, torque: float) -> float:
    """Force along the line of action at the pitch point at a roll, N: M1/(r1*cos(alpha))."""
    phi = made.pair.rolling.arc.angle(np.array([pitches * made.gear1.toothing.pitch]))
    r1 = float(abs(made.pair.rolling.tracks[0].frames(phi).p[0]))
    return torque / (r1 * math.cos(ALPHA))


@pytest.mark.parametrize(
    ("name", "printed"),
    [("nail_machine_two_phase", 20016.7), ("nail_machine_three_phase", 19531.4)],
)
def test_the_nail_machine_has_the_printed_tooth_forces(name: str, printed: float) -> None:
    """003 Table 2.7, tooth 18, where its + flank crosses the pitch curve."""
    assert pitch_force(profile(name), 17.25, 1_031_260.0) == pytest.approx(printed, rel=0.02)


@pytest.mark.parametrize(
    ("second", "printed"), [(60, (7479.4, 6361.3, 5851.4)), (90, (7589.5, 6800.4, 6169.0))]
)
def test_the_furnace_door_has_the_printed_tooth_forces(
    second: float, printed: tuple[float, float, float]
) -> None:
    """003 Table 3.1 with A = 271 mm: 1000 N m on the driver, teeth 4, 7, 10."""
    knots = (0.0, math.radians(10), math.radians(second), "solve")
    law = Phases(knots=knots, ratios=(1.0, 1.0, 2.0, 2.0), driven_travel=math.radians(308.3))
    made = job(law, (29, 29), distance=271.0)
    found = [pitch_force(made, tooth - 1.0, 1e6) for tooth in (4, 7, 10)]
    assert found == pytest.approx(printed, rel=0.02)
