"""Small pictures of variants: the parts at the start of their motion, all to one scale.

A picture is a list of paths for SVG with the number of their colour, in pixels, y downwards. Points
closer than half a pixel are merged.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count
from typing import Any, Final

import numpy as np

from gearcam.numeric.arrays import Plane
from gearcam.pictures import drawings
from gearcam.pictures.scenes import SAGITTA, MovingBody, Scene

SIZE: Final = (132, 88)
"""Width and height of the largest picture, pixels."""

PLACES: Final = 12
"""Steps of the driver: only the start is drawn."""

_APART: Final = 0.5
"""Distance of points, pixels."""

_INKS: Final = 3
"""Colours of bodies."""


def pictures(scenes: Mapping[Any, Scene]) -> dict[Any, list[dict[str, Any]]]:
    """Return pictures to one scale.

    Parameters
    ----------
    scenes : mapping of object to Scene
        Scenes of variants, by anything.

    Returns
    -------
    dict
        By the same, lists of ``{"ink": 1, "filled": true, "d": "M..."}``; ``d`` begins at the lower
        left corner of the picture's box.
    """
    shapes = {key: list(_shapes(scene)) for key, scene in scenes.items()}
    boxes = {key: _box([points for _, _, points in one]) for key, one in shapes.items()}
    scale = min((_fit(box) for box in boxes.values()), default=1.0)
    return {
        key: [
            {"ink": ink, "filled": filled, "d": _path(points, filled, boxes[key], scale)}
            for ink, filled, points in one
        ]
        for key, one in shapes.items()
    }


def _shapes(scene: Scene) -> Iterator[tuple[int, bool, list[Plane]]]:
    """Yield colour, whether it is filled, and chains of what is drawn, in place."""
    start = int(np.argmin(np.abs(scene.places - scene.start)))
    inks = count(1)
    for body in scene.bodies:
        ink = 0 if body.name == "frame" else min(next(inks), _INKS)
        filled, lines = _chains(body)
        pose = body.pose[start]
        if filled:
            yield ink, True, [pose.apply(one) for one in filled]
        if lines:
            yield ink, False, [pose.apply(one) for one in lines]


def _chains(body: MovingBody) -> tuple[list[Plane], list[Plane]]:
    """Return the closed chains that bound a body, with its openings, and its plain lines."""
    filled, lines = list[Plane](), list[Plane]()
    for feature in body.features:
        metal = feature.kind in (*drawings.FILLED, *drawings.THROUGH, drawings.OUTER_WALL)
        for points, closed in drawings.chains(feature.shape, SAGITTA):
            if metal and closed:
                filled.append(points)
            elif feature.kind not in drawings.DASHED:
                lines.append(points)
    return filled, lines


def _box(chains: Iterable[Sequence[Plane]]) -> tuple[float, float, float, float]:
    points = np.concatenate([one for shape in chains for one in shape])
    x, y = points.real, points.imag
    return float(x.min()), float(y.min()), float(x.max()), float(y.max())


def _fit(box: tuple[float, float, float, float]) -> float:
    """Return the pixels per mm with which a box fills a picture."""
    left, bottom, right, top = box
    return min(SIZE[0] / max(right - left, 1e-9), SIZE[1] / max(top - bottom, 1e-9))


def _path(
    chains: Sequence[Plane],
    closed: bool,
    box: tuple[float, float, float, float],
    scale: float,
) -> str:
    """Return the path of chains in pixels from the upper left corner of a box."""
    left, _, _, top = box
    return "".join(
        "M"
        + " ".join(f"{x:.1f} {y:.1f}" for x, y in _thinned(one, left, top, scale))
        + "Z" * closed
        for one in chains
    )


def _thinned(points: Plane, left: float, top: float, scale: float) -> Iterator[tuple[float, float]]:
    """Yield the points of a chain in pixels, the first, the last, and those that are apart."""
    pixels = scale * (points.real - left) + 1j * scale * (top - points.imag)
    last = complex("inf")
    for number, one in enumerate(pixels.tolist(), 1):
        if abs(one - last) > _APART or number == len(pixels):
            last = one
            yield one.real, one.imag
