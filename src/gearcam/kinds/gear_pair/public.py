"""Public Python names of gear pairs: designs, their parts, and results."""

from __future__ import annotations

from gearcam.gears.spec import PairSpec, Rack, RingSpec, StepsSpec
from gearcam.kinds.gear_pair.design import BarSpec, GearPairDesign, PairOutputSpec
from gearcam.kinds.gear_pair.load_settings import StressSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.kinds.shared import AccuracySpec, ForcesSpec, GoalSpec
from gearcam.mechanics.drive import DriveSpec
from gearcam.mechanics.friction import WheelFrictionSpec
from gearcam.mechanics.material import MaterialSpec
from gearcam.mechanics.wheel_load import WheelLoadSpec
from gearcam.meshing.settings import ErrorsSpec, MeshingSpec
from gearcam.parts.blank import Blank, WheelBlank
from gearcam.sheets.spec import PairDrawingSpec

__all__ = [
    "AccuracySpec", "BarSpec", "Blank", "DriveSpec", "ErrorsSpec", "ForcesSpec", "GearPairDesign",
    "GearPairResult", "GoalSpec", "MaterialSpec", "MeshingSpec", "PairDrawingSpec",
    "PairOutputSpec", "PairSpec", "Rack", "RingSpec", "StepsSpec", "StressSpec", "WheelBlank",
    "WheelFrictionSpec", "WheelLoadSpec",
]  # fmt: skip

PUBLIC = {name: globals()[name] for name in __all__}
