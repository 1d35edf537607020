"""What a ratio law promises, and the registry of laws.

A law gives ``i21 = dphi2/dphi1 > 0`` and its integral ``phi2`` over one *period* of the driver:
the driver has `n1` equal lobes, the driven wheel `n2`, so that one period turns the driver by
``2*pi/n1`` and the driven wheel by ``2*pi/n2``. A law is made from its *parameters*, a frozen
dataclass with the method ``build(lobes, tolerances)``; ``LAWS.register`` puts it into the registry.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.errors import InfeasibleError
from gearcam.laws.entry import LawEntry
from gearcam.laws.span import Feed, Lobes, Span, angle_text, continued, rough
from gearcam.numeric.chebyshev import Expansion, NotSmoothError
from gearcam.numeric.piecewise import Piece, Piecewise, integrate, piecewise
from gearcam.registry import Registry
from gearcam.tolerances import Tolerances

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class RatioLaw:
    """A transmission ratio over one lobe, continued periodically, or over the way of an open pair.

    Parameters
    ----------
    lobes : Lobes or Travel
        Periods of driver and driven wheel, or how far both turn.
    ratio : Piecewise
        i21 over ``[0, lobes.period]``; of an open pair also beyond both ends.
    motion : Piecewise or Expansion
        phi2 over the same interval, rad, zero at zero.
    solved : mapping of str to float
        What was left to the program, by name.
    """

    lobes: Span
    ratio: Piecewise
    motion: Piecewise | Expansion
    solved: Mapping[str, float] = field(default_factory=dict)

    @property
    def feeds(self) -> bool:
        """Whether the driven element is a rack: the ratio is then r1, the motion its way."""
        return isinstance(self.lobes, Feed)

    @property
    def knots(self) -> Array:
        """Knots over one lobe or the way of an open pair, rad, ends included."""
        knots = self.ratio.knots
        return knots if self.lobes.closed else knots[1:-1]

    def within(self, phi1: Array) -> tuple[Array, Array]:
        """Return how many lobes lie before driver angles, and the angles within theirs, rad."""
        if not self.lobes.closed:
            return np.zeros(np.shape(phi1)), phi1
        turns = np.floor(phi1 / self.lobes.period)
        return turns, phi1 - turns * self.lobes.period

    def knots_near(self, phi1: Array) -> Array:
        """Return for each angle the place of every knot that is nearest to it: (..., n), rad.

        The ends of a lobe are one knot; the ends of an open pair, where it is continued, are two.
        """
        phi1 = np.asarray(phi1, dtype=float)[..., None]
        if not self.lobes.closed:
            return np.broadcast_to(self.knots, (*phi1.shape[:-1], len(self.knots)))
        knots, period = self.knots[:-1], self.lobes.period
        return knots + period * np.round((phi1 - knots) / period)

    def derivatives(self, phi1: ArrayLike, order: int) -> list[Array]:
        """Return ``[i, i', ..., i^(order)]`` at any driver angles `phi1`, rad."""
        return self.ratio.derivatives(self.within(np.asarray(phi1, dtype=float))[1], order)

    def phi2(self, phi1: ArrayLike) -> Array:
        """Return the driven angle, rad, at any driver angles, rad (turns are counted)."""
        turns, x = self.within(np.asarray(phi1, dtype=float))
        return self.motion(x) + turns * self.lobes.advance

    @property
    def travelled(self) -> float:
        """Driven angle over a lobe, or over the way of an open pair, rad."""
        return self.motion.last if self.lobes.closed else float(self.motion(self.lobes.period))

    @property
    def closure_error(self) -> float:
        """Miss of the driven angle over a lobe, rad."""
        return self.travelled - self.lobes.advance

    @property
    def continuity(self) -> list[tuple[int, int]]:
        """Knots by their number in ``ratio.knots``, with the ratio's order of continuity there.

        The ends of an open pair are no knots.
        """
        found = list(enumerate(self.ratio.continuity, start=1))
        return found if self.lobes.closed else found[1:-2]

    @cached_property
    def ratio_range(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Smallest and largest ratio, each as (driver angle in rad, value)."""
        closed = self.lobes.closed
        return self.ratio.extremes if closed else self.ratio.extremes_over(self.knots)

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
        first = np.append(self.motion(grid[:-1]), self.travelled)
        return float(np.abs(first - second).max()) + np.finfo(float).eps * self.lobes.advance


class LawParameters(Protocol):
    """What the parameters of a law can do."""

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`, or raise `InfeasibleError`."""
        ...


LAWS: Final[Registry[LawEntry]] = Registry(
    "law",
    {
        "gearcam.laws.phases": ("phases",),
        "gearcam.laws.programs": ("three-phase-polynomial", "multispeed", "fourier"),
        "gearcam.laws.constant": ("constant",),
        "gearcam.laws.ellipse": ("ellipse",),
        "gearcam.laws.centrodes": ("eccentric-circle", "limacon", "lobed"),
        "gearcam.laws.shapes": ("bspline", "rounded-polygon"),
        "gearcam.laws.spiral": ("log-spiral",),
        "gearcam.laws.formula": ("formula",),
        "gearcam.laws.table": ("table",),
        "gearcam.laws.motion": ("motion",),
        "gearcam.laws.rack": ("rack",),
    },
)
"""The laws by name."""


def make_law(
    lobes: Span,
    knots: ArrayLike,
    pieces: list[Piece],
    tolerances: Tolerances,
    solved: Mapping[str, float] | None = None,
) -> RatioLaw:
    """Make a law from its pieces and prove that it can drive a pair of wheels.

    Parameters
    ----------
    lobes : Lobes or Travel
        Periods, or how far an open pair turns.
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
        Positive, at least C1, closed; an open one continued beyond its ends.

    Raises
    ------
    InfeasibleError
        Where the ratio is not finite, smooth, positive or periodic, or where it does not close.
    """
    try:
        motion = integrate(knots, pieces, tolerances.expansion)
        ratio = piecewise(knots, pieces)
        _demand_positive(ratio)
        if not lobes.closed:
            longer, more = continued(ratio, pieces)
            ratio, motion = piecewise(longer, more), integrate(longer, more, tolerances.expansion)
            motion = motion.shifted(-float(motion(0.0)))
    except NotSmoothError as error:
        raise rough("the ratio", error) from error
    law = RatioLaw(lobes=lobes, ratio=ratio, motion=motion, solved=dict(solved or {}))
    _demand_smooth(law)
    if abs(law.closure_error) > tolerances.refusal:
        asks = "the tooth counts ask" if lobes.closed else "driven_travel_deg asks"
        raise InfeasibleError(
            "the law does not close" if lobes.closed else "the law misses the driven wheel's way",
            value=math.degrees(law.travelled),
            limit=math.degrees(lobes.advance),
            unit="deg",
            nearest=f"over {math.degrees(lobes.period):.10g} deg of the driver the driven wheel "
            f"turns by the first; {asks} for the second",
        )
    return law


def _demand_positive(ratio: Piecewise) -> None:
    (place, smallest), _ = ratio.extremes
    if not smallest > 0.0:
        raise InfeasibleError(
            "the ratio must stay positive: the driven wheel would stand still or turn back",
            where=angle_text(place),
            value=smallest,
            limit=0.0,
        )


def _demand_smooth(law: RatioLaw) -> None:
    for number, order in law.continuity:
        if order < 1:
            ends = number == len(law.ratio.knots) - 1
            before = law.ratio.side(number, -1, 1)
            after = law.ratio.side(0 if ends else number, 1, 1)
            name, k = ("ratio", 0) if order < 0 else ("slope of the ratio", 1)
            place = angle_text(law.ratio.knots[number])
            if not math.isfinite(before[k] + after[k]):
                raise InfeasibleError(f"the {name} has no value", where=place)
            raise InfeasibleError(
                f"the {name} {'is not periodic' if ends else 'jumps'}: it is {before[k]:.6g} "
                f"before {place} and {after[k]:.6g} {'at 0 deg' if ends else 'after it'}",
                where=place,
            )
