"""The result of a gear pair: its stages, and what is asked of them at driver angles."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from gearcam.findings import in_order, run_checks
from gearcam.kinds.gear_pair.columns import (
    centrode_columns,
    contact_ratio_columns,
    contact_rows,
    motion_columns,
)
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.kinds.gear_pair.stages import PairStages
from gearcam.meshing.contact import Contacts, contacts
from gearcam.numeric.arguments import angles, one_of, whole
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.result import Progress
from gearcam.tolerances import DEFAULT, Tolerances

if TYPE_CHECKING:
    from gearcam.gears.contact import FlankPairs
    from gearcam.study import Study

MESHING = "meshing.csv"
"""The rows of a meshing study."""

Side = Literal["drive", "coast"]
"""Flanks of the driver: those that drive, and those that hold back."""

ROUNDING = 1e-12
"""Part of the travel by which an angle may lie beyond it: angles told in degrees are rounded."""

_AS_MOUNTED = ("contact-ratio",)
"""Checks of a pair as designed that a study repeats for the pair as mounted."""


class GearPairResult(PairStages):
    """What comes of the design of a gear pair, computed on demand.

    Parameters
    ----------
    design : GearPairDesign
        What is asked for.
    tolerances : Tolerances
        Inner accuracy.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/ellipse.toml"))
    >>> x, y = result.gear1.outline.T  # mm
    >>> result.motion([0.0, 6.283185307179586])["phi2_deg"].round(6)
    array([  0., 360.])
    """

    def centrodes(self, n: int | None = None) -> Columns:
        """Return both centrodes, until both wheels close, or over the travel.

        Parameters
        ----------
        n : int, optional
            Points, both ends included, 2 or more; one each half degree of a closed pair, or 721
            over the travel, where left out: the table of ``centrodes.csv``.

        Returns
        -------
        Columns
            ``phi1_deg``, ``phi2_deg``; ``ratio`` i21; ``r1_mm`` and ``r2_mm``, distances of the
            pitch point from both shafts; ``s_mm``, arc length of both; ``rho1_mm``, ``rho2_mm``,
            radii of curvature, negative where concave towards the tips (as a ring is where it is
            round), infinite where straight; ``x1_mm``, ``y1_mm``, ``x2_mm``, ``y2_mm``, points in
            each wheel's own frame. Of a rack ``travel_mm`` stands for phi2, ratio and r2. At a knot
            the values after it count.

        Raises
        ------
        DesignError
            If `n` is no whole number, or less than 2.
        InfeasibleError
            If the centrodes cannot be made.
        """
        if n is None:
            return self.whole_centrodes
        return centrode_columns(self, self.centrode_angles(whole("n", n, 2)))

    @cached_property
    def whole_centrodes(self) -> Columns:
        """The table of `centrodes` where nothing else is asked for."""
        return centrode_columns(self, self.centrode_angles())

    def motion(self, phi1: ArrayLike | None = None) -> Columns:
        """Return how the driven element moves, exactly.

        Parameters
        ----------
        phi1 : float or (n,) array, rad, optional
            Driver angles, of open pairs within the travel; those of `centrodes` where left out.

        Returns
        -------
        Columns
            ``phi1_deg``; ``phi2_deg``, counted from phi1 = 0 over all turns; ``ratio`` i21; its
            derivatives by phi1 ``acceleration_per_rad`` and ``jerk_per_rad2``. Of a rack
            ``travel_mm``, ``velocity_mm_per_rad``, ``acceleration_mm_per_rad2`` and
            ``jerk_mm_per_rad3``. At a knot the values after it count.

        Raises
        ------
        DesignError
            If `phi1` is no row of finite numbers, or beyond the travel.
        InfeasibleError
            If the law cannot be made.
        """
        return motion_columns(self, self._phases(phi1))

    def contact(self, phi1: ArrayLike | None = None, side: Side = "drive") -> Columns:
        """Return every point at which flanks touch, for the wheels as made, mounted as designed.

        Parameters
        ----------
        phi1 : float or (n,) array, rad, optional
            Driver angles, of open pairs within the travel; those of `centrodes` where left out.
        side : {"drive", "coast"}
            Which flanks of the driver: those that drive, or those that hold back.

        Returns
        -------
        Columns
            A row for each phase and pair of teeth that touches; none where nothing does. The rows
            of one pair are its path of contact. ``phi1_deg`` and ``phi2_deg`` (of a rack
            ``travel_mm``), nominal; ``tooth1``, ``tooth2`` from 1; ``side`` of the driver's tooth,
            -1 drives; ``pairs``, how many touch in this phase; ``x_mm``, ``y_mm``, the point in the
            fixed frame (driver's shaft at 0, driven one at the centre distance on x, that of a
            ring at minus it);
            ``force_x``, ``force_y``, the unit direction in which the driver presses there;
            ``contact_radius1_mm``, ``contact_radius2_mm`` from both shafts;
            ``pressure_angle_deg`` of the force to the perpendicular to the line of centres;
            ``sliding_mm_per_rad``, sliding speed along the driver's flank, tip outward, over the
            driver's speed; ``specific_sliding1``, ``specific_sliding2``;
            ``relative_curvature_per_mm``; ``lag_rad`` (of a rack ``lag_mm``), what the driven
            element is behind its nominal place when this pair touches.

        Raises
        ------
        DesignError
            If `phi1` is no row of finite numbers, or beyond the travel, or there is no such side.
        InfeasibleError
            If the wheels cannot be made.
        """
        pairs, phases = self.flanks_of(side), self._phases(phi1)
        return contact_rows(self, pairs, phases, contacts(pairs, phases))

    def flanks_of(self, side: Side) -> FlankPairs:
        """Return the pairs of flanks of a `side`; DesignError if there is no such side."""
        coast, drive = self.subject.sides
        return drive if one_of("side", side, get_args(Side)) == "drive" else coast

    @cached_property
    def touching(self) -> dict[Side, Contacts]:
        """Where flanks of both sides touch over `phases`."""
        return {side: contacts(self.flanks_of(side), self.phases) for side in get_args(Side)}

    @cached_property
    def centrodes_of_phases(self) -> Columns:
        """The table of `centrodes` over `phases`."""
        same = np.array_equal(self.phases, self.centrode_angles())  # no knots, and one turn
        return self.whole_centrodes if same else centrode_columns(self, self.phases)

    @cached_property
    def paths_of_contact(self) -> dict[Side, Columns]:
        """The tables of `contact` of both sides, over `phases`."""
        return {
            side: contact_rows(self, self.flanks_of(side), self.phases, found)
            for side, found in self.touching.items()
        }

    @cached_property
    def contact_ratio(self) -> float:
        """The smallest contact ratio of any pair of flanks, either way, mounted as designed."""
        return self.subject.contact_ratio

    @cached_property
    def contact_ratios(self) -> Columns:
        """The contact ratio of every pair of flanks, for the wheels as made, mounted as designed.

        ``tooth1``, ``tooth2`` from 1; ``side`` of the driver's tooth, -1 drives, which come first,
        +1 holds back; ``contact_ratio``; ``from_deg``, ``to_deg``, the driver angles between which
        they touch, not-a-number where they do not.
        """
        return contact_ratio_columns(self.subject.sides)

    def _phases(self, phi1: ArrayLike | None) -> Array:
        """Return driver angles that a caller gives, or those of the centrodes."""
        if phi1 is None:
            return self.centrode_angles()
        if self.law.lobes.closed:
            return angles("phi1", phi1)
        end = self.law.period
        return angles("phi1", phi1, 0.0, end, ROUNDING * end)

    def mesh(self, *, progress: Progress | None = None, **settings: object) -> Study:
        """Turn the pair step by step: contact, interference, backlash, as made and as mounted.

        Parameters
        ----------
        progress : callable, optional
            Called with a stage's name, the stages or steps done and their number.
        **settings : value
            Keys of the table ``[meshing]``, such as ``steps`` and ``center_distance_mm``, that
            stand before those of the design, in the units of a file.

        Returns
        -------
        Study
            Its columns are those of ``meshing.csv`` (see docs/summary.md); not complete where
            it was interrupted after some steps.

        Raises
        ------
        DesignError
            If there is no such setting, or a value is not what a file may hold.
        InfeasibleError
            If the design, or its study, cannot be made.
        KeyboardInterrupt
            If it was interrupted before the first steps were done.
        """
        from gearcam.meshing.checks import KIND as MESHING_KIND
        from gearcam.meshing.numbers import numbers
        from gearcam.meshing.study import study
        from gearcam.study import Study

        result = self._mounted(settings)
        design = result.design
        gears = result.steps[design.meshing.step - 1]
        with result.stage("meshing"):
            designed = result.subject.sides if gears is result.steps[0] else ()
            meshing = study(gears, design.meshing, progress, designed)
        if not meshing.blocks:
            raise KeyboardInterrupt
        with result.stage("checks"):
            extra = run_checks(MESHING_KIND, meshing, design.limits)
        # of what drives the study knows, as mounted
        told = [finding for finding in result.findings if finding.code not in _AS_MOUNTED]
        return Study(
            result=result,
            file=MESHING,
            table=meshing.columns,
            measured={"meshing": numbers(meshing)},
            findings=in_order((*told, *extra)),
            complete=meshing.complete,
        )

    def _mounted(self, settings: Mapping[str, object]) -> GearPairResult:
        """Return the result with other settings of its study: all that is made stays."""
        if not settings:
            return self
        design = self.design.with_({f"meshing.{key}": value for key, value in settings.items()})
        _ = self.steps  # made here, once for all studies
        other = type(self)(design, self.tolerances)
        own = {"design": design, "timings": dict(self.timings), "sought": {}}
        vars(other).update(vars(self) | own)
        return other


def build(design: GearPairDesign, tolerances: Tolerances = DEFAULT) -> GearPairResult:
    """Return the result of a `design` to `tolerances`; it computes what it is asked for."""
    return GearPairResult(design, tolerances)
