"""The table ``[tool]``: the end mill that cuts a cylinder cam on a fourth axis.

Depends on quantities only.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import ANGLE, RPM, SPEED_PER_MINUTE, TEXT, param, positive_length


@dataclass(frozen=True, kw_only=True)
class MillSpec(ShortRepr):
    """The end mill of ``tool-path`` and ``gcode``, and how it is moved.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MillSpec(diameter=6.0, depth=1.5)
    MillSpec(diameter=6, depth=1.5)
    """

    diameter: float | None = positive_length(
        example=6,
        doc="diameter of the end mill, of a conical one where it is at the outside of the cam; the "
        "width of the groove if left out",
    )
    cone: float | None = param(
        ANGLE,
        default=None,
        ge=0,
        lt=60,
        example=0,
        doc="half angle of a conical end mill, which must be that of the roller; the roller's if "
        "left out",
    )
    depth: float | None = positive_length(
        example=1.5, doc="largest depth of one pass; half the diameter if left out"
    )
    feed: float = param(
        SPEED_PER_MINUTE,
        default=5.0,
        ge=10,
        le=1e5,
        doc="feed along the path, at the outside of the cam",
    )
    spindle: float | None = param(
        RPM,
        default=None,
        ge=1,
        le=1e6,
        example=10000,
        doc="speed of the spindle; if left out the program stops for you to start it by hand",
    )
    rotary: str = param(
        TEXT,
        default="growing",
        choices=("growing", "wrapped"),
        doc="words of A in the program: growing over all turns, or from 0 to below 360 deg for a "
        "wrapped axis (LinuxCNC: WRAPPED_ROTARY = 1)",
    )
    clearance_height: float = positive_length(
        default=5.0, doc="height above the cam at which the tool moves rapidly"
    )
