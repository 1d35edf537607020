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

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.cutter import Cutter
from gearcam.gears.rolling import TURN, Frames, Plane, Rolling, Wheel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class Kind(IntEnum):
    """The kinds of curve that an outline is made of."""

    FLANK = 0
    FILLET = 1
    LAND = 2
    TIP = 3
    ROUND = 4


@dataclass(frozen=True, eq=False, kw_only=True)
class Toothing:
    """A wheel's centrode with its cutter and tooth places.

    Parameters
    ----------
    rolling : Rolling
        The pair of centrodes.
    wheel : {1, 2}
        Which wheel.
    teeth : int
        Its number of teeth: pitches along its centrode.
    cutter : Cutter
        Its cutter.
    closed : bool
        Whether its teeth go all around; else its blank ends half a pitch beyond them.
    moved : float, mm
        How far its teeth are moved on along its centrode.
    rounding : float, mm
        Radius of the rounded edges of its tips.
    """

    rolling: Rolling
    wheel: Wheel
    teeth: int
    cutter: Cutter
    closed: bool = True
    moved: float = 0.0
    rounding: float = 0.0

    @property
    def turn(self) -> complex:
        """``N = turn*T``."""
        return TURN[self.wheel]

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
        half = 0.5 * self.pitch
        return np.array([-half, self.length + half])

    @property
    def numbers(self) -> range:
        """Numbers of the teeth that are formed.

        An open wheel's blank goes from half a pitch before s = 0 to half a pitch behind s = L. On
        wheel 1 the first and last tooth formed lie outside it, on wheel 2 half in it.
        """
        if self.closed:
            return range(1, self.teeth + 1)
        return range(self.teeth + (3 if self.wheel == 1 else 2))

    @property
    def whole(self) -> slice:
        """Places in `numbers` of the teeth that are whole."""
        return slice(None) if self.closed else slice(1, -1)

    @cached_property
    def tooth_places(self) -> Array:
        """Arc length of each formed tooth's middle, mm: (k - 1) pitches, on wheel 2 (k - 1/2)."""
        first = self.numbers[0] - (1.0 if self.wheel == 1 else 0.5)
        return self.moved + self.pitch * np.arange(first, first + len(self.numbers))

    def frames(self, phi: Array, *, curved: bool = True) -> Frames:
        """Return the frames of this wheel at driver angles, rad (see `Rolling.frames`)."""
        return self.rolling.frames(self.wheel, phi, curved=curved)

    def flank_points(self, frames: Frames, sf: Array, sigma: Array) -> Plane:
        """Return points of flanks (`sf`, `sigma`) at `frames`: feet from the pitch point."""
        cosine, sine = np.cos(self.cutter.alpha), np.sin(self.cutter.alpha)
        normal = frames.t * (cosine + sigma * sine * self.turn)
        return frames.p + (sf - frames.s) * cosine * normal

    def flank_motion(self, frames: Frames, sf: Array, sigma: Array) -> Plane:
        """Return how points of flanks (`sf`, `sigma`) move with the driver angle at `frames`."""
        g = sigma * self.regularity(frames, sf, sigma)
        return (
            -g * frames.speed * self.turn * frames.t * np.exp(self.turn * sigma * self.cutter.alpha)
        )

    def regularity(self, frames: Frames, sf: Array, sigma: Array) -> Array:
        """Return sigma*g of flanks (`sf`, `sigma`) at `frames`: not positive where undercut."""
        cosine, sine = np.cos(self.cutter.alpha), np.sin(self.cutter.alpha)
        return sine + sigma * (sf - frames.s) * frames.kappa * cosine


@dataclass(frozen=True, eq=False, kw_only=True)
class Rows:
    """Stretches of curve, one a row, in the order of the outline (rising s).

    Parameters
    ----------
    kind : (n,) int array
        `Kind`.
    sf, sigma : (n,) arrays
        Flank that a flank or fillet belongs to; of a rounded edge the flank on which its centre
        lies; unused for land and tip.
    start, end : (n,) arrays, rad
        Driver angles at the ends, in the order of travel; of a rounded edge the one at its flank
        (start for sigma = -1, end for +1), and a rad beyond it.
    low, high : (n,) arrays, mm
        For tips: distance from the centrode at the ends; for lands: minus the dedendum; for rounded
        edges the directions of the outward normals at the ends, rad.
    corner : (n,) bool array
        Whether a corner precedes the row.
    tooth : (n,) int array
        Tooth number, from 1, that the row belongs to (for lands: the tooth before the space).
    """

    kind: NDArray[np.int64]
    sf: Array
    sigma: Array
    start: Array
    end: Array
    low: Array
    high: Array
    corner: Mask
    tooth: NDArray[np.int64]


def trace(
    toothing: Toothing, rows: Rows, index: NDArray[np.int64], phi: Array
) -> tuple[Plane, Plane]:
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
        In the wheel's frame; forward is the direction of the outline with rising s.
    """
    cutter, w = toothing.cutter, toothing.turn
    kind = rows.kind[index]
    points, tangents = np.empty((2, len(phi)), dtype=np.complex128)

    flank = np.flatnonzero(kind == Kind.FLANK)
    if flank.size:
        frames = toothing.frames(phi[flank], curved=False)
        sf, sigma = rows.sf[index[flank]], rows.sigma[index[flank]]
        normal = frames.t * (np.cos(cutter.alpha) + sigma * np.sin(cutter.alpha) * w)
        points[flank] = frames.p + (sf - frames.s) * np.cos(cutter.alpha) * normal
        tangents[flank] = -sigma * w * normal

    fillet = np.flatnonzero(kind == Kind.FILLET)
    if fillet.size:
        frames = toothing.frames(phi[fillet], curved=False)
        sf, sigma = rows.sf[index[fillet]], rows.sigma[index[fillet]]
        arm = _tip_center(cutter, frames, sf + sigma * cutter.offset, w)
        length = np.abs(arm)
        unit = np.where(length > 0.0, arm, -w * frames.t) / np.where(length > 0.0, length, 1.0)
        points[fillet] = frames.p + arm + cutter.tip_radius * unit
        tangents[fillet] = w * unit

    rounded = np.flatnonzero(kind == Kind.ROUND)
    if rounded.size:
        row = index[rounded]
        start, end, sigma = rows.start[row], rows.end[row], rows.sigma[row]
        frames = toothing.frames(np.where(sigma < 0.0, start, end), curved=False)
        share = (phi[rounded] - start) / (end - start)
        normal = np.exp(1j * (rows.low[row] + share * (rows.high[row] - rows.low[row])))
        center = toothing.flank_points(frames, rows.sf[row], sigma)
        points[rounded] = center + toothing.rounding * normal
        tangents[rounded] = normal / w

    parallel = np.flatnonzero((kind == Kind.LAND) | (kind == Kind.TIP))
    if parallel.size:
        frames, row = toothing.frames(phi[parallel]), index[parallel]
        span = rows.end[row] - rows.start[row]
        width = np.where(span == 0.0, 1.0, span)
        rise = rows.high[row] - rows.low[row]
        height = rows.low[row] + (phi[parallel] - rows.start[row]) / width * rise
        points[parallel] = frames.p + height * w * frames.t
        slope = np.where(span == 0.0, 0.0, rise / width) / frames.speed
        direction = frames.t * (1.0 + frames.kappa * height + slope * w)
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
