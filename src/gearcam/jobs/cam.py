"""The job of a disc cam.

A `CamJob` computes nothing until it is asked: the program, the cam, its profile, the checks, each
file.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from gearcam.cams.checks import KIND
from gearcam.cams.disc import CHORD_TOLERANCE, DiscCam, make_cam
from gearcam.cams.mechanism import Mechanism, make_mechanism
from gearcam.design import CamDesign
from gearcam.findings import Finding, in_order, run_checks
from gearcam.jobs.job import Job, Progress
from gearcam.jobs.written import Written, finish
from gearcam.laws.program import Program, make_program
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import CAM_KIND

if TYPE_CHECKING:
    from gearcam.parts.checks import PartsSubject
    from gearcam.parts.part import Part

NAME = "cam"
"""Stem of the cam's files."""

FOLLOWED = "followed.csv"
"""The motion that a given profile makes."""

_RIM_PART = 2.0 / 3.0
"""Rim that lightening holes keep where the design gives none, in thicknesses."""


class CamJob(Job):
    """A disc cam, computed on demand.

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
        with self._stage("program"):
            program = make_program(
                self.design.phases,
                self.tolerances,
                oscillating=self.design.follower.oscillating,
            )
            _ = self.design_hash  # now: points that a rise has read may change
            return program

    @cached_property
    def mechanism(self) -> Mechanism:
        """The follower's numbers."""
        return make_mechanism(self.design.follower, self.design.cam)

    @cached_property
    def cam(self) -> DiscCam:
        """The cam; its curves and measures are computed when they are asked for."""
        program = self.program
        with self._stage("cam"):
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
        with self._stage("profile"):
            return cam.contour

    @property
    def ordered(self) -> bool:
        """Whether the design orders a part: a blank, or files that are made from parts."""
        from gearcam.parts.blank import WheelBlank

        plain = {"csv", "curvature"}
        blank = WheelBlank(timing_marks=False)
        return self.design.blank != blank or not set(self.design.output.files) <= plain

    @cached_property
    def part(self) -> Part:
        """The cam as a part: bore, hub, holes, moved edges."""
        from gearcam.parts.make import finished, make_part
        from gearcam.parts.openings import RIM, Place

        profile, thickness = self.profile, self.design.cam.thickness
        with self._stage("part"):
            place = Place(wheel=None, module=_RIM_PART * thickness / RIM)
            blank = self.design.blank
            return make_part(NAME, [finished(profile, blank, place)], thickness, blank, place)

    @property
    def contour(self) -> Contour:
        """The profile as made: with its clearance."""
        return self.part.contour if self.ordered else self.profile

    @cached_property
    def part_subject(self) -> PartsSubject:
        """What the checks of parts look at."""
        from gearcam.parts.checks import PartsSubject

        kerf = self.design.output.kerf
        return PartsSubject(parts=(self.part,), names=("cam",), kerf=kerf, uncut=(False,))

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What the checks found: errors first."""
        cam = self.cam
        with self._stage("checks"):
            found = run_checks(KIND, cam, self.design.limits)
        if self.ordered:
            subject = self.part_subject
            with self._stage("checks"):
                found += run_checks(CAM_KIND, subject, self.design.limits)
        return in_order(found)

    def summary(
        self,
        files: Mapping[str, str | None] | None = None,
        extras: dict[str, Any] | None = None,
    ) -> dict[str, Any]:
        """Return the summary of the build (see `Job.summary`): `files`, `extras`."""
        from gearcam.jobs.cam_summary import summarize

        return summarize(self, files or {}, extras or {})

    def _export(self, kind: str, extras: dict[str, Any]) -> dict[str, bytes]:
        from gearcam.jobs.cam_files import export

        return export(self, kind, extras)

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
        from gearcam.jobs.followed import followed, read_profile

        if progress is not None:
            progress("profile", 0, 2)
        vertices, bulges = read_profile(profile)
        with self._stage("follow"):
            columns, facts = followed(self, vertices, bulges)
        if progress is not None:
            progress("writing", 1, 2)
        folder = Path(directory) / self.design.name
        summary = self.summary(self._beside(folder, FOLLOWED), {"followed": facts})
        contents = {FOLLOWED: table_bytes(columns)}
        return finish(folder, contents, summary, self.findings, keep=True)
