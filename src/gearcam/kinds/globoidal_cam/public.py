"""Public Python names of globoidal cams: designs, their parts, and results."""

from __future__ import annotations

from gearcam.kinds.globoidal_cam.design import GloboidalCamDesign, GloboidalOutput
from gearcam.kinds.globoidal_cam.result import GloboidalCamResult
from gearcam.sheets.spec import DrawingSpec
from gearcam.spatial.globoidal_spec import (
    GloboidalSpec,
    IndexSpec,
    TurretFrictionSpec,
    TurretLoadSpec,
    TurretMassSpec,
    TurretSpec,
)

__all__ = [
    "DrawingSpec", "GloboidalCamDesign", "GloboidalCamResult", "GloboidalOutput", "GloboidalSpec",
    "IndexSpec", "TurretFrictionSpec", "TurretLoadSpec", "TurretMassSpec", "TurretSpec",
]  # fmt: skip

PUBLIC = {name: globals()[name] for name in __all__}
