"""The table of variants: a row for each fact, a column for each variant."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.facts import NamedFact, lined_up, told_alike
from gearcam.base.inches import UNITS, told
from gearcam.compare.variants import Variant
from gearcam.console import wrapped

_SEVERITIES = ("error", "warning", "note")

_CELL = 40
"""Largest length of a value in the printed table, characters."""


@dataclass(frozen=True, kw_only=True)
class Row(ShortRepr):
    """A row of the table: one fact of all variants.

    Parameters
    ----------
    name, meaning : str
        Name and label of the fact.
    cells : tuple of str
        Values with units, one for each variant that can be made; empty without a value.
    limit : str
        The limit, if it is the same for all.
    """

    name: str
    meaning: str
    cells: tuple[str, ...]
    limit: str = ""

    @property
    def differs(self) -> bool:
        """Whether the displayed values differ."""
        return len({*self.cells}) > 1


def units_of(variants: Sequence[Variant]) -> str:
    """Return the units in which variants that can be made are compared: inches if all have them."""
    units = {one.result.design.files_in for one in variants if one.refusal is None}
    return min(units, key=UNITS.index)


def rows(variants: Sequence[Variant], *, every: bool = False) -> tuple[Row, ...]:
    """Return the table of variants.

    Parameters
    ----------
    variants : sequence of Variant
        Variants; those that cannot be made are left out.
    every : bool
        Whether to include all facts, not only those that are always shown.

    Returns
    -------
    tuple of Row
        Facts in order, then the codes of findings by severity.
    """
    results = [one.result for one in variants if one.refusal is None]
    if not results:
        return ()
    told_of = [told(one.facts, units_of(variants)) for one in results]
    columns = [
        {fact.name: fact for fact in (one.quantities() if every else one.leading())}
        for one in told_of
    ]
    names = dict.fromkeys(name for facts in columns for name in facts)
    findings = []
    for severity in _SEVERITIES:
        codes = [
            dict.fromkeys(f.code for f in one.findings if f.severity == severity) for one in results
        ]
        cells = tuple(", ".join(some) or "none" for some in codes)
        findings.append(Row(name=f"findings.{severity}", meaning=f"{severity}s", cells=cells))
    made_of = (_row([facts.get(name) for facts in columns]) for name in names)
    return (*(row for row in made_of if any(row.cells)), *findings)


def _row(facts: Sequence[NamedFact | None]) -> Row:
    """Return a row of facts; the limit stands in each cell where it is not that of all."""
    there = [one for one in facts if one is not None]
    limits = {one.limit for one in there}
    common = limits.pop() if len(limits) == 1 else ""
    texts = iter(told_alike(there))
    cells = tuple(
        "" if fact is None else next(texts) + f" ({fact.limit})" * (fact.limit != common)
        for fact in facts
    )
    return Row(name=there[0].name, meaning=there[0].meaning, cells=cells, limit=common)


def lines(variants: Sequence[Variant], *, every: bool = False) -> Iterator[str]:
    """Yield the lines of the printed table of variants.

    Parameters
    ----------
    variants : sequence of Variant
        At least one that can be made.
    every : bool
        Whether to list all facts by name and mark those that differ, not only the latter.
    """
    labels = [one.label for one in variants if one.refusal is None]
    all_rows = rows(variants, every=every)
    if not labels:
        return
    table = [("", "", *labels, "")]
    for row in all_rows:
        if row.differs or every:
            limit = f"({row.limit})" if row.limit else ""
            name = row.name if every else row.meaning
            cells = (
                cell if len(cell) <= _CELL else f"{cell[: _CELL - 3]}..." for cell in row.cells
            )
            table.append(("*" if row.differs else "", name, *cells, limit))
    yield from lined_up(table)
    same = [f"{row.meaning} {row.cells[0]}" for row in all_rows if not row.differs]
    if same and not every:
        yield wrapped(f"the same in all: {'; '.join(same)}", first="", rest="  ")
