"""Motion laws: S over phi on the unit square, in the registry `rises.base.RISES`.

Their parameters are attributes: ``gearcam.rises.Cycloidal()``.

Examples
--------
>>> import gearcam as gc
>>> gc.rises.Cycloidal()
Cycloidal()
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcam.base.registry import classes_in, lazy_names

if TYPE_CHECKING:
    from gearcam.laws.rises.formula import FormulaRise
    from gearcam.laws.rises.points import BSplineRise, TableRise
    from gearcam.laws.rises.polynomials import (
        Polynomial,
        Polynomial23,
        Polynomial345,
        Polynomial3456,
        Polynomial4567,
        Polynomial56789,
    )
    from gearcam.laws.rises.scca import ModifiedSine, ModifiedTrapezoid, Scca
    from gearcam.laws.rises.simple import (
        ConstantAcceleration,
        ConstantVelocity,
        Cycloidal,
        Harmonic,
        SineTrapezoidalVelocity,
        TrapezoidalAcceleration,
        TrapezoidalVelocity,
    )

__all__ = [
    "BSplineRise", "ConstantAcceleration", "ConstantVelocity", "Cycloidal", "FormulaRise",
    "Harmonic", "ModifiedSine", "ModifiedTrapezoid", "Polynomial", "Polynomial23",
    "Polynomial345", "Polynomial3456", "Polynomial4567", "Polynomial56789", "Scca",
    "SineTrapezoidalVelocity", "TableRise", "TrapezoidalAcceleration", "TrapezoidalVelocity",
]  # fmt: skip


def _classes() -> dict[str, type]:
    from gearcam.laws.rises.base import RISES

    return classes_in(RISES)


if not TYPE_CHECKING:  # type checkers then find misspelt names
    __getattr__, __dir__ = lazy_names("there is no rise", _classes)
