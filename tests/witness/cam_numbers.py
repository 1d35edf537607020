"""The numbers of a cam once more, in as many digits as mpmath is told to keep.

The centre of a round follower, or the line of a face, is written out in the fixed frame and turned,
or slid, into that of the cam; everything else are derivatives of that curve. Nothing is sampled:
sizes are integrals of the pitch curve (a parallel has less perimeter and area by Steiner's
theorem), extremes and corners are roots near where they are told.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath

from witness.lifts import Piece

mp: Any = mpmath.mp
Number = Any


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A follower on its cam; of a negative start it stands below the axis."""

    flat: bool = False
    swings: bool = False
    start: Number = 0
    radius: Number = 0
    """Of a round one; negative where the metal lies outside."""
    offset: Number = 0
    arm: Number = 0
    pivot: Number = 0
    face: Number = 0
    slide: Number = 0
    tilt: Number = 0
    height: Number = 0

    # --- a round follower ---------------------------------------------------------------------

    def centre(self, found: Sequence[Number]) -> list[Number]:
        """The centre in the fixed frame, with two derivatives by the cam angle."""
        s, ds, d2s, _ = found
        place = self.start + s
        if not self.swings:
            if self.slide:
                way = mp.mpc(0, 1) * mp.expj(self.tilt)
                return [way * place, way * ds, way * d2s]
            return [mp.mpc(self.offset, place), mp.mpc(0, ds), mp.mpc(0, d2s)]
        sense = 1 if self.slide else -1
        arm = sense * self.arm * mp.expj(sense * place)
        first, second = sense * 1j * ds, sense * 1j * d2s - ds * ds
        foot = mp.mpc(-self.pivot, self.height) if self.slide else self.pivot
        return [foot + arm, arm * first, arm * second]

    def pitch(self, theta: Number, found: Sequence[Number]) -> list[Number]:
        """The pitch curve in the cam's frame, with two derivatives."""
        z, dz, d2z = self.centre(found)
        if self.slide:
            return [z + self.slide * theta, dz + self.slide, d2z]
        turn = mp.expj(-theta)
        return [z * turn, (dz - 1j * z) * turn, (d2z - 2j * dz - z) * turn]

    def curvature(self, theta: Number, found: Sequence[Number]) -> Number:
        """Of the pitch curve, which runs clockwise."""
        _, first, second = self.pitch(theta, found)
        return -(mp.conj(first) * second).imag / abs(first) ** 3

    # --- a face -------------------------------------------------------------------------------

    def support(self, found: Sequence[Number]) -> list[Number]:
        """A face's distance from the axis, two derivatives by its angle, and how fast that turns.

        The derivatives are where it is touched, and what makes of the distance the radius.
        """
        s, ds, d2s, _ = found
        if not self.swings:
            return [self.start + s, ds, d2s, mp.mpf(1)]
        sine, cosine = mp.sin(self.start + s), mp.cos(self.start + s)
        spin = 1 + ds
        slope = self.pivot * (cosine * d2s - sine * ds * ds) / spin
        slope -= self.pivot * cosine * ds * d2s / spin**2
        return [
            self.pivot * sine - self.face,
            self.pivot * cosine * ds / spin,
            slope / spin,
            spin,
        ]

    # --- both ---------------------------------------------------------------------------------

    def contact(self, theta: Number, found: Sequence[Number]) -> Number:
        """Where the profile is touched, before trimming."""
        if self.flat:
            h, g, *_ = self.support(found)
            angle = theta + (self.start + found[0] if self.swings else 0)
            return mp.mpc(g, h) * mp.expj(-angle)
        place, first, _ = self.pitch(theta, found)
        return place - 1j * self.radius * first / abs(first)

    def pressure(self, found: Sequence[Number]) -> Number:
        """Angle between the normal of the contact and the way that a lift moves it."""
        if self.flat:
            if not self.swings:
                return mp.mpf(0)
            along = self.pivot * mp.cos(self.start + found[0]) / (1 + found[1])
            return mp.atan(-self.face / along)
        z, dz, _ = self.centre(found)
        normal = 1j * (dz + (self.slide or -1j * z))
        place = self.start + found[0]
        if self.swings:
            moves = 1j * mp.expj(place) if self.slide else 1j * mp.expj(-place)
        else:
            moves = 1j * mp.expj(self.tilt)
        ratio = normal / moves
        return mp.atan(ratio.imag / ratio.real)

    def room(self, theta: Number, found: Sequence[Number]) -> Number:
        """What has the sign of the speed along the profile."""
        if self.flat:
            h, _, bend, _ = self.support(found)
            return h + bend
        return 1 - self.radius * self.curvature(theta, found)

    def rested(self, theta: Number, point: Number) -> Number:
        """The lift at which a round follower rests on a point of the cam's frame."""
        z, side = point * mp.expj(theta), mp.sign(self.radius)
        if self.swings:
            from_pivot = self.pivot - z
            reach = abs(from_pivot)
            cosine = (reach**2 + self.arm**2 - self.radius**2) / (2 * reach * self.arm)
            return -mp.arg(from_pivot) + side * mp.acos(cosine) - self.start
        if self.flat:
            return z.imag - self.start
        return z.imag + side * mp.sqrt(self.radius**2 - (z.real - self.offset) ** 2) - self.start


def at(lift: Sequence[Piece], theta: Number) -> list[Number]:
    """Lift and derivatives; at a knot those after it."""
    return next(one for one in reversed(lift) if one.low <= theta).shape(theta)


def integral(lift: Sequence[Piece], function: Callable[[Number, list[Number]], Number]) -> Number:
    """A function of cam angle and lift over the turn, by Gauss and Legendre in each piece."""
    total = mp.mpf(0)
    for one in lift:
        middle = (one.low + one.high) / 2
        total += mp.quad(
            lambda t, one=one: function(t, one.shape(t)),
            [one.low, middle, one.high],
            method="gauss-legendre",
            maxdegree=4,
        )
    return total


def sizes(touch: Touch, lift: Sequence[Piece]) -> tuple[Number, Number]:
    """Perimeter and area of a profile that is not undercut; of a sliding cam the length alone."""
    if touch.flat:
        def face(_: Number, found: list[Number]) -> Number:
            h, g, _, spin = touch.support(found)
            return mp.mpc(h, (h * h - g * g) / 2) * spin

        both = integral(lift, face)
        return both.real, both.imag

    def drawn(theta: Number, found: list[Number]) -> Number:
        place, first, _ = touch.pitch(theta, found)
        return mp.mpc(abs(first), -(mp.conj(place) * first).imag / 2)

    both = integral(lift, drawn)
    length, area, r = both.real, both.imag, touch.radius
    if touch.slide:
        ends = [touch.pitch(t, one.shape(t))[1] for one, t in ((lift[0], lift[0].low), (lift[-1], lift[-1].high))]
        return length - r * mp.arg(ends[0] / ends[1]), mp.mpf(0)
    return length - 2 * mp.pi * r, area - r * length + mp.pi * r * r


def best(function: Callable[[Number], Number], place: float, low: float, high: float) -> Number:
    """The extreme of a smooth function next to a place, or its value at an end of a stretch."""
    slope = lambda t: mp.diff(function, t)  # noqa: E731
    for end in (low, high):
        if abs(place - end) < 1e-9:
            return function(mp.mpf(end))
    return function(mp.findroot(slope, mp.mpf(place)))


def crossing(touch: Touch, pair: tuple[Piece, Piece], told: tuple[float, float]) -> tuple[Number, ...]:
    """Where two pieces of a profile cross: both cam angles near those told, and the point."""

    def curve(k: int, t: Number) -> Number:
        return touch.contact(t, pair[k].shape(t))

    def apart(a: Number, b: Number) -> list[Number]:
        z = curve(0, a) - curve(1, b)
        return [z.real, z.imag]

    a, b = mp.findroot(apart, tuple(map(mp.mpf, told)))
    return a, b, curve(0, a)
