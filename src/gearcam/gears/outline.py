"""The outline of a wheel: flanks, fillets, lands and tips, joined, trimmed and verified.

And the outside of a ring that follows its roots.
"""

from __future__ import annotations

import math
from copy import deepcopy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.tolerances import Tolerances
from gearcam.gears.corners import highest_corners
from gearcam.gears.flank import Curve, Rows, Toothing, WheelCurves
from gearcam.gears.flank_ends import (
    TipEnds,
    Undercut,
    feet,
    find_cusps,
    find_tips,
    flank_crossings,
    near,
)
from gearcam.gears.open_ends import body_runs, cut_ends
from gearcam.gears.rounding import round_tips
from gearcam.gears.spaces import ROWS_PER_TOOTH, entangled, regular_rows, untangle
from gearcam.gears.spec import Bar, RingSpec
from gearcam.laws.ratio.span import angle_text
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, as_pairs, distinct
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.polygons import is_simple
from gearcam.numeric.sampling import MOST, Dense, Sampler

_NO_MATE = 3.0
"""Reach in pitches beyond that of any flank."""

_FOLLOWED = 3e-4
"""Largest chord tolerance, in pitches, in tracing corners: a coarser outline must not change the
flanks."""

_AT_TIP = 1e-12
"""Share of a flank's reach within which a cusp is at its tip: rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Flanks(ShortRepr):
    """All flanks of a wheel and their ends: sigma = +1 of all teeth formed, then sigma = -1.

    Parameters
    ----------
    sf, sigma : (2z,) arrays, mm and 1
        Position on the pitch curve, and side.
    cusps : Undercut
        Cusps.
    tips : TipEnds
        Upper ends.
    lowest, highest : (2z,) arrays, mm
        Reach w of both ends of each finished flank.
    traced : bool
        Whether some ends come from tracing corners, which are exact to a part of the tolerance.
    """

    sf: Array
    sigma: Array
    cusps: Undercut
    tips: TipEnds
    lowest: Array
    highest: Array
    traced: bool = False

    @property
    def undercut(self) -> Mask:
        """Whether a flank turns back on itself between its form point and its tip, (2z,)."""
        return np.isfinite(self.cusps.dedendum) | np.isfinite(self.cusps.addendum)


@dataclass(frozen=True, eq=False, kw_only=True)
class Outline(ShortRepr):
    """A wheel's outline.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        Its curves, loops removed, rising s.
    flanks : Flanks
        Where each flank ends.
    tolerance : float, mm
        Largest chord error.
    oversampling : int
        Dense points per chord.
    back : RingSpec or Bar, optional
        Outside of an open ring, by default that of `RingSpec()`; the bar of a rack.
    most : float
        Largest number of chords; more are refused.
    """

    toothing: Toothing
    rows: Rows
    flanks: Flanks
    tolerance: float
    oversampling: int
    back: RingSpec | Bar | None = None
    most: float = MOST

    @cached_property
    def sampler(self) -> Sampler:
        """The curves, sampled as densely as the tolerance needs."""
        return Sampler(
            curves=WheelCurves(toothing=self.toothing, rows=self.rows),
            tolerance=self.tolerance,
            closed=self.toothing.closed,
            most=self.most,
        )

    @cached_property
    def toothed(self) -> Plane:
        """Points of the teeth, complex, mm, counter-clockwise."""
        points = self.sampler.chords[1]
        return points[::-1] if self.toothing.track.clockwise else points

    @cached_property
    def body(self) -> tuple[Run, ...]:
        """Body between the ends of an open wheel around its shaft; empty for a closed wheel."""
        if self.toothing.closed:
            return ()
        parts = self.oversampling
        return body_runs(self.toothing, self.toothed, self.chord_error, parts, self.back)

    @cached_property
    def points(self) -> Plane:
        """Points of the adaptive polygon, complex, mm, counter-clockwise."""
        if self.toothing.closed:
            return self.toothed
        sparse = [run.points[: -1 : self.oversampling] for run in self.body]
        return np.concatenate([self.toothed[:-1], *sparse])

    @cached_property
    def teeth(self) -> tuple[Ints, Ints]:
        """Tooth numbers, (k,), rising, and the first and last vertex of each tooth, (k, 2).

        The vertices span the flanks and the tip, without fillets; the last index is less than the
        first where the tooth spans the start of `points`. An open driven wheel has half a tooth at
        each end: its first is number 0.
        """
        closed, rows = self.toothing.closed, self.rows
        row = self.sampler.curve_of(self.sampler.chords[0][: -1 if closed else None])
        row = row[::-1] if self.toothing.track.clockwise else row
        root, count = self.toothing.numbers[0] - 1, len(row)
        tooth = np.where(np.isin(rows.kind, (Curve.LAND, Curve.FILLET)), root, rows.tooth)[row]
        ends = []
        for step in (1, -1):
            at = np.flatnonzero((tooth != np.roll(tooth, step)) & (tooth != root))
            at = at[np.argsort(tooth[at], kind="stable")]
            ends.append((at - step) % count if closed else np.clip(at - step, 0, count - 1))
        return distinct(tooth[tooth != root]), np.column_stack(ends)

    @property
    def chord_error(self) -> float:
        """Largest measured distance of the curve from its chords, mm."""
        return self.sampler.chords[2]

    @cached_property
    def _dense(self) -> Dense:
        return self.sampler.dense(self.oversampling)

    @cached_property
    def dense_teeth(self) -> tuple[Run, ...]:
        """Dense points of the teeth, counter-clockwise."""
        return self._dense.runs(self.toothing.track.clockwise)

    @property
    def kinks_missed(self) -> float:
        """Bound of the area between the teeth and cubics through dense points at kinks, mm^2.

        Where a tip rises along the centrode, a jump of the curvature gives it a kink, but its dense
        points have a single tangent there. 0 where no tip rises.
        """
        rising = (self.rows.kind == Curve.TIP) & (self.rows.low != self.rows.high)
        return self._dense.missed(self.sampler.at) if rising.any() else 0.0

    @cached_property
    def contour(self) -> Contour:
        """The outline with dense points and tangents, for arcs, and its polygon."""
        return Contour(
            dense=lambda: self.dense_teeth + self.body,
            points=self.points,
            tolerance=self.tolerance,
            chord_error=self.chord_error,
        )

    @cached_property
    def tip_thickness(self) -> Array:
        """Distance between the upper ends of each whole tooth's flanks, (z,), mm."""
        frames = self.toothing.frames(self.flanks.tips.phi)
        ends = self.toothing.flank_points(frames, self.flanks.sf, self.flanks.sigma)
        return np.abs(np.subtract(*self.toothing.of_teeth(ends)))

    @property
    def tip_height(self) -> Array:
        """Distance of each whole tooth's lower flank end from the centrode, (z,), mm."""
        return self.toothing.of_teeth(self.flanks.tips.height).min(axis=0)

    @cached_property
    def undercut_teeth(self) -> tuple[int, ...]:
        """Numbers of the teeth with an undercut flank on either side."""
        either = self.toothing.of_teeth(self.flanks.undercut).any(axis=0)
        return tuple(np.array(self.toothing.numbers)[self.toothing.whole][either].tolist())


def build_outline(
    toothing: Toothing,
    mate: Toothing | None,
    tolerance: float,
    tolerances: Tolerances,
    *,
    follow: bool = True,
    back: RingSpec | Bar | None = None,
) -> Outline:
    """Build the outline of a wheel.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    mate : Toothing or None
        The other wheel. Flanks end where its flanks end, since beyond there is only its fillet to
        touch, and where their corners would hit its root. With None only the addendum curve ends
        them, for comparison.
    tolerance : float, mm
        Largest chord error.
    tolerances : Tolerances
        Inner accuracy.
    follow : bool
        Whether corners are traced into the mate's roots.
    back : RingSpec or Bar, optional
        Outside of an open ring, by default that of `RingSpec()`; the bar of a rack.

    Returns
    -------
    Outline
        A simple closed curve.

    Raises
    ------
    InfeasibleError
        If a tooth is cut off, or the teeth reach past the shaft.
    """
    flanks = _find_flanks(toothing, mate, tolerance if follow else None, tolerances)
    rows = regular_rows(toothing, flanks.tips)
    spaces = entangled(toothing, rows, flanks.cusps)
    rows, flanks = _assemble(toothing, rows, flanks, spaces)
    outline = Outline(
        toothing=toothing,
        rows=rows,
        flanks=flanks,
        tolerance=tolerance,
        oversampling=tolerances.oversampling,
        back=back,
    )
    _demand_simple(outline)
    _demand_shaft(outline)
    return outline


def _find_flanks(
    toothing: Toothing, mate: Toothing | None, tolerance: float | None, tolerances: Tolerances
) -> Flanks:
    sf, sigma = toothing.flanks
    mate_reach = _NO_MATE * toothing.pitch if mate is None else mate.cutter.reach
    cusps = find_cusps(toothing, sf, sigma, -toothing.cutter.reach, mate_reach)
    limit = np.minimum(cusps.addendum, mate_reach)
    tips, lower = find_tips(toothing, sf, sigma, limit), np.empty(0, dtype=np.int64)
    if mate is not None and tolerance is not None:
        reach = sigma * (sf - toothing.track.arc_length(tips.phi))
        fine = min(tolerance, _FOLLOWED * toothing.pitch)
        allowed = highest_corners(
            toothing,
            mate,
            lambda: build_outline(mate, toothing, fine, tolerances, follow=False).points,
            fine,
            (sf, sigma),
            reach,
        )
        lower = np.flatnonzero(allowed < reach)
        if lower.size:
            tips = tips.replaced(
                lower, find_tips(toothing, sf[lower], sigma[lower], allowed[lower])
            )
    tips = _sharpen(toothing, tips)
    highest = sigma * (sf - toothing.track.arc_length(tips.phi))
    # a cusp beyond the tip has no effect
    addendum = np.where(cusps.addendum <= highest * (1.0 + _AT_TIP), cusps.addendum, np.inf)
    return Flanks(
        sf=sf,
        sigma=sigma,
        cusps=Undercut(dedendum=cusps.dedendum, addendum=addendum),
        tips=tips,
        lowest=np.full(sf.shape, -toothing.cutter.reach),
        highest=highest,
        traced=lower.size > 0,
    )


def _sharpen(toothing: Toothing, tips: TipEnds) -> TipEnds:
    """Cut back the flanks of pointed teeth to where they cross."""
    (sf, sigma), z = toothing.flanks, len(toothing.numbers)
    pointed = np.flatnonzero(tips.foot[:z] <= tips.foot[z:])
    if pointed.size == 0:
        return tips
    ends, both = deepcopy(tips), np.stack([pointed, z + pointed])
    high, low = base = toothing.track.angle(sf[both])
    crossing, met = flank_crossings(toothing, sf[both], sigma[both], base, tips.phi[both])
    ends.phi[both[:, met]], ends.full[both[:, met]] = crossing[:, met], False
    frames = toothing.frames(ends.phi[pointed])
    points = toothing.flank_points(frames, sf[pointed], sigma[pointed])
    middle = feet(toothing, points, low, high, 0.5 * (low + high))
    ends.foot[both], ends.height[both] = middle, np.abs(points - toothing.frames(middle).p)
    return ends


def _assemble(toothing: Toothing, rows: Rows, flanks: Flanks, spaces: Ints) -> tuple[Rows, Flanks]:
    """Replace entangled spaces by untangled ones and shorten the flanks they trim."""
    parts, done = [], 0
    for space, part in zip(spaces, untangle(toothing, rows, spaces), strict=True):
        first = ROWS_PER_TOOTH * int(space)
        parts += [rows.select(np.arange(done, first)), part]
        done = first + ROWS_PER_TOOTH
    joined = Rows.joined([*parts, rows.select(np.arange(done, len(rows.kind)))])
    lowest = _lowest(toothing, joined)
    if not toothing.closed:
        joined = cut_ends(toothing, joined, flanks.tips)
    pointed = (joined.kind == Curve.TIP) & (joined.start == joined.end)
    joined = joined.select(np.flatnonzero(~pointed))
    highest = flanks.highest
    if toothing.rounding > near(toothing):  # below it has no effect
        joined, reach = round_tips(toothing, joined, flanks.tips)
        highest = np.where(np.isfinite(reach), reach, highest)
    return joined, replace(flanks, lowest=lowest, highest=highest)


def _lowest(toothing: Toothing, rows: Rows) -> Array:
    """Reach of the lower ends of all flanks formed, (2z,), mm."""
    z, at = len(toothing.numbers), np.flatnonzero(rows.kind == Curve.FLANK)
    sigma = rows.sigma[at]
    low = np.where(sigma > 0.0, rows.end[at], rows.start[at])
    lowest = np.full(2 * z, -toothing.cutter.reach)
    # a flank that crosses itself ends at its first loop
    np.maximum.at(
        lowest,
        rows.tooth[at] - toothing.numbers[0] + np.where(sigma > 0.0, 0, z),
        sigma * (rows.sf[at] - toothing.track.arc_length(low)),
    )
    return lowest


def _demand_simple(outline: Outline) -> None:
    """Refuse an outline that crosses itself: a tooth has been cut off."""
    if is_simple(outline.points):
        return
    from shapely import LinearRing, Polygon, is_valid_reason

    points = as_pairs(outline.points)
    if LinearRing(points).is_simple and np.all(np.diff(outline.points) != 0.0):
        return
    toothing = outline.toothing
    radius = toothing.track.convex.radius
    largest = np.sin(toothing.cutter.alpha) ** 2 * radius if np.isfinite(radius) else 0.0
    what = f"wheel {toothing.wheel} is not in one piece: undercut cuts teeth off"
    where = _crossing(is_valid_reason(Polygon(points)), float(np.ptp(points)))
    note = "the value is the module, the limit the largest without undercut at this size"
    more_teeth = toothing.pitch / (np.pi * largest) if largest else 2.0
    raise beyond_limit(
        what, where, toothing.pitch / np.pi, largest, note, unit="mm", more_teeth=more_teeth
    )


def _crossing(reason: str, size: float) -> str:
    """Return where an outline of `size`, mm, crosses itself; shapely puts it in brackets."""
    kind, _, place = reason.rstrip("]").partition("[")
    if not place:
        return "its outline touches itself"
    x, y = (formatted(float(word), 4, size) for word in place.split())
    return f"{kind.lower()} at x = {x}, y = {y} mm"


def _demand_shaft(outline: Outline) -> None:
    """Refuse a wheel whose roots reach past its own shaft."""
    if not outline.toothing.closed:
        return
    points = outline.sampler.chords[1]
    if abs(float(np.angle(points[1:] * np.conj(points[:-1])).sum())) > np.pi:
        return
    toothing = outline.toothing
    around = np.linspace(0.0, toothing.track.around, 1441)
    radii = np.abs(toothing.frames(around).p)
    radius = float(radii.min())
    module = toothing.pitch / np.pi
    largest = module * radius / toothing.cutter.dedendum
    what = f"the roots of wheel {toothing.wheel} reach past its own shaft"
    where = angle_text(float(around[radii.argmin()]))
    note = (
        "the value is the module; at the limit the roots reach the shaft, where the "
        f"centrode comes within {formatted(radius)} mm of it"
    )
    raise beyond_limit(what, where, module, largest, note, unit="mm", more_teeth=module / largest)


def outside(ring: Outline, rim: float) -> Contour:
    """Return the outside of a ring that follows its roots at a distance `rim`.

    It is a parallel of the centrode on the metal's side, as the land of a root is. Parallels that
    have corners or cross themselves are refused.

    Parameters
    ----------
    ring : Outline
        The teeth of the ring, closed.
    rim : float, mm
        Distance from the lands of its roots.

    Returns
    -------
    Contour
        Counter-clockwise, with the chord tolerance of the teeth.

    Raises
    ------
    InfeasibleError
        If a concave part of the centrode is too tight for the rim.
    """
    toothing = ring.toothing
    away = toothing.cutter.dedendum + rim
    most = toothing.track.convex.radius - toothing.cutter.dedendum
    if rim >= most:
        raise _refusal("a concave part of the pitch curve is too tight", rim, most)
    # a piece for each tooth, as dense as its curvature needs
    ends = np.linspace(0.0, toothing.track.around, toothing.teeth + 1)
    none = np.zeros(toothing.teeth)
    rows = Rows(
        kind=np.full(toothing.teeth, int(Curve.LAND)),
        sf=none,
        sigma=none,
        start=ends[:-1],
        end=ends[1:],
        low=none - away,
        high=none - away,
        corner=np.arange(toothing.teeth) == 0,
        tooth=np.arange(toothing.teeth),
    )
    curves = WheelCurves(toothing=toothing, rows=rows)
    sampler = Sampler(curves=curves, tolerance=ring.tolerance)
    _, points, error = sampler.chords
    contour = Contour(
        dense=lambda: sampler.dense(ring.oversampling).runs(),
        points=points,
        tolerance=ring.tolerance,
        chord_error=error,
    )
    if not contour.polygon.is_valid:
        raise _refusal("it would cross itself", rim, 0.0)
    return contour


def _refusal(why: str, rim: float, most: float) -> InfeasibleError:
    """Return the error for a parallel; `most` is the largest rim the curvature allows, if any."""
    adjustments = [Adjustment(near={"ring.outer": "round"})]
    bent = 0.0 < most < math.inf
    if bent:
        adjustments.insert(
            0, Adjustment(near={"ring.rim_mm": 0.99 * most}, far={"ring.rim_mm": 0.1 * most})
        )
    what = f"the outside of the ring cannot follow its roots: {why}"
    note = "at the limit the outside gets a corner" if bent else ""
    return beyond_limit(
        what, "ring.rim_mm", rim, most if bent else None, note, adjustments=adjustments
    )
