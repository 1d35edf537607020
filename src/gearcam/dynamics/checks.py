"""Checks of machines in motion; importing this module registers them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import NUMBER, RPM, Param
from gearcam.dynamics.motion import MachineMotion
from gearcam.dynamics.settings import DYNAMICS, VIBRATION
from gearcam.dynamics.stiff import LostContact
from gearcam.numeric.arrays import Array

_BALANCED = 100.0
"""Largest residue of the energy balance, in tolerances."""

_DRIVES = 1e-6
"""Work of loads, over that of the motor, that is rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MovingMachine(ShortRepr):
    """A machine in motion.

    Parameters
    ----------
    motion : MachineMotion
        Its motion.
    wanted : float or None
        The irregularity that is wanted.
    tolerance : float
        Of the integration.
    place : callable
        ``place(phi)`` returns an angle of the driver in words.
    jump : float, N m
        By how much a formula of a load jumps at the driver where the turn ends.
    """

    motion: MachineMotion
    wanted: float | None
    tolerance: float
    place: Callable[[float], str]
    jump: float = 0.0


@check("stalls", kind=DYNAMICS, severity=("error", "note"), unit="N m")
def stalls(moving: MovingMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report that the machine stops, and the torque that it lacks there.

    Looks at: the kinetic energy.
    """
    stopped, motion = moving.motion.stopped, moving.motion
    if stopped is None:
        return
    row = motion.machine.rows(stopped)
    driving = 0.0 if motion.motor is None else float(motion.motor.torque(stopped, 0.0))
    lack = motion.machine.resistance(row, 0.0, driving) - driving
    message, severity = "The machine stops here.", "note"
    if driving:  # it was not to coast
        message = "The motor does not turn the load here, and the machine stops."
        severity = "error"
    yield Remark(message, moving.place(stopped), max(float(lack), 0.0), severity)


@check("irregularity", kind=DYNAMICS, unit="", relation="at most")
def irregularity(moving: MovingMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a speed that is more irregular than is wanted.

    Looks at: least and largest speed of the driver in the regime, if motor.irregularity is given.
    """
    wanted = moving.wanted
    if wanted is not None and (found := moving.motion.irregularity) > wanted * (1.0 + 1e-9):
        message = (
            "The speed is more irregular than wanted: a flywheel steadies it, "
            'flywheel_kg_m2 = "solve" finds the least.'
        )
        yield Remark(message, "", found, limit=wanted)


@check("load-drives", kind=DYNAMICS, severity="note", unit="J")
def load_drives(moving: MovingMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note that the loads drive the machine.

    Looks at: the work on the loads, which is then negative, over a turn or the whole run.
    """
    motion = moving.motion
    fastest = motion.speeds[1][1]
    work, energy = motion.works[1], 0.5 * motion.machine.inertia_ends[1][1] * fastest**2
    if work < -max(moving.tolerance * energy, _DRIVES * abs(motion.works[0])):
        yield Remark("The loads drive the machine: is their sign right?", "", work)


@check("load-jumps", kind=DYNAMICS, severity="note", unit="N m")
def load_jumps(moving: MovingMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note that the formula of a load does not repeat with the turn, or the turns, of the motion.

    Looks at: the load at the driver before the first angle and behind it.
    """
    if moving.jump:
        message = "A formula of a load does not repeat: it jumps here, where it begins anew."
        yield Remark(message, moving.place(float(moving.motion.machine.knots[0])), moving.jump)


@check("energy", kind=DYNAMICS, relation="at most")
def energy(moving: MovingMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of works and energy that do not balance.

    Looks at: works of motor, loads and losses, and the kinetic energy at both ends.
    """
    residue, most = moving.motion.residue, _BALANCED * moving.tolerance
    if residue > most:
        yield Remark(
            "Works and energy do not balance: a smaller tolerance.", "", residue, limit=most
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class VibratingTeeth(ShortRepr):
    """Elastic teeth in motion, over a turn.

    Parameters
    ----------
    lost : list of LostContact
        Where they are apart.
    phi1 : (n,) array, rad
        Places of the turn.
    ratio : (n,) array
        Frequency of the teeth over the natural frequency there.
    speed : float, rad/s
        Mean speed of the driver.
    place : callable
        ``place(phi1)`` returns an angle in words.
    """

    lost: list[LostContact]
    phi1: Array
    ratio: Array
    speed: float
    place: Callable[[float], str]


@check("contact-lost", kind=VIBRATION)
def contact_lost(teeth: VibratingTeeth, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of teeth that part, cross the backlash and hit.

    Looks at: the lag of the driven wheel, against the backlash.
    """
    hits = [one for one in teeth.lost if one.onto]
    if not hits:
        return
    worst = max(hits, key=lambda one: one.impact)
    times = f"{len(hits)} times a turn" if len(hits) > 1 else "once a turn"
    message = (
        f"Teeth part {times}, cross the backlash and hit: the load there is less than the torque "
        "by which the driven wheel's inertia runs ahead."
    )
    yield Remark(message, teeth.place(worst.high), worst.impact, unit="rad/s")


_RESONANCE: Final = (
    "speed_ratio_resonance",
    Param(
        NUMBER,
        ge=0,
        le=0.5,
        doc="how near the frequency of the teeth may be to the natural one, or to half of it",
    ),
    0.1,
)


@check("resonance", kind=VIBRATION, limit=_RESONANCE, relation="about", severity="note")
def resonance(teeth: VibratingTeeth, limit: float) -> Iterator[Remark]:
    """Note where teeth come as often as their mesh vibrates by itself, or half as often.

    Looks at: pitches that pass per second, and the natural frequency, at each angle.
    """
    for whole, words in ((1.0, "the natural frequency"), (0.5, "half the natural frequency")):
        near = np.abs(teeth.ratio / whole - 1.0)
        worst = int(near.argmin())
        if near[worst] <= limit:
            exactly = formatted(teeth.speed * whole / float(teeth.ratio[worst]) / RPM.factor, 4)
            yield Remark(
                f"Teeth come at {words} of their mesh here, exactly so at a mean speed of "
                f"{exactly} rpm: another speed, inertia or stiffness avoids the resonance.",
                teeth.place(float(teeth.phi1[worst])),
                float(teeth.ratio[worst]),
                limit=whole,
            )
