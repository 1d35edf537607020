"""The periodic motion of a follower that stays on its cam, and at which speed it jumps.

In contact the equations are linear, with constant matrices: ``z' = A*z + B*p(x)``. A cell is passed
by collocation at the eight nodes of Radau, of order 15: exact to rounding where cells are small
beside the natural periods, and true to the slow motion where they are not. So cells are small
everywhere, or, of a slow cam, behind each knot until its vibrations have died away. The state at
the beginning of the turn is that which repeats. Nothing is cut off, as a Fourier series would be at
jumps of acceleration or load.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.dynamics.follower import ElasticFollower
from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.narrowing import peaks
from gearcam.numeric.roots import bracketed_root

_EVEN: Final = 720
"""Cells of a turn, at least."""

_PER_PIECE: Final = 24
"""Cells between knots, at least."""

_PER_PERIOD: Final = 16
"""Cells in the fastest natural period, where it is followed: extremes are found between them."""

_FOLLOWED: Final = 10_000
"""Largest number of cells in a turn that is followed all along."""

_GONE: Final = 27.6
"""Exponent of what has died away: 1e-12."""


def _radau(count: int) -> tuple[Array, Array]:
    """Return nodes in (0, 1], (n,), and integrals from 0 to them over values there, (n, n)."""
    legendre = np.polynomial.legendre
    nodes = np.sort(legendre.legroots([0.0] * (count - 1) + [1.0, -1.0]).real)
    nodes[-1] = 1.0
    values = legendre.legvander(nodes, count - 1)
    integrals = np.stack(
        [legendre.legval(nodes, legendre.legint(row, lbnd=-1.0)) for row in np.eye(count)], axis=1
    )
    weights = np.linalg.solve(values.T, integrals.T).T
    return 0.5 * (1.0 + nodes), np.asarray(0.5 * weights, dtype=float)


NODES, _INTEGRALS = _radau(8)
"""Nodes of a cell, over its width, and integrals up to them over values there."""

_NARROW: Final = 1e-4
"""Width to which two cells around an extreme are narrowed: its value is exact to rounding."""

_SPEEDS: Final = 0.5
"""Step of the speeds that are looked at, over the damping ratio: a resonance at a whole fraction of
a natural frequency is twice the ratio wide, so that it has four of them."""

_FINEST, _COARSEST = 2e-3, 0.05
"""Limits of that step."""

_BEYOND: Final = 3.0
"""Largest speed that is looked at, over that at which a rigid follower jumps."""

_MOST_EVEN: Final = 16_384
"""Largest number of places for a Fourier series."""

_NEARLY: Final = 0.02
"""Contact force over the largest load below which a speed is looked at closely."""

_SETTLED: Final = 4.6
"""Exponent of a vibration that is small: 1 %."""

_STIFFER: Final = 1.5
"""Steps in which the stiffness of a spring is looked for; one far too stiff keeps less again of a
mean force that grows with it."""

_EXACT: Final = 1e-10
"""Relative tolerance of roots."""


def passing(matrix: Array, entry: Array, width: ArrayLike) -> tuple[Array, Array]:
    """Return how ``z' = matrix @ z + entry @ p`` passes through cells.

    Parameters
    ----------
    matrix, entry : (m, m) and (m, k) arrays
        Of the equations.
    width : float or (n,) array
        Of the cells.

    Returns
    -------
    (..., m, m) array
        What becomes of z.
    (..., g, m, k) array
        What p at each node adds.
    """
    width = np.asarray(width, dtype=float)[..., None, None]
    size, count = len(matrix), len(NODES)
    coupled = np.eye(size * count) - width * np.kron(_INTEGRALS, matrix)
    right = np.empty((*width.shape[:-2], size * count, size + count * entry.shape[1]))
    right[..., :size] = np.tile(np.eye(size), (count, 1))
    right[..., size:] = width * np.kron(_INTEGRALS, entry)
    solved = np.asarray(np.linalg.solve(coupled, right), dtype=float)
    last = solved[..., -size:, :]
    inward = last[..., size:].reshape(*last.shape[:-1], count, -1)
    return last[..., :size], np.moveaxis(inward, -2, -3)


class Periodic(ShortRepr):
    """The periodic motion of a follower in contact.

    Parameters
    ----------
    follower : ElasticFollower
        The follower.
    """

    def __init__(self, follower: ElasticFollower) -> None:
        self.follower = follower
        self._zones = _zones(follower)
        cells = [np.linspace(low, high, count + 1)[:-1] for low, high, count in self._zones]
        self.edges: Array = np.concatenate([*cells, follower.knots[-1:]])
        count, self._unit = len(follower.masses), float(follower.frequencies[-1])
        self._matrix = follower.system / follower.speed
        self._input = np.zeros((2 * count, count))
        inertia = np.array(follower.masses) * self._unit * follower.speed
        self._input[count:] = np.diag(1.0 / inertia)

    def _forces(self, low: Array, width: Array) -> Array:
        """Return what bends the springs at nodes of cells, (masses, n, g)."""
        x = low[:, None] + width[:, None] * NODES
        x[:, -1] = np.maximum(np.nextafter(x[:, -1], -np.inf), low)  # before a knot
        follower, flat = self.follower, x.ravel()
        y, v, a = follower.lift(flat, 2)
        found = -follower.loads(flat) - np.outer(follower.masses, follower.speed**2 * a)
        found[-1] -= follower.spring * y + follower.damper * follower.speed * v
        return found.reshape(-1, *x.shape)

    @cached_property
    def states(self) -> Array:
        """Lags, and their derivatives by time over the highest frequency, (n + 1, 2*masses)."""
        forces = self._forces(self.edges[:-1], np.diff(self.edges))
        whole, parts, begin = np.eye(len(self._matrix)), [], 0
        for low, high, count in self._zones:
            step, inward = passing(self._matrix, self._input, (high - low) / count)
            put = np.einsum("gab,bng->na", inward, forces[:, begin : begin + count])
            parts.append((step, put))
            whole, begin = np.linalg.matrix_power(step, count) @ whole, begin + count

        def turn(state: Array) -> Array:
            found = [state[None]]
            for step, put in parts:
                found.append(_scan(step, np.vstack([found[-1][-1], put]))[1:])
            return np.vstack(found)

        added = turn(np.zeros(len(whole)))[-1]
        return turn(np.asarray(np.linalg.solve(np.eye(len(whole)) - whole, added), dtype=float))

    def _by_angle(self, states: Array) -> Array:
        """Return lag and derivative by the angle in turn, (2*masses, n), from rows of states."""
        count = len(self.follower.masses)
        found = np.empty((2 * count, len(states)))
        found[0::2] = states[:, :count].T
        found[1::2] = states[:, count:].T * (self._unit / self.follower.speed)
        return found

    def at(self, x: ArrayLike) -> Array:
        """Return lags and their derivatives by the angle in turn, (2*masses, n), at angles."""
        x, edges = np.asarray(x, dtype=float), self.edges
        cell = np.clip(edges.searchsorted(x, side="right") - 1, 0, len(edges) - 2)
        width = x - edges[cell]
        step, inward = passing(self._matrix, self._input, width)
        found = np.einsum("nab,nb->na", step, self.states[cell])
        put = np.einsum("ngab,bng->na", inward, self._forces(edges[cell], width))
        return self._by_angle(found + put)

    @cached_property
    def start(self) -> Array:
        """The state at the beginning of the turn (see `at`)."""
        return self._by_angle(self.states[:1])[:, 0]

    @cached_property
    def forces(self) -> Array:
        """Contact force along the lift at the edges of the cells."""
        return self.follower.contact_force(self._by_angle(self.states))

    def least(self) -> tuple[float, float]:
        """Return the smallest contact force, from the side that presses, and where it is."""
        side, edges = self.follower.side, self.edges
        best = int(np.argmin(side * self.forces))
        ends = edges[[max(best - 1, 0), min(best + 1, len(edges) - 1)]]

        def lifting(x: Array, _: Ints) -> Array:
            return -side * self.follower.contact_force(self.at(x.ravel())).reshape(x.shape)

        places, values = peaks(lifting, ends[:1], ends[1:], _NARROW * float(np.ptp(ends)))
        return -float(values[0]), float(places[0])

    def spare(self, share: float) -> float:
        """Return the smallest contact force less a share of the mean one."""
        mean = float(np.trapezoid(self.forces, self.edges)) / float(np.ptp(self.edges))
        return self.least()[0] - share * self.follower.side * mean


def _zones(follower: ElasticFollower) -> list[tuple[float, float, int]]:
    """Return ends of zones of a turn, and into how many equal cells each is cut."""
    turn, speed = float(np.ptp(follower.knots)), follower.speed
    small = 2.0 * math.pi * speed / float(follower.frequencies[-1]) / _PER_PERIOD
    even = turn / _EVEN
    narrow, fading = min(small, even), _GONE * speed / float(-follower.roots.real.max())
    if turn <= _FOLLOWED * small:
        fading = turn
    found = []
    for low, high in pairwise(follower.knots.tolist()):
        middle = min(low + fading, high)
        for start, end, width in ((low, middle, narrow), (middle, high, even)):
            if end > start:
                found.append((start, end, max(math.ceil((end - start) / width), _PER_PIECE)))
    return found


def _scan(step: Array, rows: Array) -> Array:
    """Return ``z[i] = step @ z[i - 1] + rows[i]``, by doubling."""
    reach = 1
    while reach < len(rows):
        moved = rows.copy()
        moved[reach:] += rows[:-reach] @ step.T
        rows, step, reach = moved, step @ step, 2 * reach
    return rows


def elastic_jump(follower: ElasticFollower) -> float | None:
    """Return the lowest speed at which the smallest contact force is 0, rad/s, or None.

    The force is no monotone function of the speed: at whole fractions of natural frequencies it has
    resonances. Speeds are looked at in steps of half the damping ratio, first roughly, up to three
    times that of a rigid follower, from the lowest at which vibrations could take the load off;
    where loads jump, from that at which the vibration has died away before the next knot. None: it
    does not jump there; 0: it does at all speeds that are low.

    Parameters
    ----------
    follower : ElasticFollower
        The follower, at any speed.
    """
    low, high, ratio = _speeds(follower)
    if not high:
        return 0.0

    def least(speed: float) -> float:
        return Periodic(replace(follower, speed=speed)).least()[0]

    if least(low) <= 0.0:
        return 0.0
    step = min(max(_SPEEDS * ratio, _FINEST), _COARSEST)
    speeds = np.geomspace(low, high, math.ceil(math.log(high / low) / step) + 1)
    coarse = _by_series(follower, speeds)
    for k in np.flatnonzero(coarse[1:] <= _NEARLY * follower.sizes[0]) + 1:
        before, speed = float(speeds[k - 1]), float(speeds[k])
        if least(speed) > 0.0:
            around = speeds[k - 1 : k + 2]
            if len(around) < 3 or coarse[k] > min(coarse[k - 1], coarse[k + 1]):
                continue
            speed, dip = _dip(least, around)
            if dip > 0.0:
                continue
        while least(before) <= 0.0:
            before *= 1.0 - step
        return _root(least, before, speed)
    return None


def _by_series(follower: ElasticFollower, speeds: Array) -> Array:
    """Return the smallest contact force at speeds, (n,), roughly: by Fourier series of the lift."""
    periods = float(follower.frequencies[-1] / speeds[0])
    count = 2 ** math.ceil(math.log2(min(max(4.0 * periods, 1024.0), _MOST_EVEN)))
    x = follower.knots[0] + (follower.knots[-1] - follower.knots[0]) * np.arange(count) / count
    y, v, a = (np.fft.rfft(one) for one in follower.lift(x, 2))
    loads = np.fft.rfft(follower.loads(x))
    masses, damping, stiffness = follower.matrices
    turns, found = 1j * np.arange(len(y)), []
    for speed in speeds.tolist():
        rates = (turns * speed)[:, None, None]
        pushed = -loads - masses[:, None] * (speed**2 * a)
        pushed[-1] -= follower.spring * y + follower.damper * speed * v
        matrix = stiffness + rates * damping + rates**2 * np.diag(masses)
        lag = np.linalg.solve(matrix, pushed.T[..., None])[:, 0, 0]
        first = follower.stiffness[0] + follower.damping[0] * rates[:, 0, 0]
        found.append((follower.side * np.fft.irfft(-first * lag, count)).min())
    return np.array(found)


def keeping_stiffness(follower: ElasticFollower, share: float, left: float) -> float:
    """Return the least stiffness between last mass and frame that keeps a follower on its cam.

    Parameters
    ----------
    follower : ElasticFollower
        The follower, at its speed.
    share, left : float
        Least contact force that is wanted: a share of the mean one, and a force besides.

    Returns
    -------
    float
        Infinite if none up to that of the softest spring before the masses does.
    """

    def lack(stiffness: float) -> float:
        return left - Periodic(replace(follower, spring=stiffness)).spare(share)

    if lack(0.0) <= 0.0:
        return 0.0
    most, (load, size) = min(follower.stiffness), follower.sizes
    low, high = 0.0, min(0.1 * load / size, most)
    while lack(high) > 0.0:
        if high == most:
            return math.inf
        low, high = high, min(_STIFFER * high, most)
    return _root(lack, low, high)


def _speeds(follower: ElasticFollower) -> tuple[float, float, float]:
    """Return lowest and highest speed of the search, and the damping ratio; 0 where it is loose.

    A vibration of one mass follows its excitation at most ``1 + 2/(pi*ratio)`` times.
    """
    x = follower.samples
    _, v, a = follower.lift(x, 2)
    still = follower.side * follower.rigid_force(x, 0.0)
    ratio = float((-follower.roots.real / np.abs(follower.roots)).min())
    if still.min() <= 0.0:
        return 0.0, 0.0, ratio
    grows = 1.0 + 2.0 / (math.pi * ratio)
    inertia = follower.mass * grows * np.abs(a).max()
    drag = follower.damper * grows * np.abs(v).max()
    low = 2.0 * still.min() / (drag + math.sqrt(drag**2 + 4.0 * inertia * still.min()))
    pulling = -follower.side * follower.mass * a
    rigid = math.sqrt(float((still[pulling > 0.0] / pulling[pulling > 0.0]).min()))
    ends = follower.knots
    before = follower.loads(np.nextafter(ends[1:], -np.inf))
    after = np.roll(follower.loads(np.nextafter(ends[:-1], np.inf)), -1, axis=1)
    if (np.abs(after - before) > _EXACT * np.abs(before).max(initial=0.0)).any():
        low = min(low, float(np.diff(ends).min() * -follower.roots.real.max() / _SETTLED))
    return float(low), _BEYOND * rigid, ratio


def _dip(function: Callable[[float], float], speeds: Array) -> tuple[float, float]:
    """Return place and value of the least of a function between three places."""
    from scipy.optimize import minimize_scalar

    low, high = float(speeds[0]), float(speeds[2])
    options = {"xatol": 1e-4 * high}
    found: Any = minimize_scalar(function, bounds=(low, high), method="bounded", options=options)
    return float(found.x), float(found.fun)


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the root of a function that is positive at one place and not at another."""
    if function(high) > 0.0:  # below 0 by the coarse search alone
        return high

    def values(x: Array) -> Array:
        return np.array(function(float(x)))

    return float(bracketed_root(values, low, high, _EXACT * high))
