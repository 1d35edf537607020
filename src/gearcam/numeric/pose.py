"""Poses: where a rigid body is.

Points in the plane are complex numbers, ``x + 1j*y``. A pose turns the points of a body about the
origin of its own frame, then shifts them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr


@dataclass(frozen=True)
class Pose(ShortRepr):
    """A turn about the origin of the body's own frame, then a shift; or n of both, as arrays.

    Parameters
    ----------
    turn : float or (n,) array, rad
        Counter-clockwise.
    shift : complex or (n,) complex array, mm
        Position of the body's origin.
    height : float, mm
        Position of a solid along z.

    Examples
    --------
    >>> Pose(0.0, 2.0) @ Pose(0.0, 1j) == Pose(0.0, 2.0 + 1j)
    True
    """

    turn: Any = 0.0
    shift: Any = 0j
    height: float = 0.0

    @property
    def rotation(self) -> Any:
        """The number of length 1 by which directions are multiplied; (n,) for arrays."""
        return np.exp(1j * np.asarray(self.turn))

    def apply(self, points: Any) -> Any:
        """Return `points`, complex, mm, given in the body's frame, in their places."""
        return points * self.rotation + self.shift

    def __matmul__(self, inner: Pose) -> Pose:
        """Return the pose of a body with the pose `inner` on a body with this one."""
        return Pose(self.turn + inner.turn, self.apply(inner.shift), self.height + inner.height)

    @property
    def inverse(self) -> Pose:
        """The pose that undoes this one."""
        return Pose(-self.turn, -np.conj(self.rotation) * self.shift, -self.height)

    def __getitem__(self, index: Any) -> Pose:
        """Return some of n poses."""
        return Pose(np.asarray(self.turn)[index], np.asarray(self.shift)[index], self.height)


UNMOVED: Final = Pose()
"""The pose of a body in its own frame."""
