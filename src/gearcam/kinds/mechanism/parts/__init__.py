"""The parts of mechanisms, and what acts on them: each is one class in a file of its own.

A new one is a file here, a line in `PARTS` or `ACTIONS`, and a field of `MechanismDesign`. Files
are imported when a design has their tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from gearcam.base.registry import lazy_names

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.bearing import BearingSpec as BearingSpec
    from gearcam.kinds.mechanism.parts.chain import ChainSpec as ChainSpec
    from gearcam.kinds.mechanism.parts.crank import CrankSpec as CrankSpec
    from gearcam.kinds.mechanism.parts.dyad import DyadSpec as DyadSpec
    from gearcam.kinds.mechanism.parts.friction import MachineFrictionSpec as MachineFrictionSpec
    from gearcam.kinds.mechanism.parts.geneva import GenevaSpec as GenevaSpec
    from gearcam.kinds.mechanism.parts.guide import GuideSpec as GuideSpec
    from gearcam.kinds.mechanism.parts.hoist import HoistSpec as HoistSpec
    from gearcam.kinds.mechanism.parts.joint import JointSpec as JointSpec
    from gearcam.kinds.mechanism.parts.load import MachineLoad as MachineLoad
    from gearcam.kinds.mechanism.parts.mass import MemberMass as MemberMass
    from gearcam.kinds.mechanism.parts.point import PointSpec as PointSpec
    from gearcam.kinds.mechanism.parts.slide import SlideSpec as SlideSpec
    from gearcam.kinds.mechanism.parts.spring import MachineSpring as MachineSpring

PARTS: Final[Mapping[str, str]] = {
    "joint": "JointSpec",
    "guide": "GuideSpec",
    "dyad": "DyadSpec",
    "slide": "SlideSpec",
    "hoist": "HoistSpec",
    "point": "PointSpec",
    "geneva": "GenevaSpec",
    "crank": "CrankSpec",
    "chain": "ChainSpec",
}
"""The classes of parts by the titles of their tables, which are the names of their files, in the
order of its lists, charts and facts."""

ACTIONS: Final[Mapping[str, str]] = {
    "load": "MachineLoad",
    "spring": "MachineSpring",
    "mass": "MemberMass",
}
"""The same of what acts on mechanisms, in the order of messages."""

if not TYPE_CHECKING:
    _FRICTION: Final = {"bearing": "BearingSpec", "friction": "MachineFrictionSpec"}
    __getattr__, __dir__ = lazy_names(
        "there is no part",
        dict,
        {f"{__name__}.{home}": (name,) for home, name in (PARTS | ACTIONS | _FRICTION).items()},
    )
