"""The rim of a ring, between its roots and its outside, and bolt holes in it.

Holes that do not fit into the rim are refused, with the largest that do, and with the bolt circle
that has the most space.

Depends on parts' shapes; shapely inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.numerals import formatted, rounded_down
from gearcam.numeric.arrays import Array, as_pairs
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import ShaftBlank
from gearcam.parts.body import Edge
from gearcam.parts.openings import Stock

if TYPE_CHECKING:
    from shapely import Polygon

_CIRCLES: Final = 400
"""Number of bolt circles tried in the search for the one with the most space."""

_SHARE: Final = 0.999
"""Share of the space that a remedy uses: walls are measured between chords."""


def is_around(outside: Edge, inner: Contour) -> bool:
    """Return whether a ring's outside encloses its inner edge, for their polygons.

    Parameters
    ----------
    outside : Contour or Circle
        Outside of the ring.
    inner : Contour
        The edge of its teeth.

    Returns
    -------
    bool
    """
    from shapely import Polygon

    return Polygon(as_pairs(outside.polyline(inner.tolerance)), [inner.vertices]).is_valid


def demand_bolts(
    blank: ShaftBlank,
    stock: Stock,
    wall: float,
    outside: Callable[[float], dict[str, object]],
) -> None:
    """Refuse bolt holes that do not lie in the rim.

    Parameters
    ----------
    blank : ShaftBlank
        With the bolts.
    stock : Stock
        The ring without them, in its own frame.
    wall : float, mm
        Wall that remedies leave on both sides.
    outside : callable
        Returns the design value that gives the ring an outside of a radius, mm.

    Raises
    ------
    InfeasibleError
        With the largest diameter that keeps the walls, if any does.
    """
    if not blank.bolts:
        return
    work, solid = stock.work, stock.region
    wide, taken = blank.bolt_diameter + blank.widening, 2.0 * wall + blank.widening
    room = float(_rooms(blank, solid, np.array([blank.bolt_circle]))[0])
    if wide < room:
        return
    away = np.hypot(*np.array(solid.exterior.coords).T)
    low, far = float(away.min()), float(away.max())
    circles = 2.0 * far * np.arange(1, _CIRCLES) / _CIRCLES
    rooms = _rooms(blank, solid, circles)
    best, most = float(circles[rooms.argmax()]), float(rooms.max()) - taken
    diameter, circle = work.key("bolt_diameter_mm"), work.key("bolt_circle_mm")
    adjustments = [Adjustment(near={circle: best})] if most >= blank.bolt_diameter else []
    if room > taken:
        adjustments.append(Adjustment(near={diameter: _SHARE * (room - taken)}))
    elif most > 0.0:
        adjustments.append(
            Adjustment(near={circle: best, diameter: min(blank.bolt_diameter, _SHARE * most)})
        )
    hole, reach = _hole(solid), 0.5 * wide + wall
    if hole is not None:
        roots = float(np.hypot(*np.array(hole.exterior.coords).T).max())
        clears = hole.distance(_middles(blank, np.array([blank.bolt_circle]))).min() >= reach
        across = blank.bolt_circle if clears else 2.0 * (roots + reach)
        if 0.5 * across + reach > low:
            moved = {} if clears else {circle: across}
            radius = (0.5 * across + reach) / _SHARE
            adjustments.append(Adjustment(near={**moved, **outside(radius)}))
            if far - low > work.sagitta:  # not round: the least radius is smaller
                adjustments[-1] = replace(
                    adjustments[-1], far={**moved, **outside(radius + far - low)}
                )
    adjustments.append(Adjustment(near=work.without(blank, "bolts")))
    roomiest = f"no bolt circle keeps walls of {formatted(wall)} mm: a larger rim in [ring] may"
    if most > 0.0:
        roomiest = f"a bolt circle of {formatted(best)} mm allows up to {rounded_down(most, 4)} mm"
    reason = (
        f"the limit leaves walls of {formatted(wall)} mm on both sides; " if room > taken else ""
    )
    what, place = "the bolt holes do not lie in the rim of the ring", "blank.bolt_diameter_mm"
    limit, note = room - taken if room > taken else None, f"{reason}{roomiest}"
    raise work.refusal(what, blank.bolt_diameter, limit, note, adjustments, place)


def _hole(solid: Polygon) -> Polygon | None:
    """Return the region inside the teeth of a closed ring."""
    from shapely import Polygon

    return Polygon(solid.interiors[0]) if len(solid.interiors) else None


def _middles(blank: ShaftBlank, circles: Array) -> Any:
    """Return the centres of the holes on bolt circles, (bolts, n)."""
    from shapely import points

    turns = blank.bolt_angle + 2.0 * math.pi * np.arange(blank.bolts) / blank.bolts
    spokes = 0.5 * np.exp(1j * turns)[:, None] * circles
    return points(spokes.real, spokes.imag)


def _rooms(blank: ShaftBlank, solid: Polygon, circles: Array) -> Array:
    """Return the diameters of the largest holes that fit on bolt circles, mm; 0 if none does."""
    middles = _middles(blank, circles)
    away = np.where(solid.contains(middles), solid.boundary.distance(middles), 0.0)
    return 2.0 * away.min(axis=0)
