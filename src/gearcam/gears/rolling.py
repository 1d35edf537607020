"""Two centrodes that roll on each other, and the frames on them.

Both wheels share one parameter, the driver angle `phi` (rad, any number of turns), and one arc
length ``s(phi)``: rolling gives equal lengths. At `phi` the wheel carries the *frame* of its pitch
point in its own coordinates: point P, unit tangent T (rising s), outward unit normal ``N = w*T``,
with ``w = -1j`` on wheel 1 (where s runs counter-clockwise) and ``w = +1j`` on wheel 2 (clockwise),
and the curvature kappa, so that ``dT/ds = -kappa*N`` and ``dN/ds = +kappa*T`` on both.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.laws.ratio.base import RatioLaw
from gearcam.numeric.chebyshev import Expansion, expand
from gearcam.numeric.jets import Jet, sqrt
from gearcam.numeric.piecewise import extremes
from gearcam.numeric.roots import newton_in_bracket
from gearcam.tolerances import Tolerances

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]
Wheel = Literal[1, 2]
WHEELS: tuple[Wheel, Wheel] = (1, 2)

_MARGIN = 2.0
"""Pitches beyond an open pair's end in which its last teeth are formed, fillets included."""

TURN = {1: -1j, 2: 1j}
"""N = TURN[wheel] * T."""


class Frames(NamedTuple):
    """Frames of a centrode at driver angles: arrays of one shape.

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

    def take(self, index: NDArray[np.int64] | int) -> Frames:
        """Return the frames at some places (or of one row)."""
        return Frames(
            self.p[index], self.t[index], self.kappa[index], self.speed[index], self.s[index]
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Rolling:
    """The pair of centrodes of an external pair, or of a wheel and a rack.

    Parameters
    ----------
    law : RatioLaw
        Their ratio.
    center_distance : float, mm
        Distance of the shafts, A; of a rack, what the law's radius is multiplied by.
    unit_arc : Expansion
        Arc length over one lobe for A = 1, zero at phi1 = 0; of an open pair also beyond its ends.
    margin : float, mm
        Length beyond each end of an open pair in which its teeth are formed.
    """

    law: RatioLaw
    center_distance: float
    unit_arc: Expansion
    margin: float = 0.0

    @cached_property
    def unit_length(self) -> float:
        """Length of one lobe, or of the way of an open pair, for A = 1."""
        lobes = self.law.lobes
        return self.unit_arc.last if lobes.closed else float(self.unit_arc(lobes.period))

    @property
    def shift(self) -> float:
        """Place of wheel 2's frame in that of wheel 1 at phi1 = 0, mm along x; 0 for a rack."""
        return 0.0 if self.law.feeds else self.center_distance

    @property
    def lobe_length(self) -> float:
        """Length of one lobe, mm; the same on both wheels."""
        return self.center_distance * self.unit_length

    def lobe_count(self, wheel: Wheel) -> int:
        """Return the number of lobes of a wheel."""
        return self.law.lobes.n1 if wheel == 1 else self.law.lobes.n2

    def length(self, wheel: Wheel) -> float:
        """Return the length of a wheel's centrode, mm."""
        return self.lobe_length * self.lobe_count(wheel)

    def arc_length(self, phi: ArrayLike) -> Array:
        """Return s, mm, at driver angles, rad."""
        turns, x = self.law.within(np.asarray(phi, dtype=float))
        return (self.unit_arc(x) + turns * self.unit_length) * self.center_distance

    def angle(self, s: ArrayLike) -> Array:
        """Return the driver angles, rad, at arc lengths, mm: a table, then Newton bracketed."""
        lobe, period = self.unit_length, self.law.lobes.period
        unit = np.asarray(s, dtype=float) / self.center_distance
        angles, arcs, slopes = self._table
        if self.law.lobes.closed:
            turns = np.floor(unit / lobe)
            rest = unit - turns * lobe
        else:
            turns, rest = np.zeros(unit.shape), np.clip(unit, arcs[0], arcs[-1])
        index = np.clip(np.searchsorted(arcs, rest, side="right") - 1, 0, len(arcs) - 2)
        low, high = angles[index], angles[index + 1]
        width = arcs[index + 1] - arcs[index]
        t = (rest - arcs[index]) / width
        # Hermite's cubic on the inverse: Newton then has little left to do.
        bend = (1.0 - t) * (slopes[index] * width - (high - low)) + t * (
            (high - low) - slopes[index + 1] * width
        )
        start = np.clip(low + t * (high - low) + t * (1.0 - t) * bend, low, high)

        def miss(phi: Array) -> tuple[Array, Array]:
            return self.unit_arc(phi) - rest, self._unit_speed(phi)

        pad = 1e-12 * period
        phi = newton_in_bracket(miss, low - pad, high + pad, start, 4e-16 * period)
        return phi + turns * period

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Driver angles, unit arc lengths and dphi/ds over one lobe, or all that is known."""
        angles = np.linspace(self.unit_arc.knots[0], self.unit_arc.knots[-1], 1025)
        arcs = np.append(self.unit_arc(angles[:-1]), self.unit_arc.last)
        return angles, arcs, 1.0 / self._unit_speed(angles)

    def _unit_speed(self, phi: Array) -> Array:
        return unit_speed(self.law, phi)

    def frames(self, wheel: Wheel, phi: ArrayLike, *, curved: bool = True) -> Frames:
        """Return the frames of a wheel at driver angles.

        Parameters
        ----------
        wheel : {1, 2}
            Driver or driven wheel.
        phi : array, rad
            Driver angles.
        curved : bool
            Whether the curvature is wanted; else it is an empty array, and time is saved.

        Returns
        -------
        Frames
            In the wheel's own coordinates (wheel 1: polar angle phi1; wheel 2: pi - phi2).

        Notes
        -----
        With ``q = r1' + 1j*r1`` the points move by ``q*exp(1j*phi1)`` and ``q*exp(-1j*phi2)``, so
        that the speed ``|q|`` is common to both. Curvatures from the second derivatives.
        """
        phi = np.asarray(phi, dtype=float)
        turns, x = self.law.within(phi)
        i, *radius = _radii(self.law, x, 2 if curved else 1)
        r, dr, *more = (self.center_distance * v for v in radius)
        speed = np.sqrt(r * r + dr * dr)
        way = phi if wheel == 1 else self.law.driven(x) + turns * self.law.lobes.advance
        if wheel == 2 and self.law.feeds:
            pole, point = _complex(1.0 + 0.0 * r, 0.0 * r), _complex(r, self.center_distance * way)
        else:
            turned = way if wheel == 1 else -way
            pole = _complex(np.cos(turned), np.sin(turned))
            point = (r if wheel == 1 else r - self.center_distance) * pole
        tangent = _complex(dr / speed, r / speed) * pole
        kappa = np.empty(0)
        if curved:
            (ddr,) = more
            if wheel == 1:
                top = r * r + 2.0 * dr * dr - r * ddr
            else:
                top = i * r * r + r * ddr + (i - 1.0) * dr * dr
            kappa = top / (speed * speed * speed)
        arc = (self.unit_arc(x) + turns * self.unit_length) * self.center_distance
        return Frames(point, tangent, kappa, speed, arc)

    def curvature_extremes(self, wheel: Wheel) -> tuple[Array, Array]:
        """Return a wheel's extremes of curvature over a lobe: driver angles, rad, and 1/mm."""
        return self._curvature_extremes[wheel - 1]

    @cached_property
    def _curvature_extremes(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Both wheels at once; the driven one by Euler and Savary: kappa1 + kappa2 = (1 + i)/v."""

        def curvatures(phi: Array) -> tuple[Array, Array]:
            i, di, ddi, dddi = self.law.ratio.derivatives(phi, 3)
            i0, i1, i2 = Jet([i, di]), Jet([di, ddi]), Jet([ddi, dddi])
            if self.law.feeds:
                r, dr, ddr, i0 = i0, i1, i2, 0.0 * i0
            else:
                a = 1.0 / (1.0 + i0)
                square = a * a
                r, dr, ddr = i0 * a, square * i1, square * (i2 - 2.0 * (a * i1 * i1))
            speed = sqrt(r * r + dr * dr)
            kappa = (r * r + 2.0 * (dr * dr) - r * ddr) / (speed * speed * speed)
            both = [k.derivatives() for k in (kappa, (1.0 + i0) / speed - kappa)]
            return np.stack([k[0] for k in both]), np.stack([k[1] for k in both])

        found = extremes(curvatures, self._tooth_knots)
        first, second = ((x, kappa / self.center_distance) for x, kappa in found)
        return first, second

    @property
    def _tooth_knots(self) -> Array:
        """The knots between which teeth are formed, ends included."""
        if self.law.lobes.closed:
            return self.law.knots
        low, high = self.angle(np.array([-self.margin, self.lobe_length + self.margin]))
        return np.concatenate([[low], self.law.knots, [high]])

    @cached_property
    def arc_error(self) -> float:
        """Estimated error of arc lengths, mm: truncated expansions, and rounding over a turn."""
        return self.center_distance * self.unit_arc.error + 4.0 * np.finfo(float).eps * max(
            self.length(1), self.length(2)
        )


def _complex(real: Array, imag: Array) -> Plane:
    """Return ``real + 1j*imag`` without the products."""
    result = np.empty(np.shape(real), dtype=np.complex128)
    result.real, result.imag = real, imag
    return result


def unit_speed(law: RatioLaw, phi: Array) -> Array:
    """Return ds/dphi for unit centre distance at driver angles within the first lobe.

    Parameters
    ----------
    law : RatioLaw
        The ratio law.
    phi : array, rad
        Driver angles in ``[0, period]``.

    Returns
    -------
    array
        ``sqrt(r1^2 + r1'^2)/A``.
    """
    _, r, dr = _radii(law, phi, 1)
    return np.sqrt(r * r + dr * dr)


def _radii(law: RatioLaw, x: Array, order: int) -> list[Array]:
    """Return the ratio (0 on a rack) and r1 for unit size with `order` derivatives."""
    i, di, *more = law.ratio.derivatives(x, order)
    if law.feeds:
        return [np.zeros(np.shape(i)), i, di, *more]
    a = 1.0 / (1.0 + i)
    square = a * a
    return [i, i * a, square * di, *(square * (ddi - 2.0 * a * di * di) for ddi in more)]


def roll(
    law: RatioLaw,
    *,
    teeth: tuple[int, int],
    center_distance: float | None,
    module: float | None,
    tolerances: Tolerances,
) -> Rolling:
    """Roll the centrodes of a law at a given centre distance or module.

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
    ValueError
        If not exactly one of the two sizes is given.
    """
    arc = expand(lambda phi: unit_speed(law, phi), law.ratio.knots, tolerances.expansion)
    unit_arc = arc.antiderivative()
    if not law.lobes.closed:
        unit_arc = unit_arc.shifted(-float(unit_arc(0.0)))
    rolling = Rolling(law=law, center_distance=1.0, unit_arc=unit_arc)
    if center_distance is not None and module is None:
        size = center_distance
    elif module is not None and center_distance is None:
        size = module * np.pi * teeth[0] / rolling.length(1)
    else:
        raise ValueError("give exactly one of center_distance and module")
    margin = 0.0 if law.lobes.closed else _MARGIN * size * rolling.length(1) / teeth[0]
    return replace(rolling, center_distance=size, margin=margin)
