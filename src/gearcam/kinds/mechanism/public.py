"""Public Python names of mechanisms: designs, their parts, and results."""

from __future__ import annotations

from gearcam.kinds.mechanism.build import MechanismResult
from gearcam.kinds.mechanism.design import MechanismDesign
from gearcam.kinds.mechanism.tables import (
    ChainSpec,
    CompareSpec,
    CrankSpec,
    DwellSpec,
    DyadSpec,
    GuideSpec,
    HoistSpec,
    IntervalSpec,
    JointSpec,
    MachineDrive,
    MechanismOutput,
    PointSpec,
    SlideSpec,
)
from gearcam.kinds.shared import AccuracySpec, GoalSpec

__all__ = [
    "AccuracySpec", "ChainSpec", "CompareSpec", "CrankSpec", "DwellSpec", "DyadSpec",
    "GoalSpec", "GuideSpec", "HoistSpec", "IntervalSpec",
    "JointSpec", "MachineDrive", "MechanismDesign", "MechanismOutput", "MechanismResult",
    "PointSpec", "SlideSpec",
]  # fmt: skip

PUBLIC = {name: globals()[name] for name in __all__}
