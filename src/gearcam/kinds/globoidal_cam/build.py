"""The result of a globoidal cam: the turret's motion, walls, checks and solid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.findings import Finding, in_order, run_checks
from gearcam.kinds.globoidal_cam.design import GloboidalCamDesign
from gearcam.kinds.shared import turn_in_steps
from gearcam.laws.indexing import IndexProgram, index_program
from gearcam.numeric.arguments import angles
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.parts.solids import Mesh, carved, ribbed
from gearcam.results.result import Result
from gearcam.spatial.globoidal import GloboidalCam
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

_CARVED: Final = 120
"""Largest number of cam angles of a turn at which rollers cut a solid: some seconds."""

_ROUND: Final = 4
"""Chords of its blank for each of them: the error of its volume is that of the walls then."""

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
        from gearcam.spatial.globoidal_checks import KIND, SOLID

        cam, bore, limits = self.cam, self.design.blank.bore, self.design.limits
        with self.stage("checks"):
            found = [*run_checks(KIND, (cam, bore), limits)]
            if self.solid_asked and self.carved:
                found += run_checks(SOLID, (self.solid_steps, self.chord_error), limits)
            return in_order(found)

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
        """
        from gearcam.spatial.globoidal_surface import blank_surface, core_surface, rib_surface

        cam, bore, around = self.cam, self.design.blank.bore, steps
        with self.stage("solid"):
            if self.carved:
                from gearcam.spatial.globoidal_carving import roller_corners, uncut_surface

                around = _ROUND * steps
                uncut = _mesh(uncut_surface(cam, around))
                rib = carved(uncut, roller_corners(cam, steps, places))
            else:
                rib = _mesh(rib_surface(cam, steps, places))
            core, blank = core_surface(cam, around), blank_surface(cam, bore, around)
            mesh = ribbed(_mesh(core), rib, _mesh(blank))
            return mesh.mirrored if cam.clockwise else mesh

    @property
    def carved(self) -> bool:
        """Whether the rib is made by cutting with the rollers: a wall is undercut."""
        return self.cam.undercut

    @property
    def solid_steps(self) -> int:
        """Number of cam angles of a turn in the solid; less where it is carved."""
        return min(self.steps, _CARVED) if self.carved else self.steps

    @cached_property
    def mesh(self) -> Mesh:
        """The cam as a closed mesh, mm."""
        return self.mesh_of(self.solid_steps, self.design.output.wall_points)

    @cached_property
    def volume(self) -> tuple[float, float]:
        """Volume of the mesh, mm^3, and its error, from the volume of a mesh of half the steps."""
        places = self.design.output.wall_points
        coarse = self.mesh_of(self.solid_steps // 2, max(2, (places + 1) // 2)).volume
        fine = self.mesh.volume
        return fine, abs(fine - coarse) / 3.0

    @cached_property
    def chord_error(self) -> float:
        """Largest distance of the walls from the mesh, mm; of a carved one its scallops."""
        if self.carved:
            from gearcam.spatial.globoidal_carving import scallop as error
        else:
            from gearcam.spatial.globoidal_surface import chord_error as error
        return error(self.cam, self.solid_steps, self.design.output.wall_points)

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
        around = circle_segments(2.0 * turret.roller_radius, max(chords, _SAGITTA))
        fine = self.solid_steps > _SHOWN
        meshes = {
            CAM: self.mesh_of(_SHOWN, places) if chords and fine else self.mesh,
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
