"""Drawings of a gear pair: its centrodes, and the assembled pair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

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

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult


def centrode_paths(result: GearPairResult) -> tuple[Path, Path]:
    """Return the centrodes of a `result` as chains, each in its wheel's own frame, driver first."""
    lobes = result.law.lobes
    ends = [lobes.n1 * lobes.period, lobes.n2 * lobes.period]
    if result.pair.on_rack:
        ends[1] = result.centrode_angles()[-1]
    paths = []
    for gear, end in zip(result.gears, ends, strict=True):
        closed = gear.toothing.closed
        turn = np.linspace(0.0, end, 721)[: -1 if closed else None]
        paths.append(Path(points=gear.centrode(turn), closed=closed))
    first, second = paths
    return first, second


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
        cross = Cross(center=np.array([shaft, 0.0]), size=size)
        features.append(Feature(layer=CENTER, shape=cross))
    return Drawing(name="pair", features=tuple(features))


def assembled(result: GearPairResult) -> Drawing:
    """Return the drawing of the assembled pair of a `result`, with its centrodes."""
    return pair_drawing(result.parts, result.pair.shift, result.centrode_paths, poses=result.poses)
