"""The contact forces of the cams of a mechanism, under what its followers exert."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.mechanics.follower_loads import DrivenMotion
from gearcam.results.nested import within

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
    """Yield the normal force between each cam and its follower, without friction.

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
        conjugate cams, a yoke, a rib and a turret the other wall carries. It is the force that
        moves the follower and all behind it; masses, springs and loads of the cam's own design are
        not in it.

    Raises
    ------
    InfeasibleError
        If a wall of a cam in space is undercut, or its turret is not held at all angles.
    """
    from gearcam.kinds.mechanism.torque import shaft_loads

    loads = {one.drive: one for one in shaft_loads(result, work, q)}
    for number, drive in enumerate(result.drives):
        if drive.spec.cam is not None:
            exerted = loads[drive.spec.name]
            scale = _KILO if exerted.column.endswith("_nm") else 1.0
            with within(f"drive[{number}].cam"):
                effect = _effect(drive, q)
            yield drive.spec.name, scale * exerted.values / effect


def _effect(drive: PlacedDrive, q: Array) -> Array:
    """Return what a unit of normal force does for a rise, N or N mm."""
    motion = drive.result.cam.motions[0]
    program, follower = motion.program, motion.follower
    support = follower.held(drive.result.design.friction, program.range[1])
    _, x = program.within(drive.own(q))
    s, ds, d2s = program.derivatives(x, 2)
    moves = DrivenMotion(x, s, ds, d2s)
    found = (one.push(moves, support, 0.0)[0].plain for one in drive.result.touches)
    effect = next(found)
    if (effect < 0.0).any():  # of the wall that presses in the lift, if there is one
        effect = next(found, effect)
    return effect
