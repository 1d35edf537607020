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
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NoReturn

from gearcam import build, remedies
from gearcam.base.errors import DesignError, InfeasibleError, MissingExtraError, Problem, WriteError
from gearcam.base.interrupts import interruptible
from gearcam.commands import Command, studied, study_arguments
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
from gearcam.designs import Design, load
from gearcam.designs.faults import unknown_word
from gearcam.designs.kind import all_formats
from gearcam.designs.outputs import FORMATS
from gearcam.results.kind import KINDS, Kind, Study

if TYPE_CHECKING:
    from gearcam.results.result import Progress, Result
    from gearcam.results.written import Written

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
                return _dispatch(words)
            except SystemExit as stop:
                return stop.code if isinstance(stop.code, int) else GOOD
    except KeyboardInterrupt:
        return _interrupted()
    except WriteError as error:
        complain(str(error))
        return WRONG
    except Exception as error:
        return _fault(error, debug="--debug" in words)


def _dispatch(words: list[str]) -> int:
    """Run the command named by the first word with the other words; return the exit code."""
    word = words[0] if words else ""
    command = next((one for one in _commands() if one.name == word), None)
    if command is not None:
        return command.run(vars(_parser(command).parse_intermixed_args(words[1:])))
    docs = {one.name: one.doc for one in _commands()}
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
        return GOOD
    if given.command is not None:
        _refuse([unknown_word(word, "is not a command", docs)])
    top.print_help(sys.stderr)
    return WRONG


def _commands() -> Iterator[Command]:
    """Yield the commands: general ones, then those of studies; of one kind of design first."""
    yield from _COMMANDS
    found = {name: (study, kind) for kind in KINDS.values() for name, study in kind.studies.items()}
    shared = [name for name in found if all(name in kind.studies for kind in KINDS.values())]
    for name in (*(name for name in found if name not in shared), *shared):
        yield _of_study(*found[name])


def parsers() -> Iterator[argparse.ArgumentParser]:
    """Yield the argument parser of every command; its description says what the command does."""
    return map(_parser, _commands())


class _Help(argparse.HelpFormatter):
    """Help texts with words wrapped at spaces, and formats where they have ``{formats}``."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        return textwrap.wrap(text, width, break_on_hyphens=False)

    def _get_help_string(self, action: argparse.Action) -> str:
        text = action.help or ""
        # the formats load all kinds of design
        return text.replace("{formats}", ", ".join(all_formats())) if "{formats}" in text else text


def _parser(command: Command) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"gearcam {command.name}", description=command.doc, formatter_class=_Help
    )
    command.arguments(parser)
    return parser


def _add_files(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", nargs="+", metavar="FILE", help="design files (TOML)")
    _add_common(parser)


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


def _of_study(study: Study, kind: Kind) -> Command:
    """Return the command of a `study` of a `kind` of design."""

    def arguments(parser: argparse.ArgumentParser) -> None:
        number = "+" if study.many else None
        parser.add_argument("designs", nargs=number, metavar="FILE", help="design file (TOML)")
        _add_common(parser)
        study_arguments(study, kind, parser)

    def run(given: Mapping[str, Any]) -> int:
        settings = dict(given)
        files = settings.pop("designs")
        output, debug = settings.pop("output"), settings.pop("debug")
        return _each_result(
            files if study.many else [files],
            study.done,
            lambda result, progress: result.study(study.name, progress).write(output),
            debug=debug,
            adapt=lambda design: studied(study, design, settings),
        )

    return Command(study.name, study.doc, run, arguments)


def _build_arguments(parser: argparse.ArgumentParser) -> None:
    _add_files(parser)
    words = "write these files instead of output.files: {formats}"
    parser.add_argument("--only", action="append", metavar="A,B,...", help=words)


def _build(options: Mapping[str, Any]) -> int:
    output, formats = options["output"], _formats(options["only"])
    return _each_result(
        options["files"],
        "built",
        lambda result, progress: result.write(output, formats, progress),
        debug=options["debug"],
    )


def _formats(only: list[str] | None) -> tuple[str, ...] | None:
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


def _check(options: Mapping[str, Any]) -> int:
    return _each_result(
        options["files"],
        "checked",
        lambda result, _: result.check(options["output"]),
        debug=options["debug"],
    )


def _compare_arguments(parser: argparse.ArgumentParser) -> None:
    from gearcam.compare.command import arguments

    _add_common(parser)
    arguments(parser)


def _compare(options: Mapping[str, Any]) -> int:
    from gearcam.compare.command import compare

    files, settings, output = options["files"], options["settings"], options["output"]

    def work(_: str) -> int:
        worst = compare(files, settings, output, every=options["every"])
        return {"refused": IMPOSSIBLE, "error": FINDINGS}.get(worst, GOOD)

    return _each([" ".join(files)], "compared", work, debug=options["debug"])


def _view_arguments(parser: argparse.ArgumentParser) -> None:
    from gearcam.view.command import arguments

    arguments(parser)


def _view(options: Mapping[str, Any]) -> int:
    from gearcam.view.command import view

    def work(file: str) -> int:
        view(file, options["port"], browser=not options["no_browser"])
        return GOOD

    return _each([options["file"]], "shown", work)


def _laws(_: Mapping[str, Any]) -> int:
    from gearcam.designs.listing import law_groups, sources_of

    groups = list(law_groups())
    say("\n".join(catalogue_lines(groups, sources_of(groups))))
    return GOOD


def _new_arguments(parser: argparse.ArgumentParser) -> None:
    words = f"kind of design: {' or '.join(KINDS)}"
    parser.add_argument("kind", metavar="KIND", help=words)
    parser.add_argument("file", nargs="?", metavar="FILE", help="default: stdout")
    words = "preset backlash, clearance and kerf for printing, laser or wire"
    parser.add_argument("--for", dest="process", metavar="PROCESS", help=words)


def _new(options: Mapping[str, Any]) -> int:
    from gearcam.designs.template import template
    from gearcam.export.write import write_new

    kind, file, process = options["kind"], options["file"], options["process"]
    if kind not in KINDS:
        _refuse([unknown_word(kind, "is not a kind of design", KINDS, "KIND")])
    if process is not None and process not in KINDS[kind].processes:
        known = KINDS[kind].processes
        _refuse([unknown_word(process, "is not supported", known, "--for")])
    text = template(kind, Path(file or "").stem, process or "")
    if file is None:
        say(text.rstrip("\n"))
        return GOOD
    import shlex

    write_new(file, text)
    say(f"{file}: written; build it with: gearcam build {shlex.quote(file)}")
    return GOOD


def _schema(_: Mapping[str, Any]) -> int:
    import json

    from gearcam.designs.schema import schema

    say(json.dumps(schema(), indent=2))
    return GOOD


_COMMANDS: Final = (
    Command(
        "build",
        "Build designs and write their files into DIR/NAME/.",
        _build,
        _build_arguments,
    ),
    Command("check", "Check designs; write DIR/NAME/summary.json only.", _check, _add_files),
    Command(
        "compare",
        "Compare designs or variants of one design; write DIR/compare.html.",
        _compare,
        _compare_arguments,
    ),
    Command(
        "view",
        "Show a design in the browser; update the page when the file is saved.",
        _view,
        _view_arguments,
    ),
    Command(
        "laws",
        "List transmission-ratio laws and motion laws with keys, continuity and source.",
        _laws,
    ),
    Command(
        "new",
        "Create a commented design file to start from; never overwrites a file.",
        _new,
        _new_arguments,
    ),
    Command("schema", "Print the JSON Schema of design files, for use in editors.", _schema),
)


def _refuse(problems: Sequence[Problem]) -> NoReturn:
    for problem in problems:
        complain(problem_text(problem))
    raise SystemExit(WRONG)


Action = Callable[["Result", "Progress | None"], "Written"]
Adapt = Callable[[Design], Design]


def _each_result(
    files: Sequence[str], done: str, action: Action, *, debug: bool, adapt: Adapt | None = None
) -> int:
    """Run `action` on the result of every file, after `adapt` has changed its design."""
    names: dict[str, str] = {}
    return _each(files, done, lambda file: _one(file, names, done, action, adapt), debug=debug)


def _each(
    files: Sequence[str], done: str, work: Callable[[str], int], *, debug: bool = False
) -> int:
    """Run `work` on every file and return the largest code."""
    codes = []
    for file in files:
        try:
            codes.append(work(file))
            if codes[-1] == INTERRUPTED:
                break
        except KeyboardInterrupt:
            return _interrupted()
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
    return max(codes, default=GOOD)


def _one(file: str, names: dict[str, str], done: str, action: Action, adapt: Adapt | None) -> int:
    """Run `action` on the result of one file, print the outcome and return the exit code."""
    start = time.perf_counter()
    design = load(file) if adapt is None else adapt(load(file))
    before = names.setdefault(design.name.casefold(), file)
    if before != file:  # its files would be overwritten
        message = f'the design of {before} has the same name, "{design.name}"'
        raise DesignError([Problem(message, file=file, key="name", value=design.name)])
    from gearcam.numeric.arrays import keep_freed_memory

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
    if written.interrupted:
        complain(f"{file}: interrupted: {written.interrupted} were written")
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
