"""Making a part: outlines with rounded edges, openings, hub and mark, all edges moved if asked.

The order is that of the shop: teeth, rounded edges, openings, and last the offset, which moves
every edge that is cut, outlines outwards and openings inwards where it adds material.

Refused: what openings, marks and parallels refuse, and offsets that close a hole.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from gearcam.errors import InfeasibleError, Way
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import WheelBlank
from gearcam.parts.openings import Place, bore, common, demand_apart, openings
from gearcam.parts.part import Hub, Mark, Opening, Part
from gearcam.parts.shapes import Circle, Loop

Marker = Callable[[], Mark]


def make_part(
    name: str,
    contours: Sequence[Contour],
    width: float,
    blank: WheelBlank,
    place: Place,
    marker: Marker | None = None,
) -> Part:
    """Make the part of a wheel.

    Parameters
    ----------
    name : str
        The stem of its files.
    contours : sequence of Contour
        True outlines: one, or those of the steps.
    width : float, mm
        Of the toothed plate.
    blank : WheelBlank
        What is wanted beyond the teeth.
    place : Place
        Which wheel.
    marker : callable, optional
        Gives the timing mark; called only if marks are wanted.

    Returns
    -------
    Part

    Raises
    ------
    InfeasibleError
        If something has no room, or meets something else.
    """
    edges = list(contours)
    if blank.tip_rounding:
        from gearcam.parts.parallel import rounded

        edges = [rounded(contour, blank.tip_rounding) for contour in edges]
    found = openings(blank, edges, place)
    hub = None
    if blank.hub_diameter:
        hub = Hub(diameter=blank.hub_diameter, front=blank.hub_front, back=blank.hub_back)
        _demand_within(hub, edges, place)
    marks = (marker(),) if marker is not None and blank.timing_marks else ()
    if blank.offset:
        from gearcam.parts.parallel import moved

        edges = [moved(contour, blank.offset) for contour in edges]
        found = tuple(_shifted(opening, blank, place) for opening in found)
        demand_apart(found, blank, common(edges), place)
        if hub is not None:
            _demand_within(hub, edges, place)
    part = Part(
        name=name,
        contours=tuple(edges),
        width=width,
        openings=tuple(found),
        hub=hub,
        marks=marks,
    )
    _demand_marks(part, place)
    return part


def _demand_within(hub: Hub, contours: Sequence[Contour], place: Place) -> None:
    from shapely import Point

    room = min(2.0 * contour.polygon.boundary.distance(Point(0.0, 0.0)) for contour in contours)
    if hub.diameter >= room:
        raise InfeasibleError(
            "the hub reaches the roots of the teeth",
            where=f"{place.name}, blank.hub_diameter_mm",
            value=hub.diameter,
            limit=room,
            unit="mm",
            nearest="the limit is where it would reach them",
            ways=(
                Way(
                    near={place.key("hub_diameter_mm"): room},
                    far={place.key("hub_diameter_mm"): 0.5 * room},
                ),
            ),
        )


def _shifted(opening: Opening, blank: WheelBlank, place: Place) -> Opening:
    """Return an opening whose edge is moved into it by the offset."""
    shape, by = opening.shape, blank.offset
    if isinstance(shape, Circle):
        if shape.diameter <= 2.0 * by:
            raise _closed(opening, by, 0.5 * shape.diameter, place)
        return replace(opening, shape=replace(shape, diameter=shape.diameter - 2.0 * by))
    if opening.kind == "BORE":
        return replace(opening, shape=_moved_bore(opening, blank, place))
    return replace(opening, shape=_moved_slot(shape, opening, by, place))


def _moved_bore(opening: Opening, blank: WheelBlank, place: Place) -> Circle | Loop:
    """Return the bore of moved sizes: keyways become narrower and less deep, flats nearer."""
    by = blank.offset
    least = min(size for size in (blank.bore, blank.keyway_width, blank.bore_flat) if size)
    if least <= 2.0 * by:
        raise _closed(opening, by, 0.5 * least, place)
    width = blank.keyway_width - 2.0 * by if blank.keyway_width else 0.0
    flat = blank.bore_flat - 2.0 * by if blank.bore_flat else 0.0
    diameter = blank.bore - 2.0 * by
    return bore(replace(blank, bore_diameter=diameter, keyway_width=width, bore_flat=flat))


def _moved_slot(shape: Loop, opening: Opening, by: float, place: Place) -> Loop:
    """Return a slot whose arcs are moved along their normals and keep their angles."""
    points = shape.vertices @ [1.0, 1j]
    radii, half = np.abs(points), len(points) // 2
    width = float(radii[0] - radii[half])
    if width <= 2.0 * by:
        raise _closed(opening, by, 0.5 * width, place)
    inwards = np.where(np.arange(len(points)) < half, -by, by)
    made = points * (1.0 + inwards / radii)
    return Loop(vertices=np.column_stack([made.real, made.imag]), bulges=shape.bulges)


def _closed(opening: Opening, by: float, limit: float, place: Place) -> InfeasibleError:
    return InfeasibleError(
        f"the offset closes the {opening.name}",
        where=f"{place.name}, blank.offset_mm",
        value=by,
        limit=limit,
        unit="mm",
        nearest=f"an offset below {limit:.6g} mm",
    )


def _demand_marks(part: Part, place: Place) -> None:
    """Refuse a mark that meets an opening, the hub or the outline."""
    from shapely import Point

    for mark in part.marks:
        middle = Point(*mark.center)
        radius = 0.5 * mark.diameter
        room = part.region.boundary.distance(middle) if part.region.contains(middle) else 0.0
        if part.hub is not None:
            room = min(room, float(np.hypot(*mark.center)) - 0.5 * part.hub.diameter)
        if room < radius:
            raise InfeasibleError(
                "the timing mark meets an opening, the hub or the outline",
                where=f"{place.name}, [blank]",
                value=mark.diameter,
                limit=max(0.0, 2.0 * room),
                unit="mm",
                nearest="the limit is the room around its middle",
                ways=(
                    Way(near={"blank.mark_diameter_mm": 1.9 * room} if room > 0.0 else {}),
                    Way(near={"blank.timing_marks": False}),
                ),
            )
