"""Studies: further computations on a result, such as meshing, as entries of a kind of design.

A *study* has settings, a table of the design, and computes rows, facts, findings, charts and points
for the moving picture from a result. It runs by its command, from Python, or as a part of a design
that names it in ``output.studies``: then summary, report, hash and `compare` include it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from gearcam.base.display import Displayed, cut
from gearcam.base.facts import Facts
from gearcam.base.findings import Finding
from gearcam.numeric.columns import Columns
from gearcam.results.result import Progress, Result
from gearcam.results.written import Written

if TYPE_CHECKING:
    from gearcam.designs.design import Design
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import ContactPoints, Scene


def _anything(_: Design) -> None:
    """Allow all settings; a function of the module, so that studies can be pickled."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Study:
    """A study: an entry of a kind of design.

    Parameters
    ----------
    name : str
        Name of its command, and in ``output.studies``.
    key : str
        Its key in ``summary.json``.
    doc : str
        One line of help: what it does and which files it writes.
    done : str
        Past participle for messages, such as ``meshed``.
    table : str
        Title of the table of its settings in a design; the command has an option for each key.
    compute : callable
        ``compute(result, progress)`` returns its outcome; the settings are those of the design.
    options : mapping of str to str
        Names of options that differ from those of their keys.
    argument : str
        Key that is given on the command line without an option, after the design file.
    metavar : str
        What stands for it in the usage.
    demand : callable
        ``demand(design)`` refuses settings that the keys alone allow, before anything is built.
    repeats : tuple of str
        Codes of findings of the design that the study gives anew.
    many : bool
        Whether its command takes several design files.
    """

    name: str
    key: str
    doc: str
    done: str
    table: str
    compute: Callable[[Any, Progress | None], StudyResult]
    options: Mapping[str, str] = field(default_factory=dict)
    argument: str = ""
    metavar: str = ""
    demand: Callable[[Design], None] = _anything
    repeats: tuple[str, ...] = ()
    many: bool = True

    def __repr__(self) -> str:
        return f'<Study "{self.name}">'


def _nothing(_: Scene) -> dict[str, ContactPoints]:
    return {}


@dataclass(frozen=True, eq=False, kw_only=True)
class StudyResult(Displayed):
    """The outcome of a study of a result.

    Parameters
    ----------
    result : Result
        The result studied.
    study : Study
        The study.
    file : str
        Name of the CSV file for the table.
    table : mapping of str to (n,) array
        Columns by name, with the unit at the end of the name.
    group : mapping
        Its facts.
    found : tuple of Finding
        Its findings.
    drawn : callable
        ``drawn()`` returns its `charts`; called when they are first read.
    overlay : callable
        ``overlay(scene)`` returns points of contact for the moving picture, by name.
    pages : mapping of str to bytes
        Files beside the table, by name.
    lines : tuple of str
        Lines to print in place of its facts.
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
    study: Study
    file: str
    table: Mapping[str, ArrayLike]
    group: Mapping[str, Any]
    found: tuple[Finding, ...] = ()
    drawn: Callable[[], Mapping[str, Chart]] = dict
    overlay: Callable[[Scene], Mapping[str, ContactPoints]] = _nothing
    pages: Mapping[str, bytes] = field(default_factory=dict)
    lines: tuple[str, ...] = ()
    interrupted: str = ""

    @property
    def complete(self) -> bool:
        """Whether it was not interrupted."""
        return not self.interrupted

    def __repr__(self) -> str:
        rows = len(next(iter(self.columns.values()), ()))
        state = "" if self.complete else " (interrupted)"
        return cut(
            f'<StudyResult{state}: {rows} rows, as in {self.file}, of "{self.result.design.name}">'
        )

    @cached_property
    def charts(self) -> Mapping[str, Chart]:
        """Its charts by name."""
        return self.drawn()

    def __getstate__(self) -> dict[str, Any]:
        # what charts are drawn from need not be picklable
        return {**vars(self), "charts": self.charts, "drawn": dict}

    @cached_property
    def columns(self) -> Columns:
        """The table with the columns of the CSV file; missing values are NaN."""
        return Columns(self.table)

    @cached_property
    def facts(self) -> Facts:
        """The facts of the result and of the study (see docs/summary.md)."""
        return self.result.design_facts({}).with_group(self.study.key, self.group)

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """Findings of the study, and those of the design that it does not repeat; errors first."""
        return self.result.findings_with((self,))

    def picture(self) -> str:
        """Return an empty text: a study has no picture."""
        return ""

    @property
    def files(self) -> dict[str, bytes]:
        """Its files: the table and its pages, by name."""
        from gearcam.export.table import table_bytes

        return {self.file: table_bytes(self.table), **self.pages}

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``summary.json`` without files (see `Result.to_dict`)."""
        return self.result.document(self.facts, self.findings)

    def write(self, directory: str | Path = "output") -> Written:
        """Write its files and the summary; the files of a build are kept.

        Parameters
        ----------
        directory : path
            Parent folder.

        Returns
        -------
        Written
            With the files and the summary.

        Raises
        ------
        WriteError
            If a file cannot be written.
        """
        written = self.result.keep(self.files, directory, self.facts, self.findings)
        lines = self.lines or tuple(self.facts.lines(f"{self.study.key}."))
        return replace(written, table=lines, interrupted=self.interrupted)
