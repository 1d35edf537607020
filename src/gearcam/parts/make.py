"""Building a part: finished outlines, openings, hub and mark.

Refused: openings, hubs and marks without space.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from gearcam.base.adjustments import Adjustment
from gearcam.numeric.contour import Contour
from gearcam.numeric.polygons import room_around
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Hub, Mark, Part, Recess
from gearcam.parts.openings import Stock, Workpiece, openings
from gearcam.parts.shapes import Circle


def make_part(
    name: str,
    contours: Sequence[Contour | Circle],
    width: float,
    blank: WheelBlank,
    work: Workpiece,
    marker: Callable[[], Mark] | None = None,
    *,
    inner: Sequence[Contour] = (),
    recesses: tuple[Recess, ...] = (),
    room: Sequence[Contour] = (),
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
    blank : WheelBlank
        Settings of the blank.
    work : Workpiece
        The wheel.
    marker : callable, optional
        Returns the timing mark; called only if marks are requested.
    inner : sequence of Contour
        For a ring: the true inner edges.
    recesses : tuple of Recess
        Pockets milled into its faces.
    room : sequence of Contour
        Contours that openings and hub must lie within; by default the outlines.

    Returns
    -------
    Part

    Raises
    ------
    InfeasibleError
        If an opening, hub or mark has no space.
    """
    found = openings(blank, room or contours, work, inner)
    hub = None
    if blank.hub_diameter:
        hub = Hub(diameter=blank.hub_diameter, front=blank.hub_front, back=blank.hub_back)
        _demand_within(hub, room or contours, work)
    marks = (marker(),) if marker is not None and blank.timing_marks else ()
    part = Part(
        name=name,
        contours=tuple(contours),
        width=width,
        openings=found,
        inner=tuple(inner),
        hub=hub,
        marks=marks,
        recesses=recesses,
    )
    _demand_marks(part, blank, work)
    return part


def finished(contour: Contour, blank: WheelBlank, work: Workpiece) -> Contour:
    """Return an outline with clearance, then rounded edges.

    Parameters
    ----------
    contour : Contour
        An outline without either.
    blank : WheelBlank
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


def _demand_marks(part: Part, blank: WheelBlank, work: Workpiece) -> None:
    """Refuse a mark that meets an opening, the hub or the outline."""
    if not part.marks:
        return
    outline, *holes = (edge.polyline(part.tolerance) for edge in part.steps[0].edges)
    for mark in part.marks:
        radius, room = 0.5 * mark.diameter, room_around(mark.center, [outline], holes)
        if part.hub is not None:
            room = min(room, abs(mark.center) - 0.5 * part.hub.diameter)
        if room < radius:
            what = "the timing mark meets an opening, the hub or the outline"
            note = "the limit is the free space around its centre"
            adjustments = (
                Adjustment(near=_between_bolts(blank, work)),
                Adjustment(near={"blank.mark_diameter_mm": 1.9 * room} if room > 0.0 else {}),
                Adjustment(near={"blank.timing_marks": False}),
            )
            limit = max(0.0, 2.0 * room)
            raise work.refusal(what, mark.diameter, limit, note, adjustments)


def _between_bolts(blank: WheelBlank, work: Workpiece) -> dict[str, object]:
    """Return the remedy that turns a bolt circle by half a step, if there are bolts."""
    if not blank.bolts:
        return {}
    angle = math.degrees(blank.bolt_angle) + 180.0 / blank.bolts
    return {work.key("bolt_angle_deg"): angle if angle <= 360.0 else angle - 360.0}
