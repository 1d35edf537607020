"""Rigid body statics of a cam and its follower, at positions of the driver.

A *touch* is a place where a cam can press on its follower: one of a disc cam, two where walls or
rollers hold the follower from both sides. A touch only presses, so that the sign of the load, with
the friction of what else presses on the support, tells which one carries
(`gearcam.cams.supports`). Where no touch can carry the follower *lifts off*; where friction leaves
nothing of the normal force it is *locked*.

The contact force acts on the follower with its roller as one body: friction of the roller on its
pin is a tangential force at its circumference. All work is per unit of the driver's position:

    T = Q*ds + mu*N*abs(slide) + G*abs(ds) + drag

with T the torque of the cam, N mm, or its driving force, N; Q the load, G the friction of the
follower's support, and drag that of the cam's bearing. Without friction ``T = Q*ds`` is the virtual
work; both are held by the tests, as the program gets T from the force and its arm.

Sources: 000 section 3.5, eqs. (3.58), (3.73), (3.78), (3.85); derived anew.

Depends on followers, supports, wall and mechanics; numpy only.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.cams.follower_loads import DrivenMotion, Loads
from gearcam.cams.followers import Follower
from gearcam.cams.supports import Push, Support
from gearcam.cams.wall import Wall
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, lengths_along

_ROUNDING = 1e-12
"""Load over the largest that is rounding."""


def pushing(
    at: Plane, tangent: Plane, past: Plane, share: Array | float, side: int = 1
) -> tuple[Push, Array]:
    """Return the force of a profile on what touches it, and the speed of sliding.

    Parameters
    ----------
    at, tangent : (n,) complex arrays, mm and 1
        Points of contact, and tangents of the profile, clockwise.
    past : (n,) complex array, mm per unit of the driver's position
        Velocity of the cam past the follower there.
    share : float or (n,) array
        Tangential force over normal force.
    side : {1, -1}
        Whether the follower is outside the profile.

    Returns
    -------
    push : Push
        Its force.
    slide : (n,) array, mm per unit of the driver's position
        Velocity along the tangent.
    """
    normal = side * 1j * tangent
    slide = (past * np.conj(tangent)).real
    return Push(at=at, unit=normal + share * np.sign(slide) * tangent, normal=normal), slide


@dataclass(frozen=True, eq=False, kw_only=True)
class Touch(ShortRepr):
    """A place where a cam can press on its follower.

    Parameters
    ----------
    wall : Wall
        The wall that presses.
    end : Follower
        The follower's end there, without the groove's clearance.
    key : str
        Name of the wall; empty for the only touch.
    across : float, rad
        How far the cam is turned on where the touch is on the other side of the axis: 0 or pi.
    """

    wall: Wall
    end: Follower
    key: str = ""
    across: float = 0.0

    def _state(self, x: Array) -> tuple[Array, Array, Array]:
        """Return position of the wall's follower, its lift and velocity."""
        if self.across:
            x = (x + self.across) % self.wall.program.period
        s, ds = self.wall.program.derivatives(x, 1)
        return x, s, ds

    def push(self, motion: DrivenMotion, support: Support, share: float) -> tuple[Push, Array]:
        """Return the force of the wall, and the speed of sliding.

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
        slide : (n,) array, mm per unit of the driver's way
            Velocity of the cam past the follower's end, along the tangent.
        """
        x = motion.x
        _, s, own = self._state(x)
        wall, touching = self.wall, self.wall.follower
        inset = wall.side * touching.radius
        at, tangent = touching.trace(wall.carrier, np.zeros_like(x), touching.start + s, own, inset)
        if self.across:
            at, tangent = -at, -tangent
        past = motion.way * wall.carrier.passing(at) - support.velocity(at) * motion.ds
        return pushing(at, tangent, past, share, wall.side)

    def along(self, x: Array) -> Array:
        """Return how far the contact has come along its wall, mm, at rising positions (n,)."""
        x, s, ds = self._state(x)
        wall, touching = self.wall, self.wall.follower
        inset = wall.side * touching.radius
        path, _ = touching.trace(wall.carrier, x, touching.start + s, ds, inset)
        return lengths_along(path)

    def curvature(self, x: Array) -> Array:
        """Return the relative curvature of wall and follower, 1/mm; infinite on an edge."""
        x, _, _ = self._state(x)
        speed = self.wall.curve.contact(x, 0).speed.c[0] + np.zeros_like(x)
        with np.errstate(divide="ignore"):
            bent = 1.0 / self.wall.radii(x) + self.end.bend
        return np.where((speed > 0.0) & ~self.wall.on_edge(x), bent, np.inf)

    @property
    def edges(self) -> Array:
        """Positions of the driver, (n,), at which it rides on each edge of its wall."""
        lost = np.array([one.theta for one in self.wall.lost])
        return np.mod(lost - self.across, self.wall.program.period) if self.across else lost


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

    Returns
    -------
    Statics
    """
    support, friction, total_load = loads.support, loads.friction, loads.total_load(motion)
    x, ds, way = motion.x, motion.ds, motion.way
    count = x.shape
    force, reserve = np.full(count, np.nan), np.full(count, np.nan)
    carrying, locked = np.full(count, -1), np.zeros(count, dtype=bool)
    lost = {name: np.zeros(count) for name in ("contact", "support", "bearing")}
    torque, bearing = np.zeros(count), np.zeros(count, dtype=complex)
    curvature, reactions = np.full(count, np.nan), dict[str, Array]()
    holding = total_load.holding(support, friction)
    if len(touches) == 1:  # a spring that is solved for leaves rounding where it just holds
        holding[np.abs(holding) <= _ROUNDING * np.abs(total_load.against).max(initial=0.0)] = 0.0
    for number, touch in enumerate(touches):
        part = share(touch.end.radius)
        push, slide = touch.push(motion, support, part)
        asked = holding * support.lifting(push.normal, push.at) >= 0.0
        found, left = support.normal_force(push, total_load, friction)
        stuck = asked & (left <= 0.0)
        carries = asked & (left > 0.0) & (carrying < 0)
        found = np.maximum(found, 0.0)  # rounding, where the load passes through 0
        reserve = np.where(asked, left, reserve)
        locked |= stuck
        carrying[carries] = number
        force = np.where(carries, found, force)
        carrier, pressed = touch.wall.carrier, np.where(carries, found, 0.0)
        arm = way * (push.unit * np.conj(carrier.passing(push.at))).real
        drag = carrier.drag(pressed * push.unit, friction)
        torque += pressed * arm + drag
        bearing += pressed * push.unit
        lost["bearing"] += drag
        lost["contact"] += part * pressed * np.abs(slide)
        rubbed = support.friction_of(pressed, push, total_load, friction) * np.abs(ds)
        lost["support"] += np.where(carries, rubbed, 0.0)
        for name, values in support.reactions(pressed, push, total_load, friction).items():
            held = reactions.setdefault(name, np.full(count, np.nan))
            held[carries] = values[carries]
        curvature = np.where(carries, touch.curvature(x), curvature)
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
    )
