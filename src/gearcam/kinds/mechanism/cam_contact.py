"""The contact forces of the cams of a mechanism, under what its followers exert."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.mechanics.follower_loads import DrivenMotion

if TYPE_CHECKING:
    from collections.abc import Iterator

    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.linkages.work import VirtualWork
    from gearcam.numeric.arrays import Array

_KILO: Final = 1e3
"""N mm of a N m."""


def contact_forces(
    result: MechanismResult, work: VirtualWork, q: Array
) -> Iterator[tuple[str, Array]]:
    """Yield the normal force between each cam that is not in space and its follower.

    Without friction.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    work : VirtualWork
        What acts on it.
    q : (n,) array, rad
        The master's angles.

    Yields
    ------
    str, (n,) array, N
        Name of the drive, and the force; negative where the follower is pulled off, or of a groove,
        conjugate cams and a yoke the other wall carries. It is the force that moves the follower
        and all behind it; masses, springs and loads of the cam's own design are not in it.
    """
    from gearcam.kinds.mechanism.torque import shaft_loads

    loads = {one.drive: one for one in shaft_loads(result, work, q)}
    for drive in result.drives:
        if drive.spec.cam is not None and not drive.spec.in_space:
            exerted = loads[drive.spec.name]
            scale = _KILO if exerted.column.endswith("_nm") else 1.0
            yield drive.spec.name, scale * exerted.values / _effect(drive, q)


def _effect(drive: PlacedDrive, q: Array) -> Array:
    """Return what a unit of normal force does for a rise, N or N mm."""
    cam = drive.result.cam
    motion = cam.motions[0]
    program, follower = motion.program, motion.follower
    support = follower.held(drive.result.design.friction, program.range[1])
    _, x = program.within(drive.own(q))
    s, ds, d2s = program.derivatives(x, 2)
    push, _ = cam.touches[0].push(DrivenMotion(x, s, ds, d2s), support, 0.0)
    return push.plain
