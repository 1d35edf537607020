"""The kind ``globoidal-cam``: its design, and its tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.brought import group_of
from gearcam.base.registry import DeferredMapping, deferred
from gearcam.designs.design import Design
from gearcam.designs.faults import Fault
from gearcam.designs.nodes import Choice
from gearcam.designs.outputs import DRAWINGS, MESHES, files_param, studies_param
from gearcam.designs.table import table_of
from gearcam.kinds.follower_tables import load_faults
from gearcam.kinds.shared import (
    AccuracySpec,
    ForcesSpec,
    GoalSpec,
    GriddedOutput,
)
from gearcam.laws.motion import MOTION_LAWS
from gearcam.mechanics.drive import DriveSpec
from gearcam.mechanics.gravity import GravitySpec
from gearcam.mechanics.load import FORCES
from gearcam.mechanics.material import MaterialSpec
from gearcam.parts.blank import CylinderBlank
from gearcam.results.kind import Kind
from gearcam.sheets.spec import DrawingSpec
from gearcam.spatial.globoidal_spec import (
    GloboidalSpec,
    IndexSpec,
    TurretFrictionSpec,
    TurretLoadSpec,
    TurretMassSpec,
    TurretSpec,
)

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined

NAME: Final = "globoidal-cam"
"""Name of the kind, as in a file."""


INDEX: Final = Choice(
    title="index",
    tag="law",
    what="a motion law",
    entries=MOTION_LAWS,
    own=table_of("index", IndexSpec),
    into="law",
    doc="the motion of the turret",
    others="# Other laws of the index, with example values:",
    listing="Globoidal indexing cams have the motion laws of cams, in the table [index]",
)
"""The table ``[index]``."""

_HERE: Final = "gearcam.kinds.globoidal_cam"

GLOBOIDAL_FORMATS: Final = ("svg", *MESHES, "csv", *DRAWINGS, "report")
"""What ``output.files`` may list."""

_FOLLOWED: Final = (
    "a mill as wide as the groove follows a roller: motion.csv has the angles of cam and turret"
)

_WITHOUT: Final = {
    "dxf": "the outside of a globoid cannot be unrolled into a plane",
    "step": "its solid is made of triangles, and walls.csv has exact points with normals",
    "tool-path": _FOLLOWED,
    "gcode": _FOLLOWED,
}
"""Why a file that other cams have is not made."""


def not_made(document: Mapping[str, Any]) -> Fault | None:
    """Return the fault of a file that is not made of globoidal cams, with the reason; or None."""
    output = document.get("output")
    files = output.get("files") if isinstance(output, Mapping) else None
    for number, name in enumerate(files if isinstance(files, list) else ()):
        if isinstance(name, str) and name in _WITHOUT:
            message = f'there is no "{name}" of a globoidal cam: {_WITHOUT[name]}'
            rule = ", ".join(GLOBOIDAL_FORMATS)
            return Fault(("output", "files", number), message, name, rule)
    return None


@dataclass(frozen=True, kw_only=True)
class GloboidalOutput(GriddedOutput):
    """Which files and studies of a globoidal cam are written, and how fine (see `GriddedOutput`).

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GloboidalOutput(files=("stl", "csv"), wall_points=25)
    GloboidalOutput(files=('stl', 'csv'), wall_points=25)
    """

    files: tuple[str, ...] = files_param(GLOBOIDAL_FORMATS, NAME)
    studies: tuple[str, ...] = studies_param(NAME)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class GloboidalCamDesign(Design):
    """The design of a globoidal indexing cam with its turret (see `Design`).

    Parameters
    ----------
    index : IndexSpec
        The motion of the turret in a turn of the cam.
    turret : TurretSpec
        Stops and rollers.
    cam : GloboidalSpec
        Place and length of the cam.
    drive : DriveSpec
        Speed of the cam.
    blank : CylinderBlank
        Bore and density.
    load : sequence of TurretLoadSpec
        What the turret works against.
    mass : sequence of TurretMassSpec
        Masses that turn with it.
    gravity : GravitySpec
        Direction of gravity.
    friction : TurretFrictionSpec
        Coefficients of friction, bearings.
    material : MaterialSpec
        Materials of cam and rollers.
    forces : ForcesSpec
        Settings of the study of forces.
    drawing : DrawingSpec
        What workshop drawings say beside sizes.
    output : GloboidalOutput
        Files and how fine they are.
    accuracy : AccuracySpec
        Settings of the study of error against run time.
    goal : GoalSpec
        What `gearcam optimize` looks for.

    Examples
    --------
    >>> import gearcam as gc
    >>> index = gc.IndexSpec(law=gc.motion_laws.ModifiedSine(), angle=2.0)
    >>> turret = gc.TurretSpec(stops=8, roller_radius=8.0, roller_length=14.0, reach=58.0)
    >>> size = gc.GloboidalSpec(center_distance=100.0)
    >>> gc.GloboidalCamDesign(name="mine", index=index, turret=turret, cam=size)
    <GloboidalCamDesign "mine">
    """

    kind = NAME

    spring = ()
    """No spring acts on a turret, which does not come back."""

    index: IndexSpec
    turret: TurretSpec
    cam: GloboidalSpec
    drive: DriveSpec = field(default_factory=DriveSpec)
    blank: CylinderBlank = field(default_factory=CylinderBlank)
    load: tuple[TurretLoadSpec, ...] = ()
    mass: tuple[TurretMassSpec, ...] = ()
    gravity: GravitySpec = field(default_factory=GravitySpec)
    friction: TurretFrictionSpec = field(default_factory=TurretFrictionSpec)
    material: MaterialSpec = field(default_factory=MaterialSpec)
    forces: ForcesSpec = field(default_factory=ForcesSpec)
    drawing: DrawingSpec = field(default_factory=DrawingSpec)
    output: GloboidalOutput = field(default_factory=GloboidalOutput)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    goal: GoalSpec = field(default_factory=GoalSpec)


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield contradictions between the tables of a `document` of which parts are `found`."""
    yield from load_faults(found, document, oscillating=True)


KIND: Final = Kind(
    name=NAME,
    doc="a globoidal indexing cam with its turret",
    design=GloboidalCamDesign,
    result=deferred(f"{_HERE}.result:GloboidalCamResult"),
    nodes={"index": INDEX},
    repeated={
        "cam.roller_radius_mm": "turret.roller_radius_mm",
        "indexer.stops": "turret.stops",
    },
    required=("index", "turret", "cam"),
    later=not_made,
    problems=problems,
    check_modules=(
        "gearcam.spatial.globoidal_checks",
        "gearcam.laws.row_checks",
        "gearcam.mechanics.force_checks",
    ),
    check_groups=("globoidal cams", "rows of tables", "solids of globoidal cams", FORCES),
    example={
        "index": {"law": "modified-sine", "angle_deg": 120},
        "turret": {"stops": 8, "roller_radius_mm": 6, "roller_length_mm": 11, "reach_mm": 47},
        "cam": {
            "form": "globoidal",
            "center_distance_mm": 84,
            "roller_clearance_mm": 0.05,
            "floor_clearance_mm": 0.5,
        },
        "blank": {"bore_diameter_mm": 20},
        "output": {"files": ["stl", "csv", "report"]},
    },
    samples={"goal": {"minimize": "cam.pressure_angle_deg.max", "maximize": "cam.least_rib_mm"}},
    processes={
        "printing": {
            "cam": {"roller_clearance_mm": 0.06, "floor_clearance_mm": 0.5},
            "output": {"files": ["stl", "report"], "wall_step_deg": 1},
        },
    },
    notes={
        "index": "In each turn of the cam the turret moves by one stop, then it rests.",
        "turret": "a wheel with a roller for each stop",
    },
    facts=deferred(f"{_HERE}.shown:facts"),
    files=DeferredMapping(f"{_HERE}.shown:FILES", group_of(NAME, "formats")),
    charts=DeferredMapping(f"{_HERE}.drawn:CHARTS"),
    scene=deferred(f"{_HERE}.drawn:scene"),
    sheets=deferred(f"{_HERE}.drawn:sheets"),
    ladders=DeferredMapping(f"{_HERE}.shown:LADDERS"),
    advice=deferred(f"{_HERE}.advice:GloboidalAdvice"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
