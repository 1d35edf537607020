"""Random plane linkages of one to four dyads, and what holds for each dyad by its definition."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.dyads import DYADS, Lengths
from gearcam.linkages.elements import Crank, Dyad, Element, GivenMotion, GuideLine, MemberPoint
from gearcam.linkages.known import Known
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

Random = np.random.Generator

TURN = 2.0 * np.pi

_PLACES = np.linspace(0.0, TURN, 73)
"""Angles at which the ends of the next dyad are looked at, to choose its sizes."""


@dataclass(frozen=True)
class Drawn:
    """A random linkage, and what its shafts and cylinders do over the driver's angle."""

    linkage: Linkage
    ways: dict[str, Callable[[Any], Any]]

    @property
    def dyads(self) -> tuple[Dyad, ...]:
        return self.linkage.dyads


def stroke_law(stroke: float) -> Callable[[Array, int], Jet]:
    """A cylinder that goes out and in once a turn."""
    return lambda q, order: jets.sin_cos(Jet.variable(q, order))[1] * stroke


def drawn(seed: int, index: int) -> Drawn:
    """Linkage of one to four dyads; only its last dyad may not close."""
    rng = np.random.default_rng([seed, index])
    ratio = float(rng.choice([-2.0, -1.0, 1.0, 2.0]))
    stroke = float(rng.uniform(3.0, 10.0))
    ways: dict[str, Callable[[Any], Any]] = {
        "q": lambda x: x,
        "geared": lambda x: ratio * x,
        "stroke": lambda x: stroke * _cosine(x),
    }
    parts: list[Element] = [
        GivenMotion("q", Jet.variable),
        GivenMotion("geared", lambda q, order: Jet.variable(q, order) * ratio),
        GivenMotion("stroke", stroke_law(stroke)),
        MemberPoint("O", 0j),
        MemberPoint("O2", complex(*rng.uniform(60.0, 160.0, 2))),
        MemberPoint("D", complex(*rng.uniform(-150.0, 150.0, 2))),
        GuideLine("bed", complex(*rng.uniform(-80.0, 80.0, 2)), rng.uniform(0.0, TURN)),
        GuideLine("post", complex(*rng.uniform(-80.0, 80.0, 2)), rng.uniform(0.0, TURN)),
        Crank("crank", "q", "O", "pin", rng.uniform(15.0, 50.0), rng.uniform(0.0, TURN)),
        Crank("crank2", "geared", "O2", "pin2", rng.uniform(15.0, 50.0), rng.uniform(0.0, TURN)),
        GuideLine("slot", complex(*rng.uniform(-20.0, 20.0, 2)), rng.uniform(0.0, TURN), "crank"),
    ]
    joints, guides, last = ["pin", "pin2", "D"], ["bed", "post", "slot"], ["pin"]
    for number in range(int(rng.integers(1, 5))):
        dyad = _dyad(rng, number, parts, (joints, guides, last))
        parts += [dyad, *_points(rng, number, dyad)]
        joints += [dyad.joint, f"M{number}"]
        guides.append(f"way{number}")
        last = [dyad.joint, f"M{number}"]
        try:
            settled(Linkage(in_order(parts), np.array([0.0, TURN])))
        except NotClosingError:
            break
    return Drawn(Linkage(in_order(parts), np.array([0.0, TURN])), ways)


def _cosine(x: Any) -> Any:
    from mpmath import mp

    return mp.cos(x)


def _points(rng: Random, number: int, dyad: Dyad) -> list[Element]:
    """A point and a guide on members of a dyad."""
    one, two = rng.permutation(dyad.members)
    return [
        MemberPoint(f"M{number}", complex(*rng.uniform(-60.0, 60.0, 2)), str(one)),
        GuideLine(f"way{number}", complex(*rng.uniform(-30.0, 30.0, 2)), 1.0, str(two)),
    ]


def _dyad(rng: Random, number: int, parts: list[Element], names: tuple[list[str], ...]) -> Dyad:
    """A dyad at what there is, sized so that it mostly closes."""
    joints, guides, last = names
    kind = str(rng.choice(sorted(DYADS)))
    ends: list[str] = []
    for guided in DYADS[kind].guides:
        pool = guides if guided else last if not ends else joints
        if kind == "TRT":  # guides that turn against each other are once parallel
            pool = pool[:2] if rng.uniform() < 0.8 else pool
        ends.append(str(rng.choice([name for name in pool if name not in ends])))
    driven = "stroke" if kind == "RRR" and rng.uniform() < 0.2 else None
    dyad = Dyad(
        kind,
        ends[0],
        ends[1],
        f"B{number}",
        (f"one{number}", f"two{number}"),
        Lengths(*rng.uniform(10.0, 90.0, 2), *_turns(rng)),
        float(rng.choice([-1.0, 1.0])),
        driven,
        str(rng.choice(["branch", "motion"])),
    )
    known = Linkage(in_order(parts), np.array([0.0, TURN])).at(_PLACES, 0)
    return replace(dyad, lengths=_sized(rng, dyad, known))


def _turns(rng: Random) -> Array:
    """Angles of members to each other and to guides, neither along nor far."""
    return rng.uniform(0.3, 1.3, 3) * rng.choice([-1.0, 1.0], 3)


def _sized(rng: Random, dyad: Dyad, known: Known) -> Lengths:
    """Lengths that mostly close between the ends that a dyad has."""
    lengths, spare = dyad.lengths, rng.uniform(-0.1, 0.6)
    if dyad.type == "RRR":
        far = np.abs(place(known, dyad.second) - place(known, dyad.first))
        whole = far.max() * (1.0 + spare) + (10.0 if dyad.driven else 0.0)
        apart = far.min() * rng.uniform(-1.05, 1.05)
        return lengths._replace(first=0.5 * (whole + apart), second=0.5 * (whole - apart))
    if dyad.type in ("RRT", "TRR"):
        (off,) = offsets(dyad, known)
        rod = max(off.max() * (1.0 + spare), 1.0)
        return lengths._replace(**{"first" if dyad.type == "RRT" else "second": rod})
    if dyad.type in ("RTR1", "RTR2"):
        far = np.abs(place(known, dyad.second) - place(known, dyad.first))
        arm = max(far.min() / abs(np.sin(lengths.beta)) * rng.uniform(0.0, 1.2), 1.0)
        return lengths._replace(**{"second" if dyad.type == "RTR1" else "first": arm})
    return lengths


def place(known: Known, name: str) -> Array:
    """Where a joint is."""
    return np.asarray(known.jet(name).c[0])


def line(known: Known, name: str) -> tuple[Array, Array]:
    """Origin and direction of a member or a guide."""
    frame = known.frame(name)
    return np.asarray(frame.origin.c[0]), np.asarray(frame.direction.c[0])


def lengths_of(dyad: Dyad, known: Known) -> tuple[Any, Any]:
    """Both lengths, with the way of a cylinder."""
    first: Any = dyad.lengths.first
    if dyad.driven is not None:
        first = first + np.real(place(known, dyad.driven))
    return first, dyad.lengths.second


def offsets(dyad: Dyad, known: Known) -> list[Array]:
    """Distance of a rod's outer joint from the line on which its other joint runs."""
    arm: Any
    ends, arm, turn = (dyad.first, dyad.second), dyad.lengths.second, dyad.lengths.gamma2
    if dyad.type == "TRR":
        ends, turn = ends[::-1], dyad.lengths.gamma1
        arm = dyad.lengths.first
    origin, way = line(known, ends[1])
    foot = origin + arm * way * np.exp(1j * turn)
    return [np.abs(np.imag((place(known, ends[0]) - foot) * way.conj()))]


def margin(dyad: Dyad, known: Known) -> Array:
    """What a dyad has left before it opens, from triangles: negative where it is open."""
    first, second = lengths_of(dyad, known)
    if dyad.type in ("RRT", "TRR"):
        return (first if dyad.type == "RRT" else second) - offsets(dyad, known)[0]
    if dyad.type == "TRT":
        ways = [line(known, name)[1] for name in (dyad.first, dyad.second)]
        return np.abs(np.imag(ways[0].conj() * ways[1]))
    if dyad.type in ("RTT", "TTR"):
        return np.ones_like(known.q)
    far = np.abs(place(known, dyad.second) - place(known, dyad.first))
    if dyad.type == "RRR":
        return np.minimum(first + second - far, far - np.abs(first - second))
    arm = second if dyad.type == "RTR1" else first
    return far - abs(arm * np.sin(dyad.lengths.beta))


def misfit(dyad: Dyad, known: Known) -> Array:
    """Largest amount by which lengths, angles and places on guides are missed, of the size."""
    joint, sizes = place(known, dyad.joint), dyad.lengths
    slides: dict[str, Any] = {
        name: np.real(place(known, f"{dyad.joint}.{name}")) for name in dyad.kind.slides
    }
    misses, size, directions = [], np.abs(joint), []
    for number, (end, own) in enumerate(
        zip((dyad.first, dyad.second), lengths_of(dyad, known), strict=True), start=1
    ):
        origin, direction = line(known, dyad.members[number - 1])
        length: Any = slides.get(f"member{number}", own)
        if f"guide{number}" in slides:
            start, way = line(known, end)
            begin = start + way * slides[f"guide{number}"]
            turn = np.exp(1j * (sizes.gamma1, sizes.gamma2)[number - 1])
            misses.append(100.0 * (direction - way * turn))
        else:
            begin = place(known, end)
        misses += [origin - begin, begin + direction * length - joint]
        misses.append(100.0 * (np.abs(direction) - 1.0))
        size = size + np.abs(begin) + np.abs(length)
        directions.append(direction)
    if dyad.type in ("RTR1", "RTR2", "RTT", "TTR"):
        misses.append(100.0 * (directions[1] - directions[0] * np.exp(1j * sizes.beta)))
    return np.max(np.abs(misses), axis=0) / (size + 100.0)


def side(dyad: Dyad, known: Known) -> Array:
    """On which side of its change points a dyad is, by the definition of its sign."""
    ends, sizes = (dyad.first, dyad.second), dyad.lengths
    joint = place(known, dyad.joint)
    if dyad.type == "RRR":
        first, second = (place(known, name) for name in ends)
        return np.imag((second - first).conj() * (joint - first))
    if dyad.type in ("RRT", "TRR"):
        begin, guide = ends if dyad.type == "RRT" else ends[::-1]
        return np.real(line(known, guide)[1].conj() * (joint - place(known, begin)))
    arm: Any
    number, arm = ("1", sizes.second) if dyad.type == "RTR1" else ("2", sizes.first)
    slide = np.real(place(known, f"{dyad.joint}.member{number}"))
    return slide - arm * np.cos(sizes.beta)


def with_lengths(linkage: Linkage, dyad: Dyad, lengths: dict[int, float]) -> tuple[Linkage, Dyad]:
    """The linkage with other lengths of a dyad, and that dyad."""
    named = {("first", "second")[number]: length for number, length in lengths.items()}
    other = replace(dyad, lengths=dyad.lengths._replace(**named))
    parts: Sequence[Element] = [other if one is dyad else one for one in linkage.elements]
    return replace(linkage, elements=tuple(parts)), other
