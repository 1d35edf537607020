"""Motion laws of cams: ``gearcam.motion_laws.Cycloidal()``.

Each gives the share S of the lift over the share phi of the cam angle. ``dir`` lists them;
``help(gearcam.motion_laws.Cycloidal)`` explains one, with an example and its source. In a design
file the key ``law`` of a rise or return names one. Ratio laws of gear pairs are in
``gearcam.laws``.

Examples
--------
>>> import gearcam as gc
>>> rise = gc.RisePhase(angle=2.0, lift=10.0, law=gc.motion_laws.Cycloidal())  # rad, mm
>>> back = gc.ReturnPhase(angle=2.0, law=gc.motion_laws.Polynomial345())
>>> roller = gc.FollowerSpec(type="roller", roller_radius=8.0)
>>> motion = (rise, back, gc.DwellPhase(angle="rest"))
>>> cam = gc.CamSpec(prime_radius=40.0)
>>> result = gc.build(gc.CamDesign(name="c", motion=motion, follower=roller, cam=cam))
>>> result.motion([1.0, 2.0])["lift_mm"].round(6)
array([ 5., 10.])
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.base.registry import Registry, classes_in, lazy_names
from gearcam.laws.entry import LawEntry

if TYPE_CHECKING:
    from gearcam.laws.motion.formula import FormulaRise as FormulaRise
    from gearcam.laws.motion.points import BSplineRise as BSplineRise
    from gearcam.laws.motion.points import TableRise as TableRise
    from gearcam.laws.motion.polynomials import Polynomial as Polynomial
    from gearcam.laws.motion.polynomials import Polynomial23 as Polynomial23
    from gearcam.laws.motion.polynomials import Polynomial345 as Polynomial345
    from gearcam.laws.motion.polynomials import Polynomial3456 as Polynomial3456
    from gearcam.laws.motion.polynomials import Polynomial4567 as Polynomial4567
    from gearcam.laws.motion.polynomials import Polynomial56789 as Polynomial56789
    from gearcam.laws.motion.scca import ModifiedSine as ModifiedSine
    from gearcam.laws.motion.scca import ModifiedTrapezoid as ModifiedTrapezoid
    from gearcam.laws.motion.scca import Scca as Scca
    from gearcam.laws.motion.simple import ConstantAcceleration as ConstantAcceleration
    from gearcam.laws.motion.simple import ConstantVelocity as ConstantVelocity
    from gearcam.laws.motion.simple import Cycloidal as Cycloidal
    from gearcam.laws.motion.simple import Harmonic as Harmonic
    from gearcam.laws.motion.simple import SineTrapezoidalVelocity as SineTrapezoidalVelocity
    from gearcam.laws.motion.simple import TrapezoidalAcceleration as TrapezoidalAcceleration
    from gearcam.laws.motion.simple import TrapezoidalVelocity as TrapezoidalVelocity


MOTION_LAWS: Final[Registry[LawEntry]] = Registry(
    "rise",
    "gearcam.laws.motion",
    {
        "simple": (
            "constant-velocity",
            "constant-acceleration",
            "harmonic",
            "cycloidal",
            "trapezoidal-velocity",
            "sine-trapezoidal-velocity",
            "trapezoidal-acceleration",
        ),
        "polynomials": ("2-3", "3-4-5", "4-5-6-7", "5-6-7-8-9", "3-4-5-6", "polynomial"),
        "scca": ("modified-trapezoid", "modified-sine", "scca"),
        "points": ("b-spline", "table"),
        "formula": ("formula",),
    },
    "motion_laws",
)
"""Motion laws by name, and the module of each."""


def _classes() -> dict[str, type]:
    return classes_in(MOTION_LAWS)


def _sources() -> dict[type, str]:
    from gearcam.laws.entry import cited

    return cited(MOTION_LAWS.values())


if not TYPE_CHECKING:  # type checkers then find misspelt names
    __getattr__, __dir__ = lazy_names("there is no rise", _classes, sources=_sources)
