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

    def height(self, theta: Any, radius: Any, azimuth: Any, side: int) -> Any:
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


@dataclass(frozen=True)
class Swept:
    """One wall of what a roller leaves that has stood at many cam angles."""

    roller: Mechanism
    side: int
    aside: float
    count: int = 1501

    def left(self, theta: float, x: float, y: np.ndarray) -> np.ndarray:
        """Heights of the wall in the plane across the roller at a cam angle, at places y."""
        radius, azimuth = np.hypot(x, y), np.arctan2(y, x) - theta
        wide = self.roller.radius + (radius - self.roller.at) * math.tan(self.roller.half_angle)
        near = np.arcsin(np.minimum(1.0, (wide + self.aside) / radius))
        span = np.minimum(near, np.arccos(np.minimum(1.0, self.roller.inner / radius)))
        share = np.linspace(-1.0, 1.0, self.count) * (1.0 - 1e-10)
        at = np.clip(span, 1e-6, None)[:, None] * share - azimuth[:, None]
        heights = self.roller.height(at, radius[:, None], azimuth[:, None], self.side)
        return self.side * np.max(self.side * heights, axis=1)

    def way(self, theta: float, x: float, moved: Callable[[float], Any], most: float) -> float:
        """How far a thin slice of the roller goes towards the wall before it rests, up to `most`.

        `moved` gives its middle (y, z) after a way.
        """
        radius = self.roller.radius + (x - self.roller.at) * math.tan(self.roller.half_angle)
        middle, size = moved(0.0)[0], 0.999 * radius
        y, z = np.empty(0), np.empty(0)

        def room(way: float) -> tuple[float, float]:
            y_a, z_a = moved(way)
            square = radius**2 - (y - y_a) ** 2
            rooms = self.side * (z - z_a) - np.sqrt(np.maximum(square, 0.0))
            rooms[square < 0.0] = math.inf
            return float(rooms.min()), float(y[np.argmin(rooms)])

        found = 0.0
        for number in range(6):
            more = middle + size * np.linspace(-1.0, 1.0, 41 if number else 161)
            y, z = np.append(y, more), np.append(z, self.left(theta, x, more))
            low, high = 0.0, most
            for _ in range(60):
                found = 0.5 * (low + high)
                low, high = (found, high) if room(found)[0] > 0.0 else (low, found)
            middle, size = room(found)[1], size / (15.0 if number else 60.0)
        return found


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
