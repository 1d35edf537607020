"""The kind ``mechanism``: its design and its tables.

Directions and angles are counter-clockwise from the x axis of the machine, which points to the
right; a point of a member is given in the member's frame, with the origin in its first joint and x
towards its second one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.brought import group_of
from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    COUNT,
    LENGTH,
    LONGEST,
    TEXT,
    fixed,
    param,
    positive_length,
)
from gearcam.base.registry import DeferredMapping, deferred
from gearcam.base.rules import Breach, distinct, needs
from gearcam.designs.design import Design
from gearcam.designs.outputs import OutputSpec, files_param, pose_param, studies_param
from gearcam.dynamics.settings import DYNAMICS, DynamicsSpec
from gearcam.kinds.mechanism import drives, names, parts
from gearcam.kinds.mechanism.asked import TABLES, DwellSpec, IntervalSpec, StretchSpec
from gearcam.kinds.mechanism.drives import CompareSpec, MachineDrive
from gearcam.kinds.mechanism.keys import NAME, Sort, WithNames, named
from gearcam.kinds.mechanism.tolerances import MachinePrecisionSpec, ToleranceSpec
from gearcam.kinds.shared import AccuracySpec, ForcesSpec, GoalSpec
from gearcam.mechanics.gravity import GravitySpec
from gearcam.mechanics.motor import MotorSpec
from gearcam.results.kind import Kind

if TYPE_CHECKING:
    from gearcam.designs.faults import Fault
    from gearcam.designs.kind import Examined

_HERE: Final = "gearcam.kinds.mechanism"

FORMATS: Final = ("csv", "dxf", "svg", "report")
"""What ``output.files`` may list."""


@dataclass(frozen=True, kw_only=True)
class TorqueSpec(ShortRepr):
    """Places at which the study ``torque`` computes moments.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.TorqueSpec(steps=360)
    TorqueSpec(steps=360)
    """

    steps: int = param(
        COUNT,
        default=720,
        ge=12,
        le=100000,
        doc="number of even steps of the master's range; both sides of knots and of the ends of "
        "loads are added",
    )


@dataclass(frozen=True, kw_only=True)
class BalanceSpec(ShortRepr):
    """Counterweights against the shaking force of a mechanism.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.BalanceSpec(counterweights=("crank", "rocker"))
    BalanceSpec(counterweights=('crank', 'rocker'))
    """

    counterweights: tuple[str, ...] | None = param(
        TEXT,
        default=None,
        min_length=1,
        example=["crank"],
        doc="members that turn about a fixed hinge and get a counterweight",
    )
    direction: float | None = param(
        ANGLE,
        default=None,
        ge=-360,
        le=360,
        example=90,
        doc="direction in which the force is to be least; in all if left out",
    )
    radius: float | None = positive_length(
        example=60, doc="distance of the counterweights from their hinges, for the moment"
    )
    harmonics: int = param(COUNT, default=6, ge=1, le=100, doc="highest harmonic in the summary")
    steps: int = param(COUNT, default=720, ge=12, le=100000, doc="even steps of the range")

    rules = (
        distinct("counterweights", "member"),
        needs("direction", "counterweights"),
        needs("radius", "counterweights"),
    )


@dataclass(frozen=True, kw_only=True)
class RotorSpec(WithNames):
    """Members, wheels and cams that turn together, to be balanced by weights in two planes.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.RotorSpec(name="shaft", parts=("crank", "cam.shaft"), places=(40.0, 110.0),
    ...              planes=(20.0, 220.0))
    RotorSpec(name='shaft', parts=('crank', 'cam.shaft'), places=(40, 110), planes=(20, 220))
    """

    name: str = named(doc="its name in the summary", example="camshaft")
    parts: tuple[str, ...] = named(
        needs=f"{Sort.MEMBER} or {Sort.SHAFT}",
        example=["crank", "pair.wheel1"],
        doc="members about one fixed axis, and wheels or cams of drives, that turn together",
    )
    places: tuple[float, ...] = param(
        LENGTH,
        ge=-LONGEST,
        le=LONGEST,
        example=[40, 110],
        doc="where each is along the axis, towards the viewer: of a member its masses, of a wheel "
        "or a cam the back of its plate",
    )
    planes: tuple[float, float] = param(
        LENGTH,
        ge=-LONGEST,
        le=LONGEST,
        order="first and second",
        example=[20, 220],
        doc="where the weights are along the axis",
    )
    radius: float | None = positive_length(
        example=60, doc="distance of the weights from the axis, for their masses"
    )

    rules = (distinct("parts", "part"),)

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if len(self.places) != len(self.parts):
            count = len(self.parts)
            yield "places", None, f"has {len(self.places)} for {count} parts", "one for each part"
        if abs(self.planes[1] - self.planes[0]) < LENGTH.least:
            apart = f"{formatted(LENGTH.least)} mm apart or more"
            yield "planes", 1, "is in the place of the first plane", apart


@dataclass(frozen=True, kw_only=True)
class MechanismOutput(OutputSpec):
    """Which files of a mechanism are written, and what is in them (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        The master's angle in the picture.
    studies : tuple of str
        Its studies.

    Attributes
    ----------
    kerf, dxf_curves, dxf_version
        Nothing is cut out.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MechanismOutput(files=("csv", "svg"), outputs=("slide", "rod.angle"))
    MechanismOutput(files=('csv', 'svg'), outputs=('slide', 'rod.angle'))
    """

    files: tuple[str, ...] = files_param(FORMATS, NAME)
    studies: tuple[str, ...] = studies_param(NAME)
    outputs: tuple[str, ...] | None = param(
        TEXT,
        default=None,
        min_length=1,
        example=["slide", "rod.angle"],
        doc="joints that slide, points or one coordinate as P.x, and directions as member.angle; "
        "if left out every slide and point, or without any the direction of the last member",
    )
    step: float = param(
        ANGLE,
        default=math.radians(1.0),
        gt=0,
        le=90,
        doc="step of the master's angle in motion.csv",
    )
    pose: float = pose_param("q", "the master's angle in the picture")
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=1e-6,
        example=0.01,
        doc="largest distance of a drawn path from the true one; 0.01 mm if left out",
    )

    kerf: float = fixed(0.0)
    dxf_curves: str = fixed("lines")
    dxf_version: str | None = fixed(None)

    rules = (
        distinct("files", "format"),
        distinct("studies", "study"),
        distinct("outputs", "output"),
    )


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
    bearing : sequence of BearingSpec
        Friction of single hinges and guides.
    friction : MachineFrictionSpec
        Friction of all others.
    gravity : GravitySpec
        The direction of gravity.
    forces : ForcesSpec
        Settings of the study of the forces in joints.
    tolerance : sequence of ToleranceSpec
        Tolerances of single dimensions.
    precision : MachinePrecisionSpec
        Tolerances of all others, clearance, and random machines.
    balance : BalanceSpec
        Counterweights.
    rotor : sequence of RotorSpec
        What is balanced in two planes.
    torque : TorqueSpec
        Settings of the study of the driver's moment.
    motor : MotorSpec
        What turns the driver.
    dynamics : DynamicsSpec
        Settings of the study of dynamics.
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

    drive: tuple[MachineDrive, ...]
    compare: tuple[CompareSpec, ...] = ()
    joint: tuple[parts.JointSpec, ...] = ()
    crank: tuple[parts.CrankSpec, ...] = ()
    slide: tuple[parts.SlideSpec, ...] = ()
    guide: tuple[parts.GuideSpec, ...] = ()
    dyad: tuple[parts.DyadSpec, ...] = ()
    point: tuple[parts.PointSpec, ...] = ()
    chain: tuple[parts.ChainSpec, ...] = ()
    hoist: tuple[parts.HoistSpec, ...] = ()
    geneva: tuple[parts.GenevaSpec, ...] = ()
    stretch: tuple[StretchSpec, ...] = ()
    interval: tuple[IntervalSpec, ...] = ()
    dwell: tuple[DwellSpec, ...] = ()
    load: tuple[parts.MachineLoad, ...] = ()
    mass: tuple[parts.MemberMass, ...] = ()
    spring: tuple[parts.MachineSpring, ...] = ()
    bearing: tuple[parts.BearingSpec, ...] = ()
    friction: parts.MachineFrictionSpec = field(default_factory=parts.MachineFrictionSpec)
    gravity: GravitySpec = field(default_factory=GravitySpec)
    forces: ForcesSpec = field(default_factory=ForcesSpec)
    tolerance: tuple[ToleranceSpec, ...] = ()
    precision: MachinePrecisionSpec = field(default_factory=MachinePrecisionSpec)
    balance: BalanceSpec = field(default_factory=BalanceSpec)
    rotor: tuple[RotorSpec, ...] = ()
    torque: TorqueSpec = field(default_factory=TorqueSpec)
    motor: MotorSpec = field(default_factory=MotorSpec)
    dynamics: DynamicsSpec = field(default_factory=DynamicsSpec)
    output: MechanismOutput = field(default_factory=MechanismOutput)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    goal: GoalSpec = field(default_factory=GoalSpec)


def _problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    faults = [*drives.problems(found), *names.problems(document, found)]
    faults += names.unasked(document, found)
    yield from faults
    yield from names.unfit(found, faults)


KIND: Final = Kind(
    name=NAME,
    doc="a linkage that a pair, a cam or an even shaft drives",
    also=("linkage", "linkages", "four-bar", "machine"),
    design=MechanismDesign,
    result=deferred(f"{_HERE}.result:MechanismResult"),
    required=("drive",),
    problems=_problems,
    check_modules=(
        "gearcam.linkages.checks",
        f"{_HERE}.parts.hoist",  # and those of chains
        f"{_HERE}.torque",
        f"{_HERE}.force_checks",
        f"{_HERE}.precision_checks",
        "gearcam.dynamics.checks",
    ),
    check_groups=(
        "mechanisms",
        TABLES,
        "torque of a mechanism",
        "forces of a mechanism",
        "precision of a mechanism",
        DYNAMICS,
    ),
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
    samples={
        "goal": {"minimize": "outputs.P_x.acceleration_mm_s2", "maximize": "outputs.P_x.stroke_mm"}
    },
    facts=deferred(f"{_HERE}.shown:facts"),
    files=DeferredMapping(f"{_HERE}.shown:FILES", group_of(NAME, "formats")),
    charts=DeferredMapping(f"{_HERE}.charts:CHARTS"),
    scene=deferred(f"{_HERE}.drawn:scene"),
    ladders=DeferredMapping(f"{_HERE}.drawn:LADDERS"),
    advice=deferred(f"{_HERE}.advice:MechanismAdvice"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
    brought=group_of(NAME, "parts"),
    cut=False,
)
