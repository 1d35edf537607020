"""Rises of cam followers on the unit square, and their registry.

A rise gives the lift over the whole lift, S, over the cam angle over the whole angle, phi, both
from 0 to 1; S', S'' and S''' are its velocity, acceleration and jerk. A lift program scales it to
a phase of the cam and turns it over for a return. Every rise is a piecewise analytic function with
exact derivatives, made from its *parameters*, a frozen dataclass with the method
``build(tolerances)``; ``RISES.register`` puts it into the registry.

Source: 000 section 3.3.2, eqs. (3.3)-(3.5).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from gearcam.laws.displacement import JUMP
from gearcam.laws.entry import LawEntry
from gearcam.numeric.piecewise import Piecewise, extremes
from gearcam.registry import Registry
from gearcam.tolerances import Tolerances

Array = NDArray[np.float64]

NARROWEST: Final = 1e-6
"""Least part of the angle that a sector or a step of a table may take.

It is a second of arc of the cam; the place of a knot in it is still known to 1e-10 of its width.
"""


@dataclass(frozen=True, eq=False, kw_only=True)
class Rise:
    """A rise on the unit square: S over phi in [0, 1], from 0 to 1.

    Parameters
    ----------
    function : Piecewise
        S, with knots from 0 to 1.
    mirrored : bool
        Whether the return is the rise run backwards, ``S(1 - phi)``, instead of ``1 - S(phi)``.
    cuts : (n,) array or None
        Where the search for peaks cuts the angle, if finer than at the knots.
    """

    function: Piecewise
    mirrored: bool = False
    cuts: Array | None = None

    @cached_property
    def _sides(self) -> tuple[list[list[float]], list[list[float]]]:
        """S to S''' before and after every knot, with dwells beyond the ends."""
        last = len(self.function.knots) - 1
        before = [self.function.side(knot, -1, 3) for knot in range(1, last + 1)]
        after = [self.function.side(knot, 1, 3) for knot in range(last)]
        return [[0.0, 0.0, 0.0, 0.0], *before], [*after, [1.0, 0.0, 0.0, 0.0]]

    @property
    def start(self) -> tuple[float, float, float]:
        """Velocity, acceleration and jerk at the start of the rise."""
        return _derivatives(self._sides[1][0])

    @property
    def end(self) -> tuple[float, float, float]:
        """Velocity, acceleration and jerk at the end of the rise."""
        return _derivatives(self._sides[0][-1])

    @cached_property
    def _largest(self) -> tuple[float, ...]:
        """Largest absolute S', S'' and S''' between knots."""

        def values(phi: Array) -> tuple[Array, Array]:
            found = np.array(self.function.derivatives(phi, 4))
            return found[1:4], found[2:5]

        inside = extremes(values, self.function.knots if self.cuts is None else self.cuts)
        before, after = self._sides
        at_knots = np.abs(before[1:] + after[:-1]).max(axis=0)[1:]
        return tuple(
            max(float(np.abs(found).max()), float(end))
            for (_, found), end in zip(inside, at_knots, strict=True)
        )

    @cached_property
    def continuity(self) -> int:
        """Order of continuity between dwells, -1 to 3, where 3 means at least 3.

        It counts over the knots and both ends: 0 where the velocity jumps (hard shock), 1 where the
        acceleration does (soft shock), 2 where the jerk does.
        """
        before, after = np.array(self._sides)
        scales = np.array([1.0, *self._largest])
        jumps = (np.abs(after - before) > JUMP * scales).any(axis=0)
        return int(np.argmax(np.append(jumps, True))) - 1

    @property
    def peak_velocity(self) -> float:
        """Largest absolute velocity; infinite where S jumps."""
        return self._peak(1)

    @property
    def peak_acceleration(self) -> float:
        """Largest absolute acceleration; infinite where the velocity jumps."""
        return self._peak(2)

    @property
    def peak_jerk(self) -> float:
        """Largest absolute jerk; infinite where velocity or acceleration jump."""
        return self._peak(3)

    def _peak(self, order: int) -> float:
        return self._largest[order - 1] if self.continuity >= order - 1 else math.inf


def _derivatives(side: list[float]) -> tuple[float, float, float]:
    _, velocity, acceleration, jerk = (value + 0.0 for value in side)  # -0.0 becomes 0.0
    return velocity, acceleration, jerk


class RiseParameters(Protocol):
    """What the parameters of a rise can do."""

    def build(self, tolerances: Tolerances) -> Rise:
        """Return the rise, to `tolerances`, or raise `InfeasibleError`."""
        ...


class ClosedForm(ABC):
    """Parameters of a rise in closed form: they say its function, and need no tolerance."""

    mirrored: ClassVar[bool] = False

    @abstractmethod
    def function(self) -> Piecewise:
        """S over phi."""

    def build(self, tolerances: Tolerances) -> Rise:  # noqa: ARG002  (kept for all to be alike)
        """Return the rise."""
        return Rise(function=self.function(), mirrored=self.mirrored)


RISES: Final[Registry[LawEntry]] = Registry(
    "rise",
    {
        "gearcam.laws.rise_simple": (
            "constant-velocity",
            "constant-acceleration",
            "harmonic",
            "cycloidal",
        ),
        "gearcam.laws.rise_polynomials": (
            "2-3",
            "3-4-5",
            "4-5-6-7",
            "5-6-7-8-9",
            "3-4-5-6",
            "polynomial",
        ),
        "gearcam.laws.rise_trapezoids": (
            "trapezoidal-velocity",
            "sine-trapezoidal-velocity",
            "trapezoidal-acceleration",
        ),
        "gearcam.laws.rise_scca": ("modified-trapezoid", "modified-sine", "scca"),
        "gearcam.laws.rise_points": ("b-spline", "table"),
        "gearcam.laws.rise_formula": ("formula",),
    },
)
"""The rises by name."""
