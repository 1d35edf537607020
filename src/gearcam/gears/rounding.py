"""Rounded tips: arcs that touch flank and addendum curve, or both flanks of a narrow tooth.

The centre of such an arc lies on the flank moved into the tooth by the radius, which is the flank
of another `sf`, and on the addendum curve moved inwards, a parallel as well. So its end on the flank is
known as exactly as the flank itself.

Refused: radii for which an arc would leave nothing of a flank above the pitch curve.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gearcam.errors import InfeasibleError
from gearcam.gears.flank import Curve, Rows, Toothing
from gearcam.gears.spaces import join, select
from gearcam.gears.track import Frames, Plane

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_STEPS = 25
_MISS = 1e-12
"""Distance at which two moved curves meet, in pitches."""

_HALVINGS = 30


def round_tips(toothing: Toothing, rows: Rows) -> tuple[Rows, Array, Ints, Array]:
    """Round the edges of the tips.

    Parameters
    ----------
    toothing : Toothing
        The wheel, with the radius ``rounding``.
    rows : Rows
        Its curves, loops taken out, open ends cut.

    Returns
    -------
    rows : Rows
        With the arcs, each a row of its own.
    places, sides : (n,) arrays, mm and 1
        sf and sigma of the flanks that became shorter.
    highest : (n,) array, mm
        Their reach w at the upper end.

    Raises
    ------
    InfeasibleError
        Naming the largest radius.
    """
    found = _arcs(toothing, rows, toothing.rounding)
    if found is None:
        low, high = 0.0, toothing.rounding
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            fits = _arcs(toothing, rows, middle) is not None
            low, high = (middle, high) if fits else (low, middle)
        largest = float(f"{low * (1.0 - 1e-6):.6g}")
        raise InfeasibleError(
            "tips rounded so much leave nothing of a flank above the pitch curve",
            where=f"wheel {toothing.wheel}, blank.tip_rounding_mm",
            value=toothing.rounding,
            limit=largest,
            unit="mm",
            nearest=f"a radius up to {largest:.6g} mm",
        )
    return found


def _arcs(toothing: Toothing, rows: Rows, radius: float) -> tuple[Rows, Array, Ints, Array] | None:
    """Return what `round_tips` does, or None where the radius is too large."""
    joints = _Joints(toothing, rows)
    phi, foot, fits = _touch(toothing, rows, joints, radius)
    # arcs that leave no tip between them become one; so do those of pointed teeth
    narrow = ~fits
    whole = joints.paired
    place = foot + joints.turn
    crossed = place[whole[0]] >= place[whole[1]]
    narrow[whole[0][crossed]] = narrow[whole[1][crossed]] = True
    narrow[whole[0]] |= narrow[whole[1]]
    narrow[whole[1]] = narrow[whole[0]]
    pairs = np.concatenate([whole[:, narrow[whole[0]]], joints.pointed], axis=1)
    if pairs.size:
        both, met = _meet(toothing, rows, joints, pairs, radius)
        if not met.all():
            return None
        phi[pairs[0]], phi[pairs[1]] = both
        fits[pairs] = True
    s = toothing.track.arc_length(phi)
    reach = joints.sigma * (joints.sf - s)
    if not (fits.all() and bool(np.all(reach > 0.0))):
        return None
    merged = np.zeros(len(phi), dtype=bool)
    merged[pairs] = True
    made = _put_in(toothing, rows, joints, (phi, foot, merged, pairs), radius)
    return made, joints.sf, joints.sigma.astype(np.int64), reach


class _Joints:
    """Where flanks meet tips: one entry a flank with an outer edge at its top."""

    def __init__(self, toothing: Toothing, rows: Rows) -> None:
        kind, size = rows.kind, len(rows.kind)
        this, after = np.arange(size), np.roll(np.arange(size), -1)
        if not toothing.closed:
            this, after = this[:-1], after[:-1]
        turn = toothing.track.around
        flank, tip = kind == Curve.FLANK, kind == Curve.TIP
        rises, falls = flank & (rows.sigma < 0.0), flank & (rows.sigma > 0.0)
        up = np.flatnonzero(rises[this] & tip[after])
        down = np.flatnonzero(tip[this] & falls[after])
        point = np.flatnonzero(rises[this] & falls[after])
        zero = np.full(point.size, -1)
        self.row = np.concatenate([this[up], after[down], this[point], after[point]])
        """Row of the flank."""
        self.tip = np.concatenate([after[up], this[down], zero, zero])
        """Row of the tip, -1 for pointed teeth."""
        self.sigma = rows.sigma[self.row]
        self.sf = rows.sf[self.row]
        self.turn = np.where(self.row < self.tip - size // 2, turn, 0.0)
        """What the tip's angles are ahead of the flank's, rad: a turn at the seam."""
        n, k = len(up) + len(down), point.size
        self.pointed = np.stack([n + np.arange(k), n + k + np.arange(k)])
        """Entries of both flanks of pointed teeth."""
        order = {int(t): i for i, t in enumerate(self.tip[: len(up)])}
        both = [
            (order[int(t)], len(up) + i)
            for i, t in enumerate(self.tip[len(up) : n])
            if int(t) in order
        ]
        self.paired = np.array(both, dtype=np.int64).reshape(-1, 2).T
        """Entries of both flanks of teeth with a tip."""


def _touch(
    toothing: Toothing, rows: Rows, joints: _Joints, radius: float
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Find where arcs touch flanks and tips: driver angles, rad, of both, and whether they do."""
    w, sigma, tip = toothing.turn, joints.sigma, joints.tip
    sf = joints.sf - sigma * radius / math.cos(toothing.cutter.alpha)
    has = tip >= 0
    start, end = rows.start[tip] - joints.turn, rows.end[tip] - joints.turn
    phi = np.where(sigma < 0.0, rows.end[joints.row], rows.start[joints.row])
    foot = np.where(sigma < 0.0, start, end)
    miss = np.full(phi.shape, np.inf, dtype=complex)
    for _ in range(_STEPS):
        roll, base = toothing.frames(phi), toothing.frames(foot)
        height, way = _addendum_curve(toothing, rows, joints, foot, base)
        along = way / np.abs(way)
        center = base.p + height * w * base.t - radius * w * along
        miss = toothing.flank_points(roll, sf, sigma) - center
        move = toothing.flank_motion(roll, sf, sigma)
        slide = -along * (np.abs(way) - radius * base.kappa * base.speed)
        with np.errstate(divide="ignore", invalid="ignore"):
            steps = (
                -np.imag(np.conj(slide) * miss) / np.imag(np.conj(slide) * move),
                -np.imag(np.conj(move) * miss) / np.imag(np.conj(move) * slide),
            )
        good = np.isfinite(steps[0]) & np.isfinite(steps[1]) & has
        phi, foot = (
            v + np.where(good, step, 0.0) for v, step in zip((phi, foot), steps, strict=True)
        )
        if np.all(np.abs(miss[has]) <= _MISS * toothing.pitch):
            break
    inside = (foot >= start - 1e-12) & (foot <= end + 1e-12)
    return phi, foot, has & inside & (np.abs(miss) <= 1e3 * _MISS * toothing.pitch)


def _meet(
    toothing: Toothing, rows: Rows, joints: _Joints, pairs: Ints, radius: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Find the driver angles, rad, (2, n), at which both moved flanks of teeth cross."""
    row, sigma = joints.row[pairs], joints.sigma[pairs]
    sf = joints.sf[pairs] - sigma * radius / math.cos(toothing.cutter.alpha)
    turn = toothing.track.around
    phi = np.where(sigma < 0.0, rows.end[row], rows.start[row])
    # at the seam both flanks are told in one turn
    seam = np.where(np.abs(sf[0] - sf[1]) > toothing.length / 2.0, 1.0, 0.0)
    sf[1] += seam * toothing.length
    phi[1] += seam * turn
    miss = np.full(phi.shape[1], np.inf, dtype=complex)
    for _ in range(_STEPS):
        frames = [toothing.frames(phi[k]) for k in (0, 1)]
        one, two = (toothing.flank_points(frames[k], sf[k], sigma[k]) for k in (0, 1))
        miss = one - two
        moves = [toothing.flank_motion(frames[k], sf[k], sigma[k]) for k in (0, 1)]
        with np.errstate(divide="ignore", invalid="ignore"):
            first = -np.imag(np.conj(moves[1]) * miss) / np.imag(np.conj(moves[1]) * moves[0])
            second = np.imag(np.conj(moves[0]) * miss) / np.imag(np.conj(moves[0]) * moves[1])
        step = np.stack([first, second])
        phi = phi + np.where(np.isfinite(step), step, 0.0)
        if np.all(np.abs(miss) <= _MISS * toothing.pitch):
            break
    phi[1] -= seam * turn
    return phi, np.abs(miss) <= 1e3 * _MISS * toothing.pitch


def _put_in(
    toothing: Toothing,
    rows: Rows,
    joints: _Joints,
    ends: tuple[Array, Array, NDArray[np.bool_], Ints],
    radius: float,
) -> Rows:
    """Return the rows with arcs put in, flanks and tips shortened, merged tips left out."""
    phi, foot, merged, pairs = ends
    rising, w, alpha = joints.sigma < 0.0, toothing.turn, toothing.cutter.alpha
    start, end, low, high, corner = (
        getattr(rows, name).copy() for name in ("start", "end", "low", "high", "corner")
    )
    end[joints.row[rising]], start[joints.row[~rising]] = phi[rising], phi[~rising]
    tips = ~merged
    for some, edge, height in ((rising & tips, start, low), (~rising & tips, end, high)):
        tip, place = joints.tip[some], foot[some] + joints.turn[some]
        span = rows.end[tip] - rows.start[tip]
        share = (place - rows.start[tip]) / np.where(span == 0.0, 1.0, span)
        height[tip] = rows.low[tip] + share * (rows.high[tip] - rows.low[tip])
        edge[tip] = place
        corner[tip] = False
    corner[joints.row[~rising]] = False
    shortened = replace(rows, start=start, end=end, low=low, high=high, corner=corner)

    frames = toothing.frames(phi)
    sides = joints.sigma * toothing.normals(frames, joints.sigma)
    way = _addendum_curve(toothing, rows, joints, foot, toothing.frames(foot))[1]
    others = w * way / np.abs(way)
    others[pairs[0]] = sides[pairs[1]]
    own = tips.copy()
    own[pairs[0]] = True  # one arc a merged tooth, told by its first flank
    turns = np.where(rising, np.angle(others / sides), np.angle(sides / others))
    first = np.angle(np.where(rising, sides, others))
    at = np.flatnonzero(own)
    arcs = Rows(
        kind=np.full(at.size, Curve.ROUND),
        sf=(joints.sf - joints.sigma * radius / math.cos(alpha))[at],
        sigma=joints.sigma[at],
        start=np.where(rising, phi, phi - 1.0)[at],
        end=np.where(rising, phi + 1.0, phi)[at],
        low=first[at],
        high=(first + turns)[at],
        corner=np.zeros(at.size, dtype=bool),
        tooth=rows.tooth[joints.row[at]],
    )
    place = np.concatenate(
        [np.arange(len(rows.kind)), np.where(rising, joints.row + 0.5, joints.tip + 0.5)[at]]
    )
    kept = np.ones(len(place), dtype=bool)
    kept[joints.tip[merged & (joints.tip >= 0)]] = False
    order = np.argsort(place, kind="stable")
    made = select(join([shortened, arcs]), order[kept[order]])
    made.corner[0] = True  # where a chain without corners begins
    return made


def _addendum_curve(
    toothing: Toothing, rows: Rows, joints: _Joints, foot: Array, base: Frames
) -> tuple[Array, Plane]:
    """Heights of tips over their feet, mm, with frames `base`, and how they move on, mm/rad."""
    tip, w = joints.tip, toothing.turn
    start, end = rows.start[tip], rows.end[tip]
    slope = (rows.high - rows.low)[tip] / np.where(end == start, 1.0, end - start)
    height = rows.low[tip] + (foot + joints.turn - start) * slope
    return height, base.t * (base.speed * (1.0 + base.kappa * height) + slope * w)
