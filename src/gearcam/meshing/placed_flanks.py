"""Flanks of pairs in their mounted positions, for first contact and contact patches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Self

import numpy as np

from gearcam.gears.contact import FlankPairs
from gearcam.gears.track import Wheel
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import newton_in_bracket


@dataclass(frozen=True, eq=False, kw_only=True)
class PlacedFlanks:
    """Flanks of n pairs, both wheels turned and moved to their positions.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    step, pair : (n,) int arrays
        Number of the phase; j.
    turn, offset : (2, n) complex arrays, 1 and mm
        Rotation of the points of both wheels, and the offset added after it.
    """

    pairs: FlankPairs
    step: Ints
    pair: Ints
    turn: Plane
    offset: Plane

    def select(self, index: Ints | Mask) -> Self:
        """Return the pairs `index`."""
        _, *each = (one.name for one in fields(self))
        return replace(self, **{name: getattr(self, name)[..., index] for name in each})

    @cached_property
    def sf(self) -> Array:
        """Position sf of both flanks, (2, n), mm."""
        return np.stack([wheel.place(self.pair) for wheel in self.pairs.wheels])

    @cached_property
    def ends(self) -> Array:
        """Driver angles, rad, of root and tip of both flanks, (2, 2, n)."""
        rolls = [
            sf - wheel.sigma * np.stack(wheel.reach(self.pair))
            for wheel, sf in zip(self.pairs.wheels, self.sf, strict=True)
        ]
        return self.pairs.track.angle(np.stack(rolls))

    def at(self, wheel: Wheel, angle: Array, *, unit: bool = False) -> tuple[Plane, Plane]:
        """Return points of a wheel's flanks, and directions along them.

        Parameters
        ----------
        wheel : {1, 2}
            Driver or driven wheel.
        angle : (n,) array, rad
            Driver angles of the points.
        unit : bool
            Whether the directions are unit vectors, of either sense, instead of derivatives by
            `angle`.

        Returns
        -------
        points, directions : (n,) complex arrays, mm and mm/rad (or 1)
        """
        flanks, turn = self.pairs.wheels[wheel - 1], self.turn[wheel - 1]
        toothing, sigma, sf = flanks.toothing, flanks.sigma, self.sf[wheel - 1]
        frames = toothing.frames(angle, curved=not unit)
        point = toothing.flank_points(frames, sf, sigma) + flanks.eccentric
        if unit:
            direction = toothing.turn * toothing.normals(frames, sigma)
        else:
            direction = toothing.flank_motion(frames, sf, sigma)
        return point * turn + self.offset[wheel - 1], direction * turn

    def find(
        self,
        wheel: Wheel,
        measure: Callable[[Plane, Plane], tuple[Array, Array]],
        value: Array,
        ends: Sequence[Array] | Array,
        start: Array,
        tolerance: float,
    ) -> Array:
        """Return the driver angles, rad, of flank points at which a measure has given values.

        Parameters
        ----------
        wheel : {1, 2}
            Driver or driven wheel.
        measure : callable
            ``measure(points, directions)`` returns values and their directional derivatives.
        value : (n,) array
            The values.
        ends : two (n,) arrays, rad
            Angles of points with lower and with higher values.
        start : (n,) array, rad
            First guess.
        tolerance : float, rad
            Step at which the search ends.

        Returns
        -------
        (n,) array
            The nearer end where a value is not reached.
        """

        def miss(angle: Array) -> tuple[Array, Array]:
            found, rate = measure(*self.at(wheel, angle))
            return found - value, rate

        low, high = ends
        start = np.clip(start, np.minimum(low, high), np.maximum(low, high))
        return newton_in_bracket(miss, low, high, start, tolerance)
