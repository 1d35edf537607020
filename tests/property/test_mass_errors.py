"""What a summary says of the errors of mass properties is honest: never less, hardly more.

The truth is what exact points of the outlines' curves tell: moments of polygons through 8 to 256
steps of each curve between its knots, extrapolated to none.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.errors import DesignError, InfeasibleError
from gearcam.gears.outline import Outline
from gearcam.gears.pair import make_gear
from gearcam.numeric.moments import Moments, curve_moments
from helpers_gallery import PROFILES

gc: Any = gearcam
TIGHT = 100.0
DENSITY = 7850.0
SOUGHT = "extreme/long_flank_short_bend"
FEW = ("circular", "feeder", "nail_machine_three_phase", "furnace_door", "ring_ellipse")
STEEL_FEW = (*FEW, "rounded_square", "extreme/concave_just_fits", "extreme/teeth_5")


def weighed(name: str) -> Any:
    design = gc.load(PROFILES / f"{name}.toml")
    return gc.build(replace(design, blank=replace(design.blank, density=DENSITY)))


def polygon_terms(points: np.ndarray) -> np.ndarray:
    """Area, first and polar moment under the chords of polylines, one a line."""
    p, q = points[:, :-1], points[:, 1:]
    cross = (np.conj(p) * (q - p)).imag
    square = np.abs(p) ** 2 + np.abs(q) ** 2 + (p * np.conj(q)).real
    terms = [cross / 2.0, cross * (p + q) / 6.0, cross * square / 12.0]
    return np.array([term.sum(axis=1) for term in terms])


def exact_moments(outline: Outline) -> np.ndarray:
    """Area, first and polar moment under the teeth, extrapolated."""
    curves = outline.sampler.curves
    row, place = curves.breaks
    cuts = []
    for k, (start, end) in enumerate(zip(curves.start, curves.end, strict=True)):
        inner = sorted(place[row == k], reverse=bool(start > end))
        cuts += [(k, a, b) for a, b in itertools.pairwise([start, *inner, end]) if a != b]
    number, low, high = np.array(cuts).T
    steps = 256
    # beside a knot, where the law is the other piece's, no more than rounding away
    shares = np.linspace(0.0, 1.0, steps + 1)
    index = np.repeat(number.astype(int), steps + 1)
    at = low[:, None] + (high - low)[:, None] * shares
    points = curves.at(index, at.ravel())[0].reshape(at.shape)
    table = [polygon_terms(points[:, :: steps // n]) for n in (8, 16, 32, 64, 128, 256)]
    for order in range(1, 6):
        gain = 4.0**order
        table = [(gain * b - a) / (gain - 1.0) for a, b in itertools.pairwise(table)]
    sums = np.array([math.fsum(line.real) + 1j * math.fsum(line.imag) for line in table[0]])
    return -sums if outline.toothing.track.clockwise else sums


def made_moments(outline: Outline) -> np.ndarray:
    runs = outline.dense_teeth
    total = sum((curve_moments(run.points, run.tangents) for run in runs), start=Moments())
    return np.array([total.area, total.first, total.polar])


def truths(name: str) -> list[tuple[float, float, float]]:
    """Errors of volume, centroid and inertia of both wheels."""
    result, found = weighed(name), []
    for part, gears in zip(result.parts, zip(*result.steps, strict=True), strict=True):
        height = part.width / len(gears)
        sign = -1.0 if gears[0].hollow else 1.0
        off = sum(exact_moments(one.profile) - made_moments(one.profile) for one in gears)
        off = sign * height * off
        mass = gearcam.parts.mass.mass_properties(part, DENSITY)
        center = complex(*mass.centroid[:2])
        moved = (off[1] - center * off[0]) / (mass.volume + off[0].real)
        found.append((abs(off[0]), abs(moved), DENSITY * 1e-9 * abs(off[2])))
    return found


@cache
def told(name: str) -> tuple[float, float, float]:
    facts = weighed(name).facts
    names = ("volume_mm3", "centroid_mm", "inertia_kg_mm2")
    return tuple(facts[f"accuracy.{one}"] for one in names)  # type: ignore[return-value]


def demand_honest(name: str) -> None:
    volume, centroid, inertia = (max(one) for one in zip(*truths(name), strict=True))
    estimates = told(name)
    assert volume <= estimates[0] <= TIGHT * volume
    assert centroid <= estimates[1]
    assert inertia <= estimates[2] <= TIGHT * inertia


@pytest.mark.parametrize("name", STEEL_FEW)
def test_mass_properties_of_a_few_wheels_are_as_exact_as_told(name: str) -> None:
    demand_honest(name)
