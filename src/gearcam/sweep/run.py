"""A sweep from its plan to its files; what is in the log already is not built again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from gearcam.base.display import ShortRepr
from gearcam.base.errors import WriteError
from gearcam.sweep.engine import Engine, Job
from gearcam.sweep.log import Log
from gearcam.sweep.plan import Plan
from gearcam.sweep.rows import Built
from gearcam.sweep.tables import (
    can_write_parquet,
    records,
    write_csv,
    write_parquet,
)


@dataclass
class Tally(ShortRepr):
    """What is known of the rows so far.

    Parameters
    ----------
    rows, refused, wrong, faults : int
        Numbers of rows, of variants that cannot be made, of those with errors, and of refusals
        that are faults of the program.
    facts : dict of str to bool
        Names of facts, and whether one of their values is a text.
    texts : set of str
        Keys with a value that is not a number.
    """

    rows: int = 0
    refused: int = 0
    wrong: int = 0
    faults: int = 0
    facts: dict[str, bool] = field(default_factory=dict)
    texts: set[str] = field(default_factory=set)

    def add(self, row: Built) -> None:
        """Count a row."""
        self.rows += 1
        self.refused += not row.made
        self.wrong += row.errors > 0
        self.faults += row.fault
        for name, value in row.facts.items():
            self.facts[name] = self.facts.get(name, False) or isinstance(value, str)
        for key, value in row.values.items():
            if isinstance(value, bool) or not isinstance(value, int | float):
                self.texts.add(key)


def run(
    plan: Plan, log: Log, engine: Engine, progress: Callable[[int, int], Any] | None = None
) -> None:
    """Build what is missing in a log.

    Parameters
    ----------
    plan : Plan
        The variants.
    log : Log
        Of this sweep.
    engine : Engine
        What builds them.
    progress : callable, optional
        Called with the number of rows that are there and their total.
    """

    def missing() -> Iterator[Job]:
        for number in range(plan.count):
            if number not in log:
                yield number, plan.values(number)

    for row in engine.run(plan.base, missing()):
        log.append(row)
        if progress is not None:
            progress(len(log), plan.count)


def head_of(plan: Plan) -> dict[str, Any]:
    """Return the first line of the log of a plan."""
    return {
        "sweep": plan.mark,
        "file": plan.base.source,
        "variants": plan.count,
        "varied": [f"{axis.key}={axis.text}" for axis in plan.axes],
    }


def write_tables(log: Log, folder: Path, stem: str = "sweep") -> tuple[Tally, list[Path]]:
    """Write the rows of a log as tables.

    Parameters
    ----------
    log : Log
        With the rows.
    folder : path
        Where to write.
    stem : str
        Names of the files without their ends.

    Returns
    -------
    tally : Tally
        What the rows have.
    files : list of path
        What was written; nothing without rows.

    Raises
    ------
    WriteError
        If a file cannot be written.
    """
    tally = Tally()
    for row in log.rows():
        tally.add(row)
    if not tally.rows:
        return tally, []
    first = next(log.rows())
    keys, facts = list(first.values), list(tally.facts)
    table, more = folder / f"{stem}.csv", folder / f"{stem}.parquet"
    written_whole(table, lambda path: write_csv(path, records(log.rows(), keys, facts)))
    if not can_write_parquet():
        return tally, [table]
    texts = {name for name, text in tally.facts.items() if text} | {"findings", "refusal"}
    texts = frozenset(texts | tally.texts)
    written_whole(more, lambda path: write_parquet(path, records(log.rows(), keys, facts), texts))
    return tally, [table, more]


def written_whole(path: Path, write: Callable[[Path], Any]) -> None:
    """Write a file whole or not at all.

    Parameters
    ----------
    path : path
        The file.
    write : callable
        ``write(part)`` writes it to another place.

    Raises
    ------
    WriteError
        If it cannot be written.
    """
    part = path.with_suffix(f"{path.suffix}.part")
    try:
        try:
            write(part)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise WriteError(f"{path}: {error.strerror or error}") from error
