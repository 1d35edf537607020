"""What the roller takes off an undercut wall, and the lift that is lost there: by a search.

Where a wall is undercut the roller cuts it away at another cam angle, and its closed form is not
the wall that is left. A point of the cam at a radius and an azimuth is passed by the roller at many
angles; the highest point that any of them reaches is the upper wall there, the lowest one the lower
wall (`reached`). The follower then rests on an edge of the wall, and can move towards it:

- the *depth* taken off is the distance of the closed form from the wall left, along the cam's axis;
- the *lost lift* at a place on the roller is the way that the follower has at this place alone;
  the largest of all places counts, though the roller may rest on others.

At the floor the end of the roller rests on the ramp that its rim makes, and loses nothing.

The clearance is left out: the follower is taken to be as wide as the groove. The roller's axis is
perpendicular to the cam's, as those of `Straight` and `SwingArm`.

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
from gearcam.numeric.arrays import Array
from gearcam.spatial.cam import SpatialWall
from gearcam.spatial.extremes import Spot
from gearcam.spatial.guides import Straight

_AROUND: Final = 720
"""Cam angles of a turn at which a search begins."""

_FINE: Final = 9
"""Places in an interval that is narrowed; it is a quarter as long each time."""

_COARSE: Final = 3
"""How often it is narrowed where that is enough to choose, or before a parabola is used."""

_NARROWED: Final = 10
"""How often the place of a largest value is narrowed, to half each time."""

_NEAR: Final = 5
"""Cam angles and places on the roller in what is narrowed."""

_LEVELS: Final = 9
"""How often the place is narrowed at which the roller rests on an edge."""

_ALONG: Final = 9
"""Places along the roller; odd, so that every second one has both ends."""

_ACROSS: Final = 33
"""Places around half the roller at which its way is looked at."""

_SCANNED: Final = 40
"""Cam angles at which it is looked at first."""

_SIDEWAYS: Final = 0.999
"""Part of that half that counts: the wall beside the roller lets it pass."""

_STEPS: Final = 5
"""Steps of Newton's method for the way of an arm; a straight follower needs one."""

_SHORT: Final = 1e-6
"""Way over which the slope of the arm's motion is taken, mm or rad."""

_FAR: Final = 1e9
"""Instead of infinity where differences are taken, mm."""

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
    """

    depth: Spot
    way: Spot
    error: float


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

    def reached(self, radius: Array, azimuth: Array) -> Array:
        """Return the heights up to which (down to which) the roller cuts.

        Parameters
        ----------
        radius, azimuth : (n,) arrays, mm and rad
            Places of the cam.

        Returns
        -------
        (n,) array, mm
            Infinite where no roller comes.
        """
        parts = range(0, len(radius), _CHUNK)
        found = [self._reached(radius[k : k + _CHUNK], azimuth[k : k + _CHUNK]) for k in parts]
        return self.wall.side * np.concatenate(found)

    def depth(self, theta: Array, x: Array) -> Array:
        """Return the depths that are taken off the closed form, (n, k), mm; 0 where none is.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles of its points.
        x : (n, k) array, mm
            Places on the roller.
        """
        points = self.wall.contact(theta, x).points.reshape(-1, 3)
        radius, azimuth = np.hypot(points[:, 0], points[:, 1]), np.arctan2(*points[:, 1::-1].T)
        beyond = self.wall.side * (self.reached(radius, azimuth) - points[:, 2])
        least = _ROUNDING * self.wall.cam.outer_radius
        return np.where(beyond > least, beyond, 0.0).reshape(x.shape)

    def lost(self, theta: Array, x: Array, levels: int = _LEVELS) -> Array:
        """Return the way of the follower towards the wall beyond its lift, (n, k), mm or rad.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        x : (n, k) array, mm
            Places on the roller, each taken alone.
        levels : int
            How often its least is narrowed down.
        """
        found = np.zeros(x.shape)
        rows, columns = np.nonzero(self.depth(theta, x))
        if len(rows):
            found[rows, columns] = self._way(theta[rows], x[rows, columns], levels)
        return found

    def loss(self) -> LostLift:
        """Return the largest depth and lost lift over the turn and the roller."""
        theta = np.linspace(0.0, 2.0 * math.pi, _AROUND, endpoint=False)
        theta = np.append(theta, self.wall.spread.theta)
        x = self._places(theta)
        depth = self.depth(theta, x)
        deepest, _ = self._largest(self.depth, theta, x, depth)
        rows = np.flatnonzero(depth.any(axis=1))
        if not len(rows):
            return LostLift(depth=deepest, way=replace(self.wall.spread, value=0.0), error=0.0)
        some = rows[:: -(-len(rows) // _SCANNED)]
        ways = self.lost(theta[some], x[some], _COARSE)
        way, error = self._largest(self.lost, theta[some], x[some], ways)
        return LostLift(depth=deepest, way=way, error=error + _ROUNDING)

    def _places(self, theta: Array) -> Array:
        """Return places from the roller's inner end to the edge of the wall, (n, k), mm.

        They are denser inside, where walls are undercut first.
        """
        low, share = self.wall.cam.inner, np.linspace(0.0, 1.0, _ALONG) ** 2
        return low + share * (self.wall.edge(theta)[:, None] - low)

    def _largest(
        self, function: Callable[[Array, Array], Array], theta: Array, x: Array, values: Array
    ) -> tuple[Spot, float]:
        """Return the largest value near the best one of a grid, and the last change of it."""
        k, j = np.unravel_index(np.argmax(values), values.shape)
        low, high, turn = float(x[k, 0]), float(x[k, -1]), 2.0 * math.pi
        spot, change = Spot(theta=float(theta[k]), x=float(x[k, j]), value=-math.inf), 0.0
        size = np.array([turn / min(len(theta), _AROUND), (high - low) / (_ALONG - 1)])
        if len(theta) < _AROUND:
            size[0] = max(turn / _AROUND, float(np.median(np.diff(theta))))
        for _ in range(_NARROWED):
            steps = np.linspace(-1.0, 1.0, _NEAR)
            at = spot.theta + size[0] * steps
            places = np.clip(spot.x + size[1] * steps, low, high) * np.ones((_NEAR, 1))
            found = function(at, places)
            row, column = np.unravel_index(np.argmax(found), found.shape)
            if found[row, column] > spot.value:
                change = float(found[row, column]) - spot.value
                near = float(at[row]), float(places[row, column])
                spot = Spot(theta=near[0], x=near[1], value=float(found[row, column]))
            size *= 2.0 / (_NEAR - 1)
        return replace(spot, theta=spot.theta % turn), change

    def _axis(self, theta: Array, more: Array | float = 0.0) -> tuple[Array, Array]:
        """Return y and z of the roller's axis, mm, moved on by a part of the lift."""
        cam = self.wall.cam
        lift = cam.program.derivatives(theta.ravel(), 0)[0].reshape(theta.shape) + more
        point, _ = cam.guide.placed(lift.ravel())
        y, z = (point[0, :, k].reshape(theta.shape) for k in (1, 2))
        return y, z - 0.5 * self.wall.side * cam.apart

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        return self._axis(2.0 * math.pi / _AROUND * np.arange(float(_AROUND)))

    def _tops(self, turned: Array, radius: Array, axis: tuple[Array, Array]) -> Array:
        """Return side times the height of a roller over points; minus infinity beside it."""
        cam, (y, z) = self.wall.cam, axis
        x = radius * np.cos(turned)
        square = cam.tool.radii(x) ** 2 - (radius * np.sin(turned) - y) ** 2
        outside = (square < 0.0) | (x < cam.floor * (1.0 - 1e-12))
        height = self.wall.side * z + np.sqrt(np.maximum(square, 0.0))
        return np.where(outside, -math.inf, height)

    def _reached(self, radius: Array, azimuth: Array) -> Array:
        """Return side times the heights that are reached, at a few points.

        The best of even cam angles is narrowed down, then improved by a parabola. The angles at
        which the roller's end passes the point bound those that count; they are looked at too.
        """
        step, here = 2.0 * math.pi / _AROUND, np.arange(len(radius))
        apart = np.arccos(np.minimum(1.0, self.wall.cam.floor / radius))
        count = math.ceil(float(apart.max()) / step) + 1
        index = np.round(-azimuth / step).astype(np.int64)[:, None] + np.arange(-count, count + 1)
        y, z = (one[index % _AROUND] for one in self._table)
        ends = apart[:, None] * [-1.0, 0.0, 1.0] - azimuth[:, None]
        theta = np.concatenate([step * index, ends], axis=1)
        more = self._axis(ends)
        axis = np.concatenate([y, more[0]], axis=1), np.concatenate([z, more[1]], axis=1)
        values = self._tops(azimuth[:, None] + theta, radius[:, None], axis)
        values[:, 1 : index.shape[1] - 1] = _peaks(values[:, : index.shape[1]])

        def seen(at: Array) -> Array:
            return self._tops(azimuth[:, None] + at, radius[:, None], self._axis(at))

        for _ in range(_COARSE):
            chosen = np.argmax(values, axis=1)
            best = theta[here, chosen]
            theta = best[:, None] + np.linspace(-step, step, _FINE)
            theta[:, _FINE // 2] = best
            values = np.maximum(seen(theta), -_FAR)
            step *= 2.0 / (_FINE - 1)
        chosen = np.clip(np.argmax(values, axis=1), 1, _FINE - 2)
        low, mid, high = (values[here, chosen + k] for k in (-1, 0, 1))
        bend = low - 2.0 * mid + high
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(bend < 0.0, 0.5 * (low - high) / bend, 0.0)
        last = theta[here, chosen] + step * np.clip(share, -1.0, 1.0)
        return np.maximum(values.max(axis=1), seen(last[:, None])[:, 0])

    def _way(self, theta: Array, x: Array, levels: int) -> Array:
        """Return how far the follower can go at n angles and places."""
        way = np.zeros(len(theta))
        for _ in range(1 if isinstance(self.wall.cam.guide, Straight) else _STEPS):
            rise = self._axis(theta, way + _SHORT)[1] - self._axis(theta, way)[1]
            way = way + self.wall.side * self._room(theta, x, way, levels) * _SHORT / rise
        return np.maximum(self.wall.side * way, 0.0)

    def _room(self, theta: Array, x: Array, more: Array, levels: int) -> Array:
        """Return the least height between the roller, moved on, and the wall."""
        cam, side = self.wall.cam, self.wall.side
        y, z = (one[:, None] for one in self._axis(theta, more))
        radius = cam.tool.radii(x)[:, None]

        def height(angle: Array) -> Array:
            across, up = y + radius * np.sin(angle), side * z + radius * np.cos(angle)
            far = np.hypot(x[:, None], across)
            azimuth = np.arctan2(across, x[:, None]) - theta[:, None]
            inside = far <= cam.outer_radius
            wall = np.full(far.shape, math.inf)
            wall[inside] = side * self.reached(far[inside], azimuth[inside])
            return wall - up

        half = 0.5 * math.pi * _SIDEWAYS
        angles = np.tile(np.linspace(-half, half, _ACROSS), (len(theta), 1))
        size, here = 2.0 * half / (_ACROSS - 1), np.arange(len(theta))
        least = np.full(len(theta), math.inf)
        best = np.zeros(len(theta))
        for _ in range(levels):
            values = height(angles)
            chosen = np.argmin(values, axis=1)
            better = values[here, chosen] < least
            least = np.where(better, values[here, chosen], least)
            best = np.where(better, angles[here, chosen], best)
            angles = np.clip(best[:, None] + np.linspace(-size, size, _FINE), -half, half)
            size *= 2.0 / (_FINE - 1)
        return least


def _peaks(values: Array) -> Array:
    """Return, for all but the ends of rows, the peak of a parabola where it is near, or the value.

    Two rollers that reach equally high meet at an edge: which is higher is seen from their peaks.
    """
    low, mid, high = (values[:, k : values.shape[1] - 2 + k] for k in range(3))
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = low - 2.0 * mid + high
        near = np.isfinite(bend) & (bend < 0.0) & (np.abs(low - high) <= -2.0 * bend)
        return np.where(near, mid - 0.125 * (low - high) ** 2 / bend, mid)
