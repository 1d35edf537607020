"""Where two flanks touch: at a common normal, with zero distance along it.

A flank's normal at roll s passes through the pitch point of that roll, for any position `sf`: the
flanks of one side are parallel curves, involutes of one base curve. At a phase of the driver three
equations (equal directions of the normals, and two coordinates) give the rolls of both wheels at
which a pair touches, and the *lead* of the driven wheel, the angle by which it is ahead of its
nominal position. As designed the rolls are equal and the lead is 0. The lead is the same for all
pairs of evenly spaced flanks: they touch together at any centre distance.

Positions are those of the mounted pair, as complex numbers: O1 at 0, O2 at the centre distance
along x, for a ring at the opposite side. A rack has no O2; its lead is a travel in mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.gears.flank import Toothing
from gearcam.gears.guide import Guide
from gearcam.gears.track import Frames, Track, Wheel
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import damped_newton, solve

_SMALL = 1e-7
"""Step, in pitches, after which the next one is below rounding."""

_MISS = 1e-9
"""Largest residual of the equations, in pitches and rad."""

_FAR = 3.0
"""Largest distance, in pitches, of a roll from the nominal one in a pair of teeth that mesh."""

_FREE = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3]])
"""Indices of the unknowns of phase, both rolls and lead, by which of the first three is known."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Mounting(ShortRepr):
    """Two mounted wheels, and the side of their flanks.

    Parameters
    ----------
    toothings : (Toothing, Toothing)
        Driver and driven wheel.
    guide : Guide
        Guide of the driven wheel.
    side : {-1, +1}
        sigma of the driver's flanks.
    distance : float, mm
        Mounted position of the driven frame along x: the centre distance, negative for a ring;
        for a rack the offset from its design position.
    """

    toothings: tuple[Toothing, Toothing]
    guide: Guide
    side: int
    distance: float

    @property
    def track(self) -> Track:
        """The driver's track; the driven one shares its parameter and arc length."""
        return self.toothings[0].track

    @property
    def pitch(self) -> float:
        """Pitch, mm."""
        return self.toothings[0].pitch

    def sigma(self, wheel: Wheel) -> int:
        """Return sigma of a wheel's flanks."""
        return self.side if wheel == 1 else -self.side


class FlankPositions(NamedTuple):
    """Positions of pairs of flanks: arrays of one shape.

    Parameters
    ----------
    phi1 : array, rad
        Phase of the driver.
    one, two : arrays, rad
        Rolls of driver and driven wheel, as driver angles.
    lead : array, rad
        Angle by which the driven wheel is ahead of its nominal position; for a rack mm of travel.
    """

    phi1: Array
    one: Array
    two: Array
    lead: Array

    def take(self, index: Ints | Mask) -> FlankPositions:
        """Return some of them, by `index`."""
        return FlankPositions(*(values[index] for values in self))


@dataclass(frozen=True, eq=False, kw_only=True)
class Normals(ShortRepr):
    """Normals of n driver's flanks and of n driven flanks, in the mounted pair.

    Parameters
    ----------
    frames : (Frames, Frames)
        At the rolls of driver and driven wheel.
    foot : (2, n) complex array, mm
        Pitch points of these rolls.
    normal : (2, n) complex array
        Unit normals of the flanks.
    equations : (3, n) array, rad and mm
        Angle between the normals; distance of the flanks along the driver's, and across it.
    slopes : (3, 4, n) array
        Their derivatives by phase, roll of the driver, roll of the driven wheel (as driver
        angles) and lead.
    """

    frames: tuple[Frames, Frames]
    foot: Plane
    normal: Plane
    equations: Array
    slopes: Array

    def take(self, index: Ints | Mask) -> Normals:
        """Return some of them, by `index`."""
        first, second = self.frames
        return Normals(
            frames=(first.some(index), second.some(index)),
            foot=self.foot[:, index],
            normal=self.normal[:, index],
            equations=self.equations[:, index],
            slopes=self.slopes[..., index],
        )

    @property
    def rates(self) -> Array:
        """Derivatives of both rolls (as driver angles) and the lead by the phase, (3, n)."""
        return -solve(self.slopes[:, _FREE[0]], self.slopes[:, 0])


def normals(
    mounting: Mounting, positions: FlankPositions, separation: Array, motion: Array | None = None
) -> Normals:
    """Return normals of both wheels' flanks, and the residuals of the equations of contact.

    Parameters
    ----------
    mounting : Mounting
        The wheels and the side.
    positions : FlankPositions
        Positions of n pairs.
    separation : (n,) array, mm
        sf2 - sf1.
    motion : (2, n) array, optional
        `Guide.motion` at the phases, if already computed.

    Returns
    -------
    Normals

    Notes
    -----
    With n the driver's unit normal and P the pitch points, flanks touch where the normals are
    parallel and ``conj(n)*(P2 - P1) + (s1 - s2 + sf2 - sf1)*cos(alpha) = 0``. Derivatives by s
    from ``dn/ds = +-1j*kappa*n`` (+ on wheel 1) and ``dP/ds = T``.
    """
    phi1, one, two, lead = positions
    first, second = (
        toothing.frames(angle)
        for toothing, angle in zip(mounting.toothings, (one, two), strict=True)
    )
    guide, alpha = mounting.guide, mounting.toothings[0].cutter.alpha
    cosine, turned = math.cos(alpha), np.exp(-1j * phi1)
    n1, n2 = (
        toothing.normals(frames, mounting.sigma(toothing.wheel))
        for toothing, frames in zip(mounting.toothings, (first, second), strict=True)
    )
    nominal, ratio = guide.motion(phi1) if motion is None else motion
    stand = guide.pose(nominal + lead)
    back = stand.rotation
    foot1, n1 = first.p * turned, n1 * turned
    foot2, n2, tangent2 = second.p * back + stand.shift, n2 * back, second.t * back
    carried, turns = guide.carried(foot2), guide.turns
    foot2 = foot2 + mounting.distance
    across = np.conj(n1) * (foot2 - foot1)
    aligned = np.conj(n2) * n1
    distance = across.real + (first.s - second.s + separation) * cosine
    by_lead = np.conj(n1) * carried
    by_one = -1j * (first.kappa * across + mounting.side * math.sin(alpha))
    by_two = np.conj(n1) * tangent2 - cosine
    # the driver turns by -phi1, the driven wheel as by the lead
    by_phase = 1j * np.conj(n1) * foot2 + ratio * by_lead
    angle = [
        -aligned.real * (1.0 + turns * ratio),
        aligned.real * first.kappa * first.speed,
        aligned.real * second.kappa * second.speed,
        -aligned.real * turns,
    ]
    moves = [by_phase, by_one * first.speed, by_two * second.speed, by_lead]
    return Normals(
        frames=(first, second),
        foot=np.stack([foot1, foot2]),
        normal=np.stack([n1, n2]),
        equations=np.stack([aligned.imag, distance, across.imag]),
        slopes=np.stack([np.stack(angle), np.real(moves), np.imag(moves)]),
    )


def touch(
    mounting: Mounting,
    start: Array,
    separation: Array,
    known: Ints | int = 0,
    limits: tuple[Array, Array] | None = None,
) -> tuple[FlankPositions, Normals, Mask]:
    """Find where flanks touch.

    Parameters
    ----------
    mounting : Mounting
        The wheels and the side.
    start : (n,) array, rad
        The known one: the phase, or the roll of a wheel as driver angle. The search begins with
        all three equal, as designed.
    separation : (n,) array, mm
        sf2 - sf1.
    known : int or (n,) int array
        Which one is known: 0 the phase, 1 the driver's roll, 2 the driven wheel's.
    limits : ((n,) array, (n,) array), optional
        If the phase is known: driver angles, rad, that bound both rolls.

    Returns
    -------
    positions : FlankPositions
        Solutions by Newton's method, with steps of half a pitch at most.
    at : Normals
        The normals there.
    found : (n,) bool array
        Whether it converged to a contact within `_FAR` pitches of the nominal roll.
    """
    every = np.stack([start, start, start, np.zeros(start.shape)])
    free, rows = _FREE[np.broadcast_to(known, start.shape)].T, np.arange(start.size)
    scale = mounting.track.frames(start, curved=False).speed / mounting.pitch
    motion = None if np.any(known) else mounting.guide.motion(start)

    def evaluate(x: Array, some: Ints) -> tuple[Normals, Array, Array]:
        every[free[:, some], some] = x
        given = motion if motion is None else motion[:, some]
        at = normals(mounting, FlankPositions(*every[:, some]), separation[some], given)
        return at, at.equations, at.slopes[:, free[:, some], np.arange(some.size)]

    _, at = damped_newton(evaluate, every[free, rows], scale, _SMALL, limits)
    found = np.abs(at.equations[0]) <= _MISS
    found &= np.abs(at.equations[1:]).max(axis=0) <= _MISS * mounting.pitch
    found &= np.abs(every[:3] - start).max(axis=0) * scale <= _FAR
    return FlankPositions(*every), at, found
