"""Derivatives of linkages against differences of their positions: off by the step squared."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from gearcam.linkages.closing import NotClosingError, closing, settled
from gearcam.linkages.dyads import DYADS
from gearcam.linkages.linkage import Linkage
from gearcam.numeric.arrays import Array
from helpers_linkages import (
    TWO_PHASES,
    crank_slider,
    four_bar,
    halve_products_of_speeds,
    phases,
    swinging_guide,
)
from helpers_random_linkages import TURN, drawn
from helpers_sampling import few

STENCILS = {
    1: ({1: 0.5, -1: -0.5}, 0.5 ** np.arange(5, 9)),
    2: ({1: 1.0, 0: -2.0, -1: 1.0}, 0.5 ** np.arange(5, 9)),
    3: ({2: 0.5, 1: -1.0, -1: 1.0, -2: -0.5}, 0.5 ** np.arange(5, 8)),
}
"""Central differences of each order, and the steps, rad, at which rounding is small beside them."""

EVERYWHERE = np.linspace(0.0, TURN, 60, endpoint=False)
BETWEEN = np.radians(np.concatenate([np.linspace(10.0, 150.0, 30), np.linspace(170.0, 350.0, 30)]))
"""Farther from the knots of the two-phase pair than any stencil reaches."""


def slope(made: Linkage, name: str, order: int, q: Array = EVERYWHERE) -> float:
    """By which power of the step the differences approach a derivative."""
    stencil, steps = STENCILS[order]
    exact = made.track(name, q, order).derivatives()[order]
    errors = []
    for step in steps:
        places = {k: made.track(name, q + k * step, 0).derivatives()[0] for k in stencil}
        difference = sum(weight * places[k] for k, weight in stencil.items()) / step**order
        errors.append(float(np.sqrt(np.mean(np.abs(difference - exact) ** 2))))
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


@pytest.mark.parametrize("order", STENCILS)
@pytest.mark.parametrize(
    ("made", "name", "q"),
    [
        (four_bar(), "P", EVERYWHERE),
        (four_bar(sign=-1.0), "P", EVERYWHERE),
        (swinging_guide(60.0, 150.0), "block.member1", EVERYWHERE),
        (
            crank_slider(150.0, 750.0, law=phases(*TWO_PHASES), knots_deg=TWO_PHASES[0]),
            "slide.guide2",
            BETWEEN,
        ),
    ],
    ids=["four-bar", "other position", "swinging guide", "behind a pair"],
)
def test_of_known_linkages(made: Linkage, name: str, q: Array, order: int) -> None:
    assert slope(made, name, order, q) == pytest.approx(2.0, abs=0.1)


@cache
def far_from_open() -> list[Linkage]:
    """Random linkages that move and are nowhere near where they open: there steps must be less."""
    chosen: list[Linkage] = []
    for index in range(40):
        try:
            made = settled(drawn(47, index).linkage)
        except NotClosingError:
            continue
        found = [closing(made, dyad) for dyad in made.dyads]
        places = made.track(made.dyads[-1].joint, EVERYWHERE, 0).derivatives()[0]
        if np.ptp(np.abs(places)) > 1.0 and all(one is None or one.least > 0.1 for one in found):
            chosen.append(made)
    return chosen


@pytest.mark.parametrize("order", few(STENCILS))
def test_of_random_linkages(order: int) -> None:
    for number, made in enumerate(far_from_open()):
        found = slope(made, made.dyads[-1].joint, order)
        assert found == pytest.approx(2.0, abs=0.1), (number, made.dyads)
    assert {dyad.type for made in far_from_open() for dyad in made.dyads} == set(DYADS)


def test_half_of_a_coriolis_acceleration_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    halve_products_of_speeds(monkeypatch)
    assert slope(four_bar(), "P", 1) == pytest.approx(2.0, abs=0.1)
    assert slope(four_bar(), "P", 2) < 0.1
