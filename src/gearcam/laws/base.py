"""What a ratio law promises, and the registry of laws.

A law gives ``i21 = dphi2/dphi1 > 0`` and its integral ``phi2`` over one *period* of the driver:
the driver has `n1` equal lobes, the driven wheel `n2`, so that one period turns the driver by
``2*pi/n1`` and the driven wheel by ``2*pi/n2``. A law is made from its *parameters*, a frozen
dataclass with the method ``build(lobes, tolerances)``; `register` hangs it in the registry
together with its claims, which one parametrised test proves for all laws.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.errors import InfeasibleError
from gearcam.numeric.chebyshev import Expansion, NotSmoothError
from gearcam.numeric.piecewise import Piece, Piecewise, extremes, integrate, piecewise
from gearcam.tolerances import Tolerances

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lobes:
    """How often the ratio repeats in a turn: n1 times of the driver, n2 of the driven wheel.

    Parameters
    ----------
    n1, n2 : int
        The tooth counts' ratio in lowest terms.
    """

    n1: int
    n2: int

    @property
    def period(self) -> float:
        """Driver angle of one lobe, rad."""
        return 2.0 * math.pi / self.n1

    @property
    def advance(self) -> float:
        """Driven angle of one lobe, rad."""
        return 2.0 * math.pi / self.n2


@dataclass(frozen=True, eq=False, kw_only=True)
class RatioLaw:
    """A transmission ratio over one lobe, continued periodically.

    Parameters
    ----------
    lobes : Lobes
        Periods of driver and driven wheel.
    ratio : Piecewise
        i21 over ``[0, lobes.period]``.
    motion : Piecewise or Expansion
        phi2 over the same interval, rad, zero at zero.
    solved : mapping of str to float
        What was left to the program, by name.
    """

    lobes: Lobes
    ratio: Piecewise
    motion: Piecewise | Expansion
    solved: Mapping[str, float] = field(default_factory=dict)

    @property
    def knots(self) -> Array:
        """Knots over one lobe, rad, ends included."""
        return self.ratio.knots

    def derivatives(self, phi1: ArrayLike, order: int) -> list[Array]:
        """Return ``[i, i', ..., i^(order)]`` at any driver angles `phi1`, rad."""
        phi1 = np.asarray(phi1, dtype=float)
        period = self.lobes.period
        return self.ratio.derivatives(phi1 - np.floor(phi1 / period) * period, order)

    def phi2(self, phi1: ArrayLike) -> Array:
        """Return the driven angle, rad, at any driver angles, rad (turns are counted)."""
        phi1 = np.asarray(phi1, dtype=float)
        turns = np.floor(phi1 / self.lobes.period)
        return self.motion(phi1 - turns * self.lobes.period) + turns * self.lobes.advance

    @property
    def closure_error(self) -> float:
        """Miss of the driven angle over a lobe, rad."""
        return self.motion.last - self.lobes.advance

    @cached_property
    def ratio_range(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Smallest and largest ratio, each as (driver angle in rad, value)."""

        def slope(x: Array) -> tuple[Array, Array]:
            value, derivative = self.ratio.derivatives(x, 1)
            return value[None], derivative[None]

        ((places, values),) = extremes(slope, self.knots)
        low, high = int(np.argmin(values)), int(np.argmax(values))
        return (float(places[low]), float(values[low])), (float(places[high]), float(values[high]))

    @cached_property
    def error(self) -> float:
        """Estimated error of phi2, rad: against Gauss-Legendre quadrature of the ratio."""
        nodes, weights = np.polynomial.legendre.leggauss(20)
        grid = np.concatenate(
            [
                np.linspace(low, high, 17)[:-1]
                for low, high in zip(self.knots[:-1], self.knots[1:], strict=True)
            ]
            + [self.knots[-1:]]
        )
        half = 0.5 * np.diff(grid)
        x = 0.5 * (grid[:-1] + grid[1:]) + half * nodes[:, None]
        second = np.concatenate([[0.0], np.cumsum(half * (weights @ self.ratio(x)))])
        first = np.append(self.motion(grid[:-1]), self.motion.last)
        return float(np.abs(first - second).max()) + np.finfo(float).eps * self.lobes.advance


class LawParameters(Protocol):
    """What the parameters of a law can do."""

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`, or raise `InfeasibleError`."""
        ...


@dataclass(frozen=True, kw_only=True)
class Claim:
    """What a law must give for an example, known in closed form and independently of the code.

    Parameters
    ----------
    parameters : LawParameters
        The example.
    lobes : Lobes
        Its lobes.
    ratio : mapping of float to float
        i21 by driver angle, rad.
    motion : mapping of float to float
        phi2, rad, by driver angle, rad.
    continuity : int
        Least order of continuity over all knots (3 means at least 3).
    """

    parameters: LawParameters
    lobes: Lobes = Lobes(1, 1)
    ratio: Mapping[float, float]
    motion: Mapping[float, float]
    continuity: int


@dataclass(frozen=True, kw_only=True)
class LawEntry:
    """A law in the registry.

    Parameters
    ----------
    name : str
        As in ``law.type``.
    parameters : type
        Dataclass with a ``build`` method.
    doc, continuity, source : str
        One line each, for people.
    claims : callable
        Returns examples with what they must give.
    """

    name: str
    parameters: type[Any]
    doc: str
    continuity: str
    source: str
    claims: Callable[[], tuple[Claim, ...]]


LAWS: Final[dict[str, LawEntry]] = {}


def register(entry: LawEntry) -> None:
    """Hang a law in the registry.

    Parameters
    ----------
    entry : LawEntry
        The law.

    Raises
    ------
    ValueError
        If its name is taken.
    """
    if entry.name in LAWS:
        raise ValueError(f"law {entry.name!r} is registered twice")
    LAWS[entry.name] = entry


def make_law(
    lobes: Lobes,
    knots: ArrayLike,
    pieces: list[Piece],
    tolerances: Tolerances,
    solved: Mapping[str, float] | None = None,
) -> RatioLaw:
    """Make a law from its pieces and prove that it can drive a pair of wheels.

    Parameters
    ----------
    lobes : Lobes
        Periods.
    knots : (n + 1,) array, rad
        From 0 to ``lobes.period``.
    pieces : list of n Piece
        i21 between the knots.
    tolerances : Tolerances
        Accuracy of expansions and closure.
    solved : mapping of str to float, optional
        What was left to the program.

    Returns
    -------
    RatioLaw
        Positive, at least C1, closed.

    Raises
    ------
    InfeasibleError
        Where the ratio is not finite, smooth, positive or periodic, or where it does not close.
    """
    try:
        motion = integrate(knots, pieces, tolerances.expansion)
    except NotSmoothError as error:
        state = "is not smooth" if error.finite else "is not finite"
        raise InfeasibleError(f"the ratio {state}", where=angle_text(error.place)) from error
    law = RatioLaw(
        lobes=lobes, ratio=piecewise(knots, pieces), motion=motion, solved=dict(solved or {})
    )
    (place, smallest), _ = law.ratio_range
    if not smallest > 0.0:
        raise InfeasibleError(
            "the ratio must stay positive: the driven wheel would stand still or turn back",
            where=angle_text(place),
            value=smallest,
            limit=0.0,
        )
    _demand_smooth(law)
    if abs(law.closure_error) > tolerances.refusal:
        raise InfeasibleError(
            "the law does not close",
            value=math.degrees(law.motion.last),
            limit=math.degrees(lobes.advance),
            unit="deg",
            nearest=f"over {math.degrees(lobes.period):.10g} deg of the driver the driven wheel "
            "turns by the first; the tooth counts ask for the second",
        )
    return law


def _demand_smooth(law: RatioLaw) -> None:
    for number, order in enumerate(law.ratio.continuity, start=1):
        if order < 1:
            ends = number == len(law.knots) - 1
            before = law.ratio.side(number, -1, 1)
            after = law.ratio.side(0 if ends else number, 1, 1)
            name, k = ("ratio", 0) if order < 0 else ("slope of the ratio", 1)
            place = angle_text(law.knots[number])
            if not math.isfinite(before[k] + after[k]):
                raise InfeasibleError(f"the {name} has no value", where=place)
            raise InfeasibleError(
                f"the {name} {'is not periodic' if ends else 'jumps'}: it is {before[k]:.6g} "
                f"before {place} and {after[k]:.6g} {'at 0 deg' if ends else 'after it'}",
                where=place,
            )


def angle_text(angle: float) -> str:
    """Return a driver angle, rad, as a place for messages."""
    return f"phi1 = {round(math.degrees(angle), 6) + 0.0:.6g} deg"
