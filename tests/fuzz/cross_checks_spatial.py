"""Cross-check of a cam in space: its walls against a search that knows no envelope."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from gearcam.kinds.spatial_cam.build import SpatialCamResult
from witness.roller_in_space import TURN, Mechanism

_ANGLES: Final = 7
"""Number of cam angles at which walls are compared, each at two places along the roller."""

_RESOLUTION: Final = 1e-7
"""Allowed difference of heights, relative to the size of the cam."""


def doubts(result: SpatialCamResult) -> Iterator[tuple[str, str]]:
    """Yield places where a wall is not where a search for the roller's positions finds it.

    Where the roller cuts a wall away at another angle, the search reaches beyond it.

    Parameters
    ----------
    result : SpatialCamResult
        The result to check.

    Yields
    ------
    place, words : str
        Place and description of a contradiction.
    """
    cam, size = result.cam, 2.0 * result.cam.outer_radius
    theta = TURN / _ANGLES * (np.arange(float(_ANGLES)) + 0.37)
    places = cam.floor + (cam.outer_radius - cam.floor) * np.array([0.1, 0.9])
    for wall in cam.walls:
        shift = -0.5 * wall.side * cam.apart

        def center(at: Any, shift: float = shift) -> tuple[Any, Any]:
            point, _ = cam.guide.placed(cam.program.derivatives(at, 0)[0])
            return point[0, :, 1], point[0, :, 2] + shift

        tool = cam.tool
        roller = Mechanism(center, tool.radius, tool.at, tool.half_angle, cam.floor)
        points = wall.contact(theta, places * np.ones((_ANGLES, 1))).points.reshape(-1, 3)
        for (x, y, z), at in zip(points.tolist(), np.repeat(theta, 2).tolist(), strict=True):
            found = roller.wall(math.hypot(x, y), math.atan2(y, x), wall.side)
            beyond = wall.side * (found - z)
            cut = wall.spread.value <= 0.0
            if beyond < -_RESOLUTION * size or (beyond > _RESOLUTION * size and not cut):
                words = f"{wall.key} wall at {math.degrees(at)} deg is {beyond} mm off"
                yield "wall", words
