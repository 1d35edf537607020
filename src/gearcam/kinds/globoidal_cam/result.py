"""The result of a globoidal cam: the turret's motion, walls, checks and solid."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.adjustments import Scale, least
from gearcam.base.errors import DesignError, InfeasibleError, beyond_limit
from gearcam.base.findings import Finding, limit_of
from gearcam.base.numerals import DIGITS, shortened
from gearcam.designs.outputs import MESHES
from gearcam.kinds.globoidal_cam.design import GloboidalCamDesign
from gearcam.kinds.gridded import ROUND, SAGITTA, STEM, GriddedCam
from gearcam.laws.indexing import IndexProgram, index_program
from gearcam.numeric.columns import Columns
from gearcam.numeric.mesh import Mesh
from gearcam.parts.solids import carved, ribbed
from gearcam.results.study_help import with_studies
from gearcam.spatial.globoidal import GloboidalCam
from gearcam.spatial.globoidal_carving import roller_corners, scallop, uncut_surface
from gearcam.spatial.globoidal_make import make_globoidal
from gearcam.spatial.globoidal_surface import (
    blank_surface,
    chord_error,
    core_surface,
    facets,
    outer_radius,
    rib_surface,
    turret_surface,
)

if TYPE_CHECKING:
    from gearcam.base.adjustments import Changes
    from gearcam.numeric.arrays import Array
    from gearcam.numeric.pose import SpacePose
    from gearcam.spatial.globoidal_spec import TurretSpec
    from gearcam.spatial.loaded import RollerTouch

TURRET: Final = "turret"
"""Name of its solid."""

_LOOKS: Final = (0, 1, 2, 4, 8, 16)
"""Where distances from the computed one on are looked at, in steps of the last digit."""

_SHOWN: Final = 360
"""Largest number of cam angles of a solid that is only looked at."""


@with_studies("globoidal-cam")
class GloboidalCamResult(GriddedCam):
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

    for_users = ("cam", "motion")

    design: GloboidalCamDesign
    solid_files = frozenset({*MESHES, "report"})
    most_carved = 120
    roller_key = "turret.roller_radius_mm"
    most_facets = 2_000_000
    cutter = "rollers that cut it"

    @cached_property
    def program(self) -> IndexProgram:
        """The angle of the turret over a turn."""
        index, pitch = self.design.index, self.design.turret.pitch
        with self.stage("program"):
            return index_program(index.law, index.angle, pitch, self.tolerances)

    @cached_property
    def cam(self) -> GloboidalCam:
        """The cam; its walls and measures are computed on demand.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/globoidal_indexer.toml"))
        >>> len(result.cam.walls)
        2
        """
        program, design = self.program, self.design
        with self.stage("cam"):
            return make_globoidal(program, design.turret, design.cam, design.blank.bore_reach)

    @property
    def core_size(self) -> tuple[float, float, float]:
        """See `GriddedCam`."""
        cam = self.cam
        return cam.distance - cam.floor, -cam.half_length, 2.0 * cam.half_length

    @property
    def rims(self) -> tuple[float, float]:
        """Radii of the edges of both faces, mm (see `GriddedCam`)."""
        radius = outer_radius(self.cam)
        return radius, radius

    @property
    def follower_spec(self) -> TurretSpec:
        """The table of the turret."""
        return self.design.turret

    @cached_property
    def touches(self) -> tuple[RollerTouch, ...]:
        """Where rollers press (see `GriddedCam.touches`); a turret that is free is refused."""
        cam = self.cam
        if cam.grip < 0.0:
            what = "the cam is too short: at some angles no roller holds the turret"
            near = shortened(cam.least_length, 1.0)
            raise beyond_limit(what, "cam.length_mm", cam.length, cam.least_length, near=near)
        return super().touches

    @cached_property
    def checked_without_hints(self) -> tuple[Finding, ...]:
        """Findings of the checks (see `Result.checked_without_hints`)."""
        from gearcam.spatial.globoidal_checks import KIND, SOLID

        return self.findings_of(KIND, SOLID, (self.cam, self.design.blank.bore_reach))

    @cached_property
    def flatter(self) -> Changes | None:
        """The least larger centre distance that keeps the limit (see `GriddedCam.flatter`)."""
        from gearcam.spatial.globoidal_checks import KIND

        cam, scale = self.cam, Scale(DIGITS)
        limit, start = (
            limit_of(KIND, "pressure-angle", self.design.limits),
            scale.index(cam.distance),
        )
        about = cam.reach * (1.0 + self.program.peaks[0] / math.tan(limit))
        guess = max(1, scale.index(about) + 1 - start)

        def changed(place: int) -> dict[str, float]:
            return {"cam.center_distance_mm": scale.value(start + place)}

        def keeps(place: int) -> bool:
            try:
                other = type(self)(self.design.with_(changed(place)), self.tolerances)
                return other.cam.pressure.value <= limit
            except (DesignError, InfeasibleError):
                return False

        found = least(keeps, (guess + one for one in _LOOKS), guessed=True)
        return changed(found[0]) if found else None

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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/globoidal_indexer.toml"))
        >>> list(result.motion([0.0, 1.0]))[:2]
        ['theta_deg', 'turret_deg']
        """
        return self.moved(theta, TURRET, math.degrees(1.0), "deg")

    def pressure_at(self, theta: Array, x: float) -> Array:
        """Return the pressure angle of the roller nearest to the middle (see `GriddedCam`)."""
        place = np.full((len(theta), 1), x)
        return self.cam.contact(theta % (2.0 * math.pi), place, 1).pressure[:, 0]

    def facets(self, steps: int, places: int) -> int:
        """Return how many triangles the solid is made from (see `GriddedCam.facets`)."""
        return facets(self.cam, steps, places)

    def solid_of(self, steps: int, places: int) -> Mesh:
        """Return the cam as a mesh (see `GriddedCam.solid_of`)."""
        cam, bore, around = self.cam, self.turned_bore, steps
        if self.carved:
            around = ROUND * steps
            uncut = uncut_surface(cam, around)
            rib = carved(uncut, roller_corners(cam, steps, places))
        else:
            rib = rib_surface(cam, steps, places)
        core, blank = core_surface(cam, around), blank_surface(cam, bore, around)
        return ribbed(core, rib, blank)

    @cached_property
    def chord_error(self) -> float:
        """Largest distance of the walls from the mesh, mm; of a carved one its scallops."""
        error = scallop if self.carved else chord_error
        return error(self.cam, self.solid_steps, self.design.output.wall_points)

    def moved_poses(self, theta: Array) -> dict[str, SpacePose]:
        """Return the pose of the turret (see `GriddedCam.moved_poses`)."""
        return {TURRET: self.cam.guide.pose(self.program.derivatives(theta, 0)[0])}

    def shown(self, chords: float) -> dict[str, Mesh]:
        """Return cam and turret (see `GriddedCam.shown`)."""
        from gearcam.parts.shapes import circle_segments

        turret, places = self.design.turret, self.design.output.wall_points
        around = circle_segments(2.0 * turret.roller_radius, max(chords, SAGITTA))
        coarser = chords and self.solid_steps > _SHOWN
        return {
            STEM: self.mesh_of(_SHOWN, places) if coarser else self.mesh,
            TURRET: turret_surface(self.cam, turret.hub, around),
        }
