"""The linkages of `peer_linkages` by gearcam; as a command like that one."""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

from gearcam.linkages.closing import settled
from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import Crank, Dyad, GivenMotion, MemberPoint
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.numeric.arrays import keep_freed_memory
from gearcam.numeric.jets import Jet

TURN = 2.0 * np.pi


def four_bar() -> tuple[Linkage, tuple[str, ...]]:
    """Return the four-bar with a point of its coupler, and its moving joints."""
    parts = [
        GivenMotion("q", Jet.variable),
        MemberPoint("A", 0j),
        MemberPoint("D", 110 + 0j),
        Crank("crank", "q", "A", "B", 40.0),
        Dyad("RRR", "B", "D", "C", ("coupler", "rocker"), Lengths(120.0, 90.0)),
        MemberPoint("P", 60.0 * np.exp(1j * np.radians(35.0)), "coupler"),
    ]
    return settled(Linkage(in_order(parts), np.array([0.0, TURN]))), ("C", "P")


def six_bar() -> tuple[Linkage, tuple[str, ...]]:
    """Return the six-bar with a dwell, and its moving joints."""
    parts = [
        GivenMotion("q", Jet.variable),
        MemberPoint("A", 0j),
        MemberPoint("D", 300 + 0j),
        MemberPoint("G", 500 + 740j),
        Crank("crank", "q", "A", "B", 100.0),
        Dyad("RRR", "B", "D", "C", ("coupler", "rocker"), Lengths(300.0, 300.0)),
        MemberPoint("E", 600 + 0j, "coupler"),
        Dyad("RRR", "E", "G", "F", ("rod", "lever"), Lengths(379.0, 218.0)),
    ]
    return settled(Linkage(in_order(parts), np.array([0.0, TURN]))), ("C", "E", "F")


LINKAGES = {"four-bar": four_bar, "six-bar": six_bar}


def solved(name: str, steps: int, order: int) -> list[NDArray[np.complex128]]:
    """Joints over a turn and their derivatives by the crank's angle, from the first step on."""
    made, joints = LINKAGES[name]()
    known = made.at(np.arange(1, steps + 1) * (TURN / steps), order)
    found = [known.jet(joint).derivatives() for joint in joints]
    return [np.stack(list(part), axis=-1) for part in zip(*found, strict=True)]


if __name__ == "__main__":
    keep_freed_memory()  # as the command line does
    last = [complex(part[-1, -1]) for part in solved(sys.argv[1], int(sys.argv[2]), 2)]
    sys.stdout.write(f"{[[one.real, one.imag] for one in last]}\n")
