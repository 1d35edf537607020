"""Marks: timing marks of a pair, two dimples that face each other at phi1 = 0; zero marks of cams.

Timing marks are on the line of centres: they show the one phase in which the wheels are assembled.
A rim between bore and root that is too thin for them is refused.
"""

from __future__ import annotations

import cmath
import math
from typing import Final

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.parts.arrows import DEPTH_PART, LINES
from gearcam.parts.body import Mark

MARK_DIAMETER: Final = 0.4
"""Diameter of a timing mark, modules: visible, and smaller than any rim that carries teeth."""

MARK_GAP: Final = 0.2
"""Least distance of a timing mark from the root line, modules."""

MARK_DEPTH: Final = 0.5
"""Depth of a mark, mm, in wheels of sufficient width: engraved by laser or drill point."""

RIM_PART: Final = 1 / 3
"""Largest size of a mark with its gap, as a share of the rim between bore and root."""


_DIMPLES: Final = {"printing": 2.0, "laser": 1.0, "wire": 1.0, "milling": 1.5}
"""Diameter of zero marks by process, mm."""


def zero_mark(point: complex, inwards: complex, width: float, process: str) -> Mark:
    """Return the mark of a cam that shows where its follower begins its motion.

    Parameters
    ----------
    point : complex, mm
        Point of contact at the zero of the motion, in the part's frame.
    inwards : complex
        Unit normal into the metal.
    width : float, mm
        Width of the part.
    process : str
        How it is made.

    Returns
    -------
    Mark
        A diameter away from the edge.
    """
    size, depth = _DIMPLES[process], min(LINES[process][1], DEPTH_PART * width)
    return Mark(center=point + 1.5 * size * inwards, diameter=size, depth=depth)


def timing_mark(
    pitch_radius: float,
    direction: float,
    module: float,
    dedendum_mm: float,
    width: float,
    *,
    bore_reach: float = 0.0,
    outside: float | None = None,
    tilt: float = 0.0,
    diameter: float | None = None,
) -> Mark:
    """Return a timing mark just inside a wheel's root, or outside a ring's, in a given direction.

    The direction is 0 for wheel 1, pi for wheel 2, 0 for a ring: at phi1 = 0 both marks lie on the
    line of centres and face each other across the pitch point.

    Parameters
    ----------
    pitch_radius : float, mm
        Radius of the centrode in that direction.
    direction : float, rad
        Polar angle in the wheel's frame.
    module : float, mm
        Sets the mark's size: 0.4 modules.
    dedendum_mm : float, mm
        Distance of the root from the centrode, along the centrode's normal.
    width : float, mm
        Width of the wheel; the depth is the lesser of 0.5 mm and a tenth of it.
    bore_reach : float, mm
        Radius within which bore, keyway and hub lie: the mark stays clear of it, and shrinks where
        the rim is thin.
    outside : float or None, mm
        For a ring: distance of its outside from the axis in that direction.
    tilt : float, rad
        Angle between the radius and the centrode's normal, 0 where the centrode crosses the line of
        centres squarely.
    diameter : float or None, mm
        Given diameter, instead of 0.4 modules.

    Returns
    -------
    Mark

    Raises
    ------
    InfeasibleError
        If there is no rim between root and bore, or a ring's outside, or none wide enough for the
        given diameter.
    """
    lean = math.cos(tilt)
    outward, end, between = -1.0, bore_reach, "bore and root"
    if outside is not None:
        outward, end, between = 1.0, outside, "root and outside"
    rim = outward * (end - pitch_radius) * lean - dedendum_mm
    if rim <= 0:
        root = pitch_radius + outward * dedendum_mm / lean
        limit = "outside" if outward > 0.0 else "circle around bore, keyway and hub"
        nearest = f"the value is the {limit}, the limit the root there"
        what = f"no room for a timing mark between {between}"
        where = f"direction {formatted(math.degrees(direction))} deg"
        limit = 2 * root if root > 0.0 else None
        note = nearest if root > 0.0 else "the roots of the teeth reach the axis there"
        adjustments = (Adjustment(near={"blank.timing_marks": False}),)
        raise beyond_limit(
            what,
            where,
            2 * end if root > 0.0 else None,
            limit,
            note,
            adjustments=adjustments,
            unit="mm",
        )
    largest = RIM_PART * rim
    if diameter is not None and diameter > largest:
        what = f"the timing mark is too large for the rim between {between}"
        where = f"direction {formatted(math.degrees(direction))} deg, blank.mark_diameter_mm"
        note = "the limit is a third of the rim"
        raise beyond_limit(what, where, diameter, largest, note, near=0.99 * largest)
    diameter = diameter or min(MARK_DIAMETER * module, largest)
    gap = min(MARK_GAP * module, RIM_PART * rim)
    radius = pitch_radius + outward * (dedendum_mm + gap + 0.5 * diameter) / lean
    depth = min(MARK_DEPTH, DEPTH_PART * width)
    return Mark(center=cmath.rect(radius, direction), diameter=diameter, depth=depth)
