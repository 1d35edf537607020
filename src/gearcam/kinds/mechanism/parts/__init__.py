"""The parts of mechanisms, and what acts on them: each is one class in a file of its own.

A new one is a file here, a line in `PARTS` or `ACTIONS`, and a field of `MechanismDesign`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gearcam.kinds.mechanism.parts.action import MachineAction
from gearcam.kinds.mechanism.parts.chain import ChainSpec
from gearcam.kinds.mechanism.parts.crank import CrankSpec
from gearcam.kinds.mechanism.parts.dyad import DyadSpec
from gearcam.kinds.mechanism.parts.friction import BearingSpec, MachineFrictionSpec
from gearcam.kinds.mechanism.parts.geneva import GenevaSpec
from gearcam.kinds.mechanism.parts.guide import GuideSpec
from gearcam.kinds.mechanism.parts.hoist import HoistSpec
from gearcam.kinds.mechanism.parts.joint import JointSpec
from gearcam.kinds.mechanism.parts.load import MachineLoad
from gearcam.kinds.mechanism.parts.mass import MemberMass
from gearcam.kinds.mechanism.parts.part import MachinePart
from gearcam.kinds.mechanism.parts.point import PointSpec
from gearcam.kinds.mechanism.parts.slide import SlideSpec
from gearcam.kinds.mechanism.parts.spring import MachineSpring

__all__ = [
    "BearingSpec",
    "ChainSpec",
    "CrankSpec",
    "DyadSpec",
    "GenevaSpec",
    "GuideSpec",
    "HoistSpec",
    "JointSpec",
    "MachineFrictionSpec",
    "MachineLoad",
    "MachineSpring",
    "MemberMass",
    "PointSpec",
    "SlideSpec",
]

PARTS: Final[Mapping[str, type[MachinePart]]] = {
    "joint": JointSpec,
    "guide": GuideSpec,
    "dyad": DyadSpec,
    "slide": SlideSpec,
    "hoist": HoistSpec,
    "point": PointSpec,
    "geneva": GenevaSpec,
    "crank": CrankSpec,
    "chain": ChainSpec,
}
"""The parts by the titles of their tables, in the order of its lists, charts and facts."""

ACTIONS: Final[Mapping[str, type[MachineAction]]] = {
    "load": MachineLoad,
    "spring": MachineSpring,
    "mass": MemberMass,
}
"""What acts on mechanisms, by the titles of their tables, in the order of messages."""
