"""Polynomial rises: the textbook's, and those of least degree for any conditions at both ends.

All are computed from the nearer end, with coefficients in exact rational arithmetic, so that what
is asked at either end holds to the last digit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, Final

from gearcam.laws.rise_pieces import from_both_ends, product, shifted, total
from gearcam.laws.rises import RISES, ClosedForm, RiseClaim, RiseEntry
from gearcam.numeric.piecewise import Piecewise, piecewise
from gearcam.quantities import NUMBER, param

_MOST: Final = 8
"""Most derivatives at an end: degree 17, whose coefficients still add up to 1e-12."""


def of_least_degree(
    start: Sequence[float], end: Sequence[float]
) -> tuple[list[Fraction], list[Fraction]]:
    """Return the polynomial of least degree with given derivatives at 0 and 1.

    With m and n of them it is ``A(t) + t^m*Q(t - 1)``: A has those at 0, and Q the first n powers
    of ``(B - A)*t^-m`` about 1, where B has those at 1.

    Parameters
    ----------
    start, end : sequences of float
        S, S', S'', ... at 0 and at 1, at least S.

    Returns
    -------
    about_start, about_end : list of Fraction
        Its exact coefficients of the powers of phi and of ``phi - 1``.
    """
    m, n = len(start), len(end)
    given = [[Fraction(v) / math.factorial(k) for k, v in enumerate(e)] for e in (start, end)]
    known = shifted(given[0], 1)
    missing = total(given[1], [-value for value in known])[:n]
    inverse = [Fraction((-1) ** j * math.comb(m + j - 1, j)) for j in range(n)]
    power = [Fraction(math.comb(m, j)) for j in range(m + 1)]
    about_end = total(known, product(power, product(missing, inverse)[:n]))
    return shifted(about_end, -1), about_end


def two_ended(start: Sequence[float], end: Sequence[float]) -> Piecewise:
    """Return the polynomial rise of least degree.

    Parameters
    ----------
    start, end : sequences of float
        S', S'', ... at 0 and at 1.

    Returns
    -------
    Piecewise
        S over phi, one piece.
    """
    left, right = of_least_degree([0.0, *start], [1.0, *end])
    return piecewise([0.0, 1.0], [from_both_ends(left, right, 0.0, 1.0)])


@dataclass(frozen=True, kw_only=True)
class Polynomial(ClosedForm):
    """The polynomial of least degree with given derivatives at both ends."""

    start: tuple[float, ...] = param(
        NUMBER,
        default=(0.0, 0.0),
        ge=-1e6,
        le=1e6,
        doc="S', S'', S''', ... at the start, as many as are asked for",
    )
    end: tuple[float, ...] = param(
        NUMBER,
        default=(0.0, 0.0),
        ge=-1e6,
        le=1e6,
        doc="S', S'', S''', ... at the end, as many as are asked for",
    )

    def problems(self) -> Iterator[tuple[str, int | None, str, str]]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        for name in ("start", "end"):
            count = len(getattr(self, name))
            if count > _MOST:
                yield name, None, f"{count} derivatives are given", f"at most {_MOST} at an end"

    def function(self) -> Piecewise:
        """S over phi, one piece of degree ``len(start) + len(end) + 1`` at most."""
        return two_ended(self.start, self.end)


class _Textbook(ClosedForm):
    """A polynomial whose derivatives at the ends are fixed."""

    start: ClassVar[tuple[float, ...]]
    end: ClassVar[tuple[float, ...]]

    def function(self) -> Piecewise:
        """S over phi."""
        return two_ended(self.start, self.end)


@dataclass(frozen=True, kw_only=True)
class Polynomial23(_Textbook):
    """``S = 3*phi^2 - 2*phi^3``."""

    start = end = (0.0,)


@dataclass(frozen=True, kw_only=True)
class Polynomial345(_Textbook):
    """``S = 10*phi^3 - 15*phi^4 + 6*phi^5``."""

    start = end = (0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Polynomial4567(_Textbook):
    """``S = 35*phi^4 - 84*phi^5 + 70*phi^6 - 20*phi^7``."""

    start = end = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Polynomial56789(_Textbook):
    """``S = 126*phi^5 - 420*phi^6 + 540*phi^7 - 315*phi^8 + 70*phi^9``."""

    start = end = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Polynomial3456(_Textbook):
    """``S = phi^3*(2 - phi)^3``: the first half of a rise and return in one formula.

    At the top the acceleration is -6 and the jerk 0. The return of the same law that follows
    without a dwell goes down the same curve, so that all derivatives go on across the top.
    """

    mirrored = True
    start = (0.0, 0.0)
    end = (0.0, -6.0, 0.0)


def _claim(
    parameters: ClosedForm, powers: dict[int, float], peaks: tuple[float, float, float], order: int
) -> RiseClaim:
    """Return the claim of a polynomial with the coefficients of its `powers`."""
    places = (0.0, 0.125, 0.25, 0.5, 0.75, 1.0)
    return RiseClaim(
        parameters=parameters,
        values={x: sum(c * x**k for k, c in powers.items()) for x in places},
        velocities={x: sum(k * c * x ** (k - 1) for k, c in powers.items()) for x in places},
        peak_velocity=peaks[0],
        peak_acceleration=peaks[1],
        peak_jerk=peaks[2],
        continuity=order,
    )


def _claims_23() -> tuple[RiseClaim, ...]:
    return (_claim(Polynomial23(), {2: 3, 3: -2}, (1.5, 6.0, math.inf), 1),)


def _claims_345() -> tuple[RiseClaim, ...]:
    powers = {3: 10.0, 4: -15.0, 5: 6.0}
    return (_claim(Polynomial345(), powers, (1.875, 10 / math.sqrt(3), 60.0), 2),)


def _claims_4567() -> tuple[RiseClaim, ...]:
    powers = {4: 35.0, 5: -84.0, 6: 70.0, 7: -20.0}
    return (_claim(Polynomial4567(), powers, (2.1875, 84 * math.sqrt(5) / 25, 52.5), 3),)


def _claims_56789() -> tuple[RiseClaim, ...]:
    """``S'' = 2520*(phi*(1 - phi))^3*(1 - 2*phi)`` is largest where ``(phi - 1/2)^2 = 1/28``."""
    powers = {5: 126.0, 6: -420.0, 7: 540.0, 8: -315.0, 9: 70.0}
    peaks = (630 / 256, 2520 * (3 / 14) ** 3 / math.sqrt(7), 78.75)
    return (_claim(Polynomial56789(), powers, peaks, 3),)


def _claims_3456() -> tuple[RiseClaim, ...]:
    """``S' = 6*w*(1 - w^2)^2`` with ``w = 1 - phi`` is largest where ``w^2 = 1/5``."""
    powers = {3: 8.0, 4: -12.0, 5: 6.0, 6: -1.0}
    return (_claim(Polynomial3456(), powers, (96 * math.sqrt(5) / 125, 6.0, math.inf), 1),)


def _claims_polynomial() -> tuple[RiseClaim, ...]:
    """No condition: a line. A dwell, then leaving at speed 2: ``4*phi^3 - 3*phi^4`` by hand."""
    line = _claim(Polynomial(start=(), end=()), {1: 1.0}, (1.0, math.inf, math.inf), 0)
    # S(1) = 1, S'(1) = 2 of a*phi^3 + b*phi^4: a = 2, b = -1; S'' = 12*phi*(1 - phi)
    leaving = _claim(
        Polynomial(start=(0.0, 0.0), end=(2.0,)), {3: 2.0, 4: -1.0}, (2.0, math.inf, math.inf), 0
    )
    smooth = {4: 35.0, 5: -84.0, 6: 70.0, 7: -20.0}
    dwells = Polynomial(start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 0.0))
    return (line, leaving, _claim(dwells, smooth, (2.1875, 84 * math.sqrt(5) / 25, 52.5), 3))


RISES.hang(
    RiseEntry(
        name="2-3",
        parameters=Polynomial23,
        doc="the simplest smooth start and stop; slow to medium speeds",
        continuity="C1: the acceleration jumps at both ends",
        source="000 section 3.3.3.2, fig. 3.16",
        claims=_claims_23,
    )
)
RISES.hang(
    RiseEntry(
        name="3-4-5",
        parameters=Polynomial345,
        doc="the usual choice between dwells: no jump of acceleration, low peaks, easy to cut",
        continuity="C2: the jerk jumps at both ends",
        source="000 section 3.3.3.2, fig. 3.17",
        claims=_claims_345,
    )
)
RISES.hang(
    RiseEntry(
        name="4-5-6-7",
        parameters=Polynomial4567,
        doc="no jump of jerk either: least vibration at high speeds, for a higher acceleration",
        continuity="C3: smooth up to the jerk",
        source="000 section 3.3.3.2, fig. 3.18 (its peak of 7.52 is 7.513)",
        claims=_claims_4567,
    )
)
RISES.hang(
    RiseEntry(
        name="5-6-7-8-9",
        parameters=Polynomial56789,
        doc="smoother still at both ends, for slender fast followers; highest peaks of its kind",
        continuity="at least C3: smooth beyond the jerk",
        source="000 section 3.3.3.2, carried on to k = 4",
        claims=_claims_56789,
    )
)
RISES.hang(
    RiseEntry(
        name="3-4-5-6",
        parameters=Polynomial3456,
        doc="rise and return without a dwell at the top: the return of the same law must follow",
        continuity="C2 with its return (the jerk jumps at the bottom); against a dwell above only "
        "C1",
        source="000 section 3.3.3.2, fig. 3.19",
        claims=_claims_3456,
    )
)
RISES.hang(
    RiseEntry(
        name="polynomial",
        parameters=Polynomial,
        doc="speed, acceleration and more given at both ends; the polynomial of least degree",
        continuity="smooth inside; at the ends what is asked for",
        source="000 section 3.3.3.2; two-point Hermite interpolation",
        claims=_claims_polynomial,
    )
)
