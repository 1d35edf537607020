"""Settings of the meshing study in a design."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import ANGLE, COUNT, param, positive_length
from gearcam.base.rules import above, distinct, excluded

KIND = "meshing"
"""Registered checks of a study."""


@dataclass(frozen=True, kw_only=True)
class MeshingSpec(ShortRepr):
    """Phases of the driver, overclosure, and mounted centre distance.

    The phases divide the range from `start` to `end` into `steps` equal parts, without its end;
    open wheels and racks are studied at both ends. The default `end` is a turn of the driver, or
    the travel of open wheels and racks. At each phase the driver is turned ahead by `overclosure`;
    a negative one holds it back, so that the coast flanks touch. With `teeth` only the phases in
    which these teeth of the driver are near the pitch point are studied. By default the wheels are
    mounted at the design centre distance; a larger `center_distance` gives backlash, but presses a
    wheel into its ring.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"meshing.steps": 72})
    >>> design.meshing == gc.MeshingSpec(steps=72)
    True
    """

    steps: int = param(COUNT, default=360, ge=1, le=1000000, doc="number of phases, evenly spaced")
    start: float = param(
        ANGLE, default=0.0, ge=-36000, le=36000, word="from", doc="driver angle of the first phase"
    )
    end: float | None = param(
        ANGLE,
        default=None,
        ge=-36000,
        le=36000,
        word="to",
        example=8,
        doc="driver angle at the end of the study; by default a turn, or the end of travel",
    )
    overclosure: float = param(
        ANGLE,
        default=math.radians(0.005),
        ge=-1,
        le=1,
        doc="how far the driver is turned ahead (or back), so that flanks overlap; not 0",
    )
    teeth: tuple[int, ...] | None = param(
        COUNT,
        default=None,
        ge=1,
        min_length=1,
        example=[1, 2],
        doc="tooth numbers of the driver to study; all by default",
    )
    step: int = param(
        COUNT, default=1, ge=1, le=100, doc="step of stepped gears to study, counted from below"
    )
    center_distance: float | None = positive_length(
        example=80.1, doc="centre distance as mounted, not for racks; as designed by default"
    )

    rules = (
        above("end", "start", why="the study would end before it begins, at {}"),
        excluded(
            "overclosure", 0,
            why="without an overclosure no flanks overlap, and the study finds no contact",
            allowed="-1 to 1, but not 0; 0.005 is usual",
        ),
        distinct("teeth", "tooth"),
    )  # fmt: skip
