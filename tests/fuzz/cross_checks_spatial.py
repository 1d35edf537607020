"""Cross-check of a cam in space: its walls against a search that knows no envelope."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from gearcam.kinds.spatial_cam.result import SpatialCamResult
from gearcam.spatial.cam import SpatialWall
from gearcam.spatial.trimmed import TrimmedWall
from witness.roller_in_space import TURN, Mechanism

_ANGLES: Final = 7
"""Number of cam angles at which walls are compared, each at two places along the roller."""

_RESOLUTION: Final = 1e-7
"""Allowed difference of heights, relative to the size of the cam."""

_EVEN: Final = 1e-6
"""Spread, over the radius of the cam, at which a wall is neither whole nor undercut."""

_BRANCHES: Final = 1e-5
"""Height over the size by which the search is wrong where two angles reach equally high."""


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
        x = places * np.ones((_ANGLES, 1))
        touched = wall.contact(theta, x)
        points, spread = touched.points.reshape(-1, 3), touched.spread.ravel()
        depth = TrimmedWall(wall=wall).depth(theta, x).ravel()
        for k, (px, py, pz) in enumerate(points.tolist()):
            found = roller.wall(math.hypot(px, py), math.atan2(py, px), wall.side)
            beyond = wall.side * (found - pz)
            for what in _contradictions(wall, beyond / size, float(spread[k]), depth[k] / size):
                at = math.degrees(theta[k // len(places)])
                yield "wall", f"{wall.key} wall at {at} deg {what}: {beyond} mm"


def _contradictions(wall: SpatialWall, beyond: float, spread: float, depth: float) -> Iterator[str]:
    """Yield what is wrong with how far the search is beyond a wall, over the size of the cam."""
    if beyond < -_RESOLUTION:
        yield "is beyond the search"
    if beyond > _RESOLUTION and wall.spread.value > 0.0:
        yield "is whole, but the search is beyond it"
    if beyond <= 0.0 and spread < -_EVEN * wall.cam.outer_radius:
        yield "is undercut, but the search is not beyond it"
    if abs(depth - max(beyond, 0.0)) > _BRANCHES:
        yield "is trimmed otherwise than the search finds"
