"""What a command has written, and the requested kinds of files."""

from __future__ import annotations

import platform
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Facts
from gearcam.base.findings import Finding
from gearcam.designs.design import Design
from gearcam.designs.kind import KINDS
from gearcam.version import __version__


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
    interrupted: str = ""
    table: tuple[str, ...] = ()


def demand_formats(design: Design, kinds: Sequence[str] | None) -> tuple[str, ...]:
    """Return the requested kinds of files, if designs of this kind have them.

    Parameters
    ----------
    design : Design
        Of any kind.
    kinds : str, sequence of str or None
        The requested kinds of files; None: those that the design lists.

    Returns
    -------
    tuple of str

    Raises
    ------
    DesignError
        If a kind of file is not available; the message lists those that are.
    """
    formats = KINDS[design.kind].formats
    asked = design.output.files if kinds is None else kinds
    wanted = (asked,) if isinstance(asked, str) else tuple(asked)
    problems = [
        Problem(
            f"designs of kind {design.kind} have no {kind} files",
            file=design.source,
            key="output.files",
            value=kind,
            allowed=", ".join(formats),
        )
        for kind in wanted
        if kind not in formats
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
