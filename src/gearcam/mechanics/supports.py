"""What holds a follower: a guide or a pivot, and the force of the cam that moves it there.

The force of the cam on the follower is ``N*r``: N is the normal force, and r the unit normal with
the share of friction at the contact. The loads against a rise are Q, in N of a guided follower and
in N mm of a swinging one; F is their resultant, as far as it loads the support. With c, what a unit
of N does for a rise, and sigma, the sign of the velocity,

    c*N - Q - sigma*G(N) = 0,

where G is the friction of the support:

==================== ========================================================
guide of length b    ``mu*max(abs(R), 2*abs(M)/b)``: R across, M about its middle
pivot of radius r    ``r*sin(arctan(mu))*abs(N*r + F)``
==================== ========================================================

The first covers both cases of a guide: its ends press on the same side, or on opposite sides if
``abs(M/R) > b/2``. Weight and inertia of a guided follower act at the guide's middle, without a
moment, as the place of its centre of mass is not asked for. Both equations have closed solutions:
the guide's is piecewise linear, the pivot's quadratic. The *reserve* is what is left of c by
friction; where it is gone the follower is locked, whatever the force.

A touch only presses. The left side is convex or concave in N, and beyond all bounds has the sign of
c. So where the follower is not locked N > 0 exists if c and

    Q + sigma*G(0)

have the same sign: *holding* is this sum. It decides between two touches, and whether one touch
keeps its follower. (On a return a touch that takes much of the weight off the support may balance
with the other sign too, by two forces; they are not counted.) Without other forces on the support
G(0) is 0, and it is the sign of the load.

Sources: 000 eqs. (3.65) to (3.69), (3.90) to (3.99), (3.101) to (3.104); derived anew.

Depends on numeric; numpy only.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.mechanics.friction import FrictionSpec
from gearcam.numeric.arrays import Array, Plane


@dataclass(frozen=True, eq=False, kw_only=True)
class Push:
    """The force of a cam on its follower, before it is known how large it is.

    Parameters
    ----------
    at : (n,) complex array, mm
        Points of contact in the fixed frame.
    unit : (n,) complex array
        Force for a normal force of 1, with friction at the contact.
    plain, effect : (n,) arrays, 1 or mm
        What a normal force of 1 does for a rise: by itself, and with friction at the contact.
    arm : (n,) array, mm or 1
        Torque or force of the driver, for a normal force of 1 with friction at the contact.
    """

    at: Plane
    unit: Plane
    plain: Array
    effect: Array
    arm: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class TotalLoad:
    """What a cam has to move.

    Parameters
    ----------
    against : (n,) array, N or N mm
        Loads against a rise.
    resultant : (n,) complex array, N
        Force on the support beside that of the cam.
    sense : (n,) array
        Sign of the velocity.
    """

    against: Array
    resultant: Plane
    sense: Array

    def holding(self, support: Support, friction: FrictionSpec) -> Array:
        """Return what presses the follower back, with the drag of its support, N or N mm.

        Parameters
        ----------
        support : Support
            What holds the follower.
        friction : FrictionSpec
            Coefficients of friction.

        Returns
        -------
        (n,) array
            Positive where a touch from below has to push, negative where one from above has to.
        """
        return self.against + self.sense * support.drag(self.resultant, friction)


class Support(ABC, ShortRepr):
    """What holds a follower."""

    @property
    @abstractmethod
    def mirrored(self) -> tuple[str, ...]:
        """Reactions that change their sign in the mirror image, of a cam that turns clockwise."""

    @abstractmethod
    def velocity(self, z: Plane) -> Plane:
        """Return velocities of points z of the follower, mm per unit of lift."""

    @abstractmethod
    def hurrying(self, z: Plane, ds: Array, d2s: Array) -> Plane:
        """Return accelerations of points z of the follower, mm per square unit of the driver.

        Parameters
        ----------
        z : (n,) complex array, mm
            The points.
        ds, d2s : (n,) arrays
            Derivatives of the lift.
        """

    @abstractmethod
    def normal_force(
        self, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> tuple[Array, Array]:
        """Return the normal force, N, and the reserve.

        Parameters
        ----------
        push : Push
            The force of the cam.
        total_load : TotalLoad
            What it has to move.
        friction : FrictionSpec
            Coefficients of friction.

        Returns
        -------
        force : (n,) array, N
            Negative where the cam would have to pull; of no meaning where the reserve is not
            positive.
        reserve : (n,) array
            Share of the normal force's effect that friction leaves.
        """

    @abstractmethod
    def drag(self, force: Plane, friction: FrictionSpec) -> Array:
        """Return the friction of a moving follower without its cam, N or N mm.

        Parameters
        ----------
        force : (n,) complex array, N
            What presses on the support.
        friction : FrictionSpec
            Coefficients of friction.
        """

    @abstractmethod
    def friction_of(
        self, force: Array, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> Array:
        """Return the friction of the support, N or N mm.

        Parameters
        ----------
        force : (n,) array, N
            Normal force of the `push`, which moves the `total_load` against `friction`.
        """

    @abstractmethod
    def reactions(
        self, force: Array, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> dict[str, Array]:
        """Return what the support exerts on the follower, as columns of output.

        Parameters
        ----------
        force : (n,) array, N
            Normal force of the `push`, which moves the `total_load` against `friction`.
        """

    def lifting(self, direction: Plane, at: Plane) -> Array:
        """Return what unit forces in a direction at points (n,) do for a rise, 1 or mm."""
        return (direction * np.conj(self.velocity(at))).real


@dataclass(frozen=True, kw_only=True)
class StraightGuide(Support):
    """A straight guide.

    Parameters
    ----------
    direction : complex
        Unit vector of a rise.
    middle : complex, mm
        Middle of the guide.
    """

    direction: complex
    middle: complex

    @property
    def mirrored(self) -> tuple[str, ...]:
        """All but forces along it (see `Support.mirrored`)."""
        return "guide_n", "guide_moment_nmm", "guide_low_n", "guide_high_n"

    def velocity(self, z: Plane) -> Plane:
        """Return the direction (see `Support.velocity`)."""
        return np.full(np.shape(z), self.direction)

    def hurrying(self, z: Plane, ds: Array, d2s: Array) -> Plane:  # noqa: ARG002
        """Return accelerations along the guide (see `Support.hurrying`)."""
        return np.asarray(self.direction * d2s, dtype=np.complex128)

    def _across(self, force: Plane) -> Array:
        """Return the component of a force across the guide, N."""
        return (force * np.conj(-1j * self.direction)).real

    def _sideways(self, push: Push, total_load: TotalLoad) -> tuple[Array, Array, Array]:
        """Return forces across the guide by N and of loads, and the moment about it by N."""
        moment = (np.conj(push.at - self.middle) * push.unit).imag
        return self._across(push.unit), self._across(total_load.resultant), moment

    def normal_force(
        self, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> tuple[Array, Array]:
        """Return force and reserve (see `Support.normal_force`)."""
        side, loaded, moment = self._sideways(push, total_load)
        plain = push.plain
        upward = np.sign(plain)
        effect, load = upward * push.effect, upward * total_load.against
        drag = upward * total_load.sense * friction.guide
        forms = [(side, loaded)]
        if friction.guide_length:
            forms.append((2.0 / friction.guide_length * moment, np.zeros_like(moment)))
        signed = [(sign * by, sign * of) for by, of in forms for sign in (1.0, -1.0)]
        left = np.array([effect - drag * by for by, _ in signed])
        with np.errstate(divide="ignore", invalid="ignore"):
            roots = np.array([load + drag * of for _, of in signed]) / left
        roots = np.where(left > 0.0, roots, np.inf)
        hardest = np.max(roots, axis=0, where=np.isfinite(roots), initial=-np.inf)
        force = np.where(drag >= 0.0, hardest, roots.min(axis=0))
        least = np.where(drag > 0.0, left.min(axis=0), effect)
        return force, least / np.abs(plain)

    def drag(self, force: Plane, friction: FrictionSpec) -> Array:
        """Return the friction in the guide, N (see `Support.drag`)."""
        return friction.guide * np.abs(self._across(force))

    def friction_of(
        self, force: Array, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> Array:
        """Return the friction in the guide, N (see `Support.friction_of`)."""
        side, loaded, moment = self._sideways(push, total_load)
        pressed = np.abs(side * force + loaded)
        if friction.guide_length:
            pressed = np.maximum(pressed, 2.0 / friction.guide_length * np.abs(moment * force))
        return friction.guide * pressed * np.abs(total_load.sense)

    def reactions(
        self, force: Array, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> dict[str, Array]:
        """Return forces across and their moment, with a length at both ends (see `Support`)."""
        side, loaded, moment = self._sideways(push, total_load)
        across, turning = -(side * force + loaded), -moment * force
        columns = {"guide_n": across, "guide_moment_nmm": turning}
        if friction.guide_length:
            pair = turning / friction.guide_length
            columns |= {"guide_low_n": 0.5 * across + pair, "guide_high_n": 0.5 * across - pair}
        return columns


def guide(direction: complex, foot: complex, beyond: float, friction: FrictionSpec) -> Support:
    """Return a guide of a stem.

    Parameters
    ----------
    direction : complex
        Along the stem, away from the cam.
    foot : complex, mm
        From where its height counts.
    beyond : float, mm
        Height above which it begins if it has no given place.
    friction : FrictionSpec
        With its length and place.
    """
    length = friction.guide_length or 0.0
    height = beyond + 0.5 * length if friction.guide_at is None else friction.guide_at
    return StraightGuide(direction=direction, middle=foot + height * direction)


@dataclass(frozen=True, kw_only=True)
class Pivot(Support):
    """A pivot about which the follower swings.

    Parameters
    ----------
    at : complex, mm
        The pivot.
    spin : float
        Turn of the follower per unit of lift.
    """

    at: complex
    spin: float

    @property
    def mirrored(self) -> tuple[str, ...]:
        """The component along x (see `Support.mirrored`)."""
        return ("pivot_x_n",)

    def velocity(self, z: Plane) -> Plane:
        """Return velocities around the pivot (see `Support.velocity`)."""
        return 1j * self.spin * (z - self.at)

    def hurrying(self, z: Plane, ds: Array, d2s: Array) -> Plane:
        """Return accelerations around the pivot and towards it (see `Support.hurrying`)."""
        return (1j * self.spin * d2s - (self.spin * ds) ** 2) * (z - self.at)

    def normal_force(
        self, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> tuple[Array, Array]:
        """Return force and reserve (see `Support.normal_force`)."""
        plain = push.plain
        upward = np.sign(plain)
        effect, load = upward * push.effect, upward * total_load.against
        sense, circle, other = (
            upward * total_load.sense,
            friction.circle,
            total_load.resultant,
        )
        square, size = circle**2 * np.abs(sense), np.abs(push.unit)
        a = effect**2 - square * size**2
        b = effect * load + square * (push.unit * np.conj(other)).real
        # b^2 - a*c with its factor taken out: without friction nothing is lost to rounding
        inside = np.abs(effect * other + load * push.unit) ** 2
        inside = inside - square * (push.unit * np.conj(other)).imag ** 2
        with np.errstate(divide="ignore", invalid="ignore"):
            force = (b + sense * circle * np.sqrt(np.maximum(inside, 0.0))) / a
        least = effect - np.maximum(sense, 0.0) * circle * size
        return force, least / np.abs(plain)

    def drag(self, force: Plane, friction: FrictionSpec) -> Array:
        """Return the moment of friction in the pivot, N mm (see `Support.drag`)."""
        return friction.circle * np.abs(force)

    def friction_of(
        self, force: Array, push: Push, total_load: TotalLoad, friction: FrictionSpec
    ) -> Array:
        """Return the moment of friction in the pivot, N mm (see `Support.friction_of`)."""
        pressed = self.drag(force * push.unit + total_load.resultant, friction)
        return pressed * np.abs(total_load.sense)

    def reactions(
        self,
        force: Array,
        push: Push,
        total_load: TotalLoad,
        friction: FrictionSpec,  # noqa: ARG002
    ) -> dict[str, Array]:
        """Return the force of the pivot and its components (see `Support.reactions`)."""
        reaction = -(force * push.unit + total_load.resultant)
        return {"pivot_n": np.abs(reaction), "pivot_x_n": reaction.real, "pivot_y_n": reaction.imag}
