"""Check that openings do not meet each other, the hub's edge or the outline.

Depends on parts' shapes; shapely inside the functions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError, Way
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Opening
from gearcam.parts.shapes import Circle
from gearcam.parts.workpiece import Workpiece

if TYPE_CHECKING:
    from shapely import Polygon

_SMALLER: Final = (
    ("bolt", "bolt_diameter_mm", 0.1),
    ("hub", "hub_diameter_mm", 0.1),
    ("bore", "bore_diameter_mm", 0.1),
)
"""Text of a refusal, and the keys to reduce, with their least values, mm."""

_FARTHER: Final = 2.0
_NEARER: Final = 0.05
"""Factors by which bolt positions are moved in remedies."""


def demand_apart(
    found: Sequence[Opening],
    blank: WheelBlank,
    solid: Polygon,
    work: Workpiece,
    places: Mapping[str, float] | None = None,
) -> None:
    """Refuse openings that meet each other, the hub's edge or the outline.

    Parameters
    ----------
    found : sequence of Opening
        The openings.
    blank : WheelBlank
        With the hub, and the widening of bores.
    solid : shapely.Polygon
        The region they go through.
    work : Workpiece
        The part, for messages.
    places : mapping of str to float, optional
        Keys of ``[blank]`` that position the bolts, with their values, mm; by default those of a
        bolt circle.

    Raises
    ------
    InfeasibleError
        If any two meet.
    """
    given = {"bolt_circle_mm": blank.bolt_circle} if places is None else places
    from shapely import Polygon

    edges = [work.points(opening.shape) for opening in found]
    regions = [Polygon(edge) for edge in edges]
    # chords of openings that touch each other may be apart by this
    gap = 2.0 * max((work.sagitta(opening.shape) for opening in found), default=0.0)
    for number, (opening, edge, region) in enumerate(zip(found, edges, regions, strict=True)):
        if not solid.contains(region) or solid.boundary.dwithin(region, gap):
            raise _no_room(opening, solid, work.within, work, blank.widening, given)
        away = np.hypot(*edge.T)
        if blank.hub_diameter and away.min() <= 0.5 * blank.hub_diameter <= away.max():
            raise _no_room(opening, solid, "the edge of the hub", work, blank.widening, given)
        for other, second in zip(found[:number], regions[:number], strict=True):
            if region.dwithin(second, gap):
                raise _no_room(opening, solid, f"the {other.name}", work, blank.widening, given)


def _no_room(
    opening: Opening,
    solid: Polygon,
    what: str,
    work: Workpiece,
    widening: float,
    places: Mapping[str, float],
) -> InfeasibleError:
    """Return the refusal of an opening that meets something; diameters as given in the design."""
    from shapely import Point

    shape, value, limit = opening.shape, None, None
    nearest = "they must not overlap"
    if isinstance(shape, Circle) and what == work.within:
        center = Point(*shape.center)
        inside = solid.contains(center)
        value = shape.diameter - widening
        limit = 2.0 * solid.boundary.distance(center) - widening if inside else None
        nearest = f"its centre lies outside {what}"
        if limit:
            nearest = "the limit is the free space around its centre"
    told = f"{opening.name} {what}"
    ways = [Way(far={work.key(key): small}) for word, key, small in _SMALLER if word in told]
    if "bolt" in told:
        ways += [
            Way(far={work.key(key): times * place})
            for key, place in places.items()
            for times in (_NEARER, _FARTHER)
        ]
    return work.refusal(
        f"the {opening.name} meets {what}",
        value=value,
        limit=limit,
        nearest=nearest,
        ways=ways,
    )
