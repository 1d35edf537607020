"""The kind ``cam``: its design, its tables, and the rules between them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, Problem
from gearcam.base.quantities import ANGLE, COUNT, FINEST, LENGTH, LONGEST, TEXT, param
from gearcam.base.registry import classes_in, name_of
from gearcam.cams.spec import POINTED, CamSpec, FollowerSpec, size_problems
from gearcam.designs.design import Design, Wanted
from gearcam.designs.examine import home_of
from gearcam.designs.faults import Fault, quoted, show
from gearcam.designs.kind import KINDS, Examined
from gearcam.designs.outputs import (
    FORMATS,
    OutputSpec,
    files_param,
    pose_param,
    studies_param,
)
from gearcam.designs.table import Table, table_of
from gearcam.designs.validate import told_faults
from gearcam.kinds.cam.blank import CamBlank
from gearcam.kinds.cam.forms.base import SLIDING, form_faults
from gearcam.kinds.cam.motion import examine_motion, motion_of, whole_turns
from gearcam.kinds.shared import AccuracySpec
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import PHASES, RisePhase
from gearcam.parts.blank import WheelBlank

if TYPE_CHECKING:
    from gearcam.kinds.cam.build import CamResult
    from gearcam.kinds.cam.motion import Motion

NAME: Final = "cam"
"""As in a file."""

CAM_FORMATS: Final = (*FORMATS, "tool-path", "curvature")
"""What ``output.files`` of a cam may list."""

LATER_FORMS: Final = ("cylinder",)
"""Forms of cams that are planned but not available."""

_OF_WHEELS: Final = ("stop_pin", "tip_rounding", "timing_marks", "mark_diameter")
"""Keys of a blank for wheels only."""

_BLANK_WORDS: Final = {
    "keyway_angle": "direction of the keyway in the cam's frame",
    "bolt_angle": "direction of the first bolt hole in the cam's frame",
    "rim": "least metal between lightening holes and profile; two thirds of the thickness if left "
    "out",
    "clearance": "what is taken off the profile, along its normal",
    "clearance_bores": "whether bore and bolt holes are widened by the clearance too",
}
"""Meanings of keys that differ from those of wheels."""


@dataclass(frozen=True, kw_only=True)
class FollowSpec(ShortRepr):
    """A given profile, of which the study ``follow`` computes the follower's motion.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.FollowSpec(file="measured.csv", wall="outer")
    FollowSpec(file='measured.csv', wall='outer')
    """

    file: str | None = param(
        TEXT,
        default=None,
        doc="cam profile: DXF with one closed outline, or CSV with columns x_mm and y_mm",
        example="measured.csv",
    )
    wall: str | None = param(
        TEXT,
        default=None,
        choices=("1", "2", "inner", "outer", "lower", "upper"),
        doc="wall to follow: 1 or 2 (conjugate cams); inner, outer, lower or upper (groove); the "
        "first if left out",
        example="outer",
    )


@dataclass(frozen=True, kw_only=True)
class CamOutputSpec(OutputSpec):
    """Which files and studies of a cam are written, and how exact (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        Cam angle of the assembly drawing.
    place : float or None, mm
        Travel of a translating cam in the assembly drawing.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CamOutputSpec(files=("dxf", "tool-path"), tool_radius=4.0)
    CamOutputSpec(files=('dxf', 'tool-path'), tool_radius=4)
    """

    files: tuple[str, ...] = files_param(CAM_FORMATS)
    studies: tuple[str, ...] = studies_param(("follow", "accuracy"))
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=FINEST,
        le=1,
        example=0.001,
        doc="largest distance of an outline from the true curve; 0.001 mm if left out",
    )
    pose: float = pose_param("theta", "cam angle of the assembly drawing")
    motion_step: float = param(
        ANGLE, default=math.radians(1), gt=0, le=90, doc="step of the cam angle in motion.csv"
    )
    travel_step: float | None = param(
        LENGTH, default=None, gt=0, le=LONGEST,
        example=1, doc="step of a translating cam's travel in motion.csv; 1 mm if left out",
    )  # fmt: skip
    place: float | None = param(
        LENGTH, default=None, ge=0, le=LONGEST, word="travel",
        example=0, doc="travel of a translating cam in the assembly drawing; 0 if left out",
    )  # fmt: skip
    inspection_points: int = param(
        COUNT,
        default=360,
        ge=8,
        le=100000,
        doc="number of points in inspection.csv, at equal steps of the cam angle",
    )
    tool_radius: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        example=8,
        doc="radius of the cutter of the tool path; the follower's, or half a groove, if left out",
    )


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
    blank : CamBlank or WheelBlank
        Bore, hub, holes, density.
    output : CamOutputSpec
        Files and their tolerance.
    follow : FollowSpec
        A given profile, for the study of the motion that it makes.
    accuracy : AccuracySpec
        Settings of the study of error against run time.

    Examples
    --------
    >>> import gearcam as gc
    >>> motion = gc.MotionFormula(lift="5*(1 - cos(theta))")
    >>> follower, size = gc.FollowerSpec(type="flat"), gc.CamSpec(base_radius=20.0)
    >>> gc.CamDesign(name="mine", motion=motion, follower=follower, cam=size)
    <CamDesign "mine">
    """

    kind = NAME

    if TYPE_CHECKING:

        @property
        def _built(self) -> CamResult: ...

    motion: Motion
    follower: FollowerSpec
    cam: CamSpec
    blank: WheelBlank = field(default_factory=CamBlank)
    output: CamOutputSpec = field(default_factory=CamOutputSpec)
    follow: FollowSpec = field(default_factory=FollowSpec)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)

    def _settle(self) -> None:
        if isinstance(self.motion, Sequence) and not isinstance(self.motion, str):
            object.__setattr__(self, "motion", tuple(self.motion))
        if isinstance(self.blank, WheelBlank):
            object.__setattr__(self, "blank", _unmarked(self.blank, self.source))

    def _wanted(self) -> Iterator[Wanted]:
        if not isinstance(self.motion, Sequence) or isinstance(self.motion, str):
            yield "motion", self.motion, (tuple, *whole_turns())
            return
        for number, phase in enumerate(self.motion):
            yield f"motion[{number}]", phase, tuple(PHASES.values())
            if isinstance(phase, RisePhase) and not name_of(MOTION_LAWS, phase.law):
                yield f"motion[{number}].law", phase.law, tuple(classes_in(MOTION_LAWS).values())


def _unmarked(blank: WheelBlank, source: str) -> CamBlank:
    """Return the blank of a cam, without timing marks; refuse other keys for wheels only."""
    plain = {item.name: item.default for item in dataclasses.fields(WheelBlank)}
    problems = [
        Problem(
            "does not apply to a cam", file=source, key=f"blank.{name}", value=getattr(blank, name)
        )
        for name in _OF_WHEELS
        if name != "timing_marks" and getattr(blank, name) != plain[name]
    ]
    if problems:
        raise DesignError(problems)
    sizes = {one.name: getattr(blank, one.name) for one in dataclasses.fields(blank)}
    return CamBlank(**sizes | {"timing_marks": False})


@lru_cache(maxsize=1)
def blank_table() -> Table:
    """Return the table of a cam's blank: the keys of a wheel's without those of teeth."""
    entries = {}
    for key, entry in table_of("blank", CamBlank).entries.items():
        if entry.name not in _OF_WHEELS:
            told = dataclasses.replace(
                entry.param, doc=_BLANK_WORDS.get(entry.name, entry.param.doc)
            )
            entries[key] = dataclasses.replace(entry, param=told)
    return Table("blank", CamBlank, entries)


def examine_motion_of(document: Mapping[str, Any], found: Examined) -> None:
    """Validate the motion of a `document`; add its faults and the motion to `found`."""
    examine_motion(document, found, partial(home_of, KINDS[NAME]))


def motion_document(design: CamDesign) -> list[dict[str, Any]] | dict[str, Any]:
    """Return the motion of a `design` as in a file."""
    sliding = "sliding" if design.cam.form in SLIDING else "turning"
    return motion_of(design.motion, (design.follower.motion, sliding))


def later(document: Mapping[str, Any]) -> Fault | None:
    """Return the fault of a form of cams that is planned, or None."""
    cam = document.get("cam")
    form = cam.get("form") if isinstance(cam, Mapping) else None
    if document.get("kind") != NAME or form not in LATER_FORMS:
        return None
    message = f"{show(form)}: {form} cams are planned, but not available yet"
    rule = quoted(KINDS[NAME].table("cam").entries["form"].param.choices or ())
    return Fault(("cam", "form"), message, form, rule)


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield contradictions between the tables of a `document` of which parts are `found`."""
    output, follower = document.get("output"), document.get("follower")
    yield from _follow_faults(output, document.get("follow"))
    yield from _tool_faults(output, follower)
    if "cam" in found.parts:
        owners = {
            "follower": FollowerSpec,
            "cam": CamSpec,
            "blank": CamBlank,
            "output": CamOutputSpec,
        }
        yield from form_faults(found.parts["cam"].form, found.parts, owners)
    slides = "cam" in found.parts and found.parts["cam"].form in SLIDING
    if "follower" in found.parts and "cam" in found.parts and not slides:
        told = size_problems(found.parts["follower"], found.parts["cam"])
        yield from told_faults(told, table_of("cam", CamSpec), document["cam"], ("cam",))


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
    asked = isinstance(files, list) and "tool-path" in files
    if asked and kind in ("flat", *POINTED) and "tool_radius_mm" not in output:
        message = f"is missing: a {kind} follower has no radius that a cutter could have"
        yield Fault(("output", "tool_radius_mm"), message, allowed="a radius above 0")
