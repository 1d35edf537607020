"""Lobes of closed pairs, and travel and ends of open ones.

A closed law repeats. An open one is continued beyond both ends, since the end teeth roll beyond
them: by a logarithmic spiral with the ratio and slope of the end (a circle for slope zero), so that
the centrode has no corner.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import FEW, formatted, rounds_to
from gearcam.base.quantities import ANGLE, Solve, param
from gearcam.base.rules import together
from gearcam.laws.entry import NO_JUMPS
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import NotSmoothError
from gearcam.numeric.gauss import gauss_cells
from gearcam.numeric.jets import Jet, exp, log
from gearcam.numeric.piecewise import Piece, Piecewise

SAME: Final = 1e-12
"""Distance, rad, below which knots are the same: the rounding of a few sums."""

PLACES: Final = 2049
"""Number of places over a period, ends included, at which functions are checked first."""

_LARGEST: Final = 1e4
"""Largest quotient of the travels of an open pair."""


WHEEL: Final = 1
RACK: Final = 0
RING: Final = -1
"""Type of the mate, w in ``r1 = A*i/(1 + w*i)``: an external wheel, a rack, a ring."""


NO_DWELL: Final = (
    "a pair of wheels cannot stand still while its driver turns: a cam, a Geneva wheel or a "
    "linkage with a dwell can"
)
"""The message on a ratio of 0."""

LOBES: Final = "lobes of driver and driven wheel; default: tooth counts in lowest terms"
"""Meaning of the key ``lobes``."""


@dataclass(frozen=True)
class Lobes:
    """Lobes: the ratio repeats n1 times per turn of the driver and n2 per turn of the driven wheel.

    Parameters
    ----------
    n1, n2 : int
        Ratio of the tooth counts in lowest terms.
    mate : {WHEEL, RING}
        Type of the mate.
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
        Travel of the driver and of the driven wheel.
    mate : {WHEEL, RING}
        Type of the mate.
    """

    period: float
    advance: float
    mate: int = WHEEL
    n1: ClassVar[int] = 1
    n2: ClassVar[int] = 1
    closed: ClassVar[bool] = False


@dataclass(frozen=True)
class RackTravel(Travel):
    """A wheel that drives a rack; the wheel turns without end, the rack is as long as its teeth.

    Parameters
    ----------
    period : float, rad
        One turn of the wheel.
    advance : float
        Travel of the rack per turn, in the scale of the radius of the wheel.
    mate : {RACK}
        Always a rack.
    """

    mate: int = RACK
    closed: ClassVar[bool] = True


ONE_LOBE: Final = Lobes(1, 1)
"""Lobes of equal tooth counts."""

Span = Lobes | Travel
"""Lobes of a closed pair, or travels of an open pair or a rack."""


def demand_lobes(given: tuple[int, int] | None, lobes: Lobes) -> int:
    """Return the lobes of the driver: as given, or from the tooth counts in lowest terms.

    Parameters
    ----------
    given : (int, int) or None
        Lobes of driver and driven wheel.
    lobes : Lobes
        Lobes of the tooth counts.

    Returns
    -------
    int

    Raises
    ------
    InfeasibleError
        If they are not in the ratio of the tooth counts.
    """
    if given is None:
        return lobes.n1
    if given[0] * lobes.n2 != given[1] * lobes.n1:
        counts = [[lobes.n1, lobes.n2]]
        if given[1] * lobes.n2 == given[0] * lobes.n1 and [*given[::-1]] not in counts:
            counts.insert(0, [*given[::-1]])
        what = "the lobes are not in the ratio of the tooth counts"
        note = (
            f"they are {given[0]}/{given[1]} and {lobes.n1}/{lobes.n2}; the tooth counts "
            f"need [{lobes.n1}, {lobes.n2}] or a multiple"
        )
        ratio, limit = given[0] / given[1], lobes.n1 / lobes.n2
        others = [Adjustment(near={"law.lobes": both}) for both in counts]
        raise beyond_limit(what, "law.lobes", ratio, limit, note, adjustments=others)
    return given[0]


def demand_equal(lobes: Lobes) -> None:
    """Refuse an open pair with unequal tooth counts, since both centrodes are equally long.

    Parameters
    ----------
    lobes : Lobes
        Lobes of the tooth counts.

    Raises
    ------
    InfeasibleError
        If the tooth counts are unequal.
    """
    if replace(lobes, mate=WHEEL) != ONE_LOBE:
        what = "an open pair needs equal tooth counts: its centrodes are equally long"
        raise beyond_limit(
            what, "pair.teeth", lobes.n1 / lobes.n2, 1.0, "this is the ratio of the tooth counts"
        )


def demand_travels(span: Span) -> None:
    """Refuse a ring that turns as far as its wheel, and travels that differ too much.

    Parameters
    ----------
    span : Lobes or Travel
        Travels of both wheels.

    Raises
    ------
    InfeasibleError
        With the travel of the driven wheel.
    """
    key, mean = "law.driven_travel_deg", span.advance / span.period
    if not (span.closed or span.mate == RACK or 1.0 / _LARGEST <= mean <= _LARGEST):
        limit = math.degrees(span.period) * (1.0 / _LARGEST if mean < 1.0 else _LARGEST)
        what = "one wheel turns so little compared with the other that it would be a rack"
        note = f"one turns at most {formatted(_LARGEST)} times as far as the other"
        raise beyond_limit(
            what, key, math.degrees(span.advance), limit, note, far=math.degrees(span.period)
        )
    if span.mate == RING and not span.advance < span.period:
        most = math.degrees(span.period)
        what = "a ring must turn less than its wheel"
        where, far = ("pair.teeth", None) if span.closed else (key, 0.1 * most)
        note, value = "the limit is the travel of the driver", math.degrees(span.advance)
        raise beyond_limit(what, where, value, most, note, far=far, unit="deg")


def demand_below_one(
    largest: float, where: str, mean: float = 1.0, far: float | None = None
) -> None:
    """Refuse an internal pair whose ratio is not below 1.

    Parameters
    ----------
    largest : float
        The largest ratio.
    where : str
        Place of the largest ratio.
    mean : float
        Mean ratio of a closed law, for the message; 1 if unknown.
    far : float, optional
        The largest change of the key `where` that may help.

    Raises
    ------
    InfeasibleError
        With the largest possible swing of the ratio about its mean.
    """
    if not largest < 1.0:
        nearest = "the wheel would be as large as its ring"
        if mean < 1.0:
            share = formatted((1.0 - mean) / (largest - mean))
            nearest += (
                f"; about the mean of {formatted(mean)}, which closure needs, the ratio may swing "
                f"by less than {share} times as much"
            )
        what = "the ratio of an internal pair must stay below 1"
        raise beyond_limit(what, where, largest, 1.0, nearest, far=far)


def is_open(parameters: Any) -> bool:
    """Return whether the parameters of a ratio law are those of an open pair."""
    travels = (getattr(parameters, f"{name}_travel", None) for name in ("driver", "driven"))
    return any(one is not None for one in travels)


def own_travel(given: float | Solve | None, own: float, within: float) -> float:
    """Return how far the driven wheel of a law turns that itself gives its travel.

    Parameters
    ----------
    given : float or "solve" or None, rad
        The travel that is asked for.
    own : float, rad
        That of the law.
    within : float, rad
        Difference of both that is rounding.

    Returns
    -------
    float, rad
        That of the law, unless the given one is another, rather than this one rounded.
    """
    if given is None or given == "solve" or abs(own - given) <= within:
        return own
    return own if rounds_to(math.degrees(own), math.degrees(given)) else given


def span_of(lobes: Lobes, driver_travel: float | None, driven_travel: float | Solve | None) -> Span:
    """Return the travel of an open pair if both travels are given, else the lobes.

    Parameters
    ----------
    lobes : Lobes
        Lobes of the tooth counts.
    driver_travel, driven_travel : float or None, rad
        Travels, both or none; "solve" where the law does not give it is refused.

    Returns
    -------
    Lobes or Travel

    Raises
    ------
    InfeasibleError
        If an open pair has unequal tooth counts.
    """
    if driver_travel is None or driven_travel is None:
        return lobes
    if driven_travel == "solve":
        what = "the law does not give the driven wheel's travel"
        key, note = "law.driven_travel_deg", 'an angle in the place of "solve"'
        raise InfeasibleError(what, where=key, nearest=note)
    demand_equal(lobes)
    return Travel(driver_travel, driven_travel, lobes.mate)


TRAVELS: Final = "driver_travel_deg and driven_travel_deg for an open pair, none for a closed one"
"""What laws allow whose travels are given for open pairs."""

OPEN: Final = tuple(together("driver_travel", "driven_travel", allowed=TRAVELS))
"""Their rules."""


@contextmanager
def demand_smooth(name: str) -> Iterator[None]:
    """Turn a `NotSmoothError` raised inside into a refusal with the driver angle.

    Parameters
    ----------
    name : str
        Name of the function, for the message.

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


def open_travel(wheel: str, own: str = "") -> Any:
    """Return the optional parameter of a law for the travel of a `wheel` of an open pair.

    Parameters
    ----------
    wheel : str
        Which wheel.
    own : str
        What itself gives the travel, so that "solve" may be given.
    """
    doc = f"how far the {wheel} of an open pair turns"
    doc += f'; "solve" takes that of {own}' if own else ""
    return param(ANGLE, default=None, gt=0, le=360, example=180, doc=doc)


def angle_text(angle: float) -> str:
    """Return a driver angle, rad, as a place for messages."""
    return f"phi1 = {formatted(round(math.degrees(angle), 6) + 0.0, FEW)} deg"


def continued(ratio: Piecewise, pieces: list[Piece], mate: int) -> tuple[Array, list[Piece]]:
    """Continue an open ratio beyond both ends.

    Parameters
    ----------
    ratio : Piecewise
        i21 over the travel, positive.
    pieces : list of Piece
        Its pieces.
    mate : {WHEEL, RING}
        Type of the mate.

    Returns
    -------
    knots : (n + 3,) array, rad
        From below 0 to beyond the travel.
    pieces : list of n + 2 Piece
        With a spiral at both ends, as long as the centrode or as the shafts allow.
    """
    length = _length(ratio, mate)
    last = len(ratio.knots) - 1
    first, before = _end(float(ratio.knots[0]), ratio.side(0, 1, 1), -1.0, length, mate)
    final, behind = _end(float(ratio.knots[last]), ratio.side(last, -1, 1), 1.0, length, mate)
    return np.concatenate([[first], ratio.knots, [final]]), [before, *pieces, behind]


def _length(ratio: Piecewise, mate: int) -> float:
    """Return the length of the centrode for unit centre distance, to a few digits."""
    x, weights = gauss_cells(ratio.knots[:-1], ratio.knots[1:], 48)
    i, slope = ratio.derivatives(x, 1)
    turn = 1.0 + mate * i
    return float((weights * np.hypot(i, slope / turn) / turn).sum())


def _end(
    place: float, end: list[float], side: float, length: float, mate: int
) -> tuple[float, Piece]:
    """Return the angle to which a spiral continues an end, given as ratio and slope, and it."""
    ratio, slope = end
    radius = ratio / (1.0 + mate * ratio)
    growth = slope / (ratio * (1.0 + mate * ratio))
    if abs(growth) < 1e-9:  # a circle, but for rounding
        piece = Piece(lambda x: 0.0 * x + ratio, lambda x: ratio * x)
        return place + side * length / radius, piece
    outward, stretch = side * growth, math.hypot(1.0, growth)
    room = radius
    if outward > 0.0:  # a ring leaves room for any wheel
        room = 1.0 - radius if mate == WHEEL else math.inf
    rise = math.copysign(min(length * abs(outward) / stretch, 0.9 * room), outward)

    reach = side * math.log1p(rise / radius) / outward
    return place + reach, spiral(radius, growth, mate, place)


def spiral(radius: float, growth: float, mate: int, place: float = 0.0) -> Piece:
    """Return the ratio of a logarithmic spiral, ``r1/A = radius*exp(growth*(phi1 - place))``.

    Parameters
    ----------
    radius : float
        Radius at `place` over the centre distance A.
    growth : float, 1/rad
        Growth of the radius per radian over the radius.
    mate : {WHEEL, RING}
        Type of the mate.
    place : float, rad
        Driver angle.

    Returns
    -------
    Piece
        With its integral, unless the growth is so small that an expansion is better.
    """

    def share(x: Jet) -> Jet:
        return radius * exp(growth * (x - place))

    def driven(x: Jet) -> Jet:
        return (-mate / growth) * log(1.0 - mate * share(x))

    def ratio(x: Jet) -> Jet:
        return share(x) / (1.0 - mate * share(x))

    return Piece(ratio, driven if abs(growth) > 1e-3 else None)
