"""Poses: where a rigid body is.

Points in the plane are complex numbers, ``x + 1j*y``. A pose turns the points of a body about the
origin of its own frame, then shifts them. A pose in space turns them about a direction.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array


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

    @property
    def in_space(self) -> SpacePose:
        """The same pose of a solid, about the z-axis."""
        heights = np.full(np.shape(self.shift), self.height)
        return SpacePose(
            axis=(0.0, 0.0, 1.0),
            turn=self.turn,
            shift=np.stack([np.real(self.shift), np.imag(self.shift), heights], axis=-1),
        )

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


@dataclass(frozen=True, eq=False)
class SpacePose(ShortRepr):
    """A turn of a solid about a direction through the origin of its own frame, then a shift.

    Parameters
    ----------
    axis : tuple of 3 floats
        The direction, of length 1; the same for all n poses.
    turn : float or (n,) array, rad
        Counter-clockwise, seen against the direction.
    shift : (3,) or (n, 3) array, mm
        Position of the solid's origin.
    """

    axis: tuple[float, float, float]
    turn: Any
    shift: Array

    @property
    def matrix(self) -> Array:
        """The (4, 4) or (n, 4, 4) matrices by which points (x, y, z, 1) are multiplied.

        Source: Rodrigues' rotation formula.
        """
        x, y, z = self.axis
        crossed = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        sine, cosine = (one(self.turn)[..., None, None] for one in (np.sin, np.cos))
        made = np.zeros((*np.shape(self.turn), 4, 4))
        made[..., :3, :3] = np.eye(3) + sine * crossed + (1.0 - cosine) * (crossed @ crossed)
        made[..., :3, 3] = self.shift
        made[..., 3, 3] = 1.0
        return made

    def __getitem__(self, index: Any) -> SpacePose:
        """Return some of n poses."""
        return SpacePose(self.axis, np.asarray(self.turn)[index], self.shift[index])

    @property
    def mirrored(self) -> SpacePose:
        """The pose of the mirror image in the plane y = 0."""
        x, y, z = self.axis
        return SpacePose((x, -y, z), -self.turn, self.shift * [1.0, -1.0, 1.0])


UNMOVED: Final = Pose()
"""The pose of a body in its own frame."""
