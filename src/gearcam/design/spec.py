"""What all designs have in common: a design made in Python meets the rules of a file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any, Protocol

from gearcam.design.examine import examine
from gearcam.design.kinds import KINDS
from gearcam.design.wording import MISSING, Fault, dotted
from gearcam.errors import DesignError, Problem

Wanted = tuple[str, Any, tuple[type, ...]]
"""Key of a part, the part, and of which types it may be."""


class DesignLike(Protocol):
    """What every design has; the fields of its tables are those of its kind."""

    @property
    def kind(self) -> str:
        """The kind of design, as in a file."""
        ...

    @property
    def name(self) -> str:
        """Its name, and that of its folder."""
        ...

    @property
    def source(self) -> str:
        """The file it came from, empty for a design made in Python."""
        ...

    @property
    def limits(self) -> Mapping[str, float]:
        """Limits of checks by name, in mm and rad; the others keep their defaults."""
        ...


def settle(design: DesignLike, wanted: Iterable[Wanted]) -> None:
    """Refuse a design that no file could hold.

    Parameters
    ----------
    design : DesignLike
        All its fields set.
    wanted : iterable of Wanted
        Of what types the parts are that follow a registry; those of tables are known.

    Raises
    ------
    DesignError
        With all problems at once.
    """
    _demand_types(design, wanted)
    faults = examine(document_of(design)).faults
    if faults:
        raise _refusal(faults, design)


def _refusal(faults: Iterable[Fault], design: DesignLike) -> DesignError:
    return DesignError(
        Problem(
            message=fault.message,
            file=design.source,
            key=dotted(fault.path),
            value=None if fault.value is MISSING else fault.value,
            allowed=fault.allowed,
            hint=fault.hint,
        )
        for fault in faults
    )


def _demand_types(design: DesignLike, wanted: Iterable[Wanted]) -> None:
    kind = KINDS[design.kind]
    owners = ((title, kind.table(title).owner) for title in kind.tables)
    tables = [(title, getattr(design, title), (owner,)) for title, owner in owners if owner]
    problems = [
        Problem(
            f"is a {type(part).__name__}",
            file=design.source,
            key=key,
            allowed=f"an instance of {' or '.join(owner.__name__ for owner in types)}",
        )
        for key, part, types in (*tables, *wanted)
        if not isinstance(part, types)
    ]
    if problems:
        raise DesignError(problems)


def document_of(design: DesignLike) -> dict[str, Any]:
    """Return what a design file with this design would hold.

    Parameters
    ----------
    design : DesignLike
        A design of any kind.

    Returns
    -------
    dict
        Nested dictionaries with the keys and units of a file.
    """
    kind = KINDS[design.kind]
    document: dict[str, Any] = {"kind": kind.name, "name": design.name}
    document[kind.main] = kind.main_of(design)
    for title in kind.tables:
        document[title] = kind.table(title).document(getattr(design, title))
    if design.limits:
        known = {entry.name: entry for entry in kind.table("limits").entries.values()}
        document["limits"] = {
            known[name].key if name in known else name: known[name].outward(value)
            if name in known
            else value
            for name, value in design.limits.items()
        }
    return document


def changed(design: Any, changes: Mapping[str, object]) -> Any:
    """Return a design with other values of some keys.

    Parameters
    ----------
    design : DesignLike
        A design of any kind.
    changes : mapping of str to value
        New values by dotted keys of the design file, such as ``law.ratios[1]``, in its units.

    Returns
    -------
    DesignLike
        Of the same kind.

    Raises
    ------
    DesignError
        If a value is not what the file may hold.
    """
    document = document_of(design)
    for key, value in changes.items():
        *path, last = path_of(key)
        place: Any = document
        for step in path:
            place = place[step]
        place[last] = value
    found = examine(document)
    if found.faults:
        raise _refusal(found.faults, design)
    return type(design)(source=design.source, **found.parts)


def value_at(document: Any, key: str) -> Any:
    """Return the value of a dotted `key` in a `document`, None where it has none."""
    for step in path_of(key):
        try:
            document = document[step]
        except (KeyError, IndexError, TypeError):
            return None
    return document


def path_of(key: str) -> tuple[str | int, ...]:
    """Return the steps of a dotted key, such as ``law.ratios[1]``."""
    return tuple(int(step) if step.isdigit() else step for step in re.findall(r"[^.\[\]]+", key))
