"""The command line.

Every command ends with one of `EXIT_CODES`. Given several files, a command works on all of them and
returns the largest code. Results go to stdout, errors to stderr; a progress bar is drawn on a
terminal only.
"""

from __future__ import annotations

import argparse
import os
import sys
import textwrap
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from gearcam import build, remedies
from gearcam.commands import demand_new_name
from gearcam.console import (
    DEBUG,
    all_lines,
    catalogue_lines,
    complain,
    fault_text,
    problem_text,
    progress_bar,
    quieten,
    refusal_text,
    remedy_lines,
    say,
    streams,
)
from gearcam.designs import KINDS, Design, load
from gearcam.designs.faults import unknown_word
from gearcam.designs.kind import all_formats, rooms
from gearcam.designs.outputs import FORMATS
from gearcam.errors import DesignError, InfeasibleError, MissingExtraError, Problem, WriteError
from gearcam.interrupts import interruptible

if TYPE_CHECKING:
    from gearcam.commands import Command
    from gearcam.result import Progress, Result
    from gearcam.written import Written

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

_ABOUT: Final = "Design cams and pairs of non-circular gears from a description of their motion."
_FILES: Final = "design files (TOML)"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Default: those of the process.

    Returns
    -------
    int
        The exit code.
    """
    with interruptible() as ended:
        return ended.code(_run(arguments))


def _run(arguments: Sequence[str] | None) -> int:
    """Run the command line and return its exit code; any interruption counts as Ctrl-C."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if arguments is None and not (sys.warnoptions or "--debug" in words or os.environ.get(DEBUG)):
        quieten()
    try:
        with streams():
            try:
                _dispatch(words)
            except SystemExit as stop:
                return stop.code if isinstance(stop.code, int) else GOOD
    except KeyboardInterrupt:
        return _interrupted()
    except WriteError as error:
        complain(str(error))
        return WRONG
    except Exception as error:
        return _fault(error, debug="--debug" in words)
    return GOOD


def _dispatch(words: list[str]) -> None:
    """Run the command named by the first word with the other words."""
    own, word = _functions(), words[0] if words else ""
    if word in own:
        formats = all_formats() if {"-h", "--help"} & set(words) else FORMATS
        parser = _parser(word, own[word], formats)
        own[word](**vars(parser.parse_intermixed_args(words[1:])))
        return
    other = next((command for command in _commands_of_kinds() if command.name == word), None)
    if other is not None:
        _of_kind(other, words[1:])
        return
    docs = {name: function.__doc__ or "" for name, function in own.items()}
    docs |= {command.name: command.doc for command in _commands_of_kinds()}
    top = argparse.ArgumentParser(
        prog="gearcam",
        description=_ABOUT,
        epilog=_help(docs),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="store_true", help="show the version and exit")
    top.add_argument("command", nargs="?", metavar="COMMAND", help="one of the commands below")
    given = top.parse_args(words[:1])
    if given.version:
        from gearcam.version import __version__

        say(f"gearcam {__version__}")
    elif given.command is None:
        top.print_help(sys.stderr)
        raise SystemExit(WRONG)
    else:
        _refuse([unknown_word(word, "is not a command", docs)])


def _functions() -> dict[str, Callable[..., None]]:
    functions = (_build, _check, _compare, _view, _laws, _new, _schema)
    return {function.__name__.lstrip("_"): function for function in functions}


def parsers() -> Iterator[argparse.ArgumentParser]:
    """Yield the argument parser of every command; its description says what the command does."""
    for name, function in _functions().items():
        yield _parser(name, function, all_formats())
    yield from map(_kind_parser, _commands_of_kinds())


def _commands_of_kinds() -> Iterator[Command]:
    """Yield the commands for one kind of design, then those of studies for any kind."""
    for room in rooms("commands"):
        yield from room.COMMANDS
    from gearcam.studies.commands import COMMANDS

    yield from COMMANDS


def _parser(
    name: str, command: Callable[..., None], formats: Sequence[str]
) -> argparse.ArgumentParser:
    """Return the argument parser of a command; its help text is the function's docstring."""
    parser = _new_parser(name, command.__doc__)
    if command in (_build, _check):
        parser.add_argument("files", nargs="+", metavar="FILE", help=_FILES)
    if command in (_build, _check, _compare):
        _add_common(parser)
    if command in (_compare, _view):
        import_module(f"gearcam.{name}.command").arguments(parser)
    if command is _build:
        words = f"write these files instead of output.files: {', '.join(formats)}"
        parser.add_argument("--only", action="append", metavar="A,B,...", help=words)
    if command is _new:
        words = f"kind of design: {' or '.join(KINDS)}"
        parser.add_argument("kind", metavar="KIND", help=words)
        parser.add_argument("file", nargs="?", metavar="FILE", help="default: stdout")
        words = "preset backlash, clearance and kerf for printing, laser or wire"
        parser.add_argument("--for", dest="process", metavar="PROCESS", help=words)
    return parser


class _Help(argparse.HelpFormatter):
    def _split_lines(self, text: str, width: int) -> list[str]:
        return textwrap.wrap(text, width, break_on_hyphens=False)


def _new_parser(name: str, doc: str | None) -> argparse.ArgumentParser:
    return argparse.ArgumentParser(prog=f"gearcam {name}", description=doc, formatter_class=_Help)


def _add_common(parser: argparse.ArgumentParser) -> None:
    words = "output folder (default: output)"
    parser.add_argument("-o", "--output", metavar="DIR", default="output", help=words)
    parser.add_argument("--debug", action="store_true", help=f"show tracebacks (or set {DEBUG})")


def _help(docs: Mapping[str, str]) -> str:
    commands = [f"  {name:<10}{doc}" for name, doc in docs.items()]
    codes = [f"  {code:<10}{meaning}" for code, meaning in EXIT_CODES.items()]
    more = "DIR is the output folder, NAME the name of the design."
    more += "\ngearcam COMMAND --help explains the options of a command."
    return "\n".join(["commands:", *commands, "", more, "", "exit codes:", *codes])


def _build(files: list[str], output: str, only: list[str] | None, debug: bool) -> None:
    """Build designs and write their files into DIR/NAME/."""
    kinds = _kinds(only)
    _each_result(files, "built", lambda one, bar: one.write(output, kinds, bar), debug=debug)


def _check(files: list[str], output: str, debug: bool) -> None:
    """Check designs; write DIR/NAME/summary.json only."""
    _each_result(files, "checked", lambda result, _: result.check(output), debug=debug)


def _view(file: str, port: int, no_browser: bool) -> None:
    """Show a design in the browser; update the page when the file is saved."""
    from gearcam.view.command import view

    _each([file], "shown", lambda one: view(one, port, browser=not no_browser) or GOOD)


def _compare(files: list[str], debug: bool, **options: Any) -> None:
    """Compare designs or variants of one design; write DIR/compare.html."""
    from gearcam.compare.command import compare

    def work(_: str) -> int:
        return {"refused": IMPOSSIBLE, "error": FINDINGS}.get(compare(files, **options), GOOD)

    _each([" ".join(files)], "compared", work, debug=debug)


def _kind_parser(command: Command) -> argparse.ArgumentParser:
    parser = _new_parser(command.name, command.doc)
    if command.many:
        parser.add_argument("files", nargs="+", metavar="FILE", help=_FILES)
    else:
        parser.add_argument("file", metavar="FILE", help="design file (TOML)")
    _add_common(parser)
    command.arguments(parser)
    return parser


def _of_kind(command: Command, words: list[str]) -> None:
    """Run a `command` with the words that follow its name."""
    options = vars(_kind_parser(command).parse_intermixed_args(words))
    files = options.pop("files") if command.many else [options.pop("file")]
    output, debug = options.pop("output"), options.pop("debug")

    def action(result: Result, progress: Progress | None) -> Written:
        return command.run(result, output, options, progress)

    def adapt(design: Design) -> Design:
        return command.adapt(design, options)

    _each_result(files, command.done, action, debug=debug, adapt=adapt)


def _laws() -> None:
    """List transmission-ratio laws and motion laws with keys, continuity and source."""
    from gearcam.designs.listing import law_groups, sources_of

    groups = list(law_groups())
    say("\n".join(catalogue_lines(groups, sources_of(groups))))


def _new(kind: str, file: str | None, process: str | None) -> None:
    """Create a commented design file to start from; never overwrites a file."""
    from gearcam.designs.template import template
    from gearcam.export.write import write_new

    if kind not in KINDS:
        _refuse([unknown_word(kind, "is not a kind of design", KINDS, "KIND")])
    if process is not None and process not in KINDS[kind].processes:
        _refuse([unknown_word(process, "is not supported", KINDS[kind].processes, "--for")])
    text = template(kind, Path(file or "").stem, process or "")
    if file is None:
        say(text.rstrip("\n"))
        return
    import shlex

    try:
        write_new(file, text)
    except WriteError as error:
        complain(str(error))
        raise SystemExit(WRONG) from None
    say(f"{file}: written; build it with: gearcam build {shlex.quote(file)}")


def _schema() -> None:
    """Print the JSON Schema of design files, for use in editors."""
    import json

    from gearcam.designs.schema import schema as made

    say(json.dumps(made(), indent=2))


def _kinds(only: list[str] | None) -> tuple[str, ...] | None:
    """Return the kinds of files listed by ``--only``; None without the option."""
    if only is None:
        return None
    kinds = [word.strip() for words in only for word in words.split(",") if word.strip()]
    if not kinds:
        _refuse([Problem("the list is empty", key="--only", allowed=", ".join(all_formats()))])
    strange = [kind for kind in kinds if kind not in FORMATS and kind not in all_formats()]
    if strange:
        words = "is not a kind of file"
        _refuse([unknown_word(kind, words, all_formats(), "--only") for kind in strange])
    return tuple(dict.fromkeys(kinds))


def _refuse(problems: Sequence[Problem]) -> None:
    for problem in problems:
        complain(problem_text(problem))
    raise SystemExit(WRONG)


Action = Callable[["Result", "Progress | None"], "Written"]
Adapt = Callable[[Design], Design]


def _each_result(
    files: Sequence[str], done: str, action: Action, *, debug: bool, adapt: Adapt | None = None
) -> None:
    """Run `action` on the result of every file, after `adapt` has changed its design."""
    names: dict[str, str] = {}
    _each(files, done, lambda file: _one(file, names, done, action, adapt), debug=debug)


def _each(
    files: Sequence[str], done: str, work: Callable[[str], int], *, debug: bool = False
) -> None:
    """Run `work` on every file and exit with the largest code."""
    codes = []
    for file in files:
        try:
            codes.append(work(file))
            if codes[-1] == INTERRUPTED:
                break
        except KeyboardInterrupt:
            raise SystemExit(_interrupted()) from None
        except DesignError as error:
            complain(refusal_text(error, file, done))
            codes.append(WRONG)
        except (WriteError, MissingExtraError) as error:
            complain(f"{file}: {error}")
            codes.append(WRONG)
        except Exception as error:
            codes.append(_fault(error, file=file, debug=debug))
    if len(files) > 1:
        count = sum(code in (GOOD, FINDINGS) for code in codes)
        say(f"{len(files)} files: {count} {done}, {len(files) - count} refused")
    raise SystemExit(max(codes, default=GOOD))


def _one(file: str, names: dict[str, str], done: str, action: Action, adapt: Adapt | None) -> int:
    """Run `action` on the result of one file, print the outcome and return the exit code."""
    start = time.perf_counter()
    design = load(file) if adapt is None else adapt(load(file))
    demand_new_name(design, file, names)
    from gearcam.numeric.memory import keep_freed_memory

    keep_freed_memory()
    result = build(design)
    try:
        with progress_bar(file) as progress:
            written = action(result, progress)
    except InfeasibleError as error:
        complain(refusal_text(error, file, done))
        for line in remedy_lines(remedies(result, error)):
            complain(f"  {line}")
        return IMPOSSIBLE
    say(f"{file}: {done} in {time.perf_counter() - start:.2f} s")
    say(textwrap.indent("\n".join(all_lines(written)), "  "))
    if not written.complete:
        meshing = written.summary["meshing"]
        done, steps = meshing["steps_done"], meshing["steps"]
        complain(f"{file}: interrupted: {done} of {steps} steps were written")
        return INTERRUPTED
    errors = any(finding.severity == "error" for finding in written.findings)
    for line in remedy_lines(remedies(result)) if errors else ():
        say(f"  {line}")
    return FINDINGS if errors else GOOD


def _fault(error: Exception, *, file: str = "", debug: bool = False) -> int:
    """Report a bug in gearcam; print the traceback only when debugging."""
    if debug or os.environ.get(DEBUG):
        import traceback

        complain("".join(traceback.format_exception(error)).rstrip())
    complain(fault_text(error, file))
    return FAULT


def _interrupted() -> int:
    complain("interrupted: no file was left half-written")
    return INTERRUPTED
