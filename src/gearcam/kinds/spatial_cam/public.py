"""Public Python names of cams in space: designs, their parts, and results."""

from __future__ import annotations

from gearcam.kinds.spatial_cam.design import DevelopedSpec, SpatialCamDesign, SpatialOutput
from gearcam.kinds.spatial_cam.result import SpatialCamResult
from gearcam.parts.blank import CylinderBlank
from gearcam.sheets.spec import DrawingSpec
from gearcam.spatial.friction import SpaceFrictionSpec
from gearcam.spatial.spec import CylinderSpec, SpatialFollower
from gearcam.spatial.tool import MillSpec

__all__ = [
    "CylinderBlank", "CylinderSpec", "DevelopedSpec", "DrawingSpec", "MillSpec",
    "SpaceFrictionSpec", "SpatialCamDesign", "SpatialCamResult", "SpatialFollower", "SpatialOutput",
]  # fmt: skip

PUBLIC = {name: globals()[name] for name in __all__}
