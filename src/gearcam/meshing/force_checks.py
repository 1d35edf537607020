"""The checks of a pair's study of forces; importing this module registers them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.quantities import TORQUE, Param
from gearcam.laws.ratio.span import angle_text
from gearcam.mechanics.hertz import CONTACT_PRESSURE
from gearcam.meshing.drive_checks import rows_text
from gearcam.meshing.forces import ToothForces
from gearcam.meshing.settings import DYNAMIC_FORCES, FORCES, STRESS
from gearcam.numeric.arrays import Array, Mask


class Pressed(Protocol):
    """Contacts with their pressures."""

    @property
    def pressure(self) -> Array:
        """Contact pressure of each, (k,), MPa."""
        ...

    @property
    def yielding(self) -> float:
        """Pressure at which either wheel first yields, MPa; infinite if unknown."""
        ...

    @property
    def shares(self) -> str:
        """How teeth share the load, in words within a sentence."""
        ...

    def place_of(self, contact: int) -> str:
        """Return the phase of a contact in words."""
        ...


@dataclass(frozen=True, eq=False, kw_only=True)
class LoadedPair(ShortRepr):
    """A pair under its load.

    Parameters
    ----------
    forces : ToothForces
        The forces at n phases.
    pressure : (k,) array, MPa
        Contact pressure of each; nan where nothing carries.
    half_width : (k,) array, mm
        Half the width of each contact.
    yielding : float, MPa
        Contact pressure at which either part first yields; infinite if unknown.
    """

    forces: ToothForces
    pressure: Array
    half_width: Array
    yielding: float

    @property
    def shares(self) -> str:
        """How teeth share the load (see `Pressed`)."""
        return ", with equal shares of the teeth,"

    def at(self, index: int) -> str:
        """Return a phase in words."""
        return angle_text(float(self.forces.phi1[index]))

    def place_of(self, contact: int) -> str:
        """Return the phase of a contact in words."""
        return self.at(int(self.forces.teeth.points.step[contact]))

    def stretches(self, mask: Mask) -> str:
        """Return in words where a mask holds."""
        return rows_text(self.forces.phi1, mask)


@check("self-locking", kind=(FORCES, DYNAMIC_FORCES), relation="at least", severity="error")
def self_locking(loaded: LoadedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report where friction locks the pair: no torque of the driver moves the load.

    Looks at: the share of the tooth force's effect that friction leaves.
    """
    locked = loaded.forces.locked
    if locked.any():
        least = float(loaded.forces.reserve[locked].min())
        yield Remark(
            "Friction locks the pair: less friction, or a smaller pressure angle frees it.",
            loaded.stretches(locked),
            least,
            limit=0.0,
        )


@check("unstated-forces", kind=(FORCES, DYNAMIC_FORCES))
def unstated_forces(loaded: LoadedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of phases in which no flanks touch: their forces are not stated.

    Looks at: contacts of the flanks that the load presses together.
    """
    apart = ~loaded.forces.driven
    if apart.any():
        yield Remark(
            "No flanks touch here, and forces on tooth edges are not computed: these phases are in "
            "no largest value.",
            loaded.stretches(apart),
        )


@check("load-reverses", kind=FORCES, severity="note")
def load_reverses(loaded: LoadedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note that the load changes its direction: teeth cross the backlash and hit the other flank.

    Looks at: which flanks carry.
    """
    back = loaded.forces.back
    if back.any() and not back.all():
        yield Remark(
            "The load turns the driver here: teeth cross the backlash where it changes, and hit. "
            "Impacts are not in these forces.",
            loaded.stretches(back),
        )


@check("torque-reversal", kind=DYNAMIC_FORCES, severity="note")
def torque_reversal(loaded: LoadedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note that the torque of the teeth changes its direction: with backlash they rattle.

    Looks at: the torque of the teeth on the driven wheel, with the inertia of what it turns.
    """
    back = loaded.forces.back
    if back.any() and not back.all():
        yield Remark(
            "The driven wheel drives the driver here, by its load and inertia: teeth change their "
            "flanks, and rattle if they have backlash.",
            loaded.stretches(back),
        )


@check(
    "contact-pressure",
    kind=(FORCES, DYNAMIC_FORCES, STRESS),
    limit=CONTACT_PRESSURE,
    relation="at most",
    unit="MPa",
)
def contact_pressure(loaded: Pressed, limit: float) -> Iterator[Remark]:
    """Warn of a contact pressure at which flanks wear or yield.

    Looks at: Hertz pressure of all contacts; without a limit against that at which either wheel
    first yields, if a yield stress is given.
    """
    most = limit or loaded.yielding
    if np.isnan(loaded.pressure).all():
        return
    worst = int(np.nanargmax(loaded.pressure))
    found = float(loaded.pressure[worst])
    if found > most:
        yield Remark(
            f"The contact pressure{loaded.shares} is too high: wider or larger wheels, or a "
            "smaller load lower it.",
            loaded.place_of(worst),
            found,
            limit=most,
        )


_TORQUE: Final = (
    "drive_torque",
    Param(TORQUE, ge=0, le=1e9, doc="largest torque of the driver; 0: no limit"),
    0.0,
)


@check("drive-torque", kind=FORCES, limit=_TORQUE, relation="at most", unit="N m")
def drive_torque(loaded: LoadedPair, limit: float) -> Iterator[Remark]:
    """Warn if the pair needs more torque than its drive has.

    Looks at: largest torque of the driver over the turn, with all friction.
    """
    torque = loaded.forces.torque
    if not limit or np.isnan(torque).all():
        return
    worst = int(np.nanargmax(torque))
    found, most = float(torque[worst]) / TORQUE.factor, limit / TORQUE.factor
    if found > most:
        yield Remark("The pair needs more torque than the drive has.", loaded.at(worst), found)
