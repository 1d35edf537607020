"""A gear pair as its design says: law, centrodes, wheels and parts, on demand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Final

from gearcam.base.errors import beyond_limit
from gearcam.base.findings import limit_of
from gearcam.base.numerals import formatted
from gearcam.gears.pair import Gear, GearPair, leads, lobes_of, make_gear, make_pair, stepped
from gearcam.gears.rack_limits import demand_rim, demand_ring
from gearcam.gears.spec import Finish
from gearcam.gears.subject import KIND, CheckedPair
from gearcam.gears.track import Wheel
from gearcam.kinds.gear_pair.bores import Bores, demand_bore
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import is_open
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

WHOLE: Final = 1e-9
"""Share of a lobe or travel by which an end may exceed it: rounding."""


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
        """The ratio law."""
        parameters, pair = self.design.law, self.design.pair
        with self.stage("law"), self.rows.named():
            if not is_open(parameters):
                demand_ring(pair)
            law = parameters.build(lobes_of(pair), self.tolerances)
            _demand_reached(self.design.output.pose, law)
        return law

    @cached_property
    def pair(self) -> GearPair:
        """The centrodes with their cutters."""
        law = self.law
        with self.stage("centrodes"), self.rows.named():
            return make_pair(
                law,
                self.design.pair,
                self.design.rack,
                self.tolerances,
                self._finish,
                self.design.ring.cutter_teeth,
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
        """The driver."""
        return self._gear(1, self.pair)

    @cached_property
    def gear2(self) -> Gear:
        """The driven wheel."""
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
        return make_gear(pair, wheel, tolerance, self.tolerances, self.design.ring)

    @property
    def gears(self) -> tuple[Gear, Gear]:
        """Both wheels, driver first."""
        return self.gear1, self.gear2

    @property
    def bores(self) -> Bores:
        """Bore diameters, mm, including keyways; None for racks and rings."""
        blanks = (self.design.blank.wheel(number).widened for number in (1, 2))
        first, second = (2.0 * blank.bore_reach for blank in blanks)
        return first or None, None if self.pair.on_rack else second or None

    @cached_property
    def subject(self) -> CheckedPair:
        """Input of the checks of teeth; for stepped wheels the lowest step."""
        return self._subject(self.gears)

    def _subject(self, gears: tuple[Gear, Gear]) -> CheckedPair:
        rim = None
        if gears[1].ring:
            rim = self.design.ring.least_rim(gears[1].largest_radius, self.pair.module)
        return CheckedPair(pair=gears[0].pair, gears=gears, bores=self.bores, rim=rim)

    @cached_property
    def parts_subject(self) -> CheckedParts:
        """Input of the checks of parts."""
        from gearcam.kinds.gear_pair.parts import parts_subject

        return parts_subject(self.parts, self.gears, self.design.output.kerf)

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
        """Both wheels as parts, with openings, hubs, marks, clearance and rounded edges."""
        from gearcam.kinds.gear_pair.parts import make_parts

        _ = self.steps  # timed separately
        with self.stage("parts"):
            return make_parts(self.steps, self.design)

    @property
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

        return wheel_rows(number)

    @cached_property
    def error_rows(self) -> Estimates:
        """Error estimates and their methods by name, without those of chords and files."""
        from gearcam.kinds.gear_pair.parts import tooth_errors, volume_errors

        rows = tooth_errors(self.subject)
        if self.ordered:
            flank, _ = rows["flank_mm"]
            rows |= volume_errors(self.parts, self.steps, self.design, flank, self.tolerances)
        return rows


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
