"""What other installed packages bring: entry points of a group, by name.

    [project.entry-points."gearcam.ratio_laws"]        a `LawEntry` of `gearcam.laws.ratio`
    [project.entry-points."gearcam.motion_laws"]       a `LawEntry` of `gearcam.laws.motion`
    [project.entry-points."gearcam.gear_pair.formats"]    a `FileMaker` of `gearcam.results.kind`
    [project.entry-points."gearcam.gear_pair.studies"]    a `Study` of `gearcam.results`
    [project.entry-points."gearcam.mechanism.parts"]      a `MachinePart` or `MachineAction`

Formats and studies are those of one kind of design, here of gear pairs. Names known here come
first: looking for entry points takes 30 ms, so it is left out until a name is not known or a list
is asked for. Then names are compared, and nothing is loaded but what is used.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from gearcam.base.display import cut
from gearcam.base.errors import DesignError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


def group_of(kind: str, what: str) -> str:
    """Return the group of what is brought for a `kind` of design: ``formats``, ``studies``."""
    return f"{kind.replace('-', '_')}.{what}"


@cache
def every_entry_point() -> Any:  # its class differs between versions of Python
    """Return the entry points of all installed packages; looking through them takes long."""
    from importlib.metadata import entry_points

    return entry_points()


def brought(group: str) -> Mapping[str, EntryPoint]:
    """Return the entry points of a `group`, without ``gearcam.``, by name; none is loaded."""
    if not group:
        return {}
    return {one.name: one for one in every_entry_point().select(group=f"gearcam.{group}")}


def load_brought(group: str, name: str) -> Any:
    """Return what a package brings.

    Parameters
    ----------
    group : str
        The group, see `brought`.
    name : str
        The name of its entry point.

    Returns
    -------
    object

    Raises
    ------
    KeyError
        If there is no such name.
    DesignError
        If its package cannot be loaded.
    """
    point = brought(group)[name]
    try:
        return point.load()
    except Exception as error:  # other people's code may raise anything
        package = point.dist.name if point.dist else point.module
        message = f"{type(error).__name__}: {error}"
        message = f"the package {package} brings it, but cannot be loaded ({message})"
        raise DesignError.of(message, key=name) from error


class Extensible(Collection[str]):
    """Names known here, then those that packages bring in a `group` (see `brought`)."""

    _group: str

    def _known(self) -> Collection[str]:
        """Return the names known here."""
        raise NotImplementedError

    def __contains__(self, name: object) -> bool:
        return name in self._known() or name in brought(self._group)

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*self._known(), *brought(self._group))))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __bool__(self) -> bool:
        return bool(self._known()) or len(self) > 0


class Words(Extensible):
    """The words that a key may be.

    Parameters
    ----------
    known : collection of str
        The words known here.
    group : str
        Group of those that packages bring.
    """

    def __init__(self, known: Collection[str], group: str) -> None:
        self._words = tuple(known)
        self._group = group

    def __repr__(self) -> str:
        return cut(f"<{type(self).__name__} {', '.join(self._words)}>")

    def _known(self) -> Collection[str]:
        return self._words
