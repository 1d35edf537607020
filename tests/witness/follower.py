"""Followers once more: let down from outside until they rest on the smooth pieces of a profile.

First by distances alone: a follower that is some way off the polygon of the points may come down by
what moves none of it farther than that. Where it stops, each place that is nearly as near as the
nearest is made exact by Newton's method: a circle's centre on the parallel of the curve, a face on
the curve's tangent, the curve a polynomial through eight neighbours; at the end of a piece, a
corner perhaps, it rests on the point itself. The highest counts.

Frames and followers as in `cam_sweep`; the profile stands in the cam's frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from witness.cam_sweep import Follower, dot, pairs

Array = NDArray[np.float64]
Plane = Any
"""A complex array: the stubs cannot follow their products."""

NEIGHBOURS = 8
OFF = 1e-5
"""Distance over the profile's size at which the way down by distances ends."""
HIGHER = 1e-3
"""The most by which what is exact may be higher than that, over the same."""
STEPS = 20
MISS = 1e-9
"""What a touch may miss when Newton's method ends, mm."""
AT_END = 1e-9
"""Share of its neighbours' extent by which a contact may lie beyond the end of a piece."""


@dataclass(frozen=True)
class Rest:
    """Where a follower rests: heights or angles of the arm, and the touched places of the cam."""

    position: Array
    contact: Plane


def rest(pieces: Sequence[Plane], follower: Follower, theta: Array) -> Rest:
    """Put a follower on a profile at cam angles.

    Parameters: the smooth pieces of the profile as points (n,), in order, each with both its ends;
    a smooth closed one is one piece whose ends overlap by some points.
    """
    theta = np.atleast_1d(theta)
    around: Plane = np.concatenate(pieces)
    if (np.conj(around) * np.roll(around, -1)).imag.sum() < 0.0:
        pieces = [piece[::-1] for piece in reversed(pieces)]
    start = _let_down(np.concatenate(pieces), follower, theta)
    found = [_touches(piece, follower, theta, start) for piece in pieces]
    step, position, point = (np.concatenate(column) for column in zip(*found, strict=True))
    order = np.lexsort((position, step))
    last = np.searchsorted(step[order], np.arange(theta.size), side="right") - 1
    best = order[last]
    assert np.array_equal(step[best], np.arange(theta.size)), "it rests nowhere"
    return Rest(position[best], point[best])


def _seen(follower: Follower, position: Any, theta: Any) -> tuple[Plane, Plane]:
    """Centre of a circle, or a point of a face, seen from the cam; derivative by the position."""
    turn, arm = np.exp(-1j * theta), np.exp(-1j * position)
    if follower.flat:
        place = follower.through(position, np)
        moves = -follower.face * arm if follower.swings else 1j
    else:
        place = follower.centre(position, np)
        moves = 1j * follower.arm * arm if follower.swings else 1j
    return place * turn, moves * turn


def _normal(follower: Follower, position: Any, theta: Any) -> tuple[Plane, Plane]:
    """The normal of a face, seen from the cam, and its derivative by the position."""
    normal = follower.normal(position, np) * np.exp(-1j * theta)
    return normal, -1j * normal if follower.swings else 0.0 * normal


def _away(points: Plane, follower: Follower, position: Array, theta: Array) -> Array:
    """How far points are outside the follower: (angles, points)."""
    place = _seen(follower, position, theta)[0][:, None]
    if not follower.flat:
        return np.abs(points - place) - follower.radius
    return dot(_normal(follower, position, theta)[0][:, None], place - points)


def _let_down(points: Plane, follower: Follower, theta: Array) -> Array:
    """Positions from which a follower is nearly as far as it can go."""
    size = float(np.abs(points).max())
    if follower.swings:
        first = 0.5 * np.pi if follower.flat else np.pi
        speed = size + follower.pivot if follower.flat else follower.arm
    else:
        first, speed = 1.1 * (size + follower.radius) + abs(follower.offset), 1.0
    position = np.full(theta.size, first)
    ring = shapely.LinearRing(pairs(points)).simplify(0.1 * OFF * size)
    corners = shapely.get_coordinates(ring)
    chords: Any = shapely.linestrings(np.stack([corners[:-1], corners[1:]], axis=1))
    tree = shapely.STRtree(chords)
    hull = shapely.get_coordinates(ring.convex_hull) @ [1.0, 1j]
    for _ in range(2000):
        if follower.flat:
            away = _away(hull, follower, position, theta).min(axis=1)
        else:
            centres = _seen(follower, position, theta)[0]
            places = shapely.points(pairs(centres))
            (step, _), far = tree.query_nearest(places, all_matches=False, return_distance=True)
            away = far[np.argsort(step)] - follower.radius
        assert away.min() > -OFF * size, "it does not begin outside"
        if away.max() < OFF * size:
            return position
        position = position - np.maximum(away, 0.0) / speed
    raise AssertionError("it comes down for ever")


def _touches(
    piece: Plane, follower: Follower, theta: Array, start: Array
) -> tuple[NDArray[np.int64], Array, Plane]:
    """Numbers of the angles, positions and points at which a piece may be touched."""
    size = float(np.abs(piece).max())
    near = float(np.abs(np.diff(piece)).max()) + 3.0 * OFF * size
    steps, places = [], []
    for first in range(0, theta.size, 64):
        some = slice(first, first + 64)
        away = _away(piece, follower, start[some], theta[some])
        walls = np.pad(away, ((0, 0), (1, 1)), constant_values=np.inf)
        nearest = (away <= walls[:, :-2]) & (away <= walls[:, 2:])
        nearest[:, [0, -1]] = True
        step, place = np.nonzero(nearest & (away < near))
        steps.append(step + first)
        places.append(place)
    step, place = np.concatenate(steps), np.concatenate(places)
    if not step.size:
        return step, np.empty(0), np.empty(0, dtype=complex)
    curve = _Curve.beside(piece, place)
    position, s = _newton(curve, follower, start[step], theta[step])
    inside = np.isfinite(s) & (s >= curve.low - AT_END) & (s <= curve.high + AT_END)
    ends = np.flatnonzero(~inside & ((place == 0) | (place == len(piece) - 1)))
    point = np.where(inside, curve.at(np.where(inside, s, 0.0))[0], piece[place])
    position[ends] = _on_point(point[ends], follower, start[step[ends]], theta[step[ends]])
    inside[ends] = np.isfinite(position[ends])
    lever = (follower.arm or follower.pivot) if follower.swings else 1.0
    inside &= position - start[step] < HIGHER * size / lever
    return step[inside], position[inside], point[inside]


@dataclass(frozen=True)
class _Curve:
    """Polynomials through neighbours, seen along their chord and scaled to half its length."""

    origin: Plane
    scale: Plane
    factors: Array
    low: Array
    high: Array

    @classmethod
    def beside(cls, piece: Plane, place: NDArray[np.int64]) -> _Curve:
        count = min(NEIGHBOURS, len(piece))
        first = np.clip(place - count // 2, 0, len(piece) - count)
        z = piece[first[:, None] + np.arange(count)]
        scale = 0.5 * (z[:, -1] - z[:, 0])
        local = (z - piece[place][:, None]) / scale[:, None]
        powers = local.real[:, :, None] ** np.arange(count)
        factors = np.linalg.solve(powers, local.imag[:, :, None])[:, :, 0]
        return cls(piece[place], scale, factors, local.real[:, 0], local.real[:, -1])

    def at(self, s: Array) -> tuple[Plane, Plane, Plane]:
        """Points and two derivatives by s."""
        value, slope, bend = (np.zeros(s.shape) for _ in range(3))
        for factor in self.factors.T[::-1]:
            bend = bend * s + 2.0 * slope
            slope = slope * s + value
            value = value * s + factor
        return (
            self.origin + self.scale * (s + 1j * value),
            self.scale * (1.0 + 1j * slope),
            self.scale * 1j * bend,
        )


def _newton(
    curve: _Curve, follower: Follower, position: Array, theta: Array
) -> tuple[Array, Array]:
    """Positions and places s at which the curve is touched in its inside; not finite if nowhere."""
    s, miss = np.zeros(len(theta)), np.inf
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            z, along, bend = curve.at(s)
            place, moves = _seen(follower, position, theta)
            if follower.flat:
                normal, turns = _normal(follower, position, theta)
                # the face: along the curve, and through its point
                miss = dot(along, normal) + 1j * dot(place - z, normal)
                by_s = dot(bend, normal) - 1j * dot(along, normal)
                by_position = dot(along, turns) + 1j * (dot(place - z, turns) + dot(moves, normal))
            else:
                length = np.abs(along)
                turning = dot(along * 1j, bend) / length**3
                miss = z - 1j * follower.radius * along / length - place
                by_s = along * (1.0 + follower.radius * turning)
                by_position = -moves
            both = (np.conj(by_s) * by_position).imag
            step = (np.conj(by_position) * miss).imag / both
            position = position - (np.conj(by_s) * miss).imag / both
            s = s + np.clip(step, -0.5, 0.5)
    return position, np.where(np.abs(miss) < MISS, s, np.nan)


def _on_point(point: Plane, follower: Follower, position: Array, theta: Array) -> Array:
    """Positions at which a follower touches points; a point follower touches none by chance."""
    away = np.inf
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            place, moves = _seen(follower, position, theta)
            if follower.flat:
                normal, turns = _normal(follower, position, theta)
                away = dot(place - point, normal)
                speed = dot(place - point, turns) + dot(moves, normal)
            else:
                way = place - point
                away = np.abs(way) - follower.radius
                speed = dot(way, moves) / np.abs(way)
            position = position - away / speed
    if not follower.flat and follower.radius == 0.0:
        return np.full(position.shape, np.nan)
    return np.where(np.abs(away) < MISS, position, np.nan)
