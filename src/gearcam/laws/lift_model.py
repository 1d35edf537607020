"""A lift of rises, returns and dwells with free boundaries and heights, fitted to rows.

The model is a ring of *moves*, rises and returns, each with a motion law, from a *start* to an
*end*, and from one level to the next. Between the end of a move and the start of the next lies a
dwell; where there is none they are *tied*, one boundary. The parameters are the boundaries, the
lowest level, the heights of the other levels above it, and of laws with one number that number.

Least squares by Gauss and Newton: the Jacobian is in closed form (that of a law's number by a
central difference), a step leaves every move at least a part of its width, and is halved until the
sum of squares falls.

Source: classical; Gauss-Newton with a line search.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache
from typing import Any, Final

import numpy as np

from gearcam.base.tolerances import Tolerances
from gearcam.laws.lift_rows import LiftRows
from gearcam.laws.motion.base import MotionFunction
from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.arrays import Array, Ints

_CELLS: Final = 1 << 16
"""Cells of the table of a law: S between two places is linear to 1e-9."""

SPAN: Final = (0.2, 0.8)
"""Shares of the lift that a move crosses at the same places whatever its law."""

_KEPT: Final = 0.3
"""Share of the width of a move or dwell that a step leaves at least."""

_NARROW: Final = 4.0
"""Width of a dwell, in steps of the rows, below which a step may close it."""

_ROUNDING: Final = 1e-12
"""Rounding of widths, rad: that of the dwell at a tied boundary is 0."""

_STEPS: Final = 40
_HALVINGS: Final = 12

_OFF: Final = 1e-4
"""Step of the difference by the number of a law."""

_FALL: Final = 1e-3
"""Fall of the sum of squares in a step, over the sum, at which steps end."""

Name = tuple[str, int]
"""A parameter: start, end, level or number, of a move; the lowest level is ``("low", 0)``."""


def number_of(law: Any) -> tuple[str, float, float] | None:
    """Return the name and the range of the only number of a law; None if it has none."""
    known = fields(law)
    if len(known) != 1:
        return None
    given = known[0].metadata["param"]
    return known[0].name, float(given.ge), float(given.le)


def _with_number(law: Any, number: float) -> Any:
    """Return a law with another number, or one at the end of its range."""
    name, least, most = number_of(law) or ("", 0.0, 0.0)
    return replace(law, **{name: min(max(number, least), most)})


@lru_cache(maxsize=256)
def _rise(law: Any) -> MotionFunction:
    return law.build(Tolerances())


@lru_cache(maxsize=64)
def _table(law: Any) -> tuple[Array, Array, Array]:
    """Return places, S and S' there."""
    places = np.linspace(0.0, 1.0, _CELLS + 1)
    value, slope = _rise(law).function.derivatives(places, 1)
    return places, value, slope


def share(law: Any, x: Array, *, falling: bool = False) -> tuple[Array, Array]:
    """Return the share of a move that is done, from 0 to 1, and its derivative.

    Parameters
    ----------
    law : object
        Parameters of a motion law.
    x : (n,) array
        Shares of the angle, from 0 to 1.
    falling : bool
        Whether it is a return.
    """
    rise = _rise(law)
    back = falling and rise.mirrored
    x = 1.0 - x if back else x
    if law == type(law)():
        places, value, slope = _table(law)
        done, rate = np.interp(x, places, value), np.interp(x, places, slope)
    else:  # a number that is being fitted
        done, rate = rise.function.derivatives(x, 1)
    return 1.0 - done if back else done, rate


@lru_cache(maxsize=256)
def crossed(law: Any, *, falling: bool) -> Array:
    """Return at which shares of the angle a law, up or `falling`, crosses those of `SPAN`."""
    x = np.linspace(0.0, 1.0, 513)
    return np.interp(SPAN, share(law, x, falling=falling)[0], x)


@dataclass(frozen=True, eq=False, kw_only=True)
class LiftModel:
    """A ring of moves (see the module docstring).

    Parameters
    ----------
    laws : tuple of k objects
        Parameters of motion laws.
    starts, ends : (k,) arrays, rad
        In order, within a turn from the first start, which may be below 0.
    levels : (k,) array, mm or rad
        Lift before each move.
    tied : tuple of k bool
        Whether no dwell follows a move.
    free : frozenset of int
        Moves of whose laws the number is fitted.
    fixed : frozenset of Name
        Parameters that are not fitted.
    ground : int or None
        The move whose level the others are above; by default the lowest.
    """

    laws: tuple[Any, ...]
    starts: Array
    ends: Array
    levels: Array
    tied: tuple[bool, ...]
    free: frozenset[int] = frozenset()
    fixed: frozenset[Name] = frozenset()
    ground: int | None = None

    @property
    def after(self) -> Array:
        """Lift after each move."""
        return np.roll(self.levels, -1)

    @cached_property
    def lowest(self) -> int:
        """The move before which the lift is lowest; of several the one that was chosen."""
        return int(np.argmin(self.levels)) if self.ground is None else self.ground

    def falling(self, k: int) -> bool:
        """Whether a move is a return."""
        return bool(self.levels[(k + 1) % len(self.levels)] < self.levels[k])

    @cached_property
    def gaps(self) -> tuple[Array, Array]:
        """The widths of moves and of the dwells after them, rad."""
        following = np.append(self.starts[1:], self.starts[0] + TURN)
        return self.ends - self.starts, following - self.ends

    @cached_property
    def parameters(self) -> dict[Name, list[Name]]:
        """What is fitted, and which starts, ends, levels and numbers change with it."""
        count = len(self.laws)
        moves = range(count)
        changed: dict[Name, list[Name]] = {}
        for k in moves:
            if not self.tied[k - 1]:
                changed["start", k] = [("start", k)]
            changed["end", k] = [("end", k)]
            if self.tied[k]:
                changed["end", k].append(("start", (k + 1) % count))
            if k != self.lowest:
                changed["level", k] = [("level", k)]
        changed["low", 0] = [("level", k) for k in moves]
        changed |= {("number", k): [("number", k)] for k in self.free}
        return {name: changed[name] for name in changed if name not in self.fixed}

    def value(self, name: Name) -> float:
        """Return the value of a parameter: rad, mm or rad, or a number."""
        kind, k = name
        low = float(self.levels[self.lowest])
        match kind:
            case "start" | "end":
                return float((self.starts if kind == "start" else self.ends)[k])
            case "low":
                return low
            case "level":
                return float(self.levels[k]) - low
            case _:
                return float(getattr(self.laws[k], fields(self.laws[k])[0].name))

    def moved(self, changes: Mapping[Name, float]) -> LiftModel:
        """Return the model with parameters changed by so much."""
        columns = {
            "start": self.starts.copy(),
            "end": self.ends.copy(),
            "level": self.levels.copy(),
        }
        laws, parts = list(self.laws), self.parameters
        for name, change in changes.items():
            for kind, k in parts[name]:
                if kind == "number":
                    laws[k] = _with_number(laws[k], self.value(name) + change)
                else:
                    columns[kind][k] += change
        starts, ends, levels = columns.values()
        return replace(self, laws=tuple(laws), starts=starts, ends=ends, levels=levels)

    def move_at(self, theta: Array) -> tuple[Ints, Array]:
        """Return for cam angles the move at them or before them, and the angle since its start."""
        x = (theta - self.starts[0]) % TURN
        move = np.searchsorted(self.starts - self.starts[0], x, side="right") - 1
        return move, x - (self.starts - self.starts[0])[move]

    def lift(self, theta: Array) -> Array:
        """Return the lift, mm or rad, at cam angles (n,), rad."""
        return self.slopes(theta)[0]

    def slopes(self, theta: Array) -> tuple[Array, dict[Name, Array]]:
        """Return the lift, and its derivatives by every start, end, level and number."""
        count, after, widths = len(self.laws), self.after, self.ends - self.starts
        move, since = self.move_at(theta)
        lift = after[move]
        slopes = {
            (kind, k): np.zeros(len(theta))
            for kind in ("start", "end", "level", "number")
            for k in range(count)
        }
        for k, law in enumerate(self.laws):
            following, rise = (k + 1) % count, after[k] - self.levels[k]
            slopes["level", following][move == k] = 1.0
            on = (move == k) & (since < widths[k])
            x = since[on] / widths[k]
            done, rate = share(law, x, falling=self.falling(k))
            lift[on] = self.levels[k] + rise * done
            slopes["start", k][on] = rise / widths[k] * rate * (x - 1.0)
            slopes["end", k][on] = -rise / widths[k] * rate * x
            slopes["level", k][on] += 1.0 - done
            slopes["level", following][on] = done
            if k in self.free:
                slopes["number", k][on] = rise * self._by_number(k, x)
        return lift, slopes

    def _by_number(self, k: int, x: Array) -> Array:
        """Return the derivative of a move's share by the number of its law, at shares of angle."""
        number = self.value(("number", k))
        laws = [_with_number(self.laws[k], number + off) for off in (-_OFF, _OFF)]
        below, above = (share(law, x, falling=self.falling(k))[0] for law in laws)
        low, high = (getattr(law, fields(law)[0].name) for law in laws)
        return (above - below) / (high - low)

    def missed(self, rows: LiftRows) -> tuple[Array, Array]:
        """Return by what rows are above it, (n,), and its derivatives by `parameters`, (n, p)."""
        lift, slopes = self.slopes(rows.theta)
        columns = [sum(slopes[one] for one in parts) for parts in self.parameters.values()]
        return rows.lift - lift, np.array(columns).reshape(-1, len(lift)).T

    def squares(self, rows: LiftRows) -> float:
        """Return the sum of squares of what it misses of rows."""
        return float(((rows.lift - self.lift(rows.theta)) ** 2).sum())

    def tie(self, k: int) -> LiftModel:
        """Return the model without the dwell after a move: its middle is the boundary."""
        starts, ends, following = self.starts.copy(), self.ends.copy(), (k + 1) % len(self.laws)
        half = 0.5 * float(self.gaps[1][k])
        ends[k] += half
        starts[following] -= half
        tied = tuple(one or number == k for number, one in enumerate(self.tied))
        return replace(self, starts=starts, ends=ends, tied=tied)

    def with_law(self, k: int, law: Any, *, free: bool = False) -> LiftModel:
        """Return the model with another law of a move, which crosses the same two lifts as before.

        At most half of a dwell is taken.

        Parameters
        ----------
        k : int
            The move.
        law : object
            Parameters of a motion law.
        free : bool
            Whether its number is fitted.
        """
        starts, ends, falling = self.starts.copy(), self.ends.copy(), self.falling(k)
        old, new = (crossed(one, falling=falling) for one in (self.laws[k], law))
        places = starts[k] + (ends[k] - starts[k]) * old
        width = np.ptp(places) / np.ptp(new)
        start, dwells = places[0] - width * new[0], self.gaps[1]
        if not self.tied[k - 1]:
            starts[k] = max(start, starts[k] - 0.5 * dwells[k - 1])
        if not self.tied[k]:
            ends[k] = min(start + width, ends[k] + 0.5 * dwells[k])
        laws = (*self.laws[:k], law, *self.laws[k + 1 :])
        numbers = self.free | {k} if free else self.free - {k}
        return replace(self, laws=laws, starts=starts, ends=ends, free=numbers)


def improved(model: LiftModel, rows: LiftRows, fall: float = _FALL) -> LiftModel:
    """Return the model with the least sum of squares of what it misses of rows.

    A narrow dwell that a step would close is left out.

    Parameters
    ----------
    model : LiftModel
        Where to begin.
    rows : LiftRows
        The rows.
    fall : float
        Fall of the sum of squares in a step, over the sum, at which steps end.

    Returns
    -------
    LiftModel
    """
    off, columns = model.missed(rows)
    for _ in range(_STEPS if columns.shape[1] else 0):
        step = np.linalg.lstsq(columns, off, rcond=1e-10)[0]
        changes = dict(zip(model.parameters, step.tolist(), strict=True))
        widths, dwells = model.gaps[1], model.moved(changes).gaps[1]
        closed = np.flatnonzero(
            (dwells <= 0.0) & (widths < _NARROW * rows.step) & ~np.array(model.tied)
        )
        if len(closed):
            model = model.tie(int(closed[np.argmin(widths[closed])]))
            off, columns = model.missed(rows)
            continue
        before = float(off @ off)
        least = _KEPT * np.array(model.gaps) - _ROUNDING
        for part in 0.5 ** np.arange(_HALVINGS):
            moved = model.moved({name: part * change for name, change in changes.items()})
            if np.all(np.array(moved.gaps) >= least):
                missed = moved.missed(rows)
                if missed[0] @ missed[0] <= before:
                    model, (off, columns) = moved, missed
                    break
        squares = float(off @ off)
        if before - squares <= fall * squares:
            break
    return model
