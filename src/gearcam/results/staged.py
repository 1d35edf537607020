"""A design with its stages: what a result is before studies, and what studies look at."""

from __future__ import annotations

import time
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property
from typing import Any, Self

from gearcam.base.display import NotebookView, cut
from gearcam.base.facts import Facts, Tree
from gearcam.base.findings import Finding
from gearcam.base.inches import told
from gearcam.base.tolerances import DEFAULT, Tolerances
from gearcam.designs.design import hash_of
from gearcam.results.kind import Kind, kind_of
from gearcam.results.table_rows import TableRows
from gearcam.results.written import Summary


class Staged(NotebookView):
    """A design whose stages are computed when they are first used, each once, and timed.

    Parameters
    ----------
    design : Design
        The design to build.
    tolerances : Tolerances
        Accuracy of the internal computations.
    """

    for_users = ("design",)

    def __init__(self, design: Any, tolerances: Tolerances = DEFAULT) -> None:
        self.design = design
        self.tolerances = tolerances
        self.timings: dict[str, float] = {}

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.design, self.tolerances)  # the copy computes anew

    def __repr__(self) -> str:
        done = ", ".join(self.timings) or "nothing"
        return cut(f'<{type(self).__name__} of "{self.design.name}", computed: {done}>')

    def with_chords(self, tolerance: float) -> Self:  # noqa: ARG002
        """Return the result with another chord `tolerance`, mm; the same without outlines."""
        return self

    def coarse(self) -> Self:
        """Return the result for a draft: outlines and solids are only looked at.

        It keeps what does not depend on how fine these are. `InfeasibleError` if the design cannot
        be made.
        """
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

    @property
    def rows(self) -> TableRows:
        """The rows of the tables of the design."""
        return TableRows(design=self.design)

    @cached_property
    def design_hash(self) -> str:
        """The hash of the design, with the contents of its CSV files as first read."""
        return hash_of(self.design)

    @cached_property
    def accuracy(self) -> Tree | None:
        """The estimated errors as facts, with ``how`` for each; None without estimates."""
        return None

    @cached_property
    def facts_without_accuracy(self) -> Facts:
        """The facts without those of studies and without estimated errors.

        For searches, rows of tables and drafts, which do not show how accurate they are: estimates
        take as long as half of the checks.
        """
        tables = [{"note": note} for note in self.rows.notes]
        facts = self.kind.facts(self).repeating(self.kind.repeated)
        return facts.with_groups({"tables": tables})

    @cached_property
    def design_facts(self) -> Facts:
        """The facts without those of studies."""
        return self.facts_without_accuracy.with_groups({"accuracy": self.accuracy})

    @property
    def main_errors(self) -> Sequence[tuple[str, Sequence[str]]]:
        """Errors that users act on: label, and names of facts of ``accuracy``.

        Of several facts the largest counts.
        """
        return ()

    def summary(self, facts: Facts, findings: Sequence[Finding]) -> Summary:
        """Return the summary of the result, or of a study.

        Parameters
        ----------
        facts : Facts
            Told in the unit of files.
        findings : sequence of Finding
            Told in that of the design, whose keys they name.
        """
        return Summary(
            design=self.design,
            design_hash=self.design_hash,
            facts=told(facts, self.design.files_in),
            findings=told(tuple(findings), self.design.units),
            timings=self.timings,
        )
