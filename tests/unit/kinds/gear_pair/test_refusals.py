"""The limits that refusals name are the limits: just within them it is built, beyond it is not."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

import pytest
import shapely

from gearcam.errors import InfeasibleError
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.build import GearPairResult
from gearcam.laws.ratio.composite import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.shapes import RoundedPolygon
from gearcam.laws.ratio.span import ONE_LOBE
from gearcam.tolerances import DEFAULT
from helpers_pairs import job

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


def test_the_shortest_way_of_a_door_is_named() -> None:
    with pytest.raises(InfeasibleError) as caught:
        door(40.0)
    shortest = caught.value.limit
    assert shortest is not None
    door(shortest * (1 + 1e-9))
    with pytest.raises(InfeasibleError):
        door(shortest * 0.99)
