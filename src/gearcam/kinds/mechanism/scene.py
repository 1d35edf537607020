"""The scene of a mechanism: members, wheels and cams over a cycle of the master."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.mechanism.bodies import bodies
from gearcam.pictures.scenes import PLACES, Scene

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

_TURNS: Final = 4
"""Largest number of turns of the master for each of which there are so many places."""


def scene(result: MechanismResult, places: int = PLACES) -> Scene:
    """Return the machine in motion.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    places : int
        Steps of the master in a turn; of many turns the steps are longer.

    Returns
    -------
    Scene
    """
    low, high = result.linkage.span
    turns = min(max(round((high - low) / (2.0 * math.pi)), 1), _TURNS)
    q = np.linspace(low, high, places * turns + 1)
    return Scene(
        title=result.design.name,
        driver=f"{result.driver[1]}, deg",
        places=np.degrees(q),
        closed=result.linkage.closed,
        start=math.degrees(shown_at(result)),
        bodies=bodies(result, q),
    )


def shown_at(result: MechanismResult) -> float:
    """Return the master's angle in pictures, rad, within its range."""
    (low, high), pose = result.linkage.span, result.design.output.pose
    if result.linkage.closed:
        return low + (pose - low) % (high - low)
    return min(max(pose, low), high)
