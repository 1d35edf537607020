"""What may be asked of a mechanism: the quantities that its names stand for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

from gearcam.designs.faults import Fault, show
from gearcam.designs.slips import did_you_mean, nearest
from gearcam.kinds.mechanism import names
from gearcam.kinds.mechanism.asked import Amount, Output, coordinates
from gearcam.kinds.mechanism.keys import Sort

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.designs.lines import Path

Known = dict[str, tuple[Output, ...]]


class OutputNames:
    """What may be asked of a mechanism, by name.

    Parameters
    ----------
    tables : mapping of str to tables
        By title.
    """

    def __init__(self, tables: names.Tables) -> None:
        self.tables = tables
        self.parts = [part for _, _, part in names.told_parts(tables)]

    @cached_property
    def known(self) -> Known:
        """All that may be asked for: a point has two coordinates, each of which has two names."""
        found = dict(self.whole)
        for joint in self.joints:
            for one in coordinates(joint):
                alone = (one._replace(name=one.quantity),)
                found.setdefault(one.quantity, alone)
                found.setdefault(one.stem, alone)
        return found

    @cached_property
    def whole(self) -> Known:
        """What may be asked for, but for single coordinates."""
        found: Known = {}
        for part in self.parts:
            found |= part.outputs()
        for joint in self.joints:
            found.setdefault(joint, coordinates(joint))
        for one in (use for part in self.parts for use in part.given() if use.turns):
            name = f"{one.name}.angle"
            found[name] = (Output(name, one.name, name, True),)
        for drive in self.tables.get("drive", ()):
            for word, sort in drive.shafts.items():
                name = f"{drive.name}.{word}"
                found[name] = (Output(name, name.replace(".", "_"), name, sort == Sort.SHAFT),)
        return found

    @cached_property
    def joints(self) -> list[str]:
        """The joints that move."""
        uses = names.given(self.tables)
        return [one.name for one in uses if one.sort == Sort.JOINT and not one.still]

    @property
    def usual(self) -> list[str]:
        """What is given where a design does not say: slides and points, else a direction."""
        last = {type(part): part for part in self.parts}
        found = [one for part in self.parts for one in part.usual(last=part is last[type(part)])]
        first = min((rank for rank, _ in found), default=0)
        master = self.tables.get("drive", ())[:1]
        return [name for rank, name in found if rank == first] or [
            f"{one.name}.{word}" for one in master for word in [*one.shafts][-1:]
        ]

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
        if any(name in part.standing for part in self.parts):
            return f"{name} stands still"
        owners = [one.rpartition(".")[0] for one in self.whole if "." in one]
        hint = "" if name in owners else did_you_mean(name, self.whole)
        meant = nearest(name, owners)
        below = [one for one in self.whole if one.startswith(f"{meant}.") and meant]
        return hint or (f"did you mean {' or '.join(below)}?" if below else "")


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
    for title, number, one in names.several(found.parts):
        if isinstance(one, Amount) and one.on not in outputs.known:
            yield outputs.unknown((title, number, "on"), one.on)
        elif isinstance(one, Amount):
            yield from _of_amount(one, outputs.known[one.on], (title, number), document)
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
    one: Amount, known: Sequence[Output], path: tuple[str, int], document: Mapping[str, Any]
) -> Iterator[Fault]:
    """Yield what is wrong in a table about one output, which gives an amount of it."""
    if len(known) > 1:
        what = f"{show(one.on)} is a point, with two coordinates"
        yield Fault((*path, "on"), what, one.on, " or ".join(one.quantity for one in known))
    elif (getattr(one, one.word) is None) != known[0].angle:
        wrong, right = ("mm", "deg") if known[0].angle else ("deg", "mm")
        what = f"{one.on} is {'an angle' if known[0].angle else 'a length'}"
        key = f"{one.word}_{wrong}"
        yield Fault((*path, key), what, document[path[0]][path[1]].get(key), f"{one.word}_{right}")


def _of_stretches(outputs: OutputNames, asked: Sequence[str] | None) -> Iterator[Fault]:
    """Yield stretches of what is no point that is asked for."""
    points = paths_asked(outputs.asked(asked))
    for number, one in enumerate(outputs.tables.get("stretch", ())):
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
