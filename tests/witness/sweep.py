"""The boolean sweep: a rack's tooth at many positions, subtracted from the blank.

The rack rolls on the wheel's centrode in equal steps of arc length, as many per turn as asked for.
A rack's flank is straight, so between two positions a ridge remains whose height grows with the
square of the step: the swept flank is too full by an error that falls as 1/N^2, and never too thin.
Only the neighbourhood of one tooth space is swept.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from witness.distance import distances
from witness.kinematics import Basic, Frames, Rolling

Array = NDArray[np.floating[Any]]
Region = Any
"""A shapely geometry; the stubs cannot tell one from an array of them."""
REACH = 4.6
"""How far from a space, in modules, its cutter tooth still touches it."""


def rack_tooth(basic: Basic, arc_points: int) -> Array:
    """One cutter tooth, (n, 2) in mm: x along the pitch line from its middle, y outward."""
    m, alpha = basic.module, basic.alpha
    depth = basic.dedendum - basic.tip_radius
    half = np.pi / 4
    centre = half - depth * np.tan(alpha) - basic.tip_radius / np.cos(alpha)
    if centre < 0:
        raise ValueError("the tip arcs of the rack overlap")
    # the right half, from the middle of the land up to well above the tips
    turn = np.linspace(-np.pi / 2, -alpha, arc_points)
    arc_x = centre + basic.tip_radius * np.cos(turn)
    arc_y = -depth + basic.tip_radius * np.sin(turn)
    top = basic.addendum + 0.6
    x = np.concatenate([arc_x, [half + top * np.tan(alpha)]])
    y = np.concatenate([arc_y, [top]])
    right = np.stack([x, y], axis=-1)
    left = right[::-1] * [-1, 1]
    return m * np.concatenate([left, right])


def positions(length: float, middle: float, reach: float, steps: int) -> Array:
    """Rolling positions near a place: those of a grid with `steps` to the turn."""
    step = length / steps
    first, last = np.ceil((middle - reach) / step), np.floor((middle + reach) / step)
    return step * np.arange(first, last + 1)


def cut_space(
    rolling: Rolling, wheel: int, k: int, basic: Basic, steps: int, *, arc_points: int = 800
) -> Region:
    """What the rack's tooth takes out of the plane around the space that follows tooth k."""
    middle = basic.space(wheel, k)
    s = positions(rolling.length, middle, REACH * basic.module, steps)
    return cut_at(rolling.frames(wheel, s), middle - s, rack_tooth(basic, arc_points))


def cut_at(at: Frames, ahead: Array, tooth: Array) -> Region:
    """The union of one tooth at positions: their frames, and how far ahead its middle is."""
    along = ahead[:, None] + tooth[None, :, 0]
    rings = (
        at.point[:, None]
        + along[..., None] * at.tangent[:, None]
        + tooth[None, :, 1, None] * at.normal[:, None]
    )
    return shapely.union_all(shapely.polygons(rings))


def whole_wheel(
    rolling: Rolling, wheel: int, teeth: int, basic: Basic, steps: int, arc_points: int
) -> Region:
    """The whole wheel: one union of all cutter teeth at all positions, one difference."""
    s = rolling.length / steps * np.arange(steps)
    at = rolling.frames(wheel, s)
    middles = np.array([basic.space(wheel, k) for k in range(1, teeth + 1)])
    ahead = middles[:, None] - s
    ahead -= rolling.length * np.round(ahead / rolling.length)
    tooth_number, position = np.nonzero(np.abs(ahead) <= REACH * basic.module)
    near = Frames(at.point[position], at.tangent[position], at.normal[position])
    cut = cut_at(near, ahead[tooth_number, position], rack_tooth(basic, arc_points))
    edge = rolling.frames(wheel, rolling.length / (1000 * teeth) * np.arange(1000 * teeth))
    disc = shapely.polygons(edge.point + basic.addendum * basic.module * edge.normal)
    return shapely.difference(disc, cut)


def blank(
    rolling: Rolling,
    wheel: int,
    k: int,
    basic: Basic,
    height: float | None = None,
    depth: float | None = None,
) -> Region:
    """The strip of the blank around a space: up to the tip curve, down to below the root.

    `height` and `depth` in modules replace these. Convex centrodes only: there the parallel of the
    centrode is its offset. (Concave: `height` must stay below the radius of curvature.)
    """
    m = basic.module
    middle = basic.space(wheel, k)
    s = np.linspace(middle - 0.5 * np.pi * m, middle + 0.5 * np.pi * m, 4001)
    at = rolling.frames(wheel, s)
    top = basic.addendum if height is None else height
    outer = at.point + top * m * at.normal
    bottom = basic.dedendum + 0.5 if depth is None else depth
    inner = at.point - bottom * m * at.normal
    return shapely.polygons(np.concatenate([outer, inner[::-1]]))


def swept(rolling: Rolling, wheel: int, k: int, basic: Basic, steps: int) -> Region:
    """The wheel's material around one space, after the sweep."""
    return shapely.difference(
        blank(rolling, wheel, k, basic), cut_space(rolling, wheel, k, basic, steps)
    )


def inside(points: Array, rolling: Rolling, wheel: int, k: int, basic: Basic) -> Array:
    """Those of the points in the space that follows tooth k, half a tooth on either side."""
    strip = blank(rolling, wheel, k, basic, 1.5)
    return points[shapely.contains_xy(strip, points)]


def farthest(points: Array, region: Region) -> float:
    """Largest distance of points from the boundary of a region, mm."""
    return float(distances(points, shapely.boundary(region)).max())
