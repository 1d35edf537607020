"""The numbers of a cam once more, in as many digits as mpmath is told to keep.

The centre of a round follower, or the line of a face, is written out in the fixed frame and turned,
or slid, into that of the cam; everything else are derivatives of that curve. Nothing is sampled:
sizes are integrals of the pitch curve (a parallel has less perimeter and area by Steiner's
theorem), extremes and corners are roots near where they are told.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
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
                way = mp.mpc(0, 1) * mp.exp(1j * self.tilt)
                return [way * place, way * ds, way * d2s]
            return [mp.mpc(self.offset, place), mp.mpc(0, ds), mp.mpc(0, d2s)]
        sense = 1 if self.slide else -1
        arm = sense * self.arm * mp.exp(1j * sense * place)
        first, second = sense * 1j * ds, sense * 1j * d2s - ds * ds
        foot = mp.mpc(-self.pivot, self.height) if self.slide else self.pivot
        return [foot + arm, arm * first, arm * second]

    def pitch(self, theta: Number, found: Sequence[Number]) -> list[Number]:
        """The pitch curve in the cam's frame, with two derivatives."""
        z, dz, d2z = self.centre(found)
        if self.slide:
            return [z + self.slide * theta, dz + self.slide, d2z]
        turn = mp.exp(-1j * theta)
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

    def place(self, found: Sequence[Number]) -> Number:
        """Where a face is touched: along it from the axis, or from the pivot."""
        if not self.swings:
            return found[1]
        return self.pivot * mp.cos(self.start + found[0]) / (1 + found[1])

    # --- both ---------------------------------------------------------------------------------

    def contact(self, theta: Number, found: Sequence[Number]) -> Number:
        """Where the profile is touched, before trimming."""
        if self.flat:
            h, g, *_ = self.support(found)
            angle = theta + (self.start + found[0] if self.swings else 0)
            return mp.mpc(g, h) * mp.exp(-1j * angle)
        place, first, _ = self.pitch(theta, found)
        return place - 1j * self.radius * first / abs(first)

    def pressure(self, found: Sequence[Number]) -> Number:
        """Angle between the normal of the contact and the way that a lift moves it."""
        if self.flat:
            if not self.swings:
                return mp.mpf(0)
            return mp.atan(-self.face / self.place(found))
        z, dz, _ = self.centre(found)
        normal = 1j * (dz + (self.slide or -1j * z))
        place = self.start + found[0]
        if self.swings:
            moves = 1j * mp.exp(1j * place) if self.slide else 1j * mp.exp(-1j * place)
        else:
            moves = 1j * mp.exp(1j * self.tilt)
        ratio = normal / moves
        return mp.atan(ratio.imag / ratio.real)

    def room(self, theta: Number, found: Sequence[Number]) -> Number:
        """What has the sign of the speed along the profile."""
        if self.flat:
            h, _, bend, _ = self.support(found)
            return h + bend
        return 1 - self.radius * self.curvature(theta, found)

    @property
    def away(self) -> int:
        """Whether a rise moves the follower away from the metal, or to it (-1)."""
        below = not self.flat and not self.slide and self.start < 0
        return -1 if below != (self.radius < 0) else 1

    def rested(self, theta: Number, point: Number) -> Number:
        """The lift at which the follower rests on a point of the cam's frame."""
        z = point - self.slide * theta if self.slide else point * mp.exp(1j * theta)
        r, side = abs(self.radius), self.away
        if self.swings and self.flat:
            reach = self.pivot - z
            return -mp.arg(reach) + mp.asin(self.face / abs(reach)) - self.start
        if self.swings:
            arm = z - mp.mpc(-self.pivot, self.height) if self.slide else mp.conj(self.pivot - z)
            cosine = (abs(arm) ** 2 + self.arm**2 - r**2) / (2 * abs(arm) * self.arm)
            return mp.arg(arm) + side * mp.acos(cosine) - self.start
        z *= mp.exp(-1j * self.tilt)
        if self.flat:
            return z.imag - self.start
        return z.imag + side * mp.sqrt(r**2 - (z.real - self.offset) ** 2) - self.start

    def standing(self, theta: Number, centre: Number) -> tuple[Number, Number]:
        """How far a centre of the cam's frame is off the follower's way, and the lift there."""
        z = centre - self.slide * theta if self.slide else centre * mp.exp(1j * theta)
        if self.swings:
            arm = z - mp.mpc(-self.pivot, self.height) if self.slide else mp.conj(self.pivot - z)
            return abs(arm) - self.arm, mp.arg(arm) - self.start
        z *= mp.exp(-1j * self.tilt)
        return z.real - self.offset, z.imag - self.start


def at(lift: Sequence[Piece], theta: Number) -> list[Number]:
    """Lift and derivatives; at a knot those after it."""
    return piece_at(lift, theta).shape(theta)


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
        ends = [
            touch.pitch(t, one.shape(t))[1]
            for one, t in ((lift[0], lift[0].low), (lift[-1], lift[-1].high))
        ]
        return length - r * mp.arg(ends[0] / ends[1]), mp.mpf(0)
    return length - 2 * mp.pi * r, area - r * length + mp.pi * r * r


def trimmed_sizes(
    touch: Touch, lift: Sequence[Piece], corners: Sequence[tuple[Number, Number]]
) -> tuple[Number, Number]:
    """Perimeter and area of a round follower's profile that corners (before, after) have cut."""

    def drawn(theta: Number, found: list[Number]) -> Number:
        _, first, _ = touch.pitch(theta, found)
        run = first * touch.room(theta, found)
        swept = -(mp.conj(touch.contact(theta, found)) * run).imag / 2
        return mp.mpc(abs(run), swept)

    total, turn = mp.mpf(0), 2 * mp.pi
    for (_, begin), (end, _) in zip(corners, [*corners[1:], corners[0]], strict=True):
        stop = end if end > begin else end + turn
        for shift in (0, turn):
            for one in lift:
                low, high = max(one.low + shift, begin), min(one.high + shift, stop)
                if low < high:
                    part = Piece(low - shift, high - shift, one.shape)
                    total += integral([part], drawn)
    return total.real, total.imag


def best(function: Callable[[Number], Number], place: float, ends: tuple[Number, Number]) -> Number:
    """The extreme of a smooth function next to a place, or its value at an end of its stretch."""
    for end in ends:
        if abs(place - end) < 1e-9:
            return function(end)
    slope = mp.findroot(partial(mp.diff, function), mp.mpf(place), tol=1e-30, verify=False)
    return function(slope if abs(slope - place) < 1e-5 else mp.mpf(place))


def piece_at(lift: Sequence[Piece], theta: Number) -> Piece:
    """The piece of a cam angle; at a knot that after it."""
    return next(one for one in reversed(lift) if one.low <= theta)


def lost_between(
    touch: Touch, lift: Sequence[Piece], theta: Number, insets: Sequence[Number]
) -> Number:
    """How far a follower moves between two parallels of its pitch curve, so deep within it."""

    def lift_at(inset: Number) -> Number:
        def centre(t: Number) -> Number:
            place, first, _ = touch.pitch(t, piece_at(lift, t % (2 * mp.pi)).shape(t % (2 * mp.pi)))
            return place - 1j * inset * first / abs(first)

        t = mp.findroot(lambda t: touch.standing(theta, centre(t))[0], theta)
        return touch.standing(theta, centre(t))[1]

    inner, outer = (lift_at(inset) for inset in insets)
    return outer - inner


def crossing(
    touch: Touch, pair: tuple[Piece, Piece], told: tuple[float, float]
) -> tuple[Number, ...]:
    """Where two pieces of a profile cross: both cam angles near those told, and the point."""

    def curve(k: int, t: Number) -> Number:
        return touch.contact(t, pair[k].shape(t))

    def apart(a: Number, b: Number) -> list[Number]:
        z = curve(0, a) - curve(1, b)
        return [z.real, z.imag]

    a, b = mp.findroot(apart, tuple(map(mp.mpf, told)))
    return a, b, curve(0, a)
