"""Rounded tips: arcs that touch flank and addendum curve, or both flanks of a narrow tooth.

The centre of such an arc lies on two parallels, each offset into the tooth by the radius: that of
the flank, which is a flank of another `sf`, and that of the addendum curve. So its end on the
flank is as exact as the flank itself.

A radius that would leave nothing of a flank above the pitch curve is refused.
"""

from __future__ import annotations

import math
from copy import deepcopy
from functools import partial
from typing import NamedTuple

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.gears.flank import Curve, Rows, Toothing
from gearcam.gears.flank_ends import ROUGH, TipEnds, cross, flank_at, flank_crossings, near
from gearcam.gears.track import Frames
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.roots import largest_fitting

_EDGE = 1e-12
"""Driver angle, rad, by which an arc may touch a tip beyond its end: rounding."""

_HALVINGS = 30
"""Relative tolerance in the search for the largest radius."""

_INSIDE = 1e-6
"""Share by which the radius named stays below the largest, since it is printed with six digits."""


class _Tops(NamedTuple):
    """Upper ends of the flanks of all teeth formed, (2z,): sigma = +1, then sigma = -1.

    Rows of flank and tip, -1 for flanks outside an open blank and for pointed teeth; the angle by
    which rows are ahead of their teeth, rad (one turn at the seam); the tip's first angle, its
    height there, mm, and the slope of that height.
    """

    row: Ints
    tip: Ints
    row_turn: Array
    tip_turn: Array
    start: Array
    height: Array
    slope: Array


def round_tips(toothing: Toothing, rows: Rows, tips: TipEnds) -> tuple[Rows, Array]:
    """Return the rows of a wheel with rounded tip edges.

    Parameters
    ----------
    toothing : Toothing
        The wheel, with the radius ``rounding``.
    rows : Rows
        Its curves, loops removed, open ends cut.
    tips : TipEnds
        Ends of the flanks of all teeth formed.

    Returns
    -------
    rows : Rows
        With each arc as a row of its own.
    highest : (2z,) array, mm
        Reach w of the flanks at the upper end; nan of those outside an open blank.

    Raises
    ------
    InfeasibleError
        If the radius is too large; with the largest.
    """
    tops = _tops(toothing, rows, tips)
    rounded = _arcs(toothing, rows, tips, tops, toothing.rounding)
    if rounded is None:
        largest = largest_fitting(
            lambda radius: _arcs(toothing, rows, tips, tops, radius) is not None,
            toothing.rounding,
            _HALVINGS,
        )
        largest = float(f"{largest * (1.0 - _INSIDE):.6g}")
        what = "the tip rounding is too large: it leaves no flank above the pitch curve"
        note = f"use a radius up to {formatted(largest)} mm"
        raise beyond_limit(
            what, f"wheel {toothing.wheel}, blank.tip_rounding_mm", toothing.rounding, largest, note
        )
    return rounded


def _tops(toothing: Toothing, rows: Rows, tips: TipEnds) -> _Tops:
    z, first = len(toothing.numbers), toothing.numbers[0]
    row, tip = np.full(2 * z, -1), np.full(z, -1)
    flank, top = (np.flatnonzero(rows.kind == kind) for kind in (Curve.FLANK, Curve.TIP))
    rising, falling = flank[rows.sigma[flank] < 0.0], flank[rows.sigma[flank] > 0.0][::-1]
    # with loops removed a flank can be several rows: the last one written is at the tip
    row[rows.tooth[rising] - first + z] = rising
    row[rows.tooth[falling] - first] = falling
    tip[rows.tooth[top] - first] = top
    row_turn, tip_turn = np.zeros(2 * z), np.zeros(z)
    if toothing.closed:
        row_turn[z] = tip_turn[0] = toothing.track.around
    span, rise = (values[:z] - values[z:] for values in (tips.foot, tips.height))
    slope = rise / np.where(span == 0.0, 1.0, span)
    of_teeth = (tip_turn, tips.foot[z:], tips.height[z:], slope)
    return _Tops(row, np.tile(tip, 2), row_turn, *(np.tile(values, 2) for values in of_teeth))


def _arcs(
    toothing: Toothing, rows: Rows, tips: TipEnds, tops: _Tops, radius: float
) -> tuple[Rows, Array] | None:
    """Return the rows and reaches of `round_tips`, or None if the radius is too large."""
    (sf, sigma), z = toothing.flanks, len(toothing.numbers)
    centers = sf - sigma * radius / math.cos(toothing.cutter.alpha)
    curve = partial(_moved_tip, toothing, tops, radius)
    there = tops.row >= 0
    flank = partial(flank_at, toothing, centers, sigma)
    base, top = toothing.track.angle(sf), tips.phi
    begin, far = np.stack([0.5 * (base + top), tips.foot]), np.full(top.shape, math.inf)
    low, high = np.stack([np.minimum(base, top), -far]), np.stack([np.maximum(base, top), far])
    phi, foot, miss = cross(toothing, flank, curve, begin, (low, high))
    place = foot + tops.tip_turn
    fits = (tops.tip >= 0) & (miss <= ROUGH * near(toothing))
    fits &= (place >= rows.start[tops.tip] - _EDGE) & (place <= rows.end[tops.tip] + _EDGE)
    # two arcs with no tip between them are merged, as on pointed teeth
    narrow = ~(fits[:z] & fits[z:]) | (foot[z:] >= foot[:z])
    both = np.flatnonzero(narrow & there[:z] & there[z:]) + np.array([[z], [0]])
    if both.size:
        phi[both], met = flank_crossings(
            toothing, centers[both], sigma[both], base[both], top[both]
        )
        fits[both] = met
    reach, end = sigma * (sf - toothing.track.arc_length(np.stack([phi, tips.phi])))
    if not np.all(fits & (reach > 0.0) & (reach < end), where=there):
        return None
    normals = sigma * toothing.normals(toothing.frames(phi), sigma)
    moves = curve(foot, toothing.frames(foot))[1]
    others = toothing.turn * moves / np.abs(moves)
    others[both[0]] = normals[both[1]]
    ends = _put_in(rows, tops, sigma, phi, foot, both)
    at = np.flatnonzero(there)
    at = at[~np.isin(at, both[1])]  # a merged tooth has one arc, that of its rising flank
    rising = sigma[at] < 0.0
    turns = np.where(rising, np.angle(others[at] / normals[at]), np.angle(normals[at] / others[at]))
    first = np.angle(np.where(rising, normals[at], others[at]))
    arcs = Rows(
        kind=np.full(at.size, Curve.ROUND),
        sf=centers[at],
        sigma=sigma[at],
        start=np.where(rising, phi[at], phi[at] - 1.0),
        end=np.where(rising, phi[at] + 1.0, phi[at]),
        low=first,
        high=first + turns,
        corner=np.zeros(at.size, dtype=bool),
        tooth=rows.tooth[tops.row[at]],
    )
    place = np.append(np.arange(len(rows.kind)), np.where(rising, tops.row[at], tops.tip[at]) + 0.5)
    kept = np.ones(len(place), dtype=bool)
    kept[tops.tip[both[0]][tops.tip[both[0]] >= 0]] = False
    order = np.argsort(place, kind="stable")
    chain = Rows.joined([ends, arcs]).select(order[kept[order]])
    chain.corner[0] = True  # start of a chain without corners
    return chain, np.where(there, reach, np.nan)


def _moved_tip(
    toothing: Toothing, tops: _Tops, radius: float, foot: Array, base: Frames
) -> tuple[Plane, Plane]:
    """Return points of tips offset inwards, over their feet, and derivatives, mm and mm/rad."""
    w = toothing.turn
    height = tops.height + (foot - tops.start) * tops.slope
    move = base.t * (base.speed * (1.0 + base.kappa * height) + tops.slope * w)
    along = move / np.abs(move)
    points = base.p + height * w * base.t - radius * w * along
    return points, along * (np.abs(move) - radius * base.kappa * base.speed)


def _put_in(rows: Rows, tops: _Tops, sigma: Array, phi: Array, foot: Array, both: Ints) -> Rows:
    """Return the rows with flanks and tips cut back to the arcs."""
    cut, whole = deepcopy(rows), tops.row >= 0
    tips = whole & (tops.tip >= 0)
    tips[both] = False
    ends = (-1, cut.end, cut.start, cut.low), (1, cut.start, cut.end, cut.high)
    for side, own, edge, height in ends:
        at = np.flatnonzero(whole & (sigma == side))
        own[tops.row[at]] = phi[at] + tops.row_turn[at]
        at = np.flatnonzero(tips & (sigma == side))
        edge[tops.tip[at]] = foot[at] + tops.tip_turn[at]
        height[tops.tip[at]] = tops.height[at] + (foot[at] - tops.start[at]) * tops.slope[at]
        cut.corner[tops.tip[at]] = False
    cut.corner[tops.row[whole & (sigma > 0.0)]] = False
    return cut
