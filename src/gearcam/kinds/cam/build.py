"""From the design of a disc cam to its program, cam, profile, checks and part."""

from __future__ import annotations

import math
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.cams.checks import KIND
from gearcam.cams.disc import CHORD_TOLERANCE, DiscCam, make_cam
from gearcam.cams.mechanism import Mechanism, make_mechanism
from gearcam.findings import Finding, in_order, run_checks
from gearcam.kinds.cam.design import STEM, CamDesign
from gearcam.laws.program import Program, make_program
from gearcam.numeric.arrays import Array
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.parts.blank import WheelBlank
from gearcam.result import Progress, Result, Written
from gearcam.tolerances import DEFAULT, Tolerances

if TYPE_CHECKING:
    from gearcam.parts.body import Part
    from gearcam.parts.checks import PartsSubject

FOLLOWED: Final = "followed.csv"
"""The motion that a given profile makes."""

_WHOLE: Final = 1e-9
"""Part of a step by which a turn may fall short of a whole number of them: rounding."""

_RIM_PART = 2.0 / 3.0
"""Rim that lightening holes keep where the design gives none, in thicknesses."""


class CamResult(Result):
    """What comes of the design of a disc cam, computed on demand.

    Parameters
    ----------
    design : CamDesign
        What is asked for.
    tolerances : Tolerances
        Inner accuracy.
    """

    design: CamDesign
    stages = MappingProxyType(
        {"program": "program", "cam": "cam", "profile": "profile", "checks": "findings"}
    )

    @cached_property
    def program(self) -> Program:
        """The lift over a turn."""
        with self.stage("program"):
            motion, swings = self.design.motion, self.design.follower.oscillating
            make = partial(make_program, motion) if isinstance(motion, tuple) else motion.program
            return make(self.tolerances, oscillating=swings)

    @cached_property
    def mechanism(self) -> Mechanism:
        """The follower's numbers."""
        return make_mechanism(self.design.follower, self.design.cam)

    @cached_property
    def cam(self) -> DiscCam:
        """The cam; its curves and measures are computed when they are asked for."""
        program = self.program
        with self.stage("cam"):
            return make_cam(
                program,
                self.mechanism,
                clockwise=self.design.cam.clockwise,
                tolerance=self.design.output.chord_tolerance or CHORD_TOLERANCE,
            )

    @cached_property
    def profile(self) -> Contour:
        """The profile, counter-clockwise, in the cam's frame."""
        cam = self.cam
        with self.stage("profile"):
            return cam.contour

    @property
    def angles(self) -> Array:
        """The cam angles of tables, (n,) rad: a turn in steps of the design, both ends."""
        step = self.design.output.motion_step
        return step * np.arange(math.floor(2.0 * math.pi / step + _WHOLE) + 1.0)

    @property
    def ordered(self) -> bool:
        """Whether the design orders a part: a blank, or files that are made from parts."""
        plain = {"csv", "curvature"}
        blank = WheelBlank(timing_marks=False)
        return self.design.blank != blank or not set(self.design.output.files) <= plain

    @cached_property
    def part(self) -> Part:
        """The cam as a part: bore, hub, holes, moved edges."""
        from gearcam.parts.make import finished, make_part
        from gearcam.parts.openings import RIM, Workpiece

        profile, thickness = self.profile, self.design.cam.thickness
        with self.stage("part"):
            place = Workpiece(name=STEM, module=_RIM_PART * thickness / RIM)
            blank = self.design.blank
            return make_part(STEM, [finished(profile, blank, place)], thickness, blank, place)

    @property
    def contour(self) -> Contour:
        """The profile as made: with its clearance."""
        return self.part.contour if self.ordered else self.profile

    @cached_property
    def part_subject(self) -> PartsSubject:
        """What the checks of parts look at."""
        from gearcam.parts.checks import PartsSubject

        kerf = self.design.output.kerf
        return PartsSubject(parts=(self.part,), names=(STEM,), kerf=kerf, uncut=(False,))

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What the checks found: errors first."""
        cam = self.cam
        with self.stage("checks"):
            found = run_checks(KIND, cam, self.design.limits)
        if self.ordered:
            subject = self.part_subject
            with self.stage("checks"):
                found += run_checks(PARTS_KIND, subject, self.design.limits)
        return in_order(found)

    def follow(
        self,
        profile: str | Path,
        directory: str | Path = "output",
        progress: Progress | None = None,
    ) -> Written:
        """Run the design's follower on a given profile and write the motion it makes.

        Parameters
        ----------
        profile : path
            A DXF file with one closed outline, or a CSV file with the columns x_mm and y_mm.
        directory : path
            Parent folder.
        progress : callable, optional
            Called with a stage's name, the stages done and their number.

        Returns
        -------
        Written
            With ``followed.csv``; files of a build stay.

        Raises
        ------
        InfeasibleError
            If the follower cannot rest on the profile.
        DesignError
            If the file cannot be read.
        """
        from gearcam.export.table import table_bytes
        from gearcam.kinds.cam.follow import followed, read_profile

        if progress is not None:
            progress("profile", 0, 2)
        vertices, bulges = read_profile(profile)
        with self.stage("follow"):
            columns, facts = followed(self.cam, vertices, bulges, self.angles)
        if progress is not None:
            progress("writing", 1, 2)
        return self.keep({FOLLOWED: table_bytes(columns)}, directory, {"followed": facts})


def build(design: CamDesign, tolerances: Tolerances = DEFAULT) -> CamResult:
    """Return the result of a `design` to `tolerances`; it computes what it is asked for."""
    return CamResult(design, tolerances)
