"""Walls of cylinder cams by a search that knows no envelope, and motions written out once.

A point of the cam at a radius and an azimuth is passed by the roller at many cam angles; the
highest point that any of them reaches is the upper wall there, the lowest one the lower wall. The
axis of the cam is z, it turns counter-clockwise; the roller's axis is parallel to x at azimuth 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

TURN = 2.0 * math.pi


@dataclass(frozen=True)
class Mechanism:
    """A roller on a cylinder cam: its axis (y, z) over the angle, and its radius along the axis.

    It begins at the distance `inner` from the axis of the cam.
    """

    center: Callable[[Any], tuple[Any, Any]]
    radius: float
    at: float
    half_angle: float = 0.0
    inner: float = -math.inf

    def height(self, theta: Any, radius: float, azimuth: float, side: int) -> Any:
        """Highest (lowest) point of the roller above a point of the cam; -side*inf beside it."""
        x, y = radius * np.cos(azimuth + theta), radius * np.sin(azimuth + theta)
        y_a, z_a = self.center(theta)
        r = self.radius + (x - self.at) * math.tan(self.half_angle)
        with np.errstate(invalid="ignore"):
            half = np.sqrt(r**2 - (y - y_a) ** 2)
        return np.where(np.isnan(half) | (x < self.inner), -side * np.inf, z_a + side * half)

    def wall(self, radius: float, azimuth: float, side: int, count: int = 2001) -> float:
        """Height of a wall at a radius and an azimuth, narrowed down to rounding."""
        low, high = -azimuth - 1.2, -azimuth + 1.2
        best = -math.inf
        for _ in range(12):
            theta = np.linspace(low, high, count)
            values = side * self.height(theta, radius, azimuth, side)
            k = int(np.argmax(values))
            best = max(best, float(values[k]))
            step = (high - low) / (count - 1)
            low, high = theta[k] - 2.0 * step, theta[k] + 2.0 * step
            count = 41
        return side * best


def cycloidal(
    theta: np.ndarray, lift: float, spans: tuple[float, float, float, float]
) -> np.ndarray:
    """Return a cycloidal rise, a dwell, a return and a dwell over a turn; spans in rad."""
    theta = np.mod(theta, TURN)
    rise, dwell, back, _ = spans
    up = np.clip(theta / rise, 0.0, 1.0)
    down = np.clip((theta - rise - dwell) / back, 0.0, 1.0)

    def unit(u: Any) -> Any:
        return u - np.sin(TURN * u) / TURN

    return lift * (unit(up) - unit(down))
