"""The result of a cam: its sizes, tables over the driver, checks, and error estimates."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.findings import Finding, in_order, run_checks
from gearcam.base.registry import deferred
from gearcam.cams.carriers import ROUNDING
from gearcam.cams.checks import KIND
from gearcam.kinds.cam.design import CamDesign
from gearcam.kinds.cam.made import MadeCam
from gearcam.kinds.shared import solved_file
from gearcam.laws.program import Program
from gearcam.numeric.arguments import angles, one_of
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.perturbation import EPS, Perturb, largest_changes, perturbed_sizes
from gearcam.numeric.piecewise import with_both_sides
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.parts.mass import quadrature_error
from gearcam.results.parts import CHORDS, Estimates
from gearcam.results.study import silent
from gearcam.results.study_help import with_studies

if TYPE_CHECKING:
    from gearcam.cams.cam import Cam
    from gearcam.cams.wall import PitchMotion, Wall
    from gearcam.kinds.cam.solve import Solution
    from gearcam.numeric.arrays import Ints, Plane
    from gearcam.results.study import Progress, StudyResult
    from gearcam.sheets.paper import Values

_TABLE: Final = deferred("gearcam.kinds.cam.calipers:sheet_table")
"""Returns the table of values of a part."""

_HINTED: Final = ("pressure-angle", "jamming", "sharp-profile", "undercut", "coarse-rows")
"""Findings whose messages name values that help."""


@with_studies("cam")
class CamResult(MadeCam):
    """Result of the design of a cam, computed on demand.

    Parameters
    ----------
    design : CamDesign
        The design.
    tolerances : Tolerances
        Internal accuracy.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
    >>> x, y = result.cam.outline.T  # mm, a circle of 31 mm
    >>> round(float(x.max() - x.min()), 2)
    62.0
    """

    for_users = ("cam", "contact", "follow", "motion", "solved")

    stages: ClassVar[Mapping[str, str]] = {
        "program": "program",
        "cam": "cam",
        "profile": "profile",
        "checks": "checked",
    }

    @cached_property
    def solution(self) -> Solution | None:
        """The sizes that the design asks for; None if it gives them all."""
        if not self.design.asked:
            return None
        from gearcam.kinds.cam.solve import solved

        with self.stage("solve"):
            return solved(self)

    @property
    def solved(self) -> CamDesign:
        """The design with all its sizes.

        Examples
        --------
        >>> import gearcam as gc
        >>> asked = {"cam.prime_radius_mm": "solve"}
        >>> result = gc.build(gc.load("profiles/plate_cam_offset_roller.toml").with_(asked))
        >>> round(result.solved.cam.prime_radius, 2)
        32.37
        """
        return self.design if self.solution is None else self.solution.design

    @property
    def more_files(self) -> dict[str, bytes]:
        """The design with the sizes that it asks for, as a file (see `Result.more_files`)."""
        return {} if self.solution is None else solved_file(self.solution.design)

    def wall(self, key: str | None) -> Wall:
        """Return the wall with a key; by default the first."""
        walls = {one.key: one for one in self.cam.walls}
        return walls[next(iter(walls)) if key is None else one_of("wall", key, tuple(walls))]

    def motion(self, theta: ArrayLike | None = None) -> Columns:
        """Return the exact motion of the follower, pressure angle and radii of curvature.

        Parameters
        ----------
        theta : float or (n,) array, rad, optional
            Cam angles, any number of turns. The default is that of ``motion.csv``: a turn in steps
            of the design's ``output.motion_step_deg``, both ends. For a translating cam travels,
            mm, from 0 to the whole travel, in steps of ``output.travel_step_mm``.

        Returns
        -------
        Columns
            ``theta_deg``, for a translating cam ``travel_mm``; ``lift_mm`` and its derivatives by
            theta ``velocity_mm_per_rad``, ``acceleration_mm_per_rad2`` and ``jerk_mm_per_rad3``
            (for an oscillating follower ``lift_deg``, ``velocity_deg_per_rad`` and so on, for a
            translating cam ``velocity_mm_per_mm`` and so on); with a speed of the drive also those
            by time, ``velocity_mm_s``, ``acceleration_mm_s2`` and ``jerk_mm_s3``;
            ``pressure_angle_deg``, signed; ``rho_pitch_mm`` and ``rho_profile_mm``, radii of
            curvature of pitch curve and profile before trimming: positive where convex, infinite
            where straight; where the pitch curve is convex and the profile undercut, that of the
            profile is negative. At a knot the values after it are returned. For conjugate cams and
            grooves names of columns contain the key, such as ``pressure_angle_2_deg`` and
            ``rho_profile_outer_mm``.

        Raises
        ------
        DesignError
            If `theta` is not an array of finite numbers, or beyond the travel of a translating cam.
        InfeasibleError
            If the cam is impossible.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
        >>> columns = result.motion([0.0, 1.0])  # cam angles, rad
        >>> columns["lift_mm"].round(3), columns["pressure_angle_deg"].round(3)
        (array([0.   , 2.758]), array([0., 0.]))
        """
        return self.motion_at(self._asked(theta))

    @cached_property
    def motion_of_turn(self) -> Columns:
        """The table of `motion` over a turn, at both sides of all knots."""
        turn = self.angles
        turn = np.append(turn[turn < self.program.period], np.nextafter(self.program.period, 0.0))
        return self.motion_at(with_both_sides(turn, self.program.knots))

    def _asked(self, theta: ArrayLike | None) -> Array:
        """Return cam angles, rad, from given angles, rad, or travels, mm."""
        if theta is None:
            return self.angles
        low, high = self.carrier.positions
        return angles("theta", theta, low, high, ROUNDING * (high - low), self.driver.per)

    def motion_at(self, theta: Array) -> Columns:
        """Return the table of `motion` at cam angles, rad, or travels, mm."""
        driver = self.driver
        motions, walls = self.cam.motions, self.cam.walls
        found = motions[0].motion(theta)
        columns = {driver.column: driver.scale * theta}
        names = zip(motions[0].motion_scales.items(), ("s", "ds", "d2s", "d3s"), strict=True)
        columns |= {name: scale * found[short] for (name, scale), short in names}
        timed = motions[0].timed_scales(self.design.drive.speed).items()
        for (name, scale), short in zip(timed, ("ds", "d2s", "d3s"), strict=False):
            columns[name] = scale * found[short]
        tables = [found, *(one.motion(theta) for one in motions[1:])]
        for one, values in zip(motions, tables, strict=True):
            columns[pressure_column(one)] = np.degrees(values["pressure"])
        for one, values in zip(motions, tables, strict=True):
            columns[rho_column("pitch", one)] = values["rho_pitch"]
        for wall in walls:
            columns[rho_column("profile", wall)] = wall.radii(theta)
        return Columns(columns)

    @cached_property
    def error_rows(self) -> Estimates:
        """Error estimates and their methods by name, without those of chords and files."""
        return error_rows(self)

    @property
    def main_errors(self) -> Sequence[tuple[str, Sequence[str]]]:
        """Errors that users act on (see `Result`)."""
        lift = next(iter(self.cam.motions[0].motion_scales))
        return (
            ("lift of the follower", [lift]),
            ("points of the profile", ["profile_mm"]),
            CHORDS,
            *self.errors_of_parts(),
        )

    @cached_property
    def places_under_load(self) -> Array:
        """Positions of the driver that the study of forces looks at (see `LoadedCam`)."""
        from gearcam.kinds.under_load import UnderLoad

        return UnderLoad(self).places()

    def contact(self, theta: ArrayLike | None = None, wall: str | None = None) -> Columns:
        """Return the points of contact of the follower on the profile, or a wall, before clearance.

        Parameters
        ----------
        theta : float or (n,) array, rad, optional
            Cam angles, or travels, mm, as for `motion`; by default those of its table.
        wall : str, optional
            The key of a wall; by default the first.

        Returns
        -------
        Columns
            A row for each angle whose point is left by trimming; at other angles the follower rests
            on a corner. ``theta_deg`` or ``travel_mm``; ``x_mm``, ``y_mm`` in the cam's frame;
            ``nx``, ``ny``, outward unit normal of the metal; ``fixed_x_mm``, ``fixed_y_mm``, the
            same point in the fixed frame: its rows are the path of contact. Where the velocity
            jumps, the point after the jump is returned.

        Raises
        ------
        DesignError
            If `theta` is not an array of finite numbers, or beyond the travel of a translating cam,
            or the wall is unknown.
        InfeasibleError
            If the cam is impossible.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
        >>> columns = result.contact([1.0])
        >>> columns["x_mm"].round(3), columns["y_mm"].round(3)
        (array([-26.086]), array([10.749]))
        """
        touched, driver = self.wall(wall), self.driver
        left, points, normals = touched.places_at(self._asked(theta))
        turn, shift = touched.carrier.frame(left)
        if touched.clockwise:
            turn, shift = np.conj(turn), -np.conj(shift)
        fixed = points * turn + shift
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
    def checked(self) -> tuple[Finding, ...]:
        """Findings of the checks, errors first."""
        found = self.checked_without_hints
        if any(one.code in _HINTED for one in found):
            from gearcam.kinds.cam.hints import hinted

            with self.stage("checks"):
                found = hinted(self, found)
        return found

    @cached_property
    def checked_without_hints(self) -> tuple[Finding, ...]:
        """Findings of the checks without values that help (see `Result.checked_without_hints`)."""
        cam = self.cam
        with self.stage("checks"):
            found = run_checks(KIND, cam, self.design.limits)
            found += self.rows.findings
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
        fit: bool = False,
        progress: Progress | None = None,
    ) -> StudyResult:
        """Return the motion of the design's follower on a given profile.

        Parameters
        ----------
        profile : path or (n, 2) array, mm
            A DXF file with one closed outline, a CSV file with the columns x_mm and y_mm, or the
            points of a closed outline in the cam's frame.
        wall : str, optional
            Key of the wall, for conjugate cams or a groove; by default the first. Walls of a
            groove are followed by a roller as wide as the groove.
        fit : bool
            Whether to find the phases, motion laws and sizes that make this motion. The profile may
            then be a CSV file of the lift, with the columns theta_deg (or angle_deg) and lift_mm or
            lift_deg.
        progress : callable, optional
            Called with a stage's name, the stages done and their number.

        Returns
        -------
        StudyResult
            Its columns are those of ``followed.csv`` (see docs/cams.md).

        Raises
        ------
        InfeasibleError
            If the follower cannot rest on the profile, or no phases can be found.
        DesignError
            If it is not a profile, or the file cannot be read.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
        >>> study = result.follow(result.cam.outline)
        >>> abs(study.facts["followed.largest_difference"]) < 0.002
        True
        """
        study = self.kind.studies["follow"]
        return study.compute(self, progress or silent, profile=profile, wall=wall, fit=fit)

    def notes(self, number: int) -> list[str]:
        """Return notes with the file of the radii, if it is written (see `PartsResult.notes`)."""
        notes = super().notes(number)
        if "caliper" in self.design.output.files:
            notes.append(f"{'Radii' if self.carrier.around else 'Heights'}: caliper.csv.")
        return notes

    def values(self, number: int) -> Values:
        """Return the radii, or the heights of a plate, of a part (see `PartsResult.values`)."""
        from gearcam.sheets.paper import Values
        from gearcam.sheets.sheet import column

        title, columns = [], []
        for name, values in _TABLE(self, number).items():
            *_, word, own = name.split("_")
            unit, text = column(own)
            title.append(f"{word}, {unit}")
            numbers = np.ma.filled(values, np.nan).tolist()
            columns.append(["" if math.isnan(one) else text(one) for one in numbers])
        return Values(title=tuple(title), rows=[*zip(*columns, strict=True)])


def pressure_column(motion: PitchMotion) -> str:
    """Return the column of the pressure angles of a `motion`."""
    return f"pressure_angle{motion.ending}_deg"


def rho_column(what: str, one: PitchMotion) -> str:
    """Return the column of radii of `what`, ``pitch`` or ``profile``, of motion or wall `one`."""
    return f"rho_{what}{one.ending}_mm"


_LENGTHS, _ANGLES, _COEFFICIENTS = 4.0 * EPS, 4.0 * EPS, 2.5 * EPS
"""Relative perturbations: of sizes of the follower; of cam angles, since knots are sums; of
coefficients of the lift."""

_PLACES: Final = 256
_FEWEST: Final = 3
"""Number of cam angles over all phases, and least number between cuts of the lift, with ends."""

_ROUNDED: Final = "largest change over the turn if every input changes by its rounding"


def error_rows(result: CamResult) -> Estimates:
    """Return the error estimates of a cam.

    Parameters
    ----------
    result : CamResult
        A built design.

    Returns
    -------
    dict of str to (float, str)
        Estimate and method by name, without those of chords and files.
    """
    unknown = " and the lift by its interpolation error" if any(result.program.errors) else ""
    lift, profile, swept = motion_errors(result.cam)
    name, scale = next(iter(result.cam.motions[0].motion_scales.items()))
    rows = {name: scale * lift, "profile_mm": profile}
    return {
        **{name: (off, _ROUNDED + unknown) for name, off in rows.items()},
        **dict(_sizes(result, swept)),
    }


def motion_errors(cam: Cam) -> tuple[float, float, list[float]]:
    """Return the errors of lift and profiles.

    Parameters
    ----------
    cam : Cam
        All its walls count.

    Returns
    -------
    lift, profile : float, mm or rad, and mm
        Largest error of the lift, and of points of profiles.
    swept : list of float, mm^2
        The area that the errors of each profile cover.
    """
    program, curves = cam.walls[0].program, [wall.curve for wall in cam.walls]
    index, theta = _places(program)
    traces = [curve.trace(theta, *program.lift.on_pieces(index, theta, 1)) for curve in curves]

    def compute(perturb: Perturb) -> list[Array | Plane]:
        places = perturb(theta, _ANGLES * theta)
        exact = program.lift.on_pieces(index, places, 1, lambda v: perturb(v, _COEFFICIENTS * v))
        s, ds = (perturb(*one) for one in zip(exact, program.errors[:2], strict=True))
        moved = [
            replace(
                one,
                follower=perturbed_sizes(one.follower, perturb, _LENGTHS),
                inset=float(perturb(one.inset, _LENGTHS * one.inset)),
            )
            for one in curves
        ]
        points = [one.trace(places, s, ds)[0] for one in moved]
        # only what is across the profile changes its area
        across = [
            (np.conj(tangents) * profile).imag
            for profile, (_, tangents) in zip(points, traces, strict=True)
        ]
        return [s, *points, *across]

    lift, *of_walls = largest_changes(compute)
    profiles, across = of_walls[: len(curves)], of_walls[len(curves) :]
    swept = [
        float(0.5 * (off[1:] + off[:-1]) @ np.abs(np.diff(points)))
        for (points, _), off in zip(traces, across, strict=True)
    ]
    return float(lift.max()), max(float(off.max()) for off in profiles), swept


def _places(program: Program) -> tuple[Ints, Array]:
    """Pieces of the lift, and cam angles in them, at knots once for each side."""
    cuts, knots = program.cuts, program.knots
    index = np.searchsorted(knots, 0.5 * (cuts[:-1] + cuts[1:])) - 1
    # the same number for all phases, so that a divided one leaves enough to the others
    share = np.diff(cuts) / np.diff(knots)[index]
    counts = np.maximum(_FEWEST, (_PLACES // (len(knots) - 1) * share).astype(int))
    stretches = zip(cuts[:-1], cuts[1:], counts, strict=True)
    return np.repeat(index, counts), np.concatenate([np.linspace(*one) for one in stretches])


def _sizes(result: CamResult, swept: list[float]) -> Iterator[tuple[str, tuple[float, str]]]:
    """Yield the errors of areas of walls before clearance, and of the volume of parts."""
    walls = result.cam.walls
    if not result.design.blank.clearance:
        how = "errors of the profile all along it, and quadrature with fewer cells"
        for wall, area in zip(walls, swept, strict=True):
            if wall.program.closed:
                name = f"{wall.key}_area_mm2" if wall.key else "area_mm2"
                yield name, (area + wall.size.area_error, how)
    if result.ordered and result.design.blank.density is not None:
        area = sum(swept) + sum(wall.cubics_missed for wall in walls)
        off = max(quadrature_error(part) + part.width * area for part in result.parts)
        how = "cubics through dense points with halved steps on walls, with doubled steps on all "
        yield "volume_mm3", (off, f"{how}edges; errors of the profile all along it")
