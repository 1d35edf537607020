"""Dyads by their loop equations, solved by Newton iteration from a guess.

Nothing here knows a closed form: a loop runs from the first end of a dyad over both members to the
second one, two unknowns close it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcam.linkages.elements import Dyad
from gearcam.linkages.known import Known
from gearcam.numeric.arrays import Array
from helpers_random_linkages import lengths_of, line, place

Unknowns = Array
"""(2, n): for each member the angle in rad, or the place of its slide in units of 100 mm."""

_LONG = 100.0
"""mm."""


@dataclass(frozen=True)
class Loop:
    """The loop of a dyad, at the angles of the driver at which all before it is known."""

    dyad: Dyad
    known: Known

    @property
    def ends(self) -> tuple[Any, Any]:
        """Joints as complex numbers, guides as origins and directions."""
        names = self.dyad.first, self.dyad.second
        return tuple(
            (line if guided else place)(self.known, name)
            for name, guided in zip(names, self.dyad.kind.guides, strict=True)
        )  # pyright: ignore[reportReturnType]

    def gap(self, x: Unknowns) -> Array:
        """What the loop misses, mm."""
        one, two = _MEMBERS[self.dyad.type](self, *x)
        return one - two

    def step(self, x: Unknowns) -> Unknowns:
        """The step of a Newton iteration."""
        small, gap = 1e-6, self.gap(x)
        slopes = [
            (self.gap(x + dx) - self.gap(x - dx)) / (2.0 * small)
            for dx in (np.array([[small], [0.0]]), np.array([[0.0], [small]]))
        ]
        area = np.imag(slopes[0].conj() * slopes[1])
        return -np.array(
            [np.imag(gap.conj() * slopes[1]) / area, np.imag(slopes[0].conj() * gap) / area]
        )

    def solved(self, guess: Unknowns) -> Unknowns:
        """The solution next to a guess."""
        x = guess
        for _ in range(30):
            x = x + self.step(x)
        return x

    def joint(self, x: Unknowns) -> Array:
        """The middle joint."""
        return _MEMBERS[self.dyad.type](self, *x)[0]

    def found(self) -> Unknowns:
        """What the package found."""
        made = []
        for number, kind in enumerate(_UNKNOWNS[self.dyad.type]):
            if kind == "angle":
                made.append(np.angle(line(self.known, self.dyad.members[number])[1]))
            else:
                made.append(np.real(place(self.known, f"{self.dyad.joint}.{kind}")) / _LONG)
        return np.array(made)

    def mirrored(self) -> Unknowns:
        """What the package found, with the triangle that has the sign turned over."""
        x, dyad, (one, two) = self.found(), self.dyad, self.ends
        joint, (first, second) = place(self.known, dyad.joint), lengths_of(dyad, self.known)
        if dyad.type == "RRR":
            return 2.0 * np.angle(two - one) - x
        if dyad.type in ("RRT", "TRR"):
            rod, guide = (0, two) if dyad.type == "RRT" else (1, one)
            begin = one if rod == 0 else two
            ahead = np.real((joint - begin) * guide[1].conj())
            other = x.copy()
            other[rod] = 2.0 * np.angle(guide[1]) + np.pi - x[rod]
            other[1 - rod] = x[1 - rod] - 2.0 * ahead / _LONG
            return other
        if dyad.type == "RTR1":
            way, arm, turn, slide = two - one, second, dyad.lengths.beta, x[0]
        else:
            way, arm, turn, slide = one - two, first, -dyad.lengths.beta, x[1]
        slide = 2.0 * arm * np.cos(turn) / _LONG - slide
        angle = np.angle(way / (slide * _LONG - arm * np.exp(1j * turn)))
        return np.array([slide, angle + turn] if dyad.type == "RTR1" else [angle + turn, slide])


def _rrr(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    (one, two), (first, second) = loop.ends, lengths_of(loop.dyad, loop.known)
    return one + first * np.exp(1j * a), two + second * np.exp(1j * b)


def _rrt(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    one, (origin, way) = loop.ends
    arm = loop.dyad.lengths.second * np.exp(1j * loop.dyad.lengths.gamma2)
    return one + loop.dyad.lengths.first * np.exp(1j * a), origin + way * (b * _LONG + arm)


def _trr(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    (origin, way), two = loop.ends
    arm = loop.dyad.lengths.first * np.exp(1j * loop.dyad.lengths.gamma1)
    return origin + way * (a * _LONG + arm), two + loop.dyad.lengths.second * np.exp(1j * b)


def _rtr1(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    (one, two), sizes = loop.ends, loop.dyad.lengths
    return one + a * _LONG * np.exp(1j * (b - sizes.beta)), two + sizes.second * np.exp(1j * b)


def _rtr2(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    (one, two), sizes = loop.ends, loop.dyad.lengths
    return one + sizes.first * np.exp(1j * a), two + b * _LONG * np.exp(1j * (a + sizes.beta))


def _trt(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    (one, two), sizes = loop.ends, loop.dyad.lengths
    first = sizes.first * np.exp(1j * sizes.gamma1)
    second = sizes.second * np.exp(1j * sizes.gamma2)
    return one[0] + one[1] * (a * _LONG + first), two[0] + two[1] * (b * _LONG + second)


def _rtt(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    one, (origin, way) = loop.ends
    sizes = loop.dyad.lengths
    turn = way * np.exp(1j * sizes.gamma2)
    first = sizes.first * turn * np.exp(-1j * sizes.beta)
    return one + first, origin + way * (a * _LONG) + turn * (b * _LONG)


def _ttr(loop: Loop, a: Array, b: Array) -> tuple[Array, Array]:
    (origin, way), two = loop.ends
    sizes = loop.dyad.lengths
    turn = way * np.exp(1j * sizes.gamma1)
    second = sizes.second * turn * np.exp(1j * sizes.beta)
    return origin + way * (a * _LONG) + turn * (b * _LONG), two + second


_MEMBERS: dict[str, Callable[[Loop, Array, Array], tuple[Array, Array]]] = {
    "RRR": _rrr,
    "RRT": _rrt,
    "TRR": _trr,
    "RTR1": _rtr1,
    "RTR2": _rtr2,
    "TRT": _trt,
    "RTT": _rtt,
    "TTR": _ttr,
}
"""Both ways from an end of the loop to its middle joint."""

_UNKNOWNS: dict[str, tuple[str, str]] = {
    "RRR": ("angle", "angle"),
    "RRT": ("angle", "guide2"),
    "TRR": ("guide1", "angle"),
    "RTR1": ("member1", "angle"),
    "RTR2": ("angle", "member2"),
    "TRT": ("guide1", "guide2"),
    "RTT": ("guide2", "member2"),
    "TTR": ("guide1", "member1"),
}
"""What is unknown: an angle is that of the first or the second member."""
