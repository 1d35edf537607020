"""The kind ``globoidal-cam``: its design and its tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.registry import classes_in
from gearcam.designs.design import Design, Wanted
from gearcam.designs.faults import Fault
from gearcam.designs.outputs import files_param, studies_param
from gearcam.kinds.globoidal_cam.index import NAME, TITLE
from gearcam.kinds.gridded_output import GriddedOutput
from gearcam.kinds.shared import AccuracySpec, GoalSpec
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.mechanics.drive import DriveSpec
from gearcam.spatial.globoidal_spec import GloboidalSpec, IndexSpec, TurretSpec
from gearcam.spatial.spec import CylinderBlank

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult

GLOBOIDAL_FORMATS: Final = ("svg", "stl", "3mf", "glb", "csv", "report")
"""What ``output.files`` may list."""

_FOLLOWED: Final = (
    "a mill as wide as the groove follows a roller: motion.csv has the angles of cam and turret"
)

_WITHOUT: Final = {
    "dxf": "the outside of a globoid cannot be unrolled into a plane",
    "step": "its solid is made of triangles, and walls.csv has exact points with normals",
    "tool-path": _FOLLOWED,
    "gcode": _FOLLOWED,
}
"""Why a file that other cams have is not made."""


def not_made(document: Mapping[str, Any]) -> Fault | None:
    """Return the fault of a file that is not made of globoidal cams, with the reason; or None."""
    output = document.get("output")
    files = output.get("files") if isinstance(output, Mapping) else None
    for number, name in enumerate(files if isinstance(files, list) else ()):
        if isinstance(name, str) and name in _WITHOUT:
            message = f'there is no "{name}" of a globoidal cam: {_WITHOUT[name]}'
            rule = ", ".join(GLOBOIDAL_FORMATS)
            return Fault(("output", "files", number), message, name, rule)
    return None


@dataclass(frozen=True, kw_only=True)
class GloboidalOutput(GriddedOutput):
    """Which files and studies of a globoidal cam are written, and how fine (see `GriddedOutput`).

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GloboidalOutput(files=("stl", "csv"), wall_points=25)
    GloboidalOutput(files=('stl', 'csv'), wall_points=25)
    """

    files: tuple[str, ...] = files_param(GLOBOIDAL_FORMATS)
    studies: tuple[str, ...] = studies_param(("accuracy",))


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class GloboidalCamDesign(Design):
    """The design of a globoidal indexing cam with its turret (see `Design`).

    Parameters
    ----------
    index : IndexSpec
        The motion of the turret in a turn of the cam.
    turret : TurretSpec
        Stops and rollers.
    cam : GloboidalSpec
        Place and length of the cam.
    drive : DriveSpec
        Speed of the cam.
    blank : CylinderBlank
        Bore and density.
    output : GloboidalOutput
        Files and how fine they are.
    accuracy : AccuracySpec
        Settings of the study of error against run time.
    goal : GoalSpec
        What `gearcam optimize` looks for.

    Examples
    --------
    >>> import gearcam as gc
    >>> index = gc.IndexSpec(law=gc.motion_laws.ModifiedSine(), angle=2.0)
    >>> turret = gc.TurretSpec(stops=8, roller_radius=8.0, roller_length=14.0, reach=58.0)
    >>> size = gc.GloboidalSpec(center_distance=100.0)
    >>> gc.GloboidalCamDesign(name="mine", index=index, turret=turret, cam=size)
    <GloboidalCamDesign "mine">
    """

    kind = NAME

    if TYPE_CHECKING:

        @property
        def _built(self) -> GloboidalCamResult: ...

    index: IndexSpec
    turret: TurretSpec
    cam: GloboidalSpec
    drive: DriveSpec = field(default_factory=DriveSpec)
    blank: CylinderBlank = field(default_factory=CylinderBlank)
    output: GloboidalOutput = field(default_factory=GloboidalOutput)
    accuracy: AccuracySpec = field(default_factory=AccuracySpec)
    goal: GoalSpec = field(default_factory=GoalSpec)

    def _wanted(self) -> Iterator[Wanted]:
        yield TITLE, self.index, (IndexSpec,)
        if isinstance(self.index, IndexSpec):
            laws = tuple(classes_in(MOTION_LAWS).values())
            yield f"{TITLE}.law", self.index.law, laws
