"""Polynomial motion laws: the common ones, and those of lowest degree for given end conditions.

All are computed from the nearer end, with coefficients in exact rational arithmetic, so that the
conditions at both ends hold to the last digit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import numpy as np

from gearcam.base.quantities import NUMBER, Row, param
from gearcam.base.rules import Breach
from gearcam.laws.entry import LawEntry
from gearcam.laws.motion.base import ClosedForm
from gearcam.laws.motion.pieces import about, from_both_ends
from gearcam.numeric.piecewise import Piecewise, piecewise

_MOST: Final = 8
"""Most derivatives at an end: degree 17, accurate to 1e-12."""


def of_least_degree(
    start: Sequence[float], end: Sequence[float]
) -> tuple[list[Fraction], list[Fraction]]:
    """Return the polynomial of lowest degree with given derivatives at 0 and 1.

    With m and n of them it is ``A(t) + t^m*Q(t - 1)``: A has those at 0, and Q the first n powers
    of ``(B - A)*t^-m`` about 1, where B has those at 1.

    Parameters
    ----------
    start, end : sequences of float
        S, S', S'', ... at 0 and at 1, at least S.

    Returns
    -------
    about_start, about_end : list of Fraction
        Exact coefficients of the powers of phi and of ``phi - 1``.
    """
    m, n = len(start), len(end)
    first, last = (
        np.array([Fraction(v) / math.factorial(k) for k, v in enumerate([*e, *[0] * rest])])
        for e, rest in ((start, n), (end, m))
    )
    about_one = np.array(about(first.tolist(), 1))
    inverse = np.array([Fraction((-1) ** j * math.comb(m + j - 1, j)) for j in range(n)])
    power = np.array([Fraction(math.comb(m, j)) for j in range(m + 1)])
    missing = np.convolve((last - about_one)[:n], inverse)[:n]
    about_end = (about_one + np.convolve(power, missing)).tolist()
    return about(about_end, -1), about_end


class _TwoEnded(ClosedForm):
    """The polynomial of lowest degree with given S', S'', ... at both ends."""

    start: Row
    end: Row

    def function(self) -> Piecewise:
        """S over phi, one piece of degree ``len(start) + len(end) + 1`` at most."""
        left, right = of_least_degree([0.0, *self.start], [1.0, *self.end])
        return piecewise([0.0, 1.0], [from_both_ends(left, right, 0.0, 1.0)])


@dataclass(frozen=True, kw_only=True)
class Polynomial(_TwoEnded):
    """The polynomial of lowest degree with given derivatives at both ends.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Polynomial(start=(0.0, 0.0), end=(0.0, -6.0))
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.0771, 0.8086, 4.6875]
    """

    start: Row = param(
        NUMBER,
        default=(0.0, 0.0),
        ge=-1e6,
        le=1e6,
        doc="S', S'', S''', ... at the start, as many as needed",
    )
    end: Row = param(
        NUMBER,
        default=(0.0, 0.0),
        ge=-1e6,
        le=1e6,
        doc="S', S'', S''', ... at the end, as many as needed",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        for name in ("start", "end"):
            count = len(getattr(self, name))
            if count > _MOST:
                yield name, None, f"{count} derivatives are given", f"at most {_MOST} at an end"


@dataclass(frozen=True, kw_only=True)
class Polynomial23(_TwoEnded):
    """``S = 3*phi^2 - 2*phi^3``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Polynomial23()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1562, 1.125, 3.0]
    """

    start = end = (0.0,)


@dataclass(frozen=True, kw_only=True)
class Polynomial345(_TwoEnded):
    """``S = 10*phi^3 - 15*phi^4 + 6*phi^5``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Polynomial345()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1035, 1.0547, 5.625]
    """

    start = end = (0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Polynomial4567(_TwoEnded):
    """``S = 35*phi^4 - 84*phi^5 + 70*phi^6 - 20*phi^7``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Polynomial4567()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.0706, 0.9229, 7.3828]
    """

    start = end = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Polynomial56789(_TwoEnded):
    """``S = 126*phi^5 - 420*phi^6 + 540*phi^7 - 315*phi^8 + 70*phi^9``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Polynomial56789()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.0489, 0.7787, 8.3057]
    """

    start = end = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Polynomial3456(_TwoEnded):
    """``S = phi^3*(2 - phi)^3``: the first half of a rise and return in one formula.

    At the top the acceleration is -6 and the jerk 0. A return of the same law without a dwell
    continues the same polynomial, so that all derivatives are continuous at the top.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.Polynomial3456()
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.0837, 0.8613, 4.7578]
    """

    mirrored = True
    start = (0.0, 0.0)
    end = (0.0, -6.0, 0.0)


ENTRIES: Final = (
    LawEntry(
        name="2-3",
        example=Polynomial23(),
        doc="the simplest polynomial without a jump of velocity: low to medium speeds",
        continuity="C1: the acceleration jumps at both ends",
        source="Duca, Buium, Paraoaru, section 3.3.3.2, fig. 3.16",
    ),
    LawEntry(
        name="3-4-5",
        example=Polynomial345(),
        doc="the usual choice between dwells: no jump of acceleration, low peaks, easy to cut",
        continuity="C2: the jerk jumps at both ends",
        source="Duca, Buium, Paraoaru, section 3.3.3.2, fig. 3.17",
    ),
    LawEntry(
        name="4-5-6-7",
        example=Polynomial4567(),
        doc="no jump of jerk either: least vibration at high speeds, but higher peak acceleration",
        continuity="C3: smooth up to the jerk",
        source="Duca, Buium, Paraoaru, section 3.3.3.2, fig. 3.18 (peak corrected to 7.513)",
    ),
    LawEntry(
        name="5-6-7-8-9",
        example=Polynomial56789(),
        doc="smoothest at both ends: fast slender followers; highest peaks of these polynomials",
        continuity="at least C3: smooth beyond the jerk",
        source="Duca, Buium, Paraoaru, section 3.3.3.2, continued to k = 4",
    ),
    LawEntry(
        name="3-4-5-6",
        example=Polynomial3456(),
        doc="rise and return without a dwell at the top; a return of the same law must follow",
        continuity="C2 if its return follows (the jerk jumps at the bottom); C1 before a dwell",
        source="Duca, Buium, Paraoaru, section 3.3.3.2, fig. 3.19",
    ),
    LawEntry(
        name="polynomial",
        example=Polynomial(start=(), end=()),
        doc="the polynomial of lowest degree with given velocity, acceleration, ... at both ends",
        continuity="smooth inside; at the ends as given",
        source="Duca, Buium, Paraoaru, section 3.3.3.2; two-point Hermite interpolation",
    ),
)
