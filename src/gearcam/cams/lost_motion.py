"""Lost motion: free travel of a follower between two walls while the cam is at rest, exactly.

A roller that rests on a wall has its centre on a parallel of the pitch curve, nearer to the wall by
half the clearance, or on an arc about a corner left by trimming. For a centre on that parallel the
cam angle and the lift have closed forms; for a given angle the centre is a bracketed root.

Depends on curve, followers, lost and numeric; numpy only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.cams.carriers import unit
from gearcam.cams.curve import ProfileSegments, segments
from gearcam.cams.followers import Round
from gearcam.cams.measures import Extreme
from gearcam.cams.trim import resting
from gearcam.cams.wall import Wall
from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import places_between
from gearcam.numeric.roots import bracketed_root, newton_in_bracket

_STEP = 1e-8
"""Last step of a search, rad of a turn or in units of a jump's velocity: the error is of the order
of its square."""

_ROUNDING = 1e-13
"""Angle, rad of a turn, larger than the rounding of angles in it."""

_FLAT = 1e-8
"""Width, rad of a turn, of a bracket of a largest value, which changes with its square."""

_APART = 1e-9
"""Angle, rad of a turn, below which two ends of stretches are merged."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Rest(ShortRepr):
    """A roller pressed against a wall.

    Parameters
    ----------
    wall : Wall
        Wall of a follower as wide as the groove.
    roller : Round
        The roller, at most as wide as the wall's follower.
    """

    wall: Wall
    roller: Round

    @cached_property
    def _centers(self) -> ProfileSegments:
        """The curve of the roller's centre, without corners."""
        inset = self.wall.side * (self.wall.follower.radius - self.roller.radius)
        return segments(replace(self.wall.curve, inset=inset))

    def _moving(self, index: Ints, parameter: Array) -> tuple[Array, Array, Array, Array]:
        """Return angles and lifts at points of the curve of centres, with their derivatives."""
        jumps = self._centers.jump[index]
        knots = self._centers.curve.program.knots[self._centers.piece[index]]
        theta = np.where(jumps, knots, parameter)
        centers, velocities = self._centers.moving(index, parameter)
        carrier = self.wall.carrier
        stands, position, fixed = carrier.stand(self.roller, centers, theta)
        # components along the follower's direction and across it
        across = np.conj(unit(self.roller.lean(position)))
        drawn = across * velocities * carrier.frame(stands)[0]
        turned = across * carrier.passing(fixed)
        # where the wall comes nearer to the axis than the roller can, it leaves the wall
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = -drawn.real / turned.real
            rise = (drawn.imag + turned.imag * slope) / self.roller.lever
        lift = position - self.roller.start
        return stands, lift, slope, rise

    @cached_property
    def _starts(self) -> Array:
        """Angles at the beginning of the pieces of that curve."""
        begin = self._centers.start
        return self._moving(np.arange(len(begin)), begin)[0]

    @cached_property
    def ends(self) -> Array:
        """Angles, rad, between which the lift is smooth."""
        bends = self._moving(*self._centers.breaks)[0]
        return np.concatenate([self._starts, bends, *(np.array(pair) for pair, _ in self._corners)])

    @cached_property
    def _corners(self) -> Sequence[tuple[tuple[float, float], complex]]:
        """Corners, with the angles between which the roller rests on them."""
        corners, curve = [], self._centers.curve
        for corner in self.wall.corners:
            theta = np.array([corner.before, corner.after])
            s, ds = self.wall.program.derivatives(theta, 1)
            places = curve.trace(theta, s, ds)[0]
            before, after = curve.carrier.stand(self.roller, places, theta)[0].tolist()
            corners.append(((before, after), corner.point))
        return corners

    @cached_property
    def span(self) -> tuple[float, float]:
        """Angles, rad, between which the roller rests on the wall."""
        if self.wall.program.closed:
            return 0.0, self.wall.program.period
        last = len(self._centers.end) - 1
        return float(self._starts[0]), float(
            self._moving(np.array([last]), self._centers.end[[last]])[0][0]
        )

    def lift(self, theta: Array) -> tuple[Array, Array]:
        """Return the lift of the resting follower and its slope.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.

        Returns
        -------
        lift, slope : (n,) arrays
            mm or rad, and per rad.
        """
        centers, starts = self._centers, np.maximum.accumulate(self._starts)
        program = self.wall.program
        period, grain = program.period, program.grain
        aim = theta if program.open else starts[0] + np.mod(theta - starts[0], period)
        index = np.maximum(np.searchsorted(starts, aim, side="right") - 1, 0)
        low, high = centers.start[index], centers.end[index]

        def function(parameter: Array) -> tuple[Array, Array]:
            stands, _, slope, _ = self._moving(index, parameter)
            return stands - aim, slope

        first = np.where(centers.jump[index], 0.5 * (low + high), np.clip(aim, low, high))
        places = newton_in_bracket(function, low, high, first, _STEP * grain, _ROUNDING * grain)
        stands, lift, slope, rise = self._moving(index, places)
        with np.errstate(invalid="ignore"):
            rise = np.where(np.isfinite(slope), rise / slope, 0.0)
        lift = lift + rise * (aim - stands)  # remaining error of the search
        for (before, after), point in self._corners:
            inside = np.mod(theta - before, period) <= np.mod(after - before, period)
            given = resting(self.roller, self.wall.carrier, point, self.wall.side)
            lift[inside], rise[inside] = given(Jet.variable(theta[inside], 1)).derivatives()
        return lift, rise


def largest_lost_motion(inner: Rest, outer: Rest) -> Extreme:
    """Return the largest lost motion of a follower between two walls, and where.

    Parameters
    ----------
    inner, outer : Rest
        Its roller, or its rollers, on the walls inside and outside the pitch curve.

    Returns
    -------
    Extreme
        Cam angle, rad, and lift, mm or rad.
    """

    def missing(theta: Array) -> list[Array]:
        rows = zip(outer.lift(theta), inner.lift(theta), strict=True)
        return [high - low for high, low in rows]

    program, spans = inner.wall.program, (inner.span, outer.span)
    period, apart = program.period, _APART * program.grain
    first, last = max(low for low, _ in spans), min(high for _, high in spans)
    ends = np.concatenate([inner.ends, outer.ends, [first]])
    if program.closed:
        ends = np.mod(ends, period)
    ends = np.sort(np.clip(ends, first, last))
    kept = ends[np.append(True, np.diff(ends) > apart)]
    x = places_between(np.append(kept[kept < last - apart], last))
    values, slopes = (found.reshape(x.shape) for found in missing(x.ravel()))
    best = int(values.argmax())
    place, value = float(x.ravel()[best]), float(values.ravel()[best])
    # near a largest value a function lies below its tangents: few cells can contain it
    low, high, width = slopes[:, :-1], slopes[:, 1:], np.diff(x, axis=1)
    top = np.minimum(values[:, :-1] + low * width, values[:, 1:] - high * width)
    cells = np.nonzero((low > 0.0) & (high < 0.0) & (top > value))
    if len(cells[0]):
        roots = bracketed_root(
            lambda theta: missing(theta)[1],
            x[:, :-1][cells],
            x[:, 1:][cells],
            _FLAT * program.grain,
            (low[cells], high[cells]),
        )
        found = missing(roots)[0]
        if found.max() > value:
            place, value = float(roots[found.argmax()]), float(found.max())
    return Extreme(theta=place % period, value=max(0.0, value))
