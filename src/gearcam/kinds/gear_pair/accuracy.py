"""Error estimates of a pair: of driven angle, flanks, contact ratio, area and volume."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from gearcam.gears.estimates import pair_errors
from gearcam.gears.pair import make_gear
from gearcam.numeric.moments import curve_moments
from gearcam.parts.mass import quadrature_error

if TYPE_CHECKING:
    from gearcam.gears.pair import Gear
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.parts.body import Part
    from gearcam.results.parts import Estimates

_FINER: Final = 16.0
"""Factor by which the tolerance is finer when corners are followed again."""

_TRACED: Final = 2.0
"""Error over the change: ends of flanks are off in proportion to the tolerance, with scatter."""

_VOLUME: Final = (
    "cubics through dense points with doubled steps, at kinks of tips with halved steps; ends of "
    "flanks searched again with a tolerance 16 times finer; flank_mm over the whole edge"
)


def error_rows(result: GearPairResult) -> Estimates:
    """Return the error estimates of a pair.

    Parameters
    ----------
    result : GearPairResult
        A built design.

    Returns
    -------
    dict of str to (float, str)
        Estimate and method by name, without those of chords and files.
    """
    driven, flank, contact_ratio = pair_errors(result.subject)
    how = "largest change if the law and its integrals change by their errors"
    if result.law.function_error:
        how += ", with that of the expansion of the Python function"
    area = max(gear.profile.chord_error * gear.profile.contour.length for gear in result.gears)
    rack = result.pair.on_rack
    name = "travel_mm" if rack else "driven_angle_rad"
    rows = {
        name: (result.pair.center_distance * driven if rack else driven, how),
        "flank_mm": (flank, how),
        "contact_ratio": (contact_ratio, how),
        "area_mm2": (area, "chord error times the length of the outline"),
    }
    if result.ordered:
        steps = zip(result.parts, *result.steps, strict=True)
        volumes = [
            _volume(result, part, gears, flank)
            for number, (part, *gears) in enumerate(steps, 1)
            if result.design.blank.wheel(number).density is not None
        ]
        if volumes:
            rows["volume_mm3"] = max(volumes), _VOLUME
    return rows


def _volume(result: GearPairResult, part: Part, gears: Sequence[Gear], flank: float) -> float:
    """Return the error of the volume of a part, mm^3, from the wheel of each of its steps."""
    height, off = part.width / len(gears), quadrature_error(part)
    for gear in gears:
        outline = gear.profile
        area = outline.kinks_missed + flank * outline.contour.length
        if outline.flanks.traced:
            finer = make_gear(
                gear.pair,
                gear.wheel,
                outline.tolerance / _FINER,
                result.tolerances,
                result.design.ring,
            )
            area += _TRACED * abs(_toothed(finer) - _toothed(gear))
        off += height * area
    return off


def _toothed(gear: Gear) -> float:
    """Return the area at the teeth of a wheel, without the joining edge of an open one."""
    runs = gear.profile.dense_teeth
    return sum(curve_moments(run.points, run.tangents).area for run in runs)
