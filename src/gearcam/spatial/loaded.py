"""A cam in space under load: how the line of contact carries the force, and what it exerts.

A roller and its wall touch along a line, its *line of contact*. The follower has one freedom, its
lift. Where the wall goes with the unit normal n, a small lift ds lets the roller approach it by
``c*ds``, c the component of its motion along -n. So of perfect, rigid parts whose surfaces yield in
proportion to the load at each place, the *line load*, N/mm, is in proportion to c, and the *normal
force* N is its sum. Several rollers of a turret share N by the same rule. Parts that are not
perfect share it less evenly.

On the follower acts, at each place, the line load along -n with the friction of the roller, from
its pin and from slip (`gearcam.spatial.slip`). The cam's torque is the moment of this force about
its axis, all work per unit of the cam angle as for plane cams (`gearcam.mechanics.statics`).

The pressure is that of two cylinders with the relative curvature of the line of contact
(`RollerContact.curvature`), at the place where it is largest.

Left out: how the pin bends under a line load that is not even.

Refused by the kinds: walls that are undercut. Depends on walls and mechanics; numpy only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.laws.program import Program
from gearcam.mechanics.follower_loads import DrivenMotion
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.statics import Touch
from gearcam.mechanics.supports import Push, Support
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.spatial.envelope import Roller, RollerContact, cross, dot
from gearcam.spatial.friction import SpaceFrictionSpec
from gearcam.spatial.guides import RollerGuide
from gearcam.spatial.slip import rubbed
from gearcam.spatial.supports import SpacePush


@dataclass(frozen=True, kw_only=True)
class RollerFollower(ShortRepr):
    """The follower of a cam in space, as far as loads depend on it.

    Parameters
    ----------
    guide : RollerGuide
        What carries its rollers.
    radius : float, mm
        Of a roller, in the middle of what presses.
    """

    guide: RollerGuide
    radius: float

    start: ClassVar[float] = 0.0
    """Positions are lifts."""

    @property
    def angular(self) -> bool:
        """Whether lifts are angles."""
        return self.guide.angular

    @property
    def load_unit(self) -> tuple[float, str, str]:
        """Factor from loads, N or N mm, to their unit in output, that unit, and its suffix."""
        return (1e-3, "N m", "nm") if self.angular else (1.0, "N", "n")

    @property
    def bend(self) -> float:
        """Curvature of its end, 1/mm."""
        return 1.0 / self.radius

    def held(self, friction: SpaceFrictionSpec, highest: float) -> Support:  # noqa: ARG002
        """Return what holds it, with sizes in `friction`; the `highest` lift does not matter."""
        return self.guide.support(friction)

    def mass_point(self, p: Array, distance: float) -> Plane:
        """Return a point in the plane of its motion at lifts p, by its distance from the pivot."""
        return self.guide.mass_point(p, distance)


@dataclass(frozen=True, kw_only=True)
class RollerMotion(ShortRepr):
    """The motion of a follower of a cam in space.

    Parameters
    ----------
    program : Program
        Its lift.
    follower : RollerFollower
        The follower.
    hand : float
        What quantities are multiplied with that change their sign in a mirror: -1 of a cam that
        turns clockwise.
    """

    program: Program
    follower: RollerFollower
    hand: float

    @property
    def clockwise(self) -> bool:
        """Whether the plane of the motion is seen in a mirror."""
        return self.hand < 0.0 and self.follower.guide.mirrored


_CELLS: Final = 8
"""Pairs of intervals along a line of contact; load and curvature hardly bend along it."""

ALONG: Final = 2 * _CELLS + 1
"""Number of places along a line of contact."""

_PLACES: Final = np.linspace(0.0, 1.0, ALONG)
"""Even places along it, both ends among them."""

_SIMPSON: Final = np.array([1.0, *([4.0, 2.0] * _CELLS)[:-1], 1.0]) / (6.0 * _CELLS)
"""Simpson's weights of the places."""


class ContactLine(NamedTuple):
    """Places along the lines of contact of one or several rollers, k of them at n cam angles.

    Attributes
    ----------
    contact : RollerContact
        The same places, those of each roller in a row: n by r rows.
    weights : (n, k) array, mm
        Length of the line that each place stands for; 0 where it is not on the cam.
    """

    contact: RollerContact
    weights: Array

    @classmethod
    def between(
        cls, low: Array, high: Array, rollers: int, contact: Callable[[Array], RollerContact]
    ) -> ContactLine:
        """Return the lines between two places on each roller, for Simpson's rule.

        Parameters
        ----------
        low, high : (n*rollers,) arrays, mm
            The places; the same where nothing is on the cam.
        rollers : int
            Number of rollers at each cam angle.
        contact : callable
            ``contact(x)`` returns the contact at places (n*rollers, k).
        """
        length = (high - low)[:, None]
        made = contact(low[:, None] + length * _PLACES)
        weights = length * _SIMPSON * made.stretch
        return cls(made, weights.reshape(len(low) // rollers, rollers * ALONG))

    def of(self, values: Array) -> Array:
        """Return values of the contact at each cam angle: (n*r, k/r, ...) as (n, k, ...)."""
        return values.reshape(*self.weights.shape, *values.shape[2:])


@dataclass(frozen=True, eq=False, kw_only=True)
class RollerTouch(Touch):
    """A wall of a cam in space as what presses on its follower (see `Touch`).

    Parameters
    ----------
    key : str
        Name of the wall.
    guide : RollerGuide
        What carries the rollers.
    roller : Roller
        Its shape.
    middle : float, mm
        The middle of what presses, along the roller.
    line : callable
        ``line(theta)`` returns the `ContactLine` at cam angles (n,), rad.
    above : bool
        Whether it presses against the direction of a rise.
    slip : float
        Coefficient of friction of the slip along a roller (see `gearcam.spatial.slip`).
    """

    key: str
    guide: RollerGuide
    roller: Roller
    middle: float
    line: Callable[[Array], ContactLine]
    above: bool
    slip: float = 0.0

    @property
    def radius(self) -> float:
        """Radius of the roller in the middle (see `Touch.radius`)."""
        return self.roller.radius_at(self.middle)

    @property
    def edges(self) -> Array:
        """It rides on no edge (see `Touch.edges`)."""
        return np.zeros(0)

    def _shares(
        self, line: ContactLine, support: Support, points: Array, normals: Array
    ) -> tuple[Array, Array]:
        """Return how the roller approaches the wall by the lift, and the line load, 1/mm, (n, k).

        The line load is that of a normal force of 1; `points` and `normals` are in the fixed frame.
        """
        in_plane = self.guide.in_plane
        near = support.lifting(in_plane(-normals), in_plane(points))
        near = np.where(line.weights > 0.0, near, 0.0)
        whole = (line.weights * near).sum(axis=1, keepdims=True)
        return near, near / whole

    def push(self, motion: DrivenMotion, support: Support, share: float) -> tuple[Push, Array]:
        """Return the force of the wall, and what its friction takes (see `Touch.push`)."""
        line = self.line(motion.x)
        contact = line.contact
        points, normals, tangents, generators = (
            _turned(line.of(one), motion.x)
            for one in (contact.points, contact.normals, contact.tangents, contact.generators)
        )
        near, density = self._shares(line, support, points, normals)
        part = line.weights * density
        moved = np.stack([-points[..., 1], points[..., 0], np.zeros(part.shape)], axis=-1)
        plane, ways = self.guide.in_plane(points), (tangents, generators)
        lifting = [support.lifting(self.guide.in_plane(one), plane) for one in ways]
        shape = contact.x.shape
        speeds = [
            (dot(moved, one) - by_lift * motion.ds[:, None]).reshape(shape)
            for one, by_lift in zip(ways, lifting, strict=True)
        ]
        friction = rubbed(
            part.reshape(shape), contact.radius, (speeds[0], speeds[1]), share, self.slip
        )
        around, along, lost = (line.of(one) for one in friction)
        each = around[..., None] * tangents + along[..., None] * generators - normals
        placed = self.guide.placed(motion.s)[0][0][:, None, :]
        force, moment = (
            (part[..., None] * one).sum(axis=1) for one in (each, cross(points - placed, each))
        )
        unit, middle = self.guide.in_plane(force), (part * plane).sum(axis=1)
        arms = np.conj(plane - middle[:, None]) * self.guide.in_plane(each)
        beside = (part * arms.imag).sum(axis=1) / np.abs(unit) ** 2
        push = SpacePush(
            at=middle - 1j * unit * beside,  # on the line of the whole force in the plane
            unit=unit,
            plain=(part * near).sum(axis=1),
            effect=(part * (near + around * lifting[0] + along * lifting[1])).sum(axis=1),
            arm=(part * dot(each, moved)).sum(axis=1),
            force=force,
            moment=moment,
        )
        return push, (part * lost).sum(axis=1)

    def radial(self, push: Any) -> Plane:
        """Return the force across the cam's axis for a normal force of 1 (see `Touch.radial`)."""
        return push.force[:, 0] + 1j * push.force[:, 1]

    def drag(self, force: Array, push: Any, friction: FrictionSpec) -> Array:
        """Return the friction of the cam's journals (see `Touch.drag`)."""
        return friction.circle * force * np.abs(self.radial(push))

    def reactions(self, force: Array, push: Any) -> dict[str, Array]:
        """Return the thrust of the cam on its bearing (see `Touch.reactions`)."""
        return {"bearing_thrust_n": force * push.force[:, 2]}

    def pressed(self, x: Array) -> tuple[Array, Array, Array]:
        """Return places, line loads of a normal force of 1, and relative curvatures.

        Parameters
        ----------
        x : (n,) array, rad
            Cam angles.

        Returns
        -------
        place, density, curvature : (n, k) arrays, mm, 1/mm and 1/mm
            The line load is 0 where a place is not on the cam.
        """
        line = self.line(x)
        contact = line.contact
        points, normals = (_turned(line.of(one), x) for one in (contact.points, contact.normals))
        _, density = self._shares(line, self._support, points, normals)
        return line.of(contact.x), density, line.of(contact.curvature(self.roller))

    def rollers(self, x: Array) -> Ints:
        """Return how many rollers press at cam angles (n,), rad."""
        line = self.line(x)
        by_roller = line.weights.reshape(len(x), line.weights.shape[1] // ALONG, ALONG)
        return (by_roller > 0.0).any(axis=2).sum(axis=1)

    @cached_property
    def _support(self) -> Support:
        return self.guide.support(SpaceFrictionSpec())

    def contact(self, x: Array) -> tuple[Array, Array]:
        """Return relative curvature and width where the pressure is largest (see `Touch`)."""
        _, density, curvature = self.pressed(x)
        worst = np.argmax(np.where(density > 0.0, density * curvature, -1.0), axis=1)
        rows = np.arange(len(x))
        return curvature[rows, worst], 1.0 / density[rows, worst]


def _turned(vectors: Array, turn: Array) -> Array:
    """Return vectors (n, k, 3) of the cam's frame in the fixed one, at cam angles (n,)."""
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x, y, z = np.moveaxis(vectors, -1, 0)
    return np.stack([c * x - s * y, s * x + c * y, z], axis=-1)
