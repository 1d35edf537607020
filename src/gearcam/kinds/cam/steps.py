"""The cam angles of tables: a turn, or the travel of a translating cam, in steps of the design.

Steps that give more than a million rows are refused.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import ABOVE, beyond_limit
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:
    from gearcam.cams.carriers import Driver
    from gearcam.kinds.cam.design import CamOutputSpec
    from gearcam.laws.program import Program

WHOLE: Final = 1e-9
"""Share of a step by which a turn may differ from whole steps, and share of a travel by which a
position may exceed it: rounding."""

_MOST: Final = 1e6
"""Largest number of steps of a table."""


def even_angles(output: CamOutputSpec, driver: Driver, program: Program) -> Array:
    """Return the cam angles of tables, including both ends.

    Parameters
    ----------
    output : CamOutputSpec
        With the step.
    driver : Driver
        Unit of the cam's angle or travel.
    program : Program
        The lift; a travel may end with a shorter step.

    Returns
    -------
    (n,) array, rad or mm

    Raises
    ------
    InfeasibleError
        If there are more than a million.
    """
    turn, slides = program.period, program.open
    step = output.travel_step if slides else output.motion_step
    if step < turn / _MOST:
        key = f"output.{'travel_step' if slides else 'motion_step'}_{driver.unit}"
        least = turn / _MOST * driver.scale
        what = f"tables would have more than {_MOST:.0f} rows"
        note = "the limit is the smallest step"
        raise beyond_limit(
            what, key, step * driver.scale, least, note, near=ABOVE * least, unit=driver.unit
        )
    made = step * np.arange(math.floor(turn / step + WHOLE) + 1.0)
    if slides:  # its end does not coincide with its beginning
        made = np.append(made[made < turn * (1.0 - WHOLE)], turn)
    return made
