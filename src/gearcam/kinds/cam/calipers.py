"""Tables to measure a cam by: its radius for each angle, and the lift of a wheel that grinds it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.inches import file_unit
from gearcam.cams.caliper import caliper, lowered, wheel
from gearcam.kinds.shared import steps_of_turn

if TYPE_CHECKING:
    from gearcam.kinds.cam.result import CamResult
    from gearcam.numeric.arrays import Array

_ROWS: Final = 36
"""Largest number of steps in the table on a sheet."""

_DECIMALS: Final = 9
"""Decimals of lengths in mm: beyond what is measured, and without the noise of rounding."""

_ROUNDING: Final = 1e-9
"""Share of a step by which a travel may differ from whole steps."""

Table = dict[str, "Array"]


def caliper_table(result: CamResult, step: float | None = None, number: int | None = None) -> Table:
    """Return the radius of the finished walls at equal steps of the polar angle.

    Parameters
    ----------
    result : CamResult
        The cam.
    step : float, rad or mm, optional
        Step of the angle, of a plate along its travel; by default that of the design.
    number : int, optional
        Number of the part, from 0, whose walls are wanted; by default all.

    Returns
    -------
    dict of str to (n,) array
        ``angle_deg`` in the frame of the part, and for each wall ``radius_mm`` (``radius_inner_mm``
        and so on); of a plate ``x_mm`` in its frame, and ``height_mm`` above its lower edge.
    """
    walls: Sequence[Any] = result.cam.walls
    walls = [lowered(wall, result.design.blank.clearance) for wall in walls]
    if number is not None and len(walls) == len(result.parts):
        walls = [walls[number]]
    output: Any = result.design.output
    if not result.carrier.around:
        return _heights(walls, step or output.height_step)
    places = steps_of_turn(step or output.caliper_step)
    read = {f"radius{wall.ending}_mm": np.round(caliper(wall, places), _DECIMALS) for wall in walls}
    return {"angle_deg": np.degrees(places), **read}


def sheet_table(result: CamResult, number: int) -> Table:
    """Return a short table for the sheet of a part.

    Parameters
    ----------
    result : CamResult
        The cam.
    number : int
        Number of the part, from 0.

    Returns
    -------
    dict of str to (n,) array
        Rows of `caliper_table`, of the walls of the part: all, or every second and so on; of a
        plate with too many for a sheet those at round places.
    """
    output: Any = result.design.output
    if result.carrier.around:
        every = math.ceil(2.0 * math.pi / (_ROWS * output.caliper_step) - _ROUNDING)
        return caliper_table(result, max(1, every) * output.caliper_step, number)
    step, period, size = output.height_step, result.program.period, file_unit().size
    if _ROWS * step < period:
        step = size * 10.0 ** math.floor(math.log10(period / size / _ROWS))
        step *= next(one for one in (1.0, 2.0, 5.0, 10.0) if one * step * _ROWS >= period)
    return caliper_table(result, step, number)


def _heights(walls: Sequence[Any], step: float) -> Table:
    """Return the heights of walls above the lower edge of their plate, in whole steps of x."""
    ends = np.array([wall.line.real[[0, -1]] for wall in walls])
    low, high = ends.min() / step, ends.max() / step
    places = step * np.arange(math.ceil(low - _ROUNDING), math.floor(high + _ROUNDING) + 1.0)
    read = {wall.ending: caliper(wall, places) - wall.plate.low for wall in walls}
    kept = ~np.isnan([*read.values()]).all(axis=0)
    heights = {
        f"height{ending}_mm": np.ma.masked_invalid(np.round(one[kept], _DECIMALS))
        for ending, one in read.items()
    }
    return {"x_mm": places[kept], **heights}


def grinding_tables(result: CamResult) -> dict[str, Table]:
    """Return the lift of a grinding wheel above the axis over the cam angle, by ending of names.

    Parameters
    ----------
    result : CamResult
        The cam.

    Returns
    -------
    dict of str to dict
        ``theta_deg``; ``lift_mm`` from the lowest place of the wheel; ``wheel_mm``, the distance of
        its centre, of a flat one its face, from the axis.

    Raises
    ------
    InfeasibleError
        If the cam slides, or the wheel does not reach a whole wall.
    """
    if not result.carrier.around:
        what, rule = "the wheel of grinding.csv is above a cam that turns", "other files"
        raise InfeasibleError(what, where="output.files", nearest=rule)
    theta, output = result.angles, result.design.output
    theta = theta[theta < result.program.period * (1.0 - _ROUNDING)]
    tables = {}
    for wall in result.cam.walls:
        angles = 0.5 * math.pi - wall.hand * theta
        own = wall.follower.radius if wall.follower.has_centre else "flat"
        given: Any = output.grinding_wheel_radius or own
        radius = math.inf if given == "flat" else given
        far = wheel(lowered(wall, result.design.blank.clearance), angles, radius)
        tables[wall.ending] = {
            "theta_deg": np.degrees(theta),
            "lift_mm": np.round(far - far.min(), _DECIMALS),
            "wheel_mm": np.round(far, _DECIMALS),
        }
    return tables
