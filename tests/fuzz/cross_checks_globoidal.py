"""Cross-check of a globoidal cam: its walls against a search that knows no envelope."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from gearcam.kinds.globoidal_cam.result import GloboidalCamResult
from witness.roller_of_turret import Wheel

_ANGLES: Final = 9
"""Number of cam angles at which each wall is compared, each at two places along the roller."""

_RESOLUTION: Final = 1e-7
"""Allowed difference of distances, over the centre distance."""

_EVEN: Final = 1e-6
"""Spread, over the centre distance, at which a wall is neither whole nor undercut."""


def doubts(result: GloboidalCamResult) -> Iterator[tuple[str, str]]:
    """Yield places of a wall that some roller does not touch, or cuts away, by the search.

    Parameters
    ----------
    result : GloboidalCamResult
        The result to check.

    Yields
    ------
    place, words : str
        Place and description of a contradiction.
    """
    cam = result.cam
    start, end = cam.span

    def angle(theta: float) -> float:
        return float(cam.angle(np.array([theta]))[0])

    wheel = Wheel(cam.distance, cam.places[1], angle)
    theta = start + (end - start) * (np.arange(float(_ANGLES)) + 0.37) / _ANGLES
    for wall in cam.walls:
        first, last = (wall.place(theta, depth) for depth in (cam.top, cam.floor))
        x = first[:, None] + (last - first)[:, None] * np.array([0.1, 0.9])
        touched = wall.contact(theta, x)
        on = cam.inside(touched.points)
        for point, spread in zip(touched.points[on].tolist(), touched.spread[on], strict=True):
            found = wheel.nearest(tuple(point), start, end) - cam.tool.radius
            beyond = -found / cam.distance
            where = f"{wall.key} wall, {found} mm"
            if beyond < -_RESOLUTION:
                yield "wall", f"{where}: no roller touches it"
            if beyond > _RESOLUTION and wall.spread.value > 0.0:
                yield "wall", f"{where}: it is whole, but a roller cuts it"
            if beyond <= 0.0 and spread < -_EVEN * cam.distance:
                yield "wall", f"{where}: it is undercut, but no roller cuts it"
