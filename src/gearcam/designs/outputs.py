"""The table ``[output]``: which files are wanted, and how exact."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from gearcam.designs.faults import Fault, show
from gearcam.display import Brief
from gearcam.quantities import ANGLE, LENGTH, TEXT, param

FORMATS: Final = (
    "dxf", "cut-svg", "svg", "stl", "3mf", "glb", "step", "csv", "drawing-dxf", "drawing-svg",
    "inspection", "report",
)  # fmt: skip
"""What ``output.files`` of any kind may list."""

_FILES: Final = "the files to write; summary.json always is"


def files_param(formats: tuple[str, ...]) -> Any:
    """Return the field of the files that are wanted, out of some `formats`."""
    return param(TEXT, default=("csv",), choices=formats, doc=_FILES)


def pose_param(word: str, doc: str) -> Any:
    """Return the field of the angle at which the machine is drawn: its key's `word`, its `doc`."""
    return param(ANGLE, default=0.0, ge=-36000, le=36000, word=word, doc=doc)


@dataclass(frozen=True, kw_only=True)
class OutputSpec(Brief):
    """Which files are wanted, and how exact; each kind adds what its own files need.

    Parameters
    ----------
    files : tuple of str
        Kinds of files.
    chord_tolerance : float, mm
        Largest distance of an outline's chords from the true curve.
    kerf : float, mm
        What the cutter burns away.
    dxf_curves, dxf_version : str
        How outlines are drawn, and for which readers.
    """

    files: tuple[str, ...] = files_param(FORMATS)
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        doc="largest distance of an outline's chords from the true curve; "
        "the smaller of 0.001 mm and module/1000 when left out, never coarser than module/50",
    )
    kerf: float = param(
        LENGTH,
        default=0.0,
        ge=0,
        le=100,
        doc="what the cutter burns away; the paths of dxf files to be cut and of cut-svg move by "
        "half of it",
    )
    dxf_curves: str = param(
        TEXT, default="arcs", choices=("arcs", "splines", "lines"), doc="how dxf outlines are drawn"
    )
    dxf_version: str | None = param(
        TEXT,
        default=None,
        choices=("R2010", "R12"),
        doc="version of dxf files; R12, for old machines, with lines, R2010 else, when left out",
    )


def output_faults(raw: Any) -> Iterator[Fault]:
    """Yield what contradicts itself in a table ``[output]`` of any kind, as read."""
    if not isinstance(raw, Mapping):
        return
    if raw.get("dxf_curves") == "splines" and raw.get("dxf_version") == "R12":
        rule = '"arcs" or "lines" in R12, "splines" in R2010'
        yield Fault(("output", "dxf_version"), '"R12": it knows no splines', "R12", rule)
    files = raw.get("files")
    if isinstance(files, list):
        for index, name in enumerate(files):
            if isinstance(name, str) and name in files[:index]:
                message = f"{show(name)} is listed twice"
                yield Fault(("output", "files", index), message, name, "each kind of file once")
