"""Distances of many points from long lines: each point looks at the piece nearest to it only."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely


def distances(points: np.ndarray, lines: Any) -> np.ndarray:
    """Distance of each point, (n, 2), from lines or rings, shapely's: (n,)."""
    vertices = [shapely.get_coordinates(line) for line in shapely.get_parts(lines)]
    pieces = [np.stack([each[:-1], each[1:]], axis=1) for each in vertices]
    made: Any = shapely.linestrings(np.concatenate(pieces))
    _, found = shapely.STRtree(made).query_nearest(
        shapely.points(points), return_distance=True, all_matches=False
    )
    assert len(found) == len(points)
    return found
