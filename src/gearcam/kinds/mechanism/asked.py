"""What a design asks of its outputs: the last bits of their travel, and stretches of paths."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from gearcam.base.errors import ABOVE, DesignError, InfeasibleError, Problem, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.linkages.dwells import WHOLE, DriverRange, ShortRangeError, last_travels

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult
    from gearcam.kinds.mechanism.tables import StretchSpec
    from gearcam.linkages.path_fits import CircleFit, LineFit

_ROUNDED: Final = 1e-9
"""Stroke of what stands still but for rounding, mm or rad."""

_LEAST_TRAVEL: Final = 2e-3
"""Travel up to which none is offered that is smaller, mm or deg."""

_DEG: Final = math.degrees(1.0)


def last_bits(result: MechanismResult) -> Iterator[DriverRange]:
    """Yield the master's ranges over the last bits of travel (see `MechanismResult.intervals`).

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    """
    for number in range(len(result.design.interval)):
        yield _last_bit(result, number)


def _last_bit(result: MechanismResult, number: int) -> DriverRange:
    one, (output, travel) = result.design.interval[number], result.asked("interval", number)
    measures = result.measures_of(output)
    what, most = f"{one.on} does not travel as far", measures.stroke
    if measures.rise:
        raise InfeasibleError(
            f"{one.on} turns on and has no dead centre", where=f"interval[{number}].on"
        )
    if travel <= most * WHOLE:
        try:
            return last_travels(measures, travel, outer=one.before == "outer")[0]
        except ShortRangeError as error:
            what = f"{one.on} does not travel as far before its {one.before} dead centre"
            most = error.travel
    if measures.stroke <= _ROUNDED:
        what, most = f"{one.on} does not move", 0.0
    scale, unit = output.unit
    where = f"interval[{number}].travel_{unit}"
    near = scale * most / ABOVE if scale * most > _LEAST_TRAVEL else None
    raise beyond_limit(what, where, scale * travel, scale * most, near=near, unit=unit)


def fits(result: MechanismResult) -> Iterator[LineFit | CircleFit]:
    """Yield the lines and circles nearest to stretches (see `MechanismResult.stretches`).

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    """
    for number, one in enumerate(result.design.stretch):
        _demand_inside(result, number, one)
        yield _fit(result, number, one)


def _fit(result: MechanismResult, number: int, one: StretchSpec) -> LineFit | CircleFit:
    from gearcam.linkages.nearest_circle import StraightError
    from gearcam.linkages.path_fits import best_circle, best_line

    fit = best_line if one.shape == "line" else best_circle
    try:
        return fit(result.paths[one.on], one.start, one.end)
    except StraightError as error:
        where = f"stretch[{number}].shape"
        raise InfeasibleError(str(error), where=where, nearest='shape = "line"') from None


def _demand_inside(result: MechanismResult, number: int, one: StretchSpec) -> None:
    """Raise `DesignError` for a stretch that an open range of the master does not hold."""
    low, high = result.linkage.span
    for key, value in (("from_deg", one.start), ("to_deg", one.end)):
        if not result.linkage.closed and not low <= value <= high:
            what = f"{formatted(_DEG * value, 8)} is beyond the master's range"
            where = f"stretch[{number}].{key}"
            allowed = f"{formatted(_DEG * low, 8)} to {formatted(_DEG * high, 8)}"
            source = result.design.source
            raise DesignError([Problem(what, source, None, where, _DEG * value, allowed)])
