"""Line numbers of keys and array items in the text of a design file.

The text must be valid TOML: this code only finds where things begin. It runs only if there is a
mistake to report. A *path* is a tuple of keys and indices, ``("pair", "teeth", 1)``; the empty path
is the file.
"""

from __future__ import annotations

import contextlib
import re
from bisect import bisect_right
from collections.abc import Mapping

Path = tuple[str | int, ...]

_SPACE = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_STRING = re.compile(
    r'"""(?:\\[\s\S]|[^\\])*?"{3,5}'
    r"|'''[\s\S]*?'{3,5}"
    r'|"(?:\\.|[^"\\])*"'
    r"|'[^']*'"
)
_SCALAR = re.compile(r"[^,\]}#\n]*")
_ESCAPE = re.compile(r'\\(u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{8}|[btnfr"\\])')
_ESCAPED = {"b": "\b", "t": "\t", "n": "\n", "f": "\f", "r": "\r", '"': '"', "\\": "\\"}


def spans_of(text: str) -> dict[Path, tuple[int, int]]:
    """Return the start and end of each value and list item in a valid TOML `text`."""
    walk = _Walk(text)
    walk.document()
    return walk.spans


def lines_of(text: str) -> dict[Path, int]:
    """Return the line of every table, key and array item of a TOML text.

    Parameters
    ----------
    text : str
        Valid TOML.

    Returns
    -------
    dict of path to int
        Line numbers from 1; incomplete if the text cannot be followed.
    """
    walk = _Walk(text)
    # a partial map is useful: lookups fall back to the nearest known parent
    with contextlib.suppress(RecursionError, LookupError):
        walk.document()
    return walk.lines


def line_at(lines: Mapping[Path, int], path: Path) -> int:
    """Return the line of a path.

    Parameters
    ----------
    lines : mapping of path to int
        From `lines_of`.
    path : tuple
        Keys and indices.

    Returns
    -------
    int
        The line of the path, or of its nearest parent that the text has.
    """
    while path and path not in lines:
        path = path[:-1]
    return lines.get(path, 1)


class _Walk:
    """A cursor over the text."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.lines: dict[Path, int] = {(): 1}
        self.last_item: dict[Path, int] = {}
        self.spans: dict[Path, tuple[int, int]] = {}
        self.end = 0
        self.starts = [0, *(match.end() for match in re.finditer("\n", text))]

    def document(self) -> None:
        table: Path = ()
        self.space()
        while self.at < len(self.text):
            if self.text[self.at] == "[":
                table = self.header()
            else:
                self.pair(table)
            self.space()

    def space(self) -> None:
        match = _SPACE.match(self.text, self.at)
        self.at = match.end() if match else self.at

    def take(self, sign: str) -> bool:
        """Skip a token and the space around it, if it is next; return whether it is."""
        self.space()
        found = self.text.startswith(sign, self.at)
        if found:
            self.at += len(sign)
            self.end = self.at
            self.space()
        return found

    def mark(self, path: Path, at: int, *, explicit: bool = True) -> None:
        line = bisect_right(self.starts, at)
        if explicit:
            self.lines[path] = line
        else:
            self.lines.setdefault(path, line)

    def header(self) -> Path:
        """Read ``[a.b]`` or ``[[a.b]]`` and return the path of the table that it opens."""
        start = self.at
        many = self.take("[[")
        if not many:
            self.take("[")
        *parents, last = self.key()
        path: Path = ()
        for name in parents:
            path = self.enter((*path, name))
            self.mark(path, start, explicit=False)
        path = (*path, last)
        self.mark(path, start, explicit=path not in self.last_item)
        if many:
            self.last_item[path] = self.last_item.get(path, -1) + 1
            path = self.enter(path)
            self.mark(path, start)
        self.take("]]" if many else "]")
        return path

    def enter(self, path: Path) -> Path:
        """Return the path of the last item if `path` is an array of tables, else `path`."""
        return (*path, self.last_item[path]) if path in self.last_item else path

    def pair(self, table: Path) -> None:
        """Read ``key = value``, dotted keys included."""
        start = self.at
        path = table
        for name in self.key():
            path = (*path, name)
            self.mark(path, start, explicit=False)
        self.take("=")
        value = self.at
        self.value(path)
        self.spans[path] = (value, self.end)

    def key(self) -> list[str]:
        names: list[str] = []
        while not names or self.take("."):
            match = _STRING.match(self.text, self.at)
            if match:
                names.append(_unquoted(match.group()))
            else:
                match = _BARE_KEY.match(self.text, self.at)
                if match is None:
                    raise LookupError(self.at)
                names.append(match.group())
            self.at = match.end()
        return names

    def value(self, path: Path) -> None:
        if self.take("["):
            index = 0
            while not self.take("]"):
                item, start = (*path, index), self.at
                self.mark(item, start)
                self.value(item)
                self.spans[item] = (start, self.end)
                self.take(",")
                index += 1
                self.more()
        elif self.take("{"):
            while not self.take("}"):
                self.pair(path)
                self.take(",")
                self.more()
        else:
            match = _STRING.match(self.text, self.at) or _SCALAR.match(self.text, self.at)
            self.end = self.at + len(match.group().rstrip()) if match else self.at
            self.at = match.end() if match else self.at

    def more(self) -> None:
        if self.at >= len(self.text):
            raise LookupError(self.at)


def _unquoted(word: str) -> str:
    if word.startswith("'"):
        return word[1:-1]

    def plain(match: re.Match[str]) -> str:
        code = match.group(1)
        return chr(int(code[1:], 16)) if code[0] in "uU" else _ESCAPED[code]

    return _ESCAPE.sub(plain, word[1:-1])
