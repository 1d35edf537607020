"""The scene of a cam: its parts over a turn, or a way, and its follower."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcam.drawings import CENTER, FOLLOWER, Feature, place
from gearcam.scenes import PLACES, MovingBody, Scene, still

if TYPE_CHECKING:
    from gearcam.cams.wall import PitchMotion
    from gearcam.kinds.cam.build import CamResult
    from gearcam.numeric.arrays import Array, Plane


def scene(result: CamResult, *, contacts: bool = True) -> Scene:  # noqa: ARG001  (none are told)
    """Return cam and follower: the picture of the cam, taken apart into what moves together.

    Parameters
    ----------
    result : CamResult
        A built design.
    contacts : bool
        Whether points of contact are sought.

    Returns
    -------
    Scene
    """
    output, motion = result.design.output, result.cam.motions[0]
    driver = motion.mechanism.driver
    pose = (output.place or 0.0) / driver.scale if result.form.slides else output.pose
    theta = np.linspace(0.0, 2.0 * np.pi, PLACES + 1)
    side = -1.0 if motion.clockwise else 1.0
    plates: list[Feature] = []
    carried: list[Feature] = []
    fixed: list[Feature] = []
    for one in result.form.picture(result).features:
        {CENTER: fixed, FOLLOWER: carried}.get(one.kind, plates).append(one)
    if motion.mechanism.slide:
        turn, shift = 0.0 * theta, np.asarray(-motion.mechanism.slide * theta, dtype=np.complex128)
        own = place(plates, 0.0, (motion.mechanism.slide * pose, 0.0))
    else:
        turn, shift = side * theta, np.zeros(len(theta), dtype=np.complex128)
        own = place(plates, -side * pose, (0.0, 0.0))
    angle, way = _carried(motion, theta, pose)
    return Scene(
        title=result.design.name,
        driver=f"{driver.called} {driver.symbol}, {driver.unit}",
        places=driver.scale * theta,
        closed=not result.program.open,
        start=driver.scale * (pose % (2.0 * np.pi)),
        bodies=(
            MovingBody(name="cam", called="cam", features=own, turn=turn, shift=shift),
            MovingBody(
                name="follower", called="follower", features=tuple(carried), turn=angle, shift=way
            ),
            still(tuple(fixed), theta),
        ),
    )


def _carried(motion: PitchMotion, theta: Array, pose: float) -> tuple[Array, Plane]:
    """Return how a follower, drawn where it stands at a cam angle `pose`, moves as a rigid body."""
    m, side = motion.mechanism, -1.0 if motion.clockwise else 1.0
    lift = motion.program.derivatives(theta, 0)[0] - float(motion.program.derivatives(pose, 0)[0])
    if not m.oscillating:
        return 0.0 * theta, np.asarray(1j * np.exp(1j * m.tilt) * lift, dtype=np.complex128)
    if m.slide:
        turn, pivot = lift, complex(-m.pivot, m.height)
    else:
        turn, pivot = -side * lift, complex(side * m.pivot, 0.0)
    return turn, np.asarray(pivot * (1.0 - np.exp(1j * turn)), dtype=np.complex128)
