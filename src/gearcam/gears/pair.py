"""The pair: two wheels on their shafts, and which of their flanks touch.

Wheel 1's flank at `sf` with side `sigma` touches wheel 2's flank of the same `sf` and the opposite
side, at every roll s that lies in the reach of both: ``w1 = sigma*(sf - s)`` and ``w2 = -w1``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcam.errors import InfeasibleError, Way
from gearcam.gears.bound import demand_cutters
from gearcam.gears.cutter import choose_cutter
from gearcam.gears.demands import demand_shift, settle_rack
from gearcam.gears.flank import Toothing
from gearcam.gears.outline import Outline, build_outline
from gearcam.gears.rolling import Rolling, Wheel, roll
from gearcam.gears.spec import BasicRack, PairSpec, Rack
from gearcam.laws.base import RatioLaw
from gearcam.laws.span import Lobes
from gearcam.numeric.bulges import as_pairs
from gearcam.tolerances import Tolerances

Array = NDArray[np.float64]

FINEST = 1e-9
"""Smallest tolerance of an outline, in modules: finer ones would be lost in rounding."""

COARSEST = 1.0 / 50.0
"""Coarsest tolerance of an outline, in modules: beyond it teeth are no longer teeth."""


@dataclass(frozen=True, eq=False, kw_only=True)
class GearPair:
    """Two centrodes with their cutters and tooth places.

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
        """Distance of the shafts, mm; of a rack, what the law's radius is multiplied by."""
        return self.rolling.center_distance

    @property
    def shift(self) -> float:
        """Place of wheel 2's frame in that of wheel 1 at phi1 = 0, mm along x."""
        return 0.0 if self.law.feeds else self.center_distance

    @property
    def studied(self) -> bool:
        """Whether both wheels go all around, as meshing studies ask."""
        return all(toothing.closed for toothing in self.toothings)

    def chord_tolerance(self, asked: float | None) -> float:
        """Return the tolerance of the outlines, mm: as asked, or ``min(0.001 mm, m/1000)``.

        Raises
        ------
        InfeasibleError
            If it is coarser than m/50 or too fine for double precision.
        """
        if asked is None:
            return min(1e-3, self.module / 1000.0)
        low, high = FINEST * self.module, COARSEST * self.module
        if not low <= asked <= high:
            fine = asked < low
            limit = low if fine else high
            raise InfeasibleError(
                f"the chord tolerance is too {'fine' if fine else 'coarse'} for this module",
                where="output.chord_tolerance_mm",
                value=asked,
                limit=limit,
                unit="mm",
                nearest=f"the limit is for the module {self.module:.6g} mm",
                ways=(Way(near={"output.chord_tolerance_mm": (1.001 if fine else 0.999) * limit}),),
            )
        return asked


@dataclass(frozen=True, eq=False, kw_only=True)
class Gear:
    """One wheel.

    Parameters
    ----------
    pair : GearPair
        The pair it belongs to.
    wheel : {1, 2}
        Driver or driven.
    profile : Outline
        Its outline with all that is known of it.
    """

    pair: GearPair
    wheel: Wheel
    profile: Outline

    @property
    def name(self) -> str:
        """``gear1`` or ``gear2``."""
        return f"gear{self.wheel}"

    @property
    def toothing(self) -> Toothing:
        """Centrode, cutter and tooth places."""
        return self.pair.toothings[self.wheel - 1]

    @property
    def outline(self) -> Array:
        """Vertices of the outline, (n, 2), mm, counter-clockwise, in the wheel's frame."""
        return self.profile.points

    @cached_property
    def least_radius(self) -> float:
        """Smallest distance of the outline from the axis, mm."""
        x, y = self.outline.T
        return float(np.hypot(x, y).min())

    @property
    def convex_radius(self) -> float:
        """Smallest convex radius of the centrode, mm; infinite where it has no convex part."""
        largest = float(self.curvatures.max())
        return 1.0 / largest if largest > 0.0 else math.inf

    @property
    def concave_curvature(self) -> float:
        """Largest concave curvature of the centrode, 1/mm; 0 for a convex one."""
        return max(0.0, -float(self.curvatures.min()))

    @property
    def concave_radius(self) -> float:
        """Smallest concave radius of the centrode, mm; infinite where it has no concave part."""
        curvature = self.concave_curvature
        return 1.0 / curvature if curvature > 0.0 else math.inf

    @property
    def curvatures(self) -> Array:
        """All extremes of the centrode's curvature, 1/mm."""
        return self.pair.rolling.curvature_extremes(self.wheel)[1]

    @property
    def curvature_places(self) -> Array:
        """Driver angles of `curvatures`, rad."""
        return self.pair.rolling.curvature_extremes(self.wheel)[0]

    def centrode(self, phi: Array) -> Array:
        """Return points of the centrode at driver angles, rad: (n, 2), mm, in the wheel's frame."""
        return as_pairs(self.toothing.frames(phi).p)


def make_pair(law: RatioLaw, spec: PairSpec, asked: Rack, tolerances: Tolerances) -> GearPair:
    """Put a law on two shafts.

    Parameters
    ----------
    law : RatioLaw
        For the lobes of the tooth counts.
    spec : PairSpec
        Sizes.
    asked : Rack
        Basic rack as it is asked for.
    tolerances : Tolerances
        Inner accuracy.

    Returns
    -------
    GearPair
        With cutters chosen, nothing cut yet.

    Raises
    ------
    InfeasibleError
        If the rack cannot be made, or a concave part is too tight for the teeth.
    """
    if law.feeds and spec.center_distance is not None:
        raise InfeasibleError(
            "a rack has no shaft",
            where="pair.center_distance_mm",
            value=spec.center_distance,
            unit="mm",
            nearest="module_mm is given instead: with the tooth count it is the size of the wheel",
        )
    rolling = roll(
        law,
        teeth=spec.teeth,
        center_distance=spec.center_distance,
        module=spec.module,
        tolerances=tolerances,
    )
    module = spec.module or rolling.length(1) / (math.pi * spec.teeth[0])
    rack = settle_rack(asked, spec.x)
    demand_shift(rack, spec, module)

    def toothing(wheel: Wheel) -> Toothing:
        concave = -float(rolling.curvature_extremes(wheel)[1].min())
        cutter = choose_cutter(
            rack,
            module,
            concave,
            shift=spec.x if wheel == 1 else -spec.x,
            backlash=spec.backlash,
        )
        return Toothing(
            rolling=rolling,
            wheel=wheel,
            teeth=spec.teeth[wheel - 1],
            cutter=cutter,
            closed=law.lobes.closed and not (law.feeds and wheel == 2),
        )

    toothings = toothing(1), toothing(2)
    demand_cutters(*toothings)
    return GearPair(
        rolling=rolling, teeth=spec.teeth, rack=rack, module=module, toothings=toothings
    )


def make_gear(pair: GearPair, wheel: Wheel, tolerance: float, tolerances: Tolerances) -> Gear:
    """Cut a wheel.

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

    Returns
    -------
    Gear

    Raises
    ------
    InfeasibleError
        If the wheel does not stay in one piece.
    """
    mate = pair.toothings[2 - wheel]
    profile = build_outline(pair.toothings[wheel - 1], mate, tolerance, tolerances)
    return Gear(pair=pair, wheel=wheel, profile=profile)


def lobes_of(teeth: tuple[int, int]) -> Lobes:
    """Return the lobes of tooth counts: ``z1 : z2`` in lowest terms."""
    common = math.gcd(*teeth)
    return Lobes(teeth[0] // common, teeth[1] // common)


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactArcs:
    """Where the flanks of one side touch: one entry a flank of wheel 1's first lobe.

    Parameters
    ----------
    start, end : (q,) arrays, mm
        Roll s between which the flank is in contact, start < end; empty where start >= end.
    tooth : (q,) int array
        Number of its tooth.
    pitch, lobe_length : float, mm
        Pitch and length of the lobe, or of an open pair's centrode.
    closed : bool
        Whether it repeats.
    """

    start: Array
    end: Array
    tooth: NDArray[np.int64]
    pitch: float
    lobe_length: float
    closed: bool

    @property
    def ratios(self) -> Array:
        """Contact ratio of each flank: arc of contact over the pitch; 0 where there is none."""
        return np.maximum(self.end - self.start, 0.0) / self.pitch

    @cached_property
    def gaps(self) -> tuple[tuple[float, float], ...]:
        """Stretches of roll within the lobe on which no flank touches, mm."""
        shifts = (-1, 0, 1) if self.closed else (0,)
        lengths = np.concatenate([self.end - self.start] * len(shifts))
        starts = np.concatenate([self.start + k * self.lobe_length for k in shifts])
        if not self.closed:  # nothing is asked for beyond the ends
            outside = self.lobe_length * np.array([-1.0, 1.0])
            starts, lengths = np.append(starts, outside), np.append(lengths, [self.lobe_length] * 2)
        alive = lengths > 0.0
        order = np.argsort(starts[alive])
        low, high = starts[alive][order], (starts + lengths)[alive][order]
        if low.size == 0:
            return ((0.0, self.lobe_length),)
        covered = np.maximum.accumulate(high)
        holes = np.flatnonzero(low[1:] > covered[:-1] + 1e-9 * self.pitch)
        found = [(float(covered[k]), float(low[k + 1])) for k in holes]
        return tuple(gap for gap in found if 0.0 <= gap[0] < self.lobe_length)


def contact_arcs(gear1: Gear, gear2: Gear, sigma: int) -> ContactArcs:
    """Return where the flanks of one side touch.

    Parameters
    ----------
    gear1, gear2 : Gear
        The wheels.
    sigma : {+1, -1}
        Side of wheel 1's flanks.

    Returns
    -------
    ContactArcs
        Over one lobe.
    """
    first, second = gear1.profile.flanks, gear2.profile.flanks
    one, two = _mates(gear1, gear2, sigma)
    sf = first.sf[one] if gear2.toothing.closed else second.sf[two]
    low = np.maximum(first.lowest[one], -second.highest[two])
    high = np.minimum(first.highest[one], -second.lowest[two])
    ends = np.stack([sf - sigma * low, sf - sigma * high])
    start, end = (ends[1], ends[0]) if sigma > 0 else (ends[0], ends[1])
    numbers = np.array(gear1.toothing.numbers)
    return ContactArcs(
        start=start,
        end=end,
        tooth=numbers[one % len(numbers)],
        pitch=gear1.toothing.pitch,
        lobe_length=gear1.pair.rolling.lobe_length
        if gear2.toothing.closed
        else gear2.toothing.length,
        closed=gear2.toothing.closed,
    )


def _mates(gear1: Gear, gear2: Gear, sigma: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Numbers of the flanks of both wheels that touch each other, by wheel 1's teeth."""
    z1, z2 = len(gear1.toothing.numbers), len(gear2.toothing.numbers)
    if gear2.toothing.closed:
        count = math.gcd(z1, z2)
        one = np.arange(count) + (0 if sigma > 0 else z1)
        # sf = (j + sigma/4) pitches on wheel 1 is (k + 1/2 - sigma/4) pitches on wheel 2.
        two = (np.arange(count) + (0 if sigma > 0 else -1)) % z2 + (z2 if sigma > 0 else 0)
        return one, two
    start, end = gear2.toothing.ends
    two = np.arange(z2) + (z2 if sigma > 0 else 0)
    places = gear2.profile.flanks.sf[two]
    two = two[(places > start) & (places < end)]
    tooth = np.rint(gear2.profile.flanks.sf[two] / gear2.toothing.pitch - 0.25 * sigma).astype(int)
    one = tooth % z1 if gear1.toothing.closed else tooth + 1 - gear1.toothing.numbers[0]
    return one + (0 if sigma > 0 else z1), two
