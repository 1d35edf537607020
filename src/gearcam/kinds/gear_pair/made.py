"""A gear pair as its design says: law, centrodes, wheels and parts, on demand."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Final, TypeAlias

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.findings import limit_of
from gearcam.base.numerals import formatted
from gearcam.designs.outputs import DRAWINGS
from gearcam.gears.pair import Gear, GearPair, leads, lobes_of, make_gear, make_pair, stepped
from gearcam.gears.rack_limits import demand_rim, demand_ring
from gearcam.gears.spec import Finish
from gearcam.gears.subject import KIND, CheckedPair
from gearcam.gears.track import Wheel
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import angle_text, is_open
from gearcam.numeric.sampling import MARGIN
from gearcam.parts.blank import Blank
from gearcam.results.parts import Estimates, PartsResult

if TYPE_CHECKING:
    from gearcam.numeric.pose import Pose
    from gearcam.parts.body import Part
    from gearcam.parts.checks import CheckedParts
    from gearcam.pictures.drawings import Drawing

_PLAIN: Final = frozenset({"csv", "inspection"})
"""Files that need only the teeth."""

_OF_SHOP: Final = frozenset({"inspection", *DRAWINGS})
"""Files that say what is measured."""

WHOLE: Final = 1e-9
"""Share of a lobe, travel or ratio that is rounding."""

Bores: TypeAlias = tuple[float | None, float | None]
"""Diameters, mm, of both wheels, including keyways; None of what has no bore."""

_BORE: Final = "blank.bore_diameter_mm"


class MadePair(PartsResult):
    """A gear pair with its parts, computed on demand (see `GearPairResult`).

    Parameters
    ----------
    design : GearPairDesign
        The design.
    tolerances : Tolerances
        Internal accuracy.
    """

    design: GearPairDesign
    before_output = ("law", "pair")
    before_studies = ("steps",)

    @cached_property
    def law(self) -> RatioLaw:
        """The ratio law.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> low, high = result.law.ratio_range  # each with the driver angle, rad
        >>> round(low[1], 4), round(high[1], 4)
        (0.5385, 1.8571)
        """
        parameters, pair = self.design.law, self.design.pair
        with self.stage("law"), self.rows.named():
            if not is_open(parameters):
                demand_ring(pair)
            built = parameters.build(lobes_of(pair), self.tolerances)
            law = replace(built, name=self.design.law_type)
            _demand_reached(self.design.output.pose, law)
        return law

    @cached_property
    def pair(self) -> GearPair:
        """The centrodes with their cutters.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> result.pair.module, result.pair.teeth
        (1.0, (41, 41))
        >>> round(result.pair.center_distance, 4)
        41.9607
        """
        law = self.law
        with self.stage("centrodes"), self.rows.named():
            return make_pair(
                law,
                self.design.pair,
                self.design.rack,
                self.tolerances,
                self._finish,
                self.design.ring.cutter_teeth,
                self.design.bar,
            )

    @property
    def _finish(self) -> tuple[Finish, Finish]:
        """Clearance and rounding of both wheels' teeth."""
        blanks = (self.design.blank.wheel(number) for number in (1, 2))
        first, second = (
            Finish(clearance=blank.clearance, tip_rounding=blank.tip_rounding) for blank in blanks
        )
        return first, second

    @cached_property
    def gear1(self) -> Gear:
        """The driver.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> result.gear1.outline.shape[1], result.pair.teeth[0]
        (2, 41)
        """
        return self._gear(1, self.pair)

    @cached_property
    def gear2(self) -> Gear:
        """The driven wheel.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> x, y = result.gear2.outline.T  # mm, its shaft at (0, 0)
        >>> bool(x.max() > 0)
        True
        """
        return self._gear(2, self.pair)

    @cached_property
    def steps(self) -> tuple[tuple[Gear, Gear], ...]:
        """Both wheels of each step, from below; one step where the wheels are not stepped."""
        pairs = [stepped(self.pair, moved) for moved in self.leads]
        return self.gears, *((self._gear(1, pair), self._gear(2, pair)) for pair in pairs[1:])

    @property
    def leads(self) -> tuple[float, ...]:
        """Tooth offsets of the steps, mm along the pitch curves."""
        return leads(self.pair, self.design.steps)

    def _gear(self, wheel: Wheel, pair: GearPair) -> Gear:
        with self.stage(f"gear{wheel}"):
            tolerance = pair.chord_tolerance(self.design.output.chord_tolerance)
            gear = self._made(wheel, pair, tolerance)
            demand_bore(gear, self.bores, self.design, lambda: self._made(2, pair, tolerance))
            if gear.hollow:
                limit = limit_of(KIND, "thin-rim", self.design.limits) * pair.module
                demand_rim(self.design.ring, gear.largest_radius, pair.module, limit)
            return gear

    def _made(self, wheel: Wheel, pair: GearPair, tolerance: float) -> Gear:
        """Return a wheel as it would be without bore and rim, at a chord `tolerance`, mm."""
        gear = make_gear(pair, wheel, tolerance, self.tolerances, self.design.back)
        return replace(gear, inches=self.design.units == "inch")

    @property
    def gears(self) -> tuple[Gear, Gear]:
        """Both wheels, driver first.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> [gear.wheel for gear in result.gears]
        [1, 2]
        """
        return self.gear1, self.gear2

    @property
    def bores(self) -> Bores:
        """Bore diameters, mm, including keyways; None for racks and rings."""
        blanks = (self.design.blank.wheel(number).widened for number in (1, 2))
        first, second = (2.0 * blank.bore_reach for blank in blanks)
        return first or None, None if self.pair.on_rack else second or None

    @property
    def pins(self) -> tuple[float | None, float | None] | None:
        """Diameters of the pins with which both wheels are measured, mm; None where none is asked.

        A diameter that is None is the recommended one.
        """
        output = self.design.output
        asked = output.pin_diameter is not None or not _OF_SHOP.isdisjoint(output.files)
        return (output.pin_diameter or (None, None)) if asked else None

    @cached_property
    def subject(self) -> CheckedPair:
        """Input of the checks of teeth; for stepped wheels the lowest step."""
        return self._subject(self.gears)

    def _subject(self, gears: tuple[Gear, Gear]) -> CheckedPair:
        rim = None
        if gears[1].ring:
            rim = self.design.ring.least_rim(gears[1].largest_radius, self.pair.module)
        across = self.design.ring.outer_diameter is not None
        return CheckedPair(
            pair=gears[0].pair,
            gears=gears,
            bores=self.bores,
            rim=rim,
            across=across,
            pins=self.pins,
        )

    @cached_property
    def parts_subject(self) -> CheckedParts:
        """Input of the checks of parts."""
        from gearcam.kinds.gear_pair.parts import parts_subject

        kerf, sought = self.design.output.kerf, not self.drafted
        made = parts_subject(self.parts, self.gears, kerf, sought=sought)
        return replace(made, step="step" in self.design.output.files)

    @property
    def ordered(self) -> bool:
        """Whether the design needs parts: a blank, files of parts, an outside that follows roots.

        Whether such an outside is possible is known only when it is made; for a round one the rim
        decides.
        """
        asked = self.design.blank != Blank() or self.design.ring.outer == "follow"
        return asked or not set(self.design.output.files) <= _PLAIN

    @cached_property
    def parts(self) -> tuple[Part, Part]:
        """Both wheels as parts, with openings, hubs, marks, clearance and rounded edges.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> [(part.name, part.width) for part in result.parts]
        [('gear1', 10.0), ('gear2', 10.0)]
        """
        from gearcam.kinds.gear_pair.parts import make_parts

        _ = self.steps  # timed separately
        with self.stage("parts"):
            return make_parts(self.steps, self.design)

    @cached_property
    def plates(self) -> tuple[Drawing, ...]:
        """A drawing of each step of both wheels, in its own frame."""
        from gearcam.pictures.drawings import wheel_drawing

        return tuple(
            wheel_drawing(part, step) for part in self.parts for step in range(len(part.contours))
        )

    @property
    def assembly(self) -> str:
        """Stem of the files of the assembled pair."""
        return "pair"

    @property
    def poses(self) -> tuple[Pose, Pose]:
        """Where the wheels are in the assembly: wheel 1 turned by -phi1."""
        return self.pair.rolling.poses(self.design.output.pose)

    @property
    def profile_tolerance(self) -> float:
        """Chord tolerance of the outlines, mm."""
        return self.gear1.profile.tolerance

    @property
    def chord_error(self) -> float:
        """Largest chord error of the outlines, mm."""
        # the largest distance from a chord may lie between the places where it is measured
        return max(gear.profile.chord_error for gear in self.gears) / MARGIN

    def rows_of(self, number: int) -> Sequence[str]:
        """Return the names of the facts in the table of a wheel's drawing, by its `number`."""
        from gearcam.kinds.gear_pair.sheet import wheel_rows

        return wheel_rows(number, self.facts)

    @cached_property
    def error_rows(self) -> Estimates:
        """Error estimates and their methods by name, without those of chords and files."""
        from gearcam.kinds.gear_pair.parts import tooth_errors, volume_errors

        rows = tooth_errors(self.subject)
        if self.ordered:
            flank, _ = rows["flank_mm"]
            rows |= volume_errors(self.parts, self.steps, self.design, flank, self.tolerances)
        return rows


def demand_bore(
    gear: Gear, bores: Bores, design: GearPairDesign, driven: Callable[[], Gear]
) -> None:
    """Refuse a bore that reaches the roots of a wheel, and that of its mate if it does, too.

    Parameters
    ----------
    gear : Gear
        The wheel.
    bores : two float or None, mm
        Bore diameters of both wheels.
    design : GearPairDesign
        The design.
    driven : callable
        ``driven()`` returns the driven wheel, which is made after the driver.

    Raises
    ------
    InfeasibleError
        With the largest bores.
    """
    if not _too_wide(gear, bores):
        return
    wheels = [gear]
    if gear.wheel == 1:
        with suppress(InfeasibleError):
            mate = driven()
            wheels += [mate] * _too_wide(mate, bores)
    names = [f"{_BORE}[{one.wheel - 1}]" for one in wheels]
    # the limit holds for the circle around bore and keyway
    limits = [2.0 * one.least_radius for one in wheels]
    given = [bores[one.wheel - 1] or 0.0 for one in wheels]
    diameters = [design.blank.wheel(one.wheel).bore for one in wheels]
    rim = 2.0 * limit_of(KIND, "thin-rim", design.limits) * gear.pair.module
    # the largest bore that keeps the limit of the rim, or without any that meets the roots
    near = [
        diameters[k] - given[k] + limit - (rim if rim < 0.9 * limit else 0.0)
        for k, limit in enumerate(limits)
    ]
    worst, notes = limits.index(min(limits)), [*map(_room, wheels)]
    where = f"wheel {gear.wheel}, {names[0]}"
    if len(wheels) > 1:
        where = f"wheels 1 and 2, {_BORE}"
        notes.append(f"both take less than {formatted(limits[worst])} mm")
        if diameters[0] == diameters[1]:
            names, near, limits = [_BORE], [min(near)], [limits[worst]]
    if diameters != given:
        notes.append("limits hold for the circle around bore and keyway")
    what = "the bore reaches the root of the teeth"
    adjustments = (
        Adjustment(
            near=dict(zip(names, near, strict=True)),
            far={name: 0.1 * limit for name, limit in zip(names, limits, strict=True)},
        ),
    )
    raise beyond_limit(
        what, where, given[worst], min(limits), "; ".join(notes), adjustments=adjustments
    )


def _too_wide(gear: Gear, bores: Bores) -> bool:
    bore = bores[gear.wheel - 1]
    return bore is not None and 0.5 * bore >= gear.least_radius


def _room(gear: Gear) -> str:
    """Return how wide the bore of a wheel may be, and why its root comes so near to the axis."""
    ends = gear.pair.law.ratio_range
    (place, ratio), (_, other) = ends if gear.wheel == 1 else reversed(ends)
    room = f"wheel {gear.wheel} takes less than {formatted(2.0 * gear.least_radius)} mm"
    if math.isclose(ratio, other, rel_tol=WHOLE):
        return room
    return (
        f"{room}: its teeth come nearest to the axis at {angle_text(place)}, where the law's ratio "
        f"is {formatted(ratio)}"
    )


def _demand_reached(pose: float, law: RatioLaw) -> None:
    """Refuse to draw an open pair at a driver angle, rad, outside its travel."""
    if law.lobes.closed or 0.0 <= pose <= (1.0 + WHOLE) * law.period:
        return
    key, limit = "output.phi1_deg", math.degrees(min(max(pose, 0.0), law.period))
    what = "the drawing angle lies outside the driver's travel"
    note = f"the driver turns from 0 to {formatted(math.degrees(law.period))} deg"
    raise beyond_limit(
        what, key, math.degrees(pose), limit, note, far=0.5 * math.degrees(law.period)
    )
