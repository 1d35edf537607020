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

from gearcam.design import KINDS, hash_of
from gearcam.errors import DesignError, Problem
from gearcam.findings import Finding
from gearcam.jobs.written import Written, finish
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
        self,
        files: Mapping[str, str | None] | None = None,
        extras: dict[str, Any] | None = None,
    ) -> dict[str, Any]:
        """Return the summary of the build, for JSON: what does not exist is left out.

        Parameters
        ----------
        files : mapping of str to str or None, optional
            Files beside it, each with the hash of the design that it was made from.
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

    @cached_property
    def design_hash(self) -> str:
        """The hash of the design as it was when its law or program was made."""
        return hash_of(self.design)

    def _beside(self, folder: Path, *made: str) -> dict[str, str | None]:
        """Return the files of a folder after this job has made some, with their designs' hashes."""
        from gearcam.export.write import previous_files

        return previous_files(folder) | dict.fromkeys(made, self.design_hash)

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
        folder = Path(directory) / self.design.name
        summary = self.summary(self._beside(folder))
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
        summary = self.summary(dict.fromkeys(contents, self.design_hash), extras)
        return finish(folder, contents, summary, self.findings)
