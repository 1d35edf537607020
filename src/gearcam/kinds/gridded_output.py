"""The table ``[output]`` of cams in space: what all have alike."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.base.quantities import ANGLE, COUNT, fixed, param
from gearcam.base.rules import distinct
from gearcam.designs.outputs import OutputSpec, pose_param


@dataclass(frozen=True, kw_only=True)
class GriddedOutput(OutputSpec):
    """Which files and studies of a cam in space are written, and how fine (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        Cam angle of the drawing.
    chord_tolerance, kerf, dxf_curves, dxf_version
        Its surfaces have steps instead, and what is drawn is not for cutting out.
    """

    wall_step: float = param(
        ANGLE,
        default=math.radians(0.5),
        ge=0.01,
        le=5,
        doc="step of the cam angle in walls.csv and in solids",
    )
    wall_points: int = param(
        COUNT, default=13, ge=2, le=500, doc="places along the roller in walls.csv and in solids"
    )
    motion_step: float = param(
        ANGLE, default=math.radians(1), gt=0, le=90, doc="step of the cam angle in motion.csv"
    )
    pose: float = pose_param("theta", "cam angle of the drawing")

    chord_tolerance: float | None = fixed(None)
    kerf: float = fixed(0.0)
    dxf_curves: str = fixed("lines")
    dxf_version: str | None = fixed(None)

    rules = (distinct("files", "format"), distinct("studies", "study"))
