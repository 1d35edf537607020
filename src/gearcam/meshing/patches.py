"""Contact patches: the overlap that the exact flanks predict on each pair as the driver is ahead.

Where the driver's flank stands deeper in its mate than their common normal is long, both are graphs
over their common tangent, and the area between them is the difference of two integrals, over the
stretch on which the driver's is above. That holds also where an end of a flank or a knot of the law
clips the patch; only what lies beyond the end of a flank, on a fillet or a tip, is left out. Inside
smooth flanks the patch has the closed form ``(4/3)*delta*sqrt(2*delta/kr)`` with the penetration
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
"""Step, in pitches, at which the search for a common normal ends."""

_MISS = 1e-9
"""What two normals may miss of being one, in rad and pitches."""

_CLOSE = 1e-6
"""Place, in pitches, to which ends of patches are found: the depth there is next to nothing."""

_ANGLE = 1e-8
"""Step of Newton's method, rad, after which the next would be below rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Patches:
    """Predicted contact patches, one entry each.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Number of the phase; j.
    area : (n,) array, mm^2
        By integrating the depth.
    closed : (n,) array, mm^2
        By the closed form; nan where the patch is clipped, holds a knot or lies near a cusp.
    depth : (n,) array, mm
        Largest penetration, along the normal.
    """

    step: Ints
    pair: Ints
    area: Array
    closed: Array
    depth: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Graphs:
    """Flanks of n pairs as graphs over the tangent at the normal that they share.

    x rises along the tangent to the driver's tip, y in the direction in which the driver presses;
    both are 0 at the driver's point on the normal.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    pair : (n,) int array
        j.
    turn, offset : (2, n) complex arrays, 1 and mm
        What turns the points of both wheels, and what is added to them then.
    center : (2, n) array, rad
        Driver angles of the points on the normal.
    """

    pairs: FlankPairs
    pair: Ints
    turn: Plane
    offset: Plane
    center: Array

    def select(self, index: Ints | Mask) -> Graphs:
        """Return some of the pairs, by `index`."""
        return Graphs(
            pairs=self.pairs,
            pair=self.pair[index],
            turn=self.turn[:, index],
            offset=self.offset[:, index],
            center=self.center[:, index],
        )

    @cached_property
    def sf(self) -> Array:
        """Place sf of both flanks, (2, n), mm."""
        return np.stack([self.pairs.place(wheel, self.pair) for wheel in WHEELS])

    @cached_property
    def ends(self) -> Array:
        """Driver angles, rad, of both flanks at their lower and upper end in x, (2, 2, n)."""
        # x rises to the driver's tip, and so to the driven wheel's root
        (root, tip), (low, high) = (self.pairs.reach(wheel, self.pair) for wheel in WHEELS)
        reach = np.array([[root, tip], [-high, -low]])
        return self.pairs.track.angle(self.sf[:, None] - self.pairs.side * reach)

    @property
    def places(self) -> Array:
        """Ends in x of what both flanks share, and the place between nearest to 0: (3, n)."""
        low, high = np.stack(
            [[self.at(wheel, end)[0] for end in self.ends[wheel - 1]] for wheel in WHEELS], axis=1
        )
        low, high = low.max(axis=0), high.min(axis=0)
        return np.stack([low, np.clip(0.0, low, high), high])

    def at(self, wheel: Wheel, angle: Array) -> tuple[Array, Array, Array]:
        """Return x and y, mm, of a `wheel`'s flanks at driver angles, rad, and dx/dangle."""
        toothing, turn = self.pairs.toothings[wheel - 1], self.turn[wheel - 1]
        sigma, sf, frames = self.pairs.sigma(wheel), self.sf[wheel - 1], toothing.frames(angle)
        seen = toothing.flank_points(frames, sf, sigma) * turn + self.offset[wheel - 1]
        slope = np.real(toothing.flank_motion(frames, sf, sigma) * turn)
        return seen.real, self.pairs.side * seen.imag, slope

    def slope(self, wheel: Wheel, angle: Array) -> Array:
        """Return dy/dx of a `wheel`'s flanks at driver angles `angle`, rad."""
        toothing = self.pairs.toothings[wheel - 1]
        frames = toothing.frames(angle, curved=False)
        normals = toothing.normals(frames, self.pairs.sigma(wheel)) * self.turn[wheel - 1]
        return -self.pairs.side * normals.real / normals.imag

    def find(self, wheel: Wheel, x: Array) -> Array:
        """Return the driver angles, rad, at which a `wheel`'s flanks have an `x`; no end passed."""

        def miss(angle: Array) -> tuple[Array, Array]:
            value, _, slope = self.at(wheel, angle)
            return value - x, slope

        center, ends = self.center[wheel - 1], self.ends[wheel - 1]
        start = np.clip(center + x / self.at(wheel, center)[2], ends.min(axis=0), ends.max(axis=0))
        return newton_in_bracket(miss, ends[0], ends[1], start, _ANGLE)

    def depth(self, x: Array) -> tuple[Array, Array, Array]:
        """Return how deep the driver's flanks stand at `x`, mm, and both driver angles, rad."""
        one, two = (self.find(wheel, x) for wheel in WHEELS)
        return self.at(1, one)[1] - self.at(2, two)[1], one, two


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
        How far the driver is ahead of them.
    lead : (n,) array or float, rad
        How far the driven wheel is ahead of its nominal place; of a rack mm.

    Returns
    -------
    Patches
        Only of pairs that overlap.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    step, pair = pairs.beside(phi1)
    lead = np.broadcast_to(lead, phi1.shape)[step]
    some, deep, bend, graphs = _overlapping(pairs, pair, phi1[step], overclosure, lead)
    # past a cusp the normal is not where the flanks are deepest: that is at an end then
    places = graphs.places
    values = np.stack([graphs.depth(place)[0] for place in places])
    best = np.where(values[1] >= values.max(axis=0), 1, values.argmax(axis=0))
    real = np.flatnonzero((places[0] < places[2]) & (values.max(axis=0) > 0.0))
    graphs, some, best, deep, bend = (
        graphs.select(real), some[real], best[real], deep[real], bend[real]
    )  # fmt: skip
    places, values = places[:, real], values[:, real]
    rows = np.arange(real.size)
    top, value = places[best, rows], values[best, rows]
    half = np.sqrt(2.0 * deep / np.where(bend > 0.0, bend, np.inf))
    cut = values[[0, 2]] > 0.0
    lower = _end(graphs, top, places[0], cut[0], -half)
    upper = _end(graphs, top, places[2], cut[1], half)
    one, two = np.stack([lower, upper], axis=1)
    clipped = cut.any(axis=0)
    unlike = clipped | _uneven(pairs, one) | ~(bend > 0.0)
    return Patches(
        step=step[some],
        pair=pair[some],
        area=np.maximum(_below(graphs, 1, one) - _below(graphs, 2, two), 0.0),
        closed=np.where(unlike, np.nan, (4.0 / 3.0) * deep * half),
        depth=np.where((best == 1) & ~clipped, deep, value),
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
    turn = np.stack([np.exp(-1j * ahead), pairs.guide.stand(ahead, lead)[0]])
    origin = at.foot[0] + one.ahead(first, sf[0]) * at.normal[0]
    offset = at.foot - np.stack([first.p, second.p]) * turn - origin
    # the tangent towards the driver's tip becomes the x-axis
    level = 1j * np.conj(at.normal[0])
    graphs = Graphs(
        pairs=pairs,
        pair=pair,
        turn=turn * level,
        offset=offset * level,
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


def _end(graphs: Graphs, top: Array, limit: Array, cut: Mask, guess: Array) -> Array:
    """Find where patches end between their deepest place and a limit, in x; `cut` at the limit.

    Returns the driver angles on both flanks, (2, n).
    """
    x, at = limit.copy(), np.flatnonzero(~cut)
    some = graphs.select(at)

    def depth(place: Array) -> tuple[Array, Array]:
        deep, first, second = some.depth(place)
        return -deep, some.slope(2, second) - some.slope(1, first)

    low, high = np.minimum(top, limit)[at], np.maximum(top, limit)[at]
    start = np.clip(guess[at], low, high)
    x[at] = newton_in_bracket(depth, top[at], limit[at], start, _CLOSE * graphs.pairs.pitch)
    return np.stack(graphs.depth(x)[1:])


def _below(graphs: Graphs, wheel: Wheel, angles: Array) -> Array:
    """Integrate flanks over x between driver angles, (2, n), rad: mm^2."""
    n, count = len(_NODES), angles.shape[1]
    many = graphs.select(np.repeat(np.arange(count), n))
    half = 0.5 * (angles[1] - angles[0])
    place = (angles[0][:, None] + half[:, None] * (1.0 + _NODES)).ravel()
    _, y, slope = many.at(wheel, place)
    return (y * slope).reshape(count, n) @ _WEIGHTS * half


def _uneven(pairs: FlankPairs, angles: Array) -> Mask:
    """Whether stretches of flank between driver angles, (2, n), hold a knot of the law."""
    law, (start, end) = pairs.guide.law, np.sort(angles, axis=0)[..., None]
    knots = pairs.track.knots_near(0.5 * (start + end)[:, 0])
    # a smooth law has no knots but the ends of its lobe
    smooth = law.lobes.closed and len(law.knots) == 2
    return np.any((knots > start) & (knots < end), axis=1) & (not smooth)
