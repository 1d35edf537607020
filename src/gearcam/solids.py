"""Solids: a part as a closed mesh of triangles, made by manifold3d.

The one place that knows manifold3d. A *mesh* is plain arrays: the library's own objects cannot be
pickled and its interface is moving.

Refused: clockwise contours (the library would silently give nothing), parts whose solid comes out
empty, and meshes that are not closed.

Depends on parts; manifold3d only inside the functions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from gearcam.errors import GearcamError
from gearcam.parts import Mark, Part, circle_points, circle_segments

if TYPE_CHECKING:
    from manifold3d import Manifold

OVERSHOOT: Final = 1.0
"""How far a mark's cutter stands above the face, in depths of the mark: faces must not coincide."""

ROUNDING: Final = 1e-8
"""The library keeps flat outlines on a grid of this step, mm."""


class SolidError(GearcamError, RuntimeError):
    """A solid that should exist came out empty or open."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Mesh:
    """A mesh of triangles, seen counter-clockwise from outside.

    Parameters
    ----------
    vertices : (n, 3) float array, mm
        Each place once.
    triangles : (m, 3) int array
        Indices of vertices.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]

    @cached_property
    def volume(self) -> float:
        """Enclosed volume, mm^3 (divergence theorem, about the mesh's middle)."""
        corners = (self.vertices - self.vertices.mean(axis=0))[self.triangles]
        return float(np.linalg.det(corners).sum()) / 6

    @cached_property
    def watertight(self) -> bool:
        """Whether each edge is met by one triangle in each direction, and no triangle is folded."""
        a, b = self.triangles.ravel(), np.roll(self.triangles, -1, axis=1).ravel()
        if not len(a) or (a == b).any():
            return False
        size = len(self.vertices)
        there, back = np.sort(a * size + b), np.sort(b * size + a)
        return bool((np.diff(there) > 0).all() and (there == back).all())


def solid(part: Part) -> Mesh:
    """Make the mesh of a part: the outline pulled up along z, less bore and marks.

    Parameters
    ----------
    part : Part
        The contour's polygon is used as it is; bore and marks are tessellated within the contour's
        tolerance.

    Returns
    -------
    Mesh

    Raises
    ------
    ValueError
        If the contour runs clockwise.
    SolidError
        If the solid comes out empty or open, or lost a part of its volume.
    """
    import manifold3d

    if not part.contour.area > 0:
        raise ValueError(f"{part.name}: the contour must run counter-clockwise")
    loops = [part.contour.vertices]
    if part.bore_diameter is not None:
        bore = circle_points((0.0, 0.0), part.bore_diameter, part.contour.tolerance)
        loops.append(bore[::-1])
    section = manifold3d.CrossSection([np.ascontiguousarray(loop) for loop in loops])
    body = manifold3d.Manifold.extrude(section, part.width)
    for mark in part.marks:
        body = body - _cutter(manifold3d, mark, part)
    mesh = _mesh(body)
    if not mesh.watertight:
        raise SolidError(f"{part.name}: the solid came out empty or open")
    missed, allowed = abs(mesh.volume - part.volume), volume_error(part)
    if missed > allowed:
        raise SolidError(
            f"{part.name}: the solid's volume is {missed:.3g} mm3 off,"
            f" {allowed:.3g} mm3 is explained"
        )
    return mesh


def _cutter(manifold3d: Any, mark: Mark, part: Part) -> Manifold:
    """Return the cylinder that engraves a mark."""
    segments = circle_segments(mark.diameter, part.contour.tolerance)
    height = (1 + OVERSHOOT) * mark.depth
    cylinder = manifold3d.Manifold.cylinder(height, 0.5 * mark.diameter, -1.0, segments)
    x, y = mark.center
    return cylinder.translate((float(x), float(y), part.width - mark.depth))


def _mesh(body: Manifold) -> Mesh:
    raw = body.to_mesh64()
    vertices = np.array(raw.vert_properties, dtype=np.float64).reshape(
        -1, raw.vert_properties.shape[-1]
    )
    return Mesh(vertices=vertices[:, :3], triangles=np.array(raw.tri_verts, dtype=np.int64))


def volume_error(part: Part) -> float:
    """Bound the difference between a part's mesh and its true shape.

    Parameters
    ----------
    part : Part
        The part.

    Returns
    -------
    float, mm^3
        Chord error and grid times length, for outline and bore over the width and for the marks
        over their depth: every chord lies within its error of the curve, so the area between them
        is at most that.
    """
    steps = np.diff(part.contour.vertices, axis=0, append=part.contour.vertices[:1])
    circles = part.contour.tolerance + ROUNDING
    outline = float(np.hypot(*steps.T).sum()) * (part.contour.chord_error + ROUNDING)
    bore = math.pi * (part.bore_diameter or 0.0) * circles
    marks = sum(math.pi * mark.diameter * mark.depth for mark in part.marks) * circles
    return (outline + bore) * part.width + marks
