"""The integral of the ratio, and the inverse of the arc length, by several methods."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, quad, solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from gearcam.gears.track import ArcLength
from gearcam.numeric.chebyshev import expand
from methods import Case, Method

mp: Any = mpmath.mp
mp.dps = 50
Array = NDArray[np.float64]
TURN = 2.0 * np.pi
PLACES = np.linspace(0.0, TURN, 361)
"""Driver angles at which the driven angle is computed: every degree."""
ARCS = 31
"""Number of arc lengths at which the driver angle is computed."""
INTERVALS = (1, 2, 4, 8, 16, 32, 64, 128)
SAMPLES = (18, 36, 72, 144, 288, 576, 1152, 4608, 18432)
"""Multiples of 9, so that samples lie on the knots of the two-phase law."""
TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
OWN = "Chebyshev pieces"


@dataclass(frozen=True)
class Ratio:
    """A ratio with its derivative and integral, for numpy and mpmath."""

    name: str
    knots: Sequence[float]
    exact_knots: Callable[[], list[Any]]
    ratio: Callable[[Any, Any], Any]
    slope: Callable[[Any, Any], Any]
    driven: Callable[[Any], Any]

    def of(self, phi: Any) -> Any:
        """Return the ratio in double precision."""
        return self.ratio(phi, np)

    def speed(self, phi: Any, lib: Any = np) -> Any:
        """Return ds/dphi for unit centre distance."""
        i = self.ratio(phi, lib)
        return lib.sqrt((i / (1 + i)) ** 2 + (self.slope(phi, lib) / (1 + i) ** 2) ** 2)


def ellipse(text: str) -> Ratio:
    """Return the law of an ellipse rotating about its focus."""

    def e(lib: Any) -> Any:
        return mp.mpf(text) if lib is mp else float(text)

    def ratio(phi: Any, lib: Any) -> Any:
        return (1 - e(lib) ** 2) / (1 + e(lib) ** 2 + 2 * e(lib) * lib.cos(phi))

    def slope(phi: Any, lib: Any) -> Any:
        return ratio(phi, lib) ** 2 * 2 * e(lib) * lib.sin(phi) / (1 - e(lib) ** 2)

    def driven(phi: Any) -> Any:
        turns = mp.nint(phi / (2 * mp.pi))
        rest = phi - 2 * mp.pi * turns
        share = (1 - e(mp)) / (1 + e(mp))
        return 2 * mp.pi * turns + 2 * mp.atan2(share * mp.sin(rest / 2), mp.cos(rest / 2))

    ends = (0.0, TURN)
    return Ratio(f"ellipse {text}", ends, lambda: [mp.mpf(0), 2 * mp.pi], ratio, slope, driven)


def two_phases() -> Ratio:
    """Return the law of the nail machine: cosine arcs from 1.6 to 0.4 over 160 degrees and back."""
    knot = 8 * np.pi / 9

    def parts(phi: Any, lib: Any) -> tuple[Any, Any, Any]:
        first = 8 * lib.pi / 9
        if lib is np:
            late = np.asarray(phi) >= knot
            width = np.where(late, TURN - knot, knot)
            return np.where(late, -0.6, 0.6), width, np.where(late, phi - knot, phi)
        if phi >= first:
            return -mp.mpf(6) / 10, 2 * mp.pi - first, phi - first
        return mp.mpf(6) / 10, first, phi

    def ratio(phi: Any, lib: Any) -> Any:
        high, width, x = parts(phi, lib)
        return 1 + high * lib.cos(lib.pi * x / width)

    def slope(phi: Any, lib: Any) -> Any:
        high, width, x = parts(phi, lib)
        return -high * lib.pi / width * lib.sin(lib.pi * x / width)

    def driven(phi: Any) -> Any:
        high, width, x = parts(phi, mp)
        return phi + high * width / mp.pi * mp.sin(mp.pi * x / width)

    ends = (0.0, knot, TURN)
    return Ratio(
        "two phases", ends, lambda: [mp.mpf(0), 8 * mp.pi / 9, 2 * mp.pi], ratio, slope, driven
    )


def _stepped(rate: Any, places: Array, end: float, tolerance: float) -> Array:
    """Return the solution of an initial value problem from 0, at places."""
    relative = max(tolerance, 3e-14)  # the smallest that it accepts
    asked = {"rtol": relative, "atol": tolerance, "t_eval": places}
    return solve_ivp(rate, (0.0, float(end)), [0.0], method="DOP853", **asked).y[0]


def _arc_lengths(law: Ratio, phi: list[float]) -> Array:
    """Return arc lengths at driver angles, by Gauss quadrature in 50 digits."""
    edges = [law.exact_knots()[0], *map(mp.mpf, phi)]
    inner = law.exact_knots()[1:-1]
    arcs, total = [], mp.mpf(0)
    for low, high in pairwise(edges):
        ends = [low, *(knot for knot in inner if low < knot < high), high]
        total += mp.quadgl(lambda x: law.speed(x, mp), ends)
        arcs.append(float(total))
    return np.array(arcs)


def integral(law: Ratio) -> Case:
    """Return the case of the driven angle at every degree."""
    exact = np.array([float(law.driven(mp.mpf(phi))) for phi in PLACES.tolist()])

    def chebyshev(cuts: float) -> Array:
        return expand(law.of, law.knots, np.inf, cuts=int(cuts)).antiderivative()(PLACES)

    def own(tolerance: float) -> Array:
        return expand(law.of, law.knots, tolerance).antiderivative()(PLACES)

    def fft(count: float) -> Array:
        values = law.of(np.arange(count) * (TURN / count))
        found = np.fft.rfft(values) / count
        k = np.arange(1, len(found))
        turned = np.exp(1j * np.outer(PLACES, k)) - 1.0
        return found[0].real * PLACES + 2.0 * (turned @ (found[1:] / (1j * k))).real

    def spline(count: float) -> Array:
        grid = np.linspace(0.0, TURN, int(count) + 1)
        values = law.of(grid)
        values[-1] = values[0]
        return CubicSpline(grid, values, bc_type="periodic").antiderivative()(PLACES)

    def adaptive(tolerance: float) -> Array:
        steps = [
            quad(law.of, a, b, epsabs=tolerance, epsrel=0.0)[0]
            for a, b in zip(PLACES[:-1:10], PLACES[10::10], strict=True)
        ]
        # every tenth degree only, since it is slow
        return np.concatenate([[0.0], np.cumsum(steps)])

    def ode(tolerance: float) -> Array:
        return _stepped(lambda phi, _: [float(law.of(phi))], PLACES, TURN, tolerance)

    smooth, note = len(law.knots) == 2, "At every degree of a turn (quadrature at every tenth)"
    return Case(
        name=f"integral_{law.name.replace(' ', '_').replace('.', '')}",
        title=f"Integral of the ratio: {law.name}",
        what="the driven angle",
        unit="rad",
        methods=[
            Method(f"{OWN}, adaptive", "tolerance", (1e-15,), own),
            Method(f"{OWN}, uniform", "intervals", INTERVALS, chebyshev, 10.0),
            Method("FFT", "samples", SAMPLES[:-1], fft, None if smooth else 3.0),
            Method("cubic spline", "samples", SAMPLES, spline, 4.0 if smooth else 3.0),
            Method(
                "adaptive quadrature",
                "tolerance",
                TOLERANCES,
                adaptive,
                error=lambda made: float(np.abs(made - exact[::10]).max()),
            ),
            Method("ODE, order 8", "tolerance", TOLERANCES, ode),
        ],
        own=OWN,
        error=lambda made: float(np.abs(made - exact).max()),
        rounding=1e-14,
        note=f"{note}, against the closed form in 50 digits.",
    )


def inverse(law: Ratio) -> Case:
    """Return the case of driver angles at given arc lengths: the positions of teeth."""
    exact = TURN * (np.arange(ARCS) + 0.37) / ARCS
    s, inner = _arc_lengths(law, exact.tolist()), law.knots[1:-1]

    def length(tolerance: float, cuts: int) -> Array:
        unit = expand(law.speed, law.knots, tolerance, cuts=cuts).antiderivative()
        return ArcLength(unit=unit, speed=law.speed, period=TURN, periodic=True).angle(s)

    def table(count: float) -> Array:
        grid = np.linspace(0.0, TURN, int(count) + 1)
        return np.interp(s, cumulative_trapezoid(law.speed(grid), grid, initial=0.0), grid)

    def spline(count: float) -> Array:
        grid = np.linspace(0.0, TURN, int(count) + 1)
        along = CubicSpline(grid, law.speed(grid)).antiderivative()(grid)
        return CubicSpline(along, grid)(s)

    def roots(tolerance: float) -> Array:
        def miss(x: float, asked: float) -> float:
            return quad(law.speed, 0.0, x, epsabs=tolerance, epsrel=0.0, limit=200)[0] - asked

        return np.array([brentq(miss, 0.0, TURN, (one,), xtol=max(tolerance, 1e-14)) for one in s])

    def ode(tolerance: float) -> Array:
        return _stepped(lambda _, x: [1.0 / float(law.speed(x[0]))], s, s[-1], tolerance)

    return Case(
        name=f"inverse_{law.name.replace(' ', '_').replace('.', '')}",
        title=f"Arc length and its inverse: {law.name}",
        what="the driver angle",
        unit="rad",
        methods=[
            Method(
                f"{OWN}, adaptive",
                "tolerance",
                (1e-15,),
                lambda level: length(level, 128),
            ),
            Method(f"{OWN}, uniform", "intervals", INTERVALS, lambda n: length(np.inf, n), 10.0),
            Method("table, linear", "samples", SAMPLES, table, 2.0),
            Method("cubic splines", "samples", SAMPLES, spline, 4.0 if len(inner) == 0 else None),
            Method("quadrature and roots", "tolerance", TOLERANCES[1::4], roots),
            Method("ODE, order 8", "tolerance", TOLERANCES, ode),
        ],
        own=OWN,
        error=lambda made: float(np.abs(made - exact).max()),
        rounding=2e-14,
        note=f"The driver angles at {ARCS} arc lengths, against Gauss quadrature in 50 digits.",
    )


def cases() -> list[Case]:
    """Return both cases for a smooth law and for one with knots."""
    laws = (ellipse("0.6"), two_phases())
    return [make(law) for make in (integral, inverse) for law in laws]
