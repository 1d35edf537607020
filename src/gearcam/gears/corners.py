"""How far tips may reach into the mate's roots.

At the moment of contact the end of a flank lies on the mate's flank. Where the centrode is concave
the corner goes on deeper beyond that moment, and may run into the mate's root. Such corners are
found in steps: those that come near the depth of the mate's root, or where a wheel is cut by a
small pinion, are followed. Most wheels have none.

In an internal pair a corner counts only below the mate's centrode: above it tips meet tips, which
shorter flanks do not cure (see `gearcam.gears.tip_pass`). There most corners that are followed are
seen to stay where the mate's cutter was. Only what is left is followed against the mate's outline,
which takes as long to make as all the rest.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from gearcam.display import Brief
from gearcam.gears.flank import Toothing
from gearcam.gears.polar import PolarCurve
from gearcam.gears.track import Frames
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

if TYPE_CHECKING:
    from shapely import Polygon

_WINDOW, _WIDE = 1.25, 8.0
"""Pitches of roll on either side of a flank over which its corner is followed; in tight parts."""

_ROLLS = 48
"""Rolls in a pitch."""

_APART = 8
"""Rolls between those at which the cutter is looked at first: most points are settled by these."""

_HALVINGS = 14
"""A reach of three modules halved 14 times: 0.0002 modules."""

_CAUTION = 0.4
"""Share of the clearance within which a corner is followed."""

_ABOUT = 0.8
"""Share of the way to the mate's form point from which a corner counts as there."""

_FEW = 24.0
"""Teeth of a pinion cutter below which all corners are followed: it leaves much in the corners of a
root, and in so tight a place tips crowd."""


def highest_corners(
    toothing: Toothing,
    mate: Toothing,
    mate_outline: Callable[[], Array],
    tolerance: float,
    flanks: tuple[Array, Array],
    highest: Array,
) -> Array:
    """Return the largest reach at which each flank's corner stays out of the mate's root.

    Parameters
    ----------
    toothing, mate : Toothing
        The wheel and the other one.
    mate_outline : callable
        Returns the outline of the other wheel, (n, 2), mm; called only where it is needed.
    tolerance : float, mm
        Its chord error. A corner only touches up to twice this depth: at contact it lies on the
        mate's flank.
    flanks : (sf, sigma), two (n,) arrays, mm and 1
        Flanks.
    highest : (n,) array, mm
        Reach of their ends as they would be.

    Returns
    -------
    (n,) array, mm
        `highest` where it does no harm.
    """
    if toothing.track.concave.radius == math.inf and mate.cutter.kc == 0.0:
        return highest.copy()
    # a closed pair repeats with its lobes
    teeth = len(highest) // 2
    count = math.gcd(toothing.teeth, mate.teeth) if toothing.closed and mate.closed else teeth
    sf, sigma, reach = (v.reshape(2, -1)[:, :count].ravel() for v in (*flanks, highest))
    paths = _Paths(
        toothing=toothing,
        mate=mate,
        sf=sf,
        sigma=sigma,
        outline=mate_outline,
        tolerance=tolerance,
    )
    at = paths.near(reach)
    if at.size and paths.internal:
        at = paths.doubtful(at, reach[at])
    if at.size:
        at = at[paths.hit(at, reach[at])]
    if at.size == 0:
        return highest.copy()
    low, high = np.zeros(at.size), reach[at]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        bad = paths.hit(at, middle)
        low, high = np.where(bad, low, middle), np.where(bad, middle, high)
    allowed = np.full(reach.shape, math.inf)
    allowed[at] = low
    return np.minimum(highest, np.tile(allowed.reshape(2, -1), teeth // count).ravel())


@dataclass(frozen=True, eq=False, kw_only=True)
class _Paths(Brief):
    """Paths of corners past the mate, over the rolls of a window on either side of their flanks.

    The rolls of neighbouring teeth are a pitch apart, and are the same ones for most of their way.

    Parameters
    ----------
    toothing, mate, outline, tolerance
        See `highest_corners`.
    sf, sigma : (n,) arrays, mm and 1
        Flanks: sigma = +1 of teeth in order, then sigma = -1.
    """

    toothing: Toothing
    mate: Toothing
    sf: Array
    sigma: Array
    outline: Callable[[], Array]
    tolerance: float

    @cached_property
    def internal(self) -> bool:
        """Whether one of the two is a ring."""
        return self.mate.track.ring or self.toothing.track.ring

    @cached_property
    def _tight(self) -> bool:
        """Whether all corners are followed, and farther."""
        teeth = min(self.toothing.cutter.teeth, self.mate.cutter.teeth)
        return teeth < _FEW and not self.internal

    @property
    def _window(self) -> float:
        return _WIDE if self._tight else _WINDOW

    @cached_property
    def _phi(self) -> Array:
        """Driver angles of the rolls of both sides, (2, k), rad."""
        sf, window = self.sf.reshape(2, -1), self._window
        count = sf.shape[1] - 1
        rolls = np.arange(-window * _ROLLS, (window + count) * _ROLLS + 1) / _ROLLS
        return self.toothing.track.angle(sf[:, :1] + self.toothing.pitch * rolls)

    @cached_property
    def _own(self) -> Frames:
        return self.toothing.frames(self._phi, curved=False)

    @cached_property
    def _other(self) -> Frames:
        return self.mate.frames(self._phi, curved=False)

    def _about(self, values: NDArray[Any], some: Ints) -> NDArray[Any]:
        """Return of what belongs to all rolls that of the rolls about some flanks, (n, rolls)."""
        count = round(2 * self._window * _ROLLS) + 1
        windows = sliding_window_view(values, count, axis=1)[:, ::_ROLLS]
        return windows[np.divmod(some, windows.shape[1])]

    def _ends(self, some: Ints, reach: Array) -> Array:
        """Return the driver angles at which corners are in contact, rad."""
        return self.toothing.track.angle(self.sf[some] - self.sigma[some] * reach)

    def _along(self, some: Ints, ends: Frames) -> Plane:
        """Return where corners are from P, seen along T, at all rolls, (n, rolls), mm."""
        corner = self.toothing.flank_points(ends, self.sf[some], self.sigma[some])
        away = corner[:, None] - self._about(self._own.p, some)
        return np.conj(self._about(self._own.t, some)) * away

    def _path(self, some: Ints, ends: Array) -> Plane:
        """Return points of corners in the mate's frame, (n, rolls), mm."""
        along = self._along(some, self.toothing.frames(ends, curved=False))
        # both tangents are one, and the outward normals opposite
        return self._about(self._other.p, some) + self._about(self._other.t, some) * along

    def near(self, reach: Array) -> Ints:
        """Return which corners are to be followed."""
        every = np.arange(reach.size)
        if self._tight:
            return every
        ends = self.toothing.frames(self._ends(every, reach), curved=self.internal)
        near = self._deep(every, ends)
        if self.internal:
            near |= self._grazing(ends, reach)
        return np.flatnonzero(near)

    def _deep(self, some: Ints, ends: Frames) -> Mask:
        """Whether corners go deep below the mate's pitch line, as on a straight rack, anywhere."""
        deepest = self.mate.cutter.dedendum
        down = np.real(np.conj(self.toothing.turn) * self._along(some, ends))
        clearance = deepest - self.toothing.cutter.addendum
        return np.any(down > deepest - _CAUTION * clearance, axis=1)

    def _grazing(self, ends: Frames, reach: Array) -> Mask:
        """Whether corners that end about the mate's form point run into the fillet beginning there.

        There the corner's path touches the fillet. By Euler and Savary it bends less, and so goes
        into the metal, where ``kappa - kc > sin(alpha)*rho/(l*(l - rho))`` with ``l =
        reach*cos(alpha)``.
        """
        cutter = self.mate.cutter
        far = cutter.reach * math.cos(cutter.alpha)
        room = math.sin(cutter.alpha) * cutter.tip_radius / (far * (far - cutter.tip_radius))
        return (reach > _ABOUT * cutter.reach) & (ends.kappa - cutter.kc > room)

    def doubtful(self, some: Ints, reach: Array) -> Ints:
        """Return which of some corners are not seen to stay where the mate's cutter was.

        Most points of a path it takes at the roll at which the corner is in contact, the rest at
        others. What it comes as near to as the tolerance, `hit` does not count either.
        """
        mate, ends = self.mate, self._ends(some, reach)
        middle = (self.sf - self.sigma * self.toothing.half_tooth)[some]
        if not mate.closed:  # beyond its teeth nothing is cut
            first, last = mate.tooth_places[[0, -1]]
            middle = np.where((first < middle) & (middle < last), middle, math.nan)
        path = self._path(some, ends)
        corner = np.repeat(np.arange(some.size), path.shape[1])
        p, t, s = (self._about(v, some).T for v in (self._other.p, self._other.t, self._other.s))
        window = Frames(p, t, np.empty(0), s, s)
        contact = mate.frames(ends, curved=False)
        points, rolls = path.ravel(), range(len(s))
        for roll in (contact, *map(window.some, rolls[::_APART]), *map(window.some, rolls)):
            along = np.conj(roll.t[corner]) * (points - roll.p[corner])
            depth = -np.real(np.conj(mate.turn) * along)
            gap = mate.cutter.gap(along.real, depth, (middle - roll.s)[corner])
            left = ~(gap <= self.tolerance)
            corner, points = corner[left], points[left]
            if corner.size == 0:
                break
        return some[np.unique(corner)]

    def hit(self, some: Ints, reach: Array) -> Mask:
        """Whether some corners go into the metal of the mate's outline."""
        import shapely

        path = self._path(some, self._ends(some, reach))
        metal = shapely.contains_xy(self._body, path.real, path.imag) != self.mate.track.hollow
        if not (self.mate.closed or self.toothing.closed):
            # beyond its travel an open pair does not go, were it only into the mate's other end
            s = self._about(self._other.s, some)
            metal &= (s >= 0.0) & (s <= self.mate.length)
        if self.internal:
            metal &= (self._centrode.beyond(path) > 0.0) == self.mate.track.ring
        return np.any(metal, axis=1)

    @cached_property
    def _body(self) -> Polygon:
        """The mate's outline, its metal less by what corners may touch."""
        import shapely

        touched = 2.0 * self.tolerance
        whole = shapely.Polygon(self.outline())
        body = whole.buffer(touched if self.mate.track.hollow else -touched)
        shapely.prepare(body)
        return body

    @cached_property
    def _centrode(self) -> PolarCurve:
        return PolarCurve(self.mate, 0.0)
