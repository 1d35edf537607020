"""Motion laws given by a formula."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.quantities import TEXT, param
from gearcam.base.rules import Breach
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import TYPED, Axis, LawEntry
from gearcam.laws.formula import Given, formula_problems, function_of
from gearcam.laws.motion.base import MotionFunction
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import Piece, piecewise

_VARIABLE: Final = "x"
_WHERE: Final = "motion.formula"
_AXIS: Final = Axis(
    name="S",
    high=1.0,
    place=lambda x: f"{_WHERE}, x = {formatted(round(x, 5))}",
    variable=_VARIABLE,
    remedy='for such values use the law "table", whose curve has no corners',
)
_NAMES: Final = ("S", "its velocity S'", "its acceleration S''", "its jerk S'''")


@dataclass(frozen=True, kw_only=True)
class FormulaRise(ShortRepr):
    """S as a formula in x, which is phi; derivatives are exact, by Taylor arithmetic.

    In Python it may be a function, or a tuple of a function and its first derivatives.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.FormulaRise(formula="x**3*(10 - 15*x + 6*x**2)")
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1035, 1.0547, 5.625]
    """

    formula: Given = param(
        TEXT, function=True, doc="lift over x from 0 to 1, such as x**3*(10 - 15*x + 6*x**2)"
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        yield from formula_problems("formula", self.formula, _VARIABLE)

    def build(self, tolerances: Tolerances) -> MotionFunction:
        """Return the rise, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the formula is not finite or not smooth, or does not go from 0 to 1.
        """
        shape = function_of(self.formula, _AXIS, tolerances.expansion)
        cuts = shape.demand_smooth(_NAMES)
        start, end = (float(v) for v in shape(Jet.variable([0.0, 1.0], 0)).derivatives()[0])
        for place, value in ((0.0, start), (1.0, end)):
            if not abs(value - place) <= TYPED:
                what = f"the formula must give {formatted(place)} at x = {formatted(place)}"
                raise beyond_limit(
                    what, _WHERE, value, place, _from_corner_to_corner(self.formula, start, end)
                )
        scale = 1.0 / (end - start)
        piece = Piece(lambda x: (shape(x) - start) * scale)
        return MotionFunction(
            function=piecewise([0.0, 1.0], [piece]),
            cuts=cuts[1:-1].tolist(),
            errors=shape.errors,
        )


def _from_corner_to_corner(formula: Given, start: float, end: float) -> str:
    if not abs(end - start) > TYPED:
        return "it is the same at both ends"
    if not isinstance(formula, str):
        off = f"subtract {start:.17g} and " if abs(start) > TYPED else ""
        return f"{off}divide by {end - start:.17g}"
    top = f"({formula})" if start == 0.0 else f"(({formula}) - ({start:.17g}))"
    return f"this one does: {top}/({end - start:.17g})"


ENTRIES: Final = (
    LawEntry(
        name="formula",
        example=FormulaRise(formula="x - sin(2*pi*x)/(2*pi)"),
        doc="any smooth formula of S in x",
        continuity="smooth inside; at the ends as the formula is",
        source="Duca, Buium, Paraoaru, section 3.3.2, eqs. (3.3), (3.4)",
    ),
)
