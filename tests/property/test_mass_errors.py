"""What a summary says of the error of volumes is honest: never less, hardly more.

The truth is what exact points of the outlines' curves tell: moments of polygons through 8 to 256
steps of each curve between its knots, extrapolated to none.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.outline import Outline
from gearcam.gears.pair import make_gear
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.numeric.moments import curve_moments
from helpers_pairs import PROFILES
from helpers_sampling import few

gc: Any = gearcam
TIGHT = 100.0
DENSITY = 7850.0
FEW = ("feeder", "nail_machine_three_phase", "furnace_door", "ring_ellipse", "rounded_square")
EDGES = ("concave_just_fits", "ellipse_95", "ring_tips_pass", "rack_uneven", "teeth_5")
ALL = (*(path.stem for path in PROFILES.glob("*.toml")), *(f"extreme/{name}" for name in EDGES))
PAIRS = sorted(
    name
    for name in ALL
    if isinstance(gc.load(PROFILES / f"{name}.toml"), GearPairDesign) and name not in FEW
)


def weighed(name: str) -> Any:
    return dense(gc.load(PROFILES / f"{name}.toml"))


def dense(design: Any) -> Any:
    # chamfers and threads have errors of their own, which hide those of curves
    plain = replace(design.blank, density=DENSITY, chamfer=0.0, set_screw="none")
    return gc.build(replace(design, blank=plain))


def exact_area(outline: Outline) -> float:
    """Area under the teeth, extrapolated."""
    curves = outline.sampler.curves
    row, place = curves.breaks
    cuts = []
    for k, (start, end) in enumerate(zip(curves.start, curves.end, strict=True)):
        inner = sorted(place[row == k], reverse=bool(start > end))
        cuts += [(k, a, b) for a, b in itertools.pairwise([start, *inner, end]) if a != b]
    number, low, high = np.array(cuts).T
    steps = 256
    shares = np.linspace(0.0, 1.0, steps + 1)
    index = np.repeat(number.astype(int), steps + 1)
    at = low[:, None] + (high - low)[:, None] * shares
    points = curves.at(index, at.ravel())[0].reshape(at.shape)
    table = [_swept(points[:, :: steps // n]) for n in (8, 16, 32, 64, 128, 256)]
    for order in range(1, 6):
        gain = 4.0**order
        table = [(gain * b - a) / (gain - 1.0) for a, b in itertools.pairwise(table)]
    area = math.fsum(table[0])
    return -area if outline.toothing.track.clockwise else area


def _swept(points: np.ndarray) -> np.ndarray:
    """Area under the chords of polylines, one a line."""
    p, q = points[:, :-1], points[:, 1:]
    return np.imag(np.conj(p) * (q - p)).sum(axis=1) / 2.0


def computed_area(outline: Outline) -> float:
    return sum(curve_moments(run.points, run.tangents).area for run in outline.dense_teeth)


def demand_honest(result: Any, true: list[float]) -> None:
    estimate = result.facts["accuracy.volume_mm3"]
    assert max(true) <= estimate <= TIGHT * max(true)


def demand_honest_curves(name: str) -> None:
    result, true = weighed(name), []
    for part, *gears in zip(result.parts, *result.steps, strict=True):
        height = part.width / len(gears)
        profiles = [gear.profile for gear in gears]
        off = sum(exact_area(profile) - computed_area(profile) for profile in profiles)
        true.append(height * abs(off))
    demand_honest(result, true)


@pytest.mark.parametrize("name", few(FEW, 3))
def test_mass_properties_of_a_few_wheels_are_as_exact_as_told(name: str) -> None:
    demand_honest_curves(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", PAIRS)
def test_mass_properties_of_all_wheels_are_as_exact_as_told(name: str) -> None:
    demand_honest_curves(name)


@pytest.mark.slow
def test_ends_of_flanks_that_were_sought_are_in_the_errors_of_mass_properties() -> None:
    """Against outlines to a 64th of the tolerance: the flanks of one wheel end elsewhere."""
    square = {"type": "rounded-polygon", "corners": 4, "corner_radius": 0.178076}
    pair = {"module_mm": 7.78935, "teeth": [35, 35]}
    design = gc.design({"kind": "gear-pair", "name": "squares", "law": square, "pair": pair})
    result, true = dense(design), []
    for part, gear in zip(result.parts, result.gears, strict=True):
        finer = make_gear(gear.pair, gear.wheel, gear.profile.tolerance / 64.0, DEFAULT)
        off = computed_area(finer.profile) - computed_area(gear.profile)
        true.append(part.width * abs(off))
    assert [gear.profile.flanks.traced for gear in result.gears] == [False, True]
    demand_honest(result, true)
