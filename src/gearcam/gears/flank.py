"""Closed forms of a wheel's curves: flank, fillet, root land and tip.

A *flank* is given by the arc length `sf` at which it crosses the pitch curve and its side `sigma`
(+1 on the tooth's side of rising s). Its points are indexed by the roll s of the rack; ``w =
sigma*(sf - s)`` is the *reach*, positive on the addendum, and the rack height is
``w*sin(alpha)*cos(alpha)``. All curves are functions of the driver angle phi, which gives s and
the frame of the pitch point.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcam.base.display import ShortRepr
from gearcam.gears.cutter import Cutter
from gearcam.gears.track import Frames, Track, Wheel
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

_BLOCK = 1 << 15
"""Points computed at once: with more, intermediate arrays leave the processor's cache and the
allocator returns them to the system (see `gearcam.numeric.arrays`)."""


class Curve(IntEnum):
    """Types of curve in an outline."""

    FLANK = 0
    FILLET = 1
    LAND = 2
    TIP = 3
    ROUND = 4


@dataclass(frozen=True, eq=False, kw_only=True)
class Toothing(ShortRepr):
    """A track with its cutter and tooth positions.

    Parameters
    ----------
    track : Track
        Its centrode.
    wheel : {1, 2}
        Wheel of the pair: at s = 0 wheel 1 has the middle of a tooth, wheel 2 of a space.
    teeth : int
        Number of teeth: pitches along its centrode.
    cutter : Cutter
        Its cutter.
    moved : float, mm
        Offset of its teeth along its centrode.
    rounding : float, mm
        Radius of its rounded tip edges.
    in_gap : bool
        Whether the blank of a rack ends in gaps, not half a pitch beyond its teeth.
    """

    track: Track
    wheel: Wheel
    teeth: int
    cutter: Cutter
    moved: float = 0.0
    rounding: float = 0.0
    in_gap: bool = False

    @property
    def closed(self) -> bool:
        """Whether it is toothed all around; if not its blank ends half a pitch beyond its teeth."""
        return self.track.closed

    @property
    def turn(self) -> complex:
        """``N = turn*T``."""
        return self.track.turn

    @property
    def pitch(self) -> float:
        """Pitch along the centrode, pi*m, mm."""
        return self.cutter.pitch

    @property
    def half_tooth(self) -> float:
        """Half the thickness of a tooth along the centrode, mm."""
        return 0.5 * self.cutter.pitch - self.cutter.half_space

    @property
    def length(self) -> float:
        """Length of its centrode, mm."""
        return self.pitch * self.teeth

    @property
    def ends(self) -> Array:
        """Arc lengths at which an open wheel's blank ends, mm: half a pitch beyond its teeth."""
        half = 0.0 if self.in_gap else 0.5 * self.pitch
        return np.array([-half, self.length + half])

    @property
    def numbers(self) -> range:
        """Numbers of the teeth that are formed.

        An open wheel's blank extends from half a pitch before s = 0 to half a pitch after s = L.
        The first and last tooth formed lie outside it on wheel 1, half inside on wheel 2.
        """
        if self.closed:
            return range(1, self.teeth + 1)
        return range(self.teeth + (3 if self.wheel == 1 else 2))

    @property
    def whole(self) -> slice:
        """Indices in `numbers` of the whole teeth."""
        return slice(None) if self.closed else slice(1, -1)

    @cached_property
    def tooth_places(self) -> Array:
        """Arc length of each formed tooth's middle, mm: (k - 1) pitches, on wheel 2 (k - 1/2)."""
        first = self.numbers[0] - (1.0 if self.wheel == 1 else 0.5)
        return self.moved + self.pitch * np.arange(first, first + len(self.numbers))

    @cached_property
    def flanks(self) -> tuple[Array, Array]:
        """Position sf, mm, and sigma of all flanks formed: sigma = +1 of every tooth, then -1."""
        sigma = np.repeat([1.0, -1.0], len(self.numbers))
        return np.tile(self.tooth_places, 2) + sigma * self.half_tooth, sigma

    @property
    def whole_flanks(self) -> Mask:
        """Mask of the flanks that belong to whole teeth."""
        return np.tile(np.isin(self.numbers, self.numbers[self.whole]), 2)

    def of_teeth(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return values of all `flanks` as those of both sides of the whole teeth, (2, n)."""
        return values.reshape(2, -1)[:, self.whole]

    def frames(self, phi: Array, *, curved: bool = True) -> Frames:
        """Return the frames of its track at driver angles, rad (see `Track.frames`)."""
        return self.track.frames(phi, curved=curved)

    def normals(self, frames: Frames, sigma: Array | float) -> Plane:
        """Return unit normals of flanks `sigma` at `frames`, towards rising s on both sides."""
        alpha = self.cutter.alpha
        return frames.t * (np.cos(alpha) + sigma * np.sin(alpha) * self.turn)

    def ahead(self, frames: Frames, sf: Array) -> Array:
        """Return distances of flanks `sf` from the points of `frames` along the normals, mm."""
        return (sf - frames.s) * np.cos(self.cutter.alpha)

    def flank_points(self, frames: Frames, sf: Array, sigma: Array | float) -> Plane:
        """Return points of flanks (`sf`, `sigma`) at `frames`."""
        return frames.p + self.ahead(frames, sf) * self.normals(frames, sigma)

    def flank_motion(self, frames: Frames, sf: Array, sigma: Array | float) -> Plane:
        """Return driver-angle derivatives of points of flanks (`sf`, `sigma`) at `frames`."""
        g = sigma * self.regularity(frames, sf, sigma)
        return -g * frames.speed * self.turn * self.normals(frames, sigma)

    def regularity(self, frames: Frames, sf: Array, sigma: Array | float) -> Array:
        """Return sigma*g of flanks (`sf`, `sigma`) at `frames`: not positive where undercut."""
        return np.sin(self.cutter.alpha) + sigma * self.ahead(frames, sf) * frames.kappa


@dataclass(frozen=True, eq=False, kw_only=True)
class Rows(ShortRepr):
    """Segments of the outline, one per row, in order of rising s.

    Parameters
    ----------
    kind : (n,) int array
        `Curve`.
    sf, sigma : (n,) arrays
        Flank of a flank or fillet row; for a rounded edge the flank on which its centre lies;
        unused for land and tip.
    start, end : (n,) arrays, rad
        Driver angles at the ends, in order of travel; for a rounded edge the one at its flank
        (start for sigma = -1, end for +1), and 1 rad from it.
    low, high : (n,) arrays, mm
        For tips: distance from the centrode at the ends; for lands: minus the dedendum; for rounded
        edges the directions of the outward normals at the ends, rad.
    corner : (n,) bool array
        Whether a corner precedes the row.
    tooth : (n,) int array
        Tooth number, from 1, of the row (for lands: of the tooth before the space).
    """

    kind: Ints
    sf: Array
    sigma: Array
    start: Array
    end: Array
    low: Array
    high: Array
    corner: Mask
    tooth: Ints

    def select(self, index: Ints) -> Rows:
        """Return the rows `index`, in that order."""
        return Rows(**{name: values[index] for name, values in vars(self).items()})

    @classmethod
    def joined(cls, parts: list[Rows]) -> Rows:
        """Return the rows of `parts`, in order."""
        return cls(
            **{
                name: np.concatenate([getattr(part, name) for part in parts])
                for name in cls.__dataclass_fields__
            }
        )


def trace(toothing: Toothing, rows: Rows, index: Ints, phi: Array) -> tuple[Plane, Plane]:
    """Return points and forward unit tangents of rows at driver angles.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        Its curves.
    index : (k,) int array
        Row of each point.
    phi : (k,) array, rad
        Driver angle of each point.

    Returns
    -------
    points, tangents : (k,) complex arrays, mm and 1
        In the wheel's frame; forward means towards rising s.
    """
    cutter, w = toothing.cutter, toothing.turn
    kind, row_sf, row_sigma = rows.kind[index], rows.sf[index], rows.sigma[index]
    points, tangents = np.empty((2, len(phi)), dtype=np.complex128)
    flank, fillet, land, tip, rounded = (np.flatnonzero(kind == int(each)) for each in Curve)
    parallel = np.concatenate([land, tip])
    place = phi
    if rounded.size:
        row = index[rounded]
        start, end = rows.start[row], rows.end[row]
        place = phi.copy()
        place[rounded] = np.where(row_sigma[rounded] < 0.0, start, end)
    every = toothing.frames(place, curved=parallel.size > 0)

    if flank.size:
        frames, sf, sigma = every.some(flank), row_sf[flank], row_sigma[flank]
        normals = toothing.normals(frames, sigma)
        points[flank] = frames.p + toothing.ahead(frames, sf) * normals
        tangents[flank] = -sigma * w * normals

    if fillet.size:
        frames, sf, sigma = every.some(fillet), row_sf[fillet], row_sigma[fillet]
        arm = _tip_center(cutter, frames, sf + sigma * cutter.offset, w)
        length = np.abs(arm)
        unit = np.where(length > 0.0, arm, -w * frames.t) / np.where(length > 0.0, length, 1.0)
        points[fillet] = frames.p + arm + cutter.tip_radius * unit
        tangents[fillet] = w * unit

    if rounded.size:
        frames, row = every.some(rounded), index[rounded]
        share = (phi[rounded] - rows.start[row]) / (rows.end[row] - rows.start[row])
        normal = np.exp(1j * (rows.low[row] + share * (rows.high[row] - rows.low[row])))
        center = toothing.flank_points(frames, row_sf[rounded], row_sigma[rounded])
        points[rounded] = center + toothing.rounding * normal
        tangents[rounded] = normal / w

    if parallel.size:
        frames, row = every.some(parallel), index[parallel]
        span = rows.end[row] - rows.start[row]
        slope = (rows.high[row] - rows.low[row]) / np.where(span == 0.0, np.inf, span)
        height = rows.low[row] + (phi[parallel] - rows.start[row]) * slope
        points[parallel] = frames.p + height * w * frames.t
        direction = frames.t * (1.0 + frames.kappa * height + slope / frames.speed * w)
        tangents[parallel] = direction / np.abs(direction)
    return points, tangents


def _tip_center(cutter: Cutter, frames: Frames, x: Array, w: complex) -> Plane:
    """Vector from the pitch point to the centre of the cutter's tip arc (design: V), rack as limit.

    ``V = R*sin(beta)*T + (1/kc - R*cos(beta))*N`` with ``beta = (x - s)*kc`` and ``R = 1/kc + d``.
    """
    roll, kc, d = x - frames.s, cutter.kc, cutter.depth
    if kc == 0.0:
        return frames.t * (roll - d * w)
    beta = roll * kc
    lift = 2.0 * np.sin(0.5 * beta) ** 2 / kc
    return frames.t * ((1.0 / kc + d) * np.sin(beta) + (lift - d * np.cos(beta)) * w)


@dataclass(frozen=True, eq=False, kw_only=True)
class WheelCurves(ShortRepr):
    """The rows of a wheel, as `gearcam.numeric.sampling.Curves` over the driver angle, rad.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        Its curves, in order.
    """

    toothing: Toothing
    rows: Rows

    @property
    def start(self) -> Array:
        """Driver angle at which each row begins, (n,), rad."""
        return self.rows.start

    @property
    def end(self) -> Array:
        """Driver angle at which each row ends, (n,), rad."""
        return self.rows.end

    @property
    def corner(self) -> Mask:
        """Whether a corner precedes each row, (n,)."""
        return self.rows.corner

    @property
    def breaks(self) -> tuple[Ints, Array]:
        """Rows and driver angles, rad, of the law's knots inside rows."""
        rows = self.rows
        low, high = np.minimum(rows.start, rows.end), np.maximum(rows.start, rows.end)
        row, place = self.toothing.track.knots_between(low, high)
        curved = rows.kind[row] != Curve.ROUND  # arcs do not depend on the law
        return row[curved], place[curved]

    def at(self, index: Ints, parameter: Array) -> tuple[Plane, Plane]:
        """Return points, mm, and forward unit tangents of rows at driver angles, rad."""
        blocks = range(0, max(len(index), 1), _BLOCK)
        parts = [
            trace(self.toothing, self.rows, index[k : k + _BLOCK], parameter[k : k + _BLOCK])
            for k in blocks
        ]
        points, tangents = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)
        return points, tangents
