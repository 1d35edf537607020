"""The walls of a plane cam as places where it presses on its follower.

Depends on followers, wall and mechanics; numpy only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcam.cams.followers import Follower
from gearcam.cams.wall import Wall
from gearcam.mechanics.follower_loads import DrivenMotion
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.statics import Touch
from gearcam.mechanics.supports import Push, Support
from gearcam.numeric.arrays import Array, Plane, lengths_along


def pushing(
    at: Plane,
    tangent: Plane,
    moved: Plane,
    held: tuple[Support, Array],
    share: Array | float,
    side: int = 1,
) -> tuple[Push, Array]:
    """Return the force of a profile on what touches it, and what its friction takes.

    Parameters
    ----------
    at, tangent : (n,) complex arrays, mm and 1
        Points of contact, and tangents of the profile, clockwise.
    moved : (n,) complex array, mm per unit of the driver's way
        Velocity of the cam there.
    held : (Support, (n,) array)
        What holds the follower, and its velocity.
    share : float or (n,) array
        Tangential force over normal force.
    side : {1, -1}
        Whether the follower is outside the profile.

    Returns
    -------
    push : Push
        Its force.
    lost : (n,) array, mm per unit of the driver's way
        Work that friction takes, over the normal force.
    """
    support, ds = held
    normal = side * 1j * tangent
    slide = ((moved - support.velocity(at) * ds) * np.conj(tangent)).real
    unit = normal + share * np.sign(slide) * tangent
    plain, effect = support.lifting(normal, at), support.lifting(unit, at)
    arm = (unit * np.conj(moved)).real
    return Push(at=at, unit=unit, plain=plain, effect=effect, arm=arm), share * np.abs(slide)


@dataclass(frozen=True, eq=False, kw_only=True)
class WallTouch(Touch):
    """A wall that can press on the follower of a cam (see `Touch`).

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
    width : float, mm
        Width of the contact; by default forces are those per mm.
    """

    wall: Wall
    end: Follower
    key: str = ""
    across: float = 0.0
    width: float = 1.0

    @property
    def radius(self) -> float:
        """Radius of the follower's end (see `Touch.radius`)."""
        return self.end.radius

    def _state(self, x: Array) -> tuple[Array, Array, Array]:
        """Return position of the wall's follower, its lift and velocity."""
        if self.across:
            x = (x + self.across) % self.wall.program.period
        s, ds = self.wall.program.derivatives(x, 1)
        return x, s, ds

    def push(self, motion: DrivenMotion, support: Support, share: float) -> tuple[Push, Array]:
        """Return the force of the wall, and what its friction takes (see `Touch.push`)."""
        x = motion.x
        _, s, own = self._state(x)
        wall, touching = self.wall, self.wall.follower
        inset = wall.side * touching.radius
        at, tangent = touching.trace(wall.carrier, np.zeros_like(x), touching.start + s, own, inset)
        if self.across:
            at, tangent = -at, -tangent
        moved = motion.way * wall.carrier.passing(at)
        return pushing(at, tangent, moved, (support, motion.ds), share, wall.side)

    def drag(self, force: Array, push: Push, friction: FrictionSpec) -> Array:
        """Return the friction of the cam's bearing (see `Touch.drag`)."""
        return self.wall.carrier.drag(force * push.unit, friction)

    def along(self, x: Array) -> Array:
        """Return how far the contact has come along its wall, mm, at rising positions (n,)."""
        x, s, ds = self._state(x)
        wall, touching = self.wall, self.wall.follower
        inset = wall.side * touching.radius
        path, _ = touching.trace(wall.carrier, x, touching.start + s, ds, inset)
        return lengths_along(path)

    def contact(self, x: Array) -> tuple[Array, Array]:
        """Return relative curvature, and the width (see `Touch.contact`)."""
        x, _, _ = self._state(x)
        speed = self.wall.curve.contact(x, 0).speed.c[0] + np.zeros_like(x)
        with np.errstate(divide="ignore"):
            bent = 1.0 / self.wall.radii(x) + self.end.bend
        curvature = np.where((speed > 0.0) & ~self.wall.on_edge(x), bent, np.inf)
        return curvature, np.full(x.shape, self.width)

    @property
    def edges(self) -> Array:
        """Positions at which it rides on each edge of its wall (see `Touch.edges`)."""
        lost = np.array([one.theta for one in self.wall.lost])
        return np.mod(lost - self.across, self.wall.program.period) if self.across else lost
