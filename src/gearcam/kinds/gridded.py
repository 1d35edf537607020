"""Results of cams whose solids are made from grids of wall points, in space."""

from __future__ import annotations

import math
from abc import abstractmethod
from bisect import bisect_right
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

import numpy as np

from gearcam.base.adjustments import text_of
from gearcam.base.errors import ABOVE, InfeasibleError, beyond_limit
from gearcam.base.findings import CHECKS, Finding, in_order, limit_of, run_checks
from gearcam.base.inches import files_in
from gearcam.base.numerals import formatted
from gearcam.kinds.loaded_cam import LoadedCam
from gearcam.kinds.shared import turn_in_steps
from gearcam.numeric.arguments import angles
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.mesh import Mesh
from gearcam.numeric.pose import SpacePose
from gearcam.results.result import Result

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike
    from trimesh import Trimesh

    from gearcam.base.adjustments import Changes
    from gearcam.base.facts import Tree
    from gearcam.mechanics.driver_axis import DriverAxis
    from gearcam.parts.body import Part
    from gearcam.results.parts import Estimates
    from gearcam.sheets.sheet import Sheet
    from gearcam.spatial.loaded import RollerTouch


_STEEP: Final = "pressure-angle"
"""Code of the finding that names a size."""

STEM: Final = "cam"
"""Stem of the files of the solid."""

SAGITTA: Final = 0.01
"""Least chord error of the rollers shown, mm."""

ROUND: Final = 4
"""Chords of the blank for each position of a roller that cuts a solid: the error of its volume is
that of the walls then."""

FINE: Final = 1e-3
"""Chord tolerance of hub, openings, marks and drawings, mm."""

_COARSE: Final = math.radians(4.0)
"""Least steps of the driver in a draft: the solid's volume is good to a thousandth."""

_FEW: Final = 3
"""Largest number of places along the roller in the solid of a draft."""

ORDERS: Final = (("velocity", 1, ""), ("acceleration", 2, "2"), ("jerk", 3, "3"))
"""Derivatives of a motion: name, order, and this as the end of a unit."""


class GriddedCam(LoadedCam, Result):
    """Result of a cam in space, computed on demand: what all have alike.

    Parameters
    ----------
    design : Design
        With ``output.motion_step``, ``output.wall_step`` and ``output.wall_points``.
    tolerances : Tolerances
        Internal accuracy.
    """

    for_users = ("solids",)

    design: Any
    stages: ClassVar[Mapping[str, str]] = {"program": "program", "cam": "cam", "checks": "checked"}
    before_studies = ("program", "cam")

    solid_files: ClassVar[frozenset[str]]
    """Files that need the solid."""
    most_carved: ClassVar[int]
    """Largest number of cam angles at which rollers cut a solid: a few seconds."""
    most_facets: ClassVar[int]
    """Largest number of triangles that a solid is made from: ten seconds, and a gigabyte."""
    roller_key: ClassVar[str]
    """Key of the radius of the roller."""
    cutter: ClassVar[str]
    """What cuts a solid that is carved, in words."""

    @cached_property
    def touches(self) -> tuple[RollerTouch, ...]:
        """Where the cam can press on its follower (see `LoadedCam`).

        Raises
        ------
        InfeasibleError
            If a wall is undercut.
        """
        self.demand_whole()
        slip = self.design.friction.flank
        return tuple(replace(one, slip=slip) for one in self.cam.touches)

    @cached_property
    def places_under_load(self) -> Array:
        """Positions of the driver that the study of forces looks at (see `LoadedCam`)."""
        from gearcam.kinds.under_load import UnderLoad

        return UnderLoad(self).places()

    @property
    def driver(self) -> DriverAxis:
        """Name and unit of the cam angle in output."""
        from gearcam.cams.carriers import Rotating

        return Rotating().driver

    def demand_whole(self) -> None:
        """Refuse walls that the roller cuts away at another angle.

        Raises
        ------
        InfeasibleError
            If one is undercut.
        """
        for wall in self.cam.walls:
            if not wall.undercut:
                continue
            most = wall.allowed_radius
            at = formatted(math.degrees(wall.spread.theta), 5)
            raise beyond_limit(
                f"the {wall.key} wall is undercut at {at} deg, and has no whole surface",
                self.roller_key,
                wall.cam.roller.radius,
                most,
                "the limit is the largest roller without undercut",
                near=most,
            )

    @cached_property
    @abstractmethod
    def flatter(self) -> Changes | None:
        """The least larger size that keeps the limit of the pressure angle, if any does."""

    @property
    @abstractmethod
    def places(self) -> Mapping[str, float]:
        """Places along the roller, mm, by their names in columns."""

    @abstractmethod
    def pressure_at(self, theta: Array, x: float) -> Array:
        """Return the pressure angle at a place along the roller, (n,), rad.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        x : float, mm
            The place.
        """

    @abstractmethod
    def motion(self, theta: ArrayLike | None = None) -> Columns:
        """Return the motion at cam angles `theta`, rad; by default those of ``motion.csv``."""

    @cached_property
    @abstractmethod
    def chord_error(self) -> float:
        """Largest distance of the walls from the mesh, mm; of a carved one its scallops."""

    def coarse(self) -> Self:
        """Return the cam with a solid and charts of larger steps (see `Staged`)."""
        output = self.design.output
        output = replace(
            output,
            motion_step=max(output.motion_step, _COARSE),
            wall_step=max(output.wall_step, _COARSE),
            wall_points=min(output.wall_points, _FEW),
        )
        known = {name: getattr(self, name) for name in self.before_studies}
        result = type(self)(replace(self.design, output=output, examined=True), self.tolerances)
        vars(result).update(known)
        return result

    @property
    @abstractmethod
    def core_size(self) -> tuple[float, float, float]:
        """Radius of the metal below the walls, height of the lower face, and length, mm."""

    @property
    @abstractmethod
    def rims(self) -> tuple[float, float]:
        """Radii of the edges of the lower and the upper face, mm."""

    @cached_property
    def core(self) -> Part | None:
        """The metal below the walls with hub, openings and marks; None with a round bore alone.

        Raises
        ------
        InfeasibleError
            If one of them has no space.
        """
        blank, (radius, _, length) = self.design.blank, self.core_size
        if blank.plain:
            return None
        from gearcam.parts.make import bevels, make_part
        from gearcam.parts.marks import zero_mark
        from gearcam.parts.openings import Workpiece
        from gearcam.parts.shapes import Circle

        work = Workpiece(
            name="the cam",
            rim=self.rims[1] - radius or 0.2 * radius,
            within="the floor of the groove",
            process=self.design.output.marking,
        )
        edge = Circle(center=0j, diameter=2.0 * radius)
        with self.stage("blank"):
            made = make_part(
                STEM,
                [edge.contour(FINE)],
                length,
                replace(blank, chamfer=0.0),
                work,
                lambda: zero_mark(radius, -1.0, length, work.process),
                way=-1.0 if self.cam.clockwise else 1.0,
            )
            outside = [Circle(center=0j, diameter=2.0 * one) for one in self.rims]
            return replace(made, bevels=tuple(bevels(made, blank.chamfer, work, outside)))

    @cached_property
    def sheets(self) -> tuple[Sheet, ...]:
        """The workshop drawing."""
        with files_in(self.design.files_in):
            return self.kind.sheets(self)

    @property
    def turned_bore(self) -> float:
        """Radius of the bore with which the solid is turned, mm; 0 if it is cut out later."""
        return 0.0 if self.core is not None else 0.5 * self.design.blank.bore

    @abstractmethod
    def solid_of(self, steps: int, places: int) -> Mesh:
        """Return the cam as a mesh, as if it turned counter-clockwise (see `mesh_of`).

        It has a bore of `turned_bore`.
        """

    @abstractmethod
    def facets(self, steps: int, places: int) -> int:
        """Return about how many triangles a solid that is not carved is made from (see `mesh_of`).

        Parameters
        ----------
        steps, places : int
            As of `mesh_of`.
        """

    def mesh_of(self, steps: int, places: int) -> Mesh:
        """Return the cam as a mesh.

        Parameters
        ----------
        steps, places : int
            Numbers of cam angles in a turn, and of places along the roller.
        """
        return self.fitted(self.body_of(steps, places), self.core)

    def body_of(self, steps: int, places: int) -> Mesh:
        """Return the cam without what its core has, as a mesh (see `mesh_of`)."""
        with self.stage("solid"):
            made = self.solid_of(steps, places)
            return made.mirrored if self.cam.clockwise else made

    def fitted(self, body: Mesh, core: Part | None) -> Mesh:
        """Return a `body` with what a `core` has, if there is one."""
        if core is None:
            return body
        from gearcam.parts.solids import fitted

        with self.stage("solid"):
            return fitted(body, core, self.core_size[1])

    @abstractmethod
    def moved_poses(self, theta: Array) -> dict[str, SpacePose]:
        """Return the poses of what a cam that turns counter-clockwise moves, by name.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        """

    @abstractmethod
    def shown(self, chords: float) -> dict[str, Mesh]:
        """Return the solids that are shown, by name.

        Parameters
        ----------
        chords : float, mm
            Chord error that is allowed for the eye; 0: that of files.
        """

    def in_space(self, theta: Array) -> dict[str, SpacePose]:
        """Return the poses of the cam and of what it moves, by name.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        """
        turned = SpacePose((0.0, 0.0, 1.0), theta, np.zeros((len(theta), 3)))
        poses = {STEM: turned, **self.moved_poses(theta)}
        return {name: one.mirrored if self.cam.clockwise else one for name, one in poses.items()}

    @property
    def place_of_solids(self) -> str:
        """Where a page shows the solids (see `Result`): the picture is only a cam unrolled."""
        return "first"

    def standing(self, chords: float = 0.0) -> dict[str, tuple[Mesh, SpacePose]]:
        """Return cam and follower at the angle of the design, as meshes (see `Result`)."""
        poses, meshes = self.in_space(np.array([self.design.output.pose])), self.shown(chords)
        return {name: (meshes[name], pose[0]) for name, pose in poses.items()}

    def findings_of(self, kind: str, solid: str, subject: Any) -> tuple[Finding, ...]:
        """Return the findings of the checks, errors first.

        Parameters
        ----------
        kind, solid : str
            The groups of checks of the cam, and of its solid where it is carved.
        subject : object
            What the first group looks at.
        """
        limits = self.design.limits
        with self.stage("checks"):
            found = [*run_checks(kind, subject, limits), *self.rows.findings]
            found += self._thin_walls(limit_of(kind, "thin-wall", limits))
            if self.solid_asked and self.carved:
                found += run_checks(solid, (self.solid_steps, self.chord_error), limits)
            return in_order(found)

    def _thin_walls(self, limit: float) -> Sequence[Finding]:
        """Return what is found of walls in the core; it is made here, or refused."""
        if self.core is None:
            return ()
        from gearcam.parts.blank import KIND as PARTS
        from gearcam.parts.checks import CheckedParts

        subject = CheckedParts(parts=(self.core,), names=(STEM,), edge="floor of the groove")
        return tuple(CHECKS[PARTS, "thin-wall"].run(subject, limit))

    @cached_property
    def checked(self) -> tuple[Finding, ...]:
        """Findings of the checks, errors first; one of a pressure angle names a size."""
        found = self.checked_without_hints
        if not any(one.code == _STEEP for one in found):
            return found
        with self.stage("checks"):
            changes = self.flatter
        hint = f" With {text_of(changes)} it keeps the limit." if changes else ""
        return tuple(
            replace(one, message=one.message + hint) if one.code == _STEEP else one for one in found
        )

    @property
    def angles(self) -> Array:
        """The cam angles of the motion's table, rad, in steps of the design, both ends."""
        return turn_in_steps(self.design.output.motion_step)

    def moved(self, theta: ArrayLike | None, name: str, scale: float, unit: str) -> Columns:
        """Return a motion with its derivatives, by cam angle and by time, and pressure angles.

        Parameters
        ----------
        theta : (n,) array, rad, optional
            Cam angles; by default those of ``motion.csv``.
        name : str
            What the motion is called.
        scale : float
            Factor to the unit of the table.
        unit : str
            That unit.
        """
        where = self.angles if theta is None else angles("theta", theta)
        speed, derivatives = self.design.drive.speed, self.program.derivatives(where, 3)
        columns = {"theta_deg": np.degrees(where), f"{name}_{unit}": scale * derivatives[0]}
        columns |= {
            f"{name}_{unit}_per_rad{power}": scale * derivatives[k] for name, k, power in ORDERS
        }
        if speed is not None:
            columns |= {
                f"{name}_{unit}_s{power}": scale * speed**k * derivatives[k]
                for name, k, power in ORDERS
            }
        for word, x in self.places.items():
            columns[f"pressure_angle_{word}_deg"] = np.degrees(self.pressure_at(where, x))
        return Columns(columns)

    @property
    def steps(self) -> int:
        """Number of cam angles of a turn in solids: even, so that half of them is one too."""
        return 2 * math.ceil(math.pi / self.design.output.wall_step - 1e-9)

    @property
    def carved(self) -> bool:
        """Whether the solid is made by cutting with rollers: a wall is undercut."""
        return self.cam.undercut

    @property
    def solid_steps(self) -> int:
        """Number of cam angles of the solid; less where it is carved, which takes long."""
        return min(self.steps, self.most_carved) if self.carved else self.steps

    @cached_property
    def mesh(self) -> Mesh:
        """The cam as a closed mesh, mm.

        Raises
        ------
        InfeasibleError
            If it would have too many facets.
        """
        steps, places = self.solid_steps, self.design.output.wall_points
        if not self.carved and self.facets(steps, places) > self.most_facets:
            raise self._too_fine(places)
        return self.fitted(self.body, self.core)

    @cached_property
    def body(self) -> Mesh:
        """The cam without what its core has, as a mesh of the steps of the design."""
        return self.body_of(self.solid_steps, self.design.output.wall_points)

    def _too_fine(self, places: int) -> InfeasibleError:
        """Return the refusal of a solid with too many facets, with the least step that has not."""
        pairs = range(1, self.steps)
        most = 2 * bisect_right(pairs, self.most_facets, key=lambda k: self.facets(2 * k, places))
        value, limit = math.degrees(self.design.output.wall_step), 360.0 / max(most, 1)
        what = f"the solid would have more than {self.most_facets} facets"
        return beyond_limit(
            what, "output.wall_step_deg", value, limit, near=ABOVE * limit, unit="deg"
        )

    @cached_property
    def volume_error(self) -> float:
        """Error of the volume of the mesh, mm^3, from the volume of a mesh of half the steps."""
        places = self.design.output.wall_points
        coarse = self.mesh_of(self.solid_steps // 2, max(2, (places + 1) // 2)).volume
        return abs(self.mesh.volume - coarse) / 3.0

    @property
    def more_errors(self) -> Estimates:
        """Other errors of the solid than those of walls and volume."""
        return {}

    @cached_property
    def accuracy(self) -> Tree | None:
        """The errors of the solid where files or a density ask for it (see `Staged`)."""
        errors: dict[str, tuple[float, str]] = {}
        if self.solid_asked:
            chords = "distance of the walls from the middles of all edges of the mesh"
            scallops = f"height of the scallops between the positions of the {self.cutter}"
            errors["chord_mm"] = self.chord_error, scallops if self.carved else chords
            errors |= self.more_errors
        if self.weighed:
            how = "a third of the change from a mesh of half the steps"
            errors["volume_mm3"] = self.volume_error, how
        if not errors:
            return None
        values: Tree = {name: value for name, (value, _) in errors.items()}
        return values | {"how": {name: how for name, (_, how) in errors.items()}}

    @property
    def weighed(self) -> bool:
        """Whether a file or a density needs the volume."""
        return self.solid_asked or bool(self.design.blank.density)

    @property
    def solid_asked(self) -> bool:
        """Whether a file needs the solid."""
        return not self.solid_files.isdisjoint(self.design.output.files)

    @cached_property
    def meshes(self) -> Mapping[str, Mesh]:
        """The cam as a closed mesh of plain arrays by name, mm, as used for files."""
        return {STEM: self.mesh}

    @cached_property
    def solids(self) -> dict[str, Trimesh]:
        """The cam as a closed `trimesh.Trimesh` object by name, mm.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/cylinder_cam.toml"))
        >>> result.solids["cam"].is_watertight
        True
        """
        from gearcam.export.mesh import trimeshes

        return trimeshes(self.meshes)

    @property
    def main_errors(self) -> Sequence[tuple[str, Sequence[str]]]:
        """Errors that users act on (see `Result`)."""
        if not self.solid_asked:
            return ()
        return (
            ("walls of the solid, between its points", ["chord_mm"]),
            ("volume", ["volume_mm3"]),
        )
