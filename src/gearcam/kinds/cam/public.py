"""What people who write Python make cams of."""

from __future__ import annotations

from typing import Final

from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.kinds.cam.design import CamDesign, CamOutputSpec
from gearcam.laws.motion_formula import MotionFormula
from gearcam.laws.motion_table import MotionTable
from gearcam.laws.phases_of_lift import PHASES
from gearcam.parts.blank import WheelBlank

PUBLIC: Final = (
    CamDesign, FollowerSpec, CamSpec, WheelBlank, CamOutputSpec, MotionTable, MotionFormula,
    *PHASES.values()
)  # fmt: skip
