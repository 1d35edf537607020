"""The disc cam: a plate whose edge is the profile."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.facts import Fact
from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.kinds.cam.forms.base import C, F, Form, S
from gearcam.kinds.cam.wall_facts import curvature, ends_of, size, start_angle, trimming

if TYPE_CHECKING:
    from gearcam.cams.wall import Wall
    from gearcam.kinds.cam.forms.base import Parts
    from gearcam.laws.program import Program
    from gearcam.numeric.contour import Contour
    from gearcam.parts.blank import ShaftBlank
    from gearcam.parts.body import Mark, Part
    from gearcam.parts.openings import Workpiece
    from gearcam.pictures.drawings import Drawing

STEM: Final = "cam"
"""Stem of its files."""

TOOL_PATH: Final = "tool_path"
"""Stem of the files of a cutter's path."""

_RIM_PART: Final = 2.0 / 3.0
"""Default rim outside lightening holes, in thicknesses."""


def workpiece(form: Form[Any, Any, Any], name: str, within: str = "the outline") -> Workpiece:
    """Return the workpiece of a `form`: its `name`, and the edge that openings stay `within`."""
    from gearcam.parts.openings import Workpiece

    rim, process = _RIM_PART * form.given.thickness, form.output.marking
    return Workpiece(name=name, rim=rim, within=within, process=process)


def marker(wall: Wall, thickness: float, work: Workpiece) -> Mark:
    """Return the zero mark of a `wall` of a plate of a `thickness`, mm, made as `work`."""
    from gearcam.parts.marks import zero_mark

    _, points, normals = wall.places_at(np.zeros(1))
    if not len(points):
        what, key = "the profile is trimmed where the motion begins", "blank.zero_mark"
        remedy = (Adjustment(near={key: False}),)
        raise work.refusal(what, None, None, "there is no place for a zero mark", remedy, key)
    return zero_mark(complex(points[0]), -complex(normals[0]), thickness, work.process)


class Plates(Form[C, S, F]):
    """A plate that turns, with one wall, its profile; what forms with several plates share."""

    def disc(self, program: Program) -> DiscCam:
        """Return the disc cam for the follower of the design, its lift a `program`."""
        return make_cam(
            program,
            make_follower(self.follower, self.given),
            clockwise=self.given.clockwise,
            tolerance=self.chord_tolerance,
        )

    def plate(self, name: str, wall: Wall, blank: ShaftBlank) -> Part:
        """Return a plate as a part, with bore, hub and holes, its edge moved by the clearance.

        Parameters
        ----------
        name : str
            The stem of its files.
        wall : Wall
            Its wall.
        blank : ShaftBlank
            Its blank.
        """
        from gearcam.parts.make import finished, make_part

        thickness, work = self.given.thickness, workpiece(self, name)
        edge = finished(wall.contour, blank, work)
        mark = partial(marker, wall, thickness, work)
        return make_part(name, [edge], thickness, blank, work, mark, way=wall.hand)

    def parts(self, cam: C) -> tuple[Part, ...]:
        """Return the cam as its only part."""
        (wall,) = cam.walls
        return (self.plate(STEM, wall, self.blank),)

    def finished(self, cam: C, parts: Parts) -> tuple[Contour, ...]:  # noqa: ARG002
        """Return the outlines of the parts (see `Form.finished`)."""
        return tuple(part.contour for part in parts)

    def drawings(self, cam: C, parts: Parts) -> tuple[Drawing, ...]:
        """Return each plate with its pitch curve and prime circle (see `Form.drawings`)."""
        from gearcam.kinds.cam.drawings import plate

        rows = zip(parts, cam.walls, self.primes(cam), strict=True)
        return tuple(plate(*row) for row in rows)

    def picture(self, cam: C, parts: Parts) -> Drawing:
        """Return the plate, turned, below its follower (see `Form.picture`)."""
        from gearcam.kinds.cam.drawings import follower, plate

        (part,), (wall,), (prime,), pose = parts, cam.walls, self.primes(cam), self.output.pose
        shapes = follower(wall, pose, wall.contour.reach)
        return plate(part, wall, prime, shapes, angle=wall.hand * pose)

    def primes(self, cam: C) -> tuple[float, ...]:
        """Return the radius of each prime circle, for a flat follower of its base circle, mm."""
        return (cam.motions[0].follower.prime_radius,)

    def paths(self, cam: C, parts: Parts) -> Mapping[str, Contour]:
        """Return the path around each plate (see `Form.paths`)."""
        from gearcam.kinds.cam.drawings import cutter_way

        radius = self.output.tool_radius
        return {
            f"{TOOL_PATH}{wall.ending}": cutter_way(part.contour, radius or wall.follower.radius)
            for wall, part in zip(cam.walls, parts, strict=True)
        }

    def facts(self, cam: C, made: Sequence[Contour]) -> dict[str, Any]:
        """Return curvature, undercut and size of the profile (see `Form.facts`)."""
        (wall,), (finished,) = cam.walls, made
        place = wall.contact_place
        return {
            "curvature": curvature(wall),
            "start_angle_deg": start_angle(wall),
            **trimming(wall),
            "contact_mm": None
            if place is None
            else Fact(ends_of(place), "contact along the face", shown=True),
            "profile": size(wall, finished, self.blank.clearance),
        }


class Disc(Plates[DiscCam, CamSpec, FollowerSpec]):
    """A plate with one wall."""

    name = "disc"
    solvable = True
    doc = "a plate whose edge is the profile"

    def make(self, program: Program) -> DiscCam:
        """Return the cam."""
        return self.disc(program)


ENTRIES: Final = (Disc,)
