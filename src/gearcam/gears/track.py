"""Tracks: the curves along which teeth are placed.

A *track* is the pitch curve of one wheel, ring or rack in its own coordinates. Its points are given
by one *parameter* phi, rad, which rises along it; two tracks that roll on each other share the
parameter (for a pair from a ratio law the driver angle) and the arc length ``s(phi)``. At phi a
track has the *frame* of its pitch point: point P, unit tangent T (rising s), unit normal ``N =
turn*T`` from the metal to the tips of the teeth, and the curvature kappa, so that ``dT/ds =
-kappa*N`` and ``dN/ds = +kappa*T``; a track that is convex towards its tips has kappa > 0. `turn`
is -1j where s runs counter-clockwise with the metal inside (a driver), +1j where s runs clockwise
(an external wheel, a rack), and also where it runs counter-clockwise with the metal outside (a
ring). So `turn` is not the same as `clockwise`, the sense of rising s around the metal.

A toothing depends on nothing but its track: neither the law nor the mate. Depends on numeric.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.chebyshev import Expansion
from gearcam.numeric.hermite import hermite_cubic
from gearcam.numeric.roots import newton_in_bracket

Wheel = Literal[1, 2]
WHEELS: tuple[Wheel, Wheel] = (1, 2)

_ROWS = 1025
"""Rows of the table that starts the inverse of an arc length: Newton then takes two steps."""

_JUMP = 1e-3
"""Change of the curvature at a knot, times the pitch, that is too small to turn a flank back or to
make a second point of contact."""

_BESIDE = 1e-9
"""Periods on both sides of a knot at which the curvature is compared."""

_PAD = 1e-12
"""Widening of the inverse's brackets, in periods, for the rounding of the table."""

_ANGLE = 1e-10
"""Step of Newton's method, in periods, at which the inverse ends: the remaining error goes with its
square, and is below rounding wherever the arc length has an expansion."""

_ROUNDING = 4e-16
"""Residual, in lengths of a period, at which it also ends: rounding. Steps stay larger where the
curve hardly moves."""


class Frames(NamedTuple):
    """Frames of a track at parameters: arrays of one shape.

    Parameters
    ----------
    p, t : complex array, mm and 1
        Point and unit tangent.
    kappa : array, 1/mm
        Curvature, positive for convex.
    speed : array, mm/rad
        ds/dphi.
    s : array, mm
        Arc length.
    """

    p: Plane
    t: Plane
    kappa: Array
    speed: Array
    s: Array

    def some(self, which: Ints | Mask | slice | int) -> Frames:
        """Return the frames at some of the parameters; an empty curvature stays empty."""
        kappa = self.kappa[which] if self.kappa.size else self.kappa
        return Frames(self.p[which], self.t[which], kappa, self.speed[which], self.s[which])


class LeastRadius(NamedTuple):
    """The sharpest bend of a track to one side.

    Parameters
    ----------
    phi : float, rad
        Parameter.
    radius : float, mm
        Radius of curvature there; infinite if it never bends to that side.
    """

    phi: float
    radius: float


@dataclass(frozen=True, eq=False, kw_only=True)
class ArcLength(ShortRepr):
    """Arc length over a parameter, and its inverse.

    Parameters
    ----------
    unit : Expansion
        Arc length over a period for unit size, 0 at phi = 0; if not `periodic` also beyond it.
    speed : callable
        Its derivative, of arrays within a period, rad.
    period : float, rad
        The parameter of one period.
    periodic : bool
        Whether it repeats beyond the period.
    size : float, mm
        Factor of unit lengths.
    """

    unit: Expansion
    speed: Callable[[Array], Array]
    period: float
    periodic: bool
    size: float = 1.0

    @cached_property
    def unit_length(self) -> float:
        """Length of a period for unit size."""
        return self.unit.last if self.periodic else float(self.unit(self.period))

    @property
    def length(self) -> float:
        """Length of a period, mm."""
        return self.size * self.unit_length

    def within(self, phi: Array) -> tuple[Array, Array]:
        """Return the whole periods before parameters, and the parameters within theirs, rad."""
        if not self.periodic:
            return np.zeros(np.shape(phi)), phi
        turns = np.floor(phi / self.period)
        return turns, phi - turns * self.period

    def at(self, turns: Array, x: Array) -> Array:
        """Return s, mm, at parameters as split by `within`."""
        return (self.unit(x) + turns * self.unit_length) * self.size

    def angle(self, s: ArrayLike) -> Array:
        """Return the parameters, rad, at arc lengths, mm, by table and bracketed Newton steps."""
        unit = np.asarray(s, dtype=float) / self.size
        angles, arcs, slopes = self._table
        if self.periodic:
            turns = np.floor(unit / self.unit_length)
            rest = unit - turns * self.unit_length
        else:
            turns, rest = np.zeros(unit.shape), np.clip(unit, arcs[0], arcs[-1])
        index = np.clip(np.searchsorted(arcs, rest, side="right") - 1, 0, len(arcs) - 2)
        low, high = angles[index], angles[index + 1]
        width = arcs[index + 1] - arcs[index]
        t = (rest - arcs[index]) / width
        # Hermite's cubic on the inverse leaves Newton little to do
        ends = slopes[index] * width, slopes[index + 1] * width
        start = np.clip(low + hermite_cubic(high - low, *ends, t)[0], low, high)

        def miss(phi: Array) -> tuple[Array, Array]:
            return self.unit(phi) - rest, self.speed(phi)

        pad, noise = _PAD * self.period, _ROUNDING * self.unit_length
        phi = newton_in_bracket(miss, low - pad, high + pad, start, _ANGLE * self.period, noise)
        return phi + turns * self.period

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Parameters, unit arc lengths and dphi/ds over a period, or over the whole range."""
        angles = np.linspace(self.unit.knots[0], self.unit.knots[-1], _ROWS)
        arcs = np.append(self.unit(angles[:-1]), self.unit.last)
        return angles, arcs, 1.0 / self.speed(angles)


@dataclass(frozen=True, eq=False, kw_only=True)
class Track(ShortRepr, ABC):
    """A curve along which teeth are placed (see above).

    Parameters
    ----------
    arc : ArcLength
        Its arc length; two tracks that roll on each other share it.
    periods : int
        Number of periods of `arc` in it.
    closed : bool
        Whether it returns to its beginning.
    slides : bool
        Whether it belongs to a rack, which has no shaft; a wheel turns about the origin.
    turn : complex
        ``N = turn*T``.
    clockwise : bool
        Whether rising s runs clockwise around the inside of the outline.
    """

    arc: ArcLength
    periods: int
    closed: bool
    slides: bool
    turn: complex
    clockwise: bool

    @property
    def length(self) -> float:
        """Its length, mm."""
        return self.arc.length * self.periods

    @property
    def around(self) -> float:
        """The parameter at its end, rad."""
        return self.arc.period * self.periods

    @property
    def exact(self) -> Track:
        """The same in closed form, where its frames come from a table."""
        return self

    def arc_length(self, phi: ArrayLike) -> Array:
        """Return s, mm, at parameters, rad."""
        return self.arc.at(*self.arc.within(np.asarray(phi, dtype=float)))

    def angle(self, s: ArrayLike) -> Array:
        """Return the parameters, rad, at arc lengths, mm."""
        return self.arc.angle(s)

    @abstractmethod
    def frames(self, phi: ArrayLike, *, curved: bool = True) -> Frames:
        """Return the frames at parameters.

        Parameters
        ----------
        phi : array, rad
            Parameters.
        curved : bool
            Whether to compute the curvature; if not it is an empty array.

        Returns
        -------
        Frames
            In the coordinates of the wheel or rack.
        """

    @abstractmethod
    def rotation(self, phi: Array) -> Array:
        """Return the wheel's angle of rotation at parameters, rad; for a rack its travel, mm."""

    @abstractmethod
    def knots_between(self, low: Array, high: Array) -> tuple[Ints, Array]:
        """Return the knots, where kappa may jump, in intervals.

        Parameters
        ----------
        low, high : (n,) arrays, rad
            Ends of the intervals; the low end is included, the high end is not.

        Returns
        -------
        number, place : (k,) int array, (k,) array, rad
            Of the stretch, and of the knot.
        """

    def jumps_between(self, low: Array, high: Array, pitch: float) -> tuple[Ints, Array]:
        """Return the knots in intervals at which kappa does jump.

        Parameters
        ----------
        low, high : (n,) arrays, rad
            See `knots_between`.
        pitch : float, mm
            Pitch of the teeth: changes too small to affect them do not count.

        Returns
        -------
        number, place : (k,) int array, (k,) array, rad
            Of the stretch, and of the knot.
        """
        number, place = self.knots_between(low, high)
        beside = _BESIDE * self.arc.period
        change = self.frames(place + beside).kappa - self.frames(place - beside).kappa
        jumps = np.abs(change) * pitch > _JUMP
        return number[jumps], place[jumps]

    @property
    @abstractmethod
    def curvature_extremes(self) -> tuple[Array, Array]:
        """Extremes of kappa over a period: parameters, rad, and 1/mm."""

    @property
    def ring(self) -> bool:
        """Whether its teeth point to the shaft: a ring, or a sector of one."""
        base = self.frames(np.zeros(1), curved=False)
        return not self.slides and bool((np.conj(base.p) * self.turn * base.t).real[0] < 0.0)

    @property
    def hollow(self) -> bool:
        """Whether the outline is the edge of a hole: a closed ring."""
        return self.ring and self.closed

    @property
    def convex(self) -> LeastRadius:
        """The bend of least convex radius."""
        return self._least_radius(1.0)

    @property
    def concave(self) -> LeastRadius:
        """The bend of least concave radius."""
        return self._least_radius(-1.0)

    def _least_radius(self, sign: float) -> LeastRadius:
        phi, kappa = self.curvature_extremes
        k = int(np.argmax(sign * kappa))
        most = sign * float(kappa[k])
        return LeastRadius(float(phi[k]), 1.0 / most if most > 0.0 else math.inf)
