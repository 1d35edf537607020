"""The scene of a gear pair: both wheels over a turn of the driver, or its travel."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

import numpy as np

from gearcam.kinds.gear_pair.charts import DRIVER
from gearcam.kinds.gear_pair.result import CENTRODE_POINTS, Side
from gearcam.meshing.contact import contacts
from gearcam.pictures.drawings import CENTER, CENTRODE, CROSS_SIZE, Cross, Feature, part_features
from gearcam.pictures.scenes import PLACES, ContactPoints, MovingBody, Scene, still

if TYPE_CHECKING:
    from gearcam.gears.pair import Gear
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.numeric.arrays import Array
    from gearcam.numeric.pose import Pose
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Path


def scene(result: GearPairResult, places: int = PLACES) -> Scene:
    """Return both wheels with their centrodes, points of contact, and the pitch point.

    Parameters
    ----------
    result : GearPairResult
        The pair; of stepped wheels the lowest step is on top, with its points of contact.
    places : int
        Steps of the driver.

    Returns
    -------
    Scene
        As designed: finished teeth in contact, the driven element behind by the lag of `contact`.
    """
    guide, pose = result.pair.rolling.guide, result.design.output.pose
    phi1 = result.turn(places)
    end = float(phi1[-1])
    names = ("driver", "rack" if result.pair.on_rack else "driven wheel")
    poses = result.pair.rolling.poses(phi1)
    wheels = zip(result.gears, result.parts, names, result.centrode_paths, poses, strict=True)
    bodies = [_stepped(*wheel) for wheel in wheels]
    size = CROSS_SIZE * (abs(result.pair.shift) or float(np.ptp(result.gear1.outline)))
    shafts = (0.0, result.pair.shift) if guide.turns else (0.0,)
    crosses = tuple(Feature(layer=CENTER, shape=Cross(center=x, size=size)) for x in shafts)
    lowest = [steps[0] for steps in bodies]
    behind = [step for steps in bodies for step in steps[:0:-1]]
    radius = result.pair.rolling.tracks[0].frames(phi1).p
    return Scene(
        title=result.design.name,
        driver=DRIVER,
        places=np.degrees(phi1),
        closed=result.pair.closed,
        start=float(np.degrees(pose % end if result.pair.closed else min(max(pose, 0.0), end))),
        bodies=(*behind, *(lowest[::-1] if result.pair.internal else lowest), still(crosses, phi1)),
        contacts={side: _contacts(result, phi1, side) for side in get_args(Side)},
        pitch=radius * np.exp(-1j * phi1),
    )


def _stepped(gear: Gear, part: Part, called: str, path: Path, pose: Pose) -> list[MovingBody]:
    """Return the steps of a wheel as bodies that move together, the lowest with its teeth."""
    # the toothed edge first: for a ring the inner one
    lowest = sorted(part_features(part), key=lambda one: one.shape is not part.contour)
    first = MovingBody(
        name=part.name,
        called=called,
        features=(*lowest, Feature(layer=CENTRODE, shape=path)),
        pose=pose,
        teeth=gear.profile.teeth[1],
    )
    others = [
        MovingBody(
            name=part.name,
            called=f"{called}, step {step + 1}",
            features=part_features(part, step),
            pose=pose,
        )
        for step in range(1, len(part.contours))
    ]
    return [first, *others]


def _contacts(result: GearPairResult, phi1: Array, side: Side) -> ContactPoints:
    """Return points of contact on one side of the driver's teeth, from charts if computed."""
    pairs, at = result.flanks_of(side), np.arange(len(phi1))
    if len(phi1) == CENTRODE_POINTS + 1:
        touching, at = result.touching[side], np.searchsorted(result.phases, phi1)
    else:
        touching = contacts(pairs, phi1)
    chosen = np.isin(touching.step, at)
    j, first = touching.pair[chosen], [gear.profile.teeth[0][0] for gear in result.gears]
    return ContactPoints(
        start=np.searchsorted(touching.step[chosen], np.append(at, at[-1] + 1)),
        point=touching.point[chosen],
        force=touching.force[chosen],
        teeth=np.column_stack([pairs.tooth(1, j), pairs.tooth(2, j)]) - first + 1,
    )
