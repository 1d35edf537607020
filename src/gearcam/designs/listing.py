"""The laws that a design can name, each with what it asks for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from gearcam.designs.faults import description
from gearcam.designs.kind import KINDS
from gearcam.designs.table import Table
from gearcam.laws.sources import SOURCES


@dataclass(frozen=True, kw_only=True)
class Listed:
    """A law as it is shown.

    Parameters
    ----------
    name, doc : str
        Of its entry.
    line : str
        How a design file names it.
    rows : tuple of (str, str)
        Its keys, then continuity and source, with what they mean.
    """

    name: str
    doc: str
    line: str
    rows: tuple[tuple[str, str], ...]


def law_groups() -> Iterator[tuple[str, list[Listed]]]:
    """Yield the laws of each kind of design below a heading."""
    for kind in filter(lambda kind: kind.main, KINDS.values()):
        yield kind.room("describe").laws()


def sources_of(groups: Iterable[tuple[str, list[Listed]]]) -> dict[str, str]:
    """Return the texts that the laws of all `groups` cite, by the authors named in citations."""
    cited = [dict(law.rows)["source"] for _, laws in groups for law in laws]
    return {name: text for name, text in SOURCES.items() if any(name in one for one in cited)}


def listed(entry: Any, line: str, known: Table) -> Listed:
    """Return a law as it is shown: its `entry`, the `line` that names it, its `known` keys."""
    keys = ((key, description(item)) for key, item in known.entries.items())
    rows = (*keys, ("continuity", entry.continuity), ("source", entry.source))
    return Listed(name=entry.name, doc=entry.doc, line=line, rows=rows)
