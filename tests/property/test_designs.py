"""Whatever is asked for: two wheels that can be cut and fit each other, or a refusal that helps.

Laws, tooth counts, racks and tolerances at random, far beyond what anybody would draw.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import gearcam
from fuzz.cross_checks_pair import doubts
from gearcam.base.errors import InfeasibleError
from gearcam.gears.flank import trace
from gearcam.gears.outline import Outline
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.numeric.arrays import as_pairs
from helpers_pairs import Assembly, explained, job
from helpers_sampling import QUICK, few, rounded

MODULE = 2.0
"""mm; the size is a matter of scale, which has a test of its own."""

NEAR_RACK = [
    Rack(),
    Rack(tip_radius=0.2),
    Rack(tip_radius=0.0),
    Rack(addendum=0.8, dedendum=1.0, tip_radius=0.3),
    Rack(addendum=1.3, dedendum=1.5, tip_radius=0.2),
    Rack(pressure_angle=math.radians(14.5)),
    Rack(pressure_angle=math.radians(25), tip_radius=0.25),
]

Given = tuple[Any, tuple[int, int], Rack, float]


@st.composite
def tooth_counts(draw: st.DrawFn) -> tuple[int, int]:
    """Equal counts as often as not, else lobes in small numbers or anything."""
    z = draw(st.integers(6, 60))
    kind = draw(st.sampled_from(["equal", "equal", "lobes", "any"]))
    if kind == "equal":
        return z, z
    if kind == "any":
        return z, draw(st.integers(6, 60))
    n1, n2 = draw(st.sampled_from([(1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1)]))
    each = draw(st.integers(math.ceil(6 / min(n1, n2)), 60 // max(n1, n2)))
    return n1 * each, n2 * each


@st.composite
def phase_laws(draw: st.DrawFn, teeth: tuple[int, int]) -> Phases:
    """Two to five phases over a lobe, one ratio left to closure."""
    period = 2 * math.pi * math.gcd(*teeth) / teeth[0]
    widths = draw(st.lists(rounded(0.15, 1.0), min_size=2, max_size=5))
    knots = np.cumsum([0.0, *widths]) / sum(widths) * period
    swing = draw(st.sampled_from([0.05, 0.2, 0.5]))
    mean = teeth[0] / teeth[1]
    ratios: list[Any] = [mean * draw(rounded(1 - swing, 1 + swing)) for _ in widths]
    ratios.append(ratios[0])
    ratios[draw(st.integers(1, len(widths) - 1))] = "solve"
    shape = draw(st.sampled_from(["cosine", "cubic"]))
    return Phases(shape=shape, knots=(*knots[:-1].tolist(), period), ratios=tuple(ratios))


@st.composite
def formula_laws(draw: st.DrawFn, teeth: tuple[int, int]) -> Formula:
    """Two harmonics on a mean: of the ratio, of the driver's radius, or of the driven angle."""
    n1 = teeth[0] // math.gcd(*teeth)
    a, b = draw(rounded(-0.4, 0.4)), draw(rounded(-0.15, 0.15))
    shift, more = draw(rounded(0, 6)), draw(st.integers(1, 3))
    kind = draw(st.sampled_from(["ratio", "r1", "phi2"]))
    first, second = f"cos({n1}*phi1 + {shift})", f"sin({more * n1}*phi1)"
    if kind == "phi2":
        a, b = a / n1 * teeth[0] / teeth[1], b / (more * n1) * teeth[0] / teeth[1]
        return Formula(phi2=f"phi1*{teeth[0]}/{teeth[1]} + {a}*{first} + {b}*{second}")
    scale = 0.5 if kind == "r1" else 1.0
    shape: dict[str, Any] = {kind: f"1 + {scale * a}*{first} + {scale * b}*{second}"}
    return Formula(**shape)


@st.composite
def designs(draw: st.DrawFn) -> Given:
    """A law, tooth counts, a rack and a tolerance in modules."""
    teeth = draw(tooth_counts())
    kind = draw(st.sampled_from(["phases", "phases", "formula", "formula", "ellipse", "constant"]))
    law: Any = Constant()
    if kind == "ellipse":
        law = Ellipse(eccentricity=draw(rounded(0, 0.8)))
    elif kind == "phases":
        law = draw(phase_laws(teeth))
    elif kind == "formula":
        law = draw(formula_laws(teeth))
    rack = draw(st.sampled_from([Rack(), *NEAR_RACK]))
    return law, teeth, rack, draw(st.sampled_from([1e-4, 1e-3, 1e-2]))


def chain_gaps(outline: Outline) -> np.ndarray:
    """How far each curve of an outline ends from where the next begins, mm."""
    rows, count = outline.rows, np.arange(len(outline.rows.kind))
    ends = trace(outline.toothing, rows, count, rows.end)[0]
    starts = trace(outline.toothing, rows, count, rows.start)[0]
    return np.abs(ends - np.roll(starts, -1))


def demand_outline(outline: Outline) -> None:
    """An outline is simple, counter-clockwise, of one piece, and keeps its tolerance."""
    polygon = shapely.Polygon(as_pairs(outline.points))
    assert polygon.is_valid, shapely.is_valid_reason(polygon)
    assert polygon.exterior.is_ccw
    assert chain_gaps(outline).max() <= 1e-8 * MODULE
    vertices = outline.sampler.chords[0]
    inner = np.linspace(0.0, 1.0, 14)[1:-1, None]
    curve = outline.sampler.at((vertices[:-1] + inner * np.diff(vertices)).ravel())[0]
    first = outline.points[::-1] if outline.toothing.wheel == 2 else outline.points
    chord = np.roll(first, -1) - first
    off = np.abs(np.imag(np.conj(chord) * (curve.reshape(12, -1) - first)) / np.abs(chord))
    assert off.max() <= outline.tolerance


def demand_pair(given: Given) -> GearPairResult | None:
    """Build a design and demand all that is promised of it; None if it is refused.

    What a refusal advises is proved in test_families.
    """
    law, teeth, rack, tolerance = given
    made = job(law, teeth, module=MODULE, tolerance=tolerance * MODULE, rack=rack)
    try:
        _ = made.findings
    except InfeasibleError as error:
        refused = error
    else:
        refused = None
    if refused is not None:
        assert refused.what
        assert refused.nearest, f"no way out is named: {refused}"
        return None
    for gear in made.gears:
        demand_outline(gear.profile)
    if any(finding.severity == "error" for finding in made.findings):
        return None
    for gear in made.gears:
        assert shapely.Polygon(gear.outline).contains(shapely.Point(0.0, 0.0))
    assembly = Assembly(made)
    turns = made.law.lobes.n2 if made.law.lobes.n1 == 1 else 1
    phases = 2 * math.pi * turns * (np.arange(8) + 0.37) / 8
    assert max(assembly.overlap(phi) for phi in phases) <= explained(made)
    return made


quick = settings(QUICK, max_examples=12)


@quick
@given(designs())
def test_any_design_can_be_cut_or_is_refused_with_a_reason(design: Given) -> None:
    demand_pair(design)


@pytest.mark.slow
@settings(quick, max_examples=300)
@given(designs())
def test_many_designs_can_be_cut_or_are_refused_with_a_reason(design: Given) -> None:
    demand_pair(design)


BEND = (0.0, 0.493633, 0.885446, 2.0 * math.pi / 3.0)
TORN: dict[str, Given] = {
    "Newton's steps went to and fro across a bend, and a flank ended beyond its tip": (
        Phases(knots=BEND, ratios=(1.3245, 1.4595, "solve", 1.3245)),
        (18, 12),
        NEAR_RACK[3],
        1e-2,
    ),
    "chords of a fillet crossed a root land that the fillet does not meet": (
        Ellipse(eccentricity=0.37),
        (9, 6),
        NEAR_RACK[3],
        1e-2,
    ),
}


@pytest.mark.parametrize("design", TORN.values(), ids=TORN)
def test_outlines_that_were_torn(design: Given) -> None:
    law, teeth, rack, tolerance = design
    made = job(law, teeth, module=MODULE, tolerance=tolerance * MODULE, rack=rack)
    for gear in made.gears:
        demand_outline(gear.profile)


DOUBTED: dict[str, dict[str, Any]] = {
    "a loop of 2 um in a flank, where the curvature jumps": {
        "law": {"type": "three-phase-polynomial", "knots_deg": [0, 61, 130, 180], "lowest": 0.45},
        "pair": {"module_mm": 4, "teeth": [46, 69]},
        "steps": {"count": 4, "offset_mm": -0.5},
        "output": {"chord_tolerance_mm": 2e-5},
    },
    "a corner 1.5 um inside a fillet, with coarse chords": {
        "law": {"type": "rounded-polygon", "corners": 5, "corner_radius": 0.18},
        "pair": {"center_distance_mm": 50, "teeth": [48, 48]},
        "output": {"chord_tolerance_mm": 0.01},
    },
}
"""What the meshing study once found in the outlines of designs, and these designs."""


@pytest.mark.parametrize("name", few(reversed(DOUBTED)))
def test_what_the_study_once_found(name: str) -> None:
    document = {"kind": "gear-pair", "name": "doubted"} | DOUBTED[name]
    made = gearcam.build(gearcam.design(document))
    assert list(doubts(made)) == []
    for gears in made.steps:
        for gear in gears:
            assert shapely.Polygon(gear.outline).is_valid


@settings(quick, max_examples=8)
@given(st.integers(17, 60), rounded(0.0, 0.3), st.sampled_from([1e-4, 1e-3]))
def test_mild_designs_are_never_refused(z: int, swing: float, tolerance: float) -> None:
    law = Formula(ratio=f"1 + {swing}*cos(phi1)")
    assume(z * (1 - swing) > 17)
    made = demand_pair((law, (z, z), Rack(), tolerance))
    assert made is not None
    assert all(gear.profile.undercut_teeth == () for gear in made.gears) or swing > 0.0


def test_an_overlap_is_seen() -> None:
    made = job(Ellipse(eccentricity=0.3), (24, 24), module=MODULE, tolerance=2e-4)
    assembly = Assembly(made)
    assembly.distance -= 0.01
    assert max(assembly.overlap(phi) for phi in (0.4, 2.0)) > explained(made)
