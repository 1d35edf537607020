"""Pitch curve and profile of a cam before trimming: curves made of sweeps and jumps.

In a *sweep* theta varies within one smooth piece of the lift. Where the velocity jumps, theta is
constant in a *jump* and the velocity varies from its value before to that after: the profile is
then an arc about the roller's centre, or a straight line under a flat face. With jumps between its
sweeps the profile is a closed curve with a continuous tangent, for any motion; it runs backwards
where it is undercut. For a cam that slides it is open and ends with the travel.

Curves are complex points, mm, in the cam's frame; for a cam that turns clockwise they are mirrored
at the y axis.

Depends on followers, carriers, laws and numeric; numpy only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.cams.carriers import Carrier
from gearcam.cams.followers import Contact, Follower
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.crossings import CurvePoint
from gearcam.numeric.jets import Jet

_SHARP = 0.5
"""Change of the tangent between even points of a sweep, rad, above which the sweep is divided."""

_GRAIN = 2.0
"""Least length of a sweep, in roundings of an angle."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CamCurve(ShortRepr):
    """An untrimmed curve of a cam: its pitch curve, a parallel of that, or the envelope of a face.

    Parameters
    ----------
    program : Program
        The lift.
    follower : Follower
        The follower.
    carrier : Carrier
        Motion of the cam.
    inset : float, mm
        Depth below a round follower's centre: 0 for the pitch curve, the follower's radius for a
        profile inside it, negative for one outside it. Of no meaning for faces, whose profile is
        the only curve.
    mirrored : bool
        Whether the cam turns clockwise.
    """

    program: Program
    follower: Follower
    carrier: Carrier
    inset: float = 0.0
    mirrored: bool = False

    @property
    def lift_sign(self) -> int:
        """Whether a rise moves the follower away from the metal (1) or towards it (-1).

        Towards it at a wall outside the pitch curve, or below the axis.
        """
        return -1 if self.follower.below != (self.inset < 0.0) else 1

    @property
    def rounded(self) -> bool:
        """Whether it runs on where the velocity jumps, on an arc or along a face.

        A pitch curve has a corner there.
        """
        return self.inset != 0.0 or not self.follower.has_centre

    def contact(self, theta: Array, order: int = 1) -> Contact:
        """Return the contact at cam angles.

        Parameters
        ----------
        theta : (n,) array, rad
            Any angles; at a knot the piece after it is used.
        order : int
            Of the jets, at most 2.
        """
        return self.contact_of(self.program.derivatives(theta, 2 + order), order)

    def contact_of(self, lift: Sequence[Array] | Array, order: int = 1) -> Contact:
        """Return the contact from the lift and its derivatives.

        Parameters
        ----------
        lift : 3 + order arrays
            ``s, s', s'', ...``, mm or rad.
        order : int
            Of the jets, at most 2.
        """
        factors = (1.0, 1.0, 0.5, 1.0 / 6.0)[: order + 2]
        s, ds = (Jet([f * lift[k + j] for j, f in enumerate(factors)]) for k in range(2))
        follower = self.follower
        return follower.contact(self.carrier, s + follower.start, ds, self.inset)

    def trace(self, theta: Array, s: Array, ds: Array) -> tuple[Plane, Plane]:
        """Return points and unit tangents.

        Parameters
        ----------
        theta, s, ds : (n,) arrays
            Cam angles, rad, lift and velocity there.

        Returns
        -------
        points, tangents : (n,) complex arrays, mm and 1
            Clockwise, or mirrored.
        """
        position = self.follower.start + s
        points, tangents = self.follower.trace(self.carrier, theta, position, ds, self.inset)
        if self.mirrored:
            return -np.conj(points), -np.conj(tangents)
        return points, tangents


@dataclass(frozen=True, eq=False)
class ProfileSegments(ShortRepr):
    """Sweeps and jumps in order; fulfils `gearcam.numeric.sampling.Curves`.

    Parameters
    ----------
    curve : CamCurve
        The untrimmed curve.
    piece : (n,) array of int
        Smooth piece of the lift that a sweep belongs to, or that begins at a jump.
    start, end : (n,) arrays
        theta of a sweep, rad; the even parameter of a jump (see `Follower.jump`).
    jump : (n,) array of bool
        Mask of the jumps.
    corner : (n,) array of bool
        Mask of the segments that begin at a corner.
    """

    curve: CamCurve
    piece: Ints
    start: Array
    end: Array
    jump: Mask
    corner: Mask

    def taken(self, index: Ints) -> ProfileSegments:
        """Return the segments `index`, in that order."""
        names = ("piece", "start", "end", "jump", "corner")
        return replace(self, **{name: getattr(self, name)[index] for name in names})

    def resolved(self, tangents: Plane) -> ProfileSegments:
        """Return the segments, divided where a sweep turns far in a small part of itself.

        With a steep lift the profile turns where its velocity passes that of the cam, in a small
        part at the very beginning of a rise.

        Parameters
        ----------
        tangents : (n, k + 1) complex array
            At even positions of every segment, including both ends.

        Returns
        -------
        ProfileSegments
            The same segments if no two neighbouring tangents differ by much.
        """
        turns = np.abs(np.angle(tangents[:, 1:] * np.conj(tangents[:, :-1])))
        sharp = (turns > _SHARP) & ~self.jump[:, None]
        if not sharp.any():
            return self
        places = np.linspace(self.start, self.end, tangents.shape[1], axis=1)
        sharp &= np.diff(places) > _GRAIN * np.spacing(np.abs(places[:, 1:]))
        if not sharp.any():
            return self
        begins = np.zeros(sharp.shape, dtype=bool)
        begins[:, 0] = True
        begins |= sharp
        begins[:, 1:] |= sharp[:, :-1]
        index, number = np.nonzero(begins)
        start, last = places[index, number], np.append(np.diff(index) > 0, True)
        end = np.where(last, self.end[index], np.roll(start, -1))
        corner = self.corner[index] & (number == 0)
        return replace(self.taken(index), start=start, end=end, corner=corner)

    @property
    def first(self) -> CurvePoint:
        """Their beginning, as a point of the curve."""
        return CurvePoint(0, float(self.start[0]))

    @property
    def last(self) -> CurvePoint:
        """Their end, as a point of the curve."""
        return CurvePoint(len(self.end) - 1, float(self.end[-1]))

    @property
    def backward(self) -> Mask:
        """Mask of jumps that run backwards: at a corner of the pitch curve towards the profile."""
        return self.jump & ((self.end - self.start) * self.curve.lift_sign < 0.0)

    @property
    def breaks(self) -> tuple[Ints, Array]:
        """Sharp bends of a law inside sweeps: numbers of segments, parameters."""
        cuts = self.curve.program.cuts
        inside = (self.start[:, None] < cuts) & (cuts < self.end[:, None]) & ~self.jump[:, None]
        index, number = np.nonzero(inside)
        return index, cuts[number]

    def states(self, index: Ints, parameter: Array, order: int = 1) -> tuple[Array, ...]:
        """Return cam angle, lift, velocity and higher derivatives.

        Parameters
        ----------
        index : (n,) array of int
            Numbers of the segments.
        parameter : (n,) array
            Positions within them.
        order : int
            Order of the last derivative.
        """
        jump, program = self.jump[index], self.curve.program
        theta = np.where(jump, program.knots[self.piece[index]], parameter)
        s, ds, *more = program.lift.on_pieces(self.piece[index], theta, order)
        if jump.any():
            follower, carrier = self.curve.follower, self.curve.carrier
            ds[jump] = follower.velocity(carrier, follower.start + s[jump], parameter[jump])
        return theta, s, ds, *more

    def at(self, index: Ints, parameter: Array) -> tuple[Plane, Plane]:
        """Return points and unit tangents, which are backwards where undercut.

        Parameters
        ----------
        index : (n,) array of int
            Numbers of the segments.
        parameter : (n,) array
            Within them.
        """
        theta, s, ds = self.states(index, parameter)
        return self.curve.trace(theta, s, ds)

    def moving(self, index: Ints, parameter: Array) -> tuple[Plane, Plane]:
        """Return points, and their derivatives by the parameter.

        Parameters
        ----------
        index : (n,) array of int
            Numbers of the segments.
        parameter : (n,) array
            Within them.

        Returns
        -------
        points, velocities : (n,) complex arrays, mm and mm per unit of the parameter
            Opposite to the tangent where the curve runs backwards.
        """
        theta, s, ds, d2s = self.states(index, parameter, 2)
        curve = self.curve
        speed = curve.contact_of((s, ds, d2s), 0).speed.c[0]
        points, tangents = curve.trace(theta, s, ds)
        jump = self.jump[index]
        if jump.any():
            position = curve.follower.start + s
            rolling = curve.follower.jump_speed(curve.carrier, position, curve.inset)
            speed = np.where(jump, rolling, speed)
        return points, speed * tangents


def segments(curve: CamCurve) -> ProfileSegments:
    """Return a whole curve over a turn, in order of theta.

    Parameters
    ----------
    curve : CamCurve
        The curve.

    Returns
    -------
    ProfileSegments
        From the beginning of the turn; corners only at a pitch curve's jumps (see `begun`).
    """
    program, follower = curve.program, curve.follower
    hard = {jump.theta: jump for jump in program.hard}
    rows: list[tuple[int, float, float, bool, bool]] = []
    for piece, (low, high) in enumerate(pairwise(program.knots.tolist())):
        jump = hard.get(low)
        if jump and curve.rounded:
            position = follower.start + program.lift.side(piece, 1, 0)[0] + np.zeros(2)
            speeds = np.array([jump.before, jump.after])
            ends = follower.jump(curve.carrier, position, speeds).tolist()
            rows.append((piece, *ends, True, False))
        rows.append((piece, low, high, False, jump is not None and not curve.rounded))
    return ProfileSegments(curve, *map(np.array, zip(*rows, strict=True)))


def begun(segments: ProfileSegments) -> ProfileSegments:
    """Return segments that begin at a corner, or at an open end, as a `Sampler` needs.

    If there is no corner the first point is marked as one.
    """
    first = 0 if segments.curve.program.open else segments.corner.argmax()
    turned = segments.taken(np.roll(np.arange(len(segments.start)), -first))
    turned.corner[0] = True  # a smooth closed curve may begin anywhere
    return turned
