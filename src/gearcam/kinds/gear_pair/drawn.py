"""Drawings of a gear pair: its centrodes, and the assembled pair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gearcam.parts.body import Part
from gearcam.pictures.drawings import (
    CENTER,
    CENTRODE,
    CROSS_SIZE,
    Cross,
    Drawing,
    Feature,
    Path,
    Placement,
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
    placements: tuple[Placement, Placement] | None = None,
) -> Drawing:
    """Return the drawing of the assembled pair.

    The default placement is phi1 = 0: wheel 1 in its own frame, wheel 2 shifted by the centre
    distance.

    Parameters
    ----------
    parts : two Part
        Driver first.
    center_distance : float, mm
        Position of the second shaft on x, negative for a ring; 0 for a rack, which has none.
    centrodes : sequence of Path
        In the wheels' own frames, driver first; may be empty.
    placements : two Placement, optional
        Rotation, rad, and shift, mm, of each wheel.

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
    offsets = ((0.0, 0.0), (float(center_distance), 0.0))
    stands = placements or ((0.0, offsets[0]), (0.0, offsets[1]))
    features: list[Feature] = []
    numbered = enumerate(zip(parts, stands, strict=True), start=1)
    # drawn later means on top: a wheel in its ring
    for number, (part, stand) in sorted(numbered, key=lambda one: not one[1][0].inner):
        features += place(part_features(part), *stand, prefix=f"GEAR{number}_")
    for path, stand in zip(centrodes, stands, strict=False):
        features += place([Feature(layer=CENTRODE, shape=path)], *stand)
    size = CROSS_SIZE * (abs(center_distance) or float(np.ptp(parts[0].contour.vertices)))
    for offset in offsets if center_distance else offsets[:1]:
        features.append(Feature(layer=CENTER, shape=Cross(center=np.array(offset), size=size)))
    return Drawing(name="pair", features=tuple(features))


def assembled(result: GearPairResult) -> Drawing:
    """Return the drawing of the assembled pair of a `result`, with its centrodes."""
    return pair_drawing(
        result.parts, result.pair.shift, result.centrode_paths, placements=result.placements
    )
