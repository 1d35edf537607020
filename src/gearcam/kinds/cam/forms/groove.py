"""The groove cam: a disc with a groove that holds a roller from both sides."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted
from gearcam.cams.disc import CHORD_TOLERANCE
from gearcam.cams.groove import GrooveCam, make_groove
from gearcam.cams.placing import make_round_follower
from gearcam.designs.faults import Fault, show
from gearcam.kinds.cam.forms.base import FORMS, Form, Keys, plate_keys
from gearcam.kinds.cam.forms.disc import STEM, TOOL_PATH, workpiece
from gearcam.kinds.cam.wall_facts import curvature, size, trimming

if TYPE_CHECKING:
    from gearcam.kinds.cam.build import CamResult
    from gearcam.kinds.cam.design import CamDesign
    from gearcam.laws.program import Program
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part, Recess
    from gearcam.pictures.drawings import Drawing

_OWN = ("outer_diameter", "groove_depth", "roller_clearance", "side")


class Groove(Form):
    """A disc with two walls, those of its groove."""

    name = "groove"
    doc = "a disc with a groove that holds a roller from both sides"
    takes = plate_keys(cam=_OWN, follower=("roller2_radius",))
    needs: ClassVar[Keys] = {"cam": ("outer_diameter", "groove_depth")}
    rows = (
        "cam.outer_diameter_mm", "cam.groove.width_mm", "cam.groove.depth_mm",
        "cam.roller2_radius_mm", "cam.roller_clearance_mm", "cam.lost_motion",
    )  # fmt: skip

    def faults(self, parts: Mapping[str, Any]) -> Iterator[Fault]:
        """Yield what a groove cam cannot have."""
        follower, cam = parts["follower"], parts["cam"]
        if follower.type != "roller":
            message = f"{show(follower.type)}: a groove holds a roller"
            yield Fault(("follower", "type"), message, follower.type, '"roller"')
        if follower.roller2_radius == follower.roller_radius:
            message = f"{show(follower.roller2_radius)}: both rollers have this radius, but run in "
            message += "steps of the groove of different width"
            rule = "a different radius, or a single roller"
            yield Fault(("follower", "roller2_radius_mm"), message, follower.roller_radius, rule)
        if cam.groove_depth >= cam.thickness:
            message = f"{show(cam.groove_depth)}: the groove would have no floor"
            rule = f"below the thickness of {formatted(cam.thickness)} mm"
            yield Fault(("cam", "groove_depth_mm"), message, cam.groove_depth, rule)
        blank, output = parts.get("blank"), parts.get("output")
        if blank is not None and blank.clearance:
            message = f"{show(blank.clearance)}: the clearance of a groove is that of its roller"
            rule = "cam.roller_clearance_mm instead"
            yield Fault(("blank", "clearance_mm"), message, blank.clearance, rule)
        if output is not None and output.kerf:
            message = f"{show(output.kerf)}: not for a groove, which is milled"
            yield Fault(("output", "kerf_mm"), message, output.kerf, "leave it out")
        if output is not None and "cut-svg" in output.files:
            message = "not for a groove, which is milled"
            rule = "other files, such as dxf and tool-path"
            yield Fault(("output", "files"), message, "cut-svg", rule)

    def make(self, design: CamDesign, program: Program) -> GrooveCam:
        """Return the cam."""
        cam = design.cam
        return make_groove(
            program,
            make_round_follower(design.follower, cam),
            clearance=cam.roller_clearance or 0.0,
            radius2=design.follower.roller2_radius,
            diameter=cam.outer_diameter or math.inf,
            clockwise=cam.clockwise,
            tolerance=design.output.chord_tolerance or CHORD_TOLERANCE,
        )

    def parts(self, result: CamResult) -> tuple[Part, ...]:
        """Return the disc with its groove; openings and hub keep within the inner wall."""
        from gearcam.parts.make import make_part
        from gearcam.parts.shapes import Circle

        cam, thickness = result.design.cam, result.design.cam.thickness
        disc = Circle(center=np.zeros(2), diameter=cam.outer_diameter or 0.0)
        recesses = _recesses(result)
        relief = _cam(result).relief
        within = [relief.contour] if relief is not None and relief.side > 0 else []
        contour = disc.contour(result.profile.tolerance)
        return (
            make_part(
                STEM,
                [contour],
                thickness,
                result.design.blank,
                workpiece(STEM, thickness, within="the groove's inner wall"),
                recesses=recesses,
                room=[*within, result.profiles[0]],
            ),
        )

    def made(self, result: CamResult) -> tuple[Contour, ...]:
        """Return the walls, which are made as they are touched."""
        return result.profiles

    def drawings(self, result: CamResult) -> tuple[Drawing, ...]:
        """Return the disc with both walls and the pitch curve."""
        from gearcam.kinds.cam.drawn import grooved

        return (grooved(result.part, result.cam.walls),)

    def picture(self, result: CamResult) -> Drawing:
        """Return the disc, turned, with its follower in the groove."""
        from gearcam.kinds.cam.drawn import follower, grooved

        (motion,), pose = result.cam.motions, result.design.output.pose
        shapes = follower(motion, pose, result.part.contour.reach)
        side = -1.0 if motion.clockwise else 1.0
        return grooved(result.part, result.cam.walls, shapes, angle=side * pose)

    def paths(self, result: CamResult, radius: float | None) -> Mapping[str, Contour]:
        """Return the pitch curve for a tool as wide as the groove, else a path along each wall."""
        from gearcam.kinds.cam.drawn import TOOL_RADIUS, cutter_way

        cam = _cam(result)
        widest = 0.5 * cam.width
        if radius is not None and radius > widest:
            what = "the cutter is wider than the groove"
            note = "the limit is half the groove's width, included"
            raise beyond_limit(what, TOOL_RADIUS, radius, widest, note, near=widest)
        if cam.relief is None and radius in (None, widest):
            return {TOOL_PATH: cam.inner.pitch_contour}
        tool = widest if radius is None else radius
        walls = [*cam.walls, *([cam.relief] if cam.relief else [])]
        return {
            f"{TOOL_PATH}_{wall.key}": cutter_way(wall.contour, tool, side=wall.side)
            for wall in walls
        }

    def facts(self, result: CamResult) -> dict[str, Any]:
        """Return sizes of the groove, its lost motion, and both walls."""
        cam, given = _cam(result), result.design.cam
        follower = cam.motion.follower
        return {
            "outer_diameter_mm": Fact(given.outer_diameter, "diameter of the blank"),
            "side": given.side or "front",
            "roller2_radius_mm": result.design.follower.roller2_radius,
            "roller_clearance_mm": given.roller_clearance or 0.0,
            "start_angle_deg": math.degrees(follower.start) if follower.angular else None,
            "groove": {
                "width_mm": Fact(cam.width, "width of the groove"),
                "depth_mm": Fact(given.groove_depth, "depth of the groove"),
                **{
                    wall.key: {"curvature": curvature(wall), **_trimmed(wall), **size(wall, made)}
                    for wall, made in zip(cam.walls, result.profiles, strict=True)
                },
            },
        }


def _trimmed(wall: Any) -> dict[str, Any]:
    return {name: value for name, value in trimming(wall).items() if name != "start_angle_deg"}


def _cam(result: CamResult) -> GrooveCam:
    """Return the cam, which is one of this form."""
    cam = result.cam
    if not isinstance(cam, GrooveCam):
        raise TypeError(f"{cam!r} is not a groove cam")
    return cam


def _recesses(result: CamResult) -> tuple[Recess, ...]:
    """Return the groove: in one, or the deeper half for the smaller of two rollers."""
    from gearcam.parts.body import Opening, Recess

    cam, given = _cam(result), result.design.cam
    inner, outer = result.profiles
    thickness, depth = given.thickness, given.groove_depth or 0.0
    front = given.side != "back"

    def recess(low: float, high: float, edges: tuple[Contour, Contour], width: float) -> Recess:
        island = Opening(kind="INNER", shape=edges[0], name="island")
        ends = (thickness - high, thickness - low) if front else (low, high)
        x, y = cam.inner.pitch_contour.vertices[0].tolist()
        return Recess(
            edge=edges[1],
            openings=(island,),
            low=ends[0],
            high=ends[1],
            front=front,
            width=width,
            place=(x, y),
        )

    if cam.relief is None:
        return (recess(0.0, depth, (inner, outer), cam.width),)
    wide, side = cam.relief.contour, cam.relief.side
    upper = (wide, outer) if side > 0 else (inner, wide)
    other = cam.outer if side > 0 else cam.inner
    width = cam.relief.follower.radius + other.follower.radius
    return (
        recess(0.0, 0.5 * depth, upper, width),
        recess(0.5 * depth, depth, (inner, outer), cam.width),
    )


FORMS.register(Groove())
