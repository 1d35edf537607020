"""Studies: what is found out about a result beyond its design, as data that may be written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from gearcam.display import Displayed, cut
from gearcam.facts import Facts
from gearcam.findings import Finding
from gearcam.numeric.columns import Columns
from gearcam.result import Result
from gearcam.written import Written


@dataclass(frozen=True, eq=False, kw_only=True)
class Study(Displayed):
    """What a study of a result has found.

    Parameters
    ----------
    result : Result
        What was studied.
    file : str
        The file that the table is written to.
    table : mapping of str to (n,) array
        Its columns, as `gearcam.export.table.table_bytes` takes them.
    measured : mapping
        What the facts are told from, by the name of their group.
    findings : tuple of Finding
        Those of the design that hold in the study, and its own: errors first.
    complete : bool
        Whether nothing was interrupted.

    Examples
    --------
    >>> import gearcam as gc
    >>> study = gc.build(gc.load("profiles/ellipse.toml")).mesh(steps=4)
    >>> study.columns["phi1_deg"][:3], study.complete
    (array([ 0.,  0., 90.]), True)
    """

    result: Result
    file: str
    table: Mapping[str, ArrayLike]
    measured: Mapping[str, Any]
    findings: tuple[Finding, ...]
    complete: bool = True

    def __repr__(self) -> str:
        rows = len(next(iter(self.columns.values()), ()))
        state = "" if self.complete else " (interrupted)"
        return cut(
            f'<Study{state}: {rows} rows, as in {self.file}, of "{self.result.design.name}">'
        )

    @cached_property
    def columns(self) -> Columns:
        """Its table, with the columns of its file; what does not exist is not-a-number."""
        return Columns(self.table)

    @cached_property
    def facts(self) -> Facts:
        """What is known of the result with what was found (see docs/conventions.md)."""
        return self.result.facts_with(self.measured)

    def picture(self) -> str:
        """Return nothing: a study is told in numbers."""
        return ""

    def to_dict(self) -> dict[str, Any]:
        """Return what `summary.json` tells of it, but for files (see `Result.to_dict`)."""
        return self.result.document(self.facts, self.findings)

    def write(self, directory: str | Path = "output") -> Written:
        """Write its file beside those of a build, which stay.

        Parameters
        ----------
        directory : path
            Parent folder.

        Returns
        -------
        Written
            With the file and the summary.

        Raises
        ------
        WriteError
            If the disk refuses.
        """
        from gearcam.export.table import table_bytes

        contents = {self.file: table_bytes(self.table)}
        written = self.result.keep(contents, directory, self.measured, self.findings)
        return replace(written, complete=self.complete)
