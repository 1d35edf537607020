"""What a job has done to its folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcam.findings import Finding
from gearcam.numerals import tree


@dataclass(frozen=True, kw_only=True)
class Written:
    """What a build has done to its folder.

    Parameters
    ----------
    directory : Path
        The folder.
    files, removed : tuple of str
        Names of the files written, and of the stale ones removed.
    summary : dict
        As in ``summary.json``.
    findings : tuple of Finding
        What the checks found.
    complete : bool
        Whether nothing was interrupted.
    """

    directory: Path
    files: tuple[str, ...]
    removed: tuple[str, ...]
    summary: dict[str, Any]
    findings: tuple[Finding, ...]
    complete: bool = True


def finish(
    folder: Path,
    contents: Mapping[str, bytes],
    summary: dict[str, Any],
    findings: Sequence[Finding],
    *,
    keep: bool = False,
) -> Written:
    """Write files and their summary, all or none.

    Parameters
    ----------
    folder : Path
        Where.
    contents : mapping of str to bytes
        Files by name.
    summary : dict
        Becomes ``summary.json``.
    findings : sequence of Finding
        Of the checks.
    keep : bool
        Whether files of an earlier build stay.

    Returns
    -------
    Written
    """
    import json

    from gearcam.export.write import SUMMARY, write_all

    summary = tree(summary)
    text = json.dumps(summary, indent=2, ensure_ascii=False, allow_nan=False)
    everything = {**contents, SUMMARY: (text + "\n").encode()}
    removed = write_all(folder, everything, keep=keep)
    return Written(
        directory=folder,
        files=tuple(everything),
        removed=tuple(removed),
        summary=summary,
        findings=tuple(findings),
    )
