"""The translating cam: a plate that slides past its follower, with one wall or a groove."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted
from gearcam.cams.placing import make_follower_over_plate
from gearcam.cams.sliding import SlidingCam, make_sliding
from gearcam.cams.wall import CHORD_TOLERANCE
from gearcam.designs.faults import Fault, show
from gearcam.kinds.cam.blank import CamBlank
from gearcam.kinds.cam.forms.base import FORMS, Form, Keys
from gearcam.kinds.cam.forms.disc import STEM, TOOL_PATH, workpiece
from gearcam.kinds.cam.wall_facts import curvature, trimming
from gearcam.laws.phases_of_lift import DwellPhase, Phase
from gearcam.laws.program import Program, make_program
from gearcam.numeric.pose import Pose

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.cams.sliding import SlidingWall
    from gearcam.kinds.cam.build import CamResult
    from gearcam.kinds.cam.design import CamDesign
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Opening, Part
    from gearcam.pictures.drawings import Drawing, Path, Shape

_ROUNDING = 1e-9
"""Relative difference of a cutter's radius from half the groove that is rounding of digits."""


class Translating(Form):
    """A plate that slides past its follower."""

    name = "translating"
    doc = "a plate that slides past its follower, with one wall or a groove"
    takes: ClassVar[Keys] = {
        "follower": (
            "type", "motion", "roller_radius", "dome_radius", "arm", "pivot_distance", "axis",
            "pivot_height",
        ),
        "cam": (
            "form", "thickness", "walls", "run_in", "run_out", "groove_depth", "roller_clearance",
            "side",
        ),
        "blank": (
            "length", "height", "bolts", "bolt_diameter", "bolt_spacing", "bolt_height", "density",
            "clearance",
        ),
        "output": ("place", "travel_step"),
    }  # fmt: skip
    needs: ClassVar[Keys] = {"blank": ("height",)}
    rows = (
        "cam.travel_mm", "cam.run_in_mm", "cam.run_out_mm", "cam.axis_deg", "cam.pivot_height_mm",
        "cam.groove.width_mm", "cam.groove.depth_mm", "cam.roller_clearance_mm", "cam.lost_motion",
    )  # fmt: skip

    def faults(self, parts: Mapping[str, Any]) -> Iterator[Fault]:
        """Yield what a translating cam cannot have."""
        follower, cam = parts["follower"], parts["cam"]
        blank, output = parts.get("blank"), parts.get("output")
        if follower.flat:
            message = '"flat": over a translating cam a flat face envelops no profile'
            yield Fault(("follower", "type"), message, "flat", '"roller", "domed" or "point"')
        if follower.oscillating and follower.axis:
            message = (
                f"{show(math.degrees(follower.axis))}: does not apply to an oscillating follower"
            )
            yield Fault(("follower", "axis_deg"), message, follower.axis, "leave it out")
        if not follower.oscillating and follower.pivot_height:
            message = f"{show(follower.pivot_height)}: a translating follower has no pivot"
            rule = 'with motion = "oscillating"'
            yield Fault(("follower", "pivot_height_mm"), message, follower.pivot_height, rule)
        yield from _groove_faults(follower, cam, blank, output)

    def program(self, design: CamDesign, tolerances: Tolerances) -> Program:
        """Return the lift over the way, with its run before and after."""
        swings = design.follower.oscillating
        return make_program(_phases(design), tolerances, oscillating=swings, closed=False)

    def make(self, design: CamDesign, program: Program) -> SlidingCam:
        """Return the cam."""
        cam, blank = design.cam, _blank(design)
        way = math.fsum(float(one.angle) for one in _phases(design))
        _demand_reached(design.output.place or 0.0, way)
        return make_sliding(
            program,
            make_follower_over_plate(design.follower),
            height=blank.height or 0.0,
            length=blank.length,
            groove=cam.walls == "both",
            clearance=cam.roller_clearance or 0.0,
            tolerance=design.output.chord_tolerance or CHORD_TOLERANCE,
        )

    def parts(self, result: CamResult) -> tuple[Part, ...]:
        """Return the plate, with its wall or its groove, and its bolts."""
        from gearcam.parts.body import Opening, Part, Recess
        from gearcam.parts.openings import demand_apart

        design, cam = result.design, _made(result)
        thickness, depth = design.cam.thickness, design.cam.groove_depth
        holes, recesses = list(_bolts(result)), []
        taken = holes
        if cam.groove is not None:
            slot = Opening(kind="GROOVE", shape=cam.groove, name="groove")
            taken = [*holes, slot]
            if depth is None:
                holes = taken
            else:
                front = design.cam.side != "back"
                low, high = (thickness - depth, thickness) if front else (0.0, depth)
                x, y = cam.lower.pitch_line[0].tolist()
                recess = Recess(
                    edge=cam.groove, low=low, high=high, front=front, width=cam.width, place=(x, y)
                )
                recesses = [recess]
        row = _blank(design)
        sizes = {"bolt_spacing_mm": row.bolt_spacing, "bolt_height_mm": row.bolt_height}
        places = {key: size for key, size in sizes.items() if size is not None}
        demand_apart(taken, row, cam.edge.polygon, workpiece(STEM, thickness), places)
        return (
            Part(
                name=STEM,
                contours=(cam.edge,),
                width=thickness,
                openings=tuple(holes),
                recesses=tuple(recesses),
                turns=False,
            ),
        )

    def made(self, result: CamResult) -> tuple[Contour, ...]:
        """Return the metal behind each wall, as made."""
        return tuple(wall.contour for wall in _made(result).walls)

    def drawings(self, result: CamResult) -> tuple[Drawing, ...]:
        """Return the plate with its pitch curve."""
        return (_drawing(result),)

    def picture(self, result: CamResult) -> Drawing:
        """Return the plate below its follower."""
        from gearcam.kinds.cam.drawn import follower

        place, (motion,) = result.design.output.place or 0.0, result.cam.motions
        reach = 0.5 * float(np.ptp(result.profile.vertices))
        shapes = follower(motion, place, reach)
        return _drawing(result, shapes, place)

    def paths(self, result: CamResult, radius: float | None) -> Mapping[str, Contour | Path]:
        """Return the path around the plate, or through the groove."""
        from gearcam.kinds.cam.drawn import cutter_way
        from gearcam.pictures.drawings import Path

        cam = _made(result)
        if cam.groove is None:
            return {TOOL_PATH: cutter_way(cam.edge, radius or result.follower.radius)}
        radius = radius or 0.5 * cam.width
        if abs(2.0 * radius - cam.width) <= _ROUNDING * cam.width:
            return {TOOL_PATH: Path(points=cam.lower.pitch_line, closed=False)}
        return {TOOL_PATH: cutter_way(cam.groove, radius, side=-1)}

    def leading(self, result: CamResult) -> str:  # noqa: ARG002
        """Return which of its sizes stands in the headline."""
        return "travel_mm"

    def sizes(self, result: CamResult) -> dict[str, Any]:
        """Return its sizes, as facts."""
        given, cam = result.design, _cam(result)
        swings, plate = given.follower.oscillating, cam.plate
        return {
            "travel_mm": Fact(cam.way, "travel"),
            "run_in_mm": given.cam.run_in or None,
            "run_out_mm": given.cam.run_out or None,
            "axis_deg": math.degrees(given.follower.axis or 0.0) or None,
            "pivot_height_mm": (given.follower.pivot_height or 0.0) if swings else None,
            "length_mm": plate.right - plate.left,
            "height_mm": plate.high - plate.low,
        }

    def facts(self, result: CamResult) -> dict[str, Any]:
        """Return curvature, undercut and length of the walls, and the lost motion in a groove."""
        cam, given = _cam(result), result.design.cam
        lead, rows = cam.motion.follower, zip(cam.walls, result.contours, strict=True)
        told = {
            wall.key or "profile": {
                "curvature": curvature(wall),
                **{name: one for name, one in trimming(wall).items() if name != "start_angle_deg"},
                "length_mm": wall.size.perimeter,
                "least_vertices": wall.sampler.least,
                "vertices": len(wall.line),
                "chord_error_mm": made.chord_error,
            }
            for wall, made in rows
        }
        start = math.degrees(lead.start) if lead.angular else None
        clearance = result.design.blank.clearance
        if cam.groove is None:
            return {"start_angle_deg": start, "clearance_mm": clearance or None, **told}
        return {
            "start_angle_deg": start,
            "roller_clearance_mm": given.roller_clearance or 0.0,
            "groove": {
                "width_mm": Fact(cam.width, "width of the groove"),
                "depth_mm": Fact(given.groove_depth or given.thickness, "depth of the groove"),
                "area_mm2": cam.groove.moments.area,
                **told,
            },
        }


def _groove_faults(follower: Any, cam: Any, blank: Any, output: Any) -> Iterator[Fault]:
    """Yield the faults of grooves, and of keys that only they have."""
    if cam.walls != "both":
        for name in ("groove_depth", "roller_clearance", "side"):
            value, key = getattr(cam, name), name if name == "side" else f"{name}_mm"
            if value is not None:
                message = f"{show(value)}: does not apply to a cam with one wall"
                yield Fault(("cam", key), message, value, 'with walls = "both"')
        return
    if follower.type != "roller":
        message = f"{show(follower.type)}: a groove holds a roller"
        yield Fault(("follower", "type"), message, follower.type, '"roller"')
    if cam.groove_depth is not None and cam.groove_depth >= cam.thickness:
        message = f"{show(cam.groove_depth)}: the groove would have no floor"
        rule = f"below the thickness of {formatted(cam.thickness)} mm; a through slot if left out"
        yield Fault(("cam", "groove_depth_mm"), message, cam.groove_depth, rule)
    if cam.side is not None and cam.groove_depth is None:
        message = f"{show(cam.side)}: the groove goes through the plate"
        yield Fault(("cam", "side"), message, cam.side, "with groove_depth_mm")
    if blank is not None and blank.clearance:
        message = f"{show(blank.clearance)}: the clearance of a groove is that of its roller"
        rule = "cam.roller_clearance_mm instead"
        yield Fault(("blank", "clearance_mm"), message, blank.clearance, rule)
    if output is not None and cam.groove_depth is not None:
        yield from _milled_faults(output)


def _milled_faults(output: Any) -> Iterator[Fault]:
    """Yield what is wrong with files for cutters if the groove has a floor."""
    if output.kerf:
        message = f"{show(output.kerf)}: not for a groove with a floor, which is milled"
        yield Fault(("output", "kerf_mm"), message, output.kerf, "leave it out")
    if "cut-svg" in output.files:
        message = "not for a groove with a floor, which is milled"
        rule = "other files, such as dxf and tool-path"
        yield Fault(("output", "files"), message, "cut-svg", rule)


def _phases(design: CamDesign) -> list[Phase]:
    """Return the phases of a design with its run before and after."""
    motion = design.motion
    if not isinstance(motion, Sequence):
        raise TypeError("the motion of a translating cam is given by phases")
    before, after = ([DwellPhase(angle=run)] if run else [] for run in design.cam.runs)
    return [*before, *motion, *after]


def _blank(design: CamDesign) -> CamBlank:
    """Return the blank, which is one of a cam."""
    blank = design.blank
    if not isinstance(blank, CamBlank):
        raise TypeError(f"{blank!r} is not the blank of a cam")
    return blank


def _cam(result: CamResult) -> SlidingCam:
    """Return the cam, which is one of this form."""
    cam = result.cam
    if not isinstance(cam, SlidingCam):
        raise TypeError(f"{cam!r} is not a translating cam")
    return cam


def _made(result: CamResult) -> SlidingCam:
    """Return the finished cam: a single wall is moved back by the clearance of the blank."""
    cam, clearance = _cam(result), result.design.blank.clearance
    if not clearance:
        return cam
    lower: SlidingWall = cam.lower
    wide = replace(lower.follower, radius=lower.follower.radius + clearance)
    return replace(cam, lower=replace(lower, follower=wide))


def _bolts(result: CamResult) -> Iterator[Opening]:
    """Yield the bolt holes, a row centred on the length of the plate."""
    from gearcam.parts.body import Opening
    from gearcam.parts.shapes import Circle

    blank, plate = _blank(result.design), _cam(result).plate
    for number in range(blank.bolts):
        aside = (number - 0.5 * (blank.bolts - 1)) * (blank.bolt_spacing or 0.0)
        place = (0.5 * (plate.left + plate.right) + aside, plate.low + (blank.bolt_height or 0.0))
        shape = Circle(center=np.array(place), diameter=blank.bolt_diameter)
        yield Opening(kind="HOLE", shape=shape, name=f"bolt hole {number + 1}")


def _drawing(result: CamResult, follower: Sequence[Shape] = (), way: float = 0.0) -> Drawing:
    """Return the plate with its pitch curve, moved by `way` below a follower."""
    from gearcam.pictures.drawings import (
        BLANK,
        CENTER,
        CROSS_SIZE,
        FOLLOWER,
        GROOVE,
        OUTER_WALL,
        PITCH,
        PROFILE,
        Cross,
        Drawing,
        Feature,
        Path,
        part_features,
        place,
    )  # fmt: skip

    part, cam = result.part, _cam(result)
    moving = [
        replace(one, layer=GROOVE) if one.layer == OUTER_WALL else one
        for one in part_features(part, outline=PROFILE if cam.groove is None else BLANK)
    ]
    if cam.motion.follower.radius:
        moving.append(Feature(layer=PITCH, shape=Path(points=cam.lower.pitch_line, closed=False)))
    features = list(place(moving, Pose(shift=way)))
    features += [Feature(layer=FOLLOWER, shape=shape) for shape in follower]
    size = CROSS_SIZE * float(np.ptp(part.contour.vertices))
    features.append(Feature(layer=CENTER, shape=Cross(center=np.zeros(2), size=size)))
    return Drawing(name=part.name, features=tuple(features))


def _demand_reached(place: float, way: float) -> None:
    """Refuse a place of the assembly drawing, mm, beyond the travel of the cam."""
    if place > way:
        what = "the assembly drawing is beyond the travel of the cam"
        raise beyond_limit(
            what,
            "output.travel_mm",
            place,
            way,
            "the limit is its whole travel, included",
            near=way,
        )


FORMS.register(Translating())
