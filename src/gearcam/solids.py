"""Solids: a part as a closed mesh of triangles, made by manifold3d.

The one place that knows manifold3d. A *mesh* is plain arrays: the library's own objects cannot be
pickled and its interface is moving.

Refused: parts whose solid comes out empty, open, or without a part of its volume. (The library
silently makes nothing of clockwise contours; parts refuse them.)

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
from gearcam.numerals import shown
from gearcam.parts.part import Mark, Part
from gearcam.parts.shapes import circle_points, circle_segments

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

    def placed(self, angle: float, offset: tuple[float, float]) -> Mesh:
        """Return the mesh turned about z by `angle`, rad, then shifted by `offset` (2,), mm."""
        cosine, sine = math.cos(angle), math.sin(angle)
        x, y, z = self.vertices.T
        moved = [cosine * x - sine * y + offset[0], sine * x + cosine * y + offset[1], z]
        return Mesh(vertices=np.stack(moved, axis=1), triangles=self.triangles)

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
    """Make the mesh of a part: outlines pulled up along z, with hubs, less openings and marks.

    Parameters
    ----------
    part : Part
        The contours' polygons are used as they are; openings, hubs and marks are tessellated within
        the contours' tolerance.

    Returns
    -------
    Mesh

    Raises
    ------
    SolidError
        If the solid comes out empty or open, or lost a part of its volume.
    """
    import manifold3d

    holes = [opening.shape.points(part.tolerance)[::-1] for opening in part.openings]
    slabs = [
        _slab(manifold3d, [contour.vertices, *holes], low, high)
        for contour, low, high in part.plates
    ]
    if part.hub is not None:
        disc = circle_points((0.0, 0.0), part.hub.diameter, part.tolerance)
        bores = [opening.shape.points(part.tolerance)[::-1] for opening in part.in_hub]
        slabs += [_slab(manifold3d, [disc, *bores], low, high) for low, high in part.bosses]
    body = (
        slabs[0]
        if len(slabs) == 1
        else manifold3d.Manifold.batch_boolean(slabs, manifold3d.OpType.Add)
    )
    for mark in part.marks:
        body = body - _cutter(manifold3d, mark, part)
    mesh = _mesh(body)
    if not mesh.watertight:
        raise SolidError(f"{part.name}: the solid came out empty or open")
    missed, allowed = abs(mesh.volume - part.volume), volume_error(part)
    if missed > allowed:
        raise SolidError(
            f"{part.name}: the solid's volume is {shown(missed, 3)} mm3 off,"
            f" {shown(allowed, 3)} mm3 is explained"
        )
    return mesh


def _slab(manifold3d: Any, loops: list[NDArray[np.float64]], low: float, high: float) -> Manifold:
    """Return a plate between two heights: the first loop less the others, which run clockwise."""
    section = manifold3d.CrossSection([np.ascontiguousarray(loop) for loop in loops])
    return manifold3d.Manifold.extrude(section, high - low).translate((0.0, 0.0, low))


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
        Chord error and grid times length, for outlines and openings over their heights, hubs and
        marks: every chord lies within its error of the curve, so the area between them is at most
        that.
    """
    rounds = sum(opening.shape.length for opening in part.openings) * part.thickness
    rounds += sum(mark.circle.length * mark.depth for mark in part.marks)
    if part.hub is not None:
        rounds += math.pi * part.hub.diameter * (part.hub.front + part.hub.back)
    total = rounds * (part.tolerance + ROUNDING)
    for contour, low, high in part.plates:
        steps = np.diff(contour.vertices, axis=0, append=contour.vertices[:1])
        length = float(np.hypot(*steps.T).sum())
        total += length * (contour.chord_error + ROUNDING) * (high - low)
    return total
