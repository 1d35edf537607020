"""Sizes of a cam that keep limits, and the smallest of them.

A *candidate* is a set of sizes of a disc cam and its follower: prime or base radius, offset, pivot
distance, arm, roller radius. Many candidates are measured at once, on the exact contact of
`gearcam.cams.followers` at the places where the lift is surveyed, with the extremes between them
from values and slopes. An *excess* is how far a candidate is beyond a limit, as a share of it: 0 or
less if it keeps it.

In the plane of offset and position at zero lift the pressure angle of a translating follower is
limited by straight lines, one for each cam angle (the lines of the hodograph); their envelope is
two lines for each kind of phase, and so the admissible region is a wedge. The other limits bend its
edge. The search needs no such shape: it looks at the whole range first, and then more and more
closely around the best candidates.

Sources: 000 section 3.7, figs. 3.41 and 3.44; derived anew.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.cams.carriers import Rotating
from gearcam.cams.curve import CamCurve
from gearcam.cams.followers import Contact, Follower
from gearcam.cams.placing import followers_of
from gearcam.cams.spec import FollowerSpec
from gearcam.cams.touch import pushing
from gearcam.laws.program import Program
from gearcam.mechanics.follower_loads import DrivenMotion
from gearcam.mechanics.friction import FrictionSpec
from gearcam.mechanics.supports import TotalLoad
from gearcam.numeric.arrays import Array, Mask, distinct
from gearcam.numeric.jets import Jet

SIZES: Final = ("radius", "offset", "pivot", "arm", "roller")
"""Names of the sizes: the first is the prime radius, of a flat follower the base radius."""

_FEWEST: Final = 512
"""Candidates of the first look, for one unknown; as many again for each further one."""

_STARTS: Final = 6
"""Best candidates around which the search looks more closely."""

_TRUST: Final = 0.05
_NEAR: Final = 2e-3
"""First range of trust, as a share of the range of each size; the second near a solution."""

_SHARE: Final = 1e-3
"""Step of differences, in ranges of trust."""

_FINEST: Final = 1e-9
"""Range of trust at which the search ends."""

_STILL: Final = 1e-12
"""Step that is rounding."""

_NEARLY: Final = 1e-4
"""Range of trust at which the search by some places of the lift ends."""

_SLIGHT: Final = 1e-6
"""Share of the merit, by some places of the lift, that is not worth another step."""

_MOST_STEPS: Final = 60
"""Largest number of linear programs."""

_LOST: Final = 1e-3
"""Excess from which limits are approached first, before the goal."""

_WEIGHT: Final = 100.0
"""Weight of a smaller excess in the merit of a step, in goals."""

_FAR: Final = 1e12
"""Merit of candidates that are beyond their limits."""

_GAIN: Final = 1e-12
"""Share of the merit that is no rounding."""

_REGULAR: Final = 1e-9
"""Least determinant of rows that meet in a corner, scaled to 1."""

_ROOM: Final = 1e-9
"""Rounding of a corner, in ranges of trust."""

_INNER: Final = (1e-4, 1e-5, 1e-6, 1e-7, 1e-3, 1e-2)
"""Ranges around the solution in which candidates with room are sought; the last where friction
makes a kink of a limit, along which the search ends too early."""

_BETWEEN: Final = 4
"""Places for each of the survey: between them cubics are exact to the last digits of a size."""

_COARSE: Final = 9
"""Least number of places in a cell of a first look."""

_CLOSE: Final = 1e-9
"""Distance of cuts, as a share of the turn, within which they are one."""

_APART: Final = 0.05
"""Least distance of two starts, as a share of the range."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Load(ShortRepr):
    """What the contact of a cam carries, and what it can bear.

    Parameters
    ----------
    total_load : callable
        ``total_load(motion)`` returns what the cam has to move.
    friction : FrictionSpec
        Coefficients.
    dragged : callable
        ``dragged(radius)`` returns tangential over normal force of ends, (n, 1), mm.
    most : float, N/mm
        Product of normal force and relative curvature at which the pressure is at its limit.
    knots : (k,) array, rad
        Where loads jump or bend.
    """

    total_load: Callable[[DrivenMotion], TotalLoad]
    friction: FrictionSpec
    dragged: Callable[[Any], Any]
    most: float
    knots: Array


@dataclass(frozen=True, kw_only=True)
class SizeLimits(ShortRepr):
    """Limits of the sizes of a cam.

    Parameters
    ----------
    rise, back : float, rad
        Largest pressure angles on rises and returns, below a right angle.
    convex : float, mm
        Least convex radius of the profile.
    hollow : float, mm
        Least concave radius; 0 without a limit.
    wall : float, mm
        Least radius of the profile from the axis.
    """

    rise: float
    back: float
    convex: float = 0.0
    hollow: float = 0.0
    wall: float = 0.0


class Measured(NamedTuple):
    """What was measured of n candidates.

    Parameters
    ----------
    goals : (j, n) array
        What is to be least: the largest of them.
    excess : mapping of str to (k, n) array
        By the names of limits, each phase for itself: such parts have slopes where the largest of
        them has a kink.
    """

    goals: Array
    excess: Mapping[str, Array]

    @property
    def goal(self) -> Array:
        """What is to be least, (n,)."""
        largest: Array = self.goals.max(axis=0)
        return largest

    @property
    def parts(self) -> Array:
        """All excesses, (k, n)."""
        return np.concatenate([*self.excess.values()])

    @property
    def worst(self) -> Array:
        """Largest excess of each, (n,)."""
        largest: Array = self.parts.max(axis=0)
        return largest


@dataclass(frozen=True, eq=False, kw_only=True)
class Sizing:
    """The candidates of a follower and a lift under limits.

    Parameters
    ----------
    spec : FollowerSpec
        The follower; sizes in it that are asked for are of no meaning.
    program : Program
        The lift.
    limits : SizeLimits
        Limits.
    beside : bool
        Whether the pivot has to stand beside the cam: where its distance is asked for.
    from_base : bool
        Whether the size ``radius`` is the base radius of a round follower.
    slender : bool
        Whether the roller may have half the prime radius at most.
    load : Load, optional
        What the cam has to move, where the contact pressure is limited.
    goal : (str, float)
        What is to be least: ``size``, the largest radius of the profile, ``pressure``, ``rise``
        or ``back``, the tangent of the largest pressure angle of all phases, rises or returns, or
        ``convex``, the least convex radius; times a factor.
    free : tuple of str
        Names of limits that do not bind; the largest excess of them is to be least instead.
    """

    spec: FollowerSpec
    program: Program
    limits: SizeLimits
    beside: bool = False
    from_base: bool = False
    slender: bool = False
    load: Load | None = None
    goal: tuple[str, float] = ("size", 1.0)
    free: tuple[str, ...] = ()

    def measured(self, sizes: Mapping[str, Array], *, coarse: bool = False) -> Measured:
        """Return what is measured of candidates.

        Parameters
        ----------
        sizes : mapping of str to (n,) array, mm
            By the names of `SIZES`; those that the follower does not have are of no meaning.
        coarse : bool
            Whether to look at some places of the lift only, not between them.
        """
        follower, reach = self._follower(sizes)
        low, high = self.program.range
        roller = np.asarray(sizes["roller"])
        with np.errstate(all="ignore"):  # out of reach
            far = _distance(follower, high) - roller
            places = self._coarse if coarse else self._fine
            contact = self._contact(follower, places)
            values, excess = self._angles(contact, places, len(roller))
            if follower.has_centre:
                radii, of_radii = self._round(contact, places, roller)
            else:
                radii, of_radii = self._flat(contact, places, far)
            values["convex"], excess = radii, excess | of_radii
            if self.load is not None:
                excess["contact"] = self._pressed(self.load, follower, contact, places)
            excess["reach"] = np.maximum(reach, _passed(follower, low, high))[None]
            if self.limits.wall > 0.0:
                near = _distance(follower, low) - roller
                excess["wall"] = 1.0 - near[None] / self.limits.wall
            if self.slender:
                excess["roller"] = 2.0 * roller[None] / _prime(follower) - 1.0
            if self.beside:
                excess["pivot"] = far[None] / np.asarray(sizes["pivot"]) - 1.0
        excess = {name: np.where(np.isnan(one), np.inf, one) for name, one in excess.items()}
        name, sign = self.goal
        goals = sign * (values | {"size": far[None]})[name]
        if sign < 0.0:
            goals = goals.max(axis=0)[None] if name == "convex" else goals.min(axis=0)[None]
        if self.free:
            goals = np.concatenate([excess.pop(one) for one in self.free if one in excess])
        return Measured(np.where(np.isnan(goals), np.inf, goals), excess)

    def _follower(self, sizes: Mapping[str, Array]) -> tuple[Follower, Array]:
        if self.from_base:
            sizes = {**sizes, "radius": np.asarray(sizes["radius"]) + sizes["roller"]}
        return followers_of(self.spec, sizes)

    def _contact(self, follower: Follower, places: _Places) -> Contact:
        curve = CamCurve(program=self.program, follower=follower, carrier=Rotating())
        return curve.contact_of(places.lift, places.order)

    def _pressed(self, load: Load, follower: Follower, contact: Contact, places: _Places) -> Array:
        """Return the excess of the contact pressure, by its square, of each phase, (k, n)."""
        s, ds, d2s = places.lift[:3]
        ends, carrier = follower.radius, Rotating()
        support = follower.held(load.friction, self.program.range[1])
        at, tangent = follower.trace(carrier, np.zeros_like(s), follower.start + s, ds, ends)
        held = support, ds
        push, _ = pushing(at, tangent, carrier.passing(at), held, load.dragged(ends))
        force, left = support.normal_force(
            push, load.total_load(DrivenMotion(places.theta, s, ds, d2s)), load.friction
        )
        bend = contact.turning.c[0] / contact.pitch_speed.c[0]
        # 1/(1/bend - radius) + 1/radius
        relative = 1.0 / (ends * (1.0 - bend * ends)) if follower.has_centre else bend
        product = np.where(left > 0.0, np.maximum(force, 0.0), np.inf) * relative
        excess = product / load.most - 1.0
        return np.stack([excess[:, where].max(axis=1) for _, where in places.phases])

    def _angles(
        self, contact: Contact, places: _Places, count: int
    ) -> tuple[dict[str, Array], dict[str, Array]]:
        """Return tangents of the largest pressure angles of phases, and the excesses of angles."""
        level = np.zeros((1, count))
        steep = contact.across / contact.along
        values, excess = {"rise": level, "back": level}, {}
        for name, limit in (("rise", self.limits.rise), ("back", self.limits.back)):
            phases = [*places.of_kind(name)]
            if phases:
                both = [places.largest(sign * steep, phases, count) for sign in (1.0, -1.0)]
                values[name] = np.concatenate(both)
                excess[name] = values[name] / math.tan(limit) - 1.0
        return values | {"pressure": np.concatenate([*values.values()])}, excess

    def _round(
        self, contact: Contact, places: _Places, roller: Array
    ) -> tuple[Array, dict[str, Array]]:
        """Return the least convex radii of phases, and the excesses of radii, of a round end.

        By the curvature of the pitch curve, which passes 0 where a convex part becomes concave.
        """
        limits, phases, count = self.limits, [where for _, where in places.phases], len(roller)
        bent = contact.turning / contact.pitch_speed
        bends = places.largest(bent, phases, count)
        excess = {
            "undercut": _impossible(contact.along, contact.pitch_speed, count),
            "convex": bends * (roller + limits.convex) - 1.0,
        }
        if limits.hollow > 0.0:
            hollows = places.largest(-bent, phases, count)
            excess["hollow"] = hollows * (limits.hollow - roller) - 1.0
        return 1.0 / bends - roller, excess

    def _flat(
        self, contact: Contact, places: _Places, far: Array
    ) -> tuple[Array, dict[str, Array]]:
        """Return the least radii of phases, and the excesses of radii, under a face.

        By the radius itself, which is negative where the profile is undercut. Its inverse has a
        peak between the places of the lift where a radius is small.
        """
        limits, phases, count = self.limits, [where for _, where in places.phases], len(far)
        radii = -places.largest(-(contact.pitch_speed / contact.turning), phases, count)
        undercut = _impossible(contact.along, contact.turning, count)
        beyond = (limits.convex - radii) / far
        if limits.convex > 0.0:
            return radii, {"undercut": undercut, "convex": beyond}
        return radii, {"undercut": np.concatenate([undercut, beyond])}

    @cached_property
    def _fine(self) -> _Places:
        return _Places.of(self._cut, 1)

    @cached_property
    def _coarse(self) -> _Places:
        return _Places.of(self._cut, 0)

    @property
    def _cut(self) -> Program:
        """The lift, with cuts where loads jump or bend too."""
        if self.load is None:
            return self.program
        cuts, apart = self.program.cuts, _CLOSE * self.program.period
        near = np.abs(self.load.knots[:, None] - cuts).min(axis=1)
        return replace(self.program, cuts=distinct(cuts, self.load.knots[near > apart]))


@dataclass(frozen=True, eq=False)
class _Places:
    """Places of the lift.

    Parameters
    ----------
    theta : (m,) array, rad
        Cam angles; at the ends of a cell slightly within, as loads may jump there.
    lift : (4 or 3, m) array
        Lift and derivatives.
    step : (m,) array, rad
        To the next place, 0 at the end of a cell.
    phases : tuple of (str, (m,) bool array)
        Kind of each phase, and which of the places are in it.
    order : int
        Whether slopes are wanted, so that extremes between places are found.
    """

    theta: Array
    lift: Array
    step: Array
    phases: tuple[tuple[str, Mask], ...]
    order: int

    def largest(self, jet: Jet, phases: Sequence[Mask], count: int) -> Array:
        """Return the largest values in some phases, (k, n), of n candidates.

        With slopes, those between the places too.
        """
        shape = (count, len(self.step))
        values, *slopes = (np.broadcast_to(one, shape) for one in jet.derivatives())
        if not slopes:
            return np.stack([values[:, where].max(axis=1) for where in phases])
        (slope,) = slopes
        return np.stack(
            [_largest(values[:, where], slope[:, where], self.step[where]) for where in phases]
        )

    def of_kind(self, name: str) -> Iterator[Mask]:
        """Yield which places are in the phases of a kind, ``rise`` or ``back``."""
        return (where for kind, where in self.phases if kind == name)

    @classmethod
    def of(cls, program: Program, order: int) -> _Places:
        """Return places between those of a survey too, or a part of them without slopes."""
        survey = program.survey
        count = survey.places.shape[1]
        if order:
            share = np.linspace(0.0, 1.0, _BETWEEN, endpoint=False)
            gap = np.diff(survey.places, axis=1)[:, :, None]
            inside = (survey.places[:, :-1, None] + gap * share).reshape(len(gap), -1)
            theta = np.concatenate([inside, survey.places[:, -1:]], axis=1)
            lift = np.array(program.derivatives(theta.ravel(), 3)).reshape(4, *theta.shape)
            lift[:, :, ::_BETWEEN] = survey.values[:4]  # at knots from within the phase
        else:
            some = distinct(np.linspace(0, count - 1, max(_COARSE, count // 8)).astype(int))
            theta, lift = survey.places[:, some], survey.values[:3][:, :, some]
        step = np.pad(np.diff(theta, axis=1), ((0, 0), (0, 1)))
        middles = survey.places.mean(axis=1)
        within = 1e-3 * _CLOSE * program.period
        theta = np.clip(theta, theta[:, :1] + within, theta[:, -1:] - within)

        rest = np.ones(len(middles), dtype=bool)
        phases: list[tuple[str, Mask]] = []
        for name, kind in (("rise", "rise"), ("back", "return")):
            for low, high in program.phases(kind):
                cells = (low < middles) & (middles < high)
                rest &= ~cells
                if not cells.any():  # rows turn at their scatter within one cell
                    continue
                phases.append((name, np.repeat(cells, theta.shape[1])))
        if rest.any():
            phases.append(("rest", np.repeat(rest, theta.shape[1])))
        return cls(
            theta=theta.ravel(),
            lift=lift.reshape(3 + order, -1),
            step=step.ravel(),
            phases=tuple(phases),
            order=order,
        )


def _impossible(one: Jet, other: Jet, count: int) -> Array:
    """Return an excess, (1, n), that is infinite where a speed is not positive everywhere."""
    back = np.minimum(one.c[0], other.c[0]) <= 0.0
    return np.where(np.broadcast_to(back, (count, back.shape[-1])).any(axis=1), np.inf, -1.0)[None]


def _largest(values: Array, slopes: Array, step: Array) -> Array:
    """Return the largest value of cubics through values and slopes, (n, m), along each row."""
    start, end = slopes[:, :-1] * step[:-1], slopes[:, 1:] * step[:-1]
    rise = np.diff(values, axis=1)
    square, cube = 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise
    peak = (start > 0.0) & (end < 0.0)
    root = np.sqrt(np.maximum(square * square - 3.0 * cube * start, 0.0))
    t = start / np.where(peak, root - square, 1.0)
    between = values[:, :-1] + t * (start + t * (square + t * cube))
    return np.maximum(values.max(axis=1), np.where(peak, between, -np.inf).max(axis=1))


def _distance(follower: Any, lift: float) -> Array:
    """Return the distance of the centre or face from the axis, (n,), mm, at a lift."""
    p = follower.start + lift
    if not follower.has_centre:
        height: Array = follower.line(p)[0][:, 0]
        return height
    return np.abs(follower.centre(p))[:, 0]


def _prime(follower: Any) -> Array:
    """Return the prime radius of followers with a centre, (n,), mm."""
    return _distance(follower, 0.0)


def _passed(follower: Any, low: float, high: float) -> Array:
    """Return an excess above 0 where a lift brings an arm over the line of centres, (n,)."""
    least, most = follower.start[:, 0] + low, follower.start[:, 0] + high
    if not follower.angular:
        return -least
    limit = follower.highest if follower.has_centre else 0.5 * math.pi
    return np.maximum(-least if follower.has_centre else -least - limit, most - limit)


Unknowns = Mapping[str, tuple[float, float]]
"""The range of each size that is asked for, mm."""


def smallest(
    sizing: Sizing, known: Mapping[str, float], unknown: Unknowns
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the smallest candidate that keeps all limits, and one that keeps them with room.

    Parameters
    ----------
    sizing : Sizing
        What is measured.
    known : mapping of str to float, mm
        Given sizes.
    unknown : mapping of str to (float, float), mm
        Ranges of the others.

    Returns
    -------
    best, inner : dict of str to float, mm
        All sizes. Where no candidate keeps the limits, that with the least excess, twice.
    """
    space = _Space(known, unknown)
    points = _sequence(_FEWEST * len(unknown), len(unknown))
    order = np.lexsort(_rank(sizing.measured(space.sizes(points), coarse=True))[::-1])
    starts: list[Array] = []
    for point in points[order]:
        if all(np.abs(point - one).max() > _APART for one in starts):
            starts.append(point[None])
        if len(starts) == _STARTS:
            break
    near = np.concatenate([_descended(sizing, space, start, coarse=True) for start in starts])
    ranks = _rank(sizing.measured(space.sizes(near), coarse=True))
    return _ended(sizing, space, near[np.lexsort(ranks[::-1])[:1]])


def smallest_from(
    sizing: Sizing, known: Mapping[str, float], unknown: Unknowns, start: Mapping[str, float]
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the smallest candidate near a start (see `smallest`)."""
    space = _Space(known, unknown)
    return _ended(sizing, space, _descended(sizing, space, space.point(start), coarse=True))


def _ended(sizing: Sizing, space: _Space, near: Array) -> tuple[dict[str, float], dict[str, float]]:
    """Return the end of a search, and a candidate with room."""
    best = _descended(sizing, space, near)
    return space.one(best), space.one(_inside(sizing, space, best))


def _inside(sizing: Sizing, space: _Space, best: Array) -> Array:
    """Return a candidate near the best one that keeps its limits with room, (1, d)."""
    none = np.empty((0, 2 * best.shape[1] + 1))
    for reach in _INNER:
        step = _SHARE * reach
        parts = sizing.measured(space.sizes(_crossed(best, step))).parts
        # what no size changes may be at its limit
        changed = np.ptp(np.where(np.isfinite(parts), parts, 0.0), axis=1) > _STILL
        if not changed.any():
            break
        inner = best + _corner(parts[changed], none, step, best[0], reach)
        if sizing.measured(space.sizes(inner)).parts[changed].max() < 0.0:
            return inner
    return best


def _crossed(place: Array, step: float) -> Array:
    """Return a place, (1, d), then a step ahead and a step back in each direction."""
    cross = step * np.eye(place.shape[1])
    return np.concatenate([place, place + cross, place - cross])


@dataclass(frozen=True, eq=False)
class _Space:
    """Candidates as points of the unit cube."""

    known: Mapping[str, float]
    unknown: Unknowns

    def sizes(self, points: Array) -> dict[str, Array]:
        """Return the sizes of points, (n, d)."""
        found = {name: np.full(len(points), value) for name, value in self.known.items()}
        for (name, (low, high)), share in zip(self.unknown.items(), points.T, strict=True):
            even = low <= 0.0  # others are lengths, spread by their logarithm
            found[name] = low + (high - low) * share if even else low * (high / low) ** share
        return found

    def point(self, sizes: Mapping[str, float]) -> Array:
        """Return the point, (1, d), of sizes."""
        shares = [
            (sizes[name] - low) / (high - low)
            if low <= 0.0
            else math.log(sizes[name] / low) / math.log(high / low)
            for name, (low, high) in self.unknown.items()
        ]
        return np.clip([shares], 0.0, 1.0)

    def one(self, point: Array) -> dict[str, float]:
        """Return the sizes of a point, (1, d), as numbers."""
        return {name: float(value[0]) for name, value in self.sizes(point).items()}


def _rank(found: Measured) -> tuple[Array, Array]:
    """Return by what candidates are compared: their excess, and of those near limits their goal.

    Descents end slightly on either side of their limits: no reason to prefer one that is within.
    """
    worst = found.worst
    return np.where(worst > _LOST, worst, -np.inf), found.goal


def _descended(sizing: Sizing, space: _Space, start: Array, *, coarse: bool = False) -> Array:
    """Return the best point near a start, (1, d), by a sequence of linear programs.

    Goals and excesses are replaced by their tangents within a range of trust; the least largest
    goal of those is at a corner of the region that they leave.
    """
    best = start
    trust, end, gain = (_TRUST, _NEARLY, _SLIGHT) if coarse else (_NEAR, _FINEST, _GAIN)

    def measured(points: Array) -> Measured:
        return sizing.measured(space.sizes(points), coarse=coarse)

    def merit(found: Measured) -> Array:
        beyond = np.maximum(found.worst, 0.0)
        near = found.goal + weight * np.minimum(beyond, _LOST)
        return np.where(beyond > _LOST, _FAR * beyond, near)

    size = float(np.abs(measured(start).goal[0]))
    weight = _WEIGHT * (size if 0.0 < size < math.inf else 1.0)
    for _ in range(_MOST_STEPS):
        step = _SHARE * trust
        found = measured(_crossed(best, step))
        feasible = found.worst[0] <= _LOST
        goals = found.goals if feasible else found.parts
        limits = found.parts if feasible else np.empty((0, goals.shape[1]))
        move = _corner(goals, limits, step, best[0], trust)
        if np.abs(move).max() < _STILL:
            break
        tried = np.clip(best + move * np.array([[1.0], [0.5], [0.25]]), 0.0, 1.0)
        scores = merit(measured(np.concatenate([best, tried])))
        first = int(np.argmin(scores))
        if first:
            best = tried[first - 1 : first]
            trust *= 2.0 if first == 1 else 0.5
            if scores[0] - scores[first] < gain * abs(scores[0]):
                break
        else:
            trust *= 0.3
        if trust < end:
            break
    return best


def _corner(goals: Array, limits: Array, step: float, place: Array, trust: float) -> Array:
    """Return the step, (d,), to the corner at which the tangents of goals are least.

    Parameters
    ----------
    goals, limits : (k, 2*d + 1) arrays
        At a place, then a step ahead and a step back in each direction.
    step : float
        That step.
    place : (d,) array
        The place in the unit cube.
    trust : float
        Largest step.
    """
    d = len(place)

    def tangents(values: Array) -> tuple[Array, Array]:
        values = values[np.isfinite(values).all(axis=1)]
        return values[:, 0], (values[:, 1 : d + 1] - values[:, d + 1 :]) / (2.0 * step)

    (goal, by_goal), (limit, by_limit) = tangents(goals), tangents(limits)
    reach = trust * np.abs(by_goal).sum(axis=1)
    high = goal + reach >= (goal - reach).max(initial=-np.inf)
    change = trust * np.abs(by_limit).sum(axis=1)
    near = (limit + change >= 0.0) & (change > 0.0)
    unit = np.abs(by_goal[high]).max(initial=0.0) or 1.0  # near a right angle slopes are steep
    rows = [
        *(np.append(slope, -unit) for slope in by_goal[high]),
        *(np.append(slope, 0.0) for slope in by_limit[near]),
        *np.eye(d, d + 1),
        *-np.eye(d, d + 1),
    ]
    sides = np.concatenate(
        [-goal[high], -limit[near], np.minimum(trust, 1.0 - place), np.minimum(trust, place)]
    )
    matrix = np.array(rows)
    scale = np.abs(matrix).max(axis=1)
    matrix, sides = matrix / scale[:, None], sides / scale
    chosen = np.array([*itertools.combinations(range(len(sides)), d + 1)])
    square, right = matrix[chosen], sides[chosen]
    regular = np.abs(np.linalg.det(square)) > _REGULAR
    corners = np.linalg.solve(square[regular], right[regular][:, :, None])[:, :, 0]
    room = (corners @ matrix.T - sides).max(axis=1)
    allowed = room <= _ROOM * max(trust, float(np.abs(sides).max()))
    if not len(corners):  # nothing has a slope
        return np.zeros(d)
    if not allowed.any():  # the limits cannot be kept within the range: as nearly as possible
        return corners[np.argmin(room), :d]
    return corners[allowed][np.argmin(corners[allowed][:, d]), :d]


def _sequence(count: int, dimensions: int) -> Array:
    """Return points that fill the unit cube evenly, the same each time (additive recurrence)."""
    root = 2.0
    for _ in range(60):  # of x^(d + 1) = x + 1
        root = (1.0 + root) ** (1.0 / (dimensions + 1))
    return (0.5 + np.outer(np.arange(1, count + 1), root ** -np.arange(1.0, dimensions + 1))) % 1.0
