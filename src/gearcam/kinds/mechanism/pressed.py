"""Lines of action of the drives of a mechanism: teeth, and cams on their followers.

All teeth of a pair that are cut by a rack, or by a pinion cutter of that rack, touch on a line
through the pitch point, at the rack's pressure angle to the tangent of both centrodes there, on one
side or the other by which flanks carry. A cam presses along the normal of the wall that carries.
Flanks and walls are without friction.
"""

from __future__ import annotations

import cmath
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.mechanism.keys import center_of, way_of
from gearcam.linkages.contacts import DriveContact, LineOfAction, Moving, carrier
from gearcam.linkages.reactions import Structure
from gearcam.mechanics.follower_loads import DrivenMotion
from gearcam.results.nested import within

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.linkages.linkage import Linkage
    from gearcam.mechanics.supports import Push
    from gearcam.numeric.arrays import Array

_PLACES: Final = 24
"""Angles of the range at which two shafts are compared."""


def contacts_of(drives: Sequence[PlacedDrive], linkage: Linkage) -> Iterator[DriveContact]:
    """Yield what the pairs and the cams of a mechanism press on, by the names of the drives.

    Parameters
    ----------
    drives : sequence of PlacedDrive
        The drives.
    linkage : Linkage
        What they move, with their own masses.

    Yields
    ------
    DriveContact
        Of a pair, in the sense in which wheel 2 or the rack moves with the driver; of a cam, in
        that of the lift: it is negative where the follower is pulled off, or of a groove, conjugate
        cams, a yoke, a rib and a turret the other wall carries. Masses, springs and loads of the
        cam's own design are not in it. Angles at which it is asked raise `InfeasibleError` if a
        wall of a cam in space is undercut, or its turret is not held at all of them.
    """
    bonds, known = Structure.of(linkage).by_member, linkage.at(linkage.even_places(_PLACES), 1)

    def moving(drive: PlacedDrive, word: str) -> Moving:
        name = f"{drive.spec.name}.{word}"
        stands = way_of(name) if drive.moved[word].along else center_of(name)
        return Moving(name, stands, carrier(bonds, known, name, stands))

    for number, drive in enumerate(drives):
        if drive.result is None:
            continue
        *driver, driven = drive.moved
        sense, lines = drive.moved[driven].sense, partial(_of_cam, drive, f"drive[{number}].cam")
        if drive.spec.pair is not None:  # turns of a ring and ways of a rack fall
            sense = 1.0 if drive.result.pair.rolling.mate > 0 else -1.0
            lines = partial(_of_pair, drive)
        yield DriveContact(
            name=drive.spec.name,
            driven=moving(drive, driven),
            sense=-sense if drive.spec.mirror and not drive.moved[driven].along else sense,
            lines=lines,
            driver=moving(drive, driver[0]) if driver else None,
        )


def _of_pair(drive: PlacedDrive, q: Array) -> tuple[LineOfAction, LineOfAction]:
    """Return the lines of action of the flanks that hold back, and of those that drive."""
    pair, phi1 = drive.result.pair, drive.own(q)
    guide, turned = pair.rolling.guide, np.exp(-1j * phi1)
    frames = pair.rolling.tracks[0].frames(phi1, curved=False)
    point, tangent = frames.p * turned, frames.t * turned  # of the pitch point

    def line(sign: float) -> LineOfAction:
        # both wheels move against the tangent there; flanks push off the driver's shaft
        way = -sign * tangent * cmath.exp(1j * sign * pair.rack.pressure_angle)
        effect = guide.lever(point - guide.place, way)
        force = drive.vector(way / effect)
        return LineOfAction(force, drive.machine(point), 1.0 / np.abs(effect))

    return line(-1.0), line(1.0)


def _of_cam(drive: PlacedDrive, where: str, q: Array) -> tuple[LineOfAction, LineOfAction]:
    """Return the lines of action of the wall that presses against the lift, and in the lift.

    One that only presses pulls along the same line: what holds its follower on it does.
    """
    motion = drive.result.cam.motions[0]
    with within(where):
        pushes = list(_pushes(drive, q))

    def line(sign: float) -> LineOfAction:
        push = next((one for one in pushes if (sign * one.plain >= 0.0).all()), pushes[0])
        force, at = push.unit / push.plain, push.at
        if motion.clockwise:  # the plane of its motion is seen in a mirror
            force, at = -np.conj(force), -np.conj(at)
        normal = 1.0 / (push.plain if len(pushes) == 1 else np.abs(push.plain))
        return LineOfAction(drive.vector(force), drive.machine(at), normal)

    return line(-1.0), line(1.0)


def _pushes(drive: PlacedDrive, q: Array) -> Iterator[Push]:
    """Yield what the walls of a cam exert, of which each can press."""
    motion = drive.result.cam.motions[0]
    program, follower = motion.program, motion.follower
    support = follower.held(drive.result.design.friction, program.range[1])
    _, x = program.within(drive.own(q))
    s, ds, d2s = program.derivatives(x, 2)
    moves = DrivenMotion(x, s, ds, d2s)
    for one in drive.result.touches:
        yield one.push(moves, support, 0.0)[0]
