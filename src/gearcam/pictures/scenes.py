"""Scenes: moving parts as data.

A *scene* shows bodies during a *cycle* of the driver: a turn of a closed pair or of a cam, the
travel of an open pair, the travel of a translating cam. A *body* is rigid: its features are given
once, in its own frame, with a rotation and a translation for each *place* of the driver. Points of
contact and the pitch point are given in the fixed frame. The folder of each kind of design defines
its scene (see `gearcam.designs.kind`).

Refused: arrays whose lengths do not match the places.

Depends on drawings, numpy only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Plane, distinct
from gearcam.numeric.pose import Pose, SpacePose
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import FOLLOWER, Feature, Path, chains

PLACES: Final = 720
"""Steps of the driver in a cycle; there is one more place for its end."""

SAGITTA: Final = 1e-3
"""Chord error of arcs and circles in a scene, mm; outlines keep their own chords."""


_SHORT: Final = 4
"""Most points of a line whose ends, and corners, are handles."""

_DIRECTIONS: Final = 180
"""Directions in which the outermost points of a body are searched: the error of the extent is below
1/6000 of its size."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MovingBody(ShortRepr):
    """A rigid body of a scene.

    Parameters
    ----------
    name : str
        Name of its part, or ``follower``. Bodies of one part move together.
    called : str
        Name for people.
    features : tuple of Feature
        Shapes in its own frame; later ones are drawn on top.
    pose : Pose
        Its n poses, one for each place; the turn has no jumps.
    teeth : (k, 2) array of int
        Indices of the first and last vertex of each tooth on the shape of the first feature, in the
        order of tooth numbers; first > last for a tooth across vertex 0. None without teeth.
    names : tuple of (str, complex), mm
        Names in the picture and their places in its frame.
    """

    name: str
    called: str
    features: tuple[Feature, ...]
    pose: Pose
    teeth: Ints | None = None
    names: tuple[tuple[str, complex], ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactPoints(ShortRepr):
    """Points of contact of two bodies in the fixed frame.

    Parameters
    ----------
    start : (n + 1,) array of int
        The points at place k are those from ``start[k]`` to before ``start[k + 1]``.
    point : (m,) complex array, mm
        Points of contact.
    force : (m,) complex array
        Unit vector of the force of the driver, along the line of action.
    teeth : (m, 2) array of int
        Teeth in contact, of both bodies in the order of their names: rows of `MovingBody.teeth`,
        from 1. They are the tooth numbers, unless an open wheel begins with half a tooth. None
        without teeth.
    """

    start: Ints
    point: Plane
    force: Plane
    teeth: Ints | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class JointForce(ShortRepr):
    """The force in a joint at the n places of a scene, in the fixed frame.

    Parameters
    ----------
    name : str
        Name of the joint.
    point : (n,) complex array, mm
        Where it acts.
    force : (n,) complex array, N
        The force; nan where there is none.
    """

    name: str
    point: Plane
    force: Plane


@dataclass(frozen=True, eq=False, kw_only=True)
class ColouredCurve(ShortRepr):
    """A curve on a body that can be drawn in the colours of values along it.

    Parameters
    ----------
    body : str
        Name of the body.
    places : (n,) array
        Places of the driver that belong to its points, in the unit of the scene.
    points : (n,) complex array, mm
        Its points, in the frame of the body; neighbours are joined.
    values : mapping of str to (n,) array
        Values by quantity and unit, as on chart axes: ``contact pressure, MPa``. Nan where there is
        none, or no point: the curve is not drawn there.
    """

    body: str
    places: Array
    points: Plane
    values: Mapping[str, Array]


@dataclass(frozen=True, eq=False, kw_only=True)
class Scene(ShortRepr):
    """Moving bodies over a cycle of the driver.

    Parameters
    ----------
    title : str
        Title of the scene.
    driver : str
        Quantity and unit of the places, as on chart axes: ``driver angle phi1, deg``.
    places : (n,) array
        Places of the driver in that unit, increasing; the last is the end of the cycle.
    closed : bool
        Whether the cycle repeats.
    start : float
        The place that is shown first.
    bodies : tuple of MovingBody
        Moving and fixed bodies; later ones are drawn on top.
    contacts : mapping of str to ContactPoints
        Points of contact by name.
    pitch : (n,) complex array, mm, optional
        The pitch point.
    forces : tuple of JointForce
        Forces drawn as arrows, all to one scale.
    coloured : tuple of ColouredCurve
        Curves that the reader can have coloured; those of one quantity share a scale.
    times : (n,) array, s, optional
        The time at each place, increasing, where the driver need not turn evenly.
    in_space : mapping of str to SpacePose
        By name, the n poses of solids that do not move as the body of their name; no turn jumps.
    eye : tuple of 3 floats
        Direction from which solids are seen at first.
    up : tuple of 3 floats
        Direction that is upwards then.
    """

    title: str
    driver: str
    places: Array
    closed: bool
    start: float = 0.0
    bodies: tuple[MovingBody, ...]
    contacts: Mapping[str, ContactPoints] = field(default_factory=dict)
    pitch: Plane | None = None
    forces: tuple[JointForce, ...] = ()
    coloured: tuple[ColouredCurve, ...] = ()
    times: Array | None = None
    in_space: Mapping[str, SpacePose] = field(default_factory=dict)
    eye: tuple[float, float, float] = (0.3, -0.7, 1.0)
    up: tuple[float, float, float] = (0.0, 1.0, 0.0)

    def __post_init__(self) -> None:
        for body in self.bodies:
            if not np.shape(body.pose.turn) == np.shape(body.pose.shift) == self.places.shape:
                raise ValueError(f"{body.name}: needs a pose for each place of the driver")
        for name, pose in self.in_space.items():
            if not (len(self.places), 3) == (*np.shape(pose.turn), 3) == np.shape(pose.shift):
                raise ValueError(f"{name}: needs a pose in space for each place of the driver")
        for name, contacts in self.contacts.items():
            if len(contacts.start) != len(self.places) + 1:
                raise ValueError(f"{name}: needs contacts for each place of the driver")
        for one in self.forces:
            if not np.shape(one.point) == np.shape(one.force) == self.places.shape:
                raise ValueError(f"{one.name}: needs a force for each place of the driver")
        if self.times is not None and (
            self.times.shape != self.places.shape or not np.all(np.diff(self.times) > 0.0)
        ):
            raise ValueError("times: needs a later one for each place of the driver")


def handles_of(body: MovingBody) -> dict[str, complex]:
    """Return the points of a body by which it can be taken hold of, by name.

    Parameters
    ----------
    body : MovingBody
        The body.

    Returns
    -------
    dict of str to complex, mm
        In its frame: named joints; of a follower the centre of its roller and the ends of its lines
        by numbers; else the origin without a name.
    """
    if body.names:  # the name of a body stands anywhere on it
        return {text: at for text, at in body.names if text not in (body.called, body.name)}
    points: list[complex] = []
    for shape in (one.shape for one in body.features if one.kind == FOLLOWER):
        if isinstance(shape, Circle):
            points.append(shape.center)
        elif isinstance(shape, Path) and len(shape.points) <= _SHORT:
            points.extend(shape.points.tolist())
    distinct = dict.fromkeys(points)
    return {str(k): at for k, at in enumerate(distinct, start=1)} or {"": 0j}


def still(features: tuple[Feature, ...], places: Array) -> MovingBody:
    """Return a body named ``frame`` of `features` that are fixed at all `places`."""
    pose = Pose(np.zeros(len(places)), np.zeros(len(places), dtype=np.complex128))
    return MovingBody(name="frame", called="frame", features=features, pose=pose)


def extent(scene: Scene) -> tuple[float, float, float, float]:
    """Return the bounding box of a `scene` over all places: left, bottom, right, top, mm.

    It contains the whole circle swept by a body that makes a full turn, also between places.
    """
    low, high = [], []
    for body in scene.bodies:
        chained = (chains(feature.shape, SAGITTA) for feature in body.features)
        points = np.concatenate([chain for shape in chained for chain, _ in shape])
        if np.ptp(body.pose.turn) < 2.0 * np.pi:
            moved = body.pose[:, None].apply(_outmost(points))
        else:
            corners = np.abs(points).max() * np.array([1 + 1j, -1 - 1j])
            moved = corners + body.pose.shift[:, None]
        low.append((moved.real.min(), moved.imag.min()))
        high.append((moved.real.max(), moved.imag.max()))
    (left, bottom), (right, top) = np.min(low, axis=0), np.max(high, axis=0)
    return float(left), float(bottom), float(right), float(top)


def _outmost(points: Plane) -> Plane:
    """Return the points that are outermost in some direction; others do not affect the box."""
    if len(points) <= _DIRECTIONS:
        return points
    angles = 2.0 * np.pi * np.arange(_DIRECTIONS)[:, None] / _DIRECTIONS
    along = np.cos(angles) * points.real + np.sin(angles) * points.imag
    return points[distinct(along.argmax(axis=1))]
