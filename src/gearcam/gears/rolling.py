"""Two centrodes of a ratio law that roll on each other: the tracks of a wheel and its mate.

Both share one parameter, the driver angle `phi` (rad, any number of turns), and one arc length
``s(phi)``, since rolling gives equal lengths. The type of the mate follows from the law's span and
is one number w, `mate`: 1 for an external wheel, 0 for a rack, whose shaft is infinitely far, and
-1 for a ring. The driver's radius is ``r1 = A*i/(1 + w*i)``, the mate's shaft is at w*A, and the
curvatures obey ``kappa1 + kappa2 = (1 + w*i)/v`` (Euler and Savary).

The driven element has a *guide*: a shaft on which it turns, or a slide on which a rack moves.
Relative to it an element has *heights* that grow from its roots to its tips: distances from the
shaft, or for a rack the distance towards the driver. Its motion, here called a *turn*, changes no
height. So two curves are compared at equal heights with either guide, and the result is a turn in
rad, for a rack in mm; positive as the nominal motion with rising phi1.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.tolerances import Tolerances
from gearcam.gears.track import ArcLength, Frames, Track, Wheel
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import RACK, RING, WHEEL, demand_smooth
from gearcam.numeric.arrays import Array, Ints, Plane, complex_of, distinct
from gearcam.numeric.chebyshev import expand, missed
from gearcam.numeric.piecewise import extremes_of_each
from gearcam.numeric.pose import Pose

_MARGIN = 2.0
"""Pitches beyond an open pair's ends over which its last teeth and fillets are formed."""


@dataclass(frozen=True, kw_only=True)
class Guide(ShortRepr, ABC):
    """Guide of the driven element; points relative to it are complex numbers in mm.

    Parameters
    ----------
    law : RatioLaw
        Its motion.
    place : float, mm
        Position of its frame in that of the driver at phi1 = 0, along x: the centre distance,
        0 for a rack, negative for a ring.
    scale : float
        Factor from the law's motion to a turn: 1, for a rack a length in mm.
    """

    law: RatioLaw
    place: float
    scale: float
    unit: ClassVar[str]
    """Unit of turns."""
    turns: ClassVar[float]
    """Rotation of directions per turn of 1: 1 rad, for a rack 0, for a ring -1 rad."""

    def nominal(self, phi1: Array) -> Array:
        """Return the nominal turns at driver angles, rad: in rad, for a rack in mm."""
        return self.scale * self.law.phi2(phi1)

    def motion(self, phi1: Array) -> Array:
        """Return the nominal turns at driver angles, rad, and their derivatives, (2, n)."""
        return self.scale * np.stack(self.law.derivatives(phi1, 1))

    @abstractmethod
    def pose(self, moved: Array) -> Pose:
        """Return the poses of the driven element, relative to its guide.

        Parameters
        ----------
        moved : (n,) array, rad, of a rack mm
            Turn from phi1 = 0: `nominal` plus any lead.
        """

    @abstractmethod
    def carried(self, points: Plane) -> Plane:
        """Return the velocity of points per turn: mm, for a rack 1."""

    @abstractmethod
    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm."""

    @abstractmethod
    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns, rad or mm, that move `others` to `points` of equal heights."""

    def rates(self, points: Plane, directions: Plane) -> tuple[Array, Array]:
        """Return derivatives of heights and of turns at points in `directions`."""
        moved = self.carried(points)
        size = np.abs(moved)
        along = np.conj(moved) * directions / size
        return -along.imag, along.real / size

    def lever(self, points: Plane, directions: Plane) -> Array:
        """Return the velocity of points per turn along unit vectors `directions`, mm or 1."""
        return np.real(np.conj(self.carried(points)) * directions)


class Shaft(Guide):
    """A shaft as the origin; the driver is to its left and turns the other way."""

    unit = "rad"
    turns = 1.0

    def pose(self, moved: Array) -> Pose:
        """Return the poses of the driven element (see `Guide.pose`)."""
        return Pose(self.turns * moved, np.zeros(moved.shape, dtype=np.complex128))

    def carried(self, points: Plane) -> Plane:
        """Return the velocity of points per turn (see `Guide.carried`)."""
        return 1j * self.turns * points

    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm (see `Guide.height`)."""
        return self.turns * np.abs(points)

    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns that move `others` to `points` (see `Guide.turn`)."""
        return self.turns * np.angle(points * np.conj(others))


class RingShaft(Shaft):
    """The shaft of a ring: the driver is to its right, within the ring, and turns as it does.

    The tips of a ring point to the shaft: its heights are negative distances from it.
    """

    turns = -1.0


class Slideway(Guide):
    """A slide across the line of centres; the origin is the rack's position at phi1 = 0.

    The rack moves downwards, as the driver's pitch point does.
    """

    unit = "mm"
    turns = 0.0

    def pose(self, moved: Array) -> Pose:
        """Return the poses of the driven element (see `Guide.pose`)."""
        return Pose(np.zeros(moved.shape), -1j * moved)

    def carried(self, points: Plane) -> Plane:
        """Return the velocity of points per turn (see `Guide.carried`)."""
        return np.full(np.shape(points), -1j)

    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm (see `Guide.height`)."""
        return -points.real

    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns that move `others` to `points` (see `Guide.turn`)."""
        return others.imag - points.imag


@dataclass(frozen=True, eq=False, kw_only=True)
class Rolling(ShortRepr):
    """The pair of centrodes of a wheel and its mate.

    Parameters
    ----------
    law : RatioLaw
        Their ratio.
    arc : ArcLength
        Arc length over a lobe, for an open pair also beyond its ends. Its size is the centre
        distance A; for a rack the factor of the law's radius.
    margin : float, mm
        Length beyond each end of an open pair in which its teeth are formed.
    """

    law: RatioLaw
    arc: ArcLength
    margin: float = 0.0

    @property
    def mate(self) -> int:
        """Type of the mate: w above."""
        return self.law.mate

    @property
    def center_distance(self) -> float:
        """Centre distance A, mm; for a rack the factor of the law's radius."""
        return self.arc.size

    @cached_property
    def tracks(self) -> tuple[Centrode, Centrode]:
        """The centrodes of driver and driven element."""
        return self._track(1), self._track(2)

    def _track(self, wheel: Wheel) -> Centrode:
        slides = wheel == 2 and self.mate == RACK
        return Centrode(
            arc=self.arc,
            periods=self.law.lobes.n1 if wheel == 1 else self.law.lobes.n2,
            closed=self.law.lobes.closed and not slides,
            slides=slides,
            turn=-1j if wheel == 1 else 1j,
            clockwise=wheel == 2 and not (self.mate == RING and self.law.lobes.closed),
            rolling=self,
            wheel=wheel,
        )

    @cached_property
    def guide(self) -> Guide:
        """Guide of the driven element."""
        size = self.center_distance
        if self.mate == RACK:
            return Slideway(law=self.law, place=0.0, scale=size)
        shaft = Shaft if self.mate == WHEEL else RingShaft
        return shaft(law=self.law, place=self.mate * size, scale=1.0)

    def poses(self, phi1: Array | float) -> tuple[Pose, Pose]:
        """Return the poses of driver and driven element at driver angles, rad, as designed."""
        phi1 = np.asarray(phi1)
        driver = Pose(-phi1, np.zeros(phi1.shape, dtype=np.complex128))
        return driver, Pose(shift=self.guide.place) @ self.guide.pose(self.guide.nominal(phi1))

    @property
    def mean_radius(self) -> float:
        """Unit of the law's ratios: 1, for a rack the mean radius for unit size."""
        return 1.0 if self.mate else self.law.lobes.advance / self.law.lobes.period

    def radii(self, phi: Array, order: int) -> list[Array]:
        """Return r1 for unit size with `order` derivatives at `phi` in the first lobe, rad."""
        return _radii(self.law.ratio.derivatives(phi, order), self.mate)[1:]

    @cached_property
    def curvature_extremes(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Both centrodes' extremes of curvature over a lobe: driver angles, rad, and 1/mm."""

        def curvatures(phi: Array) -> Array:
            ratios = self.law.ratio.derivatives(phi, 3)
            wi, r, dr, ddr, d3r = _radii(ratios, self.mate)
            speed = np.sqrt(r * r + dr * dr)
            rate = dr * (r + ddr) / (speed * speed)  # of the speed's logarithm
            cube = speed * speed * speed
            first = (r * r + 2.0 * dr * dr - r * ddr) / cube
            both = (1.0 + wi) / speed
            slope = (2.0 * r * dr + 3.0 * dr * ddr - r * d3r) / cube - 3.0 * rate * first
            change = self.mate * ratios[1] / speed - rate * both
            found = [[first, both - first], [slope, change - slope]]
            return np.array(found) / self.center_distance

        first, second = extremes_of_each(curvatures, self.cells(self._tooth_knots), cells=True)
        return first, second

    def cells(self, knots: Array) -> Array:
        """Return `knots`, and between them those of the arc length, dense where it changes fast.

        So points taken in each interval miss no feature of the ratio, even one of a degree or less
        (see `gearcam.numeric.piecewise.places_between`).
        """
        found = self.arc.unit.knots
        inside = found[(found > knots[0]) & (found < knots[-1])]
        return distinct(knots, inside)

    @property
    def _tooth_knots(self) -> Array:
        """The knots between which teeth are formed, ends included."""
        if self.law.lobes.closed:
            return self.law.knots
        low, high = self.arc.angle(np.array([-self.margin, self.arc.length + self.margin]))
        return np.concatenate([[low], self.law.knots, [high]])

    @cached_property
    def arc_error(self) -> float:
        """Estimated error of the centrodes' length, mm, and of arc lengths along them.

        Difference from another quadrature over a lobe, doubled since both are rounded; expansion
        error of a Python function, which changes the radius; and rounding.
        """
        arc, law = self.arc, self.law
        measured = 2.0 * missed(arc.unit, arc.speed, arc.unit.knots) + law.function_error
        rounding = 4.0 * float(np.finfo(float).eps) * arc.unit_length
        lobes = max(track.length for track in self.tracks) / arc.length
        return float(self.center_distance * (measured + rounding) * lobes)


@dataclass(frozen=True, eq=False, kw_only=True)
class Centrode(Track):
    """A centrode as a track; the driver's, or that of its mate.

    Parameters
    ----------
    rolling : Rolling
        The pair that it belongs to.
    wheel : {1, 2}
        Wheel: in its own coordinates wheel 1 has the polar angle phi1, wheel 2 pi - phi2, a ring
        phi2.
    """

    rolling: Rolling
    wheel: Wheel

    def frames(self, phi: ArrayLike, *, curved: bool = True) -> Frames:
        """Return the frames at driver angles (see `Track.frames`).

        Notes
        -----
        With ``q = r1' + 1j*r1`` the points move by ``q*exp(1j*phi1)`` and ``q*exp(-1j*w*phi2)``,
        so that both have the speed ``|q|``. Curvatures are from the second derivatives.
        """
        phi = np.asarray(phi, dtype=float)
        law, size = self.rolling.law, self.arc.size
        turns, x = self.arc.within(phi)
        ratios = law.ratio.derivatives(x, 2 if curved else 1)
        wi, *unit = _radii(ratios, self.rolling.mate)
        r, dr, *more = (size * value for value in unit)
        speed = np.sqrt(r * r + dr * dr)
        moved = phi if self.wheel == 1 else law.driven(x) + turns * law.lobes.advance
        if self.slides:
            pole = np.ones(r.shape, dtype=np.complex128)
            point = complex_of(r, size * moved)
        else:
            mate = self.rolling.mate
            turned = moved if self.wheel == 1 else -mate * moved
            pole = complex_of(np.cos(turned), np.sin(turned))
            point = (r if self.wheel == 1 else r - mate * size) * pole
        tangent = complex_of(dr / speed, r / speed) * pole
        kappa = np.empty(0)
        if curved:
            (ddr,) = more
            if self.wheel == 1:
                top = r * r + 2.0 * dr * dr - r * ddr
            else:
                top = wi * r * r + r * ddr + (wi - 1.0) * dr * dr
            kappa = top / (speed * speed * speed)
        return Frames(point, tangent, kappa, speed, self.arc.at(turns, x))

    def rotation(self, phi: Array) -> Array:
        """Return its angle of rotation at driver angles, rad (see `Track.rotation`)."""
        return phi if self.wheel == 1 else self.rolling.guide.nominal(phi)

    def knots_between(self, low: Array, high: Array) -> tuple[Ints, Array]:
        """Return the law's knots in intervals of driver angle (see `Track.knots_between`)."""
        return self.rolling.law.knots_between(low, high)

    @property
    def curvature_extremes(self) -> tuple[Array, Array]:
        """See `Track.curvature_extremes`."""
        return self.rolling.curvature_extremes[self.wheel - 1]


def _radii(ratios: Sequence[Any], mate: int) -> list[Any]:
    """Return w*i, and r1 for unit size with three derivatives, from those of the ratio."""
    i, di, *more = ratios
    wi = mate * i
    a = 1.0 / (1.0 + wi)
    square = a * a
    found = [wi, i * a, square * di]
    if more:
        found.append(square * (more[0] - 2.0 * mate * (a * di * di)))
    if more[1:]:
        bend = mate * a * di
        found.append(square * (more[1] - 6.0 * bend * (more[0] - bend * di)))
    return found


def roll(
    law: RatioLaw,
    *,
    teeth: tuple[int, int],
    center_distance: float | None,
    module: float | None,
    tolerances: Tolerances,
) -> Rolling:
    """Return the centrodes of a law at a given centre distance or module.

    Parameters
    ----------
    law : RatioLaw
        The ratio law.
    teeth : (int, int)
        Tooth counts.
    center_distance, module : float or None, mm
        Exactly one is given; the module is ``L/(pi*z)``.
    tolerances : Tolerances
        Accuracy of the arc length.

    Returns
    -------
    Rolling
        At its final size.

    Raises
    ------
    InfeasibleError
        If the ratio changes so fast that the centrodes' length cannot be computed.
    ValueError
        If not exactly one of the two sizes is given.
    """

    def unit_speed(phi: Array) -> Array:
        _, r, dr = _radii(law.ratio.derivatives(phi, 1), law.mate)
        return np.sqrt(r * r + dr * dr)

    with demand_smooth("the arc length of the centrodes"):
        unit = expand(unit_speed, law.ratio.knots, tolerances.expansion).antiderivative()
    lobes = law.lobes
    if not lobes.closed:
        unit = unit.shifted(-float(unit(0.0)))
    arc = ArcLength(unit=unit, speed=unit_speed, period=lobes.period, periodic=lobes.closed)
    length = arc.length * lobes.n1
    if center_distance is not None and module is None:
        size = center_distance
    elif module is not None and center_distance is None:
        size = module * np.pi * teeth[0] / length
    else:
        raise ValueError("give exactly one of center_distance and module")
    margin = 0.0 if lobes.closed else _MARGIN * size * length / teeth[0]
    return Rolling(law=law, arc=replace(arc, size=size), margin=margin)
