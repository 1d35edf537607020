"""The groove cam: a disc with a groove that holds a roller from both sides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Final

from gearcam.base.errors import beyond_limit
from gearcam.base.facts import Fact
from gearcam.base.quantities import LENGTH, REQUIRED, TEXT, fixed, param, positive_length
from gearcam.base.rules import Breach, below
from gearcam.cams.groove import GrooveCam, make_groove
from gearcam.cams.placing import make_round_follower
from gearcam.cams.spec import (
    GROOVE_SIDE,
    ROLLER_CLEARANCE,
    SECOND_ROLLER,
    CamSpec,
    FollowerSpec,
    form_param,
)
from gearcam.designs.faults import Fault, show
from gearcam.kinds.cam.forms.base import Form
from gearcam.kinds.cam.forms.disc import STEM, TOOL_PATH, marker, workpiece
from gearcam.kinds.cam.tables import CamBlank
from gearcam.kinds.cam.wall_facts import curvature, size, start_angle, trimming
from gearcam.parts.blank import OPENING_RULES

if TYPE_CHECKING:
    from gearcam.kinds.cam.forms.base import Parts
    from gearcam.laws.program import Program
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part, Recess
    from gearcam.pictures.drawings import Drawing


@dataclass(frozen=True, kw_only=True)
class GrooveFollower(FollowerSpec):
    """A roller in a groove, or two on one pin.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GrooveFollower(type="roller", roller_radius=8.0, roller2_radius=6.0)
    GrooveFollower(type='roller', roller_radius=8, roller2_radius=6)
    """

    roller2_radius: float | None = positive_length(example=6, doc=SECOND_ROLLER)

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        if self.type != "roller":
            yield "type", None, "a groove holds a roller", '"roller"'
        if self.roller2_radius == self.roller_radius is not None:
            message = "both rollers have this radius, but run in steps of the groove of different "
            rule = "a different radius, or a single roller"
            yield "roller2_radius", None, f"{message}width", rule


@dataclass(frozen=True, kw_only=True)
class GrooveSpec(CamSpec):
    """A cam of the form groove: a disc with a groove.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GrooveSpec(prime_radius=40.0, outer_diameter=130.0, groove_depth=6.0)
    GrooveSpec(prime_radius=40, outer_diameter=130, groove_depth=6)
    """

    form: str = form_param("groove")
    outer_diameter: float = positive_length(
        default=REQUIRED, example=130, doc="diameter of the disc of a groove cam"
    )
    groove_depth: float = positive_length(
        default=REQUIRED, example=6, doc="depth of a groove, less than the thickness"
    )
    roller_clearance: float = param(LENGTH, default=0.0, ge=0, le=100, doc=ROLLER_CLEARANCE)
    side: str | None = param(
        TEXT, default=None, choices=("front", "back"), example="front", doc=GROOVE_SIDE
    )

    rules = (
        *CamSpec.rules,
        below("groove_depth", "thickness", why="the groove would have no floor"),
    )


@dataclass(frozen=True, kw_only=True)
class GrooveBlank(CamBlank):
    """The blank of a groove cam: its bores are as they are given.

    Attributes
    ----------
    clearance, clearance_bores
        A groove has the clearance of its roller instead.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GrooveBlank(bore_diameter=16.0)
    GrooveBlank(bore_diameter=16)
    """

    clearance: float = fixed(0.0)
    clearance_bores: bool = fixed(False)

    without: ClassVar[str] = "the clearance of a groove is cam.roller_clearance_mm"
    """Why it does not have what other blanks have."""

    rules = OPENING_RULES


class Groove(Form[GrooveCam, GrooveSpec, GrooveFollower]):
    """A disc with two walls, those of its groove."""

    name = "groove"
    doc = "a disc with a groove that holds a roller from both sides"
    tables = Form.tables | {
        "follower": GrooveFollower,
        "cam": GrooveSpec,
        "blank": GrooveBlank,
    }
    rows = (
        "cam.outer_diameter_mm",
        "cam.roller2_radius_mm",
        "cam.roller_clearance_mm",
        "cam.lost_motion",
    )

    def contact_width(self, cam: GrooveCam) -> float:
        """Return the depth of the groove, mm, of which each of two rollers has half."""
        return self.given.groove_depth * (0.5 if cam.relief else 1.0)

    @classmethod
    def faults(cls, parts: Mapping[str, Any], document: Mapping[str, Any]) -> Iterator[Fault]:
        """Yield contradictions between the tables of a design (see `Form.faults`)."""
        yield from super().faults(parts, document)
        yield from milled_faults(parts, "a groove")

    def make(self, program: Program) -> GrooveCam:
        """Return the cam."""
        return make_groove(
            program,
            make_round_follower(self.follower, self.given),
            clearance=self.given.roller_clearance,
            radius2=self.follower.roller2_radius,
            diameter=self.given.outer_diameter,
            clockwise=self.given.clockwise,
            tolerance=self.chord_tolerance,
        )

    def parts(self, cam: GrooveCam) -> tuple[Part, ...]:
        """Return the disc with its groove; openings and hub keep within the inner wall."""
        from gearcam.parts.make import make_part
        from gearcam.parts.shapes import Circle

        thickness, inner, relief = self.given.thickness, cam.inner.contour, cam.relief
        work = workpiece(self, STEM, within="the groove's inner wall")
        disc = Circle(center=0j, diameter=self.given.outer_diameter)
        within = [relief.contour] if relief is not None and relief.side > 0 else []
        return (
            make_part(
                STEM,
                [disc.contour(inner.tolerance)],
                thickness,
                self.blank,
                work,
                partial(marker, cam.inner, thickness, work),
                way=cam.inner.hand,
                recesses=self._recesses(cam),
                room=[*within, inner],
            ),
        )

    def finished(self, cam: GrooveCam, parts: Parts) -> tuple[Contour, ...]:  # noqa: ARG002
        """Return the walls, which are made as they are touched (see `Form.finished`)."""
        return tuple(wall.contour for wall in cam.walls)

    def drawings(self, cam: GrooveCam, parts: Parts) -> tuple[Drawing, ...]:
        """Return the disc with both walls and the pitch curve (see `Form.drawings`)."""
        from gearcam.kinds.cam.drawings import grooved

        (part,) = parts
        return (grooved(part, cam.walls),)

    def picture(self, cam: GrooveCam, parts: Parts) -> Drawing:
        """Return the disc, turned, with its follower in the groove (see `Form.picture`)."""
        from gearcam.kinds.cam.drawings import follower, grooved

        motion, (part,), pose = cam.motion, parts, self.output.pose
        shapes = follower(motion, pose, part.contour.reach)
        return grooved(part, cam.walls, shapes, angle=motion.hand * pose)

    def paths(self, cam: GrooveCam, parts: Parts) -> Mapping[str, Contour]:  # noqa: ARG002
        """Return the pitch curve, or a path along each wall (see `Form.paths`)."""
        from gearcam.kinds.cam.drawings import TOOL_RADIUS, cutter_way

        radius, widest = self.output.tool_radius, 0.5 * cam.width
        if radius is not None and radius > widest:
            what = "the cutter is wider than the groove"
            note = "the limit is half the groove's width, included"
            raise beyond_limit(what, TOOL_RADIUS, radius, widest, note, near=widest)
        if cam.relief is None and radius in (None, widest):
            return {TOOL_PATH: cam.inner.pitch_contour}
        tool = widest if radius is None else radius
        walls = [*cam.walls, *([cam.relief] if cam.relief else [])]
        return {
            f"{TOOL_PATH}{wall.ending}": cutter_way(wall.contour, tool, side=wall.side)
            for wall in walls
        }

    def facts(self, cam: GrooveCam, made: Sequence[Contour]) -> dict[str, Any]:
        """Return sizes of the groove, its lost motion, and both walls (see `Form.facts`)."""
        return {
            "outer_diameter_mm": Fact(self.given.outer_diameter, "diameter of the blank"),
            "side": self.given.side or "front",
            "roller2_radius_mm": self.follower.roller2_radius,
            "roller_clearance_mm": self.given.roller_clearance,
            "start_angle_deg": start_angle(cam.motion),
            "groove": {
                "width_mm": Fact(cam.width, "width of the groove"),
                "depth_mm": Fact(self.given.groove_depth, "depth of the groove"),
                **{
                    wall.key: {
                        "curvature": curvature(wall),
                        **trimming(wall),
                        **size(wall, contour),
                    }
                    for wall, contour in zip(cam.walls, made, strict=True)
                },
            },
        }

    def _recesses(self, cam: GrooveCam) -> tuple[Recess, ...]:
        """Return the groove: in one, or the deeper half for the smaller of two rollers."""
        from gearcam.parts.body import Opening, Recess

        thickness, depth, half = (
            self.given.thickness,
            self.given.groove_depth,
            self.contact_width(cam),
        )
        inner, outer = (wall.contour for wall in cam.walls)
        front = self.given.side != "back"

        def recess(low: float, high: float, edges: tuple[Contour, Contour], width: float) -> Recess:
            island = Opening(kind="INNER", shape=edges[0], name="island")
            ends = (thickness - high, thickness - low) if front else (low, high)
            return Recess(
                edge=edges[1],
                openings=(island,),
                low=ends[0],
                high=ends[1],
                front=front,
                width=width,
                place=complex(cam.inner.pitch_contour.points[0]),
            )

        if cam.relief is None:
            return (recess(0.0, depth, (inner, outer), cam.width),)
        wide, side = cam.relief.contour, cam.relief.side
        upper = (wide, outer) if side > 0 else (inner, wide)
        other = cam.outer if side > 0 else cam.inner
        width = cam.relief.follower.radius + other.follower.radius
        return (
            recess(0.0, half, upper, width),
            recess(half, depth, (inner, outer), cam.width),
        )


def milled_faults(parts: Mapping[str, Any], groove: str) -> Iterator[Fault]:
    """Yield the faults of a clearance, and of files for cutting out, with a groove.

    Parameters
    ----------
    parts : mapping
        The tables of a design.
    groove : str
        What is milled, in words; empty for a slot, which is cut out.
    """
    blank, output = parts.get("blank"), parts.get("output")
    if blank is not None and blank.clearance:
        message = f"{show(blank.clearance)}: the clearance of a groove is that of its roller"
        rule = "cam.roller_clearance_mm instead"
        yield Fault(("blank", "clearance_mm"), message, blank.clearance, rule)
    if output is None or not groove:
        return
    if output.kerf:
        message = f"{show(output.kerf)}: not for {groove}, which is milled"
        yield Fault(("output", "kerf_mm"), message, output.kerf, "leave it out")
    if "cut-svg" in output.files:
        rule = "other files, such as dxf and tool-path"
        yield Fault(("output", "files"), f"not for {groove}, which is milled", "cut-svg", rule)


ENTRIES: Final = (Groove,)
