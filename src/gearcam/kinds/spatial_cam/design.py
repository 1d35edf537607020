"""The kind ``spatial-cam``: its design and its tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.brought import group_of
from gearcam.base.display import ShortRepr
from gearcam.base.quantities import ANGLE, COUNT, LENGTH, param
from gearcam.base.registry import DeferredMapping, deferred
from gearcam.designs.design import Design
from gearcam.designs.faults import Fault
from gearcam.designs.outputs import DRAWINGS, MESHES, files_param, studies_param
from gearcam.kinds.cam.public import MOTION, circumstances, measured_faults
from gearcam.kinds.follower_tables import load_faults
from gearcam.kinds.shared import (
    AccuracySpec,
    ForcesSpec,
    GoalSpec,
    GriddedOutput,
)
from gearcam.mechanics.drive import DriveSpec
from gearcam.mechanics.gravity import GravitySpec
from gearcam.mechanics.load import FORCES, LoadSpec
from gearcam.mechanics.mass import MassSpec
from gearcam.mechanics.material import MaterialSpec
from gearcam.mechanics.spring import SpringSpec
from gearcam.parts.blank import CylinderBlank
from gearcam.results.kind import Kind
from gearcam.sheets.spec import DrawingSpec
from gearcam.spatial.friction import SpaceFrictionSpec
from gearcam.spatial.spec import CylinderSpec, SpatialFollower
from gearcam.spatial.tool import MillSpec

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.kinds.cam.public import Motion

NAME: Final = "spatial-cam"
"""As in a file."""

_HERE: Final = "gearcam.kinds.spatial_cam"

SPATIAL_FORMATS: Final = (
    "dxf", "svg", *MESHES, "step", "csv", *DRAWINGS, "report", "tool-path", "gcode", "caliper",
)  # fmt: skip
"""What ``output.files`` may list."""


@dataclass(frozen=True, kw_only=True)
class SpatialOutput(GriddedOutput):
    """Which files and studies of a cam in space are written, and how fine (see `GriddedOutput`).

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SpatialOutput(files=("stl", "csv"), wall_points=25)
    SpatialOutput(files=('stl', 'csv'), wall_points=25)
    """

    files: tuple[str, ...] = files_param(SPATIAL_FORMATS, NAME)
    studies: tuple[str, ...] = studies_param(NAME)
    caliper_step: float = param(
        ANGLE, default=math.radians(1), ge=0.01, le=90, doc="step of the azimuth in caliper.csv"
    )
    path_tolerance: float = param(
        LENGTH,
        default=0.005,
        ge=5e-4,
        le=1,
        doc="how far the moves of a tool may be off its path, and how much a tool smaller than the "
        "roller may leave on walls beside that",
    )


@dataclass(frozen=True, kw_only=True)
class DevelopedSpec(ShortRepr):
    """Places of the study of walls that are constructed in the developed plane.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.DevelopedSpec(steps=720)
    DevelopedSpec(steps=720)
    """

    steps: int = param(COUNT, default=360, ge=12, le=100000, doc="number of even cam angles")
    radii: int = param(
        COUNT, default=9, ge=2, le=500, doc="radii from the roller's inner end to the outside"
    )


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SpatialCamDesign(Design):
    """The design of a cam in space with its follower (see `Design`).

    Parameters
    ----------
    motion : sequence of Phase, MotionTable or MotionFormula
        The lift over a turn of the cam.
    follower : SpatialFollower
        The roller and its guide.
    cam : CylinderSpec
        The cylinder.
    drive : DriveSpec
        Speed of the cam.
    blank : CylinderBlank
        Bore and density.
    load : sequence of LoadSpec
        What the follower works against.
    spring : sequence of SpringSpec
        Springs that press it onto the cam.
    mass : sequence of MassSpec
        Its masses.
    gravity : GravitySpec
        Direction of gravity.
    friction : SpaceFrictionSpec
        Coefficients of friction, bearings.
    material : MaterialSpec
        Materials of cam and roller.
    forces : ForcesSpec
        Settings of the study of forces.
    tool : MillSpec
        The end mill of its tool path.
    drawing : DrawingSpec
        What workshop drawings say beside sizes.
    output : SpatialOutput
        Files and how fine they are.
    developed : DevelopedSpec
        Settings of the study of the developed plane.
    accuracy : AccuracySpec
        Settings of the study of error against run time.
    goal : GoalSpec
        What `gearcam optimize` looks for.

    Examples
    --------
    >>> import gearcam as gc
    >>> motion = gc.MotionFormula(lift="10*(1 - cos(theta))")
    >>> size = gc.CylinderSpec(outer_diameter=80.0, length=60.0, lowest=20.0, groove_depth=10.0)
    >>> follower = gc.SpatialFollower(roller_radius=6.0)
    >>> gc.SpatialCamDesign(name="mine", motion=motion, follower=follower, cam=size)
    <SpatialCamDesign "mine">
    """

    kind = NAME

    motion: Motion
    follower: SpatialFollower
    cam: CylinderSpec
    drive: DriveSpec = field(default_factory=DriveSpec)
    blank: CylinderBlank = field(default_factory=CylinderBlank)
    load: tuple[LoadSpec, ...] = ()
    spring: tuple[SpringSpec, ...] = ()
    mass: tuple[MassSpec, ...] = ()
    gravity: GravitySpec = field(default_factory=GravitySpec)
    friction: SpaceFrictionSpec = field(default_factory=SpaceFrictionSpec)
    material: MaterialSpec = field(default_factory=MaterialSpec)
    forces: ForcesSpec = field(default_factory=ForcesSpec)
    tool: MillSpec = field(default_factory=MillSpec)
    drawing: DrawingSpec = field(default_factory=DrawingSpec)
    output: SpatialOutput = field(default_factory=SpatialOutput)
    developed: DevelopedSpec = field(default_factory=DevelopedSpec)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    goal: GoalSpec = field(default_factory=GoalSpec)

    def _settle(self) -> None:
        if isinstance(self.motion, Sequence) and not isinstance(self.motion, str):
            object.__setattr__(self, "motion", tuple(self.motion))


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield contradictions between the tables of a `document` of which parts are `found`."""
    yield from measured_faults(found, document, "cylinder")
    if "follower" in found.parts:
        yield from load_faults(found, document, oscillating=found.parts["follower"].oscillating)
    if "cam" in found.parts and found.parts["cam"].walls == "upper" and document.get("spring"):
        message = "does not act on a roller below its wall: springs press against a rise"
        allowed = "a table [[load]] with a force below 0, which presses it upwards"
        yield Fault(("spring", 0), message, allowed=allowed)


KIND: Final = Kind(
    name=NAME,
    doc="a cam in space with its roller",
    design=SpatialCamDesign,
    result=deferred(f"{_HERE}.result:SpatialCamResult"),
    nodes={"motion": MOTION},
    circumstances=circumstances,
    repeated={
        "cam.roller_radius_mm": "follower.roller_radius_mm",
        "cam.cone_deg": "follower.cone_deg",
    },
    required=("motion", "follower", "cam"),
    problems=problems,
    check_modules=(
        "gearcam.spatial.checks",
        "gearcam.laws.row_checks",
        "gearcam.mechanics.force_checks",
    ),
    check_groups=("cams in space", "rows of tables", "solids of cams in space", FORCES),
    example={
        "motion": [
            {"type": "rise", "angle_deg": 150, "law": "cycloidal", "lift_mm": 25},
            {"type": "dwell", "angle_deg": 30},
            {"type": "return", "angle_deg": 150, "law": "cycloidal"},
            {"type": "dwell", "angle_deg": "rest"},
        ],
        "follower": {"motion": "translating", "roller_radius_mm": 8},
        "cam": {
            "form": "cylinder",
            "outer_diameter_mm": 100,
            "length_mm": 60,
            "lowest_mm": 17,
            "groove_depth_mm": 12,
            "roller_clearance_mm": 0.05,
            "floor_clearance_mm": 0.5,
        },
        "blank": {"bore_diameter_mm": 20},
        "output": {"files": ["stl", "csv", "report"]},
    },
    samples={
        "goal": {
            "minimize": "cam.pressure_angle_deg.max",
            "maximize": "cam.largest_roller_mm.in_space",
        }
    },
    processes={
        "printing": {
            "cam": {"roller_clearance_mm": 0.08, "floor_clearance_mm": 0.5},
            "output": {"files": ["stl", "report"], "wall_step_deg": 1},
        },
        "milling": {
            "cam": {"roller_clearance_mm": 0.05, "floor_clearance_mm": 0.5},
            "tool": {"diameter_mm": 10},
            "output": {"files": ["gcode", "tool-path", "report"]},
        },
    },
    notes={"motion": "Phases of the motion, one after the other, 360 deg in all."},
    facts=deferred(f"{_HERE}.shown:facts"),
    files=DeferredMapping(f"{_HERE}.shown:FILES", group_of(NAME, "formats")),
    charts=DeferredMapping(f"{_HERE}.drawn:CHARTS"),
    scene=deferred(f"{_HERE}.drawn:scene"),
    sheets=deferred(f"{_HERE}.drawn:sheets"),
    ladders=DeferredMapping(f"{_HERE}.studies:LADDERS"),
    advice=deferred(f"{_HERE}.advice:SpatialAdvice"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
