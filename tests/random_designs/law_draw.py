"""Random numbers for ratio laws: tooth counts that suit a law, and its knots."""

from __future__ import annotations

import math
from typing import Any, Final

from random_designs.draw import Draw, short

Law = dict[str, Any]
"""The table of a law in a design file, without its type."""

Counts = tuple[int, int]

MOST_TEETH: Final = 120
"""Largest number of teeth of random designs: the time is proportional to it."""

LOBES: Final = ((1, 1), (1, 1), (1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1))
"""Lobes of the wheels, the frequent ones twice."""


class LawDraw(Draw):
    """Random numbers from one seed, tooth counts among them.

    Parameters
    ----------
    seed : str
        A text that identifies the design.
    most_teeth : int
        Largest number of teeth.
    """

    def __init__(self, seed: str, most_teeth: int = MOST_TEETH) -> None:
        super().__init__(seed)
        self.most_teeth = most_teeth

    def equal(self, low: int = 8) -> Counts:
        """Return equal numbers of teeth, at least `low`."""
        z = self.whole(low, self.most_teeth)
        return z, z

    def lobed(self, low: int = 8) -> Counts:
        """Return numbers of teeth for few lobes."""
        return self.of_lobes(self.pick(LOBES), low)

    def of_lobes(self, lobes: Counts, low: int = 8) -> Counts:
        """Return numbers of teeth for `lobes`: a multiple of them, the smaller at least `low`."""
        n1, n2 = lobes
        each = self.whole(math.ceil(low / min(lobes)), self.most_teeth // max(lobes))
        return n1 * each, n2 * each


def period(z: Counts) -> float:
    """Return the angle of a lobe of the driver, deg."""
    return 360.0 * math.gcd(*z) / z[0]


def rising(d: Draw, count: int, end: float) -> list[float]:
    """Return knots from 0 to `end`, deg."""
    knots = [0.0]
    for share in d.shares(count):
        knots.append(knots[-1] + share * end)
    return [*map(short, knots[:-1]), end]
