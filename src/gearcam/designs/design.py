"""What all designs have in common: a design made in Python meets the rules of a file.

What no file can hold is a Python function: designs with one compare it by identity and have a hash
of their own; written out, it is named where it is told of, and refused where it would be lost.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import InitVar, dataclass, field, fields
from functools import cached_property
from typing import Any, ClassVar, Final, Self

from gearcam.designs.examine import examine
from gearcam.designs.faults import dotted, is_deep
from gearcam.designs.functions import Function, function_name, functions_in, never, pickles
from gearcam.designs.kind import KINDS
from gearcam.designs.outputs import OutputSpec
from gearcam.designs.table import settled
from gearcam.display import cut
from gearcam.errors import DesignError, InfeasibleError, Problem
from gearcam.numeric.arguments import instance

_PLACE: Final = re.compile("[0-9]{1,9}")
"""The number of a place in a list."""

HASH_DIGITS: Final = 16
"""Hexadecimal digits of a design's hash: two of a thousand million million are alike by chance."""

Wanted = tuple[str, Any, tuple[type, ...]]
"""Key of a part, the part, and of which types it may be."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Design:
    """What every design has; each kind adds the fields of its tables.

    Parameters
    ----------
    name : str
        Name of the design and of its folder: letters, digits, ``_ - .``
    source : str
        The file it came from, empty for a design made in Python.
    limits : mapping of str to float
        Limits of checks by name, in mm and rad; the others keep their defaults.
    output : OutputSpec
        Files and their tolerance.
    examined : bool
        Whether its values have passed an examination.

    Raises
    ------
    DesignError
        If a value is not what a design file may hold, all problems at once.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml")
    >>> isinstance(design, gc.Design), design.name
    (True, 'ellipse')
    >>> design.with_({"law.eccentricity": 0.2}) == design
    False
    """

    kind: ClassVar[str]
    """The kind of design, as in a file."""

    name: str
    source: str = ""
    limits: Mapping[str, float] = field(default_factory=dict)
    output: OutputSpec = field(default_factory=OutputSpec)
    examined: InitVar[bool] = False

    def __post_init__(self, examined: bool) -> None:
        if isinstance(self.limits, Mapping):
            object.__setattr__(self, "limits", dict(self.limits))
        if not examined:
            for item in fields(self):
                object.__setattr__(self, item.name, settled(getattr(self, item.name)))
        self._settle()
        if not examined:
            _demand_types(self)
            faults = examine(document_of(self)).faults
            if faults:
                raise DesignError(fault.problem(self.source) for fault in faults)

    def __eq__(self, other: object) -> bool:
        """Whether another design is of the same kind and asks for the same, whatever its source."""
        if not isinstance(other, Design) or type(self) is not type(other):
            return NotImplemented
        return self._value == other._value

    def __hash__(self) -> int:
        return hash(self._value[0])

    def __repr__(self) -> str:
        return cut(f'<{type(self).__name__} "{self.name}">')

    def _repr_svg_(self) -> str | None:
        return self._built._repr_svg_()

    def _repr_html_(self) -> str:
        return self._built._repr_html_()

    @property
    def _built(self) -> Any:
        """Its result: a picture of a design is one of what comes of it."""
        return KINDS[self.kind].room("build").build(self)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, _: object) -> Self:
        return self

    def __getstate__(self) -> dict[str, Any]:
        document, rule = document_of(self), "a function that is defined with def in a module"
        _demand(pickles, document, self.source, "cannot be pickled", rule)
        if any(functions_in(document)):
            _ = self._token  # which the copy keeps
        return vars(self)

    @cached_property
    def _value(self) -> tuple[str, list[Callable[..., Any]]]:
        """Everything that it asks for, with the rows of CSV files instead of their names.

        Functions stand beside it.
        """
        document = document_of(self)
        functions = [one for _, many in functions_in(document) for one in many]
        with contextlib.suppress(InfeasibleError):  # of a file that cannot be read the name counts
            document = _with_rows(document, self)
        return json.dumps(document, sort_keys=True, default=lambda _: ""), functions

    @cached_property
    def _token(self) -> str:
        """What stands for functions in its hash: as they cannot be compared, no other has it."""
        return os.urandom(16).hex()

    def to_dict(self) -> dict[str, Any]:
        """Return what a design file with this design would hold.

        Returns
        -------
        dict
            Nested dictionaries with the keys and units of a file; `gearcam.design` takes them.

        Raises
        ------
        DesignError
            Where the design holds a Python function, which no file can.
        """
        document = document_of(self)
        _demand(never, document, self.source, "cannot be written to a file", "a formula as text")
        return document

    def with_(self, changes: Mapping[str, object]) -> Self:
        """Return the design with other values of some keys.

        Parameters
        ----------
        changes : mapping of str to value
            New values by dotted keys of the design file, such as ``law.ratios[1]``, in its units.

        Returns
        -------
        Design
            Of the same kind, examined anew.

        Raises
        ------
        DesignError
            If a design of this kind has no such key, or a value is not what the file may hold.
        """
        document, rule = document_of(self), "a mapping of dotted keys to values"
        for key, value in instance("changes", changes, Mapping, rule).items():
            place: Any = document
            try:
                *path, last = path_of(key)
                for step in path:
                    place = place.setdefault(step, {}) if isinstance(place, dict) else place[step]
                place[last] = value
            except (IndexError, KeyError, TypeError, ValueError):  # the last: no step at all
                problem = Problem("there is no such place", self.source, key=key)
                raise DesignError([problem]) from None
        return design(document, self.source)

    def _settle(self) -> None:
        """Bring what is given into one form."""

    def _wanted(self) -> Iterable[Wanted]:
        """Return of what types the parts are that follow a registry; those of tables are known."""
        return ()


def demand_kind(design: Design, kind: str) -> Any:
    """Return a design, or refuse it if it is of another kind.

    Parameters
    ----------
    design : Design
        Of any kind.
    kind : str
        The one that a command is for.

    Returns
    -------
    Design
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


def _demand_types(design: Design) -> None:
    kind = KINDS[design.kind]
    owners = ((title, kind.table(title).owner) for title in kind.tables)
    tables = [(title, getattr(design, title), (owner,)) for title, owner in owners if owner]
    wanted = (("limits", design.limits, (Mapping,)), *tables, *design._wanted())
    problems = [
        Problem(
            f"is a {type(part).__name__}",
            file=design.source,
            key=key,
            allowed=f"an instance of {' or '.join(owner.__name__ for owner in types)}",
        )
        for key, part, types in wanted
        if not isinstance(part, types)
    ]
    if problems:
        raise DesignError(problems)


def document_of(design: Design) -> dict[str, Any]:
    """Return what a design file with this design would hold.

    Parameters
    ----------
    design : Design
        A design of any kind.

    Returns
    -------
    dict
        Nested dictionaries with the keys and units of a file.
    """
    kind = KINDS[design.kind]
    document: dict[str, Any] = {"kind": kind.name, "name": design.name}
    if kind.main:
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


def summary_of(design: Design) -> dict[str, Any]:
    """Return the document of a `design` with the names of Python functions in their places."""
    return json.loads(json.dumps(document_of(design), default=function_name))


def _demand(
    can: Callable[[Function], bool], document: Mapping[str, Any], file: str, what: str, allowed: str
) -> None:
    """Refuse a document with functions that cannot do what is wanted."""
    problems = [
        Problem(f"the {function_name(one)} {what}", file=file, key=dotted(path), allowed=allowed)
        for path, functions in functions_in(document)
        for one in functions
        if not can(one)
    ]
    if problems:
        raise DesignError(problems)


def design(document: Mapping[str, Any], source: str = "") -> Any:
    """Return the design of nested dictionaries that hold what a design file would.

    Parameters
    ----------
    document : mapping
        With the keys and the units of a file, ``kind`` and ``name`` among them; a tuple stands for
        a list. CSV files are looked for in the current folder.
    source : str
        The file that it came from, for messages.

    Returns
    -------
    Design
        In mm and rad, of the document's kind.

    Raises
    ------
    DesignError
        For everything that is wrong in it, each with its key.
    """
    plain = document if is_deep(document) else _plain(document)  # examine refuses what is deep
    found = examine(plain)
    if found.faults:
        raise DesignError(fault.problem(source) for fault in found.faults)
    return KINDS[plain["kind"]].design(source=source, examined=True, **found.parts)


def _plain(value: Any) -> Any:
    """Return a document of the types that TOML has: numbers of numpy become those of Python."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    value = value.tolist() if hasattr(value, "tolist") else value
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


def hash_of(design: Design) -> str:
    """Return the hash of a design: designs of the same hash give the same files.

    It is taken from the values of all keys, defaults included, and from the rows of the CSV files
    that the design names; not from comments, spaces, the order of keys, or where these files
    lie; degrees count with 13 digits. What changes the content of no file of a build is left out:
    ``[limits]``, ``[meshing]`` and which files are wanted. Nobody knows whether Python functions
    are the same: a design with one has a hash that only itself and its copies have.

    Parameters
    ----------
    design : Design
        A design of any kind.

    Returns
    -------
    str
        The first `HASH_DIGITS` hexadecimal digits of SHA-256.

    Raises
    ------
    InfeasibleError
        If such a CSV file cannot be read any more.
    """
    document = document_of(design)
    for title in ("limits", "meshing"):
        document.pop(title, None)
    del document["output"]["files"]
    made = _with_rows(document, design)
    text = json.dumps(made, sort_keys=True, default=lambda _: design._token)
    return hashlib.sha256(text.encode()).hexdigest()[:HASH_DIGITS]


def _with_rows(value: Any, design: Design) -> Any:
    """Return a part of a document with rows instead of files, and numbers of one type."""
    if isinstance(value, Mapping):
        return {
            key: _rows(item, design) if key == "file" else _with_rows(item, design)
            for key, item in value.items()
        }
    if isinstance(value, list):
        return [_with_rows(item, design) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _rows(file: str, design: Design) -> Any:
    from gearcam.laws.columns import ColumnsError, tables_in

    try:
        return next((rows.cells for rows in tables_in(design) if rows.file == file), None)
    except ColumnsError as error:
        raise InfeasibleError(str(error), where=file) from error


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
    steps = re.findall(r"[^.\[\]]+", key)
    return tuple(int(step) if _PLACE.fullmatch(step) else step for step in steps)
