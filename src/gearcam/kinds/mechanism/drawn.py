"""The pictures of a mechanism: its bodies, the moving scene, and drawings.

The drawings are the machine at an angle of its master, and the paths of its points. Members are
symbols, wheels and cams are those of the pair or the cam itself, moved as the linkage takes them:
by the drive's laws; cams in space are outlines of their blanks. Layers begin with the name of the
point whose PATH is on them, or with the wheel.

The distance of a path from its chord is measured at three angles inside the chord. It falls with
the square of the step: this gives the number of chords that one is divided into.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.keys import Sort
from gearcam.kinds.mechanism.names import parts_of, standing_places, tables_of, told_parts
from gearcam.kinds.mechanism.parts.picture import CHAIN, CHAIN_WHEEL, PIN, Picture
from gearcam.kinds.mechanism.parts.setting import Setting
from gearcam.linkages.linkage import in_cycle
from gearcam.numeric.arrays import divided
from gearcam.numeric.pose import Pose
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import (
    GHOST,
    MEMBER,
    OUTER,
    PRIME,
    TRACE,
    Drawing,
    Feature,
    Path,
    box,
    chains,
    mirrored,
    place,
)
from gearcam.pictures.labels import Label, labelled
from gearcam.pictures.markup import PIXELS, with_room
from gearcam.pictures.scenes import PLACES, MovingBody, Scene, still
from gearcam.results.ladders import CHORD_ORDER, ROUNDING, SHARES, Ladder, tolerances_around
from gearcam.results.nested import within

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.moved import Moved
    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.numeric.arrays import Array, Plane

_SAME: Final = 1e-3
"""Distance of two ways of a path, relative to its length, below which they are drawn as one."""

_ROUNDING: Final = 1e-6
"""Distance of a joint from where a member carries it that is rounding, mm."""

_TURNS: Final = 4
"""Largest number of turns of the master for each of which there are so many places."""

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

_BETWEEN: Final = 12
"""Chords between knots at first."""

_INSIDE: Final = np.array([0.25, 0.5, 0.75])
"""Shares of a chord at which the distance is measured."""

_MARGIN: Final = 0.9
"""Allowed measured distance, as a share of the tolerance: between the angles it may be larger."""

_MOST: Final = 1_000_000
"""Largest number of chords of a path."""


def bodies(result: MechanismResult, q: Array, before: int = 0) -> tuple[MovingBody, ...]:
    """Return the bodies of a mechanism.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    q : (n,) array, rad
        Angles of the master; they cover all that it moves through, since guides are as long as what
        slides on them needs.
    before : int
        How many angles come before those of the paths of points.

    Returns
    -------
    tuple of MovingBody
        Later ones are drawn on top. Members, wheels and cams have their names, a wheel or a cam
        that of its drive before it; what stands still is named ``frame``.
    """
    tables = tables_of(result.design)
    parts = [part for *_, part in parts_of(tables)]
    joints = [use for part in parts for use in part.given() if use.sort == Sort.JOINT]
    joints.sort(key=lambda one: one.path != ("name",))  # first those with a table of their own
    lengths = [length for part in parts for length in part.sizes()]
    setting, known = Setting(standing_places(tables), result.drives), result.linkage.at(q, 0)
    picture = Picture(setting, q, known, [one.name for one in joints], lengths)
    for guide, quantity in (one for part in parts for one in part.guided()):
        picture.sliding[guide].append(quantity)
    for part in parts:
        part.draw(picture)
    for *_, part in told_parts(tables):
        part.stand(picture)
    driven = [one for number in range(len(result.drives)) for one in _driven(result, number, q)]
    fixed = [tuple(picture.grounds()), tuple(_paths(result, picture, before))]
    standing, paths = ([still(features, q)] if features else [] for features in fixed)
    every = (*driven, *standing, *picture.lowest, *picture.lower, *picture.members(), *paths)
    return tuple(_named(picture, every))


def _named(picture: Picture, every: tuple[MovingBody, ...]) -> Iterator[MovingBody]:
    """Yield bodies with names: of joints, each on the first body that carries it, and their own."""
    places = dict(picture.places)
    for body in every:
        own, pins = list[tuple[str, complex]](), pins_of(body)
        for name, joint in list(places.items()):
            at = complex(body.pose[0].inverse.apply(joint[0]))
            pinned = body.name == "frame" or (np.abs(pins - at) < _ROUNDING).any()
            if pinned and np.abs(body.pose.apply(at) - joint).max() < _ROUNDING:
                own.append((name, at))
                del places[name]
        if any(one.kind == MEMBER for one in body.features) and body.called != CHAIN:
            own.append((body.called, complex(pins.mean()) if len(pins) else 0j))
        yield replace(body, names=tuple(own)) if own else body


def pins_of(body: MovingBody) -> Plane:
    """Return the joints of a member in its frame, (n,) mm; none of other bodies."""
    pins = [
        one.shape.center
        for one in body.features
        if one.layer == PIN and isinstance(one.shape, Circle)
    ]
    return np.array(list(dict.fromkeys(pins)), dtype=np.complex128)


def traced(result: MechanismResult) -> tuple[str, ...]:
    """Return the names of the points whose paths are drawn: all, and joints that are asked for."""
    parts = parts_of(tables_of(result.design))
    points = [name for *_, part in parts for name in part.traced()]
    asked = [one.name for one in result.outputs if one.quantity == f"{one.name}.x"]
    return tuple(dict.fromkeys([*points, *asked]))


def _paths(result: MechanismResult, picture: Picture, before: int) -> Iterator[Feature]:
    closed = result.linkage.closed
    for name in traced(result):
        points = picture.place(name)[before:]
        if float(np.abs(points - points[0]).max()) > 0.0:
            once = _once(points[:-1]) if closed else None
            whole = Path(points=points, closed=closed)
            shape = whole if once is None else Path(points=once, closed=False)
            yield Feature(layer=TRACE, shape=shape)


def _once(points: Plane) -> Plane | None:
    """Return one way of a closed path that goes there and back on it; None if it does not.

    Dashes drawn twice would make a full line.
    """
    points = np.roll(points, -int(np.abs(points - points[0]).argmax()))
    half = int(np.abs(points - points[0]).argmax())
    out, back = points[: half + 1], np.append(points[half:], points[0])
    off = distances(out[:, None], back[:-1], back[1:]).min(axis=1)
    return out if off.max() < _SAME * abs(points[half] - points[0]) else None


# --- wheels and cams -----------------------------------------------------------------------------


def _driven(result: MechanismResult, number: int, q: Array) -> Iterator[MovingBody]:
    """Yield the bodies of the pair or the cam of a drive."""
    drive = result.drives[number]
    if drive.result is None:
        return
    if drive.spec.in_space:
        yield from _driven_in_space(drive, q)
        return
    with within(f"drive[{number}].{drive.spec.key}"):
        scene = drive.result.at_rest
    x = drive.own(q)
    for body in scene.bodies:
        moved = _moved(drive, body.name)
        yield replace(
            body,
            # bodies whose names differ behind an underscore share their colours
            name=f"{drive.spec.name.replace('_', ' ')}.{body.name}" if moved else body.name,
            called=f"{body.called} of {drive.spec.name}" if moved else body.called,
            features=tuple(_seen(drive, body.features)),
            pose=_placed(drive, _motion(moved, x) @ body.pose[0]),
            teeth=None,
        )


def _driven_in_space(drive: PlacedDrive, q: Array) -> Iterator[MovingBody]:
    """Yield the bodies of a cam in space."""
    from gearcam.kinds.mechanism.drawn_in_space import drawn_in_space

    for word, features in drawn_in_space(drive).items():
        yield MovingBody(
            name=f"{drive.spec.name.replace('_', ' ')}.{word}",
            called=f"{word} of {drive.spec.name}",
            features=tuple(_seen(drive, features)),
            pose=_placed(drive, _motion(drive.moved.get(word), drive.own(q))),
        )


def _moved(drive: PlacedDrive, body: str) -> Moved | None:
    """Return what moves a body of a pair or a cam; None if it stands still."""
    if body == "frame":
        return None
    first, last = drive.moved.values()
    if drive.spec.pair is not None:
        return first if body == drive.result.parts[0].name else last
    return last if body == "follower" else first


def _motion(moved: Moved | None, x: Array) -> Pose:
    """Return the motion of a body from its place at the drive's zero, in the drive's frame."""
    if moved is None:
        return Pose(np.zeros(x.shape), np.zeros(x.shape, dtype=np.complex128))
    way = np.asarray(moved.law(x, 0).c[0]) - np.asarray(moved.law(np.zeros(1), 0).c[0])
    if moved.along:
        return Pose(np.zeros(x.shape), way * moved.along)
    return Pose(way, moved.at * (1.0 - np.exp(1j * way)))


def _seen(drive: PlacedDrive, features: tuple[Feature, ...]) -> Iterator[Feature]:
    for one in features:
        if one.kind == PRIME:  # which says nothing of the machine
            continue
        yield replace(one, shape=mirrored(one.shape)) if drive.spec.mirror else one


def _placed(drive: PlacedDrive, pose: Pose) -> Pose:
    """Return a pose in the drive's frame as one in the machine."""
    if drive.spec.mirror:
        pose = Pose(-pose.turn, np.conj(pose.shift))
    return Pose(drive.spec.turn, complex(*drive.spec.at)) @ pose


# --- the moving scene -----------------------------------------------------------------------------


def scene(result: MechanismResult, places: int = PLACES) -> Scene:
    """Return the machine in motion.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    places : int
        Steps of the master in a turn; of many turns the steps are longer.

    Returns
    -------
    Scene
    """
    low, high = result.linkage.span
    turns = min(max(round((high - low) / (2.0 * math.pi)), 1), _TURNS)
    q = np.linspace(low, high, places * turns + 1)
    return Scene(
        title=result.design.name,
        driver=result.axis,
        places=np.degrees(q),
        closed=result.linkage.closed,
        start=math.degrees(shown_at(result)),
        bodies=bodies(result, q),
    )


def shown_at(result: MechanismResult) -> float:
    """Return the master's angle in pictures, rad, within its range."""
    (low, high), pose = result.linkage.span, result.design.output.pose
    if result.linkage.closed:
        return low + (pose - low) % (high - low)
    return min(max(pose, low), high)


# --- drawings -------------------------------------------------------------------------------------


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


def posed(every: tuple[MovingBody, ...]) -> Iterator[Feature]:
    """Yield the features of bodies, `every`, in their first places, but for paths."""
    for body in every:
        part = body.name.rpartition(".")[2]
        prefix = f"{part.upper()}_" if part.startswith("gear") else ""
        shown = [one for one in body.features if one.kind != TRACE]
        if prefix:
            # a ring begins with its inner teeth: its blank would cover them
            shown.sort(key=lambda one: one.kind not in OUTER)
        yield from place(shown, body.pose[0], prefix)


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
        *names,
        *labelled(angles, lines, less, 0.5 * less, names),
    )


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
    moving = [
        one
        for one in every
        if len(pins_of(one)) and one.name != CHAIN_WHEEL
        if np.ptp(one.pose.turn) or np.ptp(np.abs(one.pose.shift - one.pose.shift[0]))
    ]
    if not moving:
        return []
    pins, angles = pins_of(moving[0]), dict[complex, list[str]]()
    end = complex(pins[int(np.abs(pins).argmax())])
    for index in range(1, len(q)):
        if math.isclose(q[index], q[0], abs_tol=1e-9):
            continue
        at = complex(moving[0].pose[index].apply(end))
        at = next((one for one in angles if abs(one - at) < near), at)
        angles.setdefault(at, []).append(f"{formatted(math.degrees(q[index]), 4)}°")
    return [(", ".join(texts), at) for at, texts in angles.items()]


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


# --- paths as chains of chords --------------------------------------------------------------------


def path_within(
    place: Callable[[Array], Plane], knots: Array, tolerance: float
) -> tuple[Array, Plane]:
    """Return points of a path, no chord between them farther from it than a tolerance.

    Parameters
    ----------
    place : callable
        ``place(q)`` returns the point at angles (n,) of the master, complex, mm.
    knots : (k,) array, rad
        The master's angles from the first to the last one; between them the path is smooth.
    tolerance : float, mm
        Largest distance.

    Returns
    -------
    q : (n,) array, rad
        The master's angles, with both ends and all knots.
    points : (n,) complex array, mm

    Raises
    ------
    InfeasibleError
        If the tolerance needs too many chords.
    """
    q, counts = knots, np.full(len(knots) - 1, _BETWEEN)
    while counts.sum() <= _MOST:
        q = divided(q, counts)
        points = place(q)
        inner = q[:-1] + np.outer(_INSIDE, np.diff(q))
        seen = place(inner.ravel()).reshape(inner.shape)
        off = distances(seen, points[:-1], points[1:]).max(axis=0)
        counts = np.maximum(np.ceil(np.sqrt(off / (_MARGIN * tolerance))), 1.0).astype(np.int64)
        if counts.max() == 1:
            return q, points
    raise InfeasibleError(
        f"a path would have more than {_MOST} chords",
        where="output.chord_tolerance_mm",
        value=tolerance,
        unit="mm",
        nearest="a larger one",
    )


def distances(points: Plane, start: Plane, end: Plane) -> Array:
    """Return distances of points from chords.

    Parameters
    ----------
    points : (m, n) complex array, mm
        Points that belong to n chords.
    start, end : (n,) complex arrays, mm
        The ends of the chords.

    Returns
    -------
    (m, n) array, mm
    """
    chord = end - start
    square = np.abs(chord) ** 2
    share = ((points - start) * chord.conj()).real / np.where(square > 0.0, square, 1.0)
    return np.abs(points - start - np.clip(share, 0.0, 1.0) * chord)


def _path_ladder(result: MechanismResult) -> Ladder:
    """Return the distance of the path of the first point from its chords, over their tolerance."""
    path = next(iter(result.paths.values()), None)
    if path is None:
        raise InfeasibleError(
            "no point is asked for: there is no path",
            where="output.outputs",
            nearest="ask for a joint or a point that draws one",
        )

    def place(q: Array) -> Plane:
        return np.asarray(path.track(q, 0).c[0], dtype=np.complex128)

    def make(tolerance: float) -> tuple[Array, Plane]:
        return path_within(place, path.knots, tolerance)

    def measure(made: tuple[Array, Plane]) -> tuple[float, int]:
        q, points = made
        inner = place((q[:-1] + np.outer(SHARES, np.diff(q))).ravel()).reshape(len(SHARES), -1)
        return float(distances(inner, points[:-1], points[1:]).max()), len(q)

    own = result.design.output.chord_tolerance or CHORDS
    return Ladder(
        refined="chord tolerance, mm",
        measured="chords of the path",
        unit="mm",
        levels=tolerances_around(own),
        own=own,
        order=CHORD_ORDER,
        rounding=ROUNDING * path.length.value,
        make=make,
        measure=measure,
    )


LADDERS: Final = {"path": _path_ladder}
"""What `gearcam accuracy` can measure."""
