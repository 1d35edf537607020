"""What a refusal names as nearest works, and just beyond it is refused."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import pytest
import shapely

from gearcam.errors import InfeasibleError
from gearcam.gears.spec import Rack
from gearcam.jobs.gear_pair import GearPairJob
from gearcam.laws.centrodes import Limacon
from gearcam.laws.constant import Constant
from gearcam.laws.ellipse import Ellipse
from gearcam.laws.phases import Phases
from gearcam.laws.programs import Fourier, Multispeed, ThreePhasePolynomial
from gearcam.laws.shapes import RoundedPolygon
from gearcam.laws.span import ONE_LOBE
from gearcam.tolerances import DEFAULT
from helpers_pairs import job

TURN = 2 * math.pi


def build(made: GearPairJob) -> None:
    for gear in made.gears:
        assert shapely.LinearRing(gear.outline).is_simple


def refusal(made: GearPairJob) -> InfeasibleError:
    with pytest.raises(InfeasibleError) as caught:
        _ = made.gears
    return caught.value


def number(text: str, words: str) -> float:
    """The number behind some words of a message."""
    found = re.search(re.escape(words) + r" ?(-?[\d.e+-]*\d)", text)
    assert found, text
    return float(found.group(1))


TEETH: dict[str, tuple[Any, tuple[int, int], Rack]] = {
    "concave part too tight": (Limacon(eccentricity=0.7), (20, 20), Rack()),
    "teeth cut off": (Ellipse(eccentricity=0.8), (8, 8), Rack(dedendum=1.9, tip_radius=0.0)),
    "teeth past the shaft": (Ellipse(eccentricity=0.9), (12, 12), Rack()),
}


@cache
def advised(case: str) -> InfeasibleError:
    """The refusal with its advice."""
    law, teeth, rack = TEETH[case]
    return refusal(job(law, teeth, rack=rack))


@pytest.mark.parametrize("case", TEETH)
def test_tooth_counts_that_are_named_work_and_one_fewer_does_not(case: str) -> None:
    law, _, rack = TEETH[case]
    error = advised(case)
    found: Any = error.suggested["pair.teeth"]
    build(job(law, found, rack=rack))
    refusal(job(law, (found[0] - 1, found[1] - 1), rack=rack))
    assert f"the fewest teeth with which the pair can be made are {found[0]}" in str(error)


@pytest.mark.parametrize("case", TEETH)
def test_the_eccentricity_that_is_named_works_and_beyond_it_nothing(case: str) -> None:
    law, teeth, rack = TEETH[case]
    largest: Any = advised(case).suggested["law.eccentricity"]
    build(job(type(law)(eccentricity=largest), teeth, rack=rack))
    refusal(job(type(law)(eccentricity=1.01 * largest), teeth, rack=rack))


class Limit(NamedTuple):
    """A refused value, the words before the nearest in the message, and a build with any value."""

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
        "all coefficients times less than",
        lambda share: law_of(Fourier(cosines=(0.9 * share, -0.4 * share), sines=(0.3 * share,))),
    ),
    "phases": Limit(1.0, "all other ratios times less than", phases),
    "speeds": Limit(1.0, "all other ratios times less than", speeds),
    "lowest ratio": Limit(
        1.2,
        "a lowest ratio below",
        lambda low: law_of(ThreePhasePolynomial(knots=(0.0, 2.0, 4.0, TURN), lowest=low)),
    ),
    "corner radius": Limit(
        0.6,
        "a corner radius below",
        lambda radius: law_of(RoundedPolygon(corners=4, corner_radius=radius)),
    ),
    "longest way": Limit(700.0, "and", door),
    "tip radius": Limit(
        0.6,
        "a tip radius up to",
        lambda radius: build(job(Constant(), (40, 40), rack=Rack(tip_radius=radius))),
    ),
    "bore": Limit(
        40.0, "a bore below", lambda bore: build(job(Constant(), (40, 40), bores=(bore, 8.0)))
    ),
    "tolerance": Limit(
        0.1, "at most", lambda size: build(job(Constant(), (40, 40), distance=40.0, tolerance=size))
    ),
}


@pytest.mark.parametrize("case", LIMITS)
def test_a_limit_that_is_named_is_the_limit(case: str) -> None:
    limit = LIMITS[case]
    with pytest.raises(InfeasibleError) as caught:
        limit.attempt(limit.value)
    nearest = number(str(caught.value), limit.words)
    limit.attempt(nearest * (1 - 2e-6))
    with pytest.raises(InfeasibleError):
        limit.attempt(nearest * 1.01)


def test_the_shortest_way_of_a_door_is_named() -> None:
    with pytest.raises(InfeasibleError) as caught:
        door(40.0)
    shortest = number(str(caught.value), "driven_travel_deg between")
    door(shortest * (1 + 1e-9))
    with pytest.raises(InfeasibleError):
        door(shortest * 0.99)


def test_a_refusal_takes_no_longer_than_people_wait() -> None:
    """Many teeth would be needed: the search for them is given up, and the reason stays."""
    error = refusal(job(Limacon(eccentricity=0.95), (30, 30)))
    assert "pair.teeth" not in error.suggested
    assert error.nearest
