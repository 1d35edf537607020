"""A lift of rises, returns and dwells with free boundaries and heights, fitted to rows.

The model is a ring of *moves*, rises and returns, each with a motion law, from a *start* to an
*end*, and from one level to the next. Between the end of a move and the start of the next lies a
dwell; where there is none they are *tied*, one boundary. The parameters are the boundaries, the
lowest level, the heights of the other levels above it, and of laws with one number that number.

Least squares by Gauss and Newton: the Jacobian is in closed form (that of a law's number by a
central difference), a step leaves every move at least a part of its width, and is halved until the
sum of squares falls. Laws are interpolated by cubics from a fine table, to 1e-10 of the lift.

Source: classical; Gauss-Newton with a line search.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache
from typing import Any, Final

import numpy as np

from gearcam.base.tolerances import Tolerances
from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.arrays import Array, Ints, Mask

_CELLS: Final = 512
"""Cells of the table of a law: the error of cubics is below 1e-10."""

_KEPT: Final = 0.3
"""Share of the width of a move that a step leaves at least."""

_NARROW: Final = 4.0
"""Width of a dwell, in steps of the rows, below which a step may close it."""

_ROUNDING: Final = 1e-12
"""Rounding of widths, rad: that of the dwell at a tied boundary is 0."""

_STEPS: Final = 40
_FEW: Final = 12
_HALVINGS: Final = 12

_OFF: Final = 1e-4
"""Step of the difference by the number of a law."""

_RELATIVE: Final = 1e-5
"""The same over the sum of squares: what is left of a wrong law need not be found to the end."""

_IMPROVED: Final = 1e-3
"""Fall of the sum of squares, over the variance of the noise, at which steps end."""

Name = tuple[str, int]
"""A parameter: start, end, level or number, of a move; the lowest level is ``("low", 0)``."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LiftRows:
    """A lift in rows.

    Parameters
    ----------
    theta : (n,) array, rad
        Cam angles, rising, within a turn.
    lift : (n,) array, mm or rad
        Lifts.
    noise : float, mm or rad
        Standard deviation of their noise, above 0.
    error : float, mm or rad
        The part of it that neighbouring rows share.
    """

    theta: Array
    lift: Array
    noise: float
    error: float = 0.0

    @cached_property
    def step(self) -> float:
        """Mean step of the angle, rad."""
        return TURN / len(self.theta)


def number_of(law: Any) -> tuple[str, float, float] | None:
    """Return the name and the range of the only number of a law; None if it has none."""
    known = fields(law)
    if len(known) != 1:
        return None
    given = known[0].metadata["param"]
    return known[0].name, float(given.ge), float(given.le)


@lru_cache(maxsize=256)
def _table(law: Any) -> tuple[Array, Array, Array, bool]:
    """Return places, S and S' of a law there, and whether its return is the rise run backwards."""
    rise = law.build(Tolerances())
    places = np.union1d(np.linspace(0.0, 1.0, _CELLS + 1), rise.function.knots)
    value, slope = rise.function.derivatives(places, 1)
    slope[-1] = rise.function.side(len(rise.function.pieces), -1, 1)[1]  # from within
    return places, value, slope, rise.mirrored


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
    places, value, slope, mirrored = _table(law)
    if mirrored and falling:
        back, rate = share(law, 1.0 - x)
        return 1.0 - back, rate
    cell = np.searchsorted(places[1:-1], x, side="right")
    width = places[cell + 1] - places[cell]
    t = (x - places[cell]) / width
    low, rise = value[cell], value[cell + 1] - value[cell]
    first, last = width * slope[cell] - rise, rise - width * slope[cell + 1]
    bend = t * (1.0 - t)
    inside = first * (1.0 - t) + last * t
    done = low + rise * t + bend * inside
    rate = (rise + (1.0 - 2.0 * t) * inside + bend * (last - first)) / width
    return done, rate


def exact_share(law: Any, x: Array, *, falling: bool) -> Array:
    """Return the share of a move that a `law` has done at `x`, up or `falling`, without a table."""
    rise = law.build(Tolerances())
    if falling and rise.mirrored:
        return 1.0 - rise.function(1.0 - x)
    return rise.function(x)


def place_of(law: Any, done: float, *, falling: bool) -> float:
    """Return at what share of the angle a `law` has `done` a share of a move, up or `falling`."""
    places = _table(law)[0]
    values = share(law, places, falling=falling)[0]
    return float(np.interp(done, np.maximum.accumulate(values), places))


def misfit(law: Any, theta: Array, lift: Array, start: float, end: float) -> float:
    """Return the least sum of squares of what a law misses of the rows of one move.

    Both ends and both levels are free, so that nothing beside the move counts.

    Parameters
    ----------
    law : object
        Parameters of a motion law.
    theta : (n,) array, rad
        Rising cam angles; beyond the ends the lift is constant.
    lift : (n,) array, mm or rad
        Lifts.
    start, end : float, rad
        Where to begin; the law crosses the same lifts as 3-4-5 would.
    """
    falling, squares = bool(lift[-1] < lift[0]), np.inf
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    for _ in range(_STEPS):
        at = (theta - (middle - half)) / (2.0 * half)
        done, rate = share(law, np.clip(at, 0.0, 1.0), falling=falling)
        rate = np.where((at > 0.0) & (at < 1.0), rate, 0.0)
        linear = np.column_stack([np.ones(len(theta)), done])
        base, rise = np.linalg.lstsq(linear, lift, rcond=None)[0]
        off, before = lift - base - rise * done, squares
        squares = min(squares, float(off @ off))
        if not before - squares > 1e-2 * squares:
            break
        slopes = rise * rate / (2.0 * half)
        columns = np.column_stack([linear, -slopes, -slopes * (2.0 * at - 1.0)])
        *_, shift, wider = np.linalg.lstsq(columns, off, rcond=1e-10)[0]
        middle += min(max(shift, -0.3 * half), 0.3 * half)
        half += min(max(wider, -0.3 * half), 0.3 * half)
    return squares


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
    fixed : frozenset of Name
        Parameters that are not fitted.
    ground : int or None
        The move whose level the others are above; by default the lowest.
    free : frozenset of int
        Moves of whose laws the number is fitted.
    """

    laws: tuple[Any, ...]
    starts: Array
    ends: Array
    levels: Array
    tied: tuple[bool, ...]
    fixed: frozenset[Name] = frozenset()
    ground: int | None = None
    free: frozenset[int] = frozenset()

    @property
    def after(self) -> Array:
        """Lift after each move."""
        return np.roll(self.levels, -1)

    @property
    def following(self) -> Array:
        """Start of the move after each, rad."""
        return np.append(self.starts[1:], self.starts[0] + TURN)

    @property
    def lowest(self) -> int:
        """The move before which the lift is lowest; of several the one that was chosen."""
        return int(np.argmin(self.levels)) if self.ground is None else self.ground

    def names(self) -> Iterator[Name]:
        """Yield the parameters that are fitted."""
        count = range(len(self.laws))
        every: list[Name] = [("start", k) for k in count if not self.tied[k - 1]]
        every += [("end", k) for k in count]
        every += [("low", 0), *(("level", k) for k in count if k != self.lowest)]
        every += [("number", k) for k in sorted(self.free)]
        yield from (name for name in every if name not in self.fixed)

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

    def moved(self, changes: dict[Name, float]) -> LiftModel:
        """Return the model with parameters changed by so much."""
        starts, ends, levels = self.starts.copy(), self.ends.copy(), self.levels.copy()
        laws, count = list(self.laws), len(self.laws)
        for (kind, k), change in changes.items():
            if kind == "start":
                starts[k] += change
            elif kind == "end":
                ends[k] += change
                starts[(k + 1) % count] += change if self.tied[k] else 0.0
            elif kind == "low":
                levels += change
            elif kind == "level":
                levels[k] += change
            else:
                name, least, most = number_of(laws[k]) or ("", 0.0, 0.0)
                number = min(max(getattr(laws[k], name) + change, least), most)
                laws[k] = replace(laws[k], **{name: number})
        return replace(self, laws=tuple(laws), starts=starts, ends=ends, levels=levels)

    def falling(self, k: int) -> bool:
        """Whether a move is a return."""
        return bool(self.levels[(k + 1) % len(self.levels)] < self.levels[k])

    def move_at(self, theta: Array) -> tuple[Ints, Mask]:
        """Return for cam angles the move at them or before them, and whether it is over."""
        x = self.starts[0] + (theta - self.starts[0]) % TURN
        move = np.searchsorted(self.starts, x, side="right") - 1
        return move, x >= self.ends[move]

    def _shares(self, theta: Array) -> Iterator[tuple[int, Mask, Mask, Array, Array]]:
        """Yield of each move its number, the rows on it and after it, and shares of angle and lift.

        The derivative of the share of the lift comes last.
        """
        move, over = self.move_at(theta)
        x = self.starts[0] + (theta - self.starts[0]) % TURN
        widths = self.ends - self.starts
        for k, law in enumerate(self.laws):
            here = move == k
            on = here & ~over
            at = (x[on] - self.starts[k]) / widths[k]
            done, rate = share(law, at, falling=self.falling(k))
            yield k, on, here & over, at, np.array([done, rate])

    def lift(self, theta: Array) -> Array:
        """Return the lift, mm or rad, at cam angles (n,), rad."""
        lift, after = np.empty(len(theta)), self.after
        for k, on, over, _, (done, _) in self._shares(theta):
            lift[on] = self.levels[k] + (after[k] - self.levels[k]) * done
            lift[over] = after[k]
        return lift

    def _slopes(self, theta: Array) -> tuple[Array, dict[Name, Array]]:
        """Return the lift, and its derivatives by every start, end, level and number."""
        count = len(self.laws)
        lift, after, widths = np.empty(len(theta)), self.after, self.ends - self.starts
        kinds = ("start", "end", "level", "number")
        slopes = {(kind, k): np.zeros(len(theta)) for kind in kinds for k in range(count)}
        for k, on, over, at, (done, rate) in self._shares(theta):
            rise, following = after[k] - self.levels[k], (k + 1) % count
            lift[on], lift[over] = self.levels[k] + rise * done, after[k]
            slopes["start", k][on] = rise / widths[k] * rate * (at - 1.0)
            slopes["end", k][on] = -rise / widths[k] * rate * at
            slopes["level", k][on] += 1.0 - done
            slopes["level", following][on] += done
            slopes["level", following][over] += 1.0
            if k in self.free:
                slopes["number", k][on] = rise * self._by_number(k, at)
        return lift, slopes

    def _by_number(self, k: int, at: Array) -> Array:
        """Return the derivative of a move's share by the number of its law, at shares of angle."""
        name, least, most = number_of(self.laws[k]) or ("", 0.0, 0.0)
        number, falling = getattr(self.laws[k], name), self.falling(k)
        low, high = max(number - _OFF, least), min(number + _OFF, most)
        laws = (replace(self.laws[k], **{name: one}) for one in (low, high))
        below, above = (exact_share(law, at, falling=falling) for law in laws)
        return (above - below) / (high - low)

    def jacobian(self, theta: Array) -> tuple[Array, Array]:
        """Return the lift (n,) and its derivatives (n, p) by the parameters of `names`."""
        lift, slopes = self._slopes(theta)
        columns = []
        for kind, k in self.names():
            column = np.ones(len(theta)) if kind == "low" else slopes[kind, k]
            if kind == "end" and self.tied[k]:
                column = column + slopes["start", (k + 1) % len(self.laws)]
            columns.append(column)
        return lift, np.array(columns).reshape(-1, len(theta)).T

    def squares(self, rows: LiftRows) -> float:
        """Return the sum of squares of what it misses of rows."""
        return float(((self.lift(rows.theta) - rows.lift) ** 2).sum())

    def gaps(self) -> tuple[Array, Array]:
        """Return the widths of moves and of the dwells after them, rad."""
        return self.ends - self.starts, self.following - self.ends

    def tie(self, k: int) -> LiftModel:
        """Return the model without the dwell after a move: its middle is the boundary."""
        middle = 0.5 * (float(self.ends[k]) + float(self.following[k]))
        starts, ends, following = self.starts.copy(), self.ends.copy(), (k + 1) % len(self.laws)
        ends[k] = middle
        starts[following] = middle - (TURN if following == 0 else 0.0)
        tied = tuple(one or number == k for number, one in enumerate(self.tied))
        return replace(self, starts=starts, ends=ends, tied=tied)


def improved(model: LiftModel, rows: LiftRows, rough: float = 0.0) -> LiftModel:
    """Return the model with the least sum of squares of what it misses of rows.

    A dwell that the steps would make narrower than nothing is left out.

    Parameters
    ----------
    model : LiftModel
        Where to begin.
    rows : LiftRows
        The rows.
    rough : float
        Fall of the sum of squares in a step, over the sum, at which steps end at the latest.

    Returns
    -------
    LiftModel
    """
    squares = model.squares(rows)
    for _ in range(_FEW if rough else _STEPS):
        lift, columns = model.jacobian(rows.theta)
        if not columns.shape[1]:
            break
        step = np.linalg.lstsq(columns, rows.lift - lift, rcond=1e-10)[0]
        changes = dict(zip(model.names(), step.tolist(), strict=True))
        lost = _lost_dwell(model, changes, rows)
        if lost is not None:
            model = model.tie(lost)
            squares = model.squares(rows)
            continue
        before = squares
        model, squares = _shortened(model, changes, squares, rows)
        if before - squares <= max(_IMPROVED * rows.noise**2, max(rough, _RELATIVE) * squares):
            break
    return model


def _lost_dwell(model: LiftModel, changes: dict[Name, float], rows: LiftRows) -> int | None:
    """Return the narrow dwell that a step closes, None if there is none."""
    widths, dwells = model.gaps()[1], model.moved(changes).gaps()[1]
    narrow = _NARROW * rows.step
    closed = [
        k
        for k, tied in enumerate(model.tied)
        if not tied and dwells[k] <= 0.0 and widths[k] < narrow
    ]
    return min(closed, key=lambda k: float(widths[k]), default=None)


def _shortened(
    model: LiftModel, changes: dict[Name, float], squares: float, rows: LiftRows
) -> tuple[LiftModel, float]:
    """Return the model after as much of a step as keeps widths positive and squares falling."""
    least, part = _KEPT * np.array(model.gaps()), 1.0
    for _ in range(_HALVINGS):
        moved = model.moved({name: part * change for name, change in changes.items()})
        if np.all(np.array(moved.gaps()) >= least - _ROUNDING):
            found = moved.squares(rows)
            if found <= squares:
                return moved, found
        part *= 0.5
    return model, squares
