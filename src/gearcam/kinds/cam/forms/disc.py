"""The disc cam: a plate whose edge is the profile."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact
from gearcam.cams.disc import CHORD_TOLERANCE, DiscCam, make_cam
from gearcam.cams.placing import make_follower
from gearcam.kinds.cam.forms.base import FORMS, Form
from gearcam.kinds.cam.wall_facts import curvature, ends_of, size, trimming

if TYPE_CHECKING:
    from gearcam.cams.cam import Cam
    from gearcam.kinds.cam.build import CamResult
    from gearcam.kinds.cam.design import CamDesign
    from gearcam.laws.program import Program
    from gearcam.numeric.contour import Contour
    from gearcam.parts.blank import WheelBlank
    from gearcam.parts.body import Part
    from gearcam.parts.openings import Workpiece
    from gearcam.pictures.drawings import Drawing

STEM: Final = "cam"
"""Stem of its files."""

TOOL_PATH: Final = "tool_path"
"""Stem of the files of a cutter's path."""

_RIM_PART: Final = 2.0 / 3.0
"""Default rim outside lightening holes, in thicknesses."""


def disc_cam(design: CamDesign, program: Program) -> DiscCam:
    """Return the disc cam that a `design` asks for, its lift a `program`."""
    return make_cam(
        program,
        make_follower(design.follower, design.cam),
        clockwise=design.cam.clockwise,
        tolerance=design.output.chord_tolerance or CHORD_TOLERANCE,
    )


def workpiece(name: str, thickness: float, within: str = "the outline") -> Workpiece:
    """Return the workpiece: `name`, `thickness` in mm, and the edge that openings stay `within`."""
    from gearcam.parts.openings import Workpiece

    return Workpiece(name=name, rim=_RIM_PART * thickness, within=within)


def plate_part(
    result: CamResult,
    name: str,
    profile: Contour,
    thickness: float,
    blank: WheelBlank | None = None,
) -> Part:
    """Return a plate as a part: bore, hub, holes, moved edges.

    Parameters
    ----------
    result : CamResult
        With the blank.
    name : str
        The stem of its files.
    profile : Contour
        Its edge before clearance.
    thickness : float, mm
        Of the plate.
    blank : WheelBlank, optional
        That of the design where left out.

    Returns
    -------
    Part
    """
    from gearcam.parts.make import finished, make_part

    place = workpiece(name, thickness)
    blank = blank or result.design.blank
    return make_part(name, [finished(profile, blank, place)], thickness, blank, place)


class Disc(Form):
    """A plate with one wall, its profile."""

    name = "disc"
    doc = "a plate whose edge is the profile"

    def make(self, design: CamDesign, program: Program) -> Cam:
        """Return the cam."""
        return disc_cam(design, program)

    def parts(self, result: CamResult) -> tuple[Part, ...]:
        """Return the cam as its only part."""
        return (plate_part(result, STEM, result.profile, result.design.cam.thickness),)

    def made(self, result: CamResult) -> tuple[Contour, ...]:
        """Return the outlines of the parts."""
        return tuple(part.contour for part in result.parts)

    def drawings(self, result: CamResult) -> tuple[Drawing, ...]:
        """Return each plate with its pitch curve and prime circle."""
        from gearcam.kinds.cam.drawn import plate

        rows = zip(result.parts, result.cam.walls, strict=True)
        return tuple(plate(part, wall) for part, wall in rows)

    def picture(self, result: CamResult) -> Drawing:
        """Return the plate, turned, below its follower."""
        from gearcam.kinds.cam.drawn import follower, plate

        (part,), (wall,), pose = result.parts, result.cam.walls, result.design.output.pose
        reach = float(np.hypot(*result.profile.vertices.T).max())
        side = -1.0 if wall.clockwise else 1.0
        return plate(part, wall, follower(wall, pose, reach), angle=side * pose)

    def paths(self, result: CamResult, radius: float | None) -> Mapping[str, Contour]:
        """Return the path around the plate."""
        from gearcam.kinds.cam.drawn import cutter_way

        return {TOOL_PATH: cutter_way(result.part.contour, radius or result.follower.radius)}

    def facts(self, result: CamResult) -> dict[str, Any]:
        """Return curvature, undercut and size of the profile."""
        (wall,), (made,) = result.cam.walls, result.contours
        place = wall.contact_place
        return {
            "curvature": curvature(wall),
            **trimming(wall),
            "contact_mm": None
            if place is None
            else Fact(ends_of(place), "contact along the face", shown=True),
            "profile": size(wall, made, result.design.blank.clearance),
        }


FORMS.register(Disc())
