"""The command line.

Every command ends in an exit code: 0 good (warnings included), 1 built but with findings at error
level, 2 wrong by reading the file or refused by the disk, 3 found impossible by computing, 4 a
fault of the program, 130 interrupted. Several files are all tried; the largest code is returned.
What was done goes to stdout, what went wrong to stderr; progress is drawn on a terminal only.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import shlex
import sys
import textwrap
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from gearcam import remedies
from gearcam.console import (
    DEBUG,
    all_lines,
    complain,
    fault_text,
    infeasible_text,
    law_lines,
    progress_bar,
    quieten,
    remedy_lines,
    say,
)
from gearcam.design import FORMATS, KINDS, demand_kind, load
from gearcam.errors import (
    DesignError,
    InfeasibleError,
    MissingExtraError,
    Problem,
    WriteError,
)

if TYPE_CHECKING:
    from gearcam.design import Design
    from gearcam.jobs import Job, Written

GOOD: Final = 0
FINDINGS: Final = 1
WRONG: Final = 2
IMPOSSIBLE: Final = 3
FAULT: Final = 4
INTERRUPTED: Final = 130

_ABOUT: Final = "Non-circular gears and cams from a description of the motion."
_CODES: Final = (
    "exit codes: 0 good, 1 findings at error level, 2 wrong by reading, 3 impossible, "
    "4 a fault of the program, 130 interrupted"
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Those of the process when left out.

    Returns
    -------
    int
        The exit code.
    """
    for stream in (sys.stdout, sys.stderr):
        # a name that the terminal cannot show must not end the program
        with contextlib.suppress(AttributeError, ValueError):
            stream.reconfigure(errors="backslashreplace")  # pyright: ignore[reportAttributeAccessIssue]
    words = list(sys.argv[1:] if arguments is None else arguments)
    if arguments is None and not (sys.warnoptions or "--debug" in words or os.environ.get(DEBUG)):
        quieten()
    try:
        _dispatch(words)
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else GOOD
    except KeyboardInterrupt:
        return _interrupted()
    except Exception as error:
        return _fault(error, debug="--debug" in words)
    return GOOD


def _dispatch(words: list[str]) -> None:
    """Find the command of the first word and run it on the others."""
    functions = (_build, _check, _mesh, _follow, _laws, _new, _migrate, _schema)
    commands = {function.__name__.lstrip("_"): function for function in functions}
    top = argparse.ArgumentParser(
        prog="gearcam",
        description=_ABOUT,
        epilog=_command_help(commands) + _CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="store_true", help="show the version")
    top.add_argument("command", nargs="?", metavar="COMMAND", help="see below")
    if words and words[0] in commands:
        parser = _parser(words[0], commands[words[0]])
        commands[words[0]](**vars(parser.parse_intermixed_args(words[1:])))
        return
    given = top.parse_args(words[:1])
    if given.version:
        from gearcam import __version__

        say(f"gearcam {__version__}")
    elif given.command is None:
        top.print_help(sys.stderr)
        raise SystemExit(WRONG)
    else:
        from gearcam.design.wording import did_you_mean

        hint = did_you_mean(given.command, commands)
        _refuse(
            [Problem(f'"{given.command}" is not a command', allowed=", ".join(commands), hint=hint)]
        )


def _parser(name: str, command: Callable[..., None]) -> argparse.ArgumentParser:
    """Return the parser of a command; its help is the function's docstring."""
    parser = argparse.ArgumentParser(prog=f"gearcam {name}", description=command.__doc__)
    if command in (_build, _check, _mesh, _migrate):
        parser.add_argument("files", nargs="+", metavar="FILE", help="design files (TOML)")
    if command is _follow:
        parser.add_argument("file", metavar="FILE", help="design file (TOML) of a cam")
        words = "the profile: DXF with one closed outline, or CSV with x_mm, y_mm"
        parser.add_argument("profile", metavar="PROFILE", help=words)
    if command in (_build, _check, _mesh, _follow):
        parser.add_argument(
            "-o", "--output", metavar="DIR", default="output", help="where to write"
        )
        parser.add_argument(
            "--debug", action="store_true", help=f"show tracebacks (or set {DEBUG})"
        )
    if command is _build:
        words = f"write only these: {','.join(FORMATS)}"
        parser.add_argument("--only", action="append", metavar="KINDS", help=words)
    if command is _mesh:
        _mesh_options(parser)
    if command is _new:
        words = f"the kind of design: {' or '.join(KINDS)}"
        parser.add_argument("kind", metavar="KIND", help=words)
        parser.add_argument("file", nargs="?", metavar="FILE", help="printed when left out")
    return parser


def _mesh_options(parser: argparse.ArgumentParser) -> None:
    """Add the settings of a study: they stand before those of the file's table [meshing]."""
    kinds = {"steps": int, "helix_step": int, "teeth": _numbers}
    for key, entry in KINDS["gear-pair"].table("meshing").entries.items():
        names = {"center_distance_mm": "center", "helix_step": "step"}
        word = names.get(key, key.removesuffix("_deg"))
        unit = entry.param.quantity.unit.upper()
        parser.add_argument(
            f"--{word}",
            dest=key,
            type=kinds.get(key, float),
            metavar=unit or ("1,27,..." if key == "teeth" else "N"),
            help=entry.param.doc,
        )


def _numbers(text: str) -> list[int]:
    try:
        return [int(word) for word in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f'"{text}" is no list of teeth such as 1,27') from None


def _command_help(commands: Mapping[str, Callable[..., None]]) -> str:
    rows = (f"  {name:<8}{command.__doc__}\n" for name, command in commands.items())
    return "commands:\n" + "".join(rows) + "\n"


def _build(files: list[str], output: str, only: list[str] | None, debug: bool) -> None:
    """Build designs into DIR/<name>/."""
    kinds = _kinds(only)

    def action(job: Job, progress: Progress | None) -> Written:
        return job.write(output, files=kinds, progress=progress)

    _jobs(files, "built", action, debug=debug)


def _check(files: list[str], output: str, debug: bool) -> None:
    """Check designs and write nothing but DIR/<name>/summary.json."""

    def action(job: Job, progress: Progress | None) -> Written:  # noqa: ARG001
        return job.check(output)

    _jobs(files, "checked", action, debug=debug)


def _mesh(files: list[str], output: str, debug: bool, **settings: Any) -> None:
    """Turn the pair step by step: contact, interference, play; writes DIR/<name>/meshing.csv."""
    from gearcam.design import with_meshing

    given = {key: value for key, value in settings.items() if value is not None}

    def adapt(design: Design) -> Design:
        return with_meshing(demand_kind(design, "gear-pair"), given)

    def action(job: Any, progress: Progress | None) -> Written:
        return job.mesh(output, progress=progress)

    _jobs(files, "meshed", action, debug=debug, adapt=adapt)


def _follow(file: str, profile: str, output: str, debug: bool) -> None:
    """Put a cam's follower on a given profile; writes DIR/<name>/followed.csv."""

    def action(job: Any, progress: Progress | None) -> Written:
        return job.follow(profile, output, progress=progress)

    _jobs([file], "followed", action, debug=debug, adapt=lambda d: demand_kind(d, "cam"))


def _laws() -> None:
    """Show every law, of ratios and of lifts: parameters, continuity, source."""
    from gearcam.design.listing import law_groups

    for heading, laws in law_groups():
        say(f"{heading}\n")
        for law in laws:
            say("\n".join(law_lines(law)))


def _new(kind: str, file: str | None) -> None:
    """Write a commented design file to start from; an existing file is never overwritten."""
    from gearcam.design.template import template
    from gearcam.design.wording import did_you_mean, show

    if kind not in KINDS:
        message, hint = f"{show(kind)} is not a kind of design", did_you_mean(kind, KINDS)
        _refuse([Problem(message, key="KIND", allowed=", ".join(KINDS), hint=hint)])
    if file is None:
        say(template(kind).rstrip("\n"))
        return
    try:
        with Path(file).open("x", encoding="utf-8", newline="\n") as stream:
            stream.write(template(kind, Path(file).stem))
    except FileExistsError:
        _refuse([Problem("exists, and is not overwritten", file=file)])
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        _refuse([Problem(f"cannot be written: {reason}", file=file)])
    say(f"{file}: written; build it with: gearcam build {shlex.quote(file)}")


def _migrate(files: list[str]) -> None:
    """Rewrite design files with keys that are no longer known; comments stay."""
    from gearcam.design.migrate import migrate
    from gearcam.export.rewrite import rewrite

    def one(file: str) -> int:
        content, changes = migrate(file)
        if changes:
            rewrite(file, content)
        say("\n  ".join([f"{file}: {'migrated' if changes else 'nothing to change'}", *changes]))
        return GOOD

    _each(files, "migrated", one, good="up to date")


def _schema() -> None:
    """Print the JSON schema of design files, for editors."""
    import json

    from gearcam.design.schema import schema as made

    say(json.dumps(made(), indent=2))


def _kinds(only: list[str] | None) -> tuple[str, ...] | None:
    """Return the kinds of files of ``--only``, or refuse."""
    from gearcam.design.wording import did_you_mean, show

    if only is None:
        return None
    kinds = [word.strip() for words in only for word in words.split(",") if word.strip()]
    rule = ", ".join(FORMATS)
    problems = [] if kinds else [Problem("nothing is listed", key="--only", allowed=rule)]
    for kind in kinds:
        if kind not in FORMATS:
            message, hint = f"{show(kind)} is not a kind of file", did_you_mean(kind, FORMATS)
            problems.append(Problem(message, key="--only", value=kind, allowed=rule, hint=hint))
    if problems:
        _refuse(problems)
    return tuple(dict.fromkeys(kinds))


def _refuse(problems: Sequence[Problem]) -> None:
    for problem in problems:
        complain(str(problem))
    raise SystemExit(WRONG)


Progress = Callable[[str, int, int], None]
Action = Callable[["Job", Progress | None], "Written"]
Adapt = Callable[["Design"], "Design"]


def _jobs(
    files: Sequence[str], done: str, action: Action, *, debug: bool, adapt: Adapt | None = None
) -> None:
    """Do something with the job of every file, its design adapted where asked."""
    names: dict[str, str] = {}
    _each(files, done, lambda file: _one(file, names, done, action, adapt), debug=debug)


def _each(
    files: Sequence[str],
    done: str,
    work: Callable[[str], int],
    *,
    good: str = "",
    debug: bool = False,
) -> None:
    """Do some work with every file, and end with the largest code; `good` files are counted."""
    codes = []
    for file in files:
        try:
            codes.append(work(file))
            if codes[-1] == INTERRUPTED:
                break
        except KeyboardInterrupt:
            raise SystemExit(_interrupted()) from None
        except DesignError as error:
            count = len(error.problems)
            complain(f"{file}: {count} problem{'s' * (count > 1)}, nothing was {done}")
            complain(textwrap.indent(str(error), "  "))
            codes.append(WRONG)
        except (WriteError, MissingExtraError) as error:
            complain(f"{file}: {error}")
            codes.append(WRONG)
        except Exception as error:
            codes.append(_fault(error, file=file, debug=debug))
    if len(files) > 1:
        count = sum(code in (GOOD, FINDINGS) for code in codes)
        say(f"{len(files)} files: {count} {good or done}, {len(files) - count} refused")
    raise SystemExit(max(codes, default=GOOD))


def _one(file: str, names: dict[str, str], done: str, action: Action, adapt: Adapt | None) -> int:
    """Do something with one file and say what came of it."""
    start = time.perf_counter()
    design = load(file) if adapt is None else adapt(load(file))
    _demand_new_name(design, file, names)
    from gearcam.jobs import make_job  # a file that is refused needs none of it

    job = make_job(design)
    try:
        with progress_bar(file) as progress:
            written = action(job, progress)
    except InfeasibleError as error:
        complain(f"{file}: cannot be made, nothing was {done}\n{infeasible_text(error)}")
        for line in remedy_lines(remedies(job, error)):
            complain(f"  {line}")
        return IMPOSSIBLE
    say(f"{file}: {done} in {time.perf_counter() - start:.2f} s")
    say(textwrap.indent("\n".join(all_lines(written)), "  "))
    if not written.complete:
        found = written.summary["meshing"]
        complain(f"{file}: interrupted: {found['steps_done']} of {found['steps']} steps are kept")
        return INTERRUPTED
    errors = any(finding.severity == "error" for finding in written.findings)
    for line in remedy_lines(remedies(job)) if errors else ():
        say(f"  {line}")
    return FINDINGS if errors else GOOD


def _demand_new_name(design: Design, file: str, names: dict[str, str]) -> None:
    """Refuse a second design that would be written over the first one of the same call."""
    before = names.setdefault(design.name.casefold(), file)
    if before != file:
        message = f'"{design.name}" is taken by {before} in this call'
        raise DesignError([Problem(message, file=file, key="name", value=design.name)])


def _fault(error: Exception, *, file: str = "", debug: bool = False) -> int:
    """Say that the program is at fault; the traceback only where it is asked for."""
    if debug or os.environ.get(DEBUG):
        complain("".join(traceback.format_exception(error)).rstrip())
    complain(fault_text(error, file))
    return FAULT


def _interrupted() -> int:
    complain("interrupted: no file was left half-written")
    return INTERRUPTED
