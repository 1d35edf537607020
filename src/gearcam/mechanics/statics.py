"""Rigid body statics of a cam and its follower, at positions of the driver.

A *touch* is a place where a cam can press on its follower: one of a disc cam, two where walls or
rollers hold the follower from both sides. A touch only presses, so that the sign of the load, with
the friction of what else presses on the support, tells which one carries
(`gearcam.mechanics.supports`). Where no touch can carry the follower *lifts off*; where friction
leaves nothing of the normal force it is *locked*.

The contact force acts on the follower with its roller as one body: friction of the roller on its
pin is a tangential force at its circumference. All work is per unit of the driver's position:

    T = Q*ds + mu*N*abs(slide) + G*abs(ds) + drag

with T the torque of the cam, N mm, or its driving force, N; Q the load, G the friction of the
follower's support, and drag that of the cam's bearing. Without friction ``T = Q*ds`` is the virtual
work; both are held by the tests, as the program gets T from the force and its arm.

Sources: 000 section 3.5, eqs. (3.58), (3.73), (3.78), (3.85); derived anew.

Depends on supports and loads; numpy only.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.mechanics.follower_loads import DrivenMotion, Loads
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.supports import Push, Support, TotalLoad
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

_ROUNDING = 1e-12
"""Load over the largest that is rounding."""

_STUCK = 1e-6
"""Share of the normal force's effect that is none: the forces would be a million times the load."""


class Touch(ABC, ShortRepr):
    """A place where a cam can press on its follower."""

    key: str
    """Name of the wall that presses; empty for the only touch."""
    above: bool = False
    """Whether it presses against the direction of a rise; of interest for the only touch."""

    @property
    @abstractmethod
    def radius(self) -> float:
        """Radius of the follower's end there, mm."""

    @abstractmethod
    def push(self, motion: DrivenMotion, support: Support, share: float) -> tuple[Push, Array]:
        """Return the force of the cam, and what its friction takes.

        Parameters
        ----------
        motion : DrivenMotion
            The motion of the follower, at n positions of the driver.
        support : Support
            What holds the follower.
        share : float
            Tangential force over normal force.

        Returns
        -------
        push : Push
            Its force.
        lost : (n,) array, mm per unit of the driver's way
            Work that its friction takes, over the normal force.
        """

    @abstractmethod
    def drag(self, force: Array, push: Push, friction: FrictionSpec) -> Array:
        """Return the friction of the cam's bearing, N mm or N.

        Parameters
        ----------
        force : (n,) array, N
            Normal forces of the `push`, under `friction`.
        """

    @abstractmethod
    def contact(self, x: Array) -> tuple[Array, Array]:
        """Return how cam and follower touch where they are pressed most.

        Parameters
        ----------
        x : (n,) array
            Positions of the driver.

        Returns
        -------
        curvature : (n,) array, 1/mm
            Relative curvature; infinite on an edge.
        width : (n,) array, mm
            Normal force over the largest force per mm of the line of contact.
        """

    @property
    @abstractmethod
    def edges(self) -> Array:
        """Positions of the driver, (n,), at which the follower rides on an edge."""

    def radial(self, push: Push) -> Plane:
        """Return the force of a `push` across the cam's axis, for a normal force of 1."""
        return push.unit

    def reactions(self, force: Array, push: Push) -> dict[str, Array]:  # noqa: ARG002
        """Return what else the cam's bearing exerts, as columns of output.

        Parameters
        ----------
        force : (n,) array, N
            Normal forces of the `push`.
        """
        return {}


@dataclass(frozen=True, eq=False, kw_only=True)
class Statics(ShortRepr):
    """Forces at positions of the driver; nan where nothing carries.

    Parameters
    ----------
    force : (n,) array, N
        Normal force.
    carrying : (n,) int array
        Number of the touch that carries; -1 where none does.
    locked, lifted : (n,) bool arrays
        Where the follower is locked, and where no touch holds it.
    reserve : (n,) array
        Share of the normal force's effect that friction leaves, where the touch would carry.
    torque : (n,) array, N mm or N
        Of the driver, with all friction.
    against : (n,) array, N or N mm
        Loads against a rise.
    useful : (n,) array, N mm or N
        Work of the loads, per unit of the driver's position.
    moving : (n,) bool array
        Where the follower is not at rest.
    lost : dict of str to (n,) array, N mm or N
        Work of friction by places: contact, support, bearing.
    reactions : dict of str to (n,) array
        Of the support, as columns of output, in the frame of a cam that turns counter-clockwise.
    bearing : (n,) complex array, N
        Force of the cam's bearing on the cam, in that frame.
    curvature : (n,) array, 1/mm
        Relative curvature at the touch that carries; infinite on an edge of cam or follower.
    width : (n,) array, mm
        Normal force over the largest force per mm of the line of contact.
    """

    force: Array
    carrying: Ints
    locked: Mask
    lifted: Mask
    reserve: Array
    torque: Array
    against: Array
    useful: Array
    moving: Mask
    lost: dict[str, Array]
    reactions: dict[str, Array]
    bearing: Array
    curvature: Array
    width: Array

    @property
    def driven(self) -> Mask:
        """Where the cam drives, and moves a load."""
        return (self.useful > 0.0) & (self.torque > 0.0)

    @property
    def efficiency(self) -> Array:
        """Work that arrives over work that is put in; nan at rest and where all is lost.

        From the losses, not from the torque: near rest that would be a quotient of rounding.
        """
        work, losses = np.where(self.moving, self.useful, np.nan), sum(self.lost.values())
        with np.errstate(divide="ignore", invalid="ignore"):
            driven, driving = work / (work + losses), 1.0 + losses / work
        share = np.where(work > 0.0, driven, driving)
        return np.where(share > 0.0, share, np.nan)


def solve(
    touches: Sequence[Touch],
    loads: Loads,
    motion: DrivenMotion,
    share: Callable[[float], float],
    total_load: TotalLoad | None = None,
) -> Statics:
    """Return the forces of a cam on its follower.

    Parameters
    ----------
    touches : sequence of Touch
        Where the cam can press.
    loads : Loads
        What acts on the follower beside the cam.
    motion : DrivenMotion
        The motion of the follower, at n positions of the driver; torque is by the driver's way.
    share : callable
        ``share(radius)`` returns tangential over normal force of an end of that radius, mm.
    total_load : TotalLoad, optional
        What the cam moves, if it is not that of a rigid follower.

    Returns
    -------
    Statics
    """
    support, friction = loads.support, loads.friction
    total_load = loads.total_load(motion) if total_load is None else total_load
    ds, count = motion.ds, motion.x.shape
    force, reserve = np.full(count, np.nan), np.full(count, np.nan)
    carrying, locked = np.full(count, -1), np.zeros(count, dtype=bool)
    lost = {name: np.zeros(count) for name in ("contact", "support", "bearing")}
    torque, bearing = np.zeros(count), np.zeros(count, dtype=complex)
    curvature, width = np.full(count, np.nan), np.full(count, np.nan)
    reactions: dict[str, Array] = {}
    holding = total_load.holding(support, friction)
    if len(touches) == 1:  # a spring that is solved for leaves rounding where it just holds
        holding[np.abs(holding) <= _ROUNDING * np.abs(total_load.against).max(initial=0.0)] = 0.0
    for number, touch in enumerate(touches):
        push, rubbed = touch.push(motion, support, share(touch.radius))
        asked = holding * push.plain >= 0.0
        found, left = support.normal_force(push, total_load, friction)
        stuck = asked & (left <= _STUCK)
        carries = asked & (left > _STUCK) & (carrying < 0)
        found = np.maximum(found, 0.0)  # rounding, where the load passes through 0
        reserve = np.where(asked, left, reserve)
        locked |= stuck
        carrying[carries] = number
        force = np.where(carries, found, force)
        pressed = np.where(carries, found, 0.0)
        drag = touch.drag(pressed, push, friction)
        torque += pressed * push.arm + drag
        bearing += pressed * touch.radial(push)
        lost["bearing"] += drag
        lost["contact"] += pressed * rubbed
        rubbed = support.friction_of(pressed, push, total_load, friction) * np.abs(ds)
        lost["support"] += np.where(carries, rubbed, 0.0)
        exerted = support.reactions(pressed, push, total_load, friction)
        for name, values in (exerted | touch.reactions(pressed, push)).items():
            held = reactions.setdefault(name, np.full(count, np.nan))
            held[carries] = values[carries]
        curvature[carries], width[carries] = touch.contact(motion.x[carries])
    none = carrying < 0
    for values in (torque, *lost.values()):
        values[none] = np.nan
    bearing[none] = np.nan
    return Statics(
        force=force,
        carrying=carrying,
        locked=locked & none,
        lifted=none & ~locked,
        reserve=reserve,
        torque=torque,
        against=total_load.against,
        useful=total_load.against * ds,
        moving=total_load.sense != 0.0,
        lost=lost,
        reactions=reactions,
        bearing=bearing,
        curvature=curvature,
        width=width,
    )
