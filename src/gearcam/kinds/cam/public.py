"""Public Python names of cams: designs, their parts, and results."""

from __future__ import annotations

from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.kinds.cam.blank import CamBlank
from gearcam.kinds.cam.build import CamResult
from gearcam.kinds.cam.design import CamDesign, CamOutputSpec, FollowSpec
from gearcam.kinds.shared import AccuracySpec
from gearcam.laws.motion_formula import MotionFormula
from gearcam.laws.motion_table import MotionTable
from gearcam.laws.phases_of_lift import DwellPhase, ReturnPhase, RisePhase, SegmentPhase
from gearcam.parts.blank import WheelBlank

__all__ = [
    "AccuracySpec", "CamBlank", "CamDesign", "CamOutputSpec", "CamResult", "CamSpec", "DwellPhase",
    "FollowSpec", "FollowerSpec", "MotionFormula", "MotionTable", "ReturnPhase", "RisePhase",
    "SegmentPhase", "WheelBlank",
]  # fmt: skip

PUBLIC = {name: globals()[name] for name in __all__}
