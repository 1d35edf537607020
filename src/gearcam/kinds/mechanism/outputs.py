"""What may be asked of a mechanism: the quantities that its names stand for."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from gearcam.designs.faults import Fault, show
from gearcam.designs.slips import did_you_mean, nearest
from gearcam.kinds.mechanism import names
from gearcam.kinds.mechanism.name_keys import JOINT, SHAFT
from gearcam.kinds.mechanism.names import moves

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.designs.lines import Path

_DEG: Final = math.degrees(1.0)

AMOUNTS: Final = {"interval": "travel", "dwell": "within"}
"""The amount that a table about one output gives."""

RATES: Final = ("velocity", "acceleration", "jerk")
"""Names of the derivatives, those in tables."""


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

    def rate_keys(self, order: int) -> tuple[str, str]:
        """Return the units of a derivative as in keys: by the master's angle, and by time."""
        power = order if order > 1 else ""
        return f"{self.rate_unit}_per_rad{power}", f"{self.rate_unit}_s{power}"


Known = dict[str, tuple[Output, ...]]


class OutputNames:
    """What may be asked of a mechanism, by name.

    Parameters
    ----------
    parts : mapping of str to tables
        By title.
    """

    def __init__(self, parts: names.Parts) -> None:
        self.parts = parts

    def _tables(self, *titles: str) -> list[Any]:
        return [one for title in titles for one in self.parts.get(title, ())]

    @cached_property
    def known(self) -> Known:
        """All that may be asked for: a point has two coordinates, each of which has two names."""
        found = dict(self.whole)
        for joint in self.joints:
            for one in _coordinates(joint):
                alone = (one._replace(name=one.quantity),)
                found.setdefault(one.quantity, alone)
                found.setdefault(one.stem, alone)
        return found

    @cached_property
    def whole(self) -> Known:
        """What may be asked for, but for single coordinates."""
        found: Known = {}
        for dyad in self._tables("dyad"):
            place = Output(dyad.joint, dyad.joint, moves(dyad), False)
            found[dyad.joint] = (place,) if moves(dyad) else _coordinates(dyad.joint)
        for slide in self._tables("slide"):
            found[slide.name] = (Output(slide.name, slide.name, slide.on, False),)
        for hoist in self._tables("hoist"):
            found[hoist.name] = (Output(hoist.name, hoist.name, f"{hoist.name}.way", False),)
        for wheel in self._tables("geneva"):
            name = f"{wheel.name}.turn"
            found[name] = (Output(name, wheel.name, name, True),)
        for joint in self.joints:
            found.setdefault(joint, _coordinates(joint))
        for member in self._turning:
            name = f"{member}.angle"
            found[name] = (Output(name, member, name, True),)
        for drive in self._tables("drive"):
            for word, sort in drive.shafts.items():
                name = f"{drive.name}.{word}"
                found[name] = (Output(name, name.replace(".", "_"), name, sort == SHAFT),)
        return found

    @cached_property
    def joints(self) -> list[str]:
        """The joints that move."""
        uses = names.given(self.parts)
        return [one.name for one in uses if one.sort == JOINT and one.path[0] != "joint"]

    @property
    def _turning(self) -> list[str]:
        """The members that have a direction of their own."""
        members = [name for one in self._tables("dyad") for name in one.members]
        members += [one.name for one in self._tables("crank")]
        return members + [one.lever for one in self._tables("chain")]

    @property
    def usual(self) -> list[str]:
        """What is given where a design does not say: slides and points, else a direction."""
        dyads, chains = self._tables("dyad"), self._tables("chain")
        found = [one.joint for one in dyads if moves(one)]
        found += [one.name for one in self._tables("slide", "hoist", "point")]
        found += [f"{one.name}.turn" for one in self._tables("geneva")]
        last = [one.members[1] for one in dyads[-1:]] + [one.lever for one in chains]
        last = last or [one.name for one in self._tables("crank")[-1:]]
        drives = self._tables("drive")[:1]
        return (
            found
            or [f"{name}.angle" for name in last]
            or [f"{one.name}.{word}" for one in drives for word in [*one.shafts][-1:]]
        )

    def asked(self, asked: Sequence[str] | None) -> tuple[Output, ...]:
        """Return what is asked for, each once.

        Parameters
        ----------
        asked : sequence of str or None
            Names of outputs; None for the usual ones.
        """
        found = dict[tuple[str, str], Output]()
        for name in self.usual if asked is None else asked:
            for one in self.known[name]:
                # a coordinate that is also asked for with the whole point belongs to its path
                key = one.stem, one.quantity
                if key not in found or one.quantity != one.name:
                    found[key] = one
        return tuple(found.values())

    def unknown(self, path: Path, name: str) -> Fault:
        """Return that nothing moves by a name, what does, and what may be meant.

        Parameters
        ----------
        path : tuple
            Where the name stands.
        name : str
            The name.
        """
        more = "; of a joint also NAME.x and NAME.y" if self.joints else ""
        allowed = f"{', '.join(self.whole)}{more}"
        message = f"{show(name)}: nothing moves by this name"
        return Fault(path, message, name, allowed, self._hint(name))

    def _hint(self, name: str) -> str:
        """Return what may be meant by a name that is no output."""
        owner = name.rpartition(".")[0]
        if owner in self.joints:
            gives = (
                "its place on its guide" if len(self.whole[owner]) == 1 else "its two coordinates"
            )
            return f"{owner} is a joint, which has no direction: write {owner}, for {gives}"
        if name in (one.name for one in self._tables("joint")):
            return f"{name} stands still"
        owners = [one.rpartition(".")[0] for one in self.whole if "." in one]
        hint = "" if name in owners else did_you_mean(name, self.whole)
        meant = nearest(name, owners)
        below = [one for one in self.whole if one.startswith(f"{meant}.") and meant]
        return hint or (f"did you mean {' or '.join(below)}?" if below else "")


def _coordinates(name: str) -> tuple[Output, ...]:
    return tuple(Output(name, f"{name}_{part}", f"{name}.{part}", False) for part in "xy")


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
    outputs = OutputNames(found.parts)
    for title, word in AMOUNTS.items():
        for number, one in enumerate(found.parts.get(title, ())):
            path = (title, number)
            if one.on in outputs.known:
                yield from _of_amount(one, word, outputs.known[one.on], path, document)
            else:
                yield outputs.unknown((*path, "on"), one.on)
    if "output" not in found.parts:
        return
    asked = found.parts["output"].outputs
    unknown = [
        outputs.unknown(("output", "outputs", number), name)
        for number, name in enumerate(asked or ())
        if name not in outputs.known
    ]
    yield from unknown or _of_stretches(outputs, asked)


def _of_amount(
    one: Any, word: str, known: Sequence[Output], path: tuple[str, int], document: Mapping[str, Any]
) -> Iterator[Fault]:
    """Yield what is wrong in a table about one output, which gives an amount of it."""
    if len(known) > 1:
        what = f"{show(one.on)} is a point, with two coordinates"
        yield Fault((*path, "on"), what, one.on, " or ".join(one.quantity for one in known))
    elif (getattr(one, word) is None) != known[0].angle:
        wrong, right = ("mm", "deg") if known[0].angle else ("deg", "mm")
        what = f"{one.on} is {'an angle' if known[0].angle else 'a length'}"
        key = f"{word}_{wrong}"
        yield Fault((*path, key), what, document[path[0]][path[1]].get(key), f"{word}_{right}")


def _of_stretches(outputs: OutputNames, asked: Sequence[str] | None) -> Iterator[Fault]:
    """Yield stretches of what is no point that is asked for."""
    points = paths_asked(outputs.asked(asked))
    for number, one in enumerate(outputs.parts.get("stretch", ())):
        if one.on not in points:
            allowed = f"a point of the outputs: {', '.join(points)}"
            hint = "add it to output.outputs" if one.on in outputs.joints else ""
            hint = hint or did_you_mean(one.on, points)
            what = f"{show(one.on)} is not a point that is asked for"
            yield Fault(("stretch", number, "on"), what, one.on, allowed, hint)


def paths_asked(outputs: Sequence[Output]) -> list[str]:
    """Return the points of which both coordinates are asked for, by name.

    Parameters
    ----------
    outputs : sequence of Output
        What is asked for.
    """
    return list(dict.fromkeys(one.name for one in outputs if one.quantity == f"{one.name}.x"))
