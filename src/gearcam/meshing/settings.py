"""What a design says of its meshing study."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.display import Brief
from gearcam.quantities import ANGLE, COUNT, LENGTH, param

KIND = "meshing"
"""The checks of a study."""


@dataclass(frozen=True, kw_only=True)
class MeshingSpec(Brief):
    """Phases of the driver, its overclosure, and how the wheels are mounted.

    The phases divide the stretch from `start` to `end` into `steps` equal parts, its end left out;
    open wheels and racks are studied at both of its ends. Without `end` it is a turn of the driver,
    or the travel of open wheels and racks to the stop.
    The driver is turned ahead by `overclosure` at each (a negative one holds it back, so that the
    other flanks touch). With `teeth` only the phases in which these teeth of the driver are near
    the pitch point are studied. Without `center_distance` the wheels stand as designed; a larger
    one gives backlash, but presses a wheel into its ring.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"meshing.steps": 72})
    >>> design.meshing == gc.MeshingSpec(steps=72)
    True
    """

    steps: int = param(COUNT, default=360, ge=1, le=1000000, doc="number of phases, at even angles")
    start: float = param(
        ANGLE, default=0.0, ge=-36000, le=36000, word="from", doc="driver angle of the first phase"
    )
    end: float | None = param(
        ANGLE,
        default=None,
        ge=-36000,
        le=36000,
        word="to",
        doc="driver angle at which the study ends; a turn, or the last stop, if left out",
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
        doc="teeth of the driver that count; all if left out",
    )
    step: int = param(
        COUNT, default=1, ge=1, le=100, doc="step studied of stepped wheels, from below"
    )
    center_distance: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=1e6,
        doc="centre distance as mounted, not of a rack; as designed if left out",
    )
