"""The scene of a cam: its parts over a turn or travel, and its follower."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.kinds.cam.coloured import coloured
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import CENTER, FOLLOWER, Feature, place
from gearcam.pictures.scenes import PLACES, ContactPoints, MovingBody, Scene, still

if TYPE_CHECKING:
    from gearcam.cams.wall import PitchMotion, Wall
    from gearcam.kinds.cam.build import CamResult
    from gearcam.numeric.arrays import Array


def scene(result: CamResult, places: int = PLACES) -> Scene:
    """Return cam and follower: the drawing of the cam, divided into rigid bodies.

    Parameters
    ----------
    result : CamResult
        The cam.
    places : int
        Steps of the driver.

    Returns
    -------
    Scene
        As designed, before clearance; without contact where the follower rests on a corner.
    """
    motion = result.cam.motions[0]
    driver, carrier = motion.carrier.driver, motion.carrier
    output: Any = result.design.output
    pose = output.pose if carrier.around else output.place
    theta = np.linspace(0.0, motion.program.period, places + 1)
    moving, drawn = (_pose(motion, at) for at in (theta, np.array([pose])))
    back = Pose(float(drawn.turn[0]), complex(drawn.shift[0])).inverse
    shown = result.drawing.features
    plates = [one for one in shown if one.kind not in (CENTER, FOLLOWER)]
    follower = MovingBody(
        name="follower",
        called="follower",
        features=tuple(one for one in shown if one.kind == FOLLOWER),
        pose=_carried(motion, theta, pose),
    )
    several = len(result.parts) > 1
    cams = [
        MovingBody(
            name=part.name,
            called=f"cam {number}" if several else "cam",
            features=place(_of_part(plates, part.name if several else ""), back),
            pose=moving,
        )
        for number, part in enumerate(result.parts, start=1)
    ]
    fixed = still(tuple(one for one in shown if one.kind == CENTER), theta)
    return Scene(
        title=result.design.name,
        driver=f"{driver.called} {driver.symbol}, {driver.unit}",
        places=driver.scale * theta,
        closed=not result.program.open,
        start=driver.scale * (pose % (2.0 * math.pi) if carrier.around else pose),
        bodies=(*cams, follower, fixed),
        contacts=_contacts(result, theta, moving),
        coloured=coloured(result, theta),
    )


def _of_part(features: list[Feature], name: str) -> list[Feature]:
    """Return the features on layers that begin with the name of a part."""
    return [one for one in features if one.layer.startswith(name.upper())]


def _pose(motion: PitchMotion, theta: Array) -> Pose:
    """Return the pose of the cam at cam angles, rad."""
    carrier = motion.carrier
    return _mirrored(motion, Pose(carrier.rate * theta, carrier.frame(theta)[1]))


def _carried(motion: PitchMotion, theta: Array, pose: float) -> Pose:
    """Return the pose of a follower that is drawn at the cam angle `pose`, at cam angles, rad."""
    lift = motion.program.derivatives(theta, 0)[0] - float(motion.program.derivatives(pose, 0)[0])
    return _mirrored(motion, Pose(*motion.follower.moved(lift)))


def _mirrored(motion: PitchMotion, pose: Pose) -> Pose:
    """Return a pose, mirrored in the y-axis if the cam turns clockwise."""
    return Pose(-pose.turn, -np.conj(pose.shift)) if motion.clockwise else pose


def _contacts(result: CamResult, theta: Array, pose: Pose) -> dict[str, ContactPoints]:
    """Return points of contact on each wall, or on both sides of a cam in a yoke."""

    def found(wall: Wall, ahead: float = 0.0) -> ContactPoints:
        asked = theta + ahead
        left, points, normals = wall.places_at(asked)
        there = pose[np.searchsorted(asked, left)]
        return ContactPoints(
            start=np.searchsorted(left, np.append(asked, np.inf)),
            point=there.apply(points),
            force=normals * there.rotation,
        )

    if result.form.half_turns:  # the upper side touches a point half a turn after the lower side
        (profile,) = result.cam.walls
        return {"upper side": found(profile), "lower side": found(profile, math.pi)}
    return {wall.called: found(wall) for wall in result.cam.walls}
