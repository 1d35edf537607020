"""Columns: tables of results that data frames accept.

A table is a dictionary of arrays of equal length whose names end in their units, with the same
columns as the CSV file of the table.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.base.display import line
from gearcam.base.near_names import UnknownNameError
from gearcam.numeric.arrays import Array


class Columns(dict[str, NDArray[Any]]):
    """Arrays (n,) by name; ``pandas.DataFrame(columns)`` and ``polars.DataFrame(columns)`` work.

    Names end in the unit, as keys of design files do (``x_mm``, ``phi1_deg``); without one the
    column has plain numbers. Values that do not exist are nan.

    Parameters
    ----------
    columns : mapping of str to (n,) array
        In order; whole numbers stay whole, masked values become nan.

    Examples
    --------
    >>> import gearcam as gc
    >>> columns = gc.build(gc.load("profiles/eccentric_cam.toml")).motion([0.0, 1.0])
    >>> columns["lift_mm"].round(3)
    array([0.   , 2.758])
    >>> list(columns)[:3]
    ['theta_deg', 'lift_mm', 'velocity_mm_per_rad']
    """

    def __init__(self, columns: Mapping[str, ArrayLike]) -> None:
        super().__init__({name: _plain(values) for name, values in columns.items()})

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (dict(self),)

    def __missing__(self, name: str) -> NDArray[Any]:
        raise UnknownNameError(name, self)

    def __repr__(self) -> str:
        rows = len(next(iter(self.values()), ()))
        return line(type(self).__name__, [f"{rows} rows", *self])

    @property
    def points(self) -> Array:
        """The columns x_mm and y_mm as one array, (n, 2), mm, in the frame of the table."""
        return np.column_stack([self["x_mm"], self["y_mm"]])

    @property
    def normals(self) -> Array:
        """The columns nx and ny as one array, (n, 2): unit normals, in the frame of the table."""
        return np.column_stack([self["nx"], self["ny"]])


def _plain(values: ArrayLike) -> NDArray[Any]:
    if np.any(getattr(values, "mask", False)):
        return np.where(values.mask, np.nan, values.data)  # pyright: ignore
    return np.asarray(values)
