"""What the accuracy block of a pair says: an estimate for each family of its numbers."""

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
    from gearcam.kinds.gear_pair.build import GearPairResult
    from gearcam.parts.body import Part

_FINER: Final = 16.0
"""Times by which the tolerance is finer with which corners are followed once more."""

_SOUGHT: Final = 2.0
"""Over what that changes: ends of flanks are off in proportion to the tolerance, with scatter."""

_HOW: Final = (
    "cubics through every second dense point of all edges, over their order; bends of tips;"
    " ends of flanks that were sought to a sixteenth of the tolerance; flank_mm all around"
)


def error_rows(result: GearPairResult) -> Estimates:
    """Return the estimated errors of a pair.

    Parameters
    ----------
    result : GearPairResult
        A built design.

    Returns
    -------
    dict of str to (float, str)
        Each with how it was made, by name; chords and files are not among them.
    """
    rows = estimates(result.subject)
    flank, _ = rows["flank_mm"]
    if result.ordered:
        rows |= tool_errors(result.parts_subject.tools)
    return rows | {name: (value, _HOW) for name, value in _weights(result, flank)}


def _weights(result: GearPairResult, flank: float) -> Iterator[tuple[str, float]]:
    """Yield the errors of mass properties, the larger of both wheels, where they are told."""
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
    """Return what the moments of a part's volume are off by.

    Parameters
    ----------
    part : Part
        A wheel.
    gears : sequence of Gear
        That of each of its steps.
    flank : float, mm
        By how much places on outlines are off.
    finer : callable
        Returns a wheel to a sixteenth of its tolerance.

    Returns
    -------
    Moments
        None below zero.
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
    """Return what the teeth add to a wheel's moments; what joins those of open ones stays."""
    runs = gear.profile.dense_teeth
    return sum((curve_moments(run.points, run.tangents) for run in runs), start=Moments())
