"""Numbers of gear pairs in summaries and tables, and the letters they stand among."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.ellipse import Ellipse
from helpers_pairs import job


def small(**given: Any) -> GearPairResult:
    """A small pair, quick to cut."""
    law = given.pop("law", Ellipse(eccentricity=0.2))
    return job(law, given.pop("teeth", (22, 22)), module=2.0, tolerance=0.01, **given)


def test_a_summary_tells_the_bore_of_the_wheel_that_has_one() -> None:
    one, two = small(bores=(8.0, 0.0)).facts.document["gears"]
    assert one["bore_diameter_mm"] == 8.0
    assert "bore_diameter_mm" not in two


def test_a_summary_is_read_by_people_in_any_language(tmp_path: Path) -> None:
    """Letters beyond ASCII stand in the file as they are."""
    written = GearPairResult(replace(small().design, name="Förderer")).write(
        tmp_path, files=["csv"]
    )
    text = (written.directory / "summary.json").read_text("utf-8")
    assert '"name": "Förderer"' in text


def test_centrodes_are_told_until_both_wheels_close() -> None:
    """720 points for each turn of the driver: two turns where it turns twice for once."""
    whole = small().centrode_angles()
    assert (len(whole), whole[-1]) == (721, pytest.approx(2 * math.pi))
    law = Ellipse(eccentricity=0.1, lobes=(1, 2))
    twice = small(law=law, teeth=(20, 40)).centrode_angles()
    assert (len(twice), twice[-1]) == (1441, pytest.approx(4 * math.pi))


def test_whole_numbers_from_python_make_the_hash_of_the_same_file() -> None:
    hashes = {job(Ellipse(eccentricity=0.2), (22, 22), module=m).design_hash for m in (2, 2.0)}
    assert len(hashes) == 1
