"""The table ``[gravity]``."""

from __future__ import annotations

import cmath
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import ACCELERATION, ANGLE, param
from gearcam.base.rules import needs

G = 9.80665
"""Standard acceleration of gravity, m/s2."""


@dataclass(frozen=True, kw_only=True)
class GravitySpec(ShortRepr):
    """The direction in which gravity pulls; none without it.

    Examples
    --------
    >>> import gearcam as gc
    >>> import math
    >>> gc.GravitySpec(direction=math.radians(-90.0)).given
    True
    """

    direction: float | None = param(
        ANGLE,
        default=None,
        ge=-360,
        le=360,
        example=-90,
        doc="direction of the pull, from the x axis of the assembled cam, or of the machine; of a "
        "cam in space from y towards z, the cam's axis, of a globoidal cam from x towards z",
    )
    g: float = param(ACCELERATION, default=G, ge=0, le=1000, doc="acceleration")

    rules = (needs("g", "direction"),)

    @property
    def given(self) -> bool:
        """Whether gravity acts."""
        return self.direction is not None

    @property
    def pull(self) -> complex:
        """Acceleration, m/s2, in the frame of its direction; 0 where none is given."""
        return 0j if self.direction is None else cmath.rect(self.g, self.direction)
