"""Drafts of the live view beside the exact answers, for every design file in the gallery.

A draft has coarser outlines and solids, and no values that help, no largest tools and no estimated
errors. All else that it says must be what the exact answer says.
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from gearcam.base.errors import GearcamError
from gearcam.report.page import draft
from helpers_built import built, fresh
from helpers_pairs import PROFILES
from helpers_sampling import few

FAR = 0.02
"""Largest distance of drawn outlines from the exact ones, mm."""

SOLIDS = 2e-3
"""Largest relative difference of what is computed from outlines and solids."""

SAME = 1e-9
"""Largest relative difference of all else."""

ROUGH = (
    "area", "volume", "mass", "inertia", "unbalance", "centroid", "size_mm", "root_radius", "rim",
    "openings", "profile.radius",
)  # fmt: skip
"""Parts of names of facts that are computed from outlines and solids."""

COUNTS = ("vertices", "triangles", "chord_error_mm")
"""Ends of names of facts that say how fine these are."""

NAMES = sorted(path.stem for path in PROFILES.glob("*.toml"))

OF_TOOLS = {"wide-kerf", "tool-too-large"}


def numbers(value: Any) -> list[Any]:
    """The leaves of a fact's value."""
    if isinstance(value, dict):
        return [one for item in value.values() for one in numbers(item)]
    if isinstance(value, list | tuple):
        return [one for item in value for one in numbers(item)]
    return [value]


def made(name: str) -> Any:
    """The result of a design in the gallery without its studies."""
    result = built(f"profiles/{name}.toml").plain
    try:
        _ = result.facts_without_accuracy
    except GearcamError:
        pytest.skip("it cannot be made")
    return result


@pytest.mark.parametrize("name", few(NAMES, 4))
def test_a_draft_says_what_the_exact_answer_says(name: str) -> None:
    result = made(name)
    coarse = fresh(result).coarse()
    exact, rough = result.facts_without_accuracy, coarse.facts_without_accuracy
    names = [one.name for one in exact.quantities() if ".tool." not in one.name]
    assert [one.name for one in rough.quantities()] == names
    for fact in names:
        one, other = exact.quantity(fact), rough.quantity(fact)
        of_solid = any(part in fact for part in ROUGH)
        if fact.endswith(COUNTS):
            continue
        size = max((abs(x) for x in numbers(one.value) if isinstance(x, float)), default=0.0)
        near = SOLIDS * size + FAR if of_solid else SAME * size + 1e-9
        for x, y in zip(numbers(one.value), numbers(other.value), strict=True):
            if fact.endswith("direction_deg"):
                assert math.remainder(y - x, 360.0) == pytest.approx(0.0, abs=near), fact
                continue
            assert y == (pytest.approx(x, abs=near) if isinstance(x, float) else x), fact
        assert of_solid or other.place == one.place, fact


@pytest.mark.parametrize("name", few(NAMES, 4))
def test_a_draft_finds_what_the_exact_answer_finds(name: str) -> None:
    result = made(name)
    told = [
        [(one.severity, one.code, one.where) for one in findings if one.code not in OF_TOOLS]
        for findings in (
            result.checked_without_hints,
            fresh(result).coarse().checked_without_hints,
        )
    ]
    assert told[0] == told[1]


@pytest.mark.parametrize("name", few(NAMES, 4))
def test_the_outlines_of_a_draft_are_near_the_exact_ones(name: str) -> None:
    result = made(name)
    parts = getattr(result, "parts", ())
    if not parts:
        pytest.skip("it has no outlines")
    for one, other in zip(parts, fresh(result).coarse().parts, strict=True):
        lines = [part.contour.polygon.exterior for part in (one, other)]
        assert lines[0].hausdorff_distance(lines[1]) <= FAR + one.contour.tolerance


def test_a_draft_has_the_charts_in_sight() -> None:
    result = built("profiles/nail_machine_slide.toml")
    shown = draft(fresh(result).coarse())
    assert [one["name"] for one in shown["leading"]] == list(result.plain.charts[:3])
