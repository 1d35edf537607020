"""What is drawn of a cam in space in the plane of a mechanism: its blank, and what it moves.

The cam turns about an axis in the plane: its outline stands still. Rollers are drawn where they are
at the cam's zero.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import BLANK, CENTER, CENTRODE, FOLLOWER, Cross, Feature, Path

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.placed import PlacedDrive

_ARC: Final = 97
"""Points of the outline of a globoid at each side."""

_AXIS: Final = 1.08
"""Length of the drawn axis of a cam, over that of the cam."""


def drawn_in_space(drive: PlacedDrive) -> dict[str, tuple[Feature, ...]]:
    """Return the features of a cam in space, and of what it moves.

    Parameters
    ----------
    drive : PlacedDrive
        Its drive.

    Returns
    -------
    dict of str to tuple of Feature
        By the word of what is moved, and ``cam``; in the drive's frame, at the cam's zero.
    """
    ((word, moved),) = drive.moved.items()
    cam = drive.result.cam
    if word == "turret":
        return {"cam": _globoid(cam), word: tuple(_turret(drive.result))}
    half, height = cam.outer_radius, drive.result.blank.length
    corners = np.array([-half, half, half + 1j * height, -half + 1j * height])
    first = float(drive.result.program.derivatives(0.0, 0)[0])
    ends = [moved.at + moved.along * first]
    if not moved.along:
        arm = moved.arm + moved.sense * first
        ends = [moved.at + cam.guide.length * complex(math.cos(arm), math.sin(arm)), moved.at]
    size = 2.0 * cam.roller.radius
    rollers = [ends[0] + 1j * up for up in drive.result.rollers.values()]
    shapes = [Circle(center=at, diameter=size) for at in rollers]
    lines = [Path(points=np.array(ends), closed=False)] if len(ends) > 1 else []
    return {
        "cam": (Feature(layer=BLANK, shape=Path(points=corners)), _axis(0.0, height)),
        word: tuple(Feature(layer=FOLLOWER, shape=one) for one in (*lines, *shapes)),
    }


def _axis(low: float, high: float) -> Feature:
    """Return the axis of a cam between two heights, and a little beyond."""
    middle, half = 0.5 * (low + high), 0.5 * _AXIS * (high - low)
    ends = 1j * np.array([middle - half, middle + half])
    return Feature(layer=CENTRODE, shape=Path(points=ends, closed=False))


def _globoid(cam: Any) -> tuple[Feature, ...]:
    """Return the outline of the tops of its ribs, which are arcs about the turret's axis."""
    z = np.linspace(-cam.half_length, cam.half_length, _ARC)
    right = cam.distance - np.sqrt(cam.top**2 - z**2) + 1j * z
    outline = np.concatenate([right, -right[::-1].conj()])
    edge = Feature(layer=BLANK, shape=Path(points=outline))
    return edge, _axis(-cam.half_length, cam.half_length)


def _turret(result: Any) -> Iterator[Feature]:
    """Yield the body of a turret and its rollers."""
    turret, cam = result.design.turret, result.cam
    corner = complex(turret.hub, turret.roller_radius)
    beyond = complex(turret.reach, turret.roller_radius)
    roller = np.array([corner.conjugate(), beyond.conjugate(), beyond, corner])
    for k in range(turret.stops):
        way = np.exp(1j * (math.pi - cam.guide.start - k * turret.pitch))
        yield Feature(layer=FOLLOWER, shape=Path(points=cam.distance + roller * way))
    at = complex(cam.distance)
    yield Feature(layer=FOLLOWER, shape=Circle(center=at, diameter=2.0 * turret.hub))
    yield Feature(layer=CENTER, shape=Cross(center=at, size=0.4 * turret.hub))
