"""Which members of a four-bar turn fully, by Grashof's rule (Norton, Design of Machinery, 2.12).

The shortest member turns fully against all others if it and the longest one together are shorter
than the other two. Which motion that gives depends on which member is the shortest one.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

_EQUAL: Final = 1e-12
"""Difference of sums of lengths, as a share of all, that counts as none."""


class FourBarLengths(NamedTuple):
    """Lengths of a four-bar, mm.

    Attributes
    ----------
    driver, coupler, follower, base : float, mm
        The member that is driven, those after it in their order, and the distance of the shafts.
    """

    driver: float
    coupler: float
    follower: float
    base: float


class GrashofClass(NamedTuple):
    """How the members of a four-bar move.

    Attributes
    ----------
    name : str
        crank-rocker, rocker-crank, double crank, double rocker, triple rocker or change point.
    meaning : str
        A sentence.
    turning : tuple of str
        Which of driver, coupler and follower turn fully against the base; at a change point which
        of driver and follower can.
    spare : float, mm
        By how much the shortest and the longest member together are shorter than the other two.
    """

    name: str
    meaning: str
    turning: tuple[str, ...]
    spare: float


_BY_SHORTEST: Final[dict[str, tuple[str, str, tuple[str, ...]]]] = {
    "driver": (
        "crank-rocker",
        "the driver turns fully and the follower swings",
        ("driver",),
    ),
    "follower": (
        "rocker-crank",
        "the driver only swings; the follower could turn fully and drive it",
        ("follower",),
    ),
    "base": (
        "double crank",
        "driver and follower both turn fully",
        ("driver", "coupler", "follower"),
    ),
    "coupler": (
        "double rocker",
        "driver and follower only swing; the coupler turns fully",
        ("coupler",),
    ),
}

_TRIPLE: Final = "no member turns fully: driver, coupler and follower all swing"

_CHANGE: Final = (
    "all members come into one line, where the follower may go either way; "
    "it must be guided through by force, a second linkage or its own speed"
)


def grashof(lengths: FourBarLengths) -> GrashofClass:
    """Return how the members of a four-bar move.

    Parameters
    ----------
    lengths : FourBarLengths
        All above 0.

    Returns
    -------
    GrashofClass

    Raises
    ------
    ValueError
        If a length is not above 0, or the longest one is not shorter than the others together.
    """
    _check(lengths)
    least, *middle, most = sorted(lengths)
    spare = math.fsum([*middle, -least, -most])
    shortest = min(lengths._fields, key=lambda name: getattr(lengths, name))
    if abs(spare) <= _EQUAL * sum(lengths):
        ways = {
            "driver": lengths,
            "follower": lengths._replace(driver=lengths.follower, follower=lengths.driver),
        }
        turning = tuple(name for name, seen in ways.items() if turns_fully(seen))
        return GrashofClass("change point", _CHANGE, turning, 0.0)
    if spare < 0.0:
        return GrashofClass("triple rocker", _TRIPLE, (), spare)
    name, meaning, turning = _BY_SHORTEST[shortest]
    return GrashofClass(name, meaning, turning, spare)


def turns_fully(lengths: FourBarLengths) -> bool:
    """Return whether the driver of a four-bar turns fully (000, 2.151).

    Parameters
    ----------
    lengths : FourBarLengths
        All above 0.

    Returns
    -------
    bool
        True for a change point too: it turns if it is guided through.
    """
    loose = _EQUAL * sum(lengths)
    least, most = abs(lengths.driver - lengths.base), lengths.driver + lengths.base
    reach = lengths.coupler + lengths.follower
    return least >= abs(lengths.coupler - lengths.follower) - loose and most <= reach + loose


def _check(lengths: FourBarLengths) -> None:
    for name, value in lengths._asdict().items():
        if not value > 0.0:
            raise ValueError(f"{name} {value:g} mm: must be above 0")
    name = max(lengths._fields, key=lambda one: getattr(lengths, one))
    longest = getattr(lengths, name)
    rest = sum(lengths) - longest
    if longest >= rest:
        raise ValueError(
            f"{name} {longest:g} mm: the other three do not reach; it must be below {rest:g} mm"
        )
