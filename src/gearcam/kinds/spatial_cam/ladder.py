"""The solid of a cam in space at rising resolution (see `gearcam.results.ladders`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.results.ladders import Ladder, Ladders, grid_ladder

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult

_LEAST: Final = 24
"""Least number of cam angles of a level."""


def _solid(result: SpatialCamResult) -> Ladder:
    """Return the error of the volume; a carved solid, which takes long, is not made finer."""
    return grid_ladder(result, _LEAST, finer=not result.carved)


LADDERS: Final[Ladders] = {"solid": _solid}
"""What `gearcam accuracy` can measure."""
