"""The translating cam: a plate that slides past its follower, with one wall or a groove."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Final, cast

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.facts import Fact
from gearcam.base.quantities import (
    LENGTH,
    LONGEST,
    REQUIRED,
    TEXT,
    fixed,
    param,
    params_of,
    positive_length,
)
from gearcam.base.rules import below, needs, only_with
from gearcam.cams.caliper import lowered
from gearcam.cams.placing import make_follower_over_plate
from gearcam.cams.spec import (
    GROOVE_SIDE,
    ROLLER_CLEARANCE,
    CamSpec,
    PlateFollower,
    form_param,
)
from gearcam.cams.translating import TranslatingCam, make_translating
from gearcam.designs.faults import Fault, show
from gearcam.kinds.cam.forms.base import Form
from gearcam.kinds.cam.forms.disc import STEM, TOOL_PATH, marker, workpiece
from gearcam.kinds.cam.forms.groove import milled_faults
from gearcam.kinds.cam.tables import CamBlank, CamOutputSpec
from gearcam.kinds.cam.wall_facts import curvature, start_angle, trimming
from gearcam.laws.phases_of_lift import DwellPhase, Phase
from gearcam.laws.program import Program, make_program
from gearcam.mechanics.drive import SlideDriveSpec
from gearcam.mechanics.load import SlideLoadSpec
from gearcam.numeric.pose import Pose
from gearcam.parts.blank import RowBlank

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.kinds.cam.forms.base import Parts
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Drawing, Path, Shape

_ROUNDING = 1e-9
"""Relative difference of a cutter's radius from half the groove that is rounding of digits."""


def _run(*, doc: str) -> Any:
    """Return the field of a length beside the motion."""
    return param(LENGTH, default=0.0, ge=0, le=LONGEST, doc=doc)


def _of_wheels(name: str) -> Any:
    """Return a field of `CamBlank` once more."""
    return field(
        default=CamBlank.__dataclass_fields__[name].default,
        metadata={"param": params_of(CamBlank)[name]},
    )


@dataclass(frozen=True, kw_only=True)
class PlateSpec(CamSpec):
    """A cam of the form translating: a plate that slides past its follower.

    Attributes
    ----------
    prime_radius, base_radius : None
        It has none: its lift counts from the lower edge of the plate.
    rotation : str
        It does not turn.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PlateSpec(walls="both", run_in=10.0).runs
    (10.0, 0.0)
    """

    form: str = form_param("translating")
    prime_radius: float | None = fixed(None)
    base_radius: float | None = fixed(None)
    rotation: str = fixed("ccw")
    walls: str = param(
        TEXT,
        default="lower",
        choices=("lower", "both"),
        doc="walls of a translating cam: the lower one, or both walls of a groove",
    )
    run_in: float = _run(doc="length of a translating cam before its motion, at zero lift")
    run_out: float = _run(doc="length of a translating cam after its motion, at the last lift")
    groove_depth: float | None = positive_length(
        example=6, doc="depth of a groove, less than the thickness; through the plate if left out"
    )
    roller_clearance: float = param(LENGTH, default=0.0, ge=0, le=100, doc=ROLLER_CLEARANCE)
    side: str | None = param(
        TEXT, default=None, choices=("front", "back"), example="front", doc=GROOVE_SIDE
    )

    @property
    def runs(self) -> tuple[float, float]:
        """Lengths before and after the motion, mm."""
        return self.run_in, self.run_out

    rules = (
        only_with(
            ("groove_depth", "roller_clearance", "side"),
            "walls",
            "both",
            why="does not apply to a cam with one wall",
        ),
        below("groove_depth", "thickness", why="the groove would have no floor"),
        needs("side", "groove_depth"),
    )


@dataclass(frozen=True, kw_only=True)
class PlateBlank(RowBlank):
    """The blank of a translating cam: a plate with a row of mounting holes.

    Its `density`, `clearance`, `chamfer`, `rotation_arrow` and `zero_mark` are those of a
    `CamBlank`.

    Attributes
    ----------
    timing_marks : bool
        They belong to teeth.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PlateBlank(length=120.0, height=40.0)
    PlateBlank(height=40, length=120)
    """

    height: float = positive_length(
        default=REQUIRED,
        example=40,
        doc="height of a translating cam's plate; with one wall, up to the largest lift",
    )
    length: float | None = positive_length(
        example=150,
        doc="length of a translating cam's plate; as long as its profile needs if left out",
    )
    density: float | None = _of_wheels("density")
    clearance: float = _of_wheels("clearance")
    chamfer: float = _of_wheels("chamfer")
    rotation_arrow: bool = _of_wheels("rotation_arrow")
    zero_mark: bool = _of_wheels("zero_mark")

    timing_marks: bool = fixed(False)
    without: ClassVar[str] = "it slides, and has no other openings than a row of holes"
    """Why it does not have what other blanks have."""


@dataclass(frozen=True, kw_only=True)
class PlateOutput(CamOutputSpec):
    """Which files and studies of a translating cam are written, and how exact.

    Parameters
    ----------
    place : float, mm
        Travel in the assembly drawing.
    height_step : float, mm
        Step along the cam in ``caliper.csv``.

    Attributes
    ----------
    pose, motion_step, caliper_step : float
        It does not turn.
    grinding_wheel_radius : None
        Only cams that turn are ground below a wheel.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PlateOutput(files=("dxf",), travel_step=0.5)
    PlateOutput(files=('dxf',), travel_step=0.5)
    """

    pose: float = fixed(0.0)
    motion_step: float = fixed(0.0)
    caliper_step: float = fixed(0.0)
    height_step: float = param(
        LENGTH,
        default=1.0,
        gt=0,
        le=LONGEST,
        word="caliper_step",
        doc="step along a translating cam in caliper.csv",
    )
    grinding_wheel_radius: None = fixed(None)
    travel_step: float = positive_length(
        default=1.0, doc="step of a translating cam's travel in motion.csv"
    )
    place: float = param(
        LENGTH,
        default=0.0,
        ge=0,
        le=LONGEST,
        word="travel",
        doc="travel of a translating cam in the assembly drawing",
    )


class Translating(Form[TranslatingCam, PlateSpec, PlateFollower]):
    """A plate that slides past its follower."""

    name = "translating"
    doc = "a plate that slides past its follower, with one wall or a groove"
    tables: ClassVar[dict[str, type]] = {
        "follower": PlateFollower,
        "cam": PlateSpec,
        "drive": SlideDriveSpec,
        "load": SlideLoadSpec,
        "blank": PlateBlank,
        "output": PlateOutput,
    }
    moves = "sliding"
    rows = (
        "cam.travel_mm",
        "cam.run_in_mm",
        "cam.run_out_mm",
        "cam.axis_deg",
        "cam.pivot_height_mm",
        "cam.groove.width_mm",
        "cam.groove.depth_mm",
        "cam.roller_clearance_mm",
        "cam.lost_motion",
    )

    @property
    def step(self) -> tuple[str, float]:
        """Key and value of the step of tables of the motion, mm (see `Form.step`)."""
        return "output.travel_step_mm", self.output.travel_step

    def contact_width(self, cam: TranslatingCam) -> float:  # noqa: ARG002
        """Return the depth of a groove, or the thickness of the plate, mm."""
        return self.given.groove_depth or self.given.thickness

    @classmethod
    def faults(cls, parts: Mapping[str, Any], document: Mapping[str, Any]) -> Iterator[Fault]:  # noqa: ARG003
        """Yield contradictions between the tables of a design (see `Form.faults`)."""
        follower, cam = parts["follower"], parts["cam"]
        if cam.walls != "both":
            return
        if follower.type != "roller":
            message = f"{show(follower.type)}: a groove holds a roller"
            yield Fault(("follower", "type"), message, follower.type, '"roller"')
        yield from milled_faults(parts, "a groove with a floor" if cam.groove_depth else "")

    def program(self, tolerances: Tolerances) -> Program:
        """Return the lift over the travel, with its run before and after."""
        motion = cast("Sequence[Phase]", self.design.motion)
        before, after = ([DwellPhase(angle=run)] if run else [] for run in self.given.runs)
        return make_program(
            [*before, *motion, *after],
            tolerances,
            oscillating=self.follower.oscillating,
            closed=False,
        )

    def make(self, program: Program) -> TranslatingCam:
        """Return the cam."""
        travel = program.period
        if self.output.place > travel:
            what = "the assembly drawing is beyond the travel of the cam"
            rule, key = "the limit is its whole travel, included", "output.travel_mm"
            raise beyond_limit(what, key, self.output.place, travel, rule, near=travel)
        return make_translating(
            program,
            make_follower_over_plate(self.follower),
            height=self.blank.height,
            length=self.blank.length,
            groove=self.given.walls == "both",
            clearance=self.given.roller_clearance,
            tolerance=self.chord_tolerance,
        )

    def rows_of(self, number: int) -> Sequence[str]:
        """Return the names of the facts in the table of its drawing (see `Form.rows_of`)."""
        drawn = (".groove.width_mm", ".groove.depth_mm") if self.given.groove_depth else ()
        return [name for name in super().rows_of(number) if not name.endswith(drawn)]

    def parts(self, cam: TranslatingCam) -> tuple[Part, ...]:
        """Return the plate, with its wall or its groove, and its bolts."""
        from gearcam.parts.body import Opening, Part, Recess
        from gearcam.parts.make import marked
        from gearcam.parts.openings import Stock, demand_apart, row_of_holes

        cam, thickness, depth = self._cut(cam), self.given.thickness, self.given.groove_depth
        foot = complex(0.5 * (cam.plate.left + cam.plate.right), cam.plate.low)
        holes, recesses = list(row_of_holes(self.blank, foot, 1.0, 1j)), []
        taken = holes
        if cam.groove is not None:
            slot = Opening(kind="GROOVE", shape=cam.groove, name="groove")
            taken = [*holes, slot]
            if depth is None:
                holes = taken
            else:
                front = self.given.side != "back"
                low, high = (thickness - depth, thickness) if front else (0.0, depth)
                place = complex(cam.lower.pitch_line[0])
                recess = Recess(
                    edge=cam.groove, low=low, high=high, front=front, width=cam.width, place=place
                )
                recesses = [recess]
        work = workpiece(self, STEM)
        demand_apart(taken, Stock(contours=(cam.edge,), work=work), self.blank.places)
        part = Part(
            name=STEM,
            contours=(cam.edge,),
            width=thickness,
            openings=tuple(holes),
            recesses=tuple(recesses),
            turns=False,
        )
        mark = partial(marker, cam.lower, thickness, work)
        return (marked(part, self.blank, work, mark),)

    def _cut(self, cam: TranslatingCam) -> TranslatingCam:
        """Return the finished cam: a single wall is moved back by the clearance of the blank."""
        lower = lowered(cam.lower, self.blank.clearance)
        return cam if lower is cam.lower else replace(cam, lower=lower)

    def finished(self, cam: TranslatingCam, parts: Parts) -> tuple[Contour, ...]:  # noqa: ARG002
        """Return the metal behind each wall, as made (see `Form.finished`)."""
        return tuple(wall.contour for wall in self._cut(cam).walls)

    def drawings(self, cam: TranslatingCam, parts: Parts) -> tuple[Drawing, ...]:
        """Return the plate with its pitch curve (see `Form.drawings`)."""
        (part,) = parts
        return (_drawing(cam, part),)

    def picture(self, cam: TranslatingCam, parts: Parts) -> Drawing:
        """Return the plate below its follower (see `Form.picture`)."""
        from gearcam.kinds.cam.drawings import follower

        (part,), place = parts, self.output.place
        reach = 0.5 * float(np.ptp(cam.lower.contour.vertices))
        return _drawing(cam, part, follower(cam.motion, place, reach), place)

    def paths(self, cam: TranslatingCam, parts: Parts) -> Mapping[str, Contour | Path]:  # noqa: ARG002
        """Return the path around the plate, or through the groove (see `Form.paths`)."""
        from gearcam.kinds.cam.drawings import cutter_way
        from gearcam.pictures.drawings import Path

        own, cam = cam.motion.follower.radius, self._cut(cam)
        if cam.groove is None:
            return {TOOL_PATH: cutter_way(cam.edge, self.output.tool_radius or own)}
        radius = self.output.tool_radius or 0.5 * cam.width
        if abs(2.0 * radius - cam.width) <= _ROUNDING * cam.width:
            return {TOOL_PATH: Path(points=cam.lower.pitch_line, closed=False)}
        return {TOOL_PATH: cutter_way(cam.groove, radius, side=-1)}

    @property
    def leading(self) -> str:
        """The name of the size for the headline."""
        return "travel_mm"

    def sizes(self, cam: TranslatingCam) -> dict[str, Any]:
        """Return the sizes of a `cam`, as facts."""
        plate = cam.plate
        return {
            "travel_mm": Fact(cam.travel, "travel"),
            "run_in_mm": self.given.run_in or None,
            "run_out_mm": self.given.run_out or None,
            **self.follower.placement,
            "length_mm": plate.right - plate.left,
            "height_mm": plate.high - plate.low,
        }

    def facts(self, cam: TranslatingCam, made: Sequence[Contour]) -> dict[str, Any]:
        """Return curvature, undercut and length of the walls, and the groove (see `Form.facts`)."""
        given = self.given
        walls = {
            wall.key or "profile": {
                "curvature": curvature(wall),
                **trimming(wall),
                "length_mm": wall.size.perimeter,
                "least_vertices": wall.sampler.least,
                "vertices": len(wall.line),
                "chord_error_mm": contour.chord_error,
            }
            for wall, contour in zip(cam.walls, made, strict=True)
        }
        start = {"start_angle_deg": start_angle(cam.motion)}
        if cam.groove is None:
            return {**start, "clearance_mm": self.blank.clearance or None, **walls}
        return {
            **start,
            "roller_clearance_mm": given.roller_clearance,
            "groove": {
                "width_mm": Fact(cam.width, "width of the groove"),
                "depth_mm": Fact(given.groove_depth or given.thickness, "depth of the groove"),
                "area_mm2": cam.groove.moments.area,
                **walls,
            },
        }


def _drawing(
    cam: TranslatingCam, part: Part, follower: Sequence[Shape] = (), travel: float = 0.0
) -> Drawing:
    """Return the plate with its pitch curve, moved by its travel below a follower."""
    from gearcam.kinds.cam.drawings import cam_drawing
    from gearcam.pictures.drawings import BLANK, GROOVE, OUTER_WALL, PROFILE, Path

    pitch = Path(points=cam.lower.pitch_line, closed=False)
    drawing = cam_drawing(
        part,
        pitch if cam.motion.follower.radius else None,
        None,
        follower,
        pose=Pose(shift=travel),
        outline=PROFILE if cam.groove is None else BLANK,
    )
    features = (
        replace(one, layer=GROOVE) if one.layer == OUTER_WALL else one for one in drawing.features
    )
    return replace(drawing, features=tuple(features))


ENTRIES: Final = (Translating,)
