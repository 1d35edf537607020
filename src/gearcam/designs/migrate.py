"""Rewriting design files: retired keys become those that stand for them, all else stays as it is.

The text is edited where the keys stand: comments, order, blanks and line ends stay. What comes of
it must read as a design, or nothing is changed.
"""

from __future__ import annotations

import codecs
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from gearcam.designs.faults import dotted
from gearcam.designs.kind import KINDS
from gearcam.designs.lines import Span, spans_of
from gearcam.designs.reader import content_of, decoded, document_in, loads, problems_of
from gearcam.designs.retired import Found, Instead, assigned, without_retired
from gearcam.errors import DesignError, Problem


def migrate(file: str) -> tuple[bytes, tuple[str, ...]]:
    """Rewrite a design file.

    Parameters
    ----------
    file : str
        A TOML file in UTF-8.

    Returns
    -------
    content : bytes
        What the file should hold.
    changes : tuple of str
        What has been changed, in words; empty where the file is as it should be.

    Raises
    ------
    DesignError
        If the file cannot be read, if nothing stands for a retired key alone, or if what would come
        of it does not read as a design.
    """
    content = content_of(file)
    text = decoded(content, file)
    document = document_in(text, file)
    found, _ = without_retired(document)
    if not found:
        return content, ()
    stuck = [one.fault for one in found if one.instead.by_hand]
    if stuck:
        raise DesignError(problems_of(stuck, text, file))
    made, left = _retitled(text, document, found)
    for one in left:
        made = _rewritten(made, one)
    for title in {one.path[0] for one in left}:
        if not document_in(made, file).get(title, True):
            made = _without_table(
                made, title, known=any(title in kind.titles for kind in KINDS.values())
            )
    try:
        loads(made, file=file)
    except DesignError as error:
        raise DesignError(_others(text, file, found) or error.problems) from None
    mark = codecs.BOM_UTF8 if content.startswith(codecs.BOM_UTF8) else b""
    changes = tuple(f"{dotted(one.path)} -> {one.instead.words}" for one in found)
    return mark + made.encode(), changes


def _others(text: str, file: str, found: list[Found]) -> list[Problem]:
    """Return what else is wrong in a file, by its own lines."""
    known = {dotted(one.path) for one in found}
    try:
        loads(text, file=file)
    except DesignError as error:
        return [problem for problem in error.problems if problem.key not in known]
    return []


def _retitled(
    text: str, document: Mapping[str, Any], found: list[Found]
) -> tuple[str, list[Found]]:
    """Give heads of tables, all of whose keys go to one new table, its name; what is left."""
    left = list(found)
    for (title, *more), end in spans_of(text).heads.items():
        moved = [one for one in found if one.path[0] == title and one.instead.there]
        homes = {home for one in moved for home, _ in one.instead.there}
        if (
            more
            or len(moved) != len(document[str(title)])
            or len(homes) != 1
            or homes & {*document}
        ):
            continue
        (home,) = homes
        start = _line_start(text, end)
        head = text[start:end].replace(str(title), home, 1)
        text = text[:start] + head + text[end:]
        for one in moved:
            here = {key: value for (_, key), value in one.instead.there.items()}
            place = left.index(one)
            left[place] = replace(one, path=(home, one.path[1]), instead=Instead(here=here))
        break  # places have moved, and no second table has gone
    return text, left


def _rewritten(text: str, found: Found) -> str:
    """Return a text with other keys for a retired one."""
    text = _replaced(text, spans_of(text).pairs[found.path], found.instead.here)
    for (title, key), value in found.instead.there.items():
        text = _added(text, title, assigned(key, value))
    return text


def _replaced(text: str, span: Span, here: Mapping[str, Any]) -> str:
    """Put other keys of the same table in the place of one, or nothing."""
    prefix = text[span.start : span.name]
    items = [prefix + assigned(key, value) for key, value in here.items()]
    if _is_inline(text, span):
        if items:
            return text[: span.start] + ", ".join(items) + text[span.end :]
        return _without_item(text, span)
    if not items:
        return _without_line(text, span)
    first, *rest = items
    text = text[: span.start] + first + text[span.end :]
    for item in reversed(rest):
        text = _line_after(text, span.start, item)
    return text


def _is_inline(text: str, span: Span) -> bool:
    """Whether a pair stands in a table in braces: something stands before it on its line."""
    return bool(text[_line_start(text, span.start) : span.start].strip())


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _without_item(text: str, span: Span) -> str:
    """Take a pair out of its braces, with one of the commas beside it."""
    before, after = text[: span.start], text[span.end :]
    if after.lstrip().startswith(","):
        return before + after.lstrip()[1:].lstrip()
    return before.rstrip().removesuffix(",") + after


def _without_line(text: str, span: Span) -> str:
    """Take the line of a pair out; a comment on it stays."""
    start, end = _line_start(text, span.start), text.find("\n", span.end) + 1
    end = end or len(text)
    rest = text[span.end : end].lstrip(" \t")
    kept = text[start : span.start] + rest if rest.strip() else ""
    return text[:start] + kept + text[end:]


def _without_table(text: str, title: str, *, known: bool) -> str:
    """Take an empty table out: in braces, or the head of one that is not `known` any more."""
    spans = spans_of(text)
    span = spans.pairs.get((title,))
    if span is None:
        if known:
            return text
        end = spans.heads[title,]
        start = _line_start(text, end)
        span = Span(start, start, end, end)
    return _without_line(text, span)


def _line_after(text: str, at: int, item: str) -> str:
    """Put an item on a line of its own below that of a place, with the same indentation."""
    newline = "\r\n" if "\r\n" in text else "\n"
    start, end = _line_start(text, at), text.find("\n", at) + 1
    indent = text[start:at] if not text[start:at].strip() else ""
    if not end:
        return f"{text}{newline}{indent}{item}{newline}"
    return f"{text[:end]}{indent}{item}{newline}{text[end:]}"


def _added(text: str, title: str, item: str) -> str:
    """Add an item to a table, which is made where there is none."""
    spans = spans_of(text)
    inside = [span for path, span in spans.pairs.items() if path[:1] == (title,) and len(path) == 2]
    whole = spans.pairs.get((title,))
    if whole is not None:  # a table in braces
        end = max((span.end for span in inside), default=0)
        if end:
            return f"{text[:end]}, {item}{text[end:]}"
        return f"{text[: whole.value]}{{ {item} }}{text[whole.end :]}"
    if inside:
        last = max(inside, key=lambda span: span.end)
        line = text[last.start : last.name] + item
        return _below(text, last, line)
    if (title,) in spans.heads:
        at = spans.heads[title,]
        return _line_after(text, _line_start(text, at), item)
    newline = "\r\n" if "\r\n" in text else "\n"
    gap = "" if text.endswith("\n") else newline
    return f"{text}{gap}{newline}[{title}]{newline}{item}{newline}"


def _below(text: str, last: Span, line: str) -> str:
    """Put a line below a pair, whose value may take several lines, indented as the pair is."""
    indent = text[_line_start(text, last.start) : last.start]
    return _line_after(text, last.end, indent + line)
