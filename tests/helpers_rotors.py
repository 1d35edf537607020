"""Masses of cams and wheels as points in space, from the polygons of their parts alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from shapely import Polygon

Path = Callable[[Any], Any]
"""``path(q)``: complex places in the machine, mm, at angles of the master, rad."""

STEP = 1e-3
"""Step of differences, rad."""


class Point(NamedTuple):
    """A mass, kg, that moves in a plane across the axis at z, mm; holes have negative ones."""

    mass: float
    path: Path
    z: float


def prisms(part: Any, density: float) -> list[tuple[float, complex, float]]:
    """Mass, centroid and middle height of each prism of a part."""
    found = []
    for sign, layers in ((1.0, part.layers), (-1.0, part.pockets)):
        for layer in layers:
            holes = [chords(one.shape) for one in layer.openings]
            region = Polygon(chords(layer.edge), holes)
            mass = sign * 1e-9 * density * region.area * (layer.high - layer.low)
            center = complex(region.centroid.x, region.centroid.y)
            found.append((mass, center, 0.5 * (layer.low + layer.high)))
    return found


def chords(edge: Any) -> Any:
    points = edge.polyline(1e-4)
    return np.stack([points.real, points.imag], axis=1)


def shaft_frame(placed: dict[str, Any], turn: Callable[[Any], Any]) -> Callable[[complex], Path]:
    """What a point of a wheel in the origin of a drive's frame does, which turns by `turn`(q)."""
    at = complex(*placed.get("at_mm", (0.0, 0.0)))
    around = np.exp(1j * np.radians(placed.get("turn_deg", 0.0)))

    def path(point: complex) -> Path:
        def where(q: Any) -> Any:
            own = point * np.exp(1j * turn(q))
            return at + around * (np.conj(own) if placed.get("mirror") else own)

        return where

    return path


def acceleration(path: Path, q: Any, speed: float) -> Any:
    """Of a place by differences of fourth order, mm/s2."""
    far, near = (path(q + k * STEP) + path(q - k * STEP) for k in (2, 1))
    return speed**2 * (16.0 * near - far - 30.0 * path(q)) / (12.0 * STEP**2)


def shaken(points: list[Point], q: Any, speed: float, about: Any = (0.0, 0.0, 0.0)) -> Any:
    """Force, N, and moment, N mm, of inertia on the frame about a point: (n, 6)."""
    whole = np.zeros((len(q), 6))
    for mass, path, z in points:
        place, pull = path(q), -1e-3 * mass * acceleration(path, q, speed)
        force = np.stack([pull.real, pull.imag, 0.0 * q], axis=1)
        arm = np.stack([place.real, place.imag, z + 0.0 * q], axis=1) - np.asarray(about)
        whole += np.concatenate([force, np.cross(arm, force)], axis=1)
    return whole
