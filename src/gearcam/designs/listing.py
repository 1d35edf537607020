"""The laws for ``gearcam laws``, with their keys."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from gearcam.designs.faults import description
from gearcam.designs.kind import KINDS
from gearcam.designs.nodes import Choice, Either, Keys, choices_in
from gearcam.designs.table import Table
from gearcam.laws.entry import SOURCES


@dataclass(frozen=True, kw_only=True)
class Listed:
    """A law in the list.

    Parameters
    ----------
    name, doc : str
        Name and description.
    line : str
        The line that selects it in a design file.
    rows : tuple of (str, str)
        Keys with their meanings, then continuity and source.
    """

    name: str
    doc: str
    line: str
    rows: tuple[tuple[str, str], ...]


def law_groups() -> Iterator[tuple[str, list[Listed]]]:
    """Yield a heading and the laws of each kind of design; those of several kinds once."""
    found: dict[str, list[Listed]] = {}
    seen: list[Mapping[str, Any]] = []
    for kind in KINDS.values():
        for title, node in kind.nodes.items():
            for one in choices_in(node):
                if one.listing and one.listing not in found:
                    again = any(one.entries is other for other in seen)
                    key = one.tag if isinstance(node, Either) else f"{title}.{one.tag}"
                    found[one.listing] = [] if again else [*_listed(one, key)]
                    seen.append(one.entries)
    yield from found.items()


def _listed(choice: Choice, key: str) -> Iterator[Listed]:
    for name, entry in choice.entries.items():
        node = choice.node(name)
        if isinstance(node, Keys):
            yield listed(entry, f'{key} = "{name}"', node.table)


def sources_of(groups: Iterable[tuple[str, list[Listed]]]) -> dict[str, str]:
    """Return the texts that the laws of all `groups` cite, by the authors named in citations."""
    cited = [dict(law.rows)["source"] for _, laws in groups for law in laws]
    return {name: text for name, text in SOURCES.items() if any(name in one for one in cited)}


def listed(entry: Any, line: str, table: Table) -> Listed:
    """Return the list entry of a law from its `entry`, its `line` and the `table` of its keys."""
    keys = ((key, description(item)) for key, item in table.entries.items())
    rows = (*keys, ("continuity", entry.continuity), ("source", entry.source))
    return Listed(name=entry.name, doc=entry.doc, line=line, rows=rows)
