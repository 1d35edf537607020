"""The result of a globoidal cam: the turret's motion, walls, checks and solid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import beyond_limit
from gearcam.base.findings import Finding, in_order, run_checks
from gearcam.base.numerals import formatted
from gearcam.kinds.globoidal_cam.design import GloboidalCamDesign
from gearcam.kinds.shared import turn_in_steps
from gearcam.laws.indexing import IndexProgram, index_program
from gearcam.numeric.arguments import angles
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.parts.solids import Mesh, ribbed
from gearcam.results.result import Result
from gearcam.spatial.globoidal import GloboidalCam, GloboidalWall
from gearcam.spatial.globoidal_make import make_globoidal

if TYPE_CHECKING:
    from trimesh import Trimesh

    from gearcam.numeric.pose import SpacePose
    from gearcam.spatial.surface import Surface

CAM: Final = "cam"
TURRET: Final = "turret"
"""Names of the solids; that of the cam is also the stem of its files."""

_SHOWN: Final = 360
"""Largest number of cam angles of a solid that is only looked at."""

_SAGITTA: Final = 0.01
"""Least chord error of the rollers shown, mm."""


class GloboidalCamResult(Result):
    """Result of the design of a globoidal cam, computed on demand.

    Parameters
    ----------
    design : GloboidalCamDesign
        The design.
    tolerances : Tolerances
        Internal accuracy.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/globoidal_indexer.toml"))
    >>> [wall.key for wall in result.cam.walls]
    ['upper', 'lower']
    """

    design: GloboidalCamDesign
    stages = MappingProxyType({"program": "program", "cam": "cam", "checks": "checked"})
    before_studies = ("program", "cam")

    @cached_property
    def program(self) -> IndexProgram:
        """The angle of the turret over a turn."""
        index, pitch = self.design.index, self.design.turret.pitch
        with self.stage("program"):
            return index_program(index.law, index.angle, pitch, self.tolerances)

    @cached_property
    def cam(self) -> GloboidalCam:
        """The cam; its walls and measures are computed on demand."""
        program, design = self.program, self.design
        with self.stage("cam"):
            return make_globoidal(program, design.turret, design.cam, design.blank.bore)

    @cached_property
    def checked(self) -> tuple[Finding, ...]:
        """Findings of the checks, errors first."""
        from gearcam.spatial.globoidal_checks import KIND

        cam, bore = self.cam, self.design.blank.bore
        with self.stage("checks"):
            return in_order(run_checks(KIND, (cam, bore), self.design.limits))

    @property
    def angles(self) -> Array:
        """The cam angles of the motion's table, rad, in steps of the design, both ends."""
        return turn_in_steps(self.design.output.motion_step)

    @property
    def places(self) -> dict[str, float]:
        """Places along a roller, mm from the turret's axis, by their names in columns."""
        cam = self.cam
        return {"top": cam.top, "mean": cam.middle, "end": cam.reach}

    def motion(self, theta: ArrayLike | None = None) -> Columns:
        """Return the motion of the turret and the pressure angles.

        Parameters
        ----------
        theta : (n,) array, rad, optional
            Cam angles; by default those of ``motion.csv``.

        Returns
        -------
        Columns
            ``theta_deg``; ``turret_deg``, how far the turret has turned, and its derivatives by the
            cam angle; with a speed also those by time; ``pressure_angle_top_deg``,
            ``pressure_angle_mean_deg`` and ``pressure_angle_end_deg`` of the roller nearest to the
            middle of the cam: at the tops of the ribs, in the middle and at its end.

        Raises
        ------
        DesignError
            If `theta` is not an array of finite numbers.
        InfeasibleError
            If the cam is impossible.
        """
        where = self.angles if theta is None else angles("theta", theta)
        cam, speed = self.cam, self.design.drive.speed
        place, *slopes = (np.degrees(one) for one in self.program.derivatives(where, 3))
        columns = {"theta_deg": np.degrees(where), "turret_deg": place}
        names = [
            (name, order if order > 1 else "")
            for order, name in enumerate(("velocity", "acceleration", "jerk"), start=1)
        ]
        for (name, power), values in zip(names, slopes, strict=True):
            columns[f"{name}_deg_per_rad{power}"] = values
        if speed is not None:
            for (name, power), values in zip(names, slopes, strict=True):
                columns[f"{name}_deg_s{power}"] = speed ** int(power or 1) * values
        within = where % (2.0 * math.pi)
        for word, x in self.places.items():
            touched = cam.contact(within, np.full((len(where), 1), x), 1)
            columns[f"pressure_angle_{word}_deg"] = np.degrees(touched.pressure[:, 0])
        return Columns(columns)

    @property
    def steps(self) -> int:
        """Number of cam angles of a turn in solids: even, so that half of them is one too."""
        return 2 * math.ceil(math.pi / self.design.output.wall_step - 1e-9)

    def mesh_of(self, steps: int, places: int) -> Mesh:
        """Return the cam as a mesh.

        Parameters
        ----------
        steps, places : int
            Numbers of cam angles in a turn, and of places along the roller.

        Raises
        ------
        InfeasibleError
            If a wall is undercut.
        """
        from gearcam.spatial.globoidal_surface import blank_surface, core_surface, rib_surface

        cam, bore = self.cam, self.design.blank.bore
        for wall in cam.walls:
            _demand_whole(wall)
        with self.stage("solid"):
            mesh = ribbed(
                _mesh(core_surface(cam, steps)),
                _mesh(rib_surface(cam, steps, places)),
                _mesh(blank_surface(cam, bore, steps)),
            )
            return mesh.mirrored if cam.clockwise else mesh

    @cached_property
    def mesh(self) -> Mesh:
        """The cam as a closed mesh, mm."""
        return self.mesh_of(self.steps, self.design.output.wall_points)

    @cached_property
    def volume(self) -> tuple[float, float]:
        """Volume of the mesh, mm^3, and its error, from the volume of a mesh of half the steps."""
        places = self.design.output.wall_points
        coarse = self.mesh_of(self.steps // 2, max(2, (places + 1) // 2)).volume
        fine = self.mesh.volume
        return fine, abs(fine - coarse) / 3.0

    @cached_property
    def chord_error(self) -> float:
        """Largest distance of the walls from the mesh, mm."""
        from gearcam.spatial.globoidal_surface import chord_error

        return chord_error(self.cam, self.steps, self.design.output.wall_points)

    @property
    def solid_asked(self) -> bool:
        """Whether a file needs the solid."""
        return not {"stl", "3mf", "glb", "report"}.isdisjoint(self.design.output.files)

    @cached_property
    def meshes(self) -> dict[str, Mesh]:
        """The cam as a closed mesh of plain arrays by name, mm, as used for files."""
        return {CAM: self.mesh}

    @cached_property
    def solids(self) -> dict[str, Trimesh]:
        """The cam as a closed `trimesh.Trimesh` object by name, mm."""
        from gearcam.export.mesh import trimeshes

        return trimeshes(self.meshes)

    def standing(self, chords: float = 0.0) -> dict[str, tuple[Mesh, SpacePose]]:
        """Return cam and turret at the angle of the design, as meshes (see `Result`)."""
        from gearcam.kinds.globoidal_cam.scene import in_space
        from gearcam.parts.shapes import circle_segments
        from gearcam.spatial.globoidal_surface import turret_surface

        turret, places = self.design.turret, self.design.output.wall_points
        chord = max(chords, _SAGITTA)
        around = circle_segments(2.0 * turret.roller_radius, chord)
        meshes = {
            CAM: self.mesh_of(min(self.steps, _SHOWN), places) if chords else self.mesh,
            TURRET: _mesh(turret_surface(self.cam, turret.hub, around)),
        }
        poses = in_space(self, np.array([self.design.output.pose]))
        return {name: (mesh, poses[name][0]) for name, mesh in meshes.items()}

    @property
    def main_errors(self) -> Sequence[tuple[str, Sequence[str]]]:
        """Errors that users act on (see `Result`)."""
        if not self.solid_asked:
            return ()
        return (
            ("walls of the solid, between its points", ["chord_mm"]),
            ("volume", ["volume_mm3"]),
        )


def _mesh(made: Surface) -> Mesh:
    return Mesh(vertices=made.vertices, triangles=made.triangles)


def _demand_whole(wall: GloboidalWall) -> None:
    """Refuse a wall that the rollers cut away at another angle."""
    if not wall.undercut:
        return
    most = wall.largest_roller.value - 0.5 * wall.cam.clearance
    at = formatted(math.degrees(wall.spread.theta), 5)
    raise beyond_limit(
        f"the {wall.key} wall is undercut at {at} deg, and has no whole surface",
        "turret.roller_radius_mm",
        wall.cam.roller.radius,
        most,
        "the limit is the largest roller without undercut",
        near=most,
    )
