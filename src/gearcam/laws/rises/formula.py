"""Rises by formula."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.display import Brief
from gearcam.errors import InfeasibleError
from gearcam.laws.entry import TYPED, LawEntry
from gearcam.laws.formula import compiled, formula_problems
from gearcam.laws.rises.base import RISES, Rise
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import NotSmoothError, expand
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import Piece, piecewise
from gearcam.quantities import TEXT, param
from gearcam.tolerances import Tolerances

_ODD_PLACE: Final = 0.3819660112501052
"""Where the search for corners is cut first: a corner at a round place then lies inside a part."""

_VARIABLE: Final = "x"
_WHERE: Final = "motion.formula"
_NAMES: Final = ("S", "its velocity S'", "its acceleration S''", "its jerk S'''")


@dataclass(frozen=True, kw_only=True)
class FormulaRise(Brief):
    """S as a formula in x, which is phi; derivatives are exact, by Taylor arithmetic."""

    formula: str = param(TEXT, doc="S over x from 0 to 1, such as x**3*(10 - 15*x + 6*x**2)")

    def problems(self) -> Iterator[tuple[str, int | None, str, str]]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        yield from formula_problems("formula", self.formula, _VARIABLE)

    def build(self, tolerances: Tolerances) -> Rise:
        """Return the rise, to `tolerances`.

        Raises
        ------
        InfeasibleError
            Where the formula is not finite or not smooth, or does not go from 0 to 1.
        """
        shape = compiled(self.formula, _VARIABLE)
        cuts = _demand_smooth(shape, tolerances)
        start, end = (float(v) for v in shape(Jet.variable([0.0, 1.0], 0)).derivatives()[0])
        for place, value in ((0.0, start), (1.0, end)):
            if not abs(value - place) <= TYPED:
                raise InfeasibleError(
                    f"the formula must give {shown(place)} at x = {shown(place)}",
                    where=_WHERE,
                    value=value,
                    limit=place,
                    nearest=_from_corner_to_corner(self.formula, start, end),
                )
        scale = 1.0 / (end - start)
        piece = Piece(lambda x: (shape(x) - start) * scale)
        return Rise(function=piecewise([0.0, 1.0], [piece]), cuts=cuts[1:-1].tolist())


def _from_corner_to_corner(formula: str, start: float, end: float) -> str:
    if not abs(end - start) > TYPED:
        return "it is the same at both ends"
    top = f"({formula})" if start == 0.0 else f"(({formula}) - ({start:.17g}))"
    return f"this one does: {top}/({end - start:.17g})"


def _demand_smooth(shape: Callable[[Jet], Jet], tolerances: Tolerances) -> Array:
    """Refuse a formula that has no jerk, or a rough one; return the places that show its peaks."""
    *_, cuts = [_cuts(shape, order, tolerances) for order in range(len(_NAMES))]
    ends = np.array(shape(Jet.variable([0.0, 1.0], len(_NAMES))).derivatives())
    for place, found in zip((0.0, 1.0), ends.T, strict=True):
        if not np.isfinite(found).all():
            order = int(np.argmin(np.isfinite(found)))
            raise InfeasibleError(
                f"{(*_NAMES, 'the derivative of its jerk')[order]} cannot be computed",
                where=f"{_WHERE}, x = {shown(place)}",
                nearest="roots of zero and powers of zero that are not whole have no derivatives",
            )
    return cuts


def _cuts(shape: Callable[[Jet], Jet], order: int, tolerances: Tolerances) -> Array:
    """Return the knots that an expansion of a derivative needs."""

    def values(x: Array) -> Array:
        # with 1 added, the rounding of a derivative that is zero does not count as rough
        return 1.0 + shape(Jet.variable(x, order)).derivatives()[order]

    try:
        return expand(values, [0.0, _ODD_PLACE, 1.0], tolerances.expansion).knots
    except NotSmoothError as error:
        state = "smooth" if error.finite else "finite"
        place = f"{_WHERE}, x = {shown(round(error.place, 5))}"
        raise InfeasibleError(f"{_NAMES[order]} is not {state}", where=place) from error


RISES.register(
    LawEntry(
        name="formula",
        example=FormulaRise(formula="x - sin(2*pi*x)/(2*pi)"),
        doc="any smooth formula of S in x: a law of your own",
        continuity="smooth inside; at the ends what the formula gives",
        source="000 section 3.3.2, eqs. (3.3), (3.4)",
    )
)
