"""The lift that a given profile produces, from its points alone, without the law.

The follower comes down from outside until it rests: its position is the largest of those at which
it touches a point of the profile. With the profile turned by theta, a point z = x + i*y touches at

==================== ==================================================================
translating round    height of the centre ``y + sqrt(r^2 - (x - e)^2)``
translating flat     height of the face ``y``
oscillating round    ``Psi = Psi_z + arccos((l^2 + D^2 - r^2)/(2*l*D))``
oscillating flat     ``Psi = Psi_z + arcsin(f/D)``
==================== ==================================================================

where ``z = d - D*exp(-i*Psi_z)`` (see `Follower.rest`).

Inside a wall that lies outside the pitch curve, and below the axis, the mirror image is used: the
lowest position becomes the highest.

The same formulas with r, or the face, *grown* by g give the position on a disc of radius g around
z, and so a bound for all points within: blocks of points that cannot be the highest are skipped.

Refused: profiles of too few points, or that do not go around the cam's axis once; profiles that
the follower misses at some angle, or that reach past its pivot.

Source: derived anew; conventions as in `followers`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.cams.carriers import ROTATING, Carrier
from gearcam.cams.followers import Follower
from gearcam.numeric.arrays import Array, Ints, Plane, as_complex
from gearcam.numeric.jets import Jet
from gearcam.numeric.sampling import FEWEST

_ROUNDING: Final = 1e-12
"""Rounding of lengths, over the profile's size."""

_NOISE: Final = 1e-14
"""Rounding of a lift, in rad or over the size of profile and follower: the least error given."""

_TOGETHER: Final = 128
"""Cam angles computed at once."""

_CORNER: Final = 0.5
"""Angle between two chords of a plate, rad, too large for a curve: a corner."""

_LEAST: Final = 3
"""Least number of points of a plate: it may be straight between corners."""

_BLOCK: Final = 8
"""Least number of chords of a block, if there are as many."""

_ALIKE: Final = 1e-12
"""Distance over the profile's size below which neighbours are one point: rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Followed:
    """Motion of a follower on given points.

    Parameters
    ----------
    theta : (m,) array, rad
        Cam angles.
    lift : (m,) array, mm or rad
        Lift at them.
    error : (m,) array, mm or rad
        Estimated error of the lift for exact points: the possible distance of a curve through the
        points from the chords, to either side. A corner cut off by a chord is included only if
        `missed` is given.
    contact : (m,) complex array, mm
        Point of contact, in the cam's frame.
    """

    theta: Array
    lift: Array
    error: Array
    contact: Plane


def follow(
    points: Plane | Array,
    follower: Follower,
    theta: ArrayLike,
    *,
    carrier: Carrier = ROTATING,
    side: int = 1,
    missed: float = 0.0,
) -> Followed:
    """Return the lift that a profile, the polygon of some points, produces.

    Parameters
    ----------
    points : (n,) complex array or (n, 2) array, mm
        A closed profile in the cam's frame, in order, in either sense. For a polyline with bulges
        use `gearcam.numeric.bulges.flatten_bulges`, whose points lie on its arcs. Of a cam that
        slides the mirror image in the y axis, as in output.
    follower : Follower
        The follower.
    theta : (m,) array, rad
        Cam angles.
    carrier : Carrier
        Motion of the cam: it turns counter-clockwise by theta, or slides.
    side : {1, -1}
        Whether the profile lies inside the pitch curve or outside it.
    missed : float, mm
        Chord error of the points; 0 if unknown.

    Returns
    -------
    Followed

    Raises
    ------
    InfeasibleError
        If the points are not a closed profile around the axis, or the follower cannot rest on it.
    """
    profile = profile_points(points, around=carrier.around, missed=missed)
    if not carrier.around:  # given as the mirror image, like all output of a cam that slides
        profile = replace(profile, points=-np.conj(profile.points[::-1]))
    angles = np.atleast_1d(np.asarray(theta, dtype=float))
    if follower.below == (side < 0):
        _demand_clear_pivot(profile, follower, carrier)
        motion = _rested(profile, follower, carrier, angles)
    else:
        # mirrored, a cam that turns does so the other way
        sense = -1.0 if carrier.around else 1.0
        within = side < 0 and carrier.around  # metal to the right of its edge
        other = np.conj(profile.points)
        other = replace(profile, points=other if within else other[::-1].copy())
        mirrored = _rested(other, follower.mirrored(), carrier, sense * angles)
        motion = replace(
            mirrored, theta=angles, lift=-mirrored.lift, contact=np.conj(mirrored.contact)
        )
    return motion if carrier.around else replace(motion, contact=-np.conj(motion.contact))


def _rested(
    profile: ProfilePoints, follower: Follower, carrier: Carrier, angles: Array
) -> Followed:
    """Return the motion of a follower that rests on a profile, or inside it below the axis."""
    noise = _NOISE * (1.0 if follower.angular else profile.size + follower.radius)
    parts = []
    for first in range(0, max(len(angles), 1), _TOGETHER):
        some = angles[first : first + _TOGETHER]
        parts.append(_highest(profile, follower, carrier.frame(some), some))
    position, error, contact = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Followed(
        theta=angles,
        lift=position - follower.start,
        error=np.maximum(error, noise),
        contact=contact,
    )


def _demand_clear_pivot(profile: ProfilePoints, follower: Follower, carrier: Carrier) -> None:
    """Refuse a profile that reaches past the pivot of a swinging follower."""
    limit = follower.clear
    if carrier.around and profile.size >= limit:
        what, rule = (
            "the profile reaches past the follower's pivot",
            "place the pivot farther from the cam",
        )
        raise beyond_limit(what, "its largest radius", profile.size, limit, rule, unit="mm")


def _highest(
    profile: ProfilePoints, follower: Follower, pose: tuple[Plane, Plane], angles: Array
) -> tuple[Array, Array, Plane]:
    """Return position, error and contact at each angle.

    Raises
    ------
    InfeasibleError
        If nothing is touched at one of them.
    """
    (turn, shift), tolerance = pose, _ROUNDING * profile.size
    (number, chord, upper), lower = _candidates(profile, follower, (turn, shift), tolerance)
    start, step = profile.points[chord], profile.chords[chord]
    z, steps = turn[number] * start + shift[number], turn[number] * step
    positions, part = _on_chord(follower, z, steps, 0.0, tolerance)
    upper = np.maximum(upper, positions)
    # even if a chord is not touched its curve may be: on a steep plate that of the next chord
    highest = np.full(len(angles), -np.inf)
    np.maximum.at(highest, number, upper)
    touched = np.isfinite(positions)
    point, within, position = (start + part * step)[touched], number[touched], positions[touched]
    order = np.lexsort((position, within))
    last = np.searchsorted(within[order], np.arange(len(angles)), side="right")
    missed = np.diff(last, prepend=0) == 0
    if missed.any():
        raise InfeasibleError(
            "the follower meets no point of the profile",
            where="cam angle",
            value=math.degrees(float(angles[missed][0])),
            unit="deg",
        )
    best = order[last - 1]
    rest = position[best]
    np.maximum.at(lower, number, _certain(follower, z, steps, profile.hollow[chord], tolerance))
    free = np.isneginf(lower)
    np.logical_or.at(free, number, follower.radius < profile.hollow[chord])
    if free.any():
        below = _left(follower, z, steps, profile.hollow[chord], tolerance)
        lower[free] = np.maximum(lower, _passed(rest, number, upper, below))[free]
    return rest, np.maximum(highest - rest, rest - lower), point[best]


def _passed(rest: Array, number: Ints, upper: Array, below: Array) -> Array:
    """Return the lowest possible rest of a follower: below all bands that it is in.

    Bands around chords, which contain the curve, are entered at `upper` and left at `below`, each
    at the angle with its `number`.
    """
    lowest, before = rest.copy(), np.full(rest.shape, np.inf)
    while np.any(lowest < before):
        before = lowest.copy()
        joined = upper >= before[number]
        np.minimum.at(lowest, number[joined], below[joined])
    return lowest


# --- one place ---------------------------------------------------------------------------------


def _reached(
    follower: Follower, z: Plane, grow: Array | float = 0.0, tolerance: float = 0.0
) -> Array:
    """Return the positions on discs; -inf if out of reach by more than the tolerance."""
    position, room = _rest(follower, z, grow)
    met = (room >= -(tolerance**2)) & ~follower.behind(z, grow)
    return np.where(met, position, -np.inf)


def _rest(follower: Follower, z: Plane, grow: Array | float) -> tuple[Array, Array]:
    """Return the positions on discs around `z`, and the room left (see `Follower.rest`)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        position, room = follower.rest(Jet([z.real]), Jet([z.imag]), grow)
    # straight beyond a pivot there is no angle: no bound either
    return np.nan_to_num(np.asarray(position.c[0]), nan=np.inf, posinf=np.inf, neginf=-np.inf), room


# --- one chord ---------------------------------------------------------------------------------


def _on_chord(
    follower: Follower, z: Plane, chord: Plane, grow: Array | float, tolerance: float
) -> tuple[Array, Array]:
    """Return the position on chords from `z`, and the contact: 0 at the start, 1 at the end.

    A flat face rests on the ends. A round follower may touch between them: its centre is then where
    its path leaves the chord's parallel.
    """
    ends = [_reached(follower, place, grow, tolerance) for place in (z, z + chord)]
    position, part = np.maximum(*ends), np.where(ends[0] >= ends[1], 0.0, 1.0)
    share = follower.on_chord(z, chord, grow)
    between = (share >= 0.0) & (share <= 1.0)
    place = z + np.where(between, share, 0.0) * chord
    between &= ~follower.behind(place, grow)
    grown = np.broadcast_to(grow, z.shape)[between]
    position[between] = _rest(follower, place[between], grown)[0]
    part[between] = share[between]
    return position, part


def _certain(follower: Follower, z: Plane, chord: Plane, depth: Array, tolerance: float) -> Array:
    """Return the positions at which curves below their chords, by a depth at most, stop it.

    -inf if the follower is smaller than the depth.
    """
    positions = np.full(z.shape, -np.inf)
    wide = follower.radius >= depth
    positions[wide] = _on_chord(follower, z[wide], chord[wide], -depth[wide], tolerance)[0]
    return positions


def _left(follower: Follower, z: Plane, chord: Plane, depth: Array, tolerance: float) -> Array:
    """Return the positions at which it leaves bands around chords; infinite without a band.

    In the mirror image it enters them.
    """
    return -_on_chord(follower.mirrored(), np.conj(z), np.conj(chord), depth, tolerance)[0]


def _candidates(
    profile: ProfilePoints, follower: Follower, stand: tuple[Plane, Plane], tolerance: float
) -> tuple[tuple[Ints, Ints, Array], Array]:
    """Return the chords that may contain the contact: index of angle and chord, and upper bound.

    Also a lower bound for each angle, -inf where no point is reached.

    `stand` is the pose of the cam. Points lie on the curve, so that the highest of some is a lower
    bound; blocks, and then chords, that cannot reach it are skipped.
    """
    index, middle, radius = profile.blocks
    turn, shift = stand
    upper = _reached(follower, turn[:, None] * middle + shift[:, None], radius, tolerance)
    top = index[np.argmax(upper, axis=1)]
    tops = turn[:, None] * profile.points[top] + shift[:, None]
    lower = _reached(follower, tops, 0.0, tolerance).max(axis=1)
    angle, block = np.nonzero((upper >= lower[:, None] - tolerance) & (upper > -np.inf))
    angle, chord = np.repeat(angle, index.shape[1]), index[block].ravel()
    z = turn[angle] * profile.points[chord] + shift[angle]
    np.maximum.at(lower, angle, _reached(follower, z, 0.0, tolerance))
    height = profile.sagitta[chord]
    upper = _on_chord(follower, z, turn[angle] * profile.chords[chord], height, tolerance)[0]
    keep = (upper >= lower[angle] - tolerance) & (upper > -np.inf)
    return (angle[keep], chord[keep], upper[keep]), lower


# --- the points of a profile -------------------------------------------------------------------


@dataclass(frozen=True, eq=False, kw_only=True)
class ProfilePoints:
    """The points of a profile.

    Parameters
    ----------
    points : (n,) complex array, mm
        Counter-clockwise around the cam's axis at 0, no equal neighbours, first not repeated.
    corner : float, rad
        Angle from which on a point is a corner, whose chords are straight.
    missed : float, mm
        Chord error of the points; 0 if unknown.
    """

    points: Plane
    corner: float = math.inf
    missed: float = 0.0

    @cached_property
    def size(self) -> float:
        """Largest distance from the axis, mm."""
        return float(np.abs(self.points).max())

    @cached_property
    def chords(self) -> Plane:
        """Vectors from each point to the next, mm."""
        return np.roll(self.points, -1) - self.points

    @cached_property
    def sagitta(self) -> Array:
        """Estimated height of the curve over each chord, mm: the larger of those from both ends."""
        length, turn = np.abs(self.chords), self._turns.copy()
        # the arc over one chord may contain all of the angle, limited by the given chord error
        bent = _bent(turn)
        arcs = 0.25 * length * np.maximum(bent, np.roll(bent, -1))
        turn[np.abs(turn) >= self.corner] = 0.0
        back = _heights(length[::-1], np.roll(turn[::-1], 1))[::-1]
        likely = np.maximum(_heights(length, turn), back)
        return np.maximum(likely, np.minimum(arcs, self.missed))

    @cached_property
    def hollow(self) -> Array:
        """The same below each chord, mm; the chord error if the curve turns left at both ends."""
        right = np.minimum(self._turns, np.roll(self._turns, -1)) < 0.0
        return np.where(right, self.sagitta, np.minimum(self.sagitta, self.missed))

    @cached_property
    def _turns(self) -> Array:
        """Angle at each point from the chord before, rad."""
        return np.angle(self.chords * np.conj(np.roll(self.chords, 1)))

    @cached_property
    def blocks(self) -> tuple[Ints, Plane, Array]:
        """Blocks of neighbouring chords, and a disc around the curve over each.

        Returns
        -------
        chords : (b, k) int array
            Their numbers; the last block overlaps the one before, so that it is full too.
        middle : (b,) complex array, mm
        radius : (b,) array, mm
            With twice the estimated heights of the curve.
        """
        count = len(self.points)
        width = min(count, max(_BLOCK, math.isqrt(count) // 2))
        first = np.minimum(np.arange(0, count, width), count - width)
        index = first[:, None] + np.arange(width)
        reach = self.points[(first[:, None] + np.arange(width + 1)) % count]
        middle = 0.5 * (reach[:, 0] + reach[:, -1])
        radius = np.abs(reach - middle[:, None]).max(axis=1)
        return index, middle, radius + 2.0 * self.sagitta[index].max(axis=1)


def _bent(turn: Array) -> Array:
    """Return the largest angles of curves at points, rad.

    Next to an angle of opposite sign both may be differences of larger bends: at least as large as
    their neighbour.
    """
    besides = [np.roll(turn, step) for step in (-1, 1)]
    return np.max([np.abs(turn), *(-np.sign(turn) * angle for angle in besides)], axis=0)


def _heights(length: Array, turn: Array) -> Array:
    """Return heights of a curve over chords, mm, from the angles at their starts, rad.

    Up to the size of the angle before, both chords at an angle have equal heights: a long chord
    between short ones is straight. Any excess of the angle is a bend of the chord itself, as over a
    gap in the points, at most that of the circle through both chords.
    """
    before = np.roll(length, 1)
    bend = 0.25 * np.abs(turn) * length / (length + before)
    more = 0.25 * length * (np.abs(turn) - np.sign(turn) * np.roll(turn, 1))
    return np.minimum(bend * length, bend * before + np.maximum(more, 0.0))


def profile_points(
    points: Plane | Array, around: bool = True, missed: float = 0.0
) -> ProfilePoints:
    """Return the points of a profile, cleaned.

    Parameters
    ----------
    points : (n,) complex array or (n, 2) array, mm
        A closed profile in order, in either sense; equal neighbours are dropped.
    around : bool
        Whether it goes around the cam's axis, as for a cam that turns.
    missed : float, mm
        Chord error of the points; 0 if unknown.

    Returns
    -------
    ProfilePoints

    Raises
    ------
    InfeasibleError
        If the points are not a closed profile around the cam's axis.
    """
    if np.iscomplexobj(points):
        z = np.asarray(points, dtype=np.complex128)
    else:
        z = as_complex(np.asarray(points, dtype=np.float64))
    if not np.all(np.isfinite(z)):
        raise InfeasibleError(
            "the profile contains numbers that are not finite",
            where=f"point {int(np.argmin(np.isfinite(z)))}",
        )
    z = z[np.abs(z - np.roll(z, 1)) > _ALIKE * np.abs(z).max(initial=0.0)]
    least = FEWEST if around else _LEAST
    if len(z) < least:
        raise beyond_limit("the profile has too few points", "", len(z), least, unit="points")
    if not around:
        turned = float((np.conj(z) * np.roll(z, -1)).imag.sum())
        points = z if turned > 0.0 else z[::-1].copy()
        return ProfilePoints(points=points, corner=_CORNER, missed=missed)
    turns = float(np.angle(np.roll(z, -1) * np.conj(z)).sum()) / (2.0 * math.pi)
    if abs(abs(turns) - 1.0) > 0.25 or not np.all(z):
        what = "the profile does not go around the cam's axis once"
        rule = "give one closed line in order, with the origin inside"
        raise beyond_limit(what, "", turns, 1.0, rule, unit="turns")
    return ProfilePoints(points=z if turns > 0.0 else z[::-1].copy(), missed=missed)
