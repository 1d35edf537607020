"""The tables of a cam beside motion, follower and size: blank, output, the study of a profile."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    ANGLE,
    COUNT,
    FINEST,
    LENGTH,
    TEXT,
    allowance,
    fixed,
    param,
    positive_length,
)
from gearcam.designs.outputs import FORMATS, OutputSpec, files_param, pose_param, studies_param
from gearcam.parts.blank import WheelBlank

CAM_FORMATS: Final = (*FORMATS, "tool-path", "curvature")
"""What ``output.files`` of a cam may list."""


def _direction(*, doc: str) -> Any:
    return param(ANGLE, default=0.0, ge=-360, le=360, doc=doc)


@dataclass(frozen=True, kw_only=True)
class CamBlank(WheelBlank):
    """Bore, hub, holes, density of a cam: a `WheelBlank` without what belongs to teeth.

    Parameters
    ----------
    stop_pin, timing_marks, mark_diameter, tip_rounding
        A cam has none.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CamBlank(bore_diameter=16.0, density=7850.0)
    CamBlank(bore_diameter=16, density=7850)
    """

    keyway_angle: float = _direction(doc="direction of the keyway in the cam's frame")
    bolt_angle: float = _direction(doc="direction of the first bolt hole in the cam's frame")
    rim: float | None = positive_length(
        example=6,
        doc="least metal between lightening holes and profile; two thirds of the thickness if left "
        "out",
    )
    clearance: float = allowance(doc="what is taken off the profile, along its normal")
    clearance_bores: bool = param(
        TEXT,
        default=False,
        doc="whether bore and bolt holes are widened by the clearance too",
    )
    stop_pin: float = fixed(0.0)
    timing_marks: bool = fixed(False)
    mark_diameter: float | None = fixed(None)
    tip_rounding: float = fixed(0.0)


@dataclass(frozen=True, kw_only=True)
class FollowSpec(ShortRepr):
    """A given profile, of which the study ``follow`` computes the follower's motion.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.FollowSpec(file="measured.csv", wall="outer")
    FollowSpec(file='measured.csv', wall='outer')
    """

    file: str | None = param(
        TEXT,
        default=None,
        doc="cam profile: DXF with one closed outline, or CSV with columns x_mm and y_mm",
        example="measured.csv",
    )
    wall: str | None = param(
        TEXT,
        default=None,
        choices=("1", "2", "inner", "outer", "lower", "upper"),
        doc="wall to follow: 1 or 2 (conjugate cams); inner, outer, lower or upper (groove); the "
        "first if left out",
        example="outer",
    )


@dataclass(frozen=True, kw_only=True)
class CamOutputSpec(OutputSpec):
    """Which files and studies of a cam are written, and how exact (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        Cam angle of the assembly drawing.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CamOutputSpec(files=("dxf", "tool-path"), tool_radius=4.0)
    CamOutputSpec(files=('dxf', 'tool-path'), tool_radius=4)
    """

    files: tuple[str, ...] = files_param(CAM_FORMATS)
    studies: tuple[str, ...] = studies_param(("follow", "accuracy"))
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=FINEST,
        le=1,
        example=0.001,
        doc="largest distance of an outline from the true curve; 0.001 mm if left out",
    )
    pose: float = pose_param("theta", "cam angle of the assembly drawing")
    motion_step: float = param(
        ANGLE, default=math.radians(1), gt=0, le=90, doc="step of the cam angle in motion.csv"
    )
    inspection_points: int = param(
        COUNT,
        default=360,
        ge=8,
        le=100000,
        doc="number of points in inspection.csv, at equal steps of the cam angle",
    )
    tool_radius: float | None = positive_length(
        example=8,
        doc="radius of the cutter of the tool path; the follower's, or half a groove, if left out",
    )
