"""Geneva wheels: a crank whose pin turns a slotted wheel by one slot, and leaves it at rest.

The pin enters and leaves along the slot, so that the wheel's speed has no jump there; its
acceleration has. With ``lambda = sin(pi/n) = r/A``, the crank's angle x from the line of centres
and the wheel's angle from its middle place (000, 2.4.6.1)::

    external   tan(phi) = lambda*sin(x)/(1 - lambda*cos(x)),   |x| <= pi/2 - pi/n
    internal   tan(phi) = lambda*sin(x)/(1 + lambda*cos(x)),   |x| <= pi/2 + pi/n

An external wheel turns against its crank, and x counts from the side of the wheel's centre. An
internal one turns with it, and x counts from the other side.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.elements import Carriers, Element, Law
from gearcam.linkages.known import GROUND, Known
from gearcam.linkages.measures import TrackMeasures
from gearcam.linkages.plane import Frame, towards
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array, away, distinct
from gearcam.numeric.jets import Jet

if TYPE_CHECKING:
    from gearcam.linkages.bonds import Bond

_SAME: Final = 1e-9
"""Knots closer than this are one, rad."""

SLOTS: Final = (3, 24)
"""Least and largest number of slots: with two the pin would have to enter at the wheel's centre."""


@dataclass(frozen=True, eq=False)
class GenevaWheel(ShortRepr, Element):
    """A slotted wheel and the crank that indexes it.

    Parameters
    ----------
    name : str
        Of the wheel: its frame begins in its centre, x along the slot that is in engagement in the
        first turn. Its turn, rad, 0 where this slot is on the line of centres, has the name with
        ``.turn`` behind.
    shaft : str
        Quantity: the crank's turn, rad.
    center : str
        Joint in which the crank's shaft stands.
    length : float, mm
        Of the crank, to the pin.
    slots : int
        3 to 24.
    direction : float, rad
        From the crank's shaft to the wheel's.
    start : float, rad
        The crank's direction where the shaft's turn is 0.
    internal : bool
        Whether the wheel surrounds the crank.

    Raises
    ------
    ValueError
        If the number of slots is not allowed, or the crank's length is not above 0.
    """

    needing = ("shaft", "center")

    name: str
    shaft: str
    center: str
    length: float
    slots: int
    direction: float = 0.0
    start: float = 0.0
    internal: bool = False

    def __post_init__(self) -> None:
        """Check the sizes."""
        least, most = SLOTS
        if not least <= self.slots <= most:
            raise ValueError(f"slots {self.slots}: must be {least} to {most}")
        if not self.length > 0.0:
            raise ValueError(f"length {self.length:g} mm: must be above 0")

    @property
    def gives(self) -> tuple[str, ...]:
        """The wheel and its turn."""
        return self.name, f"{self.name}.turn"

    @property
    def pitch(self) -> float:
        """Angle of the wheel from slot to slot, rad: what a turn of the crank moves it."""
        return math.tau / self.slots

    @property
    def distance(self) -> float:
        """From the crank's shaft to the wheel's, mm."""
        return self.length / math.sin(0.5 * self.pitch)

    @property
    def engaged(self) -> float:
        """Angle of the crank while it moves the wheel, rad."""
        return math.pi - self._side * self.pitch

    @property
    def jump(self) -> float:
        """Jump of the wheel's second derivative by the crank's angle at entry and exit, 1/rad."""
        return math.tan(0.5 * self.pitch)

    @property
    def _side(self) -> int:
        return -1 if self.internal else 1

    @property
    def _middle(self) -> float:
        """The shaft's turn at which the pin is in the middle of its engagement, rad."""
        return self.direction - self.start + (math.pi if self.internal else 0.0)

    def switches(self, low: float, high: float) -> Array:
        """Return the turns of the crank's shaft at which the pin enters or leaves.

        Parameters
        ----------
        low, high : float, rad
            The shaft's turns between which they are wanted.

        Returns
        -------
        (n,) array, rad
            Rising.
        """
        first = math.floor((low - self._middle) / math.tau) - 1
        last = math.ceil((high - self._middle) / math.tau) + 1
        middles = self._middle + math.tau * np.arange(first, last + 1)
        found = (middles[:, None] + 0.5 * self.engaged * np.array([-1.0, 1.0])).ravel()
        return found[(low <= found) & (found <= high)]

    def knots(self, law: Law, knots: Array) -> Array:
        """Return the knots of a linkage with those at which the pin enters or leaves.

        Parameters
        ----------
        law : callable
            ``law(q, order) -> Jet``: the shaft's turn over the driver's angle, rad.
        knots : (k,) array, rad
            Of the linkage: the driver's angles from the first to the last one.

        Returns
        -------
        (n,) array, rad
        """
        shaft = TrackMeasures(law, knots, closed=False, highest=0)
        turns = self.switches(shaft.least().value, shaft.largest().value)
        found = np.concatenate([[], *(shaft.places_of(float(one)) for one in turns)])
        return distinct(knots, away(found, knots, _SAME))

    def knots_with(self, track: Callable[[str, Array, int], Jet], knots: Array) -> Array:
        """Return the knots with those where the pin enters or leaves (see `Element`)."""
        return self.knots(partial(track, self.shaft), knots)

    def wheel_turn(self, turn: Jet) -> Jet:
        """Return the wheel's turn.

        Parameters
        ----------
        turn : Jet
            Of the crank's shaft, rad. At entry and exit its value decides the side.

        Returns
        -------
        Jet, rad
            Counter-clockwise, 0 in the middle of the first engagement.
        """
        away = turn - self._middle
        turns = np.floor(np.asarray(away.c[0]) / math.tau + 0.5)
        x = away - turns * math.tau
        sine, cosine = jets.sin_cos(x)
        share = math.sin(0.5 * self.pitch)
        moved = jets.atan(sine * share / (1.0 - cosine * (self._side * share)))
        place = np.asarray(x.c[0])
        rests = np.abs(place) >= 0.5 * self.engaged
        rest = np.copysign(0.5 * self.pitch, place)
        values = [np.where(rests, 0.0 if k else rest, one) for k, one in enumerate(moved.c)]
        return (Jet(values) + turns * self.pitch) * float(-self._side)

    def solve(self, known: Known) -> None:
        """Add the wheel and its turn."""
        turn = self.wheel_turn(known.jet(self.shaft))
        ahead = cmath.exp(1j * self.direction)
        origin = known.jet(self.center) + self.distance * ahead
        known.given[self.name] = Frame(origin, towards(turn) * -ahead)
        known.given[f"{self.name}.turn"] = turn

    def carried(self, carriers: Carriers) -> Carriers:
        """Return the wheel (see `Element`)."""
        del carriers
        return {self.name: self.name}

    def bonds(self, carriers: Carriers) -> Iterator[Bond]:
        """Yield the wheel's bearing and the pin (see `Element`)."""
        from gearcam.linkages.bonds import Hinge, SlotPin  # motion needs none

        by = carriers[self.center]
        yield Hinge(name=f"{self.name}.center", on=self.name, by=by, place=self.name)
        yield SlotPin(
            name=f"{self.name}.pin",
            on=self.name,
            by=GROUND,
            center=self.center,
            length=self.length,
            start=self.start,
            shaft=self.shaft,
            turn=f"{self.name}.turn",
        )
