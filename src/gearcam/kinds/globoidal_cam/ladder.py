"""The solid of a globoidal cam at rising resolution (see `gearcam.results.ladders`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.results.ladders import ROUNDING, Ladder, Ladders

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult
    from gearcam.parts.solids import Mesh

_PARTS: Final = (8, 4, 2, 1)
"""Steps of the coarser levels over those of the design."""

_LEAST: Final = 72
"""Least number of cam angles of a level."""


def _solid(result: GloboidalCamResult) -> Ladder:
    """Return the error of the volume over the number of cam angles.

    Places along the roller are refined with them, so that the error falls with the number of
    points. The truth is extrapolated from a level twice as fine as the finest and from that one.
    """
    own, places = result.solid_steps, result.design.output.wall_points
    levels = sorted({max(_LEAST, own // part) for part in _PARTS})

    def make(level: float) -> Mesh:
        return result.mesh_of(int(level), max(2, 1 + round((places - 1) * level / own)))

    finest = levels[-1]
    close, closer = make(finest).volume, make(2 * finest).volume
    truth = closer + (closer - close) / 3.0

    def measure(made: Mesh) -> tuple[float, int]:
        return abs(made.volume - truth), len(made.vertices)

    return Ladder(
        refined="cam angles",
        measured="volume of the solid",
        unit="mm3",
        levels=levels,
        own=float(own),
        order=1.0,
        rounding=ROUNDING * truth,
        make=make,
        measure=measure,
    )


LADDERS: Final[Ladders] = {"solid": _solid}
"""What `gearcam accuracy` can measure."""
