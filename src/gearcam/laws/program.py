"""Lift programs: the displacement of a follower over a turn, or over the travel, of the cam.

A program joins phases: motion laws scaled to their phases, and segments, quintics that continue the
phase before. It repeats every turn and has knots where its velocity, acceleration or jerk jumps.
That of a translating cam is *open*, over a travel in mm in place of an angle in rad.

Source: 000 section 3.3, eqs. (3.3)-(3.5).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from typing import Any

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import Tolerances
from gearcam.laws.displacement import EXACT, JUMP, Deviation, Displacement, Jump
from gearcam.laws.motion.base import MotionFunction
from gearcam.laws.motion.pieces import from_both_ends
from gearcam.laws.phases_of_lift import (
    TURN,
    DwellPhase,
    Phase,
    PlacedPhase,
    ReturnPhase,
    RisePhase,
    SegmentPhase,
    angles_of,
    levels,
    program_problems,
)
from gearcam.numeric.arrays import Array, distinct
from gearcam.numeric.hermite import hermite_quintics
from gearcam.numeric.jets import Jet, Value, polynomial
from gearcam.numeric.piecewise import (
    Piece,
    Piecewise,
    extremes,
    extremes_among,
    piecewise,
    places_between,
)


@dataclass(frozen=True, eq=False, kw_only=True)
class Survey(ShortRepr):
    """A lift and its derivatives up to the fourth at many places, computed once.

    Parameters
    ----------
    places : (n, k) array, rad
        Places in every interval between cuts, both ends included.
    values : (5, n, k) array
        Lift and derivatives there.
    before, after : (m, 5) arrays
        The same on both sides of each knot but the last.
    """

    places: Array
    values: Array
    before: Array
    after: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Program(ShortRepr, Displacement):
    """The lift of a follower over a turn, repeated, or over a travel.

    Angles and derivatives in rad are in mm over a travel.

    Parameters
    ----------
    lift : Piecewise
        s over the period, mm or rad.
    stretches : tuple of PlacedPhase
        Phases; a segment is a rise or a return, by its direction.
    cuts : (m,) array, rad
        Knots and places where a law bends sharply; extremes are searched between them.
    errors : (float, float, float, float)
        Estimated errors of the lift, mm or rad, and of its first three derivatives beyond rounding.
    fall : float
        Error of a curve through every second row over that of the lift; 1 where there are no rows.
    deviation : Deviation, optional
        Largest distance of a smoothed lift from the rows.
    given : (n, 2) array, optional
        The rows that were smoothed: angle, rad, and lift, mm or rad.
    open : bool
        Whether it ends with the travel.
    """

    lift: Piecewise
    stretches: tuple[PlacedPhase, ...]
    cuts: Array
    errors: tuple[float, ...] = EXACT
    fall: float = 1.0
    deviation: Deviation | None = None
    given: Array | None = None
    open: bool = False

    @property
    def closed(self) -> bool:
        """Whether it repeats every turn."""
        return not self.open

    @property
    def knots(self) -> Array:
        """Knots of the lift over a turn, rad, both ends included."""
        return self.lift.knots

    @property
    def period(self) -> float:
        """A turn of the cam, rad, or its travel, mm."""
        return float(self.knots[-1])

    @property
    def grain(self) -> float:
        """The period over a turn: factor of small distances that are given in rad."""
        return self.period / TURN

    def cuts_between(self, low: float, high: float) -> Array:
        """Return the cuts between two cam angles, these included.

        Parameters
        ----------
        low, high : float, rad
            Rising, within two turns.

        Returns
        -------
        (n,) array, rad
        """
        cuts = np.append(self.cuts, self.cuts + self.period)
        return distinct(cuts[(cuts > low) & (cuts < high)], [low, high])

    def sides(self, cuts: Sequence[Array]) -> tuple[Array, Array]:
        """Return the ends of stretches between `cuts`, rad, and lift, s' and s'' from within."""
        low, high = np.hstack([[part[:-1], part[1:]] for part in cuts])
        periods, middle = self.within(0.5 * (low + high))
        index = np.tile(np.searchsorted(self.knots[1:-1], middle), 2)
        ends = np.concatenate([low, high])
        return ends, self.lift.on_pieces(index, ends - np.tile(periods, 2) * self.period, 2)

    def phases(self, kind: str) -> list[tuple[float, float]]:
        """Return start and end, rad, of every phase of a `kind`, such as rise."""
        return [(s.start, s.end) for s in self.stretches if s.kind == kind]

    def in_period(self, x: Array, order: int) -> list[Array]:
        """Return ``[s, s', ...]`` over the turn (see `Displacement.in_period`)."""
        return self.lift.derivatives(x, order)

    @cached_property
    def peaks(self) -> tuple[float, float, float]:
        """Largest absolute velocity, acceleration and jerk between knots, per rad, rad^2, rad^3."""
        first, second, third = (max(map(abs, self.range_of(order))) for order in (1, 2, 3))
        return first, second, third

    @cached_property
    def survey(self) -> Survey:
        """The lift and its derivatives over the turn."""
        places, pieces = places_between(self.cuts), np.arange(len(self.knots) - 1)
        owner = np.repeat(np.searchsorted(self.knots, places[:, 0]) - 1, places.shape[1])
        index = np.concatenate([pieces, pieces, owner])
        places[:, 0], places[:, -1] = self.cuts[:-1], self.cuts[1:]
        theta = np.concatenate([self.knots[1:], self.knots[:-1], places.ravel()])
        values = self.lift.on_pieces(index, theta, 4)
        before, after, inside = np.split(values, [len(pieces), 2 * len(pieces)], axis=1)
        return Survey(
            places=places,
            values=inside.reshape(5, *places.shape),
            before=before.T[pieces - 1],
            after=after.T,
        )

    def range_of(self, order: int) -> tuple[float, float]:
        """Return the smallest and largest derivative of an `order` to 3, on both sides of knots."""
        survey = self.survey

        def values(theta: Array) -> list[Array]:
            return self.lift.derivatives(theta, order + 1)[order:]

        _, inside = extremes_among(values, survey.places, *survey.values[order : order + 2])
        all_values = np.concatenate([inside, survey.before[:, order], survey.after[:, order]])
        return float(all_values.min()), float(all_values.max())

    @cached_property
    def range(self) -> tuple[float, float]:
        """Smallest and largest lift, mm or rad."""
        return self.range_of(0)

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """The lowest derivative that jumps at each knot; both ends of the turn are one knot.

        If it jumps too little to matter also the next one that does.
        """
        survey = self.survey
        # a sixth of the places gives the size of derivatives well enough
        inside = np.abs(survey.values[..., 5:-5:6]).max(axis=(1, 2))
        at_knots = np.abs([survey.before, survey.after]).max(axis=(0, 1))
        scales = np.maximum(inside, at_knots)[:4]
        # a knot is rounded: a derivative on its wrong side is off by its slope times the rounding
        rounding = 4.0 * np.finfo(float).eps * self.period
        limits = JUMP * scales + rounding * np.append(scales[1:], inside[4])
        jumping = (np.abs(survey.after - survey.before)[:, :4] > limits)[:, 1:]
        jumps: list[Jump] = []
        for knot in np.flatnonzero(jumping.any(axis=1)).tolist():
            for order in 1 + np.flatnonzero(jumping[knot] & (knot > 0 or not self.open)):
                before, after = (float(one[knot, order]) for one in (survey.before, survey.after))
                share = abs(after - before) / self.peaks[order - 1]
                theta = float(self.knots[knot])
                jump = Jump(theta=theta, order=int(order), before=before, after=after, share=share)
                jumps.append(jump)
                if not jump.slight:
                    break
        return tuple(jumps)

    @property
    def hard(self) -> tuple[Jump, ...]:
        """The knots where the velocity jumps."""
        return tuple(jump for jump in self.jumps if jump.order == 1)

    def slight(self, theta: float) -> bool:
        """Return whether the velocity jumps at a knot, rad, too little to matter."""
        return any(jump.theta == theta and jump.slight for jump in self.hard)

    @property
    def continuity(self) -> int:
        """Order of continuity over the turn, 0 to 3; 3 means at least 3."""
        return min((jump.order for jump in self.jumps), default=4) - 1


def stretches_of(
    lift: Piecewise, theta: Array, values: Array, level: float, cutoff: float
) -> tuple[PlacedPhase, ...]:
    """Return rises, returns and dwells; one that goes on over the end of the turn is cut there.

    Parameters
    ----------
    lift : Piecewise
        The curve.
    theta, values : (n,) arrays
        Places of it, rad, and lifts there.
    level : float, mm or rad
        What a lift may change by in a dwell.
    cutoff : float, 1/rad
        Wave number above which the curve has none.

    Returns
    -------
    tuple of PlacedPhase
    """
    runs = _runs(theta, values, level, cutoff)
    turns = [
        _turning(lift, theta, (first, row), sign) if sign * before else float(theta[row])
        for (before, first), (sign, row) in zip([runs[-1], *runs], runs, strict=False)
    ]
    names = {1: "rise", -1: "return", 0: "dwell"}
    kinds, first = [names[sign] for sign, _ in runs], int(np.argmin(turns))
    kinds, turns = kinds[first:] + kinds[:first], turns[first:] + turns[:first]
    bounds = zip([kinds[-1], *kinds], [0.0, *turns], [*turns, TURN], strict=True)
    return tuple(
        PlacedPhase(kind=kind, start=start, end=end) for kind, start, end in bounds if end > start
    )


def _runs(theta: Array, values: Array, level: float, cutoff: float) -> list[tuple[int, int]]:
    """Return what the lift does, 1, -1 or 0, and from which row on, in a ring.

    It stands still where it changes by less than the level in a phase of 1 of waves at the cutoff,
    over half such a wave and two steps at least, and by no more than twice the level in all.
    """
    steps, widths = np.diff(values, append=values[0]), np.diff(theta, append=theta[0] + TURN)
    still = np.abs(steps) <= level * np.minimum(cutoff * widths, 1.0)
    signs = np.where(still & (not still.all()), 0.0, np.sign(steps)).astype(int)
    begin = int(np.flatnonzero(signs * (signs - np.roll(signs, 1)))[0])
    runs: list[tuple[int, int]] = []
    for sign, group in groupby(np.roll(np.arange(len(steps)), -begin), key=signs.__getitem__):
        run = np.array(list(group))
        change = np.cumsum(steps[run])
        short = len(run) < 2 or widths[run].sum() < math.pi / cutoff
        if sign == 0 and short:
            continue  # it turns, or goes on
        if sign == 0 and np.abs(change).max() > 2.0 * level:
            sign = int(np.sign(change[-1]))
        if not runs or runs[-1][0] != sign:
            runs.append((int(sign), int(run[0])))
    if runs[0][0] == runs[-1][0]:
        return runs[1:]
    return runs


def _turning(lift: Piecewise, theta: Array, rows: tuple[int, int], sign: int) -> float:
    """Return where a lift is extreme, rad, that comes from one row and goes from another."""
    first, last = rows
    row = theta[np.arange(first - 1, last + 2 + len(theta) * (last < first)) % len(theta)]
    near = np.unwrap(row, period=TURN)

    def function(x: Array) -> list[Array]:
        return lift.derivatives(x % TURN, 1)

    places, values = extremes(function, near)
    place = float(places[np.argmin(sign * values)])
    nearest = float(near[np.abs(near - place).argmin()])
    # extremes are known to half the digits
    return (nearest if abs(nearest - place) < 1e-9 else place) % TURN


def make_program(
    phases: Sequence[Phase],
    tolerances: Tolerances,
    *,
    oscillating: bool = False,
    closed: bool = True,
    half: bool = False,
) -> Program:
    """Make a program from its phases.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn, in order.
    tolerances : Tolerances
        Accuracy of expansions of laws.
    oscillating : bool
        Whether lifts are angles.
    closed : bool
        Whether it repeats; else the phases cover a travel.
    half : bool
        Whether the phases fill half a turn and are followed by their opposite; the first phase
        then starts with the opposite of the end state of the last.

    Returns
    -------
    Program
        Its knots are the ends of phases and the knots of laws; the first is 0, the last exactly
        2*pi, or pi for half a turn, to be completed by `gearcam.laws.half_turns`.

    Raises
    ------
    InfeasibleError
        If the program does not close, or a law has no value.
    """
    for number, _, message, rule in program_problems(
        phases, oscillating=oscillating, closed=closed, half=half
    ):
        where = "motion" if number is None else f"motion[{number}]"
        raise InfeasibleError(message, where=where, nearest=rule)
    angles, heights = _ends(phases, closed=closed, half=half)
    shapes = [phase.law for phase in phases if isinstance(phase, RisePhase)]
    rises = {shape: shape.build(tolerances) for shape in dict.fromkeys(shapes)}
    places = [
        _Place(*ends, *lifts)
        for ends, lifts in zip(pairwise(angles.tolist()), pairwise(heights), strict=True)
    ]

    pieces: list[tuple[float, Piece]] = []
    stretches: list[PlacedPhase] = []
    cuts, errors = np.array([]), np.array(EXACT)
    for number, (phase, place) in enumerate(zip(phases, places, strict=True)):
        match phase:
            case DwellPhase():
                kind = "dwell"
                pieces.append((place.end, Piece(polynomial, parameters=(place.start, place.base))))
            case SegmentPhase():
                kind = "rise" if place.rise >= 0.0 else "return"
                before = _end_state(phases[number - 1], places[number - 1], rises)
                start, around = before if number or closed else (0.0, 0.0), half and number == 0
                pieces.append((place.end, place.quintic(start, phase.end[1:], opposite=around)))
            case RisePhase():
                kind = "return" if isinstance(phase, ReturnPhase) else "rise"
                pieces += place.pieces(rises[phase.law])
                cuts = np.append(cuts, place.cuts(rises[phase.law]))
                errors = np.maximum(errors, place.errors(rises[phase.law]))
        stretches.append(PlacedPhase(kind=kind, start=place.start, end=place.end))
    knots, parts = zip(*pieces, strict=True)
    lift = piecewise([0.0, *knots], list(parts))
    return Program(
        lift=lift,
        stretches=tuple(stretches),
        cuts=distinct(lift.knots, cuts),
        errors=tuple(errors.tolist()),
        open=not closed,
    )


def _ends(phases: Sequence[Phase], *, closed: bool, half: bool) -> tuple[Array, list[float]]:
    """Return the places and lifts at the starts of phases and at the end of the last."""
    if closed:
        turn = 0.5 * TURN if half else TURN
        widths = angles_of(phases, turn)
        share = turn / sum(widths)
        angles = np.cumsum([0.0, *(width * share for width in widths)])
        angles[-1] = turn
    else:
        angles = np.cumsum([0.0, *(float(phase.angle) for phase in phases)])
    heights = levels(phases)
    if closed and not half:
        heights[-1] = 0.0
    return angles, heights


def _end_state(
    phase: Phase, place: _Place, rises: Mapping[Any, MotionFunction]
) -> tuple[float, float]:
    """Return velocity and acceleration at the end of a phase, which its law defines."""
    match phase:
        case SegmentPhase():
            return phase.end[1:]
        case RisePhase():
            return place.end_state(rises[phase.law])
        case DwellPhase():
            return 0.0, 0.0


@dataclass(frozen=True)
class _Placed(ShortRepr):
    """A scaled law, ``base + scale*S((theta - origin)/width)``; phases of one law share it."""

    law: Callable[..., Jet]

    def __call__(
        self, x: Jet, origin: Value, per_width: Value, base: Value, scale: Value, *parameters: Value
    ) -> Jet:
        share = Jet.variable((x.c[0] - origin) * per_width, x.order)
        value, *slopes = self.law(share, *parameters).c
        rates = (scale * per_width**k * slope for k, slope in enumerate(slopes, 1))
        return Jet([base + scale * value, *rates])


@dataclass(frozen=True)
class _Place:
    """Position of a phase: from `start` to `end`, rad, and from lift `base` to `top`."""

    start: float
    end: float
    base: float
    top: float

    @property
    def rise(self) -> float:
        return self.top - self.base

    def law(self, rise: MotionFunction) -> tuple[float, float, float, float]:
        """Return origin, width, base and scale of a law (see `_Placed`)."""
        if rise.mirrored and self.rise < 0.0:  # a return is the law run backwards
            return self.end, self.start - self.end, self.top, -self.rise
        return self.start, self.end - self.start, self.base, self.rise

    def pieces(self, rise: MotionFunction) -> Iterator[tuple[float, Piece]]:
        """Yield the pieces of a law, each with its end angle."""
        origin, width, base, scale = self.law(rise)
        inner = np.sort(origin + width * rise.function.knots[1:-1]).tolist()
        parts = rise.function.pieces[:: 1 if width > 0.0 else -1]
        for end, part in zip([*inner, self.end], parts, strict=True):
            parameters = (origin, 1.0 / width, base, scale, *part.parameters)
            yield end, Piece(_Placed(part.function), parameters=parameters)

    def cuts(self, rise: MotionFunction) -> Array:
        """Return the angles at which a law bends sharply."""
        origin, width, *_ = self.law(rise)
        return origin + width * np.array(rise.cuts)

    def errors(self, rise: MotionFunction) -> Array:
        """Return the errors of a law and of its first three derivatives."""
        return abs(self.rise) * np.array(rise.errors) / (self.end - self.start) ** np.arange(4)

    def end_state(self, rise: MotionFunction) -> tuple[float, float]:
        """Return velocity and acceleration of a law at the end."""
        _, width, _, scale = self.law(rise)
        ends = (len(rise.function.pieces), -1) if width > 0.0 else (0, 1)
        _, velocity, acceleration = rise.function.side(*ends, 2)
        return scale * velocity / width, scale * acceleration / width**2

    def quintic(
        self, start: tuple[float, float], end: tuple[float, float], *, opposite: bool
    ) -> Piece:
        """Return the quintic with given velocities and accelerations at both ends.

        `opposite` changes the signs of those at its start. The polynomial is about the nearer end.
        """
        width = self.end - self.start
        first, last = np.array([start, end]) * [width, width**2]
        first *= -1.0 if opposite else 1.0
        ends = np.array([(0.0, 0.0, *first), (1.0, self.rise, *last)])
        # as seen from the end
        reverse = np.array([(0.0, self.rise, *last), (1.0, 0.0, *first)]) * [1, 1, -1, 1]
        left, right = (hermite_quintics(*rows.T)[0] for rows in (ends, reverse))
        both = from_both_ends(left.tolist(), (right * (-1.0) ** np.arange(6)).tolist(), 0.0, 1.0)
        parameters = (self.start, 1.0 / width, self.base, 1.0, *both.parameters)
        return Piece(_Placed(both.function), parameters=parameters)
