"""Public Python names of mechanisms: designs, their parts, and results."""

from __future__ import annotations

from gearcam.kinds.mechanism import parts
from gearcam.kinds.mechanism.asked import DwellSpec, IntervalSpec, StretchSpec
from gearcam.kinds.mechanism.design import (
    BalanceSpec,
    MechanismDesign,
    MechanismOutput,
    RotorSpec,
    TorqueSpec,
)
from gearcam.kinds.mechanism.drives import CompareSpec, MachineDrive
from gearcam.kinds.mechanism.parts.bearing import BearingSpec
from gearcam.kinds.mechanism.parts.friction import MachineFrictionSpec
from gearcam.kinds.mechanism.result import MechanismResult
from gearcam.kinds.mechanism.tolerances import MachinePrecisionSpec, ToleranceSpec
from gearcam.kinds.shared import AccuracySpec, ForcesSpec, GoalSpec
from gearcam.mechanics.gravity import GravitySpec

__all__ = [
    "AccuracySpec",
    "BalanceSpec",
    "BearingSpec",
    "CompareSpec",
    "DwellSpec",
    "ForcesSpec",
    "GoalSpec",
    "GravitySpec",
    "IntervalSpec",
    "MachineDrive",
    "MachineFrictionSpec",
    "MachinePrecisionSpec",
    "MechanismDesign",
    "MechanismOutput",
    "MechanismResult",
    "RotorSpec",
    "StretchSpec",
    "ToleranceSpec",
    "TorqueSpec",
]

PUBLIC = {name: globals()[name] for name in __all__}
PUBLIC |= {name: getattr(parts, name) for name in (*parts.PARTS.values(), *parts.ACTIONS.values())}
