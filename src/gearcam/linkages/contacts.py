"""Contacts that move shafts and slides of a linkage: teeth of wheels, cams on their followers.

A drive is a bond with one unknown, a moment on a shaft or a force along a guide. What makes it is a
force along a line of action, whose moment or component this is. The rest of that force, which does
no work, is carried by the bearing of the shaft or by the guide, and the opposite one by those of
the shaft or slide that drives. So a contact adds no unknown: its force is in proportion to what the
drives of all that is on the shaft exert together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.bonds import Bond, Hinge, PushDrive, ShaftDrive, SlidingJoint, Wrench
from gearcam.linkages.known import GROUND, Known
from gearcam.numeric.arrays import Array, Plane

_SAME: Final = 1e-9
"""Difference of places, mm, or of rates up to which two shafts are one."""


class LineOfAction(NamedTuple):
    """A contact at n angles of the driver, for a moment of 1 on its shaft, or a force of 1.

    Attributes
    ----------
    force : (n,) complex array, 1/mm or 1
        Force on what is driven, in the machine's frame.
    at : (n,) complex array, mm
        A point on the line.
    normal : (n,) array, 1/mm or 1
        Normal force; negative of a wall that presses the other way.
    """

    force: Plane
    at: Plane
    normal: Array


class Moving(NamedTuple):
    """A shaft or a slide of a drive.

    Attributes
    ----------
    name : str
        Quantity: its turn or its way.
    stands : str
        Joint in which the shaft stands, or frame of the guide.
    member : str
        Whose bearing or guide holds it (see `carrier`); empty if none does.
    """

    name: str
    stands: str
    member: str


@dataclass(frozen=True, eq=False, kw_only=True)
class DriveContact(ShortRepr):
    """What drives a shaft or a slide by a contact.

    Parameters
    ----------
    name : str
        Its name.
    driven : Moving
        What it drives.
    sense : float
        +1 or -1: direction in which a positive moment or force turns or moves this.
    lines : callable
        ``lines(q)`` returns two `LineOfAction` at angles of the linkage's driver: where that moment
        or force is negative, and where it is positive. One flank or wall carries, or the other.
    driver : Moving, optional
        What presses, on which the opposite force acts.
    """

    name: str
    driven: Moving
    sense: float
    lines: Callable[[Array], tuple[LineOfAction, LineOfAction]]
    driver: Moving | None = None

    def wrenches(
        self, bonds: Mapping[str, tuple[Bond, ...]], known: Known, line: LineOfAction
    ) -> Iterator[tuple[str, Wrench]]:
        """Yield what it exerts on members, beside what their drives exert.

        Parameters
        ----------
        bonds : mapping of str to tuple of Bond
            What joins and drives each member.
        known : Known
            The motion.
        line : LineOfAction
            The contact.
        """
        for one, force in ((self.driven, line.force), (self.driver, -line.force)):
            if one and one.member:
                drive = next(bond for bond in bonds[one.member] if isinstance(bond, _DRIVES))
                yield one.member, _idle(drive, one, known, Wrench.at(line.at, force))


_DRIVES: Final = (ShaftDrive, PushDrive)


def _idle(drive: Bond, one: Moving, known: Known, whole: Wrench) -> Wrench:
    """Return the part of a wrench on a shaft or slide that does no work on it."""
    if isinstance(drive, PushDrive):
        (unit,) = drive.units(known)
        along = np.real(np.conj(unit.force) * whole.force)
        return Wrench(whole.force - along * unit.force, whole.moment - along * unit.moment)
    return Wrench.at(known.place(one.stands), whole.force)


def carrier(bonds: Mapping[str, tuple[Bond, ...]], known: Known, name: str, stands: str) -> str:
    """Return the member whose bearing or guide holds a shaft or slide; empty if none does.

    Of several members it is the first. One on another shaft at the same place, which turns as this
    does, is on the same shaft.

    Parameters
    ----------
    bonds : mapping of str to tuple of Bond
        What joins and drives each member, its joint to the one before first.
    known : Known
        The motion, over the whole range.
    name, stands : str
        See `Moving`.
    """

    def bears(one: Bond, driving: Bond) -> bool:
        if isinstance(one, SlidingJoint) and isinstance(driving, PushDrive):
            return (driving.way, one.guide) == (name, stands)
        if not (isinstance(one, Hinge) and isinstance(driving, ShaftDrive)):
            return False
        apart = known.place(one.place) - known.place(stands)
        turned = known.rate(driving.shaft) - known.rate(name)
        return bool(np.abs([apart, turned]).max(initial=0.0) <= _SAME)

    fitting = [
        (driving.name != name, member)
        for member, (first, *others) in bonds.items()
        for driving in others
        if first.by == GROUND and bears(first, driving)
    ]
    return min(fitting, key=lambda one: one[0], default=(False, ""))[1]
