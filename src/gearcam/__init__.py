"""gearcam: from a description of a motion to a cam, or a pair of non-circular gears, to be cut.

    design = gearcam.load("profiles/nail_machine_two_phase.toml")
    result = gearcam.build(design)
    result.pair.module, result.findings, result.gear1.outline
    result.write("output", files=["dxf"])
    gearcam.remedies(result).found  # where it is refused or has errors: what would work

Importing the package loads nothing else: `load` and `build` bring in what they need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcam.version import __version__

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from gearcam.advice import Remedies
    from gearcam.designs import Design
    from gearcam.errors import InfeasibleError
    from gearcam.result import Result

__all__ = ["__version__", "build", "design", "load", "loads", "remedies"]


def load(path: str | os.PathLike[str]) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : path
        A TOML file.

    Returns
    -------
    Design
        What is asked for, in mm and rad, of the file's kind.

    Raises
    ------
    DesignError
        With every problem of the file at once.
    """
    from gearcam.designs import load as read

    return read(path)


def loads(text: str) -> Design:
    """Read the text of a design file.

    Parameters
    ----------
    text : str
        TOML; a key ``name`` is needed. CSV files are looked for in the current folder.

    Returns
    -------
    Design
        As from `load`.

    Raises
    ------
    DesignError
        With every problem of the text at once, each with its line.
    """
    from gearcam.designs import loads as read

    return read(text)


def design(document: Mapping[str, Any]) -> Design:
    """Make a design of nested dictionaries that hold what a design file would.

    Parameters
    ----------
    document : mapping
        With the keys and the units of a file: ``kind`` and ``name`` among them.

    Returns
    -------
    Design
        As from `load`.

    Raises
    ------
    DesignError
        With every problem at once, each with its key.
    """
    from gearcam.designs import design as made

    return made(document)


def build(design: Design) -> Any:
    """Return the result of a design; nothing is computed until it is asked for.

    Parameters
    ----------
    design : Design
        What is asked for.

    Returns
    -------
    Result
        Of the design's kind: its attributes compute what they name and raise `InfeasibleError` for
        what cannot be made.
    """
    from gearcam.designs.kind import KINDS

    return KINDS[design.kind].room("build").build(design)


def remedies(
    result: Result, refusal: InfeasibleError | None = None, *, patience: float = 6.0
) -> Remedies:
    """Search for changes with which a refused design, or one with errors, can be made.

    Parameters
    ----------
    result : Result
        From `build`.
    refusal : InfeasibleError, optional
        How it was refused; found by building where left out.
    patience : float, s
        Time after which no other design is tried.

    Returns
    -------
    Remedies
        Each was built: nothing is refused, what was an error is gone, and no other has come.
    """
    from gearcam.advice import remedies as search

    return search(result, refusal, patience=patience)
