"""The lift of a follower over a turn of the cam as one formula or Python function.

Refused: a lift that is not finite or smooth, does not repeat after the turn, is constant or larger
than a kilometre.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.quantities import LONGEST, TEXT, param
from gearcam.base.rules import Breach
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import TYPED, Axis
from gearcam.laws.formula import Given, formula_problems, function_of, values_of
from gearcam.laws.phases_of_lift import TURN
from gearcam.laws.program import Program, stretches_of
from gearcam.numeric.piecewise import Piece, piecewise

_VARIABLE: Final = "theta"
_WHERE: Final = "motion.lift"
_AXIS: Final = Axis(
    name="the lift",
    high=TURN,
    place=lambda x: f"{_WHERE}, theta = {formatted(math.degrees(x))} deg",
    variable=_VARIABLE,
    remedy="for such values use a motion table, whose curve has no corners",
)
_NAMES: Final = ("the lift", "its velocity", "its acceleration", "its jerk")

_PLACES: Final = 1440
"""Places at which the lift is compared, a quarter of a degree apart."""


@dataclass(frozen=True, kw_only=True)
class MotionFormula:
    """The lift over a turn as a formula in theta; derivatives are exact, by Taylor arithmetic.

    In Python it may be a function, or a tuple of a function and its first derivatives.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MotionFormula(lift="5*(1 - cos(theta))")
    MotionFormula(lift='5*(1 - cos(theta))')
    """

    lift: Given = param(
        TEXT,
        function=True,
        doc="formula in theta, rad, such as 5*(1 - cos(theta)); in millimetres, also in files in "
        "inches, or rad if oscillating",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        yield from formula_problems("lift", self.lift, _VARIABLE)

    def turn_problems(self, *, oscillating: bool) -> Iterator[Breach]:  # noqa: ARG002  (signature as of a table)
        """Yield nothing: a formula suits followers of either kind."""
        yield from ()

    def program(self, tolerances: Tolerances, *, oscillating: bool = False) -> Program:
        """Return the program of the formula.

        Parameters
        ----------
        tolerances : Tolerances
            Accuracy of the expansion of a function.
        oscillating : bool
            Whether lifts are angles, rad.

        Returns
        -------
        Program
            One piece; jumps at the end of the turn are among its jumps.

        Raises
        ------
        InfeasibleError
            If the formula is not finite or not smooth, does not repeat or is constant.
        """
        function = function_of(self.lift, _AXIS, tolerances.expansion)
        scale, unit = (math.degrees(1.0), "deg") if oscillating else (1.0, "mm")
        theta = np.linspace(0.0, TURN, _PLACES + 1)
        first = values_of(function)(theta)
        largest, far = (math.pi if oscillating else LONGEST), int(np.abs(first).argmax())
        if np.isfinite(first).all() and abs(first[far]) > largest:
            what = "the lift is too large"
            limit = scale * math.copysign(largest, first[far])
            raise beyond_limit(
                what, _AXIS.place(float(theta[far])), scale * float(first[far]), limit, unit=unit
            )
        cuts = function.demand_smooth(_NAMES)
        # two at least for each cut: the shortest wave has several, which cannot all be its zeros
        count = max(_PLACES, 2 * len(cuts))
        theta = np.linspace(0.0, TURN, count + 1)
        values = values_of(function)(theta)
        extent, size = float(np.ptp(values)), float(np.abs(values).max())
        if extent <= TYPED * size:
            raise InfeasibleError("the follower never moves", where=_WHERE)
        miss = float(values[-1] - values[0])
        if abs(miss) > TYPED * extent:
            what = "the lift does not repeat after the turn"
            note = "the limit is the lift at the start"
            raise beyond_limit(
                what, _WHERE, scale * float(values[-1]), scale * float(values[0]), note, unit=unit
            )
        lift = piecewise([0.0, TURN], [Piece(lambda x: function(x) - (miss / TURN) * x)])
        rows = theta[:-1], values[:-1], TYPED * extent, 0.5 * count
        return Program(
            lift=lift,
            stretches=stretches_of(lift, *rows),
            cuts=cuts,
            errors=function.errors,
        )
