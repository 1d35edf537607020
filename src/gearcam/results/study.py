"""The outcome of a study of a result: its table, facts, findings, charts and files."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from gearcam.base.display import NotebookView, cut
from gearcam.base.facts import Facts
from gearcam.base.findings import Finding, in_order
from gearcam.base.inches import files_in, told
from gearcam.base.pickling import pickled
from gearcam.numeric.columns import Columns
from gearcam.results.staged import Staged
from gearcam.results.studies import Study
from gearcam.results.written import BuildOutput

if TYPE_CHECKING:
    from gearcam.numeric.arrays import Array
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import ColouredCurve, ContactPoints, JointForce, Scene

Progress = Callable[[str, int, int], None]
"""Called with the name of the next stage, the number of stages done and their total."""


def silent(stage: str, done: int, total: int) -> None:
    """Tell nobody of progress (see `Progress`)."""


def merged(checked: Sequence[Finding], studies: Collection[StudyResult]) -> tuple[Finding, ...]:
    """Return the findings of `studies`, and those `checked` that they do not repeat, in order.

    Of studies that find the same, that which repeats it counts.

    Parameters
    ----------
    checked : sequence of Finding
        Of the design.
    studies : collection of StudyResult
        Its studies.
    """
    repeated = {code for one in studies for code in one.study.repeats}
    every = [*((one, ()) for one in checked)]
    every += [(found, one.study.repeats) for one in studies for found in one.study_findings]
    return in_order(one for one, own in every if one.code not in repeated or one.code in own)


def _nothing(_: Scene) -> dict[str, ContactPoints]:
    return {}


def _no_forces(_: Scene) -> tuple[JointForce, ...]:
    return ()


@dataclass(frozen=True, eq=False, kw_only=True)
class StudyResult(NotebookView):
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
    study_findings : tuple of Finding
        Its findings.
    drawn : callable
        ``drawn()`` returns its `charts`; called when they are first read.
    overlay : callable
        ``overlay(scene)`` returns points of contact for the moving picture, by name.
    joints : callable
        ``joints(scene)`` returns forces in joints for the moving picture.
    coloured : callable
        ``coloured()`` returns curves of the moving picture with values along them.
    pace : (n, 2) array or None
        Places of the driver over a cycle, in the unit of the moving picture, increasing, and the
        time at each, s: the motion that this picture can follow.
    full : mapping of str to str
        Of columns without a unit in their names, one with it: ``lift_mm`` of ``s``.
    further : mapping of str to mapping
        Columns of further tables by name, such as ``trials``: the file ``errors_trials.csv``.
    pages : mapping of str to bytes
        Other files beside the table, by name.
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

    for_users = (
        "charts", "columns", "complete", "facts", "files", "findings", "picture", "tables",
        "to_dict", "write",
    )  # fmt: skip

    result: Staged
    study: Study
    file: str
    table: Mapping[str, ArrayLike]
    group: Mapping[str, Any]
    study_findings: tuple[Finding, ...] = ()
    drawn: Callable[[], Mapping[str, Chart]] = dict
    overlay: Callable[[Scene], Mapping[str, ContactPoints]] = _nothing
    joints: Callable[[Scene], Iterable[JointForce]] = _no_forces
    coloured: Callable[[], Iterable[ColouredCurve]] = tuple
    pace: Array | None = None
    further: Mapping[str, Mapping[str, ArrayLike]] = field(default_factory=dict)
    full: Mapping[str, str] = field(default_factory=dict)
    pages: Mapping[str, bytes] = field(default_factory=dict)
    lines: tuple[str, ...] = ()
    interrupted: str = ""

    @property
    def complete(self) -> bool:
        """Whether it was not interrupted.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> study.complete, study.interrupted
        (True, '')
        """
        return not self.interrupted

    def __repr__(self) -> str:
        rows = len(next(iter(self.columns.values()), ()))
        state = "" if self.complete else " (interrupted)"
        return cut(
            f'<StudyResult{state}: {rows} rows, as in {self.file}, of "{self.result.design.name}">'
        )

    @cached_property
    def charts(self) -> Mapping[str, Chart]:
        """Its charts by name.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> list(study.charts)
        ['transmission_error', 'contact_patch']
        """
        return self.drawn()

    def __getstate__(self) -> dict[str, Any]:
        # what charts are drawn from need not be picklable
        curves = tuple(self.coloured())
        coloured = partial(tuple, curves) if curves else tuple
        kept = {"charts": self.charts, "drawn": dict, "coloured": coloured}
        return pickled({**vars(self), **kept})

    @cached_property
    def columns(self) -> Columns:
        """The table with the columns of the CSV file; missing values are NaN.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> list(study.columns)[:3]
        ['step', 'phi1_deg', 'phi2_deg']
        """
        return Columns(self.table)

    @cached_property
    def tables(self) -> dict[str, Columns]:
        """Its further tables by name, such as ``trials`` of errors: a row for each assembly.

        Examples
        --------
        >>> import gearcam as gc
        >>> errors = {"errors.center_tolerance_mm": 0.02, "errors.trials": 5, "errors.steps": 36}
        >>> study = gc.build(gc.load("profiles/ellipse.toml").with_(errors)).study("errors")
        >>> list(study.tables), study.tables["trials"]["number"]
        (['trials'], array([1., 2., 3., 4., 5.]))
        """
        return {name: Columns(table) for name, table in self.further.items()}

    @cached_property
    def facts(self) -> Facts:
        """The facts of the result and of the study (see docs/summary.md).

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> study.facts["meshing.steps"]
        4
        """
        return self.result.design_facts.with_groups({self.study.key: self.group})

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """Findings of the study, and those of the design that it does not repeat; errors first.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> [one.code for one in study.findings]
        ['no-backlash']
        """
        return merged(self.result.checked, (self,))

    def picture(self) -> str:
        """Return an empty text: a study has no picture.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> study.picture()
        ''
        """
        return ""

    @property
    def files(self) -> dict[str, bytes]:
        """Its files: the tables and its pages, by name.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> list(study.files)
        ['meshing.csv']
        """
        from gearcam.export.table import table_bytes

        stem = Path(self.file).stem
        tables = {f"{stem}_{name}.csv": table for name, table in self.further.items()}
        with files_in(self.result.design.files_in):
            every = {self.file: self.table, **tables}
            written = {name: table_bytes(one, self.full) for name, one in every.items()}
        return {**written, **self.pages}

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``summary.json`` without files (see `Result.to_dict`).

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> study.to_dict()["meshing"]["steps"]
        4
        """
        return self.result.summary(self.facts, self.findings).document()

    def write(self, directory: str | Path = "output") -> BuildOutput:
        """Write its files and the summary; the files of a build are kept.

        Parameters
        ----------
        directory : path
            Parent folder.

        Returns
        -------
        BuildOutput
            With the files and the summary.

        Raises
        ------
        WriteError
            If a file cannot be written.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.mesh(steps=4)
        >>> study.write("output").files
        ('meshing.csv', 'summary.json')
        """
        summary = self.result.summary(self.facts, self.findings)
        written = summary.write(directory, self.files, keep=True)
        lines = told(self.lines, self.result.design.files_in)
        lines = lines or tuple(written.facts.lines(f"{self.study.key}."))
        return replace(written, table=lines, interrupted=self.interrupted)
