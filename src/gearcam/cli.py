"""The command line.

Every command ends with one of the exit codes of `gearcam.commands`. Results go to stdout, errors to
stderr; a progress bar is drawn on a terminal only.
"""

from __future__ import annotations

import argparse
import os
import sys
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from gearcam.base.errors import Problem, WriteError
from gearcam.base.interrupts import interruptible
from gearcam.base.registry import deferred
from gearcam.commands import (
    EXIT_CODES,
    GOOD,
    WRONG,
    Command,
    Options,
    add_output,
    each_result,
    fault,
    interrupted,
    refuse,
    study_command,
)
from gearcam.console import DEBUG, catalogue_lines, complain, quieten, say, streams
from gearcam.designs import load
from gearcam.designs.faults import unknown_word
from gearcam.designs.kind import all_formats
from gearcam.designs.outputs import FORMATS
from gearcam.results.kind import KINDS

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
        return interrupted()
    except WriteError as error:
        complain(str(error))
        return WRONG
    except Exception as error:
        return fault(error, debug="--debug" in words)


def _dispatch(words: list[str]) -> int:
    """Run the command named by the first word with the other words; return the exit code."""
    word = words[0] if words else ""
    command = _command(word)
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
    options = top.parse_args(words[:1])
    if options.version:
        from gearcam.version import __version__

        say(f"gearcam {__version__}")
        return GOOD
    if options.command is not None:
        refuse([unknown_word(word, "is not a command", docs)])
    top.print_help(sys.stderr)
    return WRONG


def _commands() -> Iterator[Command]:
    """Yield the commands: general ones, then those of studies."""
    yield from _COMMANDS
    for name in sorted({name for kind in KINDS.values() for name in kind.studies}):
        yield study_command(name)


def _command(word: str) -> Command | None:
    """Return the command of a `word`; None if there is none."""
    # those known here first: only then are other packages asked
    for kind in KINDS.values() if word not in _GENERAL else ():
        if word in kind.study_tables:
            return study_command(word)
    return next((one for one in _commands() if one.name == word), None)


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


def _help(docs: Mapping[str, str]) -> str:
    commands = [f"  {name:<10}{doc}" for name, doc in docs.items()]
    codes = [f"  {code:<10}{meaning}" for code, meaning in EXIT_CODES.items()]
    more = "DIR is the output folder, NAME the name of the design."
    more += "\ngearcam COMMAND --help explains the options of a command."
    return "\n".join(["commands:", *commands, "", more, "", "exit codes:", *codes])


# --- general commands ----------------------------------------------------------------------------


def _add_files(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", nargs="+", metavar="FILE", help="design files (TOML)")
    add_output(parser)


def _build_arguments(parser: argparse.ArgumentParser) -> None:
    _add_files(parser)
    words = "write these files instead of output.files: {formats}"
    parser.add_argument("--only", action="append", metavar="A,B,...", help=words)


def _build(options: Options) -> int:
    output, formats = options["output"], _formats(options["only"])
    return each_result(
        options["files"],
        load,
        "built",
        lambda result, progress: result.write(output, formats, progress),
        debug=options["debug"],
    )


def _formats(only: list[str] | None) -> tuple[str, ...] | None:
    """Return the formats listed by ``--only``; None without the option."""
    if only is None:
        return None
    formats = [word.strip() for words in only for word in words.split(",") if word.strip()]
    if not formats:
        refuse([Problem("the list is empty", key="--only", allowed=", ".join(all_formats()))])
    unknown = [name for name in formats if name not in FORMATS and name not in all_formats()]
    if unknown:
        words = "is not a file format"
        refuse([unknown_word(name, words, all_formats(), "--only") for name in unknown])
    return tuple(dict.fromkeys(formats))


def _check(options: Options) -> int:
    return each_result(
        options["files"],
        load,
        "checked",
        lambda result, _: result.check(options["output"]),
        debug=options["debug"],
    )


def _laws(_: Options) -> int:
    from gearcam.designs.listing import law_groups, sources_of

    groups = list(law_groups())
    say("\n".join(catalogue_lines(groups, sources_of(groups))))
    return GOOD


def _new_arguments(parser: argparse.ArgumentParser) -> None:
    words = f"kind of design: {' or '.join(KINDS)}"
    parser.add_argument("kind", metavar="KIND", help=words)
    parser.add_argument("file", nargs="?", metavar="FILE", help="default: stdout")
    words = "preset backlash, clearance, kerf and tool for printing, laser, wire or milling"
    parser.add_argument("--for", dest="process", metavar="PROCESS", help=words)


def _new(options: Options) -> int:
    from gearcam.designs.template import process_problem, template, template_hint
    from gearcam.export.write import write_new

    kind, file, process = options["kind"], options["file"], options["process"]
    if kind not in KINDS:
        problem = unknown_word(kind, "is not a kind of design", KINDS, "KIND")
        refuse([replace(problem, hint=template_hint(kind))])
    if process is not None and (problem := process_problem(kind, process)):
        refuse([problem])
    text = template(kind, Path(file or "").stem, process or "")
    if file is None:
        say(text.rstrip("\n"))
        return GOOD
    import shlex

    write_new(file, text)
    say(f"{file}: written; build it with: gearcam build {shlex.quote(file)}")
    return GOOD


def _schema(_: Options) -> int:
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
        deferred("gearcam.compare.command:compare"),
        deferred("gearcam.compare.command:arguments"),
    ),
    Command(
        "sweep",
        "Build thousands of variants of a design; write DIR/sweep.csv and sweep.html.",
        deferred("gearcam.sweep.command:sweep"),
        deferred("gearcam.sweep.command:arguments"),
    ),
    Command(
        "optimize",
        "Search the best of a design's variants; write DIR/best.toml and optimize.html.",
        deferred("gearcam.sweep.optimize:optimize"),
        deferred("gearcam.sweep.optimize:arguments"),
    ),
    Command(
        "view",
        "Show a design in the browser; update the page when the file is saved.",
        deferred("gearcam.view.command:view"),
        deferred("gearcam.view.command:arguments"),
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

_GENERAL: Final = frozenset(one.name for one in _COMMANDS)
"""Names of the general commands."""
