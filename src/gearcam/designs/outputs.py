"""The table ``[output]``: which files are written, and how exact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.brought import Words, group_of
from gearcam.base.display import ShortRepr
from gearcam.base.inches import UNITS
from gearcam.base.kinds import kind_studies
from gearcam.base.quantities import ANGLE, FINEST, LENGTH, TEXT, allowance, param
from gearcam.base.rules import distinct, excluded

MESHES: Final = ("stl", "3mf", "glb")
"""Kinds of files of solids made of triangles; `gearcam.export.mesh` has their writers."""

DRAWINGS: Final = ("drawing-dxf", "drawing-svg", "drawing-pdf")
"""Kinds of files of workshop drawings."""

FORMATS: Final = (
    "dxf", "cut-svg", "svg", *MESHES, "step", "csv", *DRAWINGS, "print-pdf", "inspection",
    "report",
)  # fmt: skip
"""Kinds of files that ``output.files`` may list."""

PROCESSES: Final = ("printing", "laser", "wire", "milling")
"""How parts are made."""

_FILES: Final = "files to write; summary.json is always written"
_STUDIES: Final = "studies to include in summary and report, by the names of their commands"


def files_param(formats: tuple[str, ...], kind: str) -> Any:
    """Return the field of the files to write of a `kind` of design, any of some `formats`."""
    words = Words(formats, group_of(kind, "formats"))
    return param(TEXT, default=("csv",), choices=words, doc=_FILES)


def studies_param(kind: str = "") -> Any:
    """Return the field of the studies to include, any of those of a `kind`, if it is given."""
    return param(TEXT, default=(), choices=kind_studies(kind) if kind else (), doc=_STUDIES)


def process_param() -> Any:
    """Return the field of the process by which parts are made."""
    doc = "how the parts are made: arrows and zero marks are as wide and deep as it can make them; "
    doc += "as milled ones if left out"
    return param(TEXT, default=None, choices=PROCESSES, example="printing", doc=doc)


def pose_param(word: str, doc: str) -> Any:
    """Return the field of the angle of the assembly drawing: the `word` of its key, its `doc`."""
    return param(ANGLE, default=0.0, ge=-36000, le=36000, word=word, doc=doc)


@dataclass(frozen=True, kw_only=True)
class OutputSpec(ShortRepr):
    """Which files are written, and how exact; each kind of design adds its own fields.

    Parameters
    ----------
    files : tuple of str
        Kinds of files.
    studies : tuple of str
        Names of studies.
    chord_tolerance : float, mm
        Largest distance of an outline from the true curve.
    kerf : float, mm
        Width of the cut.
    units : {"mm", "inch"} or None
        Unit of lengths in files; None: that of the design.
    dxf_curves, dxf_version : str
        How outlines are drawn, and the version of the files.
    process : str
        How the parts are made.
    """

    files: tuple[str, ...] = param(TEXT, default=("csv",), choices=FORMATS, doc=_FILES)
    studies: tuple[str, ...] = studies_param()
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=FINEST,
        example=0.001,
        doc="largest distance of an outline from the true curve, at most module/50; 0.001 mm or "
        "module/1000 if left out, the smaller one",
    )
    kerf: float = allowance(
        doc="width of the cut; cutting paths in dxf and cut-svg are offset from the part by half "
        "of it",
    )
    units: str | None = param(
        TEXT,
        default=None,
        choices=UNITS,
        example="inch",
        doc="unit of lengths in files; if left out that of the design; workshop drawings always "
        "have millimetres",
    )
    dxf_curves: str = param(
        TEXT,
        default="arcs",
        choices=("arcs", "splines", "lines"),
        doc="how outlines are drawn in dxf files",
    )
    dxf_version: str | None = param(
        TEXT,
        default=None,
        choices=("R2010", "R12"),
        example="R2010",
        doc="version of dxf files; if left out R12 (for old machines) with lines, else R2010",
    )
    process: str | None = process_param()

    @property
    def marking(self) -> str:
        """The process by which arrows and marks are made."""
        return self.process or "milling"

    rules = (
        excluded(
            "dxf_version", "R12", dxf_curves="splines",
            why="DXF R12 does not support splines",
            allowed='"arcs" or "lines" in R12, "splines" in R2010',
        ),
        distinct("files", "format"),
        distinct("studies", "study"),
    )  # fmt: skip
