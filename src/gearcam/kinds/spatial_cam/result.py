"""The result of a cam in space: lift program, walls, checks and solid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import Finding
from gearcam.base.numerals import formatted
from gearcam.designs.outputs import MESHES
from gearcam.kinds.cam.public import lift_program
from gearcam.kinds.gridded import ROUND, SAGITTA, STEM, GriddedCam
from gearcam.kinds.shared import solved_file
from gearcam.kinds.spatial_cam.design import SpatialCamDesign
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.mesh import Mesh
from gearcam.parts.solids import carved
from gearcam.results.study_help import with_studies
from gearcam.results.table_rows import TableRows
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.carving import roller_corners, scallop
from gearcam.spatial.make import make_cylinder
from gearcam.spatial.surface import (
    Cylinder,
    blank_surface,
    chord_error,
    roller_surface,
    surface,
)

if TYPE_CHECKING:
    from gearcam.base.adjustments import Changes
    from gearcam.numeric.pose import SpacePose
    from gearcam.parts.bands import BandedBody
    from gearcam.results.parts import Estimates
    from gearcam.spatial.loaded import RollerTouch
    from gearcam.spatial.milling import RotaryPath
    from gearcam.spatial.sizing import SolvedDiameter
    from gearcam.spatial.spec import SpatialFollower

ROLLER: Final = "roller"
"""Name of its solid; of two, those at a rib, the beginning of their names."""

_TURN: Final = 2.0 * math.pi

_WITNESSES: Final = ((360, 13), (720, 25))
"""Cam angles and places along the roller of two meshes that give the volume of a STEP solid."""


@with_studies("spatial-cam")
class SpatialCamResult(GriddedCam):
    """Result of the design of a cam in space, computed on demand.

    Parameters
    ----------
    design : SpatialCamDesign
        The design.
    tolerances : Tolerances
        Internal accuracy.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/cylinder_cam.toml"))
    >>> [wall.key for wall in result.cam.walls]
    ['upper', 'lower']
    """

    for_users = ("cam", "motion", "solved")

    design: SpatialCamDesign
    solid_files = frozenset({*MESHES, "step", "report"})
    most_carved = 240
    roller_key = "follower.roller_radius_mm"
    most_facets = 4_000_000
    cutter = "roller that cuts it"

    @cached_property
    def program(self) -> Program:
        """The lift over a turn."""
        with self.stage("program"):
            return lift_program(self.design, self.tolerances)

    @cached_property
    def solution(self) -> SolvedDiameter | None:
        """The outer diameter that the design asks for; None if it gives one."""
        program, design = self.program, self.design
        if not design.cam.asks:
            return None
        from gearcam.spatial.sizing import least_diameter

        with self.stage("solve"):
            return least_diameter(
                program, design.follower, design.cam, design.blank.bore_reach, design.limits
            )

    @cached_property
    def solved(self) -> SpatialCamDesign:
        """The design with all its sizes.

        Examples
        --------
        >>> import gearcam as gc
        >>> asked = {"cam.outer_diameter_mm": "solve"}
        >>> result = gc.build(gc.load("profiles/cylinder_cam.toml").with_(asked))
        >>> round(result.solved.cam.outer_diameter, 2)
        187.81
        """
        found = self.solution
        if found is None:
            return self.design
        size = replace(self.design.cam, outer_diameter=found.diameter)
        return replace(self.design, cam=size, examined=True)

    @property
    def more_files(self) -> dict[str, bytes]:
        """The design with the size that it asks for, as a file (see `Result.more_files`)."""
        return {} if self.solution is None else solved_file(self.solved)

    @cached_property
    def cam(self) -> SpatialCam:
        """The cam; its walls and measures are computed on demand.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/cylinder_cam.toml"))
        >>> [wall.key for wall in result.cam.walls]
        ['upper', 'lower']
        """
        program, design = self.program, self.solved
        with self.stage("cam"), self.rows.named():
            bore = design.blank.bore_reach
            return make_cylinder(program, design.follower, design.cam, bore)

    @cached_property
    def touches(self) -> tuple[RollerTouch, ...]:
        """Where the roller presses (see `GriddedCam.touches`); it must reach into the cam."""
        spot = self.cam.depth_of_contact
        if spot.value <= 0.0:
            what = f"the roller leaves the cam at {formatted(math.degrees(spot.theta), 5)} deg"
            why = "there its end touches the wall outside the cylinder"
            near = "a deeper groove and a longer roller, or a smaller pressure angle"
            raise InfeasibleError(f"{what}: {why}", where="cam.groove_depth_mm", nearest=near)
        return super().touches

    @property
    def follower_spec(self) -> SpatialFollower:
        """The table of the follower."""
        return self.design.follower

    @property
    def blank(self) -> Cylinder:
        """What it is made from."""
        return Cylinder(length=self.design.cam.length, bore=self.design.blank.bore_reach)

    @property
    def core_size(self) -> tuple[float, float, float]:
        """See `GriddedCam`."""
        return self.cam.floor, 0.0, self.design.cam.length

    @property
    def rims(self) -> tuple[float, float]:
        """Radii of the edges of the lower and the upper face, mm (see `GriddedCam`)."""
        cam = self.cam
        low, high = (
            cam.outer_radius if side in cam.sides and not cam.apart else cam.floor
            for side in (-1, 1)
        )
        return low, high

    @property
    def lift_unit(self) -> tuple[float, str]:
        """Factor and unit of the lift in output."""
        return (math.degrees(1.0), "deg") if self.design.follower.oscillating else (1.0, "mm")

    @property
    def rows(self) -> TableRows:
        """The rows of the tables of the design (see `Staged`)."""
        return TableRows(design=self.design, oscillating=self.design.follower.oscillating)

    @cached_property
    def checked_without_hints(self) -> tuple[Finding, ...]:
        """Findings of the checks (see `Result.checked_without_hints`)."""
        from gearcam.spatial.checks import KIND, SOLID

        return self.findings_of(KIND, SOLID, (self.cam, self.blank))

    @cached_property
    def flatter(self) -> Changes | None:
        """The least larger diameter that keeps the limit (see `GriddedCam.flatter`)."""
        from gearcam.spatial.sizing import flat_diameter

        design = self.solved
        bore, limits = design.blank.bore_reach, design.limits
        size = flat_diameter(self.program, design.follower, design.cam, bore, limits)
        return None if size is None else {"cam.outer_diameter_mm": size}

    def motion(self, theta: ArrayLike | None = None) -> Columns:
        """Return the motion of the follower and the pressure angles.

        Parameters
        ----------
        theta : (n,) array, rad, optional
            Cam angles; by default those of ``motion.csv``.

        Returns
        -------
        Columns
            ``theta_deg``; ``lift_mm`` (of a follower that swings ``lift_deg``) and its derivatives
            by the cam angle; ``pressure_angle_inner_deg``, ``pressure_angle_mean_deg`` and
            ``pressure_angle_outer_deg``, the larger one of both walls at the roller's inner end, in
            the middle and at the outside; with a speed also the derivatives by time.

        Raises
        ------
        DesignError
            If `theta` is not an array of finite numbers.
        InfeasibleError
            If the cam is impossible.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/cylinder_cam.toml"))
        >>> result.motion([0.0, 1.0])["lift_mm"].round(3)
        array([ 0.   , 17.915])
        """
        return self.moved(theta, "lift", *self.lift_unit)

    @property
    def places(self) -> dict[str, float]:
        """Places along the roller, mm from the axis, by their names in columns."""
        cam = self.cam
        return {"inner": cam.inner, "mean": cam.middle, "outer": cam.outer_radius}

    def pressure_at(self, theta: Array, x: float) -> Array:
        """Return the larger pressure angle of both walls (see `GriddedCam.pressure_at`)."""
        cam, place = self.cam, np.full((len(theta), 1), x)
        both = [cam.contact(theta, place, side).pressure[:, 0] for side in cam.sides]
        return np.max(both, axis=0)

    @property
    def wall_angles(self) -> Array:
        """The cam angles of solids and of ``walls.csv``, rad."""
        return np.linspace(0.0, _TURN, self.steps, endpoint=False)

    def facets(self, steps: int, places: int) -> int:
        """Return how many triangles the solid is made from (see `GriddedCam.facets`)."""
        return 4 * steps * len(self.cam.walls) * places

    def solid_of(self, steps: int, places: int) -> Mesh:
        """Return the cam as a mesh (see `GriddedCam.solid_of`)."""
        cam, blank = self.cam, replace(self.blank, bore=self.turned_bore)
        if not self.carved:
            return surface(cam, blank, steps, places)
        whole = blank_surface(cam, blank, ROUND * steps)
        return carved(whole, roller_corners(cam, blank, steps, places))

    @cached_property
    def chord_error(self) -> float:
        """Largest distance of the walls from the mesh, mm; of a carved one its scallops."""
        error = scallop if self.carved else chord_error
        return error(self.cam, self.solid_steps, self.design.output.wall_points)

    @property
    def more_errors(self) -> Estimates:
        """The error of the STEP solid, if a file asks for it (see `GriddedCam.more_errors`)."""
        if "step" not in self.design.output.files:
            return {}
        how = "distance of exact points from the B-splines, half-way between those interpolated"
        return {"step_mm": (self.bands.error, how)}

    @cached_property
    def bands(self) -> BandedBody:
        """The cam as a solid of planes, cylinders and B-splines, as used for STEP.

        Raises
        ------
        InfeasibleError
            If a wall is undercut.
        """
        from gearcam.parts.cam_bands import cam_bands

        self.demand_whole()
        coarse, fine = (self.mesh_of(*size).volume for size in _WITNESSES)
        error = (fine - coarse) / 3.0
        with self.stage("bands"):
            blank = replace(self.blank, bore=self.turned_bore)
            made = cam_bands(self.cam, blank, STEM, (fine + error, abs(error)))
            return replace(made, core=self.core)

    @cached_property
    def rotary(self) -> RotaryPath:
        """The path of the tool on a machine with a rotary axis.

        Raises
        ------
        InfeasibleError
            If a wall is undercut, or the tool does not fit.
        """
        from gearcam.spatial.milling import rotary_path

        cam, design = self.cam, self.design
        self.demand_whole()
        with self.stage("tool path"):
            return rotary_path(cam, design.tool, design.output.path_tolerance)

    @property
    def path_asked(self) -> bool:
        """Whether a file needs the path of the tool."""
        return not {"tool-path", "gcode"}.isdisjoint(self.design.output.files)

    @property
    def rollers(self) -> dict[str, float]:
        """How far above the follower's place its rollers are, mm, by name: two at a rib, or one."""
        half = 0.5 * self.cam.apart
        return {f"{ROLLER}_upper": half, f"{ROLLER}_lower": -half} if half else {ROLLER: 0.0}

    def moved_poses(self, theta: Array) -> dict[str, SpacePose]:
        """Return the poses of the rollers (see `GriddedCam.moved_poses`)."""
        carried = self.cam.guide.pose(self.program.derivatives(theta, 0)[0])
        return {
            name: replace(carried, shift=carried.shift + np.array([0.0, 0.0, up]))
            for name, up in self.rollers.items()
        }

    def shown(self, chords: float) -> dict[str, Mesh]:
        """Return cam and rollers (see `GriddedCam.shown`)."""
        from gearcam.parts.shapes import circle_segments

        size = 2.0 * self.design.follower.roller_radius
        roller = roller_surface(self.cam, circle_segments(size, max(chords, SAGITTA)))
        return {STEM: self.mesh, **dict.fromkeys(self.rollers, roller)}

    @property
    def main_errors(self) -> Sequence[tuple[str, Sequence[str]]]:
        """Errors that users act on (see `Result`)."""
        if "step" not in self.design.output.files:
            return super().main_errors
        walls, volume = super().main_errors
        return walls, ("walls of the STEP solid, between its points", ["step_mm"]), volume
