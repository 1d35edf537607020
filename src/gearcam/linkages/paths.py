"""The path of a point: length, area, cusps, and where it crosses itself.

Length and area are integrals by Gauss' rule between knots and the places where the point is slow,
halved until both results agree. Cusps are roots, crossings are pairs of roots.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.elements import Law
from gearcam.linkages.linkage import in_cycle
from gearcam.linkages.measures import extremes_of
from gearcam.linkages.plane import square
from gearcam.numeric.arrays import Array, Mask, Plane, distinct
from gearcam.numeric.crossings import chord_shares, near_chords
from gearcam.numeric.gauss import Integral, integral
from gearcam.numeric.jets import Jet

_ROUNDING: Final = 1e-15
"""Rounding of an integral that is 0, as a share of the distance from the origin."""

_STOPPED: Final = 1e-7
"""Speed, as a share of the largest, at which the point counts as standing still."""

_BENT: Final = 1e-6
"""Sine of the angle between two directions below which they are one."""

_CHORDS: Final = 720
"""Number of chords on which crossings are first looked for: a loop within three is not seen."""

_SLACK: Final = 1e-6
"""Share of a chord by which a crossing may be beyond its ends."""

_NEWTON: Final = 30
"""Largest number of steps towards a crossing."""

_CLOSE: Final = 1e-11
"""Distance of both branches at a crossing, as a share of the path's size."""

_SAME: Final = 1e-7
"""Crossings whose driver angles differ less are one, rad."""


class Cusp(NamedTuple):
    """A place where the point stops and goes back along the other side of its tangent.

    Attributes
    ----------
    place : float, rad
        The driver's angle.
    point : complex, mm
        Where it is.
    """

    place: float
    point: complex


class SelfCrossing(NamedTuple):
    """A place that the point passes twice, in different directions.

    Attributes
    ----------
    first, second : float, rad
        The driver's angles, rising.
    point : complex, mm
        Where it is.
    """

    first: float
    second: float
    point: complex


@dataclass(frozen=True, eq=False)
class PointPath(ShortRepr):
    """The path of a point over the driver.

    Parameters
    ----------
    track : callable
        ``track(q, order) -> Jet`` of complex numbers, mm.
    knots : (k,) array, rad
        The driver's angles from the first to the last one; between them it is smooth.
    closed : bool
        Whether the point is back after the last knot.
    """

    track: Law
    knots: Array
    closed: bool = True

    @property
    def span(self) -> tuple[float, float]:
        """First and last angle of the driver, rad."""
        return float(self.knots[0]), float(self.knots[-1])

    def at(self, q: Array, order: int) -> Jet:
        """Return the point at any angle of the driver, past the end of a turn too.

        Parameters
        ----------
        q : (n,) array, rad
            Within the range if the path is open.
        order : int
            Highest derivative.

        Returns
        -------
        Jet, mm
        """
        return self.track(in_cycle(q, self.span)[1] if self.closed else q, order)

    def _speed(self, q: Array, order: int) -> Jet:
        """Return the squared speed, mm2."""
        return square(self.track(q, order + 1).differentiated())

    @cached_property
    def _slow(self) -> tuple[Array, Array]:
        """Places where the speed is stationary, and both sides of knots; the squared speed."""
        ((places, values),) = extremes_of(self._speed, self.knots, 0)
        return places, values

    @cached_property
    def length(self) -> Integral:
        """Way of the point, mm: what it goes twice counts twice."""

        def speed(q: Array) -> Array:
            return np.sqrt(np.asarray(self._speed(q, 0).c[0]))

        return self._integrated(speed, self._reach)

    @cached_property
    def area(self) -> Integral | None:
        """Enclosed area, mm2, positive if the point goes round it counter-clockwise.

        What is enclosed twice counts twice. None for an open path.
        """
        if not self.closed:
            return None

        def swept(q: Array) -> Array:
            point, speed = self.track(q, 1).derivatives()
            return 0.5 * np.imag(np.conj(point) * speed)

        return self._integrated(swept, self._reach**2)

    @property
    def _reach(self) -> float:
        """How far the point is from the origin, mm."""
        return float(np.abs(np.asarray(self.track(self._slow[0], 0).c[0])).max())

    def _integrated(self, function: Callable[[Array], Array], size: float) -> Integral:
        """Return an integral; `size` times the driver's range is what its rounding is a share of.

        That of a point that stands still, or of one that goes to and fro in line with the origin,
        is nothing but rounding.
        """
        edges = distinct(self.knots, self._slow[0])
        return integral(function, edges, _ROUNDING * size * float(edges[-1] - edges[0]))

    @cached_property
    def cusps(self) -> tuple[Cusp, ...]:
        """Where the point stops and its path has a cusp.

        The speed there is below 1e-7 of the largest. A stop from which the point goes back on its
        own path, as that of a rocker does, and a rest are no cusps: acceleration and jerk have one
        direction there.
        """
        places, values = self._slow
        stops = places[values <= _STOPPED**2 * values.max()]
        if self.closed:
            stops = stops[stops < self.span[1]]
        if not stops.size:
            return ()
        point, _, bend, jerk = (np.asarray(one) for one in self.track(stops, 3).derivatives())
        across = np.abs(np.imag(np.conj(bend) * jerk))
        sharp = across > _BENT * np.abs(bend) * np.abs(jerk)
        cusps: list[Cusp] = []
        for place, where in zip(stops[sharp].tolist(), point[sharp].tolist(), strict=True):
            if not cusps or place - cusps[-1].place > _SAME:
                cusps.append(Cusp(place, where))
        return tuple(cusps)

    @cached_property
    def crossings(self) -> tuple[SelfCrossing, ...]:
        """Where the path crosses itself, by the first angle.

        Places where it touches itself in one direction, or is gone twice, are left out.
        """
        q = np.linspace(*self.span, _CHORDS + 1)
        q = distinct(q, self.knots, self._slow[0])
        points = np.asarray(self.track(q, 0).c[0])
        if self.closed:
            points[-1] = points[0]
        one, two = near_chords(points[:-1], points[1:])
        apart = two - one > 1
        if self.closed:
            apart &= two - one < q.size - 2
        one, two = one[apart], two[apart]
        shares, _ = chord_shares(points[one], points[one + 1], points[two], points[two + 1])
        hit = np.all((shares > -_SLACK) & (shares < 1.0 + _SLACK), axis=0)
        first, second = (
            q[k[hit]] + shares[number][hit] * (q[k[hit] + 1] - q[k[hit]])
            for number, k in enumerate((one, two))
        )
        size = float(np.abs(points - points.mean()).max())
        return self._listed(*self._met(first, second, size))

    def _met(self, first: Array, second: Array, size: float) -> tuple[Array, Array]:
        """Return pairs of driver angles at which both branches meet, by Newton's method."""
        for _ in range(_NEWTON):
            (p, u), (r, v) = (self.at(one, 1).derivatives() for one in (first, second))
            gap, turn = r - p, np.imag(np.conj(u) * v)
            with np.errstate(divide="ignore", invalid="ignore"):
                steps = np.imag(np.conj(gap) * v) / turn, np.imag(np.conj(gap) * u) / turn
            steps = [np.where(np.isfinite(one), one, 0.0) for one in steps]
            first, second = self._held(first + steps[0]), self._held(second + steps[1])
            if max(float(np.abs(one).max(initial=0.0)) for one in steps) <= math.ulp(8.0):
                break
        (p, u), (r, v) = (self.at(one, 1).derivatives() for one in (first, second))
        crossed = np.abs(np.imag(np.conj(u) * v)) > _BENT * np.abs(u) * np.abs(v)
        real: Mask = crossed & (np.abs(r - p) <= _CLOSE * size)
        return first[real], second[real]

    def _held(self, q: Array) -> Array:
        return q if self.closed else np.clip(q, *self.span)

    def _listed(self, first: Array, second: Array) -> tuple[SelfCrossing, ...]:
        if self.closed:
            first, second = (in_cycle(one, self.span)[1] for one in (first, second))
        pairs = np.sort(np.stack([first, second]), axis=0)
        found: list[SelfCrossing] = []
        points: Plane = np.asarray(self.at(pairs[0], 0).c[0])
        for k in np.lexsort(pairs[::-1]).tolist():
            one, two = float(pairs[0, k]), float(pairs[1, k])
            if not any(abs(one - a) < _SAME and abs(two - b) < _SAME for a, b, _ in found):
                found.append(SelfCrossing(one, two, complex(points[k])))
        return tuple(found)
