"""Commands of the command line, as entries: those of kinds of design and studies too."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from gearcam.designs.design import Design
from gearcam.numeric.arguments import whole
from gearcam.results.result import Progress
from gearcam.results.written import Written


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
    run: Callable[[Mapping[str, Any]], int]
    arguments: Callable[[argparse.ArgumentParser], None] = lambda _: None


@dataclass(frozen=True, kw_only=True)
class ResultCommand:
    """A command that works on the result of each design file; the command line prints the outcome.

    Parameters
    ----------
    name, doc : str
        As of a `Command`.
    done : str
        Past participle for messages, such as ``meshed``.
    arguments : callable
        ``arguments(parser)`` adds its own options to a parser.
    adapt : callable
        ``adapt(design, options)`` returns the design to work on; it raises `DesignError` for a
        kind of design that the command does not support.
    run : callable
        ``run(result, output, options, progress)`` does the work and writes its files.
    many : bool
        Whether it takes several design files.
    """

    name: str
    doc: str
    done: str
    arguments: Callable[[argparse.ArgumentParser], None]
    adapt: Callable[[Design, Mapping[str, Any]], Design]
    run: Callable[[Any, str, Mapping[str, Any], Progress | None], Written]
    many: bool = True


def _accuracy_arguments(parser: argparse.ArgumentParser) -> None:
    words = "stages to measure: law, centrode, flank, outline, solid, contact, cam (default: all)"
    parser.add_argument("--stage", metavar="A,B,...", help=words)
    words = "number of runs; the median time is reported (default: 5)"
    parser.add_argument("--repeat", metavar="K", type=int, default=5, help=words)


def _stages(options: Mapping[str, Any]) -> list[str] | None:
    given = options["stage"]
    return None if given is None else [word.strip() for word in given.split(",") if word.strip()]


def _accuracy_design(design: Design, options: Mapping[str, Any]) -> Design:
    from gearcam.results.accuracy import stages_of

    whole("--repeat", options["repeat"], 1)
    stages_of(design, _stages(options))
    return design


def _measure(
    result: Any, output: str, options: Mapping[str, Any], progress: Progress | None
) -> Written:
    from gearcam.report.page import charts_page
    from gearcam.results.accuracy import PAGE, TABLE, accuracy

    found = accuracy(result, _stages(options), options["repeat"], progress)
    lines = tuple(found.lines())
    title = f"{result.design.name}, error against run time"
    page = charts_page(title, found.charts, "\n".join(lines))
    return replace(result.keep({TABLE: found.table, PAGE: page}, output, {}), table=lines)


COMMANDS: Final = (
    ResultCommand(
        name="accuracy",
        done="measured",
        doc="Measure accuracy against run time; write DIR/NAME/accuracy.csv and accuracy.html.",
        arguments=_accuracy_arguments,
        adapt=_accuracy_design,
        run=_measure,
        many=False,
    ),
)
"""The commands for designs of any kind."""
