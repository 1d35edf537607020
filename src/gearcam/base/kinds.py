"""The kinds of design by name, and the studies of each, without what else they do.

A kind is a folder of the package `gearcam.kinds`; its name is that of the folder, with hyphens. The
folder itself has its ``STUDIES``, if there are any; all else is in its modules
(`gearcam.designs.kind`). None of these is imported here: the help of the command line needs none,
and a build of one kind no other.
"""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from typing import Any, Final

from gearcam.base.brought import group_of
from gearcam.base.registry import ExtensibleMapping

_HOME: Final = "gearcam.kinds"


def kind_names() -> tuple[str, ...]:
    """Return the names of the kinds of design, in alphabetical order."""
    return _folders(tuple(importlib.import_module(_HOME).__path__))


@cache
def _folders(path: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the kinds that have a folder on a `path` of packages."""
    found = (one.name for one in pkgutil.iter_modules(path) if one.ispkg)
    return tuple(name.replace("_", "-") for name in sorted(found))


def folder_of(kind: str) -> str:
    """Return the package of the `kind` of a name."""
    return f"{_HOME}.{kind.replace('-', '_')}"


@cache
def kind_studies(kind: str) -> ExtensibleMapping[Any]:
    """Return the studies of the `kind` of a name, to which packages may add.

    Returns
    -------
    mapping of str to gearcam.results.studies.Study
        By name; only those of other packages are imported.
    """
    studies = getattr(importlib.import_module(folder_of(kind)), "STUDIES", ())
    return ExtensibleMapping({one.name: one for one in studies}, group_of(kind, "studies"))
