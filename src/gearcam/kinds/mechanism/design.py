"""The kind ``mechanism``: its design and its tables."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from gearcam.designs.design import Design
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

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

NAME: Final = "mechanism"
"""As in a file."""


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
