"""Lift programs: the displacement of a follower over a turn of the cam.

A program is made from phases. Every phase is scaled from the unit square; a segment is the quintic
that leaves with the state in which the phase before it ends. The program repeats every turn, and
says at which knots its velocity (*hard shock*), acceleration (*soft shock*) or jerk jumps.

Source: 000 section 3.3, eqs. (3.3)-(3.5).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.laws.displacement import JUMP, Displacement, Jump
from gearcam.laws.phases_of_lift import (
    DwellPhase,
    Phase,
    ReturnPhase,
    RisePhase,
    SegmentPhase,
    levels,
    program_problems,
)
from gearcam.laws.placed import PlacedLaws, PlacedPiece, placed
from gearcam.laws.rises.base import Rise, RiseParameters
from gearcam.numeric.arrays import Array
from gearcam.numeric.hermite import hermite_quintics
from gearcam.numeric.jets import polynomial
from gearcam.numeric.piecewise import (
    Piece,
    Piecewise,
    extremes_among,
    piecewise,
    places_between,
)
from gearcam.tolerances import Tolerances

_INNER = slice(5, -5, 6)
"""Surveyed places at which the size of derivatives is known well enough to judge jumps."""

_TURN = 2.0 * math.pi

_KNOT = 4.0 * np.finfo(float).eps * _TURN
"""Rounding of a knot, rad."""


@dataclass(frozen=True, kw_only=True)
class PlacedPhase:
    """A phase in its place: its `kind` (rise, return or dwell), `start` and `end` in rad."""

    kind: str
    start: float
    end: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Survey:
    """A lift and its derivatives to the fourth, all at once: most questions need no more.

    Parameters
    ----------
    places : (n, k) array, rad
        In every stretch between cuts, both ends just inside.
    found : (5, n, k) array
        Lift and derivatives there.
    before, after : (m, 5) arrays
        The same on both sides of each knot but the last.
    """

    places: Array
    found: Array
    before: Array
    after: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Program(Displacement):
    """The lift over a turn, repeated.

    Parameters
    ----------
    lift : PlacedLaws
        s over ``[0, 2*pi]``, mm or rad.
    stretches : tuple of PlacedPhase
        Its phases; a segment counts as a rise or return by its direction.
    cuts : (m,) array, rad
        The knots, and more places where a law bends sharply: between them extremes are sought.
    """

    lift: PlacedLaws
    stretches: tuple[PlacedPhase, ...]
    cuts: Array

    @property
    def knots(self) -> Array:
        """Knots of the lift over a turn, rad, both ends included."""
        return self.lift.knots

    @property
    def period(self) -> float:
        """A turn of the cam, rad."""
        return _TURN

    def cuts_between(self, low: float, high: float) -> Array:
        """Return the cuts between two cam angles, with both of these.

        Parameters
        ----------
        low, high : float, rad
            Rising, within two turns.

        Returns
        -------
        (n,) array, rad
        """
        cuts = np.concatenate([self.cuts, self.cuts + _TURN])
        return np.array(sorted({low, *cuts[(cuts > low) & (cuts < high)].tolist(), high}))

    def phases(self, kind: str) -> list[tuple[float, float]]:
        """Return beginning and end, rad, of every phase of a `kind`, such as rise."""
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
        theta = np.concatenate([self.knots[1:], self.knots[:-1], places.ravel()])
        found = self.lift.on_pieces(index, theta, 4)
        before, after, inside = np.split(found, [len(pieces), 2 * len(pieces)], axis=1)
        return Survey(
            places=places,
            found=inside.reshape(5, *places.shape),
            before=before.T[pieces - 1],
            after=after.T,
        )

    def range_of(self, order: int) -> tuple[float, float]:
        """Return the smallest and largest derivative of an `order` to 3, on both sides of knots."""
        survey = self.survey

        def values(theta: Array) -> list[Array]:
            return self.lift.derivatives(theta, order + 1)[order:]

        _, inside = extremes_among(values, survey.places, *survey.found[order : order + 2])
        found = np.concatenate([inside, survey.before[:, order], survey.after[:, order]])
        return float(found.min()), float(found.max())

    @cached_property
    def range(self) -> tuple[float, float]:
        """Smallest and largest lift, mm or rad."""
        return self.range_of(0)

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """The lowest derivative that jumps at each knot, the turn's ends counting as one."""
        survey = self.survey
        inside = np.abs(survey.found[..., _INNER]).max(axis=(1, 2))
        at_knots = np.abs([survey.before, survey.after]).max(axis=(0, 1))
        scales = np.maximum(inside, at_knots)[:4]
        # a knot is rounded, and a derivative seen on the wrong side of it by its own slope
        limits = JUMP * scales + _KNOT * np.append(scales[1:], inside[4])
        jumping = (np.abs(survey.after - survey.before)[:, :4] > limits)[:, 1:]
        return tuple(
            Jump(
                theta=float(self.knots[knot]),
                order=(order := 1 + int(jumping[knot].argmax())),
                before=float(survey.before[knot, order]),
                after=float(survey.after[knot, order]),
            )
            for knot in np.flatnonzero(jumping.any(axis=1)).tolist()
        )

    @property
    def hard(self) -> tuple[Jump, ...]:
        """The knots where the velocity jumps."""
        return tuple(jump for jump in self.jumps if jump.order == 1)

    @property
    def continuity(self) -> int:
        """Order of continuity over the turn: 0 to 3, where 3 means at least 3."""
        return min((jump.order for jump in self.jumps), default=4) - 1


def make_program(
    phases: Sequence[Phase], tolerances: Tolerances, *, oscillating: bool = False
) -> Program:
    """Make a program from its phases.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn, in order.
    tolerances : Tolerances
        Accuracy of laws that are expanded.
    oscillating : bool
        Whether lifts are angles.

    Returns
    -------
    Program
        Knots at the ends of phases and inside laws; the first is 0, the last exactly 2*pi.

    Raises
    ------
    InfeasibleError
        If the program does not close, or a law has no value.
    """
    for number, _, message, rule in program_problems(phases, oscillating=oscillating):
        where = "motion" if number is None else f"motion[{number}]"
        raise InfeasibleError(message, where=where, nearest=rule)
    share = _TURN / sum(phase.angle for phase in phases)
    angles = np.concatenate([[0.0], np.cumsum([phase.angle * share for phase in phases])])
    angles[-1] = _TURN
    heights = levels(phases)
    heights[-1] = 0.0
    shapes = [phase.shape for phase in phases if isinstance(phase, RisePhase)]
    rises = {shape: shape.build(tolerances) for shape in dict.fromkeys(shapes)}
    frame = _Frame(phases=phases, angles=angles, heights=heights, rises=rises)
    places: list[PlacedPiece] = []
    stretches: list[PlacedPhase] = []
    cuts: list[float] = []
    for number, phase in enumerate(phases):
        match phase:
            case DwellPhase():
                kind = "dwell"
                places.append(frame.whole(number, None, 0.0))
            case SegmentPhase():
                kind = "rise" if frame.rise(number) >= 0.0 else "return"
                places.append(frame.whole(number, frame.segment(number), 1.0))
            case RisePhase():
                kind = "return" if isinstance(phase, ReturnPhase) else "rise"
                places += frame.law(number, rises[phase.shape])
                cuts += _cuts(places[-1], rises[phase.shape])
        start, end = float(angles[number]), float(angles[number + 1])
        stretches.append(PlacedPhase(kind=kind, start=start, end=end))
    lift = placed(places)
    sharp = np.array(sorted({*lift.knots.tolist(), *cuts}))
    return Program(lift=lift, stretches=tuple(stretches), cuts=sharp)


def _cuts(place: PlacedPiece, rise: Rise) -> list[float]:
    """Return where a law bends sharply in its place."""
    cuts = np.array([]) if rise.cuts is None else rise.cuts
    return (place.origin + place.width * cuts[(cuts > 0.0) & (cuts < 1.0)]).tolist()


@dataclass(frozen=True, eq=False, kw_only=True)
class _Frame:
    """Phases with their places: ends of the `angles`, rad, `heights` there, laws by their shape."""

    phases: Sequence[Phase]
    angles: Array
    heights: list[float]
    rises: Mapping[RiseParameters, Rise]

    def width(self, number: int) -> float:
        return float(self.angles[number + 1] - self.angles[number])

    def rise(self, number: int) -> float:
        return self.heights[number + 1] - self.heights[number]

    def backwards(self, number: int, rise: Rise) -> bool:
        """Whether a law comes down by running backwards."""
        return rise.mirrored and self.rise(number) < 0.0

    def whole(self, number: int, law: Piecewise | None, scale: float) -> PlacedPiece:
        """Return a law without knots that begins where a phase does."""
        start, end = self.angles[number : number + 2].tolist()
        base, width = self.heights[number], self.width(number)
        return PlacedPiece(
            law=law, part=0, end=end, origin=start, width=width, base=base, scale=scale
        )

    def law(self, number: int, rise: Rise) -> list[PlacedPiece]:
        """Return the pieces of a law in the place of a phase."""
        place = self.whole(number, rise.function, self.rise(number))
        parts = range(len(rise.function.pieces))
        if self.backwards(number, rise):
            parts = parts[::-1]
            place = replace(
                place,
                origin=place.end,
                width=-place.width,
                base=self.heights[number + 1],
                scale=-place.scale,
            )
        inner = np.sort(place.origin + place.width * rise.function.knots[1:-1]).tolist()
        return [
            replace(place, part=part, end=end)
            for part, end in zip(parts, [*inner, place.end], strict=True)
        ]

    def segment(self, number: int) -> Piecewise:
        """Return the quintic from the state before to the state at the end of a phase."""
        width, rise = self.width(number), self.rise(number)
        start, end = self.end_state((number - 1) % len(self.phases)), self.end_state(number)
        v0, a0, v1, a1 = start[0] * width, start[1] * width**2, end[0] * width, end[1] * width**2
        ends = np.array([[0.0, 1.0], [0.0, rise], [v0, v1], [a0, a1]])
        powers = hermite_quintics(*ends)[0].tolist()
        return piecewise([0.0, 1.0], [Piece(polynomial, parameters=(0.0, *powers))])

    def end_state(self, number: int) -> tuple[float, float]:
        """Return velocity and acceleration at the end of a phase: its law fixes them by itself."""
        phase = self.phases[number]
        if isinstance(phase, SegmentPhase):
            return phase.end[1:]
        if not isinstance(phase, RisePhase):
            return 0.0, 0.0
        law, rise, width = self.rises[phase.shape], self.rise(number), self.width(number)
        if self.backwards(number, law):
            velocity, acceleration, _ = law.start
            return rise * velocity / width, -rise * acceleration / width**2
        velocity, acceleration, _ = law.end
        return rise * velocity / width, rise * acceleration / width**2
