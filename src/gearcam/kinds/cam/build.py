"""From the design of a disc cam to its program, cam, profile, checks and part."""

from __future__ import annotations

import math
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.cams.checks import KIND
from gearcam.findings import Finding, in_order, run_checks
from gearcam.kinds.cam.blank import CamBlank
from gearcam.kinds.cam.design import CamDesign
from gearcam.kinds.cam.forms.base import FORMS, Form
from gearcam.kinds.cam.steps import WHOLE, even_angles
from gearcam.laws.program import Program
from gearcam.numeric.arguments import angles, one_of
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.contour import Contour
from gearcam.numeric.piecewise import with_both_sides
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.result import Progress, Result
from gearcam.tolerances import DEFAULT, Tolerances

if TYPE_CHECKING:
    from gearcam.cams.cam import Cam
    from gearcam.cams.mechanism import Mechanism
    from gearcam.cams.wall import PitchMotion, Wall
    from gearcam.drawings import Drawing
    from gearcam.parts.body import Part
    from gearcam.parts.checks import PartsSubject
    from gearcam.sheets.sheet import Sheet
    from gearcam.study import Study

FOLLOWED: Final = "followed.csv"
"""The motion that a given profile makes."""


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
    before_output = ("program",)
    stages = MappingProxyType(
        {"program": "program", "cam": "cam", "profile": "profile", "checks": "findings"}
    )

    @cached_property
    def program(self) -> Program:
        """The lift over a turn."""
        with self.stage("program"):
            return self.form.program(self.design, self.tolerances)

    @property
    def form(self) -> Form:
        """What the cam's form says of it."""
        return FORMS[self.design.cam.form]

    @cached_property
    def cam(self) -> Cam:
        """The cam; its curves and measures are computed when they are asked for."""
        program = self.program
        with self.stage("cam"):
            return self.form.make(self.design, program)

    @property
    def mechanism(self) -> Mechanism:
        """The follower's numbers, of conjugate cams those on the first."""
        return self.cam.motions[0].mechanism

    @cached_property
    def profiles(self) -> tuple[Contour, ...]:
        """The walls, counter-clockwise, in the cam's frame, in the order of `Cam.walls`."""
        cam = self.cam
        with self.stage("profile"):
            return tuple(wall.contour for wall in cam.walls)

    @property
    def profile(self) -> Contour:
        """The first of them: of a disc cam the profile."""
        return self.profiles[0]

    @property
    def angles(self) -> Array:
        """The cam angles of tables, (n,) rad: a turn in steps of the design, both ends."""
        return even_angles(self.design.output, self.mechanism.driver, self.program.open)

    def motion(self, theta: ArrayLike | None = None) -> Columns:
        """Return the follower's motion and the curvature of what it touches, exactly.

        Parameters
        ----------
        theta : float or (n,) array, rad, optional
            Cam angles, any number of turns; a turn in steps of the design's
            ``output.motion_step_deg``, both ends, where left out: the table of ``motion.csv``. Of a
            translating cam ways, mm, from 0 to the whole one, and steps of ``output.way_step_mm``.

        Returns
        -------
        Columns
            ``theta_deg``, of a translating cam ``u_mm``; ``lift_mm`` and its derivatives by theta
            ``velocity_mm_per_rad``, ``acceleration_mm_per_rad2`` and ``jerk_mm_per_rad3`` (of an
            oscillating follower ``lift_deg``, ``velocity_deg_per_rad`` and so on, of a translating
            cam ``velocity_mm_per_mm`` and so on); ``pressure_angle_deg``, signed;
            ``rho_pitch_mm`` and ``rho_profile_mm``, radii of curvature of pitch curve and profile
            before trimming: positive where convex, infinite where straight, that of the profile
            negative on a convex pitch curve where it is undercut. At a knot the values after it
            count. Of conjugate cams and grooves names of columns tell which, such as
            ``pressure_angle_2_deg`` and ``rho_profile_outer_mm``.

        Raises
        ------
        DesignError
            If `theta` is no row of finite numbers, or leaves the way of a translating cam.
        InfeasibleError
            If the cam cannot be made.
        """
        return self.motion_at(self._asked(theta))

    @cached_property
    def motion_of_turn(self) -> Columns:
        """The table of `motion` over a turn, at both sides of all knots."""
        turn = self.angles
        turn = np.append(turn[turn < 2.0 * math.pi], np.nextafter(2.0 * math.pi, 0.0))
        return self.motion_at(with_both_sides(turn, self.program.knots))

    def _asked(self, theta: ArrayLike | None) -> Array:
        """Return cam angles, rad, of what people give: angles, rad, or ways, mm."""
        if theta is None:
            return self.angles
        driver = self.mechanism.driver
        if not self.form.slides:
            return angles("theta", theta)
        slack = WHOLE * driver.turn
        ways = angles("theta", theta, 0.0, driver.turn, slack, driver.unit)
        return np.minimum(ways / driver.scale, 2.0 * math.pi)

    def motion_at(self, theta: Array) -> Columns:
        """Return the table of `motion` at cam angles `theta`, rad, of a way 2*pi at its end."""
        driver = self.mechanism.driver
        motions, walls = self.cam.motions, self.cam.walls
        found = motions[0].motion(theta)
        columns = {driver.column: driver.scale * theta}
        names = zip(self.mechanism.motion_scales.items(), ("s", "ds", "d2s", "d3s"), strict=True)
        columns |= {name: scale * found[short] for (name, scale), short in names}
        told = [found, *(one.motion(theta) for one in motions[1:])]
        for one, values in zip(motions, told, strict=True):
            columns[pressure_column(one)] = np.degrees(values["pressure"])
        for one, values in zip(motions, told, strict=True):
            columns[rho_column("pitch", one)] = values["rho_pitch"]
        for wall in walls:
            columns[rho_column("profile", wall)] = wall.radii(theta)
        return Columns(columns)

    @property
    def ordered(self) -> bool:
        """Whether the design orders a part: a blank, or files that are made from parts."""
        plain = {"csv", "curvature", "inspection"}
        blank = CamBlank()
        return self.design.blank != blank or not set(self.design.output.files) <= plain

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The cam as it is made: as one part, or as several."""
        profiles = self.profiles  # a stage of its own
        with self.stage("part"):
            return self.form.parts(self) if profiles else ()

    @property
    def part(self) -> Part:
        """The cam as a part, of several parts the first: bore, hub, holes, moved edges."""
        return self.parts[0]

    @cached_property
    def to_cut(self) -> tuple[Drawing, ...]:
        """What a cutter follows: the parts, or paths with the kerf."""
        from gearcam.drawings import cut_drawing

        kerf = self.design.output.kerf
        return tuple(cut_drawing(one, kerf) for one in self.form.drawings(self))

    @cached_property
    def drawing(self) -> Drawing:
        """The assembled cam with its follower, at the angle of the design."""
        return self.form.picture(self)

    @cached_property
    def sheets(self) -> tuple[Sheet, ...]:
        """The workshop drawings of the parts."""
        from gearcam.kinds.cam.drawn import sheets

        return sheets(self)

    def _wall(self, key: str | None) -> Wall:
        """Return the wall with a key, the first where left out."""
        walls = {one.key: one for one in self.cam.walls}
        return walls[next(iter(walls)) if key is None else one_of("wall", key, tuple(walls))]

    def contact(self, theta: ArrayLike | None = None, wall: str | None = None) -> Columns:
        """Return where the follower touches the profile, or a wall (before clearance).

        Parameters
        ----------
        theta : float or (n,) array, rad, optional
            Cam angles, or ways, mm, as of `motion`; those of its table where left out.
        wall : str, optional
            The key of a wall; the first where left out.

        Returns
        -------
        Columns
            A row for each angle at which trimming has left the point; elsewhere the follower rests
            on a corner. ``theta_deg`` or ``u_mm``; ``x_mm``, ``y_mm`` in the cam's frame; ``nx``,
            ``ny``, the outward unit normal of the metal there; ``fixed_x_mm``, ``fixed_y_mm``, the
            same point in the fixed frame, whose rows are the path of contact. Where the velocity
            jumps, the point after it counts.

        Raises
        ------
        DesignError
            If `theta` is no row of finite numbers, leaves the way of a translating cam, or there is
            no such wall.
        InfeasibleError
            If the cam cannot be made.
        """
        left, points, normals = self._wall(wall).places_at(self._asked(theta))
        driver = self.mechanism.driver
        if self.form.slides:
            fixed = points + driver.scale * left
        else:
            fixed = points * np.exp((-1j if self.design.cam.clockwise else 1j) * left)
        return Columns(
            {
                driver.column: driver.scale * left,
                "x_mm": points.real,
                "y_mm": points.imag,
                "nx": normals.real,
                "ny": normals.imag,
                "fixed_x_mm": fixed.real,
                "fixed_y_mm": fixed.imag,
            }
        )

    @cached_property
    def contours(self) -> tuple[Contour, ...]:
        """The walls as made, in the order of `Cam.walls`: with clearance."""
        return self.form.made(self) if self.ordered else self.profiles

    @property
    def contour(self) -> Contour:
        """The first of them: of a disc cam the profile with its clearance."""
        return self.contours[0]

    @cached_property
    def part_subject(self) -> PartsSubject:
        """What the checks of parts look at."""
        from gearcam.parts.checks import PartsSubject

        parts = self.parts
        return PartsSubject(
            parts=parts,
            names=tuple(part.name for part in parts),
            kerf=self.design.output.kerf,
            uncut=(False,) * len(parts),
        )

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What the checks found: errors first."""
        cam = self.cam
        with self.stage("checks"):
            found = run_checks(KIND, cam, self.design.limits)
            if any(one.code in ("pressure-angle", "jamming") for one in found):
                from gearcam.kinds.cam.pressed import explained

                found = explained(self, found)
            if any(one.code == "coarse-rows" for one in found):
                from gearcam.kinds.cam.coarse import helped

                found = tuple(
                    helped(self, one) if one.code == "coarse-rows" else one for one in found
                )
        if self.ordered:
            subject = self.part_subject
            with self.stage("checks"):
                found += run_checks(PARTS_KIND, subject, self.design.limits)
        return in_order(found)

    def follow(
        self,
        profile: str | Path | ArrayLike,
        *,
        wall: str | None = None,
        progress: Progress | None = None,
    ) -> Study:
        """Put the design's follower on a given profile: what motion it makes.

        Parameters
        ----------
        profile : path or (n, 2) array, mm
            A DXF file with one closed outline, a CSV file with the columns x_mm and y_mm, or such
            points: a closed outline in the cam's frame.
        wall : str, optional
            Which of conjugate cams, or of a groove's walls, it is, by its key; the first where left
            out. Walls of a groove are followed by a roller as wide as it is.
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

        chosen = self._wall(wall)
        if progress is not None:
            progress("profile", 0, 2)
        vertices, bulges = read_profile(profile, chosen)
        if progress is not None:
            progress("follow", 1, 2)
        with self.stage("follow"):
            limits = self.design.limits
            columns, facts, own = followed(chosen, vertices, bulges, self.angles, limits)
        return Study(
            result=self,
            file=FOLLOWED,
            table=columns,
            measured={"followed": facts},
            findings=in_order((*self.findings, *own)),
        )


def _ending(one: PitchMotion) -> str:
    """Return what follows in the names of columns of a motion or wall."""
    return f"_{one.key}" if one.key else ""


def pressure_column(motion: PitchMotion) -> str:
    """Return the column of the pressure angles of a `motion`."""
    return f"pressure_angle{_ending(motion)}_deg"


def rho_column(what: str, one: PitchMotion) -> str:
    """Return the column of radii of a ``pitch`` curve or a ``profile``: `what`, of which `one`."""
    return f"rho_{what}{_ending(one)}_mm"


def build(design: CamDesign, tolerances: Tolerances = DEFAULT) -> CamResult:
    """Return the result of a `design` to `tolerances`; it computes what it is asked for."""
    return CamResult(design, tolerances)
