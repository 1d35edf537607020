"""The command line: its commands by name; only what a command needs is imported.

Every command ends with one of the exit codes of `gearcam.commands`. Results go to stdout, errors to
stderr; a progress bar is drawn on a terminal only.
"""

from __future__ import annotations

import argparse
import os
import sys
import textwrap
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from gearcam.base.errors import WriteError
from gearcam.base.interrupts import interruptible
from gearcam.base.kinds import kind_names, kind_studies
from gearcam.base.registry import deferred
from gearcam.commands import EXIT_CODES, GOOD, WRONG, Command, Options, fault, interrupted, refuse
from gearcam.console import DEBUG, complain, quieten, say, streams, talking

if TYPE_CHECKING:
    from gearcam.results.studies import Study

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
        options = vars(_parser(command).parse_intermixed_args(words[1:]))
        with talking(quiet=options.get("quiet", False), aside=options.get("json", False)):
            return command.run(options)
    top = _Top(
        prog="gearcam", description=_ABOUT, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    top.add_argument("--version", action="store_true", help="show the version and exit")
    top.add_argument("command", nargs="?", metavar="COMMAND", help="one of the commands below")
    options = top.parse_args(words[:1])
    if options.version:
        from gearcam.version import __version__

        say(f"gearcam {__version__}")
        return GOOD
    if options.command is not None:
        from gearcam.designs.faults import unknown_word

        refuse([unknown_word(word, "is not a command", [one.name for one in _commands()])])
    top.print_help(sys.stderr)
    return WRONG


def _commands() -> Iterator[Command]:
    """Yield the commands: general ones, then those of studies."""
    yield from _COMMANDS
    every: dict[str, Study] = {}
    for kind in kind_names():
        every = {**kind_studies(kind), **every}  # the first kind describes it
    yield from (_study_command(every[name]) for name in sorted(every))


def _command(word: str) -> Command | None:
    """Return the command of a `word`; None if there is none."""
    # those known here first: only then are other packages asked
    for one in _COMMANDS:
        if one.name == word:
            return one
    for kind in kind_names():
        if word in (own := kind_studies(kind).own):
            return _study_command(own[word])
    if not word or word.startswith("-"):
        return None
    return next((one for one in _commands() if one.name == word), None)


def _study_command(study: Study) -> Command:
    run = deferred("gearcam.study_commands:run")
    options = deferred("gearcam.study_commands:add_options")
    return Command(study.name, study.doc, partial(run, study), partial(options, study))


def parsers() -> Iterator[argparse.ArgumentParser]:
    """Yield the argument parser of every command; its description says what the command does."""
    return map(_parser, _commands())


def _completion(options: Options) -> int:
    """Print the script of a shell, with the words of all parsers."""
    from gearcam.completion import script

    say(script(options["shell"], parsers()))
    return GOOD


def _skill(options: Options) -> int:
    """Write the page for coding assistants."""
    from gearcam.export.write import write_new
    from gearcam.skill import page

    text = page(EXIT_CODES.items(), ((one.name, one.doc) for one in _commands()))
    if options["file"] is None:
        say(text.rstrip("\n"))
        return GOOD
    write_new(options["file"], text)
    say(f"{options['file']}: written")
    return GOOD


class _Help(argparse.HelpFormatter):
    """Help texts with words wrapped at spaces, and formats where they have ``{formats}``."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        return textwrap.wrap(text, width, break_on_hyphens=False)

    def _get_help_string(self, action: argparse.Action) -> str:
        text = action.help or ""
        if "{formats}" not in text:
            return text
        from gearcam.designs.kind import all_formats  # loads all kinds of design

        return text.replace("{formats}", ", ".join(all_formats()))


def _parser(command: Command) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"gearcam {command.name}", description=command.doc, formatter_class=_Help
    )
    command.arguments(parser)
    return parser


class _Top(argparse.ArgumentParser):
    """The parser of the command line, whose help lists the commands."""

    def format_help(self) -> str:
        commands = [f"  {one.name:<11}{one.doc}" for one in _commands()]
        codes = [f"  {code:<11}{meaning}" for code, meaning in EXIT_CODES.items()]
        more = "DIR is the output folder, NAME the name of the design."
        more += "\ngearcam COMMAND --help explains the options of a command."
        self.epilog = "\n".join(["commands:", *commands, "", more, "", "exit codes:", *codes])
        return super().format_help()


_GENERAL: Final = "gearcam.general_commands"

_COMMANDS: Final = (
    Command(
        "build",
        "Build designs and write their files into DIR/NAME/.",
        deferred(f"{_GENERAL}:build"),
        deferred(f"{_GENERAL}:build_options"),
    ),
    Command(
        "check",
        "Check designs; write DIR/NAME/summary.json only.",
        deferred(f"{_GENERAL}:check"),
        deferred(f"{_GENERAL}:add_files"),
    ),
    Command(
        "compare",
        "Compare designs or variants of one design; write DIR/compare.html.",
        deferred("gearcam.compare.command:compare"),
        deferred("gearcam.compare.command:arguments"),
    ),
    Command(
        "sweep",
        "Build thousands of variants of a design; write DIR/sweep.csv and sweep.html.",
        deferred("gearcam.sweeps.command:sweep"),
        deferred("gearcam.sweeps.command:arguments"),
    ),
    Command(
        "optimize",
        "Search the best of a design's variants; write DIR/best.toml and optimize.html.",
        deferred("gearcam.sweeps.optimize:optimize"),
        deferred("gearcam.sweeps.optimize:arguments"),
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
        deferred(f"{_GENERAL}:laws"),
    ),
    Command(
        "new",
        "Create a commented design file to start from; never overwrites a file.",
        deferred(f"{_GENERAL}:new"),
        deferred(f"{_GENERAL}:new_options"),
    ),
    Command(
        "schema",
        "Print the JSON Schema of design files, for use in editors.",
        deferred(f"{_GENERAL}:schema"),
    ),
    Command(
        "completion",
        "Print the script that completes commands and options in bash, zsh or fish.",
        _completion,
        deferred(f"{_GENERAL}:completion_options"),
    ),
    Command(
        "skill",
        "Write a page for coding assistants: design files, refusals, worked examples.",
        _skill,
        deferred(f"{_GENERAL}:skill_options"),
    ),
)
