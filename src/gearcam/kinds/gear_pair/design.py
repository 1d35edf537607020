"""The kind ``gear-pair``: its design, its tables, and the rules between them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, fields
from typing import Any, Final, TypeGuard

from gearcam.base.brought import group_of
from gearcam.base.errors import GearcamError
from gearcam.base.quantities import COUNT, LENGTH, LONGEST, NONE, param
from gearcam.base.registry import DeferredMapping, deferred
from gearcam.base.rules import Breach, Rule, Values, at_most, only_with
from gearcam.designs.design import Design
from gearcam.designs.faults import Fault, show
from gearcam.designs.kind import Examined
from gearcam.designs.nodes import Choice
from gearcam.designs.outputs import FORMATS, OutputSpec, files_param, pose_param, studies_param
from gearcam.designs.table import table_of
from gearcam.dynamics.settings import DYNAMICS, VIBRATION, PairDynamicsSpec
from gearcam.gears.spec import Bar, PairSpec, Rack, RingSpec, StepsSpec
from gearcam.gears.subject import KIND as TEETH
from gearcam.kinds.gear_pair.load_settings import StressSpec
from gearcam.kinds.shared import AccuracySpec, ForcesSpec, GoalSpec
from gearcam.laws.ratio import LAWS
from gearcam.mechanics.drive import DriveSpec
from gearcam.mechanics.friction import WheelFrictionSpec
from gearcam.mechanics.material import MaterialSpec
from gearcam.mechanics.motor import MotorSpec
from gearcam.mechanics.wheel_load import WheelLoadSpec
from gearcam.meshing.settings import (
    DYNAMIC_FORCES,
    ERRORS,
    FORCES,
    STRESS,
    TRIALS,
    ErrorsSpec,
    MeshingSpec,
)
from gearcam.meshing.settings import KIND as MESHING
from gearcam.parts.blank import KIND as PARTS
from gearcam.parts.blank import Blank, RowBlank, serving
from gearcam.results.kind import Kind
from gearcam.sheets.spec import PairDrawingSpec

NAME: Final = "gear-pair"
"""As in a file."""

_HERE: Final = "gearcam.kinds.gear_pair"

_OF_SHAFT: Final = ("bore_diameter", "shaft", "hub_diameter", "lightening_holes", "stop_pin")
"""What a ring does not have."""

_OF_HOLES: Final = (*_OF_SHAFT, "bolts")
"""What a rack does not have."""

_COARSEST: Final = 50
"""Largest chord tolerance is the module over this: a coarser one does not show the teeth."""


@dataclass(frozen=True, kw_only=True)
class PairOutputSpec(OutputSpec):
    """Which files and studies of a pair are written, and how exact (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        Driver angle of the assembly drawing.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PairOutputSpec(files=("dxf", "csv"), chord_tolerance=0.005)
    PairOutputSpec(files=('dxf', 'csv'), chord_tolerance=0.005)
    """

    files: tuple[str, ...] = files_param(FORMATS, NAME)
    studies: tuple[str, ...] = studies_param(NAME)
    pose: float = pose_param("phi1", "driver angle of the assembly drawing")
    inspection_points: int = param(
        COUNT, default=9, ge=2, le=1000, doc="number of points on each flank in inspection.csv"
    )
    pin_diameter: tuple[float, float] | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        both=True,
        example=[3.5, 3.5],
        doc="diameter of the pins or balls in measures.csv; a simple size that suits all tooth "
        "spaces if left out",
    )


@dataclass(frozen=True, kw_only=True)
class BarSpec(Bar, RowBlank):
    """What a rack is made from: its height, its ends, a row of mounting holes.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.BarSpec(height=20.0, ends="gap", bolts=1, bolt_diameter=5.0, bolt_height=6.0)
    BarSpec(height=20, bolts=1, bolt_diameter=5, bolt_height=6, ends='gap')
    """


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class GearPairDesign(Design):
    """The design of a pair of non-circular gears (see `Design`).

    Parameters
    ----------
    law : object
        The law's parameters, such as `gearcam.laws.Ellipse`.
    pair : PairSpec
        Centre distance or module, tooth counts, width.
    drive : DriveSpec
        Speed of the driver.
    rack : Rack
        The basic rack.
    blank : Blank
        Bores, hubs, holes, marks, edges, density.
    ring : RingSpec
        The metal around the teeth of a ring, and its cutter.
    bar : BarSpec
        What a rack is made from: height, ends, mounting holes.
    steps : StepsSpec
        Steps of stepped wheels.
    drawing : PairDrawingSpec
        What workshop drawings say beside sizes.
    output : PairOutputSpec
        Files and their tolerance.
    meshing : MeshingSpec
        Phases and mounting of a meshing study.
    errors : ErrorsSpec
        Errors of mounting and making, for their study.
    load : sequence of WheelLoadSpec
        Loads on the driven element, or torques of the driver.
    friction : WheelFrictionSpec
        Coefficients of friction, bearings.
    material : MaterialSpec
        Elasticity and strength of both wheels.
    forces : ForcesSpec
        Phases of the study of forces.
    stress : StressSpec
        Settings of the study of stress.
    motor : MotorSpec
        What turns the driver.
    dynamics : PairDynamicsSpec
        Settings of the study of dynamics.
    goal : GoalSpec
        What `gearcam optimize` seeks.
    accuracy : AccuracySpec
        Settings of the study of error against run time.

    Examples
    --------
    >>> import gearcam as gc
    >>> pair = gc.PairSpec(teeth=(20, 20), module=2.0)
    >>> gc.GearPairDesign(name="mine", law=gc.laws.Ellipse(eccentricity=0.3), pair=pair)
    <GearPairDesign "mine">
    """

    kind = NAME

    law: Any
    pair: PairSpec
    drive: DriveSpec = field(default_factory=DriveSpec)
    rack: Rack = field(default_factory=Rack)
    blank: Blank = field(default_factory=Blank)
    ring: RingSpec = field(default_factory=RingSpec)
    bar: BarSpec = field(default_factory=BarSpec)
    steps: StepsSpec = field(default_factory=StepsSpec)
    drawing: PairDrawingSpec = field(default_factory=PairDrawingSpec)
    output: PairOutputSpec = field(default_factory=PairOutputSpec)
    meshing: MeshingSpec = field(default_factory=MeshingSpec)
    errors: ErrorsSpec = field(default_factory=ErrorsSpec)
    load: tuple[WheelLoadSpec, ...] = ()
    friction: WheelFrictionSpec = field(default_factory=WheelFrictionSpec)
    material: MaterialSpec = field(default_factory=MaterialSpec)
    forces: ForcesSpec = field(default_factory=ForcesSpec)
    stress: StressSpec = field(default_factory=StressSpec)
    motor: MotorSpec = field(default_factory=MotorSpec)
    dynamics: PairDynamicsSpec = field(default_factory=PairDynamicsSpec)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    goal: GoalSpec = field(default_factory=GoalSpec)

    @property
    def back(self) -> RingSpec | Bar:
        """What is behind the teeth of an open ring or a rack."""
        return self.bar if self.law_type == "rack" else self.ring

    @property
    def law_type(self) -> str:
        """Name of the law in the registry; empty if it is not a law."""
        return LAWS.name_of(self.law)


LAW: Final = Choice(
    title="law",
    tag="type",
    what="a law",
    entries=LAWS,
    doc="the ratio of the pair",
    others="# Other laws that can replace the table above, with example values:",
    listing="Laws of gear pairs: the ratio, in the table [law]; all but rack work with a ring too",
)
"""The table ``[law]``."""


def planetary(document: Mapping[str, Any]) -> Fault | None:
    """Return the fault of a design with a planet between sun and ring, or None."""
    pair = document.get("pair")
    given = pair if isinstance(pair, Mapping) and document.get("kind") == NAME else {}
    teeth = given.get("teeth")
    if given.get("type") != "planetary" and not (isinstance(teeth, list) and len(teeth) == 3):
        return None
    three = isinstance(teeth, list) and len(teeth) == 3
    return Fault(
        ("pair", "teeth") if three else ("pair",),
        "a planet between sun and ring on a carrier is not available",
        teeth if three else None,
        allowed="two tooth counts, driver first; design each pair of wheels separately",
        hint="only round wheels mesh in a ring of sun + 2*planet teeth, none in a smaller one",
    )


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield what is wrong between the tables of a `document`, of which valid parts are `found`."""
    pair, law, blank = (document.get(title) for title in ("pair", "law", "blank"))
    on_rack = isinstance(law, Mapping) and law.get("type") == "rack"
    yield from _load_faults(found.parts.get("load", ()), document, on_rack=on_rack)
    radii = getattr(found.parts.get("friction"), "journal_radius", None)
    if on_rack and radii and radii[0] != radii[1]:
        message = "wheel 2 is a rack and has no journal"
        yield Fault(("friction", "journal_radius_mm"), message, allowed="one radius")
    bar = found.parts.get("bar", BarSpec())
    if not on_rack and isinstance(law, Mapping):
        for entry in table_of("bar", BarSpec).entries.values():
            if getattr(bar, entry.name) != entry.default:
                value = document["bar"][entry.key]
                message = f"{show(value)}: is for a rack, and both elements are wheels"
                yield Fault(("bar", entry.key), message, value, 'law.type = "rack"')
    if on_rack:
        yield from _unmade(blank, _OF_HOLES, "is a rack and has no openings and no hub")
    elif isinstance(pair, Mapping) and pair.get("type") == "internal":
        outside = "; the outside of the ring is set in [ring]"
        yield from _unmade(blank, _OF_SHAFT, "is a ring and has no shaft", outside)


def _load_faults(
    loads: Sequence[WheelLoadSpec], document: Mapping[str, Any], *, on_rack: bool
) -> Iterator[Fault]:
    """Yield loads that do not suit what they act on, or act on both elements."""
    for number, one in enumerate(loads):
        key, slides = ("load", number), on_rack and one.on == "wheel2"
        if one.on != loads[0].on:
            message = f"{show(one.on)}: the torque of one wheel follows from that of the other"
            yield Fault((*key, "on"), message, one.on, f"{show(loads[0].on)}, as the first load")
        if slides and one.torque is not None:
            message, value = "acts on a rack, which does not turn", document["load"][number]
            yield Fault((*key, "torque_nm"), message, value["torque_nm"], "force_n")
        if not slides and one.slides:
            message, name = "acts on a wheel, which turns", "file" if one.file else "force_n"
            yield Fault((*key, name), message, document["load"][number][name], "torque_nm")
        if slides and one.column and not one.slides:
            message = f"has {one.column}, but a rack does not turn"
            yield Fault((*key, "file"), message, one.file, "a column force_n")
        variable = "phi1"
        with suppress(GearcamError):  # one that cannot be read is refused by itself
            variable = one.read(one.formula)[0] if one.formula is not None else variable
        if on_rack and variable != "phi1":
            message = f"a rack has no {variable}"
            yield Fault((*key, "formula"), message, one.formula, "a formula of phi1")


def _tooth_breaches(values: Values) -> Iterator[Breach]:
    """Yield the teeth to study that a wheel does not have."""
    counts, wheel = values["pair.teeth"].right, values["stress.wheel"].right
    rows = [
        ("meshing.teeth", 1, "the driver has no such tooth"),
        ("stress.teeth", wheel, "the wheel has no such tooth"),
    ]
    for key, own, why in rows:
        teeth, number = values[key].right, 2 if own == 2 else 1
        most = counts[-1 if number == 2 else 0] if isinstance(counts, list) and counts else None
        for index, tooth in enumerate(teeth if isinstance(teeth, list) else ()):
            if _is_number(most) and _is_number(tooth) and tooth > most:
                yield key, index, why, f"1 to {show(most)}"


RULES: Final = (
    only_with(
        (f"ring.{one.name}" for one in fields(RingSpec)), "pair.type", "internal",
        why="an external pair has no ring",
    ),
    at_most(
        "output.chord_tolerance", "pair.module", part=1.0 / _COARSEST, why="is too coarse for {}"
    ),
    at_most("meshing.step", "steps.count", why="the wheels have no such step"),
    Rule(_tooth_breaches),
)  # fmt: skip
"""Rules between the tables of a pair."""


def _unmade(raw: Any, names: Collection[str], why: str, rest: str = "") -> Iterator[Fault]:
    """Yield the faults of what a blank, as in the file, asks of wheel 2 that this does not have.

    Parameters
    ----------
    raw : object
        The blank.
    names : collection of str
        What it does not have. What serves it may have one value for both wheels, but none of its
        own for wheel 2.
    why : str
        What wheel 2 is.
    rest : str
        More of what is allowed.
    """
    if not isinstance(raw, Mapping):
        return
    for entry in table_of("blank", Blank).entries.values():
        value = raw.get(entry.key)
        own = value if isinstance(value, list) and len(value) == 2 else [value, value]
        served = entry.name in serving(names) and own[0] != own[1]
        none = show(NONE) if entry.base is str else "0"
        wanted = isinstance(own[1], str) or (_is_number(own[1]) and own[1])
        if not wanted or own[1] == NONE or not (entry.name in names or served):
            continue
        if isinstance(value, list):
            message, rule = f"{show(own[1])}: wheel 2 {why}", f"{none} for wheel 2{rest}"
            yield Fault(("blank", entry.key, 1), message, own[1], rule)
        else:
            message = f"{show(value)}: it holds for both wheels, but wheel 2 {why}"
            yield Fault(("blank", entry.key), message, value, f"[{show(value)}, {none}]{rest}")


def _is_number(value: Any) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


KIND: Final = Kind(
    name=NAME,
    doc="a pair of non-circular gears",
    also=("gear", "gears", "wheels", "pair", "gearpair"),
    design=GearPairDesign,
    result=deferred(f"{_HERE}.result:GearPairResult"),
    nodes={"law": LAW},
    repeated={"pair.rack": "rack"},
    required=("law", "pair"),
    rules=RULES,
    problems=problems,
    later=planetary,
    check_modules=(
        "gearcam.gears.checks",
        "gearcam.laws.row_checks",
        "gearcam.meshing.checks",
        "gearcam.meshing.error_checks",
        f"{_HERE}.trial_checks",
        "gearcam.meshing.force_checks",
        "gearcam.stress.checks",
        "gearcam.dynamics.checks",
        "gearcam.parts.checks",
    ),
    check_groups=(
        TEETH,
        "rows of tables",
        MESHING,
        ERRORS,
        TRIALS,
        FORCES,
        DYNAMIC_FORCES,
        STRESS,
        DYNAMICS,
        VIBRATION,
        PARTS,
    ),
    example={
        "law": {
            "type": "phases",
            "shape": "cosine",
            "knots_deg": [0, 160, 360],
            "ratios": [1.25, 0.75, 1.25],
        },
        "pair": {"center_distance_mm": 80, "teeth": [32, 32], "face_width_mm": 10},
        "blank": {"bore_diameter_mm": 8},
        "output": {"files": ["dxf", "csv", "report"]},
    },
    samples={
        "goal": {
            "minimize": "pair.center_distance_mm",
            "maximize": "mesh.contact_ratio.forward.least",
        }
    },
    processes={
        "printing": {
            "pair": {"backlash_mm": 0.1, "face_width_mm": 8},
            "blank": {"clearance_mm": 0.05, "clearance_bores": True},
            "output": {"files": ["stl", "report"], "chord_tolerance_mm": 0.01},
        },
        "laser": {
            "pair": {"backlash_mm": 0.1, "face_width_mm": 4},
            "output": {
                "files": ["dxf", "cut-svg", "report"],
                "kerf_mm": 0.15,
                "chord_tolerance_mm": 0.02,
            },
        },
        "wire": {
            "pair": {"backlash_mm": 0.03},
            "output": {"files": ["dxf", "report"], "kerf_mm": 0.3, "chord_tolerance_mm": 0.002},
        },
    },
    notes={
        "law": "the ratio i21 = dphi2/dphi1 over the driver's angle",
        "pair": "give center_distance_mm or module_mm; the other is computed",
    },
    facts=deferred(f"{_HERE}.shown:facts"),
    files=DeferredMapping(f"{_HERE}.shown:FILES", group_of(NAME, "formats")),
    charts=DeferredMapping(f"{_HERE}.drawn:CHARTS"),
    scene=deferred(f"{_HERE}.drawn:scene"),
    advice=deferred(f"{_HERE}.advice:PairAdvice"),
    ladders=DeferredMapping(f"{_HERE}.studies:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
