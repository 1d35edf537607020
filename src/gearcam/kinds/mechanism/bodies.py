"""The bodies of a mechanism: its members, the true wheels or cams of its drives, guides, paths.

Members are symbols (see `gearcam.pictures.links`), wheels and cams are those of the pair or the cam
itself, moved as the linkage takes them: by the drive's laws.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.kinds.mechanism.drives import center_of, way_of
from gearcam.kinds.mechanism.names import given
from gearcam.kinds.mechanism.traces import distances
from gearcam.linkages.dyads import DYADS
from gearcam.linkages.elements import GROUND as STANDING
from gearcam.numeric.pose import Pose
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import (
    BORE,
    CENTER,
    CENTRODE,
    MEMBER,
    PRIME,
    TRACE,
    Cross,
    Feature,
    Path,
    mirrored,
    place,
)
from gearcam.pictures.geneva import geneva_crank, geneva_wheel
from gearcam.pictures.links import block, guide, link, pin, pivot
from gearcam.pictures.scenes import MovingBody, still
from gearcam.results.nested import within

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult
    from gearcam.kinds.mechanism.drives import Moved, PlacedDrive
    from gearcam.kinds.mechanism.tables import ChainSpec, DyadSpec, GuideSpec, HoistSpec
    from gearcam.linkages.elements import Known
    from gearcam.numeric.arrays import Array, Plane

_WIDTH: Final = 0.011
"""Half width of a link, relative to the size of the machine."""

_LEAST, _MOST = 0.004, 0.2
"""Smallest half width relative to the machine, and largest one relative to its shortest link."""

_SAME: Final = 1e-3
"""Distance of two ways of a path, relative to its length, below which they are drawn as one."""

_ROUNDING: Final = 1e-6
"""Distance of a joint from where a member carries it that is rounding, mm."""

PIN: Final = f"{MEMBER}_{BORE}"
"""Layer of the joints of members."""

_PIECES: Final = 24
"""Most pieces of a chain, which overlap where it is short."""

CHAIN_WHEEL: Final = "chain_wheel"
"""Name of the wheel of a chain."""

CHAIN: Final = "chain"
"""What its pieces are called."""

_BARREL: Final = 0.8
"""Length of a cylinder's barrel, relative to the cylinder at its shortest."""


@dataclass(frozen=True)
class _Shown:
    """A solved mechanism: its `result`, angles `q` of the master, what is `known` there."""

    result: MechanismResult
    q: Array
    known: Known

    def place(self, name: str) -> Plane:
        """Return the places of a joint."""
        return _all(self.known.jet(name).c[0], self.q) + 0j

    def turn(self, name: str) -> Array:
        """Return the turn of a shaft, or the place of a slide."""
        return _all(self.known.jet(name).c[0], self.q)

    def pose(self, name: str) -> Pose:
        """Return the poses of a member or a guide."""
        frame = self.known.frame(name)
        turn = np.unwrap(np.angle(_all(frame.direction.c[0], self.q)))
        return Pose(turn, _all(frame.origin.c[0], self.q) + 0j)

    @property
    def joints(self) -> list[str]:
        """Names of the joints that the tables give, and of those of even shafts."""
        design = self.result.design
        named = [one.name for one in (*design.joint, *design.point)]
        others = (*design.crank, *design.slide, *design.dyad, *design.chain, *design.hoist)
        return [*named, *(one.joint for one in others)]

    @property
    def half(self) -> float:
        """Half of the width of a link, mm."""
        design = self.result.design
        places = np.concatenate([self.place(name) for name in self.joints] or [np.zeros(1)])
        size = float(np.hypot(np.ptp(places.real), np.ptp(places.imag)))
        lengths = [one.length for one in (*design.crank, *design.chain)]
        lengths += [length for one in design.dyad for length in one.lengths if length > 0.0]
        size = max(size, *lengths, 1.0) if lengths else size or 1.0
        return max(_LEAST * size, min(_WIDTH * size, _MOST * min(lengths, default=size)))


def _all(value: Any, q: Array) -> Any:
    """Return values at all angles."""
    return np.broadcast_to(np.asarray(value), q.shape)


@dataclass
class _Parts:
    """What a member is drawn with, in its frame: joints, straight ways, blocks and directions."""

    pins: list[complex] = field(default_factory=list)
    ways: list[tuple[complex, complex]] = field(default_factory=list)
    blocks: list[tuple[complex, float]] = field(default_factory=list)

    def features(self, half: float) -> tuple[Feature, ...]:
        """Return its shapes."""
        made: list[Feature] = []
        for way in self.ways:
            made += link(way, half)[:1]
        for at, direction in self.blocks:
            made += block(at, direction, half)
        if len(self.pins) > 1 or not made:
            made += link(self.pins, half)
        elif not self.blocks:  # which have pins
            made += [pin(at, half) for at in self.pins]
        return tuple(made)


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
    shown = _Shown(result, q, result.linkage.at(q, 0))
    half = shown.half
    driven = [one for number in range(len(result.drives)) for one in _driven(shown, number)]
    members = [
        MovingBody(name=name, called=name, features=parts.features(half), pose=shown.pose(name))
        for name, parts in _members(shown, half).items()
        if parts.pins or parts.blocks
    ]
    chains = (*_chains(shown), *_genevas(shown))
    cylinders = [one for spec in result.design.dyad for one in _cylinder(shown, spec, half)]
    grounds = tuple(_grounds(shown, half))
    standing = [still(grounds, q)] if grounds else []
    paths = tuple(_paths(shown, before))
    drawn = [still(paths, q)] if paths else []
    every = (*driven, *standing, *chains, *cylinders, *members, *drawn)
    return tuple(_named(shown, every))


def _named(shown: _Shown, every: tuple[MovingBody, ...]) -> Iterator[MovingBody]:
    """Yield bodies with names: of joints, each on the first body that carries it, and their own."""
    places = {name: shown.place(name) for name in shown.joints}
    for body in every:
        own: list[tuple[str, complex]] = []
        for name, joint in list(places.items()):
            at = complex(body.pose[0].inverse.apply(joint[0]))
            if _carries(body, at) and np.abs(body.pose.apply(at) - joint).max() < _ROUNDING:
                own.append((name, at))
                del places[name]
        pins = pins_of(body)
        if any(one.kind == MEMBER for one in body.features) and body.called != CHAIN:
            own.append((body.called, complex(pins.mean()) if len(pins) else 0j))
        yield replace(body, names=tuple(own)) if own else body


def _carries(body: MovingBody, at: complex) -> bool:
    """Return whether a joint at a place in a body's frame may be named on it."""
    return body.name == "frame" or bool((np.abs(pins_of(body) - at) < _ROUNDING).any())


def pins_of(body: MovingBody) -> Plane:
    """Return the joints of a member in its frame, (n,) mm; none of other bodies."""
    pins = [
        one.shape.center
        for one in body.features
        if one.layer == PIN and isinstance(one.shape, Circle)
    ]
    return np.array(list(dict.fromkeys(pins)), dtype=np.complex128)


# --- members -------------------------------------------------------------------------------------


def _members(shown: _Shown, half: float) -> dict[str, _Parts]:
    """Return what the members are drawn with, by name, in order."""
    design = shown.result.design
    found = {one.name: _Parts([0j, complex(one.length)]) for one in design.crank}
    for slide in design.slide:
        pins = [0j, complex(*slide.at)] if any(slide.at) else [0j]
        found[slide.name] = _Parts(pins, blocks=[] if _carried(shown, slide.on) else [(0j, 0.0)])
    for dyad in design.dyad:
        for k, name in enumerate(dyad.members):
            found[name] = _of_dyad(shown, dyad, k, half)
    found |= {one.lever: _Parts([0j, complex(one.length)]) for one in design.chain}
    found |= {one.name: _Parts([0j], blocks=[(0j, 0.0)]) for one in design.hoist}
    for one in design.guide:
        if one.on in found:
            found[one.on].ways += _guide_on(shown, one, half)
    for point in design.point:
        if point.on in found:
            found[point.on].pins.append(complex(*point.at))
    return found


def _guide_on(shown: _Shown, spec: GuideSpec, half: float) -> Iterator[tuple[complex, complex]]:
    """Yield the guide on a member, and what joins it to the member's origin."""
    own = shown.pose(spec.on)[0].inverse @ shown.pose(spec.name)[0]
    ends, way, at = _ends(shown, spec.name), complex(own.rotation), complex(own.shift)
    if ends is not None:
        low, high = _reach(*ends, half)
        yield at + low * way, at + high * way
    if at:
        yield 0j, at


def _carried(shown: _Shown, slide: str) -> bool:
    """Return whether a slide is a follower or a rack, which its drive draws."""
    word = slide.rpartition(".")[2]
    return word in ("follower", "rack") and slide in {
        one.name for one in given({"drive": shown.result.design.drive})
    }


def _of_dyad(shown: _Shown, dyad: DyadSpec, k: int, half: float) -> _Parts:
    """Return what member `k` of a dyad is drawn with."""
    guided, slides = DYADS[dyad.formula].guides[k], DYADS[dyad.formula].slides
    beside = (dyad.beta, -dyad.beta)[k]
    own, other = f"member{k + 1}", f"member{2 - k}"
    parts = _Parts(blocks=[(0j, -dyad.gammas[k])] if guided else [])
    parts.pins.append(0j)
    if own in slides:
        along = shown.turn(f"{dyad.joint}.{own}")
        parts.ways.append(_reach(float(along.min()), float(along.max()), half))
        return parts
    if dyad.driven is not None and k == 0:  # drawn as a cylinder
        return _Parts()
    end = complex(dyad.lengths[k])
    if end:
        parts.pins.append(end)
    if other in slides:
        parts.blocks.append((end, beside))
    return parts


def _reach(least: float, most: float, half: float) -> tuple[float, float]:
    """Return the ends of a way on a member, from its origin on, with room for the block on it."""
    room = 3.0 * half
    return min(0.0, least - room), max(0.0, most + room)


def _ends(shown: _Shown, name: str) -> tuple[float, float] | None:
    """Return the first and the last place of what slides on a guide; None without anything."""
    design = shown.result.design
    used = [
        f"{dyad.joint}.guide{k + 1}"
        for dyad in design.dyad
        for k, owner in enumerate((dyad.first, dyad.last))
        if owner == name and DYADS[dyad.formula].guides[k]
    ]
    used += [f"{one.name}.way" for one in design.hoist if f"{one.name}.guide" == name]
    used += [slide.on for slide in design.slide if way_of(slide.on) == name]
    places = [shown.turn(one) for one in used]
    if not places:
        return None
    return float(min(one.min() for one in places)), float(max(one.max() for one in places))


def _cylinder(shown: _Shown, dyad: DyadSpec, half: float) -> Iterator[MovingBody]:
    """Yield barrel and rod of a member whose length a drive changes."""
    if dyad.driven is None:
        return
    pose, end = shown.pose(dyad.members[0]), shown.place(dyad.joint)
    long = np.abs(end - pose.shift)
    shortest, longest = float(long.min()), float(long.max())
    rod = max(longest - _BARREL * shortest, 0.5 * shortest)
    barrel = _BARREL * shortest
    low, high = -1.8j * half, 1.8j * half
    edge = np.array([low, barrel + low, barrel + high, high])
    pinned = link([0j], 1.2 * half)
    shape = Feature(layer=MEMBER, shape=Path(points=edge))
    first = dyad.members[0]
    yield MovingBody(
        name=f"{first}_rod", called=f"{first}, rod", features=link([-rod + 0j, 0j], half)[:1],
        pose=Pose(pose.turn, end),
    )  # fmt: skip
    yield MovingBody(name=first, called=first, features=(shape, *pinned), pose=pose)


# --- what stands still ---------------------------------------------------------------------------


def _grounds(shown: _Shown, half: float) -> Iterator[Feature]:
    """Yield guides and pivots on the ground."""
    design = shown.result.design
    ways = [one.name for one in design.guide if one.on == STANDING]
    ways += [way_of(one.on) for one in design.slide if not _carried(shown, one.on)]
    ways += [f"{one.name}.guide" for one in design.hoist]
    for name in dict.fromkeys(ways):
        ends, pose = _ends(shown, name), shown.pose(name)[0]
        if ends is not None:
            yield from place(guide(ends, half), pose)
    for at in dict.fromkeys(_pivots(shown)):
        yield from pivot(at, half)


def _pivots(shown: _Shown) -> Iterator[complex]:
    """Yield the joints that stand still, but for the shafts of wheels and cams."""
    design = shown.result.design
    yield from (complex(*one.at) for one in design.joint)
    shafts = {
        f"{drive.spec.name}.{word}": drive.machine(one.at)
        for drive in shown.result.drives
        for word, one in drive.moved.items()
        if not one.along and (drive.result is None or word == "follower")
    }
    shafts |= {name.rpartition(".")[0]: at for name, at in shafts.items()}
    used = [one.on for one in design.crank if one.at is None]
    yield from (shafts[name] for name in used if name in shafts)
    yield from (complex(*one.hinge) for one in design.chain)


def traced(result: MechanismResult) -> tuple[str, ...]:
    """Return the names of the points whose paths are drawn: all, and joints that are asked for."""
    points = [one.name for one in result.design.point if one.on != STANDING]
    asked = [one.name for one in result.outputs if one.quantity == f"{one.name}.x"]
    return tuple(dict.fromkeys([*points, *asked]))


def _paths(shown: _Shown, before: int) -> Iterator[Feature]:
    closed = shown.result.linkage.closed
    for name in traced(shown.result):
        points = shown.place(name)[before:]
        if float(np.abs(points - points[0]).max()) > 0.0:
            once = _once(points[:-1]) if closed else None
            shape = Path(points=points, closed=closed)
            shape = shape if once is None else Path(points=once, closed=False)
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


# --- chains --------------------------------------------------------------------------------------


def _chains(shown: _Shown) -> Iterator[MovingBody]:
    """Yield the wheels of chains and the free parts of these."""
    design = shown.result.design
    for spec in design.chain:
        yield from _swinging(shown, spec)
    for spec in design.hoist:
        yield from _lifting(shown, spec)


def _swinging(shown: _Shown, spec: ChainSpec) -> Iterator[MovingBody]:
    """Yield wheel and chain of a lever."""
    center, wind = complex(*spec.at), 1.0 if spec.wind == "ccw" else -1.0
    end = shown.place(spec.joint)
    way = end - center
    seen = np.angle(way) + wind * np.arccos(spec.radius / np.abs(way))
    yield _wheel(shown, spec.on, center, spec.radius)
    start = np.asarray(center + spec.radius * np.exp(1j * seen), dtype=np.complex128)
    yield from _pieces(start, end)


def _lifting(shown: _Shown, spec: HoistSpec) -> Iterator[MovingBody]:
    """Yield wheel and chain of what is lifted, the wheel on its shaft."""
    end, along = shown.place(spec.joint), cmath.exp(1j * spec.direction)
    shaft = complex(shown.place(center_of(spec.on))[0])
    # where the chain, which leads straight to the joint, is level with the shaft
    foot = complex(end[0] + along * ((shaft - end[0]) * along.conjugate()).real)
    yield _wheel(shown, spec.on, shaft, spec.radius)
    beside = abs(foot - shaft)
    if beside > (1.0 + _SAME) * spec.radius:  # something must guide it to the wheel
        rim = shaft + spec.radius * (foot - shaft) / beside
        guided = Feature(layer=CENTRODE, shape=Path(points=np.array([rim, foot]), closed=False))
        yield still((guided,), shown.q)
    yield from _pieces(np.full(shown.q.shape, foot), end)


def _genevas(shown: _Shown) -> Iterator[MovingBody]:
    """Yield Geneva wheels and their cranks."""
    for spec in shown.result.design.geneva:
        wheel = geneva_wheel(spec.length, spec.slots, internal=spec.internal)
        crank = geneva_crank(spec.length, spec.slots, internal=spec.internal)
        turn = shown.turn(spec.on) + spec.angle
        pose = Pose(turn, shown.place(spec.at or center_of(spec.on)))
        yield MovingBody(
            name=spec.name, called=spec.name, features=wheel, pose=shown.pose(spec.name)
        )
        name = f"{spec.name}_crank"
        yield MovingBody(name=name, called="crank", features=crank, pose=pose)


def _wheel(shown: _Shown, shaft: str, center: complex, radius: float) -> MovingBody:
    """Return the wheel of a chain."""
    holes = [0.6 * radius * cmath.exp(2j * math.pi * k / 3) for k in range(3)]
    features = (
        Feature(layer=MEMBER, shape=Circle(center=0j, diameter=2.0 * radius)),
        *(Feature(layer=PIN, shape=Circle(center=at, diameter=0.3 * radius)) for at in holes),
        Feature(layer=CENTER, shape=Cross(center=0j, size=0.4 * radius)),
    )
    pose = Pose(shown.turn(shaft), np.full(shown.q.shape, center))
    return MovingBody(name=CHAIN_WHEEL, called="chain wheel", features=features, pose=pose)


def _pieces(start: Plane, end: Plane) -> Iterator[MovingBody]:
    """Yield straight pieces that cover a chain between two points; they overlap where it is short.

    Bodies are rigid, and its length changes.
    """
    long, turn = np.abs(end - start), np.unwrap(np.angle(end - start))
    longest = float(long.max())
    size = max(float(long.min()), longest / _PIECES)
    count = max(1, math.ceil(longest / size))
    shape = Path(points=np.array([0j, size]), closed=False)
    for k in range(count):
        share = k / (count - 1) if count > 1 else 0.0
        at = start + np.exp(1j * turn) * share * (long - size)
        piece = Feature(layer=MEMBER, shape=shape)
        yield MovingBody(
            name=f"chain_{k + 1}", called=CHAIN, features=(piece,), pose=Pose(turn, at)
        )


# --- wheels and cams -----------------------------------------------------------------------------


def _driven(shown: _Shown, number: int) -> Iterator[MovingBody]:
    """Yield the bodies of the pair or the cam of a drive."""
    drive = shown.result.drives[number]
    if drive.result is None:
        return
    with within(f"drive[{number}].{drive.spec.key}"):
        scene = drive.result.plain.scene(1)
    x = drive.own(shown.q)
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
