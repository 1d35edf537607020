"""The checks of a study of forces; importing this module registers them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import TORQUE, Param
from gearcam.mechanics.driver_axis import DriverAxis
from gearcam.mechanics.hertz import CONTACT_PRESSURE
from gearcam.mechanics.load import FORCES
from gearcam.mechanics.statics import Statics
from gearcam.numeric.arrays import Array, Mask


def on_way(way: float) -> str:
    """Return a way of a cam that slides to and fro, 1 or -1, in words."""
    return f" on the way {'forward' if way > 0.0 else 'back'}"


@dataclass(frozen=True, eq=False, kw_only=True)
class Loaded(ShortRepr):
    """A cam under its loads.

    Parameters
    ----------
    x : (n,) array, rad or mm
        Positions of the driver.
    driver : DriverAxis
        Their name and unit.
    statics : Statics
        The forces.
    pressure : (n,) array, MPa
        Contact pressure, infinite where an edge carries.
    pointed : bool
        Whether the edge is that of the follower.
    yielding : float, MPa
        Contact pressure at which either part first yields; infinite if unknown.
    torque : (n,) array
        Of the driver, in N m; of a driver that slides nan.
    way : (n,) array, optional
        Of a cam that slides to and fro: 1 forward, -1 back.
    above : bool
        Whether the only wall is above the follower, so that loads have to press it upwards.
    holding : str
        The preload that holds the follower on the cam, in words; empty without a spring.
    release : str
        At which speed the follower lifts off, in words; empty if unknown.
    loose : str
        Where it lifts off at the lowest speeds too, in words; empty if nowhere, or unknown.
    """

    x: Array
    driver: DriverAxis
    statics: Statics
    pressure: Array
    yielding: float
    torque: Array
    pointed: bool = False
    way: Array | None = None
    release: str = ""
    loose: str = ""
    holding: str = ""
    above: bool = False

    @property
    def on_edge(self) -> Mask:
        """Where an edge carries, (n,)."""
        return np.isinf(self.pressure)

    def stretch(self, mask: Mask) -> str:
        """Return where a mask first holds, in words."""
        places = np.flatnonzero(mask)
        turned = np.zeros(len(places)) if self.way is None else self.way[places]
        breaks = np.flatnonzero((np.diff(places) > 1) | (np.diff(turned) != 0.0))
        last = places[breaks[0]] if breaks.size else places[-1]
        low, high = (
            formatted(self.driver.scale * float(self.x[one]), 5) for one in (places[0], last)
        )
        more = f", and {breaks.size} more" if breaks.size else ""
        unit = self.driver.unit + self._on(int(places[0]))
        reach = low if low == high else f"{low} to {high}"
        return f"{self.driver.symbol} = {reach} {unit}{more}"

    def at(self, index: int) -> str:
        """Return a place in words."""
        return self.driver.place(float(self.x[index])) + self._on(index)

    def _on(self, index: int) -> str:
        """Return on which way a place is, in words; empty for a cam that turns."""
        return "" if self.way is None else on_way(float(self.way[index]))


@check("self-locking", kind=FORCES, relation="at least", severity="error")
def self_locking(loaded: Loaded, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report where friction locks the follower: no force of the cam can move it.

    Looks at: the share of the normal force's effect that friction leaves, wherever it would carry.
    """
    locked = loaded.statics.locked
    if locked.any():
        least = float(np.nanmin(loaded.statics.reserve[locked]))
        yield Remark(
            "Friction locks the follower: a smaller pressure angle, a longer or nearer guide, or "
            "less friction frees it.",
            loaded.stretch(locked),
            least,
            limit=0.0,
        )


@check("lift-off", kind=FORCES)
def lift_off(loaded: Loaded, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn where the loads lift the follower off its cam.

    Looks at: the loads against a rise, where no wall holds the follower from the other side, at
    the speed of the drive and at the lowest speeds.
    """
    lifted = loaded.statics.lifted
    upwards = "loads below 0, which press it upwards" if loaded.above else ""
    if lifted.any():
        slow = ", at the lowest speeds too" if loaded.loose else ""
        needs = upwards or "a stiffer spring or more preload"
        message = f"The follower lifts off the cam{slow}: it needs {needs}"
        message += f"; it stays on it up to {loaded.release}." if loaded.release else "."
        message += f" With {loaded.holding} it stays on the cam." if loaded.holding else ""
        yield Remark(message, loaded.stretch(lifted))
    elif loaded.loose:
        needs = upwards or "more preload"
        message = f"The follower lifts off the cam at the lowest speeds: it needs {needs}."
        yield Remark(message, loaded.loose)


@check(
    "contact-pressure",
    kind=FORCES,
    limit=CONTACT_PRESSURE,
    relation="at most",
    severity=("warning", "note"),
    unit="MPa",
)
def contact_pressure(loaded: Loaded, limit: float) -> Iterator[Remark]:
    """Warn of a contact pressure at which the surface wears or yields.

    On an edge, a corner that trimming leaves or that of a pointed follower, it is unbounded: a note
    if there is no limit.

    Looks at: Hertz pressure between profile and follower, over the turn; without a limit against
    that at which either part first yields, if a yield stress is given.
    """
    most = limit or loaded.yielding
    if loaded.on_edge.any():
        beyond = "" if np.isinf(most) else f", beyond the limit of {formatted(most, FEW)} MPa"
        why = " where the follower rides on a corner of the profile"
        yield Remark(
            f"The contact pressure is unbounded{beyond}"
            + (": the follower is pointed." if loaded.pointed else f"{beyond and ','}{why}."),
            loaded.stretch(loaded.on_edge),
            severity="note" if np.isinf(most) else None,
        )
    finite = np.where(loaded.on_edge, np.nan, loaded.pressure)
    if np.isnan(finite).all():
        return
    worst = int(np.nanargmax(finite))
    found = float(finite[worst])
    if found > most:
        message = "The contact pressure is too high: a larger roller or cam, a wider face or less "
        message += "load lowers it."
        yield Remark(message, loaded.at(worst), found, limit=most)


_TORQUE: Final = (
    "drive_torque",
    Param(TORQUE, ge=0, le=1e9, doc="largest torque of the cam's drive; 0: no limit"),
    0.0,
)


@check("drive-torque", kind=FORCES, limit=_TORQUE, relation="at most", unit="N m")
def drive_torque(loaded: Loaded, limit: float) -> Iterator[Remark]:
    """Warn if the cam needs more torque than its drive has.

    Looks at: largest torque of the cam over the turn, with all friction.
    """
    if not limit or np.isnan(loaded.torque).all():
        return
    worst = int(np.nanargmax(loaded.torque))
    found, most = float(loaded.torque[worst]), limit / TORQUE.factor
    if found > most:
        yield Remark("The cam needs more torque than the drive has.", loaded.at(worst), found)
