"""Studies: further computations on a result, such as meshing, as data that can be written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from gearcam.base.display import Displayed, cut
from gearcam.base.facts import Facts
from gearcam.base.findings import Finding
from gearcam.numeric.columns import Columns
from gearcam.results.result import Result
from gearcam.results.written import Written


@dataclass(frozen=True, eq=False, kw_only=True)
class Study(Displayed):
    """The outcome of a study of a result.

    Parameters
    ----------
    result : Result
        The result studied.
    file : str
        Name of the CSV file for the table.
    table : mapping of str to (n,) array
        Columns by name, with the unit at the end of the name.
    measured : mapping
        Results of the study by groups of facts.
    findings : tuple of Finding
        Findings of the study, and those of the design that apply to it; errors first.
    interrupted : str
        How much was done when it was interrupted: ``125 of 1000 steps``; empty if it is complete.

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
    interrupted: str = ""

    @property
    def complete(self) -> bool:
        """Whether it was not interrupted."""
        return not self.interrupted

    def __repr__(self) -> str:
        rows = len(next(iter(self.columns.values()), ()))
        state = "" if self.complete else " (interrupted)"
        return cut(
            f'<Study{state}: {rows} rows, as in {self.file}, of "{self.result.design.name}">'
        )

    @cached_property
    def columns(self) -> Columns:
        """The table with the columns of the CSV file; missing values are NaN."""
        return Columns(self.table)

    @cached_property
    def facts(self) -> Facts:
        """The facts of the result and of the study (see docs/summary.md)."""
        return self.result.facts_with(self.measured)

    def picture(self) -> str:
        """Return an empty text: a study has no picture."""
        return ""

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``summary.json`` without files (see `Result.to_dict`)."""
        return self.result.document(self.facts, self.findings)

    def write(self, directory: str | Path = "output") -> Written:
        """Write its CSV file and the summary; the files of a build are kept.

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
            If a file cannot be written.
        """
        from gearcam.export.table import table_bytes

        contents = {self.file: table_bytes(self.table)}
        written = self.result.keep(contents, directory, self.measured, self.findings)
        return replace(written, interrupted=self.interrupted)
