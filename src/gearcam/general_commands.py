"""The general commands: they build and check designs, list laws, and write new design files."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from gearcam.base.errors import Problem
from gearcam.base.inches import UNITS
from gearcam.commands import (
    GOOD,
    Options,
    add_output,
    add_summary,
    each_result,
    refuse,
    suggest,
)
from gearcam.completion import PLACES, SHELLS
from gearcam.console import catalogue_lines, say
from gearcam.designs import load
from gearcam.designs.faults import unknown_word
from gearcam.designs.kind import all_formats
from gearcam.designs.outputs import FORMATS
from gearcam.designs.reader import STDIN
from gearcam.results.kind import KINDS


def add_files(parser: argparse.ArgumentParser) -> None:
    """Add design files and the output folder to a `parser`."""
    words = f"design files (TOML); {STDIN} is the standard input"
    parser.add_argument("files", nargs="+", metavar="FILE", help=words)
    add_output(parser)
    add_summary(parser)


def build_options(parser: argparse.ArgumentParser) -> None:
    """Add what ``gearcam build`` takes to a `parser`."""
    add_files(parser)
    words = "write these files instead of output.files: {formats}"
    only = parser.add_argument("--only", action="append", metavar="A,B,...", help=words)
    suggest(only, all_formats)


def build(options: Options) -> int:
    """Build designs and write their files."""
    output, formats = options["output"], _formats(options["only"])
    return each_result(
        options["files"],
        load,
        "built",
        lambda result, progress: result.write(output, formats, progress),
        debug=options["debug"],
        as_json=options["json"],
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


def check(options: Options) -> int:
    """Check designs and write their summaries."""
    return each_result(
        options["files"],
        load,
        "checked",
        lambda result, _: result.check(options["output"]),
        debug=options["debug"],
        as_json=options["json"],
    )


def laws(_: Options) -> int:
    """Print ratio laws and motion laws."""
    from gearcam.designs.listing import law_groups, sources_of

    groups = list(law_groups())
    say("\n".join(catalogue_lines(groups, sources_of(groups))))
    return GOOD


def new_options(parser: argparse.ArgumentParser) -> None:
    """Add what ``gearcam new`` takes to a `parser`."""
    words = f"kind of design: {' or '.join(KINDS)}"
    suggest(parser.add_argument("kind", metavar="KIND", help=words), lambda: KINDS)
    parser.add_argument("file", nargs="?", metavar="FILE", help="default: stdout")
    words = "preset backlash, clearance, kerf and tool for printing, laser, wire or milling"
    process = parser.add_argument("--for", dest="process", metavar="PROCESS", help=words)
    suggest(
        process, lambda: dict.fromkeys(one for kind in KINDS.values() for one in kind.processes)
    )
    words = "unit of lengths in the file, mm or inch (default: mm)"
    parser.add_argument("--units", metavar="UNIT", choices=UNITS, default=UNITS[0], help=words)


def new(options: Options) -> int:
    """Write a commented design file."""
    from gearcam.designs.template import process_problem, template, template_hint
    from gearcam.export.write import write_new

    kind, file, process = options["kind"], options["file"], options["process"]
    if kind not in KINDS:
        problem = unknown_word(kind, "is not a kind of design", KINDS, "KIND")
        refuse([replace(problem, hint=template_hint(kind))])
    if process is not None and (problem := process_problem(kind, process)):
        refuse([problem])
    text = template(kind, Path(file or "").stem, process or "", options["units"])
    if file is None:
        say(text.rstrip("\n"))
        return GOOD
    import shlex

    write_new(file, text)
    say(f"{file}: written; build it with: gearcam build {shlex.quote(file)}")
    return GOOD


def schema(_: Options) -> int:
    """Print the JSON Schema of design files."""
    import json

    from gearcam.designs.schema import schema as made

    say(json.dumps(made(), indent=2))
    return GOOD


def completion_options(parser: argparse.ArgumentParser) -> None:
    """Add what ``gearcam completion`` takes to a `parser`."""
    places = "; ".join(f"{shell}: {place}" for shell, place in PLACES.items())
    words = f"the shell; its script belongs into ({places})"
    parser.add_argument("shell", metavar="SHELL", choices=SHELLS, help=words)


def skill_options(parser: argparse.ArgumentParser) -> None:
    """Add what ``gearcam skill`` takes to a `parser`."""
    words = "a new file, such as SKILL.md; default: stdout"
    parser.add_argument("file", nargs="?", metavar="FILE", help=words)
