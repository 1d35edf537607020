"""The scene of a cam: its parts over a turn or travel, and its follower."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcam.pictures.drawings import CENTER, FOLLOWER, Feature, place
from gearcam.pictures.scenes import PLACES, ContactPoints, MovingBody, Scene, still

if TYPE_CHECKING:
    from gearcam.cams.wall import PitchMotion, Wall
    from gearcam.kinds.cam.build import CamResult
    from gearcam.numeric.arrays import Array, Plane


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
    driver, carrier = motion.mechanism.driver, motion.mechanism.carrier
    output = result.design.output
    pose = output.pose if carrier.around else (output.place or 0.0) / driver.scale
    theta = np.linspace(0.0, 2.0 * math.pi, places + 1)
    turn, shift = _pose(motion, theta)
    (turned,), (shifted,) = _pose(motion, np.array([pose]))
    back = -float(turned), (-float(shifted.real), -float(shifted.imag))
    shown = result.drawing.features
    plates = [one for one in shown if one.kind not in (CENTER, FOLLOWER)]
    angle, way = _carried(motion, theta, pose)
    follower = MovingBody(
        name="follower",
        called="follower",
        features=tuple(one for one in shown if one.kind == FOLLOWER),
        turn=angle,
        shift=way,
    )
    several = len(result.parts) > 1
    cams = [
        MovingBody(
            name=part.name,
            called=f"cam {number}" if several else "cam",
            features=place(_of_part(plates, part.name if several else ""), *back),
            turn=turn,
            shift=shift,
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
        contacts=_contacts(result, theta, turn, shift),
    )


def _of_part(features: list[Feature], name: str) -> list[Feature]:
    """Return the features on layers that begin with the name of a part."""
    return [one for one in features if one.layer.startswith(name.upper())]


def _pose(motion: PitchMotion, theta: Array) -> tuple[Array, Plane]:
    """Return the rotation, rad, and shift, mm, of the cam."""
    carrier = motion.mechanism.carrier
    turn, (_, shift) = carrier.rate * theta, carrier.frame(theta)
    return (-turn, -np.conj(shift)) if motion.clockwise else (turn, shift)


def _carried(motion: PitchMotion, theta: Array, pose: float) -> tuple[Array, Plane]:
    """Return the rigid motion of a follower that is drawn at the cam angle `pose`."""
    lift = motion.program.derivatives(theta, 0)[0] - float(motion.program.derivatives(pose, 0)[0])
    turn, way = motion.mechanism.follower.moved(lift)
    return (-turn, -np.conj(way)) if motion.clockwise else (turn, way)


def _contacts(
    result: CamResult, theta: Array, turn: Array, shift: Plane
) -> dict[str, ContactPoints]:
    """Return points of contact on each wall, or on both sides of a cam in a yoke."""

    def found(wall: Wall, ahead: float = 0.0) -> ContactPoints:
        asked = theta + ahead
        left, points, normals = wall.places_at(asked)
        at = np.searchsorted(asked, left)
        stand = np.exp(1j * turn[at])
        return ContactPoints(
            start=np.searchsorted(left, np.append(asked, np.inf)),
            point=points * stand + shift[at],
            force=normals * stand,
        )

    if result.form.half_turns:  # the upper side touches a point half a turn after the lower side
        (profile,) = result.cam.walls
        return {"upper side": found(profile), "lower side": found(profile, math.pi)}
    return {wall.called: found(wall) for wall in result.cam.walls}
