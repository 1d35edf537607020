"""A cam as its design says: program, cam, profiles and parts, on demand."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import ABOVE, beyond_limit
from gearcam.kinds.cam.design import CamDesign
from gearcam.kinds.cam.forms.base import FORMS, Form
from gearcam.kinds.loaded_cam import LoadedCam
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import Pose
from gearcam.results.parts import PartsResult
from gearcam.results.table_rows import TableRows

if TYPE_CHECKING:
    from gearcam.cams.cam import Cam
    from gearcam.cams.carriers import Carrier
    from gearcam.cams.followers import Follower
    from gearcam.cams.spec import FollowerSpec
    from gearcam.cams.touch import WallTouch
    from gearcam.mechanics.driver_axis import DriverAxis
    from gearcam.parts.body import Part
    from gearcam.parts.checks import CheckedParts
    from gearcam.pictures.drawings import Drawing, Path
    from gearcam.sheets.wheel import Sense

_MOST_STEPS: Final = 1e6
"""Largest number of steps of a table."""


class MadeCam(LoadedCam, PartsResult):
    """A cam with its parts and their drawings, computed on demand (see `CamResult`).

    Parameters
    ----------
    design : CamDesign
        The design.
    tolerances : Tolerances
        Internal accuracy.
    """

    design: CamDesign
    before_output = ("program",)

    @property
    def solved(self) -> CamDesign:
        """The design with all its sizes."""
        return self.design

    @cached_property
    def form(self) -> Form[Any, Any, Any]:
        """What is special to the form of the cam."""
        return FORMS[self.design.form](self.solved)

    @cached_property
    def program(self) -> Program:
        """The lift over a turn."""
        with self.stage("program"):
            return self.form.program(self.tolerances)

    @cached_property
    def cam(self) -> Cam:
        """The cam; its curves and measures are computed on demand.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
        >>> x, y = result.cam.outline.T  # mm, the shaft at (0, 0)
        >>> float(y.max().round(3))
        25.0
        """
        program = self.program
        with self.stage("cam"), self.rows.named():
            return self.form.make(program)

    @property
    def rows(self) -> TableRows:
        """The rows of the tables of the design (see `Staged`)."""
        return TableRows(design=self.design, oscillating=self.design.follower.oscillating)

    @property
    def follower(self) -> Follower:
        """The follower; for conjugate cams that on the first."""
        return self.cam.motions[0].follower

    @property
    def driver(self) -> DriverAxis:
        """Name and unit of the cam's angle or travel in output."""
        return self.carrier.driver

    @property
    def carrier(self) -> Carrier:
        """What the cam does beneath its follower."""
        return self.cam.motions[0].carrier

    @cached_property
    def profiles(self) -> tuple[Contour, ...]:
        """The walls, counter-clockwise, in the cam's frame, in the order of `Cam.walls`."""
        cam = self.cam
        with self.stage("profile"):
            return tuple(wall.contour for wall in cam.walls)

    @property
    def profile(self) -> Contour:
        """The first wall: for a disc cam the profile."""
        return self.profiles[0]

    @property
    def angles(self) -> Array:
        """The cam angles of tables, rad, in steps of the design, both ends; or travels, mm.

        Raises
        ------
        InfeasibleError
            If there are more than a million.
        """
        period, driver = self.program.period, self.driver
        key, step = self.form.step
        if step < (least := period / _MOST_STEPS):
            what, scale = f"tables would have more than {_MOST_STEPS:.0f} rows", driver.scale
            note, near = "the limit is the smallest step", ABOVE * least * scale
            value, limit, unit = step * scale, least * scale, driver.unit
            raise beyond_limit(what, key, value, limit, note, near=near, unit=unit)
        return self.carrier.places(step, period)

    @property
    def ordered(self) -> bool:
        """Whether the design needs a part: a blank, or files of parts."""
        plain = {"csv", "curvature", "inspection", "caliper", "grinding"}
        blank = self.design.blank
        described = any(getattr(blank, one.name) != one.default for one in fields(blank))
        return described or not set(self.design.output.files) <= plain

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The cam as one or several parts.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
        >>> [(part.name, part.width) for part in result.parts]
        [('cam', 10.0)]
        """
        _ = self.profiles  # timed separately
        with self.stage("part"):
            return self.form.parts(self.cam)

    @property
    def part(self) -> Part:
        """The cam as a part, or its first part, with bore, hub, holes and clearance."""
        return self.parts[0]

    @cached_property
    def plates(self) -> tuple[Drawing, ...]:
        """A drawing of each part with its curves, in its own frame."""
        return self.form.drawings(self.cam, self.parts)

    @property
    def references(self) -> tuple[Drawing, ...]:
        """The parts with their curves, beside cutting paths that are offset by the kerf."""
        if not self.design.output.kerf:
            return ()
        return tuple(replace(one, name=f"{one.name}_reference") for one in self.plates)

    @property
    def assembly(self) -> str:
        """Stem of the files of the assembled cams; empty for a single part."""
        return "cams" if len(self.parts) > 1 else ""

    @property
    def poses(self) -> tuple[Pose, ...]:
        """Where each cam is on the shaft."""
        return tuple(Pose(height=height) for height in self.form.heights())

    @cached_property
    def touches(self) -> tuple[WallTouch, ...]:
        """Where the cam can press on its follower."""
        return tuple(replace(one, width=self.contact_width) for one in self.cam.touches)

    @property
    def follower_spec(self) -> FollowerSpec:
        """The table of the follower."""
        return self.design.follower

    @property
    def contact_width(self) -> float:
        """Width of the contact between cam and follower, mm."""
        return self.form.contact_width(self.cam)

    def paths(self) -> Mapping[str, Contour | Path]:
        """Return paths of a cutter's centre, by the stems of their files."""
        return self.form.paths(self.cam, self.parts)

    @cached_property
    def drawing(self) -> Drawing:
        """The assembled cam with its follower, at the angle of the design."""
        return self.form.picture(self.cam, self.parts)

    @property
    def profile_tolerance(self) -> float:
        """Chord tolerance of the profile, mm."""
        return self.profile.tolerance

    @property
    def chord_error(self) -> float:
        """Largest chord error of the finished walls, mm."""
        return max(one.chord_error for one in self.contours)

    @cached_property
    def contours(self) -> tuple[Contour, ...]:
        """The finished walls, with clearance, in the order of `Cam.walls`."""
        return self.form.finished(self.cam, self.parts) if self.ordered else self.profiles

    @property
    def contour(self) -> Contour:
        """The first finished wall: for a disc cam the profile with its clearance."""
        return self.contours[0]

    @cached_property
    def part_subject(self) -> CheckedParts:
        """Input of the checks of parts."""
        from gearcam.parts.checks import CheckedParts

        parts = self.parts
        return CheckedParts(
            parts=parts,
            names=tuple(part.name for part in parts),
            kerf=self.design.output.kerf,
            uncut=(False,) * len(parts),
            sought=not self.drafted,
            step="step" in self.design.output.files,
        )

    def turning(self, number: int) -> Sense | None:
        """Return how the part of a `number` turns (see `PartsResult.turning`)."""
        from gearcam.sheets.wheel import Sense

        wall = self.cam.walls[min(number, len(self.cam.walls) - 1)]
        if not self.carrier.around:
            return None
        zero = 0.5 * math.pi
        if wall.follower.has_centre:
            curve = replace(wall.curve, inset=0.0)
            lift = self.program.derivatives(np.zeros(1), 1)
            zero = float(np.angle(curve.trace(np.zeros(1), *lift)[0][0]))
        return Sense(zero=zero, clockwise=wall.hand < 0)

    def rows_of(self, number: int) -> Sequence[str]:
        """Return the names of the facts in the table of a part's drawing, by its `number`."""
        return self.form.rows_of(number)
