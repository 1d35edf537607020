"""The lift of a follower on a measured profile: a closed curve of radii over the polar angle.

The follower is first put on a polygon of the curve (see `follow`), then on the curve itself: its
position is the largest over the points of the curve, where its derivative along the curve is 0. So
each lift is exact for the curve through the radii, whose own error between them remains.

The radii say how large the cam is. Lifts count from the circle of the design, so that the cam that
is made has the measured profile, and a circle that is not that of the profile is refused.

Refused: profiles that the follower does not reach everywhere, circles of another size, and what
`follow` refuses.

Depends on follow, followers, laws and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted, rounded_down, shortened
from gearcam.cams.carriers import ROTATING, unit
from gearcam.cams.follow import follow
from gearcam.cams.followers import Follower
from gearcam.laws.motion_table import program_of_rows
from gearcam.laws.phases_of_lift import TURN
from gearcam.laws.program import Program, stretches_of
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet, sin_cos
from gearcam.numeric.roots import bracketed_root, newton_in_bracket

_FEWEST, _MOST, _FINER = 360, 3600, 2
"""Fewest and most rows of the lift, and how many there are for each measured one."""

_POLYGON = 4
"""Corners of the polygon for each row of the lift."""

_AROUND = 3.0
"""Steps of the polygon to both sides of its contact, within which the curve is touched."""

_ROOT = 1e-13
"""Width of a bracket that counts as a root, rad."""

_OFF = 1e-3
"""Height of the follower above the profile, mm, from which on it does not reach it."""

_PER_WAVE = 6
"""Rows for each wave of a smoothed curve (see `gearcam.laws.motion_table`)."""

_LITTLE = 1e-6
"""Share of a radius with which the change of a lift is computed."""

_ASTRIDE = 2.0
"""Safety factor: a follower touches where the error of the curve slopes too."""

_SCATTER = 0.05
"""Height, mm, up to which the scatter of the radii may be all that it does not reach."""

_WIDER = (1.0, 2.0, 4.0)
"""Tolerances of the radii to be tried, in such heights."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MeasuredProfile(ShortRepr):
    """A profile by its radii, below a follower.

    Parameters
    ----------
    curve : Program
        The radius, mm, over the polar angle in the cam's frame.
    count : int
        Number of radii.
    follower : Follower
        At zero lift on the circle of the design.
    clockwise : bool
        Whether the cam turns clockwise; the curve is mirrored then.
    """

    curve: Program
    count: int
    follower: Follower
    clockwise: bool = False

    @property
    def pointed(self) -> bool:
        """Whether the follower is a point, whose position is that of the radius at it."""
        return math.isinf(self.follower.bend)

    def _behind(self, phi: Array) -> Array:
        """Return by how much a point stands on points of the curve behind the cam angles, rad."""
        point: Any = self.follower
        place = self.radius(phi)[0] * unit(phi)
        return ROTATING.stand(point, place, self.theta)[0] - self.theta

    def radius(self, phi: Array) -> list[Array]:
        """Return the radius and two derivatives at angles (n,) of the cam turned the usual way."""
        if not self.clockwise:
            return self.curve.derivatives(phi, 2)
        r, slope, bend = self.curve.derivatives(math.pi - phi, 2)
        return [r, -slope, bend]

    def _rest(self, phi: Array, theta: Array, order: int = 2) -> Jet:
        """Return the positions on points of the curve at cam angles, as jets along the curve."""
        r, slope, bend = self.radius(phi)
        s, c = sin_cos(Jet.variable(phi + theta, 2))
        radius = Jet([r, slope, 0.5 * bend])
        return self.follower.rest((radius * c).upto(order), (radius * s).upto(order))[0]

    @cached_property
    def theta(self) -> Array:
        """The cam angles of the rows of the lift, rad, (m,)."""
        count = min(_MOST, max(_FEWEST, _FINER * self.count))
        return np.arange(float(count)) * (TURN / count)

    @cached_property
    def contact(self) -> Array:
        """Polar angles of the contact there, rad, falling by a turn, (m + 1,)."""
        count = _POLYGON * len(self.theta)
        phi = np.arange(float(count)) * (TURN / count)
        points = self.radius(phi)[0] * np.exp(1j * phi)
        near = np.angle(follow(points, self.follower, self.theta).contact)
        reach = _AROUND * TURN / count

        def falling(phi: Array) -> tuple[Array, Array]:
            _, slope, bend = self._rest(phi, self.theta).c
            return -np.asarray(slope), -2.0 * np.asarray(bend)

        ends = near - reach, near + reach
        if self.pointed:
            found = bracketed_root(self._behind, *ends, _ROOT)
        else:
            found = newton_in_bracket(falling, *ends, near, _ROOT)
        return np.append(found := np.unwrap(found), found[:1] - TURN)

    @cached_property
    def lift(self) -> Array:
        """The lift there, mm or rad, (m,)."""
        if self.pointed:
            position = self.follower.on_circle(self.radius(self.contact[:-1])[0])
        else:
            position = np.asarray(self._rest(self.contact[:-1], self.theta, 0).c[0])
        return position - self.follower.start

    @cached_property
    def steep(self) -> float:
        """By how much the lift changes with the radius at the contact, at most."""
        phi, (s, c) = self.contact[:-1], sin_cos(self.contact[:-1] + self.theta)
        r = self.radius(phi)[0]
        if self.pointed:
            more = self.follower.on_circle((1.0 + _LITTLE) * r) - self.follower.start - self.lift
            return float((more / (_LITTLE * r)).max())
        return float(np.abs(self.follower.rest(Jet([r * c, c]), Jet([r * s, s]))[0].c[1]).max())

    @cached_property
    def program(self) -> Program:
        """The lift over a turn."""
        made = program_of_rows(self.theta, self.lift, np.zeros(len(self.theta)), 0.0)
        # an error of the curve passes the follower as fast as its contact
        fast = max(1.0, float(np.abs(np.diff(self.contact)).max()) / float(self.theta[1]))
        errors = (
            own + _ASTRIDE * self.steep * fast**order * error
            for order, (own, error) in enumerate(zip(made.errors, self.curve.errors, strict=True))
        )
        return replace(made, errors=tuple(errors), fall=self.curve.fall)

    def standing(self, tolerance: float) -> Program:
        """Return the same lift with dwells where it changes less than it is known to."""
        made, cutoff = self.program, (len(self.curve.knots) - 1) / _PER_WAVE
        level = max(self.steep * tolerance, made.errors[0])
        phases = stretches_of(made.lift, self.theta, self.lift, level, cutoff)
        return replace(made, stretches=phases)

    @cached_property
    def highest(self) -> tuple[float, float]:
        """The largest height of the follower above the profile, mm, and its polar angle, rad.

        Midway between neighbouring contacts, where the follower is held by them: below 0 unless the
        curve is hollow between them.
        """
        left, right, theta = self.contact[:-1], self.contact[1:], np.append(self.theta, TURN)
        phi = 0.5 * (left + right)

        def along(theta: Array) -> Array:
            return np.asarray(self._rest(phi, theta, 1).c[1])

        ends = along(theta[:-1]), along(theta[1:])
        root = bracketed_root(along, theta[:-1], theta[1:], _ROOT, ends)
        place = np.where(ends[0] * ends[1] < 0.0, root, theta[:-1])
        beside, middle, other = (
            np.asarray(self._rest(one, place, 0).c[0]) for one in (left, phi, right)
        )
        height = self.follower.lever * (np.maximum(beside, other) - middle)
        worst = int(np.argmax(height))
        return float(height[worst]), math.pi - phi[worst] if self.clockwise else float(phi[worst])

    @property
    def hollow(self) -> float:
        """The smallest concave radius of the curve, mm; infinite without one."""
        r, slope, bend = self.radius(np.linspace(0.0, TURN, 16 * self.count))
        bent = r * r + 2.0 * slope * slope - r * bend
        with np.errstate(divide="ignore"):
            return float(np.where(bent < 0.0, np.hypot(r, slope) ** 3 / -bent, np.inf).min())

    @property
    def circle(self) -> float:
        """Distance of the follower's centre or face from the axis at its lowest, mm."""
        return self.follower.distance(self.follower.start + float(self.lift.min()))


def demand_reached(
    profile: MeasuredProfile, place: Callable[[float], str], key: str, tolerance: float
) -> None:
    """Refuse a profile with a hollow that its follower does not reach.

    Parameters
    ----------
    profile : MeasuredProfile
        The profile.
    place : callable
        ``place(angle)`` returns where a polar angle, rad, is in the file.
    key : str
        Key of the radius of the follower; empty of a flat face or a point.
    tolerance : float, mm
        Largest distance from a radius that was asked for.

    Raises
    ------
    InfeasibleError
        With the largest radius that reaches it.
    """
    height, angle = (0.0, 0.0) if profile.pointed else profile.highest
    if height <= _OFF:
        return
    changes = list(_changes(profile, key, height, tolerance))
    note = "the value is its height above it"
    if math.isfinite(profile.hollow):
        reach = formatted(float(rounded_down(profile.hollow, 4)))
        note += f"; a radius of the follower up to {reach} mm reaches it"
    raise InfeasibleError(
        "the follower does not reach the measured profile, which is hollow there",
        where=f"motion.file, {place(angle)}",
        value=height,
        unit="mm",
        nearest=note,
        adjustments=changes,
    )


def _changes(
    profile: MeasuredProfile, key: str, height: float, tolerance: float
) -> Iterator[Adjustment]:
    """Yield what may help: another radius of the follower, or a smoother curve."""
    if key and math.isfinite(profile.hollow):
        yield Adjustment(near={key: float(rounded_down(profile.hollow, 3))})
    if height < _SCATTER:
        sizes = (shortened(max(tolerance, share * height), 1.0, 2) for share in _WIDER)
        yield Adjustment(steps=[{"motion.radius_tolerance_mm": size} for size in sizes])
