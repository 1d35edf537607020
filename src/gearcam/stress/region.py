"""Plane regions bounded by true curves, for elastic bodies.

The metal is always to the left: the outer curve runs counter-clockwise, holes run clockwise.
A curve is a closed chain of smooth runs; a run is one exact arc or straight line, or dense points
of a true curve with the cubics through its points and tangents. *Held* runs do not move.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import shortened
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, divided
from gearcam.numeric.bulges import bulge_pieces, on_arcs
from gearcam.numeric.contour import Contour
from gearcam.numeric.hermite import hermite_arms, on_cubics
from gearcam.numeric.moments import curve_moments
from gearcam.parts.body import Edge, Opening, Part
from gearcam.parts.shapes import Circle

if TYPE_CHECKING:
    from gearcam.gears.pair import Gear

_CORNER: Final = 0.02
"""Least turn of the tangent at a corner, rad: smaller kinks neither matter to a mesh nor to the
stress a little away from them."""

_SAMPLES: Final = 2000
"""Least number of places along a curve among which the nearest is looked for."""

_NEAREST: Final = 3
"""Nearest of these places from which the search goes on: at corners two are the same point."""

_ROUNDS: Final = 8
"""Newton steps towards the nearest place: three are enough beside a smooth curve."""

_STEEP: Final = 0.2
"""Least slope taken in a Newton step: near a centre of curvature it vanishes."""

_EVEN: Final = 1e-6
"""Relative change of curvature up to which a run is an arc or, by its turn, straight."""

_HELD: Final = 0.5
"""Diameter of the held circle over the smallest root diameter, for a wheel without a bore."""

_APART: Final = 1.01
"""Least size of the held circle over that of an opening within it, and of the roots over it."""

_KEY: Final = "stress.held_diameter_mm"


@dataclass(frozen=True, eq=False, kw_only=True)
class BoundaryRun(ShortRepr):
    """A smooth piece of a boundary, the metal to its left.

    Parameters
    ----------
    points : (n,) complex array, mm
        Points on the curve: dense, or both ends of an arc or a straight line.
    tangents : (n,) complex array
        Unit tangents, forward.
    bulge : float or None
        Of an arc or a straight line (see `numeric.bulges`); None for the cubics between the points.
    held : bool
        Whether it does not move.
    """

    points: Plane
    tangents: Plane
    bulge: float | None = None
    held: bool = False

    @property
    def reversed(self) -> BoundaryRun:
        """The same curve in the opposite sense."""
        bulge = None if self.bulge is None else -self.bulge
        return replace(self, points=self.points[::-1], tangents=-self.tangents[::-1], bulge=bulge)

    @cached_property
    def steps(self) -> Array:
        """Lengths of the arc or of the cubics, (n - 1,), mm."""
        if self.bulge is None:
            return hermite_arms(self.points, self.tangents)
        half = 2.0 * math.atan(self.bulge)
        return np.abs(np.diff(self.points)) / np.sinc(half / np.pi)

    @cached_property
    def bends(self) -> Array:
        """Mean curvature of each step, (n - 1,), 1/mm, positive to the left."""
        if self.bulge is not None:
            return 4.0 * math.atan(self.bulge) / self.steps
        turns = np.angle(self.tangents[1:] * np.conj(self.tangents[:-1]))
        return np.divide(turns, self.steps, out=np.zeros_like(turns), where=self.steps > 0.0)

    @property
    def length(self) -> float:
        """Length, mm."""
        return float(self.steps.sum())

    @property
    def swept(self) -> float:
        """Area swept by the ray from the origin, mm^2."""
        if self.bulge is None:
            return curve_moments(self.points, self.tangents).area
        first, last = self.points
        turn = 4.0 * math.atan(self.bulge)
        triangle = 0.5 * float((np.conj(first) * last).imag)
        if not turn:
            return triangle
        radius = self.length / turn
        return triangle + 0.5 * radius * radius * (turn - math.sin(turn))

    def part(self, low: float, high: float) -> BoundaryRun:
        """Return the piece from one length along the run, `low`, to another, `high`, mm."""
        ends, within = np.append(0.0, np.cumsum(self.steps)), np.array([low, high])
        if self.bulge is not None:
            way, _ = on_arcs(np.diff(self.points), np.array([self.bulge]), within / ends[-1])
            first, last = (self.points[0] + way).tolist()
            bulge = math.tan(math.atan(self.bulge) * (high - low) / float(ends[-1]))
            return arc_run(first, last, bulge, held=self.held)
        step = np.clip(np.searchsorted(ends, within, side="right") - 1, 0, len(self.steps) - 1)
        share = (within - ends[step]) / self.steps[step]
        points, tangents = on_cubics(self.points, self.tangents, step, share)
        inner = np.flatnonzero((ends > low) & (ends < high))
        return replace(
            self,
            points=np.concatenate([points[:1], self.points[inner], points[1:]]),
            tangents=np.concatenate([tangents[:1], self.tangents[inner], tangents[1:]]),
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class BoundaryCurve(ShortRepr):
    """A closed curve that bounds a region, by its arc length s from the start of its first run.

    Parameters
    ----------
    runs : tuple of BoundaryRun
        In order, each beginning where the one before ends, the metal to the left.
    """

    runs: tuple[BoundaryRun, ...]

    @cached_property
    def _first(self) -> Ints:
        """Index of the point before each step, in the points of all runs."""
        counts = [len(run.points) for run in self.runs]
        starts = np.cumsum([0, *counts[:-1]])
        pairs = zip(starts, counts, strict=True)
        return np.concatenate([np.arange(start, start + n - 1) for start, n in pairs])

    @cached_property
    def _run(self) -> Ints:
        """Number of the run of each step."""
        return np.repeat(np.arange(len(self.runs)), [len(run.steps) for run in self.runs])

    @cached_property
    def _points(self) -> Plane:
        return np.concatenate([run.points for run in self.runs])

    @cached_property
    def _tangents(self) -> Plane:
        return np.concatenate([run.tangents for run in self.runs])

    @cached_property
    def _ends(self) -> Array:
        """Arc lengths s at which the steps begin, and the end."""
        return np.append(0.0, np.cumsum(np.concatenate([run.steps for run in self.runs])))

    @cached_property
    def _bulges(self) -> Array:
        """Bulge of each run, nan for cubics."""
        return np.array([math.nan if run.bulge is None else run.bulge for run in self.runs])

    @cached_property
    def steps(self) -> tuple[Array, Array]:
        """Arc lengths s at the ends of all steps, (n + 1,), mm, and their mean curvatures, (n,)."""
        return self._ends, np.concatenate([run.bends for run in self.runs])

    @property
    def length(self) -> float:
        """Length, mm."""
        return float(self._ends[-1])

    @property
    def area(self) -> float:
        """Area inside, mm^2, negative for a hole."""
        return sum(run.swept for run in self.runs)

    @property
    def reversed(self) -> BoundaryCurve:
        """The same curve in the opposite sense."""
        return BoundaryCurve(runs=tuple(run.reversed for run in reversed(self.runs)))

    @cached_property
    def starts(self) -> Array:
        """Arc length s at which each run begins, (runs,), mm."""
        return np.append(0.0, np.cumsum([run.length for run in self.runs]))[:-1]

    @cached_property
    def corners(self) -> Array:
        """Arc lengths s of the corners, rising, mm; empty for a smooth curve."""
        before = np.array([run.tangents[-1] for run in self.runs])
        after = np.array([run.tangents[0] for run in self.runs])
        return self.starts[np.abs(np.angle(after * np.conj(np.roll(before, 1)))) > _CORNER]

    @property
    def held_ends(self) -> Array:
        """Arc lengths s at which held and free runs meet, rising, mm."""
        held = np.array([run.held for run in self.runs])
        return self.starts[held != np.roll(held, 1)]

    @cached_property
    def places(self) -> Array:
        """Arc lengths s of all points, and between them where they are far apart, rising, mm."""
        counts = np.ceil(_SAMPLES * np.diff(self._ends) / self.length).astype(np.int64)
        return divided(self._ends, np.maximum(counts, 1))

    def _step(self, s: Array) -> Ints:
        last = len(self._ends) - 2
        return np.clip(np.searchsorted(self._ends, s, side="right") - 1, 0, last)

    def _wrapped(self, s: Array) -> Array:
        return np.mod(np.asarray(s, dtype=np.float64), self.length)

    def at(self, s: Array) -> tuple[Plane, Plane]:
        """Return points and tangents.

        Parameters
        ----------
        s : (k,) array, mm
            Arc lengths, of any turn.

        Returns
        -------
        points, tangents : (k,) complex arrays, mm and 1
            With unit tangents; at a corner the tangent after it.
        """
        s = self._wrapped(s)
        return self._on(self._step(s), s)

    def _on(self, step: Ints, s: Array) -> tuple[Plane, Plane]:
        begin = self._ends[step]
        width = self._ends[step + 1] - begin
        share = np.divide(s - begin, width, out=np.zeros_like(s), where=width > 0.0)
        first, bulge = self._first[step], self._bulges[self._run[step]]
        points, tangents = on_cubics(self._points, self._tangents, first, share)
        arc = ~np.isnan(bulge)
        start = self._points[first[arc]]
        way, slope = on_arcs(self._points[first[arc] + 1] - start, bulge[arc], share[arc])
        points[arc], tangents[arc] = start + way, slope / np.abs(slope)
        return points, tangents

    def curvature(self, s: Array) -> Array:
        """Return the curvature, 1/mm, positive where the metal is convex, at s, (k,), mm.

        It is continuous along a run: linear between the middles of its steps.
        """
        s = self._wrapped(s)
        step = self._step(s)
        run, middles = self._run[step], 0.5 * (self._ends[1:] + self._ends[:-1])
        bends = self.steps[1]
        beside = np.clip(step + np.where(s < middles[step], -1, 1), 0, len(middles) - 1)
        beside = np.where(self._run[beside] == run, beside, step)
        apart = middles[beside] - middles[step]
        share = np.divide(s - middles[step], apart, out=np.zeros_like(s), where=apart != 0.0)
        made: Array = bends[step] + share * (bends[beside] - bends[step])
        return made

    def held(self, s: Array) -> Mask:
        """Return whether the curve is held at s, (k,), mm."""
        held = np.array([run.held for run in self.runs])
        made: Mask = held[self._run[self._step(self._wrapped(s))]]
        return made

    @cached_property
    def _search(self) -> tuple[Any, Array, Ints]:
        """A tree of places along all runs, both ends of each among them, with their s and runs."""
        from scipy.spatial import KDTree

        ends = np.append(self.starts, self.length)
        s, run = [], []
        for number in range(len(self.runs)):
            low, high = ends[number], ends[number + 1]
            inner = self.places[(self.places > low) & (self.places < high)]
            s.append(np.concatenate([[low], inner, [high]]))
            run.append(np.full(len(inner) + 2, number))
        places, runs = np.concatenate(s), np.concatenate(run)
        points = self.at(places)[0]
        return KDTree(np.column_stack([points.real, points.imag])), places, runs

    def nearest(self, points: Plane) -> Array:
        """Return the s, (k,), mm, of the places that are nearest to points, (k,), complex, mm."""
        tree, places, runs = self._search
        points = np.asarray(points, dtype=np.complex128)
        _, found = tree.query(np.column_stack([points.real, points.imag]), k=_NEAREST)
        found = found.ravel()
        aim, ends = np.repeat(points, _NEAREST), np.append(self.starts, self.length)
        low, high = ends[runs[found]], ends[runs[found] + 1]
        low = np.maximum(low, places[np.maximum(found - 1, 0)])
        high = np.minimum(high, places[np.minimum(found + 1, len(places) - 1)])
        low, high = np.minimum(low, places[found]), np.maximum(high, places[found])
        s = places[found].copy()
        for _ in range(_ROUNDS):
            on, along = self.at(s)
            away = np.conj(along) * (aim - on)
            slope = np.maximum(1.0 - self.curvature(s) * away.imag, _STEEP)
            s = np.clip(s + away.real / slope, low, high)
        off = np.abs(self.at(s)[0] - aim).reshape(-1, _NEAREST)
        return s.reshape(-1, _NEAREST)[np.arange(len(points)), off.argmin(axis=1)] % self.length


@dataclass(frozen=True, eq=False, kw_only=True)
class Region(ShortRepr):
    """A plane region.

    Parameters
    ----------
    outer : BoundaryCurve
        Counter-clockwise.
    holes : tuple of BoundaryCurve
        Clockwise; none touches another or the outer curve.
    toothed : int
        Number, in `curves`, of the curve with the teeth: 0, of a ring that of its inner edge.
    """

    outer: BoundaryCurve
    holes: tuple[BoundaryCurve, ...] = ()
    toothed: int = 0

    @property
    def curves(self) -> tuple[BoundaryCurve, ...]:
        """The outer curve, then the holes."""
        return self.outer, *self.holes

    @property
    def area(self) -> float:
        """Area, mm^2."""
        return sum(curve.area for curve in self.curves)

    @property
    def teeth(self) -> BoundaryCurve:
        """The curve with the teeth."""
        return self.curves[self.toothed]


def curve_of(edge: Edge, *, hole: bool = False, held: bool = False) -> BoundaryCurve:
    """Return the boundary along an edge of a part.

    Parameters
    ----------
    edge : Contour or Circle or Loop
        Counter-clockwise; arcs and straight lines of circles and loops are kept exactly.
    hole : bool
        Whether the metal is outside.
    held : bool
        Whether it is held.

    Returns
    -------
    BoundaryCurve
    """
    made = BoundaryCurve(runs=tuple(replace(run, held=held) for run in _runs(edge)))
    return made.reversed if hole else made


def _runs(edge: Edge) -> Iterable[BoundaryRun]:
    if isinstance(edge, Contour):
        pieces = (piece for run in edge.runs for piece in run.pieces)
        return (BoundaryRun(points=one.points, tangents=one.tangents) for one in pieces)
    if isinstance(edge, Circle):
        radius = 0.5 * edge.diameter
        points = np.array([edge.center + way * radius for way in (1.0, 1j, -1.0, -1j)])
        return _arcs(points, np.full(4, math.tan(math.pi / 8.0)))
    return _arcs(edge.points, edge.bulges)


def _arcs(points: Plane, bulges: Array) -> Iterable[BoundaryRun]:
    for start, chord, bulge in zip(*bulge_pieces(points, bulges, closed=True), strict=True):
        yield arc_run(complex(start), complex(start + chord), float(bulge))


def arc_run(start: complex, end: complex, bulge: float = 0.0, *, held: bool = False) -> BoundaryRun:
    """Return a run that is one arc or a straight line.

    Parameters
    ----------
    start, end : complex, mm
        Its ends.
    bulge : float
        Tangent of a quarter of the arc's turn, positive to the left; 0 for a line.
    held : bool
        Whether it is held.

    Returns
    -------
    BoundaryRun
    """
    half = 2.0 * math.atan(bulge)
    along = (end - start) / abs(end - start) * np.exp(1j * half * np.array([-1.0, 1.0]))
    return BoundaryRun(points=np.array([start, end]), tangents=along, bulge=bulge, held=held)


def region_of(part: Part, held_diameter: float | None = None) -> Region:
    """Return the region of a part, that of its lowest step, and where it is held.

    A wheel is held on its bore; without one, on a circle of half the smallest root diameter, or
    within its openings if that circle cuts one; the disc is left out. A ring is held on its
    outside, a rack or a sector of a ring on its back.

    Parameters
    ----------
    part : Part
        A wheel, ring or rack.
    held_diameter : float, optional
        Diameter of a held circle around the shaft, mm, in place of the bore.

    Returns
    -------
    Region

    Raises
    ------
    InfeasibleError
        If the circle reaches the roots, cuts an opening or lies within the bore, or if the part
        has no metal around its shaft and a diameter is given.
    """
    step = part.steps[0]
    kinds = [one.kind for one in step.openings]
    outer = curve_of(step.edge, held="INNER" in kinds)
    if "INNER" in kinds or not _goes_round(outer):
        if held_diameter is not None:
            what = f"{part.name} has no metal around its shaft that a circle could hold"
            raise beyond_limit(what, _KEY, held_diameter, None, "leave the key out")
        holes = tuple(curve_of(one.shape, hole=True) for one in step.openings)
        if "INNER" in kinds:
            return Region(outer=outer, holes=holes, toothed=1 + kinds.index("INNER"))
        return Region(outer=_on_its_back(outer), holes=holes)
    if held_diameter is None and "BORE" in kinds:
        bores = (curve_of(one.shape, hole=True, held=one.kind == "BORE") for one in step.openings)
        return Region(outer=outer, holes=tuple(bores))
    return _on_circle(outer, step.openings, held_diameter)


def _goes_round(curve: BoundaryCurve) -> bool:
    """Return whether a curve goes round the origin."""
    points = curve.at(curve.places)[0]
    return abs(float(np.angle(points[1:] / points[:-1]).sum())) > math.pi


def _on_its_back(outer: BoundaryCurve) -> BoundaryCurve:
    """Return an outline held on its longest straight line or arc: no tooth has so long a one."""
    even = [
        run.length if float(np.ptp(run.bends)) * run.length <= _EVEN else 0.0 for run in outer.runs
    ]
    longest = int(np.argmax(even))
    return BoundaryCurve(
        runs=tuple(replace(run, held=k == longest) for k, run in enumerate(outer.runs))
    )


def _on_circle(outer: BoundaryCurve, openings: Sequence[Opening], diameter: float | None) -> Region:
    """Return a wheel without a disc around the shaft, held there."""
    roots = float(np.abs(outer.at(outer.places)[0]).min())
    holes = [curve_of(one.shape, hole=True) for one in openings]
    away = [np.abs(hole.at(hole.places)[0]) for hole in holes]
    least = [2.0 * _APART * float(one.max()) for one in away]
    most = [2.0 * float(one.min()) / _APART for one in away]
    if diameter is None:
        diameter = 2.0 * _HELD * roots
        if any(low < diameter < high for low, high in zip(most, least, strict=True)):
            diameter = min(most)
    limit = 2.0 * roots / _APART
    if diameter > limit:
        what = "the held circle reaches the roots of the teeth"
        raise beyond_limit(what, _KEY, diameter, limit, far=limit)
    for one, low, high in zip(openings, most, least, strict=True):
        if diameter < high and one.kind == "BORE":
            what = "the held circle does not go round the bore and its keyway"
            raise beyond_limit(what, _KEY, diameter, high, near=shortened(high, 1.0, 5))
        if low < diameter < high:
            what = f"the held circle cuts an opening, {one.name}"
            note = "the limit is the circle that has the opening within it"
            raise beyond_limit(what, _KEY, diameter, high, note, near=high)
    circle = curve_of(Circle(center=0j, diameter=diameter), hole=True, held=True)
    outside = (hole for hole, low in zip(holes, most, strict=True) if low >= diameter)
    return Region(outer=outer, holes=(circle, *outside))


def tooth_spans(region: Region, gear: Gear) -> tuple[Ints, Array]:
    """Return the teeth of a wheel on its boundary.

    Parameters
    ----------
    region : Region
        Of the wheel's part.
    gear : Gear
        The wheel.

    Returns
    -------
    numbers : (k,) int array
        Tooth numbers, in order along the boundary.
    spans : (k, 2) array, mm
        s from the middle of the root before each tooth to that after it; the second may be beyond
        the length, or the first below 0.
    """
    curve = region.teeth
    numbers, vertices = gear.profile.teeth
    ends = curve.nearest(gear.profile.points[vertices.ravel()]).reshape(-1, 2)
    if region.toothed:
        ends = ends[:, ::-1]
    order = np.argsort(ends[:, 0])
    numbers, ends = numbers[order], ends[order]
    ends[:, 1] = ends[:, 0] + (ends[:, 1] - ends[:, 0]) % curve.length
    gaps = np.append(ends[1:, 0], ends[0, 0] + curve.length) - ends[:, 1]
    # between the ends of an open wheel lies its body
    half = 0.5 * np.minimum(gaps, 2.0 * np.median(gaps))
    return numbers, np.column_stack([ends[:, 0] - np.roll(half, 1), ends[:, 1] + half])
