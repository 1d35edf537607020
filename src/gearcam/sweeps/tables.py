"""Tables of a sweep: CSV with a row for each variant, and Parquet where pyarrow is installed.

Columns: ``number``; the values by keys; the facts by names; ``findings``, their codes; ``errors``,
how many of them are errors; ``refusal``, the reason; ``time_s``, the only column that differs when
a sweep is repeated. Rows stand by their numbers. What a variant does not have is an empty cell.
"""

from __future__ import annotations

import csv
import importlib.util
import json
import math
import os
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, WriteError
from gearcam.base.near_names import UnknownNameError
from gearcam.base.two_names import spellings
from gearcam.numeric.columns import Columns
from gearcam.sweeps.kept import RowStore
from gearcam.sweeps.rows import Built

_BATCH: Final = 5000
"""Rows of Parquet that are in memory at once."""


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
        Keys with a value that is not a number; None is no value.
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
            if isinstance(value, bool) or not isinstance(value, int | float | None):
                self.texts.add(key)

    @property
    def words(self) -> str:
        """What is not right, in words."""
        words = f"{self.refused} refused, {self.wrong} with errors"
        return f"{words}, {self.faults} by faults of gearcam" if self.faults else words

    @property
    def text_columns(self) -> set[str]:
        """Names of the columns that are texts."""
        facts = {name for name, text in self.facts.items() if text}
        return facts | self.texts | {"findings", "refusal"}


def tally_of(rows: Iterable[Built]) -> Tally:
    """Return what some rows have."""
    tally = Tally()
    for row in rows:
        tally.add(row)
    return tally


class SweptColumns(Columns):
    """Columns of a sweep, also found by the other names of keys and facts.

    Parameters
    ----------
    columns : mapping of str to (n,) array
        In order.
    repeated : mapping of str to str
        Keys of the design that facts repeat, by these facts.
    """

    def __init__(
        self, columns: Mapping[str, ArrayLike], repeated: Mapping[str, str] = MappingProxyType({})
    ) -> None:
        super().__init__(columns)
        self._repeated = dict(repeated)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (dict(self), self._repeated)

    def __missing__(self, name: str) -> NDArray[Any]:
        for one in spellings(self._repeated, name) if isinstance(name, str) else ():
            if one in self:
                return self[one]
        raise UnknownNameError(name, self, self._all_refused)

    @property
    def _all_refused(self) -> str:
        """The usual reason if all variants were refused: there are no facts then."""
        reasons = Counter(map(str, self.get("refusal", ())))
        if not reasons or reasons[""]:
            return ""
        return f"all {reasons.total()} variants were refused: {reasons.most_common(1)[0][0]}"


def columns_of(there: RowStore, repeated: Mapping[str, str] = MappingProxyType({})) -> SweptColumns:
    """Return rows as columns, as of the CSV file; numbers that a row does not have are nan.

    Parameters
    ----------
    there : RowStore
        The rows.
    repeated : mapping of str to str
        Keys of the design that facts repeat, by these facts: either name finds a column.

    Returns
    -------
    SweptColumns
        Empty without rows. Columns with a text are texts, empty where a row has none.
    """
    tally = tally_of(there.rows())
    if not tally.rows:
        return SweptColumns({})
    keys = list(next(there.rows()).values)
    texts, whole = tally.text_columns, {"number", "errors"}
    names, *_ = _records(there.rows(), keys, list(tally.facts))
    cells: dict[str, list[Any]] = {name: [] for name in names}
    for record in _records(there.rows(), keys, list(tally.facts)):
        for name, value in record.items():
            missing = value is None
            if name in texts:
                cells[name].append("" if missing else str(value))
            else:
                cells[name].append(math.nan if missing else value)
    return SweptColumns(
        {name: np.array(one, dtype=_dtype(name, texts, whole)) for name, one in cells.items()},
        repeated,
    )


def _dtype(name: str, texts: Collection[str], whole: Collection[str]) -> type:
    return str if name in texts else int if name in whole else float


def write_tables(log: RowStore, folder: Path, stem: str = "sweep") -> tuple[Tally, list[Path]]:
    """Write rows as tables.

    Parameters
    ----------
    log : RowStore
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
    tally = tally_of(log.rows())
    if not tally.rows:
        return tally, []
    first = next(log.rows())
    keys, facts = list(first.values), list(tally.facts)
    table, more = folder / f"{stem}.csv", folder / f"{stem}.parquet"
    written_whole(table, lambda path: _write_csv(path, _records(log.rows(), keys, facts)))
    if importlib.util.find_spec("pyarrow") is None:
        return tally, [table]
    texts = tally.text_columns
    written_whole(more, lambda path: _write_parquet(path, _records(log.rows(), keys, facts), texts))
    return tally, [table, more]


def made_folder(folder: str | os.PathLike[str] | None) -> Path:
    """Return the `folder` of files, which is made; none is refused (`DesignError`)."""
    if folder is None:
        raise DesignError.of("is not given", key="folder", allowed="a path")
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    return place


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


def _records(
    rows: Iterable[Built], keys: Sequence[str], facts: Sequence[str]
) -> Iterator[dict[str, Any]]:
    """Yield rows as values by columns; `keys` and `facts` are those of values and facts."""
    for row in rows:
        yield {
            "number": row.number,
            **{key: _cell(row.values[key]) for key in keys},
            **{name: row.facts.get(name) for name in facts if name not in row.values},
            "findings": " ".join(row.findings),
            "errors": row.errors,
            "refusal": row.refusal,
            "time_s": row.time_s,
        }


def _cell(value: Any) -> float | str | None:
    """Return a value of a key as a number or a text; None of a key that is left out."""
    if isinstance(value, bool) or not isinstance(value, int | float | str | None):
        return json.dumps(value)
    return value


def _write_csv(path: Path, table: Iterable[dict[str, Any]]) -> None:
    """Write values by columns, at least of one row, as CSV."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer: csv.DictWriter[str] | None = None
        for record in table:
            if writer is None:
                writer = csv.DictWriter(file, list(record), lineterminator="\n")
                writer.writeheader()
            writer.writerow(record)


def _write_parquet(path: Path, table: Iterable[dict[str, Any]], texts: set[str]) -> None:
    """Write values by columns as Parquet; `texts` are columns of texts, others of numbers."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    rows, writer = iter(table), None
    try:
        while batch := list(islice(rows, _BATCH)):
            if writer is None:
                kinds = dict.fromkeys(batch[0], pa.float64()) | dict.fromkeys(texts, pa.string())
                kinds |= dict.fromkeys(("number", "errors"), pa.int64())
                schema = pa.schema([(name, kinds[name]) for name in batch[0]])
                writer = pq.ParquetWriter(path, schema)
            for record in batch:
                record |= {name: str(record[name]) for name in texts if record[name] is not None}
            writer.write_table(pa.Table.from_pylist(batch, schema=writer.schema))
    finally:
        if writer is not None:
            writer.close()
