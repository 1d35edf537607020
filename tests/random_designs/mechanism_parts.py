"""Where the joints of a random mechanism are, roughly: enough to choose sizes that close.

Shafts turn evenly here, whatever their law: what a dyad reaches does not depend on when. Dyads are
solved by triangles and projections of single positions, without the package.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Final

TURN: Final = 2.0 * math.pi

ALONG: Final = 1 + 0j

NOTHING: Final[frozenset[str]] = frozenset()


@dataclass(frozen=True)
class Joint:
    """A joint at some angles of the master.

    Parameters
    ----------
    at : list of complex, mm
        Its places.
    roots : frozenset of str
        The shafts and slides that move it.
    """

    at: list[complex]
    roots: frozenset[str] = NOTHING

    @property
    def middle(self) -> complex:
        """The middle of its places."""
        return sum(self.at) / len(self.at)

    @property
    def reach(self) -> float:
        """How far it gets from there, mm."""
        return max(abs(one - self.middle) for one in self.at)


@dataclass(frozen=True)
class Line:
    """A guide or a member at some angles of the master.

    Parameters
    ----------
    at, along : list of complex
        Its origins, mm, and its directions.
    roots : frozenset of str
        The shafts and slides that move it.
    """

    at: list[complex]
    along: list[complex]
    roots: frozenset[str] = NOTHING

    def point(self, at: complex) -> Joint:
        """Return a point of it, in its frame."""
        places = [one + at * way for one, way in zip(self.at, self.along, strict=True)]
        return Joint(places, self.roots)

    def turned(self, at: complex, angle: float) -> Line:
        """Return a guide on it."""
        along = [way * cmath.exp(1j * angle) for way in self.along]
        return Line(self.point(at).at, along, self.roots)

    @property
    def still(self) -> bool:
        """Whether it keeps its direction, within some degrees."""
        return all(abs(way - self.along[0]) < 0.3 for way in self.along)

    @property
    def swing(self) -> float:
        """Difference of its largest and its least direction, rad; a turn if it comes round."""
        steps = [cmath.phase(b / a) for a, b in zip(self.along, self.along[1:], strict=False)]
        sums = [sum(steps[:k]) for k in range(len(steps) + 1)]
        return min(TURN, max(sums) - min(sums))


def together(first: Joint | Line, last: Joint | Line) -> list[tuple[int, int]]:
    """Return which positions of two may occur together: all, if different shafts move them."""
    count = len(first.at)
    if first.roots and last.roots and (first.roots != last.roots or len(first.roots) > 1):
        return [*product(range(count), range(count))]
    return [(k, k) for k in range(count)]


def distances(first: Joint, last: Joint) -> tuple[float, float]:
    """Return the least and the largest distance of two joints, mm."""
    found = [abs(first.at[i] - last.at[k]) for i, k in together(first, last)]
    return min(found), max(found)


def off(joint: Joint, line: Line, arm: complex = 0j) -> float:
    """Return how far a joint gets from a line that stands `arm` off a guide, mm."""
    found = [
        ((line.at[k] - joint.at[i]) / line.along[k] + arm).imag for i, k in together(joint, line)
    ]
    return max(map(abs, found))


def crossing(first: Line, last: Line) -> float:
    """Return the least sine of the angle between two guides."""
    return min(abs((last.along[k] / first.along[i]).imag) for i, k in together(first, last))


Sizes = dict[str, Any]
"""What a dyad has: lengths, angles in rad, and a sign."""

Found = tuple[complex, complex, complex, complex, complex]
"""The joint; origin and direction of member 1; origin and direction of member 2."""


def _unit(way: complex) -> complex:
    return way / abs(way) if way else ALONG


def _rrr(a: Any, b: Any, s: Sizes) -> Found:
    one, two = s["lengths"]
    way = b[0] - a[0]
    square = abs(way) ** 2 or 1e-12
    along = (one * one - two * two + square) / (2.0 * square)
    height = math.sqrt(max(0.0, one * one / square - along * along))
    joint = a[0] + way * complex(along, s["sign"] * height)
    return joint, a[0], _unit(joint - a[0]), b[0], _unit(joint - b[0])


def _rrt(a: Any, b: Any, s: Sizes) -> Found:
    (rod, arm), turn = s["lengths"], cmath.exp(1j * s["gammas"][1])
    place = (b[0] - a[0]) / b[1] + arm * turn
    reach = s["sign"] * math.sqrt(max(0.0, rod * rod - place.imag**2))
    joint = a[0] + b[1] * complex(reach, place.imag)
    return joint, a[0], _unit(joint - a[0]), joint - arm * turn * b[1], b[1] * turn


def _rtr(a: Any, b: Any, s: Sizes) -> Found:
    arm, beta = s["lengths"][1], s["beta"]
    way, across = b[0] - a[0], arm * math.sin(beta)
    reach = s["sign"] * math.sqrt(max(1e-12, abs(way) ** 2 - across**2))
    guide = _unit(way / complex(reach, -across))
    joint = a[0] + guide * (reach + arm * math.cos(beta))
    return joint, a[0], guide, b[0], guide * cmath.exp(1j * beta)


def _trt(a: Any, b: Any, s: Sizes) -> Found:
    one, two = (
        way[1] * cmath.exp(1j * gamma) for way, gamma in zip((a, b), s["gammas"], strict=True)
    )
    way = b[0] - a[0] + two * s["lengths"][1] - one * s["lengths"][0]
    foot = a[0] + a[1] * (way / b[1]).imag / ((a[1] / b[1]).imag or 1e-12)
    joint = foot + one * s["lengths"][0]
    return joint, foot, one, joint - two * s["lengths"][1], two


def _rtt(a: Any, b: Any, s: Sizes) -> Found:
    turn = cmath.exp(1j * s["gammas"][1])
    second = b[1] * turn
    one = second * cmath.exp(-1j * s["beta"])
    joint = a[0] + one * s["lengths"][0]
    place = (joint - b[0]) / b[1]
    foot = b[0] + b[1] * (place.real - place.imag * turn.real / turn.imag)
    return joint, a[0], one, foot, second


def _exchanged(solve: Callable[[Any, Any, Sizes], Found]) -> Callable[[Any, Any, Sizes], Found]:
    def other(a: Any, b: Any, s: Sizes) -> Found:
        turned = {"lengths": s["lengths"][::-1], "gammas": s["gammas"][::-1]}
        joint, *ends = solve(b, a, s | turned | {"beta": -s["beta"]})
        return joint, *ends[2:], *ends[:2]  # pyright: ignore[reportReturnType]

    return other


_SOLVERS: Final[Mapping[str, Callable[[Any, Any, Sizes], Found]]] = {
    "RRR": _rrr,
    "RTRR": _rrr,
    "RRT": _rrt,
    "TRR": _exchanged(_rrt),
    "RTR1": _rtr,
    "RTR2": _exchanged(_rtr),
    "TRT": _trt,
    "RTT": _rtt,
    "TTR": _exchanged(_rtt),
}


def solved(
    kind: str, first: Joint | Line, last: Joint | Line, sizes: Sizes, driven: Sequence[float] = ()
) -> tuple[Joint, Line, Line]:
    """Return the joint and the members of a dyad.

    Parameters
    ----------
    kind : str
        Its type, RTR1 and RTR2 for the two of RTR.
    first, last : Joint or Line
        What its members begin at.
    sizes : dict
        ``lengths``, ``gammas``, ``beta`` and ``sign``.
    driven : sequence of float, mm
        What is added to the first length.
    """
    found = []
    for k, pair in enumerate(zip(_ends(first), _ends(last), strict=True)):
        more = {"lengths": (sizes["lengths"][0] + driven[k], sizes["lengths"][1])} if driven else {}
        found.append(_SOLVERS[kind](pair[0], pair[1], sizes | more))
    joint, one, along, two, across = ([each[k] for each in found] for k in range(5))
    roots = first.roots | last.roots
    return Joint(joint, roots), Line(one, along, roots), Line(two, across, roots)


def _ends(end: Joint | Line) -> list[tuple[complex, ...]]:
    if isinstance(end, Joint):
        return [(one,) for one in end.at]
    return [*zip(end.at, end.along, strict=True)]
