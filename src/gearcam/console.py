"""Output of the command line: aligned tables, file sizes, error messages, a progress bar.

Results go to stdout, errors to stderr; output into a pipe or file is plain text. Where a command
answers a program (``--json``), only this goes to stdout, and what people read to stderr.
"""

from __future__ import annotations

import contextlib
import logging
import os
import re
import sys
import textwrap
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, TextIO

from gearcam.base.errors import MOST_LISTED, DesignError, InfeasibleError, Problem, WriteError
from gearcam.base.facts import lined_up
from gearcam.base.numerals import size_of

if TYPE_CHECKING:
    from gearcam.base.findings import Finding
    from gearcam.designs.listing import Listed
    from gearcam.results.advice import Remedies
    from gearcam.results.written import BuildOutput

DEBUG: Final = "GEARCAM_DEBUG"
"""Environment variable that turns tracebacks on."""

_WIDTH: Final = 96

_STEERING: Final = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")
"""Control characters other than tab and newline, and marks that change the text direction."""


def catalogue_lines(
    groups: Sequence[tuple[str, Sequence[Listed]]], sources: Mapping[str, str]
) -> Iterator[str]:
    """Yield the `groups` of laws, each below its heading, then the `sources` that they cite."""
    for heading, laws in groups:
        yield f"{heading}\n"
        for law in laws:
            yield from _law_lines(law)
    yield "Sources\n"
    for name, text in sources.items():
        yield f"{name}\n{wrapped(text)}"


def _law_lines(law: Listed) -> Iterator[str]:
    """Yield the lines of a `law`: name, description, its line in a design file, keys."""
    yield f"{law.name}\n{wrapped(law.doc)}\n    {law.line}"
    width = 2 + max(len(key) for key, _ in law.rows)
    for key, words in law.rows:
        yield wrapped(words, first=f"    {key:<{width}}", rest=" " * (4 + width))
    yield ""


def finding_lines(findings: Sequence[Finding]) -> Iterator[str]:
    """Yield findings as an aligned table, each with its message below."""
    if not findings:
        yield "findings: none"
        return
    yield "findings"
    rows = [(one.severity, one.code, one.where, one.text, one.limit_text) for one in findings]
    for row, finding in zip(lined_up(rows), findings, strict=True):
        yield f"  {row}"
        yield wrapped(finding.message, first="      ", rest="      ")


def all_lines(written: BuildOutput) -> Iterator[str]:
    """Yield facts or table, findings and files of what was `written`."""
    yield from written.table or written.facts.lines()
    yield from finding_lines(written.findings)
    yield from written_lines(written)


def written_lines(written: BuildOutput) -> Iterator[str]:
    """Yield the files written, with their sizes, and those kept, removed or outdated."""
    folder = written.directory
    yield f"written to {folder}"
    names = (*written.files, *written.former, *written.kept, *written.removed)
    width = max(map(len, names), default=0)
    for name in written.files:
        yield f"  {name:<{width}}  {_size(folder / name):>9}"
    for name, before in written.former.items():
        yield f"  {name:<{width}}  kept: what {before} was before"
    for name in written.kept:
        yield f"  {name:<{width}}  kept: no longer part of this build, but you may have edited it"
    for name in written.removed:
        yield f"  {name:<{width}}  removed: no longer part of this build"
    if outdated := ", ".join(written.summary.get("outdated", ())):
        words = "made from another version of the design; build again to renew or remove them"
        words += " (what you may have edited is kept)"
        yield wrapped(f"outdated: {outdated}: {words}", first="")


def _size(path: Path) -> str:
    try:
        return size_of(path.stat().st_size)
    except OSError:
        return ""


def fault_text(error: Exception, file: str) -> str:
    """Return the message for a bug: an unexpected `error` while working on `file`."""
    place = f"{file}: " if file else ""
    what = f"{type(error).__name__}: {error}"
    return (
        f"{place}this is a bug in gearcam, not a mistake in your design: {what}\n"
        f"  please report it with the design file; --debug or {DEBUG}=1 prints a traceback"
    )


def refusal_text(error: DesignError | InfeasibleError, file: str, done: str) -> str:
    """Return the message that `file` was not `done`, with all problems of the `error`."""
    if isinstance(error, InfeasibleError):
        return f"{file}: cannot be made, nothing was {done}\n{infeasible_text(error)}"
    count = len(error.problems)
    lines = [f"{file}: {count} problem{'s' * (count > 1)}, nothing was {done}"]
    lines += [textwrap.indent(problem_text(one), "  ") for one in error.problems[:MOST_LISTED]]
    lines += [f"  and {count - MOST_LISTED} more"] if count > MOST_LISTED else []
    return "\n".join(lines)


def problem_text(problem: Problem) -> str:
    """Return a problem as text, the lines below its first one wrapped."""
    head, *tail = str(problem).split("\n")
    return "\n".join([head, *(wrapped(line.strip(), rest=" " * 8) for line in tail)])


def infeasible_text(error: InfeasibleError) -> str:
    """Return why a design cannot be made, with value and limit, indented."""
    lines = [f"{error.what}, at {error.where}" if error.where else error.what]
    lines += filter(None, [error.numbers()])
    lines += error.nearest.split("; ") if error.nearest else []
    return "\n".join(wrapped(line, first="  ", rest="      ") for line in lines)


def remedy_lines(remedies: Remedies) -> Iterator[str]:
    """Yield the remedies that a search has found, and whether it was complete."""
    if remedies.found:
        many = len(remedies.found) > 1
        yield f"{'each of these changes' if many else 'this change'} was built without errors:"
    for remedy in remedies.found:
        yield wrapped(f"{remedy.text}  {remedy.notes}".rstrip(), first="  ", rest="      ")
    for text, codes in ({} if remedies.found else remedies.nearly).items():
        words = f"with {text} it can be made, but has errors: {', '.join(codes)}"
        yield wrapped(words, first="", rest="  ")
    nearly = " ".join(remedies.nearly)
    keys = ", ".join(key for key in remedies.tried if f"{key} = " not in nearly)
    if remedies.gave_up:
        sought = "more remedies" if remedies.found else "a remedy"
        yield f"the search for {sought} was ended after {remedies.builds} designs"
    elif keys and not remedies.found:
        yield wrapped(f"no remedy was found by changing {keys}", first="", rest="  ")


def wrapped(text: str, *, first: str = "    ", rest: str = "    ") -> str:
    """Return `text` wrapped to the page width, its lines indented by `first` and `rest`."""
    return textwrap.fill(
        text,
        _WIDTH,
        initial_indent=first,
        subsequent_indent=rest,
        break_long_words=False,
        break_on_hyphens=False,
    )


@contextlib.contextmanager
def progress_bar(file: str) -> Iterator[Callable[[str, int, int], None] | None]:
    """Draw a progress bar on a terminal; yield its callback, or None where nobody looks."""
    if not (_Talk.stream and sys.stderr.isatty()):
        yield None
        return
    from rich.console import Console
    from rich.markup import escape
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        name = escape(visible(file))
        task = bar.add_task(name, total=None)

        def advance(stage: str, done: int, total: int) -> None:
            bar.update(task, description=f"{name}: {stage}", completed=done, total=total)

        yield advance


@contextlib.contextmanager
def streams() -> Iterator[None]:
    """Make stdout and stderr accept any text: discard it if closed, escape what they lack."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115
        with contextlib.suppress(AttributeError, ValueError):
            getattr(sys, name).reconfigure(errors="backslashreplace")
    yield
    for stream in (sys.stdout, sys.stderr):
        _write("", stream, end="")  # flush what argparse and others have written


def quieten() -> None:
    """Hide the warnings that libraries address to programmers; errors are still reported."""
    warnings.simplefilter("ignore")
    logging.getLogger().addHandler(logging.NullHandler())


class _Talk:
    """Where the words of a command go: the name of a stream; empty if nobody wants them."""

    stream = "stdout"


@contextlib.contextmanager
def talking(*, quiet: bool, aside: bool) -> Iterator[None]:
    """Yield while a command says nothing, if it is to be `quiet`, or says it to stderr, `aside`."""
    before, _Talk.stream = _Talk.stream, "" if quiet else "stderr" if aside else "stdout"
    try:
        yield
    finally:
        _Talk.stream = before


def silent() -> bool:
    """Return whether a command is to print errors only."""
    return not _Talk.stream


def say(text: str) -> None:
    """Print to stdout, or where a command is `talking`."""
    if _Talk.stream:
        _write(text, getattr(sys, _Talk.stream))


def answer(text: str) -> None:
    """Print what programs read to stdout, whatever else is said."""
    _write(text, sys.stdout)


def complain(text: str) -> None:
    """Print to stderr."""
    _write(text, sys.stderr)


def visible(text: str) -> str:
    """Return `text` with control characters and marks of text direction escaped."""
    return _STEERING.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def _write(text: str, stream: TextIO, end: str = "\n") -> None:
    """Print; a closed pipe (such as one to ``head``) does not stop a build."""
    try:
        print(visible(text), file=stream, end=end, flush=True)
    except OSError as error:
        # discard the buffer, so that the flush at exit does not fail again
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        if not isinstance(error, BrokenPipeError) and stream is sys.stdout:
            raise WriteError(f"cannot write to the standard output: {error.strerror}") from error
