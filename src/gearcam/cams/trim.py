"""Trimming: what is left of a profile when the follower's own passing has cut it.

An undercut profile crosses itself: between two crossings it lies where the follower passes at
another angle. What is left is the region of positive winding number that holds the axis (see
`gearcam.numeric.crossings`), and its corners are crossings of the curve with itself.

Refused: crossings that cannot be told apart, and hundreds of undercut stretches.

Depends on curve and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gearcam.cams.curve import ProfileSegments
from gearcam.display import Brief
from gearcam.errors import InfeasibleError, Way
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.contour import Contour
from gearcam.numeric.crossings import Branch, Chain, Ring, remaining, rows_between
from gearcam.numeric.sampling import Sampler

_PROBES = 33
"""Places on each segment at which its chords are counted."""

_EFFORT = 1e-6
"""Chords that a straight piece between probes is given, so that the count rises everywhere."""

_AROUND = 97
"""Places in and beside every undercut stretch: its loop is seen at its own size."""

_BESIDE = 3.0
"""How far beside, in widths of the stretch: the loop closes within twice of it."""

_RUNS = 8.0
"""Run before and after a way that is tried where a wall is undercut there, in followers' radii."""

_ROUNDS = 8
"""Times that chords are made four times finer where crossings are not told apart."""

_MOST = 500
"""Undercut stretches that are trimmed: of more, each crosses hundreds of others."""

_OVERLAP = 1e-12
"""Angle, rad, by which an undercut stretch may reach into what is left: rounding."""

_MISS = 1e-12
"""Distance of two curves at their crossing, in sizes of the cam: rounding of points."""

_JOINED = 0.1
"""Part of the chord tolerance by which sides may miss each other at a corner."""

_ROUNDING = 4.0 * np.finfo(float).eps
"""Part of an angle by which it is rounded where two curves cross: a steep curve moves far by it."""


@dataclass(frozen=True, kw_only=True)
class Corner(Brief):
    """A corner where trimming has cut.

    Parameters
    ----------
    point : complex, mm
        In the cam's frame.
    before, after : float, rad
        Cam angles at which its two sides are drawn; between them the follower rests on it.
    """

    point: complex
    before: float
    after: float


def star_shaped(points: Plane, tangents: Plane, slides: bool = False) -> bool:
    """Return whether a curve is seen whole from the axis: it then cannot cross itself.

    Parameters
    ----------
    points, tangents : complex arrays, mm and 1
        All along the curve, which is drawn forward everywhere.
    slides : bool
        Whether the cam slides: its axis is infinitely far below.
    """
    if slides:
        return bool(np.all(tangents.real > 0.0) or np.all(tangents.real < 0.0))
    side = np.imag(np.conj(points) * tangents)
    return bool(np.all(side > 0.0) or np.all(side < 0.0))


def trimmed(
    segments: ProfileSegments, undercut: Sequence[tuple[float, float]], tolerance: float
) -> tuple[ProfileSegments, tuple[Corner, ...]]:
    """Return what is left of a profile, with its corners.

    Parameters
    ----------
    segments : ProfileSegments
        The whole profile.
    undercut : sequence of (float, float)
        Cam angles between which it runs backwards, rad.
    tolerance : float, mm
        Chord error of the polygons in which crossings are sought.

    Returns
    -------
    segments : ProfileSegments
        Those that are left, beginning at a corner if there is one.
    corners : tuple of Corner
        In the order of drawing.

    Raises
    ------
    InfeasibleError
        If the crossings cannot be told apart, or are too many.
    """
    if len(undercut) > _MOST:
        raise InfeasibleError(
            "the profile is undercut in so many places that what is left of it is not sought",
            where="[cam]",
            value=len(undercut),
            limit=_MOST,
            nearest="a lift with fewer waves, or less noise, has fewer of them",
        )
    for number in range(_ROUNDS):
        chain = _chain(segments, undercut, tolerance * 0.25**number)
        rings = [
            ring for ring in remaining(segments, [chain])[0] if chain.open or _about_axis(ring)
        ]
        # chords that are too long may have missed a loop
        if len(rings) == 1 and _meets(segments, rings[0], float(np.abs(chain.points).max())):
            made = cut_out(segments, rings[0].branches) if rings[0].crossed else (segments, ())
            if not _backwards(made[0], undercut):
                return made
    if segments.curve.program.open:
        run, runs = _RUNS * abs(segments.inset), ("cam.run_in_mm", "cam.run_out_mm")
        raise InfeasibleError(
            "the wall is undercut where its way begins or ends: what is left cannot be told",
            where="[cam]",
            nearest="longer run_in_mm and run_out_mm leave room for what is cut away",
            ways=(Way(near=dict.fromkeys(runs, 0.0), far=dict.fromkeys(runs, run)),),
        )
    raise InfeasibleError(
        "the profile crosses itself so often that what is left cannot be told",
        where="[cam]",
        nearest="no piece of it has a place in the order of the others",
    )


def _backwards(segments: ProfileSegments, undercut: Sequence[tuple[float, float]]) -> bool:
    """Return whether anything is left that runs backwards."""
    if np.any(segments.backward):
        return True
    start, end = segments.start[~segments.jump], segments.end[~segments.jump]
    return any(
        bool(np.any(np.minimum(end, high) - np.maximum(start, low) > _OVERLAP))
        for low, high in undercut
    )


def _meets(segments: ProfileSegments, ring: Ring, size: float) -> bool:
    """Return whether curves meet at the crossings of a ring, as near as rounding allows."""
    places = [place for branch in ring.branches for place in branch]
    index, parameter = (np.array(values) for values in zip(*places, strict=True))
    rounding = _ROUNDING * np.abs(parameter)
    ends = np.sort([segments.start[index], segments.end[index]], axis=0)
    # a curve that stands at its beginning may be fast within the rounding of an angle
    beside = (np.clip(parameter + shift, *ends) for shift in (-rounding, 0.0, rounding))
    ways = [rounding * np.abs(segments.moving(index, place)[1]) for place in beside]
    return ring.gap <= _MISS * size + float(np.max(ways))


def demand_joined(segments: ProfileSegments, tolerance: float) -> None:
    """Refuse a profile whose sides do not meet at its corners.

    Where it moves far within the rounding of a cam angle, crossings are no better than that.

    Parameters
    ----------
    segments : ProfileSegments
        All that is left of it.
    tolerance : float, mm
        Its chord tolerance.

    Raises
    ------
    InfeasibleError
        If sides stay farther apart than a tenth of it.
    """
    number = np.arange(len(segments.start))
    after = np.roll(number, -1)
    sides = (number, segments.end), (after, segments.start[after])
    before, behind = (segments.at(*side)[0] for side in sides)
    gaps = np.abs(behind - before)
    if segments.curve.program.open:
        gaps = gaps[:-1]
    worst = int(gaps.argmax())
    gap, limit = float(gaps[worst]), _JOINED * tolerance
    if gap <= limit:
        return
    fast = max(sides, key=lambda side: float(np.abs(segments.moving(*side)[1][worst])))
    raise InfeasibleError(
        "the lift changes so abruptly that two sides of a corner miss each other by the rounding "
        "of cam angles",
        where=segments.curve.mechanism.driver.told(float(segments.states(*fast)[0][worst])),
        value=gap,
        limit=limit,
        unit="mm",
        nearest="the limit is a tenth of the chord tolerance; a longer phase there leaves less",
    )


def _about_axis(ring: Ring) -> bool:
    """Return whether a ring holds the axis."""
    p = ring.polygon
    return float(np.angle(np.roll(p, -1) * np.conj(p)).sum()) > math.pi


def _chain(
    segments: ProfileSegments, undercut: Sequence[tuple[float, float]], tolerance: float
) -> Chain:
    """Cut every segment into chords, finely around undercut stretches; counter-clockwise."""
    number, low, high = [], [], []
    beside = _beside(undercut)
    for k in range(len(segments.start)):
        start, end = float(segments.start[k]), float(segments.end[k])
        probes = np.linspace(start, end, _PROBES)
        if not segments.jump[k]:
            probes = np.union1d(probes, segments.curve.program.cuts_between(start, end))
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
            places = np.unique(np.concatenate([places, beside[inside]]))
        number.append(np.full(len(places) - 1, k))
        low.append(places[:-1])
        high.append(places[1:])
    curve, lows = np.concatenate(number), np.concatenate(low)
    highs = np.concatenate(high)
    if segments.curve.program.open:
        curve, lows = np.append(curve, curve[-1]), np.append(lows, highs[-1])
    points = np.conj(segments.at(curve, lows)[0])  # a cam is drawn clockwise
    curve, lows = curve[: len(highs)], lows[: len(highs)]
    return Chain(curve=curve, low=lows, high=highs, points=points)


def _beside(stretches: Sequence[tuple[float, float]]) -> Array:
    """Return places in and beside undercut stretches, also a turn on and back, in rising order."""
    low, high = np.reshape(stretches, (-1, 2)).T
    more = _BESIDE * (high - low)
    places = np.linspace(low - more, high + more, _AROUND)
    turns = 2.0 * math.pi * np.array([-1.0, 0.0, 1.0])  # of an open curve nothing lies there
    return np.sort((places + turns[:, None, None]).ravel())


def crossing_chords(
    called: str, sampler: Sampler, contour: Callable[[Sampler], Contour]
) -> InfeasibleError:
    """Return the refusal of chords that cross: finer ones may not, where a profile is narrow.

    Parameters
    ----------
    called : str
        What people call the profile.
    sampler : Sampler
        With the tolerance of the chords.
    contour : callable
        ``contour(sampler) -> Contour``.
    """
    for number in range(1, _ROUNDS):
        finer = replace(sampler, tolerance=sampler.tolerance * 0.25**number)
        if contour(finer).polygon.is_valid:
            key = "output.chord_tolerance_mm"
            return InfeasibleError(
                f"the {called} is so narrow somewhere that its chords cross",
                where=key,
                value=sampler.tolerance,
                limit=finer.tolerance,
                unit="mm",
                nearest="with the limit they do not",
                ways=(Way(near={key: finer.tolerance}),),
            )
    return InfeasibleError(
        f"the {called} crosses itself, and what is left of it cannot be told",
        where="[cam]",
        nearest="no piece of it has a place in the order of the others",
    )


def cut_out(
    segments: ProfileSegments, branches: Sequence[Branch]
) -> tuple[ProfileSegments, tuple[Corner, ...]]:
    """Return what is left of a curve.

    Parameters
    ----------
    segments : ProfileSegments
        The whole curve.
    branches : sequence of Branch
        What is left of it, in the order of drawing; each ends where the next one begins, the last
        where the first does or at an open curve's end.

    Returns
    -------
    segments : ProfileSegments
        What is left, beginning at a corner.
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
