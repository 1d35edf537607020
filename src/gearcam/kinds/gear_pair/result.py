"""The result of a gear pair: tables over driver angles, drawings, findings."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.findings import Finding, in_order, run_checks
from gearcam.base.inches import files_in
from gearcam.base.numerals import FEW, formatted
from gearcam.gears import checks  # noqa: F401  (its checks register themselves)
from gearcam.gears.subject import KIND
from gearcam.gears.track import Wheel
from gearcam.kinds.gear_pair.made import WHOLE, MadePair
from gearcam.kinds.gear_pair.tables import (
    centrode_columns,
    contact_ratio_columns,
    contact_rows,
    motion_columns,
)
from gearcam.meshing import drive_checks  # noqa: F401  (its checks register themselves)
from gearcam.meshing.contact import Contacts, contacts
from gearcam.numeric.arguments import angles, one_of, refused, whole
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.piecewise import with_both_sides
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.results.parts import CHORDS
from gearcam.results.study import Progress, StudyResult
from gearcam.results.study_help import with_studies

if TYPE_CHECKING:
    from gearcam.gears.contact import FlankPairs
    from gearcam.pictures.drawings import Drawing, Path
    from gearcam.sheets.sheet import Sheet
    from gearcam.sheets.wheel import Teeth

Side = Literal["drive", "coast"]
"""Flanks of the driver: the driving side and the coast side."""

ROUNDING = 1e-12
"""Share of the travel by which an angle may exceed it: degrees are rounded."""

_OF_TEETH = ("contact-ratio", "undercut", "thin-tip", "short-flank", "tips-collide")
"""Checks whose findings can differ between the steps of stepped wheels."""

CENTRODE_POINTS = 720
"""Intervals of phi1 over which centrodes are tabulated: half degrees for a full turn."""


@with_studies("gear-pair")
class GearPairResult(MadePair):
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

    for_users = (
        "centrodes", "contact", "contact_ratio", "contact_ratios", "gear1", "gear2", "gears",
        "law", "measures", "mesh", "motion", "pair", "span",
    )  # fmt: skip

    stages: ClassVar[Mapping[str, str]] = {
        "law": "law",
        "centrodes": "pair",
        "gear 1": "gear1",
        "gear 2": "gear2",
        "checks": "checked",
    }

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

    @property
    def place_of_solids(self) -> str:
        """Where a page shows the solids (see `Result`): first those of wheels on tilted axes."""
        return "first" if any(self.design.errors.tilt) else "after"

    @property
    def references(self) -> tuple[Drawing, ...]:
        """The assembled pair, beside the cutting paths."""
        return (self.drawing,)

    @property
    def centrode_ends(self) -> tuple[float, float]:
        """Driver angles at which both centrodes end, rad."""
        lobes = self.law.lobes
        end = self.centrode_angles(2)[-1] if self.pair.on_rack else lobes.n2 * lobes.period
        return lobes.n1 * lobes.period, float(end)

    @cached_property
    def centrode_paths(self) -> tuple[Path, Path]:
        """Both centrodes as chains, each in its wheel's own frame, driver first."""
        from gearcam.kinds.gear_pair.drawings import centrode_path

        first, second = map(centrode_path, self.gears, self.centrode_ends)
        return first, second

    @property
    def printed(self) -> tuple[Drawing, ...]:
        """The steps of both wheels with their centrodes (see `PartsResult.printed`)."""
        from gearcam.pictures.drawings import CENTRODE, Feature

        paths = (path for path in self.centrode_paths for _ in self.steps)
        curves = (Feature(layer=CENTRODE, shape=path) for path in paths)
        return tuple(
            replace(one, features=(*one.features, curve))
            for one, curve in zip(self.plates, curves, strict=True)
        )

    def teeth(self, number: int) -> Teeth:
        """Return the teeth in front of a wheel (see `PartsResult.teeth`)."""
        from gearcam.kinds.gear_pair.sheet import teeth_of

        return teeth_of(self.steps[-1][number], self.centrode_ends[number])

    def data(self, number: int) -> dict[str, str]:
        """Return the data of a wheel, with its mate (see `PartsResult.data`)."""
        from gearcam.kinds.gear_pair.sheet import MOST_SPANS, spans_of

        other, rows = 1 - number, super().data(number)
        spans = len(spans_of(number, self.facts))
        if spans > MOST_SPANS:
            rows["spans"] = f"{spans} places, in measures.csv"
        name = self.heading(other).part_number or self.parts[other].name
        return {**rows, "mates with": f"{name}, {self.pair.teeth[other]} teeth"}

    def notes(self, number: int) -> list[str]:
        """Return notes on a wheel and its measures (see `PartsResult.notes`)."""
        from gearcam.kinds.gear_pair.sheet import counted

        nominal = ["Measures over pins, chords and spans are nominal."] if self.pins else []
        return [*super().notes(number), counted(self.gears[number]), *nominal]

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
        radius = float(abs(self.pair.rolling.tracks[0].frames(np.array([pose])).p[0]))
        heading = self.heading(None)
        names = [self.heading(n).part_number or part.name for n, part in enumerate(self.parts)]
        with files_in(design.files_in):
            rows = {"law": design.law_type, **sheet_rows(self.facts, PAIR_ROWS)}
            rows["drawn at phi1"] = f"{formatted(math.degrees(pose), FEW)} deg"
            drawing, shift = self.drawing, self.pair.shift
            pair = pair_sheet(drawing, shift, rows, heading, names, pitch_radius=radius)
        return *super().sheets, pair

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
        lobes = math.ceil(self.centrode_angles(2)[-1] / period * (1.0 - WHOLE))
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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> columns = result.centrodes(5)
        >>> columns["r1_mm"].round(3)
        array([14.686, 19.092, 27.274, 19.092, 14.686])
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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> result.motion([0.0, 3.141592653589793])["ratio"].round(4)
        array([0.5385, 1.8571])
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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> columns = result.contact([0.0])  # a row for each pair of teeth that touches
        >>> columns["tooth1"], columns["pressure_angle_deg"].round(6)
        (array([1, 2]), array([20., 20.]))
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
        """Smallest contact ratio of all pairs of flanks, for both directions, as designed.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> round(result.contact_ratio, 4)
        1.7047
        """
        return self.subject.contact_ratio

    @cached_property
    def contact_ratios(self) -> Columns:
        """Contact ratio of every pair of finished flanks, at the design centre distance.

        ``tooth1``, ``tooth2`` from 1; ``side`` of the driver's tooth, first -1 (driving), then +1
        (coast); ``contact_ratio``; ``from_deg``, ``to_deg``, driver angles at start and end of
        contact, nan without contact.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> columns = result.contact_ratios
        >>> columns["tooth1"][:2], columns["contact_ratio"][:2].round(3)
        (array([1, 2]), array([1.705, 1.705]))
        """
        return contact_ratio_columns(self.subject.sides)

    def measures(self, wheel: Wheel = 1, pin_diameter: float | None = None) -> Columns:
        """Return what a shop measures on a finished wheel, tooth by tooth, as in ``measures.csv``.

        Parameters
        ----------
        wheel : {1, 2}
            The driver or what it drives; of stepped wheels the lowest step.
        pin_diameter : float, optional, mm
            Diameter of the pins or balls; by default that of the design, or the recommended one.

        Returns
        -------
        Columns
            A row for each whole tooth and the space after it; nan where there is no such measure.
            ``tooth``; ``pin_diameter_mm``; ``pin_least_mm``, ``pin_most_mm``, the thinnest and
            thickest pin that touches both flanks; ``x_mm``, ``y_mm``, ``center_radius_mm``,
            ``center_deg``, the centre of the pin in the wheel's frame;
            ``contact_radius_before_mm``, ``contact_radius_after_mm``, of the contacts on this tooth
            and the next, from the axis; ``root_gap_mm``, ``stands_out_mm``, distances of the pin
            from the root and beyond the tips; ``opposite``, ``over_pins_mm``, the space half of all
            teeth ahead, and the measure over both pins (in a ring between them, on a rack over the
            pin and the back); ``chord_mm``, ``chord_depth_mm``, the pitch chord and its depth below
            the tip; ``constant_chord_mm``, ``constant_chord_depth_mm``; ``span_teeth``,
            ``span_mm``, a steady span from this tooth on; ``span_radius_first_mm``,
            ``span_radius_last_mm`` of its contacts from the axis; ``span_rocked_1deg_mm``, its
            change if the jaws rock by 1 deg.

        Raises
        ------
        DesignError
            If there is no such wheel, or the diameter is not positive.
        InfeasibleError
            If the wheel is impossible, or a pin of this diameter touches both flanks of no space.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> columns = result.measures(1, pin_diameter=1.75)
        >>> columns["over_pins_mm"][:2].round(4)
        array([44.4238, 44.3553])
        """
        if pin_diameter is None:
            pin_diameter = (self.pins or (None, None))[self._wheel(wheel) - 1]
        elif not isinstance(pin_diameter, int | float) or not 0.0 < pin_diameter < math.inf:
            raise refused("no diameter", "pin_diameter", pin_diameter, "a positive number, mm")
        return self.gears[self._wheel(wheel) - 1].measuring.table(pin_diameter)

    def span(self, wheel: Wheel, first: int, teeth: int) -> float:
        """Return the span over some teeth of a finished wheel, mm.

        Parameters
        ----------
        wheel : {1, 2}
            The driver or what it drives; of stepped wheels the lowest step.
        first : int
            Number of the first tooth between the jaws.
        teeth : int
            How many teeth are between them.

        Raises
        ------
        DesignError
            If there is no such wheel, or a number is not whole.
        InfeasibleError
            If no reading is steady there, since both flanks have no common normal: it names the
            nearest place where one is.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> round(result.span(1, first=40, teeth=5), 6)  # across the near vertex
        13.821117
        """
        numbers = whole("first", first, 0), whole("teeth", teeth, 1)
        return self.gears[self._wheel(wheel) - 1].measuring.span(*numbers)

    def _wheel(self, wheel: int) -> int:
        if wheel not in (1, 2):
            raise refused("there is no such wheel", "wheel", wheel, "1 or 2")
        return wheel

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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4, center_distance_mm=42.0)
        >>> round(study.facts["meshing.center_distance_mm"], 6)
        42.0
        """
        return self.with_settings("meshing", settings).study("mesh", progress)
