"""Cross-checks of a cam: the motion on its profile, and what an error of the profile does."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from shapely import Point

from gearcam.cams.caliper import caliper
from gearcam.cams.carriers import unit
from gearcam.cams.precision import sensitivities
from gearcam.cams.wall import Wall
from gearcam.kinds.cam.given_profile import followed
from gearcam.kinds.cam.result import CamResult
from gearcam.numeric.arrays import Array

_ANGLES: Final = 120
"""Number of cam angles at which the lift is computed."""

_ROOM: Final = 3.0
"""Allowed error along the normal, in chord tolerances, for a follower on two chords."""

_ROUNDING: Final = 1e-9
"""Allowed error relative to the size of the profile."""

_ALIKE: Final = 1e-6
"""Allowed relative difference of two forms of a sensitivity, of steep cams too."""


def doubts(result: CamResult) -> Iterator[tuple[str, str]]:
    """Yield places where the lift from the polygon of a wall differs from the specified lift.

    Parameters
    ----------
    result : CamResult
        The result to check.

    Yields
    ------
    place, words : str
        Place and description of a contradiction.
    """
    theta = result.program.period / _ANGLES * (np.arange(float(_ANGLES)) + 0.5)
    for wall, contour in zip(result.cam.walls, result.profiles, strict=True):
        yield from _radii_beside_the_outline(wall)
        bulges = np.zeros(len(contour.points))
        columns, _, _ = followed(wall, contour.points, bulges, theta, result.design.limits)
        off = np.abs(columns["difference"])
        room = _room(wall, theta)
        worst = int((off - room).argmax())
        if off[worst] > room[worst]:
            at = wall.carrier.driver.text(float(theta[worst]))
            words = f"{wall.called} {wall.key}: the lift at {at} differs by {off[worst]}"
            yield "lift", f"{words}, {room[worst]} {wall.follower.lift_unit[1]} are allowed"
        # metal in excess lifts by its share along the follower's direction
        lifted = sensitivities(wall, result.cam.linked(wall), theta)["profile"]
        off = np.abs(np.abs(lifted) * _lever(wall, theta) - 1.0)
        if np.nanmax(off, initial=0.0) > _ALIKE:
            at = wall.carrier.driver.text(float(theta[int(np.nanargmax(off))]))
            yield "precision", f"{wall.called} {wall.key}: an error of the profile at {at}"


def _radii_beside_the_outline(wall: Wall) -> Iterator[tuple[str, str]]:
    """Yield the radii for a caliper whose places are not on the polygon."""
    if not wall.carrier.around:
        return
    angles = np.linspace(0.0, 6.2, _ANGLES)
    place = caliper(wall, angles) * unit(angles)
    outline: Any = wall.contour.polygon.exterior
    off = np.array([outline.distance(Point(one.real, one.imag)) for one in place.tolist()])
    worst = int(np.argmax(off))
    size = _ROUNDING * np.abs(place).max()
    if not off[worst] <= wall.tolerance + size:
        yield "caliper", f"{wall.called} {wall.key}: {off[worst]} beside it at {angles[worst]} rad"


def _room(wall: Wall, theta: Array) -> Array:
    """Return the allowed error of the lift at cam angles, in the unit of files."""
    normal = _ROOM * wall.tolerance + _ROUNDING * np.abs(wall.outline).max()
    return wall.follower.lift_unit[0] * (normal / _lever(wall, theta) + wall.shortfall)


def _lever(wall: Wall, theta: Array) -> Array:
    """Return mm along the normal of the contact per unit of lift, at cam angles."""
    follower, contact = wall.follower, wall.curve.contact(theta, 0)
    lever = follower.lever * np.cos(contact.pressure.c[0])
    if not follower.has_centre:  # perpendicular to the face
        lever = np.abs(contact.place.c[0]) if follower.angular else 1.0
    return lever + np.zeros_like(theta)
