"""The command line: the one room that prints.

Every command ends in an exit code: 0 good (warnings included), 1 built but with findings at error
level, 2 wrong by reading the file or refused by the disk, 3 found impossible by computing, 4 a
fault of the program, 130 interrupted. Several files are all tried; the largest code is returned.
What was done goes to stdout, what went wrong to stderr; progress is drawn on a terminal only.
"""

from __future__ import annotations

import contextlib
import os
import sys
import textwrap
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, TextIO

import typer

from gearcam.design import FORMATS, KIND, GearPairDesign, load
from gearcam.errors import DesignError, InfeasibleError, Problem, WriteError

if TYPE_CHECKING:
    from gearcam.findings import Finding
    from gearcam.jobs import GearPairJob, Written

GOOD: Final = 0
FINDINGS: Final = 1
WRONG: Final = 2
IMPOSSIBLE: Final = 3
FAULT: Final = 4
INTERRUPTED: Final = 130

_WIDTH: Final = 96
_DEBUG: Final = "GEARCAM_DEBUG"

app = typer.Typer(
    name="gearcam",
    help="Non-circular gears from a description of the motion.",
    epilog="Exit codes: 0 good, 1 findings at error level, 2 wrong by reading, 3 impossible, "
    "4 a fault of the program, 130 interrupted.",
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

Files = Annotated[list[str], typer.Argument(metavar="FILE...", help="Design files (TOML).")]
Output = Annotated[str, typer.Option("--output", "-o", metavar="DIR", help="Where to write.")]
Debug = Annotated[bool, typer.Option("--debug", help=f"Show tracebacks (or set {_DEBUG}).")]


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
    try:
        typer.main.get_command(app).main(args=words, prog_name="gearcam", windows_expand_args=True)
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else GOOD
    except KeyboardInterrupt:
        return _interrupted()
    except Exception as error:
        return _fault(error, debug="--debug" in words)
    return GOOD


@app.callback(invoke_without_command=True)
def _root(
    version: Annotated[bool, typer.Option("--version", help="Show the version.")] = False,
) -> None:
    if version:
        from importlib.metadata import PackageNotFoundError
        from importlib.metadata import version as installed

        with contextlib.suppress(PackageNotFoundError):
            _say(f"gearcam {installed('gearcam')}")
            raise typer.Exit(GOOD)
        _say("gearcam, not installed: its version is not known")
        raise typer.Exit(GOOD)


@app.command()
def build(
    files: Files,
    output: Output = "output",
    only: Annotated[
        list[str] | None,
        typer.Option(metavar="KINDS", help=f"Write only these: {','.join(FORMATS)}."),
    ] = None,
    debug: Debug = False,
) -> None:
    """Build designs into DIR/<name>/."""
    kinds = _kinds(only)

    def action(job: GearPairJob, progress: Progress | None) -> Written:
        return job.write(output, files=kinds, progress=progress)

    _each(files, "built", action, debug=debug)


@app.command()
def check(files: Files, output: Output = "output", debug: Debug = False) -> None:
    """Check designs and write nothing but DIR/<name>/summary.json."""

    def action(job: GearPairJob, progress: Progress | None) -> Written:  # noqa: ARG001
        return job.check(output)

    _each(files, "checked", action, debug=debug)


@app.command()
def laws() -> None:
    """Show every law: parameters, continuity, source."""
    from gearcam.design.models import description
    from gearcam.design.tables import law_table
    from gearcam.laws.base import LAWS

    for name, law in LAWS.items():
        _say(f'{name}\n{_wrapped(law.doc)}\n    law.type = "{name}"')
        rows = [(entry.key, description(entry)) for entry in law_table(name).entries.values()]
        for key, words in rows:
            _say(_wrapped(words, first=f"    {key:<16}", rest=" " * 20))
        _say(_wrapped(law.continuity, first=f"    {'continuity':<16}", rest=" " * 20))
        _say(_wrapped(law.source, first=f"    {'source':<16}", rest=" " * 20) + "\n")


@app.command()
def new(
    kind: Annotated[str, typer.Argument(metavar="KIND", help=f"The kind of design: {KIND}.")],
    file: Annotated[
        str | None, typer.Argument(metavar="[FILE]", help="Printed when left out.")
    ] = None,
) -> None:
    """Write a commented design file to start from; an existing file is never overwritten."""
    from gearcam.design.examine import LATER_KINDS
    from gearcam.design.template import template
    from gearcam.design.wording import did_you_mean, show

    if kind != KIND:
        later = kind in LATER_KINDS
        what = f"{kind}s are not built by this version yet" if later else "is not a kind of design"
        hint = "" if later else did_you_mean(kind, [KIND])
        _refuse([Problem(f"{show(kind)}: {what}", key="KIND", allowed=KIND, hint=hint)])
    if file is None:
        _say(template().rstrip("\n"))
        return
    try:
        with Path(file).open("x", encoding="utf-8", newline="\n") as stream:
            stream.write(template(_stem(file)))
    except FileExistsError:
        _refuse([Problem("exists, and is not overwritten", file=file)])
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        _refuse([Problem(f"cannot be written: {reason}", file=file)])
    _say(f"{file}: written; build it with: gearcam build {file}")


@app.command()
def schema() -> None:
    """Print the JSON schema of design files, for editors."""
    import json

    from gearcam.design.schema import schema as made

    _say(json.dumps(made(), indent=2))


def _stem(file: str) -> str:
    """Return a file's stem where it can name a design, or the template's own name."""
    from gearcam.design.examine import name_fault

    stem = Path(file).stem
    return "my_gear_pair" if name_fault(stem) else stem


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
        _complain(str(problem))
    raise typer.Exit(WRONG)


Progress = Callable[[str, int, int], None]
Action = Callable[["GearPairJob", Progress | None], "Written"]


def _each(files: Sequence[str], done: str, action: Action, *, debug: bool) -> None:
    """Do something with every file and end with the largest code."""
    names: dict[str, str] = {}
    codes = []
    for file in files:
        try:
            codes.append(_one(file, names, done, action))
        except KeyboardInterrupt:
            raise typer.Exit(_interrupted()) from None
        except DesignError as error:
            count = len(error.problems)
            _complain(f"{file}: {count} problem{'s' * (count > 1)}, nothing was {done}")
            _complain(textwrap.indent(str(error), "  "))
            codes.append(WRONG)
        except InfeasibleError as error:
            _complain(f"{file}: cannot be made, nothing was {done}\n{_infeasible(error)}")
            codes.append(IMPOSSIBLE)
        except WriteError as error:
            _complain(f"{file}: {error}")
            codes.append(WRONG)
        except Exception as error:
            codes.append(_fault(error, file=file, debug=debug))
    if len(files) > 1:
        good = sum(code in (GOOD, FINDINGS) for code in codes)
        _say(f"{len(files)} files: {good} {done}, {len(files) - good} refused")
    raise typer.Exit(max(codes, default=GOOD))


def _one(file: str, names: dict[str, str], done: str, action: Action) -> int:
    """Do something with one file and say what came of it."""
    start = time.perf_counter()
    design = load(file)
    _demand_new_name(design, file, names)
    from gearcam.jobs import GearPairJob  # a file that is refused needs none of it

    job = GearPairJob(design)
    with _progress(file) as progress:
        written = action(job, progress)
    _say(f"{file}: {done} in {time.perf_counter() - start:.2f} s")
    findings = job.findings
    told = [_pair_lines(written.summary), _finding_lines(findings), _written_lines(written)]
    _say(textwrap.indent("\n".join(line for lines in told for line in lines), "  "))
    return FINDINGS if any(finding.severity == "error" for finding in findings) else GOOD


def _demand_new_name(design: GearPairDesign, file: str, names: dict[str, str]) -> None:
    """Refuse a second design that would be written over the first one of the same call."""
    before = names.setdefault(design.name.casefold(), file)
    if before != file:
        message = f'"{design.name}" is taken by {before} in this call'
        raise DesignError([Problem(message, file=file, key="name", value=design.name)])


def _pair_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    pair = summary.get("pair", {})
    teeth = " : ".join(str(count) for count in pair.get("teeth", ()))
    distance, module = pair.get("center_distance_mm"), pair.get("module_mm")
    if distance is not None and module is not None:
        yield f"centre distance {distance:.6g} mm, module {module:.6g} mm, teeth {teeth}"


def _finding_lines(findings: Sequence[Finding]) -> Iterator[str]:
    """Lay out findings as a table, each with its message below."""
    if not findings:
        yield "findings: none"
        return
    yield "findings"
    rows = []
    for finding in findings:
        limit = f"limit {_number(finding.limit, finding.unit)}" if finding.limit is not None else ""
        value = _number(finding.value, finding.unit)
        rows.append((finding.severity, finding.code, finding.where, value, limit))
    widths = [max(len(row[k]) for row in rows) for k in range(5)]
    for row, finding in zip(rows, findings, strict=True):
        cells = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True) if width)
        yield "  " + "  ".join(cells).rstrip()
        yield _wrapped(finding.message, first="      ", rest="      ")


def _written_lines(written: Written) -> Iterator[str]:
    folder = written.directory
    yield f"written to {folder}"
    width = max(map(len, (*written.files, *written.removed)), default=0)
    for name in written.files:
        yield f"  {name:<{width}}  {_size(folder / name):>9}"
    for name in written.removed:
        yield f"  {name:<{width}}  removed: no longer part of the design"


def _number(value: float | None, unit: str) -> str:
    return "" if value is None else f"{value:.6g} {unit}".rstrip()


def _size(path: Path) -> str:
    try:
        count = path.stat().st_size
    except OSError:
        return ""
    if count < 1000:
        return f"{count} B"
    return f"{count / 1e3:.1f} kB" if count < 1e6 else f"{count / 1e6:.1f} MB"


def _infeasible(error: InfeasibleError) -> str:
    lines = [f"{error.what}, at {error.where}" if error.where else error.what]
    numbers = (("value", error.value), ("limit", error.limit))
    shown = [
        f"{name} {_number(number, error.unit)}" for name, number in numbers if number is not None
    ]
    lines += [", ".join(shown)] if shown else []
    lines += error.nearest.split("; ") if error.nearest else []
    return "\n".join(_wrapped(line, first="  ", rest="      ") for line in lines)


def _wrapped(text: str, *, first: str = "    ", rest: str = "    ") -> str:
    return textwrap.fill(
        text,
        _WIDTH,
        initial_indent=first,
        subsequent_indent=rest,
        break_long_words=False,
        break_on_hyphens=False,
    )


@contextlib.contextmanager
def _progress(file: str) -> Iterator[Progress | None]:
    """Draw a bar while long work runs, on a terminal; elsewhere there is nothing to call."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(file, total=None)

        def advance(stage: str, done: int, total: int) -> None:
            bar.update(task, description=f"{file}: {stage}", completed=done, total=total)

        yield advance


def _fault(error: Exception, *, file: str = "", debug: bool = False) -> int:
    """Say that the program is at fault; the traceback only where it is asked for."""
    place = f"{file}: " if file else ""
    if debug or os.environ.get(_DEBUG):
        _complain("".join(traceback.format_exception(error)).rstrip())
    _complain(
        f"{place}this is a fault of gearcam, not of your design: {type(error).__name__}: {error}\n"
        f"  please report it with the design file; {_DEBUG}=1 or --debug shows where it happened"
    )
    return FAULT


def _interrupted() -> int:
    _complain("interrupted: no file was left half-written")
    return INTERRUPTED


def _say(text: str) -> None:
    _write(text, sys.stdout)


def _complain(text: str) -> None:
    _write(text, sys.stderr)


def _write(text: str, stream: TextIO) -> None:
    """Print; a reader that has gone (such as ``head``) is no reason to stop building."""
    try:
        print(text, file=stream, flush=True)
    except BrokenPipeError:
        # what is still buffered goes nowhere, and the flush at the end finds nothing broken
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
