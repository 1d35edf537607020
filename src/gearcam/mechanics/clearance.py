"""Remarks on clearances of rollers: of grooves in plates, of cams in space.

Depends on base.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcam.base.findings import Remark


def without_clearance(roller: float, floor: float = math.inf) -> Iterator[Remark]:
    """Yield the remarks on rollers without clearance.

    Parameters
    ----------
    roller : float, mm
        Width of a groove less the roller's diameter.
    floor : float, mm
        Gap at the end of a roller; infinite without a floor.
    """
    if roller <= 0.0:
        yield Remark(
            "A roller has no clearance between its walls: it touches both, and they turn it in "
            "opposite directions. cam.roller_clearance_mm gives it some.",
            "between the walls",
            0.0,
        )
    if floor <= 0.0:
        yield Remark(
            "The end of a roller rubs on the floor: cam.floor_clearance_mm makes a gap.",
            "at the floor",
            0.0,
        )
