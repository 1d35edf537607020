"""What all designs have in common: a design made in Python meets the rules of a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Protocol

from gearcam.design.examine import examine
from gearcam.design.kinds import KINDS
from gearcam.design.wording import MISSING, dotted
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


def demand_kind(design: DesignLike, kind: str) -> Any:
    """Return a design, or refuse it if it is of another kind.

    Parameters
    ----------
    design : DesignLike
        Of any kind.
    kind : str
        The one that a command is for.

    Returns
    -------
    DesignLike
        The design, whose fields are those of the kind.

    Raises
    ------
    DesignError
        With the kind that it is of.
    """
    if design.kind != kind:
        message = f"this command is for designs of kind {kind}"
        raise DesignError([Problem(message, file=design.source, key="kind", value=design.kind)])
    return design


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
        raise DesignError(
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
