"""The text of a design file: TOML becomes a document, with the lines of its mistakes."""

from __future__ import annotations

import codecs
import os
import re
import sys
import tomllib
import unicodedata
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final
from weakref import WeakKeyDictionary

from gearcam.base.errors import DesignError, Problem
from gearcam.base.inches import key_mm
from gearcam.base.numerals import size_of
from gearcam.base.quantities import FILE_KEYS, unit_of
from gearcam.base.reading import UnreadableError, read
from gearcam.designs.faults import DEEPEST, TOO_DEEP, Fault, is_deep
from gearcam.designs.kind import KINDS
from gearcam.designs.lines import line_at, lines_of
from gearcam.designs.measures import TYPESET, measure_hint, typed

LARGEST: Final = 2_000_000
"""Largest size of a design file, bytes: twice that of a motion table of 20 000 rows."""

STDIN: Final = "-"
"""What is given for a file to read the standard input."""

STDIN_NAME: Final = "stdin"
"""What it is called in messages, and the name of a design that says none."""

_read: WeakKeyDictionary[Any, bytes] = WeakKeyDictionary()
"""What stood in a standard input, by its stream."""

_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")
_TWICE = re.compile(r"Cannot declare \((.*)\) twice")
_LONG = re.compile(r"(?<![0-9_])[0-9_]{1000,}")
"""Digits that may be too many for an integer."""

_DEEP_KEY = re.compile(
    r"""(?<![\w."'-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    f"{{{DEEPEST}}}"
)
"""A dotted key that is nested too deep; the time of tomllib is quadratic in the number of names."""

_VALUE = re.compile(
    r"\s*([\w.-]+)\s*=\s*([\"']?)\s*(#\d[\d-]*|[^#\"'\[{\s][^#\[{]*?)\2\s*(?:#.*)?$"
)
"""A key and a value that is no list or table, with or without quotes."""

_TEXT = re.compile(r"\"[^\"]*\"|'[^']*'|#.*")
"""A text in quotes, or a comment."""

_BARE = re.compile(r"\s*([\w.-]+)\s*=\s*([^\W\d][\w.-]*)\s*(#.*)?$")
"""A key and a word without quotes."""

_NAME = re.compile(r"\s*(\[?\[?)\s*([\w.-]+|\"[^\"]*\")")
"""A name at the beginning of a line, with the brackets of a table if any."""

_PLAIN: Final = {
    "Invalid value": "this value cannot be read (text needs quotes, a number a decimal point)",
    "Invalid statement": "this line is neither a table [name] nor key = value",
    "Expected '=' after a key in a key/value pair": "an = is missing after the key",
    "Expected newline or end of document after a statement": (
        "there is more after the value (write one key = value on each line)"
    ),
    "Unclosed array": "a comma or the closing ] of the list is missing here",
    "Unclosed inline table": "the closing } of the table is missing",
    "Unterminated string": "the closing quote of the text is missing",
    "Expected ']' at the end of a table declaration": "the closing ] of the table name is missing",
    "Illegal character '\\n'": "the closing quote of the text is missing on this line",
}


def content_of(file: str) -> bytes:
    """Return the content of a `file`; of `STDIN` that of the standard input, which is read once.

    Raises
    ------
    DesignError
        If it cannot be read.
    """
    if file == STDIN:
        return _standard_input()
    try:
        return read(file, LARGEST)
    except UnreadableError as error:
        near = f"{Path(file)}.toml"
        hint = f"did you mean {near}?" if Path(near).is_file() else ""
        raise DesignError([Problem(str(error), file=file, hint=hint)]) from error


def _standard_input() -> bytes:
    """Return what stands in the standard input; several readers get the same."""
    stream = sys.stdin
    if stream is None:
        raise DesignError.of("there is no standard input", allowed="the name of a file")
    if stream not in _read:
        try:
            content = getattr(stream, "buffer", stream).read(LARGEST + 1)
        except (OSError, ValueError) as error:
            raise DesignError.of(f"the standard input cannot be read: {error}") from error
        _read[stream] = content.encode() if isinstance(content, str) else content
    if len(_read[stream]) > LARGEST:
        message = f"the standard input is longer than {size_of(LARGEST)}, which is the most"
        raise DesignError.of(message)
    return _read[stream]


def decoded(content: bytes, file: str) -> str:
    """Return the content of a file as text.

    Parameters
    ----------
    content : bytes
        The bytes of the file.
    file : str
        Its name, for messages.

    Returns
    -------
    str
        The text without a byte order mark.

    Raises
    ------
    DesignError
        If it is not UTF-8.
    """
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        message = f"the byte 0x{content[error.start]:02x} is not UTF-8"
        if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            message = "the file is UTF-16"
        problem = Problem(message, file=file, line=line, allowed="a text file saved as UTF-8")
        raise DesignError([problem]) from error


def find_tables(value: Any, folder: Path) -> None:
    """Make the paths of CSV files in a document, `value`, relative to the `folder` of its file."""
    for item in value.values() if isinstance(value, dict) else value:
        if isinstance(item, dict | list):
            find_tables(item, folder)
    for key in FILE_KEYS.intersection(value) if isinstance(value, dict) else ():
        if isinstance(value[key], str) and value[key]:
            value[key] = os.fspath(folder / value[key])


def problems_of(faults: Iterable[Fault], text: str, file: str) -> list[Problem]:
    """Return the `faults` in the `text` of a `file` as problems, sorted by line."""
    lines = lines_of(text)
    placed = [fault.problem(file, line_at(lines, fault.path)) for fault in faults]
    # those of nested files follow
    return sorted(placed, key=lambda one: (one.file != file, one.file, one.line or 0))


def document_in(text: str, file: str) -> dict[str, Any]:
    """Return the document of a TOML text.

    Parameters
    ----------
    text : str
        TOML.
    file : str
        Name of the file, for messages.

    Returns
    -------
    dict
        The document.

    Raises
    ------
    DesignError
        If it is not valid TOML, or nested too deep.
    """
    deep = DesignError([Problem(TOO_DEEP, file=file)])
    if _DEEP_KEY.search(text):
        raise deep
    try:
        document = tomllib.loads(text)
    except RecursionError as error:
        raise deep from error
    except ValueError as error:  # TOMLDecodeError, and integers beyond Python's limit of digits
        raise DesignError([_syntax_problem(str(error), text, file)]) from error
    if is_deep(document):
        raise deep
    return document


def _syntax_problem(message: str, text: str, file: str) -> Problem:
    place = _PLACE.search(message)
    what = message[: place.start()] if place else message
    what = _PLAIN.get(what, what)
    hint, twice = "", _TWICE.fullmatch(what)
    if twice:
        name = ".".join(re.findall(r"'([^']*)'", twice[1]))
        what, hint = f"the table [{name}] is given twice", _many_hint(name)
    if place and place.group(1):
        number = int(place.group(1))
        line = text.split("\n")[number - 1]
        first = _NAME.match(line)
        if typeset := _typeset(line):
            column, what, hint = typeset
            return Problem(f"column {column}: {what}", file=file, line=number, hint=hint)
        if what == "Cannot overwrite a value" and first:
            what = f"the {'name' if first[1] else 'key'} {first[2]} is given twice"
            hint = _many_hint(first[2])
        elif told := _measure_hint(line):
            hint = told
        elif bare := _BARE.match(line):
            word = bare[2].lower()
            value = word if word in ("true", "false") else f'"{bare[2]}"'
            hint = f"write {bare[1]} = {value}"
        message = f"column {place.group(2)}: {what}"
        return Problem(message, file=file, line=number, hint=hint)
    if place:
        last = text.rstrip().count("\n") + 1
        return Problem(f"{what} (at the end of the file)", file=file, line=last)
    most = sys.get_int_max_str_digits()
    long = next((one for one in _LONG.finditer(text) if len(one[0].replace("_", "")) > most), None)
    line = text.count("\n", 0, long.start()) + 1 if long else None
    rule = f"numbers of at most {most} digits"
    return Problem("a number has too many digits", file=file, line=line, allowed=rule)


def _measure_hint(line: str) -> str:
    """Return how to write the measure in a line as a number; empty if there is none."""
    found = _VALUE.match(typed(line))
    if found is None:
        return ""
    key, value = found[1], found[3]
    unit = unit_of(key)
    # without a unit a fraction may be meant as two numbers
    if "/" in value and not unit:
        return ""
    classes = value[-1:].isdigit() and _takes_classes(key)
    return measure_hint(value, unit, key=key, classes=classes)


def _takes_classes(key: str) -> bool:
    """Return whether a key of some kind of design may have a tolerance class."""
    tables = (kind.table(title) for kind in KINDS.values() for title in kind.tables)
    key = key_mm(key)
    return any(key in one.entries and one.entries[key].param.fit for one in tables)


def _typeset(line: str) -> tuple[int, str, str] | None:
    """Return column, message and hint of the first character of typesetting outside of texts."""
    bare = _TEXT.sub(lambda found: " " * len(found[0]), line)
    place = next((k for k, one in enumerate(bare) if one in TYPESET), None)
    if place is None:
        return None
    one, plain = bare[place], TYPESET[bare[place]]
    shown = f"{one} is" if one.isprintable() else "here is"
    what = f"{shown} a typographic character, {unicodedata.name(one).lower()} (U+{ord(one):04X})"
    told = _measure_hint(line) if plain in ("'", '"') else ""
    plain = "a plain space" if plain == " " else plain
    return place + 1, what, told or (f"write {plain} in its place" if plain else "leave it out")


def _many_hint(name: str) -> str:
    """Return a hint on arrays of tables, if a design can have several tables called `name`."""
    many = any(isinstance(kind.example.get(name), list) for kind in KINDS.values())
    return f"for several of these tables write [[{name}]]" if many else ""
