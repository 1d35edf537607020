"""What acts on a linkage: forces and moments, each with the coordinate on which it does work.

With the driver's angle q the moment that balances a force F is ``-F*x'``, x' the derivative of its
way by q: exact, since the linkage gives its derivatives exactly, and without any reaction in a
joint. A moving mass has the force ``-m*a`` and the moment ``-J*alpha''``, at an even speed of the
driver ``a = P''*w^2``.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.coordinates import Acting, NamedCoordinate, WorkCoordinate, WorkState
from gearcam.linkages.known import Known
from gearcam.linkages.plane import dot, square
from gearcam.numeric.arrays import Array, Mask, Plane
from gearcam.numeric.jets import Jet

LOADS, INERTIA, GRAVITY, SPRINGS = "loads", "inertia", "gravity", "springs"
PARTS: Final = (LOADS, INERTIA, GRAVITY, SPRINGS)
"""What efforts come from."""

_MILLI: Final = 1e-3
"""N over kg mm/s2."""

_KILO: Final = 1e3
"""N mm over kg m2/s2."""

_AROUND: Final = np.array([[-1.0], [0.0], [1.0]])
"""Turns about the one of an angle in which a range may hold it."""


@dataclass(frozen=True)
class ActiveRanges(ShortRepr):
    """Ranges of the driver in which a load acts.

    Parameters
    ----------
    ranges : sequence of (float, float), rad
        Begin and end of each, begin not above end.
    period : float, rad, optional
        After which they repeat.
    """

    ranges: Sequence[tuple[float, float]]
    period: float | None = None

    def at(self, q: Array) -> Mask:
        """Return at which of the angles `q` it acts; ends belong to what follows them."""
        found, shift = np.zeros(np.shape(q), dtype=bool), np.zeros((1, 1))
        for begin, end in self.ranges:
            if self.period is not None:  # angles as they are: a remainder would blur the ends
                shift = (np.floor((q - begin) / self.period) + _AROUND) * self.period
            found |= np.any((begin + shift <= q) & (q < end + shift), axis=0)
        return found

    def ends(self, low: float, high: float) -> Array:
        """Return where it begins and ends between the angles `low` and `high`, rad."""
        ends = np.array([end for one in self.ranges for end in one])
        if self.period is not None:
            turns = range(
                math.floor((low - ends.max()) / self.period),
                math.ceil((high - ends.min()) / self.period) + 1,
            )
            ends = np.concatenate([ends + turn * self.period for turn in turns])
        return ends[(ends > low) & (ends < high)]


ForceLaw = Callable[[Acting], "Jet | complex"]
"""``law(acting)``: force, N, or moment, N mm, in the coordinate's positive direction."""


class Effort(ABC):
    """A force or a moment with the coordinate on which it does work."""

    coordinate: WorkCoordinate
    part: str
    """What it comes from, of `PARTS`."""
    active: ActiveRanges | None = None
    """Where it acts; everywhere if None."""

    @abstractmethod
    def force(self, state: WorkState) -> Jet:
        """Return the force, N, complex on a point's place, or the moment, N mm."""

    def balance(self, state: WorkState) -> Jet:
        """Return the moment or force that balances it in the displacement of a `state`.

        Of the driver's own motion it is the driver's moment, N mm, over its angle: positive if it
        must drive.
        """
        way = self.coordinate.rate(state.displaced, state.order)
        return self._where_active(state.q, state.angle * 0.0 - dot(self.force(state), way))

    def acting(self, state: WorkState) -> Plane:
        """Return the force, N, or moment, N mm, where it acts, (n,)."""
        found = self._where_active(state.q, self.force(state))
        return np.asarray(found.c[0]) + np.zeros(state.q.shape, dtype=complex)

    def _where_active(self, q: Array, values: Jet) -> Jet:
        """Return values that are 0 where it does not act."""
        if self.active is None:
            return values
        acts = self.active.at(q)
        return Jet([np.where(acts, one, 0.0) for one in values.c])


@dataclass(frozen=True)
class AppliedForce(ShortRepr, Effort):
    """A force along a way, or a moment about an angle, that follows a law.

    Parameters
    ----------
    coordinate : WorkCoordinate
        On which it does work.
    law : callable
        ``law(acting)`` (see `ForceLaw`).
    part : str
        Of `PARTS`.
    active : ActiveRanges, optional
        Where it acts.
    """

    coordinate: WorkCoordinate
    law: ForceLaw
    part: str = LOADS
    active: ActiveRanges | None = None

    def force(self, state: WorkState) -> Jet:
        """Return the force or moment."""
        return state.angle * 0.0 + self.law(Acting(state, self.coordinate))


def force_on(
    point: str,
    force: complex,
    part: str = LOADS,
    active: ActiveRanges | None = None,
    member: str = "",
) -> AppliedForce:
    """Return a force of constant size and direction at a point.

    Parameters
    ----------
    point : str
        The joint.
    force : complex, N
        In the machine's frame.
    part : str
        Of `PARTS`.
    active : ActiveRanges, optional
        Where it acts.
    member : str
        See `NamedCoordinate`.
    """
    return AppliedForce(NamedCoordinate(point, member), lambda _: force, part, active)


@dataclass(frozen=True)
class InertiaForce(ShortRepr, Effort):
    """The inertia force of a mass, or the inertia torque of what turns.

    Parameters
    ----------
    coordinate : WorkCoordinate
        That moves.
    amount : float, N s2/mm or N mm s2
        Its mass, or its moment of inertia.
    member : str
        What has it.
    """

    coordinate: WorkCoordinate
    amount: float
    member: str

    part = INERTIA

    @classmethod
    def of_mass(cls, center: str, mass: float, member: str) -> InertiaForce:
        """Return that of a `mass`, kg, of a `member`, by the joint in its `center` of mass."""
        return cls(NamedCoordinate(center, member), _MILLI * mass, member)

    @classmethod
    def of_turn(cls, turn: WorkCoordinate, inertia: float, member: str) -> InertiaForce:
        """Return that of a `turn`: of the moment of `inertia`, kg m2, of a `member`."""
        return cls(turn, _KILO * inertia, member)

    def force(self, state: WorkState) -> Jet:
        """Return ``-m*P''*w^2`` or ``-J*alpha''*w^2``; 0 without a speed."""
        rate = self.coordinate.rate(state.known, state.order + 1)
        return rate.differentiated() * (-self.amount * (state.speed or 0.0) ** 2)

    def reduced(self, known: Known, order: int) -> Jet:
        """Return its moment of inertia at the driver, ``m*|P'|^2`` or ``J*alpha'^2``, kg m2.

        Parameters
        ----------
        known : Known
            The solved linkage.
        order : int
            Highest derivative.
        """
        return square(self.coordinate.rate(known, order)) * (self.amount / _KILO)
