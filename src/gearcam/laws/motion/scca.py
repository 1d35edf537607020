"""The family of sine-constant-cosine acceleration (SCCA), with its two best known members.

Over the first half of the rise the acceleration grows as a quarter of a sine over b/2, keeps its
peak Ca over c/2, and falls to zero as a quarter of a cosine over d/2; the second half is
symmetric. Velocities and lifts at the ends of the sectors are sums of positive terms, and Ca
makes the lift at the middle one half.

Source: R. L. Norton, the SCCA family of double-dwell
functions; Neklutin for the modified trapezoid.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gearcam.base.numerals import formatted
from gearcam.base.quantities import NUMBER, param
from gearcam.base.rules import Breach
from gearcam.laws.entry import TYPED, LawEntry
from gearcam.laws.motion.base import NARROWEST, ClosedForm
from gearcam.laws.motion.pieces import from_half, lag
from gearcam.numeric.jets import Jet, sin
from gearcam.numeric.piecewise import Piecewise


@dataclass(frozen=True, kw_only=True)
class Scca(ClosedForm):
    """Sine, constant, cosine acceleration, by the widths of its sectors.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Scca(b=0.2, c=0.5, d=0.3)
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1094, 1.0112, 4.7327]
    """

    b: float = param(NUMBER, ge=0, le=1, doc="total width of the two sine sectors")
    c: float = param(
        NUMBER, ge=0, le=1, doc="total width of the two sectors of constant acceleration"
    )
    d: float = param(NUMBER, ge=0, le=1, doc="width of the cosine sector in the middle")

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        for name in ("b", "c", "d"):
            if 0.0 < getattr(self, name) < NARROWEST:
                rule = f"0, or at least {formatted(NARROWEST)}"
                yield name, None, "this sector is too narrow", rule
        total = self.b + self.c + self.d
        if abs(total - 1.0) > TYPED:
            last = 1.0 - self.b - self.c
            hint = f"; with this b and c, d is {formatted(last, 10)}" if last >= 0.0 else ""
            yield "d", None, f"b + c + d is {formatted(total, 10)}", f"b + c + d = 1{hint}"

    def function(self) -> Piecewise:
        """S of the three sectors of the first half."""
        total = self.b + self.c + self.d
        return scca(self.b / total, self.c / total, self.d / total)


def scca(b: float, c: float, d: float) -> Piecewise:
    """Return S over phi of a member of the family.

    Parameters
    ----------
    b, c, d : float
        Widths of the sectors, at least 0, with sum 1; sectors of width zero are left out.

    Returns
    -------
    Piecewise
    """
    u, w = b / math.pi, d / math.pi
    # velocities and lifts over Ca at the ends of the first and the second sector
    v1, s1 = u, u * u * (0.5 * math.pi - 1.0)
    v2, s2 = v1 + 0.5 * c, s1 + 0.5 * c * (v1 + 0.25 * c)
    peak = 0.5 / (s2 + 0.5 * d * v2 + w * w)

    def constant(x: Jet) -> Jet:
        t = x - 0.5 * b
        return peak * (t * (0.5 * t + v1) + s1)

    def cosine(x: Jet) -> Jet:
        t = x - 0.5 * (b + c)
        wave = sin((0.5 / w) * t)
        return peak * ((2.0 * w * w) * (wave * wave) + v2 * t + s2)

    sine = (0.5 * b, lambda x: (peak * u * u) * lag((1.0 / u) * x))
    return from_half([sine, (0.5 * c, constant), (0.5 * d, cosine)])


@dataclass(frozen=True, kw_only=True)
class ModifiedTrapezoid(ClosedForm):
    """A trapezoid of acceleration with rounded flanks: b, c, d = 1/4, 1/2, 1/4.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.ModifiedTrapezoid()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1045, 1.0, 4.8881]
    """

    def function(self) -> Piecewise:
        """S over phi."""
        return scca(0.25, 0.5, 0.25)


@dataclass(frozen=True, kw_only=True)
class ModifiedSine(ClosedForm):
    """A steep and a slow sine of acceleration: b, c, d = 1/4, 0, 3/4.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.ModifiedSine()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.125, 2)]  # S, S', S'' at phi = 0.125
    [0.02, 0.4399, 5.528]
    """

    def function(self) -> Piecewise:
        """S over phi."""
        return scca(0.25, 0.0, 0.75)


ENTRIES: Final = (
    LawEntry(
        name="scca",
        example=Scca(b=0.2, c=0.5, d=0.3),
        doc="the family from harmonic to cycloidal: trades peak velocity, acceleration and jerk",
        continuity="C2 if b and d are above zero, else C1: the acceleration jumps",
        source="Norton, SCCA family of double-dwell functions",
    ),
    LawEntry(
        name="modified-trapezoid",
        example=ModifiedTrapezoid(),
        doc="low peak acceleration without a jump: high speeds with stiff followers",
        continuity="C2: the jerk jumps at both ends",
        source="Neklutin; Norton",
    ),
    LawEntry(
        name="modified-sine",
        example=ModifiedSine(),
        doc="low peak velocity and smooth torque: heavy loads, indexing tables, elastic drives",
        continuity="C2: the jerk jumps at both ends",
        source="Norton",
    ),
)
