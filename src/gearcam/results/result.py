"""Results: everything computed from a design, stage by stage and on demand, and its files.

A result computes a value when it is first used, and times each stage. Which facts, charts and files
it has is defined in the folder of its kind of design (see `gearcam.designs.kind`). Only the modules
that the requested files need are imported.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

import numpy as np

from gearcam.base.display import renderer
from gearcam.base.errors import GearcamError
from gearcam.base.facts import Facts
from gearcam.base.findings import Finding
from gearcam.base.inches import files_in, told
from gearcam.base.registry import deferred
from gearcam.base.tolerances import DEFAULT, Tolerances
from gearcam.numeric.arguments import one_of, refused
from gearcam.results.goals import demand_facts, goals_of
from gearcam.results.record import Record
from gearcam.results.staged import Staged
from gearcam.results.study import Progress, StudyResult, merged, silent
from gearcam.results.written import BuildOutput, demand_formats

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gearcam.numeric.mesh import Mesh
    from gearcam.numeric.pose import SpacePose
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import Scene

PICTURE: Final = "svg"
"""The format that shows the design as a picture."""
REPORT: Final = "report"
"""The format that describes the other files and is written last."""

_framed = deferred("gearcam.report.file:framed")
"""Returns the page of a result for a notebook; named like the renderer of `gearcam.base.display`,
since the report is made from results."""

_OF_STUDIES: Final = (
    "_studied",
    "_running",
    "_drawn",
    "facts_without_accuracy",
    "design_facts",
    "facts",
    "findings",
    "design_hash",
    "sought",
    "sizes",
)
"""What a result with other studies computes anew."""


class Result(Staged):
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

    for_users = (
        "chart", "charts", "check", "facts", "files", "findings", "picture", "plot", "record",
        "scene", "studies", "study", "to_dict", "with_settings", "write",
    )  # fmt: skip

    stages: ClassVar[Mapping[str, str]]
    """Attributes that a build computes before its files, by the names of the stages."""
    before_studies: ClassVar[Sequence[str]] = ()
    """The stages that studies need, computed once for all settings of a study."""

    def __init__(self, design: Any, tolerances: Tolerances = DEFAULT) -> None:
        super().__init__(design, tolerances)
        self.sizes: dict[str, int] = {}  # bytes of the files built so far
        self._studied: dict[str, StudyResult] = {}
        self._drawn: dict[str, Chart | None] = {}
        self._running: set[str] = set()  # studies that are being computed
        self.sought: dict[float, Any] = {}  # remedies found, by the patience of the search

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """The findings of all checks and of the studies that the design asks for, errors first.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> [(one.severity, one.code, one.where) for one in result.findings]
        [('note', 'no-backlash', 'pair')]
        """
        return merged(self.checked, self.studies.values())

    @property
    def findings_without_hints(self) -> tuple[Finding, ...]:
        """The same findings; those of checks need not name values that help."""
        return merged(self.checked_without_hints, self.studies.values())

    @property
    def studies(self) -> dict[str, StudyResult]:
        """The outcomes of the studies that the design asks for, by name, computed once.

        Without one that is being computed: it may use scene, charts and facts of the design.

        Examples
        --------
        >>> import gearcam as gc
        >>> asked = {"output.studies": ["mesh"], "meshing.steps": 4}
        >>> result = gc.build(gc.load("profiles/ellipse.toml").with_(asked))
        >>> list(result.studies), result.studies["mesh"].complete
        (['mesh'], True)
        """
        asked = (name for name in self.design.output.studies if name not in self._running)
        return {name: self.study(name) for name in asked}

    def study(self, name: str, progress: Progress | None = None, *, jobs: int = 1) -> StudyResult:
        """Return the outcome of a study with the settings of the design, computed once.

        Settings are a table of the design: ``result.design.with_({"meshing.steps": 72})`` has
        others. The outcome has `columns`, the rows of its CSV file; `facts`; `findings`; `charts`;
        and ``write(directory)``.

        Parameters
        ----------
        name : str
            The name of its command, such as ``mesh``.
        progress : callable, optional
            Called with a stage's name, the stages or steps done and their number.
        jobs : int
            Number of processes, for studies that take several: ``errors``.

        Returns
        -------
        StudyResult

        Raises
        ------
        DesignError
            If designs of this kind have no such study, or it takes one process only.
        InfeasibleError
            If the design, or its study, is impossible.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> study = result.with_settings("meshing", {"steps": 4}).study("mesh")
        >>> study.facts["meshing.contact_ratio"]["min"] > 1.6
        True
        """
        entry = self.kind.studies[one_of("name", name, self.kind.studies)]
        taken = entry.processes(jobs)
        outcome = self._studied.get(name)
        if outcome is None or outcome.interrupted:
            entry.demand(self.design)
            self._running.add(name)
            try:
                outcome = self._studied[name] = entry.compute(self, progress or silent, **taken)
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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> coarse = result.with_settings("meshing", {"steps": 4})
        >>> coarse.design.meshing.steps
        4
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
        """Return the picture of the file kind ``svg``, or why there is none, as SVG text.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> "<svg" in result.picture()
        True
        """
        if PICTURE not in self.kind.formats:
            return ""
        try:
            (data,) = self.files(PICTURE).values()
        except GearcamError as error:
            return renderer().refusal_picture(self.design.name, told(error, self.design.units))
        return data.decode()

    def _repr_html_(self) -> str:
        try:
            facts, findings = self.facts, self.findings
            if REPORT in self.kind.formats:
                return _framed(self)
        except GearcamError as error:
            return renderer().refusal(self.design.name, told(error, self.design.units))
        lines = [f"{one.severity}, {one.code}: {one.message} {one.where}" for one in findings]
        return renderer().page(self.picture(), facts, lines)

    @cached_property
    def facts(self) -> Facts:
        """All computed quantities by dotted names (see docs/summary.md).

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> round(result.facts["pair.center_distance_mm"], 4)
        41.9607
        >>> list(result.facts)[:3]
        ['pair.type', 'pair.module_mm', 'pair.teeth']
        """
        return self._with_studies(self.design_facts)

    def _with_studies(self, facts: Facts) -> Facts:
        return facts.with_groups({one.study.key: one.group for one in self.studies.values()})

    @cached_property
    def at_rest(self) -> Scene | None:
        """The parts at the first place of the driver, as `scene` has them, without studies."""
        return self.plain.scene(1)

    @property
    def place_of_solids(self) -> str:
        """Where a page shows the solids: "first", above the picture in the plane, or "after"."""
        return "after" if type(self).standing is not Result.standing else ""

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

    def record(self) -> dict[str, float | str]:
        """Return the result as one flat row of a table: plain numbers and texts, no lists, no None.

        Keys are ``name``, ``kind``, the dotted names of all facts but those of ``accuracy``, which
        take long, and what the checks found: ``findings.errors``, ``.warnings``, ``.notes``,
        counts, and ``findings.codes``. A range has two keys, ``pair.ratio.min`` and
        ``pair.ratio.max``; a list of lengths or places one for each, counted from 0, such as
        ``gears.0.size_mm.2``; a list of whole numbers is a text. Results of other laws or kinds may
        have other keys. Raises `InfeasibleError` if the design cannot be made.

        Examples
        --------
        >>> import gearcam as gc
        >>> design = gc.load("profiles/ellipse.toml")
        >>> designs = [design.with_({"law.eccentricity": e}) for e in (0.1, 0.3)]
        >>> rows = [gc.build(one).record() for one in designs]  # for a DataFrame(rows)
        >>> [round(row["pair.ratio.max"], 3) for row in rows]
        [1.222, 1.857]
        """
        facts = self._with_studies(self.facts_without_accuracy)
        row = Record({"name": self.design.name, "kind": self.design.kind, **facts.record()})
        findings = self.findings_without_hints
        for word in ("error", "warning", "note"):
            row[f"findings.{word}s"] = sum(one.severity == word for one in findings)
        row["findings.codes"] = ", ".join(dict.fromkeys(one.code for one in findings))
        return row

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``summary.json`` without the list of files.

        Facts, findings, design and versions as plain values, in the units of their names. Raises
        `InfeasibleError` if the design cannot be made.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> summary = result.to_dict()
        >>> summary["pair"]["teeth"], [one["code"] for one in summary["findings"]]
        ([41, 41], ['no-backlash'])
        """
        return self.summary(self.facts, self.findings).document()

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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> tables = result.files("csv")  # nothing is written
        >>> list(tables)
        ['gear1_outline.csv', 'gear2_outline.csv', 'centrodes.csv']
        >>> tables["centrodes.csv"][:21]
        b'phi1_deg,phi2_deg,rat'
        """
        demand_formats(self.design, (name,))
        with self.rows.named(), files_in(self.design.files_in):
            return self.kind.files[name](self, {} if measured is None else measured)

    @property
    def charts(self) -> tuple[str, ...]:
        """Names that `chart` and `plot` accept; `InfeasibleError` if it cannot be made.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> result.charts[:3]
        ('ratio', 'pressure_angle', 'contact_ratio')
        """
        names = (name for name in self.kind.charts if self._chart(name) is not None)
        return (*self._in_order(names), *self._study_charts)

    def leading(self, count: int) -> Iterator[tuple[str, Chart]]:
        """Yield names and charts of the first `count` charts, without those of studies."""
        drawn = ((name, self._chart(name)) for name in self._in_order(self.kind.charts))
        yield from islice(((name, one) for name, one in drawn if one is not None), count)

    def _in_order(self, names: Iterable[str]) -> Sequence[str]:
        """Return names of charts, those first that say most."""
        return tuple(names)

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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> chart = result.chart("ratio")
        >>> chart.title, chart.y
        ('Transmission ratio', 'ratio i21')
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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> axes = result.plot("ratio")
        >>> axes.get_xlabel()
        'driver angle phi1, deg'
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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> scene = result.scene(4)
        >>> scene.driver, scene.places
        ('driver angle phi1, deg', array([  0.,  90., 180., 270., 360.]))
        """
        from gearcam.pictures.scenes import PLACES

        scene = self.kind.scene(self, PLACES if places is None else places)
        if scene is None:
            return None
        studies = self.studies.values()
        more = [one.overlay(scene) for one in studies]
        curves = [curve for one in studies for curve in one.coloured()]
        contacts = {
            name: points
            for contacts in (scene.contacts, *more)
            for name, points in contacts.items()
        }
        forces = tuple(force for one in studies for force in one.joints(scene))
        coloured = (*scene.coloured, *curves)
        paces = [one.pace for one in studies if one.pace is not None]
        times = np.interp(scene.places, *paces[0].T) if paces else None
        return replace(scene, contacts=contacts, coloured=coloured, forces=forces, times=times)

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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> written = result.check("output")
        >>> written.files
        ('summary.json',)
        """
        self.demand_goals()
        return self.summary(self.facts, self.findings).write(directory, {}, keep=True)

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

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> written = result.write("output", files=["dxf"])
        >>> written.files
        ('gear1.dxf', 'gear2.dxf', 'pair.dxf', 'summary.json')
        """
        formats = sorted(demand_formats(self.design, files), key=lambda name: name == REPORT)
        studies = self.design.output.studies
        steps = [*self.stages, *studies, *formats, "writing"]

        def tell(step: str, *_: int) -> None:
            if step in steps:
                (progress or silent)(step, steps.index(step), len(steps))

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
        return self.summary(facts, self.findings).write(directory, contents, keep=False)

    def demand_goals(self) -> None:
        """Refuse goals of the design that are no numbers among its facts (`DesignError`)."""
        goals = goals_of(self.design)
        if goals:
            demand_facts(goals, self.record())

    @property
    def more_files(self) -> dict[str, bytes]:
        """Contents of files, by name, that are written with any format."""
        return {}
