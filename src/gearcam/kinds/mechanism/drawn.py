"""The drawings of a mechanism: the machine at an angle of its master, and the paths of its points.

Layers begin with the name of the point whose PATH is on them, or with the wheel.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.bodies import CHAIN_WHEEL, PIN, bodies, pins_of, traced
from gearcam.kinds.mechanism.scene import shown_at
from gearcam.kinds.mechanism.traces import path_within
from gearcam.linkages.linkage import in_cycle
from gearcam.numeric.arrays import divided
from gearcam.pictures.drawings import (
    GHOST,
    OUTER,
    TRACE,
    Drawing,
    Feature,
    Path,
    box,
    chains,
    place,
)
from gearcam.pictures.labels import Label, labelled
from gearcam.pictures.markup import PIXELS, with_room

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult
    from gearcam.numeric.arrays import Array, Plane
    from gearcam.pictures.scenes import MovingBody

_STEPS: Final = 720
"""Angles of the master in a picture."""

_GHOSTS: Final = 6
"""Places of the machine in a picture, the shown one among them."""

_LETTERS: Final = 15.0
"""Height of letters, pixels."""

_SMALLER: Final = 0.8
"""Height of the letters of other angles, relative to that of names."""

CHORDS: Final = 0.01
"""Chord tolerance of paths if the design has none, mm."""


def _angles(result: MechanismResult) -> tuple[Array, int]:
    """Return the shown angle of the master, those of ghosts, and all; how many come before all."""
    (low, high), at = result.linkage.span, shown_at(result)
    if result.linkage.closed:
        ahead = np.linspace(at, at + high - low, _GHOSTS, endpoint=False)[1:]
        _, others = in_cycle(ahead, (low, high))
    else:
        others = np.linspace(low, high, _GHOSTS)
    first = np.concatenate([[at], others])
    turns = max(1, round((high - low) / math.tau))
    return np.concatenate([first, np.linspace(low, high, _STEPS * turns + 1)]), len(first)


def posed(every: tuple[MovingBody, ...], index: int = 0) -> Iterator[Feature]:
    """Yield the features of bodies in their places, but for paths.

    Parameters
    ----------
    every : tuple of MovingBody
        The bodies.
    index : int
        Number of the place.
    """
    for body in every:
        part = body.name.rpartition(".")[2]
        prefix = f"{part.upper()}_" if part.startswith("gear") else ""
        shown = [one for one in body.features if one.kind != TRACE]
        if prefix:
            # a ring begins with its inner teeth: its blank would cover them
            shown.sort(key=lambda one: one.kind not in OUTER)
        yield from place(shown, body.pose[index], prefix)


def _ghosts(every: tuple[MovingBody, ...], count: int) -> Iterator[Feature]:
    """Yield lines between the joints of members, and their pins, at other places."""
    for body in every:
        pins = pins_of(body)
        if not len(pins) or body.name == CHAIN_WHEEL:
            continue
        shown = [one for one in body.features if one.layer == PIN]
        if len(pins) > 1:
            line = Path(points=pins, closed=len(pins) > 2)
            shown.append(Feature(layer=GHOST, shape=line))
        for index in range(1, count):
            yield from place([replace(one, layer=GHOST) for one in shown], body.pose[index])


def picture(result: MechanismResult) -> tuple[Drawing, tuple[Label, ...]]:
    """Return the machine at the angle of the design, at others as ghosts, and its names."""
    q, count = _angles(result)
    every = bodies(result, q, count)
    paths = [one for body in every for one in body.features if one.kind == TRACE]
    # wheels and cams would cover the thin lines of cranks on their shafts
    below, above = (
        tuple(posed(tuple(one for one in every if bool(len(pins_of(one))) == linked)))
        for linked in (False, True)
    )
    features = (*below, *_ghosts(every, count), *above, *paths)
    low, high = with_room(*box(features))
    size = _LETTERS * (high - low).real / PIXELS
    lines = _lines((*below, *above), 0.4 * size)
    names = labelled(_names(every), lines, size, size)
    less, angles = _SMALLER * size, _other_angles(every, q[:count], size)
    return Drawing(name="poses", features=features), (
        *names, *labelled(angles, lines, less, 0.5 * less, names)
    )  # fmt: skip


def legend(result: MechanismResult) -> str:
    """Return what the lines of the picture mean."""
    names = traced(result)
    thin = f"thin lines: the machine at the {result.driver[0]} beside them"
    word = "paths" if len(names) > 1 else "path"
    return f"{thin}; dashed: {word} of {', '.join(names)}" if names else thin


def _other_angles(
    every: tuple[MovingBody, ...], q: Array, near: float
) -> list[tuple[str, complex]]:
    """Return the angles of ghosts, each with the end of the first member there; near ones together.

    The first of the angles (n,), rad, is that of the machine itself.
    """
    moving = [one for one in every if len(pins_of(one)) and one.name != CHAIN_WHEEL and _moves(one)]
    if not moving:
        return []
    pins, found = pins_of(moving[0]), dict[complex, list[str]]()
    end = complex(pins[int(np.abs(pins).argmax())])
    for index in range(1, len(q)):
        if math.isclose(q[index], q[0], abs_tol=1e-9):
            continue
        at = complex(moving[0].pose[index].apply(end))
        at = next((one for one in found if abs(one - at) < near), at)
        found.setdefault(at, []).append(f"{formatted(math.degrees(q[index]), 4)}°")
    return [(", ".join(texts), at) for at, texts in found.items()]


def _moves(body: MovingBody) -> bool:
    return bool(np.ptp(body.pose.turn) or np.ptp(np.abs(body.pose.shift - body.pose.shift[0])))


def _names(every: tuple[MovingBody, ...]) -> list[tuple[str, complex]]:
    """Return the names in the picture with their places, those of joints first."""
    members = {body.called for body in every}
    named = [(text, complex(body.pose[0].apply(at))) for body in every for text, at in body.names]
    return sorted(named, key=lambda one: one[0] in members)


def _lines(features: tuple[Feature, ...], step: float) -> Plane:
    """Return points of the lines of features, no farther apart than a step, mm."""
    found = []
    for feature in features:
        for points, closed in chains(feature.shape, step):
            whole = np.append(points, points[:1]) if closed else points
            counts = np.ceil(np.abs(np.diff(whole)) / step).astype(np.int64) + 1
            found.append(divided(whole, counts)[:-1])
    return np.concatenate(found)


def paths_drawing(result: MechanismResult) -> Drawing:
    """Return the paths of points within the chord tolerance, and the machine at its angle."""
    linkage, tolerance = result.linkage, result.design.output.chord_tolerance or CHORDS
    names, features, taken = traced(result), [], set[str]()
    for name in names:

        def where(q: Array, name: str = name) -> Plane:
            return np.asarray(linkage.track(name, q, 0).c[0], dtype=np.complex128)

        _, points = path_within(where, linkage.knots, tolerance)
        points = points[:-1] if linkage.closed else points
        layer = _layer(name, taken)
        features.append(Feature(layer=layer, shape=Path(points=points, closed=linkage.closed)))
    q, _ = _angles(result)
    return Drawing(name="paths", features=(*features, *posed(bodies(result, q))), cut=False)


def _layer(name: str, taken: set[str]) -> str:
    """Return the layer of a point's path; layers that differ in case only are one in DXF."""
    own, number = name, 2
    while own.casefold() in taken:
        own, number = f"{name}_{number}", number + 1
    taken.add(own.casefold())
    return f"{own}_{TRACE}"
