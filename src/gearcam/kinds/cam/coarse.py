"""Values that help if the rows of a motion table are coarser than the profile is cut."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import Finding
from gearcam.base.numerals import formatted, shortened
from gearcam.kinds.cam.motion import turn_tables
from gearcam.laws.motion_table import MotionTable

if TYPE_CHECKING:
    from gearcam.kinds.cam.build import CamResult

COARSEST: Final = 1.0
"""Largest chord tolerance of a cam, mm."""

_SCATTERED: Final = 4.0
"""Between a quarter and half of the rows the error falls by more than this if the lift is smooth,
and hardly at all if the rows scatter."""

_SHARES: Final = (0.4, 0.5, 0.65, 0.8, 1.0)
"""Smoothing tolerances that are tried, over the error: the farthest of scattered rows is about 0.4
of it beside the lift, and a much larger tolerance takes more from the lift than scatter did."""


def helped(result: CamResult, finding: Finding) -> Finding:
    """Return the finding coarse-rows of a `result` with the keys and values that help."""
    return replace(finding, message=" ".join([finding.message, *_remedies(result, finding)]))


def _remedies(result: CamResult, finding: Finding) -> Iterator[str]:
    table, lead, error = result.design.motion, result.cam.motions[0], finding.value or 0.0
    if isinstance(table, MotionTable) and lead.program.fall < _SCATTERED:
        oscillating, lever = lead.follower.angular, lead.follower.lever
        entries = turn_tables()[0].bound([result.design.follower.motion]).entries.values()
        entry = next(one for one in entries if one.name == "smoothing_tolerance")
        given = 2.0 * (table.smoothing_tolerance or 0.0)
        asked = (entry.outward(max(share * error / lever, given)) for share in _SHARES)
        sizes = {shortened(size, 1.0, 2) for size in asked}
        for size in sorted(sizes):
            smoother = replace(table, smoothing_tolerance=entry.inward(size))
            try:  # what is left of the error is computed, not assumed
                program = smoother.program(result.tolerances, oscillating=oscillating)
            except InfeasibleError:  # a tolerance as large as the lift
                break
            if program.errors[0] * lever <= lead.tolerance:
                yield f"With motion.{entry.key} = {formatted(size)} the scatter is averaged out."
                break
    coarser = shortened(error, 1.0, 2)
    if coarser <= COARSEST:
        yield (
            f"With output.chord_tolerance_mm = {formatted(coarser)} the profile is cut only as "
            "finely as the lift is known."
        )
