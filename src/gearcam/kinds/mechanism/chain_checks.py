"""Notes on chains that do not lead straight from a wheel on its shaft: something guides them."""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.findings import Finding
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.drives import center_of

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

_NEAR: Final = 1e-3
"""Distance, relative to the wheel's radius, that is none: places are rounded in design files."""


def guided_chains(result: MechanismResult) -> Iterator[Finding]:
    """Yield notes on wheels of chains that are not on their shafts, and on chains beside wheels.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    """
    yield from _wheels_apart(result)
    yield from _chains_beside(result)


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
