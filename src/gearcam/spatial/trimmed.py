"""What the roller takes off an undercut wall, and the lift that is lost there.

Where a wall is undercut the roller cuts it away at another cam angle, and its closed form is not
the wall that is left. A point of the cam at a radius and an azimuth is passed by the roller at many
angles; the highest point that any of them reaches is the upper wall there, the lowest one the lower
wall (`reached`). The follower then rests on an edge of the wall, and can move towards it:

- the *depth* taken off is the distance of the closed form from the wall left, along the cam's axis;
- the *lost lift* at a place on the roller is the way that the follower has at this place alone, at
  most to the end of its lift; the largest of all places counts, though the roller may rest on
  others.

The edge is seen in the plane across the roller at this place. What the roller reaches there at
earlier cam angles rises to one side, what it reaches at later angles to the other: they cross at
the edge, which a bracketed search finds. On its way the follower moves in this plane until its
circle meets the edge, a point; that is a closed form of the guide.

At the floor the end of the roller rests on the ramp that its rim makes, and loses nothing.

The clearance is left out: the follower is taken to be as wide as the groove. So is the outside of
the blank: walls go on beyond it, or a place near the outside would lose its hold where it is not
undercut.

Depends on cam and guides; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.roots import bracketed_root
from gearcam.spatial.cam import SpatialWall
from gearcam.spatial.extremes import Spot

_AROUND: Final = 720
"""Cam angles of a turn at which a search begins."""

_STEP: Final = 2.0 * math.pi / _AROUND
"""From one to the next, rad."""

_FINE: Final = 16
"""Parts of a step between them in which the best is looked for, before a parabola is used."""

_LOOKED: Final = 360
"""Cam angles of a turn at which walls are looked at."""

_NARROWED: Final = 8
"""How often the place of a largest value is narrowed, to a third each time."""

_NEAR: Final = 7
"""Cam angles and places on the roller in what is narrowed."""

_ALONG: Final = 9
"""Places along the roller."""

_SCANNED: Final = 40
"""Cam angles at which the lost lift is looked at first."""

_SIDEWAYS: Final = 0.999
"""Part of half the roller on which it may rest: the wall beside it lets it pass."""

_HALF: Final = 1.2
"""Twice the distance of the peak of a parabola at which it is near: half a step, and a little."""

_NARROW: Final = 1e-8
"""Width of the bracket of an edge, rad around the roller."""

_ROUNDING: Final = 1e-9
"""Heights that are the same, over the radius of the cam."""

_CHUNK: Final = 2000
"""Points that are looked at together, to limit the memory."""


@dataclass(frozen=True, kw_only=True)
class LostLift(ShortRepr):
    """What an undercut costs on one wall.

    Parameters
    ----------
    depth : Spot
        The largest depth that is taken off, mm, along the cam's axis.
    way : Spot
        The largest lost lift of any place on the roller, mm or rad.
    error : float
        Error of it: the change by the last narrowing, and rounding.
    gone : float or None
        A cam angle, rad, at which nothing is left of the wall along the whole roller; None if there
        is none.
    """

    depth: Spot
    way: Spot
    error: float
    gone: float | None = None


@lru_cache(maxsize=8)
def lost_lift(wall: SpatialWall) -> LostLift:
    """Return what undercut costs on a wall; the same object for the same wall.

    Parameters
    ----------
    wall : SpatialWall
        The wall.
    """
    return TrimmedWall(wall=wall).loss()


@dataclass(frozen=True, eq=False, kw_only=True)
class TrimmedWall(ShortRepr):
    """A wall as the roller leaves it.

    Parameters
    ----------
    wall : SpatialWall
        Its closed form.
    """

    wall: SpatialWall

    def reached(self, theta: Array, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the heights up to which (down to which) the roller cuts before and after.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles at which the roller passes over the places.
        x, y : (n,) arrays, mm
            Places in the fixed frame.

        Returns
        -------
        before, after : (n,) arrays, mm
            What the roller reaches at these angles and at earlier ones, and at these and later
            ones.
        """
        radius, azimuth = np.hypot(x, y), np.arctan2(y, x) - theta
        parts = [slice(k, k + _CHUNK) for k in range(0, len(theta), _CHUNK)]
        found = [self._reached(theta[k], radius[k], azimuth[k]) for k in parts]
        before, after = self.wall.side * np.concatenate(found, axis=1)
        return before, after

    def depth(self, theta: Array, x: Array) -> Array:
        """Return the depths that are taken off the closed form, (n, k), mm; 0 where none is.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles of its points.
        x : (n, k) array, mm
            Places on the roller.
        """
        side, at = self.wall.side, np.repeat(theta, x.shape[1])
        px, py, pz = self.wall.contact(theta, x).points.reshape(-1, 3).T
        c, s = np.cos(at), np.sin(at)
        reached = self.reached(at, c * px - s * py, s * px + c * py)
        beyond = np.max(side * (np.array(reached) - pz), axis=0)
        least = _ROUNDING * self.wall.cam.outer_radius
        return np.where(beyond > least, beyond, 0.0).reshape(x.shape)

    def lost(self, theta: Array, x: Array) -> Array:
        """Return the way of the follower towards the wall beyond its lift, (n, k), mm or rad.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        x : (n, k) array, mm
            Places on the roller, each taken alone.
        """
        found = np.zeros(x.shape)
        rows, columns = np.nonzero(self.depth(theta, x))
        if len(rows):
            found[rows, columns] = self._way(theta[rows], x[rows, columns])
        return found

    def loss(self) -> LostLift:
        """Return the largest depth and lost lift over the turn and the roller."""
        step = 2.0 * math.pi / _LOOKED
        theta = np.append(step * np.arange(float(_LOOKED)), self.wall.spread.theta)
        x = self._places(theta)
        depth = self.depth(theta, x)
        deepest, _ = self._largest(self.depth, theta, x, depth, step)
        rows = np.flatnonzero(depth.any(axis=1))
        if not len(rows):
            return LostLift(depth=deepest, way=replace(self.wall.spread, value=0.0), error=0.0)
        every = -(-len(rows) // _SCANNED)
        some = rows[::every]
        ways = self.lost(theta[some], x[some])
        way, error = self._largest(self.lost, theta[some], x[some], ways, every * step)
        least = depth.min(axis=1)
        gone = float(theta[np.argmax(least)]) if least.any() else None
        return LostLift(depth=deepest, way=way, error=error + _ROUNDING, gone=gone)

    def _places(self, theta: Array) -> Array:
        """Return places from the roller's inner end to the edge of the wall, (n, k), mm.

        They are denser inside, where walls are undercut first.
        """
        low, share = self.wall.cam.inner, np.linspace(0.0, 1.0, _ALONG) ** 2
        return low + share * (self.wall.edge(theta)[:, None] - low)

    def _largest(
        self,
        of: Callable[[Array, Array], Array],
        theta: Array,
        x: Array,
        values: Array,
        step: float,
    ) -> tuple[Spot, float]:
        """Return the largest value near the best one of a grid, and the last change of it."""
        k, j = np.unravel_index(np.argmax(values), values.shape)
        low, high = float(x[k, 0]), float(x[k, -1])
        spot, change = Spot(theta=float(theta[k]), x=float(x[k, j]), value=float(values[k, j])), 0.0
        size = np.array([step, (high - low) / (_ALONG - 1)])
        steps, ones = np.linspace(-1.0, 1.0, _NEAR), np.ones((_NEAR, 1))
        for _ in range(_NARROWED):
            at = spot.theta + size[0] * steps
            places = np.clip(spot.x + size[1] * steps, low, high) * ones
            found = of(at, places)
            row, column = np.unravel_index(np.argmax(found), found.shape)
            change = max(0.0, float(found[row, column]) - spot.value)
            if change > 0.0:
                near = float(at[row]), float(places[row, column])
                spot = Spot(theta=near[0], x=near[1], value=float(found[row, column]))
            size *= 2.0 / (_NEAR - 1)
        return replace(spot, theta=spot.theta % (2.0 * math.pi)), change

    def _moved(self, theta: Array) -> Array:
        """Return cosine and sine of cam angles, and y and z of the roller's axis, mm, (4, ...)."""
        cam = self.wall.cam
        point, _ = cam.guide.placed(cam.program.derivatives(theta.ravel(), 0)[0])
        y, z = (point[0, :, k].reshape(theta.shape) for k in (1, 2))
        return np.stack([np.cos(theta), np.sin(theta), y, z - 0.5 * self.wall.side * cam.apart])

    @cached_property
    def _table(self) -> Array:
        """What `_moved` returns at all fine angles of a turn."""
        return self._moved(_STEP / _FINE * np.arange(float(_AROUND * _FINE)))

    def _tops(self, point: tuple[Array, Array], moved: Array) -> Array:
        """Return side times the heights of the roller over points of the cam, (n, k).

        Minus infinity beside it.
        """
        cam, (c, s, y, z) = self.wall.cam, moved
        px, py = (one[:, None] for one in point)
        x = px * c - py * s
        square = cam.tool.radii(x) ** 2 - (px * s + py * c - y) ** 2
        outside = (square < 0.0) | (x < cam.floor * (1.0 - 1e-12))
        height = self.wall.side * z + np.sqrt(np.maximum(square, 0.0))
        return np.where(outside, -math.inf, height)

    def _reached(self, theta: Array, radius: Array, azimuth: Array) -> list[Array]:
        """Return side times the heights that are reached before and after, at a few points.

        The best of even cam angles is narrowed down on finer ones and by a parabola. The sides of
        the roller bound those that count, and the angles at which its end passes the point; these
        are looked at too.
        """
        point, here = (radius * np.cos(azimuth), radius * np.sin(azimuth)), np.arange(len(radius))
        apart = np.arccos(np.minimum(1.0, self.wall.cam.floor / radius))
        known = np.stack([-azimuth - apart, theta, -azimuth + apart], axis=1)
        exact = self._tops(point, self._moved(known))
        beside = self.wall.cam.tool.radii(radius) + np.abs(self._table[2]).max()
        near = np.minimum(apart, np.arcsin(np.minimum(1.0, beside / radius)))
        count = math.ceil(float(near.max()) / _STEP) + 1
        index = np.round(-azimuth / _STEP).astype(np.int64)[:, None] + np.arange(-count, count + 1)

        def seen(fine: Ints) -> Array:
            return self._tops(point, self._table[:, fine % (_AROUND * _FINE)])

        def only(values: Array, fine: Ints, sign: float) -> Array:
            later = sign * (_STEP / _FINE * fine - theta[:, None]) >= 0.0
            return np.where(later, values, -math.inf)

        coarse, found = seen(_FINE * index), []
        for sign, mine in ((-1.0, exact[:, :2]), (1.0, exact[:, 1:])):
            best = np.argmax(_peaks(only(coarse, _FINE * index, sign)), axis=1) + 1
            fine = _FINE * index[here, best][:, None] + np.arange(-_FINE, _FINE + 1)
            values = only(seen(fine), fine, sign)
            found.append(np.max(np.concatenate([mine, values, _peaks(values)], axis=1), axis=1))
        return found

    def _way(self, theta: Array, x: Array) -> Array:
        """Return how far the follower can go at n angles and places."""
        cam, side = self.wall.cam, self.wall.side
        radius, y = cam.tool.radii(x), self._moved(theta)[2]

        def around(angle: Array) -> tuple[Array, Array, Array]:
            across = y + radius * np.sin(angle)
            return across, *self.reached(theta, x, across)

        def earlier(angle: Array) -> Array:
            _, before, after = around(angle)
            return side * (before - after)

        half = np.full(len(theta), 0.5 * math.pi * _SIDEWAYS)
        across, *reached = around(bracketed_root(earlier, -half, half, _NARROW))
        z = side * np.max(side * np.array(reached), axis=0) + 0.5 * side * cam.apart
        lift = cam.program.derivatives(theta, 0)[0]
        low, high = cam.program.range
        left = high - lift if side > 0 else lift - low
        return np.clip(cam.guide.way(lift, (across, z), radius, side), 0.0, left)


def _peaks(values: Array) -> Array:
    """Return, for all but the ends of rows, the peak of a parabola where it is near, or the value.

    Two rollers that reach equally high meet at an edge: which is higher is seen from their peaks.
    """
    low, mid, high = (values[:, k : values.shape[1] - 2 + k] for k in range(3))
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = low - 2.0 * mid + high
        near = np.isfinite(bend) & (bend < 0.0) & (np.abs(low - high) <= -_HALF * bend)
        return np.where(near, mid - 0.125 * (low - high) ** 2 / bend, mid)
