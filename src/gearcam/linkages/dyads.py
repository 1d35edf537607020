"""The dyads: groups of two members and three joints, solved from what their outer joints are on.

A dyad is named by its joints in their order, R for a hinge and T for a slide: member 1 begins at
the first joint, member 2 at the last one, the middle joint B joins both. A slide's member runs
along a guide, or along the other member. Its two positions differ by a sign that is a constant of
the machine: no continuation, no start value.

==== ======================= ==================================================================
dyad begins at               its other solution
==== ======================= ==================================================================
RRR  joint A1, joint A2      +1: B to the left of A1 -> A2
RRT  joint A1, guide 2       +1: B ahead of A1, in the guide's direction
TRR  guide 1, joint A2       +1: B ahead of A2
RTR1 joint A1, joint A2      +1; the slide is on member 1
RTR2 joint A1, joint A2      +1; the slide is on member 2
TRT  guide 1, guide 2        none
RTT  joint A1, guide 2       none
TTR  guide 1, joint A2       none
==== ======================= ==================================================================

Every formula is written once, on jets, which give all its derivatives. TRR, RTR2 and TTR are RRT,
RTR1 and RTT with their members exchanged.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np

from gearcam.linkages.plane import Frame, conjugate, cross, imaginary, parts, real, square, turned
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

Length = Jet | float
"""Of a member, mm: a jet where a cylinder drives it."""

End = Jet | Frame
"""What a dyad begins at: a joint or a guide."""


class Lengths(NamedTuple):
    """Sizes of a dyad.

    Attributes
    ----------
    first, second : float, mm
        From the outer joint or the guide to B; a jet where a cylinder drives the first.
    beta : float, rad
        From member 1 to member 2, of RTR, RTT and TTR.
    gamma1, gamma2 : float, rad
        From a guide to the member that slides on it.
    """

    first: Length
    second: float
    beta: float = 0.0
    gamma1: float = 0.0
    gamma2: float = 0.0

    def exchanged(self) -> Lengths:
        """Return the sizes with the members exchanged."""
        return Lengths(self.second, self.first, -self.beta, self.gamma2, self.gamma1)  # pyright: ignore[reportArgumentType]


class Solved(NamedTuple):
    """A dyad's position.

    Attributes
    ----------
    joint : Jet
        B, of complex numbers, mm.
    frames : two Frames
        Of the members: the origin in the outer joint, or in the slide's place on its guide; x
        towards B (of a member that is a guide or a slide without length along the guide).
    slides : dict of str to Jet
        Places along guides, mm: ``guide1`` and ``guide2`` on those given, ``member1`` and
        ``member2`` on its own members.
    left : tuple of Jet, mm2
        What is left before it is singular: 0 or more where it closes (none: it always does). Of RRR
        before its members are in line, outstretched and folded, and before its outer joints meet;
        of TRT the square of a sine.
    squares : tuple of Jet or float, mm2
        Each of these is the difference of two squares of lengths: the larger one.
    scale : Jet or float, mm2
        Of which this is a share: the square of the dyad's size.
    """

    joint: Jet
    frames: tuple[Frame, Frame]
    slides: Mapping[str, Jet]
    left: tuple[Jet, ...]
    squares: tuple[Length, ...] = ()
    scale: Length = 1.0

    @property
    def room(self) -> tuple[Jet, ...]:
        """Shares that are 0 or more where it closes, at most about 1."""
        return tuple(one / self.scale for one in self.left)

    @property
    def rounding(self) -> tuple[Array, ...]:
        """Shares that are none: lengths are equal that differ by rounding of the dyad's size."""
        return tuple(
            2.0 * _EQUAL * np.sqrt(number_of(one) / number_of(self.scale)) for one in self.squares
        )

    def exchanged(self) -> Solved:
        """Return the same with the members exchanged."""
        names = {"guide2": "guide1", "guide1": "guide2", "member1": "member2", "member2": "member1"}
        slides = {names[key]: value for key, value in self.slides.items()}
        return self._replace(frames=self.frames[::-1], slides=slides)


class Passage(NamedTuple):
    """How a dyad goes through its change points.

    Attributes
    ----------
    sign : (n,) array
        Of its position; next to a change point that of the root that is smooth there.
    past : (n,) array, rad
        Angle of the driver from the change point next to it; nan where none is near.
    """

    sign: np.ndarray
    past: np.ndarray


Sign = float | Passage
"""+1 or -1, or where a dyad has change points the way through them."""

_EQUAL: Final = 5e-13
"""Difference of two lengths by rounding, as a share of a dyad's size."""

_NEAR: Final = 1.0
"""Square of the distance of two joints that is no longer far, mm^2: a slide without an arm has no
length that this could be a share of, and is singular where its joints meet."""

_LOST: Final = 1e-15
"""Rounding of what closes a dyad, as a share of its scale."""

_OPEN = np.errstate(invalid="ignore", divide="ignore", over="ignore")
"""Outside of what closes the values are nan, which `Solved.room` tells."""


def number_of(length: Length) -> Array:
    """Return the value of what may be a jet."""
    return np.asarray(length.c[0] if isinstance(length, Jet) else length, dtype=float)


def _root(x: Jet, sign: Sign) -> Jet:
    """Return ``sign*sqrt(x)``.

    Parameters
    ----------
    x : Jet
        At least 0 but for rounding; of double zeros at change points.
    sign : float or Passage

    Notes
    -----
    Next to a double zero x has lost the digits of its root, and more so of the derivatives. There
    ``x = h^2*(a2 + a3*h + ...)`` with the known angle h from the zero, from the derivatives of x
    but the first two, so that its root is ``h*sqrt(a2 + a3*h + ...)``. It has one derivative less.
    This is used where the last terms are less than what is lost otherwise.
    """
    if not isinstance(sign, Passage):
        return jets.sqrt(x) * sign
    near = np.isfinite(sign.past)
    root = jets.sqrt(x) * np.where(sign.past < 0.0, -1.0, 1.0)
    past, own = sign.past[near], [np.broadcast_to(value, near.shape)[near] for value in x.c]
    none = np.zeros(past.shape)
    series = jets.sqrt(Jet(_shifted([none, none, *own[2:]], -past)[2:])).c
    left = [np.abs(value * past**k) for k, value in enumerate(series)]
    near[near] = chosen = np.maximum(*left[-2:]) * past**2 <= _LOST * left[0]
    smooth = _shifted([none, *map(np.asarray, series), none], past)
    values = [np.array(np.broadcast_to(value, near.shape)) for value in root.c]
    for value, mended in zip(values, smooth, strict=True):
        value[near] = mended[chosen]
    return Jet(values) * sign.sign


def _shifted(coefficients: Sequence[np.ndarray], by: np.ndarray) -> list[np.ndarray]:
    """Return the coefficients of polynomials about other points, `by` away."""
    made = list(coefficients)
    for first in range(len(made) - 1):
        for k in range(len(made) - 2, first - 1, -1):
            made[k] = made[k] + by * made[k + 1]
    return made


@_OPEN
def _rrr(first: Jet, second: Jet, sizes: Lengths, sign: Sign) -> Solved:
    one, two = sizes.first, sizes.second
    way = second - first
    distance = square(way)
    whole = (one + two) * (one + two)
    outer, inner = whole - distance, distance - (one - two) * (one - two)
    along = (one * one - two * two + distance) / (distance * 2.0)
    # 16 times the squared area of the triangle, as a product: no cancellation near its zeros
    height = _root(outer * inner, sign) / (distance * 2.0)
    joint = first + way * (along + height * 1j)
    directions = (joint - first) / one, (joint - second) / two
    frames = Frame(first, directions[0]), Frame(second, directions[1])
    left, squares = (outer, inner, distance), (whole, distance, distance)
    return Solved(joint, frames, {}, left, squares, whole)


@_OPEN
def _rrt(first: Jet, guide: Frame, sizes: Lengths, sign: Sign) -> Solved:
    rod, arm, turn = sizes.first, sizes.second, turned(sizes.gamma2)
    ahead = guide.direction
    place = (guide.origin - first) * conjugate(ahead) + turn * arm
    off = imaginary(place)
    # as a product, exact near the ends
    room = (rod - off) * (rod + off)
    reach = _root(room, sign)
    direction = ahead * ((reach + off * 1j) / rod)
    slide = reach - real(place)
    joint = first + direction * rod
    frames = Frame(first, direction), Frame(guide.origin + ahead * slide, ahead * turn)
    return Solved(joint, frames, {"guide2": slide}, (room,), (rod * rod,), rod * rod)


def rtr_distance(across: float, share: float) -> float:
    """Return the distance of the outer joints of RTR at which a share is left (see `Solved.room`).

    Parameters
    ----------
    across : float, mm
        How far the block's arm is across the guide.
    share : float
        What is left.
    """
    return math.sqrt(max(across * across + share * _NEAR, 0.0) / (1.0 - share))


@_OPEN
def _rtr(first: Jet, second: Jet, sizes: Lengths, sign: Sign) -> Solved:
    turn = turned(sizes.beta)
    along, across = parts(turn * sizes.second)
    way = second - first
    distance = square(way)
    room = distance - across * across
    reach = _root(room, sign)
    slide = reach + along
    # the guide's direction; where the arm is 0 this is the way itself
    guide = way / (reach - across * 1j)
    joint = first + guide * slide
    frames = Frame(first, guide), Frame(second, guide * turn)
    return Solved(joint, frames, {"member1": slide}, (room,), (distance,), distance + _NEAR)


def rtr_reach(solved: Solved, sizes: Lengths) -> Jet:
    """Return the place of the block of RTR less where it jams: its distance ``l0``, mm, signed.

    Parameters
    ----------
    solved : Solved
        Its position.
    sizes : Lengths
        Of the same dyad.
    """
    ((guide, slide),) = solved.slides.items()
    arm = sizes.second if guide == "member1" else sizes.first
    return slide - arm * np.cos(sizes.beta)


@_OPEN
def _trt(first: Frame, second: Frame, sizes: Lengths, _: Sign) -> Solved:
    turns = turned(sizes.gamma1), turned(sizes.gamma2)
    one, two = first.direction * turns[0], second.direction * turns[1]
    way = second.origin - first.origin + two * sizes.second - one * sizes.first
    sine = cross(first.direction, second.direction)
    slides = cross(way, second.direction) / sine, cross(way, first.direction) / sine
    feet = [
        guide.at(0j) + guide.direction * slide
        for guide, slide in zip((first, second), slides, strict=True)
    ]
    joint = feet[0] + one * sizes.first
    frames = Frame(feet[0], one), Frame(feet[1], two)
    places, left = {"guide1": slides[0], "guide2": slides[1]}, (sine * sine,)
    return Solved(joint, frames, places, left, left)


def _rtt(first: Jet, guide: Frame, sizes: Lengths, _: Sign) -> Solved:
    turn = turned(sizes.gamma2)
    second = guide.direction * turn
    one = second * turned(-sizes.beta)
    joint = first + one * sizes.first
    place = (joint - guide.origin) * conjugate(guide.direction)
    cosine, sine = parts(turn)
    along = imaginary(place) / sine
    slide = real(place) - along * cosine
    frames = Frame(first, one), Frame(guide.origin + guide.direction * slide, second)
    return Solved(joint, frames, {"guide2": slide, "member2": along}, ())


Solver = Callable[..., Solved]


def _exchanged(solver: Solver) -> Solver:
    def solve(first: End, second: End, sizes: Lengths, sign: Sign) -> Solved:
        return solver(second, first, sizes.exchanged(), sign).exchanged()

    return solve


class DyadType(NamedTuple):
    """What a type of dyad begins at and how it is solved.

    Attributes
    ----------
    guides : (bool, bool)
        Whether member 1 and member 2 begin at a guide instead of a joint.
    branches : (str, str) or ()
        Names of the positions for the signs +1 and -1.
    slides : tuple of str
        The slides whose places it gives (see `Solved`).
    rods : tuple of int
        Numbers of the lengths that must be above 0.
    passable : bool
        Whether it can pass a change point; the others jam or lose their place.
    solve : callable
        ``solve(first, second, lengths, sign) -> Solved``.
    """

    guides: tuple[bool, bool]
    branches: tuple[str, ...]
    slides: tuple[str, ...]
    rods: tuple[int, ...]
    passable: bool
    solve: Solver

    @property
    def guiding(self) -> int | None:
        """Index of the member along which the other one slides; None with a hinge between them."""
        return next((k for k in (0, 1) if f"member{k + 1}" in self.slides), None)


_HINGES, _TO_GUIDE, _FROM_GUIDE = (False, False), (False, True), (True, False)
_SIDES, _AHEAD = ("left", "right"), ("ahead", "behind")

DYADS: Final[Mapping[str, DyadType]] = {
    "RRR": DyadType(_HINGES, _SIDES, (), (0, 1), True, _rrr),
    "RRT": DyadType(_TO_GUIDE, _AHEAD, ("guide2",), (0,), True, _rrt),
    "TRR": DyadType(_FROM_GUIDE, _AHEAD, ("guide1",), (1,), True, _exchanged(_rrt)),
    "RTR1": DyadType(_HINGES, _AHEAD, ("member1",), (), False, _rtr),
    "RTR2": DyadType(_HINGES, _AHEAD, ("member2",), (), False, _exchanged(_rtr)),
    "TRT": DyadType((True, True), (), ("guide1", "guide2"), (), False, _trt),
    "RTT": DyadType(_TO_GUIDE, (), ("guide2", "member2"), (), False, _rtt),
    "TTR": DyadType(_FROM_GUIDE, (), ("guide1", "member1"), (), False, _exchanged(_rtt)),
}
"""The types of dyads by name."""
