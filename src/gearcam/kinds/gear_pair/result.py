"""The result of a gear pair: its stages, parts, and tables over driver angles."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import Adjustment, InfeasibleError, beyond_limit
from gearcam.base.findings import Finding, in_order, limit_of, run_checks
from gearcam.base.numerals import formatted
from gearcam.gears import checks  # noqa: F401  (its checks register themselves)
from gearcam.gears.pair import Gear, GearPair, leads, lobes_of, make_gear, make_pair, stepped
from gearcam.gears.rack_limits import demand_rim, demand_ring
from gearcam.gears.spec import Finish
from gearcam.gears.subject import KIND, CheckedPair
from gearcam.gears.track import Wheel
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.kinds.gear_pair.tables import (
    centrode_columns,
    contact_ratio_columns,
    contact_rows,
    motion_columns,
)
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import angle_text, is_open
from gearcam.meshing import drive_checks  # noqa: F401  (its checks register themselves)
from gearcam.meshing.contact import Contacts, contacts
from gearcam.numeric.arguments import angles, one_of, whole
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.piecewise import with_both_sides
from gearcam.numeric.sampling import MARGIN
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.parts.blank import Blank
from gearcam.results.parts import CHORDS, Estimates, PartsResult
from gearcam.results.study import Progress, StudyResult

if TYPE_CHECKING:
    from gearcam.gears.contact import FlankPairs
    from gearcam.numeric.pose import Pose
    from gearcam.parts.body import Part
    from gearcam.parts.checks import CheckedParts
    from gearcam.pictures.drawings import Drawing, Path
    from gearcam.sheets.sheet import Sheet

Side = Literal["drive", "coast"]
"""Flanks of the driver: the driving side and the coast side."""

ROUNDING = 1e-12
"""Share of the travel by which an angle may exceed it: degrees are rounded."""

_OF_TEETH = ("contact-ratio", "undercut", "thin-tip", "short-flank", "tips-collide")
"""Checks whose findings can differ between the steps of stepped wheels."""

_PLAIN = frozenset({"csv", "inspection"})
"""Files that need only the teeth."""

_WHOLE = 1e-9
"""Share of a lobe or travel by which an end may exceed it: rounding."""

CENTRODE_POINTS = 720
"""Intervals of phi1 over which centrodes are tabulated: half degrees for a full turn."""


class GearPairResult(PartsResult):
    """Result of the design of a gear pair, computed on demand.

    Parameters
    ----------
    design : GearPairDesign
        The design.
    tolerances : Tolerances
        Internal accuracy.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/ellipse.toml"))
    >>> x, y = result.gear1.outline.T  # mm
    >>> result.motion([0.0, 6.283185307179586])["phi2_deg"].round(6)
    array([  0., 360.])
    """

    design: GearPairDesign
    before_output = ("law", "pair")
    before_studies = ("steps",)
    stages: ClassVar[Mapping[str, str]] = {
        "law": "law",
        "centrodes": "pair",
        "gear 1": "gear1",
        "gear 2": "gear2",
        "checks": "checked",
    }

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
            gear = make_gear(pair, wheel, tolerance, self.tolerances, self.design.ring)
            if self._too_wide(gear):
                raise self._bore_refusal(gear, tolerance)
            if gear.hollow:
                limit = limit_of(KIND, "thin-rim", self.design.limits) * pair.module
                demand_rim(self.design.ring, gear.largest_radius, pair.module, limit)
            return gear

    def _too_wide(self, gear: Gear) -> bool:
        """Whether the bore of a wheel reaches the root of its teeth."""
        bore = self.bores[gear.wheel - 1]
        return bore is not None and 0.5 * bore >= gear.least_radius

    def _bore_refusal(self, gear: Gear, tolerance: float) -> InfeasibleError:
        """Return the refusal of the bore of a wheel, and of its mate's where that is too wide."""
        wheels, key = [gear], "blank.bore_diameter_mm"
        if gear.wheel == 1:  # the driven wheel has not been made yet
            with suppress(InfeasibleError):
                mate = make_gear(gear.pair, 2, tolerance, self.tolerances, self.design.ring)
                wheels += [mate] * self._too_wide(mate)
        names = [f"{key}[{one.wheel - 1}]" for one in wheels]
        # the limit holds for the circle around bore and keyway
        limits = [2.0 * one.least_radius for one in wheels]
        bores = [self.bores[one.wheel - 1] or 0.0 for one in wheels]
        diameters = [self.design.blank.wheel(one.wheel).bore for one in wheels]
        rim = 2.0 * limit_of(KIND, "thin-rim", self.design.limits) * gear.pair.module
        # the largest bore that keeps the limit of the rim, or without any that meets the roots
        near = [
            diameters[k] - bores[k] + limit - (rim if rim < 0.9 * limit else 0.0)
            for k, limit in enumerate(limits)
        ]
        worst, notes = limits.index(min(limits)), [*map(_room, wheels)]
        where = f"wheel {gear.wheel}, {names[0]}"
        if len(wheels) > 1:
            where = f"wheels 1 and 2, {key}"
            notes.append(f"both take less than {formatted(limits[worst])} mm")
            if diameters[0] == diameters[1]:
                names, near, limits = [key], [min(near)], [limits[worst]]
        if diameters != bores:
            notes.append("limits hold for the circle around bore and keyway")
        what = "the bore reaches the root of the teeth"
        adjustments = (
            Adjustment(
                near=dict(zip(names, near, strict=True)),
                far={name: 0.1 * limit for name, limit in zip(names, limits, strict=True)},
            ),
        )
        return beyond_limit(
            what, where, bores[worst], min(limits), "; ".join(notes), adjustments=adjustments
        )

    @property
    def gears(self) -> tuple[Gear, Gear]:
        """Both wheels, driver first."""
        return self.gear1, self.gear2

    @property
    def bores(self) -> tuple[float | None, float | None]:
        """Bore diameters, mm, including keyways; None for racks and rings."""
        blanks = (self.design.blank.wheel(number).widened for number in (1, 2))
        first, second = (2.0 * blank.bore_reach for blank in blanks)
        return first or None, None if self.pair.on_rack else second or None

    @cached_property
    def checked(self) -> tuple[Finding, ...]:
        """Findings of the checks, errors first."""
        steps, limits = self.steps, self.design.limits
        parts = self.parts_subject if self.ordered else None
        with self.stage("checks"):
            findings = [*run_checks(KIND, self.subject, limits), *self.rows.findings]
            for number, gears in enumerate(steps[1:], start=2):
                findings += (
                    replace(finding, where=f"step {number}, {finding.where}")
                    for finding in run_checks(KIND, self._subject(gears), limits)
                    if finding.code in _OF_TEETH
                )
            if parts is not None:
                findings += run_checks(PARTS_KIND, parts, limits)
        return in_order(findings)

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
    def references(self) -> tuple[Drawing, ...]:
        """The assembled pair, beside the cutting paths."""
        return (self.drawing,)

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

    @cached_property
    def centrode_paths(self) -> tuple[Path, Path]:
        """Both centrodes as chains, each in its wheel's own frame, driver first."""
        from gearcam.kinds.gear_pair.drawings import centrode_path

        lobes = self.law.lobes
        end = self.centrode_angles(2)[-1] if self.pair.on_rack else lobes.n2 * lobes.period
        return (
            centrode_path(self.gear1, lobes.n1 * lobes.period),
            centrode_path(self.gear2, end),
        )

    @cached_property
    def drawing(self) -> Drawing:
        """The assembled pair, with its centrodes."""
        from gearcam.kinds.gear_pair.drawings import pair_drawing

        return pair_drawing(self.parts, self.pair.shift, self.centrode_paths, poses=self.poses)

    @cached_property
    def sheets(self) -> tuple[Sheet, ...]:
        """The workshop drawings of both wheels and of the pair."""
        from gearcam.kinds.gear_pair.sheet import PAIR_ROWS, pair_sheet
        from gearcam.sheets.paper import sheet_rows

        design, pose = self.design, self.design.output.pose
        rows = {"law": design.law_type, **sheet_rows(self.facts, PAIR_ROWS)}
        rows["drawn at phi1"] = f"{formatted(math.degrees(pose))} deg"
        radius = float(abs(self.pair.rolling.tracks[0].frames(np.array([pose])).p[0]))
        pair = pair_sheet(self.drawing, self.pair.shift, rows, design.name, pitch_radius=radius)
        return *super().sheets, pair

    def rows_of(self, number: int) -> Sequence[str]:
        """Return the names of the facts in the table of a wheel's drawing, by its `number`."""
        from gearcam.kinds.gear_pair.sheet import wheel_rows

        return wheel_rows(number)

    def centrode_angles(self, count: int | None = None) -> Array:
        """Return driver angles, rad, until both wheels close, or over the travel, both ends.

        Parameters
        ----------
        count : int, optional
            Number of angles; by default one per half degree of a closed pair.
        """
        lobes, turns = self.law.lobes, 1
        if self.pair.on_rack:
            end = float(self.pair.rolling.arc.angle(np.array(self.gear2.toothing.length)))
        elif not lobes.closed:
            end = lobes.period
        else:
            whole_turns = math.lcm(lobes.n1, lobes.n2)
            turns = max(1, round(whole_turns / lobes.n1))
            end = whole_turns * lobes.period
        return np.linspace(0.0, end, CENTRODE_POINTS * turns + 1 if count is None else count)

    @cached_property
    def phases(self) -> Array:
        """Driver angles, rad, of a turn or the whole travel, at both sides of all knots."""
        return with_both_sides(self.turn(CENTRODE_POINTS), self.knots)

    def turn(self, steps: int) -> Array:
        """Return driver angles, rad, of a turn or the whole travel in `steps`, both ends."""
        closed, law = self.pair.closed, self.law
        end = law.lobes.n1 * law.period if closed else self.centrode_angles(2)[-1]
        return np.linspace(0.0, end, steps + 1)

    @property
    def knots(self) -> Array:
        """Knots of the law, rad, repeated until both wheels close, or to the end of travel."""
        period, knots = self.law.period, np.asarray(self.law.knots, dtype=float)
        lobes = math.ceil(self.centrode_angles(2)[-1] / period * (1.0 - _WHOLE))
        return np.concatenate([knots[:1], *(knots[1:] + lobe * period for lobe in range(lobes))])

    def centrodes(self, n: int | None = None) -> Columns:
        """Return both centrodes: until both wheels close, or over the travel of an open pair.

        Parameters
        ----------
        n : int, optional
            Number of points, both ends included, 2 or more. The default is that of
            ``centrodes.csv``: one per half degree of a closed pair, or 721 over the travel.

        Returns
        -------
        Columns
            ``phi1_deg``, ``phi2_deg``; ``ratio`` i21; ``r1_mm`` and ``r2_mm``, distances of the
            pitch point from both shafts; ``s_mm``, arc length of both; ``rho1_mm``, ``rho2_mm``,
            radii of curvature, negative where concave towards the tips (as on a round ring),
            infinite where straight; ``x1_mm``, ``y1_mm``, ``x2_mm``, ``y2_mm``, points in each
            wheel's own frame. A rack has ``travel_mm`` instead of phi2, ratio and r2. At a knot
            the values after it are returned.

        Raises
        ------
        DesignError
            If `n` is not a whole number, or less than 2.
        InfeasibleError
            If the centrodes cannot be made.
        """
        if n is None:
            return self.whole_centrodes
        return centrode_columns(self.pair, self.centrode_angles(whole("n", n, 2)))

    @cached_property
    def whole_centrodes(self) -> Columns:
        """The default table of `centrodes`."""
        return centrode_columns(self.pair, self.centrode_angles())

    def motion(self, phi1: ArrayLike | None = None) -> Columns:
        """Return the exact motion of the driven element.

        Parameters
        ----------
        phi1 : float or (n,) array, rad, optional
            Driver angles, for open pairs within the travel; by default those of `centrodes`.

        Returns
        -------
        Columns
            ``phi1_deg``; ``phi2_deg``, counted from phi1 = 0 over all turns; ``ratio`` i21; its
            derivatives by phi1 ``acceleration_per_rad`` and ``jerk_per_rad2``. A rack has
            ``travel_mm``, ``velocity_mm_per_rad``, ``acceleration_mm_per_rad2`` and
            ``jerk_mm_per_rad3``. With a speed of the drive also ``speed_rpm`` of the driven wheel,
            ``acceleration_rad_s2`` and ``jerk_rad_s3``; of a rack ``velocity_mm_s``,
            ``acceleration_mm_s2`` and ``jerk_mm_s3``. At a knot the values after it are returned.

        Raises
        ------
        DesignError
            If `phi1` is not an array of finite numbers, or beyond the travel.
        InfeasibleError
            If the law is impossible.
        """
        return motion_columns(self.pair, self._phases(phi1), self.design.drive.speed)

    def contact(self, phi1: ArrayLike | None = None, side: Side = "drive") -> Columns:
        """Return all points of contact of the finished flanks at the design centre distance.

        Parameters
        ----------
        phi1 : float or (n,) array, rad, optional
            Driver angles, for open pairs within the travel; by default those of `centrodes`.
        side : {"drive", "coast"}
            Flanks of the driver: the driving side or the coast side.

        Returns
        -------
        Columns
            A row for each phase and pair of teeth in contact. The rows of one pair are its path of
            contact. ``phi1_deg`` and ``phi2_deg`` (for a rack ``travel_mm``), nominal; ``tooth1``,
            ``tooth2`` from 1; ``side`` of the driver's tooth, -1 drives; ``pairs``, number of pairs
            in contact in this phase; ``x_mm``, ``y_mm``, the point in the fixed frame (driver's
            shaft at 0, driven shaft at the centre distance on x, for a ring at its negative);
            ``force_x``, ``force_y``, unit direction of the driver's force;
            ``contact_radius1_mm``, ``contact_radius2_mm`` from both shafts;
            ``pressure_angle_deg`` of the force to the perpendicular to the line of centres;
            ``sliding_mm_per_rad``, sliding speed along the driver's flank, towards its tip, over
            the driver's speed; ``specific_sliding1``, ``specific_sliding2``;
            ``relative_curvature_per_mm``; ``lag_rad`` (for a rack ``lag_mm``), lag of the driven
            element behind its nominal position when this pair touches.

        Raises
        ------
        DesignError
            If `phi1` is not an array of finite numbers, or beyond the travel, or `side` is unknown.
        InfeasibleError
            If the wheels are impossible.
        """
        pairs, phases = self.flanks_of(side), self._phases(phi1)
        return contact_rows(self.pair, pairs, phases, contacts(pairs, phases))

    def flanks_of(self, side: Side) -> FlankPairs:
        """Return the pairs of flanks of a `side`; DesignError if it is unknown."""
        coast, drive = self.subject.sides
        return drive if one_of("side", side, get_args(Side)) == "drive" else coast

    @cached_property
    def touching(self) -> dict[Side, Contacts]:
        """Contacts of both sides over `phases`."""
        return {side: contacts(self.flanks_of(side), self.phases) for side in get_args(Side)}

    @cached_property
    def centrodes_of_phases(self) -> Columns:
        """The table of `centrodes` over `phases`."""
        same = np.array_equal(self.phases, self.centrode_angles())  # no knots, and one turn
        return self.whole_centrodes if same else centrode_columns(self.pair, self.phases)

    @cached_property
    def paths_of_contact(self) -> dict[Side, Columns]:
        """The tables of `contact` of both sides, over `phases`."""
        return {
            side: contact_rows(self.pair, self.flanks_of(side), self.phases, points)
            for side, points in self.touching.items()
        }

    @cached_property
    def error_rows(self) -> Estimates:
        """Error estimates and their methods by name, without those of chords and files."""
        from gearcam.kinds.gear_pair.parts import tooth_errors, volume_errors

        rows = tooth_errors(self.subject)
        if self.ordered:
            flank, _ = rows["flank_mm"]
            rows |= volume_errors(self.parts, self.steps, self.design, flank, self.tolerances)
        return rows

    @property
    def main_errors(self) -> Sequence[tuple[str, Sequence[str]]]:
        """Errors that users act on (see `Result`)."""
        return (
            ("rack travel", ["travel_mm"])
            if self.pair.on_rack
            else ("driven angle", ["driven_angle_rad"]),
            ("points of the flanks", ["flank_mm"]),
            CHORDS,
            ("contact ratio", ["contact_ratio"]),
            *self.errors_of_parts(),
        )

    @cached_property
    def contact_ratio(self) -> float:
        """Smallest contact ratio of all pairs of flanks, for both directions, as designed."""
        return self.subject.contact_ratio

    @cached_property
    def contact_ratios(self) -> Columns:
        """Contact ratio of every pair of finished flanks, at the design centre distance.

        ``tooth1``, ``tooth2`` from 1; ``side`` of the driver's tooth, first -1 (driving), then +1
        (coast); ``contact_ratio``; ``from_deg``, ``to_deg``, driver angles at start and end of
        contact, nan without contact.
        """
        return contact_ratio_columns(self.subject.sides)

    def _phases(self, phi1: ArrayLike | None) -> Array:
        """Return given driver angles, or by default those of the centrodes."""
        if phi1 is None:
            return self.centrode_angles()
        if self.law.lobes.closed:
            return angles("phi1", phi1)
        end = self.law.period
        return angles("phi1", phi1, 0.0, end, ROUNDING * end)

    def mesh(self, *, progress: Progress | None = None, **settings: object) -> StudyResult:
        """Return the meshing study: contact, interference and backlash, step by step, as mounted.

        Parameters
        ----------
        progress : callable, optional
            Called with a stage's name, the stages or steps done and their number.
        **settings : value
            Keys of the table ``[meshing]``, such as ``steps`` and ``center_distance_mm``, in the
            units of a file; they override those of the design.

        Returns
        -------
        StudyResult
            Its columns are those of ``meshing.csv`` (see docs/summary.md); incomplete if it was
            interrupted.

        Raises
        ------
        DesignError
            If a setting is unknown, or its value is not allowed.
        InfeasibleError
            If the design, or its study, is impossible.
        KeyboardInterrupt
            If it was interrupted before the first steps were done.
        """
        return self.with_settings("meshing", settings).study("mesh", progress)


def _room(gear: Gear) -> str:
    """Return how wide the bore of a wheel may be, and why its root comes so near to the axis."""
    ends = gear.pair.law.ratio_range
    (place, ratio), (_, other) = ends if gear.wheel == 1 else reversed(ends)
    room = f"wheel {gear.wheel} takes less than {formatted(2.0 * gear.least_radius)} mm"
    if math.isclose(ratio, other, rel_tol=_WHOLE):
        return room
    return (
        f"{room}: its teeth come nearest to the axis at {angle_text(place)}, where the law's ratio "
        f"is {formatted(ratio)}"
    )


def _demand_reached(pose: float, law: RatioLaw) -> None:
    """Refuse to draw an open pair at a driver angle, rad, outside its travel."""
    if law.lobes.closed or 0.0 <= pose <= (1.0 + _WHOLE) * law.period:
        return
    key, limit = "output.phi1_deg", math.degrees(min(max(pose, 0.0), law.period))
    what = "the drawing angle lies outside the driver's travel"
    note = f"the driver turns from 0 to {formatted(math.degrees(law.period))} deg"
    raise beyond_limit(
        what, key, math.degrees(pose), limit, note, far=0.5 * math.degrees(law.period)
    )
