"""The checks of mechanisms: change points, jumps at knots, and what a pair makes worse.

Importing this module registers them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import ANGLE, Param
from gearcam.laws.displacement import Jump
from gearcam.linkages.elements import BRANCH, Crank
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.measures import TrackMeasures
from gearcam.linkages.transmission import ADMISSIBLE, Transmission

KIND: Final = "mechanisms"
"""Their group."""

_JUMP, _NOISE = 1e-7, 1e-9
"""Jump of a derivative, as a share of its largest value and in mm or rad, above rounding."""

_WORSE: Final = 1.01
"""Factor above which a larger acceleration is reported."""


_NONE: Final = 1e-9
"""An acceleration this small, as a share of another one, is rounding."""


@dataclass(frozen=True, eq=False)
class CheckedMachine(ShortRepr):
    """What is checked.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    outputs : mapping of str to TrackMeasures
        Its outputs by name.
    units : mapping of str to str
        ``mm`` or ``rad`` of each output.
    transmissions : sequence of Transmission
        The worst place of each dyad.
    even : mapping of str to TrackMeasures
        The same outputs where an even shaft stands in the place of the pair; empty if no pair
        drives it.
    """

    linkage: Linkage
    outputs: Mapping[str, TrackMeasures]
    units: Mapping[str, str]
    transmissions: Sequence[Transmission] = ()
    even: Mapping[str, TrackMeasures] = field(default_factory=dict)


def _at(q: float) -> str:
    return f"at {formatted(math.degrees(q), FEW)} deg"


@check(
    "pressure-angle",
    kind=KIND,
    limit=(
        "pressure_angle",
        Param(
            ANGLE,
            gt=0,
            lt=90,
            example=45,
            doc="largest pressure angle of a dyad; 45 RRR, 30 RRT and TRR",
        ),
        math.nan,
    ),
    relation="at most",
)
def pressure_angle(machine: CheckedMachine, limit: float) -> Iterator[Remark]:
    """Warn of dyads through which a force hardly passes.

    Looks at: the largest pressure angle over the whole range, 90 degrees less the transmission
    angle. Source of the limits: 000, 2.2.
    """
    for transmission in machine.transmissions:
        safe = ADMISSIBLE.get(transmission.dyad.type)
        if transmission.pressure_angle is None or safe is None:
            continue
        most = safe.pressure_angle[0] if math.isnan(limit) else limit
        worst, angle = transmission.pressure_angle, math.degrees(transmission.pressure_angle.value)
        if worst.value > most:
            usual, least = (90.0 - math.degrees(limit) for limit in safe.pressure_angle)
            yield Remark(
                f"The pressure angle of {transmission.dyad.joint} reaches {formatted(angle, 4)} "
                f"deg: the transmission angle falls to {formatted(90.0 - angle, 4)} deg. Usual "
                f"are {formatted(usual)} deg and more, and never less than {formatted(least)} deg.",
                f"{transmission.dyad.joint}, {_at(worst.place)}",
                angle,
                limit=math.degrees(most),
                unit="deg",
            )


@check("guide-distance", kind=KIND, relation="at least")
def guide_distance(machine: CheckedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a block that comes near the pivot of the guide on which it slides.

    Looks at: the least distance ``l0`` over the length of the crank that carries the block; the
    guide turns fast there. Source of the limit: 000, 2.2.
    """
    cranks = {one.joint: one for one in machine.linkage.elements if isinstance(one, Crank)}
    for transmission in machine.transmissions:
        crank = cranks.get(transmission.dyad.first) or cranks.get(transmission.dyad.second)
        if transmission.distance is None or crank is None:
            continue
        least = ADMISSIBLE[transmission.dyad.type].distance[0] * crank.length
        if transmission.distance.value < least:
            yield Remark(
                f"The block of {transmission.dyad.joint} comes within "
                f"{formatted(transmission.distance.value, 4)} mm of the guide's pivot, where the "
                "guide turns fast.",
                f"{transmission.dyad.joint}, {_at(transmission.distance.place)}",
                transmission.distance.value,
                limit=least,
                unit="mm",
            )


@check("change-point", kind=KIND)
def change_point(machine: CheckedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a change point: both positions of a dyad meet, and forces grow without bound.

    Looks at: where the room that a dyad needs to close is 0.
    """
    for dyad in machine.linkage.dyads:
        if dyad.changes:
            told = 'It goes on into the other branch; with change = "branch" it keeps its own.'
            if dyad.keeps == BRANCH:
                told = 'It keeps its branch; with change = "motion" it goes on into the other one.'
            yield Remark(
                f"Both positions of {dyad.joint} meet here: the machine may leave it either way, "
                f"and needs a flywheel or a second link. {told}",
                f"{dyad.joint}, " + ", ".join(_at(one) for one in dyad.changes),
            )


def _jumps(measures: TrackMeasures, order: int) -> Iterator[tuple[float, float]]:
    """Yield the knots at which a derivative jumps, and by how much."""
    places, values = measures.extremes[order]
    least = max(_JUMP * float(np.abs(values).max()), _NOISE)
    for knot in measures.knots[1:-1]:
        there = values[places == knot]
        if there.size > 1 and np.ptp(there) > least:
            yield float(knot), float(there[-1] - there[0])
    if measures.closed and abs(values[0] - values[-1]) > least:
        yield float(measures.knots[0]), float(values[0] - values[-1])


def _told(machine: CheckedMachine, order: int, what: str) -> Iterator[Remark]:
    power = order if order > 1 else ""
    for name, measures in machine.outputs.items():
        unit = f"{machine.units[name]}/rad{power}"
        found = list(_jumps(measures, order))
        if found:
            where, by = max(found, key=lambda one: abs(one[1]))
            share = abs(by) / float(np.abs(measures.extremes[order][1]).max())
            jump = Jump(theta=where, order=order, before=0.0, after=by, share=share)
            more = f"; the largest of {len(found)} jumps" if len(found) > 1 else ""
            yield Remark(
                f"The {what} of {name} jumps by {formatted(by, 5)} {unit}"
                f"{jump.small if jump.slight else ''}{more}.",
                f"{name}, {_at(where)}",
                by,
                severity="note" if jump.slight else None,
                unit=unit,
            )


@check("velocity-jump", kind=KIND, severity=("warning", "note"))
def velocity_jump(machine: CheckedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of outputs whose velocity jumps: a shock.

    A note if it jumps by no more than a thousandth of the largest velocity.

    Looks at: both sides of the knots of laws and motions.
    """
    yield from _told(machine, 1, "velocity")


@check("acceleration-jump", kind=KIND, severity="note")
def acceleration_jump(machine: CheckedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note outputs whose acceleration jumps: vibration at high speed.

    Looks at: both sides of the knots of laws and motions.
    """
    yield from _told(machine, 2, "acceleration")


@check("peak-acceleration", kind=KIND, severity="note")
def peak_acceleration(machine: CheckedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note that a pair makes the largest acceleration larger than an even drive would.

    Looks at: the largest acceleration of each output, also with an even shaft in place of the pair.
    """
    for name, even in machine.even.items():
        unit = f"{machine.units[name]}/rad2"
        own, without = machine.outputs[name].size(2), even.size(2)
        if abs(own.value) > _WORSE * abs(without.value):
            even_one = f"{formatted(abs(without.value), 4)} {unit}"
            told = f"accelerates {name}; an even shaft would not"
            if abs(without.value) > _NONE * abs(own.value):
                factor = formatted(abs(own.value / without.value), 3)
                told = f"makes the largest acceleration of {name} {factor} times that behind an "
                told += f"even shaft, which is {even_one}"
            yield Remark(
                f"The pair {told}.",
                f"{name}, {_at(own.place)}",
                abs(own.value),
                unit=unit,
            )
