"""What a rise does between dwells: order of continuity, and peaks of its derivatives."""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion.base import MotionFunction
from gearcam.numeric.piecewise import extremes

Array = NDArray[np.float64]

JUMP = 1e-9
"""Jump of a derivative that counts, in its largest value: far above rounding."""


class ShownRise(MotionFunction):
    """A rise that is asked for its peaks."""

    @property
    def start(self) -> tuple[float, ...]:
        """Velocity, acceleration and jerk at the start of the rise."""
        return tuple(self.function.side(0, 1, 3)[1:])

    @property
    def end(self) -> tuple[float, ...]:
        """Velocity, acceleration and jerk at the end of the rise."""
        return tuple(self.function.side(len(self.function.knots) - 1, -1, 3)[1:])

    @cached_property
    def _sides(self) -> tuple[list[list[float]], list[list[float]]]:
        """S to S''' before and after every knot, with dwells beyond the ends."""
        last = len(self.function.knots) - 1
        before = [self.function.side(knot, -1, 3) for knot in range(1, last + 1)]
        after = [self.function.side(knot, 1, 3) for knot in range(last)]
        return [[0.0, 0.0, 0.0, 0.0], *before], [*after, [1.0, 0.0, 0.0, 0.0]]

    @cached_property
    def _largest(self) -> tuple[float, ...]:
        """Largest absolute S', S'' and S''' between knots."""

        def values(order: int, phi: Array) -> list[Array]:
            return self.function.derivatives(phi, order + 1)[order:]

        cuts = np.union1d(self.function.knots, self.cuts)
        inside = [extremes(partial(values, order), cuts) for order in (1, 2, 3)]
        before, after = self._sides
        at_knots = np.abs(before[1:] + after[:-1]).max(axis=0)[1:]
        return tuple(
            max(float(np.abs(found).max()), float(end))
            for (_, found), end in zip(inside, at_knots, strict=True)
        )

    @cached_property
    def continuity(self) -> int:
        """Order of continuity between dwells, -1 to 3, where 3 means at least 3.

        It counts over the knots and both ends: 0 where the velocity jumps, 1 where the acceleration
        does, 2 where the jerk does.
        """
        before, after = np.array(self._sides)
        scales = np.array([1.0, *self._largest])
        jumps = (np.abs(after - before) > JUMP * scales).any(axis=0)
        return int(np.argmax(np.append(jumps, True))) - 1

    @property
    def peaks(self) -> tuple[float, float, float]:
        """Largest velocity, acceleration and jerk; infinite where a derivative below jumps."""
        first, second, third = (
            self._largest[order] if self.continuity >= order else math.inf for order in range(3)
        )
        return first, second, third

    @property
    def peak_velocity(self) -> float:
        return self.peaks[0]

    @property
    def peak_acceleration(self) -> float:
        return self.peaks[1]

    @property
    def peak_jerk(self) -> float:
        return self.peaks[2]


def shown(parameters: Any) -> ShownRise:
    """Build a rise of its parameters."""
    rise = parameters.build(DEFAULT)
    return ShownRise(function=rise.function, mirrored=rise.mirrored, cuts=rise.cuts)
