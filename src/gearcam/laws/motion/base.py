"""Motion laws of rises on the unit square.

A rise gives the lift over the whole lift, S, over the cam angle over the whole angle, phi, both
from 0 to 1; S', S'' and S''' are its velocity, acceleration and jerk. A lift program scales it to
a phase of the cam and mirrors it for a return. Every rise is a piecewise analytic function with
exact derivatives, made from its *parameters*, a frozen dataclass with the method
``build(tolerances)``; its module has it among its ``ENTRIES``.

Source: 000 section 3.3.2, eqs. (3.3)-(3.5).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Final, Protocol

from gearcam.base.display import ShortRepr
from gearcam.base.tolerances import Tolerances
from gearcam.laws.displacement import EXACT
from gearcam.numeric.piecewise import Piecewise

NARROWEST: Final = 1e-4
"""Smallest share of the angle for a sector."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MotionFunction:
    """A rise on the unit square: S over phi in [0, 1], from 0 to 1.

    Parameters
    ----------
    function : Piecewise
        S, with knots from 0 to 1.
    mirrored : bool
        Whether the return is the rise run backwards, ``S(1 - phi)``, instead of ``1 - S(phi)``.
    cuts : sequence of float
        Further places, besides the knots, at which it bends sharply: peaks are searched between.
    errors : (float, float, float, float)
        Estimated errors of S, S', S'' and S''' beyond rounding.
    """

    function: Piecewise
    mirrored: bool = False
    cuts: Sequence[float] = ()
    errors: tuple[float, ...] = EXACT


class MotionLawParameters(Protocol):
    """Parameters of a rise."""

    def build(self, tolerances: Tolerances) -> MotionFunction:
        """Return the rise, to `tolerances`, or raise `InfeasibleError`."""
        ...


class ClosedForm(ShortRepr, ABC):
    """Parameters of a rise whose function is a closed form without tolerance."""

    mirrored: ClassVar[bool] = False

    @abstractmethod
    def function(self) -> Piecewise:
        """S over phi."""

    def build(self, tolerances: Tolerances) -> MotionFunction:  # noqa: ARG002  (same signature for all)
        """Return the rise."""
        return MotionFunction(function=self.function(), mirrored=self.mirrored)
