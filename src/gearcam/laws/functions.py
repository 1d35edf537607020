"""Python functions as functions of jets, that is, with derivatives.

A Python function gives values and perhaps a few derivatives; laws need more. It is therefore
expanded over its interval: in harmonics about a straight line if a few suffice (most closed laws),
which keeps all digits of derivatives, else in Chebyshev pieces, which lose some. It is called a few
times with arrays, or value by value if it does not accept arrays, and never afterwards.

Refused, with the place: values that are not finite numbers, functions that are not deterministic,
scatter or are not smooth, and given derivatives that do not belong to the function.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import shown
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import Expansion, NotSmoothError, expand
from gearcam.numeric.jets import Jet, composed, harmonics

if TYPE_CHECKING:
    from gearcam.laws.formula import Axis, Function, Functions

_PLACES: Final = 2054
"""Places, ends included, at which a function is evaluated first and its expansion is compared: a
prime number of steps, so that these and the samples cannot both miss a wave."""

_SAMPLES: Final = 256
_MOST_HARMONICS: Final = 96
"""Largest number of harmonics that are kept; those above must be rounding."""

_DEGREE: Final = 16
_CUTS: Final = (1, 8, 64, 512)
"""Degree and first number of Chebyshev pieces. Few wide ones keep most digits of derivatives; more
are tried if they miss something between their nodes."""

_SCATTER: Final = 1e-12
"""Largest scatter of values over the largest value: the fourth derivative has four digits then."""

_MISS: Final = 1e-11
"""Largest error of an expansion between its nodes over the largest value."""

_ROUNDING: Final = 4.0 * np.finfo(float).eps
"""Rounding of a value over the largest value."""

_ROUGH: Final = 1e-4
"""Jump of a derivative between pieces, over its largest value, of a function that is not smooth."""

_SMOOTH_TO: Final = 4
"""Derivatives that are examined: one more than the jerk."""

_AGREEMENT: Final = 1e-7
"""Largest difference between given and computed derivative over its largest value."""

_SPOTS: Final = 8
_BESIDE: Final = 1e-7
"""Spots at which scatter is measured, and the distance of places there over the interval."""


@dataclass(frozen=True, eq=False)
class Waves:
    """A straight line plus harmonics over an interval.

    Parameters
    ----------
    low, rate : float
        Start of the interval, and ``2*pi`` over its length.
    start, slope : float
        Value at the start and slope of the line.
    cosines, sines : (n,) arrays
        Coefficients of the harmonics, from the first.
    """

    low: float
    rate: float
    start: float
    slope: float
    cosines: Array
    sines: Array

    def error(self, missed: float, scale: float, order: int) -> float:
        """Return the error of a derivative, estimated by the next harmonic.

        The rounding of the line, by far the largest part of a driven angle, has no derivatives.

        Parameters
        ----------
        missed : float
            Largest error of values before rounding.
        scale : float
            The largest value.
        order : int
            Order of the derivative.

        Returns
        -------
        float
        """
        if not order:
            return missed + _ROUNDING * scale
        level = abs(self.start) + float(np.hypot(self.cosines, self.sines).sum())
        growth = (self.rate * (len(self.cosines) + 1)) ** order
        return (missed + _ROUNDING * min(level, scale)) * growth

    def derivatives(self, x: Array, order: int) -> list[Array]:
        """Return ``[f, f', ..., f^(order)]`` at places `x`."""
        distance = Jet.variable(x, order) - self.low
        waves = harmonics(self.rate * distance, self.cosines, self.sines)
        return (waves + self.slope * distance + self.start).derivatives()


@dataclass(frozen=True, eq=False)
class Pieces:
    """Chebyshev pieces: an `expansion` and its derivatives."""

    expansion: Expansion

    @cached_property
    def _chain(self) -> list[Expansion]:
        return [self.expansion]

    def order(self, order: int) -> Expansion:
        """Return the derivative of an `order`."""
        while len(self._chain) <= order:
            self._chain.append(self._chain[-1].derivative())
        return self._chain[order]

    def error(self, missed: float, scale: float, order: int) -> float:
        """Return the error of a derivative at the ends of a piece (see `Waves.error`).

        Errors at the nodes are not smooth: all coefficients have the same, and at the ends the k-th
        derivative of ``T_n`` is the product of ``(n^2 - j^2)/(2*j + 1)`` for j below k.
        """
        n, j = np.arange(len(self.expansion.coefficients))[:, None], np.arange(order)
        slopes = np.prod((n**2 - j**2) / (2 * j + 1), axis=1)
        rate = 2.0 / float(np.diff(self.expansion.knots).min())
        growth = float(np.sqrt(2.0 * np.mean(slopes**2)) * rate**order)
        return (missed + _ROUNDING * scale) * growth

    def derivatives(self, x: Array, order: int) -> list[Array]:
        """Return ``[f, f', ..., f^(order)]`` at places `x`."""
        return [self.order(k)(x) for k in range(order + 1)]


@dataclass(frozen=True, eq=False)
class Expanded:
    """A function of jets made from a Python function.

    Parameters
    ----------
    curves : tuple of Waves or Pieces
        Expansions of the function and of the derivatives given with it.
    misses : tuple of float
        Largest difference between each expansion and its function between the nodes.
    scales : tuple of float
        Largest value of each.
    """

    curves: tuple[Waves | Pieces, ...]
    misses: tuple[float, ...]
    scales: tuple[float, ...]

    @property
    def errors(self) -> tuple[float, ...]:
        """Estimated errors of the function and its first three derivatives."""
        found = []
        for k in range(4):
            own = min(k, len(self.curves) - 1)
            found.append(self.curves[own].error(self.misses[own], self.scales[own], k - own))
        return tuple(found)

    def __call__(self, x: Jet) -> Jet:
        """Return the function of a jet."""
        places, last = np.asarray(x.c[0]), min(x.order, len(self.curves) - 1)
        found = [curve.derivatives(places, 0)[0] for curve in self.curves[:last]]
        found += self.curves[last].derivatives(places, x.order - last)
        return composed(x, [values / math.factorial(k) for k, values in enumerate(found)])


def expanded(given: Functions, axis: Axis, tolerance: float) -> Expanded:
    """Expand a Python function.

    Parameters
    ----------
    given : callable or tuple of callables
        The function, or a tuple of the function and its first derivatives in order.
    axis : Axis
        Variable and interval.
    tolerance : float
        Largest truncation error over the largest value.

    Returns
    -------
    Expanded
        The function of jets; the Python function is not called again.

    Raises
    ------
    InfeasibleError
        With the place (see the module docstring).
    """
    functions = given if isinstance(given, tuple) else (given,)
    places = np.linspace(axis.low, axis.high, _PLACES)
    curves: list[Waves | Pieces] = []
    misses: list[float] = []
    scales: list[float] = []
    for number, function in enumerate(functions):
        ask = _Asked(function, axis, number)
        values = ask(places)
        scale = float(np.abs(values).max())
        allowed = max(tolerance, _ROUNDING, 8.0 * _scatter(ask, places, values, scale))
        curve: Waves | Pieces | None = _waves(ask, values, allowed * scale)
        if curve is None:
            curve = _pieces(ask, places, values, allowed, scale)
            if axis.series:
                what = f"needs more than {_MOST_HARMONICS} harmonics over its interval"
                raise ask.refusal(what, axis.low, nearest="a formula as text has no such limit")
        if curves:
            _demand_agreement(curves[-1], ask, places, values)
        miss = np.abs(curve.derivatives(places, 0)[0] - values)
        misses.append(float(miss.max()))
        scales.append(scale)
        curves.append(curve)
    return Expanded(tuple(curves), tuple(misses), tuple(scales))


class _Asked:
    """A function (or its `number`-th derivative) whose values are checked."""

    def __init__(self, function: Function, axis: Axis, number: int) -> None:
        self.function, self.axis, self.number = function, axis, number
        self.takes_arrays = True

    def refusal(self, state: str, x: float, **numbers: Any) -> InfeasibleError:
        """Return the error that says what is wrong at a place: its `state`."""
        of = f"{_ordinal(self.number)} derivative given with " if self.number else ""
        name = f"the {of}{self.axis.name}" if of else self.axis.name
        return InfeasibleError(f"{name} {state}", where=self.axis.place(x), **numbers)

    def not_smooth(self, x: float) -> InfeasibleError:
        return self.refusal("is not smooth", x, nearest=self.axis.remedy)

    def __call__(self, x: Array) -> Array:
        """Return the values at (n,) places, all finite."""
        values = self._of_array(x) if self.takes_arrays else None
        if values is None:
            self.takes_arrays = False
            values = np.array([self._value(place) for place in x.tolist()])
        bad = ~np.isfinite(values)
        if bad.any():
            raise self.refusal("is not finite", float(x[bad][0]))
        return values

    def _of_array(self, x: Array) -> Array | None:
        """Return the values; None if the function does not accept arrays."""
        try:
            with np.errstate(all="ignore"):
                found = np.asarray(self.function(x.copy()))
        except Exception:
            return None  # reported if it fails for floats too
        usable = found.dtype.kind in "iuf" and found.shape in ((), x.shape)
        return np.broadcast_to(found.astype(float), x.shape) if usable else None

    def _value(self, x: float) -> float:
        try:
            with np.errstate(all="ignore"):
                result = self.function(x)
                found = np.asarray(result)
        except Exception as error:
            told = f"raises {type(error).__name__}: {error}".rstrip(": ")
            raise self.refusal(told, x) from error
        if found.size != 1 or found.dtype.kind not in "iuf":
            what = f"an array of shape {found.shape}" if found.shape else repr(result)
            rule = "a function returns a number for a float, or an array for an array"
            raise self.refusal(f"gives {what}, not a number", x, nearest=rule)
        return float(found.item())


def _ordinal(number: int) -> str:
    return {1: "first", 2: "second", 3: "third"}.get(number, f"{number}th")


def _scatter(ask: _Asked, places: Array, values: Array, scale: float) -> float:
    """Return the scatter of values about a smooth curve over the largest; refuse too much."""
    again = slice(_PLACES - 2, _PLACES // 3, -3)
    other = ask(places[again])
    for k in np.flatnonzero(~(np.abs(other - values[again]) <= _MISS * scale))[:1]:
        raise ask.refusal(
            "is not deterministic: a repeated evaluation returned a different value",
            float(places[again][k]),
            value=float(other[k]),
            limit=float(values[again][k]),
            nearest="the limit is the value returned first",
        )
    span = places[-1] - places[0]
    spots = places[0] + span * ((np.arange(_SPOTS) + 0.5) * 0.6180339887498949 % 0.99)
    beside = spots[:, None] + span * _BESIDE * np.arange(16)
    fourth = np.diff(ask(beside.ravel()).reshape(beside.shape), 4, axis=1) / math.sqrt(70.0)
    found = float(np.median(np.sqrt((fourth**2).mean(axis=1)))) / (scale or 1.0)
    if found > _SCATTER:
        raise ask.refusal(
            f"is not smooth anywhere: its values scatter by {shown(found)} times the largest",
            float(spots[0]),
            value=found,
            limit=_SCATTER,
            nearest=ask.axis.remedy,
        )
    return found


def _waves(ask: _Asked, values: Array, allowed: float) -> Waves | None:
    """Return a straight line plus harmonics, None if the function needs many."""
    low, span = ask.axis.low, ask.axis.high - ask.axis.low
    start, slope = float(values[0]), float(values[-1] - values[0]) / span
    distance = span * np.arange(_SAMPLES) / _SAMPLES
    rest = ask(low + distance) - start - slope * distance
    found = np.fft.rfft(rest) * (2.0 / _SAMPLES)
    last = int(np.flatnonzero(np.abs(found[1:]) > allowed).max(initial=-1)) + 1
    if last > _MOST_HARMONICS:
        return None
    kept = found[1 : last + 1]
    made = Waves(
        low, 2.0 * math.pi / span, start + 0.5 * float(found[0].real), slope, kept.real, -kept.imag
    )
    places = np.linspace(low, ask.axis.high, len(values))
    missed = np.abs(made.derivatives(places, 0)[0] - values).max()
    return made if missed <= _MISS * np.abs(values).max() else None


def _pieces(ask: _Asked, places: Array, values: Array, allowed: float, scale: float) -> Pieces:
    ends = [ask.axis.low, ask.axis.high]
    worst = places[0]
    for cuts in _CUTS:
        try:
            found = expand(ask, ends, allowed, degree=_DEGREE, cuts=cuts)
        except NotSmoothError as error:
            raise ask.not_smooth(error.place) from error
        # rounding would dominate high derivatives
        counts = np.logical_or.accumulate(np.abs(found.coefficients[::-1]) > allowed * scale)
        made = Pieces(replace(found, coefficients=found.coefficients * counts[::-1]))
        missed = np.abs(made.expansion(places) - values)
        if missed.max() <= _MISS * scale:
            _demand_smooth(made, ask, allowed * scale)
            return made
        worst = places[missed >= 0.5 * missed.max()][0]  # of places alike the first, always
    raise ask.not_smooth(float(worst))


def _demand_smooth(made: Pieces, ask: _Asked, rounding: float) -> None:
    """Refuse a function whose derivatives jump between pieces: it has corners there."""
    knots = made.expansion.knots
    loss = (
        2.0 * _DEGREE**2 / np.diff(knots).max()
    )  # of digits in one derivative, at the ends of a piece
    for order in range(1, _SMOOTH_TO + 1 - ask.number):
        c = made.order(order).coefficients
        ends, starts = c.sum(axis=0), ((-1.0) ** np.arange(len(c))) @ c
        jumps = np.abs(ends[:-1] - starts[1:])
        noise = 100.0 * rounding * loss**order / math.prod(range(1, 2 * order, 2))
        if jumps.size and jumps.max() > _ROUGH * np.abs(c).sum(axis=0).max() + noise:
            raise ask.not_smooth(float(knots[int(jumps.argmax()) + 1]))


def _demand_agreement(before: Waves | Pieces, ask: _Asked, places: Array, values: Array) -> None:
    """Refuse a given derivative that does not belong to the function before it."""
    slopes = before.derivatives(places, 1)[1]
    off = np.abs(slopes - values)
    worst = int(off.argmax())
    if off[worst] > _AGREEMENT * np.abs(slopes).max():
        raise ask.refusal(
            "is not the derivative of the function given before it",
            float(places[worst]),
            value=float(values[worst]),
            limit=float(slopes[worst]),
            nearest="the limit is the derivative of that function",
        )
