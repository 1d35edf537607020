from __future__ import annotations

from typing import Any

from gearcam.commands import ResultCommand
from gearcam.designs.design import demand_kind


def _adapt(design: Any, _: Any) -> Any:
    return demand_kind(design, "spacer")


def _run(result: Any, output: str, options: Any, _: Any) -> Any:
    return result.keep({"weight.txt": str(options["density"]).encode()}, output, {"weighed": True})


def _arguments(parser: Any) -> None:
    parser.add_argument("--density", type=float, default=7.8)


COMMANDS = (
    ResultCommand(
        name="weigh", done="weighed", doc="Weigh a spacer.", arguments=_arguments, adapt=_adapt,
        run=_run,
    ),
)  # fmt: skip
