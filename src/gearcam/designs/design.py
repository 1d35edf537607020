"""Designs: their base class, and how files, texts and dictionaries become one.

A design made in Python obeys the rules of a design file.

Only a Python function has no equivalent in a file. Designs compare functions by identity and have a
unique hash then; a summary names the function, and writing such a design to a file is refused.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import pickle
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import InitVar, dataclass, field, fields, is_dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

from gearcam.base.display import cut
from gearcam.base.errors import DesignError, InfeasibleError, Problem
from gearcam.base.findings import Limits
from gearcam.base.inches import UNITS, changes_in, customary
from gearcam.base.quantities import FILE_KEYS
from gearcam.base.reading import UnreadableError, read
from gearcam.base.two_names import key_of
from gearcam.designs.examine import examine, examine_file
from gearcam.designs.faults import dotted, functions_of, is_deep
from gearcam.designs.kind import KINDS
from gearcam.designs.lines import Path
from gearcam.designs.nodes import Wanted, tables_in, wanted, written
from gearcam.designs.outputs import OutputSpec
from gearcam.designs.reader import (
    STDIN,
    STDIN_NAME,
    content_of,
    decoded,
    document_in,
    problems_of,
)
from gearcam.designs.table import settled
from gearcam.numeric.arguments import instance
from gearcam.parts.fits import FitSize

_PLACE: Final = re.compile("[0-9]{1,9}")
"""Index of an item in a list."""

HASH_DIGITS: Final = 16
"""Hexadecimal digits of the hash of a design: 64 bits."""

Function = Callable[..., Any]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Design:
    """Base class of designs; each kind adds a field for each of its tables.

    Parameters
    ----------
    name : str
        Name of the design and of its output folder: letters, digits, ``_ - .``
    source : str
        The design file; empty for a design made in Python.
    units : {"mm", "inch"}
        Those of the design file (see `gearcam.base.inches`); values in Python are in mm.
    limits : mapping of str to float or tuple of float
        Limits of checks by name, in mm and rad; others have their defaults.
    output : OutputSpec
        Files to write and their tolerance.
    added : mapping of str to object
        What tables hold that other packages bring, by title; each is an attribute, too.
    examined : bool
        Whether the values have been validated already.

    Raises
    ------
    DesignError
        If a value would not be allowed in a design file; lists all problems.

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
    """The kind of design, as in the key ``kind`` of a file."""

    name: str
    source: str = ""
    units: str = UNITS[0]
    limits: Limits = field(default_factory=dict)
    output: OutputSpec = field(default_factory=OutputSpec)
    added: Mapping[str, Any] = field(default_factory=dict)
    examined: InitVar[bool] = False

    def __post_init__(self, examined: bool) -> None:
        if isinstance(self.limits, Mapping):
            object.__setattr__(self, "limits", dict(self.limits))
        if not examined:
            for item in fields(self):
                object.__setattr__(self, item.name, settled(getattr(self, item.name)))
            added = {title: settled(part) for title, part in self.added.items()}
            object.__setattr__(self, "added", added)
        self._settle()
        variants = KINDS[self.kind].variants
        for title in variants.titles if variants else ():
            object.__setattr__(self, title, _suiting(self, title))
        if not examined:
            _demand_types(self)
            faults = examine(document_of(self)).faults
            if faults:
                raise DesignError(fault.problem(self.source) for fault in faults)
        goal, repeated = getattr(self, "goal", None), KINDS[self.kind].repeated
        if goal is not None and repeated:
            object.__setattr__(self, "goal", goal.named(repeated))

    if not TYPE_CHECKING:  # type checkers then find misspelt names

        def __getattr__(self, name: str) -> Any:
            """Return what a table of another package holds."""
            if not name.startswith("_"):
                added, kind = vars(self).get("added", {}), KINDS[self.kind]
                if name in added:
                    return added[name]
                kind.take_brought()
                if name in kind.added:
                    return () if name in kind.several else kind.tables[name]()
            raise AttributeError(f"{type(self).__name__} has no {name}", name=name, obj=self)

    def __dir__(self) -> Iterable[str]:
        """Return the tables of the design and what it can do."""
        tables = {one.name for one in fields(self)} - {"added"}
        names = {"kind", "to_dict", "with_", *tables, *self.added}
        return [*(one for one in super().__dir__() if one.startswith("_")), *sorted(names)]

    def __eq__(self, other: object) -> bool:
        """Return whether another design has the same kind and values, regardless of its source."""
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
        """The result, which provides the picture of a design in notebooks."""
        return KINDS[self.kind].result(self)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, _: object) -> Self:
        return self

    def __getstate__(self) -> dict[str, Any]:
        document, rule = document_of(self), "a function that is defined with def in a module"
        _demand(_pickles, document, self.source, "cannot be pickled", rule)
        if any(functions_in(document)):
            _ = self._token  # the copy keeps it
        return vars(self)

    @property
    def files_in(self) -> str:
        """The units of files that are written: those that ``[output]`` names, or its own."""
        return self.output.units or self.units

    def _document(self) -> dict[str, Any]:
        """Return its document, with which it is written where it is nested: in mm, as others."""
        return {key: one for key, one in document_of(self).items() if key != "units"}

    @cached_property
    def _value(self) -> tuple[str, list[Callable[..., Any]]]:
        """The values to compare, with rows of CSV files instead of their names, and functions."""
        document = document_of(self)
        functions = [one for _, many in functions_in(document) for one in many]
        with contextlib.suppress(InfeasibleError):  # if a file cannot be read, its name is compared
            document = _with_rows(document, self)
        return json.dumps(document, sort_keys=True, default=lambda _: ""), functions

    @cached_property
    def _token(self) -> str:
        """A random text that replaces functions in the hash, since they cannot be compared."""
        return os.urandom(16).hex()

    def to_dict(self) -> dict[str, Any]:
        """Return the content of a design file for this design.

        Returns
        -------
        dict
            Nested dictionaries with the keys and units of a file, as for `gearcam.design`.

        Raises
        ------
        DesignError
            If the design contains a Python function, which a file cannot.

        Examples
        --------
        >>> import gearcam as gc
        >>> document = gc.load("profiles/ellipse.toml").to_dict()
        >>> document["pair"]["teeth"]
        [41, 41]
        """
        document = own_document(self)
        _demand(
            lambda _: False,
            document,
            self.source,
            "cannot be written to a file",
            "a formula as text",
        )
        return document

    def with_(self, changes: Mapping[str, object]) -> Self:
        """Return a copy of the design with changed values.

        Parameters
        ----------
        changes : mapping of str to value
            New values by dotted keys of the design file, such as ``law.ratios[1]``, in its units;
            those of a design in inches also by keys in mm. None leaves a key out, so that it has
            its default. A fact that repeats a key stands for it: ``pair.rack.addendum`` for
            ``rack.addendum``.

        Returns
        -------
        Design
            Of the same kind, validated.

        Raises
        ------
        DesignError
            If there is no such key, or a value is not allowed.

        Examples
        --------
        >>> import gearcam as gc
        >>> design = gc.load("profiles/ellipse.toml").with_({"law.eccentricity": 0.2})
        >>> design.law.eccentricity, round(gc.build(design).facts["pair.ratio"]["max"], 6)
        (0.2, 1.5)
        """
        rule = "a mapping of dotted keys to values"
        changes = instance("changes", changes, Mapping, rule)
        units = changes.get("units", self.units)
        document = own_document(self) if units != "mm" else document_of(self)
        left_out: list[Path] = []
        spelt: dict[str, str] = {}
        for name, value in changes.items():
            key = key_of(KINDS[self.kind].repeated, name) if isinstance(name, str) else name
            if self.units == "inch" == units and isinstance(key, str):
                ((key, value),) = changes_in({key: value}).items()
            if (other := spelt.setdefault(key, name)) != name:
                what = f"is given beside {other}"
                raise DesignError([Problem(what, self.source, key=name, allowed="one of them")])
            place: Any = document
            step: str | int = ""
            try:
                *path, last = path_of(key)
                for step in path:
                    place = place.setdefault(step, {}) if isinstance(place, dict) else place[step]
                step = last
                if value is None and isinstance(place, dict):
                    place.pop(last, None)
                    left_out.append((*path, last))
                    continue
                place[last] = _own(value)  # later changes may lie within it
            except (IndexError, KeyError, TypeError, ValueError):  # the last: no step at all
                allowed, hint = _numbered(place, step)
                what = "there is no such key or index"
                problem = Problem(what, self.source, key=key, allowed=allowed, hint=hint)
                raise DesignError([problem]) from None
        _demand_known(document, left_out, self.source)
        return design(document, self.source)

    def _settle(self) -> None:
        """Convert alternative forms of input into one form."""


def _demand_known(document: dict[str, Any], left_out: Sequence[Path], source: str) -> None:
    """Refuse keys that were left out of a `document` and that no design has (`DesignError`)."""
    probe = _own(document)
    for path in left_out:
        place: Any = probe
        for step in path[:-1]:
            place = place.get(step, {}) if isinstance(place, dict) else place[step]
        place.setdefault(path[-1], None)
    faults = examine(probe).faults if left_out else ()
    wrong = [one for one in faults if one.of_unknown_key and one.path in left_out]
    if wrong:
        raise DesignError(one.problem(source) for one in wrong)


def _own(value: Any) -> Any:
    """Return a value whose tables and lists are copies."""
    if isinstance(value, Mapping):
        return {key: _own(one) for key, one in value.items()}
    return [_own(one) for one in value] if isinstance(value, list) else value


def _numbered(place: Any, step: str | int) -> tuple[str, str]:
    """Return the numbers of a list, and that of the table with a name that was written instead."""
    if not isinstance(place, list | tuple) or not place:
        return "", ""
    allowed = f"a number from 0 to {len(place) - 1} in the brackets" if place[1:] else "[0]"
    named = [
        number
        for number, one in enumerate(place)
        if isinstance(one, Mapping) and step in (one.get("name"), one.get("joint"))
    ]
    return allowed, f"{step} is number {named[0]}" if named else ""


def _suiting(design: Design, title: str) -> Any:
    """Return a table; one from whose class that of its variant is derived as an instance of it."""
    kind, given = KINDS[design.kind], getattr(design, title)
    wanted, own = kind.table_of(design, title).owner, type(given)
    if wanted is None or wanted is own or not is_dataclass(own) or not issubclass(wanted, own):
        return given
    taken = {one.name for one in fields(wanted) if one.init}
    values = {one: getattr(given, one.name) for one in fields(own)}
    lost = [one for one in values if one.name not in taken and values[one] != one.default]
    if lost and kind.variants:
        what = f"does not apply to {kind.variants.called.format(kind.variants.of(design))}"
        raise DesignError(
            Problem(what, design.source, key=f"{title}.{one.name}", value=values[one])
            for one in lost
        )
    try:
        return wanted(**{one.name: values[one] for one in values if one.name in taken})
    except TypeError:  # it needs more
        return given


def _demand_types(design: Design) -> None:
    """Raise `DesignError` if a table, or what is nested in one, is not of its type."""
    kind = KINDS[design.kind]
    titles = kind.titles_with(design.added)
    if unknown := [title for title in design.added if title not in kind.added]:
        what, rule = "is no table that another package brings", ", ".join(kind.added)
        raise DesignError(Problem(what, design.source, key=one, allowed=rule) for one in unknown)
    parts = (
        one
        for title in titles
        for one in wanted(kind.node_of(design, title), getattr(design, title), title)
    )
    _demand_instances(design, (("limits", design.limits, (Mapping,)), *parts))
    inner = ((dotted(at), one, (Design,)) for at, one in nested_designs(design))
    _demand_instances(design, inner)


def _demand_instances(design: Design, wanted: Iterable[Wanted]) -> None:
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


def nested_designs(design: Design) -> Iterator[tuple[Path, Design]]:
    """Yield the path and the design of each design nested in a `design`."""
    kind = KINDS[design.kind]
    for title in kind.titles_with(design.added):
        parts = getattr(design, title)
        if title in kind.nodes or parts == ():
            continue
        for at, table, part in tables_in(kind.node_of(design, title), parts, (title,)):
            for key, entry in table.entries.items():
                if entry.param.nested and (inner := getattr(part, entry.name)) is not None:
                    yield (*at, key), inner


def document_of(design: Design) -> dict[str, Any]:
    """Return the content of a design file for this design; it may contain Python functions.

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
    if design.units != UNITS[0]:
        document["units"] = design.units
    titles = kind.titles_with(design.added)
    parts = {one: getattr(design, one) for one in titles if one not in kind.nodes}
    plain = {
        # the class of tables that a design does not have need not be imported
        one: [] if part == () else written(kind.node(one, {}), part, {})
        for one, part in parts.items()
    }
    given = kind.circumstances(plain)
    for title in titles:
        node = kind.nodes.get(title)
        document[title] = written(node, getattr(design, title), given) if node else plain[title]
    if design.limits:
        limits = {entry.name: entry for entry in kind.table("limits").entries.values()}
        document["limits"] = {
            limits[name].key if name in limits else name: limits[name].outward(value)
            if name in limits
            else value
            for name, value in design.limits.items()
        }
    return document


def own_document(design: Design) -> dict[str, Any]:
    """Return the same in the units of the `design`."""
    document = document_of(design)
    return customary(document) if design.units == "inch" else document


def summary_of(design: Design) -> dict[str, Any]:
    """Return the document of a `design` with Python functions replaced by their names."""
    return json.loads(json.dumps(own_document(design), default=_function_name))


def functions_in(part: Any, path: Path = ()) -> Iterator[tuple[Path, tuple[Function, ...]]]:
    """Yield the paths of functions in a `part` of a document at a `path`, with the functions."""
    if functions := functions_of(part):
        yield path, functions
    elif isinstance(part, dict | list):
        for key, item in part.items() if isinstance(part, dict) else enumerate(part):
            yield from functions_in(item, (*path, key))


def _function_name(function: Function) -> str:
    """Return the name of a function for messages: ``Python function module.name``."""
    named = function if hasattr(function, "__qualname__") else type(function)
    return f"Python function {named.__module__}.{named.__qualname__}"


def _pickles(function: Function) -> bool:
    try:
        pickle.dumps(function)
    except Exception:
        return False  # other classes may raise anything
    return True


def _demand(
    can: Callable[[Function], bool], document: Mapping[str, Any], file: str, what: str, allowed: str
) -> None:
    """Raise `DesignError` if a function in a document does not satisfy `can`."""
    problems = [
        Problem(f"the {_function_name(one)} {what}", file=file, key=dotted(path), allowed=allowed)
        for path, functions in functions_in(document)
        for one in functions
        if not can(one)
    ]
    if problems:
        raise DesignError(problems)


def design(document: Mapping[str, Any], source: str = "") -> Any:
    """Return the design of nested dictionaries with the content of a design file.

    Parameters
    ----------
    document : mapping
        Keys and values as in a design file, including ``kind`` and ``name``; lists may be tuples.
        Paths of CSV files are relative to the current folder.
    source : str
        Name of the design file, for messages.

    Returns
    -------
    Design
        In mm and rad; its class depends on the kind.

    Raises
    ------
    DesignError
        With all mistakes, each with its key.
    """
    plain = document if is_deep(document) else _plain(document)  # examine refuses what is deep
    outcome = examine(plain)
    if outcome.faults:
        raise DesignError(fault.problem(source) for fault in outcome.faults)
    return KINDS[outcome.kind].made(outcome.parts, source)


def load(path: str | os.PathLike[str]) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : path
        A TOML file in UTF-8; ``-`` is the standard input.

    Returns
    -------
    Design
        In mm and rad; its class depends on the kind.

    Raises
    ------
    DesignError
        If the file cannot be read, or with all mistakes in it, each with its line.
    """
    file = os.fspath(path)
    name = STDIN_NAME if file == STDIN else file
    return loads(decoded(content_of(file), name), file=name)


def loads(text: str, *, file: str = "") -> Design:
    """Read the text of a design file.

    Parameters
    ----------
    text : str
        TOML.
    file : str
        Name of the file, for messages; its stem is the default name of the design.

    Returns
    -------
    Design
        In mm and rad; its class depends on the kind.

    Raises
    ------
    DesignError
        With all mistakes, each with its line.
    """
    document = document_in(text, file)
    outcome = examine_file(document, file)
    if outcome.faults:
        raise DesignError(problems_of(outcome.faults, text, file))
    return KINDS[outcome.kind].made(outcome.parts, file)


def _plain(value: Any) -> Any:
    """Return a document with types of TOML: numpy numbers and arrays become Python ones."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, FitSize):
        return str(value)
    value = value.tolist() if hasattr(value, "tolist") else value
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


def hash_of(design: Design) -> str:
    """Return the hash of a design: designs with the same hash produce the same files.

    It depends on the values of all keys, including defaults, on the rows of CSV files and on the
    hashes of nested designs, but not on comments, spaces, the order of keys, or the paths of files;
    degrees are rounded to 13 digits. Values that do not change any file are excluded: ``[limits]``,
    the list of files, and the settings of studies for which the design does not ask. Python
    functions cannot be compared: a design with one shares its hash only with its copies.

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
        If a CSV file of the design cannot be read any more.
    """
    document = document_of(design)
    asked = design.output.studies
    for name, title in KINDS[design.kind].study_tables.items():
        if name not in asked:
            document.pop(title, None)
    for key in ("files", *(() if asked else ("studies",))):
        del document["output"][key]
    document["output"].pop("units", None)
    document["output"] |= {"units": design.files_in} if design.files_in != UNITS[0] else {}
    document.pop("limits", None)
    for path, inner in nested_designs(design):
        place: Any = document
        for step in path[:-1]:
            place = place[step]
        place[path[-1]] = hash_of(inner)
    text = json.dumps(_with_rows(document, design), sort_keys=True, default=lambda _: design._token)
    return hashlib.sha256(text.encode()).hexdigest()[:HASH_DIGITS]


def _with_rows(value: Any, design: Design) -> Any:
    """Return a part of a document with rows instead of CSV files, and all numbers as floats."""
    if isinstance(value, Mapping):
        return {
            key: _rows(item, design) if key in FILE_KEYS else _with_rows(item, design)
            for key, item in value.items()
        }
    if isinstance(value, list):
        return [_with_rows(item, design) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _rows(file: Any, design: Design) -> Any:
    """Return the rows of a table's file; of another file what tells its content."""
    from gearcam.laws.columns import LARGEST, ColumnsError, files_in

    if file is None:
        return None
    try:
        for rows in files_in(design):
            if rows.file == file:
                return rows.cells
        return hashlib.sha256(read(file, LARGEST)).hexdigest()
    except UnreadableError:
        return None  # the study that needs it says so
    except ColumnsError as error:
        raise InfeasibleError(str(error), where=file) from error


def value_at(document: Any, key: str) -> Any:
    """Return the value of a dotted `key` in a `document`; None if there is none."""
    for step in path_of(key):
        try:
            document = document[step]
        except (KeyError, IndexError, TypeError):
            return None
    return document


def path_of(key: str) -> tuple[str | int, ...]:
    """Return the steps of a dotted key: ``("law", "ratios", 1)`` for ``law.ratios[1]``."""
    steps = re.findall(r"[^.\[\]]+", key)
    return tuple(int(step) if _PLACE.fullmatch(step) else step for step in steps)
