"""Forces in the joints of a linkage: the equilibrium of every member.

At each angle of the driver the loads, weights, springs and inertia forces of each member are in
equilibrium with what its joints and its drive exert: two equations of forces and one of moments.
A crank has two unknowns of its bearing and its shaft's moment, a dyad with two members six in its
three joints, so that all are known; the equations of all members are solved together.

The moment that the drives exert then, over the turn of the driver, is found a second time by
virtual work (see `gearcam.linkages.work`), without any reaction: the difference is an error
estimate of both.

Contacts (see `gearcam.linkages.contacts`) load the bearings and guides of what they drive and of
what drives them, in proportion to the drives' moments and forces, on one flank or wall or the
other.

Friction (see `gearcam.linkages.friction`) depends on the reactions: Newton's method solves for all
of them. Where the determinant of its last step has another sign than without friction, the machine
is locked: no moment of the driver moves it.

Sources: 000, sections 2.2.2 to 2.2.4.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.bonds import FORCES, Bond, Hinge, SlidingJoint, Wrench
from gearcam.linkages.contacts import DriveContact
from gearcam.linkages.coordinates import HeldMembers, WorkCoordinate, WorkState
from gearcam.linkages.efforts import Effort
from gearcam.linkages.elements import Carriers
from gearcam.linkages.friction import Friction
from gearcam.linkages.known import GROUND, Known
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.work import displaced_by
from gearcam.numeric.arrays import Array, Mask, Plane

_STEPS: Final = 30
"""Largest number of Newton steps with friction: five are usual."""

_SETTLED: Final = 1e-8
"""Change of the reactions in a step, over the largest, at which they are known: the error falls
with its square."""

_ROUNDING: Final = 1e-9
"""Share of the largest force that is none: what carries nothing has no friction."""

_SINGULAR: Final = 1e-6
"""Determinant, over that without friction, that is none: the forces would be a million times as
large, and lose as many digits."""

_SHARES: Final = (0.25, 0.5, 0.75, 1.0)
"""Shares of the friction on the way to all of it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Structure(ShortRepr):
    """What a linkage is made of: its members and what joins them.

    Parameters
    ----------
    carriers : mapping of str to str
        Members by what is fixed to them.
    bonds : tuple of Bond
        Joints and drives.
    """

    carriers: Carriers
    bonds: tuple[Bond, ...]

    @classmethod
    def of(cls, linkage: Linkage) -> Structure:
        """Return that of a linkage."""
        carriers: dict[str, str] = {GROUND: GROUND}
        bonds: list[Bond] = []
        for element in linkage.elements:
            carriers |= element.carried(carriers)
            bonds += element.bonds(carriers)
        return cls(carriers=carriers, bonds=tuple(bonds))

    @cached_property
    def members(self) -> tuple[str, ...]:
        """Names of the members that move."""
        return tuple(dict.fromkeys(one.on for one in self.bonds))

    @cached_property
    def by_member(self) -> dict[str, tuple[Bond, ...]]:
        """What joins and drives each member, its joint to the one before first."""
        return {name: tuple(one for one in self.bonds if one.on == name) for name in self.members}

    @cached_property
    def slides(self) -> dict[str, SlidingJoint]:
        """Guides by the quantities that are places on them."""
        return {one.slide: one for one in self.bonds if isinstance(one, SlidingJoint)}

    @cached_property
    def joints(self) -> tuple[Hinge | SlidingJoint, ...]:
        """Hinges and guides."""
        return tuple(one for one in self.bonds if isinstance(one, Hinge | SlidingJoint))

    def held(self, known: Known) -> HeldMembers:
        """Return the members at what is `known`, for forces on them."""
        return HeldMembers(known, self.carriers, self.slides)

    @cached_property
    def _forces(self) -> Mask:
        """Which unknowns are forces."""
        return np.array([name in FORCES for one in self.bonds for name in one.unknowns])

    def carried(self, bond: Bond, values: Array, size: float) -> Array:
        """Return the unknowns of a bond without rounding, whose sign would be chance.

        Parameters
        ----------
        bond : Bond
            One of the bonds.
        values : (n, u) array, N and N mm
            All unknowns.
        size : float, mm
            Of the linkage, with which moments are compared.

        Returns
        -------
        (n, k) array
            0 where it is less than rounding of the largest force.
        """
        own = values[:, self.columns[bond]]
        least = _ROUNDING * np.abs(values[:, self._forces]).max(axis=1, initial=0.0)
        sizes = [1.0 if one in FORCES else size for one in bond.unknowns]
        return np.where(np.abs(own) > least[:, None] * sizes, own, 0.0)

    @cached_property
    def columns(self) -> dict[Bond, slice]:
        """Which unknowns are those of each bond."""
        ends = np.cumsum([0, *(len(one.unknowns) for one in self.bonds)]).tolist()
        return {one: slice(*ends[k : k + 2]) for k, one in enumerate(self.bonds)}


@dataclass(frozen=True, eq=False, kw_only=True)
class Reactions(ShortRepr):
    """Forces in the joints of a linkage at n angles of the driver.

    Parameters
    ----------
    structure : Structure
        Members and bonds.
    known : Known
        The motion.
    values : (n, u) array, N and N mm
        The unknowns of all bonds; nan where friction locks.
    size : float, mm
        Of the linkage.
    moment : (n,) array, N mm
        The driver's moment, from what its drives exert.
    work : (n,) array, N mm
        The same without friction, by virtual work.
    lost : (n,) array, N mm
        Work lost to friction per rad of the driver.
    room : (n,) array
        Determinant of the equilibrium with friction over that without: 1 without friction, 0 where
        the machine is locked.
    contacts : dict of str to (n,) array, N
        Normal forces of contacts by their names (see `LineOfAction`).
    """

    structure: Structure
    known: Known
    values: Array
    size: float
    moment: Array
    work: Array
    lost: Array
    room: Array
    contacts: dict[str, Array]

    def of(self, bond: Bond) -> Array:
        """Return the unknowns of a bond, (n, k)."""
        return self.values[:, self.structure.columns[bond]]

    def carried(self, bond: Bond) -> Array:
        """Return them without rounding."""
        return self.structure.carried(bond, self.values, self.size)

    def force(self, bond: Bond) -> Plane:
        """Return the force of a bond on its member, (n,), N, in the machine's frame."""
        units, own = bond.units(self.known), self.of(bond).T
        parts = [unit.force * one for unit, one in zip(units, own, strict=True)]
        return np.sum(parts, axis=0)

    @property
    def locked(self) -> Mask:
        """Where friction locks the machine, (n,)."""
        return self.room == 0.0

    @property
    def apart(self) -> float:
        """Largest difference of the driver's moment from virtual work and losses, over the largest.

        An error estimate of all forces.
        """
        free = ~self.locked
        off = np.abs(self.moment - self.work - self.lost)[free]
        most = np.abs(np.stack([self.moment, self.work, self.lost]))[:, free].max(initial=0.0)
        return float(off.max(initial=0.0) / most) if most else 0.0


class UnheldError(ValueError):
    """A linkage in which some forces are not known.

    Parameters
    ----------
    name : str
        Of a member or joint on which a force acts, but which nothing holds.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(name)


def reactions(
    linkage: Linkage,
    efforts: Sequence[Effort],
    q: Array,
    *,
    speed: float | None = None,
    friction: Mapping[Bond, Friction[Any]] | None = None,
    contacts: Sequence[DriveContact] = (),
) -> Reactions:
    """Return the forces in the joints of a linkage.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    efforts : sequence of Effort
        What acts on it.
    q : (n,) array, rad
        The driver's angles.
    speed : float, rad/s, optional
        Of the driver.
    friction : mapping of Bond to Friction, optional
        Of hinges and guides.
    contacts : sequence of DriveContact
        What drives its shafts and slides; without any, drives exert pure moments, and forces along
        guides.

    Returns
    -------
    Reactions

    Raises
    ------
    UnheldError
        If a force acts on what no member carries, as a point of another package's part.
    """
    structure = Structure.of(linkage)
    state = WorkState(linkage, np.asarray(q, dtype=float), 0, speed)
    held = structure.held(state.known)
    equilibrium = _Equilibrium(structure, state.known)
    loads, unheld = equilibrium.loads(efforts, state, held)
    pairs = [(one, own) for one, own in (friction or {}).items() if one in structure.columns]
    pressing = [equilibrium.pressing(one, linkage, state, unheld) for one in contacts]
    values, room, lost = equilibrium.rubbing(equilibrium.solved(loads), loads, pairs, pressing)
    balances = [np.asarray(one.balance(state).c[0]) for one in efforts]
    return Reactions(
        structure=structure,
        known=state.known,
        values=values,
        size=equilibrium.size,
        moment=_Driving.of(structure, state.known, unheld).exerted(values),
        work=sum(balances, start=np.zeros(state.q.shape)),
        lost=lost,
        room=room,
        contacts={
            one.name: each.normal(values) for one, each in zip(contacts, pressing, strict=True)
        },
    )


Unheld = Sequence[tuple[WorkCoordinate, Array]]
"""Forces that act on drives, not on members, and what they do work on."""


_Pairs = Sequence[tuple[Bond, Friction[Any]]]
"""Joints with their friction."""


class _Driving(NamedTuple):
    """What the drives exert together in a displacement: linear in the unknowns.

    Attributes
    ----------
    works : (n, u) array
        Work of a unit of each unknown.
    loads : (n,) array
        Work of what acts on the drives.
    """

    works: Array
    loads: Array

    @classmethod
    def of(cls, structure: Structure, displaced: Known, unheld: Unheld) -> _Driving:
        """Return that of a displacement."""
        works = [one for bond in structure.bonds for one in bond.works(displaced)]
        loads = [np.asarray(on.rate(displaced, 0).c[0]) * force for on, force in unheld]
        return cls(np.stack(works, axis=1), sum(loads, start=np.zeros(displaced.q.shape)))

    def exerted(self, values: Array) -> Array:
        """Return it with the unknowns `values`, (n, u)."""
        return (values * self.works).sum(axis=1) - self.loads


class _Pressing(NamedTuple):
    """A contact in the equations.

    Attributes
    ----------
    driving : _Driving
        What it exerts.
    columns : (2, n, r) array
        What a unit of that does in each equation, with either sign: -1 and +1.
    normals : (2, n) array
        Its normal force.
    """

    driving: _Driving
    columns: Array
    normals: Array

    def column(self, exerted: Array) -> Array:
        """Return the column of the flank or wall that carries, (n, r)."""
        back, forth = self.columns
        return np.where(exerted[:, None] < 0.0, back, forth)

    def normal(self, values: Array) -> Array:
        """Return the normal force, (n,), N, with the unknowns `values`."""
        exerted = self.driving.exerted(values)
        return exerted * np.where(exerted < 0.0, *self.normals)


class _Equilibrium:
    """The equations of all members: three rows each, a column for each unknown.

    Moments are over a length, so that all numbers are of the size of forces.
    """

    def __init__(self, structure: Structure, known: Known) -> None:
        self.structure, self.known = structure, known
        self.rows = {name: 3 * k for k, name in enumerate(structure.members)}
        count = sum(len(one.unknowns) for one in structure.bonds)
        if count != 3 * len(self.rows):
            raise UnheldError(structure.members[-1])
        places = [np.abs(known.place(name)).max() for name in structure.members]
        self.size = float(np.max([1.0, *places]))
        self.matrix = np.zeros((len(known.q), count, count))
        for bond, columns in structure.columns.items():
            for k, unit in enumerate(bond.units(known), start=columns.start):
                self._add(self.matrix[:, :, k], bond, unit)

    def _put(self, rows: Array, member: str, wrench: Wrench) -> None:
        """Add a wrench on a member to its `rows`, (n, r); what holds the frame is not told."""
        if member == GROUND:
            return
        row = self.rows[member]
        rows[:, row] += wrench.force.real
        rows[:, row + 1] += wrench.force.imag
        rows[:, row + 2] += wrench.moment / self.size

    def _add(self, rows: Array, bond: Bond, wrench: Wrench) -> None:
        self._put(rows, bond.on, wrench)
        self._put(rows, bond.by, wrench.times(np.array(-1.0)))

    def loads(
        self, efforts: Sequence[Effort], state: WorkState, held: HeldMembers
    ) -> tuple[Array, Unheld]:
        """Return what acts on the members, (n, r), and what acts on drives."""
        found, unheld = np.zeros(self.matrix.shape[:2]), list[tuple[WorkCoordinate, Array]]()
        for effort in efforts:
            force = effort.acting(state)
            parts = list(effort.coordinate.wrenches(held, force))
            for member, wrench in parts:
                self._put(found, member, wrench)
            if not parts:
                unheld.append((effort.coordinate, force.real))
        return found, unheld

    def pressing(
        self, contact: DriveContact, linkage: Linkage, state: WorkState, unheld: Unheld
    ) -> _Pressing:
        """Return a contact in the equations."""
        displaced = displaced_by(linkage, {contact.driven.name: contact.sense})
        driving = _Driving.of(self.structure, displaced.at(state.q, 1), unheld)
        lines = contact.lines(state.q)
        columns = np.zeros((2, *self.matrix.shape[:2]))
        for column, line in zip(columns, lines, strict=True):
            for member, wrench in contact.wrenches(self.structure.by_member, self.known, line):
                self._put(column, member, wrench)
        return _Pressing(driving, columns, np.stack([line.normal for line in lines]))

    def solved(self, loads: Array) -> Array:
        """Return the unknowns without friction, (n, u)."""
        return np.asarray(np.linalg.solve(self.matrix, -loads[..., None])[..., 0], dtype=float)

    def rubbing(
        self, free: Array, loads: Array, pairs: _Pairs, pressing: Sequence[_Pressing]
    ) -> tuple[Array, Array, Array]:
        """Return the unknowns with friction, what is left of the determinant, and the work lost.

        From none to all of the friction: where the determinant comes to 0 on the way, or no forces
        are found, it locks.
        """
        values, room, lost = free, np.ones(len(free)), np.zeros(len(free))
        for one in pressing:  # what the drives exert is the same without it
            exerted = one.driving.exerted(free)
            values = values + self.solved(one.column(exerted) * exerted[:, None])
        finite = np.isfinite(values).all(axis=1)
        for share in _SHARES if pairs else ():
            some = [(bond, one.times(share)) for bond, one in pairs]
            values, left, lost = self._settled(values, loads, some, pressing)
            room = np.where(room > 0.0, left, 0.0)
        room = np.where(finite, room, 1.0)  # what has no finite forces is not locked
        return np.where(room[:, None] > 0.0, values, np.nan), room, lost

    def _settled(
        self, values: Array, loads: Array, pairs: _Pairs, pressing: Sequence[_Pressing]
    ) -> tuple[Array, Array, Array]:
        """Return unknowns, determinant (0 where they are not found) and work by Newton's method."""
        plain, whole = np.linalg.slogdet(self.matrix)
        settled, room, lost = np.zeros(len(loads), dtype=bool), np.ones(len(loads)), loads[:, 0]
        for _ in range(_STEPS):
            tangent, rest, lost = self.matrix.copy(), loads.copy(), np.zeros(len(loads))
            for bond, one in pairs:
                own = self.structure.columns[bond]
                found = one.of(bond, self.known, self.structure.carried(bond, values, self.size))
                column = np.zeros(loads.shape)
                self._add(column, bond, found.unit)
                rest += column * found.size[:, None]
                tangent[:, :, own] += column[:, :, None] * found.slopes[:, None, :]
                lost += found.lost
            for each in pressing:
                exerted = each.driving.exerted(values)
                column = each.column(exerted)
                rest += column * exerted[:, None]
                tangent += column[:, :, None] * each.driving.works[:, None, :]
            sign, size = np.linalg.slogdet(tangent)
            room = sign * plain * np.exp(size - whole)
            singular = np.abs(room) < _SINGULAR
            tangent[singular] = self.matrix[singular]
            residual = (self.matrix @ values[..., None])[..., 0] + rest
            step = np.linalg.solve(tangent, -residual[..., None])[..., 0]
            step[settled | singular] = 0.0
            values = values + step
            near = np.abs(step).max(axis=1) <= _SETTLED * np.abs(values).max(axis=1)
            settled |= near & ~singular
            if settled.all():
                break
        return values, np.where(settled & (room > _SINGULAR), room, 0.0), lost
