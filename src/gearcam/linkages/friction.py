"""Friction in the joints of a linkage: what it exerts, and how that depends on the reactions.

A journal has the moment ``r*|R|*sin(atan(mu))`` against its turning. A guide has the force
``mu*|N|`` against its sliding while the force N falls within its length b, ``|M| < |N|*b/2`` with
the couple M, and ``2*mu*|M|/b`` where the slide tips and presses at both ends.

Source: 000, section 2.2.3.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Generic, NamedTuple, Self, TypeVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.bonds import Bond, Hinge, SlidingJoint, Wrench
from gearcam.linkages.known import Known
from gearcam.numeric.arrays import Array, Mask

_Joint = TypeVar("_Joint", bound=Bond)


class Rubbing(NamedTuple):
    """Friction of a joint at n angles of the driver.

    Attributes
    ----------
    unit : Wrench
        What a unit of it exerts on the joint's member.
    size : (n,) array, N or N mm
        Its size, with its sign.
    slopes : (n, 2) array
        Derivatives of the size by the joint's unknowns.
    lost : (n,) array, N mm
        Work lost per rad of the driver.
    """

    unit: Wrench
    size: Array
    slopes: Array
    lost: Array


@dataclass(frozen=True, kw_only=True)
class Friction(ShortRepr, ABC, Generic[_Joint]):
    """Friction of a joint.

    Parameters
    ----------
    coefficient : float
        Of friction.
    """

    coefficient: float

    def times(self, share: float) -> Self:
        """Return the same with a `share` of its coefficient."""
        return replace(self, coefficient=share * self.coefficient)

    @abstractmethod
    def of(self, joint: _Joint, known: Known, own: Array) -> Rubbing:
        """Return its friction.

        Parameters
        ----------
        joint : Bond
            The joint.
        known : Known
            The motion.
        own : (n, 2) array, N and N mm
            The joint's unknowns.
        """


@dataclass(frozen=True, kw_only=True)
class JournalFriction(Friction[Hinge]):
    """Friction of a hinge.

    Parameters
    ----------
    coefficient : float
        Of friction.
    radius : float, mm
        Of the journal.
    """

    radius: float

    @property
    def circle(self) -> float:
        """Radius of the friction circle, mm, which the force of the joint touches."""
        return self.radius * float(np.sin(np.arctan(self.coefficient)))

    def of(self, joint: Hinge, known: Known, own: Array) -> Rubbing:
        """Return the moment of a `joint` with the forces `own`, at what is `known`."""
        turns, force = joint.turns(known), np.hypot(*own.T)
        arm = self.circle * np.sign(turns)
        ways = np.divide(own, force[:, None], out=np.zeros_like(own), where=force[:, None] > 0.0)
        unit = Wrench.couple(np.ones(turns.shape))
        return Rubbing(unit, -arm * force, -arm[:, None] * ways, np.abs(arm * turns) * force)


@dataclass(frozen=True, kw_only=True)
class GuideFriction(Friction[SlidingJoint]):
    """Friction of a straight guide.

    Parameters
    ----------
    coefficient : float
        Of friction.
    length : float, mm
        Of the guide; infinite if its couple does not matter.
    """

    length: float = np.inf

    def of(self, joint: SlidingJoint, known: Known, own: Array) -> Rubbing:
        """Return the force along a `joint` with normal force and couple `own`, at `known`."""
        slides, tips = known.rate(joint.slide), self.tips(own)
        grip = self.coefficient * np.sign(slides)
        across = np.where(tips, 0.0, np.sign(own[:, 0]))
        tipping = np.where(tips, 2.0 / self.length * np.sign(own[:, 1]), 0.0)
        slopes = -grip[:, None] * np.column_stack([across, tipping])
        size = (slopes * own).sum(axis=1)
        return Rubbing(joint.along(known), size, slopes, -size * slides)

    def tips(self, own: Array) -> Mask:
        """Return where the slide tips, (n,), with normal force and couple `own`, (n, 2)."""
        return np.abs(own[:, 1]) * (2.0 / self.length) > np.abs(own[:, 0])
