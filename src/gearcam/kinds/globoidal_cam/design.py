"""The kind ``globoidal-cam``: its design, its tables, and how ``[index]`` is read with its law."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.registry import DeferredMapping, classes_in, deferred, name_of
from gearcam.designs.design import Design, Wanted
from gearcam.designs.examine import chosen, home_of
from gearcam.designs.faults import MISSING, Fault, quoted, show
from gearcam.designs.kind import KINDS, Examined, Main
from gearcam.designs.outputs import files_param, studies_param
from gearcam.designs.table import Table, table_of
from gearcam.designs.validate import faults_of, parameters_of
from gearcam.kinds.shared import AccuracySpec, GoalSpec, GriddedOutput
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.mechanics.drive import DriveSpec
from gearcam.results.kind import Kind
from gearcam.spatial.globoidal_spec import GloboidalSpec, IndexSpec, TurretSpec
from gearcam.spatial.spec import CylinderBlank

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.result import GloboidalCamResult

TITLE: Final = "index"
NAME: Final = "globoidal-cam"
"""Name of the kind, as in a file."""


def law_table(law: str) -> Table:
    """Return the table of a law's parameters."""
    return table_of(TITLE, MOTION_LAWS[law].parameters)


def index_table(law: str) -> Table:
    """Return the table for a law, without the key ``law``."""
    own = table_of(TITLE, IndexSpec)
    return Table(TITLE, None, {**own.entries, **law_table(law).entries})


def examine_index(document: Mapping[str, Any], found: Examined) -> None:
    """Examine the index of a document.

    Parameters
    ----------
    document : mapping
        As read from TOML.
    found : Examined
        Gets the faults, or ``index``.
    """
    raw = document.get(TITLE, MISSING)
    if not isinstance(raw, Mapping):
        lacks = raw is MISSING
        message = f"the table [{TITLE}] is missing" if lacks else f"{show(raw)} is not a table"
        rule = f"[{TITLE}] with angle_deg and law = {quoted(MOTION_LAWS)}"
        found.faults.append(Fault((TITLE,), message, raw, rule))
        return
    law, right = chosen((TITLE,), raw, "law", "a motion law", MOTION_LAWS, found)
    if not law:
        return
    known, own, shape = index_table(law), table_of(TITLE, IndexSpec), law_table(law)
    rest = {key: value for key, value in raw.items() if key != "law"}
    faults = list(
        faults_of(known, rest, home=partial(home_of, KINDS[NAME]), listed=["law", *known.entries])
    )
    if not right:  # what is missing is reported once the law is known
        found.faults += [fault for fault in faults if fault.path[1] in rest]
        return
    parameters, problems = parameters_of(
        shape, MOTION_LAWS[law].parameters, _only(rest, shape), faults, (TITLE,)
    )
    make = partial(IndexSpec, law=parameters)
    made, more = parameters_of(own, make, _only(rest, own), faults, (TITLE,))
    found.faults += [*faults, *problems, *more]
    if made is not None and not (faults or problems or more):
        found.parts[TITLE] = made


def _only(raw: Mapping[str, Any], table: Table) -> dict[str, Any]:
    return {key: value for key, value in raw.items() if key in table.entries}


def index_document(design: Any) -> dict[str, Any]:
    """Return the table of a `design` as in a file."""
    given, law = design.index, name_of(MOTION_LAWS, design.index.law)
    own = table_of(TITLE, IndexSpec).document(given)
    return {"law": law, **own, **law_table(law).document(given.law)}


def known(raw: Mapping[str, Any]) -> Table:
    """Return the table as it is in a file."""
    return index_table(raw["law"])


def words() -> dict[str, Collection[str]]:
    """Return the laws, by the key that chooses them."""
    return {f"{TITLE}.law": MOTION_LAWS.keys()}


def homes() -> dict[str, str]:
    """Return hints by key that say which laws have it."""
    laws: dict[str, list[str]] = {}
    for law in MOTION_LAWS:
        for key in law_table(law).entries:
            laws.setdefault(key, []).append(law)
    found = {
        key: f"this key belongs under [{TITLE}] with law = {quoted(names)}"
        for key, names in laws.items()
    }
    own = ("law", *table_of(TITLE, IndexSpec).entries)
    return found | dict.fromkeys(own, f"this key belongs under [{TITLE}]")


GLOBOIDAL_FORMATS: Final = ("svg", "stl", "3mf", "glb", "csv", "report")
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

    files: tuple[str, ...] = files_param(GLOBOIDAL_FORMATS)
    studies: tuple[str, ...] = studies_param(("accuracy",))


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

    if TYPE_CHECKING:

        @property
        def _built(self) -> GloboidalCamResult: ...

    index: IndexSpec
    turret: TurretSpec
    cam: GloboidalSpec
    drive: DriveSpec = field(default_factory=DriveSpec)
    blank: CylinderBlank = field(default_factory=CylinderBlank)
    output: GloboidalOutput = field(default_factory=GloboidalOutput)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    goal: GoalSpec = field(default_factory=GoalSpec)

    def _wanted(self) -> Iterator[Wanted]:
        yield TITLE, self.index, (IndexSpec,)
        if isinstance(self.index, IndexSpec):
            laws = tuple(classes_in(MOTION_LAWS).values())
            yield f"{TITLE}.law", self.index.law, laws


_HERE: Final = "gearcam.kinds.globoidal_cam"

KIND: Final = Kind(
    name=NAME,
    doc="a globoidal indexing cam with its turret",
    design=GloboidalCamDesign,
    result=deferred(f"{_HERE}.result:GloboidalCamResult"),
    main=Main(
        title=TITLE,
        examine=examine_index,
        document=index_document,
        table=known,
        homes=homes,
        schema=deferred(f"{_HERE}.describe:schema"),
        template=deferred(f"{_HERE}.describe:lines"),
        laws=deferred(f"{_HERE}.describe:laws"),
        words=words,
    ),
    required=("turret", "cam"),
    later=not_made,
    formats=GLOBOIDAL_FORMATS,
    check_modules=("gearcam.spatial.globoidal_checks", "gearcam.laws.row_checks"),
    check_groups=("globoidal cams", "rows of tables", "solids of globoidal cams"),
    study_tables={"accuracy": "accuracy"},
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
    shown={"goal": {"minimize": "cam.pressure_angle_deg.max", "maximize": "cam.least_rib_mm"}},
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
    files=DeferredMapping(f"{_HERE}.shown:FILES"),
    charts=DeferredMapping(f"{_HERE}.drawn:CHARTS"),
    scene=deferred(f"{_HERE}.drawn:scene"),
    studies=DeferredMapping(f"{_HERE}.studies:STUDIES"),
    ladders=DeferredMapping(f"{_HERE}.studies:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
