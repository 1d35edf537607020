"""The kind ``mechanism``: its design and its tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.registry import DeferredMapping, deferred
from gearcam.designs.design import Design
from gearcam.kinds.mechanism import load_names, names, outputs, unfit_drives
from gearcam.kinds.mechanism.keys import NAME
from gearcam.kinds.mechanism.load_tables import MachineLoad, MachineSpring, MemberMass, TorqueSpec
from gearcam.kinds.mechanism.tables import (
    FORMATS,
    STUDIES,
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
from gearcam.kinds.mechanism.torque_checks import TORQUE
from gearcam.kinds.shared import AccuracySpec, GoalSpec
from gearcam.mechanics.mass import GravitySpec
from gearcam.results.kind import Kind

if TYPE_CHECKING:
    from gearcam.designs.faults import Fault
    from gearcam.designs.kind import Examined
    from gearcam.kinds.mechanism.build import MechanismResult


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class MechanismDesign(Design):
    """The design of a mechanism (see `Design`).

    Parameters
    ----------
    drive : sequence of MachineDrive
        What moves it; the first one is the master.
    compare : sequence of CompareSpec
        Other drives in the place of the first one.
    joint : sequence of JointSpec
        Joints that stand still.
    crank : sequence of CrankSpec
        Members on shafts.
    slide : sequence of SlideSpec
        Members that are pushed.
    guide : sequence of GuideSpec
        Straight guides.
    dyad : sequence of DyadSpec
        Pairs of members that close a loop.
    point : sequence of PointSpec
        Points of members.
    chain : sequence of ChainSpec
        Chains that swing a lever.
    hoist : sequence of HoistSpec
        What wheels lift.
    geneva : sequence of GenevaSpec
        Geneva wheels.
    stretch : sequence of StretchSpec
        Stretches of paths that are to be straight or round.
    interval : sequence of IntervalSpec
        The last bits of travel before dead centres.
    dwell : sequence of DwellSpec
        Dwells that are wanted.
    load : sequence of MachineLoad
        What it works against.
    mass : sequence of MemberMass
        Masses of its members.
    spring : sequence of MachineSpring
        Its springs and dampers.
    gravity : GravitySpec
        The direction of gravity.
    torque : TorqueSpec
        Settings of the study of the driver's moment.
    output : MechanismOutput
        Files and what is in them.
    accuracy : AccuracySpec
        Settings of the study of error against run time.
    goal : GoalSpec
        What `gearcam optimize` looks for.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MechanismDesign(
    ...     name="mine",
    ...     drive=[gc.MachineDrive(name="motor", even=True)],
    ...     crank=[gc.CrankSpec(name="crank", on="motor", joint="B", length=40.0)],
    ... )
    <MechanismDesign "mine">
    """

    kind = NAME

    if TYPE_CHECKING:

        @property
        def _built(self) -> MechanismResult: ...

    drive: tuple[MachineDrive, ...]
    compare: tuple[CompareSpec, ...] = ()
    joint: tuple[JointSpec, ...] = ()
    crank: tuple[CrankSpec, ...] = ()
    slide: tuple[SlideSpec, ...] = ()
    guide: tuple[GuideSpec, ...] = ()
    dyad: tuple[DyadSpec, ...] = ()
    point: tuple[PointSpec, ...] = ()
    chain: tuple[ChainSpec, ...] = ()
    hoist: tuple[HoistSpec, ...] = ()
    geneva: tuple[GenevaSpec, ...] = ()
    stretch: tuple[StretchSpec, ...] = ()
    interval: tuple[IntervalSpec, ...] = ()
    dwell: tuple[DwellSpec, ...] = ()
    load: tuple[MachineLoad, ...] = ()
    mass: tuple[MemberMass, ...] = ()
    spring: tuple[MachineSpring, ...] = ()
    gravity: GravitySpec = field(default_factory=GravitySpec)
    torque: TorqueSpec = field(default_factory=TorqueSpec)
    output: MechanismOutput = field(default_factory=MechanismOutput)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    goal: GoalSpec = field(default_factory=GoalSpec)


_HERE: Final = "gearcam.kinds.mechanism"


def _problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    faults = [*unfit_drives.problems(found), *names.problems(document, found)]
    faults += outputs.problems(document, found)
    yield from faults
    yield from load_names.problems(found, faults)


KIND: Final = Kind(
    name=NAME,
    doc="a linkage that a pair, a cam or an even shaft drives",
    also=("linkage", "linkages", "four-bar", "machine"),
    design=MechanismDesign,
    result=deferred(f"{_HERE}.build:MechanismResult"),
    required=("drive",),
    problems=_problems,
    formats=FORMATS,
    check_modules=("gearcam.linkages.checks", f"{_HERE}.checks", f"{_HERE}.torque_checks"),
    check_groups=("mechanisms", "tables of mechanisms", TORQUE),
    study_tables={name: name for name in STUDIES},
    example={
        "drive": [{"name": "motor", "even": True, "speed_rpm": 60}],
        "joint": [{"name": "D", "at_mm": [110, 0]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 30}],
        "dyad": [
            {
                "type": "RRR",
                "from": "B",
                "to": "D",
                "joint": "C",
                "members": ["coupler", "rocker"],
                "lengths_mm": [100, 90],
            }
        ],
        "point": [{"name": "P", "on": "coupler", "at_mm": [49, 34]}],
        "output": {"files": ["csv", "report"]},
    },
    shown={
        "goal": {
            "minimize": "outputs.P_x.acceleration_mm_s2",
            "maximize": "outputs.P_x.stroke_mm",
        }
    },
    facts=deferred(f"{_HERE}.facts:facts"),
    files=DeferredMapping(f"{_HERE}.files:FILES"),
    charts=DeferredMapping(f"{_HERE}.charts:CHARTS"),
    scene=deferred(f"{_HERE}.scene:scene"),
    studies=DeferredMapping(f"{_HERE}.studies:STUDIES"),
    ladders=DeferredMapping(f"{_HERE}.ladder:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
    cut=False,
)
