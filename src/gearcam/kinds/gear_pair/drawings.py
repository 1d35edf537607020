"""Drawings of a gear pair: its centrodes, and both wheels assembled."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from gearcam.gears.pair import Gear
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Part
from gearcam.pictures.drawings import (
    CENTER,
    CENTRODE,
    CROSS_SIZE,
    Cross,
    Drawing,
    Feature,
    Path,
    part_features,
    place,
)

_POINTS: Final = 720
"""Intervals of a centrode that is drawn."""


def centrode_path(gear: Gear, end: float, away: float = 0.0) -> Path:
    """Return the centrode of a wheel as a chain in its own frame, or a parallel of it.

    Parameters
    ----------
    gear : Gear
        The wheel.
    end : float, rad
        Driver angle at its end.
    away : float, mm
        How far away from the centrode it is, towards the tips.

    Returns
    -------
    Path
    """
    closed = gear.toothing.closed
    phi1 = np.linspace(0.0, end, _POINTS + 1)[: -1 if closed else None]
    frames = gear.toothing.frames(phi1)
    return Path(points=frames.p + away * gear.toothing.turn * frames.t, closed=closed)


def pair_drawing(
    parts: Sequence[Part],
    center_distance: float,
    centrodes: Sequence[Path] = (),
    *,
    poses: tuple[Pose, Pose] | None = None,
) -> Drawing:
    """Return the drawing of the assembled pair.

    By default phi1 = 0: wheel 1 in its own frame, wheel 2 shifted by the centre distance.

    Parameters
    ----------
    parts : two Part
        Driver first.
    center_distance : float, mm
        Position of the second shaft on x, negative for a ring; 0 for a rack, which has none.
    centrodes : sequence of Path
        In the wheels' own frames, driver first; may be empty.
    poses : two Pose, optional
        Where the wheels are.

    Returns
    -------
    Drawing

    Raises
    ------
    ValueError
        If there are not two parts, or centrodes for another number of wheels.
    """
    if len(parts) != 2 or len(centrodes) not in (0, 2):
        raise ValueError("a pair takes two parts, and two centrodes or none")
    poses = poses or (Pose(), Pose(shift=center_distance))
    features: list[Feature] = []
    numbered = enumerate(zip(parts, poses, strict=True), start=1)
    # drawn later means on top: a wheel in its ring
    for number, (part, pose) in sorted(numbered, key=lambda one: not one[1][0].inner):
        features += place(part_features(part), pose, prefix=f"GEAR{number}_")
    for path, pose in zip(centrodes, poses, strict=False):
        features += place([Feature(layer=CENTRODE, shape=path)], pose)
    size = CROSS_SIZE * (abs(center_distance) or float(np.ptp(parts[0].contour.vertices)))
    for shaft in (0.0, center_distance) if center_distance else (0.0,):
        cross = Cross(center=shaft, size=size)
        features.append(Feature(layer=CENTER, shape=cross))
    return Drawing(name="pair", features=tuple(features))
