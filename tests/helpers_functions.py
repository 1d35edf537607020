"""Functions at the top of a module: these pickle."""

from __future__ import annotations

import math


def swing(phi1: float) -> float:
    return phi1 - 0.6 * math.sin(phi1)


class Bent:
    """A function with a number that can be pickled."""

    def __init__(self, share: float) -> None:
        self.share = share

    def __call__(self, phi1: float) -> float:
        return phi1 - self.share * math.sin(phi1)
