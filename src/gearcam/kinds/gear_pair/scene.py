"""The scene of a gear pair: both wheels over a turn of the driver, or its travel."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

import numpy as np

from gearcam.drawings import CENTER, CENTRODE, CROSS_SIZE, Cross, Feature, part_features
from gearcam.kinds.gear_pair.build import Side
from gearcam.kinds.gear_pair.charts import DRIVER
from gearcam.kinds.gear_pair.files import centrode_paths
from gearcam.scenes import PLACES, ContactPoints, MovingBody, Scene, still

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.build import GearPairResult
    from gearcam.numeric.arrays import Array


def scene(result: GearPairResult, *, contacts: bool = True) -> Scene:
    """Return both wheels with their centrodes, teeth that touch, and the pitch point.

    Parameters
    ----------
    result : GearPairResult
        A built design.
    contacts : bool
        Whether the teeth that touch are sought; without them it is sooner there.

    Returns
    -------
    Scene
    """
    sides: tuple[Side, ...] = get_args(Side) if contacts else ()
    guide, lobes = result.pair.rolling.guide, result.law.lobes
    end = lobes.n1 * lobes.period if result.pair.toothings[0].closed else result.law.period
    phi1 = np.linspace(0.0, end, PLACES + 1)
    moved = guide.nominal(phi1)
    way = np.zeros_like(moved) if guide.turns else moved
    shift = np.asarray(guide.place - 1j * way, dtype=np.complex128)
    placements = ((-phi1, np.zeros_like(shift)), (guide.turns * moved, shift))
    bodies = []
    rows = zip(result.gears, result.parts, centrode_paths(result), placements, strict=True)
    for gear, part, path, (turn, place) in rows:
        features = (*part_features(part), Feature(layer=CENTRODE, shape=path))
        name = "driver" if gear.wheel == 1 else "rack" if result.pair.on_rack else "driven"
        bodies.append(
            MovingBody(name=part.name, called=name, features=features, turn=turn, shift=place)
        )
    size = CROSS_SIZE * (abs(result.pair.shift) or float(np.ptp(result.gear1.outline)))
    shafts = (0.0, result.pair.shift) if guide.turns else (0.0,)
    crosses = tuple(
        Feature(layer=CENTER, shape=Cross(center=np.array([x, 0.0]), size=size)) for x in shafts
    )
    radius = result.pair.rolling.tracks[0].frames(phi1).p
    return Scene(
        title=result.design.name,
        driver=DRIVER,
        places=np.degrees(phi1),
        closed=result.pair.closed,
        start=float(np.degrees(result.design.output.pose % (lobes.n1 * lobes.period))),
        bodies=(*(bodies[::-1] if result.pair.internal else bodies), still(crosses, phi1)),
        contacts={side: _contacts(result, phi1, side) for side in sides},
        pitch=radius * np.exp(-1j * phi1),
    )


def _contacts(result: GearPairResult, phi1: Array, side: Side) -> ContactPoints:
    """Return where teeth touch on one side of the driver's, as designed."""
    table = result.contact(phi1, side)
    return ContactPoints(
        start=np.searchsorted(table["phi1_deg"], np.append(np.degrees(phi1), np.inf)),
        point=table["x_mm"] + 1j * table["y_mm"],
        force=table["force_x"] + 1j * table["force_y"],
        teeth=np.column_stack([table["tooth1"], table["tooth2"]]),
    )
