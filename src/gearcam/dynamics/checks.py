"""Checks of machines in motion; importing this module registers them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.dynamics.rigid import RigidMotion
from gearcam.dynamics.settings import DYNAMICS

_BALANCED = 100.0
"""Largest residue of the energy balance, in tolerances."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MovingMachine(ShortRepr):
    """A machine in motion.

    Parameters
    ----------
    motion : RigidMotion
        Its motion.
    wanted : float or None
        The irregularity that is wanted.
    tolerance : float
        Of the integration.
    place : callable
        ``place(phi)`` returns an angle of the driver in words.
    """

    motion: RigidMotion
    wanted: float | None
    tolerance: float
    place: Callable[[float], str]


@check("stalls", kind=DYNAMICS, severity="error", unit="N m")
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
    message = "The machine stops here."
    if motion.motor is not None and driving:
        message = "The motor does not turn the load here, and the machine stops."
    severity = "note" if not driving else "error"  # it was to coast
    yield Remark(message, moving.place(stopped), max(float(lack), 0.0), severity)


@check("irregularity", kind=DYNAMICS, unit="", relation="at most")
def irregularity(moving: MovingMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a speed that is more irregular than is wanted.

    Looks at: least and largest speed of the driver in the regime, if motor.irregularity is given.
    """
    found, wanted = moving.motion.irregularity, moving.wanted
    if wanted is not None and found > wanted * (1.0 + 1e-9):
        message = (
            "The speed is more irregular than wanted: a flywheel steadies it, "
            'flywheel_kg_m2 = "solve" finds the least.'
        )
        yield Remark(message, "", found, limit=wanted)


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
