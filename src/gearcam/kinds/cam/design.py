"""The kind ``cam``: its design, its tables, and the rules between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, get_args

from gearcam.base.brought import group_of
from gearcam.base.numerals import formatted, shortened
from gearcam.base.quantities import Solve
from gearcam.base.registry import DeferredMapping, deferred
from gearcam.base.rules import Rule, only_with
from gearcam.cams.spec import (
    FITTED,
    FOLLOWED,
    FOLLOWERS,
    POINTED,
    PRECISION,
    CamSpec,
    FollowerSpec,
)
from gearcam.cams.spec import KIND as CAM
from gearcam.designs.design import Design, document_of
from gearcam.designs.faults import Fault, show
from gearcam.designs.kind import Examined
from gearcam.designs.table import table_of
from gearcam.designs.validate import placed_faults
from gearcam.dynamics.follower_checks import MOVING
from gearcam.kinds.cam.forms.base import FORMS, VARIANTS
from gearcam.kinds.cam.motion import MOTION, circumstances, measured_faults
from gearcam.kinds.cam.polydyne import polydyne_faults
from gearcam.kinds.cam.tables import (
    GOALS,
    NAME,
    BoundsSpec,
    CamBlank,
    CamOutputSpec,
    FollowerDynamicsSpec,
    FollowSpec,
    PrecisionSpec,
)
from gearcam.kinds.follower_tables import load_faults
from gearcam.kinds.shared import AccuracySpec, ForcesSpec, GoalSpec
from gearcam.mechanics.drive import DriveSpec
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.gravity import GravitySpec
from gearcam.mechanics.load import FORCES, LoadSpec
from gearcam.mechanics.mass import MassSpec
from gearcam.mechanics.material import MaterialSpec
from gearcam.mechanics.spring import SpringSpec
from gearcam.parts.blank import KIND as PARTS
from gearcam.results.kind import Kind
from gearcam.sheets.spec import DrawingSpec

if TYPE_CHECKING:
    from gearcam.kinds.cam.forms.translating import PlateBlank
    from gearcam.kinds.cam.motion import Motion
    from gearcam.parts.blank import ShaftBlank


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class CamDesign(Design):
    """The design of a cam with its follower (see `Design`).

    Parameters
    ----------
    motion : sequence of Phase, MotionTable or MotionFormula
        The lift over a turn of the cam.
    follower : FollowerSpec
        The follower and its guide.
    cam : CamSpec
        Form, size, direction of turning.
    drive : CamDriveSpec or SlideDriveSpec
        Speed of the cam.
    load : sequence of LoadSpec or SlideLoadSpec
        What the follower works against.
    blank : CamBlank, PlateBlank or ShaftBlank
        Bore, hub, holes, density.
    drawing : DrawingSpec
        What workshop drawings say beside sizes.
    output : CamOutputSpec
        Files and their tolerance.
    spring : sequence of SpringSpec
        Springs that press it onto the cam.
    mass : sequence of MassSpec
        Its masses.
    gravity : GravitySpec
        Direction of gravity.
    friction : FrictionSpec
        Coefficients of friction, bearings.
    material : MaterialSpec
        Materials of cam and follower.
    forces : ForcesSpec
        Settings of the study of forces.
    dynamics : FollowerDynamicsSpec
        Elasticity of the follower, for the study of its dynamics.
    follow : FollowSpec
        A given profile, for the study of the motion that it makes.
    precision : PrecisionSpec
        Tolerances of its sizes, for the study of the errors that they make.
    accuracy : AccuracySpec
        Settings of the study of error against run time.
    bounds : BoundsSpec
        Ranges of sizes that are solved for.
    goal : GoalSpec
        What their solution, or that of `gearcam optimize`, has least or most of.

    Examples
    --------
    >>> import gearcam as gc
    >>> motion = gc.MotionFormula(lift="5*(1 - cos(theta))")
    >>> follower, size = gc.FollowerSpec(type="flat"), gc.CamSpec(base_radius=20.0)
    >>> gc.CamDesign(name="mine", motion=motion, follower=follower, cam=size)
    <CamDesign "mine">
    """

    kind = NAME

    motion: Motion
    follower: FollowerSpec
    cam: CamSpec
    drive: DriveSpec = field(default_factory=DriveSpec)
    load: tuple[LoadSpec, ...] = ()
    blank: ShaftBlank | PlateBlank = field(default_factory=CamBlank)
    drawing: DrawingSpec = field(default_factory=DrawingSpec)
    output: CamOutputSpec = field(default_factory=CamOutputSpec)
    spring: tuple[SpringSpec, ...] = ()
    mass: tuple[MassSpec, ...] = ()
    gravity: GravitySpec = field(default_factory=GravitySpec)
    friction: FrictionSpec = field(default_factory=FrictionSpec)
    material: MaterialSpec = field(default_factory=MaterialSpec)
    forces: ForcesSpec = field(default_factory=ForcesSpec)
    dynamics: FollowerDynamicsSpec = field(default_factory=FollowerDynamicsSpec)
    follow: FollowSpec = field(default_factory=FollowSpec)
    precision: PrecisionSpec = field(default_factory=PrecisionSpec)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    bounds: BoundsSpec = field(default_factory=BoundsSpec)
    goal: GoalSpec = field(default_factory=GoalSpec)

    @cached_property
    def asked(self) -> tuple[str, ...]:
        """Keys of the sizes that are to be solved for."""
        return tuple(unknowns(document_of(self)))

    def _settle(self) -> None:
        if isinstance(self.motion, Sequence) and not isinstance(self.motion, str):
            object.__setattr__(self, "motion", tuple(self.motion))

    @property
    def form(self) -> str:
        """The name of its form."""
        return VARIANTS.of(self)


def _toleranced(sizes: str, key: str, *words: str) -> Rule:
    """Return the rule that some sizes have tolerances only with certain followers or forms."""
    names = (f"precision.{size}_tolerance" for size in sizes.split())
    return only_with(names, key, *words)


_ROUND: Final = tuple(name for name in FOLLOWERS if name != "flat")
_TURNING: Final = tuple(name for name in FORMS if name != "translating")

_ARMS: Final = {
    "follower.roller_radius_mm": 5.0,
    "blank.bore_diameter_mm": 2.5,
    "cam.prime_radius_mm": 1.2,
    "cam.base_radius_mm": 1.5,
}
_LONGER: Final = 3.0
"""The least arm of a usual range, over sizes of the design, and the largest over the least."""


RULES: Final = (
    _toleranced("radius", "follower.type", "roller", "domed"),
    _toleranced("offset axis face_angle roller_distance", "follower.motion", "translating"),
    _toleranced("face_angle face_offset", "follower.type", "flat"),
    _toleranced(
        "arm pivot_distance pivot_height face_offset arms_angle", "follower.motion", "oscillating"
    ),
    _toleranced("arm", "follower.type", *_ROUND),
    _toleranced("roller_distance arms_angle", "cam.form", "conjugate"),
    _toleranced("cam_angle", "cam.form", *_TURNING),
    _toleranced("travel", "cam.form", "translating"),
    only_with(("precision.lift_error",), "follower.motion", "translating"),
    only_with(("precision.swing_error",), "follower.motion", "oscillating"),
)
"""Rules between the tables of a cam."""


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield contradictions between the tables of a `document` of which parts are `found`."""
    output, follower = document.get("output"), document.get("follower")
    yield from _follow_faults(output, document.get("follow"))
    yield from _tool_faults(output, follower)
    if "follower" in found.parts:
        held = found.parts["follower"]
        yield from load_faults(found, document, oscillating=held.oscillating)
        if "dynamics" in found.parts and "dynamics" in document:
            breaches = found.parts["dynamics"].allowed_on(oscillating=held.oscillating)
            table = table_of("dynamics", FollowerDynamicsSpec)
            yield from placed_faults(breaches, table, document["dynamics"], ("dynamics",))
        yield from polydyne_faults(found, document)
    asked = unknowns(document)
    yield from measured_faults(found, document, VARIANTS.meant(document), asked)
    yield from _unsolvable(document, asked)
    if {"cam", "follower"} <= found.parts.keys():
        yield from FORMS[VARIANTS.meant(document)].faults(found.parts, document)


def unknowns(document: Mapping[str, Any]) -> list[str]:
    """Return the keys of the sizes in a `document` that are to be solved for."""
    (word,) = get_args(Solve)
    return [
        f"{title}.{key}"
        for title in ("cam", "follower")
        if isinstance(table := document.get(title), Mapping)
        for key, value in table.items()
        if value == word
    ]


def _unsolvable(document: Mapping[str, Any], asked: Sequence[str]) -> Iterator[Fault]:
    """Yield the faults of sizes that cannot be solved for in this design."""
    form = VARIANTS.meant(document)
    for key in asked:
        title, name = key.split(".")
        if not FORMS[form].solvable:
            message, known = f'"solve" is not available for a {form} cam', "a length"
            yield Fault((title, name), message, allowed=known)
    if asked:
        yield from _unknown_goals(document.get("goal"))
    bounds = document.get("bounds")
    ranges = bounds if isinstance(bounds, Mapping) else {}
    names = [key.split(".")[1] for key in asked]
    known = ", ".join(names) or 'ranges of sizes whose value is "solve"'
    for name in ranges:
        if name not in names and name in table_of("bounds", BoundsSpec).entries:
            message = "has no effect: this size is not solved for"
            yield Fault(("bounds", name), message, ranges[name], known)
    if {"arm_mm", "pivot_distance_mm"} <= {*names} and "arm_mm" not in ranges:
        message = "cannot be solved together with the pivot distance without a range: the lift is "
        message += "an angle, so that a shorter arm always makes a smaller cam"
        near = f"[bounds] arm_mm = {_arms(document)}"
        yield Fault(("follower", "arm_mm"), message, "solve", near)


def _arms(document: Mapping[str, Any]) -> str:
    """Return a range of arms that suits the sizes that a `document` gives, mm."""
    sizes = (factor * _number(document, key) for key, factor in _ARMS.items())
    least = max(sizes)
    if not least:
        return "[least, largest]"
    ends = (formatted(shortened(size, 1.0, 2)) for size in (least, _LONGER * least))
    return f"[{', '.join(ends)}]"


def _number(document: Mapping[str, Any], key: str) -> float:
    """Return a length in a `document`; 0 if it does not have it as a number above 0."""
    title, name = key.split(".")
    table = document.get(title)
    value = table.get(name) if isinstance(table, Mapping) else None
    return float(value) if isinstance(value, int | float) and value > 0.0 else 0.0


def _unknown_goals(goal: Any) -> Iterator[Fault]:
    """Yield goals that sizes cannot be solved for."""
    known, found = ", ".join(GOALS), list[str]()
    for key in ("minimize", "maximize"):
        given = goal.get(key, []) if isinstance(goal, Mapping) else []
        for name in [given] if isinstance(given, str) else given:
            if name not in GOALS:
                message = f"{show(name)}: sizes are not solved for this fact"
                yield Fault(("goal", key), message, name, known)
            elif found:
                message = f"{show(name)}: sizes are solved for one goal"
                yield Fault(("goal", key), message, name, f"{found[0]} alone")
            found.append(name)


def _follow_faults(output: Any, follow: Any) -> Iterator[Fault]:
    asked = output.get("studies") if isinstance(output, Mapping) else None
    given = isinstance(follow, Mapping) and "file" in follow
    if isinstance(asked, list) and "follow" in asked and not given:
        message = 'is missing: output.studies lists "follow", which needs a profile'
        yield Fault(("follow", "file"), message, allowed="a DXF or CSV file of a closed profile")


def _tool_faults(output: Any, follower: Any) -> Iterator[Fault]:
    if not isinstance(output, Mapping) or not isinstance(follower, Mapping):
        return
    files, kind = output.get("files"), follower.get("type")
    asked = files if isinstance(files, list) else []
    for word, key, tool, without in (
        ("tool-path", "tool_radius_mm", "cutter", ("flat", *POINTED)),
        ("grinding", "grinding_wheel_radius_mm", "wheel", POINTED),
    ):
        if word in asked and kind in without and key not in output:
            message = f"is missing: a {kind} follower has no radius that a {tool} could have"
            yield Fault(("output", key), message, allowed="a radius above 0")


_HERE: Final = "gearcam.kinds.cam"

KIND: Final = Kind(
    name=NAME,
    doc="a cam with its follower",
    design=CamDesign,
    result=deferred(f"{_HERE}.result:CamResult"),
    nodes={"motion": MOTION},
    circumstances=circumstances,
    variants=VARIANTS,
    repeated={
        **{
            f"cam.{size}_mm": f"follower.{size}_mm"
            for size in (
                *("arm", "dome_radius", "face_offset", "offset"),
                *("pivot_distance", "preload", "roller_radius"),
            )
        },
        "part.density_kg_m3": "blank.density_kg_m3",
    },
    required=("motion", "follower", "cam"),
    rules=RULES,
    problems=problems,
    check_modules=(
        "gearcam.cams.checks",
        "gearcam.dynamics.follower_checks",
        "gearcam.laws.row_checks",
        "gearcam.mechanics.force_checks",
        "gearcam.parts.checks",
    ),
    check_groups=(CAM, "rows of tables", PARTS, FOLLOWED, FITTED, FORCES, MOVING, PRECISION),
    example={
        "motion": [
            {"type": "rise", "angle_deg": 120, "law": "cycloidal", "lift_mm": 10},
            {"type": "dwell", "angle_deg": 60},
            {"type": "return", "angle_deg": 120, "law": "cycloidal"},
            {"type": "dwell", "angle_deg": "rest"},
        ],
        "follower": {"type": "roller", "motion": "translating", "roller_radius_mm": 8},
        "cam": {"prime_radius_mm": 42, "thickness_mm": 10},
        "blank": {"bore_diameter_mm": 8},
        "output": {"files": ["dxf", "csv", "report"]},
    },
    samples={
        "goal": {
            "minimize": "cam.profile.radius_mm.max",
            "maximize": "cam.curvature.profile_convex_min_mm",
        }
    },
    processes={
        "printing": {
            "cam": {"thickness_mm": 8},
            "blank": {"clearance_mm": 0.05, "clearance_bores": True},
            "output": {"files": ["stl", "report"], "chord_tolerance_mm": 0.01},
        },
        "laser": {
            "cam": {"thickness_mm": 4},
            "output": {
                "files": ["dxf", "cut-svg", "report"],
                "kerf_mm": 0.15,
                "chord_tolerance_mm": 0.02,
            },
        },
        "wire": {
            "output": {"files": ["dxf", "report"], "kerf_mm": 0.3, "chord_tolerance_mm": 0.002}
        },
    },
    notes={
        "motion": "Phases of the motion, one after the other, 360 deg in all.",
        "cam": "give prime_radius_mm or base_radius_mm; with a flat follower base_radius_mm",
    },
    facts=deferred(f"{_HERE}.shown:facts"),
    files=DeferredMapping(f"{_HERE}.shown:FILES", group_of(NAME, "formats")),
    charts=DeferredMapping(f"{_HERE}.drawn:CHARTS"),
    scene=deferred(f"{_HERE}.drawn:scene"),
    advice=deferred(f"{_HERE}.hints:CamAdvice"),
    ladders=DeferredMapping(f"{_HERE}.ladders:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
