"""Contact patches: overlap of each pair predicted from the exact flanks with the driver ahead.

Near their common normal both flanks are graphs over the common tangent. Where the driver's flank
penetrates its mate, the area between them is the difference of two integrals over the interval of
penetration. That also holds where an end of a flank or a knot of the law clips the patch; only the
parts beyond the end of a flank, on a fillet or a tip, are left out. Inside smooth flanks the patch
has the closed form ``(4/3)*delta*sqrt(2*delta/kr)`` with the penetration delta and the relative
curvature kr.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.contact import FlankPairs, FlankPositions, Normals, normals
from gearcam.gears.track import WHEELS, Wheel
from gearcam.meshing.contact import outermost, sought
from gearcam.meshing.placed_flanks import PlacedFlanks
from gearcam.numeric.arrays import Array, Ints, Mask
from gearcam.numeric.gauss import legendre_rule
from gearcam.numeric.roots import damped_newton, newton_in_bracket

_NODES, _WEIGHTS = legendre_rule(24)

_SMALL = 1e-9
"""Step, in pitches, at which the search for a common normal ends."""

_MISS = 1e-9
"""Largest residual of a common normal, in rad and pitches."""

_CLOSE = 1e-6
"""Tolerance of the ends of patches, in pitches: the depth there is negligible."""

_ANGLE = 1e-8
"""Step of Newton's method, rad, after which the next is below rounding."""


def closed_area(depth: Array, curvature: Array) -> Array:
    """Return the area of patches inside smooth flanks, mm^2: 003, figs. 2.34 to 2.38.

    Parameters
    ----------
    depth : (n,) array, mm
        Penetration of the flanks along their common normal.
    curvature : (n,) array, 1/mm
        Relative curvature of the flanks there; nan where it is not positive.

    Returns
    -------
    (n,) array, mm^2
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        area = (4.0 / 3.0) * depth * np.sqrt(2.0 * depth / curvature)
    return np.where(curvature > 0.0, area, np.nan)


@dataclass(frozen=True, eq=False, kw_only=True)
class Patches:
    """Predicted contact patches, one entry each.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Number of the phase; j.
    area : (n,) array, mm^2
        Integral of the depth.
    closed : (n,) array, mm^2
        Closed form; nan where the patch is clipped, contains a knot or is near a cusp.
    depth : (n,) array, mm
        Largest penetration, along the normal.
    """

    step: Ints
    pair: Ints
    area: Array
    closed: Array
    depth: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Graphs(PlacedFlanks):
    """Flanks of n pairs as graphs over the tangent at their common normal.

    x is along the tangent towards the driver's tip, y in the direction of the driver's force; both
    are 0 at the driver's point on the normal.

    Parameters
    ----------
    center : (2, n) array, rad
        Driver angles of the points on the normal.
    penetration : (n,) array, mm
        Penetration of the driver's flanks along the normal.
    curvature : (n,) array, 1/mm
        Relative curvature of the flanks there.
    """

    center: Array
    penetration: Array
    curvature: Array

    @property
    def rising(self) -> Array:
        """Driver angles, rad, of both flanks at their lower and upper end in x, (2, 2, n)."""
        # x rises towards the driver's tip, and so towards the driven wheel's root
        return np.stack([self.ends[0], self.ends[1, ::-1]])

    @property
    def places(self) -> Array:
        """Ends in x of the range common to both flanks, and its point nearest to 0: (3, n)."""
        x = [
            [self.at(wheel, end, unit=True)[0].real for end in ends]
            for wheel, ends in zip(WHEELS, self.rising, strict=True)
        ]
        low, high = np.max(x, axis=0)[0], np.min(x, axis=0)[1]
        return np.stack([low, np.clip(0.0, low, high), high])

    @cached_property
    def along(self) -> Array:
        """Derivatives of x by the driver angles at `center`, (2, n), mm/rad."""
        each = zip(WHEELS, self.center, strict=True)
        return np.stack([self.at(wheel, center)[1].real for wheel, center in each])

    def depth(self, x: Array) -> tuple[Array, Array, Array]:
        """Return the penetration of the driver's flanks at `x`, mm.

        With its derivative by x, and both driver angles, (2, n).
        """
        angles, y, slope = [], [], []
        rows = zip(WHEELS, self.center, self.along, self.rising, strict=True)
        for wheel, center, along, ends in rows:
            start = center + x / along
            angles.append(self.find(wheel, lambda p, d: (p.real, d.real), x, ends, start, _ANGLE))
            point, direction = self.at(wheel, angles[-1], unit=True)
            y.append(self.pairs.side * point.imag)
            with np.errstate(divide="ignore", invalid="ignore"):  # a vertical tangent at an end
                slope.append(self.pairs.side * direction.imag / direction.real)
        return y[0] - y[1], slope[0] - slope[1], np.stack(angles)


def patches(
    pairs: FlankPairs, phi1: ArrayLike, overclosure: float, lead: ArrayLike = 0.0
) -> Patches:
    """Predict the contact patches of a side.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    overclosure : float, rad
        Angle by which the driver is ahead of them.
    lead : (n,) array or float, rad
        Angle by which the driven wheel is ahead of its nominal position; for a rack mm.

    Returns
    -------
    Patches
        Of the pairs that overlap.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    graphs = _overlapping(pairs, phi1, overclosure, np.broadcast_to(lead, phi1.shape))
    # past a cusp the largest depth is not at the normal but at an end
    places = graphs.places
    values = np.stack([graphs.depth(place)[0] for place in places])
    real = np.flatnonzero((places[0] < places[2]) & (values.max(axis=0) > 0.0))
    graphs, places, values = graphs.select(real), places[:, real], values[:, real]
    deepest = values.max(axis=0)
    best = np.where(values[1] >= deepest, 1, values.argmax(axis=0))
    top, convex = places[best, np.arange(real.size)], graphs.curvature > 0.0
    half = np.sqrt(2.0 * graphs.penetration / np.where(convex, graphs.curvature, np.inf))
    cut = values[[0, 2]] > 0.0
    lower = _end(graphs, top, places[0], cut[0], -half)
    upper = _end(graphs, top, places[2], cut[1], half)
    one, two = np.stack([lower, upper], axis=1)
    clipped = cut.any(axis=0)
    unlike = clipped | _uneven(pairs, one) | ~convex
    return Patches(
        step=graphs.step,
        pair=graphs.pair,
        area=np.maximum(_below(graphs, 1, one) - _below(graphs, 2, two), 0.0),
        closed=np.where(unlike, np.nan, closed_area(graphs.penetration, graphs.curvature)),
        depth=np.where((best == 1) & ~clipped, graphs.penetration, deepest),
    )


def _overlapping(pairs: FlankPairs, phi1: Array, overclosure: float, lead: Array) -> Graphs:
    """Return the common normals of pairs, and the pairs that overlap along them."""
    side, guide, ahead = pairs.side, pairs.guide, phi1 + overclosure
    moved, motion = guide.nominal(phi1) + lead, guide.motion(ahead)
    nominal = FlankPositions(ahead, phi1, phi1, moved - motion[0])
    step, pair, limits = sought(pairs, phi1, nominal)
    positions, motion, ahead, moved = nominal.take(step), motion[:, step], ahead[step], moved[step]
    center, at = _shared(pairs, positions, pairs.separation(pair), motion, limits)
    first, second = at.frames
    one, two = (wheel.toothing for wheel in pairs.wheels)
    sf = [wheel.place(pair) for wheel in pairs.wheels]
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature = first.kappa / one.regularity(first, sf[0], side)
        curvature = curvature + second.kappa / two.regularity(second, sf[1], -side)
    turn = np.stack([np.exp(-1j * ahead), guide.pose(moved).rotation])
    origin = at.foot[0] + one.ahead(first, sf[0]) * at.normal[0]
    foot = np.stack([f.p + w.eccentric for f, w in zip(at.frames, pairs.wheels, strict=True)])
    offset = at.foot - foot * turn - origin
    # the tangent towards the driver's tip is the x-axis
    level = 1j * np.conj(at.normal[0])
    every = Graphs(
        pairs=pairs,
        step=step,
        pair=pair,
        turn=turn * level,
        offset=offset * level,
        center=center,
        penetration=-side * at.equations[1],
        curvature=curvature,
    )
    missed = np.abs(at.equations[0]) + np.abs(at.equations[2]) / pairs.pitch
    overlap = (every.penetration > 0.0) & (missed < _MISS)
    return every.select(outermost(step, pair, every.penetration, overlap))


def _shared(
    pairs: FlankPairs,
    positions: FlankPositions,
    separation: Array,
    motion: Array,
    limits: tuple[Array, Array] | None,
) -> tuple[Array, Normals]:
    """Return the rolls at which two flanks have a common normal, at any distance along it.

    As driver angles, rad, (2, n), with the normal. `motion` is `Guide.motion` at the phases,
    `limits` bound the rolls.
    """
    # the third unknown is the distance along the normal
    none = np.zeros_like(separation)
    by_distance = np.stack([none, none - 1.0, none])

    def evaluate(x: Array, some: Ints) -> tuple[Normals, Array, Array]:
        placed = positions.take(some)._replace(one=x[0], two=x[1])
        at = normals(pairs, placed, separation[some], motion[:, some])
        by = by_distance[:, some]
        slopes = np.stack([at.slopes[:, 1], at.slopes[:, 2], by], axis=1)
        return at, at.equations + x[2] * by, slopes

    scale = pairs.wheels[0].toothing.frames(positions.one, curved=False).speed / pairs.pitch
    x = np.stack([positions.one, positions.two, none])
    x, at = damped_newton(evaluate, x, scale, _SMALL, limits)
    return x[:2], at


def _end(graphs: Graphs, top: Array, limit: Array, cut: Mask, guess: Array) -> Array:
    """Return the ends in x of patches between their deepest point and a limit; `cut` at the limit.

    As driver angles on both flanks, (2, n).
    """
    x, at = limit.copy(), np.flatnonzero(~cut)
    some = graphs.select(at)

    def depth(place: Array) -> tuple[Array, Array]:
        deep, slope, _ = some.depth(place)
        return -deep, -slope

    low, high = np.minimum(top, limit)[at], np.maximum(top, limit)[at]
    start = np.clip(guess[at], low, high)
    x[at] = newton_in_bracket(depth, top[at], limit[at], start, _CLOSE * graphs.pairs.pitch)
    return graphs.depth(x)[2]


def _below(graphs: Graphs, wheel: Wheel, angles: Array) -> Array:
    """Return integrals of flanks over x between driver angles, (2, n), rad: mm^2."""
    n, count = len(_NODES), angles.shape[1]
    many = graphs.select(np.repeat(np.arange(count), n))
    half = 0.5 * (angles[1] - angles[0])
    place = (angles[0][:, None] + half[:, None] * (1.0 + _NODES)).ravel()
    point, slope = many.at(wheel, place)
    return graphs.pairs.side * (point.imag * slope.real).reshape(count, n) @ _WEIGHTS * half


def _uneven(pairs: FlankPairs, angles: Array) -> Mask:
    """Return whether flanks between driver angles, (2, n), contain a knot of the law."""
    law, (start, end) = pairs.guide.law, np.sort(angles, axis=0)
    stretch, knots = pairs.track.knots_between(start, end)
    # a smooth law has knots only at the ends of its lobe
    smooth = law.lobes.closed and len(law.knots) == 2
    uneven = np.zeros(len(start), dtype=bool)
    uneven[stretch[knots > start[stretch]]] = not smooth
    return uneven
