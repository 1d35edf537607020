"""The tables ``[output]``: which files each kind of design can give, and how exact."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from gearcam.design.wording import Fault, show
from gearcam.quantities import ANGLE, COUNT, LENGTH, TEXT, param

PAIR_FORMATS: Final = (
    "dxf", "cut-svg", "svg", "stl", "3mf", "glb", "step", "csv", "drawing-dxf", "drawing-svg",
    "inspection",
)  # fmt: skip
"""What ``output.files`` of a gear pair may list."""

CAM_FORMATS: Final = (*PAIR_FORMATS, "tool-path", "curvature")
"""What ``output.files`` of a cam may list."""

FORMATS: Final = tuple(dict.fromkeys((*PAIR_FORMATS, *CAM_FORMATS)))
"""Every kind of file that a design of some kind can give."""

_FILES: Final = "the files to write; summary.json always is"


def _dxf_curves() -> Any:
    return param(
        TEXT,
        default="arcs",
        choices=("arcs", "splines", "lines"),
        doc="how dxf outlines are drawn",
    )


def _dxf_version() -> Any:
    return param(
        TEXT,
        default=None,
        choices=("R2010", "R12"),
        doc="version of dxf files; R12, for old machines, with lines, R2010 else, when left out",
    )


def _kerf() -> Any:
    return param(
        LENGTH,
        default=0.0,
        ge=0,
        le=100,
        doc="what the cutter burns away; the paths of dxf files to be cut and of cut-svg move by "
        "half of it",
    )


@dataclass(frozen=True, kw_only=True)
class OutputSpec:
    """Which files of a gear pair are wanted, and how exact.

    Parameters
    ----------
    kerf : float, mm
        What the cutter burns away.
    dxf_curves, dxf_version : str
        How outlines are drawn, and for which readers.
    """

    files: tuple[str, ...] = param(TEXT, default=("csv",), choices=PAIR_FORMATS, doc=_FILES)
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        doc="largest distance of an outline's chords from the true curve; "
        "the smaller of 0.001 mm and module/1000 when left out, never coarser than module/50",
    )
    kerf: float = _kerf()
    dxf_curves: str = _dxf_curves()
    dxf_version: str | None = _dxf_version()
    pose: float = param(
        ANGLE,
        default=0.0,
        ge=-36000,
        le=36000,
        word="phi1",
        doc="driver angle at which the assembled pair is drawn",
    )
    inspection_points: int = param(
        COUNT, default=9, ge=2, le=1000, doc="points on each flank in inspection.csv"
    )


@dataclass(frozen=True, kw_only=True)
class CamOutputSpec:
    """Which files of a cam are wanted, and how exact.

    Parameters
    ----------
    kerf : float, mm
        What the cutter burns away.
    dxf_curves, dxf_version : str
        How outlines are drawn, and for which readers.
    """

    files: tuple[str, ...] = param(TEXT, default=("csv",), choices=CAM_FORMATS, doc=_FILES)
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=1,
        doc="largest distance of an outline's chords from the true curve; 0.001 mm when left out",
    )
    kerf: float = _kerf()
    dxf_curves: str = _dxf_curves()
    dxf_version: str | None = _dxf_version()
    pose: float = param(
        ANGLE,
        default=0.0,
        ge=-36000,
        le=36000,
        word="theta",
        doc="cam angle at which the assembled cam is drawn",
    )
    motion_step: float = param(
        ANGLE, default=math.radians(1), gt=0, le=90, doc="step of the cam angle in motion.csv"
    )
    inspection_points: int = param(
        COUNT, default=360, ge=8, le=100000, doc="points in inspection.csv, at even cam angles"
    )
    tool_radius: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=1e6,
        doc="radius of the cutter of the tool path; the follower's radius when left out",
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
