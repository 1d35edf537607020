"""Cross-checks of a pair without errors: by the meshing study, by pins and jaws on its outlines."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gearcam.base.findings import run_checks
from gearcam.gears.pair import Gear
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.meshing.checks import KIND
from gearcam.meshing.numbers import numbers
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import study
from helpers_gauges import jaw_misfits, misfits

_STEPS: Final = 24
"""Number of phases to study; each takes time."""

_CHORDS: Final = 3.0
"""Allowed distance of pins and jaws from an outline, in its chord errors."""

_SAME: Final = 1e-6
"""Allowed difference of contact ratios."""


def doubts(result: GearPairResult) -> Iterator[tuple[str, str]]:
    """Yield contradictions between a pair, mounted as designed, and its meshing study.

    Parameters
    ----------
    result : GearPairResult
        The result to check; one with errors is not checked.

    Yields
    ------
    place, words : str
        Place and description of a contradiction.
    """
    if any(one.severity == "error" for one in result.findings):
        return
    for number, gears in enumerate(result.steps, start=1):
        found = study(gears, MeshingSpec(steps=_STEPS))
        for one in run_checks(KIND, found, result.design.limits):
            if one.severity == "error":
                yield (
                    one.code,
                    f"step {number}: {one.message} {one.where}, {one.text}, {one.limit_text}",
                )
        for gear in gears:
            yield from _measured(gear)
        told = numbers(found)["contact_ratio"]["min"]
        if number == 1 and told < result.contact_ratio - _SAME:
            yield "contact-ratio", f"studied {told}, built {result.contact_ratio}"


def _measured(gear: Gear) -> Iterator[tuple[str, str]]:
    """Yield what is wrong with the measures of a wheel, seen from its outline."""
    allowed = _CHORDS * gear.profile.chord_error
    for what, find in (("pins", misfits), ("span", jaw_misfits)):
        off = abs(find(gear.measuring, gear)).max(initial=0.0)
        if off > allowed:
            yield what, f"wheel {gear.wheel}: {off} mm from the outline, {allowed} are chords"
