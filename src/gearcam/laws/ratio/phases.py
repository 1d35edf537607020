"""Ratios at knots, joined by arcs, for closed and open pairs.

An arc from `start` to `end` over ``[low, low + width]`` has slope zero at both ends, except the
sine, which starts with a slope. Its mean is ``(1 - share)*start + share*end``, so that closure is
linear in ratios and knots.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    NARROWEST,
    NARROWEST_DEG,
    NUMBER,
    TEXT,
    RowOfSome,
    Solve,
    param,
)
from gearcam.base.rules import Breach
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import LawEntry
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.span import NO_DWELL, SAME, Lobes, Span, open_travel, own_travel, span_of
from gearcam.numeric.jets import Jet, Value, cos, polynomial, primitive, sin
from gearcam.numeric.piecewise import Piece

Curve = Callable[[Jet, Value, Value, Value, Value], Jet]
"""A function of phi1, with the ratios at both ends, the angle at the start and the width."""


@dataclass(frozen=True)
class Arc(ShortRepr):
    """A shape of arcs.

    Parameters
    ----------
    ratio, integral : callable
        The ratio, and its integral with any constant.
    share : float
        Weight of the end value in the mean of the arc.
    """

    ratio: Curve
    integral: Curve
    share: float = 0.5

    def piece(self, start: float, end: float, low: float, width: float) -> Piece:
        """Return an arc.

        Parameters
        ----------
        start, end : float
            Ratios at both ends.
        low, width : float, rad
            Where it starts, and its width.

        Returns
        -------
        Piece
        """
        return Piece(self.ratio, self.integral, (start, end, low, width))


def _cosine(x: Jet, start: Value, end: Value, low: Value, width: Value) -> Jet:
    """003 eqs. (2.1), (2.17) with Tables 2.2, 2.4."""
    return 0.5 * (start - end) * cos(math.pi / width * (x - low)) + 0.5 * (start + end)


def _cosine_integral(x: Jet, start: Value, end: Value, low: Value, width: Value) -> Jet:
    half, speed = 0.5 * (start - end), math.pi / width
    return 0.5 * (start + end) * x + (half / speed) * sin(speed * (x - low))


def _sine(x: Jet, start: Value, end: Value, low: Value, width: Value) -> Jet:
    """Return a quarter of a sine, 003 eqs. (3.1), (3.10), (3.11), with a slope at the start."""
    return (end - start) * sin(0.5 * math.pi / width * (x - low)) + start


def _sine_integral(x: Jet, start: Value, end: Value, low: Value, width: Value) -> Jet:
    speed = 0.5 * math.pi / width
    return start * x - ((end - start) / speed) * cos(speed * (x - low))


def _rising(*powers: float) -> Arc:
    """Return arcs shaped as a polynomial that rises from 0 to 1 over the unit interval."""

    def ratio(x: Jet, start: Value, end: Value, low: Value, width: Value) -> Jet:
        return (end - start) * polynomial((x - low) / width, 0.0, *powers) + start

    def integral(x: Jet, start: Value, end: Value, low: Value, width: Value) -> Jet:
        t = (x - low) / width
        return width * (start * t + (end - start) * primitive(t, 0.0, *powers))

    return Arc(ratio, integral)


ARCS: Final[dict[str, Arc]] = {
    "cosine": Arc(_cosine, _cosine_integral),
    # 003 eq. (2.13) with Table 2.3, written on the unit interval
    "cubic": _rising(0.0, 0.0, 3.0, -2.0),
    # also the second derivative of the ratio is zero at both ends
    "quintic": _rising(0.0, 0.0, 0.0, 10.0, -15.0, 6.0),
    "sine": Arc(_sine, _sine_integral, share=2.0 / math.pi),
}
"""Shapes by their names in design files."""

SMOOTH: Final = ("cosine", "cubic", "quintic")
"""Shapes with slope zero at both ends."""


@dataclass(frozen=True, kw_only=True)
class Phases(ShortRepr):
    """Ratios at knots over one turn (or one lobe); closure may give one ratio.

    With `driven_travel` the pair is open: first and last ratio may differ, and one ratio or one
    knot may be solved so that the driven wheel turns by its travel, or the travel itself.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Phases(knots=(0.0, 2.0, 6.283185307179586), ratios=(1.6, "solve", 1.6))
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="phases", law=law, pair=pair))
    >>> result.motion([0.0, 2.0])["ratio"].round(4)
    array([1.6, 0.4])
    """

    shape: str = param(
        TEXT, default="cosine", choices=tuple(ARCS), doc="shape of the arcs between the knots"
    )
    knots: RowOfSome = param(
        ANGLE,
        ge=0,
        le=360,
        min_length=2,
        doc='driver angles from 0 to a turn or one lobe; of an open pair one may be "solve"',
    )
    ratios: RowOfSome = param(
        NUMBER,
        gt=0,
        min_length=2,
        at_zero=NO_DWELL,
        constant_at="mean",  # a mixture of two laws that close closes too
        doc='i21 there; one may be "solve" (the first: the last too)',
    )
    driven_travel: float | Solve | None = open_travel("driven wheel", "the knots and ratios")

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        if len(self.knots) != len(self.ratios):
            message = f"{len(self.ratios)} ratios for {len(self.knots)} knots"
            yield "ratios", None, message, "one ratio for each knot"
            return
        yield from knot_problems(self.knots)
        if self.driven_travel is None:
            yield from self._closed_problems()
            return
        for place in solved_places(self, "knots", "ratios", "driven_travel")[1:2]:
            rule = 'one "solve" among knots, ratios and driven_travel_deg'
            yield (*place, 'more than one "solve"', rule)

    def _closed_problems(self) -> Iterator[Breach]:
        rule = "an angle (a knot can be solved only for an open pair, with driven_travel_deg)"
        for place in solved_places(self, "knots"):
            yield (*place, "a knot of a closed pair cannot be solved", rule)
        first, last = self.ratios[0], self.ratios[-1]
        if first != last:
            given = last if first == "solve" else first
            message = "the last ratio differs from the first"
            yield "ratios", len(self.ratios) - 1, message, f"{given!r}"
        solved = [k for k, value in enumerate(self.ratios[:-1]) if value == "solve"]
        for second in solved[1:2]:
            message = 'more than one "solve"'
            yield "ratios", second, message, 'one "solve"; the knots of one lobe are enough'

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the knots span neither a turn nor a lobe, or the law does not close; the error names
            the closing value of each ratio.
        """
        arc = ARCS[self.shape]
        if self.driven_travel is None:
            knots, ratios = one_lobe(np.array(self.knots, dtype=float), self.ratios, lobes)
            return arcs_law(arc, knots, ratios, lobes, tolerances, places=range(len(self.ratios)))
        travel, solved = self.driven_travel, {}
        if travel != "solve" and "solve" in self.knots:
            knots, solved = _solve_knot(arc, self.knots, self.ratios, travel)
            span = span_of(lobes, float(knots[-1]), travel)
        else:
            knots = np.array(self.knots, dtype=float)
            span = open_span(arc, knots, self.ratios, lobes, travel, tolerances)
        return arcs_law(arc, knots, self.ratios, span, tolerances, solved)


def solved_places(parameters: Any, *names: str) -> list[tuple[str, int | None]]:
    """Return the fields `names` of a law's parameters, and places in them, that are "solve"."""
    found: list[tuple[str, int | None]] = []
    for name in names:
        value = getattr(parameters, name)
        row = enumerate(value) if isinstance(value, tuple) else [(None, value)]
        found += [(name, place) for place, one in row if one == "solve"]
    return found


def open_span(
    arc: Arc,
    knots: np.ndarray,
    ratios: Sequence[float | Solve],
    lobes: Lobes,
    travel: float | Solve,
    tolerances: Tolerances,
) -> Span:
    """Return the travels of an open pair; knots and ratios, if none is solved, give that asked for.

    Parameters
    ----------
    arc : Arc
        Shape between the knots.
    knots : (n,) array, rad
        From 0 to the end of the driver's travel.
    ratios : sequence of n floats or "solve"
        i21 at the knots.
    lobes : Lobes
        Lobes of the tooth counts.
    travel : float or "solve", rad
        The driven wheel's, as given.
    tolerances : Tolerances
        Accuracy.

    Returns
    -------
    Travel
    """
    if "solve" not in ratios:
        own = float(_weights(arc, knots) @ np.array(ratios, dtype=float))
        travel = own_travel(travel, own, tolerances.refusal)
    return span_of(lobes, float(knots[-1]), travel)


def _weights(arc: Arc, knots: np.ndarray) -> np.ndarray:
    """Return the driven angle of each ratio 1 with 0 at the other knots, rad."""
    widths = np.diff(knots)
    return np.append((1.0 - arc.share) * widths, 0.0) + np.append(0.0, arc.share * widths)


def knot_problems(knots: RowOfSome) -> Iterator[Breach]:
    """Yield the faults of `knots`, rad: field, index, message, allowed."""
    if knots[0] != 0.0:
        yield "knots", 0, "the first knot is not 0", "0"
    given = [(k, value) for k, value in enumerate(knots) if value != "solve"]
    for (_, before), (index, value) in pairwise(given):
        if not value >= before + NARROWEST:
            rule = f"at least {formatted(NARROWEST_DEG)} deg more than the knot before"
            yield "knots", index, "knots must rise", rule


def one_lobe(
    knots: np.ndarray, ratios: Sequence[float | Solve], lobes: Lobes, where: str = "law.knots_deg"
) -> tuple[np.ndarray, list[float | Solve]]:
    """Return knots and ratios over one lobe.

    Parameters
    ----------
    knots : (n,) array, rad
        Knots over one lobe, or over a turn of repeated lobes.
    ratios : sequence of n floats or "solve"
        i21 at the knots.
    lobes : Lobes
        Lobes of the tooth counts.
    where : str
        The key, for messages.

    Returns
    -------
    knots, ratios
        From 0 to the period.

    Raises
    ------
    InfeasibleError
        If they span neither a turn nor a lobe.
    """
    for repeats in (1, lobes.n1):
        count = (len(knots) - 1) // repeats
        tiled = lobes.period * np.arange(repeats)[:, None] + knots[:count]
        grid, lobe = np.append(tiled, repeats * lobes.period), list(ratios[:count])
        repeated = len(grid) == len(knots) and lobe * repeats + lobe[:1] == list(ratios)
        if repeated and np.allclose(grid, knots, rtol=0, atol=SAME):
            return np.append(knots[:count], lobes.period), lobe + lobe[:1]
    lobe = formatted(360 / lobes.n1)
    spans = lobe if lobes.n1 == 1 else f"360 (repeating {lobes.n1} times) or {lobe}"
    what = f"the knots must span {spans} deg for these tooth counts"
    near = {"law.knots_deg": [360.0 / lobes.n1 * float(k / knots[-1]) for k in knots]}
    span, note = math.degrees(knots[-1]), "the limit is one lobe"
    raise beyond_limit(what, where, span, 360 / lobes.n1, note, unit="deg", near=near)


def arcs_law(
    arc: Arc,
    knots: np.ndarray,
    ratios: Sequence[float | Solve],
    lobes: Span,
    tolerances: Tolerances,
    solved: dict[str, float] | None = None,
    places: Sequence[int] = (),
) -> RatioLaw:
    """Return a law of arcs of one shape; closure may give one ratio.

    Parameters
    ----------
    arc : Arc
        Shape between the knots.
    knots : (n,) array, rad
        From 0 to the period.
    ratios : sequence of n floats or "solve"
        i21 at the knots; all that are solved have the same value.
    lobes : Lobes or Travel
        Lobes, or travels of an open pair.
    tolerances : Tolerances
        Accuracy.
    solved : dict, optional
        Values that were solved already, by name.
    places : sequence of int, optional
        Index in `law.ratios` of each knot's ratio, of repeated lobes too; its own if left out.

    Returns
    -------
    RatioLaw

    Raises
    ------
    InfeasibleError
        If it does not close, with the closing value of each ratio, or no positive ratio closes it.
    """
    widths, weights = np.diff(knots), _weights(arc, knots)
    values, closing = _close(weights, ratios, lobes, tolerances, places or range(len(ratios)))
    pieces = [
        arc.piece(values[k], values[k + 1], float(knots[k]), float(widths[k]))
        for k in range(len(widths))
    ]
    return make_law(lobes, knots, pieces, tolerances, (solved or {}) | closing)


def _close(
    weights: np.ndarray,
    ratios: Sequence[float | Solve],
    lobes: Span,
    tolerances: Tolerances,
    places: Sequence[int],
) -> tuple[list[float], dict[str, float]]:
    """Return the ratios with the solved one; the mean of an arc is linear in its end values."""
    if lobes.closed:  # first and last ratio are the same
        weights = np.append(weights[0] + weights[-1], weights[1:-1])
        ratios = ratios[:-1]
    given = np.array([0.0 if value == "solve" else value for value in ratios], dtype=float)
    rest = lobes.advance - float(weights @ given)
    solved = {}
    if "solve" in ratios:
        unknown = np.array([value == "solve" for value in ratios])
        closing = rest / float(weights[unknown].sum())
        given[unknown] = closing
        name = f"ratios[{places[ratios.index('solve')]}]"
        solved = {name: closing}
        if not closing > 0.0:
            share = lobes.advance / (lobes.advance - rest)
            least = {
                f"law.ratios[{place}]": share * float(given[k % len(given)])
                for k, place in enumerate(places)
                if not unknown[k % len(given)]
            }
            note = (
                "closure needs this value; it is positive with the other ratios multiplied "
                f"by less than {formatted(share)}"
            )
            far = dict.fromkeys(least, lobes.advance / lobes.period)
            what, where = "no positive ratio closes the law", f"law.{name}"
            raise beyond_limit(what, where, closing, 0.0, note, near=least, far=far)
    elif abs(rest) > tolerances.refusal:
        nearest, adjustments = _closing_values(given, weights, rest, places)
        how = "do not close" if lobes.closed else "miss the driven wheel's travel"
        what = f"the phases {how}: they turn the driven wheel by the value, not by the limit"
        value, limit = math.degrees(lobes.advance - rest), math.degrees(lobes.advance)
        if not lobes.closed:
            adjustments.append(Adjustment(near={"law.driven_travel_deg": value}))
        raise beyond_limit(
            what, "law.ratios", value, limit, nearest, adjustments=adjustments, unit="deg"
        )
    values = given.tolist()
    return [*values, values[0]] if lobes.closed else values, solved


def _closing_values(
    given: np.ndarray, weights: np.ndarray, rest: float, places: Sequence[int]
) -> tuple[str, list[Adjustment]]:
    """Return the value that each ratio of a file needs for the law to close: text, adjustments.

    Only that ratio is changed, wherever it holds; values that are not positive are left out.
    """
    lines, adjustments, left = [], [], set(range(len(given)))
    while left:
        group, same, size = {min(left)}, set[int](), 0
        while size < len(group):  # knots with one ratio, and ratios of one knot
            size = len(group)
            same = {place for k, place in enumerate(places) if k % len(given) in group}
            group |= {k % len(given) for k, place in enumerate(places) if place in same}
        left -= group
        closing = float(given[min(group)] + rest / weights[sorted(group)].sum())
        if closing > 0.0:
            names = [f"ratios[{place}]" for place in sorted(same)]
            lines.append(f"{' = '.join(names)} = {formatted(closing, 10)}")
            adjustments.append(Adjustment(near={f"law.{name}": closing for name in names}))
    if not lines:
        return "it does not close with any other value of a single ratio", adjustments
    return f"it closes with {' or '.join(lines)}", adjustments


def _solve_knot(
    arc: Arc, knots: Sequence[float | Solve], ratios: Sequence[float | Solve], travel: float
) -> tuple[np.ndarray, dict[str, float]]:
    """Return the knots of an open pair with the solved one; the driven angle is linear in it."""
    index = knots.index("solve")

    def filled(place: float) -> np.ndarray:
        return np.array([place if value == "solve" else value for value in knots])

    def driven(place: float) -> float:
        values = np.array(ratios, dtype=float)
        means = (1.0 - arc.share) * values[:-1] + arc.share * values[1:]
        return float(means @ np.diff(filled(place)))

    slope = driven(1.0) - driven(0.0)
    place = (travel - driven(0.0)) / slope if slope else math.inf
    ends = [*knots, 2.0 * math.pi]
    low, high = float(ends[index - 1]), float(ends[index + 1])
    if not low < place <= high or place == high < 2.0 * math.pi:
        travels = sorted(math.degrees(driven(edge)) for edge in (low, high))
        key, nearest = (
            "law.driven_travel_deg",
            travels[0 if math.degrees(travel) < travels[0] else 1],
        )
        what = "no knot between its neighbours gives the driven wheel its travel"
        least, most = (formatted(one, 10) for one in travels)
        note = f"the knots allow {least} to {most} deg, both excluded"
        where, near, far = f"law.knots_deg[{index}]", {key: nearest}, {key: 0.5 * sum(travels)}
        raise beyond_limit(what, where, math.degrees(travel), nearest, note, near=near, far=far)
    return filled(place), {f"knots_deg[{index}]": math.degrees(place)}


ENTRIES: Final = (
    LawEntry(
        name="phases",
        example=Phases(knots=(0.0, math.radians(160), 2 * math.pi), ratios=(1.6, 0.4, 1.6)),
        doc="ratios at knots, joined by arcs with zero slope at each knot; closed or open",
        continuity="C1 at the knots; C2 for quintic arcs",
        source="Niculescu, sections 2.2.2.1 to 2.2.2.3 and 3.2.2",
    ),
)
