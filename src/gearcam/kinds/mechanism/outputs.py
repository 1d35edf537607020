"""What may be asked of a mechanism: the quantities that its names stand for."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from gearcam.designs.faults import Fault, show
from gearcam.designs.slips import did_you_mean
from gearcam.kinds.mechanism import names
from gearcam.kinds.mechanism.names import JOINT, WAY, moves

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined

Parts = Mapping[str, Sequence[Any]]

_DEG: Final = math.degrees(1.0)

UNKNOWN: Final = "nothing moves by this name"
"""What is wrong with a name that is no output."""

AMOUNTS: Final = {"interval": "travel", "dwell": "within"}
"""The amount that a table about one output gives."""

RATES: Final = ("velocity", "acceleration", "jerk")
"""Names of the derivatives."""


class Output(NamedTuple):
    """A quantity whose motion is asked for.

    Attributes
    ----------
    name : str
        As in ``output.outputs``.
    stem : str
        Beginning of its columns.
    quantity : str
        Its name in the linkage (see `Linkage.track`).
    angle : bool
        Whether it is an angle; else a length.
    """

    name: str
    stem: str
    quantity: str
    angle: bool

    @property
    def unit(self) -> tuple[float, str]:
        """Factor to its unit in output, and that unit."""
        return (_DEG, "deg") if self.angle else (1.0, "mm")

    @property
    def rate_unit(self) -> str:
        """Unit of its velocity but for the time."""
        return "rad" if self.angle else "mm"


Known = dict[str, tuple[Output, ...]]


def parts_of(design: Any) -> dict[str, Sequence[Any]]:
    """Return the tables of a mechanism's `design` that give or need names, by title."""
    return {title: getattr(design, title) for title in names.PARTS}


def known_outputs(parts: Parts) -> Known:
    """Return all that may be asked for, by name: a point has two coordinates.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.
    """
    found = _named(parts)
    for joint in _moving(parts):
        for one in _coordinates(joint):
            alone = (one._replace(name=one.quantity),)
            found.setdefault(one.quantity, alone)
            found.setdefault(one.stem, alone)
    return found


def _named(parts: Parts) -> Known:
    """Return what may be asked for, but for single coordinates."""
    found: Known = {}
    for dyad in parts.get("dyad", ()):
        place = Output(dyad.joint, dyad.joint, moves(dyad), False)
        found[dyad.joint] = (place,) if moves(dyad) else _coordinates(dyad.joint)
    for slide in parts.get("slide", ()):
        found[slide.name] = (Output(slide.name, slide.name, slide.on, False),)
    for hoist in parts.get("hoist", ()):
        found[hoist.name] = (Output(hoist.name, hoist.name, f"{hoist.name}.way", False),)
    for wheel in parts.get("geneva", ()):
        name = f"{wheel.name}.turn"
        found[name] = (Output(name, wheel.name, name, True),)
    for joint in _moving(parts):
        found.setdefault(joint, _coordinates(joint))
    for name in _turning(parts):
        found[f"{name}.angle"] = (Output(f"{name}.angle", name, f"{name}.angle", True),)
    for drive in parts.get("drive", ()):
        for word in drive.shafts:
            name = f"{drive.name}.{word}"
            along = names.sort_of(drive, word) == WAY
            found[name] = (Output(name, name.replace(".", "_"), name, not along),)
    return found


def _coordinates(name: str) -> tuple[Output, ...]:
    return tuple(Output(name, f"{name}_{part}", f"{name}.{part}", False) for part in "xy")


def _moving(parts: Parts) -> list[str]:
    """Return the joints that move."""
    return [one.name for one in names.given(parts) if one.sort == JOINT and one.path[0] != "joint"]


def _turning(parts: Parts) -> list[str]:
    """Return the members that have a direction of their own."""
    members = [name for one in parts.get("dyad", ()) for name in one.members]
    members += [one.name for one in parts.get("crank", ())]
    return members + [one.lever for one in parts.get("chain", ())]


def usual_outputs(parts: Parts) -> list[str]:
    """Return what is given where a design does not say: slides and points, else a direction.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.
    """
    dyads, chains, cranks = (parts.get(title, ()) for title in ("dyad", "chain", "crank"))
    slides = [one.joint for one in dyads if moves(one)]
    pushed = (one for title in ("slide", "hoist", "point") for one in parts.get(title, ()))
    found = [*slides, *(one.name for one in pushed)]
    last = [one.members[1] for one in dyads[-1:]] + [one.lever for one in chains]
    turns = [f"{one.name}.turn" for one in parts.get("geneva", ())]
    members = last or [] if turns else last or [one.name for one in cranks[-1:]]
    angles = [*found, *turns] or [f"{name}.angle" for name in members]
    return angles or [f"{one.name}.{one.shafts[-1]}" for one in parts.get("drive", ())[:1]]


def asked_outputs(parts: Parts, asked: Sequence[str] | None) -> tuple[Output, ...]:
    """Return what is asked for, each once.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.
    asked : sequence of str or None
        Names of outputs; None for the usual ones.
    """
    known, found = known_outputs(parts), dict[tuple[str, str], Output]()
    for name in usual_outputs(parts) if asked is None else asked:
        for one in known[name]:
            # a coordinate that is also asked for with the whole point belongs to its path
            key = one.stem, one.quantity
            if key not in found or one.quantity != one.name:
                found[key] = one
    return tuple(found.values())


def allowed_outputs(parts: Parts) -> str:
    """Return what may be asked for, as text.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.
    """
    more = "; of a joint also NAME.x and NAME.y" if _moving(parts) else ""
    return f"{', '.join(_named(parts))}{more}"


def unknown_hint(name: str, parts: Parts) -> str:
    """Return what may be meant by a name that is no output.

    Parameters
    ----------
    name : str
        The name.
    parts : mapping of str to sequence of tables
        By title.
    """
    named, joints = _named(parts), _moving(parts)
    owner = name.rpartition(".")[0]
    if owner in joints:
        gives = "its place on its guide" if len(named[owner]) == 1 else "its two coordinates"
        return f"{owner} is a joint, which has no direction: write {owner}, for {gives}"
    if name in (one.name for one in parts.get("joint", ())):
        return f"{name} stands still"
    below = [one for one in named if one.startswith(f"{name}.")]
    return f"did you mean {' or '.join(below)}?" if below else did_you_mean(name, named)


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield outputs that do not move, and what is asked of outputs that cannot have it.

    Parameters
    ----------
    document : mapping
        As read.
    found : Examined
        The valid tables; nothing is said if they do not tell all names.
    """
    if not names.complete(found):
        return
    known = known_outputs(found.parts)
    asked = found.parts["output"].outputs if "output" in found.parts else ()
    for number, name in enumerate(asked or ()):
        if name not in known:
            yield _unknown(("output", "outputs", number), name, found.parts)
    for title, word in AMOUNTS.items():
        for number, one in enumerate(found.parts.get(title, ())):
            yield from _of_amount((title, number), document, one, word, known, found.parts)
    if "output" in found.parts and known.keys() >= set(asked or ()):
        yield from _of_stretches(found.parts, asked)


def _unknown(path: tuple[str | int, ...], name: str, parts: Parts) -> Fault:
    message = f"{show(name)}: {UNKNOWN}"
    return Fault(path, message, name, allowed_outputs(parts), unknown_hint(name, parts))


def _of_amount(
    path: tuple[str, int],
    document: Mapping[str, Any],
    one: Any,
    word: str,
    known: Known,
    parts: Parts,
) -> Iterator[Fault]:
    """Yield what is wrong in a table about one output, which gives an amount of it."""
    outputs = list(known.get(one.on, ()))
    if not outputs:
        yield _unknown((*path, "on"), one.on, parts)
        return
    if len(outputs) > 1:
        what = f"{show(one.on)} is a point, with two coordinates"
        yield Fault((*path, "on"), what, one.on, " or ".join(one.quantity for one in outputs))
        return
    angle = outputs[0].angle
    if (getattr(one, word) is None) != angle:
        wrong, right = ("mm", "deg") if angle else ("deg", "mm")
        what = f"{one.on} is {'an angle' if angle else 'a length'}"
        key = f"{word}_{wrong}"
        yield Fault((*path, key), what, document[path[0]][path[1]].get(key), f"{word}_{right}")


def _of_stretches(parts: Mapping[str, Any], asked: Sequence[str] | None) -> Iterator[Fault]:
    """Yield stretches of what is no point that is asked for."""
    outputs = asked_outputs(parts, asked)
    points = list(dict.fromkeys(one.name for one in outputs if one.quantity == f"{one.name}.x"))
    for number, one in enumerate(parts.get("stretch", ())):
        if one.on not in points:
            allowed = f"a point of the outputs: {', '.join(points)}"
            hint = "add it to output.outputs" if one.on in _moving(parts) else ""
            hint = hint or did_you_mean(one.on, points)
            what = f"{show(one.on)} is not a point that is asked for"
            yield Fault(("stretch", number, "on"), what, one.on, allowed, hint)
