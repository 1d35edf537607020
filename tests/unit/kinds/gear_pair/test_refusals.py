"""The limits that refusals name are the limits: just within them it is built, beyond it is not."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import pytest
import shapely

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.shapes import RoundedPolygon
from gearcam.laws.ratio.span import ONE_LOBE
from helpers_pairs import job, profile

TURN = 2 * math.pi


def build(made: GearPairResult) -> None:
    for gear in made.gears:
        assert shapely.LinearRing(gear.outline).is_simple


def refusal(made: GearPairResult) -> InfeasibleError:
    with pytest.raises(InfeasibleError) as caught:
        _ = made.gears
    return caught.value


def number(text: str, words: str) -> float:
    """The number behind some words of a message."""
    found = re.search(re.escape(words) + r" ?(-?[\d.e+-]*\d)", text)
    assert found, text
    return float(found.group(1))


class Limit(NamedTuple):
    """A refused value, the words before the limit in the message where it is told in words, and a
    build with any value.
    """

    value: float
    words: str
    attempt: Callable[[float], object]


def law_of(law: Any) -> object:
    return law.build(ONE_LOBE, DEFAULT)


def phases(share: float) -> object:
    knots = (0.0, 2.0, 4.0, TURN)
    return law_of(Phases(knots=knots, ratios=(2.0 * share, 2.0 * share, "solve", 2.0 * share)))


def speeds(share: float) -> object:
    ratios = (2.5 * share, "solve")
    return law_of(Multispeed(ratios=ratios, angles=(2.5, TURN - 3.5), transition=0.5))


def door(travel: float) -> object:
    knots = (0.0, math.radians(10), math.radians(60), "solve")
    law = Phases(knots=knots, ratios=(1.0, 1.0, 2.0, 2.0), driven_travel=math.radians(travel))
    return law_of(law)


def arms(apart: float) -> object:
    """Conjugate cams whose second roller would reach the axis beyond a limit."""
    return built(
        motion=[
            {"type": "rise", "law": "cycloidal", "angle_deg": 90, "lift_deg": 10},
            {"type": "return", "law": "cycloidal", "angle_deg": "rest"},
        ],
        follower={"type": "roller", "roller_radius_mm": 8, "motion": "oscillating"}
        | {"arm_mm": 90, "pivot_distance_mm": 100, "arms_angle_deg": apart},
        cam={"form": "conjugate", "prime_radius_mm": 40},
    ).cam


def drawn(angle: float) -> object:
    """An open pair, drawn at an angle of the driver."""
    return built(
        law={"type": "log-spiral", "ratios": [2.2, 0.8], "driven_travel_deg": 210},
        pair={"module_mm": 2, "teeth": [20, 20]},
        output={"phi1_deg": angle},
    ).files("svg")


def built(**tables: Any) -> Any:
    kind = "gear-pair" if "law" in tables else "cam"
    return gearcam.build(gearcam.design({"kind": kind, "name": "limit"} | tables))


LIMITS = {
    "harmonics": Limit(
        1.0,
        "with all coefficients times",
        lambda share: law_of(Fourier(cosines=(0.9 * share, -0.4 * share), sines=(0.3 * share,))),
    ),
    "phases": Limit(1.0, "the other ratios multiplied by less than", phases),
    "speeds": Limit(1.0, "the other ratios multiplied by less than", speeds),
    "lowest ratio": Limit(
        1.2,
        "",
        lambda low: law_of(ThreePhasePolynomial(knots=(0.0, 2.0, 4.0, TURN), lowest=low)),
    ),
    "corner radius": Limit(
        0.6,
        "",
        lambda radius: law_of(RoundedPolygon(corners=4, corner_radius=radius)),
    ),
    "longest way": Limit(700.0, "", door),
    "tip radius": Limit(
        0.6,
        "",
        lambda radius: build(
            job(Constant(), (40, 40), rack=Rack(tip_radius=radius, dedendum=1.25))
        ),
    ),
    "profile shift": Limit(
        0.95, "", lambda x: build(job(Constant(), (40, 40), rack=Rack(addendum=1.0), x=x))
    ),
    "angle of the arms": Limit(210.0, "", arms),
    "angle of the drawing": Limit(250.0, "", drawn),
    "bore": Limit(40.0, "", lambda bore: build(job(Constant(), (40, 40), bores=(bore, 8.0)))),
    "tolerance": Limit(
        0.1, "", lambda size: build(job(Constant(), (40, 40), distance=40.0, tolerance=size))
    ),
}


@pytest.mark.parametrize("case", LIMITS)
def test_a_limit_that_is_named_is_the_limit(case: str) -> None:
    limit = LIMITS[case]
    with pytest.raises(InfeasibleError) as caught:
        limit.attempt(limit.value)
    error = caught.value
    nearest = number(str(error), limit.words) if limit.words else error.limit
    assert nearest is not None
    limit.attempt(nearest * (1 - 2e-6))
    with pytest.raises(InfeasibleError):
        limit.attempt(nearest * 1.01)


def test_a_travel_of_a_rack_is_refused_with_the_least() -> None:
    def travel(driven: float) -> object:
        law = {"type": "formula", "ratio": "1 + 0.001*phi1", "driver_travel_deg": 115}
        pair = {"module_mm": 8, "teeth": [21, 21]}
        return built(law=law | {"driven_travel_deg": driven}, pair=pair).law

    with pytest.raises(InfeasibleError, match="it would be a rack") as caught:
        travel(1e-6)
    assert caught.value.limit == pytest.approx(115 / 10000, rel=1e-4)
    travel(115 / 10000 * 1.001)


def test_a_groove_that_reaches_the_axis_is_refused() -> None:
    """Half its width is the roller's radius and half of the clearance; the inner wall is there."""
    motion = [
        {"type": "rise", "law": "cycloidal", "angle_deg": 90, "lift_mm": 10},
        {"type": "return", "law": "cycloidal", "angle_deg": "rest"},
    ]
    size = {"prime_radius_mm": 30, "thickness_mm": 20, "groove_depth_mm": 12}
    size |= {"form": "groove", "outer_diameter_mm": 400}
    roller = {"type": "roller", "roller_radius_mm": 6}
    groove = partial(built, motion=motion, follower=roller)
    _ = groove(cam=size | {"roller_clearance_mm": 47.9}).cam
    with pytest.raises(InfeasibleError, match="reaches the cam's axis") as caught:
        _ = groove(cam=size | {"roller_clearance_mm": 48.0}).cam
    assert (caught.value.value, caught.value.limit) == (30.0, 30.0)


def test_a_typing_error_in_a_table_of_ratios_is_refused_where_it_is() -> None:
    angles = [10.0 * k for k in range(13)]
    ratios = [1.0 + 0.01 * math.sin(k) for k in range(13)]
    ratios[10], ratios[12] = 1e30, ratios[0]
    table = {"type": "table", "phi1_deg": angles, "ratio": ratios}
    with pytest.raises(InfeasibleError, match=r"\(phi1 = 100 deg\)"):
        _ = built(law=table, pair={"module_mm": 2, "teeth": [66, 44]}).law


def test_the_shortest_way_of_a_door_is_named() -> None:
    with pytest.raises(InfeasibleError) as caught:
        door(40.0)
    shortest = caught.value.limit
    assert shortest is not None
    door(shortest * (1 + 1e-9))
    with pytest.raises(InfeasibleError):
        door(shortest * 0.99)


def test_a_load_whose_formula_cannot_be_read_is_refused() -> None:
    with pytest.raises(DesignError, match="unknown name 'floor'"):
        profile("ellipse").design.with_({"load": [{"on": "wheel2", "formula": "floor(phi1)"}]})
