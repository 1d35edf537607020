"""Stiff and extreme designs: each is built and right, or refused with what would be."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.kinds.cam.result import CamResult
from gearcam.kinds.gear_pair.result import GearPairResult
from helpers_extreme import EXTREME, misses, must_of, outcome, whole, with_nearest
from helpers_pairs import Assembly, explained
from helpers_rings import overlap
from helpers_sampling import chosen

CASES = {path.stem: must_of(path.read_text()) for path in sorted(EXTREME.glob("*.toml"))}
BUILT = [name for name, must in CASES.items() if must.ending == "built"]
RUNS = [*BUILT, *(name for name, must in CASES.items() if must.codes == {"jamming"})]
NEAREST = [name for name, must in CASES.items() if must.value]

LONG = {
    "formula_steep", "table_noise", "cam_one_degree", "teeth_2000", "cam_roller_past_limit",
    "ring_1_to_40",
}  # fmt: skip

PAGE = EXTREME.parents[1] / "benchmarks" / "results" / "accuracy.md"

PHASES = (0.0, 0.29, 0.57, 0.83)
"""Shares of the driver's way at which wheels are laid over each other."""

FOLLOWED = 3.0
"""Errors of a profile's chords by which the lift that it gives may differ from that asked for."""


@pytest.mark.parametrize(
    "name",
    chosen([*CASES], *(name for name in CASES if name not in LONG)),
)
def test_what_must_happen_happens(name: str) -> None:
    """And what is made has outlines that are simple polygons; what is built, or only jams, runs."""
    wrong, result = outcome(EXTREME / f"{name}.toml")
    assert wrong == []
    if result is not None:
        demand_simple(result)
    if name in RUNS:
        demand_running(result)


def demand_simple(result: Any) -> None:
    pair = isinstance(result, GearPairResult)
    edges = (
        [gear.outline for gear in result.gears]
        if pair
        else [profile.vertices for profile in result.profiles]
    )
    for outline in edges:
        assert np.isfinite(outline).all()
        assert shapely.Polygon(outline).is_valid


def demand_running(result: Any) -> None:
    """Wheels do not overlap by more than their chord errors; cams give the lift asked for."""
    if isinstance(result, CamResult):
        for wall, profile in zip(result.cam.walls, result.profiles, strict=True):
            facts = result.follow(profile.vertices, wall=wall.key).facts
            difference = facts["followed.largest_difference"]
            assert abs(difference) <= FOLLOWED * facts["followed.error"]
    elif result.pair.internal and result.pair.closed:
        assert overlap(result) == 0.0
    elif not result.pair.on_rack:
        assembly, law = Assembly(result), result.law
        way = law.period * law.lobes.n1 if law.closed else law.period
        assert max(assembly.overlap(share * way) for share in PHASES) <= explained(result)


@pytest.mark.slow
@pytest.mark.parametrize("name", NEAREST)
def test_the_nearest_feasible_value_is_told(name: str) -> None:
    assert misses(EXTREME / f"{name}.toml", searched=True) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", BUILT)
def test_the_study_finds_no_interference(name: str) -> None:
    result = gearcam.build(gearcam.load(EXTREME / f"{name}.toml"))
    if isinstance(result, GearPairResult):
        study = result.mesh(steps=3)
        assert study.facts["meshing.interference_steps"] == 0
        assert [one.code for one in study.findings if one.severity == "error"] == []


@pytest.mark.parametrize("name", NEAREST)
def test_the_nearest_feasible_value_is_feasible(name: str) -> None:
    assert with_nearest(EXTREME / f"{name}.toml").parts


def test_the_page_tells_of_every_case() -> None:
    section = PAGE.read_text().split("## Stiff and extreme cases")[1].split("\n## ")[0]
    rows = re.findall(r"^\| `(\w+)` \| [^|]+ \| [^|]+ \|$", section, re.MULTILINE)
    assert sorted(rows) == sorted(CASES)


CIRCLES = """
kind = "gear-pair"
[law]
type = "constant"
[pair]
module_mm = 1
teeth = [{teeth}]
[rack]
addendum = {addendum}
"""


@pytest.mark.parametrize(
    ("told", "teeth", "addendum", "right"),
    [
        ("built", "20, 20", 1, True),
        ("errors contact-ratio", "20, 20", 1, False),
        ("built", "20, 20", 0.2, False),
        ("errors contact-ratio", "20, 20", 0.2, True),
        ("errors contact-ratio, undercut", "20, 20", 0.2, False),
        ("refused, rack.addendum", "20, 20", 1, False),
        ("refused, rack.dedendum", "20, 20", 2, False),
        ("invalid, pair.teeth = 3", "2, 20", 1, True),
        ("invalid, pair.teeth = 4", "2, 20", 1, False),
        ("invalid, pair.module_mm", "2, 20", 1, False),
        ("refused, pair.teeth = 3", "2, 20", 1, False),
    ],
)
def test_a_wrong_claim_is_seen(
    told: str, teeth: str, addendum: float, right: bool, tmp_path: Path
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(
        f"# A case.\n# expected: {told}" + CIRCLES.format(teeth=teeth, addendum=addendum)
    )
    assert (misses(path) == []) == right


@pytest.mark.parametrize(
    "text", ["", "# A case.\nkind = 1\n# expected: built", "# expected: made", "# expected: errors"]
)
def test_a_file_tells_what_must_happen(text: str) -> None:
    with pytest.raises(ValueError, match="no expected outcome"):
        must_of(text)


def test_a_fact_that_is_no_number_is_seen() -> None:
    facts = SimpleNamespace(document={"ratio": float("nan")})
    with pytest.raises(ValueError, match="not JSON compliant"):
        whole(SimpleNamespace(parts=(), findings=(), facts=facts))
