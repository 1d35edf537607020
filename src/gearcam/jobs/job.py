"""What every job has: stages that are timed once, findings, a summary, files all or none.

A job computes nothing until it is asked for. Nothing is imported that the asked-for files do not
need.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

from gearcam.design import KINDS
from gearcam.errors import DesignError, Problem
from gearcam.findings import Finding
from gearcam.jobs.written import Written, finish
from gearcam.numeric.memory import keep_freed_memory
from gearcam.tolerances import DEFAULT, Tolerances

Progress = Callable[[str, int, int], None]


class Job(ABC):
    """A design, computed on demand.

    Parameters
    ----------
    design : GearPairDesign or CamDesign
        What is asked for.
    tolerances : Tolerances
        Inner accuracy.
    """

    stages: ClassVar[Mapping[str, str]]
    """The attributes that a build computes before its files, by what they are called."""

    def __init__(self, design: Any, tolerances: Tolerances = DEFAULT) -> None:
        self.design = design
        self.tolerances = tolerances
        self.timings: dict[str, float] = {}
        keep_freed_memory()

    @contextmanager
    def _stage(self, name: str) -> Iterator[None]:
        start = time.perf_counter()
        yield
        self.timings[name] = self.timings.get(name, 0.0) + time.perf_counter() - start

    @cached_property
    @abstractmethod
    def findings(self) -> tuple[Finding, ...]:
        """What the checks found: errors first."""

    @abstractmethod
    def summary(
        self, files: Sequence[str] = (), extras: dict[str, Any] | None = None
    ) -> dict[str, Any]:
        """Return the summary of the build, for JSON: what does not exist is left out.

        Parameters
        ----------
        files : sequence of str
            Names of the files written beside it.
        extras : dict, optional
            What the exporters measured.

        Returns
        -------
        dict
            As described in docs/conventions.md.
        """

    @abstractmethod
    def _export(self, kind: str, extras: dict[str, Any]) -> dict[str, bytes]:
        """Return the files of one kind."""

    def _demand_formats(self, kinds: Sequence[str]) -> None:
        known = KINDS[self.design.kind].formats
        problems = [
            Problem(
                f"{kind} is no file of designs of kind {self.design.kind}",
                file=self.design.source,
                key="output.files",
                value=kind,
                allowed=", ".join(known),
            )
            for kind in kinds
            if kind not in known
        ]
        if problems:
            raise DesignError(problems)

    def check(self, directory: str | Path = "output") -> Written:
        """Run the checks and write the summary only; files of an earlier build stay listed in it.

        Parameters
        ----------
        directory : path
            Parent folder.

        Returns
        -------
        Written
            With the summary as its only file.
        """
        from gearcam.export.write import previous_files

        folder = Path(directory) / self.design.name
        summary = self.summary(previous_files(folder))
        return finish(folder, {}, summary, self.findings, keep=True)

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
        files : sequence of str, optional
            Kinds of files, instead of those the design lists.
        progress : callable, optional
            Called with a stage's name, the stages done and their number.

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
        kinds = tuple(self.design.output.files if files is None else files)
        self._demand_formats(kinds)
        steps = [*self.stages, *kinds, "writing"]

        def tell(step: str) -> None:
            if progress is not None:
                progress(step, steps.index(step), len(steps))

        for step, attribute in self.stages.items():
            tell(step)
            getattr(self, attribute)
        contents: dict[str, bytes] = {}
        extras: dict[str, Any] = {}
        for kind in kinds:
            tell(kind)
            with self._stage(kind):
                contents |= self._export(kind, extras)
        tell("writing")
        folder = Path(directory) / self.design.name
        summary = self.summary(tuple(contents), extras)
        return finish(folder, contents, summary, self.findings)
