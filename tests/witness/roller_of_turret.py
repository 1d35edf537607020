"""How near the axis of a roller on a turret comes to a point of the cam, by search.

It knows no envelope and no contact: it looks at the distance of the point from the roller's axis
over the angles of the cam, written with the standard library.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

_STEPS = 1500
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


@dataclass(frozen=True)
class Wheel:
    """A turret: distance of its axis, ends of its rollers, and their angle over the cam's, rad."""

    distance: float
    reach: float
    angle: Callable[[float], float]

    def away(self, point: tuple[float, float, float], theta: float) -> float:
        """Distance of the roller's axis from a point of the cam that has turned by theta."""
        x, y, z = point
        c, s, psi = math.cos(theta), math.sin(theta), self.angle(theta)
        u, v, w = c * x - s * y - self.distance, s * x + c * y, z
        along = -u * math.cos(psi) + w * math.sin(psi)
        # behind the turret's axis and beyond its end there is no roller
        return math.hypot(
            v, u * math.sin(psi) + w * math.cos(psi), min(0.0, along), max(0.0, along - self.reach)
        )

    def nearest(self, point: tuple[float, float, float], start: float, end: float) -> float:
        """The least distance between two angles."""
        step = (end - start) / _STEPS
        found = [self.away(point, start + k * step) for k in range(_STEPS + 1)]
        best = min(found)
        for k in range(1, _STEPS):
            if found[k] <= min(found[k - 1], found[k + 1]):
                best = min(best, self._narrowed(point, start + (k - 1) * step, 2.0 * step))
        return best

    def _narrowed(self, point: tuple[float, float, float], low: float, width: float) -> float:
        for _ in range(60):
            one, other = low + (1.0 - _GOLDEN) * width, low + _GOLDEN * width
            if self.away(point, one) > self.away(point, other):
                low = one
            width *= _GOLDEN
        return self.away(point, low + 0.5 * width)
