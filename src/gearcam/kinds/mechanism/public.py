"""Public Python names of mechanisms: designs, their parts, and results."""

from __future__ import annotations

from gearcam.kinds.mechanism.build import MechanismResult
from gearcam.kinds.mechanism.design import MechanismDesign
from gearcam.kinds.mechanism.load_tables import (
    MachineLoad,
    MachineSpring,
    MemberMass,
    TorqueSpec,
)
from gearcam.kinds.mechanism.tables import (
    ChainSpec,
    CompareSpec,
    CrankSpec,
    DwellSpec,
    DyadSpec,
    GenevaSpec,
    GuideSpec,
    HoistSpec,
    IntervalSpec,
    JointSpec,
    MachineDrive,
    MechanismOutput,
    PointSpec,
    SlideSpec,
    StretchSpec,
)
from gearcam.kinds.shared import AccuracySpec, GoalSpec
from gearcam.mechanics.mass import GravitySpec

__all__ = [
    "AccuracySpec", "ChainSpec", "CompareSpec", "CrankSpec", "DwellSpec", "DyadSpec",
    "GenevaSpec", "GoalSpec", "GravitySpec", "GuideSpec", "HoistSpec", "IntervalSpec",
    "JointSpec", "MachineDrive", "MachineLoad", "MachineSpring", "MechanismDesign",
    "MechanismOutput", "MechanismResult", "MemberMass", "PointSpec", "SlideSpec", "StretchSpec",
    "TorqueSpec",
]  # fmt: skip

PUBLIC = {name: globals()[name] for name in __all__}
