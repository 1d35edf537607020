"""What a meshing study holds against a pair that its own checks find good."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gearcam.findings import run_checks
from gearcam.kinds.gear_pair.build import GearPairResult
from gearcam.meshing.checks import KIND
from gearcam.meshing.numbers import numbers
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import study

_STEPS: Final = 24
"""Phases that are studied: outlines are laid over each other at each, which takes time."""

_SAME: Final = 1e-6
"""What the same contact ratio may differ by."""


def doubts(result: GearPairResult) -> Iterator[tuple[str, str]]:
    """Yield what a study says against a pair, mounted as designed.

    Parameters
    ----------
    result : GearPairResult
        Any; one with errors has been told.

    Yields
    ------
    place, words : str
        What is contradicted, and how.
    """
    if any(one.severity == "error" for one in result.findings):
        return
    for number, gears in enumerate(result.steps, start=1):
        found = study(gears, MeshingSpec(steps=_STEPS))
        for one in run_checks(KIND, found, result.design.limits):
            if one.severity == "error":
                yield one.code, f"step {number}: {one.message} {one.where}, {one.told}, {one.held}"
        told = numbers(found)["contact_ratio"]["min"]
        if number == 1 and told < result.contact_ratio - _SAME:
            yield "contact-ratio", f"studied {told}, built {result.contact_ratio}"
