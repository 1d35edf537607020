"""The checks of what the tables of a mechanism ask for, and of its chains.

Importing this module registers them. Those of its motion are in `gearcam.linkages.checks`.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.drives import center_of
from gearcam.linkages.checks import CheckedMachine

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

TABLES: Final = "tables of mechanisms"
"""Their group."""

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


@check("no-dwell", kind=TABLES, relation="at least", unit="deg")
def no_dwell(result: MechanismResult, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a dwell that is asked for and not long enough.

    Looks at: the longest range of the master in which the output stays within the amount.
    """
    for number, (one, found) in enumerate(zip(result.design.dwell, result.dwells, strict=True)):
        if found.length < one.least:
            yield Remark(
                f"{one.on} has no dwell as long as that: this is the longest.",
                f"dwell[{number}], from {formatted(_DEG * found.begin, 6)} deg",
                _DEG * found.length,
                limit=_DEG * one.least,
            )


@check("second-dead-center", kind=TABLES, severity="note")
def second_center(result: MechanismResult, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note an interval before a dead centre that is reached more than once.

    Looks at: the dead centres of the output with the same value.
    """
    for number, (one, found) in enumerate(
        zip(result.design.interval, result.intervals, strict=True)
    ):
        measures = result.measures_of(result.asked("interval", number)[0])
        outer = one.before == "outer"
        top = (measures.largest() if outer else measures.least()).value
        same = [
            center.place
            for center in measures.dead_centers
            if center.outer == outer and math.isclose(center.value, top, rel_tol=1e-9)
        ]
        if len(same) > 1:
            places = ", ".join(f"{formatted(_DEG * place, 6)} deg" for place in same)
            yield Remark(
                f"{one.on} reaches this dead centre more than once in a cycle, at {places}: the "
                "interval is before the first of them.",
                f"interval[{number}], to {formatted(_DEG * found.end, 6)} deg",
            )


@check("loads-unused", kind=TABLES, severity="note")
def loads_unused(result: MechanismResult, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note loads, masses and springs that nothing uses.

    Looks at: whether the study of the driver's moment is asked for.
    """
    design = result.design
    given = [word for word in ("load", "mass", "spring") if getattr(design, word)]
    if given and "torque" not in design.output.studies:
        yield Remark(
            "Only the study of the driver's moment uses loads, masses and springs: "
            'gearcam torque FILE, or studies = ["torque"].',
            ", ".join(given),
        )


@check("wheel-apart", kind=TABLES, severity="note", unit="mm")
def wheel_apart(result: MechanismResult, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note the wheel of a lever's chain that is not where its shaft is.

    Looks at: the distance of the wheel from its shaft.
    """
    for number, one in enumerate(result.design.chain):
        shaft, wheel = _shaft(result, one.on), complex(*one.at)
        if abs(wheel - shaft) > _NEAR * one.radius:
            yield Remark(
                f"The chain wheel is not on the shaft {one.on}, which is at {_at(shaft)}: "
                "it is taken to turn with that shaft, by what is no part of the machine.",
                f"chain[{number}].at_mm",
                abs(wheel - shaft),
            )


@check("guided-chain", kind=TABLES, severity="note", unit="mm")
def guided_chain(result: MechanismResult, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note the chain of a hoist that does not lead straight to its wheel.

    Looks at: how far it passes beside the shaft, and the radius of the wheel.
    """
    for number, one in enumerate(result.design.hoist):
        shaft, at = _shaft(result, one.on), complex(*one.at)
        # the chain is wound up on this side of the wheel
        side = -1j * cmath.exp(1j * one.direction) * (1.0 if one.wind == "ccw" else -1.0)
        beside = ((at - shaft) * side.conjugate()).real
        if abs(beside - one.radius) > _NEAR * one.radius:
            straight = at + side * (one.radius - beside)
            yield Remark(
                "The chain does not lead straight to its wheel on the shaft "
                f"{one.on}, at {_at(shaft)}: this is how far it passes beside the shaft, on the "
                f"side where it is wound up, not the radius of {formatted(one.radius, 6)} mm. It "
                f"is taken to be guided; it is straight with at_mm = [{_numbers(straight)}].",
                f"hoist[{number}].at_mm",
                beside,
            )


def _shaft(result: MechanismResult, name: str) -> complex:
    """Return where a shaft is."""
    start = np.array([result.linkage.span[0]])
    return complex(np.asarray(result.linkage.at(start, 0).jet(center_of(name)).c[0]).flat[0])


def _at(place: complex) -> str:
    return f"({_numbers(place)}) mm"


def _numbers(place: complex) -> str:
    return f"{formatted(place.real + 0.0, 8)}, {formatted(place.imag + 0.0, 8)}"
