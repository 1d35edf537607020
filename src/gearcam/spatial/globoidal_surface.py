"""The surfaces of a globoidal cam and its turret as triangles.

The rib is a closed strip: a grid of each wall, and two sheets from wall to wall, one in the core
and one beyond the tops; at both ends a sheet that is beyond the faces. Core and blank are bodies of
revolution. The finished cam is what is in the blank and in either of core and rib.

Between the walls points are given by the distance from the turret's axis and the direction from it
in planes through the cam's axis, and by the azimuth, so that sheets keep this distance.

Depends on globoidal and surface; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

import numpy as np

from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.mesh import Mesh
from gearcam.spatial.globoidal import GloboidalCam
from gearcam.spatial.surface import distances, revolved, welded

_BEYOND: Final = 0.05
"""How far the rib goes on beyond top and floor, over the radius of a roller."""

MARGIN: Final = 0.02
"""What a body has more that is cut by rollers, over the difference of top and half the length."""

_SAG: Final = 0.25
"""Largest chord error of sheets from wall to wall, over how far the rib goes on there."""

_SECTORS: Final = 45
"""Sectors of a turn of which arcs about the turret's axis have a whole number."""

_LONGER: Final = 0.1
"""How far the core goes on beyond the faces, over what the floor exceeds half the length by."""

_HUB: Final = 0.9
"""Radius in the turret's body at which shown rollers begin, over that of the body."""

_BODY: Final = 1.2
"""Half the thickness of the turret's body that is shown, over the radius of a roller."""


def rib_surface(cam: GloboidalCam, steps: int, places: int) -> Mesh:
    """Return the surface of the rib, a little beyond faces, top and floor.

    Parameters
    ----------
    cam : GloboidalCam
        The cam; its walls must not be undercut.
    steps : int
        Number of even cam angles in a turn.
    places : int
        Number of places along the roller on each wall.

    Returns
    -------
    Mesh
    """
    theta, beyond = rib_angles(cam, steps), _BEYOND * cam.roller.radius
    # the rib is above the roller that is followed, and below the next one
    low, high = (
        polar(cam, wall.grid(theta + TURN * k, places, beyond).points, theta)
        for k, wall in enumerate(cam.walls)
    )
    high[..., 1] = low[..., 1] + np.mod(high[..., 1] - low[..., 1], TURN)
    share = np.linspace(0.0, 1.0, 1 + _strips(cam))[:, None]

    def between(rows: slice, columns: slice) -> Array:
        """Return points from the upper wall of one roller to the lower one of the next."""
        one, other = low[rows, columns, None], high[rows, columns, None]
        return _points(cam, one + share * (other - one), theta[rows])

    every, first, last = slice(None), slice(0, 1), slice(-1, None)
    sheets = [
        (_points(cam, low[:, :, None], theta)[:, :, 0], True),
        (_points(cam, high[:, :, None], theta)[:, :, 0], False),
        (between(every, first)[:, 0], False),
        (between(every, last)[:, 0], True),
        (between(first, every)[0], True),
        (between(last, every)[0], False),
    ]
    return welded(*_together(sheets), cam.distance)


def _strips(cam: GloboidalCam) -> int:
    """Return the number of strips of a sheet of the rib from wall to wall."""
    step = 2.0 * math.acos(1.0 - _SAG * _BEYOND * cam.roller.radius / cam.floor)
    return math.ceil(cam.pitch / step)


def rib_angles(cam: GloboidalCam, steps: int) -> Array:
    """Return the cam angles of the rib, rad: even ones, and the knots of the motion.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    steps : int
        Number of even cam angles in a turn.
    """
    start, end = cam.span
    step = TURN / steps
    even: Array = step * np.arange(math.floor(start / step), math.ceil(end / step) + 1.0)
    turns = TURN * np.arange(math.floor(start / TURN), math.ceil(end / TURN))
    knots = (turns[:, None] + cam.program.knots[1:-1]).ravel()
    near = np.abs(knots / step - np.round(knots / step)) < 1e-6  # a step would be too narrow
    within = (knots > even[0]) & (knots < even[-1])
    return np.sort(np.concatenate([even, knots[within & ~near]]))


def core_surface(cam: GloboidalCam, steps: int) -> Mesh:
    """Return the surface of the core without a bore, a little longer than the cam.

    Parameters
    ----------
    cam, steps
        As of `rib_surface`.

    Returns
    -------
    Mesh
    """
    longer = cam.half_length + _LONGER * (cam.floor - cam.half_length)
    outside = _arc(cam, cam.floor, longer, steps)
    return revolved([(0.0, -longer), (0.0, longer), *outside], steps)


def blank_surface(cam: GloboidalCam, bore: float, steps: int, margin: float = 0.0) -> Mesh:
    """Return the surface of what the cam is made from: a globoid with a bore.

    Parameters
    ----------
    cam, steps
        As of `rib_surface`.
    bore : float, mm
        Radius of the bore.
    margin : float, mm
        What it has more at both faces and outside.

    Returns
    -------
    Mesh
    """
    half = cam.half_length + margin
    outside = _arc(cam, cam.top - margin, half, steps)
    return revolved([(bore, -half), (bore, half), *outside], steps)


def outer_radius(cam: GloboidalCam) -> float:
    """Return the largest radius of a cam, mm: that of its faces."""
    return cam.distance - math.sqrt(cam.top**2 - cam.half_length**2)


def chord_error(cam: GloboidalCam, steps: int, places: int) -> float:
    """Return the largest distance of the walls from the triangles of the rib, mm.

    Parameters
    ----------
    cam, steps, places
        As of `rib_surface`.
    """
    rows, beyond = rib_angles(cam, steps), _BEYOND * cam.roller.radius
    theta = np.empty(2 * len(rows) - 1)
    theta[::2], theta[1::2] = rows, 0.5 * (rows[:-1] + rows[1:])
    worst = 0.0
    for k, wall in enumerate(cam.walls):
        fine = wall.grid(theta + TURN * k, 2 * places - 1, beyond)
        off = distances(fine.points, fine.normals)
        worst = max(worst, float(off[cam.inside(fine.points)].max()))
    return worst


def turret_surface(cam: GloboidalCam, hub: float, steps: int) -> Mesh:
    """Return the surfaces of the turret: its body, a disc, and its rollers.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    hub : float, mm
        Radius of the body.
    steps : int
        Number of chords around a roller.

    Returns
    -------
    Mesh
        In the frame of a roller: its axis is +x, that of the turret y.
    """
    radius = cam.roller.radius
    start, half = _HUB * hub, _BODY * radius
    corners = [(0.0, -half), (0.0, half), (hub, half), (hub, -half)]
    body = revolved(corners, max(steps, 4 * cam.stops))
    parts = [body.vertices[:, [1, 2, 0]]]
    faces = [body.triangles]
    one = revolved([(0.0, start), (0.0, cam.reach), (radius, cam.reach), (radius, start)], steps)
    x, y, z = one.vertices[:, [2, 0, 1]].T
    for k in range(cam.stops):
        c, s = math.cos(k * cam.pitch), math.sin(k * cam.pitch)
        faces.append(one.triangles + sum(map(len, parts)))
        parts.append(np.stack([c * x + s * z, y, c * z - s * x], axis=1))
    return Mesh(vertices=np.concatenate(parts), triangles=np.concatenate(faces))


def _arc(cam: GloboidalCam, radius: float, half: float, steps: int) -> list[tuple[float, float]]:
    """Return an arc about the turret's axis from the upper to the lower height, as corners."""
    last = math.asin(half / radius)
    angle = np.linspace(last, -last, 1 + _chords(2.0 * last, steps))
    return [(cam.distance - radius * math.cos(a), radius * math.sin(a)) for a in angle.tolist()]


def _chords(angle: float, steps: int) -> int:
    """Return the number of chords of an arc about the turret's axis.

    It is in proportion to the steps, so that the error of the volume falls with their square.
    """
    return math.ceil(angle * _SECTORS / TURN) * math.ceil(steps / _SECTORS)


def facets(cam: GloboidalCam, steps: int, places: int) -> int:
    """Return about how many triangles the rib, the core and the blank have together.

    Parameters
    ----------
    cam, steps, places
        As of `rib_surface`.
    """
    share = (cam.span[1] - cam.span[0]) / TURN
    rib = 2.0 * steps * share * 2 * (places + _strips(cam))
    bodies = [2 * steps * _chords(2.0 * math.asin(cam.half_length / cam.top), steps)] * 2
    return int(rib) + sum(bodies)


def polar(cam: GloboidalCam, points: Array, theta: Array) -> Array:
    """Return distance and direction from the turret's axis, mm and rad, and azimuth at rest.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    points : (n, k, 3) array, mm
        Points in the frame of the cam.
    theta : (n,) array, rad
        Cam angles: the azimuth, rad, is that in the fixed frame.

    Returns
    -------
    (n, k, 3) array
    """
    x, y, z = np.moveaxis(points, -1, 0)
    turn = theta[:, None]
    azimuth = np.arctan2(x * np.sin(turn) + y * np.cos(turn), x * np.cos(turn) - y * np.sin(turn))
    aside = cam.distance - np.hypot(x, y)
    return np.stack([np.hypot(aside, z), np.arctan2(z, aside), azimuth], axis=-1)


def _points(cam: GloboidalCam, polar: Array, theta: Array) -> Array:
    """Return the points of `polar` in the frame of the cam; theta of the first axis."""
    depth, direction, azimuth = np.moveaxis(polar, -1, 0)
    radius = cam.distance - depth * np.cos(direction)
    at = azimuth - theta[:, None, None]
    return np.stack([radius * np.cos(at), radius * np.sin(at), depth * np.sin(direction)], axis=-1)


def _together(sheets: Iterable[tuple[Array, bool]]) -> tuple[Array, Ints]:
    """Return points and triangles of grids; those of some turned over."""
    points, faces, count = [], [], 0
    for grid, over in sheets:
        rows, columns = grid.shape[:2]
        index = count + np.arange(rows * columns).reshape(rows, columns)
        a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
        cells = [np.stack(one, axis=-1).reshape(-1, 3) for one in ((a, b, d), (b, c, d))]
        faces += [one[:, ::-1] if over else one for one in cells]
        points.append(grid.reshape(-1, 3))
        count += rows * columns
    return np.concatenate(points), np.concatenate(faces)
