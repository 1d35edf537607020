"""The command ``follow``: the motion of a follower on a given cam profile."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any

from gearcam.commands import ResultCommand
from gearcam.designs.design import Design, demand_kind
from gearcam.results.result import Progress
from gearcam.results.written import Written


def _arguments(parser: argparse.ArgumentParser) -> None:
    words = "cam profile: DXF with one closed outline, or CSV with columns x_mm and y_mm"
    parser.add_argument("profile", metavar="PROFILE", help=words)
    words = "wall to follow: 1 or 2 (conjugate cams); inner, outer, lower or upper (groove)"
    parser.add_argument("--wall", metavar="KEY", help=words)


def _adapt(design: Design, _: Mapping[str, Any]) -> Design:
    from gearcam.kinds.cam.design import NAME

    return demand_kind(design, NAME)


def _run(
    result: Any, output: str, options: Mapping[str, Any], progress: Progress | None
) -> Written:
    study = result.follow(options["profile"], wall=options["wall"], progress=progress)
    return study.write(output)


def commands() -> tuple[ResultCommand, ...]:
    """Return the commands."""
    return (
        ResultCommand(
            name="follow",
            done="followed",
            doc="Compute the follower motion on a given profile; write DIR/NAME/followed.csv.",
            arguments=_arguments,
            adapt=_adapt,
            run=_run,
            many=False,
        ),
    )
