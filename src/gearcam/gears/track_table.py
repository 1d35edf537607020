"""Tables of closed centrodes: frames and inverse arc length in less than half the time.

The outlines and contacts of a pair ask for tens of thousands of frames. A *table* divides a lobe
into *cells*: those of the expansion of the arc length, which are narrow where the ratio changes
fast and end at every knot of the law, so that nothing is smoothed across a knot. On each cell it
has polynomials of degree 7 with the values and three derivatives of the closed form at both ends:
of both wheels' pitch points and of the arc length s over the driver angle phi, and of phi over s.
Tangents, speed and curvature are derivatives of the points.

Each cell is compared with the closed form when the table is made (`_OF_PLACES`, `_OF_TANGENTS`,
`_OF_CURVATURES`). Cells that miss it are halved. If that does not help, or if there would be too
many cells, there is no table, and the closed form answers.

`tabled` takes a pair of centrodes and returns them with one table for both, made when it is first
needed. Open pairs and racks have none. A table takes as long as some 4000 frames in closed form:
where fewer are needed, as for each of the perturbed laws of an error estimate, ask the centrodes of
`Rolling` themselves.

Depends on rolling.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.gears.rolling import Centrode, Rolling
from gearcam.gears.track import Frames
from gearcam.laws.ratio.span import RACK
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, complex_of, divided
from gearcam.numeric.jets import Jet, sin_cos, sqrt

_OF_PLACES: Final = 3e-13
"""Error of points, and of arc lengths in both directions, in centre distances."""

_OF_TANGENTS, _OF_CURVATURES = 2e-12, 1e-9
"""Errors of directions, of relative speeds, and of curvatures in the largest one. Each derivative
costs digits; curvatures are used for steps of Newton's method and for directions."""

_PROBE: Final = 0.4
"""Share of a cell at which errors are measured: there those of points, tangents and curvatures have
85, 74 and 66 percent of their largest values in the cell."""

_HALVINGS: Final = 2
"""Rounds of halving. Each divides an error of curvature that is not rounding by 64, others by more;
what two do not repair is mostly rounding."""

_MOST: Final = 4096
"""Largest number of cells: more take longer to make than they save."""

_TAYLOR: Final = np.array([[math.comb(j, k) for j in range(4)] for k in range(4)], dtype=float)
"""From the Taylor coefficients of a cubic about 0 to those about 1."""

_REST: Final = np.array(
    [
        [35.0, -15.0, 5.0, -1.0],
        [-84.0, 39.0, -14.0, 3.0],
        [70.0, -34.0, 13.0, -3.0],
        [-20.0, 10.0, -4.0, 1.0],
    ]
)
"""From what it misses about 1 to the coefficients of the powers 4 to 7 that add just this."""


class Cells(NamedTuple):
    """Consecutive cells of an axis.

    Parameters
    ----------
    ends : (n + 1,) array
        Their ends, rising.
    per : (n,) array
        One over their widths.
    """

    ends: Array
    per: Array

    @classmethod
    def between(cls, ends: Array) -> Cells:
        """Return the cells between their ends, (n + 1,)."""
        return cls(ends, 1.0 / np.diff(ends))

    def holding(self, x: Array) -> tuple[Ints, Array]:
        """Return the cells in which places lie, and the places as shares of them, from 0 to 1."""
        cell = self.ends[1:-1].searchsorted(x, side="right")
        return cell, (x - self.ends.take(cell)) * self.per.take(cell)


class TrackTable(NamedTuple):
    """Polynomials on n cells, in powers of the share of the cell.

    Parameters
    ----------
    cells : Cells, rad
        Of driver angles over a lobe.
    wheels : pair of (8, 3, n) arrays, mm
        For each wheel the coefficients of x, y and s.
    arcs : Cells, mm
        The same cells by their arc length.
    angles : (8, n) array, rad
        Coefficients of the driver angle on `arcs`.
    """

    cells: Cells
    wheels: tuple[Array, Array]
    arcs: Cells
    angles: Array

    @property
    def probes(self) -> Array:
        """A driver angle in each cell, (n,) rad, at which errors are nearly largest."""
        ends = self.cells.ends
        return ends[:-1] + _PROBE * np.diff(ends)

    def angle(self, s: Array) -> Array:
        """Return the driver angles, rad, at arc lengths, mm, within the first lobe."""
        cell, share = self.arcs.holding(s)
        *rows, value = self.angles.take(cell, 1)
        for row in rows[::-1]:
            value *= share
            value += row
        return value

    def frames(self, track: Centrode, x: Array, *, curved: bool) -> Frames:
        """Return frames of a centrode of the table.

        Parameters
        ----------
        track : Centrode
            That of wheel 1 or 2.
        x : array, rad
            Driver angles within the first lobe.
        curved : bool
            As for `Track.frames`.
        """
        cell, share = self.cells.holding(x)
        *rows, value = self.wheels[track.wheel - 1].take(cell, 2)
        # Horner's scheme for values, their slopes, and half their second derivatives
        slope = value[:2].copy()
        value *= share
        value += rows.pop()
        bend = slope.copy()
        slope *= share
        slope += value[:2]
        value *= share
        value += rows.pop()
        for row in rows[::-1]:
            if curved:
                bend *= share
                bend += slope
            slope *= share
            slope += value[:2]
            value *= share
            value += row
        (px, py, s), (dx, dy) = value, slope
        speed = np.sqrt(dx * dx + dy * dy)
        dx /= speed
        dy /= speed
        kappa = np.empty(0)
        if curved:
            ddx, ddy = bend
            kappa = (dx * ddy - dy * ddx) * (-2.0 * track.turn.imag) / (speed * speed)
        speed *= self.cells.per.take(cell)
        return Frames(complex_of(px, py), complex_of(dx, dy), kappa, speed, s)


def make_table(rolling: Rolling, cells: Array) -> TrackTable:
    """Return the table of two closed centrodes.

    Parameters
    ----------
    rolling : Rolling
        The centrodes of two wheels, or of a wheel and a ring.
    cells : (n + 1,) array, rad
        Ends of the cells over a lobe, with the law's knots among them.

    Returns
    -------
    TrackTable
        Its errors are not known yet (see `missed`).
    """
    law, size, mate = rolling.law, rolling.arc.size, rolling.mate
    low, high = cells[:-1], cells[1:]
    x = np.concatenate([low, high])
    # at both ends that piece of the law which the cell lies in
    piece = law.knots[1:-1].searchsorted(0.5 * (low + high))
    i, di, ddi, d3i = law.ratio.on_pieces(np.tile(piece, 2), x, 3)
    ratio = Jet([i, di, ddi / 2.0, d3i / 6.0])
    radius = size * ratio / (1.0 + mate * ratio)
    across, along = radius.shortened(), radius.differentiated()
    s = _integral(size * rolling.arc.unit(x), sqrt(across * across + along * along))
    turned, driven = Jet.variable(x, 3), -mate * _integral(law.driven(x), ratio)
    points = [*_point(radius, turned), *_point(radius - mate * size, driven)]
    of_angle = _on_cells([*points, s], high - low).swapaxes(0, 1)
    length, d, dd, d3 = map(np.asarray, s.c)
    arcs = np.append(length[: len(low)], length[-1])
    per = 1.0 / d
    inverse = Jet([x, per, -dd * per**3, (2.0 * dd * dd - d * d3) * per**5])
    (angles,) = _on_cells([inverse], np.diff(arcs))
    wheels = of_angle[:, [0, 1, 4]], of_angle[:, [2, 3, 4]]
    return TrackTable(Cells.between(cells), wheels, Cells.between(arcs), angles)


def _integral(value: Array, slope: Jet) -> Jet:
    """Return the jet of order 3 with a value and a slope."""
    return Jet([value, *(one / k for k, one in enumerate(slope.c[:3], 1))])


def _point(radius: Jet, angle: Jet) -> tuple[Jet, Jet]:
    """Return x and y of a point in polar coordinates."""
    sine, cosine = sin_cos(angle)
    return radius * cosine, radius * sine


def _on_cells(jets: Sequence[Jet], width: Array) -> Array:
    """Return polynomials that agree with jets of order 3 at both ends of cells.

    Parameters
    ----------
    jets : sequence of m Jet
        Functions at the left ends of n cells, then at the right ends.
    width : (n,) array
        Widths of the cells.

    Returns
    -------
    (m, 8, n) array
        Coefficients of the powers of the share of a cell.
    """
    ends = np.array([np.broadcast_arrays(*jet.c) for jet in jets])
    ends = ends.reshape(len(jets), 4, 2, -1) * (width ** np.arange(4)[:, None])[:, None]
    left, right = ends[:, :, 0], ends[:, :, 1]
    return np.concatenate([left, _REST @ (right - _TAYLOR @ left)], axis=1)


def missed(rolling: Rolling, table: TrackTable) -> Mask:
    """Return in which cells of a table errors are above those allowed.

    Parameters
    ----------
    rolling : Rolling
        The centrodes.
    table : TrackTable
        Their table.

    Returns
    -------
    (n,) mask
    """
    x = table.probes
    length = rolling.arc.size * _OF_PLACES
    frames = [(track.frames(x), table.frames(track, x, curved=True)) for track in rolling.tracks]
    off = [np.abs(table.angle(frames[0][0].s) - x) * frames[0][0].speed / length]
    for exact, own in frames:
        off += [
            np.abs(own.p - exact.p) / length,
            np.abs(own.s - exact.s) / length,
            np.abs(own.t - exact.t) / _OF_TANGENTS,
            np.abs(own.speed / exact.speed - 1.0) / _OF_TANGENTS,
            np.abs(own.kappa - exact.kappa) / (np.abs(exact.kappa).max() * _OF_CURVATURES),
        ]
    return ~(np.max(off, axis=0) <= 1.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class LazyTable(ShortRepr):
    """The table of two centrodes, made when it is first needed.

    Parameters
    ----------
    rolling : Rolling
        The centrodes.
    """

    rolling: Rolling

    @cached_property
    def table(self) -> TrackTable | None:
        """The table, or none that is accurate."""
        cells = self.rolling.cells(self.rolling.law.knots)
        for _ in range(_HALVINGS + 1):
            if len(cells) > _MOST:
                break
            table = make_table(self.rolling, cells)
            again = missed(self.rolling, table)
            if not again.any():
                return table
            cells = divided(cells, 1 + again)
        return None


@dataclass(frozen=True, eq=False, kw_only=True)
class TabledCentrode(Centrode):
    """A closed centrode that takes its frames from a table, if there is one.

    Parameters
    ----------
    source : LazyTable
        The table of both centrodes.
    """

    source: LazyTable

    @property
    def exact(self) -> Centrode:
        """The same centrode, without a table."""
        return self.source.rolling.tracks[self.wheel - 1]

    def frames(self, phi: ArrayLike, *, curved: bool = True) -> Frames:
        """Return the frames at driver angles (see `Track.frames`)."""
        table = self.source.table
        if table is None:
            return super().frames(phi, curved=curved)
        turns, x = self.arc.within(np.asarray(phi, dtype=float))
        p, t, kappa, speed, s = table.frames(self, x, curved=curved)
        s += turns * self.arc.length
        if self.periods > 1:
            lobe = self._lobes.take(turns.astype(np.int64) % self.periods)
            p *= lobe
            t *= lobe
        return Frames(p, t, kappa, speed, s)

    def angle(self, s: ArrayLike) -> Array:
        """Return the driver angles, rad, at arc lengths, mm (see `Track.angle`)."""
        table = self.source.table
        if table is None:
            return super().angle(s)
        s, length = np.asarray(s, dtype=float), self.arc.length
        turns = np.floor(s / length)
        return table.angle(s - turns * length) + turns * self.arc.period

    @cached_property
    def _lobes(self) -> Plane:
        """The directions in which lobes lie, from that of the first."""
        side = 1 if self.wheel == 1 else -self.rolling.mate
        return np.exp(2j * np.pi * side / self.periods * np.arange(self.periods))


def tabled(rolling: Rolling) -> tuple[Centrode, Centrode]:
    """Return both centrodes with a common table; those of an open pair or a rack as they are."""
    if not rolling.law.closed or rolling.mate == RACK:
        return rolling.tracks
    source = LazyTable(rolling=rolling)
    one, two = (TabledCentrode(**vars(track), source=source) for track in rolling.tracks)
    return one, two
