"""What a caliper reads on a wall of a cam, and where a grinding wheel is that rolls on it.

A caliper reads where the ray at an angle meets the wall. The centre of a wheel of radius R lies on
the parallel of the wall at R, or on a circle about an edge: of these places on a ray the wheel
rests at the outermost, inside a wall at the innermost. The face of a flat wheel stands at the
largest of the distances of tangents with its normal, the support function of the profile. All are
roots of closed forms, bracketed between the probes of the wall's sampler; none is read from a
polygon.

Refused: wheels that do not reach the whole wall.

Depends on carriers, wall and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final, TypeVar

import numpy as np

from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted, rounded_down
from gearcam.cams.carriers import unit
from gearcam.cams.wall import Wall
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.roots import bracketed_root

WHEEL: Final = "output.grinding_wheel_radius_mm"
"""The key of a grinding wheel's radius."""

_ROUNDING: Final = 1e-12
"""Rounding of an angle, rad, and of a place, in sizes of the wall."""

_ROOT: Final = 1e-14
"""Width of a bracket that counts as a root, rad or mm."""

_ALIKE: Final = 1e-6
"""Distance of two places of a wheel, in sizes of the wall, below which they are one."""

_TURN: Final = 2.0 * math.pi

W = TypeVar("W", bound=Wall)


def lowered(wall: W, clearance: float) -> W:
    """Return a wall as it is made: moved back along its normals by a clearance, mm."""
    follower: Any = wall.follower
    if not clearance:
        return wall
    if follower.has_centre:
        moved = {"radius": follower.radius + clearance}
    elif follower.angular:
        moved = {"offset": follower.offset + clearance}
    else:
        moved = {"start": follower.start - clearance}
    return replace(wall, follower=replace(follower, **moved))


def caliper(wall: Wall, places: Array) -> Array:
    """Return what a caliper reads on a wall.

    Parameters
    ----------
    wall : Wall
        The wall.
    places : (n,) array, rad or mm
        Polar angles in the cam's frame; of a wall that slides places x.

    Returns
    -------
    (n,) array, mm
        Radii from the axis; of a wall that slides heights y, and nan beyond its ends. Where a ray
        meets the wall several times, the place that is farthest from the metal.
    """
    number, points, _ = _crossings(wall, lambda z, _: z, places)
    far = np.abs(points) if wall.carrier.around else points.imag
    return _last(wall, number, far, len(places))


def wheel(wall: Wall, angles: Array, radius: float) -> Array:
    """Return where a grinding wheel is that rolls on a wall.

    Parameters
    ----------
    wall : Wall
        A wall around the axis.
    angles : (n,) array, rad
        Polar angles of the wheel's centre in the cam's frame, of a flat wheel those of its normal.
    radius : float, mm
        Of the wheel; infinite of a flat one.

    Returns
    -------
    (n,) array, mm
        Distances of the centre from the axis, of a flat wheel those of its face.

    Raises
    ------
    InfeasibleError
        If the wheel does not reach the whole wall.
    """
    deepest, kept, flat = wall.profile_radius[1], wall.drawn, math.isinf(radius)
    if radius > deepest:
        raise _beyond_reach(wall, radius, deepest)
    look = unit(-angles)
    if flat:
        number, points, _ = _crossings(wall, lambda _, normals: normals, angles)
        far = (points * look[number]).real
    else:
        number, points, normals = _crossings(wall, lambda z, n: z + radius * n, angles)
        far = np.abs(points + radius * normals)
    first, last = (_last(wall, number, far, len(angles), sign) for sign in (-1, 1))
    if np.nanmax(np.abs(last - first), initial=0.0) > _ALIKE * np.abs(points).max():
        raise _beyond_reach(wall, radius, None)
    edges = np.flatnonzero(kept.corner)
    seen = kept.at(edges, kept.start[edges])[0][:, None] * look
    if flat:
        return np.fmax(last, seen.real.max(axis=0))
    with np.errstate(invalid="ignore"):  # no number beside the circle about an edge
        on_edge = seen.real + wall.side * np.sqrt((radius - seen.imag) * (radius + seen.imag))
    if wall.side > 0:
        return np.fmax.reduce([last, *on_edge])
    return np.fmin.reduce([last, *np.where(seen.real < 0.0, np.nan, on_edge)])


def _last(wall: Wall, number: Ints, far: Array, count: int, sign: int = 1) -> Array:
    """Return the values `far` of the places with a `number` that lie farthest from the metal."""
    outwards, found = sign * wall.side, np.full(count, np.nan)
    (np.fmax if outwards > 0 else np.fmin).at(found, number, far)
    return found


def _crossings(
    wall: Wall, seen: Callable[[Plane, Plane], Plane], places: Array
) -> tuple[Ints, Plane, Plane]:
    """Return where what is `seen` of points and normals lies on the rays at angles.

    Of a wall that slides at places x. Returns numbers of the rays, points, and outward normals.
    """
    kept, (points, tangents), around = wall.drawn, wall.sampler.probes, wall.carrier.around
    outward = wall.side * (-1j if wall.clockwise else 1j)
    vectors = seen(points, outward * tangents)
    along = np.unwrap(np.angle(vectors), axis=1) if around else vectors.real
    order = np.argsort(places % _TURN if around else places)
    wanted = (places % _TURN if around else places)[order]

    def rank(values: Array, side: Any) -> Ints:
        """Return how many of all rays, those of earlier turns included, lie below."""
        turns = np.floor(values / _TURN) if around else np.zeros(values.shape)
        left = np.searchsorted(wanted, values - _TURN * turns, side)
        return (turns.astype(np.int64) * len(wanted) + left).ravel()

    grain = _ROUNDING * (1.0 if around else float(np.abs(vectors).max()))
    first = rank(np.minimum(along[:, :-1], along[:, 1:]) - grain, "left")
    count = rank(np.maximum(along[:, :-1], along[:, 1:]) + grain, "right") - first
    cell = np.repeat(np.arange(len(count)), count)
    number = np.repeat(first - np.cumsum(count) + count, count) + np.arange(len(cell))
    number = order[number % len(wanted)]
    chords = points.shape[1] - 1
    index, probe = cell // chords, cell % chords
    share = np.linspace(0.0, 1.0, chords + 1)
    low, high = (
        kept.start[index] + share[probe + k] * (kept.end[index] - kept.start[index]) for k in (0, 1)
    )
    ray = unit(-places[number]) if around else np.ones(len(number))

    def place(parameter: Array) -> tuple[Plane, Plane]:
        z, directions = kept.at(index, parameter)
        return z, outward * directions

    def beside(parameter: Array) -> Array:
        vector = seen(*place(parameter))
        if not around:
            return vector.real - places[number]
        return (vector * ray).imag / np.abs(vector)

    ends = beside(low), beside(high)
    within = ends[0] * ends[1] < 0.0
    nearer = np.where(np.abs(ends[0]) <= np.abs(ends[1]), low, high)
    root = bracketed_root(beside, low, high, _ROOT, ends)
    return number, *place(np.where(within, root, nearer))


def _beyond_reach(wall: Wall, radius: float, limit: float | None) -> InfeasibleError:
    """Return the refusal of a wheel; `limit` is the smallest concave radius if it decides."""
    what, near = f"the grinding wheel does not reach the whole {wall.called}", None
    note = "a smaller wheel" if limit is None else "no wheel reaches an inner corner"
    if limit:
        near = float(rounded_down(limit, 4))
        note = f"a wheel up to {formatted(near)} mm, the smallest concave radius"
    if math.isinf(radius):
        return InfeasibleError(what, where=WHEEL, nearest=note)
    return beyond_limit(what, WHEEL, radius, limit or None, note, near=near)
