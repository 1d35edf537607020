"""What loads, masses and springs act on: whether their keys suit it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from gearcam.designs.faults import Fault, show
from gearcam.kinds.mechanism import names
from gearcam.kinds.mechanism.name_keys import JOINT, MEMBER, SHAFT, WAY
from gearcam.linkages.elements import GROUND

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.kinds.mechanism.load_tables import MachineLoad, MachineSpring, MemberMass

Parts = Mapping[str, Sequence[Any]]
Path = tuple[str, int]

_TURNS: Final = (MEMBER, SHAFT)
"""What a torque acts on."""


def pushed_in(parts: Parts) -> tuple[Any, ...]:
    """Return the tables of members that are pushed or lifted, which have a name and a joint.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.
    """
    return (*parts.get("slide", ()), *parts.get("hoist", ()))


def sorts_of(parts: Parts) -> dict[str, str]:
    """Return what each name of a mechanism is to a load: a joint, a member, a shaft, or a slide.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.

    Returns
    -------
    dict of str to str
        A slide is a joint that slides along a guide, a member that a drive pushes and its joint,
        or what pushes it.
    """
    found = {GROUND: MEMBER} | {one.name: one.sort for one in names.given(parts)}
    joints = [one.joint for one in parts.get("dyad", ()) if names.moves(one)]
    pushed = [name for one in pushed_in(parts) for name in (one.name, one.joint)]
    return found | dict.fromkeys([*joints, *pushed], WAY)


def unturned(parts: Parts) -> dict[str, str]:
    """Return the members that keep their direction on a guide, each with a joint that has its way.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.
    """
    slides = {"RRT": 1, "TRR": 0}
    found = {
        one.members[slides[one.type]]: one.joint
        for one in parts.get("dyad", ())
        if one.type in slides
    }
    return found | {one.name: one.joint for one in pushed_in(parts)}


def problems(found: Examined, told: Iterable[Fault]) -> Iterator[Fault]:
    """Yield keys of loads, masses and springs that do not suit what they act on.

    Parameters
    ----------
    found : Examined
        The valid tables.
    told : iterable of Fault
        Of names: nothing more is said of their tables.
    """
    parts = found.parts
    vain = list(_in_vain(parts))
    yield from vain
    sorts, still = sorts_of(parts), unturned(parts)
    wrong = {one.path[:2] for one in (*found.faults, *told, *vain)}
    wrong |= {one.path[:2] for one in names.needed(parts) if one.name not in sorts}
    ways = {one.name for one in names.given(parts) if one.sort == WAY}
    for title in ("load", "mass", "spring"):
        for number, one in enumerate(parts.get(title, ())):
            path = (title, number)
            if path in wrong:
                continue
            if title == "load":
                yield from _of_load(one, sorts[one.on], one.on in ways, path)
            elif title == "mass":
                yield from _of_mass(one, sorts[one.of], one.of in still, path)
            else:
                yield from _of_spring(one, sorts, path)


def _in_vain(parts: Parts) -> Iterator[Fault]:
    """Yield loads and masses of what stands still."""
    standing = {GROUND, *(one.name for one in parts.get("joint", ()))}
    for title, key in (("load", "on"), ("mass", "of")):
        for number, one in enumerate(parts.get(title, ())):
            name = getattr(one, key)
            if name in standing:
                what = f"{show(name)} stands still: what acts on it does no work"
                yield Fault((title, number, key), what, name, "the name of what moves")


def _of_load(load: MachineLoad, sort: str, driven: bool, path: Path) -> Iterator[Fault]:
    if driven and load.has_direction:
        what = f"acts on {load.on}, which moves along its own way only"
        allowed = "force_n of one value, or a joint or point"
        yield Fault((*path, "on"), what, load.on, allowed)
    if sort in _TURNS:
        keys = (("force", "force_n"), ("direction", "direction_deg"), ("way", "at_mm"))
        for name, key in keys:
            if getattr(load, name) is not None:
                what = f"acts on {load.on}, which is a {sort}"
                yield Fault((*path, key), what, allowed="torque_nm, or a joint, point or slide")
    elif load.torque is not None:
        what = f"acts on {load.on}, which is a {sort}"
        yield Fault((*path, "torque_nm"), what, allowed="force_n, or a member or shaft")
    elif sort == JOINT and not load.has_direction:
        what = f"has no direction, and {load.on} slides along no guide"
        yield Fault((*path, load.key), what, allowed="direction_deg, or force_n = [x, y]")
    if sort != WAY and load.travel is not None:
        what = f"is of {load.on}, which slides along no guide"
        yield Fault((*path, "travel_mm"), what, load.travel, "from_deg and to_deg")


def _of_mass(mass: MemberMass, sort: str, still: bool, path: Path) -> Iterator[Fault]:
    placed = mass.center is not None or mass.at is not None
    if sort == SHAFT and mass.mass is not None:
        what = "does not count for a shaft: its centre stands still"
        yield Fault((*path, "mass_kg"), what, allowed="inertia_kg_m2")
    elif mass.mass is not None and not placed and not still:
        what = f"{mass.of} turns, and its centre of mass is not given"
        yield Fault(path, what, allowed="center or at_mm beside mass_kg")


def _of_spring(spring: MachineSpring, sorts: Mapping[str, str], path: Path) -> Iterator[Fault]:
    if spring.between is not None:
        ends, key, wanted = spring.between, "between", "two joints, or two members"
    else:
        ends, key, wanted = (spring.on or "",), "on", "a slide, a member or a shaft"
    turns = {sorts[name] in _TURNS for name in ends}
    if len(turns) > 1:
        yield Fault((*path, key), "joins a joint to a member", list(ends), wanted)
    elif key == "on" and sorts[ends[0]] == JOINT:
        yield Fault((*path, key), "slides along no guide", ends[0], wanted)
    elif turns == {True} and spring.straight:
        what = "has the keys of a straight spring about an angle"
        yield Fault((*path, key), what, list(ends), "stiffness_nm_rad, or two joints")
    elif turns == {False} and spring.angular:
        what = "has the keys of a spring about an angle along a line"
        yield Fault((*path, key), what, list(ends), "stiffness_n_mm, or two members")
