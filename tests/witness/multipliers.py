"""Forces in the joints of a linkage by Lagrange's multipliers, from positions of its members alone.

Each member has three coordinates, each joint constraints between them. All are solved at once::

    M*a = Q + J^T*lambda

J is found by differences of the constraints, a by differences of positions over the driver's angle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

_APART = np.array([-2, -1, 0, 1, 2])
_SECOND = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / 12.0
"""The second derivative from five values, with an error of fourth order."""

_STEP = 2e-3
"""Between them, rad."""


@dataclass(frozen=True)
class Lumped:
    """A mass at a point of a member, a moment of inertia, and a force there."""

    member: str
    point: str
    mass: float
    inertia: float
    force: complex


@dataclass(frozen=True)
class Joined:
    """A joint or a shaft: its sort, name, members, and the frame of its guide, or its place."""

    sort: str
    name: str
    on: str
    by: str
    more: str = ""


_BLOCK = {"RTR1": 1, "RTR2": 0, "RTT": 0, "TTR": 1, "RRT": 1}
"""Which member has the middle joint, where it is not the first one."""


def _joined(linkage: Any) -> list[Joined]:
    """What joins the members."""
    own, found = {"ground": "ground"}, list[Joined]()
    for one in linkage.elements:
        if type(one).__name__ in ("MemberPoint", "GuideLine"):
            own[one.name] = own[one.on]
        elif type(one).__name__ == "Crank":
            own |= {one.name: one.name, one.joint: one.name}
            found.append(Joined("hinge", one.center, one.name, own[one.center], one.center))
            found.append(Joined("turn", one.shaft, one.name, own[one.center]))
        elif type(one).__name__ == "Dyad":
            members, block = one.members, 1 if one.driven else _BLOCK.get(one.type, 0)
            own |= {name: name for name in members} | {one.joint: members[block]}
            for member, end, letter in zip(
                members, (one.first, one.second), one.type[::2], strict=False
            ):
                found.append(
                    Joined("hinge" if letter == "R" else "slide", end, member, own[end], end)
                )
            if one.type[1] == "R":
                found.append(Joined("hinge", one.joint, members[1], members[0], one.joint))
            else:
                guide = members[1 - block]
                found.append(Joined("slide", one.joint, members[block], guide, guide))
    return found


Places = dict[str, Any]
"""Coordinates of members: x, y and angle."""


class _Positions:
    """Where the members are at an angle of the driver, and beside it."""

    def __init__(self, linkage: Any, q: float, members: list[str]) -> None:
        self.known = linkage.at(q + _STEP * _APART, 0)
        self.frames: Places = {"ground": np.zeros(3)}
        for name in members:
            at = self.place(name)
            self.frames[name] = np.array([at.real, at.imag, np.angle(self.way(name))])

    def place(self, name: str) -> complex:
        return complex(self.known.place(name)[2])

    def way(self, name: str) -> complex:
        return complex(self.known.direction(name)[2])

    def fixed(self, member: str, point: complex) -> Callable[[Places], complex]:
        """A point of a member, wherever this is."""
        x, y, turn = self.frames[member]
        inside = (point - complex(x, y)) * np.exp(-1j * turn)
        return lambda now: complex(*now[member][:2]) + inside * np.exp(1j * now[member][2])

    def constraint(self, one: Joined) -> Callable[[Places], list[float]]:
        """What is 0."""
        rest = self.frames[one.on][2] - self.frames[one.by][2]

        def turned(now: Places) -> float:
            return float(now[one.on][2] - now[one.by][2] - rest)

        if one.sort == "turn":
            return lambda now: [turned(now)]
        if one.sort == "hinge":
            point = self.place(one.more)
            mine, other = self.fixed(one.on, point), self.fixed(one.by, point)
            return lambda now: [(mine(now) - other(now)).real, (mine(now) - other(now)).imag]
        point = self.place(one.on if one.more == one.name else one.name)
        mine, foot = self.fixed(one.on, point), self.fixed(one.by, point)
        across = 1j * self.way(one.more) * np.exp(-1j * self.frames[one.by][2])

        def off(now: Places) -> float:
            normal = across * np.exp(1j * now[one.by][2])
            return float((np.conj(normal) * (mine(now) - foot(now))).real)

        return lambda now: [off(now), turned(now)]

    def applied(self, one: Lumped, speed: float) -> tuple[complex, float]:
        """Force and moment about the member's origin, inertia among them."""
        turns = np.unwrap(np.angle(self.known.direction(one.member)))
        spin = float(turns @ _SECOND) / _STEP**2 * speed**2
        moved = complex(self.known.place(one.point) @ _SECOND) / _STEP**2 * speed**2
        force = one.force - 1e-3 * one.mass * moved
        arm = self.place(one.point) - self.place(one.member)
        return force, float((np.conj(arm) * force).imag - 1e3 * one.inertia * spin)


def multipliers(
    linkage: Any, lumped: list[Lumped], q: float, speed: float
) -> dict[tuple[str, str], Any]:
    """Multipliers of each joint by its name and member: force x and y, or across and couple."""
    joints = _joined(linkage)
    members = list(dict.fromkeys(one.on for one in joints))
    there = _Positions(linkage, q, members)
    constraints = [there.constraint(one) for one in joints]

    def missed(flat: Any) -> Any:
        now = {name: flat[3 * k : 3 * k + 3] for k, name in enumerate(members)}
        return np.concatenate([one(now | {"ground": np.zeros(3)}) for one in constraints])

    start = np.concatenate([there.frames[name] for name in members])
    steps = np.diag(np.tile([1e-3, 1e-3, 1e-5], len(members)))
    slopes = [(missed(start + e) - missed(start - e)) / (2.0 * e.max()) for e in steps]
    loads = np.zeros(3 * len(members))
    for one in lumped:
        force, moment = there.applied(one, speed)
        first = 3 * members.index(one.member)
        loads[first : first + 3] += [force.real, force.imag, moment]
    solved = np.linalg.solve(np.stack(slopes), -loads)
    sizes = [1 if one.sort == "turn" else 2 for one in joints]
    parts = np.split(solved, np.cumsum(sizes)[:-1])
    return {(one.name, one.on): part for one, part in zip(joints, parts, strict=True)}
