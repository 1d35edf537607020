"""Building a part: finished outlines, openings, hub and mark.

Refused: openings, hubs and marks without space.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any, Final

from gearcam.base.adjustments import Adjustment
from gearcam.base.numerals import formatted
from gearcam.base.quantities import NONE
from gearcam.numeric.contour import Contour
from gearcam.numeric.polygons import room_around
from gearcam.parts.blank import TAPPED, ShaftBlank
from gearcam.parts.body import (
    Bevel,
    Edge,
    Hub,
    Mark,
    Opening,
    Part,
    Recess,
    ScrewHole,
)
from gearcam.parts.openings import Stock, Workpiece, openings
from gearcam.parts.shapes import Circle

_UNEVEN: Final = 0.001
"""Difference of an area from what parallels without lost details have, over size times length."""


def make_part(
    name: str,
    contours: Sequence[Contour | Circle],
    width: float,
    blank: ShaftBlank,
    work: Workpiece,
    marker: Callable[[], Mark] | None = None,
    *,
    inner: Sequence[Contour] = (),
    recesses: tuple[Recess, ...] = (),
    room: Sequence[Contour | Circle] = (),
    way: complex = 1.0,
) -> Part:
    """Return the part of a wheel or a ring.

    Parameters
    ----------
    name : str
        The stem of its files.
    contours : sequence of Contour
        True finished outlines: one, or those of the steps; for a ring they may be circles.
    width : float, mm
        Width of the toothed plate.
    blank : ShaftBlank
        Settings of the blank.
    work : Workpiece
        The wheel.
    marker : callable, optional
        Returns the timing mark or zero mark; called only if one is requested.
    inner : sequence of Contour
        For a ring: the true inner edges.
    recesses : tuple of Recess
        Pockets milled into its faces.
    room : sequence of Contour or Circle
        Edges that openings and hub must lie within; by default the outlines.
    way : complex
        How it moves (see `gearcam.parts.arrows.arrow`).

    Returns
    -------
    Part

    Raises
    ------
    InfeasibleError
        If an opening, hub, screw, mark, arrow or chamfer has no space.
    """
    found = openings(blank, room or contours, work, inner)
    hub = None
    if blank.hub_diameter:
        hub = Hub(diameter=blank.hub_diameter, front=blank.hub_front, back=blank.hub_back)
        _demand_within(hub, room or contours, work)
    screw = None
    if hub is not None and blank.set_screw != NONE:
        screw = _screw(blank, hub, found, width, work)
    part = Part(
        name=name,
        contours=tuple(contours),
        width=width,
        openings=found,
        inner=tuple(inner),
        hub=hub,
        recesses=recesses,
        screw=screw,
    )
    return marked(part, blank, work, marker, way=way)


def marked(
    part: Part,
    blank: Any,
    work: Workpiece,
    marker: Callable[[], Mark] | None = None,
    *,
    way: complex = 1.0,
) -> Part:
    """Return a part with its mark, its arrow and its chamfers.

    Parameters
    ----------
    part : Part
        The part without them.
    blank : ShaftBlank or another
        With what is wanted of them.
    work : Workpiece
        What it is made from.
    marker : callable, optional
        As of `make_part`.
    way : complex
        As of `make_part`.

    Raises
    ------
    InfeasibleError
        If one of them has no space.
    """
    if marker is not None and (blank.zero_mark or blank.timing_marks):
        part = replace(part, marks=(marker(),))
        _demand_marks(part, blank, work)
    if blank.rotation_arrow:
        from gearcam.parts.arrows import arrow

        core = [one.shape.reach for one in part.openings if one.kind == "BORE"]
        core += [boss.edge.reach for boss in part.bosses]
        part = replace(part, arrow=arrow(part, work, way, max(core, default=0.0)))
    return replace(part, bevels=tuple(bevels(part, blank.chamfer, work)))


def _screw(
    blank: ShaftBlank, hub: Hub, found: Sequence[Opening], width: float, work: Workpiece
) -> ScrewHole:
    """Return the hole of a set screw, in the middle of the hub."""
    drill, height = TAPPED[blank.set_screw], hub.front or hub.back
    if height <= drill:
        key = "hub_front_mm" if hub.front else "hub_back_mm"
        what = f"the set screw, with a hole of {formatted(drill)} mm, is as wide as the hub is high"
        near = Adjustment(near={work.key(key): 2.0 * drill})
        raise work.refusal(what, height, drill, "twice the hole is usual", (near,), f"blank.{key}")
    middle = width + 0.5 * height if hub.front else -0.5 * height
    bore = next(one for one in found if one.kind == "BORE")
    return ScrewHole(
        edge=Circle(center=0j, diameter=hub.diameter),
        openings=(bore,),
        low=middle - 0.5 * drill,
        high=middle + 0.5 * drill,
        size=blank.set_screw,
        angle=blank.keyway_angle + blank.set_screw_angle,
    )


def bevels(
    part: Part, size: float, work: Workpiece, outside: Sequence[Edge] = ()
) -> Iterator[Bevel]:
    """Yield the chamfers of a part: of outlines, hubs, inner edges and bore, in both faces.

    Parameters
    ----------
    part : Part
        The part without them.
    size : float, mm
        The chamfer; 0 for none.
    work : Workpiece
        What it is made from.
    outside : sequence of Edge
        The edges of the lower and of the upper face, where they are not those of the part.

    Raises
    ------
    InfeasibleError
        If it leaves no simple edge, or those of both faces meet.
    """
    if not size:
        return
    least = min(layer.height for layer in part.layers)
    if 2.0 * size >= least:
        what = "the chamfers of both faces meet"
        near = (Adjustment(near={work.key("chamfer_mm"): 0.25 * least}),)
        raise work.refusal(what, size, 0.5 * least, "", near, "blank.chamfer_mm")
    made: dict[tuple[int, bool], Bevel] = {}  # most edges are in both faces
    for up in (False, True):
        layer = part.steps[-1 if up else 0]
        rims = [(outside[up] if outside else layer.edge, layer, False)]
        rims += [(one.shape, layer, True) for one in layer.openings if one.kind == "INNER"]
        rims += [(one.edge, one, False) for one in part.bosses if (one.low > 0.0) == up]
        far = rims[-1][1]
        rims += [(one.shape, far, True) for one in part.openings if one.kind == "BORE"]
        for edge, of, hollow in rims:
            same = id(edge), hollow
            if same not in made:
                made[same] = _bevel(part, edge, size, work, hollow=hollow)
            by = made[same].high
            low, high = (of.high - by, of.high) if up else (of.low, of.low + by)
            yield replace(made[same], low=low, high=high, up=up)


def _bevel(part: Part, edge: Edge, size: float, work: Workpiece, *, hollow: bool) -> Bevel:
    """Return the chamfer of an edge in a lower face at 0."""
    from gearcam.parts.parallel import moved, sized
    from gearcam.parts.rolled import too_far

    whole = edge if isinstance(edge, Contour) else edge.contour(part.tolerance)
    way = 1.0 if hollow else -1.0

    def bevel(by: float) -> Bevel:
        """Return the chamfer of a size that loses no detail of the edge."""
        made = Bevel(
            edge=edge,
            middle=moved(whole, 0.5 * way * by),
            face=moved(whole, way * by),
            low=0.0,
            high=by,
            up=False,
            hollow=hollow,
        )
        if made.uneven > _UNEVEN * by * whole.length:
            raise too_far(whole, by)
        return made

    return sized(bevel, size, f"{work.name}, blank.chamfer_mm", "chamfer")


def finished(contour: Contour, blank: ShaftBlank, work: Workpiece) -> Contour:
    """Return an outline with clearance, then rounded edges.

    Parameters
    ----------
    contour : Contour
        An outline without either.
    blank : ShaftBlank
        With both sizes.
    work : Workpiece
        The part, for messages.

    Returns
    -------
    Contour

    Raises
    ------
    InfeasibleError
        If they leave no simple outline, with sizes that do.
    """
    if not (blank.clearance or blank.tip_rounding):
        return contour
    from gearcam.parts.parallel import moved, rounded, sized

    where = f"{work.name}, blank"
    clear = sized(
        lambda size: moved(contour, -size), blank.clearance, f"{where}.clearance_mm", "clearance"
    )
    return sized(
        lambda size: rounded(clear, size), blank.tip_rounding, f"{where}.tip_rounding_mm", "radius"
    )


def _demand_within(hub: Hub, contours: Sequence[Contour | Circle], work: Workpiece) -> None:
    room = 2.0 * Stock(contours=contours, work=work).room(0j)
    if hub.diameter >= room:
        key = work.key("hub_diameter_mm")
        what = f"the hub reaches {work.within if work.wheel is None else 'the roots of the teeth'}"
        smaller = (Adjustment(near={key: room}, far={key: 0.5 * room}),)
        place = "blank.hub_diameter_mm"
        raise work.refusal(what, hub.diameter, room, "at the limit they touch", smaller, place)


def _demand_marks(part: Part, blank: Any, work: Workpiece) -> None:
    """Refuse a mark that meets an opening, the hub or the outline."""
    key = "timing_marks" if blank.timing_marks else "zero_mark"
    outline, *holes = (edge.polyline(part.tolerance) for edge in part.steps[0].edges)
    for mark in part.marks:
        radius, room = 0.5 * mark.diameter, room_around(mark.center, [outline], holes)
        if part.hub is not None:
            room = min(room, abs(mark.center) - 0.5 * part.hub.diameter)
        if room < radius:
            what = f"the {key.partition('_')[0]} mark meets an opening, the hub or the outline"
            note = "the limit is the free space around its centre"
            smaller = {"blank.mark_diameter_mm": 1.9 * room} if blank.timing_marks else {}
            adjustments = (
                Adjustment(near=_between_bolts(blank, work)),
                Adjustment(near=smaller if room > 0.0 else {}),
                Adjustment(near={f"blank.{key}": False}),
            )
            limit = max(0.0, 2.0 * room)
            raise work.refusal(what, mark.diameter, limit, note, adjustments)


def _between_bolts(blank: Any, work: Workpiece) -> dict[str, object]:
    """Return the remedy that turns a bolt circle by half a step, if there are bolts."""
    if not getattr(blank, "bolt_circle", 0.0):
        return {}
    angle = math.degrees(blank.bolt_angle) + 180.0 / blank.bolts
    return {work.key("bolt_angle_deg"): angle if angle <= 360.0 else angle - 360.0}
