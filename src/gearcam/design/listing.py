"""The laws that a design can name, each with what it asks for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gearcam.design.gear_pair import law_table
from gearcam.design.models import description
from gearcam.design.motion import rise_table
from gearcam.design.tables import Table
from gearcam.laws.entry import LawEntry
from gearcam.laws.ratio.base import LAWS
from gearcam.laws.rises.base import RISES


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
    ratios = [
        _listed(entry, f'law.type = "{name}"', law_table(name)) for name, entry in LAWS.items()
    ]
    yield "Laws of gear pairs: the ratio, in the table [law]", ratios
    lifts = [_listed(entry, f'law = "{name}"', rise_table(name)) for name, entry in RISES.items()]
    yield "Laws of cams: rises and returns, in the tables [[motion]]", lifts


def _listed(entry: LawEntry, line: str, known: Table) -> Listed:
    keys = ((key, description(item)) for key, item in known.entries.items())
    rows = (*keys, ("continuity", entry.continuity), ("source", entry.source))
    return Listed(name=entry.name, doc=entry.doc, line=line, rows=rows)
