"""Every law family at random: wheels that fit each other, or a refusal whose advice holds.

Laws and tooth counts of `random_designs.laws`, up to 200 teeth (the quick runs: 40), and profile
shift. The outlines are simple and do not collide in 64 phases for each tooth (by the stepwise
overlap, and by whole outlines in some phases); a refusal names tooth counts that build while one
step fewer is refused; at most a fifth are refused.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio import LAWS
from gearcam.laws.ratio.span import RACK
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.overlap import Turning
from helpers_pairs import explained, job
from helpers_sampling import few
from random_designs.law_draw import LawDraw
from random_designs.laws import parameters, random_law

MODULE = 2.0
PHASES_PER_TOOTH = 64
FEW_TEETH, FEW_PHASES = 40, 16

SHIFTS = (0.0, 0.0, 0.2, -0.2, 0.4)
"""Profile shifts, the frequent one twice."""


def region(points: Any) -> Any:
    return shapely.Polygon(np.stack([points.real, points.imag], axis=1))


def whole_overlap(made: GearPairResult, phi: float) -> float:
    """Area that the whole outlines share at a phase."""
    driven = float(made.law.phi2(phi))
    one = made.gear1.outline @ [1, 1j] * np.exp(-1j * phi)
    two = made.gear2.outline @ [1, 1j]
    if made.law.mate == RACK:
        two = two - 1j * driven * made.pair.center_distance
    else:
        two = two * np.exp(1j * driven) + made.pair.center_distance
    return float(shapely.intersection(region(one), region(two)).area)


def demand_free(made: GearPairResult, per_tooth: int) -> None:
    """No collision: every phase by the stepwise overlap, a few by whole outlines."""
    end = float(made.centrode_angles()[-1]) if made.law.mate == RACK else made.law.lobes.period
    phases = end * (np.arange(12) + 0.37) / 12
    assert max(whole_overlap(made, phi) for phi in phases) <= explained(made)
    first, second = (half_teeth(gear.profile) for gear in made.gears)
    if not (first.sound and second.sound):  # the study refuses them
        phases = end * np.arange(per_tooth) / per_tooth
        assert max(whole_overlap(made, phi) for phi in phases) <= explained(made)
        return
    turning = Turning(
        rolling=made.pair.rolling, driver=first, driven=second, distance=made.pair.shift
    )
    if made.pair.closed:
        count = per_tooth * math.gcd(*made.pair.teeth)
        angles = made.law.lobes.period * np.arange(count) / count
    else:
        count = per_tooth * made.pair.teeth[1]
        angles = np.linspace(0.0, end, count)
    found = turning.overlaps(angles, 0.0)
    areas = np.bincount(found.step, found.area, minlength=count)
    assert areas.max() <= explained(made)


def demand_remedies(refused: GearPairResult, patience: float) -> None:
    """What the search names builds, and the next smaller change is refused or has errors."""
    found = gearcam.remedies(refused, patience=patience)
    assert found.found or found.gave_up or "pair.teeth" in found.tried
    for remedy in found.found:
        assert not has_errors(remedy.design)
        assert not remedy.less or has_errors(refused.design.with_(remedy.less))


def has_errors(design: Any) -> bool:
    """Whether a design is refused or builds with errors."""
    try:
        findings = gearcam.build(design).findings
    except InfeasibleError:
        return True
    return any(finding.severity == "error" for finding in findings)


def demand(law: Any, teeth: tuple[int, int], x: float, *, thorough: bool = True) -> bool:
    """Build a design and demand all that is promised; whether it was built."""
    start = time.process_time()
    made = job(law, teeth, module=MODULE, x=x)
    try:
        _ = made.gears
    except InfeasibleError as error:
        refused: InfeasibleError | None = error
    else:
        refused = None
    assert time.process_time() - start < 10.0
    if refused is not None:
        demand_remedies(made, 6.0 if thorough else 0.3)
        return False
    for gear in made.gears:
        ring = shapely.LinearRing(gear.outline)
        assert ring.is_simple
        assert ring.is_ccw
    demand_free(made, PHASES_PER_TOOTH if thorough else FEW_PHASES)
    _ = made.findings
    return True


def run(name: str, examples: int, most: int = 200) -> list[bool]:
    """Try random laws of a type on wheels with `most` teeth at most; whether each was built.

    Few teeth are looked at in fewer phases, and remedies are sought for a shorter time.
    """
    built = []
    for number in range(examples):
        d = LawDraw(f"families {name} {number}", most)
        law, teeth = random_law(d, name)
        thorough = most > FEW_TEETH
        built.append(demand(parameters(law), teeth, d.pick(SHIFTS), thorough=thorough))
    return built


@pytest.mark.parametrize("family", few(LAWS, 3))
def test_a_few_designs_of_each_family(family: str) -> None:
    run(family, 1, most=FEW_TEETH)


@pytest.mark.slow
@pytest.mark.parametrize("family", list(LAWS))
def test_two_hundred_designs_of_each_family(family: str) -> None:
    built = run(family, 200)
    assert len(built) >= 150
    assert np.mean(built) >= 0.8
