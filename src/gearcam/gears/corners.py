"""How far tip corners may reach into the mate's roots (trochoid interference).

At the moment of contact the end of a flank lies on the mate's flank. Where the centrode is concave
the corner moves deeper after that moment and may cut into the mate's root. The search narrows in
steps: only corners that come near the depth of the mate's root, or of wheels cut by a small
pinion, are traced. Most wheels have none.

In an internal pair a corner counts only below the mate's centrode: above it tips meet tips, which
shorter flanks do not cure (see `gearcam.gears.tip_pass`). Most traced corners are proved to stay
in the space that the mate's cutter swept. Only the rest are checked against the mate's outline,
which takes as long to compute as everything else.
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

from gearcam.base.display import ShortRepr
from gearcam.gears.flank import Toothing
from gearcam.gears.track import Frames
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, as_pairs, distinct

if TYPE_CHECKING:
    from shapely import Polygon

_WINDOW, _WIDE = 1.25, 8.0
"""Pitches of roll to either side of a flank over which its corner is traced; in tight parts."""

_ROLLS = 48
"""Roll positions per pitch."""

_APART = 8
"""Step of roll positions in the first pass against the cutter: it settles most points."""

_HALVINGS = 14
"""A reach of three modules halved 14 times: 0.0002 modules."""

_CAUTION = 0.4
"""Share of the clearance within which a corner is traced."""

_ABOUT = 0.8
"""Share of the distance to the mate's form point at which a corner counts as having reached it."""

_FEW = 24.0
"""Teeth of a pinion cutter below which all corners are traced: it leaves large fillets in a root
that has little space for tips."""

_PLACES = 8
"""Points per pitch; between them a curve is taken as straight."""

_FEET = 2.0
"""Pitches to either side of a first guess by polar angle within which a foot lies."""


def highest_corners(
    toothing: Toothing,
    mate: Toothing,
    mate_outline: Callable[[], Plane],
    tolerance: float,
    flanks: tuple[Array, Array],
    highest: Array,
) -> Array:
    """Return the largest reach at which each flank's corner stays out of the mate's root.

    Parameters
    ----------
    toothing, mate : Toothing
        The wheel and its mate.
    mate_outline : callable
        Returns the outline of the mate, complex, mm; called only if needed.
    tolerance : float, mm
        Its chord error. Penetration up to twice this counts as touching, since at contact a corner
        lies on the mate's flank.
    flanks : (sf, sigma), two (n,) arrays, mm and 1
        Flanks.
    highest : (n,) array, mm
        Reach of their ends without this limit.

    Returns
    -------
    (n,) array, mm
        `highest` where the corner does not interfere.
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
class _Paths(ShortRepr):
    """Paths of corners in the mate's frame, over a window of roll on either side of their flanks.

    Windows of neighbouring teeth are one pitch apart and share most of their roll positions.

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
    outline: Callable[[], Plane]
    tolerance: float

    @cached_property
    def internal(self) -> bool:
        """Whether one of the two wheels is a ring."""
        return self.mate.track.ring or self.toothing.track.ring

    @cached_property
    def _tight(self) -> bool:
        """Whether all corners are traced, over a longer window."""
        teeth = min(self.toothing.cutter.teeth, self.mate.cutter.teeth)
        return teeth < _FEW and not self.internal

    @property
    def _window(self) -> float:
        return _WIDE if self._tight else _WINDOW

    @cached_property
    def _phi(self) -> Array:
        """Driver angles of the roll positions of both sides, (2, k), rad."""
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
        """Return the windows around some flanks, (n, rolls), of values given for all rolls."""
        count = round(2 * self._window * _ROLLS) + 1
        windows = sliding_window_view(values, count, axis=1)[:, ::_ROLLS]
        return windows[np.divmod(some, windows.shape[1])]

    def _ends(self, some: Ints, reach: Array) -> Array:
        """Return the driver angles at which corners are in contact, rad."""
        return self.toothing.track.angle(self.sf[some] - self.sigma[some] * reach)

    def _along(self, some: Ints, ends: Frames) -> Plane:
        """Return corners relative to the pitch point P, in units of T, (n, rolls), mm."""
        corner = self.toothing.flank_points(ends, self.sf[some], self.sigma[some])
        away = corner[:, None] - self._about(self._own.p, some)
        return np.conj(self._about(self._own.t, some)) * away

    def _path(self, some: Ints, ends: Array) -> Plane:
        """Return positions of corners in the mate's frame, (n, rolls), mm."""
        along = self._along(some, self.toothing.frames(ends, curved=False))
        # the tangents coincide, and the outward normals are opposite
        return self._about(self._other.p, some) + self._about(self._other.t, some) * along

    def near(self, reach: Array) -> Ints:
        """Return which corners need tracing."""
        every = np.arange(reach.size)
        if self._tight:
            return every
        ends = self.toothing.frames(self._ends(every, reach), curved=self.internal)
        near = self._deep(every, ends)
        if self.internal:
            near |= self._grazing(ends, reach)
        return np.flatnonzero(near)

    def _deep(self, some: Ints, ends: Frames) -> Mask:
        """Return which corners get deep below the mate's pitch line, taken as straight."""
        deepest = self.mate.cutter.dedendum
        down = np.real(np.conj(self.toothing.turn) * self._along(some, ends))
        clearance = deepest - self.toothing.cutter.addendum
        return np.any(down > deepest - _CAUTION * clearance, axis=1)

    def _grazing(self, ends: Frames, reach: Array) -> Mask:
        """Return which corners near the mate's form point cut into the fillet that begins there.

        There the corner's path is tangent to the fillet. By Euler and Savary it is less curved,
        and so enters the metal, where ``kappa - kc > sin(alpha)*rho/(l*(l - rho))`` with ``l =
        reach*cos(alpha)``.
        """
        cutter = self.mate.cutter
        far = cutter.reach * math.cos(cutter.alpha)
        room = math.sin(cutter.alpha) * cutter.tip_radius / (far * (far - cutter.tip_radius))
        return (reach > _ABOUT * cutter.reach) & (ends.kappa - cutter.kc > room)

    def doubtful(self, some: Ints, reach: Array) -> Ints:
        """Return which of some corners are not proved to stay in the space the mate's cutter swept.

        Most points of a path are settled by the cutter's position at the corner's contact, the
        rest by other positions. Distances below the tolerance count as swept, as in `hit`.
        """
        mate, ends = self.mate, self._ends(some, reach)
        middle = (self.sf - self.sigma * self.toothing.half_tooth)[some]
        if not mate.closed:  # the cutter does not move beyond the teeth of an open wheel
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
        return some[distinct(corner)]

    def hit(self, some: Ints, reach: Array) -> Mask:
        """Return which corners penetrate the mate's outline."""
        import shapely

        path = self._path(some, self._ends(some, reach))
        metal = shapely.contains_xy(self._body, path.real, path.imag) != self.mate.track.hollow
        if not (self.mate.closed or self.toothing.closed):
            # an open pair stops at the end of its travel; beyond it only its other end is hit
            s = self._about(self._other.s, some)
            metal &= (s >= 0.0) & (s <= self.mate.length)
        if self.internal:
            metal &= (self._centrode.beyond(path) > 0.0) == self.mate.track.ring
        return np.any(metal, axis=1)

    @cached_property
    def _body(self) -> Polygon:
        """The mate's outline, its metal shrunk by the depth that counts as touching."""
        import shapely

        touched = 2.0 * self.tolerance
        whole = shapely.Polygon(as_pairs(self.outline()))
        body = whole.buffer(touched if self.mate.track.hollow else -touched)
        shapely.prepare(body)
        return body

    @cached_property
    def _centrode(self) -> RadialCurve:
        return RadialCurve(self.mate, 0.0)


class RadialCurve:
    """A parallel of a centrode in polar coordinates; its angle rises with the driver angle.

    It is approximate: to sort points of ring pairs.

    Parameters
    ----------
    toothing : Toothing
        A driver or a ring.
    height : float, mm
        Its distance from the centrode, towards the tips.
    """

    def __init__(self, toothing: Toothing, height: float) -> None:
        more = 0 if toothing.closed else 1  # pitches added at each end for the outer half teeth
        count = _PLACES * (toothing.teeth + 2 * more)
        s = toothing.pitch * (np.arange(count + 1) / _PLACES - more)
        reach = _FEET * toothing.pitch
        self._phi = toothing.track.angle(np.stack([s - reach, s + reach, s]))
        base = toothing.frames(self._phi[2], curved=False)
        points = base.p + height * toothing.turn * base.t
        self._polar, self._radii = np.unwrap(np.angle(points)), np.abs(points)

    def _places(self, points: Plane) -> Array:
        first = self._polar[0]
        return first + (np.angle(points) - first) % (2.0 * math.pi)

    def feet(self, points: Plane) -> tuple[Array, Array, Array]:
        """Return bounds and guesses of the feet of points near it, driver angles, rad."""
        places = self._places(points)
        low, high, guess = (np.interp(places, self._polar, phi) for phi in self._phi)
        return low, high, guess

    def beyond(self, points: Plane) -> Array:
        """Return radii of points less those of the curve, mm; -inf beyond the last angle."""
        return np.abs(points) - np.interp(
            self._places(points), self._polar, self._radii, right=math.inf
        )
