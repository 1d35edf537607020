"""The table ``[friction]`` of cams in space.

Depends on mechanics only.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.base.quantities import LENGTH, LONGEST, param
from gearcam.base.rules import needs
from gearcam.mechanics.friction import FrictionSpec, coefficient


@dataclass(frozen=True, kw_only=True)
class SpaceFrictionSpec(FrictionSpec):
    """Coefficients of friction of a cam in space, 0 where left out, and sizes of bearings.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SpaceFrictionSpec(guide=0.1, guide_length=60.0, guide_distance=70.0)
    SpaceFrictionSpec(guide=0.1, guide_length=60, guide_distance=70)
    """

    flank: float = coefficient(
        doc="of the slip along a roller, which has one speed where the cam is faster outside"
    )
    guide_at: float | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        example=30,
        doc="height of the middle of the guide above the axis of the roller, or the middle of two; "
        "0 if left out",
    )
    guide_distance: float | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        example=70,
        doc="distance of the guide from the cam's axis, along the roller",
    )

    rules = (
        *FrictionSpec.rules,
        needs("guide_length", "guide_distance"),
        needs("guide_distance", "guide_length"),
        needs("guide_at", "guide_length"),
    )
