"""Cross-check of a pair without errors by the meshing study."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gearcam.base.findings import run_checks
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.meshing.checks import KIND
from gearcam.meshing.numbers import numbers
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import study

_STEPS: Final = 24
"""Number of phases to study; each takes time."""

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
        told = numbers(found)["contact_ratio"]["min"]
        if number == 1 and told < result.contact_ratio - _SAME:
            yield "contact-ratio", f"studied {told}, built {result.contact_ratio}"
