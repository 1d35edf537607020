"""Closed surfaces as meshes of triangles: volume, place, and whether they are closed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.pose import SpacePose


@dataclass(frozen=True, eq=False, kw_only=True)
class Mesh:
    """A mesh of triangles, counter-clockwise seen from outside.

    Parameters
    ----------
    vertices : (n, 3) float array, mm
        Each point once.
    triangles : (m, 3) int array
        Indices of vertices.
    """

    vertices: Array
    triangles: Ints

    @cached_property
    def volume(self) -> float:
        """Enclosed volume, mm^3, summed over triangles down to the mesh's middle."""
        x, y, z = (self.vertices - self.vertices.mean(axis=0)).T
        a, b, c = self.triangles.T
        twice = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])
        return float((twice * (z[a] + z[b] + z[c])).sum()) / 6

    def placed(self, pose: SpacePose) -> Mesh:
        """Return the mesh in its place."""
        matrix = pose.matrix
        moved = self.vertices @ matrix[:3, :3].T + matrix[:3, 3]
        return Mesh(vertices=moved, triangles=self.triangles)

    @property
    def mirrored(self) -> Mesh:
        """The mirror image of the mesh in the plane y = 0."""
        return Mesh(vertices=self.vertices * [1.0, -1.0, 1.0], triangles=self.triangles[:, ::-1])

    def joined(self, index: Ints, vertices: Array) -> Mesh:
        """Return the mesh with points joined; without triangles of which two corners coincide.

        Parameters
        ----------
        index : (n,) int array
            New index of each vertex.
        vertices : (k, 3) array, mm
            The new vertices.
        """
        triangles = index[self.triangles]
        a, b, c = triangles.T
        return Mesh(vertices=vertices, triangles=triangles[(a != b) & (b != c) & (c != a)])

    @cached_property
    def watertight(self) -> bool:
        """Whether each edge has one triangle in each direction, and no triangle is folded."""
        a, b = self.triangles.ravel(), np.roll(self.triangles, -1, axis=1).ravel()
        if not len(a) or (a == b).any():
            return False
        size = len(self.vertices)
        there, back = np.sort(a * size + b), np.sort(b * size + a)
        return bool((np.diff(there) > 0).all() and (there == back).all())
