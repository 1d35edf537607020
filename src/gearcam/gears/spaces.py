"""The chain of curves around a wheel, space by space, with loops removed.

A space has five curves: flank, fillet, root land, fillet, flank; each tooth has its tip. Without
undercut they join smoothly. An undercut flank crosses its fillet, in narrow roots fillets cross
each other, and where the radius of curvature is below the dedendum the land crosses itself: then
the chain has loops, which the cutter removes. `untangle` finds each crossing on the true curves and
removes the loop.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcam.gears.flank import Curve, Rows, Toothing, WheelCurves
from gearcam.gears.flank_ends import ROUGH, TipEnds, Undercut, near
from gearcam.numeric.arrays import Array, Ints, in_groups
from gearcam.numeric.crossings import (
    Branch,
    Chain,
    CurvePoint,
    Ring,
    remaining,
    rows_between,
)

ROWS_PER_TOOTH = 6
_ABOUT, _WIDE = 32, 0.25
"""Points on each side of a jump, and their distances from it, in lengths of the curve."""

_SHARP = 0.9
"""Curvature times dedendum from which a root is examined: at 1 the land has a cusp."""

_SAMPLES, _DENSER = 49, 4
"""Points of the chords of each curve, and how often they are doubled where chords cross but the
curves do not."""


def regular_rows(toothing: Toothing, tips: TipEnds) -> Rows:
    """Return the rows of a wheel as if without undercut: five per space and one per tip.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    tips : TipEnds
        Ends of its flanks: the sigma = +1 flanks of all teeth, then the sigma = -1 flanks.

    Returns
    -------
    Rows
        Row ``6*j + k`` is curve k of the space after the j-th tooth formed; k = 5 is the tip of the
        next tooth.
    """
    cutter, half, z = toothing.cutter, toothing.half_tooth, len(toothing.numbers)
    # a closed wheel's last space ends at its first tooth, a turn later; an open one has none there
    count = z if toothing.closed else z - 1
    turn, following = np.divmod(np.arange(1, count + 1), z)
    wrap = turn * toothing.track.around
    plus = toothing.tooth_places[:count] + half
    minus = toothing.tooth_places[following] + turn * toothing.length - half
    forms = toothing.track.angle(
        np.stack(
            [plus + cutter.reach, plus + cutter.offset, minus - cutter.offset, minus - cutter.reach]
        )
    )
    land, number = -cutter.dedendum, np.array(toothing.numbers)
    table = {
        "kind": [Curve.FLANK, Curve.FILLET, Curve.LAND, Curve.FILLET, Curve.FLANK, Curve.TIP],
        "sf": [plus, plus, 0.0, minus, minus, 0.0],
        "sigma": [1.0, 1.0, 0.0, -1.0, -1.0, 0.0],
        "start": [tips.phi[:count], *forms, tips.foot[z + following] + wrap],
        "end": [*forms, tips.phi[z + following] + wrap, tips.foot[following] + wrap],
        "low": [0.0, 0.0, land, 0.0, 0.0, tips.height[z + following]],
        "high": [0.0, 0.0, land, 0.0, 0.0, tips.height[following]],
        "corner": [True, False, False, False, False, True],
        "tooth": [*[number[:count]] * 3, *[number[following]] * 3],
    }
    columns = {}
    for name, values in table.items():
        column = np.empty((count, ROWS_PER_TOOTH), np.result_type(*values))
        for k, value in enumerate(values):
            column[:, k] = value
        columns[name] = column.ravel()
    return Rows(**columns)


def entangled(toothing: Toothing, rows: Rows, cusps: Undercut) -> Ints:
    """Return the spaces (from 0) whose chain of curves may have loops.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        From `regular_rows`.
    cusps : Undercut
        Cusps of the sigma = +1 flanks, then of the sigma = -1 flanks.

    Returns
    -------
    (k,) int array
        Spaces with an undercut flank, a root radius below the dedendum, or no land.
    """
    z = len(toothing.numbers)
    undercut = np.isfinite(cusps.dedendum)
    loops = undercut[:z] | np.roll(undercut[z:], -1)
    loops = loops if toothing.closed else loops[:-1]
    if toothing.cutter.dedendum >= _SHARP * toothing.track.convex.radius:
        start, end = rows.start[1::ROWS_PER_TOOTH], rows.end[3::ROWS_PER_TOOTH]
        steps = start + (end - start) * np.linspace(0.0, 1.0, 65)[:, None]
        sharp = toothing.frames(steps).kappa * toothing.cutter.dedendum >= _SHARP
        loops = loops | sharp.any(axis=0)
    return np.flatnonzero(loops)


def untangle(toothing: Toothing, rows: Rows, spaces: Ints) -> list[Rows]:
    """Return spaces with their loops removed.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        From `regular_rows`.
    spaces : (k,) int array
        Numbers of the spaces, from 0.

    Returns
    -------
    list of Rows
        For each space its remaining curves, followed by the tip.
    """
    curves, samples = WheelCurves(toothing=toothing, rows=rows), _SAMPLES
    untangled: dict[int, Rows] = {}
    left = spaces
    for _ in range(_DENSER + 1):
        if not left.size:
            break
        rings = [first for first, *_ in remaining(curves, _chains(curves, left, samples))]
        for space, ring in zip(left.tolist(), rings, strict=True):
            untangled[space] = _along(curves, space, ring)
        left = left[[ring.gap > ROUGH * near(toothing) for ring in rings]]
        samples = 2 * samples - 1
    return [untangled[int(space)] for space in spaces]


def _along(curves: WheelCurves, space: int, ring: Ring) -> Rows:
    """Return the remaining rows of a space, followed by the tip."""
    tip = ROWS_PER_TOOTH * (space + 1) - 1
    *inner, last = ring.branches
    branches = [*inner, Branch(last.begin, CurvePoint(tip, float(curves.rows.end[tip])))]
    index, start, end, corner = rows_between(curves, branches)
    return replace(curves.rows.select(index), start=start, end=end, corner=corner)


def _chains(curves: WheelCurves, spaces: Ints, samples: int) -> list[Chain]:
    """Return points of the five curves of spaces, denser towards places of possible tiny loops.

    These are the form points and the jumps of curvature, at which flanks may turn back.
    """
    t = np.linspace(0.0, 1.0, samples)
    towards_start, towards_end = t**3, 1.0 - (1.0 - t) ** 3
    grading = [towards_end, towards_start, t, towards_end, towards_start]
    rows = curves.rows
    curve = ROWS_PER_TOOTH * spaces[:, None] + np.arange(len(grading))
    start, span = rows.start[curve][..., None], (rows.end - rows.start)[curve][..., None]
    share = np.broadcast_to(grading, (*curve.shape, samples))
    share = np.sort(np.concatenate([share, _about_jumps(curves, curve)], axis=2), axis=2)
    phi = start + span * share
    low, high = (one.reshape(len(spaces), -1) for one in (phi[..., :-1], phi[..., 1:]))
    curve = np.repeat(curve, share.shape[2] - 1, axis=1)
    along = curve[:, [*range(curve.shape[1]), -1]]
    phi = np.append(low, high[:, -1:], 1)
    points = curves.at(along.ravel(), phi.ravel())[0].reshape(phi.shape)
    if curves.toothing.turn.imag > 0.0:  # mirrored, since the metal is to the right of rising s
        points = np.conj(points)
    return [
        Chain(curve=number, low=begin, high=end, points=path)
        for number, begin, end, path in zip(curve, low, high, points, strict=True)
    ]


def _about_jumps(curves: WheelCurves, curve: Ints) -> Array:
    """Return parameters from 0 to 1 around the jumps of curvature in curves, (*curve.shape, n).

    Curves with fewer jumps are padded with 0, their beginning.
    """
    rows, toothing = curves.rows, curves.toothing
    start, end = rows.start[curve.ravel()], rows.end[curve.ravel()]
    number, place = toothing.track.jumps_between(
        np.minimum(start, end), np.maximum(start, end), toothing.pitch
    )
    count = np.bincount(number, minlength=start.size)
    _, order = in_groups(count)
    about = np.zeros((start.size, int(count.max()), 2 * _ABOUT + 1))
    away = np.arange(-_ABOUT, _ABOUT + 1) / _ABOUT
    share = ((place - start[number]) / (end - start)[number])[:, None] + _WIDE * away**3
    about[number, order] = np.clip(share, 0.0, 1.0)
    return about.reshape(*curve.shape, about.shape[1] * about.shape[2])
