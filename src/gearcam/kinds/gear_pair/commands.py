"""The command ``mesh``: a meshing study of a gear pair."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.commands import ResultCommand
from gearcam.designs.design import Design, demand_kind
from gearcam.designs.kind import KINDS
from gearcam.results.result import Progress
from gearcam.results.written import Written

if TYPE_CHECKING:
    from gearcam.designs.table import Table
    from gearcam.kinds.gear_pair.design import GearPairDesign

_OPTIONS: Final = {"center_distance_mm": "center"}
"""Names of options that differ from their keys."""


def with_meshing(design: Design, given: Mapping[str, Any]) -> GearPairDesign:
    """Return a design with changed settings of its meshing study.

    Parameters
    ----------
    design : Design
        The design of a gear pair.
    given : mapping of str to value
        New values by keys of the table ``[meshing]``, in the units of a design file.

    Returns
    -------
    GearPairDesign

    Raises
    ------
    DesignError
        If the design is not a gear pair, or a value is not allowed.
    """
    from gearcam.kinds.gear_pair.design import NAME

    pair: GearPairDesign = demand_kind(design, NAME)
    values = _table().inward(given)
    return dataclasses.replace(pair, meshing=dataclasses.replace(pair.meshing, **values))


def _table() -> Table:
    from gearcam.kinds.gear_pair.design import NAME

    return KINDS[NAME].table("meshing")


def _arguments(parser: argparse.ArgumentParser) -> None:
    """Add an option for each key of the table [meshing], which it overrides."""
    for key, entry in _table().entries.items():
        unit = entry.param.quantity.unit.upper()
        parser.add_argument(
            f"--{_OPTIONS.get(key, key.removesuffix('_deg'))}",
            dest=key,
            type=entry.base if entry.length is None else _numbers,
            metavar=unit or ("N" if entry.length is None else "1,27,..."),
            help=entry.param.doc,
        )


def _numbers(text: str) -> list[int]:
    try:
        return [int(word) for word in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f'"{text}" is not a list of teeth such as 1,27') from None


def _adapt(design: Design, options: Mapping[str, Any]) -> Design:
    return with_meshing(design, {key: item for key, item in options.items() if item is not None})


def _run(
    result: Any, output: str, options: Mapping[str, Any], progress: Progress | None
) -> Written:
    _ = options  # they are in the design
    return result.mesh(progress=progress).write(output)


def commands() -> tuple[ResultCommand, ...]:
    """Return the commands."""
    return (
        ResultCommand(
            name="mesh",
            done="meshed",
            doc="Study the meshing of gear pairs step by step; write DIR/NAME/meshing.csv.",
            arguments=_arguments,
            adapt=_adapt,
            run=_run,
        ),
    )
