"""gearcam: cams and pairs of non-circular gears from a description of their motion.

    design = gearcam.load("profiles/nail_machine_two_phase.toml")
    result = gearcam.build(design)
    result.pair.module, result.findings, result.gear1.outline
    result.write("output", files=["dxf"])
    gearcam.remedies(result).found  # changes that make a failing design work

Importing the package is fast: modules are loaded when they are needed. Classes of designs and of
their parts are attributes too; ``dir(gearcam)`` lists all names.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcam.base.registry import lazy_names
from gearcam.version import __version__

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from gearcam import laws
    from gearcam.base.errors import (
        DesignError,
        GearcamError,
        InfeasibleError,
        MissingExtraError,
        WriteError,
    )
    from gearcam.base.facts import Facts
    from gearcam.base.findings import Finding
    from gearcam.base.tolerances import Tolerances
    from gearcam.designs import Design
    from gearcam.kinds import *  # noqa: F403
    from gearcam.kinds import build
    from gearcam.laws import motion as motion_laws
    from gearcam.numeric.columns import Columns
    from gearcam.results.advice import Remedies
    from gearcam.results.result import Result
    from gearcam.results.study import StudyResult


__all__ = [
    "Columns", "Design", "DesignError", "Facts", "Finding", "GearcamError", "InfeasibleError",
    "MissingExtraError", "Result", "StudyResult", "Tolerances", "WriteError", "__version__",
    "build",
    "design", "laws", "load", "loads", "motion_laws", "remedies",
]  # fmt: skip

_HOMES = {
    "gearcam.designs": ("Design",),
    "gearcam.base.errors": (
        "DesignError", "GearcamError", "InfeasibleError", "MissingExtraError", "WriteError",
    ),
    "gearcam.base.facts": ("Facts",),
    "gearcam.base.findings": ("Finding",),
    "gearcam.kinds": ("build",),
    "gearcam.laws": ("laws",),
    "gearcam.laws.motion": ("motion_laws",),
    "gearcam.numeric.columns": ("Columns",),
    "gearcam.results.result": ("Result",),
    "gearcam.results.study": ("StudyResult",),
    "gearcam.base.tolerances": ("Tolerances",),
}  # fmt: skip
"""Names that are imported on demand, by their modules; kinds of design add theirs."""


def _of_kinds() -> dict[str, type]:
    from gearcam.results.kind import KINDS

    return {name: one for kind in KINDS.values() for name, one in kind.public.items()}


if not TYPE_CHECKING:  # so that type checkers report misspelt names
    __getattr__, _ = lazy_names("gearcam has no", _of_kinds, _HOMES)


def __dir__() -> list[str]:
    return sorted({*__all__, *_of_kinds()})


def load(path: str | os.PathLike[str]) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : path
        A TOML file.

    Returns
    -------
    Design
        The design, in mm and rad; its class depends on ``kind`` in the file.

    Raises
    ------
    DesignError
        With all mistakes in the file at once.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.load("profiles/ellipse.toml").name
    'ellipse'
    """
    from os import PathLike

    from gearcam.designs import load as read
    from gearcam.numeric.arguments import instance

    return read(instance("path", path, (str, PathLike), "a path"))


def loads(text: str) -> Design:
    """Read the text of a design file.

    Parameters
    ----------
    text : str
        TOML with a key ``name``. Paths of CSV files are relative to the current folder.

    Returns
    -------
    Design
        As from `load`.

    Raises
    ------
    DesignError
        With all mistakes in the text at once, each with its line.

    Examples
    --------
    >>> import gearcam as gc
    >>> from pathlib import Path
    >>> gc.loads(Path("profiles/ellipse.toml").read_text()).name
    'ellipse'
    """
    from gearcam.designs import loads as read
    from gearcam.numeric.arguments import instance

    return read(instance("text", text, str, "the text of a design file"))


def design(document: Mapping[str, Any]) -> Design:
    """Return a design from nested dictionaries with the content of a design file.

    Parameters
    ----------
    document : mapping
        Keys and values as in a design file, in its units, including ``kind`` and ``name``.

    Returns
    -------
    Design
        As from `load`.

    Raises
    ------
    DesignError
        With all mistakes at once, each with its key.

    Examples
    --------
    >>> import gearcam as gc
    >>> document = gc.load("profiles/ellipse.toml").to_dict()
    >>> document["law"]["eccentricity"] = 0.2
    >>> gc.design(document).name
    'ellipse'
    """
    from collections.abc import Mapping

    from gearcam.designs import design as made
    from gearcam.numeric.arguments import instance

    return made(instance("document", document, Mapping, "a mapping of the keys of a design file"))


def remedies(
    result: Result, refusal: InfeasibleError | None = None, *, patience: float = 6.0
) -> Remedies:
    """Search for changes that make a refused design, or one with errors, work.

    Parameters
    ----------
    result : Result
        From `build`.
    refusal : InfeasibleError, optional
        The error with which it was refused; found by building it by default.
    patience : float, s
        Time of the search on a usual machine, at ten designs a second. Designs are counted, not
        time, so that the answer is the same everywhere.

    Returns
    -------
    Remedies
        Each was built without refusal and without findings of severity ``error``.

    Raises
    ------
    DesignError
        If the argument is not a result.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"blank.bore_diameter_mm": 60})
    >>> found = gc.remedies(gc.build(design), patience=60.0).found
    >>> [list(one.changes) for one in found]
    [['blank.bore_diameter_mm']]
    """
    from gearcam.numeric.arguments import instance
    from gearcam.results.advice import remedies as search
    from gearcam.results.result import Result

    instance("result", result, Result, "a result, as returned by build")
    return search(result, refusal, patience=patience)
