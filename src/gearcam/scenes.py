"""Scenes: parts that move, as data.

A *scene* shows bodies while the driver goes through its *cycle*: a turn of a closed pair or of a
cam, the travel of an open pair, the way of a cam that slides. A *body* is rigid: what it looks like
is drawn once, in its own frame, and a placement for each *place* of the driver tells where it
stands. What moves with no body, the points of contact and the pitch point, is told in the fixed
frame. The folder of a kind makes its scene from the arrays of a result (see
`gearcam.designs.kind`); nothing here knows what moves.

Refused: arrays that do not belong to the places.

Depends on drawings, numpy only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from gearcam.display import Brief
from gearcam.drawings import Feature, chains
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.bulges import as_complex

PLACES: Final = 720
"""Steps of the driver in a cycle, and one more place for its end."""

SAGITTA: Final = 1e-3
"""Chord error of arcs and circles in a scene, mm; outlines keep their own."""


_DIRECTIONS: Final = 180
"""Directions in which the outmost points of a body are sought: what lies between two of them is
farther out by less than a six-thousandth of its size."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MovingBody(Brief):
    """A rigid body.

    Parameters
    ----------
    name : str
        As its part is called; ``follower`` of a follower. Bodies of one part move as one.
    called : str
        For people.
    features : tuple of Feature
        What it looks like, in its own frame; what is drawn later lies on top.
    turn : (n,) array, rad
        Counter-clockwise at each place, without jumps.
    shift : (n,) complex array, mm
        Place of its origin.
    teeth : (k, 2) array of int
        First and last vertex of each tooth on the shape of its first feature, in the order of the
        teeth's numbers; the last is the smaller where a tooth lies over the first vertex. None
        where nothing contacts tooth by tooth.
    """

    name: str
    called: str
    features: tuple[Feature, ...]
    turn: Array
    shift: Plane
    teeth: Ints | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactPoints(Brief):
    """Where bodies touch, in the fixed frame, place after place.

    Parameters
    ----------
    start : (n + 1,) array of int
        The rows of place k are ``start[k]`` to ``start[k + 1]``, the last excluded.
    point : (m,) complex array, mm
        Points of contact.
    force : (m,) complex array
        Unit direction in which the driver presses there: the line of action.
    teeth : (m, 2) array of int
        Teeth that touch, of both bodies with teeth in the order of their names: their places in
        `MovingBody.teeth`, from 1, which are their numbers but where an open wheel begins with half
        a tooth. None where bodies have none.
    """

    start: Ints
    point: Plane
    force: Plane
    teeth: Ints | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class Scene(Brief):
    """Bodies over a cycle of the driver.

    Parameters
    ----------
    title : str
        What is seen.
    driver : str
        The driver's place with its unit, as charts call their axis: ``driver angle phi1, deg``.
    places : (n,) array
        Of the driver, rising, in that unit; the last is the end of the cycle.
    closed : bool
        Whether the cycle repeats: its end is the next one's beginning.
    start : float
        The place that is shown first.
    bodies : tuple of MovingBody
        What moves, and what stands; what comes later lies on top.
    contacts : mapping of str to ContactPoints
        Points of contact by what they are.
    pitch : (n,) complex array, mm, optional
        The pitch point.
    """

    title: str
    driver: str
    places: Array
    closed: bool
    start: float = 0.0
    bodies: tuple[MovingBody, ...]
    contacts: Mapping[str, ContactPoints] = field(default_factory=dict)
    pitch: Plane | None = None

    def __post_init__(self) -> None:
        for body in self.bodies:
            if not body.turn.shape == body.shift.shape == self.places.shape:
                raise ValueError(f"{body.name}: a placement for each place of the driver")
        for name, contacts in self.contacts.items():
            if len(contacts.start) != len(self.places) + 1:
                raise ValueError(f"{name}: a row of contacts for each place of the driver")


def still(features: tuple[Feature, ...], places: Array) -> MovingBody:
    """Return the `features` that do not move, a body named ``frame``, over all `places`."""
    turn, shift = np.zeros(len(places)), np.zeros(len(places), dtype=np.complex128)
    return MovingBody(name="frame", called="frame", features=features, turn=turn, shift=shift)


def extent(scene: Scene) -> tuple[float, float, float, float]:
    """Return the box of a `scene` in every place: left, bottom, right, top, mm.

    It holds the circles that bodies sweep which turn all around, so that nothing leaves it on the
    way, and of others all places.
    """
    low, high = [], []
    for body in scene.bodies:
        points = np.vstack([p for f in body.features for p, _ in chains(f.shape, SAGITTA)])
        places = as_complex(points)
        if np.ptp(body.turn) < 2.0 * np.pi:
            moved = _outmost(places) * np.exp(1j * body.turn[:, None]) + body.shift[:, None]
        else:
            moved = np.abs(places).max() * np.array([1 + 1j, -1 - 1j]) + body.shift[:, None]
        low.append((moved.real.min(), moved.imag.min()))
        high.append((moved.real.max(), moved.imag.max()))
    (left, bottom), (right, top) = np.min(low, axis=0), np.max(high, axis=0)
    return float(left), float(bottom), float(right), float(top)


def _outmost(points: Plane) -> Plane:
    """Return those points that are farthest in some direction: the box of no others matters."""
    if len(points) <= _DIRECTIONS:
        return points
    ways = 2.0 * np.pi * np.arange(_DIRECTIONS)[:, None] / _DIRECTIONS
    along = np.cos(ways) * points.real + np.sin(ways) * points.imag
    return points[np.unique(along.argmax(axis=1))]
