"""What a command is, its exit codes, and how it works on design files.

Given several files, a command works on all of them and returns the largest code.
"""

from __future__ import annotations

import argparse
import json
import os
import textwrap
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NoReturn

from gearcam import build, remedies
from gearcam.base.errors import DesignError, InfeasibleError, MissingExtraError, Problem, WriteError
from gearcam.base.inches import told
from gearcam.console import (
    DEBUG,
    all_lines,
    answer,
    complain,
    fault_text,
    finding_lines,
    problem_text,
    progress_bar,
    refusal_text,
    remedy_lines,
    say,
    silent,
)

if TYPE_CHECKING:
    from gearcam.results.result import Result
    from gearcam.results.study import Progress
    from gearcam.results.written import BuildOutput

GOOD, FINDINGS, WRONG, IMPOSSIBLE, FAULT, INTERRUPTED = 0, 1, 2, 3, 4, 130

EXIT_CODES: Final = {
    GOOD: "success, possibly with warnings",
    FINDINGS: "built, but a check found an error",
    WRONG: "a mistake in the design file or the command, or a file that cannot be written",
    IMPOSSIBLE: "the design cannot be made",
    FAULT: "a bug in gearcam",
    INTERRUPTED: "interrupted by Ctrl-C (143 by SIGTERM, 129 by SIGHUP)",
}
"""Meanings of the exit codes."""

Options = Mapping[str, Any]
"""Values of a command's arguments and options by name."""

Action = Callable[["Result", "Progress | None"], "BuildOutput"]
"""``action(result, progress)`` writes files of a result."""


@dataclass(frozen=True)
class Command:
    """A command.

    Parameters
    ----------
    name : str
        Name on the command line.
    doc : str
        One line of help: what it does and which files it writes.
    run : callable
        ``run(options)`` does the work, prints the outcome and returns the exit code.
    arguments : callable
        ``arguments(parser)`` adds its files and options to a parser.
    """

    name: str
    doc: str
    run: Callable[[Options], int]
    arguments: Callable[[argparse.ArgumentParser], None] = lambda _: None


def add_output(parser: argparse.ArgumentParser) -> None:
    """Add the options of commands that write into an output folder to a `parser`."""
    words = "output folder (default: output)"
    parser.add_argument("-o", "--output", metavar="DIR", default="output", help=words)
    words = "print errors only"
    parser.add_argument("-q", "--quiet", action="store_true", help=words)
    parser.add_argument("--debug", action="store_true", help=f"show tracebacks (or set {DEBUG})")


def add_summary(parser: argparse.ArgumentParser) -> None:
    """Add the option to print the summary for programs to a `parser`."""
    words = "print summary.json to stdout, a line for each design, and all else to stderr"
    parser.add_argument("--json", action="store_true", help=words)


def suggest(action: argparse.Action, words: Callable[[], Iterable[str]]) -> None:
    """Note `words` that shells complete for an `action`, an argument that may take others too."""
    vars(action)["suggested"] = words


def refuse(problems: Sequence[Problem]) -> NoReturn:
    """Print `problems` of the command line and end the command.

    Raises
    ------
    SystemExit
        Always.
    """
    for problem in problems:
        complain(problem_text(problem))
    raise SystemExit(WRONG)


def each_result(
    files: Sequence[str],
    read: Callable[[str], Any],
    done: str,
    action: Action,
    *,
    debug: bool,
    as_json: bool = False,
) -> int:
    """Run an action on the result of every file.

    Parameters
    ----------
    files : sequence of str
        Design files.
    read : callable
        ``read(file)`` returns the design.
    done : str
        Past participle for messages, such as ``built``.
    action : callable
        ``action(result, progress)`` writes files of a result.
    debug : bool
        Whether to print tracebacks of bugs.
    as_json : bool
        Whether to print the summary of each as a line for programs.

    Returns
    -------
    int
        The largest exit code.
    """
    names: dict[str, str] = {}

    def telling(result: Result, progress: Progress | None) -> BuildOutput:
        written = action(result, progress)
        if as_json:
            answer(json.dumps(written.summary, ensure_ascii=False))
        return written

    def work(file: str) -> int:
        start = time.perf_counter()
        design = read(file)
        before = names.setdefault(design.name.casefold(), file)
        if before != file:  # its files would be overwritten
            message = f'the design of {before} has the same name, "{design.name}"'
            raise DesignError([Problem(message, file=file, key="name", value=design.name)])
        return _act(build(design), named(file), done, telling, start)

    return each(files, done, work, debug=debug)


def _act(result: Result, file: str, done: str, action: Action, start: float) -> int:
    """Run `action` on the `result` of one file, print the outcome and return the exit code."""
    from gearcam.numeric.arrays import keep_freed_memory

    keep_freed_memory()
    try:
        with progress_bar(file) as progress:
            written = action(result, progress)
    except InfeasibleError as error:
        complain(refusal_text(told(error, result.design.units), file, done))
        for line in remedy_lines(remedies(result, error)):
            complain(f"  {line}")
        return IMPOSSIBLE
    say(f"{file}: {done} in {time.perf_counter() - start:.2f} s")
    say(textwrap.indent("\n".join(all_lines(written)), "  "))
    if written.interrupted:
        complain(f"{file}: interrupted: {written.interrupted} were written")
        return INTERRUPTED
    errors = [finding for finding in written.findings if finding.severity == "error"]
    if errors and silent():
        complain(f"{file}: {done}, with errors")
        complain(textwrap.indent("\n".join(finding_lines(errors)), "  "))
    for line in remedy_lines(remedies(result)) if errors else ():
        say(f"  {line}")
    return FINDINGS if errors else GOOD


def each(
    files: Sequence[str], done: str, work: Callable[[str], int], *, debug: bool = False
) -> int:
    """Run a function on every file and print its errors.

    Parameters
    ----------
    files : sequence of str
        Design files.
    done : str
        Past participle for messages, such as ``built``.
    work : callable
        ``work(file)`` returns the exit code.
    debug : bool
        Whether to print tracebacks of bugs.

    Returns
    -------
    int
        The largest exit code.
    """
    codes = []
    for file in files:
        try:
            codes.append(work(file))
            if codes[-1] == INTERRUPTED:
                break
        except KeyboardInterrupt:
            return interrupted()
        except DesignError as error:
            complain(refusal_text(error, named(file), done))
            codes.append(WRONG)
        except (WriteError, MissingExtraError) as error:
            complain(f"{named(file)}: {error}")
            codes.append(WRONG)
        except Exception as error:
            codes.append(fault(error, file=named(file), debug=debug))
    if len(files) > 1:
        count = sum(code in (GOOD, FINDINGS) for code in codes)
        say(f"{len(files)} files: {count} {done}, {len(files) - count} refused")
    return max(codes, default=GOOD)


def named(file: str) -> str:
    """Return what a `file` of the command line is called in messages."""
    from gearcam.designs.reader import STDIN, STDIN_NAME

    return STDIN_NAME if file == STDIN else file


def fault(error: Exception, *, file: str = "", debug: bool = False) -> int:
    """Return the exit code of an unexpected `error` in a `file`; report it, for `debug` fully."""
    if debug or os.environ.get(DEBUG):
        import traceback

        complain("".join(traceback.format_exception(error)).rstrip())
    complain(fault_text(error, file))
    return FAULT


def interrupted() -> int:
    """Report an interruption and return the exit code."""
    complain("interrupted: no file was left half-written")
    return INTERRUPTED
