"""gearcam: from a description of a motion to a cam, or a pair of non-circular gears, to be cut.

    design = gearcam.load("profiles/nail_machine_two_phase.toml")
    result = gearcam.build(design)
    result.pair.module, result.findings, result.gear1.outline
    result.write("output", files=["dxf"])
    gearcam.remedies(result).found  # where it is refused or has errors: what would work

Importing the package loads nothing else: what is asked for brings in what it needs. Classes of
designs and of their parts are attributes too; ``dir(gearcam)`` tells of all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcam.version import __version__

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping
    from typing import Protocol, TypeVar

    from gearcam import laws
    from gearcam.advice import Remedies
    from gearcam.designs import Design
    from gearcam.errors import (
        DesignError,
        GearcamError,
        InfeasibleError,
        MissingExtraError,
        WriteError,
    )
    from gearcam.facts import Facts
    from gearcam.findings import Finding
    from gearcam.kinds import *  # noqa: F403
    from gearcam.laws import rises
    from gearcam.numeric.columns import Columns
    from gearcam.result import Result
    from gearcam.study import Study
    from gearcam.tolerances import Tolerances

    _R = TypeVar("_R", covariant=True)

    class _Buildable(Protocol[_R]):
        @property
        def _built(self) -> _R: ...


__all__ = [
    "Columns", "Design", "DesignError", "Facts", "Finding", "GearcamError", "InfeasibleError",
    "MissingExtraError", "Result", "Study", "Tolerances", "WriteError", "__version__", "build",
    "design", "laws", "load", "loads", "remedies", "rises",
]  # fmt: skip

_HOMES = {
    **dict.fromkeys(
        ("DesignError", "GearcamError", "InfeasibleError", "MissingExtraError", "WriteError"),
        "gearcam.errors",
    ),
    "Columns": "gearcam.numeric.columns",
    "Design": "gearcam.designs",
    "Facts": "gearcam.facts",
    "Finding": "gearcam.findings",
    "Result": "gearcam.result",
    "Study": "gearcam.study",
    "Tolerances": "gearcam.tolerances",
    "laws": "gearcam.laws",
    "rises": "gearcam.laws.rises",
}
"""Modules of names that are brought in when they are asked for; those of kinds are found."""


def _brought(name: str) -> Any:
    """Return what is brought in when it is asked for: classes of designs, laws, errors."""
    from importlib import import_module

    if name in _HOMES:
        module = import_module(_HOMES[name])
        return getattr(module, name, module)
    made = _of_kinds() if name[:1].isupper() else {}
    if name in made:
        return made[name]
    raise AttributeError(f"gearcam has no {name}; dir(gearcam) tells of all")


if not TYPE_CHECKING:  # type checkers know the names, and find misspelt ones
    __getattr__ = _brought


def __dir__() -> list[str]:
    return sorted({*__all__, *_of_kinds()})


def _of_kinds() -> dict[str, type]:
    from gearcam.designs.kind import KINDS
    from gearcam.quantities import described

    rooms = [kind.room("public") for kind in KINDS.values()]
    return {name: described(getattr(room, name)) for room in rooms for name in room.__all__}


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
        TOML; a key ``name`` is needed. CSV files are looked for in the current folder.

    Returns
    -------
    Design
        As from `load`.

    Raises
    ------
    DesignError
        With every problem of the text at once, each with its line.

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

    return made(instance("document", document, Mapping, "a mapping, as of a design file"))


def build(design: _Buildable[_R], tolerances: Tolerances | None = None) -> _R:
    """Return the result of a design; nothing is computed until it is asked for.

    Parameters
    ----------
    design : Design
        What is asked for.
    tolerances : Tolerances, optional
        Inner accuracy.

    Returns
    -------
    Result
        Of the design's kind: its attributes compute what they name and raise `InfeasibleError` for
        what cannot be made.

    Raises
    ------
    DesignError
        If it is no design.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/ellipse.toml"))
    >>> round(result.contact_ratio, 3)
    1.705
    """
    from gearcam.designs import KINDS, Design
    from gearcam.numeric.arguments import instance

    kind = instance("design", design, Design, "a design, as load returns it").kind
    given = () if tolerances is None else (tolerances,)
    return KINDS[kind].room("build").build(design, *given)


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
        Time after which no other design is tried on a usual machine; designs are counted, ten a
        second, so that the answer is the same everywhere.

    Returns
    -------
    Remedies
        Each was built: nothing is refused, what was an error is gone, and no other has come.

    Raises
    ------
    DesignError
        If it is no result.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"blank.bore_diameter_mm": 60})
    >>> found = gc.remedies(gc.build(design), patience=60.0).found
    >>> [list(one.changes) for one in found]
    [['blank.bore_diameter_mm']]
    """
    from gearcam.advice import remedies as search
    from gearcam.numeric.arguments import instance
    from gearcam.result import Result

    instance("result", result, Result, "a result, as build returns it")
    return search(result, refusal, patience=patience)
