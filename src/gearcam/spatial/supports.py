"""What holds the follower of a cam in space, under forces that are not in the plane of its motion.

Every follower moves in a plane: along the cam in y and z, on an arm in y and z, a turret in x and
z. In this plane it is held as followers of plane cams are (`gearcam.mechanics.supports`). The
forces of the cam are not in it. What they do beside is

- at a *guide* along the cam, which carries the roller at a distance: a couple that tips the
  follower, to which both ends of the guide react in their own directions across it,
- at a *pivot*: a thrust along its axis.

With F the force on the follower across the guide, as x + i*y, M its moment about the middle of the
guide, b the length and w the weight across it, the ends exert

    R = -(F + w)/2 +- i*(Mx + i*My)/b

and their friction is ``mu*(abs(R1) + abs(R2))``; that of a cam in the plane of its guide is the
same. F and M are in proportion to the normal force N, so that N is the root of a convex function;
without weight across the guide it is closed. Loads, springs and weight act along the middle of the
guide. Where friction leaves nothing of N, the follower counts as locked: with
weight across the guide this is on the safe side, as a small N may take it from the guide.

Source: 000 eqs. (3.65) to (3.69), derived in space here. Depends on mechanics and numeric; numpy
only.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.supports import Pivot, Push, StraightGuide, TotalLoad
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.roots import bracketed_root

_ROOT: Final = 1e-14
"""Width of the bracket of a normal force, over the largest."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SpacePush(Push):
    """The force of a cam on a roller, for a normal force of 1 (see `Push`).

    Parameters
    ----------
    force : (n, 3) array
        The force on the follower in the fixed frame.
    moment : (n, 3) array, mm
        Its moment about the point of the roller's axis from which places along it are measured.
    """

    force: Array
    moment: Array


@dataclass(frozen=True, kw_only=True)
class OverhungGuide(StraightGuide):
    """A straight guide parallel to the cam's axis, beside the cam.

    Parameters
    ----------
    distance : float, mm
        From the cam's axis to the middle of the guide, along the roller.
    height : float, mm
        Of its middle above the roller's axis; it goes along with the follower.
    length : float, mm
        Of the guide; 0 if it is not given: then there is no friction.
    """

    distance: float = 0.0
    height: float = 0.0
    length: float = 0.0

    @property
    def mirrored(self) -> tuple[str, ...]:
        """What keeps it from turning (see `Support.mirrored`): the others are sizes."""
        return ("guide_twist_nmm",)

    def _sides(self, push: Any) -> tuple[Plane, Array]:
        """Return the force across the guide, and the moment about its middle, (3, n)."""
        x, y, z = push.force.T
        off, up = self.distance, self.height
        across = np.empty(len(x), dtype=np.complex128)
        across.real, across.imag = x, y
        return across, push.moment.T - np.stack([-up * y, up * x - off * z, off * y])

    def _ends(self, push: Any) -> Plane:
        """Return what both ends exert, the upper one first, (2, n), for a normal force of 1."""
        across, (tipping_x, tipping_y, _) = self._sides(push)
        couple = np.zeros_like(across)
        if self.length:
            couple.real, couple.imag = -tipping_y / self.length, tipping_x / self.length
        return np.asarray([couple - 0.5 * across, -couple - 0.5 * across])

    @staticmethod
    def _weight(total_load: TotalLoad) -> Plane:
        """Return half the weight across the guide, as the ends exert it."""
        half = np.zeros_like(total_load.resultant)
        half.imag = -0.5 * total_load.resultant.real
        return half

    def _pressed(self, force: Array, push: Any, total_load: TotalLoad) -> Array:
        """Return what both ends press on the guide, N, under a normal force."""
        weight = self._weight(total_load)
        return np.abs(force * self._ends(push) + weight).sum(axis=0)

    def normal_force(
        self, push: Any, total_load: TotalLoad, friction: FrictionSpec
    ) -> tuple[Array, Array]:
        """Return force and reserve (see `Support.normal_force`)."""
        upward = np.sign(push.plain)
        effect, load = upward * push.effect, upward * total_load.against
        drag = upward * total_load.sense * friction.guide
        left = effect - drag * np.abs(self._ends(push)).sum(axis=0)
        slack = np.abs(drag) * 2.0 * np.abs(self._weight(total_load))
        moving = np.where(left > 0.0, left, 1.0)

        def missing(force: Array) -> Array:
            return effect * force - load - drag * self._pressed(force, push, total_load)

        low, high = (load - slack) / moving, (load + slack) / moving
        force = low
        if slack.any():
            width = _ROOT * max(float(np.abs(high).max(initial=0.0)), np.finfo(float).tiny)
            force = bracketed_root(missing, low, high, width)
        reserve = np.where(drag > 0.0, left, effect) / np.abs(push.plain)
        return force, reserve

    def friction_of(
        self, force: Array, push: Any, total_load: TotalLoad, friction: FrictionSpec
    ) -> Array:
        """Return the friction in the guide, N (see `Support.friction_of`)."""
        pressed = self._pressed(force, push, total_load)
        return friction.guide * pressed * np.abs(total_load.sense)

    def reactions(
        self,
        force: Array,
        push: Any,
        total_load: TotalLoad,
        friction: FrictionSpec,  # noqa: ARG002
    ) -> dict[str, Array]:
        """Return forces across the guide, of both ends and whole, and couples (see `Support`)."""
        across, (tipping_x, tipping_y, twist) = self._sides(push)
        weight = self._weight(total_load)
        columns = {"guide_n": np.abs(force * across - 2.0 * weight)}
        if not self.length:
            return columns
        high, low = np.abs(force * self._ends(push) + weight)
        return columns | {
            "guide_low_n": low,
            "guide_high_n": high,
            "guide_moment_nmm": force * np.hypot(tipping_x, tipping_y),
            "guide_twist_nmm": -force * twist,
        }


@dataclass(frozen=True, kw_only=True)
class ThrustPivot(Pivot):
    """A pivot of a follower in space, with a thrust along its axis.

    Parameters
    ----------
    along : int
        The axis of the pivot: 0 is x, 1 is y.
    central : bool
        Whether the rollers are in its middle plane: then what tips it is known.
    """

    along: int
    central: bool

    @property
    def mirrored(self) -> tuple[str, ...]:
        """What is along y, which is reversed (see `Support.mirrored`)."""
        return ("pivot_thrust_n",) if self.along else ("pivot_y_n",)

    def reactions(
        self, force: Array, push: Any, total_load: TotalLoad, friction: FrictionSpec
    ) -> dict[str, Array]:
        """Return radial force, thrust and the couple across the axis (see `Support`)."""
        plane = super().reactions(force, push, total_load, friction)
        columns = {
            "pivot_n": plane["pivot_n"],
            f"pivot_{'yx'[self.along]}_n": plane["pivot_x_n"],
            "pivot_z_n": plane["pivot_y_n"],
            "pivot_thrust_n": -force * push.force[:, self.along],
        }
        if self.central:
            tipping = np.delete(push.moment, self.along, axis=1)
            columns["pivot_moment_nmm"] = force * np.linalg.norm(tipping, axis=1)
        return columns
