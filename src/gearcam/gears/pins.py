"""Measures over pins or balls, and chords of teeth, of a finished outline.

A *pin* lies in a space and touches the flanks of both teeth beside it; a ball touches them at the
same points. The parallel of a flank at a distance rho is the flank of ``sf +
sigma*rho/cos(alpha)`` (see `gearcam.gears.flank`), so the centre of a pin of radius rho is where
two such flanks cross. Points of both flanks, given by their reach, are touched by one pin if the
line through them is equally inclined to both. Thick pins lie farther out than thin ones: the
thinnest touches one flank at its lower end, the thickest one at its upper end.

Depends on outline.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile
from typing import Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.inches import INCH
from gearcam.gears.flank import Curve, Toothing, trace
from gearcam.gears.flank_ends import flank_crossings
from gearcam.gears.outline import Outline
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import bracketed_root

SIDES: Final = np.array([[1.0], [-1.0]])
"""Sigma of the flanks of a space: that of the tooth before it, and that of the tooth after."""

_SHARE: Final = 1e-12
"""Width at which a bracket counts as a point, as a share of a flank."""

_ANGLE: Final = 1e-9
"""The same in rad along a tip: the error of its height goes with the square."""

_SHARES: Final = (1.0 / 3.0, 1.0 / 6.0, 0.0)
"""Share of the flanks at both ends that a recommended pin does not touch: the first possible."""

_OUT: Final = 0.05
"""Least amount by which a recommended pin stands out of the tips, in modules."""

_FINEST, _STEPS = 0.01, 8.0
"""Steps of the sizes of pins: hundredths of a mm, but not below an eighth of the possible range."""

_INCHES: Final = (*(0.5**power for power in range(7)), 0.01, 0.005, 0.001)
"""Steps in inches, the simplest first: fractions to 1/64, then decimals."""


class Spaces(NamedTuple):
    """The spaces between whole teeth; rows of arrays are those of `SIDES`.

    Parameters
    ----------
    teeth : (2, n) int array
        The teeth beside each space, as indices of those formed.
    sf, lowest, highest : (2, n) arrays, mm
        Their flanks, and the reach of the ends of these.
    """

    teeth: Ints
    sf: Array
    lowest: Array
    highest: Array

    @classmethod
    def of(cls, outline: Outline) -> Spaces:
        """Return those of an `outline`, rising s: an open wheel has one fewer than teeth."""
        toothing, flanks = outline.toothing, outline.flanks
        whole = np.arange(len(toothing.numbers))[toothing.whole]
        teeth = np.stack([whole, np.roll(whole, -1)])[:, : None if toothing.closed else -1]
        flank = teeth + np.array([[0], [len(toothing.numbers)]])
        sf = flanks.sf[flank]
        sf[1] += toothing.length * (teeth[1] < teeth[0])
        return cls(teeth, sf, flanks.lowest[flank], flanks.highest[flank])


def flank_ends(outline: Outline) -> tuple[Plane, Plane]:
    """Return the lower and the upper ends of all flanks of an `outline`, mm."""
    toothing, flanks = outline.toothing, outline.flanks
    sf, sigma = flanks.sf, flanks.sigma
    low, high = (
        toothing.flank_points(toothing.frames(toothing.track.angle(sf - sigma * w)), sf, sigma)
        for w in (flanks.lowest, flanks.highest)
    )
    return low, high


class Pins(NamedTuple):
    """Pins of one diameter in all n spaces; what does not exist is nan.

    Parameters
    ----------
    center : (n,) complex array, mm
        Centres of the pins that touch both flanks.
    contact : (2, n) complex array, mm
        Points of contact on the tooth before and the tooth after.
    root_gap, stands_out : (n,) arrays, mm
        Distance from the root; how far they stand out of the tips of both teeth, along the normal
        of the centrode in the middle of the space.
    opposite : (n,) int array
        Index of the opposite space, half of all spaces ahead; of an open wheel the space itself.
    over : (n,) array, mm
        Over two opposite pins, between them in a ring, over one and the back of a rack. Only of
        pins that can be measured and stand out where flat jaws touch them.
    """

    center: Plane
    contact: Plane
    root_gap: Array
    stands_out: Array
    opposite: Ints
    over: Array

    @property
    def measured(self) -> Mask:
        """Whether each touches both flanks, stands out of the tips and clears the root."""
        return (self.root_gap > 0.0) & (self.stands_out > 0.0)


class PinLimits(NamedTuple):
    """The thinnest or the thickest pin of each space.

    Parameters
    ----------
    diameter : (n,) array, mm
        Its diameter; nan where no pin touches both flanks.
    reach : (2, n) array, mm
        Reach of its contacts.
    """

    diameter: Array
    reach: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class PinMeasures(ShortRepr):
    """Measures over pins and chords of the teeth of a finished outline.

    Parameters
    ----------
    outline : Outline
        The teeth as made: backlash, clearance, shortened and rounded tips are in it.
    inches : bool
        Whether simple sizes of pins are those in inches.
    """

    outline: Outline
    inches: bool = False

    @property
    def toothing(self) -> Toothing:
        """The wheel."""
        return self.outline.toothing

    @cached_property
    def spaces(self) -> Spaces:
        """Its spaces."""
        return Spaces.of(self.outline)

    @cached_property
    def thinnest(self) -> PinLimits:
        """The thinnest pins that touch both flanks."""
        return self._limit(self.spaces.lowest, self.spaces.highest, 1.0)

    @cached_property
    def thickest(self) -> PinLimits:
        """The thickest pins that touch both flanks."""
        return self._limit(self.spaces.highest, self.spaces.lowest, -1.0)

    def _inside(self, share: float) -> tuple[PinLimits, PinLimits]:
        """Return the thinnest and the thickest pins that do not touch a `share` of both ends."""
        low, high = self.spaces.lowest, self.spaces.highest
        inset = share * (high - low)
        return self._limit(low + inset, high, 1.0), self._limit(high - inset, low, -1.0)

    def _limit(self, start: Array, end: Array, sense: float) -> PinLimits:
        """Return the pins that touch one flank at `start` and the other from there to `end`."""
        first = self._touching(start)[0]
        moves = np.stack([sense * first > 0.0, sense * first <= 0.0])

        def reach(share: Array) -> Array:
            return start + share * moves * (end - start)

        def skew(share: Array) -> Array:
            return self._touching(reach(share))[0]

        last = skew(np.ones_like(first))
        found = reach(bracketed_root(skew, 0.0 * first, 0.0 * first + 1.0, _SHARE, (first, last)))
        there = (first * last <= 0.0) & (self.spaces.highest > self.spaces.lowest).all(axis=0)
        diameter = np.where(there, 2.0 * self._touching(found)[1], np.nan)
        return PinLimits(diameter, found)

    def _touching(self, reach: Array) -> tuple[Array, Array]:
        """Return how much farther out the second contacts lie than those of pins, and their radii.

        Parameters
        ----------
        reach : (2, n) array, mm
            Of the points of contact.

        Returns
        -------
        skew, radius : (n,) arrays, mm
            The radii hold where the skew is 0.
        """
        toothing, cosine = self.toothing, math.cos(self.toothing.cutter.alpha)
        frames = toothing.frames(toothing.track.angle(self.spaces.sf - SIDES * reach), curved=False)
        normals = toothing.normals(frames, SIDES)
        before, after = frames.p + SIDES * reach * cosine * normals
        chord = np.conj(normals.sum(axis=0)) * (after - before)
        size = np.abs(normals.sum(axis=0))
        return (chord / toothing.turn).real / size, chord.real / size**2

    def pins(self, diameter: float) -> Pins:
        """Return the pins of a `diameter`, mm, in all spaces."""
        thin, thick = self.thinnest, self.thickest
        at = np.flatnonzero((thin.diameter <= diameter) & (diameter <= thick.diameter))
        places = np.full((3, len(thin.diameter)), complex(np.nan, np.nan))
        if at.size:
            self._place(diameter, at, places)
        with np.errstate(invalid="ignore"):
            return self._measured(places[0], places[1:], 0.5 * diameter)

    def _place(self, diameter: float, at: Ints, places: Plane) -> None:
        """Enter centres and both contacts of pins in the spaces `at` into rows of `places`."""
        toothing = self.toothing
        sf, sigma = self.spaces.sf[:, at], np.repeat(SIDES, len(at), axis=1)
        moved = sf + sigma * 0.5 * diameter / math.cos(toothing.cutter.alpha)
        ends = (
            toothing.track.angle(sf - sigma * one.reach[:, at])
            for one in (self.thinnest, self.thickest)
        )
        phi, met = flank_crossings(toothing, moved, sigma, *ends)
        frames = toothing.frames(phi)
        places[0, at[met]] = toothing.flank_points(frames, moved, sigma)[0, met]
        places[1:, at[met]] = toothing.flank_points(frames, sf, sigma)[:, met]

    def _measured(self, center: Plane, contact: Plane, radius: float) -> Pins:
        """Return pins with their distances from roots and tips, and what is measured over them."""
        toothing, around = self.toothing, np.arange(len(center))
        frames = toothing.frames(toothing.track.angle(self.spaces.sf.mean(axis=0)), curved=False)
        normal = toothing.turn * frames.t
        gap = self._root_gap(center) - radius
        out = self._stands_out(center, normal, around) + radius
        there, over, opposite = (gap > 0.0) & (out > 0.0), np.full(center.shape, np.nan), around
        if toothing.track.slides:
            over = self.outline.points.real.max() - center.real + radius
        elif toothing.closed:
            opposite = (around + len(center) // 2) % len(center)
            inwards = -1.0 if toothing.track.ring else 1.0
            across = center - center[opposite]
            away = inwards * across / np.abs(across)
            over = np.abs(across) + 2.0 * inwards * radius
            there = there & there[opposite]
            for at, direction in ((around, away), (opposite, -away)):
                there &= self._stands_out(center[at], direction, at) > -radius
        return Pins(center, contact, gap, out, opposite, np.where(there, over, np.nan))

    def _stands_out(self, center: Plane, away: Plane, at: Ints) -> Array:
        """Return how far centres of the spaces `at` lie beyond the tips of both teeth, mm."""
        before, after = (self._top(teeth, away) for teeth in self.spaces.teeth[:, at])
        return (np.conj(away) * center).real - np.maximum(before, after)

    def _top(self, teeth: Ints, away: Plane) -> Array:
        """Return how far different `teeth` reach in the directions `away`, mm."""
        toothing, rows = self.toothing, self.outline.rows
        both = teeth + np.array([[0], [len(toothing.numbers)]])
        top = (np.conj(away) * self._upper_ends[both]).real.max(axis=0)
        place = np.full(len(toothing.numbers), -1)
        place[teeth] = np.arange(len(teeth))
        tips = np.flatnonzero(np.isin(rows.kind, (Curve.TIP, Curve.ROUND)))
        at = place[rows.tooth[tips] - toothing.numbers[0]]
        tips, at = tips[at >= 0], at[at >= 0]
        start, end = rows.start[tips], rows.end[tips]

        def along(phi: Array, which: Ints | slice, moves: int) -> Array:
            of_tips = trace(toothing, rows, tips[which], phi)[moves]
            return (np.conj(away)[at[which]] * of_tips).real

        first, last = along(start, slice(None), 1), along(end, slice(None), 1)
        inner = np.flatnonzero(first * last < 0.0)
        ends = start[inner], end[inner]
        found = bracketed_root(
            lambda phi: along(phi, inner, 1), *ends, _ANGLE, (first[inner], last[inner])
        )
        for phi, which in ((start, slice(None)), (end, slice(None)), (found, inner)):
            np.maximum.at(top, at[which], along(phi, which, 0))
        return top

    @cached_property
    def _upper_ends(self) -> Plane:
        return flank_ends(self.outline)[1]

    def _root_gap(self, center: Plane) -> Array:
        """Return the distances of centres from the vertices of the roots of their spaces, mm."""
        toothing, rows, sampler = self.toothing, self.outline.rows, self.outline.sampler
        j, points, _ = sampler.chords
        row = sampler.curve_of(j)
        root = np.flatnonzero(np.isin(rows.kind[row], (Curve.LAND, Curve.FILLET)))
        row = row[root]
        before = rows.tooth[row] - (rows.sigma[row] < 0.0) - toothing.numbers[0]
        space = (before - self.spaces.teeth[0, 0]) % len(toothing.numbers)
        root, space = root[space < len(center)], space[space < len(center)]
        gap = np.where(np.isnan(center), np.nan, np.inf)
        np.minimum.at(gap, space, np.abs(points[root] - center[space]))
        return gap

    @property
    def recommended(self) -> float:
        """The pin that serves this wheel, diameter in mm: of a simple size if one does.

        It touches the flanks near their middle in all spaces, stands out and clears the root. Where
        no pin does so in all spaces, it is that of the middle space.
        """
        return self._recommended[0]

    @property
    def simple(self) -> bool:
        """Whether the recommended pin has a simple size."""
        return self._recommended[1]

    @cached_property
    def _recommended(self) -> tuple[float, bool]:
        least, most = self.thinnest.diameter, self.thickest.diameter
        there, module = np.isfinite(least + most), self.toothing.pitch / math.pi
        if not there.any():
            return 0.5 * self.toothing.pitch, False
        for share in _SHARES:
            low, high = (one.diameter[there] for one in self._inside(share))
            possible = np.isfinite(low + high).all()
            ends = float(low.max()), float(high.min())
            for diameter in _sizes(*ends, self.inches) if possible else ():
                pins = self.pins(diameter)
                if (pins.measured & (pins.stands_out > _OUT * module))[there].all():
                    return diameter, True
        return float(np.median(0.5 * (least + most)[there])), False

    @cached_property
    def chords(self) -> dict[str, Array]:
        """Chords of the whole teeth and their depths below the tips, by name, (n,) arrays, mm.

        ``chord``, ``chord_depth``: from flank to flank at the centrode. ``constant_chord``,
        ``constant_chord_depth``: between the points in which both flanks touch the rack that stands
        in the middle of the tooth, ``2*half*cos(alpha)^2`` along T: at every tooth, along any
        centrode. Nan where flanks do not reach these points.
        """
        toothing, half = self.toothing, self.toothing.half_tooth
        teeth = np.arange(len(toothing.numbers))[toothing.whole]
        flank = teeth + np.array([[0], [len(toothing.numbers)]])
        low, high = self.outline.flanks.lowest[flank], self.outline.flanks.highest[flank]
        places = toothing.tooth_places[teeth] + half * np.array([[-1.0], [0.0], [1.0]])
        frames = toothing.frames(toothing.track.angle(places), curved=False)
        before, middle, after = frames.p
        cosine, sine = math.cos(toothing.cutter.alpha), math.sin(toothing.cutter.alpha)
        chord, out = np.abs(after - before), toothing.turn * frames.t[1]
        constant, height = 2.0 * half * cosine**2 + 0.0 * chord, half * cosine * sine
        across = toothing.turn * (after - before) / chord
        table = {}
        for name, reach, size, away, point in (
            ("chord", 0.0, chord, across, before),
            ("constant_chord", half, constant, out, middle + height * out),
        ):
            there = ((low <= reach) & (reach <= high)).all(axis=0)
            depth = self._top(teeth, away) - (np.conj(away) * point).real
            table[name] = np.where(there, size, np.nan)
            table[f"{name}_depth"] = np.where(there, depth, np.nan)
        return table


def _sizes(low: float, high: float, inches: bool) -> Iterator[float]:
    """Yield diameters in a range, mm: simple sizes first, of equally simple ones the middle."""
    finest = max(_FINEST, (high - low) / _STEPS)
    steps: Iterable[float] = (
        part * 10.0**power
        for power in range(math.ceil(math.log10(max(high, _FINEST))), -3, -1)
        for part in (1.0, 0.5, 0.25)
    )
    if inches:
        steps = [INCH * part for part in _INCHES]
    for step in takewhile(lambda step: step > finest * (1.0 - _SHARE), steps):
        counts = range(math.ceil(low / step), math.floor(high / step) + 1)
        yield from sorted(
            (round(n * step, 7) for n in counts), key=lambda d: abs(2 * d - low - high)
        )
