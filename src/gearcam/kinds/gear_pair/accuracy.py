"""Error estimates of a pair, one for each family of its numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from gearcam.gears.estimates import Estimates, estimates, kink_error
from gearcam.gears.pair import make_gear
from gearcam.numeric.moments import Moments, curve_moments
from gearcam.parts.mass import error_of, mass_errors, quadrature_error
from gearcam.parts.tools import tool_errors

if TYPE_CHECKING:
    from gearcam.gears.pair import Gear
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.parts.body import Part

_FINER: Final = 16.0
"""Factor by which the tolerance is finer when corners are followed again."""

_SOUGHT: Final = 2.0
"""Error over the change: ends of flanks are off in proportion to the tolerance, with scatter."""

_HOW: Final = (
    "cubics through every second dense point of all edges; curvature of tips; ends of flanks "
    "searched again with a tolerance 16 times finer; flank_mm over the whole edge"
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
    rows = estimates(result.subject)
    flank, _ = rows["flank_mm"]
    if result.ordered:
        rows |= tool_errors(result.parts_subject.tools)
    return rows | {name: (value, _HOW) for name, value in _weights(result, flank)}


def _weights(result: GearPairResult, flank: float) -> Iterator[tuple[str, float]]:
    """Yield the errors of mass properties, the larger of both wheels, if there is a density."""
    densities = [result.design.blank.wheel(number).density for number in (1, 2)]
    if not result.ordered or densities == [None, None]:
        return

    def finer(gear: Gear) -> Gear:
        tolerance = gear.profile.tolerance / _FINER
        return make_gear(gear.pair, gear.wheel, tolerance, result.tolerances, result.design.ring)

    errors = [
        mass_errors(part, volume_error(part, gears, flank, finer), density)
        for part, density, *gears in zip(result.parts, densities, *result.steps, strict=True)
        if density is not None
    ]
    for name in errors[0]:
        yield name, max(one[name] for one in errors)


def volume_error(
    part: Part, gears: Sequence[Gear], flank: float, finer: Callable[[Gear], Gear]
) -> Moments:
    """Return the errors of the moments of a part's volume.

    Parameters
    ----------
    part : Part
        A wheel.
    gears : sequence of Gear
        The wheel of each step.
    flank : float, mm
        Error of places on outlines.
    finer : callable
        Returns a wheel with a sixteenth of its tolerance.

    Returns
    -------
    Moments
        All at least zero.
    """
    height, found = part.width / len(gears), quadrature_error(part)
    for gear in gears:
        outline, far = gear.profile, gear.largest_radius
        area = flank * outline.contour.length + kink_error(outline)
        found += height * Moments(area=area, first=complex(far * area), polar=far**2 * area)
        if outline.flanks.sought:
            found += _SOUGHT * height * error_of(_toothed(finer(gear)) - _toothed(gear))
    return found


def _toothed(gear: Gear) -> Moments:
    """Return the moments of the teeth of a wheel, without the joining edge of an open one."""
    runs = gear.profile.dense_teeth
    return sum((curve_moments(run.points, run.tangents) for run in runs), start=Moments())
