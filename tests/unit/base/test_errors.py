"""Refusals of values beyond their limits."""

from __future__ import annotations

from typing import Any

import pytest

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import beyond_limit

OTHER = Adjustment(near={"rack.addendum": 1})


@pytest.mark.parametrize(
    ("where", "unit"),
    [
        ("wheel 2, ring.outer_diameter_mm", "mm"),
        ("blank.clearance_mm[1]", "mm"),
        ("output.phi1_deg", "deg"),
        ("law.knots_deg[3]", "deg"),
        ("pair.x", ""),
        ("phi1 = 30 deg", ""),
    ],
)
def test_the_unit_is_that_in_which_the_key_ends(where: str, unit: str) -> None:
    assert beyond_limit("too large", where, 2.0, 1.0).unit == unit
    assert beyond_limit("too large", where, 2.0, 1.0, unit="kg").unit == "kg"


def test_the_text_has_the_place_the_numbers_and_the_note() -> None:
    error = beyond_limit("too large", "wheel 2, ring.rim_mm", 2.0, 1.0, "the limit is the root")
    assert str(error) == (
        "too large (wheel 2, ring.rim_mm); value 2 mm, limit 1 mm; the limit is the root"
    )
    assert error.adjustments == ()


@pytest.mark.parametrize(
    ("changes", "way"),
    [
        ({"near": 0.9}, Adjustment(near={"ring.rim_mm": 0.9})),
        ({"far": 0.0}, Adjustment(near={"ring.rim_mm": 1.0}, far={"ring.rim_mm": 0.0})),
        (
            {"near": 0.9, "far": 0.1},
            Adjustment(near={"ring.rim_mm": 0.9}, far={"ring.rim_mm": 0.1}),
        ),
    ],
)
def test_the_change_is_that_of_the_key_and_comes_first(
    changes: dict[str, Any], way: Adjustment
) -> None:
    error = beyond_limit(
        "too large", "wheel 2, ring.rim_mm", 2.0, 1.0, adjustments=(OTHER,), **changes
    )
    assert error.adjustments == (way, OTHER)
