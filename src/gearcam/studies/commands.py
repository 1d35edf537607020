"""The command ``accuracy``: error against run time of a design's computations."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any, Final

from gearcam.commands import ResultCommand
from gearcam.designs.design import Design
from gearcam.numeric.arguments import whole
from gearcam.result import Progress
from gearcam.written import Written


def _arguments(parser: argparse.ArgumentParser) -> None:
    words = "stages to measure: law, centrode, flank, outline, solid, contact, cam (default: all)"
    parser.add_argument("--stage", metavar="A,B,...", help=words)
    words = "number of runs; the median time is reported (default: 5)"
    parser.add_argument("--repeat", metavar="K", type=int, default=5, help=words)


def _asked(options: Mapping[str, Any]) -> list[str] | None:
    given = options["stage"]
    return None if given is None else [word.strip() for word in given.split(",") if word.strip()]


def _adapt(design: Design, options: Mapping[str, Any]) -> Design:
    from gearcam.studies.accuracy import stages_of

    whole("--repeat", options["repeat"], 1)
    stages_of(design, _asked(options))
    return design


def _run(
    result: Any, output: str, options: Mapping[str, Any], progress: Progress | None
) -> Written:
    from gearcam.studies.accuracy import accuracy

    return accuracy(result, _asked(options), options["repeat"], progress).write(output)


COMMANDS: Final = (
    ResultCommand(
        name="accuracy",
        done="measured",
        doc="Measure accuracy against run time; write DIR/NAME/accuracy.csv and accuracy.svg.",
        arguments=_arguments,
        adapt=_adapt,
        run=_run,
        many=False,
    ),
)
