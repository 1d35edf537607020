"""Public Python names of cams: designs, their parts, and results."""

from __future__ import annotations

from gearcam.cams.spec import CamSpec, FollowerSpec, PlateFollower
from gearcam.kinds.cam.design import CamDesign
from gearcam.kinds.cam.forms.base import lift_program as lift_program
from gearcam.kinds.cam.forms.conjugate import ConjugateFollower, ConjugateSpec
from gearcam.kinds.cam.forms.groove import GrooveBlank, GrooveFollower, GrooveSpec
from gearcam.kinds.cam.forms.translating import PlateBlank, PlateOutput, PlateSpec
from gearcam.kinds.cam.forms.yoke import YokeFollower, YokeSpec
from gearcam.kinds.cam.motion import MOTION as MOTION
from gearcam.kinds.cam.motion import Motion as Motion
from gearcam.kinds.cam.motion import circumstances as circumstances
from gearcam.kinds.cam.motion import measured_faults as measured_faults
from gearcam.kinds.cam.result import CamResult
from gearcam.kinds.cam.tables import (
    BoundsSpec,
    CamBlank,
    CamOutputSpec,
    FollowerDynamicsSpec,
    FollowSpec,
    PrecisionSpec,
)
from gearcam.kinds.shared import AccuracySpec, ForcesSpec, GoalSpec
from gearcam.laws.motion_formula import MotionFormula
from gearcam.laws.motion_table import MotionTable
from gearcam.laws.phases_of_lift import DwellPhase, ReturnPhase, RisePhase, SegmentPhase
from gearcam.mechanics.drive import CamDriveSpec, SlideDriveSpec
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.gravity import GravitySpec
from gearcam.mechanics.load import LoadSpec, SlideLoadSpec
from gearcam.mechanics.mass import MassSpec
from gearcam.mechanics.material import MaterialSpec
from gearcam.mechanics.spring import SpringSpec
from gearcam.sheets.spec import DrawingSpec

__all__ = [
    "AccuracySpec", "BoundsSpec", "CamBlank", "CamDesign", "CamDriveSpec", "CamOutputSpec",
    "CamResult", "CamSpec", "ConjugateFollower", "ConjugateSpec", "DrawingSpec", "DwellPhase",
    "FollowSpec", "FollowerDynamicsSpec", "FollowerSpec", "ForcesSpec", "FrictionSpec", "GoalSpec",
    "GravitySpec", "GrooveBlank", "GrooveFollower", "GrooveSpec", "LoadSpec", "MassSpec",
    "MaterialSpec", "MotionFormula", "MotionTable", "PlateBlank", "PlateFollower", "PlateOutput",
    "PlateSpec", "PrecisionSpec", "ReturnPhase", "RisePhase", "SegmentPhase", "SlideDriveSpec",
    "SlideLoadSpec", "SpringSpec", "YokeFollower", "YokeSpec",
]  # fmt: skip

PUBLIC = {name: globals()[name] for name in __all__}
