"""What drives move, each in its own frame: shafts and slides as functions of the drive's place.

A pair stands as assembled: wheel 1 turns by -phi1 about the origin, wheel 2 by phi2 about (A, 0); a
ring turns by -phi2. A rack moves along -y. A cam turns counter-clockwise by theta about the origin,
or clockwise; its follower is lifted along its guide, or turns about its pivot. A plate moves by u
along +x, below its follower.

Of a cam in space the frame's plane is that in which its follower moves, and the cam's axis is its
y axis. Of a cylinder cam x is the cam's y, seen from the roller; of a globoidal cam x runs from the
cam's axis towards that of its turret, which a rising roller turns clockwise.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.elements import Law
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.drives import MachineDrive
    from gearcam.laws.displacement import Displacement


@dataclass(frozen=True, eq=False)
class Moved(ShortRepr):
    """One thing that a drive moves, in the drive's frame.

    Parameters
    ----------
    law : callable
        ``law(x, order) -> Jet`` over the drive's own place: its turn, rad, or its place, mm.
    at : complex, mm
        Where its shaft stands, or the zero of its places.
    along : complex
        Direction of its way; 0 for a shaft.
    arm : float, rad
        Direction of the arm of an oscillating follower at zero lift; nan if there is none.
    sense : float
        -1 where lift turns it clockwise, or an index of its turret does; else +1.
    """

    law: Law
    at: complex = 0j
    along: complex = 0j
    arm: float = math.nan
    sense: float = 1.0


def linear(factor: float, constant: float = 0.0) -> Law:
    """Return the law ``factor*x + constant``."""

    def law(x: Array, order: int) -> Jet:
        return Jet.variable(x, order) * factor + constant

    return law


def displaced(by: Displacement, factor: float, constant: float = 0.0) -> Law:
    """Return the law ``factor*y(x) + constant`` of a displacement y.

    Parameters
    ----------
    by : Displacement
        A ratio law or a program of lift.
    factor, constant : float
        In the units of its values.
    """

    def law(x: Array, order: int) -> Jet:
        found = by.derivatives(x, order)
        scaled = [factor * value / math.factorial(k) for k, value in enumerate(found)]
        return Jet([scaled[0] + constant, *scaled[1:]])

    return law


def moved_by(drive: MachineDrive, result: Any) -> dict[str, Moved]:
    """Return what a drive moves.

    Parameters
    ----------
    drive : MachineDrive
        Its table.
    result : GearPairResult, CamResult or None
        Of the pair or the cam.

    Returns
    -------
    dict of str to Moved
        By the words of `MachineDrive.shafts`.
    """
    if drive.pair is not None:
        return _of_pair(result)
    if drive.cam is not None:
        return _OF_CAMS.get(drive.cam.kind, _of_cam)(result)
    if drive.slide is not None:
        return {"slide": Moved(linear(1.0), 0j, 1 + 0j)}
    return {"shaft": Moved(linear(1.0))}


def _of_pair(result: Any) -> dict[str, Moved]:
    pair = result.pair
    law, distance = pair.law, pair.center_distance
    driver = Moved(linear(-1.0))
    if pair.on_rack:  # its law is the travel over the size that the module gives
        return {"wheel1": driver, "rack": Moved(displaced(law, -distance), 0j, 1j)}
    inside = result.design.pair.type == "internal"
    side, center = (-1.0, -distance) if inside else (1.0, distance)
    return {"wheel1": driver, "wheel2": Moved(displaced(law, side), complex(center))}


def _of_cam(result: Any) -> dict[str, Moved]:
    """Return the cam, a shaft or a plate, and its follower."""
    motion = result.cam.motions[0]
    follower, side = motion.follower, -1.0 if motion.clockwise else 1.0
    own = {"shaft": Moved(linear(side))}
    if not motion.carrier.around:
        own = {"plate": Moved(linear(1.0), 0j, 1 + 0j)}
    turn, shift = (
        float(one[0].real) + 1j * float(one[0].imag) for one in follower.moved(np.ones(1))
    )
    seen = (lambda z: z) if side > 0.0 else (lambda z: -z.conjugate())
    if not follower.angular:
        end = complex(follower.centre(np.array([follower.start]))[0]) if follower.has_centre else 0j
        return own | {"follower": Moved(displaced(result.program, 1.0), seen(end), seen(shift))}
    spin = turn.real
    pivot = shift / (1.0 - cmath.exp(1j * spin))
    arm = math.nan
    if follower.has_centre:
        arm = cmath.phase(seen(complex(follower.centre(np.array([follower.start]))[0]) - pivot))
    return own | {"follower": _swinging(result, seen(pivot), arm, side * spin)}


def _swinging(result: Any, pivot: complex, arm: float, sense: float) -> Moved:
    """Return an oscillating follower, which lift turns by itself times the `sense`."""
    return Moved(displaced(result.program, sense), pivot, arm=arm, sense=sense)


def _of_cylinder(result: Any) -> dict[str, Moved]:
    """Return the follower of a cylinder cam, in the plane of the cam's y and z."""
    from gearcam.spatial.guides import SwingArm

    guide, side = result.cam.guide, result.cam.hand
    if not isinstance(guide, SwingArm):
        return {"follower": Moved(displaced(result.program, 1.0), 1j * guide.height, 1j)}
    pivot = complex(-side * guide.distance, guide.pivot)
    arm = cmath.phase(complex(side * math.cos(guide.start), math.sin(guide.start)))
    return {"follower": _swinging(result, pivot, arm, side)}


def _of_globoid(result: Any) -> dict[str, Moved]:
    """Return the turret of a globoidal cam, in the plane of the cam's x and z: on both hands."""
    law = displaced(result.program, -1.0)
    return {"turret": Moved(law, complex(result.cam.distance), sense=-1.0)}


_OF_CAMS: Final = {"spatial-cam": _of_cylinder, "globoidal-cam": _of_globoid}
"""What returns what cams move, by their kind, of those in space."""
