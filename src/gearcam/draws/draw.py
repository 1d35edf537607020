"""Drawing at random: numbers and choices of one seed, the same on every machine."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import Final, TypeVar

T = TypeVar("T")

DIGITS: Final = 6
"""Digits of a drawn number: people type no more."""


class Draw:
    """Draws of one seed.

    Parameters
    ----------
    seed : str
        Whatever tells one design from another.
    """

    def __init__(self, seed: str) -> None:
        self.random = random.Random(seed)

    def chance(self, share: float) -> bool:
        """Return True in this share of draws."""
        return self.random.random() < share

    def pick(self, items: Sequence[T]) -> T:
        """Return one of these."""
        return items[int(self.random.random() * len(items))]

    def even(self, low: float, high: float) -> float:
        """Return a number from `low` to `high`, each as likely."""
        return short(low + (high - low) * self.random.random())

    def log(self, low: float, high: float) -> float:
        """Return a number from `low` to `high`, both above 0, each power of ten as likely."""
        return short(math.exp(self.random.uniform(math.log(low), math.log(high))))

    def sign(self) -> int:
        """Return 1 or -1."""
        return 1 if self.chance(0.5) else -1

    def whole(self, low: int, high: int) -> int:
        """Return a whole number from `low` to `high`, small ones as likely as all large ones."""
        return min(high, int(self.log(max(low, 0.7), high + 0.999))) if high > low else low

    def shares(self, count: int, least: float = 0.3) -> list[float]:
        """Return a `count` of numbers that are 1 in all, none below `least` times another."""
        drawn = [self.random.uniform(least, 1.0) for _ in range(count)]
        return [one / sum(drawn) for one in drawn]


def short(value: float) -> float:
    """Return a number with few digits."""
    return float(f"{value:.{DIGITS}g}")
