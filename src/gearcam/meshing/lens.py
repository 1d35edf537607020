"""The overlap that the exact flanks predict for a driver turned ahead: a lens on each pair.

Where the driver's flank stands deeper in its mate than their common normal is long, both are graphs
over their common tangent, and the area between them is the difference of two integrals, over the
stretch on which the driver's is above. That holds also where an end of a flank or a knot of the law
clips the lens; only what lies beyond the end of a flank, on a fillet or a tip, is left out. Inside
smooth flanks the lens has the closed form ``(4/3)*delta*sqrt(2*delta/kr)`` with the penetration
delta and the relative curvature kr.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.contact import FlankPairs
from gearcam.gears.normals import Normals, Pose, normals
from gearcam.gears.track import WHEELS, Wheel
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.newton import damped_newton
from gearcam.numeric.roots import newton_in_bracket

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)

_SMALL = 1e-9
"""Step, in pitches, at which they end."""

_MISS = 1e-9
"""What they may miss of being one, in rad and pitches."""

_CLOSE = 1e-6
"""The same of the ends of lenses, in pitches."""

_ANGLE = 1e-8
"""Step of Newton's method, rad, after which the next would be below rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Lenses:
    """Predicted overlaps, one entry each.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Ints of the phase; j.
    area : (n,) array, mm^2
        By integrating the gap.
    closed : (n,) array, mm^2
        By the closed form; nan where the lens is clipped, holds a knot or lies near a cusp.
    depth : (n,) array, mm
        Largest penetration, along the normal.
    radius : (2, n) array, mm
        Distances of the lens's ends from the driver's axis: towards its root, towards its tip.
    edge : (n,) bool array
        Whether an end of a flank lies inside the lens.
    """

    step: Ints
    pair: Ints
    area: Array
    closed: Array
    depth: Array
    radius: Array
    edge: Mask


@dataclass(frozen=True, eq=False, kw_only=True)
class Graphs:
    """Flanks of n pairs as graphs over the tangent at the normal that they share.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    pair : (n,) int array
        j.
    turned : (2, n) complex array
        What turns the points of both wheels.
    shift : (2, n) complex array, mm
        What is added to them then; zero is the driver's point on the normal.
    along : (n,) complex array
        Unit tangent, towards the driver's tip; the driver presses along ``side*1j*along``.
    center : (2, n) array, rad
        Driver angles of the points on the normal.
    """

    pairs: FlankPairs
    pair: Ints
    turned: Plane
    shift: Plane
    along: Plane
    center: Array

    def select(self, index: Ints | Mask) -> Graphs:
        """Return some of the pairs, by `index`."""
        return Graphs(
            pairs=self.pairs,
            pair=self.pair[index],
            turned=self.turned[:, index],
            shift=self.shift[:, index],
            along=self.along[index],
            center=self.center[:, index],
        )

    @cached_property
    def sf(self) -> Array:
        """Place sf of both flanks, (2, n), mm."""
        return np.stack([self.pairs.place(wheel, self.pair) for wheel in WHEELS])

    def places(self, ends: tuple[Array, Array]) -> Array:
        """Return x at the `ends` of what both flanks share, and between, nearest to 0: (3, n)."""
        one, two = (
            np.stack([self.at(wheel, angle)[0] for angle in angles])
            for wheel, angles in zip(WHEELS, ends, strict=True)
        )
        low, high = np.maximum(one[0], two[0]), np.minimum(one[1], two[1])
        return np.stack([low, np.clip(0.0, low, high), high])

    def ends(self, wheel: Wheel) -> Array:
        """Return the driver angles, rad, of a `wheel`'s flanks at the lower and upper end in x."""
        low, high = self.pairs.reach(wheel, self.pair)
        sf = self.sf[wheel - 1]
        # x rises to the driver's tip, and so to the driven wheel's root
        reach = np.stack([low, high] if wheel == 1 else [high, low])
        return self.pairs.toothings[0].track.angle(sf - self.pairs.sigma(wheel) * reach)

    def at(self, wheel: Wheel, angle: Array) -> tuple[Array, Array, Array]:
        """Return x and y, mm, of a `wheel`'s flanks at driver angles, rad, and dx/dangle."""
        toothing = self.pairs.toothings[wheel - 1]
        sigma = self.pairs.sigma(wheel)
        frames, sf = toothing.frames(angle), self.sf[wheel - 1]
        turned = self.turned[wheel - 1] * np.conj(self.along)
        shift = self.shift[wheel - 1] * np.conj(self.along)
        seen = toothing.flank_points(frames, sf, sigma) * turned + shift
        slope = np.real(toothing.flank_motion(frames, sf, sigma) * turned)
        return seen.real, self.pairs.side * seen.imag, slope

    def slope(self, wheel: Wheel, angle: Array) -> Array:
        """Return dy/dx of a `wheel`'s flanks at driver angles `angle`, rad."""
        toothing = self.pairs.toothings[wheel - 1]
        frames = toothing.frames(angle, curved=False)
        normals = toothing.normals(frames, self.pairs.sigma(wheel)) * self.turned[wheel - 1]
        direction = -1j * normals * np.conj(self.along)
        return self.pairs.side * direction.imag / direction.real

    def find(self, wheel: Wheel, x: Array, ends: Array) -> Array:
        """Return the driver angles, rad, at which a `wheel`'s flanks have an `x`, within `ends`."""

        def miss(angle: Array) -> tuple[Array, Array]:
            value, _, slope = self.at(wheel, angle)
            return value - x, slope

        start = self.center[wheel - 1] + x / self._rise[wheel - 1]
        start = np.clip(start, ends.min(axis=0), ends.max(axis=0))
        return newton_in_bracket(miss, ends[0], ends[1], start, _ANGLE)

    @cached_property
    def _rise(self) -> tuple[Array, Array]:
        """dx/dangle of both flanks at the normal."""
        return self.at(1, self.center[0])[2], self.at(2, self.center[1])[2]

    def depth(self, x: Array, ends: tuple[Array, Array]) -> tuple[Array, Array, Array]:
        """Return how deep the driver's flanks stand at `x`, mm, and both angles within `ends`."""
        one, two = (self.find(wheel, x, ends[wheel - 1]) for wheel in WHEELS)
        return self.at(1, one)[1] - self.at(2, two)[1], one, two


def lenses(pairs: FlankPairs, phi1: ArrayLike, overclosure: float, lead: ArrayLike = 0.0) -> Lenses:
    """Predict the overlaps of a side.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    overclosure : float, rad
        How far the driver is ahead of them.
    lead : (n,) array or float, rad
        How far the driven wheel is ahead of its nominal place; of a rack mm.

    Returns
    -------
    Lenses
        Only pairs that overlap.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    step, pair = pairs.beside(phi1)
    lead = np.broadcast_to(lead, phi1.shape)[step]
    some, deep, bend, graphs = _overlapping(pairs, pair, phi1[step], overclosure, lead)
    ends = graphs.ends(1), graphs.ends(2)
    places = graphs.places(ends)
    # past a cusp the normal is not where the flanks are deepest: that is at an end then
    values = np.stack([graphs.depth(place, ends)[0] for place in places])
    best = np.where(values[1] >= values.max(axis=0), 1, values.argmax(axis=0))
    real = np.flatnonzero((places[0] < places[2]) & (values.max(axis=0) > 0.0))
    graphs, ends = graphs.select(real), (ends[0][:, real], ends[1][:, real])
    step, pair, best = (numbers[real] for numbers in (step[some], pair[some], best))
    deep, bend, places, values = deep[real], bend[real], places[:, real], values[:, real]
    rows = np.arange(real.size)
    top, value = places[best, rows], values[best, rows]
    reach = np.sqrt(2.0 * deep / np.where(bend > 0.0, bend, np.inf))
    sides = [
        _end(graphs, ends, top, places[k], values[k] > 0.0, sign * reach)
        for k, sign in ((0, -1.0), (2, 1.0))
    ]
    edge = sides[0][2] | sides[1][2]
    one, two = (np.stack([side[0][k] for side in sides]) for k in (0, 1))
    closed = np.where(edge, np.nan, (4.0 / 3.0) * deep * reach)
    closed[_uneven(pairs, one[0], one[1]) | ~(bend > 0.0)] = np.nan
    axis = graphs.shift[0]
    radius = [
        np.abs((x + 1j * pairs.side * y) * graphs.along - axis)
        for x, y, _ in (graphs.at(1, angle) for angle in one)
    ]
    return Lenses(
        step=step,
        pair=pair,
        area=np.maximum(_below(graphs, 1, one) - _below(graphs, 2, two), 0.0),
        closed=closed,
        depth=np.where(best == 1, np.where(edge, value, deep), value),
        radius=np.stack(radius),
        edge=edge,
    )


def _overlapping(
    pairs: FlankPairs, pair: Ints, phi1: Array, overclosure: float, lead: Array
) -> tuple[Ints, Array, Array, Graphs]:
    """Find the normals that pairs share, and the pairs that overlap along them.

    Returns their places, penetrations, mm, relative curvatures, 1/mm, and graphs.
    """
    side, ahead = pairs.side, phi1 + overclosure
    lead = lead + pairs.guide.nominal(phi1) - pairs.guide.nominal(ahead)
    pose, at = _shared(pairs, Pose(ahead, phi1, phi1, lead), pairs.separation(pair))
    deep = -side * at.equations[1]
    missed = np.abs(at.equations[0]) + np.abs(at.equations[2]) / pairs.pitch
    some = np.flatnonzero((deep > 0.0) & (missed < _MISS))
    first, second = at.frames
    one, two = pairs.toothings
    sf = [pairs.place(wheel, pair) for wheel in WHEELS]
    with np.errstate(divide="ignore", invalid="ignore"):
        bend = first.kappa / one.regularity(first, sf[0], side)
        bend = bend + second.kappa / two.regularity(second, sf[1], -side)
    turned = np.stack([np.exp(-1j * ahead), pairs.guide.stand(ahead, lead)[0]])
    origin = at.foot[0] + one.ahead(first, sf[0]) * at.normal[0]
    graphs = Graphs(
        pairs=pairs,
        pair=pair,
        turned=turned,
        shift=at.foot - np.stack([first.p, second.p]) * turned - origin,
        along=-1j * at.normal[0],
        center=np.stack([pose.one, pose.two]),
    )
    return some, deep[some], bend[some], graphs.select(some)


def _shared(pairs: FlankPairs, pose: Pose, separation: Array) -> tuple[Pose, Normals]:
    """Find the rolls at which two flanks of a given pose have one normal, at any distance."""
    # the third unknown is the distance along it
    none = np.zeros_like(separation)
    by_distance = np.stack([none, none - 1.0, none])

    def evaluate(x: Array) -> tuple[Normals, Array, Array]:
        at = normals(pairs, pose._replace(one=x[0], two=x[1]), separation)
        slopes = np.stack([at.slopes[:, 1], at.slopes[:, 2], by_distance], axis=1)
        return at, at.equations + x[2] * by_distance, slopes

    scale = pairs.toothings[0].frames(pose.one, curved=False).speed / pairs.pitch
    x = np.stack([pose.one, pose.two, np.zeros_like(separation)])
    x, at = damped_newton(evaluate, x, scale, _SMALL)
    return pose._replace(one=x[0], two=x[1]), at


def _end(
    graphs: Graphs, ends: tuple[Array, Array], top: Array, limit: Array, cut: Mask, guess: Array
) -> tuple[tuple[Array, Array], Array, Mask]:
    """Find where lenses end between their deepest place and a limit, in x; `cut` at the limit.

    Returns the driver angles on both flanks, x, and whether the limit cuts the lens off.
    """
    x = limit.copy()
    at = np.flatnonzero(~cut)
    some, inner = graphs.select(at), (ends[0][:, at], ends[1][:, at])

    def depth(place: Array) -> tuple[Array, Array]:
        deep, first, second = some.depth(place, inner)
        return -deep, some.slope(2, second) - some.slope(1, first)

    low, high = np.minimum(top, limit)[at], np.maximum(top, limit)[at]
    start = np.clip(guess[at], low, high)
    x[at] = newton_in_bracket(depth, top[at], limit[at], start, _CLOSE * graphs.pairs.pitch)
    _, one, two = graphs.depth(x, ends)
    return (one, two), x, cut


def _below(graphs: Graphs, wheel: Wheel, angles: Array) -> Array:
    """Integrate flanks over x between driver angles, (2, n), rad: mm^2."""
    n, count = len(_NODES), angles.shape[1]
    many = graphs.select(np.repeat(np.arange(count), n))
    half = 0.5 * (angles[1] - angles[0])
    place = (angles[0][:, None] + half[:, None] * (1.0 + _NODES)).ravel()
    _, y, slope = many.at(wheel, place)
    return (y * slope).reshape(count, n) @ _WEIGHTS * half


def _uneven(pairs: FlankPairs, low: Array, high: Array) -> Mask:
    """Whether stretches of flank, by driver angle, hold a knot of the law."""
    arc, knots = pairs.track.arc, pairs.guide.law.knots
    start, end = np.minimum(low, high), np.maximum(low, high)
    if not arc.periodic:
        inside = (knots > start[:, None]) & (knots < end[:, None])
        return np.any(inside, axis=1)
    # a smooth law has no knots but the ends of its lobe
    knots = knots[:-1] if len(knots) > 2 else knots[:0]
    first = np.floor((start[:, None] - knots) / arc.period)
    return np.any(np.floor((end[:, None] - knots) / arc.period) > first, axis=1)
