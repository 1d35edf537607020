"""Tracks: the curves that teeth are set along.

A *track* is the pitch curve of one wheel, ring or rack in its own coordinates. Its places are named
by one *parameter* phi, rad, which rises along it; two tracks that roll on each other share the
parameter (of a pair made from a ratio law the driver angle) and the arc length ``s(phi)``. At phi a
track carries the *frame* of its pitch point: point P, unit tangent T (rising s), unit normal ``N =
turn*T`` from the metal to the tips of the teeth, and the curvature kappa, so that ``dT/ds =
-kappa*N`` and ``dN/ds = +kappa*T``; a track that is convex towards its tips has kappa > 0. `turn`
is -1j where s runs counter-clockwise with the metal inside (a driver), +1j where s runs clockwise
(an external wheel, a rack), and also where it runs counter-clockwise with the metal outside (a
ring). So `turn` and `clockwise`, the sense of rising s about the metal's outline, are two things.

A toothing needs nothing else of what it is cut on: neither the law nor the mate.

Refused: nothing. Depends on numeric.
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

from gearcam.display import Brief
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.chebyshev import Expansion
from gearcam.numeric.hermite import hermite_cubic
from gearcam.numeric.roots import newton_in_bracket

Wheel = Literal[1, 2]
WHEELS: tuple[Wheel, Wheel] = (1, 2)

_ROWS = 1025
"""Rows of the table from which the inverse of an arc length starts: Newton then takes two steps."""

_JUMP = 1e-3
"""Change of the curvature at a knot, over a pitch, that neither turns a flank back nor makes two
places of contact."""

_BESIDE = 1e-9
"""Periods on both sides of a knot at which the curvature is compared."""

_PAD = 1e-12
"""What brackets of the inverse are widened by, in periods: the table is rounded."""

_ANGLE = 1e-10
"""Step of Newton's method at which the inverse ends, in periods: what it misses then goes with the
square of the step, and is less than rounding wherever the arc length has an expansion."""

_ROUNDING = 4e-16
"""What an arc length is missed by at which it ends too, in those of a period: rounding; steps stay
larger where the curve hardly moves."""


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

    def some(self, which: Ints | Mask | int) -> Frames:
        """Return those at some of the parameters; a curvature that is left out stays so."""
        kappa = self.kappa[which] if self.kappa.size else self.kappa
        return Frames(self.p[which], self.t[which], kappa, self.speed[which], self.s[which])


class LeastRadius(NamedTuple):
    """Where a track bends most to one side.

    Parameters
    ----------
    phi : float, rad
        Parameter.
    radius : float, mm
        Radius of curvature there; infinite where nothing bends to that side.
    """

    phi: float
    radius: float


@dataclass(frozen=True, eq=False, kw_only=True)
class ArcLength(Brief):
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
        Whether it goes on by repeating.
    size : float, mm
        What unit lengths are multiplied by.
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
        """Return how many periods lie before parameters, and the parameters within theirs, rad."""
        if not self.periodic:
            return np.zeros(np.shape(phi)), phi
        turns = np.floor(phi / self.period)
        return turns, phi - turns * self.period

    def at(self, turns: Array, x: Array) -> Array:
        """Return s, mm, at parameters as told by `within`."""
        return (self.unit(x) + turns * self.unit_length) * self.size

    def angle(self, s: ArrayLike) -> Array:
        """Return the parameters, rad, at arc lengths, mm: a table, then Newton bracketed."""
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
        # Hermite's cubic on the inverse: Newton then has little left to do.
        ends = slopes[index] * width, slopes[index + 1] * width
        start = np.clip(low + hermite_cubic(high - low, *ends, t)[0], low, high)

        def miss(phi: Array) -> tuple[Array, Array]:
            return self.unit(phi) - rest, self.speed(phi)

        pad, noise = _PAD * self.period, _ROUNDING * self.unit_length
        phi = newton_in_bracket(miss, low - pad, high + pad, start, _ANGLE * self.period, noise)
        return phi + turns * self.period

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Parameters, unit arc lengths and dphi/ds over a period, or all that is known."""
        angles = np.linspace(self.unit.knots[0], self.unit.knots[-1], _ROWS)
        arcs = np.append(self.unit(angles[:-1]), self.unit.last)
        return angles, arcs, 1.0 / self.speed(angles)


@dataclass(frozen=True, eq=False, kw_only=True)
class Track(Brief, ABC):
    """A curve that teeth are set along (see above).

    Parameters
    ----------
    arc : ArcLength
        Its arc length; two tracks that roll on each other share it.
    periods : int
        How often the period of `arc` fits into it.
    closed : bool
        Whether it comes back to its beginning.
    slides : bool
        Whether it is a rack's, which has no shaft; a wheel turns about the origin.
    turn : complex
        ``N = turn*T``.
    clockwise : bool
        Whether rising s runs clockwise around what is inside the outline.
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
            Whether the curvature is wanted; else it is an empty array, and time is saved.

        Returns
        -------
        Frames
            In the own coordinates of the wheel or rack.
        """

    @abstractmethod
    def rotation(self, phi: Array) -> Array:
        """Return how far the wheel has turned at parameters, rad; of a rack how far it moved."""

    @abstractmethod
    def knots_between(self, low: Array, high: Array) -> tuple[Ints, Array]:
        """Return the knots, where kappa may jump, in stretches.

        Parameters
        ----------
        low, high : (n,) arrays, rad
            Ends of the stretches; the low one belongs to its stretch, the high one does not.

        Returns
        -------
        number, place : (k,) int array, (k,) array, rad
            Of the stretch, and of the knot.
        """

    def jumps_between(self, low: Array, high: Array, pitch: float) -> tuple[Ints, Array]:
        """Return the knots in stretches where kappa does jump.

        Parameters
        ----------
        low, high : (n,) arrays, rad
            See `knots_between`.
        pitch : float, mm
            Of the teeth: a change that bends them by next to nothing is no jump.

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
        """Whether the outline is the edge of a hole: of a ring that goes all around."""
        return self.ring and self.closed

    @property
    def convex(self) -> LeastRadius:
        """The least convex radius."""
        return self._least_radius(1.0)

    @property
    def concave(self) -> LeastRadius:
        """The least concave radius."""
        return self._least_radius(-1.0)

    def _least_radius(self, sign: float) -> LeastRadius:
        phi, kappa = self.curvature_extremes
        k = int(np.argmax(sign * kappa))
        most = sign * float(kappa[k])
        return LeastRadius(float(phi[k]), 1.0 / most if most > 0.0 else math.inf)
