"""How far tips may reach into the mate's roots.

At the moment of contact the end of a flank lies on the mate's flank. Where the centrode is concave
the corner goes on deeper beyond that moment, and may run into the mate's root. Such corners are
found in two steps: those that come near the depth of the mate's root, or where a wheel is cut by a
small pinion, are followed against its outline. Most wheels have none.

In an internal pair a corner counts only below the mate's centrode: above it tips meet tips, which
shorter flanks do not cure (see `gearcam.gears.tip_pass`).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from gearcam.gears.cutter import Cutter
from gearcam.gears.flank import Toothing
from gearcam.gears.polar import PolarCurve
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

_WINDOW, _WIDE = 1.25, 8.0
"""Pitches of roll on either side of a flank over which its corner is followed; in tight parts."""

_ROLLS = 48
"""Rolls in a pitch."""

_HALVINGS = 14
"""A reach of three modules halved 14 times: 0.0002 modules."""

_CAUTION = 0.4
"""Share of the clearance within which a corner is followed."""

_ABOUT = 0.8
"""Share of the way to the mate's form point from which a corner counts as there."""

_FEW = 24.0
"""Teeth of a pinion cutter below which all corners are followed: it leaves much in the corners of a
root, and in so tight a place tips crowd."""


def highest_corners(
    toothing: Toothing,
    mate: Toothing,
    mate_outline: Callable[[], Array],
    tolerance: float,
    flanks: tuple[Array, Array],
    highest: Array,
) -> Array:
    """Return the largest reach at which each flank's corner stays out of the mate's root.

    Parameters
    ----------
    toothing, mate : Toothing
        The wheel and the other one.
    mate_outline : callable
        Returns the outline of the other wheel, (n, 2), mm; called only where it is needed.
    tolerance : float, mm
        Its chord error. A corner only touches up to twice this depth: at contact it lies on the
        mate's flank.
    flanks : (sf, sigma), two (n,) arrays, mm and 1
        Flanks.
    highest : (n,) array, mm
        Reach of their ends as they would be.

    Returns
    -------
    (n,) array, mm
        `highest` where it does no harm.
    """
    if toothing.track.concave.radius == math.inf and mate.cutter.kc == 0.0:
        return highest.copy()
    # a closed pair repeats with its lobes
    teeth = len(highest) // 2
    count = math.gcd(toothing.teeth, mate.teeth) if toothing.closed and mate.closed else teeth
    sf, sigma, highest = (v.reshape(2, -1)[:, :count].ravel() for v in (*flanks, highest))
    flanks, result = (sf, sigma), highest.copy()

    def of_all() -> Array:
        return np.tile(result.reshape(2, -1), teeth // count).ravel()

    hollow, ring = mate.track.hollow, mate.track.ring
    internal = ring or toothing.track.ring
    near = _deep(toothing, mate.cutter, flanks, highest)
    if internal:
        near |= _grazing(toothing, mate.cutter, flanks, highest)
    tight = min(toothing.cutter.teeth, mate.cutter.teeth) < _FEW and not internal
    at = np.flatnonzero(near | tight)
    if at.size == 0:
        return of_all()
    import shapely

    body = shapely.Polygon(mate_outline()).buffer(2.0 * (tolerance if hollow else -tolerance))
    shapely.prepare(body)
    centrode = PolarCurve(mate, 0.0) if internal else None

    def hits(some: Ints, reach: Array) -> Mask:
        window = _WIDE if tight else _WINDOW
        phi, along = _paths(toothing, (sf[some], sigma[some]), reach, window)
        other = mate.frames(phi, curved=False)
        # both tangents are one, and the outward normals opposite
        path = other.p + other.t * along
        metal = shapely.contains_xy(body, path.real, path.imag) != hollow
        if centrode is not None:
            metal &= (centrode.beyond(path) > 0.0) == ring
        return np.any(metal, axis=1)

    at = at[hits(at, highest[at])]
    low, high = np.zeros(at.size), highest[at]
    for _ in range(_HALVINGS if at.size else 0):
        middle = 0.5 * (low + high)
        bad = hits(at, middle)
        low, high = np.where(bad, low, middle), np.where(bad, middle, high)
    result[at] = low
    return of_all()


def _paths(
    toothing: Toothing, flanks: tuple[Array, Array], reach: Array, window: float
) -> tuple[Array, Plane]:
    """Return rolls as driver angles, and where ends of flanks are there from P, seen along T."""
    sf, sigma = flanks
    ends = toothing.track.angle(sf - sigma * reach)
    corner = toothing.flank_points(toothing.frames(ends, curved=False), sf, sigma)
    steps = np.arange(-window, window + 0.5 / _ROLLS, 1.0 / _ROLLS)
    phi = toothing.track.angle(sf[:, None] + toothing.pitch * steps)
    own = toothing.frames(phi, curved=False)
    return phi, np.conj(own.t) * (corner[:, None] - own.p)


def _grazing(toothing: Toothing, cutter: Cutter, flanks: tuple[Array, Array], reach: Array) -> Mask:
    """Whether corners that end about the mate's form point run into the fillet that begins there.

    There the corner's path touches the fillet. By Euler and Savary it bends less, and so goes into
    the metal, where ``kappa - kc > sin(alpha)*rho/(l*(l - rho))`` with ``l = reach*cos(alpha)``.
    """
    sf, sigma = flanks
    kappa = toothing.frames(toothing.track.angle(sf - sigma * reach)).kappa
    far = cutter.reach * math.cos(cutter.alpha)
    room = math.sin(cutter.alpha) * cutter.tip_radius / (far * (far - cutter.tip_radius))
    return (reach > _ABOUT * cutter.reach) & (kappa - cutter.kc > room)


def _deep(toothing: Toothing, cutter: Cutter, flanks: tuple[Array, Array], reach: Array) -> Mask:
    """Whether corners go deep below the mate's pitch line, as on a straight rack, at any roll.

    The rolls of neighbouring teeth are a pitch apart, and are the same ones for most of their way.
    """
    sf, sigma = (values.reshape(2, -1) for values in flanks)
    ends = toothing.track.angle(sf - sigma * reach.reshape(sf.shape))
    corner = toothing.flank_points(toothing.frames(ends, curved=False), sf, sigma)
    rolls = np.arange(-_WINDOW * _ROLLS, (_WINDOW + sf.shape[1] - 1) * _ROLLS + 1) / _ROLLS
    own = toothing.frames(toothing.track.angle(sf[:, :1] + toothing.pitch * rolls), curved=False)
    up = np.conj(toothing.turn * own.t)
    base = np.real(up * own.p)
    count = round(2 * _WINDOW * _ROLLS) + 1
    up, base = (sliding_window_view(v, count, axis=1)[:, ::_ROLLS] for v in (up, base))
    down = np.real(up * corner[..., None]) - base
    clearance = cutter.dedendum - toothing.cutter.addendum
    return np.any(down > cutter.dedendum - _CAUTION * clearance, axis=2).ravel()
