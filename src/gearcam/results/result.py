"""Results: everything computed from a design, stage by stage and on demand, and its files.

A result computes a value when it is first used, and times each stage. Which facts, charts and files
it has is defined in the folder of its kind of design (see `gearcam.designs.kind`). Only the modules
that the requested files need are imported.
"""

from __future__ import annotations

import sys
import time
from abc import abstractmethod
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

from numpy.typing import ArrayLike

from gearcam.base.display import NotebookView, cut, renderer
from gearcam.base.errors import GearcamError, InfeasibleError
from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import Finding, in_order
from gearcam.base.numerals import tree
from gearcam.base.pickling import pickled
from gearcam.base.registry import deferred
from gearcam.base.tolerances import DEFAULT, Tolerances
from gearcam.designs.design import hash_of, summary_of
from gearcam.numeric.arguments import one_of, refused
from gearcam.numeric.columns import Columns
from gearcam.results.goals import demand_facts, goals_of
from gearcam.results.kind import Kind, Study, kind_of
from gearcam.results.written import BuildOutput, demand_formats, versions

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gearcam.laws.columns import Given
    from gearcam.numeric.mesh import Mesh
    from gearcam.numeric.pose import SpacePose
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import ContactPoints, Scene

FORMAT: Final = 1
"""Version of the layout of ``summary.json``."""

PICTURE: Final = "svg"
"""The format that shows the design as a picture."""
REPORT: Final = "report"
"""The format that describes the other files and is written last."""

Progress = Callable[[str, int, int], None]
"""Called with the name of the next stage, the number of stages done and their total."""


_framed = deferred("gearcam.report.file:framed")
"""Returns the page of a result for a notebook; named like the renderer of `gearcam.base.display`,
since the report is made from results."""

_OF_STUDIES: Final = (
    "_studied", "_running", "_drawn", "design_facts", "facts", "findings", "design_hash", "sought",
    "sizes",
)  # fmt: skip
"""What a result with other studies computes anew."""


class Result(NotebookView):
    """The result of a design, computed on demand.

    Parameters
    ----------
    design : Design
        The design to build.
    tolerances : Tolerances
        Accuracy of the internal computations.

    Examples
    --------
    >>> import gearcam as gc
    >>> isinstance(gc.build(gc.load("profiles/ellipse.toml")), gc.Result)
    True
    """

    stages: ClassVar[Mapping[str, str]]
    """Attributes that a build computes before its files, by the names of the stages."""
    before_studies: ClassVar[Sequence[str]] = ()
    """The stages that studies need, computed once for all settings of a study."""

    def __init__(self, design: Any, tolerances: Tolerances = DEFAULT) -> None:
        self.design = design
        self.tolerances = tolerances
        self.timings: dict[str, float] = {}
        self.sizes: dict[str, int] = {}  # bytes of the files built so far
        self._studied: dict[str, StudyResult] = {}
        self._drawn: dict[str, Chart | None] = {}
        self._running: set[str] = set()  # studies that are being computed
        self.sought: dict[float, Any] = {}  # remedies found, by the patience of the search

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.design, self.tolerances)  # the copy computes anew

    def __repr__(self) -> str:
        done = ", ".join(self.timings) or "nothing"
        return cut(f'<{type(self).__name__} of "{self.design.name}", computed: {done}>')

    def with_chords(self, tolerance: float) -> Self:  # noqa: ARG002
        """Return the result with another chord `tolerance`, mm; the same without outlines."""
        return self

    @property
    def kind(self) -> Kind:
        """The kind of the design."""
        return kind_of(self.design)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Add the time spent inside the context to the stage called `name`."""
        start = time.perf_counter()
        yield
        self.timings[name] = self.timings.get(name, 0.0) + time.perf_counter() - start

    @cached_property
    @abstractmethod
    def checked(self) -> tuple[Finding, ...]:
        """The findings of the checks of the design, errors first."""

    @cached_property
    def checked_without_hints(self) -> tuple[Finding, ...]:
        """The same findings; their messages need not name values that help.

        For searches, which look at codes and numbers only: values that help are searched for, and
        take longer than the checks.
        """
        return self.checked

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """The findings of all checks and of the studies that the design asks for, errors first."""
        return self.findings_with(self.studies.values())

    @property
    def findings_without_hints(self) -> tuple[Finding, ...]:
        """The same findings; those of checks need not name values that help."""
        return _merged(self.checked_without_hints, self.studies.values())

    def findings_with(self, studies: Collection[StudyResult]) -> tuple[Finding, ...]:
        """Return the findings of `studies`, and of the design what they do not repeat, in order."""
        return _merged(self.checked, studies)

    @property
    def studies(self) -> dict[str, StudyResult]:
        """The outcomes of the studies that the design asks for, by name, computed once.

        Without one that is being computed: it may use scene, charts and facts of the design.
        """
        asked = (name for name in self.design.output.studies if name not in self._running)
        return {name: self.study(name) for name in asked}

    def study(self, name: str, progress: Progress | None = None) -> StudyResult:
        """Return the outcome of a study with the settings of the design, computed once.

        Parameters
        ----------
        name : str
            The name of its command, such as ``mesh``.
        progress : callable, optional
            Called with a stage's name, the stages or steps done and their number.

        Returns
        -------
        StudyResult

        Raises
        ------
        DesignError
            If designs of this kind have no such study.
        InfeasibleError
            If the design, or its study, is impossible.
        """
        entry = self.kind.studies[one_of("name", name, (*self.kind.studies,))]
        outcome = self._studied.get(name)
        if outcome is None or outcome.interrupted:
            entry.demand(self.design)
            self._running.add(name)
            try:
                outcome = self._studied[name] = entry.compute(self, progress)
            finally:
                self._running.discard(name)
        return outcome

    def with_settings(self, title: str, settings: Mapping[str, object]) -> Self:
        """Return the result with other settings of a study; finished stages are kept.

        Parameters
        ----------
        title : str
            The table of the settings.
        settings : mapping of str to value
            New values by key, in the units of a file.

        Returns
        -------
        Result

        Raises
        ------
        DesignError
            If a setting is unknown, or its value is not allowed.
        """
        if not settings:
            return self
        design = self.design.with_({f"{title}.{key}": value for key, value in settings.items()})
        for name in self.before_studies:
            getattr(self, name)
        return self._shared(design)

    @property
    def plain(self) -> Self:
        """The result without the studies that the design asks for; finished stages are kept."""
        if not self.design.output.studies:
            return self
        output = replace(self.design.output, studies=())
        return self._shared(replace(self.design, output=output, examined=True))

    def _shared(self, design: Any) -> Self:
        """Return the result of a design that differs in its studies only, with all stages done."""
        result = type(self)(design, self.tolerances)
        shared = {name: one for name, one in vars(self).items() if name not in _OF_STUDIES}
        vars(result).update(shared | {"design": design, "timings": dict(self.timings)})
        return result

    def picture(self) -> str:
        """Return the picture of the file kind ``svg``, or why there is none, as SVG text."""
        if PICTURE not in self.kind.formats:
            return ""
        try:
            (data,) = self.files(PICTURE).values()
        except GearcamError as error:
            return renderer().refusal_picture(self.design.name, error)
        return data.decode()

    def _repr_html_(self) -> str:
        try:
            facts, findings = self.facts, self.findings
            if REPORT in self.kind.formats:
                return _framed(self)
        except GearcamError as error:
            return renderer().refusal(self.design.name, error)
        lines = [f"{one.severity}, {one.code}: {one.message} {one.where}" for one in findings]
        return renderer().page(self.picture(), facts, lines)

    @cached_property
    def design_hash(self) -> str:
        """The hash of the design, with the contents of its CSV files as first read."""
        return hash_of(self.design)

    @cached_property
    def facts(self) -> Facts:
        """All computed quantities by dotted names (see docs/summary.md)."""
        return self.design_facts.with_groups(
            {one.study.key: one.group for one in self.studies.values()}
        )

    @cached_property
    def design_facts(self) -> Facts:
        """The facts without those of studies."""
        files = [table.rows for table in self._tables if table.rows is not None]
        notes = [Fact(rows.note, Path(rows.file).name, shown=True) for rows in files]
        tables = [{"note": note} for note in notes if note.value]
        return self.kind.facts(self).with_groups({"tables": tables})

    @property
    def _tables(self) -> Sequence[Any]:
        """The tables of the design that are, or may be, files."""
        columns = sys.modules.get("gearcam.laws.columns")  # loaded if a design has a table
        return [*columns.tables_in(self.design)] if columns else []

    @property
    def given_rows(self) -> list[tuple[str, Given]]:
        """The rows of tables that should lie on curves, with the keys of what they belong to."""
        return self._given_rows(oscillating=False)

    def _given_rows(self, *, oscillating: bool) -> list[tuple[str, Given]]:
        """Return the same where lifts are angles, or mm."""
        if all(table.given(oscillating=oscillating) is None for table in self._tables):
            return []
        from gearcam.laws.row_checks import given_in

        return [*given_in(self.design, oscillating=oscillating)]

    @property
    def row_findings(self) -> tuple[Finding, ...]:
        """The findings of the rows of all tables of the design."""
        if not (tables := self.given_rows):
            return ()
        from gearcam.laws.row_checks import row_findings

        return row_findings(tables)

    @contextmanager
    def naming_rows(self) -> Iterator[None]:
        """Name a stray row of a table in the place of a refusal."""
        try:
            yield
        except InfeasibleError as error:
            from gearcam.laws.row_checks import refused_for_row

            named = refused_for_row(self.given_rows, error)
            if named is None or named.where == error.where:  # which names it already
                raise
            raise named from error

    def standing(
        self,
        chords: float = 0.0,  # noqa: ARG002
    ) -> dict[str, tuple[Mesh, SpacePose]]:
        """Return the parts as meshes in their own frames, with their places, by name.

        Empty without solids. How they move is in the scene, under the same names.

        Parameters
        ----------
        chords : float, mm
            Chord error of the outlines, if that of the design is smaller.
        """
        return {}

    def assembled(self, chords: float = 0.0) -> dict[str, Mesh]:
        """Return the parts in their places as meshes, by name; empty without solids.

        Parameters
        ----------
        chords : float, mm
            Chord error of the outlines, if that of the design is smaller.
        """
        return {name: mesh.placed(pose) for name, (mesh, pose) in self.standing(chords).items()}

    @property
    def main_errors(self) -> Sequence[tuple[str, Sequence[str]]]:
        """Errors that users act on: label, and names of facts of ``accuracy``.

        Of several facts the largest counts.
        """
        return ()

    def record(self) -> dict[str, float | str]:
        """Return the result as one flat row of a table: plain numbers and texts, no lists, no None.

        Keys are ``name``, ``kind``, the dotted names of all facts, and what the checks found:
        ``findings.errors``, ``.warnings``, ``.notes``, counts, and ``findings.codes``. A range has
        two keys, ``pair.ratio.min`` and ``pair.ratio.max``; a list of lengths or places one for
        each, counted from 0, such as ``gears.0.size_mm.2``; a list of whole numbers is a text.
        Results of other laws or kinds may have other keys. Raises `InfeasibleError` if the design
        cannot be made.

        Examples
        --------
        >>> import gearcam as gc
        >>> design = gc.load("profiles/ellipse.toml")
        >>> designs = [design.with_({"law.eccentricity": e}) for e in (0.1, 0.3)]
        >>> rows = [gc.build(one).record() for one in designs]  # for a DataFrame(rows)
        >>> [round(row["pair.ratio.max"], 3) for row in rows]
        [1.222, 1.857]
        """
        row = {"name": self.design.name, "kind": self.design.kind, **self.facts.record()}
        findings = self.findings_without_hints
        for word in ("error", "warning", "note"):
            row[f"findings.{word}s"] = sum(one.severity == word for one in findings)
        return row | {"findings.codes": ", ".join(dict.fromkeys(one.code for one in findings))}

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``summary.json`` without the list of files.

        Facts, findings, design and versions as plain values, in the units of their names. Raises
        `InfeasibleError` if the design cannot be made.
        """
        return self.document(self.facts, self.findings)

    def document(
        self, facts: Facts, findings: Sequence[Finding], files: Mapping[str, Any] | None = None
    ) -> dict[str, Any]:
        """Return a summary.

        Parameters
        ----------
        facts, findings
            As of a result or a study.
        files : mapping, optional
            Entries about files.

        Returns
        -------
        dict
            Plain values for JSON.
        """
        return tree(
            {
                "format": FORMAT,
                "name": self.design.name,
                "kind": self.design.kind,
                **facts.document,
                "hash": self.design_hash,
                **(files or {}),
                "findings": [finding.as_dict() for finding in findings],
                "timings_s": {name: round(value, 6) for name, value in self.timings.items()},
                "versions": versions(),
                "design": summary_of(self.design),
            }
        )

    def files(self, name: str, measured: dict[str, Any] | None = None) -> dict[str, bytes]:
        """Return the files of one format.

        Parameters
        ----------
        name : str
            A format that ``output.files`` can list.
        measured : dict, optional
            Receives facts measured on the files, by group.

        Returns
        -------
        dict of str to bytes
            Contents by file name.

        Raises
        ------
        DesignError
            If designs of this kind have no such files.
        InfeasibleError
            If the design cannot be made.
        """
        demand_formats(self.design, (name,))
        with self.naming_rows():
            return self.kind.files[name](self, {} if measured is None else measured)

    @property
    def charts(self) -> tuple[str, ...]:
        """Names that `chart` and `plot` accept; `InfeasibleError` if it cannot be made."""
        names = (name for name in self.kind.charts if self._chart(name) is not None)
        return (*names, *self._study_charts)

    def _chart(self, name: str) -> Chart | None:
        """Return a chart of the kind, drawn once; None where it would say nothing."""
        if name not in self._drawn:
            self._drawn[name] = self.kind.charts[name](self)
        return self._drawn[name]

    @property
    def _study_charts(self) -> dict[str, Chart]:
        """The charts of the studies that the design asks for, by ``study.chart``."""
        studies = self.studies.items()
        return {
            f"{name}.{chart}": one for name, study in studies for chart, one in study.charts.items()
        }

    def chart(self, name: str) -> Chart:
        """Return a chart as data: lines and limits, with the labels of the axes.

        Parameters
        ----------
        name : str
            One of `charts`.

        Returns
        -------
        Chart

        Raises
        ------
        DesignError
            If there is no such chart.
        InfeasibleError
            If the design cannot be made.
        """
        more = self._study_charts
        known = one_of("name", name, (*self.kind.charts, *more))
        chart = more[known] if known in more else self._chart(known)
        if chart is None:
            raise refused("there is no such chart here", "name", name, ", ".join(self.charts))
        return chart

    def plot(self, name: str, ax: Axes | None = None) -> Axes:
        """Draw a chart with matplotlib and return its axes.

        Parameters
        ----------
        name : str
            One of `charts`.
        ax : Axes, optional
            Axes to draw into; a new figure by default.

        Returns
        -------
        Axes

        Raises
        ------
        DesignError, InfeasibleError
            As `chart` does.
        MissingExtraError
            If matplotlib is not installed.
        """
        return self.chart(name).draw(ax)

    def scene(self, places: int | None = None) -> Scene | None:
        """Return the moving parts as data; None for kinds without them.

        Parameters
        ----------
        places : int, optional
            Steps of the driver over its turn or travel; by default those of the report.

        Returns
        -------
        Scene or None

        Raises
        ------
        InfeasibleError
            If the design cannot be made.
        """
        from gearcam.pictures.scenes import PLACES

        scene = self.kind.scene(self, PLACES if places is None else places)
        if scene is None:
            return None
        more = [one.overlay(scene) for one in self.studies.values()]
        contacts = {
            name: points
            for contacts in (scene.contacts, *more)
            for name, points in contacts.items()
        }
        return replace(scene, contacts=contacts)

    def check(self, directory: str | Path = "output") -> BuildOutput:
        """Run the checks and write the summary only; the files of an earlier build are kept.

        The summary lists those made from another version of the design under ``outdated``.

        Parameters
        ----------
        directory : path
            Parent folder.

        Returns
        -------
        BuildOutput
            With the summary as its only file.
        """
        self.demand_goals()
        return self.put(directory, {}, self.facts, self.findings, keep=True)

    def write(
        self,
        directory: str | Path = "output",
        files: Sequence[str] | None = None,
        progress: Progress | None = None,
    ) -> BuildOutput:
        """Write the files of the design into ``directory/NAME/``, all or none.

        Parameters
        ----------
        directory : path
            Parent folder.
        files : str or sequence of str, optional
            Formats instead of those that the design lists.
        progress : callable, optional
            ``progress(stage, done, total)`` is called before each stage.

        Returns
        -------
        BuildOutput
            With the files written, and those of the previous build that were removed.

        Raises
        ------
        DesignError
            If designs of this kind have no such files.
        InfeasibleError
            If the design cannot be made; then nothing is written or removed.
        WriteError
            If a file cannot be written.
        """
        formats = sorted(demand_formats(self.design, files), key=lambda name: name == REPORT)
        studies = self.design.output.studies
        steps = [*self.stages, *studies, *formats, "writing"]

        def tell(step: str, *_: int) -> None:
            if progress is not None and step in steps:
                progress(step, steps.index(step), len(steps))

        for step, attribute in self.stages.items():
            tell(step)
            getattr(self, attribute)
        contents: dict[str, bytes] = {}
        measured: dict[str, Any] = {}
        for name in studies:
            tell(name)
            outcome = self.study(name, tell)
            if outcome.interrupted:
                raise KeyboardInterrupt
            contents |= outcome.files
        self.demand_goals()
        for name in formats:
            tell(name)
            with self.stage(name):
                contents |= self.files(name, measured)
            self.sizes = {file: len(content) for file, content in contents.items()}
        contents |= self.more_files
        tell("writing")
        facts = self.facts.with_groups(measured)
        return self.put(directory, contents, facts, self.findings, keep=False)

    def demand_goals(self) -> None:
        """Refuse goals of the design that are no numbers among its facts (`DesignError`)."""
        goals = goals_of(self.design)
        if goals:
            demand_facts(goals, self.record())

    @property
    def more_files(self) -> dict[str, bytes]:
        """Contents of files, by name, that are written with any format."""
        return {}

    def put(
        self,
        directory: str | Path,
        contents: Mapping[str, bytes],
        facts: Facts,
        findings: Sequence[Finding],
        *,
        keep: bool,
    ) -> BuildOutput:
        """Write files and the summary, all or none.

        Parameters
        ----------
        directory : path
            Parent folder.
        contents : mapping of str to bytes
            The files by name.
        facts, findings
            For the summary.
        keep : bool
            Whether the other files of an earlier build are kept.

        Returns
        -------
        BuildOutput
        """
        import json

        from gearcam.export.listing import planned
        from gearcam.export.write import SUMMARY, writing

        folder = Path(directory) / self.design.name
        with writing(directory, self.design.name) as replace_files:
            plan = planned(folder, contents, self.design_hash, keep=keep)
            summary = self.document(facts, findings, plan.about)
            text = json.dumps(summary, indent=2, ensure_ascii=False, allow_nan=False)
            files = {**contents, SUMMARY: (text + "\n").encode()}
            replace_files(files, plan.removed, plan.renamed)
        return BuildOutput(
            directory=folder,
            files=tuple(files),
            removed=plan.removed,
            kept=plan.kept,
            former={name: before for before, name in plan.renamed.items()},
            summary=summary,
            facts=facts,
            findings=tuple(findings),
        )


def _merged(checked: Sequence[Finding], studies: Collection[StudyResult]) -> tuple[Finding, ...]:
    """Return the findings of studies, and of the checks those that they do not repeat, in order."""
    repeated = {code for one in studies for code in one.study.repeats}
    kept = (one for one in checked if one.code not in repeated)
    return in_order((*kept, *(finding for one in studies for finding in one.study_findings)))


def _nothing(_: Scene) -> dict[str, ContactPoints]:
    return {}


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
    study_findings: tuple[Finding, ...] = ()
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
        return pickled({**vars(self), "charts": self.charts, "drawn": dict})

    @cached_property
    def columns(self) -> Columns:
        """The table with the columns of the CSV file; missing values are NaN."""
        return Columns(self.table)

    @cached_property
    def facts(self) -> Facts:
        """The facts of the result and of the study (see docs/summary.md)."""
        return self.result.design_facts.with_groups({self.study.key: self.group})

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
        """
        written = self.result.put(directory, self.files, self.facts, self.findings, keep=True)
        lines = self.lines or tuple(self.facts.lines(f"{self.study.key}."))
        return replace(written, table=lines, interrupted=self.interrupted)
