"""The rows of the tables of a design that are, or may be, files: their findings and refusals."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact
from gearcam.base.findings import Finding

if TYPE_CHECKING:
    from gearcam.laws.columns import Given


@dataclass(frozen=True, eq=False, kw_only=True)
class TableRows(ShortRepr):
    """The rows of the tables of a design.

    Parameters
    ----------
    design : Design
        Without the designs that are nested in it.
    oscillating : bool
        Whether lifts are angles, or mm.
    """

    design: Any
    oscillating: bool = False

    @property
    def _tables(self) -> list[Any]:
        """The tables of the design."""
        columns = sys.modules.get("gearcam.laws.columns")  # loaded if a design has a table
        return [*columns.tables_in(self.design)] if columns else []

    @property
    def notes(self) -> list[Fact]:
        """Notes on what was read from files."""
        files = (table.rows for table in self._tables if table.rows is not None)
        return [Fact(rows.note, Path(rows.file).name, shown=True) for rows in files if rows.note]

    @property
    def given(self) -> list[tuple[str, Given]]:
        """The rows that should lie on curves, with the keys of what they belong to."""
        if all(table.given(oscillating=self.oscillating) is None for table in self._tables):
            return []
        from gearcam.laws.row_checks import given_in

        return [*given_in(self.design, oscillating=self.oscillating)]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Their findings."""
        if not (given := self.given):
            return ()
        from gearcam.laws.row_checks import row_findings

        return row_findings(given)

    @contextmanager
    def named(self) -> Iterator[None]:
        """Return a context that names a stray row in the place of a refusal.

        Raises
        ------
        InfeasibleError
            For the row, or the one that was raised.
        """
        try:
            yield
        except InfeasibleError as error:
            from gearcam.laws.row_checks import refused_for_row

            refusal = refused_for_row(self.given, error)
            if refusal is None or refusal.where == error.where:  # which names it already
                raise
            raise refusal from error
