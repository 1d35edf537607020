"""Ratio laws of gear pairs: a module for each idea, and where each law stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.base.registry import Registry
from gearcam.laws.entry import LawEntry

if TYPE_CHECKING:
    from gearcam.laws.ratio.centrodes import EccentricCircle as EccentricCircle
    from gearcam.laws.ratio.centrodes import Limacon as Limacon
    from gearcam.laws.ratio.centrodes import Lobed as Lobed
    from gearcam.laws.ratio.centrodes import LogSpiral as LogSpiral
    from gearcam.laws.ratio.composite import Fourier as Fourier
    from gearcam.laws.ratio.composite import Multispeed as Multispeed
    from gearcam.laws.ratio.composite import ThreePhasePolynomial as ThreePhasePolynomial
    from gearcam.laws.ratio.constant import Constant as Constant
    from gearcam.laws.ratio.ellipse import Ellipse as Ellipse
    from gearcam.laws.ratio.formula import Formula as Formula
    from gearcam.laws.ratio.formula import RackLaw as RackLaw
    from gearcam.laws.ratio.phases import Phases as Phases
    from gearcam.laws.ratio.position import MotionLaw as MotionLaw
    from gearcam.laws.ratio.shapes import BSplineLaw as BSplineLaw
    from gearcam.laws.ratio.shapes import RoundedPolygon as RoundedPolygon
    from gearcam.laws.ratio.table import TableLaw as TableLaw

LAWS: Final[Registry[LawEntry]] = Registry(
    "law",
    "gearcam.laws.ratio",
    {
        "phases": ("phases",),
        "composite": ("three-phase-polynomial", "multispeed", "fourier"),
        "constant": ("constant",),
        "ellipse": ("ellipse",),
        "centrodes": ("eccentric-circle", "limacon", "lobed", "log-spiral"),
        "shapes": ("bspline", "rounded-polygon"),
        "formula": ("formula", "rack"),
        "table": ("table",),
        "position": ("motion",),
    },
    "ratio_laws",
)
"""Ratio laws by name, and the module of each."""
