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
    from gearcam.laws.rises.formula import FormulaRise as FormulaRise
    from gearcam.laws.rises.points import BSplineRise as BSplineRise
    from gearcam.laws.rises.points import TableRise as TableRise
    from gearcam.laws.rises.polynomials import Polynomial as Polynomial
    from gearcam.laws.rises.polynomials import Polynomial23 as Polynomial23
    from gearcam.laws.rises.polynomials import Polynomial345 as Polynomial345
    from gearcam.laws.rises.polynomials import Polynomial3456 as Polynomial3456
    from gearcam.laws.rises.polynomials import Polynomial4567 as Polynomial4567
    from gearcam.laws.rises.polynomials import Polynomial56789 as Polynomial56789
    from gearcam.laws.rises.scca import ModifiedSine as ModifiedSine
    from gearcam.laws.rises.scca import ModifiedTrapezoid as ModifiedTrapezoid
    from gearcam.laws.rises.scca import Scca as Scca
    from gearcam.laws.rises.simple import ConstantAcceleration as ConstantAcceleration
    from gearcam.laws.rises.simple import ConstantVelocity as ConstantVelocity
    from gearcam.laws.rises.simple import Cycloidal as Cycloidal
    from gearcam.laws.rises.simple import Harmonic as Harmonic
    from gearcam.laws.rises.simple import SineTrapezoidalVelocity as SineTrapezoidalVelocity
    from gearcam.laws.rises.simple import TrapezoidalAcceleration as TrapezoidalAcceleration
    from gearcam.laws.rises.simple import TrapezoidalVelocity as TrapezoidalVelocity


def _classes() -> dict[str, type]:
    from gearcam.laws.rises.base import RISES

    return classes_in(RISES)


if not TYPE_CHECKING:  # type checkers then find misspelt names
    __getattr__, __dir__ = lazy_names("there is no rise", _classes)
