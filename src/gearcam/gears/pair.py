"""The gear pair: two wheels on their shafts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.base.adjustments import least
from gearcam.base.display import NotebookView, ShortRepr, renderer
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import ROUNDING
from gearcam.base.numerals import formatted
from gearcam.base.tolerances import Tolerances
from gearcam.gears.cutter import choose_cutter, ring_pinions
from gearcam.gears.flank import Toothing
from gearcam.gears.outline import Outline, build_outline
from gearcam.gears.rack_limits import (
    demand_clearance,
    demand_cutters,
    demand_shift,
    least_dedendum,
    settle_rack,
)
from gearcam.gears.rolling import Rolling, roll
from gearcam.gears.spec import Bar, BasicRack, Finish, PairSpec, Rack, RingSpec, StepsSpec
from gearcam.gears.track import Wheel
from gearcam.gears.track_table import tabled
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import RACK, RING, WHEEL, Lobes
from gearcam.numeric.arguments import whole
from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.numeric.columns import Columns

if TYPE_CHECKING:
    from gearcam.gears.measuring import Measuring

FINEST = 1e-9
"""Smallest tolerance of an outline, in modules: rounding hides finer ones."""

_DEPTH = 0.01
"""Step in which a default dedendum yields, in modules."""

_USUAL = 1e-3
"""Default tolerance of an outline, mm: a micrometre is finer than any machine that cuts teeth."""

_PARTS = 1000.0
"""The default tolerance is the module over this where that is finer."""

PICTURED = 721
"""Points of a centrode in a drawing."""

FLANK_POINTS = 17
"""Default number of points on each flank."""

_STRAIGHT = 1e12
"""Least radius of curvature, in lengths of the centrode, of what is straight but for rounding."""

COARSEST = 1.0 / 50.0
"""Coarsest tolerance of an outline, in modules: beyond it teeth lose their shape."""


@dataclass(frozen=True, eq=False, kw_only=True)
class GearPair(ShortRepr):
    """Two centrodes with their cutters and tooth positions.

    Parameters
    ----------
    rolling : Rolling
        The centrodes.
    teeth : (int, int)
        Tooth counts.
    rack : BasicRack
        Basic rack.
    module : float, mm
        L/(pi*z).
    toothings : (Toothing, Toothing)
        Both wheels.
    """

    rolling: Rolling
    teeth: tuple[int, int]
    rack: BasicRack
    module: float
    toothings: tuple[Toothing, Toothing]

    @property
    def law(self) -> RatioLaw:
        """The ratio law."""
        return self.rolling.law

    @property
    def center_distance(self) -> float:
        """Centre distance, mm; for a rack the factor of the law's radius."""
        return self.rolling.center_distance

    @property
    def shift(self) -> float:
        """Position of wheel 2's frame in that of wheel 1 at phi1 = 0, mm along x."""
        return self.rolling.guide.place

    @property
    def on_rack(self) -> bool:
        """Whether the driven element is a rack."""
        return self.rolling.mate == RACK

    @property
    def internal(self) -> bool:
        """Whether the driven element is a ring."""
        return self.rolling.mate == RING

    @property
    def closed(self) -> bool:
        """Whether both wheels are toothed all around."""
        return all(toothing.closed for toothing in self.toothings)

    def chord_tolerance(self, asked: float | None) -> float:
        """Return the tolerance of the outlines, mm: as given, or ``min(0.001 mm, m/1000)``.

        Raises
        ------
        InfeasibleError
            If it is coarser than m/50 or too fine for double precision.
        """
        if asked is None:
            return min(_USUAL, self.module / _PARTS)
        low, high = FINEST * self.module, COARSEST * self.module
        if not low <= asked <= high:
            fine = asked < low
            limit = low if fine else high
            what = f"the chord tolerance is too {'fine' if fine else 'coarse'} for this module"
            where = "output.chord_tolerance_mm"
            note = f"the limit is for the module {formatted(self.module)} mm"
            raise beyond_limit(
                what, where, asked, limit, note, near=(1.001 if fine else 0.999) * limit
            )
        return asked


@dataclass(frozen=True, eq=False, kw_only=True)
class Gear(ShortRepr, NotebookView):
    """One wheel of a pair.

    Parameters
    ----------
    pair : GearPair
        The pair it belongs to.
    wheel : {1, 2}
        Driver or driven.
    profile : Outline
        Its outline, with its curves and the ends of its flanks.
    inches : bool
        Whether pins to measure it have simple sizes in inches.
    """

    pair: GearPair
    wheel: Wheel
    profile: Outline
    inches: bool = False

    @property
    def name(self) -> str:
        """``gear1`` or ``gear2``."""
        return f"gear{self.wheel}"

    @property
    def toothing(self) -> Toothing:
        """Centrode, cutter and tooth positions."""
        return self.pair.toothings[self.wheel - 1]

    @property
    def outline(self) -> Array:
        """Vertices of the outline, (n, 2), mm, counter-clockwise, in the wheel's frame."""
        return as_pairs(self.profile.points)

    @property
    def ring(self) -> bool:
        """Whether it is a ring, or a sector of one: its metal is outside its teeth."""
        return self.pair.internal and self.wheel == 2

    @property
    def hollow(self) -> bool:
        """Whether its outline is the edge of a hole: a closed ring."""
        return self.ring and self.toothing.closed

    @cached_property
    def flanks(self) -> Columns:
        """Points on the finished flanks, `FLANK_POINTS` on each (see `flank_points`)."""
        return self.flank_points(FLANK_POINTS)

    @cached_property
    def measuring(self) -> Measuring:
        """What a shop measures on its teeth."""
        from gearcam.gears.measuring import Measuring

        return Measuring(wheel=self.wheel, outline=self.profile, inches=self.inches)

    def flank_points(self, count: int) -> Columns:
        """Return points on the exact finished flanks of all whole teeth.

        Parameters
        ----------
        count : int
            Points on each flank, from root to tip, both ends included: 2 or more.

        Returns
        -------
        Columns
            ``tooth`` from 1; ``side``, +1 where s is larger, else -1; ``point`` from 1 at the root;
            ``x_mm``, ``y_mm`` in the wheel's frame; ``nx``, ``ny``, the outward unit normal of the
            metal; ``curvature_per_mm``, positive where the flank is convex, infinite at a cusp;
            ``reach_mm``, the rack's roll from the pitch curve, positive towards the tip;
            ``phi1_deg``, the driver angle at which the point touches as designed. By tooth, then
            side (+1 first), then from root to tip. Parts removed by clearance, rounding or
            undercut have no points.

        Raises
        ------
        DesignError
            If `count` is not a whole number, or less than 2.
        """
        count = whole("count", count, 2)
        toothing, flanks = self.toothing, self.profile.flanks
        kept = np.flatnonzero(toothing.whole_flanks & (flanks.highest > flanks.lowest))
        tooth = np.tile(np.array(toothing.numbers), 2)[kept]
        order = np.lexsort((-flanks.sigma[kept], tooth))
        kept, tooth = kept[order], tooth[order]
        share = np.linspace(0.0, 1.0, count)
        lowest, highest = flanks.lowest[kept, None], flanks.highest[kept, None]
        reach = (lowest + share * (highest - lowest)).ravel()
        sf, sigma = (np.repeat(values[kept], count) for values in (flanks.sf, flanks.sigma))
        phi1 = toothing.track.angle(sf - sigma * reach)
        frames = toothing.frames(phi1)
        points = toothing.flank_points(frames, sf, sigma)
        normals = sigma * toothing.normals(frames, sigma)
        with np.errstate(divide="ignore"):  # at a cusp
            curvature = frames.kappa / toothing.regularity(frames, sf, sigma)
        return Columns(
            {
                "tooth": np.repeat(tooth, count),
                "side": sigma.astype(np.int64),
                "point": np.tile(np.arange(1, count + 1), len(kept)),
                "x_mm": points.real,
                "y_mm": points.imag,
                "nx": normals.real,
                "ny": normals.imag,
                "curvature_per_mm": curvature,
                "reach_mm": reach,
                "phi1_deg": np.degrees(phi1),
            }
        )

    @cached_property
    def facts(self) -> Facts:
        """Facts of the wheel; docs/summary.md explains their names."""
        return Facts(gear_tree(self), ("teeth",), self.name)

    def picture(self) -> str:
        """Return a drawing of the outline and the centrode, SVG, in the wheel's frame.

        A ring is drawn with one module of metal around its teeth.
        """
        track = self.toothing.track
        phi = np.linspace(0.0, float(track.angle(self.toothing.length)), PICTURED)
        edges: list[Plane] = [self.profile.points]
        if self.hollow:
            spokes: Plane = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, PICTURED))
            edges.append(spokes * (self.largest_radius + self.pair.module))
        return renderer().outlines(
            self.facts.headline,
            edges,
            [self.toothing.frames(phi).p],
            wheel=self.wheel,
            axis=not track.slides,
        )

    @cached_property
    def least_radius(self) -> float:
        """Smallest distance of the outline from the shaft's axis, mm."""
        return float(np.abs(self.profile.points).min())

    @cached_property
    def largest_radius(self) -> float:
        """Largest distance of the teeth from the shaft's axis, mm: for a ring, of its roots."""
        return float(np.abs(self.profile.toothed).max())

    def centrode(self, phi: Array) -> Array:
        """Return points of the centrode at driver angles, rad: (n, 2), mm, in the wheel's frame."""
        return as_pairs(self.toothing.frames(phi).p)


def _shallower(
    rack: BasicRack, given: Rack, x: float, toothing: Callable[[BasicRack], Toothing]
) -> tuple[BasicRack, Toothing]:
    """Return the deepest rack with which the cutter of a ring has no pointed teeth, and the ring.

    The rack as it is where none has.
    """

    def settled(place: int) -> BasicRack:
        return settle_rack(replace(given, dedendum=round(rack.dedendum - place * _DEPTH, 9)), x)

    lowest = max(rack.addendum, least_dedendum(given, x))
    steps = math.floor((rack.dedendum - lowest) / _DEPTH + ROUNDING)
    found = least(lambda place: toothing(settled(place)).cutter.fits, [steps] if steps > 0 else [])
    chosen = settled(found[0]) if found else rack
    return chosen, toothing(chosen)


def make_pair(
    law: RatioLaw,
    spec: PairSpec,
    given: Rack,
    tolerances: Tolerances,
    finish: tuple[Finish, Finish] = (Finish(), Finish()),
    cutter_teeth: float | None = None,
    bar: Bar | None = None,
) -> GearPair:
    """Return the gear pair of a ratio law: centrodes at size, rack and cutters chosen.

    Parameters
    ----------
    law : RatioLaw
        With the lobes that the tooth counts give.
    spec : PairSpec
        Sizes.
    given : Rack
        Given values of the basic rack.
    tolerances : Tolerances
        Inner accuracy.
    finish : (Finish, Finish)
        Clearance and rounding of both wheels' teeth.
    cutter_teeth : float, optional
        Number of teeth of the pinion cutter of a ring.
    bar : Bar, optional
        What a rack is made from.

    Returns
    -------
    GearPair
        The pair; no outline is computed yet.

    Raises
    ------
    InfeasibleError
        If the rack is impossible, or a concave part is too tight for the teeth, or the cutter too
        large for a ring.
    """
    rolling = roll(
        law,
        teeth=spec.teeth,
        center_distance=spec.center_distance,
        module=spec.module,
        tolerances=tolerances,
    )
    if rolling.mate == RACK and spec.center_distance is not None:
        what = "a rack has no shaft, and so no centre distance"
        where = "pair.center_distance_mm"
        note = "give module_mm instead: with the tooth count it sets the size of the wheel"
        raise InfeasibleError(
            what, where=where, value=spec.center_distance, unit="mm", nearest=note
        )
    module = spec.module or rolling.tracks[0].length / (math.pi * spec.teeth[0])
    rack = settle_rack(given, spec.x)
    demand_shift(rack, spec, module)
    demand_clearance(rack, spec, module, finish)

    tracks = tabled(rolling)

    def toothing(wheel: Wheel, rack: BasicRack) -> Toothing:
        track = tracks[wheel - 1]
        pinions: tuple[float, ...] = ()
        if wheel == 2 and rolling.mate == RING and track.concave.radius < math.inf:
            least = float(rolling.curvature_extremes[0][1].min())
            pinions = ring_pinions(1.0 / track.concave.radius, least, module, cutter_teeth)
        cutter = choose_cutter(
            rack,
            module,
            1.0 / track.concave.radius,
            pinions=pinions,
            shift=spec.x if wheel == 1 else -spec.x,
            backlash=spec.backlash,
            clearance=finish[wheel - 1].clearance,
        )
        return Toothing(
            track=track,
            wheel=wheel,
            teeth=spec.teeth[wheel - 1],
            cutter=cutter,
            rounding=finish[wheel - 1].tip_rounding,
            in_gap=track.slides and bar is not None and bar.ends == "gap",
        )

    second = toothing(2, rack)
    if rolling.mate == RING and given.dedendum is None and not second.cutter.fits:
        rack, second = _shallower(rack, given, spec.x, partial(toothing, 2))
        demand_shift(rack, spec, module)
        demand_clearance(rack, spec, module, finish)
    toothings = toothing(1, rack), second
    demand_cutters(*toothings)
    return GearPair(
        rolling=rolling, teeth=spec.teeth, rack=rack, module=module, toothings=toothings
    )


def make_gear(
    pair: GearPair,
    wheel: Wheel,
    tolerance: float,
    tolerances: Tolerances,
    back: RingSpec | Bar | None = None,
) -> Gear:
    """Return one wheel of a pair with its outline.

    Parameters
    ----------
    pair : GearPair
        The pair.
    wheel : {1, 2}
        Which wheel.
    tolerance : float, mm
        Chord tolerance.
    tolerances : Tolerances
        Inner accuracy.
    back : RingSpec or Bar, optional
        Outside of an open ring, by default that of `RingSpec()`; the bar of a rack.

    Returns
    -------
    Gear

    Raises
    ------
    InfeasibleError
        If the wheel would not be in one piece.
    """
    mate = pair.toothings[2 - wheel]
    profile = build_outline(pair.toothings[wheel - 1], mate, tolerance, tolerances, back=back)
    return Gear(pair=pair, wheel=wheel, profile=profile)


def gear_tree(gear: Gear) -> dict[str, Any]:
    """Return the facts of a wheel as a nested dict (see `gearcam.base.facts.Facts`)."""
    cutter, track = gear.toothing.cutter, gear.toothing.track
    convex, concave, straight = track.convex.radius, track.concave.radius, _STRAIGHT * track.length
    pinion = cutter.kind == "pinion"
    return {
        "name": gear.name,
        "internal": True if gear.ring else None,
        "teeth": gear.toothing.teeth,
        "centrode": {
            "length_mm": Fact(gear.toothing.length, "centrode length"),
            "min_convex_radius_mm": convex if convex < straight else None,
            "max_concave_curvature_per_mm": 1.0 / concave if concave < straight else 0.0,
            "closed": gear.toothing.closed,
        },
        "cutter": cutter.kind,
        "cutter_pitch_radius_mm": 1.0 / cutter.kc if pinion else None,
        "cutter_teeth": cutter.teeth if pinion else None,
        "cutter_tip_radius_mm": cutter.tip_radius,
        "undercut_teeth": list(gear.profile.undercut_teeth),
        "tip_thickness_min_mm": float(gear.profile.tip_thickness.min()),
        "root_radius_min_mm": None if gear.ring else gear.least_radius,
        "root_radius_max_mm": gear.largest_radius if gear.ring else None,
        "outline": {
            "vertices": len(gear.outline),
            "least_vertices": gear.profile.sampler.least,
            "area_mm2": gear.profile.contour.area,
            "chord_error_mm": gear.profile.chord_error,
        },
    }


def lobes_of(spec: PairSpec) -> Lobes:
    """Return the numbers of lobes of a pair's wheels: ``z1 : z2`` in lowest terms."""
    common = math.gcd(*spec.teeth)
    z1, z2 = spec.teeth
    return Lobes(z1 // common, z2 // common, RING if spec.type == "internal" else WHEEL)


def leads(pair: GearPair, spec: StepsSpec) -> tuple[float, ...]:
    """Return the tooth offsets of the steps, mm along the pitch curves.

    Parameters
    ----------
    pair : GearPair
        The lowest step.
    spec : StepsSpec
        Count and offset.

    Returns
    -------
    tuple of float
        Reduced to one pitch, since whole pitches change nothing; the first is 0.

    Raises
    ------
    InfeasibleError
        If the wheels are open.
    """
    if spec.count > 1 and not pair.closed:
        what = "open wheels and racks cannot be stepped: their end teeth would leave the blank"
        raise beyond_limit(what, "steps.count", spec.count, 1, "open wheels have one step", near=1)
    pitch = pair.toothings[0].pitch
    offset = pitch / spec.count if spec.offset is None else spec.offset
    return tuple(number * offset % pitch for number in range(spec.count))


def stepped(pair: GearPair, moved: float) -> GearPair:
    """Return the pair with its teeth offset by `moved`, mm (see `leads`)."""
    if moved == 0.0:
        return pair
    first, second = (replace(toothing, moved=moved) for toothing in pair.toothings)
    return replace(pair, toothings=(first, second))
