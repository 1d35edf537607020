"""Spans over teeth: the places at which two flanks of a wheel have a common normal.

Flat jaws touch the sigma = -1 flank of the first tooth at the roll b, and the sigma = +1 flank of
the last at the roll a. Their reading is steady where both flanks have one normal: the chord of the
centrode from P(b) to P(a) stands under alpha at both ends,

    n = T(a)*(cos(alpha) + sin(alpha)*turn) = T(b)*(cos(alpha) - sin(alpha)*turn),

along the chord. That does not depend on the teeth, which give the reading ``W = chord +
cos(alpha)*(w_a + w_b)`` with the reach of both contacts. If the jaws rock by a small angle x it
changes by ``0.5*x^2*(sin(alpha)*(1/kappa_a + 1/kappa_b) - chord)``. Along arcs of circles every
place is one; elsewhere there are few: an ellipse has four, across its axes.

Depends on outline.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, NamedTuple

import numpy as np

from gearcam.gears.flank import Toothing
from gearcam.gears.outline import Outline
from gearcam.gears.pins import SIDES, flank_ends
from gearcam.gears.track import Frames
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import damped_newton

_CELLS: Final = 1024
"""Cells of a centrode in the search, beside those that its knots divide."""

_SLACK: Final = 1.5
"""Factor on how far the conditions may change within a cell."""

_SMALL: Final = 1e-11
"""Length of the last step of a search for a root, over twice its cell."""

_NEAR: Final = 4.0
"""Distance from the middle of its cell at which a root is of another one, in cells."""

_EXACT: Final = 1e-10
"""Largest error of a root, rad, and of lengths over that of the centrode."""

_APART: Final = 1e-7
"""Distance of two places, over the length of the centrode, from which they are two."""

_STEADY: Final = 1e-5
"""Change by rocking, mm/rad^2 over the length of the centrode, below which a place belongs to an
arc; above the inverse it is where an arc joins a straight stretch."""

_MORE: Final = np.arange(-6, 7)
"""Teeth more than those that are touched at the middle of their flanks: all possible ones."""

_TOUCH: Final = 1e-9
"""Share of a reading by which the ends of flanks may reach beyond the jaws: rounding."""

_ROUND: Final = 1e-9
"""Relative change of the curvature from cell to cell on an arc of a circle: rounding."""


class Spans(NamedTuple):
    """Steady readings of flat jaws over teeth, (n,) arrays; of each place the best teeth first.

    Parameters
    ----------
    first, last : int arrays
        Numbers of the teeth whose flanks are touched.
    teeth : int array
        How many teeth are between the jaws.
    reading : array, mm
        The distance of the jaws.
    contact : (2, n) complex array, mm
        Points of contact of the first and the last tooth.
    rocked : array, mm/rad^2
        Change of the reading by the square of a small angle by which the jaws rock: it is least
        where this is positive, largest where negative.
    off : array
        Distance of the contacts from the middle of their flanks, 0 to 1.
    place : int array
        Number of the place on the centrode; of arcs of circles -1, -2 and so on.
    """

    first: Ints
    last: Ints
    teeth: Ints
    reading: Array
    contact: Plane
    rocked: Array
    off: Array
    place: Ints


def find_spans(outline: Outline) -> Spans:
    """Return the steady readings over two or more teeth of a wheel; of racks and rings none.

    Parameters
    ----------
    outline : Outline
        The teeth as made.
    """
    toothing = outline.toothing
    z, flanks = len(toothing.numbers), outline.flanks
    whole = np.arange(z)[toothing.whole]
    on_arcs, rolls, places = np.empty((3, 0), dtype=np.int64), np.empty((2, 0)), np.empty((2, 0))
    if not (toothing.track.slides or toothing.track.ring):
        cells = _Cells.of(toothing)
        places = _isolated(toothing, cells)
        on_arcs, rolls = _on_arcs(outline, cells, whole)
    touched = []
    for at, side, roll in ((z + whole, -1.0, places[1]), (whole, 1.0, places[0])):
        reach = side * _within(toothing, flanks.sf[at, None] - roll)
        touched.append((flanks.lowest[at, None] <= reach) & (reach <= flanks.highest[at, None]))
    first, last, place = np.nonzero(touched[0][:, None] & touched[1])
    found = np.append(np.stack([whole[first], whole[last], place]), on_arcs, axis=1)
    return _spans(outline, found, np.append(places[:, place], rolls, axis=1))


def _on_arcs(outline: Outline, cells: _Cells, whole: Ints) -> tuple[Ints, Array]:
    """Return first and last teeth and places (3, n), rolls a and b (2, n), mm, of those on arcs."""
    toothing, flanks, z = outline.toothing, outline.flanks, len(outline.toothing.numbers)
    found: dict[tuple[int, int], tuple[float, ...]] = {}
    first = np.repeat(whole, len(_MORE))
    low, high, sf = (one[z + first] for one in (flanks.lowest, flanks.highest, flanks.sf))
    for arc, (start, stop, kappa) in enumerate(cells.arcs(toothing.cutter.alpha), start=1):
        between = 2.0 * toothing.cutter.alpha / kappa
        # of whole pitches, so many that both contacts are near the middle of their flanks
        steps = np.rint((low + high - 2.0 * toothing.half_tooth + between) / toothing.pitch)
        steps += np.tile(_MORE, len(whole))
        reach = 0.5 * (steps * toothing.pitch - between) + toothing.half_tooth
        last, b = first + steps.astype(np.int64), sf + reach
        if toothing.closed:
            last, b = last % z, start + (b - start) % toothing.length
        there = (steps > 0.0) & (steps < len(whole)) & np.isin(last, whole)
        there &= (start <= b) & (b + between <= stop) & (low <= reach) & (reach <= high)
        far = last[there]
        there[there] = (flanks.lowest[far] <= reach[there]) & (reach[there] <= flanks.highest[far])
        rows = zip(first[there].tolist(), last[there].tolist(), b[there].tolist(), strict=True)
        found |= {(one, other): (-arc, roll + between, roll) for one, other, roll in rows}
    table = np.array([(*teeth, *rest) for teeth, rest in found.items()]).reshape(-1, 5).T
    return table[:3].astype(np.int64), table[3:]


def _spans(outline: Outline, found: Ints, rolls: Array) -> Spans:
    """Return the readings at common normals of convex flanks over two teeth or more."""
    first, last, place = found
    toothing, flanks, z = outline.toothing, outline.flanks, len(outline.toothing.numbers)
    cosine = math.cos(toothing.cutter.alpha)
    frames = toothing.frames(toothing.track.angle(rolls))
    flank = np.stack([last, z + first])
    reach = SIDES * _within(toothing, flanks.sf[flank] - rolls)
    contact = toothing.flank_points(frames, rolls + SIDES * reach, SIDES)
    normal = toothing.normals(frames, SIDES)[0]
    chord = np.abs(frames.p[0] - frames.p[1])
    reading = chord + cosine * reach.sum(axis=0)
    rocked = np.where(place < 0, 0.0, _rocked(toothing, rolls))
    low, high = flank_ends(outline)
    under, over = np.abs(contact - low[flank]), np.abs(contact - high[flank])
    off = np.abs((under - over) / (under + over)).max(axis=0)
    teeth = (last - first) % z + 1
    kept = (teeth > 1) & (frames.kappa > 0.0).all(axis=0)
    for end in (low[flank], high[flank]):  # a flank that turns concave farther on lifts the jaw
        beyond = SIDES * (np.conj(normal) * (end - contact)).real
        kept &= (beyond <= _TOUCH * reading).all(axis=0)
    order = np.flatnonzero(kept)
    order = order[np.lexsort((first[order], off[order].round(9), place[order]))]
    first, last = np.array(toothing.numbers)[found[:2]]
    values: tuple[Any, ...] = (first, last, teeth, reading, contact, rocked, off, place)
    return Spans(*(one[..., order] for one in values))


class _Cells(NamedTuple):
    """Stretches of a centrode over one turn, of a closed wheel over two.

    Parameters
    ----------
    ends : (n + 1,) array, mm
        Arc lengths at their ends.
    middle : Frames
        Frames at their middles, (n,).
    turned : (n,) array, rad
        Directions of the tangents there, rising where convex.
    turning : (n,) array, rad
        Change of these within a cell.
    arc : (n,) int array
        Numbers of stretches of constant curvature.
    once : int
        Number of cells in a turn.
    """

    ends: Array
    middle: Frames
    turned: Array
    turning: Array
    arc: Ints
    once: int

    def arcs(self, alpha: float) -> Iterator[tuple[float, float, float]]:
        """Yield start and end, mm, and curvature of arcs that are long enough for jaws."""
        first = np.searchsorted(self.arc, np.arange(self.arc[self.once - 1] + 1))
        last = np.searchsorted(self.arc, np.arange(len(first)), side="right")
        start, stop, kappa = self.ends[first], self.ends[last], self.middle.kappa[first]
        for arc in np.flatnonzero(kappa * (stop - start) >= 2.0 * alpha):
            yield float(start[arc]), float(stop[arc]), float(kappa[arc])

    @classmethod
    def of(cls, toothing: Toothing) -> _Cells:
        """Return the cells of a `toothing`."""
        track = toothing.track.exact
        ends = track.angle(np.array([0.0, toothing.length]))
        knots = track.knots_between(ends[:1], ends[1:])[1]
        phi = np.sort(np.append(np.linspace(ends[0], ends[1], _CELLS + 1), knots))
        once = len(phi) - 1
        if toothing.closed:
            phi = np.append(phi, phi[1:] + track.around)
        middle = track.frames(0.5 * (phi[1:] + phi[:-1]))
        tangents = track.frames(phi, curved=False).t
        steps = -toothing.turn.imag * np.angle(middle.t[1:] / middle.t[:-1])
        change = np.abs(np.diff(middle.kappa)) > _ROUND * np.abs(middle.kappa).max()
        return cls(
            track.arc_length(phi),
            middle,
            np.append(0.0, np.cumsum(steps)),
            np.abs(np.angle(tangents[1:] / tangents[:-1])),
            np.append(0, np.cumsum(change)),
            once,
        )


def _within(toothing: Toothing, distance: Array) -> Array:
    """Return distances along a closed centrode by the shorter way."""
    turn, half = toothing.length, 0.5 * toothing.length
    return (distance + half) % turn - half if toothing.closed else distance


def _isolated(toothing: Toothing, cells: _Cells) -> Array:
    """Return the rolls a and b, mm, of all places that are not on one arc of a circle, (2, n)."""
    alpha, length = toothing.cutter.alpha, toothing.length
    place, middle, once = cells.middle.p, cells.middle, cells.once
    normal = middle.t * (math.cos(alpha) - math.sin(alpha) * toothing.turn)
    size = np.diff(cells.ends)
    i, j = np.nonzero(
        np.abs(cells.turned[:, None] - cells.turned[:once] - 2.0 * alpha)
        <= 0.5 * _SLACK * (cells.turning[:, None] + cells.turning[:once])
    )
    apart, chord = middle.s[i] - middle.s[j], place[i] - place[j]
    limit = 0.5 * _SLACK * (size[i] + size[j] + np.abs(chord) * cells.turning[j])
    near = np.abs((np.conj(normal[j]) * chord).imag) <= limit
    near &= (apart > 0.0) & (apart < (0.5 if toothing.closed else 1.0) * length)
    near &= cells.arc[i] != cells.arc[j]
    pairs = np.stack([i, j])[:, near]
    rolls, exact = _common_normals(toothing, middle.s[pairs], size[pairs])
    rolls = rolls[:, exact & (np.abs(rolls - middle.s[pairs]) <= _NEAR * size[pairs]).all(axis=0)]
    close = _APART * length
    if any(cells.arcs(alpha)):  # where an arc ends smoothly, conditions nearly hold beyond it too
        rocked = np.abs(_rocked(toothing, rolls)) / length
        rolls = rolls[:, (rocked > _STEADY) & (rocked < 1.0 / _STEADY)]
    if toothing.closed:
        rolls -= (rolls[1] + close) // length * length
    rolls = rolls[:, np.lexsort(rolls)]
    new = (np.abs(np.diff(rolls, prepend=np.inf)) > close).any(axis=0)
    return rolls[:, new]


def _rocked(toothing: Toothing, rolls: Array) -> Array:
    """Return by how much readings change, by the square of the angle of the jaws, mm/rad^2."""
    frames = toothing.frames(toothing.track.angle(rolls))
    with np.errstate(divide="ignore"):
        sizes = math.sin(toothing.cutter.alpha) * (1.0 / frames.kappa).sum(axis=0)
    return 0.5 * (sizes - np.abs(frames.p[0] - frames.p[1]))


def _common_normals(toothing: Toothing, rolls: Array, cells: Array) -> tuple[Array, Mask]:
    """Return rolls (2, n), mm, of common normals in `cells` of a size, and whether they are exact.

    The third unknown is the chord.
    """
    track, alpha, sense = toothing.track.exact, toothing.cutter.alpha, -toothing.turn.imag
    lean = math.sin(alpha) * toothing.turn

    def conditions(x: Array, _: Ints) -> tuple[Mask, Array, Array]:
        frames = track.frames(track.angle(x[:2]))
        normal = frames.t[1] * (math.cos(alpha) - lean)
        angle = sense * np.angle(frames.t[0] * (math.cos(alpha) + lean) / normal)
        chord = np.conj(normal) * (frames.p[0] - frames.p[1])
        # by the rolls a and b
        slopes = np.conj(normal) * frames.t * SIDES
        slopes[1] -= 1j * sense * frames.kappa[1] * chord
        by_rolls = np.stack([slopes.real, slopes.imag, frames.kappa * SIDES])
        exact = (np.abs(angle) <= _EXACT) & (np.abs(chord.imag) <= _EXACT * toothing.length)
        matrix = np.pad(by_rolls, ((0, 0), (0, 1), (0, 0)))
        matrix[0, 2] = -1.0  # by the chord
        misses = np.stack([chord.real - x[2], chord.imag, angle])
        return exact & (chord.real > 0.0), misses, matrix

    start = np.append(rolls, np.zeros_like(rolls[:1]), axis=0)
    found, exact = damped_newton(conditions, start, 0.5 / cells.max(axis=0), _SMALL)
    return found[:2], exact
