"""The picture of a mechanism while its parts are drawn: a solved machine, and what is drawn of it.

Members are symbols (see `gearcam.pictures.links`): links through their pins, bars along which
blocks slide, and chains on wheels.
"""

from __future__ import annotations

import cmath
import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from gearcam.kinds.mechanism.parts.setting import Setting
from gearcam.linkages.known import Known
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.pose import Pose
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import BORE, CENTER, CENTRODE, MEMBER, Cross, Feature, Path, place
from gearcam.pictures.links import block, guide, link, pin, pivot
from gearcam.pictures.scenes import MovingBody, still

_WIDTH: Final = 0.011
"""Half width of a link, relative to the size of the machine."""

_LEAST, _MOST = 0.004, 0.2
"""Smallest half width relative to the machine, and largest one relative to its shortest link."""

PIN: Final = f"{MEMBER}_{BORE}"
"""Layer of the joints of members."""

_PIECES: Final = 24
"""Most pieces of a chain, which overlap where it is short."""

CHAIN_WHEEL: Final = "chain_wheel"
"""Name of the wheel of a chain."""

CHAIN: Final = "chain"
"""What its pieces are called."""

Bar = tuple[complex, complex]


@dataclass(frozen=True)
class _Member:
    """What a member is drawn with, in its frame: joints, straight bars, blocks and directions."""

    pins: tuple[complex, ...]
    bars: tuple[Bar, ...]
    blocks: tuple[tuple[complex, float], ...]

    def features(self, pins: Sequence[complex], bars: Sequence[Bar], half: float) -> list[Feature]:
        """Return its shapes, with further pins and bars, of links so wide."""
        made: list[Feature] = []
        for bar in (*self.bars, *bars):
            made += link(bar, half)[:1]
        for at, direction in self.blocks:
            made += block(at, direction, half)
        every = [*self.pins, *pins]
        if len(every) > 1 or not made:
            made += link(every, half)
        elif not self.blocks:  # which have pins
            made += [pin(at, half) for at in every]
        return made


class Picture:
    """A solved mechanism, and what its parts draw.

    Parameters
    ----------
    setting : Setting
        What its drives move.
    q : (n,) array, rad
        The master's angles; they cover all that it moves through, since guides are as long as what
        slides on them needs.
    known : Known
        The linkage there.
    joints : sequence of str
        The names of all joints.
    lengths : sequence of float, mm
        Those of links, above 0.
    """

    def __init__(
        self,
        setting: Setting,
        q: Array,
        known: Known,
        joints: Sequence[str],
        lengths: Sequence[float],
    ) -> None:
        self.setting, self.q, self.known, self.lengths = setting, q, known, lengths
        self.places = {name: self.place(name) for name in joints}
        """The places of all joints by name."""
        self.sliding: defaultdict[str, list[str]] = defaultdict(list)
        """The quantities that are places on guides, by the guides' names."""
        self.pins: defaultdict[str, list[complex]] = defaultdict(list)
        """Further pins of members, by their names."""
        self.bars: defaultdict[str, list[Bar]] = defaultdict(list)
        """Further bars of members, by their names: guides on them."""
        self.lowest: list[MovingBody] = []
        """Bodies below the members: chains and their wheels."""
        self.lower: list[MovingBody] = []
        """Those on them: cylinders."""
        self._members: dict[str, _Member] = {}
        self._ways: list[str] = []
        self._pivots: list[complex] = []

    # --- the machine -----------------------------------------------------------------------------

    def place(self, name: str) -> Plane:
        """Return the places of a joint, by its `name`."""
        return _all(self.known.jet(name).c[0], self.q) + 0j

    def turn(self, name: str) -> Array:
        """Return the turns of a shaft, or the places of a slide, by its `name`."""
        return _all(self.known.jet(name).c[0], self.q)

    def pose(self, name: str) -> Pose:
        """Return the poses of a member or a guide, by its `name`."""
        frame = self.known.frame(name)
        turn = np.unwrap(np.angle(_all(frame.direction.c[0], self.q)))
        return Pose(turn, _all(frame.origin.c[0], self.q) + 0j)

    def ends(self, guide: str) -> tuple[float, float] | None:
        """Return the first and the last place of what slides on a `guide`; None if nothing does."""
        places = [self.turn(name) for name in self.sliding[guide]]
        if not places:
            return None
        return float(min(one.min() for one in places)), float(max(one.max() for one in places))

    @cached_property
    def half(self) -> float:
        """Half of the width of a link, mm."""
        places = np.concatenate([*self.places.values()] or [np.zeros(1)])
        size = float(np.hypot(np.ptp(places.real), np.ptp(places.imag)))
        size = max(size, *self.lengths, 1.0) if self.lengths else size or 1.0
        shortest = min(self.lengths, default=size)
        return max(_LEAST * size, min(_WIDTH * size, _MOST * shortest))

    def reach(self, least: float, most: float) -> tuple[float, float]:
        """Return the ends of a bar from its member's origin on, with room for the block on it.

        Parameters
        ----------
        least, most : float, mm
            The first and the last place of the block.
        """
        room = 3.0 * self.half
        return min(0.0, least - room), max(0.0, most + room)

    # --- what parts draw -------------------------------------------------------------------------

    def member(
        self,
        name: str,
        *pins: complex,
        bars: Iterable[Bar] = (),
        blocks: Iterable[tuple[complex, float]] = (),
    ) -> None:
        """Draw a member.

        Parameters
        ----------
        name : str
            Its name.
        *pins : complex, mm
            Its joints, in its frame.
        bars : iterable of (complex, complex), mm
            Ends of straight bars on which something slides.
        blocks : iterable of (complex, float), mm, rad
            Blocks that slide on something else, and their directions.
        """
        self._members[name] = _Member(pins, tuple(bars), tuple(blocks))

    def below(self, name: str, called: str, features: Sequence[Feature], pose: Pose) -> None:
        """Draw a body below the members (see `MovingBody`)."""
        self.lowest.append(
            MovingBody(name=name, called=called, features=tuple(features), pose=pose)
        )

    def way(self, guide: str) -> None:
        """Draw a guide on the ground."""
        self._ways.append(guide)

    def pivot(self, at: complex) -> None:
        """Draw a pivot on the ground."""
        self._pivots.append(at)

    def cylinder(self, member: str, joint: str, share: float) -> None:
        """Draw a member whose length changes as a barrel and a rod.

        Parameters
        ----------
        member, joint : str
            Its name, and the joint at its end.
        share : float
            Length of the barrel, relative to the cylinder at its shortest.
        """
        self.member(member)
        pose, end, half = self.pose(member), self.place(joint), self.half
        long = np.abs(end - pose.shift)
        shortest, longest = float(long.min()), float(long.max())
        barrel = share * shortest
        rod = max(longest - barrel, 0.5 * shortest)
        low, high = -1.8j * half, 1.8j * half
        edge = np.array([low, barrel + low, barrel + high, high])
        shape = Feature(layer=MEMBER, shape=Path(points=edge))
        self.lower += [
            MovingBody(
                name=f"{member}_rod",
                called=f"{member}, rod",
                features=link([-rod + 0j, 0j], half)[:1],
                pose=Pose(pose.turn, end),
            ),
            MovingBody(
                name=member, called=member, features=(shape, *link([0j], 1.2 * half)), pose=pose
            ),
        ]

    def chain_wheel(self, shaft: str, center: complex, radius: float) -> None:
        """Draw the wheel of a chain on a `shaft`, which stands in `center`, with a `radius`, mm."""
        holes = [0.6 * radius * cmath.exp(2j * math.pi * k / 3) for k in range(3)]
        features = (
            Feature(layer=MEMBER, shape=Circle(center=0j, diameter=2.0 * radius)),
            *(Feature(layer=PIN, shape=Circle(center=at, diameter=0.3 * radius)) for at in holes),
            Feature(layer=CENTER, shape=Cross(center=0j, size=0.4 * radius)),
        )
        pose = Pose(self.turn(shaft), np.full(self.q.shape, center))
        self.below(CHAIN_WHEEL, "chain wheel", features, pose)

    def guided(self, start: complex, end: complex) -> None:
        """Draw where a chain is guided, from `start` to `end`, mm."""
        line = Path(points=np.array([start, end]), closed=False)
        self.lowest.append(still((Feature(layer=CENTRODE, shape=line),), self.q))

    def chain(self, start: Plane, end: Plane) -> None:
        """Draw a chain from `start` to `end`, (n,) mm, by straight pieces that cover it."""
        # bodies are rigid, and its length changes: where it is short they overlap
        long, turn = np.abs(end - start), np.unwrap(np.angle(end - start))
        longest = float(long.max())
        size = max(float(long.min()), longest / _PIECES)
        count = max(1, math.ceil(longest / size))
        shape = Path(points=np.array([0j, size]), closed=False)
        for k in range(count):
            share = k / (count - 1) if count > 1 else 0.0
            at = start + np.exp(1j * turn) * share * (long - size)
            piece = Feature(layer=MEMBER, shape=shape)
            self.below(f"chain_{k + 1}", CHAIN, (piece,), Pose(turn, at))

    # --- what is drawn ---------------------------------------------------------------------------

    def grounds(self) -> Iterator[Feature]:
        """Yield guides and pivots on the ground."""
        for name in dict.fromkeys(self._ways):
            ends, pose = self.ends(name), self.pose(name)[0]
            if ends is not None:
                yield from place(guide(ends, self.half), pose)
        for at in dict.fromkeys(self._pivots):
            yield from pivot(at, self.half)

    def members(self) -> Iterator[MovingBody]:
        """Yield the members with all their pins and bars."""
        for name, one in self._members.items():
            pins, bars = self.pins[name], self.bars[name]
            if one.pins or pins or one.blocks:
                features = tuple(one.features(pins, bars, self.half))
                yield MovingBody(name=name, called=name, features=features, pose=self.pose(name))


def _all(value: Any, q: Array) -> Any:
    """Return values at all angles."""
    return np.broadcast_to(np.asarray(value), q.shape)
