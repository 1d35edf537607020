"""The lift program that rows come from: its phases, motion laws and sizes, as far as noise tells.

Each move is tried with every motion law that has no number to choose, and with those that have one.
For normal noise of variance v the sums of squares S_a, S_b of two laws differ by d^2 on average if
the first is the true one, where d is what the second misses of it, with the deviation
``2*d*sqrt(v)``. The true law then loses by ``S_a - S_b > T`` with a chance that is largest for
``d^2 = T``: that of ``sqrt(T/v)`` standard deviations. So laws whose sums differ by less than
``16*v``, four deviations, *cannot be distinguished*. Of these one without a number to choose is
taken, one without a dwell by the same rule, and of such the one with the *shortest description*:
the sum of squares over v is twice the length of the errors in natural units, to within a constant,
and the name of one of n laws has the length ``ln(n)``. A law is named once, for all its moves.

The variance is that of what the best model misses, or of the noise in the rows if that is larger,
times the number of neighbouring rows whose errors are alike (the sum of the autocorrelation). An
error that is known to be shared, that of a profile's chords, counts as alike over a twentieth of
the turn.

Sizes are rounded one after the other to the roundest number within two standard deviations, as long
as the sum of squares grows by less than ``9*v`` when the others have adapted themselves.

Source: Rissanen, Modeling by shortest data description, Automatica 14 (1978), for the choice among
laws; the rest derived anew; least squares as in `gearcam.laws.lift_model`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache, cached_property
from itertools import product
from typing import Any, Final, NamedTuple

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.laws.lift_model import SPAN, LiftModel, Name, crossed, improved, number_of
from gearcam.laws.lift_rows import LAG, LiftRows, noise_of, runs_of
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import TURN, DwellPhase, Phase, ReturnPhase, RisePhase
from gearcam.numeric.arrays import Array, Ints, Mask

FEWEST: Final = 36
"""Fewest rows of a turn."""

FEWEST_OF_MOVE: Final = 3
"""Fewest rows on a rise or return, without its flat ends: the law and its boundaries need them."""

_LOUD: Final = 25.0
"""Total lift over the noise below which no law could be found."""

_FLAT: Final = 0.02
"""Share of a move that belongs to its flat ends."""

_APART: Final = 16.0
"""Least difference of sums of squares, in variances, that tells two models apart."""

_ROUNDED: Final = 9.0
"""Largest growth of the sum of squares by rounding a size, in variances."""

_NEAR: Final = 2.0
"""Standard deviations within which sizes are rounded, and which their errors are."""

_SWEEPS: Final = 4

_PAIRED: Final = 12
"""Pairs of laws of touching moves that are tried beside the others: those that suit them best."""

_ROUGH: Final = 0.02
"""How well they are fitted by themselves: fall of the sum of squares in a step, over the sum."""

_INSET: Final = 0.08
"""Share of a move next to a boundary without a dwell that belongs to another move perhaps."""

_GRIDS: Final = (5.0, 1.0, 0.5, *(part * 10.0**-k for k in range(1, 8) for part in (1.0, 0.5)))
"""Roundest numbers first."""

_DIGITS: Final = 9

_LEAST: Final = math.radians(0.01)
"""Least angle of a phase."""

_BESIDE: Final = 0.4
"""Share of the dwells beside a move that is looked at with it."""

_EDGE: Final = 0.02
"""Share of a range next to its ends, where the law is another one."""


class AlikeLaw(NamedTuple):
    """A law that a move may as well have, and where the move would be, rad."""

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
    scale : float
        Factor from lifts to their unit in output.
    alike : tuple of k tuples of AlikeLaw
        Other laws that cannot be distinguished from that of each move.
    deviations : mapping of Name to float
        Standard deviations of the parameters before rounding, rad, mm or rad, or a number.
    """

    model: LiftModel
    rows: LiftRows
    scale: float
    alike: tuple[tuple[AlikeLaw, ...], ...]
    deviations: dict[Name, float]

    @cached_property
    def missed(self) -> Array:
        """The rows less the lift of the program, mm or rad."""
        return self.rows.lift - self.model.lift(self.rows.theta)

    def on(self, k: int) -> Mask:
        """Return whether each row is on a move."""
        move, since = self.model.move_at(self.rows.theta)
        return (move == k) & (since < self.model.gaps[0][k])

    def error(self, name: Name) -> float:
        """Return the error of a boundary, rad: two deviations, and what other laws make of it."""
        kind, k = name
        if name not in self.deviations:  # tied: the end of the move before
            return self.error(("end", k - 1 if k else len(self.model.laws) - 1))
        own = self.model.value(name)
        other = (abs(getattr(one, kind) - own) for one in self.alike[k])
        return _NEAR * self.deviations[name] + max(other, default=0.0)

    @cached_property
    def begin(self) -> tuple[int, float]:
        """The move with which the program begins, and the row angle of its angle 0, rad.

        That is 0 if the lift is lowest there.
        """
        model, tiny = self.model, 1e-9 * self.rows.step
        lowest = model.levels[model.lowest] + 1e-9 * np.ptp(model.levels)
        for k in np.flatnonzero(model.levels <= lowest).tolist():
            start = float(model.starts[k])
            dwell = start - float(model.gaps[1][k - 1])
            zero = TURN * math.ceil((dwell - tiny) / TURN)
            if zero <= start + tiny:
                # a dwell that a design cannot have is left out
                return k, start if start - zero < _LEAST else zero
        return model.lowest, float(model.starts[model.lowest])

    def phases(self) -> tuple[Phase, ...]:
        """Return the phases of a design, from zero lift on."""
        model, (first, zero) = self.model, self.begin
        before, count = float(model.starts[first]) - zero, len(model.laws)
        widths, dwells = model.gaps
        dwells = dwells.copy()
        dwells[first - 1] -= before
        phases: list[Phase] = list(_dwell(before))
        for k in (*range(first, count), *range(first)):
            rise = self.scale * float(model.after[k] - model.levels[k])
            last = (k + 1) % count == first
            make = ReturnPhase if rise < 0.0 else RisePhase
            lift = None if last else float(f"{abs(rise):.12g}") / self.scale
            phases.append(make(angle=_angle(widths[k]), law=model.laws[k], lift=lift))
            phases += _dwell(float(dwells[k]))
        return (*phases[:-1], replace(phases[-1], angle="rest"))


def _dwell(width: float) -> Iterator[Phase]:
    if width >= _LEAST:
        yield DwellPhase(angle=_angle(width))


def _angle(width: float) -> float:
    return math.radians(round(math.degrees(width), _DIGITS))


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
        If there are too few rows, the lift is lost in noise, or a move takes too few rows.
    """
    if len(theta) < FEWEST:
        raise beyond_limit("the lift has too few rows", "", len(theta), FEWEST, unit="rows")
    rows = LiftRows(theta=theta, lift=lift, noise=0.0, error=error)
    scale, name = unit
    rows = replace(rows, noise=math.hypot(noise_of(rows, scale), error))
    if rows.total < _LOUD * rows.noise:
        what = f"the lift is lost in its noise, {formatted(scale * rows.noise, 3)} {name}"
        rule = f"a total lift of at least {_LOUD:g} times the noise; measure again, or average"
        raise beyond_limit(
            what, "", scale * rows.total, scale * _LOUD * rows.noise, rule, unit=name
        )
    trials = _Trials(first_model(rows), rows)
    model = trials.best()
    simple = _simplified(model, rows)
    if simple.tied != model.tied:
        trials = _Trials(simple, rows)
        model = trials.best()
    variance = _variance(model, rows)
    model = trials.near(min(trials.squares.values()), variance)[0]
    near = trials.near(model.squares(rows), variance)
    return FittedLift(
        model=_rounded(model, rows, variance, scale),
        rows=rows,
        scale=scale,
        alike=tuple(tuple(_alike(near, k)) for k in range(len(model.laws))),
        deviations=_deviations(model, variance, rows),
    )


def _alike(models: Sequence[LiftModel], k: int) -> Iterator[AlikeLaw]:
    """Yield other laws of a move than in the first of models, each name once."""
    seen = {type(models[0].laws[k])}
    for one in models:
        law = one.laws[k]
        if type(law) not in seen:
            seen.add(type(law))
            yield AlikeLaw(law, float(one.starts[k]), float(one.ends[k]))


def _variance(model: LiftModel, rows: LiftRows) -> float:
    """Return the variance of the noise, times the number of rows whose errors are alike."""
    off, count = rows.lift - model.lift(rows.theta), len(rows.theta)
    square = float(off @ off)
    alike = 1.0
    for lag in range(1, count // LAG):
        together = float(off @ np.roll(off, lag)) / square if square else 0.0
        if together <= 2.0 / math.sqrt(count):
            break
        alike += 2.0 * together
    left = max(1, count - len(model.parameters))
    return max(rows.noise**2, square / left) * alike + rows.variance - rows.noise**2


# --- where moves are ---------------------------------------------------------------------------


def first_model(rows: LiftRows) -> LiftModel:
    """Return a model of the moves that rows show, all with the law 3-4-5.

    Parameters
    ----------
    rows : LiftRows
        The rows.

    Returns
    -------
    LiftModel

    Raises
    ------
    InfeasibleError
        If a move takes too few rows.
    """
    runs, law = runs_of(rows), MOTION_LAWS["3-4-5"].example
    signs, zero = [sign for sign, _ in runs], rows.theta[runs[0][1][0]]
    angles = [zero + (rows.theta[run] - zero) % TURN for _, run in runs]
    before = np.array([angles[k - 1][-1] for k in range(len(runs))])
    before[0] -= TURN
    edges = 0.5 * (before + np.array([one[0] for one in angles]))
    edges = np.append(edges, edges[0] + TURN)
    # half of a dwell is left
    latest, earliest = (edges[:-1] + part * np.diff(edges) for part in (0.25, 0.75))
    starts, ends, levels = [], [], []
    for j, (sign, run) in enumerate(runs):
        if not sign:
            continue
        after = (j + 1) % len(runs)
        low, high = (
            float(rows.lift[run[end]] if signs[k] else rows.lift[runs[k][1]].mean())
            for k, end in ((j - 1, 0), (after, -1))
        )
        done = (rows.lift[run] - low) / (high - low)
        _demand_rows(rows, run, done)
        places = np.interp(SPAN, np.maximum.accumulate(done), angles[j])
        shares = crossed(law, falling=high < low)
        width = np.ptp(places) / np.ptp(shares)
        start = places[0] - width * shares[0]
        first = edges[j] if signs[j - 1] else max(start, earliest[j - 1] - TURN * (j == 0))
        last = min(start + width, latest[after] + TURN * (after == 0))
        starts.append(first)
        ends.append(edges[j + 1] if signs[after] else last)
        levels.append(low)
    return LiftModel(
        laws=(law,) * len(starts),
        starts=np.array(starts),
        ends=np.array(ends),
        levels=np.array(levels),
        tied=(False,) * len(starts),
    )


def _demand_rows(rows: LiftRows, run: Ints, done: Array) -> None:
    """Refuse a move of too few rows, of which shares are done."""
    inside = int(((done > _FLAT) & (done < 1.0 - _FLAT)).sum())
    if inside < FEWEST_OF_MOVE:
        word = "rise" if rows.lift[run[-1]] > rows.lift[run[0]] else "return"
        where = " to ".join(f"{math.degrees(float(rows.theta[one])):.6g}" for one in run[[0, -1]])
        note = f"at {where} deg; measure at smaller steps there; a jump has no law"
        what, least = f"a {word} takes too few rows", FEWEST_OF_MOVE
        raise beyond_limit(what, "", inside, least, note, unit="rows")


# --- laws --------------------------------------------------------------------------------------

Choice = tuple[Any, bool]
"""A motion law, and whether its number is fitted."""

Laws = tuple[Choice, ...]
"""Those of all moves."""


@cache
def _choices() -> tuple[Choice, ...]:
    """Return the laws without numbers to choose, and those with one: at its default, then free."""
    choices = []
    for entry in MOTION_LAWS.values():
        law, known = entry.parameters, fields(entry.parameters)
        if not known:
            choices.append((law(), False))
        elif len(known) == 1 and isinstance(known[0].default, float):
            choices += [(law(), False), (law(), True)]
    return tuple(choices)


@dataclass(frozen=True, eq=False)
class _Trials:
    """The laws that were tried, all from the boundaries that rows show.

    Beside a wrong law another one may close a dwell.
    """

    start: LiftModel
    rows: LiftRows
    models: dict[Laws, LiftModel] = field(default_factory=dict)
    squares: dict[Laws, float] = field(default_factory=dict)

    def cost(self, choices: Laws) -> float:
        """Return the sum of squares that laws leave, and more for each number that is chosen."""
        if choices not in self.models:
            model = self.start
            for k, (law, free) in enumerate(choices):
                model = model.with_law(k, law, free=free)
            model = improved(model, self.rows)
            ended = any(_at_end(model.laws[k]) for k in model.free)
            self.models[choices] = model
            self.squares[choices] = math.inf if ended else model.squares(self.rows)
        numbers = sum(free for _, free in choices)
        return self.squares[choices] + _APART * self.rows.variance * numbers

    def best(self) -> LiftModel:
        """Return the model with the best laws.

        Laws are tried move by move beside the others, from one law in all moves, as in most cams.
        Moves without a dwell between them are tried in pairs too.
        """
        plain = [one for one in _choices() if not one[1]]
        count = len(self.start.laws)
        laws = self.swept(min(((one,) * count for one in plain), key=self.cost), plain)
        for k, tied in enumerate(self.models[laws].tied):
            if tied:
                laws = min(self.in_pairs(laws, k, plain), key=self.cost)
        return self.models[self.swept(laws, _choices())]

    def swept(self, laws: Laws, choices: Iterable[Choice]) -> Laws:
        """Return the best laws, tried move by move."""
        for _ in range(_SWEEPS):
            before = laws
            for k in range(len(laws)):
                laws = min((_changed(laws, {k: one}) for one in choices), key=self.cost)
            if laws == before:
                break
        return laws

    def in_pairs(self, laws: Laws, k: int, choices: Iterable[Choice]) -> Iterator[Laws]:
        """Yield the laws with those that suit a move and the next best, in all pairs."""
        following = (k + 1) % len(laws)
        part, rows = _pair_alone(self.models[laws], k, self.rows)

        def squares(pair: Laws) -> float:
            model = part.with_law(0, pair[0][0]).with_law(1, pair[1][0])
            return improved(model, rows, _ROUGH).squares(rows)

        for first, second in sorted(product(choices, repeat=2), key=squares)[:_PAIRED]:
            yield _changed(laws, {k: first, following: second})

    def near(self, squares: float, variance: float) -> list[LiftModel]:
        """Return the models that cannot be distinguished from one, the simplest and best first."""
        most = squares + _APART * variance
        good = [laws for laws, missed in self.squares.items() if missed <= most]
        name = 2.0 * math.log(len(_choices()))

        def order(laws: Laws) -> tuple[int, float]:
            model = self.models[laws]
            more = _APART * len(model.parameters) + name * len(set(laws))
            return len(model.free), self.squares[laws] + more * variance

        return [self.models[laws] for laws in sorted(good, key=order)]


def _pair_alone(model: LiftModel, k: int, rows: LiftRows) -> tuple[LiftModel, LiftRows]:
    """Return a move and the next as a model of their own, and their rows.

    Where another move touches some rows are left out. A move where there are no rows closes the
    ring.
    """
    count = len(model.laws)
    last, after = (k + 1) % count, (k + 2) % count
    widths, dwells = model.gaps
    starts = model.starts[k] + np.array([0.0, (model.starts[last] - model.starts[k]) % TURN])
    ends = starts + widths[[k, last]]
    low = starts[0] - _BESIDE * dwells[k - 1] + _INSET * widths[k] * model.tied[k - 1]
    high = ends[-1] + _BESIDE * dwells[last] - _INSET * widths[last] * model.tied[last]
    inside = (rows.theta - low) % TURN <= high - low
    third = (TURN - (high - low)) / 3.0
    alone = LiftModel(
        laws=(model.laws[k], model.laws[last], model.laws[k]),
        starts=np.append(starts, high + third),
        ends=np.append(ends, high + 2.0 * third),
        levels=model.levels[[k, last, after]],
        tied=(model.tied[k], False, False),
        fixed=frozenset({("start", 2), ("end", 2)}),
    )
    return alone, replace(rows, theta=rows.theta[inside], lift=rows.lift[inside])


def _changed(laws: Laws, new: dict[int, Choice]) -> Laws:
    return tuple(new.get(k, one) for k, one in enumerate(laws))


def _at_end(law: Any) -> bool:
    """Whether the number of a law is at the end of its range: it is then another law."""
    name, low, high = number_of(law) or ("", 0.0, 0.0)
    edge = _EDGE * (high - low)
    return not low + edge < getattr(law, name) < high - edge


def _simplified(model: LiftModel, rows: LiftRows) -> LiftModel:
    """Return the model without dwells that noise does not show, narrow ones first."""
    for k in np.argsort(model.gaps[1]).tolist():
        one = model if model.tied[k] else improved(model.tie(k), rows)
        # what a wrong model leaves is no noise
        if one.squares(rows) <= model.squares(rows) + _APART * rows.variance:
            model = one
    return model


# --- sizes -------------------------------------------------------------------------------------


def _deviations(model: LiftModel, variance: float, rows: LiftRows) -> dict[Name, float]:
    """Return the standard deviations of the parameters that are fitted."""
    columns = model.missed(rows)[1]
    inverse = np.linalg.pinv(columns.T @ columns, rcond=1e-14, hermitian=True)
    sizes = np.sqrt(np.maximum(np.diag(inverse), 0.0) * variance)
    return dict(zip(model.parameters, sizes.tolist(), strict=True))


def _rounded(model: LiftModel, rows: LiftRows, variance: float, scale: float) -> LiftModel:
    """Return the model with all sizes rounded (see the module docstring)."""
    places = ("start", "end")
    names = sorted(
        model.parameters, key=lambda one: (one[0] not in places, one[1], one[0] == "end")
    )
    up = np.sign(model.after - model.levels)  # no move may be rounded to nothing
    model = replace(model, ground=model.lowest)  # another level may be rounded to the same
    for name in names:
        deviation = _deviations(model, variance, rows).get(name)
        if deviation is None:  # its dwell was closed
            continue
        most, one = model.squares(rows) + _ROUNDED * variance, model
        for target in _round_values(model, name, deviation, scale):
            moved = model.moved({name: target - model.value(name)})
            one = improved(replace(moved, fixed=model.fixed | {name}), rows)
            level = np.any(np.sign(one.after - one.levels) != up)
            if one.squares(rows) <= most and not level:
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
