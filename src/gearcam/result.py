"""Results: what comes of a design, stage by stage, on demand, and the writing of its files.

A result computes nothing until it is asked for, and each stage is timed once. It knows neither
readers nor files: what facts and files are made from it the folder of its kind says (see
`gearcam.designs.kind`). Nothing is imported that the asked-for files do not need.
"""

from __future__ import annotations

import sys
import time
from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final

from gearcam.designs.design import hash_of, summary_of
from gearcam.designs.kind import KINDS
from gearcam.display import Displayed, cut
from gearcam.errors import GearcamError
from gearcam.facts import Fact, Facts
from gearcam.findings import Finding
from gearcam.numerals import tree
from gearcam.numeric.arguments import one_of
from gearcam.tolerances import DEFAULT, Tolerances
from gearcam.written import Written, demand_formats, put, versions

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from trimesh import Trimesh

    from gearcam.charts import Chart
    from gearcam.parts.body import Part
    from gearcam.solids import Mesh

FORMAT: Final = 3
"""Version of the summary's layout."""

PICTURE: Final = "svg"
"""The kind of file that is a picture."""
REPORT: Final = "report"
"""The kind of file that tells of the others and is made last."""

Progress = Callable[[str, int, int], None]
"""Called with a stage's name, the stages done and their number."""


class Result(Displayed):
    """What comes of a design, computed on demand.

    Parameters
    ----------
    design : Design
        What is asked for.
    tolerances : Tolerances
        Inner accuracy.

    Examples
    --------
    >>> import gearcam as gc
    >>> isinstance(gc.build(gc.load("profiles/ellipse.toml")), gc.Result)
    True
    """

    stages: ClassVar[Mapping[str, str]]
    """The attributes that a build computes before its files, by what they are called."""
    before_output: ClassVar[Sequence[str]] = ()
    """Those of them that the table ``[output]`` of a design does not change."""

    def __init__(self, design: Any, tolerances: Tolerances = DEFAULT) -> None:
        self.design = design
        self.tolerances = tolerances
        self.timings: dict[str, float] = {}
        self.sizes: dict[str, int] = {}  # bytes of the files of a build so far
        self.sought: dict[float, Any] = {}  # remedies, by the patience of the search

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.design, self.tolerances)  # computed again where it is read

    def __repr__(self) -> str:
        done = ", ".join(self.timings) or "nothing"
        return cut(f'<{type(self).__name__} of "{self.design.name}", computed: {done}>')

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time what is done within, under a `name`."""
        start = time.perf_counter()
        yield
        self.timings[name] = self.timings.get(name, 0.0) + time.perf_counter() - start

    @cached_property
    @abstractmethod
    def findings(self) -> tuple[Finding, ...]:
        """What the checks found: errors first."""

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """What is made, as parts with all that is ordered; none where a kind has none."""
        return ()

    @cached_property
    def solids(self) -> dict[str, Trimesh]:
        """The parts as closed meshes of trimesh by name, mm, each in its own frame.

        From z = 0 to the width, hubs beyond; what cannot be made raises `InfeasibleError`.
        """
        from gearcam.export.mesh import trimeshes

        return trimeshes(self.meshes)

    @cached_property
    def meshes(self) -> dict[str, Mesh]:
        """The parts as closed meshes of plain arrays by name, mm: what files are made from."""
        from gearcam.solids import solid

        return {part.name: solid(part) for part in self.parts}

    def picture(self) -> str:
        """Return the picture of the file kind ``svg``, or a refusal; none without it."""
        if PICTURE not in KINDS[self.design.kind].formats:
            return ""
        try:
            (data,) = self.files(PICTURE).values()
        except GearcamError as error:
            from gearcam.markup import refusal_picture

            return refusal_picture(self.design.name, error)
        return data.decode()

    def _repr_html_(self) -> str:
        from gearcam.markup import page, refusal

        try:
            facts, findings = self.facts, self.findings
            if REPORT in KINDS[self.design.kind].formats:
                return KINDS[self.design.kind].room("files").framed(self)
        except GearcamError as error:
            return refusal(self.design.name, error)
        told = [f"{one.severity}, {one.code}: {one.message} {one.where}" for one in findings]
        return page(self.picture(), facts, told)

    @cached_property
    def design_hash(self) -> str:
        """The hash of the design, its CSV files as they were first read."""
        return hash_of(self.design)

    @cached_property
    def facts(self) -> Facts:
        """What is known of the result, under the names that docs/conventions.md explains."""
        return self.facts_with({})

    def facts_with(self, measured: Mapping[str, Any]) -> Facts:
        """Return the facts with what was `measured` on files or by studies, by group."""
        made = KINDS[self.design.kind].room("facts").facts(self, measured)
        columns = sys.modules.get("gearcam.laws.columns")  # not loaded where no design read a file
        tables = columns.tables_in(self.design) if columns else ()
        notes = [Fact(rows.note, Path(rows.file).name, shown=True) for rows in tables]
        return made.with_group("tables", [{"note": one} for one in notes if one.value])

    def to_dict(self) -> dict[str, Any]:
        """Return what ``summary.json`` holds, but for the files: facts, findings, design, versions.

        Plain values, in the units of their names. What cannot be made raises `InfeasibleError`.
        """
        return self.document(self.facts, self.findings)

    def document(
        self, facts: Facts, findings: Sequence[Finding], files: Mapping[str, Any] | None = None
    ) -> dict[str, Any]:
        """Return a summary.

        Parameters
        ----------
        facts, findings
            What is known, and what checks found.
        files : mapping, optional
            What it says of files.

        Returns
        -------
        dict
            As JSON holds it.
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

    def files(self, kind: str, measured: dict[str, Any] | None = None) -> dict[str, bytes]:
        """Return the files of one kind.

        Parameters
        ----------
        kind : str
            One that ``output.files`` may list.
        measured : dict, optional
            What is measured on them is written down here.

        Returns
        -------
        dict of str to bytes
            Contents by file name.

        Raises
        ------
        DesignError
            If designs of this kind have no such files.
        InfeasibleError
            If they cannot be made.
        """
        demand_formats(self.design, (kind,))
        makers = KINDS[self.design.kind].room("files").FILES
        return makers[kind](self, {} if measured is None else measured)

    @property
    def charts(self) -> tuple[str, ...]:
        """The names of the charts of designs of this kind."""
        return tuple(KINDS[self.design.kind].room("charts").CHARTS)

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
            If what it tells of cannot be made.
        """
        make = KINDS[self.design.kind].room("charts").CHARTS[one_of("name", name, self.charts)]
        return make(self)

    def plot(self, name: str, ax: Axes | None = None) -> Axes:
        """Draw a chart with matplotlib and return its axes.

        Parameters
        ----------
        name : str
            One of `charts`.
        ax : Axes, optional
            Where; a new figure where left out.

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

    def check(self, directory: str | Path = "output") -> Written:
        """Run the checks and write the summary only; files of an earlier build stay.

        They stay listed, under ``stale`` if they were made from another state of the design.

        Parameters
        ----------
        directory : path
            Parent folder.

        Returns
        -------
        Written
            With the summary as its only file.
        """
        return self.keep({}, directory, {})

    def write(
        self,
        directory: str | Path = "output",
        files: Sequence[str] | None = None,
        progress: Progress | None = None,
    ) -> Written:
        """Write the files of the design into ``directory/<name>/``, all or none.

        Parameters
        ----------
        directory : path
            Parent folder.
        files : str or sequence of str, optional
            Kinds of files, one or more, instead of those the design lists.
        progress : callable, optional
            As `Progress` says.

        Returns
        -------
        Written
            With the files written and the stale ones removed.

        Raises
        ------
        DesignError
            If designs of this kind have no such files.
        InfeasibleError
            If the design cannot be made; nothing is written or removed then.
        WriteError
            If the disk refuses.
        """
        kinds = sorted(demand_formats(self.design, files), key=lambda kind: kind == REPORT)
        steps = [*self.stages, *kinds, "writing"]

        def tell(step: str) -> None:
            if progress is not None:
                progress(step, steps.index(step), len(steps))

        for step, attribute in self.stages.items():
            tell(step)
            getattr(self, attribute)
        contents: dict[str, bytes] = {}
        measured: dict[str, Any] = {}
        for kind in kinds:
            tell(kind)
            with self.stage(kind):
                contents |= self.files(kind, measured)
            self.sizes = {name: len(content) for name, content in contents.items()}
        tell("writing")
        return put(self, directory, contents, measured, self.findings)

    def keep(
        self,
        contents: Mapping[str, bytes],
        directory: str | Path,
        measured: Mapping[str, Any],
        findings: Sequence[Finding] | None = None,
    ) -> Written:
        """Write some files beside those of an earlier build, which stay.

        Parameters
        ----------
        contents : mapping of str to bytes
            By name.
        directory : path
            Parent folder.
        measured : mapping
            What the summary says of them.
        findings : sequence of Finding, optional
            Those of the checks where left out.

        Returns
        -------
        Written
        """
        found = self.findings if findings is None else findings
        return put(self, directory, contents, measured, found, keep=True)
