"""Trimming: removal of the parts of a profile that the follower would cut off.

An undercut profile crosses itself: between two crossings it lies where the follower passes at
another angle. The remaining profile bounds the region of positive winding number that contains the
axis (see `gearcam.numeric.crossings`), and its corners are self-crossings of the curve. A loop of
nanometres, which rounding hides, is cut out where it turns back.

Between the cam angles of the two sides of a corner the follower touches only corners; its lift
there has a closed form, and the largest lift that is lost is a root of a derivative.

Refused: crossings that cannot be separated, and hundreds of undercut stretches.

Depends on curve, measures and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.cams.carriers import Carrier
from gearcam.cams.curve import CamCurve, ProfileSegments
from gearcam.cams.followers import Follower
from gearcam.cams.measures import Extreme, over_the_end
from gearcam.numeric.arrays import Array, Plane, distinct
from gearcam.numeric.contour import Contour
from gearcam.numeric.crossings import (
    Branch,
    Chain,
    CurvePoint,
    Ring,
    remaining,
    rows_between,
)
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import extremes
from gearcam.numeric.sampling import Sampler

_PROBES = 33
"""Points on each segment at which its number of chords is computed."""

_EFFORT = 1e-6
"""Chords assigned to a straight piece between probes, so that their number rises everywhere."""

_AROUND = 97
"""Points in and next to every undercut stretch, so that its loop is resolved."""

_BESIDE = 3.0
"""Distance of these points to both sides, in widths of the stretch: loops close within twice."""

_WIDEST = 0.01
"""Largest distance of these points from a jump that goes back, in periods."""

_RUNS = 8.0
"""Run-in and run-out tried as remedy where a wall is undercut at its ends, in follower radii."""

_ROUNDS = 3
"""How often crossings are searched, each time with chords four times finer; then once more around
jumps."""

_MOST = 500
"""Largest number of undercut stretches: with more, each crosses hundreds of others."""

_TINY = 2e-8
"""Length of a backward stretch, in sizes of the cam, below which its loop is not searched: without
it less lift is lost than this times the angle of the stretch."""

_OVERLAP = 1e-12
"""Angle, rad of a turn, by which an undercut stretch may reach into the remaining profile by
rounding."""

_MISS = 1e-12
"""Distance of two curves at their crossing, in sizes of the cam: rounding of points."""

_JOINED = 0.1
"""Largest gap between the sides of a corner, as a share of the chord tolerance."""

_ROUNDING = 4.0 * np.finfo(float).eps
"""Relative rounding of an angle at a crossing: a steep curve moves far by it."""


_NARROWEST = 1e-9
"""Angle, rad of a turn, below which rounding may exchange the two sides of a corner."""


@dataclass(frozen=True, kw_only=True)
class Corner(ShortRepr):
    """A corner left by trimming.

    Parameters
    ----------
    point : complex, mm
        In the cam's frame.
    before, after : float, rad
        Cam angles of its two sides; between them the follower rests on it.
    """

    point: complex
    before: float
    after: float


def star_shaped(points: Plane, tangents: Plane, slides: bool = False) -> bool:
    """Return whether a curve is star-shaped about the axis: then it cannot cross itself.

    Parameters
    ----------
    points, tangents : complex arrays, mm and 1
        All along the curve, which runs forward everywhere.
    slides : bool
        Whether the cam slides: its axis is infinitely far below.
    """
    if slides:
        return bool(np.all(tangents.real > 0.0) or np.all(tangents.real < 0.0))
    side = np.imag(np.conj(points) * tangents)
    return bool(np.all(side > 0.0) or np.all(side < 0.0))


def without_tiny_loops(
    segments: ProfileSegments, undercut: Sequence[tuple[float, float]], size: float
) -> tuple[ProfileSegments, tuple[Corner, ...], list[tuple[float, float]]]:
    """Return a profile without the backward stretches whose loops rounding hides.

    Parameters
    ----------
    segments : ProfileSegments
        The whole profile, in order from the beginning of the turn.
    undercut : sequence of (float, float)
        Cam angles between which it runs backwards, rad.
    size : float, mm
        Of the cam.

    Returns
    -------
    segments : ProfileSegments
        Without those stretches.
    corners : tuple of Corner
        In their places.
    left : list of (float, float)
        The other undercut stretches.
    """
    cut: list[tuple[CurvePoint, CurvePoint]] = []
    left: list[tuple[float, float]] = []
    closed = segments.curve.program.closed
    for parts in over_the_end(undercut, segments.curve.program):
        # a stretch in two parts, on both sides of the turn's end, begins with the later part; a
        # jump at that end is no stretch after it
        ends = _ends(segments, parts[-1][0], parts[0][1] or parts[-1][1])
        begin, end = segments.at(*(np.array(values) for values in zip(*ends, strict=True)))[0]
        if abs(end - begin) > _TINY * size:
            left += parts
        else:
            cut.append(ends)
    if not cut:
        return segments, (), left
    after = [*cut[1:], cut[0]] if closed else [*cut, (segments.last, segments.last)]
    before = cut if closed else [(segments.first, segments.first), *cut]
    stays = [Branch(one[1], two[0]) for one, two in zip(before, after, strict=True)]
    return *cut_out(segments, stays), left


def _ends(segments: ProfileSegments, low: float, high: float) -> tuple[CurvePoint, CurvePoint]:
    """Return the ends of an undercut stretch, which includes jumps next to it."""
    count, back = len(segments.start), segments.backward
    if low == high:
        theta = segments.curve.program.knots[segments.piece]
        k = int(np.flatnonzero(back & (theta == low))[0])
        return CurvePoint(k, float(segments.start[k])), CurvePoint(k, float(segments.end[k]))
    sweep = ~segments.jump
    first = int(np.flatnonzero(sweep & (segments.start <= low) & (low < segments.end))[0])
    last = int(np.flatnonzero(sweep & (segments.start < high) & (high <= segments.end))[0])
    begin, end = CurvePoint(first, low), CurvePoint(last, high)
    if low == segments.start[first] and back[first - 1]:
        begin = CurvePoint((first - 1) % count, float(segments.start[first - 1]))
    after = (last + 1) % count
    if high == segments.end[last] and back[after]:
        end = CurvePoint(after, float(segments.end[after]))
    return begin, end


def trimmed(
    segments: ProfileSegments, undercut: Sequence[tuple[float, float]], tolerance: float
) -> tuple[ProfileSegments, tuple[Corner, ...]]:
    """Return the trimmed profile, with its corners.

    Parameters
    ----------
    segments : ProfileSegments
        The whole profile.
    undercut : sequence of (float, float)
        Cam angles between which it runs backwards, rad.
    tolerance : float, mm
        Chord tolerance of the profile, and of the first polygon in the search for crossings.

    Returns
    -------
    segments : ProfileSegments
        The remaining segments, beginning at a corner if there is one.
    corners : tuple of Corner
        In order of the segments.

    Raises
    ------
    InfeasibleError
        If the crossings cannot be separated, or are too many.
    """
    if len(undercut) > _MOST:
        what = "the profile is undercut in too many places to be trimmed"
        raise beyond_limit(
            what, "[cam]", len(undercut), _MOST, "use a lift with fewer waves or less noise"
        )
    for number in range(_ROUNDS + 1):
        # a loop of a slight jump, whose sides are nearly straight, is seen among short chords only
        jumps = number == _ROUNDS
        chain = _chain(segments, undercut, tolerance * 0.25**number, jumps=jumps)
        rings = [
            ring for ring in remaining(segments, [chain])[0] if chain.open or _about_axis(ring)
        ]
        # too long chords may have missed a loop
        if len(rings) == 1 and _meets(segments, rings[0], chain, tolerance):
            kept = cut_out(segments, rings[0].branches) if rings[0].crossed else (segments, ())
            if not _backwards(kept[0], undercut):
                return kept
    if segments.curve.program.open:
        run, runs = _RUNS * abs(segments.curve.inset), ("cam.run_in_mm", "cam.run_out_mm")
        what = "the wall is undercut at the beginning or end of its travel and cannot be trimmed"
        adjustments = (Adjustment(near=dict.fromkeys(runs, 0.0), far=dict.fromkeys(runs, run)),)
        raise InfeasibleError(
            what,
            where="[cam]",
            nearest="use longer run_in_mm and run_out_mm",
            adjustments=adjustments,
        )
    what = "the profile has too many self-intersections: the trimmed profile cannot be determined"
    raise InfeasibleError(what, where="[cam]", nearest="its pieces do not join to one closed line")


def _backwards(segments: ProfileSegments, undercut: Sequence[tuple[float, float]]) -> bool:
    """Return whether any remaining part runs backwards."""
    if np.any(segments.backward):
        return True
    start, end = segments.start[~segments.jump], segments.end[~segments.jump]
    overlap = _OVERLAP * segments.curve.program.grain
    return any(
        bool(np.any(np.minimum(end, high) - np.maximum(start, low) > overlap))
        for low, high in undercut
    )


def _meets(segments: ProfileSegments, ring: Ring, chain: Chain, tolerance: float) -> bool:
    """Return whether curves meet at the crossings of a ring, within rounding and tolerance."""
    places = [place for branch in ring.branches for place in branch]
    index, parameter = (np.array(values) for values in zip(*places, strict=True))
    rounding = _ROUNDING * np.abs(parameter)
    ends = np.sort([segments.start[index], segments.end[index]], axis=0)
    # a curve at rest at its beginning may be fast within the rounding of an angle
    beside = (np.clip(parameter + shift, *ends) for shift in (-rounding, 0.0, rounding))
    moves = [rounding * np.abs(segments.moving(index, place)[1]) for place in beside]
    rounded = _MISS * float(np.abs(chain.points).max()) + float(np.max(moves))
    return ring.gap <= min(rounded, _JOINED * tolerance)


def _about_axis(ring: Ring) -> bool:
    """Return whether a ring contains the axis."""
    p = ring.polygon
    return float(np.angle(np.roll(p, -1) * np.conj(p)).sum()) > math.pi


def _chain(
    segments: ProfileSegments,
    undercut: Sequence[tuple[float, float]],
    tolerance: float,
    *,
    jumps: bool,
) -> Chain:
    """Return all segments as chords, counter-clockwise.

    They are fine around undercut stretches, and around `jumps` if these are wanted.
    """
    number, low, high = [], [], []
    beside = _beside(segments, undercut, jumps=jumps)
    for k in range(len(segments.start)):
        start, end = float(segments.start[k]), float(segments.end[k])
        probes = np.linspace(start, end, _PROBES)
        if not segments.jump[k]:
            probes = distinct(probes, segments.curve.program.cuts_between(start, end))
        points, tangents = segments.at(np.full(len(probes), k), probes)
        turning = np.abs(np.angle(tangents[1:] * np.conj(tangents[:-1])))
        # the square root of a chord's error adds up along the curve
        effort = np.sqrt(turning * np.abs(np.diff(points)) / (8.0 * tolerance)) + _EFFORT
        total = np.concatenate([[0.0], np.cumsum(effort)])
        count = max(8, math.ceil(float(total[-1])))
        places = np.interp(np.linspace(0.0, float(total[-1]), count + 1), total, probes)
        places[-1] = end
        if not segments.jump[k]:
            inside = slice(*np.searchsorted(beside, [np.nextafter(start, np.inf), end]).tolist())
            places = distinct(places, beside[inside])
        number.append(np.full(len(places) - 1, k))
        low.append(places[:-1])
        high.append(places[1:])
    curve, lows = np.concatenate(number), np.concatenate(low)
    highs = np.concatenate(high)
    if segments.curve.program.open:
        curve, lows = np.append(curve, curve[-1]), np.append(lows, highs[-1])
    points = np.conj(segments.at(curve, lows)[0])  # a cam's curve runs clockwise
    curve, lows = curve[: len(highs)], lows[: len(highs)]
    return Chain(curve=curve, low=lows, high=highs, points=points)


def _beside(
    segments: ProfileSegments, stretches: Sequence[tuple[float, float]], *, jumps: bool
) -> Array:
    """Return angles in and next to undercut stretches, also a period before and after, rising."""
    low, high = np.reshape(stretches, (-1, 2)).T
    period = segments.curve.program.period
    width = np.where(low < high, high - low, _jumped(segments, low)) if jumps else high - low
    more = _BESIDE * width
    places = np.linspace(low - more, high + more, _AROUND)
    turns = period * np.array([-1.0, 0.0, 1.0])  # an open curve has nothing there
    return np.sort((places + turns[:, None, None]).ravel())


def _jumped(segments: ProfileSegments, theta: Array) -> Array:
    """Return by which angle a profile needs to go on as far as jumps at `theta` go back, (n,)."""
    program, widths = segments.curve.program, np.zeros(len(theta))
    for k in np.flatnonzero(segments.backward):
        both, ends = np.full(2, k), np.array([segments.start[k], segments.end[k]])
        points, _ = segments.at(both, ends)
        beside = np.array([(k - 1) % len(segments.start), (k + 1) % len(segments.start)])
        places = np.array([segments.end[beside[0]], segments.start[beside[1]]])
        speed = float(np.abs(segments.moving(beside, places)[1]).min())
        width = _WIDEST * program.period
        back = abs(points[1] - points[0])
        at = theta == program.knots[segments.piece[k]]
        widths[at] = back / speed if back < width * speed else width
    return widths


def crossing_chords(
    called: str, sampler: Sampler, contour: Callable[[Sampler], Contour]
) -> InfeasibleError:
    """Return the error for chords that cross; where a profile is narrow finer ones may not.

    Parameters
    ----------
    called : str
        Name of the profile in messages.
    sampler : Sampler
        With the tolerance of the chords.
    contour : callable
        ``contour(sampler) -> Contour``.
    """
    for number in range(1, _ROUNDS):
        finer = replace(sampler, tolerance=sampler.tolerance * 0.25**number)
        if contour(finer).polygon.is_valid:
            key = "output.chord_tolerance_mm"
            what = f"the {called} has a part so narrow that its chords cross"
            note = "at the limit they do not cross"
            return beyond_limit(
                what, key, sampler.tolerance, finer.tolerance, note, near=finer.tolerance
            )
    what = f"the {called} crosses itself, or has a part much narrower than its chord tolerance"
    return InfeasibleError(what, where="[cam]", nearest="its chords do not form one closed line")


def cut_out(
    segments: ProfileSegments, branches: Sequence[Branch]
) -> tuple[ProfileSegments, tuple[Corner, ...]]:
    """Return the remaining parts of a curve.

    Parameters
    ----------
    segments : ProfileSegments
        The whole curve.
    branches : sequence of Branch
        The remaining branches in order; each ends where the next one begins, the last where the
        first begins or at an open curve's end.

    Returns
    -------
    segments : ProfileSegments
        The remaining segments, beginning at a corner.
    corners : tuple of Corner
        At the ends of the branches.
    """
    corners = []
    following = branches[1:] if segments.curve.program.open else [*branches[1:], branches[0]]
    for one, two in zip(branches, following, strict=False):
        index, places = (np.array(values) for values in zip(one.end, two.begin, strict=True))
        before, after = segments.states(index, places)[0].tolist()
        point = complex(segments.at(index, places)[0][0])
        corners.append(Corner(point=point, before=before, after=after))
    index, start, end, corner = rows_between(segments, branches)
    kept = replace(segments.taken(index), start=start, end=end, corner=corner)
    return kept, tuple(corners)


def resting(
    follower: Follower, carrier: Carrier, point: complex, side: int = 1
) -> Callable[[Jet], Jet]:
    """Return the lift of a follower that rests on a point of the cam.

    Parameters
    ----------
    follower : Follower
        The follower.
    carrier : Carrier
        Motion of the cam.
    point : complex, mm
        In the cam's frame, turning counter-clockwise.
    side : {1, -1}
        Whether a round follower is above the point or pressed against it from below.

    Returns
    -------
    callable
        ``lift(theta) -> Jet``, mm or rad; nan where the point cannot be touched.
    """

    def lift(theta: Jet) -> Jet:
        with np.errstate(divide="ignore", invalid="ignore"):
            position, room = follower.rest(*carrier.placed(theta, point), side=side)
        missed = (room < 0.0) | ~np.isfinite(position.c[0])
        s = position - follower.start
        return Jet([np.where(missed, np.nan, value) for value in s.c])

    return lift


def lost_lift(curve: CamCurve, corner: Corner) -> Extreme:
    """Return the largest lift lost at a corner, and its cam angle.

    Parameters
    ----------
    curve : CamCurve
        The untrimmed profile, turning counter-clockwise.
    corner : Corner
        Corner of the trimmed profile.

    Returns
    -------
    Extreme
        Cam angle, rad, and lift, mm or rad, not negative.

    Raises
    ------
    InfeasibleError
        If the follower cannot touch the corner anywhere.
    """
    program, side = curve.program, curve.lift_sign
    start, end = corner.before, corner.after
    rest = resting(curve.follower, curve.carrier, corner.point, side)
    if end < start:
        end += program.period
    if end == start or end - start > program.period - _NARROWEST * program.grain:
        return Extreme(theta=start, value=0.0)

    def missing(theta: Array) -> list[Array]:
        given = rest(Jet.variable(theta, 1)).derivatives()
        return list(side * np.subtract(program.derivatives(theta, 1), given))

    places, values = extremes(missing, program.cuts_between(start, end))
    if np.isnan(values).all():
        raise InfeasibleError(
            "the follower cannot rest on a corner that trimming leaves",
            where=curve.carrier.driver.text(start),
            nearest="its arm or its pivot does not allow that position",
        )
    best = int(np.nanargmax(values))
    theta = float(places[best]) % program.period
    if program.period - theta <= _ROUNDING * program.period:  # the end of a turn is its beginning
        theta = 0.0
    return Extreme(theta=theta, value=max(0.0, float(values[best])))
