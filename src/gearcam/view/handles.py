"""Handles: the points of the picture that numbers of a design file move, and how far they do.

A *handle* is a point of a body (see `gearcam.pictures.scenes.handles_of`) at one place of the
driver. The page drags it: it changes numbers by the derivatives of the handle's position, and
corrects them by where drafts show it. The derivatives are differences of built designs, so that
each kind of design whose scene has such points has handles.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from gearcam.base.errors import GearcamError
from gearcam.pictures.scenes import Scene, handles_of
from gearcam.view.numbers import Values, equals, tidy

_NEAR: Final = 1e-3
"""Change of a position, relative to the largest by another number, below which it does not move:
the scene of a draft is interpolated."""

_ROUNDING: Final = 1e-9
"""Change of a position below which no number moves it, mm."""

Spot = tuple[int, str]
"""A handle: index of its body among those of the scene, and its name there, or nothing."""


def spots(scene: Scene, place: float) -> dict[Spot, complex]:
    """Return the handles of a scene and where they are.

    Parameters
    ----------
    scene : Scene
        The scene.
    place : float
        Place of the driver, in the unit of the scene.

    Returns
    -------
    dict of (int, str) to complex, mm
        In the fixed frame.
    """
    found: dict[Spot, complex] = {}
    for index, body in enumerate(scene.bodies):
        turn, x, y = (
            float(np.interp(place, scene.places, np.broadcast_to(one, scene.places.shape)))
            for one in (body.pose.turn, np.real(body.pose.shift), np.imag(body.pose.shift))
        )
        for name, at in handles_of(body).items():
            found[index, name] = complex(x, y) + np.exp(1j * turn) * at
    return found


def handles(
    drawn: Callable[[Values], Scene | None],
    values: Values,
    changes: Values,
    steps: Mapping[str, float],
    place: float,
) -> list[dict[str, Any]]:
    """Return the handles that numbers move.

    Parameters
    ----------
    drawn : callable
        ``drawn(changes)`` returns the scene of the design with changed numbers.
    values : mapping of str to float
        Numbers of the file.
    changes : mapping of str to float
        Changes that the page shows.
    steps : mapping of str to float
        Small changes of the numbers that may move, by key.
    place : float
        Place of the driver, in the unit of the scene.

    Returns
    -------
    list of dict
        ``body``, ``name``, and ``moves``: by key the change of x and y, mm, per unit of the number.
    """
    scene = drawn(changes)
    if scene is None:
        return []
    there, now = spots(scene, place), {**values, **changes}
    moves: dict[Spot, dict[str, tuple[complex, float]]] = {spot: {} for spot in there}
    for key, step in steps.items():
        for change in (step, -step):
            scene = _tried(drawn, now, changes, key, now[key] + change)
            if scene is None:
                continue
            moved = spots(scene, place)
            for spot, at in there.items():
                moves[spot][key] = moved.get(spot, at) - at, change
            break
    return [
        {"body": body, "name": name, "moves": found}
        for (body, name), ways in moves.items()
        if (found := _rates(ways))
    ]


def _rates(ways: Mapping[str, tuple[complex, float]]) -> dict[str, list[float]]:
    """Return the changes of x and y for a unit of each number that moves a handle."""
    largest = max((abs(way) for way, _ in ways.values()), default=0.0)
    return {
        key: [tidy(way.real / change), tidy(way.imag / change)]
        for key, (way, change) in ways.items()
        if abs(way) > max(_ROUNDING, _NEAR * largest)
    }


def _tried(
    drawn: Callable[[Values], Scene | None], now: Values, changes: Values, key: str, new: float
) -> Scene | None:
    """Return the scene with a new value, and with that of its equals; None if refused."""
    for more in ({}, equals(now, key, new)):
        try:
            return drawn({**changes, **more, key: new})
        except GearcamError:
            continue
    return None
