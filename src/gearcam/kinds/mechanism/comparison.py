"""The same mechanism behind several drives, side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.kinds.mechanism.outputs import RATES
from gearcam.numeric.columns import Columns

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from gearcam.kinds.mechanism.build import MechanismResult

Row = dict[str, Any]

_DEG: Final = math.degrees(1.0)


def comparison(result: MechanismResult) -> Mapping[str, ArrayLike]:
    """Return what the drives to compare make of each output.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.

    Returns
    -------
    dict of str to (n,) array
        A row for each drive and output: ``drive``, the master's range ``range_deg``, ``output``,
        ``unit``, ``stroke``, the largest sizes of the derivatives by the master's angle with the
        places, ``velocity`` and ``velocity_at_deg`` and so on, in the unit or rad; with a speed
        those by time, ``velocity_per_s``, and the range's time, ``range_s``. Places of what stands
        still are masked.
    """
    return _tabled(result, _of_outputs)


def interval_table(result: MechanismResult) -> Columns:
    """Return the intervals that a design asks for, behind each drive.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.

    Returns
    -------
    Columns
        A row for each drive and interval: ``drive``, ``on``, ``before``, the master's angles
        ``from_deg``, ``to_deg``, ``angle_deg``, the velocity at the beginning by the master's
        angle; with a speed the time, ``time_s``, and the velocity by time.
    """
    return Columns(_tabled(result, _of_intervals))


def _tabled(
    result: MechanismResult, rows_of: Callable[[str, MechanismResult], Iterator[Row]]
) -> Mapping[str, ArrayLike]:
    rows = [row for name, one in result.machines.items() for row in rows_of(name, one)]
    return {key: _column([row[key] for row in rows]) for key in rows[0]}


def _column(values: list[Any]) -> ArrayLike:
    """Return the values of a column, those that are None masked."""
    missing = [one is None for one in values]
    if not any(missing):
        return np.array(values)
    there = [0.0 if one is None else one for one in values]
    return np.ma.MaskedArray(there, mask=missing)


def _of_outputs(name: str, machine: MechanismResult) -> Iterator[Row]:
    speed, (low, high) = machine.speed, machine.linkage.span
    for one in machine.outputs:
        measures, (scale, unit) = machine.measures[one.stem], one.unit
        row: Row = {
            "drive": name, "range_deg": _DEG * (high - low), "output": one.stem, "unit": unit,
            "stroke": scale * measures.stroke,
        }  # fmt: skip
        if speed is not None:
            row["range_s"] = (high - low) / speed
        for order, word in enumerate(RATES, start=1):
            peak = measures.size(order)
            place = None if measures.still else _DEG * peak.place
            row |= {word: peak.value, f"{word}_at_deg": place}
            if speed is not None:
                row[f"{word}_per_s"] = peak.value * speed**order
        yield row


def _of_intervals(name: str, machine: MechanismResult) -> Iterator[Row]:
    speed = machine.speed
    for one, found, rate in zip(
        machine.design.interval, machine.intervals, machine.interval_velocities, strict=True
    ):
        row = {
            "drive": name, "on": one.on, "before": one.before, "from_deg": _DEG * found.begin,
            "to_deg": _DEG * found.end, "angle_deg": _DEG * found.length, "velocity": rate,
        }  # fmt: skip
        yield row if speed is None else row | {
            "time_s": found.length / speed, "velocity_per_s": rate * speed,
        }  # fmt: skip
