"""Random numbers and choices from a seed, the same on every machine."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import Final, TypeVar

T = TypeVar("T")

DIGITS: Final = 6
"""Significant digits of a random number: as many as people type."""


class Draw:
    """Random numbers from one seed.

    Parameters
    ----------
    seed : str
        A text that identifies the design.
    """

    def __init__(self, seed: str) -> None:
        self.random = random.Random(seed)

    def chance(self, share: float) -> bool:
        """Return True with this probability."""
        return self.random.random() < share

    def pick(self, items: Sequence[T]) -> T:
        """Return one of the items at random."""
        return items[int(self.random.random() * len(items))]

    def even(self, low: float, high: float) -> float:
        """Return a number uniformly distributed from `low` to `high`."""
        return short(low + (high - low) * self.random.random())

    def log(self, low: float, high: float) -> float:
        """Return a number log-uniformly distributed from `low` to `high`, both above 0."""
        return short(math.exp(self.random.uniform(math.log(low), math.log(high))))

    def sign(self) -> int:
        """Return 1 or -1 at random."""
        return 1 if self.chance(0.5) else -1

    def whole(self, low: int, high: int) -> int:
        """Return a whole number log-uniformly distributed from `low` to `high`."""
        return min(high, int(self.log(max(low, 0.7), high + 0.999))) if high > low else low

    def shares(self, count: int, least: float = 0.3) -> list[float]:
        """Return `count` numbers with the sum 1, each at least `least` times any other."""
        drawn = [self.random.uniform(least, 1.0) for _ in range(count)]
        return [one / sum(drawn) for one in drawn]


def short(value: float) -> float:
    """Return the value rounded to `DIGITS` significant digits."""
    return float(f"{value:.{DIGITS}g}")
