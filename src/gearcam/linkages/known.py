"""What is solved of a linkage so far: its joints, members and quantities by name."""

from __future__ import annotations

from typing import Final, TypeVar

import numpy as np

from gearcam.linkages.dyads import Solved
from gearcam.linkages.plane import Frame
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.jets import Jet

GROUND: Final = "ground"
"""Name of the frame of what does not move."""

Given = Jet | Frame

_T = TypeVar("_T", Jet, Frame)


class Known:
    """What is solved so far, at some angles of the driver.

    Parameters
    ----------
    q : (n,) array, rad
        Angles of the driver.
    order : int
        Highest derivative.
    """

    def __init__(self, q: Array, order: int) -> None:
        self.q, self.order = q, order
        self.given: dict[str, Given] = {}
        self.solved: dict[str, Solved] = {}
        self.given[GROUND] = Frame(self.constant(0j), self.constant(1 + 0j))

    def constant(self, value: complex) -> Jet:
        """Return the jet of a number."""
        return Jet([np.full(self.q.shape, value), *[0.0] * self.order])

    def jet(self, name: str) -> Jet:
        """Return a joint or a quantity by name."""
        return self._of(name, Jet)

    def frame(self, name: str) -> Frame:
        """Return a member or a guide by name."""
        return self._of(name, Frame)

    def _of(self, name: str, wanted: type[_T]) -> _T:
        found = self.given[name]
        if not isinstance(found, wanted):
            raise TypeError(f"{name} is a {type(found).__name__}, not a {wanted.__name__}")
        return found

    def place(self, name: str) -> Plane:
        """Return the place of a joint, or of the origin of a member or guide, (n,), mm."""
        found = self.given[name]
        point = found.origin if isinstance(found, Frame) else found
        return np.asarray(point.c[0]) + np.zeros(self.q.shape, dtype=complex)

    def direction(self, name: str) -> Plane:
        """Return the direction of the x axis of a member or guide, (n,)."""
        return np.asarray(self.frame(name).direction.c[0]) + np.zeros(self.q.shape, dtype=complex)

    def rate(self, name: str) -> Array:
        """Return the derivative of a quantity by the driver's angle, (n,)."""
        return np.asarray(self.jet(name).c[1]) + np.zeros(self.q.shape)
