"""The summary of a result, what a command has written with it, and the requested formats."""

from __future__ import annotations

import json
import platform
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Facts
from gearcam.base.findings import Finding
from gearcam.base.numerals import tree
from gearcam.designs.design import Design, summary_of
from gearcam.designs.kind import KINDS, as_written
from gearcam.version import __version__

FORMAT: Final = 1
"""Version of the layout of ``summary.json``."""


@dataclass(frozen=True, kw_only=True)
class BuildOutput(ShortRepr):
    """The files that a command has written.

    Parameters
    ----------
    directory : Path
        The folder of the design.
    files : tuple of str
        The files written, in order.
    removed : tuple of str
        Files of the previous build that are no longer produced.
    summary : dict
        The content of ``summary.json``.
    facts : Facts
        The facts in the summary.
    findings : tuple of Finding
        The findings in the summary.
    kept : tuple of str
        Files of the previous build that are no longer produced but were not removed, since the user
        may have edited them.
    former : dict of str to str
        Files of these names that the user may have edited, and that are kept: their names before,
        by those that they have now.
    interrupted : str
        How much of a study was done when it was interrupted; empty if it is complete.
    table : tuple of str
        Lines to print in place of the facts.
    """

    directory: Path
    files: tuple[str, ...]
    removed: tuple[str, ...]
    summary: dict[str, Any]
    facts: Facts
    findings: tuple[Finding, ...]
    kept: tuple[str, ...] = ()
    former: Mapping[str, str] = field(default_factory=dict)
    interrupted: str = ""
    table: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Summary:
    """What ``summary.json`` says of a result or a study.

    Parameters
    ----------
    design : Design
        The design.
    design_hash : str
        Its hash.
    facts, findings
        Of the result or the study.
    timings : mapping of str to float, s
        Run times by stage.
    """

    design: Design
    design_hash: str
    facts: Facts
    findings: tuple[Finding, ...]
    timings: Mapping[str, float]

    def document(self, files: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Return it as plain values for JSON, with entries about `files`."""
        return tree(
            {
                "format": FORMAT,
                "name": self.design.name,
                "kind": self.design.kind,
                **({"units": units} if (units := self.design.files_in) != "mm" else {}),
                **self.facts.document,
                "hash": self.design_hash,
                **(files or {}),
                "findings": [finding.as_dict() for finding in self.findings],
                "timings_s": {name: round(value, 6) for name, value in self.timings.items()},
                "versions": versions(),
                "design": summary_of(self.design),
            }
        )

    def write(
        self, directory: str | Path, contents: Mapping[str, bytes], *, keep: bool
    ) -> BuildOutput:
        """Write files and the summary, all or none.

        Parameters
        ----------
        directory : path
            Parent folder.
        contents : mapping of str to bytes
            The files by name.
        keep : bool
            Whether the other files of an earlier build are kept.

        Returns
        -------
        BuildOutput

        Raises
        ------
        WriteError
            If a file cannot be written.
        """
        from gearcam.export.listing import planned
        from gearcam.export.write import SUMMARY, writing

        folder = Path(directory) / self.design.name
        with writing(directory, self.design.name) as replace_files:
            plan = planned(folder, contents, self.design_hash, keep=keep)
            summary = self.document(plan.about)
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
            facts=self.facts,
            findings=self.findings,
        )


def demand_formats(design: Design, formats: Sequence[str] | None) -> tuple[str, ...]:
    """Return the requested formats, if designs of this kind have them.

    Parameters
    ----------
    design : Design
        Of any kind.
    formats : str, sequence of str or None
        The requested formats; None: those that the design lists.

    Returns
    -------
    tuple of str

    Raises
    ------
    DesignError
        If a format is not available; the message lists those that are.
    """
    available = KINDS[design.kind].formats
    names = design.output.files if formats is None else formats
    wanted = (names,) if isinstance(names, str) else tuple(names)
    problems = [
        Problem(
            f"designs of {as_written(KINDS[design.kind])} have no {name} files",
            file=design.source,
            key="output.files",
            value=name,
            allowed=", ".join(available),
        )
        for name in wanted
        if name not in available
    ]
    if problems:
        raise DesignError(problems)
    return wanted


def versions() -> dict[str, str]:
    """Return the versions of gearcam, Python and the numerical libraries loaded so far."""
    numbers = {"gearcam": __version__, "python": platform.python_version()}
    for name in ("numpy", "shapely", "ezdxf", "manifold3d", "trimesh"):
        module = sys.modules.get(name)
        if module is not None and hasattr(module, "__version__"):
            numbers[name] = str(module.__version__)
    return numbers
