"""Findings on a mechanism: on its linkage, on what is asked of it, on its loads and chains."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.findings import Finding
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.drives import center_of
from gearcam.linkages.checks import CheckedMachine

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

_NEAR: Final = 1e-3
"""Distance, relative to the wheel's radius, that is none: places are rounded in design files."""

_DEG: Final = math.degrees(1.0)


def machine_to_check(result: MechanismResult) -> CheckedMachine:
    """Return what the checks of linkages look at.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    """
    even = result.without_pair if result.linkage.closed else None
    # of one that is not compared only the accelerations are looked at
    beside = {} if even is None else even.measures if result.design.compare else even.measured(2)
    return CheckedMachine(
        result.linkage,
        result.measures,
        {one.stem: one.rate_unit for one in result.outputs},
        result.transmissions,
        beside,
    )


def own_findings(result: MechanismResult) -> Iterator[Finding]:
    """Yield what is asked for and missed, what is given in vain, and chains that are guided.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    """
    yield from _dwells_missed(result)
    yield from _second_centers(result)
    yield from _loads_unused(result)
    yield from _wheels_apart(result)
    yield from _chains_beside(result)


def _dwells_missed(result: MechanismResult) -> Iterator[Finding]:
    """Yield the dwells that are asked for and not long enough."""
    for number, (one, found) in enumerate(zip(result.design.dwell, result.dwells, strict=True)):
        if found.length < one.least:
            yield Finding(
                code="no-dwell",
                severity="warning",
                message=f"{one.on} has no dwell as long as that: this is the longest.",
                value=_DEG * found.length,
                limit=_DEG * one.least,
                unit="deg",
                where=f"dwell[{number}], from {formatted(_DEG * found.begin, 6)} deg",
            )


def _second_centers(result: MechanismResult) -> Iterator[Finding]:
    """Yield intervals before a dead centre that is reached a second time."""
    for number, (one, found) in enumerate(
        zip(result.design.interval, result.intervals, strict=True)
    ):
        output, _ = result.asked("interval", number)
        measures = result.measures_of(output)
        outer = one.before == "outer"
        top = (measures.largest() if outer else measures.least()).value
        same = [
            center.place
            for center in measures.dead_centers
            if center.outer == outer and math.isclose(center.value, top, rel_tol=1e-9)
        ]
        if len(same) > 1:
            places = ", ".join(f"{formatted(_DEG * place, 6)} deg" for place in same)
            yield Finding(
                code="second-dead-center",
                severity="note",
                message=f"{one.on} reaches this dead centre more than once in a cycle, at "
                f"{places}: the interval is before the first of them.",
                where=f"interval[{number}], to {formatted(_DEG * found.end, 6)} deg",
            )


def _loads_unused(result: MechanismResult) -> Iterator[Finding]:
    """Yield that the study which uses loads, masses and springs is not asked for."""
    design = result.design
    given = [word for word in ("load", "mass", "spring") if getattr(design, word)]
    if given and "torque" not in design.output.studies:
        yield Finding(
            code="loads-unused",
            severity="note",
            message="Only the study of the driver's moment uses loads, masses and springs: "
            'gearcam torque FILE, or studies = ["torque"].',
            where=", ".join(given),
        )


def _wheels_apart(result: MechanismResult) -> Iterator[Finding]:
    """Yield the wheels of levers' chains that are not where their shafts are."""
    for number, one in enumerate(result.design.chain):
        shaft, wheel = _shaft(result, one.on), complex(*one.at)
        if abs(wheel - shaft) > _NEAR * one.radius:
            yield Finding(
                code="wheel-apart",
                severity="note",
                message=f"The chain wheel is not on the shaft {one.on}, which is at {_at(shaft)}: "
                "it is taken to turn with that shaft, by what is no part of the machine.",
                value=abs(wheel - shaft),
                unit="mm",
                where=f"chain[{number}].at_mm",
            )


def _chains_beside(result: MechanismResult) -> Iterator[Finding]:
    """Yield the chains of hoists that do not lead straight to their wheels."""
    for number, one in enumerate(result.design.hoist):
        shaft, at = _shaft(result, one.on), complex(*one.at)
        # the chain is wound up on this side of the wheel
        side = -1j * cmath.exp(1j * one.direction) * (1.0 if one.wind == "ccw" else -1.0)
        beside = ((at - shaft) * side.conjugate()).real
        if abs(beside - one.radius) > _NEAR * one.radius:
            straight = at + side * (one.radius - beside)
            yield Finding(
                code="guided-chain",
                severity="note",
                message="The chain does not lead straight to its wheel on the shaft "
                f"{one.on}, at {_at(shaft)}: this is how far it passes beside the shaft, on the "
                f"side where it is wound up, not the radius of {formatted(one.radius, 6)} mm. It "
                f"is taken to be guided; it is straight with at_mm = [{_numbers(straight)}].",
                value=beside,
                unit="mm",
                where=f"hoist[{number}].at_mm",
            )


def _shaft(result: MechanismResult, name: str) -> complex:
    """Return where a shaft is."""
    start = np.array([result.linkage.span[0]])
    return complex(np.asarray(result.linkage.at(start, 0).jet(center_of(name)).c[0]).flat[0])


def _at(place: complex) -> str:
    return f"({_numbers(place)}) mm"


def _numbers(place: complex) -> str:
    return f"{formatted(place.real + 0.0, 8)}, {formatted(place.imag + 0.0, 8)}"
