"""The surface of a finished cam as triangles: rings around its axis, joined one to the next.

A *ring* is a closed row of points around the axis, in the order of falling azimuth: one point for
each cam angle, or those of a circle. From the bore up over the upper face, down the outside,
through the groove and back over the lower face, every two neighbours are joined by triangles, so
that the surface is closed by its making and needs no boolean operation.

Rings of the same cam angles are joined point by point. The edge of a wall has its points at other
azimuths than a circle; there the points of both are taken in the order of their azimuths, so that
no triangle is longer around the cam than a step.

The groove's floor: the end of the roller is a disc. It cuts the floor, a cylinder, with its line
nearest to the cam's axis, and with its rim a ramp from the floor to the foot of the wall.

All surfaces are met at their points, so that the volume converges with the square of the step.
Refused: walls that are undercut, whose rings would cross. Depends on cam; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Mask
from gearcam.numeric.mesh import Mesh
from gearcam.spatial.cam import SpatialCam, SpatialWall

_COINCIDENT: Final = 1e-9
"""Size of a cell within which points coincide, over the radius of the cylinder."""

_PIN: Final = 0.5
"""Radius of the pin that is shown, over that of the roller at the outside."""

_STUB: Final = 1.0
"""Its length outside the cam, over the same."""


@dataclass(frozen=True, kw_only=True)
class Cylinder(ShortRepr):
    """What a cam is made from: a cylinder with a bore.

    Parameters
    ----------
    length : float, mm
        From z = 0 upwards.
    bore : float, mm
        Radius of the bore; 0 without one.
    """

    length: float
    bore: float = 0.0


def surface(cam: SpatialCam, blank: Cylinder, steps: int, places: int) -> Mesh:
    """Return the surface of a cam, as if it turned counter-clockwise.

    Parameters
    ----------
    cam : SpatialCam
        The cam; its walls must not be undercut.
    blank : Cylinder
        What it is made from.
    steps : int
        Number of even cam angles.
    places : int
        Number of places along the roller on each wall.

    Returns
    -------
    Mesh
    """
    theta = np.linspace(0.0, 2.0 * math.pi, steps, endpoint=False)
    return _closed(list(_rings(cam, blank, theta, places)), cam.outer_radius)


def blank_surface(cam: SpatialCam, blank: Cylinder, steps: int) -> Mesh:
    """Return the surface of what a cam is made from.

    Parameters
    ----------
    cam, blank, steps
        As of `surface`.

    Returns
    -------
    Mesh
    """
    outer, length = cam.outer_radius, blank.length
    corners = (blank.bore, 0.0), (blank.bore, length), (outer, length), (outer, 0.0)
    return revolved(corners, steps)


def roller_surface(cam: SpatialCam, steps: int) -> Mesh:
    """Return the surface of the roller of a cam with the beginning of its pin outside the cam.

    Parameters
    ----------
    cam : SpatialCam
        The cam.
    steps : int
        Number of chords around it.

    Returns
    -------
    Mesh
        In the frame of the roller: its axis is +x.
    """
    inside, outside = cam.inner, cam.outer_radius
    thin, thick = (cam.roller.radius_at(x) for x in (inside, outside))
    pin, end = _PIN * thick, outside + _STUB * thick
    profile = [(0.0, end), (pin, end), (pin, outside), (thick, outside), (thin, inside)]
    made = revolved((*profile, (0.0, inside)), steps)
    return Mesh(vertices=np.roll(made.vertices, 1, axis=1), triangles=made.triangles)


def revolved(corners: Iterable[tuple[float, float]], steps: int) -> Mesh:
    """Return the surface of a body of revolution about z.

    Parameters
    ----------
    corners : iterable of (float, float), mm
        Radii and heights of its outline: up inside, then down outside.
    steps : int
        Number of chords around it.

    Returns
    -------
    Mesh
    """
    theta = np.linspace(0.0, 2.0 * math.pi, steps, endpoint=False)
    outline = [*corners]
    size = max(abs(value) for corner in outline for value in corner)
    return _closed([_circle(theta, *one) for one in outline], size)


def _closed(rings: Sequence[_Ring], size: float) -> Mesh:
    """Return the surface through rings, each joined to the next, the last to the first.

    `size` is the radius of the cylinder, mm.
    """
    sizes = [len(ring.points) for ring in rings]
    starts = np.cumsum([0, *sizes[:-1]])
    faces = []
    for k, ring in enumerate(rings):
        after = (k + 1) % len(rings)
        joined = _joined(ring, rings[after])  # points of the second ring follow those of the first
        faces.append(joined + np.where(joined < sizes[k], starts[k], starts[after] - sizes[k]))
    return welded(np.concatenate([ring.points for ring in rings]), np.concatenate(faces), size)


def welded(vertices: Array, triangles: Ints, size: float) -> Mesh:
    """Return a mesh in which points that coincide are one, such as those of a ramp in a dwell.

    Parameters
    ----------
    vertices : (n, 3) array, mm
        Points.
    triangles : (m, 3) array of int
        Indices of points; triangles of which two corners coincide are left out.
    size : float, mm
        Size of the body.
    """
    cells = np.round(vertices / (_COINCIDENT * size)).astype(np.int64)
    _, kept, index = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    return Mesh(vertices=vertices, triangles=triangles).joined(index.ravel(), vertices[kept])


def chord_error(cam: SpatialCam, steps: int, places: int) -> float:
    """Return the largest distance of the walls from the triangles of their surface, mm.

    Measured at the middles of all edges; of the two diagonals of a cell the worse one counts.

    Parameters
    ----------
    cam, steps, places
        As of `surface`.
    """
    theta = np.linspace(0.0, 2.0 * math.pi, 2 * steps, endpoint=False)
    worst = 0.0
    for wall in cam.walls:
        fine = wall.grid(theta, 2 * places - 1)
        points, normals = (np.concatenate([one, one[:1]]) for one in (fine.points, fine.normals))
        worst = max(worst, float(distances(points, normals).max()))
    return worst


def distances(points: Array, normals: Array) -> Array:
    """Return how far a wall is from triangles through every second of its points, (n, k), mm.

    At a point in the middle of an edge its distance from this edge; of two diagonals from the one
    that is farther. 0 at corners of triangles.

    Parameters
    ----------
    points, normals : (n, k, 3) arrays, mm and 1
        Points of the wall as a grid with odd numbers of rows and columns, and its normals there.
    """
    found = np.zeros(points.shape[:2])
    here, after = points[:-2:2], points[2::2]
    one, other = here[:, :-2:2], here[:, 2::2]
    beyond, ahead = after[:, 2::2], after[:, :-2:2]
    for middle, rows, columns in (
        (0.5 * (here[:, ::2] + after[:, ::2]), 1, 0),
        (0.5 * (points[::2, :-2:2] + points[::2, 2::2]), 0, 1),
        (0.5 * (one + beyond), 1, 1),
        (0.5 * (other + ahead), 1, 1),
    ):
        at = np.s_[rows::2, columns::2]
        off = np.abs(((middle - points[at]) * normals[at]).sum(axis=-1))
        found[at] = np.maximum(found[at], off)
    return found


@dataclass(frozen=True, eq=False)
class _Ring:
    """Points around the axis; `apart`: at azimuths other than those of the ring that follows."""

    points: Array
    apart: bool = False


def _rings(cam: SpatialCam, blank: Cylinder, theta: Array, places: int) -> Iterator[_Ring]:
    """Yield the rings from the bore over the upper face and the walls to the lower face."""
    walls, outer = {wall.side: wall for wall in cam.walls}, cam.outer_radius
    yield _circle(theta, blank.bore, 0.0)
    yield _circle(theta, blank.bore, blank.length)
    if cam.apart:  # a rib on a core: the wall of the upper roller is the upper one
        yield _circle(theta, cam.floor, blank.length)
        yield from _out(walls[-1], theta, places)
        yield from _in(walls[1], theta, places)
        yield _circle(theta, cam.floor, 0.0)
        return
    if 1 in walls:
        yield _Ring(_circle(theta, outer, blank.length).points, apart=True)
        yield from _in(walls[1], theta, places)
    else:
        yield _circle(theta, cam.floor, blank.length)
    if -1 in walls:
        yield from _out(walls[-1], theta, places)
        yield _circle(theta, outer, 0.0)
    else:
        yield _circle(theta, cam.floor, 0.0)


def _circle(theta: Array, radius: float, height: float) -> _Ring:
    """Return a circle, or its centre alone."""
    if not radius:
        return _Ring(np.array([[0.0, 0.0, height]]))
    heights = np.full_like(theta, height)
    return _Ring(np.stack([radius * np.cos(theta), -radius * np.sin(theta), heights], axis=1))


def _in(wall: SpatialWall, theta: Array, places: int) -> list[_Ring]:
    """Return the rings of a wall from its edge to its foot, and of its ramp down to the floor."""
    below = ramp(wall, theta, places)[:, :-1]  # without the foot, which the wall has too
    points = np.concatenate([below, wall.grid(theta, places).points], axis=1)
    return [_Ring(points[:, k]) for k in reversed(range(points.shape[1]))]


def _out(wall: SpatialWall, theta: Array, places: int) -> list[_Ring]:
    """Return the same rings from the floor to the edge, beside which others are not in line."""
    edge, *others = _in(wall, theta, places)
    return [*reversed(others), _Ring(edge.points, apart=True)]


def ramp(wall: SpatialWall, theta: Array, places: int) -> Array:
    """Return the ramp below the foot of a wall as a grid, from the floor to the foot.

    Parameters
    ----------
    wall : SpatialWall
        The wall.
    theta : (n,) array, rad
        Cam angles.
    places : int
        Number of places around the end of the roller; even angles.

    Returns
    -------
    (n, places, 3) array, mm
    """
    center, radius, across, first, turned = _rim(wall, theta)
    angle = (first[:, None] + turned[:, None] * np.linspace(0.0, 1.0, places))[..., None]
    up = np.array([0.0, 0.0, float(wall.side)])
    rim = np.sin(angle) * across[:, None, :] + np.cos(angle) * up
    return center[:, None, :] + radius[:, None, None] * rim


def ramp_width(wall: SpatialWall, theta: Array) -> Array:
    """Return the lengths of arc, mm, of a ramp from the floor to the foot; signed.

    Parameters
    ----------
    wall : SpatialWall
        The wall.
    theta : (n,) array, rad
        Cam angles.
    """
    _, radius, _, _, turned = _rim(wall, theta)
    return radius * turned


def _rim(wall: SpatialWall, theta: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Return the end of the roller: centre, radius, the direction along the floor, and angles.

    The angles, rad: of the place nearest to the cam's axis from the direction of the cam's axis,
    and from there to the foot of the wall.
    """
    foot = wall.contact(theta, np.full((len(theta), 1), wall.cam.floor))
    center, radius = foot.centers[:, 0], foot.radius[:, 0]
    # directions in the end of the roller: across the plane of both axes, and along the cam
    along = np.array([0.0, 0.0, 1.0])
    across = np.cross(along, foot.axis.direction[0])
    towards = foot.radial[:, 0]
    final = np.arctan2((towards * across).sum(axis=1), wall.side * (towards @ along))
    first = -np.arcsin((center * across).sum(axis=1) / radius)
    return center, radius, across, first, final - first


def _joined(ring: _Ring, other: _Ring) -> Ints:
    """Return triangles between two rings; points of the second are counted after the first."""
    count, more = len(ring.points), len(other.points)
    here, there = np.arange(count), count + np.arange(more)
    if count == 1 or more == 1:
        several, apex = (there, here) if count == 1 else (here[::-1], there)
        if count == more:
            return np.empty((0, 3), dtype=np.int64)
        return np.stack([np.repeat(apex, len(several)), np.roll(several, -1), several], axis=1)
    if ring.apart:
        return _zipped(_turns(ring), _turns(other))
    after, beyond = np.roll(here, -1), np.roll(there, -1)
    corners = [here, after, there], [after, beyond, there]
    return np.concatenate([np.stack(one, axis=1) for one in corners])


def _turns(ring: _Ring) -> Array:
    """Return the azimuths of a ring's points, falling, as shares of a turn in [0, 1)."""
    x, y = ring.points[:, 0], ring.points[:, 1]
    return np.mod(np.arctan2(-y, x) / (2.0 * math.pi), 1.0)


def _zipped(ring: Array, other: Array) -> Ints:
    """Return triangles between two rings at azimuths of their own, in the order of these."""
    count = len(ring)
    places = np.concatenate([ring, other])
    order = np.argsort(places, kind="stable")
    first = order < count
    # the last point of each ring that has been reached; at first the last of all
    step = np.arange(len(order))
    here, there = (_latest(order, which, step) for which in (first, ~first))
    before = order[np.where(first, _previous(first), _previous(~first))]
    return np.where(
        first[:, None],
        np.stack([before, order, there], axis=1),
        np.stack([here, order, before], axis=1),
    )


def _latest(order: Ints, which: Mask, step: Ints) -> Ints:
    """Return the latest point of one ring at each step; before its first point its last."""
    last = np.maximum.accumulate(np.where(which, step, -1))
    return order[np.where(last < 0, np.flatnonzero(which)[-1], last)]


def _previous(which: Mask) -> Ints:
    """Return the step of the point before of the same ring, around."""
    places = np.flatnonzero(which)
    found = np.zeros(len(which), dtype=np.int64)
    found[places] = np.roll(places, 1)
    return found
