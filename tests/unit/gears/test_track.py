"""A toothing asks its track only: one made from a polar curve gives the wheel that a law gives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.cutter import choose_cutter
from gearcam.gears.flank import Toothing
from gearcam.gears.flank_ends import cross
from gearcam.gears.outline import build_outline
from gearcam.gears.rolling import roll
from gearcam.gears.spec import BasicRack
from gearcam.gears.track import ArcLength, Frames, Track
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.span import Lobes
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.chebyshev import expand
from gearcam.numeric.piecewise import extremes

E, TEETH = 0.3, 30


@dataclass(frozen=True, eq=False, kw_only=True)
class Polar(Track):
    """An ellipse about its focus, ``r = p/(1 + e*cos(theta))``, by its polar angle."""

    def _derivatives(self, theta: Array) -> tuple[Array, Array, Array]:
        below = 1.0 + E * np.cos(theta)
        p, sine, cosine = (1.0 - E * E) * self.arc.size, np.sin(theta), np.cos(theta)
        r = p / below
        slope = p * E * sine / below**2
        return r, slope, p * E * (2.0 * E * sine**2 / below + cosine) / below**2

    def _kappa(self, theta: Array) -> Array:
        r, dr, ddr = self._derivatives(theta)
        return (r * r + 2.0 * dr * dr - r * ddr) / (r * r + dr * dr) ** 1.5

    def frames(self, phi: ArrayLike, *, curved: bool = True) -> Frames:
        phi = np.asarray(phi, dtype=float)
        r, dr, _ = self._derivatives(phi)
        move = (dr + 1j * r) * np.exp(1j * phi)
        kappa = self._kappa(phi) if curved else np.empty(0)
        speed = np.abs(move)
        return Frames(
            np.asarray(r * np.exp(1j * phi), dtype=complex),
            move / speed,
            kappa,
            speed,
            self.arc_length(phi),
        )

    def rotation(self, phi: Array) -> Array:
        return phi

    def knots_between(self, low: Array, high: Array) -> tuple[Ints, Array]:
        turn = 2.0 * math.pi * np.ceil(low / (2.0 * math.pi))
        inside = np.flatnonzero(turn < high)
        return inside, turn[inside]

    @property
    def curvature_extremes(self) -> tuple[Array, Array]:
        step = 1e-6

        def curvature(phi: Array) -> tuple[Array, Array]:
            slope = (self._kappa(phi + step) - self._kappa(phi - step)) / (2.0 * step)
            return self._kappa(phi), slope

        return extremes(curvature, np.array([0.0, 2.0 * math.pi]))


def polar(half_axis: float) -> Polar:
    def speed(theta: Array) -> Array:
        below = 1.0 + E * np.cos(theta)
        r = (1.0 - E * E) / below
        return np.hypot(r, r * E * np.sin(theta) / below)

    unit = expand(speed, [0.0, 2.0 * math.pi], DEFAULT.expansion).antiderivative()
    arc = ArcLength(unit=unit, speed=speed, period=2.0 * math.pi, periodic=True, size=half_axis)
    return Polar(arc=arc, periods=1, closed=True, slides=False, turn=-1j, clockwise=False)


@pytest.mark.parametrize("rounding", [0.0, 0.3])
def test_a_polar_curve_is_toothed_as_the_centrode_of_a_law(rounding: float) -> None:
    rolling = roll(
        Ellipse(eccentricity=E).build(Lobes(1, 1), DEFAULT),
        teeth=(TEETH, TEETH),
        center_distance=None,
        module=2.0,
        tolerances=DEFAULT,
    )
    curves = rolling.tracks[0], polar(0.5 * rolling.center_distance)
    assert curves[1].length == pytest.approx(curves[0].length, rel=1e-12)
    rows = []
    for track in curves:
        cutter = choose_cutter(BasicRack(), 2.0, 0.0)
        toothing = Toothing(track=track, wheel=1, teeth=TEETH, cutter=cutter, rounding=rounding)
        rows.append(build_outline(toothing, None, 0.01, DEFAULT).rows)
    for name in ("kind", "tooth", "sigma", "start", "end"):
        np.testing.assert_allclose(getattr(rows[1], name), getattr(rows[0], name), atol=1e-9)


def test_curves_that_bend_where_they_cross_are_found() -> None:
    """Of a root of the distance Newton's whole steps lead as far to the other side, for ever."""
    target = np.array([0.1, -0.2, 0.3])
    plane: Any = SimpleNamespace(pitch=1.0, track=SimpleNamespace(length=1.0))
    plane.frames = lambda phi: SimpleNamespace(some=lambda which: phi[which])

    def bent(x: Array, _: Frames) -> tuple[Plane, Plane]:
        off = x - target
        far = np.sqrt(np.abs(off))
        return np.asarray(x + 1j * np.sign(off) * far), np.asarray(1.0 + 0.5j / far)

    def straight(x: Array, _: Frames) -> tuple[Plane, Plane]:
        return x.astype(np.complex128), np.ones(x.shape, dtype=np.complex128)

    x, y, miss = cross(plane, bent, straight, np.array([[0.4, 0.1, 0.2], [0.0, 0.0, 0.0]]), most=50)
    assert np.all(miss < 1e-6)
    np.testing.assert_allclose([x, y], [target, target], atol=1e-6)
