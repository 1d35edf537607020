"""Walks through limits: on either side outlines and numbers move no faster than what is changed.

What changes at once is what is documented: a finding comes, or the pair is refused.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.base.errors import InfeasibleError
from helpers_sampling import few


class Walk(NamedTuple):
    """A walk in even steps.

    Parameters
    ----------
    tables : callable
        Law, teeth and other tables of the pair at a value.
    values : (float, float)
        From where to where.
    rate : float
        Modules that outlines may move for a change by 1.
    changes : tuple of str
        What comes on the way, once: codes of errors, ``refused``.
    pace : float
        Contact ratio, and margin in modules, by which the steepest step of the walk, taken all the
        way, would change them.
    """

    tables: Callable[[float], tuple[dict[str, Any], list[int], dict[str, Any]]]
    values: tuple[float, float]
    rate: float
    changes: tuple[str, ...] = ()
    pace: float = 1.0


FINE = 0.01
"""Chord tolerance, in modules: what vertices add to the distance of two outlines."""

CIRCLE = {"type": "constant"}
LOW = {"dedendum": 2.05, "tip_radius": 0.02}
DOOR = {"type": "phases", "knots_deg": [0, 10, 60, "solve"], "ratios": [1, 1, 2, 2]}


def ellipse(e: float) -> dict[str, Any]:
    return {"type": "ellipse", "eccentricity": e}


WALKS = {
    "undercut by shift": Walk(lambda x: (CIRCLE, [8, 30], {"pair": {"x": x}}), (0.46, 0.6), 1.2),
    "undercut by depth": Walk(
        lambda hf: (CIRCLE, [17, 17], {"rack": {"dedendum": hf}}), (1.1, 1.4), 1.2
    ),
    "pointed tips": Walk(
        lambda ha: (CIRCLE, [20, 20], {"rack": {"addendum": ha} | LOW}), (1.48, 1.6), 1.2
    ),
    "some tips pointed": Walk(
        lambda ha: (ellipse(0.5), [41, 41], {"rack": {"addendum": ha} | LOW}), (1.6, 1.85), 1.2
    ),
    "the addendum yields to a shift": Walk(
        lambda x: (ellipse(0.3), [41, 41], {"pair": {"x": x}}), (0.84, 0.96), 2.2
    ),
    "a concave part grows too tight": Walk(
        lambda e: ({"type": "limacon", "eccentricity": e}, [40, 40], {}),
        (0.58, 0.72),
        30.0,
        ("undercut", "contact-ratio", "refused"),
        2.0,
    ),
    "the shaft comes to the roots": Walk(
        lambda e: (ellipse(e), [24, 24], {}),
        (0.72, 0.96),
        60.0,
        ("undercut", "contact-ratio", "refused"),
        2.0,
    ),
    "tips of a ring collide": Walk(
        lambda ha: (CIRCLE, [20, 26], {"pair": {"type": "internal"}, "rack": {"addendum": ha}}),
        (0.7, 0.9),
        1.2,
        ("tips-collide",),
    ),
    "the ends of a door meet": Walk(
        lambda way: (DOOR | {"driven_travel_deg": way}, [29, 29], {}),
        (330.0, 346.0),
        0.4,
        ("refused",),
    ),
    "the ratio comes to zero": Walk(
        lambda a: ({"type": "fourier", "cosines": [a]}, [80, 80], {}),
        (0.7, 0.88),
        120.0,
        ("undercut", "contact-ratio", "refused"),
        6.5,
    ),
}


class Stop(NamedTuple):
    """Outlines in modules, contact ratio and tip-pass margin at a value, and codes of errors."""

    outlines: list[Any]
    numbers: list[float]
    codes: frozenset[str]


def stop(walk: Walk, value: float) -> Stop | None:
    """What is made at a value; None where it is refused."""
    law, teeth, tables = walk.tables(value)
    pair = {"module_mm": 1.0, "teeth": teeth} | tables.pop("pair", {})
    output = {"files": ["csv"], "chord_tolerance_mm": FINE}
    document = {"kind": "gear-pair", "name": "walk", "law": law, "pair": pair, "output": output}
    result: Any = gearcam.build(gearcam.design(document | tables))
    try:
        codes = frozenset(one.code for one in result.findings if one.severity == "error")
    except InfeasibleError:
        return None
    passed = result.subject.tip_pass
    numbers = [result.contact_ratio, *([passed.margin] if passed else [])]
    return Stop([shapely.LinearRing(gear.outline) for gear in result.gears], numbers, codes)


@pytest.mark.parametrize("steps", [6, pytest.param(48, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", few(WALKS, 6))
def test_nothing_jumps_but_what_is_told(name: str, steps: int) -> None:
    walk = WALKS[name]
    values = np.linspace(*walk.values, steps)
    stops = [stop(walk, float(value)) for value in values]
    allowed = walk.rate * abs(values[1] - values[0])
    came: list[str] = []
    for before, after in pairwise(stops):
        if after is None or before is None:
            assert after is None, "what is refused stays refused"
            came += ["refused"] if before else []
            continue
        assert before.codes <= after.codes
        came += sorted(after.codes - before.codes, reverse=True)
        for one, other in zip(before.outlines, after.outlines, strict=True):
            assert shapely.hausdorff_distance(one, other) <= allowed + 2.0 * FINE
        for one, other in zip(before.numbers, after.numbers, strict=True):
            assert abs(other - one) <= walk.pace / (steps - 1)
    assert tuple(came) == walk.changes
