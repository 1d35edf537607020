"""A four-bar and a six-bar by the package pylinkage from PyPI.

Run as a command it prints the last position of a linkage after a number of steps, with velocities
and accelerations: ``peer_linkages.py six-bar 10000``.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pylinkage.actuators import Crank
from pylinkage.components import Ground
from pylinkage.dyads import FixedDyad, RRRDyad
from pylinkage.simulation import Linkage


@dataclass(frozen=True)
class Peer:
    """A linkage of pylinkage, and the numbers of its joints that are compared."""

    linkage: Any
    crank: Any
    joints: tuple[int, ...]


def four_bar(steps: int) -> Peer:
    """Crank 40, coupler 120, rocker 90, base 110, a point of the coupler."""
    shaft, far = Ground(0.0, 0.0), Ground(110.0, 0.0)
    crank = Crank(anchor=shaft, radius=40.0, angular_velocity=math.tau / steps)
    rocker = RRRDyad(crank.output, far, 120.0, 90.0, x=120.0, y=89.0)
    point = FixedDyad(crank.output, rocker, 60.0, math.radians(35.0))
    return Peer(Linkage([shaft, far, crank, rocker, point]), crank, (3, 4))


def six_bar(steps: int) -> Peer:
    """Crank 100, a coupler point 600 from its pin, a second dyad of 379 and 218."""
    shaft, far, third = Ground(0.0, 0.0), Ground(300.0, 0.0), Ground(500.0, 740.0)
    crank = Crank(anchor=shaft, radius=100.0, angular_velocity=math.tau / steps)
    rocker = RRRDyad(crank.output, far, 300.0, 300.0, x=200.0, y=283.0)
    point = FixedDyad(crank.output, rocker, 600.0, 0.0)
    lever = RRRDyad(point, third, 379.0, 218.0, x=397.0, y=932.0)
    return Peer(Linkage([shaft, far, third, crank, rocker, point, lever]), crank, (4, 5, 6))


PEERS = {"four-bar": four_bar, "six-bar": six_bar}


def stepped(name: str, steps: int) -> NDArray[np.complex128]:
    """Joints over a turn, one by one, from the first step on."""
    peer = PEERS[name](steps)
    places = np.array(list(peer.linkage.step(steps)))[:, peer.joints]
    return places[..., 0] + 1j * places[..., 1]


def compiled(name: str, steps: int) -> list[NDArray[np.float64]]:
    """Positions, velocities and accelerations of the compiled solver."""
    peer = PEERS[name](steps)
    peer.linkage.set_input_velocity(peer.crank, 1.0)
    return [part[:, peer.joints] for part in peer.linkage.step_fast_with_kinematics(steps)]


if __name__ == "__main__":
    found = compiled(sys.argv[1], int(sys.argv[2]))
    sys.stdout.write(f"{[part[-1, -1].tolist() for part in found]}\n")
