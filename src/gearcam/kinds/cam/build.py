"""From the design of a disc cam to its program, cam, profile, checks and part."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.cams.checks import KIND
from gearcam.cams.disc import CHORD_TOLERANCE, DiscCam, make_cam
from gearcam.cams.mechanism import Mechanism, make_mechanism
from gearcam.findings import Finding, in_order, run_checks
from gearcam.kinds.cam.design import STEM, CamDesign
from gearcam.laws.program import Program, make_program
from gearcam.numeric.arguments import angles
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.parts.blank import WheelBlank
from gearcam.result import Progress, Result
from gearcam.tolerances import DEFAULT, Tolerances

if TYPE_CHECKING:
    from gearcam.parts.body import Part
    from gearcam.parts.checks import PartsSubject
    from gearcam.study import Study

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

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
    >>> x, y = result.cam.outline.T  # mm, a circle of 31 mm
    >>> round(float(x.max() - x.min()), 2)
    62.0
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
            make = partial(make_program, motion) if isinstance(motion, Sequence) else motion.program
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

    def motion(self, theta: ArrayLike | None = None) -> Columns:
        """Return the follower's motion and the curvature of what it touches, exactly.

        Parameters
        ----------
        theta : float or (n,) array, rad, optional
            Cam angles, any number of turns; a turn in steps of the design's
            ``output.motion_step_deg``, both ends, where left out: the table of ``motion.csv``.

        Returns
        -------
        Columns
            ``theta_deg``; ``lift_mm`` and its derivatives by theta ``velocity_mm_per_rad``,
            ``acceleration_mm_per_rad2`` and ``jerk_mm_per_rad3`` (of an oscillating follower
            ``lift_deg``, ``velocity_deg_per_rad`` and so on); ``pressure_angle_deg``, signed;
            ``rho_pitch_mm`` and ``rho_profile_mm``, radii of curvature of pitch curve and profile
            before trimming: positive where convex, infinite where straight, that of the profile
            negative on a convex pitch curve where it is undercut. At a knot the values after it
            count.

        Raises
        ------
        DesignError
            If `theta` is no row of finite numbers.
        InfeasibleError
            If the cam cannot be made.
        """
        theta = self.angles if theta is None else angles("theta", theta)
        found = self.cam.motion(theta)
        oscillating = self.design.follower.oscillating
        unit, scale = ("deg", math.degrees(1.0)) if oscillating else ("mm", 1.0)
        names = ("lift_{}", "velocity_{}_per_rad", "acceleration_{}_per_rad2", "jerk_{}_per_rad3")
        return Columns(
            {
                "theta_deg": np.degrees(theta),
                **{
                    name.format(unit): scale * found[short]
                    for name, short in zip(names, ("s", "ds", "d2s", "d3s"), strict=True)
                },
                "pressure_angle_deg": np.degrees(found["pressure"]),
                "rho_pitch_mm": found["rho_pitch"],
                "rho_profile_mm": found["rho_profile"],
            }
        )

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

    def contact(self, theta: ArrayLike | None = None) -> Columns:
        """Return where the follower touches the profile (before clearance).

        Parameters
        ----------
        theta : float or (n,) array, rad, optional
            Cam angles, any number of turns; those of `motion` where left out.

        Returns
        -------
        Columns
            A row for each angle at which trimming has left the point; elsewhere the follower rests
            on a corner. ``theta_deg``; ``x_mm``, ``y_mm`` in the cam's frame; ``nx``, ``ny``, the
            outward unit normal of the metal there; ``fixed_x_mm``, ``fixed_y_mm``, the same point
            in the fixed frame, whose rows are the path of contact. Where the velocity jumps, the
            point after it counts.

        Raises
        ------
        DesignError
            If `theta` is no row of finite numbers.
        InfeasibleError
            If the cam cannot be made.
        """
        asked = self.angles if theta is None else angles("theta", theta)
        left, points, normals = self.cam.places_at(asked)
        fixed = points * np.exp((-1j if self.design.cam.clockwise else 1j) * left)
        return Columns(
            {
                "theta_deg": np.degrees(left),
                "x_mm": points.real,
                "y_mm": points.imag,
                "nx": normals.real,
                "ny": normals.imag,
                "fixed_x_mm": fixed.real,
                "fixed_y_mm": fixed.imag,
            }
        )

    @cached_property
    def parts(self) -> tuple[Part]:
        """The cam as the only part."""
        return (self.part,)

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

    def follow(self, profile: str | Path | ArrayLike, *, progress: Progress | None = None) -> Study:
        """Put the design's follower on a given profile: what motion it makes.

        Parameters
        ----------
        profile : path or (n, 2) array, mm
            A DXF file with one closed outline, a CSV file with the columns x_mm and y_mm, or such
            points: a closed outline in the cam's frame.
        progress : callable, optional
            Called with a stage's name, the stages done and their number.

        Returns
        -------
        Study
            Its columns are those of ``followed.csv`` (see docs/cams.md).

        Raises
        ------
        InfeasibleError
            If the follower cannot rest on the profile.
        DesignError
            If it is no profile, or the file cannot be read.
        """
        from gearcam.kinds.cam.follow import followed, read_profile
        from gearcam.study import Study

        if progress is not None:
            progress("profile", 0, 2)
        vertices, bulges = read_profile(profile)
        if progress is not None:
            progress("follow", 1, 2)
        with self.stage("follow"):
            columns, facts = followed(self.cam, vertices, bulges, self.angles)
        return Study(
            result=self,
            file=FOLLOWED,
            table=columns,
            measured={"followed": facts},
            findings=self.findings,
        )


def build(design: CamDesign, tolerances: Tolerances = DEFAULT) -> CamResult:
    """Return the result of a `design` to `tolerances`; it computes what it is asked for."""
    return CamResult(design, tolerances)
