"""The table ``[[load]]`` of a pair: what its driven element works against."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Final

import numpy as np

from gearcam.base.quantities import ANGLE, FORCE, TEXT, TORQUE, Row, param
from gearcam.base.rules import Breach, exactly_one, needs
from gearcam.laws.columns import ColumnsError, FromFile
from gearcam.mechanics.load import MOST, PlacedLoad
from gearcam.numeric.arrays import Array

_KILO: Final = 1e3
"""N mm of a N m."""

_FARTHEST: Final = 36000
"""Largest driver angle of a pair that turns more than once, deg."""

OF_SPEED: Final = "omega2"
"""Variable of formulas over the speed of the driven wheel, rad/s."""

_COLUMNS: Final[Mapping[str, tuple[str, ...]]] = {
    "wheel1": ("wheel1_torque_nm", "torque_nm"),
    "wheel2": ("wheel2_torque_nm", "rack_force_n", "force_n", "torque_nm"),
}
"""Columns of a file that has a load, by what it acts on; the first that is there is read."""


@dataclass(frozen=True, kw_only=True)
class WheelLoadSpec(FromFile, PlacedLoad):
    """A load on a pair: on the driven wheel or rack, or the torque with which the driver turns.

    It is positive where it acts against the motion of the driven element, or drives the driver.
    It may be constant, a formula in the driver's angle phi1 or the driven angle phi2, rad, or in
    the driven speed omega2, rad/s, or rows that are joined by straight lines, also of a file, such
    as that of the study of a mechanism.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.WheelLoadSpec(torque=2000.0, start=1.0, end=2.0).at([0.5, 1.5], [0.0, 0.0])
    array([   0., 2000.])
    """

    _variables: ClassVar[Mapping[str, str]] = {
        "phi1": "phi1",
        "phi2": "the driven angle phi2",
        OF_SPEED: "the driven speed omega2",
    }

    on: str = param(
        TEXT, default="wheel2", choices=("wheel1", "wheel2"), doc="what is loaded: driver or driven"
    )
    torque: float | None = param(
        TORQUE, default=None, ge=-MOST, le=MOST, example=20, doc="constant torque"
    )
    force: float | None = param(
        FORCE, default=None, ge=-MOST, le=MOST, example=500, doc="constant force on a rack"
    )
    formula: str | None = param(
        TEXT,
        default=None,
        example="20 + 5*cos(phi1)",
        doc="torque, N m, or force on a rack, N, as a formula in the driver's angle phi1, rad, in "
        "the driven angle phi2, rad, or in the driven speed omega2, rad/s",
    )
    table: Row | None = param(
        default=None,
        ge=-MOST,
        le=MOST,
        min_length=2,
        example=[10, 25, 10],
        doc="torques, N m, or forces on a rack, N, at the places of `at`, with straight lines "
        "between",
    )
    place: Row | None = param(
        ANGLE,
        default=None,
        ge=0,
        le=_FARTHEST,
        min_length=2,
        word="at",
        example=[0, 180, 360],
        doc="driver angles of the table, from 0 over the turn, or the travel of an open pair",
    )
    file: str | None = param(
        TEXT,
        default=None,
        example="torque.csv",
        doc="CSV file of rows over phi1_deg: torque_nm, of a rack force_n; wheel2_torque_nm, "
        "wheel1_torque_nm or rack_force_n of a mechanism's torque.csv come first",
    )
    start: float | None = param(
        ANGLE,
        default=None,
        ge=0,
        le=_FARTHEST,
        word="from",
        example=90,
        doc="where the load begins",
    )
    end: float | None = param(
        ANGLE, default=None, ge=0, le=_FARTHEST, word="to", example=180, doc="where the load ends"
    )

    rules = (
        exactly_one("torque", "force", "formula", "table", "file"),
        needs("table", "place"),
        needs("place", "table"),
        needs("start", "end"),
        needs("end", "start"),
    )

    @property
    def column(self) -> str:
        """Name of the column of its file that has its values; empty without one that is read."""
        try:
            rows = self.rows
        except ColumnsError:
            return ""
        known = () if rows is None else (one for one in _COLUMNS[self.on] if rows.spelt(one))
        return next(iter(known), "")

    @property
    def slides(self) -> bool:
        """Whether it is a force."""
        return self.force is not None or self.column.endswith("_n")

    @cached_property
    def of_file(self) -> tuple[Array, Array, list[int]]:
        """Driver angles, rad, values, N m or N, and lines of its file; see `FromFile.rows`."""
        if self.rows is None:
            return np.empty(0), np.empty(0), []
        names = ("phi1_deg", self.column or _COLUMNS[self.on][-1])
        columns, lines = self.rows.columns(names)
        angles, values = columns.T
        return np.radians(angles), values, lines

    @property
    def ends(self) -> tuple[float, ...]:
        """First and last driver angle of its table or file, rad; empty without one."""
        places = self.of_file[0] if self.place is None else np.array(self.place)
        return (float(places[0]), float(places[-1])) if len(places) else ()

    @property
    def knots(self) -> tuple[float, ...]:
        """Where it jumps or bends, rad (see `PlacedLoad.knots`); of a file where it jumps."""
        angles = self.of_file[0]
        return (*super().knots, *angles[1:][np.diff(angles) == 0.0].tolist())

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        needed = f"a CSV file with columns phi1_deg and {_COLUMNS[self.on][-1]}"
        try:
            angles, _, lines = self.of_file
        except ColumnsError as error:
            yield "file", None, str(error), needed
            return
        back = np.flatnonzero(np.diff(angles) < 0.0)
        if back.size:
            yield "file", None, f"line {lines[back[0] + 1]}: phi1_deg falls", "rising angles"
        elif self.rows is not None and len(angles) < 2:
            yield "file", None, "has no two rows", needed
        elif len(angles) and angles[0] > 0.0:
            yield "file", None, f"line {lines[0]}: the rows begin inside the turn", "0 as the first"

    @property
    def of_speed(self) -> bool:
        """Whether it depends on the speed."""
        return self.formula is not None and self.read(self.formula)[0] == OF_SPEED

    def at(self, phi1: Any, phi2: Any, omega2: Any = None, *, per: float = _KILO) -> Array:
        """Return the load.

        Parameters
        ----------
        phi1, phi2 : (n,) array, rad
            Driver angles in the turn, or the travel, and driven angles.
        omega2 : (n,) array, optional
            Speeds of the driven wheel, rad/s; a load that depends on them needs them.
        per : float
            Unit of formula and table in those inside: 1 of N, 1000 of N m.

        Returns
        -------
        (n,) array, N mm or N
        """
        x = np.asarray(phi1, dtype=float)
        if self.file is not None:
            angles, values, _ = self.of_file
            return self._within(x, per * np.interp(x, angles, values))
        given = self.torque if self.force is None else self.force
        other = omega2 if self.of_speed else phi2
        return self._sizes(x, np.asarray(other, dtype=float), given, per)
