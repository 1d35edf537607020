"""How far a law reaches: lobes of a closed pair, or the travel of an open one with its ends.

A closed law repeats. An open one is continued beyond both ends, since the teeth there roll beyond
them: by the logarithmic spiral that goes on with the end's ratio and slope (a circle where the
slope is zero), so that the centrode has no corner.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Final

import numpy as np

from gearcam.errors import InfeasibleError, Way
from gearcam.laws.entry import NO_JUMPS
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import NotSmoothError
from gearcam.numeric.jets import Jet, exp, log
from gearcam.numeric.piecewise import Piece, Piecewise
from gearcam.quantities import ANGLE, param

_FLAT = 1e-9
"""Growth of the radius in a radian below which the continued centrode is a circle: rounding."""

_CLOSED_FORM = 1e-3
"""Growth from which the closed form of the spiral's driven angle is better than an expansion."""

SAME: Final = 1e-12
"""Distance of knots, rad, below which they are one: the rounding of a few sums."""

PLACES: Final = 2049
"""Places over a period, ends included, at which functions are first asked for values to refuse."""

_LARGEST: Final = 1e4
"""How many times as far as the other wheel one of an open pair may turn."""

_ROOM = 0.9
"""Largest share of the room to either shaft that a continued centrode may use."""


WHEEL: Final = 1
RACK: Final = 0
RING: Final = -1
"""What the driver rolls on, w in ``r1 = A*i/(1 + w*i)``: an external wheel, a rack, a ring."""


@dataclass(frozen=True)
class Lobes:
    """How often the ratio repeats in a turn: n1 times of the driver, n2 of the driven wheel.

    Parameters
    ----------
    n1, n2 : int
        The tooth counts' ratio in lowest terms.
    mate : {WHEEL, RING}
        What the driver rolls on.
    """

    n1: int
    n2: int
    mate: int = WHEEL
    closed: ClassVar[bool] = True

    @property
    def period(self) -> float:
        """Driver angle of one lobe, rad."""
        return 2.0 * math.pi / self.n1

    @property
    def advance(self) -> float:
        """Driven angle of one lobe, rad."""
        return 2.0 * math.pi / self.n2


@dataclass(frozen=True)
class Travel:
    """The travel of an open pair.

    Parameters
    ----------
    period, advance : float, rad
        How far the driver and the driven wheel turn.
    mate : {WHEEL, RING}
        What the driver rolls on.
    """

    period: float
    advance: float
    mate: int = WHEEL
    n1: ClassVar[int] = 1
    n2: ClassVar[int] = 1
    closed: ClassVar[bool] = False


@dataclass(frozen=True)
class RackTravel(Travel):
    """A wheel that drives a rack, turning for ever; the rack is as long as its teeth.

    Parameters
    ----------
    period : float, rad
        A turn of the wheel.
    advance : float
        The rack's travel in a turn, in the scale of the wheel's radius.
    mate : {RACK}
        Nothing else.
    """

    mate: int = RACK
    closed: ClassVar[bool] = True


ONE_LOBE: Final = Lobes(1, 1)
"""Of equal tooth counts."""

Span = Lobes | Travel
"""Closed, open, or closed on a rack."""


def demand_equal(lobes: Lobes) -> None:
    """Refuse an open pair with unequal tooth counts: both centrodes have the same length.

    Parameters
    ----------
    lobes : Lobes
        Of the tooth counts.

    Raises
    ------
    InfeasibleError
        If they are unequal.
    """
    if replace(lobes, mate=WHEEL) != ONE_LOBE:
        raise InfeasibleError(
            "an open pair has equal tooth counts: its centrodes are equally long",
            where="pair.teeth",
            value=lobes.n1 / lobes.n2,
            limit=1.0,
            nearest="this is the ratio of the counts",
        )


def demand_travels(span: Span) -> None:
    """Refuse a ring that turns as far as its wheel, and wheels that would be racks beside others.

    Parameters
    ----------
    span : Lobes or Travel
        How far both turn.

    Raises
    ------
    InfeasibleError
        Naming the driven wheel's travel.
    """
    key, mean = "law.driven_travel_deg", span.advance / span.period
    if not (span.closed or span.mate == RACK or 1.0 / _LARGEST <= mean <= _LARGEST):
        limit = math.degrees(span.period) * (1.0 / _LARGEST if mean < 1.0 else _LARGEST)
        raise InfeasibleError(
            "one wheel turns so little beside the other that it would be a rack",
            where=key,
            value=math.degrees(span.advance),
            limit=limit,
            unit="deg",
            nearest=f"one turns at most {shown(_LARGEST)} times as far as the other",
            ways=(Way(near={key: limit}, far={key: math.degrees(span.period)}),),
        )
    if span.mate == RING and not span.advance < span.period:
        most = math.degrees(span.period)
        raise InfeasibleError(
            "a ring turns less than its wheel",
            where="pair.teeth" if span.closed else key,
            value=math.degrees(span.advance),
            limit=most,
            unit="deg",
            nearest="the limit is how far the driver turns",
            ways=() if span.closed else (Way(near={key: most}, far={key: 0.1 * most}),),
        )


def demand_below_one(
    largest: float, where: str, mean: float = 1.0, ways: Sequence[Way] = ()
) -> None:
    """Refuse a ratio of an internal pair that is not below 1.

    Parameters
    ----------
    largest : float
        The largest ratio.
    where : str
        Its place.
    mean : float
        The mean that closure asks for, where it is told.
    ways : sequence of Way
        Changes that may help.

    Raises
    ------
    InfeasibleError
        Naming how much less the ratio may swing about its mean.
    """
    if not largest < 1.0:
        nearest = "the wheel would be as large as its ring"
        if mean < 1.0:
            share = shown((1.0 - mean) / (largest - mean))
            nearest += (
                f"; about the mean of {shown(mean)}, which closure asks for, the ratio may swing "
                f"less than {share} times as far"
            )
        raise InfeasibleError(
            "the ratio of an internal pair must stay below 1",
            where=where,
            value=largest,
            limit=1.0,
            nearest=nearest,
            ways=ways,
        )


def span_of(lobes: Lobes, driver_travel: float | None, driven_travel: float | None) -> Span:
    """Return the travel of an open pair where it is given for both wheels, else the lobes.

    Parameters
    ----------
    lobes : Lobes
        Of the tooth counts.
    driver_travel, driven_travel : float or None, rad
        Both or none.

    Returns
    -------
    Lobes or Travel

    Raises
    ------
    InfeasibleError
        For an open pair of unequal tooth counts.
    """
    if driver_travel is None or driven_travel is None:
        return lobes
    demand_equal(lobes)
    return Travel(driver_travel, driven_travel, lobes.mate)


def travel_problems(
    driver_travel: float | None, driven_travel: float | None
) -> Iterator[tuple[str, int | None, str, str]]:
    """Yield what is wrong where one of two travels is given alone: field, index, message, allowed.

    Parameters
    ----------
    driver_travel, driven_travel : float or None, rad
        As the design says.

    Yields
    ------
    tuple
        For a law's ``problems``.
    """
    if (driver_travel is None) != (driven_travel is None):
        missing = "driven_travel" if driven_travel is None else "driver_travel"
        rule = "driver_travel_deg and driven_travel_deg for an open pair, neither for a closed one"
        yield missing, None, "is missing beside the other travel", rule


@contextmanager
def demand_smooth(name: str) -> Iterator[None]:
    """Refuse what turns out inside not to be smooth, or not finite, over the driver angle.

    Parameters
    ----------
    name : str
        What it is.

    Yields
    ------
    None

    Raises
    ------
    InfeasibleError
        With the place.
    """
    try:
        yield
    except NotSmoothError as error:
        state = "is not smooth" if error.finite else "is not finite"
        nearest = NO_JUMPS if error.finite else ""
        where = angle_text(error.place)
        raise InfeasibleError(f"{name} {state}", where=where, nearest=nearest) from error


def open_travel(wheel: str) -> Any:
    """Return the optional parameter of a law for the travel of a `wheel` (see `param`)."""
    doc = f"how far the {wheel} of an open pair turns"
    return param(ANGLE, default=None, gt=0, le=360, doc=doc)


def angle_text(angle: float) -> str:
    """Return a driver angle, rad, as a place for messages."""
    return f"phi1 = {shown(round(math.degrees(angle), 6) + 0.0)} deg"


def continued(ratio: Piecewise, pieces: list[Piece], mate: int) -> tuple[Array, list[Piece]]:
    """Continue an open ratio beyond both ends.

    Parameters
    ----------
    ratio : Piecewise
        i21 over the travel, positive.
    pieces : list of Piece
        Its pieces.
    mate : {WHEEL, RING}
        What the driver rolls on.

    Returns
    -------
    knots : (n + 3,) array, rad
        From before 0 to beyond the travel.
    pieces : list of n + 2 Piece
        With a spiral before and behind. Each is as long as the centrode itself, or as the room
        between the shafts allows.
    """
    length = _length(ratio, mate)
    last = len(ratio.knots) - 1
    first, before = _end(float(ratio.knots[0]), ratio.side(0, 1, 1), -1.0, length, mate)
    final, behind = _end(float(ratio.knots[last]), ratio.side(last, -1, 1), 1.0, length, mate)
    return np.concatenate([[first], ratio.knots, [final]]), [before, *pieces, behind]


def _length(ratio: Piecewise, mate: int) -> float:
    """Length of the centrode for unit centre distance, to a few digits."""
    nodes, weights = np.polynomial.legendre.leggauss(48)
    half = 0.5 * np.diff(ratio.knots)
    x = ratio.knots[:-1] + half * (1.0 + nodes[:, None])
    i, slope = ratio.derivatives(x, 1)
    turn = 1.0 + mate * i
    return float((weights @ (np.hypot(i, slope / turn) / turn)) @ half)


def _end(
    place: float, end: list[float], side: float, length: float, mate: int
) -> tuple[float, Piece]:
    """Angle to which a spiral continues an end (ratio and slope given), and the spiral."""
    ratio, slope = end
    radius = ratio / (1.0 + mate * ratio)
    growth = slope / (ratio * (1.0 + mate * ratio))
    if abs(growth) < _FLAT:
        piece = Piece(lambda x: 0.0 * x + ratio, lambda x: ratio * x)
        return place + side * length / radius, piece
    outward, stretch = side * growth, math.hypot(1.0, growth)
    room = radius
    if outward > 0.0:  # a ring goes on around any wheel
        room = 1.0 - radius if mate == WHEEL else math.inf
    rise = math.copysign(min(length * abs(outward) / stretch, _ROOM * room), outward)

    reach = side * math.log1p(rise / radius) / outward
    return place + reach, spiral(radius, growth, mate, place)


def spiral(radius: float, growth: float, mate: int, place: float = 0.0) -> Piece:
    """Return the ratio of a logarithmic spiral, ``r1/A = radius*exp(growth*(phi1 - place))``.

    Parameters
    ----------
    radius : float
        At the place, over the centre distance A.
    growth : float, 1/rad
        Of the radius in a radian, in the radius.
    mate : {WHEEL, RING}
        What the driver rolls on.
    place : float, rad
        Driver angle.

    Returns
    -------
    Piece
        With its integral, unless it grows so little that an expansion is better.
    """

    def share(x: Jet) -> Jet:
        return radius * exp(growth * (x - place))

    def driven(x: Jet) -> Jet:
        return (-mate / growth) * log(1.0 - mate * share(x))

    return Piece(
        lambda x: share(x) / (1.0 - mate * share(x)), driven if abs(growth) > _CLOSED_FORM else None
    )
