"""The lift program that rows come from: its phases, motion laws and sizes, as far as noise tells.

Each move is tried with every motion law that has no number to choose, and with those that have one.
For normal noise of variance v the sums of squares S_a, S_b of two laws differ by d^2 on average if
the first is the true one, where d is what the second misses of it, with the deviation
``2*d*sqrt(v)``. The true law then loses by ``S_a - S_b > T`` with a chance that is largest for
``d^2 = T``: that of ``sqrt(T/v)`` standard deviations. So laws whose sums differ by less than
``16*v``, four deviations, *cannot be distinguished*; of these the simplest is taken, then the one
that misses least. By the same rule dwells are left out, and moves of one direction are joined.

The variance is that of what the best model misses, or of the noise in the rows if that is larger,
times the number of neighbouring rows whose errors are alike (the sum of the autocorrelation). An
error that is known to be shared, that of a profile's chords, counts as alike over a twentieth of
the turn.

Sizes are rounded one after the other to the roundest number within two standard deviations, as long
as the sum of squares grows by less than ``9*v`` when the others have adapted themselves.

Source: derived anew; least squares as in `gearcam.laws.lift_model`.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import product
from typing import Any, Final

import numpy as np

from gearcam.laws.lift_model import LiftModel, LiftRows, Name, improved, misfit, number_of, place_of
from gearcam.laws.lift_phases import first_model, noise_of
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import (
    TURN,
    DwellPhase,
    Phase,
    ReturnPhase,
    RisePhase,
)
from gearcam.numeric.arrays import Array, Mask

_APART: Final = 16.0
"""Least difference of sums of squares, in variances, that tells two models apart."""

_ROUNDED: Final = 9.0
"""Largest growth of the sum of squares by rounding a size, in variances."""

_NEAR: Final = 2.0
"""Standard deviations within which sizes are rounded, and which their errors are."""

_SWEEPS: Final = 3

_ROUGH: Final = 1e-2
"""How well laws are fitted first: fall of the sum of squares in a step, over the sum."""

_TWICE: Final = 2.0
"""Sum of squares of laws that are fitted to the end, over the least one."""

_MORE: Final = 1.15
"""Mean square of what laws leave, over that of the noise, above which laws with numbers are tried
from the start."""

_INSET: Final = 0.08
"""Share of a move next to a boundary without a dwell that belongs to another move perhaps."""

_PAIRED: Final = 6
"""Laws that are tried in pairs: those that suit a move best."""


_EXPLAINED: Final = 4.0
"""Mean square of what laws leave, over that of the noise, from which on none of them explains the
rows, and pairs of them need not be compared."""

_SPAN: Final = (0.2, 0.8)
_LAG: Final = 20
"""Largest distance of rows, as a part of all, over which errors are correlated."""

_GRIDS: Final = (5.0, 1.0, 0.5, *(part * 10.0**-k for k in range(1, 8) for part in (1.0, 0.5)))
"""Roundest numbers first."""

_DIGITS: Final = 9

_LEAST: Final = math.radians(0.01)
"""Least angle of a phase."""

_EDGE: Final = 0.02
"""Share of a range next to its ends, where the law is another one."""


@dataclass(frozen=True, kw_only=True)
class AlikeLaw:
    """A law that a move may as well have.

    Parameters
    ----------
    law : object
        Its parameters.
    start, end : float, rad
        Where the move would be.
    """

    law: Any
    start: float
    end: float


@dataclass(frozen=True, eq=False, kw_only=True)
class FittedLift:
    """A lift program that was found in rows.

    Parameters
    ----------
    model : LiftModel
        With rounded sizes.
    rows : LiftRows
        The rows.
    variance : float
        Of the noise, times the number of rows whose errors are alike, mm2 or rad2.
    alike : tuple of k tuples of AlikeLaw
        Other laws that cannot be distinguished from that of each move.
    deviations : mapping of Name to float
        Standard deviations of the parameters before rounding, rad, mm or rad, or a number.
    """

    model: LiftModel
    rows: LiftRows
    variance: float
    alike: tuple[tuple[AlikeLaw, ...], ...]
    deviations: dict[Name, float]

    @cached_property
    def lift(self) -> Array:
        """The lift of the program at the rows, mm or rad."""
        return self.model.lift(self.rows.theta)

    @cached_property
    def missed(self) -> Array:
        """The rows less the lift of the program, mm or rad."""
        return self.rows.lift - self.lift

    def on(self, k: int) -> Mask:
        """Return whether each row is on a move."""
        move, over = self.model.move_at(self.rows.theta)
        return (move == k) & ~over

    def error(self, name: Name) -> float:
        """Return the error of a boundary, rad: two deviations, and what other laws make of it."""
        kind, k = name
        if name not in self.deviations:  # tied: the end of the move before
            return self.error(("end", k - 1 if k else len(self.model.laws) - 1))
        own = self.model.value(name)
        other = (getattr(one, kind) for one in self.alike[k]) if kind in ("start", "end") else ()
        return _NEAR * self.deviations[name] + max((abs(one - own) for one in other), default=0.0)

    @cached_property
    def begin(self) -> tuple[int, float]:
        """The move with which the program begins, and the row angle of its angle 0, rad.

        That is 0 if the lift is lowest there.
        """
        model = self.model
        first, low = model.lowest, float(model.levels[model.lowest])
        near = low + 1e-9 * float(np.ptp(model.levels))
        lowest = [k for k in range(len(model.laws)) if model.levels[k] <= near]
        for k in lowest:
            dwell = model.ends[k - 1] - (TURN if k == 0 else 0.0)
            turns = TURN * math.ceil((dwell - _tiny(self)) / TURN)
            if dwell - _tiny(self) <= turns <= model.starts[k] + _tiny(self):
                # a dwell that a design cannot have is left out
                short = float(model.starts[k]) - turns < _LEAST
                return k, float(model.starts[k]) if short else turns
        return first, float(model.starts[first])

    def phases(self) -> tuple[Phase, ...]:
        """Return the phases of a design, from zero lift on."""
        model, (first, zero) = self.model, self.begin
        count = len(model.laws)
        found: list[Phase] = list(_dwell(float(model.starts[first]) - zero))
        for number in range(count):
            k = (first + number) % count
            width, dwell = (float(gaps[k]) for gaps in model.gaps())
            rise, last = float(model.after[k] - model.levels[k]), number == count - 1
            make = ReturnPhase if rise < 0.0 else RisePhase
            lift = None if last else _plain(abs(rise))
            found.append(make(angle=_angle(width), law=model.laws[k], lift=lift))
            if last:
                dwell -= float(model.starts[first]) - zero
            found += _dwell(dwell)
        return (*found[:-1], replace(found[-1], angle="rest"))


def _tiny(fitted: FittedLift) -> float:
    return 1e-9 * fitted.rows.step


def _dwell(width: float) -> Iterator[Phase]:
    if width >= _LEAST:
        yield DwellPhase(angle=_angle(width))


def _angle(width: float) -> float:
    return math.radians(round(math.degrees(width), _DIGITS))


def _plain(lift: float) -> float:
    return float(f"{lift:.12g}")


def fit_lift(theta: Array, lift: Array, unit: tuple[float, str], error: float = 0.0) -> FittedLift:
    """Return the lift program that rows come from.

    Parameters
    ----------
    theta : (n,) array, rad
        Cam angles, rising, within a turn, all around.
    lift : (n,) array, mm or rad
        Lifts.
    unit : (float, str)
        Factor from lifts to their unit in output, and that unit.
    error : float, mm or rad
        Error of the lifts that neighbouring rows share, so that it is not seen in the rows.

    Returns
    -------
    FittedLift

    Raises
    ------
    InfeasibleError
        If no phases can be found (see `gearcam.laws.lift_phases.first_model`).
    """
    noise = math.hypot(noise_of(theta, lift, 1.0 if error else unit[0]), error)
    rows = LiftRows(theta=theta, lift=lift, noise=noise, error=error)
    model = _chosen(first_model(rows, unit), rows)
    simple = _untied(_simplified(model, rows), rows)
    if len(simple.laws) != len(model.laws) or simple.tied != model.tied:
        model = _chosen(simple, rows)
    model, tried = _settled(model, rows)
    good = model.squares(rows) <= _EXPLAINED * len(theta) * rows.noise**2
    for k in (k for k, tied in enumerate(model.tied) if tied and good):
        pairs = [improved(one, rows) for one in _in_pairs(model, model, k, rows)]
        for one in (k, (k + 1) % len(model.laws)):
            tried[one] += pairs
    variance = variance_of(model, rows)
    most = model.squares(rows) + _APART * variance
    alike = tuple(
        tuple(_alike([one for one in row if one.squares(rows) <= most], model, k, rows))
        for k, row in enumerate(tried)
    )
    deviations = _deviations(model, variance, rows)
    return FittedLift(
        model=_rounded(model, rows, variance, unit[0]),
        rows=rows,
        variance=variance,
        alike=alike,
        deviations=deviations,
    )


# --- laws --------------------------------------------------------------------------------------


def _candidates(*, numbers: bool) -> Iterator[tuple[Any, bool]]:
    """Yield the laws without numbers to choose, and those with one: at its default, then free."""
    for entry in MOTION_LAWS.values():
        law, known = entry.parameters, fields(entry.parameters)
        if not known:
            yield law(), False
        elif len(known) == 1 and isinstance(known[0].default, float):
            yield law(), False
            if numbers:
                yield law(), True


def _with(model: LiftModel, k: int, law: Any, *, free: bool) -> LiftModel:
    """Return the model with another law of a move, which crosses the same two lifts as before."""
    start, width = float(model.starts[k]), float(model.ends[k] - model.starts[k])
    starts, ends, falling = model.starts.copy(), model.ends.copy(), model.falling(k)
    old, new = (
        [place_of(one, part, falling=falling) for part in _SPAN] for one in (model.laws[k], law)
    )
    places = [start + width * one for one in old]
    width = (places[1] - places[0]) / (new[1] - new[0])
    start = places[0] - width * new[0]
    dwells = model.gaps()[1]
    if not model.tied[k - 1]:
        starts[k] = max(start, float(starts[k] - 0.5 * dwells[k - 1]))
    if not model.tied[k]:
        ends[k] = min(start + width, float(ends[k] + 0.5 * dwells[k]))
    laws = tuple(law if number == k else one for number, one in enumerate(model.laws))
    numbers = model.free | {k} if free else model.free - {k}
    return replace(model, laws=laws, starts=starts, ends=ends, free=numbers)


def _tried(model: LiftModel, k: int, rows: LiftRows, *, numbers: bool) -> list[LiftModel]:
    """Return the model with every law of a move, fitted, and roughly those that are far off."""
    found = []
    for law, free in _candidates(numbers=numbers):
        one = improved(_with(model, k, law, free=free), rows, _ROUGH)
        if not (free and _at_end(one.laws[k])):
            found.append(one)
    squares = [one.squares(rows) for one in found]
    near = _TWICE * min(squares)
    return [
        improved(one, rows) if value <= near else one
        for one, value in zip(found, squares, strict=True)
    ]


def _at_end(law: Any) -> bool:
    """Whether the number of a law is at the end of its range: it is then another law."""
    name, low, high = number_of(law) or ("", 0.0, 0.0)
    edge = _EDGE * (high - low)
    return not low + edge < getattr(law, name) < high - edge


def _simplest(models: Sequence[LiftModel], k: int, rows: LiftRows, variance: float) -> LiftModel:
    """Return the simplest model that cannot be distinguished from the best; of such the best."""
    squares = [one.squares(rows) for one in models]
    least = min(squares)
    good = [
        (k in one.free, value, number)
        for number, (one, value) in enumerate(zip(models, squares, strict=True))
        if value <= least + _APART * variance
    ]
    return models[min(good)[2]]


def _best(models: Iterable[LiftModel], rows: LiftRows) -> LiftModel:
    """Return the model that misses least of rows."""
    return min(models, key=lambda one: one.squares(rows))


def _chosen(model: LiftModel, rows: LiftRows) -> LiftModel:
    """Return the model with the best laws.

    Laws are tried move by move beside the others, from one law in all moves, as in most cams, or
    from the laws that suit each move alone. Moves without a dwell between them are tried in pairs
    too. Laws with free numbers are tried if more than noise is left.
    """
    laws = [law for law, _ in _candidates(numbers=False)]
    every = [_every(model, [law] * len(model.laws)) for law in laws]
    every.append(_every(model, [_alone(model, k, rows, laws)[0] for k in range(len(model.laws))]))
    found = _best((improved(one, rows, _ROUGH) for one in every), rows)
    found = _by_moves(model, found, rows, numbers=False)
    for k, tied in enumerate(found.tied):
        if tied:
            found = _best([found, *_in_pairs(model, found, k, rows)], rows)
    if found.squares(rows) > _MORE * len(rows.theta) * rows.noise**2:
        found = _by_moves(model, found, rows, numbers=True)
    return improved(found, rows)


def _by_moves(model: LiftModel, found: LiftModel, rows: LiftRows, *, numbers: bool) -> LiftModel:
    """Return a model with the best law of each move beside the others.

    Every trial begins with the boundaries of the first model, which are those that rows show:
    beside a wrong law another one may close a dwell.
    """
    for _ in range(_SWEEPS):
        before = found
        for k in range(len(model.laws)):
            start = _every(model, found.laws, found.free)
            found = _best([found, *_tried(start, k, rows, numbers=numbers)], rows)
        if all(_same(found, before, k) for k in range(len(model.laws))):
            break
    return found


def _in_pairs(model: LiftModel, found: LiftModel, k: int, rows: LiftRows) -> list[LiftModel]:
    """Return the model with the laws that suit a move and the next best, in all pairs."""
    laws = [law for law, _ in _candidates(numbers=False)]
    following = (k + 1) % len(found.laws)
    both = [_alone(model, one, rows, laws)[:_PAIRED] for one in (k, following)]
    every = ({k: one, following: other} for one, other in product(*both))
    free = found.free - {k, following}
    return [
        improved(
            _every(model, [pair.get(n, law) for n, law in enumerate(found.laws)], free),
            rows,
            _ROUGH,
        )
        for pair in every
    ]


def _alone(model: LiftModel, k: int, rows: LiftRows, laws: Iterable[Any]) -> list[Any]:
    """Return laws in the order of what they miss of a move, without what is beside it."""
    start, end = float(model.starts[k]), float(model.ends[k])
    before, after = (float(model.gaps()[1][one]) for one in (k - 1, k))
    inset = _INSET * (end - start)
    low = start + (inset if model.tied[k - 1] else -0.5 * before)
    high = end - (inset if model.tied[k] else -0.5 * after)
    x = low + (rows.theta - low) % TURN
    inside = np.flatnonzero(x <= high)
    inside = inside[np.argsort(x[inside])]
    theta, lift = x[inside], rows.lift[inside]
    return sorted(laws, key=lambda law: misfit(law, theta, lift, start, end))


def _every(model: LiftModel, laws: Sequence[Any], free: Collection[int] = ()) -> LiftModel:
    """Return the model with other laws in all moves."""
    for k, law in enumerate(laws):
        model = _with(model, k, law, free=k in free)
    return model


def _settled(model: LiftModel, rows: LiftRows) -> tuple[LiftModel, list[list[LiftModel]]]:
    """Return the model with the simplest laws, and for each move the models with every law."""
    tried = []
    for _ in range(_SWEEPS):
        before, tried = model, []
        for k in range(len(model.laws)):
            tried.append(_tried(model, k, rows, numbers=True))
            best = min(tried[k], key=lambda one: one.squares(rows))
            model = _simplest(tried[k], k, rows, variance_of(best, rows))
        if all(_same(before, model, k) for k in range(len(model.laws))):
            break
    return model, tried


def _same(one: LiftModel, model: LiftModel, k: int) -> bool:
    """Whether two models have a law of one name in a move."""
    return type(one.laws[k]) is type(model.laws[k]) and (k in one.free) == (k in model.free)


def _alike(
    models: Sequence[LiftModel], model: LiftModel, k: int, rows: LiftRows
) -> Iterator[AlikeLaw]:
    """Yield other laws of a move in the order of what they miss, each name once."""
    seen = {type(model.laws[k])}
    for one in sorted(models, key=lambda one: (k in one.free, one.squares(rows))):
        law = one.laws[k]
        if type(law) not in seen:
            seen.add(type(law))
            yield AlikeLaw(law=law, start=float(one.starts[k]), end=float(one.ends[k]))


# --- noise -------------------------------------------------------------------------------------


def variance_of(model: LiftModel, rows: LiftRows) -> float:
    """Return the variance of the noise, times the number of rows whose errors are alike.

    Parameters
    ----------
    model : LiftModel
        The best one.
    rows : LiftRows
        The rows.

    Returns
    -------
    float, mm2 or rad2
    """
    off, count = rows.lift - model.lift(rows.theta), len(rows.theta)
    left = max(1, count - len(list(model.names())))
    square = float((off**2).sum())
    alike = 1.0
    for lag in range(1, count // _LAG):
        together = float((off * np.roll(off, lag)).sum()) / square if square else 0.0
        if together <= 2.0 / math.sqrt(count):
            break
        alike += 2.0 * together
    return max(rows.noise**2, square / left) * alike + rows.error**2 * count / _LAG


# --- structure ---------------------------------------------------------------------------------


def _simplified(model: LiftModel, rows: LiftRows) -> LiftModel:
    """Return the model without dwells, and with moves joined, that noise does not show."""
    allowed = _APART * rows.noise**2  # what a wrong model leaves is no noise
    found = True
    while found:
        found = False
        for one in _simpler(model, rows):
            if one.squares(rows) <= model.squares(rows) + allowed:
                model, found = one, True
                break
    return model


def _simpler(model: LiftModel, rows: LiftRows) -> Iterator[LiftModel]:
    """Yield models with a dwell less, narrow ones first, or a move less."""
    dwells = model.gaps()[1]
    for k in np.argsort(dwells).tolist():
        following = (k + 1) % len(model.laws)
        if not model.tied[k]:
            yield improved(model.tie(k), rows)
        elif len(model.laws) > 2 and model.falling(k) == model.falling(following):
            joined = _joined(model, k)
            number = min(k, len(joined.laws) - 1)
            yield min(
                _tried(joined, number, rows, numbers=False), key=lambda one: one.squares(rows)
            )


def _joined(model: LiftModel, k: int) -> LiftModel:
    """Return the model with a move and the next as one."""
    count = len(model.laws)
    if k == count - 1:  # over the end of the turn: the first comes last
        first = [np.append(one[1:], one[0] + TURN) for one in (model.starts, model.ends)]
        model = replace(
            model,
            laws=(*model.laws[1:], model.laws[0]),
            starts=first[0],
            ends=first[1],
            levels=np.roll(model.levels, -1),
            tied=(*model.tied[1:], model.tied[0]),
        )
        k -= 1
    keep = [number for number in range(count) if number != k + 1]
    return replace(
        model,
        laws=tuple(model.laws[number] for number in keep),
        starts=model.starts[keep],
        ends=np.delete(model.ends, k),
        levels=model.levels[keep],
        tied=tuple(one for number, one in enumerate(model.tied) if number != k),
        free=frozenset(),
    )


def _untied(model: LiftModel, rows: LiftRows) -> LiftModel:
    """Return the model with dwells where rows show that there is one."""
    for k in range(len(model.laws)):
        if model.tied[k]:
            ends, starts = model.ends.copy(), model.starts.copy()
            ends[k] -= rows.step
            starts[(k + 1) % len(starts)] += rows.step
            tied = tuple(one and number != k for number, one in enumerate(model.tied))
            one = improved(replace(model, starts=starts, ends=ends, tied=tied), rows)
            if one.squares(rows) < model.squares(rows) - _APART * variance_of(one, rows):
                model = one
    return model


# --- sizes -------------------------------------------------------------------------------------


def _deviations(model: LiftModel, variance: float, rows: LiftRows) -> dict[Name, float]:
    """Return the standard deviations of the parameters that are fitted."""
    _, columns = model.jacobian(rows.theta)
    inverse = np.linalg.pinv(columns.T @ columns, rcond=1e-14, hermitian=True)
    sizes = np.sqrt(np.maximum(np.diag(inverse), 0.0) * variance)
    return dict(zip(model.names(), sizes.tolist(), strict=True))


def _rounded(model: LiftModel, rows: LiftRows, variance: float, scale: float) -> LiftModel:
    """Return the model with all sizes rounded (see the module docstring)."""
    places = ("start", "end")
    names = sorted(model.names(), key=lambda one: (one[0] not in places, one[1], one[0] == "end"))
    model = replace(model, ground=model.lowest)  # another level may be rounded to the same
    for name in names:
        deviation = _deviations(model, variance, rows).get(name)
        if deviation is None:  # its dwell was closed
            continue
        squares, one = model.squares(rows), model
        for target in _round_values(model, name, deviation, scale):
            moved = model.moved({name: target - model.value(name)})
            one = improved(replace(moved, fixed=model.fixed | {name}), rows)
            if one.squares(rows) <= squares + _ROUNDED * variance:
                break
        model = one
    return model


def _round_values(model: LiftModel, name: Name, deviation: float, scale: float) -> Iterator[float]:
    """Yield values of a parameter, the roundest first; of a boundary the width that ends there."""
    kind, k = name
    value, unit, base = model.value(name), 1.0, 0.0
    if kind in ("start", "end"):
        unit = math.degrees(1.0)
        if kind == "end":
            base = float(model.starts[k])
        elif k:
            base = float(model.ends[k - 1])
    elif kind in ("low", "level"):
        unit = scale
    size, near = unit * (value - base), _NEAR * deviation * unit
    for grid in _GRIDS:
        target = float(f"{grid * round(size / grid):.12g}")
        if abs(target - size) <= near:
            yield base + target / unit
    yield base + round(size, _DIGITS) / unit
