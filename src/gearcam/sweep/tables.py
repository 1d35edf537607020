"""Tables of a sweep: CSV with a row for each variant, and Parquet where pyarrow is installed.

Columns: ``number``; the values by keys; the facts by names; ``findings``, their codes; ``errors``,
how many of them are errors; ``refusal``, the reason; ``time_s``, the only column that differs when
a sweep is repeated. Rows stand by their numbers. What a variant does not have is an empty cell.
"""

from __future__ import annotations

import csv
import importlib.util
import json
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, Final

from gearcam.sweep.rows import Built

_BATCH: Final = 5000
"""Rows of Parquet that are in memory at once."""


def records(
    rows: Iterable[Built], keys: Sequence[str], facts: Sequence[str]
) -> Iterator[dict[str, Any]]:
    """Yield rows as dicts of columns.

    Parameters
    ----------
    rows : iterable of Built
        The rows.
    keys, facts : sequence of str
        Columns of values and facts.
    """
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


def _cell(value: Any) -> float | str:
    """Return a value of a key as a number or a text."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return json.dumps(value)
    return value


def write_csv(path: Path, table: Iterable[dict[str, Any]]) -> None:
    """Write rows as CSV.

    Parameters
    ----------
    path : path
        The file.
    table : iterable of dict
        The rows: values by the same columns; at least one.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        writer: csv.DictWriter[str] | None = None
        for record in table:
            if writer is None:
                writer = csv.DictWriter(file, list(record), lineterminator="\n")
                writer.writeheader()
            writer.writerow(record)


def can_write_parquet() -> bool:
    """Return whether pyarrow is installed."""
    return importlib.util.find_spec("pyarrow") is not None


def write_parquet(path: Path, table: Iterable[dict[str, Any]], texts: frozenset[str]) -> None:
    """Write rows as Parquet.

    Parameters
    ----------
    path : path
        The file.
    table : iterable of dict
        The rows, as for `write_csv`.
    texts : frozenset of str
        Columns that are texts; others are numbers.

    Raises
    ------
    OSError
        If it cannot be written.
    """
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
