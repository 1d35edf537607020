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
from typing import Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.laws.entry import Axis, Function, Functions
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import Expansion, NotSmoothError, expand
from gearcam.numeric.jets import Jet, composed, harmonics

_PLACES: Final = 2054
"""Places, ends included, at which a function is evaluated first and its expansion is compared: a
prime number of steps, so that these and the samples cannot both miss a wave."""

_SAMPLES: Final = 256
_MOST_HARMONICS: Final = 96
"""Largest number of harmonics that are kept; those above must be rounding."""

_DEGREE: Final = 16
"""Degree of Chebyshev pieces."""

_SCATTER: Final = 1e-12
"""Largest scatter of values over the largest value: the fourth derivative has four digits then."""

_MISS: Final = 1e-11
"""Largest error of an expansion between its nodes over the largest value."""

_ROUNDING: Final = 4.0 * np.finfo(float).eps
"""Rounding of a value over the largest value."""


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
        given = [min(k, len(self.curves) - 1) for k in range(4)]
        return tuple(
            self.curves[g].error(self.misses[g], self.scales[g], k - g) for k, g in enumerate(given)
        )

    def __call__(self, x: Jet) -> Jet:
        """Return the function of a jet."""
        places, last = np.asarray(x.c[0]), min(x.order, len(self.curves) - 1)
        values = [curve.derivatives(places, 0)[0] for curve in self.curves[:last]]
        values += self.curves[last].derivatives(places, x.order - last)
        return composed(x, [value / math.factorial(k) for k, value in enumerate(values)])


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
    curves: list[Waves | Pieces] = []
    samples: list[_Sample] = []
    for number, function in enumerate(given if isinstance(given, tuple) else (given,)):
        sample = _Sample(function, axis, number)
        allowed = max(tolerance, _ROUNDING, 8.0 * sample.scatter())
        curve: Waves | Pieces | None = sample.waves(allowed)
        if curve is None:
            curve = sample.pieces(allowed)
            if axis.series:
                what = f"needs more than {_MOST_HARMONICS} harmonics over its interval"
                raise sample.refusal(what, axis.low, nearest="a formula as text has no such limit")
        if curves:
            sample.demand_agreement(curves[-1])
        curves.append(curve)
        samples.append(sample)
    misses = tuple(
        float(sample.missed(curve.derivatives(sample.places, 0)[0]).max())
        for sample, curve in zip(samples, curves, strict=True)
    )
    return Expanded(tuple(curves), misses, tuple(sample.scale for sample in samples))


class _Sample:
    """A function (or its `number`-th derivative), checked wherever it is evaluated.

    It is sampled at even places over the interval; `scale` is the largest value.
    """

    def __init__(self, function: Function, axis: Axis, number: int) -> None:
        self.function, self.axis, self.number = function, axis, number
        self.takes_arrays = True
        self.places = np.linspace(axis.low, axis.high, _PLACES)
        self.values = self(self.places)
        self.scale = float(np.abs(self.values).max())

    def missed(self, values: Array) -> Array:
        """Return by how much values at the places are off."""
        return np.abs(values - self.values)

    def refusal(self, state: str, x: float, **numbers: Any) -> InfeasibleError:
        """Return the error that says what is wrong at a place: its `state`."""
        ordinal = {1: "first", 2: "second", 3: "third"}.get(self.number, f"{self.number}th")
        of = f"{ordinal} derivative given with " if self.number else ""
        name = f"the {of}{self.axis.name}" if of else self.axis.name
        return InfeasibleError(f"{name} {state}", where=self.axis.place(x), **numbers)

    def not_smooth(self, x: float) -> InfeasibleError:
        """Return the error of a corner or a jump."""
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
                values = np.asarray(self.function(x.copy()))
        except Exception:
            return None  # reported if it fails for floats too
        usable = values.dtype.kind in "iuf" and values.shape in ((), x.shape)
        return np.broadcast_to(values.astype(float), x.shape) if usable else None

    def _value(self, x: float) -> float:
        try:
            with np.errstate(all="ignore"):
                result = self.function(x)
                value = np.asarray(result)
        except Exception as error:
            state = f"raises {type(error).__name__}: {error}".rstrip(": ")
            raise self.refusal(state, x) from error
        if value.size != 1 or value.dtype.kind not in "iuf":
            what = f"an array of shape {value.shape}" if value.shape else repr(result)
            rule = "a function returns a number for a float, or an array for an array"
            raise self.refusal(f"gives {what}, not a number", x, nearest=rule)
        return float(value.item())

    def scatter(self) -> float:
        """Return the scatter of values about a smooth curve over the largest; refuse too much."""
        again = slice(_PLACES - 2, _PLACES // 3, -3)
        other = self(self.places[again])
        for k in np.flatnonzero(~(np.abs(other - self.values[again]) <= _MISS * self.scale))[:1]:
            raise self.refusal(
                "is not deterministic: a repeated evaluation returned a different value",
                float(self.places[again][k]),
                value=float(other[k]),
                limit=float(self.values[again][k]),
                nearest="the limit is the value returned first",
            )
        low, span = self.axis.low, self.axis.high - self.axis.low
        spots = low + span * ((np.arange(8) + 0.5) * 0.6180339887498949 % 0.99)
        beside = spots[:, None] + span * 1e-7 * np.arange(16)
        fourth = np.diff(self(beside.ravel()).reshape(beside.shape), 4, axis=1) / math.sqrt(70.0)
        scatter = float(np.median(np.sqrt((fourth**2).mean(axis=1)))) / (self.scale or 1.0)
        if scatter > _SCATTER:
            times = formatted(scatter)
            what = f"is not smooth anywhere: its values scatter by {times} times the largest"
            remedy, place = self.axis.remedy, float(spots[0])
            raise self.refusal(what, place, value=scatter, limit=_SCATTER, nearest=remedy)
        return scatter

    def waves(self, allowed: float) -> Waves | None:
        """Return a straight line plus harmonics, None if the function needs many."""
        low, span = self.axis.low, self.axis.high - self.axis.low
        start, slope = float(self.values[0]), float(self.values[-1] - self.values[0]) / span
        distance = span * np.arange(_SAMPLES) / _SAMPLES
        rest = self(low + distance) - start - slope * distance
        harmonics = np.fft.rfft(rest) * (2.0 / _SAMPLES)
        last = int(np.flatnonzero(np.abs(harmonics[1:]) > allowed * self.scale).max(initial=-1)) + 1
        if last > _MOST_HARMONICS:
            return None
        start += 0.5 * float(harmonics[0].real)
        kept = harmonics[1 : last + 1]
        waves = Waves(low, 2.0 * math.pi / span, start, slope, kept.real, -kept.imag)
        missed = self.missed(waves.derivatives(self.places, 0)[0]).max()
        return waves if missed <= _MISS * self.scale else None

    def pieces(self, allowed: float) -> Pieces:
        """Return Chebyshev pieces; refuse a function that is not smooth."""
        ends = [self.axis.low, self.axis.high]
        worst = self.places[0]
        # few wide pieces keep most digits of derivatives
        for cuts in (1, 8, 64, 512):
            try:
                raw = expand(self, ends, allowed, degree=_DEGREE, cuts=cuts)
            except NotSmoothError as error:
                raise self.not_smooth(error.place) from error
            # rounding would dominate high derivatives
            counts = np.logical_or.accumulate(np.abs(raw.coefficients[::-1]) > allowed * self.scale)
            pieces = Pieces(replace(raw, coefficients=raw.coefficients * counts[::-1]))
            missed = self.missed(pieces.expansion(self.places))
            if missed.max() <= _MISS * self.scale:
                self._demand_smooth(pieces, allowed * self.scale)
                return pieces
            worst = self.places[missed >= 0.5 * missed.max()][
                0
            ]  # of places alike the first, always
        raise self.not_smooth(float(worst))

    def _demand_smooth(self, pieces: Pieces, rounding: float) -> None:
        """Refuse a function whose derivatives jump between pieces: it has corners there."""
        knots = pieces.expansion.knots
        # what a derivative loses at the ends of a piece
        loss = 2.0 * _DEGREE**2 / np.diff(knots).max()
        for order in range(1, 5 - self.number):  # to one more than the jerk
            c = pieces.order(order).coefficients
            ends, starts = c.sum(axis=0), ((-1.0) ** np.arange(len(c))) @ c
            jumps = np.abs(ends[:-1] - starts[1:])
            noise = 100.0 * rounding * loss**order / math.prod(range(1, 2 * order, 2))
            if jumps.size and jumps.max() > 1e-4 * np.abs(c).sum(axis=0).max() + noise:
                raise self.not_smooth(float(knots[int(jumps.argmax()) + 1]))

    def demand_agreement(self, before: Waves | Pieces) -> None:
        """Refuse a given derivative that does not belong to the function before it."""
        slopes = before.derivatives(self.places, 1)[1]
        off = self.missed(slopes)
        worst = int(off.argmax())
        if off[worst] > 1e-7 * np.abs(slopes).max():
            raise self.refusal(
                "is not the derivative of the function given before it",
                float(self.places[worst]),
                value=float(self.values[worst]),
                limit=float(slopes[worst]),
                nearest="the limit is the derivative of that function",
            )
